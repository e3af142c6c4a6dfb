"""The words that algorithms are written in, beside Python's own; also how Python runs them."""

from __future__ import annotations

import math
from array import array
from typing import TYPE_CHECKING, Any, Protocol, cast, overload

from linegraph.ir.rounding import DOUBLE

if TYPE_CHECKING:
    from linegraph.ir.program import Status

small = DOUBLE
"""The bounds of rounding: those of doubles here, those of its own numbers in every language."""

infinity = math.inf


class Reals(Protocol):
    """An array of real numbers; a slice is a part of the same array, not a copy."""

    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, place: int, /) -> float: ...
    @overload
    def __getitem__(self, places: slice, /) -> Reals: ...
    def __setitem__(self, place: int, value: float, /) -> None: ...


class Ints(Protocol):
    """An array of whole numbers."""

    def __len__(self) -> int: ...
    def __getitem__(self, place: int, /) -> int: ...
    def __setitem__(self, place: int, value: int, /) -> None: ...


class Places(Protocol):
    """Whole numbers that stay as they are, such as places of coordinates."""

    def __len__(self) -> int: ...
    def __getitem__(self, place: int, /) -> int: ...


def reals(size: int) -> Reals:
    """A new array of so many zeros."""
    return cast("Reals", memoryview(array("d", bytes(8 * size))))


def ints(size: int) -> Ints:
    """A new array of so many zeros, whole numbers."""
    return cast("Ints", array("l", [0]) * size)


def ratio(x: float, y: float) -> float:
    """The quotient of which y may be zero: it is infinite then, or not a number, as IEEE 754 has it.

    Elsewhere ``/`` stands, which Python computes faster.
    """
    if y != 0:
        return x / y
    if x == 0 or math.isnan(x) or math.isnan(y):
        return math.nan
    return math.copysign(math.inf, x) * math.copysign(1.0, y)


def larger(x: float, y: float) -> float:
    """The larger one of two numbers; the other one if one is not a number, as ``fmax`` of C has it."""
    return y if y > x or x != x else x


def sqrt(x: float) -> float:
    """The square root of what is never negative."""
    return math.sqrt(x)


class Failed(Exception):
    """An algorithm ends with a status; its outputs are not used."""

    def __init__(self, status: Status) -> None:
        """The status says why."""
        super().__init__(status.about)
        self.status = status


class ModuleAtState(Protocol):
    """A module of emitted functions, at the arguments that the algorithm's function was called with.

    The functions write their results into arrays that are given in the order of the results. Arguments by
    keyword replace those of the call: ``module.constraints(phi, q=at)`` are the constraints at other
    positions and all else the same. One that reports a status other than OK ends the algorithm with that
    status.

    Attributes:
        NQ, NV: how many positions and velocities.
        NU: how many inputs.
        NC, NP, RANK: how many constraints, how many of position, how many independent.
        NI: how many independent velocities.
        NT: how many directions in which positions change.
        NDX: how many changes the linearised state has.
        mechanical: how many of v are velocities of the mechanics: the states of networks follow them.
        position_rank: how many constraints of position are independent.
        baumgarte: whether constraints are stabilised.
        size: of the algebraic loop.
        quaternions: where quaternions begin in q.
        s_at, w_at: where the independent coordinates are in q, their rates in v.
        d_at: which changes of position are the state of the linearisation.
    """

    NQ: int
    NV: int
    NU: int
    NC: int
    NP: int
    RANK: int
    NI: int
    NT: int
    NDX: int
    mechanical: int
    position_rank: int
    baumgarte: bool
    size: int
    quaternions: tuple[int, ...]
    s_at: tuple[int, ...]
    w_at: tuple[int, ...]
    d_at: tuple[int, ...]

    def coordinate_rates(self, qdot: Reals, **given: Reals) -> None:
        """N(q) v."""

    def mass_matrix(self, M: Reals, **given: Reals) -> None:
        """M."""

    def equations(self, M: Reals, h: Reals, **given: Reals) -> None:
        """M and h."""

    def forward_dynamics(self, a: Reals, *lam: Reals, **given: Reals) -> None:
        """Accelerations, with constraints multipliers, too."""

    def constraints(self, phi: Reals, **given: Reals) -> None:
        """Gaps."""

    def constraint_jacobian(self, J: Reals, **given: Reals) -> None:
        """J."""

    def constraint_rates(self, rates: Reals, **given: Reals) -> None:
        """J v - b."""

    def constraint_bias(self, gam: Reals, **given: Reals) -> None:
        """What J vdot must be."""

    def constraint_sizes(self, of_phi: Reals, of_v: Reals) -> None:
        """Sizes that make J a matrix of pure numbers."""

    def constrained_equations(
        self, M: Reals, f: Reals, J: Reals, gam: Reals, **given: Reals
    ) -> None:
        """All of M vdot = f + J^T lam, J vdot = gam."""

    def constrained_slopes(
        self, slopes_f: Reals, slopes_gam: Reals, slopes_rates: Reals, drift: Reals, **given: Reals
    ) -> None:
        """Derivatives of these equations."""

    def reduction(self, T: Reals, rest: Reals, **given: Reals) -> None:
        """Velocities and accelerations from the independent ones."""

    def loop_equations(self, r: Reals, K: Reals, s: Reals, **given: Reals) -> None:
        """Residuals of the algebraic loop, their Jacobian and the sizes of their terms."""

    def then(self, *results: Any, **given: Reals) -> None:
        """The function that the routine calls last, whose results are its own."""

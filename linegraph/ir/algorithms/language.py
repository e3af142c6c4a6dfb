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
    """The quotient x / y as IEEE 754 defines it; unlike ``/`` in Python, it allows y = 0.

    Where y cannot be zero, algorithms use ``/``, which is faster in Python.

    Args:
        x: the numerator.
        y: the denominator; if it is zero, the result is infinite, or NaN where x is zero or NaN.
    """
    if y != 0:
        return x / y
    if x == 0 or math.isnan(x) or math.isnan(y):
        return math.nan
    return math.copysign(math.inf, x) * math.copysign(1.0, y)


def larger(x: float, y: float) -> float:
    """The larger of two numbers, like ``fmax`` in C.

    Args:
        x: one number; if it is NaN, the result is y.
        y: the other number; if it is NaN, the result is x.
    """
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
    """The emitted functions of a module, called with the arguments of the routine being computed.

    The functions write their results into the arrays passed as positional arguments, in the order of the
    results; matrices are row-major, in SI units. Keyword arguments replace arguments of the routine:
    ``module.constraints(phi, q=at)`` evaluates the constraints at other positions, with all other arguments
    unchanged. If a function returns a status other than OK, the algorithm ends with that status.

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
        """The time derivatives of the positions, qdot = N(q) v.

        Args:
            qdot: written, NQ entries.
            given: arguments that replace those of the routine, here and in the methods below.
        """

    def mass_matrix(self, M: Reals, **given: Reals) -> None:
        """The mass matrix M(q).

        Args:
            M: written, NV x NV, row-major, both triangles.
            given: arguments that replace those of the routine.
        """

    def equations(self, M: Reals, h: Reals, **given: Reals) -> None:
        """Mass matrix and bias of the equations of motion M vdot + h = Q.

        Args:
            M: written, NV x NV, row-major, both triangles.
            h: written, NV generalised forces.
            given: arguments that replace those of the routine.
        """

    def forward_dynamics(self, a: Reals, *lam: Reals, **given: Reals) -> None:
        """The accelerations for given inputs, with constraints also the multipliers.

        Args:
            a: written, NV entries, the derivatives of v.
            lam: written, NC multipliers; omitted if the model has no constraints.
            given: arguments that replace those of the routine.
        """

    def constraints(self, phi: Reals, **given: Reals) -> None:
        """The residuals phi of the position constraints, zero where loops are closed.

        Args:
            phi: written, NP entries.
            given: arguments that replace those of the routine.
        """

    def constraint_jacobian(self, J: Reals, **given: Reals) -> None:
        """The Jacobian of all constraints with respect to the velocities.

        Args:
            J: written, NC x NV, row-major; the position constraints come first.
            given: arguments that replace those of the routine.
        """

    def constraint_rates(self, rates: Reals, **given: Reals) -> None:
        """The residuals of the constraints at velocity level, J v - b.

        Args:
            rates: written, NC entries.
            given: arguments that replace those of the routine.
        """

    def constraint_bias(self, gam: Reals, **given: Reals) -> None:
        """The right-hand side gam of the constraints at acceleration level, J vdot = gam.

        Args:
            gam: written, NC entries.
            given: arguments that replace those of the routine.
        """

    def constraint_sizes(self, of_phi: Reals, of_v: Reals) -> None:
        """Reference values that make J dimensionless, as J_ij of_v_j / of_phi_i.

        Args:
            of_phi: written, NC entries in the units of the constraints.
            of_v: written, NV entries in the units of the velocities.
        """

    def constrained_equations(
        self, M: Reals, f: Reals, J: Reals, gam: Reals, **given: Reals
    ) -> None:
        """All terms of the constrained equations of motion M vdot = f + J^T lam, J vdot = gam.

        Args:
            M: written, NV x NV, row-major, both triangles.
            f: written, NV entries: the generalised forces except those of the constraints.
            J: written, NC x NV, row-major.
            gam: written, NC entries, including stabilisation if the model has any.
            given: arguments that replace those of the routine.
        """

    def constrained_slopes(
        self, slopes_f: Reals, slopes_gam: Reals, slopes_rates: Reals, drift: Reals, **given: Reals
    ) -> None:
        """Derivatives of the constrained equations, for the linearization.

        Args:
            slopes_f: written, NV x (NT + NV + NU), row-major: derivatives of M a - f - J^T lam at given a
                and lam, with respect to changes of position along the velocities, v and u.
            slopes_gam: written, NC x (NT + NV + NU), row-major: the same of J a - gam.
            slopes_rates: written, NC x NT, row-major: derivatives of J v - b by these changes.
            drift: written, NT x NT, row-major: derivatives of the rates of these changes by them.
            given: arguments that replace those of the routine.
        """

    def reduction(self, T: Reals, rest: Reals, **given: Reals) -> None:
        """Velocities and accelerations in terms of the independent ones: v = T w, vdot = T wdot + rest.

        Args:
            T: written, NV x NI, row-major.
            rest: written, NV entries.
            given: arguments that replace those of the routine.
        """

    def loop_equations(self, r: Reals, K: Reals, s: Reals, **given: Reals) -> None:
        """Residuals and Jacobian of the algebraic loop.

        Args:
            r: written, `size` residuals.
            K: written, `size` x `size`, row-major: the Jacobian of r.
            s: written, `size` entries: the magnitudes of the terms of each residual, to judge rounding.
            given: arguments that replace those of the routine; ``loop`` are the unknowns, ``ease`` the
                series resistance and parallel conductance at each law.
        """

    def then(self, *results: Any, **given: Reals) -> None:
        """Call the function named in the routine's details, whose results are those of the routine.

        Args:
            results: written, the results of the routine in their order.
            given: arguments that replace those of the routine.
        """

"""Assembly: a position in which all loops close, and the rank and redundancy of the constraints there.

Newton's method starts from the joints' `start` values and, if that fails, from places around them. The
rank of the Jacobian is the greatest of three: at the position found and at two others nearby that also
close the loops, so that no special position decides.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.algebra.pivoting import apart_columns, free_motions, without_inertia
from linegraph.components.joints import Joint
from linegraph.dynamics.regularity import Idle, link_of
from linegraph.errors import ModelError
from linegraph.numeric.loop_closure import Search, least, quoted
from linegraph.tolerance import CLOSED, DEPENDENT

if TYPE_CHECKING:
    import random
    from collections.abc import Mapping, Sequence

    from linegraph.kinematics.formulated import Formulated
    from linegraph.numeric.reference import Numeric

    Array = Any

ROUNDING = 1e-13
"""A pivot of the mass matrix on the admissible motions below this fraction of its terms is zero."""

OPENING = 2 * CLOSED
"""Greatest singular value of J, in pure numbers, that is still rounding: both ends of a loop may be off by
`CLOSED`."""

INDEPENDENT = (1e-4, 1e-6)
"""Least distance from linear dependence for columns of J that determine the other velocities: the first
value with which enough columns are found."""


@dataclass(frozen=True)
class Assembly:
    """A position that closes all loops, and the constraints there.

    Attributes:
        q: the coordinates.
        rank: the number of independent constraints.
        position_rank: the number of independent constraints among the holonomic ones.
        redundant: the number of constraints that follow from the others.
        freedoms: the degrees of freedom: velocities less independent constraints.
        unique: for each constraint, whether its multiplier is determined.
        independent: velocities that determine all others; the first such set in declared order.
        massless: the joints of admissible motions in which nothing with mass takes part.
    """

    q: list[float]
    rank: int
    position_rank: int
    redundant: int
    freedoms: int
    unique: list[bool]
    independent: list[int]
    massless: tuple[Idle, ...] = ()


def assemble(
    derivation: Formulated,
    hold: Mapping[str, float] | None = None,
    seed: int = 0,
    start: Sequence[float] | None = None,
) -> Assembly:
    """Find a position that closes all loops, at t = 0 and with all inputs zero.

    Args:
        derivation: a system with its trees.
        hold: coordinates to keep at given values, by name (rad or m).
        seed: of the random places that are tried if the start fails.
        start: all coordinates to start from, instead of the joints' `start` values.

    Raises:
        ModelError: there is no such position, or prescribed motions contradict each other; names the
            edges.
    """
    search = Search(derivation, dict(hold or {}), seed)
    return _Judgement(search).of(search.position(start))


def consistent(
    derivation: Formulated, near: Sequence[float], numeric: Numeric, draw: random.Random
) -> tuple[list[float], list[float]]:
    """A random state that satisfies the constraints, near the assembly.

    Args:
        derivation: a system with constraints.
        near: coordinates near which its loops close.
        numeric: its equations at the required time, inputs and parameters.
        draw: source of randomness.

    Returns:
        q and v. The velocity is the nearest admissible one, in pure numbers, to a random vector.
    """
    search = Search(derivation, {}, draw.randrange(2**31), numeric)
    near = list(near)
    search.close(near)
    beside = search.beside(near, 0.2) or search.beside(near, 0.05)
    q = near if beside is None else beside
    v = [draw.uniform(-1, 1) * float(x) for x in search.of_velocities]
    step = least(search.jacobian(q), search.rates(q, v)) * search.of_velocities
    return q, [float(x - dx) for x, dx in zip(v, step, strict=True)]


def saddle(
    M: Sequence[Sequence[float]],
    right: Sequence[float],
    J: Sequence[Sequence[float]],
    bias: Sequence[float],
) -> tuple[list[float], list[float]]:
    """Accelerations and multipliers of a constrained system: ``M v̇ = right + Jᵀ λ``, ``J v̇ = bias``.

    If constraints are redundant, λ is not unique. Least squares then choose the λ of least norm, which
    does not depend on the order of the constraints, as dropping some of them would.

    Args:
        M: mass matrix, n x n.
        right: Q - h, n entries.
        J: constraints x n.
        bias: γ, one entry per constraint.
    """
    import numpy

    n, m = len(right), len(bias)
    rows = numpy.zeros((n + m, n + m))
    rows[:n, :n] = M
    rows[n:, :n] = numpy.array(J, float).reshape(m, n)
    # -Jᵀ, so that λ has the sign of M v̇ = right + Jᵀ λ
    rows[:n, n:] = -rows[n:, :n].T
    found = numpy.linalg.lstsq(rows, numpy.array([*right, *bias], float), rcond=1e-11)[0]
    return found[:n].tolist(), found[n:].tolist()


class _Judgement:
    """Rank, redundancy and consistency of the constraints, over floats."""

    def __init__(self, search: Search) -> None:
        self.search = search
        self.np = search.np
        self.numeric = search.numeric
        self.tree = search.tree
        self.equations = search.equations
        self.derivation = search.derivation

    def of(self, q: list[float]) -> Assembly:
        """The assembly at a position, with the constraints judged around it."""
        np = self.np
        # three positions: at a special one, such as a stretched linkage, the rank is lower than elsewhere
        places = [q, *(x for _ in range(2) if (x := self.search.beside(q)) is not None)]
        best = max(self._rank_at(place) for place in places)
        at = next(place for place in places if self._rank_at(place) == best)
        J = self.search.jacobian(at)
        self._require_decided(J, best)
        rows, columns = J.shape
        left = np.linalg.svd(J)[0][:, best:] if rows and columns else np.zeros((rows, 0))
        # `left` spans the null space of Jᵀ, the self-stresses: λ_k is unique if none has an entry there
        unique = [bool(np.abs(left[k]).max(initial=0.0) < 1e-6) for k in range(rows)]
        self._require_consistent(at, J, left)
        independent = self._independent(J, best)
        motions = [self._massless(place, best) for place in places]
        massless = self._idle(motions[0]) if all(motions) else ()
        position_rank = self._rank_of(J[: sum(e.holonomic for e in self.equations)])
        place = [float(x) for x in q]
        counts = (best, position_rank, rows - best, self.tree.layout.mechanical - best)
        return Assembly(place, *counts, unique, independent, massless)

    def _require_decided(self, J: Array, rank: int) -> None:
        """Refuse loops that close in one position and open in motion, by a gap too small to resist it."""
        left, values, _ = self.np.linalg.svd(J)
        opening = float(max(values[rank:], default=0.0))
        if opening <= OPENING:
            return
        row = int(abs(left[:, rank]).argmax())
        worst = self.equations[row]
        size = self.search.sizes.constraints[row]
        gap = f"{opening * size:.2g} m" if worst.multiplier.unit == "N" else f"{opening:.2g} rad"
        circuit = " - ".join(self.derivation.circuit_of(worst.component))
        problem = (
            f"closes the circuit {circuit} where it stands, but a gap of {gap} opens for every radian "
            "(or length of the loop) that it moves: too little to hold it, too much for rounding. "
            "Give axes and places that are to agree with all their digits"
        )
        raise ModelError(self.search.who(worst.component), problem)

    def _independent(self, J: Array, rank: int) -> list[int]:
        """Velocities to keep: the last declared become dependent as long as constraints determine them."""
        count = self.tree.layout.mechanical
        for apart in INDEPENDENT:
            dependent = apart_columns(J, list(reversed(range(count))), rank, apart)
            if len(dependent) == rank:
                return sorted(set(range(count)) - set(dependent))
        return []

    def _require_consistent(self, q: list[float], J: Array, left: Array) -> None:
        """Refuse prescribed motions that contradict each other."""
        np = self.np
        v = [0.0] * len(self.tree.velocities)
        joints = {n for n, end in self.tree.ends.items() if isinstance(end.component, Joint)}
        for t in (self.numeric.t, self.numeric.t + 0.37):
            numeric = self.numeric.at_time(t)
            rates = -self.search.rates(q, v, numeric)
            # dependent rows need dependent rates; at two times, since rates may agree by chance at one
            amiss = np.abs(left.T @ rates)
            if amiss.max(initial=0.0) > 1e-6 * np.abs(rates).max(initial=0.0):
                worst = left[:, int(amiss.argmax())]
                names = dict.fromkeys(
                    e.component
                    for e, x in zip(self.equations, worst, strict=True)
                    if abs(x) > 1e-3 * np.abs(worst).max()
                )
                driven = [n for name in names for n in self._driven_with(name)]
                plain = [n for n in names if n in joints and not any(self.tree.ends[n].drive)]
                whole = [n for n in dict.fromkeys([*names, *driven]) if n not in plain]
                whole = whole or list(names)
                problem = f"is over-driven: {quoted(whole)} contradict each other; free one of them"
                raise ModelError(self.search.who(whole[0]), problem)

    def _massless(self, q: list[float], rank: int) -> list[int]:
        """The velocities in admissible motions in which nothing with mass takes part."""
        np, count = self.np, self.tree.layout.mechanical
        sizes = self.search.of_velocities[:count]
        M = np.array(self._inertia(q), float) * sizes * sizes[:, None]
        allowed = free_motions(self.search.jacobian(q)[:, :count], rank)
        found: set[int] = set()
        for motion in without_inertia(M, allowed, ROUNDING):
            found.update(np.flatnonzero(np.abs(motion) > 1e-6 * np.abs(motion).max()).tolist())
        return sorted(found)

    def _inertia(self, q: list[float]) -> list[list[float]]:
        """M of mechanics, including the entries of networks if they are defined there."""
        size = self.tree.layout.mechanical
        try:
            return [row[:size] for row in self.numeric.mass_matrix(q)[:size]]
        except (ModelError, ArithmeticError):
            return self.numeric.mechanical_mass_matrix(q)

    def _idle(self, velocities: Sequence[int]) -> tuple[Idle, ...]:
        """The joints of some velocities, each once."""
        links = {link.name: link for link in (link_of(self.tree, k) for k in velocities)}
        return tuple(Idle("joint", link.joint.name, name) for name, link in links.items())

    def _driven_with(self, chord: str) -> list[str]:
        """The prescribed joints in the circuit of a chord."""
        return [
            name
            for name in self.derivation.circuit_of(chord)[:-1]
            if name in self.tree.ends and any(self.tree.ends[name].drive)
        ]

    def _rank_at(self, q: list[float]) -> int:
        return self._rank_of(self.search.jacobian(q))

    def _rank_of(self, J: Array) -> int:
        return int((self.np.linalg.svd(J, compute_uv=False) > DEPENDENT).sum())

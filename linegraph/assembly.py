"""Assembly: a position in which all loops close, and what the constraints are worth there.

Newton's method from the joints' `start` values, and where that fails from places around them. At what it
finds, and at two places near it that close the loops too, the Jacobian tells how many constraints are
independent: no special position decides.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.closure import equations
from linegraph.errors import ModelError
from linegraph.joints import Joint
from linegraph.joints.base import BY_INPUT
from linegraph.layout import coordinates

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.closure import Chords, Equation
    from linegraph.derive import Derivation, Numeric
    from linegraph.kinematics import Closure, KinematicTree

    Array = Any

TRIES = 60
STEPS = 60
CLOSED = 1e-11
LARGEST_STEP = 0.6
DEPENDENT = 1e-8
"""A singular value of the scaled Jacobian below this fraction of the largest is zero."""


@dataclass(frozen=True)
class Assembly:
    """A position that closes all loops.

    Attributes:
        q: the coordinates.
        rank: the number of independent constraints.
        position_rank: how many of those that have an equation of position are independent.
        redundant: how many constraints follow from the others.
        freedoms: the degrees of freedom: velocities less independent constraints.
        unique: for each constraint whether its multiplier is the only one possible.
        independent: velocities that the others follow from; the first such set in declared order.
    """

    q: list[float]
    rank: int
    position_rank: int
    redundant: int
    freedoms: int
    unique: list[bool]
    independent: list[int]


def assemble(
    derivation: Derivation,
    hold: Mapping[str, float] | None = None,
    seed: int = 0,
    start: Sequence[float] | None = None,
) -> Assembly:
    """Find a position that closes all loops, at t = 0 and with inputs zero.

    Args:
        derivation: a model.
        hold: coordinates that keep the value given, by name.
        seed: of the places tried where the start does not lead to one.
        start: where to begin instead of the joints' `start` values.

    Raises:
        ModelError: there is none, or what is prescribed contradicts itself; names the edges.
    """
    search = _Search(derivation, dict(hold or {}), seed)
    return search.judged(search.position(start))


def consistent(
    derivation: Derivation, numeric: Numeric, draw: random.Random
) -> tuple[list[float], list[float]]:
    """A random state that satisfies the constraints, near the assembly.

    Args:
        derivation: a model with constraints.
        numeric: it at the time and for the inputs and parameters wanted.
        draw: where randomness comes from.
    """
    search = _Search(derivation, {}, draw.randrange(2**31), numeric)
    start = derivation.assembled.q
    near = list(start)
    search.close(near)
    beside = search.beside(near, 0.2) or search.beside(near, 0.05)
    q = near if beside is None else beside
    v = [draw.uniform(-1, 1) for _ in search.tree.velocities]
    rates = search.np.array(numeric.constraint_rates(q, v), float)
    J = search.np.array(numeric.constraint_jacobian(q), float).reshape(len(rates), len(v))
    step = search.np.linalg.lstsq(J, rates, rcond=DEPENDENT)[0]
    return q, [float(x - dx) for x, dx in zip(v, step, strict=True)]


def saddle(
    M: Sequence[Sequence[float]],
    right: Sequence[float],
    J: Sequence[Sequence[float]],
    bias: Sequence[float],
) -> tuple[list[float], list[float]]:
    """v̇ and λ of ``M v̇ = right + J^T λ``, ``J v̇ = bias``, λ of least norm where it is not unique."""
    import numpy

    n, m = len(right), len(bias)
    rows = numpy.zeros((n + m, n + m))
    rows[:n, :n] = M
    rows[n:, :n] = numpy.array(J, float).reshape(m, n)
    rows[:n, n:] = -rows[n:, :n].T
    found = numpy.linalg.lstsq(rows, numpy.array([*right, *bias], float), rcond=1e-11)[0]
    return found[:n].tolist(), found[n:].tolist()


class _Search:
    """One search, over floats."""

    def __init__(
        self,
        derivation: Derivation,
        hold: dict[str, float],
        seed: int,
        numeric: Numeric | None = None,
    ) -> None:
        import numpy

        self.np = numpy
        self.derivation = derivation
        self.draw = random.Random(seed)
        self.numeric: Numeric = numeric or derivation.numeric()
        self.tree: KinematicTree = self.numeric.tree
        self.equations = equations(self.tree)
        names = [quantity.name for quantity in self.tree.positions]
        for name in hold:
            if name not in names:
                known = ", ".join(names[:8])
                raise ModelError(f'coordinate "{name}"', f"is none of this tree; known: {known}")
        self.held = {names.index(name): float(value) for name, value in hold.items()}
        held = [e for e in self.equations if e.holonomic]
        # what an input prescribes is wherever that input says: any position will do
        self.sought = [k for k, e in enumerate(held) if not self._by_input(e)]

    def _by_input(self, equation: Equation) -> bool:
        """Whether a constraint prescribes a motion that comes from inputs."""
        closure = self.tree.ends[equation.component]
        component = closure.component
        if isinstance(component, Joint):
            q = component.positions()
            drive = component.drive
            given = list(drive) if isinstance(drive, (tuple, list)) else [drive] * len(q)
        else:
            given = [x for x, _ in component.prescribed() if x is not None]
        place = equation.place - len(closure.restrictions)
        return 0 <= place < len(given) and given[place] == BY_INPUT

    def position(self, given: Sequence[float] | None) -> list[float]:
        """The first place found."""
        start = self._start() if given is None else list(given)
        best: tuple[float, list[float]] | None = None
        for attempt in range(TRIES):
            spread = 0.0 if attempt == 0 else 0.1 * attempt
            q = [x + self.draw.uniform(-spread, spread) for x in start]
            for k, value in self.held.items():
                q[k] = value
            try:
                gap = self.close(q)
                if gap < CLOSED and not self._flipped(q):
                    return q
            except (ArithmeticError, ValueError, ModelError):
                continue  # two ends of a rod coincide, or the like: begin elsewhere
            if best is None or gap < best[0]:
                best = (gap, q)
        raise self._refusal(best[1] if best else None)

    def judged(self, q: list[float]) -> Assembly:
        """The position with what the constraints are worth around it."""
        np = self.np
        places = [q, *(x for _ in range(2) if (x := self.beside(q)) is not None)]
        best = max(self._rank(place) for place in places)
        at = next(place for place in places if self._rank(place) == best)
        J = self._jacobian(at)
        rows, columns = J.shape
        left = np.linalg.svd(J)[0][:, best:] if rows and columns else np.zeros((rows, 0))
        unique = [bool(np.abs(left[k]).max(initial=0.0) < 1e-6) for k in range(rows)]
        self._require_consistent(at, J, left)
        independent = self._independent(J, best)
        massless = [self._massless(place, best) for place in places]
        if all(massless):
            raise _no_inertia(massless[0] or [])
        position_rank = self._rank_of(J[: sum(e.holonomic for e in self.equations)])
        place = [float(x) for x in q]
        counts = (best, position_rank, rows - best, columns - best)
        return Assembly(place, *counts, unique, independent)

    # -- Newton's method

    def _start(self) -> list[float]:
        """The joints' start values, at rest where there are none."""
        q = [0.0] * len(self.tree.positions)
        resolve = self.numeric.resolve
        for link in self.tree.links:
            places = [freedom.index for freedom in link.place.positions]
            joint = link.joint
            if len(places) != len(joint.rest()) or not places:
                continue
            given = joint.rest() if joint.start is None else joint.start
            values = list(given) if isinstance(given, (tuple, list)) else [given]
            for place, freedom, value in zip(places, link.place.positions, values, strict=False):
                if freedom.ratio == 1:
                    q[place] = float(resolve(value))
        self._measured_from_ground(q)
        return q

    def _measured_from_ground(self, q: list[float]) -> None:
        """Start values are the joints' own: add what their near bodies have turned."""
        for link in self.tree.links:
            if link.place.less[0]:
                (own,) = link.place.positions
                at, _ = coordinates(link.place, tuple(q), (0.0,) * len(self.tree.velocities))
                q[own.index] += q[own.index] - at[0]

    def close(self, q: list[float]) -> float:
        """Move q onto the constraints as far as that goes; the largest violation that remains."""
        np = self.np
        self.tree.normalise(q)
        phi = self._position(q)
        gap = float(np.abs(phi).max(initial=0.0))
        for _ in range(STEPS):
            if gap < CLOSED * 1e-3:
                break
            J = self._jacobian(q)[self.sought]
            step = -np.linalg.lstsq(J, phi, rcond=1e-10)[0]
            largest = float(np.abs(step).max(initial=0.0))
            step *= min(1.0, LARGEST_STEP / max(largest, 1e-300))
            for _ in range(12):
                moved = self._moved(q, step)
                ahead = self._position(moved)
                if np.linalg.norm(ahead) < np.linalg.norm(phi):
                    break
                step /= 2
            else:
                break
            q[:], phi = moved, ahead
            gap = float(np.abs(phi).max(initial=0.0))
        return gap

    def _moved(self, q: list[float], step: Any) -> list[float]:
        """``q + N(q) step``."""
        rates = self.numeric.coordinate_rates(q, list(step))
        moved = [x + dx for x, dx in zip(q, rates, strict=True)]
        for k, value in self.held.items():
            moved[k] = value
        self.tree.normalise(moved)
        return moved

    def _position(self, q: list[float]) -> Any:
        return self.np.array(self.numeric.constraints(q), float)[self.sought]

    def _jacobian(self, q: list[float]) -> Any:
        """J, held coordinates left out of it."""
        J = self.np.array(self.numeric.constraint_jacobian(q), float)
        J = J.reshape(len(self.equations), len(self.tree.velocities))
        for link in self.tree.links:
            for at, rate in zip(link.place.positions, link.velocities, strict=False):
                if at.index in self.held:
                    J[:, rate.index] = 0.0
        return J

    def _flipped(self, q: list[float]) -> bool:
        """Whether a chord stands the wrong way round: its equations hold for axes against each other, too."""
        chords = self.numeric.chords(q, [0.0] * len(self.tree.velocities))
        return any(self._turned_over(closure, chords) for closure in self.tree.closures)

    def _turned_over(self, closure: Closure, chords: Chords) -> bool:
        joint = closure.component
        if not isinstance(joint, Joint) or not closure.restrictions:
            return False
        rotation, displacement = chords.seen(joint.name)
        try:
            at = joint.measured(self.numeric.algebra, rotation, displacement)
        except ModelError:
            return False
        motion = joint.motion(self.numeric.algebra, at, (0.0,) * joint.freedoms)
        differences = (
            abs(a - b)
            for mine, given in zip(motion.rotation.matrix(), rotation, strict=True)
            for a, b in zip(mine, given, strict=True)
        )
        return bool(max(differences) > 1e-6)

    # -- what is found there

    def beside(self, q: list[float], spread: float = 0.05) -> list[float] | None:
        """Another place that closes the loops, near the first."""
        near = [x + self.draw.uniform(-spread, spread) for x in q]
        for k, value in self.held.items():
            near[k] = value
        try:
            return near if self.close(near) < CLOSED and not self._flipped(near) else None
        except (ArithmeticError, ValueError, ModelError):
            return None

    def _rank(self, q: list[float]) -> int:
        return self._rank_of(self._jacobian(q))

    def _rank_of(self, J: Array) -> int:
        values = self.np.linalg.svd(J, compute_uv=False)
        return int((values > DEPENDENT * values.max(initial=0.0)).sum())

    def _independent(self, J: Array, rank: int) -> list[int]:
        """Velocities to keep: those declared last give way as long as the constraints determine them."""
        np = self.np
        scale = np.abs(J).max(initial=1e-300)
        dependent: list[int] = []
        for k in reversed(range(J.shape[1])):
            if len(dependent) == rank:
                break
            columns = J[:, [*dependent, k]] / scale
            if np.linalg.svd(columns, compute_uv=False).min() > 1e-4:
                dependent.append(k)
        if len(dependent) < rank:
            return []
        return sorted(set(range(J.shape[1])) - set(dependent))

    def _require_consistent(self, q: list[float], J: Array, left: Array) -> None:
        """Refuse prescribed motions that contradict each other."""
        np = self.np
        v = [0.0] * len(self.tree.velocities)
        for t in (self.numeric.t, self.numeric.t + 0.37):
            numeric = self.numeric.at(t)
            rates = -np.array(numeric.constraint_rates(q, v), float)
            amiss = np.abs(left.T @ rates)
            if amiss.max(initial=0.0) > 1e-6 * (1 + np.abs(rates).max(initial=0.0)):
                worst = left[:, int(amiss.argmax())]
                names = dict.fromkeys(
                    e.component
                    for e, x in zip(self.equations, worst, strict=True)
                    if abs(x) > 1e-3 * np.abs(worst).max()
                )
                problem = (
                    f"over-driven: what they prescribe contradicts itself ({', '.join(names)}); "
                    "free one of them"
                )
                raise ModelError(f"constraints {_quoted(names)}", problem)

    def _massless(self, q: list[float], rank: int) -> list[str] | None:
        """The velocities of a motion that the constraints allow and nothing with mass takes part in."""
        np = self.np
        J = self._jacobian(q)
        M = np.array(self.numeric.mass_matrix(q), float)
        allowed = np.linalg.svd(J)[2][rank:].T if len(J) else np.eye(len(M))
        if not allowed.shape[1]:
            return None
        values, vectors = np.linalg.eigh(allowed.T @ M @ allowed)
        if values[0] > 1e-12 * max(np.abs(M).max(), 1e-300):
            return None
        motion = np.abs(allowed @ vectors[:, 0])
        pairs = zip(self.tree.velocities, motion, strict=True)
        return [quantity.name for quantity, x in pairs if x > 0.1 * motion.max()]

    def _refusal(self, q: list[float] | None) -> ModelError:
        """What to tell where no position closes the loops: the worst chord and its circuit."""
        if q is None:
            names = dict.fromkeys(e.component for e in self.equations)
            problem = "are not defined at any position tried; give `start` values near one"
            return ModelError(f"constraints {_quoted(names)}", problem)
        phi = self.np.abs(self._position(q))
        worst = self.equations[self.sought[int(phi.argmax())]]
        circuit = self.derivation.circuit_of(worst.component)
        kind = self.tree.ends[worst.component].component.kind
        held = f" with {_quoted([self.tree.positions[k].name for k in self.held])} held" * bool(
            self.held
        )
        problem = (
            f"closes the circuit {' - '.join(circuit)}, which cannot be assembled{held}: a gap of "
            f"{phi.max():.3g} remains. Check lengths and axes, or give `start` values near a position"
        )
        who = "joint" if isinstance(self.tree.ends[worst.component].component, Joint) else kind
        return ModelError(f'{who} "{worst.component}"', problem)


def _no_inertia(names: Sequence[str]) -> ModelError:
    problem = (
        "moves no inertia that the loops allow to move: the mass matrix is singular there. Give the "
        "bodies mass and inertia"
    )
    return ModelError(f"motion of {_quoted(names)}", problem)


def _quoted(names: Sequence[str] | Mapping[str, Any]) -> str:
    return ", ".join(f'"{name}"' for name in names)

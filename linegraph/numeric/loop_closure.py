"""The search for a position that closes all loops, by Newton's method over floats."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, Any

from linegraph.components.joints import Joint
from linegraph.components.joints.base import BY_INPUT
from linegraph.dynamics.chords import equations
from linegraph.dynamics.circuit_lengths import of_rows, pure
from linegraph.errors import ModelError
from linegraph.kinematics.state_layout import NOT_SMOOTH, coordinates
from linegraph.numeric.reference import over_floats
from linegraph.tolerance import CLOSED, DEPENDENT

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.dynamics.chords import ChordEquation, Chords
    from linegraph.kinematics.formulated import Formulated
    from linegraph.kinematics.links import Closure, KinematicTree
    from linegraph.numeric.reference import Numeric

TRIES = 24
STEPS = 50
LARGEST_STEP = 0.6
"""Greatest step of a coordinate: in rad for angles, as a fraction of the loop's length for translations."""

STILL = 1e-14
"""A gap below this fraction of the loop's length is rounding; further steps would change nothing."""


class Search:
    """A search for positions that close all loops.

    Args:
        derivation: a system with its trees.
        hold: coordinates to keep at given values, by name (rad or m).
        seed: of the random places that are tried if the start fails.
        numeric: the equations over floats; by default at t = 0 and with all inputs zero.

    Raises:
        ModelError: a coordinate to hold does not exist.
    """

    def __init__(
        self,
        derivation: Formulated,
        hold: dict[str, float],
        seed: int,
        numeric: Numeric | None = None,
    ) -> None:
        """Measure the loops and the held coordinates; no position is tried yet."""
        import numpy

        self.np = numpy
        self.derivation = derivation
        self.draw = random.Random(seed)
        self.numeric: Numeric = numeric or at_some_time(derivation)
        self.tree: KinematicTree = self.numeric.tree
        self.equations = equations(self.tree)
        names = [quantity.name for quantity in self.tree.positions]
        for name in hold:
            if name not in names:
                known = ", ".join(names[:8])
                raise ModelError(f'coordinate "{name}"', f"is none of this tree; known: {known}")
        self.held = {names.index(name): float(value) for name, value in hold.items()}
        held = [e for e in self.equations if e.holonomic]
        # a motion prescribed by input may be anywhere: its constraints are ignored unless inputs are given
        moved = numeric is not None
        self.sought = [k for k, e in enumerate(held) if moved or not self._by_input(e)]
        self.sizes = self.numeric.sizes
        self.of_velocities = numpy.array(self.sizes.velocities, float)
        self.of_positions = self._of_positions()

    def _of_positions(self) -> list[float]:
        """The unit of each coordinate: 1, or the length of its loop (m)."""
        found = [1.0] * len(self.tree.positions)
        for link in self.tree.links:
            length = max((self.of_velocities[f.index] for f in link.velocities), default=1.0)
            for freedom in link.place.positions:
                if self.tree.positions[freedom.index].unit == "m":
                    found[freedom.index] = float(length)
        return found

    def _by_input(self, equation: ChordEquation) -> bool:
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
        """The first position found that closes all loops.

        Raises:
            ModelError: none was found; names the chord with the largest gap and its circuit.
        """
        start = self._start() if given is None else list(given)
        best: tuple[float, list[float]] | None = None
        undefined: ModelError | None = None
        for attempt in range(TRIES):
            spread = 0.0 if attempt == 0 else 0.1 * attempt
            q = self._around(start, spread)
            for k, value in self.held.items():
                q[k] = value
            try:
                gap = self.close(q)
                if gap < CLOSED and not self._flipped(q):
                    return q
            except (ArithmeticError, ValueError):
                continue  # undefined there, e.g. both ends of a rod coincide: start elsewhere
            except ModelError as error:
                undefined = error
                continue
            if best is None or gap < best[0]:
                best = (gap, q)
        if best is None and undefined is not None:
            raise undefined
        raise self._refusal(best[1] if best else None)

    def _around(self, q: Sequence[float], spread: float) -> list[float]:
        """A random place near another one."""
        sizes = self.of_positions
        return [x + self.draw.uniform(-spread, spread) * s for x, s in zip(q, sizes, strict=True)]

    def _start(self) -> list[float]:
        """The joints' start values, or rest positions if there are none."""
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
        """Add the near bodies' angles to start values, which are the joints' own."""
        for link in self.tree.links:
            if link.place.less[0]:
                (own,) = link.place.positions
                at, _ = coordinates(link.place, tuple(q), (0.0,) * len(self.tree.velocities))
                q[own.index] += q[own.index] - at[0]

    def close(self, q: list[float]) -> float:
        """Move q onto the constraints as far as possible, in place; the largest remaining gap.

        Gauss-Newton steps of least norm, halved until the gaps decrease. The gap is in pure numbers
        (rad, or fractions of the loop's length).
        """
        np = self.np
        self.tree.normalise(q)
        phi = self._position(q)
        gap = float(np.abs(phi).max(initial=0.0))
        for _ in range(STEPS):
            if gap < STILL:
                break
            step = -least(self.jacobian(q)[self.sought], phi)
            largest = float(np.abs(step).max(initial=0.0))
            step *= min(1.0, LARGEST_STEP / max(largest, 1e-300))
            # far from a solution a full Newton step may enlarge the gaps: halve it until they shrink
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
        """``q + N(q) step``, with the step in pure numbers."""
        rates = self.numeric.coordinate_rates(q, list(step * self.of_velocities))
        moved = [x + dx for x, dx in zip(q, rates, strict=True)]
        for k, value in self.held.items():
            moved[k] = value
        self.tree.normalise(moved)
        return moved

    def _position(self, q: list[float]) -> Any:
        """The gaps in pure numbers."""
        np, sizes = self.np, self.sizes.constraints
        gaps = np.array(self.numeric.constraints(q), float)
        return (gaps / np.array(sizes[: len(gaps)], float))[self.sought]

    def rates(self, q: list[float], v: list[float], numeric: Numeric | None = None) -> Any:
        """Residuals ``J v - b`` of the constraints of velocity in pure numbers (1/s).

        Args:
            q: the coordinates.
            v: the velocities.
            numeric: equations at another time; by default those of the search.
        """
        rates = self.np.array((numeric or self.numeric).constraint_rates(q, v), float)
        return rates / of_rows(self._rows(q), self.sizes)

    def _rows(self, q: list[float]) -> Any:
        J = self.np.array(self.numeric.constraint_jacobian(q), float)
        return J.reshape(len(self.equations), len(self.tree.velocities))

    def jacobian(self, q: list[float]) -> Any:
        """J in pure numbers, with zero columns for held coordinates."""
        J = pure(self._rows(q), self.sizes)
        for link in self.tree.links:
            for at, rate in zip(link.place.positions, link.velocities, strict=False):
                if at.index in self.held:
                    J[:, rate.index] = 0.0
        return J

    def _flipped(self, q: list[float]) -> bool:
        """Whether a chord is assembled the wrong way round: its equations also hold for opposite axes."""
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

    def beside(self, q: list[float], spread: float = 0.05) -> list[float] | None:
        """Another position that closes the loops, near the first; None if the attempt fails.

        Args:
            q: the first position.
            spread: greatest change of each coordinate, in pure numbers, before the loops are closed
                again.
        """
        near = self._around(q, spread)
        for k, value in self.held.items():
            near[k] = value
        try:
            return near if self.close(near) < CLOSED and not self._flipped(near) else None
        except (ArithmeticError, ValueError, ModelError):
            return None

    def _refusal(self, q: list[float] | None) -> ModelError:
        """The error if no position closes the loops: the chord with the largest gap, and its circuit."""
        if q is None:
            names = dict.fromkeys(e.component for e in self.equations)
            problem = "are not defined at any position tried; give `start` values near one"
            return ModelError(f"constraints {quoted(names)}", problem)
        worst, gap = self._gap(self._nearest(q))
        circuit = self.derivation.circuit_of(worst)
        held = f" with {quoted([self.tree.positions[k].name for k in self.held])} held" * bool(
            self.held
        )
        problem = (
            f"closes the circuit {' - '.join(circuit)}, which cannot be assembled{held}: a gap of "
            f"{gap} remains at least. Check lengths and axes, or give `start` values near a position"
        )
        return ModelError(self.who(worst), problem)

    def _nearest(self, q: list[float]) -> list[float]:
        """A position at which the gaps are least, by the Levenberg-Marquardt method [Marquardt 1963].

        Newton's method stops wherever its step no longer reduces the gaps; that position may be far
        from the least gap, which the message should report.
        """
        np, damping = self.np, 1e-3
        phi = self._position(q)
        for _ in range(400):
            J = self.jacobian(q)[self.sought]
            normal = J.T @ J + damping * np.eye(J.shape[1])
            moved = self._moved(q, -np.linalg.solve(normal, J.T @ phi))
            ahead = self._position(moved)
            if not np.linalg.norm(ahead) < np.linalg.norm(phi):
                damping *= 4
                if damping > 1e9:
                    break
                continue
            q, phi, damping = moved, ahead, damping / 3
        return q

    def _gap(self, q: list[float]) -> tuple[str, str]:
        """The chord with the largest gap, and the gap: a distance, or an angle if that is larger."""
        phi = self._position(q)
        gaps: dict[tuple[str, bool], list[float]] = {}
        lengths: dict[str, float] = {}
        for x, k in zip(phi, self.sought, strict=True):
            equation = self.equations[k]
            far = equation.multiplier.unit == "N"
            gaps.setdefault((equation.component, far), []).append(float(x))
            if far:
                lengths[equation.component] = float(self.sizes.constraints[k])
        (name, far), entries = max(
            gaps.items(), key=lambda item: float(self.np.hypot.reduce(item[1]))
        )
        size = float(self.np.hypot.reduce(entries))
        return name, f"{size * lengths[name]:.3g} m" if far else f"{size:.3g} rad"

    def who(self, name: str) -> str:
        """Kind and name of a joint or constraint, as messages give them."""
        end = self.tree.ends.get(name)
        if end is None:
            return f'relation "{name}"'
        kind = "joint" if isinstance(end.component, Joint) else end.component.kind
        return f'{kind} "{name}"'


def least(J: Any, right: Any) -> Any:
    """The x of least norm that minimises ``|J x - right|``.

    Singular values below `DEPENDENT` count as zero. J must be in pure numbers, since a threshold is
    meaningless for a matrix of mixed units.

    Args:
        J: array, constraints x velocities, in pure numbers.
        right: array, one entry per constraint.
    """
    import numpy as np

    left, values, along = np.linalg.svd(J, full_matrices=False)
    kept = values > DEPENDENT
    return along[kept].T @ ((left[:, kept].T @ right) / values[kept])


def at_some_time(derivation: Formulated) -> Numeric:
    """The numeric reference at t = 0, or later if motions have no derivatives there."""
    try:
        return over_floats(derivation)
    except ModelError as error:
        bounds = derivation.system.bounds
        if not error.problem.endswith(NOT_SMOOTH) and bounds.t is None:
            raise
        return over_floats(derivation, t=bounds.sometime)


def quoted(names: Sequence[str] | Mapping[str, Any]) -> str:
    """Names in double quotes, separated by commas."""
    return ", ".join(f'"{name}"' for name in names)

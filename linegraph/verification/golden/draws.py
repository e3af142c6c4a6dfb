"""Random states at which a model is compared: admissible, regular, and within the user's bounds.

Quaternions have length 1, loops are closed and velocities obey the constraints, every law is defined, and M
is not nearly singular. At every second state the parameters differ from the model's own values; otherwise
two parameters of equal value could be exchanged unnoticed.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.components.validation import nearest
from linegraph.dynamics.chords import equations
from linegraph.errors import ModelError
from linegraph.numeric.assembly import consistent
from linegraph.verification.golden.blame import undefined
from linegraph.verification.golden.loudness import CALM, acting, even, loudest, quietest
from linegraph.verification.golden.point import Kept, Point

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from linegraph.ir.program import Quantity
    from linegraph.model.bounds import Interval
    from linegraph.numeric.derived import Derived
    from linegraph.numeric.reference import Numeric
    from linegraph.verification.golden.walk import Valued

STATES = 10
"""Number of states, the one at rest included."""

TRIES = 40
"""Number of draws for one state before giving up."""

DIGITS = 14
"""Significant digits written to files: rounding to these is far below the tolerance."""

REACHES = (1.0, 0.3, 0.1, 0.03)
"""Largest states of networks and inputs, tried in this order until all states are usable."""

REGULAR = 1e4
"""Largest ratio of the terms of accelerations to accelerations; beyond it M counts as nearly singular."""

SOLVED = ("a", "A", "B", "da_dq", "da_dv", "da_du", "da_dp", "Lambda", "R", "D", "P", "y")
"""Results that are solved for with M."""

APART = (0.8, 1.25)
"""Range of factors on the model's own values from which parameters are drawn."""

SLOW, SLOW_AT = 1e-3, 4
"""Factor on velocities at one state, so small that dry friction has not saturated; that state's index."""

RATES = ("m/s", "rad/s")
"""Units of those states of networks that are velocities."""

GAP = 1e-9
"""Largest error of a constraint at an admissible state, for lengths and angles of size 1."""

LITTLE = 0.1
"""Value for a parameter that is zero, relative to the least of its unit: small, so that inertias stay
possible.
"""

LOCKED = 1e-13
"""Velocities below this fraction of the largest, or of 1, are rounding of velocities that constraints lock.
"""

BESIDE = 0.02
"""Distance of guesses from positions, small enough that Newton's iteration returns to these positions."""

SINGULAR = "no state was found at which all laws are defined and M is regular"

Asked = dict[str, "Callable[[Point], Valued]"]
"""Results of a function by name, and how to compute each at a point."""


@dataclass(frozen=True)
class Drawing:
    """A source of random states of a model.

    Attributes:
        derivation: the model.
        draw: the random number generator.
        kept: indices of the independent variables under constraints.
        chosen: for each function that must be defined at the states, its results.
        varied: whether parameters with a value may be varied: True if the functions take them as an
            argument.
    """

    derivation: Derived
    draw: random.Random
    kept: Kept
    chosen: Sequence[Asked]
    varied: bool = True

    def points(self, count: int = STATES) -> list[Point]:
        """Draw all states, those of networks so near zero that no exponential law dominates.

        Args:
            count: how many states.

        Returns:
            The states. Where states had to be nearer zero than 1, further ones are appended: one loud state
            for each reach that was too far, so that diodes conduct at some states.

        Raises:
            ModelError: a law is defined at no state that was tried, M is singular at all of them, or the
                bounds name a quantity that does not exist.
        """
        self._require_known()
        network = self.derivation.formulation.network
        if network is None:
            return [self._point(REACHES[0], k) for k in range(count)]
        points: list[Point] = []
        loud: list[Point] = []
        calm = self._calm()
        for reach in REACHES:
            try:
                points = [self._point(reach, k) for k in range(count)]
            except ModelError:
                if points:
                    return points + loud[:-1]
                if reach == REACHES[-1]:
                    raise
                continue  # nearer zero laws may be milder
            if even(points, calm):
                return points + loud
            loud.append(replace(loudest(points), loud=True))
        return self._quietest(count) + loud[:-1]

    def _calm(self) -> Any:
        """Forces in networks very near zero, one row for each state; empty where laws are undefined."""
        beside = replace(self, draw=random.Random(0), chosen=[{}], varied=False)
        try:
            return acting([beside._point(REACHES[-1], k) for k in range(1, CALM + 1)])
        except ModelError:
            return []

    def _quietest(self, count: int) -> list[Point]:
        """The least loud of several states very near zero; sources are loud at some times anyway."""
        found = [[self._point(REACHES[-1], k) for _ in range(CALM)] for k in range(count)]
        return quietest(found)

    def _require_known(self) -> None:
        """Refuse bounds on quantities that the model does not have."""
        tree, model = self.derivation.structure, self.derivation.system
        bounds = model.bounds
        known: dict[str, Iterable[str]] = {
            "coordinates": [x.name for x in tree.positions],
            "velocities": [x.name for x in tree.velocities],
            "inputs": [x.name for x in tree.inputs],
            "parameters": [p.name for p in model.parameters.values() if not p.derived],
        }
        for group, names in known.items():
            for name in getattr(bounds, group):
                if name not in names:
                    problem = f"{group}: there is no {name}; {nearest(name, list(names))}"
                    raise ModelError("check", problem)

    def _point(self, reach: float, place: int) -> Point:
        """Draw one state at which all laws are defined and M is regular."""
        first: ModelError | None = None
        defined = False
        for attempt in range(TRIES):
            # Roots, logarithms and gaps need positive arguments, so every second try draws positive values.
            low = -1.0 if attempt % 2 == 0 else 0.2
            # Later tries keep the model's own parameters: laws may be undefined for others.
            varied = self.varied and place % 2 == 1 and attempt < TRIES // 2
            try:
                rest = place == 0 and attempt < 2
                slow = SLOW if place == SLOW_AT and attempt < TRIES // 2 else 1.0
                p = self._parameters(varied=varied, zeros=attempt < TRIES // 4)
                point = self._drawn((low, reach), p, rest=rest, slow=slow)
                if rest and point is not None and self._folding(point):
                    continue
                if point is not None and self._defined(point):
                    return point
                defined = defined or point is not None
            except ModelError as error:
                first = first or error
            except (ArithmeticError, ValueError):
                continue
        if first is not None and not defined:
            raise undefined(self.derivation, first, self._somewhere())
        who = f'model "{self.derivation.system.name}"'
        raise ModelError(who, SINGULAR)

    def _somewhere(self) -> Numeric | None:
        """The model at some inputs and time, for finding the component whose law is undefined."""
        tree, bounds = self.derivation.structure, self.derivation.system.bounds
        u = self._some(tree.inputs, bounds.inputs, (-1.0, 1.0))
        try:
            return self.derivation.numeric(None, bounds.sometime, u)
        except (ModelError, ArithmeticError):
            return None

    def _drawn(
        self,
        within: tuple[float, float],
        p: dict[str, float] | None,
        *,
        rest: bool,
        slow: float,
    ) -> Point | None:
        """Draw a state: at rest in mechanics, or random; on the constraints if there are any.

        Args:
            within: the least value drawn, and the largest states of networks and inputs.
            p: values of parameters that differ from the model's own, if any.
            rest: whether mechanics is at rest.
            slow: factor on velocities, those of masses in networks included.

        Returns:
            None where the loops do not close, or not within the bounds.
        """
        low, reach = within
        tree, model = self.derivation.structure, self.derivation.system
        first, bounds = tree.layout.mechanical, model.bounds
        still = rest and low < 0
        t = self._one((0.1, 1.0), bounds.t) if model.depends_on_time else 0.0
        u = self._some(tree.inputs, bounds.inputs, (reach * low, reach), still=still)
        numeric = self.derivation.numeric(p, t, u)
        both = tree.velocities[:first], tree.velocities[first:]
        states = self._some(both[1], bounds.velocities, (reach * low, reach))
        # Masses of networks have dry friction, too, so they are slowed like those of mechanics.
        free = [x.unit in RATES and x.name not in bounds.velocities for x in both[1]]
        states = [short(slow * x) if can else x for x, can in zip(states, free, strict=True)]
        v = self._some(both[0], bounds.velocities, (-slow, slow), still=rest)
        q = self._some(tree.positions, bounds.coordinates, (low, 1.0))
        if rest:
            q = _held(tree.positions, bounds.coordinates, _at_rest(self.derivation))
        numeric.tree.normalise(q)
        if tree.closed:
            q, found = consistent(self.derivation, self.derivation.assembled.q, numeric, self.draw)
            if rest and not model.depends_on_time and not any(u) and p is None:
                q, found = list(self.derivation.assembled.q), [0.0] * len(found)
            v, states = found[:first], found[first:] if not rest else states
            fastest = max(map(abs, v), default=0.0)
            v = [slow * x if abs(x) > LOCKED * max(fastest, 1.0) else 0.0 for x in v]
            if not self._legal(numeric, q, [*v, *states]):
                return None
        q, v = [short(x, 15) for x in q], [short(x, 15) for x in (*v, *states)]
        beside = [x + self.draw.uniform(-BESIDE, BESIDE) for x in q]
        numeric.tree.normalise(beside)
        beside = _held(tree.positions, bounds.coordinates, beside)
        a, off, lam = (self._plain(n) for n in (len(v), len(v), len(equations(tree))))
        # States of networks are not constrained; they keep their values and with these their size.
        off = _held(tree.velocities, bounds.velocities, [*off[:first], *v[first:]])
        off_q = [short(x, 15) for x in beside]
        return Point(self.derivation, t, u, q, v, a, off_q, off, self.kept, p or {}, lam)

    def _parameters(self, *, varied: bool, zeros: bool = False) -> dict[str, float] | None:
        """Draw values of parameters that differ from the model's own; None if none may differ.

        Parameters that would open loops of redundant constraints keep their values; those that are zero
        differ only with `zeros`.
        """
        model, found = self.derivation.system, {}
        for parameter in model.parameters.values():
            name = parameter.name
            if parameter.derived or not varied or name in self._fixed:
                continue
            bound = model.bounds.parameters.get(name)
            if bound is not None:
                found[name] = self._one((0.5, 2.0), bound)
            elif parameter.value or (zeros and name in self._little):
                value = float(parameter.value or self._little[name])
                found[name] = short(value * self.draw.uniform(*APART))
        return found or None

    @cached_property
    def _little(self) -> dict[str, float]:
        """Small values for parameters that are zero, compared with others of their unit."""
        own = [p for p in self.derivation.system.parameters.values() if not p.derived]
        found = {}
        for parameter in own:
            if parameter.value == 0:
                alike = [abs(float(p.value)) for p in own if p.value and p.unit == parameter.unit]
                if alike:
                    found[parameter.name] = LITTLE * min(alike)
        return found

    @cached_property
    def _fixed(self) -> frozenset[str]:
        """Parameters whose change opens a loop or changes the rank of redundant constraints."""
        derivation = self.derivation
        if not derivation.structure.closed or not derivation.assembled.redundant:
            return frozenset()
        own = {p.name: p.value for p in derivation.system.parameters.values() if not p.derived}
        others = {
            name: APART[1] * float(value or self._little.get(name, 0))
            for name, value in own.items()
        }
        return frozenset(name for name, other in others.items() if not self._closes({name: other}))

    def _closes(self, p: dict[str, float]) -> bool:
        """Whether loops close with these parameters and the rank of the constraints stays the same."""
        derivation, bounds = self.derivation, self.derivation.system.bounds
        u = self._some(derivation.structure.inputs, bounds.inputs, (-1.0, 1.0))
        try:
            numeric = derivation.numeric(p, bounds.sometime, u)
            q, v = consistent(derivation, derivation.assembled.q, numeric, random.Random(0))
            if not self._legal(numeric, q, v):
                return False
            point = Point(derivation, bounds.sometime, u, q, v, v, q, v, self.kept, p)
            return point.rank == derivation.assembled.rank
        except (ModelError, ArithmeticError, ValueError):
            return False

    def _legal(self, numeric: Numeric, q: Sequence[float], v: Sequence[float]) -> bool:
        """Whether the loops are closed and everything is within its bounds."""
        tree, bounds = self.derivation.structure, self.derivation.system.bounds
        gaps = [*numeric.constraints(q), *numeric.constraint_rates(q, v)]
        pairs = [(tree.positions, q, bounds.coordinates), (tree.velocities, v, bounds.velocities)]
        inside = (
            known[x.name][0] <= value <= known[x.name][1]
            for quantities, values, known in pairs
            for x, value in zip(quantities, values, strict=True)
            if x.name in known
        )
        return all(abs(gap) < GAP for gap in gaps) and all(inside)

    def _some(
        self,
        quantities: Sequence[Quantity],
        bounds: Mapping[str, Interval],
        within: Interval,
        *,
        still: bool = False,
    ) -> list[float]:
        """Draw one number for each quantity, within its bounds where it has some."""
        if still:
            return _held(quantities, bounds, [0.0] * len(quantities))
        return [self._one(within, bounds.get(x.name)) for x in quantities]

    def _one(self, within: Interval, bound: Interval | None) -> float:
        return short(self.draw.uniform(*(bound or within)))

    def _plain(self, count: int) -> list[float]:
        return [self._one((-1.0, 1.0), None) for _ in range(count)]

    def _folding(self, point: Point) -> bool:
        """Whether the rank drops there: a parallelogram laid flat has no unique acceleration."""
        closed = self.derivation.structure.closed and not self.derivation.idle
        return closed and point.rank < self.derivation.assembled.rank

    def _defined(self, point: Point) -> bool:
        """Whether all results are finite and accelerations are not small remainders of far larger terms."""
        np = point.walk.np
        # Where M is singular everywhere, no emitted function divides by it.
        solving = not self.derivation.idle
        for name, made in (pair for asked in self.chosen for pair in asked.items()):
            try:
                value, size = made(point)
                if not (np.isfinite(value).all() and np.isfinite(size).all()):
                    return False
                if solving and name in SOLVED and not _regular(np, *point.motion[0]):
                    return False
                if name == "Lambda" and not _regular(np, value, size, least=0):
                    return False
            except np.linalg.LinAlgError:
                return False
        return True


def _held(
    quantities: Sequence[Quantity], bounds: Mapping[str, Interval], values: Sequence[float]
) -> list[float]:
    """Clip values to their bounds."""
    pairs = [(x, bounds.get(quantity.name)) for quantity, x in zip(quantities, values, strict=True)]
    return [x if bound is None else min(max(x, bound[0]), bound[1]) for x, bound in pairs]


def _at_rest(derivation: Derived) -> list[float]:
    """Coordinates at which the two frames of every joint coincide."""
    q = [0.0] * len(derivation.structure.positions)
    for link in derivation.structure.links:
        places = link.place.positions
        for f, x in zip(places, link.joint.rest(), strict=False):
            q[f.index] = float(x)
    return q


def _regular(np: Any, value: Any, size: Any, least: float = 1.0) -> bool:
    largest = least + np.abs(value).max(initial=0.0)
    return bool(size.max(initial=0.0) <= REGULAR * largest)


def short(x: float, digits: int = DIGITS) -> float:
    """Round a number.

    Args:
        x: the number.
        digits: how many significant decimal digits remain.
    """
    return float(f"{x:.{digits}g}")

"""States at which a model is looked at: drawn at random, legal, and within the bounds that the user gives.

Quaternions have length 1, loops are closed and velocities allowed, every law is defined, and nothing is
nearly singular. At every second state the parameters differ from the model's own values: two parameters of
one value could not be told apart otherwise.
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
"""How many states a model is asked at, that at rest included."""

TRIES = 40
"""How many states are drawn for one that is defined."""

DIGITS = 14
"""Digits of what is written: the tolerance is far above them."""

REACHES = (1.0, 0.3, 0.1, 0.03)
"""How far states of networks and inputs are from zero; the first that will do."""

REGULAR = 1e4
"""Accelerations may be this much smaller than what they are made of; beyond, M is nearly singular."""

SOLVED = ("a", "A", "B", "da_dq", "da_dv", "da_du", "da_dp", "Lambda", "R", "D", "P", "y")
"""Results for which M is solved with."""

APART = (0.8, 1.25)
"""Parameters that are drawn are within these multiples of the model's own values."""

SLOW, SLOW_AT = 1e-3, 4
"""Velocities at one of the states are so small that dry friction has not yet risen; which state that is."""

RATES = ("m/s", "rad/s")
"""The units of velocities among the states of networks."""

GAP = 1e-9
"""What constraints may miss, at most, in lengths and angles of size 1."""

LITTLE = 0.1
"""What a parameter that is zero becomes, as a part of the least of its unit: inertias stay possible."""

LOCKED = 1e-13
"""Velocities of this part of the largest, or of 1, are what is left of those that constraints lock."""

BESIDE = 0.02
"""How far guesses are from positions: so little that they lead to these, and to no other way to assemble."""

SINGULAR = "no state was found at which all laws are defined and M is regular"

Asked = dict[str, "Callable[[Point], Valued]"]
"""The results of a function, and what gives them."""


@dataclass(frozen=True)
class Drawing:
    """How states of a model are drawn.

    Attributes:
        derivation: the model.
        draw: where randomness comes from.
        kept: what is independent under constraints.
        chosen: for each function that is to be defined at the states, its results.
        varied: whether those with a value may be: the functions take them as an argument.
    """

    derivation: Derived
    draw: random.Random
    kept: Kept
    chosen: Sequence[Asked]
    varied: bool = True

    def points(self, count: int = STATES) -> list[Point]:
        """All states; those of networks so near zero that no exponential law dwarfs one state by another.

        Where these had to be nearer zero than 1 there are more than `count`: one loud state from each reach
        that was too far, at which diodes conduct.

        Raises:
            ModelError: a law is defined at no state that was tried, M is singular at all of them, or the
                bounds name what does not exist.
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
        """What acts in networks at states very near zero, a row each; no row where laws are not defined."""
        beside = replace(self, draw=random.Random(0), chosen=[{}], varied=False)
        try:
            return acting([beside._point(REACHES[-1], k) for k in range(1, CALM + 1)])
        except ModelError:
            return []

    def _quietest(self, count: int) -> list[Point]:
        """Of states very near zero the least loud: sources are loud at some times, whatever the state."""
        found = [[self._point(REACHES[-1], k) for _ in range(CALM)] for k in range(count)]
        return quietest(found)

    def _require_known(self) -> None:
        """Refuse bounds of what the model does not have."""
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
        """A state at which everything is defined, and nothing nearly singular."""
        first: ModelError | None = None
        defined = False
        for attempt in range(TRIES):
            # roots, logarithms and gaps want what is positive
            low = -1.0 if attempt % 2 == 0 else 0.2
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
        """The model for some inputs, at a time, to ask whose law is not defined."""
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
        """A state: at rest in mechanics, or a random one, on the constraints if there are any.

        Args:
            within: the least value drawn, and how far states of networks and inputs reach.
            p: parameters that have not their own values, if any.
            rest: whether it is to be at rest.
            slow: what velocities are multiplied by, those of masses in networks too.

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
        # masses of networks have dry friction too
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
        # what networks store is not constrained, and keeps its size
        off = _held(tree.velocities, bounds.velocities, [*off[:first], *v[first:]])
        off_q = [short(x, 15) for x in beside]
        return Point(self.derivation, t, u, q, v, a, off_q, off, self.kept, p or {}, lam)

    def _parameters(self, *, varied: bool, zeros: bool = False) -> dict[str, float] | None:
        """Values of the parameters that are not the model's own; None where all are.

        What redundant constraints are made of keeps its value where loops do not close with another.

        Args:
            varied: whether any is to have another value.
            zeros: whether those that are zero are.
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
        """Values for parameters that are zero: little beside all others of their unit, if there are some."""
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
        """Parameters of redundant constraints that close no loop, or bind otherwise, with other values."""
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
        """Whether loops close with these parameters, with as many constraints independent as ever."""
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
        """Whether the loops are closed, and everything is within its bounds."""
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
        """One number for each quantity, within its bounds where it has some."""
        if still:
            return _held(quantities, bounds, [0.0] * len(quantities))
        return [self._one(within, bounds.get(x.name)) for x in quantities]

    def _one(self, within: Interval, bound: Interval | None) -> float:
        return short(self.draw.uniform(*(bound or within)))

    def _plain(self, count: int) -> list[float]:
        return [self._one((-1.0, 1.0), None) for _ in range(count)]

    def _folding(self, point: Point) -> bool:
        """Whether more moves there than elsewhere: a parallelogram laid flat has no one acceleration."""
        closed = self.derivation.structure.closed and not self.derivation.idle
        return closed and point.rank < self.derivation.assembled.rank

    def _defined(self, point: Point) -> bool:
        """Whether all is finite there, and accelerations are not what is left of far larger things."""
        np = point.walk.np
        # where M is singular everywhere, nothing that is emitted divides by it
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
    """Values moved into their bounds."""
    pairs = [(x, bounds.get(quantity.name)) for quantity, x in zip(quantities, values, strict=True)]
    return [x if bound is None else min(max(x, bound[0]), bound[1]) for x, bound in pairs]


def _at_rest(derivation: Derived) -> list[float]:
    """Where the frames of all joints coincide."""
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
    """A number rounded to some significant digits."""
    return float(f"{x:.{digits}g}")

"""Sizes that make constraints comparable: the lengths of the circuits that chords close.

A row of J is a unit force or a unit torque. Along a rotational velocity, the entry of a unit force is
its lever arm, along a translational one a cosine; that of a unit torque along a rotational velocity is
a cosine. Divided by a length L of the circuit for each force, and multiplied by L for each translation,
all entries are pure numbers of size 1 at most, whatever the units and the size of the mechanism:

    J_ij size(v_j) / size(φ_i)        size = L (m) or 1 (rad)

Without these sizes the rank of J, and so the number of degrees of freedom, would depend on whether
lengths are in metres or millimetres. L is the sum of the arms between the joints of a circuit, each
measured in the axes of its link, so that it does not depend on the position. Circuits that share
velocities share the largest of their lengths.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.components.constraints.base import Constraint
from linegraph.dynamics.chords import equations
from linegraph.spatial.vector import Vector, subtract

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.ir.program import Quantity
    from linegraph.kinematics.links import Closure, KinematicTree, Link

SHORT = 1e-6
"""Arms shorter than this fraction of the bodies' extent are taken as rounding: the joints coincide."""


class ConstraintSizes(NamedTuple):
    """Units of measurement for constraints and velocities.

    Attributes:
        constraints: for each its length (m) or 1 (rad); 0 for a relation, whose coefficients are its
            only scale.
        velocities: for each a length (m) or 1.
    """

    constraints: list[Scalar]
    velocities: list[Scalar]


class _Circuit(NamedTuple):
    """The circuit that a chord closes.

    Attributes:
        links: those whose joints lie in it.
        arms: from joint to joint, each in the axes of one link (m).
        own: lengths of the chord itself (m).
    """

    links: frozenset[int]
    arms: list[Vector]
    own: list[Scalar]


def sizes(tree: KinematicTree, numbers: KinematicTree | None = None) -> ConstraintSizes:
    """The sizes of all constraints and velocities.

    Args:
        tree: the links, over any algebra.
        numbers: the same links over floats, to decide which arms are rounding; `tree` itself if
            omitted.
    """
    sample = numbers or tree
    circuits, known = _circuits(tree), _circuits(sample)
    of_chord: dict[str, Scalar] = {}
    of_velocity: dict[int, Scalar] = {}
    for group in _groups(tree, circuits):
        links = {link for k in group for link in circuits[k].links}
        bodies = _extent(sample.links[k] for k in links)
        length: Scalar = bodies or 1.0
        if _longest(sample.algebra, [known[k] for k in group]) > SHORT * bodies:
            length = _longest(tree.algebra, [circuits[k] for k in group])
        of_chord.update((tree.closures[k].component.name, length) for k in group)
        of_velocity.update((f.index, length) for k in links for f in tree.links[k].velocities)
    rest = _extent(sample.links) or 1.0
    return ConstraintSizes(
        [_size_of(e.multiplier, of_chord.get(e.component, 0)) for e in equations(tree)],
        [
            of_velocity.get(k, rest) if quantity.unit == "m/s" else 1
            for k, quantity in enumerate(tree.velocities)
        ],
    )


def of_rows(J: Any, found: ConstraintSizes) -> Any:
    """Divisors of the rows of J: each constraint's size, or its largest entry if it has none.

    Args:
        J: array, constraints x velocities.
        found: the sizes.

    Returns:
        One positive divisor per row; 1 for a row of zeros.
    """
    import numpy as np

    known = np.array(found.constraints, float)
    own = np.abs(J * np.array(found.velocities, float)).max(axis=1, initial=0.0)
    return np.where(known > 0, known, np.where(own > 0, own, 1.0))


def pure(J: Any, found: ConstraintSizes) -> Any:
    """J in pure numbers: an entry of a unit direction has size 1 at most.

    Args:
        J: array, constraints x velocities.
        found: the sizes.
    """
    import numpy as np

    return J * np.array(found.velocities, float) / of_rows(J, found)[:, None]


def _size_of(multiplier: Quantity, length: Scalar) -> Scalar:
    """The size of a constraint: a length if its multiplier is a force, 1 if a torque, 0 if unknown."""
    sizes_of: dict[str, Scalar] = {"N": length, "N*m": 1}
    return sizes_of.get(multiplier.unit, 0)


def _circuits(tree: KinematicTree) -> list[_Circuit]:
    return [_circuit(tree, closure) for closure in tree.closures]


def _circuit(tree: KinematicTree, closure: Closure) -> _Circuit:
    """The links and arms of the circuit that a chord closes."""
    ways = []
    for seat in (closure.tail, closure.head):
        way = [(seat.link, seat.at)]
        while way[-1][0] >= 0:
            link = tree.links[way[-1][0]]
            way.append((link.parent, link.at))
        ways.append(way)
    one, other = (dict(way) for way in ways)
    meeting = next(link for link, _ in ways[0] if link in other)
    outer = [(k, at) for way in ways for k, at in way if not (k in one and k in other)]
    arms = [*(at for _, at in outer), subtract(one[meeting], other[meeting])]
    links = {k for k, _ in outer}
    if tree.levelled:
        links |= {k for k in (*one, *other) if k >= 0}
    own: list[Scalar] = []
    if isinstance(closure.component, Constraint):
        own += [jet.x for jet in closure.drive if jet is not None and jet.dx == 0]
        own += [tree.resolve(x) for x in closure.component.lengths()]
    return _Circuit(frozenset(links), arms, own)


def _groups(tree: KinematicTree, circuits: Sequence[_Circuit]) -> list[list[int]]:
    """Circuits that share velocities, directly or through other circuits."""
    groups: list[tuple[set[int], list[int]]] = []
    for k, circuit in enumerate(circuits):
        shared = {f.index for link in circuit.links for f in tree.links[link].velocities}
        members = [k]
        apart = []
        for velocities, others in groups:
            if velocities & shared:
                shared, members = shared | velocities, [*others, *members]
            else:
                apart.append((velocities, others))
        groups = [*apart, (shared, members)]
    return [members for _, members in groups]


def _longest(algebra: Algebra, circuits: Sequence[_Circuit]) -> Scalar:
    """The greatest length among some circuits (m)."""
    longest: Scalar = 0
    for circuit in circuits:
        parts = [*(x for arm in circuit.arms for x in arm), *circuit.own]
        # sums of absolute components: at least the Euclidean length, without square roots to emit
        length = sum((algebra.function("abs", x) for x in parts), start=0)
        longest = length if longest == 0 else algebra.function("max", longest, length)
    return longest


def _extent(links: Iterable[Link]) -> float:
    """The greatest distance that the mass of some links reaches from their joints (m)."""
    reaches = [0.0]
    for link in links:
        mass, first, inertia = link.moments.mass, link.moments.first, link.moments.inertia
        if mass > 0:
            square = (abs(inertia[0]) + abs(inertia[3]) + abs(inertia[5])) / mass
            reaches.append(math.hypot(*first) / mass + math.sqrt(square))
    return max(reaches)

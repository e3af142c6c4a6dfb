"""Edges of the system graph with both their variables, and what they are called."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.components.domains import DOMAINS
from linegraph.ir.program import Quantity
from linegraph.model.choices import GROUND_AXES, HEAD
from linegraph.spatial.vector import ZERO, Vector, add, cross, dot, negate, subtract

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.model.system import System
    from linegraph.networks import Network

XYZ = "xyz"


class Wrench(NamedTuple):
    """A force and a torque about a point, in ground axes."""

    force: Vector
    torque: Vector

    def __add__(self, other: Any) -> Wrench:
        return Wrench(add(self.force, other.force), add(self.torque, other.torque))

    def turned(self) -> Wrench:
        """The reaction."""
        return Wrench(negate(self.force), negate(self.torque))

    def about(self, old: Vector, new: Vector) -> Wrench:
        """The same about another point."""
        return Wrench(self.force, add(self.torque, cross(subtract(old, new), self.force)))


NOTHING = Wrench(ZERO, ZERO)


class EdgeVariables(NamedTuple):
    """What an edge does: through and across variables in ground axes, and the lever of its force.

    Attributes:
        through: on its head, about the head's origin.
        linear, angular: velocity and angular velocity of the head less those of the tail.
        lever: torque on the tail that the force's offset from it makes.
        turning: the angular velocity of the tail.
    """

    through: Wrench
    linear: Vector
    angular: Vector
    lever: Vector = ZERO
    turning: Vector = ZERO


def powers(edges: Mapping[str, EdgeVariables]) -> tuple[dict[str, Scalar], tuple[Scalar, Scalar]]:
    """Through times across of every edge, and the sums of translation and of rotation, which are zero."""
    found: dict[str, Scalar] = {}
    translation: Scalar = 0
    rotation: Scalar = 0
    for name, edge in edges.items():
        found[f"{name}.translation"] = dot(edge.through.force, edge.linear)
        found[f"{name}.rotation"] = dot(edge.through.torque, edge.angular)
        found[f"{name}.lever"] = dot(edge.lever, edge.turning)
        translation = translation + found[f"{name}.translation"]
        rotation = rotation + found[f"{name}.rotation"] + found[f"{name}.lever"]
    return found, (translation, rotation)


def network_powers(
    network: Network | None, found: Mapping[str, tuple[Scalar, Scalar]]
) -> tuple[dict[str, Scalar], dict[str, Scalar]]:
    """The power that each edge of a network delivers, and its sum in each subspace that has a power: zero."""
    powers_: dict[str, Scalar] = {}
    sums: dict[str, Scalar] = {}
    for branch in network.branches if network is not None else ():
        domain = branch.port.domain
        if branch.port.spatial or domain in (network.heats if network else ()):
            continue
        x, y = found[branch.name]
        powers_[branch.name] = -(x * y)
        sums[domain] = sums.get(domain, 0) + powers_[branch.name]
    return powers_, sums


def network_quantities(model: System, network: Network | None, place: int) -> list[Quantity]:
    """What the across (0) or the through (1) variables of a network's edges are called."""
    found = []
    for branch in network.branches if network is not None else ():
        if branch.port.spatial:
            continue
        domain = model.domains.get(branch.port.domain) or DOMAINS[branch.port.domain]
        variable = (domain.across, domain.through)[place]
        what = f"{variable.name} {('across', 'through')[place]} {branch.name}"
        found.append(Quantity(branch.name, variable.symbol, what))
    return found


def across_groups(names: Sequence[str]) -> tuple[tuple[Quantity, int], ...]:
    """The same, one for each edge, and how many they are: what the head of a file lists."""
    return tuple((Quantity(name, "m/s, rad/s"), 6) for name in names)


def reaction_groups(names: Sequence[str]) -> tuple[tuple[Quantity, int], ...]:
    """The reactions, one for each joint, and how many they are."""
    return tuple((Quantity(name, "N, N*m"), 6) for name in names)


def reaction_axes(model: System) -> str:
    """In whose axes reactions are resolved."""
    return {HEAD: "the head's", GROUND_AXES: "ground"}.get(model.choices.reactions, "the tail's")


def across_quantities(names: Sequence[str]) -> tuple[Quantity, ...]:
    """The names of all across variables: velocities and angular velocities in ground axes."""
    return tuple(
        Quantity(f"{name}_{letter}{c}", unit, f"{what} {c} across {name}, in ground axes")
        for name in names
        for letter, unit, what in (("v", "m/s", "velocity"), ("w", "rad/s", "angular velocity"))
        for c in XYZ
    )


def reaction_quantities(model: System, names: Sequence[str]) -> tuple[Quantity, ...]:
    """The names of all reactions."""
    axes = reaction_axes(model)
    return tuple(
        Quantity(
            f"{name}_{letter}{c}",
            unit,
            f"{what} {c} that {name} exerts on its head, in {axes} axes",
        )
        for name in names
        for letter, unit, what in (("f", "N", "force"), ("t", "N*m", "torque"))
        for c in XYZ
    )

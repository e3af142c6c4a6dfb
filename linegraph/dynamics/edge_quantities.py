"""Edges of the system graph with both of their variables, and the names of these in emitted code."""

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
    """A force (N) and a torque about a point (N m), in ground axes."""

    force: Vector
    torque: Vector

    def __add__(self, other: Any) -> Wrench:
        return Wrench(add(self.force, other.force), add(self.torque, other.torque))

    def turned(self) -> Wrench:
        """The reaction: the opposite force and torque, about the same point."""
        return Wrench(negate(self.force), negate(self.torque))

    def about(self, old: Vector, new: Vector) -> Wrench:
        """The same wrench about another point.

        Args:
            old: the point that the torque is about, from the origin of ground (m).
            new: the point that it shall be about.
        """
        return Wrench(self.force, add(self.torque, cross(subtract(old, new), self.force)))


NOTHING = Wrench(ZERO, ZERO)


class EdgeVariables(NamedTuple):
    """Through and across variables of an edge in ground axes, and the lever of its force.

    Attributes:
        through: force and torque on its head, about the head's origin.
        linear, angular: velocity (m/s) and angular velocity (rad/s) of the head less those of the tail.
        lever: torque on the tail from the offset of the force's line of action (N m).
        turning: angular velocity of the tail, across which the lever acts (rad/s).
    """

    through: Wrench
    linear: Vector
    angular: Vector
    lever: Vector = ZERO
    turning: Vector = ZERO


def powers(edges: Mapping[str, EdgeVariables]) -> tuple[dict[str, Scalar], tuple[Scalar, Scalar]]:
    """The power of every edge, through times across, and the sums over each mechanical subspace (W).

    Args:
        edges: all edges of the system graph, by name.

    Returns:
        The powers by ``edge.translation``, ``edge.rotation`` and ``edge.lever``; then the sums over
            translation and over rotation with levers, both zero by the principle of orthogonality.
    """
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
    """The power that each edge of a network delivers, and its sum in each subspace: zero.

    Args:
        network: the scalar networks; None if there are none.
        found: across and through variable of each edge.

    Returns:
        The powers by edge (W), positive if the edge delivers power; then the sums by domain. Edges of
            domains whose product is no power, such as heat, are left out.
    """
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


def network_quantities(system: System, network: Network | None, place: int) -> list[Quantity]:
    """Names and units of the across or through variables of a network's edges.

    Args:
        system: declares domains.
        network: the scalar networks; None if there are none.
        place: 0 for across, 1 for through variables.
    """
    found = []
    for branch in network.branches if network is not None else ():
        if branch.port.spatial:
            continue
        domain = system.domains.get(branch.port.domain) or DOMAINS[branch.port.domain]
        variable = (domain.across, domain.through)[place]
        what = f"{variable.name} {('across', 'through')[place]} {branch.name}"
        found.append(Quantity(branch.name, variable.symbol, what))
    return found


def across_groups(names: Sequence[str]) -> tuple[tuple[Quantity, int], ...]:
    """Across variables by edge with their number, as the head of an emitted file lists them."""
    return tuple((Quantity(name, "m/s, rad/s"), 6) for name in names)


def reaction_groups(names: Sequence[str]) -> tuple[tuple[Quantity, int], ...]:
    """Reactions by joint with their number, as the head of an emitted file lists them."""
    return tuple((Quantity(name, "N, N*m"), 6) for name in names)


def reaction_axes(system: System) -> str:
    """The axes in which the user wants reactions resolved, in words."""
    return {HEAD: "the head's", GROUND_AXES: "ground"}.get(system.choices.reactions, "the tail's")


def across_quantities(names: Sequence[str]) -> tuple[Quantity, ...]:
    """Names and units of across variables: linear, then angular velocity of each edge, in ground axes."""
    return tuple(
        Quantity(f"{name}_{letter}{c}", unit, f"{what} {c} across {name}, in ground axes")
        for name in names
        for letter, unit, what in (("v", "m/s", "velocity"), ("w", "rad/s", "angular velocity"))
        for c in XYZ
    )


def reaction_quantities(system: System, names: Sequence[str]) -> tuple[Quantity, ...]:
    """Names and units of reactions: force, then torque on each joint's head.

    Args:
        system: chooses the axes in which reactions are resolved.
        names: the joints and constraints.
    """
    axes = reaction_axes(system)
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

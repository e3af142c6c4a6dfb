"""The trees in translation and in rotation of a mechanical system, which decide the coordinates (stage 2).

The unknown across variables of the branches are the coordinates: another tree means other coordinates, never
other physics. A joint that is a branch contributes its own coordinates, an inertia edge that is a branch the
motion of its body relative to ground; a joint that is a chord contributes constraints, its projected circuit
equation. Unless the user decides otherwise, the tree of least weight is chosen, in this order:

    1. fewest coordinates: a joint weighs its freedoms, a prescribed one nothing, an inertia edge more than
       any joint, a force element more than anything
    2. the same joint in translation and in rotation
    3. joints in which something acts (an effort, an element), or that have a start, are rather branches
    4. shallow trees: a loop is cut where it is farthest from ground
    5. with coordinates "automatic", absolute angles where bodies turn in a plane: an inertia edge instead of
       the hinge in rotation. By default coordinates are those of joints, as their names say

The first rule also decides which joint of a loop is cut: the one with the most freedoms, which weighs most
and leaves the fewest constraints.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.components.body import GROUND
from linegraph.components.domains import ROTATION, TRANSLATION
from linegraph.components.forces import Element
from linegraph.components.joints import Compound
from linegraph.components.validation import nearest
from linegraph.errors import ModelError
from linegraph.formulation.planarity import Angle, absolute_angles, related
from linegraph.graph.forest import Topology, choose_forest
from linegraph.graph.multigraph import Projection
from linegraph.model.choices import ABSOLUTE, ABSOLUTE_ANGLE, AUTOMATIC
from linegraph.model.terminal_graphs import terminals_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.components.scalar.branches import Branch
    from linegraph.graph.multigraph import Edge, SystemGraph
    from linegraph.model.system import System
    from linegraph.networks import Network

# an inertia edge weighs more than the six freedoms of a free joint; the other two only break ties, since
# their sum is less than one freedom
INERTIA_WEIGHT = 7.0
NOTHING_ACTS = 0.3
DEPTH = 0.2


@dataclass(frozen=True)
class Formulation:
    """The chosen trees and their consequences for the mechanics.

    Attributes:
        translation, rotation: the trees.
        joints: the joints that are branches in translation, hence in the kinematic tree.
        absolute: bodies whose inertia edge is a branch in both.
        level: joints that are branches in translation only, with the body beyond, whose inertia edge is the
            branch in rotation: its orientation is measured relative to ground.
        chords: joints that are chords in both.
        network: the scalar networks, with trees of their own.
    """

    translation: Topology
    rotation: Topology
    joints: frozenset[str]
    absolute: tuple[str, ...]
    level: Mapping[str, Angle]
    chords: tuple[str, ...]
    network: Network | None = None


def formulate(model: System, graph: SystemGraph) -> Formulation:
    """Choose the trees of a mechanical system.

    Args:
        model: the system, with the user's choices.
        graph: its system graph.

    Raises:
        ModelError: nothing holds a body, the requested tree is none, or a joint that must be a branch would
            be a chord.
    """
    if not model.bodies and not model.components:
        problem = "has no bodies and no components: there is nothing to derive"
        raise ModelError(f'model "{model.name}"', problem)
    _require_known(model)
    network = _network_of(model)
    absolute = _absolute(model)
    projection = _mechanics(graph, TRANSLATION.name)
    # rigid arms hold bodies together: they are branches before all else
    arms = [edge.name for edge in projection.edges if _is_arm(model, edge)]
    wanted = [*arms, *_wanted(model, absolute)]
    try:
        translation = choose_forest(projection, edge_weights(model, projection), (GROUND,), wanted)
    except ModelError as error:
        raise _explained(error, model) from None
    _require_held(model, translation, absolute)
    names = {joint.name for joint in model.joints}
    branches = frozenset(edge.name for edge in translation.branches if edge.name in names)
    level = _level(model, translation)
    rotation = _rotation(_mechanics(graph, ROTATION.name), translation, level)
    chords = tuple(edge.name for edge in translation.chords if edge.name in names)
    _require_followers(model, branches)
    return Formulation(translation, rotation, branches, absolute, level, chords, network)


def _mechanics(graph: SystemGraph, domain: str) -> Projection:
    """The graph of a mechanical subspace; ground alone if the system has no edge there."""
    return graph[domain] if domain in graph.domains else Projection(domain, (GROUND,), ())


def _explained(error: ModelError, model: System) -> ModelError:
    """The error with the joints that were requested only because they are coupled."""
    coupled = [name for name in _coupled(model) if name not in model.choices.tree]
    if not coupled:
        return error
    names = ", ".join(dict.fromkeys(coupled))
    problem = f"{error.problem}; coupled joints have to be branches, too: {names}"
    wanted = any(error.thing == f'branch "{name}"' for name in model.choices.tree)
    return ModelError(error.thing if wanted else f'joint "{coupled[0]}"', problem)


def _is_arm(model: System, edge: Edge) -> bool:
    """Whether an edge is a rigid arm of a body or of ground."""
    return edge.component in (GROUND, *model.bodies) and edge.name.startswith(
        f"{edge.component}/arm"
    )


def _absolute(model: System) -> tuple[str, ...]:
    """The bodies whose inertia edge is a branch in both trees.

    Where all bodies are to be absolute, those at the head of a joint that has to be a branch are not.
    """
    held = {*_coupled(model), *(j.name for j in model.joints if isinstance(j, Compound))}
    held |= related(model)
    terminals = terminals_of(model)
    ends = (joint.between[::-1] for joint in model.joints if joint.name in held)
    bodies = [[terminals[end][0] for end in pair if end in terminals] for pair in ends]
    spared = {next((b for b in pair if b != GROUND), "") for pair in bodies}
    spared -= set(model.choices.of_body)
    return tuple(
        name
        for name in model.bodies
        if (model.choices.kind(name) == ABSOLUTE and name not in spared)
        or f"{name}/inertia" in model.choices.tree
    )


def _coupled(model: System) -> list[str]:
    """The joints that follow others or are followed."""
    joints = {joint.name for joint in model.joints if joint.freedoms == 1}
    return [n for c in model.couplings for n in (c.joint, c.master) if n in joints]


def _wanted(model: System, absolute: tuple[str, ...]) -> list[str]:
    """Edges that must be branches: those that the user requests, and those that cannot be chords."""
    inertia = (f"{name}/inertia" for name in absolute)
    components = {branch.name for branch in _network_edges(model)}
    chosen = (name for name in model.choices.tree if name not in components)
    wanted = [*inertia, *chosen, *_coupled(model)]
    return list(dict.fromkeys(wanted))


def edge_weights(model: System, projection: Projection) -> dict[str, float]:
    """The weight of every edge but rigid arms, which have weight 0.

    Args:
        model: the system.
        projection: its graph in translation, for the distance of each edge from ground.

    Returns:
        Weights by name of edge: freedoms plus a fraction of 1 by the rules that break ties; infinite for
        force elements and constraints.
    """
    acting = {e.joint for e in model.elements if isinstance(e, Element) and e.joint is not None}
    depth = _depths(projection)
    deepest = 1 + max(depth.values(), default=0)
    ends = {edge.name: max(depth[edge.tail], depth[edge.head]) for edge in projection.edges}
    weights = {f"{name}/inertia": INERTIA_WEIGHT for name in model.bodies}
    for joint in model.joints:
        weight = float(joint.freedoms) if joint.drive is None else 0.0
        if not (joint.effort or joint.name in acting or joint.start is not None):
            weight += NOTHING_ACTS
        if isinstance(joint, Compound):
            weight = -1.0  # it cannot be a chord
        weights[joint.name] = weight + DEPTH * ends.get(joint.name, 0) / deepest
    others = (*model.elements, *model.constraints)
    weights |= {component.name: math.inf for component in others}
    return weights


def _depths(projection: Projection) -> dict[str, int]:
    """The number of edges from ground to each vertex; inertia edges, which start there, do not count."""
    near: dict[str, list[str]] = {vertex: [] for vertex in projection.vertices}
    for edge in projection.edges:
        if not edge.name.endswith("/inertia"):
            near[edge.tail].append(edge.head)
            near[edge.head].append(edge.tail)
    depth = {GROUND: 0}
    frontier = [GROUND]
    while frontier:
        frontier = [
            vertex
            for here in frontier
            for vertex in dict.fromkeys(near.get(here, ()))
            if depth.setdefault(vertex, depth[here] + 1) == depth[here] + 1
        ]
        frontier = list(dict.fromkeys(frontier))
    return {vertex: depth.get(vertex, 0) for vertex in projection.vertices}


def _level(model: System, translation: Topology) -> dict[str, Angle]:
    """The joints beyond which a body's orientation is measured relative to ground."""
    kinds = {name: model.choices.kind(name) for name in model.bodies}
    wanted = {name for name, kind in kinds.items() if kind in (ABSOLUTE_ANGLE, AUTOMATIC)}
    found = absolute_angles(model, translation, wanted) if wanted else {}
    return {
        joint: angle
        for joint, angle in found.items()
        if kinds[angle.body] == ABSOLUTE_ANGLE or angle.less is not None
    }


def _rotation(
    projection: Projection, translation: Topology, level: Mapping[str, Angle]
) -> Topology:
    """The tree in rotation: that in translation, with inertia edges in place of the joints in `level`."""
    names = [edge.name for edge in translation.branches if edge.name not in level]
    names += [f"{angle.body}/inertia" for angle in level.values()]
    return choose_forest(projection, roots=(GROUND,), branches=names)


def _require_known(model: System) -> None:
    """Refuse choices that name edges, bodies or kinds that do not exist."""
    edges = [joint.name for joint in model.joints] + [f"{name}/inertia" for name in model.bodies]
    edges += [branch.name for branch in _network_edges(model) if not branch.port.spatial]
    for name in model.choices.tree:
        if name not in edges:
            raise ModelError(
                f'branch "{name}"',
                f"is no joint, inertia edge or component; {nearest(name, edges)}",
            )
    for name in model.choices.of_body:
        if name not in model.bodies:
            problem = f"coordinates: there is no such body; {nearest(name, model.bodies)}"
            raise ModelError(f'body "{name}"', problem)


def _require_held(model: System, translation: Topology, absolute: tuple[str, ...]) -> None:
    """Refuse a part that only inertia edges or force elements connect to ground."""
    joints = {joint.name for joint in model.joints}
    for edge in translation.branches:
        if edge.name.endswith("/inertia") and edge.name not in joints:
            if edge.component in absolute:
                continue
            problem = "nothing connects it to ground; add a joint, a free one if it floats"
            raise ModelError(f'body "{edge.component}"', problem)


def _require_followers(model: System, branches: frozenset[str]) -> None:
    """Refuse a follower that a loop has made a chord: its angle would be known only up to full turns."""
    names = {joint.name for joint in model.joints}
    for coupling in model.couplings:
        for part in (coupling.joint, coupling.master):
            if part in names and part not in branches:
                problem = (
                    "is coupled to another and must be a branch; cut another joint of the loop"
                )
                raise ModelError(f'joint "{part}"', problem)


def _network_of(model: System) -> Network | None:
    """The network of a system; its derivation is imported only if there is one."""
    if not model.components:
        return None
    from linegraph.networks.equations import network_of

    return network_of(model)


def _network_edges(model: System) -> Sequence[Branch]:
    """The edges of a model's components."""
    if not model.components:
        return ()
    from linegraph.components.scalar.branches import edges_of

    return edges_of(model.components)

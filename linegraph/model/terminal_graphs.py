"""The system graph from components: terminals, terminal graphs, and their union."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.body import GROUND, MASS_CENTER
from linegraph.components.domains import ROTATION, TRANSLATION
from linegraph.components.forces import Element, PointForce
from linegraph.components.scalar.branches import edges_of, terminal_graph
from linegraph.components.validation import nearest
from linegraph.errors import ModelError
from linegraph.graph.multigraph import Edge, SystemGraph, unite
from linegraph.spatial.placement import Placement
from linegraph.spatial.rotation import IDENTITY_MATRIX
from linegraph.spatial.vector import ZERO

if TYPE_CHECKING:
    from linegraph.model.system import System

MECHANICAL = (TRANSLATION.name, ROTATION.name)
Terminals = dict[str, tuple[str, Placement]]


def terminals_of(model: System) -> Terminals:
    """Every terminal of a system by name, with its body and its placement there.

    Raises:
        ModelError: two terminals have the same name.
    """
    found: Terminals = {GROUND: (GROUND, Placement(ZERO, IDENTITY_MATRIX))}

    def add(terminal: str, body: str, placement: Placement) -> None:
        if terminal in found:
            raise ModelError(f'terminal "{terminal}"', "two frames have this name; rename one")
        found[terminal] = (body, placement)

    for name, placement in model.ground_frames.items():
        add(f"{GROUND}.{name}", GROUND, placement)
    for body in model.bodies.values():
        add(body.name, body.name, Placement(ZERO, IDENTITY_MATRIX))
        for name, placement in body.frames.items():
            add(f"{body.name}.{name}", body.name, placement)
    for name in model.bodies:
        if f"{name}.{MASS_CENTER}" in found:
            problem = f'is the name of the mass centre of "{name}"; rename a body or frame'
            raise ModelError(f'terminal "{name}.{MASS_CENTER}"', problem)
    return found


def system_graph(model: System) -> SystemGraph:
    """Unite the terminal graphs of ground, bodies, joints, elements, constraints and networks.

    Raises:
        ModelError: a component names a terminal that does not exist, or connects a body to itself.
    """
    terminals = terminals_of(model)
    graphs = [_ground_edges(model), *(body.edges() for body in model.bodies.values())]
    for joint in model.joints:
        _require_ends(f'joint "{joint.name}"', joint.between, terminals)
        graphs.append([Edge(joint.name, joint.name, d, *joint.between) for d in MECHANICAL])
    for element in model.elements:
        graphs.append(_element_edges(model, element, terminals))
    for limit in model.constraints:
        _require_ends(f'{limit.kind} "{limit.name}"', limit.ends, terminals)
        graphs.append([Edge(limit.name, limit.name, d, *limit.ends) for d in MECHANICAL])
    graphs.append(terminal_graph(edges_of(model.components)))
    return unite(graphs)


def _ground_edges(model: System) -> list[Edge]:
    return [
        Edge(f"{GROUND}/arm.{frame}", GROUND, domain, GROUND, f"{GROUND}.{frame}")
        for domain in MECHANICAL
        for frame in model.ground_frames
    ]


def _element_edges(
    model: System, element: Element | PointForce, terminals: Terminals
) -> list[Edge]:
    """The edges of an element: parallel to its joint, between its ends, or from ground to a load's point.

    Raises:
        ModelError: a terminal or a joint does not exist, or the joint has several freedoms.
    """
    who = f'{element.kind} "{element.name}"'
    if isinstance(element, PointForce):
        _require_terminal(who, element.at, terminals)
        return [Edge(element.name, element.name, d, GROUND, element.at) for d in MECHANICAL]
    if element.between is not None:
        _require_ends(who, element.between, terminals)
        return [Edge(element.name, element.name, TRANSLATION.name, *element.between)]
    joints = {joint.name: joint for joint in model.joints}
    joint = joints.get(element.joint or "")
    if joint is None:
        raise ModelError(
            who, f'there is no joint "{element.joint}"; {nearest(str(element.joint), joints)}'
        )
    if joint.freedoms != 1:
        raise ModelError(who, f'joint "{joint.name}" is {joint.kind}; it must have one freedom')
    return [Edge(element.name, element.name, d, *joint.between) for d in MECHANICAL]


def _require_ends(who: str, between: tuple[str, str], terminals: Terminals) -> None:
    for terminal in between:
        _require_terminal(who, terminal, terminals)
    if len({terminals[terminal][0] for terminal in between}) == 1:
        raise ModelError(who, f'connects body "{terminals[between[0]][0]}" to itself')


def _require_terminal(who: str, terminal: str, terminals: Terminals) -> None:
    if terminal not in terminals:
        hint = nearest(terminal, terminals)
        raise ModelError(who, f'there is no body or frame "{terminal}"; {hint}')

"""The content of a model as text: `linegraph show`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.components.domains import DOMAINS
from linegraph.components.parameters import Parameter
from linegraph.dynamics.chords import equations
from linegraph.dynamics.regularity import cause
from linegraph.programs.loop_remarks import freedoms_text

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from linegraph.derivation import Derivation
    from linegraph.graph.forest import Topology
    from linegraph.graph.multigraph import IntegerMatrix
    from linegraph.kinematics.links import KinematicTree
    from linegraph.model.system import System
    from linegraph.networks import Network
    from linegraph.numeric.assembly import Assembly

WIDEST_TABLE = 120
"""A matrix wider than this (characters) is written row by row as sums."""

Lines = list[str]


def show(derivation: Derivation, heading: Callable[[str], str] = str) -> str:
    """List bodies, joints, domains, graph, tree, coordinates, cutset and circuit equations of a model.

    Args:
        derivation: the derived model.
        heading: how to mark a heading, such as bold on a terminal; by default unchanged.

    Returns:
        The text, with a blank line after each section.
    """
    tree = derivation.structure
    mechanics = bool(derivation.system.bodies)
    sections = [(f"model {derivation.system.name}", _summary(derivation, tree))]
    if mechanics:
        sections += [("bodies", _bodies(derivation.system)), ("joints", _joints(derivation))]
    if derivation.system.components:
        sections.append(("components", _components(derivation.system)))
    sections.append(("domains", _domains(derivation)))
    if mechanics:
        title = f"graph: edges tail -> head, {_likeness(derivation)}"
        sections += [
            (title, _graph(derivation.topology)),
            ("tree: links from ground outward", _tree(tree)),
        ]
    sections.append(("coordinates", _coordinates(tree)))
    if tree.closed:
        sections.append(("constraints", _constraints(derivation)))
    if mechanics:
        sections += [*_topological(derivation.topology, ""), *_in_rotation(derivation)]
    if tree.network is not None:
        sections += _networks(tree.network)
    return "\n".join(
        line for title, lines in sections for line in (heading(title), *_indented(lines), "")
    )


def _topological(topology: Topology, where: str) -> list[tuple[str, Lines]]:
    """Cutset and circuit matrix of a tree."""
    return [
        (f"cutset equations{where} [U A] Y = 0: A, branches x chords", _matrix(topology.cutset)),
        (f"circuit equations{where} [B U] X = 0: B, chords x branches", _matrix(topology.circuit)),
    ]


def _networks(network: Network) -> list[tuple[str, Lines]]:
    """Graph and normal tree of each scalar subspace, with remarks on the states."""
    sections: list[tuple[str, Lines]] = []
    for topology in network.topologies:
        domain = topology.projection.domain
        sections.append((f"{domain} graph: edges tail -> head", _graph(topology)))
        if topology.branches and topology.chords:
            sections += _topological(topology, f" in {domain}")
    if network.remarks:
        sections.append(("remarks", list(network.remarks)))
    return sections


def _components(model: System) -> Lines:
    rows = [("component", "type", "edges")]
    for component in model.components:
        edges = []
        for port in component.ports():
            where = port.joint or " -> ".join(port.between or port.points or ())
            edges.append(f"{port.label}: {where}" if port.label else where)
        rows.append((component.name, component.kind, "; ".join(edges)))
    return _table(rows)


def _likeness(derivation: Derivation) -> str:
    same = "the same in translation and rotation"
    return f"{same}, branches those of translation" if derivation.formulation.level else same


def _in_rotation(derivation: Derivation) -> tuple[tuple[str, Lines], ...]:
    """Cutset equations in rotation, if the tree there differs."""
    rotation = derivation.formulation.rotation
    if not derivation.formulation.level:
        return ()
    title = "cutset equations in rotation, whose tree has inertia edges: A, branches x chords"
    return ((title, _matrix(rotation.cutset)),)


def assembled(derivation: Derivation, found: Assembly) -> str:
    """List a position that closes all loops, with the rank of the constraints there.

    Args:
        derivation: the derived model.
        found: the position.

    Returns:
        A table of coordinates (rad or m), then counts, ending in a newline.
    """
    rows = [
        (f"q[{k}]", quantity.name, f"{value:.12g}", quantity.unit)
        for k, (quantity, value) in enumerate(
            zip(derivation.structure.positions, found.q, strict=True)
        )
    ]
    held = len(found.unique)
    counts = (
        f"{len(derivation.structure.velocities)} velocities, {held} constraints, {found.rank} independent: "
        f"{freedoms_text(found.freedoms)}"
    )
    lines = [*_table(rows), counts]
    if found.redundant:
        names = [
            equation.multiplier.name
            for equation, one in zip(equations(derivation.structure), found.unique, strict=True)
            if not one
        ]
        lines.append(f"{found.redundant} redundant; not unique: {', '.join(names)}")
    return "\n".join(lines) + "\n"


def _summary(derivation: Derivation, tree: KinematicTree) -> Lines:
    graph, model = derivation.topology, derivation.system
    states = len(tree.velocities) - tree.layout.mechanical
    lines = [
        f"{len(tree.positions)} coordinates q, {len(tree.velocities)} velocities v"
        f"{f', {states} of them states of networks' * bool(states)}, {len(tree.inputs)} inputs u",
    ]
    if model.bodies:
        counts = f"{len(model.joints)} joints, {len(tree.links)} moving links"
        lines.insert(0, f"{len(model.bodies)} bodies, {counts}")
        lines += [
            f"{len(graph.projection.vertices)} vertices, {len(graph.projection.edges)} edges: "
            f"{len(graph.branches)} branches, {len(graph.chords)} chords (per domain)",
            f"gravity {_vector(model.gravity)} m/s^2",
        ]
    if model.components:
        lines.insert(0, f"{len(model.components)} components in networks")
    if derivation.idle:
        lines.append(f"the mass matrix is singular: {cause(derivation.idle)}")
    return lines


def _bodies(model: System) -> Lines:
    rows = [("body", "mass / kg", "mass centre / m", "frames")]
    for body in model.bodies.values():
        center = (
            _vector(body.center) if body.center else f"first moment {_vector(body.first or ())}"
        )
        rows.append((body.name, _text(body.mass), center, ", ".join(body.frames) or "-"))
    return _table(rows)


def _joints(derivation: Derivation) -> Lines:
    model, chords = derivation.system, derivation.formulation.chords
    rows = [("joint", "type", "tail -> head", "axis", "remark")]
    coupled = {c.joint: c for c in model.couplings}
    for joint in model.joints:
        remark = "chord: closes a loop" if joint.name in chords else ""
        if joint.name in coupled:
            c = coupled[joint.name]
            remark = f"= {_text(c.ratio)} {c.master} + {_text(c.offset)}"
        ends = " -> ".join(joint.between)
        axis = _vector(joint.axis) if joint.freedoms in (1, 3) else "-"
        rows.append((joint.name, joint.kind, ends, axis, remark))
    return _table(rows)


def _domains(derivation: Derivation) -> Lines:
    rows = [("domain", "across", "through", "dimension")]
    for name in derivation.graph.domains:
        domain = derivation.system.domains.get(name) or DOMAINS[name]
        across, through = (f"{x.name} / ({x.symbol})" for x in (domain.across, domain.through))
        rows.append((name, across, through, str(domain.dimension)))
    return _table(rows)


def _graph(topology: Topology) -> Lines:
    branches = {edge.name for edge in topology.branches}
    rows = [("edge", "tail -> head", "")]
    for edge in topology.projection.edges:
        role = "branch" if edge.name in branches else "chord"
        rows.append((edge.name, f"{edge.tail} -> {edge.head}", role))
    return _table(rows)


def _tree(tree: KinematicTree) -> Lines:
    depth: list[int] = []
    lines = ["ground"]
    for link in tree.links:
        depth.append(depth[link.parent] + 1 if link.parent >= 0 else 1)
        turned = "" if link.forward else " (crossed from head to tail)"
        kind = f"[{link.joint.kind} {link.joint.name}]{turned}"
        lines.append("  " * depth[-1] + f"{kind} {link.name}")
    return lines


def _coordinates(tree: KinematicTree) -> Lines:
    listed = {"q": tree.positions, "v": tree.velocities, "u": tree.inputs}
    return _table(
        (f"{symbol}[{i}]", quantity.name, quantity.unit, quantity.about)
        for symbol, quantities in listed.items()
        for i, quantity in enumerate(quantities)
    )


def _constraints(derivation: Derivation) -> Lines:
    found = derivation.assembled
    rows = [("row", "multiplier", "unit", "")]
    for k, (equation, one) in enumerate(
        zip(equations(derivation.structure), found.unique, strict=True)
    ):
        multiplier = equation.multiplier
        remark = "" if one else "not unique"
        rows.append((str(k), multiplier.name, multiplier.unit, remark))
    freedoms = freedoms_text(found.freedoms)
    counts = f"{found.rank} independent, {found.redundant} redundant: {freedoms}"
    return [*_table(rows), counts]


def _matrix(matrix: IntegerMatrix) -> Lines:
    table = str(matrix).splitlines()
    if max(map(len, table)) <= WIDEST_TABLE:
        return table
    return [
        f"{name}: {_sum(matrix, row) or '0'}"
        for name, row in zip(matrix.rows, matrix.entries, strict=True)
    ]


def _sum(matrix: IntegerMatrix, row: dict[int, int]) -> str:
    return " ".join(f"{'+' if value > 0 else '-'} {matrix.columns[j]}" for j, value in row.items())


def _table(rows: Iterable[tuple[str, ...]]) -> Lines:
    rows = list(rows)
    if not rows:
        return []
    widths = [max(len(row[j]) for row in rows) for j in range(len(rows[0]))]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]


def _indented(lines: Lines) -> Lines:
    return [f"  {line}" for line in lines]


def _vector(values: Iterable[Any]) -> str:
    return "(" + ", ".join(_text(x) for x in values) + ")"


def _text(x: Any) -> str:
    if isinstance(x, Parameter):
        return x.name
    return f"{x:.6g}" if isinstance(x, float) else str(x)

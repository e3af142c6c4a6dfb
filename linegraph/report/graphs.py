"""Sections on graphs: of components and of the system, with incidence, cutset and circuit equations."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from linegraph.components.domains import ROTATION, SPATIAL, TRANSLATION
from linegraph.drawing.mechanism import mechanism_scene
from linegraph.drawing.pictures import chosen_panels, graph_scene
from linegraph.errors import ModelError
from linegraph.notation.tree import ZERO, Name
from linegraph.report.document import (
    Block,
    CellTable,
    Code,
    EquationRow,
    Formulas,
    Matrix,
    Picture,
    Section,
    Text,
    said,
)
from linegraph.report.system import count, listed

if TYPE_CHECKING:
    from linegraph.graph.forest import Topology
    from linegraph.graph.multigraph import Edge, Projection
    from linegraph.report.subject import Subject

MOST_WRITTEN = 20
"""Largest number of edges of a graph whose equations are written out besides their matrix."""


def topologies(subject: Subject) -> list[tuple[str, Topology]]:
    """The trees of all subspaces with edges; equal ones are listed once."""
    return [
        (" and ".join(map(called, names)), topology)
        for names, topology in chosen_panels(subject.derivation)
    ]


def called(domain: str) -> str:
    """A subspace in words: ``rotation_1d`` is rotation in one dimension."""
    if domain.endswith("_1d"):
        return f"{domain.removesuffix('_1d')} in one dimension"
    return {"electrical": "electricity", "hydraulic": "hydraulics", "thermal": "heat",
            "magnetic": "magnetism"}.get(domain, domain.replace("_", " "))  # fmt: skip


def terminal_graphs(subject: Subject) -> Section:
    """The section that lists the edges of every component."""
    order: dict[str, dict[str, tuple[Edge, list[str]]]] = {}
    for projection in subject.derivation.graph.projections:
        for edge in projection.edges:
            own = order.setdefault(edge.component, {})
            own.setdefault(edge.name, (edge, []))[1].append(projection.domain)
    places = {listed([called(d) for d in where]) for e in order.values() for _, where in e.values()}
    alike = len(places) == 1
    rows: list[tuple[Text, ...]] = []
    for component, edges in order.items():
        for k, (edge, domains) in enumerate(edges.values()):
            first: Text = (Code(component),) if k == 0 else ()
            name: Text = (Code(edge.name),)
            row: tuple[Text, ...] = (first, name, (Code(edge.tail), " → ", Code(edge.head)))
            rows.append(row if alike else (*row, (listed([called(d) for d in domains]),)))
    text = (
        "Each component shows its terminals only; between two of them an edge is measured, and the edges of "
        "a component are its terminal graph."
    )
    if subject.model.bodies:
        text += (
            " A body has an inertia edge from ground to its mass centre and a rigid arm from there to each "
            "of its frames; joints, elements and loads are edges between frames."
        )
    text += f" All edges are in {places.pop()}." if alike else ""
    head = ("component", "edge", "tail → head", *([] if alike else ["subspace"]))
    return Section("Terminal graphs of the components", (said(text), CellTable(head, tuple(rows))))


def system_graph(subject: Subject) -> Section:
    """The section on the system graph, subspace by subspace."""
    text = (
        "Terminals of one name are one vertex: so the terminal graphs unite to the system graph, which has "
        "one part for each subspace."
    )
    blocks: list[Block] = [said(text), *_mechanism(subject)]
    for title, topology in topologies(subject):
        blocks.append(Section(f"In {title}", tuple(_graph(subject, topology))))
    return Section("The system graph", tuple(blocks))


def _mechanism(subject: Subject) -> list[Block]:
    """A sketch of the mechanism; a remark where parameters have no values."""
    if not subject.model.bodies:
        return []
    try:
        scene = mechanism_scene(subject.derivation)
    except ModelError as error:
        return [said(f"There is no sketch: {error.thing} {error.problem}.")]
    return [Picture(scene, "The mechanism.")]


def _graph(subject: Subject, topology: Topology) -> list[Block]:
    projection = topology.projection
    size = (
        f"{count(len(projection.vertices), 'vertex', 'vertices')} and "
        f"{count(len(projection.edges), 'edge')}: {count(len(topology.branches), 'branch', 'branches')} and "
        f"{count(len(topology.chords), 'chord')}."
    )
    names = next(n for n, t in chosen_panels(subject.derivation) if t is topology)
    about = f"The system graph in {listed([called(n) for n in names])}; edges of the tree are bold."
    picture = Picture(graph_scene(subject.derivation, names), about, topology)
    return [said(f"It has {size}"), picture, *_incidence(projection)]


def _incidence(projection: Projection) -> list[Block]:
    matrix = projection.incidence
    return [
        said("Its incidence matrix; by the vertex postulate the through variables at every vertex, each with "
             "its sign there, add up to zero:"),
        Matrix("", matrix, ("vertices", "edges")),
    ]  # fmt: skip


# ---- topological equations


def topological(subject: Subject) -> Section:
    """The section on cutset and circuit equations, written out and as matrices."""
    blocks: list[Block] = [
        said(
            "Cutting a branch separates the vertices beyond it: the through variables over the cut add up to "
            "zero, one equation for each branch. A chord closes a circuit with branches: the across "
            "variables around it add up to zero, one equation for each chord. The two matrices are one: each "
            "is the negative transpose of the other."
        )
    ]
    formulation = subject.derivation.formulation
    pairs: list[tuple[str, str, Topology]] = []
    if subject.model.bodies:
        pairs.append((TRANSLATION.name, "translation", formulation.translation))
        pairs.append((ROTATION.name, "rotation", formulation.rotation))
    if subject.network is not None:
        pairs += [
            (t.projection.domain, called(t.projection.domain), t)
            for t in subject.network.topologies
        ]
    shown: list[object] = []
    for domain, title, topology in pairs:
        again = topology.cutset in shown
        shown.append(topology.cutset)
        large = len(topology.projection.edges) > MOST_WRITTEN
        inner = _as_matrices(subject, domain, topology, again) if large else [
            *_equations(subject, domain, topology), *_matrices(topology, again)]  # fmt: skip
        blocks.append(Section(f"In {title}", tuple(inner)))
    return Section("Cutset and circuit equations", tuple(blocks))


def _matrices(topology: Topology, again: bool) -> list[Block]:
    if not (topology.branches and topology.chords):
        return []
    if again:
        return [said("The matrices are those in translation.")]
    return [
        said("A of the cutset equations [U A] Y = 0:"),
        Matrix("A", topology.cutset, ("branches", "chords")),
        said("B of the circuit equations [B U] X = 0:"),
        Matrix("B", topology.circuit, ("chords", "branches")),
    ]


def _as_matrices(subject: Subject, domain: str, topology: Topology, again: bool) -> list[Block]:
    """For a large graph the matrices and how to read an equation off them."""
    if again:
        through, across = subject.through(domain, ""), subject.across(domain, "")
        return [said(
            "The same equations as in translation, with torques ", Name(through.letter, bold=True),
            " about the origin of ground for forces and angular velocities ",
            Name(across.letter, bold=True), " for velocities.")]  # fmt: skip
    if not (topology.branches and topology.chords):
        return _equations(subject, domain, topology)
    cut, circuit = min(
        (_cut(subject, domain, topology, k) for k in range(len(topology.cutset.rows))), key=_length
    ), min(
        (_circuit(subject, domain, topology, k) for k in range(len(topology.circuit.rows))),
        key=_length,
    )  # fmt: skip
    return [
        said("A of the cutset equations [U A] Y = 0, a row for each branch and a column for each chord:"),
        Matrix("A", topology.cutset, ("branches", "chords")),
        said("A row is a cutset equation: the through variable of its branch and, with their signs, those "
             "of its chords add up to zero. The shortest of them is"),
        Formulas((cut,)),
        said("A column turned round in sign is a circuit equation, since B = −Aᵀ in [B U] X = 0: the across "
             "variable of its chord and those of its branches add up to zero. The shortest of them is"),
        Formulas((circuit,)),
    ]  # fmt: skip


def _length(row: EquationRow) -> int:
    """Number of summands; a single one counts as many."""
    return len(getattr(row.left, "terms", ())) or MOST_WRITTEN


def _cut(subject: Subject, domain: str, topology: Topology, row: int) -> EquationRow:
    """The cutset equation of a branch."""
    first = subject.through(domain, topology.cutset.rows[row])
    of = partial(subject.through, domain)
    return EquationRow(subject.combined(topology.cutset, row, first, of), ZERO)


def _circuit(subject: Subject, domain: str, topology: Topology, row: int) -> EquationRow:
    """The circuit equation of a chord."""
    first = subject.across(domain, topology.circuit.rows[row])
    of = partial(subject.across, domain)
    return EquationRow(subject.combined(topology.circuit, row, first, of), ZERO)


def _equations(subject: Subject, domain: str, topology: Topology) -> list[Block]:
    blocks: list[Block] = []
    cuts = [_cut(subject, domain, topology, k) for k in range(len(topology.cutset.rows))]
    circuits = [_circuit(subject, domain, topology, k) for k in range(len(topology.circuit.rows))]
    if domain in SPATIAL and domain == ROTATION.name:
        blocks.append(said(
            "Torques are those about the origin of ground here, marked by a capital letter, so that the "
            "forces' levers are in them; the connecting equations say how."))  # fmt: skip
    if cuts:
        blocks += [said("Cutset equations:"), Formulas(tuple(cuts))]
    if circuits:
        blocks += [said("Circuit equations:"), Formulas(tuple(circuits))]
    return blocks or [said("It has neither cutsets nor circuits.")]


__all__ = ["called", "system_graph", "terminal_graphs", "topological"]

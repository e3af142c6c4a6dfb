"""The graphs: of the components, of the system in each subspace, their incidence, and the chosen trees."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from linegraph.body import GROUND
from linegraph.choices import ABSOLUTE, JOINT
from linegraph.domains import ROTATION, SPATIAL, TRANSLATION
from linegraph.formulation import DEPTH, INERTIA_WEIGHT, NOTHING_ACTS, edge_weights
from linegraph.joints import Compound
from linegraph.report.document import (
    Block,
    Code,
    Formulas,
    Inline,
    Matrix,
    Picture,
    Row,
    Section,
    Table,
    Text,
    said,
)
from linegraph.notation.expressions import number
from linegraph.notation.tree import ZERO, total
from linegraph.report.system import count, listed

if TYPE_CHECKING:
    from linegraph.graph import Edge, Projection
    from linegraph.report.subject import Subject
    from linegraph.topology import Topology

WIDEST = 24
"""A matrix of more columns than this is written row by row."""


def topologies(subject: Subject) -> list[tuple[str, Topology]]:
    """The tree of every subspace that has edges; of mechanics once where both trees are the same."""
    found: list[tuple[str, Topology]] = []
    formulation = subject.derivation.formulation
    if subject.model.bodies:
        alike = not formulation.level and _same(subject)
        title = "translation and rotation" if alike else "translation"
        found.append((title, formulation.translation))
        if not alike:
            found.append(("rotation", formulation.rotation))
    if subject.network is not None:
        found += [(called(t.projection.domain), t) for t in subject.network.topologies]
    return found


def _same(subject: Subject) -> bool:
    """Whether the graphs in translation and rotation have the same edges."""
    formulation = subject.derivation.formulation
    names = [
        [(e.name, e.tail, e.head) for e in t.projection.edges]
        for t in (formulation.translation, formulation.rotation)
    ]
    return names[0] == names[1]


def called(domain: str) -> str:
    """A subspace in words: ``rotation_1d`` is rotation in one dimension."""
    if domain.endswith("_1d"):
        return f"{domain.removesuffix('_1d')} in one dimension"
    return {"electrical": "electricity", "hydraulic": "hydraulics", "thermal": "heat",
            "magnetic": "magnetism"}.get(domain, domain.replace("_", " "))  # fmt: skip


def terminal_graphs(subject: Subject) -> Section:
    """The edges of every component."""
    order: dict[str, dict[str, tuple[Edge, list[str]]]] = {}
    for projection in subject.derivation.graph.projections:
        for edge in projection.edges:
            own = order.setdefault(edge.component, {})
            own.setdefault(edge.name, (edge, []))[1].append(projection.domain)
    rows = []
    for component, edges in order.items():
        for k, (edge, domains) in enumerate(edges.values()):
            first: Text = (Code(component),) if k == 0 else ()
            where = listed([called(d) for d in domains])
            rows.append((first, (Code(edge.name),), (Code(edge.tail), " → ", Code(edge.head)), (where,)))
    text = (
        "Each component shows its terminals only; between two of them an edge is measured, and the edges of "
        "a component are its terminal graph."
    )
    if subject.model.bodies:
        text += (
            " A body has an inertia edge from ground to its mass centre and a rigid arm from there to each "
            "of its frames; joints, elements and loads are edges between frames."
        )
    table = Table(("component", "edge", "tail → head", "subspace"), tuple(rows))
    return Section("Terminal graphs of the components", (said(text), table))


def system_graph(subject: Subject) -> Section:
    """The united graph, subspace by subspace."""
    text = (
        "Terminals of one name are one vertex: so the terminal graphs unite to the system graph, which has "
        "one part for each subspace."
    )
    blocks: list[Block] = [said(text), *_mechanism(subject)]
    for title, topology in topologies(subject):
        blocks.append(Section(f"In {title}", tuple(_graph(subject, topology))))
    return Section("The system graph", tuple(blocks))


def _mechanism(subject: Subject) -> list[Block]:
    if not subject.model.bodies:
        return []
    svg = drawn(subject, None)
    return [Picture(svg, "The mechanism.")] if svg else []


def drawn(subject: Subject, domain: str | None) -> str:
    """The graph of a subspace, or without one the mechanism; nothing where there are no drawings."""
    try:
        from linegraph import drawing
    except ImportError:
        return ""
    if domain is None:
        return str(drawing.mechanism_svg(subject.derivation))
    return str(drawing.graph_svg(subject.derivation, domain))


def _graph(subject: Subject, topology: Topology) -> list[Block]:
    projection = topology.projection
    size = (
        f"{count(len(projection.vertices), 'vertex', 'vertices')} and "
        f"{count(len(projection.edges), 'edge')}: {count(len(topology.branches), 'branch', 'branches')} and "
        f"{count(len(topology.chords), 'chord')}."
    )
    about = f"The system graph in {called(projection.domain)}; edges of the tree are bold."
    picture = Picture(drawn(subject, projection.domain), about, topology)
    return [said(f"It has {size}"), picture, *_incidence(projection)]


def _incidence(projection: Projection) -> list[Block]:
    matrix = projection.incidence
    return [
        said("Its incidence matrix; by the vertex postulate the through variables at every vertex, each with "
             "its sign there, add up to zero:"),
        Matrix("", matrix, ("vertices", "edges")),
    ]  # fmt: skip


# ---- trees


def chosen_tree(subject: Subject) -> Section:
    """The branches, and why these."""
    text = (
        "A tree connects all vertices of a part without a circuit; its edges are branches, the others "
        "chords. The across variables of branches determine all others, so the tree decides which variables "
        "are coordinates and which equations are constraints; the motion is the same with every tree."
    )
    blocks: list[Block] = [said(text)]
    if subject.model.bodies:
        blocks.append(Section("In mechanics", tuple(_mechanical(subject))))
    if subject.network is not None:
        blocks.append(Section("In networks", tuple(_normal(subject))))
    return Section("The chosen tree", tuple(blocks))


def _mechanical(subject: Subject) -> list[Block]:
    model, formulation = subject.model, subject.derivation.formulation
    topology = formulation.translation
    found = edge_weights(model, topology.projection)
    blocks: list[Block] = [
        said(
            "Of all trees that with the least weight is taken. Rigid arms weigh nothing and come first. A "
            "joint weighs one for each of its freedoms, since as a branch it gives that many coordinates, and "
            f"nothing where its motion is prescribed; {NOTHING_ACTS:g} more where nothing acts in it, so that "
            "joints with an effort, an element or a start are rather branches; and up to "
            f"{DEPTH:g} more the farther it is from ground, so that a loop is cut far out. An inertia edge "
            f"weighs {INERTIA_WEIGHT:g}, more than any joint; a force element or a constraint is always a chord."
        )
    ]
    branches = {edge.name for edge in topology.branches}
    rows = []
    for edge in topology.projection.edges:
        if edge.name not in found:
            continue
        weight = found[edge.name]
        shown = ("∞",) if math.isinf(weight) else (number(round(weight, 2)),)
        branch = edge.name in branches
        role = (Code("branch", strong=True),) if branch else ("chord",)
        rows.append(((Code(edge.name),), shown, role, _because(subject, edge)))
    blocks.append(Table(("edge", "weight", "role", "made up of"), tuple(rows)))
    blocks += [said(*text) for text in _wishes(subject)]
    blocks += [said(*text) for text in _cuts(subject, found)]
    if formulation.level:
        names = listed([f"{angle.body}/inertia" for angle in formulation.level.values()])
        blocks.append(said(
            "In rotation the tree is another: orientations are measured from ground, so the branches there "
            "are the inertia edges ", Code(names), "."))  # fmt: skip
    return blocks


def _because(subject: Subject, edge: Edge) -> Text:
    model = subject.model
    joint = next((j for j in model.joints if j.name == edge.name), None)
    if joint is None:
        inertia = edge.name.endswith("/inertia") and edge.component in model.bodies
        return ("inertia edge",) if inertia else ("its law gives the through variable",)
    if isinstance(joint, Compound):
        return ("compound joint: it cannot be a chord",)
    parts = ["prescribed" if joint.drive is not None else count(joint.freedoms, "freedom")]
    acting = {getattr(e, "joint", None) for e in model.elements}
    if not (joint.effort or joint.name in acting or joint.start is not None):
        parts.append("nothing acts in it")
    parts.append("distance from ground")
    return (", ".join(parts),)


def _wishes(subject: Subject) -> list[Text]:
    choices, found = subject.model.choices, []
    if choices.tree:
        found.append(("Wished for as branches were ", Code(", ".join(choices.tree)), "."))
    if choices.coordinates != JOINT:
        found.append(("Wished for were the coordinates ", Code(choices.coordinates), " for all bodies."))
    for body, kind in choices.of_body.items():
        found.append(("Wished for were the coordinates ", Code(kind), " for ", Code(body), "."))
    if subject.model.couplings:
        names = ", ".join(dict.fromkeys(n for c in subject.model.couplings for n in (c.joint, c.master)))
        found.append(("Joints that follow each other have to be branches: ", Code(names), "."))
    formulation = subject.derivation.formulation
    if formulation.absolute and choices.coordinates != ABSOLUTE:
        names = ", ".join(formulation.absolute)
        found.append(("Bodies whose inertia edge is a branch: ", Code(names), "."))
    if not found and not formulation.chords:
        found.append(("No joint closes a loop, so every joint is a branch: the tree of joints is the only one.",))
    return found


def _cuts(subject: Subject, found: dict[str, float]) -> list[Text]:
    """Why each joint that is a chord is one."""
    texts: list[Text] = []
    for chord in subject.derivation.formulation.chords:
        circuit = subject.derivation.circuit_of(chord)
        others = [name for name in circuit if name != chord]
        text: list[Inline] = ["The joint ", Code(chord), " closes the circuit with ",
                              Code(", ".join(others)), ". "]  # fmt: skip
        heavier = [n for n in others if found.get(n, 0.0) > found[chord]]
        equal = [n for n in others if found.get(n, 0.0) == found[chord]]
        if heavier:
            text.append("It was cut because the branches were wished for.")
        elif equal:
            text += ["None of them weighs more than it; of equal ones, ", Code(", ".join(equal)),
                     ", those declared first are branches, so it is cut."]  # fmt: skip
        else:
            text.append("It weighs most of them, so it is cut: its circuit equation is a constraint.")
        texts.append(tuple(text))
    return texts


def _normal(subject: Subject) -> list[Block]:
    """The normal tree: sources, stores, dissipators, by what they give."""
    network = subject.network
    assert network is not None
    blocks: list[Block] = [
        said(
            "The tree is a normal one: first edges whose across variable is given, then as many stores of an "
            "across variable as possible, then edges with a law between both variables, then as few stores of "
            "a through variable as possible; edges whose through variable is given are chords. The states are "
            "what stores keep, as far as they are independent by the exact rank of all laws."
        )
    ]
    states = {state.key for state in network.states}
    stores = {store.edge: store for store in network.laws.stores}
    for topology in network.topologies:
        branches = {edge.name for edge in topology.branches}
        rows = []
        for edge in topology.projection.edges:
            store = stores.get(edge.name)
            role = (Code("branch", strong=True),) if edge.name in branches else ("chord",)
            what = _gives(subject, edge.name)
            if store is not None:
                kind = "across" if store.key[0] == "X" else "through"
                what = f"store of its {kind} variable"
                what += ", a state" if store.key in states else ", depends on others"
            rows.append(((Code(edge.name),), role, (what,)))
        title = f"{called(topology.projection.domain)}: edge"
        blocks.append(Table((title, "role", "what it is"), tuple(rows)))
    for edge_name, on in network.dependent.items():
        what: list[Inline] = ["The store ", Code(edge_name), " is in excess: "]
        what += ["it follows from ", Code(", ".join(on))] if on else ["it is given by sources"]
        blocks.append(said(*what, ", so it adds to the matrix of the others as a mass does."))
    return blocks


def _gives(subject: Subject, edge: str) -> str:
    network = subject.network
    assert network is not None
    kinds: set[str] = set()
    for static in network.laws.statics:
        touched = {s for s in network.laws.calculus.gradient(static.zero) if s[0] in ("X", "Y")}
        if any(place == edge for _, place in touched):
            alone = len(touched) == 1
            kinds.add("across" if alone and ("X", edge) in touched else
                      "through" if alone and ("Y", edge) in touched else "both")  # fmt: skip
    if kinds == {"across"}:
        return "across variable given"
    if kinds == {"through"}:
        return "through variable given"
    return "law between variables"


# ---- topological equations


def topological(subject: Subject) -> Section:
    """Cutset and circuit equations, written out and as matrices."""
    blocks: list[Block] = [
        said(
            "Cutting a branch separates the vertices beyond it: the through variables over the cut add up to "
            "zero, one equation for each branch. A chord closes a circuit with branches: the across variables "
            "around it add up to zero, one equation for each chord. The two matrices are one: each is the "
            "negative transpose of the other."
        )
    ]
    formulation = subject.derivation.formulation
    pairs: list[tuple[str, str, Topology]] = []
    if subject.model.bodies:
        pairs.append((TRANSLATION.name, "translation", formulation.translation))
        pairs.append((ROTATION.name, "rotation", formulation.rotation))
    if subject.network is not None:
        pairs += [(t.projection.domain, called(t.projection.domain), t) for t in subject.network.topologies]
    shown: list[object] = []
    for domain, title, topology in pairs:
        inner = _equations(subject, domain, topology)
        if topology.branches and topology.chords:
            if topology.cutset in shown:
                inner.append(said("The matrices are those in translation."))
            else:
                inner += [
                    said("A of the cutset equations [U A] Y = 0:"),
                    Matrix("A", topology.cutset, ("branches", "chords")),
                    said("B of the circuit equations [B U] X = 0:"),
                    Matrix("B", topology.circuit, ("chords", "branches")),
                ]
                shown.append(topology.cutset)
        blocks.append(Section(f"In {title}", tuple(inner)))
    return Section("Cutset and circuit equations", tuple(blocks))


def _equations(subject: Subject, domain: str, topology: Topology) -> list[Block]:
    blocks: list[Block] = []
    cutset, circuit = topology.cutset, topology.circuit
    cuts = [
        Row(subject.combined(cutset, i, subject.through(domain, name), lambda e: subject.through(domain, e)), ZERO)
        for i, name in enumerate(cutset.rows)
    ]
    circuits = [
        Row(subject.combined(circuit, i, subject.across(domain, name), lambda e: subject.across(domain, e)), ZERO)
        for i, name in enumerate(circuit.rows)
    ]
    if domain in SPATIAL and domain == ROTATION.name:
        blocks.append(said(
            "Torques are those about the origin of ground here, marked by a capital letter, so that the "
            "forces' levers are in them; the connecting equations say how."))  # fmt: skip
    if cuts:
        blocks += [said("Cutset equations:"), Formulas(tuple(cuts))]
    if circuits:
        blocks += [said("Circuit equations:"), Formulas(tuple(circuits))]
    return blocks or [said("It has neither cutsets nor circuits.")]


__all__ = ["GROUND", "chosen_tree", "system_graph", "terminal_graphs", "topological", "total"]

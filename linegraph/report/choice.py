"""Section on the chosen trees: weights of edges, choices of the user, and joints that were cut."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from linegraph.components.joints import Compound
from linegraph.formulation.formulate import DEPTH, INERTIA_WEIGHT, NOTHING_ACTS, edge_weights
from linegraph.model.choices import ABSOLUTE, JOINT
from linegraph.notation.expressions import number
from linegraph.report.document import Block, CellTable, Code, Inline, Section, Text, said
from linegraph.report.graphs import called
from linegraph.report.system import count, listed

if TYPE_CHECKING:
    from linegraph.graph.multigraph import Edge
    from linegraph.report.subject import Subject


def chosen_tree(subject: Subject) -> Section:
    """The section that lists the branches and the reasons for choosing them."""
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
            "Of all trees that with the least weight is taken. Rigid arms weigh nothing and come first. "
            "A joint weighs one for each of its freedoms, since as a branch it gives that many "
            "coordinates, and nothing where its motion is prescribed; "
            f"{NOTHING_ACTS:g} more where nothing acts in it, so that joints with an effort, an element "
            f"or a start are rather branches; and up to {DEPTH:g} more the farther it is from ground, so "
            f"that a loop is cut far out. An inertia edge weighs {INERTIA_WEIGHT:g}, more than any joint; "
            "a force element or a constraint is always a chord."
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
    blocks.append(CellTable(("edge", "weight", "role", "made up of"), tuple(rows)))
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
    free = count(joint.freedoms, "freedom") if joint.freedoms else "no freedom"
    parts = ["prescribed" if joint.drive is not None else free]
    acting = {getattr(e, "joint", None) for e in model.elements}
    if not (joint.effort or joint.name in acting or joint.start is not None):
        parts.append("nothing acts in it")
    parts.append("distance from ground")
    return (", ".join(parts),)


def _wishes(subject: Subject) -> list[Text]:
    choices = subject.model.choices
    found: list[Text] = []
    if choices.tree:
        found.append(("Wished for as branches were ", Code(", ".join(choices.tree)), "."))
    if choices.coordinates != JOINT:
        found.append(
            ("Wished for were the coordinates ", Code(choices.coordinates), " for all bodies.")
        )
    for body, kind in choices.of_body.items():
        found.append(("Wished for were the coordinates ", Code(kind), " for ", Code(body), "."))
    if subject.model.couplings:
        names = ", ".join(
            dict.fromkeys(n for c in subject.model.couplings for n in (c.joint, c.master))
        )
        found.append(("Joints that follow each other have to be branches: ", Code(names), "."))
    formulation = subject.derivation.formulation
    if formulation.absolute and choices.coordinates != ABSOLUTE:
        names = ", ".join(formulation.absolute)
        found.append(("Bodies whose inertia edge is a branch: ", Code(names), "."))
    if not found and not formulation.chords:
        found.append(
            (
                "No joint closes a loop, so every joint is a branch: the tree of joints is the only one.",
            )
        )
    return found


def _cuts(subject: Subject, found: dict[str, float]) -> list[Text]:
    """For each joint that is a chord, the reason."""
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
            text.append(
                "It weighs most of them, so it is cut: its circuit equation is a constraint."
            )
        texts.append(tuple(text))
    return texts


def _normal(subject: Subject) -> list[Block]:
    """The normal tree of each network: sources, stores and dissipators."""
    network = subject.network
    assert network is not None
    blocks: list[Block] = [
        said(
            "The tree is a normal one: first edges whose across variable is given, then as many stores "
            "of an across variable as possible, then edges with a law between both variables, then as "
            "few stores of a through variable as possible; edges whose through variable is given are "
            "chords. The states are what stores keep, as far as they are independent by the exact rank "
            "of all laws."
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
        blocks.append(CellTable((title, "role", "what it is"), tuple(rows)))
    for edge_name, on in network.dependent.items():
        excess: list[Inline] = ["The store ", Code(edge_name), " is in excess: "]
        reason: list[Inline] = ["it follows from ", Code(", ".join(on))]
        excess += reason if on else ["it is given by sources"]
        blocks.append(said(*excess, ", so it adds to the matrix of the others as a mass does."))
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

"""Sections on the connecting equations and on the principle of orthogonality for this system."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.domains import ROTATION, TRANSLATION
from linegraph.components.forces import PointForce
from linegraph.notation.tree import TRANSPOSED, ZERO, Math, Name, Over, Power, Product, Sum, total
from linegraph.report.document import Block, Code, EquationRow, Formulas, Inline, Section, said
from linegraph.report.graphs import called
from linegraph.report.laws import (
    crossed,
    dotted,
    element_motion,
    port_variables,
    pull_of,
    vector,
)
from linegraph.report.motion import motion
from linegraph.report.system import letter, motion_equation

if TYPE_CHECKING:
    from linegraph.report.subject import Subject

MOST_EDGES = 16
"""For graphs with more edges the sum over all edges is written with Σ."""

MOST_BODIES = 12
"""For more bodies the remaining sum is written with Σ."""


def connecting(subject: Subject) -> Section:
    """The section on relations between variables of different subspaces and kinds."""
    blocks: list[Block] = [said("Connecting equations tie the subspaces to each other.")]
    if subject.model.bodies:
        blocks.append(Section("Translation and rotation", _arms(subject)))
        blocks.append(Section("Motion in terms of the velocities", motion(subject)))
    ports = [] if subject.network is None else subject.network.ports
    if ports:
        names = ", ".join(branch.name for branch in ports)
        blocks.append(Section("Networks and mechanics", (
            said("These edges of networks act in mechanics along one coordinate each, and their across "
                 "variable is its rate: ", Code(names), "."),)))  # fmt: skip
    return Section("Connecting equations", tuple(blocks))


def _arms(subject: Subject) -> tuple[Block, ...]:
    """An arm as a transformer between translation and rotation."""
    arm, spin = Name("ρ", bold=True), Name("ω", bold=True)
    force, torque = Name("f", bold=True), Name("τ", bold=True)
    moment = Name("T", bold=True)
    head = Name("r", ("head",), bold=True)
    rows = (
        EquationRow(Name("v", ("arm",), bold=True), crossed(spin, arm)),
        EquationRow(moment, total([(False, torque), (False, crossed(head, force))], ordered=False)),
    )
    text: tuple[Inline, ...] = (
        "A rigid arm ", arm, " turns with its body, so a rotation appears in translation as a velocity "
        "across the arm; and a force appears in rotation as a torque: the torque ", moment, " of an edge "
        "about the origin of ground is the torque ", torque, " about its own head and the moment of its "
        "force there."
    )  # fmt: skip
    arms = [e.name for e in subject.derivation.topology.projection.edges if "/arm" in e.name]
    blocks: list[Block] = [said(*text), Formulas(rows)]
    if arms and len(arms) <= MOST_EDGES:
        of = [
            EquationRow(
                vector("v", name), crossed(vector("ω", name.partition("/")[0]), vector("ρ", name))
            )
            for name in arms
            if not name.startswith("ground/")
        ]
        blocks.append(Formulas(tuple(of)))
    return tuple(blocks)


# ---- orthogonality


def orthogonality(subject: Subject) -> Section:
    """The section with the principle in this system's variables, and the terms that remain of it."""
    blocks: list[Block] = [
        said(
            "By the principle of orthogonality the through variables of all edges, which satisfy the cutset "
            "equations, and the across variables of all edges, which satisfy the circuit equations, are "
            "orthogonal in every subspace. That stays so when the across variables are varied, by δ:"
        ),
        Formulas(tuple(_sums(subject))),
    ]
    left = _left(subject)
    if left is not None:
        blocks.append(said(
            "Add the sums. With the connecting equations the arms and the moments of forces leave each other "
            "out, and with the terminal equations of the joints their reactions do no work. What remains are "
            "inertia edges, efforts, elements and what closes loops:"))  # fmt: skip
        blocks.append(Formulas((EquationRow(left, ZERO),)))
    blocks.append(said(
        "The variations of all across variables follow from those of the velocities, which are independent; "
        "so each coefficient is zero, and these are the equations of motion ",
        motion_equation(subject), "."))  # fmt: skip
    return Section("The principle of orthogonality", tuple(blocks))


def _sums(subject: Subject) -> list[EquationRow]:
    rows = []
    graph = subject.derivation.graph
    for projection in graph.projections:
        domain = projection.domain
        spatial = domain in (TRANSLATION.name, ROTATION.name)
        edges = [edge.name for edge in projection.edges]
        if len(edges) > MOST_EDGES:
            pair: Math = _pair(subject, domain, "e", spatial)
            rows.append(EquationRow(Over("Σ", f"e in {called(domain)}", pair), ZERO))
            continue
        terms: list[tuple[bool, Math]] = [
            (False, _pair(subject, domain, e, spatial)) for e in edges
        ]
        rows.append(EquationRow(total(terms, ordered=False), ZERO))
    return rows


def _pair(subject: Subject, domain: str, edge: str, spatial: bool) -> Math:
    x, y = subject.across(domain, edge), subject.through(domain, edge)
    varied = Name(x.letter, x.subs, x.dots, x.bold, "δ")
    return dotted(y, varied) if spatial else Product((y, varied))


def _left(subject: Subject) -> Math | None:
    """Terms that remain of the sum after connecting equations and joints' terminal equations are used."""
    model = subject.model
    if not model.bodies:
        return None
    terms: list[tuple[bool, Math]] = []
    many = len(model.bodies) > MOST_BODIES
    for body in ["i"] if many else list(model.bodies):
        edge = f"{body}/inertia" if not many else "i"
        force = dotted(vector("f", edge), vector("v", edge, before="δ"))
        torque = dotted(vector("τ", edge), vector("ω", body, before="δ"))
        one = total([(False, force), (False, torque)], ordered=False)
        terms.append(
            (False, Over("Σ", "bodies i", Sum(((False, force), (False, torque)))) if many else one)
        )
    terms += _efforts(subject)
    for element in model.force_elements:
        if isinstance(element, PointForce):
            terms.append(
                (False, dotted(vector("f", element.name), vector("v", element.name, before="δ")))
            )
            terms.append(
                (False, dotted(vector("τ", element.name), vector("ω", element.name, before="δ")))
            )
            continue
        _, v = element_motion(subject, element)
        rate = subject.look.name(v.name)
        terms.append((True, Product((pull_of(element.name), _varied(rate)))))
    for branch in subject.network.ports if subject.network is not None else ():
        x, y = port_variables(subject, branch)
        assert isinstance(x, Name)
        terms.append((True, Product((y, _varied(x)))))
    if subject.tree.closed:
        row = Product(
            (Power(letter("λ"), TRANSPOSED), letter("J"), Name("v", bold=True, before="δ"))
        )
        terms.append((False, row))
    return total(terms, ordered=False)


def _varied(name: Name) -> Name:
    return Name(name.letter, name.subs, name.dots, name.bold, "δ")


def _efforts(subject: Subject) -> list[tuple[bool, Math]]:
    """Efforts of joints times variations of their velocities."""
    terms: list[tuple[bool, Math]] = []
    given = {quantity.name for quantity in subject.tree.inputs}
    for joint in subject.model.joints:
        if not joint.effort or joint.drive is not None:
            continue
        own = [quantity.name for quantity in joint.positions()]
        for quantity in joint.velocities():
            if quantity.name not in given:
                continue  # it follows another joint
            effort = subject.look.name(subject.efforts[quantity.name])
            rate = f"{quantity.name}_dot" if quantity.name in own else quantity.name
            terms.append((False, Product((effort, _varied(subject.look.name(rate))))))
    return terms


__all__ = ["connecting", "orthogonality"]

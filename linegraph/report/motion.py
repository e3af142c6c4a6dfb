"""Motion in terms of velocities: of bodies as sums along the tree, of mass centres in closed form."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.components.body import MASS_CENTER
from linegraph.errors import ModelError
from linegraph.ir.program import Result, operations_of
from linegraph.model.terminal_graphs import terminals_of
from linegraph.notation.plain import Plain
from linegraph.notation.tree import ZERO, Components, Math, Name, total
from linegraph.report.document import Block, EquationRow, Formulas, said
from linegraph.report.laws import vector

if TYPE_CHECKING:
    from linegraph.report.subject import Subject

MOST_OPERATIONS = 150
"""Largest number of operations for which closed forms of mass centres are tried."""

MOST_PRODUCTS = 1000
"""Largest number of products of two terms spent on them."""

MOST_PRINTED, LONGEST = 900, 280
"""Largest number of readable characters of positions and velocities: of all, and of one vector."""

LONGEST_WAY = 3
"""Largest number of joints in a sum; beyond it the motion of a nearer body is used."""

WIDEST = 76
"""A vector of more characters is written by components."""


def motion(subject: Subject) -> tuple[Block, ...]:
    """Angular velocities of bodies as sums along the tree; mass centres as sums and in closed form."""
    rows = []
    derivation = subject.derivation
    paths: dict[str, list[tuple[bool, Math]]] = {}
    for body in subject.model.bodies:
        if body in derivation.formulation.absolute:
            paths[body] = [(False, vector("ω", f"{body}/inertia"))]
    owner = {vertex: body for vertex, (body, _) in terminals_of(subject.model).items()}
    owner |= {f"{body}.{MASS_CENTER}": body for body in subject.model.bodies}
    for step in derivation.formulation.rotation.walk:
        near, far = owner.get(step.near, "ground"), owner.get(step.far, "ground")
        if near == far or far in paths:
            continue
        before = paths.get(near, [])
        if len(before) >= LONGEST_WAY:
            before = [(False, vector("ω", near))]
        paths[far] = [*before, (not step.forward, vector("ω", step.edge.name))]
    for body in subject.model.bodies:
        rows.append(EquationRow(vector("ω", body), total(paths.get(body, []), ordered=False)))
    text = (
        "By the circuit equations of rotation the angular velocity of a body is the sum of those of the "
        "joints on its way to ground:"
    )
    after = (
        "and its mass centre's velocity is the sum of those across arms and joints on the same way, as the "
        "circuit equations of translation say. With the motions of the joints, every across variable is "
        "linear in the velocities."
    )
    return (said(text), Formulas(tuple(rows)), said(after), *centers(subject))


def centers(subject: Subject) -> list[Block]:
    """Positions and velocities of mass centres in ground axes; empty if they are long."""
    found = [row for row in _rows(subject) if len(Plain()(row.right)) <= LONGEST]
    length = sum(len(Plain()(row.right)) for row in found)
    if not found or length > MOST_PRINTED:
        return []
    text = (
        "Put together along the tree, in the axes of ground: the place of a mass centre and its velocity, "
        "which is that across the inertia edge; components that are not shown are zero:"
    )
    return [said(text), Formulas(tuple(short for row in found for short in _by_components(row)))]


def _rows(subject: Subject) -> list[EquationRow]:
    """Position and velocity of every mass centre; empty if they have too many terms."""
    scheme = subject.equations.edges
    frames = {body: scheme.center(body) for body in subject.model.bodies}
    entries = [x for frame in frames.values() for x in (*frame.origin, *frame.linear)]
    if operations_of((Result("", (len(entries),), tuple(entries), ""),)) > MOST_OPERATIONS:
        return []
    try:
        closed = _closed(subject, entries)
    except ModelError:
        return []  # too many terms
    rows = []
    for k, body in enumerate(frames):
        place, speed = closed[6 * k : 6 * k + 3], closed[6 * k + 3 : 6 * k + 6]
        rows.append(EquationRow(vector("r", f"{body}.{MASS_CENTER}"), _vector(place)))
        rows.append(EquationRow(vector("v", f"{body}/inertia"), _vector(speed)))
    return rows


def _closed(subject: Subject, entries: list[Any]) -> list[Math]:
    from linegraph.algebra.sympy_scalars import Sympy
    from linegraph.symbolic.simplification import Simplifier

    names = Sympy(subject.derivation.symbol_names)
    simplifier = Simplifier(lambda symbol: names.symbol(*symbol), subject.level, MOST_PRODUCTS)
    found = simplifier.all(entries, "mass centres")
    return [subject.look.tree(subject.valued(x)) for x in found]


def _vector(entries: list[Math]) -> Math:
    return ZERO if all(entry == ZERO for entry in entries) else Components(tuple(entries))


def _by_components(row: EquationRow) -> list[EquationRow]:
    """A vector as a whole if it fits, else its components that are not zero."""
    if not isinstance(row.right, Components) or len(Plain()(row.right)) <= WIDEST:
        return [row]
    assert isinstance(row.left, Name)
    left = row.left
    return [
        EquationRow(Name(left.letter, (*left.subs, axis)), entry)
        for axis, entry in zip("xyz", row.right.entries, strict=True)
        if entry != ZERO
    ]

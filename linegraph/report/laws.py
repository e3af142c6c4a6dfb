"""Section on terminal equations: the law of each component, in the variables of its edges."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.algebra.residues import CONSTANT
from linegraph.components.body import MASS_CENTER
from linegraph.components.domains import SPATIAL
from linegraph.components.forces import Element, PointForce
from linegraph.components.forces.load import BODY
from linegraph.components.joints.base import BY_INPUT
from linegraph.ir.dag import SUB, SYMBOL, Node
from linegraph.networks.static import LOOP
from linegraph.notation.expressions import number
from linegraph.notation.plain import Plain
from linegraph.notation.tree import (
    ZERO,
    Components,
    Math,
    Name,
    Over,
    Product,
    Sum,
    TwoSides,
    negated,
    total,
)
from linegraph.report.document import (
    Block,
    CellTable,
    Code,
    EquationRow,
    Formulas,
    Inline,
    Section,
    Text,
    said,
)
from linegraph.report.nodes import Nodes
from linegraph.report.system import letter
from linegraph.spatial.rotation import IDENTITY_MATRIX
from linegraph.spatial.vector import times

LONGEST_CELL = 60
"""Motions of joints longer than this (characters) are placed below their table."""

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.components.joints import Joint
    from linegraph.components.scalar.branches import Branch
    from linegraph.report.subject import Subject


def vector(text: str, edge: str, *, dots: int = 0, before: str = "") -> Name:
    """Symbol of a vector of an edge.

    Args:
        text: the letter.
        edge: the edge, as subscript.
        dots: number of dots.
        before: sign before the letter, such as δ.
    """
    return Name(text, (edge,), dots=dots, bold=True, before=before)


def dotted(left: Math, right: Math) -> Math:
    """The scalar product of two vectors.

    Args:
        left: the first vector.
        right: the second vector.
    """
    return Product((left, right), "·")


def crossed(left: Math, right: Math) -> Math:
    """The vector product of two vectors.

    Args:
        left: the first vector.
        right: the second vector.
    """
    return Product((left, right), "×")


def terminal_equations(subject: Subject) -> Section:
    """The section on the laws of all components."""
    blocks: list[Block] = [
        said(
            "Terminal equations tie the across variables of a component's edges to their through variables."
        )
    ]
    if subject.model.bodies:
        blocks.append(Section("Bodies", _bodies(subject)))
    if subject.model.joints:
        blocks.append(Section("Joints", _joints(subject)))
    if subject.model.constraints or subject.model.relations:
        blocks.append(Section("Constraints", _constraints(subject)))
    if subject.model.force_elements:
        blocks.append(Section("Force elements", _elements(subject)))
    if subject.network is not None:
        blocks.append(Section("Components of networks", tuple(network_laws(subject))))
    return Section("Terminal equations", tuple(blocks))


def _bodies(subject: Subject) -> tuple[Block, ...]:
    rows = []
    for body in subject.model.bodies.values():
        edge = f"{body.name}/inertia"
        mass = subject.value(body.mass)
        if mass != ZERO:
            pull: Math = vector("r", f"{body.name}.{MASS_CENTER}", dots=2)
            if any(x != 0 for x in subject.model.gravity):
                pull = Sum(((False, pull), (True, letter("g"))))
            factors = mass.factors if isinstance(mass, Product) else (mass,)
            rows.append(EquationRow(vector("f", edge), negated(Product((*factors, pull)))))
        if any(x != 0 for x in body.inertia):
            spin = vector("ω", body.name)
            tensor = vector("J", body.name)
            terms = Sum(((False, Product((tensor, spin.rate()))),
                         (False, crossed(spin, Product((tensor, spin))))))  # fmt: skip
            rows.append(EquationRow(vector("τ", edge), negated(terms)))
    text = said(
        "The inertia edge of a body exerts d'Alembert's force and torque on its mass centre, the weight with "
        "it: here ", Name("r", bold=True), " is the position of the mass centre, ", Name("ω", bold=True),
        " the angular velocity of the body and ", Name("J", bold=True), " its central inertia. Rigid "
        "arms have no law for their through variables: their across variables are fixed in the body."
    )  # fmt: skip
    return (text, Formulas(tuple(rows))) if rows else (text,)


def _joints(subject: Subject) -> tuple[Block, ...]:
    rows = []
    long: list[EquationRow] = []
    for joint in subject.model.joints:
        moves, pushes = _joint(subject, joint)
        found = [part for part in moves if isinstance(part, TwoSides)]
        if sum(len(Plain()(part)) for part in found) > LONGEST_CELL:
            long += [row for part in found for row in _by_components(part)]
            moves = ("below",)
        rows.append(((Code(joint.name),), moves, pushes))
    text = (
        "A joint leaves its head free to move against its tail as its velocities say; in every other "
        "direction it holds it with a reaction that does no work, so only the power of its effort remains. "
        "Components are those in the axes of its head."
    )
    table = CellTable(("joint", "motion of the head against the tail", "effort"), tuple(rows))
    return (said(text), table, *([Formulas(tuple(long))] if long else []))


def _by_components(part: TwoSides) -> list[EquationRow]:
    """A vector that is too long for a cell, as equations of its components."""
    assert isinstance(part.left, Name)
    assert isinstance(part.right, Components)
    subs = ((*part.left.subs, axis) for axis in "xyz")
    return [
        EquationRow(Name(part.left.letter, sub), entry)
        for sub, entry in zip(subs, part.right.entries, strict=True)
    ]


def _joint(subject: Subject, joint: Joint) -> tuple[Text, Text]:
    """Relative motion of a joint in its head's axes, and its through variables along the motion."""
    moves = [
        TwoSides(vector(symbol, joint.name), "=", Components(entries))
        for symbol, entries in zip("ωv", _relative_motion(subject, joint), strict=True)
        if any(entry != ZERO for entry in entries)
    ]
    efforts = _efforts(subject, joint) or (f"none; {6 - joint.freedoms} reactions",)
    return _listed(moves) or ("none",), efforts


def _relative_motion(subject: Subject, joint: Joint) -> tuple[tuple[Math, ...], tuple[Math, ...]]:
    """Angular velocity and velocity of the head relative to the tail, by components in the head's axes."""
    own, algebra = joint.resolved(subject.resolve), subject.algebra
    names = [quantity.name for quantity in joint.positions()]
    rates = [_rate(subject, quantity.name, names) for quantity in joint.velocities()]
    q, v = (tuple(algebra.symbol("", name) for name in found) for found in (names, rates))
    motion, axes = own.motion(algebra, q, v), own.alignment()

    def components(directions: Iterable[Any]) -> tuple[Math, ...]:
        turned = [times(axes, d) for d in directions]
        entries = (sum(d[k] * x for d, x in zip(turned, v, strict=True)) for k in range(3))
        return tuple(map(subject.expression, entries))

    return components(motion.angular), components(motion.linear)


def _efforts(subject: Subject, joint: Joint) -> Text:
    """The efforts of a joint along its velocities, or how its motion is prescribed."""
    if joint.drive is not None:
        by = "inputs" if joint.drive == BY_INPUT else "the time"
        return (f"what drives it; its motion is prescribed by {by}",)
    # a joint that follows another one has no input
    given = {quantity.name for quantity in subject.tree.inputs} if joint.effort else set()
    own = [quantity.name for quantity in joint.velocities() if quantity.name in given]
    return _listed([subject.look.name(subject.efforts[name]) for name in own])


def _listed(parts: Sequence[Inline]) -> Text:
    """Parts with commas between them."""
    return tuple(x for part in parts for x in (", ", part))[1:]


def _rate(subject: Subject, name: str, positions: Sequence[str]) -> str:
    return f"{name}_dot" if name in positions else name


def _constraints(subject: Subject) -> tuple[Block, ...]:
    rows = []
    for limit in subject.model.constraints:
        loose = [q.name for q, _ in limit.equations()]
        parts: list[Inline] = []
        for name in loose:
            parts += [", "] if parts else []
            parts.append(subject.look.name(subject.multiplier_symbols[name]))
        about = "; ".join(q.about for q, _ in limit.equations())
        rows.append(((Code(limit.name),), (limit.kind,), tuple(parts), (about,)))
    for relation in subject.model.relations:
        quantity = relation.equation()
        rows.append(
            (
                (Code(relation.name),),
                ("relation",),
                (subject.look.name(subject.multiplier_symbols[quantity.name]),),
                (quantity.about,),
            )
        )
    text = "The across variable of a constraint is known and its through variable is not: a multiplier."
    return (said(text), CellTable(("constraint", "type", "multipliers", "meaning"), tuple(rows)))


# ---- force elements


def _elements(subject: Subject) -> tuple[Block, ...]:
    rows: list[EquationRow] = []
    for element in subject.model.force_elements:
        rows += (
            _load(subject, element)
            if isinstance(element, PointForce)
            else [_element(subject, element)]
        )
    text: Text = (
        "A positive through variable ", Name("y"), " of an element pulls: its two points together, along the "
        "line between them whose length is ", Name("ℓ"), ", or the coordinate of its joint back. A load is "
        "the force and the torque given.")  # fmt: skip
    turning = [e.name for e in subject.model.force_elements if getattr(e, "axes", "") == BODY]
    blocks: list[Block] = [said(*text), Formulas(tuple(rows))]
    if turning:
        blocks.append(said("In the axes of the body they act on: ", Code(", ".join(turning)), "."))
    return tuple(blocks)


def _element(subject: Subject, element: Element) -> EquationRow:
    x, v = element_motion(subject, element)
    law = element.through(subject.algebra, x, v, subject.resolve)
    return EquationRow(pull_of(element.name), subject.expression(law))


def pull_of(element: str) -> Name:
    """Symbol of the through variable of a force element."""
    return Name("y", (element,))


def element_motion(subject: Subject, element: Element) -> tuple[Any, Any]:
    """Symbols of a force element's across variable and of its rate.

    Args:
        subject: the derivation with its notation; receives the look of the symbols.
        element: the element, in a joint or between two points.

    Returns:
        Coordinate or length, and its rate.
    """
    if element.joint is not None:
        joint = next(j for j in subject.model.joints if j.name == element.joint)
        name = joint.positions()[0].name
        subject.look.names.setdefault(f"{name}_dot", subject.look.name(name).rate())
    else:
        name = f"length({element.name})"
        subject.look.names[name] = Name("ℓ", (element.name,))
        subject.look.names[f"{name}_dot"] = subject.look.names[name].rate()
    symbol = subject.algebra.symbol
    return symbol("", name), symbol("", f"{name}_dot")


def _load(subject: Subject, load: PointForce) -> list[EquationRow]:
    """The force and the torque of a load by components; the velocity of its terminal is a symbol."""
    names = [f"{c}(velocity of {load.name})" for c in "xyz"]
    for name, c in zip(names, "xyz", strict=True):
        subject.look.names[name] = Name("v", (load.name, c))
    velocity = tuple(subject.algebra.symbol("", name) for name in names)
    # given in the body's axes, components stay as given: the text below the table says so
    point = _MovingPoint(IDENTITY_MATRIX, velocity)
    rows = []
    for symbol, part in zip(
        "fτ", load.wrench(subject.algebra, point, subject.resolve), strict=True
    ):
        entries = tuple(subject.expression(_of_reals(x)) for x in part)
        if any(entry != ZERO for entry in entries):
            rows.append(EquationRow(vector(symbol, load.name), Components(entries)))
    return rows


def _of_reals(x: Any) -> Any:
    """An expression that is simpler because all its symbols are real: max(0, a^2 + b^2) is the sum."""
    if not hasattr(x, "free_symbols"):
        return x
    from sympy import Dummy

    reals = {symbol: Dummy(real=True) for symbol in sorted(x.free_symbols, key=str)}
    return x.subs(reals).subs({real: symbol for symbol, real in reals.items()})


class _MovingPoint(NamedTuple):
    """A terminal whose velocity is a symbol."""

    rotation: Any
    linear: Any


# ---- networks


def network_laws(subject: Subject) -> list[Block]:
    """Laws of all components of networks, in declared order."""
    network = subject.network
    assert network is not None
    branch = {b.name: b for b in network.branches}
    trees = Nodes(lambda kind, place: _symbol(subject, branch, kind, place))
    rows: list[EquationRow] = []
    for static in network.laws.statics:
        rows.append(_solved(trees, static.zero))
    for store in (*network.laws.stores, *network.laws.spatial):
        change = Over("d/dt", "", trees(store.charge))
        right = total([(False, change), (False, trees(store.rest))], ordered=False)
        rows.append(EquationRow(_symbol(subject, branch, *store.dual), right))
    for own in network.laws.own:
        rows.append(EquationRow(_symbol(subject, branch, *own.key).rate(), trees(own.rate)))  # type: ignore[union-attr]
    text = (
        "The laws of the components; what stores has the rate of its charge in it. A port in mechanics "
        "has the coordinate of its joint for its displacement and pulls it back."
    )
    return [said(text), Formulas(tuple(rows))]


def _solved(trees: Nodes, zero: Any) -> EquationRow:
    """A law as ``X = ...`` if it is the difference of a variable and an expression."""
    if isinstance(zero, Node) and zero.op == SUB and isinstance(zero.a, Node):
        a, b = zero.a, zero.b
        if a.op == SYMBOL and a.a in ("X", "Y", "w"):
            return EquationRow(trees(a), trees(b))
    return EquationRow(trees(zero), ZERO)


def port_variables(subject: Subject, branch: Branch) -> tuple[Math, Math]:
    """Symbols of an edge's across and through variable.

    Args:
        subject: the derivation with its notation.
        branch: an edge of a network, which may act in mechanics.
    """
    names = {branch.name: branch}
    kind = "w" if branch.port.spatial else "X"
    return _symbol(subject, names, kind, branch.name), _symbol(subject, names, "Y", branch.name)


def _symbol(subject: Subject, branches: dict[str, Branch], kind: str, place: Any) -> Math:
    """Typeset a symbol of a network's DAG."""
    assert subject.network is not None
    if kind == CONSTANT:
        return number(float(Fraction(place)))
    if kind == LOOP:
        return subject.look.name(subject.loop_names[place])
    if kind in ("X", "Y") and not branches[place].port.spatial:
        domain = branches[place].port.domain
        assert domain not in SPATIAL
        return (subject.across if kind == "X" else subject.through)(domain, place)
    if kind == "Y":
        return Name("F", (place,))
    if kind in ("w", "x"):
        joint = branches[place].port.joint
        own = subject.look.name(joint) if joint is not None else Name("ℓ", (place,))
        return own.rate() if kind == "w" else own
    if kind == "s":
        found = next(o for o in subject.network.laws.own if o.key == (kind, place))
        return subject.look.name(found.quantity.name)
    return subject.look.name(kind if place is None else str(place))

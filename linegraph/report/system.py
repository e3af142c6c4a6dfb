"""Sections on the system: conventions, bodies, joints, elements, components, parameters, coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.components.joints.base import BY_INPUT
from linegraph.notation.tree import (
    TRANSPOSED,
    ZERO,
    Name,
    Power,
    Product,
    Sum,
    TwoSides,
    product,
    total,
)
from linegraph.report.document import Block, CellTable, Code, Inline, Section, Text, said

if TYPE_CHECKING:
    from linegraph.components.joints import Joint
    from linegraph.report.subject import Subject

AXES = ("xx", "xy", "xz", "yy", "yz", "zz")


def letter(text: str, *, dots: int = 0, bold: bool = True) -> Name:
    """Symbol of a vector or matrix of the whole system.

    Args:
        text: the letter.
        dots: number of dots.
        bold: whether it is bold.
    """
    return Name(text, dots=dots, bold=bold)


def motion_equation(subject: Subject) -> TwoSides:
    """The equation ``M v̇ + h = Q``, with multipliers if there are any."""
    left = Sum(((False, Product((letter("M"), letter("v", dots=1)))), (False, letter("h"))))
    right: Any = letter("Q")
    if subject.tree.closed:
        pushed = Product((Power(letter("J"), TRANSPOSED), letter("λ")))
        right = Sum(((False, right), (False, pushed)))
    return TwoSides(left, "=", right)


def conventions(subject: Subject, rounded: bool) -> Section:
    """The section on signs and symbols.

    Args:
        subject: the derivation with its notation.
        rounded: whether numbers in the report are rounded.
    """
    mechanics, networks = bool(subject.model.bodies), subject.network is not None
    text: list[Inline] = ["The equations of motion are ", motion_equation(subject)]
    if subject.tree.closed:
        gamma = TwoSides(Product((letter("J"), letter("v", dots=1))), "=", letter("γ"))
        text += [" with the constraints ", gamma]
    if subject.tree.positions:
        rates = TwoSides(letter("q", dots=1), "=", Product((letter("N"), letter("v"))))
        text += [", and ", rates]
    text += [
        ". A dot, in plain text a prime, is a derivative by time; vectors and matrices are bold; "
        "units are those of the SI."
    ]
    blocks: list[Block] = [said(*text)]
    signs = (
        "An edge runs from its tail to its head. In an incidence matrix it has +1 where it leaves a vertex "
        "and −1 where it enters one. "
    )
    if mechanics:
        signs += (
            "In mechanics the through variable of an edge, a force or a torque, is what the edge exerts on "
            "its head, and its across variable is the motion of its head against its tail. "
        )
    if networks:
        signs += (
            "In networks the across variable of an edge is the potential of its tail less that of its head, "
            "and the through variable flows from tail to head: their product is the power it takes in. "
        )
    blocks.append(said(signs.strip()))
    if rounded:
        blocks.append(
            said("Numbers are rounded to six significant digits in print, and only there.")
        )
    return Section("Conventions", tuple(blocks))


def described(subject: Subject) -> Section:
    """The section that lists the content of the model."""
    blocks: list[Block] = [_counts(subject)]
    for title, table in (
        ("Bodies", _bodies(subject)),
        ("Joints", _joints(subject)),
        ("Constraints", _constraints(subject)),
        ("Force elements", _elements(subject)),
        ("Components of networks", _components(subject)),
        ("Parameters", _parameters(subject)),
        ("Coordinates, velocities and inputs", _state(subject)),
    ):
        if table is not None:
            blocks.append(Section(title, table))
    return Section("The system", tuple(blocks))


def _counts(subject: Subject) -> Block:
    model, tree = subject.model, subject.tree
    parts = []
    if model.bodies:
        parts.append(count(len(model.bodies), "body", "bodies"))
        parts.append(count(len(model.joints), "joint"))
    if model.force_elements:
        parts.append(count(len(model.force_elements), "force element"))
    if model.constraints:
        parts.append(count(len(model.constraints), "constraint"))
    if model.components:
        parts.append(count(len(model.components), "component") + " in networks")
    text: list[Inline] = [f"The system consists of {listed(parts)}."] if parts else []
    state = [
        count(len(tree.positions), "coordinate"),
        count(len(tree.velocities), "velocity", "velocities"),
        count(len(tree.inputs), "input"),
    ]
    text.append(f" Its motion is described by {listed(state)}.")
    if model.bodies:
        gravity = subject.vector(model.gravity)
        if gravity == ZERO:
            text.append(" There is no gravity.")
        else:
            text += [" Gravity is ", TwoSides(letter("g"), "=", gravity), " in the axes of ground."]
    return said(*text)


def count(n: int, word: str, words: str = "") -> str:
    """A number with its noun, such as ``2 bodies``.

    Args:
        n: the number.
        word: the noun in the singular.
        words: its plural; by default with -s.
    """
    return f"{n} {word if n == 1 else words or word + 's'}"


def listed(parts: list[str]) -> str:
    """A list in words: ``a, b and c``."""
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"


def _bodies(subject: Subject) -> tuple[Block, ...] | None:
    bodies = subject.model.bodies.values()
    if not bodies:
        return None
    rows = []
    for body in bodies:
        center = subject.vector((body.center if body.first is None else body.first) or ())
        frames: list[Inline] = []
        for name, placement in body.frames.items():
            frames += [", "] if frames else []
            frames += [Code(name), " at ", subject.vector(placement.at)]
        place: Text = (center,) if body.first is None else ("first moment ", center)
        rows.append(((Code(body.name),), (subject.value(body.mass),), place, tuple(frames)))
    table = CellTable(("body", "mass / kg", "mass centre / m", "frames / m"), tuple(rows))
    return (table, *_inertias(subject))


def _inertias(subject: Subject) -> list[Block]:
    """A row for each body with inertia, a column for each entry that is not zero everywhere."""
    bodies = [b for b in subject.model.bodies.values() if any(x != 0 for x in b.inertia)]
    if not bodies:
        return [said("No body has an inertia of its own.")]
    used = [k for k, axes in enumerate(AXES)
            if axes[0] == axes[1] or any(b.inertia[k] != 0 for b in bodies)]  # fmt: skip
    about = (
        "Inertias about the mass centre, in the axes of the body"
        if all(body.first is None for body in subject.model.bodies.values())
        else "Inertias about the mass centre, or about the origin where a first moment is given"
    )
    about += ", in kg m²"
    if len(bodies) < len(subject.model.bodies):
        about += "; bodies without inertia are left out"
    head = ("body", *(f"J {AXES[k]}" for k in used))
    rows = [((Code(b.name),), *((subject.value(b.inertia[k]),) for k in used)) for b in bodies]
    return [said(f"{about}:"), CellTable(head, tuple(rows))]


def unit_of(text: str) -> str:
    """A unit as it is printed.

    Example:
        >>> unit_of("kg*m^2"), unit_of("N*m*s/rad")
        ('kg m²', 'N m s/rad')
    """
    return text.replace("*", " ").replace("^2", "²").replace("^3", "³")


def _joints(subject: Subject) -> tuple[Block, ...] | None:
    model = subject.model
    if not model.joints:
        return None
    rows = []
    for joint in model.joints:
        axis: Text = (subject.vector(joint.axis),) if joint.freedoms in (1, 3) else ("–",)
        tail, head = joint.between
        between: Text = (Code(tail), " → ", Code(head))
        rows.append(
            ((Code(joint.name),), (_kind(joint.kind),), between, axis, _remark(subject, joint))
        )
    return (CellTable(("joint", "type", "tail → head", "axis", "remark"), tuple(rows)),)


def _remark(subject: Subject, joint: Joint) -> Text:
    text: list[Inline] = []
    for coupling in subject.model.couplings:
        if coupling.joint == joint.name:
            master = subject.look.name(coupling.master)
            ratio, offset = subject.value(coupling.ratio), subject.value(coupling.offset)
            follows = total([(False, product([ratio, master])), (False, offset)], ordered=False)
            text += ["follows: ", TwoSides(subject.look.name(joint.name), "=", follows)]
    if joint.drive is not None:
        given = joint.drive if isinstance(joint.drive, (tuple, list)) else (joint.drive,)
        if BY_INPUT in given:
            text.append("prescribed by inputs")
        else:
            for quantity, x in zip(joint.positions(), given, strict=False):
                text += [", "] if text else ["prescribed: "]
                text.append(TwoSides(subject.look.name(quantity.name), "=", subject.value(x)))
    if joint.name in subject.derivation.formulation.chords:
        text.append("closes a loop" if not text else "; closes a loop")
    return tuple(text)


def _kind(kind: str) -> str:
    return kind.replace("_", " ")


def _constraints(subject: Subject) -> tuple[Block, ...] | None:
    rows: list[tuple[Text, ...]] = [
        ((Code(c.name),), (_kind(c.kind),), (Code(c.ends[0]), " → ", Code(c.ends[1])))
        for c in subject.model.constraints
    ]
    rows += [((Code(r.name),), ("relation",), ("between rates",)) for r in subject.model.relations]
    return (CellTable(("constraint", "type", "tail → head"), tuple(rows)),) if rows else None


def _elements(subject: Subject) -> tuple[Block, ...] | None:
    rows = []
    for element in subject.model.force_elements:
        place: Text
        joint, between = getattr(element, "joint", None), getattr(element, "between", None)
        if joint is not None:
            place = ("in joint ", Code(joint))
        elif between is not None:
            place = (Code(between[0]), " → ", Code(between[1]))
        else:
            place = ("on ", Code(getattr(element, "at", "")))
        rows.append(((Code(element.name),), (_kind(element.kind),), place))
    return (CellTable(("element", "type", "place"), tuple(rows)),) if rows else None


def _components(subject: Subject) -> tuple[Block, ...] | None:
    rows = []
    for component in subject.model.components:
        ports: list[Inline] = []
        for port in component.ports():
            ports += ["; "] if ports else []
            ports += [f"{port.label.replace('_', ' ')}: "] if port.label else []
            ends = port.between or port.points
            if ends is None:
                ports += ["joint ", Code(port.joint or "")]
            else:
                ports += [Code(ends[0]), " → ", Code(ends[1])]
        rows.append(((Code(component.name),), (_kind(component.kind),), tuple(ports)))
    return (CellTable(("component", "type", "edges: tail → head"), tuple(rows)),) if rows else None


def _parameters(subject: Subject) -> tuple[Block, ...] | None:
    rows = []
    for parameter in subject.model.parameters.values():
        value: Text = ("–",) if parameter.value is None else (subject.value(parameter.value),)
        name = subject.look.name(parameter.name)
        rows.append(
            (
                (Code(parameter.name),),
                (name,),
                value,
                (unit_of(parameter.unit),),
                (parameter.about,),
            )
        )
    head = ("parameter", "symbol", "value", "unit", "meaning")
    return (CellTable(head, tuple(rows)),) if rows else None


def _state(subject: Subject) -> tuple[Block, ...]:
    rows = []
    tree = subject.tree
    for letter_, names, quantities in (
        ("q", subject.q_names, tree.positions),
        ("v", subject.v_names, tree.velocities),
        ("u", subject.u_names, tree.inputs),
    ):
        for k, (name, quantity) in enumerate(zip(names, quantities, strict=True), 1):
            symbol = subject.look.name(name)
            of = Name(letter_, (str(k),))
            rows.append(((of,), (symbol,), (unit_of(quantity.unit),), (quantity.about,)))
    return (
        (CellTable(("", "symbol", "unit", "meaning"), tuple(rows)),) if rows else (said("None."),)
    )


__all__ = ["conventions", "count", "described", "letter", "listed", "motion_equation"]

"""Tables of a model file, as data: the keys of each and their kinds of values.

Tables of joints, elements, constraints and components follow from the dataclasses in the registers, so a
new type is available in files at once. `Law` fields may use x and v; all others use the names of their
`Scope`.
"""

from __future__ import annotations

import re
from dataclasses import MISSING, dataclass, fields, replace
from inspect import cleandoc
from typing import TYPE_CHECKING, Any

from linegraph.components.constraints import CONSTRAINTS, Constraint
from linegraph.components.forces import ELEMENTS, POINT_FORCES, Element, Load, PointForce
from linegraph.components.forces.load import BODY, WORLD
from linegraph.components.joints import JOINTS, Joint
from linegraph.components.joints.compound import PARTS
from linegraph.components.scalar import COMPONENTS
from linegraph.model.choices import REACTION_AXES
from linegraph.readers.modelfile.bounded import CHECK
from linegraph.readers.modelfile.expressions import Scope
from linegraph.readers.modelfile.fields import Field, Named, Table
from linegraph.readers.modelfile.kinds import (
    WRONG,
    Direction,
    Ends,
    Flag,
    FreeText,
    Items,
    JointName,
    Kind,
    Label,
    Real,
    Schema,
    Terminal,
    Word,
    said,
    vector,
)
from linegraph.readers.modelfile.mechanics import InertiaTable, Turning
from linegraph.readers.modelfile.networks import DOMAIN, component_table
from linegraph.readers.modelfile.report import shown
from linegraph.readers.modelfile.timed import (
    Coordinates,
    Listed,
    PrescribedMotion,
    Start,
    Timed,
)

if TYPE_CHECKING:
    from linegraph.readers.modelfile.expressions import Names
    from linegraph.readers.modelfile.report import Spot

if TYPE_CHECKING:
    from collections.abc import Mapping


_ATTRIBUTE = re.compile(r"^ {4}(\w+(?:, \w+)*): (.*(?:\n {8,}\S.*)*)", re.MULTILINE)


_UNIT = Field(FreeText(), "its unit, for readers")
_ABOUT = Field(FreeText(), "its meaning, for readers")

PARAMETER = Table(
    {
        "value": Field(Real(), "a number, or an expression of earlier parameters", True),
        "unit": _UNIT,
        "about": _ABOUT,
    }
)
INPUT = Table({"unit": _UNIT, "about": _ABOUT})

FRAME = Table(
    {
        "at": Field(vector(), "origin in the body's frame (m)"),
        "rpy": Field(vector(folded=True), "turns about the body's fixed x, y, z (rad)"),
        "axis": Field(Direction(), "direction to turn about"),
        "angle": Field(Real(folded=True), "angle of the turn about axis (rad)"),
    },
    exclusive=(("rpy", "axis"), ("rpy", "angle")),
)
BASEMENT = Table(
    {
        "position": Field(PrescribedMotion(3), 'three expressions of t (m), or "input"'),
        "rotation": Field(Turning(), 'a turn as a function of t, or "input"'),
    },
    about='a massless body called "basement" in prescribed motion, for others to stand on',
)
GRAVITY = Table(
    {"acceleration": Field(vector(), "of free fall, in ground axes (m/s^2)", True)},
)
BODY_TABLE = Table(
    {
        "mass": Field(Real(least=0), "kg; 0 if left out"),
        "mass_center": Field(vector(), "in the body's frame (m); its origin if left out"),
        "inertia": Field(
            InertiaTable(), "kg m^2, in body axes, about the mass centre; 0 if left out"
        ),
        "first_moment": Field(
            vector(),
            "mass times mass centre (kg m), instead of mass_center; the inertia is then about the origin",
        ),
        "frame": Field(Named(FRAME), "frames of this body by name"),
    },
    exclusive=(("mass_center", "first_moment"),),
)
FOLLOWS = Table(
    {
        "joint": Field(JointName(), "the joint it follows", True),
        "ratio": Field(Real(folded=True), "its coordinate over that of the other; 1 if left out"),
        "offset": Field(
            Real(folded=True), "its coordinate where that of the other is 0 (rad or m)"
        ),
    }
)
LOAD = {
    "force": Field(vector(Scope.STATE), "N"),
    "torque": Field(vector(Scope.STATE), "N m"),
    "axes": Field(Word((WORLD, BODY)), '"world" (default) or "body": axes of what is given'),
}
ROTOR = Table(
    {
        "joint": Field(JointName(), "the revolute joint it drives", True),
        "inertia": Field(Real(least=0), "about the joint's axis (kg m^2)", True),
        "ratio": Field(Real(), "turns of the rotor for one of the joint; 1 if left out"),
    }
)
RELATION = Table(
    {
        "rate": Field(
            Real(Scope.STATE),
            "an expression that is zero, linear in the rates der(...)",
            True,
        )
    },
    about="a constraint on velocities: a(q) v = b(q, t)",
)
OUTPUT = Table(
    {
        "value": Field(Real(Scope.OUTPUT), "an expression", True),
        "unit": _UNIT,
        "about": _ABOUT,
    }
)
FORMULATION = Table(
    {
        "tree": Field(
            Listed("joints, or inertia edges body/inertia,"), "edges that must be branches"
        ),
        "coordinates": Field(
            Coordinates(),
            '"joint" (default), "absolute", "absolute-angle" or "automatic"; or one for each body named',
        ),
        "independent": Field(
            Listed("coordinates"),
            "what a closed mechanism is reduced to; chosen automatically if left out",
        ),
        "baumgarte": Field(
            Items(Real(least=0), 2, "a list [alpha, beta]"),
            "stabilises constraints in forward_dynamics: -2 alpha rate - beta^2 error (1/s)",
        ),
        "reactions": Field(
            Word(REACTION_AXES), 'axes of reactions: "head" (default), "tail" or "ground"'
        ),
    },
    about="choices of the formulation: none of them changes the physics",
)
HEAD = {
    "name": Field(Label(), "prefix of everything emitted; the file's own name if left out"),
    "description": Field(FreeText(2000, lines=True), "one paragraph for the head of emitted files"),
}


def _abouts(kind: type) -> dict[str, str]:
    """Descriptions of a dataclass's attributes, from its docstring."""
    found: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        text = cleandoc(base.__doc__ or "").partition("Attributes:")[2].partition("Example:")[0]
        for names, about in _ATTRIBUTE.findall(text):
            found |= {name: " ".join(about.split()) for name in names.split(", ")}
    return found


@dataclass(frozen=True)
class Parts:
    """The parts of a compound joint: a list of tables with a type each."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read one to six parts.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            Tuples (type, axis, options), as `Compound.parts` requires, or `WRONG` after its errors are
            noted.
        """
        if not isinstance(value, list) or not value or len(value) > 6:
            spot.error(f"a list of one to six {{ type, axis }} is wanted, not {said(value)}")
            return WRONG
        parts = tuple(self._part(part, spot.at(i), names) for i, part in enumerate(value))
        return WRONG if any(part is WRONG for part in parts) else parts

    def _part(self, value: Any, spot: Spot, names: Names) -> Any:
        kind = value.get("type") if isinstance(value, dict) else None
        if not isinstance(kind, str) or kind not in PARTS:
            given = f'type "{shown(kind)}"' if isinstance(kind, str) else said(value)
            known = ", ".join(PARTS)
            spot.error(f"{{ type, axis }} is wanted, the type one of {known}; not {given}")
            return WRONG
        found = part_table(kind).read(value, spot, names)
        if found is WRONG:
            return WRONG
        options = {key: inner for key, inner in found.items() if key not in ("type", "axis")}
        return (kind, found["axis"], options)

    def schema(self) -> Schema:
        """The JSON Schema: an array of alternatives."""
        items = {"anyOf": [part_table(kind).schema() for kind in PARTS]}
        return {"type": "array", "items": items, "minItems": 1, "maxItems": 6}


_KINDS: Mapping[str, Kind] = {
    "Any": Real(),
    "Vector": vector(),
    "Vector | None": Direction(),
    "bool": Flag(),
    "str": FreeText(),
    "str | None": FreeText(),
    "tuple[Vector, Vector]": Items(Direction(), 2, "a list of two directions"),
    "tuple[Any, ...]": Parts(),
}
"""Kind of a dataclass's field, by its annotation."""


def _own(kind: type, base: type) -> dict[str, Field]:
    """Fields that a type adds to those of its base class."""
    common = {f.name for f in fields(base)}
    abouts = _abouts(kind)
    return {
        f.name: Field(_KINDS[str(f.type)], abouts.get(f.name, ""), f.default is MISSING)
        for f in fields(kind)
        if f.name not in common
    }


def _has_axis(kind: type[Joint]) -> bool:
    """Whether a joint type uses `axis`."""
    own = {f.name for f in fields(kind)} - {f.name for f in fields(Joint)}
    return kind.alignment is not Joint.alignment and not own & {"axes", "parts"}


def freedoms_of(name: str) -> int | None:
    """Number of freedoms of a joint type; None if it depends on the joint."""
    freedoms: Any = JOINTS[name].freedoms
    return freedoms if isinstance(freedoms, int) else None


_AXIS = Field(Direction(), "direction, in the joint's frames", True)


def joint_table(name: str) -> Table:
    """Return the table of a joint type."""
    kind = JOINTS[name]
    entries = {"between": Field(Ends(), "[tail, head]: body or body.frame", True)}
    if _has_axis(kind):
        entries["axis"] = _AXIS
    entries |= _own(kind, Joint)
    freedoms = freedoms_of(name)
    if freedoms != 0:
        entries |= {
            "effort": Field(Flag(), "whether a force or torque along each velocity is an input"),
            "motion": Field(PrescribedMotion(), 'prescribed: expressions of t, or "input"'),
        }
        entries["start"] = Field(
            Start(), "where the search for a position that closes all loops begins; 0 if left out"
        )
    if freedoms in (1, None):
        entries["follows"] = Field(FOLLOWS, "the joint it is coupled to")
    about = (kind.__doc__ or "").strip().split("\n")[0]
    return Table(entries, exclusive=(("motion", "follows"),), about=about)


def part_table(name: str) -> Table:
    """Return the table of one part of a compound joint."""
    entries = {
        "type": Field(Word((name,)), "", True),
        "axis": _AXIS,
        "name": Field(Label(), "its coordinate is JOINT_name; JOINT_1, JOINT_2, ... if left out"),
    }
    return Table(entries | _own(PARTS[name], Joint))


def element_table(name: str) -> Table:
    """Return the table of an element type."""
    kind = ELEMENTS[name]
    places = {
        "between": Field(Ends(), "[tail, head]: along the line that joins them; or"),
        "joint": Field(JointName(), "along the coordinate of this joint"),
    }
    own = {
        key: Field(Real(Scope.LAW if key in kind.laws else Scope.STATE), entry.about)
        for key, entry in _own(kind, Element).items()
    }
    about = (kind.__doc__ or "").strip().split("\n")[0]
    groups = (("between", "joint"),)
    return Table(places | own, (*groups, *kind.needs), groups, about)


def point_force_table(name: str) -> Table:
    """Return the table of a force on a body at a terminal."""
    kind = POINT_FORCES[name]
    entries = {"at": Field(Terminal(), "where it acts: body or body.frame", True)}
    if kind is Load:
        return Table(entries | LOAD, needs=kind.needs)
    own = {
        key: replace(entry, kind=vector(Scope.STATE) if key in kind.vectors else Real(Scope.STATE))
        for key, entry in _own(kind, PointForce).items()
    }
    about = (kind.__doc__ or "").strip().split("\n")[0]
    return Table(entries | own, kind.needs, (), about)


def constraint_table(name: str) -> Table:
    """Return the table of a constraint type."""
    kind = CONSTRAINTS[name]
    own = {
        key: replace(entry, kind=Timed()) if key in kind.timed else entry
        for key, entry in _own(kind, Constraint).items()
    }
    about = (kind.__doc__ or "").strip().split("\n")[0]
    ends = {"between": Field(Ends(), "[tail, head]: body or body.frame", True)}
    return Table(ends | own, kind.needs, (), about)


TYPES: Mapping[str, Table] = {
    "body": BODY_TABLE,
    "frame": FRAME,
    **{name: joint_table(name) for name in JOINTS},
    **{name: element_table(name) for name in ELEMENTS},
    **{name: point_force_table(name) for name in POINT_FORCES},
    **{name: constraint_table(name) for name in CONSTRAINTS},
    "relation": RELATION,
    "rotor": ROTOR,
    "domain": DOMAIN,
    **{name: component_table(name, _abouts) for name in COMPONENTS},
}
"""Tables ``[type.name]``, by type."""

FLAT: Mapping[str, Table | None] = {
    "parameters": None,
    "inputs": None,
    "gravity": GRAVITY,
    "basement": BASEMENT,
    "formulation": FORMULATION,
    "check": CHECK,
    "outputs": None,
}
"""Tables ``[table]``; None for those whose keys are names chosen by the user."""

"""From the tables of a file to a `Model`, in the order of the file; errors are noted, not raised."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.components.body import GROUND
from linegraph.components.constraints import CONSTRAINTS
from linegraph.components.forces import ELEMENTS, POINT_FORCES
from linegraph.components.joints import JOINTS
from linegraph.components.scalar import COMPONENTS
from linegraph.model.builder import Model
from linegraph.model.name_register import (
    Claim,
    claims_of,
    claims_of_constraint,
    clash,
    input_claim,
    located,
    output_claim,
    parameter_claim,
)
from linegraph.readers.modelfile.bounded import CHECK
from linegraph.readers.modelfile.expressions import Names
from linegraph.readers.modelfile.kinds import WRONG, said
from linegraph.readers.modelfile.names import name_problem
from linegraph.readers.modelfile.report import ModelReport, Spot, shown
from linegraph.readers.modelfile.symbols import (
    read_inputs,
    read_outputs,
    read_parameters,
    rotation_value,
)
from linegraph.readers.modelfile.tables import (
    BASEMENT,
    FLAT,
    FORMULATION,
    GRAVITY,
    HEAD,
    TYPES,
    freedoms_of,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from linegraph.components.joints import Joint
    from linegraph.model.body_handle import BodyHandle
    from linegraph.readers.modelfile.document import ModelText

SHARED = {*JOINTS, *ELEMENTS, *POINT_FORCES, *CONSTRAINTS, "relation", *COMPONENTS}
"""Types that name an edge, so that their names must differ from each other."""

THINGS = {**dict.fromkeys(JOINTS, "joint"), "frame": "frame"}
"""Names of types in later errors; others are named by the type itself."""


_JOINTS = f"; a joint's table has the name of its type, [revolute.NAME]; types: {', '.join(JOINTS)}"
_ELEMENTS = (
    f"; an element's table has the name of its type, [spring.NAME]; types: {', '.join(ELEMENTS)}"
)
_FOLLOWS = "; write follows = { joint = ..., ratio = ... } into the table of the joint that follows"
_LOAD = "; write [load.NAME] with at = ..., force = [...] and torque = [...]"
MEANT = {
    "joint": _JOINTS,
    "joints": _JOINTS,
    "element": _ELEMENTS,
    "elements": _ELEMENTS,
    "link": '; did you mean "body"?',
    "links": '; did you mean "body"?',
    "couple": _FOLLOWS,
    "coupling": _FOLLOWS,
    "mimic": _FOLLOWS,
    "force": _LOAD,
    "torque": _LOAD,
}
"""Advice for words of other programs that this format does not have."""


def build(document: ModelText, name: str, report: ModelReport, snap: float) -> Model:
    """Build the model of a file, as far as it is right.

    Args:
        document: the content of the file.
        name: name of a model that has none.
        report: collects errors; the caller raises them.
        snap: as for `Model`.
    """
    return _Builder(document, report, Model(name, snap=snap)).build()


class _Builder:
    """Reads the tables of one file in the order in which they depend on each other."""

    def __init__(self, document: ModelText, report: ModelReport, model: Model) -> None:
        self._data = document.data
        self._order = {path: i for i, path in enumerate(document.lines)}
        self._report = report
        self._model = model
        self._names = Names()
        self._refused: set[tuple[str, str]] = set()
        self._owners: dict[str, Claim] = {}

    def build(self) -> Model:
        """Build the whole model."""
        self._check_tables()
        self._head()
        self._note_names()
        read_parameters(
            self._data.get("parameters", {}), self._spot("parameters"), self._names, self._model
        )
        read_inputs(self._data.get("inputs", {}), self._spot("inputs"), self._names, self._model)
        for name in self._model.parameters:
            self._claim(("parameters", name), [parameter_claim(name)])
        for given in self._model.inputs:
            self._claim(("inputs", given.name), [input_claim(given.name)])
        for kind, name in self._tables("domain"):
            self._element(kind, name)
        self._gravity()
        self._basement()
        for kind, name in self._tables("body"):
            self._body(kind, name)
        for kind, name in self._tables("frame"):
            self._ground_frame(kind, name)
        self._joints()
        for kind, name in self._tables(*ELEMENTS, *POINT_FORCES):
            self._element(kind, name)
        for kind, name in self._tables(*CONSTRAINTS, "relation"):
            self._element(kind, name)
        for kind, name in self._tables("rotor"):
            self._rotor(kind, name)
        for kind, name in self._tables(*COMPONENTS):
            self._element(kind, name)
        self._formulation()
        for limit in self._model.constraints:
            self._claim((limit.kind, limit.name), claims_of_constraint(limit))
        self._check()
        read_outputs(self._data.get("outputs", {}), self._spot("outputs"), self._names, self._model)
        for output in self._model.outputs:
            self._claim(("outputs", output.name), [output_claim(output.name)])
        return self._model

    def _spot(self, *path: str) -> Spot:
        return Spot(self._report, path)

    def _check_tables(self) -> None:
        """Refuse unknown tables, and values where tables are required."""
        known = [*HEAD, *FLAT, *TYPES]
        for key, value in self._data.items():
            if key not in known:
                self._unknown_table(key, value)
            elif key not in HEAD and not isinstance(value, dict):
                shape = f"[{key}]" if key in FLAT else f"[{key}.NAME]"
                self._spot(key).error(f"a table {shape} is wanted, not {said(value)}")

    def _unknown_table(self, key: str, value: Any) -> None:
        what = f"[{shown(key)}]" if isinstance(value, dict) else f'"{shown(key)}"'
        hint = MEANT.get(key) or self._report.hint(key, [*HEAD, *FLAT, *TYPES])
        problem = f"{what} is not known{hint}"
        self._report.add((key,), problem, thing="")

    def _head(self) -> None:
        for key in HEAD:
            if key in self._data:
                found = HEAD[key].kind.read(self._data[key], self._spot(key), self._names)
                if found is not WRONG:
                    setattr(self._model, {"name": "name", "description": "about"}[key], found)

    def _tables(self, *kinds: str) -> Iterator[tuple[str, str]]:
        """Tables of some types, in the order of the file."""
        found = [
            (kind, name)
            for kind in kinds
            if isinstance(self._data.get(kind), dict)
            for name in self._data[kind]
            if (kind, name) not in self._refused
        ]
        yield from sorted(found, key=lambda table: self._order.get(table, 0))

    def _note_names(self) -> None:
        """Note all declared names. Wrong tables count, so that references to them are no further errors."""
        owners: dict[str, str] = {}
        for kind, name in self._tables(*TYPES):
            self._check_name(kind, name, owners)
            thing = THINGS.get(kind, kind)
            label = f"{GROUND}.{name}" if kind == "frame" else name
            line = self._report.line((kind, name))
            self._model.places.setdefault(f'{thing} "{label}"', line or 1)
        for key, thing in (("parameters", "parameter"), ("inputs", "input"), ("outputs", "output")):
            for _, name in self._tables(key):
                self._model.places[f'{thing} "{name}"'] = self._report.line((key, name)) or 1
        terminals = self._names.terminals
        terminals[GROUND] = GROUND
        if "basement" in self._data:
            terminals["basement"] = "basement"
            self._model.places['joint "basement"'] = self._report.line(("basement",)) or 1
        for _, name in self._tables("frame"):
            terminals[f"{GROUND}.{name}"] = GROUND
        for _, name in self._tables("body"):
            terminals[name] = name
            value = self._data["body"][name]
            frames = value.get("frame") if isinstance(value, dict) else None
            for frame in frames if isinstance(frames, dict) else ():
                terminals[f"{name}.{frame}"] = name
        for kind, name in self._tables(*JOINTS):
            self._names.joints[name] = freedoms_of(kind)
        self._names.elements = {name for _, name in self._tables(*ELEMENTS)}
        self._names.constraints = {name for _, name in self._tables(*CONSTRAINTS)}
        self._names.components = {name: kind for kind, name in self._tables(*COMPONENTS)}
        self._names.domains = {name for _, name in self._tables("domain")}

    def _check_name(self, kind: str, name: str, owners: dict[str, str]) -> None:
        spot = self._spot(kind, name)
        problem = name_problem(name)
        if problem:
            spot.error(problem)
        elif kind in SHARED:
            if name in owners:
                first = f"[{owners[name]}.{name}] in line {self._report.line((owners[name], name))}"
                spot.error(
                    f"the name is taken by {first}; joints, elements, constraints and components share names"
                )
                self._refused.add((kind, name))
            owners.setdefault(name, kind)

    def _read(self, kind: str, name: str) -> Any:
        """Values of a table, or `WRONG`."""
        return TYPES[kind].read(self._data[kind][name], self._spot(kind, name), self._names)

    def _gravity(self) -> None:
        if "gravity" in self._data and isinstance(self._data["gravity"], dict):
            found = GRAVITY.read(self._data["gravity"], self._spot("gravity"), self._names)
            if found is not WRONG:
                self._model.gravity = found["acceleration"]

    def _formulation(self) -> None:
        given = self._data.get("formulation")
        if not isinstance(given, dict):
            return
        found = FORMULATION.read(given, self._spot("formulation"), self._names)
        if found is WRONG:
            return
        line = self._report.line(("formulation",)) or 1
        things = [f'branch "{name}"' for name in found.get("tree", ())]
        self._model.places |= dict.fromkeys(["formulation", *things], line)
        if isinstance(found.get("coordinates"), dict):
            found["of_body"] = found.pop("coordinates")
        self._model.formulation(**found)

    def _check(self) -> None:
        if not isinstance(self._data.get("check"), dict):
            return
        found = CHECK.read(self._data["check"], self._spot("check"), self._names)
        if found is not WRONG:
            self._model.places["check"] = self._report.line(("check",)) or 1
            self._model.check_within(**found)

    def _basement(self) -> None:
        if isinstance(self._data.get("basement"), dict):
            found = BASEMENT.read(self._data["basement"], self._spot("basement"), self._names)
            if found is not WRONG:
                with self._report.placed(("basement",)):
                    self._model.basement(**found)
                    joint = self._model.joints[-1]
                    self._names.coordinates |= {quantity.name for quantity in joint.positions()}
                    self._claim(("basement",), claims_of(joint))

    def _body(self, kind: str, name: str) -> None:
        found = self._read(kind, name)
        if found is WRONG:
            return
        frames = found.pop("frame", {})
        with self._report.placed((kind, name)):
            handle = self._model.body(name, **found)
            for frame, values in frames.items():
                with self._report.placed((kind, name, "frame", frame)):
                    self._frame(handle, frame, values)

    def _ground_frame(self, kind: str, name: str) -> None:
        found = self._read(kind, name)
        if found is not WRONG:
            with self._report.placed((kind, name)):
                self._frame(self._model.ground, name, found)

    def _frame(self, body: BodyHandle, name: str, values: dict[str, Any]) -> None:
        turned = {key: rotation_value(value) for key, value in values.items() if key != "at"}
        body.frame(name, **values | turned)

    def _joints(self) -> None:
        """Add all joints, then couplings: a joint may follow a later one."""
        followers = []
        for kind, name in self._tables(*JOINTS):
            found = self._read(kind, name)
            if found is WRONG:
                self._names.incomplete = True
                continue
            follows = found.pop("follows", None)
            if follows:
                followers.append((kind, name, follows))
            if "motion" in found:
                found["drive"] = found.pop("motion")
            with self._report.placed((kind, name)):
                self._note_coordinates(kind, name, getattr(self._model, kind)(name, **found))
        for kind, name, follows in followers:
            with self._report.placed((kind, name, "follows")):
                self._model.couple(name, follows.pop("joint"), **follows)

    def _note_coordinates(self, kind: str, name: str, joint: Joint) -> None:
        """Note the coordinates of a joint, which laws may use."""
        coordinates = [quantity.name for quantity in joint.positions()]
        self._claim((kind, name), claims_of(joint))
        self._names.coordinates |= set(coordinates)
        self._names.joints[name] = joint.freedoms
        if coordinates != [name]:
            self._names.several[name] = coordinates

    def _claim(self, path: tuple[str, ...], claims: Iterable[Claim]) -> None:
        """Note the owner of names; a clash is reported once."""
        places = self._model.places
        problems = []
        for claim in claims:
            first = self._owners.setdefault(claim.name, claim)
            self._names.owners.setdefault(claim.name, located(first, places))
            if first is not claim:
                problems.append(clash(first, claim, places))
        if problems:
            self._spot(*path).error(problems[0])

    def _element(self, kind: str, name: str) -> None:
        given = self._data[kind][name]
        joint = given.get("joint") if isinstance(given, dict) else None
        # In a joint called x the element's own x and the coordinate x are the same number.
        self._names.shared = "x" if joint == "x" and not given.get("length") else ""
        found = self._read(kind, name)
        if found is not WRONG:
            with self._report.placed((kind, name)):
                getattr(self._model, kind)(name, **found)

    def _rotor(self, kind: str, name: str) -> None:
        found = self._read(kind, name)
        if found is not WRONG and not self._names.incomplete:
            with self._report.placed((kind, name)):
                self._model.rotor(name, **found)

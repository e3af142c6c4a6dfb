"""Seeded random systems of 3-D mechanics and scalar networks, tied to each other by transducers.

A system is a tree of hinges and slides, as the Newton-Euler oracle reads it, and a list of parts: components
of networks with all that the builder is told of them. `model_of` tells the builder; `mixed_tableau` reads the
same list by itself. The variants say the same system otherwise: edges reversed, names changed, another order.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from oracles import newton_euler as oracle
from support.spec_models import numbers, rows
from systems import random_trees as trees
from systems.random_systems import Drive, random_drive

from linegraph import Model
from linegraph.model.body_handle import BodyHandle

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Array = Any
Pair = tuple[str, str]

GROUND = "ground"
ELECTRICAL, HYDRAULIC, THERMAL, MAGNETIC = "electrical", "hydraulic", "thermal", "magnetic"
TURNING, SLIDING = "rotation_1d", "translation_1d"

ONE_PORT = {
    **dict.fromkeys(("resistor", "conductance", "capacitor", "inductor", "diode"), ELECTRICAL),
    **dict.fromkeys(("voltage_source", "current_source", "element"), ELECTRICAL),
    **dict.fromkeys(("inertia", "rotational_spring", "rotational_damper"), TURNING),
    **dict.fromkeys(("rotational_friction", "torque_source"), TURNING),
    "angular_velocity_source": TURNING,
    **dict.fromkeys(("mass", "translational_spring", "translational_damper"), SLIDING),
    "force_source": SLIDING,
    **dict.fromkeys(("accumulator", "tank", "inertance", "pipe", "orifice", "valve"), HYDRAULIC),
    **dict.fromkeys(("pressure_source", "flow_source"), HYDRAULIC),
    **dict.fromkeys(("heat_capacity", "conduction", "convection", "radiation"), THERMAL),
    **dict.fromkeys(("temperature_source", "heat_source", "losses"), THERMAL),
    **dict.fromkeys(("reluctance", "mmf_source"), MAGNETIC),
}
TWO_PORT = {
    **dict.fromkeys(("transformer", "gyrator"), (ELECTRICAL, ELECTRICAL)),
    **dict.fromkeys(("gear", "belt"), (TURNING, TURNING)),
    "lever": (SLIDING, SLIDING),
    **dict.fromkeys(("rack", "screw"), (TURNING, SLIDING)),
    "winding": (ELECTRICAL, MAGNETIC),
    "opamp": (ELECTRICAL, ELECTRICAL),
}
TRANSDUCER = {
    **dict.fromkeys(("dc_motor", "reluctance_machine"), (ELECTRICAL, TURNING)),
    **dict.fromkeys(("moving_coil", "solenoid", "variable_capacitor"), (ELECTRICAL, SLIDING)),
    "piezo": (ELECTRICAL, SLIDING),
    "cylinder": (HYDRAULIC, SLIDING),
    **dict.fromkeys(("pump", "hydraulic_motor"), (HYDRAULIC, TURNING)),
    "rotational_interface": (TURNING, TURNING),
    "translational_interface": (SLIDING, SLIDING),
}
SEVERAL = ("synchronous_machine", "coupled_inductors")
SOURCES = (
    *("voltage_source", "current_source", "torque_source", "force_source", "pressure_source"),
    *("flow_source", "mmf_source", "temperature_source", "heat_source", "losses", "opamp"),
    "angular_velocity_source",
)


@dataclass(frozen=True)
class Port:
    """An edge of a part: its vertices in a subspace, or its place in 3-D mechanics."""

    edge: str
    domain: str
    between: Pair | None
    joint: str | None = None
    points: Pair | None = None


@dataclass(frozen=True)
class Part:
    """A component, or a force element whose law names variables of networks.

    Attributes:
        options: what the builder is told.
        controlled: whether it is a source that some other variable controls.
    """

    kind: str
    name: str
    options: Mapping[str, Any]
    controlled: bool = False

    @property
    def ports(self) -> list[Port]:
        """Its edges."""
        given, name = self.options, self.name
        place = {"joint": given.get("joint"), "points": given.get("points")}
        if self.kind in ONE_PORT:
            return [Port(name, ONE_PORT[self.kind], given["between"])]
        if self.kind == "law":
            return [Port(name, "", None, **place)]
        if self.kind in TWO_PORT:
            ends, labels = (given["between"], given.get("second")), ("first", "second")
            if self.kind == "opamp":
                ends, labels = (given["between"], given["output"]), ("input", "output")
            kinds = zip(labels, TWO_PORT[self.kind], ends, strict=True)
            return [Port(f"{name}.{label}", domain, pair) for label, domain, pair in kinds]
        if self.kind in SEVERAL:
            turning, found = TURNING, []
            for k, pair in enumerate(given["windings"]):
                found.append(Port(f"{name}.winding{k + 1}", ELECTRICAL, pair))
            if self.kind == "coupled_inductors":
                return found
        else:
            first, turning = TRANSDUCER[self.kind]
            found = [Port(f"{name}.{first}", first, given["between"])]
        shaft = given.get("shaft")
        domain = turning if shaft is not None else ""
        return [*found, Port(f"{name}.mechanical", domain, shaft, **place)]


@dataclass
class System:
    """A random system.

    Attributes:
        tree: the mechanism; its coordinates are also those that are prescribed.
        drives: prescribed motions by joint.
        idle: joints without effort.
        frames: points on bodies: body and place, by terminal.
        forces: springs and the like, as the builder is told.
        parts: components of networks.
        wanted: what the formulation's `tree` names.
        coordinates: the formulation's choice.
    """

    name: str
    tree: trees.Tree
    drives: dict[str, Drive] = field(default_factory=dict)
    idle: set[str] = field(default_factory=set)
    frames: dict[str, tuple[str, Array]] = field(default_factory=dict)
    forces: list[tuple[str, str, dict[str, Any]]] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)
    inputs: list[str] = field(default_factory=list)
    parameters: dict[str, float] = field(default_factory=dict)
    wanted: tuple[str, ...] = ()
    coordinates: str = "joint"

    @property
    def own(self) -> list[str]:
        """The joints whose coordinates are free, in order."""
        return [j.name for j in self.tree.active if j.name not in self.drives]

    def places(self) -> Array:
        """Where these stand in the tree's q and v."""
        return np.array([self.tree.velocity_slices[n].start for n in self.own], dtype=int)

    @property
    def compared(self) -> bool:
        """Whether the power of all that is prescribed is known: no joint follows one that is."""
        return not any(c.master in self.drives for c in self.tree.couplings)

    @property
    def controlled(self) -> bool:
        """Whether some source is controlled by another variable."""
        return any(part.controlled for part in self.parts)


def model_of(system: System, *, bare: bool = False) -> Model:
    """What a user would tell the builder; bare without components."""
    tree = system.tree
    model = Model(system.name, gravity=numbers(tree.gravity))
    for name, value in system.parameters.items():
        model.parameter(name, value)
    for name in system.inputs:
        model.input(name)
    for body in tree.bodies:
        model.body(
            body.name,
            mass=float(body.mass),
            mass_center=numbers(body.mass_center),
            inertia=rows(body.inertia),
        )
    for terminal, (body_name, at) in system.frames.items():
        frame = terminal.partition(".")[2]
        BodyHandle(model, body_name).frame(frame, at=numbers(at))
    for joint in tree.joints:
        ends = [
            BodyHandle(model, body).frame(f"{joint.name}.{end}", at=numbers(at), rotation=rows(r))
            for body, end, at, r in (
                (joint.tail, "tail", joint.tail_at, joint.tail_rotation),
                (joint.head, "head", joint.head_at, joint.head_rotation),
            )
        ]
        options: dict[str, Any] = {"axis": numbers(joint.axis)}
        options["effort"] = joint.name not in system.idle
        if joint.name in system.drives:
            options["drive"] = system.drives[joint.name].text
        getattr(model, joint.kind)(joint.name, tuple(ends), **options)
    for c in tree.couplings:
        model.couple(c.joint, c.master, float(c.ratio), float(c.offset))
    for kind, name, given in system.forces:
        getattr(model, kind)(name, **given)
    if bare:
        return model
    for part in system.parts:
        given = dict(part.options)
        if part.kind == "law":
            getattr(model, part.kind)(part.name, **given)
        elif part.kind in SEVERAL:
            model_word = getattr(model, part.kind)
            model_word(part.name, given.pop("windings"), **given)
        else:
            getattr(model, part.kind)(part.name, given.pop("between"), **given)
    model.formulation(tree=system.wanted, coordinates=system.coordinates)
    return model


# ---- the same system said otherwise

REVERSIBLE = {
    **dict.fromkeys(("resistor", "conductance", "rotational_damper", "translational_damper"), ()),
    **dict.fromkeys(("rotational_friction", "inertia", "mass", "pipe", "orifice", "valve"), ()),
    **dict.fromkeys(("inertance", "heat_capacity", "conduction", "convection"), ()),
    **dict.fromkeys(("transformer", "gyrator", "gear", "belt", "lever", "rack", "screw"), ()),
    **dict.fromkeys(("winding", "radiation"), ()),
    "capacitor": ("charge", "coenergy"),
    "inductor": ("flux", "coenergy"),
    "accumulator": ("volume", "coenergy"),
    "reluctance": ("flux", "coenergy"),
    "rotational_spring": ("force", "energy"),
    "translational_spring": ("force", "energy"),
    "solenoid": ("coenergy", "energy"),
    "reluctance_machine": ("coenergy", "energy"),
    "variable_capacitor": ("coenergy", "energy"),
    **dict.fromkeys(("dc_motor", "moving_coil"), ()),
}
"""What may be turned around, unless it is given by one of these fields; motors with their constant."""

KIND_OF = re.compile(r"(across|through)\(([\w.]+)\)")


def reversed_parts(system: System, rng: np.random.Generator) -> tuple[System, dict[str, int]]:
    """About half of the passive parts turned around; the sign of each edge's variables."""
    signs = {port.edge: 1 for part in system.parts for port in part.ports}
    parts = []
    for part in system.parts:
        fields = REVERSIBLE.get(part.kind)
        if fields is None or any(f in part.options for f in fields) or rng.random() < 0.4:
            parts.append(part)
            continue
        given = dict(part.options)
        for key in ("between", "second"):
            if key in given:
                given[key] = given[key][::-1]
        if part.kind in ("dc_motor", "moving_coil"):
            given["constant"] = _negative(given["constant"])
        parts.append(replace(part, options=given))
        for port in part.ports:
            if port.between is not None and port.between != given.get("shaft"):
                signs[port.edge] = -1

    def sign(found: re.Match[str]) -> str:
        return f"(-{found[0]})" if signs[found[2]] < 0 else found[0]

    parts = [_rewritten(part, lambda text: KIND_OF.sub(sign, text)) for part in parts]
    return replace(system, parts=parts), signs


def renamed(system: System) -> tuple[System, dict[str, str]]:
    """New names of components and vertices, whose alphabetic order is another; edges by their old names."""
    count = len(system.parts)
    names = {p.name: f"z{count - k:03d}_{p.kind[:3]}" for k, p in enumerate(system.parts)}

    def other(found: re.Match[str]) -> str:
        name, dot, label = found[2].partition(".")
        return f"{found[1]}({names[name]}{dot}{label})"

    def vertex(name: str) -> str:
        return name if name == GROUND else f"y{hash_of(name)}"

    parts = []
    for former in system.parts:
        part = replace(former, name=names[former.name])
        given = dict(_rewritten(part, lambda text: KIND_OF.sub(other, text)).options)
        for key in ("between", "second", "output", "shaft"):
            if key in given:
                given[key] = tuple(map(vertex, given[key]))
        if "windings" in given:
            given["windings"] = tuple(tuple(map(vertex, pair)) for pair in given["windings"])
        if part.kind == "losses":
            given["of"] = tuple(names.get(name, name) for name in given["of"])
        parts.append(replace(part, options=given))
    edges = {
        old.edge: new.edge
        for before, after in zip(system.parts, parts, strict=True)
        for old, new in zip(before.ports, after.ports, strict=True)
    }
    return replace(system, parts=parts), edges


def hash_of(name: str) -> int:
    """A number that orders names otherwise."""
    return sum((k + 1) * ord(c) * 7919 for k, c in enumerate(name)) % 99991


def reordered(system: System, rng: np.random.Generator) -> System:
    """Joints, parts, inputs and forces in another order."""

    def shuffled(items: Any) -> list[Any]:
        return [items[k] for k in rng.permutation(len(items))]

    tree = system.tree
    tree = trees.Tree(tree.bodies, tuple(shuffled(tree.joints)), tree.couplings, tree.gravity)
    return replace(
        system,
        tree=tree,
        parts=shuffled(system.parts),
        forces=shuffled(system.forces),
        inputs=shuffled(system.inputs),
    )


def _negative(value: Any) -> Any:
    return f"-({value})" if isinstance(value, str) else -value


def _rewritten(part: Part, rewrite: Callable[[str], str]) -> Part:
    """A part with its texts changed; vertices and places are no texts."""
    places = ("between", "second", "output", "shaft", "joint", "points", "windings", "of")

    def change(value: Any) -> Any:
        if isinstance(value, str):
            return rewrite(value)
        if isinstance(value, tuple):
            return tuple(map(change, value))
        return value

    given = {k: v if k in places else change(v) for k, v in part.options.items()}
    return replace(part, options=given)


# ---- states


@dataclass(frozen=True)
class States:
    """Many states of a system's mechanics, one a row, and all that inputs are.

    Attributes:
        q, v: of the free joints, in their order in the system.
        whole: q, v and the prescribed part of the acceleration of the tree, for each state.
        t, u: the time; inputs by name, those that prescribe motions and their rates among them.
    """

    q: Array
    v: Array
    t: Array
    u: dict[str, Array]
    whole: tuple[tuple[Array, Array, Array], ...]


NEAREST = 0.4
"""How close two points of a cylinder may come."""

STEEPEST = 1e-3
"""Least eigenvalue of M scaled to a unit diagonal."""


def draw_states(rng: np.random.Generator, system: System, count: int) -> States:
    """States at which M is regular and points are apart."""
    found = []
    while len(found) < count:
        q, v = trees.random_state(rng, system.tree)
        t = float(rng.uniform(-1.5, 1.5))
        names = [*system.inputs, *(f"{name}_rate" for name in system.inputs)]
        names += [f"{name}_acceleration" for name in system.inputs]
        for joint, drive in system.drives.items():
            if drive.text == "input":
                names += [joint, f"{joint}_rate", f"{joint}_acceleration"]
        u = {name: float(rng.uniform(-1, 1)) for name in names}
        a = np.zeros(system.tree.nv)
        for joint, drive in system.drives.items():
            k = system.tree.velocity_slices[joint].start
            q[k], v[k], a[k] = drive.at(t, u)
        if _apart(system, q, v):
            found.append((q, v, a, t, u))
    own = system.places()
    return States(
        np.array([x[0][own] for x in found]),
        np.array([x[1][own] for x in found]),
        np.array([x[3] for x in found]),
        {name: np.array([x[4][name] for x in found]) for name in found[0][4]},
        tuple((x[0], x[1], x[2]) for x in found),
    )


def _apart(system: System, q: Array, v: Array) -> bool:
    motions = oracle.body_motions(system.tree, q, v)
    for part in system.parts:
        for port in part.ports:
            if port.points is not None:
                a, b = (point(system, motions, v, end).origin for end in port.points)
                if np.linalg.norm(b - a) < NEAREST:
                    return False
    own = system.places()
    mass = _mass(system, motions, v)[np.ix_(own, own)]
    diagonal = np.diag(mass)
    if diagonal.min() < STEEPEST:
        return False
    return bool(np.linalg.eigvalsh(mass / np.sqrt(np.outer(diagonal, diagonal)))[0] > STEEPEST)


def _mass(system: System, motions: Mapping[str, Any], v: Array) -> Array:
    total = np.zeros((system.tree.nv, system.tree.nv))
    for body in system.tree.bodies:
        center = oracle.carried(motions[body.name], v, body.mass_center, np.eye(3))
        turning = center.rotation.T @ center.angular
        total += body.mass * center.linear.T @ center.linear + turning.T @ body.inertia @ turning
    return total


def point(system: System, motions: Mapping[str, Any], v: Array, terminal: str) -> oracle.Motion:
    """The motion of a point on a body."""
    body, at = system.frames[terminal]
    return oracle.carried(motions[body], v, at, np.eye(3))


# ---- the generator


def random_system(seed: int) -> System:
    """A system of one to five joints and two to five networks."""
    rng = np.random.default_rng([seed, 11])
    bodies = 1 + seed % 5
    kinds = ("revolute", "revolute", "prismatic")
    tree = trees.random_tree(rng, bodies, kinds, couplings=bool(rng.random() < 0.4), massless=False)
    return _Builder(rng, System(f"mixed{seed}", tree)).build()


class _Builder:
    """Adds networks, one block after the other."""

    def __init__(self, rng: np.random.Generator, system: System) -> None:
        self.rng, self.system = rng, system
        self.counts: dict[str, int] = {}
        self.nodes: list[str] = []
        self.joints = [joint.name for joint in system.tree.joints]
        self.lossy: list[str] = []
        self.kept: list[str] = []
        self.temperatures: list[str] = []

    def build(self) -> System:
        """Mechanics, then networks."""
        self._mechanics()
        if self.chance(0.3):
            self.thermal()
        blocks = (
            *(self.motor, self.motor, self.motor, self.solenoid, self.solenoid, self.plate),
            *(self.plate, self.piezo, self.coil, self.cylinder, self.cylinder, self.machine),
            *(self.train, self.train, self.sliding_train, self.rlc, self.rlc, self.rlc),
            *(self.rectifier, self.magnetic, self.hydraulic_drive, self.law, self.stiff),
            *(self.amplifier, self.differential, self.branched),
        )
        for _ in range(int(self.rng.integers(2, 6))):
            blocks[int(self.rng.integers(len(blocks)))]()
        if self.lossy and self.chance(0.4):
            self.heated()
        return self.system

    # -- small choices

    def chance(self, p: float) -> bool:
        return bool(self.rng.random() < p)

    def pick(self, items: Any) -> Any:
        return items[int(self.rng.integers(len(items)))]

    def number(self, low: float = 0.3, high: float = 3.0) -> float:
        return round(float(np.exp(self.rng.uniform(np.log(low), np.log(high)))), 3)

    def signed(self) -> float:
        return self.number() * (1 if self.chance(0.7) else -1)

    def value(self, low: float = 0.3, high: float = 3.0) -> Any:
        """A number, or the name of a parameter."""
        number = self.number(low, high)
        if self.chance(0.8):
            return number
        name = f"k{len(self.system.parameters)}"
        self.system.parameters[name] = number
        return name

    def new(self, letter: str) -> str:
        self.counts[letter] = self.counts.get(letter, 0) + 1
        return f"{letter}{self.counts[letter]}"

    def add(self, kind: str, letter: str, *, controlled: bool = False, **options: Any) -> str:
        name = self.new(letter)
        self.system.parts.append(Part(kind, name, options, controlled))
        return name

    def input(self) -> str:
        if self.system.inputs and (len(self.system.inputs) > 2 or self.chance(0.3)):
            return str(self.pick(self.system.inputs))
        self.system.inputs.append(f"u{len(self.system.inputs)}")
        return self.system.inputs[-1]

    def given(self) -> Any:
        """What a source gives: a number, an input, a function of time."""
        kind = self.rng.random()
        if kind < 0.25:
            return self.signed()
        if kind < 0.7:
            return self.input() if self.chance(0.6) else f"{self.number()}*{self.input()}"
        return f"{self.signed()}*sin({self.number()}*t + {self.number()})"

    def control(self) -> str:
        """What controls a source: a kept variable, a joint as a servo sees it, both."""
        joint = self.pick(self.joints)
        texts = [f"{-self.number()}*{joint} - {self.number(0.1, 1)}*der({joint})"]
        if self.kept:
            texts.append(f"{self.signed()}*{self.pick(self.kept)}")
            texts.append(f"{self.signed()}*{self.pick(self.kept)} + {self.input()}")
            texts.append(f"{self.signed()}*tanh({self.pick(self.kept)})")
        return str(self.pick(texts))

    def place(self, points: float = 0.0, kind: str = "") -> dict[str, Any]:
        """Where a transducer acts in 3-D mechanics; of an interface the joint is of its kind."""
        fitting = [j.name for j in self.system.tree.joints if kind in ("", j.kind)]
        if not fitting or self.chance(points):
            return {"points": self.points()}
        return {"joint": str(self.pick(fitting))}

    def interface(self, tail: str, head: str = GROUND) -> None:
        """Where a shaft meets a hinge; where there is none a motor that turns it."""
        if any(joint.kind == "revolute" for joint in self.system.tree.joints):
            where = self.place(kind="revolute")
            self.add("rotational_interface", "X", between=(tail, head), **where)
        else:
            self.add("torque_source", "Q", between=(head, tail), torque=self.given())
            self.add("inertia", "J", between=(tail, GROUND), inertia=self.value())

    def points(self) -> Pair:
        """Two new points, at least one of them on a body."""
        bodies = [body.name for body in self.system.tree.bodies]
        first = str(self.pick([GROUND, *bodies]))
        second = str(self.pick([body for body in bodies if body != first] or [GROUND]))
        ends = []
        for body in (first, second):
            name = f"{body}.p{len(self.system.frames)}"
            self.system.frames[name] = (body, self.rng.normal(scale=0.8, size=3))
            ends.append(name)
        return ends[0], ends[1]

    # -- mechanics

    def _mechanics(self) -> None:
        system, rng = self.system, self.rng
        coupled = {c.joint for c in system.tree.couplings}
        active = [j.name for j in system.tree.active]
        for name in active:
            if len(active) - len(system.drives) > 1 and rng.random() < 0.12:
                drive = random_drive(rng, name)
                system.drives[name] = drive
        for name in self.joints:
            if name in coupled or rng.random() < 0.6:
                system.idle.add(name)
            if rng.random() < 0.3:
                self.force(name)
        if rng.random() < 0.3:
            given = {"between": self.points(), "stiffness": self.number(), "length": 0.5}
            system.forces.append(("spring", self.new("strut"), given))

    def force(self, joint: str) -> None:
        kind = str(self.pick(["spring", "damper", "friction"]))
        given: dict[str, Any] = {"joint": joint}
        if kind == "spring":
            given |= {"stiffness": self.number(), "length": self.signed()}
        elif kind == "damper":
            given["damping"] = self.number()
        else:
            given |= {"viscous": self.number(), "coulomb": self.number(), "width": self.number()}
        name = self.new(kind)
        self.system.forces.append((kind, name, given))
        if kind != "spring":
            self.lossy.append(name)

    # -- electrical

    def resistance(self) -> Any:
        """A number, or what depends on a temperature or a joint."""
        if self.temperatures and self.chance(0.4):
            return f"{self.number()}*(1 + 0.2*across({self.pick(self.temperatures)})**2)"
        if self.chance(0.1):
            return f"{self.number(1, 3)} + 0.5*sin({self.pick(self.joints)})"
        return self.value()

    def resistor(self, tail: str, head: str) -> str:
        if self.chance(0.8):
            name = self.add("resistor", "R", between=(tail, head), resistance=self.resistance())
        else:
            name = self.add("conductance", "G", between=(tail, head), conductance=self.value())
        self.lossy.append(name)
        return name

    def supply(self) -> str:
        """A new vertex with a source."""
        vertex = self.new("n")
        controlled = self.chance(0.3)
        given = self.control() if controlled else self.given()
        if self.chance(0.75):
            inner = self.new("n") if controlled or self.chance(0.4) else vertex
            ends = (inner, GROUND) if self.chance(0.7) else (GROUND, inner)
            self.add("voltage_source", "V", between=ends, voltage=given, controlled=controlled)
            if inner != vertex:
                self.resistor(inner, vertex)
        else:
            self.add(
                *("current_source", "I"),
                between=(GROUND, vertex),
                current=given,
                controlled=controlled,
            )
            self.resistor(vertex, GROUND)
        self.nodes.append(vertex)
        return vertex

    def node(self) -> str:
        """A vertex with a source, or another that hangs on a resistor."""
        if not self.nodes or self.chance(0.4):
            return self.supply()
        return str(self.pick(self.nodes))

    def behind(self, share: float = 0.5) -> str:
        """A node, or a new vertex behind a resistor, now and then behind an inductor."""
        node = self.node()
        if not self.chance(share):
            return node
        vertex = self.new("n")
        self.pick([*[self.resistor] * 3, self.inductor])(node, vertex)
        return vertex

    def capacitor(self, tail: str, head: str) -> str:
        kind, given = self.rng.random(), {}
        if kind < 0.7:
            given = {"capacitance": self.value()}
        elif kind < 0.9:
            given = {"coenergy": f"{self.number()}*x**2/2 + {self.number(0.02, 0.1)}*x**4"}
        else:
            given = {"charge": f"{self.number()}*x + {self.number(0.1, 0.5)}*tanh(x)"}
        name = self.add("capacitor", "C", between=(tail, head), **given)
        self.kept.append(f"across({name})")
        return name

    def inductor(self, tail: str, head: str) -> str:
        kind, given = self.rng.random(), {}
        if kind < 0.7:
            given = {"inductance": self.value()}
        elif kind < 0.9:
            given = {"coenergy": f"{self.number()}*y**2/2 + {self.number(0.02, 0.1)}*log(cosh(y))"}
        else:
            given = {"flux": f"{self.number()}*atan(y) + {self.number(0.1, 0.5)}*y"}
        name = self.add("inductor", "L", between=(tail, head), **given)
        self.kept.append(f"through({name})")
        return name

    def rlc(self) -> None:
        """Stores and resistors, among them loops of capacitors and cutsets of inductors."""
        node = self.behind()
        for _ in range(int(self.rng.integers(1, 4))):
            piece = int(self.rng.integers(8))
            if piece == 0:
                self.capacitor(node, GROUND)
            elif piece == 1:
                vertex = self.new("n")
                self.inductor(node, vertex)
                self.resistor(vertex, GROUND)
                self.nodes.append(vertex)
            elif piece == 2:
                self._capacitor_loop(node)
            elif piece == 3:
                self._inductor_cutset(node)
            elif piece == 4:
                self._coupled(node)
            elif piece == 5:
                self._two_port(node)
            elif piece == 6:
                self.resistor(node, self.pick([GROUND, *(n for n in self.nodes if n != node)]))
            else:
                vertex = self.new("n")
                self.resistor(node, vertex)
                self.capacitor(vertex, GROUND)
                self.nodes.append(vertex)

    def _capacitor_loop(self, node: str) -> None:
        near, far = self.new("n"), self.new("n")
        self.resistor(node, near)
        self.capacitor(near, GROUND)
        self.capacitor(near, far)
        self.capacitor(far, GROUND)
        if self.chance(0.5):
            self.resistor(far, GROUND)
        if self.chance(0.3):
            self.capacitor(near, far)
        self.nodes.append(far)

    def _inductor_cutset(self, node: str) -> None:
        middle = self.new("n")
        ends = [self.new("n") for _ in range(int(self.rng.integers(1, 3)))]
        self.inductor(node, middle)
        for end in ends:
            self.inductor(middle, end)
            self.resistor(end, GROUND)
        self.nodes += ends

    def _coupled(self, node: str) -> None:
        far = self.new("n")
        own, other = self.number(), self.number()
        mutual = round(0.7 * (own * other) ** 0.5, 3)
        windings = ((node, GROUND), (far, GROUND))
        matrix = ((own, mutual), (mutual, other))
        self.add("coupled_inductors", "T", windings=windings, inductance=matrix)
        self.resistor(far, GROUND)
        self.nodes.append(far)

    def _two_port(self, node: str) -> None:
        far = self.new("n")
        kind = str(self.pick(["transformer", "gyrator"]))
        self.add(kind, "T", between=(node, GROUND), second=(far, GROUND), ratio=self.signed())
        self.resistor(far, GROUND)
        if self.chance(0.5):
            self.pick([self.capacitor, self.inductor])(far, GROUND)
        self.nodes.append(far)

    def rectifier(self) -> None:
        """Diodes behind resistors: an algebraic loop, unless a store is beside."""
        node = self.node()
        vertex = self.new("n")
        self.resistor(node, vertex)
        for _ in range(int(self.rng.integers(1, 3))):
            ends = (vertex, GROUND) if self.chance(0.6) else (GROUND, vertex)
            given = {"saturation": self.number(0.02, 0.2), "voltage": self.number(0.4, 1.0)}
            self.lossy.append(self.add("diode", "D", between=ends, **given))
        if self.chance(0.5):
            self.capacitor(vertex, GROUND)
        self.nodes.append(vertex)

    def magnetic(self) -> None:
        """A core with a winding or two."""
        core = self.new("f")
        self.add("reluctance", "P", between=(core, GROUND), reluctance=self.value())
        if self.chance(0.4):
            gap = self.new("f")
            self.add("reluctance", "P", between=(core, gap), reluctance=self.value())
            self.add("reluctance", "P", between=(gap, GROUND), reluctance=self.value())
        for _ in range(int(self.rng.integers(1, 3))):
            ends = (self.behind(1.0), GROUND)
            self.add("winding", "W", between=ends, second=(core, GROUND), turns=self.signed())

    def stiff(self) -> None:
        """Stores that a source gives what they keep: the source's derivative counts."""
        vertex, kind = self.new("n"), int(self.rng.integers(3))
        if kind == 0:
            self.add("voltage_source", "V", between=(vertex, GROUND), voltage=self.given())
            self.capacitor(vertex, GROUND)
            self.nodes.append(vertex)
        elif kind == 1:
            self.add("current_source", "I", between=(GROUND, vertex), current=self.given())
            far = self.new("n")
            self.inductor(vertex, far)
            self.resistor(far, GROUND)
            self.nodes.append(far)
        else:
            shaft, far = self.new("s"), self.new("s")
            given = {"between": (shaft, GROUND), "velocity": self.given()}
            self.add("angular_velocity_source", "Q", **given)
            self.add("inertia", "J", between=(shaft, GROUND), inertia=self.value())
            self.spring("rotational_spring", shaft, far)
            self.interface(far)

    def amplifier(self) -> None:
        """An op-amp that integrates or amplifies, and a resistance of no constant."""
        node, minus, out = self.node(), self.new("n"), self.new("n")
        self.resistor(node, minus)
        self.pick([self.capacitor, self.resistor])(minus, out)
        self.add("opamp", "a_", between=(GROUND, minus), output=(out, GROUND), controlled=True)
        law = f"y = {self.number()}*x + {self.number(0.05, 0.2)}*x**3"
        load = {"between": (out, GROUND), "domain": ELECTRICAL, "law": law}
        self.lossy.append(self.add("element", "e_", **load))
        self.nodes.append(out)

    # -- transducers

    def motor(self) -> None:
        """With or without inductance, inertia, damping and gear."""
        given: dict[str, Any] = {"constant": self.value(), "resistance": self.resistance()}
        for key, share in (("inductance", 0.6), ("inertia", 0.5), ("damping", 0.5)):
            if self.chance(share):
                given[key] = self.value()
        if self.chance(0.5):
            given["ratio"] = self.signed()
        ends = (self.behind(0.2), GROUND)
        name = self.add("dc_motor", "M", between=ends, **self.place(), **given)
        self.lossy.append(name)
        if "inductance" in given:
            self.kept.append(f"through({name}.electrical)")

    def field(self, *, turning: bool = False) -> str:
        """An inductance or capacitance by a displacement."""
        a, b = self.number(0.8, 2.0), self.number(0.2, 0.7)
        if turning or self.chance(0.4):
            return f"{a} + {b}*cos({int(self.rng.integers(1, 3))}*x)"
        return f"{a} + {b}/(1 + x**2)"

    def solenoid(self) -> None:
        """By inductance, co-energy or energy; in a joint, between points or on a mass in a line."""
        kind = str(self.pick(["solenoid", "solenoid", "reluctance_machine"]))
        law, form = self.field(turning=kind != "solenoid"), self.rng.random()
        given: dict[str, Any] = {}
        if form < 0.4:
            given["inductance"] = law
        elif form < 0.7:
            given["coenergy"] = (
                f"({law})*i**2/2 + {self.number(0.05, 0.3)}*log(cosh(i))*(1 + x**2/9)"
            )
        else:
            given["energy"] = f"psi**2/(2*({law})) + {self.number(0.02, 0.1)}*psi**4"
        if self.chance(0.5):
            given["resistance"] = self.resistance()
        where = self.place(0.3) if kind == "solenoid" else self.place()
        if self.chance(0.2):
            where = {"shaft": self._mass() if kind == "solenoid" else self._rotor()}
        ends = (self.behind(), GROUND)
        name = self.add(kind, "S", between=ends, **where, **given)
        if "resistance" in given:
            self.lossy.append(name)
        if "energy" not in given:
            self.kept.append(f"through({name}.electrical)")

    def plate(self) -> None:
        """A capacitor whose plate moves."""
        law, form = self.field(), self.rng.random()
        if form < 0.4:
            given = {"capacitance": law}
        elif form < 0.7:
            given = {"coenergy": f"({law})*v**2/2 + {self.number(0.02, 0.1)}*v**4*cos(x)**2"}
        else:
            given = {"energy": f"q**2/(2*({law})) + {self.number(0.02, 0.1)}*q**4"}
        where = {"shaft": self._mass()} if self.chance(0.15) else self.place(0.3)
        vertex = self.behind(1.0 if "energy" in given else 0.8)
        ends = (vertex, GROUND) if self.chance(0.7) else (GROUND, vertex)
        name = self.add("variable_capacitor", "B", between=ends, **where, **given)
        if "energy" not in given:
            self.kept.append(f"across({name}.electrical)")
        if self.chance(0.3):
            self.capacitor(*ends)

    def piezo(self) -> None:
        """A stack, now and then two in parallel."""
        vertex = self.behind(0.9)
        for _ in range(2 if self.chance(0.3) else 1):
            given = {
                "stiffness": self.value(),
                "coupling": self.signed(),
                "capacitance": self.value(),
            }
            self.add("piezo", "Z", between=(vertex, GROUND), **self.place(0.3), **given)

    def coil(self) -> None:
        """A moving coil."""
        given: dict[str, Any] = {"constant": self.value()}
        if self.chance(0.5):
            given["inductance"] = self.value()
        if self.chance(0.7):
            given["resistance"] = self.resistance()
        ends = (self.behind(0.3 if "inductance" in given else 1.0), GROUND)
        name = self.add("moving_coil", "E", between=ends, **self.place(0.3), **given)
        self.lossy.append(name)

    def machine(self) -> None:
        """Two phases or three, in a star that floats or not, round or salient, with magnets or without."""
        phases = int(self.rng.integers(2, 4))
        star = GROUND if self.chance(0.5) else self.new("n")
        own, mutual, salient = self.number(1, 2), self.number(0.1, 0.3), self.number(0.05, 0.15)
        shift = [round(2 * np.pi * k / phases, 6) for k in range(phases)]
        if phases == 2:
            shift[1] = round(np.pi / 2, 6)
        pairs = int(self.rng.integers(1, 4))
        matrix = [[str(-mutual)] * phases for _ in range(phases)]
        for i in range(phases):
            for j in range(i + 1):
                base = own if i == j else -mutual
                entry = f"{base} + {salient}*cos({2 * pairs}*x - {round(shift[i] + shift[j], 6)})"
                matrix[i][j] = matrix[j][i] = entry if self.salient(phases, pairs) else str(base)
        flux = tuple(f"{self.number(0.3, 1)}*cos({pairs}*x - {s})" for s in shift)
        windings = []
        for _ in range(phases):
            vertex = self.new("n")
            self.add("voltage_source", "V", between=(vertex, GROUND), voltage=self.given())
            windings.append((vertex, star))
        given: dict[str, Any] = {"inductance": tuple(map(tuple, matrix))}
        if self.chance(0.7):
            given["flux"] = flux
        if self.chance(0.8):
            given["resistance"] = self.value()
        where = {"shaft": self._rotor()} if self.chance(0.2) else self.place()
        name = self.add("synchronous_machine", "Y", windings=tuple(windings), **given, **where)
        if "resistance" in given:
            self.lossy.append(name)

    def salient(self, phases: int, pairs: int) -> bool:
        return (phases + pairs) % 2 == 0

    # -- 1-D mechanics

    def _rotor(self) -> Pair:
        """A shaft with an inertia, held or not."""
        vertex = self.new("s")
        self.add("inertia", "J", between=(vertex, GROUND), inertia=self.value())
        if self.chance(0.5):
            given = {"between": (vertex, GROUND), "damping": self.value()}
            self.lossy.append(self.add("rotational_damper", "d", **given))
        return vertex, GROUND

    def _mass(self) -> Pair:
        """A mass in a line."""
        vertex = self.new("m")
        self.add("mass", "m", between=(vertex, GROUND), mass=self.value())
        if self.chance(0.7):
            self.spring("translational_spring", vertex, GROUND)
        if self.chance(0.5):
            given = {"between": (vertex, GROUND), "damping": self.value()}
            self.lossy.append(self.add("translational_damper", "c", **given))
        return vertex, GROUND

    def spring(self, kind: str, tail: str, head: str) -> None:
        if self.chance(0.7):
            name = self.add(kind, "k_", between=(tail, head), stiffness=self.value())
            self.kept.append(f"through({name})")
        else:
            energy = f"{self.number()}*x**2/2 + {self.number(0.02, 0.1)}*x**4"
            self.add(kind, "k_", between=(tail, head), energy=energy)

    def train(self) -> None:
        """An interface to a joint, gears, inertias, springs; perhaps a motor at the end."""
        shaft = self.new("s")
        self.interface(shaft)
        for _ in range(int(self.rng.integers(1, 4))):
            if self.chance(0.6):
                self.add("inertia", "J", between=(shaft, GROUND), inertia=self.value())
            if self.chance(0.6):
                near, shaft = shaft, self.new("s")
                given = {"between": (near, GROUND), "second": (shaft, GROUND)}
                if self.chance(0.7):
                    self.add("gear", "N", **given, ratio=self.signed())
                else:
                    radii = {"radius1": self.number(), "radius2": self.number()}
                    self.add("belt", "N", **given, **radii)
            if self.chance(0.5):
                near, shaft = shaft, self.new("s")
                self.spring("rotational_spring", near, shaft)
                if self.chance(0.4):
                    given = {"between": (near, shaft), "damping": self.value()}
                    self.lossy.append(self.add("rotational_damper", "d", **given))
                self.add("inertia", "J", between=(shaft, GROUND), inertia=self.value())
        end = self.rng.random()
        if end < 0.3:
            self.add("torque_source", "Q", between=(GROUND, shaft), torque=self.given())
        elif end < 0.6:
            given = {"constant": self.value(), "resistance": self.value()}
            if self.chance(0.6):
                given["inductance"] = self.value()
            if self.chance(0.5):
                given |= {"inertia": self.value(), "ratio": self.signed()}
            ends = {"between": (self.node(), GROUND), "shaft": (shaft, GROUND)}
            self.lossy.append(self.add("dc_motor", "M", **ends, **given))
        elif end < 0.8:
            given = {"viscous": self.value(), "coulomb": self.value(), "width": self.number()}
            name = self.add("rotational_friction", "F", between=(shaft, GROUND), **given)
            self.lossy.append(name)
        else:
            near, mass = shaft, self.new("m")
            kind, key = self.pick([("rack", "radius"), ("screw", "lead")])
            ends = {"between": (near, GROUND), "second": (mass, GROUND)}
            self.add(kind, "N", **ends, **{key: self.number()})
            self.add("mass", "m", between=(mass, GROUND), mass=self.value())

    def sliding_train(self) -> None:
        """The same in a line, at a joint or between two points."""
        vertex = self.new("m")
        self.add(
            "translational_interface", "X", between=(vertex, GROUND), **self.place(0.5, "prismatic")
        )
        if self.chance(0.6):
            self.add("mass", "m", between=(vertex, GROUND), mass=self.value())
        if self.chance(0.4):
            near, vertex = vertex, self.new("m")
            ends = {"between": (near, GROUND), "second": (vertex, GROUND)}
            self.add("lever", "N", **ends, ratio=self.signed())
        near, vertex = vertex, self.new("m")
        self.spring("translational_spring", near, vertex)
        self.add("mass", "m", between=(vertex, GROUND), mass=self.value())
        if self.chance(0.5):
            given = {"between": (near, vertex), "damping": self.value()}
            self.lossy.append(self.add("translational_damper", "c", **given))
        if self.chance(0.4):
            self.add("force_source", "Q", between=(GROUND, vertex), force=self.given())

    def differential(self) -> None:
        """An inertia that turns as fast as two joints together."""
        first, second = self.new("s"), self.new("s")
        self.interface(first)
        self.interface(second, first)
        self.add("inertia", "J", between=(second, GROUND), inertia=self.value())

    # -- hydraulics

    def line(self) -> str:
        """A vertex with pressure."""
        vertex = self.new("h")
        kind = self.rng.random()
        if kind < 0.5:
            self.add("pressure_source", "H", between=(vertex, GROUND), pressure=self.given())
            return vertex
        if kind < 0.75:
            self.add("flow_source", "H", between=(GROUND, vertex), flow=self.given())
        else:
            given = {"displacement": self.value(), "leakage": self.value()}
            where = {"shaft": self._rotor()} if self.chance(0.4) else self.place()
            self.lossy.append(self.add("pump", "H", between=(GROUND, vertex), **where, **given))
        self.accumulator(vertex)
        return vertex

    def accumulator(self, vertex: str) -> None:
        kind, given = self.rng.random(), {}
        if kind < 0.75:
            given = {"capacity": self.value()}
        elif kind < 0.9:
            given = {"coenergy": f"{self.number()}*x**2/2 + {self.number(0.02, 0.1)}*x**4"}
        else:
            given = {"volume": f"{self.number()}*x + 0.2*atan(x)"}
        name = self.add("accumulator", "A", between=(vertex, GROUND), **given)
        self.kept.append(f"across({name})")

    def throttle(self, tail: str, head: str) -> None:
        """An orifice, a valve, a pipe."""
        kind = str(self.pick(["orifice", "valve", "pipe"]))
        if kind == "pipe":
            given: dict[str, Any] = {"resistance": self.value()}
        else:
            given = {"coefficient": self.value(), "width": self.number(0.3, 1)}
            if kind == "valve":
                given["opening"] = self.pick([0.7, f"0.6 + 0.3*{self.input()}", "0.5 + 0.4*sin(t)"])
        self.lossy.append(self.add(kind, "O", between=(tail, head), **given))

    def cylinder(self) -> None:
        """One chamber or two, each with its oil, its throttle or a column of oil in a pipe."""
        line, where = self.line(), self.place(0.8)
        for sign in (1, -1)[: int(self.rng.integers(1, 3))]:
            chamber = self.new("h")
            area = sign * self.number()
            self.add("cylinder", "K", between=(chamber, GROUND), **where, area=area)
            kind = self.rng.random()
            if kind < 0.6:
                self.throttle(line, chamber)
                self.accumulator(chamber)
                if self.chance(0.5):
                    self.throttle(chamber, GROUND)
            elif kind < 0.8:
                middle = self.new("h")
                self.add("inertance", "I", between=(line, middle), inertance=self.value())
                self.throttle(middle, chamber)
            else:
                self.throttle(line, chamber)
                self.throttle(chamber, GROUND)

    def branched(self) -> None:
        """Two cylinders that share a column of oil: its inertia ties joints and points to each other."""
        vertex, line = self.new("h"), self.line()
        for _ in range(2):
            ends = (vertex, GROUND)
            self.add("cylinder", "K", between=ends, **self.place(0.5), area=self.signed())
        middle = self.new("h")
        self.add("inertance", "I", between=(vertex, middle), inertance=self.value())
        self.throttle(middle, line)

    def hydraulic_drive(self) -> None:
        """A motor between two lines."""
        line, back = self.line(), self.new("h")
        given: dict[str, Any] = {"displacement": self.value()}
        if self.chance(0.7):
            given["leakage"] = self.value()
        where = {"shaft": self._rotor()} if self.chance(0.2) else self.place()
        name = self.add("hydraulic_motor", "H", between=(line, back), **where, **given)
        self.lossy.append(name)
        self.throttle(back, GROUND)
        if self.chance(0.5):
            self.add(
                "tank", "A", between=(back, GROUND), area=self.value(), density=1.0, gravity=1.0
            )

    # -- heat, and force elements that see networks

    def thermal(self) -> None:
        """A body that keeps heat, on which resistances may depend."""
        vertex = self.new("q")
        name = self.add("heat_capacity", "c_", between=(vertex, GROUND), capacity=self.value())
        self.temperatures.append(name)

    def heated(self) -> None:
        """What is lost goes into bodies that keep heat and cool."""
        vertices = [f"q{k + 1}" for k in range(self.counts.get("q", 0))]
        if not vertices or self.chance(0.3):
            vertices.append(self.new("q"))
            ends = (vertices[-1], GROUND)
            self.add("heat_capacity", "c_", between=ends, capacity=self.value())
        count = min(len(self.lossy), int(self.rng.integers(1, 4)))
        names = tuple(str(x) for x in self.rng.choice(self.lossy, count, replace=False))
        self.add("losses", "l_", between=(GROUND, vertices[0]), of=names)
        air = self.new("q")
        self.add("temperature_source", "t_", between=(air, GROUND), temperature=self.number())
        for vertex in vertices:
            kind = str(self.pick(["conduction", "convection", "radiation"]))
            given: dict[str, Any] = {"conductance": self.value()}
            if kind != "conduction":
                given = {"coefficient": self.number(0.02, 0.1)}
            self.add(kind, "g_", between=(vertex, air), **given)
        if len(vertices) > 1:
            self.add(
                "conduction", "g_", between=(vertices[0], vertices[1]), conductance=self.value()
            )

    def law(self) -> None:
        """A force in a joint that what a store keeps decides."""
        if self.kept:
            force = f"{self.signed()}*{self.pick(self.kept)}*(1 + 0.3*x) + 0.2*v"
            self.add("law", "law", controlled=True, joint=str(self.pick(self.joints)), force=force)

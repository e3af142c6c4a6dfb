"""Seeded random systems of everything a model may say, each with the same mechanism made of simple joints.

A random tree gets joints of several freedoms, couplings, rotors, a basement and joints in prescribed motion,
force elements and loads. Beside the model stands a `random_trees.Tree` of revolute, prismatic, planar and
free joints with massless bodies in between, which the Newton-Euler oracle reads:

    cylindrical, universal, angles, compound, basement    simple joints one after the other
    helical                                               a slide coupled to a hinge
    rotor                                                 a body on a hinge coupled to the joint's
    ball with a quaternion                                a free joint held at its origin

What is prescribed or held are coordinates of that tree with known q, v and a: with f the free ones and p
the others, M = M_ff and h = h_f + M_fp a_p. Elements and loads act through the oracle's Jacobians; their laws
stand here as text for the model and as functions of numpy for the comparison.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from oracles import newton_euler as oracle
from support.spec_models import numbers, rows
from systems import random_trees as trees

from linegraph import Model
from linegraph.model.body_handle import BodyHandle

Array = np.ndarray
Values = Mapping[str, Any]
Law = tuple[str, Callable[[float, float, Values], float]]
"""A law as text for the model, and as a function of x, v and all that has a name."""
Stored = tuple[Callable[[float, Values], float], Callable[[float, Values], float]]
"""An energy as a function of x and of values by name, and its derivative with respect to x."""

BASEMENT = "basement"
SINGLE = ("revolute", "prismatic", "helical")
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
SEQUENCES = ("xyz", "zyx", "yxz", "zxz", "yzy")
HERE = (np.zeros(3), np.eye(3))
REGULARITY = 1e-4
"""Least eigenvalue of M scaled to a unit diagonal: what accuracy of accelerations stands on."""

STIFFNESS, PULL, PUSH = 37.5, "pull", "push"


@dataclass(frozen=True)
class Drive:
    """A prescribed coordinate: a text or a number and its three values at t, or "input" for named inputs."""

    text: Any
    at: Callable[[float, Values], tuple[float, float, float]]


@dataclass(frozen=True)
class Freedom:
    """Where a joint of one freedom finds its coordinate in the tree: ratio q[joint] + offset."""

    joint: str
    ratio: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Point:
    """A terminal: a frame on a body."""

    name: str
    body: str
    at: Array
    rotation: Array


class Rigid(NamedTuple):
    """M, h, both energies and motions of the oracle."""

    mass: Array
    bias: Array
    kinetic: float
    potential: float
    motions: dict[str, oracle.Motion]


@dataclass(frozen=True)
class State:
    """A state of the model and what the oracle makes of it.

    Attributes:
        q, v, a: the model's coordinates, velocities and accelerations.
        t: the time.
        u: the inputs by name.
        whole: q, v and a of the tree, in which only what is prescribed accelerates.
        rigid: what the oracle says there, without elements and loads.
    """

    q: Array
    v: Array
    a: Array
    t: float
    u: dict[str, float]
    whole: tuple[Array, Array, Array]
    rigid: Rigid


@dataclass(frozen=True)
class Expected:
    """What emitted code has to say, and what of the forces is not driven and of that conservative."""

    mass: Array
    bias: Array
    efforts: Array
    kinetic: float
    potential: float
    passive: Array
    conservative: Array


@dataclass
class Scene:
    """What forces are evaluated on: motions of all bodies, and everything by name."""

    motions: dict[str, oracle.Motion]
    velocities: Array
    freedoms: Mapping[str, tuple[float, float, Array]]
    values: dict[str, Any]


@dataclass(frozen=True)
class Force:
    """An element or load: generalised forces (nv,) on a scene, and whether inputs drive it.

    Attributes:
        potential: the energy (J) that the element stores, where it is known.
        conservative: the part of the forces that this energy belongs to.
    """

    act: Callable[[Scene], Array]
    driven: bool = False
    potential: Callable[[Scene], float] | None = None
    conservative: Callable[[Scene], Array] | None = None


@dataclass
class System:
    """A model and the same mechanism for the oracle.

    Attributes:
        own, held: joints of the tree whose coordinates are the model's; those held at their origin.
        drives: what moves the others, by joint.
        freedoms: the model's joints of one freedom.
        names: the model's coordinates in order.
    """

    model: Model
    tree: trees.Tree
    own: list[str] = field(default_factory=list)
    held: set[str] = field(default_factory=set)
    drives: dict[str, Drive] = field(default_factory=dict)
    driven_names: dict[str, str] = field(default_factory=dict)
    freedoms: dict[str, Freedom] = field(default_factory=dict)
    forces: list[Force] = field(default_factory=list)
    effort_places: list[int] = field(default_factory=list)
    named_inputs: list[str] = field(default_factory=list)

    def places(self) -> tuple[Array, Array]:
        """The entries of the tree's q and v that are the model's, in its order."""
        q: list[int] = []
        v: list[int] = []
        for name, at_q in self.tree.coordinate_slices.items():
            at_v = self.tree.velocity_slices[name]
            skip = 3 if name in self.held else 0
            if name not in self.drives:
                q += range(at_q.start + skip, at_q.stop)
                v += range(at_v.start + skip, at_v.stop)
        return np.array(q, dtype=int), np.array(v, dtype=int)

    @property
    def names(self) -> list[str]:
        """The model's coordinates by name."""
        moving = {joint.name for joint in self.model.joints if joint.drive is None}
        moving -= {coupling.joint for coupling in self.model.couplings}
        return [c.name for j in self.model.joints if j.name in moving for c in j.positions()]


# ---- states and what is expected of them


def draw_state(rng: np.random.Generator, system: System) -> State:
    """A state of model and tree, at some time, for some inputs."""
    tree = system.tree
    q, v = trees.random_state(rng, tree)
    for name in system.held:
        at = tree.coordinate_slices[name].start
        q[at : at + 3] = 0
        at = tree.velocity_slices[name].start
        v[at : at + 3] = 0
    t = float(rng.uniform(-2, 2))
    u = {name: float(rng.normal()) for name in system.named_inputs}
    own_q, own_v = system.places()
    a = np.zeros(tree.nv)
    for name, drive in system.drives.items():
        entry, rate = tree.coordinate_slices[name].start, tree.velocity_slices[name].start
        q[entry], v[rate], a[rate] = drive.at(t, u)
    own_a = rng.normal(size=len(own_v))
    return State(q[own_q], v[own_v], own_a, t, u, (q, v, a), rigid(tree, q, v))


def expected(system: System, state: State, tau: Array) -> Expected:
    """What follows from the oracle, for efforts `tau` along the velocities that carry some."""
    tree, (q, v, a) = system.tree, state.whole
    _, own = system.places()
    mass, bias, kinetic, potential, motions = state.rigid
    scene = Scene(motions, v, _freedoms(system, q, v), _values(system, state))
    sums = {key: np.zeros(tree.nv) for key in ("passive", "driven", "conservative")}
    for force in system.forces:
        acting = force.act(scene)
        sums["driven" if force.driven else "passive"] += acting
        if force.potential is not None:
            assert force.conservative is not None
            potential += force.potential(scene)
            sums["conservative"] += force.conservative(scene)
    efforts = sums["driven"][own]
    efforts[system.effort_places] += tau
    return Expected(
        mass[np.ix_(own, own)],
        (bias + mass @ a - sums["passive"])[own],
        efforts,
        kinetic,
        potential,
        sums["passive"][own],
        sums["conservative"][own],
    )


def rigid(tree: trees.Tree, q: Array, v: Array) -> Rigid:
    """All from one evaluation of the oracle's Jacobians."""
    motions = oracle.body_motions(tree, q, v)
    mass, bias = np.zeros((tree.nv, tree.nv)), np.zeros(tree.nv)
    kinetic = potential = 0.0
    for body in tree.bodies:
        if not body.mass and not body.inertia.any():
            continue
        center = oracle.carried(motions[body.name], v, body.mass_center, np.eye(3))
        inertia = center.rotation @ body.inertia @ center.rotation.T
        spin = center.angular @ v
        mass += body.mass * center.linear.T @ center.linear
        mass += center.angular.T @ inertia @ center.angular
        force = body.mass * (center.linear_bias - tree.gravity)
        moment = inertia @ center.angular_bias + np.cross(spin, inertia @ spin)
        bias += center.linear.T @ force + center.angular.T @ moment
        speed = center.linear @ v
        kinetic += float(body.mass * speed @ speed + spin @ inertia @ spin) / 2
        # energy is of all that moves: not of what is welded to ground
        if center.linear.any() or center.angular.any():
            potential -= float(body.mass * tree.gravity @ center.origin)
    return Rigid(mass, bias, kinetic, potential, motions)


def regular(system: System, state: State) -> bool:
    """Whether M is safely positive definite."""
    own = system.places()[1]
    mass = state.rigid.mass[np.ix_(own, own)]
    diagonal = np.diag(mass)
    if diagonal.min() < REGULARITY:
        return False
    return bool(np.linalg.eigvalsh(mass / np.sqrt(np.outer(diagonal, diagonal)))[0] > REGULARITY)


def _freedoms(system: System, q: Array, v: Array) -> dict[str, tuple[float, float, Array]]:
    """x, v and the Jacobian of v for each of the model's joints of one freedom."""
    tree, found = system.tree, {}
    for name, freedom in system.freedoms.items():
        entry = tree.coordinate_slices[freedom.joint].start
        rate = tree.velocity_slices[freedom.joint].start
        along = freedom.ratio * np.eye(tree.nv)[rate]
        found[name] = (freedom.ratio * q[entry] + freedom.offset, float(along @ v), along)
    return found


def _values(system: System, state: State) -> dict[str, Any]:
    """All that a law may name."""
    q, v, _ = state.whole
    own, _ = system.places()
    values: dict[str, Any] = {"k": STIFFNESS, "t": state.t, **state.u}
    rates = oracle.coordinate_rates(system.tree, q, v)
    for name, entry in zip(system.names, own, strict=True):
        values[name], values[f"der({name})"] = q[entry], rates[entry]
    for name, joint in system.driven_names.items():
        values[name], values[f"der({name})"], _ = system.drives[joint].at(state.t, state.u)
    return values


# ---- the systems


def random_system(seed: int) -> System:
    """A system whose M is regular at a random state."""
    rng = np.random.default_rng(seed)
    while True:
        system = _Builder(rng, f"system{seed}", moving=bool(seed % 2), bodies=1 + seed % 6).build()
        if not system.names:
            continue
        if all(regular(system, draw_state(rng, system)) for _ in range(3)):
            return system


class _Builder:
    """Says everything twice: to the model and to the tree."""

    def __init__(self, rng: np.random.Generator, name: str, *, moving: bool, bodies: int) -> None:
        self.rng, self.moving = rng, moving
        kinds = ("fixed", "revolute", "revolute", "prismatic", "planar", "free")
        self.skeleton = trees.random_tree(rng, bodies, kinds, couplings=False)
        self.model = Model(name, gravity=numbers(self.skeleton.gravity))
        self.bodies = list(self.skeleton.bodies)
        self.joints: list[trees.Joint] = []
        self.couplings: list[trees.Coupling] = []
        self.system = System(self.model, self.skeleton)
        self.effort_names: list[str] = []
        self.singles: dict[str, str] = {}

    def build(self) -> System:
        """The system of random parts."""
        for body in self.skeleton.bodies:
            self.model.body(
                body.name,
                mass=float(body.mass),
                mass_center=numbers(body.mass_center),
                inertia=rows(body.inertia),
            )
        self.model.parameter("k", STIFFNESS)
        for name in (PULL, PUSH):
            self.model.input(name)
        self.system.named_inputs += [PULL, PUSH]
        if self.moving:
            self._basement()
        for joint in self.skeleton.joints:
            self._joint(joint)
        self._couple()
        self._rotors()
        system, order = self.system, {joint.name: joint for joint in self.joints}
        system.tree = trees.Tree(
            tuple(self.bodies), tuple(order.values()), tuple(self.couplings), self.skeleton.gravity
        )
        self._efforts()
        _Forces(self.rng, system).add()
        return system

    def _basement(self) -> None:
        """A massless body in prescribed motion, from which most of what hung on ground now hangs."""
        rng = self.rng
        names = [f"{BASEMENT}_{part}" for part in ("x", "y", "z", "yaw", "pitch", "roll")]
        slides = [random_drive(rng, names[k]) for k in range(3)]
        form = rng.choice(["rpy", "axis", "input", "none"])
        axes = [AXES[c] for c in "xyz"]
        turns: list[Drive] = []
        rotation: Any = None
        if form == "axis":
            axis = rng.normal(size=3)
            names[3] = f"{BASEMENT}_angle"
            turns = [random_drive(rng, names[3])]
            axes.append(numbers(axis / np.linalg.norm(axis)))
            rotation = {"axis": numbers(axis), "angle": turns[0].text}
        elif form != "none":
            make = input_drive if form == "input" else random_drive
            turns = [make(rng, names[3 + k]) for k in range(3)]
            axes += [AXES[c] for c in "zyx"]
            yaw, pitch, roll = (turn.text for turn in turns)
            rotation = "input" if form == "input" else {"rpy": (roll, pitch, yaw)}
        self.model.basement(tuple(slide.text for slide in slides), rotation)
        kinds = ["prismatic"] * 3 + ["revolute"] * len(turns)
        simple = trees.Joint(BASEMENT, "fixed", "ground", BASEMENT, *HERE, *HERE, np.zeros(3))
        parts = self._parts(simple, list(zip(kinds, axes, strict=True)))
        self.bodies.append(trees.Body(BASEMENT, 0.0, np.zeros(3), np.zeros((3, 3))))
        for name, part, drive in zip(names, parts, [*slides, *turns], strict=False):
            self._drive(name, part, drive)

    def _drive(self, name: str, part: str, drive: Drive) -> None:
        """Prescribe a coordinate, called `name` in the model."""
        self.system.drives[part] = drive
        self.system.driven_names[name] = part
        if drive.text == "input":
            self.system.named_inputs += [name, f"{name}_rate", f"{name}_acceleration"]

    def _joint(self, joint: trees.Joint) -> None:
        """A joint of the skeleton as it is, as one of the family, or in prescribed motion."""
        rng = self.rng
        if self.moving and rng.random() < 0.8:
            joint = replace(
                joint,
                tail=BASEMENT if joint.tail == "ground" else joint.tail,
                head=BASEMENT if joint.head == "ground" else joint.head,
            )
        kind, options = joint.kind, {"axis": numbers(joint.axis)}
        parts: list[tuple[str, Any]] = [(kind, numbers(joint.axis))]
        leads: list[tuple[int, float]] = []
        if kind != "fixed" and rng.random() < 0.6:
            kind = str(rng.choice(list(FAMILIES)))
            options, parts, leads = FAMILIES[kind](rng, numbers(joint.axis))
        if self.moving and kind in ("revolute", "prismatic") and rng.random() < 0.2:
            drive = random_drive(rng, joint.name)
            options["drive"] = drive.text
            self._drive(joint.name, f"{joint.name}.0", drive)
        elif kind in SINGLE:
            self.singles[joint.name] = kind
        ends = tuple(
            BodyHandle(self.model, body).frame(
                f"{joint.name}.{end}", at=numbers(at), rotation=rows(r)
            )
            for body, end, at, r in (
                (joint.tail, "tail", joint.tail_at, joint.tail_rotation),
                (joint.head, "head", joint.head_at, joint.head_rotation),
            )
        )
        getattr(self.model, kind)(joint.name, ends, **options)
        if kind == "spherical" and options.get("angles") is None:
            self.system.held.add(f"{joint.name}.0")
        if kind in SINGLE:
            self.system.freedoms[joint.name] = Freedom(f"{joint.name}.0")
        names = self._parts(joint, parts)
        for k, lead in leads:
            ratio = lead / (2 * np.pi)
            self.couplings.append(trees.Coupling(names[k + 1], names[k], ratio, 0.0))

    def _parts(self, joint: trees.Joint, parts: list[tuple[str, Any]]) -> list[str]:
        """Simple joints one after the other with massless bodies in between."""
        last = len(parts) - 1
        between = [f"{joint.name}.body{k}" for k in range(last)]
        self.bodies += [trees.Body(name, 0.0, np.zeros(3), np.zeros((3, 3))) for name in between]
        stops = [joint.tail, *between, joint.head]
        for k, (kind, axis) in enumerate(parts):
            tail = (joint.tail_at, joint.tail_rotation) if k == 0 else HERE
            head = (joint.head_at, joint.head_rotation) if k == last else HERE
            name, ends = f"{joint.name}.{k}", (stops[k], stops[k + 1])
            self.joints.append(trees.Joint(name, kind, *ends, *tail, *head, np.array(axis)))
        return [f"{joint.name}.{k}" for k in range(last + 1)]

    def _couple(self) -> None:
        """Some joints of one freedom follow others, also in a chain."""
        rng, names = self.rng, list(self.singles)
        for k in range(1, len(names)):
            if rng.random() < 0.3:
                follower, master = names[k], names[int(rng.integers(k))]
                ratio, offset = (
                    float(rng.uniform(0.3, 2) * rng.choice([-1, 1])),
                    float(rng.normal()),
                )
                self.model.couple(follower, master, ratio, offset)
                self._follow(follower, self.system.freedoms[master], ratio, offset)

    def _follow(self, follower: str, master: Freedom, ratio: float, offset: float) -> None:
        """The tree's joint of a follower, and a screw's slide with it."""
        place = Freedom(master.joint, ratio * master.ratio, ratio * master.offset + offset)
        self.system.freedoms[follower] = place
        name = f"{follower}.0"
        self.couplings = [
            replace(
                c,
                master=place.joint,
                ratio=c.ratio * place.ratio,
                offset=c.ratio * place.offset,
            )
            if c.master == name
            else c
            for c in self.couplings
        ]
        self.couplings.append(trees.Coupling(name, place.joint, place.ratio, place.offset))

    def _rotors(self) -> None:
        """A rotor behind a gear at some hinges."""
        tails = {joint.name: joint for joint in self.joints}
        for name, kind in self.singles.items():
            if kind != "revolute" or self.rng.random() < 0.5:
                continue
            inertia, ratio = float(self.rng.uniform(0.01, 0.1)), float(self.rng.normal(scale=5))
            self.model.rotor(f"{name}_rotor", name, inertia, ratio)
            hinge, place = tails[f"{name}.0"], self.system.freedoms[name]
            tensor = inertia * np.outer(hinge.axis, hinge.axis)
            rotor = f"{name}_rotor"
            self.bodies.append(trees.Body(rotor, 0.0, np.zeros(3), tensor))
            self.joints.append(
                replace(hinge, name=rotor, head=rotor, head_at=np.zeros(3), head_rotation=np.eye(3))
            )
            followed = trees.Coupling(rotor, place.joint, ratio * place.ratio, ratio * place.offset)
            self.couplings.append(followed)
            self.system.freedoms[rotor] = Freedom(place.joint, followed.ratio, followed.offset)

    def _efforts(self) -> None:
        """The places among the model's velocities at which an effort acts."""
        followers = {coupling.joint for coupling in self.model.couplings}
        at = 0
        for joint in self.model.joints:
            if joint.drive is None and joint.name not in followers:
                count = joint.freedoms
                self.system.effort_places += range(at, at + count) if joint.effort else ()
                at += count


# ---- joints of the family: options, simple parts, screws among these

Made = tuple[dict[str, Any], list[tuple[str, Any]], list[tuple[int, float]]]


def _direction(rng: np.random.Generator) -> Any:
    """Any direction, one time in three a coordinate axis."""
    if rng.random() < 1 / 3:
        return numbers(rng.choice([-1.0, 1.0]) * np.eye(3)[rng.integers(3)])
    x = rng.normal(size=3)
    return numbers(x / np.linalg.norm(x))


def _universal(rng: np.random.Generator, axis: Any) -> Made:
    other = _direction(rng)
    while np.linalg.norm(np.cross(axis, other)) < 0.3:
        other = _direction(rng)
    return {"axes": (axis, other)}, [("revolute", axis), ("revolute", other)], []


def _spherical(rng: np.random.Generator, axis: Any) -> Made:
    if rng.random() < 0.5:
        return {}, [("free", axis)], []
    angles = str(rng.choice(SEQUENCES))
    return {"angles": angles}, [("revolute", AXES[c]) for c in angles], []


def _cylindrical(rng: np.random.Generator, axis: Any) -> Made:
    return {"axis": axis}, [("revolute", axis), ("prismatic", axis)], []


def _helical(rng: np.random.Generator, axis: Any) -> Made:
    lead = float(rng.normal())
    return {"axis": axis, "lead": lead}, [("revolute", axis), ("prismatic", axis)], [(0, lead)]


def _free(rng: np.random.Generator, axis: Any) -> Made:
    angles = str(rng.choice(SEQUENCES))
    parts = [("prismatic", AXES[c]) for c in "xyz"] + [("revolute", AXES[c]) for c in angles]
    return {"angles": angles}, parts, []


def _compound(rng: np.random.Generator, axis: Any) -> Made:
    given: list[Any] = []
    parts: list[tuple[str, Any]] = []
    leads: list[tuple[int, float]] = []
    for _ in range(int(rng.integers(1, 4))):
        kind = str(rng.choice(["revolute", "prismatic", "cylindrical", "helical"]))
        options, own, screws = FAMILIES.get(kind, _plain(kind))(rng, axis)
        options.pop("axis")
        given.append((kind, axis, options))
        leads += [(len(parts) + k, lead) for k, lead in screws]
        parts += own
        axis = _direction(rng)
    return {"parts": tuple(given)}, parts, leads


def _plain(kind: str) -> Callable[[np.random.Generator, Any], Made]:
    return lambda rng, axis: ({"axis": axis}, [(kind, axis)], [])


FAMILIES: dict[str, Callable[[np.random.Generator, Any], Made]] = {
    "universal": _universal,
    "spherical": _spherical,
    "cylindrical": _cylindrical,
    "helical": _helical,
    "compound": _compound,
    "free": _free,
}


# ---- prescribed motions


def input_drive(rng: np.random.Generator, name: str) -> Drive:
    """A coordinate from inputs."""
    names = (name, f"{name}_rate", f"{name}_acceleration")
    return Drive("input", lambda t, u: (u[names[0]], u[names[1]], u[names[2]]))


def random_drive(rng: np.random.Generator, name: str) -> Drive:
    """A constant, a function of time with its derivatives by hand, or inputs."""
    a, b, w = (float(x) for x in rng.uniform(0.2, 1.5, size=3))
    forms = (
        Drive(a, lambda t, u: (a, 0.0, 0.0)),
        Drive(
            f"{a} + {b}*sin({w}*t)",
            lambda t, u: (
                a + b * np.sin(w * t), b * w * np.cos(w * t), -b * w * w * np.sin(w * t)
            ),
        ),
        Drive(f"{a}*t - {b}*t**2", lambda t, u: (a * t - b * t * t, a - 2 * b * t, -2 * b)),
        Drive(
            f"{a}*exp(-{w}*t)",
            lambda t, u: (
                a * np.exp(-w * t), -a * w * np.exp(-w * t), a * w * w * np.exp(-w * t)
            ),
        ),
        Drive(
            f"{b}*tanh(t/{a})",
            lambda t, u: (
                b * np.tanh(t / a),
                b / a / np.cosh(t / a) ** 2,
                -2 * b / a**2 * np.tanh(t / a) / np.cosh(t / a) ** 2,
            ),
        ),
        Drive(
            "sqrt(2 + t**2)",
            lambda t, u: (np.sqrt(2 + t * t), t / np.sqrt(2 + t * t), 2 / (2 + t * t) ** 1.5),
        ),
        input_drive(rng, name),
    )  # fmt: skip
    return forms[int(rng.integers(len(forms)))]


# ---- elements and loads


class _Forces:
    """Adds elements and loads to both descriptions."""

    def __init__(self, rng: np.random.Generator, system: System) -> None:
        self.rng, self.system, self.model = rng, system, system.model
        self.count = 0

    def add(self) -> None:
        """About five of them, in joints where there are any, and between points."""
        makers = (self._spring, self._sprung, self._damper, self._friction, self._stop, self._law)
        for _ in range(int(self.rng.integers(2, 7))):
            makers[int(self.rng.integers(len(makers)))]()
        for _ in range(int(self.rng.integers(0, 3))):
            self._load()

    def _name(self) -> str:
        self.count += 1
        return f"element{self.count}"

    def _place(self) -> tuple[dict[str, Any], Callable[[Scene], tuple[float, float, Array]]]:
        """Where an element acts: x, its rate and the Jacobian of the rate."""
        joints = list(self.system.freedoms)
        if joints and self.rng.random() < 0.5:
            joint = str(self.rng.choice(joints))
            return {"joint": joint}, lambda scene: scene.freedoms[joint]
        a = self._point()
        b = self._point(without=a.body)
        return {"between": (a.name, b.name)}, lambda scene: _distance(scene, a, b)

    def _point(self, without: str = "") -> Point:
        """A new frame on a body or on ground; of two, one is on a body."""
        bodies = ["ground", *(body.name for body in self.model.bodies.values())]
        body = str(self.rng.choice([name for name in bodies if name != without]))
        at, rotation = self.rng.normal(size=3), trees.random_rotation(self.rng)
        name = f"point{sum(len(b.frames) for b in self.model.bodies.values())}"
        name += f"_{len(self.model.ground_frames)}"
        handle = BodyHandle(self.model, body)
        terminal = handle.frame(name, at=numbers(at), rotation=rows(rotation))
        return Point(terminal, body, at, rotation)

    def _element(
        self, word: str, options: dict[str, Any], law: Callable[[float, float, Values], float],
        driven: bool = False, energy: Stored | None = None,
    ) -> None:  # fmt: skip
        place, across = self._place()
        getattr(self.model, word)(self._name(), **place, **options)

        def act(scene: Scene) -> Array:
            x, v, along = across(scene)
            return -law(x, v, scene.values) * along

        if energy is None:
            self.system.forces.append(Force(act, driven))
            return
        held, tension = energy

        def stored(scene: Scene) -> float:
            return float(held(across(scene)[0], scene.values))

        def kept(scene: Scene) -> Array:
            x, _, along = across(scene)
            return -tension(x, scene.values) * along

        self.system.forces.append(Force(act, driven, stored, kept))

    def _spring(self) -> None:
        symbolic, k = bool(self.rng.random() < 0.4), float(self.rng.uniform(5, 50))
        length = float(self.rng.uniform(0, 1))
        k = STIFFNESS if symbolic else k
        self._element(
            "spring",
            {"stiffness": "k" if symbolic else k, "length": length},
            lambda x, v, s: k * (x - length),
            energy=(lambda x, s: k * (x - length) ** 2 / 2, lambda x, s: k * (x - length)),
        )

    def _sprung(self) -> None:
        length, (text, law) = float(self.rng.uniform(0, 1)), self._random_law()
        self._element(
            "spring",
            {"force": text, "length": length},
            lambda x, v, s: law(x - length, v, s),
            driven=_driven(text),
            energy=_stored(text, length),
        )

    def _damper(self) -> None:
        if self.rng.random() < 0.3:
            c = float(self.rng.uniform(0, 3))
            text = f"{c}*(1 + cos(t)**2)"
            self._element(
                "damper", {"damping": text}, lambda x, v, s: c * (1 + np.cos(s["t"]) ** 2) * v
            )
        else:
            self._element("damper", {"damping": "k/10"}, lambda x, v, s: STIFFNESS / 10 * v)

    def _friction(self) -> None:
        b, c, width = (float(x) for x in self.rng.uniform(0.1, 2, size=3))
        self._element(
            "friction",
            {"viscous": b, "coulomb": c, "width": width},
            lambda x, v, s: b * v + c * np.tanh(v / width),
        )

    def _stop(self) -> None:
        k, c, width = (float(x) for x in self.rng.uniform(0.1, 5, size=3))
        lower, upper = float(self.rng.uniform(-1, 0.5)), float(self.rng.uniform(0.5, 2))
        limits: dict[str, float] = {"lower": lower, "upper": upper}
        if self.rng.random() < 0.5:
            limits.pop(str(self.rng.choice(list(limits))))

        def push(depth: float, rate: float) -> float:
            root = np.hypot(depth, width)
            return float(k * (depth + root) / 2 + c * (1 + depth / root) / 2 * rate)

        def law(x: float, v: float, s: Values) -> float:
            above = push(x - limits["upper"], v) if "upper" in limits else 0.0
            return above - (push(limits["lower"] - x, -v) if "lower" in limits else 0.0)

        def held(depth: float) -> float:
            root = np.hypot(depth, width)
            return float(k * (depth * (depth + root) + width**2 * np.arcsinh(depth / width)) / 4)

        def energy(x: float, s: Values) -> float:
            above = held(x - limits["upper"]) if "upper" in limits else 0.0
            return above + (held(limits["lower"] - x) if "lower" in limits else 0.0)

        options = {**limits, "stiffness": k, "damping": c, "width": width}
        self._element("stop", options, law, energy=(energy, lambda x, s: law(x, 0.0, s)))

    def _law(self) -> None:
        text, law = self._random_law()
        self._element("law", {"force": text}, law, driven=_driven(text), energy=_stored(text))

    def _random_law(self) -> Law:
        names = [*self.system.names, *self.system.driven_names]
        laws = (*LAWS, named_law(str(self.rng.choice(names))))
        return laws[int(self.rng.integers(len(laws)))]

    def _load(self) -> None:
        point, axes = self._point(), str(self.rng.choice(["world", "body"]))
        laws = [LOADS[int(self.rng.integers(len(LOADS)))] for _ in range(6)]
        texts = [text for text, _ in laws]
        self.model.load(self._name(), point.name, texts[:3], texts[3:], axes)

        def act(scene: Scene) -> Array:
            motion = oracle.carried(
                scene.motions[point.body], scene.velocities, point.at, point.rotation
            )
            wrench = np.array([law(0.0, 0.0, scene.values) for _, law in laws], dtype=float)
            force, torque = wrench[:3], wrench[3:]
            if axes == "body":
                force, torque = motion.rotation @ force, motion.rotation @ torque
            acting: Array = motion.linear.T @ force + motion.angular.T @ torque
            return acting

        self.system.forces.append(Force(act, any(map(_driven, texts))))


def _driven(text: Any) -> bool:
    return PULL in str(text) or PUSH in str(text)


def _distance(scene: Scene, a: Point, b: Point) -> tuple[float, float, Array]:
    """The distance of two points, its rate and the Jacobian of that."""
    tail, head = (
        oracle.carried(scene.motions[p.body], scene.velocities, p.at, p.rotation) for p in (a, b)
    )
    line = head.origin - tail.origin
    x = float(np.linalg.norm(line))
    along = line / x @ (head.linear - tail.linear)
    return x, float(along @ scene.velocities), along


def named_law(name: str) -> Law:
    """A law of some coordinate and its rate."""
    return (
        f"0.7*atan({name}) + 0.2*der({name})*x",
        lambda x, v, s: 0.7 * np.arctan(s[name]) + 0.2 * s[f"der({name})"] * x,
    )


LAWS: tuple[Law, ...] = (
    ("3.1*x**3 + v/5", lambda x, v, s: 3.1 * x**3 + v / 5),
    ("k*sin(x) - 0.3*tanh(2*v)", lambda x, v, s: s["k"] * np.sin(x) - 0.3 * np.tanh(2 * v)),
    ("exp(-x**2)*cos(1.3*t)", lambda x, v, s: np.exp(-(x**2)) * np.cos(1.3 * s["t"])),
    ("pull*x/(1 + abs(x))", lambda x, v, s: s["pull"] * x / (1 + np.abs(x))),
    ("max(x, 0.2)*sqrt(1 + v**2)", lambda x, v, s: np.fmax(x, 0.2) * np.sqrt(1 + v**2)),
    ("min(x, v)*sign(v)", lambda x, v, s: np.fmin(x, v) * np.sign(v)),
    ("atan2(v, 1 + x**2)", lambda x, v, s: np.arctan2(v, 1 + x**2)),
    ("log(1 + x**2) - push", lambda x, v, s: np.log(1 + x**2) - s["push"]),
    ("sinh(x/9) + cosh(v/9)", lambda x, v, s: np.sinh(x / 9) + np.cosh(v / 9)),
    ("asin(x/(2 + x**2))", lambda x, v, s: np.arcsin(x / (2 + x**2))),
    ("acos(sin(v))*tan(t/4)", lambda x, v, s: np.arccos(np.sin(v)) * np.tan(s["t"] / 4)),
    ("(2 + x**2)**-1.5", lambda x, v, s: (2 + x**2) ** -1.5),
)

STORED: dict[str, Stored] = {
    "3.1*x**3 + v/5": (lambda x, s: 3.1 * x**4 / 4, lambda x, s: 3.1 * x**3),
    "k*sin(x) - 0.3*tanh(2*v)": (
        lambda x, s: s["k"] * (1 - np.cos(x)),
        lambda x, s: s["k"] * np.sin(x),
    ),
    "max(x, 0.2)*sqrt(1 + v**2)": (
        lambda x, s: 0.2 * x if x < 0.2 else x**2 / 2 + 0.02,
        lambda x, s: np.fmax(x, 0.2),
    ),
    "sinh(x/9) + cosh(v/9)": (
        lambda x, s: 9 * (np.cosh(x / 9) - 1) + x,
        lambda x, s: np.sinh(x / 9) + 1,
    ),
}
"""What laws store: their integral over x at rest. Of the others none is known, or it is zero."""


def _stored(text: str, length: float = 0.0) -> Stored | None:
    """What a law of the stretch x - length stores."""
    if text not in STORED:
        return None
    held, tension = STORED[text]
    return lambda x, s: held(x - length, s), lambda x, s: tension(x - length, s)


LOADS: tuple[Law, ...] = (
    ("0", lambda x, v, s: 0.0),
    ("2.5", lambda x, v, s: 2.5),
    ("pull", lambda x, v, s: s["pull"]),
    ("3*sin(2*t)", lambda x, v, s: 3 * np.sin(2 * s["t"])),
    ("push*t - k/30", lambda x, v, s: s["push"] * s["t"] - s["k"] / 30),
)

"""A sparse tableau of networks and mechanics, written apart: what `random_mixed` systems must do.

The unknowns y at a state are all potentials and through variables, their rates, and v̇. The equations are
Kirchhoff's current law, the components' laws as textbooks have them, the same differentiated once in time,
the charges' rates, the values of the states, and the mechanism with what its ports exert:

    F(y) = 0    dF/dt = 0    dual - rest - dQ/dt = 0    y_state = z    M v̇ + Σ row^T Y_port = Q - h

No tree is chosen: all of it is one linear least-squares problem for each step of Newton's method.
Slopes of all laws come from complex steps, charges and forces from dual numbers through the co-energies.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from oracles import newton_euler as oracle
from scipy.linalg import lstsq
from systems.random_mixed import GROUND, Part, Port, System, point

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Array = Any
Key = tuple[str, str]
STEP = 1e-30
ENOUGH, SMALL = 1e-13, 1e-11
"""Newton's method ends with a relative step below the first, or with one that stagnates below the other."""

MOST_STEPS = 60


class Dual:
    """A value with its slopes along a few directions; both complex, for steps in all variables at once."""

    __array_ufunc__ = None

    def __init__(self, a: Array, b: Array) -> None:
        """The value and its slopes."""
        self.a, self.b = a, b

    def __neg__(self) -> Dual:
        return Dual(-self.a, -self.b)

    def __add__(self, other: Any) -> Dual:
        y = dual(other)
        return Dual(self.a + y.a, self.b + y.b)

    def __mul__(self, other: Any) -> Dual:
        y = dual(other)
        return Dual(self.a * y.a, self.b * y.a + self.a * y.b)

    __radd__, __rmul__ = __add__, __mul__

    def __sub__(self, other: Any) -> Dual:
        return self + -dual(other)

    def __rsub__(self, other: Any) -> Dual:
        return dual(other) - self

    def __truediv__(self, other: Any) -> Dual:
        y = dual(other)
        return Dual(self.a / y.a, (self.b * y.a - self.a * y.b) / (y.a * y.a))

    def __rtruediv__(self, other: Any) -> Dual:
        return dual(other) / self

    def __pow__(self, n: int) -> Dual:
        return Dual(self.a**n, n * self.a ** (n - 1) * self.b)


def dual(x: Any) -> Dual:
    return x if isinstance(x, Dual) else Dual(x, 0.0)


def _smooth(value: Callable[[Array], Array], slope: Callable[[Array], Array]) -> Any:
    def function(x: Any) -> Any:
        return Dual(value(x.a), slope(x.a) * x.b) if isinstance(x, Dual) else value(x)

    return function


FUNCTIONS = {
    "sin": _smooth(np.sin, np.cos),
    "cos": _smooth(np.cos, lambda x: -np.sin(x)),
    "tanh": _smooth(np.tanh, lambda x: 1 / np.cosh(x) ** 2),
    "cosh": _smooth(np.cosh, np.sinh),
    "log": _smooth(np.log, lambda x: 1 / x),
    "exp": _smooth(np.exp, np.exp),
    "atan": _smooth(np.arctan, lambda x: 1 / (1 + x * x)),
    "sqrt": _smooth(np.sqrt, lambda x: 0.5 / np.sqrt(x)),
}


@cache
def compiled(text: str) -> Any:
    """An expression of this generator's own as Python's."""
    text = re.sub(r"(across|through|der)\(([\w.]+)\)", r'\1("\2")', text)
    return compile(text, "<expression>", "eval")


@dataclass
class Equations:
    """What a part contributes.

    Attributes:
        zeros: of laws without rates.
        charges: (dual variable, what it has beside the rate, charge).
        rates: of its own states.
        energy: that it stores; None where it is not known.
        heat: that it dissipates.
    """

    zeros: list[Array] = field(default_factory=list)
    charges: list[tuple[Array, Array, Array]] = field(default_factory=list)
    rates: dict[Key, Array] = field(default_factory=dict)
    energy: Array = 0.0
    heat: Array = 0.0


class At:
    """A part's variables, each with a complex step along every variable of the whole."""

    def __init__(self, part: Part, values: Mapping[Key, Array], taken: Mapping[str, Array]) -> None:
        """All variables, and what other parts turn into heat."""
        self.part, self.values, self.taken = part, values, taken
        self.X = [values[("X", p.edge)] for p in part.ports]
        self.Y = [values[("Y", p.edge)] for p in part.ports]
        self.out = Equations()

    def own(self, name: str) -> Array:
        return self.values[("s", f"{self.part.name}.{name}")]

    @property
    def x(self) -> Array:
        """The displacement."""
        port = self.part.ports[-1]
        if port.between is None:
            return self.values[("x", port.edge)]
        return self.own("displacement")

    def __call__(self, key: str, default: Any = None, **names: Any) -> Any:
        return self.value(self.part.options.get(key, default), **names)

    def value(self, given: Any, **names: Any) -> Any:
        """An option as a number or an expression."""
        if not isinstance(given, str):
            return given
        values = self.values
        scope: dict[str, Any] = {
            **{key[1]: x for key, x in values.items() if key[0] == "name"},
            **FUNCTIONS,
            "across": lambda edge: values[("X", edge)],
            "through": lambda edge: values[("Y", edge)],
            "der": lambda name: values[("der", name)],
            **names,
        }
        return eval(compiled(given), {"__builtins__": {}}, scope)

    def has(self, key: str) -> bool:
        return key in self.part.options

    def zero(self, *laws: Array) -> None:
        self.out.zeros += laws

    def store(self, coenergy: Callable[..., Any], kept: list[tuple[Array, Array, Array]]) -> Array:
        """Ports that keep: (kept, dual, rest) of each, with W' of all kept and x; the force of x."""
        directions = len(kept) + 1
        moving = bool(self.part.ports[-1].edge.endswith(".mechanical"))
        place = self.x if moving and self.displaced else np.zeros_like(kept[0][0])
        seeds = []
        for k, value in enumerate((*(x[0] for x in kept), place)):
            slopes = np.zeros((directions, 1))
            slopes[k] = 1
            seeds.append(Dual(value[None, :], slopes))
        work = dual(coenergy(*seeds))
        slopes = np.broadcast_to(work.b, (directions, len(place)))
        stored = -work.a[0]
        for (value, other, rest), charge in zip(kept, slopes, strict=False):
            self.out.charges.append((other, rest, charge))
            stored = stored + value * charge
        self.out.energy = self.out.energy + stored
        return slopes[-1]

    @property
    def displaced(self) -> bool:
        return self.part.kind in DISPLACED

    def energy(self, stored: Callable[..., Any], *given: Array) -> Array:
        """The slopes of an energy along what it is given of."""
        seeds = []
        for k, value in enumerate(given):
            slopes = np.zeros((len(given), 1))
            slopes[k] = 1
            seeds.append(Dual(value[None, :], slopes))
        work = dual(stored(*seeds))
        self.out.energy = self.out.energy + work.a[0]
        return np.broadcast_to(work.b, (len(given), len(given[0])))


DISPLACED = (
    *("solenoid", "reluctance_machine", "variable_capacitor", "piezo", "synchronous_machine"),
)
OWN = {"solenoid": "psi", "reluctance_machine": "psi", "variable_capacitor": "q"}


# ---- laws, kind by kind


def _ohm(key: str) -> Callable[[At], None]:
    def law(at: At) -> None:
        at.zero(at.X[0] - at(key) * at.Y[0])
        at.out.heat = at.X[0] * at.Y[0]

    return law


def _siemens(*keys: str, lost: bool = True) -> Callable[[At], None]:
    def law(at: At) -> None:
        flow = at.X[0]
        for key in keys:
            flow = flow * at(key, 1)
        at.zero(at.Y[0] - flow)
        at.out.heat = at.X[0] * at.Y[0] if lost else 0.0

    return law


def _curve(flow: Callable[[At, Array], Array]) -> Callable[[At], None]:
    def law(at: At) -> None:
        at.zero(at.Y[0] - flow(at, at.X[0]))
        at.out.heat = at.X[0] * at.Y[0]

    return law


def _friction(at: At, x: Array) -> Array:
    return at("viscous", 0) * x + at("coulomb", 0) * np.tanh(x / at("width"))


def _orifice(at: At, x: Array) -> Array:
    opening = at("opening", 1)
    opening = np.where(np.real(opening) > 0, opening, 0)
    return at("coefficient") * opening * x / (x * x + at("width") ** 2) ** 0.25


def _element(at: At) -> None:
    right = str(at.part.options["law"]).partition("=")[2].strip()
    at.zero(at.Y[0] - at.value(right, x=at.X[0], y=at.Y[0]))
    at.out.heat = at.X[0] * at.Y[0]


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)
HALVES = ((_NODES + 1) / 2, _WEIGHTS / 2)
"""Places and weights of Gauss and Legendre's integral from 0 to 1."""


def _kept_across(constant: Callable[[At], Any], charge: str = "") -> Callable[[At], None]:
    return lambda at: _kept(at, at.X[0], at.Y[0], "x", constant, charge)


def _kept_through(constant: Callable[[At], Any], charge: str = "") -> Callable[[At], None]:
    return lambda at: _kept(at, at.Y[0], at.X[0], "y", constant, charge)


def _kept(
    at: At, kept: Array, other: Array, name: str, constant: Callable[[At], Any], charge: str
) -> None:
    if charge and at.has(charge):
        held = at(charge, **{name: kept})
        at.out.charges.append((other, 0.0, held))
        # W = k Q - the integral of Q from 0 to k
        coenergy = sum(w * at(charge, **{name: kept * x}) for x, w in zip(*HALVES, strict=True))
        at.out.energy = at.out.energy + kept * (held - coenergy)
    elif at.has("coenergy"):
        at.store(lambda k, _: at("coenergy", **{name: k}), [(kept, other, 0.0)])
    else:
        at.store(lambda k, _: k * k * (constant(at) / 2), [(kept, other, 0.0)])


def _spring(at: At) -> None:
    if at.has("stiffness"):
        at.store(lambda k, _: k * k / (2 * at("stiffness")), [(at.Y[0], at.X[0], 0.0)])
        return
    (force,) = at.energy(lambda x: at("energy", x=x), at.own("x"))
    at.zero(at.Y[0] - force)
    at.out.rates[("s", f"{at.part.name}.x")] = at.X[0]


def _coupled(at: At) -> None:
    matrix, n = at.part.options["inductance"], len(at.X)

    def work(*given: Any) -> Any:
        products = (
            given[i] * given[j] * (at.value(matrix[i][j]) / 2) for i in range(n) for j in range(n)
        )
        return sum(products)

    at.store(work, [(y, x, 0.0) for x, y in zip(at.X, at.Y, strict=True)])


def _source(variable: str, key: str) -> Callable[[At], None]:
    return lambda at: at.zero(getattr(at, variable)[0] - at(key))


def _losses(at: At) -> None:
    at.zero(at.Y[0] - sum(at.taken[name] for name in at.part.options["of"]))


def _radiation(at: At) -> None:
    hot, cold = (at.values[("phi", f"thermal.{v}")] for v in at.part.options["between"])
    at.zero(at.Y[0] - at("coefficient") * (hot**4 - cold**4))


def _ratio(n: Callable[[At], Any]) -> Callable[[At], None]:
    """X1 = n X2, and no power is lost."""
    return lambda at: at.zero(at.X[0] - n(at) * at.X[1], n(at) * at.Y[0] + at.Y[1])


def _turned(n: Callable[[At], Any]) -> Callable[[At], None]:
    """X1 = n Y2, X2 = -n Y1."""
    return lambda at: at.zero(at.X[0] - n(at) * at.Y[1], at.X[1] + n(at) * at.Y[0])


def _displaced(at: At) -> None:
    """The displacement of a shaft is a state."""
    if at.part.ports[-1].between is not None:
        at.out.rates[("s", f"{at.part.name}.displacement")] = at.X[-1]


def _motor(at: At) -> None:
    n = at("ratio", 1)
    k, drag, w = at("constant") * n, at("damping", 0.0) * n * n, at.X[1]
    voltage = at("resistance", 0.0) * at.Y[0] + k * w
    torque = drag * w - k * at.Y[0]
    if at.has("inductance"):
        at.store(lambda i, _: i * i * (at("inductance") / 2), [(at.Y[0], at.X[0], voltage)])
    else:
        at.zero(at.X[0] - voltage)
    if at.has("inertia"):
        at.store(lambda w, _: w * w * (n * n * at("inertia") / 2), [(w, at.Y[1], torque)])
    else:
        at.zero(at.Y[1] - torque)
    at.out.heat = at("resistance", 0.0) * at.Y[0] ** 2 + drag * w * w


def _solenoid(at: At) -> None:
    _displaced(at)
    drop = at("resistance", 0.0) * at.Y[0]
    if at.has("energy"):
        psi = at.own("psi")
        current, force = at.energy(lambda psi, x: at("energy", psi=psi, x=x), psi, at.x)
        at.zero(at.Y[0] - current, at.Y[1] - force)
        at.out.rates[("s", f"{at.part.name}.psi")] = at.X[0] - drop
    else:

        def work(i: Any, x: Any) -> Any:
            given = {"i": i, "x": x}
            return (
                at("coenergy", **given) if at.has("coenergy") else at("inductance", x=x) * i * i / 2
            )

        at.zero(at.Y[1] + at.store(work, [(at.Y[0], at.X[0], drop)]))
    at.out.heat = drop * at.Y[0]


def _plate(at: At) -> None:
    _displaced(at)
    if at.has("energy"):
        voltage, force = at.energy(lambda q, x: at("energy", q=q, x=x), at.own("q"), at.x)
        at.zero(at.X[0] - voltage, at.Y[1] - force)
        at.out.rates[("s", f"{at.part.name}.q")] = at.Y[0]
    else:

        def work(v: Any, x: Any) -> Any:
            given = {"v": v, "x": x}
            return (
                at("coenergy", **given)
                if at.has("coenergy")
                else at("capacitance", x=x) * v * v / 2
            )

        at.zero(at.Y[1] + at.store(work, [(at.X[0], at.Y[0], 0.0)]))


def _piezo(at: At) -> None:
    _displaced(at)

    def work(v: Any, x: Any) -> Any:
        return (
            v * v * (at("capacitance") / 2) + v * x * at("coupling") - x * x * (at("stiffness") / 2)
        )

    at.zero(at.Y[1] + at.store(work, [(at.X[0], at.Y[0], 0.0)]))


def _machine(at: At) -> None:
    _displaced(at)
    matrix, flux, R = (
        at.part.options["inductance"],
        at.part.options.get("flux"),
        at("resistance", 0),
    )

    def work(*given: Any) -> Any:
        *i, x = given
        total: Any = 0.0
        for j, row in enumerate(matrix):
            for k, entry in enumerate(row):
                total = total + i[j] * i[k] * at.value(entry, x=x) / 2
            if flux is not None:
                total = total + i[j] * at.value(flux[j], x=x)
        return total

    kept = [(y, x, R * y) for x, y in zip(at.X[:-1], at.Y[:-1], strict=True)]
    at.zero(at.Y[-1] + at.store(work, kept))
    at.out.heat = R * sum(y * y for y in at.Y[:-1])


def _coil(at: At) -> None:
    k, drop = at("constant"), at("resistance", 0.0) * at.Y[0]
    voltage = drop + k * at.X[1]
    if at.has("inductance"):
        at.store(lambda i, _: i * i * (at("inductance") / 2), [(at.Y[0], at.X[0], voltage)])
    else:
        at.zero(at.X[0] - voltage)
    at.zero(at.Y[1] + k * at.Y[0])
    at.out.heat = drop * at.Y[0]


def _pump(at: At) -> None:
    d, leak = at("displacement"), at("leakage", 0.0)
    at.zero(at.Y[0] - d * at.X[1] - leak * at.X[0], at.Y[1] + d * at.X[0])
    at.out.heat = leak * at.X[0] ** 2


def _law(at: At) -> None:
    at.zero(at.Y[0] - at("force", x=at.values[("x", at.part.name)], v=at.X[0]))


LAWS: dict[str, Callable[[At], None]] = {
    "resistor": _ohm("resistance"),
    "pipe": _ohm("resistance"),
    "conductance": _siemens("conductance"),
    "conduction": _siemens("conductance", lost=False),
    "convection": _siemens("coefficient", "area", lost=False),
    "rotational_damper": _siemens("damping"),
    "translational_damper": _siemens("damping"),
    "rotational_friction": _curve(_friction),
    "orifice": _curve(_orifice),
    "valve": _curve(_orifice),
    "diode": _curve(lambda at, x: at("saturation") * (np.exp(x / at("voltage")) - 1)),
    "element": _element,
    "radiation": _radiation,
    "capacitor": _kept_across(lambda at: at("capacitance"), "charge"),
    "inductor": _kept_through(lambda at: at("inductance"), "flux"),
    "accumulator": _kept_across(lambda at: at("capacity"), "volume"),
    "tank": _kept_across(lambda at: at("area") / (at("density") * at("gravity"))),
    "inertance": _kept_through(lambda at: at("inertance")),
    "inertia": _kept_across(lambda at: at("inertia")),
    "mass": _kept_across(lambda at: at("mass")),
    "heat_capacity": _kept_across(lambda at: at("capacity")),
    "reluctance": _kept_across(lambda at: 1 / at("reluctance")),
    "rotational_spring": _spring,
    "translational_spring": _spring,
    "coupled_inductors": _coupled,
    "voltage_source": _source("X", "voltage"),
    "current_source": _source("Y", "current"),
    "pressure_source": _source("X", "pressure"),
    "flow_source": _source("Y", "flow"),
    "torque_source": _source("Y", "torque"),
    "force_source": _source("Y", "force"),
    "angular_velocity_source": _source("X", "velocity"),
    "temperature_source": _source("X", "temperature"),
    "losses": _losses,
    "transformer": _ratio(lambda at: at("ratio")),
    "gear": _ratio(lambda at: at("ratio")),
    "lever": _ratio(lambda at: at("ratio")),
    "belt": _ratio(lambda at: at("radius2") / at("radius1")),
    "rack": _ratio(lambda at: 1 / at("radius")),
    "screw": _ratio(lambda at: 2 * np.pi / at("lead")),
    "gyrator": _turned(lambda at: at("ratio")),
    "winding": _turned(lambda at: at("turns")),
    "opamp": lambda at: at.zero(at.X[0], at.Y[0]),
    "dc_motor": _motor,
    "solenoid": _solenoid,
    "reluctance_machine": _solenoid,
    "variable_capacitor": _plate,
    "piezo": _piezo,
    "synchronous_machine": _machine,
    "moving_coil": _coil,
    "cylinder": lambda at: at.zero(at.Y[0] - at("area") * at.X[1], at.Y[1] + at("area") * at.X[0]),
    "pump": _pump,
    "hydraulic_motor": _pump,
    "rotational_interface": lambda at: at.zero(at.X[0] - at.X[1], at.Y[0] + at.Y[1]),
    "translational_interface": lambda at: at.zero(at.X[0] - at.X[1], at.Y[0] + at.Y[1]),
    "law": _law,
}


# ---- mechanics


@dataclass(frozen=True)
class Moving:
    """How a port moves: displacement, rate, its row over the free velocities, acceleration at v̇ = 0."""

    x: float
    w: float
    row: Array
    bias: float


@dataclass(frozen=True)
class Instant:
    """A state of the mechanism with the time and the inputs, and the bare equations of motion there.

    Attributes:
        q, v, a: of the whole tree; a of what is prescribed alone.
        mass, right: M, and Q - h, without networks.
    """

    q: Array
    v: Array
    a: Array
    t: float
    u: Mapping[str, float]
    mass: Array
    right: Array


def in_joint(system: System, at: Instant, joint: str) -> Moving:
    """The motion of a joint's coordinate."""
    coupling = next((c for c in system.tree.couplings if c.joint == joint), None)
    master = joint if coupling is None else coupling.master
    ratio, offset = (1.0, 0.0) if coupling is None else (coupling.ratio, coupling.offset)
    k = system.tree.velocity_slices[master].start
    row = ratio * np.eye(system.tree.nv)[k][system.places()]
    return Moving(ratio * at.q[k] + offset, ratio * at.v[k], row, ratio * at.a[k])


def stretching(system: System, at: Instant, motions: Any, port: Port) -> Moving:
    """The distance of two points."""
    assert port.points is not None
    a, b = (point(system, motions, at.v, end) for end in port.points)
    line, linear = b.origin - a.origin, b.linear - a.linear
    x = float(np.linalg.norm(line))
    along, apart = line / x, linear @ at.v
    w = float(along @ apart)
    row = along @ linear
    bias = along @ (b.linear_bias - a.linear_bias) + (apart @ apart - w * w) / x
    return Moving(x, w, row[system.places()], float(bias + row @ at.a))


# ---- the tableau


@dataclass
class Solved:
    """What the tableau says.

    Attributes:
        values: of every variable: ("X", edge), ("Y", edge).
        rates: of the same, and of own states.
        acceleration: v̇.
        energy: that networks store.
    """

    values: dict[Key, float]
    rates: dict[Key, float]
    acceleration: Array
    energy: float


class Tableau:
    """A system's equations."""

    def __init__(self, system: System) -> None:
        """Number all variables."""
        self.system = system
        ports = [port for part in system.parts for port in part.ports]
        self.edges = [port for port in ports if port.between is not None]
        self.spatial = [port for port in ports if port.between is None]
        vertices = dict.fromkeys(
            f"{p.domain}.{v}" for p in self.edges for v in p.between or () if v != GROUND
        )
        self.keys: list[Key] = [("phi", v) for v in vertices]
        self.keys += [("X", p.edge) for p in self.edges] + [("Y", p.edge) for p in self.edges]
        self.keys += [("Y", p.edge) for p in self.spatial]
        self.count = len(self.keys)
        self.keys += [("X", p.edge) for p in self.spatial] + [("x", p.edge) for p in self.spatial]
        self.joints = [joint.name for joint in system.tree.joints]
        self.keys += [("name", j) for j in self.joints] + [("der", j) for j in self.joints]
        self.keys += [("name", "t"), *(("name", u) for u in system.inputs)]
        self.keys += self._own_states()
        self.place = {key: k for k, key in enumerate(self.keys)}
        self.potentials = len(vertices)
        self.expand = self._expand()
        self.kirchhoff = self._kirchhoff()

    def _own_states(self) -> list[Key]:
        found = []
        for part in self.system.parts:
            given = part.options
            if "energy" in given:
                found.append(("s", f"{part.name}.{OWN.get(part.kind, 'x')}"))
            if "shaft" in given and part.kind in DISPLACED:
                found.append(("s", f"{part.name}.displacement"))
        return found

    def _expand(self) -> Array:
        """All unknowns from potentials and through variables: across variables are differences."""
        edges, first = len(self.edges), self.potentials
        found = np.zeros((self.count, self.count - edges))
        found[:first, :first] = np.eye(first)
        found[first + edges :, first:] = np.eye(self.count - edges - first)
        for k, port in enumerate(self.edges):
            for vertex, sign in zip(port.between or (), (1, -1), strict=True):
                if vertex != GROUND:
                    found[first + k, self.place[("phi", f"{port.domain}.{vertex}")]] += sign
        return found

    def _kirchhoff(self) -> Array:
        """What flows out of every vertex."""
        edges, first = len(self.edges), self.potentials
        rows = np.zeros((first, self.count))
        rows[:, first + edges : first + 2 * edges] = self.expand[first : first + edges, :first].T
        return rows

    def solve(
        self, at: Instant, states: Mapping[Key, float], start: Mapping[Key, float] | None = None
    ) -> Solved:
        """All variables at a state."""
        moving = self._moving(at)
        b = self._known(at, moving)
        if start:
            b[: self.count] = self._from(start)
        given = {self.place[key]: x for key, x in states.items()}
        for k, x in given.items():
            if k >= self.count:
                b[k] = x
        last = np.inf
        for _ in range(MOST_STEPS):
            laws = self._evaluated(b)
            matrix, right = self._linear(at, moving, laws, b, given)
            found = lstsq(matrix, right, lapack_driver="gelsy", cond=1e-13)[0]
            size = len(self.expand.T)
            delta = self.expand @ found[:size]
            b[: self.count] += delta
            change = np.max(np.abs(delta), initial=0.0) / (1 + np.max(np.abs(b)))
            if change <= ENOUGH or (change < SMALL and change > last / 2):
                break
            last = change
        found = np.concatenate((b[:0], self.expand @ found[size : 2 * size], found[2 * size :]))
        rates = dict(zip(self.keys[: self.count], found[: self.count], strict=True))
        for key, x in laws.rates.items():
            rates[key] = float(np.real(x[-1]))
        return Solved(
            dict(zip(self.keys, b, strict=True)),
            rates,
            found[self.count :],
            laws.energy,
        )

    def _from(self, start: Mapping[Key, float]) -> Array:
        """Unknowns near given across and through variables."""
        found = np.zeros(self.count)
        for key, x in start.items():
            found[self.place[key]] = x
        first, edges = self.potentials, len(self.edges)
        incidence = self.expand[first : first + edges, :first]
        found[:first] = np.linalg.lstsq(incidence, found[first : first + edges], rcond=None)[0]
        found[first : first + edges] = incidence @ found[:first]
        return found

    def _moving(self, at: Instant) -> dict[str, Moving]:
        found = {}
        motions = None
        for port in self.spatial:
            if port.joint is not None:
                found[port.edge] = in_joint(self.system, at, port.joint)
                continue
            if motions is None:
                motions = oracle.body_motions(self.system.tree, at.q, at.v)
            found[port.edge] = stretching(self.system, at, motions, port)
        for joint in self.joints:
            found[joint] = in_joint(self.system, at, joint)
        return found

    def _known(self, at: Instant, moving: Mapping[str, Moving]) -> Array:
        """Everything that is no unknown, own states apart."""
        b = np.zeros(len(self.keys))
        for port in self.spatial:
            b[self.place[("X", port.edge)]] = moving[port.edge].w
            b[self.place[("x", port.edge)]] = moving[port.edge].x
        for joint in self.joints:
            b[self.place[("name", joint)]] = moving[joint].x
            b[self.place[("der", joint)]] = moving[joint].w
        b[self.place[("name", "t")]] = at.t
        for name in self.system.inputs:
            b[self.place[("name", name)]] = at.u[name]
        return b

    def _evaluated(self, b: Array) -> _Laws:
        """All laws with steps along every variable; the last column has none."""
        stepped = b[:, None] + np.hstack([1j * STEP * np.eye(len(b)), np.zeros((len(b), 1))])
        values: dict[Key, Array] = dict(zip(self.keys, stepped, strict=True))
        nothing = np.zeros(len(b) + 1, dtype=complex)
        for domain in {port.domain for port in self.edges}:
            values[("phi", f"{domain}.{GROUND}")] = nothing
        for name, x in self.system.parameters.items():
            values[("name", name)] = np.full(len(b) + 1, x, dtype=complex)
        laws = _Laws(len(b) + 1)
        taken = self._elements(values)
        parts = [p for p in self.system.parts if p.kind != "losses"]
        parts += [p for p in self.system.parts if p.kind == "losses"]
        for part in parts:
            given = At(part, values, taken)
            LAWS[part.kind](given)
            laws.add(part, given.out)
            taken[part.name] = given.out.heat
        return laws

    def _elements(self, values: Mapping[Key, Array]) -> dict[str, Array]:
        """What dampers and friction of the mechanism take."""
        found = {}
        for kind, name, given in self.system.forces:
            if kind == "damper":
                w = values[("der", given["joint"])]
                found[name] = given["damping"] * w * w
            elif kind == "friction":
                w = values[("der", given["joint"])]
                dry = given["coulomb"] * np.tanh(w / given["width"])
                found[name] = (given["viscous"] * w + dry) * w
        return found

    def _linear(
        self,
        at: Instant,
        moving: Mapping[str, Moving],
        laws: _Laws,
        b: Array,
        given: Mapping[int, float],
    ) -> tuple[Array, Array]:
        """The linear equations of one step: unknowns δy, ẏ and v̇."""
        n, count = len(at.mass), self.count
        zeros, G = laws.zeros, laws.slopes
        # ḃ = known + own δy + (rates of unknowns) + W v̇
        known, W = np.zeros(len(b)), np.zeros((len(b), n))
        for port in self.spatial:
            k = self.place[("X", port.edge)]
            known[k], W[k] = moving[port.edge].bias, moving[port.edge].row
            known[self.place[("x", port.edge)]] = moving[port.edge].w
        for joint in self.joints:
            k = self.place[("der", joint)]
            known[k], W[k] = moving[joint].bias, moving[joint].row
            known[self.place[("name", joint)]] = moving[joint].w
        known[self.place[("name", "t")]] = 1
        for name in self.system.inputs:
            known[self.place[("name", name)]] = at.u[f"{name}_rate"]
        own = np.zeros((len(b), count))
        for key, x in laws.rates.items():
            known[self.place[key]] = np.real(x[-1])
            own[self.place[key]] = np.imag(x[:count]) / STEP
        rest, rest_slopes, C = laws.rest, laws.rest_slopes, laws.charge_slopes
        K = self.kirchhoff
        y = b[:count]
        kept = [k for k in given if k < count]
        picks = np.eye(count)[kept]
        wanted = np.array([given[k] for k in kept])
        ports = [self.place[("Y", p.edge)] for p in self.spatial]
        R = np.array([moving[p.edge].row for p in self.spatial]).reshape(len(ports), n)
        pushes = np.zeros((n, count))
        pushes[:, ports] = R.T
        blocks = [
            (K, None, 0, -K @ y),
            (None, K, 0, np.zeros(len(K))),
            (G[:, :count], None, 0, -zeros),
            (G @ own, G[:, :count], G @ W, -G @ known),
            (rest_slopes[:, :count] - C @ own, -C[:, :count], -C @ W, -rest + C @ known),
            (picks, None, 0, wanted - picks @ y),
            (pushes, None, at.mass, at.right - pushes @ y),
        ]
        rows = sum(len(block[3]) for block in blocks)
        size = len(self.expand.T)
        matrix, right = np.zeros((rows, 2 * size + n)), np.zeros(rows)
        first = 0
        for left, middle, last, side in blocks:
            here = slice(first, first + len(side))
            if left is not None:
                matrix[here, :size] = left @ self.expand
            if middle is not None:
                matrix[here, size : 2 * size] = middle @ self.expand
            matrix[here, 2 * size :] = last
            right[here] = side
            first += len(side)
        return matrix, right


class _Laws:
    """Laws gathered, as values and slopes."""

    def __init__(self, columns: int) -> None:
        self._columns = columns
        self._zeros: list[Array] = []
        self._rests: list[Array] = []
        self._charges: list[Array] = []
        self.rates: dict[Key, Array] = {}
        self.energy = 0.0

    def add(self, part: Part, found: Equations) -> None:
        self._zeros += found.zeros
        self._rests += [other - rest for other, rest, _ in found.charges]
        self._charges += [charge for _, _, charge in found.charges]
        self.rates |= found.rates
        thermal = any(port.domain == "thermal" for port in part.ports)
        if found.energy is not None and not thermal:
            stored = np.broadcast_to(found.energy, (self._columns,))
            self.energy += float(np.real(stored[-1]))

    def _stacked(self, rows: list[Array]) -> Array:
        full = [np.broadcast_to(row, (self._columns,)) for row in rows]
        return np.array(full, dtype=complex).reshape(len(rows), self._columns)

    @property
    def zeros(self) -> Array:
        return np.real(self._stacked(self._zeros)[:, -1])

    @property
    def slopes(self) -> Array:
        return np.imag(self._stacked(self._zeros)[:, :-1]) / STEP

    @property
    def rest(self) -> Array:
        return np.real(self._stacked(self._rests)[:, -1])

    @property
    def rest_slopes(self) -> Array:
        return np.imag(self._stacked(self._rests)[:, :-1]) / STEP

    @property
    def charge_slopes(self) -> Array:
        return np.imag(self._stacked(self._charges)[:, :-1]) / STEP

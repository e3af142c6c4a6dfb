"""Systems that people derive by hand: each as a model, as a book prints it, and by Lagrange.

A book's form is ``M v̇ + h = Q`` with everything that no input drives in h. It is written as printed, in
sympy's own arithmetic. Lagrange's equations follow from positions and orientations of the bodies alone,
differentiated by sympy, and know nothing of linegraph: they prove the book's form, which then is the
measure of what linegraph finds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy
from sympy import Rational, cos, sin
from sympy.physics.mechanics import dynamicsymbols

import linegraph as lg

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

Expr = Any
HALF = Rational(1, 2)
TIME = dynamicsymbols._t
UP = sympy.Matrix([0, 0, 1])


def symbols(names: str) -> tuple[Expr, ...]:
    """Symbols without assumptions, as linegraph makes them."""
    return tuple(sympy.Symbol(name) for name in names.split())


# ---- Lagrange, knowing nothing of graphs


@dataclass(frozen=True)
class Mass:
    """A rigid body: mass, place of the mass centre, orientation, and inertia in its own axes."""

    mass: Expr
    at: Expr
    rotation: Expr = None
    inertia: tuple[Expr, Expr, Expr] = (0, 0, 0)

    @property
    def kinetic(self) -> Expr:
        """Of translation and of rotation; the angular velocity is that of Rᵀ dR/dt."""
        speed = sympy.Matrix(self.at).diff(TIME)
        total = HALF * self.mass * speed.dot(speed)
        if self.rotation is not None:
            spin = self.rotation.T * self.rotation.diff(TIME)
            w = (spin[2, 1], spin[0, 2], spin[1, 0])
            total += HALF * sum(j * x**2 for j, x in zip(self.inertia, w, strict=True))
        return total


@dataclass(frozen=True)
class Lagrange:
    """M and h from a Lagrangian.

    Attributes:
        q: functions of time, whose names are those of the coordinates.
        lagrangian: of q and their rates.
        forces: along q, those that no input drives.
        rates: names of the rates that are not called after their coordinate.
        given: names of derivatives of given functions of time.
    """

    q: Sequence[Expr]
    lagrangian: Expr
    forces: Sequence[Expr] = ()
    rates: Mapping[str, str] | None = None
    given: Mapping[Expr, Expr] | None = None

    def equations(self) -> tuple[Expr, Expr]:
        """M and h in plain symbols."""
        speeds = [x.diff(TIME) for x in self.q]
        rows = [
            self.lagrangian.diff(v).diff(TIME) - self.lagrangian.diff(x)
            for x, v in zip(self.q, speeds, strict=True)
        ]
        rows = [
            row - force for row, force in zip(rows, self.forces or [0] * len(rows), strict=True)
        ]
        return self._split(sympy.Matrix([row.doit() for row in rows]), speeds)

    def _split(self, rows: Expr, speeds: Sequence[Expr]) -> tuple[Expr, Expr]:
        rates = [v.diff(TIME) for v in speeds]
        known = {}
        for x, v in zip(self.q, speeds, strict=True):
            name = str(x.func)
            known |= {
                v: sympy.Symbol((self.rates or {}).get(name, f"{name}_dot")),
                x: sympy.Symbol(name),
            }
        # higher derivatives first: those of lower order stand within them
        steps = [dict(self.given or {}), {v: s for v, s in known.items() if v.is_Derivative}, known]
        marks = {rate: sympy.Dummy() for rate in rates}
        rows = rows.xreplace(marks)
        for step in steps:
            rows = rows.xreplace(step)
        M = rows.jacobian(list(marks.values()))
        return M, rows.subs(dict.fromkeys(marks.values(), 0))


def turned(axis: str, angle: Expr) -> Expr:
    """The rotation about an axis."""
    k = "xyz".index(axis)
    i, j = (k + 1) % 3, (k + 2) % 3
    R = sympy.eye(3)
    R[i, i] = R[j, j] = cos(angle)
    R[i, j], R[j, i] = -sin(angle), sin(angle)
    return R


# ---- the systems


@dataclass(frozen=True)
class Book:
    """A system.

    Attributes:
        name: of the system.
        model: builds it.
        M, h, Q: as printed.
        proof: M and h by another route.
        q, v: names of the coordinates and of the velocities.
        planar: whether all turns are about one direction, so that no product of turns is left.
        angles: what sines and cosines may be taken of.
        squares: what squares of symbols stand for.
    """

    name: str
    model: Callable[[], lg.Model]
    M: Expr
    h: Expr
    proof: Callable[[], tuple[Expr, Expr]]
    q: str
    v: str
    Q: Expr = None
    planar: bool = True
    angles: tuple[Expr, ...] = ()
    squares: Mapping[Expr, Expr] | None = None

    @property
    def forces(self) -> Expr:
        """Q, or zeros."""
        return sympy.zeros(len(self.h), 1) if self.Q is None else self.Q


def started(name: str, parameters: str) -> tuple[lg.Model, Mapping[str, Any]]:
    """A model with parameters without values, g downward."""
    model = lg.Model(name)
    found = {p: model.parameter(p) for p in parameters.split()}
    if "g" in found:
        model.gravity = (0, 0, -found["g"])
    return model, found


def moving_pendulum(motion: str = "input") -> lg.Model:
    """A pendulum that swings towards x on slides along x and z in given motion."""
    names = "I m l g" + (" A B w" if motion != "input" else "")
    model, p = started("moving_pendulum", names)
    moves = ("input", "input") if motion == "input" else ("A*sin(w*t)", "B*cos(w*t)")
    along, upward = model.body("along"), model.body("upward")
    bob = model.body("bob", mass=p["m"], mass_center=(0, 0, -p["l"]), inertia={"yy": p["I"]})
    model.prismatic("X", between=("ground", along), axis=(1, 0, 0), motion=moves[0])
    model.prismatic("Y", between=(along, upward), axis=(0, 0, 1), motion=moves[1])
    model.revolute("th", between=(upward, bob), axis=(0, -1, 0), effort=False)
    return model


def basement_pendulum() -> lg.Model:
    """The same on a basement."""
    model, p = started("basement_pendulum", "I m l g")
    bob = model.body("bob", mass=p["m"], mass_center=(0, 0, -p["l"]), inertia={"yy": p["I"]})
    model.basement(("input", 0, "input"))
    model.revolute("th", between=("basement", bob), axis=(0, -1, 0), effort=False)
    return model


def _moving_pendulum(name: str, model: Callable[[], lg.Model], ddX: Expr, ddY: Expr) -> Book:
    I, m, l, g, th = symbols("I m l g th")  # noqa: E741
    given = isinstance(ddX, sympy.Symbol)

    def proof() -> tuple[Expr, Expr]:
        q = dynamicsymbols("th")
        A, B, w = symbols("A B w")
        X, Y = dynamicsymbols("X Y") if given else (A * sin(w * TIME), B * cos(w * TIME))
        at = sympy.Matrix([X + l * sin(q), 0, Y - l * cos(q)])
        bob = Mass(m, at, turned("y", -q), (0, I, 0))
        named = {X.diff(TIME, 2): ddX, Y.diff(TIME, 2): ddY} if given else None
        return Lagrange([q], bob.kinetic - m * g * at.dot(UP), given=named).equations()

    return Book(
        name,
        model,
        sympy.Matrix([[I + m * l**2]]),
        sympy.Matrix([m * g * l * sin(th) + m * l * (cos(th) * ddX + sin(th) * ddY)]),
        proof,
        "th",
        "th_dot",
        planar=given,
        angles=(th,) if given else (th, sympy.Symbol("w") * sympy.Symbol("t")),
    )


def elastic_pendulum() -> lg.Model:
    """A particle on a spring, in polar coordinates from the hook, the angle from hanging."""
    model, p = started("elastic_pendulum", "m g k r0")
    arm, bob = model.body("arm"), model.body("bob", mass=p["m"])
    model.revolute("ph", between=("ground", arm), axis=(0, -1, 0), effort=False)
    model.prismatic("r", between=(arm, bob), axis=(0, 0, -1), effort=False)
    model.spring("coil", joint="r", stiffness=p["k"], length=p["r0"])
    return model


def compound_pendulum() -> lg.Model:
    """The same with one joint; its spring is a law of a load along the slide."""
    model, p = started("compound_pendulum", "m g k r0")
    bob = model.body("bob", mass=p["m"])
    parts = (("revolute", (0, -1, 0), {"name": "ph"}), ("prismatic", (0, 0, -1), {"name": "r"}))
    model.compound("c", between=("ground", bob), parts=parts, effort=False)
    model.load("coil", at=bob, force=(0, 0, "k*(c_r - r0)"), axes="body")
    return model


def _elastic_pendulum(name: str, model: Callable[[], lg.Model], ph: Expr, r: Expr) -> Book:
    m, g, k, r0 = symbols("m g k r0")
    dph, dr = (sympy.Symbol(f"{x}_dot") for x in (ph, r))

    def proof() -> tuple[Expr, Expr]:
        angle, length = dynamicsymbols(f"{ph} {r}")
        at = sympy.Matrix([length * sin(angle), 0, -length * cos(angle)])
        potential = m * g * at.dot(UP) + k * (length - r0) ** 2 / 2
        return Lagrange([angle, length], Mass(m, at).kinetic - potential).equations()

    return Book(
        name,
        model,
        # the first row is a torque: m r times what books print for the particle
        sympy.Matrix([[m * r**2, 0], [0, m]]),
        sympy.Matrix(
            [
                m * r * (2 * dr * dph + g * sin(ph)),
                -m * r * dph**2 - m * g * cos(ph) + k * (r - r0),
            ]
        ),
        proof,
        f"{ph} {r}",
        f"{dph} {dr}",
        angles=(ph,),
    )


def double_pendulum(coordinates: str = "joint") -> lg.Model:
    """Two rods on hinges about y, each with its mass centre on its axis."""
    model, p = started("double_pendulum", "g m1 m2 l1 c1 c2 I1 I2")
    upper = model.body("b1", mass=p["m1"], mass_center=(0, 0, -p["c1"]), inertia={"yy": p["I1"]})
    lower = model.body("b2", mass=p["m2"], mass_center=(0, 0, -p["c2"]), inertia={"yy": p["I2"]})
    tip = upper.frame("tip", at=(0, 0, -p["l1"]))
    names = ("a", "b") if coordinates == "joint" else ("t1", "t2")
    model.revolute(names[0], between=("ground", upper), axis=(0, 1, 0), effort=False)
    model.revolute(names[1], between=(tip, lower), axis=(0, 1, 0), effort=False)
    model.formulation(coordinates=coordinates)
    return model


def _rods(first: Expr, second: Expr) -> tuple[Expr, Expr]:
    """Kinetic and potential energy of the two rods at absolute angles."""
    g, m1, m2, l1, c1, c2, I1, I2 = symbols("g m1 m2 l1 c1 c2 I1 I2")
    at1 = sympy.Matrix([-c1 * sin(first), 0, -c1 * cos(first)])
    at2 = sympy.Matrix(
        [-l1 * sin(first) - c2 * sin(second), 0, -l1 * cos(first) - c2 * cos(second)]
    )
    rods = (
        Mass(m1, at1, turned("y", first), (0, I1, 0)),
        Mass(m2, at2, turned("y", second), (0, I2, 0)),
    )
    return sum(rod.kinetic for rod in rods), g * (m1 * at1 + m2 * at2).dot(UP)


def _double_pendulum() -> Book:
    g, m1, m2, l1, c1, c2, I1, I2 = symbols("g m1 m2 l1 c1 c2 I1 I2")
    a, b, da, db = symbols("a b a_dot b_dot")
    h = m2 * l1 * c2 * sin(b)

    def proof() -> tuple[Expr, Expr]:
        q = dynamicsymbols("a b")
        kinetic, potential = _rods(q[0], q[0] + q[1])
        return Lagrange(q, kinetic - potential).equations()

    M12 = I2 + m2 * c2**2 + m2 * l1 * c2 * cos(b)
    return Book(
        "double pendulum, relative angles",
        double_pendulum,
        sympy.Matrix(
            [
                [I1 + I2 + m1 * c1**2 + m2 * (l1**2 + c2**2 + 2 * l1 * c2 * cos(b)), M12],
                [M12, I2 + m2 * c2**2],
            ]
        ),
        sympy.Matrix(
            [
                -h * (2 * da * db + db**2)
                + g * ((m1 * c1 + m2 * l1) * sin(a) + m2 * c2 * sin(a + b)),
                h * da**2 + g * m2 * c2 * sin(a + b),
            ]
        ),
        proof,
        "a b",
        "a_dot b_dot",
        angles=(a, b, a + b),
    )


def _absolute_pendulum() -> Book:
    g, m1, m2, l1, c1, c2, I1, I2 = symbols("g m1 m2 l1 c1 c2 I1 I2")
    t1, t2, d1, d2 = symbols("t1 t2 t1_dot t2_dot")

    def proof() -> tuple[Expr, Expr]:
        q = dynamicsymbols("t1 t2")
        kinetic, potential = _rods(*q)
        return Lagrange(q, kinetic - potential).equations()

    M12 = m2 * l1 * c2 * cos(t1 - t2)
    return Book(
        "double pendulum, absolute angles",
        lambda: double_pendulum("absolute-angle"),
        sympy.Matrix([[I1 + m1 * c1**2 + m2 * l1**2, M12], [M12, I2 + m2 * c2**2]]),
        sympy.Matrix(
            [
                m2 * l1 * c2 * sin(t1 - t2) * d2**2 + g * (m1 * c1 + m2 * l1) * sin(t1),
                -m2 * l1 * c2 * sin(t1 - t2) * d1**2 + g * m2 * c2 * sin(t2),
            ]
        ),
        proof,
        "t1 t2",
        "t1_dot t2_dot",
        angles=(t1, t2, t1 - t2),
    )


def cart_pole_motor() -> lg.Model:
    """A pole on a cart that a motor of direct current drives through a pinion; p = 0 hangs."""
    model, p = started("cart_pole_motor", "g M m l J J_m rho K R L")
    model.input("v", "V")
    cart = model.body("cart", mass=p["M"])
    pole = model.body("pole", mass=p["m"], mass_center=(0, 0, -p["l"]), inertia={"yy": p["J"]})
    model.prismatic("x", between=("ground", cart), axis=(1, 0, 0), effort=False)
    model.revolute("p", between=(cart, pole), axis=(0, -1, 0), effort=False)
    model.voltage_source("supply", ("plus", "ground"), voltage="v")
    constants = {"constant": "K", "resistance": "R", "inductance": "L", "inertia": "J_m"}
    model.dc_motor("motor", ("plus", "ground"), shaft=("shaft", "ground"), **constants)
    model.rack("pinion", ("shaft", "ground"), second=("rail", "ground"), radius="rho")
    model.translational_interface("mount", ("rail", "ground"), joint="x")
    return model


def _cart_pole_motor() -> Book:
    g, M, m, l, J, J_m, rho, K, R, L = symbols("g M m l J J_m rho K R L")  # noqa: E741
    p, dx, dp, i, v = symbols("p x_dot p_dot i_motor v")

    def proof() -> tuple[Expr, Expr]:
        slide, angle, charge = dynamicsymbols("x p charge")
        at = sympy.Matrix([slide + l * sin(angle), 0, -l * cos(angle)])
        pole = Mass(m, at, turned("y", -angle), (0, J, 0))
        cart, current = slide.diff(TIME), charge.diff(TIME)
        # the flux linkage of the armature with the field turns with the pinion
        magnetic = L * current**2 / 2 + K * current * slide / rho
        kinetic = M * cart**2 / 2 + J_m * (cart / rho) ** 2 / 2 + pole.kinetic
        lagrangian = kinetic + magnetic - m * g * at.dot(UP)
        names = {"charge": "i_motor"}
        forces = (0, 0, -R * current)
        return Lagrange((slide, angle, charge), lagrangian, forces, names).equations()

    return Book(
        "cart-pole with motor",
        cart_pole_motor,
        sympy.Matrix(
            [
                [M + m + J_m / rho**2, m * l * cos(p), 0],
                [m * l * cos(p), J + m * l**2, 0],
                [0, 0, L],
            ]
        ),
        sympy.Matrix(
            [-m * l * sin(p) * dp**2 - K * i / rho, m * g * l * sin(p), R * i + K * dx / rho]
        ),
        proof,
        "x p",
        "x_dot p_dot i_motor",
        Q=sympy.Matrix([0, 0, v]),
        angles=(p,),
    )


def furuta() -> lg.Model:
    """An arm about the vertical with a pendulum at its tip; al = 0 hangs."""
    model, p = started("furuta", "g m l L J0 J_a J_t")
    model.input("tau", "N*m")
    arm = model.body("arm", inertia={"zz": p["J0"]})
    inertia = (p["J_t"], p["J_t"], p["J_a"])
    pole = model.body("pole", mass=p["m"], mass_center=(0, 0, -p["l"]), inertia=inertia)
    tip = arm.frame("tip", at=(p["L"], 0, 0))
    model.revolute("th", between=("ground", arm), axis=(0, 0, 1), effort=False)
    model.revolute("al", between=(tip, pole), axis=(1, 0, 0), effort=False)
    model.load("motor", at=arm, torque=(0, 0, "tau"))
    return model


def _furuta() -> Book:
    g, m, l, L, J0, J_a, J_t = symbols("g m l L J0 J_a J_t")  # noqa: E741
    al, dth, dal, tau = symbols("al th_dot al_dot tau")

    def proof() -> tuple[Expr, Expr]:
        shaft, hinge = dynamicsymbols("th al")
        out = turned("z", shaft)
        pole = out * turned("x", hinge)
        at = out * sympy.Matrix([L, 0, 0]) + pole * sympy.Matrix([0, 0, -l])
        arm = Mass(0, sympy.zeros(3, 1), out, (0, 0, J0))
        kinetic = arm.kinetic + Mass(m, at, pole, (J_t, J_t, J_a)).kinetic
        return Lagrange((shaft, hinge), kinetic - m * g * at.dot(UP)).equations()

    M12 = m * L * l * cos(al)
    wide = J_t + m * l**2 - J_a
    return Book(
        "Furuta pendulum",
        furuta,
        sympy.Matrix(
            [
                [J0 + m * L**2 + (J_t + m * l**2) * sin(al) ** 2 + J_a * cos(al) ** 2, M12],
                [M12, J_t + m * l**2],
            ]
        ),
        sympy.Matrix(
            [
                wide * sin(2 * al) * dal * dth - m * L * l * sin(al) * dal**2,
                -HALF * wide * sin(2 * al) * dth**2 + m * g * l * sin(al),
            ]
        ),
        proof,
        "th al",
        "th_dot al_dot",
        Q=sympy.Matrix([tau, 0]),
        angles=(al, 2 * al),
    )


LAWS = {"a fraction": "L0 + L1/(1 + x/d)", "an exponential": "L0 + L1*exp(-x/d)"}
"""Inductances as functions of the gap x."""


def levitation(law: str, flux: bool = False) -> lg.Model:
    """A ball under a magnet; the gap z counts down."""
    model, p = started("levitation", "g m R L0 L1 d")
    model.input("v", "V")
    ball = model.body("ball", mass=p["m"])
    model.prismatic("z", between=("ground", ball), axis=(0, 0, -1), effort=False)
    model.voltage_source("supply", ("plus", "ground"), voltage="v")
    form = {"energy": f"psi**2/(2*({LAWS[law]}))"} if flux else {"inductance": LAWS[law]}
    model.solenoid("magnet", ("plus", "ground"), joint="z", resistance="R", **form)
    return model


def _inductance(law: str, z: Expr) -> tuple[Expr, Expr]:
    """L and its slope, as one would write them."""
    L0, L1, d = symbols("L0 L1 d")
    if law == "a fraction":
        return L0 + L1 / (1 + z / d), -L1 / (d * (1 + z / d) ** 2)
    return L0 + L1 * sympy.exp(-z / d), -L1 / d * sympy.exp(-z / d)


def _levitation(law: str) -> Book:
    g, m, R, z, dz, i, v = symbols("g m R z z_dot i_magnet v")
    L, slope = _inductance(law, z)

    def proof() -> tuple[Expr, Expr]:
        gap, charge = dynamicsymbols("z charge")
        current = charge.diff(TIME)
        kinetic = m * gap.diff(TIME) ** 2 / 2
        stored = L.subs(z, gap) * current**2 / 2
        lagrangian = kinetic + stored + m * g * gap
        names = {"charge": "i_magnet"}
        return Lagrange((gap, charge), lagrangian, (0, -R * current), names).equations()

    return Book(
        f"levitation, current, {law}",
        lambda: levitation(law),
        sympy.Matrix([[m, 0], [0, L]]),
        sympy.Matrix([-m * g - HALF * slope * i**2, R * i + slope * dz * i]),
        proof,
        "z",
        "z_dot i_magnet",
        Q=sympy.Matrix([0, v]),
    )


def _levitation_by_flux(law: str) -> Book:
    g, m, R, z, psi, v = symbols("g m R z psi_magnet v")
    L, slope = _inductance(law, z)

    def proof() -> tuple[Expr, Expr]:
        # Hamilton: p' = -dH/dz, psi' = v - R dH/dpsi, H = p**2/(2 m) - m g z + psi**2/(2 L)
        energy = -m * g * z + psi**2 / (2 * L)
        return sympy.diag(m, 1), sympy.Matrix([energy.diff(z), R * energy.diff(psi)])

    return Book(
        f"levitation, flux, {law}",
        lambda: levitation(law, flux=True),
        sympy.Matrix([[m, 0], [0, 1]]),
        sympy.Matrix([-m * g - HALF * psi**2 * slope / L**2, R * psi / L]),
        proof,
        "z",
        "z_dot psi_magnet",
        Q=sympy.Matrix([0, v]),
    )


def top(angles: str | None = "zxz") -> lg.Model:
    """The symmetric heavy top about a fixed point; its mass centre is l up its axis z."""
    model, p = started("top", "m g l A C")
    centre = (0, 0, p["l"])
    body = model.body("top", mass=p["m"], mass_center=centre, inertia=_about_centre(p))
    model.spherical("o", between=("ground", body), angles=angles, effort=False)
    return model


def _about_centre(p: Mapping[str, Any]) -> tuple[Any, Any, Any]:
    """A and C are about the fixed point, as in books."""
    across = p["A"] - p["m"] * p["l"] ** 2
    return across, across, p["C"]


def _top_by_angles() -> Book:
    m, g, l, A, C = symbols("m g l A C")  # noqa: E741
    th = sympy.Symbol("o_angle2")
    dph, dth, dps = symbols("o_angle1_dot o_angle2_dot o_angle3_dot")

    def proof() -> tuple[Expr, Expr]:
        q = dynamicsymbols("o_angle1 o_angle2 o_angle3")
        R = turned("z", q[0]) * turned("x", q[1]) * turned("z", q[2])
        whole = Mass(0, sympy.zeros(3, 1), R, (A, A, C))
        height = (R * sympy.Matrix([0, 0, l])).dot(UP)
        return Lagrange(q, whole.kinetic - m * g * height).equations()

    return Book(
        "heavy top, Euler angles",
        top,
        sympy.Matrix(
            [
                [A * sin(th) ** 2 + C * cos(th) ** 2, 0, C * cos(th)],
                [0, A, 0],
                [C * cos(th), 0, C],
            ]
        ),
        sympy.Matrix(
            [
                (A - C) * sin(2 * th) * dth * dph - C * sin(th) * dth * dps,
                -HALF * (A - C) * sin(2 * th) * dph**2
                + C * sin(th) * dph * dps
                - m * g * l * sin(th),
                -C * sin(th) * dth * dph,
            ]
        ),
        proof,
        "o_angle1 o_angle2 o_angle3",
        "o_angle1_dot o_angle2_dot o_angle3_dot",
        angles=(th, 2 * th),
    )


def _top_by_quaternion() -> Book:
    m, g, l, A, C = symbols("m g l A C")  # noqa: E741
    x, y, z, w = symbols("o_qx o_qy o_qz o_qw")
    wx, wy, wz = symbols("o_wx o_wy o_wz")

    def proof() -> tuple[Expr, Expr]:
        # Euler: I w' + w x I w = T, with T = r x R^T (0, 0, -m g)
        inertia, spin = sympy.diag(A, A, C), sympy.Matrix([wx, wy, wz])
        # the third row of the rotation: k seen from the top, by q* k q
        down = (
            -m * g * sympy.Matrix([2 * (x * z - w * y), 2 * (y * z + w * x), _squares(x, y, z, w)])
        )
        torque = sympy.Matrix([0, 0, l]).cross(down)
        return inertia, spin.cross(inertia * spin) - torque

    return Book(
        "heavy top, quaternion",
        lambda: top(None),
        sympy.diag(A, A, C),
        sympy.Matrix(
            [
                (C - A) * wy * wz - 2 * m * g * l * (y * z + w * x),
                (A - C) * wx * wz + 2 * m * g * l * (x * z - w * y),
                0,
            ]
        ),
        proof,
        "o_qx o_qy o_qz o_qw",
        "o_wx o_wy o_wz",
        squares={w: 1 - x**2 - y**2 - z**2},
    )


def _squares(x: Expr, y: Expr, z: Expr, w: Expr) -> Expr:
    return w**2 - x**2 - y**2 + z**2


def books() -> list[Book]:
    """All of them."""
    A, B, w, t = symbols("A B w t")
    inputs = [symbols(f"{x}_acceleration {y}_acceleration") for x, y in ("XY", BASEMENT)]
    given = (-A * w**2 * sin(w * t), -B * w**2 * cos(w * t))
    return [
        _moving_pendulum("moving pendulum, inputs", moving_pendulum, *inputs[0]),
        _moving_pendulum("moving pendulum, basement", basement_pendulum, *inputs[1]),
        _moving_pendulum("moving pendulum, given", lambda: moving_pendulum("time"), *given),
        _elastic_pendulum("elastic pendulum", elastic_pendulum, *symbols("ph r")),
        _elastic_pendulum("elastic pendulum, one joint", compound_pendulum, *symbols("c_ph c_r")),
        _double_pendulum(),
        _absolute_pendulum(),
        _cart_pole_motor(),
        _furuta(),
        *(make(law) for make in (_levitation, _levitation_by_flux) for law in LAWS),
        _top_by_angles(),
        _top_by_quaternion(),
    ]


BASEMENT = ("basement_x", "basement_z")

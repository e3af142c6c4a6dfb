"""Published figures and closed forms: Puma 560, RBDL's trees, the heavy top, and textbook mechanisms.

Numbers are copied from the sources named beside them, with the digits printed there. The closed forms were
derived by Lagrange's equations elsewhere and must agree symbolically: the difference simplifies to zero.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import sympy

from linegraph import Model, derive

PUBLISHED = 6e-5  # half a unit of the fourth decimal printed, and a little

# ---- Puma 560
# Corke & Armstrong-Helouvry 1994 data as coded in Robotics Toolbox for Python models/DH/Puma560,
# expected values from its tests/test_DHRobot.
# link i: Rz(q) Tz(d) Tx(a) Rx(alpha); r = mass centre in the link frame; I = xx, yy, zz about it

QUARTER = math.pi / 2
PUMA = (
    # d, a, alpha, mass, r, (xx, yy, zz), Jm, G, B, Tc for positive rates
    (0.67183, 0, QUARTER, 0, (0, 0, 0), (0, 0.35, 0), 200e-6, -62.6111, 1.48e-3, 0.395),
    (0, 0.4318, 0, 17.4, (-0.3638, 0.006, 0.2275), (0.13, 0.524, 0.539), 200e-6, 107.815, 0.817e-3,
     0.126),
    (0.15005, 0.0203, -QUARTER, 4.8, (-0.0203, -0.0141, 0.070), (0.066, 0.086, 0.0125), 200e-6,
     -53.7063, 1.38e-3, 0.132),
    (0.4318, 0, QUARTER, 0.82, (0, 0.019, 0), (1.8e-3, 1.3e-3, 1.8e-3), 33e-6, 76.0364, 71.2e-6,
     11.2e-3),
    (0, 0, -QUARTER, 0.34, (0, 0, 0), (0.3e-3, 0.4e-3, 0.3e-3), 33e-6, 71.923, 82.6e-6, 9.26e-3),
    (0, 0, 0, 0.09, (0, 0, 0.032), (0.15e-3, 0.15e-3, 0.04e-3), 33e-6, 76.686, 36.7e-6, 3.96e-3),
)  # fmt: skip
QN = [0.0, math.pi / 4, math.pi, 0.0, math.pi / 4, 0.0]
QD = [1.0, 2.0, 3.0, 1.0, 2.0, 3.0]
ROTORS = np.array([gear**2 * rotor for *_, rotor, gear, _, _ in PUMA])
FRICTION = np.array([gear**2 * viscous + abs(gear) * dry for *_, gear, viscous, dry in PUMA])


def puma() -> Any:
    """The arm as numbers; each body's own frame is its link's Denavit-Hartenberg frame."""
    model = Model("puma", gravity=(0, 0, -9.81))
    before: Any = "ground"
    for i, (d, a, alpha, mass, center, inertia, *_) in enumerate(PUMA, start=1):
        body = model.body(f"link{i}", mass=mass, mass_center=center, inertia=inertia)
        # the joint's head frame seen from the link frame: (Tz(d) Tx(a) Rx(alpha))^-1
        at = (-a, -d * math.sin(alpha), -d * math.cos(alpha))
        head = body.frame("joint", at=at, rpy=(-alpha, 0, 0))
        model.revolute(f"q{i}", between=(before, head))
        before = body
    return derive(model).numeric()


def test_puma_mass_matrix() -> None:
    expected = [
        [3.6594, -0.4044, 0.1006, -0.0025, 0, 0],
        [-0.4044, 4.4137, 0.3509, 0, 0.0024, 0],
        [0.1006, 0.3509, 0.9378, 0, 0.0015, 0],
        [-0.0025, 0, 0, 0.1925, 0, 0],
        [0, 0.0024, 0.0015, 0, 0.1713, 0],
        [0, 0, 0, 0, 0, 0.1941],
    ]
    found = np.array(puma().mass_matrix(QN)) + np.diag(ROTORS)
    np.testing.assert_allclose(found, expected, rtol=0, atol=PUBLISHED)


def test_puma_gravity() -> None:
    found = puma().bias(QN, [0.0] * 6)
    expected = [0, 31.6399, 6.0351, 0, 0.0283, 0]
    np.testing.assert_allclose(found, expected, rtol=0, atol=PUBLISHED)


def test_puma_inertial_torque() -> None:
    arm = puma()
    rotors = ROTORS * QD
    found = np.array(arm.mass_matrix(QN)) @ QD + rotors
    expected = [3.1500, 9.4805, 3.6189, 0.1901, 0.3519, 0.5823]
    np.testing.assert_allclose(found, expected, rtol=0, atol=PUBLISHED)
    rest = [0.0] * 6
    moved = np.subtract(arm.inverse_dynamics(QN, rest, QD), arm.bias(QN, rest)) + rotors
    np.testing.assert_allclose(moved, expected, rtol=0, atol=PUBLISHED)


def test_puma_inverse_dynamics_at_unit_acceleration() -> None:
    found = np.array(puma().inverse_dynamics(QN, [0.0] * 6, [1.0] * 6)) + ROTORS
    expected = [3.35311, 36.0025, 7.42596, 0.190043, 0.203441, 0.194133]
    np.testing.assert_allclose(found, expected, rtol=5e-6, atol=0)  # six figures printed


def test_puma_inverse_dynamics_at_unit_rates_with_friction() -> None:
    found = np.array(puma().bias(QN, [1.0] * 6)) + FRICTION
    expected = [29.1421, 56.5044, 16.3528, 1.26448, 1.12392, 0.519648]
    np.testing.assert_allclose(found, expected, rtol=5e-6, atol=0)  # six figures printed


def test_puma_coriolis() -> None:
    arm = puma()
    found = np.subtract(arm.bias(QN, QD), arm.bias(QN, [0.0] * 6))
    expected = [-4.6346, 8.7258, -1.9267, 0.0021, 0.0190, 0.0001]
    # the source prints a Coriolis matrix of rounded entries: each product adds half a unit
    np.testing.assert_allclose(found, expected, rtol=0, atol=5e-4)


# ---- RBDL
# RBDL tests/DynamicsTests (three_dof value computed there with Featherstone spatial_v1): masses 1, radii
# of gyration 1, gravity (0, -9.81, 0), at rest


@pytest.mark.parametrize(
    "expected",
    [[-5.886, 3.924], [-6.03692307692308, 3.77307692307692, 1.50923076923077]],
    ids=["double", "triple"],
)
def test_rbdl_forward_dynamics(expected: list[float]) -> None:
    model = Model("chain", gravity=(0, -9.81, 0))
    tip: Any = "ground"
    for i in range(len(expected)):
        body = model.body(f"b{i}", mass=1, mass_center=(1, 0, 0), inertia=(1, 1, 1))
        model.revolute(f"q{i}", between=(tip, body), axis=(0, 0, 1))
        tip = body.frame("tip", at=(1, 0, 0))
    numeric = derive(model).numeric()
    rest = [0.0] * len(expected)
    found = np.linalg.solve(numeric.mass_matrix(rest), -np.array(numeric.bias(rest, rest)))
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11)


# ---- the heavy top


def top(symbolic: bool) -> Model:
    """A top on its fixed point by three hinges: precession about z, tilt about x, spin about its axis.

    The two bodies between are massless. With `symbolic`, its axis is z and its transverse inertia A and
    axial inertia C are about the fixed point.
    """
    if symbolic:
        model = Model("top", gravity=(0, 0, 0))
        m, g, length, a, c = (model.parameter(name) for name in ("m", "g", "l", "A", "C"))
        model.gravity = (0, 0, -g)
        body = model.body("top", mass=m, first_moment=(0, 0, m * length), inertia=(a, a, c))
        spin = (0, 0, 1)
    else:
        # Geradin & Cardona; Exudyn TestModels/heavyTop and its verification data (MATLAB RK4)
        model = Model("top", gravity=(0, 0, -9.81))
        inertia = (0.234375, 0.46875, 0.234375)
        body = model.body("top", mass=15, mass_center=(0, 1, 0), inertia=inertia)
        spin = (0, 1, 0)
    post, cradle = model.body("post"), model.body("cradle")
    model.revolute("psi", between=("ground", post), axis=(0, 0, 1))
    model.revolute("theta", between=(post, cradle), axis=(1, 0, 0))
    model.revolute("phi", between=(cradle, body), axis=spin)
    return model


def test_heavy_top_in_closed_form() -> None:
    symbolic = derive(top(symbolic=True)).symbolic
    _, theta, _ = symbolic.q
    a, c, m, g, length = sympy.symbols("A C m g l")
    cosine, sine = sympy.cos(theta), sympy.sin(theta)
    expected = sympy.Matrix(
        [[a * sine**2 + c * cosine**2, 0, c * cosine], [0, a, 0], [c * cosine, 0, c]]
    )
    assert sympy.simplify(symbolic.mass_matrix - expected) == sympy.zeros(3)
    # tilt at constant precession W and total axial rate n: sin(theta) (C n W - A W^2 cos - m g l)
    precession, tilt, own = symbolic.v
    n = own + precession * cosine
    steady = sine * (c * n * precession - a * precession**2 * cosine - m * g * length)
    assert sympy.simplify(symbolic.bias[1].subs(tilt, 0) - steady) == 0
    assert sympy.simplify(symbolic.bias[0].subs(tilt, 0)) == 0
    assert sympy.simplify(symbolic.bias[2].subs(tilt, 0)) == 0


def test_heavy_top_precesses_steadily() -> None:
    """A W^2 cos(theta) - C n W + m g l = 0 holds, and then nothing accelerates."""
    numeric = derive(top(symbolic=False)).numeric()
    a, c, weight = 15 + 0.234375, 0.46875, 15 * 9.81
    n, tilt = 250.0, 0.4  # tilt from upright; the hinge's angle is from horizontal
    cosine = math.cos(tilt)
    w = (c * n - math.sqrt((c * n) ** 2 - 4 * a * cosine * weight)) / (2 * a * cosine)
    q, v = [0.3, math.pi / 2 - tilt, 0.7], [w, 0.0, n - w * cosine]
    found = np.linalg.solve(numeric.mass_matrix(q), -np.array(numeric.bias(q, v)))
    np.testing.assert_allclose(found, np.zeros(3), rtol=0, atol=1e-13)  # measured 1.2e-14


def quaternion(q: np.ndarray) -> np.ndarray:
    """(w, x, y, z) of Rz(psi) Rx(theta) Ry(phi)."""
    total = np.array([1.0, 0.0, 0.0, 0.0])
    for angle, axis in zip(q, ([0, 0, 1], [1, 0, 0], [0, 1, 0]), strict=True):
        w, u = total[0], total[1:]
        s, r = math.cos(angle / 2), math.sin(angle / 2) * np.array(axis)
        total = np.array([w * s - u @ r, *(w * r + s * u + np.cross(u, r))])
    return total


def test_heavy_top_moves_as_published() -> None:
    """Exudyn's verification data at 0.02 and 0.2 s, five decimals; here by Runge-Kutta, 1 ms a step."""
    numeric = derive(top(symbolic=False)).numeric()

    def rate(x: np.ndarray) -> np.ndarray:
        q, v = x[:3].tolist(), x[3:].tolist()
        a = np.linalg.solve(numeric.mass_matrix(q), -np.array(numeric.bias(q, v)))
        return np.concatenate([x[3:], a])

    x = np.array([0.0, 0.0, 0.0, -4.61538, 0.0, 150.0])
    expected = {
        20: [0.070614, 0.045708, 0.99644, -0.0063419],
        200: [-0.70828, 0.43878, 0.54573, 0.0894],
    }
    h = 1e-3
    for step in range(1, 201):
        k1 = rate(x)
        k2 = rate(x + h / 2 * k1)
        k3 = rate(x + h / 2 * k2)
        k4 = rate(x + h * k3)
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        if step in expected:
            found = quaternion(x[:3])
            sign = np.sign(found @ expected[step])
            np.testing.assert_allclose(sign * found, expected[step], rtol=0, atol=2e-5)


# ---- closed forms, theory.md section 5


def assert_same(symbolic: Any, mass: list[list[Any]], bias: list[Any]) -> None:
    for found, expected in zip(symbolic.mass_matrix, sympy.Matrix(mass), strict=True):
        assert sympy.simplify(found - expected) == 0
    for found, expected in zip(symbolic.bias, bias, strict=True):
        assert sympy.simplify(found - expected) == 0


def parameters(model: Model, *names: str) -> list[Any]:
    return [model.parameter(name) for name in names]


def test_double_pendulum_with_relative_angles() -> None:
    model = Model("double", gravity=(0, 0, 0))
    m1, m2, l1, c1, c2, i1, i2, g = parameters(model, "m1", "m2", "l1", "c1", "c2", "I1", "I2", "g")
    model.gravity = (0, 0, -g)
    upper = model.body("upper", mass=m1, mass_center=(0, 0, -c1), inertia=(0, i1, 0))
    lower = model.body("lower", mass=m2, mass_center=(0, 0, -c2), inertia=(0, i2, 0))
    model.revolute("a", between=("ground", upper), axis=(0, 1, 0))
    model.revolute("b", between=(upper.frame("elbow", at=(0, 0, -l1)), lower), axis=(0, 1, 0))
    symbolic = derive(model).symbolic

    m1, m2, l1, c1, c2, i1, i2, g, a, b, a_dot, b_dot = sympy.symbols(
        "m1 m2 l1 c1 c2 I1 I2 g a b a_dot b_dot"
    )
    m11 = i1 + i2 + m1 * c1**2 + m2 * (l1**2 + c2**2 + 2 * l1 * c2 * sympy.cos(b))
    m12 = i2 + m2 * c2**2 + m2 * l1 * c2 * sympy.cos(b)
    h = m2 * l1 * c2 * sympy.sin(b)
    both = m2 * c2 * g * sympy.sin(a + b)
    assert_same(
        symbolic,
        [[m11, m12], [m12, i2 + m2 * c2**2]],
        [
            -h * (2 * a_dot * b_dot + b_dot**2) + g * (m1 * c1 + m2 * l1) * sympy.sin(a) + both,
            h * a_dot**2 + both,
        ],
    )


def test_furuta_pendulum() -> None:
    model = Model("furuta", gravity=(0, 0, 0))
    arm_inertia, m, length, c, axial, transverse, g = parameters(
        model, "J0", "m", "L", "l", "Ja", "Jt", "g"
    )
    model.gravity = (0, 0, -g)
    arm = model.body("arm", inertia=(0, 0, arm_inertia))
    rod = model.body("rod", mass=m, mass_center=(0, 0, -c), inertia=(transverse, transverse, axial))
    model.revolute("th", between=("ground", arm), axis=(0, 0, 1))
    model.revolute("al", between=(arm.frame("tip", at=(length, 0, 0)), rod), axis=(1, 0, 0))
    symbolic = derive(model).symbolic

    j0, m, length, c, ja, jt, g, al, th_dot, al_dot = sympy.symbols(
        "J0 m L l Ja Jt g al th_dot al_dot"
    )
    sine, cosine = sympy.sin(al), sympy.cos(al)
    m11 = j0 + m * length**2 + (jt + m * c**2) * sine**2 + ja * cosine**2
    m12 = m * length * c * cosine
    swing = (jt + m * c**2 - ja) * sympy.sin(2 * al)
    assert_same(
        symbolic,
        [[m11, m12], [m12, jt + m * c**2]],
        [
            swing * al_dot * th_dot - m * length * c * sine * al_dot**2,
            -swing * th_dot**2 / 2 + m * g * c * sine,
        ],
    )


def test_cart_pole() -> None:
    model = Model("cart_pole", gravity=(0, 0, 0))
    cart_mass, m, c, inertia, g = parameters(model, "M", "m", "l", "J", "g")
    model.gravity = (0, 0, -g)
    cart = model.body("cart", mass=cart_mass)
    pole = model.body("pole", mass=m, mass_center=(0, 0, -c), inertia=(0, inertia, 0))
    model.prismatic("x", between=("ground", cart), axis=(1, 0, 0))
    # hanging pole: positive p takes its end towards positive x
    model.revolute("p", between=(cart, pole), axis=(0, -1, 0))
    symbolic = derive(model).symbolic

    cart_mass, m, c, inertia, g, p, p_dot = sympy.symbols("M m l J g p p_dot")
    across = m * c * sympy.cos(p)
    assert_same(
        symbolic,
        [[cart_mass + m, across], [across, inertia + m * c**2]],
        [-m * c * sympy.sin(p) * p_dot**2, m * g * c * sympy.sin(p)],
    )


def test_pendulum_of_variable_length() -> None:
    """The elastic pendulum less its spring: m r'' = m r ph'^2 + m g cos ph, r ph'' = -2 r' ph' - g sin."""
    model = Model("telescope", gravity=(0, 0, 0))
    m, g = parameters(model, "m", "g")
    model.gravity = (0, 0, -g)
    hub, bob = model.body("hub"), model.body("bob", mass=m)
    model.revolute("ph", between=("ground", hub), axis=(0, 1, 0))
    model.prismatic("r", between=(hub, bob), axis=(0, 0, -1))
    symbolic = derive(model).symbolic

    m, g, ph, r, ph_dot, r_dot = sympy.symbols("m g ph r ph_dot r_dot")
    assert_same(
        symbolic,
        [[m * r**2, 0], [0, m]],
        [
            2 * m * r * r_dot * ph_dot + m * g * r * sympy.sin(ph),
            -m * r * ph_dot**2 - m * g * sympy.cos(ph),
        ],
    )


def test_a_free_rigid_body_obeys_euler() -> None:
    """M = diag(m, J), h = (m w x v - m R^T g, w x J w), about the mass centre."""
    model = Model("free", gravity=(0, 0, 0))
    m, a, b, c, g = parameters(model, "m", "A", "B", "C", "g")
    model.gravity = (0, 0, -g)
    body = model.body("body", mass=m, inertia=(a, b, c))
    model.free("f", between=("ground", body))
    symbolic = derive(model).symbolic

    m, a, b, c, g = sympy.symbols("m A B C g")
    x, y, z, w = sympy.symbols("f_qx f_qy f_qz f_qw")
    v, omega = sympy.Matrix(symbolic.v[:3]), sympy.Matrix(symbolic.v[3:])
    inertia = sympy.diag(a, b, c)
    down = sympy.Matrix([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x**2 + y**2)])
    force = m * omega.cross(v) + m * g * down
    torque = omega.cross(inertia * omega)
    assert_same(symbolic, sympy.diag(m, m, m, a, b, c).tolist(), [*force, *torque])

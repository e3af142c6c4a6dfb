"""Linearisation in letters: right against other routes, short, and refused where it cannot be had.

The other routes are values by hand and from books, sympy's `DomainMatrix` on M and K, the emitted `linearize`
(which differentiates programs) at random parameters, complex steps of the derivation over numbers, and the
frequency responses of `control`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import control
import numpy as np
import pytest
import sympy
from agreement.test_closed_derivatives import reduced
from agreement.test_derivatives import Point, error
from support import closed_examples
from support.emitted import load
from support.linear_models import SYSTEMS, parallelogram, row
from sympy.polys.matrices import DomainMatrix

import linegraph as lg
from linegraph import Model, ModelError
from linegraph.emission.emit import render
from linegraph.programs.independent import independent
from linegraph.programs.loop_derivatives import free_changes
from linegraph.programs.workspace import Workspace

if TYPE_CHECKING:
    from pathlib import Path

    from linegraph.derivation import Derivation
    from linegraph.symbolic.state_space import StateSpace

Array = Any

EXACT = 1e-12
"""Relative to 1 + the largest entry."""

SIZES = (2, 3, 4, 6)
OF_POINTS = ("row", "pendulum", "pendulum on a cart")


def drawn(derivation: Derivation, seed: int) -> dict[str, float]:
    """Other values of all parameters."""
    rng = np.random.default_rng(seed)
    given = [p for p in derivation.system.parameters.values() if not p.derived]
    return {p.name: float(p.value or 1.0) * rng.uniform(0.7, 1.4) for p in given}


def emitted(derivation: Derivation, state: dict[str, float], parameters: Any) -> list[Array]:
    """A and B of the emitted function at a state given by names."""
    names = {"q": derivation.q, "v": derivation.v, "u": derivation.u}
    given = {k: [float(state.get(str(x), 0.0)) for x in column] for k, column in names.items()}
    function = derivation.function("linearize")
    found = function(*(given[k] for k in function.arguments if k in given), parameters=parameters)
    return list(found) if isinstance(found, tuple) else [found]


def agree(derivation: Derivation, at: Any, letters: Any, seed: int = 0) -> StateSpace:
    """Linearise in letters, and compare with the emitted function at random parameters."""
    space = derivation.linearise(at)
    parameters = drawn(derivation, seed)
    values = {**parameters, **letters}
    by_name = {sympy.Symbol(name): x for name, x in values.items()}
    state = {str(k): float(sympy.sympify(x).subs(by_name)) for k, x in at.items()}
    ours = space.numeric(values)
    for mine, theirs in zip(ours, emitted(derivation, state, parameters), strict=False):
        assert mine.shape == theirs.shape
        assert error(mine, theirs) < EXACT
    return space


# ---- in letters, short


@pytest.mark.parametrize("size", [2, 3])
@pytest.mark.parametrize("name", OF_POINTS)
def test_rows_and_pendulums_are_right_and_short(name: str, size: int) -> None:
    """M^-1 K as `DomainMatrix` finds it, in no more operations, and the emitted function's A and B."""
    derivation = lg.derive(SYSTEMS[name](size))
    space = agree(derivation, {}, {})
    n = len(derivation.q)
    still = dict.fromkeys([*derivation.q, *derivation.v], 0)
    mass = derivation.mass_matrix.subs(still)
    stiffness = derivation.bias.jacobian(derivation.q).subs(still)
    # from the leaves to the root: in the other order six links take minutes
    order = list(reversed(range(n)))
    M, K = (
        DomainMatrix.from_Matrix(m)
        for m in (mass.extract(order, order), stiffness.extract(order, list(range(n))))
    )
    left, right = M.unify(K)
    found = left.to_field().lu_solve(right.to_field()).to_Matrix()[::-1, :]
    below = space.A[n:, :n]
    assert sympy.count_ops(below) <= sympy.count_ops(found)
    values = {sympy.Symbol(k): x for k, x in drawn(derivation, 5).items()}
    expected = np.array((-found).subs(values), float)
    assert error(np.array(below.subs(values), float), expected) < EXACT


OPERATIONS = {
    "row": (9, 16, 23, 37),
    "pendulum": (15, 35, 59, 119),
    "pendulum on a cart": (27, 50, 77, 143),
}
"""Of A; DomainMatrix's of the same are 10 to 46, 18 to 202, 34 to 214."""


@pytest.mark.parametrize("name", OPERATIONS)
def test_operations_of_linearised_systems(name: str) -> None:
    """A count that goes up is a form that got longer."""
    found = [sympy.count_ops(lg.derive(SYSTEMS[name](n)).linearise().A) for n in SIZES]
    assert all(ours <= most for ours, most in zip(found, OPERATIONS[name], strict=True)), found


def test_what_has_too_many_terms_is_refused_soon() -> None:
    derivation = lg.derive(SYSTEMS["pendulum of bodies"](5))
    with pytest.raises(ModelError, match=r'too many terms.*function\("linearize"\)'):
        derivation.linearise()


def test_two_masses_by_hand() -> None:
    m1, m2, k1, k2 = sympy.symbols("m1 m2 k1 k2")
    A = lg.derive(row(2)).linearise().A
    below = sympy.Matrix([[-k1 / m1, k2 / m1], [k1 / m1, -k2 * (m1 + m2) / (m1 * m2)]])
    assert sympy.simplify(A[2:, :2] - below) == sympy.zeros(2)


# ---- points in numbers, in letters and in both


def driven_pendulum() -> Model:
    model = Model("pendulum")
    m, l = model.parameter("m", 2.0), model.parameter("l", 0.5)  # noqa: E741
    model.gravity = (0, 0, -1 * model.parameter("g", 9.81))
    bob = model.body("bob", mass=m, mass_center=(0, 0, -1 * l))
    bob.frame("tip", at=(0, 0, -1 * l))
    model.revolute("theta", between=("ground", bob), axis=(0, 1, 0))
    return model


@pytest.mark.parametrize(
    "angle",
    [0, sympy.pi, sympy.pi / 3, 0.4, sympy.Rational(1, 4), sympy.Symbol("alpha"), "mixed"],
    ids=str,
)
def test_a_pendulum_held_at_any_angle(angle: Any) -> None:
    m, l, g = sympy.symbols("m l g")  # noqa: E741
    angle = sympy.Symbol("alpha") + sympy.pi / 2 if angle == "mixed" else angle
    at = {"theta": angle, "u_theta": m * g * l * sympy.sin(angle)}
    space = agree(lg.derive(driven_pendulum()), at, {"alpha": 0.3})
    difference = space.A[1, 0] + g * sympy.cos(angle) / l
    assert abs(difference.subs({g: 9.81, l: 0.5, "alpha": 0.3}).evalf()) < 1e-13
    if isinstance(angle, float):
        return
    assert sympy.simplify(difference) == 0
    assert not space.A.atoms(sympy.Float)


def test_a_coordinate_may_be_the_letter_that_it_is() -> None:
    derivation = lg.derive(driven_pendulum())
    m, l, g, theta = sympy.symbols("m l g theta")  # noqa: E741
    space = derivation.linearise({"theta": theta, "u_theta": m * g * l * sympy.sin(theta)})
    assert space.A[1, 0] == -g * sympy.cos(theta) / l


def levitated(assumed: Any) -> tuple[Derivation, StateSpace, Any]:
    model = Model("maglev")
    model.parameter("m", 0.05)
    model.parameter("C", 1e-4)
    model.gravity = (0, 0, model.parameter("g", 9.81))
    model.input("i", "A")
    model.prismatic("y", ("ground", model.body("ball", mass="m")), (0, 0, 1), effort=False)
    model.load("pull", at="ball", force=(0, 0, "-C*i**2/y**2"))
    derivation = lg.derive(model)
    h = sympy.Symbol("h", **assumed)
    p = derivation.p
    return derivation, derivation.linearise({"y": h, "i": h * sympy.sqrt(p.m * p.g / p.C)}), h


@pytest.mark.parametrize("assumed", [{}, {"positive": True}], ids=["plain", "positive"])
def test_a_root_in_b_by_hand(assumed: Any) -> None:
    """Magnetic levitation: -2 C sqrt(gm/C)/(h m) in B, 2 C sqrt(gm/C)/(m (2g - h s^2)) of s."""
    derivation, space, h = levitated(assumed)
    m, g, C, s = (*sympy.symbols("m g C"), sympy.Symbol("s"))
    root = sympy.sqrt(g * m / C)
    assert sympy.Matrix([[0, 1], [2 * g / h, 0]]) == space.A
    assert sympy.simplify(space.B - sympy.Matrix([0, -2 * C * root / (h * m)])) == sympy.zeros(2, 1)
    expected = 2 * C * root / (m * (2 * g - h * s**2))
    found = space.transfer_function()
    assert sympy.simplify(found[0] - expected) == 0
    at = {"y": h, "i": h * sympy.sqrt(m * g / C)}
    values = {"h": 0.02}
    state = {
        str(k): float(x.subs({**derivation.symbolic.defaults, h: 0.02})) for k, x in at.items()
    }
    A, B = emitted(derivation, state, derivation.symbolic.defaults)
    ours = space.numeric(values)
    assert error(ours[0], A) < EXACT
    assert error(ours[1], B) < EXACT


def test_a_ball_keeps_its_quaternion() -> None:
    """A of the four numbers is that of small turns: A P = P A' with dq = N d."""
    model = Model("ball")
    model.gravity = (0, 0, -1 * model.parameter("g", 9.81))
    c = model.parameter("c", 0.3)
    J = tuple(model.parameter(f"J{k}", 0.1 + 0.03 * k) for k in range(3))
    bob = model.body("bob", mass=model.parameter("m", 1.5), mass_center=(0, 0, -1 * c), inertia=J)
    model.spherical("ball", ("ground", bob))
    derivation = lg.derive(model)
    parameters = drawn(derivation, 2)
    space = derivation.linearise()
    ours = space.numeric(parameters)[0]
    start = {str(x): float(k == 3) for k, x in enumerate(derivation.q)}
    A, *_ = emitted(derivation, start, parameters)
    P = np.zeros((7, 6))
    N = np.array([derivation.coordinate_rates.diff(x).tolist() for x in derivation.v])[..., 0].T
    still = {x: start[str(x)] for x in derivation.q}
    P[:4, :3] = np.array(sympy.Matrix(N).subs(still), float)
    P[4:, 3:] = np.eye(3)
    assert error(ours @ P, P @ A) < EXACT


# ---- networks


def low_pass() -> Model:
    model = Model("rc")
    model.parameter("R", 1e3)
    model.parameter("C", 1e-6)
    model.input("u", "V")
    model.voltage_source("s", between=("a", "ground"), voltage="u")
    model.resistor("R1", between=("a", "b"), resistance="R")
    model.capacitor("C1", between=("b", "ground"), capacitance="C")
    return model


def test_a_network_without_mechanics() -> None:
    R, C, s = sympy.symbols("R C s")
    space = agree(lg.derive(low_pass()), {}, {})
    assert sympy.Matrix([[-1 / (C * R)]]) == space.A
    assert space.transfer_function()[0] == 1 / (C * R * s + 1)


def test_a_boost_converter_averaged() -> None:
    """Its duty ratio d multiplies states: L i' = E - (1 - d) v, C v' = (1 - d) i - v/R."""
    model = Model("boost")
    for name, x in {"E": 12.0, "L": 1e-3, "C": 1e-4, "R": 20.0}.items():
        model.parameter(name, x)
    model.input("d", "1")
    model.voltage_source("s", between=("in", "ground"), voltage="E")
    model.inductor("L1", between=("in", "x"), inductance="L")
    model.transformer("sw", between=("x", "ground"), second=("out", "ground"), ratio="1 - d")
    model.capacitor("C1", between=("out", "ground"), capacitance="C")
    model.resistor("load", between=("out", "ground"), resistance="R")
    derivation = lg.derive(model)
    E, R, L, C, D = sympy.symbols("E R L C D")
    names = [str(x) for x in derivation.v]
    voltage = next(n for n in names if n.startswith("v"))
    current = next(n for n in names if n.startswith("i"))
    at = {voltage: E / (1 - D), current: E / (R * (1 - D) ** 2), "d": D}
    space = agree(derivation, at, {"D": 0.4})
    i, v = names.index(current), names.index(voltage)
    expected = {(i, i): 0, (i, v): -(1 - D) / L, (v, i): (1 - D) / C, (v, v): -1 / (R * C)}
    for place, x in expected.items():
        assert sympy.simplify(space.A[place] - x) == 0
    assert sympy.simplify(space.B[i] - E / (L * (1 - D))) == 0


def test_motors_on_joints_and_circuits_together() -> None:
    agree(
        lg.derive(lg.read(str(closed_examples.EXAMPLES / "cart_pole_motor/cart_pole_motor.toml"))),
        {},
        {},
    )


# ---- loops and rolling


def test_a_parallelogram_by_hand() -> None:
    """(2 m L²/3 + M L²) θ'' = u - (m + M) g L θ, of two rods m and a coupler M."""
    derivation = lg.derive(parallelogram())
    m, M, L, g = sympy.symbols("m M L g")
    space = agree(derivation, {}, {})
    inertia = 2 * m * L**2 / 3 + M * L**2
    assert space.states == ("left", "left_dot")
    assert sympy.simplify(space.A[1, 0] + (m + M) * g * L / inertia) == 0
    assert sympy.simplify(space.B[1] - 1 / inertia) == 0


def test_a_disc_that_rolls_is_stable_above_its_speed() -> None:
    """A thin disc: lean'' = (4 g/r - 12 Ω²)/5 lean, stable where Ω² > g/(3 r)."""
    derivation = lg.derive(closed_examples.read("rolling_disc"))
    r, g, W, x = sympy.symbols("r g Omega x")
    at = {"motion_z": r, "motion_roll_dot": W, "motion_x_dot": r * W}
    space = agree(derivation, at, {"Omega": 3.0})
    found = sympy.factor(space.A.charpoly(x).as_expr())
    expected = x**6 * (x**2 - (4 * g / r - 12 * W**2) / 5)
    assert sympy.simplify(found - expected) == 0


def test_a_bicycle_rides_in_letters(tmp_path: Path) -> None:
    """All dimensions and the speed are letters; A and B are those of the emitted function."""
    model = closed_examples.read("bicycle")
    derivation = lg.derive(model)
    V, p = sympy.Symbol("V"), derivation.p
    at = {"frame_x_dot": V, "rear_spin_dot": -V / p.rR, "front_spin_dot": -V / p.rF}
    space = derivation.linearise(at)
    assert {"V", "w", "c", "g", "rR", "rF"} <= {x.name for x in space.A.free_symbols}
    files = render(model, folded=True, only=("linearize",), languages=["python"])
    module = load(files, "bicycle", tmp_path)
    assert space.states == tuple(module.DX_NAMES)
    values = {**derivation.symbolic.defaults, "V": 4.3}
    v = [float(sympy.sympify(at.get(str(x), 0)).subs(values)) for x in derivation.v]
    found = module.linearize(np.zeros(9), np.array(v), np.zeros(2))
    for mine, theirs in zip(space.numeric({"V": 4.3}), found, strict=False):
        assert error(mine, theirs) < EXACT


LOOPS = {"four_bar": {"motor": 1.0}, "slider_crank": {"shaft": 0.7}, "parallelograms": {"A0": 0.4}}


@pytest.mark.parametrize("name", LOOPS)
def test_loops_that_close_in_numbers_alone(name: str, tmp_path: Path) -> None:
    """Held where their drive balances them: the emitted function and complex steps give the same."""
    model = closed_examples.read(name)
    derivation = lg.derive(model)
    q = derivation.assembly(LOOPS[name], start=derivation.assembled.q).q
    still = [0.0] * len(derivation.v)
    count = len(derivation.u)
    f = Workspace(derivation, folded=True)
    free, own = free_changes(f), [v for _, v in independent(f)]
    numeric = derivation.numeric()
    bias = np.array(numeric.bias(q, still), float)
    J = np.array(numeric.constraint_jacobian(q), float).reshape(-1, len(still))
    drive = np.array(derivation.forces.jacobian(derivation.u), float).reshape(len(still), count)
    # h = B u + J^T lam
    balanced = np.linalg.lstsq(np.hstack((drive, J.T)), bias, rcond=1e-10)[0][:count]
    at = LOOPS[name] | {str(u): x for u, x in zip(derivation.u, balanced, strict=True)}
    space = derivation.linearise(at)
    assert not space.A.free_symbols
    A, B, *_ = space.numeric()
    files = render(model, folded=True, only=("linearize",), languages=["python"])
    module = load(files, name, tmp_path)
    found = module.linearize(np.array(q), np.array(still), balanced)
    holonomic = sum(equation.holonomic for equation in f.constraint_equations)
    point = Point(derivation, 0.0, np.array(q), np.array(still), balanced)
    stepped = reduced(point, free, own, holonomic)
    for mine, theirs in zip((A, B), found, strict=True):
        assert error(mine, theirs) < 1e-9  # the loops close to 1e-11
    assert error(np.hstack((A, B)), stepped) < 1e-9


def test_a_network_beside_a_loop() -> None:
    """A motor drives the parallelogram; the current is a state, too: L i' = u - R i - K θ'."""
    model = parallelogram()
    for name, x in {"K": 0.3, "R": 2.0, "H": 0.05}.items():
        model.parameter(name, x)
    model.input("u", "V")
    model.voltage_source("s", ("a", "ground"), voltage="u")
    model.dc_motor(
        "drive", ("a", "ground"), joint="left", constant="K", resistance="R", inductance="H"
    )
    space = lg.derive(model).linearise()
    m, M, L, g, K, R, H = sympy.symbols("m M L g K R H")
    inertia = 2 * m * L**2 / 3 + M * L**2
    assert space.states == ("left", "left_dot", "i_drive")
    below = sympy.Matrix([[-(m + M) * g * L / inertia, 0, K / inertia], [0, -K / H, -R / H]])
    assert sympy.simplify(space.A[1:, :] - below) == sympy.zeros(2, 3)
    assert space.B[2, list(space.inputs).index("u")] == 1 / H


def test_an_algebraic_loop_is_differentiated_too() -> None:
    """A diode charges a capacitor through a resistor: C v' = z, z = S (exp((u - v - R z)/n) - 1)."""
    model = Model("rectifier")
    for name, x in {"S": 1e-3, "n": 0.5, "R": 3.0, "C": 1e-2}.items():
        model.parameter(name, x)
    model.input("u", "V")
    model.voltage_source("s", ("a", "ground"), voltage="u")
    model.diode("D", ("a", "b"), saturation="S", voltage="n")
    model.resistor("R1", ("b", "c"), resistance="R")
    model.capacitor("C1", ("c", "ground"), capacitance="C")
    derivation = lg.derive(model)
    space = agree(derivation, {}, {})
    S, n, R, C = sympy.symbols("S n R C")
    assert sympy.simplify(space.A[0] + 1 / (C * (R + n / S))) == 0


# ---- refusals


def held(problem: str, model: Model, at: Any) -> None:
    with pytest.raises(ModelError, match=problem):
        lg.derive(model).linearise(at)


def test_where_loops_are_open_the_gap_is_said() -> None:
    held(r"constraint of .* does not hold there.*L", parallelogram(), {"left": sympy.Symbol("x")})


def test_no_equilibrium_is_named() -> None:
    held("left_dot does not stay.*equilibrium", parallelogram(), {"u_left": 1})
    held(
        "theta_dot does not stay.*= u_theta|theta_dot does not stay",
        driven_pendulum(),
        {"theta": 1},
    )


def test_a_singular_position_is_refused() -> None:
    """Where all rods lie in line two motions are free."""
    model = parallelogram()
    at = {"left": sympy.pi / 2, "near": -sympy.pi / 2, "right": sympy.pi / 2}
    model.gravity = (0, 0, 0)
    held("position is singular", model, at)


def test_motions_that_follow_the_time_or_inputs_are_refused() -> None:
    model = driven_pendulum()
    model.load("wind", at="bob.tip", force=("sin(t)", 0, 0))
    held("depend on the time.*ask function", model, {})
    model = Model("led")
    arm = model.body("arm", mass=1.0, mass_center=(0, 0, -0.5), inertia=(0.1, 0.1, 0.1))
    model.revolute("hinge", between=("ground", arm), axis=(0, 1, 0))
    bob = model.body("bob", mass=1.0, inertia=(0.1, 0.1, 0.1))
    model.prismatic("slide", between=(arm, bob), axis=(0, 0, 1), start=0.5)
    model.driver("lead", between=("ground", bob), x="input")
    held("constraints that follow inputs", model, {"slide": 0.5})


# ---- transfer functions


def is_collected(part: Any, s: Any) -> bool:
    """A factor without s times a sum with each power of s once."""
    factors = [f for f in sympy.Mul.make_args(part) if f.has(s)]
    if len(factors) > 1 or any(not f.is_Add and f.as_base_exp()[0] != s for f in factors):
        return False
    powers = [
        sympy.degree(term.as_independent(s)[1], s)
        for f in factors
        for term in sympy.Add.make_args(f)
    ]
    return len(set(powers)) == len(powers)


def motor_with_shaft() -> Model:
    model = Model("motor")
    for name, x in {
        "K": 0.05,
        "R": 1.0,
        "L": 1e-3,
        "J": 1e-4,
        "k": 10.0,
        "J2": 1e-3,
        "b": 1e-4,
    }.items():
        model.parameter(name, x)
    model.input("u", "V")
    model.voltage_source("s", between=("a", "ground"), voltage="u")
    model.dc_motor(
        "m",
        between=("a", "ground"),
        shaft=("w", "ground"),
        constant="K",
        resistance="R",
        inductance="L",
        inertia="J",
        damping="b",
    )
    model.rotational_spring("sh", between=("w", "l"), stiffness="k")
    model.inertia("load", between=("l", "ground"), inertia="J2")
    model.output("speed", "across(load)", "rad/s")
    return model


RESPONSES: dict[str, Any] = {
    "motor": lambda: lg.derive(motor_with_shaft()).state_space,
    "row of three": lambda: lg.derive(row(3)).linearise(),
    "pendulum of two": lambda: lg.derive(SYSTEMS["pendulum"](2)).linearise(),
    "pendulum on a cart": lambda: lg.derive(SYSTEMS["pendulum on a cart"](2)).linearise(),
    "parallelogram": lambda: lg.derive(parallelogram()).linearise(),
    "low pass": lambda: lg.derive(low_pass()).linearise(),
}


@pytest.mark.parametrize("name", RESPONSES)
def test_transfer_functions_are_quotients_of_polynomials(name: str) -> None:
    """Collected in s, without common factors, and what `control` answers at random parameters."""
    space = RESPONSES[name]()
    s = sympy.Symbol("s")
    found = space.transfer_function()
    rng = np.random.default_rng(4)
    values = {p: x * rng.uniform(0.7, 1.4) for p, x in space.defaults.items()}
    there = control.ss(*space.numeric(values))
    for i, j in np.ndindex(*found.shape):
        if found[i, j] == 0:
            continue
        above, below = sympy.fraction(found[i, j])
        assert is_collected(above, s)
        assert is_collected(below, s)
        letters = sorted({*above.free_symbols, *below.free_symbols}, key=str)
        assert sympy.gcd(sympy.expand(above), sympy.expand(below), *letters).is_number
        for at in (0.3 + 1.7j, 2.1j):
            ours = complex(found[i, j].subs({**values, "s": at}).evalf())
            theirs = complex(np.asarray(there(at)).reshape(found.shape)[i, j])
            assert abs(ours - theirs) <= 1e-9 * (1 + abs(theirs))


def test_a_motor_as_a_book_writes_it() -> None:
    K, R, L, J, k, J2, b, s = sympy.symbols("K R L J k J2 b s")
    found = RESPONSES["motor"]().transfer_function()[0]
    above, below = sympy.fraction(found)
    polynomial = [
        J * J2 * L,
        J2 * (J * R + L * b),
        J * L * k + J2 * (K**2 + L * k + R * b),
        k * (J * R + J2 * R + L * b),
        k * (K**2 + R * b),
    ]
    assert above == K * k
    assert all(
        sympy.expand(a - c) == 0
        for a, c in zip(sympy.Poly(below, s).all_coeffs(), polynomial, strict=True)
    )


def test_among_numbers_the_highest_power_has_one() -> None:
    model = Model("filter")
    model.input("u", "V")
    model.voltage_source("s", ("a", "ground"), voltage="u")
    model.resistor("R1", ("a", "b"), resistance=0.7)
    model.capacitor("C1", ("b", "ground"), capacitance=0.13)
    model.inductor("L1", ("b", "ground"), inductance=0.37)
    space = lg.derive(model).linearise()
    s = sympy.Symbol("s")
    below = sympy.Poly(sympy.fraction(space.transfer_function()[0])[1], s)
    assert float(below.LC()) == 1
    assert [float(x) for x in below.all_coeffs()] == pytest.approx(
        list(np.poly(space.numeric()[0]))
    )


# ---- the same function


def test_linearize_is_the_same_function() -> None:
    derivation = lg.derive(driven_pendulum())
    assert type(derivation).linearize is type(derivation).linearise
    assert type(derivation.symbolic).linearize is type(derivation.symbolic).linearise
    assert (
        derivation.linearize({"theta": sympy.pi}).A == derivation.linearise({"theta": sympy.pi}).A
    )

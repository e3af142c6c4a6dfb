"""Names: what a model declares never meets what a derivation adds, whoever declares it and however.

Random names are drawn from the patterns of the register itself, for all kinds of names at once. Either the
names are refused, with both owners, or the equations are those of the same model under neutral names: closed
forms as well as numbers.
"""

from __future__ import annotations

import random
import re
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy

import linegraph as lg
from linegraph.components.validation import RESERVED
from linegraph.readers import modelfile, urdf

if TYPE_CHECKING:
    from linegraph.derivation import Derivation

STEMS = ("theta", "x", "b", "lambda", "I")
PATTERNS = (
    *("{}", "a_{}", "u_{}", "{}_dot", "{}_ddot", "effort_{}", "{}_rate", "{}_acceleration"),
    *("{}_f1", "{}_t1", "{}_drive", "lam_{}_f1", "{}_multiplier", "{}_length", "a_a_{}", "u_u_{}"),
    *(
        "{}_x",
        "{}_y",
        "{}_angle",
        "{}_vx",
        "{}_wz",
        "{}_qx",
        "{}_qw",
        "{}_wx",
        "a_{}_vx",
        "u_{}_wz",
    ),
    *("v_{}", "i_{}", "a_v_{}", "state_v_{}", "{}_body", "{}_body_x", "{}_link", "{}_joint"),
)
WORDS = ("t", "pi", "q", "v", "a", "u", "s", "E", "S", "N", "sin", "der", "input", "gamma", "lam")
KINDS = {
    "parameters": ("mass", "arm", "stiff", "amount"),
    "inputs": ("push",),
    "bodies": ("one", "two", "three"),
    "joints": ("first", "second", "third"),
    "components": ("source", "line", "store"),
    "elements": ("strut", "bearing"),
    "outputs": ("seen",),
}
Naming = dict[str, str]
NEUTRAL: Naming = {role: f"{role}0" for roles in KINDS.values() for role in roles}


def naming(seed: int) -> Naming:
    """Names for all kinds of things: one stem, and what could meet something of that name."""
    draw = random.Random(seed)
    stem = draw.choice(STEMS)
    names = dict(NEUTRAL)
    owner = draw.choice((*KINDS["joints"], "store", "one"))
    names[owner] = stem
    for role in draw.sample(list(NEUTRAL), draw.randint(1, 3)):
        word = draw.random() < 0.05
        if role != owner:
            names[role] = draw.choice(WORDS) if word else draw.choice(PATTERNS).format(stem)
    return names


def built(names: Naming, seed: int) -> lg.Model:
    """A chain of three bodies, an electrical network, laws and outputs under given names."""
    draw = random.Random(seed)
    n = names
    model = lg.Model("chain", gravity=(0.3, -9.81, 0.5))
    mass = model.parameter(n["mass"], 1.7)
    arm = model.parameter(n["arm"], 0.6)
    stiff = model.parameter(n["stiff"], 40.0)
    model.parameter(n["amount"], 2 * mass)
    push = model.input(n["push"], "N")
    one = model.body(n["one"], mass=mass, mass_center=(0, -arm, 0), inertia=(0.1, 0.2, 0.3))
    two = model.body(n["two"], mass=0.8, mass_center=(arm, 0, 0), inertia=(0.1, 0.1, 0.1))
    three = model.body(n["three"], mass=0.5, mass_center=(0, 0.2, 0), inertia=(0.1, 0.2, 0.2))
    kinds = draw.choice(
        (
            *(("revolute", "prismatic", "revolute"), ("planar", "revolute", "prismatic")),
            *(("prismatic", "revolute", "spherical"), ("revolute", "planar", "prismatic")),
        )
    )
    axes = ((0, 0, 1), (1, 0, 0), (0, 0, 1))
    near: Any = "ground"
    for kind, role, body, axis in zip(
        kinds, ("first", "second", "third"), (one, two, three), axes, strict=True
    ):
        extra = {} if kind == "spherical" else {"axis": axis}
        getattr(model, kind)(n[role], (near, body), **extra)
        near = body.frame(f"end_{role}", at=(0.5, 0.1, 0))
    model.spring(n["strut"], ("ground", two), stiffness=stiff, length=0.3)
    model.load(n["bearing"], two, force=(push * mass, 0, 0))
    model.output(n["seen"], stiff * arm + push)
    if seed % 2:
        model.voltage_source(n["source"], ("a", "ground"), voltage=push)
        model.resistor(n["line"], ("a", "b"), resistance=stiff)
        model.capacitor(n["store"], ("b", "ground"), capacitance=arm)
    if seed % 3 == 1:
        model.formulation(coordinates=draw.choice(("absolute", "absolute-angle")))
    return model


def numbers(derivation: Derivation, point: np.random.Generator) -> tuple[Any, ...]:
    """A state with inputs, and over floats M, h, Q and J there."""
    tree = derivation.structure
    u = point.uniform(-1, 1, len(tree.inputs)).tolist()
    q = point.uniform(-1, 1, len(tree.positions)).tolist()
    tree.normalise(q)
    v = point.uniform(-1, 1, len(tree.velocities)).tolist()
    here = derivation.numeric(u=u).at(q, v)
    parts = (here.mass_matrix, here.bias, here.forces, here.jacobian)
    return (q, v, u, *(np.array(part, dtype=float) for part in parts))


def values_at(derivation: Derivation, q: Any, v: Any, u: Any, rest: np.random.Generator) -> Any:
    """A number for each symbol of the closed forms; refuses two things under one symbol."""
    names = derivation.symbol_names
    given = {"q": q, "v": v, "u": u}
    found: dict[str, float] = {}
    for parameter in derivation.system.parameters.values():
        if not parameter.derived:
            found[parameter.name] = float(parameter.value)
    count = len(found)
    for argument, symbols in names.items():
        numbers_of = given.get(argument, rest.uniform(-1, 1, len(symbols)).tolist())
        count += len(symbols)
        found |= dict(zip(symbols, numbers_of, strict=True))
    declared = {*derivation.system.parameters, "t", "pi"}
    assert not declared & {x for symbols in names.values() for x in symbols}
    assert len(found) == count, "two things have one symbol"
    return {sympy.Symbol(name): x for name, x in found.items()}


def evaluated(expression: Any, values: Any) -> Any:
    matrix = sympy.Matrix(expression).subs(values)
    return np.array(matrix.evalf().tolist(), dtype=float)


@cache
def neutral(seed: int) -> Derivation:
    return lg.derive(built(NEUTRAL, seed))


def assert_same(derivation: Derivation, twin: Derivation, seed: int, closed: bool) -> None:
    """The numbers of two derivations, and the closed forms of the first, are the same at a state."""
    found, wanted = (numbers(d, np.random.default_rng(seed)) for d in (derivation, twin))
    for mine, theirs in zip(found, wanted, strict=True):
        np.testing.assert_allclose(mine, theirs, rtol=1e-12, atol=1e-12)
    q, v, u, M, h, Q, J = wanted
    values = values_at(derivation, q, v, u, np.random.default_rng(1))
    if not closed:
        return
    form = derivation.closed_form("none")
    names = derivation.symbol_names
    a, lam = ([values[sympy.Symbol(x)] for x in names[key]] for key in ("a", "lam"))
    size = len(a)
    left, right = M @ a + h, Q + J.reshape(-1, size).T @ lam
    np.testing.assert_allclose(evaluated(form.mass_matrix, values), M, rtol=1e-9, atol=1e-9)
    for k, equation in enumerate(form.equations()[:size]):
        mine = evaluated([equation.lhs, equation.rhs], values).ravel()
        np.testing.assert_allclose(mine, [left[k], right[k]], rtol=1e-9, atol=1e-9)


def check_refusal(error: lg.LinegraphError, names: Naming) -> None:
    """A refusal says which thing it blames, and why it cannot have its name."""
    text = str(error)
    assert any(f'"{name}"' in text for name in names.values()), text
    assert re.search(
        r"has the name of|has this name too|taken|declared twice|meaning of its own", text
    ), text


def refused(seed: int, closed: bool) -> bool:
    names = naming(seed)
    try:
        derivation = lg.derive(built(names, seed))
    except lg.LinegraphError as error:
        check_refusal(error, names)
        return True
    assert_same(derivation, neutral(seed), seed, closed)
    return False


@pytest.mark.seeds(range(0, 4, 2), range(400))
def test_random_names_are_refused_or_change_nothing(seed: int) -> None:
    """Ten models each, the closed forms of one of them."""
    outcomes = [refused(10 * seed + k, closed=k == 0) for k in range(10)]
    assert len(outcomes) == 10


# ---- the same from a file


def written(names: Naming) -> bytes:
    """A cart with a pole in a file, a law, a rod to ground and outputs under given names."""
    n = {role: f'"{name}"' for role, name in names.items()}
    return f"""name = "cart"
[parameters]
{n["mass"]} = 1.7
{n["arm"]} = 0.6
[inputs]
{n["push"]} = {{ unit = "N" }}
[body.{n["one"]}]
mass = 2.5
[body.{n["two"]}]
mass = 0.7
mass_center = [0, 0, -0.4]
inertia = [0.1, 0.2, 0.2]
[prismatic.{n["first"]}]
between = ["ground", {n["one"]}]
axis = [1, 0, 0]
[revolute.{n["second"]}]
between = [{n["one"]}, {n["two"]}]
axis = [0, 1, 0]
[spring.{n["strut"]}]
joint = {n["second"]}
stiffness = 3
[load.{n["bearing"]}]
at = {n["one"]}
force = ["{names["push"]} + {names["mass"]}*{names["first"]}", 0, 0]
[driver.{n["source"]}]
between = ["ground", {n["one"]}]
x = "input"
[outputs]
{n["seen"]} = "{names["first"]} + {names["arm"]}*der({names["second"]})"
""".encode()


def check_lines(message: str) -> None:
    assert all(re.match(r"cart\.toml:\d+: ", line) for line in message.splitlines()), message


def refused_in_file(seed: int) -> bool:
    names = naming(seed)
    try:
        derivation = lg.derive(modelfile.parse(written(names), "cart.toml"))
    except lg.LinegraphError as error:
        check_lines(str(error))
        return True
    twin = lg.derive(modelfile.parse(written(NEUTRAL), "cart.toml"))
    assert_same(derivation, twin, seed, closed=seed % 10 == 0)
    return False


@pytest.mark.seeds(range(0, 4, 2), range(200))
def test_random_names_in_files_are_refused_with_lines_or_change_nothing(seed: int) -> None:
    for k in range(10):
        refused_in_file(10 * seed + k)


# ---- the same from a URDF, which cannot be refused: names in it give way


def robot(names: Naming) -> bytes:
    n = names
    inertial = (
        '<inertial><origin xyz="0 0.1 -0.5"/><mass value="2"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    links = "".join(f'<link name="{n[role]}">{inertial}</link>' for role in KINDS["bodies"])
    ends = [("stand", n["one"]), (n["one"], n["two"]), (n["two"], n["three"])]
    joints = "".join(
        f'<joint name="{n[role]}" type="{kind}"><parent link="{near}"/><child link="{far}"/>'
        f'<axis xyz="{axis}"/><origin xyz="0.3 0 0"/></joint>\n'
        for role, kind, (near, far), axis in zip(
            KINDS["joints"],
            ("revolute", "planar", "prismatic"),
            ends,
            ("0 0 1", "1 0 0", "0 1 0"),
            strict=True,
        )
    )
    return f'<robot name="r"><link name="stand">{inertial}</link>{links}\n{joints}</robot>'.encode()


def different(seed: int) -> Naming:
    """Names of which no two links and no two joints have the same: a file may not say that."""
    found = dict(NEUTRAL)
    for role, name in naming(seed).items():
        kind = next(roles for roles in KINDS.values() if role in roles)
        if name not in {found[other] for other in kind if other != role}:
            found[role] = name
    return found


@pytest.mark.seeds(range(0, 4, 2), range(100))
@pytest.mark.parametrize("base", ["fixed", "floating"])
@pytest.mark.parametrize("symbolic", [False, True])
def test_random_names_in_a_urdf_give_way_and_change_nothing(
    seed: int, base: str, symbolic: bool
) -> None:
    for k in range(5):
        names = different(5 * seed + k)
        model = urdf.parse(robot(names), "r.urdf", base=base, symbolic=symbolic)
        twin = urdf.parse(robot(NEUTRAL), "r.urdf", base=base, symbolic=symbolic)
        kept = [joint.name for joint in model.joints if joint.name in names.values()]
        renamed = {names[role] for role in KINDS["joints"]} - set(kept)
        told = "\n".join(model.warnings)
        assert all(f'joint "{name}": ' in told for name in renamed)
        assert told.count("it becomes the joint") == len(renamed)
        assert_same(lg.derive(model), lg.derive(twin), seed, closed=False)


# ---- what was seen to meet


def pendulum(name: str) -> Derivation:
    """A point of 1 kg on a rod of the length `name` below a hinge called theta."""
    model = lg.Model("p")
    length = model.parameter(name, 2.0)
    model.gravity = (0, -model.parameter("g", 9.81), 0)
    bob = model.body("bob", mass=1, mass_center=(0, -length, 0))
    model.revolute("theta", ("ground", bob), (0, 0, 1))
    return lg.derive(model)


@pytest.mark.parametrize(
    ("name", "acceleration", "effort"),
    [
        ("l", "a_theta", "u_theta"),
        ("a_theta", "theta_ddot", "u_theta"),
        ("u_theta", "a_theta", "effort_theta"),
    ],
)
def test_a_length_is_no_acceleration_and_no_torque(
    name: str, acceleration: str, effort: str
) -> None:
    """l² θ'' + g l sin θ = u, whatever l is called; linearised, θ'' = -g/l θ + u/l²."""
    d = pendulum(name)
    length, g, theta, a, u = sympy.symbols(f"{name} g theta {acceleration} {effort}")
    (equation,) = d.equations()
    wanted = length**2 * a + g * length * sympy.sin(theta) - u
    assert sympy.expand(equation.lhs - equation.rhs - wanted) == 0
    space = d.linearise()
    assert sympy.simplify(space.A - sympy.Matrix([[0, 1], [-g / length, 0]])) == sympy.zeros(2)
    assert sympy.simplify(space.B - sympy.Matrix([0, 1 / length**2])) == sympy.zeros(2, 1)
    assert space.inputs == (effort,)


def test_a_joint_named_like_the_acceleration_of_another_keeps_apart() -> None:
    model = lg.Model("two")
    for name in ("theta", "a_theta"):
        bob = model.body(f"b{name}", mass=1, mass_center=(0, -1, 0))
        model.revolute(name, ("ground", bob), (0, 0, 1))
    d = lg.derive(model)
    assert [str(x) for x in (*d.q, *d.a)] == ["theta", "a_theta", "theta_ddot", "a_a_theta"]
    text = [f"{e.lhs} = {e.rhs}" for e in d.equations()]
    assert text == ["theta_ddot = u_theta", "a_a_theta = u_a_theta"]


def test_multipliers_and_states_keep_apart_from_parameters() -> None:
    """A hinge's reaction arm_f1 and a capacitor's voltage v_C beside parameters of these names."""
    model = lg.Model("m")
    length, bias = model.parameter("arm_f1", 0.5), model.parameter("v_C", 2.0)
    body = model.body("b", mass=1, mass_center=(0, -length, 0), inertia=(1, 1, 1))
    model.revolute("arm", ("ground", body), (0, 0, 1))
    model.resistor("R", ("n", "ground"), resistance=bias)
    model.capacitor("C", ("n", "ground"), capacitance=1)
    model.formulation(coordinates="absolute")
    d = lg.derive(model)
    assert "lam_arm_f1" in d.symbol_names["lam"]
    assert "arm_f1" not in d.symbol_names["lam"]
    assert d.symbol_names["v"][-1] == "state_v_C"
    model.formulation(coordinates="joint")
    state, resistance, rate = sympy.symbols("state_v_C v_C a_v_C")
    equation = lg.derive(model).equations()[1]
    # C v' = -v/R with C = 1
    assert sympy.simplify(equation.lhs - equation.rhs - rate - state / resistance) == 0


@pytest.mark.parametrize("name", sorted(RESERVED))
@pytest.mark.parametrize(
    "add",
    [
        lambda m, n: m.parameter(n, 1.0),
        lambda m, n: m.input(n),
        lambda m, n: m.revolute(n, ("ground", m.body("b", mass=1))),
        lambda m, n: m.prismatic(n, ("ground", m.body("b", mass=1))),
        lambda m, n: m.output(n, 1),
    ],
    ids=["parameter", "input", "hinge", "slide", "output"],
)
def test_the_builder_refuses_reserved_words_for_symbols(add: Any, name: str) -> None:
    with pytest.raises(lg.ModelError, match=f'"{name}" has a meaning of its own'):
        add(lg.Model("m"), name)


@pytest.mark.parametrize("name", ["t", "pi", "input", "sin"])
def test_what_is_no_symbol_may_have_any_name(name: str) -> None:
    """Bodies, frames, elements and components are named where nothing but such a name can stand."""
    model = lg.Model("m")
    body = model.body(name, mass=1, inertia=(1, 1, 1))
    model.free("joint", ("ground", body.frame(name)))
    model.spring(name, ("ground", body), stiffness=2.0, length=1.0)
    model.resistor(f"{name}_R", ("n", "ground"), resistance=3)
    model.capacitor(f"{name}_C", ("n", "ground"), capacitance=1)
    model.output("seen", f"position({name}.{name}).x + across({name}) + 2*through({name}_R)")
    derivation = lg.derive(model)
    assert not derivation.system.depends_on_time
    outputs = derivation.closed_form("none").outputs["seen"]
    assert sympy.Symbol("t") not in outputs.free_symbols
    assert {str(x) for x in outputs.free_symbols} >= {"joint_x", f"v_{name}_C"}


def test_a_file_refuses_a_joint_called_like_the_time() -> None:
    text = CART.replace("hinge", "t")
    assert refusals(text) == [
        'm.toml:10: [revolute.t]: "t" has a meaning of its own in expressions; choose another name'
    ]


CART = """name = "m"
[body.cart]
mass = 1
[body.pole]
mass = 1
mass_center = [0, 0, -1]
[prismatic.x]
between = ["ground", "cart"]
axis = [1, 0, 0]
[revolute.hinge]
between = ["cart", "pole"]
axis = [0, -1, 0]
"""


def refusals(text: str) -> list[str]:
    with pytest.raises(lg.LinegraphError) as caught:
        modelfile.parse(text.encode(), "m.toml")
    return str(caught.value).splitlines()


def test_a_law_says_what_else_is_called_x() -> None:
    law = '[law.stiffening]\njoint = "hinge"\nforce = "2*x + x**3"\n'
    assert refusals(CART + law) == [
        'm.toml:15: [law.stiffening] force: "x" is the element\'s own displacement here, but a '
        'coordinate of joint "x" (line 7) has this name too; rename that'
    ]


def test_in_a_joint_called_x_a_law_means_its_coordinate() -> None:
    """In joint x both meanings of x are one number."""
    law = '[law.f]\njoint = "x"\nforce = "7*x"\n'
    model = modelfile.parse((CART + law).encode(), "m.toml")
    assert lg.derive(model).numeric().bias([0.3, 0.0], [0.0, 0.0])[0] == pytest.approx(2.1)


def test_a_law_says_how_to_write_a_rate() -> None:
    law = '[law.f]\njoint = "x"\nforce = "2*x + 3*x_dot"\n'
    assert refusals(CART + law) == [
        'm.toml:15: [law.f] force: there is no "x_dot"; write v for the element\'s own rate or '
        "der(x) for the rate of x"
    ]
    load = '[load.f]\nat = "cart"\nforce = ["-hinge_dot", 0, 0]\n'
    assert refusals(CART + load) == [
        'm.toml:15: [load.f] force (item 1): there is no "hinge_dot"; write der(hinge) for the rate of hinge'
    ]


def test_known_names_are_listed_once() -> None:
    law = '[law.f]\njoint = "x"\nforce = "wholly_unknown"\n'
    (message,) = refusals(CART + law)
    listed = message.partition("known: ")[2].split(", ")
    assert sorted(listed) == sorted(set(listed)) == ["hinge", "t", "v", "x"]


def test_the_builder_refuses_a_law_whose_x_means_two_things() -> None:
    model = lg.Model("m")
    cart = model.body("cart", mass=1)
    model.prismatic("x", ("ground", cart), (1, 0, 0))
    model.prismatic("y", (cart, model.body("b", mass=1)), (0, 1, 0))
    model.law("f", joint="y", force="2*x")
    with pytest.raises(
        lg.ModelError, match=r'law "f": "x" is .* a coordinate of joint "x" has this'
    ):
        lg.derive(model)


def test_the_builder_refuses_a_component_whose_x_means_two_things() -> None:
    """Voltage or parameter."""
    model = lg.Model("m")
    model.parameter("x", 3.0)
    model.resistor("R", ("a", "ground"), resistance=1)
    model.capacitor("C", ("a", "ground"), charge="2*x")
    with pytest.raises(lg.ModelError, match=r'capacitor "C": "x" is of the component itself here'):
        lg.derive(model)


def test_in_a_joint_called_x_a_transducer_means_its_coordinate() -> None:
    """A coil in joint x: the force of half L' i² for L = 0.1 + 0.2 x, i = 3 A, is 0.9 N."""
    model = lg.Model("m", gravity=(0, 0, 0))
    model.prismatic("x", ("ground", model.body("b", mass=1)), (1, 0, 0), effort=False)
    model.solenoid("coil", ("a", "ground"), joint="x", inductance="0.1 + 0.2*x")
    model.current_source("s", ("ground", "a"), current=3)
    d = lg.derive(model)
    q, v = [0.4], [0.0] * len(d.structure.velocities)
    assert abs(d.numeric().bias(q, v)[0]) == pytest.approx(0.9)


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        (
            "[parameters]\nhinge_dot = 1\n",
            '10: [revolute.hinge]: its rate "hinge_dot" has the name of a parameter (line 14)',
        ),
        (
            "[inputs]\nx = {}\n",
            '7: [prismatic.x]: its coordinate "x" has the name of an input (line 14)',
        ),
        (
            '[outputs]\nx = "x"\n',
            '14: [outputs] x: a coordinate of joint "x" has this name too (line 7)',
        ),
        (
            "[parameters]\nk = 1\n[inputs]\nk = {}\n",
            "16: [inputs] k: a parameter has this name too (line 14)",
        ),
    ],
)
def test_both_places_are_named(more: str, expected: str) -> None:
    assert refusals(CART + more) == [f"m.toml:{expected}; rename one"]


def test_an_effort_is_called_the_same_in_all_coordinates() -> None:
    """Where the joint is no branch, too; its coordinate's name is no input then."""
    model = lg.Model("m")
    body = model.body("b", mass=1, mass_center=(0, -1, 0), inertia=(1, 1, 1))
    model.revolute("hinge", ("ground", body), (0, 0, 1))
    for coordinates in ("joint", "absolute"):
        model.formulation(coordinates=coordinates)
        assert lg.derive(model).symbol_names["u"] == ("u_hinge",)


def test_an_input_called_the_rate_of_another_is_an_input_of_its_own() -> None:
    """Set points yaw and yaw_rate: neither is the derivative of the other; x' = v, v' = yaw + 3 yaw_rate."""
    model = lg.Model("m")
    model.prismatic("x", ("ground", model.body("b", mass=1)), (1, 0, 0), effort=False)
    yaw, rate = model.input("yaw"), model.input("yaw_rate")
    model.load("pull", "b", force=(yaw + 3 * rate, 0, 0))
    space = lg.derive(model).linearise()
    assert space.inputs == ("yaw", "yaw_rate")
    assert sympy.Matrix([[0, 0], [1, 3]]) == space.B
    assert sympy.zeros(2, 2) == space.E


def test_a_parameter_s_is_not_the_variable_of_a_transfer_function() -> None:
    """X'' = -s x + u: 1/(p² + s), never 1/(s² + s)."""
    model = lg.Model("m")
    stiffness = model.parameter("s", 4.0)
    model.prismatic("x", ("ground", model.body("b", mass=1)), (1, 0, 0))
    model.spring("k", joint="x", stiffness=stiffness)
    space = lg.derive(model).linearise()
    with pytest.raises(lg.ModelError, match="the model has a symbol s, too"):
        space.transfer_function()
    p, s = sympy.symbols("p s")
    assert sympy.simplify(space.transfer_function(p)[0] - 1 / (p**2 + s)) == 0


# ---- a derivation is a snapshot


def test_a_derivation_keeps_the_model_as_it_was() -> None:
    """M g l sin q = 2 9.81 0.5 sin 0.3 = 2.899 N m, whatever happens to the model afterwards."""
    model = lg.Model("p")
    mass, length = model.parameter("m", 2.0), model.parameter("l", 0.5)
    bob = model.body("bob", mass=mass, mass_center=(0, 0, -length))
    model.revolute("a", between=("ground", bob), axis=(0, 1, 0))
    d = lg.derive(model)
    wanted = 2 * 9.81 * 0.5 * np.sin(0.3)
    assert d.numeric().bias([0.3], [0.0])[0] == pytest.approx(wanted, rel=1e-15)
    model.gravity = (0, 0, -1.62)
    model.body("second", mass=1.0)
    model.prismatic("s", between=(bob, "second"), axis=(1, 0, 0))
    model.parameter("late", 1.0)
    model.formulation(coordinates="absolute")
    model.parameters.pop("m")
    assert d.numeric().bias([0.3], [0.0])[0] == pytest.approx(wanted, rel=1e-15)
    assert d.numeric().mass_matrix([0.3]) == [[0.5]]
    assert d.function("bias")([0.3], [0.0])[0] == pytest.approx(wanted, rel=1e-15)
    assert d.gravity[0].subs({"a": 0.3, "m": 2.0, "l": 0.5}) == pytest.approx(wanted, rel=1e-12)

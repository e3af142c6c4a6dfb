"""`check` as an independent judge: it notices what is wrong, and says what it compared and where."""

from __future__ import annotations

import random
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from click.testing import CliRunner
from support import targets

import linegraph as lg
from linegraph.cli.main import main
from linegraph.errors import LinegraphError, ModelError
from linegraph.ir.dag import ADD, SUB, SYMBOL, Node
from linegraph.ir.program import Module, Program
from linegraph.readers import modelfile
from linegraph.verification import checking
from linegraph.verification.checking.report import counted

if TYPE_CHECKING:
    from linegraph.verification.checking.findings import Findings

EXAMPLES = Path(__file__).parents[2] / "examples"


def example(name: str) -> lg.Model:
    return modelfile.read(EXAMPLES / name / f"{name}.toml")


def parsed(text: str) -> lg.Model:
    return modelfile.parse(text.encode(), "m.toml")


def told(model: lg.Model) -> str:
    derivation = lg.derive(model)
    return checking.report(derivation, checking.check(derivation))


# ---- each entry on the scale of what it is made of

MIRROR = """
[body.mirror]
mass = 2e-9
mass_center = [0, 0, 1e-5]
inertia = { xx = 4e-17, yy = 6e-17, zz = 9e-17 }
[revolute.tilt]
between = ["ground", "mirror"]
axis = [0, 1, 0]
[spring.hinge]
joint = "tilt"
stiffness = 1e-9
"""
"""A mirror of a micro-mechanical scanner: all of M and h are far below 1e-9."""


def with_wrong_equations(monkeypatch: pytest.MonkeyPatch, model: lg.Model, wrong: Any) -> Findings:
    """Findings where what is emitted for M and h has gone through `wrong`."""
    right = checking._State.emitted
    monkeypatch.setattr(
        checking._State, "emitted", lambda state, module: wrong(*right(state, module))
    )
    return checking.check(lg.derive(model))


@pytest.mark.parametrize("factor", [0.0, 2.0, 1.001, 1 + 1e-9])
def test_a_small_machine_is_judged_on_its_own_scale(
    monkeypatch: pytest.MonkeyPatch, factor: float
) -> None:
    model = parsed(MIRROR)
    assert checking.check(lg.derive(model)).good

    def scaled(M: Any, h: Any) -> Any:
        return [[factor * x for x in row] for row in M], [factor * x for x in h]

    findings = with_wrong_equations(monkeypatch, model, scaled)
    assert not findings.good
    assert {c.what for c in findings.bad} == {"M", "h"}


@pytest.mark.parametrize(
    "name", ["electro_hydraulic_servo", "excavator_arm", "ring_modulator", "rlc_ladder"]
)
def test_small_entries_beside_large_ones_are_seen(
    monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    """Each entry of M that is smaller than a billionth of 1 + the largest, left out alone."""
    model = example(name)
    derivation = lg.derive(model)
    assert checking.check(derivation).good
    right = checking._State.emitted
    places: set[tuple[int, int]] = set()

    def noted(state: Any, module: Any) -> Any:
        M, h = right(state, module)
        top = max(abs(x) for row in M for x in row)
        size = range(len(M))
        places.update((i, j) for i in size for j in size if 0 < abs(M[i][j]) < 1e-9 * (1 + top))
        return M, h

    monkeypatch.setattr(checking._State, "emitted", noted)
    checking.check(derivation)
    assert places
    for place in sorted(places)[:3]:

        def without(state: Any, module: Any, place: tuple[int, int] = place) -> Any:
            M, h = right(state, module)
            M[place[0]][place[1]] = 0.0
            return M, h

        monkeypatch.setattr(checking._State, "emitted", without)
        assert [c.what for c in checking.check(derivation).bad] == ["M"]


MOONS = """
[gravity]
acceleration = [0, 0, 0]
[body.earth]
mass = 6e24
inertia = [1e37, 1e37, 1e37]
[body.ship]
mass = 1000
inertia = [300, 300, 100]
[free.earth_floats]
between = ["ground", "earth"]
[free.ship_floats]
between = ["ground", "ship"]
angles = "zyx"
[law.gravitation]
between = ["earth", "ship"]
force = "6.674e-11*6e24*1000/x**2"
"""
"""A planet beside a ship; at rest with their centres in one point its law is not defined."""


@pytest.mark.parametrize("coordinates", ["joint", "absolute", "absolute-angle"])
def test_a_planet_beside_a_ship_is_judged_on_the_scale_of_each(
    coordinates: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Right equations are good, and the force on the ship is not lost in the planet's gyroscopic torques."""
    model = parsed(MOONS)
    model.formulation(coordinates=coordinates)
    found = checking.check(lg.derive(model))
    assert found.good
    assert not found.unjudged

    first = next(k for k, x in enumerate(lg.derive(model).structure.velocities) if "ship" in x.name)

    def on_the_ship(M: Any, h: Any) -> Any:
        at = range(first, len(h))
        return M, [x * (1 + 1e-6) if k in at else x for k, x in enumerate(h)]

    assert not with_wrong_equations(monkeypatch, model, on_the_ship).good


# ---- loops

DOOR = """
[frame.low]
at = [0.3, 0, 0]
[frame.high]
at = [0.3, 0, 1]
[body.door]
mass = 10
mass_center = [0.5, 0, 0.5]
inertia = [1, 2, 1]
frame.low = { at = [0.30000000000000004, 0, 0] }
frame.high = { at = [0.3, 0, 1] }
[revolute.low]
between = ["ground.low", "door.low"]
axis = [0, 0, 1]
[revolute.high]
between = ["ground.high", "door.high"]
axis = [0, 0, 1]
effort = false
"""
"""A door on two hinges, one of them off by the last digit: its constraints are nothing but rounding."""


def test_a_door_moves_and_is_good() -> None:
    text = told(parsed(DOOR))
    assert "1 degree of freedom, 1 input" in text
    assert "accelerations, multipliers, number of freedoms" in text
    assert text.endswith("good\n") or text.endswith("good")


def test_a_door_that_is_counted_as_stuck_is_not_good() -> None:
    derivation = lg.derive(parsed(DOOR))
    stuck = replace(derivation.assembled, freedoms=0, rank=1, redundant=4)
    derivation.__dict__["assembled"] = stuck
    findings = checking.check(derivation)
    assert not findings.good
    assert "number of freedoms" in {c.what for c in findings.bad}
    assert "0 by the assembly, 1 by the places of the bodies" in checking.report(
        derivation, findings
    )


def test_a_door_moves_by_newton_and_euler() -> None:
    """Under 7 N m about its hinges: 7 / (1 + 10 0.2²) = 5, and one of five constraints binds nothing."""
    from linegraph.verification.golden.point import Point

    derivation = lg.derive(parsed(DOOR))
    point = Point(derivation, 0.0, [7.0], [0.3], [0.0], [0.0], [0.3], [0.0])
    assert point.rank == 0
    assert point.motion[0][0] == pytest.approx([5.0], rel=1e-12)


@pytest.mark.parametrize("name", ["four_bar", "bricard", "rolling_disc"])
def test_wrong_freedoms_are_seen(name: str) -> None:
    from linegraph.verification.checking import run as running

    derivation = lg.derive(example(name))
    points, _ = running._points(derivation, 0)
    assert running._freedoms(derivation, points).good
    right = derivation.assembled
    derivation.__dict__["assembled"] = replace(right, freedoms=right.freedoms + 1)
    assert not running._freedoms(derivation, points).good


def test_multipliers_that_are_not_unique_are_named() -> None:
    text = told(example("four_bar"))
    assert "multipliers that are not unique: knee_f3, knee_t1, knee_t2" in text
    assert "accelerations, multipliers, number of freedoms" in text


# ---- networks

MOVING = """
[parameters]
C0 = 1e-9
d0 = 1e-3
[gravity]
acceleration = [0, 0, 0]
[inputs]
i0 = {{ unit = "A" }}
[body.plate]
mass = 0.01
[prismatic.gap]
between = ["ground", "plate"]
axis = [1, 0, 0]
effort = false
[current_source.s]
between = ["ground", "a"]
current = "{current}"
{store}
"""
STORES = {
    "capacitor": '[capacitor.C]\nbetween = ["a", "ground"]\ncapacitance = "C0/(1 + gap/d0)"',
    "inductor": '[inductor.C]\nbetween = ["a", "b"]\ninductance = "C0/(1 + gap/d0)"\n'
    '[resistor.R]\nbetween = ["b", "ground"]\nresistance = 3\n[capacitor.D]\nbetween = ["a", "ground"]\n'
    "capacitance = 1e-9",
}


def test_a_store_that_moves_and_pulls_balances() -> None:
    """The same as a transducer, which pulls its plate."""
    store = '[variable_capacitor.C]\nbetween = ["a", "ground"]\njoint = "gap"\n'
    store += 'capacitance = "C0/(1 + x/d0)"'
    findings = checking.check(lg.derive(parsed(MOVING.format(current="i0", store=store))))
    assert findings.good
    assert "power of C" in {c.what for c in findings.comparisons}


@pytest.mark.parametrize(
    ("kind", "named"),
    [("capacitor", "Use variable_capacitor"), ("inductor", "Use solenoid or reluctance_machine")],
)
@pytest.mark.parametrize("current", ["i0", "1e-3*sin(t)"])
def test_a_store_that_moves_without_a_force_is_refused(kind: str, named: str, current: str) -> None:
    """Its energy changes with the joint, and nothing pulls there: told where, and what pulls."""
    line = 1 + MOVING.format(current=current, store=STORES[kind]).split("\n").index(f"[{kind}.C]")
    message = rf'^m.toml:{line}: {kind} "C": .*names gap: .*energy would come from nothing. {named}'
    with pytest.raises(ModelError, match=message):
        lg.derive(parsed(MOVING.format(current=current, store=STORES[kind])))


def test_what_a_network_cannot_balance_is_said() -> None:
    text = told(example("cart_pole_motor"))
    assert "power of supply: it is a source" in text
    driven = MOVING.format(current="i0", store=STORES["capacitor"]).replace(
        "1 + gap/d0", "2 + sin(t)"
    )
    assert "power of C: what it stores is changed from outside, by the time" in told(parsed(driven))


# ---- mutants of the programs

OF_MOTION = ("equations", "forward_dynamics", "constrained_equations", "inverse_dynamics")
"""The programs that check runs; the constants they read are made by another."""


def operations(module: Module) -> list[list[Node]]:
    """All operations that M, h and forward dynamics take, program by program."""
    programs = {p.name: p for p in module.programs if isinstance(p, Program)}
    found = []
    for name in OF_MOTION:
        own = programs.get(name)
        if own is not None:
            own = programs.get(own.handed, own)
            found.append([node for node in own.live if node.op != SYMBOL])
    return [nodes for nodes in found if nodes]


def mutate(node: Node, nodes: list[Node], draw: random.Random) -> str:
    """Make one thing of an operation wrong, in place; says what, or nothing where it has nothing to spoil."""
    kinds = ["operand"]
    kinds += ["sign"] * (node.op in (ADD, SUB))
    numbers = [
        x for x in ("a", "b") if isinstance(getattr(node, x), (int, float)) and getattr(node, x)
    ]
    kinds += ["constant"] * bool(numbers)
    symbols = [x for x in ("a", "b") if indexed(getattr(node, x))]
    kinds += ["index"] * bool(symbols)
    kind = draw.choice(kinds)
    if kind == "sign":
        node.op = SUB if node.op == ADD else ADD
    elif kind == "constant":
        setattr(node, numbers[0], getattr(node, numbers[0]) * 1.00001)
    elif kind == "index":
        old = getattr(node, symbols[0])
        other: Any = Node(old.dag, SYMBOL, old.a, old.b - 1)
        other.index = old.index - 0.5  # programs run in the order of construction
        setattr(node, symbols[0], other)
    else:
        place = "b" if isinstance(node.b, Node) else "a"
        earlier = [x for x in nodes if x.index < node.index and x is not getattr(node, place)]
        if not earlier or not isinstance(getattr(node, place), Node):
            return ""
        setattr(node, place, draw.choice(earlier))
    return kind


def indexed(x: Any) -> bool:
    """Whether it is a symbol that has a neighbour before it."""
    return isinstance(x, Node) and x.op == SYMBOL and isinstance(x.b, int) and x.b > 0


def missed(
    monkeypatch: pytest.MonkeyPatch, model: lg.Model, count: int, seed: int
) -> tuple[int, list[str]]:
    """How many mutants were tried, and those that `check` finds good though they make a difference."""
    from linegraph.programs.register import module_of
    from linegraph.verification.checking import run as running

    derivation = lg.derive(model)
    module = module_of(derivation, "checked")
    points = {s: running._points(derivation, s) for s in (0, 1)}
    monkeypatch.setattr(running, "module_of", lambda *_, **__: module)
    monkeypatch.setattr(running, "_points", lambda _, s: points[s])
    draw, programs = random.Random(seed), operations(module)
    tried, found = 0, []
    for k in range(count):
        nodes = programs[k % len(programs)]
        node = draw.choice(nodes)
        before = (node.op, node.a, node.b)
        kind = mutate(node, nodes, draw)
        forget(module)
        if kind:
            tried += 1
            try:
                good = checking.check(derivation).good
                # what makes no difference at other states either is no fault
                if good and checking.check(derivation, 1).program > 1e-13:
                    found.append(f"{kind} of {node} ({node.label})")
            except (ArithmeticError, ValueError, LinegraphError):
                pass  # no number comes out: noticed
        node.op, node.a, node.b = before
    forget(module)
    return tried, found


def forget(module: Module) -> None:
    """Programs keep the list of their operations, which are not meant to change."""
    for program in module.programs:
        vars(program).pop("live", None)


MUTATED = ("double_pendulum", "four_bar", "cart_pole_motor", "heavy_top")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Models whose programs are mutated: some examples, or all models of tests with ``--all-forms``."""
    if "mutated_model" in metafunc.fixturenames:
        every = [name for name in targets.everything() if not name.endswith(targets.MORE)]
        wanted = every if metafunc.config.getoption("--all-forms") else MUTATED
        metafunc.parametrize("mutated_model", wanted)


def test_mutants_of_the_equations_are_seen(
    monkeypatch: pytest.MonkeyPatch, mutated_model: str, request: pytest.FixtureRequest
) -> None:
    """Signs, constants, indices and operands of M, h and forward dynamics, one at a time."""
    count = 13 if request.config.getoption("--all-forms") else 8
    model = targets.everything()[mutated_model]()
    tried, found = missed(monkeypatch, model, count, 7)
    assert tried >= count // 2
    assert found == []


# ---- where laws are defined

SLIDE = """
[body.b]
mass = 1
[prismatic.p]
between = ["ground", "b"]
axis = [1, 0, 0]
effort = false
[inputs]
flow = {{ unit = "m^3/s" }}
[law.orifice]
joint = "p"
force = "{law}"
{check}
"""


def test_a_law_with_a_limited_domain_is_drawn_inside_it() -> None:
    assert checking.check(lg.derive(parsed(SLIDE.format(law="sqrt(flow)", check="")))).good
    assert checking.check(lg.derive(parsed(SLIDE.format(law="log(p)", check="")))).good


def test_a_law_that_is_defined_nowhere_is_named_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "valve.toml"
    path.write_text(SLIDE.format(law="sqrt(flow - 5)", check=""), encoding="utf-8")
    done = CliRunner().invoke(main, ["check", str(path)])
    assert done.exit_code == 2
    assert 'valve.toml:10: law "orifice": sqrt(-' in done.output
    assert "[check] with inputs" in done.output
    done = CliRunner().invoke(main, ["emit", str(path), "--tests", "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert 'valve.toml:10: law "orifice"' in done.output


def test_a_network_says_whose_law_is_not_defined(tmp_path: Path) -> None:
    text = (
        '[inputs]\nu0 = { unit = "V" }\n[voltage_source.s]\nbetween = ["a", "ground"]\n'
        'voltage = "sqrt(u0 - 3)"\n[resistor.R]\nbetween = ["a", "b"]\nresistance = 2\n'
        '[capacitor.C]\nbetween = ["b", "ground"]\ncapacitance = 1e-6\n'
    )
    with pytest.raises(ModelError, match=r'm.toml:3: voltage_source "s": sqrt'):
        checking.check(lg.derive(parsed(text)))
    assert checking.check(lg.derive(parsed(text + "[check]\ninputs = { u0 = [3.5, 9] }\n"))).good


@pytest.mark.parametrize(
    ("law", "check"),
    [
        ("sqrt(flow - 5)", "inputs = { flow = [5.5, 9] }"),
        ("log(p - 3)", "coordinates = { p = [3.1, 4] }"),
        ("log(der(p) - 3)", "velocities = { p = [3.1, 4] }"),
        ("flow*sqrt(t - 3)", "t = [4, 5]"),
    ],
)
def test_check_bounds_what_is_drawn(law: str, check: str) -> None:
    model = parsed(SLIDE.format(law=law, check=f"[check]\n{check}"))
    assert checking.check(lg.derive(model)).good
    bare = parsed(SLIDE.format(law=law, check=""))
    with pytest.raises(ModelError, match="at all states that were tried"):
        checking.check(lg.derive(bare))


def test_golden_vectors_keep_the_bounds() -> None:
    from linegraph.emission.emit import module_for
    from linegraph.verification import golden

    model = parsed(SLIDE.format(law="sqrt(flow - 5)", check=""))
    model.check_within(inputs={"flow": (5.5, 9)}, coordinates={"p": (2, 3)})
    found = golden.vectors(lg.derive(model), module_for(model, "m"))
    assert all(5.5 <= u <= 9 for (u,) in found.given["u"])
    assert all(2 <= q <= 3 for (q,) in found.given["q"])


@pytest.mark.parametrize(
    ("check", "problem"),
    [
        ("inputs = { flaw = [0, 1] }", "inputs: there is no flaw.*flow"),
        ("coordinates = { x = [0, 1] }", "coordinates: there is no x"),
        ("velocities = { x = [0, 1] }", "velocities: there is no x"),
        ("parameters = { k = [0, 1] }", "parameters: there is no k"),
    ],
)
def test_bounds_of_what_is_not_there_are_refused(check: str, problem: str) -> None:
    model = parsed(SLIDE.format(law="flow", check=f"[check]\n{check}"))
    with pytest.raises(ModelError, match=rf"m.toml:13: check: {problem}"):
        checking.check(lg.derive(model))


@pytest.mark.parametrize(
    ("check", "problem"),
    [
        ("inputs = { flow = [2, 1] }", "the lower bound 2 is above the upper bound 1"),
        ("inputs = { flow = [1] }", r"a list \[low, high\] is wanted"),
        ("inputs = 3", "a table NAME = "),
        ("t = 3", r"a list \[low, high\] is wanted"),
        ("speed = [0, 1]", 'unknown key "speed"'),
    ],
)
def test_a_wrong_check_table_is_refused(check: str, problem: str) -> None:
    with pytest.raises(LinegraphError, match=f"m.toml:14: .*{problem}"):
        parsed(SLIDE.format(law="flow", check=f"[check]\n{check}"))


@pytest.mark.parametrize("pair", [(2, 1), (0, float("nan")), (0, float("inf")), 3, (1,)])
def test_the_builder_refuses_wrong_bounds(pair: Any) -> None:
    with pytest.raises(ModelError, match="check: inputs flow: "):
        lg.Model("m").check_within(inputs={"flow": pair})


# ---- what is told


def test_one_of_a_kind_is_no_plural() -> None:
    text = told(parsed(MIRROR))
    assert "1 degree of freedom, 1 input\n" in text
    assert "2 degrees of freedom, 1 state of networks, 1 input\n" in told(
        example("cart_pole_motor")
    )
    assert counted(0, "input") == "0 inputs"


def test_what_was_compared_is_told() -> None:
    text = told(example("gyroscope"))
    assert "emitted program and Newton-Euler" in text
    assert "M, h, M a + h, accelerations" in text
    assert "power balance: prescribed motion does work" in text


def test_what_the_structure_forbids_is_no_matter_of_bounds() -> None:
    """A rotor turns with a joint that absolute coordinates leave out: no states would help."""
    model = example("cart_pole_motor")
    model.formulation(coordinates="absolute")
    with pytest.raises(ModelError, match=r"keep joint coordinates there$"):
        checking.check(lg.derive(model))


def test_a_mass_on_an_axis_has_none_about_it_but_for_rounding() -> None:
    """A particle hangs on a rope without mass: about the rope nothing turns, and that is no error."""
    model = example("crane")
    model.formulation(coordinates="absolute")
    assert checking.check(lg.derive(model)).good


DRIVEN = """
[body.b]
mass = 2
inertia = [1, 1, 1]
[body.c]
mass = 1
mass_center = [0, 0, -0.5]
inertia = [0.1, 0.1, 0.1]
[prismatic.p]
between = ["ground", "b"]
axis = [1, 0, 0]
[revolute.r]
between = ["b", "c"]
axis = [0, 1, 0]
[driver.d]
between = ["ground", "b"]
x = "input"
"""


def test_a_body_that_an_input_moves_is_drawn_where_the_input_says() -> None:
    model = parsed(DRIVEN)
    found = checking.check(lg.derive(model))
    assert found.good
    assert "multipliers" in {c.what for c in found.comparisons}

"""Base parameters: as many as the regressor has rank, and beta = B pi gives the same torques.

Their sums are compared with published ones where there are some: the planar arm, the Staubli RX90 by Khalil
and Dombre's formulas, and the numbers of 36 for a PUMA and of 40 with rotors.
"""

from __future__ import annotations

import math
import random
import re
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy
from click.testing import CliRunner
from support.spec_models import model_of
from systems import random_systems as systems
from systems import random_trees as trees

from linegraph import Model, ModelError, derive
from linegraph.algebra.sampled import Traced, closed, given, kernel, reduced
from linegraph.cli.main import main
from linegraph.emission.emit import module_for
from linegraph.identification.search import in_numbers, regressor_rows
from linegraph.identification.standard_parameters import axes
from linegraph.readers import modelfile, urdf

if TYPE_CHECKING:
    from linegraph.identification.base_parameters import BaseParameters
    from linegraph.numeric.reference import Numeric

    Array = Any

ROOT = Path(__file__).parents[2]
EXACT = 1e-12
"""Of Y pi - Y_b beta, relative to the largest torque; measured 4e-15, and 5e-13 for one robot with mimics."""
GAP = 1e-8
"""Least singular value of Y_b with columns of one length, relative to the largest; measured 5e-5 and more."""
FEW = ("panda", "ur5_robot", "solo12", "tiago_pro", "simple_humanoid")
TWENTY = (
    *FEW,
    *(
        "a1",
        "alex_nub_hands",
        "allegro_left_hand",
        "anymal-kinova",
        "baxter",
        "bolt",
        "double_pendulum",
    ),
    *(
        "finger_edu",
        "g1_29dof_rev_1_0",
        "go2",
        "human",
        "icub",
        "iris",
        "kinova",
        "pr2",
        "so101",
    ),
    *("talos_full_v2", "talos_reduced", "tiago", "xarm7", "z1"),
)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "file" in metafunc.fixturenames:
        peers = pytest.importorskip("oracles.pinocchio_models")
        wanted = TWENTY if metafunc.config.getoption("--all-robots") else FEW
        files = {file.stem: file for file in peers.urdf_files()}
        metafunc.parametrize("file", [files[name] for name in wanted], ids=wanted)


def sample_of(model: Model) -> tuple[BaseParameters, Numeric]:
    """Base parameters, and the model at random values of its parameters."""
    derivation = derive(model)
    draw = random.Random(11)
    values = {
        p.name: (p.value or 1.0) * draw.uniform(0.5, 2)
        for p in model.parameters.values()
        if not p.derived
    }
    u = [draw.uniform(-1, 1) for _ in derivation.structure.inputs]
    return derivation.base_parameters(), derivation.numeric(values, 0.4, u)


def require_minimal(model: Model) -> BaseParameters:
    """Y pi = Y_b B pi at random states, and Y_b has full rank."""
    base, numeric = sample_of(model)
    derivation = base.derivation
    seen = axes(derivation.structure)
    numerics = in_numbers(derivation, numeric, 7)
    states = (3 * base.count // len(derivation.structure.velocities) + 12) // len(numerics) + 2
    Y = regressor_rows(numerics, seen, states, random.Random(5))
    values = {
        p.name: numeric.parameters[p.name] for p in model.parameters.values() if not p.derived
    }
    pi = np.random.default_rng(0).normal(size=len(base.names))
    tau = Y @ pi
    error = np.abs(Y[:, base.independent] @ (base.matrix(values) @ pi) - tau).max()
    assert error < EXACT * np.abs(tau).max()
    # friction's columns depend on the joint's own rate alone, and are left out there
    moving = [
        k
        for k in base.independent
        if base.names[k].rpartition(".")[2] not in ("damping", "friction")
    ]
    Yb = Y[:, moving]
    Yb = Yb / np.linalg.norm(Yb, axis=0)
    singular = np.linalg.svd(Yb, compute_uv=False)
    assert singular[-1] > GAP * singular[0]
    assert sorted((*base.independent, *base.dependent)) == list(range(len(base.names)))
    for place in base.without_effect:
        assert not Y[:, place].any() or np.abs(Y[:, place]).max() < 1e-12
    return base


# ---- known sets


def planar(gravity: tuple[Any, ...]) -> Model:
    model = Model("planar", gravity=gravity)
    l1 = model.parameter("l1", 0.4)
    upper, lower = (model.body(name, mass=1.0, inertia=(0, 0, 0.1)) for name in ("upper", "lower"))
    model.revolute("q1", ("ground", upper))
    model.revolute("q2", (upper.frame("end", (l1, 0, 0)), lower))
    return model


def sums(base: BaseParameters) -> dict[str, Any]:
    """Each base parameter by the name of its own; of friction nothing."""
    pairs = zip(base.independent, base.expressions, strict=True)
    found = {base.names[place]: expression for place, expression in pairs}
    return {name: x for name, x in found.items() if not name.endswith(("damping", "friction"))}


def symbols(text: str) -> list[sympy.Symbol]:
    return [sympy.Symbol(name) for name in text.split()]


def test_the_planar_arm() -> None:
    m2, l1, J1, J2 = symbols("lower.m l1 upper.Izz lower.Izz")
    mx1, my1, mx2, my2, a1, a2 = symbols(
        "upper.mx upper.my lower.mx lower.my q1.armature q2.armature"
    )
    base = require_minimal(planar((0, -9.81, 0)))
    assert sums(base) == {
        "upper.mx": mx1 + l1 * m2,
        "upper.my": my1,
        "upper.Izz": J1 + l1**2 * m2 + a1,
        "lower.mx": mx2,
        "lower.my": my2,
        "lower.Izz": J2,
        "q2.armature": a2,
    }
    # in a plane that is level the inner link's first moment does nothing
    base = require_minimal(planar((0, 0, -9.81)))
    gone = {base.names[place] for place in base.without_effect}
    assert {"upper.mx", "upper.my", "upper.m"} <= gone
    assert "lower.mx" not in gone


def rx90() -> Model:
    """By alpha, d and r of the modified notation of Denavit and Hartenberg."""
    model = Model("rx90")
    d3, r4 = model.parameter("D3", 0.45), model.parameter("RL4", 0.45)
    half = math.pi / 2
    near: Any = model.ground
    table = [(0, 0, 0), (half, 0, 0), (0, d3, 0), (-half, 0, r4), (half, 0, 0), (-half, 0, 0)]
    for k, (alpha, d, r) in enumerate(table, 1):
        body = model.body(f"L{k}", mass=1.0, mass_center=(0.1, 0.2, 0.1), inertia=(0.1, 0.2, 0.3))
        s, c = round(math.sin(alpha)), round(math.cos(alpha))
        at = (d, -s * r if s else 0, c * r if c else 0)
        model.revolute(f"q{k}", (near.frame(f"f{k}", at, rpy=(alpha, 0, 0)), body))
        near = body
    return model


def test_the_rx90_by_khalil_and_dombre() -> None:
    base = require_minimal(rx90())
    found = sums(base)
    assert len(found) == 40
    D3, R = symbols("D3 RL4")

    def p(part: str) -> sympy.Symbol:
        return sympy.Symbol(f"L{part[-1]}.{part[:-1]}")

    m3, m4 = (sum(p(f"m{k}") for k in range(first, 7)) for first in (3, 4))
    a = [sympy.Symbol(f"q{k}.armature") for k in range(7)]
    expected = {
        "L1.Izz": a[1] + p("Izz1") + p("Iyy2") + D3**2 * m3 + p("Iyy3"),
        "L2.Ixx": p("Ixx2") - p("Iyy2") - D3**2 * m3,
        "L2.Ixz": p("Ixz2") - D3 * p("mz3"),
        "L2.Izz": a[2] + p("Izz2") + D3**2 * m3,
        "L2.mx": p("mx2") + D3 * m3,
        "L3.Ixx": p("Ixx3") - p("Iyy3") + p("Iyy4") + 2 * R * p("mz4") + R**2 * m4,
        "L3.Izz": p("Izz3") + p("Iyy4") + 2 * R * p("mz4") + R**2 * m4,
        "L3.my": p("my3") + p("mz4") + R * m4,
        "L4.Ixx": p("Ixx4") - p("Iyy4") + p("Iyy5"),
        "L4.Izz": p("Izz4") + p("Iyy5"),
        "L4.my": p("my4") - p("mz5"),
        "L5.Ixx": p("Ixx5") - p("Iyy5") + p("Iyy6"),
        "L5.Izz": p("Izz5") + p("Iyy6"),
        "L5.my": p("my5") + p("mz6"),
        "L6.Ixx": p("Ixx6") - p("Iyy6"),
    }
    for name, x in expected.items():
        assert sympy.expand(found.pop(name) - x) == 0, name
    own = {name for name, x in found.items() if x == sympy.Symbol(name)}
    assert own == set(found)
    assert {f"q{k}.armature" for k in (3, 4, 5, 6)} <= own


def test_the_puma_has_36_without_rotors_and_40_with() -> None:
    base = require_minimal(modelfile.read("examples/arm_with_drives/arm_with_drives.toml"))
    names = [base.names[k] for k in base.independent]
    assert (
        sum(name.split(".")[1] not in ("damping", "friction", "armature") for name in names) == 36
    )
    assert [name for name in names if name.endswith("armature")] == [
        f"{joint}.armature" for joint in ("elbow", "roll", "pitch", "flange")
    ]


def test_a_stanford_arm_has_a_slide() -> None:
    """Two crossed hinges, a slide, and a wrist of three: of the slide's link the second moments go inward."""
    model = Model("stanford")
    d2 = model.parameter("d2", 0.15)
    half = math.pi / 2
    bodies = [
        model.body(f"L{k}", mass=1.0, mass_center=(0.1, 0.2, 0.1), inertia=(0.1, 0.2, 0.3))
        for k in range(1, 7)
    ]
    turns = [0, -half, half, 0, -half, half]
    near: Any = model.ground
    for k, (body, alpha) in enumerate(zip(bodies, turns, strict=True), 1):
        tail = near.frame(f"f{k}", (0, d2 if k == 2 else 0, 0), rpy=(alpha, 0, 0))
        add = model.prismatic if k == 3 else model.revolute
        add(f"q{k}", (tail, body))
        near = body
    found = sums(require_minimal(model))
    # the slide keeps its mass and first moments at most, and hands over what turns with it
    kept = {name.split(".")[1] for name in found if name.startswith("L3.")}
    assert kept <= {"m", "mx", "my", "mz"}
    I2, I3, I4 = symbols("L2.Ixx L3.Ixx L4.Iyy")
    assert {I3, I4} <= found["L2.Ixx"].free_symbols | found["L2.Izz"].free_symbols
    assert I2 in found["L2.Ixx"].free_symbols


def test_a_floating_base_shows_all_its_parameters() -> None:
    model = urdf.read(robot("solo12"), base="floating")
    base = require_minimal(model)
    kept = [base.names[k] for k in base.independent][:10]
    assert kept == [
        f"base_link.{part}"
        for part in ["m", "mx", "my", "mz", "Ixx", "Ixy", "Iyy", "Ixz", "Iyz", "Izz"]
    ]
    assert not base.without_effect


def test_symbolic_offsets_of_a_robot() -> None:
    base = require_minimal(urdf.read(robot("ur5_robot"), symbolic=True))
    assert base.count == 52
    assert any(
        x.free_symbols & {sympy.Symbol(p) for p in base.derivation.system.parameters}
        for x in base.K
    )


def test_a_rotor_behind_a_gear_with_a_symbolic_ratio() -> None:
    """Its inertia is a sum of the joint's, the armature's and the inner link's."""
    model = planar((0, -9.81, 0))
    n, J = model.parameter("n", 30.0), model.parameter("J", 1e-4)
    model.rotor("r2", "q2", J, n)
    found = sums(require_minimal(model))
    r, n = symbols("r2.Izz n")
    assert sympy.simplify(found["lower.Izz"].coeff(r) - n) == 0
    assert sympy.simplify(found["q2.armature"].coeff(r) - (n**2 - n)) == 0
    assert sympy.simplify(found["upper.Izz"].coeff(r) - (1 - n)) == 0


def test_a_symbolic_twist_of_axes() -> None:
    """Sine and cosine of a parameter: their squares add up to 1 in the sums."""
    model = Model("twisted")
    alpha, length = sympy.Symbol("alpha"), model.parameter("l", 0.5)
    model.parameter("alpha", 0.3)
    near: Any = model.ground
    c, s = sympy.cos(alpha), sympy.sin(alpha)
    for k in range(3):
        body = model.body(f"b{k}", mass=1.0, mass_center=(0.1, 0.2, 0.1), inertia=(0.1, 0.2, 0.3))
        rows = ((1, 0, 0), (0, c, -s), (0, s, c))
        model.revolute(f"q{k}", (near.frame(f"f{k}", (length, 0, 0), rotation=rows), body))
        near = body
    base = require_minimal(model)
    found = sums(base)
    m, mz, length = symbols("b2.m b2.mz l")
    assert sympy.simplify(found["b1.mx"].coeff(m) - length) == 0
    assert sympy.simplify(found["b1.my"].coeff(mz) + s) == 0
    # the first axis is not upright; of the outer links Khalil's seven, and their rotors' inertias
    assert len(found) == 3 + 7 + 7 + 2


def test_an_angle_that_some_parameters_do_not_have() -> None:
    model = Model("m")
    model.parameter("a", 0.9)
    model.parameter("b", 1.0)
    model.parameter("angle", "acos(a/b)")
    near: Any = model.ground
    for k, turn in enumerate((0, sympy.Symbol("angle"))):
        body = model.body(f"b{k}", mass=1.0, mass_center=(0.1, 0, 0.1), inertia=(0.1, 0.1, 0.1))
        model.revolute(f"q{k}", (near.frame(f"f{k}", (0.1, 0, 0), rpy=(turn, 0, 0)), body))
        near = body
    found = sums(derive(model).base_parameters())
    cosine = sympy.Symbol("a") / sympy.Symbol("b")
    factor = found["b0.Izz"].coeff(sympy.Symbol("b1.Iyy"))
    assert (
        abs(float((factor - 1 + cosine**2).subs({"a": 0.8, "b": 0.9, "angle": math.acos(8 / 9)})))
        < 1e-14
    )


# ---- everything else


@pytest.mark.parametrize("seed", [4, 6, 8, 10, 14, 20, 22, 54, 30])
def test_random_trees(seed: int) -> None:
    """With joints that follow others; that of seed 54 is crossed from its head."""
    rng = np.random.default_rng(seed)
    require_minimal(model_of(trees.random_tree(rng, bodies=1 + seed % 8)))


@pytest.mark.parametrize("seed", [1, 3, 5, 10, 14, 16, 19, 22, 77])
def test_random_systems(seed: int) -> None:
    """All joints; coupled and prescribed ones, whose further relations only numbers show."""
    require_minimal(systems.random_system(seed).model)


@pytest.mark.parametrize(
    "name", ["cart_pole", "excavator_arm", "four_bar", "furuta", "gyroscope", "crane"]
)
def test_examples(name: str) -> None:
    require_minimal(modelfile.read(f"examples/{name}/{name}.toml"))


def test_robots(file: Path) -> None:
    """Angles rounded to 1.5708 and the like are taken for what they mean."""
    require_minimal(urdf.read(file, snap=1e-4))


def test_axes_that_are_not_quite_parallel_keep_their_parameters() -> None:
    exact, rounded = (urdf.read(robot("xarm7"), snap=snap) for snap in (1e-4, 1e-11))
    assert derive(rounded).base_parameters().count > derive(exact).base_parameters().count


def test_coupled_joints_apart_with_symbolic_lengths_are_refused() -> None:
    model = planar((0, -9.81, 0))
    model.couple("q2", "q1", ratio=model.parameter("n", 2.0))
    with pytest.raises(ModelError, match="factors that depend on other parameters"):
        derive(model).base_parameters()


def test_numbers() -> None:
    base = derive(planar((0, -9.81, 0))).base_parameters()
    B = base.matrix()
    assert np.abs(B[:, base.dependent] - base.relation()).max() == 0
    assert (B[:, base.independent] == np.eye(base.count)).all()
    assert np.abs(base.values() - B @ base.standard()).max() == 0
    assert np.abs(np.array(base.K.subs("l1", 0.4), dtype=float) - base.relation()).max() < 1e-15
    longer = base.relation({"l1": 0.8})
    assert longer.max() == base.relation().max() == 1.0
    assert base.values({"l1": 0.8})[0] == pytest.approx(2 * base.values()[0])
    with pytest.raises(ModelError, match="l2"):
        base.relation({"l2": 1.0})


def test_the_table() -> None:
    base = derive(planar((0, -9.81, 0))).base_parameters()
    lines = str(base).splitlines()
    assert lines[0] == "11 base parameters of planar, of 26 standard parameters"
    assert lines[3].split(None, 2) == [
        "upper.Izz",
        "kg*m^2",
        "upper.Izz + l1^2*lower.m + q1.armature",
    ]
    assert lines[-2].startswith("by themselves: q1.damping, q1.friction")
    assert lines[-1].startswith("without effect: upper.m, ")
    assert repr(base) == "<11 base parameters of planar, of 26 standard ones>"
    html = base._repr_html_()
    assert html.count("<tr>") == 7
    assert "upper.Izz + l1^2*lower.m" in html


def test_the_command() -> None:
    done = CliRunner().invoke(main, ["parameters", "examples/double_pendulum/double_pendulum.toml"])
    assert done.exit_code == 0
    assert "base parameters of double_pendulum" in done.output
    done = CliRunner().invoke(main, ["parameters", "examples/cauer_filter/cauer_filter.toml"])
    assert done.exit_code == 2
    assert "has no links that move" in done.output


def test_the_example_of_the_documentation() -> None:
    text = (ROOT / "docs" / "identification.md").read_text(encoding="utf-8")
    code, table = (block.split("\n", 1)[1] for block in text.split("```")[1:4:2])
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.stderr == ""
    assert done.stdout.strip() == table.strip()
    (cost,) = re.findall(r"Y costs (\d+) operations for a Panda", text)
    model = urdf.read(robot("panda"))
    (program,) = module_for(model, "m", folded=True, only=["regressor"]).programs
    assert program.operations == int(cost)


# ---- linear algebra with symbols


def test_what_cancels_is_zero_and_what_is_a_number_is_one() -> None:
    draw = random.Random(0)
    angles = [draw.uniform(0, 3) for _ in range(3)]
    c, s = (given(x, [f(a) for a in angles], 0.0) for x, f in ((0.3, math.cos), (0.4, math.sin)))
    assert c * c + s * s == 1
    assert c * s - s * c == 0
    assert isinstance(c + s, Traced)
    assert 2 * c - c - c == 0
    assert (c / c) == 1
    # small is not zero
    small = given(1e-9, [1e-9, 2e-9, 3e-9], 0.0)
    assert isinstance(small * small, Traced)
    assert (1 + small) - 1 != 0


def test_reduction_kernel_and_closure() -> None:
    rows = [[1, 2, 3], [2, 4, 6], [0, 1, 1]]
    done, pivots = reduced(rows, [2, 1, 0])
    assert len(done) == 2
    assert sorted(pivots) == [1, 2]
    for x in kernel(rows, 3):
        assert all(sum(a * b for a, b in zip(row, x, strict=True)) == 0 for row in rows)
    assert len(kernel(rows, 3)) == 1
    turned = closed([[1, 0, 0]], lambda row: [-row[1], row[0], 0])
    assert len(turned) == 2


def robot(name: str) -> Path:
    peers = pytest.importorskip("oracles.pinocchio_models")
    (file,) = (file for file in peers.urdf_files() if file.stem == name)
    return file

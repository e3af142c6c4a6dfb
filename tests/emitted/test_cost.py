"""What emitted code costs, counted: operations may go down, never up."""

from __future__ import annotations

import math
import random
import subprocess
import sys
from pathlib import Path

import pytest
from benchmarks import operations
from oracles.pinocchio_models import robots_folder

from linegraph import Model
from linegraph.emission.emit import module_for, render
from linegraph.ir.program import Program
from linegraph.readers.read import read

MOST = {
    # M and h together, M, h, inverse and forward dynamics when last measured, signs free; forward dynamics
    # by factors calls M and h
    "panda": (783, 320, 544, 571, 244),
    "ur5": (285, 98, 207, 266, 392),
    "solo12": (1398, 496, 1069, 1148, 2328),
    "anymal": (1449, 539, 1269, 1364, 2581),
    "talos": (5861, 3009, 3475, 3589, 7792),
}
SLOPES_MOST = {
    # inverse_dynamics_derivatives, linearize; CasADi's Jacobians of Pinocchio's rnea and aba take 13589 and
    # 23237 for the Panda, 4702 and 10077 for the UR5
    "panda": (2557, 4535),
    "ur5": (869, 1835),
    "anymal": (4744, 18913),
    "talos": (21304, 109148),
}
CHAINS_MOST = {10: 2912, 20: 7769, 40: 20419}
PLANAR_MOST = 2058
RX90_MOST = 407


def chain(links: int) -> Model:
    """Revolute links one after the other, with turned axes and rotated frames."""
    model = Model("chain")
    before = model.ground
    for i in range(links):
        tip = before.frame("tip", at=(0.1, 0.0, 0.5), rpy=(0.3, 0.2, 0.1))
        before = model.body(
            f"b{i}", mass=1.0, mass_center=(0.1, 0.2, 0.3), inertia=(0.1, 0.2, 0.25)
        )
        axis = ((0, 0, 1), (1, 0, 0), (0, 1, 0))[i % 3]
        model.revolute(f"j{i}", between=(tip, before), axis=axis)
    return model


def planar_chain(links: int) -> Model:
    """Links of different inertia about parallel axes."""
    model = Model("planar")
    before = model.ground
    for i in range(links):
        tip = before.frame("tip", at=(0.5, 0.0, 0.0))
        before = model.body(
            f"b{i}", mass=1.0, mass_center=(0.1 + 0.01 * i, 0.0, 0.0), inertia=(0.1, 0.2, 0.25)
        )
        model.revolute(f"j{i}", between=(tip, before), axis=(0, 0, 1))
    return model


def rx90() -> Model:
    """The geometry of the RX90 arm (modified Denavit-Hartenberg: alpha, d, r), inertias in full."""
    quarter = math.pi / 2
    rows = [
        (0, 0, 0),
        (-quarter, 0, 0),
        (0, 0.45, 0),
        (-quarter, 0, 0.45),
        (quarter, 0, 0),
        (-quarter, 0, 0),
    ]
    draw = random.Random(0)
    model = Model("rx90")
    before = model.ground
    for i, (alpha, d, r) in enumerate(rows):
        at = (d, -r * math.sin(alpha), r * math.cos(alpha))
        tip = before.frame("tip", at=at, rpy=(alpha, 0, 0))
        center = tuple(draw.uniform(-0.1, 0.1) for _ in "xyz")
        inertia = {"xx": 1.1, "yy": 1.2, "zz": 0.9, "xy": 0.01, "xz": 0.02, "yz": 0.03}
        before = model.body(f"b{i}", mass=1.0 + i, mass_center=center, inertia=inertia)
        model.revolute(f"j{i}", between=(tip, before), axis=(0, 0, 1))
    return model


def counts(model: Model) -> dict[str, int]:
    """Operations of each function of a model, its numbers folded."""
    programs = module_for(model, "model", folded=True).programs
    return {p.name: p.operations for p in programs if isinstance(p, Program)}


FUNCTIONS = ("equations", "mass_matrix", "bias", "inverse_dynamics", "forward_dynamics")


@pytest.mark.parametrize("robot", MOST)
def test_operations_of_known_robots(robot: str) -> None:
    if robots_folder() is None:
        pytest.skip("the example-robot-data wheel is not installed")
    counted = operations.operations(operations.emitted(robot), signs=False)
    found = tuple(counted[f"{robot}_{name}"] for name in FUNCTIONS)
    assert all(count <= most for count, most in zip(found, MOST[robot], strict=True)), found
    assert found[0] < found[1] + found[2]


@pytest.mark.parametrize("robot", SLOPES_MOST)
def test_operations_of_derivatives(robot: str) -> None:
    folder = robots_folder()
    if folder is None:
        pytest.skip("the example-robot-data wheel is not installed")
    file, base, locks = operations.WATCHED[robot]
    model = read(folder / file, base=base)
    for joint in locks:
        model.lock(joint)
    wanted = ("inverse_dynamics_derivatives", "linearize")
    made = module_for(model, robot, folded=True, only=wanted).programs
    found = {p.name: p.operations for p in made if isinstance(p, Program)}
    pairs = zip(wanted, SLOPES_MOST[robot], strict=True)
    assert all(found[name] <= most for name, most in pairs), found


def test_operations_of_chains() -> None:
    """In space they grow with an exponent of 1.4, in a plane almost as the entries of M do."""
    for links, most in CHAINS_MOST.items():
        assert counts(chain(links))["equations"] <= most
    assert counts(planar_chain(30))["mass_matrix"] <= PLANAR_MOST


def test_operations_of_an_arm_that_is_a_yardstick() -> None:
    """The best classic customised Newton-Euler figure is 253 + 238 with full inertias, friction included."""
    assert counts(rx90())["bias"] <= RX90_MOST


def test_the_counter_counts_what_a_hand_counts() -> None:
    source = """
void f(const double q[1], double M[2 * 2])
{
    /* a - comment + with * signs */
    const double t0 = -cos(q[1]) * 1e-05 + p->m / 2.0;
    M[0] = t0 - 1.5;
}
"""
    assert operations.operations(source) == {"f": 6}


def test_the_program_and_the_text_agree() -> None:
    """Two counts of the same functions."""
    module = module_for(chain(4), "chain", folded=True)
    text = render(chain(4), folded=True, languages=["c"])["chain.c"]
    counted = operations.operations(text, signs=False)
    for program in (x for x in module.programs if isinstance(x, Program)):
        assert program.operations == counted[f"chain_{program.name}"]


def test_growth_of_inverse_dynamics_is_linear() -> None:
    def count(links: int) -> int:
        programs = module_for(chain(links), "chain").programs
        return next(p.operations for p in programs if p.name == "inverse_dynamics")

    ten, twenty, forty = count(10), count(20), count(40)
    assert forty - twenty == pytest.approx(2 * (twenty - ten), rel=0.02)


def test_long_chains_emit(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    """100 links, 200 with --all-forms, in a fresh process with the interpreter's own recursion limit."""
    sizes = (100, 200) if request.config.getoption("--all-forms") else (100,)
    script = (
        "import sys; sys.path[:0] = [sys.argv[1], sys.argv[2]]\n"
        "from test_cost import chain; import linegraph as lg\n"
        f"for n in {sizes}: lg.emit(chain(n), sys.argv[3], name=f'chain{{n}}')\n"
    )
    here = Path(__file__).parent
    command = [sys.executable, "-c", script, str(here), str(here.parent), str(tmp_path)]
    subprocess.run(command, check=True)
    assert {path.name for path in tmp_path.iterdir()} == {
        f"chain{n}.{ending}" for n in sizes for ending in ("h", "c", "py")
    }

"""What emitted code costs, counted: operations may go down, never up."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parent / "benchmarks"))

import operations
from pinocchio_models import robots_folder

from linegraph import Model
from linegraph.emission import module_for, render
from linegraph.program import Program

# what M and h together took when last measured; asked were 1300, 600 and 9000
MOST = {"panda": 958, "ur5": 430, "talos": 7013, "solo12": 1814}


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


@pytest.mark.parametrize("robot", MOST)
def test_operations_of_known_robots(robot: str) -> None:
    if robots_folder() is None:
        pytest.skip("the example-robot-data wheel is not installed")
    counted = operations.operations(operations.emitted(robot))
    assert counted[f"{robot}_equations"] <= MOST[robot]
    both = counted[f"{robot}_mass_matrix"] + counted[f"{robot}_bias"]
    assert counted[f"{robot}_equations"] <= both


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
    """Two counts of the same functions; the text repeats a sign where two results share it."""
    module = module_for(chain(4), "chain", folded=True)
    counted = operations.operations(render(chain(4), folded=True, languages=["c"])["chain.c"])
    for program in (x for x in module.programs if isinstance(x, Program)):
        text = counted[f"chain_{program.name}"]
        assert program.operations <= text <= program.operations * 1.05 + 2


def test_growth_of_inverse_dynamics_is_linear() -> None:
    def count(links: int) -> int:
        programs = module_for(chain(links), "chain").programs
        return next(p.operations for p in programs if p.name == "inverse_dynamics")

    ten, twenty, forty = count(10), count(20), count(40)
    assert forty - twenty == pytest.approx(2 * (twenty - ten), rel=0.02)


def test_long_chains_emit(tmp_path: Path) -> None:
    """100 and 200 links, in a fresh process with the interpreter's own recursion limit."""
    script = (
        "import sys; sys.path[:0] = [sys.argv[1], sys.argv[2]]\n"
        "from test_cost import chain; import linegraph as lg\n"
        "for n in (100, 200): lg.emit(chain(n), sys.argv[3], name=f'chain{n}')\n"
    )
    here = Path(__file__).parent
    command = [sys.executable, "-c", script, str(here), str(here.parent), str(tmp_path)]
    subprocess.run(command, check=True)
    assert {path.name for path in tmp_path.iterdir()} == {
        f"chain{n}.{ending}" for n in (100, 200) for ending in ("h", "c", "py")
    }

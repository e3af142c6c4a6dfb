"""What docs/closed_loops.md shows is true: its program compiles and prints what the page says."""

from __future__ import annotations

import cmath
import inspect
import math
import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.emitted import load

from linegraph.components.constraints import CONSTRAINTS
from linegraph.emission.emit import emit, render
from linegraph.readers import modelfile

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "closed_loops.md").read_text("utf-8")
README = (ROOT / "README.md").read_text("utf-8")
EXAMPLE = ROOT / "examples" / "four_bar" / "four_bar.toml"


def block(language: str, text: str = PAGE) -> str:
    """The one block of a page in a language."""
    (found,) = re.findall(rf"^```{language}\n(.*?)^```", text, re.M | re.S)
    return found


@pytest.fixture(scope="module")
def printed(tmp_path_factory: pytest.TempPathFactory) -> str:
    """What the page's program prints."""
    folder = tmp_path_factory.mktemp("four_bar")
    emit(modelfile.read(EXAMPLE), folder, languages=["c"])
    (folder / "main.c").write_text(block("c"))
    strict = ["-std=c99", "-pedantic", "-O1", "-Wall", "-Wextra", "-Werror"]
    sources = [str(folder / name) for name in ("main.c", "four_bar.c")]
    command = ["cc", *strict, f"-I{folder}", *sources, "-lm", "-o", str(folder / "main")]
    subprocess.run(command, check=True)
    done = subprocess.run([folder / "main"], check=True, capture_output=True, text=True)
    return done.stdout


def test_the_program_is_short_and_prints_what_the_page_says(printed: str) -> None:
    assert len(block("c").splitlines()) <= 20
    assert printed == block("text")


# ---- the same four-bar by hand, over complex numbers

CRANK, COUPLER, ROCKER, GROUND, DENSITY, GRAVITY = 0.1, 0.4, 0.3, 0.35, 2.0, 9.81
DAMPING, TORQUE, ANGLE, RATE = 0.01, 0.5, 0.8, 10.0
STEP = 1e-4


def directions(angle: float) -> tuple[complex, complex, complex]:
    """Of crank, coupler and rocker, the coupler above: two circles cut each other."""
    crank = cmath.exp(1j * angle)
    gap = GROUND - CRANK * crank
    along = (COUPLER**2 - ROCKER**2 + abs(gap) ** 2) / (2 * abs(gap))
    coupler = complex(along, (COUPLER**2 - along**2) ** 0.5) * gap / abs(gap) / COUPLER
    return crank, coupler, (COUPLER * coupler - gap) / ROCKER


def angles(angle: float) -> list[float]:
    """Motor, elbow and swing."""
    crank, coupler, rocker = directions(angle)
    return [angle, cmath.phase(coupler / crank), cmath.phase(rocker)]


def after(t: float, acceleration: float) -> float:
    """The crank's angle a moment later."""
    return ANGLE + RATE * t + acceleration * t * t / 2


def slope(of: Callable[[float], Any]) -> Any:
    """The derivative at t = 0, by differences of the fourth order."""
    near, far = (of(k * STEP) - of(-k * STEP) for k in (1, 2))
    return (8 * near - far) / (12 * STEP)


def energy(t: float, acceleration: float) -> float:
    """Kinetic and potential, of three slender bars."""

    def middles(time: float) -> list[complex]:
        crank, coupler, rocker = directions(after(time, acceleration))
        tip = CRANK * crank
        return [tip / 2, tip + COUPLER * coupler / 2, GROUND + ROCKER * rocker / 2]

    total = 0.0
    for k, length in enumerate((CRANK, COUPLER, ROCKER)):
        mass = DENSITY * length
        velocity = slope(lambda s, k=k: middles(t + s)[k])
        turn = slope(
            lambda s, k=k: cmath.phase(
                directions(after(t + s, acceleration))[k] / directions(after(t, acceleration))[k]
            )
        )
        total += mass * (abs(velocity) ** 2 + length**2 * turn**2 / 12) / 2
        total += mass * GRAVITY * middles(t)[k].imag
    return total


def test_the_numbers_are_those_of_a_four_bar(printed: str) -> None:
    """Positions and rates by trigonometry, accelerations by the power, the pin's force by moments."""
    rows = [[float(x) for x in line.split()[1:]] for line in printed.splitlines()]
    motor, elbow, swing = rows[:3]
    force = complex(rows[3][0], rows[4][0])
    q = angles(ANGLE)
    v = [slope(lambda t, k=k: angles(after(t, 0))[k]) for k in range(3)]
    power = TORQUE * RATE - DAMPING * v[2] ** 2
    missing = [slope(lambda t, a=a: energy(t, a)) - power for a in (0.0, 1.0)]
    crank = -missing[0] / (missing[1] - missing[0])
    a = [crank]
    for k in (1, 2):
        near, far = (
            sum(angles(after(s * n * STEP, crank))[k] for s in (1, -1)) - 2 * q[k] for n in (1, 2)
        )
        a.append((16 * near - far) / (12 * STEP**2))
    for found, expected in zip(zip(motor, elbow, swing, strict=True), (q, v, a), strict=True):
        assert found == pytest.approx(expected, rel=1e-5, abs=1e-5)
    # about the rocker's pivot: the knee's force, in the axes of its tail, the coupler; weight; the damper
    coupler, rocker = directions(ANGLE)[1:]
    arm, pin = ROCKER * rocker, force * coupler
    moment = (arm.conjugate() * pin).imag - DAMPING * v[2]
    moment -= DENSITY * ROCKER * GRAVITY * arm.real / 2
    assert DENSITY * ROCKER**3 / 3 * a[2] == pytest.approx(moment, rel=1e-4)


# ---- the tables


FAN = """
[body.fan]
mass = 0.1
inertia = [1e-4, 1e-4, 1e-4]
[revolute.fan]
between = ["rocker", "fan"]
axis = [0, 0, 1]
motion = "0.3"
"""


@pytest.fixture(scope="module")
def module(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The example with a fan that a motor turns, so that every function is there."""
    text = EXAMPLE.read_text("utf-8") + FAN
    model = modelfile.parse(text.encode(), EXAMPLE.name)
    files = render(model, languages=["python"], functions=["power"])
    return load(files, "four_bar", tmp_path_factory.mktemp("python"))


ROWS = re.findall(r"^\| `(\w+)\(([\w, ]*)\)` \|", PAGE, re.M)


@pytest.mark.parametrize(("name", "arguments"), ROWS)
def test_functions_take_what_the_page_says(name: str, arguments: str, module: Any) -> None:
    found = inspect.signature(getattr(module, name)).parameters
    assert ["p", *filter(None, arguments.split(", "))] == list(found)


def test_every_function_of_closed_systems_is_on_the_page(module: Any) -> None:
    def functions(of: Any) -> set[str]:
        public = {name: x for name, x in vars(of).items() if not name.startswith("_")}
        found = {name for name, x in public.items() if inspect.isfunction(x)}
        # what reads the constants of prepare does what its name without the ending does
        return {name for name in found if not name.endswith("_prepared")}

    known = {"mass_matrix", "bias", "equations", "inverse_dynamics", "coordinate_rates", "energy"}
    known |= {"rhs", "prepare"}
    assert functions(module) - known == {name for name, _ in ROWS}


def test_statuses_are_those_of_the_header() -> None:
    """A function that has one in the header has it in the table, and no other."""
    header = render(modelfile.read(EXAMPLE), languages=["c"])["four_bar.h"]
    stated = {}
    for comment, name in re.findall(r"/\*\*((?:(?!\*/).)*)\*/\s*int four_bar_(\w+)", header, re.S):
        found = set(re.findall(r"FOUR_BAR_(\w+)\s[*\s]*\(\d+\):", comment))
        assert found > {"NOT_FINITE_INPUT", "NOT_FINITE"}
        stated[name] = found - {"NOT_FINITE_INPUT", "NOT_FINITE"}
    prepared = {name for name in stated if name.endswith("_prepared")}
    for name in prepared:
        assert stated.pop(name) == stated[name.removesuffix("_prepared")], name
    table = {}
    for names, cell in re.findall(r"^\| (`[^|]*) \| ([^|]*`[A-Z_]+`.*) \|$", PAGE, re.M):
        for name in re.findall(r"`(\w+)`", names):
            table[name] = set(re.findall(r"`([A-Z_]+)`", cell))
    assert table.keys() <= stated.keys()
    callers = stated.keys() - table.keys()
    assert callers == {"reactions", "outputs", "rhs"}
    expected = table | dict.fromkeys(callers, table["forward_dynamics"])
    assert stated == expected


def test_the_step_of_the_page_passes_a_flat_position(tmp_path: Path) -> None:
    """Parallelograms fall from the upright through the horizontal, at 0.72 s, as their one equation says."""
    words: dict[str, Any] = {}
    exec(block("python"), words)
    path = ROOT / "examples" / "parallelograms" / "parallelograms.toml"
    files = render(modelfile.read(path), languages=["python"])
    parallelograms = load(files, "parallelograms", tmp_path)
    p, n = parallelograms.DEFAULT_PARAMETERS, parallelograms.NV
    start = parallelograms.complete(p, np.zeros(n), [0.0], [-1.0])
    handed = SimpleNamespace(
        project=lambda q, v: parallelograms.project(p, q, v), StatusError=parallelograms.StatusError
    )
    x, t = np.concatenate(start), 0.0
    while t < 0.9:
        x, step = words["passed"](
            handed, lambda x: parallelograms.rhs(p, x, np.zeros(parallelograms.NU)), x, 2e-3
        )
        t += step
    exact = solve_ivp(
        lambda _, y: [y[1], 3.5 / 3 * 9.81 * math.sin(y[0])],
        (0, t),
        [0.0, -1.0],
        rtol=1e-12,
        atol=1e-12,
    ).y[:, -1]
    assert abs(exact[0]) > 2.5
    assert [x[0], x[n]] == pytest.approx(exact, abs=1e-7)


def test_the_other_page_names_all_multipliers() -> None:
    other = (ROOT / "docs" / "model_file.md").read_text("utf-8")
    options = {"rod": {"length": 1}, "driver": {"x": 0, "y": 0, "z": 0}, "rolling": {"radius": 1}}
    for kind, make in CONSTRAINTS.items():
        limit = make("NAME", ("ground", "b"), **options.get(kind, {}))
        for quantity, _ in limit.equations():
            assert f"`{quantity.name}`" in other, quantity.name


# ---- the README


def test_the_commands_of_the_readme_run() -> None:
    for line in block("console", README).splitlines():
        command = line.replace(".venv/bin/linegraph", f"{sys.executable} -m linegraph").split()
        done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
        assert "motor" in done.stdout

"""What the README shows is true: its Python runs, its C compiles, its output is what is printed."""

from __future__ import annotations

import math
import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest
from support.emitted import load

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text()


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.MULTILINE | re.DOTALL)


def run(program: str, folder: Path) -> str:
    path = folder / "example.py"
    path.write_text(program)
    done = subprocess.run(
        [sys.executable, str(path)],
        cwd=folder,
        env={"PYTHONPATH": str(ROOT), "PATH": "/usr/bin"},
        check=True,
        capture_output=True,
        text=True,
    )
    return done.stdout


def test_two_commands_come_first() -> None:
    setup, tests = blocks("sh")
    assert "linegraph emit examples/" in setup
    assert "pytest" in tests


def test_the_python_example_prints_what_the_readme_says(tmp_path: Path) -> None:
    model, stages = blocks("python")
    assert len(model.strip().splitlines()) <= 20
    expected = blocks("text")[0]
    assert run(model, tmp_path) == expected
    assert {p.name for p in (tmp_path / "build" / "cart_pole").iterdir()} == {
        "cart_pole.h",
        "cart_pole.c",
        "cart_pole.py",
    }
    assert run(model + stages, tmp_path).startswith(expected)


def test_the_first_model_of_a_new_user(tmp_path: Path) -> None:
    """The commands of the README one after the other, fewer than ten."""
    (script,) = blocks("bash")
    commands = re.sub(r"<<'END'.*?^END$", "", script, flags=re.M | re.S)
    assert len(commands.splitlines()) < 10
    script = script.replace(".venv/bin/linegraph", f"{sys.executable} -m linegraph")
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", script],
        cwd=tmp_path,
        env={"PYTHONPATH": str(ROOT), "PATH": "/usr/bin:/bin"},
        check=True,
        capture_output=True,
        text=True,
    )
    assert "good" in done.stdout
    slide, swing = map(float, re.findall(r"= (-?[\d.]+)", done.stdout.splitlines()[-1]))
    # by hand: (M + m) x'' + m l cos p p'' = F - k x, (J + m l^2) p'' + m l cos p x'' = -m g l sin p
    m, length, cart, force, stiffness, x, p = 0.2, 0.3, 0.8, 2.0, 5.0, 0.1, 0.5
    inertia = m * length**2 / 3 + m * length**2
    cosine, sine = math.cos(p), math.sin(p)
    a, b, c = cart + m, m * length * cosine, inertia
    right = (force - stiffness * x, -m * 9.81 * length * sine)
    determinant = a * c - b * b
    assert slide == pytest.approx((right[0] * c - b * right[1]) / determinant, abs=1e-5)
    assert swing == pytest.approx((a * right[1] - b * right[0]) / determinant, abs=1e-5)


def test_the_c_example_compiles_and_runs(tmp_path: Path) -> None:
    emit_panda(tmp_path)
    (tmp_path / "main.c").write_text(blocks("c")[0])
    compile_and_run(tmp_path / "main.c", tmp_path)


def test_the_panda_example_keeps_its_energy(tmp_path: Path) -> None:
    emit_panda(tmp_path)
    printed = compile_and_run(ROOT / "examples" / "panda" / "main.c", tmp_path)
    assert "panda_finger_joint1" in printed
    before, after = map(float, re.findall(r"(-?\d+\.\d+) J", printed))
    assert after == pytest.approx(before, abs=0.05)


@pytest.mark.parametrize("name", ["double_pendulum", "cart_pole"])
def test_python_examples_emit(name: str, tmp_path: Path) -> None:
    example = ROOT / "examples" / f"{name}.py"
    done = subprocess.run(
        [sys.executable, str(example), str(tmp_path)],
        env={"PYTHONPATH": str(ROOT), "PATH": "/usr/bin"},
        check=True,
        capture_output=True,
        text=True,
    )
    assert done.stdout.startswith("M = Matrix(")
    source = tmp_path / f"{name}.c"
    command = ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-c", str(source)]
    subprocess.run([*command, "-o", str(tmp_path / "out.o")], check=True)
    module = load({f"{name}.py": (tmp_path / f"{name}.py").read_text()}, name, tmp_path)
    mass = module.mass_matrix(module.DEFAULT_PARAMETERS, [0.1, 0.2])
    assert mass.shape == (2, 2)
    assert mass[0, 0] > 0
    assert runpy.run_path(str(example))[name]().name == name


def emit_panda(folder: Path) -> None:
    command = [sys.executable, "-m", "linegraph", "emit", "examples/panda/panda.urdf"]
    subprocess.run([*command, "--out", str(folder)], cwd=ROOT, check=True, capture_output=True)


def compile_and_run(main: Path, folder: Path) -> str:
    program = folder / "main"
    command = ["cc", "-std=c99", "-O1", "-Wall", "-Wextra", "-Werror", f"-I{folder}", str(main)]
    subprocess.run([*command, str(folder / "panda.c"), "-lm", "-o", str(program)], check=True)
    return subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout


def drawn(*arguments: str) -> str:
    command = [sys.executable, "-m", "linegraph", *arguments]
    environment = {"PYTHONPATH": str(ROOT), "PATH": "/usr/bin", "PYTHONIOENCODING": "utf-8"}
    return subprocess.run(
        command, cwd=ROOT, env=environment, check=True, capture_output=True, encoding="utf-8"
    ).stdout


def test_the_picture_of_the_linkage_is_current() -> None:
    """Else call `linegraph graph` as the README does, with ``-o docs/four_bar.svg``."""
    assert "docs/four_bar.svg" in README
    (source,) = re.findall(r"^ +\.venv/bin/linegraph graph (\S+) --what both", README, re.MULTILINE)
    kept = (ROOT / "docs" / "four_bar.svg").read_text(encoding="utf-8")
    assert drawn("graph", source, "--what", "both") == kept


def test_the_derivation_says_what_the_page_on_derivations_shows() -> None:
    page = (ROOT / "docs" / "derivations.md").read_text(encoding="utf-8")
    (shown,) = re.findall(r"^```text\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    report = drawn("derive", "examples/cart_pole/cart_pole.toml")
    for part in shown.strip("\n").split("\n\n"):
        assert part in report

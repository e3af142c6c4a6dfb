"""The controllers: what their READMEs print runs as printed, and meets the goal that it states.

Whether it does is computed here from the log, beside what the program says by its exit status; and both must
say no of the detuned controller that the README names.
"""

from __future__ import annotations

import math
import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

if TYPE_CHECKING:
    from collections.abc import Callable

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "examples" / "controllers"
UPRIGHT = math.pi

Log = dict[str, Any]


# ---- the goals, from the logs


def computed_torque(log: Log) -> bool:
    wanted = np.array([log[f"wanted{i}"] for i in range(1, 8)])
    errors = {
        law: np.array([log[f"{law}_q{i}"] for i in range(1, 8)]) - wanted
        for law in ("computed", "pd")
    }
    rms = {law: math.sqrt(np.mean(error**2)) for law, error in errors.items()}
    most = np.array([[87.0]] * 4 + [[12.0]] * 3)
    for law in errors:
        assert np.all(np.abs([log[f"{law}_u{i}"] for i in range(1, 8)]) <= most)
    assert np.max(np.ptp(wanted, axis=1)) > 1  # it does move
    assert rms["pd"] > 1.5 * rms["computed"]
    return rms["computed"] < 3e-3 and bool(np.max(np.abs(errors["computed"])) < 8e-3)


def cart_pole_motor(log: Log) -> bool:
    t, off = log["t"], from_upright(log["swing"])
    assert np.max(np.abs(log["voltage"])) <= 12
    assert abs(off[0]) == pytest.approx(math.pi)  # it hangs
    return bool(
        np.max(np.abs(off[t >= 4])) < 0.2
        and np.max(np.abs([off[t > 9], log["slide"][t > 9]])) < 0.02
        and np.max(np.abs(log["slide"])) < 0.5
    )


def furuta(log: Log) -> bool:
    t, off = log["t"], from_upright(log["hinge"])
    assert np.max(np.abs(log["torque"])) <= 0.5
    assert abs(off[0]) == pytest.approx(math.pi)
    return bool(
        np.max(np.abs(off[t >= 4])) < 0.3
        and np.max(np.abs([off[t > 9], log["shaft"][t > 9]])) < 0.02
        and np.max(np.abs(log["shaft"])) < 1.5
    )


def ekf(log: Log) -> bool:
    from scipy.stats import chi2

    late = log["t"] > 0.5
    assert np.ptp(log["hinge"]) > 2.5  # it does swing
    good = True
    for joint in ("shaft", "hinge"):
        truth = log[f"{joint}_dot"]
        error = log[f"{joint}_dot_estimate"] - truth
        rms = math.sqrt(np.mean(error[late] ** 2))
        by_differences = math.sqrt(np.mean((log[f"{joint}_difference"] - truth)[late] ** 2))
        believed = np.mean(np.abs(error) < 2 * log[f"{joint}_dot_deviation"])
        good = good and rms < 0.05 and 10 * rms < by_differences and believed > 0.9
    below, above = chi2.ppf([0.025, 0.975], 160) / 40
    within = (below < log["mean_normalized"]) & (log["mean_normalized"] < above)
    return good and np.mean(within) > 0.9


def four_bar(log: Log) -> bool:
    crank, coupler, rocker = log["motor"], log["motor"] + log["elbow"], log["swing"]
    open_x = 0.1 * np.cos(crank) + 0.4 * np.cos(coupler) - 0.35 - 0.3 * np.cos(rocker)
    open_y = 0.1 * np.sin(crank) + 0.4 * np.sin(coupler) - 0.3 * np.sin(rocker)
    error = rocker - log["wanted"]
    assert np.ptp(log["wanted"]) == pytest.approx(0.48, abs=1e-6)
    assert np.max(np.abs(log["torque"])) <= 3
    return (
        math.sqrt(np.mean(error**2)) < 1e-3
        and np.max(np.abs(error)) < 2e-3
        and np.max(np.hypot(open_x, open_y)) < 1e-9
    )


def impedance(log: Log) -> bool:
    """The response of m x'' + d x' + k x = k x_d to a step, as every textbook has it."""
    mass, damping, stiffness, wall = 6.0, 84.0, 600.0, 20000.0
    t, natural = log["t"], math.sqrt(stiffness / mass)
    ratio = damping / 2 / math.sqrt(stiffness * mass)
    since, beats = np.maximum(t - 0.1, 0), natural * math.sqrt(1 - ratio**2)
    swing = np.cos(beats * since) + ratio / math.sqrt(1 - ratio**2) * np.sin(beats * since)
    done = 1 - np.exp(-ratio * natural * since) * swing
    assert log["wanted_x"][-1] - log["wanted_x"][0] == pytest.approx(0.08)
    off = [
        log["y"] - log["wanted_y"][0] - 0.05 * done,
        log["z"] - log["wanted_z"][0] + 0.03 * done,
        (log["x"] - log["wanted_x"])[t < 1.5],
    ]
    late = t > 4.5
    force = np.mean(log["force"][late])
    spring = force / np.mean((log["wanted_x"] - log["x"])[late])
    wanted = 0.03 * stiffness * wall / (stiffness + wall)
    return bool(
        max(np.max(np.abs(error)) for error in off) < 3e-3
        and abs(force / wanted - 1) < 0.03
        and abs(spring / stiffness - 1) < 0.03
        and np.max(log["force"]) < 25
        and np.max(log["turn"]) < 0.01
    )


def mpc(log: Log) -> bool:
    off = from_upright(log["swing"])
    assert np.max(np.abs(log["force"])) <= 8
    assert abs(off[0]) == pytest.approx(math.pi)  # it hangs
    return (
        np.max(np.abs(off[log["t"] >= 2.5])) < 0.15
        and math.sqrt(np.mean(off[log["t"] > 5] ** 2)) < 0.05
        and np.max(np.abs(log["slide"])) < 0.6
    )


def from_upright(angle: Any) -> Any:
    return np.remainder(angle, 2 * math.pi) - UPRIGHT


GOALS: dict[str, Callable[[Log], bool]] = {
    "cart_pole_motor": cart_pole_motor,
    "computed_torque": computed_torque,
    "ekf": ekf,
    "four_bar": four_bar,
    "furuta": furuta,
    "impedance": impedance,
    "mpc": mpc,
}
FIXED = set(GOALS) - {"mpc"}
"""Those whose figures hang by no last bit of `<math.h>`: small differences die out."""


# ---- running them


@dataclass
class Place:
    """A folder that looks like the project's, with the commands that READMEs call."""

    folder: Path

    def run(self, script: str) -> subprocess.CompletedProcess[str]:
        """Run lines of a README as they are printed, until one fails."""
        search = f"{self.folder / 'bin'}:{os.environ['PATH']}"
        return subprocess.run(
            ["bash", "-eu", "-c", script],
            cwd=self.folder,
            env={**os.environ, "PATH": search, "PYTHONPATH": str(ROOT)},
            check=False,
            capture_output=True,
            text=True,
        )


def place(folder: Path) -> Place:
    """`examples` as they are, controllers as copies; `cc` with all warnings, as errors."""
    commands = {
        "linegraph": f'"{sys.executable}" -m linegraph',
        "python": f'"{sys.executable}"',
        "cc": "gcc -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror",
    }
    (folder / "bin").mkdir()
    for name, command in commands.items():
        path = folder / "bin" / name
        path.write_text(f'#!/bin/sh\nexec {command} "$@"\n')
        path.chmod(0o755)
    (folder / "examples").mkdir()
    for source in (ROOT / "examples").iterdir():
        if source != FOLDER:
            (folder / "examples" / source.name).symlink_to(source)
    for source in FOLDER.rglob("*"):
        if source.suffix in (".c", ".h", ".py", ".toml"):
            target = folder / source.relative_to(ROOT)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(source.read_bytes())
    return Place(folder)


def readme(name: str) -> str:
    return (FOLDER / name / "README.md").read_text(encoding="utf-8")


def block(name: str, language: str) -> str:
    (found,) = re.findall(rf"^```{language}\n(.*?)^```", readme(name), re.MULTILINE | re.DOTALL)
    return str(found)


def log_of(path: Path) -> Log:
    names, *_ = path.read_text().split("\n", 1)
    values = np.loadtxt(path, delimiter=",", skiprows=1)
    assert np.all(np.isfinite(values))
    return dict(zip(names.split(","), values.T, strict=True))


def same_words(one: str, other: str) -> bool:
    number = r"\d+(?:\.\d+)?(?:e[-+]\d+)?"
    return re.sub(number, "#", one) == re.sub(number, "#", other)


def numbers(text: str) -> list[float]:
    return [float(found) for found in re.findall(r"\d+(?:\.\d+)?(?:e[-+]\d+)?", text)]


def pixels(path: Path) -> Any:
    from matplotlib.image import imread

    return imread(path)


# ---- the tests


def test_every_controller_is_here_and_answers_the_same_questions() -> None:
    folders = {
        path.name for path in FOLDER.iterdir() if path.is_dir() and path.name != "__pycache__"
    }
    assert folders == set(GOALS)
    overview = (FOLDER / "README.md").read_text(encoding="utf-8")
    for name in GOALS:
        files = {path.name for path in (FOLDER / name).iterdir()} - {f"{name}.toml"}
        assert files == {"README.md", "controller.c", "controller.h", "main.c", f"{name}.png"}
        headings = re.findall(r"^## (.*)", readme(name), re.MULTILINE)
        assert headings == ["The law", "The goal", "To run it"]
        assert f"]({name})" in overview
        assert f"]({name}/{name}.png)" in overview


@pytest.mark.parametrize("name", GOALS)
def test_it_needs_nothing_but_what_is_emitted(name: str) -> None:
    """And no heap: nothing is included but this, `<math.h>`, and `<stdio.h>` for the log."""
    sources = [*(FOLDER / name).glob("*.[ch]"), *FOLDER.glob("*.[ch]")]
    assert len(sources) == 5
    for source in sources:
        included = set(re.findall(r"#include <(.*)>", source.read_text()))
        assert included <= {"math.h", *(["stdio.h"] if source.name == "main.c" else [])}


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", GOALS)
def test_it_meets_its_goal(name: str, tmp_path: Path) -> None:
    here = place(tmp_path)
    done = here.run(block(name, "sh"))
    assert done.returncode == 0, done.stderr
    build = tmp_path / "build" / "controllers" / name
    assert GOALS[name](log_of(build / "log.csv"))

    said = [line for line in done.stderr.splitlines() if not line.startswith("warning: ")]
    shown = block(name, "text")
    assert same_words("\n".join(said), shown.rstrip())
    if name in FIXED:
        assert numbers("\n".join(said)) == pytest.approx(numbers(shown), rel=0.2)

    drawn, kept = pixels(build / "plot.png"), pixels(FOLDER / name / f"{name}.png")
    assert drawn.shape == kept.shape
    # letters and lines are a matter of matplotlib's build
    assert np.sqrt(np.mean((drawn - kept) ** 2)) < 0.03


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", GOALS)
def test_detuned_it_misses_its_goal(name: str, tmp_path: Path) -> None:
    """The goal is one that can be missed, and the program says so."""
    ((new, old, file),) = re.findall(r"With `(.*?)` for `(.*?)`\s+in\s+`(.*?)`", readme(name))
    here = place(tmp_path)
    source = tmp_path / "examples" / "controllers" / name / file
    pattern = r"\b" + r"\s+".join(map(re.escape, old.split())) + r"(?![\d.])"
    text, count = re.subn(pattern, new, source.read_text())
    assert count == 1
    source.write_text(text)
    emit, compile_it, run, _ = block(name, "sh").splitlines()
    assert here.run(f"{emit}\n{compile_it}").returncode == 0
    done = here.run(run)
    assert done.returncode == 1, done.stderr
    assert not GOALS[name](log_of(tmp_path / "build" / "controllers" / name / "log.csv"))

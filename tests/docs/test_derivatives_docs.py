"""What docs/derivatives.md says is true: its program runs, its commands write, its counts are asserted."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from click.testing import CliRunner
from emitted.test_cost import SLOPES_MOST

from linegraph.cli.main import main
from linegraph.programs.register import ON_REQUEST

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "derivatives.md").read_text()


def test_the_program_prints_the_poles() -> None:
    poles = [float(x) for x in re.findall(r"-?\d+\.\d*", printed(0))]
    assert len(poles) == 4


def test_the_program_in_letters_prints_what_stands_there() -> None:
    (shown,) = re.findall(r"```text\n(.*?)```", TEXT, re.DOTALL)
    assert printed(1) == shown


def printed(place: int) -> str:
    """What a program of the page prints."""
    programs = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)
    assert len(programs) == 2
    command = [sys.executable, "-c", programs[place]]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT)
    return done.stdout


def test_the_command_writes_what_it_says(tmp_path: Path) -> None:
    (command,) = re.findall(r"^    linegraph (emit .*)$", TEXT, re.MULTILINE)
    words = command.replace("furuta.toml", str(ROOT / "examples/furuta/furuta.toml")).split()
    words[-1] = str(tmp_path)
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 0, done.output
    header = (tmp_path / "furuta.h").read_text()
    assert "furuta_linearize(" in header
    assert "furuta_inverse_dynamics_derivatives(" in header


def test_the_command_of_the_readme_writes_code_that_holds(tmp_path: Path) -> None:
    text = (ROOT / "README.md").read_text()
    (command,) = re.findall(
        r"^    \.venv/bin/linegraph (emit .* --real float .*)$", text, re.MULTILINE
    )
    words = command.replace("examples/", f"{ROOT}/examples/").split()
    words[-1] = str(tmp_path)
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 0, done.output
    build = ["gcc", "-std=c99", "panda_test.c", "panda.c", "-lm", "-o", "check"]
    subprocess.run(build, cwd=tmp_path, check=True)
    done = subprocess.run([tmp_path / "check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
    assert "linearize" in done.stdout


def test_all_functions_and_counts_are_there() -> None:
    for name in ON_REQUEST:
        if "derivatives" in name or name == "linearize":
            assert f"| `{name}` |" in TEXT
    rows = re.findall(r"^\| (\w+)[^|]*\| (\d+) / \d+ \| (\d+) / \d+ \|$", TEXT, re.MULTILINE)
    assert {name.lower(): (int(a), int(b)) for name, a, b in rows} == SLOPES_MOST
    inverse, forward = SLOPES_MOST["panda"]
    readme = re.sub(r"\s+", " ", (ROOT / "README.md").read_text())
    assert f"The Panda's (arm only) take {inverse} and {forward} operations" in readme

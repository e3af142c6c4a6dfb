"""The commands on closed systems as a user types them: emit, show, check, trees, assemble."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from linegraph.cli.main import main

EXAMPLES = Path(__file__).parents[2] / "examples"
FOUR_BAR = str(EXAMPLES / "four_bar" / "four_bar.toml")


def run(*arguments: str) -> Result:
    return CliRunner().invoke(main, list(arguments))


def test_emit_writes_the_constraints(tmp_path: Path) -> None:
    done = run("emit", FOUR_BAR, "--out", str(tmp_path))
    assert done.exit_code == 0, done.output
    header = (tmp_path / "four_bar.h").read_text()
    for name in ("constraints", "constraint_jacobian", "constraint_bias", "project", "complete"):
        assert f"four_bar_{name}(" in header
    assert "#define FOUR_BAR_RANK 2" in header
    assert "3 are redundant" in header
    assert "four_bar_power(" not in header


def test_the_power_audit_is_emitted_on_request(tmp_path: Path) -> None:
    done = run("emit", FOUR_BAR, "--out", str(tmp_path), "--with", "power")
    assert done.exit_code == 0, done.output
    assert "four_bar_power(" in (tmp_path / "four_bar.h").read_text()


def test_show_tells_chords_and_constraints() -> None:
    text = run("show", FOUR_BAR).output
    assert "chord: closes a loop" in text
    assert "2 independent, 3 redundant: 1 degree of freedom" in text


def test_check_finds_closed_systems_good() -> None:
    done = run("check", FOUR_BAR)
    assert done.exit_code == 0, done.output
    assert "audit: sum of through times across" in done.output
    assert done.output.endswith("good\n")


def test_trees_are_listed_with_what_they_cost() -> None:
    lines = run("trees", FOUR_BAR).output.splitlines()
    assert lines[0].split() == ["operations", "velocities", "constraints", "cut"]
    costs = [int(line.split()[0]) for line in lines[1:]]
    assert costs == sorted(costs)
    assert sum("(this model)" in line for line in lines) == 1


def test_an_open_chain_has_one_tree_of_joints() -> None:
    text = run("trees", str(EXAMPLES / "double_pendulum" / "double_pendulum.toml")).output
    assert "the only tree of joints" in text
    assert 'coordinates = "absolute-angle"' in text


def test_assemble_prints_a_position() -> None:
    text = run("assemble", FOUR_BAR).output
    assert text.splitlines()[0].startswith("q[0]  motor")
    assert "1 degree of freedom" in text


def test_assemble_holds_what_is_set() -> None:
    text = run("assemble", FOUR_BAR, "--set", "motor=1.25").output
    assert text.splitlines()[0].split()[:3] == ["q[0]", "motor", "1.25"]


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ("nothing=1", 'coordinate "nothing"'),
        ("motor=x", "'x' is not a number"),
        ("motor", "number"),
    ],
)
def test_what_cannot_be_set_is_said(value: str, said: str) -> None:
    done = run("assemble", FOUR_BAR, "--set", value)
    assert done.exit_code == 2
    assert said in done.output
    assert "Traceback" not in done.output


def test_a_place_that_cannot_be_reached_is_said(tmp_path: Path) -> None:
    """A rocker that cannot reach so far: the message names the file, the chord and its circuit."""
    text = Path(FOUR_BAR).read_text().replace("d = { value = 0.35", "d = { value = 3.5")
    (tmp_path / "far.toml").write_text(text)
    done = run("emit", str(tmp_path / "far.toml"), "--out", str(tmp_path / "out"))
    assert done.exit_code == 2
    assert "far.toml:" in done.output
    assert "motor - elbow - swing - knee" in done.output
    assert "cannot be assembled" in done.output
    assert not (tmp_path / "out").exists()

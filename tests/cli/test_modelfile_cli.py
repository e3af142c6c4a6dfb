"""Model files at the command line, as a first-time user meets them."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from typing import TYPE_CHECKING

import pytest
from cli.test_cli import linegraph, refused
from support.modelfile_text import SMALL

from linegraph.readers.modelfile.schema import text

if TYPE_CHECKING:
    from pathlib import Path

MAIN = """
#include <stdio.h>
#include "crane.h"
int main(void) {
    const double q[CRANE_NQ] = {0.1, 0.2}, v[CRANE_NV] = {0.0}, u[CRANE_NU] = {0.0};
    double a[CRANE_NV];
    const int status = crane_forward_dynamics(&crane_default_parameters, q, v, u, a);
    printf("%g %g\\n", a[0], a[1]);
    return status;
}
"""


def test_from_nothing_to_a_running_program(tmp_path: Path) -> None:
    assert linegraph("new", "crane", cwd=tmp_path).stdout == "crane.toml\n"
    assert "swing" in linegraph("show", "crane.toml", cwd=tmp_path).stdout
    done = linegraph("emit", "crane.toml", "--out", "build", cwd=tmp_path)
    assert done.stdout.splitlines() == [f"build/crane.{end}" for end in ("h", "c", "py")]
    assert done.stderr == ""
    (tmp_path / "main.c").write_text(MAIN)
    command = [
        "cc",
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-Ibuild",
        "main.c",
        "build/crane.c",
    ]
    subprocess.run([*command, "-lm", "-o", "main"], cwd=tmp_path, check=True)
    printed = subprocess.run(["./main"], cwd=tmp_path, check=True, capture_output=True, text=True)
    assert len(printed.stdout.split()) == 2


def test_new_writes_over_nothing(tmp_path: Path) -> None:
    (tmp_path / "crane.toml").write_text("mine")
    refused(linegraph("new", "crane", cwd=tmp_path), "crane.toml", "is there already")
    assert (tmp_path / "crane.toml").read_text() == "mine"
    assert linegraph("new", "crane", "--out", "b.toml", cwd=tmp_path).stdout == "b.toml\n"


def test_parameters_stay_symbols_unless_folded(tmp_path: Path) -> None:
    (tmp_path / "small.toml").write_text(SMALL)
    linegraph("emit", "small.toml", "--lang", "c", cwd=tmp_path)
    assert "small_default_parameters" in (tmp_path / "small.h").read_text()
    linegraph("emit", "small.toml", "--lang", "c", "--parameters", "folded", cwd=tmp_path)
    assert "small_default_parameters" not in (tmp_path / "small.h").read_text()


@pytest.mark.parametrize("name", ["small.json", "small.model"])
def test_json_is_known_by_its_name_or_its_beginning(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(json.dumps(tomllib.loads(SMALL)))
    assert "hinge" in linegraph("show", name, cwd=tmp_path).stdout


def test_a_urdf_is_known_by_its_beginning(tmp_path: Path) -> None:
    (tmp_path / "robot.txt").write_text('<?xml version="1.0"?><robot name="r"><link/></robot>')
    refused(linegraph("show", "robot.txt", cwd=tmp_path), "<link>")


def test_every_error_has_its_line(tmp_path: Path) -> None:
    broken = SMALL.replace('"m"', '"mm"').replace("axis", "axes")
    (tmp_path / "small.toml").write_text(broken)
    done = linegraph("emit", "small.toml", "--out", "build", cwd=tmp_path)
    refused(done, 'error: small.toml:9: [body.arm] mass: there is no "mm"')
    lines = done.stderr.splitlines()
    assert [line.split(":")[2] for line in lines] == ["9", "12", "14"]
    assert all(line.startswith("error: small.toml:") for line in lines)
    assert not (tmp_path / "build").exists()


def test_a_floating_base_is_a_joint_of_the_file(tmp_path: Path) -> None:
    (tmp_path / "small.toml").write_text(SMALL)
    done = linegraph("show", "small.toml", "--base", "floating", cwd=tmp_path)
    refused(done, "--base floating", "[free.root]", "between")


def test_locks_reach_model_files(tmp_path: Path) -> None:
    (tmp_path / "small.toml").write_text(SMALL)
    done = linegraph("show", "small.toml", "--lock", "hing", cwd=tmp_path)
    refused(done, "hing", "hinge")


def test_the_schema_is_printed() -> None:
    assert linegraph("schema").stdout == text()


def test_emitting_a_model_file_imports_nothing_heavy(tmp_path: Path) -> None:
    (tmp_path / "small.toml").write_text(SMALL)
    script = (
        "import sys; from linegraph.cli.main import main\n"
        "try: main(sys.argv[1:])\nexcept SystemExit: pass\n"
        "heavy = {'sympy', 'numpy', 'networkx', 'lxml'} & set(sys.modules)\n"
        "sys.exit(f'imported: {heavy}' if heavy else 0)"
    )
    command = [sys.executable, "-c", script, "emit", "small.toml", "--out", "build"]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        env={"PYTHONPATH": ":".join(sys.path)},
        capture_output=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr

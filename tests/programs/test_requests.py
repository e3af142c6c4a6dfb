"""What a user may ask for in one go, and what is answered when it makes no sense."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import linegraph as lg
from linegraph import ModelError
from linegraph.cli.main import main
from linegraph.emission.emit import render
from linegraph.errors import LinegraphError
from linegraph.files import write_all

FURUTA = Path("examples/furuta/furuta.toml")


def functions_of(text: str) -> set[str]:
    return set(re.findall(r"^def ([a-z]\w*)", text, re.MULTILINE))


def test_with_stands_beside_only(tmp_path: Path) -> None:
    words = ["emit", str(FURUTA), "--lang", "python", "--out", str(tmp_path)]
    done = CliRunner().invoke(main, [*words, "--only", "mass_matrix", "--with", "linearize"])
    assert done.exit_code == 0, done.output
    names = functions_of((tmp_path / "furuta.py").read_text())
    assert {"mass_matrix", "linearize"} <= names
    assert "inverse_dynamics" not in names


def test_one_name_alone_is_one() -> None:
    files = render(lg.read(FURUTA), functions="linearize", frames="arm", languages="python")
    assert {"linearize", "frame_arm_pose"} <= functions_of(files["furuta.py"])


@pytest.mark.parametrize("choice", [("--prefix", "zz"), ("--cmake",), ("--real", "float")])
def test_options_of_c_without_c_are_refused(choice: tuple[str, ...], tmp_path: Path) -> None:
    words = ["emit", str(FURUTA), "--lang", "python", "--out", str(tmp_path), *choice]
    done = CliRunner().invoke(main, words)
    assert done.exit_code == 2
    assert "C is not written" in done.output
    assert not list(tmp_path.iterdir())


def test_a_prefix_is_a_text() -> None:
    with pytest.raises(ModelError, match="is a text, not 3"):
        render(lg.read(FURUTA), prefix=3)


def test_what_depends_on_the_file_is_no_function_of_a_derivation() -> None:
    derivation = lg.derive(lg.read(FURUTA))
    for what in ("prepare", "linearize_prepared"):
        with pytest.raises(ModelError, match="order of its constants"):
            derivation.function(what)
    with pytest.raises(ModelError, match=r"its frame has to be in frames"):
        derivation.function("frame_arm_pose")
    position, _ = derivation.function("frame_arm_pose", frames="arm")([0.1, 0.2])
    assert np.allclose(position, 0)


def test_base_parameters_say_what_is_wrong() -> None:
    base = lg.derive(lg.read(FURUTA)).base_parameters()
    with pytest.raises(ModelError, match="is a number, not"):
        base.matrix({"L": "x"})
    with pytest.raises(ModelError, match="is not there; known: g, L"):
        base.matrix({"nosuch": 1.0})


def test_nothing_is_replaced_where_one_file_cannot_be(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    (tmp_path / "a").write_text("old")
    with pytest.raises(LinegraphError, match=re.escape(str(tmp_path / "b"))):
        write_all(tmp_path, {"a": "new", "b": "new"})
    assert (tmp_path / "a").read_text() == "old"
    (tmp_path / "c").write_text("a file")
    with pytest.raises(LinegraphError, match=re.escape(str(tmp_path / "c"))):
        write_all(tmp_path, {"a": "new", "c/d": "new"})
    assert (tmp_path / "a").read_text() == "old"
    assert {path.name for path in tmp_path.iterdir()} == {"a", "b", "c"}


def test_a_library_of_arduino_has_its_test_inside(tmp_path: Path) -> None:
    files = render(lg.read(FURUTA), tests=True, arduino=True, real="float")
    assert {name.split("/")[0] for name in files} == {"furuta"}
    write_all(tmp_path, files)
    (command,) = re.findall(r"(cc -std=c99 .*) && ", files["furuta/extras/furuta_test.c"])
    folder = tmp_path / "furuta" / "extras"
    subprocess.run(command.split(), cwd=folder, check=True)
    assert (
        subprocess.run([folder / "furuta_test"], capture_output=True, check=False).returncode == 0
    )

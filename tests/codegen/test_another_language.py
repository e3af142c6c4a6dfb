"""A third language, whose whole code is `support.javascript`: what it emits passes golden vectors in node."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from support import javascript, targets

import codegen
from linegraph.emission.emit import render
from linegraph.readers import modelfile, urdf

EXAMPLES = Path(__file__).parents[2] / "examples"
MODELS = {
    "four_bar": lambda: modelfile.read(EXAMPLES / "four_bar" / "four_bar.toml"),
    "rolling_disc": lambda: modelfile.read(EXAMPLES / "rolling_disc" / "rolling_disc.toml"),
    "panda": lambda: urdf.read(EXAMPLES / "panda" / "panda.urdf"),
    "mixed4": targets.everything()["mixed4"],
}
"""A loop, one with quaternions, a robot, and a network with an algebraic loop."""


@pytest.fixture
def third(monkeypatch: pytest.MonkeyPatch) -> None:
    """The register with one more line."""
    made = {**codegen._REGISTER, "javascript": javascript.LANGUAGE}
    monkeypatch.setattr(codegen, "_REGISTER", made)
    monkeypatch.setattr(codegen, "LANGUAGES", tuple(made))


def checked(files: dict[str, str], folder: Path) -> subprocess.CompletedProcess[str]:
    """What node says of the golden vectors."""
    for file, text in files.items():
        (folder / file).write_text(text)
    command = ["node", "model_test.js"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("name", MODELS)
def test_golden_vectors_hold_in_a_third_language(name: str, third: None, tmp_path: Path) -> None:
    if lacking := targets.missing("node"):
        pytest.skip(lacking)
    files = render(MODELS[name](), name="model", languages=["javascript"], tests=True)
    assert set(files) == {"model.js", "model_test.js"}
    done = checked(files, tmp_path)
    assert done.returncode == 0, done.stdout[:2000] + done.stderr[:2000]
    assert int(done.stdout.split()[0]) > 8


def test_a_wrong_sign_is_seen(third: None, tmp_path: Path) -> None:
    if lacking := targets.missing("node"):
        pytest.skip(lacking)
    files = render(MODELS["four_bar"](), name="model", languages=["javascript"], tests=True)
    right = "A[below + columns[j]] -= "
    assert files["model.js"].count(right) == 1
    files["model.js"] = files["model.js"].replace(right, right.replace("-=", "+="))
    assert checked(files, tmp_path).returncode == 1

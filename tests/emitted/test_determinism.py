"""Same input, same bytes: whatever the hash seed, the locale, the folder or the day."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"


def emitted(robot: Path, folder: Path, **environment: str) -> dict[str, str]:
    """Digests of what a fresh process writes when it runs in this folder."""
    folder.mkdir(parents=True)
    shutil.copy(robot, folder / robot.name)
    command = [sys.executable, "-m", "linegraph", "emit", robot.name, "--out", "out"]
    root = str(EXAMPLES.parent)
    subprocess.run(
        command,
        cwd=folder,
        env={**os.environ, "PYTHONPATH": root, **environment},
        check=True,
        capture_output=True,
    )
    files = sorted((folder / "out").iterdir())
    return {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in files}


MODELS = (
    "panda/panda.urdf",
    "anymal_c/anymal.urdf",
    "bricard/bricard.toml",
    "bicycle/bicycle.toml",
)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("robot", MODELS)
def test_bytes_depend_on_the_input_alone(robot: str, tmp_path: Path) -> None:
    first = emitted(EXAMPLES / robot, tmp_path / "a", PYTHONHASHSEED="0")
    assert len(first) == 3
    settings = [
        {"PYTHONHASHSEED": "1", "LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"},
        {"PYTHONHASHSEED": "12345", "LC_ALL": "C", "TZ": "Pacific/Auckland"},
        {"PYTHONHASHSEED": "7", "SOURCE_DATE_EPOCH": "0", "HOME": str(tmp_path)},
        {"PYTHONHASHSEED": "8", "OPENBLAS_NUM_THREADS": "1"},
    ]
    for i, setting in enumerate(settings):
        folder = tmp_path / "deeply" / f"nested {i}" / "ordner"
        assert emitted(EXAMPLES / robot, folder, **setting) == first

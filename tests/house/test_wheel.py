"""The wheel: built, installed alone in a fresh environment, emitting from another folder."""

from __future__ import annotations

import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(folder)]
    subprocess.run([*command, str(ROOT)], check=True, capture_output=True)
    (built,) = folder.glob("*.whl")
    return built


def test_holds_the_packages_their_templates_and_nothing_else(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    tops = {name.split("/")[0] for name in names}
    assert {top for top in tops if not top.endswith(".dist-info")} == {"linegraph", "codegen"}
    for template in (ROOT / "templates").rglob("*.jinja"):
        assert f"codegen/templates/{template.relative_to(ROOT / 'templates')}" in names
    for source in (*(ROOT / "linegraph").rglob("*.py"), *(ROOT / "codegen").rglob("*.py")):
        assert str(source.relative_to(ROOT)) in names
    assert any(name.endswith("licenses/LICENSE") for name in names)
    assert {"linegraph/py.typed", "codegen/py.typed"} <= set(names)


def test_emits_when_installed(wheel: Path, tmp_path: Path) -> None:
    """Dependencies come from the running environment: what is tested is the wheel."""
    venv.create(tmp_path / "env", with_pip=False)
    python = tmp_path / "env" / "bin" / "python"
    site = next((tmp_path / "env" / "lib").iterdir()) / "site-packages"
    zipfile.ZipFile(wheel).extractall(site)
    import click

    dependencies = Path(click.__file__).parent.parent
    (site / "dependencies.pth").write_text(f"{dependencies}\n")
    out = tmp_path / "out"
    robot = ROOT / "examples" / "panda" / "panda.urdf"
    emit = [str(python), "-m", "linegraph", "emit", str(robot), "--out", str(out)]
    done = subprocess.run(emit, cwd=tmp_path, check=True, capture_output=True, text=True)
    assert done.stdout.splitlines() == [str(out / f"panda.{end}") for end in ("h", "c", "py")]
    where = [str(python), "-c", "import codegen, linegraph; print(codegen.__file__)"]
    found = subprocess.run(where, cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    assert str(site) in found

"""The notebooks run, what they assert holds, and the outputs that are kept are those of today."""

from __future__ import annotations

import base64
import importlib.util
import struct
import sys
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from types import ModuleType

nbformat = pytest.importorskip("nbformat")
pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")

FOLDER = Path(__file__).parents[2] / "examples" / "notebooks"
NAMES = [path.stem for path in sorted(FOLDER.glob("*.ipynb"))]
MOST_LINES, MOST_BYTES = 15, 400_000


def loaded() -> ModuleType:
    """`refresh.py`, which is no part of a package."""
    spec = importlib.util.spec_from_file_location("refresh", FOLDER / "refresh.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


refresh = loaded()


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name", NAMES)
def test_outputs_are_current(name: str) -> None:
    kept = refresh.read(FOLDER / f"{name}.ipynb")
    fresh = refresh.executed(kept)
    assert refresh.flaws(fresh) == []
    assert refresh.differences(kept, fresh) == []


@pytest.mark.parametrize("name", NAMES)
def test_notebooks_are_kept_as_they_are_written(name: str) -> None:
    """No trace of when and where they ran, nothing that should not be shown, nothing left to run."""
    path = FOLDER / f"{name}.ipynb"
    kept = refresh.read(path)
    assert refresh.flaws(kept) == []
    assert any(cell.get("outputs") for cell in kept.cells)
    assert path.read_text(encoding="utf-8") == refresh.written(refresh.normalised(kept))
    assert len(path.read_bytes()) < MOST_BYTES


@pytest.mark.parametrize("name", NAMES)
def test_notebooks_tell_in_small_steps(name: str) -> None:
    cells = refresh.read(FOLDER / f"{name}.ipynb").cells
    assert cells[0].cell_type == "markdown"
    assert cells[0].source.startswith("# ")
    assert cells[-1].cell_type == "markdown"
    assert "Try next" in cells[-1].source
    code = [cell.source for cell in cells if cell.cell_type == "code"]
    assert all(len(source.splitlines()) <= MOST_LINES for source in code)
    assert any("assert" in source for source in code)  # what is claimed is checked


def test_the_list_names_all() -> None:
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert len(NAMES) == 8
    assert all(f"({name}.ipynb)" in text for name in NAMES)


# ---- what refreshes them


def notebook(*sources: str) -> Any:
    cells = [nbformat.v4.new_code_cell(source) for source in sources]
    return nbformat.v4.new_notebook(cells=cells)


@pytest.fixture(scope="module")
def ran() -> Any:
    """One run of everything that outputs may be."""
    return refresh.executed(
        notebook(
            "print('one'); print('two'); 1 + 1",
            "from IPython.display import SVG, Math, display; display(Math('x'))",
            "import matplotlib.pyplot as plt; plt.plot([0, 1]); plt.show()",
            "import sys; print('/home/me'); print('DeprecationWarning', file=sys.stderr)",
            "import linegraph; linegraph.__file__",
        )
    )


def test_outputs_say_what_was_said(ran: Any) -> None:
    first, math, plot, *_ = ran.cells
    assert [output.output_type for output in first.outputs] == ["stream", "execute_result"]
    assert first.outputs[0].text == "one\ntwo\n"
    assert list(math.outputs[0].data) == ["text/latex"]
    assert list(plot.outputs[0].data) == ["image/png"]
    assert [cell.id for cell in ran.cells] == [f"cell-{n}" for n in range(1, 6)]
    assert all(not cell.metadata for cell in ran.cells)
    assert set(ran.metadata) == {"kernelspec", "language_info"}


def test_it_is_this_checkout_that_runs(ran: Any) -> None:
    place = ran.cells[-1].outputs[0].data["text/plain"]
    assert str(FOLDER.parent.parent) in place


def test_plots_name_no_program(ran: Any) -> None:
    image = base64.b64decode(ran.cells[2].outputs[0].data["image/png"])
    assert image[:8] == b"\x89PNG\r\n\x1a\n"
    at, kinds = 8, []
    while at < len(image):
        (size,) = struct.unpack(">I", image[at : at + 4])
        kinds.append(image[at + 4 : at + 8])
        whole = image[at + 4 : at + 8 + size]
        assert image[at + 8 + size : at + 12 + size] == struct.pack(">I", zlib.crc32(whole))
        at += size + 12
    assert kinds == [b"IHDR", b"IDAT", b"IEND"]


def test_flaws_are_found(ran: Any) -> None:
    found = "\n".join(refresh.flaws(ran))
    assert "cell-4: an output holds '/home/'" in found
    assert "cell-4: writes to stderr" in found
    assert "DeprecationWarning" in found
    assert "cell-1" not in found
    assert "cell-2" not in found
    assert "cell-3" not in found


def test_differences_are_found(ran: Any) -> None:
    assert refresh.differences(ran, ran) == []
    other = nbformat.from_dict(ran)
    other.cells[0].outputs[0].text = "one\nthree\n"
    other.cells[1].outputs = []
    other.cells[2].outputs[0].data["image/png"] = "another"  # the same plot of another machine
    found = refresh.differences(other, ran)
    assert [problem.split(":")[0] for problem in found] == ["cell-1", "cell-2"]
    assert "three" in found[0]
    other.cells[2].outputs = []
    assert len(refresh.differences(other, ran)) == 3


def test_unknown_names_are_refused() -> None:
    with pytest.raises(SystemExit, match="nonsense"):
        refresh.notebooks(["3_furuta", "nonsense"])
    assert [path.stem for path in refresh.notebooks(["3_furuta.ipynb"])] == ["3_furuta"]


def test_a_cell_that_raises_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = tmp_path / "wrong.ipynb"
    path.write_text(refresh.written(refresh.normalised(notebook("1 / 0"))), encoding="utf-8")
    before = path.read_bytes()
    monkeypatch.setattr(refresh, "FOLDER", tmp_path)
    monkeypatch.setattr(sys, "argv", ["refresh.py"])
    assert refresh.main() == 1
    assert path.read_bytes() == before

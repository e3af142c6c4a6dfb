"""Execute the notebooks of this folder and write their outputs, or check that those written are current.

    python examples/notebooks/refresh.py                 all of them
    python examples/notebooks/refresh.py 3_furuta        some
    python examples/notebooks/refresh.py --check         write nothing, say what differs

What is written depends on the cells alone: cells are numbered, and the time and the machine leave no trace.
Where an output has a formula or a picture, its plain text is left out. Two runs are compared in all they
say; plots only for being there, as their last bit is a matter of matplotlib's build.
"""

from __future__ import annotations

import argparse
import base64
import os
import re
import struct
import sys
import tempfile
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import nbformat
from jupyter_client.kernelspec import KernelSpecManager
from jupyter_client.manager import AsyncKernelManager
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parent.parent
SECONDS = 120
"""How long a cell may take."""

KERNEL = {"display_name": "Python 3", "language": "python", "name": "python3"}
PLOTS = ("image/png", "image/jpeg")
RICH = ("text/latex", "text/html", "text/markdown", "image/svg+xml", *PLOTS)

MATPLOTLIB = """
figure.figsize: 7.2, 2.8
figure.dpi: 100
figure.constrained_layout.use: True
savefig.dpi: 100
axes.grid: True
axes.spines.top: False
axes.spines.right: False
grid.alpha: 0.3
lines.linewidth: 1.4
legend.frameon: False
"""
"""How plots look in the outputs that are kept."""

PLACES = re.compile(
    r"(?<![\w.:/])/(?:home|root|tmp|usr|opt|var|private|Users|work|mnt)/|\b[A-Z]:\\"
)
WORRIES = re.compile(r"\b\w*(?:Warning|Traceback)\b")


def notebooks(names: Iterable[str] = ()) -> list[Path]:
    """The notebooks of this folder, in their order; of given names only."""
    found = sorted(FOLDER.glob("*.ipynb"))
    wanted = [Path(name).stem for name in names]
    missing = sorted(set(wanted) - {path.stem for path in found})
    if missing:
        raise SystemExit(f"there is no notebook {', '.join(missing)}")
    return [path for path in found if not wanted or path.stem in wanted]


def read(path: Path) -> Any:
    """A notebook as it is kept."""
    return nbformat.read(path, as_version=4)


def executed(notebook: Any) -> Any:
    """A copy with the outputs of a kernel of its own, in this folder, with this checkout.

    Raises:
        CellExecutionError: a cell raises.
    """
    fresh = nbformat.from_dict(notebook)
    with tempfile.TemporaryDirectory(prefix="nb") as place:
        Path(place, "matplotlibrc").write_text(MATPLOTLIB, encoding="utf-8")
        path = os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])
        ours = {
            "PYTHONPATH": path,
            "MATPLOTLIBRC": place,
            "IPYTHONDIR": place,  # no settings of whoever runs this
            "COLUMNS": "100",
            "PYDEVD_DISABLE_FILE_VALIDATION": "1",
        }
        # sockets that are files: two runs at once cannot meet at a port
        transport = "tcp" if sys.platform == "win32" else "ipc"
        manager = AsyncKernelManager(
            kernel_name=KERNEL["name"],
            kernel_spec_manager=KernelSpecManager(kernel_dirs=[]),  # the Python that runs this
            transport=transport,
            connection_file=str(Path(place, "k.json")),
        )
        client = NotebookClient(
            fresh, km=manager, timeout=SECONDS, resources={"metadata": {"path": str(FOLDER)}}
        )
        client.execute(env={**os.environ, **ours}, cleanup_kc=True)  # and end the kernel
    return normalised(fresh)


def normalised(notebook: Any) -> Any:
    """The same with nothing in it of when and where it ran."""
    notebook.metadata = nbformat.from_dict(
        {"kernelspec": KERNEL, "language_info": {"name": "python"}}
    )
    notebook.nbformat, notebook.nbformat_minor = 4, 5
    count = 0
    for n, cell in enumerate(notebook.cells, 1):
        cell.id, cell.metadata = f"cell-{n}", nbformat.from_dict({})
        if cell.cell_type == "code":
            count += 1
            cell.execution_count = count
            cell.outputs = [_plain(output, count) for output in _joined(cell.outputs)]
    return notebook


def _joined(outputs: Iterable[Any]) -> Iterator[Any]:
    """Outputs with neighbouring pieces of one stream put together."""
    last = None
    for output in outputs:
        if last is not None and _one_stream(last, output):
            last.text += output.text
            continue
        if last is not None:
            yield last
        last = output
    if last is not None:
        yield last


def _one_stream(a: Any, b: Any) -> bool:
    return bool(a.output_type == b.output_type == "stream" and a.name == b.name)


def _plain(output: Any, count: int) -> Any:
    if output.output_type == "execute_result":
        output.execution_count = count
    if "data" in output:
        output.metadata = nbformat.from_dict({})
        if any(kind in output.data for kind in RICH):
            output.data.pop("text/plain", None)
        if "image/png" in output.data:
            output.data["image/png"] = _bare(output.data["image/png"])
    return output


def _bare(text: str) -> str:
    """A PNG without its remarks on who wrote it, and packed as tightly as that goes."""
    image = base64.b64decode(text)
    kept, pixels, at = [image[:8]], b"", 8
    while at < len(image):
        (size,) = struct.unpack(">I", image[at : at + 4])
        kind, data = image[at + 4 : at + 8], image[at + 8 : at + 8 + size]
        at += size + 12
        if kind == b"IDAT":
            pixels += data
            continue
        if kind == b"IEND":
            kept.append(_chunk(b"IDAT", zlib.compress(zlib.decompress(pixels), 9)))
        if kind[:1].isupper():  # the others are optional
            kept.append(_chunk(kind, data))
    return base64.b64encode(b"".join(kept)).decode("ascii")


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def written(notebook: Any) -> str:
    """A notebook as the text of its file."""
    nbformat.validate(notebook)
    return nbformat.writes(notebook, indent=1, ensure_ascii=False).rstrip("\n") + "\n"


def differences(kept: Any, fresh: Any) -> list[str]:
    """What the outputs that are kept say otherwise than those of a fresh run."""
    found = []
    for old, new in zip(kept.cells, fresh.cells, strict=True):
        if old.cell_type != "code":
            continue
        before, after = _said(old), _said(new)
        if before != after:
            place = next(
                (
                    i
                    for i, pair in enumerate(zip(before, after, strict=False))
                    if pair[0] != pair[1]
                ),
                min(len(before), len(after)),
            )
            pair = [(*said[place : place + 1], "nothing")[0] for said in (before, after)]
            found.append(f"{new.id}: kept {_short(pair[0])}, now {_short(pair[1])}")
    return found


def _said(cell: Any) -> list[Any]:
    """The outputs of a cell as far as they are compared."""
    found = []
    for output in cell.outputs:
        if "data" in output:
            data = {kind: "a plot" if kind in PLOTS else x for kind, x in output.data.items()}
            found.append((output.output_type, data))
        else:
            found.append((output.output_type, output.get("name", ""), output.get("text", "")))
    return found


def _short(said: Any) -> str:
    text = str(said)
    return text if len(text) < 300 else text[:300] + " ..."


def flaws(notebook: Any) -> list[str]:
    """What no output should hold: errors, warnings, paths of a machine."""
    found = []
    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            if output.output_type == "error":
                found.append(f"{cell.id}: {output.ename}")
            if output.get("name") == "stderr":
                found.append(f"{cell.id}: writes to stderr: {_short(output.text)}")
            texts = [output.get("text", "")]
            texts += [x for kind, x in output.get("data", {}).items() if kind not in PLOTS]
            for pattern in (PLACES, WORRIES):
                match = pattern.search("\n".join(texts))
                if match:
                    found.append(f"{cell.id}: an output holds {match[0]!r}")
    return found


def main() -> int:
    """Refresh or check, from the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("notebook", nargs="*", help="names of notebooks; all if left out")
    parser.add_argument("--check", action="store_true", help="write nothing, say what differs")
    given = parser.parse_args()
    wrong = 0
    for path in notebooks(given.notebook):
        kept = read(path)
        try:
            fresh = executed(kept)
        except CellExecutionError as error:
            problems = [str(error)]
        else:
            problems = flaws(fresh)
            if given.check:
                problems += differences(kept, fresh)
            elif not problems:
                path.write_text(written(fresh), encoding="utf-8")
        wrong += bool(problems)
        print(f"{path.stem}: {'current' if given.check else 'fresh'}" * (not problems), end="")
        print(*(f"{path.stem}: {problem}" for problem in problems), sep="\n")
    return min(wrong, 1)


if __name__ == "__main__":
    sys.exit(main())

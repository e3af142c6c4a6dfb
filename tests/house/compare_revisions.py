"""Compare everything that two revisions write for every example and twenty robots, byte by byte.

    python tests/house/compare_revisions.py BEFORE [AFTER]

BEFORE and AFTER are revisions as git knows them; without AFTER the working tree is compared. Both run with
the libraries of the interpreter that runs this script. The exit status is 1 if any file differs.
"""

from __future__ import annotations

import argparse
import contextlib
import filecmp
import importlib.util
import io
import os
import runpy
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).resolve().parents[2]
ROBOTS = 20
"""How many URDFs of the example-robot-data wheel are compared, evenly spread over their names."""

COMMANDS: dict[str, tuple[str, ...]] = {
    "emit": ("emit", "{model}", "--name", "m", "--tests", "--report", "--out", "{out}"),
    "batch": ("emit", "{model}", "--name", "b", "--batch", "--trig", "inline", "--out", "{out}"),
    "float": ("emit", "{model}", "--name", "f", "--real", "float", "--out", "{out}"),
    "graph": ("graph", "{model}", "--output", "{out}/graph.svg"),
    "both": ("graph", "{model}", "--what", "both", "--output", "{out}/both.svg"),
    "show": ("show", "{model}"),
    "trees": ("trees", "{model}"),
    "parameters": ("parameters", "{model}"),
    "derive": ("derive", "{model}", "--level", "fast", "--output", "{out}/derivation.md"),
    "html": ("derive", "{model}", "--level", "none", "--output", "{out}/derivation.html"),
    "latex": ("derive", "{model}", "--level", "none", "--output", "{out}/derivation.tex"),
}
"""What is run for each model; what a command prints is compared as well as the files that it writes."""

REQUESTED = (
    "linearize",
    "center_of_mass",
    "momentum",
    "kinematics",
    "regressor",
    "power",
    "inverse_dynamics_derivatives",
    "forward_dynamics_derivatives",
)
"""Functions on request, each emitted alone."""

FOR_ROBOTS = {"emit", "graph", "show"}
"""Commands for robots: their reports have no end."""


def models() -> dict[str, Path]:
    """All models that are compared, by the name of the folder that their files go to."""
    found = {
        "-".join(path.relative_to(ROOT / "examples").with_suffix("").parts): path
        for path in sorted((ROOT / "examples").rglob("*.toml"))
        if "notebooks" not in path.parts
    }
    return found | dict(_robots())


def _robots() -> list[tuple[str, Path]]:
    # `oracles.pinocchio_models` finds them too, but imports linegraph, which is another one for each revision
    found = importlib.util.find_spec("pinocchio")
    files = [
        path
        for folder in Path((found and found.origin) or "/").parents
        for path in sorted((folder / "share" / "example-robot-data" / "robots").rglob("*.urdf"))
    ]
    step = max(1, len(files) // ROBOTS)
    return [(f"robot-{path.stem}", path) for path in files[::step][:ROBOTS]]


def jobs(name: str, model: Path) -> dict[str, list[str]]:
    """The command lines for a model, by the name of what they print."""
    robot = name.startswith("robot-")
    lines = {k: line for k, line in COMMANDS.items() if not robot or k in FOR_ROBOTS}
    if not robot:
        emit = ("emit", "{model}", "--out", "{out}")
        for function in REQUESTED:
            lines[function] = (*emit, "--name", function, "--only", function)
    return {
        k: [word.format(model=model, out=f"out/{name}") for word in line]
        for k, line in lines.items()
    }


def write(names: list[str]) -> None:
    """Run all commands for some models here, below ``out`` in the current folder."""
    chosen = models()
    for name in names:
        folder = Path("out") / name
        folder.mkdir(parents=True)
        for job, line in jobs(name, chosen[name]).items():
            text = io.StringIO()
            sys.argv = ["linegraph", *line]
            with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
                try:
                    runpy.run_module("linegraph", run_name="__main__")
                except SystemExit as status:
                    print("exit status", status.code)
            (folder / f"{job}.txt").write_text(text.getvalue(), encoding="utf-8")


def run(tree: Path, work: Path) -> None:
    """Everything that the sources in a folder write, below ``out`` in another, on two processors."""
    work.mkdir()
    names = list(models())
    environment = {**os.environ, "PYTHONPATH": str(tree), "OPENBLAS_NUM_THREADS": "1"}

    def one(name: str) -> None:
        done = subprocess.run(
            [sys.executable, __file__, "--write", name],
            cwd=work,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            (work / "out" / name / "failed.txt").write_text(done.stderr, encoding="utf-8")

    with ThreadPoolExecutor(2) as pool:
        list(pool.map(one, names))


@contextlib.contextmanager
def revision(name: str | None, work: Path) -> Iterator[Path]:
    """The folder of a revision's sources; the working tree without a name."""
    if name is None:
        yield ROOT
        return
    tree = work / f"tree-{name.replace('/', '_')}"
    git = ["git", "-C", str(ROOT), "worktree"]
    subprocess.run([*git, "add", "--quiet", "--detach", str(tree), name], check=True)
    try:
        yield tree
    finally:
        subprocess.run([*git, "remove", "--force", str(tree)], check=True)


def files(folder: Path) -> set[str]:
    """All files below a folder."""
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def main() -> int:
    """Write with both revisions and tell which files differ."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("before", nargs="?", help="a revision")
    parser.add_argument("after", nargs="?", help="another; the working tree without it")
    parser.add_argument("--write", nargs="*", help=argparse.SUPPRESS)
    parser.add_argument(
        "--keep", type=Path, help="a folder that is kept, with all that was written"
    )
    given = parser.parse_args()
    if given.write is not None:
        write(given.write)
        return 0
    if given.before is None:
        parser.error("which revision?")
    work = given.keep or Path(tempfile.mkdtemp(prefix="linegraph-"))
    work.mkdir(parents=True, exist_ok=True)
    written = []
    for side, name in (("before", given.before), ("after", given.after)):
        where = work / side
        if not where.exists():
            with revision(name, work) as tree:
                run(tree, where)
        written.append(where / "out")
    before, after = map(files, written)
    differing = [
        name
        for name in sorted(before & after)
        if not filecmp.cmp(written[0] / name, written[1] / name, shallow=False)
    ]
    only = [f"{name} (only before)" for name in sorted(before - after)]
    only += [f"{name} (only after)" for name in sorted(after - before)]
    for name in [*differing, *only]:
        print(name)
    print(
        f"{len(before & after)} files compared, {len(differing)} differ, {len(only)} on one side only"
    )
    return 1 if differing or only else 0


if __name__ == "__main__":
    sys.exit(main())

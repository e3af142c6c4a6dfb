"""The packages of linegraph from the ground up, and every import between them.

python tests/house/rooms.py            draw docs/rooms.svg
python tests/house/rooms.py --count    print how many files, packages, arrows and circles there are
"""

from __future__ import annotations

import ast
import sys
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import networkx as nx

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("linegraph", "codegen")

ROOMS = (
    "errors",
    "version",
    "exits",
    "tolerance",
    "display",
    "files",
    "ir",
    "codegen",
    "algebra",
    "graph",
    "spatial",
    "components",
    "model",
    "networks",
    "formulation",
    "kinematics",
    "dynamics",
    "paper",
    "numeric",
    "pipeline",
    "notation",
    "symbolic",
    "identification",
    "programs",
    "drawing",
    "evaluation",
    "readers",
    "verification",
    "emission",
    "derivation",
    "notebook",
    "report",
    "cli",
    "__main__",
)
"""Packages and modules of the root, from the ground up: each imports only those listed before it."""


class Import(NamedTuple):
    """Module `source` imports module `target`; `lazy` inside a function, `typing` for types only."""

    source: str
    target: str
    lazy: bool
    typing: bool


@cache
def files() -> dict[str, Path]:
    """Every module's file by its dotted name."""
    found = {}
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            parts = path.relative_to(ROOT).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@cache
def parsed(path: Path) -> ast.Module:
    """The syntax tree of a file."""
    return ast.parse(path.read_text(encoding="utf-8"))


def imports(name: str, path: Path) -> Iterator[Import]:
    """All imports of a module, those in functions and under TYPE_CHECKING too."""

    def walk(node: ast.AST, lazy: bool, typing: bool) -> Iterator[Import]:
        if isinstance(node, ast.Import):
            yield from (Import(name, alias.name, lazy, typing) for alias in node.names)
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{name}: a relative import"
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                target = whole if whole in files() else str(node.module)
                yield Import(name, target, lazy, typing)
        lazy = lazy or isinstance(node, ast.FunctionDef)
        typing = typing or (isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING")
        for child in ast.iter_child_nodes(node):
            yield from walk(child, lazy, typing)

    yield from walk(parsed(path), False, False)


@cache
def all_imports() -> tuple[Import, ...]:
    """The imports of all modules."""
    return tuple(found for name, path in files().items() for found in imports(name, path))


def room(module: str) -> str:
    """The package of the root, or the module there, that a module belongs to."""
    first, *rest = module.split(".")
    return first if first == "codegen" or not rest else rest[0]


def ours() -> list[Import]:
    """Imports of modules of this project; those of the package's own names by `linegraph` left out."""
    return [
        found
        for found in all_imports()
        if found.target.split(".")[0] in PACKAGES and found.source != "linegraph"
    ]


def between_rooms() -> list[Import]:
    """Imports from one package to another."""
    return [found for found in ours() if room(found.source) != room(found.target)]


def upward() -> list[Import]:
    """Imports of a package that is not below."""
    level = {name: k for k, name in enumerate(ROOMS)}
    return [x for x in between_rooms() if level[room(x.target)] >= level[room(x.source)]]


def circles() -> list[list[str]]:
    """Files that import each other, directly or not."""
    graph = nx.DiGraph((x.source, x.target) for x in ours() if x.source != x.target)
    return [sorted(part) for part in nx.strongly_connected_components(graph) if len(part) > 1]


def counts() -> dict[str, int]:
    """How large the house is."""
    modules = [name for name in files() if name.startswith("linegraph.")]
    roots = [n for n in modules if n.count(".") == 1 and files()[n].name != "__init__.py"]
    return {
        "files": len(files()),
        "modules in the root": len(roots) + 1,
        "packages": len({room(name) for name in modules} - {n.split(".")[1] for n in roots}),
        "imports": len(ours()),
        "upward": len(upward()),
        "circles": len(circles()),
        "files in circles": sum(map(len, circles())),
    }


if __name__ == "__main__":
    for what, count in counts().items():
        print(f"{what:20} {count}")
    if "--list" in sys.argv:
        for found in upward():
            print(f"{found.source} -> {found.target}", "lazy" * found.lazy, "type" * found.typing)
        for part in circles():
            print("circle:", ", ".join(part))

"""Put random faults of sign, index and operand into the equations of motion and see whether tests notice.

    python tests/house/faults.py [COUNT] [SEED]

For each fault the package is copied, one place of `linegraph/dynamics` or `linegraph/kinematics` is changed,
and tests run until one fails, the fast ones first. Faults that none notices are printed; the exit status is 1
if there are any. What changes no value, such as the sign of a zero, has to be judged by reading.
"""

from __future__ import annotations

import ast
import os
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
FILES = (
    "dynamics/applied_forces.py",
    "dynamics/articulated.py",
    "dynamics/chords.py",
    "dynamics/composite_bias.py",
    "dynamics/composite_derivatives.py",
    "dynamics/edge_variables.py",
    "dynamics/equations.py",
    "dynamics/force_laws.py",
    "dynamics/mass_matrix.py",
    "dynamics/momentum.py",
    "dynamics/network_state.py",
    "dynamics/orthogonality.py",
    "dynamics/whole_system.py",
    "kinematics/accelerations.py",
    "kinematics/arms.py",
    "kinematics/ground_frames.py",
    "kinematics/twists.py",
)
STAGES = (
    ("tests/dynamics", "tests/kinematics"),
    (
        "tests/agreement/test_derivation.py",
        "tests/agreement/test_closed_loops.py",
        "tests/agreement/test_kinematics.py",
        "tests/agreement/test_random_systems.py",
        "tests/agreement/test_random_mixed.py",
        "tests/agreement/test_stored_energy.py",
        "tests/components/test_drag.py",
        "tests/programs",
        "tests/conformance/test_golden.py",
        "tests/conformance/test_components.py",
        "tests/conformance/test_constraints.py",
    ),
)
"""Tests of the first stage take seconds, those of the second a minute or two."""

SWAPPED = {ast.Add: ast.Sub, ast.Sub: ast.Add}


class Fault(NamedTuple):
    """A change of one place of a file.

    Attributes:
        file: relative to the package.
        line: where it is.
        text: the whole file with the change.
        about: what is changed.
    """

    file: str
    line: int
    text: str
    about: str


class _Change(ast.NodeTransformer):
    """Changes the place with a given number, in the order of the walk; counts all."""

    def __init__(self, place: int) -> None:
        self.place, self.seen = place, 0
        self.line, self.about = 0, ""

    def _here(self, node: ast.expr, about: str) -> bool:
        self.seen += 1
        if self.seen - 1 == self.place:
            self.line, self.about = node.lineno, about
            return True
        return False

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        self.generic_visit(node)
        other = SWAPPED.get(type(node.op))
        if other is not None and self._here(node, f"{ast.unparse(node)}: sign"):
            return ast.copy_location(ast.BinOp(node.left, other(), node.right), node)
        return node

    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.AST:
        self.generic_visit(node)
        if isinstance(node.op, ast.USub) and self._here(node, f"{ast.unparse(node)}: sign"):
            return node.operand
        return node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        self.generic_visit(node)
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name in ("add", "subtract") and self._here(node, f"{ast.unparse(node)}: sign"):
            other = {"add": "subtract", "subtract": "add"}[name]
            return ast.copy_location(
                ast.Call(ast.Attribute(ast.Name("vector"), other), node.args, []), node
            )
        if name == "cross" and self._here(node, f"{ast.unparse(node)}: operands"):
            return ast.copy_location(ast.Call(node.func, node.args[::-1], []), node)
        return node

    def visit_Subscript(self, node: ast.Subscript) -> ast.AST:
        self.generic_visit(node)
        at = node.slice
        if (
            isinstance(at, ast.Constant)
            and at.value in (0, 1, 2)
            and isinstance(node.ctx, ast.Load)
            and self._here(node, f"{ast.unparse(node)}: index")
        ):
            changed = ast.Constant((at.value + 1) % 3 if at.value else 1)
            return ast.copy_location(ast.Subscript(node.value, changed, node.ctx), node)
        return node


def faults(count: int, seed: int) -> list[Fault]:
    """Random faults, spread over all places of all files."""
    places = []
    for file in FILES:
        counting = _Change(-1)
        counting.visit(ast.parse((ROOT / "linegraph" / file).read_text(encoding="utf-8")))
        places += [(file, k) for k in range(counting.seen)]
    found = []
    for file, k in sorted(random.Random(seed).sample(places, min(count, len(places)))):
        tree = ast.parse((ROOT / "linegraph" / file).read_text(encoding="utf-8"))
        change = _Change(k)
        changed = ast.fix_missing_locations(change.visit(tree))
        text = ast.unparse(changed)
        if "vector.add(" in text or "vector.subtract(" in text:
            future = "from __future__ import annotations\n"
            text = text.replace(future, f"{future}from linegraph.spatial import vector\n", 1)
        found.append(Fault(file, change.line, text, change.about))
    return found


def noticed(fault: Fault) -> bool:
    """Whether a test fails."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder)
        for name in ("linegraph", "codegen", "templates", "tests", "examples", "docs"):
            shutil.copytree(ROOT / name, copy / name, symlinks=True)
        for name in ("pyproject.toml", "README.md", "CONTRIBUTING.md"):
            shutil.copy(ROOT / name, copy / name)
        (copy / "linegraph" / fault.file).write_text(fault.text, encoding="utf-8")
        here = {**os.environ, "PYTHONPATH": str(copy)}
        for stage in STAGES:
            command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", *stage]
            done = subprocess.run(command, cwd=copy, env=here, capture_output=True, check=False)
            if done.returncode == 1:
                return True
            if done.returncode != 0:
                print(done.stdout.decode()[-2000:])
                return True
    return False


def main() -> int:
    """Try the faults; the number that no test notices."""
    given = [int(x) for x in sys.argv[1:3]]
    count, seed = (*given, *(150, 0)[len(given) :])
    missed = 0
    for number, fault in enumerate(faults(count, seed)):
        seen = noticed(fault)
        missed += not seen
        mark = "noticed" if seen else "MISSED"
        print(f"{number:4} {mark:8} {fault.file}:{fault.line}  {fault.about}", flush=True)
    print(f"{missed} missed")
    return 1 if missed else 0


if __name__ == "__main__":
    raise SystemExit(main())

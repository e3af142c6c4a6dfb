"""Counts the operations in emitted C, function by function, from its text alone.

    python tests/benchmarks/operations.py build/panda/panda.c

Every + - * / counts as one, a sign too, and every call of sin, cos or sqrt. Without an argument: the
robots whose counts the project watches, where the example-robot-data wheel is installed.
"""

from __future__ import annotations

import re
import sys
import tempfile
from pathlib import Path

FUNCTION = re.compile(
    # a long function is written in parts, and one that reports a status as two: they count as one
    r"^(?:[A-Z0-9_]+_PART )?(?:void|int) (\w+?)(?:_core)?(?:_part\d+)?\([^;{]*\)\n\{\n(.*?)^\}",
    re.MULTILINE | re.DOTALL,
)
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
EXPONENT = re.compile(r"(?<=[\d.])e[+-](?=\d)")
SIGN = re.compile(r"((?:[=(,+\-*/]|\breturn)\s*)-")
WATCHED = {
    # robot: file, base, locked joints
    "panda": ("panda_description/urdf/panda.urdf", "fixed", ("panda_finger_joint1",)),
    "ur5": ("ur_description/urdf/ur5_robot.urdf", "fixed", ()),
    "talos": ("talos_data/robots/talos_reduced.urdf", "floating", ()),
    "solo12": ("solo_description/robots/solo12.urdf", "floating", ()),
    "anymal": ("anymal_b_simple_description/robots/anymal.urdf", "floating", ()),
}


def operations(source: str, *, signs: bool = True) -> dict[str, int]:
    """Operations of each function in the text of a C file, with or without those that change a sign."""
    counts: dict[str, int] = {}
    for name, body in FUNCTION.findall(source):
        if f"{name}_core(" in body:
            continue  # it looks at arguments and results, and computes nothing
        counts[name] = counts.get(name, 0) + _count(body, signs=signs)
    return counts


def _count(body: str, *, signs: bool) -> int:
    text = EXPONENT.sub("e", COMMENT.sub("", body))
    text = re.sub(r"\[[^\]]*\]|->", "", text)
    if not signs:
        text = SIGN.sub(r"\1", text)
    return sum(map(text.count, "+-*/")) + len(re.findall(r"\b(?:sin|cos|sqrt)\(", text))


def emitted(robot: str) -> str:
    """The C file of one of the watched robots, by the command line."""
    from click.testing import CliRunner

    sys.path[:0] = [str(Path(__file__).parent.parent), str(Path(__file__).parent.parent.parent)]
    from oracles.pinocchio_models import robots_folder

    from linegraph.cli.main import main

    file, base, locks = WATCHED[robot]
    with tempfile.TemporaryDirectory() as folder:
        command = ["emit", str(robots_folder() / file), "--out", folder, "--lang", "c"]
        command += ["--base", base, "--name", robot, *(f"--lock={lock}" for lock in locks)]
        done = CliRunner().invoke(main, command)
        if done.exit_code:
            raise SystemExit(done.output)
        return (Path(folder) / f"{robot}.c").read_text()


def main() -> None:
    """Print a table."""
    given = {Path(name).stem: Path(name).read_text() for name in sys.argv[1:]}
    for robot, source in (given or {robot: emitted(robot) for robot in WATCHED}).items():
        for name, count in operations(source).items():
            print(f"{robot:10s} {name:32s} {count:8d}")


if __name__ == "__main__":
    main()

"""What generating costs: CPU seconds and peak memory of whole processes, beside one `import sympy`.

    python tests/benchmarks/generation.py

Each line is the median of several runs, the peers interleaved with ours. The last column is the CPU time
in units of `import sympy` measured in the same run.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
RUNS = 7
CHAIN = """<robot name="chain{n}"><link name="b0"/>{links}</robot>"""
LINK = (
    '<link name="b{i}"><inertial><origin xyz=".1 .2 .3"/><mass value="1"/>'
    '<inertia ixx=".1" iyy=".2" izz=".25" ixy=".01" ixz=".02" iyz=".03"/></inertial></link>'
    '<joint name="j{i}" type="revolute"><parent link="b{p}"/><child link="b{i}"/>'
    '<origin xyz="0 0 .5" rpy=".3 .2 .1"/><axis xyz="{axis}"/>{limit}</joint>'
)
LIMIT = '<limit lower="-3" upper="3" effort="100" velocity="10"/>'  # the format asks for one
PLANAR_LINK = (
    '<link name="b{i}"><inertial><origin xyz=".25 0 0"/><mass value="1"/>'
    '<inertia ixx=".01" iyy=".02" izz=".02" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    '<joint name="j{i}" type="revolute"><parent link="b{p}"/><child link="b{i}"/>'
    '<origin xyz=".5 0 0"/><axis xyz="0 1 0"/>{limit}</joint>'
)


def chain(n: int, folder: Path) -> Path:
    """A URDF of n revolute links one after the other, with rotated frames and turning axes."""
    axes = ("0 0 1", "1 0 0", "0 1 0")
    links = "".join(
        LINK.format(i=i, p=i - 1, axis=axes[i % 3], limit=LIMIT) for i in range(1, n + 1)
    )
    path = folder / f"chain{n}.urdf"
    path.write_text(CHAIN.format(n=n, links=links))
    return path


def planar_chain(n: int, folder: Path) -> Path:
    """A URDF of n revolute links whose axes are parallel, in a vertical plane."""
    links = "".join(PLANAR_LINK.format(i=i, p=i - 1, limit=LIMIT) for i in range(1, n + 1))
    path = folder / f"planar{n}.urdf"
    path.write_text(CHAIN.format(n=n, links=links).replace('"chain', '"planar'))
    return path


def cost(command: list[str]) -> tuple[float, float]:
    """CPU seconds and peak memory (MiB) of one run of a command."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"failed: {' '.join(command)}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def jobs(folder: Path) -> dict[str, list[str]]:
    """What is measured, by name."""
    sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parent.parent)]
    from operations import WATCHED
    from oracles.pinocchio_models import robots_folder

    linegraph = [sys.executable, "-m", "linegraph"]
    found = {"import sympy": [sys.executable, "-c", "import sympy"]}
    found["linegraph --help"] = [*linegraph, "--help"]
    for robot, (file, base, locks) in WATCHED.items():
        command = [*linegraph, "emit", str(robots_folder() / file), "--out", str(folder)]
        found[robot] = [*command, "--base", base, *(f"--lock={lock}" for lock in locks)]
    for n in (25, 50, 100, 200):
        found[f"chain of {n}"] = [*linegraph, "emit", str(chain(n, folder)), "--out", str(folder)]
    return found


def main() -> None:
    """Print the table."""
    os.environ["PYTHONPATH"] = str(HERE.parent.parent)
    with tempfile.TemporaryDirectory() as name:
        commands = jobs(Path(name))
        costs: dict[str, list[tuple[float, float]]] = {job: [] for job in commands}
        for run in range(RUNS):
            for job, command in commands.items():
                if run == 0 or not job.startswith("chain"):
                    costs[job].append(cost(command))
    unit = statistics.median(cpu for cpu, _ in costs["import sympy"])
    print(f"{'':20s} {'CPU / s':>9s} {'MiB':>7s} {'sympy':>7s}")
    for job, runs in costs.items():
        cpu = statistics.median(cpu for cpu, _ in runs)
        memory = max(memory for _, memory in runs)
        print(f"{job:20s} {cpu:9.3f} {memory:7.0f} {cpu / unit:7.2f}")


if __name__ == "__main__":
    main()

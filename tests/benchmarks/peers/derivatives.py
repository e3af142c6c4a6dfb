"""Operations of derivatives, linegraph beside CasADi's Jacobians of Pinocchio's algorithms.

    python tests/benchmarks/peers/derivatives.py [ROBOT ...]

Uses the environment of the other peers, which the first run makes. Each of CasADi's rows takes the convention
(frames in the axes of the joints or of the world) that takes fewer operations.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import environment  # noqa: E402

FUNCTIONS = ("inverse_dynamics_derivatives", "forward_dynamics_derivatives")


def main() -> None:
    """Print a table."""
    environment.enter(Path(__file__))
    import robots
    from casadi_peer import FREE

    from linegraph.emission.emit import module_for
    from linegraph.readers.read import read

    folder = environment.BUILD / "derivatives"
    for name in sys.argv[1:] or ("ur5", "panda", "anymal", "talos"):
        robot = robots.robot(name, folder)
        kinds = [f"{f}{mark}" for f in FUNCTIONS for mark in ("", "_world")]
        command = [str(environment.casadi_generator()), str(robot.urdf), robot.base, str(folder)]
        made = json.loads(environment.run([*command, *kinds]))["functions"]
        theirs = {
            kind: sum(n for code, n in made[kind]["codes"].items() if int(code) not in FREE)
            for kind in kinds
        }
        programs = module_for(
            read(str(robot.urdf), base=robot.base), name, folded=True, only=FUNCTIONS
        ).programs
        ours = {program.name: program.operations for program in programs}
        for function in FUNCTIONS:
            best = min(theirs[function], theirs[f"{function}_world"])
            ratio = ours[function] / best
            print(f"{name:10s} {function:32s} {ours[function]:8d} {best:8d} {ratio:6.2f}")


if __name__ == "__main__":
    main()

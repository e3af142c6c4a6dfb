"""linegraph beside its peers: run time, instructions, operations, generation, compilation, in one run.

    python tests/benchmarks/peers
    python tests/benchmarks/peers --robots panda,talos --skip sympy,mujoco --quick

Any Python from 3.11 on will do: CasADi, Pinocchio, MuJoCo and SymPy go into a virtual environment of
their own under build/peers, with linegraph from this checkout. The first run installs them and compiles
two C++ programs, which takes some minutes. gcc and g++ must be there; valgrind counts instructions if it is.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from environment import enter  # noqa: E402

SKIPPABLE = ("casadi", "pinocchio", "mujoco", "sympy", "batch", "instructions", "generation")


def options() -> argparse.Namespace:
    """What the command line says."""
    parser = argparse.ArgumentParser(
        prog="peers", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    words = {"type": lambda text: tuple(text.split(","))}
    parser.add_argument("--robots", **words, help="names, chainN and planarN among them")
    parser.add_argument("--functions", **words, help="equations, inverse_dynamics, ...")
    parser.add_argument("--skip", **words, default=(), help=", ".join(SKIPPABLE))
    parser.add_argument("--sympy-links", **words, default=("2", "3", "4"), help="default 2,3,4")
    parser.add_argument("--quick", action="store_true", help="few rounds, no instructions")
    parser.add_argument("--processes", type=int, help="in which each call is timed; default 15")
    parser.add_argument("--output", type=Path, metavar="FILE.json", help="keep all figures")
    parser.add_argument("--input", type=Path, metavar="FILE.json", help="show kept figures again")
    parser.add_argument("--plot", type=Path, metavar="FILE.svg", help="draw times of M and h")
    parser.add_argument("--readme", action="store_true", help="print the README's table instead")
    found = parser.parse_args()
    if unknown := set(found.skip) - set(SKIPPABLE):
        parser.error(f"cannot skip {', '.join(sorted(unknown))}")
    return found


def main() -> None:
    """Measure, or read what was measured; then show it."""
    chosen = options()
    enter()
    import plot
    import tables
    from calls import FUNCTIONS
    from robots import CHAINS, ROBOTS
    from study import Plan, study

    if chosen.input:
        found = json.loads(chosen.input.read_text())
    else:
        skip = {*chosen.skip, *(["instructions"] if chosen.quick else [])}
        plan = Plan(
            robots=chosen.robots or (*ROBOTS, *CHAINS),
            functions=chosen.functions or FUNCTIONS,
            skip=frozenset(skip),
            processes=chosen.processes or (3 if chosen.quick else 15),
            rounds=5,
            milliseconds=1.0,
            runs=1 if chosen.quick else 5,
            links=[int(n) for n in chosen.sympy_links],
        )
        found = study(plan)
    print(tables.markdown(found) if chosen.readme else tables.report(found))
    if chosen.output:
        chosen.output.write_text(json.dumps(found, indent=1) + "\n")
    if chosen.plot:
        plot.draw(found, chosen.plot)


if __name__ == "__main__":
    main()

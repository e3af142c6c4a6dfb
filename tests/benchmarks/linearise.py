"""`linearise` in letters, beside sympy's `DomainMatrix` on the same matrices.

    python tests/benchmarks/linearise.py
    python tests/benchmarks/linearise.py --seconds 120 --only pendulum

Each line is one process with one thread, after all imports and after `derive`, M and h in closed form: CPU
seconds of `DomainMatrix.lu_solve` of M and K = ∂h/∂q at rest, and of all of `linearise`, which derives M and
K anew, differentiates, solves, writes and proves; and the operations (`sympy.count_ops`) of both. What
`DomainMatrix` has not solved in time has no figures. Every parameter is a letter.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import time
from pathlib import Path
from typing import Any

sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parents[2])]

import sympy  # noqa: E402
from support.linear_models import SYSTEMS  # noqa: E402
from sympy.polys.matrices import DomainMatrix  # noqa: E402

import linegraph as lg  # noqa: E402

SIZES = (2, 3, 4, 6)
POINTS = ("row", "pendulum", "pendulum on a cart")


def measured(name: str, size: int, out: Any) -> None:
    """Seconds and operations: first linegraph's, then sympy's."""
    derivation = lg.derive(SYSTEMS[name](size))
    still = dict.fromkeys([*derivation.q, *derivation.v], 0)
    mass = derivation.mass_matrix.subs(still)
    stiffness = derivation.bias.jacobian(derivation.q).subs(still)
    start = time.process_time()
    space = derivation.linearise()
    out.put((time.process_time() - start, int(sympy.count_ops(space.A))))
    start = time.process_time()
    M, K = DomainMatrix.from_Matrix(mass).unify(DomainMatrix.from_Matrix(stiffness))
    found = M.to_field().lu_solve(K.to_field()).to_Matrix()
    out.put((time.process_time() - start, int(sympy.count_ops(found))))


def main() -> None:
    """Print a line for each system."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--seconds", type=float, default=60.0, help="that DomainMatrix may take")
    parser.add_argument("--only", choices=POINTS, help="one kind of system")
    chosen = parser.parse_args()
    print("| system | n | linearise, s | operations | DomainMatrix, s | operations | ratio |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for name in [chosen.only] if chosen.only else POINTS:
        for size in SIZES:
            out: Any = multiprocessing.Queue()
            process = multiprocessing.Process(target=measured, args=(name, size, out))
            process.start()
            ours, operations = out.get()
            process.join(chosen.seconds)
            there = ("-", "-", "-")
            if process.is_alive():
                process.kill()
                process.join()
            else:
                theirs, count = out.get()
                there = (f"{theirs:.4f}", str(count), f"{ours / theirs:.2f}")
            print(
                f"| {name} | {size} | {ours:.4f} | {operations} | {' | '.join(there)} |", flush=True
            )


if __name__ == "__main__":
    main()

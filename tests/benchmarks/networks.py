"""What motors and circuits add to an arm: CPU time of generation and operations, beside the bare arm.

    python tests/benchmarks/networks.py

The arm is `examples/arm_with_drives`; the bare arm is the same without its networks, an effort in each
joint. Both are read and rendered in C and Python in one process, interleaved; shown are the best of several
runs. Then how the cost of a ladder of R, L and C grows with its length.
"""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

from linegraph import Model
from linegraph.emission import emit as emission
from linegraph.ir.program import Program
from linegraph.readers import modelfile

ARM = Path(__file__).parents[2] / "examples" / "arm_with_drives" / "arm_with_drives.toml"
RUNS = 15
FUNCTIONS = ("mass_matrix", "bias", "equations", "inverse_dynamics", "forward_dynamics", "energy")


def driven() -> Model:
    """The arm with its drives."""
    model = modelfile.read(ARM)
    model.outputs.clear()
    return model


def bare() -> Model:
    """The same mechanics, moved by efforts."""
    model = driven()
    model._components.clear()
    model._inputs.clear()
    model._joints = {name: replace(joint, effort=True) for name, joint in model._joints.items()}
    return model


def operations(model: Model) -> dict[str, int]:
    """Of each function, what it calls included."""
    programs = {
        p.name: p for p in emission.module_for(model, "counted").programs if isinstance(p, Program)
    }

    def of(name: str) -> int:
        program = programs[name]
        return program.operations + sum(of(call.program) for call in program.calls)

    return {name: of(name) for name in FUNCTIONS}


def seconds(make: object) -> float:
    """CPU seconds of reading and rendering once."""
    start = time.process_time()
    emission.render(make())  # type: ignore[operator]
    return time.process_time() - start


def ladder(n: int) -> Model:
    """So many stages of R and L along, C across."""
    model = Model("ladder")
    model.input("u", "V")
    model.voltage_source("s", ("n0", "ground"), voltage="u")
    for k in range(n):
        model.resistor(f"R{k}", (f"n{k}", f"m{k}"), resistance=1.0 + k / n)
        model.inductor(f"L{k}", (f"m{k}", f"n{k + 1}"), inductance=1e-3)
        model.capacitor(f"C{k}", (f"n{k + 1}", "ground"), capacitance=1e-6)
    return model


def main() -> None:
    """Print both tables."""
    times: dict[str, list[float]] = {"driven": [], "bare": []}
    for _ in range(RUNS):
        times["driven"].append(seconds(driven))
        times["bare"].append(seconds(bare))
    best = {name: min(found) for name, found in times.items()}
    print(f"{'':20}{'with drives':>14}{'bare':>10}{'ratio':>8}")
    print(
        f"{'CPU / s':20}{best['driven']:14.4f}{best['bare']:10.4f}{best['driven'] / best['bare']:8.2f}"
    )
    ours, theirs = operations(driven()), operations(bare())
    for name in FUNCTIONS:
        print(f"{name:20}{ours[name]:14}{theirs[name]:10}{ours[name] / theirs[name]:8.2f}")
    print(f"\n{'ladder, stages':20}{'CPU / s':>14}{'operations of forward_dynamics':>34}")
    for n in (10, 20, 40, 80, 160):
        spent = seconds(lambda n=n: ladder(n))
        print(f"{n:<20}{spent:14.3f}{operations(ladder(n))['forward_dynamics']:34}")


if __name__ == "__main__":
    main()

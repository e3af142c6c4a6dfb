"""A state beside the given one: near a singular position, the two tell the error of results."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.ir.algorithms.language import reals
from linegraph.ir.algorithms.sizes import unit

if TYPE_CHECKING:
    from linegraph.ir.algorithms.language import ModuleAtState, Reals


def overshoot(n: int, error: Reals, more: float, of_row: Reals, change: Reals) -> None:
    """Changes of n constraints that take their errors to zero and on by `more` of the sizes of the rows."""
    for i in range(n):
        beyond = more * of_row[i]
        change[i] = beyond - error[i] if error[i] < 0.0 else -beyond - error[i]


def move(module: ModuleAtState, step: Reals, at: Reals) -> None:
    """Move positions `at` by a step along the velocities, N(q) step, with N of the given positions."""
    NQ = module.NQ
    slope = reals(NQ)
    module.coordinate_rates(slope, v=step)
    for i in range(NQ):
        at[i] += slope[i]
    if len(module.quaternions) > 0:
        unit(module, at)

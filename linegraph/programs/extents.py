"""Names of counts for the extents of arrays: emitted code has ``q[NQ]`` instead of ``q[7]``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from linegraph.ir.program import counts_of

if TYPE_CHECKING:
    from linegraph.ir.program import Argument, Module, Result

EXTENTS = {
    **dict.fromkeys(("q", "qdot", "q_on"), ("NQ",)),
    **dict.fromkeys(("v", "a", "tau", "h", "f", "rest", "v_on"), ("NV",)),
    "c": ("NK",),
    "M": ("NV", "NV"),
    "u": ("NU",),
    "phi": ("NP",),
    "J": ("NC", "NV"),
    "Y": ("NV", "NPI"),
    "T": ("NV", "NI"),
    "Mr": ("NI", "NI"),
    **dict.fromkeys(("dtau_dq", "da_dq"), ("NV", "NT")),
    **dict.fromkeys(("dtau_dv", "dtau_da", "da_dv"), ("NV", "NV")),
    "da_du": ("NV", "NU"),
    "A": ("NDX", "NDX"),
    "B": ("NDX", "NU"),
    **dict.fromkeys(("hr", "s", "w"), ("NI",)),
}
"""The counts of arguments and results, by names that mean the same in all functions."""


def named(module: Module) -> Module:
    """The module with counts as extents of all arguments and results that have none yet.

    A count is used only if its value is the actual size.
    """
    counts = counts_of(module)
    listed = {result: x.count for x in module.listings for result in x.sizes}

    def count(name: str, size: int | None, axis: int) -> str:
        expected = EXTENTS.get(name, ())
        found = expected[axis] if axis < len(expected) else listed.get(name, "")
        return found if found and counts.get(found) == size else ""

    def argument(x: Argument) -> Argument:
        return replace(x, count=x.count or count(x.name, x.size, 0))

    def result(x: Result) -> Result:
        found = tuple(count(x.name, size, axis) for axis, size in enumerate(x.shape))
        return replace(x, counts=x.counts or found)

    return replace(
        module,
        programs=tuple(
            replace(
                program,
                arguments=tuple(map(argument, program.arguments)),
                results=tuple(map(result, program.results)),
            )
            for program in module.programs
        ),
    )

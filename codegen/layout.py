"""What the files of all languages say alike: sizes by name, and the head."""

from __future__ import annotations

from typing import TYPE_CHECKING

from codegen import prose
from linegraph.ir.program import Listing

if TYPE_CHECKING:
    from linegraph.ir.program import Module, Quantity, Result

_SIZES = {
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
"""The counts a reader expects as an array's extents; all others are plain numbers."""


def counts(module: Module) -> dict[str, int]:
    """How many positions, velocities, inputs and the like there are, by the names all languages give them."""
    return {x.count: len(x.quantities) for x in named(module)} | dict(module.counts)


def extent(module: Module, name: str, size: int, prefix: str = "", axis: int = 0) -> str:
    """The size of the array `name` as a reader expects it: ``prefix + NV`` rather than ``7``."""
    expected = _SIZES.get(name, ())
    listed = {result: x.count for x in module.listings for result in x.sizes}
    count = expected[axis] if axis < len(expected) else listed.get(name, "")
    return f"{prefix}{count}" if counts(module).get(count) == size else str(size)


def shape(module: Module, result: Result, prefix: str = "") -> list[str]:
    """The extents of a result, each as `extent` says it, or by the counts that the result itself names."""
    if result.counts:
        pairs = zip(result.counts, result.shape, strict=True)
        return [f"{prefix}{count}" if count else str(size) for count, size in pairs]
    return [
        extent(module, result.name, size, prefix, axis) for axis, size in enumerate(result.shape)
    ]


def named(module: Module) -> tuple[Listing, ...]:
    """What has a count and an array of names."""
    return (
        Listing("q", "NQ", "positions", module.positions),
        Listing("v", "NV", "velocities", module.velocities),
        Listing("u", "NU", "inputs", module.inputs),
        *module.listings,
    )


def head(module: Module) -> list[str]:
    """What the head of a file says of this module, in plain lines: description and quantities."""
    lines: list[str] = []
    for text in module.about:
        lines += [*prose.paragraph(text), ""]
    for listing in (*named(module), Listing("p", "", "parameters", module.parameters)):
        if listing.quantities and listing.shown:
            value = "value, " if listing.symbol == "p" else ""
            symbol = listing.sizes[0] if listing.sizes else listing.symbol
            meaning = "" if listing.groups else ", meaning"
            title = f"{symbol}, the {listing.heading}: index, name, {value}unit{meaning}"
            rows = [quantity for quantity, _ in listing.groups] or listing.quantities
            sizes = [size for _, size in listing.groups]
            lines += [*prose.paragraph(title), *prose.table(rows, sizes), ""]
    return lines[:-1]


def default(parameter: Quantity) -> float:
    """The value of a parameter unless the caller says otherwise."""
    if parameter.value is None:
        raise ValueError(f"parameter {parameter.name!r} has no value")
    return parameter.value

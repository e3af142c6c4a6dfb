"""Text common to the files of all languages: names of sizes, and the head."""

from __future__ import annotations

from typing import TYPE_CHECKING

from codegen import prose
from linegraph.ir.program import Listing, named_listings

if TYPE_CHECKING:
    from linegraph.ir.program import Argument, Module, Quantity, Result


def extent(argument: Argument, prefix: str = "") -> str:
    """The size of an array argument as text: the name of a count such as ``NV``, or else a number.

    Args:
        argument: an array.
        prefix: precedes the name of a count.
    """
    return f"{prefix}{argument.count}" if argument.count else str(argument.size)


def shape(result: Result, prefix: str = "") -> list[str]:
    """The extents of a result as texts: names of counts where they have one, or else numbers.

    Args:
        result: an array of any dimension.
        prefix: precedes the names of counts.
    """
    names = result.counts or ("",) * len(result.shape)
    pairs = zip(names, result.shape, strict=True)
    return [f"{prefix}{name}" if name else str(size) for name, size in pairs]


def head(module: Module) -> list[str]:
    """The head of a file in plain lines: the module's description and its quantities."""
    lines: list[str] = []
    for text in module.about:
        lines += [*prose.paragraph(text), ""]
    for listing in (*named_listings(module), Listing("p", "", "parameters", module.parameters)):
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

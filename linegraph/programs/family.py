"""Additions of a family of functions to a file besides the functions: lists of names, counts, remarks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from linegraph.ir.program import Listing
    from linegraph.programs.workspace import Workspace


def _nothing(f: Workspace, chosen: Sequence[str]) -> tuple[Any, ...]:
    return ()


class Family(NamedTuple):
    """Additions of a family of functions to a file, made after its functions.

    Each is called with the shared equations and the keys of `register.PROGRAMS` that were made.

    Attributes:
        listings: arrays of names that the file declares.
        counts: named sizes, each a pair of name and number.
        remarks: paragraphs for the head of the file.
    """

    listings: Callable[[Workspace, Sequence[str]], tuple[Listing, ...]] = _nothing
    counts: Callable[[Workspace, Sequence[str]], tuple[tuple[str, int], ...]] = _nothing
    remarks: Callable[[Workspace, Sequence[str]], tuple[str, ...]] = _nothing

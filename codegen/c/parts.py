"""Splits long functions, since compile time grows faster than the length of a function.

A program's lines are cut where few values are known and still needed. These go from part to part in
an array, in which places are used again.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from codegen.c.order import NamedStep

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from codegen.c.order import Item

SIZE = 1000
"""About how many operations and results a part has."""

_SPREAD = 0.3
"""How far from equal sizes a cut may go, as a part of the size, to find fewer values alive."""


@dataclass(frozen=True)
class CodePart:
    """Consecutive lines of a function that form one part.

    Attributes:
        items: the lines.
        given: the indices of the nodes known from earlier parts that these lines need.
        kept: of the nodes named here, those that later parts need.
    """

    items: Sequence[Item]
    given: frozenset[int]
    kept: frozenset[int]


@dataclass(frozen=True)
class WorkingPlaces:
    """The places of values passed between parts: one for each node, and the number of places by type."""

    of: dict[int, int]
    count: dict[str, int]


def cut(items: Sequence[Item]) -> list[CodePart]:
    """The lines in parts of about equal size; one part if there are not many."""
    cuts = _cuts(items, SIZE)
    if not cuts:
        return [CodePart(items, frozenset(), frozenset())]
    starts = [0, *cuts, len(items)]
    slices = [items[a:b] for a, b in pairwise(starts)]
    home = {
        item.node.index: number
        for number, lines in enumerate(slices)
        for item in lines
        if isinstance(item, NamedStep)
    }
    given = [
        frozenset(x for item in lines for x in item.needs if home[x] != number)
        for number, lines in enumerate(slices)
    ]
    needed = frozenset().union(*given)
    return [
        CodePart(
            lines,
            given[number],
            frozenset(
                x.node.index for x in lines if isinstance(x, NamedStep) and x.node.index in needed
            ),
        )
        for number, lines in enumerate(slices)
    ]


def places(parts: Sequence[CodePart], kind: Callable[[int], str]) -> WorkingPlaces:
    """Assign every value that is passed between parts a place in a working array.

    No part writes to a place that it reads, so the order of lines within a part is free.

    Args:
        parts: the parts of a function, in order.
        kind: the number type of a node, by its index; each type has an array of its own.
    """
    last = {index: number for number, part in enumerate(parts) for index in part.given}
    free: dict[str, list[int]] = {}
    count: dict[str, int] = {}
    of: dict[int, int] = {}
    for number, part in enumerate(parts):
        for item in part.items:
            if not isinstance(item, NamedStep) or item.node.index not in part.kept:
                continue
            index = item.node.index
            own = kind(index)
            if free.get(own):
                of[index] = free[own].pop()
            else:
                of[index] = count.get(own, 0)
                count[own] = of[index] + 1
        for index in sorted(part.given, reverse=True):
            if last[index] == number:
                free.setdefault(kind(index), []).append(of[index])
    return WorkingPlaces(of, count)


def _cuts(items: Sequence[Item], size: int) -> list[int]:
    """The indices of the lines at which new parts begin."""
    before = [0]
    for item in items:
        before.append(before[-1] + item.cost)
    total = before[-1]
    if total <= (1 + _SPREAD) * size:
        return []
    count = round(total / size)
    unit = total / count
    alive = _alive(items)
    found: list[int] = []
    start = 0
    for number in range(1, count):
        low, high = ((number + sign * _SPREAD) * unit for sign in (-1, 1))
        while start + 1 < len(items) and before[start] < low:
            start += 1
        stop = start
        while stop + 1 < len(items) and before[stop + 1] <= high:
            stop += 1
        found.append(min(range(start, stop + 1), key=lambda k: (alive[k], k)))
    return found


def _alive(items: Sequence[Item]) -> list[int]:
    """Before each line, the number of values that are known and still needed."""
    last = {x: place for place, item in enumerate(items) for x in item.needs}
    change = [0] * (len(items) + 2)
    for place, item in enumerate(items):
        if isinstance(item, NamedStep) and item.node.index in last:
            change[place + 1] += 1
            change[last[item.node.index] + 1] -= 1
    alive = [0]
    for place in range(1, len(items) + 1):
        alive.append(alive[-1] + change[place])
    return alive

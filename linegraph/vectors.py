"""Golden vectors as data: states, and what emitted functions must return there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

Row = tuple[float, ...]


@dataclass(frozen=True)
class Values:
    """One result at every state.

    Attributes:
        shape: of the result at one state.
        rows: its entries at each state, row-major.
        scale: for each entry how large what it is made of gets over all states: what an error is compared
            with.
    """

    shape: tuple[int, ...]
    rows: tuple[Row, ...]
    scale: Row


@dataclass(frozen=True)
class Expected:
    """What one function must return.

    Attributes:
        function: its name.
        route: where the values came from.
        given: for each argument but the parameters, in order, its key in `Vectors.given`.
        results: for each result, in order, its key in `Vectors.values`.
    """

    function: str
    route: str
    given: tuple[str, ...]
    results: tuple[str, ...]


@dataclass(frozen=True)
class Vectors:
    """All states and all expected results of a model.

    Attributes:
        states: how many there are.
        given: arguments by name, a row for each state; the time is a row of one.
        values: results by key.
        expected: what each function is compared with.
        untested: functions without an independent route, and why.
    """

    states: int
    given: Mapping[str, tuple[Row, ...]]
    values: Mapping[str, Values]
    expected: tuple[Expected, ...]
    untested: tuple[tuple[str, str], ...]

"""Golden vectors as data: states, and the expected results of emitted functions at these states."""

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
            with; over all but the last states where these are loud.
        loud: the same for each loud state alone: there is one for each of the last states.
    """

    shape: tuple[int, ...]
    rows: tuple[Row, ...]
    scale: Row
    loud: tuple[Row, ...] = ()

    @property
    def scales(self) -> tuple[Row, ...]:
        """The scale of all states that are not loud, and those of the loud ones."""
        return (self.scale, *self.loud)


CONSTANTS = "c"
"""The key of the argument that holds the constants computed by `prepare`."""

RETURNED = "returned."
"""How the key of an argument begins that is a result of the function called before."""


@dataclass(frozen=True)
class Then:
    """A function that is called with the results of another one.

    Attributes:
        function: its name.
        given: for each argument but the parameters its key in `Vectors.given`, or `RETURNED` and the
            name of a result of the function called before.
        results: for each result its key in `Vectors.values`.
    """

    function: str
    given: tuple[str, ...]
    results: tuple[str, ...]


@dataclass(frozen=True)
class Expected:
    """The expected results of one function.

    Attributes:
        label: what the comparison is called: the function's name, or that and what is special.
        function: its name.
        route: where the values came from.
        given: for each argument but the parameters, in order, its key in `Vectors.given`.
        results: for each result, in order, its key in `Vectors.values`; empty where only what follows from it
            is compared.
        then: what else must hold of its results.
    """

    label: str
    function: str
    route: str
    given: tuple[str, ...]
    results: tuple[str, ...]
    then: tuple[Then, ...] = ()


@dataclass(frozen=True)
class Vectors:
    """All states and all expected results of a model.

    Attributes:
        states: how many there are.
        given: arguments by name, a row for each state; the time is a row of one, the parameters one of all.
        parameters: their names, if functions take them.
        values: results by key.
        expected: what each function is compared with.
        untested: functions without an independent route, and why.
    """

    states: int
    given: Mapping[str, tuple[Row, ...]]
    values: Mapping[str, Values]
    expected: tuple[Expected, ...]
    untested: tuple[tuple[str, str], ...]
    parameters: tuple[str, ...] = ()

    @property
    def loud(self) -> int:
        """How many states are loud, the last ones."""
        return len(next(iter(self.values.values())).loud) if self.values else 0

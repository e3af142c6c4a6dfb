"""Golden vectors as rows of a program that checks emitted functions, for all languages alike.

Each language fills a template with these. The program stands beside what it checks and needs nothing else:
in C no library but <math.h> and, unless it is told otherwise, <stdio.h>; in Python NumPy and pytest.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from codegen import failures, prose
from codegen.printer import number

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from linegraph.ir.golden_vectors import Expected, Row, Then, Values, Vectors
    from linegraph.ir.program import Module

DOUBLE = 5e-12
"""Rounding of a double is 1e-16; sums and solutions take some hundred times that, seldom a thousand times."""

SINGLE = 1e-4
"""Rounding of a float is 6e-8, that of the given state included; the same again."""

_WIDTH = 96


class GivenRows(NamedTuple):
    """An argument: its key, how many numbers it has at one state, and the lines of all states' numbers."""

    key: str
    size: int
    lines: list[str]


class Wanted(NamedTuple):
    """A result: its key, its shape at one state, the lines of its numbers and of the scales of errors."""

    key: str
    shape: tuple[int, ...]
    rows: list[str]
    scales: list[str]

    @property
    def size(self) -> int:
        """How many numbers it has at one state."""
        return math.prod(self.shape)


class Returned(NamedTuple):
    """A result of a call: its name, its key among `Golden.wanted` if it is compared, and its size."""

    name: str
    key: str
    size: int


class Called(NamedTuple):
    """A call: for each argument what it is given, a key of `Golden.given` or another word.

    Other words are ``p`` for the parameters, `golden_vectors.CONSTANTS` and what begins with
    `golden_vectors.RETURNED`.
    """

    function: str
    given: tuple[str, ...]
    results: tuple[Returned, ...]
    fails: bool


class GoldenComparison(NamedTuple):
    """A function called and compared, then others that are called with its results."""

    label: str
    route: str
    first: Called
    then: tuple[Called, ...]


class Golden(NamedTuple):
    """All of a program: states, of which the last ones are loud, arguments, results, comparisons."""

    states: int
    loud: int
    given: list[GivenRows]
    wanted: list[Wanted]
    comparisons: list[GoldenComparison]
    parameters: tuple[str, ...]


def golden(module: Module, vectors: Vectors) -> Golden:
    """The content of the program that checks a module, the same for all languages.

    Args:
        module: the module.
        vectors: arguments and independently computed results.
    """
    statuses = failures.statuses(module)
    return Golden(
        vectors.states,
        vectors.loud,
        [GivenRows(key, len(rows[0]), _lines(rows)) for key, rows in vectors.given.items()],
        [_wanted(key, values) for key, values in vectors.values.items()],
        [
            GoldenComparison(
                x.label,
                x.route,
                _called(module, x, statuses),
                tuple(_called(module, y, statuses) for y in x.then),
            )
            for x in vectors.expected
        ],
        vectors.parameters,
    )


def about(module: Module, vectors: Vectors, *, batch: bool = False) -> list[str]:
    """The description of the comparisons, for the head of the program.

    Args:
        module: the module.
        vectors: arguments and results, with the functions that are not compared.
        batch: whether there are functions of many states, which are not compared either.

    Returns:
        Wrapped lines of plain text.
    """
    lines = ["Compared are, with where the expected values came from:"]
    for x in vectors.expected:
        lines += _item(f"{x.label}: {x.route}.")
    if vectors.untested:
        lines += ["", "Not compared are:"]
        for function, why in vectors.untested:
            lines += _item(f"{function}: {why}.")
    if batch:
        lines += ["", "Functions of many states, whose names end in _batch, are not compared."]
    if any("network" in text for text in module.about):
        text = (
            "Laws of networks, elements and loads are evaluated in numbers; their forces on bodies are "
            "projected on the bodies' velocities."
        )
        lines += ["", *prose.paragraph(text)]
    return lines


def _wanted(key: str, values: Values) -> Wanted:
    return Wanted(key, values.shape, _lines(values.rows), _lines(values.scales))


def _called(
    module: Module, call: Expected | Then, statuses: Mapping[str, Mapping[int, str]]
) -> Called:
    """A call with the names and sizes of the function's own results."""
    program = next(x for x in module.programs if x.name == call.function)
    keys = iter(call.given)
    given = tuple("p" if x.name == "p" else next(keys) for x in program.arguments)
    results = tuple(
        Returned(result.name, key, math.prod(result.shape))
        for result, key in zip(program.results, call.results, strict=True)
    )
    return Called(call.function, given, results, bool(statuses[call.function]))


def _item(text: str) -> list[str]:
    return [f"    {line}" for line in prose.paragraph(text, 4)]


def _lines(rows: Iterable[Row]) -> list[str]:
    """Numbers, as many on a line as fit."""
    lines: list[str] = []
    line = ""
    for entry in (number(x) for row in rows for x in row):
        if line and len(line) + len(entry) > _WIDTH:
            lines.append(line)
            line = ""
        line = f"{line} {entry},".lstrip()
    return [*lines, line] if line else lines

"""One entry of the register of references: a function's results and an independent way to compute them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from linegraph.verification.golden.point import Point
    from linegraph.verification.golden.walk import Valued


class After(NamedTuple):
    """A function that is called with results of another one, to check a property of these.

    Attributes:
        function: its name.
        results: how to compute each expected result, by name.
        given: keys of arguments by name: `RETURNED` followed by the name of a result; others keep their
            own.
    """

    function: str
    results: Mapping[str, Callable[[Point], Valued]]
    given: Mapping[str, str]


class Reference(NamedTuple):
    """How to compute a function's results independently.

    Attributes:
        route: the method in words, printed into tests.
        results: how to compute each expected result, by name; results left out are not compared.
        given: keys of arguments that differ from the arguments' names.
        function: its name, if the key in the register is another.
        then: functions that check further properties of its results.
    """

    route: str
    results: Mapping[str, Callable[[Point], Valued]]
    given: Mapping[str, str] = {}
    function: str = ""
    then: tuple[After, ...] = ()

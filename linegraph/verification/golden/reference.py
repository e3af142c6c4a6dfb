"""One line of the register of references: by which route a function's results are known otherwise."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from linegraph.verification.golden.point import Point
    from linegraph.verification.golden.walk import Valued


class After(NamedTuple):
    """A function that is called with what another one has returned.

    Attributes:
        function: its name.
        results: what gives each of its results, by name.
        given: arguments that are not those of the same name, by name: `RETURNED` and a result's name.
    """

    function: str
    results: Mapping[str, Callable[[Point], Valued]]
    given: Mapping[str, str]


class Reference(NamedTuple):
    """How the results of a function are known otherwise.

    Attributes:
        route: in words.
        results: what gives each result, by its name; a result that is not here is not compared itself.
        given: arguments that are not those of the same name, by name.
        function: its name, where the key in the register is another.
        then: what else must hold of its results.
    """

    route: str
    results: Mapping[str, Callable[[Point], Valued]]
    given: Mapping[str, str] = {}
    function: str = ""
    then: tuple[After, ...] = ()

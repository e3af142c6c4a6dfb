"""The table ``[check]``: bounds of the states at which equations are checked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.readers.modelfile.expressions import Scope
from linegraph.readers.modelfile.fields import Field, Table
from linegraph.readers.modelfile.kinds import WRONG, Items, Real, Schema, said

if TYPE_CHECKING:
    from linegraph.readers.modelfile.expressions import Names
    from linegraph.readers.modelfile.report import Spot


@dataclass(frozen=True)
class Interval:
    """Two numbers, the lower one first."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a pair of numbers and check their order.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            The tuple (low, high), or `WRONG` after its errors are noted.
        """
        found = _PAIR.read(value, spot, names)
        if found is WRONG:
            return WRONG
        low, high = found
        if low > high:
            spot.error(f"the lower bound {low:g} is above the upper bound {high:g}")
            return WRONG
        return found

    def schema(self) -> Schema:
        """The JSON Schema of a pair of numbers."""
        return _PAIR.schema()


_PAIR = Items(Real(Scope.NUMBERS, folded=True), 2, "a list [low, high]")


@dataclass(frozen=True)
class Intervals:
    """Intervals by name. The names are checked later, when states are drawn."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a table of intervals.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            Intervals by name, or `WRONG` after its errors are noted.
        """
        if not isinstance(value, dict):
            spot.error(f"a table NAME = [low, high] is wanted, not {said(value)}")
            return WRONG
        before = spot.report.count
        found = {name: Interval().read(x, spot.at(name), names) for name, x in value.items()}
        return WRONG if spot.report.count > before else found

    def schema(self) -> Schema:
        """The JSON Schema: an object whose values are pairs."""
        return {"type": "object", "additionalProperties": Interval().schema()}


CHECK = Table(
    {
        "coordinates": Field(Intervals(), "NAME = [low, high] for entries of q"),
        "velocities": Field(Intervals(), "the same for entries of v, states of networks included"),
        "inputs": Field(Intervals(), "the same for inputs"),
        "parameters": Field(
            Intervals(), "the same for parameters, which are then drawn instead of fixed"
        ),
        "t": Field(Interval(), "[low, high] for the time (s)"),
    },
    about="where check and golden vectors draw their states; the equations do not depend on it",
)

"""Tables of a model file: a kind of value for each key, and tables by name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.readers.modelfile.kinds import WRONG, Kind, Schema, said
from linegraph.readers.modelfile.names import name_problem
from linegraph.readers.modelfile.report import shown

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.readers.modelfile.expressions import Names
    from linegraph.readers.modelfile.report import Spot

MOST_NAMED = 1000


@dataclass(frozen=True)
class Field:
    """A key of a table.

    Attributes:
        kind: the values it may have.
        about: its meaning, for schema and messages.
        required: whether the key must be present.
    """

    kind: Kind
    about: str = ""
    required: bool = False


@dataclass(frozen=True)
class Table:
    """A table with a kind of value for each key.

    Attributes:
        fields: the keys.
        needs: groups of keys of which at least one must be present.
        exclusive: groups of keys of which at most one may be present.
        about: description for the schema.
    """

    fields: Mapping[str, Field]
    needs: tuple[tuple[str, ...], ...] = ()
    exclusive: tuple[tuple[str, ...], ...] = ()
    about: str = ""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a table; one wrong value makes the whole table wrong.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            Values by key, or `WRONG` after its errors are noted.
        """
        if not isinstance(value, dict):
            keys = ", ".join(self.fields)
            spot.error(f"a table with keys is wanted ({keys}), not {said(value)}")
            return WRONG
        before = spot.report.count
        found = {}
        for key, inner in value.items():
            if key in self.fields:
                found[key] = self.fields[key].kind.read(inner, spot.at(key), names)
            else:
                what = "name" if not key else f'key "{shown(key)}"'
                spot.at(key).error(f"unknown {what}{spot.report.hint(key, self.fields)}")
        self._check_groups(value, spot)
        return WRONG if spot.report.count > before else found

    def _check_groups(self, value: Mapping[str, Any], spot: Spot) -> None:
        for key, wanted in self.fields.items():
            if wanted.required and key not in value:
                spot.error(f"{key} is missing{': ' * bool(wanted.about)}{wanted.about}")
        for group in self.needs:
            if not any(key in value for key in group):
                spot.error(f"{' or '.join(group)} is missing")
        for group in self.exclusive:
            given = [key for key in group if key in value]
            if len(given) > 1:
                spot.error(f"give {' or '.join(given)}, not both")

    def schema(self) -> Schema:
        """The JSON Schema: an object with these properties only."""
        properties = {}
        for key, entry in self.fields.items():
            properties[key] = entry.kind.schema()
            if entry.about:
                properties[key] = {"description": entry.about, **properties[key]}
        result: Schema = {"type": "object", "properties": properties}
        result["additionalProperties"] = False
        required = [key for key, entry in self.fields.items() if entry.required]
        if required:
            result["required"] = required
        if self.needs:
            result["allOf"] = [{"anyOf": [{"required": [k]} for k in g]} for g in self.needs]
        if self.about:
            result["description"] = self.about
        return result


@dataclass(frozen=True)
class Named:
    """Tables by name, such as the frames of a body."""

    kind: Kind

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read tables with names of the user's choice.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            Values by name, or `WRONG` after its errors are noted.
        """
        if not isinstance(value, dict):
            spot.error(f"tables with a name each are wanted, not {said(value)}")
            return WRONG
        if len(value) > MOST_NAMED:
            spot.error(f"has more than {MOST_NAMED} tables")
            return WRONG
        before = spot.report.count
        found = {}
        for name, inner in value.items():
            problem = name_problem(name)
            if problem:
                spot.at(name).error(problem)
            found[name] = self.kind.read(inner, spot.at(name), names)
        return WRONG if spot.report.count > before else found

    def schema(self) -> Schema:
        """The JSON Schema: an object whose values all have one kind."""
        return {"type": "object", "additionalProperties": self.kind.schema()}

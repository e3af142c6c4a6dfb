"""Kinds of values of bodies and basements: inertias and rotations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.body import symmetric
from linegraph.readers.modelfile.fields import Field, Table
from linegraph.readers.modelfile.kinds import (
    WRONG,
    Direction,
    Items,
    Real,
    Schema,
    said,
    vector,
)
from linegraph.readers.modelfile.timed import (
    BY_INPUT,
    PrescribedMotion,
    Timed,
)

if TYPE_CHECKING:
    from linegraph.readers.modelfile.expressions import Names
    from linegraph.readers.modelfile.report import Spot


@dataclass(frozen=True)
class InertiaTable:
    """An inertia: entries by name, three moments, or a symmetric 3 x 3 matrix (kg m^2)."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read an inertia in any of its three forms.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            Entries by name, or `WRONG` after its errors are noted.
        """
        if isinstance(value, dict):
            return INERTIA.read(value, spot, names)
        if not isinstance(value, list) or len(value) != 3:
            spot.error(f"{_INERTIAS} is wanted, not {said(value)}")
            return WRONG
        if not any(isinstance(row, list) for row in value):
            found = Items(Real(least=0), 3, "").read(value, spot, names)
            return WRONG if found is WRONG else dict(zip(("xx", "yy", "zz"), found, strict=True))
        return self._matrix(value, spot, names)

    def _matrix(self, value: list[Any], spot: Spot, names: Names) -> Any:
        rows = [
            vector().read(row, spot.at(i) if isinstance(row, list) else spot, names)
            for i, row in enumerate(value)
        ]
        if any(row is WRONG for row in rows):
            return WRONG
        found = symmetric(rows)
        if found is None:
            spot.error("is not symmetric")
            return WRONG
        return dict(zip(ENTRIES, found, strict=True))

    def schema(self) -> Schema:
        """The JSON Schema: one of three forms."""
        matrix = Items(vector(), 3, "").schema()
        return {"anyOf": [INERTIA.schema(), vector().schema(), matrix]}


@dataclass(frozen=True)
class Turning:
    """The basement's rotation: axis and angle, three angles, or "input"."""

    def read(self, value: Any, spot: Spot, names: Names) -> Any:
        """Read a rotation as a function of time.

        Args:
            value: the value in the file.
            spot: its place in the file, where errors are noted.
            names: the names that the file declares.

        Returns:
            The table, or "input", or `WRONG` after its errors are noted.
        """
        return value if value == BY_INPUT else TURNING.read(value, spot, names)

    def schema(self) -> Schema:
        """The JSON Schema: a table or "input"."""
        return {"anyOf": [{"const": BY_INPUT}, TURNING.schema()]}


ENTRIES = ("xx", "xy", "xz", "yy", "yz", "zz")


_INERTIAS = "{ xx, yy, zz, xy, xz, yz }, a list [xx, yy, zz] or a 3 x 3 matrix"


INERTIA = Table(
    {
        key: Field(Real(least=0 if key[0] == key[1] else None), f"entry {key} (kg m^2)")
        for key in ("xx", "yy", "zz", "xy", "xz", "yz")
    },
    about="the tensor's own entries; those left out are 0",
)


TURNING = Table(
    {
        "axis": Field(Direction(), "direction to turn about"),
        "angle": Field(Timed(), "angle of the turn about axis (rad)"),
        "rpy": Field(PrescribedMotion(3), "turns about fixed x, y, z (rad)"),
    },
    needs=(("axis", "rpy"), ("angle", "rpy")),
    exclusive=(("rpy", "axis"), ("rpy", "angle")),
)

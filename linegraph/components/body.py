"""The rigid body: a multiterminal component with edges in translation and rotation."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import ROTATION, TRANSLATION
from linegraph.components.parameters import is_number
from linegraph.components.validation import finite, listed, plain
from linegraph.errors import ModelError
from linegraph.graph.multigraph import Edge
from linegraph.spatial.rotation import IDENTITY_MATRIX, Inertia, about, from_rpy
from linegraph.spatial.vector import ZERO, Matrix, Vector

if TYPE_CHECKING:
    from linegraph.spatial.placement import Placement

GROUND = "ground"
COMMON_NAMES = ("gnd", "0", "earth", "reference", "vss", "world", "base", "datum")
"""Names that other programs use for ground: hints suggest `GROUND` where one is met."""
MASS_CENTER = "mass_center"

SMALLEST = 1e-150
PHYSICAL = 1e-6
"""Relative to the largest principal moment: files carry about seven digits."""
ROUNDING = 1e-12
"""How far the entries of a computed tensor may be from symmetric, relative to the largest."""
_AXES = ("xx", "xy", "xz", "yy", "yz", "zz")


@dataclass(frozen=True)
class Body:
    """A rigid body.

    Terminal graph, once in translation and once in rotation: the inertia edge from ground to the mass
    centre, whose through variable is the d'Alembert force -m v̇ (torque -(I ω̇ + ω x I ω)), and an arm
    from the mass centre to the body's own frame and to each named frame.

    Attributes:
        name: also that of the body's own frame.
        mass: kg.
        center: mass centre in the body's frame (m); None where `first` is given instead.
        first: first moment of mass in the body's frame (kg m), instead of `center`.
        inertia: (xx, xy, xz, yy, yz, zz) in body axes (kg m^2), tensor entries: about the mass centre,
            or about the body's origin where `first` is given.
        frames: placement of each named frame.
    """

    name: str
    mass: Any = 0
    center: Vector | None = ZERO
    first: Vector | None = None
    inertia: Inertia = (0, 0, 0, 0, 0, 0)
    frames: Mapping[str, Placement] = field(default_factory=dict)

    def edges(self) -> list[Edge]:
        """The terminal graph: for each subspace the inertia edge, then the arms."""
        center = f"{self.name}.{MASS_CENTER}"
        edges = []
        for domain in (TRANSLATION.name, ROTATION.name):
            edges.append(Edge(f"{self.name}/inertia", self.name, domain, GROUND, center))
            edges.append(Edge(f"{self.name}/arm", self.name, domain, center, self.name))
            edges += [
                Edge(f"{self.name}/arm.{frame}", self.name, domain, center, f"{self.name}.{frame}")
                for frame in self.frames
            ]
        return edges


def inertia_of(given: Any, who: str) -> Inertia:
    """An inertia tensor from any of the forms that a user may write.

    Args:
        given: the diagonal (xx, yy, zz), a symmetric 3 x 3 matrix, or entries by name, such as
            ``{"xx": 1.0, "xy": 0.1}`` (kg m^2). Off-diagonal entries are those of the tensor, -∫ x y dm.
        who: the thing that errors name.

    Returns:
        The entries (xx, xy, xz, yy, yz, zz).

    Raises:
        ModelError: another shape, an unknown entry, or a matrix that is not symmetric.
    """
    if isinstance(given, Mapping):
        unknown = [key for key in given if key not in _AXES]
        if unknown:
            known = ", ".join(_AXES)
            raise ModelError(who, f"unknown inertia entry {unknown[0]!r}; entries are {known}")
        return tuple(plain(given.get(key, 0)) for key in _AXES)
    parts = listed(given)
    rows = [listed(row) for row in parts] if isinstance(parts, list) else []
    if len(rows) == 3 and not any(isinstance(row, list) for row in rows):
        return (rows[0], 0, 0, rows[1], 0, rows[2])
    if len(rows) != 3 or any(not isinstance(row, list) or len(row) != 3 for row in rows):
        raise ModelError(who, "inertia must be (xx, yy, zz), a 3 x 3 matrix or named entries")
    for row in rows:
        finite(row, who)
    found = symmetric(rows)
    if found is None:
        raise ModelError(who, "the inertia matrix is not symmetric")
    return found


def symmetric(rows: Sequence[Sequence[Any]]) -> Inertia | None:
    """The entries (xx, xy, xz, yy, yz, zz) of a matrix; None where it is not symmetric.

    Numbers that differ by the rounding of a computed tensor are replaced by their mean.

    Args:
        rows: a 3 x 3 matrix.

    Example:
        >>> symmetric([[2.0, 0.1, 0], [0.1 + 1e-17, 2.0, 0], [0, 0, 3.0]])
        (2.0, 0.1, 0, 2.0, 0, 3.0)
    """
    largest = max((abs(x) for row in rows for x in row if is_number(x)), default=0)
    found = []
    for i in range(3):
        for j in range(i, 3):
            a, b = rows[i][j], rows[j][i]
            near = is_number(a) and is_number(b) and abs(a - b) <= ROUNDING * largest
            if not near and a != b:
                return None
            found.append((a + b) / 2 if near and a != b else a)
    return tuple(found)


def orientation(who: str, rpy: Vector | None, axis: Vector | None, angle: float) -> Matrix:
    """The axes of a frame as columns, from angles or from one turn.

    Args:
        who: the thing that errors name.
        rpy: roll, pitch and yaw about the fixed axes x, y and z, in this order (rad); or
        axis: the direction that the frame is turned about; None for no turn.
        angle: of that turn, right-handed (rad).

    Raises:
        ModelError: the axis has no length.
    """
    if rpy is not None:
        return from_rpy(*rpy)
    if axis is None:
        return IDENTITY_MATRIX
    return about(unit(axis, who), angle)


def unit(axis: Sequence[Any], who: str) -> Vector:
    """A direction scaled to length 1; coordinate axes stay exact.

    Args:
        axis: three numbers, parameters or SymPy expressions.
        who: the thing that errors name.

    Raises:
        ModelError: three zeros, or text.
    """
    x, y, z = axis
    if any(isinstance(c, str) for c in axis):
        raise ModelError(who, "an axis takes numbers, parameters or sympy expressions, not text")
    length: Any = math.hypot(x, y, z) if all(map(is_number, axis)) else _length(axis)
    if length == 0:
        raise ModelError(who, "the axis has length zero; give a direction such as (0, 0, 1)")
    return (_part(x, length), _part(y, length), _part(z, length))


def _part(x: Any, length: Any) -> Any:
    """A component of a unit vector; one too small to be squared is none."""
    part = x if length == 1 else x / length
    return 0 if is_number(part) and abs(part) < SMALLEST else part


def _length(axis: Sequence[Any]) -> Any:
    """The length of a vector with symbolic components."""
    import sympy

    return sympy.sqrt(sum(sympy.sympify(c, strict=True) ** 2 for c in axis))


def impossible(tensor: Inertia) -> str:
    """Why no distribution of mass has this inertia tensor; empty where one has.

    Principal moments are never negative, and none exceeds the sum of the other two: they are the integrals
    of y² + z², z² + x² and x² + y² over the mass [Traversaro et al. 2016].

    Args:
        tensor: entries (xx, xy, xz, yy, yz, zz) about the mass centre (kg m^2), numbers.

    Example:
        >>> impossible((1.0, 0, 0, 1.0, 0, 3.0))
        'principal moments 1, 1, 3 kg m^2: the largest exceeds the sum of the others'
    """
    low, middle, high = principal_moments(tensor)
    largest = max(abs(low), abs(high))
    margin = PHYSICAL * largest
    # moments that are zero up to rounding are shown as zero
    shown = (0.0 if abs(moment) < 1e-12 * largest else moment for moment in (low, middle, high))
    said = f"principal moments {', '.join(f'{moment:.6g}' for moment in shown)} kg m^2"
    if low < -margin:
        return f"{said}: none can be negative"
    if high > low + middle + margin:
        return f"{said}: the largest exceeds the sum of the others"
    return ""


def about_one_axis(tensor: Inertia) -> bool:
    """Whether there is inertia about one axis and none about those across it.

    Args:
        tensor: entries (xx, xy, xz, yy, yz, zz), numbers.
    """
    low, middle, high = principal_moments(tensor)
    return high > 0 and max(abs(low), abs(middle)) <= PHYSICAL * high


def principal_moments(tensor: Inertia) -> tuple[float, float, float]:
    """The eigenvalues of a symmetric tensor, rising: roots of its cubic by the cosine formula [Smith 1961].

    The tensor is scaled by its largest entry first, because its cube would overflow or vanish.

    Args:
        tensor: entries (xx, xy, xz, yy, yz, zz), numbers.
    """
    scale = max(abs(entry) for entry in tensor)
    if scale == 0:
        return (0.0, 0.0, 0.0)
    xx, xy, xz, yy, yz, zz = (entry / scale for entry in tensor)
    mean = (xx + yy + zz) / 3
    a, b, c = xx - mean, yy - mean, zz - mean
    spread = math.sqrt((a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6)
    if spread == 0:
        return (mean * scale,) * 3
    determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)
    cosine = max(-1.0, min(1.0, determinant / (2 * spread**3)))
    angle = math.acos(cosine) / 3
    high = mean + 2 * spread * math.cos(angle)
    low = mean + 2 * spread * math.cos(angle + 2 * math.pi / 3)
    return (low * scale, (3 * mean - high - low) * scale, high * scale)

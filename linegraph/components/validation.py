"""Small checks of values that a user gives, with errors that name the thing."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from linegraph.algebra.formula import CONSTANTS
from linegraph.components.parameters import is_number
from linegraph.errors import ModelError
from linegraph.ir.functions import ARITY

if TYPE_CHECKING:
    from collections.abc import Container, Iterable

    from linegraph.spatial.vector import Matrix, Vector

ORTHOGONAL = 1e-6
"""How far the axes of a frame may be from orthogonal unit vectors: matrices typed with six digits pass."""

RESERVED = frozenset({"t", "der", "input", *CONSTANTS, *ARITY})
"""Names with a meaning of their own in expressions: no symbol may have them."""


def require_new(
    name: str, known: Container[str], who: str, problem: str = "is declared twice"
) -> None:
    """Refuse a name that is taken.

    Args:
        name: the name of a new thing.
        known: the names of all that it shares names with.
        who: the thing that errors name.
        problem: the message where the name is known.

    Raises:
        ModelError: the name is known.
    """
    if name in known:
        raise ModelError(who, problem)


def require_symbols(names: Iterable[str], who: str) -> None:
    """Refuse names of symbols that mean something else in expressions.

    Args:
        names: of the symbols.
        who: the thing that errors name.

    Raises:
        ModelError: a name is reserved.
    """
    for name in names:
        if name in RESERVED:
            raise ModelError(who, reserved_problem(name))


def reserved_problem(name: str) -> str:
    """The message for a reserved name.

    Args:
        name: the name that was given.
    """
    return f'"{name}" has a meaning of its own in expressions; choose another name'


def plain(x: Any) -> Any:
    """SymPy's numbers as Python's, anything else as it is.

    Args:
        x: a model value.
    """
    if hasattr(x, "free_symbols") and not x.free_symbols:
        return int(x) if x.is_Integer else float(x)
    return x


def vector(given: Any, who: str) -> Vector:
    """Three finite numbers or symbols.

    Args:
        given: a list, a tuple, an array or a SymPy matrix, a row or a column.
        who: the thing that errors name.

    Raises:
        ModelError: another length, or an infinity or NaN.
    """
    parts = listed(given)
    if isinstance(parts, list):
        # a column matrix is a list of lists of one
        parts = [p[0] if isinstance(p, list) and len(p) == 1 else p for p in map(listed, parts)]
    if not isinstance(parts, list) or len(parts) != 3:
        count = len(parts) if isinstance(parts, list) else "one number"
        raise ModelError(who, f"three components are needed, got {count}")
    finite(parts, who)
    return (parts[0], parts[1], parts[2])


def triple(given: Any, who: str) -> Vector | None:
    """Three finite numbers or symbols, or None where nothing is given.

    Args:
        given: as for `vector`, or None.
        who: the thing that errors name.

    Raises:
        ModelError: another length, or an infinity or NaN.
    """
    return None if given is None else vector(given, who)


def listed(given: Any) -> Any:
    """Tuples, arrays of NumPy's and matrices of SymPy's as lists; anything else as it is.

    Args:
        given: a model value or several.
    """
    if hasattr(given, "tolist"):
        given = given.tolist()
    return [plain(part) for part in given] if isinstance(given, (list, tuple)) else given


def finite(values: Iterable[Any], who: str) -> None:
    """Refuse infinities and NaN among plain numbers.

    Args:
        values: model values; symbols and expressions pass.
        who: the thing that errors name.

    Raises:
        ModelError: a number is not finite.
    """
    for value in values:
        if is_number(value) and not math.isfinite(value):
            raise ModelError(who, f"{value} is not a finite number")


def rotation_matrix(given: Any, who: str) -> Matrix:
    """A 3 x 3 matrix whose columns are right-handed orthogonal unit vectors; symbols pass unchecked.

    Args:
        given: the matrix by rows.
        who: the thing that errors name.

    Raises:
        ModelError: another shape, or numbers that are no rotation.
    """
    rows = listed(given)
    if not isinstance(rows, list) or len(rows) != 3:
        raise ModelError(who, "the rotation must be a 3 x 3 matrix")
    x, y, z = (vector(row, who) for row in rows)
    if all(is_number(part) for row in (x, y, z) for part in row):
        lengths = (
            _dot(x, x) - 1,
            _dot(y, y) - 1,
            _dot(z, z) - 1,
            _dot(x, y),
            _dot(y, z),
            _dot(x, z),
        )
        triple_product = (
            x[0] * (y[1] * z[2] - y[2] * z[1])
            - x[1] * (y[0] * z[2] - y[2] * z[0])
            + x[2] * (y[0] * z[1] - y[1] * z[0])
        )
        if max(map(abs, lengths)) > ORTHOGONAL or triple_product < 0:
            problem = "the matrix is no rotation: its columns must be right-handed orthogonal unit vectors"
            raise ModelError(who, problem)
    return (x, y, z)


def _dot(a: Vector, b: Vector) -> float:
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


def nearest(name: str, known: Iterable[str]) -> str:
    """A hint at the known name most like another, or a list of the first few known names.

    Args:
        name: the name that is not known.
        known: the names that are.
    """
    from difflib import get_close_matches

    names = list(known)
    close = get_close_matches(name, names, 1)
    if close:
        return f'did you mean "{close[0]}"?'
    return f"known: {', '.join(names[:8])}{', ...' if len(names) > 8 else ''}"

"""`linegraph.simplify`: the simplification of closed forms, loaded when it is called."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable


def simplify(
    expression: Any,
    level: str = "full",
    *,
    rates: Iterable[Any] = (),
    progress: Callable[[str], None] | None = None,
) -> Any:
    """A SymPy expression or matrix in the closed form of derivations.

    Args:
        expression: a SymPy expression or matrix.
        level: none, fast or full; see `simplification`.
        rates: symbols and functions in whose products terms are collected, e.g. ``d.v``.
        progress: called with the current step.

    Raises:
        ModelError: it has too many terms.

    Example:
        >>> from sympy import cos, sin, symbols
        >>> a, b = symbols("a b")
        >>> simplify(sin(a) * cos(b) + cos(a) * sin(b))
        sin(a + b)
    """
    from linegraph.symbolic.simplification import plain

    return plain.simplify(expression, level, rates=tuple(rates), progress=progress)

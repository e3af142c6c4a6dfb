"""Symbols of a derivation as `dynamicsymbols` of `sympy.physics.mechanics`, and back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import sympy
from sympy.physics.mechanics import dynamicsymbols

if TYPE_CHECKING:
    from linegraph.symbolic.equation_forms import EquationForms

Expr = Any


def to_dynamic(symbolic: EquationForms, expression: Expr) -> Expr:
    """Replace coordinates by functions of time, and rates and accelerations by their derivatives.

    Args:
        symbolic: the closed forms whose symbols occur.
        expression: an expression, a matrix or a list of these.

    Example:
        >>> from linegraph import Model, derive
        >>> model = Model("slider")
        >>> _ = model.prismatic("x", between=("ground", model.body("b", mass=2)), axis=(1, 0, 0))
        >>> d = derive(model)
        >>> d.dynamic(d.equations()[0])
        Eq(2*Derivative(x(t), (t, 2)), u_x(t))
        >>> d.static(d.dynamic(d.equations()[0])) == d.equations()[0]
        True
    """
    return _whole(expression).xreplace(_names(symbolic))


def to_static(symbolic: EquationForms, expression: Expr) -> Expr:
    """Replace functions of time and their derivatives by the symbols of the derivation.

    Args:
        symbolic: the closed forms that have the symbols.
        expression: an expression, a matrix or a list of these.
    """
    names = _names(symbolic)
    # highest derivatives first: each contains the function that it is of
    backward = {moving: symbol for symbol, moving in names.items()}
    ordered = sorted(backward, key=lambda e: -_order(e))
    whole = _whole(expression).doit()
    for moving in ordered:
        whole = whole.xreplace({moving: backward[moving]})
    return whole


def _whole(expression: Expr) -> Expr:
    if isinstance(expression, (list, tuple)):
        return sympy.Tuple(*map(_whole, expression))
    found = sympy.sympify(expression, strict=True)
    return found.as_immutable() if isinstance(found, sympy.MatrixBase) else found


def _names(symbolic: EquationForms) -> dict[Expr, Expr]:
    """For each symbol its function of time or derivative."""
    found: dict[Expr, Expr] = {symbol: dynamicsymbols(symbol.name) for symbol in symbolic.q}
    time = dynamicsymbols._t
    rates = dict(zip(symbolic.coordinate_rates, symbolic.q, strict=True))
    for rate, acceleration in zip(symbolic.v, symbolic.a, strict=True):
        moving = found[rates[rate]].diff(time) if rate in rates else dynamicsymbols(rate.name)
        found[rate] = moving
        found[acceleration] = moving.diff(time)
    found |= {u: dynamicsymbols(u.name) for u in symbolic.u}
    found[sympy.Symbol("t")] = time
    return found


def _order(e: Expr) -> int:
    return int(e.derivative_count) if isinstance(e, sympy.Derivative) else 0

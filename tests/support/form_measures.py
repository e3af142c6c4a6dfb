"""What tests of closed forms share: exact zeros, operation counts, and values at high precision.

Operations are `sympy.count_ops`: one for each + - * / and power, for a sign, and for each function. A power
counts one whatever its exponent, and a factor of 2 counts as any other.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any

import mpmath
import numpy as np
import sympy

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

Expr = Any
Array = Any

DIGITS = 40
SIN, COS = sympy.sin, sympy.cos


# ---- values


def value(expression: Expr, values: Mapping[Expr, Any], digits: int = DIGITS) -> Any:
    """An expression at a point, in high precision; what it shares is computed once.

    Raises:
        KeyError: a symbol has no value.
    """
    with mpmath.workdps(digits):
        known: dict[Expr, Any] = {symbol: mpmath.mpf(x) for symbol, x in values.items()}
        return _walked(sympy.sympify(expression, strict=True), known)


def values(matrix: Iterable[Expr], at: Mapping[Expr, Any], digits: int = DIGITS) -> Array:
    """The entries of a matrix, or of any list of expressions, as floats in one row."""
    with mpmath.workdps(digits):
        known: dict[Expr, Any] = {symbol: mpmath.mpf(x) for symbol, x in at.items()}
        found = [_walked(sympy.sympify(e, strict=True), known) for e in matrix]
        return np.array([float(x) for x in found])


def matrix_values(matrix: Expr, at: Mapping[Expr, Any], digits: int = DIGITS) -> Array:
    """The same in the matrix's own shape."""
    return values(list(matrix), at, digits).reshape(matrix.shape)


def _walked(expression: Expr, known: dict[Expr, Any]) -> Any:
    pending = [expression]
    while pending:
        top = pending[-1]
        if top in known:
            pending.pop()
            continue
        waiting = [part for part in top.args if part not in known]
        if waiting:
            pending += waiting
            continue
        known[top] = _operation(top, [known[part] for part in top.args])
        pending.pop()
    return known[expression]


def _operation(e: Expr, parts: list[Any]) -> Any:
    if e.is_Symbol:
        raise KeyError(e)
    if e.is_Rational:
        return mpmath.mpf(int(e.p)) / int(e.q)
    if e.is_Float:
        return mpmath.mpf(e._mpf_)
    if e.is_NumberSymbol:
        return mpmath.mpf(e.evalf(mpmath.mp.dps + 5)._mpf_)
    if e.is_Add:
        return mpmath.fsum(parts)
    if e.is_Mul:
        return mpmath.fprod(parts)
    if e.is_Pow:
        return _power(e, *parts)
    return FUNCTIONS[e.func.__name__](*parts)


def _power(e: Expr, base: Any, exponent: Any) -> Any:
    if e.exp == sympy.S.Half:
        return mpmath.sqrt(base)
    return mpmath.power(base, int(e.exp) if e.exp.is_Integer else exponent)


ALIKE = ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "log")
FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{name: getattr(mpmath, name) for name in (*ALIKE, "sign")},
    "Abs": mpmath.fabs,
    "Min": min,
    "Max": max,
}
"""sympy's functions in mpmath."""


# ---- exact zeros


def vanishes(expression: Expr, relations: Mapping[Expr, Expr] | None = None) -> bool:
    """Whether an expression is zero whatever its symbols are: by polynomials, in exact arithmetic.

    Sines and cosines of sums and multiples are written out in those of single angles, which with
    ``sin² = 1 - cos²`` have one normal form over one common denominator.

    Args:
        expression: without floats.
        relations: squares of symbols that something else stands for, as of a quaternion's.
    """
    whole = sympy.sympify(expression, strict=True)
    assert not whole.atoms(sympy.Float), f"floats in {whole}"
    spread = sympy.expand_trig(sympy.expand(whole, power_base=True))
    angles = sorted({f.args[0] for f in spread.atoms(SIN, COS)}, key=str)
    names = {}
    squares = dict(relations or {})
    for k, angle in enumerate(angles):
        s, c = sympy.Dummy(f"s{k}"), sympy.Dummy(f"c{k}")
        names |= {SIN(angle): s, COS(angle): c}
        squares[s] = 1 - c**2
    for k, power in enumerate(sorted(spread.atoms(sympy.exp), key=str)):
        names[power] = sympy.Dummy(f"e{k}")
    top, _ = sympy.fraction(sympy.together(spread.xreplace(names)))
    top = sympy.expand(top)
    for symbol, square in squares.items():
        top = _reduced(top, symbol, square)
    if top == 0:
        return True
    return bool(spread.atoms(sympy.exp)) and sympy.simplify(whole) == 0


def _reduced(expression: Expr, symbol: Expr, square: Expr) -> Expr:
    if not expression.has(symbol):
        return expression
    total = sympy.S.Zero
    for (power,), factor in sympy.Poly(expression, symbol).terms():
        half, odd = divmod(power, 2)
        total += factor * square**half * symbol**odd
    return sympy.expand(total)


# ---- how a closed form looks


def operations(*expressions: Expr) -> int:
    """Operations of expressions one by one; of a Matrix those of its entries."""
    total = 0
    for expression in expressions:
        entries = list(expression) if isinstance(expression, sympy.MatrixBase) else [expression]
        total += sum(int(sympy.count_ops(entry)) for entry in entries)
    return total


def whole_floats(expression: Expr) -> list[Expr]:
    """Floats that are whole numbers, also but for rounding, which a reader wants as such."""
    return sorted((x for x in expression.atoms(sympy.Float) if _whole(float(x))), key=str)


def _whole(x: float) -> bool:
    return abs(x - round(x)) <= 1e-14 * abs(x)


def unmerged(expression: Expr) -> list[Expr]:
    """Sums in which ``k sin² x + k cos² x`` is left, also as part of two coefficients."""
    return [e for e in sympy.preorder_traversal(expression) if e.is_Add and _square_pairs(e)]


def _square_pairs(total: Expr) -> bool:
    terms = sympy.Add.make_args(sympy.expand(total, trig=False))
    found: set[Expr] = set()
    for term in terms:
        for factor in sympy.Mul.make_args(term):
            if factor.is_Pow and factor.exp == 2 and isinstance(factor.base, (SIN, COS)):
                found.add(term)
    for one, other in combinations(sorted(found, key=str), 2):
        for square in (f for f in one.atoms(SIN, COS) if one.has(f**2)):
            partner = COS if isinstance(square, SIN) else SIN
            if one / square**2 == other / partner(*square.args) ** 2:
                return True
    return False


def angles(expression: Expr) -> set[Expr]:
    """What sines and cosines are taken of, their sign left out."""
    found = {sympy.expand(f.args[0]) for f in expression.atoms(SIN, COS)}
    return {-x if x.could_extract_minus_sign() else x for x in found}


def products_of_angles(expression: Expr) -> list[Expr]:
    """Products in which sines and cosines of different angles meet."""
    return [e for e in _products(expression) if len(angles(_outer(e))) > 1]


def _products(expression: Expr) -> Iterator[Expr]:
    return (e for e in sympy.preorder_traversal(expression) if e.is_Mul)


def _outer(product: Expr) -> Expr:
    """A product without its sums."""
    return sympy.Mul(*(f for f in product.args if not f.is_Add), evaluate=False)

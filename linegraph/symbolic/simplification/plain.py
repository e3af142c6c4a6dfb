"""Any SymPy expression in the closed form of derivations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import sympy

from linegraph.algebra.sympy_scalars import OURS, Expr, evaluate
from linegraph.ir.dag import Dag
from linegraph.ir.functions import ARITY
from linegraph.symbolic.simplification import BUDGET, Simplifier

if TYPE_CHECKING:
    from collections.abc import Callable


def simplify(
    expression: Any,
    level: str = "full",
    *,
    rates: tuple[Expr, ...] = (),
    budget: int = BUDGET,
    progress: Callable[[str], None] | None = None,
) -> Expr:
    """An expression or a matrix, as `Derivation` writes its closed forms.

    Sums are multiplied out and collected again, sines of sums of angles too. Subexpressions that are
    not sums, products, powers or functions of `functions.ARITY` are left as they are. The result is
    compared with the given expression at random points to fifty digits.

    Args:
        expression: a SymPy expression or matrix.
        level: none, fast or full.
        rates: symbols and functions in whose products terms are collected.
        budget: the number of products of two terms that may be formed.
        progress: called with the current step.

    Raises:
        ModelError: it has too many terms.

    Example:
        >>> m, l, a, b = sympy.symbols("m l a b")
        >>> simplify(m * l * (sympy.sin(a) * sympy.cos(b) + sympy.cos(a) * sympy.sin(b)))
        l*m*sin(a + b)
        >>> simplify(m * sympy.sin(a) ** 2 + m * sympy.cos(a) ** 2 + l * m)
        m*(l + 1)
    """
    if isinstance(expression, sympy.MatrixBase):
        return expression.applyfunc(
            lambda e: simplify(e, level, rates=rates, budget=budget, progress=progress)
        )
    whole = sympy.sympify(expression, strict=True)
    known = set(rates)
    atoms = sorted(_atoms(whole, known), key=sympy.default_sort_key)
    names = {atom: sympy.Symbol(f"x{n}") for n, atom in enumerate(atoms)}
    angles = {e for wave in whole.atoms(sympy.sin, sympy.cos) for e in _atoms(wave.args[0], known)}
    dag = Dag()

    def argument(atom: Expr) -> str:
        return "v" if atom in known else "q" if atom in angles else "p"

    symbols = {names[atom].name: dag.symbol(argument(atom), n) for n, atom in enumerate(atoms)}
    node = evaluate(whole.xreplace(names), dag, symbols)
    written = Simplifier(lambda symbol: atoms[symbol[1]], level, budget, progress)
    return written(node)


def quotient(expression: Any) -> Expr:
    """An expression as one quotient without common factors, numerator and denominator in closed form.

    Example:
        >>> m, l, g = sympy.symbols("m l g")
        >>> quotient(-g * l * m / (-m * l**2 - m * l**2))
        g/(2*l)
    """
    whole = sympy.sympify(expression, strict=True)
    if not whole.free_symbols:
        return whole
    inexact = whole.has(sympy.Float)
    exact = sympy.nsimplify(whole, rational=True) if inexact else whole
    parts = [part.expand() for part in sympy.fraction(sympy.cancel(exact))]
    scale = sympy.Integer(1)
    if inexact:  # undo the scaling from clearing denominators
        scale /= max(abs(k) for k, _ in _terms(parts[1]))
    if 2 * sum(bool(k.is_negative) for k, _ in _terms(parts[1])) > len(_terms(parts[1])):
        scale = -scale
    above, below = (
        sympy.Add(*(_decimal(scale * k, inexact) * term for k, term in _terms(part)))
        for part in parts
    )
    return simplify(above) / simplify(below)


def _terms(part: Expr) -> list[tuple[Expr, Expr]]:
    """The coefficients and the remaining factors of a sum's terms."""
    return [term.as_coeff_Mul() for term in sympy.Add.make_args(part)]


def _decimal(k: Expr, inexact: bool) -> Expr:
    return k if k.is_Integer or not inexact else sympy.Float(k)


def _atoms(e: Expr, known: set[Expr]) -> set[Expr]:
    """Subexpressions that are left as they are: symbols, functions of time, anything not arithmetic."""
    if e in known or e.is_Symbol or e.is_NumberSymbol:
        return {e}
    if e.is_Number:
        return set()
    arithmetic = e.is_Add or e.is_Mul or (e.is_Pow and (2 * e.exp).is_Integer)
    name = e.func.__name__
    if arithmetic or ARITY.get(OURS.get(name, name)) == len(e.args):
        parts = e.args[:1] if e.is_Pow else e.args
        return set().union(*(_atoms(part, known) for part in parts))
    return {e}

"""Closed forms as in a textbook: `Simplifier`, from a derived expression to the shortest form found.

    DAG node ──expanded──→ terms ──collected──→ fewer terms ──factored──→ SymPy expression

Levels:

    none    as derived, with all intermediates substituted
    fast    multiplied out, like terms and sines collected, common factors out
    full    the same in the angles and with the grouping that give the shortest expression

Each arrow is one rewrite. After each, the new form is compared with the derived expression at random
points to fifty digits; a form that differs is not used. All decisions depend on numbers of terms, never
on time, so that the same input gives the same form on every machine.
"""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any

import sympy

from linegraph.algebra.differentiation import Replay
from linegraph.algebra.sympy_scalars import to_sympy
from linegraph.errors import ModelError
from linegraph.symbolic.simplification.angles import fewest, merged, spread
from linegraph.symbolic.simplification.factoring import SympyWriter, in_decimals
from linegraph.symbolic.simplification.generators import Swollen
from linegraph.symbolic.simplification.memory import Memory
from linegraph.symbolic.simplification.polynomial import Ring
from linegraph.symbolic.simplification.proof import EXACT, INEXACT, SamplePoint

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.algebra.sympy_scalars import Expr
    from linegraph.symbolic.simplification.numbers import Terms

LEVELS = ("none", "fast", "full")

BUDGET = 1_000_000
"""The number of products of two terms that a quantity may take: a few seconds."""

MOST_TERMS = 4000
"""Longer polynomials are not written."""

POINTS = 2
"""The number of points at which each form is compared."""

SHORT = 60
"""In polynomials with more terms, products of sines are not written as sums."""

LONG = 400
"""For polynomials with more terms, one form is written, not several."""


class Simplifier:
    """Writes scalars of a DAG as SymPy expressions.

    Args:
        symbol: returns the SymPy symbol of a symbol of the DAG, given its argument and place.
        level: none, fast or full.
        budget: the number of products of two terms that a quantity may take.
        progress: called with the current step.
        units: groups of four symbols that are the entries x, y, z, w of a unit quaternion.

    Attributes:
        rejected: forms that differed from the derived expression; empty unless there is a bug.

    Example:
        >>> from linegraph.ir.dag import Dag
        >>> dag = Dag()
        >>> m, q = dag.symbol("p", "m"), dag.symbol("q", 0)
        >>> simplifier = Simplifier(lambda symbol: sympy.Symbol(symbol[1] or "x"))
        >>> simplifier(m * dag.sin(q) * dag.sin(q) + m * dag.cos(q) * dag.cos(q))
        m
    """

    def __init__(
        self,
        symbol: Callable[[Symbol], Expr],
        level: str = "full",
        budget: int = BUDGET,
        progress: Callable[[str], None] | None = None,
        units: Iterable[Sequence[Symbol]] = (),
    ) -> None:
        """Start with an empty ring; equal polynomials are written only once."""
        if level not in LEVELS:
            raise ModelError(f'level "{level}"', f"is not known; there are {', '.join(LEVELS)}")
        self.level = level
        self.rejected: list[Expr] = []
        self._budget = budget
        self._progress = progress or (lambda text: None)
        self._symbol = symbol
        self._names: dict[Expr, Symbol] = {}
        self._defined: dict[Symbol, Expr] = {}
        self._ring = Ring()
        units = self._units = [tuple(unit) for unit in units]
        for unit in units:
            self._ring.normalise(unit)
        self._replay = Replay(self._ring, self._ring.of_symbol)
        self._points = [SamplePoint(self._ring, self._names, seed, units) for seed in range(POINTS)]
        self._writer = SympyWriter(self._ring, self._named, self._inner)
        self._written: dict[Any, Expr] = {}

    def __call__(self, x: Scalar, what: str = "expression") -> Expr:
        """The closed form of one scalar.

        Args:
            x: a scalar of the DAG.
            what: its name in messages.
        """
        return self.all([x], what)[0]

    def all(self, given: Iterable[Scalar], what: str = "expression") -> list[Expr]:
        """The closed forms of the scalars of one quantity, within one budget.

        If the quantity is refused, everything learnt from it is forgotten: later quantities come out as
        if it had never been requested.

        Args:
            given: scalars of the DAG.
            what: name of the quantity in messages.

        Raises:
            ModelError: they have too many terms, or a power that is too high.
        """
        given = list(given)
        memory = Memory(self, self._ring, self._replay, self._writer, *self._points)
        self.start()
        found = []
        for n, x in enumerate(given):
            self._progress(f"simplifying {what} {bar(n, len(given))}")
            try:
                found.append(self._closed(x))
            except BaseException as error:
                memory.restore()
                if not isinstance(error, Swollen):
                    raise
                problem = (
                    f"{error.problem} for a closed form; ask for its function, or see it with named "
                    'intermediates in the report; the level "none" writes it as derived'
                )
                raise ModelError(what, problem) from None
        return found

    # -- access for other calculations

    def twin(self) -> Simplifier:
        """Another simplifier with the same settings and an empty ring."""
        return Simplifier(self._symbol, self.level, self._budget, units=self._units)

    @property
    def ring(self) -> Ring:
        """The ring of the polynomials that are written."""
        return self._ring

    @property
    def points(self) -> list[SamplePoint]:
        """The points at which forms are compared."""
        return self._points

    def start(self) -> None:
        """Start a new budget from here."""
        self._ring.budget = self._ring.work + self._budget

    def known(self, e: Expr) -> Symbol | None:
        """The symbol that is written as an expression; None if there is none."""
        return self._names.get(e)

    def define(self, symbol: Symbol, e: Expr, *, valued: bool = False) -> None:
        """Set the expression that a symbol is written as.

        Args:
            symbol: its argument and place.
            e: the expression.
            valued: whether the expression is also its value.
        """
        if valued:  # while the expression is not yet known as the symbol
            for point in self._points:
                point.define(symbol, e)
        self._defined[symbol] = e
        self._names[e] = symbol

    def of_terms(self, terms: Terms) -> Expr:
        """The closed form of a polynomial of the ring."""
        key = frozenset(terms.items())
        if key not in self._written:
            values = [point.terms(terms)[0] for point in self._points]
            self._written[key] = self._written_as(terms, values)
        return self._written[key]

    def _named(self, symbol: Symbol) -> Expr:
        expression = self._defined.get(symbol) or self._symbol(symbol)
        self._names[expression] = symbol
        return expression

    def _closed(self, x: Scalar) -> Expr:
        if self.level == "none":
            return in_decimals(to_sympy(x, self._symbol))
        terms = self._ring.poly(self._replay(x)).terms
        if len(terms) > MOST_TERMS:
            raise Swollen
        key = frozenset(terms.items())
        if key not in self._written:
            derived = [point.node(x) for point in self._points]
            self._written[key] = self._written_as(terms, derived)
        return self._written[key]

    def _written_as(self, terms: Terms, derived: list[Any]) -> Expr:
        """The shortest form that passes the comparison."""
        writer = self._writer
        if not self._holds(terms, derived):
            raise AssertionError("a polynomial differs from what was derived: a bug")
        scales = [point.terms(terms)[1] for point in self._points]
        forms = [form for form in self._forms(terms) if self._holds(form, derived)]
        if len(terms) > LONG:
            forms = [min(forms, key=len)]
        written = [writer.written(form) for form in forms]
        for expression in sorted(written, key=sympy.count_ops):
            values = [point.expression(expression) for point in self._points]
            if self._agree(values, derived, scales):
                return expression
            self.rejected.append(expression)
        return writer.expanded(terms)

    def _forms(self, terms: Terms) -> list[Terms]:
        """The polynomial, and its forms in other angles."""
        if not any(
            self._ring.is_wave(place) for t in terms for place, _ in self._ring.exponents(t)
        ):
            return [terms]
        if self.level == "fast":
            return [merged(self._ring, terms)]
        forms = [terms, merged(self._ring, terms, doubled=False), merged(self._ring, terms)]
        # if the search exceeds the budget, the forms found so far remain
        with contextlib.suppress(Swollen):
            forms.append(fewest(self._ring, terms))
            if len(terms) <= SHORT:
                forms.append(spread(self._ring, terms))
        most = 2 * min(map(len, forms))
        return [form for n, form in enumerate(forms) if form not in forms[:n] and len(form) <= most]

    def _inner(self, terms: Terms) -> Expr:
        """The content of a function, an angle or a root as an expression."""
        key = frozenset(terms.items())
        if key not in self._written:
            self._written[key] = self._writer.written(terms)
        return self._written[key]

    def _holds(self, terms: Terms, derived: list[Any]) -> bool:
        found = [point.terms(terms) for point in self._points]
        return self._agree([f[0] for f in found], derived, [f[1] for f in found])

    def _agree(self, found: list[Any], derived: list[Any], scales: list[Any]) -> bool:
        most = INEXACT if self._ring.inexact else EXACT
        return all(
            # 1 is the size of the symbols, and so of terms that cancel completely and leave no scale
            abs(a - b) <= most * (1 + scale + abs(b))
            for a, b, scale in zip(found, derived, scales, strict=True)
        )


def bar(done: int, of: int, width: int = 20) -> str:
    """A progress bar as text.

    Args:
        done: number of finished steps.
        of: number of all steps.
        width: number of characters between the brackets.
    """
    full = width * done // max(of, 1)
    return f"[{'#' * full}{'.' * (width - full)}] {done}/{of}"


__all__ = ["BUDGET", "LEVELS", "Simplifier", "bar"]

"""The static part of a network: all variables from states, inputs and variables that only rates determine.

Linear laws are eliminated symbolically. Of the others, those that determine one more variable at a time are
solved in that order; the rest is an algebraic loop, whose unknowns stay symbols for Newton's method.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from linegraph.algebra.differentiation import Replay, substitution
from linegraph.algebra.residues import Residues
from linegraph.networks.elimination import LinearRow, eliminate
from linegraph.networks.kirchhoff import Kirchhoff

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from linegraph.algebra.differentiation import Calculus, Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.branches import Branch
    from linegraph.networks.law_records import Laws, Static
    from linegraph.networks.selection import Selection

DUAL, LOOP, EASE = "d", "loop", "ease"
"""Symbols of variables that only rates determine, of the unknowns of algebraic loops, and of the resistance
in series and the conductance in parallel that make a loop easier to solve and are zero at its solution."""


@dataclass
class Statics:
    """The values of the primary variables.

    Attributes:
        kirchhoff: the chosen trees' equations.
        values: scalars by primary variable.
        loop: the unknowns of the algebraic loop; the k-th is the symbol ``(LOOP, k)`` in `values`.
        residuals: expressions that are zero in the loop.
        laws: the components whose laws form the loop.
        pivots: divisors that might be zero.
        eased: the residuals with resistances at the ports of their laws.
    """

    kirchhoff: Kirchhoff
    values: dict[Symbol, Scalar]
    loop: list[Symbol] = field(default_factory=list)
    residuals: list[Scalar] = field(default_factory=list)
    laws: list[str] = field(default_factory=list)
    pivots: list[Scalar] = field(default_factory=list)
    eased: list[Scalar] = field(default_factory=list)


class Solver:
    """Solves the static laws of a network on a chosen tree.

    Args:
        branches: all edges.
        laws: the terminal equations.
        selection: states and trees.
    """

    def __init__(self, branches: Sequence[Branch], laws: Laws, selection: Selection) -> None:
        """Collect the variables that are known as states."""
        self._laws = laws
        self._dag, self._calculus = laws.dag, laws.calculus
        self._residues = Residues()
        self._kirchhoff = Kirchhoff(branches, selection.topologies)
        self._selection = selection
        self._known = {store.key for store in selection.states}
        self._pivots: list[Scalar] = []

    def solve(self) -> Statics:
        """Solve for all primary variables."""
        rows = [*self._state_rows(), *self._dual_rows()]
        nonlinear: list[Static] = []
        for static in self._laws.statics:
            row = self._linear(static.zero)
            if row is None:
                nonlinear.append(static)
            else:
                row.owner = static.component.name
                rows.append(row)
        found = eliminate(rows, self._dag, self._residues, self._natural(nonlinear))
        found.values = {symbol: self._pruned(value) for symbol, value in found.values.items()}
        self._pivots = found.pivots
        values = {
            symbol: self._dag.symbol(*symbol)
            for symbol in self._kirchhoff.primaries
            if symbol in self._known
        }
        values |= found.values
        free = [s for s in self._kirchhoff.primaries if s not in values]
        return self._nonlinear(nonlinear, values, free)

    def _pruned(self, value: Scalar) -> Scalar:
        """A value without unknowns that cancel in it, as elimination adds and subtracts them."""
        return pruned(
            value,
            self._calculus,
            self._residues,
            lambda s: s[0] == DUAL or (self._kirchhoff.knows(s) and s not in self._known),
        )

    def _state_rows(self) -> list[LinearRow]:
        """Rows for states that are not primary variables of the tree: Kirchhoff's laws for them."""
        rows = []
        for key in sorted(self._known):
            form = self._kirchhoff.form(key)
            if form != {key: 1}:
                entries, rest = self._split(dict(form.items()))
                rows.append(LinearRow(entries, rest - self._dag.symbol(*key)))
        return rows

    def _dual_rows(self) -> list[LinearRow]:
        """Rows for variables that only rates determine; each is known as a symbol of its own."""
        rows = []
        for store in self._selection.determined:
            entries, rest = self._split(dict(self._kirchhoff.form(store.dual)))
            rows.append(LinearRow(entries, rest - self._dag.symbol(DUAL, store.edge)))
        return rows

    def _split(self, slopes: dict[Symbol, Scalar]) -> tuple[dict[Symbol, Scalar], Scalar]:
        """The slopes of unknown primary variables, and the sum of the terms of known ones."""
        entries: dict[Symbol, Scalar] = {}
        rest: Scalar = 0
        for symbol, slope in slopes.items():
            if symbol in self._known:
                rest = rest + slope * self._dag.symbol(*symbol)
            else:
                entries[symbol] = entries.get(symbol, 0) + slope
        return entries, rest

    def _linear(self, zero: Scalar) -> LinearRow | None:
        """A law as a row; None if it is not linear in the unknowns."""
        gradient = self._calculus.gradient(zero)
        unknown = {s for s in gradient if self._kirchhoff.knows(s) and s not in self._known}
        for symbol in unknown:
            if self._unknown_in(gradient[symbol]):
                return None
        constant = substitution(self._dag, dict.fromkeys(unknown, 0))(zero)
        slopes: dict[Symbol, Scalar] = {}
        for symbol in sorted(unknown):
            for primary, factor in self._kirchhoff.form(symbol).items():
                slopes[primary] = slopes.get(primary, 0) + factor * gradient[symbol]
        entries, rest = self._split(slopes)
        return LinearRow(entries, rest + constant)

    def _unknown_in(self, x: Scalar) -> bool:
        return any(
            self._kirchhoff.knows(s) and s not in self._known for s in self._calculus.support(x)
        )

    def _natural(self, nonlinear: Sequence[Static]) -> set[Symbol]:
        """The variables of nonlinear laws' own edges, for which linear laws are solved last."""
        return {
            symbol
            for static in nonlinear
            for symbol in self._calculus.support(static.zero)
            if symbol in self._kirchhoff.primaries and symbol not in self._known
            if str(symbol[1]).partition(".")[0] == static.component.name
        }

    def _nonlinear(
        self, laws: Sequence[Static], values: dict[Symbol, Scalar], free: list[Symbol]
    ) -> Statics:
        """Solve the laws that determine one variable at a time, before the loop and after it."""
        put = self.substituting(values)
        open_laws = [(static, put(static.zero)) for static in laws]
        unknown = dict.fromkeys(free)
        while True:
            step = self._forward(open_laws, unknown)
            if step is None:
                break
            place, symbol, value = step
            open_laws.pop(place)
            del unknown[symbol]
            replace = substitution(self._dag, {symbol: value})
            values = {s: replace(v) for s, v in values.items()} | {symbol: value}
            open_laws = [(static, replace(zero)) for static, zero in open_laws]
        later = []
        while True:
            back = self._backward(open_laws, unknown)
            if back is None:
                break
            place, symbol, value = back
            open_laws.pop(place)
            del unknown[symbol]
            later.append((symbol, value))
        loop = list(unknown)
        renamed = {s: self._dag.symbol(LOOP, k) for k, s in enumerate(loop)}
        residuals = substitution(self._dag, renamed).all(zero for _, zero in open_laws)
        for symbol, value in reversed(later):
            renamed[symbol] = substitution(self._dag, renamed)(value)
        replace = substitution(self._dag, renamed)
        values = {s: replace(v) for s, v in values.items()} | renamed
        names = list(dict.fromkeys(static.component.name for static, _ in open_laws))
        return Statics(
            self._kirchhoff,
            values,
            loop,
            residuals,
            names,
            self._pivots,
            self._eased([static for static, _ in open_laws], residuals, values),
        )

    def _eased(
        self, laws: Sequence[Static], residuals: Sequence[Scalar], values: dict[Symbol, Scalar]
    ) -> list[Scalar]:
        """The residuals of the loop with the resistances `EASE` at the ports of its laws.

        A port gets a resistance in series and a conductance in parallel, or one of the two where the other
        would make the loop depend on further symbols.
        """
        needed = {s for r in residuals for s in self._calculus.support(r)}
        put = self.substituting(values)
        found = []
        for static, residual in zip(laws, residuals, strict=True):
            kept = residual
            for series, parallel in ((1, 1), (0, 1), (1, 0)):
                eased = put(self._in_resistances(static, series, parallel))
                support = self._calculus.support(eased)
                if all(s in needed or s[0] in (LOOP, EASE) for s in support):
                    kept = eased
                    break
            found.append(kept)
        return found

    def _in_resistances(self, static: Static, series: int, parallel: int) -> Scalar:
        """A law behind a resistance and beside a conductance; a rising law stays rising, more steeply."""
        dag = self._dag
        x, y = dag.symbol("X", static.edge), dag.symbol("Y", static.edge)
        inner_x = x - series * (dag.symbol(EASE, 0) * y)
        inner_y = y - parallel * (dag.symbol(EASE, 1) * x)
        inner = {("X", static.edge): inner_x, ("Y", static.edge): inner_y}
        return substitution(dag, inner)(static.zero)

    def _forward(
        self, laws: Sequence[tuple[Static, Scalar]], unknown: dict[Symbol, None]
    ) -> tuple[int, Symbol, Scalar] | None:
        """A law with one unknown, in which it is linear: its index, the unknown and its value."""
        for place, (_, zero) in enumerate(laws):
            touched = [s for s in self._calculus.support(zero) if s in unknown]
            if len(touched) == 1:
                value = self._solved(zero, touched[0])
                if value is not None:
                    return place, touched[0], value
        return None

    def _backward(
        self, laws: Sequence[tuple[Static, Scalar]], unknown: dict[Symbol, None]
    ) -> tuple[int, Symbol, Scalar] | None:
        """An unknown in one law only, and linear there: it follows from the other unknowns."""
        supports = [self._calculus.support(zero) for _, zero in laws]
        for symbol in unknown:
            places = [k for k, support in enumerate(supports) if symbol in support]
            if len(places) == 1:
                value = self._solved(laws[places[0]][1], symbol)
                if value is not None:
                    return places[0], symbol, value
        return None

    def _solved(self, zero: Scalar, symbol: Symbol) -> Scalar | None:
        """The root of an expression that is linear in the symbol; None if it is not."""
        slope = self._calculus.derivative(zero, symbol)
        if symbol in self._calculus.support(slope) or not self._residues(slope):
            return None
        rest = substitution(self._dag, {symbol: 0})(zero)
        if not isinstance(slope, (int, float)):
            self._pivots.append(slope)
        return -rest / slope

    def substituting(self, values: dict[Symbol, Scalar]) -> Replay:
        """The replacement of all across and through variables by their values."""
        return substituting(self._laws, self._kirchhoff, values)


def substituting(laws: Laws, kirchhoff: Kirchhoff, values: dict[Symbol, Scalar]) -> Replay:
    """The replacement of all across and through variables by combinations of primary ones.

    Args:
        laws: the terminal equations.
        kirchhoff: the chosen trees' equations.
        values: scalars by primary variable.
    """

    def symbol(key: Symbol) -> Scalar:
        if kirchhoff.knows(key):
            return kirchhoff.combined(key, laws.dag, values)
        return laws.dag.symbol(*key)

    return Replay(laws.dag, symbol)


def pruned(
    x: Scalar, calculus: Calculus, residues: Residues, doubtful: Callable[[Symbol], bool]
) -> Scalar:
    """A scalar without the symbols whose derivative is exactly zero, which only seem to occur in it.

    Args:
        x: the scalar.
        calculus: derivatives over its DAG.
        residues: the exact zero test.
        doubtful: whether a symbol is to be tested; others stay.
    """
    dead = {
        symbol: 0
        for symbol in calculus.support(x)
        if doubtful(symbol) and not residues(calculus.derivative(x, symbol))
    }
    return substitution(calculus.dag, dead)(x) if dead else x

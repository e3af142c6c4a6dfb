"""The derivation that a report is about, with its notation and the symbols of its edges."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.components.domains import DOMAINS, ROTATION, TRANSLATION
from linegraph.components.parameters import resolver
from linegraph.notation.expressions import number
from linegraph.notation.names import shaped
from linegraph.notation.notation import Notation
from linegraph.notation.tree import ZERO, Components, Math, Name, total
from linegraph.symbolic.simplification.numbers import plain

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.components.domains import Domain
    from linegraph.derivation import Derivation
    from linegraph.graph.multigraph import IntegerMatrix
    from linegraph.ir.program import Quantity
    from linegraph.programs.workspace import Workspace

LETTERS = {"w": "ω", "tau": "τ", "dphi": "Φ", "phi": "φ", "psi": "ψ"}
"""Symbols for letters of domains that are written as words."""


class AnyName(Mapping[str, Any]):
    """A mapping in which every name is the SymPy symbol of that name, so that laws appear as given."""

    def __init__(self, known: Mapping[str, Any] | None = None) -> None:
        """Keep the names with other meanings.

        Args:
            known: values of some names.
        """
        self._known = known or {}

    def __getitem__(self, name: str) -> Any:
        from sympy import Symbol

        return self._known.get(name, Symbol(name))

    def __contains__(self, name: object) -> bool:
        return True

    def __iter__(self) -> Iterator[str]:
        return iter(self._known)

    def __len__(self) -> int:
        return len(self._known)


class Subject:
    """A derivation with its notation.

    Attributes:
        derivation, model, tree, network: the derivation and its parts.
        look: its notation.
        level: how far closed forms are simplified.
        folded: whether parameters are written as numbers.
    """

    def __init__(self, derivation: Derivation, level: str = "full", folded: bool = False) -> None:
        """Choose the notation.

        Args:
            derivation: the derived model.
            level: how far closed forms are simplified.
            folded: whether parameters are written as numbers.
        """
        self.derivation = derivation
        self.model = derivation.system
        self.tree = derivation.structure
        self.network = derivation.formulation.network
        self.look = Notation(derivation)
        self.level = level
        self.folded = folded

    @cached_property
    def equations(self) -> Workspace:
        """The equations over a DAG: what counts operations, and what shows the shared intermediates."""
        from linegraph.programs.workspace import Workspace

        return Workspace(self.derivation, self.folded)

    @cached_property
    def algebra(self) -> Any:
        """The SymPy algebra in which laws are shown."""
        from linegraph.algebra.sympy_scalars import Sympy

        names = {"q": self.q_names, "v": self.v_names, "u": self.u_names}
        return Sympy(names)

    def value(self, x: Any, /, **own: Any) -> Math:
        """A value of the model as a formula.

        Args:
            x: a number, an expression or a parameter.
            own: values of further names.
        """
        return self.expression(self.resolve(x, **own))

    def resolve(self, x: Any, /, **own: Any) -> Any:
        """A value of the model as a SymPy expression, with names as symbols.

        Args:
            x: a number, an expression or a parameter.
            own: values of further names.
        """
        return resolver(self.algebra, AnyName(own))(x)

    def expression(self, x: Any) -> Math:
        """Convert a number or SymPy expression to a formula."""
        if isinstance(x, (int, float)):
            whole = isinstance(x, float) and x.is_integer() and abs(x) < 1e6
            return number(int(x) if whole else x)
        from sympy import sympify

        return self.look.tree(sympify(x, strict=True))

    def valued(self, expression: Any) -> Any:
        """Replace parameters in a SymPy expression by numbers, if the report shows numbers."""
        if not self.folded:
            return expression
        return expression.xreplace(self._numbers)

    @cached_property
    def _numbers(self) -> dict[Any, Any]:
        """Values of independent parameters, by symbol."""
        from sympy import Symbol, sympify

        own = (p for p in self.model.parameters.values() if p.value is not None and not p.derived)
        return {Symbol(p.name): sympify(plain(p.value), strict=True) for p in own}

    def vector(self, values: Iterable[Any]) -> Math:
        """A vector in brackets; 0 if all components are zero."""
        entries = tuple(self.value(x) for x in values)
        return ZERO if all(e == ZERO for e in entries) else Components(entries)

    # -- symbols of the state

    @cached_property
    def q_names(self) -> list[str]:
        """Names of the symbols of coordinates q."""
        return [quantity.name for quantity in self.tree.positions]

    @cached_property
    def v_names(self) -> list[str]:
        """Names of the symbols of velocities v."""
        return list(self.derivation.symbol_names["v"])

    @cached_property
    def a_names(self) -> list[str]:
        """Names of the symbols of v̇."""
        return list(self.derivation.symbol_names["a"])

    @cached_property
    def u_names(self) -> list[str]:
        """Names of the symbols of inputs u."""
        return list(self.derivation.symbol_names["u"])

    @cached_property
    def efforts(self) -> dict[str, str]:
        """Names of the symbols of inputs, by name of the input."""
        return dict(zip((x.name for x in self.tree.inputs), self.u_names, strict=True))

    @cached_property
    def loop_names(self) -> list[str]:
        """Names of the symbols of an algebraic loop's unknowns."""
        return list(self.derivation.symbol_names["loop"])

    @cached_property
    def multiplier_symbols(self) -> dict[str, str]:
        """Names of the symbols of λ, by name of the multiplier."""
        from linegraph.dynamics.chords import equations

        names = (equation.multiplier.name for equation in equations(self.tree))
        return dict(zip(names, self.derivation.symbol_names["lam"], strict=True))

    @cached_property
    def multipliers(self) -> list[Quantity]:
        """The multipliers λ, named as their symbols."""
        from linegraph.dynamics.chords import equations

        found = (equation.multiplier for equation in equations(self.tree))
        return [replace(q, name=self.multiplier_symbols[q.name]) for q in found]

    def symbols(self, names: Iterable[str]) -> list[Math]:
        """Formulas of some names."""
        return [self.look.name(name) for name in names]

    # -- symbols of edges

    def domain(self, name: str) -> Domain:
        """The domain of a subspace, built in or defined by the model."""
        return self.model.domains.get(name) or DOMAINS[name]

    def across(self, domain: str, edge: str) -> Name:
        """Symbol of the across variable of an edge.

        Args:
            domain: the subspace.
            edge: name of the edge.
        """
        if domain == TRANSLATION.name:
            return Name("v", (edge,), bold=True)
        if domain == ROTATION.name:
            return Name("ω", (edge,), bold=True)
        if ("X", edge) in self._states:
            return self._states[("X", edge)]
        letter = self.domain(domain).across.letter
        return Name(LETTERS.get(letter, shaped(letter).letter), (edge,))

    def through(self, domain: str, edge: str) -> Name:
        """Symbol of the through variable of an edge; torques are about the origin of ground.

        Args:
            domain: the subspace.
            edge: name of the edge.
        """
        if domain == TRANSLATION.name:
            return Name("f", (edge,), bold=True)
        if domain == ROTATION.name:
            return Name("T", (edge,), bold=True)
        if ("Y", edge) in self._states:
            return self._states[("Y", edge)]
        letter = self.domain(domain).through.letter
        return Name(LETTERS.get(letter, shaped(letter).letter), (edge,))

    @cached_property
    def _states(self) -> dict[Any, Name]:
        """Symbols of the edges' variables that are states."""
        states = () if self.network is None else self.network.states
        return {state.key: self.look.name(state.quantity.name) for state in states}

    def combined(self, matrix: IntegerMatrix, row: int, first: Name, of: Any) -> Math:
        """A cutset or circuit equation's left side: ``X_row + Σ entries X_columns``.

        Args:
            matrix: the cutset or circuit matrix.
            row: index of the row.
            first: symbol of the row's own variable.
            of: returns the symbol of a column's variable by name of its edge.
        """
        terms: list[tuple[bool, Math]] = [(False, first)]
        for j, value in sorted(matrix.entries[row].items()):
            terms.append((value < 0, of(matrix.columns[j])))
        return total(terms, ordered=False)

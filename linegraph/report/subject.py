"""What is reported on: a derivation with its notation, and the symbols of its edges."""

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
"""Letters of domains that are written otherwise."""


class AnyName(Mapping[str, Any]):
    """Every name as the symbol of that name: laws are shown as they were said."""

    def __init__(self, known: Mapping[str, Any] | None = None) -> None:
        """Some names may stand for something else."""
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
    """A derivation as a report sees it.

    Attributes:
        derivation, model, tree: what was derived.
        look: how its expressions look.
    """

    def __init__(self, derivation: Derivation, level: str = "full", folded: bool = False) -> None:
        """Choose the notation.

        Args:
            derivation: what to report on.
            level: how far closed forms are simplified.
            folded: whether parameters are numbers.
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
        """sympy, where laws are shown."""
        from linegraph.algebra.sympy_scalars import Sympy

        names = {"q": self.q_names, "v": self.v_names, "u": self.u_names}
        return Sympy(names)

    def value(self, x: Any, /, **own: Any) -> Math:
        """A value of the model as it was given."""
        return self.expression(self.resolve(x, **own))

    def resolve(self, x: Any, /, **own: Any) -> Any:
        """A value of the model over sympy, names as symbols."""
        return resolver(self.algebra, AnyName(own))(x)

    def expression(self, x: Any) -> Math:
        """A number or a sympy expression."""
        if isinstance(x, (int, float)):
            whole = isinstance(x, float) and x.is_integer() and abs(x) < 1e6
            return number(int(x) if whole else x)
        from sympy import sympify

        return self.look.tree(sympify(x, strict=True))

    def valued(self, expression: Any) -> Any:
        """A sympy expression, parameters as numbers where that is asked for."""
        if not self.folded:
            return expression
        return expression.xreplace(self._numbers)

    @cached_property
    def _numbers(self) -> dict[Any, Any]:
        """The values of independent parameters; a name stands for its symbol and for nothing else."""
        from sympy import Symbol, sympify

        own = (p for p in self.model.parameters.values() if p.value is not None and not p.derived)
        return {Symbol(p.name): sympify(plain(p.value), strict=True) for p in own}

    def vector(self, values: Iterable[Any]) -> Math:
        """Components in brackets; 0 where all are."""
        entries = tuple(self.value(x) for x in values)
        return ZERO if all(e == ZERO for e in entries) else Components(entries)

    # -- symbols of the state

    @cached_property
    def q_names(self) -> list[str]:
        """The symbols of coordinates."""
        return [quantity.name for quantity in self.tree.positions]

    @cached_property
    def v_names(self) -> list[str]:
        """The symbols of velocities."""
        return list(self.derivation.symbol_names["v"])

    @cached_property
    def a_names(self) -> list[str]:
        """The symbols of their derivatives."""
        return list(self.derivation.symbol_names["a"])

    @cached_property
    def u_names(self) -> list[str]:
        """The symbols of inputs."""
        return list(self.derivation.symbol_names["u"])

    @cached_property
    def efforts(self) -> dict[str, str]:
        """The symbols of inputs by their names."""
        return dict(zip((x.name for x in self.tree.inputs), self.u_names, strict=True))

    @cached_property
    def loop_names(self) -> list[str]:
        """The symbols of an algebraic loop's unknowns."""
        return list(self.derivation.symbol_names["loop"])

    @cached_property
    def multiplier_symbols(self) -> dict[str, str]:
        """The symbols of λ by their names."""
        from linegraph.dynamics.chords import equations

        names = (equation.multiplier.name for equation in equations(self.tree))
        return dict(zip(names, self.derivation.symbol_names["lam"], strict=True))

    @cached_property
    def multipliers(self) -> list[Quantity]:
        """λ, by the names of their symbols."""
        from linegraph.dynamics.chords import equations

        found = (equation.multiplier for equation in equations(self.tree))
        return [replace(q, name=self.multiplier_symbols[q.name]) for q in found]

    def symbols(self, names: Iterable[str]) -> list[Math]:
        """The looks of some names."""
        return [self.look.name(name) for name in names]

    # -- symbols of edges

    def domain(self, name: str) -> Domain:
        """A subspace."""
        return self.model.domains.get(name) or DOMAINS[name]

    def across(self, domain: str, edge: str) -> Name:
        """The across variable of an edge."""
        if domain == TRANSLATION.name:
            return Name("v", (edge,), bold=True)
        if domain == ROTATION.name:
            return Name("ω", (edge,), bold=True)
        if ("X", edge) in self._states:
            return self._states[("X", edge)]
        letter = self.domain(domain).across.letter
        return Name(LETTERS.get(letter, shaped(letter).letter), (edge,))

    def through(self, domain: str, edge: str) -> Name:
        """The through variable of an edge; torques in cutset equations are about the origin of ground."""
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
        """The variables of edges that are states."""
        states = () if self.network is None else self.network.states
        return {state.key: self.look.name(state.quantity.name) for state in states}

    def combined(self, matrix: IntegerMatrix, row: int, first: Name, of: Any) -> Math:
        """``X_row + Σ entries X_columns``."""
        terms: list[tuple[bool, Math]] = [(False, first)]
        for j, value in sorted(matrix.entries[row].items()):
            terms.append((value < 0, of(matrix.columns[j])))
        return total(terms, ordered=False)

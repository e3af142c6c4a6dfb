"""The variables of one component, in which its laws are written."""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from linegraph.algebra.differentiation import Symbol
from linegraph.algebra.formula import variable_of
from linegraph.algebra.residues import CONSTANT
from linegraph.components.parameters import names_in, resolver, valued
from linegraph.components.scalar.base import ACROSS, Component
from linegraph.components.validation import nearest
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag, Node
from linegraph.networks.law_records import Laws

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.branches import Branch
    from linegraph.model.system import System

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.branches import Branch
    from linegraph.model.system import System

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Component
    from linegraph.components.scalar.branches import Branch
    from linegraph.networks.law_records import Laws


TAKEN = "taken"
"""The name of the power that a force element dissipates, as ``taken(NAME)``."""


class At:
    """The variables of one component, as its laws use them; see `components.scalar.base.Terminals`.

    Attributes:
        X, Y: across and through variable of each port.
        states: its own states by name.
        x: the displacement of its mechanical port.
        integrated: whether x is a state, since the port is in a network and not in 3-D mechanics.
    """

    def __init__(
        self,
        component: Component,
        branches: Sequence[Branch],
        laws: Laws,
        names: _Names,
        ways: Mapping[tuple[str, str], list[tuple[str, int]]],
    ) -> None:
        """Create the symbols in the network's DAG.

        Args:
            component: whose laws are to be evaluated.
            branches: its edges, one for each port.
            laws: of the network, with its DAG.
            names: all names that laws may use.
            ways: from each vertex to ground, by (domain, vertex): edges with signs.
        """
        dag = laws.dag
        self.branches = branches
        self.X = [_across(dag, branch) for branch in branches]
        self.Y = [dag.symbol("Y", branch.name) for branch in branches]
        self.states = {
            s.name: dag.symbol("s", f"{component.name}.{s.name}") for s in component.states()
        }
        self.integrated = component.displaced and not branches[-1].port.spatial
        place = f"{component.name}.displacement" if self.integrated else branches[-1].name
        self.x = dag.symbol("s" if self.integrated else "x", place)
        self._laws, self._names, self._ways = laws, names, ways
        self._who = f'{component.kind} "{component.name}"'
        # for a joint called x, the component's x and the coordinate are the same number
        self._joint = getattr(component, "joint", None)

    def value(self, given: Any, **own: Scalar) -> Scalar:
        """A model value as a scalar of the network's DAG.

        Args:
            given: a number, a parameter, an expression or its text.
            **own: scalars of the component for names in it, which take precedence.

        Raises:
            ModelError: such a name also belongs to something else in the model.
        """
        for name in sorted(names_in(given) & own.keys()) if own else ():
            if name in self._names and not (name == "x" and self._joint == name):
                problem = (
                    f'"{name}" is of the component itself here, but something else has this name'
                )
                raise ModelError(self._who, f"{problem}; rename that")
        values = self._names.with_own(own) if own else self._names
        return constant(resolver(self._laws.dag, values)(given), self._laws.dag)

    def function(self, name: str, *x: Scalar) -> Scalar:
        """An elementary function, as a node of the network's DAG.

        Args:
            name: its name in `ir.functions.ARITY`.
            *x: its arguments.
        """
        return self._laws.dag.function(name, *x)

    def potential(self, domain: str, vertex: str) -> Scalar:
        """The potential of a vertex relative to ground: across variables summed along a tree.

        Args:
            domain: name of the subspace.
            vertex: name of the vertex.
        """
        total: Scalar = 0
        for edge, sign in self._ways[(domain, vertex)]:
            x = self._laws.dag.symbol("X", edge)
            total = total + x if sign > 0 else total - x
        return total

    def derivative(self, of: Scalar, by: Scalar) -> Scalar:
        """The partial derivative of a law or a charge.

        Args:
            of: the scalar.
            by: one of the symbols of this component.
        """
        return self._laws.calculus.derivative(of, key_of(by))

    def taken(self, name: str) -> Scalar:
        """The power that another component or a force element dissipates (W).

        Raises:
            ModelError: there is no such component, damper or friction.
        """
        if name in self._laws.heat:
            return self._laws.heat[name]
        if name in self._names.forces:
            return self._laws.dag.symbol("name", f"{TAKEN}({name})")
        known = [*self._laws.heat, *self._names.forces]
        raise ModelError(
            "", f'of: there is no component, damper or friction "{name}"; {nearest(name, known)}'
        )


def key_of(symbol: Scalar) -> Symbol:
    """Argument and place of a symbol's node."""
    assert isinstance(symbol, Node)
    return (symbol.a, symbol.b)


def constant(x: Scalar, dag: Dag) -> Scalar:
    """A number as an exact one, by its decimal digits, so that terms cancel that should.

    A number that is not an integer becomes a symbol that carries its value: sums and products of many exact
    fractions would grow without bound. `Residues` knows its value, and it is a number again where the network
    is used.

    Args:
        x: a number; other scalars are returned unchanged.
        dag: of the network.
    """
    if isinstance(x, float) and math.isfinite(x):
        x = Fraction(repr(x))
    if not isinstance(x, Fraction):
        return x
    return int(x) if x.denominator == 1 else dag.symbol(CONSTANT, str(x))


def _across(dag: Dag, branch: Branch) -> Scalar:
    return dag.symbol("w" if branch.port.spatial else "X", branch.name)


class _Names(Mapping[str, Any]):
    """All names that a law may use; their symbols are created when they are looked up."""

    def __init__(self, model: System, branches: Sequence[Branch], dag: Dag) -> None:
        self._dag = dag
        self._values = valued(model.parameters.values(), dag, lambda p: dag.symbol("p", p.name))
        self._known: dict[str, Symbol] = {"t": ("t", None)}
        self._known |= {declared.name: ("u", declared.name) for declared in model.inputs}
        for joint in model.joints:
            for quantity in joint.positions():
                for name in (quantity.name, f"der({quantity.name})"):
                    self._known[name] = ("name", name)
        self._edges: dict[str, Branch] = {branch.name: branch for branch in branches}
        self.forces = {e.name for e in model.force_elements if e.kind in DISSIPATIVE}

    def with_own(self, own: Mapping[str, Scalar]) -> Mapping[str, Scalar]:
        """The names of a component before all others."""
        return _Both(own, self)

    def __contains__(self, name: object) -> bool:
        return name in self._values or name in self._known or self._edge(str(name)) is not None

    def __getitem__(self, name: str) -> Scalar:
        if name in self._values:
            return self._values[name]
        if name in self._known:
            return self._dag.symbol(*self._known[name])
        found = self._edge(name)
        if found is None:
            raise KeyError(name)
        kind, branch = found
        return _across(self._dag, branch) if kind == ACROSS else self._dag.symbol("Y", branch.name)

    def _edge(self, name: str) -> tuple[str, Branch] | None:
        """The edge of ``across(R1)`` or ``through(motor.electrical)``; None for other names."""
        kind, edge, part = variable_of(name) or ("", "", "")
        if kind not in ("across", "through") or part:
            return None
        if edge in self._edges:
            return kind, self._edges[edge]
        return None

    def __iter__(self) -> Iterator[str]:
        yield from (*self._known, *self._values)
        for name in self._edges:
            yield from (f"across({name})", f"through({name})")

    def __len__(self) -> int:
        return len(list(iter(self)))


class _Both(Mapping[str, Any]):
    """A component's own names before those of the model."""

    def __init__(self, own: Mapping[str, Scalar], others: Mapping[str, Scalar]) -> None:
        self._own, self._others = own, others

    def __contains__(self, name: object) -> bool:
        return name in self._own or name in self._others

    def __getitem__(self, name: str) -> Scalar:
        return self._own[name] if name in self._own else self._others[name]

    def __iter__(self) -> Iterator[str]:
        yield from (*self._own, *self._others)

    def __len__(self) -> int:
        return len(self._own) + len(self._others)


DISSIPATIVE = ("damper", "friction")
"""Force elements that dissipate all the power they take in."""

"""Terminal equations: every component's laws, written once over the symbols of a DAG of the network's own.

X, Y    the across and the through variable of an edge
s       a state of a component's own
w, x    rate and displacement of an edge in 3-D mechanics
u, t, p, name    inputs, the time, parameters, and whatever else of the model laws name
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from linegraph.algebra.differentiation import Calculus, Symbol, substitute
from linegraph.algebra.formula import variable_of
from linegraph.algebra.residues import CONSTANT
from linegraph.components.domains import DOMAINS
from linegraph.components.parameters import names_in, resolver, valued
from linegraph.components.scalar.base import ACROSS, STATIC, Component
from linegraph.components.validation import nearest
from linegraph.errors import ModelError
from linegraph.graph.forest import choose_forest
from linegraph.ir.dag import Dag, Node
from linegraph.ir.program import Quantity
from linegraph.networks.stored import changing, coenergy_of, own_energy_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.branches import Branch
    from linegraph.graph.multigraph import Projection
    from linegraph.model.builder import Model

DISSIPATIVE = ("damper", "friction")
"""Force elements that turn all they take in into heat."""

TAKEN = "taken"
"""The power that a force element turns into heat stands under this name."""


@dataclass(frozen=True)
class Store:
    """An edge that keeps a variable: the other one is ``d/dt charge + rest``.

    Attributes:
        edge: its name.
        key: the symbol that is kept.
        dual: the symbol of the other variable.
        charge: of what is kept, a displacement, the time.
        rest: what the other variable has beside the charge's rate.
    """

    edge: str
    key: Symbol
    dual: Symbol
    charge: Scalar
    rest: Scalar


@dataclass(frozen=True)
class Static:
    """A law without a rate: what is zero, and the edge whose port it is the law of."""

    component: Component
    zero: Scalar
    edge: str = ""


@dataclass(frozen=True)
class Own:
    """A state of a component's own, and its rate."""

    key: Symbol
    quantity: Quantity
    rate: Scalar


@dataclass
class Laws:
    """All laws of a network.

    Attributes:
        energy: stored by each component; in powers of what is kept only where a co-energy is known.
        heat: the power each component dissipates.
        unknown: components whose energy is not known: of a charge or a force that no rule integrates.
        driven: stores whose value the time or inputs change, and the names of these.
    """

    dag: Dag
    calculus: Calculus
    statics: list[Static] = field(default_factory=list)
    stores: list[Store] = field(default_factory=list)
    spatial: list[Store] = field(default_factory=list)
    own: list[Own] = field(default_factory=list)
    energy: dict[str, Scalar] = field(default_factory=dict)
    heat: dict[str, Scalar] = field(default_factory=dict)
    unknown: set[str] = field(default_factory=set)
    driven: dict[str, tuple[str, ...]] = field(default_factory=dict)


def laws_of(model: Model, branches: Sequence[Branch], projections: Sequence[Projection]) -> Laws:
    """Evaluate every component.

    Raises:
        ModelError: a law names what does not exist, or has no value.
    """
    dag = Dag()
    laws = Laws(dag, Calculus(dag, (CONSTANT,)))
    names = _Names(model, branches, dag)
    ways = _ways(projections, {branch.name for branch in branches if branch.kept == ACROSS})
    by_component: dict[str, list[Branch]] = {}
    for branch in branches:
        by_component.setdefault(branch.component.name, []).append(branch)
    ordered = [c for c in model.components if c.kind != "losses"]
    ordered += [c for c in model.components if c.kind == "losses"]
    for component in ordered:
        at = At(component, by_component[component.name], laws, names, ways)
        who = f'{component.kind} "{component.name}"'
        try:
            _require_names(component, names)
            _evaluate(component, at, laws)
        except ModelError as error:
            problem = error.problem if not error.thing else str(error)
            raise ModelError(who, problem) from None
        except ZeroDivisionError:
            raise ModelError(who, "division by zero: a value that is divided by is zero") from None
        except (ArithmeticError, ValueError) as error:
            raise ModelError(who, f"has no finite value ({error})") from None
    return laws


def _require_names(component: Component, names: _Names) -> None:
    """Refuse variables of edges that do not exist, and the state of an element that has none."""
    stateless = component.kind == "element" and getattr(component, "rate", None) is None
    for value in component.values():
        for name in sorted(names_in(value)):
            variable = variable_of(name)
            if variable is not None and name not in names:
                edges = [n for n in names if n.startswith(f"{variable[0]}(")]
                known = [n.partition("(")[2].rstrip(")") for n in edges]
                hint = nearest(variable[1], known)
                raise ModelError("", f"there is no {variable[0]}({variable[1]}); {hint}")
            if name == "s" and stateless and name not in names:
                raise ModelError(
                    "", "s is its state, and it has none: give rate, the derivative of s"
                )


def _evaluate(component: Component, at: At, laws: Laws) -> None:
    """One component's statics, stores, states, energy and heat."""
    calculus = laws.calculus
    charges = component.charges(at)
    work = (
        component.kept_coenergy(at)
        if charges is None
        else coenergy_of(component, at, laws, charges)
    )
    zeros = component.laws(at)
    own_energy = own_energy_of(component, at, laws)
    driven = changing(component, at.branches, calculus, (work, own_energy, *(charges or ())))
    if driven:
        laws.driven[component.name] = driven
    pushed = calculus.derivative(work, key_of(at.x)) if component.displaced else 0
    kept_keys = {
        key_of((at.X, at.Y)[b.kept != ACROSS][k]) for k, b in enumerate(at.branches) if b.kept
    }
    stored: Scalar = 0
    quadratic = substitute(work, laws.dag, dict.fromkeys(kept_keys, 0)) == 0
    for k, branch in enumerate(at.branches):
        zero = zeros[k] + pushed if _mechanical(component, k) else zeros[k]
        if branch.kept == STATIC:
            laws.statics.append(Static(component, zero, branch.name))
            continue
        kept, other = (at.X, at.Y) if branch.kept == ACROSS else (at.Y, at.X)
        charge = calculus.derivative(work, key_of(kept[k])) if charges is None else charges[k]
        if not isinstance(charge, Node) and charge == 0:
            raise ModelError("", "stores nothing: its value is zero; leave it out")
        found = laws.spatial if branch.port.spatial else laws.stores
        found.append(Store(branch.name, key_of(kept[k]), key_of(other[k]), charge, zero))
        quadratic = quadratic and _proportional(charge, kept_keys, laws)
        stored = stored + kept[k] * charge
    rates = list(component.rates(at))
    for state, rate in zip(component.states(), rates, strict=True):
        about = f"{state.about} of {component.name}"
        quantity = Quantity(f"{state.label}_{component.name}", state.unit, about)
        laws.own.append(Own(key_of(at.states[state.name]), quantity, rate))
    if at.integrated:
        across = DOMAINS[at.branches[-1].port.domain].across
        letter, unit, about = across.integral
        quantity = Quantity(f"{letter}_{component.name}", unit, f"{about} of {component.name}")
        laws.own.append(Own(key_of(at.x), quantity, at.X[-1]))
    # of charges in proportion to what is kept energy and co-energy are the same
    energy = 0 if component.name in laws.unknown else work if quadratic else stored - work
    laws.energy[component.name] = own_energy + energy
    laws.heat[component.name] = component.dissipation(at)


def _proportional(charge: Scalar, kept: set[Symbol], laws: Laws) -> bool:
    """Whether a charge is linear in what is kept, without a constant."""
    slopes = laws.calculus.gradient(charge)
    curved = any(
        laws.calculus.support(slope) & kept for key, slope in slopes.items() if key in kept
    )
    return not curved and substitute(charge, laws.dag, dict.fromkeys(kept, 0)) == 0


def _mechanical(component: Component, place: int) -> bool:
    """Whether a port is the one whose displacement counts: the last."""
    return component.displaced and place == len(component.ports()) - 1


def key_of(symbol: Scalar) -> Symbol:
    """The argument and place of a symbol."""
    assert isinstance(symbol, Node)
    return (symbol.a, symbol.b)


class At:
    """One component's variables: what its laws are written in (`components.base.Terminals`)."""

    def __init__(
        self,
        component: Component,
        branches: Sequence[Branch],
        laws: Laws,
        names: _Names,
        ways: Mapping[tuple[str, str], list[tuple[str, int]]],
    ) -> None:
        """Make the symbols."""
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
        # in a joint called x, x is one number, whether the component's own or the coordinate
        self._joint = getattr(component, "joint", None)

    def value(self, given: Any, **own: Scalar) -> Scalar:
        """A model value as a scalar.

        Raises:
            ModelError: a name of the component's own has another owner, too.
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
        """A function."""
        return self._laws.dag.function(name, *x)

    def potential(self, domain: str, vertex: str) -> Scalar:
        """Along the tree from a vertex to ground."""
        total: Scalar = 0
        for edge, sign in self._ways[(domain, vertex)]:
            x = self._laws.dag.symbol("X", edge)
            total = total + x if sign > 0 else total - x
        return total

    def derivative(self, of: Scalar, by: Scalar) -> Scalar:
        """By a symbol."""
        return self._laws.calculus.derivative(of, key_of(by))

    def taken(self, name: str) -> Scalar:
        """What another component loses, or a force element."""
        if name in self._laws.heat:
            return self._laws.heat[name]
        if name in self._names.forces:
            return self._laws.dag.symbol("name", f"{TAKEN}({name})")
        known = [*self._laws.heat, *self._names.forces]
        raise ModelError(
            "", f'of: there is no component, damper or friction "{name}"; {nearest(name, known)}'
        )


def constant(x: Scalar, dag: Dag) -> Scalar:
    """A number as its decimal digits say it: what cancels, cancels.

    One that is not whole is a symbol that carries its value: sums and products of many exact fractions would
    grow without bound. `Residues` knows what it is worth, and it is a number again where the network is used.
    """
    if isinstance(x, float) and math.isfinite(x):
        x = Fraction(repr(x))
    if not isinstance(x, Fraction):
        return x
    return int(x) if x.denominator == 1 else dag.symbol(CONSTANT, str(x))


def _across(dag: Dag, branch: Branch) -> Scalar:
    return dag.symbol("w" if branch.port.spatial else "X", branch.name)


def _ways(
    projections: Sequence[Projection], kept: set[str]
) -> dict[tuple[str, str], list[tuple[str, int]]]:
    """From each vertex to ground: edges with +1 where X counts from the vertex's side, rather `kept` ones."""
    found: dict[tuple[str, str], list[tuple[str, int]]] = {}
    for projection in projections:
        weights = {edge.name: float(edge.name not in kept) for edge in projection.edges}
        topology = choose_forest(projection, weights, ("ground",))
        found |= {(projection.domain, root): [] for root in topology.roots}
        for step in topology.walk:
            sign = -1 if step.forward else 1
            way = [(step.edge.name, sign), *found[(projection.domain, step.near)]]
            found[(projection.domain, step.far)] = way
    return found


class _Names(Mapping[str, Any]):
    """Everything a law may name, made into symbols as it is named."""

    def __init__(self, model: Model, branches: Sequence[Branch], dag: Dag) -> None:
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
        """These names too, before all others."""
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
        """What ``across(R1)`` or ``through(motor.electrical)`` means."""
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

"""Terminal equations: all laws of the components, evaluated once over symbols of the network's own DAG.

X, Y    the across and the through variable of an edge
s       a state of a component
w, x    rate and displacement of a port in 3-D mechanics
u, t, p, name    inputs, the time, parameters, and all else of the model that laws name
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.algebra.differentiation import Calculus, Symbol, substitute
from linegraph.algebra.formula import variable_of
from linegraph.algebra.residues import CONSTANT
from linegraph.components.domains import DOMAINS
from linegraph.components.parameters import names_in
from linegraph.components.scalar.base import ACROSS, STATIC, Component
from linegraph.components.validation import nearest
from linegraph.errors import ModelError
from linegraph.graph.forest import choose_forest
from linegraph.ir.dag import Dag, Node
from linegraph.ir.program import Quantity
from linegraph.networks.law_records import Laws, Own, Static, StoreLaw
from linegraph.networks.stored import changing, coenergy_of, own_energy_of
from linegraph.networks.variables import At, _Names, key_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.branches import Branch
    from linegraph.graph.multigraph import Projection
    from linegraph.model.system import System


def laws_of(model: System, branches: Sequence[Branch], projections: Sequence[Projection]) -> Laws:
    """Evaluate the laws of every component.

    Args:
        model: the system.
        branches: the edges of its components.
        projections: the graph of each scalar subspace.

    Raises:
        ModelError: a law names something that does not exist, or has no finite value.
    """
    dag = Dag()
    laws = Laws(dag, Calculus(dag, (CONSTANT,)))
    names = _Names(model, branches, dag)
    ways = _ways(projections, {branch.name for branch in branches if branch.kept == ACROSS})
    by_component: dict[str, list[Branch]] = {}
    for branch in branches:
        by_component.setdefault(branch.component.name, []).append(branch)
    # losses name the heat of other components, which has to be known first
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
    """Refuse names of edges that do not exist, and the state s of an element that has none."""
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
    """Enter one component's static laws, stores, states, energy and heat."""
    calculus = laws.calculus
    charges = component.charges(at)
    if charges is None:
        work = component.kept_coenergy(at)
        slopes = [calculus.derivative(work, key_of(x)) for x in _kept(at)]
        charges_of_ports = dict(zip(_storing(at), slopes, strict=True))
    else:
        work = coenergy_of(component, at, laws, charges)
        charges_of_ports = {k: charges[k] for k in _storing(at)}
    zeros = list(component.laws(at))
    own_energy = own_energy_of(component, at, laws)
    driven = changing(component, at.branches, calculus, (work, own_energy, *(charges or ())))
    if driven:
        laws.driven[component.name] = driven
    if component.displaced:
        # the force with which a co-energy pushes: without it, moving the port would make energy from nothing
        pushed = calculus.derivative(work, key_of(at.x))
        zeros = [z + pushed if _mechanical(component, k) else z for k, z in enumerate(zeros)]
    _enter_ports(component, at, laws, charges_of_ports, zeros)
    _enter_states(component, at, laws)
    # of charges in proportion to what is kept energy and co-energy are the same
    energy: Scalar = 0
    if component.name not in laws.unknown:
        kept = {key_of(x) for x in _kept(at)}
        quadratic = substitute(work, laws.dag, dict.fromkeys(kept, 0)) == 0 and all(
            _proportional(charge, kept, laws) for charge in charges_of_ports.values()
        )
        stored = sum(x * y for x, y in zip(_kept(at), charges_of_ports.values(), strict=True))
        energy = work if quadratic else stored - work
    laws.energy[component.name] = own_energy + energy
    laws.heat[component.name] = component.dissipation(at)


def _storing(at: At) -> list[int]:
    """The ports of a component that keep a variable."""
    return [k for k, branch in enumerate(at.branches) if branch.kept != STATIC]


def _kept(at: At) -> list[Scalar]:
    """The variables that these keep: across or through."""
    return [(at.X if at.branches[k].kept == ACROSS else at.Y)[k] for k in _storing(at)]


def _enter_ports(
    component: Component,
    at: At,
    laws: Laws,
    charges: Mapping[int, Scalar],
    zeros: Sequence[Scalar],
) -> None:
    """Enter the law of every port: a static one, or that of a store with its charge."""
    for k, branch in enumerate(at.branches):
        if branch.kept == STATIC:
            laws.statics.append(Static(component, zeros[k], branch.name))
            continue
        kept, other = (at.X, at.Y) if branch.kept == ACROSS else (at.Y, at.X)
        if not isinstance(charges[k], Node) and charges[k] == 0:
            raise ModelError("", "stores nothing: its value is zero; leave it out")
        found = laws.spatial if branch.port.spatial else laws.stores
        found.append(StoreLaw(branch.name, key_of(kept[k]), key_of(other[k]), charges[k], zeros[k]))


def _enter_states(component: Component, at: At, laws: Laws) -> None:
    """Enter the states that a component has of its own, and the displacement it integrates."""
    for state, rate in zip(component.states(), component.rates(at), strict=True):
        about = f"{state.about} of {component.name}"
        quantity = Quantity(f"{state.label}_{component.name}", state.unit, about)
        laws.own.append(Own(key_of(at.states[state.name]), quantity, rate))
    if at.integrated:
        across = DOMAINS[at.branches[-1].port.domain].across
        letter, unit, about = across.integral
        quantity = Quantity(f"{letter}_{component.name}", unit, f"{about} of {component.name}")
        laws.own.append(Own(key_of(at.x), quantity, at.X[-1]))


def _proportional(charge: Scalar, kept: set[Symbol], laws: Laws) -> bool:
    """Whether a charge is linear in the kept variables, without a constant term."""
    slopes = laws.calculus.gradient(charge)
    curved = any(
        laws.calculus.support(slope) & kept for key, slope in slopes.items() if key in kept
    )
    return not curved and substitute(charge, laws.dag, dict.fromkeys(kept, 0)) == 0


def _mechanical(component: Component, place: int) -> bool:
    """Whether a port is the one whose displacement is in the co-energy: the last."""
    return component.displaced and place == len(component.ports()) - 1


def _ways(
    projections: Sequence[Projection], kept: set[str]
) -> dict[tuple[str, str], list[tuple[str, int]]]:
    """From each vertex the way to ground: edges, +1 where X is counted from the vertex's side.

    Edges that keep an across variable are preferred.
    """
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

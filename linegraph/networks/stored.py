"""The energy of stores, and the variables on which their values may depend.

The other variable of a store is the rate of a charge, ``d/dt ∂W'/∂kept``. If the co-energy W' depends on
anything else, a force ``∂W'/∂x`` belongs to that: a capacitor pulls its plate. A transducer has a port for
it. Without a port, energy would come from nothing, so that such a store is refused. The time and inputs may
change a store, since whoever changes it does the work.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.algebra.antiderivative import antiderivative
from linegraph.algebra.formula import Formula, variable_of
from linegraph.components.parameters import names_in
from linegraph.components.scalar.base import ACROSS, PLACES
from linegraph.components.scalar.stores import Spring1D
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from typing import Any

    from linegraph.algebra.differentiation import Calculus, Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Component
    from linegraph.components.scalar.branches import Branch
    from linegraph.networks.law_records import Laws
    from linegraph.networks.variables import At

TRANSDUCERS = {
    "capacitor": "variable_capacitor",
    "inductor": "solenoid or reluctance_machine",
    "coupled_inductors": "solenoid or reluctance_machine",
    "reluctance": "solenoid or reluctance_machine",
}
"""The component to use instead of a store whose value depends on the motion of a joint, by kind."""


def changing(
    component: Component, branches: Sequence[Branch], calculus: Calculus, stored: Iterable[Scalar]
) -> tuple[str, ...]:
    """The names of the inputs, and the time, that change the value of a store.

    Args:
        component: the store.
        branches: its edges.
        calculus: derivatives over the network's DAG.
        stored: its co-energy, energy and charges.

    Raises:
        ModelError: the value depends on a joint, on the variables of other edges, or, if it is to be
            constant, on those of its own.
    """
    _require_constants(component, {branch.name for branch in branches})
    support = sorted({s for x in stored for s in calculus.support(x)}, key=repr)
    own = {branch.name for branch in branches}
    found = []
    for kind, place in support:
        if kind == "name":
            raise ModelError("", _moved(component, str(place)))
        if kind in ("X", "Y", "w", "x") and place not in own:
            raise ModelError("", _foreign(component, _named((kind, place))))
        if kind in ("t", "u"):
            found.append("t" if kind == "t" else str(place))
    return tuple(found)


def coenergy_of(component: Component, at: At, laws: Laws, charges: Sequence[Scalar]) -> Scalar:
    """The co-energy of a store by its charge, ``∫ Q dk`` with the kept variable k; 0 where no rule gives it.

    Args:
        component: the store; without a rule it is entered in `laws.unknown`.
        at: its variables.
        laws: of the network.
        charges: its charges, one for each port.
    """
    kept: Any = (at.X if at.branches[0].kept == ACROSS else at.Y)[0]
    found = antiderivative(laws.calculus, charges[0], (kept.a, kept.b))
    if found is None or len(charges) > 1:
        laws.unknown.add(component.name)
        return 0
    return found


def own_energy_of(component: Component, at: At, laws: Laws) -> Scalar:
    """The energy in states of the component itself (J); of a spring given by its force ``∫ Y dx``.

    Args:
        component: the component; without a rule it is entered in `laws.unknown`.
        at: its variables.
        laws: of the network.
    """
    if not isinstance(component, Spring1D) or component.force is None:
        return component.own_energy(at)
    x: Any = at.states["x"]
    found = antiderivative(laws.calculus, at.value(component.force, x=x), (x.a, x.b))
    if found is None:
        laws.unknown.add(component.name)
        return 0
    return found


def _named(symbol: Symbol) -> str:
    kind, place = symbol
    return f"{'through' if kind == 'Y' else 'across'}({place})"


def _moved(component: Component, name: str) -> str:
    problem = (
        f"stores energy, and its value names {name}: it would have to push the joint, and has no edge there; "
        "energy would come from nothing"
    )
    other = TRANSDUCERS.get(component.kind)
    if other is None:
        return (
            f"{problem}. Let the value depend on parameters, inputs, t and its own variable alone"
        )
    return f"{problem}. Use {other}: its value depends on its displacement x, and it pushes"


def _foreign(component: Component, name: str) -> str:
    return (
        f"stores energy, and its value names {name}: that edge would have to take part of the power, and "
        "does not; energy would come from nothing. Let the value depend on parameters, inputs, t and its own "
        "variable alone"
    )


def _require_constants(component: Component, own: set[str]) -> None:
    """Refuse a constant that depends on the store's own variables."""
    if not any(component.kept()):
        return
    for field, value in _fields(component):
        if field in component.own:
            continue
        for name in sorted(names_in(value)):
            variable = variable_of(name)
            if variable and variable[0] in ("across", "through") and variable[1] in own:
                law = " or ".join(sorted(component.own)) or "an element with a law"
                problem = f"{field} names its own {name}; give {law} instead, of its own variable"
                raise ModelError("", problem)


def _fields(component: Component) -> list[tuple[str, Any]]:
    given = ((key, getattr(component, key)) for key in component.__dataclass_fields__)
    found = []
    for key, value in given:
        if key not in PLACES:
            parts = value if isinstance(value, (tuple, list)) else (value,)
            found += [(key, part) for part in parts if isinstance(part, (str, Formula)) and part]
    return found

"""Records of a network's evaluated laws: stores, static laws, and states of components."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linegraph.algebra.differentiation import Calculus, Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.scalar.base import Component
    from linegraph.ir.dag import Dag
    from linegraph.ir.program import Quantity


@dataclass(frozen=True)
class StoreLaw:
    """The law of a port that stores: one variable is kept, the other is ``d/dt charge + rest``.

    Attributes:
        edge: its name.
        key: the symbol of the variable that is kept.
        dual: the symbol of the other variable.
        charge: a function of kept variables, displacements and the time, such as C X or L Y.
        rest: the part of the other variable that is not the charge's rate.
    """

    edge: str
    key: Symbol
    dual: Symbol
    charge: Scalar
    rest: Scalar


@dataclass(frozen=True)
class Static:
    """A law without a rate.

    Attributes:
        component: whose law it is.
        zero: an expression that is zero.
        edge: the port to which the law belongs.
    """

    component: Component
    zero: Scalar
    edge: str = ""


@dataclass(frozen=True)
class Own:
    """A state of a component beside its ports, with its rate.

    Attributes:
        key: its symbol.
        quantity: its name, unit and meaning.
        rate: its time derivative.
    """

    key: Symbol
    quantity: Quantity
    rate: Scalar


@dataclass
class Laws:
    """All laws of a network.

    Attributes:
        dag: of all scalars.
        calculus: derivatives over it.
        statics: laws without rates.
        stores: laws of stores in scalar subspaces.
        spatial: laws of ports in 3-D mechanics that store.
        own: states of components.
        energy: stored by each component (J); 0 for the part that no rule integrates.
        heat: the power that each component dissipates (W).
        unknown: components of unknown energy: no rule integrates their charge or force.
        driven: for stores whose value the time or inputs change, the names of these.
    """

    dag: Dag
    calculus: Calculus
    statics: list[Static] = field(default_factory=list)
    stores: list[StoreLaw] = field(default_factory=list)
    spatial: list[StoreLaw] = field(default_factory=list)
    own: list[Own] = field(default_factory=list)
    energy: dict[str, Scalar] = field(default_factory=dict)
    heat: dict[str, Scalar] = field(default_factory=dict)
    unknown: set[str] = field(default_factory=set)
    driven: dict[str, tuple[str, ...]] = field(default_factory=dict)

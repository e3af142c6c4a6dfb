"""The laws of a network, evaluated: stores, static laws, states of components of their own."""

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
    stores: list[StoreLaw] = field(default_factory=list)
    spatial: list[StoreLaw] = field(default_factory=list)
    own: list[Own] = field(default_factory=list)
    energy: dict[str, Scalar] = field(default_factory=dict)
    heat: dict[str, Scalar] = field(default_factory=dict)
    unknown: set[str] = field(default_factory=set)
    driven: dict[str, tuple[str, ...]] = field(default_factory=dict)

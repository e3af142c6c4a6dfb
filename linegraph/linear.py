"""Linear systems from closed forms: those that are linear, and small deviations of those that are not."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import sympy

from linegraph.checks import nearest
from linegraph.errors import ModelError
from linegraph.state_space import StateSpace, linearised, state_space

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.symbols import Symbolic

Expr = Any


def state_space_of(symbolic: Symbolic) -> StateSpace:
    """A, B, C, D of a linear system; its outputs are the model's, or all states where it has none.

    Raises:
        ModelError: it is not linear.
    """
    if symbolic.tree.network is not None:
        symbolic.tree.network.require_linear()
    states = [*symbolic.q, *symbolic.v]
    rates = [*symbolic.coordinate_rates, *symbolic.rates]
    return state_space(states, rates, *_inputs(symbolic), _outputs(symbolic), symbolic.defaults)


def linearise(symbolic: Symbolic, at: Mapping[Any, Any]) -> StateSpace:
    """A, B, C, D for small deviations from an equilibrium or a steady motion.

    Args:
        symbolic: the closed forms.
        at: values of coordinates, velocities and inputs by name or symbol, numbers or expressions of
            parameters; those left out are 0, of quaternions the identity.

    Raises:
        ModelError: v̇ is not 0 there, there are constraints, or the time stands in the equations.

    Example:
        >>> from linegraph import Model, derive
        >>> model = Model("pendulum")
        >>> l = model.parameter("l", 0.5)
        >>> model.gravity = (0, 0, -model.parameter("g", 9.81))
        >>> bob = model.body("bob", mass=1, mass_center=(0, 0, -l))
        >>> _ = model.revolute("theta", between=("ground", bob), axis=(0, 1, 0))
        >>> linearise(derive(model).symbolic, {"theta": sympy.pi}).A
        Matrix([
        [  0, 1],
        [g/l, 0]])
    """
    symbolic.require_open("linearise")
    equations = (
        symbolic.coordinate_rates,
        symbolic.mass_matrix,
        symbolic.forces - symbolic.bias,
    )
    point = _point(symbolic, at)
    rest = (*_inputs(symbolic), _outputs(symbolic), symbolic.defaults)
    return linearised(equations, (symbolic.q, symbolic.v), point, *rest)


def _inputs(symbolic: Symbolic) -> tuple[list[Expr], dict[Expr, Expr]]:
    """The inputs that are no derivatives of others, and the symbols of those that are."""
    found = symbolic.tree.layout.slopes
    slopes = {symbolic.u[k]: symbolic.u[rate] for k, rate in found.items()}
    return [u for u in symbolic.u if u not in slopes.values()], slopes


def _outputs(symbolic: Symbolic) -> dict[str, Expr]:
    return symbolic.outputs or {str(x): x for x in [*symbolic.q, *symbolic.v]}


def _point(symbolic: Symbolic, at: Mapping[Any, Any]) -> dict[Expr, Expr]:
    """The value of every state and input: as given, or at rest."""
    symbols = {str(x): x for x in [*symbolic.q, *symbolic.v, *symbolic.u]}
    found = dict.fromkeys(symbols.values(), sympy.Integer(0))
    for link in symbolic.tree.links:
        for freedom, value in zip(link.place.positions, link.joint.rest(), strict=False):
            found[symbolic.q[freedom.index]] += sympy.nsimplify(value)
    for name, value in at.items():
        if str(name) not in symbols:
            problem = f"is no coordinate, velocity or input; {nearest(str(name), symbols)}"
            raise ModelError(f'"{name}"', problem)
        found[symbols[str(name)]] = sympy.sympify(value, strict=True)
    return found

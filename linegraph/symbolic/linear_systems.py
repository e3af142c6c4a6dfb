"""Linear systems in letters: those that are linear, and small deviations of those that are not."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import sympy

from linegraph.algebra.differentiation import Calculus
from linegraph.components.validation import nearest
from linegraph.errors import ModelError
from linegraph.symbolic.at_state import IN_NUMBERS, WHO, AtState, picked
from linegraph.symbolic.small_motions import LOOP, slopes
from linegraph.symbolic.state_space import StateSpace

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.algebra.differentiation import Symbol
    from linegraph.symbolic.equation_forms import EquationForms
    from linegraph.symbolic.small_motions import EquationsOfMotion

Expr = Any


def state_space_of(symbolic: EquationForms) -> StateSpace:
    """A, B, C, D of a linear system; its outputs are the model's, or all states if there are none.

    Raises:
        ModelError: it is not linear, depends on time or has a constant part, or there are constraints.
    """
    symbolic.require_open("state space")
    if symbolic.tree.network is not None:
        symbolic.tree.network.require_linear()
    motion = symbolic.motion
    _require_no_time(motion, "state space")
    found = _space(symbolic, _at(symbolic, {}), moving=True)
    names = [*found.states, *found.outputs]
    known = {str(x) for x in _states(symbolic).values()}
    upper, lower = (sympy.Matrix.hstack(*parts) for parts in found.halves)
    whole = upper.col_join(lower)
    for i, name in enumerate(names):
        used = {str(x) for x in whole[i, :].free_symbols} & known
        if used:
            problem = f"is not linear in {min(used)}: there is no state space"
            raise ModelError(f'"{name}"', problem)
    for name, x in zip(names, _at(symbolic, _at_rest(symbolic)).rates(), strict=True):
        if x != 0:
            problem = f"has a part ({x}) that is neither of states nor of inputs; make its source an input"
            raise ModelError(f'"{name}"', problem)
    return found


def linearise(symbolic: EquationForms, at: Mapping[Any, Any]) -> StateSpace:
    """A, B, C, D for small deviations from an equilibrium or a steady motion.

    In a tree the states are q and v. With closed loops or rolling wheels they are the independent
    changes of position and velocities of the emitted ``linearize``, and all others follow.

    Args:
        symbolic: the closed forms.
        at: values of coordinates, velocities, inputs and unknowns of algebraic loops by name or symbol:
            numbers, or expressions of parameters and other letters. Omitted ones are 0, for quaternions
            the identity.

    Raises:
        ModelError: M is singular, v̇ is not 0 there, constraints do not hold there, or the equations
            depend on time.

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
    symbolic.derivation.require_inverse(WHO)
    motion = symbolic.motion
    _require_no_time(motion, WHO)
    _require_no_input(symbolic)
    given = _given(symbolic, at)
    state = _at(symbolic, _at_rest(symbolic) | given)
    try:
        state.require_kept()
    except ModelError:
        values = _in_numbers(symbolic, given)
        if values is None:
            raise
        state = _at(symbolic, values)
        state.require_kept()
    state.require_steady()
    return _space(symbolic, state, moving=False)


def _space(symbolic: EquationForms, state: AtState, *, moving: bool) -> StateSpace:
    """The matrices, with columns of inputs separate from those of their derivatives."""
    rows = state.matrices(slopes(symbolic.motion, moving=moving), moving=moving)
    inputs, steep = _inputs(symbolic)
    n = len(state.states)
    columns: list[list[int | None]] = [
        list(range(n)),
        [n + k for k in inputs],
        [None if k is None else n + k for k in steep],
    ]
    A, B, E, C, D, F = (picked(part, places) for part in rows for places in columns)
    names = (tuple(str(symbolic.u[k]) for k in inputs), tuple(symbolic.motion.outputs))
    return StateSpace(state.states, *names, A, B, C, D, E, F, symbolic.defaults)


def _at(symbolic: EquationForms, values: Mapping[Symbol, Expr]) -> AtState:
    """The motion at a state; parameters are plain symbols, whatever the values assume about them."""
    simplifier = symbolic.simplifier.twin()
    for symbol, e in _states(symbolic).items():
        if symbol not in values:
            simplifier.define(symbol, e)
    own = symbolic.derivation.system.parameters
    plain = {
        symbol: e.xreplace({x: sympy.Symbol(x.name) for x in e.free_symbols if x.name in own})
        for symbol, e in values.items()
    }
    letters = {x.name for e in plain.values() for x in e.free_symbols}
    for name in sorted({*own, *letters}):  # fixes the order of terms in sums
        simplifier.ring.symbol("p", name)
    chosen = (_independent(symbolic), _rank(symbolic)) if symbolic.tree.closed else ()
    return AtState(symbolic.motion, simplifier, symbolic.names, plain, *chosen)


def _in_numbers(symbolic: EquationForms, given: Mapping[Symbol, Expr]) -> dict[Symbol, Expr] | None:
    """The state at default parameters, omitted coordinates from closing the loops; None if impossible."""
    derivation = symbolic.derivation
    names = {("q", k): quantity.name for k, quantity in enumerate(symbolic.tree.positions)}
    if not symbolic.tree.closed or not _valued(symbolic):
        return None
    if any(e.free_symbols for e in given.values()):
        return None
    hold = {names[s]: float(e) for s, e in given.items() if s in names}
    try:
        found = derivation.assembly(hold, start=derivation.assembled.q)
    except ModelError:
        return None
    q = [sympy.Float(x) for x in found.q]
    parameters = {p.name: p.value for p in derivation.system.parameters.values() if not p.derived}
    values = _at_rest(symbolic) | {("q", k): x for k, x in enumerate(q)} | dict(given)
    return values | {("p", name): sympy.Float(x) for name, x in parameters.items()}


def _require_no_time(motion: EquationsOfMotion, who: str) -> None:
    calculus = Calculus(motion.dag)
    given = [*motion.right, *motion.rates, *motion.bias, *motion.drift, *motion.position]
    given += [*motion.loop, *motion.outputs.values(), *(x for row in motion.mass for x in row)]
    if any(("t", None) in calculus.support(x) for x in given):
        problem = f"the equations depend on the time: no point is an equilibrium; {IN_NUMBERS}"
        raise ModelError(who, problem)


def _require_no_input(symbolic: EquationForms) -> None:
    """Refuse constraints that follow inputs, as the emitted function does."""
    motion = symbolic.motion
    calculus = Calculus(motion.dag)
    for x in (*motion.position, *motion.drift):
        if any(argument == "u" for argument, _ in calculus.support(x)):
            raise ModelError(
                WHO, "there are constraints that follow inputs: prescribe no motion by them"
            )


def _at_rest(symbolic: EquationForms) -> dict[Symbol, Expr]:
    """Every state and input at rest."""
    zero = sympy.Integer(0)
    found: dict[Symbol, Expr] = dict.fromkeys(_states(symbolic), zero)
    for link in symbolic.tree.links:
        for freedom, value in zip(link.place.positions, link.joint.rest(), strict=False):
            found["q", freedom.index] += sympy.nsimplify(value)
    return found


def _given(symbolic: EquationForms, at: Mapping[Any, Any]) -> dict[Symbol, Expr]:
    """The user's values by symbol."""
    symbols = {str(e): symbol for symbol, e in _states(symbolic).items()}
    found = {}
    for name, value in at.items():
        if str(name) not in symbols:
            problem = f"is no coordinate, velocity or input; {nearest(str(name), symbols)}"
            raise ModelError(f'"{name}"', problem)
        found[symbols[str(name)]] = sympy.sympify(value, strict=True)
    return found


def _states(symbolic: EquationForms) -> dict[Symbol, Expr]:
    """The symbols of coordinates, velocities, inputs and unknowns of loops, with their expressions."""
    columns = {"q": symbolic.q, "v": symbolic.v, "u": symbolic.u}
    columns[LOOP] = [sympy.Symbol(name) for name in symbolic.names[LOOP]]
    return {(kind, k): x for kind, column in columns.items() for k, x in enumerate(column)}


def _inputs(symbolic: EquationForms) -> tuple[list[int], list[int | None]]:
    """The inputs that are not derivatives of others, and the places of their derivatives."""
    steep = symbolic.tree.layout.slopes
    own = [k for k in range(len(symbolic.u)) if k not in steep.values()]
    return own, [steep.get(k) for k in own]


def _independent(symbolic: EquationForms) -> list[int]:
    """The velocities that the emitted functions keep, if these are known."""
    chosen = symbolic.derivation.system.choices.independent
    velocities = [quantity.name for quantity in symbolic.tree.velocities]
    if chosen is not None:
        return [velocities.index(name) for name in chosen if name in velocities]
    return symbolic.derivation.assembled.independent if _valued(symbolic) else []


def _rank(symbolic: EquationForms) -> int:
    """The rank of the constraints, or 0 if it is unknown."""
    return symbolic.derivation.assembled.rank if _valued(symbolic) else 0


def _valued(symbolic: EquationForms) -> bool:
    return all(p.value is not None for p in symbolic.derivation.system.parameters.values())

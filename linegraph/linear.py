"""Linear systems in letters: those that are linear, and small deviations of those that are not."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import sympy

from linegraph.checks import nearest
from linegraph.differentiation import Calculus, Sizes
from linegraph.errors import ModelError
from linegraph.letters import Letters, Numbers
from linegraph.simplification.polynomial import Swollen
from linegraph.simplification.quotients import Singular
from linegraph.small_motions import LOOP, Freedoms, Motion, accelerations, linear, slopes
from linegraph.state_space import StateSpace
from linegraph.symbol_names import MULTIPLIERS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.differentiation import Symbol
    from linegraph.small_motions import Rows, Slopes
    from linegraph.symbols import Symbolic

Expr = Any

WHO = "linearise"
IN_NUMBERS = 'ask function("linearize") for A and B in numbers'


def state_space_of(symbolic: Symbolic) -> StateSpace:
    """A, B, C, D of a linear system; its outputs are the model's, or all states where it has none.

    Raises:
        ModelError: it is not linear, depends on the time or has a constant part, or there are constraints.
    """
    symbolic.require_open("state space")
    if symbolic.tree.network is not None:
        symbolic.tree.network.require_linear()
    motion = symbolic.motion
    names = {str(x) for x in [*symbolic.q, *symbolic.v, *symbolic.u]}
    _require_no_time(motion, "state space")
    state = _State(symbolic, motion, {})
    found = state.space(slopes(motion, moving=True), moving=True)
    rows = [(x, found.A[i, :], found.B[i, :], found.E[i, :]) for i, x in enumerate(found.states)]
    rows += [(y, found.C[i, :], found.D[i, :], found.F[i, :]) for i, y in enumerate(found.outputs)]
    for name, *parts in rows:
        used = {str(x) for part in parts for x in part.free_symbols} & names
        if used:
            problem = f"is not linear in {min(used)}: there is no state space"
            raise ModelError(f'"{name}"', problem)
    rest = _State(symbolic, motion, _everything(symbolic)).constants()
    for name, x in zip([*found.states, *found.outputs], rest, strict=True):
        if x != 0:
            problem = f"has a part ({x}) that is neither of states nor of inputs; make its source an input"
            raise ModelError(f'"{name}"', problem)
    return found


def linearise(symbolic: Symbolic, at: Mapping[Any, Any]) -> StateSpace:
    """A, B, C, D for small deviations from an equilibrium or a steady motion.

    In a tree the states are q and v. Where loops close or wheels roll they are the independent changes of
    position and velocities that the emitted ``linearize`` speaks of, and all others follow.

    Args:
        symbolic: the closed forms.
        at: values of coordinates, velocities, inputs and unknowns of algebraic loops by name or symbol,
            numbers or expressions of parameters and other letters; those left out are 0, of quaternions the
            identity.

    Raises:
        ModelError: v̇ is not 0 there, the constraints do not hold there, or the time stands in the equations.

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
    motion = symbolic.motion
    _require_no_time(motion, WHO)
    state = _State(symbolic, motion, _everything(symbolic) | _given(symbolic, at))
    state.require_kept()
    state.require_steady()
    return state.space(slopes(motion, moving=False), moving=False)


class _State:
    """A motion at a state, in letters and in numbers beside them."""

    def __init__(self, symbolic: Symbolic, motion: Motion, values: Mapping[Symbol, Expr]) -> None:
        self.symbolic, self.motion = symbolic, motion
        self.simplifier = symbolic.twin()
        for symbol, e in _states(symbolic).items():
            if symbol not in values:
                self.simplifier.define(symbol, e)
        own = set(symbolic.derivation.model.parameters)
        values = {
            symbol: e.xreplace({x: sympy.Symbol(x.name) for x in e.free_symbols if x.name in own})
            for symbol, e in values.items()
        }
        ring = self.simplifier.ring
        ring.budget = ring.work + self.simplifier.budget
        self.letters = Letters(self.simplifier, values)
        self.right = [self.letters(x) for x in motion.right]
        self.numbers = [
            Numbers(point, values, inexact=ring.inexact) for point in self.simplifier.points
        ]
        self.freedoms = self._freedoms() if motion.jacobian else _all(motion)

    def _freedoms(self) -> Freedoms:
        """The velocities and changes of position that stay, those of the emitted functions if possible."""
        motion, numbers = self.motion, self.numbers[0]
        mechanical = motion.tree.layout.mechanical
        wanted = _independent(self.symbolic)
        order = [k for k in reversed(range(mechanical)) if k not in wanted]
        order += reversed(wanted)
        J = [[numbers(x) for x in row] for row in motion.jacobian]
        rows = numbers.basis(J, order)
        position_rows = numbers.basis(J[: len(motion.position)], order)
        if len(rows) < _rank(self.symbolic):
            problem = (
                "the position is singular: more motions are free there than elsewhere, and the equations are "
                "not linear around it; linearise beside it"
            )
            raise ModelError(WHO, problem)
        dependent = {j for _, j in rows}
        own = [k for k in range(motion.size) if k not in dependent]
        moved = {j for _, j in position_rows}
        free = [k for k in range(mechanical) if k not in moved]
        return Freedoms(rows, position_rows, own, free)

    def _sizes(self, x: Any) -> Any:
        """The size of the terms that a scalar is a sum of."""
        return self.numbers[0](Sizes(Calculus(self.motion.dag))(x))

    def _vanishes(self, x: Any) -> bool:
        """Whether a scalar of the DAG is zero there."""
        return all(
            abs(value) <= numbers.zero * max(self._sizes(x), abs(value) * 0)
            for numbers in self.numbers
            for value in (numbers(x),)
        )

    def require_kept(self) -> None:
        """Refuse a state that breaks constraints.

        Raises:
            ModelError: names one.
        """
        motion = self.motion
        names = self.symbolic.names[MULTIPLIERS]
        for what, given in (("position", motion.position), ("velocity", motion.drift)):
            for name, x in zip(names, given, strict=False):
                if self._vanishes(x):
                    continue
                problem = (
                    f"the constraint of {name} does not hold there: its {what} is off by "
                    f"{self.letters.written(self.letters(x))}. Give all coordinates and velocities of a state "
                    "that keeps the constraints whatever the letters are, or give parameters numbers and "
                    + IN_NUMBERS
                )
                raise ModelError(WHO, problem)
        for name, x in zip(self.symbolic.names[LOOP], motion.loop, strict=True):
            if not self._vanishes(x):
                problem = f"the algebraic loop of {name} is not solved there; give its value, too"
                raise ModelError(WHO, problem)

    def require_steady(self) -> None:
        """Refuse a state in which something accelerates.

        Raises:
            ModelError: names it.
        """
        motion = self.motion
        advice = "Give the values of an equilibrium, those of inputs too"
        if not motion.jacobian:
            for name, x, right in zip(self.symbolic.v, self.right, motion.right, strict=True):
                if not self._vanishes(right):
                    problem = (
                        f"{name} does not stay as it is there: Q - h = {self.letters.written(x)}. {advice}"
                    )
                    raise ModelError(WHO, problem)
            return
        for numbers in self.numbers:
            found, lam = self._solved(lambda n=numbers: accelerations(motion, n, self.freedoms))
            scale = [self._sizes(x) for x in motion.right]
            for x, row in zip(lam, motion.jacobian, strict=True):
                scale = [s + abs(x * numbers(entry)) for s, entry in zip(scale, row, strict=True)]
            for i, row in enumerate(motion.mass):
                force = sum(numbers(entry) * x for entry, x in zip(row, found, strict=True))
                if abs(force) > numbers.zero * scale[i]:
                    name = self.symbolic.v[self.freedoms.own[0]] if self.freedoms.own else "it"
                    problem = f"{name} does not stay as it is there: it accelerates. {advice}"
                    raise ModelError(WHO, problem)

    def _solved(self, action: Any) -> Any:
        try:
            return action()
        except Singular:
            problem = (
                "the motion is not determined there: the mass matrix is singular on the motions that are "
                "free. Give the bodies that move mass and inertia"
            )
            raise ModelError(WHO, problem) from None
        except Swollen:
            problem = f"has too many terms for a closed form; {IN_NUMBERS}, or give some parameters numbers"
            raise ModelError(WHO, problem) from None

    def _give(self, at: Any, *, moving: bool) -> None:
        """Let accelerations and multipliers have their values."""
        motion = self.motion
        a = [at(0)] * motion.size
        if moving or motion.jacobian:
            found, lam = accelerations(motion, at, self.freedoms)
            a = found if moving else a
            for k, x in enumerate(lam):
                at.give((MULTIPLIERS, k), x)
        for k, x in enumerate(a):
            at.give(("a", k), x)

    def _matrices(self, at: Any, slopes: Slopes, *, moving: bool) -> tuple[Rows, Rows]:
        self._give(at, moving=moving)
        return linear(self.motion, slopes, at, self.freedoms)

    def space(self, slopes: Slopes, *, moving: bool) -> StateSpace:
        """The matrices, proven at random points."""
        found = self._solved(lambda: self._written(slopes, moving=moving))
        for numbers, point in zip(self.numbers, self.simplifier.points, strict=True):
            there = self._matrices(numbers, slopes, moving=moving)
            for part, values in zip(found, there, strict=True):
                for row, other in zip(part, values, strict=True):
                    self._compare(row, other, point, numbers.zero)
        symbolic = self.symbolic
        names = self._state_names()
        inputs, steep = _inputs(symbolic)
        n = len(names)
        chosen = [n + k for k in inputs]
        columns = [list(range(n)), chosen, [None if k is None else n + k for k in steep]]
        parts = [
            _picked(rows, part, n if rows is found[0] else len(self.motion.outputs))
            for rows in found
            for part in columns
        ]
        A, B, E, C, D, F = parts
        known = tuple(str(symbolic.u[k]) for k in inputs)
        outputs = tuple(self.motion.outputs)
        return StateSpace(names, known, outputs, A, B, C, D, E, F, symbolic.defaults)

    def _written(self, slopes: Slopes, *, moving: bool) -> tuple[Rows, Rows]:
        state, outputs = self._matrices(self.letters, slopes, moving=moving)
        written = self.letters.written
        return (
            [[written(x) for x in row] for row in state],
            [[written(x) for x in row] for row in outputs],
        )

    def _compare(self, row: Sequence[Expr], values: Sequence[Any], point: Any, zero: float) -> None:
        """Hold written forms against numbers."""
        scale = max((abs(x) for x in values), default=0)
        for e, x in zip(row, values, strict=True):
            if abs(point.expression(e) - x) > zero * (scale + abs(x)):
                raise AssertionError(f"{e} differs from what was derived: a bug")

    def constants(self) -> list[Expr]:
        """Rates and outputs at the state."""
        motion, at = self.motion, self.letters

        def found() -> list[Expr]:
            self._give(at, moving=True)
            rates = [at(x) for x in motion.rates]
            rates += [at(motion.dag.symbol("a", k)) for k in range(motion.size)]
            return [at.written(x) for x in (*rates, *(at(y) for y in motion.outputs.values()))]

        result: list[Expr] = self._solved(found)
        return result

    def _state_names(self) -> tuple[str, ...]:
        symbolic, motion = self.symbolic, self.motion
        if not motion.jacobian:
            return tuple(map(str, [*symbolic.q, *symbolic.v]))
        positions = {quantity.name for quantity in motion.tree.positions}
        moved = [motion.tree.velocities[k].name for k in self.freedoms.free]
        changes = [name if name in positions else f"d_{name}" for name in moved]
        return (*changes, *(str(symbolic.v[k]) for k in self.freedoms.own))


def _all(motion: Motion) -> Freedoms:
    return Freedoms([], [], list(range(motion.size)), [])


def _picked(rows: Rows, columns: Sequence[int | None], count: int) -> Expr:
    """Some columns of a matrix; those that are not there are zero."""
    entries = [[0 if k is None else row[k] for k in columns] for row in rows]
    return sympy.Matrix(count, len(columns), [x for row in entries for x in row])


def _require_no_time(motion: Motion, who: str) -> None:
    calculus = Calculus(motion.dag)
    given = [*motion.right, *motion.rates, *motion.bias, *motion.drift, *motion.position]
    given += [*motion.loop, *motion.outputs.values(), *(x for row in motion.mass for x in row)]
    if any(("t", None) in calculus.support(x) for x in given):
        problem = f"the equations depend on the time: no point is an equilibrium; {IN_NUMBERS}"
        raise ModelError(who, problem)


def _everything(symbolic: Symbolic) -> dict[Symbol, Expr]:
    """Every state and input at rest."""
    zero = sympy.Integer(0)
    found: dict[Symbol, Expr] = dict.fromkeys(_states(symbolic), zero)
    for link in symbolic.tree.links:
        for freedom, value in zip(link.place.positions, link.joint.rest(), strict=False):
            found["q", freedom.index] += sympy.nsimplify(value)
    return found


def _given(symbolic: Symbolic, at: Mapping[Any, Any]) -> dict[Symbol, Expr]:
    """What the user says."""
    symbols = {str(e): symbol for symbol, e in _states(symbolic).items()}
    found = {}
    for name, value in at.items():
        if str(name) not in symbols:
            problem = f"is no coordinate, velocity or input; {nearest(str(name), symbols)}"
            raise ModelError(f'"{name}"', problem)
        found[symbols[str(name)]] = sympy.sympify(value, strict=True)
    return found


def _states(symbolic: Symbolic) -> dict[Symbol, Expr]:
    """The symbols of coordinates, velocities, inputs and unknowns of loops, and how they are written."""
    columns = {"q": symbolic.q, "v": symbolic.v, "u": symbolic.u}
    columns[LOOP] = [sympy.Symbol(name) for name in symbolic.names[LOOP]]
    return {(kind, k): x for kind, column in columns.items() for k, x in enumerate(column)}


def _inputs(symbolic: Symbolic) -> tuple[list[int], list[int | None]]:
    """The inputs that are no derivatives of others, and the places of their derivatives."""
    places = {str(u): k for k, u in enumerate(symbolic.u)}
    steep = {k: places.get(f"{name}_rate") for name, k in places.items()}
    own = [k for k in steep if k not in set(steep.values())]
    return own, [steep[k] for k in own]


def _independent(symbolic: Symbolic) -> list[int]:
    """The velocities that the emitted functions keep, if these are known."""
    chosen = symbolic.derivation.model.choices.independent
    velocities = [quantity.name for quantity in symbolic.tree.velocities]
    if chosen is not None:
        return [velocities.index(name) for name in chosen if name in velocities]
    return symbolic.derivation.assembled.independent if _valued(symbolic) else []


def _rank(symbolic: Symbolic) -> int:
    """How many constraints are independent anywhere, as far as that is known."""
    return symbolic.derivation.assembled.rank if _valued(symbolic) else 0


def _valued(symbolic: Symbolic) -> bool:
    return all(p.value is not None for p in symbolic.derivation.model.parameters.values())


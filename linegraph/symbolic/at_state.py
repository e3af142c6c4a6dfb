"""A motion at a state given in letters: whether it is steady, and its matrices for small deviations.

Everything is calculated twice, with polynomials that have exact values and with numbers at random
points, and compared before it is used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import sympy

from linegraph.algebra.differentiation import Calculus, TermSizes
from linegraph.dynamics.symbol_names import MULTIPLIERS
from linegraph.errors import ModelError
from linegraph.symbolic.letters import Letters, Numbers
from linegraph.symbolic.simplification.generators import Swollen
from linegraph.symbolic.simplification.quotients import Singular
from linegraph.symbolic.small_motions import LOOP, Freedoms, accelerations, linear

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.symbolic.simplification import Simplifier
    from linegraph.symbolic.small_motions import EquationsOfMotion, Rows, Slopes

Expr = Any

WHO = "linearise"
IN_NUMBERS = 'ask function("linearize") for A and B in numbers'
ADVICE = "Give the values of an equilibrium, those of inputs too"


class AtState:
    """A motion at a state.

    Args:
        motion: the equations.
        simplifier: a new one, which writes the results.
        names: of all symbols, by argument.
        values: expressions for symbols; symbols without one stay as they are.
        independent: velocities to keep if there are constraints, as far as possible.
        rank: the number of independent constraints elsewhere; 0 if it is unknown.

    Raises:
        ModelError: the state is not defined, is singular or leads to too many terms.
    """

    def __init__(
        self,
        motion: EquationsOfMotion,
        simplifier: Simplifier,
        names: Mapping[str, Sequence[str]],
        values: Mapping[Symbol, Expr],
        independent: Sequence[int] = (),
        rank: int = 0,
    ) -> None:
        """Evaluate the equations at the state."""
        self.motion, self._names = motion, names
        self._simplifier = simplifier
        ring = simplifier.ring
        simplifier.start()
        self._letters = Letters(simplifier, values)
        self._checked(self._evaluate)
        self._numbers = [Numbers(point, values, ring) for point in simplifier.points]
        self._sizes = TermSizes(Calculus(motion.dag))
        self._freedoms = Freedoms([], [], list(range(motion.size)), [])
        if motion.jacobian:
            self._freedoms = self._found_freedoms(independent, rank)

    def _evaluate(self) -> None:
        """Evaluate all equations first: whether any number is a float decides on the tolerance for zero."""
        motion = self.motion
        for row in (*motion.mass, motion.right, *motion.jacobian, motion.bias, motion.drift):
            for x in row:
                self._letters(x)

    def _found_freedoms(self, independent: Sequence[int], rank: int) -> Freedoms:
        """The velocities and changes of position to keep: those of the emitted functions if possible."""
        motion, numbers = self.motion, self._numbers[0]
        mechanical = motion.tree.layout.mechanical
        order = [k for k in reversed(range(mechanical)) if k not in independent]
        order += reversed(independent)
        J = [[numbers(x) for x in row] for row in motion.jacobian]
        sizes = [max(numbers(self._sizes(x)) for x in row) for row in motion.jacobian]
        count = len(motion.position)
        rows = numbers.basis(J, sizes, order)
        position_rows = numbers.basis(J[:count], sizes[:count], order)
        if len(rows) < rank:
            problem = (
                "the position is singular: more motions are free there than elsewhere, and the equations are "
                "not linear around it; linearise beside it"
            )
            raise ModelError(WHO, problem)
        dependent, moved = {j for _, j in rows}, {j for _, j in position_rows}
        own = [k for k in range(motion.size) if k not in dependent]
        free = [k for k in range(mechanical) if k not in moved]
        return Freedoms(rows, position_rows, own, free)

    def _vanishes(self, x: Scalar) -> bool:
        """Whether a scalar of the DAG is zero at the state, relative to the terms that it is a sum of."""
        size = self._sizes(x)
        return all(abs(n(x)) <= n.zero * n(size) for n in self._numbers)

    # -- conditions

    def require_kept(self) -> None:
        """Refuse a state that violates constraints or does not solve the algebraic loop of a network.

        Raises:
            ModelError: names the first of these.
        """
        motion = self.motion
        for what, given in (("position", motion.position), ("velocity", motion.drift)):
            for name, x in zip(self._names[MULTIPLIERS], given, strict=False):
                if self._vanishes(x):
                    continue
                problem = (
                    f"the constraint of {name} does not hold there: its {what} is off by "
                    f"{self._letters.written(self._letters(x))}. Give all coordinates and velocities of a "
                    f"state that keeps the constraints whatever the parameters are, or {IN_NUMBERS}"
                )
                raise ModelError(WHO, problem)
        for name, x in zip(self._names[LOOP], motion.loop, strict=True):
            if not self._vanishes(x):
                problem = f"the algebraic loop of {name} is not solved there; give its value, too"
                raise ModelError(WHO, problem)

    def require_steady(self) -> None:
        """Refuse a state in which a velocity changes.

        Raises:
            ModelError: names the velocity.
        """
        if self.motion.jacobian:
            self._checked(self._require_balance)
            return
        for name, right in zip(self._names["v"], self.motion.right, strict=True):
            if not self._vanishes(right):
                rest = self._letters.written(self._letters(right))
                problem = f"{name} does not stay as it is there: Q - h = {rest}. {ADVICE}"
                raise ModelError(WHO, problem)

    def _require_balance(self) -> None:
        """Refuse a state in which multipliers cannot balance the applied forces."""
        motion = self.motion
        for numbers in self._numbers:
            found, lam = accelerations(motion, numbers, self._freedoms)
            scale = [numbers(self._sizes(x)) for x in motion.right]
            for x, row in zip(lam, motion.jacobian, strict=True):
                scale = [s + abs(x * numbers(entry)) for s, entry in zip(scale, row, strict=True)]
            for name, row, size in zip(self._names["v"], motion.mass, scale, strict=True):
                force = sum(numbers(entry) * x for entry, x in zip(row, found, strict=True))
                if abs(force) > numbers.zero * (size + max(scale)):
                    raise ModelError(WHO, f"{name} does not stay as it is there. {ADVICE}")

    def _checked(self, action: Callable[[], Any]) -> Any:
        try:
            return action()
        except Singular:
            problem = (
                "the motion is not determined there: the mass matrix is singular on the motions that are "
                "free. Give the bodies that move mass and inertia"
            )
            raise ModelError(WHO, problem) from None
        except Swollen:
            problem = (
                f"has too many terms for a closed form; {IN_NUMBERS}, or give parameters numbers"
            )
            raise ModelError(WHO, problem) from None

    # -- results

    def matrices(self, slopes: Slopes, *, moving: bool) -> tuple[Rows, Rows]:
        """The rows of (A B) and of (C D), with B and D for all inputs.

        Args:
            slopes: the derivatives of the motion.
            moving: whether anything accelerates.

        Raises:
            ModelError: they have too many terms, or the motion is not determined.
        """

        def linearised(at: Any) -> tuple[Rows, Rows]:
            self._give(at, moving=moving)
            return linear(self.motion, slopes, at, self._freedoms)

        def written() -> Any:
            return [
                [[self._letters.written(x) for x in row] for row in rows]
                for rows in linearised(self._letters)
            ]

        found: tuple[Rows, Rows] = self._checked(written)
        forms = [e for rows in found for row in rows for e in row]
        for numbers, point in zip(self._numbers, self._simplifier.points, strict=True):
            values = [x for rows in linearised(numbers) for row in rows for x in row]
            # random values have size 1, and so do forms: 1 is the scale if all values are small
            most = numbers.zero * (1 + max(map(abs, values), default=0))
            for e, x in zip(forms, values, strict=True):
                if abs(point.expression(e) - x) > most:
                    raise AssertionError(f"{e} differs from what was derived: a bug")
        return found

    def _give(self, at: Any, *, moving: bool) -> None:
        """Set the values of accelerations and multipliers."""
        motion = self.motion
        a = [at(0)] * motion.size
        if moving or motion.jacobian:
            found, lam = accelerations(motion, at, self._freedoms)
            a = found if moving else a
            for k, x in enumerate(lam):
                at.give((MULTIPLIERS, k), x)
        for k, x in enumerate(a):
            at.give(("a", k), x)

    def rates(self) -> list[Expr]:
        """q̇, v̇ and the outputs at the state."""
        motion, at = self.motion, self._letters

        def found() -> list[Expr]:
            self._give(at, moving=True)
            given = [*motion.rates, *(motion.dag.symbol("a", k) for k in range(motion.size))]
            return [at.written(at(x)) for x in (*given, *motion.outputs.values())]

        result: list[Expr] = self._checked(found)
        return result

    @property
    def states(self) -> tuple[str, ...]:
        """The names of the states: q and v, or with constraints the independent changes of both."""
        motion, freedoms = self.motion, self._freedoms
        if not motion.jacobian:
            return (*self._names["q"], *self._names["v"])
        positions = {quantity.name for quantity in motion.tree.positions}
        moved = [motion.tree.velocities[k].name for k in freedoms.free]
        changes = [name if name in positions else f"d_{name}" for name in moved]
        return (*changes, *(self._names["v"][k] for k in freedoms.own))


def picked(rows: Rows, columns: Sequence[int | None]) -> Expr:
    """Some columns of a matrix, in the given order.

    Args:
        rows: the matrix.
        columns: the places of the columns; None gives a column of zeros.
    """
    entries = [0 if k is None else row[k] for row in rows for k in columns]
    return sympy.Matrix(len(rows), len(columns), entries)

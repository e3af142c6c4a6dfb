"""Small deviations from a state: the equations of motion, their derivatives, and A, B, C, D from these.

With small changes of position d, of velocity dv and of inputs du, and ``r = M a + h - Q - Jᵀ lam``,

    M da - Jᵀ dlam + ∂r/∂z dz = -∂r        J da = -∂(J a - gam)        ∂F/∂z dz = -∂F

where F(z) = 0 is an algebraic loop of a network. In a tree, d are changes of q itself. With closed
loops or rolling wheels they go along the velocities (`tangent_space`) and satisfy the constraints:

    d = D ds        dv = T dw + S ds        J S = -∂(J v - b) D

with as many s and w as there are freedoms. All of it is derived over the DAG, and solved here over any
scalars with linear equations: polynomials with exact values, and numbers to compare with.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from linegraph.algebra.differentiation import Calculus
from linegraph.dynamics.symbol_names import MULTIPLIERS
from linegraph.kinematics import tangent_space as tangent

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.differentiation import Gradient, Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.equations import StateEquations
    from linegraph.ir.dag import Dag
    from linegraph.kinematics.links import KinematicTree

Rows = list[list[Any]]
"""A matrix of scalars."""

Solution = tuple[Rows, Rows]

LOOP = "loop"


class Calculator(Protocol):
    """Values of scalars of the DAG at a state, and linear equations between them."""

    def __call__(self, x: Scalar) -> Any:
        """The value of a scalar of the DAG."""

    def give(self, symbol: Symbol, value: Any) -> None:
        """Set the value of a symbol for all later evaluations.

        Args:
            symbol: its argument and place.
            value: a scalar of the calculator.
        """

    def solve(self, rows: Rows, rights: Rows, through: Rows = ..., direct: Rows = ...) -> Solution:
        """X of ``rows X = rights``, and ``through X + direct``.

        Args:
            rows: a square matrix.
            rights: the right-hand sides, as columns of a matrix.
            through: rows that multiply X.
            direct: rows that are added to the products.
        """


@dataclass(frozen=True)
class EquationsOfMotion:
    """The equations of motion over a DAG, with symbols a for v̇, lam for λ, loop for unknowns of loops.

    Attributes:
        tree: has the layout of the state.
        dag: of all scalars.
        mass: M.
        right: Q - h.
        rates: q̇.
        jacobian, bias, drift: J, gam and J v - b; empty without constraints.
        position: φ.
        loop: residuals of the algebraic loop of a network.
        outputs: the outputs, by name.
        inputs: the number of inputs.
    """

    tree: KinematicTree
    dag: Dag
    mass: Rows
    right: list[Scalar]
    rates: list[Scalar]
    jacobian: Rows
    bias: list[Scalar]
    drift: list[Scalar]
    position: list[Scalar]
    loop: list[Scalar]
    outputs: dict[str, Scalar]
    inputs: int

    @classmethod
    def of(cls, found: StateEquations, dag: Dag, **others: Any) -> EquationsOfMotion:
        """The equations of a composition, with constraints if there are any.

        Args:
            found: the equations at a state in symbols.
            dag: of all scalars.
            others: the remaining attributes.
        """
        given: tuple[Any, ...] = ([], [], [], [])
        mass, rates = found.mass_matrix, found.coordinate_rates
        if found.tree.closed:
            given = (
                found.jacobian,
                found.constraint_bias,
                found.constraint_rates,
                found.constraints,
            )
        names = ("jacobian", "bias", "drift", "position")
        known = dict(zip(names, given, strict=True))
        return cls(found.tree, dag, mass=mass, rates=rates, **known, **others)

    @property
    def size(self) -> int:
        """The number of velocities."""
        return len(self.mass)

    def acting(self, moving: bool) -> list[Scalar]:
        """Residuals M a + h - Q - Jᵀ lam, without M a if nothing accelerates."""
        lam = [self.dag.symbol(MULTIPLIERS, k) for k in range(len(self.jacobian))]
        a = [self.dag.symbol("a", k) for k in range(self.size)] if moving else []
        found = []
        for i, right in enumerate(self.right):
            total = -right
            for x, entry in zip(a, self.mass[i], strict=False):
                total = total + entry * x
            for x, row in zip(lam, self.jacobian, strict=True):
                total = total - row[i] * x
            found.append(total)
        return found


@dataclass(frozen=True)
class Freedoms:
    """Velocities and changes of position that determine the others under constraints.

    Attributes:
        rows: independent constraints of J, each with a velocity that it determines.
        position_rows: the same for holonomic constraints and changes of position.
        own, free: the remaining velocities and changes of position.
    """

    rows: list[tuple[int, int]]
    position_rows: list[tuple[int, int]]
    own: list[int]
    free: list[int]


@dataclass(frozen=True)
class Slopes:
    """The derivatives of a motion; columns: changes of position, velocities, inputs, unknowns of loops.

    Attributes:
        motion: of the residuals M a + h - Q - Jᵀ lam.
        bias: of the residuals J a - gam.
        drift: of J v - b.
        rates: of q̇; empty with constraints.
        loop: of the residuals of algebraic loops.
        outputs: of the outputs.
        by_solution: of the outputs by a and lam.
        adjoint: ad v of ḋ = dv - (ad v) d; empty without constraints.
    """

    motion: Rows
    bias: Rows
    drift: Rows
    rates: Rows
    loop: Rows
    outputs: Rows
    by_solution: Rows
    adjoint: Rows


def slopes(motion: EquationsOfMotion, *, moving: bool) -> Slopes:
    """The derivatives of the equations of motion.

    Args:
        motion: the equations.
        moving: whether anything accelerates at the state.

    Raises:
        ModelError: a function has no derivative.
    """
    tree, dag = motion.tree, motion.dag
    closed = bool(motion.jacobian)
    chain: dict[Symbol, Gradient] = {}
    changes: list[Symbol] = [("q", k) for k in range(len(motion.rates))]
    if closed:
        q = [dag.symbol("q", k) for k in range(len(motion.rates))]
        chain, changes = tangent.chain(tree, q), tangent.changes(tree)
    fixed = ("p", "t", "a", MULTIPLIERS)
    calculus = Calculus(dag, fixed, chain)
    velocities: list[Symbol] = [("v", k) for k in range(motion.size)]
    inputs: list[Symbol] = [("u", k) for k in range(motion.inputs)]
    loop: list[Symbol] = [(LOOP, k) for k in range(len(motion.loop))]
    by = [*changes, *velocities, *inputs, *loop]

    def rows(given: Sequence[Scalar], by: Sequence[Symbol] = by) -> Rows:
        return [[calculus.gradient(x).get(symbol, 0) for symbol in by] for x in given]

    a = [dag.symbol("a", k) for k in range(motion.size)]
    missed = []
    for row, gam in zip(motion.jacobian, motion.bias, strict=True):
        products = (entry * x for entry, x in zip(row, a, strict=True)) if moving else ()
        missed.append(sum(products, start=0) - gam)
    results = list(motion.outputs.values())
    solution: list[Symbol] = [("a", k) for k in range(motion.size)]
    solution += [(MULTIPLIERS, k) for k in range(len(motion.jacobian))]
    by_solution = Calculus(dag, ("p", "t", "q", "v", "u", LOOP))
    v = [dag.symbol("v", k) for k in range(motion.size)]
    return Slopes(
        rows(motion.acting(moving)),
        rows(missed),
        rows(motion.drift),
        [] if closed else rows(motion.rates),
        rows(motion.loop),
        rows(results),
        [[by_solution.gradient(x).get(symbol, 0) for symbol in solution] for x in results],
        tangent.adjoint(tree, v) if closed else [],
    )


def accelerations(
    motion: EquationsOfMotion, at: Calculator, freedoms: Freedoms
) -> tuple[list[Any], list[Any]]:
    """v̇ and λ at a state; λ of redundant constraints is zero.

    Args:
        motion: the equations.
        at: the state.
        freedoms: which constraints are independent.
    """
    kept = [i for i, _ in freedoms.rows]
    right = [[at(x)] for x in motion.right]
    right += [[at(motion.bias[i])] for i in kept]
    found = [x for (x,) in at.solve(_saddle(motion, at, kept), right)[0]]
    lam = [at(0)] * len(motion.jacobian)
    for i, x in zip(kept, found[motion.size :], strict=True):
        lam[i] = x
    return found[: motion.size], lam


def linear(
    motion: EquationsOfMotion, slopes: Slopes, at: Calculator, freedoms: Freedoms
) -> tuple[Rows, Rows]:
    """The rows of (A B) and of (C D).

    Args:
        motion: the equations.
        slopes: their derivatives.
        at: the state, with values of a and lam.
        freedoms: which changes are independent.
    """
    n = motion.size
    kept = [i for i, _ in freedoms.rows]
    moved, turning = _allowed(motion, slopes, at, freedoms)
    by = len(moved) or len(motion.rates) + n + motion.inputs

    def along(rows: Rows) -> tuple[Rows, Rows]:
        """Derivatives by the independent changes, and by the unknowns of loops."""
        values = _at(at, rows)
        direct = [row[:by] for row in values]
        return _product(direct, moved) if moved else direct, [row[by:] for row in values]

    (force, force_z), (bias, bias_z), (residue, residue_z) = map(
        along, (slopes.motion, [slopes.bias[i] for i in kept], slopes.loop)
    )
    whole = _saddle(motion, at, kept)
    zero = at(0)
    rows = [row + z for row, z in zip(whole, [*force_z, *bias_z], strict=True)]
    rows += [[zero] * len(whole) + z for z in residue_z]
    rights = [[-x for x in row] for row in (*force, *bias, *residue)]
    direct, direct_z = along(slopes.outputs)
    solution = [*range(n), *(n + i for i in kept)]
    through = [
        [row[k] for k in solution] + z
        for row, z in zip(_at(at, slopes.by_solution), direct_z, strict=True)
    ]
    found, outputs = at.solve(rows, rights, through, direct)
    above = turning if motion.jacobian else along(slopes.rates)[0]
    return above + [found[k] for k in freedoms.own], outputs


def _allowed(
    motion: EquationsOfMotion, slopes: Slopes, at: Calculator, freedoms: Freedoms
) -> tuple[Rows, Rows]:
    """(d, dv, du) by (ds, dw, du), and the rates of s by the same; empty without constraints."""
    n, mechanical = motion.size, motion.tree.layout.mechanical
    zero, one = at(0), at(1)
    if not motion.jacobian:
        return [], []
    free, own = freedoms.free, freedoms.own
    count = len(free) + len(own) + motion.inputs

    def unit(k: int) -> list[Any]:
        return [one if k == j else zero for j in range(count)]

    jacobian = _at(at, motion.jacobian)
    rows, rights = [], []
    for i, _ in freedoms.position_rows:
        rows.append(jacobian[i][:mechanical])
        rights.append([zero] * count)
    for j, k in enumerate(free):
        rows.append([one if k == c else zero for c in range(mechanical)])
        rights.append(unit(j))
    changes, _ = at.solve(rows, rights)
    drift = _product([row[:mechanical] for row in _at(at, slopes.drift)], changes)
    rows, rights = [], []
    for i, _ in freedoms.rows:
        rows.append(jacobian[i])
        rights.append([-x for x in drift[i]] if drift[i] else [zero] * count)
    for j, k in enumerate(own):
        rows.append([one if k == c else zero for c in range(n)])
        rights.append(unit(len(free) + j))
    velocities, _ = at.solve(rows, rights)
    inputs = [unit(len(free) + len(own) + k) for k in range(motion.inputs)]
    turned = _product(_at(at, slopes.adjoint), changes)
    going = [[x - y for x, y in zip(velocities[k], turned[k], strict=True)] for k in free]
    return [*changes, *velocities, *inputs], going


def _saddle(motion: EquationsOfMotion, at: Calculator, kept: Sequence[int]) -> Rows:
    """M and the independent rows of J in one matrix: (M -Jᵀ; J 0)."""
    mass, jacobian = _at(at, motion.mass), [[at(x) for x in motion.jacobian[i]] for i in kept]
    zero = at(0)
    above = [[*row, *(-j[i] for j in jacobian)] for i, row in enumerate(mass)]
    return above + [[*row, *([zero] * len(kept))] for row in jacobian]


def _at(at: Calculator, rows: Rows) -> Rows:
    return [[at(x) for x in row] for row in rows]


def _product(left: Rows, right: Rows) -> Rows:
    """A product of matrices without the products of zeros."""
    found = []
    for row in left:
        used = [(x, other) for x, other in zip(row, right, strict=True) if not _is_zero(x)]
        width = len(right[0]) if right else 0
        total = []
        for k in range(width):
            terms = [x * other[k] for x, other in used if not _is_zero(other[k])]
            zero = row[0] * 0
            total.append(sum(terms[1:], start=terms[0]) if terms else zero)
        found.append(total)
    return found


def _is_zero(x: Any) -> bool:
    terms = getattr(x, "terms", None)
    return not terms if terms is not None else bool(x == 0)

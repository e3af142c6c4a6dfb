"""Closed forms: the equations of a derivation as SymPy expressions."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import sympy

from linegraph.algebra.sympy_scalars import Expr, Sympy
from linegraph.components.parameters import valued
from linegraph.components.validation import nearest
from linegraph.dynamics import orthogonality
from linegraph.dynamics.equations import StateEquations
from linegraph.dynamics.mass_matrix import mass_matrix
from linegraph.dynamics.symbol_names import MULTIPLIERS
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag
from linegraph.kinematics.tree_state import TreeState
from linegraph.notation.notation import Notation
from linegraph.paper.joint_form import PaperMatrices, paper_matrices
from linegraph.paper.star_form import printed_matrices
from linegraph.symbolic.coriolis import coriolis_matrix, gradient_along
from linegraph.symbolic.equation_list import Equations
from linegraph.symbolic.simplification import BUDGET, Simplifier
from linegraph.symbolic.small_motions import EquationsOfMotion

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.links import KinematicTree
    from linegraph.numeric.derived import Derived
    from linegraph.paper.star_tree import PrintedMatrices


class EquationForms:
    """A derivation's equations as SymPy objects, in closed form.

    Coordinates are written as the joints' names; velocities as ``name_dot``, or under their own names
    (``root_wx``) if v is not the derivative of q; accelerations as ``a_name``, efforts as ``u_name``.
    `symbol_names` lists replacements for names that are taken. Everything is derived when it is first
    needed.

    Attributes:
        q, v, a, u: column matrices of symbols; `multipliers` are λ.
        names: of all symbols, by argument.
        simplifier: writes the closed forms.
    """

    def __init__(
        self,
        derivation: Derived,
        level: str = "full",
        budget: int = BUDGET,
        progress: Callable[[str], None] | None = None,
    ) -> None:
        """Derive over a DAG, to be written as SymPy expressions.

        Args:
            derivation: the system with its trees.
            level: none, fast or full; see `simplification`.
            budget: the number of products of terms that one quantity may take.
            progress: called with the quantity that is being simplified.
        """
        self.derivation = derivation
        self._model = derivation.system
        self.names = derivation.symbol_names
        self._sympy = Sympy(self.names)
        self.dag = Dag()
        self.tree: KinematicTree = derivation.tree(self.dag, self._valued(self.dag))
        units = [[("q", place) for place in unit] for unit in self.tree.quaternions]
        self.simplifier = Simplifier(
            lambda symbol: self._sympy.symbol(*symbol), level, budget, progress, units
        )
        self.q, self.v, self.a, self.u, self.multipliers = map(
            self._column, ("q", "v", "a", "u", MULTIPLIERS)
        )

    def _valued(self, algebra: Any) -> dict[str, Scalar]:
        declared = self._model.parameters.values()
        return valued(declared, algebra, lambda p: algebra.symbol("p", p.name))

    def _column(self, argument: str) -> Expr:
        names = self.names[argument]
        return sympy.Matrix(len(names), 1, [sympy.Symbol(name) for name in names])

    def _of_dag(self, argument: str) -> tuple[Scalar, ...]:
        return tuple(self.dag.symbol(argument, k) for k in range(len(self.names[argument])))

    @cached_property
    def _derived(self) -> StateEquations:
        """The equations over the DAG, with v̇ and λ as symbols."""
        q, v = self._of_dag("q"), self._of_dag("v")
        return StateEquations(
            self.tree, q, v, solution=lambda: (self._of_dag("a"), self._of_dag(MULTIPLIERS))
        )

    def _matrix(self, what: str, rows: Sequence[Sequence[Scalar]], columns: int = 1) -> Expr:
        """The closed forms of a matrix."""
        found = self.simplifier.all([x for row in rows for x in row], what)
        return sympy.Matrix(len(rows), columns, found)

    def _closed_column(self, what: str, entries: Iterable[Scalar]) -> Expr:
        return self._matrix(what, [[x] for x in entries])

    # -- the equations of motion

    @cached_property
    def mass_matrix(self) -> Expr:
        """Mass matrix M(q), n x n."""
        return self._matrix("mass matrix", self._derived.mass_matrix, len(self.v))

    @cached_property
    def bias(self) -> Expr:
        """Bias h(q, v), a column."""
        return self._closed_column("bias", self._derived.bias)

    @cached_property
    def forces(self) -> Expr:
        """Q(q, v, u), a column: efforts, and elements and loads that inputs drive."""
        return self._closed_column("forces", self._derived.forces)

    def equations(self) -> Equations:
        """The equations of motion, row by row: M v̇ + h = Q + Jᵀ λ, and those of constraints, J v̇ = γ.

        Rows of constraints that read 0 = 0 are left out.
        """
        left, right = self.mass_matrix * self.a + self.bias, self.forces
        if self.tree.closed:
            right += self.constraint_jacobian.T * self.multipliers
            rows = zip(self.constraint_jacobian * self.a, self.constraint_bias, strict=True)
            said = [row for row in rows if any(side != 0 for side in row)]
            left = [*left, *(row[0] for row in said)]
            right = [*right, *(row[1] for row in said)]
        return Equations(left, right, Notation(self.derivation))

    @cached_property
    def coriolis_matrix(self) -> Expr:
        """C(q, v) of the bodies: ``C v`` is the part of h quadratic in v, and ``Ṁ - 2C`` is skew.

        Entries for states of networks are zero.
        """
        size = self.tree.layout.mechanical
        state = self._derived.state
        mass = [row[:size] for row in mass_matrix(state)[:size]]
        bias = orthogonality.inverse_dynamics(state)[:size]
        rows = coriolis_matrix(self.dag, mass, bias, state.coordinate_rates)
        found = sympy.zeros(len(self.v))
        found[:size, :size] = self._matrix("Coriolis matrix", rows, size)
        return found

    @cached_property
    def gravity(self) -> Expr:
        """g(q), a column: the part of h from weight, the gradient of its potential."""
        state = self._derived.state
        _, potential = orthogonality.energy(state)
        rows = gradient_along(self.dag, potential, state.coordinate_rates, len(self.v))
        return self._closed_column("gravity", rows)

    @cached_property
    def coordinate_rates(self) -> Expr:
        """Rates of the coordinates q̇ = N(q) v, a column."""
        return self._closed_column("coordinate rates", self._derived.coordinate_rates)

    @cached_property
    def rates(self) -> Expr:
        """Accelerations v̇ = M⁻¹ (Q - h), a column: for small systems, and for networks.

        Raises:
            ModelError: there are constraints.
        """
        self.require_open("rates")
        right = self.forces - self.bias
        return self.mass_matrix.LUsolve(right).applyfunc(sympy.simplify)

    def require_open(self, what: str) -> None:
        """Refuse a quantity that constraints or a singular mass matrix do not allow."""
        if self.tree.closed:
            raise ModelError(what, "there are constraints; their multipliers have no closed form")
        self.derivation.require_inverse(what)

    @cached_property
    def energy(self) -> tuple[Expr, ...]:
        """Kinetic and potential energy (J), springs included; then the networks' energy, if there are any."""
        return tuple(self.simplifier.all(self._derived.energy, "energy"))

    @property
    def kinetic_energy(self) -> Expr:
        """Kinetic energy of the bodies, ½ vᵀ M v plus terms of prescribed motions (J)."""
        return self.energy[0]

    @property
    def potential_energy(self) -> Expr:
        """Potential energy of weight and springs (J)."""
        return self.energy[1]

    @cached_property
    def outputs(self) -> dict[str, Expr]:
        """The model's outputs, by name; accelerations in them are replaced by their solution."""
        names, known = list(self._observed), set(self.a)
        expressions = self.simplifier.all(self._observed.values(), "outputs")
        if any(x.free_symbols & known for x in expressions):
            solved = dict(zip(self.a, self.rates, strict=True))
            expressions = [sympy.simplify(x.subs(solved)) for x in expressions]
        return dict(zip(names, expressions, strict=True))

    @property
    def defaults(self) -> dict[str, float]:
        """The default values of the parameters, by name."""
        return {
            p.name: float(p.value)
            for p in self._model.parameters.values()
            if p.value is not None and not p.derived
        }

    # -- constraints and edges

    @cached_property
    def constraints(self) -> Expr:
        """Residuals φ(q), a column: zero if all loops are closed."""
        return self._closed_column("constraints", self._derived.constraints)

    @cached_property
    def constraint_jacobian(self) -> Expr:
        """J(q), constraints x velocities; `multipliers` has the multiplier of each row."""
        return self._matrix("constraint Jacobian", self._derived.jacobian, len(self.v))

    @cached_property
    def constraint_bias(self) -> Expr:
        """Right-hand side γ of J v̇ = γ, a column."""
        return self._closed_column("constraint bias", self._derived.constraint_bias)

    def reaction(self, joint: str) -> tuple[Expr, Expr]:
        """Force and torque of a joint on its head, about the head's origin, with v̇ as symbols ``a_name``.

        They are resolved in the axes of `Choices.reactions`; with loops, λ are the symbols
        `multipliers`.

        Raises:
            ModelError: there is no such joint or constraint.
        """
        if joint not in self.tree.ends:
            raise ModelError(f'joint "{joint}"', f"is not there; {nearest(joint, self.tree.ends)}")
        return self._both(f"reaction of {joint}", *self._derived.edges.reaction(joint))

    def across(self, edge: str) -> tuple[Expr, Expr]:
        """Velocity and angular velocity across an edge, in ground axes.

        Raises:
            ModelError: there is no such edge.
        """
        found = self._derived.edges.across()
        if edge not in found:
            raise ModelError(f'edge "{edge}"', f"is not there; {nearest(edge, found)}")
        return self._both(f"motion across {edge}", *found[edge])

    def _both(
        self, what: str, linear: Sequence[Scalar], angular: Sequence[Scalar]
    ) -> tuple[Expr, Expr]:
        entries = self.simplifier.all([*linear, *angular], what)
        return sympy.Matrix(entries[:3]), sympy.Matrix(entries[3:])

    # -- sources

    @cached_property
    def _observed(self) -> dict[str, Scalar]:
        """The model's outputs over the DAG, by name."""
        found, _ = self._derived.outputs
        return dict(zip((output.name for output in self._model.outputs), found, strict=True))

    @cached_property
    def motion(self) -> EquationsOfMotion:
        """The equations over the DAG, in the form in which they are linearised."""
        of = self._derived
        state, exchange = of.state, of.networks
        return EquationsOfMotion.of(
            of,
            self.dag,
            right=[effort - h for effort, h in zip(of.forces, of.bias, strict=True)],
            loop=[] if exchange is None else exchange.algebraic_loop(),
            outputs=self._observed
            or dict(zip(map(str, [*self.q, *self.v]), [*state.q, *state.v], strict=True)),
            inputs=len(self.u),
        )

    # -- the paper's matrices

    @cached_property
    def _sympy_tree(self) -> KinematicTree:
        return self.derivation.tree(self._sympy, self._valued(self._sympy))

    @cached_property
    def paper_matrices(self) -> PaperMatrices:
        """P, H, C, S, K and the literal (13)-(15) of the paper, over SymPy, not simplified."""
        return paper_matrices(TreeState(self._sympy_tree, self.q, self.v))

    @cached_property
    def printed_matrices(self) -> PrintedMatrices:
        """All matrices of the paper in its own form of 2n - 1 chords, over SymPy, not simplified."""
        return printed_matrices(TreeState(self._sympy_tree, self.q, self.v))

    def __repr__(self) -> str:
        """The name of the model and the level of simplification."""
        return f"<closed forms of {self._model.name}, level {self.simplifier.level}>"

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
    """A derivation's equations as sympy objects, in closed form.

    Coordinates are written as the joints' names; velocities as ``name_dot``, or by their own names
    (``root_wx``) where v is not the derivative of q; accelerations as ``a_name``, efforts as ``u_name``.
    `symbol_names` says what they are called where something else has such a name. Everything is derived when
    it is first asked for.

    Attributes:
        q, v, a, u: column matrices of symbols; `multipliers` are λ.
        names: of all symbols, by argument.
        simplifier: what writes the closed forms.
    """

    def __init__(
        self,
        derivation: Derived,
        level: str = "full",
        budget: int = BUDGET,
        progress: Callable[[str], None] | None = None,
    ) -> None:
        """Derive over a DAG, to be written as sympy expressions.

        Args:
            derivation: of what.
            level: none, fast or full; see `simplification`.
            budget: how many products of terms a quantity may take.
            progress: told what is being simplified.
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
        """M(q) as a sympy Matrix."""
        return self._matrix("mass matrix", self._derived.mass_matrix, len(self.v))

    @cached_property
    def bias(self) -> Expr:
        """h(q, v) as a sympy column Matrix."""
        return self._closed_column("bias", self._derived.bias)

    @cached_property
    def forces(self) -> Expr:
        """Q(q, v, u) as a sympy column Matrix: efforts, and all that inputs drive."""
        return self._closed_column("forces", self._derived.forces)

    def equations(self) -> Equations:
        """The equations of motion, row by row: M v̇ + h = Q + J^T λ, and of constraints J v̇ = γ.

        Rows of constraints that say nothing, 0 = 0, are left out.
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
        """C(q, v) of the bodies: ``C v`` is what of h is quadratic in v, and ``Ṁ - 2C`` is skew.

        Entries of networks' states are zero.
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
        """g(q) as a column Matrix: what of h weight makes, the gradient of its potential."""
        state = self._derived.state
        _, potential = orthogonality.energy(state)
        rows = gradient_along(self.dag, potential, state.coordinate_rates, len(self.v))
        return self._closed_column("gravity", rows)

    @cached_property
    def coordinate_rates(self) -> Expr:
        """q̇ = N(q) v as a column Matrix."""
        return self._closed_column("coordinate rates", self._derived.coordinate_rates)

    @cached_property
    def rates(self) -> Expr:
        """v̇ = M⁻¹ (Q - h) as a sympy column Matrix: for small systems, and those of networks.

        Raises:
            ModelError: there are constraints.
        """
        self.require_open("rates")
        right = self.forces - self.bias
        return self.mass_matrix.LUsolve(right).applyfunc(sympy.simplify)

    def require_open(self, what: str) -> None:
        """Refuse what constraints or a singular mass matrix do not allow."""
        if self.tree.closed:
            raise ModelError(what, "there are constraints; their multipliers have no closed form")
        self.derivation.require_inverse(what)

    @cached_property
    def energy(self) -> tuple[Expr, ...]:
        """Kinetic and potential energy, that of springs included; then what networks store, if any."""
        return tuple(self.simplifier.all(self._derived.energy, "energy"))

    @property
    def kinetic_energy(self) -> Expr:
        """½ v^T M v of the bodies, and what prescribed motions add."""
        return self.energy[0]

    @property
    def potential_energy(self) -> Expr:
        """The potential energy of weight and springs."""
        return self.energy[1]

    @cached_property
    def outputs(self) -> dict[str, Expr]:
        """What the model asks for by name; what depends on v̇ has it put in."""
        names, known = list(self._observed), set(self.a)
        expressions = self.simplifier.all(self._observed.values(), "outputs")
        if any(x.free_symbols & known for x in expressions):
            solved = dict(zip(self.a, self.rates, strict=True))
            expressions = [sympy.simplify(x.subs(solved)) for x in expressions]
        return dict(zip(names, expressions, strict=True))

    @property
    def defaults(self) -> dict[str, float]:
        """The parameters' own values."""
        return {
            p.name: float(p.value)
            for p in self._model.parameters.values()
            if p.value is not None and not p.derived
        }

    # -- constraints and edges

    @cached_property
    def constraints(self) -> Expr:
        """φ(q) as a column Matrix: zero where all loops are closed."""
        return self._closed_column("constraints", self._derived.constraints)

    @cached_property
    def constraint_jacobian(self) -> Expr:
        """J(q), constraints x velocities; the multipliers' names are in `multipliers`."""
        return self._matrix("constraint Jacobian", self._derived.jacobian, len(self.v))

    @cached_property
    def constraint_bias(self) -> Expr:
        """γ of J v̇ = γ as a column Matrix."""
        return self._closed_column("constraint bias", self._derived.constraint_bias)

    def reaction(self, joint: str) -> tuple[Expr, Expr]:
        """Force and torque that a joint exerts on its head, one edge alone, v̇ as symbols ``a_name``.

        Resolved as `Choices.reactions` says, about the head's origin; with loops λ are `multipliers`.

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

    # -- what they are made of

    @cached_property
    def _observed(self) -> dict[str, Scalar]:
        """The outputs that the model names."""
        found, _ = self._derived.outputs
        return dict(zip((output.name for output in self._model.outputs), found, strict=True))

    @cached_property
    def motion(self) -> EquationsOfMotion:
        """The equations over the DAG, as they are linearised."""
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
        """P, H, C, S, K and the literal (13)-(15) of the paper, over sympy and not simplified."""
        return paper_matrices(TreeState(self._sympy_tree, self.q, self.v))

    @cached_property
    def printed_matrices(self) -> PrintedMatrices:
        """All matrices of the paper in its own form of 2n - 1 chords, over sympy and not simplified."""
        return printed_matrices(TreeState(self._sympy_tree, self.q, self.v))

    def __repr__(self) -> str:
        """What it is of, and how far it is simplified."""
        return f"<closed forms of {self._model.name}, level {self.simplifier.level}>"

"""sympy, the face: closed forms for people, and user expressions coming in."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import sympy

from linegraph import orthogonality
from linegraph.checks import nearest
from linegraph.closure import Chords, equations
from linegraph.errors import ModelError
from linegraph.inverse_scheme import InverseScheme
from linegraph.loads import Applied, applied, efforts
from linegraph.observation import observed
from linegraph.paper import PaperMatrices, paper_matrices
from linegraph.paper_print import PrintedMatrices, printed_matrices
from linegraph.parameters import valued
from linegraph.scope import relations
from linegraph.state_space import StateSpace, state_space
from linegraph.sympy_walk import Expr, Sympy, evaluate, to_sympy
from linegraph.united import exchange_at, network_entries, united_mass_matrix

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.derive import Derivation
    from linegraph.exchange import Exchange
    from linegraph.kinematics import KinematicTree


class Symbolic:
    """A derivation's equations as sympy objects.

    Coordinates are written as the joints' names; velocities as ``name_dot``, or by their own names
    (``root_wx``) where v is not the derivative of q.

    Attributes:
        q, v, u: column matrices of symbols.
    """

    def __init__(self, derivation: Derivation) -> None:
        """Derive over sympy; nothing is simplified until asked for."""
        self._derivation = derivation
        self._model = derivation.model
        positions, rates, inputs = _names(derivation.structure, derivation.model.parameters)
        network = derivation.formulation.network
        loop = () if network is None else network.loop_names
        self.algebra = Sympy({"q": positions, "v": rates, "u": inputs, "loop": loop})
        declared = derivation.model.parameters.values()
        self._parameters = valued(declared, self.algebra, lambda p: sympy.Symbol(p.name))
        self.tree: KinematicTree = derivation.tree(self.algebra, self._parameters)
        self.u = sympy.Matrix([sympy.Symbol(name) for name in inputs])
        self.q = sympy.Matrix([sympy.Symbol(name) for name in positions])
        self.v = sympy.Matrix([sympy.Symbol(name) for name in rates])

    @cached_property
    def _arms(self) -> list[orthogonality.Arm]:
        return orthogonality.arms(self.tree, self.algebra, list(self.q), list(self.v))

    @cached_property
    def mass_matrix(self) -> Expr:
        """M(q) as a sympy Matrix, simplified entry by entry."""
        entries = network_entries(self._exchange, self.algebra)
        rows = united_mass_matrix(self.tree, self.algebra, self._arms, entries)
        return sympy.Matrix(rows).applyfunc(simplified)

    @cached_property
    def bias(self) -> Expr:
        """h(q, v) as a sympy column Matrix, simplified entry by entry."""
        rows = orthogonality.inverse_dynamics(
            self.tree, self.algebra, self._arms, applied=self._applied
        )
        return sympy.Matrix(rows).applyfunc(simplified)

    @cached_property
    def forces(self) -> Expr:
        """Q(q, v, u) as a sympy column Matrix: efforts, and all that inputs drive."""
        acting = self._acted(driven=True)
        active = orthogonality.generalised_forces(self.tree, self.algebra, self._arms, acting)
        found = efforts(self.tree, self.algebra, self._chords, active)
        return sympy.Matrix(found).applyfunc(simplified)

    @cached_property
    def rates(self) -> Expr:
        """v̇ = M⁻¹ (Q - h) as a sympy column Matrix: for small systems, and those of networks.

        Raises:
            ModelError: there are constraints.
        """
        if self.tree.closed:
            raise ModelError(
                "rates", "there are constraints; their multipliers have no closed form"
            )
        rows = united_mass_matrix(
            self.tree, self.algebra, self._arms, network_entries(self._exchange, self.algebra)
        )
        right = self.forces - self.bias
        return sympy.Matrix(rows).LUsolve(right).applyfunc(sympy.simplify)

    @cached_property
    def outputs(self) -> dict[str, Expr]:
        """What the model asks for by name; what depends on v̇ has it put in."""
        state = (tuple(self.q), tuple(self.v))
        found, _ = observed(
            self._model,
            self.tree,
            self.algebra,
            self._parameters,
            self._chords,
            state,
            self._scheme,
        )
        names = [output.name for output in self._model.outputs]
        known = set(self.a)
        expressions = [sympy.sympify(x, strict=True) for x in found]
        if any(x.free_symbols & known for x in expressions):
            solved = dict(zip(self.a, self.rates, strict=True))
            expressions = [x.subs(solved) for x in expressions]
        return dict(zip(names, map(sympy.simplify, expressions), strict=True))

    @cached_property
    def state_space(self) -> StateSpace:
        """A, B, C, D of a linear system; its outputs are the model's, or all states where it has none.

        Raises:
            ModelError: it is not linear.
        """
        if self.tree.network is not None:
            self.tree.network.require_linear()
        steep = {u: sympy.Symbol(f"{u}_rate") for u in self.u}
        slopes = {u: rate for u, rate in steep.items() if rate in set(self.u)}
        inputs = [u for u in self.u if u not in slopes.values()]
        states = [*self.q, *self.v]
        outputs = self.outputs or {str(x): x for x in states}
        defaults = {
            p.name: float(p.value)
            for p in self._model.parameters.values()
            if p.value is not None and not p.derived
        }
        velocities = orthogonality.coordinate_rates(
            self.tree, self.algebra, list(self.q), list(self.v)
        )
        return state_space(states, [*velocities, *self.rates], inputs, slopes, outputs, defaults)

    @cached_property
    def _exchange(self) -> Exchange | None:
        """The networks."""
        chords = Chords(self.tree, self.algebra, self._arms, self._parameters)
        state = (tuple(self.q), tuple(self.v))
        return exchange_at(self._model, self.tree, self.algebra, self._parameters, chords, state)

    @cached_property
    def constraints(self) -> Expr:
        """φ(q) as a column Matrix: zero where all loops are closed."""
        return sympy.Matrix(self._chords.position()).applyfunc(simplified)

    @cached_property
    def constraint_jacobian(self) -> Expr:
        """J(q), constraints x velocities; the multipliers' names are in `multipliers`."""
        rows = self._chords.jacobian()
        return sympy.Matrix(len(rows), len(self.v), [x for row in rows for x in row]).applyfunc(
            simplified
        )

    @cached_property
    def constraint_bias(self) -> Expr:
        """γ of J v̇ = γ as a column Matrix."""
        return sympy.Matrix(self._chords.bias()).applyfunc(simplified)

    @property
    def multipliers(self) -> Expr:
        """λ as a column Matrix of symbols: the through variables of the chords."""
        return sympy.Matrix([sympy.Symbol(e.multiplier.name) for e in equations(self.tree)])

    def reaction(self, joint: str) -> tuple[Expr, Expr]:
        """Force and torque that a joint exerts on its head, one edge alone, v̇ as symbols ``a_name``.

        Resolved as `Choices.reactions` says, about the head's origin; with loops λ are `multipliers`.

        Raises:
            ModelError: there is no such joint or constraint.
        """
        if joint not in self.tree.ends:
            raise ModelError(f'joint "{joint}"', f"is not there; {nearest(joint, self.tree.ends)}")
        wrench = self._scheme.reaction(joint)
        force, torque = (sympy.Matrix(part).applyfunc(simplified) for part in wrench)
        return force, torque

    def across(self, edge: str) -> tuple[Expr, Expr]:
        """Velocity and angular velocity across an edge, in ground axes.

        Raises:
            ModelError: there is no such edge.
        """
        found = self._scheme.across()
        if edge not in found:
            raise ModelError(f'edge "{edge}"', f"is not there; {nearest(edge, found)}")
        linear, angular = (sympy.Matrix(part).applyfunc(simplified) for part in found[edge])
        return linear, angular

    @cached_property
    def a(self) -> Expr:
        """v̇ as a column Matrix of symbols."""
        return sympy.Matrix([sympy.Symbol(f"a_{q.name}") for q in self.tree.velocities])

    @cached_property
    def _chords(self) -> Chords:
        state = (tuple(self.q), tuple(self.v))
        rates = orthogonality.coordinate_rates(self.tree, self.algebra, *state)
        found = relations(self._model, self.tree, self.algebra, self._parameters, state, rates)
        return Chords(self.tree, self.algebra, self._arms, self._parameters, found)

    @cached_property
    def _scheme(self) -> InverseScheme:
        multipliers = zip(equations(self.tree), self.multipliers, strict=True)
        return InverseScheme(
            self._derivation,
            self.tree,
            self.algebra,
            self._parameters,
            self._arms,
            self._chords,
            (tuple(self.q), tuple(self.v)),
            tuple(self.a),
            list(multipliers),
        )

    @cached_property
    def paper_matrices(self) -> PaperMatrices:
        """P, H, C, S, K and the literal (13)-(15) of the paper, over sympy and not simplified."""
        return paper_matrices(self.tree, self.algebra, list(self.q), list(self.v))

    @cached_property
    def energy(self) -> tuple[Expr, ...]:
        """Kinetic and potential energy, that of springs included; then what networks store, if any."""
        kinetic, potential = orthogonality.energy(self.tree, self.algebra, self._arms)
        found = [kinetic, potential + self._applied.potential]
        if self._exchange is not None:
            found.append(self._exchange.energy())
        return tuple(simplified(energy) for energy in found)

    @cached_property
    def printed_matrices(self) -> PrintedMatrices:
        """All matrices of the paper in its own form of 2n - 1 chords, over sympy and not simplified."""
        return printed_matrices(self.tree, self.algebra, list(self.q), list(self.v))

    @cached_property
    def _applied(self) -> Applied:
        """Elements and loads that no input drives."""
        return self._acted(driven=False)

    def _acted(self, *, driven: bool) -> Applied:
        state = (tuple(self.q), tuple(self.v))
        return applied(
            self._model,
            self.tree,
            self.algebra,
            self._parameters,
            self._arms,
            *state,
            driven=driven,
        )


def _names(
    tree: KinematicTree, parameters: Mapping[str, Any]
) -> tuple[list[str], list[str], list[str]]:
    """What positions, velocities and inputs are called; no two alike.

    Raises:
        ModelError: a name stands for two things.
    """
    positions = [quantity.name for quantity in tree.positions]
    rates = [quantity.name for quantity in tree.velocities]
    rates = [f"{name}_dot" if name in positions else name for name in rates]
    inputs = [
        f"u_{quantity.name}" if quantity.name in (*positions, *rates) else quantity.name
        for quantity in tree.inputs
    ]
    for name in parameters:
        if name in positions or name in rates:
            raise ModelError(f'parameter "{name}"', "has the name of a coordinate; rename one")
    for name in rates:
        if name in positions:
            problem = "is the name of a coordinate and of a rate; rename a joint"
            raise ModelError(f'coordinate "{name}"', problem)
    return positions, rates, inputs


def simplified(expression: Expr) -> Expr:
    """Products multiplied out, sin^2 + cos^2 merged, common factors collected."""
    whole = _whole(sympy.sympify(expression, strict=True))
    return _whole(sympy.factor_terms(sympy.trigsimp(sympy.expand(whole))))


def _whole(expression: Expr) -> Expr:
    """Floats with integer values as integers: 2.0 x is 2 x to a reader."""
    return expression.replace(
        lambda e: e.is_Float and float(e).is_integer(), lambda e: sympy.Integer(int(e))
    )


__all__ = ["Expr", "Symbolic", "Sympy", "evaluate", "simplified", "to_sympy"]

"""Derivations as users see them: equations as SymPy objects, functions, and drawings."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from linegraph.display import Displayed
from linegraph.numeric.derived import Derived
from linegraph.pipeline import derived

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from linegraph.drawing.scene import Scene
    from linegraph.evaluation import Function
    from linegraph.identification.base_parameters import BaseParameters
    from linegraph.model.builder import Model
    from linegraph.model.system import System
    from linegraph.symbolic.closed_forms import ClosedForms
    from linegraph.symbolic.equation_list import Equations
    from linegraph.symbolic.state_space import StateSpace

Expr = Any


@dataclass(frozen=True, repr=False)
class Derivation(Derived, Displayed):
    """The equations of a system: the result of `derive`.

    It is a snapshot: later changes of the model do not affect it. Closed forms are derived when they
    are first needed, and kept. With coordinates q, velocities v and inputs u, all of them symbols,

        M(q) v̇ + h(q, v) = Q(q, v, u) + Jᵀ λ        q̇ = N(q) v        J v̇ = γ

    with λ, J and γ only if there are loops or constraints. Coordinates have the names of joints, their
    rates are ``name_dot``, accelerations ``a_name``, efforts ``u_name``; velocities that are not rates
    keep names of their own. `symbol_names` lists the replacements for names that the model has taken.

    Attributes:
        system: the frozen system that was derived.
        graph: the system graph.
        formulation: the chosen trees.

    Example:
        >>> from linegraph import Model, derive
        >>> model = Model("pendulum")
        >>> m, l = model.parameter("m", 2.0), model.parameter("l", 0.5)
        >>> model.gravity = (0, 0, -model.parameter("g", 9.81))
        >>> bob = model.body("bob", mass=m, mass_center=(0, 0, -l))
        >>> _ = model.revolute("theta", between=("ground", bob), axis=(0, 1, 0))
        >>> d = derive(model)
        >>> d.mass_matrix, d.gravity
        (Matrix([[l**2*m]]), Matrix([[g*l*m*sin(theta)]]))
        >>> d.equations()
        [Eq(a_theta*l**2*m + g*l*m*sin(theta), u_theta)]
        >>> d.function("bias")([0.1], [0.0]).round(6)
        array([0.979366])
    """

    @cached_property
    def symbolic(self) -> ClosedForms:
        """The closed forms, simplified in full."""
        return self.closed_form()

    def closed_form(
        self,
        level: str = "full",
        *,
        budget: int | None = None,
        progress: Callable[[str], None] | None = None,
    ) -> ClosedForms:
        """All closed forms at one level of simplification.

        Args:
            level: ``none`` as derived, ``fast`` collected and factored, ``full`` in the shortest form
                found; see `simplification`.
            budget: the number of products of two terms that a quantity may take.
            progress: called with the quantity that is being simplified, e.g. ``print``.

        Raises:
            ModelError: there is no such level.
        """
        from linegraph.symbolic.closed_forms import ClosedForms
        from linegraph.symbolic.simplification import BUDGET

        return ClosedForms(self, level, BUDGET if budget is None else budget, progress)

    # -- symbols

    @property
    def q(self) -> Expr:
        """The coordinates, a column of symbols."""
        return self.symbolic.q

    @property
    def v(self) -> Expr:
        """The velocities, a column of symbols."""
        return self.symbolic.v

    @property
    def a(self) -> Expr:
        """The accelerations v̇, a column of symbols ``a_name``."""
        return self.symbolic.a

    @property
    def u(self) -> Expr:
        """The inputs, a column of symbols."""
        return self.symbolic.u

    # -- equations

    @property
    def p(self) -> SimpleNamespace:
        """The parameters as symbols, by their names: ``d.p.m``."""
        from sympy import Symbol

        names = self.system.parameters
        return SimpleNamespace(**{name: Symbol(name) for name in names})

    @property
    def mass_matrix(self) -> Expr:
        """Mass matrix M(q), nv x nv."""
        return self.symbolic.mass_matrix

    @property
    def bias(self) -> Expr:
        """h(q, v), a column: gravity, Coriolis and centrifugal terms, springs and dampers."""
        return self.symbolic.bias

    @property
    def forces(self) -> Expr:
        """Q(q, v, u), a column: efforts of joints, and elements and loads that inputs drive."""
        return self.symbolic.forces

    @property
    def coriolis_matrix(self) -> Expr:
        """C(q, v) of the bodies: C v is the part of h quadratic in v, and Ṁ - 2C is skew."""
        return self.symbolic.coriolis_matrix

    @property
    def gravity(self) -> Expr:
        """g(q), a column: the part of h from weight, Nᵀ ∂V/∂q."""
        return self.symbolic.gravity

    @property
    def kinetic_energy(self) -> Expr:
        """Kinetic energy of the bodies, ½ vᵀ M v plus terms of prescribed motions (J)."""
        return self.symbolic.kinetic_energy

    @property
    def potential_energy(self) -> Expr:
        """Potential energy of weight and springs (J)."""
        return self.symbolic.potential_energy

    @property
    def coordinate_rates(self) -> Expr:
        """Rates of the coordinates q̇ = N(q) v, a column."""
        return self.symbolic.coordinate_rates

    @property
    def constraints(self) -> Expr:
        """Residuals φ(q), a column: zero if all loops are closed."""
        return self.symbolic.constraints

    @property
    def constraint_jacobian(self) -> Expr:
        """J(q), constraints x velocities."""
        return self.symbolic.constraint_jacobian

    @property
    def constraint_bias(self) -> Expr:
        """Right-hand side γ of J v̇ = γ, a column."""
        return self.symbolic.constraint_bias

    @property
    def multipliers(self) -> Expr:
        """The multipliers λ, a column of symbols."""
        return self.symbolic.multipliers

    def reaction(self, joint: str) -> tuple[Expr, Expr]:
        """Force and torque that a joint or constraint exerts on its head, about the head's origin.

        They are resolved in the axes of the head unless the model chooses others. Accelerations occur
        as symbols ``a_name``, multipliers as λ; substitute those of a motion to get numbers.

        Raises:
            ModelError: there is no such joint or constraint.
        """
        return self.symbolic.reaction(joint)

    def equations(self) -> Equations:
        """The equations of motion, one `sympy.Eq` per velocity, then those of constraints.

        Notebooks show the list line by line.
        """
        return self.symbolic.equations()

    @property
    def state_space(self) -> StateSpace:
        """A, B, C, D of a linear system, in letters.

        Raises:
            ModelError: the system is not linear.
        """
        return self.symbolic.state_space

    def linearise(self, at: Mapping[Any, Any] | None = None) -> StateSpace:
        """A, B, C, D for small deviations from an equilibrium or a steady motion, in letters.

        The states are q and v; with closed loops or rolling wheels, the independent changes of position
        and velocity of the emitted ``linearize``. `linearize` is the same function.

        Args:
            at: values of coordinates, velocities, inputs and unknowns of algebraic loops: numbers, or
                expressions of parameters and other letters. Omitted ones are 0, for quaternions the
                identity. If numbers close the loops only for the default parameters, those are
                substituted, and omitted coordinates follow from closing the loops.

        Raises:
            ModelError: v̇ is not 0 there, constraints do not hold or the position is singular, the
                equations depend on time, or they have too many terms.
        """
        return self.symbolic.linearise(at)

    linearize = linearise

    def dynamic(self, expression: Expr) -> Expr:
        """An expression or matrix with `dynamicsymbols` of `sympy.physics.mechanics` for the state.

        Coordinates become functions of time, their rates and accelerations derivatives of these; other
        velocities and inputs become functions of their own names. `static` is the inverse.
        """
        from linegraph.symbolic.dynamicsymbols import to_dynamic

        return to_dynamic(self.symbolic, expression)

    def static(self, expression: Expr) -> Expr:
        """An expression or matrix of `dynamicsymbols`, with the symbols of the derivation."""
        from linegraph.symbolic.dynamicsymbols import to_static

        return to_static(self.symbolic, expression)

    # -- identification

    def base_parameters(self) -> BaseParameters:
        """Identifiable combinations of masses, moments, friction and rotor inertias: base parameters.

        Each is a sum of standard parameters, with factors in closed form of the model's geometry.

        Raises:
            ModelError: nothing moves, or a relation of coupled or prescribed motions has no closed
                form.
        """
        from linegraph.identification.search import base_parameters

        def of_model(parameters: Mapping[str, float]) -> Any:
            function = self.function("inertial_parameters")
            return function(parameters=parameters) if parameters else function()

        return base_parameters(self, of_model)

    # -- numbers

    def function(self, what: Any = "equations", frames: Iterable[str] = ()) -> Function:
        """A fast function of one state or many, from the Python that `emit` writes.

        Args:
            what: the name of an emitted function (``mass_matrix``, ``bias``, ``rhs``, ...), or a SymPy
                expression or matrix of this derivation's symbols.
            frames: bodies, or frames of bodies as ``body.frame``, whose functions are needed, such as
                ``frame_hand_pose``, or all of them by ``kinematics``.

        Returns:
            A function with the arguments of the emitted one except parameters: ``f(q)``, ``f(q, v)``,
                ... Parameters have the model's own values, or those given by ``parameters={"m": 2.0}``.

        Raises:
            ModelError: there is no such function, or a symbol is not of this derivation.
        """
        from linegraph.evaluation import function

        return function(self, what, frames)

    # -- looks

    def sketch(self, hold: Mapping[str, float] | None = None) -> Scene:
        """A drawing of the mechanism, in a position that closes its loops.

        Args:
            hold: coordinates to keep at given values, by name (rad or m).

        Raises:
            ModelError: there is nothing to draw, a parameter has no value, or there is no such
                position.
        """
        from linegraph.drawing.mechanism import mechanism_scene

        return mechanism_scene(self, hold=hold)


def derive(model: Model | System) -> Derivation:
    """Unite the terminal graphs, choose the trees, and check that equations of motion exist.

    The derivation is a snapshot: it keeps a copy of the model, which later changes do not affect.

    Raises:
        ModelError: the model cannot be derived; the message names the component.

    Example:
        >>> from linegraph import Model
        >>> model = Model("pendulum")
        >>> bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
        >>> _ = model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
        >>> derive(model).numeric().mass_matrix([0.3])
        [[0.5]]
    """
    return derived(model, Derivation)

"""Routes to M, h and accelerations at a state: program, derivation over floats, the paper's matrices."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.algebra.jets import Jet, Jets
from linegraph.algebra.protocol import Floats
from linegraph.dynamics import orthogonality
from linegraph.dynamics.edge_quantities import network_powers, powers
from linegraph.dynamics.edge_variables import InverseScheme
from linegraph.ir.interpreter import run
from linegraph.ir.program import Program
from linegraph.ir.prologue import PREPARE
from linegraph.kinematics.tree_state import TreeState
from linegraph.paper.joint_form import paper_matrices

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.equations import StateEquations
    from linegraph.evaluation import Function
    from linegraph.ir.program import Module
    from linegraph.kinematics.links import KinematicTree
    from linegraph.numeric.derived import Derived
    from linegraph.numeric.reference import Numeric
    from linegraph.verification.golden.point import Point

Vector = list[float]


@dataclass(frozen=True)
class _State:
    """A model at a state, with the routes to M, h and accelerations that share its derivation."""

    point: Point
    derivation: Derived
    algebra: Floats
    parameters: dict[str, Scalar]
    tree: KinematicTree
    numeric: Numeric
    q: Vector
    v: Vector

    @classmethod
    def at(cls, point: Point) -> _State:
        """The routes at a state that was drawn."""
        numeric = point.walk.numeric
        q, v = list(point.q), list(point.v)
        values = dict(numeric.parameters)
        algebra = Floats(**numeric.algebra.arguments, p=values)
        given = (algebra, values, numeric.tree, numeric)
        return cls(point, point.derivation, *given, q, v)

    @cached_property
    def equations(self) -> StateEquations:
        """The derivation over floats."""
        return self.numeric.at(self.q, self.v)

    def reference(self) -> tuple[list[Vector], Vector]:
        """M and h by the derivation over floats."""
        return self.equations.mass_matrix, self.equations.bias

    def constraints(self) -> tuple[Vector, Vector]:
        """J and γ by the derivation over floats."""
        return [x for row in self.equations.jacobian for x in row], self.equations.constraint_bias

    def emitted(self, module: Module) -> tuple[list[Vector], Vector]:
        """M and h by interpreting the program that would be emitted."""
        M, h = self.run(module, "equations")
        size = len(self.v)
        return [M[i * size : (i + 1) * size] for i in range(size)], h

    def accelerations(self, module: Module) -> Vector:
        """v̇ by the program that would be emitted, for models without constraints."""
        (a,) = self.run(module, "forward_dynamics")
        return a

    def constrained_motion(self, module: Module, function: Function) -> tuple[Vector, Vector]:
        """v̇ and λ by the emitted Python, since the interpreter knows no loops and branches.

        NaN where it reports an error status.
        """
        import numpy

        given = {"q": self.q, "v": self.v, **self.algebra.arguments}
        known = {x.name: float(self.parameters[x.name]) for x in module.parameters}
        try:
            a, lam = function(*(given[name] for name in function.arguments), parameters=known)
        except (ArithmeticError, numpy.linalg.LinAlgError):
            rows = len(self.point.lam)
            return [float("nan")] * len(self.v), [float("nan")] * rows
        return list(map(float, a)), list(map(float, lam))

    def run(self, module: Module, name: str) -> list[Vector]:
        """Results of one of the programs that would be emitted."""
        exchange = self.equations.networks
        loop = exchange.solved if exchange is not None and exchange.network.loop else []
        given = {"q": self.q, "v": self.v, "a": self.point.a, "loop": loop}
        return self._run(module, name, {**given, **self.algebra.arguments})

    def _run(self, module: Module, name: str, given: dict[str, Any]) -> list[Vector]:
        """Results of a program, running the programs that it calls first."""
        programs = {p.name: p for p in module.programs if isinstance(p, Program)}
        program = programs[name]
        if program.handed:
            (constants,) = run(programs[PREPARE], given)
            given, program = {**given, "c": constants}, programs[program.handed]
        for call in program.calls:
            if call.program in programs:
                found = self._run(module, call.program, given)
                given |= {x.name: y for x, y in zip(call.results, found, strict=True)}
        return run(program, given)

    def forces(self) -> Vector:
        """Q (n): joint efforts and forces of inputs."""
        return [float(x) for x in self.equations.forces]

    def audit_sums(self, acceleration: Vector, multipliers: Vector) -> Any:
        """Sum of the powers of all edges in each subspace (W).

        Args:
            acceleration: v̇, n.
            multipliers: λ, one for each constraint.
        """
        import numpy

        scheme = InverseScheme(self.equations.chords, acceleration, multipliers)
        _, sums = powers(scheme.edges())
        _, domains = network_powers(self.tree.network, scheme.network())
        return numpy.array([float(x) for x in (*sums, *domains.values())])

    def printed(self) -> tuple[list[Vector], Vector]:
        """M and h by the paper's matrices; forces of elements are projected by the float reference."""
        of = self.equations
        matrices = paper_matrices(of.state)
        loads = of.along(of.passive)
        rows = [list(row) for row in matrices.A]
        for i, j, entry in of.stored:
            rows[i][j] += entry
        return rows, [-b - load for b, load in zip(matrices.B, loads, strict=True)]

    def power_balance(self, acceleration: Vector) -> tuple[float, float, float]:
        """Rate of kinetic and gravitational energy, power of all applied forces, and their size (W)."""
        import numpy as np

        passive = self.equations.along(self.equations.passive)
        first = self.tree.layout.mechanical
        both = list(zip(self.v, self.forces(), passive, strict=True))[:first]
        power = sum(v * (active + own) for v, active, own in both)
        for i, j, entry in self.equations.stored:
            # Power that accelerates a rotor behind a gear is not applied to the bodies.
            power -= self.v[i] * entry * acceleration[j] if i < first else 0.0
        of_M, of_force = self.point.bodies.mass_matrix[1], self.point.force[1]
        (_, of_a) = self.point.motion[0]
        of_force = of_force + of_M @ (np.abs(acceleration) + of_a)
        size = float(np.abs(self.v[:first]) @ of_force[:first])
        return float(self._energy_rate(acceleration)), float(power), size

    def _energy_rate(self, acceleration: Sequence[float]) -> float:
        """Rate of kinetic and gravitational energy, by jets."""
        rates = self.equations.coordinate_rates
        q = [Jet(x, dx, 0) for x, dx in zip(self.q, rates, strict=True)]
        v = [Jet(x, dx, 0) for x, dx in zip(self.v, acceleration, strict=True)]
        moving = replace(self.tree, algebra=Jets(self.algebra))
        energies = orthogonality.energy(TreeState(moving, q, v))
        return float(sum(energy.dx for energy in energies if isinstance(energy, Jet)))

"""Whether a model's equations hold: `linegraph check`.

Three routes to M and h meet at random states: the program that is emitted, run as it is; the same derivation
over floats; and the paper's matrices multiplied out. And the power balance: along the motion, the rate of
kinetic and gravitational energy, differentiated exactly, is the power of all that is applied.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph import orthogonality
from linegraph.algebra import Floats
from linegraph.factorization import solve
from linegraph.interpretation import run
from linegraph.jets import Jet, Jets
from linegraph.loads import applied
from linegraph.mass_matrix import mass_matrix
from linegraph.paper import paper_matrices
from linegraph.parameters import Parameter, valued
from linegraph.program import Program
from linegraph.programs import module_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from linegraph.derive import Derivation
    from linegraph.kinematics import KinematicTree
    from linegraph.program import Module
    from linegraph.vector import Scalar

STATES = 20
TOLERANCE = 1e-9
"""Worst relative difference that rounding explains."""

Vector = list[float]


@dataclass(frozen=True)
class Findings:
    """What a check found: worst differences over all states, relative to 1 + the largest entry.

    Attributes:
        program: of the emitted program from the float reference.
        paper: of the paper's matrices from the float reference.
        power: of the power balance; None where a prescribed motion does work on the system.
    """

    program: float
    paper: float
    power: float | None

    @property
    def good(self) -> bool:
        """Whether all differences are rounding."""
        found = (self.program, self.paper, self.power or 0.0)
        return all(difference < TOLERANCE for difference in found)


def check(derivation: Derivation, seed: int = 0) -> Findings:
    """Compare the routes at `STATES` random states.

    Raises:
        ModelError: a parameter has no value, or a law is not defined somewhere.
    """
    draw = random.Random(seed)
    module = module_of(derivation, "checked", folded=False, about=())
    worst = [0.0, 0.0, 0.0]
    driven = any(place.drive for place in _state(derivation, draw).tree.layout.places.values())
    for _ in range(STATES):
        state = _state(derivation, draw)
        M, h = state.reference()
        worst[0] = max(worst[0], state.difference(M, h, *state.emitted(module)))
        worst[1] = max(worst[1], state.difference(M, h, *state.printed()))
        if not driven:
            worst[2] = max(worst[2], state.power_defect(M, h))
    return Findings(worst[0], worst[1], None if driven else worst[2])


def _state(derivation: Derivation, draw: random.Random) -> _State:
    model = derivation.model
    values = {
        p.name: draw.uniform(0.5, 2.0) if p.value is None else float(p.value)
        for p in model.parameters.values()
        if not p.derived
    }
    count = len(derivation.structure.inputs)
    algebra = Floats(t=draw.uniform(0, 1), u=[draw.uniform(-1, 1) for _ in range(count)], p=values)

    def given(parameter: Parameter) -> float:
        return values[parameter.name]

    parameters = valued(model.parameters.values(), algebra, given)
    tree = derivation.tree(algebra, parameters)
    q = [draw.uniform(-1, 1) for _ in tree.positions]
    tree.normalise(q)
    v = [draw.uniform(-1, 1) for _ in tree.velocities]
    return _State(derivation, algebra, parameters, tree, q, v)


@dataclass(frozen=True)
class _State:
    """A model at a random state: all routes to its M and h."""

    derivation: Derivation
    algebra: Floats
    parameters: dict[str, Scalar]
    tree: KinematicTree
    q: Vector
    v: Vector

    def reference(self) -> tuple[list[Vector], Vector]:
        """M and h by the derivation over floats."""
        crossed = orthogonality.arms(self.tree, self.algebra, self.q, self.v)
        M = mass_matrix(self.tree, self.algebra, crossed)
        passive = self._applied(crossed, driven=False)
        return M, orthogonality.inverse_dynamics(self.tree, self.algebra, crossed, applied=passive)

    def emitted(self, module: Module) -> tuple[list[Vector], Vector]:
        """M and h by the program that would be emitted."""
        program = next(
            p for p in module.programs if isinstance(p, Program) and p.name == "equations"
        )
        given = {"q": self.q, "v": self.v, **self.algebra.arguments}
        M, h = run(program, given)
        size = len(self.v)
        return [M[i * size : (i + 1) * size] for i in range(size)], h

    def printed(self) -> tuple[list[Vector], Vector]:
        """M and h by the paper's matrices; what elements add is projected by the float reference."""
        crossed = orthogonality.arms(self.tree, self.algebra, self.q, self.v)
        matrices = paper_matrices(self.tree, self.algebra, self.q, self.v)
        loads = orthogonality.generalised_forces(
            self.tree, self.algebra, crossed, self._applied(crossed, driven=False)
        )
        return matrices.A, [-b - load for b, load in zip(matrices.B, loads, strict=True)]

    def power_defect(self, M: list[Vector], h: Vector) -> float:
        """dE/dt less the power of everything applied, relative to the power."""
        crossed = orthogonality.arms(self.tree, self.algebra, self.q, self.v)
        active, passive = (
            orthogonality.generalised_forces(
                self.tree, self.algebra, crossed, self._applied(crossed, driven=driven)
            )
            for driven in (True, False)
        )
        for velocity, place in self.tree.layout.efforts:
            active[velocity] = active[velocity] + self.algebra.symbol("u", place)
        right = [force - bias for force, bias in zip(active, h, strict=True)]
        acceleration = solve(M, right, self.tree.outward).unknowns
        power = sum(v * (a + p) for v, a, p in zip(self.v, active, passive, strict=True))
        return float(abs(self._energy_rate(acceleration) - power) / (1 + abs(power)))

    def _energy_rate(self, acceleration: Sequence[float]) -> float:
        """The rate of kinetic and gravitational energy, by calculating with jets."""
        rates = orthogonality.coordinate_rates(self.tree, self.algebra, self.q, self.v)
        q = [Jet(x, dx, 0) for x, dx in zip(self.q, rates, strict=True)]
        v = [Jet(x, dx, 0) for x, dx in zip(self.v, acceleration, strict=True)]
        jets = Jets(self.algebra)
        energies = orthogonality.energy(self.tree, jets, orthogonality.arms(self.tree, jets, q, v))
        return float(sum(energy.dx for energy in energies if isinstance(energy, Jet)))

    def _applied(self, crossed: list[orthogonality.Arm], *, driven: bool) -> Any:
        state = (tuple(self.q), tuple(self.v))
        model = self.derivation.model
        return applied(
            model, self.tree, self.algebra, self.parameters, crossed, *state, driven=driven
        )

    @staticmethod
    def difference(M: list[Vector], h: Vector, other_M: list[Vector], other_h: Vector) -> float:
        """The worst relative difference."""
        rows = [x for row in M for x in row], [x for row in other_M for x in row]
        return max(_relative(*rows), _relative(h, other_h))


def _relative(expected: Sequence[float], found: Sequence[float]) -> float:
    largest = 1 + max(map(abs, expected), default=0.0)
    return max((abs(a - b) for a, b in zip(expected, found, strict=True)), default=0.0) / largest


def report(derivation: Derivation, findings: Findings, heading: Callable[[str], str] = str) -> str:
    """The findings for a reader."""
    tree = derivation.structure
    lines = [heading(f"model {derivation.model.name}")]
    lines.append(f"  {len(tree.velocities)} degrees of freedom, {len(tree.inputs)} inputs")
    listed = (("q", tree.positions), ("v", tree.velocities), ("u", tree.inputs))
    for symbol, quantities in listed:
        lines += [f"  {symbol}[{i}]  {x.name}  {x.unit}" for i, x in enumerate(quantities)]
    lines.append(heading(f"at {STATES} random states, worst relative differences"))
    lines.append(f"  emitted program and float reference   {findings.program:.1e}")
    lines.append(f"  paper's matrices and float reference  {findings.paper:.1e}")
    if findings.power is None:
        lines.append(
            "  power balance                         not judged: prescribed motion does work"
        )
    else:
        lines.append(f"  power balance                         {findings.power:.1e}")
    lines.append("good" if findings.good else "NOT GOOD: please report this model")
    return "\n".join(lines) + "\n"

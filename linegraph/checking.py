"""Whether a model's equations hold: `linegraph check`.

Three routes to M and h meet at random states: the program that is emitted, run as it is; the same derivation
over floats; and the paper's matrices multiplied out. And the power balance: along the motion, the rate of
kinetic and gravitational energy, differentiated exactly, is the power of all that is applied. And the audit:
through times across, summed over all edges of each subspace, is zero, and every component of a network
stores or turns into heat what it takes in. With constraints the states satisfy
them, and their Jacobian and bias are compared, too.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph import orthogonality
from linegraph.algebra import Floats
from linegraph.assembly import consistent, saddle
from linegraph.closure import equations
from linegraph.edges import network_powers, powers
from linegraph.factorization import solve
from linegraph.interpretation import run
from linegraph.inverse_scheme import InverseScheme
from linegraph.jets import Jet, Jets
from linegraph.loads import applied, efforts
from linegraph.paper import paper_matrices
from linegraph.program import Program
from linegraph.programs import module_of
from linegraph.prologue import PREPARE
from linegraph.regularity import cause
from linegraph.united import network_entries

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from linegraph.derive import Derivation
    from linegraph.kinematics import KinematicTree
    from linegraph.numeric import Numeric
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
        paper: of the paper's matrices from the float reference; None where a link turns against ground.
        power: of the power balance of mechanics; None where a prescribed motion does work, or nothing moves.
        audit: of the sums of through times across, relative to the largest power.
        idle: why M is singular, so that no accelerations follow to judge powers by; power and audit are None.
    """

    program: float
    paper: float | None
    power: float | None
    audit: float | None
    idle: str = ""

    @property
    def good(self) -> bool:
        """Whether all differences are rounding."""
        found = (self.program, self.paper or 0.0, self.power or 0.0, self.audit or 0.0)
        return all(difference < TOLERANCE for difference in found)


def check(derivation: Derivation, seed: int = 0) -> Findings:
    """Compare the routes at `STATES` random states.

    Raises:
        ModelError: a parameter has no value, or a law is not defined somewhere.
    """
    draw = random.Random(seed)
    module = module_of(derivation, "checked", folded=False, about=())
    worst = [0.0, 0.0, 0.0, 0.0]
    tree = derivation.structure
    driven = any(place.drive for place in tree.layout.places.values())
    driven = driven or any(any(drives) for drives in tree.layout.drives.values())
    unmoved = not tree.layout.mechanical
    idle = cause(derivation.idle) if derivation.idle else ""
    for _ in range(STATES):
        state = _state(derivation, draw)
        M, h = state.reference()
        worst[0] = max(worst[0], state.difference(M, h, *state.emitted(module)))
        if tree.closed:
            worst[0] = max(worst[0], state.constraint_difference(module))
        if not tree.levelled:
            worst[1] = max(worst[1], state.difference(M, h, *state.printed()))
        if idle:
            continue  # no acceleration follows from M and h
        a, lam = state.solved(M, h)
        if not driven:
            worst[2] = max(worst[2], state.power_defect(a))
        worst[3] = max(worst[3], state.audit(a, lam))
    paper = None if tree.levelled else worst[1]
    if idle:
        return Findings(worst[0], paper, None, None, idle)
    return Findings(worst[0], paper, None if driven or unmoved else worst[2], worst[3])


def _state(derivation: Derivation, draw: random.Random) -> _State:
    model = derivation.model
    values = {
        p.name: draw.uniform(0.5, 2.0) if p.value is None else float(p.value)
        for p in model.parameters.values()
        if not p.derived
    }
    count = len(derivation.structure.inputs)
    u = [draw.uniform(-1, 1) for _ in range(count)]
    numeric = derivation.numeric(values, draw.uniform(0, 1), u)
    tree = numeric.tree
    if tree.closed:
        q, v = consistent(derivation, numeric, draw)
    else:
        q = [draw.uniform(-1, 1) for _ in tree.positions]
        tree.normalise(q)
        v = [draw.uniform(-1, 1) for _ in tree.velocities]
    algebra = Floats(t=numeric.t, u=u, p=values)
    return _State(derivation, algebra, dict(numeric.parameters), tree, numeric, q, v)


@dataclass(frozen=True)
class _State:
    """A model at a random state: all routes to its M and h."""

    derivation: Derivation
    algebra: Floats
    parameters: dict[str, Scalar]
    tree: KinematicTree
    numeric: Numeric
    q: Vector
    v: Vector

    def reference(self) -> tuple[list[Vector], Vector]:
        """M and h by the derivation over floats."""
        crossed = orthogonality.arms(self.tree, self.algebra, self.q, self.v)
        M = self.numeric.united_mass_matrix(self.q, self.v)
        passive = self._applied(crossed, driven=False)
        return M, orthogonality.inverse_dynamics(self.tree, self.algebra, crossed, applied=passive)

    def emitted(self, module: Module) -> tuple[list[Vector], Vector]:
        """M and h by the program that would be emitted."""
        M, h = self.run(module, "equations")
        size = len(self.v)
        return [M[i * size : (i + 1) * size] for i in range(size)], h

    def run(self, module: Module, name: str) -> list[Vector]:
        """The results of one of the programs that would be emitted."""
        programs = {p.name: p for p in module.programs if isinstance(p, Program)}
        program = programs[name]
        exchange = self.numeric.exchange(self.q, self.v)
        loop = exchange.solved if exchange is not None and exchange.network.loop else []
        given = {"q": self.q, "v": self.v, "loop": loop, **self.algebra.arguments}
        if program.handed:
            (given["c"],) = run(programs[PREPARE], given)
            program = programs[program.handed]
        return run(program, given)

    def constraint_difference(self, module: Module) -> float:
        """J and γ of the emitted program and of the float reference."""
        (J,), (gam,) = (
            self.run(module, name) for name in ("constraint_jacobian", "constraint_bias")
        )
        reference = [x for row in self.numeric.constraint_jacobian(self.q) for x in row]
        bias = self.numeric.constraint_bias(self.q, self.v)
        return max(_relative(reference, J), _relative(bias, gam))

    def solved(self, M: list[Vector], h: Vector) -> tuple[Vector, Vector]:
        """v̇ and λ."""
        right = [force - bias for force, bias in zip(self.forces(), h, strict=True)]
        if not self.tree.closed:
            symmetric = self.tree.network is None or self.tree.network.symmetric
            return solve(M, right, self.tree.outward, symmetric=symmetric).unknowns, []
        J = self.numeric.constraint_jacobian(self.q)
        return saddle(M, right, J, self.numeric.constraint_bias(self.q, self.v))

    def forces(self) -> Vector:
        """Q: joint efforts and what inputs drive."""
        crossed = orthogonality.arms(self.tree, self.algebra, self.q, self.v)
        acting = self._applied(crossed, driven=True)
        active = orthogonality.generalised_forces(self.tree, self.algebra, crossed, acting)
        chords = self.numeric.chords(self.q, self.v)
        return [float(x) for x in efforts(self.tree, self.algebra, chords, active)]

    def audit(self, acceleration: Vector, multipliers: Vector) -> float:
        """What the powers of all edges sum up to in each subspace, relative to the largest of them."""
        crossed = orthogonality.arms(self.tree, self.algebra, self.q, self.v)
        scheme = InverseScheme(
            self.derivation,
            self.tree,
            self.algebra,
            self.parameters,
            crossed,
            self.numeric.chords(self.q, self.v),
            (tuple(self.q), tuple(self.v)),
            acceleration,
            list(zip(equations(self.tree), multipliers, strict=True)),
        )
        found, sums = powers(scheme.edges())
        more, domains = network_powers(self.tree.network, scheme.network())
        found, sums = found | more, (*sums, *domains.values(), *scheme.gains().values())
        return float(max(map(abs, sums)) / (1 + max(map(abs, found.values()), default=0.0)))

    def printed(self) -> tuple[list[Vector], Vector]:
        """M and h by the paper's matrices; what elements add is projected by the float reference."""
        crossed = orthogonality.arms(self.tree, self.algebra, self.q, self.v)
        matrices = paper_matrices(self.tree, self.algebra, self.q, self.v)
        loads = orthogonality.generalised_forces(
            self.tree, self.algebra, crossed, self._applied(crossed, driven=False)
        )
        rows = [list(row) for row in matrices.A]
        entries = network_entries(self.numeric.exchange(self.q, self.v), self.algebra)
        for i, j, entry in entries:
            rows[i][j] += entry
        return rows, [-b - load for b, load in zip(matrices.B, loads, strict=True)]

    def power_defect(self, acceleration: Vector) -> float:
        """dE/dt less the power of everything applied, relative to the power."""
        crossed = orthogonality.arms(self.tree, self.algebra, self.q, self.v)
        passive = orthogonality.generalised_forces(
            self.tree, self.algebra, crossed, self._applied(crossed, driven=False)
        )
        first = self.tree.layout.mechanical
        both = list(zip(self.v, self.forces(), passive, strict=True))[:first]
        power = sum(v * (active + own) for v, active, own in both)
        entries = network_entries(self.numeric.exchange(self.q, self.v), self.algebra)
        for i, j, entry in entries:
            # what a rotor behind a gear takes is no power applied to the bodies
            power -= self.v[i] * entry * acceleration[j] if i < first else 0.0
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
    freedoms = derivation.assembled.freedoms if tree.closed else tree.layout.mechanical
    states = len(tree.velocities) - tree.layout.mechanical
    beside = f", {states} states of networks" * bool(states)
    lines.append(f"  {freedoms} degrees of freedom{beside}, {len(tree.inputs)} inputs")
    listed = (("q", tree.positions), ("v", tree.velocities), ("u", tree.inputs))
    for symbol, quantities in listed:
        lines += [f"  {symbol}[{i}]  {x.name}  {x.unit}" for i, x in enumerate(quantities)]
    lines.append(heading(f"at {STATES} random states, worst relative differences"))
    lines.append(f"  emitted program and float reference   {findings.program:.1e}")
    if findings.paper is None:
        lines.append(
            "  paper's matrices                      not judged: angles measured from ground"
        )
    else:
        lines.append(f"  paper's matrices and float reference  {findings.paper:.1e}")
    if findings.idle:
        why = f"not judged: M is singular, as {findings.idle}"
        lines.append(f"  power balance and audit               {why}")
        lines.append("good" if findings.good else "NOT GOOD: please report this model")
        return "\n".join(lines) + "\n"
    if findings.power is None:
        why = "prescribed motion does work" if tree.layout.mechanical else "nothing moves"
        lines.append(f"  power balance                         not judged: {why}")
    else:
        lines.append(f"  power balance                         {findings.power:.1e}")
    lines.append(f"  audit: sum of through times across    {findings.audit:.1e}")
    lines.append("good" if findings.good else "NOT GOOD: please report this model")
    return "\n".join(lines) + "\n"

"""Emitted code of random closed mechanisms against an oracle in absolute coordinates.

The oracle (`closed_systems`) solves the equations of all bodies and all joints at once. The first
part below holds it against Newton-Euler equations of trees and against differences along motions;
the second part holds linegraph against it at 50 systems x 10 states, or at 200 with ``--all-forms``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
from oracles import closed_systems as closed
from oracles import newton_euler
from scipy.linalg import null_space
from support.compiled import Compiled
from support.emitted import load
from support.spec_models import numbers, rows
from systems import random_trees as trees

from linegraph import Model, derive
from linegraph.components.joints import JOINTS
from linegraph.emission.emit import render

SYSTEMS, STATES, BATCH = 200, 10, 10
SLICES = range(0, SYSTEMS, BATCH)
FEW = SLICES[::20]
"""Of all systems every fourth ten."""

TOLERANCE = 1e-8  # relative to 1 + the largest expected entry; measured 6e-12
DIFFERENCES = 1e-6
CONDITION = 1e6
MARGIN = 1e3
UNIQUE, FREE = 1e-9, 1e-7
"""An entry of the null space below the first is zero, above the second it is not."""

FIRST = {-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}
SECOND = {-2: -1 / 12, -1: 16 / 12, 0: -30 / 12, 1: 16 / 12, 2: -1 / 12}
"""Weights of differences of the fourth order, for the first and the second derivative."""


def error(found: Any, expected: Any) -> float:
    """The largest difference, relative to 1 + the largest entry expected."""
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape
    largest = np.max(np.abs(found - expected), initial=0.0)
    return float(largest / (1 + np.max(np.abs(expected), initial=0.0)))


# ---- the oracle by itself ----


def system_of(tree: trees.Tree) -> closed.System:
    """A tree as a system of the oracle, with efforts wherever there can be."""
    joints = tuple(
        closed.Joint(**vars(joint), effort=joint.kind not in ("fixed", "free"))
        for joint in tree.joints
    )
    return closed.System("tree", tree.bodies, joints, tree.gravity)


def own_chart(system: closed.System) -> closed.Chart:
    """The chart of a system that is a tree, with its joints in order."""
    q_names = [name for joint in system.joints for name in joint.coordinate_names]
    v_names = [name for joint in system.joints for name in joint.velocity_names]
    return closed.chart(system, q_names, v_names)


def hanging(seed: int) -> closed.System:
    """A tree with joints of all kinds, also those `random_trees` does not know."""
    rng = np.random.default_rng(seed)
    sketch = closed.Sketch(rng, floating=seed % 3 == 0)
    kinds = [kind for kind in closed.COORDINATES if kind != "free"]
    for kind in rng.permutation(kinds):
        carrier = str(rng.choice([sketch.root, *sketch.bodies]))
        step = closed.Step(str(kind), rng.normal(size=3), closed.direction(rng))
        sketch.connect(step, carrier, sketch.new_body())
    return sketch.finished("tree")


def moving_state(seed: int) -> tuple[closed.System, dict[str, closed.Motion], np.ndarray]:
    """A closed system as drawn, in some motion that its joints allow, with efforts u."""
    system, rng = closed.random_system(seed), np.random.default_rng(seed)
    none = np.zeros(6 * len(system.bodies))
    u = rng.normal(scale=3.0, size=len(system.effort_names))
    still = closed.moving(system, system.assembled, none)
    free = null_space(closed.solve(system, still, system.efforts_of(u)).constraints, rcond=1e-9)
    x = free @ rng.normal(size=free.shape[1])
    return system, closed.moving(system, system.assembled, x), u


@pytest.mark.parametrize("seed", range(24))
def test_oracle_agrees_with_newton_euler_on_trees(seed: int) -> None:
    """Joint accelerations there, accelerations of mass centres here."""
    rng = np.random.default_rng(seed)
    tree = trees.random_tree(rng, bodies=1 + seed % 8, couplings=False, massless=False)
    system = system_of(tree)
    chart = own_chart(system)
    for _ in range(3):
        q, v = trees.random_state(rng, tree)
        u = rng.normal(size=len(system.effort_names))
        tau = np.zeros(tree.nv)
        for joint in system.joints:
            if joint.effort:
                tau[tree.velocity_slices[joint.name]] = system.efforts_of(u)[joint.name]
        a = newton_euler.forward_dynamics(tree, q, v, tau)
        expected = np.concatenate(
            [
                np.append(c.linear @ a + c.linear_bias, c.angular @ a + c.angular_bias)
                for _, c in newton_euler.mass_centers(tree, q, v)
            ]
        )
        motions = chart.motions(q, v, a)
        assert error(closed.accelerations(system, motions), expected) < 1e-11
        found = closed.solve(system, motions, system.efforts_of(u))
        assert error(found.acceleration, expected) < 1e-9
        assert (found.mobility, found.redundancy) == (tree.nv, 0)
        energy = newton_euler.kinetic_energy(tree, q, v) + newton_euler.potential_energy(tree, q)
        assert abs(closed.energy(system, motions) - energy) < 1e-11 * (1 + abs(energy))


@pytest.mark.parametrize("seed", range(12))
def test_motions_of_all_kinds_of_joint_are_derivatives_of_each_other(seed: int) -> None:
    """Gaps stay closed, x is the derivative of places, x' that of x, and the joints' rows hold."""
    system = hanging(seed)
    chart, rng = own_chart(system), np.random.default_rng(seed)
    q, v, a = (rng.normal(size=n) for n in (sum(map(len, chart.q.values())), chart.nv, chart.nv))
    q, step = chart.normalised(q), 1e-3
    there = {k: chart.motions(*chart.advance(q, v, a, k * step), a) for k in FIRST}
    motions = chart.motions(q, v, a)
    assert np.max(np.abs(closed.gaps(system, motions))) < 1e-12

    rate = sum(w / step * closed.velocities(system, there[k]) for k, w in FIRST.items())
    assert error(rate, closed.accelerations(system, motions)) < 1e-8
    for place, center in enumerate(closed.centers(system, motions)):
        around = {k: closed.centers(system, there[k])[place] for k in FIRST}
        velocity = sum(w / step * around[k].origin for k, w in FIRST.items())
        assert error(velocity, center.velocity) < 1e-8
        turning = sum(w / step * around[k].rotation for k, w in FIRST.items())
        assert error(turning, newton_euler.skew(center.spin) @ center.rotation) < 1e-8
    x, change = closed.velocities(system, motions), closed.accelerations(system, motions)
    for joint in system.joints:
        own = closed.rows_of(system, joint, motions)
        assert np.max(np.abs(own.matrix @ x), initial=0.0) < 1e-12
        assert error(own.matrix @ change, own.right) < 1e-12
        assert error(own.rates, v[chart.v.get(joint.name, [])]) < 1e-12


@pytest.mark.parametrize("seed", range(0, SYSTEMS, 7))
def test_oracle_keeps_loops_closed_and_energy_balanced(seed: int) -> None:
    """On its accelerations all gaps stay zero, and only efforts bring energy."""
    system, motions, u = moving_state(seed)
    efforts = system.efforts_of(u)
    found = closed.solve(system, motions, efforts)
    step = 2e-3
    there = {k: closed.shifted(system, motions, found.acceleration, k * step) for k in (*FIRST, 0)}
    assert np.max(np.abs(closed.gaps(system, motions))) < 1e-12
    bend = sum(w / step**2 * closed.gaps(system, there[k]) for k, w in SECOND.items())
    assert np.max(np.abs(bend)) < 1e-6 * (1 + np.max(np.abs(found.acceleration)))
    rate = sum(w / step * closed.energy(system, there[k]) for k, w in FIRST.items())
    power = sum(
        efforts[joint.name] @ closed.rows_of(system, joint, motions).rates
        for joint in system.joints
    )
    assert abs(rate - power) < 1e-6 * (1 + abs(power) + np.max(np.abs(found.acceleration)))
    assert found.residual < 1e-9


@pytest.mark.parametrize("seed", range(3, SYSTEMS, 7))
def test_wrenches_of_the_oracle_move_each_body(seed: int) -> None:
    """Newton's and Euler's laws for each body, with the wrenches as told: in head axes."""
    system, motions, u = moving_state(seed)
    found = closed.solve(system, motions, system.efforts_of(u))
    total = {name: np.zeros((2, 3)) for name in motions}
    for joint in system.joints:
        head = closed.frames(joint, motions)[1]
        force, torque = found.wrenches[joint.name].reshape(2, 3) @ head.rotation.T
        about_ground = np.array([force, torque + np.cross(head.origin, force)])
        total[joint.head] += about_ground
        total[joint.tail] -= about_ground
    for body, center in zip(system.bodies, closed.centers(system, motions), strict=True):
        acceleration, spin_rate = found.acceleration[system.places[body.name]].reshape(2, 3)
        inertia = center.rotation @ body.inertia @ center.rotation.T
        force = body.mass * (acceleration - system.gravity)
        torque = inertia @ spin_rate + np.cross(center.spin, inertia @ center.spin)
        needed = np.array([force, torque + np.cross(center.origin, force)])
        assert error(total[body.name], needed) < 1e-9


# ---- linegraph against the oracle ----


@dataclass(frozen=True, eq=False)
class State:
    """A consistent state q, v, the accelerations and multipliers there, and what should be.

    Attributes:
        motions: Motion of the bodies under linegraph's accelerations a.
        expected: The oracle's solution.
        gap: How far the joints are from being satisfied, in the oracle's words.
    """

    q: np.ndarray
    v: np.ndarray
    u: np.ndarray
    a: np.ndarray
    motions: dict[str, closed.Motion]
    expected: closed.Solution
    gap: float

    @property
    def regular(self) -> bool:
        """Whether nothing here is nearly singular."""
        return self.expected.condition < CONDITION and self.expected.margin > MARGIN


@dataclass(frozen=True, eq=False, repr=False)
class Case:
    """A system with its emitted code, its assembly, and states around that."""

    seed: int
    system: closed.System
    emitted: Any
    assembly: Any
    chart: closed.Chart
    states: list[State]

    def __repr__(self) -> str:
        """What messages need to say of it."""
        return f"system {self.seed} ({self.system.family})"

    @property
    def regular(self) -> list[State]:
        """The states that are compared; that all are consistent is a test of its own."""
        return [state for state in self.states if state.regular and state.gap < 1e-6]


def model_of(system: closed.System, name: str, tree: tuple[str, ...] = ()) -> Model:
    """The model a user would build for this system, who may wish for certain branches."""
    model = Model(name, gravity=numbers(system.gravity))
    model.formulation(tree=tree)
    handles = {trees.GROUND: model.ground}
    for body in system.bodies:
        handles[body.name] = model.body(
            body.name,
            mass=float(body.mass),
            mass_center=numbers(body.mass_center),
            inertia=rows(body.inertia),
        )
    for joint in system.joints:
        tail = handles[joint.tail].frame(
            f"{joint.name}.tail", at=numbers(joint.tail_at), rotation=rows(joint.tail_rotation)
        )
        head = handles[joint.head].frame(
            f"{joint.name}.head", at=numbers(joint.head_at), rotation=rows(joint.head_rotation)
        )
        options: dict[str, Any] = {"axis": numbers(joint.axis)}
        if joint.kind == "universal":
            options = {"axes": (numbers(joint.axis), numbers(joint.second))}
        options["effort"] = joint.effort
        model.add_joint(JOINTS[joint.kind](joint.name, (tail, head), **options))
    return model


def model_with_its_tree(seed: int, system: closed.System, name: str) -> Model:
    """The model of the system of this number.

    Every other twenty have a random tree: left to itself linegraph cuts what has most freedoms.
    """
    if seed // len(closed.FAMILIES) % 2 == 0:
        return model_of(system, name)
    return model_of(system, name, closed.random_branches(system, np.random.default_rng(seed)))


def consistent(
    emitted: Any, chart: closed.Chart, q: np.ndarray, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """A state beside q that satisfies all constraints; nearer where Newton does not get there."""
    toward, v = rng.normal(size=chart.nv), rng.normal(size=chart.nv)
    for size in (0.3, 0.1, 0.03, 0.01):
        beside, _ = chart.advance(q, toward, np.zeros(chart.nv), size)
        try:
            return emitted.project(beside, v)
        except np.linalg.LinAlgError:
            continue
    raise AssertionError("project fails however near the configuration is")


def state_at(case: Case, rng: np.random.Generator) -> State:
    """A state of this system near its assembly."""
    system, chart, emitted = case.system, case.chart, case.emitted
    q, v = consistent(emitted, chart, np.array(case.assembly.q), rng)
    u = rng.normal(scale=2.0, size=emitted.NU)
    a, _ = emitted.forward_dynamics(q, v, u)
    motions = chart.motions(q, v, a)
    expected = closed.solve(system, motions, system.efforts_of(u))
    gap = float(np.max(np.abs(closed.gaps(system, motions))))
    return State(q, v, u, a, motions, expected, gap)


@cache
def case(seed: int) -> Case:
    """The system of this number, emitted."""
    system, name = closed.random_system(seed), f"closed{seed}"
    rng = np.random.default_rng([seed, 1])
    model = model_with_its_tree(seed, system, name)
    files = render(model, languages=["python"], folded=True)
    with TemporaryDirectory() as folder:
        emitted = load(files, name, Path(folder))
    chart = closed.chart(system, emitted.Q_NAMES, emitted.V_NAMES)
    found = Case(seed, system, emitted, derive(model).assembly(), chart, [])
    found.states.extend(state_at(found, rng) for _ in range(STATES))
    return found


def cases(first: int) -> list[Case]:
    """The systems of a slice."""
    return [case(seed) for seed in range(first, first + BATCH)]


def rank_of(matrix: np.ndarray) -> int:
    """The rank with the oracle's notion of zero."""
    values = np.linalg.svd(matrix, compute_uv=False)
    return int(np.sum(values > closed.RANK * np.max(values, initial=0.0)))


def oracle_at(case: Case, q: np.ndarray) -> closed.Solution:
    """The oracle at rest at q."""
    none = np.zeros(case.chart.nv)
    motions = case.chart.motions(q, none, none)
    u = np.zeros(len(case.system.effort_names))
    return closed.solve(case.system, motions, case.system.efforts_of(u))


@pytest.mark.seeds(FEW, SLICES)
def test_sizes_and_names(seed: int) -> None:
    for one in cases(seed):
        emitted, system = one.emitted, one.system
        loops = len(system.joints) - len(system.bodies)
        assert list(emitted.U_NAMES) == system.effort_names, one
        assert (one.chart.nv, len(system.effort_names)) == (emitted.NV, emitted.NU), one
        lost = sum(6 - joint.freedoms for joint in system.joints)
        assert lost - 6 * len(system.bodies) + emitted.NV == emitted.NC, one
        assert emitted.NP == emitted.NC == len(emitted.CONSTRAINT_NAMES), one
        chords = [j.name for j in system.joints if j.name not in one.chart.q]
        assert len(chords) == loops, one
        wanted = [j.name + end for j in system.joints if j.kind != "free" for end in closed.WRENCH]
        assert set(wanted) <= set(emitted.REACTION_NAMES), one


@pytest.mark.seeds(FEW, SLICES)
def test_assembly_counts_freedoms_and_redundancy_like_the_oracle(seed: int) -> None:
    """At the assembly itself; a few may be so near a singularity that a rank means little."""
    skipped = 0
    for one in cases(seed):
        assembly, q = one.assembly, np.array(one.assembly.q)
        expected = oracle_at(one, q)
        there = one.chart.motions(q, np.zeros(one.chart.nv), np.zeros(one.chart.nv))
        assert np.max(np.abs(closed.gaps(one.system, there))) < 1e-9, one
        assert np.max(np.abs(one.emitted.constraints(q)), initial=0.0) < 1e-9, one
        if expected.condition > CONDITION or expected.margin < MARGIN:
            skipped += 1
            continue
        rank = rank_of(one.emitted.constraint_jacobian(q))
        assert rank == assembly.rank, one
        assert one.emitted.NV - rank == assembly.freedoms == expected.mobility, one
        assert one.emitted.NC - rank == assembly.redundant == expected.redundancy, one
    assert skipped <= 1


@pytest.mark.seeds(FEW, SLICES)
def test_unique_multipliers_are_those_outside_of_the_null_space(seed: int) -> None:
    for one in cases(seed):
        jacobian = one.emitted.constraint_jacobian(np.array(one.assembly.q))
        none = null_space(jacobian.T, rcond=closed.RANK)
        doubt = np.linalg.norm(none, axis=1)
        assert len(one.assembly.unique) == one.emitted.NC, one
        for k, unique in enumerate(one.assembly.unique):
            assert not (unique and doubt[k] > FREE), (one, k, doubt[k])
            assert not (not unique and doubt[k] < UNIQUE), (one, k, doubt[k])


@pytest.mark.seeds(FEW, SLICES)
def test_projected_states_satisfy_all_joints(seed: int) -> None:
    """In the oracle's words: places of all joints, chords too, and their velocities."""
    skipped = 0
    for one in cases(seed):
        for state in one.states:
            skipped += not state.regular
            x = closed.velocities(one.system, state.motions)
            slip = np.max(np.abs(state.expected.constraints @ x))
            assert not state.regular or state.gap < 1e-9, one
            assert not state.regular or slip < 1e-9 * (1 + np.max(np.abs(x))), one
            assert not state.regular or state.expected.residual < 1e-6, one
    assert skipped <= STATES * BATCH // 20, f"{skipped} states are nearly singular"


@pytest.mark.seeds(FEW, SLICES)
def test_velocities_the_jacobian_allows_are_those_of_the_joints(seed: int) -> None:
    """The null space of J, mapped to twists of bodies, is that of the oracle's rows."""
    for one in cases(seed):
        for state in one.regular[:3]:
            free = null_space(one.emitted.constraint_jacobian(state.q), rcond=closed.RANK)
            assert free.shape[1] == state.expected.mobility, one
            x = one.chart.jacobian(state.q) @ free
            assert np.max(np.abs(state.expected.constraints @ x), initial=0.0) < 1e-8, one


@pytest.mark.seeds(FEW, SLICES)
def test_constraints_along_a_motion(seed: int) -> None:
    """Along any v, d phi/dt = J v; d(J v)/dt = J a - gamma where J v = 0, at any a."""
    step = 1e-3
    for one in cases(seed):
        emitted, chart = one.emitted, one.chart
        rng = np.random.default_rng(one.seed)
        for state in one.regular[:2]:
            q, v, a = state.q, state.v, rng.normal(size=chart.nv)
            jacobian = emitted.constraint_jacobian(q)
            none = np.zeros(chart.nv)
            any_v = rng.normal(size=chart.nv)
            around = {k: chart.advance(q, any_v, none, k * step)[0] for k in FIRST}
            rate = sum(w / step * emitted.constraints(around[k]) for k, w in FIRST.items())
            assert error(emitted.constraint_rates(q, any_v), jacobian @ any_v) < 1e-12, one
            assert error(rate, jacobian[: emitted.NP] @ any_v) < DIFFERENCES, one

            there = {k: chart.advance(q, v, a, k * step) for k in FIRST}
            rate = sum(w / step * emitted.constraint_rates(*there[k]) for k, w in FIRST.items())
            expected = jacobian @ a - emitted.constraint_bias(q, v)
            assert error(rate, expected) < 10 * DIFFERENCES, one
            assert error(jacobian @ state.a, emitted.constraint_bias(q, v)) < TOLERANCE, one


@pytest.mark.seeds(FEW, SLICES)
def test_accelerations_agree(seed: int) -> None:
    """Of all mass centres, linear and angular, and the emitted equations hold."""
    for one in cases(seed):
        for state in one.regular:
            found = closed.accelerations(one.system, state.motions)
            assert error(found, state.expected.acceleration) < TOLERANCE, one


@pytest.mark.seeds(FEW, SLICES)
def test_reactions_agree_where_they_are_unique(seed: int) -> None:
    for one in cases(seed):
        places = {name: k for k, name in enumerate(one.emitted.REACTION_NAMES)}
        joints = [joint.name for joint in one.system.joints if joint.kind != "free"]
        order = [places[name + end] for name in joints for end in closed.WRENCH]
        for state in one.regular:
            found = one.emitted.reactions(state.q, state.v, state.u)[order]
            expected = np.concatenate([state.expected.wrenches[name] for name in joints])
            doubts = np.concatenate([state.expected.doubts[name] for name in joints])
            sure = doubts < UNIQUE
            assert not np.any(~sure & (doubts < FREE)), one
            assert error(found[sure], expected[sure]) < TOLERANCE, one


@pytest.mark.parametrize("kind", ["fixed", "revolute", "prismatic", "cylindrical", "planar"])
def test_project_never_turns_a_chord_over(kind: str, tmp_path: Path) -> None:
    """Axes against each other satisfy the same equations; from 120 degrees Newton finds these."""
    model = Model("over")
    body = model.body("b", mass=1.0, inertia=(1.0, 2.0, 3.0))
    model.free("base", between=("ground", body))
    model.add_joint(JOINTS[kind]("chord", ("ground", "b")))
    model.formulation(tree=("base",))
    emitted = load(render(model, languages=["python"], folded=True), "over", tmp_path)
    q = np.array([0.0, 0.0, 0.0, np.sin(np.pi / 3), 0.0, 0.0, np.cos(np.pi / 3)])
    try:
        found, _ = emitted.project(q, np.zeros(6))
    except np.linalg.LinAlgError:
        return
    assert newton_euler.rotation_of_quaternion(found[3:])[2, 2] == pytest.approx(1.0)


@pytest.mark.seeds(
    [seed for first in FEW for seed in (first + 3, first + 8)], range(3, SYSTEMS, 12)
)
def test_emitted_c_agrees_with_emitted_python(seed: int, tmp_path: Path) -> None:
    """One batch in Python, state after state in C."""
    one = case(seed)
    emitted, name = one.emitted, f"closed{seed}"
    model = model_with_its_tree(seed, one.system, name)
    compiled = Compiled(render(model, folded=True, languages=["c"]), name, tmp_path)
    nq, nv, nc = emitted.NQ, emitted.NV, emitted.NC
    states = one.regular[:4]
    q, v, u = (np.array([getattr(s, key) for s in states]) for key in "qvu")
    phi, jacobian, gamma = (
        emitted.constraints(q),
        emitted.constraint_jacobian(q),
        emitted.constraint_bias(q, v),
    )
    a, multipliers = emitted.forward_dynamics(q, v, u)
    reactions = emitted.reactions(q, v, u)
    beside = q + 0.01
    on_q, on_v = emitted.project(beside, v + 0.1)
    for k in range(len(states)):
        call, at = compiled.call, (q[k], v[k], u[k])
        assert error(call("constraints", q[k], out=[(nc,)]), phi[k]) < 1e-13
        assert error(call("constraint_jacobian", q[k], out=[(nc, nv)]), jacobian[k]) < 1e-13
        assert error(call("constraint_bias", *at[:2], out=[(nc,)]), gamma[k]) < 1e-12
        found = call("forward_dynamics", *at, out=[(nv,), (nc,)])
        assert error(found[0], a[k]) < 1e-10
        assert error(found[1], multipliers[k]) < 1e-9
        assert error(call("reactions", *at, out=[reactions[k].shape]), reactions[k]) < 1e-9
        found = call("project", beside[k], v[k] + 0.1, out=[(nq,), (nv,)])
        assert error(found[0], on_q[k]) < 1e-10
        assert error(found[1], on_v[k]) < 1e-10

"""The derivation against the independent Newton-Euler oracle, against itself, and under renaming.

Errors are relative to one plus the largest expected entry. Random trees hold every kind of joint in both
directions, couplings, massless bodies and welds; the larger run on emitted code is test_random_trees.py.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import networkx as nx
import numpy as np
import pytest
import sympy
from oracles import newton_euler as oracle
from support import dag_values
from support.spec_models import model_of
from systems import random_trees as trees

from linegraph import Derivation, Model, derive
from linegraph.algebra.factorization import solve
from linegraph.dynamics import mass_matrix as columns_of_mass
from linegraph.dynamics.articulated import forward_dynamics
from linegraph.dynamics.orthogonality import inverse_dynamics
from linegraph.ir.dag import Dag
from linegraph.kinematics.tree_state import TreeState
from linegraph.numeric.reference import Numeric
from linegraph.paper.joint_form import paper_matrices
from linegraph.programs.register import module_of
from linegraph.programs.request import Request

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.kinematics.links import KinematicTree

Array = Any

TREES, STATES = 100, 3
ALL = pytest.mark.parametrize("seed", range(TREES))
SOME = pytest.mark.parametrize("seed", range(0, TREES, 4))
FEW = pytest.mark.parametrize("seed", range(0, TREES, 10))

EQUATIONS = 1e-13  # measured 1e-14
ENERGY = 1e-13  # measured 1.3e-14
SOLVED = 1e-10  # measured 7e-12 by factors, 1.3e-12 by articulated inertias
SAME_ROUTE = 1e-13  # measured 1e-14
PAPER = 1e-13  # measured 9e-15
POWER = 1e-10  # measured 6e-12: the error of a fourth-order difference
VARIANTS = 1e-12  # measured 2e-13 in the potential energy, 2e-15 in M and h


class Case(NamedTuple):
    """A tree, its derivation, and states: q, v, a a row each."""

    spec: trees.Tree
    derivation: Derivation
    numeric: Numeric
    states: list[tuple[Array, Array, Array]]


@lru_cache(maxsize=TREES)
def case(seed: int) -> Case:
    rng = np.random.default_rng(1000 + seed)
    spec = trees.random_tree(rng, bodies=1 + seed % 8)
    derivation = derive(model_of(spec))
    states = []
    for _ in range(STATES):
        q, v = trees.random_state(rng, spec)
        states.append((q, v, rng.normal(size=spec.nv)))
    return Case(spec, derivation, derivation.numeric(), states)


def floats(a: Array) -> list[float]:
    return [float(x) for x in a]


def error(found: Any, expected: Any) -> float:
    found, expected = np.array(found, dtype=float), np.array(expected, dtype=float)
    assert found.shape == expected.shape
    return float(np.abs(found - expected).max(initial=0) / (1 + np.abs(expected).max(initial=0)))


def at(tree: KinematicTree, q: Array, v: Array) -> TreeState:
    return TreeState(tree, floats(q), floats(v))


# ---- against the oracle


@pytest.mark.one_in(2)
@ALL
def test_equations_are_those_of_newton_and_euler(seed: int) -> None:
    spec, _, numeric, states = case(seed)
    for q, v, a in states:
        mass = numeric.mass_matrix(floats(q))
        assert error(mass, oracle.mass_matrix(spec, q, v)) < EQUATIONS
        assert error(numeric.bias(floats(q), floats(v)), oracle.bias(spec, q, v)) < EQUATIONS
        torque = numeric.inverse_dynamics(floats(q), floats(v), floats(a))
        assert error(torque, oracle.inverse_dynamics(spec, q, v, a)) < EQUATIONS


@ALL
def test_the_mass_matrix_is_symmetric_and_positive_definite(seed: int) -> None:
    _, _, numeric, states = case(seed)
    for q, _, _ in states:
        mass = np.array(numeric.mass_matrix(floats(q)))
        assert np.array_equal(mass, mass.T)
        assert np.linalg.eigvalsh(mass)[0] > 0


@ALL
def test_energy(seed: int) -> None:
    """Kinetic: the oracle's and v M v / 2. Potential: the oracle's less that of another state.

    Bodies welded to ground are left out of the equations, hence the difference.
    """
    spec, _, numeric, states = case(seed)
    (q0, v0, _), *_ = states
    zero = numeric.energy(floats(q0), floats(v0))[1] - oracle.potential_energy(spec, q0)
    for q, v, _ in states:
        kinetic, potential = numeric.energy(floats(q), floats(v))
        assert error(kinetic, oracle.kinetic_energy(spec, q, v)) < ENERGY
        mass = np.array(numeric.mass_matrix(floats(q)))
        assert error(kinetic, v @ mass @ v / 2) < ENERGY
        assert error(potential - zero, oracle.potential_energy(spec, q)) < ENERGY


@ALL
def test_coordinate_rates(seed: int) -> None:
    spec, _, numeric, states = case(seed)
    for q, v, _ in states:
        found = numeric.coordinate_rates(floats(q), floats(v))
        assert error(found, oracle.coordinate_rates(spec, q, v)) < 1e-15


@ALL
def test_a_factored_mass_matrix_solves_for_accelerations(seed: int) -> None:
    spec, _, numeric, states = case(seed)
    outward = outward_order(numeric.tree)
    for q, v, a in states:
        rows = numeric.mass_matrix(floats(q))
        right = floats(np.array(rows) @ a)
        solution = solve(rows, right, outward)
        assert min(solution.pivots) > 0
        assert error(np.array(rows) @ solution.unknowns, right) < EQUATIONS
        tau = oracle.inverse_dynamics(spec, q, v, a)
        h = numeric.bias(floats(q), floats(v))
        accelerations = solve(rows, floats(tau - h), outward).unknowns
        assert error(accelerations, oracle.forward_dynamics(spec, q, v, tau)) < SOLVED


def outward_order(tree: KinematicTree) -> list[int]:
    return list(dict.fromkeys(f.index for link in tree.links for f in link.velocities))


@ALL
def test_the_mass_matrix_has_the_pattern_of_the_tree(seed: int) -> None:
    """M, and so its factor L, has no entry for joints of which neither carries the other."""
    tree = case(seed).numeric.tree
    size = len(tree.velocities)
    carried_by = ancestors(tree)
    related = [
        [bool(carried_by[i] & carried_by[j] & {i, j}) for j in range(size)] for i in range(size)
    ]
    if tree.coupled:
        return
    q, _, _ = case(seed).states[0]
    mass = np.array(case(seed).numeric.mass_matrix(floats(q)))
    assert not mass[~np.array(related)].any()


def ancestors(tree: KinematicTree) -> list[set[int]]:
    """For each velocity those of its own joint and of the joints between it and ground."""
    above: list[set[int]] = []
    found: dict[int, set[int]] = {}
    for link in tree.links:
        own = {freedom.index for freedom in link.velocities}
        above.append(own | (above[link.parent] if link.parent >= 0 else set()))
        found.update(dict.fromkeys(own, above[-1]))
    return [found[k] for k in range(len(tree.velocities))]


@ALL
def test_articulated_inertias_solve_for_accelerations(seed: int) -> None:
    spec, _, numeric, states = case(seed)
    if spec.couplings:
        return  # articulated inertias are not for coupled joints; most trees have none
    for tree in (numeric.tree, numeric.tree.regrouped()):
        for q, v, a in states:
            tau = oracle.inverse_dynamics(spec, q, v, a)
            solution = forward_dynamics(at(tree, q, v), floats(tau))
            assert error(solution.unknowns, a) < SOLVED
            assert min(solution.pivots) > 0


def test_trees_with_couplings_know_it() -> None:
    coupled = [case(seed).numeric.tree.coupled for seed in range(TREES)]
    assert coupled == [bool(case(seed).spec.couplings) for seed in range(TREES)]
    assert 10 < sum(coupled) < TREES / 2


@ALL
def test_a_regrouped_tree_has_the_same_equations(seed: int) -> None:
    _, _, numeric, states = case(seed)
    short = Numeric(numeric.tree.regrouped())
    for q, v, a in states:
        mass = numeric.mass_matrix(floats(q))
        assert error(short.mass_matrix(floats(q)), mass) < SAME_ROUTE
        torque = numeric.inverse_dynamics(floats(q), floats(v), floats(a))
        found = short.inverse_dynamics(floats(q), floats(v), floats(a))
        assert error(found, torque) < EQUATIONS


@ALL
def test_columns_carried_by_frames_or_in_ground_are_the_same(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    spec, _, numeric, states = case(seed)
    for cheaper in (True, False):
        monkeypatch.setattr(columns_of_mass, "ground_is_cheaper", lambda *_, c=cheaper: c)
        for q, v, _ in states:
            expected = oracle.mass_matrix(spec, q, v)
            assert error(numeric.mass_matrix(floats(q)), expected) < EQUATIONS


@ALL
def test_inverse_dynamics_is_mass_matrix_times_acceleration_plus_bias(seed: int) -> None:
    _, _, numeric, states = case(seed)
    for q, v, a in states:
        mass, bias = numeric.mass_matrix(floats(q)), numeric.bias(floats(q), floats(v))
        torque = numeric.inverse_dynamics(floats(q), floats(v), floats(a))
        assert error(torque, np.array(mass) @ a + bias) < SAME_ROUTE


@SOME
def test_energy_grows_by_the_power_of_the_forces(seed: int) -> None:
    spec, _, numeric, states = case(seed)
    step = 1e-3
    q, v, a = states[0]
    rate = 0.0
    for shift, weight in ((-2, 1), (-1, -8), (1, 8), (2, -1)):
        there = oracle.advance(spec, q, v, a, shift * step)
        rate += weight * sum(numeric.energy(*map(floats, there))) / (12 * step)
    power = float(np.dot(numeric.inverse_dynamics(floats(q), floats(v), floats(a)), v))
    assert abs(rate - power) < POWER * (1 + abs(power) + sum(map(abs, numeric.energy(q, v))))


# ---- the same mechanism said otherwise

CHANGES: dict[str, Callable[[trees.Tree, np.random.Generator], trees.Variant]] = {
    "renamed": lambda tree, rng: trees.renamed(tree),
    "reordered": trees.reordered,
    "reversed_joints": trees.reversed_joints,
    "rebased": trees.rebased,
}


@pytest.mark.parametrize("change", CHANGES)
@SOME
def test_another_description_has_the_same_equations(seed: int, change: str) -> None:
    spec, _, numeric, states = case(seed)
    variant = CHANGES[change](spec, np.random.default_rng(seed))
    other = derive(model_of(variant.tree)).numeric()
    order = variant.velocity_order
    shifts = []
    for q, v, _ in states:
        there = floats(q[variant.coordinate_order]), floats(v[order])
        mass = np.array(numeric.mass_matrix(floats(q)))
        assert error(other.mass_matrix(there[0]), mass[np.ix_(order, order)]) < VARIANTS
        bias = np.array(numeric.bias(floats(q), floats(v)))
        assert error(other.bias(*there), bias[order]) < VARIANTS
        kinetic, potential = numeric.energy(floats(q), floats(v))
        found = other.energy(*there)
        assert error(found[0], kinetic) < VARIANTS
        shifts.append(found[1] - potential)
    assert error(shifts, [shifts[0]] * STATES) < VARIANTS


@SOME
def test_declared_order_is_the_order_of_coordinates(seed: int) -> None:
    spec, _, numeric, _ = case(seed)
    owners = {name: joint.name for joint in spec.active for name in names_of(joint)}
    listed = [quantity.name for quantity in numeric.tree.velocities]
    assert [owners[name] for name in listed] == [
        joint.name for joint in spec.active for _ in names_of(joint)
    ]


def names_of(joint: trees.Joint) -> list[str]:
    suffixes = {"planar": ("_vx", "_vy", "_wz"), "free": ("_vx", "_vy", "_vz", "_wx", "_wy", "_wz")}
    return [f"{joint.name}{suffix}" for suffix in suffixes.get(joint.kind, ("",))]


# ---- the paper's matrices


@ALL
def test_the_papers_matrices_multiplied_out_are_the_recursive_route(seed: int) -> None:
    _, _, numeric, states = case(seed)
    for q, v, _ in states:
        paper = paper_matrices(at(numeric.tree, q, v))
        assert error(paper.A, numeric.mass_matrix(floats(q))) < PAPER
        assert error([-b for b in paper.B], numeric.bias(floats(q), floats(v))) < PAPER


@ALL
def test_P_times_H_is_one_and_H_holds_the_paths(seed: int) -> None:
    """H_kj = 1 where joint k lies between ground and body j: the ancestors that networkx finds."""
    tree = case(seed).numeric.tree
    q, v, _ = case(seed).states[0]
    state = at(tree, q, v)
    paper = paper_matrices(state)
    p, h = np.array(paper.P), np.array(paper.H)
    size = len(tree.links)
    assert np.array_equal(p @ h, np.eye(size))
    assert set(h.flat) <= {0, 1}
    graph = nx.DiGraph()
    graph.add_nodes_from(range(size))
    graph.add_edges_from((link.parent, j) for j, link in enumerate(tree.links) if link.parent >= 0)
    for j in range(size):
        assert set(np.flatnonzero(h[:, j])) == nx.ancestors(graph, j) | {j}


def test_the_papers_equations_in_matrix_form() -> None:
    """(13) and (15): A = (S H) I (S H)^T + Lambda (H m H^T) Lambda^T, assembled here with numpy.

    Masses, centres and central inertias come from the oracle, so only S, H, C, K are the library's.
    """
    rng = np.random.default_rng(3)
    for _ in range(10):
        spec = trees.random_tree(
            rng, 5, kinds=("revolute", "prismatic"), couplings=False, massless=False
        )
        tree = derive(model_of(spec)).numeric().tree
        q, v = trees.random_state(rng, spec)
        state = at(tree, q, v)
        paper = paper_matrices(state)
        s, k, c = (np.array(m, dtype=float) for m in (paper.S, paper.K, paper.C))
        h = np.array(paper.H, dtype=float)
        centers = {body.name: (body, m) for body, m in oracle.mass_centers(spec, q, v)}
        bodies = [centers[link.name] for link in tree.links]
        masses = np.diag([body.mass for body, _ in bodies])
        inertias = [m.rotation @ body.inertia @ m.rotation.T for body, m in bodies]
        sh = np.einsum("ajx,ji->aix", s, h)
        hc = np.einsum("ji,ikx->jkx", h, c)
        lever = np.cross(s[:, :, None, :], hc[None, :, :, :]).sum(axis=1) + k
        a = sum(sh[:, i] @ inertias[i] @ sh[:, i].T for i in range(len(bodies)))
        a = a + np.einsum("aix,ij,bjx->ab", lever, h @ masses @ h.T, lever)
        assert error(a, oracle.mass_matrix(spec, q, v)) < PAPER
        # every mass centre is the sum of the arms along its path, after the basement's own arm
        along = c.sum(axis=0)
        for i, (_, center) in enumerate(bodies):
            root = next(j for j, link in enumerate(tree.links) if h[j, i] and link.parent < 0)
            assert error(h[:, i] @ along + state.arms[root].at, center.origin) < PAPER


# ---- the three algebras


@FEW
def test_programs_over_the_dag_have_the_numbers_of_the_floats(seed: int) -> None:
    spec, derivation, numeric, states = case(seed)
    module = module_of(derivation, "m", Request(folded=True))
    actuated = [velocity for velocity, _ in numeric.tree.layout.efforts]
    for q, v, a in states:
        q_, v_, a_ = floats(q), floats(v), floats(a)
        mass = numeric.mass_matrix(q_)
        both = dag_values.run(module, "equations", q=q_, v=v_)
        assert error(both["M"], np.ravel(mass)) < SAME_ROUTE
        assert error(both["h"], numeric.bias(q_, v_)) < EQUATIONS
        assert dag_values.run(module, "mass_matrix", q=q_)["M"] == both["M"]
        alone = dag_values.run(module, "bias", q=q_, v=v_)["h"]
        assert error(alone, both["h"]) < EQUATIONS  # beside M it may come from composites
        tau = dag_values.run(module, "inverse_dynamics", q=q_, v=v_, a=a_)["tau"]
        assert error(tau, numeric.inverse_dynamics(q_, v_, a_)) < EQUATIONS
        energy = dag_values.run(module, "energy", q=q_, v=v_)["E"]
        assert error(energy, numeric.energy(q_, v_)) < SAME_ROUTE
        rates = dag_values.run(module, "coordinate_rates", q=q_, v=v_)["qdot"]
        assert error(rates, oracle.coordinate_rates(spec, q, v)) < 1e-15
        efforts = np.zeros(spec.nv)
        efforts[actuated] = a[actuated]
        found = dag_values.run(module, "forward_dynamics", q=q_, v=v_, u=floats(a[actuated]))["a"]
        assert error(found, oracle.forward_dynamics(spec, q, v, efforts)) < SOLVED


LABELS = {
    "mass_matrix": {"carried by turn -> arm", "mass matrix, swing -> rod"},
    "bias": {"joint swing", "motion, turn -> arm", "forces, swing -> rod"},
    "inverse_dynamics": {"forces, x -> cart"},
    "energy": {"kinetic energy, swing -> rod", "potential energy, x -> cart"},
    "coordinate_rates": set(),
}


@pytest.mark.parametrize("name", LABELS)
def test_nodes_are_labelled_with_the_part_they_were_derived_for(name: str) -> None:
    """What comments in emitted code are made of: no operation without a label."""
    module = module_of(derive(symbolic_model()), "m", Request(folded=True))
    program = next(program for program in module.programs if program.name == name)
    roots = [entry for result in program.results for entry in result.entries]
    labels = {n.label for n in dag_values.reached(roots) if n.op not in ("symbol", "neg")}
    assert labels >= LABELS[name]
    assert all(label.endswith(("x", "turn", "swing", "cart", "arm", "rod")) for label in labels)


def test_articulated_inertias_label_their_nodes() -> None:
    dag = Dag()
    tree = derive(symbolic_model()).tree(dag, dict.fromkeys(symbolic_model().parameters, 1.5))
    q, v, u = ([dag.symbol(name, i) for i in range(3)] for name in "qvu")
    solution = forward_dynamics(TreeState(tree, q, v), u)
    labels = {n.label for n in dag_values.reached(solution.unknowns) if n.op != "symbol"}
    assert {"articulated inertia, swing -> rod", "accelerations, turn -> arm"} <= labels


def symbolic_model() -> Model:
    """A cart, an arm turning on it and a rod hung crosswise on the arm, every number a parameter."""
    model = Model("three", gravity=(0, 0, 0))
    p = {
        name: model.parameter(name, 0.3 + 0.17 * k)
        for k, name in enumerate(("g", "m1", "m2", "m3", "l", "c2", "c3", "Jx", "Jy", "Jz", "Jxz"))
    }
    model.gravity = (0, 0, -p["g"])
    inertia = {"xx": p["Jx"], "yy": p["Jy"], "zz": p["Jz"], "xz": p["Jxz"]}
    cart = model.body("cart", mass=p["m1"])
    arm = model.body("arm", mass=p["m2"], mass_center=(p["c2"], 0, 0), inertia=inertia)
    rod = model.body("rod", mass=p["m3"], mass_center=(0, p["c3"], 0), inertia=inertia)
    tip = arm.frame("tip", at=(p["l"], 0, 0), rpy=(0, 0, np.pi / 2))
    model.prismatic("x", between=("ground", cart), axis=(1, 0, 0))
    model.revolute("turn", between=(cart, arm), axis=(0, 1, 0))
    model.revolute("swing", between=(rod, tip), axis=(1, 0, 0))
    return model


@lru_cache(maxsize=1)
def symbolic_case() -> tuple[Derivation, dict[Any, Any], list[float], list[float]]:
    """The derivation, exact rational numbers for every symbol, and the same as floats."""
    derivation = derive(symbolic_model())
    symbolic = derivation.symbolic
    q = [sympy.Rational(k, 7) for k in (3, -5, 8)]
    v = [sympy.Rational(k, 9) for k in (-4, 13, 6)]
    numbers = dict(zip([*symbolic.q, *symbolic.v], [*q, *v], strict=True))
    for parameter in derivation.system.parameters.values():
        assert parameter.value is not None
        numbers[sympy.Symbol(parameter.name)] = sympy.Rational(parameter.value)
    return derivation, numbers, [float(x) for x in q], [float(x) for x in v]


def precise(expression: Any, numbers: dict[Any, Any]) -> Any:
    return sympy.sympify(expression, strict=True).evalf(30, subs=numbers)


def test_closed_forms_at_thirty_digits_are_the_numbers_of_the_floats() -> None:
    derivation, numbers, q, v = symbolic_case()
    symbolic, numeric = derivation.symbolic, derivation.numeric()
    mass = symbolic.mass_matrix.applyfunc(lambda e: precise(e, numbers))
    bias = symbolic.bias.applyfunc(lambda e: precise(e, numbers))
    assert error(mass.tolist(), numeric.mass_matrix(q)) < 1e-15
    assert error([b for (b,) in bias.tolist()], numeric.bias(q, v)) < 1e-15
    energy = [precise(e, numbers) for e in symbolic.energy]
    assert error(energy, numeric.energy(q, v)) < 1e-15


def test_simplifying_and_multiplying_out_changes_no_digit() -> None:
    """The paper's matrices over sympy, not simplified, against the simplified closed forms."""
    derivation, numbers, _, _ = symbolic_case()
    symbolic = derivation.symbolic
    paper = symbolic.paper_matrices
    pairs = [
        *zip(symbolic.mass_matrix, [e for row in paper.A for e in row], strict=True),
        *zip(symbolic.bias, [-b for b in paper.B], strict=True),
    ]
    for found, expected in pairs:
        assert abs(precise(found, numbers) - precise(expected, numbers)) < sympy.Float("1e-26")


def test_the_bias_follows_from_the_energy() -> None:
    """Lagrange's equations of the symbolic energies: an independent route to M and h."""
    derivation, numbers, _, _ = symbolic_case()
    symbolic = derivation.symbolic
    kinetic, potential = symbolic.energy
    for i, (qi, vi) in enumerate(zip(symbolic.q, symbolic.v, strict=True)):
        momentum = sympy.diff(kinetic, vi)
        for j, vj in enumerate(symbolic.v):
            difference = sympy.diff(momentum, vj) - symbolic.mass_matrix[i, j]
            assert abs(precise(difference, numbers)) < sympy.Float("1e-26")
        moved = sum(
            sympy.diff(momentum, qj) * vj for qj, vj in zip(symbolic.q, symbolic.v, strict=True)
        )
        h = moved - sympy.diff(kinetic, qi) + sympy.diff(potential, qi)
        assert abs(precise(h - symbolic.bias[i], numbers)) < sympy.Float("1e-26")


def test_the_names_of_the_symbols() -> None:
    symbolic = symbolic_case()[0].symbolic
    assert [str(s) for s in symbolic.q] == ["x", "turn", "swing"]
    assert [str(s) for s in symbolic.v] == ["x_dot", "turn_dot", "swing_dot"]
    model = Model("m")
    model.free("root", between=("ground", model.body("b", mass=1, inertia=(1, 1, 1))))
    symbolic = derive(model).symbolic
    assert [str(s) for s in symbolic.q][:4] == ["root_x", "root_y", "root_z", "root_qx"]
    assert [str(s) for s in symbolic.v] == [
        f"root_{c}" for c in ("vx", "vy", "vz", "wx", "wy", "wz")
    ]


# ---- the generator


def test_the_trees_drawn_reach_every_feature() -> None:
    links = [
        (link.joint.kind, link.outward)
        for seed in range(TREES)
        for link in oracle.outward_links(case(seed).spec)
    ]
    assert set(links) == {(kind, way) for kind in trees.KINDS for way in (True, False)}
    assert any(body.mass == 0 for seed in range(TREES) for body in case(seed).spec.bodies)
    assert any(len(case(seed).spec.couplings) > 1 for seed in range(TREES))


def test_deriving_twice_gives_equal_bits() -> None:
    spec, _, numeric, ((q, v, _), *_) = case(7)
    again = derive(model_of(spec)).numeric()
    assert again.mass_matrix(floats(q)) == numeric.mass_matrix(floats(q))
    assert again.bias(floats(q), floats(v)) == numeric.bias(floats(q), floats(v))


def test_a_derivation_over_nodes_is_the_same_twice() -> None:
    spec = case(7).spec

    def listing() -> list[tuple[Any, ...]]:
        dag = Dag()
        tree = derive(model_of(spec)).tree(dag, {})
        q = [dag.symbol("q", i) for i in range(spec.nq)]
        v = [dag.symbol("v", i) for i in range(spec.nv)]
        roots = inverse_dynamics(TreeState(tree, q, v))
        return [(n.index, n.op, repr(n.a), repr(n.b), n.label) for n in dag_values.reached(roots)]

    assert listing() == listing()

"""Emitted code on random trees against an independent Newton-Euler formulation.

108 trees, or 300 with ``--all-forms``, at 20 states, of which every third is compared with the formulation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from oracles import newton_euler as oracle
from support.compiled import Compiled
from support.emitted import load
from support.spec_models import model_of
from systems import random_trees as trees

from linegraph.emission.emit import render

if TYPE_CHECKING:
    from pathlib import Path

TREES, STATES, BATCH = 300, 20, 12
EVERY = range(0, TREES, BATCH)
FEW = EVERY[::13]
"""Where batches of trees begin, one of each size from 1 to 12 bodies."""

TOLERANCE = (
    1e-10  # relative to 1 + the largest expected entry; measured 3e-12, forward dynamics 4e-11
)

EXACT = 1e-12  # of reactions; measured 6e-14
AUDIT = 1e-11  # of sums over all edges, relative to the largest power


def draw(seed: int) -> tuple[trees.Tree, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A tree of 1 to 12 bodies and its states q, v, a, tau, one a row."""
    rng = np.random.default_rng(seed)
    tree = trees.random_tree(rng, bodies=1 + seed % 12)
    states = [trees.random_state(rng, tree) for _ in range(STATES)]
    q, v = (np.array([state[k] for state in states]) for k in (0, 1))
    return tree, q, v, rng.normal(size=v.shape), rng.normal(size=v.shape)


def error(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.max(np.abs(found - expected)) / (1 + np.max(np.abs(expected))))


def inputs_of(tree: trees.Tree, tau: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Inputs u, and the efforts Q(u) they are: a free joint carries none."""
    actuated = np.ones(tree.nv, dtype=bool)
    for joint in tree.active:
        if joint.kind == "free":
            actuated[tree.velocity_slices[joint.name]] = False
    return tau[..., actuated], tau * actuated


@pytest.mark.seeds(FEW, EVERY)
def test_emitted_python_agrees_with_newton_euler(seed: int, tmp_path: Path) -> None:
    for number in range(seed, seed + BATCH):
        tree, q, v, a, tau = draw(number)
        model = model_of(tree, f"tree{number}")
        files = render(model, languages=["python"], functions=("power",))
        emitted = load(files, f"tree{number}", tmp_path)
        u, efforts = inputs_of(tree, tau)

        mass, bias = emitted.equations(q, v)
        torque = emitted.inverse_dynamics(q, v, a)
        acceleration = emitted.forward_dynamics(q, v, u)
        energy = emitted.energy(q, v)
        found = emitted.reactions_at(q, v, a).reshape(STATES, -1, 2, 3)
        powers, sums = emitted.power(q, v, u)
        names = [name[:-3] for name in emitted.REACTION_NAMES[::6]]
        assert np.abs(sums).max() <= AUDIT * (1 + np.abs(powers).max()), number

        assert np.array_equal(mass, np.swapaxes(mass, -1, -2))
        # the two may add their terms in another order
        assert error(emitted.mass_matrix(q), mass) < 1e-15
        assert error(emitted.bias(q, v), bias) < 1e-13
        assert np.all(np.linalg.eigvalsh(mass) > 0)
        assert error(energy[:, 0], np.einsum("ki,kij,kj->k", v, mass, v) / 2) < 1e-12
        for k in range(0, STATES, 3):
            expected_mass = oracle.mass_matrix(tree, q[k], v[k])
            expected_bias = oracle.bias(tree, q[k], v[k])
            assert error(mass[k], expected_mass) < TOLERANCE, number
            assert error(bias[k], expected_bias) < TOLERANCE, number
            expected = oracle.inverse_dynamics(tree, q[k], v[k], a[k])
            assert error(torque[k], expected) < TOLERANCE, number
            expected = np.linalg.solve(expected_mass, efforts[k] - expected_bias)
            assert error(acceleration[k], expected) < TOLERANCE, number
        for k in range(0, STATES, 4):
            reactions = oracle.reactions(tree, q[k], v[k], a[k])
            scale = 1 + max(np.abs(x).max() for x in reactions.values())
            for name, wrench in zip(names, found[k], strict=True):
                assert np.abs(wrench - reactions[name]).max() < EXACT * scale, (number, name)
        for k in range(2):
            assert error(energy[k, 0], oracle.kinetic_energy(tree, q[k], v[k])) < TOLERANCE
            rates = emitted.coordinate_rates(q[k], v[k])
            assert error(rates, oracle.coordinate_rates(tree, q[k], v[k])) < TOLERANCE


@pytest.mark.seeds(range(0, 144, 24), range(0, 300, 12))
def test_emitted_c_agrees_with_emitted_python(seed: int, tmp_path: Path) -> None:
    """The same operations in the same order: equal to a few units in the last place."""
    tree, q, v, a, tau = draw(seed + seed // 12 % 12)
    only = ("equations", "inverse_dynamics", "forward_dynamics")
    files = render(model_of(tree, "tree"), only=only)
    emitted, compiled = load(files, "tree", tmp_path), Compiled(files, "tree", tmp_path)
    u, _ = inputs_of(tree, tau)
    n = tree.nv
    for k in range(3):
        mass, bias = compiled.call("equations", q[k], v[k], out=[(n, n), (n,)])
        expected_mass, expected_bias = emitted.equations(q[k], v[k])
        assert error(mass, expected_mass) < 1e-14
        assert error(bias, expected_bias) < 1e-13
        torque = compiled.call("inverse_dynamics", q[k], v[k], a[k], out=[(n,)])
        assert error(torque, emitted.inverse_dynamics(q[k], v[k], a[k])) < 1e-13
        acceleration = compiled.call("forward_dynamics", q[k], v[k], u[k], out=[(n,)])
        assert error(acceleration, emitted.forward_dynamics(q[k], v[k], u[k])) < 1e-11


@pytest.mark.seeds(range(0, 20, 4), range(20))
def test_power_balance(seed: int, tmp_path: Path) -> None:
    """d(T + U)/dt = tau . v along the motion, by a fourth-order difference of the emitted energy."""
    tree, q, v, a, _ = draw(seed)
    only = ("energy", "inverse_dynamics")
    files = render(model_of(tree, "tree"), languages=["python"], only=only)
    emitted = load(files, "tree", tmp_path)
    step = 1e-3
    weights = {-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}
    for k in range(5):
        rate = 0.0
        for shift, weight in weights.items():
            there = oracle.advance(tree, q[k], v[k], a[k], shift * step)
            rate += weight * float(np.sum(emitted.energy(*there))) / step
        power = float(emitted.inverse_dynamics(q[k], v[k], a[k]) @ v[k])
        assert abs(rate - power) < 1e-7 * (1 + abs(power))

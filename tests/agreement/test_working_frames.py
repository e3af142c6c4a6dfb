"""Working frames, regrouped moments, composite bias and articulated inertias: the same numbers, fewer steps.

Everything is compared with the derivation in the frames of the walk, from the bodies' own moments, by the
recursion over single links: the one that nothing has been done to.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from conformance.test_joints import KINDS, pair, pair_state
from oracles.pinocchio_models import robots_folder
from support.emitted import load
from support.spec_models import model_of
from systems import random_trees as trees

from linegraph import Model, derive
from linegraph.algebra.protocol import Floats
from linegraph.dynamics.applied_forces import Applied
from linegraph.dynamics.articulated import forward_dynamics
from linegraph.dynamics.composite_bias import bias_beside_mass
from linegraph.dynamics.mass_matrix import mass_matrix
from linegraph.dynamics.orthogonality import inverse_dynamics
from linegraph.emission.emit import render
from linegraph.kinematics.tree_state import TreeState
from linegraph.kinematics.working_frames import shortened
from linegraph.readers import urdf
from linegraph.spatial.vector import ZERO

if TYPE_CHECKING:
    from pathlib import Path

    from linegraph.kinematics.links import KinematicTree

SAME = 1e-12  # measured 3e-13 at worst, mostly 1e-14
ROUNDING = 1e-14  # of robots


def error(found: Any, expected: Any) -> float:
    found, expected = np.array(found, dtype=float), np.array(expected, dtype=float)
    return float(np.abs(found - expected).max(initial=0) / (1 + np.abs(expected).max(initial=0)))


def compare(tree: KinematicTree, q: Any, v: Any, a: Any) -> float:
    """The largest relative error of M, both forms of h, inverse dynamics and, where M allows, v̇."""
    q, v, a = ([float(x) for x in y] for y in (q, v, a))
    plain, short = (TreeState(t, q, v) for t in (tree, shortened(tree).tree))
    nothing = Applied([(ZERO, ZERO)] * len(short.tree.links), [0] * len(tree.velocities))
    m = np.array(mass_matrix(plain), dtype=float)
    h = inverse_dynamics(plain)
    tau = inverse_dynamics(plain, a)
    errors = [
        error(mass_matrix(short), m),
        error(inverse_dynamics(short), h),
        error(bias_beside_mass(short, nothing), h),
        error(inverse_dynamics(short, a), tau),
    ]
    if not short.tree.coupled and len(a):
        solved = forward_dynamics(short, tau).unknowns
        errors.append(error(solved, a) / max(1.0, 1e-2 * np.linalg.cond(m)))
    return max(errors)


def chain(count: int, rng: np.random.Generator, twist: str) -> Model:
    """Hinges one after the other, forward and reversed, whose axes are in a run, normal, or any."""
    model = Model("chain", gravity=tuple(rng.normal(size=3)))
    before: Any = model.ground
    for i in range(count):
        turn = {
            "any": tuple(rng.uniform(-3, 3, size=3)),
            "run": (float(rng.choice([0.0, math.pi])), 0.0, rng.uniform(-3, 3)),
            "normal": (math.pi / 2 * rng.integers(4), 0.0, math.pi / 2 * rng.integers(4)),
            "mixed": (float(rng.choice([0.0, 0.0, 1.1])), 0.0, rng.uniform(-3, 3)),
        }[twist]
        tip = before.frame(f"tip{i}", at=tuple(rng.normal(size=3)), rpy=turn)
        body = model.body(
            f"b{i}",
            mass=rng.uniform(0.5, 2),
            mass_center=tuple(rng.normal(size=3)),
            inertia=(1.0, 1.2, 0.9),
        )
        ends = (tip, body) if rng.random() < 0.5 else (body, tip)
        model.revolute(f"j{i}", between=ends, axis=(0, 0, 1))
        # now and then a branch: the next one goes on from an earlier body
        before = body if rng.random() < 0.8 else before
    return model


@pytest.mark.parametrize("seed", range(0, 100, 2))
def test_random_trees(seed: int) -> None:
    rng = np.random.default_rng(4000 + seed)
    spec = trees.random_tree(rng, bodies=1 + seed % 9)
    tree = derive(model_of(spec)).tree(Floats(), {})
    for _ in range(2):
        q, v = trees.random_state(rng, spec)
        assert compare(tree, q, v, rng.normal(size=spec.nv)) < SAME  # measured 3e-13


@KINDS
@pytest.mark.parametrize("forward", [True, False])
def test_every_kind_of_joint(kind: str, forward: bool) -> None:
    rng = np.random.default_rng(5)
    tree = derive(pair(kind, forward, rng)).tree(Floats(), {})
    q, v = pair_state(tree, rng)
    assert compare(tree, q, v, rng.normal(size=len(v))) < SAME


@pytest.mark.parametrize("twist", ["any", "run", "normal", "mixed"])
@pytest.mark.parametrize("seed", range(8))
def test_runs_of_axes(twist: str, seed: int) -> None:
    rng = np.random.default_rng([seed, len(twist)])
    tree = derive(chain(8, rng, twist)).tree(Floats(), {})
    n = len(tree.velocities)
    q, v, a = rng.uniform(-3, 3, n), rng.normal(size=n), rng.normal(size=n)
    assert compare(tree, q, v, a) < SAME
    if twist == "run":
        assert all(link.in_plane for link in shortened(tree).tree.links)


@pytest.mark.parametrize("lean", [1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 0.05, 0.11])
def test_axes_that_are_almost_parallel_lose_no_digits(lean: float) -> None:
    """Where two axes meet at a small angle, neither their plane nor their nearest points are known well."""
    rng = np.random.default_rng(7)
    model = Model("leaning", snap=0)
    before: Any = model.ground
    for i in range(5):
        tip = before.frame("tip", at=(0.3, 0.2, 0.5), rpy=(lean, 0.3 * lean, 0.4))
        before = model.body(f"b{i}", mass=1.0, mass_center=(0.1, 0.2, 0.3), inertia=(1, 2, 2.5))
        model.revolute(f"j{i}", between=(tip, before), axis=(0, 0, 1))
    tree = derive(model).tree(Floats(), {})
    assert compare(tree, rng.normal(size=5), rng.normal(size=5), rng.normal(size=5)) < 1e-13


def test_frames_are_slid_turned_and_still() -> None:
    """A hinge about y, then two about x: offsets along an axis end in ground."""
    model = Model("leg")
    hip = model.body("hip", mass=1, mass_center=(0.1, 0, 0), inertia=(1, 2, 2.5))
    thigh = model.body("thigh", mass=1, mass_center=(0.1, 0, -0.2), inertia=(1, 2, 2.5))
    shank = model.body("shank", mass=1, mass_center=(0, 0.01, -0.2), inertia=(1, 2, 2.5))
    model.revolute("a", between=("ground", hip), axis=(0, 1, 0))
    model.revolute("b", between=(hip.frame("b", at=(0.2, 0.1, 0)), thigh), axis=(1, 0, 0))
    model.revolute("c", between=(thigh.frame("c", at=(0.05, 0, -0.4)), shank), axis=(1, 0, 0))
    walk = derive(model).tree(Floats(), {})
    found = shortened(walk)
    counted = [sum(x != 0 for x in link.at) for link in walk.links]
    assert counted == [0, 2, 2]
    assert [sum(x != 0 for x in link.at) for link in found.tree.links] == [1, 0, 1]
    assert [link.still for link in found.tree.links] == [False, True, False]
    # what is slid is known, so that loads find their place
    assert any(pose.at != ZERO for pose in found.poses)


def test_the_first_joints_of_a_fixed_arm_keep_one_inertia() -> None:
    """A link that can only turn about one direction of ground has no more than its inertia about that."""
    rng = np.random.default_rng(0)
    tree = derive(chain(3, rng, "run")).tree(Floats(), {})
    for link in shortened(tree).tree.links:
        assert link.moments.second[1:] == (0, 0, 0, 0, 0)
        assert link.moments.inertia[5] == link.moments.second[0] > 0


ROBOTS = {
    "ur5": ("ur_description/urdf/ur5_robot.urdf", "fixed"),
    "panda": ("panda_description/urdf/panda.urdf", "fixed"),
    "solo12": ("solo_description/robots/solo12.urdf", "floating"),
    "anymal": ("anymal_b_simple_description/robots/anymal.urdf", "floating"),
    "talos": ("talos_data/robots/talos_reduced.urdf", "floating"),
}


@pytest.mark.parametrize("name", ROBOTS)
def test_what_robots_are_emitted_as(name: str, tmp_path: Path) -> None:
    """The emitted functions beside the derivation in the frames of the walk; measured 6e-16."""
    folder = robots_folder()
    if folder is None:
        pytest.skip("the example-robot-data wheel is not installed")
    file, base = ROBOTS[name]
    model = urdf.read(folder / file, base=base)
    plain = derive(model).numeric()
    only = ("equations", "bias", "inverse_dynamics", "forward_dynamics")
    emitted = load(
        render(model, name=name, folded=True, languages=["python"], only=only), name, tmp_path
    )
    rng = np.random.default_rng(0)
    for _ in range(5):
        q = rng.uniform(-2, 2, len(plain.tree.positions)).tolist()
        plain.tree.normalise(q)
        v, a = (rng.normal(size=len(plain.tree.velocities)) for _ in "va")
        u = rng.normal(size=len(plain.tree.inputs))
        m = np.array(plain.mass_matrix(q))
        h = np.array(plain.bias(q, v.tolist()))
        found, bias = emitted.equations(q, v)
        assert relative(found, m) < ROUNDING
        assert relative(bias, h) < ROUNDING
        assert relative(emitted.bias(q, v), h) < ROUNDING
        assert relative(emitted.inverse_dynamics(q, v, a), m @ a + h) < 10 * ROUNDING
        effort = np.zeros(len(v))
        effort[len(v) - len(u) :] = u
        solved = np.linalg.solve(m, effort - h)
        assert relative(emitted.forward_dynamics(q, v, u), solved) < 1e-12  # cond(M) 8e4 at most


def relative(found: Any, expected: Any) -> float:
    return float(np.abs(found - expected).max() / np.abs(expected).max())

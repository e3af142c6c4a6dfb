"""Energy, exactly differentiated: the power balance and the skewness of dM/dt - 2C.

Rates come from calculating with jets, so that nothing here is a difference quotient.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.spec_models import model_of
from systems import random_systems as systems
from systems import random_trees as trees

from linegraph import Model, derive
from linegraph.algebra.jets import Jet, Jets
from linegraph.algebra.protocol import Floats
from linegraph.dynamics.mass_matrix import mass_matrix
from linegraph.dynamics.orthogonality import inverse_dynamics
from linegraph.kinematics.tree_state import TreeState
from linegraph.verification.checking import check


@pytest.mark.seeds(range(0, 80, 12), range(0, 80, 2))
def test_power_balance(seed: int) -> None:
    """d(T + U)/dt = power of all that is applied; worst measured 2e-13."""
    findings = check(derive(systems.random_system(seed).model), seed)
    assert findings.program < 1e-12
    assert findings.paper < 1e-11
    if findings.power is not None:
        assert findings.power < 1e-11


def test_power_is_judged_where_nothing_is_prescribed() -> None:
    judged = [seed for seed in range(0, 20, 2) if _power(seed) is not None]
    assert len(judged) >= 5


def _power(seed: int) -> float | None:
    return check(derive(systems.random_system(seed).model), seed).power


@pytest.mark.seeds(range(0, 40, 6), range(40))
def test_mass_matrix_rate_less_twice_coriolis_is_skew_along_v(seed: int) -> None:
    rng = np.random.default_rng(seed)
    tree = trees.random_tree(rng, bodies=1 + seed % 8)
    q, v = (list(map(float, x)) for x in trees.random_state(rng, tree))
    assert skew_defect(model_of(tree), q, v) < 1e-12


@pytest.mark.seeds(range(0, 80, 12), range(0, 80, 2))
def test_the_same_with_every_joint(seed: int) -> None:
    """Systems of all kinds of joints, couplings and rotors; elements left out, prescribed motion skipped."""
    system = systems.random_system(seed)
    structure = derive(system.model).structure
    if any(place.drive for place in structure.layout.places.values()):
        pytest.skip("prescribed motion does work")
    rng = np.random.default_rng(seed)
    q = list(map(float, rng.uniform(-1, 1, len(structure.positions))))
    structure.normalise(q)
    v = list(map(float, rng.uniform(-1, 1, len(structure.velocities))))
    assert skew_defect(system.model, q, v) < 1e-12


def skew_defect(model: Model, q: list[float], v: list[float]) -> float:
    """v^T (dM/dt - 2C) v = 0: the velocity terms of the bias do half the work of dM/dt."""
    model.gravity = (0, 0, 0)
    state = derive(model).numeric().at(q, v).state
    moving = [Jet(x, dx, 0) for x, dx in zip(q, state.coordinate_rates, strict=True)]
    rows = mass_matrix(TreeState(replace(state.tree, algebra=Jets(Floats())), moving, v))
    change = np.array([[x.dx if isinstance(x, Jet) else 0.0 for x in row] for row in rows])
    coriolis = np.array(inverse_dynamics(state))
    work = float(np.array(v) @ change @ np.array(v))
    scale = 1 + float(np.abs(v) @ np.abs(change) @ np.abs(v))
    return abs(2 * float(np.array(v) @ coriolis) - work) / scale


def test_the_builder_says_motion_like_the_model_file() -> None:
    model = Model("driven")
    table = model.body("table", mass=1, inertia=(1, 1, 1))
    arm = model.body("arm", mass=1, mass_center=(1, 0, 0))
    joint = model.revolute("turn", between=("ground", table), motion="0.1*sin(t)")
    model.revolute("swing", between=(table, arm), axis=(0, 1, 0))
    assert joint.drive == "0.1*sin(t)"
    assert [x.name for x in derive(model).structure.velocities] == ["swing"]

"""Random mechanisms with loops and what the oracle says of them: what Newton and the joints demand."""

from __future__ import annotations

import numpy as np
import pytest
from oracles.closed_systems import (
    at_rest,
    centers,
    frames,
    gaps,
    moving,
    random_system,
    rows_of,
    solve,
)

SEEDS = range(0, 40, 3)


@pytest.mark.parametrize("seed", SEEDS)
def test_what_is_drawn_holds_together(seed: int) -> None:
    system = random_system(seed)
    motions = {name: at_rest(pose) for name, pose in system.assembled.items()}
    assert np.abs(gaps(system, motions)).max() < 1e-13


@pytest.mark.parametrize("seed", SEEDS)
def test_forces_on_every_body_make_its_mass_centre_move(seed: int) -> None:
    """M a = m g + what joints exert on it as their head, less what they exert with it as their tail."""
    system = random_system(seed)
    rest = {name: at_rest(pose) for name, pose in system.assembled.items()}
    matrix = np.vstack([rows_of(system, joint, rest).matrix for joint in system.joints])
    allowed = np.linalg.svd(matrix)[2][np.linalg.matrix_rank(matrix, 1e-9) :]
    draw = np.random.default_rng(seed)
    x = draw.normal(size=len(allowed)) @ allowed
    motions = moving(system, system.assembled, x)
    efforts = system.efforts_of(draw.normal(size=len(system.effort_names)))
    found = solve(system, motions, efforts)
    assert found.residual < 1e-9
    for body, center in zip(system.bodies, centers(system, motions), strict=True):
        assert center.velocity == pytest.approx(x[system.places[body.name]][:3], abs=1e-12)
        needed = body.mass * found.acceleration[system.places[body.name]][:3]
        exerted = body.mass * system.gravity
        for joint in system.joints:
            turn = frames(joint, motions)[1].rotation
            force = turn @ found.wrenches[joint.name][:3]
            exerted = exerted + force * ((joint.head == body.name) - (joint.tail == body.name))
        assert exerted == pytest.approx(needed, abs=1e-9 * (1 + np.abs(exerted).max()))

"""Forces between two bodies: gravity by the inverse-square law, and that pairs cancel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from support.emitted import load

import linegraph as lg
from linegraph.emission.emit import render

if TYPE_CHECKING:
    from pathlib import Path

GRAVITY, MASSES = 0.7, (2.0, 3.0, 5.0)


def three_bodies() -> lg.Model:
    model = lg.Model("three_bodies", gravity=(0, 0, 0))
    model.parameter("G", GRAVITY)
    names = ("a", "b", "c")
    for name, mass in zip(names, MASSES, strict=True):
        body = model.body(name, mass=mass, inertia=(0.4, 0.4, 0.4))
        model.free(f"free_{name}", between=("ground", body))
    for i, j in ((0, 1), (1, 2), (2, 0)):
        force = f"G*{MASSES[i]}*{MASSES[j]}/x**2"
        model.law(f"pull_{names[i]}{names[j]}", between=(names[i], names[j]), force=force)
    return model


def test_three_bodies_attract_as_newton_says(tmp_path: Path) -> None:
    emitted = load(render(three_bodies(), languages=["python"]), "three_bodies", tmp_path)
    rng = np.random.default_rng(3)
    for _ in range(20):
        q, v = rng.normal(size=21), np.zeros(18)
        for k in range(3):
            q[7 * k + 3 : 7 * k + 7] = (0, 0, 0, 1)
        places = q.reshape(3, 7)[:, :3]
        acceleration = emitted.forward_dynamics(emitted.DEFAULT_PARAMETERS, q, v, [])
        for i in range(3):
            expected = sum(
                GRAVITY
                * MASSES[j]
                * (places[j] - places[i])
                / np.linalg.norm(places[j] - places[i]) ** 3
                for j in range(3)
                if j != i
            )
            found = acceleration[6 * i : 6 * i + 3]
            np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-13)


def test_a_pair_leaves_the_whole_momentum_alone(tmp_path: Path) -> None:
    emitted = load(render(three_bodies(), languages=["python"]), "three_bodies", tmp_path)
    rng = np.random.default_rng(4)
    q = rng.normal(size=21)
    for k in range(3):
        q[7 * k + 3 : 7 * k + 7] /= np.linalg.norm(q[7 * k + 3 : 7 * k + 7])
    h = emitted.bias(emitted.DEFAULT_PARAMETERS, q, np.zeros(18))
    total = np.zeros(3)
    for k in range(3):
        x, y, z, w = q[7 * k + 3 : 7 * k + 7]
        axis = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        rotation = np.eye(3) + 2 * w * axis + 2 * axis @ axis
        total += rotation @ h[6 * k : 6 * k + 3]
    np.testing.assert_allclose(total, 0, atol=1e-13)

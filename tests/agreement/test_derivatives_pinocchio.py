"""Derivatives of robots against Pinocchio's own: computeRNEADerivatives and computeABADerivatives.

Both take derivatives by q on the same tangent space, so that they are equal entry by entry. A few robots by
default, every URDF of the example-robot-data wheel with ``--all-robots``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from agreement.test_pinocchio import readable
from support.emitted import load

from linegraph.emission.emit import render

pytest.importorskip("pinocchio")
import pinocchio
from oracles import pinocchio_models as peers

if TYPE_CHECKING:
    from pathlib import Path

TOLERANCE = 1e-11
FEW = ("panda", "ur5_robot", "solo12", "simple_humanoid")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    files = peers.urdf_files()
    if not metafunc.config.getoption("--all-robots"):
        files = [file for file in files if file.stem in FEW]
    names = [f"{file.parent.parent.name}-{file.stem}" for file in files]
    metafunc.parametrize("file", files, ids=names)
    metafunc.parametrize("base", ["fixed", "floating"])


@pytest.mark.one_in(2)
def test_agrees_with_pinocchio(file: Path, base: str, tmp_path: Path) -> None:
    model, held = readable(file, base, 0.0)
    text = file.read_text()
    pair = peers.Bridge(
        model, peers.load_text(text, floating=base == "floating"), peers.followers(text), held
    )
    wanted = ("inverse_dynamics_derivatives", "forward_dynamics_derivatives")
    files = render(model, name="robot", folded=True, only=wanted, languages=["python"])
    module = load(files, "robot", tmp_path)
    rng = np.random.default_rng(0)
    G = pair.G
    for _ in range(3):
        q, v = pair.random_state(rng)
        at = pair.positions(q)
        a, u = rng.normal(size=module.NV), rng.normal(size=module.NU)
        by_q, by_v, by_a = slopes(pair, at, G @ v, G @ a)
        found = module.inverse_dynamics_derivatives(q, v, a)
        for ours, theirs in zip(found, (by_q, by_v, by_a), strict=True):
            assert apart(ours, G.T @ theirs @ G) < TOLERANCE
        # where nothing is coupled or held Pinocchio's articulated bodies are a third way
        tau = np.zeros(module.NV)
        tau[[module.V_NAMES.index(name) for name in module.U_NAMES]] = u
        mass, bias = pair.mass_matrix(q), pair.bias(q, v)
        a = np.linalg.solve(mass, tau - bias)
        by_q, by_v, _ = slopes(pair, at, G @ v, G @ a)
        solved = [-np.linalg.solve(mass, G.T @ x @ G) for x in (by_q, by_v)]
        if pair.pin.nv == module.NV:
            pinocchio.computeABADerivatives(
                pair.pin, pair.data, at, G @ v, np.linalg.solve(G.T, tau)
            )
            solved = [np.linalg.solve(G, x @ G) for x in (pair.data.ddq_dq, pair.data.ddq_dv)]
        driven = [module.V_NAMES.index(name) for name in module.U_NAMES]
        if driven:
            solved.append(np.linalg.inv(mass)[:, driven])
        limit = max(TOLERANCE, 10 * np.finfo(float).eps * float(np.linalg.cond(mass)))
        found = module.forward_dynamics_derivatives(q, v, u)
        for ours, theirs in zip(found, solved, strict=True):
            assert apart(ours, theirs) < limit


def apart(found: np.ndarray, expected: np.ndarray) -> float:
    """The largest difference relative to the largest entry; a matrix of zeros is dust to Pinocchio."""
    return float(np.max(np.abs(found - expected)) / max(np.max(np.abs(expected)), 1e-3))


def slopes(pair: peers.Bridge, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> list[np.ndarray]:
    """Pinocchio's derivatives by q, v and a."""
    pinocchio.computeRNEADerivatives(pair.pin, pair.data, q, v, a)
    upper = np.triu(pair.data.M)
    mass = upper + np.triu(upper, 1).T
    return [np.array(pair.data.dtau_dq), np.array(pair.data.dtau_dv), mass]

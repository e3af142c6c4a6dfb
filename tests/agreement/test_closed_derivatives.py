"""The linearisation of mechanisms in their independent coordinates, against complex steps over numbers.

The reference moves s or w by a small imaginary number, finds the other coordinates' changes from J and all
velocities from J v = b at the moved position, and solves M a = f + J^T lam, J a = gam there by numpy, with
those constraints that are independent.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from agreement.test_derivatives import STEP, Point, above, error
from examples.test_closed_examples import BICYCLE_AT_REST, CAPSIZE, WEAVE
from scipy.linalg import qr
from support import closed_examples
from support.compiled import Compiled
from support.emitted import load

import linegraph as lg
from linegraph import ModelError, derive
from linegraph.emission.emit import render
from linegraph.programs.independent import independent
from linegraph.programs.loop_derivatives import free_changes
from linegraph.programs.workspace import Workspace

if TYPE_CHECKING:
    from pathlib import Path

Array = Any

NAMES = (
    "four_bar",
    "slider_crank",
    "andrews_squeezer",
    "parallelograms",
    "bricard",
    "stewart_platform",
    "rolling_disc",
    "bicycle",
)
EXACT = 1e-11
"""Relative to 1 + the largest entry; the constraints are eliminated in another order."""


def independent_rows(J: Array) -> Array:
    _, upper, order = qr(J.T, mode="economic", pivoting=True)
    size = np.abs(np.diag(upper))
    return np.sort(order[: int(np.sum(size > 1e-9 * size[0]))])


def reduced(point: Point, free: list[int], own: list[int], holonomic: int) -> Array:
    """(A B) for changes of position at places `free` and velocities at places `own`."""
    still = point.still
    J = np.real(still.stacked(still.here.jacobian)[0])
    rows, n, m, k = independent_rows(J), len(point.v), len(free), len(own)
    keeping = independent_rows(J[:holonomic]) if holonomic else np.array([], dtype=int)
    square = np.vstack((J[keeping], np.eye(n)[free]))
    D = np.linalg.solve(square, np.vstack((np.zeros((len(keeping), m)), np.eye(m))))
    lanes = m + k + len(point.u)
    shift = np.zeros((lanes, len(point.q) + n + len(point.u)), complex)
    shift[:m, : len(point.q)] = (point.columns @ D[: point.mechanical]).T
    shift[m + k :, len(point.q) + n :] = np.eye(len(point.u))
    moved = point.at(1j * STEP * shift)
    there = moved.stacked(moved.here.jacobian)[:, rows]
    velocity = np.tile(point.v[own].astype(complex), (lanes, 1))
    velocity[m : m + k] += 1j * STEP * np.eye(k)
    # J v - b at the moved position and the old v gives b
    amiss = moved.stacked(moved.here.constraint_rates)[:, rows]
    fixed = np.einsum("sij,j->si", there, point.v) - amiss
    whole = np.concatenate((there, np.tile(np.eye(n)[own], (lanes, 1, 1))), axis=1)
    v = np.linalg.solve(whole, np.concatenate((fixed, velocity), axis=1)[..., None])[..., 0]
    shift = 1j * STEP * shift
    shift[:, len(point.q) : len(point.q) + n] = v - point.v
    moved = point.at(shift)
    there, bias = (
        moved.stacked(moved.here.jacobian)[:, rows],
        moved.stacked(moved.here.constraint_bias),
    )
    kkt = np.zeros((lanes, n + len(rows), n + len(rows)), complex)
    kkt[:, :n, :n], kkt[:, n:, :n] = moved.mass, there
    kkt[:, :n, n:] = -np.swapaxes(there, 1, 2)
    right = np.concatenate((moved.forces - moved.bias, bias[:, rows]), axis=1)
    a = np.linalg.solve(kkt, right[..., None])[:, :n, 0]
    d = np.zeros((point.mechanical, lanes))
    d[:, :m] = D
    going = np.imag(v).T / STEP + above(point)[:, : point.mechanical] @ d
    return np.vstack((going[free], np.imag(a[:, own]).T / STEP))


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", NAMES)
def test_mechanisms(name: str, tmp_path: Path) -> None:
    model = closed_examples.read(name)
    derivation = derive(model)
    files = render(model, folded=True, only=("linearize", "project"))
    emitted, compiled = load(files, model.name, tmp_path), Compiled(files, model.name, tmp_path)
    f = Workspace(derivation, folded=True)
    free, own = free_changes(f), [v for _, v in independent(f)]
    holonomic = sum(equation.holonomic for equation in f.constraint_equations)
    rng = np.random.default_rng(3)
    start = np.array(derivation.assembled.q)
    for _ in range(3):
        near = start + rng.uniform(-0.05, 0.05, len(start))
        q, v = emitted.project(near, rng.normal(size=emitted.NV))
        u = rng.normal(size=emitted.NU)
        found = emitted.linearize(q, v, u)
        A, *B = found if emitted.NU else (found,)
        assert len(A) == emitted.NDX == len(emitted.DX_NAMES)
        expected = reduced(Point(derivation, 0.0, q, v, u), free, own, holonomic)
        assert error(np.hstack((A, *B)), expected) <= EXACT
        shapes = [x.shape for x in (A, *B)]
        in_c = compiled.call("linearize", q, v, u, out=shapes)
        for ours, theirs in zip(in_c if B else (in_c,), (A, *B), strict=True):
            assert error(ours, theirs) <= EXACT


def test_the_bicycle_is_that_of_the_benchmark(tmp_path: Path) -> None:
    """Riding straight, lean and steer by themselves: eigenvalues at rest, and where weave becomes stable."""
    files = render(
        closed_examples.read("bicycle"),
        folded=True,
        only=("linearize", "reduction"),
        languages=["python"],
    )
    emitted = load(files, "bicycle", tmp_path)
    start = np.array(derive(closed_examples.read("bicycle")).assembled.q)
    names = ("frame_lean", "steer", "frame_lean_dot", "steer_dot")
    at = [emitted.DX_NAMES.index(name) for name in names]
    u = np.zeros(emitted.NU)

    def riding(speed: float) -> Array:
        q, v = emitted.complete(start, [0.0, 0.0, 0.0], [0.0, 0.0, -speed / 0.3])
        A, _ = emitted.linearize(q, v, u)
        others = [k for k in range(emitted.NDX) if k not in at]
        assert np.max(np.abs(A[np.ix_(at, others)])) < 1e-11
        return A[np.ix_(at, at)]

    assert np.allclose(np.sort(np.linalg.eigvals(riding(0.0)).real), BICYCLE_AT_REST, rtol=1e-10)
    weave = np.linalg.eigvals(riding(WEAVE))
    assert abs(weave[np.abs(weave.imag) > 1e-3].real.max()) < 1e-9
    capsize = np.linalg.eigvals(riding(CAPSIZE))
    assert np.min(np.abs(capsize)) < 1e-9


def test_constraints_that_follow_inputs_are_refused() -> None:
    model = lg.Model("led")
    arm = model.body("arm", mass=1.0, mass_center=(0, 0, -0.5), inertia=(0.1, 0.1, 0.1))
    model.revolute("hinge", between=("ground", arm), axis=(0, 1, 0))
    bob = model.body("bob", mass=1.0, inertia=(0.1, 0.1, 0.1))
    model.prismatic("slide", between=(arm, bob), axis=(0, 0, 1), start=0.5)
    model.driver("lead", between=("ground", bob), x="input")
    with pytest.raises(ModelError, match="constraints that follow inputs"):
        render(model, only=("linearize",))

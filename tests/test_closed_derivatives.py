"""The linearisation of mechanisms in their independent coordinates, against complex steps over numbers.

The reference moves s or w by a small imaginary number, finds the other coordinates' changes from J and all
velocities from J v = b at the moved position, and solves M a = f + J^T lam, J a = gam there by numpy, with
those constraints that are independent.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import closed_examples
import numpy as np
import pytest
from compiled import Compiled
from emitted import load
from scipy.linalg import qr
from test_derivatives import STEP, Point, error

from linegraph import ModelError, derive
from linegraph.closed_programs import independent
from linegraph.emission import render
from linegraph.shared import Functions

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
)
EXACT = 1e-11
"""Relative to 1 + the largest entry; the constraints are eliminated in another order."""


def independent_rows(J: Array) -> Array:
    _, upper, order = qr(J.T, mode="economic", pivoting=True)
    size = np.abs(np.diag(upper))
    return np.sort(order[: int(np.sum(size > 1e-9 * size[0]))])


def reduced(point: Point, at: list[tuple[int, int]]) -> Array:
    """(A B) in the independent coordinates at places `at` of v."""
    own = [v for _, v in at]
    still = point.still
    J = np.real(still.stacked(still.chords.jacobian())[0])
    rows, n, k = independent_rows(J), len(point.v), len(own)
    free = np.vstack((J[rows], np.eye(n)[own]))
    T = np.linalg.solve(free, np.vstack((np.zeros((len(rows), k)), np.eye(k))))
    lanes = 2 * k + len(point.u)
    shift = np.zeros((lanes, len(point.q) + n + len(point.u)), complex)
    shift[:k, : len(point.q)] = (point.columns @ T).T
    shift[2 * k :, len(point.q) + n :] = np.eye(len(point.u))
    moved = point.at(1j * STEP * shift)
    there = moved.stacked(moved.chords.jacobian())[:, rows]
    velocity = np.tile(point.v[own].astype(complex), (lanes, 1))
    velocity[k : 2 * k] += 1j * STEP * np.eye(k)
    # J v - b at the moved position and the old v gives b
    fixed = (
        np.einsum("sij,j->si", there, point.v)
        - moved.stacked(moved.chords.rates(moved.state[1]))[:, rows]
    )
    whole = np.concatenate((there, np.tile(np.eye(n)[own], (lanes, 1, 1))), axis=1)
    v = np.linalg.solve(whole, np.concatenate((fixed, velocity), axis=1)[..., None])[..., 0]
    shift = 1j * STEP * shift
    shift[:, len(point.q) : len(point.q) + n] = v - point.v
    moved = point.at(shift)
    there, bias = (
        moved.stacked(moved.chords.jacobian())[:, rows],
        moved.stacked(moved.chords.bias()),
    )
    kkt = np.zeros((lanes, n + len(rows), n + len(rows)), complex)
    kkt[:, :n, :n], kkt[:, n:, :n] = moved.mass, there
    kkt[:, :n, n:] = -np.swapaxes(there, 1, 2)
    right = np.concatenate((moved.forces - moved.bias, bias[:, rows]), axis=1)
    a = np.linalg.solve(kkt, right[..., None])[:, :n, 0]
    below = np.imag(a[:, own]).T / STEP
    above = np.hstack((np.zeros((k, k)), np.eye(k), np.zeros((k, len(point.u)))))
    return np.vstack((above, below))


@pytest.mark.parametrize("name", NAMES)
def test_mechanisms(name: str, tmp_path: Path) -> None:
    model = closed_examples.read(name)
    derivation = derive(model)
    files = render(model, folded=True, only=("linearize", "project"))
    emitted, compiled = load(files, model.name, tmp_path), Compiled(files, model.name, tmp_path)
    at = independent(Functions(derivation, folded=True))
    rng = np.random.default_rng(3)
    start = np.array(derivation.assembled.q)
    for _ in range(3):
        q, v = emitted.project(
            start + rng.uniform(-0.05, 0.05, len(start)), rng.normal(size=emitted.NV)
        )
        u = rng.normal(size=emitted.NU)
        found = emitted.linearize(q, v, u)
        A, *B = found if emitted.NU else (found,)
        expected = reduced(Point(derivation, 0.0, q, v, u), at)
        assert error(np.hstack((A, *B)), expected) <= EXACT
        shapes = [x.shape for x in (A, *B)]
        in_c = compiled.call("linearize", q, v, u, out=shapes)
        for ours, theirs in zip(in_c if B else (in_c,), (A, *B), strict=True):
            assert error(ours, theirs) <= EXACT


def test_without_independent_coordinates_it_is_refused() -> None:
    model = closed_examples.read("rolling_disc")
    with pytest.raises(ModelError, match="constraints are of velocity alone"):
        render(model, only=("linearize",))

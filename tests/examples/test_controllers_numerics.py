"""The numerics that the controllers share agree with NumPy, SciPy and what is published."""

from __future__ import annotations

import ctypes
import math
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

SOURCE = Path(__file__).parents[2] / "examples" / "controllers" / "numerics.c"


@pytest.fixture(scope="module")
def numerics(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    library = tmp_path_factory.mktemp("numerics") / "numerics.so"
    command = ["gcc", "-std=c99", "-O2", "-fPIC", "-shared", str(SOURCE), "-lm"]
    subprocess.run([*command, "-o", str(library)], check=True)
    return ctypes.CDLL(str(library))


def pointer(array: Any) -> ctypes.c_void_p:
    assert array.flags.c_contiguous
    return ctypes.c_void_p(array.ctypes.data)


def systems() -> list[tuple[Any, Any]]:
    """Pairs A, B of x' = A x + B u, slow and stiff."""
    rng = np.random.default_rng(3)
    sizes = [(n, m, scale) for n, m in ((2, 1), (5, 2), (14, 3)) for scale in (0.1, 1.0, 300.0)]
    return [(scale * rng.normal(size=(n, n)), rng.normal(size=(n, m))) for n, m, scale in sizes]


def test_solving_agrees_with_numpy(numerics: ctypes.CDLL) -> None:
    for A, B in systems():
        found = B.copy()
        assert numerics.numerics_solve(*B.shape, pointer(A), pointer(found)) == 0
        assert found == pytest.approx(np.linalg.solve(A, B), rel=1e-9)
    singular, right = np.array([[1.0, 2.0], [2.0, 4.0]]), np.ones(2)
    assert numerics.numerics_solve(2, 1, pointer(singular), pointer(right)) == 1


def test_discretization_agrees_with_the_matrix_exponential(numerics: ctypes.CDLL) -> None:
    from scipy.linalg import expm

    for A, B in systems():
        (n, m), h = B.shape, 0.01
        Ad, Bd = np.empty((n, n)), np.empty((n, m))
        numerics.numerics_discretize(
            n, m, pointer(A), pointer(B), ctypes.c_double(h), pointer(Ad), pointer(Bd)
        )
        block = expm(h * np.block([[A, B], [np.zeros((m, n + m))]]))
        scale = np.max(np.abs(block))
        assert np.max(np.abs(Ad - block[:n, :n])) < 1e-12 * scale
        assert np.max(np.abs(Bd - block[:n, n:])) < 1e-12 * scale


def test_the_regulator_solves_the_riccati_equation(numerics: ctypes.CDLL) -> None:
    from scipy.linalg import solve_discrete_are

    rng = np.random.default_rng(4)
    for n, m in ((2, 1), (5, 2), (8, 3)):
        A, B = np.eye(n) + 0.3 * rng.normal(size=(n, n)), rng.normal(size=(n, m))
        Q, R = rng.uniform(0.5, 2, n), rng.uniform(0.5, 2, m)
        K = np.empty((m, n))
        status = numerics.numerics_lqr(n, m, *map(pointer, (A, B, Q, R, K)))
        P = solve_discrete_are(A, B, np.diag(Q), np.diag(R))
        wanted = np.linalg.solve(np.diag(R) + B.T @ P @ B, B.T @ P @ A)
        assert status == 0
        assert np.max(np.abs(K - wanted)) < 1e-9 * np.max(np.abs(wanted))
    unreachable = [np.array([2.0]), np.array([0.0]), np.ones(1), np.ones(1), np.empty(1)]
    assert numerics.numerics_lqr(1, 1, *map(pointer, unreachable)) == 1


def test_the_runge_kutta_method_is_of_fourth_order(numerics: ctypes.CDLL) -> None:
    """The solution of x' = t x is exp(t^2/2)."""
    numbers = ctypes.POINTER(ctypes.c_double)

    @ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_double, numbers, numbers)
    def rates(plant: Any, t: float, x: Any, xdot: Any) -> int:
        xdot[0] = t * x[0]
        return 0

    errors = []
    for steps in (20, 40):
        x, h = np.ones(1), 1.5 / steps
        for k in range(steps):
            step = (ctypes.c_double(k * h), ctypes.c_double(h))
            assert numerics.numerics_rk4(rates, None, 1, *step, pointer(x)) == 0
        errors.append(abs(x[0] - math.exp(1.125)))
    assert errors[1] < 1e-6
    assert errors[0] / errors[1] == pytest.approx(16, rel=0.15)


def test_random_numbers_are_those_of_splitmix64(numerics: ctypes.CDLL) -> None:
    seed = ctypes.c_ulonglong(1234567)
    numerics.numerics_uniform.restype = numerics.numerics_normal.restype = ctypes.c_double
    published = [6457827717110365317, 3203168211198807973, 9817491932198370423]
    found = [numerics.numerics_uniform(ctypes.byref(seed)) for _ in published]
    assert found == pytest.approx([value / 2**64 for value in published], abs=2**-53)
    normal = [numerics.numerics_normal(ctypes.byref(seed)) for _ in range(20000)]
    assert np.mean(normal) == pytest.approx(0, abs=0.03)
    assert np.std(normal) == pytest.approx(1, abs=0.03)

"""A grid of resistors, every one of another size: elimination keeps its digits without looking at sizes."""

from __future__ import annotations

import random

import numpy as np
from support.network_models import linear

from linegraph import Model

SIDE = 8


def test_resistance_of_a_grid() -> None:
    """A capacitor charged through the grid: ``v' = (u - v) / (R C)``, R by the nodal matrix."""
    draw = random.Random(5)
    model = Model("grid")
    model.input("u", "V")
    model.voltage_source("s", ("n0_0", "ground"), voltage="u")
    laplacian = np.zeros((SIDE * SIDE, SIDE * SIDE))
    for i in range(SIDE):
        for j in range(SIDE):
            for di, dj in ((0, 1), (1, 0)):
                if max(i + di, j + dj) == SIDE:
                    continue
                resistance = 10 ** draw.uniform(-3, 3)
                ends = (f"n{i}_{j}", f"n{i + di}_{j + dj}")
                model.resistor(f"R{i}_{j}_{di}", ends, resistance=resistance)
                a, b = SIDE * i + j, SIDE * (i + di) + j + dj
                slope = np.zeros(SIDE * SIDE)
                slope[[a, b]] = 1, -1
                laplacian += np.outer(slope, slope) / resistance
    model.capacitor("C", (f"n{SIDE - 1}_{SIDE - 1}", "ground"), capacitance=0.25)
    current = np.zeros(SIDE * SIDE)
    current[[0, -1]] = 1, -1
    potentials = np.linalg.lstsq(laplacian, current, rcond=None)[0]
    expected = 1 / (0.25 * (potentials[0] - potentials[-1]))
    _, A, B = linear(model)
    assert abs(A[0, 0] + expected) <= 1e-9 * expected
    assert abs(B[0][0, 0] - expected) <= 1e-9 * expected

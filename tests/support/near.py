"""Comparison of numbers relative to the largest of them, as rounding goes."""

from __future__ import annotations

from typing import Any

import numpy as np


def near(found: Any, expected: Any, tolerance: float = 1e-13) -> None:
    """Assert that entries differ by no more than a share of 1 and the largest expected entry."""
    found, expected = np.asarray(found, float), np.asarray(expected, float)
    size = 1 + np.abs(expected).max(initial=0.0)
    np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance * size)

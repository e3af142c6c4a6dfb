"""Tolerances of closed loops, shared by assembly, checks and emitted code.

All are dimensionless: positions, velocities and rows of J are first divided by sizes taken from the model
(`circuit_lengths`).
"""

from __future__ import annotations

CLOSED = 1e-9
"""Largest gap of a closed loop, relative to the loop's length."""

DEPENDENT = 1e-7
"""Singular values of J per unit of velocity below this are rounding or the effect of gaps."""

ACCURATE = 1e-6
"""Accelerations and multipliers are returned up to this estimated relative error."""

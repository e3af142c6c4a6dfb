"""How closely loops close, and what counts as nothing: one set of numbers for assembly, checks and run time.

All are pure numbers: positions, velocities and rows of J are first divided by sizes of the model itself, see
`circuit_lengths`.
"""

from __future__ import annotations

CLOSED = 1e-9
"""A gap of this part of a loop's length is none."""

DEPENDENT = 1e-7
"""A direction of J that moves less than this per unit of velocity is rounding, or what gaps leave of it."""

ACCURATE = 1e-6
"""The estimated relative error up to which accelerations and multipliers are returned."""

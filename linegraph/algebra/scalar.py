"""The type of the scalars in a derivation's formulas."""

from __future__ import annotations

from typing import Any, TypeAlias

Scalar: TypeAlias = Any
"""A Python number, a DAG node or a sympy expression: whatever + - * / work on.

To the type checker it is `Any`: numbers, nodes and sympy expressions have no common base class, and mypy has
no protocol that all three satisfy.
"""

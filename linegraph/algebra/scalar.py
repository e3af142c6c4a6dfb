"""Scalars: what the formulas of a derivation are written with."""

from __future__ import annotations

from typing import Any, TypeAlias

Scalar: TypeAlias = Any
"""A Python number, a DAG node or a sympy expression: whatever + - * / work on.

It is `Any` to the type checker: numbers, nodes and sympy expressions have no common base class, and no protocol
that mypy accepts for all three.
"""

"""The type of the scalars in a derivation's formulas."""

from __future__ import annotations

from typing import Any, TypeAlias

Scalar: TypeAlias = Any
"""A Python number, a DAG node, a SymPy expression or another type with + - * /.

For the type checker it is `Any`: numbers, nodes and SymPy expressions have no common base class, and there is
no protocol in mypy that all three satisfy.
"""

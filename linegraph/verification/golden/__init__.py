"""Golden vectors: states of a model, and what its functions return there by a route of their own."""

from linegraph.verification.golden.states import vectors

__all__ = ["vectors"]

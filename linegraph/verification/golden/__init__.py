"""Golden vectors: states of a model and the results its functions must return there, computed independently.

The reference shares with the derivation the positions of the links and the laws of elements, and nothing
else.
"""

from linegraph.verification.golden.states import vectors

__all__ = ["vectors"]

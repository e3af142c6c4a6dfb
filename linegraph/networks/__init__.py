"""Scalar networks: the states that their components need, and the equations of these states.

`equations.network_of` derives a `Network`; it is imported only where a model has components.
"""

from linegraph.networks.network import Network, State

__all__ = ["Network", "State"]

"""Scalar networks: from components to the states they need and the equations these obey.

`equations.network_of` derives them; it is imported where a model has components.
"""

from linegraph.networks.network import Network, State

__all__ = ["Network", "State"]

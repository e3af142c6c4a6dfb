"""Scalar networks: from components to the states they need and the equations these obey."""

from linegraph.network.equations import network_of
from linegraph.network.network import Network, State

__all__ = ["Network", "State", "network_of"]

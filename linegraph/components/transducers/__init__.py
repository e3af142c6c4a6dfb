"""Transducers: components with an edge in a network and one in mechanics, a file each.

The edge in mechanics is at a joint, between two points or on a shaft; w is the rate of the joint's
coordinate, of the distance or of the shaft, positive as these grow. The through variable of that edge opposes
w, so a transducer that drives with a force F has the law ``Y = -F``. Their register is that of all components
(`linegraph.components.scalar.Words`).
"""

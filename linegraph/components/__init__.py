"""The components of systems, each a terminal graph with laws.

Bodies, joints, forces, constraints, scalar components by domain, transducers, parameters and power domains. A
new kind is one class, and one line in the register of its package.
"""

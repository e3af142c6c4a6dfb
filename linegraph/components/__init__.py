"""What a system may consist of, each a terminal graph with laws.

Bodies, joints, forces, constraints, scalar components of all domains, parameters and the power domains. A new
kind is one file and one line in the register of its package.
"""

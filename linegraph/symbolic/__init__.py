"""Closed forms as SymPy expressions: simplification, Coriolis matrix, linear systems, dynamicsymbols."""

"""Closed forms for people: simplification, the Coriolis matrix, linear systems, dynamicsymbols."""

"""Geometry and mass in three dimensions, over any algebra.

Vectors are triples of scalars, resolved in a frame that the caller knows (`vector`); rotations are products
of cheap factors (`rotation`).
"""

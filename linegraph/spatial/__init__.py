"""Geometry and mass in three dimensions, over any algebra.

Vectors are triples of scalars, resolved in a frame that the caller keeps track of (`vector`). Rotations are
products of cheap factors (`rotation`), placements are frames in frames (`placement`), `inertia` has moments
of mass and `motion` the relative motion across a joint.
"""

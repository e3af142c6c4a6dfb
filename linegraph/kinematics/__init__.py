"""Kinematics of the chosen tree: coordinates, links, velocities and accelerations.

`state_layout` numbers the entries of q, v and u. `tree` walks from ground outward and reduces the model
to `links`. `arms`, `accelerations` and `twists` evaluate motion at a state, `ground_frames` the same in
ground axes. `working_frames` chooses frames in which the equations take few operations.
"""

"""What moves.

The layout of q, v and u (`state_layout`); links and the walk that builds the tree (`links`, `tree`);
velocities and accelerations (`accelerations`, `twists`); frames that make equations short (`working_frames`).
"""

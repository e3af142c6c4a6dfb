"""Terminal graphs without physics.

Oriented multigraphs and their union into the system graph (`multigraph`); forests, their branches and chords,
cutset and circuit matrices (`forest`).
"""

"""Terminal graphs without physics: vertices, oriented edges and exact integer matrices.

`multigraph` has oriented multigraphs and their union, the system graph; `forest` chooses a forest in it and
derives branches, chords, the cutset matrix and the circuit matrix.
"""

"""The principle of orthogonality, over any algebra: equations of motion at a state.

M and h (`mass_matrix`, `orthogonality`, `composite_bias`), applied forces (`applied_forces`),
constraints from chords (`chords`), all variables of all edges (`edge_variables`), networks coupled to
mechanics (`network_state`, `whole_system`). `equations` puts them together.
"""

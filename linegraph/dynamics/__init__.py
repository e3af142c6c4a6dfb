"""The principle of orthogonality, over any algebra.

M and h (`mass_matrix`, `orthogonality`, `composite_bias`), what acts (`applied_forces`), constraints from
chords (`chords`), every variable of every edge (`edge_variables`), networks in the whole (`network_state`,
`whole_system`).
"""

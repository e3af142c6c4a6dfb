"""Models as users build them, and the frozen systems that are derived.

The builder `Model` (`builder`), whose methods come from the registers of components (`builder_words`); macros
that add several components at once (`macros`); the frozen `System` (`system`, `snapshot`); choices, outputs
and bounds; the names that a model may bring into equations (`name_register`); the union of all terminal
graphs (`terminal_graphs`).
"""

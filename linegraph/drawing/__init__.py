"""Pictures: the system graph as papers draw it, the mechanism as engineers sketch it.

    Derivation ─→ Scene ─→ SVG, PNG          Derivation ─→ DOT

A scene is laid out in whole units by rules of its own, so that the same model gives the same bytes.
"""

"""How pictures draw a joint, so that a new type is drawn without a line in the drawings."""

from __future__ import annotations

from typing import NamedTuple

ABOUT, ALONG = "about", "along"
"""How a joint moves within a plane: it turns about the plane's normal, or slides along the plane."""


class Look(NamedTuple):
    """How a joint is drawn.

    Attributes:
        sign: whose symbol it has, a key of `drawing.symbols`; a diamond where there is none of this name.
        apart: whether its two frames may be apart, so that a line joins them.
        loose: whether that line is dashed, since no guide leads the head along it.
        directed: whether the symbol lies along the axis, and names keep clear of it there.
        shifted: whether the symbol may be moved along the axis to make room for others.
        actuated: whether it is drawn as cylinder and piston where it connects two bodies.
        guided: whether it is drawn as a slider on a guide.
        long: whether the legend draws it along its axis in full length.
        plane: `ABOUT` or `ALONG` where it keeps bodies in planes; empty where it does not.
    """

    sign: str = ""
    apart: bool = False
    loose: bool = False
    directed: bool = True
    shifted: bool = False
    actuated: bool = False
    guided: bool = False
    long: bool = False
    plane: str = ""

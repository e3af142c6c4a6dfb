"""The spring of 1-D translation."""

from __future__ import annotations

from dataclasses import dataclass

from linegraph.components.domains import TRANSLATION_1D
from linegraph.components.scalar.stores import Spring1D


@dataclass(frozen=True)
class TranslationalSpring(Spring1D):
    """A spring in 1-D translation: ``dY/dt = stiffness X``, Y the force that it is pressed together with.

    Example:
        >>> TranslationalSpring("strut", ("car", "wheel"), stiffness=2e4).kind
        'translational_spring'
    """

    kind = "translational_spring"
    domain_name = TRANSLATION_1D.name

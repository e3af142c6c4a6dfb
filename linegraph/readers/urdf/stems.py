"""Names of parameters, from names of links and joints that may contain any characters."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

MOMENTS = ("m", "mx", "my", "mz", "Ixx", "Ixy", "Ixz", "Iyy", "Iyz", "Izz")
"""Prefixes of a link's parameters: mass, first moment and inertia."""
OFFSETS = ("x", "y", "z")
"""Prefixes of a joint's parameters: its position."""

_LONGEST = 100
_RUN = re.compile(r"[A-Za-z0-9]+")


def stems(
    names: Iterable[str], prefixes: Collection[str], taken: Collection[str]
) -> dict[str, str]:
    """Choose a stem for each name, so that ``PREFIX_STEM`` is a unique C identifier.

    Everything but ASCII letters and digits becomes one ``_``. Later ones of equal results get a number.

    Args:
        names: names of links or of joints, each once.
        prefixes: prefixes of the identifiers.
        taken: identifiers already in use, such as those of coordinates.

    Returns:
        The stem of each name.

    Example:
        >>> stems(["left arm", "left-arm", "手"], ["m"], [])
        {'left arm': 'left_arm', 'left-arm': 'left_arm_2', '手': 'unnamed'}
    """
    chosen: dict[str, str] = {}
    used: set[str] = set()
    last: dict[str, int] = {}
    reserved = set(taken)
    for name in names:
        plain = "_".join(_RUN.findall(name))[:_LONGEST].rstrip("_") or "unnamed"
        stem, number = plain, last.get(plain, 1)
        while stem in used or any(f"{prefix}_{stem}" in reserved for prefix in prefixes):
            number += 1
            stem = f"{plain}_{number}"
        # Continue numbering from here; starting at 1 each time would take quadratic time for many equal
        # names.
        last[plain] = number
        used.add(stem)
        chosen[name] = stem
    return chosen

"""Names for parameters, made from names of links and joints that may hold anything."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

MOMENTS = ("m", "mx", "my", "mz", "Ixx", "Ixy", "Ixz", "Iyy", "Iyz", "Izz")
"""Mass, first moment and inertia of a link: what comes before its stem."""
OFFSETS = ("x", "y", "z")
"""The position of a joint: what comes before its stem."""

_LONGEST = 100
_RUN = re.compile(r"[A-Za-z0-9]+")


def stems(
    names: Iterable[str], prefixes: Collection[str], taken: Collection[str]
) -> dict[str, str]:
    """A stem for each name, such that ``PREFIX_STEM`` is a C identifier and unlike every other.

    Everything but ASCII letters and digits becomes one ``_``. Where two names come out the same, the
    later ones get a number.

    Args:
        names: of links or of joints, each once.
        prefixes: what is put before the stem.
        taken: identifiers that may not arise, e.g. of coordinates.

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
        # numbering goes on from here, or many equal names would take quadratic time
        last[plain] = number
        used.add(stem)
        chosen[name] = stem
    return chosen

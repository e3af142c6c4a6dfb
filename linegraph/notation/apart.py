"""Makes names look different from each other in every output format."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from linegraph.notation.latex import Latex
from linegraph.notation.mathml import MathMl
from linegraph.notation.plain import Plain

if TYPE_CHECKING:
    from linegraph.notation.tree import Name


def told_apart(found: dict[str, Name]) -> dict[str, Name]:
    """Names of which no two look alike in any format.

    Names that look alike are written as the words that they are in the model; where the words look alike,
    too, they are numbered.

    Args:
        found: the look of each symbol, by its name in the model.

    Example:
        >>> from linegraph.notation.names import shaped
        >>> names = told_apart({key: shaped(key) for key in ("m1", "m_1", "m2")})
        >>> [Plain()(name) for name in names.values()]
        ['m1', 'm_1', 'm₂']
    """
    known = dict(found)
    words: set[str] = set()
    while alike := _alike(known) - words:
        words |= alike
        known |= {key: replace(known[key], letter=key, subs=(), dots=0) for key in alike}
    alike = _alike(known)
    for place, key in enumerate(known):
        if key in alike:
            known[key] = replace(known[key], subs=(f"({place + 1})",))
    return known


def _alike(found: dict[str, Name]) -> set[str]:
    """The names that some writer writes in the same way as another name."""
    alike: set[str] = set()
    for writer in (Plain(), Latex(), MathMl()):
        looks: dict[str, list[str]] = {}
        for key, name in found.items():
            # a reader sees no difference between the two commands for italics
            looks.setdefault(writer(name).replace(r"\textit", r"\mathit"), []).append(key)
        alike |= {key for keys in looks.values() if len(keys) > 1 for key in keys}
    return alike

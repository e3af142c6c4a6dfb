"""Text for people, made fit for the comments of any language: printable ASCII, one line or wrapped.

Names, units and descriptions come from files and may hold anything. Whatever it was, `plain` leaves
one line of printable ASCII; what may still end a comment or a string is each language's own affair.
"""

from __future__ import annotations

import textwrap
import unicodedata
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.ir.program import Quantity

WIDTH = 92
"""Wrapped lines are at most this long, before the language puts its comment marks around them."""

_NAME_WIDTH = 24

_SPELLED = {
    letter: spelling
    for spellings in (
        "\u0307:dot \u0308:ddot ẍ:xddot ÿ:yddot °:deg º:deg µ:u Ω:ohm Δ:Delta Σ:sum",
        "·:* ⋅:* ×:x ÷:/ −:- –:- —:- …:... ±:+- ≤:<= ≥:>= ≠:!= ≈:~ →:-> √:sqrt ∞:infinity",
        "ᵀ:^T ²:^2 ³:^3 ⁴:^4 ¹:^1 ⁻:^- ‘:' ’:' “:\" ”:\"",
        "α:alpha β:beta γ:gamma δ:delta ε:epsilon ζ:zeta η:eta θ:theta κ:kappa λ:lambda μ:mu",
        "ν:nu ξ:xi π:pi ρ:rho σ:sigma τ:tau φ:phi χ:chi ψ:psi ω:omega ℓ:l",
    )
    for letter, spelling in (item.split(":") for item in spellings.split())
} | {unicodedata.normalize("NFC", f"{x}\u0307"): f"{x}dot" for x in "ahmprswxyz"}


def plain(text: str) -> str:
    """One line of printable ASCII that says the same; what has no spelling is shown by its number.

    Example:
        >>> plain("α̇ in °/s, für 半")
        'alphadot in deg/s, fur <U+534A>'
    """
    if not text.isascii():
        text = "".join(map(_spell, unicodedata.normalize("NFC", text)))
    text = " ".join(text.split())
    return text if text.isprintable() else "".join(map(_show, text))


def paragraph(text: str, indent: int = 0) -> list[str]:
    """A text as lines of printable ASCII, wrapped at `WIDTH` characters.

    Args:
        text: any text.
        indent: how many spaces precede lines after the first.
    """
    return textwrap.wrap(plain(text), WIDTH, subsequent_indent=" " * indent, break_on_hyphens=False)


def table(quantities: Sequence[Quantity], sizes: Sequence[int] = ()) -> list[str]:
    """A table of quantities: index, name, value if there is one, unit and description.

    Args:
        quantities: one for each row.
        sizes: how many indices each row takes; empty if each takes one.
    """
    places = [sum(sizes[:k]) if sizes else k for k in range(len(quantities))]
    rows = [
        [
            str(index),
            plain(x.name),
            "" if x.value is None else repr(float(x.value)),
            plain(x.unit),
        ]
        for index, x in zip(places, quantities, strict=True)
    ]
    widths = [min(max(map(len, column)), _NAME_WIDTH) for column in zip(*rows, strict=True)]
    lines: list[str] = []
    for row, x in zip(rows, quantities, strict=True):
        cells = [row[0].rjust(widths[0])]
        cells += [row[i].ljust(widths[i]) for i in (1, 2, 3) if widths[i]]
        line = f"  {'  '.join(cells)}  "
        lines += _row(line, plain(x.about), min(len(line), WIDTH // 2))
    return lines


def _row(head: str, about: str, indent: int) -> list[str]:
    lines = textwrap.wrap(about, WIDTH - indent, break_on_hyphens=False) or [""]
    if len(head) > indent:
        return [head.rstrip(), *(" " * indent + line for line in lines if line)]
    return [(head + lines[0]).rstrip(), *(" " * indent + line for line in lines[1:])]


def _spell(letter: str) -> str:
    if letter.isascii():
        return letter
    if letter in _SPELLED:
        return _SPELLED[letter]
    parts = unicodedata.normalize("NFKD", letter)
    kept = "".join(part for part in parts if not unicodedata.combining(part))
    return kept if kept and kept.isascii() else _show(letter)


def _show(letter: str) -> str:
    return letter if " " <= letter <= "~" else f"<U+{ord(letter):04X}>"

"""How wide text is, and what of a name can be drawn.

Pictures are laid out without asking for a font, so that they are the same on every machine: widths are
those of DejaVu Sans, wider than most sans-serif fonts, in hundredths of the size.
"""

from __future__ import annotations

import unicodedata

LONGEST = 36
"""A longer name is drawn with its middle left out; the whole name stands in the element's title."""

_WIDTHS = {
    28: "'ijl",
    30: "IJ",
    32: " ,.",
    34: "/:;\\|",
    36: "f",
    37: "-",
    40: "()[]t",
    42: "r!",
    46: '"',
    50: "*`",
    52: "_",
    54: "?sz",
    56: "Lc",
    58: "Fk",
    60: "vxy",
    62: "TYaeoP",
    64: "$0123456789ESbdghnpqu{}",
    66: "K",
    69: "BVXZ",
    70: "CR",
    72: "A",
    76: "HNU",
    79: "DGOQ&",
    82: "w",
    87: "M",
    99: "Wm%",
    100: "@",
}
_WIDTH = {letter: width for width, letters in _WIDTHS.items() for letter in letters}
_OTHER, _WIDE, _BOLDER = 88, 105, 13


def width(text: str, size: int, *, bold: bool = False) -> int:
    """A width that the text does not exceed, in whole units.

    Example:
        >>> width("shoulder", 12), width("", 12)
        (53, 0)
    """
    total = sum(_letter_width(letter) for letter in text) + _BOLDER * bold * len(text)
    return -(-total * size // 100)


def is_common(text: str) -> bool:
    """Whether every letter's width is known; of others fonts differ."""
    return all(letter in _WIDTH or letter in "#+<=>^~…" for letter in text)


def _letter_width(letter: str) -> int:
    if letter in _WIDTH:
        return _WIDTH[letter]
    if unicodedata.combining(letter):
        return 0
    if unicodedata.east_asian_width(letter) in ("W", "F"):
        return _WIDE
    return _OTHER if ord(letter) < 0x2E80 else _WIDE


def clean(text: str) -> str:
    r"""The text on one line, with characters that cannot be drawn, or turn the line round, replaced.

    Example:
        >>> clean("a\nb\x00")
        'a b\ufffd'
    """
    return "".join(_drawable(letter) for letter in text)


def _drawable(letter: str) -> str:
    if letter.isspace():
        return " "
    category = unicodedata.category(letter)
    return "\ufffd" if category in ("Cc", "Cf", "Cs", "Cn", "Co") else letter


def short(text: str, longest: int = LONGEST) -> str:
    """A clean text of no more than `longest` letters, the middle left out.

    Example:
        >>> short("abcdefghij", 7)
        'abc…hij'
    """
    text = clean(text)
    if len(text) <= longest:
        return text
    keep = longest - 1
    return f"{text[: (keep + 1) // 2]}…{text[len(text) - keep // 2 :]}"

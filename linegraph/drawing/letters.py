"""Widths of text, and names shortened and cleaned for drawing.

Pictures are laid out without loading a font, so that they are the same on every machine. Widths are those
of DejaVu Sans, wider than most sans-serif fonts, in hundredths of the size.
"""

from __future__ import annotations

import unicodedata

LONGEST = 36
"""Longer names are drawn with their middle left out; the title of the element has the whole name."""

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
    """Upper bound on the width of a text, in whole units.

    Args:
        text: the text.
        size: its size.
        bold: whether it is bold.

    Example:
        >>> width("shoulder", 12), width("", 12)
        (53, 0)
    """
    total = sum(_letter_width(letter) for letter in text) + _BOLDER * bold * len(text)
    return -(-total * size // 100)


def is_common(text: str) -> bool:
    """Whether the widths of all letters are known; others depend on the font."""
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
    r"""Put text on one line and replace characters that cannot be drawn or change its direction.

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
    """Clean a text and leave out its middle if it is too long.

    Args:
        text: the text.
        longest: largest number of letters.

    Example:
        >>> short("abcdefghij", 7)
        'abc…hij'
    """
    text = clean(text)
    if len(text) <= longest:
        return text
    keep = longest - 1
    return f"{text[: (keep + 1) // 2]}…{text[len(text) - keep // 2 :]}"

"""What all writers of formulas share: brackets, signs, and where a line may be broken.

A writer leaves a mark before every + and - that is not inside a fraction or an exponent; the mark says how
many brackets are open there. All writers leave the same marks, so the width of a piece is that of its
plain text, whatever it is written in.
"""

from __future__ import annotations

import re
import unicodedata
from typing import TYPE_CHECKING

from linegraph.notation.tree import (
    Components,
    Fraction,
    FunctionCall,
    Grid,
    Math,
    Name,
    Numeral,
    Over,
    Power,
    Product,
    Raw,
    Root,
    Sum,
    TwoSides,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

SIDES, SUM, PRODUCT, POWER, ATOM = range(5)
"""How tightly a tree holds together."""

DEEPEST = 7
MARKS = re.compile("[\x01-\x08]")

SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
DIGITS = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
SUPERSCRIPTS = str.maketrans("0123456789-T", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻ᵀ")


def solid(text: str) -> str:
    """Without marks: what cannot be broken."""
    return MARKS.sub("", text)


def pieces(text: str) -> list[tuple[int, str]]:
    """What stands between marks, each with the brackets open at its start."""
    found, depth, start = [], 0, 0
    for mark in MARKS.finditer(text):
        found.append((depth, text[start : mark.start()]))
        depth, start = ord(mark[0]) - 1, mark.end()
    return [*found, (depth, text[start:])]


def visible(text: str) -> str:
    """Any text on one line without characters that cannot be seen or that turn the direction of others."""
    if text.isprintable() and " " not in text:
        return text
    shown = "".join(
        c if unicodedata.category(c)[0] != "C" or c in "\n\t" else _code(c) for c in text
    )
    return " ".join(shown.split())


def digits(subs: Sequence[str]) -> bool:
    """Whether subscripts are single digits, which need nothing between them."""
    return bool(subs) and all(len(sub) == 1 and sub in "0123456789" for sub in subs)


def numbered(sub: str) -> tuple[str, str]:
    """A subscript without the digits that are a subscript of its own, and these.

    Example:
        >>> numbered("θ₁₂"), numbered("tip")
        (('θ', '12'), ('tip', ''))
    """
    bare = sub.rstrip("₀₁₂₃₄₅₆₇₈₉")
    return (bare, sub[len(bare) :].translate(DIGITS)) if bare else (sub, "")


def _code(letter: str) -> str:
    return f"<U+{ord(letter):04X}>"


class Writer:
    """Base of all writers: goes through a tree; what a thing looks like is each writer's own affair."""

    multiplied = " "
    """What stands between factors."""

    def __init__(self) -> None:
        """No bracket is open."""
        self._depth = 0

    def __call__(self, tree: Math) -> str:
        """The formula on one line."""
        return solid(self.marked(tree))

    def marked(self, tree: Math) -> str:
        """The formula with marks where it may be broken."""
        return self.held(tree, SIDES)

    def whole(self, tree: Math) -> str:
        """A part that is not to be broken."""
        return solid(self.held(tree, SIDES))

    def held(self, tree: Math, level: int) -> str:
        """A part, in brackets where it holds together less than it must."""
        if self.tightness(tree) >= level:
            return self.write(tree)
        self._depth += 1
        text = self.write(tree)
        self._depth -= 1
        return self.bracketed(text)

    def tightness(self, tree: Math) -> int:
        """How tightly a tree holds together."""
        match tree:
            case TwoSides():
                return SIDES
            case Sum() | Raw():
                return SUM
            case Product() | Over():
                return PRODUCT
            case Fraction():
                return PRODUCT
            case Power() | FunctionCall():
                return POWER
        return ATOM

    def write(self, tree: Math) -> str:
        """A tree, without brackets around it."""
        match tree:
            case Name():
                return self.name(tree)
            case Numeral(text):
                return self.number(text)
            case Sum(terms):
                return self._sum(terms)
            case Product(factors, sign):
                return self.product(factors, sign)
            case Fraction(above, below):
                return self.quotient(above, below)
            case Power(base, exponent):
                return self.power(base, exponent)
            case Root(of):
                return self.root(of)
            case FunctionCall(name, arguments):
                return self.call(name, arguments, bare=True)
            case Components(entries):
                return self.bracketed(self.comma.join(self.whole(e) for e in entries))
            case Grid(rows):
                return self.grid([[self.whole(e) for e in row] for row in rows])
            case TwoSides(left, sign, right):
                return f"{self.held(left, SUM)}{self.related(sign)}{self.held(right, SUM)}"
            case Over(sign, under, body):
                return self.over(sign, under, body)
            case Raw():
                return self.raw(tree)
        raise TypeError(tree)

    comma = ", "

    def _sum(self, terms: Sequence[tuple[bool, Math]]) -> str:
        mark = chr(1 + min(self._depth, DEEPEST))
        found = []
        for k, (negative, term) in enumerate(terms):
            text = self.held(term, PRODUCT)
            if k:
                found.append(f"{mark}{self.signed(negative)}{text}")
            else:
                found.append(f"{self.minus}{text}" if negative else text)
        return "".join(found)

    minus = "-"

    def signed(self, negative: bool) -> str:
        """A sign between summands."""
        return " - " if negative else " + "

    def product(self, factors: Sequence[Math], sign: str) -> str:
        """Factors in a row; a function before another factor has its argument in brackets."""
        found = []
        for k, factor in enumerate(factors):
            follows = factors[k + 1] if k + 1 < len(factors) else None
            if _function(factor) and follows is not None and not (_function(follows) and not sign):
                found.append(self.closed(factor))
            else:
                level = PRODUCT if self.fractions and isinstance(factor, Fraction) else POWER
                found.append(self.held(factor, level))
        text = found[0]
        for k, part in enumerate(found[1:], 1):
            text += self.between(factors[k - 1], factors[k], sign) + part
        return text

    fractions = True
    """Whether a fraction needs no brackets among factors."""

    def closed(self, tree: Math) -> str:
        """A function, or a power of one, with its argument in brackets."""
        if isinstance(tree, Power) and isinstance(tree.base, FunctionCall):
            return self.called_power(tree.base, tree.exponent, bare=False)
        assert isinstance(tree, FunctionCall)
        return self.call(tree.name, tree.arguments, bare=False)

    def power(self, base: Math, exponent: Math) -> str:
        """A power; of a function that of its name."""
        if isinstance(base, FunctionCall) and isinstance(exponent, Numeral):
            return self.called_power(base, exponent, bare=True)
        return self.raised(solid(self.held(base, ATOM)), exponent)

    # -- what each writer says

    def bracketed(self, text: str) -> str:
        """In brackets."""
        return f"({text})"

    def name(self, name: Name) -> str:
        """A name."""
        raise NotImplementedError

    def number(self, text: str) -> str:
        """A number."""
        mantissa, _, exponent = text.partition("e")
        if not exponent:
            return text
        power = self.ten(exponent)
        return power if mantissa == "1" else f"{mantissa}{self.dot}{power}"

    dot = "·"

    def ten(self, exponent: str) -> str:
        """A power of ten."""
        raise NotImplementedError

    def between(self, left: Math, right: Math, sign: str) -> str:
        """What stands between two factors."""
        return f" {sign} " if sign else self.multiplied

    def related(self, sign: str) -> str:
        """What stands between two sides."""
        return f" {sign} "

    def quotient(self, above: Math, below: Math) -> str:
        """A fraction."""
        raise NotImplementedError

    def raised(self, base: str, exponent: Math) -> str:
        """A power."""
        raise NotImplementedError

    def root(self, of: Math) -> str:
        """A square root."""
        raise NotImplementedError

    def call(self, name: str, arguments: Sequence[Math], *, bare: bool) -> str:
        """A function; `bare` where a single name needs no brackets."""
        raise NotImplementedError

    def called_power(self, call: FunctionCall, exponent: Math, *, bare: bool) -> str:
        """A power of a function."""
        raise NotImplementedError

    def grid(self, rows: Sequence[Sequence[str]]) -> str:
        """A matrix."""
        raise NotImplementedError

    def over(self, sign: str, under: str, body: Math) -> str:
        """An operator over something."""
        raise NotImplementedError

    def raw(self, tree: Raw) -> str:
        """What another printer has written."""
        return tree.text


def _function(tree: Math) -> bool:
    base = tree.base if isinstance(tree, Power) else tree
    return isinstance(base, FunctionCall)

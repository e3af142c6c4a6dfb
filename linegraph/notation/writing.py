"""What all writers of formulas share: brackets, signs, and the places where a line may be broken.

A writer leaves a mark before every + and - that is not inside a fraction or an exponent; the mark is the
number of brackets open there. All writers leave the same marks, so that lines can be broken by the width of
the plain text, whatever the format.
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
"""How tightly the parts of a tree are bound, from relations to single symbols."""

DEEPEST = 7
MARKS = re.compile("[\x01-\x08]")

SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
DIGITS = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
SUPERSCRIPTS = str.maketrans("0123456789-T", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻ᵀ")


def solid(text: str) -> str:
    """A text without marks, which cannot be broken."""
    return MARKS.sub("", text)


def pieces(text: str) -> list[tuple[int, str]]:
    """The texts between the marks, each with the number of brackets open at its start."""
    found, depth, start = [], 0, 0
    for mark in MARKS.finditer(text):
        found.append((depth, text[start : mark.start()]))
        depth, start = ord(mark[0]) - 1, mark.end()
    return [*found, (depth, text[start:])]


def visible(text: str) -> str:
    """Any text on one line, without invisible characters and those that reverse the direction of writing."""
    if text.isprintable() and " " not in text:
        return text
    shown = "".join(
        c if unicodedata.category(c)[0] != "C" or c in "\n\t" else _code(c) for c in text
    )
    return " ".join(shown.split())


def digits(subs: Sequence[str]) -> bool:
    """Whether all subscripts are single digits, which need no comma between them."""
    return bool(subs) and all(len(sub) == 1 and sub in "0123456789" for sub in subs)


def numbered(sub: str) -> tuple[str, str]:
    """A subscript split into its word and the digits that are a subscript of that word.

    Example:
        >>> numbered("θ₁₂"), numbered("tip")
        (('θ', '12'), ('tip', ''))
    """
    bare = sub.rstrip("₀₁₂₃₄₅₆₇₈₉")
    return (bare, sub[len(bare) :].translate(DIGITS)) if bare else (sub, "")


def _code(letter: str) -> str:
    return f"<U+{ord(letter):04X}>"


class Writer:
    """Base of all writers: walks a tree and sets brackets; each format overrides how the parts look."""

    multiplied = " "
    """The text between two factors."""

    def __init__(self) -> None:
        """Start with no bracket open."""
        self._depth = 0

    def __call__(self, tree: Math) -> str:
        """The formula on one line."""
        return solid(self.marked(tree))

    def marked(self, tree: Math) -> str:
        """The formula with marks where a line may be broken."""
        return self.held(tree, SIDES)

    def whole(self, tree: Math) -> str:
        """A tree that must not be broken."""
        return solid(self.held(tree, SIDES))

    def held(self, tree: Math, level: int) -> str:
        """A tree, in brackets if it binds less tightly than its context requires.

        Args:
            tree: the tree.
            level: the tightness that the context requires, `SIDES` to `ATOM`.
        """
        if self.tightness(tree) >= level:
            return self.write(tree)
        self._depth += 1
        text = self.write(tree)
        self._depth -= 1
        return self.bracketed(text)

    def tightness(self, tree: Math) -> int:
        """How tightly the parts of a tree are bound, `SIDES` to `ATOM`."""
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
        """The sign between two summands."""
        return " - " if negative else " + "

    def product(self, factors: Sequence[Math], sign: str) -> str:
        """Factors in a row; the argument of a function before another factor gets brackets.

        Args:
            factors: in order.
            sign: ``·`` or ``×`` between them, or nothing.
        """
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
        """A power; of a function, the exponent follows the function's name.

        Args:
            base: the base.
            exponent: the exponent.
        """
        if isinstance(base, FunctionCall) and isinstance(exponent, Numeral):
            return self.called_power(base, exponent, bare=True)
        return self.raised(solid(self.held(base, ATOM)), exponent)

    # -- overridden by each format

    def bracketed(self, text: str) -> str:
        """A text in round brackets."""
        return f"({text})"

    def name(self, name: Name) -> str:
        """A name with subscripts and dots."""
        raise NotImplementedError

    def number(self, text: str) -> str:
        """A number, with a power of ten if it has an exponent."""
        mantissa, _, exponent = text.partition("e")
        if not exponent:
            return text
        power = self.ten(exponent)
        return power if mantissa == "1" else f"{mantissa}{self.dot}{power}"

    dot = "·"

    def ten(self, exponent: str) -> str:
        """A power of ten with this exponent."""
        raise NotImplementedError

    def between(self, left: Math, right: Math, sign: str) -> str:
        """The sign or space between two factors.

        Args:
            left: the factor before.
            right: the factor after.
            sign: ``·`` or ``×``, or nothing.
        """
        return f" {sign} " if sign else self.multiplied

    def related(self, sign: str) -> str:
        """The relation sign between two sides."""
        return f" {sign} "

    def quotient(self, above: Math, below: Math) -> str:
        """A fraction of two trees.

        Args:
            above: the numerator.
            below: the denominator.
        """
        raise NotImplementedError

    def raised(self, base: str, exponent: Math) -> str:
        """A base with an exponent.

        Args:
            base: as written, in brackets where needed.
            exponent: the exponent.
        """
        raise NotImplementedError

    def root(self, of: Math) -> str:
        """The square root of a tree."""
        raise NotImplementedError

    def call(self, name: str, arguments: Sequence[Math], *, bare: bool) -> str:
        """A function with its arguments.

        Args:
            name: of the function.
            arguments: its arguments.
            bare: whether a single name needs no brackets.
        """
        raise NotImplementedError

    def called_power(self, call: FunctionCall, exponent: Math, *, bare: bool) -> str:
        """A power of a function.

        Args:
            call: the function with its arguments.
            exponent: the exponent.
            bare: whether a single name as argument needs no brackets.
        """
        raise NotImplementedError

    def grid(self, rows: Sequence[Sequence[str]]) -> str:
        """A matrix, given by the written entries of its rows."""
        raise NotImplementedError

    def over(self, sign: str, under: str, body: Math) -> str:
        """An operator applied to a tree.

        Args:
            sign: ``Σ``, ``d/dt`` or another operator.
            under: its range as text, or nothing.
            body: the tree to which it applies.
        """
        raise NotImplementedError

    def raw(self, tree: Raw) -> str:
        """The output of another printer, as plain text."""
        return tree.text


def _function(tree: Math) -> bool:
    base = tree.base if isinstance(tree, Power) else tree
    return isinstance(base, FunctionCall)

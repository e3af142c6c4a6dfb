"""Formulas in the presentation elements of MathML Core, which browsers draw without a script."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from linegraph.notation.latex import _wide
from linegraph.notation.tree import TRANSPOSED, FunctionCall, Math, Name, Numeral, Raw
from linegraph.notation.writing import ATOM, SUM, Writer, digits, numbered, solid, visible

if TYPE_CHECKING:
    from collections.abc import Sequence

_DOTS = ("", "˙", "¨", "⃛")
_BOLD = {
    chr(start + k): chr(bold + k)
    for start, count, bold in (
        (ord("A"), 26, 0x1D468),
        (ord("a"), 26, 0x1D482),
        (ord("Α"), 25, 0x1D71C),
        (ord("α"), 25, 0x1D736),
    )
    for k in range(count)
}
"""Letters and their bold italic forms, separate characters in mathematical fonts."""

THIN = '<mspace width="0.17em"/>'


def element(tag: str, text: str) -> str:
    """An element that contains a text, which is escaped.

    Args:
        tag: name of the element.
        text: any text.
    """
    return f"<{tag}>{escape(visible(text), quote=False)}</{tag}>"


class MathMl(Writer):
    """Writes a tree as the content of a ``math`` element."""

    minus = '<mo form="prefix">−</mo>'
    comma = "<mo>,</mo>"

    def bracketed(self, text: str) -> str:
        """Round brackets that do not stretch, so that a line may be broken between them."""
        return f'<mo stretchy="false">(</mo>{text}<mo stretchy="false">)</mo>'

    def one(self, text: str) -> str:
        """A text as a single element, in a row if it is several."""
        return text if _single(text) else f"<mrow>{text}</mrow>"

    def name(self, name: Name) -> str:
        """A letter in italics or a word as one name, with its dots; subscripts that are words are upright."""
        text = self._letter(name.letter, name.bold)
        if name.dots:
            dots = _DOTS[min(name.dots, 3)]
            text = f'<mover accent="true">{text}<mo>{dots}</mo></mover>'
        if name.subs:
            low = ("" if digits(name.subs) else "<mo>,</mo>").join(map(self._sub, name.subs))
            text = f"<msub>{text}{self.one(low)}</msub>"
        if name.before:
            return f'<mi mathvariant="normal">{escape(name.before)}</mi>{text}'
        return text

    def _letter(self, text: str, bold: bool) -> str:
        shown = escape(visible(text), quote=False)
        if bold and len(text) == 1 and text in _BOLD:
            return f"<mi>{_BOLD[text]}</mi>"
        if bold:
            return f'<mi class="b">{shown}</mi>'
        return f"<mi>{shown}</mi>" if len(text) == 1 else f'<mi class="w">{shown}</mi>'

    def _sub(self, text: str) -> str:
        letter, number = numbered(text)
        if number:
            return f"<msub>{self._sub(letter)}{element('mn', number)}</msub>"
        return element("mn" if text.isdigit() else "mi", text)

    def number(self, text: str) -> str:
        """A number, with a power of ten if it has an exponent."""
        mantissa, _, exponent = text.partition("e")
        if not exponent:
            return f"<mn>{text}</mn>"
        shown = exponent.replace("-", "−")
        power = f"<msup><mn>10</mn><mn>{shown}</mn></msup>"
        if mantissa == "1":
            return power
        return f"<mrow><mn>{mantissa}</mn><mo>·</mo>{power}</mrow>"

    def signed(self, negative: bool) -> str:
        """The sign between two summands, infix even at the start of a line."""
        return f'<mo form="infix">{"−" if negative else "+"}</mo>'

    def between(self, left: Math, right: Math, sign: str) -> str:
        """A thin space beside words, a dot between numbers, else an invisible multiplication sign."""
        if sign:
            return f"<mo>{sign}</mo>"
        if isinstance(left, Numeral) and isinstance(right, Numeral):
            return "<mo>·</mo>"
        return THIN if _wide(left) or _wide(right) else "<mo>\u2062</mo>"

    def related(self, sign: str) -> str:
        """The relation sign between two sides."""
        return f'<mo form="infix">{escape(sign)}</mo>'

    def quotient(self, above: Math, below: Math) -> str:
        """A fraction, with a line between its parts."""
        return f"<mfrac>{self.one(self.whole(above))}{self.one(self.whole(below))}</mfrac>"

    def raised(self, base: str, exponent: Math) -> str:
        """A base with its exponent raised."""
        above = self.one(self.whole(exponent))
        if exponent == TRANSPOSED:
            above = '<mi mathvariant="normal">T</mi>'
        return f"<msup>{self.one(solid(base))}{above}</msup>"

    def root(self, of: Math) -> str:
        """A square root under its sign."""
        return f"<msqrt>{self.whole(of)}</msqrt>"

    def call(self, name: str, arguments: Sequence[Math], *, bare: bool) -> str:
        """A function of its arguments, an absolute value between bars."""
        if name == "abs":
            inner = self.whole(arguments[0])
            return f'<mrow><mo stretchy="false">|</mo>{inner}<mo stretchy="false">|</mo></mrow>'
        return self._called(element("mi", name), arguments, bare)

    def called_power(self, call: FunctionCall, exponent: Math, *, bare: bool) -> str:
        """A power of a function, with the exponent after its name: ``sin² x``."""
        if call.name == "abs":
            return self.raised(self.write(call), exponent)
        named = f"<msup>{element('mi', call.name)}{self.one(self.whole(exponent))}</msup>"
        return self._called(named, call.arguments, bare)

    def _called(self, named: str, arguments: Sequence[Math], bare: bool) -> str:
        if bare and len(arguments) == 1 and isinstance(arguments[0], Name):
            return f"{named}{THIN}{self.whole(arguments[0])}"
        return named + solid_bracket(self.comma.join(self.whole(a) for a in arguments))

    def grid(self, rows: Sequence[Sequence[str]]) -> str:
        """A matrix in square brackets."""
        lines = "".join(
            f"<mtr>{''.join(f'<mtd>{cell}</mtd>' for cell in row)}</mtr>" for row in rows
        )
        return f"<mrow><mo>[</mo><mtable>{lines}</mtable><mo>]</mo></mrow>"

    def over(self, sign: str, under: str, body: Math) -> str:
        """An operator with its range underneath."""
        inner = self.held(body, ATOM if sign == "d/dt" else SUM)
        if sign == "d/dt":
            first, second = ("<mi>d</mi>", "<mrow><mi>d</mi><mi>t</mi></mrow>")
            return f"<mfrac>{first}{second}</mfrac>{inner}"
        shown = f"<mo>{escape(sign)}</mo>"
        return (f"<munder>{shown}{element('mtext', under)}</munder>" if under else shown) + inner

    def raw(self, tree: Raw) -> str:
        """The plain text of another printer."""
        return element("mtext", tree.text)


def solid_bracket(text: str) -> str:
    """Round brackets that do not stretch, around an argument."""
    return f'<mo stretchy="false">(</mo>{text}<mo stretchy="false">)</mo>'


def _single(text: str) -> bool:
    """Whether a text consists of exactly one element."""
    if not text.startswith("<") or not text.endswith(">"):
        return False
    depth = 0
    place = 0
    while place < len(text):
        end = text.index(">", place)
        if text[place] != "<":
            place = text.index("<", place)
            continue
        tag = text[place : end + 1]
        if tag.startswith("</"):
            depth -= 1
        elif not tag.endswith("/>"):
            depth += 1
        place = end + 1
        if depth == 0 and place < len(text):
            return False
    return depth == 0

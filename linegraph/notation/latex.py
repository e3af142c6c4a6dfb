"""Formulas in LaTeX with amsmath. All text from a model is escaped."""

from __future__ import annotations

import unicodedata
from typing import TYPE_CHECKING

from linegraph.notation.names import LATEX_GREEK
from linegraph.notation.tree import (
    TRANSPOSED,
    Fraction,
    FunctionCall,
    Math,
    Name,
    Numeral,
    Product,
    Raw,
)
from linegraph.notation.writing import ATOM, SIDES, SUM, Writer, digits, numbered, visible

if TYPE_CHECKING:
    from collections.abc import Sequence

_ESCAPES = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    "`": r"\textasciigrave{}",
    "'": r"\textquotesingle{}",
    '"': r"\textquotedbl{}",
    "-": "{-}",
    "·": r"\ensuremath{\cdot}",
    "²": r"\ensuremath{^2}",
    "³": r"\ensuremath{^3}",
    "°": r"\ensuremath{^\circ}",
    "−": r"\ensuremath{-}",
    "×": r"\ensuremath{\times}",
    "→": r"\ensuremath{\to}",
    "∞": r"\ensuremath{\infty}",
    "Σ": r"\ensuremath{\sum}",
    "ℓ": r"\ensuremath{\ell}",
    "̇": "'",
    "ᵀ": r"\ensuremath{^{\mathsf{T}}}",
    "…": r"\dots{}",
    "ł": "l",
    "ø": "o",
    "–": "--",
}

_FUNCTIONS = ("sin", "cos", "tan", "exp", "ln", "sinh", "cosh", "tanh", "max", "min")
_SIGNS = {"×": r"\times ", "·": r"\cdot ", "≈": r"\approx ", "≤": r"\le ", "→": r"\to "}
_ACCENTS = ("", r"\dot", r"\ddot", r"\dddot")
_OVER = {"Σ": r"\sum", "d/dt": r"\frac{\mathrm{d}}{\mathrm{d}t}"}
_BEFORE = {"δ": r"\delta ", "Δ": r"\Delta "}


def escaped(text: str) -> str:
    r"""Any text for LaTeX's text mode: printable, on one line, without commands.

    Example:
        >>> escaped("50 % of a_1")
        '50 \\% of a\\_1'
    """
    return "".join(map(_letter, visible(text)))


def _letter(c: str) -> str:
    if c in _ESCAPES:
        return _ESCAPES[c]
    if c.isascii():
        return c
    if c in LATEX_GREEK:
        return rf"\ensuremath{{{_greek(c)}}}"
    base = "".join(x for x in unicodedata.normalize("NFKD", c) if not unicodedata.combining(x))
    if base.isascii() and base.isalnum():
        return base
    return rf"\textless{{}}U+{ord(c):04X}\textgreater{{}}"


def _greek(letter: str) -> str:
    return "o" if letter == "ο" else LATEX_GREEK[letter]


class Latex(Writer):
    """Writes a tree as LaTeX for math mode."""

    minus = "-"
    comma = r",\allowbreak\ "

    def name(self, name: Name) -> str:
        """A letter in italics or a word as one name, with accents; subscripts that are words are upright."""
        text = self._letter(name.letter)
        if name.bold:
            text = rf"\boldsymbol{{{text}}}"
        if name.dots:
            accent = _ACCENTS[min(name.dots, 3)]
            text = rf"{accent}{{{text}}}"
        if name.subs:
            text += f"_{{{('' if digits(name.subs) else ',').join(map(self._sub, name.subs))}}}"
        return f"{_BEFORE.get(name.before, name.before)}{text}"

    def _letter(self, text: str) -> str:
        if text in LATEX_GREEK:
            return _greek(text)
        if text == "ℓ":
            return r"\ell "
        if len(text) == 1 and text.isascii() and text.isalpha():
            return text
        if text.isascii() and text.isalnum():
            return rf"\mathit{{{text}}}"
        return rf"\textit{{{escaped(text)}}}"

    def _sub(self, text: str) -> str:
        letter, number = numbered(text)
        if number:
            return f"{self._sub(letter)}_{{{number}}}"
        if text in LATEX_GREEK:
            return _greek(text)
        if text.isascii() and (text.isdigit() or (len(text) == 1 and text.isalpha())):
            return text
        if text.isascii() and text.isalnum():
            return rf"\mathrm{{{text}}}"
        return rf"\text{{{escaped(text)}}}"

    dot = r" \cdot "

    def ten(self, exponent: str) -> str:
        """A power of ten with its exponent raised."""
        return f"10^{{{exponent}}}"

    def between(self, left: Math, right: Math, sign: str) -> str:
        """Nothing between letters, a thin space beside words, a dot between numbers."""
        if sign:
            return f" {_SIGNS.get(sign, sign)}"
        if isinstance(left, Numeral) and isinstance(right, Numeral):
            return r" \cdot "
        return r"\," if _wide(left) or _wide(right) else " "

    def related(self, sign: str) -> str:
        """The relation sign between two sides, as a LaTeX command."""
        return f" {_SIGNS.get(sign, sign)} "

    def quotient(self, above: Math, below: Math) -> str:
        """A fraction; a small one if it is of two numbers."""
        small = isinstance(above, Numeral) and isinstance(below, Numeral)
        command = r"\tfrac" if small else r"\frac"
        return rf"{command}{{{self.whole(above)}}}{{{self.whole(below)}}}"

    def raised(self, base: str, exponent: Math) -> str:
        """A base with its exponent raised."""
        inner = self.whole(exponent)
        if exponent == TRANSPOSED:
            inner = r"\mathsf{T}"
        return (
            f"{{{base}}}^{{{inner}}}"
            if base.startswith("\\") or "_" in base
            else f"{base}^{{{inner}}}"
        )

    def root(self, of: Math) -> str:
        """A square root under its sign."""
        return rf"\sqrt{{{self.whole(of)}}}"

    def call(self, name: str, arguments: Sequence[Math], *, bare: bool) -> str:
        """A function of its arguments, an absolute value between bars."""
        return self._called(self._function(name), arguments, bare)

    def called_power(self, call: FunctionCall, exponent: Math, *, bare: bool) -> str:
        """A power of a function, with the exponent after its name: ``sin² x``."""
        if call.name == "abs":
            return self.raised(self.write(call), exponent)
        named = f"{self._function(call.name)}^{{{self.whole(exponent)}}}"
        return self._called(named, call.arguments, bare)

    def _called(self, named: str, arguments: Sequence[Math], bare: bool) -> str:
        if named == "abs":
            return rf"\lvert {self.whole(arguments[0])}\rvert "
        if bare and len(arguments) == 1 and isinstance(arguments[0], Name):
            return f"{named} {self.whole(arguments[0])}"
        return f"{named}({', '.join(self.whole(a) for a in arguments)})"

    def _function(self, name: str) -> str:
        if name == "abs":
            return name
        return f"\\{name}" if name in _FUNCTIONS else rf"\operatorname{{{escaped(name)}}}"

    def grid(self, rows: Sequence[Sequence[str]]) -> str:
        """A matrix in square brackets."""
        lines = r" \\ ".join(" & ".join(row) for row in rows)
        return rf"\begin{{bmatrix}} {lines} \end{{bmatrix}}"

    def over(self, sign: str, under: str, body: Math) -> str:
        """An operator with its range as a subscript."""
        low = rf"_{{\text{{{escaped(under)}}}}}" if under else ""
        inner = self.held(body, ATOM if sign == "d/dt" else SUM)
        return f"{_OVER.get(sign, sign)}{low} {inner}"

    def raw(self, tree: Raw) -> str:
        """The LaTeX of another printer, unchanged."""
        return tree.latex


def _wide(tree: Math) -> bool:
    """Whether a thin space makes a factor easier to read."""
    match tree:
        case Name(letter, subs):
            return len(letter) > 1 or bool(subs and not subs[0].isdigit())
        case Numeral():
            return False
        case Product() | Fraction():
            return isinstance(tree, Product)
    base = getattr(tree, "base", tree)
    if isinstance(base, Name):
        return _wide(base)
    return isinstance(base, FunctionCall)


__all__ = ["SIDES", "Latex", "escaped"]

"""Formulas as plain text: ``(J + l²·m)·a″ + g·l·m·sin(a) = 0``.

Every product has its sign and every function its brackets, so that the text is unambiguous.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.notation.tree import FunctionCall, Math, Name, Numeral, Raw
from linegraph.notation.writing import (
    ATOM,
    POWER,
    SUBSCRIPTS,
    SUM,
    SUPERSCRIPTS,
    Writer,
    digits,
    solid,
    visible,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

PRIMES = ("", "′", "″", "‴")


class Plain(Writer):
    """Writes a tree as plain text."""

    multiplied = "·"
    minus = "−"
    fractions = False

    def name(self, name: Name) -> str:
        """A name with digits as subscripts, other subscripts after ``_``, and primes for dots."""
        subs = [visible(sub) for sub in name.subs]
        if (len(subs) == 1 and subs[0].isascii() and subs[0].isdigit()) or digits(subs):
            tail = "".join(subs).translate(SUBSCRIPTS)
        else:
            tail = "".join(f"_{sub}" for sub in subs)
        dots = PRIMES[name.dots] if name.dots < len(PRIMES) else f"^({name.dots})"
        return f"{name.before}{visible(name.letter)}{tail}{dots}"

    def ten(self, exponent: str) -> str:
        """A power of ten with its exponent as superscript."""
        return f"10{exponent.translate(SUPERSCRIPTS)}"

    def signed(self, negative: bool) -> str:
        """The sign between two summands, with spaces."""
        return " − " if negative else " + "

    def quotient(self, above: Math, below: Math) -> str:
        """A fraction with a slash."""
        top, bottom = self.held(above, POWER), self.held(below, POWER)
        return solid(f"{top}/{bottom}")

    def raised(self, base: str, exponent: Math) -> str:
        """A base with its exponent, an integer as superscript."""
        text = self.whole(exponent).replace("−", "-")
        if text.removeprefix("-").isdigit() or text == "T":
            return base + text.translate(SUPERSCRIPTS)
        return f"{base}^{self.bracketed(self.whole(exponent))}"

    def root(self, of: Math) -> str:
        """A square root with brackets after its sign."""
        return f"√({self.whole(of)})"

    def call(self, name: str, arguments: Sequence[Math], *, bare: bool) -> str:
        """A function with its arguments in brackets."""
        return f"{name}({', '.join(self.whole(a) for a in arguments)})"

    def called_power(self, call: FunctionCall, exponent: Math, *, bare: bool) -> str:
        """A power of a function, with the exponent after its name: ``sin²(x)``."""
        if isinstance(exponent, Numeral) and exponent.text.isdigit():
            inner = ", ".join(self.whole(a) for a in call.arguments)
            return f"{call.name}{exponent.text.translate(SUPERSCRIPTS)}({inner})"
        return self.raised(self.bracketed(self.write(call)), exponent)

    def grid(self, rows: Sequence[Sequence[str]]) -> str:
        """A matrix row by row, separated by semicolons; a column as (x, y, z)."""
        if all(len(row) == 1 for row in rows):
            return f"({', '.join(row[0] for row in rows)})"
        return f"[{'; '.join(', '.join(row) for row in rows)}]"

    def over(self, sign: str, under: str, body: Math) -> str:
        """An operator with its range after ``_``."""
        low = f"_{under}" if under else ""
        inner = self.held(body, ATOM if sign == "d/dt" else SUM)
        return f"{sign}{low}{'' if inner.startswith('(') else ' '}{inner}"

    def raw(self, tree: Raw) -> str:
        """The plain text of another printer."""
        return visible(tree.text)

"""Expressions of algorithms as text, for languages with infix operators.

A language derives from `Phrases` and says what it writes differently: its words, and how it reads an entry
of an array or calls a function. Parentheses stand where the grouping needs them, or wherever operators of
different precedence meet (`bracketed`).
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, ClassVar

from codegen.printer import number
from linegraph.ir.statements import (
    ArrayEntry,
    ArrayPart,
    Bound,
    Choice,
    Count,
    Detail,
    Infinity,
    Intrinsic,
    Invocation,
    Literal,
    LocalVariable,
    Minus,
    NamedNumber,
    Not,
    Operation,
    ValueKind,
)

if TYPE_CHECKING:
    from linegraph.ir.rounding import Rounding
    from linegraph.ir.statements import Expression

CHOICE, OR, AND, NOT, COMPARISON, SUM, PRODUCT, SIGN, ATOM = range(9)
"""How tightly a text holds together, as in Python."""

LEVELS = {
    "or": OR,
    "and": AND,
    **dict.fromkeys(("<", "<=", ">", ">=", "==", "!="), COMPARISON),
    **dict.fromkeys("+-", SUM),
    **dict.fromkeys("*/", PRODUCT),
}


class Phrases:
    """Prints expressions; `small` are the bounds of rounding for the language's numbers.

    Attributes:
        bracketed: whether operators of different precedence are always apart.
        words: what operators are called that are not called as in C and Python alike.
    """

    bracketed = False
    words: ClassVar = {"and": "and", "or": "or"}

    def __init__(self, small: Rounding) -> None:
        """Bounds of rounding are those of the language's own numbers."""
        self.small = small

    def text(self, x: Expression) -> str:
        """An expression as it stands alone."""
        return self.held(x)[0]

    def operand(self, x: Expression, level: int, *, right: bool = False) -> str:
        """An operand as text, in parentheses where precedence requires them.

        Args:
            x: the operand.
            level: the precedence of the operator around it, one of `LEVELS`.
            right: whether it is the right operand, which has parentheses at equal precedence, too.
        """
        text, own = self.inner(x)
        apart = own < level or (right and own == level)
        if self.bracketed:
            apart = apart or (own < ATOM and own != level and (right or own != SIGN))
        return f"({text})" if apart else text

    def inner(self, x: Expression) -> tuple[str, int]:
        """The text of an operand, and how tightly it holds together."""
        return self.held(x)

    def held(self, x: Expression) -> tuple[str, int]:
        """The text of an expression, and how tightly it holds together."""
        match x:
            case Operation():
                return self.operation(x)
            case Minus():
                return f"-{self.operand(x.a, ATOM)}", SIGN
            case Not():
                return self.opposite(x.a)
            case Choice():
                return self.choice(x)
            case Intrinsic():
                return self.intrinsic(x)
            case Invocation():
                return self.invocation(x), ATOM
            case ArrayEntry():
                return f"{self.array(x.array)}[{self.text(x.place)}]", ATOM
            case LocalVariable():
                return self.variable(x), ATOM
            case Literal(value=value):
                return self.literal(value), ATOM if value >= 0 else SIGN
            case Bound():
                return self.literal(getattr(self.small, x.name)), ATOM
            case Count():
                return self.count(x), ATOM
            case NamedNumber():
                return self.code(x), ATOM
            case Infinity():
                return self.infinity(), ATOM
            case Detail():
                raise ValueError(f"{x.name} is not bound")

    def operation(self, x: Operation) -> tuple[str, int]:
        """Two operands with an operator between them, grouped from the left."""
        level = LEVELS[x.operator]
        a, b = self.operand(x.a, level), self.operand(x.b, level, right=True)
        return f"{a} {self.words.get(x.operator, x.operator)} {b}", level

    def opposite(self, a: Expression) -> tuple[str, int]:
        """That something is not so."""
        return f"not {self.operand(a, NOT)}", NOT

    def choice(self, x: Choice) -> tuple[str, int]:
        """One of two values."""
        a, test, b = self.operand(x.a, OR), self.operand(x.test, OR), self.operand(x.b, CHOICE)
        return f"{a} if {test} else {b}", CHOICE

    def intrinsic(self, x: Intrinsic) -> tuple[str, int]:
        """A call of a function that every language has."""
        return f"{x.name}({', '.join(map(self.text, x.arguments))})", ATOM

    def invocation(self, x: Invocation) -> str:
        """A call of another procedure."""
        arguments = [
            self.part(y) if isinstance(y, ArrayPart) else self.text(y) for y in x.arguments
        ]
        return f"{self.procedure(x)}({', '.join([*map(self.array, x.context), *arguments])})"

    # ---- words

    def procedure(self, x: Invocation) -> str:
        """The name of a procedure in the emitted code."""
        return x.procedure

    def part(self, x: ArrayPart) -> str:
        """An array as an argument."""
        return self.array(x.array)

    def array(self, name: str) -> str:
        """An array by its name, or another argument that is passed on."""
        return name

    def variable(self, x: LocalVariable) -> str:
        """A variable by its name."""
        return x.name

    def count(self, x: Count) -> str:
        """A count of the module."""
        return x.name

    def code(self, x: NamedNumber) -> str:
        """A number with a name."""
        return x.name

    def literal(self, value: bool | int | float) -> str:
        """A number, true or false."""
        if isinstance(value, int):
            return str(value)
        return re.sub(r"e([+-]?)0*(?=\d)", lambda x: f"e{x[1].strip('+')}", number(value))

    def infinity(self) -> str:
        """A number above all others."""
        return "infinity"

    def is_switch(self, x: Expression) -> bool:
        """Whether something true or false is kept in a variable, or returned by a procedure."""
        return x.kind is ValueKind.BOOL and isinstance(x, LocalVariable | Invocation | Literal)


def wrapped(line: str, width: int, *, shallowest: int = 0) -> list[str]:
    """A line of code in lines of at most `width`, further ones indented by four more.

    It is broken after commas and before operators, where as few brackets as possible are open. A line
    without such a place stays longer.

    Args:
        line: the line with its indentation.
        width: the most characters of a line.
        shallowest: how many brackets must be open at least, 1 for languages in which newlines end statements.
    """
    lines = [line]
    while len(lines[-1]) > width:
        line = lines[-1]
        indent = len(line) - len(line.lstrip())
        depth, best, place = 0, (99, 0), 0
        for at, sign in enumerate(line[: width + 1]):
            depth += (sign in "([{") - (sign in ")]}")
            ends = line[at] == " " and (
                line[at - 1] == "," or re.match(r" (?:&&|\|\||and|or|[-+*/?:]) ", line[at:])
            )
            key = (depth, -at)
            if ends and at > indent + 8 and depth >= shallowest and key <= best:
                best, place = key, at
        if not place:
            break
        more = 4 if len(lines) == 1 else 0
        lines[-1:] = [line[:place], " " * (indent + more) + line[place + 1 :]]
    return lines

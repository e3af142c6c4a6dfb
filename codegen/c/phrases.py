"""Expressions of algorithms in C."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from codegen.phrases import ATOM, CHOICE, COMPARISON, Phrases
from linegraph.ir.rounding import DOUBLE, FLOAT
from linegraph.ir.statements import Literal, Minus, Not, Operation, ValueKind

if TYPE_CHECKING:
    from linegraph.ir.program import Module
    from linegraph.ir.statements import (
        ArrayPart,
        Choice,
        Count,
        Expression,
        Intrinsic,
        Invocation,
        NamedNumber,
    )

_FUNCTIONS = {"abs": "fabs", "sqrt": "sqrt", "larger": "fmax"}


class CPhrases(Phrases):
    """Expressions of C: brackets wherever operators meet; true and false are 1 and 0."""

    bracketed = True
    words: ClassVar = {"and": "&&", "or": "||"}

    def __init__(self, module: Module, real: str, routine: str, own: frozenset[str]) -> None:
        """Take names and bounds of rounding from the module and its number type.

        Args:
            module: the module; its name is the prefix of all functions and macros.
            real: ``double`` or ``float``.
            routine: the name of the routine being printed; empty for shared procedures.
            own: the procedures that belong to this routine, whose names contain that of the routine.
        """
        super().__init__(FLOAT if real == "float" else DOUBLE)
        self.prefix, self.macro = module.name, module.name.upper()
        self.routine, self.own = routine, own

    def condition(self, x: Expression) -> str:
        """An expression as a condition in C."""
        return self.test(x)[0]

    def test(self, x: Expression) -> tuple[str, int]:
        """An expression as a condition, with the precedence of its text."""
        if self.is_switch(x):
            return f"{super().held(x)[0]} == 1", COMPARISON
        return super().held(x)

    def held(self, x: Expression) -> tuple[str, int]:
        """An expression as a value; a condition becomes 1 or 0."""
        if x.kind is ValueKind.BOOL and isinstance(x, Operation | Not):
            return f"({self.condition(x)}) ? 1 : 0", CHOICE
        return super().held(x)

    def inner(self, x: Expression) -> tuple[str, int]:
        """Operands that are true or false are conditions."""
        return self.test(x) if x.kind is ValueKind.BOOL else self.held(x)

    def opposite(self, a: Expression) -> tuple[str, int]:
        """That something is not so, even if a number compared is none."""
        if self.is_switch(a):
            return f"{super().held(a)[0]} == 0", COMPARISON
        return f"!({self.condition(a)})", ATOM

    def choice(self, x: Choice) -> tuple[str, int]:
        """One of two values, operations in brackets."""
        a, b = (self._bracketed(y) for y in (x.a, x.b))
        return f"({self.condition(x.test)}) ? {a} : {b}", CHOICE

    def _bracketed(self, x: Expression) -> str:
        text, own = self.held(x)
        return f"({text})" if own < ATOM and not isinstance(x, Minus | Literal) else text

    def intrinsic(self, x: Intrinsic) -> tuple[str, int]:
        """Functions of <math.h>, quotients and conversions."""
        if x.name == "ratio":
            a, b = x.arguments
            return self.operation(Operation("/", a, b, ValueKind.REAL))
        if x.name == "float":
            text, own = self.held(x.arguments[0])
            return f"(double){text}" if own == ATOM else f"(double)({text})", ATOM
        return f"{_FUNCTIONS[x.name]}({', '.join(map(self.text, x.arguments))})", ATOM

    def procedure(self, x: Invocation) -> str:
        """A procedure of the routine's own, or a shared one."""
        middle = f"{self.routine}_" if x.procedure in self.own else ""
        return f"{self.prefix}_{middle}{x.procedure}"

    def part(self, x: ArrayPart) -> str:
        """A pointer to the first entry."""
        return x.array if x.start is None else f"&{x.array}[{self.text(x.start)}]"

    def count(self, x: Count) -> str:
        """The macro of the header."""
        return f"{self.macro}_{x.name}"

    def code(self, x: NamedNumber) -> str:
        """A constant of the file."""
        return f"{self.macro}_{x.name}"

    def literal(self, value: bool | int | float) -> str:
        """True and false are numbers."""
        return str(int(value)) if isinstance(value, bool) else super().literal(value)

    def infinity(self) -> str:
        """The macro of <math.h> for infinity."""
        return "HUGE_VAL"

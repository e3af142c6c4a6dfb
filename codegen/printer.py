"""The one printer of expressions: a `Program` becomes lines of assignments and texts of results.

Languages of C's family agree on ``+ - * /``, their precedence and left-to-right grouping, so one
printer serves them all, and the value and order of evaluation are the same in each. Parentheses
stand exactly where the grouping needs them. What differs between languages is said by a `Syntax`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.errors import ModelError
from linegraph.ir.dag import ADD, DIV, MUL, NEG, SUB, SYMBOL, Node

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.ir.dag import Number, Operand
    from linegraph.ir.program import Check, Program

_SIGNED, _SUM, _PRODUCT, _ATOM = range(4)
"""How tightly a text holds together; one that starts with a sign is never an operand as it is."""

_INFIX = {
    ADD: (" + ", _SUM, True),
    SUB: (" - ", _SUM, False),
    MUL: (" * ", _PRODUCT, True),
    DIV: (" / ", _PRODUCT, False),
}
"""For each infix operation: its operator, its precedence, and whether it commutes."""


_BARE: dict[int, tuple[int, ...]] = {_SIGNED: (), _SUM: (), _PRODUCT: ()}
_MIXED: dict[int, tuple[int, ...]] = {_SIGNED: (_SUM, _PRODUCT), _SUM: (_PRODUCT,), _PRODUCT: ()}
"""Within what operators of which others get brackets that they do not need."""


@dataclass(frozen=True)
class Syntax:
    """The differences in syntax between target languages.

    Attributes:
        before: what stands before the name in an assignment, indentation included.
        after: what ends an assignment.
        member: what gives access to a parameter, e.g. ``p->``.
        functions: what each function is called, its bracket included.
        comment: the line that says a label.
        check: the lines that stop the function unless the first text is greater than the second.
        divided: the function that divides even by zero, its bracket included; empty where ``/`` does.
        bracketed: whether brackets stand wherever operators of different precedence meet.
        tolerance: a fraction that stands for the rounding of doubles, as it is for the language's numbers.
    """

    before: str
    after: str
    member: str
    functions: Mapping[str, str]
    comment: Callable[[str], str]
    check: Callable[[str, str, Check], list[str]]
    divided: str = ""
    bracketed: bool = False
    tolerance: Callable[[float], float] = float


@dataclass(frozen=True)
class PrintedBody:
    """A printed program.

    Attributes:
        lines: comments, assignments and checks in order.
        results: for each result the texts of its entries.
        used: the names of the arguments and local arrays that are read.
    """

    lines: Sequence[str]
    results: Sequence[Sequence[str]]
    used: frozenset[str]


def number(x: Number) -> str:
    """A constant as the shortest decimal that reads back as the same double; never an integer.

    Raises:
        ModelError: it is not a finite double.
    """
    try:
        value = float(x)
    except OverflowError:
        value = math.inf
    if not math.isfinite(value):
        problem = "a number computed from the model's values is too large, or not a number"
        raise ModelError("", f"{problem}: scale the values (SI units)")
    return repr(value)


def print_program(program: Program, notation: Syntax) -> PrintedBody:
    """A program as assignments, checks and expressions of one language.

    Args:
        program: the program.
        notation: the syntax of the language.

    Raises:
        ModelError: a constant is not a finite number.
    """
    printer = Printer(program, notation)
    lines = printer.assignments(program)
    results = [[printer.text(x) for x in result.entries] for result in program.results]
    return PrintedBody(lines, results, frozenset(printer.used))


class Printer:
    """Prints the nodes of one program, in order.

    Methods call each other only for nodes without a name, whose depth `INLINE_LIMIT` bounds.

    Attributes:
        known: by index, the names of nodes that have been assigned.
        read: by index, the texts of symbols that have been read.
        used: the arguments that have been read since `begin`.
    """

    def __init__(self, program: Program, notation: Syntax) -> None:
        """Start without any assigned node.

        Args:
            program: the program whose nodes are printed.
            notation: the syntax of the language.
        """
        self.notation = notation
        self.mixed = _MIXED if notation.bracketed else _BARE
        self.turned = program.turned
        self.guarded = program.guarded if notation.divided else frozenset[int]()
        self.known: dict[int, str] = {}
        self.read: dict[int, str] = {}
        self.used: set[str] = set()

    def assignments(self, program: Program) -> list[str]:
        """One line for each step, a comment where the label changes, checks as early as can be."""
        notation, known = self.notation, self.known
        before, after = notation.before, notation.after
        due = _due(program)
        lines: list[str] = []
        for check in due.get(-1, ()):
            lines += self.check(check)
        label = ""
        for count, node in enumerate(program.steps):
            if node.label != label:
                label = node.label
                if label:
                    lines.append(notation.comment(label))
            lines.append(f"{before}t{count} = {self.expression(node)[0]}{after}")
            known[node.index] = f"t{count}"
            if count in due:
                for check in due[count]:
                    lines += self.check(check)
        return lines

    def begin(self) -> set[str]:
        """Begin a new `used`, which is returned."""
        self.read = {}
        self.used = set()
        return self.used

    def check(self, check: Check) -> list[str]:
        """The lines of one check."""
        return self.notation.check(self.text(check.node), self.bound(check), check)

    def bound(self, check: Check) -> str:
        """The text of the bound that a check must exceed."""
        if check.fraction is None:
            return self.text(check.bound)
        fraction = self.notation.tolerance(check.fraction)
        if not isinstance(check.bound, Node):
            return number(fraction * check.bound)
        text, level = self.held(check.bound)
        if level < _PRODUCT:
            text = f"({text})"
        scale = number(fraction)
        product = f"{text} * {scale}" if level == _PRODUCT else f"{scale} * {text}"
        return f"({product})" if self.notation.bracketed else product

    def text(self, x: Operand) -> str:
        """An operand as it stands alone."""
        if not isinstance(x, Node):
            return number(x)
        return self.known.get(x.index) or self.expression(x)[0]

    def held(self, x: Operand) -> tuple[str, int]:
        """The text of an operand, and how tightly it holds together."""
        if not isinstance(x, Node):
            return number(x), _ATOM
        text = self.known.get(x.index)
        return self.expression(x) if text is None else (text, _ATOM)

    def expression(self, node: Node) -> tuple[str, int]:
        """The operation itself, even of a named node, and how tightly its text holds together.

        Sums and products change places where that saves parentheses; it does not change a bit.
        """
        infix = _INFIX.get(node.op)
        if infix is None:
            return self.prefix(node)
        if node.index in self.guarded:
            return f"{self.notation.divided}{self.text(node.a)}, {self.text(node.b)})", _ATOM
        sign, level, commutes = infix
        a, b = node.a, node.b
        if sign == " - " and node.index in self.turned:
            a, b = b, a
        left, first = self.held(a)
        if not isinstance(b, Node):
            return self.constant(left, first, sign, level, b), level
        right, second = self.held(b)
        if commutes and first > level == second:
            left, first, right, second = right, second, left, first
        apart = self.mixed[level]
        if first < level or first in apart:
            left = f"({left})"
        if second <= level or second in apart:
            right = f"({right})"
        return f"{left}{sign}{right}", level

    def constant(self, left: str, first: int, sign: str, level: int, b: Number) -> str:
        """An operation whose second operand is a number.

        ``x + -2`` is ``x - 2`` and ``x * 2`` is ``2 * x``, to the last bit.

        Args:
            left: the text of the first operand.
            first: how tightly this text holds together.
            sign: the operator, with the spaces around it.
            level: the precedence of the operator.
            b: the number.
        """
        if first < level or first in self.mixed[level]:
            left = f"({left})"
        if level == _SUM and b < 0:
            return f"{left}{' - ' if sign == ' + ' else ' + '}{number(-b)}"
        right = f"({number(b)})" if b < 0 else number(b)
        return (
            f"{right}{sign}{left}" if sign == " * " and first != level else f"{left}{sign}{right}"
        )

    def prefix(self, node: Node) -> tuple[str, int]:
        """A symbol, a negation or a function."""
        op, a = node.op, node.a
        if op == SYMBOL:
            return self.symbol(node), _ATOM
        if op != NEG:
            second = "" if node.b is None else f", {self.text(node.b)}"
            return f"{self.notation.functions[op]}{self.text(a)}{second})", _ATOM
        if a.index in self.turned:
            known = self.known.get(a.index)
            return self.expression(a) if known is None else (known, _ATOM)
        text, own = self.held(a)
        apart = own < _PRODUCT or text[0] == "-" or own in self.mixed[_SIGNED]
        return f"-({text})" if apart else f"-{text}", _SIGNED

    def symbol(self, node: Node) -> str:
        """The text that reads an input: an element of an array, a parameter, or the time."""
        found = self.read.get(node.index)
        if found is not None:
            return found
        argument, place = str(node.a), node.b
        self.used.add(argument)
        if place is None:
            text = argument
        elif isinstance(place, int):
            text = f"{argument}[{place}]"
        else:
            text = f"{self.notation.member}{place}"
        self.read[node.index] = text
        return text


def _due(program: Program) -> dict[int, list[Check]]:
    """The checks by the step after which all they need is known; -1 is before the first."""
    if not program.checks:
        return {}
    order = {node.index: place for place, node in enumerate(program.steps)}

    def known_after(x: Operand) -> int:
        if not isinstance(x, Node) or x.op == SYMBOL:
            return -1
        place = order.get(x.index)
        return max(known_after(x.a), known_after(x.b)) if place is None else place

    due: dict[int, list[Check]] = {}
    for check in program.checks:
        due.setdefault(max(known_after(check.node), known_after(check.bound)), []).append(check)
    return due

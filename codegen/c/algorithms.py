"""Algorithms in C: procedures as functions, in the part of C99 and C++ that MISRA leaves."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from codegen import failures
from codegen.c import declare
from codegen.c.frames import Definition, StackFrame, statements
from codegen.c.phrases import CPhrases
from codegen.phrases import COMPARISON, wrapped
from linegraph.ir.binding import value
from linegraph.ir.program import counts_of
from linegraph.ir.statement_walks import nested
from linegraph.ir.statements import (
    Array,
    Assign,
    Break,
    Constant,
    ConstantTable,
    Fail,
    For,
    If,
    Let,
    Literal,
    LocalVariable,
    Minus,
    Not,
    Operation,
    Perform,
    Remark,
    Return,
    Use,
    ValueKind,
    While,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from codegen.algorithms import Algorithms
    from linegraph.ir.program import Module, Routine
    from linegraph.ir.statements import (
        Expression,
        Procedure,
        ProcedureParameter,
        Statement,
    )

WIDTH = 110

_TYPES = {ValueKind.INT: "int", ValueKind.REAL: "double", ValueKind.BOOL: "int"}


class CAlgorithms:
    """Prints the procedures of a module as functions of C."""

    def __init__(self, module: Module, algorithms: Algorithms, real: str) -> None:
        """Collect the names of statuses and counts.

        Args:
            module: the module; its name is the prefix of all functions and macros.
            algorithms: its algorithms.
            real: ``double`` or ``float``; the bounds of rounding depend on it.
        """
        self.module, self.algorithms, self.real = module, algorithms, real
        self.macro = module.name.upper()
        self.ok = f"{self.macro}_{failures.OK}"
        self.constants = {key: name for key, (name, _) in failures.constants(module).items()}
        self.counts = counts_of(module)

    def codes(self) -> list[str]:
        """The lines of an enumeration of all numbers with names."""
        codes = self.algorithms.codes()
        if not codes:
            return []
        lines = [f"    {self.macro}_{x.name} = {x.value}," for x in codes]
        lines[-1] = lines[-1].rstrip(",")
        return ["enum {", *lines, "};"]

    def shared(self) -> list[Definition]:
        """The procedures that routines share."""
        return [_CProcedure(self, None, x, frozenset()).helper() for x in self.algorithms.shared]

    def routine(self, routine: Routine, head: str, name: str) -> list[Definition]:
        """The function of a routine, preceded by those of the procedures that only it uses.

        Args:
            routine: the routine.
            head: the text of its head, without the opening brace.
            name: the name of its function, without the prefix.
        """
        *others, body = self.algorithms.own[routine.name]
        own = frozenset(x.name for x in others)
        made = [_CProcedure(self, routine, x, own).helper() for x in others]
        return [*made, _CProcedure(self, routine, body, own).body(head, name)]


class _CProcedure:
    """Writes one procedure, and keeps the record of its stack."""

    def __init__(
        self, printer: CAlgorithms, routine: Routine | None, made: Procedure, own: frozenset[str]
    ) -> None:
        self.printer, self.routine, self.made = printer, routine, made
        self.module = printer.module
        self.own = own
        name = routine.name if routine else ""
        self.phrases = CPhrases(printer.module, printer.real, name, own)
        self.frame = StackFrame()
        self.known: dict[str, int] = {}
        self.failing = sum(map(self.may_fail, nested(made.body)))

    # ---- functions

    def helper(self) -> Definition:
        """A function that routines call."""
        made = self.made
        name = f"{self.routine.name}_{made.name}" if self.routine else made.name
        returned = "int" if made.fails else "void"
        if made.returns is not None:
            returned = _TYPES[made.returns]
        parts = [self.context(x) for x in made.context] + list(map(self.parameter, made.parameters))
        start = f"{self.printer.macro}_PART {returned} {self.module.name}_{name}("
        text = f"{start}{', '.join(parts)})"
        lines = self.lines()
        self.frame.parameters = len(parts)
        about = "\n".join(made.about).strip().split("\n")
        remark = ["/*", *declare.block(about), " */"]
        if len(about) == 1:
            remark = [f"/* {declare.escape(about[0])} */"]
        head = "\n".join([*remark, *wrapped(text, WIDTH)])
        return Definition(name, head, lines, self.frame, self.routine.name if self.routine else "")

    def body(self, head: str, name: str) -> Definition:
        """The function that does the work of the routine."""
        assert self.routine is not None
        lines = self.lines()
        text = "\n".join(lines)
        unread = [
            f"    (void){x.name};"
            for x in self.routine.arguments
            if not re.search(rf"\b{x.name}\b", text)
        ]
        self.frame.parameters = len(self.routine.arguments) + len(self.routine.results)
        return Definition(name, head, [*unread, *lines], self.frame)

    def context(self, name: str) -> str:
        """A parameter that is passed on to functions of the module."""
        assert self.routine is not None
        given = next(x for x in self.routine.arguments if x.name == name)
        return declare.argument(self.module, given)

    def parameter(self, x: ProcedureParameter) -> str:
        """A parameter of the procedure."""
        if x.array:
            return f"{'' if x.written else 'const '}{_TYPES[x.kind]} *const {x.name}"
        return f"const {_TYPES[x.kind]} {x.name}"

    def lines(self) -> list[str]:
        """The lines between the braces."""
        made = self.made
        lines: list[str] = []
        constants = [x for x in made.body if isinstance(x, Constant)]
        if constants:
            for x in constants:
                self.known[x.name] = self.size(x.value)
            entries = ", ".join(f"{x.name} = {self.phrases.text(x.value)}" for x in constants)
            lines += wrapped(f"    enum {{ {entries} }};", WIDTH)
        tail = self.tail()
        if self.failing > 1:
            lines.append("    int status;")
            self.frame.ints += 1
        lines += self.block(made.body[:-1] if tail else made.body, 1)
        lines += tail or []
        entry = self.routine is not None and made.name == self.routine.algorithm
        if (made.fails or entry) and not tail and not isinstance(made.body[-1], Return | Fail):
            lines.append(f"    return {self.printer.ok};")
        middle = f"{self.routine.name}_" if self.routine else ""
        self.frame.calls |= {f"{middle if x in self.own else ''}{x}" for x in made.calls}
        self.frame.statements = statements(lines)
        return lines

    def tail(self) -> list[str] | None:
        """The lines of a last statement whose status is the function's own."""
        last = self.made.body[-1]
        if not self.may_fail(last) or not isinstance(last, Use | Perform):
            return None
        return wrapped(f"    return {self.call(last)};", WIDTH)

    def may_fail(self, x: Statement) -> bool:
        """Whether a statement calls a function that may return a status other than OK."""
        if isinstance(x, Use):
            return x.fails
        return isinstance(x, Perform) and x.call.fails

    def size(self, x: Expression) -> int:
        """The value of an extent."""
        match x:
            case LocalVariable():
                return self.known[x.name]
            case Operation():
                a, b = self.size(x.a), self.size(x.b)
                return a + b if x.operator == "+" else a * b if x.operator == "*" else a - b
            case _:
                return int(value(x))

    # ---- statements

    def block(self, body: Sequence[Statement], depth: int) -> list[str]:
        """The lines of a block."""
        indent = "    " * depth
        found: list[str] = []
        for statement in body:
            for line in self.statement(statement, depth):
                found += wrapped(indent + line, WIDTH) if line else [line]
        return found

    def statement(self, x: Statement, depth: int) -> Iterator[str]:
        """The lines of a statement, those within it indented further."""
        text = self.phrases.text
        match x:
            case Remark():
                yield f"/* {declare.comment(x.text)} */"
            case ConstantTable():
                entries = ", ".join(map(self.phrases.literal, x.entries))
                yield f"static const {_TYPES[x.kind]} {x.name}[{len(x.entries)}] = {{{entries}}};"
            case Array():
                self.note(x.kind, self.size(x.size))
                yield f"{_TYPES[x.kind]} {x.name}[{text(x.size)}] = {{0}};"
            case Let(kind=ValueKind.BOOL, value=Operation() | Not() as test):
                # an `int` takes no conditional expression of 1 and 0 (MISRA 10.6)
                self.note(x.kind, 1)
                yield from (f"int {x.name} = 0;", f"if ({self.phrases.condition(test)}) {{")
                yield from (f"    {x.name} = 1;", "}")
            case Let():
                self.note(x.kind, 1)
                constant = "const " if x.final else ""
                yield f"{constant}{_TYPES[x.kind]} {x.name} = {text(x.value)};"
            case Assign(
                target=LocalVariable(kind=ValueKind.BOOL) as target,
                value=Operation() | Not() as test,
            ):
                yield f"if ({self.phrases.condition(test)}) {{"
                yield from (f"    {target.name} = 1;", "} else {", f"    {target.name} = 0;", "}")
            case Assign():
                yield self.assignment(x)
            case Break():
                yield "break;"
            case Return():
                yield f"return {text(x.value) if x.value is not None else self.printer.ok};"
            case Fail():
                yield f"return {self.printer.constants[x.status.number, x.status.name]};"
            case Use() | Perform():
                yield from self.called(x)
            case For() | While() | If():
                yield from self.compound(x)
            case Constant():
                pass

    def compound(self, x: For | While | If) -> Iterator[str]:
        """A statement with others within it."""
        if isinstance(x, For):
            self.note(ValueKind.INT, 1)
            yield f"for ({self.span(x)}) {{"
        else:
            word = "while" if isinstance(x, While) else "if"
            yield f"{word} ({self.phrases.condition(x.test)}) {{"
        yield from self.inner(x.body)
        while isinstance(x, If) and x.orelse:
            other = x.orelse
            if len(other) == 1 and isinstance(other[0], If):
                x = other[0]
                yield f"}} else if ({self.phrases.condition(x.test)}) {{"
                yield from self.inner(x.body)
            else:
                yield "} else {"
                yield from self.inner(other)
                break
        yield "}"

    def inner(self, body: Sequence[Statement]) -> Iterator[str]:
        """The lines of a block within another one."""
        for statement in body:
            for line in self.statement(statement, 0):
                yield f"    {line}"

    def span(self, x: For) -> str:
        """The text between the parentheses of a loop."""
        start, name = self.phrases.text(x.start), x.name
        stop = self.phrases.operand(x.stop, COMPARISON)
        relation = f"{name} < {stop}" if x.step > 0 else f"{name} > {stop}"
        if x.step < 0 and x.stop in (Literal(-1), Minus(Literal(1), ValueKind.INT)):
            relation = f"{name} >= 0"
        change = {1: f"++{name}", -1: f"--{name}"}.get(x.step)
        change = change or f"{name} {'+' if x.step > 0 else '-'}= {abs(x.step)}"
        return f"int {name} = {start}; {relation}; {change}"

    def assignment(self, x: Assign) -> str:
        """An assignment; steps of one are those of C."""
        target = self.phrases.text(x.target)
        if x.value == Literal(1) and x.operator in ("+", "-"):
            return f"{x.operator * 2}{target};"
        return f"{target} {x.operator}= {self.phrases.text(x.value)};"

    def called(self, x: Use | Perform) -> Iterator[str]:
        """A call, with the lines for a status other than OK."""
        call = self.call(x)
        if not self.may_fail(x):
            yield f"{call};"
            return
        if self.failing > 1:
            yield f"status = {call};"
        else:
            self.note(ValueKind.INT, 1)
            yield f"const int status = {call};"
        yield f"if (status != {self.printer.ok}) {{"
        yield "    return status;"
        yield "}"

    def call(self, x: Use | Perform) -> str:
        """The text of a call."""
        if isinstance(x, Perform):
            return self.phrases.text(x.call)
        results = [self.phrases.part(part) for part in x.results]
        if x.passed:
            assert self.routine is not None
            results = [result.name for result in self.routine.results]
        given = [y if isinstance(y, str) else self.phrases.part(y) for y in x.arguments]
        self.frame.calls.add(x.function)
        return f"{self.module.name}_{x.function}({', '.join([*given, *results])})"

    def note(self, kind: ValueKind, count: int) -> None:
        """Note variables in the record of the stack."""
        if kind is ValueKind.REAL:
            self.frame.doubles += count
        else:
            self.frame.ints += count

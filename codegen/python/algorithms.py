"""Algorithms in Python: procedures as functions over lists of numbers.

With arrays of NumPy they would be shorter, but not faster: models have some ten coordinates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from codegen import failures
from codegen.phrases import ATOM, Phrases, wrapped
from linegraph.ir.rounding import DOUBLE
from linegraph.ir.statement_walks import expressions, nested, operands
from linegraph.ir.statements import (
    Array,
    ArrayPart,
    Assign,
    Break,
    Constant,
    ConstantTable,
    Count,
    Fail,
    For,
    If,
    Let,
    Literal,
    LocalVariable,
    Perform,
    Remark,
    Return,
    Use,
    ValueKind,
    While,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from codegen.algorithms import Algorithms
    from linegraph.ir.program import Module, Routine
    from linegraph.ir.statements import Intrinsic, Invocation, NamedNumber, Procedure, Statement

WIDTH = 110

_FUNCTIONS = {
    "abs": "abs",
    "float": "float",
    "sqrt": "_sqrt",
    "larger": "_larger",
    "ratio": "_ratio",
}


class PythonPhrases(Phrases):
    """Expressions of Python; names of counts stand for constants that equal them."""

    def __init__(self, routine: str, own: frozenset[str], aliases: Mapping[str, str]) -> None:
        """Use the bounds of rounding of doubles.

        Args:
            routine: the name of the routine being printed; empty for shared procedures.
            own: the procedures that belong to this routine, whose names contain that of the routine.
            aliases: by the name of a constant, the count that it equals.
        """
        super().__init__(DOUBLE)
        self.routine, self.own, self.aliases = routine, own, aliases

    def variable(self, x: LocalVariable) -> str:
        """A variable, or the count that it is another name for."""
        return self.aliases.get(x.name, x.name)

    def intrinsic(self, x: Intrinsic) -> tuple[str, int]:
        """A function of Python or of the module itself."""
        return f"{_FUNCTIONS[x.name]}({', '.join(map(self.text, x.arguments))})", ATOM

    def procedure(self, x: Invocation) -> str:
        """A procedure of the routine's own, or a shared one."""
        return f"_{self.routine}_{x.procedure}" if x.procedure in self.own else f"_{x.procedure}"

    def part(self, x: ArrayPart) -> str:
        """A list, or a part of one."""
        if x.start is None and x.stop is None:
            return x.array
        bounds = ["" if y is None else self.text(y) for y in (x.start, x.stop)]
        return f"{x.array}[{':'.join(bounds)}]"

    def code(self, x: NamedNumber) -> str:
        """A constant of the module."""
        return f"_{x.name}"

    def infinity(self) -> str:
        """A constant of the module."""
        return "_INFINITE"


class PythonAlgorithms:
    """Prints the procedures of a module as functions of Python."""

    def __init__(self, module: Module, algorithms: Algorithms) -> None:
        """Determine which functions report a status.

        The others are called so that a division by zero gives the same as in C.

        Args:
            module: the module.
            algorithms: its algorithms.
        """
        self.module, self.algorithms = module, algorithms
        self.fails = {name for name, found in failures.statuses(module).items() if found}

    def codes(self) -> list[str]:
        """The lines that define all numbers with names."""
        return [f"_{x.name} = {x.value}" for x in self.algorithms.codes()]

    def shared(self) -> list[list[str]]:
        """The lines of each procedure that routines share."""
        return [
            _PythonProcedure(self, None, x, frozenset()).helper() for x in self.algorithms.shared
        ]

    def own(self, routine: Routine) -> list[list[str]]:
        """The lines of each procedure of a routine's own."""
        others = self.algorithms.own[routine.name][:-1]
        names = frozenset(x.name for x in others)
        return [_PythonProcedure(self, routine, x, names).helper() for x in others]

    def body(self, routine: Routine) -> list[str]:
        """The lines of a routine's body, which takes its arguments and returns its results."""
        *others, body = self.algorithms.own[routine.name]
        return _PythonProcedure(self, routine, body, frozenset(x.name for x in others)).body()


class _PythonProcedure:
    """Writes one procedure."""

    def __init__(
        self,
        printer: PythonAlgorithms,
        routine: Routine | None,
        made: Procedure,
        own: frozenset[str],
    ) -> None:
        self.printer, self.routine, self.made = printer, routine, made
        aliases = {
            x.name: x.value.name
            for x in made.body
            if isinstance(x, Constant) and isinstance(x.value, Count)
        }
        self.phrases = PythonPhrases(routine.name if routine else "", own, aliases)
        self.entry = routine is not None and made.name == routine.algorithm
        self.given = {x.name for x in made.parameters}
        self.late = _set_by_calls(made.body)

    def helper(self) -> list[str]:
        """A function that routines call."""
        made = self.made
        name = f"_{self.routine.name}_{made.name}" if self.routine else f"_{made.name}"
        head = f"def {name}({', '.join([*made.context, *(x.name for x in made.parameters)])}):"
        first, *more = "\n".join(made.about).strip().split("\n")
        about = [f'"""{first}"""'] if not more else [f'"""{first}', *more, '"""']
        lines = [f"    {line}".rstrip() for line in about]
        return [*wrapped(head, WIDTH), *lines, *self.block(made.body, 1)]

    def body(self) -> list[str]:
        """The lines of a routine's function."""
        assert self.routine is not None
        results = [x.name for x in self.routine.results]
        self.given -= set(results)
        made = self.made.body
        known = _set_by_calls(made, results)
        sizes = {x.name: " * ".join(map(str, x.shape)) for x in self.routine.results}
        passed = any(isinstance(x, Use) and x.passed for x in made)
        lines = [f"    {x} = [0.0] * {_factor(sizes[x])}" for x in results if x not in known]
        lines = [] if passed else lines
        lines += self.block(made, 1)
        if not passed and not isinstance(made[-1], Return | Fail):
            lines.append(f"    return {', '.join(results)}")
        return lines

    # ---- statements

    def block(self, body: Sequence[Statement], depth: int) -> list[str]:
        """The lines of a block."""
        indent = "    " * depth
        found: list[str] = []
        for statement in body:
            for line in self.statement(statement):
                found += wrapped(indent + line, WIDTH, shallowest=1)
        return found

    def statement(self, x: Statement) -> Iterator[str]:
        """The lines of a statement, those within it indented further."""
        text = self.phrases.text
        match x:
            case Remark():
                yield f"# {x.text}"
            case Constant():
                if x.name not in self.phrases.aliases:
                    yield f"{x.name} = {text(x.value)}"
            case ConstantTable():
                entries = ", ".join(map(self.phrases.literal, x.entries))
                yield f"{x.name} = ({entries}{',' * (len(x.entries) == 1)})"
            case Array():
                if x.name not in self.late:
                    zero = "0.0" if x.kind is ValueKind.REAL else "0"
                    yield f"{x.name} = [{zero}] * {_factor(text(x.size))}"
            case Let():
                yield f"{x.name} = {text(x.value)}"
            case Assign():
                yield f"{text(x.target)} {x.operator}= {text(x.value)}"
            case Break():
                yield "break"
            case Return():
                yield self.returned(x)
            case Fail():
                yield f'raise StatusError("{x.status.name}")'
            case Perform():
                yield text(x.call)
            case Use():
                yield self.used(x)
            case For() | While() | If():
                yield from self.compound(x)

    def returned(self, x: Return) -> str:
        """A return: of a value, or of the results of the routine."""
        if x.value is not None:
            return f"return {self.phrases.text(x.value)}"
        if not self.entry:
            return "return"
        assert self.routine is not None
        return f"return {', '.join(y.name for y in self.routine.results)}"

    def compound(self, x: For | While | If) -> Iterator[str]:
        """A statement with others within it."""
        text = self.phrases.text
        if isinstance(x, For):
            bounds = [x.start, x.stop] if x.start != Literal(0) or x.step != 1 else [x.stop]
            given = [*map(text, bounds), *([str(x.step)] if x.step != 1 else [])]
            yield f"for {x.name} in range({', '.join(given)}):"
        else:
            yield f"{'while' if isinstance(x, While) else 'if'} {text(x.test)}:"
        yield from self.inner(x.body)
        if isinstance(x, If) and x.orelse:
            if len(x.orelse) == 1 and isinstance(x.orelse[0], If):
                first, *more = self.statement(x.orelse[0])
                yield f"el{first}"
                yield from more
            else:
                yield "else:"
                yield from self.inner(x.orelse)

    def inner(self, body: Sequence[Statement]) -> Iterator[str]:
        """The lines of a block within another one."""
        for statement in body:
            for line in self.statement(statement):
                yield f"    {line}"

    def used(self, x: Use) -> str:
        """A call of another function of the module; arrays of the caller are written in place."""
        given = [y if isinstance(y, str) else self.phrases.part(y) for y in x.arguments]
        if x.fails:
            call = f"_{x.function}({', '.join(given)})"
        else:
            call = f"_as_in_c({', '.join([f'_{x.function}', *given])})"
        if x.passed:
            return f"return {call}"
        return f"{', '.join(map(self.taken, x.results))} = {call}"

    def taken(self, x: ArrayPart) -> str:
        """What takes a result."""
        if x.start is None and x.stop is None:
            return f"{x.array}[:]" if x.array in self.given else x.array
        return self.phrases.part(x)


def _factor(text: str) -> str:
    """A product as the factor of another one."""
    return f"({text})" if " " in text else text


def _set_by_calls(body: tuple[Statement, ...], names: Sequence[str] = ()) -> set[str]:
    """The arrays that a call of the module sets as a whole before anything else mentions them.

    They need no zeros before. All that mentions them must stand in the block of that call.

    Args:
        body: of a procedure.
        names: the arrays in question; by default those declared at its outermost level.
    """
    wanted = set(names) or {x.name for x in body if isinstance(x, Array)}
    found: set[str] = set()

    def mentions(block: tuple[Statement, ...], name: str) -> int:
        return sum(
            isinstance(y, ArrayPart) and y.array == name
            for x in nested(block)
            for whole in expressions(x)
            for y in operands(whole)
        )

    def look(block: tuple[Statement, ...]) -> None:
        for place, x in enumerate(block):
            if isinstance(x, Use):
                for part in x.results:
                    name = part.array
                    whole = part.start is None and part.stop is None
                    here = mentions(block[place:], name) == mentions(body, name)
                    if whole and name in wanted and here and not mentions(block[:place], name):
                        found.add(name)
            elif isinstance(x, For | While):
                look(x.body)
            elif isinstance(x, If):
                look(x.body)
                look(x.orelse)

    look(body)
    return found

"""Traversal of statements and expressions, and replacement of calls in them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from linegraph.ir.statements import (
    Array,
    ArrayEntry,
    ArrayPart,
    Assign,
    Choice,
    Constant,
    For,
    If,
    Intrinsic,
    Invocation,
    Let,
    LocalVariable,
    Minus,
    Not,
    Operation,
    Perform,
    Return,
    Use,
    While,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from linegraph.ir.statements import Expression, Statement


def nested(body: tuple[Statement, ...]) -> Iterator[Statement]:
    """All statements, each before those within it."""
    for statement in body:
        yield statement
        if isinstance(statement, For | While):
            yield from nested(statement.body)
        elif isinstance(statement, If):
            yield from nested(statement.body)
            yield from nested(statement.orelse)


def operands(x: Expression | ArrayPart) -> Iterator[Expression | ArrayPart]:
    """An expression and all its subexpressions, itself first; arrays appear as `ArrayPart`."""
    yield x
    match x:
        case ArrayEntry():
            yield ArrayPart(x.array)
            yield from operands(x.place)
        case Operation():
            yield from operands(x.a)
            yield from operands(x.b)
        case Minus() | Not():
            yield from operands(x.a)
        case Choice():
            for y in (x.test, x.a, x.b):
                yield from operands(y)
        case Intrinsic() | Invocation():
            for argument in x.arguments:
                yield from operands(argument)
        case ArrayPart():
            for bound in (x.start, x.stop):
                if bound is not None:
                    yield from operands(bound)
        case _:
            pass


def expressions(statement: Statement) -> Iterator[Expression | ArrayPart]:
    """The expressions of a statement itself, not of those within it; arrays that it writes included."""
    match statement:
        case Constant() | Let():
            yield statement.value
        case Array():
            yield statement.size
        case Assign():
            yield statement.target
            yield statement.value
        case For():
            yield statement.start
            yield statement.stop
        case While() | If():
            yield statement.test
        case Return():
            if statement.value is not None:
                yield statement.value
        case Perform():
            yield statement.call
        case Use():
            yield from statement.results
            yield from (part for _, part in statement.given)
            yield from (x for x in statement.arguments if isinstance(x, ArrayPart))
        case _:
            pass


def invocations(body: tuple[Statement, ...]) -> Iterator[Invocation]:
    """All calls of other procedures."""
    for statement in nested(body):
        for whole in expressions(statement):
            yield from (x for x in operands(whole) if isinstance(x, Invocation))


def names_read(body: tuple[Statement, ...]) -> set[str]:
    """The variables and arrays that a body reads, without those that it only assigns."""
    found: set[str] = set()
    for statement in nested(body):
        for whole in expressions(statement):
            assigned = isinstance(statement, Assign) and whole is statement.target
            for x in operands(whole):
                if isinstance(x, LocalVariable) and not (assigned and x is whole):
                    found.add(x.name)
                elif isinstance(x, ArrayPart):
                    found.add(x.array)
        if isinstance(statement, Use):
            found |= {x for x in statement.arguments if isinstance(x, str)}
    return found


def with_invocations(
    body: tuple[Statement, ...], change: Callable[[Invocation], Invocation]
) -> tuple[Statement, ...]:
    """A body in which all calls of procedures are replaced.

    Args:
        body: the statements, which are left as they are.
        change: maps each call, whose arguments have been changed already, to its replacement.
    """

    def of(x: Any) -> Any:
        match x:
            case Invocation():
                return change(replace(x, arguments=tuple(map(of, x.arguments))))
            case ArrayEntry():
                return replace(x, place=of(x.place))
            case Operation():
                return replace(x, a=of(x.a), b=of(x.b))
            case Minus() | Not():
                return replace(x, a=of(x.a))
            case Choice():
                return replace(x, test=of(x.test), a=of(x.a), b=of(x.b))
            case Intrinsic():
                return replace(x, arguments=tuple(map(of, x.arguments)))
            case For():
                return replace(x, start=of(x.start), stop=of(x.stop), body=tuple(map(of, x.body)))
            case While():
                return replace(x, test=of(x.test), body=tuple(map(of, x.body)))
            case If():
                inner, other = tuple(map(of, x.body)), tuple(map(of, x.orelse))
                return replace(x, test=of(x.test), body=inner, orelse=other)
            case Constant() | Let():
                return replace(x, value=of(x.value))
            case Assign():
                return replace(x, target=of(x.target), value=of(x.value))
            case Return():
                return replace(x, value=None if x.value is None else of(x.value))
            case Perform():
                return replace(x, call=of(x.call))
            case _:
                return x

    return tuple(map(of, body))

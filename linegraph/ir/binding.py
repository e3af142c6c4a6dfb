"""Algorithms of one module: all that its model decides is decided, and what is not needed then is gone.

Counts and other facts get their values; decisions that these make are made; calls of the module's functions
get all their arguments. Variables, arrays and parameters that nothing reads any more are dropped, and so
are procedures that nothing calls.
"""

from __future__ import annotations

import operator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from linegraph.ir.program import PREPARED_SUFFIX
from linegraph.ir.reading import algorithm
from linegraph.ir.statement_walks import invocations, names_read, nested, with_invocations
from linegraph.ir.statements import (
    Array,
    ArrayEntry,
    ArrayPart,
    Assign,
    Choice,
    Constant,
    ConstantTable,
    Count,
    Detail,
    Fail,
    For,
    If,
    Intrinsic,
    Invocation,
    Let,
    Literal,
    LocalVariable,
    Minus,
    Not,
    Operation,
    Perform,
    Procedure,
    Return,
    Use,
    While,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from linegraph.ir.program import Program, Routine
    from linegraph.ir.statements import Expression, Statement

_OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
    "and": lambda a, b: a and b,
    "or": lambda a, b: a or b,
}


@dataclass(frozen=True)
class Surroundings:
    """The module to which algorithms are bound.

    Attributes:
        programs: all functions of the module by name.
        counts: its counts; those that are missing are 0.
        fails: the functions that report a status.
    """

    programs: Mapping[str, Program | Routine]
    counts: Mapping[str, int]
    fails: frozenset[str]


def bound(routine: Routine, around: Surroundings) -> tuple[Procedure, ...]:
    """The procedures of a routine, bound to its module.

    Args:
        routine: the routine; its details give the facts of the model that the algorithm needs.
        around: the functions of its module, the counts and which functions report a status.

    Returns:
        The procedures, each after those that it calls; that of the routine itself is last.

    Raises:
        ValueError: the routine does not name a function that it calls, or gives no fact that it needs.
    """
    binder = _Binder(routine, around)
    found = _called_only(algorithm(routine.algorithm), routine.algorithm, binder)
    found = _without_unread(found, routine.algorithm)
    made: dict[str, Procedure] = {}
    for name, x in found.items():
        made[name] = binder.linked(x, made)
    return tuple(made.values())


class _Binder:
    """Evaluates everything in an algorithm that depends only on the model of one routine."""

    def __init__(self, routine: Routine, around: Surroundings) -> None:
        self.routine, self.around = routine, around
        self.details = dict(routine.details)

    # ---- statements

    def block(self, body: Iterable[Statement]) -> tuple[Statement, ...]:
        """The statements of a block, less those that are never reached."""
        return tuple(x for statement in body for x in self.statement(statement))

    def statement(self, x: Statement) -> Iterable[Statement]:
        """The bound form of a statement; a branch that is always taken replaces its `If`."""
        match x:
            case If():
                test = self.expression(x.test)
                known = value(test)
                if known is not None:
                    return self.block(x.body if known else x.orelse)
                return (If(test, self.block(x.body), self.block(x.orelse)),)
            case For():
                bounds = self.expression(x.start), self.expression(x.stop)
                return (For(x.name, *bounds, x.step, self.block(x.body)),)
            case While():
                return (While(self.expression(x.test), self.block(x.body)),)
            case ConstantTable(detail=detail) if detail:
                return (replace(x, entries=tuple(self.detail(detail)), detail=""),)
            case Array():
                return (replace(x, size=self.expression(x.size)),)
            case Constant() | Let():
                return (replace(x, value=self.expression(x.value)),)
            case Assign():
                return (
                    Assign(self.expression(x.target), x.operator, self.expression(x.value)),  # type: ignore[arg-type]
                )
            case Return(value=known) if known is not None:
                return (Return(self.expression(known)),)
            case Perform():
                return (Perform(self.expression(x.call)),)  # type: ignore[arg-type]
            case Use():
                return (self.use(x),)
            case _:
                return (x,)

    def use(self, x: Use) -> Use:
        """A call of another function of the module, with all its arguments."""
        name = self.details["then"] if x.function == "then" else x.function
        if name not in self.routine.uses:
            name += PREPARED_SUFFIX
        if name not in self.routine.uses:
            raise ValueError(f"{self.routine.name} does not say that it calls {name}")
        called = self.around.programs[name]
        given = {key: self.part(part) for key, part in x.given}
        arguments = tuple(given.get(a.name, a.name) for a in called.arguments)
        results = tuple(map(self.part, x.results))
        if not x.passed and len(results) != len(called.results):
            raise ValueError(f"{self.routine.name}: {name} has {len(called.results)} results")
        return Use(name, results, (), arguments, name in self.around.fails, x.passed)

    # ---- expressions

    def detail(self, name: str) -> Any:
        """A fact of the model."""
        if name not in self.details:
            raise ValueError(f"{self.routine.name} does not say {name}")
        return self.details[name]

    def part(self, x: ArrayPart) -> ArrayPart:
        """An array as an argument."""
        bounds = (None if y is None else self.expression(y) for y in (x.start, x.stop))
        return ArrayPart(x.array, *bounds)

    def expression(self, x: Expression) -> Expression:
        """An expression in which facts of the model are numbers."""
        match x:
            case Count():
                return replace(x, value=self.around.counts.get(x.name, 0))
            case Detail():
                found = self.detail(x.name)
                return Literal(len(found) if x.length else found)
            case ArrayEntry():
                return replace(x, place=self.expression(x.place))
            case Operation():
                return replace(x, a=self.expression(x.a), b=self.expression(x.b))
            case Minus() | Not():
                return replace(x, a=self.expression(x.a))
            case Choice():
                test = self.expression(x.test)
                known = value(test)
                if known is not None:
                    return self.expression(x.a if known else x.b)
                return replace(x, test=test, a=self.expression(x.a), b=self.expression(x.b))
            case Intrinsic():
                return replace(x, arguments=tuple(map(self.expression, x.arguments)))
            case Invocation():
                arguments = tuple(
                    self.part(y) if isinstance(y, ArrayPart) else self.expression(y)
                    for y in x.arguments
                )
                return replace(x, arguments=arguments)
            case _:
                return x

    # ---- calls

    def linked(self, x: Procedure, made: Mapping[str, Procedure]) -> Procedure:
        """A procedure that knows what it passes on, and whether it fails; what it calls is linked already."""
        needed: dict[str, None] = {}
        own = {parameter.name for parameter in x.parameters} | declared(x.body)
        for statement in nested(x.body):
            if isinstance(statement, Use):
                needed |= dict.fromkeys(a for a in statement.arguments if isinstance(a, str))
        calls = [made[name] for name in dict.fromkeys(y.procedure for y in invocations(x.body))]
        for called in calls:
            needed |= dict.fromkeys(called.context)
        order = [a.name for a in self.routine.arguments]
        missing = needed.keys() - {*order} - own
        if missing:
            raise ValueError(f"{self.routine.name}, {x.name}: nothing is called {sorted(missing)}")
        context = tuple(name for name in order if name in needed.keys() - own)
        fails = any(
            isinstance(y, Fail) or (isinstance(y, Use) and y.fails) for y in nested(x.body)
        ) or any(called.fails for called in calls)
        if fails and x.returns is not None:
            raise ValueError(f"{self.routine.name}, {x.name}: it returns a value, and cannot fail")
        return replace(
            x,
            body=_relinked(x.body, {called.name: called for called in calls}),
            context=context,
            fails=fails,
            calls=tuple(called.name for called in calls),
            uses=any(isinstance(y, Use) for y in nested(x.body)) or any(y.uses for y in calls),
        )


def value(x: Expression) -> Any:
    """The value of an expression that the model alone decides; else None."""
    match x:
        case Literal() | Count():
            return x.value
        case Not():
            known = value(x.a)
            return None if known is None else not known
        case Operation():
            a, b = value(x.a), value(x.b)
            return None if a is None or b is None else _OPERATORS[x.operator](a, b)
        case _:
            return None


def declared(body: tuple[Statement, ...]) -> set[str]:
    """The names that a body declares."""
    kinds = (Array, Constant, For, Let, ConstantTable)
    return {x.name for x in nested(body) if isinstance(x, kinds)}


def _called_only(
    known: Mapping[str, Procedure], entry: str, binder: _Binder
) -> dict[str, Procedure]:
    """The procedures that are called, directly or not, with their bodies bound.

    Others are not bound: they may use functions that this model does not have.
    """
    needed = {entry}
    made: dict[str, Procedure] = {}
    for name in reversed(list(known)):
        if name in needed:
            made[name] = replace(known[name], body=binder.block(known[name].body))
            needed |= {x.procedure for x in invocations(made[name].body)}
    return {name: made[name] for name in known if name in made}


def _without_unread(found: dict[str, Procedure], entry: str) -> dict[str, Procedure]:
    """The same without variables and parameters that nothing reads; those of the entry stay."""
    while True:
        kept = {
            name: replace(x, body=_read_only(x.body, {p.name for p in x.parameters}))
            for name, x in found.items()
        }
        places: dict[str, list[int]] = {}
        for name, x in kept.items():
            read = names_read(x.body)
            named = enumerate(x.parameters)
            places[name] = [k for k, p in named if name == entry or p.name in read]
        if all(len(places[name]) == len(x.parameters) for name, x in kept.items()):
            if kept == found:
                return found
        else:
            kept = {
                name: replace(
                    x,
                    parameters=tuple(x.parameters[place] for place in places[name]),
                    body=_with_arguments(x.body, places),
                )
                for name, x in kept.items()
            }
        found = kept


def _read_only(body: tuple[Statement, ...], outer: set[str]) -> tuple[Statement, ...]:
    """A body without declarations of, and assignments to, what nothing reads."""
    read = names_read(body)

    def needed(x: Statement) -> bool:
        if isinstance(x, Array | Constant | Let | ConstantTable):
            return x.name in read
        if isinstance(x, Assign) and isinstance(x.target, LocalVariable):
            return x.target.name in read or x.target.name in outer
        return True

    def kept(block: tuple[Statement, ...]) -> tuple[Statement, ...]:
        made: list[Statement] = []
        for x in block:
            if isinstance(x, For | While):
                made.append(replace(x, body=kept(x.body)))
            elif isinstance(x, If):
                made.append(replace(x, body=kept(x.body), orelse=kept(x.orelse)))
            elif needed(x):
                made.append(x)
        return tuple(made)

    return kept(body)


def _with_arguments(
    body: tuple[Statement, ...], places: Mapping[str, list[int]]
) -> tuple[Statement, ...]:
    def change(x: Invocation) -> Invocation:
        kept = places[x.procedure]
        if len(kept) == len(x.arguments):
            return x
        return replace(x, arguments=tuple(x.arguments[place] for place in kept))

    return with_invocations(body, change)


def _relinked(
    body: tuple[Statement, ...], called: Mapping[str, Procedure]
) -> tuple[Statement, ...]:
    def change(x: Invocation) -> Invocation:
        made = called[x.procedure]
        return replace(x, context=made.context, fails=made.fails)

    return with_invocations(body, change)

"""The text of an algorithm's functions, read into statements.

Only the text is read, as a syntax tree; nothing of it runs here. What stands for no statement is refused
with its place. A variable belongs to the block in which it is first assigned, as in C, so what is used
after a block is assigned before it. Comments on lines of their own go along.
"""

from __future__ import annotations

import ast
import functools
import importlib
import inspect
import io
import tokenize
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NoReturn

from linegraph.ir.program import Status
from linegraph.ir.reading_expressions import ANNOTATIONS, BlockScope, ExpressionReader, Signature
from linegraph.ir.statement_walks import invocations, nested
from linegraph.ir.statements import (
    Array,
    ArrayEntry,
    ArrayPart,
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
    Perform,
    Procedure,
    Remark,
    Return,
    Use,
    ValueKind,
    While,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from types import FunctionType, ModuleType

    from linegraph.ir.statements import Invocation, Statement

WHERE = "linegraph.ir.algorithms"

ALGORITHMS = {
    "newton": "newton",
    "project": "project",
    "complete": "complete",
    "constrained_dynamics": "dynamics",
    "after_dynamics": "dynamics",
    "rhs": "dynamics",
    "reduction": "reduction",
    "reduced_equations": "reduction",
    "linearization": "linearization",
}
"""The algorithms of routines, and the module in which each is written."""

_OPERATORS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}


@functools.cache
def algorithm(name: str) -> dict[str, Procedure]:
    """An algorithm and all that it calls, by name, each after those it calls; itself last.

    Raises:
        ValueError: its text says something that is no statement.
    """
    found: dict[str, Procedure] = {}

    def collect(function: FunctionType) -> None:
        made = procedure(function)
        for other in made.calls:
            if other not in found:
                collect(getattr(importlib.import_module(function.__module__), other))
        found[made.name] = made

    collect(getattr(importlib.import_module(f"{WHERE}.{ALGORITHMS[name]}"), name))
    return found


@functools.cache
def procedure(function: FunctionType) -> Procedure:
    """One function of an algorithm."""
    text = _text(importlib.import_module(function.__module__))
    node = text.functions[function.__name__]
    return _ProcedureReader(text, node).procedure()


class _Text:
    """A file of algorithms: its functions, its comments and the values of its global names."""

    def __init__(self, module: ModuleType) -> None:
        source = inspect.getsource(module)
        tree = ast.parse(source)
        self.file = f"{module.__name__.rpartition('.')[2]}.py"
        self.names: dict[str, Any] = vars(module)
        self.functions = {x.name: x for x in tree.body if isinstance(x, ast.FunctionDef)}
        lines = source.splitlines()
        self.comments = {
            token.start[0]: token.string.lstrip("# ")
            for token in tokenize.generate_tokens(io.StringIO(source).readline)
            if token.type == tokenize.COMMENT and lines[token.start[0] - 1].strip() == token.string
        }

    def refuse(self, node: ast.AST, problem: str) -> NoReturn:
        line = getattr(node, "lineno", 0)
        raise ValueError(f"{self.file}, line {line}: {problem}: {ast.unparse(node)[:80]}")


@functools.cache
def _text(module: ModuleType) -> _Text:
    return _Text(module)


def _signature(function: FunctionType) -> Signature:
    made = procedure(function)
    return Signature(made.name, made.module, made.parameters, made.returns, made.fails)


class _ProcedureReader:
    """Reads one function."""

    def __init__(self, text: _Text, node: ast.FunctionDef) -> None:
        self.text, self.node = text, node
        self.scope = BlockScope()
        self.of = ExpressionReader(self.scope, text.names, text.refuse, _signature)
        self.loops = 0

    def procedure(self) -> Procedure:
        """The function as a procedure."""
        node = self.node
        parameters = []
        module = False
        for given in node.args.args:
            said = ast.unparse(given.annotation) if given.annotation else ""
            if said == "ModuleAtState":
                module = True
                continue
            if said not in ANNOTATIONS:
                self.text.refuse(given, "a parameter is int, float, bool, Reals, Ints or Places")
            parameter = replace(ANNOTATIONS[said], name=given.arg)
            parameters.append(parameter)
            self.scope.declare(given.arg, parameter.kind, array=parameter.array)
        returns = {
            "None": None,
            "int": ValueKind.INT,
            "float": ValueKind.REAL,
            "bool": ValueKind.BOOL,
        }[ast.unparse(node.returns) if node.returns else "None"]
        first = node.body[1:] if ast.get_docstring(node) is not None else node.body
        body = self.block(first, int(node.body[0].end_lineno or 0))
        calls = tuple(dict.fromkeys(call.procedure for call in invocations(body)))
        written = self.written(body)
        return Procedure(
            node.name,
            tuple((ast.get_docstring(node) or "").split("\n")),
            tuple(replace(x, written=x.array and x.name in written) for x in parameters),
            returns,
            _finals(body),
            module,
            calls,
            fails=any(isinstance(x, Fail) for x in nested(body))
            or any(call.fails for call in invocations(body)),
        )

    def written(self, body: tuple[Statement, ...]) -> set[str]:
        """The arrays that a body changes, directly or through the functions it calls."""
        found = set()
        for statement in nested(body):
            if isinstance(statement, Assign) and isinstance(statement.target, ArrayEntry):
                found.add(statement.target.array)
            if isinstance(statement, Use):
                found |= {part.array for part in statement.results}
        for call in invocations(body):
            parameters = _signature(self.text.names[call.procedure]).parameters
            for given, taken in zip(call.arguments, parameters, strict=True):
                if taken.written and isinstance(given, ArrayPart):
                    found.add(given.array)
        return found

    # ---- statements

    def block(self, nodes: Sequence[ast.stmt], above: int) -> tuple[Statement, ...]:
        """The statements of a block, with the comments above each; what it declares ends with it."""
        self.scope.enter()
        made: list[Statement] = []
        for node in nodes:
            for line in range(above + 1, node.lineno):
                if line in self.text.comments:
                    made.append(Remark(self.text.comments[line]))
            above = int(node.end_lineno or node.lineno)
            made += self.statement(node)
        self.scope.leave()
        return tuple(made)

    def statement(self, node: ast.stmt) -> Iterator[Statement]:
        """The statements for one statement of Python."""
        match node:
            case ast.Assign(targets=[target]):
                yield self.assignment(node, target)
            case ast.AugAssign(op=operator) if type(operator) in _OPERATORS:
                yield self.assigned(node, node.target, _OPERATORS[type(operator)], node.value)
            case ast.For(target=ast.Name(id=name), iter=ast.Call() as span, orelse=[]):
                yield self.loop(node, name, span)
            case ast.While(orelse=[]):
                test = self.of.condition(node.test)
                yield While(test, self.block(node.body, node.lineno))
            case ast.If():
                test = self.of.condition(node.test)
                body = self.block(node.body, node.lineno)
                yield If(test, body, self.block(node.orelse, int(node.body[-1].end_lineno or 0)))
            case ast.Break():
                yield Break()
            case ast.Return():
                yield Return(None if node.value is None else self.of.expression(node.value))
            case ast.Raise(exc=ast.Call(func=ast.Name(id="Failed"), args=[ast.Name(id=name)])):
                status = self.text.names.get(name)
                if not isinstance(status, Status):
                    self.text.refuse(node, "a failure is raised with a status")
                yield Fail(status)
            case ast.Expr(value=ast.Call() as call):
                used = self.of.used(call)
                yield used or Perform(self.performed(call))
            case _:
                self.text.refuse(node, "this is none of the statements of algorithms")

    def performed(self, node: ast.Call) -> Invocation:
        call = self.of.invocation(node)
        if call is None or call.kind is not None:
            self.text.refuse(node, "a call that returns nothing is expected")
        return call

    def loop(self, node: ast.For, name: str, span: ast.Call) -> For:
        """A loop over a range."""
        given = [self.of.expression(x) for x in span.args]
        if ast.unparse(span.func) != "range" or not given:
            self.text.refuse(node, "loops go over ranges")
        start, stop = (Literal(0), given[0]) if len(given) == 1 else given[:2]
        step = ast.literal_eval(span.args[2]) if len(given) == 3 else 1
        if name == "_":
            self.loops += 1
            name = "turn" if self.loops == 1 else f"turn_{self.loops}"
        self.scope.enter()
        self.scope.declare(name, ValueKind.INT)
        body = self.block(node.body, node.lineno)
        self.scope.leave()
        return For(name, start, stop, step, body)

    def target(self, node: ast.expr) -> LocalVariable | ArrayEntry:
        """The variable or array entry on the left of an assignment."""
        found = self.of.expression(node)
        if not isinstance(found, LocalVariable | ArrayEntry):
            self.text.refuse(node, "only variables and entries of arrays are assigned")
        return found

    def assigned(self, node: ast.stmt, target: ast.expr, operator: str, value: ast.expr) -> Assign:
        """An assignment to a declared variable or array entry, whose type must match."""
        place, found = self.target(target), self.of.expression(value)
        self.of.alike(node, place, found)
        return Assign(place, operator, found)

    def assignment(self, node: ast.Assign, target: ast.expr) -> Statement:
        """An assignment; the first one to a name in a block declares it."""
        if not isinstance(target, ast.Name) or self.scope.knows(target.id):
            return self.assigned(node, target, "", node.value)
        name = target.id
        match node.value:
            case ast.Call(func=ast.Name(id="reals" | "ints" as word), args=[size]):
                kind = ValueKind.REAL if word == "reals" else ValueKind.INT
                made = Array(name, kind, self.of.expression(size))
                self.scope.declare(name, kind, array=True)
                return made
            case ast.Attribute(value=ast.Name(id="module"), attr=attr) if attr.endswith(
                ("_at", "quaternions")
            ):
                self.scope.declare(name, ValueKind.INT, array=True, detail=attr)
                return ConstantTable(name, ValueKind.INT, detail=attr)
            case ast.Name(id=word) if isinstance(self.text.names.get(word), tuple):
                entries = self.text.names[word]
                self.scope.declare(name, ValueKind.REAL, array=True, length=len(entries))
                return ConstantTable(name, ValueKind.REAL, entries)
            case _:
                value = self.of.expression(node.value)
                kind = self.of.kind(value, node)
                self.scope.declare(name, kind, constant=name.isupper())
                return Constant(name, value) if name.isupper() else Let(name, kind, value, True)


def _finals(body: tuple[Statement, ...]) -> tuple[Statement, ...]:
    """The same where each `Let` says whether anything else is assigned to its variable."""
    made: list[Statement] = []
    for place, statement in enumerate(body):
        match statement:
            case Let():
                later = nested(body[place + 1 :])
                again = any(
                    isinstance(x, Assign)
                    and isinstance(x.target, LocalVariable)
                    and x.target.name == statement.name
                    for x in later
                )
                made.append(replace(statement, final=not again))
            case For() | While():
                made.append(replace(statement, body=_finals(statement.body)))
            case If():
                inner, other = _finals(statement.body), _finals(statement.orelse)
                made.append(replace(statement, body=inner, orelse=other))
            case _:
                made.append(statement)
    return tuple(made)

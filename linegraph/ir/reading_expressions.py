"""Expressions of algorithms, read from Python's syntax tree."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.ir.statements import (
    ArrayEntry,
    ArrayPart,
    Bound,
    Choice,
    Count,
    Detail,
    Expression,
    Infinity,
    Intrinsic,
    Invocation,
    Literal,
    LocalVariable,
    Minus,
    NamedNumber,
    Not,
    Operation,
    ProcedureParameter,
    Use,
    ValueKind,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from types import FunctionType

ANNOTATIONS = {
    "int": ProcedureParameter("", ValueKind.INT),
    "float": ProcedureParameter("", ValueKind.REAL),
    "bool": ProcedureParameter("", ValueKind.BOOL),
    "Reals": ProcedureParameter("", ValueKind.REAL, array=True),
    "Ints": ProcedureParameter("", ValueKind.INT, array=True),
    "Places": ProcedureParameter("", ValueKind.INT, array=True),
}
"""The type of a parameter, by the text of its annotation."""

_BINARY = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
_COMPARISONS = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}
_INTRINSICS = {"abs": 1, "sqrt": 1, "float": 1, "larger": 2, "ratio": 2}


class Signature(NamedTuple):
    """The signature of a procedure, for checking calls of it."""

    name: str
    module: bool
    parameters: tuple[ProcedureParameter, ...]
    returns: ValueKind | None
    fails: bool


class Known(NamedTuple):
    """The meaning of a name: a number or an array, with its length if known."""

    kind: ValueKind
    array: bool
    constant: bool
    detail: str
    length: int | None


class BlockScope:
    """The names that are known at a place, block within block."""

    def __init__(self) -> None:
        """The outermost block is that of the parameters."""
        self.blocks: list[dict[str, Known]] = [{}]

    def enter(self) -> None:
        """Begin a block within the current one."""
        self.blocks.append({})

    def leave(self) -> None:
        """End the current block and forget the names declared in it."""
        self.blocks.pop()

    def declare(
        self,
        name: str,
        kind: ValueKind,
        *,
        array: bool = False,
        constant: bool = False,
        detail: str = "",
        length: int | None = None,
    ) -> None:
        """Declare a name in the current block.

        Args:
            name: the variable or array.
            kind: the type of the number, or of the entries.
            array: whether it is an array.
            constant: whether it is a constant, whose name is in capitals.
            detail: the fact of the model that the array contains; empty for others.
            length: the length of the array if its entries are known; else None.
        """
        self.blocks[-1][name] = Known(kind, array, constant, detail, length)

    def knows(self, name: str) -> bool:
        """Whether a name is declared in this block or one around it."""
        return any(name in block for block in self.blocks)

    def __getitem__(self, name: str) -> Known:
        return next(block[name] for block in reversed(self.blocks) if name in block)


class ExpressionReader:
    """Reads the expressions of one function."""

    def __init__(
        self,
        scope: BlockScope,
        names: Mapping[str, Any],
        refuse: Callable[[ast.AST, str], Any],
        signature: Callable[[FunctionType], Signature],
    ) -> None:
        """Read expressions within a scope that the caller keeps up to date.

        Args:
            scope: the variables and arrays declared so far.
            names: the global names of the file, with their values.
            refuse: raises `ValueError` with the position of a node and a message.
            signature: returns the signature of another function of algorithms.
        """
        self.scope, self.names, self.refuse, self.signature = scope, names, refuse, signature

    def expression(self, node: ast.expr) -> Expression:
        """Any expression that has a value."""
        match node:
            case ast.Constant(value=bool() | int() | float() as value):
                return Literal(value)
            case ast.Name(id=name):
                return self.name(node, name)
            case ast.Attribute(value=ast.Name(id="small"), attr=attr):
                return Bound(attr)
            case ast.Attribute(value=ast.Name(id="module"), attr=attr):
                return Count(attr) if attr.isupper() else Detail(attr, False, _kind_of(attr))
            case ast.Subscript(value=ast.Name(id=array), slice=place):
                return ArrayEntry(array, self.expression(place), self.array(node, array))
            case ast.BinOp(op=operator) if type(operator) in _BINARY:
                a, b = self.expression(node.left), self.expression(node.right)
                return self.operation(node, _BINARY[type(operator)], a, b)
            case ast.UnaryOp(op=ast.USub()):
                a = self.expression(node.operand)
                return Minus(a, self.kind(a, node))
            case ast.UnaryOp(op=ast.Not()):
                return Not(self.condition(node.operand))
            case ast.Compare(ops=[operator], comparators=[right]):
                a, b = self.expression(node.left), self.expression(right)
                self.alike(node, a, b)
                return Operation(_COMPARISONS[type(operator)], a, b, ValueKind.BOOL)
            case ast.BoolOp(op=operator):
                word = "and" if isinstance(operator, ast.And) else "or"
                found, *others = [self.condition(x) for x in node.values]
                for other in others:
                    found = Operation(word, found, other, ValueKind.BOOL)
                return found
            case ast.IfExp():
                a, b = self.expression(node.body), self.expression(node.orelse)
                return Choice(self.condition(node.test), a, b, self.alike(node, a, b))
            case ast.Call():
                return self.call(node)
            case _:
                self.refuse(node, "this is none of the expressions of algorithms")
                raise AssertionError

    def name(self, node: ast.AST, name: str) -> Expression:
        """A variable, or a constant of the file.

        Args:
            node: where the name occurs.
            name: the name.

        Raises:
            ValueError: the name is not declared, or is that of an array.
        """
        if self.scope.knows(name):
            known = self.scope[name]
            if known.array:
                self.refuse(node, f"{name} is an array, and a number is expected")
            return LocalVariable(name, known.kind)
        if name == "infinity":
            return Infinity()
        value = self.names.get(name)
        if isinstance(value, int) and not isinstance(value, bool):
            return NamedNumber(name, value)
        if isinstance(value, float):
            return Literal(value)
        self.refuse(node, f"{name} is not known here; assign it before the block")
        raise AssertionError

    def array(self, node: ast.AST, name: str) -> ValueKind:
        """The type of an array's entries.

        Args:
            node: where the array occurs.
            name: of the array.

        Raises:
            ValueError: the name is not that of an array.
        """
        if not self.scope.knows(name) or not self.scope[name].array:
            self.refuse(node, f"{name} is no array")
        return self.scope[name].kind

    def condition(self, node: ast.expr) -> Expression:
        """An expression that is true or false."""
        found = self.expression(node)
        if self.kind(found, node) is not ValueKind.BOOL:
            self.refuse(node, "a condition is true or false, not a number")
        return found

    def kind(self, x: Expression, node: ast.AST) -> ValueKind:
        """The type of an expression's value.

        Args:
            x: the expression.
            node: where it occurs.

        Raises:
            ValueError: it is a call of a function that returns nothing.
        """
        if x.kind is None:
            self.refuse(node, "this returns nothing")
        assert x.kind is not None
        return x.kind

    def alike(self, node: ast.AST, a: Expression, b: Expression) -> ValueKind:
        """The common type of two operands.

        Args:
            node: where they occur.
            a: the first operand.
            b: the second operand.

        Raises:
            ValueError: their types differ; nothing is converted implicitly.
        """
        first, second = self.kind(a, node), self.kind(b, node)
        if first is not second:
            self.refuse(
                node, f"{first.value} and {second.value} do not meet; write 1.0 or float(i)"
            )
        return first

    def operation(self, node: ast.AST, operator: str, a: Expression, b: Expression) -> Expression:
        """A sum, difference, product or quotient.

        Args:
            node: where it occurs.
            operator: ``+``, ``-``, ``*`` or ``/``.
            a: the left operand.
            b: the right operand, of the same type.

        Raises:
            ValueError: the types differ, are Boolean, or are whole numbers in a quotient.
        """
        kind = self.alike(node, a, b)
        if kind is ValueKind.BOOL or (operator == "/" and kind is ValueKind.INT):
            self.refuse(node, f"{operator} takes real numbers")
        return Operation(operator, a, b, kind)

    # ---- calls

    def call(self, node: ast.Call) -> Expression:
        """A call that returns a value."""
        match node.func, node.args:
            case ast.Name(id="len"), [ast.Name(id=name)] if self.scope.knows(name):
                known = self.scope[name]
                if known.detail:
                    return Detail(known.detail, True, ValueKind.INT)
                if known.length is not None:
                    return Literal(known.length)
            case ast.Name(id="len"), [ast.Attribute(value=ast.Name(id="module"), attr=attr)]:
                return Detail(attr, True, ValueKind.INT)
            case ast.Name(id=word), given if _INTRINSICS.get(word) == len(given):
                wanted = ValueKind.INT if word == "float" else ValueKind.REAL
                arguments = tuple(map(self.expression, given))
                if any(x.kind is not wanted for x in arguments):
                    self.refuse(node, f"{word} takes {wanted.value} numbers")
                return Intrinsic(word, arguments)
            case _:
                pass
        found = self.invocation(node)
        if found is None:
            self.refuse(node, "this is none of the functions of algorithms")
            raise AssertionError
        self.kind(found, node)
        return found

    def invocation(self, node: ast.Call) -> Invocation | None:
        """A call of another function of algorithms; nothing if it is none."""
        function = self.names.get(node.func.id) if isinstance(node.func, ast.Name) else None
        if not callable(function) or node.keywords:
            return None
        signature = self.signature(function)
        given: list[ast.expr] = []
        for argument in node.args:
            splat = isinstance(argument, ast.Starred) and isinstance(argument.value, ast.Tuple)
            given += argument.value.elts if splat else [argument]  # type: ignore[attr-defined]
        if signature.module:
            given = given[1:]
        if len(given) != len(signature.parameters):
            self.refuse(node, f"{signature.name} takes {len(signature.parameters)} arguments")
        arguments = tuple(
            self.argument(x, parameter)
            for x, parameter in zip(given, signature.parameters, strict=True)
        )
        return Invocation(signature.name, arguments, signature.returns, fails=signature.fails)

    def argument(self, node: ast.expr, parameter: ProcedureParameter) -> Expression | ArrayPart:
        """An argument of a call.

        Args:
            node: the argument.
            parameter: the parameter for which it is passed.

        Raises:
            ValueError: its type differs from that of the parameter, or the called function writes to it
                although it is a slice or a constant array.
        """
        if not parameter.array:
            found = self.expression(node)
            if found.kind is not parameter.kind:
                self.refuse(node, f"{parameter.name} is {parameter.kind.value}")
            return found
        part = self.part(node)
        if self.array(node, part.array) is not parameter.kind:
            self.refuse(node, f"{parameter.name} is an array of {parameter.kind.value}")
        if parameter.written and (part.start or part.stop or self.scope[part.array].detail):
            self.refuse(node, f"{parameter.name} is written: give a whole array of your own")
        return part

    def part(self, node: ast.expr) -> ArrayPart:
        """An array, or a slice of one."""
        match node:
            case ast.Name(id=name):
                self.array(node, name)
                return ArrayPart(name)
            case ast.Subscript(value=ast.Name(id=name), slice=ast.Slice(step=None) as span):
                self.array(node, name)
                bounds = [
                    None if x is None else self.expression(x) for x in (span.lower, span.upper)
                ]
                return ArrayPart(name, *bounds)
            case _:
                self.refuse(node, "an array is expected")
                raise AssertionError

    def used(self, node: ast.Call) -> Use | None:
        """A call of an emitted function of the module; nothing if it is none."""
        match node.func:
            case ast.Attribute(value=ast.Name(id="module"), attr=function):
                results = tuple(map(self.part, node.args))
                given = tuple((str(x.arg), self.part(x.value)) for x in node.keywords)
                return Use(function, results, given, passed=function == "then")
            case _:
                return None


def _kind_of(detail: str) -> ValueKind:
    return ValueKind.BOOL if detail == "baumgarte" else ValueKind.INT

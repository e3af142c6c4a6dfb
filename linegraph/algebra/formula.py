"""Expressions that users write, as text; parsed by an own walker and never executed.

A `Formula` is the parsed text. It is evaluated over any algebra by looking its names up in a mapping, so that
the same text gives numbers, DAG nodes or SymPy expressions. The language:

    numbers   names   + - * / **   ( )   sin(x) ... max(x, y)   der(x)
    position(body.frame).x ... torque(joint).z   across(element)   through(element)

Its limits hold before any number is computed: a text that would explode, as 9**9**9, is refused and not
tried.
"""

from __future__ import annotations

import ast
import math
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from linegraph.algebra.powers import power, quotient
from linegraph.errors import ModelError
from linegraph.ir.functions import ARITY

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar

LONGEST_TEXT = 10_000
DEEPEST = 100
MOST_NODES = 5_000
LARGEST_POWER = 64
LARGEST_EXPONENT = 300
"""The largest decimal exponent of a literal, of either sign."""

LONGEST_NUMBER = 100
"""The largest number of characters of a literal."""

CONSTANTS = {"pi": math.pi}
RATE = "der"

VECTORS = (
    *("position", "velocity", "acceleration", "angular_velocity", "angular_acceleration"),
    *("force", "torque"),
)
VARIABLES = (*VECTORS, "across", "through")
"""Variables of edges and points, which outputs may name."""

_SIGNS = {ast.UAdd: "+", ast.USub: "-"}
_OPERATORS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}


@dataclass(frozen=True)
class Formula:
    """A parsed expression: `op` applied to `parts`.

    Attributes:
        op: ``number``, ``name``, ``der``, ``variable``, ``+ - * / **``, or the name of a function.
        parts: the operands; of a number its value, of a name its text, of a variable its kind, its owner and
            its component.
    """

    op: str
    parts: tuple[Formula | Fraction | float | str, ...]

    def names(self) -> Iterator[str]:
        """The names to be looked up, rates as ``der(x)``, in order of appearance and with repetitions."""
        if self.op == "name":
            yield str(self.parts[0])
        elif self.op == RATE:
            yield f"der({self.parts[0]})"
        elif self.op == "variable":
            what, which, component = self.parts
            yield f"{what}({which}){'.' if component else ''}{component}"
        else:
            for part in self.parts:
                if isinstance(part, Formula):
                    yield from part.names()

    def evaluate(self, algebra: Algebra, values: Mapping[str, Scalar]) -> Scalar:
        """The value of the expression over an algebra.

        Args:
            algebra: where to calculate.
            values: scalars by name, in the units of the model file; rates under ``der(x)``.

        Raises:
            ModelError: a name is not known, or a number is divided by zero.
        """
        if self.op == "number":
            return self.parts[0]
        if self.op in ("name", RATE, "variable"):
            name = next(self.names())
            if name not in values:
                raise ModelError("", f"{name} is not known here; {_known(values)}")
            return values[name]
        operands = [p.evaluate(algebra, values) for p in self.parts if isinstance(p, Formula)]
        return _apply(self.op, operands, algebra)


@lru_cache(maxsize=4096)  # a model's expressions are parsed again wherever their names are needed
def parse(text: str) -> Formula:
    """Parse an expression.

    Raises:
        ModelError: the text is not an expression of this language; the message says why and at which column.

    Example:
        >>> from linegraph.algebra.protocol import Floats
        >>> parse("m*l**2/3").evaluate(Floats(), {"m": 6.0, "l": 0.5})
        0.5
    """
    if len(text) > LONGEST_TEXT:
        raise ModelError(
            "", f"an expression of {len(text)} characters; the limit is {LONGEST_TEXT}"
        )
    _refuse_notation(text)
    try:
        tree = ast.parse(text.strip(), mode="eval").body
    except SyntaxError as error:
        raise ModelError("", f"cannot read {_shown(text)}: {_syntax(error)}") from None
    except (RecursionError, MemoryError, ValueError):
        raise ModelError("", f"cannot read {_shown(text)}: it is nested too deeply") from None
    return _Reader(text).read(tree, 0)


def variable_of(name: str) -> tuple[str, str, str] | None:
    """Kind, owner and component of a variable as `Formula.names` writes it; None for other names.

    Example:
        >>> variable_of("position(arm.tip).x"), variable_of("der(x)")
        (('position', 'arm.tip', 'x'), None)
    """
    what, bracket, rest = name.partition("(")
    if not bracket or what not in VARIABLES:
        return None
    which, _, component = rest.partition(")")
    return what, which, component.removeprefix(".")


class _Reader:
    """Turns the parsed text into a `Formula`, refusing all syntax that is not listed."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._left = MOST_NODES

    def read(self, node: ast.expr, depth: int) -> Formula:
        """One syntax node and all below it."""
        self._left -= 1
        if depth > DEEPEST:
            raise self._error(node, f"nested deeper than {DEEPEST}")
        if self._left < 0:
            raise self._error(node, f"more than {MOST_NODES} parts")
        if isinstance(node, ast.Constant):
            return self._number(node)
        if isinstance(node, ast.Name):
            if node.id in CONSTANTS:
                return Formula("number", (CONSTANTS[node.id],))
            return Formula("name", (node.id,))
        if isinstance(node, ast.UnaryOp) and type(node.op) in _SIGNS:
            inner = self.read(node.operand, depth + 1)
            return inner if type(node.op) is ast.UAdd else Formula("-", (inner,))
        if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            return self._operation(node, depth)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            return self._call(node, node.func.id, depth)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Call):
            return self._component(node, node.value)
        raise self._error(node, _hint(node))

    def _component(self, node: ast.Attribute, call: ast.Call) -> Formula:
        """One component of a vector: ``position(arm.tip).x``."""
        what = call.func.id if isinstance(call.func, ast.Name) else ""
        if what not in VECTORS:
            raise self._error(node, _hint(node))
        if node.attr not in ("x", "y", "z"):
            raise self._error(node, f"a vector has the components x, y and z, not {node.attr}")
        return Formula("variable", (what, self._thing(call, what), node.attr))

    def _thing(self, call: ast.Call, what: str) -> str:
        """The owner of a variable: a name, or ``body.frame``."""
        if len(call.args) == 1 and not call.keywords:
            (node,) = call.args
            if isinstance(node, ast.Name):
                return node.id
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                return f"{node.value.id}.{node.attr}"
        raise self._error(call, f"{what} takes one name, as in {what}(arm.tip)")

    def _operation(self, node: ast.BinOp, depth: int) -> Formula:
        left, right = self.read(node.left, depth + 1), self.read(node.right, depth + 1)
        op = _OPERATORS[type(node.op)]
        if op == "**":
            self._check_power(node, right)
        if op == "/" and right == Formula("number", (0,)):
            raise self._error(node, "division by zero")
        return Formula(op, (left, right))

    def _check_power(self, node: ast.expr, exponent: Formula) -> None:
        """Refuse exponents other than integers and half-integers of moderate size."""
        value: object = exponent.parts[0]
        negative = exponent.op == "-" and len(exponent.parts) == 1
        if negative and isinstance(value, Formula):
            value = value.parts[0] if value.op == "number" else None
        if not isinstance(value, (int, Fraction)) or (2 * value) % 1 or value > LARGEST_POWER:
            allowed = f"an integer or half-integer up to {LARGEST_POWER}"
            raise self._error(node, f"an exponent must be {allowed}; use exp and log otherwise")

    def _number(self, node: ast.Constant) -> Formula:
        """A literal as an exact number, its size checked on the text."""
        if type(node.value) not in (int, float):
            raise self._error(node, "only numbers, names, operators and functions may stand here")
        # the size is checked first: an exact 1e999999999 has a billion digits
        text = ast.get_source_segment(self._text.strip(), node) or ""
        if "_" in text or text[:2].lower() in ("0x", "0o", "0b"):
            raise self._error(node, "write numbers as decimals, such as 1500 or 1.5e3")
        size = abs(float(text)) if len(text) <= LONGEST_NUMBER else math.inf
        zero = not any(digit in text.lower().partition("e")[0] for digit in "123456789")
        if not zero and not 10.0**-LARGEST_EXPONENT < size < 10.0**LARGEST_EXPONENT:
            raise self._error(node, "the number is too large or too small")
        exact = Fraction(text)
        return Formula("number", (int(exact) if exact.denominator == 1 else exact,))

    def _call(self, node: ast.Call, name: str, depth: int) -> Formula:
        if node.keywords or any(isinstance(a, ast.Starred) for a in node.args):
            raise self._error(node, "functions take plain arguments")
        if name == RATE:
            if len(node.args) != 1 or not isinstance(node.args[0], ast.Name):
                raise self._error(node, "der takes one name, as in der(hinge)")
            return Formula(RATE, (node.args[0].id,))
        if name in VARIABLES and name not in VECTORS:
            return Formula("variable", (name, self._thing(node, name), ""))
        if name in VECTORS:
            raise self._error(node, f"{name} is a vector: add .x, .y or .z")
        if name not in ARITY:
            raise self._error(node, f"{name}(...) is not a function; known: {', '.join(ARITY)}")
        if len(node.args) != ARITY[name]:
            raise self._error(node, f"{name} takes {ARITY[name]} argument(s), not {len(node.args)}")
        return Formula(name, tuple(self.read(a, depth + 1) for a in node.args))

    def _error(self, node: ast.expr, problem: str) -> ModelError:
        column = node.col_offset + 1
        return ModelError("", f"cannot read {_shown(self._text)}: {problem} (column {column})")


def _apply(op: str, operands: list[Scalar], algebra: Algebra) -> Scalar:
    if op == "+":
        return operands[0] + operands[1]
    if op == "-":
        return -operands[0] if len(operands) == 1 else operands[0] - operands[1]
    if op == "*":
        return operands[0] * operands[1]
    if op == "/":
        return quotient(*operands)
    if op == "**":
        return power(operands[0], operands[1], algebra)
    if op == "sqrt" and hasattr(algebra, "root"):
        return algebra.root(*operands)
    return algebra.function(op, *operands)


def _refuse_notation(text: str) -> None:
    """Refuse notations that Python would read in another way than their writer meant."""
    if not text.isascii():
        odd = next(c for c in text if not c.isascii())
        raise ModelError("", f"cannot read {_shown(text)}: {odd!r} is not ASCII")
    if "^" in text:
        raise ModelError("", f"cannot read {_shown(text)}: write powers as **, not ^")
    if "#" in text or "\n" in text.strip() or "\x00" in text:
        raise ModelError("", f"cannot read {_shown(text)}: an expression is one line without #")


def _hint(node: ast.expr) -> str:
    if isinstance(node, (ast.BinOp, ast.UnaryOp)):
        return "the operators are + - * / and **"
    return "only numbers, names, operators and functions may stand here"


def _syntax(error: SyntaxError) -> str:
    column = f" (column {error.offset})" if error.offset else ""
    return f"it is not an expression{column}"


def _shown(text: str) -> str:
    text = text.strip()
    return ascii(text if len(text) <= 60 else text[:57] + "...")


def _known(values: Mapping[str, Scalar]) -> str:
    names = list(values)
    return f"known: {', '.join(names[:12])}{', ...' if len(names) > 12 else ''}"

"""The statements of algorithms, which are written once and printed in every target language.

A `Procedure` is one function of an algorithm. `linegraph.ir.reading` makes procedures from the text of
Python functions; `linegraph.ir.binding` decides all that depends on the model alone. What is left is what
languages without objects have: whole and real numbers, arrays of fixed size, loops over ranges, decisions
and calls.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linegraph.ir.program import Status


class ValueKind(Enum):
    """The type of a variable, a result or the entries of an array."""

    INT = "int"
    REAL = "real"
    BOOL = "bool"


# ---- expressions


@dataclass(frozen=True)
class Literal:
    """A constant number or Boolean."""

    value: bool | int | float

    @property
    def kind(self) -> ValueKind:
        """The type of the value; a Boolean does not count as a whole number."""
        if isinstance(self.value, bool):
            return ValueKind.BOOL
        return ValueKind.INT if isinstance(self.value, int) else ValueKind.REAL


@dataclass(frozen=True)
class Infinity:
    """Infinity, which is larger than all numbers."""

    kind: ValueKind = ValueKind.REAL


@dataclass(frozen=True)
class Bound:
    """A bound of rounding, by its name in `linegraph.ir.rounding`."""

    name: str
    kind: ValueKind = ValueKind.REAL


@dataclass(frozen=True)
class Count:
    """A count of the module, by the name that all languages give it; its value once the model is known."""

    name: str
    value: int | None = None
    kind: ValueKind = ValueKind.INT


@dataclass(frozen=True)
class Detail:
    """Another fact of the model, or the length of a list; its value replaces it when it is known."""

    name: str
    length: bool
    kind: ValueKind


@dataclass(frozen=True)
class NamedNumber:
    """A named integer constant, such as the result code of a procedure."""

    name: str
    value: int
    kind: ValueKind = ValueKind.INT


@dataclass(frozen=True)
class LocalVariable:
    """A parameter or a local variable that is one number."""

    name: str
    kind: ValueKind


@dataclass(frozen=True)
class ArrayEntry:
    """An entry of an array."""

    array: str
    place: Expression
    kind: ValueKind


@dataclass(frozen=True)
class Operation:
    """Two operands: ``+ - * / < <= > >= == != and or``."""

    operator: str
    a: Expression
    b: Expression
    kind: ValueKind


@dataclass(frozen=True)
class Minus:
    """A change of sign."""

    a: Expression
    kind: ValueKind


@dataclass(frozen=True)
class Not:
    """The negation of a condition."""

    a: Expression
    kind: ValueKind = ValueKind.BOOL


@dataclass(frozen=True)
class Choice:
    """One of two values, depending on a condition."""

    test: Expression
    a: Expression
    b: Expression
    kind: ValueKind


@dataclass(frozen=True)
class Intrinsic:
    """A function that every language has: ``abs sqrt larger ratio float``."""

    name: str
    arguments: tuple[Expression, ...]
    kind: ValueKind = ValueKind.REAL


@dataclass(frozen=True)
class ArrayPart:
    """An array as an argument: from `start` on, to `stop`; whole without them."""

    array: str
    start: Expression | None = None
    stop: Expression | None = None


@dataclass(frozen=True)
class Invocation:
    """A call of another procedure; its kind is that of what it returns, None if nothing.

    Attributes:
        module: whether the procedure is for the module itself, whose functions it may call.
        context: arguments of the emitted function that it passes on to these, in front.
        fails: whether it may end with a status.
    """

    procedure: str
    arguments: tuple[Expression | ArrayPart, ...]
    kind: ValueKind | None
    context: tuple[str, ...] = ()
    fails: bool = False


Expression = (
    Literal
    | Infinity
    | Bound
    | Count
    | Detail
    | NamedNumber
    | LocalVariable
    | ArrayEntry
    | Operation
    | Minus
    | Not
    | Choice
    | Intrinsic
    | Invocation
)


# ---- statements


@dataclass(frozen=True)
class Remark:
    """A comment on a line of its own."""

    text: str


@dataclass(frozen=True)
class Constant:
    """A named whole number that depends on the model, such as the size of an array."""

    name: str
    value: Expression


@dataclass(frozen=True)
class ConstantTable:
    """A constant array; `detail` names the fact of the model that gives its entries, until they are known."""

    name: str
    kind: ValueKind
    entries: tuple[int | float, ...] = ()
    detail: str = ""


@dataclass(frozen=True)
class Array:
    """A new array of zeros."""

    name: str
    kind: ValueKind
    size: Expression


@dataclass(frozen=True)
class Let:
    """A new variable; `final` if nothing else is assigned to it."""

    name: str
    kind: ValueKind
    value: Expression
    final: bool


@dataclass(frozen=True)
class Assign:
    """``target = value``, or with an operator ``target += value``."""

    target: LocalVariable | ArrayEntry
    operator: str
    value: Expression


@dataclass(frozen=True)
class For:
    """A loop over a range of whole numbers; the variable is not assigned within."""

    name: str
    start: Expression
    stop: Expression
    step: int
    body: tuple[Statement, ...]


@dataclass(frozen=True)
class While:
    """A loop while a condition holds."""

    test: Expression
    body: tuple[Statement, ...]


@dataclass(frozen=True)
class If:
    """A decision between two blocks, the second of which may be empty."""

    test: Expression
    body: tuple[Statement, ...]
    orelse: tuple[Statement, ...] = ()


@dataclass(frozen=True)
class Break:
    """Leave the innermost loop."""


@dataclass(frozen=True)
class Return:
    """Leave the procedure, with a value where it has one; from an emitted function, with its results."""

    value: Expression | None = None


@dataclass(frozen=True)
class Fail:
    """End the emitted function with a status."""

    status: Status


@dataclass(frozen=True)
class Perform:
    """A call as a statement, which returns no value."""

    call: Invocation


@dataclass(frozen=True)
class Use:
    """A call of an emitted function of the module.

    Attributes:
        function: its name; ``then`` for the one that the routine names.
        results: the arrays that take its results.
        given: arguments other than those of the same name here.
        arguments: all arguments in order, once the module is known: names, and arrays for those in `given`.
        fails: whether it reports a status, which is passed on.
        passed: whether its results are those of the emitted function itself.
    """

    function: str
    results: tuple[ArrayPart, ...]
    given: tuple[tuple[str, ArrayPart], ...] = ()
    arguments: tuple[ArrayPart | str, ...] = ()
    fails: bool = False
    passed: bool = False


Statement = (
    Remark
    | Constant
    | ConstantTable
    | Array
    | Let
    | Assign
    | For
    | While
    | If
    | Break
    | Return
    | Fail
    | Perform
    | Use
)


@dataclass(frozen=True)
class ProcedureParameter:
    """A parameter of a procedure: a number, or an array, which is `written` if the procedure changes it."""

    name: str
    kind: ValueKind
    array: bool = False
    written: bool = False


@dataclass(frozen=True)
class Procedure:
    """One function of an algorithm.

    Attributes:
        name: its name, unique among all algorithms.
        about: the lines of its description.
        module: whether it depends on the model.
        returns: what it returns; None if nothing.
        calls: the procedures that it calls.
        context: arguments of the emitted function that its calls of others need, in their order.
        fails: whether it may end with a status.
        uses: whether it, or one that it calls, calls emitted functions of the module.
    """

    name: str
    about: tuple[str, ...]
    parameters: tuple[ProcedureParameter, ...]
    returns: ValueKind | None
    body: tuple[Statement, ...]
    module: bool = False
    calls: tuple[str, ...] = ()
    context: tuple[str, ...] = ()
    fails: bool = False
    uses: bool = False

"""Parameters: named numbers of a model that may stay symbols in everything derived from it."""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.algebra.formula import Formula, parse
from linegraph.algebra.protocol import set_label
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar


@dataclass(frozen=True)
class Parameter:
    """A named number: its default value, unit and meaning.

    With an expression of other parameters for its value it is *derived*: computed wherever it is used.

    It calculates as the sympy symbol of its name, so ``m * l**2 / 3`` is a sympy expression.

    Attributes:
        name: in expressions and in emitted code.
        value: a number, an expression of other parameters, or None where it has no default.
        unit: for readers; nothing is converted.
        about: its meaning, for readers.

    Example:
        >>> m, l = Parameter("m", 2.0, "kg"), Parameter("l", 0.5, "m")
        >>> m * l**2 / 3
        l**2*m/3
    """

    name: str
    value: Any = None
    unit: str = ""
    about: str = ""

    @property
    def derived(self) -> bool:
        """Whether the value is an expression of other parameters."""
        return self.value is not None and not is_number(self.value)

    def _sympy_(self) -> Any:
        from sympy import Symbol

        return Symbol(self.name)

    def __neg__(self) -> Any:
        return -self._sympy_()

    def __add__(self, other: Any) -> Any:
        return self._sympy_() + other

    def __radd__(self, other: Any) -> Any:
        return other + self._sympy_()

    def __sub__(self, other: Any) -> Any:
        return self._sympy_() - other

    def __rsub__(self, other: Any) -> Any:
        return other - self._sympy_()

    def __mul__(self, other: Any) -> Any:
        return self._sympy_() * other

    def __rmul__(self, other: Any) -> Any:
        return other * self._sympy_()

    def __truediv__(self, other: Any) -> Any:
        return self._sympy_() / other

    def __rtruediv__(self, other: Any) -> Any:
        return other / self._sympy_()

    def __pow__(self, other: Any) -> Any:
        return self._sympy_() ** other


@dataclass(frozen=True)
class Input(Parameter):
    """A named input u: known at run time, it may be used in laws and prescribed motions."""


def is_number(x: Any) -> bool:
    """Whether a model value is a plain number: not a name, a text or an expression.

    Args:
        x: the model value.
    """
    return not isinstance(x, (Parameter, str, Formula)) and not hasattr(x, "free_symbols")


def resolver(algebra: Algebra, values: Mapping[str, Scalar]) -> Callable[[Any], Scalar]:
    """A function from model values to scalars of `algebra`.

    Numbers stay numbers, parameters are looked up in `values`, texts are parsed, formulas and sympy
    expressions are walked.

    Args:
        algebra: where to calculate.
        values: scalars of the names that a value may use.

    Returns:
        The function. It raises `ModelError` for a parameter that `values` lacks and for text that cannot be
        read.
    """

    def resolve(x: Any) -> Scalar:
        if isinstance(x, str):
            x = parse(x)
        if isinstance(x, Formula):
            return x.evaluate(algebra, values)
        if isinstance(x, Parameter):
            if x.name not in values:
                raise ModelError(f'parameter "{x.name}"', "does not belong to this model")
            return values[x.name]
        if hasattr(x, "free_symbols"):
            from linegraph.algebra.sympy_scalars import evaluate

            return evaluate(x, algebra, values)
        return x

    return resolve


def valued(
    parameters: Iterable[Parameter], algebra: Algebra, given: Callable[[Parameter], Scalar]
) -> dict[str, Scalar]:
    """The scalar of every parameter: `given` for independent ones, their expression for derived ones.

    Args:
        parameters: in an order in which each uses only those before it.
        algebra: where to calculate.
        given: the scalar of an independent parameter.

    Returns:
        Scalars by name.
    """
    values: dict[str, Scalar] = {}
    for parameter in parameters:
        if parameter.derived:
            set_label(algebra, f"parameter {parameter.name}")
            values[parameter.name] = resolver(algebra, values)(parameter.value)
        else:
            values[parameter.name] = given(parameter)
    set_label(algebra, "")
    return values


def names_in(x: Any) -> set[str]:
    """The names a model value depends on; rates as ``der(x)``.

    Args:
        x: the model value.
    """
    if isinstance(x, str):
        x = parse(x)
    if isinstance(x, Formula):
        return set(x.names())
    if isinstance(x, Parameter):
        return {x.name}
    return {symbol.name for symbol in getattr(x, "free_symbols", ())}


def sample_values(parameters: Iterable[Parameter], algebra: Algebra) -> dict[str, Scalar]:
    """Each parameter's value, or some positive number where it has none.

    At such values properties are tested that are to hold at all values.
    The numbers are drawn from 0.5 to 2 with a fixed seed, so that the same model gets the same ones.

    Args:
        parameters: in an order in which each uses only those before it.
        algebra: where to calculate.

    Returns:
        Scalars by name.
    """
    draw = random.Random(0)

    def given(parameter: Parameter) -> float:
        return draw.uniform(0.5, 2.0) if parameter.value is None else float(parameter.value)

    return valued(parameters, algebra, given)

"""Parameters: named numbers of a model that may stay symbols in everything derived from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from linegraph.algebra import Algebra
    from linegraph.vector import Scalar


@dataclass(frozen=True)
class Parameter:
    """A named number: its default value, unit and meaning.

    It calculates as the sympy symbol of its name, so ``m * l**2 / 3`` is a sympy expression.

    Example:
        >>> m, l = Parameter("m", 2.0, "kg"), Parameter("l", 0.5, "m")
        >>> m * l**2 / 3
        l**2*m/3
    """

    name: str
    value: float | None = None
    unit: str = ""
    about: str = ""

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


def is_number(x: Any) -> bool:
    """Whether a model value is a plain number, not a parameter or an expression."""
    return not isinstance(x, Parameter) and not hasattr(x, "free_symbols")


def resolver(algebra: Algebra, parameters: Mapping[str, Scalar]) -> Callable[[Any], Scalar]:
    """A function from model values to scalars of `algebra`.

    Numbers stay numbers, parameters are looked up in `parameters`, sympy expressions are walked.
    """

    def resolve(x: Any) -> Scalar:
        if isinstance(x, Parameter):
            if x.name not in parameters:
                raise ModelError(f'parameter "{x.name}"', "does not belong to this model")
            return parameters[x.name]
        if hasattr(x, "free_symbols"):
            from linegraph.symbols import evaluate

            return evaluate(x, algebra, parameters)
        return x

    return resolve

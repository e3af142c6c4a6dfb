"""Scalars with their first two time derivatives, for prescribed motions.

A `Jet` (x, ẋ, ẍ) obeys the chain rule over any algebra, so that a formula in t evaluated at t = (t, 1, 0)
gives position, velocity and acceleration at once: a truncated Taylor series [Griewank and Walther 2008].
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.algebra.powers import power
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Callable
    from fractions import Fraction

    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar


@dataclass(frozen=True)
class Jet:
    """A scalar with its first and second time derivative.

    Attributes:
        x: the value.
        dx: ẋ.
        ddx: ẍ, not divided by 2.

    Example:
        >>> t = Jet(2.0, 1, 0)
        >>> t * t * t
        Jet(x=8.0, dx=12.0, ddx=12.0)
    """

    x: Scalar
    dx: Scalar
    ddx: Scalar

    def __neg__(self) -> Jet:
        return Jet(-self.x, -self.dx, -self.ddx)

    def __add__(self, other: Scalar) -> Jet:
        y = lifted(other)
        return Jet(self.x + y.x, self.dx + y.dx, self.ddx + y.ddx)

    __radd__ = __add__

    def __sub__(self, other: Scalar) -> Jet:
        return self + -lifted(other)

    def __rsub__(self, other: Scalar) -> Jet:
        return lifted(other) + -self

    def __mul__(self, other: Scalar) -> Jet:
        y = lifted(other)
        ddx = self.ddx * y.x + 2 * (self.dx * y.dx) + self.x * y.ddx
        return Jet(self.x * y.x, self.dx * y.x + self.x * y.dx, ddx)

    __rmul__ = __mul__

    def __truediv__(self, other: Scalar) -> Jet:
        # x y differentiated twice, solved for the derivatives of x: the quotient is reused
        y = lifted(other)
        x = self.x / y.x
        dx = (self.dx - x * y.dx) / y.x
        return Jet(x, dx, (self.ddx - 2 * (dx * y.dx) - x * y.ddx) / y.x)

    def __rtruediv__(self, other: Scalar) -> Jet:
        return lifted(other) / self


def lifted(x: Scalar) -> Jet:
    """A constant as a jet with zero derivatives; a jet as it is."""
    return x if isinstance(x, Jet) else Jet(x, 0, 0)


class Jets:
    """The algebra of jets whose components are scalars of another algebra."""

    def __init__(self, base: Algebra) -> None:
        """Calculate components over `base`."""
        self._base = base

    def symbol(self, argument: str, place: int | str | None = None) -> Jet:
        """The jet of a symbol: (t, 1, 0) for the time, otherwise a constant.

        Args:
            argument: name of the argument.
            place: index or name of the entry; None if the argument is one scalar.
        """
        return Jet(self._base.symbol(argument, place), 1 if argument == "t" else 0, 0)

    def sin(self, x: Scalar) -> Jet:
        """Sine of a jet (rad)."""
        return self.function("sin", x)

    def cos(self, x: Scalar) -> Jet:
        """Cosine of a jet (rad)."""
        return self.function("cos", x)

    def sqrt(self, x: Scalar) -> Jet:
        """Square root of a jet; its derivatives are infinite at 0."""
        return self.function("sqrt", x)

    def power(self, base: Scalar, exponent: Fraction) -> Jet:
        """A half-integer power, with finite derivatives where those of a root among its factors are infinite.

        Args:
            base: a jet or a constant.
            exponent: a multiple of 1/2.
        """
        a = lifted(base)
        y, first, second = (
            factor * power(a.x, exponent - order, self._base) if factor else 0
            for order, factor in enumerate((1, exponent, exponent * (exponent - 1)))
        )
        return Jet(y, first * a.dx, second * (a.dx * a.dx) + first * a.ddx)

    def function(self, name: str, *x: Scalar) -> Jet:
        """A smooth elementary function of jets.

        Args:
            name: its name in `ir.functions.ARITY`.
            *x: jets or constants; of `atan2` first y, then x.

        Raises:
            ModelError: the function does not have two derivatives everywhere, as `abs`, `sign`, `min` and
                `max`.
        """
        if name == "atan2":
            return self._angle(lifted(x[0]), lifted(x[1]))
        if name not in _DERIVATIVES:
            raise ModelError("", f"{name}(...) cannot prescribe a motion: it is not smooth")
        a = lifted(x[0])
        y = self._base.function(name, a.x)
        first, second = _DERIVATIVES[name](self._base, a.x, y)
        return Jet(y, first * a.dx, second * (a.dx * a.dx) + first * a.ddx)

    def _angle(self, y: Jet, x: Jet) -> Jet:
        """``atan2(y, x)``: its rate is (x ẏ - y ẋ) / (x² + y²)."""
        squared = x.x * x.x + y.x * y.x
        rate = (x.x * y.dx - y.x * x.dx) / squared
        moment = x.x * y.ddx - y.x * x.ddx
        second = (moment - 2 * (rate * (x.x * x.dx + y.x * y.dx))) / squared
        return Jet(self._base.function("atan2", y.x, x.x), rate, second)


def _tan(_: Algebra, x: Scalar, y: Scalar) -> tuple[Scalar, Scalar]:
    first = 1 + y * y
    return first, 2 * (y * first)


def _asin(base: Algebra, x: Scalar, y: Scalar) -> tuple[Scalar, Scalar]:
    first = 1 / base.sqrt(1 - x * x)
    return first, x * first * first * first


def _acos(base: Algebra, x: Scalar, y: Scalar) -> tuple[Scalar, Scalar]:
    first, second = _asin(base, x, y)
    return -first, -second


def _atan(_: Algebra, x: Scalar, y: Scalar) -> tuple[Scalar, Scalar]:
    first = 1 / (1 + x * x)
    return first, -2 * (x * first * first)


def _tanh(_: Algebra, x: Scalar, y: Scalar) -> tuple[Scalar, Scalar]:
    first = 1 - y * y
    return first, -2 * (y * first)


def _sqrt(_: Algebra, x: Scalar, y: Scalar) -> tuple[Scalar, Scalar]:
    first = 1 / (2 * y)
    return first, -first / (2 * x)


_DERIVATIVES: dict[str, Callable[[Algebra, Scalar, Scalar], tuple[Scalar, Scalar]]] = {
    "sin": lambda base, x, y: (base.cos(x), -y),
    "cos": lambda base, x, y: (-base.sin(x), -y),
    "tan": _tan,
    "asin": _asin,
    "acos": _acos,
    "atan": _atan,
    "sinh": lambda base, x, y: (base.function("cosh", x), y),
    "cosh": lambda base, x, y: (base.function("sinh", x), y),
    "tanh": _tanh,
    "exp": lambda base, x, y: (y, y),
    "log": lambda base, x, y: (1 / x, -1 / (x * x)),
    "sqrt": _sqrt,
}
"""First and second derivative of each smooth function, given its argument x and its value y."""


def derivatives(name: str, base: Algebra, x: Scalar, y: Scalar) -> tuple[Scalar, Scalar] | None:
    """First and second derivative of a smooth function of one argument; None for any other function.

    Args:
        name: of the function.
        base: the algebra of x and y.
        x: its argument.
        y: its value at x, which many derivatives reuse.
    """
    found = _DERIVATIVES.get(name)
    return found(base, x, y) if found else None

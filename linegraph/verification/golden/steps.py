"""Complex steps: derivatives of a function that calculates in floats, by calculating in complex numbers.

    f(x + i h d) = f(x) + i h f'(x) d + O(h^2)

With h far below rounding, Im f / h is the derivative along d to the last digit, because nothing is
subtracted [Martins et al. 2003]. A difference quotient would lose half of the digits.
"""

from __future__ import annotations

import cmath
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.components.parameters import valued
from linegraph.errors import ModelError
from linegraph.ir.functions import of_numbers
from linegraph.numeric.reference import Numeric

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.algebra.scalar import Scalar

STEP = 2.0**-100
"""The step h; a power of two, so that multiplying and dividing by it is exact."""


class Complexes:
    """Complex numbers as an algebra: real functions, continued analytically.

    Args:
        arguments: the numbers of each argument, by name.

    Example:
        >>> Complexes().sin(0.5 + 1j * STEP).imag / STEP == cmath.cos(0.5).real
        True
    """

    def __init__(self, **arguments: Scalar) -> None:
        """Keep the numbers that `symbol` looks up."""
        self.arguments = arguments

    def symbol(self, argument: str, place: int | str | None = None) -> Scalar:
        """Look up the number given for a symbol.

        Args:
            argument: name of the argument, such as ``q``.
            place: index or name within it; None for an argument that is one number.
        """
        given = self.arguments[argument]
        return given if place is None else given[place]

    def sin(self, x: Scalar) -> Scalar:
        """Return the sine of x (rad)."""
        return self.function("sin", x)

    def cos(self, x: Scalar) -> Scalar:
        """Return the cosine of x (rad)."""
        return self.function("cos", x)

    def sqrt(self, x: Scalar) -> Scalar:
        """Return the square root of x; see `function` for zero."""
        return self.function("sqrt", x)

    def root(self, x: Scalar) -> Scalar:
        """Return the square root where it stands alone, and refuse an infinite slope at zero.

        The square root of `function` may be a factor of a product that has a finite slope there.
        """
        return self.power(x, Fraction(1, 2))

    def power(self, base: Scalar, exponent: Fraction) -> Scalar:
        """Return a half-integer power of a number >= 0.

        It is computed from the root as a whole, since its derivative may be finite where the root's is not.

        Args:
            base: a real or complex number.
            exponent: a multiple of 1/2.

        Raises:
            ModelError: the power or its derivative is not finite.
        """
        z, count = complex(base), int(2 * exponent)
        root = of_numbers("sqrt", z.real)
        # With n twice the exponent, the derivative n / 2 root^(n - 2) is finite at zero from n = 2 on.
        least = 2 if z.imag else 0
        if root == 0 and count < least:
            raise ModelError(
                "", f"0**{exponent} has no finite {'derivative' if z.imag else 'value'}"
            )
        slope = count / 2 * root ** (count - 2) if z.imag else 0.0
        return complex(root**count, slope * z.imag) if isinstance(base, complex) else root**count

    def function(self, name: str, *x: Scalar) -> Scalar:
        """Return any function of `functions.ARITY`; at a kink its derivative from one side.

        abs has the slope of positive numbers at 0; min and max of equal numbers have that of the first
        complex one.

        Args:
            name: the function's name.
            x: its arguments.

        Raises:
            ModelError: the function or its derivative is not finite there.
        """
        if not any(isinstance(part, complex) for part in x):
            return of_numbers(name, *x)
        z = [complex(part) for part in x]
        # The real part is that of the other routes; cmath may differ from it in the last digit.
        real = of_numbers(name, *(part.real for part in z))
        if name in _OWN:
            return _OWN[name](*(x if name in ("min", "max") else z))
        if z[0].imag and abs(z[0].real) == _STEEP.get(name):
            raise ModelError("", f"{name}({z[0].real}) has no finite derivative")
        try:
            return complex(real, getattr(cmath, name)(*z).imag)
        except (ValueError, OverflowError):
            raise ModelError("", f"{name}({z[0].real}) has no finite derivative") from None


def _larger(a: Scalar, b: Scalar) -> complex:
    first, second = complex(a), complex(b)
    if first.real == second.real:
        return first if isinstance(a, complex) else second
    return first if first.real > second.real else second


def _angle(y: complex, x: complex) -> complex:
    squared = x.real * x.real + y.real * y.real
    turned = (x.real * y.imag - y.real * x.imag) / squared
    return complex(cmath.phase(complex(x.real, y.real)), turned)


_OWN: dict[str, Callable[..., complex]] = {
    "abs": lambda x: x if x.real >= 0 else -x,
    "sign": lambda x: complex((x.real > 0) - (x.real < 0)),
    "min": lambda a, b: -_larger(-a, -b),
    "max": _larger,
    "atan2": _angle,
}
"""Functions that `cmath` does not continue analytically."""

_STEEP = {"asin": 1.0, "acos": 1.0}
"""Magnitude of the argument at which a slope is infinite.

A complex step would return a large number there.
"""


class Beside(NamedTuple):
    """A complex state beside the real one; entries that are None are as there.

    Attributes:
        q: nq coordinates.
        v: n velocities.
        u: nu inputs.
        t: the time (s).
        parameters: values in place of the model's; parameters derived from them follow.
    """

    q: Sequence[Scalar]
    v: Sequence[Scalar]
    u: Sequence[Scalar] | None = None
    t: Scalar | None = None
    parameters: Mapping[str, Scalar] | None = None


def stepped(numeric: Numeric, beside: Beside, *, held: bool = False) -> Numeric:
    """Numeric reference at a complex state, for complex inputs, time and parameters.

    Args:
        numeric: the model in floats, at the real state's time and inputs.
        beside: the other state.
        held: whether unknowns of algebraic loops keep their values at the real state.

    Returns:
        The model over `Complexes`.
    """
    q, v, u, t, parameters = beside
    given = numeric.algebra.arguments
    tree, values = numeric.tree, numeric.parameters
    algebra: Any = Complexes(
        t=given["t"] if t is None else t, u=given["u"] if u is None else list(u)
    )
    derivation = numeric.derivation
    assert derivation is not None
    if u is not None or t is not None or parameters is not None:
        known = {**numeric.parameters, **(parameters or {})}
        model = derivation.system
        values = valued(model.parameters.values(), algebra, lambda p: known[p.name])
        tree = derivation.tree(algebra, values)
    tree = replace(tree, algebra=algebra, parameters=values)
    found = Numeric(tree, derivation)
    if tree.network is None or not tree.network.loop:
        return found
    algebra = Complexes(**algebra.arguments, loop=_loop(numeric, found, q, v, held=held))
    return Numeric(replace(tree, algebra=algebra), derivation)


def _loop(
    numeric: Numeric, beside: Numeric, q: Sequence[Scalar], v: Sequence[Scalar], *, held: bool
) -> list[complex]:
    """Unknowns of an algebraic loop at the complex state: one Newton step, or none if held."""
    import numpy as np

    at = numeric.exchange([x.real for x in q], [x.real for x in v])
    assert at is not None
    if held:
        return [complex(x) for x in at.solved]
    network = at.network
    x = np.array(at.solved)
    moved: Any = Complexes(**beside.algebra.arguments, loop=list(at.solved))
    near = Numeric(replace(beside.tree, algebra=moved)).exchange(q, v)
    assert near is not None
    slopes = np.array([[float(at.still(e)) for e in row] for row in network.loop_jacobian])
    gap = np.array([complex(near.still(r)).imag for r in network.loop])
    return [complex(a, b) for a, b in zip(x, -np.linalg.solve(slopes, gap), strict=True)]

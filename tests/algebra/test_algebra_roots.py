"""Products that are half-integer powers: what is found is worth what was given."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from support.plain_values import PRECISE, precise, value

from linegraph.algebra.roots import Roots
from linegraph.ir.dag import Dag

DAG = Dag()
X, Y, Z = (DAG.symbol(name) for name in "xyz")
ROOT = DAG.sqrt
AT = {("x", None): 1.7, ("y", None): 2.3, ("z", None): 0.6}


@pytest.mark.parametrize(
    ("product", "base", "exponent"),
    [
        (X * ROOT(X), X, Fraction(3, 2)),
        (3 * X * Y * ROOT(X), X, Fraction(3, 2)),
        (X * X * ROOT(X) * X, X, Fraction(7, 2)),
        (ROOT(X) * ROOT(X), X, Fraction(1)),
        (ROOT(4 * X) * X, X, Fraction(3, 2)),
        ((X + Y) * ROOT(X + Y) / Z, X + Y, Fraction(3, 2)),
        ((X * ROOT(X) / Y) * Z, X, Fraction(3, 2)),
        (X * ROOT(X) * ROOT(Y), X, Fraction(3, 2)),
        (-(X * ROOT(X)) * Y, X, Fraction(3, 2)),
    ],
)
def test_a_root_meets_its_base(product: Any, base: Any, exponent: Fraction) -> None:
    node = product.a if product.op in ("neg", "div") else product
    found = Roots(DAG).power_in(node)
    assert found is not None
    assert found.base is base
    assert found.exponent == exponent
    power = precise(value(found.base, AT)) ** (
        PRECISE.mpf(exponent.numerator) / exponent.denominator
    )
    whole = power * precise(value(found.rest, AT))
    assert float(whole) == pytest.approx(float(value(node, AT)), rel=1e-14)


def test_a_root_of_what_is_negative_has_its_sign_in_the_base() -> None:
    """Of x sqrt(-x) the base is -x, and x is -(-x)."""
    found = Roots(DAG).power_in(X * ROOT(-X))
    assert found is not None
    at = {("x", None): -4}
    assert value(found.base, at) == 4
    assert found.exponent == Fraction(3, 2)
    assert value(found.rest, at) == -1


@pytest.mark.parametrize(
    "node", [X * Y, X * ROOT(Y), ROOT(X), X + ROOT(X), X * ROOT(X + Y), ROOT(X) / X, 3 * ROOT(X)]
)
def test_a_root_without_its_base_stays_one(node: Any) -> None:
    assert Roots(DAG).power_in(node) is None

"""Rings of polynomials and sympy: into the ring by its algebra, and back by a walk of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import sympy

from linegraph.algebra.sympy_scalars import evaluate

if TYPE_CHECKING:
    from linegraph.symbolic.simplification.polynomial import Poly, Ring

x, y, z = sympy.symbols("x y z")
m, k, l = sympy.symbols("m k l")  # noqa: E741
u, w = sympy.symbols("u w")

PLACES = {
    **{s: ("q", n) for n, s in enumerate((x, y, z))},
    **{s: ("p", s.name) for s in (m, k, l)},
    **{s: ("v", n) for n, s in enumerate((u, w))},
}
"""Coordinates, parameters and rates, by the symbols they are written as."""

SYMBOLS = {place: s for s, place in PLACES.items()}
POINT = {s: sympy.Rational(20 + 17 * n, 61) for n, s in enumerate(PLACES)}


def polynomial(ring: Ring, e: Any) -> Poly:
    """An expression as a polynomial of a ring."""
    names = {s.name: ring.symbol(*place) for s, place in PLACES.items()}
    return ring.poly(evaluate(e, ring, names))


def expression(ring: Ring, terms: dict[int, Any]) -> Any:
    """Terms of a ring as a sum."""
    total = sympy.Integer(0)
    for term, factor in terms.items():
        product = sympy.sympify(factor)
        for place, exponent in ring.exponents(term):
            product *= _generator(ring, *ring.generators[place]) ** exponent
        total += product
    return total


def _generator(ring: Ring, kind: str, content: Any) -> Any:
    if kind == "symbol":
        return SYMBOLS[content]
    if kind in ("sin", "cos"):
        angle = sum(n * expression(ring, dict(ring.angles[a])) for a, n in content)
        return getattr(sympy, kind)(angle)
    if kind == "function":
        name, given = content
        name = {"abs": "Abs", "min": "Min", "max": "Max"}.get(name, name)
        return getattr(sympy, name)(*(expression(ring, dict(part)) for part in given))
    inner = expression(ring, dict(content))
    return sympy.sqrt(inner) if kind == "root" else 1 / inner


def same(a: Any, b: Any) -> bool:
    """Whether two expressions are worth the same at a point, to thirty digits."""
    a, b = (sympy.N(sympy.sympify(e).xreplace(POINT), 40) for e in (a, b))
    return bool(abs(a - b) <= 1e-30 * (1 + abs(b)))

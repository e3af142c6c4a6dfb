"""Polynomials of a ring as SymPy polynomials in all generators, where common factors are found.

Quotients are multiplied by their denominators on the way there; relations between generators are
applied on the way back.
"""

from __future__ import annotations

import random
from fractions import Fraction
from functools import reduce
from math import lcm
from typing import TYPE_CHECKING, Any

import sympy
from sympy.polys.rings import PolyRing

from linegraph.symbolic.simplification.generators import INVERSE, unit
from linegraph.symbolic.simplification.numbers import Terms, gather
from linegraph.symbolic.simplification.polynomial import Poly, Ring

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

Element: Any = Any
"""A SymPy polynomial over the integers."""

PRIME = 2**61 - 1


class Space:
    """The SymPy polynomials in all generators of some polynomials of a ring.

    Args:
        ring: of the polynomials.
        given: the polynomials.
    """

    def __init__(self, ring: Ring, given: Iterable[Poly]) -> None:
        """Find the generators, including those in denominators."""
        self._ring = ring
        places: set[int] = set()
        pending = [term for x in given for term in x.terms]
        seen: set[int] = set()
        while pending:
            for place, _ in ring.exponents(pending.pop()):
                if place in seen:
                    continue
                seen.add(place)
                kind, content = ring.generators[place]
                if kind == INVERSE:
                    pending += [term for term, _ in content]
                else:
                    places.add(place)
        self._places = sorted(places)
        self._index = {place: n for n, place in enumerate(self._places)}
        symbols = [sympy.Symbol(f"g{place}") for place in self._places]
        self._poly = PolyRing(symbols, sympy.ZZ)
        self._inverses: dict[int, tuple[Element, Element]] = {}

    @property
    def zero(self) -> Element:
        """The zero polynomial of the space."""
        return self._poly.zero

    def cleared(self, row: Sequence[Poly]) -> list[Element]:
        """A row times the factor that makes its entries polynomials with integer coefficients."""
        need: dict[tuple[int, bool], int] = {}
        for x in row:
            for term in x.terms:
                for place, exponent in self._ring.exponents(term):
                    inverse = self._ring.generators[place].kind == INVERSE
                    if exponent < 0 or inverse:
                        key = (place, exponent < 0)
                        need[key] = max(need.get(key, 0), abs(exponent))
        exact = [{t: _exact(k) for t, k in x.terms.items()} for x in row]
        scale = lcm(*(k.denominator for terms in exact for k in terms.values()))
        return [self._element(terms, need, scale) for terms in exact]

    def _element(
        self, terms: dict[int, Fraction], need: dict[tuple[int, bool], int], scale: int
    ) -> Element:
        groups: dict[tuple[tuple[int, int], ...], dict[tuple[int, ...], int]] = {}
        for term, k in terms.items():
            exponents = dict(self._ring.exponents(term))
            inverses = []
            for (place, negative), most in need.items():
                kind = self._ring.generators[place].kind
                if kind != INVERSE:
                    exponents[place] = exponents.get(place, 0) + most
                elif not negative or (place, False) not in need:
                    inverses.append((place, exponents.pop(place, 0)))
            monomial = [0] * len(self._places)
            for place, exponent in exponents.items():
                monomial[self._index[place]] = exponent
            group = groups.setdefault(tuple(inverses), {})
            group[tuple(monomial)] = int(k * scale)
        return sum((self._times(*pair, need) for pair in groups.items()), self._poly.zero)

    def _times(
        self,
        inverses: tuple[tuple[int, int], ...],
        group: dict[tuple[int, ...], int],
        need: dict[tuple[int, bool], int],
    ) -> Element:
        """Terms with the same inverses, times the remaining denominators."""
        found = self._poly.from_dict(group)
        for place, exponent in inverses:
            above, below = self._inverse(place)
            up, down = need.get((place, False), 0), need.get((place, True), 0)
            # inverse = above / below: a power of it multiplies by one and divides by the other
            for factor, power in ((below, up - exponent), (above, down + exponent)):
                if power and factor != 1:
                    times = factor**power
                    self._ring.spend(len(found) * len(times))
                    found = found * times
        return found

    def _inverse(self, place: int) -> tuple[Element, Element]:
        """Numerator and denominator of an inverse."""
        if place not in self._inverses:
            inner = Poly(self._ring, dict(self._ring.generators[place].content))
            below, above = self.cleared([inner, self._ring.poly(1)])
            self._inverses[place] = (above, below)
        return self._inverses[place]

    def cancelled(self, above: Element, below: Element) -> tuple[Element, Element]:
        """Numerator and denominator without their common factor.

        Args:
            above: the numerator.
            below: the denominator.
        """
        domain = self._poly.domain
        numbers = reduce(domain.gcd, [*above.values(), *below.values()])
        least = [min(exponents) for exponents in zip(*above, *below, strict=True)]
        above, below = (
            self._poly.from_dict(
                {
                    tuple(e - low for e, low in zip(monomial, least, strict=True)): k // numbers
                    for monomial, k in x.items()
                }
            )
            for x in (above, below)
        )
        if len(below) == 1 or coprime(above, below):
            return above, below
        self._ring.spend(len(above) * len(below))
        _, above, below = above.cofactors(below)
        return above, below

    def terms(self, x: Element) -> tuple[Terms, bool]:
        """The terms in the ring, and whether relations between generators changed them."""
        found: Terms = {}
        changed = False
        for monomial, k in x.items():
            term = sum(unit(p, e) for p, e in zip(self._places, monomial, strict=True) if e)
            for other, factor in self._ring.reduced(term).items():
                changed = changed or other != term
                gather(found, other, factor * int(k))
        return found, changed


def coprime(a: Element, b: Element) -> bool:
    """Whether two polynomials have no common factor with a variable; True is certain.

    If all variables but one get values, a common factor remains one unless its leading coefficient
    vanishes. So it is looked for in one variable at a time, modulo a prime; a full gcd in all variables
    is far slower.

    Args:
        a: a SymPy polynomial.
        b: another one of the same space.
    """
    draw = random.Random(0)
    places = [draw.randrange(2, PRIME) for _ in a.ring.gens]
    for n, (e, f) in enumerate(zip(a.degrees(), b.degrees(), strict=True)):
        if not (e and f):
            continue
        images = [_image(x, n, places) for x in (a, b)]
        if len(images[0]) <= e or _common_degree(*images):
            return False
    return True


def _image(x: Element, kept: int, places: Sequence[int]) -> list[int]:
    """The coefficients of the powers of one variable, modulo a prime; the highest is non-zero."""
    found = [0] * (x.degrees()[kept] + 1)
    for monomial, k in x.items():
        value = int(k)
        for n, exponent in enumerate(monomial):
            if exponent and n != kept:
                value = (
                    value
                    * (places[n] if exponent == 1 else pow(places[n], exponent, PRIME))
                    % PRIME
                )
        found[monomial[kept]] = (found[monomial[kept]] + value) % PRIME
    return _trimmed(found)


def _common_degree(a: list[int], b: list[int]) -> int:
    """The degree of the greatest common factor of two polynomials modulo a prime."""
    while b:
        inverse = pow(b[-1], -1, PRIME)
        rest = list(a)
        while len(rest) >= len(b):
            factor = rest[-1] * inverse % PRIME
            shift = len(rest) - len(b)
            for n, k in enumerate(b):
                rest[shift + n] = (rest[shift + n] - factor * k) % PRIME
            rest = _trimmed(rest)
        a, b = b, rest
    return len(a) - 1


def _trimmed(coefficients: list[int]) -> list[int]:
    while coefficients and not coefficients[-1]:
        coefficients.pop()
    return coefficients


def _exact(k: Any) -> Fraction:
    """A coefficient as a fraction; a float as its decimal representation."""
    return Fraction(repr(k)) if isinstance(k, float) else Fraction(k)

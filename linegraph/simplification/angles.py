"""The trigonometric forms of a polynomial: squares and products of sines put together, angles chosen anew.

A polynomial comes with sines and cosines of single angles, no cosine squared. What people write instead is
found by rules that each replace two terms by one, m being the rest of both:

    m - m sin^2 a            = m cos^2 a            m - 2 m sin^2 a           = m cos 2a
    m cos a cos b - m sin a sin b = m cos(a + b)    m sin a cos b + m cos a sin b = m sin(a + b)

and the like with a - b; a product sin a cos a is half of sin 2a. Other angles, a + b in place of b, may
leave fewer terms: those of parallel axes do.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from linegraph.simplification.polynomial import (
    COS,
    SIN,
    Harmonic,
    Poly,
    Ring,
    Terms,
    gather,
    plain,
    unit,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph.expression import Number

EQUAL = 1e-12
"""Coefficients that are floats are equal if they differ by less than this, relatively."""

MOST_TERMS = 4000
"""Of polynomials with more terms other angles are not tried."""


def merged(ring: Ring, terms: Terms, *, doubled: bool = True) -> Terms:
    """Terms put together until no rule applies.

    Args:
        ring: of the terms.
        terms: with sines and cosines of angles.
        doubled: whether double angles may arise from one angle.
    """
    found = dict(terms)
    count = len(found) + 1
    while len(found) < count:
        count = len(found)
        waves = _waves(ring, found)
        for harmonic in waves:
            _complements(ring, found, harmonic)
        for i, a in enumerate(waves):
            for b in waves[i + 1 :]:
                _sums(ring, found, a, b)
    if doubled:
        for harmonic in _waves(ring, found):
            _doubled(ring, found, harmonic)
    return found


def fewest(ring: Ring, terms: Terms) -> Terms:
    """The same in the angles that leave fewest terms, put together."""
    best = merged(ring, terms)
    present = dict(terms)
    while len(best) > 2 and len(present) < MOST_TERMS:
        waves = _waves(ring, present)
        tried = []
        for a in waves:
            for b in waves:
                if a != b:
                    tried += [_exchanged(ring, present, a, b, sign) for sign in (1, -1)]
        results = [(len(together := merged(ring, t)), n, t, together) for n, t in enumerate(tried)]
        if not results or min(results[:])[0] >= len(best):
            break
        _, _, present, best = min(results, key=lambda r: (r[0], r[1]))
    return best


def harmonic_sum(a: Harmonic, b: Harmonic, sign: int = 1) -> Harmonic:
    """The harmonic of a + b or a - b."""
    found = dict(a)
    for angle, times in b:
        found[angle] = found.get(angle, 0) + sign * times
    return tuple(sorted((angle, times) for angle, times in found.items() if times))


def _waves(ring: Ring, terms: Terms) -> list[Harmonic]:
    """The angles whose sines or cosines stand in terms, in order of the ring."""
    present = dict.fromkeys(place for term in terms for place, _ in ring.exponents(term))
    found = {
        ring.generators[place].content: None
        for place in sorted(present)
        if ring.generators[place].kind in (SIN, COS)
    }
    return list(found)


def _pair(ring: Ring, harmonic: Harmonic) -> tuple[int, int]:
    """The terms of an angle's sine and cosine."""
    return unit(ring.generator(SIN, harmonic)), unit(ring.generator(COS, harmonic))


def _signed(ring: Ring, kind: str, harmonic: Harmonic) -> tuple[Number, int]:
    """The term of a sine or cosine of any harmonic, its first angle made positive, and the sign."""
    if not harmonic:
        return (1, 0) if kind == COS else (0, 0)
    if harmonic[0][1] > 0:
        return 1, unit(ring.generator(kind, harmonic))
    turned = tuple((angle, -times) for angle, times in harmonic)
    return (1 if kind == COS else -1), unit(ring.generator(kind, turned))


def _same(a: Number, b: Number) -> bool:
    if isinstance(a, float) or isinstance(b, float):
        return abs(float(a - b)) <= EQUAL * abs(float(a))
    return a == b


def _having(ring: Ring, terms: Terms, place: int, least: int) -> Iterator[int]:
    """The terms in which a generator stands at least so often, as they are now."""
    for term in list(terms):
        if term in terms and ring.exponent(term, place) >= least:
            yield term


def _complements(ring: Ring, terms: Terms, harmonic: Harmonic) -> None:
    """``1 - sin^2`` and ``1 - 2 sin^2``."""
    sine, cosine = _pair(ring, harmonic)
    place = ring.generator(SIN, harmonic)
    for term in _having(ring, terms, place, 2):
        rest = term - 2 * sine
        k, other = terms[term], terms.get(rest)
        if other is None:
            continue
        if _same(k, -other):
            factor: Number = other
            new = rest + 2 * cosine
        elif _same(k, -2 * other):
            factor, new = other, rest + unit(ring.generator(COS, harmonic_sum(harmonic, harmonic)))
        else:
            continue
        del terms[term], terms[rest]
        gather(terms, new, factor)


def _sums(ring: Ring, terms: Terms, a: Harmonic, b: Harmonic) -> None:
    """Products of sines and cosines of two angles that are one of their sum or difference."""
    (sin_a, cos_a), (sin_b, cos_b) = _pair(ring, a), _pair(ring, b)
    for kind, first, second in (
        (COS, cos_a + cos_b, sin_a + sin_b),
        (SIN, sin_a + cos_b, cos_a + sin_b),
    ):
        places = [place for place, _ in ring.exponents(first)]
        for term in _having(ring, terms, places[0], 1):
            if ring.exponent(term, places[1]) < 1:
                continue
            other = term - first + second
            if other not in terms:
                continue
            k, j = terms[term], terms[other]
            if _same(k, j):
                sign = -1 if kind == COS else 1
            elif _same(k, -j):
                sign = 1 if kind == COS else -1
            else:
                continue
            factor, wave = _signed(ring, kind, harmonic_sum(a, b, sign))
            del terms[term], terms[other]
            gather(terms, term - first + wave, k * factor)


def _doubled(ring: Ring, terms: Terms, harmonic: Harmonic) -> None:
    """``sin a cos a`` as ``sin(2a)/2``."""
    sine, cosine = _pair(ring, harmonic)
    place, other = ring.generator(SIN, harmonic), ring.generator(COS, harmonic)
    for term in _having(ring, terms, place, 1):
        if ring.exponent(term, place) == 1 and ring.exponent(term, other) == 1:
            k = terms.pop(term)
            double = unit(ring.generator(SIN, harmonic_sum(harmonic, harmonic)))
            gather(terms, term - sine - cosine + double, plain(k * Fraction(1, 2)))


def _exchanged(ring: Ring, terms: Terms, a: Harmonic, b: Harmonic, sign: int) -> Terms:
    """Terms with angle b replaced by ``(b + sign a) - sign a``."""
    new = harmonic_sum(b, a, sign)
    if not new or new[0][1] < 0:
        return terms
    sin_b, cos_b = ring.generator(SIN, b), ring.generator(COS, b)
    s_a, c_a = ring.power(SIN, a), ring.power(COS, a)
    s_n, c_n = ring.power(SIN, new), ring.power(COS, new)
    sine = s_n * c_a - sign * (c_n * s_a)
    cosine = c_n * c_a + sign * (s_n * s_a)
    powers: dict[tuple[int, int], Poly] = {}
    found: Terms = {}
    for term, k in terms.items():
        i, j = ring.exponent(term, sin_b), ring.exponent(term, cos_b)
        if i < 0 or j < 0:
            return terms
        if (i, j) not in powers:
            powers[i, j] = sine**i * cosine**j
        rest = term - unit(sin_b, i) - unit(cos_b, j)
        for part, factor in ring.product({rest: k}, powers[i, j].terms).items():
            gather(found, part, factor)
    return found

"""The trigonometric forms of a polynomial: squares and products of sines collected, angles chosen anew.

A polynomial comes with sines and cosines of single angles, and without squares of cosines. The usual
forms are found by rules that each replace two terms by one, m being the common rest:

    m - m sin^2 a            = m cos^2 a            m - 2 m sin^2 a           = m cos 2a
    m cos a cos b - m sin a sin b = m cos(a + b)    m sin a cos b + m cos a sin b = m sin(a + b)

and the like with a - b; a product sin a cos a is half of sin 2a. Other angles, such as a + b instead of
b, may leave fewer terms: those of parallel axes do.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from linegraph.symbolic.simplification.generators import COS, SIN, Harmonic, unit
from linegraph.symbolic.simplification.numbers import Terms, gather, plain

if TYPE_CHECKING:
    from linegraph.ir.dag import Number
    from linegraph.symbolic.simplification.polynomial import Poly, Ring

EQUAL = 1e-12
"""Relative difference below which two floats are equal coefficients."""

SEARCH = 10_000
"""The work on terms that the search for other angles may take."""


def merged(ring: Ring, terms: Terms, *, doubled: bool = True) -> Terms:
    """Collect terms until no rule applies.

    Args:
        ring: of the terms.
        terms: with sines and cosines of angles.
        doubled: whether double angles may be formed from one angle.
    """
    found = dict(terms)
    _put_together(ring, found)
    if doubled and sum(_doubled(ring, found, term) for term in list(found)):
        _put_together(ring, found)
    return found


def _put_together(ring: Ring, terms: Terms) -> None:
    """Apply the rules that reduce the number of terms until none does."""
    count = len(terms) + 1
    while len(terms) < count:
        count = len(terms)
        ring.spend(count)
        for rule in (_complement, _sum):
            for term in list(terms):
                if term in terms:
                    rule(ring, terms, term)


def fewest(ring: Ring, terms: Terms) -> Terms:
    """The terms in the angles that leave fewest of them, collected.

    Args:
        ring: of the terms.
        terms: with sines and cosines of angles.
    """
    best = merged(ring, terms)
    present = dict(terms)
    end = ring.work + SEARCH
    while len(best) > 2 and ring.work < end:
        waves = _waves(ring, present)
        tried = []
        for a in waves:
            for b in waves:
                if a != b and ring.work < end:
                    tried += [_exchanged(ring, present, a, b, sign) for sign in (1, -1)]
        results = [(len(together := merged(ring, t)), n, t, together) for n, t in enumerate(tried)]
        if not results or min(results[:])[0] >= len(best):
            break
        _, _, present, best = min(results, key=lambda r: (r[0], r[1]))
    return best


def spread(ring: Ring, terms: Terms) -> Terms:
    """Products of sines and cosines written as sums: each term has one sine or cosine at most.

    Args:
        ring: of the terms.
        terms: with sines and cosines of angles; returned unchanged if one is in a denominator.
    """
    found: Terms = {}
    for term, k in terms.items():
        waves = _of_waves(ring, term)
        rest = term - sum(unit(ring.generator(kind, a), e) for kind, a, e in waves)
        parts: dict[tuple[str, Harmonic], Number] = {(COS, ()): k}
        for kind, a, exponent in waves:
            if exponent < 0:
                return terms
            for _ in range(exponent):
                parts = _times(parts, kind, a)
        ring.spend(len(parts))
        for (kind, a), factor in parts.items():
            sign, wave = _signed(ring, kind, a)
            gather(found, rest + wave, plain(factor * sign))
    return found


def _times(
    parts: dict[tuple[str, Harmonic], Number], kind: str, a: Harmonic
) -> dict[tuple[str, Harmonic], Number]:
    """A sum of sines and cosines times another one, by 2 sin b cos a = sin(b + a) + sin(b - a) etc."""
    found: dict[tuple[str, Harmonic], Number] = {}
    for (own, b), k in parts.items():
        new = COS if own == kind else SIN
        # signs of sum, difference: cos cos (+, +), sin sin (-, +), sin b cos a (+, +), cos b sin a (+, -)
        signs = (
            (-1, 1) if (own, kind) == (SIN, SIN) else (1, -1 if (own, kind) == (COS, SIN) else 1)
        )
        for sign, direction in zip(signs, (1, -1), strict=True):
            key = (new, harmonic_sum(b, a, direction))
            found[key] = found.get(key, 0) + k * Fraction(sign, 2)
    return found


def harmonic_sum(a: Harmonic, b: Harmonic, sign: int = 1) -> Harmonic:
    """The harmonic of a + b, or of a - b.

    Args:
        a: the first sum of angles.
        b: the second one.
        sign: 1 to add it, -1 to subtract it.
    """
    found = dict(a)
    for angle, times in b:
        found[angle] = found.get(angle, 0) + sign * times
    return tuple(sorted((angle, times) for angle, times in found.items() if times))


def _waves(ring: Ring, terms: Terms) -> list[Harmonic]:
    """The angles whose sines or cosines occur in terms, in the order of the ring."""
    present = dict.fromkeys(place for term in terms for place, _ in ring.exponents(term))
    found = {
        ring.generators[place].content: None
        for place in sorted(present)
        if ring.generators[place].kind in (SIN, COS)
    }
    return list(found)


def _pair(ring: Ring, harmonic: Harmonic) -> tuple[int, int]:
    """The terms of an angle's sine and cosine."""
    found = ring.waves.get(harmonic)
    if found is None:
        found = unit(ring.generator(SIN, harmonic)), unit(ring.generator(COS, harmonic))
        ring.waves[harmonic] = found
    return found


def _signed(ring: Ring, kind: str, harmonic: Harmonic) -> tuple[Number, int]:
    """Sign and term of a sine or cosine of any harmonic, with the first angle made positive."""
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


def _of_waves(ring: Ring, term: int) -> list[tuple[str, Harmonic, int]]:
    """The sines and cosines in a term: kind, angle and exponent."""
    return [
        (kind, content, exponent)
        for place, exponent in ring.exponents(term)
        for kind, content in (ring.generators[place],)
        if kind in (SIN, COS)
    ]


def _complement(ring: Ring, terms: Terms, term: int) -> None:
    """Collect ``1 - sin^2`` or ``1 - 2 sin^2``, if a term contains the square."""
    for kind, harmonic, exponent in _of_waves(ring, term):
        if kind == COS or exponent < 2:
            continue
        sine, cosine = _pair(ring, harmonic)
        rest = term - 2 * sine
        k, other = terms[term], terms.get(rest)
        if other is None:
            continue
        if _same(k, -other):
            new = rest + 2 * cosine
        elif _same(k, -2 * other):
            new = rest + unit(ring.generator(COS, harmonic_sum(harmonic, harmonic)))
        else:
            continue
        del terms[term], terms[rest]
        gather(terms, new, other)
        return


def _sum(ring: Ring, terms: Terms, term: int) -> None:
    """Collect two products of sines and cosines that make one of the sum or difference of their angles."""
    waves = [wave for wave in _of_waves(ring, term) if wave[2] > 0]
    for kind_a, a, _ in waves:
        for kind_b, b, _ in waves:
            if a == b or kind_a == SIN:
                continue
            # cos a cos b with sin a sin b, cos a sin b with sin a cos b
            (sin_a, cos_a), (sin_b, cos_b) = _pair(ring, a), _pair(ring, b)
            own, turned = (cos_b, sin_b) if kind_b == COS else (sin_b, cos_b)
            other = term - cos_a - own + sin_a + turned
            if other not in terms:
                continue
            k, j = terms[term], terms[other]
            kind = COS if kind_b == COS else SIN
            if _same(k, j):
                sign = -1 if kind == COS else 1
            elif _same(k, -j):
                sign = 1 if kind == COS else -1
            else:
                continue
            # sin b cos a - cos b sin a = sin(b - a)
            whole = harmonic_sum(b, a, sign) if kind == SIN else harmonic_sum(a, b, sign)
            factor, wave = _signed(ring, kind, whole)
            del terms[term], terms[other]
            gather(terms, term - cos_a - own + wave, k * factor)
            return


def _doubled(ring: Ring, terms: Terms, term: int) -> bool:
    """Write ``sin a cos a`` as ``sin(2a)/2``; whether the term contains it."""
    k, new = terms[term], term
    waves = {(kind, harmonic): exponent for kind, harmonic, exponent in _of_waves(ring, term)}
    for (kind, harmonic), exponent in waves.items():
        if kind == SIN and exponent == 1 and waves.get((COS, harmonic)) == 1:
            sine, cosine = _pair(ring, harmonic)
            double = unit(ring.generator(SIN, harmonic_sum(harmonic, harmonic)))
            k, new = plain(k * Fraction(1, 2)), new - sine - cosine + double
    if new == term:
        return False
    del terms[term]
    gather(terms, new, k)
    return True


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
    ring.spend(len(terms))
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

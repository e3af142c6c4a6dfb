"""Generators and terms, the powers of them; errors for expressions that grow too long.

The exponents of a term are the digits of one integer, so that multiplying terms is adding integers.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from linegraph.symbolic.simplification.numbers import Terms, gather

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.differentiation import Symbol
    from linegraph.ir.dag import Number

Harmonic: TypeAlias = tuple[tuple[int, int], ...]
"""A sum of multiples of angles: pairs (number of the angle, factor), ascending."""

SYMBOL, SIN, COS, ROOT, INVERSE, FUNCTION = "symbol", "sin", "cos", "root", "inverse", "function"

BITS = 16
ZERO_DIGIT = 1 << (BITS - 2)
"""The digit of exponent 0, so that exponents may be negative; their size stays below it."""

Frozen: TypeAlias = "tuple[tuple[int, Number], ...]"
"""The terms of a polynomial, ascending."""


class Swollen(Exception):
    """An expression has more terms than the budget allows; `problem` is the text for messages."""

    problem = "has too many terms"


class TooHigh(Swollen):
    """An exponent is beyond the digits of a term."""

    problem = f"has a power above {ZERO_DIGIT - 1}, too high"


class Generator(NamedTuple):
    """A factor that terms have powers of.

    Attributes:
        kind: SYMBOL, SIN, COS, ROOT, INVERSE or FUNCTION.
        content: a symbol's argument and place, an angle's `Harmonic`, a `Frozen` polynomial, or a
            function's name and arguments.
    """

    kind: str
    content: Any


def unit(place: int, exponent: int = 1) -> int:
    """The term that is a power of one generator.

    Args:
        place: of the generator in the ring.
        exponent: of the power; may be negative.
    """
    return exponent << (BITS * place) if exponent >= 0 else -(-exponent << (BITS * place))


class Generators:
    """A register of generators, and the terms in them.

    Attributes:
        generators: in order of first use.
    """

    def __init__(self) -> None:
        """Start without generators."""
        self.generators: list[Generator] = []
        self._places: dict[Generator, int] = {}
        self._bias = 0
        self._high = 0
        self._watched = 0
        self._squares: list[tuple[int, int, Terms]] = []
        self._exponents: dict[int, tuple[tuple[int, int], ...]] = {}

    def generator(self, kind: str, content: Any) -> int:
        """The place of a generator, which is registered at first use.

        Args:
            kind: see `Generator`.
            content: see `Generator`.
        """
        key = Generator(kind, content)
        if key not in self._places:
            place = self._places[key] = len(self.generators)
            self.generators.append(key)
            shift = BITS * place
            self._bias |= ZERO_DIGIT << shift
            self._high |= 1 << (shift + BITS - 1)
            if kind in (COS, ROOT):
                square: Terms = dict(content) if kind == ROOT else {0: 1}
                if kind == COS:
                    square[unit(self.generator(SIN, content), 2)] = -1
                self.replace_square(place, square)
        return self._places[key]

    def normalise(self, quaternion: Sequence[Symbol]) -> None:
        """Replace w^2 of a unit quaternion (x, y, z, w) by 1 - x^2 - y^2 - z^2 from now on."""
        *others, last = (self.generator(SYMBOL, symbol) for symbol in quaternion)
        square: Terms = {unit(place, 2): -1 for place in others}
        self.replace_square(last, {0: 1} | square)

    def replace_square(self, place: int, square: Terms) -> None:
        """Replace the square of a generator by other terms from now on.

        Args:
            place: of the generator.
            square: the terms.
        """
        shift = BITS * place
        mask = (ZERO_DIGIT - 2) << shift
        self._watched |= mask
        self._squares.append((mask, shift, square))

    def is_wave(self, place: int) -> bool:
        """Whether a generator is a sine or a cosine."""
        return self.generators[place].kind in (SIN, COS)

    def exponents(self, term: int) -> tuple[tuple[int, int], ...]:
        """The generators in a term as pairs (place, exponent)."""
        found = self._exponents.get(term)
        if found is None:
            count = len(self.generators)
            digits = (term + self._bias).to_bytes(BITS // 8 * count, "little")
            found = tuple(
                (place, digit - ZERO_DIGIT)
                for place, digit in enumerate(struct.unpack(f"<{count}H", digits))
                if digit != ZERO_DIGIT
            )
            self._exponents[term] = found
        return found

    def exponent(self, term: int, place: int) -> int:
        """The exponent of one generator in a term.

        Args:
            term: the term.
            place: of the generator.
        """
        digit: int = (term + self._bias) >> (BITS * place) & (2**BITS - 1)
        return digit - ZERO_DIGIT

    def reduced(self, term: int) -> Terms:
        """A term with all squares that have a replacement replaced: of cosines, of roots.

        Raises:
            Swollen: an exponent is too large.
        """
        found: Terms = {}
        pending: list[tuple[int, Number]] = [(term, 1)]
        while pending:
            term, k = pending.pop()
            biased = term + self._bias
            if biased < 0 or biased & self._high:
                raise TooHigh
            for mask, shift, square in self._squares:
                # negative exponents have these bits too, so compare the digit itself
                if biased & mask and (biased >> shift & (2**BITS - 1)) >= ZERO_DIGIT + 2:
                    rest = term - (2 << shift)
                    pending += [(rest + t, k * x) for t, x in square.items()]
                    break
            else:
                gather(found, term, k)
        return found

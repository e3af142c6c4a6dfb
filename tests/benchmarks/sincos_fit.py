"""Where the coefficients of the emitted sine and cosine come from: Remez exchange in 60 digits.

    python tests/benchmarks/sincos_fit.py

Coefficients are rounded to doubles one after the other, from the lowest, and the rest is fitted again.
"""

from __future__ import annotations

from collections.abc import Callable

import mpmath as mp

Function = Callable[[mp.mpf], mp.mpf]
TERMS = 6


def remez(wanted: Function, weight: Function, fixed: list[mp.mpf]) -> list[mp.mpf]:
    """The free coefficients of a polynomial of `TERMS` terms in z = r^2, best for |r| <= pi/4."""
    top = LIMIT**2
    powers = range(len(fixed), TERMS)
    count = len(powers) + 1
    points = [top * (1 - mp.cos(mp.pi * (k + mp.mpf(1) / 2) / count)) / 2 for k in range(count)]
    found: list[mp.mpf] = []
    for _ in range(12):
        system, right = mp.matrix(count, count), mp.matrix(count, 1)
        for i, z in enumerate(points):
            for j, power in enumerate(powers):
                system[i, j] = z**power
            system[i, count - 1] = (-1) ** i / weight(z)
            right[i] = wanted(z) - value(fixed, z)
        found = list(mp.lu_solve(system, right))[:-1]
        grid = [top * k / 600 for k in range(1, 601)]
        errors = [error(wanted, weight, [*fixed, *found], z) for z in grid]
        extremes: list[mp.mpf] = []
        begin = 0
        for k in range(1, len(grid) + 1):
            if k == len(grid) or mp.sign(errors[k]) != mp.sign(errors[begin]):
                largest = max(range(begin, k), key=lambda i: abs(errors[i]))
                extremes.append(grid[largest])
                begin = k
        if len(extremes) != count:
            break
        points = extremes
    return found


def value(coefficients: list[mp.mpf], z: mp.mpf) -> mp.mpf:
    """The polynomial."""
    return sum((c * z**k for k, c in enumerate(coefficients)), mp.mpf(0))


def error(wanted: Function, weight: Function, coefficients: list[mp.mpf], z: mp.mpf) -> mp.mpf:
    """How far sine, relatively, or cosine are off."""
    return (wanted(z) - value(coefficients, z)) * weight(z)


def odd(z: mp.mpf) -> mp.mpf:
    """(sin r / r - 1) / r^2."""
    return (mp.sin(mp.sqrt(z)) / mp.sqrt(z) - 1) / z


def even(z: mp.mpf) -> mp.mpf:
    """(cos r - 1 + r^2 / 2) / r^4."""
    return (mp.cos(mp.sqrt(z)) - 1 + z / 2) / z**2


def main() -> None:
    """Print coefficients, the error in powers of two, and pi/2 in three parts."""
    for name, wanted, weight in (("sine", odd, lambda z: z), ("cosine", even, lambda z: z * z)):
        fixed: list[mp.mpf] = []
        while len(fixed) < TERMS:
            fixed.append(mp.mpf(float(remez(wanted, weight, fixed)[0])))
        grid = [LIMIT**2 * k / 2000 for k in range(1, 2001)]
        worst = max(abs(error(wanted, weight, fixed, z)) for z in grid)
        print(name, mp.nstr(mp.log(worst, 2), 4), *(repr(float(c)) for c in fixed))
    half, parts = mp.pi / 2, []
    for bits in (39, 79):
        parts.append(mp.floor((half - sum(parts)) * mp.mpf(2) ** bits) / mp.mpf(2) ** bits)
    parts.append(half - sum(parts))
    print("pi/2", *(repr(float(part)) for part in parts))


if __name__ == "__main__":
    mp.mp.dps = 60
    LIMIT = mp.pi / 4 * (1 + mp.mpf(2) ** -20)
    main()

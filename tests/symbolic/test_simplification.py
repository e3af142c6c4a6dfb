"""The pass that makes closed forms readable, on expressions of its own kind: never wrong, never longer.

Expressions are drawn tidy, then scrambled as derivations scramble them: multiplied out, sums of angles
written out, turns multiplied with each other. What comes back is the same and no longer than what was drawn.
"""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, Any

import pytest
import sympy
from published.book_forms import books, turned
from support.form_measures import (
    angles,
    operations,
    products_of_angles,
    unmerged,
    value,
    vanishes,
    whole_floats,
)
from sympy import cos, sin

from linegraph.algebra.sympy_scalars import evaluate
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag
from linegraph.symbolic.simplification import Simplifier

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Expr = Any
SEEDS = range(40)
LEVELS = ("none", "fast", "full")
LONGER = 1.2
"""As much longer than it might be a closed form may be."""

WRITTEN_OUT = [book for book in books() if "flux" not in book.name]
"""Not those whose denominators would be multiplied out, too."""
ANGLES = sympy.symbols("q1 q2 q3")
RATES = sympy.symbols("q1_dot q2_dot q3_dot")
PARAMETERS = sympy.symbols("m l c I1 g")


def simplified(expression: Expr, level: str = "full") -> Expr:
    """The one call of the pass: `ANGLES` are positions and `RATES` velocities, all others parameters."""
    dag = Dag()
    kinds = {"q": ANGLES, "v": RATES}
    kinds["p"] = tuple(expression.free_symbols - set(ANGLES) - set(RATES))
    nodes, symbols = {}, {}
    for kind, found in kinds.items():
        for k, symbol in enumerate(sorted(found, key=str)):
            place = symbol.name if kind == "p" else k
            nodes[symbol.name] = dag.symbol(kind, place)
            symbols[kind, place] = symbol
    simplifier = Simplifier(lambda symbol: symbols[symbol], level)
    closed = simplifier(evaluate(expression, dag, nodes))
    assert not simplifier.rejected
    return sympy.sympify(closed, strict=True)


# ---- expressions


def angle(draw: random.Random) -> Expr:
    """An integer combination of angles."""
    while True:
        factors = [draw.choice((0, 0, 1, 1, 1, -1, 2)) for _ in ANGLES]
        total = sum(k * q for k, q in zip(factors, ANGLES, strict=True))
        if total != 0:
            return total


def factor(draw: random.Random) -> Expr:
    """A product of parameters."""
    return sympy.Mul(*(draw.choice(PARAMETERS) for _ in range(draw.randint(1, 3))))


def term(draw: random.Random) -> Expr:
    """A coefficient, perhaps a rate or two, perhaps a sine or a cosine."""
    rates = sympy.Mul(*(draw.choice(RATES) for _ in range(draw.choice((0, 0, 1, 2)))))
    wave = draw.choice((sin, cos))(angle(draw)) if draw.random() < 0.8 else sympy.S.One
    return draw.choice((1, 1, -1, 2, sympy.Rational(1, 2))) * factor(draw) * rates * wave


def tidy(draw: random.Random) -> Expr:
    """A sum of terms, some with a sum as their coefficient."""
    total = sympy.Add(*(term(draw) for _ in range(draw.randint(1, 4))))
    inertia = factor(draw) + factor(draw)
    return total + inertia * term(draw) * draw.choice((0, 1))


def written_out(expression: Expr) -> Expr:
    """Products multiplied out, sums of angles in sines and cosines of single ones."""
    return sympy.expand(sympy.expand_trig(sympy.expand(expression)))


def with_squares(expression: Expr, draw: random.Random) -> Expr:
    """Some terms times sin² + cos² of some angle."""
    terms = sympy.Add.make_args(sympy.expand(expression))
    q = draw.choice(ANGLES)
    return sympy.Add(
        *(
            sympy.expand(t * (sin(q) ** 2 + cos(q) ** 2)) if draw.random() < 0.4 else t
            for t in terms
        )
    )


def scrambled(expression: Expr, draw: random.Random) -> Expr:
    """Both, in the form that they come in."""
    return written_out(with_squares(expression, draw))


# ---- never wrong, never longer


@pytest.mark.one_in(2)
@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("seed", SEEDS)
def test_the_pass_changes_no_value_and_adds_nothing(seed: int, level: str) -> None:
    draw = random.Random(seed)
    whole = scrambled(tidy(draw), draw)
    found = simplified(whole, level)
    assert vanishes(found - whole)
    assert operations(found) <= operations(whole)


@pytest.mark.parametrize("seed", SEEDS)
def test_what_is_tidy_stays_as_short(seed: int) -> None:
    expression = tidy(random.Random(seed))
    assert operations(simplified(expression)) <= LONGER * operations(expression)


@pytest.mark.parametrize("seed", SEEDS)
def test_what_was_scrambled_is_tidy_again(seed: int) -> None:
    draw = random.Random(seed)
    expression = tidy(draw)
    best = min(operations(expression), operations(sympy.expand(expression)))
    found = simplified(scrambled(expression, draw))
    assert operations(found) <= LONGER * max(best, 5), (expression, found)
    assert not unmerged(found)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_pass_is_done_when_it_is_done(seed: int) -> None:
    draw = random.Random(seed)
    found = simplified(scrambled(tidy(draw), draw))
    again = simplified(found)
    assert operations(again) == operations(found)
    assert vanishes(again - found)


@pytest.mark.parametrize("seed", range(20))
def test_the_full_level_is_the_shortest(seed: int) -> None:
    draw = random.Random(seed)
    whole = scrambled(tidy(draw), draw)
    none, fast, full = (operations(simplified(whole, level)) for level in LEVELS)
    assert full <= min(fast, none)
    assert none == operations(whole)


@pytest.mark.parametrize("seed", range(20))
def test_numbers_are_simplified_as_symbols_are(seed: int) -> None:
    """With numbers put in for parameters, the same angles and no more operations."""
    draw = random.Random(seed)
    expression = tidy(draw)
    point = {p: sympy.Float(round(draw.uniform(0.3, 2), 3)) for p in PARAMETERS}
    whole = scrambled(expression, draw)
    named, numbered = simplified(whole), simplified(whole.xreplace(point))
    assert operations(numbered) <= operations(named.xreplace(point).expand())
    assert angles(numbered) <= angles(named)
    assert not whole_floats(numbered)
    for _ in range(3):
        at = {x: draw.uniform(-2, 2) for x in (*ANGLES, *RATES)}
        expected = value(whole, at | {p: float(x) for p, x in point.items()})
        assert abs(float(value(numbered, at) - expected)) < 1e-12 * (1 + abs(float(expected)))


# ---- turns multiplied with each other


def axes(draw: random.Random, count: int) -> list[str]:
    return [draw.choice("xyz") for _ in range(count)]


@pytest.mark.parametrize("axis", "xyz")
@pytest.mark.parametrize("count", [2, 3])
def test_turns_about_one_axis_add_up(axis: str, count: int) -> None:
    R = sympy.eye(3)
    for q in ANGLES[:count]:
        R = R * turned(axis, q)
    expected = turned(axis, sum(ANGLES[:count]))
    for one, other in zip(R.applyfunc(sympy.expand), expected, strict=True):
        assert simplified(one) == other


def test_a_turn_and_back_is_none() -> None:
    R = turned("x", ANGLES[0]) * turned("y", ANGLES[1]) * turned("z", ANGLES[2])
    for one, other in zip(R * R.T, sympy.eye(3), strict=True):
        assert simplified(sympy.expand(one)) == other


@pytest.mark.parametrize("seed", range(15))
def test_inertias_seen_from_other_axes_are_short(seed: int) -> None:
    """R J Rᵀ of principal moments, of two or three turns."""
    draw = random.Random(seed)
    names = axes(draw, draw.choice((2, 3)))
    R = sympy.eye(3)
    for name, q in zip(names, ANGLES, strict=False):
        R = R * turned(name, q)
    J = R * sympy.diag(*sympy.symbols("A B C")) * R.T
    for i, j in ((0, 0), (0, 1), (1, 2)):
        whole = sympy.expand(J[i, j])
        found = simplified(whole)
        assert vanishes(found - whole)
        assert operations(found) <= operations(whole)
        assert not unmerged(found)


@pytest.mark.parametrize("count", [2, 3])
def test_speeds_of_planar_chains_have_differences_of_angles_only(count: int) -> None:
    """The kinetic energy of points at the end of each link, from their coordinates multiplied out."""
    total, x, y = sympy.S.Zero, sympy.S.Zero, sympy.S.Zero
    lengths = sympy.symbols("l1 l2 l3")
    for q, rate, length in zip(ANGLES[:count], RATES, lengths, strict=False):
        x = x + length * cos(q) * rate
        y = y + length * sin(q) * rate
        total = total + x**2 + y**2
    whole = sympy.expand(total)
    found = simplified(whole)
    assert vanishes(found - whole)
    assert not products_of_angles(found)
    pairs = {a - b for a in ANGLES for b in ANGLES}
    assert angles(found) <= pairs


# ---- books' own forms


@pytest.mark.parametrize("book", WRITTEN_OUT, ids=lambda book: book.name)
def test_books_forms_multiplied_out_are_books_forms(book: Any) -> None:
    """Each entry within a fifth of the book's, whatever it looked like before."""
    scrambles: Sequence[Callable[[Expr], Expr]] = (sympy.expand, written_out)
    for entry in (*book.M, *book.h):
        for scramble in scrambles:
            found = simplified(scramble(entry))
            assert vanishes(found - entry)
            assert operations(found) <= LONGER * max(operations(entry), 2), (entry, found)
            assert not unmerged(found)


@pytest.mark.parametrize(
    "expression",
    ["0", "1", "m", "-m", "m/l", "sqrt(m**2 + l**2)", "exp(-q1/l)", "atan2(q1, l)", "Abs(q1)"],
)
def test_small_things_are_left_alone(expression: str) -> None:
    given = sympy.sympify(expression)
    assert simplified(given) == given


def test_what_is_under_a_root_stays_there() -> None:
    """No square of a root is made of what is not known to be positive."""
    m, q = sympy.symbols("m q1")
    for given in (sympy.sqrt(q**2), sympy.sqrt(m**2 * q**2), sympy.sqrt((m - q) ** 2)):
        found = simplified(given)
        for at in ({m: 1.3, q: -0.7}, {m: -1.3, q: 0.7}):
            assert abs(value(found, at) - value(given, at)) < 1e-30


def test_denominators_stay_as_they_were() -> None:
    z, d, L0, L1 = sympy.symbols("z d L0 L1")
    given = L1 / (d * (1 + z / d) ** 2) / (L0 + L1 / (1 + z / d)) ** 2
    found = simplified(given)
    assert operations(found) <= operations(given)
    assert vanishes(found - given)


@pytest.mark.parametrize("level", LEVELS)
def test_high_powers_are_powers(level: str) -> None:
    """The highest power that a model's expressions may have, and products of such powers."""
    m, q = sympy.symbols("m q1")
    for given in (m * q**64, m / q**64, sympy.sin(q) ** 64):
        assert simplified(given, level) == given
    assert vanishes(simplified((q + m) ** 64, level) - (q + m) ** 64)
    simplifier = Simplifier(lambda symbol: q, level)
    x = evaluate(q**64, dag := Dag(), {"q1": dag.symbol("q", 0)})
    assert simplifier(x * x) == q**128
    assert simplifier(1 / (x * x * x)) == q**-192


@pytest.mark.parametrize("power", [20000, -20000])
def test_higher_powers_are_refused_as_that(power: int) -> None:
    dag = Dag()
    x: Any = dag.symbol("q", 0)
    for _ in range(4):  # 20000 = 2 * 10**4
        x = (x * x) * ((x * x) * (x * x)) * (x * x) * (x * x)
    x = x * x if power > 0 else 1 / (x * x)
    simplifier = Simplifier(lambda symbol: ANGLES[0])
    problem = (
        r"^force: has a power above 16383, too high for a closed form; .*level \"none\" writes it"
    )
    with pytest.raises(ModelError, match=problem):
        simplifier(x, "force")


@pytest.mark.parametrize("level", ["fast", "full"])
def test_a_common_number_is_a_factor(level: str) -> None:
    """9.81 (a + b) and not 9.81 a + 9.81 b, among other terms, too."""
    q, p = ANGLES[:2]
    m, length, c = sympy.symbols("m l c")
    cases = {
        9.81 * m * sin(q) + 9.81 * length * sin(p): "9.81*(l*sin(q2) + m*sin(q1))",
        9.81 * m * sin(q) - 9.81 * length * sin(q): "9.81*(-l + m)*sin(q1)",
        c * q + 9.81 * m * sin(p) + 9.81 * sin(q): "c*q1 + 9.81*(m*sin(q2) + sin(q1))",
    }
    for given, expected in cases.items():
        found = simplified(given, level)
        assert str(found) == expected
        at = {symbol: 0.3 + 0.4 * k for k, symbol in enumerate((q, p, m, length, c))}
        assert abs(value(found, at) - value(given, at)) < 1e-12


# ---- the measures themselves


def test_zeros_are_told_from_others() -> None:
    q, p = ANGLES[:2]
    zeros = (
        sin(q) ** 2 + cos(q) ** 2 - 1,
        sin(2 * q) - 2 * sin(q) * cos(q),
        cos(q - p) - cos(q) * cos(p) - sin(q) * sin(p),
        1 / (1 + sin(q) ** 2) - 1 / (2 - cos(q) ** 2),
        sympy.exp(-q / p) ** 2 - sympy.exp(-2 * q / p),
    )
    for zero in zeros:
        assert vanishes(zero)
        assert not vanishes(zero + sin(q - p))
        assert not vanishes(zero + sympy.Rational(1, 10**12))


def test_squares_left_over_are_found() -> None:
    q, p = ANGLES[:2]
    m, length, g = sympy.symbols("m l g")
    assert unmerged(m * sin(q) ** 2 + m * cos(q) ** 2)
    assert unmerged(g * (m * sin(q) ** 2 + length + m * cos(q) ** 2))
    assert unmerged((m + g) * sin(q) ** 2 + (m + length) * cos(q) ** 2)
    assert not unmerged(m * sin(q) ** 2 + g * cos(q) ** 2)
    assert not unmerged(m * sin(q) ** 2 + m * cos(p) ** 2)


def test_products_of_angles_are_found() -> None:
    q, p = ANGLES[:2]
    assert products_of_angles(sin(q) * cos(p))
    assert not products_of_angles(sin(q) * cos(q) + sin(p - q))


@pytest.mark.parametrize("level", LEVELS)
def test_what_is_divided_by_a_float_has_a_float_in_front(level: str) -> None:
    """1/2.4 is no quotient of whole numbers of sixteen digits; a third stays a third."""
    dag = Dag()
    x, y = dag.symbol("q", 0), dag.symbol("q", 1)
    names = {0: sympy.Symbol("x"), 1: sympy.Symbol("y")}
    written = Simplifier(lambda symbol: names[symbol[1]], level)
    found = written(x / 2.4 + y / 3 + (x + y) / 0.0137)
    at = {names[0]: sympy.Rational(7, 8), names[1]: sympy.Rational(-5, 4)}
    assert float(found.subs(at)) == pytest.approx(
        0.875 / 2.4 - 1.25 / 3 + (0.875 - 1.25) / 0.0137, rel=1e-14
    )
    assert all(max(abs(k.p), k.q) < 1e6 for k in found.atoms(sympy.Rational))
    assert written(y / 3) == names[1] / 3

"""Closed forms as books print them: symbol for symbol, and no longer than 1.2 times theirs.

Operations are counted by `form_measures.operations`, of an equation those of its row of M, of h and of Q.
Each equation is measured alone, and the whole system, and so is every entry of M: none may be twice as long.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import pytest
import sympy
from published.book_forms import books, double_pendulum, symbols, top
from support.form_measures import (
    angles,
    operations,
    products_of_angles,
    unmerged,
    vanishes,
)
from sympy.physics import mechanics

import linegraph as lg

if TYPE_CHECKING:
    from linegraph.derivation import Derivation

BOOKS = {book.name: book for book in books()}
EVERY = pytest.mark.parametrize("name", BOOKS)
LONGER = 1.2


@cache
def derived(name: str) -> Derivation:
    return lg.derive(BOOKS[name].model())


@cache
def proven(name: str) -> tuple[Any, Any]:
    return BOOKS[name].proof()


def forms(name: str) -> list[Any]:
    """M, h and Q as linegraph has them."""
    d = derived(name)
    return [d.mass_matrix, d.bias, d.forces]


def printed(name: str) -> list[Any]:
    """M, h and Q as the book has them."""
    book = BOOKS[name]
    return [book.M, book.h, book.forces]


def counted(parts: list[Any]) -> list[int]:
    """Operations of each equation."""
    M, h, Q = parts
    return [operations(M[i, :], h[i], Q[i]) for i in range(len(h))]


def table(name: str) -> str:
    """Ours and the book's, entry by entry: what a failure shows."""
    lines = [f"{name}: operations, ours and the book's"]
    for word, ours, theirs in zip(("M", "h", "Q"), forms(name), printed(name), strict=True):
        for place in range(len(theirs)):
            i, j = divmod(place, theirs.shape[1])
            pair = ours[i, j], theirs[i, j]
            counts = " ".join(f"{operations(e):4d}" for e in pair)
            lines.append(f"  {word}[{i},{j}] {counts}   {pair[0]}   |   {pair[1]}")
    return "\n".join(lines)


@pytest.mark.one_in(4)
@EVERY
def test_the_book_is_right(name: str) -> None:
    book = BOOKS[name]
    M, h = proven(name)
    for ours, theirs in ((M, book.M), (h, book.h)):
        for one, other in zip(ours, theirs, strict=True):
            assert vanishes(one - other, book.squares), (one, other)


@EVERY
def test_closed_forms_are_the_books(name: str) -> None:
    book = BOOKS[name]
    d = derived(name)
    assert [str(x) for x in d.q] == book.q.split()
    assert [str(x) for x in d.v] == book.v.split()
    for ours, theirs in zip(forms(name), printed(name), strict=True):
        assert ours.shape == theirs.shape
        for one, other in zip(ours, theirs, strict=True):
            assert vanishes(one - other, book.squares), (one, other)


@EVERY
def test_closed_forms_are_as_short_as_the_books(name: str) -> None:
    ours, theirs = counted(forms(name)), counted(printed(name))
    for one, other in zip(ours, theirs, strict=True):
        assert one <= LONGER * other, table(name)
    assert sum(ours) <= LONGER * sum(theirs), table(name)
    for one, other in zip(derived(name).mass_matrix, BOOKS[name].M, strict=True):
        assert operations(one) <= max(2 * operations(other), operations(other) + 1), table(name)


@EVERY
def test_closed_forms_look_as_in_books(name: str) -> None:
    book = BOOKS[name]
    for matrix in forms(name):
        for entry in matrix:
            assert not entry.atoms(sympy.Float), entry
            assert not unmerged(entry), entry
            assert angles(entry) <= set(book.angles), entry
            if book.planar:
                assert not products_of_angles(entry), entry


@EVERY
def test_a_symmetric_matrix_says_the_same_twice(name: str) -> None:
    M = derived(name).mass_matrix
    assert M.T == M


# ---- what is known of single systems


def test_only_differences_of_absolute_angles_couple() -> None:
    d = derived("double pendulum, absolute angles")
    t1, t2 = symbols("t1 t2")
    assert angles(d.mass_matrix) == {t1 - t2}
    weight = d.gravity
    assert angles(weight) == {t1, t2}
    rest = (d.bias - weight).applyfunc(sympy.expand)
    assert angles(rest) == {t1 - t2}


def test_inertias_are_grouped() -> None:
    """M11 of the Furuta pendulum has one square of the hinge's angle at most, or two as in the book."""
    M = derived("Furuta pendulum").mass_matrix
    squares = [f for f in M[0, 0].atoms(sympy.Pow) if f.base.is_Function]
    assert len(squares) <= 2


def test_common_factors_are_out() -> None:
    """Of the torques of gravity g, of those of the lower rod its first moment too."""
    m2, c2, g = symbols("m2 c2 g")
    first, second = derived("double pendulum, relative angles").gravity
    assert g in sympy.Mul.make_args(first)
    assert {m2, c2, g} <= set(sympy.Mul.make_args(second))


def test_kane_and_lagrange_of_sympy_have_the_same_double_pendulum() -> None:
    """A third route, sympy's own, for the system that everybody knows."""
    q, speeds = mechanics.dynamicsymbols("a b"), mechanics.dynamicsymbols("u v")
    M, h = sympys_double_pendulum(q, speeds)
    plain = dict(zip(speeds, symbols("a_dot b_dot"), strict=True))
    plain |= dict(zip(q, symbols("a b"), strict=True))
    book = BOOKS["double pendulum, relative angles"]
    for one, other in zip([*M, *h], [*book.M, *book.h], strict=True):
        assert vanishes(one.xreplace(plain) - other)


def sympys_double_pendulum(q: Any, speeds: Any) -> tuple[Any, Any]:
    """M and h of `book_forms.double_pendulum` by Kane."""
    g, m1, m2, l1, c1, c2, I1, I2 = symbols("g m1 m2 l1 c1 c2 I1 I2")
    N, A, B = (mechanics.ReferenceFrame(name) for name in "NAB")
    A.orient_axis(N, N.y, q[0])
    B.orient_axis(A, N.y, q[1])
    A.set_ang_vel(N, speeds[0] * N.y)
    B.set_ang_vel(A, speeds[1] * N.y)
    O = mechanics.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    C1 = O.locatenew("C1", -c1 * A.z)
    tip = O.locatenew("tip", -l1 * A.z)
    C2 = tip.locatenew("C2", -c2 * B.z)
    C1.v2pt_theory(O, N, A)
    tip.v2pt_theory(O, N, A)
    C2.v2pt_theory(tip, N, B)
    rods = [
        mechanics.RigidBody(f"b{k}", C, F, m, (mechanics.inertia(F, 0, J, 0), C))
        for k, (C, F, m, J) in enumerate(((C1, A, m1, I1), (C2, B, m2, I2)))
    ]
    loads = [(rod.masscenter, -rod.mass * g * N.z) for rod in rods]
    rates = [s - x.diff() for s, x in zip(speeds, q, strict=True)]
    kane = mechanics.KanesMethod(N, q_ind=q, u_ind=speeds, kd_eqs=rates)
    kane.kanes_equations(rods, loads)
    return kane.mass_matrix, -kane.forcing


def test_steady_precession_of_the_top() -> None:
    """A Om² cos th - C n Om + m g l = 0 holds the angle th, with n the spin about the axis."""
    d = derived("heavy top, Euler angles")
    A, C, m, g, l, th, Om, n = symbols("A C m g l o_angle2 Om n")  # noqa: E741
    rates = dict(
        zip(
            symbols("o_angle1_dot o_angle2_dot o_angle3_dot"),
            (Om, 0, n - Om * sympy.cos(th)),
            strict=True,
        )
    )
    steady = d.bias.subs(rates)
    condition = A * Om**2 * sympy.cos(th) - C * n * Om + m * g * l
    assert vanishes(steady[1] + sympy.sin(th) * condition)
    assert steady[0] == 0
    assert steady[2] == 0


def test_the_top_in_both_coordinates_has_the_same_energy() -> None:
    """With w of the angles' rates in the axes of the body."""
    by_angles, by_quaternion = lg.derive(top()), lg.derive(top(None))
    ph, th, ps = symbols("o_angle1_dot o_angle2_dot o_angle3_dot")
    q2, q3 = symbols("o_angle2 o_angle3")
    sin, cos = sympy.sin, sympy.cos
    spin = (
        ph * sin(q2) * sin(q3) + th * cos(q3),
        ph * sin(q2) * cos(q3) - th * sin(q3),
        ph * cos(q2) + ps,
    )
    seen = dict(zip(symbols("o_wx o_wy o_wz"), spin, strict=True))
    difference = by_quaternion.kinetic_energy.subs(seen) - by_angles.kinetic_energy
    assert vanishes(difference)
    A, C = symbols("A C")
    wx, wy, wz = seen
    assert vanishes(by_quaternion.kinetic_energy - (A * (wx**2 + wy**2) + C * wz**2) / 2)


def test_a_free_top_keeps_its_energy_and_its_spin() -> None:
    """Without weight d/dt (w·Iw) and d/dt |Iw|² vanish along M ẇ = -h, and so does C ẇz."""
    d = derived("heavy top, quaternion")
    spin = d.v
    torque_free = -d.bias.subs(sympy.Symbol("g"), 0)
    momentum = d.mass_matrix * spin
    assert vanishes(spin.dot(torque_free))
    assert vanishes(momentum.dot(torque_free))
    assert torque_free[2] == 0


@pytest.mark.parametrize("coordinates", ["joint", "absolute-angle"])
def test_energies_of_the_double_pendulum(coordinates: str) -> None:
    d = lg.derive(double_pendulum(coordinates))
    g, m1, m2, l1, c1, c2, I1, I2 = symbols("g m1 m2 l1 c1 c2 I1 I2")
    first, second = d.q if coordinates != "joint" else (d.q[0], d.q[0] + d.q[1])
    u, w = d.v if coordinates != "joint" else (d.v[0], d.v[0] + d.v[1])
    cos = sympy.cos
    speed = (l1 * u) ** 2 + (c2 * w) ** 2 + 2 * l1 * c2 * u * w * cos(first - second)
    kinetic = ((I1 + m1 * c1**2) * u**2 + I2 * w**2 + m2 * speed) / 2
    potential = -g * ((m1 * c1 + m2 * l1) * cos(first) + m2 * c2 * cos(second))
    assert vanishes(d.kinetic_energy - kinetic)
    assert vanishes(d.potential_energy - potential)
    assert operations(d.potential_energy) <= LONGER * operations(potential)
    assert not products_of_angles(d.potential_energy)

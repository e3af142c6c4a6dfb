"""The printer: parentheses, signs, numbers, names of steps, labels and checks."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from codegen.printer import PrintedBody, Syntax, number, print_program
from linegraph.ir.dag import Dag, Node, Operand
from linegraph.ir.functions import ARITY
from linegraph.ir.program import Argument, Check, Guards, Program, Result, assemble

PLAIN = Syntax(
    before="",
    after="",
    member="p.",
    functions={name: f"{name}(" for name in ARITY},
    comment=lambda label: f"# {label}",
    check=lambda value, bound, check: [f"check {check.status}: {value} > {bound}"],
)
ARGUMENTS = tuple(Argument(name, None, "") for name in "abcdqp")


def assembled(*entries: Operand, checks: tuple[Check, ...] = ()) -> Program:
    return assemble(
        "f", "", ARGUMENTS, (Result("y", (len(entries),), entries, ""),), Guards(checks)
    )


def printed(*entries: Operand, checks: tuple[Check, ...] = ()) -> PrintedBody:
    return print_program(assembled(*entries, checks=checks), PLAIN)


DAG = Dag()
A, B, C, D = (DAG.symbol(name) for name in "abcd")


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        (A, "a"),
        (DAG.symbol("q", 3), "q[3]"),
        (DAG.symbol("p", "mass"), "p.mass"),
        (-A, "-a"),
        (A + B + C, "a + b + c"),
        (A + (B + C), "b + c + a"),
        (A - B - C, "a - b - c"),
        (A - (B - C), "a - (b - c)"),
        (A - (B + C), "a - (b + c)"),
        (A * B * C, "a * b * c"),
        (A * (B * C), "b * c * a"),
        (A / B / C, "a / b / c"),
        (A / (B / C), "a / (b / c)"),
        (A / (B * C), "a / (b * c)"),
        (A * (B / C), "b / c * a"),
        (A / B * C, "a / b * c"),
        (A + B * C, "a + b * c"),
        ((A + B) + (C + D), "a + b + (c + d)"),
        ((A * B) * (C / D), "a * b * (c / d)"),
        (A * B + (C - D), "c - d + a * b"),
        ((A - B) * (C - D) * A, "(a - b) * (c - d) * a"),
        ((A + B) * C, "c * (a + b)"),
        ((A + B) / (C - D), "(a + b) / (c - d)"),
        (-(A + B), "-(a + b)"),
        (-(A * B), "-a * b"),
        (-(A / B), "-a / b"),
        (-A * B + C, "c - a * b"),
        (-A - B, "-(a + b)"),
        (A + 2, "a + 2.0"),
        (A - 2, "a - 2.0"),
        (2 - A, "2.0 - a"),
        (-2 - A, "-2.0 - a"),
        (A - Fraction(1, 4), "a - 0.25"),
        (A * 2, "2.0 * a"),
        (A * -2, "-2.0 * a"),
        ((A + B) * 2, "2.0 * (a + b)"),
        (A * B * 2, "a * b * 2.0"),
        (A / B * 2, "a / b * 2.0"),
        (-3 / A, "-3.0 / a"),
        (-(-3 / A), "-(-3.0 / a)"),
        (A / 4, "0.25 * a"),
        (A - 3 / B, "a - 3.0 / b"),
        (DAG.sin(A + B), "sin(a + b)"),
        (DAG.sqrt(-A), "sqrt(-a)"),
        (DAG.sqrt(-A * B), "sqrt(-a * b)"),
        (DAG.cos(A) * 2, "2.0 * cos(a)"),
        (DAG.cos(-A), "cos(a)"),
        (0, "0.0"),
        (-1, "-1.0"),
        (1e-5, "1e-05"),
    ],
)
def test_parentheses_stand_where_they_must(entry: Operand, text: str) -> None:
    assert printed(entry).results == [[text]]


@pytest.mark.parametrize(
    ("x", "text"),
    [
        (1, "1.0"),
        (-2, "-2.0"),
        (10**20, "1e+20"),
        (Fraction(1, 3), "0.3333333333333333"),
        (0.1, "0.1"),
        (1e-300, "1e-300"),
        (2**53 + 1, "9007199254740992.0"),
    ],
)
def test_numbers_are_floating_and_short(x: Any, text: str) -> None:
    assert number(x) == text


def test_difference_used_only_with_its_sign_turned_is_turned() -> None:
    dag = Dag()
    a, b = dag.symbol("a"), dag.symbol("b")
    assert printed(-(a - b)).results == [["b - a"]]
    assert printed(-(a - b), a - b).results == [["-t0", "t0"]]
    with_number = -(2 - a)
    assert isinstance(with_number, Node)
    assert printed(with_number).results == [["a - 2.0"]]
    assert printed(-(-2 - a)).results == [["a + 2.0"]]
    assert printed(dag.sqrt(-(a - b))).results == [["sqrt(b - a)"]]


def test_turned_difference_with_a_name_is_referred_to_without_sign() -> None:
    dag = Dag()
    a, b = dag.symbol("a"), dag.symbol("b")
    difference = a - b
    assert isinstance(difference, Node)
    program = assembled(-difference, -difference)
    named = Program(**{**program.__dict__, "steps": (difference,)})
    assert named.turned == {difference.index}
    body = print_program(named, PLAIN)
    assert body.lines == ["t0 = b - a"]
    assert body.results == [["t0", "t0"]]


def test_labels_stand_above_the_first_step_they_belong_to() -> None:
    dag = Dag()
    a, b = dag.symbol("a"), dag.symbol("b")
    dag.label = "one"
    x = a * b
    y = x + a
    dag.label = "two"
    z = y / b
    dag.label = ""
    w = z + 1
    dag.label = "two"
    u = w * b
    body = printed(x, x, y, y, z, z, w, w, u, u)
    assert body.lines == [
        "# one",
        "t0 = a * b",
        "t1 = a + t0",
        "# two",
        "t2 = t1 / b",
        "t3 = t2 + 1.0",
        "# two",
        "t4 = b * t3",
    ]


def test_checks_come_as_soon_as_all_they_need_is_known() -> None:
    dag = Dag()
    a, b = dag.symbol("a"), dag.symbol("b")
    first = a + b
    second = first * first
    third = second + a
    assert isinstance(first, Node)
    assert isinstance(third, Node)
    checks = (
        Check(third, second * 1e-9, 3, ""),
        Check(a, 0, 1, ""),
        Check(first, dag.symbol("c") / third, 4, ""),
        Check(first, 1e-9, 2, ""),
    )
    body = printed(third / first, checks=checks)
    assert body.lines == [
        "check 1: a > 0.0",
        "t0 = a + b",
        "check 2: t0 > 1e-09",
        "t1 = t0 * t0",
        "t2 = a + t1",
        "check 3: t2 > 1e-09 * t1",
        "check 4: t0 > c / t2",
    ]
    assert body.used == {"a", "b", "c"}


def test_used_arguments_are_those_that_are_read() -> None:
    dag = Dag()
    body = printed(dag.symbol("q", 0), dag.symbol("p", "m") * dag.symbol("t"))
    assert body.used == {"q", "p", "t"}
    assert printed(1, 2).used == frozenset()

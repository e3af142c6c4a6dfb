"""Programs put in order: which nodes live, which get a name, and what they cost."""

from __future__ import annotations

from typing import Any

from small_programs import program

from linegraph.ir.dag import Dag
from linegraph.ir.program import (
    INLINE_LIMIT,
    Argument,
    Check,
    Module,
    Result,
    count_uses,
    leaves,
    needed_for,
    operations_of,
    reads,
)

DAG = Dag()
X, Y, Z = (DAG.symbol("q", n) for n in range(3))


def result(*entries: Any) -> tuple[Result, ...]:
    return (Result("y", (len(entries),), entries, ""),)


def test_what_no_result_needs_is_left_out() -> None:
    used, _unused = DAG.sin(X), DAG.cos(X)
    made = program(used * Y)
    assert made.live == sorted([X, Y, used, used * Y], key=lambda node: node.index)


def test_each_node_follows_its_operands() -> None:
    entry = DAG.sqrt(X * Y + Z) / (X - Y)
    seen: set[int] = set()
    for node in program(entry, entry * Z).live:
        if node.op != "symbol":
            assert all(not hasattr(x, "index") or x.index in seen for x in (node.a, node.b))
        seen.add(node.index)


def test_what_is_used_twice_has_a_name_and_what_is_used_once_has_none() -> None:
    shared, once = X * Y, Y * Z
    made = program(shared + once, shared - Z)
    assert shared in made.steps
    assert once not in made.steps


def test_a_line_that_grows_too_long_is_cut() -> None:
    long = X
    for _ in range(3 * INLINE_LIMIT):
        long = DAG.sin(long) * Y
    names = program(long).steps
    assert 3 * 2 * INLINE_LIMIT // (INLINE_LIMIT + 1) - 1 <= len(names) <= 6
    assert program(X * Y + Z).steps == ()


def test_what_is_checked_has_a_name() -> None:
    pivot = X * Y
    check = Check(pivot, 0, 1, "singular")
    assert program(Z, checks=(check,)).steps == (pivot,)


def test_a_change_of_sign_is_free_and_has_no_name() -> None:
    turned = -(X * Y)
    made = program(turned, turned + Z)
    assert all(node.op != "neg" for node in made.steps)
    assert made.operations == 2


def test_shared_operations_count_once() -> None:
    shared = DAG.sin(X)
    assert operations_of(result(shared * Y, shared * Z, shared)) == 3
    assert needed_for([shared * Y, 5]) == {shared.index, (shared * Y).index}


def test_a_bound_with_a_fraction_is_one_product_more() -> None:
    bound = Y * Z
    plain = Check(X, bound, 1, "")
    scaled = Check(X, bound, 1, "", fraction=1e-9)
    number = Check(X, 3.0, 1, "", fraction=1e-9)
    counts = [operations_of(result(X), (check,)) for check in (plain, scaled, number)]
    assert counts == [1, 2, 0]


def test_a_difference_of_which_only_the_negative_is_used_is_turned() -> None:
    difference = X - Z
    negative = DAG.function("exp", -difference)
    assert program(-difference, negative).turned == {difference.index}
    assert program(negative, Y * difference).turned == frozenset()
    assert program(-difference, difference).turned == frozenset()


def test_uses_of_a_negation_are_uses_of_its_operand() -> None:
    product = X * Z
    entries = (-product, -product + 1, product)
    made = program(*entries)
    uses, negated = count_uses(made.live, made.results, ())
    assert uses[product.index] == 3
    assert negated == {product.index: 1}  # 1 - x z needs no change of sign
    assert uses[X.index] == uses[Z.index] == 1


def test_a_written_out_operand_has_shared_parts_as_often_as_used() -> None:
    square = (X + 1) * (X + 2)
    assert leaves(square) == 4
    assert leaves(square * square) == 8
    assert leaves(-X) == 1
    assert leaves(7) == 1


def test_results_read_the_arguments_that_stand_in_them() -> None:
    t = DAG.symbol("t")
    assert reads("t", result(X * t))
    assert not reads("t", result(X * Y, 3))


def test_a_program_shows_its_arguments_and_cost() -> None:
    made = program(X * Y + Z)
    assert repr(made) == "<program f(q, p): 2 operations>"
    module = Module("arm", (), (), (), (), (), False, (made,))
    assert repr(module) == "<module arm: f>"
    assert made.arguments[0] == Argument("q", 4, "coordinates")

"""The expression DAG and the programs cut from it: rules, sharing, order, counting, and equal values."""

from __future__ import annotations

import math
import random
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest
from support.dag_values import reached, value, values

from linegraph import ModelError
from linegraph.ir.dag import Dag, Node
from linegraph.ir.functions import ARITY, of_numbers
from linegraph.ir.program import INLINE_LIMIT, Argument, Check, Guards, Program, Result, assemble

if TYPE_CHECKING:
    from collections.abc import Callable

DEEP = 50_000
ARGUMENTS = (Argument("q", 4, "inputs"),)


def symbols(dag: Dag) -> list[Any]:
    return [dag.symbol("q", i) for i in range(4)]


def program(*entries: Any, checks: tuple[Check, ...] = ()) -> Program:
    result = Result("r", (len(entries),), entries, "results")
    return assemble("f", "A function.", ARGUMENTS, (result,), Guards(checks))


# ---- simplification at construction


@pytest.mark.parametrize(
    ("left", "right"),
    [
        (lambda d, x, y: x + 0, lambda d, x, y: x),
        (lambda d, x, y: 0 + x, lambda d, x, y: x),
        (lambda d, x, y: x - 0, lambda d, x, y: x),
        (lambda d, x, y: x - 0.0, lambda d, x, y: x),
        (lambda d, x, y: 0 - x, lambda d, x, y: -x),
        (lambda d, x, y: x * 1, lambda d, x, y: x),
        (lambda d, x, y: 1.0 * x, lambda d, x, y: x),
        (lambda d, x, y: x * -1, lambda d, x, y: -x),
        (lambda d, x, y: x / 1, lambda d, x, y: x),
        (lambda d, x, y: x / -1, lambda d, x, y: -x),
        (lambda d, x, y: d.negate(-x), lambda d, x, y: x),
        (lambda d, x, y: x + y, lambda d, x, y: y + x),
        (lambda d, x, y: x * y, lambda d, x, y: y * x),
        (lambda d, x, y: x + 2, lambda d, x, y: 2 + x),
        (lambda d, x, y: x * 2, lambda d, x, y: 2 * x),
        (lambda d, x, y: x - y, lambda d, x, y: -(y - x)),
        (lambda d, x, y: x + (-y), lambda d, x, y: x - y),
        (lambda d, x, y: (-x) + y, lambda d, x, y: y - x),
        (lambda d, x, y: x - (-y), lambda d, x, y: x + y),
        (lambda d, x, y: (-x) - y, lambda d, x, y: -(x + y)),
        (lambda d, x, y: (-x) - (-y), lambda d, x, y: y - x),
        (lambda d, x, y: 2 + (-x), lambda d, x, y: 2 - x),
        (lambda d, x, y: (-x) + 2, lambda d, x, y: 2 - x),
        (lambda d, x, y: 2 - (-x), lambda d, x, y: x + 2),
        (lambda d, x, y: (-x) * y, lambda d, x, y: -(x * y)),
        (lambda d, x, y: x * (-y), lambda d, x, y: -(x * y)),
        (lambda d, x, y: (-x) * (-y), lambda d, x, y: x * y),
        (lambda d, x, y: (-x) * 3, lambda d, x, y: -(x * 3)),
        (lambda d, x, y: x * -3, lambda d, x, y: -(x * 3)),
        (lambda d, x, y: (-x) * -3, lambda d, x, y: x * 3),
        (lambda d, x, y: x * 2 * 3, lambda d, x, y: x * 6),
        (lambda d, x, y: x * 2 / 2, lambda d, x, y: x),
        (lambda d, x, y: x * 2 * -3, lambda d, x, y: -(x * 6)),
        (lambda d, x, y: x * -2 * -3, lambda d, x, y: x * 6),
        (lambda d, x, y: x * 3 / -3, lambda d, x, y: -x),
        (lambda d, x, y: x / 4, lambda d, x, y: x * Fraction(1, 4)),
        (lambda d, x, y: (-x) / y, lambda d, x, y: -(x / y)),
        (lambda d, x, y: x / (-y), lambda d, x, y: -(x / y)),
        (lambda d, x, y: (-x) / (-y), lambda d, x, y: x / y),
        (lambda d, x, y: 2 / (-y), lambda d, x, y: -(2 / y)),
        (lambda d, x, y: d.sin(-x), lambda d, x, y: -d.sin(x)),
        (lambda d, x, y: d.cos(-x), lambda d, x, y: d.cos(x)),
        (lambda d, x, y: d.sin(x + y), lambda d, x, y: d.sin(y + x)),
        (lambda d, x, y: d.cos(x - y), lambda d, x, y: d.cos(y - x)),
        (lambda d, x, y: x + 1, lambda d, x, y: x + 1.0),
    ],
)
def test_equal_expressions_are_one_node(
    left: Callable[..., Any], right: Callable[..., Any]
) -> None:
    """Whichever of the two is built first."""
    for first, second in ((left, right), (right, left)):
        dag = Dag()
        x, y, *_ = symbols(dag)
        assert first(dag, x, y) is second(dag, x, y)


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (lambda d, x, y: x * 0, 0),
        (lambda d, x, y: 0 * x, 0),
        (lambda d, x, y: 0 / x, 0),
        (lambda d, x, y: x - x, 0),
        (lambda d, x, y: x + (-x), 0),
        (lambda d, x, y: (x + y) - (y + x), 0),
        (lambda d, x, y: (-x) - (-x), 0),
        (lambda d, x, y: x / x, 1),
        (lambda d, x, y: (x * y) / (y * x), 1),
        (lambda d, x, y: (x - y) + (y - x), 0),
        (lambda d, x, y: d.sin(0), 0),
        (lambda d, x, y: d.cos(0), 1),
        (lambda d, x, y: d.sqrt(1), 1),
        (lambda d, x, y: d.add(2, 3), 5),
        (lambda d, x, y: d.subtract(2, 3), -1),
        (lambda d, x, y: d.multiply(2, 3), 6),
        (lambda d, x, y: d.divide(6, 3), 2),
        (lambda d, x, y: d.negate(2), -2),
    ],
)
def test_what_is_known_becomes_a_number(expression: Callable[..., Any], expected: int) -> None:
    dag = Dag()
    x, y, *_ = symbols(dag)
    found = expression(dag, x, y)
    assert not isinstance(found, Node)
    assert found == expected


@pytest.mark.parametrize(
    ("left", "right"),
    [
        (lambda d, x, y: x - y, lambda d, x, y: y - x),
        (lambda d, x, y: x / y, lambda d, x, y: y / x),
        (lambda d, x, y: 2 - x, lambda d, x, y: x - 2),
        (lambda d, x, y: 2 / x, lambda d, x, y: x / 2),
        (lambda d, x, y: x + 1, lambda d, x, y: x * 2),
        (lambda d, x, y: x + y, lambda d, x, y: x * y),
        (lambda d, x, y: d.sin(x), lambda d, x, y: d.cos(x)),
        (lambda d, x, y: d.symbol("q", 0), lambda d, x, y: d.symbol("v", 0)),
        (lambda d, x, y: d.symbol("q", 0), lambda d, x, y: d.symbol("q", "0")),
        # node number 1 and the number 1 are different operands
        (lambda d, x, y: y + y, lambda d, x, y: y + 1),
    ],
)
def test_different_expressions_are_different_nodes(
    left: Callable[..., Any], right: Callable[..., Any]
) -> None:
    dag = Dag()
    x, y, *_ = symbols(dag)
    assert left(dag, x, y) is not right(dag, x, y)


def test_of_two_opposite_differences_one_is_computed() -> None:
    dag = Dag()
    x, y, *_ = symbols(dag)
    both = [x - y, y - x]
    assert [node.op for node in reached(both)] == ["symbol", "symbol", "sub", "neg"]


def test_an_integral_fold_is_exact_and_any_other_is_a_float() -> None:
    for name, x, expected in (("sin", 0, 0), ("cos", 0, 1), ("sqrt", 0, 0), ("sqrt", 1, 1)):
        found = of_numbers(name, x)
        assert found == expected
        assert isinstance(found, int)
    assert of_numbers("sin", math.pi / 2) == 1.0
    assert isinstance(of_numbers("sin", math.pi / 2), float)
    assert of_numbers("sqrt", Fraction(1, 4)) == 0.5
    assert of_numbers("cos", 1) == math.cos(1)
    for name, x in (("exp", 0), ("cosh", 0), ("sign", 1), ("abs", 1)):
        assert of_numbers(name, x) == 1
        assert isinstance(of_numbers(name, x), int)


REFERENCE: dict[str, Callable[..., float]] = {
    "abs": math.fabs,
    "min": min,
    "max": max,
    "sign": lambda x: math.copysign(1.0, x),
}


@pytest.mark.parametrize("name", ARITY)
def test_every_function_is_known_over_nodes_and_numbers(name: str) -> None:
    """A known argument is folded, an unknown one kept and shared, whatever the function."""
    x = (0.37, -1.2)[: ARITY[name]]
    expected = REFERENCE.get(name) or getattr(math, name)
    assert of_numbers(name, *x) == expected(*x)
    dag = Dag()
    assert dag.function(name, *x) == expected(*x)
    unknown = symbols(dag)[: ARITY[name]]
    node = dag.function(name, *unknown)
    assert isinstance(node, Node)
    assert node.op == name
    assert dag.function(name, *unknown) is node
    assert (node.a, node.b) == (unknown[0], unknown[1] if len(unknown) > 1 else None)


def test_functions_without_a_value_are_refused() -> None:
    for name, x in (("sqrt", -1), ("log", 0), ("acos", 1.5), ("exp", 1e6)):
        with pytest.raises(ModelError, match=f"{name}.* is not a finite number"):
            of_numbers(name, x)


def test_fractions_stay_exact() -> None:
    dag = Dag()
    x, *_ = symbols(dag)
    assert (x / 3) * 3 is x
    node = x / 3 / 7
    assert isinstance(node, Node)
    assert (node.a, node.b) == (x, Fraction(1, 21))
    assert isinstance(dag.divide(1, Fraction(3)), Fraction)


def test_dividing_by_the_number_zero_raises() -> None:
    dag = Dag()
    x, *_ = symbols(dag)
    with pytest.raises(ZeroDivisionError):
        x / 0


# ---- numbering, labels, sharing


def build(dag: Dag, seed: int, size: int = 60) -> list[Any]:
    """Random expressions over four symbols; functions and divisions only where they are safe."""
    draw = random.Random(seed)
    pool: list[Any] = [*symbols(dag), 0, 1, -1, 2, 0.5, Fraction(1, 3)]
    for _ in range(size):
        x, y = draw.choice(pool), draw.choice(pool)
        make: Any = draw.choice(
            [
                lambda x, y: x + y,
                lambda x, y: x - y,
                lambda x, y: x * y,
                lambda x, y: -x,
                lambda x, y: x / (y * y + 1),
                lambda x, y: dag.sin(x),
                lambda x, y: dag.cos(y),
                lambda x, y: dag.sqrt(x * x + 1),
            ]
        )
        pool.append(make(x, y))
    return pool[4:]


def listing(roots: list[Any]) -> list[tuple[Any, ...]]:
    def name(x: Any) -> Any:
        return ("node", x.index) if isinstance(x, Node) else x

    return [(n.index, n.op, name(n.a), name(n.b), n.label) for n in reached(roots)]


@pytest.mark.parametrize("seed", range(5))
def test_numbering_repeats_itself(seed: int) -> None:
    assert listing(build(Dag(), seed)) == listing(build(Dag(), seed))


@pytest.mark.parametrize("seed", range(5))
def test_operands_come_before_their_node_and_no_node_twice(seed: int) -> None:
    nodes = reached(build(Dag(), seed))
    for node in nodes:
        assert all(x.index < node.index for x in (node.a, node.b) if isinstance(x, Node))
    operations = [
        (n.op, *(x.index if isinstance(x, Node) else ("number", x) for x in (n.a, n.b)))
        for n in nodes
    ]
    assert len(operations) == len(set(operations))


def test_a_node_keeps_the_label_of_its_first_construction() -> None:
    dag = Dag()
    x, y, *_ = symbols(dag)
    dag.label = "one"
    first: Any = x * y
    dag.label = "two"
    assert (y * x).label == "one"
    assert (first + 1).label == "two"


def test_released_nodes_are_made_anew_with_new_numbers() -> None:
    dag = Dag()
    x, y, *_ = symbols(dag)
    before = x * y
    assert x * y is before
    dag.release()
    after = x * y
    assert after is not before
    assert after.index > before.index


def test_nodes_show_their_names() -> None:
    dag = Dag()
    assert repr(dag.symbol("t")) == "t"
    assert repr(dag.symbol("q", 3)) == "q[3]"
    assert repr(dag.symbol("p", "mass")) == "p[mass]"
    assert repr(dag.symbol("q", 3) + 1) == "n3"


# ---- values


@pytest.mark.parametrize("seed", range(40))
def test_rational_expressions_have_exactly_the_value_of_pythons_arithmetic(seed: int) -> None:
    """Built twice, over nodes and over fractions: not one rule changes a value."""
    draw = random.Random(seed)
    numbers = [Fraction(draw.randint(-9, 9), draw.randint(1, 9)) for _ in range(4)]
    constants: list[Any] = [0, 1, -1, 2, Fraction(-2, 3), Fraction(5)]
    pairs: list[tuple[Any, Fraction]] = [
        *zip(symbols(Dag()), numbers, strict=True),
        *((c, Fraction(c)) for c in constants),
    ]
    for _ in range(120):
        (x, a), (y, b) = draw.choice(pairs), draw.choice(pairs)
        kind = draw.choice("+-*/n")
        if kind == "+":
            pairs.append((x + y, a + b))
        elif kind == "-":
            pairs.append((x - y, a - b))
        elif kind == "*":
            pairs.append((x * y, a * b))
        elif kind == "n":
            pairs.append((-x, -a))
        elif b and y != 0 and abs(a) < 10**9 and not (isinstance(x, int) and isinstance(y, int)):
            pairs.append((x / y, a / b))
        if pairs[-1][1].denominator > 10**40 or abs(pairs[-1][1]) > 10**40:
            pairs.pop()
    found = values([node for node, _ in pairs], {"q": numbers})
    assert found == [expected for _, expected in pairs]


@pytest.mark.parametrize("seed", range(40))
def test_functions_have_the_value_of_pythons_arithmetic(seed: int) -> None:
    draw = random.Random(seed)
    numbers = [draw.uniform(-2, 2) for _ in range(4)]

    class Plain(Dag):
        """The same recipe over floats instead of nodes."""

        def symbol(self, argument: str, place: int | str | None = None) -> Any:
            return numbers[place]  # type: ignore[index]

    found = values(build(Dag(), seed), {"q": numbers})
    for got, expected in zip(found, build(Plain(), seed), strict=True):
        assert got == pytest.approx(expected, rel=1e-13, abs=1e-13)  # measured 3e-15


# ---- programs


def operations(*entries: Any) -> int:
    return program(*entries).operations


def test_operations_counted_by_hand() -> None:
    dag = Dag()
    x, y, z, w = symbols(dag)
    assert operations(x, 1, 0) == 0
    assert operations(x * y + x * y * z) == 3  # x y once, times z, sum
    assert operations(-(x * y)) == 1  # signs are free
    assert operations(x * y - z * w, dag.sin(x * y)) == 4
    assert operations(dag.cos(x), dag.sin(x), dag.cos(-x)) == 2
    assert operations((x + y) / 2 + z / w) == 4
    assert operations((x + y) * 0 + z) == 0


def test_what_no_result_needs_falls_away() -> None:
    dag = Dag()
    x, y, z, _ = symbols(dag)
    unused = dag.sin(x * y)
    shared: Any = y * z
    made = program(shared + 1, shared + 2)
    assert unused not in made.steps
    assert made.steps == (shared,)
    assert made.operations == 3


def test_shared_nodes_are_named_and_others_written_in_place() -> None:
    dag = Dag()
    x, y, z, _ = symbols(dag)
    once: Any = x * y
    twice: Any = dag.sin(z)
    assert program(once + twice, twice * 3).steps == (twice,)
    assert program(x + y, x - y, x * y).steps == ()
    result: Any = x + y
    assert program(result, result).steps == (result,)


def test_symbols_and_negations_are_never_named() -> None:
    dag = Dag()
    x, y, *_ = symbols(dag)
    product: Any = x * y
    assert program(-x, -x + 1, x * 2, -x).steps == ()
    # the operand of a negation used twice is named, the negation written in place
    assert program(-product, dag.sqrt(-product)).steps == (product,)


def test_a_line_that_would_grow_too_long_is_cut() -> None:
    dag = Dag()
    total: Any = dag.symbol("q", 0)
    chain = []
    for i in range(1, 2 * INLINE_LIMIT + 3):
        total = total * dag.symbol("q", i)
        chain.append(total)
    steps = program(total).steps
    assert steps == (chain[INLINE_LIMIT], chain[2 * INLINE_LIMIT + 1])
    assert program(chain[INLINE_LIMIT - 1]).steps == ()


def test_a_difference_only_used_negated_is_computed_the_other_way_round() -> None:
    dag = Dag()
    x, y, z, _ = symbols(dag)
    difference: Any = x - y
    alone = program(y - x)
    assert alone.turned == {difference.index}
    assert alone.operations == 1
    twice = program(y - x, dag.sqrt(y - x))
    assert twice.turned == {difference.index}
    assert twice.operations == 2
    assert twice.steps == (difference,)
    as_it_is = program(difference)
    assert as_it_is.turned == frozenset()
    assert as_it_is.operations == 1
    both = program(difference * z, y - x)
    assert both.turned == frozenset()
    assert both.operations == 2


def test_signs_move_out_of_products_before_a_difference_could_be_turned() -> None:
    dag = Dag()
    x, y, z, _ = symbols(dag)
    difference: Any = x - y
    made = program((y - x) * z)
    assert made.turned == frozenset()
    assert reached([(y - x) * z])[-2:] == reached([-(difference * z)])[-2:]
    assert made.operations == 2


def test_a_checked_node_is_named_and_its_bound_is_alive() -> None:
    dag = Dag()
    x, y, z, _ = symbols(dag)
    pivot: Any = x * y
    bound: Any = dag.sqrt(z)
    made = program(x + 1, checks=(Check(pivot, bound, 1, "singular"),))
    assert made.steps == (pivot,)
    assert made.operations == 3


@pytest.mark.parametrize("seed", range(10))
def test_steps_follow_their_operands_and_are_needed(seed: int) -> None:
    roots = build(Dag(), seed)
    made = program(*roots)
    places = [node.index for node in made.steps]
    assert places == sorted(set(places))
    assert set(made.steps) <= set(reached(roots))
    assert made.operations == sum(node.op not in ("symbol", "neg") for node in reached(roots))


def test_deep_chains_need_no_recursion() -> None:
    dag = Dag()
    x: Any = dag.symbol("q", 0)
    y: Any = x
    for _ in range(DEEP // 2):
        y = dag.sin(y) + x
    made = program(y)
    assert made.operations == DEEP
    expected = 0.5
    for _ in range(DEEP // 2):
        expected = math.sin(expected) + 0.5
    assert value(y, q=[0.5]) == expected


def test_deep_negations_need_no_recursion() -> None:
    dag = Dag()
    y: Any = dag.symbol("q", 0)
    for i in range(DEEP):
        y = dag.symbol("q", 1) - y if i % 2 else -(y * dag.symbol("q", 2))
    made = program(y)
    assert len(reached([y])) > DEEP // 2
    assert made.operations > DEEP // 2

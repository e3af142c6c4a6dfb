"""Sums collected: nothing repeats or cancels within a sum of a program, and no sum holds two numbers.

What is found is found twice: `repeats` walks over the programs, `torn` over the text of the emitted C.
"""

from __future__ import annotations

import random
import re
from collections import Counter
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import pytest
from support import dag_values, targets

import codegen
from linegraph import Model
from linegraph.emission.emit import module_for, render
from linegraph.ir.dag import Dag, Node
from linegraph.ir.program import Argument, Check, Guards, Program, Result, assemble
from linegraph.ir.sums import collected

if TYPE_CHECKING:
    from collections.abc import Iterator

FEW = ("double_pendulum", "furuta", "gyroscope", "four_bar", "panda", "tree3", "loop4", "mixed1")
NAMES = tuple(targets.everything())


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "name" in metafunc.fixturenames:
        every = metafunc.config.getoption("--all-forms")
        metafunc.parametrize("name", NAMES if every else FEW)


def program_of(*entries: Any, checks: tuple[Check, ...] = ()) -> Program:
    given = (Argument("x", 8, ""), Argument("p", None, ""))
    return assemble("f", "", given, (Result("y", (len(entries),), entries, ""),), Guards(checks))


def roots_of(program: Program) -> list[Any]:
    found = [entry for result in program.results for entry in result.entries]
    return found + [x for check in program.checks for x in (check.node, check.bound)]


def tidy(*entries: Any) -> tuple[Any, ...]:
    """What entries become."""
    found = collected(program_of(*entries))
    return found.results[0].entries


def operands(node: Node) -> list[Any]:
    return [] if node.op == "symbol" else [x for x in (node.a, node.b) if x is not None]


def repeats(program: Program) -> list[list[Any]]:
    """The sums in which a term, whatever number it has, or a number stands twice."""
    roots = roots_of(program)
    nodes = dag_values.reached(roots)
    users: Counter[Node] = Counter(x for x in roots if isinstance(x, Node))
    for node in reversed(nodes):
        for x in operands(node):
            if isinstance(x, Node):
                # a change of sign is written in place, as often as it is used
                users[x] += users[node] if node.op == "neg" else 1

    def scaled(node: Node) -> bool:
        return node.op == "mul" and not isinstance(node.b, Node)

    def terms(x: Any, top: bool = False) -> Iterator[Any]:
        if not isinstance(x, Node):
            yield "number"
        elif x.op == "neg":
            yield from terms(x.a)
        elif (top or users[x] == 1) and x.op in ("add", "sub"):
            yield from (*terms(x.a), *terms(x.b))
        elif (top or users[x] == 1) and scaled(x):
            yield from terms(x.a)
        else:
            yield x

    sums = [list(terms(node, True)) for node in nodes if node.op in ("add", "sub")]
    return [found for found in sums if len(set(found)) < len(found)]


def torn(text: str) -> Iterator[list[str]]:
    """The operands of every sum in the text of an expression, brackets outside in."""
    depth, start, found = 0, 0, []
    for place, letter in enumerate(text):
        depth += (letter in "([") - (letter in ")]")
        if not depth and letter in "+-" and text[place - 1 : place] == " ":
            found.append(text[start:place].strip())
            start = place + 1
    found.append(text[start:].strip())
    if len(found) > 1:
        yield found
    for part in found:
        for inside in re.findall(r"\((.*)\)", part):
            yield from torn(inside)


# ---- by hand


def test_terms_that_cancel_leave_nothing() -> None:
    dag = Dag()
    x, c = dag.symbol("p", "x"), dag.symbol("p", "c")
    assert [repr(entry) for entry in tidy(x + c - x)] == ["p[c]"]
    assert tidy(x + 0.00157 - x) == (0.00157,)
    assert tidy((x - c) - (x - c + 2)) == (-2,)


def test_terms_that_repeat_meet() -> None:
    """Half I + m l l + half I is I + m l l: three operations, not five."""
    dag = Dag()
    inertia, m, length = (dag.symbol("p", name) for name in ("I", "m", "l"))
    half = inertia * 0.5
    (found,) = tidy(half + m * length * length + half)
    assert dag_values.value(found, p={"I": 3.0, "m": 5.0, "l": 7.0}) == 3.0 + 5.0 * 49.0
    assert program_of(found).operations == 3


def test_numbers_meet() -> None:
    dag = Dag()
    x, y = dag.symbol("x", 0), dag.symbol("x", 1)
    (found,) = tidy((x + 1) + (y + 2))
    assert program_of(found).operations == 2
    assert dag_values.value(found, x=[10, 100]) == 113
    (found,) = tidy((x + 1) * 2 + 3)
    assert (program_of(found).operations, dag_values.value(found, x=[10])) == (2, 25)


def test_a_common_number_stays_a_factor() -> None:
    dag = Dag()
    a, b, c = (dag.symbol("x", i) for i in range(3))
    (found,) = tidy(a * 9.81 + b * 9.81)
    assert (found.op, found.b) == ("mul", 9.81)
    assert program_of(found).operations == 2
    (found,) = tidy(a * 9.81 - c + b * -9.81)
    assert program_of(found).operations == 3
    kept = (a + b) * 9.81 + c
    assert tidy(kept) == (kept,)


def test_numbers_are_found_within_products_and_quotients() -> None:
    """(9.81 a) b / c + (9.81 c) b takes five products, quotients and sums, not seven."""
    dag = Dag()
    a, b, c = (dag.symbol("x", i) for i in range(3))
    (found,) = tidy((a * 9.81) * b / c + (c * 9.81) * b)
    assert program_of(found).operations == 5
    assert dag_values.value(found, x=[2, 3, 6]) == pytest.approx(9.81 * (2 * 3 / 6 + 6 * 3))


def test_a_sum_that_others_need_is_taken_apart_where_that_saves_something() -> None:
    dag = Dag()
    x, y, c = (dag.symbol("x", i) for i in range(3))
    place = x + y
    assert tidy(place, (place + c) - x)[1].op == "add"
    assert program_of(*tidy(place, (place + c) - place)).operations == 1
    unchanged = (place, place + c)
    assert tidy(*unchanged) == unchanged


def test_what_is_needed_no_longer_is_taken_apart_where_it_is_still_needed() -> None:
    """Both differences leave out the sum x + y, so that nobody needs it."""
    dag = Dag()
    x, y, a, b = (dag.symbol("x", i) for i in range(4))
    common = x + y
    found = tidy((common + a) - (common + b), (common - a) - x)
    assert program_of(*found).operations == 2


def test_rounding_leaves_no_term() -> None:
    dag = Dag()
    x, y = dag.symbol("x", 0), dag.symbol("x", 1)
    assert 0.1 + 0.2 != 0.3
    assert [repr(entry) for entry in tidy(x * 0.1 + y + x * 0.2 - x * 0.3)] == ["x[1]"]


def test_each_program_is_looked_at_by_itself() -> None:
    dag = Dag()
    x, y, c = (dag.symbol("x", i) for i in range(3))
    both = x + c
    one, two = map(collected, (program_of(both - x, y * c), program_of(both, both - x, y * c)))
    assert (one.operations, two.operations) == (1, 2)


def test_checks_are_kept() -> None:
    dag = Dag()
    x, c = dag.symbol("x", 0), dag.symbol("x", 1)
    check = Check(x + c - x, 0, 1, "c is not positive", "C")
    program = program_of(x, checks=(check, Check(x * x, x + 1 - x, 2, "too small")))
    found = collected(program)
    assert repr(found.checks[0].node) == "x[1]"
    assert found.checks[1].bound == 1
    assert [(k.status, k.about, k.name) for k in found.checks] == [
        (k.status, k.about, k.name) for k in program.checks
    ]


# ---- drawn


def drawn(seed: int) -> Program:
    """Sums of sums, products and quotients, with numbers everywhere; some are needed several times."""
    rng = random.Random(seed)
    dag = Dag()
    known: list[Any] = [dag.symbol("x", i) for i in range(5)]
    for _ in range(rng.randrange(6, 40)):
        a, b = rng.choice(known), rng.choice(known[-6:])
        k = rng.choice([2, 3, -1, Fraction(1, 2), Fraction(981, 100)])
        made = rng.choice(
            [lambda: a + b, lambda: a - b, lambda: a * k, lambda: a + k, lambda: -a]  # noqa: B023
            + [lambda: a * b] * (rng.random() < 0.3)  # noqa: B023
            + [lambda: a / (b * b + 1)] * (rng.random() < 0.2)  # noqa: B023
        )()
        if isinstance(made, Node):
            known.append(made)
    return program_of(*rng.sample(known, 3), known[-1])


@pytest.mark.parametrize("block", range(8))
def test_random_sums_keep_their_values_exactly(block: int) -> None:
    """With fractions, so that equal is equal; no program takes more operations."""
    fewer = 0
    for seed in range(50 * block, 50 * block + 50):
        before = drawn(seed)
        after = collected(before)
        x = [Fraction(random.Random(i).randrange(-9, 9), 7) for i in range(seed, seed + 5)]
        assert dag_values.values(roots_of(after), {"x": x}) == dag_values.values(
            roots_of(before), {"x": x}
        )
        assert after.operations <= before.operations
        fewer += after.operations < before.operations
        assert repeats(after) == []
        assert collected(after) is after
    assert fewer > 10


# ---- everything that is emitted


def test_no_emitted_sum_repeats_or_cancels(name: str) -> None:
    for program in targets.module(name).programs:
        if isinstance(program, Program):
            assert repeats(program) == [], program


def test_no_sum_in_the_text_repeats_or_cancels(name: str) -> None:
    source = codegen.render(targets.module(name), "c")["model.c"]
    number = re.compile(r"[\d.]+(?:e[+-]?\d+)?")
    right_sides = re.findall(r" = (.*?);", re.sub(r"/\*.*?\*/", "", source, flags=re.DOTALL))
    sums = [terms for text in right_sides for terms in torn(text)]
    assert len(sums) > 5
    for terms in sums:
        assert len(set(terms)) == len(terms), terms
        assert sum(bool(number.fullmatch(term)) for term in terms) < 2, terms


def test_the_search_finds_what_is_there() -> None:
    dag = Dag()
    x, c = dag.symbol("x", 0), dag.symbol("x", 1)
    assert repeats(program_of(x + c - x))
    assert repeats(program_of((x + 1) - (c - 2)))
    assert not repeats(program_of((x + c) * (x + c) + x))
    assert list(torn("t1 * (a + b - a) - 0.5 * c[1 + 2]")) == [
        ["t1 * (a + b - a)", "0.5 * c[1 + 2]"],
        ["a", "b", "a"],
    ]


def test_inertia_of_two_links_is_written_as_by_hand() -> None:
    """I + m l^2 + J + ... about the first axis, I once and not as two halves."""
    model = Model("half_half")
    inertia, m, length = (
        model.parameter(name, value) for name, value in (("I", 0.3), ("m", 1.0), ("l", 0.5))
    )
    a = model.body("a", mass=m, mass_center=(0, 0, -length), inertia={"yy": inertia})
    b = model.body("b", mass=1, mass_center=(0, 0, -1), inertia={"yy": 0.1})
    model.revolute("x", between=("ground", a), axis=(0, 1, 0))
    model.revolute("y", between=(a, b), axis=(0, 1, 0))
    text = render(model, languages=["c"])["half_half.c"]
    assert "0.5" not in text[text.index("mass_matrix") : text.index("half_half_bias")]
    programs = {x.name: x for x in module_for(model, "m").programs if isinstance(x, Program)}
    entries = programs["mass_matrix"].results[0].entries
    given = {"q": [0.3, 0.7], "p": {"I": 2.0, "m": 3.0, "l": 5.0}}
    # 2 + 3 * 25 about the first hinge, and 1.1 of the second link
    assert dag_values.values(entries, given) == pytest.approx([2 + 75 + 1.1, 1.1, 1.1, 1.1])

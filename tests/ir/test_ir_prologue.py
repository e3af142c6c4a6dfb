"""The prologue: what `prepare` computes and what reads it, together worth the function as it was."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_programs import OPERATIONS, at, program, returned
from support.plain_values import value

from linegraph.ir.dag import Dag, Node
from linegraph.ir.parameter_constants import is_constant
from linegraph.ir.program import Argument, Call, Check, Program, Result, Routine
from linegraph.ir.prologue import SHORT, is_prepared, with_prologue

DAG = Dag()
X, Y = DAG.symbol("q", 0), DAG.symbol("q", 1)
K, M, L = (DAG.symbol("p", name) for name in "kml")
POINT = at((Fraction(7, 3), Fraction(-5, 2)), k=Fraction(3, 7), m=Fraction(2, 9), l=Fraction(5, 4))


def parts(*programs: Program | Routine) -> tuple[dict[str, Any], int]:
    made, count = with_prologue(programs)
    return {p.name: p for p in made}, count


def by_constants(found: dict[str, Any], name: str) -> list[Any]:
    """What the twin returns, given what `prepare` does."""
    constants = returned(found["prepare"], {s: x for s, x in POINT.items() if s[0] == "p"})
    given_values = {s: x for s, x in POINT.items() if s[0] == "q"}
    given_values |= {("c", n): x for n, x in enumerate(constants)}
    return returned(found[f"{name}_prepared"], given_values)


ENTRIES = (X * K * M + Y * (M + 1), X / (K - M * L), -(K * M) * X - K * M, K, 5)


def test_the_twin_is_worth_what_the_function_is() -> None:
    whole = program(*ENTRIES, name="bias")
    found, count = parts(whole)
    assert list(found) == ["prepare", "bias", "bias_prepared"]
    assert by_constants(found, "bias") == returned(whole, POINT)
    assert returned(found["bias"], POINT) == returned(whole, POINT)
    assert count == len(found["prepare"].results[0].entries)


def test_the_twin_takes_c_of_that_size_in_place_of_p() -> None:
    found, count = parts(program(*ENTRIES, name="bias"))
    names = {a.name: a.size for a in found["bias_prepared"].arguments}
    assert names == {"q": 4, "c": count}
    assert [a.name for a in found["prepare"].arguments] == ["p"]


def test_the_twin_does_nothing_that_depends_on_constants_alone() -> None:
    found, _ = parts(program(*ENTRIES, name="bias"))
    for node in found["bias_prepared"].live:
        if node.op in ("symbol", "neg"):
            continue
        operands = [x for x in (node.a, node.b) if isinstance(x, Node)]
        assert not all(x.op == "symbol" and x.a == "c" for x in operands)


def test_constants_are_different_and_none_is_a_number() -> None:
    found, _ = parts(program(*ENTRIES, K * M * Y, name="bias"))
    entries = found["prepare"].results[0].entries
    assert all(is_constant(x, {}) and isinstance(x, Node) for x in entries)
    assert len(set(entries)) == len(entries)
    assert len({value(x, POINT) for x in entries}) == len(entries)


def test_functions_of_one_model_share_constants() -> None:
    found, count = parts(program(X * (K * M), name="bias"), program(Y * (K * M), name="equations"))
    assert count == 1
    assert [by_constants(found, name) for name in ("bias", "equations")] == [
        [POINT["q", n] * value(K * M, POINT)] for n in (0, 1)
    ]


def test_a_constant_and_its_negative_are_one() -> None:
    found, count = parts(program(-(K * M), X * (K * M), name="bias"))
    assert count == 1
    assert by_constants(found, "bias") == returned(program(-(K * M), X * (K * M)), POINT)


def test_constants_that_meet_in_collected_sums_of_two_functions_are_one() -> None:
    """Twice k is a constant of its own, and k alone is one, too."""
    first = program(X + K + Y + K, X * K, name="bias")
    second = program(Y + K + X * Y + K, name="equations")
    found, _ = parts(first, second)
    worth = [value(x, POINT) for x in found["prepare"].results[0].entries]
    assert worth.count(2 * POINT["p", "k"]) == 1
    for made in (first, second):
        assert by_constants(found, made.name) == returned(made, POINT)


def test_only_functions_of_simulation_and_control_have_twins() -> None:
    found, _ = parts(program(X * K, name="energy"), program(Y * K, name="frame_hand_pose"))
    assert "energy_prepared" not in found
    assert "frame_hand_pose_prepared" in found
    assert is_prepared("linearize")
    assert not is_prepared("reactions")


def test_without_parameters_there_is_no_prologue() -> None:
    made = program(X + Y + X, name="bias")
    found, count = parts(made)
    assert (list(found), count) == (["bias"], 0)
    assert returned(found["bias"], POINT) == returned(made, POINT)


def long(name: str, count: int = SHORT) -> Program:
    """A function of many operations on states and few on parameters."""
    x: Any = X
    for n in range(count):
        x = DAG.sin(x) + Y * (n + 2)
    return program(x * (K * M), name=name)


def test_a_long_function_hands_its_work_to_its_twin_and_a_short_one_does_it() -> None:
    found, _ = parts(long("bias"), program(X * (K * M), name="equations"))
    assert found["bias"].handed == "bias_prepared"
    assert found["equations"].handed == ""
    shorter = long("bias", SHORT // 4)
    assert SHORT // 2 < shorter.operations < SHORT
    assert parts(shorter)[0]["bias"].handed == ""


def test_a_function_that_could_then_fail_stays_whole() -> None:
    """Another function divides by k - m, which may be zero where this one has a value."""
    found, _ = parts(long("bias"), program(X / (K - M), name="equations"))
    assert found["bias"].handed == ""
    check = Check(K - M, 0, 1, "k is m")
    checked = program(X / (K - M), name="equations", checks=(check,))
    found, _ = parts(long("bias"), checked)
    assert found["bias"].handed == "bias_prepared"


def test_a_division_that_a_check_is_about_is_guarded() -> None:
    check = Check(K - M, 0, 1, "k is m")
    found, _ = parts(program(X / (K - M), name="equations", checks=(check,)))
    guarded = found["prepare"].guarded
    divisions = [n for n in found["prepare"].live if n.op == "div"]
    assert {n.index for n in divisions} == guarded
    assert len(guarded) == 1
    free, _ = parts(program(X / (K - M), name="equations"))
    assert free["prepare"].guarded == frozenset()


def test_a_routine_and_a_call_use_twins_too() -> None:
    inner = long("equations")
    call = Call("equations", ("q", "p"), (Argument("y", 1, ""),))
    outer = program(X * K, name="rhs", calls=(call,))
    given_arguments = Argument("q", 4, ""), Argument("p", None, "")
    routine = Routine("project", "", given_arguments, (), "newton", (), ("equations",))
    found, count = parts(inner, outer, routine)
    (called,) = found["rhs_prepared"].calls
    assert (called.program, called.arguments) == ("equations_prepared", ("q", "c"))
    twin = found["project_prepared"]
    assert twin.uses == ("equations_prepared",)
    assert [(a.name, a.size) for a in twin.arguments] == [("q", 4), ("c", count)]
    assert found["project"].handed == "project_prepared"
    assert replace(found["project"], handed="") == routine


@st.composite
def entries(draw: st.DrawFn) -> list[Any]:
    nodes: list[Any] = [X, Y, K, M, L, 2]
    for _ in range(draw(st.integers(3, 9))):
        a, b = draw(st.sampled_from(nodes)), draw(st.sampled_from(nodes))
        if draw(st.booleans()):
            a, b = b, draw(st.sampled_from([K, M, L]))
        operation = draw(st.sampled_from("+-*/"))
        if operation == "/" and (not isinstance(b, Node) or value(b, POINT) == 0):
            continue
        nodes.append(OPERATIONS[operation](a, b))
    return nodes[-3:]


@settings(derandomize=True, deadline=None, max_examples=100)
@given(entries())
def test_twins_of_random_functions_are_worth_what_these_are(given_entries: list[Any]) -> None:
    whole = program(*given_entries, name="bias")
    found, count = parts(whole)
    if count:
        assert by_constants(found, "bias") == returned(whole, POINT)
    else:
        assert not any(node.op == "symbol" and node.a == "p" for node in found["bias"].live)


def test_results_keep_their_names() -> None:
    made = program(X * K, name="bias")
    found, _ = parts(made)
    assert [(r.name, r.shape) for r in found["bias_prepared"].results] == [("y", (1,))]
    assert found["prepare"].results[0] == Result(
        "c", (1,), found["prepare"].results[0].entries, "constants"
    )


@pytest.mark.parametrize("name", ["bias", "equations"])
def test_twins_are_told_from_their_functions_by_a_suffix(name: str) -> None:
    found, _ = parts(program(X * K, name=name))
    assert found[f"{name}_prepared"].about.startswith(f"{name} from the constants of prepare.")

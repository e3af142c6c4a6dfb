"""Expressions in text: read by a walker of our own, bounded, never executed."""

from __future__ import annotations

import ast
import math
import random
import time
from fractions import Fraction

import pytest

from linegraph.algebra.formula import VARIABLES, VECTORS, Formula, parse, variable_of
from linegraph.algebra.protocol import Floats
from linegraph.errors import ModelError

VALUES = {"m": 2.0, "l": 0.5, "x": 3.0, "der(x)": -1.5, "beta": 0.25, "S": 7.0, "E": 11.0}


def value(text: str) -> float:
    return float(parse(text).evaluate(Floats(), VALUES))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("m*l**2/3", 2.0 * 0.25 / 3),
        ("-x**2", -9.0),
        ("2**-2", 0.25),
        ("x**0.5", math.sqrt(3)),
        ("x**(-1.5)", 3**-1.5),
        ("der(x) + 1", -0.5),
        ("+x - -x", 6.0),
        ("max(sin(pi/2), cos(0.5))", 1.0),
        ("beta + S + E", 18.25),
        ("1.5e3 / 3", 500.0),
        ("(1 + 2) * (3 - 4) / 5", -0.6),
        (" 7 ", 7.0),
    ],
)
def test_values(text: str, expected: float) -> None:
    values = {**VALUES, "pi": math.pi}
    assert float(parse(text).evaluate(Floats(), values)) == pytest.approx(expected, rel=1e-15)


def test_decimals_stay_exact() -> None:
    assert parse("0.1 + 0.2").evaluate(Floats(), {}) == Fraction(3, 10)
    assert parse("1/3").evaluate(Floats(), {}) == Fraction(1, 3)


def test_names_in_order() -> None:
    assert list(parse("a*b + der(c)*a").names()) == ["a", "b", "der(c)", "a"]


@pytest.mark.parametrize(
    "text",
    [
        "",
        " ",
        "1 +",
        "(1",
        "1)",
        "a b",
        "a = 1",
        "a == b",
        "a < b",
        "a and b",
        "not a",
        "a if b else c",
        "lambda: 1",
        "[1, 2]",
        "{1: 2}",
        "(1, 2)",
        "a[0]",
        "a.b",
        "a.__class__",
        "().__class__.__bases__[0].__subclasses__()",
        "__import__('os').system('touch /tmp/canary')",
        "open('/etc/passwd')",
        "eval('1')",
        "exec('1')",
        "print(1)",
        "getattr(a, 'b')",
        "'text'",
        "b'bytes'",
        "f'{a}'",
        "'{0.__class__}'.format(a)",
        "True",
        "None",
        "...",
        "1j",
        "a @ b",
        "a // b",
        "a % b",
        "a << 2",
        "a | b",
        "~a",
        "a ^ 2",
        "a := 1",
        "(a := 1)",
        "*a",
        "sin()",
        "sin(1, 2)",
        "sin(x=1)",
        "sin(*a)",
        "atan2(1)",
        "Sin(1)",
        "der()",
        "der(1)",
        "der(a + b)",
        "der(der(a))",
        "1_000",
        "0x10",
        "0b1",
        "0o7",
        "010",
        "1e999",
        "1e-999",
        "1" * 400,
        "9**9**9",
        "9**99999",
        "2**1e9",
        "a**b",
        "a**-b",
        "a**0.3",
        "a**1000",
        "x # comment",
        "x\ny",
        "x\x00y",
        "x; y",
        "x\\",
        "αβ",
        "ｘ",
        "x⁄y",
        "yield x",
        "await x",
        "[i for i in x]",
        "import os",
        "{{ x }}",
        "{% raw %}",
        "$x",
        "`x`",
        "1/0",
        "1/0.0",
        "(" * 300 + "1" + ")" * 300,
        "-" * 5000 + "1",
        "+".join(["a"] * 6000),
        "sin(" * 150 + "1" + ")" * 150,
        "a*" * 6000 + "a",
    ],
    ids=lambda text: ascii(text[:30]),
)
def test_what_is_no_expression_is_refused_at_once(text: str) -> None:
    start = time.process_time()
    with pytest.raises(ModelError) as caught:
        parse(text)
    assert time.process_time() - start < 10
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize("text", ["((2**64)**64)**64", "(1/3)**64 * ((7**60)**60)**60"])
def test_huge_numbers_are_refused_when_they_would_arise(text: str) -> None:
    with pytest.raises(ModelError, match="too large"):
        parse(text).evaluate(Floats(), {})


def test_an_unknown_name_is_named() -> None:
    with pytest.raises(ModelError, match="mass is not known here; known: m, l"):
        parse("2*mass").evaluate(Floats(), {"m": 1, "l": 2})


def test_columns_are_said() -> None:
    with pytest.raises(ModelError, match=r"column 5"):
        parse("1 + a.b")


@pytest.mark.parametrize("seed", range(5))
def test_random_expressions_agree_with_python(seed: int) -> None:
    """Python's own arithmetic over the same text is the independent reference."""
    draw = random.Random(seed)

    def text(depth: int) -> str:
        if depth == 0:
            return draw.choice(["m", "l", "x", "2", "0.5", "1.25e1"])
        kind = draw.randrange(6)
        if kind == 0:
            return f"-({text(depth - 1)})"
        if kind == 1:
            return f"({text(depth - 1)})**{draw.randrange(1, 4)}"
        operator = draw.choice("+-*/")
        return f"({text(depth - 1)}) {operator} ({text(depth - 1)})"

    for _ in range(60):
        written = text(4)
        code = compile(ast.parse(written, mode="eval"), "reference", "eval")
        try:
            expected = eval(code, {"__builtins__": {}}, dict(VALUES))
        except (ZeroDivisionError, OverflowError):
            continue
        if abs(expected) < 1e50:
            assert value(written) == pytest.approx(expected, rel=1e-12, abs=1e-12)


def test_a_formula_is_data() -> None:
    assert parse("a + 1") == Formula("+", (Formula("name", ("a",)), Formula("number", (1,))))


# ---- variables of edges and points


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("position(arm).x", ["position(arm).x"]),
        ("position(arm.tip).y", ["position(arm.tip).y"]),
        ("velocity( arm . tip ) . z", ["velocity(arm.tip).z"]),
        ("2*force(knee).x**2 - a", ["force(knee).x", "a"]),
        ("across(strut) + through(strut)", ["across(strut)", "through(strut)"]),
        ("sqrt(torque(x).x/der(x))", ["torque(x).x", "der(x)"]),
        ("acceleration(x.y).z*angular_acceleration(x).x", None),
        ("-angular_velocity(x).x", ["angular_velocity(x).x"]),
    ],
)
def test_variables_are_names(text: str, names: list[str] | None) -> None:
    found = list(parse(text).names())
    assert found == names or (names is None and len(found) == 2)
    values = {name: 1.5 + k for k, name in enumerate(found)}
    assert math.isfinite(float(parse(text).evaluate(Floats(), values)))
    for name in found:
        assert list(parse(name).names()) == [name]


def test_a_variable_is_taken_apart_as_it_was_written() -> None:
    assert variable_of("position(arm.tip).x") == ("position", "arm.tip", "x")
    assert variable_of("across(strut)") == ("across", "strut", "")
    for other in ("der(x)", "x", "sin(x)", "positions(x).x"):
        assert variable_of(other) is None
    assert set(VARIABLES) - set(VECTORS) == {"across", "through"}


def test_a_variable_is_data() -> None:
    expected = Formula("variable", ("position", "arm.tip", "x"))
    assert parse("position(arm.tip).x") == expected


def test_an_unknown_variable_is_named() -> None:
    with pytest.raises(ModelError, match=r"position\(arm\)\.x is not known here; known: m"):
        parse("m + position(arm).x").evaluate(Floats(), {"m": 1})


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("position(a)", r"position is a vector: add .x, .y or .z"),
        ("force(a) + 1", r"force is a vector: add .x, .y or .z"),
        ("position(a).w", "components x, y and z, not w"),
        ("position(a).real", "components x, y and z, not real"),
        ("position(a).__class__", "components x, y and z, not __class__"),
        ("position().x", r"position takes one name, as in position\(arm.tip\)"),
        ("position(a, b).x", "takes one name"),
        ("position(1).x", "takes one name"),
        ("position(a + b).x", "takes one name"),
        ("position('a').x", "takes one name"),
        ("position(a=b).x", "takes one name"),
        ("position(*a).x", "takes one name"),
        ("position(a.b.c).x", "takes one name"),
        ("position(a().b).x", "takes one name"),
        ("position(a[0]).x", "takes one name"),
        ("position(position(a).x).x", "takes one name"),
        ("position(a).x.y", "may stand here"),
        ("position(a).x(1)", "may stand here"),
        ("position(a)(b)", "may stand here"),
        ("position.x", "may stand here"),
        ("a.b", "may stand here"),
        ("a.b.c", "may stand here"),
        ("(1).real", "may stand here"),
        ("(1 + a).x", "may stand here"),
        ("sin(a).x", "may stand here"),
        ("across(a).x", "may stand here"),
        ("(position)(a).y.z", "may stand here"),
        ("os.system(a).x", "may stand here"),
        ("across()", "across takes one name"),
        ("through(a, b)", "through takes one name"),
        ("across(sin(a))", "across takes one name"),
        ("der(position(a).x)", "der takes one name"),
        ("position(a).x(", "not an expression"),
        ("a**position(b).x", "an exponent must be"),
    ],
)
def test_what_is_no_variable_is_refused_with_a_hint(text: str, hint: str) -> None:
    with pytest.raises(ModelError, match=hint) as caught:
        parse(text)
    assert "column" in str(caught.value) or "not an expression" in str(caught.value)
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize(
    "thing", ["__class__", "__import__", "a.__dict__", "self", "print", "_", "x.__init__", "None_"]
)
def test_hostile_names_of_variables_are_looked_up_and_nothing_else(thing: str) -> None:
    """A name is a text: it is found in the mapping or it is unknown."""
    for kind in ("position", "force"):
        formula = parse(f"{kind}({thing}).x")
        assert list(formula.names()) == [f"{kind}({thing}).x"]
        with pytest.raises(ModelError, match="is not known here"):
            formula.evaluate(Floats(), {})
        assert formula.evaluate(Floats(), {f"{kind}({thing}).x": 2}) == 2


def test_a_name_cannot_look_like_a_variable() -> None:
    """What stands in brackets is a name: brackets of its own would end it."""
    for text in ("position(a).x).x", "position(a.x)", "position(a).x .y", "position(a;b).x"):
        with pytest.raises(ModelError):
            parse(text)


@pytest.mark.parametrize("letters", [1_000, 9_000])
def test_long_names_of_variables_are_bounded(letters: int) -> None:
    name = "a" * letters
    start = time.process_time()
    assert list(parse(f"position({name}).x").names()) == [f"position({name}).x"]
    with pytest.raises(ModelError) as caught:
        parse(f"position({name})")
    assert len(str(caught.value)) < 400
    assert time.process_time() - start < 10


@pytest.mark.parametrize("count", [200, 3_000])
def test_chains_of_attributes_are_refused_at_once(count: int) -> None:
    start = time.process_time()
    for text in ("a" + ".x" * count, "position(a" + ".x" * count + ").x", "position(a).x" * count):
        with pytest.raises(ModelError) as caught:
            parse(text)
        assert len(str(caught.value)) < 400
    assert time.process_time() - start < 10

"""Modules made by hand, for the tests of code generation, and their values computed without it."""

from __future__ import annotations

import math
import random
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from linegraph.ir.dag import ADD, DIV, MUL, NEG, SUB, SYMBOL, Dag, Node, Operand
from linegraph.ir.program import (
    Argument,
    Call,
    Check,
    Guards,
    Module,
    Program,
    Quantity,
    Result,
    assemble,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Values = dict[str, Any]

P = Argument("p", None, "the parameters")
T = Argument("t", None, "time in s")
Q = Argument("q", 2, "positions", "NQ")
V = Argument("v", 2, "velocities", "NV")
U = Argument("u", 2, "inputs", "NU")

SINGULAR = "the mass matrix is singular"


def evaluate(module: Module, name: str, values: Mapping[str, Any]) -> Values:
    """The results of a function, flat, straight from the DAG; raises ArithmeticError if a check fails."""
    program = next(x for x in module.programs if x.name == name)
    known = dict(values)
    for call in program.calls:
        known |= evaluate(module, call.program, {key: known[key] for key in call.arguments})
    for check in program.checks:
        if not value(check.node, known) > value(check.bound, known):
            raise ArithmeticError(check.about)
    return {x.name: [value(entry, known) for entry in x.entries] for x in program.results}


_OPERATIONS: dict[str, Callable[..., float]] = {
    ADD: lambda a, b: a + b,
    SUB: lambda a, b: a - b,
    MUL: lambda a, b: a * b,
    DIV: lambda a, b: a / b,
    NEG: lambda a, _: -a,
    "sin": lambda a, _: math.sin(a),
    "cos": lambda a, _: math.cos(a),
    "sqrt": lambda a, _: math.sqrt(a),
}


def value(x: Operand, values: Mapping[str, Any]) -> float:
    """One node's value; floats for all numbers, as emitted code has them."""
    done: dict[int, float] = {}

    def look(operand: Any) -> float | None:
        if isinstance(operand, Node):
            return done.get(operand.index)
        return None if operand is None else float(operand)

    pending = [x] if isinstance(x, Node) else []
    while pending:
        node = pending[-1]
        if node.op == SYMBOL:
            argument = values[node.a]
            done[node.index] = argument if node.b is None else argument[node.b]
            pending.pop()
            continue
        missing = [y for y in (node.a, node.b) if isinstance(y, Node) and y.index not in done]
        pending += missing
        if not missing:
            done[node.index] = _OPERATIONS[node.op](look(node.a), look(node.b))
            pending.pop()
    return done[x.index] if isinstance(x, Node) else float(x)


def coordinates(count: int, prefix: str = "joint") -> tuple[Quantity, ...]:
    return tuple(Quantity(f"{prefix}_{i}", "rad", f"angle of {prefix} {i}") for i in range(count))


def solve(calls: str, arguments: tuple[Argument, ...]) -> Program:
    """Forward dynamics of two coordinates: M a = u - h, from the results of another function."""
    dag = Dag()
    a, b, c = (dag.symbol("M", i) for i in (0, 1, 3))
    rest = [dag.symbol("u", i) - dag.symbol("h", i) for i in (0, 1)]
    factor = b / a
    pivot = c - factor * b
    assert isinstance(pivot, Node)
    second = (rest[1] - factor * rest[0]) / pivot
    first = rest[0] / a - factor * second
    return assemble(
        "forward_dynamics",
        "Accelerations: solve M a = Q - h.",
        (*arguments, U),
        (Result("a", (2,), (first, second), "the accelerations", ("NV",)),),
        Guards(
            (Check(a, 0, 1, SINGULAR), Check(pivot, 1e-12 * c, 1, SINGULAR)),
            (
                Call(
                    calls,
                    tuple(argument.name for argument in arguments),
                    (Argument("M", 4, "the mass matrix"), Argument("h", 2, "the bias")),
                ),
            ),
        ),
    )


def arm() -> Module:
    """Two coordinates with parameters, time, a call, checks, fractions, zeros and turned signs."""
    dag = Dag()
    q, v = ([dag.symbol(x, i) for i in (0, 1)] for x in "qv")
    m, inertia, t = dag.symbol("p", "m"), dag.symbol("p", "I"), dag.symbol("t")
    dag.label = 'link "upper"'
    shared = m * dag.cos(q[1]) * Fraction(1, 3)
    mass = (shared + inertia + 2, 0 - shared, 0 - shared, inertia * 1.5 + m)
    dag.label = "gravity"
    weight = 9.81 * m * dag.sin(t)
    apart = q[0] - q[1]
    bias = (weight * v[0] - v[1] * (q[1] - q[0]), -(weight * v[0] + -3 * v[1]))
    M = Result("M", (2, 2), mass, "the mass matrix", ("NV", "NV"))
    h = Result("h", (2,), bias, "the bias", ("NV",))
    E = Result("E", (2,), (dag.sqrt(1 + apart * apart), 0), "kinetic and potential energy")
    listed = coordinates(2)
    return Module(
        "arm",
        ("A double pendulum.",),
        listed,
        listed,
        listed,
        (Quantity("m", "kg", "mass", 1.5), Quantity("I", "kg m²", "inertia", 0.1)),
        True,
        (
            assemble("mass_matrix", "The mass matrix M(q).", (P, Q), (M,)),
            assemble("bias", "The bias h(q, v).", (P, T, Q, V), (h,)),
            assemble("equations", "M and h at once.", (P, T, Q, V), (M, h)),
            assemble("energy", "Energies.", (P, Q, V), (E,)),
            solve("equations", (P, T, Q, V)),
        ),
    )


def constant() -> Module:
    """No parameters, no inputs, and a mass matrix that depends on nothing."""
    dag = Dag()
    q = [dag.symbol("q", i) for i in (0, 1)]
    h = (dag.sin(q[0]), 0)
    listed = coordinates(2)
    M = Result("M", (2, 2), (2, 0, 0, Fraction(1, 3)), "the mass matrix")
    return Module(
        "plain",
        (),
        listed,
        listed,
        (),
        (),
        False,
        (
            assemble("mass_matrix", "M.", (Q,), (M,)),
            assemble("equations", "Both.", (Q, V), (M, Result("h", (2,), h, "the bias"))),
            assemble("driven", "None.", (Q, Argument("u", 0, "inputs")), (M,)),
        ),
    )


def single(program: Program, name: str = "one", size: int = 2) -> Module:
    """A module of one function."""
    listed = coordinates(size)
    return Module(name, (), listed, listed, listed, (), False, (program,))


def random_module(rng: random.Random, count: int, functions: bool) -> tuple[Module, list[float]]:
    """Many random functions of q and a point near which all their values are moderate."""
    point = [rng.uniform(0.5, 2.0) for _ in range(4)]
    q = Argument("q", len(point), "positions")
    programs = []
    for i in range(count):
        dag = Dag()
        entries = tuple(_random_pool(rng, dag, point, functions)[-8:])
        results = (Result("y_out", (len(entries),), entries, "values"),)
        programs.append(assemble(f"f{i}", "Random.", (q,), results))
    listed = coordinates(len(point))
    return Module("chance", (), listed, listed, (), (), False, tuple(programs)), point


def _random_pool(
    rng: random.Random, dag: Dag, point: list[float], functions: bool
) -> list[Operand]:
    pool: list[Operand] = [dag.symbol("q", i) for i in range(len(point))]
    numbers = (2, -3, 0.1, -0.7, Fraction(1, 3), Fraction(-7, 2), 1e-5, 1.25e3)
    steps = 12 if functions else rng.randint(5, 60)
    while len(pool) < steps:
        a = rng.choice(pool)
        b = rng.choice(pool) if rng.random() < 0.7 else rng.choice(numbers)
        kind = rng.randrange(9 if functions else 6)
        if kind < 5:
            x = (dag.add, dag.subtract, dag.multiply, dag.divide, dag.subtract)[kind](a, b)
        elif kind == 5:
            x = dag.negate(a)
        else:
            x = (dag.sin, dag.cos, lambda y: dag.sqrt(dag.add(dag.multiply(y, y), 1)))[kind - 6](a)
        if isinstance(x, Node) and 1e-3 < abs(value(x, {"q": point})) < 1e3:
            dag.label = rng.choice(("", "one part", "another"))
            pool.append(x)
    return pool


def large_module(nodes: int = 40_000, size: int = 38) -> Module:
    """As many operations as the equations of a humanoid have, in functions of the same shapes."""
    rng = random.Random(1)
    q, v = Argument("q", size, "positions"), Argument("v", size, "velocities")
    shapes: dict[str, dict[str, tuple[int, ...]]] = {
        "mass_matrix": {"M": (size, size)},
        "bias": {"h": (size,)},
        "equations": {"M": (size, size), "h": (size,)},
        "forward_dynamics": {"a": (size,)},
    }
    programs = []
    for name, results in shapes.items():
        dag = Dag()
        pool = [dag.symbol(x, i) for x in "qv" for i in range(size)]
        pool += [x for y in pool[:size] for x in (dag.sin(y), dag.cos(y)) if isinstance(x, Node)]
        while len(pool) < nodes // len(shapes):
            dag.label = f"link {len(pool) // 400}"
            other = rng.choice(pool[-300:]) if rng.random() < 0.7 else rng.random()
            operation = rng.choice((dag.multiply, dag.multiply, dag.add, dag.subtract))
            x = operation(pool[-1] if rng.random() < 0.5 else rng.choice(pool[-400:]), other)
            if isinstance(x, Node):
                pool.append(x)
        made = tuple(
            Result(key, shape, tuple(rng.choices(pool[-1500:], k=math.prod(shape))), key)
            for key, shape in results.items()
        )
        programs.append(assemble(name, name, (q, v), made))
    listed = coordinates(size)
    return Module("humanoid", (), listed, listed, listed, (), False, tuple(programs))


HOSTILE = (
    "*/",
    "*/ int evil(void); /*",
    "/*",
    "//",
    "/",
    "*",
    "**/",
    "*//*",
    "/*/",
    "*\\\n/ evil",
    "// evil \\",
    "\\",
    "\\\\",
    "ends in a backslash \\",
    "??/",
    "??/\n evil",
    "???/",
    "*??/\n/",
    "??=define evil",
    "??'??(??)??!??<??>??-",
    '"',
    '""',
    '"""',
    '""""',
    '"""\nimport evil\n"""',
    'ends in a quote"',
    '\\"""',
    "'",
    "'''",
    "\"'",
    "\n",
    "line\nevil()",
    "line\r\nevil()",
    "line\revil()",
    "tab\tand\vand\f",
    "\x00",
    "a\x00b",
    "\x1b[31mred",
    "\x7f",
    "\x85next line",
    "\u2028evil()",
    "\u2029evil()",
    "\u202eevil\u202c",
    "\u2066evil\u2069",
    "\u200b\ufeff",
    "＊／ evil",
    "＂＂＂",
    "＼",
    "раураl",
    "ﬀ ℀ ½",
    "𝐪 🤖",
    "\ud800",
    "%n%s%x",
    "{0.__class__}",
    "{{ 7 * 7 }}{% raw %}",
    "#define evil 1",
    "#",
    "\\N{BULLET}\\x\\u12\\U1",
    "\\0\\777\\n",
    "$(evil) `evil`",
    "type: ignore",
    "type: (evil",
    " coding: latin-1",
    "noqa",
    "@param \\param evil",
    "-*-",
    "",
    " ",
    "x" * 900,
    "x " * 400,
    "*/" * 300,
    '_Pragma("evil")',
    "\\u002a/",
    "&#42;/",
    "<!-- -->",
)
"""Texts that must never become code."""


def hostile(text: str) -> Module:
    """A module that has `text` wherever a model or a derivation may put a text."""
    dag = Dag()
    q, k = dag.symbol("q", 0), dag.symbol("p", "k")
    dag.label = text
    square = q * q + 1
    dag.label = "harmless"
    root = dag.sqrt(square) * k
    assert isinstance(square, Node)
    M = Result("M", (1, 1), (root * root + root,), text)
    check = Check(square, 0, 1, text)
    arguments = (Argument("p", None, text), Argument("q", 1, text))
    quantity = (Quantity(text, text, text),)
    return Module(
        "arm",
        (text, f"Text: {text}"),
        quantity,
        quantity,
        quantity,
        (Quantity("k", text, text, 1.0),),
        False,
        (
            assemble("mass_matrix", text, arguments, (M,), Guards((check,))),
            assemble("square", f"Text: {text}", arguments, (M,), Guards((check,))),
        ),
    )


def with_parameters(*names: str) -> Module:
    """A module without arguments but these parameters."""
    listed = tuple(Quantity(name, "", "", 1.0) for name in names)
    return replace(constant(), parameters=listed)

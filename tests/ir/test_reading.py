"""Algorithms read into statements: what is read, what is refused, and what a model decides."""

from __future__ import annotations

import importlib.util
import sys
from typing import TYPE_CHECKING, Any

import pytest

from linegraph.ir import binding, reading
from linegraph.ir import statements as ir
from linegraph.ir.program import Argument, Result, Routine
from linegraph.ir.statement_walks import expressions, nested, operands

if TYPE_CHECKING:
    from pathlib import Path

HEAD = """
from __future__ import annotations
from linegraph.ir.algorithms.language import Failed, infinity, ints, larger, ratio, reals, small
from linegraph.ir.statuses import NOT_CLOSED
TABLE = (0.5, 1.5)
MOST = 7
SHARE = 0.25
"""


def read(folder: Path, text: str, name: str = "f") -> ir.Procedure:
    """A function of a file, read."""
    count = len(list(folder.iterdir()))
    path = folder / f"algorithm{count}.py"
    path.write_text(HEAD + text)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    try:
        return reading.procedure(getattr(module, name))
    finally:
        del sys.modules[path.stem]


def test_statements_are_those_of_the_text(tmp_path: Path) -> None:
    made = read(
        tmp_path,
        """
def f(n: int, x: Reals, y: Reals) -> float:
    \"\"\"A sum.

    Of more.
    \"\"\"
    total = SHARE
    table = TABLE
    # the first counts twice
    for i in range(n):
        total += x[i] * table[1]
        if not total < infinity or n == MOST:
            return total
    y[0] = -total
    return total
""",
    )
    total = ir.LocalVariable("total", ir.ValueKind.REAL)
    i = ir.LocalVariable("i", ir.ValueKind.INT)
    assert made.about == ("A sum.", "", "Of more.")
    assert [(p.name, p.array, p.written) for p in made.parameters] == [
        ("n", False, False),
        ("x", True, False),
        ("y", True, True),
    ]
    assert made.returns is ir.ValueKind.REAL
    assert made.body[:3] == (
        ir.Let("total", ir.ValueKind.REAL, ir.Literal(0.25), final=False),
        ir.ConstantTable("table", ir.ValueKind.REAL, (0.5, 1.5)),
        ir.Remark("the first counts twice"),
    )
    loop = made.body[3]
    assert isinstance(loop, ir.For)
    assert (loop.start, loop.step) == (ir.Literal(0), 1)
    product = ir.Operation(
        "*",
        ir.ArrayEntry("x", i, ir.ValueKind.REAL),
        ir.ArrayEntry("table", ir.Literal(1), ir.ValueKind.REAL),
        ir.ValueKind.REAL,
    )
    assert loop.body[0] == ir.Assign(total, "+", product)
    test = loop.body[1]
    assert isinstance(test, ir.If)
    assert isinstance(test.test, ir.Operation)
    assert test.test.operator == "or"
    assert test.test.b == ir.Operation(
        "==",
        ir.LocalVariable("n", ir.ValueKind.INT),
        ir.NamedNumber("MOST", 7),
        ir.ValueKind.BOOL,
    )
    assert made.body[5] == ir.Return(total)


REFUSED = {
    "with open('x') as y:\n        pass": "none of the statements",
    "x[0] = [1.0][0]": "",
    "x[0] = n": "do not meet",
    "x[0] = 1 + 2.0": "int and real do not meet",
    "x[0] = n / 2": "",
    "x[0] = total": "not known here",
    "for i in x:\n        x[0] = 1.0": "",
    "if n:\n        x[0] = 1.0": "a condition is true or false",
    "if x[0] < 1:\n        x[0] = 1.0": "do not meet",
    "if x[0] < 1.0:\n        y = 1.0\n    x[0] = y": "not known here",
    "print(n)": "a call",
    "x[0] = max(x[0], 1.0)": "none of the functions",
    "x[0] = larger(n, 1)": "larger takes real numbers",
    "raise ValueError": "none of the statements",
    "raise Failed(n)": "raised with a status",
    "g(n, n)": "",
    "g(1.0, x)": "n is int",
    "g(n, x[1:])": "",
    "h(x[1:])": "give a whole array of your own",
    "x = 1.0": "x is an array",
    "x[0] = x": "x is an array",
    "y = g": "not known here",
    "x[0] = 1.0 if n > 0 else 1": "do not meet",
    "x[0] = 1.0 < 2.0 < 3.0": "none of the expressions",
    "y, z = 1.0, 2.0": "none of the expressions",
    "lambda: 0": "none of the statements",
}


@pytest.mark.parametrize("line", REFUSED)
def test_what_is_no_statement_is_refused_with_its_line(line: str, tmp_path: Path) -> None:
    others = """
def g(n: int, x: Reals) -> None:
    '''Nothing.'''
    y = x[0] + float(n)

def h(x: Reals) -> None:
    '''Writes.'''
    x[0] = 1.0
"""
    if line == "g(n, x[1:])":
        assert read(tmp_path, f"{others}\ndef f(n: int, x: Reals) -> None:\n    {line}\n")
        return
    with pytest.raises(ValueError, match=r"algorithm\d\.py, line \d+: ") as caught:
        read(tmp_path, f"{others}\ndef f(n: int, x: Reals) -> None:\n    {line}\n")
    assert REFUSED[line] in str(caught.value)


ROUTINE = Routine(
    "close",
    "",
    (Argument("q", 2, ""), Argument("v", 2, "")),
    (Result("q_on", (2,), (), ""), Result("v_on", (2,), (), "")),
    "project",
    (),
    (
        *("mass_matrix", "constraint_jacobian", "constraint_rates", "constraint_sizes"),
        *("coordinate_rates", "constraints"),
    ),
)


def around(**counts: int) -> binding.Surroundings:
    def called(name: str, results: int) -> Any:
        arguments = (Argument("q", 2, ""), Argument("v", 2, ""))
        given = tuple(Result(f"r{k}", (2,), (), "") for k in range(results))
        return Routine(name, "", arguments, given, "", (), ())

    results = dict.fromkeys(ROUTINE.uses, 1) | {"constraint_sizes": 2}
    programs = {name: called(name, count) for name, count in results.items()}
    return binding.Surroundings(programs, counts, frozenset())


def details(routine: Routine, **values: Any) -> Routine:
    return Routine(**{**vars(routine), "details": tuple(values.items())})


@pytest.mark.parametrize("quaternions", [(), (3,)])
@pytest.mark.parametrize("positions", [0, 1])
def test_nothing_is_left_of_what_a_model_has_not(
    quaternions: tuple[int, ...], positions: int
) -> None:
    routine = details(ROUTINE, quaternions=quaternions, position_rank=1)
    found = {
        x.name: x for x in binding.bound(routine, around(NQ=2, NV=2, NC=1, NP=positions, RANK=1))
    }
    assert list(found)[-1] == "project"
    assert ("unit" in found) == bool(quaternions)
    assert ("close" in found) == ("approach" in found) == bool(positions)
    for x in found.values():
        for statement in nested(x.body):
            for whole in expressions(statement):
                assert not any(isinstance(y, ir.Detail) for y in operands(whole))
                assert all(y.value is not None for y in operands(whole) if isinstance(y, ir.Count))
    # the routine fails, and so does what it calls for that
    assert found["project"].fails
    if positions:
        assert found["close"].fails
        assert not found["approach"].fails
        assert found["approach"].context == ("v",)
        assert found["close"].uses
    assert not found["constrained"].uses


def test_what_a_routine_does_not_say_is_missed() -> None:
    counts = around(NQ=2, NV=2, NC=1, NP=1, RANK=1)
    with pytest.raises(ValueError, match="does not say position_rank"):
        binding.bound(details(ROUTINE, quaternions=()), counts)
    lacking = Routine(**{**vars(ROUTINE), "uses": ROUTINE.uses[1:]})
    with pytest.raises(ValueError, match="does not say that it calls mass_matrix"):
        binding.bound(details(lacking, quaternions=(), position_rank=1), counts)


def test_every_algorithm_is_read_and_calls_nothing_twice_named() -> None:
    names: dict[str, str] = {}
    for name in reading.ALGORITHMS:
        for procedure in reading.algorithm(name).values():
            about = "\n".join(procedure.about)
            assert names.setdefault(procedure.name, about) == about
            assert about.endswith(".")

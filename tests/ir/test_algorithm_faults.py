"""Faults in algorithms: a wrong sign, index or operator in one line is seen by the tests of algorithms.

A fault that is no statement any more is seen by the reader. Any other one is put into the running function
itself, so that all that call it have it; then the tests of algorithms run until one fails. A hundred and
fifty by default, all with ``--all-forms``.
"""

from __future__ import annotations

import ast
import contextlib
import copy
import importlib
import inspect
import random
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from linegraph.ir import reading
from linegraph.ir.reading import ALGORITHMS, WHERE

sys.path.insert(0, str(Path(__file__).parents[1] / "networks"))

import test_algorithm_details
import test_algorithm_newton
import test_algorithms
import test_algorithms_of_a_bead
import test_algorithms_of_a_particle
import test_network_newton

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import CodeType, FunctionType

MODULES = sorted(
    {*ALGORITHMS.values(), "elimination", "sizes", "constrained", "determined", "beside"}
)
TESTS = (
    test_algorithm_details,
    test_algorithm_newton,
    test_algorithms,
    test_algorithms_of_a_bead,
    test_algorithms_of_a_particle,
    test_network_newton,
)
FEW = 75
SWAPPED = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Add,
    ast.Div: ast.Mult,
    ast.Lt: ast.Gt,
    ast.LtE: ast.Gt,
    ast.Gt: ast.LtE,
    ast.GtE: ast.Lt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.And: ast.Or,
    ast.Or: ast.And,
}
INDICES = {"i": "j", "j": "i", "k": "i"}

JUDGED = (
    "result = constrained(*(module, NC, module.RANK, True, small.slack, most * most, M, f, J, gam, "
    "of_phi, of_v, a_on), *(True, lam_on, pure_on, margin))"
)
FINITE = (
    "if too_large(NV * WIDTH, slopes_f) + too_large(NC * WIDTH, slopes_gam) + "
    "too_large(NC * NT, slopes_rates) + too_large(NT * NT, drift) > 0:"
)
LATER = "the equations of a column are refused with the same status"
SAME_ERROR = "a state as far off on the same side tells the same error"
HARMLESS = {
    "move: at[i] += slope[i]  ->  at[i] -= slope[i]": SAME_ERROR,
    "state_beside: v_on[i] = v[i] + step[i]  ->  v_on[i] = v[i] - step[i]": SAME_ERROR,
    "least_multipliers: for i in range(rank - 1, -1, -1):  ->  for i in range(rank + 1, -1, -1):": (
        "the inner loop is empty for the rows beyond"
    ),
    "largest_force: total += M[i * NV + j] * a[j]  ->  total -= M[i * NV + j] * a[j]": (
        "only its size is used"
    ),
    "eliminate: side = m if m < n else n  ->  side = m if m > n else n": (
        "beyond the smaller side there are no entries, and so no pivot"
    ),
    "is_only: ahead[i] = at[i] + PROBE * float(way) * ratio(step[i], reach)  ->  "
    "ahead[i] = at[i] - PROBE * float(way) * ratio(step[i], reach)": "both sides are tried",
    "is_rounding: more += 1  ->  more -= 1": "only zero is none",
    f"compare_accelerations: {JUDGED}  ->  {JUDGED.replace('most * most', 'most + most')}": (
        "contradictions of the given state were judged before, by the square of speeds"
    ),
    f"linearization: {FINITE}  ->  {FINITE.replace('+ too_large(NC * N', '- too_large(NC * N')}": LATER,
    f"linearization: {FINITE}  ->  {FINITE.replace('+ too_large(NC * W', '- too_large(NC * W')}": LATER,
    f"linearization: {FINITE}  ->  {FINITE.replace('NV * WIDTH', 'NV + WIDTH')}": LATER,
    "reduced_equations: Mr[k * NI + j] = 0.0  ->  Mr[k * NI - j] = 0.0": (
        "all entries are set in another order, as Python counts from the end"
    ),
    "compare_tangents: step[NC + k] = 0.0  ->  step[NC - k] = 0.0": (
        "what stands there is a correction of positions, of the size of rounding"
    ),
}
"""Faults that change no result, and why."""


def functions() -> Iterator[FunctionType]:
    """All functions of algorithms."""
    for name in MODULES:
        module = importlib.import_module(f"{WHERE}.{name}")
        for found in vars(module).values():
            if inspect.isfunction(found) and found.__module__ == module.__name__:
                yield found


def tree(function: FunctionType) -> ast.Module:
    """The text of a function, its description and annotations left out."""
    made = ast.parse(inspect.getsource(function))
    (node,) = made.body
    assert isinstance(node, ast.FunctionDef)
    node.body = node.body[1:]
    node.returns = None
    for argument in node.args.args:
        argument.annotation = None
    return made


def faults(function: FunctionType) -> Iterator[tuple[str, ast.Module]]:
    """Each fault of a function: its line before and after, and the text with it."""
    whole = tree(function)
    extents = {
        id(inner)
        for call in ast.walk(whole)
        if isinstance(call, ast.Call) and ast.unparse(call.func) in ("reals", "ints")
        for inner in ast.walk(call)
    }
    for place, node in enumerate(ast.walk(whole)):
        # an array that is too large harms nothing
        for change in changes(node) if id(node) not in extents else ():
            wrong = copy.deepcopy(whole)
            other = next(x for k, x in enumerate(ast.walk(wrong)) if k == place)
            change(other)
            lines = zip(ast.unparse(whole).split("\n"), ast.unparse(wrong).split("\n"), strict=True)
            (changed,) = [(a.strip(), b.strip()) for a, b in lines if a != b]
            yield f"{function.__name__}: {changed[0]}  ->  {changed[1]}", wrong


def changes(node: ast.AST) -> Iterator[Callable[[Any], None]]:
    """What can be made wrong at one place."""
    if isinstance(node, ast.BinOp | ast.AugAssign | ast.BoolOp) and type(node.op) in SWAPPED:
        wrong = SWAPPED[type(node.op)]
        yield lambda x: setattr(x, "op", wrong())
    if isinstance(node, ast.Compare):
        other = SWAPPED[type(node.ops[0])]
        yield lambda x: setattr(x, "ops", [other()])
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        sign = ast.UAdd if isinstance(node.op, ast.USub) else None
        if sign is not None and not isinstance(node.operand, ast.Constant):
            yield lambda x: setattr(x, "op", ast.UAdd())
        elif sign is None:
            yield lambda x: x.__dict__.update(
                op=ast.Not(), operand=ast.UnaryOp(ast.Not(), x.operand)
            )
    if isinstance(node, ast.Subscript) and not isinstance(node.slice, ast.Slice):
        for inner in ast.walk(node.slice):
            if isinstance(inner, ast.Name) and inner.id in INDICES:
                yield renamed_index
                break


def renamed_index(node: Any) -> None:
    """Another index than the one that stands there first."""
    for inner in ast.walk(node.slice):
        if isinstance(inner, ast.Name) and inner.id in INDICES:
            inner.id = INDICES[inner.id]
            return


def is_read(function: FunctionType, wrong: ast.Module) -> bool:
    """Whether the reader takes the text: an index that stands for nothing it refuses."""
    given = ast.parse(inspect.getsource(function)).body[0]
    (node,) = copy.deepcopy(wrong).body
    assert isinstance(node, ast.FunctionDef)
    assert isinstance(given, ast.FunctionDef)
    node.args, node.returns = given.args, given.returns
    text = reading._text(importlib.import_module(function.__module__))
    try:
        reading._ProcedureReader(text, node).procedure()
    except ValueError:
        return False
    return True


def code_of(function: FunctionType, wrong: ast.Module) -> CodeType:
    """The code of a function with other text."""
    space = dict(function.__globals__)
    exec(compile(ast.fix_missing_locations(wrong), "fault", "exec"), space)
    found: CodeType = space[function.__name__].__code__
    return found


@contextlib.contextmanager
def faulty(function: FunctionType, wrong: ast.Module) -> Iterator[None]:
    """The function has the fault, for all that call it."""
    right = function.__code__
    function.__code__ = code_of(function, wrong)
    try:
        yield
    finally:
        function.__code__ = right


def checks() -> list[Callable[[], None]]:
    """The tests, once for each set of parameters."""
    found: list[Callable[[], None]] = []
    for module in TESTS:
        for name, test in vars(module).items():
            if name.startswith("test_"):
                found += [
                    lambda test=test, given=given: test(**given) for given in parameters(test)
                ]
    return found


def parameters(test: Any) -> list[dict[str, Any]]:
    """What a test is called with."""
    sets: list[dict[str, Any]] = [{}]
    for mark in getattr(test, "pytestmark", ()):
        if mark.name != "parametrize":
            continue
        names, values = mark.args
        names = [names] if isinstance(names, str) else names
        rows = [
            dict(zip(names, [value] if len(names) == 1 else value, strict=True)) for value in values
        ]
        sets = [{**a, **b} for a in sets for b in rows]
    return sets


def seen(run: list[Callable[[], None]]) -> bool:
    """Whether a test fails."""
    for place, test in enumerate(run):
        try:
            test()
        except (Exception, pytest.fail.Exception):
            # what sees one fault is likely to see the next
            run.insert(0, run.pop(place))
            return True
    return False


@pytest.mark.filterwarnings("ignore")
def test_faults_are_seen(request: pytest.FixtureRequest) -> None:
    every = [(f, about, wrong) for f in functions() for about, wrong in faults(f)]
    assert len(every) > 300
    if not request.config.getoption("--all-forms"):
        every = random.Random(18).sample(every, FEW)
    run = checks()
    assert not seen(run)
    missed = []
    for function, about, wrong in every:
        if is_read(function, wrong):
            with faulty(function, wrong):
                if not seen(run):
                    missed.append(about)
    print(f"{len(every)} faults, {len(missed)} not seen")
    assert "\n".join(sorted(set(missed) - set(HARMLESS))) == ""

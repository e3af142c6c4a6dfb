"""Stack that headers state: never less than what compilers take, and not much more.

Compilers say what a frame takes and who calls whom (-fcallgraph-info=su); the sum along the deepest chain of
calls is measured, for this machine and for a Cortex-M4, without optimisation and with all of it.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any

import pytest
from support import targets
from support.targets import CORTEX_M4

import codegen
from codegen.c import frames, stack
from linegraph import Model
from linegraph.emission.emit import module_for
from linegraph.ir.program import counts_of

if TYPE_CHECKING:
    from pathlib import Path

FEW = ("furuta+", "four_bar+", "network3")
LEVELS = ("-O0", "-O2", "-O3")
MACHINES = {"gcc": ("gcc",), "arm": ("arm-none-eabi-gcc", *CORTEX_M4)}
NAMES = tuple(targets.everything())

MOST, SMALL = 3, 448
"""How many times what is measured may be stated, or how many bytes more."""


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "name" in metafunc.fixturenames:
        every = metafunc.config.getoption("--all-forms")
        metafunc.parametrize("name", NAMES if every else FEW)


def stated(header: str) -> dict[str, int]:
    """What a header says of each of its functions."""
    pattern = r"Takes at most (\d+) bytes of stack\.\n \*/\n(?:void|int) (\w+)\("
    return {name: int(size) for size, name in re.findall(pattern, header)}


def measured(folder: Path, machine: str, flags: tuple[str, ...]) -> dict[str, int]:
    """What each function takes with all that it calls, math functions left out."""
    command = [*MACHINES[machine], "-std=c99", *flags, "-fcallgraph-info=su", "-c", "model.c"]
    targets.run([*command, "-o", "model.o"], folder)
    graph = (folder / "model.ci").read_text()
    nodes = re.findall(r'node: \{ title: "([^"]+)" label: "[^"]*?(\d+) bytes \(([\w,]+)\)', graph)
    assert {kind for _, _, kind in nodes} <= {"static", "dynamic,bounded"}
    own = {name: int(size) for name, size, _ in nodes}
    calls: dict[str, set[str]] = {}
    for source, target in re.findall(
        r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"', graph
    ):
        calls.setdefault(source, set()).add(target)

    def depth(name: str, above: tuple[str, ...] = ()) -> int:
        assert name not in above, "recursion"
        below = [depth(x, (*above, name)) for x in calls.get(name, ()) if x in own]
        return own[name] + max(below, default=0)

    return {name.rpartition(":")[2]: depth(name) for name in own}


@pytest.mark.one_in(4)
@pytest.mark.parametrize("real", ["double", "float"])
def test_stack_is_stated_and_kept(name: str, real: str, tmp_path: Path) -> None:
    lacking = targets.missing("gcc", "arm-none-eabi-gcc")
    if lacking:
        pytest.skip(lacking)
    files = targets.emitted(name, real)
    for file, text in files.items():
        (tmp_path / file).write_text(text)
    said = stated(files["model.h"])
    assert set(said) == {f"model_{program.name}" for program in targets.module(name).programs}
    taken = {(m, o): measured(tmp_path, m, (o,)) for m in MACHINES for o in LEVELS}
    for function, size in said.items():
        found = {way: sizes[function] for way, sizes in taken.items()}
        worst = max(found.values())
        assert worst <= size, (function, found)
        assert size <= max(MOST * worst, worst + SMALL), (function, found)


@pytest.mark.parametrize("flags", [("-mavx512f",), ("-DMODEL_LANES=1",)])
@pytest.mark.parametrize("model", ["double_pendulum", "panda"])
def test_stack_of_vector_registers(model: str, flags: tuple[str, ...], tmp_path: Path) -> None:
    options = codegen.Options(trig="inline", batch=True)
    files = codegen.render(targets.module(model), "c", options)
    for file, text in files.items():
        (tmp_path / file).write_text(text)
    said = stated(files["model.h"])
    for level in ("-O0", "-O2"):
        taken = measured(tmp_path, "gcc", (level, *flags))
        for function, size in said.items():
            assert taken[function] <= size, (function, level)


# ---- records and text

COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
FUNCTION = re.compile(
    r"^[a-zA-Z][^\n;{}=]*?\bmodel_(\w+)\(([^;{}]*?)\)\n\{\n(.*?)^\}", re.DOTALL | re.MULTILINE
)
VARIABLES = re.compile(
    r"(?<=[\s(])(?:const )?(double|float|int|\w+_(?:lanes|bits|some)) ((?:\*const )?\w+(?:\[[^\]]+\])?"
    r"(?:, \w+(?:\[[^\]]+\])?)*)(?= =|;)"
)
SIZES = {"double": 8, "float": 4, "int": 4}


def value(text: str, known: dict[str, int]) -> int:
    """A sum of products of whole numbers and names, with brackets."""
    for name in sorted(known, key=len, reverse=True):
        text = re.sub(rf"\b{name}\b", str(known[name]), text)
    while inner := re.search(r"\(([^()]*)\)", text):
        text = text[: inner.start()] + str(value(inner[1], {})) + text[inner.end() :]
    return sum(math.prod(map(int, term.split("*"))) for term in text.split("+"))


def read_off(body: str, sizes: dict[str, int]) -> int:
    """Bytes of the variables in the text of a function."""
    known = sizes | dict.fromkeys(re.findall(r"\w+_LANES\b", body), 8)
    for entries in re.findall(r"\benum \{([^}]*)\}", body):
        for entry in entries.split(","):
            name, size = entry.split("=")
            known[name.strip()] = value(size, known)
    found = 0
    for kind, names in VARIABLES.findall(re.sub(r"\bstatic const [^;]*;", "", body)):
        for name in names.split(", "):
            size = re.search(r"\[(.*)\]", name)
            each = 8 if name.startswith("*") else SIZES.get(kind, 64)
            found += each * (value(size[1], known) if size else 1)
    return found


@pytest.mark.parametrize(
    ("of", "options"),
    [
        *((name, {}) for name in ("four_bar+", "bicycle", "mixed4", "panda", "rolling_disc")),
        ("four_bar+", {"real": "float"}),
        *((name, {"trig": "inline", "batch": True}) for name in ("double_pendulum", "panda")),
    ],
)
def test_records_say_what_the_text_does(
    of: str, options: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every variable and every call in the text of a function is in its record, and little else."""
    records: dict[str, frames.StackFrame] = {}
    bounds = stack.bounds
    monkeypatch.setattr(
        stack, "bounds", lambda known, real: (records.update(known), bounds(known, real))[1]
    )
    module, way = targets.module(of), codegen.Options(**options)
    source = COMMENT.sub("", codegen.render(module, "c", way)["model.c"])
    sizes = {f"MODEL_{x}": size for x, size in counts_of(module).items()}
    functions = {x: (head, body) for x, head, body in FUNCTION.findall(source)}
    assert len(functions) > len(module.programs)
    for function, (head, body) in functions.items():
        record = records[function]
        read = read_off(body, sizes)
        recorded = stack.variables(record, way.real)
        assert read <= recorded <= 1.1 * read + (300 if function == "turn" else 40), function
        called = set(re.findall(r"\bmodel_(\w+)\(", body)) & set(functions)
        assert called <= record.calls, function
        assert head.count(",") + 1 <= max(record.parameters, 1), function


def test_the_text_is_read_as_it_is_written() -> None:
    body = """    enum { N = ARM_NV, C = 2 };
    static const int place[3] = {0, 1, 2};
    double B[(N + C) * (N + 1)] = {0};
    const double *const row = &B[n];
    double sines[2], cosines[2 * 3];
    for (int i = 0; i < n; ++i) {
"""
    assert read_off(body, {"ARM_NV": 3}) == 8 * 5 * 4 + 8 + 8 * 8 + 4


def test_bounds_add_up_along_the_deepest_calls() -> None:
    def frame(*calls: str, doubles: int) -> frames.StackFrame:
        return frames.StackFrame(doubles=doubles, statements=0, parameters=1, calls={*calls, "sin"})

    known = {
        "top": frame("left", "right", doubles=4),
        "left": frame(doubles=8),
        "right": frame("end", doubles=0),
        "end": frame(doubles=16),
    }
    each = stack.CALL + 8
    found = stack.bounds(known)
    assert found["left"] == each + 80
    assert found["top"] == (each + 40) + each + (each + 160)
    assert stack.bounds(known, "float")["left"] == each + 40


def test_names_that_look_like_code_change_nothing() -> None:
    """Joints and bodies called like comments and functions: records know no text."""
    hostile = ("*/ int evil; /*", "*/\nint evil(void)\n{\n double x[999];\n}\n/*", "model_copy(")

    def taken(names: tuple[str, ...]) -> dict[str, int]:
        model = Model("model")
        before = model.ground
        for k, name in enumerate(names):
            body = model.body(f"{name} {k}", mass=1.0, mass_center=(0, 0, -0.3), inertia=(1, 1, 1))
            model.revolute(name, between=(before, body), axis=((0, 1, 0), (1, 0, 0))[k % 2])
            before = body
        files = codegen.render(module_for(model, "model"), "c", codegen.Options(report=True))
        assert "\nint evil" not in files["model.c"]
        return stated(files["model.h"])

    assert taken(hostile) == taken(("a", "b", "c"))

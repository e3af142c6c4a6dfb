"""Golden vectors as a program of each language that checks the emitted functions against them.

The program stands beside what it checks and needs nothing else: in C no library but <math.h> and, unless it
is told otherwise, <stdio.h>; in Python NumPy and pytest.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from codegen import failures, prose, templates
from codegen.declare import block, comment
from codegen.options import DEFAULT
from codegen.printer import number
from codegen.python import literal
from linegraph.ir.golden_vectors import CONSTANTS, RETURNED

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from codegen.options import Options
    from linegraph.ir.golden_vectors import Expected, Then, Vectors
    from linegraph.ir.program import Module, Program, Routine

DOUBLE = 5e-12
"""Rounding of a double is 1e-16; sums and solutions take some hundred times that, seldom a thousand times."""

SINGLE = 1e-4
"""Rounding of a float is 6e-8, that of the given state included; the same again."""

_WIDTH = 96


def in_c(module: Module, vectors: Vectors, options: Options) -> dict[str, str]:
    """The program in C that checks what `c.render` writes of a module: file name -> text."""
    file, module = module.name, replace(module, name=options.prefix or module.name)
    statuses = failures.statuses(module)
    given = {key: len(rows[0]) for key, rows in vectors.given.items()}
    text = templates.fill(
        "c/golden.c.jinja",
        file=file,
        sources=f"-I ../src {file}_test.c ../src/{file}.c"
        if options.arduino
        else f"{file}_test.c {file}.c",
        name=module.name,
        macro=module.name.upper(),
        real=options.real,
        width=max(24, *(len(x.label) for x in vectors.expected)),
        states=vectors.states,
        loud=vectors.loud,
        double=number(DOUBLE),
        single=number(SINGLE),
        about=block(_about(module, vectors, options)),
        given=[
            (key, size, _lines(x for row in vectors.given[key] for x in row))
            for key, size in given.items()
            if size
        ],
        parameters=vectors.parameters,
        values=[
            (
                key,
                math.prod(v.shape),
                _lines(x for row in v.rows for x in row),
                _lines(x for row in v.scales for x in row),
            )
            for key, v in vectors.values.items()
            if math.prod(v.shape)
        ],
        functions=[_called_in_c(module, vectors, x, given, statuses) for x in vectors.expected],
    )
    # a library of Arduino's compiles nothing of this folder by itself
    return {f"{file}/extras/{file}_test.c" if options.arduino else f"{file}_test.c": text}


def _called_in_c(
    module: Module,
    vectors: Vectors,
    expected: Expected,
    given: Mapping[str, int],
    statuses: Mapping[str, Any],
) -> dict[str, Any]:
    """A comparison: what is loaded, the call, what its results and those that follow are compared with."""

    def results(call: Expected | Then) -> list[tuple[str, str, int]]:
        """Of each result its name, its key and its size; the latter from the function itself."""
        program = _program(module, call.function)
        return [
            (result.name, key, math.prod(result.shape))
            for result, key in zip(program.results, call.results, strict=True)
        ]

    keys = [*expected.given, *(key for then in expected.then for key in then.given)]
    loaded = [
        key
        for key in dict.fromkeys(keys)
        if key not in ("t", CONSTANTS) and not key.startswith(RETURNED)
    ]
    calls: list[Expected | Then] = [expected, *expected.then]
    return {
        "label": expected.label,
        "name": expected.function,
        "about": comment(expected.route),
        "given": [(key, given[key]) for key in loaded],
        "takes_p": any(
            a.name in ("p", CONSTANTS)
            for call in calls
            for a in _program(module, call.function).arguments
        ),
        "constants": dict(module.counts).get("NK", 0) if CONSTANTS in keys else 0,
        "call": ", ".join(_arguments_in_c(module, expected)),
        "results": results(expected),
        "fails": bool(statuses[expected.function]),
        "then": [
            {
                "name": then.function,
                "call": ", ".join(_arguments_in_c(module, then, f"then_{k}")),
                "results": [(f"then_{k}_{n}", key, size) for n, key, size in results(then)],
                "fails": bool(statuses[then.function]),
            }
            for k, then in enumerate(expected.then)
        ],
    }


def in_python(module: Module, vectors: Vectors, options: Options) -> dict[str, str]:
    """The same for `python.render`."""
    del options  # functions of many states are there in any case
    scales = (1 + vectors.loud,) if vectors.loud else ()
    text = templates.fill(
        "python/golden.py.jinja",
        name=module.name,
        states=vectors.states,
        loud=vectors.loud,
        tolerance=number(DOUBLE),
        about=[line.replace("\\", "/") for line in _about(module, vectors, DEFAULT)],
        given=[
            (
                key,
                f"({vectors.states},)" if key == "t" else f"({vectors.states}, {len(rows[0])})",
                _lines(x for row in rows for x in row),
            )
            for key, rows in vectors.given.items()
        ],
        values=[
            (
                key,
                f"({', '.join(map(str, (vectors.states, *v.shape)))})",
                f"({', '.join(map(str, (*scales, *v.shape)))},)",
                _lines(x for row in v.rows for x in row),
                _lines(x for row in v.scales for x in row),
            )
            for key, v in vectors.values.items()
        ],
        parameters=vectors.parameters,
        functions=[
            (
                x.label,
                literal(x.function),
                _tuple(_keys(module, x)),
                _tuple(x.results),
                literal(x.route),
                [
                    (literal(y.function), _tuple(_keys(module, y)), _tuple(y.results))
                    for y in x.then
                ],
                _tuple(r.name for r in _program(module, x.function).results),
            )
            for x in vectors.expected
        ],
    )
    return {f"test_{module.name}.py": text}


def _program(module: Module, function: str) -> Program | Routine:
    return next(p for p in module.programs if p.name == function)


def _keys(module: Module, call: Expected | Then) -> list[str]:
    """For each argument what stands for it; the parameters are ``p``."""
    keys = iter(call.given)
    names = [argument.name for argument in _program(module, call.function).arguments]
    return [name if name == "p" else next(keys) for name in names]


def _arguments_in_c(module: Module, call: Expected | Then, prefix: str = "") -> list[str]:
    single = {"p": "&p", "t": f"(real){module.name}_given_t[state]"}
    arguments = [
        single.get(key) or f"out_{key.removeprefix(RETURNED)}"
        if key.startswith(RETURNED) or key in single
        else f"in_{key}"
        for key in _keys(module, call)
    ]
    prefix = f"{prefix}_" * bool(prefix)
    results = [result.name for result in _program(module, call.function).results]
    return [*arguments, *(f"out_{prefix}{result}" for result in results)]


def _about(module: Module, vectors: Vectors, options: Options) -> list[str]:
    """What is compared with what, and what is not, in plain lines."""
    lines = ["Compared are, with where the expected values came from:"]
    for x in vectors.expected:
        lines += _item(f"{x.label}: {x.route}.")
    if vectors.untested:
        lines += ["", "Not compared are:"]
        for function, why in vectors.untested:
            lines += _item(f"{function}: {why}.")
    if options.batch:
        lines += ["", "Functions of many states, whose names end in _batch, are not compared."]
    if any("network" in text for text in module.about):
        text = (
            "Laws of networks, elements and loads are evaluated in numbers; their forces on bodies are "
            "projected on the bodies' velocities."
        )
        lines += ["", *prose.paragraph(text)]
    return lines


def _item(text: str) -> list[str]:
    return [f"    {line}" for line in prose.paragraph(text, 4)]


def _tuple(names: Iterable[str]) -> str:
    found = list(map(literal, names))
    return f"({', '.join(found)}{',' * (len(found) == 1)})"


def _lines(entries: Iterable[float]) -> list[str]:
    """Numbers, as many on a line as fit."""
    lines: list[str] = []
    line = ""
    for entry in map(number, entries):
        if line and len(line) + len(entry) > _WIDTH:
            lines.append(line)
            line = ""
        line = f"{line} {entry},".lstrip()
    return [*lines, line] if line else lines

"""Golden vectors as a program in C."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from codegen import golden, templates
from codegen.c.declare import block, comment
from codegen.printer import number
from linegraph.ir.golden_vectors import CONSTANTS, RETURNED

if TYPE_CHECKING:
    from codegen.golden import Called, GoldenComparison
    from codegen.options import Options
    from linegraph.ir.golden_vectors import Vectors
    from linegraph.ir.program import Module


def render(module: Module, vectors: Vectors, options: Options) -> dict[str, str]:
    """The program in C that checks the files of `source.render` against golden vectors.

    Args:
        module: the functions of a model.
        vectors: arguments and independently computed results.
        options: those with which the files are rendered.

    Returns:
        The text of the one file, by file name.
    """
    file, module = module.name, replace(module, name=options.prefix or module.name)
    found = golden.golden(module, vectors)
    sizes = {x.key: x.size for x in found.given}
    constants = dict(module.counts).get("NK", 0)
    text = templates.fill(
        "c/golden.c.jinja",
        file=file,
        sources=f"-I ../src {file}_test.c ../src/{file}.c"
        if options.arduino
        else f"{file}_test.c {file}.c",
        name=module.name,
        macro=module.name.upper(),
        real=options.real,
        width=max(24, *(len(x.label) for x in found.comparisons)),
        states=found.states,
        loud=found.loud,
        double=number(golden.DOUBLE),
        single=number(golden.SINGLE),
        about=block(golden.about(module, vectors, batch=options.batch)),
        given=[x for x in found.given if x.size],
        parameters=found.parameters,
        values=[(x.key, x.size, x.rows, x.scales) for x in found.wanted if x.size],
        functions=[_compared(module, x, sizes, constants) for x in found.comparisons],
    )
    # a library of Arduino's compiles nothing of this folder by itself
    return {f"{file}/extras/{file}_test.c" if options.arduino else f"{file}_test.c": text}


def _compared(
    module: Module, x: GoldenComparison, sizes: dict[str, int], constants: int
) -> dict[str, Any]:
    """What is loaded, the call, what its results and those that follow are compared with."""
    keys = dict.fromkeys(key for call in (x.first, *x.then) for key in call.given)
    loaded = [
        key for key in keys if key not in ("t", "p", CONSTANTS) and not key.startswith(RETURNED)
    ]
    return {
        "label": x.label,
        "about": comment(x.route),
        "given": [(key, sizes[key]) for key in loaded],
        "takes_p": "p" in keys or CONSTANTS in keys,
        "constants": constants if CONSTANTS in keys else 0,
        **_call(module, x.first),
        "then": [_call(module, then, f"then_{k}_") for k, then in enumerate(x.then)],
    }


def _call(module: Module, x: Called, prefix: str = "") -> dict[str, Any]:
    """A call; the names of its results begin with `prefix`."""
    single = {"p": "&p", "t": f"(real){module.name}_given_t[state]"}
    given = [
        f"out_{key.removeprefix(RETURNED)}"
        if key.startswith(RETURNED)
        else single.get(key, f"in_{key}")
        for key in x.given
    ]
    results = [(f"{prefix}{y.name}", y.key, y.size) for y in x.results]
    return {
        "name": x.function,
        "call": ", ".join([*given, *(f"out_{name}" for name, _, _ in results)]),
        "results": results,
        "fails": x.fails,
    }

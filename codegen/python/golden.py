"""Golden vectors as tests in Python."""

from __future__ import annotations

from typing import TYPE_CHECKING

from codegen import golden, templates
from codegen.printer import number
from codegen.python.module import literal

if TYPE_CHECKING:
    from collections.abc import Iterable

    from codegen.options import Options
    from linegraph.ir.golden_vectors import Vectors
    from linegraph.ir.program import Module


def render(module: Module, vectors: Vectors, options: Options) -> dict[str, str]:
    """The program in Python that checks the file of `module.render` against golden vectors.

    Args:
        module: the functions of a model.
        vectors: arguments and independently computed results.
        options: not used.

    Returns:
        The text of the one file, by file name.
    """
    del options  # functions of many states are there in any case
    found = golden.golden(module, vectors)
    scales = (1 + found.loud,) if found.loud else ()
    text = templates.fill(
        "python/golden.py.jinja",
        name=module.name,
        states=found.states,
        loud=found.loud,
        tolerance=number(golden.DOUBLE),
        about=[line.replace("\\", "/") for line in golden.about(module, vectors)],
        given=[
            (x.key, _shape((found.states,) if x.key == "t" else (found.states, x.size)), x.lines)
            for x in found.given
        ],
        values=[
            (
                x.key,
                f"({', '.join(map(str, (found.states, *x.shape)))})",
                f"({', '.join(map(str, (*scales, *x.shape)))},)",
                x.rows,
                x.scales,
            )
            for x in found.wanted
        ],
        parameters=found.parameters,
        functions=[
            (
                x.label,
                literal(x.first.function),
                _tuple(x.first.given),
                _tuple(y.key for y in x.first.results),
                literal(x.route),
                [
                    (literal(y.function), _tuple(y.given), _tuple(z.key for z in y.results))
                    for y in x.then
                ],
                _tuple(y.name for y in x.first.results),
            )
            for x in found.comparisons
        ],
    )
    return {f"test_{module.name}.py": text}


def _shape(extents: tuple[int, ...]) -> str:
    return f"({', '.join(map(str, extents))}{',' * (len(extents) == 1)})"


def _tuple(names: Iterable[str]) -> str:
    found = list(map(literal, names))
    return f"({', '.join(found)}{',' * (len(found) == 1)})"

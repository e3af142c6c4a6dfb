"""JavaScript, for tests: a whole language in little more than a hundred lines.

A module is a file that node runs; every function takes arrays and returns an array of its results.
Failures are exceptions with the name of the status.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, ClassVar

from codegen import algorithms, golden
from codegen.language import Language
from codegen.phrases import ATOM, CHOICE, NOT, Phrases
from codegen.printer import Syntax, number, print_program
from linegraph.ir import statements as ir
from linegraph.ir.functions import ARITY
from linegraph.ir.program import Routine, counts_of
from linegraph.ir.rounding import DOUBLE

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph.ir.golden_vectors import Vectors
    from linegraph.ir.program import Module, Program

HELPERS = """const larger = (x, y) => (y > x || x !== x ? y : x);
const sign = (x) => (x > 0 ? 1 : x < 0 ? -1 : 0 * x);
function write(targets, results) {
    targets.forEach(([array, start], k) => results[k].forEach((x, i) => { array[start + i] = x; }));
}
"""
CHECKS = """let failed = 0;
for (const { label, calls } of comparisons) {
    for (let state = 0; state < states; ++state) {
        const returned = {};
        for (const call of calls) {
            const found = code[call.function](...call.given.map((key) => argument(key, state, returned)));
            call.results.forEach(([name, key, size], k) => {
                returned[name] = found[k];
                for (let i = 0; key && i < size; ++i) {
                    const scale = wanted[key].scales[Math.max(0, state - (states - loud - 1)) * size + i];
                    const error = Math.abs(found[k][i] - wanted[key].rows[state * size + i]) / scale;
                    if (!(error <= tolerance)) { failed += 1; console.log(label, key, state, i, error); }
                }
            });
        }
    }
}
function argument(key, state, returned) {
    const row = (k) => given[k].lines.slice(state * given[k].size, (state + 1) * given[k].size);
    if (key.startsWith("returned.")) { return returned[key.slice(9)]; }
    if (key === "t") { return row("t")[0]; }
    if (key !== "p" && key !== "c") { return row(key); }
    const p = Object.fromEntries(parameters.map((name, i) => [name, row("p")[i]]));
    return key === "p" ? p : code.prepare(p)[0];
}
console.log(`${comparisons.length} functions compared`);
process.exit(failed > 0 ? 1 : 0);
"""


class JavaScript(Phrases):
    """Expressions; procedures of a routine's own are called after it."""

    words: ClassVar = {"and": "&&", "or": "||", "==": "===", "!=": "!=="}

    def __init__(self, routine: str = "", own: frozenset[str] = frozenset()) -> None:
        """Numbers are doubles."""
        super().__init__(DOUBLE)
        self.routine, self.own = routine, own

    def opposite(self, a: Any) -> tuple[str, int]:
        return f"!({self.text(a)})", ATOM

    def choice(self, x: ir.Choice) -> tuple[str, int]:
        return f"{self.operand(x.test, NOT)} ? {self.text(x.a)} : {self.text(x.b)}", CHOICE

    def intrinsic(self, x: ir.Intrinsic) -> tuple[str, int]:
        given = list(map(self.text, x.arguments))
        texts = {"abs": "Math.abs", "sqrt": "Math.sqrt", "larger": "larger", "float": "Number"}
        if x.name == "ratio":
            return f"(({given[0]}) / ({given[1]}))", ATOM
        return f"{texts[x.name]}({', '.join(given)})", ATOM

    def literal(self, value: bool | int | float) -> str:
        return str(value).lower() if isinstance(value, bool) else super().literal(value)

    def infinity(self) -> str:
        return "Infinity"

    def count(self, x: ir.Count) -> str:
        return f"counts.{x.name}"

    def procedure(self, x: ir.Invocation) -> str:
        return f"{self.routine}_{x.procedure}" if x.procedure in self.own else x.procedure

    def part(self, x: ir.ArrayPart) -> str:
        if x.start is None and x.stop is None:
            return x.array
        bounds = ["0" if x.start is None else self.text(x.start)]
        bounds += [] if x.stop is None else [self.text(x.stop)]
        return f"{x.array}.slice({', '.join(bounds)})"

    def statement(self, x: ir.Statement) -> Iterator[str]:
        """The lines of a statement."""
        match x:
            case ir.Constant() | ir.Let():
                word = "let" if isinstance(x, ir.Let) and not x.final else "const"
                yield f"{word} {x.name} = {self.text(x.value)};"
            case ir.ConstantTable():
                yield f"const {x.name} = {list(x.entries)};"
            case ir.Array():
                yield f"const {x.name} = new Array({self.text(x.size)}).fill(0);"
            case ir.Assign():
                yield f"{self.text(x.target)} {x.operator}= {self.text(x.value)};"
            case ir.For():
                relation = "<" if x.step > 0 else ">"
                test = f"{x.name} {relation} {self.text(x.stop)}"
                yield f"for (let {x.name} = {self.text(x.start)}; {test}; {x.name} += {x.step}) {{"
                yield from (*self.block(x.body), "}")
            case ir.While():
                yield from (f"while ({self.text(x.test)}) {{", *self.block(x.body), "}")
            case ir.If():
                yield from (f"if ({self.text(x.test)}) {{", *self.block(x.body), "} else {")
                yield from (*self.block(x.orelse), "}")
            case ir.Break():
                yield "break;"
            case ir.Return():
                yield f"return {'' if x.value is None else self.text(x.value)};"
            case ir.Fail():
                yield f'throw new Error("{x.status.name}");'
            case ir.Perform():
                yield f"{self.text(x.call)};"
            case ir.Use():
                given = ", ".join(y if isinstance(y, str) else self.part(y) for y in x.arguments)
                starts = [
                    (y.array, "0" if y.start is None else self.text(y.start)) for y in x.results
                ]
                targets = ", ".join(f"[{array}, {start}]" for array, start in starts)
                call = f"{x.function}({given})"
                yield f"return {call};" if x.passed else f"write([{targets}], {call});"

    def block(self, body: tuple[ir.Statement, ...]) -> list[str]:
        """The lines of a block."""
        return [f"    {line}" for x in body for line in self.statement(x)]


def procedure(phrases: JavaScript, made: ir.Procedure) -> list[str]:
    """A procedure as a function."""
    given = ", ".join([*made.context, *(x.name for x in made.parameters)])
    name = f"{phrases.routine}_{made.name}" if made.name in phrases.own else made.name
    return [f"function {name}({given}) {{", *phrases.block(made.body), "}"]


def function(module: Module, program: Program | Routine, found: algorithms.Algorithms) -> list[str]:
    """An emitted function."""
    names = ", ".join(x.name for x in program.results)
    head = f"function {program.name}({', '.join(x.name for x in program.arguments)}) {{"
    if program.handed:
        given = ["prepare(p)[0]", *(x.name for x in program.arguments if x.name != "p")]
        return [head, f"    return {program.handed}({', '.join(given)});", "}"]
    if isinstance(program, Routine):
        *others, body = found.own[program.name]
        phrases = JavaScript(program.name, frozenset(x.name for x in others))
        arrays = [f"    const {x.name} = [];" for x in program.results]
        made = [line for x in others for line in procedure(phrases, x)]
        return [*made, head, *arrays, *phrases.block(body.body), f"    return [{names}];", "}"]
    lines = []
    for call in program.calls:
        taken = ", ".join(x.name for x in call.results)
        lines.append(f"    const [{taken}] = {call.program}({', '.join(call.arguments)});")
    printed = print_program(program, SYNTAX)
    results = ", ".join(f"[{', '.join(entries)}]" for entries in printed.results)
    return [head, *lines, *printed.lines, f"    return [{results}];", "}"]


SYNTAX = Syntax(
    before="    const ",
    after=";",
    member="p.",
    functions={name: "sign(" if name == "sign" else f"Math.{name}(" for name in ARITY},
    comment=lambda label: f"    // {label}",
    check=lambda value, bound, x: [
        f'    if (!({value} > {bound})) {{ throw new Error("{x.name}"); }}'
    ],
)


def render(module: Module, options: object) -> dict[str, str]:
    """The file of a module."""
    found = algorithms.of(module)
    names = [x.name for x in module.programs]
    lines = [f"const counts = {json.dumps(counts_of(module))};"]
    lines += [f"const {x.name} = {x.value};" for x in found.codes()]
    lines += [line for x in found.shared for line in procedure(JavaScript(), x)]
    lines += [line for x in module.programs for line in function(module, x, found)]
    return {
        f"{module.name}.js": "\n".join(
            [HELPERS, *lines, f"module.exports = {{ {', '.join(names)} }};", ""]
        )
    }


def render_tests(module: Module, vectors: Vectors, options: object) -> dict[str, str]:
    """A program that exits with 1 unless every function returns what it must."""
    found = golden.golden(module, vectors)
    given = {x.key: {"size": x.size, "lines": _numbers(x.lines)} for x in found.given}
    wanted = {x.key: {"rows": _numbers(x.rows), "scales": _numbers(x.scales)} for x in found.wanted}
    comparisons = [
        {"label": x.label, "calls": [call._asdict() for call in (x.first, *x.then)]}
        for x in found.comparisons
    ]
    data = {"given": given, "wanted": wanted, "comparisons": comparisons}
    data |= {"parameters": found.parameters, "states": found.states, "loud": found.loud}
    lines = [f"const {name} = {json.dumps(value)};" for name, value in data.items()]
    lines += [f'const code = require("./{module.name}.js");', f"const tolerance = {number(5e-12)};"]
    return {f"{module.name}_test.js": "\n".join([*lines, CHECKS])}


def _numbers(lines: list[str]) -> list[float]:
    return [float(x) for line in lines for x in line.rstrip(",").split(",")]


LANGUAGE = Language(render, render_tests)

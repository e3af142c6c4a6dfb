"""Straight-line programs in C: lines in the order of `order`, in parts as `parts` cuts them.

The same lines serve doubles, and registers that hold a number of each of several states (`codegen.c.batch`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from codegen import failures
from codegen.c import declare, real
from codegen.c.angles import Angles
from codegen.c.frames import Definition, StackFrame
from codegen.c.order import Entry, Guard, NamedStep, arranged, paired
from codegen.c.parts import cut, places
from codegen.dependence import SHARED, varying
from codegen.printer import Printer, Syntax, number
from linegraph.ir.dag import Node
from linegraph.ir.functions import ARITY

if TYPE_CHECKING:
    from collections.abc import Sequence

    from codegen.c.order import Item
    from codegen.c.parts import CodePart
    from linegraph.ir.dag import Operand
    from linegraph.ir.program import Argument, Call, Check, Module, Program

OWN = ("sign", "min", "max")
"""Functions of the file itself: that of <math.h> is missing, or it hides what is not a number."""


@dataclass(frozen=True)
class NumberKind:
    """The type of the numbers in a function.

    Attributes:
        number: their type.
        wide: whether a number is a register, with one number of each of several states.
        inline: whether sines and cosines are those of the file itself.
        real: one of `options.REAL`, for which the text is rewritten in the end.
    """

    number: str = "double"
    wide: bool = False
    inline: bool = False
    real: str = "double"


def function(module: Module, name: str) -> str:
    """The name in C of an elementary function, from <math.h> or defined in the file.

    Args:
        module: the module; its name is the prefix of functions that the file defines.
        name: one of `ARITY`.
    """
    if name in OWN:
        return f"{module.name}_{name}_of"
    return "fabs" if name == "abs" else name


def define(
    module: Module, program: Program, statuses: dict[str, dict[int, str]], kind: NumberKind
) -> list[Definition]:
    """The function of a program, preceded by its parts if it is long.

    Args:
        module: the module.
        program: the function.
        statuses: for each function of the module, the meaning of each status; empty if it has none.
        kind: the type of its numbers.
    """
    return _Writer(module, program, statuses, kind).definitions()


class _Writer:
    """Writes one program; `printer` and `count` go through its parts in order."""

    def __init__(
        self,
        module: Module,
        program: Program,
        statuses: dict[str, dict[int, str]],
        kind: NumberKind,
    ) -> None:
        self.module, self.program, self.statuses, self.kind = module, program, statuses, kind
        self.prefix, self.macro = module.name, module.name.upper()
        self.ok = f"{self.macro}_{failures.OK}"
        live = program.live
        self.wide = varying(live) if kind.wide else frozenset()
        special = kind.wide or kind.inline
        forced = filter(self.apart, live) if special else paired(live)
        items = arranged(program, forced)
        angles = (
            Angles(items, self.wide if kind.wide else None) if kind.inline else Angles([], None)
        )
        self.angles, self.items = angles, angles.without(items)
        self.notation = _notation(module, kind)
        self.printer = Printer(program, self.notation)
        self.own = {f"{node.op}_of" for node in live if node.op in OWN}
        self.frame = self.begun()
        self.count = 0
        self.zero = False
        self.read: set[str] = set()

    def apart(self, node: Node) -> bool:
        """Whether a node needs a line of its own: its function is more than a call that gives a number."""
        if self.kind.inline and node.op in ("sin", "cos"):
            return True
        return self.kind.wide and node.op in ARITY

    def type_of(self, index: int) -> str:
        """The type of the variable to which a node is assigned."""
        return self.kind.number if not self.kind.wide or index in self.wide else "double"

    def begun(self) -> StackFrame:
        """A new record of a function's stack frame."""
        return StackFrame(statements=0, wide=self.kind.wide, calls=set(self.own))

    def definitions(self) -> list[Definition]:
        """All functions, the public one last."""
        program, kind, made = self.program, self.kind, list[Definition]()
        parts = cut(self.items)
        if len(parts) == 1:
            self.read = self.printer.begin()
            main = self.lines(parts[0], {})
        else:
            main, made = self.split(parts)
        fails = [bool(self.statuses[call.program]) for call in program.calls]
        lines = [
            f"    {kind.number} {local.name}[{local.size or 1}];"
            for call in program.calls
            for local in call.results
        ]
        for call in program.calls:
            self.frame.add(kind.number, sum(local.size or 1 for local in call.results))
            self.frame.calls.add(call.program)
        guarded = len(parts) > 1 and bool(program.checks)
        if any(fails) or guarded:
            lines.append("    int status;")
            self.frame.ints += 1
        lines += [f"    (void){x.name};" for x in program.arguments if x.name not in self.used()]
        lines += [f"    (void){x.name};" for x in program.results if not x.entries]
        for call, may_fail in zip(program.calls, fails, strict=True):
            text = f"{self.prefix}_{call.program}({_given(call)});"
            lines += _called(text, may_fail, self.ok)
        lines += self.sines() + main
        if self.statuses[program.name]:
            lines.append(f"    return {self.ok};")
        self.frame.parameters = len(program.arguments) + len(program.results)
        self.frame.statements = len(lines)
        return [*made, Definition(self.name(), self.signature(), lines, self.frame)]

    def name(self) -> str:
        """The name of the function itself, without the prefix."""
        if self.kind.wide:
            return f"{self.program.name}_lanes"
        return self.program.name + declare.CORE * bool(self.statuses[self.program.name])

    def signature(self) -> str:
        """The head of the function itself."""
        if not self.kind.wide:
            core = bool(self.statuses[self.program.name])
            return declare.signature(self.module, self.program, self.statuses, core=core)
        parts = [self.argument(x) for x in self.program.arguments]
        parts += [declare.result(self.module, x, self.kind.number) for x in self.program.results]
        return declare.head(f"static void {self.prefix}_{self.program.name}_lanes(", parts)

    def argument(self, given: Argument) -> str:
        """A parameter that is read."""
        number = "double" if given.name in SHARED else self.kind.number
        return declare.argument(self.module, given, number)

    def used(self) -> set[str]:
        """The names of the arguments and local arrays that are read."""
        return self.read.union(self.angles.reads, *(x.arguments for x in self.program.calls))

    def sines(self) -> list[str]:
        """Sines and cosines of all angles that are known from the start, side by side."""
        angles, number = self.angles, self.kind.number
        if not angles.size:
            return []
        self.frame.add(number, 2 * angles.size)
        arrays = f"sines[{angles.size}], cosines[{angles.size}]"
        if not angles.early:
            return [f"    {number} {arrays};"]
        texts = [Printer(self.program, self.notation).text(angle) for angle in angles.early]
        texts += ["0.0"] * (angles.filled - len(texts))
        function = f"{'lanes' if self.kind.wide else 'all'}_sincos"
        self.frame.add(number, len(texts))
        self.frame.calls.add(function)
        return [
            f"    const {number} angles[{len(texts)}] = {{{', '.join(texts)}}};",
            f"    {number} {arrays};",
            f"    {self.prefix}_{function}({len(angles.early)}, angles, sines, cosines);",
        ]

    # ---- parts

    def split(self, parts: Sequence[CodePart]) -> tuple[list[str], list[Definition]]:
        """The lines that call the parts, and the parts."""
        found = places(parts, self.type_of)
        arrays = {
            number: "kept" if number == self.kind.number else "common" for number in found.count
        }
        of = {x: f"{arrays[self.type_of(x)]}[{place}]" for x, place in found.of.items()}
        lines: list[str] = []
        for type_, count in found.count.items():
            lines.append(f"    {type_} {arrays[type_]}[{count}];")
            self.frame.add(type_, count)
        main, made = self.frame, list[Definition]()
        for place, part in enumerate(parts, 1):
            read = self.printer.begin()
            self.frame = self.begun()
            body = self.lines(part, of)
            self.read |= read
            names, declared = self.parameters(part, read, of, found.count, arrays)
            fails = any(isinstance(item, Guard) for item in part.items)
            name = f"{self.program.name}{'_lanes' * self.kind.wide}_part{place}"
            start = f"{self.macro}_PART {'int' if fails else 'void'} {self.prefix}_{name}("
            body += [f"    return {self.ok};"] * fails
            self.frame.parameters, self.frame.statements = len(names), len(body)
            made.append(Definition(name, declare.head(start, declared), body, self.frame))
            lines += _called(f"{self.prefix}_{name}({', '.join(names)});", fails, self.ok)
            main.calls.add(name)
        self.frame = main
        return lines, made

    def parameters(
        self,
        part: CodePart,
        read: set[str],
        of: dict[int, str],
        count: dict[str, int],
        arrays: dict[str, str],
    ) -> tuple[list[str], list[str]]:
        """The parameters of a part: their names and their declarations."""
        written = {item.result for item in part.items if isinstance(item, Entry)}
        declared = {x.name: self.argument(x) for x in self.program.arguments if x.name in read}
        for call in self.program.calls:
            for x in call.results:
                if x.name in read:
                    declared[x.name] = f"const {self.kind.number} {x.name}[{x.size or 1}]"
        for type_, size in count.items():
            name = arrays[type_]
            own = {x for x in part.kept if of[x].startswith(f"{name}[")}
            if own:
                declared[name] = f"{type_} {name}[{self.macro}_RESTRICT {size}]"
            elif any(of[x].startswith(f"{name}[") for x in part.given):
                declared[name] = f"const {type_} {name}[{size}]"
        waves = [x.node for x in part.items if isinstance(x, NamedStep) if self.angles.has(x.node)]
        late = any(map(self.angles.comes_first, waves))
        for name, op in (("sines", "sin"), ("cosines", "cos")):
            if late or any(node.op == op for node in waves):
                constant = "" if late else "const "
                declared[name] = f"{constant}{self.kind.number} {name}[{self.angles.size}]"
        for result in self.program.results:
            if result.name in written:
                declared[result.name] = declare.result(self.module, result, self.kind.number)
        return list(declared), list(declared.values())

    # ---- lines

    def lines(self, part: CodePart, of: dict[int, str]) -> list[str]:
        """The lines of a part: what earlier parts have kept is read right before it is needed."""
        known = self.printer.known
        missing = set(part.given)
        lines: list[str] = []
        label = ""
        self.zero = False
        for item in part.items:
            now = item.node.label if isinstance(item, NamedStep) else label or "results"
            if now != label:
                label = now
                lines.append(self.notation.comment(label or "no element"))
            for index in item.needs if missing else ():
                if index in missing:
                    missing.remove(index)
                    lines.append(f"    const {self.type_of(index)} {known[index]} = {of[index]};")
                    self.frame.add(self.type_of(index))
            if isinstance(item, NamedStep):
                name = f"t{self.count}"
                self.count += 1
                self.frame.name(self.type_of(item.node.index))
                lines += self.assignment(item.node, name)
                known[item.node.index] = name
                if item.node.index in part.kept:
                    lines.append(f"    {of[item.node.index]} = {name};")
            else:
                lines += self.ending(item)
        self.frame.add(self.kind.number, int(self.zero))
        return [f"    const {self.kind.number} zero = {{0.0}};"] * self.zero + lines

    def ending(self, item: Item) -> list[str]:
        """An entry of a result, or a check."""
        printer = self.printer
        if isinstance(item, Guard):
            return printer.check(item.check)
        assert isinstance(item, Entry)
        text = printer.text(item.value)
        if self.kind.wide and not (isinstance(item.value, Node) and item.value.index in self.wide):
            text = self.equal(text)
        return [f"    {item.result}[{item.place}] = {text};"]

    def assignment(self, node: Node, name: str) -> list[str]:
        """The lines that give a node its name."""
        number = self.type_of(node.index)
        if self.angles.has(node):
            place = self.angles.place(node)
            array = "sines" if node.op == "sin" else "cosines"
            late = self.late(node, place) if self.angles.comes_first(node) else []
            return [*late, f"    const {number} {name} = {array}[{place}];"]
        if self.kind.wide and node.op in ARITY and node.index in self.wide:
            return self.lanewise(node, name)
        return [f"    const {number} {name} = {self.printer.expression(node)[0]};"]

    def late(self, node: Node, place: int) -> list[str]:
        """Sine and cosine of an angle that is known only here."""
        angle = self.printer.text(node.a)
        at = f"&sines[{place}], &cosines[{place}]"
        self.frame.calls.add("lanes_sincos" if self.kind.wide else "sincos")
        if not self.kind.wide:
            return [f"    {self.prefix}_sincos({angle}, {at});"]
        self.frame.add(self.kind.number)
        return [
            "    {",
            f"        const {self.kind.number} angle = {angle};",
            f"        {self.prefix}_lanes_sincos(1, &angle, {at});",
            "    }",
        ]

    def lanewise(self, node: Node, name: str) -> list[str]:
        """A function of each number in a register."""
        self.frame.calls.add(f"lanes_{node.op}")
        self.frame.add(self.kind.number, ARITY[node.op] - 1)
        function = f"{self.prefix}_lanes_{node.op}"
        lines = [f"    {self.kind.number} {name} = {self.spread(node.a)};"]
        if ARITY[node.op] == 1:
            return [*lines, f"    {function}(&{name});"]
        return [
            *lines,
            "    {",
            f"        const {self.kind.number} other = {self.spread(node.b)};",
            f"        {function}(&{name}, &other);",
            "    }",
        ]

    def spread(self, x: Operand) -> str:
        """An operand as a register."""
        text = self.printer.text(x) if isinstance(x, Node) else number(x)
        return text if isinstance(x, Node) and x.index in self.wide else self.equal(text)

    def equal(self, text: str) -> str:
        """A number as a register that has it in all lanes."""
        self.zero = True
        return f"{text} + zero"


def _given(call: Call) -> str:
    """The arguments of a call of another function."""
    return ", ".join((*call.arguments, *(local.name for local in call.results)))


def _called(call: str, may_fail: bool, ok: str) -> list[str]:
    """A call whose status, if it has one, ends the caller."""
    if not may_fail:
        return [f"    {call}"]
    return [
        f"    status = {call}",
        f"    if (status != {ok}) {{",
        "        return status;",
        "    }",
    ]


def _notation(module: Module, kind: NumberKind) -> Syntax:
    """How C writes expressions and checks."""
    named = {key: constant for key, (constant, _) in failures.constants(module).items()}

    def check(value: str, bound: str, found: Check) -> list[str]:
        """Written so that NaN fails, too."""
        return [
            f"    if (!({value} > {bound})) {{ /* {declare.comment(found.about)} */",
            f"        return {named[found.status, found.name]};",
            "    }",
        ]

    return Syntax(
        before="    const double ",
        after=";",
        member="p->",
        functions={name: f"{function(module, name)}(" for name in ARITY},
        comment=lambda label: f"    /* {declare.comment(label)} */",
        check=check,
        bracketed=True,
        tolerance=lambda fraction: real.tolerance(fraction, kind.real),
    )

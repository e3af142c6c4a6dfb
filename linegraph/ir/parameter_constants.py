"""Rearranges programs so that as much as possible depends on parameters alone.

With k for constants, of which parameters or numbers are all they depend on:

    x / k = x (1 / k)               (x k1) k2 = x (k1 k2)
    (x k) y = (x y) k               x k1 + x k2 = x (k1 + k2)
    x k + y k = (x + y) k

Nothing is rearranged that would take more operations. Summands stay where they are: k1 may be there to make
x + k1 small.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING

from linegraph.errors import ModelError
from linegraph.ir.dag import ADD, DIV, MUL, NEG, SUB, SYMBOL, Dag, Node, Operand
from linegraph.ir.program import Guards, assemble

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from linegraph.ir.program import Program


class Restructured:
    """Programs over a DAG of their own, constants brought together."""

    def __init__(self) -> None:
        """None yet."""
        self._dag = Dag()
        self._known: dict[int, Operand] = {}
        self._constant: dict[int, bool] = {}
        self._uses: Counter[int] = Counter()

    def programs(self, programs: Iterable[Program]) -> list[Program]:
        """All of them, nodes in the order in which they were derived."""
        programs = list(programs)
        nodes = {node.index: node for program in programs for node in program.live}
        used = [x for program in programs for x in ends(program)]
        used += [x for node in nodes.values() for x in (node.a, node.b)]
        self._uses = Counter(x.index for x in used if isinstance(x, Node))
        for index in sorted(nodes):
            self._dag.label = nodes[index].label
            self._known[index] = self._made(nodes[index])
        self._dag.release()
        return [mapped(program, self._of) for program in programs]

    def _of(self, x: Operand) -> Operand:
        return self._known[x.index] if isinstance(x, Node) else x

    def _made(self, node: Node) -> Operand:
        if node.op == MUL:
            return self._outward(node)
        if node.op == DIV:
            a, b = self._of(node.a), self._of(node.b)
            if self._varies_by(a, b):
                return self._product(a, self._dag.divide(1, b))
        if node.op in (ADD, SUB):
            return self._sum(node)
        return remade(self._dag, node, self._of)

    def _outward(self, node: Node) -> Operand:
        """``a b``; constant factors that nothing else needs go outward, where they may meet others."""
        a, b = self._of(node.a), self._of(node.b)
        if self._holds(a) or self._holds(b):
            return self._product(a, b)
        (x, k), (y, m) = self._freed(node.a), self._freed(node.b)
        return self._product(self._dag.multiply(x, y), self._dag.multiply(k, m))

    def _freed(self, original: Node) -> tuple[Operand, Operand]:
        """The new operand for an old one, split into factors if nothing else uses it."""
        x = self._of(original)
        if isinstance(x, Node) and self._uses[original.index] == 1:
            return self._factors(x)
        return x, 1

    def _product(self, a: Operand, b: Operand) -> Operand:
        """``a b``; a constant goes to the constant factor that the other one has already."""
        if self._holds(a):
            a, b = b, a
        if not isinstance(a, Node) or not self._varies_by(a, b):
            return self._dag.multiply(a, b)
        if a.op == NEG:
            return self._dag.negate(self._product(a.a, b))
        x, k = self._factors(a)
        return self._dag.multiply(x, self._dag.multiply(k, b))

    def _sum(self, node: Node) -> Operand:
        """``a + b`` or ``a - b``; constants meet as factors."""
        a, b = self._of(node.a), self._of(node.b)
        if node.op == SUB:
            b = self._dag.negate(b)
        if not isinstance(a, Node) or not isinstance(b, Node):
            return self._dag.add(a, b)
        fewer = self._uses[node.a.index] == 1 or self._uses[node.b.index] == 1
        if not self._holds(a) and not self._holds(b):
            (x, k), (y, m) = self._factors(a), self._factors(b)
            if x is y:
                return self._product(x, self._dag.add(k, m))
            (k, sign), (m, other) = self._size(k), self._size(m)
            if fewer and k != 1 and (k is m or (k == m and not isinstance(k, Node))):
                rest = self._dag.add(sign * x, other * y)
                return self._product(rest, k)
        return self._dag.add(a, b)

    def _factors(self, x: Node) -> tuple[Operand, Operand]:
        """A factor that varies and a constant one."""
        if x.op == NEG:
            varying, k = self._factors(x.a)
            return varying, self._dag.negate(k)
        if x.op == MUL:
            for varying, k in ((x.a, x.b), (x.b, x.a)):
                if self._holds(k):
                    return varying, k
        return x, 1

    @staticmethod
    def _size(k: Operand) -> tuple[Operand, int]:
        """A constant but for its sign, and the sign."""
        if isinstance(k, Node):
            return (k.a, -1) if k.op == NEG else (k, 1)
        return (-k, -1) if k < 0 else (k, 1)

    def _holds(self, x: Operand) -> bool:
        return is_constant(x, self._constant)

    def _varies_by(self, a: Operand, b: Operand) -> bool:
        """Whether b is constant and a is not."""
        return self._holds(b) and not self._holds(a)


def ends(program: Program) -> list[Operand]:
    """The values that a program must compute: entries of results and both sides of checks."""
    entries = [entry for result in program.results for entry in result.entries]
    return [*entries, *(x for check in program.checks for x in (check.node, check.bound))]


def is_constant(x: Operand, known: dict[int, bool]) -> bool:
    """Whether an operand depends on nothing but numbers and parameters.

    Args:
        x: the operand.
        known: the results for nodes that have been examined, by index; those found here are added.
    """
    if not isinstance(x, Node):
        return True
    pending = [x]
    while pending:
        node = pending[-1]
        operands = () if node.op == SYMBOL else (node.a, node.b)
        nodes = [y for y in operands if isinstance(y, Node)]
        asked = [y for y in nodes if y.index not in known]
        if asked:
            pending += asked
            continue
        known[node.index] = all(known[y.index] for y in nodes) if nodes else node.a == "p"
        pending.pop()
    return known[x.index]


def remade(dag: Dag, node: Node, of: Callable[[Operand], Operand]) -> Operand:
    """The operation of a node, repeated in a DAG on new operands.

    Args:
        dag: the DAG in which the operation is made.
        node: the operation; a symbol becomes the symbol of the same name.
        of: maps each old operand to the new one, which belongs to `dag`.
    """
    if node.op == SYMBOL:
        return dag.symbol(node.a, node.b)
    a = of(node.a)
    if node.op == NEG:
        return dag.negate(a)
    if node.b is None:
        return dag.function(node.op, a)
    b = of(node.b)
    binary = {ADD: dag.add, SUB: dag.subtract, MUL: dag.multiply, DIV: dag.divide}
    return binary[node.op](a, b) if node.op in binary else dag.function(node.op, a, b)


def mapped(program: Program, of: Callable[[Operand], Operand]) -> Program:
    """A program with replaced results and checks, whose steps are not yet updated.

    Args:
        program: the program; checks that cannot fail after the replacement are dropped.
        of: maps each entry of a result and both sides of each check to its replacement.

    Raises:
        ModelError: a check fails at every state.
    """
    results = tuple(replace(r, entries=tuple(map(of, r.entries))) for r in program.results)
    checks = []
    for check in program.checks:
        node, bound = of(check.node), of(check.bound)
        if isinstance(node, Node):
            checks.append(replace(check, node=node, bound=bound))
        elif isinstance(bound, Node) or not node > bound * (check.fraction or 1):
            raise ModelError("", f"{check.about}, whatever the state")
    return replace(program, results=results, checks=tuple(checks))


def rewritten(program: Program, of: Callable[[Operand], Operand]) -> Program:
    """A program with replaced results and checks, assembled again.

    Args:
        program: the program; its name, arguments, calls and texts are kept.
        of: maps each entry of a result and both sides of each check to its replacement.

    Raises:
        ModelError: a check fails at every state.
    """
    made = mapped(program, of)
    return assemble(
        made.name,
        made.about,
        made.arguments,
        made.results,
        Guards(made.checks, made.calls, made.status),
    )

"""Collects sums so that each term occurs once, and at most one number.

The DAG simplifies where a node is made, so that a sum that grows one operation at a time may hold a term
twice, or one that cancels. Here each sum of a program is seen as a whole, as a linear combination

    s = k1 t1 + k2 t2 + ... + c

of terms t and numbers k, c: additions, subtractions, changes of sign and products with numbers are taken
apart as long as nothing else needs what lies between. Equal terms meet, numbers meet, and terms that have the
same factor are added before they are scaled, 9.81 (a + b). A sum is written anew where that takes fewer
operations, or as many where it held a term or a number twice; all others stay as they were derived.

Terms stay in the order in which they were derived.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from linegraph.ir.dag import ADD, DIV, MUL, NEG, SUB, SYMBOL, Dag, Node, Number, Operand
from linegraph.ir.parameter_constants import remade, rewritten
from linegraph.ir.program import Program, count_uses

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from linegraph.ir.program import Routine

Key: TypeAlias = "int | tuple[str, Key, Key]"
"""A term without its numeric factor: the index of a node, or a product or quotient of such terms."""

CONSTANT = -1
"""The key of the number that a sum holds."""

ROUNDING = 2.0**-50
"""Relative bound below which the difference of two floats is taken for zero."""

_SUMS = (ADD, SUB)


class Combination(NamedTuple):
    """A sum as a linear combination.

    Attributes:
        factors: the number of each term, in order of first appearance; that of `CONSTANT` is added as it is.
        operations: how many operations made it so.
        repeats: whether a term or a number occurred twice.
        risky: whether a constant that stays occurred twice, once in a difference: (x - p) + (y - p) may be
            small where x, y and p are not, so that x + y - 2 p would lose its digits.
        leaves: the indices of the nodes that it was made of, as often as they were used.
    """

    factors: dict[Key, Number]
    operations: int
    repeats: bool
    leaves: list[int]
    risky: bool = False

    @property
    def cost(self) -> int:
        """How many operations `_Rewritten` takes for it, those of the terms not counted."""
        scales = {_size(k) for key, k in self.factors.items() if key != CONSTANT}
        return max(len(self.factors) - 1, 0) + len(scales - {1})

    @property
    def better(self) -> bool:
        """Whether rewriting the sum saves operations or removes a repeated term or number."""
        if self.risky:
            return False
        if not self.repeats and self.operations < len(self.factors) + 1:
            return False  # nothing but additions, or one product with a number
        return self.cost < self.operations or (self.repeats and self.cost == self.operations)


def collected(program: Program, dag: Dag | None = None) -> Program:
    """A program with its sums collected.

    Each program is looked at by itself, since what one of them needs twice another may take apart.
    Collecting twice gives what collecting once gives.

    Args:
        program: any.
        dag: the DAG that it is to be over; if left out one of its own, where there is anything to collect.
    """
    plan = Sums(program).plans()
    if dag is None and not plan:
        return program
    dag = Dag() if dag is None else dag
    program = _Rewriting(plan, dag).of(program)
    # what is written anew may leave others alone with a term
    while plan := Sums(program).plans():
        program = _Rewriting(plan, dag).of(program)
    return program


def with_sums_collected(programs: Sequence[Program | Routine]) -> tuple[Program | Routine, ...]:
    """Collect the sums of all programs over one DAG, where shared nodes stay shared."""
    dag = Dag()
    found = tuple(collected(x, dag) if isinstance(x, Program) else x for x in programs)
    dag.release()
    return found


class Sums:
    """The sums of one program, visited from last to first, so that all uses of a sum are known.

    Attributes:
        nodes: all nodes of the program by index, each after its operands.
    """

    def __init__(self, program: Program) -> None:
        """Count how often each node is needed, and find the numbers within products."""
        live = program.live
        self.nodes = {node.index: node for node in live}
        self._uses, _ = count_uses(live, program.results, program.checks)
        self._linear: dict[int, Node] = {}
        self._inner: dict[int, int] = {}
        self._numbers: set[int] = set()
        self._shared: dict[int, Combination] = {}
        self._freed: set[int] = set()
        for node in live:
            op, b = node.op, node.b
            if op in _SUMS or (op == MUL and not isinstance(b, Node)):
                self._linear[node.index] = node
            elif (op == MUL and (self._has_number(node.a) or self._has_number(b))) or (
                op == DIV and self._has_number(node.a)
            ):
                self._numbers.add(node.index)

    def plans(self) -> dict[int, Combination]:
        """The sums to be written anew, by the index of the node that is the whole."""
        found: dict[int, Combination] = {}
        wholes: Iterable[int] = reversed(self._linear)
        while wholes:
            for index in wholes:
                if index in self._inner or index in found or not self._uses[index]:
                    continue
                if self._may_hold_more(self._linear[index]):
                    combination = self._whole(self._linear[index])
                    if combination.better:
                        found[index] = combination
                        self._replace(combination)
            wholes = self._again()
        return found

    def _may_hold_more(self, node: Node) -> bool:
        """Whether a sum is of more than two terms, or of terms that hold numbers."""
        for x in (node.a, node.b):
            if isinstance(x, Node):
                index = (x.a if x.op == NEG else x).index
                if index in self._linear or index in self._numbers:
                    return True
        return False

    def _again(self) -> list[int]:
        """The sums that alone still need what others have needed, too, the last one first."""
        freed = {index for index in self._freed if self._uses[index] == 1}
        self._freed.clear()
        if not freed:
            return []
        users = (
            self._inner.get(index, index)
            for index, node in self._linear.items()
            if any(
                isinstance(x, Node) and (x.a if x.op == NEG else x).index in freed
                for x in (node.a, node.b)
            )
        )
        return sorted(set(users), reverse=True)

    def _whole(self, node: Node) -> Combination:
        """A sum taken apart; sums within that others need, too, only where that saves operations."""
        own = self._apart(node)
        for key in [x for x in own.factors if isinstance(x, int) and x in self._linear]:
            if key not in self._shared:
                self._shared[key] = self._apart(self._linear[key])
            inner = self._shared[key]
            if key in own.factors and not own.factors.keys().isdisjoint(inner.factors):
                wider = _merged(own, key, inner)
                if wider.cost < min(own.cost, own.operations):
                    own = wider
        return own

    def _apart(self, node: Node) -> Combination:
        """A sum as a linear combination, taken apart as long as nothing else needs what is inside."""
        factors: dict[Key, Number] = {}
        leaves: list[int] = []
        operations, repeats = 0, False
        twice: set[Key] = set()
        differing: set[Key] = set()
        pending: list[tuple[Operand, Number, bool]] = [(node, 1, False)]
        while pending:
            x, k, difference = pending.pop()
            key: Key = CONSTANT
            if not isinstance(x, Node):
                k *= x
            else:
                if x.op == NEG:
                    x, k = x.a, -k
                key = index = x.index
                if x is node or self._uses[index] == 1:
                    if index in self._linear:
                        operations += 1
                        if x is not node:
                            self._inner[index] = node.index
                        if x.op == MUL:
                            pending.append((x.a, k * x.b, difference))
                        else:
                            less = x.op == SUB
                            pending += ((x.b, -k if less else k, less), (x.a, k, less))
                        continue
                    if index in self._numbers:
                        number, key, taken = self._split(x)
                        k, operations = k * number, operations + taken
                leaves.append(index)
            if difference and isinstance(x, Node) and x.op == SYMBOL and x.a in ("p", "c"):
                differing.add(key)
            if key in factors:
                repeats = True
                twice.add(key)
                _gather(factors, key, k)
            else:
                factors[key] = k
        risky = any(key in factors for key in twice & differing)
        return Combination(factors, operations, repeats, leaves, risky)

    def _replace(self, combination: Combination) -> None:
        """From now on a sum needs the terms it is to be written with, and its leaves no longer."""
        keys: list[Key] = [key for key in combination.factors if key != CONSTANT]
        while keys:
            key = keys.pop()
            if isinstance(key, int):
                self._uses[key] += 1
            else:
                keys += key[1:]
        pending: list[Operand] = [self.nodes[index] for index in combination.leaves]
        while pending:
            x = pending.pop()
            if not isinstance(x, Node):
                continue
            x = x.a if x.op == NEG else x
            self._uses[x.index] -= 1
            if self._uses[x.index] == 1 and x.index in self._linear:
                self._freed.add(x.index)
            elif not self._uses[x.index] and x.op != SYMBOL:
                pending += (x.a, x.b)

    def _has_number(self, x: Operand) -> bool:
        """Whether a factor that nothing else needs holds a product with a number."""
        if not isinstance(x, Node):
            return False
        index = (x.a if x.op == NEG else x).index
        if self._uses[index] != 1:
            return False
        return index in self._numbers or (index in self._linear and self._linear[index].op == MUL)

    def _split(self, x: Node) -> tuple[Number, Key, int]:
        """A product or quotient as a number and the rest, and how many products that saves the rest."""
        if x.op == NEG:
            number, key, taken = self._split(x.a)
            return -number, key, taken
        if not self._has_number(x):
            return 1, x.index, 0
        number, a, taken = self._split(x.a)
        if not isinstance(x.b, Node):
            return number * x.b, a, taken + 1
        if x.op == DIV:
            return number, (DIV, a, x.b.index), taken
        other, b, more = self._split(x.b)
        # in one order, so that equal products are equal
        a, b = (a, b) if repr(a) <= repr(b) else (b, a)
        return number * other, (MUL, a, b), taken + more


class _Rewriting:
    """A program over another DAG, some of its sums written anew.

    Nodes are made in the order in which they were derived: as they were, as long as all that they are made of
    is, too.
    """

    def __init__(self, plan: Mapping[int, Combination], dag: Dag) -> None:
        """Keep what the sums become, by the index of the node that is the whole."""
        self._plan = plan
        self._dag = dag
        self._known: dict[int, Operand] = {}

    def of(self, program: Program) -> Program:
        """The program, rewritten."""
        dag, known, plan = self._dag, self._known, self._plan
        changed: set[int] = set()
        for node in program.live:
            index, a, b = node.index, node.a, node.b
            dag.label = node.label
            if index in plan:
                known[index] = self._sum(plan[index])
            elif (isinstance(a, Node) and a.index in changed) or (
                isinstance(b, Node) and b.index in changed
            ):
                known[index] = remade(dag, node, self._become)
            else:
                known[index] = dag.copied(node, known)
                continue
            changed.add(index)
        return self._assembled(program)

    def _become(self, x: Operand) -> Operand:
        """The rewritten operand for an old one."""
        return self._known[x.index] if isinstance(x, Node) else x

    def _sum(self, combination: Combination) -> Operand:
        """The nodes of a linear combination; terms with equal factors are added before they are scaled."""
        dag = self._dag
        groups: dict[Number | None, tuple[Number, Operand]] = {}
        for key, k in combination.factors.items():
            if key == CONSTANT:
                groups[None] = 1, k
                continue
            term = self._term(key)
            first, group = groups.get(_size(k), (k, 0))
            groups[_size(k)] = first, dag.add(group, term if k == first else dag.negate(term))
        total: Operand = 0
        for first, group in groups.values():
            total = dag.add(total, dag.multiply(group, first))
        return total

    def _term(self, key: Key) -> Operand:
        if isinstance(key, int):
            return self._known[key]
        op, a, b = key
        make = self._dag.multiply if op == MUL else self._dag.divide
        return make(self._term(a), self._term(b))

    def _assembled(self, program: Program) -> Program:
        found = rewritten(program, self._become)
        guarded = [self._known[index] for index in sorted(program.guarded)]
        divisions = (x.a if x.op == NEG else x for x in guarded if isinstance(x, Node))
        return replace(found, handed=program.handed, guarded=frozenset(x.index for x in divisions))


def _size(k: Number) -> Number:
    return -k if k < 0 else k


def _merged(outer: Combination, key: Key, inner: Combination) -> Combination:
    """A sum with one of its terms taken apart, which stays for others."""
    factors: dict[Key, Number] = {}
    for own, k in outer.factors.items():
        if own == key:
            for other, m in inner.factors.items():
                _gather(factors, other, k * m)
        else:
            _gather(factors, own, k)
    return outer._replace(factors=factors, repeats=True)


def _gather(factors: dict[Key, Number], key: Key, k: Number) -> None:
    """Add to the factor of a term; what rounding alone leaves of it is nothing."""
    old = factors.get(key, 0)
    new = old + k
    if not new or (isinstance(new, float) and old and _size(new) <= ROUNDING * _size(old)):
        factors.pop(key, None)
    else:
        factors[key] = new

"""The order of a program's lines: what is computed together stands together, and is used soon.

The derivation goes over all joints in turn, and again for each sweep, so that in the order of
construction hundreds of values wait for the sweep that needs them. Here the lines of one label stay
together, in their order, and these blocks follow each other as their users need them: one branch of
the tree is finished before the next begins. An entry of a result is written as soon as it is known.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.expression import SYMBOL, Node

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from linegraph.expression import Operand
    from linegraph.program import Check, Program

_PARTNERS = {"sin": "cos", "cos": "sin"}


@dataclass(frozen=True)
class Reads:
    """What an expression is made of.

    Attributes:
        steps: the indices of the nodes with a name that it reads.
        arguments: the names of the arguments and local arrays that it reads.
        cost: how many operations it has.
    """

    steps: tuple[int, ...]
    arguments: frozenset[str]
    cost: int


@dataclass(frozen=True)
class Step:
    """A node gets a name."""

    node: Node
    reads: Reads


@dataclass(frozen=True)
class Entry:
    """An entry of a result is written."""

    result: str
    place: int
    value: Operand
    reads: Reads


@dataclass(frozen=True)
class Guard:
    """A check; nothing is written before the last one, since a function that fails writes nothing."""

    check: Check
    reads: Reads


Item = Step | Entry | Guard


def arranged(program: Program, live: Sequence[Node], forced: Callable[[Node], bool]) -> list[Item]:
    """All lines of a program in order.

    Args:
        program: the program.
        live: all its nodes, each after its operands.
        forced: which nodes get a name in any case.
    """
    named = {node.index: node for node in program.steps}
    named |= {node.index: node for node in (*paired(live), *filter(forced, live))}
    nodes = [named[index] for index in sorted(named)]
    known = frozenset(named)
    steps = {node.index: Step(node, _reads((node.a, node.b), known)) for node in nodes}
    order = [steps[index] for index in _together(_ordered(nodes, steps), named)]
    guards = [Guard(x, _reads((x.node, x.bound), known, whole=True)) for x in program.checks]
    entries = [
        Entry(result.name, place, value, _reads((value,), known, whole=True))
        for result in program.results
        for place, value in enumerate(result.entries)
    ]
    return _placed(order, guards, entries)


def paired(live: Iterable[Node]) -> list[Node]:
    """Sines and cosines of which the other one is needed, too: a compiler makes one call of both."""
    waves = {(node.op, node.a.index): node for node in live if node.op in _PARTNERS}
    return [node for (op, angle), node in waves.items() if (_PARTNERS[op], angle) in waves]


def _reads(operands: Iterable[Operand | None], named: frozenset[int], whole: bool = False) -> Reads:
    """What the text of an operation reads; of `whole` operands, which may be names themselves."""
    steps: dict[int, None] = {}
    arguments: set[str] = set()
    cost = 0 if whole else 1
    pending = [x for x in operands if isinstance(x, Node)]
    while pending:
        node = pending.pop()
        if node.index in named:
            steps[node.index] = None
        elif node.op == SYMBOL:
            arguments.add(str(node.a))
        else:
            cost += 1
            pending += [x for x in (node.a, node.b) if isinstance(x, Node)]
    return Reads(tuple(sorted(steps)), frozenset(arguments), cost)


def _ordered(nodes: Sequence[Node], steps: dict[int, Step]) -> list[int]:
    """The indices of all named nodes: blocks of one label, each right before the first that needs it."""
    blocks: list[list[int]] = []
    block_of: dict[int, int] = {}
    label = None
    for node in nodes:
        if node.label != label:
            label = node.label
            blocks.append([])
        blocks[-1].append(node.index)
        block_of[node.index] = len(blocks) - 1
    needs = [
        sorted({block_of[x] for index in block for x in steps[index].reads.steps})
        for block in blocks
    ]
    order: list[int] = []
    done = [False] * len(blocks)
    # from the last block on, since what is needed by many, such as the base, comes last by itself
    for last in reversed(range(len(blocks))):
        pending = [last]
        while pending:
            block = pending[-1]
            missing = next((x for x in needs[block] if not done[x] and x != block), None)
            if missing is not None:
                pending.append(missing)
                continue
            pending.pop()
            if not done[block]:
                done[block] = True
                order += blocks[block]
    return order


def _together(order: Sequence[int], named: dict[int, Node]) -> list[int]:
    """The same with sine and cosine of an angle next to each other."""
    waves = {(named[x].op, named[x].a.index): x for x in order if named[x].op in _PARTNERS}
    moved: set[int] = set()
    found: list[int] = []
    for index in order:
        if index in moved:
            continue
        found.append(index)
        node = named[index]
        if node.op in _PARTNERS and (_PARTNERS[node.op], node.a.index) in waves:
            other = waves[_PARTNERS[node.op], node.a.index]
            found.append(other)
            moved.add(other)
    return found


def _placed(order: list[Step], guards: list[Guard], entries: list[Entry]) -> list[Item]:
    """Checks as early as can be; entries, too, but none before the last check; constants at the end."""
    at = {step.node.index: place for place, step in enumerate(order)}

    def known_after(item: Item) -> int:
        return max((at[x] for x in item.reads.steps), default=-1)

    after: dict[int, list[Item]] = {}
    last = -1
    for guard in guards:
        after.setdefault(known_after(guard), []).append(guard)
        last = max(last, known_after(guard))
    constants: list[Item] = []
    for entry in entries:
        if entry.reads.steps:
            after.setdefault(max(known_after(entry), last), []).append(entry)
        else:
            constants.append(entry)
    items: list[Item] = [*after.get(-1, ())]
    for place, step in enumerate(order):
        items.append(step)
        items += after.get(place, ())
    return items + constants

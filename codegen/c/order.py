"""The order of a program's lines: related operations stay together, close to their uses.

The derivation goes over all joints in turn, and again for each sweep, so that in the order of
construction hundreds of values wait for the sweep that needs them. Here the lines of one label stay
together, in their order, and these blocks follow each other as their users need them: one branch of
the tree is finished before the next begins. An entry of a result is written as soon as it is known.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.ir.dag import SYMBOL, Node

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.ir.dag import Operand
    from linegraph.ir.program import Check, Program

_PARTNERS = {"sin": "cos", "cos": "sin"}


class NamedStep(NamedTuple):
    """A node gets a name; `needs` are the indices of the named nodes it is computed from."""

    node: Node
    needs: Sequence[int]
    cost: int


class Entry(NamedTuple):
    """An entry of a result is written."""

    result: str
    place: int
    value: Operand
    needs: Sequence[int]
    cost: int


class Guard(NamedTuple):
    """A check; nothing is written before the last one, since a function that fails writes nothing."""

    check: Check
    needs: Sequence[int]
    cost: int


Item = NamedStep | Entry | Guard


def arranged(program: Program, forced: Iterable[Node]) -> list[Item]:
    """The lines of a program in the order in which C computes them.

    Args:
        program: the program.
        forced: nodes that are assigned to variables in addition to the steps of the program.
    """
    named = {node.index: node for node in program.steps}
    named |= {node.index: node for node in forced}
    steps = {
        index: NamedStep(named[index], *_read_by(named[index], named)) for index in sorted(named)
    }
    order = [steps[index] for index in _together(_ordered(list(steps.values())), named)]
    guards = []
    for check in program.checks:
        needs, cost = _reads((check.node, check.bound), named)
        guards.append(Guard(check, needs, cost))
    entries = [
        Entry(result.name, place, value, *_reads((value,), named, 1))
        for result in program.results
        for place, value in enumerate(result.entries)
    ]
    return _placed(order, guards, entries)


def paired(live: Iterable[Node]) -> list[Node]:
    """Sines and cosines of which the other one is needed, too: a compiler makes one call of both."""
    waves = {(node.op, node.a.index): node for node in live if node.op in _PARTNERS}
    return [node for (op, angle), node in waves.items() if (_PARTNERS[op], angle) in waves]


def _read_by(node: Node, named: dict[int, Node]) -> tuple[Sequence[int], int]:
    """The named nodes that a node's operation reads, and the number of operations in its line."""
    return _reads((node.a, node.b), named, 1)


def _reads(
    operands: Iterable[object], named: dict[int, Node], cost: int = 0
) -> tuple[Sequence[int], int]:
    """The indices of the named nodes that an expression reads, and its cost."""
    needs: list[int] = []
    pending = list(operands)
    while pending:
        node = pending.pop()
        if isinstance(node, Node):
            if node.index in named:
                needs.append(node.index)
            elif node.op != SYMBOL:
                cost += 1
                pending.append(node.a)
                pending.append(node.b)
    return needs, cost


def _ordered(steps: Sequence[NamedStep]) -> list[int]:
    """The indices of all named nodes: blocks of one label, each right before the first that needs it."""
    blocks: list[list[int]] = []
    needs: list[set[int]] = []
    block_of: dict[int, int] = {}
    label = None
    for step in steps:
        node = step.node
        if node.label != label:
            label = node.label
            blocks.append([])
            needs.append(set())
        blocks[-1].append(node.index)
        needs[-1].update([block_of[index] for index in step.needs])
        block_of[node.index] = len(blocks) - 1
    order: list[int] = []
    done = [False] * len(blocks)
    waiting = [sorted(found - {place}, reverse=True) for place, found in enumerate(needs)]
    # from the last block on, since what is needed by many, such as the base, comes last by itself
    for last in reversed(range(len(blocks))):
        pending = [last]
        while pending:
            block = pending[-1]
            if done[block]:
                pending.pop()
            elif waiting[block]:
                pending.append(waiting[block].pop())
            else:
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


def _placed(order: list[NamedStep], guards: list[Guard], entries: list[Entry]) -> list[Item]:
    """Checks as early as can be; entries, too, but none before the last check; constants at the end."""
    at = {step.node.index: place for place, step in enumerate(order)}
    after: dict[int, list[Item]] = {}
    last = -1
    for guard in guards:
        known = max((at[x] for x in guard.needs), default=-1)
        after.setdefault(known, []).append(guard)
        last = max(last, known)
    constants: list[Item] = []
    for entry in entries:
        if entry.needs:
            known = max(at[x] for x in entry.needs)
            after.setdefault(max(known, last), []).append(entry)
        else:
            constants.append(entry)
    items: list[Item] = [*after.get(-1, ())]
    for place, step in enumerate(order):
        items.append(step)
        if place in after:
            items += after[place]
    return items + constants

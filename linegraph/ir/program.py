"""Stage 5: a `Program`, the one thing code generation sees.

Named arguments, single assignments in order, named results. Nothing in it knows of bodies or joints; what
a reader should know of them stands in the labels and in the texts of the `Module`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.ir.dag import NEG, SUB, SYMBOL, Node, Operand

if TYPE_CHECKING:
    from collections.abc import Iterable

PREPARED_SUFFIX = "_prepared"
"""How the name of a function ends that takes the constants of `prepare` in place of the parameters."""

INLINE_LIMIT = 6
"""An expression used once is written in place while the line stays below this many operations."""


@dataclass(frozen=True)
class Quantity:
    """A coordinate, input or parameter, as the head of an emitted file lists it."""

    name: str
    unit: str
    about: str = ""
    value: float | None = None


@dataclass(frozen=True)
class Argument:
    """An argument of a function: an array of `size` numbers, ``p`` (the parameters) or ``t`` (a number).

    Attributes:
        count: the name of the count that `size` is, ``NV`` say, or nothing.
    """

    name: str
    size: int | None
    about: str
    count: str = ""


@dataclass(frozen=True)
class Result:
    """A result of a function: a dense array with its `entries` in row-major order.

    Attributes:
        counts: for each extent the name of the count that it is, ``NV`` say, or nothing; none if all are
            plain numbers.
    """

    name: str
    shape: tuple[int, ...]
    entries: tuple[Operand, ...]
    about: str
    counts: tuple[str, ...] = ()


@dataclass(frozen=True)
class Check:
    """After `node` is known: unless ``node > bound``, stop with `status`, results untouched.

    Attributes:
        status, about, name: the number, the meaning and the name of the status (`statuses`).
        fraction: of `bound` is what the node must exceed; it stands for the rounding of doubles.
    """

    node: Node
    bound: Operand
    status: int
    about: str
    name: str = ""
    fraction: float | None = None


@dataclass(frozen=True)
class Call:
    """Run another program first; its results become local arrays of these names and sizes."""

    program: str
    arguments: tuple[str, ...]
    results: tuple[Argument, ...]


@dataclass(frozen=True, repr=False)
class Program:
    """One function: ``results = name(arguments)``.

    Attributes:
        steps: the nodes that are assigned to variables, each after its operands.
        status: whether it returns a status in languages without exceptions, even if no check can fail.
        turned: indices of differences a - b that are computed as b - a, since only their negative is used.
        handed: the function to which the work is delegated, which computes the same from the constants of
            `prepare`; empty if the function is emitted in full.
        guarded: indices of divisions whose divisor may be zero; the functions that use them check it.
    """

    name: str
    about: str
    arguments: tuple[Argument, ...]
    steps: tuple[Node, ...]
    results: tuple[Result, ...]
    turned: frozenset[int] = frozenset()
    checks: tuple[Check, ...] = ()
    calls: tuple[Call, ...] = ()
    status: bool = False
    handed: str = ""
    guarded: frozenset[int] = frozenset()

    def __repr__(self) -> str:
        """Its name, arguments and cost."""
        arguments = ", ".join(argument.name for argument in self.arguments)
        return f"<program {self.name}({arguments}): {self.operations} operations>"

    @cached_property
    def live(self) -> list[Node]:
        """All nodes that results and checks need, each after its operands."""
        return _live(_roots(self.results, self.checks))

    @property
    def operations(self) -> int:
        """Arithmetic operations and function calls executed: every node once; a change of sign is free."""
        return operations_of(self.results, self.checks)


class Status(NamedTuple):
    """A status code other than 0: its number, its meaning and its name."""

    number: int
    about: str
    name: str


@dataclass(frozen=True)
class Routine:
    """A function with loops or branches, whose body is an algorithm of `linegraph.ir.algorithms`.

    Attributes:
        algorithm: its name in `linegraph.ir.reading.ALGORITHMS`.
        statuses: the statuses other than 0 that it may return by itself.
        uses: the functions it calls.
        details: facts of the model that the algorithm needs: numbers and lists of numbers, by name.
        handed: as in `Program`.
    """

    name: str
    about: str
    arguments: tuple[Argument, ...]
    results: tuple[Result, ...]
    algorithm: str
    statuses: tuple[Status, ...]
    uses: tuple[str, ...]
    details: tuple[tuple[str, Any], ...] = ()
    status: bool = True
    calls: tuple[Call, ...] = ()
    handed: str = ""


@dataclass(frozen=True)
class Listing:
    """Quantities of one kind, listed in the head of a file and by a count and an array of names.

    Attributes:
        symbol: the symbol of the quantities in formulas and in the array's name.
        count: the name of their number; empty for those without count and array.
        heading: the kind of quantity, in the plural.
        sizes: the results that have so many entries.
        groups: in the head of a file, one row each; a group's name and how many quantities it has.
        shown: whether the head of a file lists them.
    """

    symbol: str
    count: str
    heading: str
    quantities: tuple[Quantity, ...]
    sizes: tuple[str, ...] = ()
    groups: tuple[tuple[Quantity, int], ...] = ()
    shown: bool = True


@dataclass(frozen=True, repr=False)
class Module:
    """All functions of one model, with the descriptions that are emitted with them.

    Attributes:
        name: the prefix of everything emitted; an identifier.
        about: paragraphs for the head of the file.
        time: whether the functions take the time ``t``.
        listings: further quantities of the model's functions.
        counts: further numbers that have a name.
        omitted: the functions that are left out as they divide by a singular mass matrix.
    """

    name: str
    about: tuple[str, ...]
    positions: tuple[Quantity, ...]
    velocities: tuple[Quantity, ...]
    inputs: tuple[Quantity, ...]
    parameters: tuple[Quantity, ...]
    time: bool
    programs: tuple[Program | Routine, ...]
    listings: tuple[Listing, ...] = ()
    counts: tuple[tuple[str, int], ...] = ()
    omitted: tuple[str, ...] = ()

    def __repr__(self) -> str:
        """Its name and functions."""
        return f"<module {self.name}: {', '.join(program.name for program in self.programs)}>"


def named_listings(module: Module) -> tuple[Listing, ...]:
    """The listings for which a count and an array of names are emitted."""
    return (
        Listing("q", "NQ", "positions", module.positions),
        Listing("v", "NV", "velocities", module.velocities),
        Listing("u", "NU", "inputs", module.inputs),
        *module.listings,
    )


def counts_of(module: Module) -> dict[str, int]:
    """The numbers of positions, velocities, inputs and so on, by the names they have in all languages."""
    return {x.count: len(x.quantities) for x in named_listings(module)} | dict(module.counts)


class Guards(NamedTuple):
    """Conditions and calls that come before the results of a function.

    Attributes:
        checks: conditions at which it reports a status instead.
        calls: functions that it calls first, whose results it reads.
        status: whether it reports one even without checks of its own, as those that it calls do.
    """

    checks: tuple[Check, ...] = ()
    calls: tuple[Call, ...] = ()
    status: bool = False


UNGUARDED = Guards()


def assemble(
    name: str,
    about: str,
    arguments: tuple[Argument, ...],
    results: tuple[Result, ...],
    guards: Guards = UNGUARDED,
) -> Program:
    """A program with the operations that its results and checks need, in order.

    An operation is assigned to a variable if it is used more than once or checked, or if the line would
    otherwise have more than `INLINE_LIMIT` operations.

    Args:
        name: of the function.
        about: its description, a sentence for the comment above it.
        arguments: all that it reads, in the order of its parameters.
        results: all that it writes, in the order of its parameters.
        guards: its checks, and the functions it calls first.
    """
    checks = guards.checks
    live = _live(_roots(results, checks))
    uses, negated = count_uses(live, results, checks)
    turned = frozenset(
        node.index
        for node in live
        if node.op == SUB and uses[node.index] == negated.get(node.index, 0)
    )
    steps = _named(live, uses, {check.node.index for check in checks})
    return Program(name, about, arguments, steps, results, turned, *guards)


def operations_of(results: tuple[Result, ...], checks: tuple[Check, ...] = ()) -> int:
    """The number of operations that results and checks take together; a change of sign is free.

    Args:
        results: the results; operations that they share count once.
        checks: the checks; a bound that is scaled by a fraction takes one more operation.
    """
    scaled = sum(x.fraction is not None and isinstance(x.bound, Node) for x in checks)
    return scaled + len(_operations(_roots(results, checks)))


def leaves(x: Operand) -> int:
    """The number of symbols and numbers in a fully expanded operand, where shared parts are repeated.

    Example:
        >>> from linegraph.ir.dag import Dag
        >>> x = Dag().symbol("x")
        >>> square = (x + 1) * (x + 2)
        >>> leaves(square * square + x)
        9
    """
    if not isinstance(x, Node):
        return 1
    counts: dict[int, int] = {}
    for node in _live([x]):
        operands = () if node.op == SYMBOL else (p for p in (node.a, node.b) if p is not None)
        counts[node.index] = (
            sum(counts[p.index] if isinstance(p, Node) else 1 for p in operands) or 1
        )
    return counts[x.index]


def needed_for(entries: Iterable[Operand]) -> frozenset[int]:
    """The indices of the operations that some entries take together."""
    return frozenset(_operations([entry for entry in entries if isinstance(entry, Node)]))


def _operations(roots: list[Node]) -> list[int]:
    return [node.index for node in _live(roots) if node.op not in (SYMBOL, NEG)]


def reads(argument: str, results: tuple[Result, ...]) -> bool:
    """Whether any result depends on an argument.

    Args:
        argument: the name of the argument.
        results: the results of a function.
    """
    live = _live(_roots(results, ()))
    return any(node.op == SYMBOL and node.a == argument for node in live)


def _roots(results: tuple[Result, ...], checks: tuple[Check, ...]) -> list[Node]:
    roots = [entry for result in results for entry in result.entries if isinstance(entry, Node)]
    for check in checks:
        roots += [x for x in (check.node, check.bound) if isinstance(x, Node)]
    return roots


def _live(roots: Iterable[Node]) -> list[Node]:
    """All nodes that `roots` depend on, in order of construction; without recursion."""
    found = {node.index: node for node in roots}
    pending = list(found.values())
    while pending:
        node = pending.pop()
        for operand in (node.a, node.b):
            if isinstance(operand, Node) and operand.index not in found:
                found[operand.index] = operand
                pending.append(operand)
    return [found[index] for index in sorted(found)]


def count_uses(
    live: list[Node], results: tuple[Result, ...], checks: tuple[Check, ...]
) -> tuple[dict[int, int], dict[int, int]]:
    """How often each node is used, and how often of that only to be negated.

    Args:
        live: all nodes of a program, each after its operands.
        results: of the program; each entry is a use.
        checks: of the program; what is compared is used, too.
    """
    uses = dict.fromkeys((node.index for node in live), 0)
    negated: dict[int, int] = {}
    for root in _roots(results, checks):
        uses[root.index] += 1
    for node in reversed(live):
        if node.op == NEG:
            # a negation is written in place, so each of its uses is one of its operand
            uses[node.a.index] += uses[node.index]
            negated[node.a.index] = uses[node.index]
            continue
        for operand in (node.a, node.b):
            if isinstance(operand, Node):
                uses[operand.index] += 1
    return uses, negated


def _named(live: list[Node], uses: dict[int, int], forced: set[int]) -> tuple[Node, ...]:
    """The nodes worth a name: shared ones, checked ones and those that would make a line too long."""
    size: dict[int, int] = {}
    named = []
    for node in live:
        index = node.index
        if node.op == SYMBOL:
            size[index] = 0
            continue
        total = 1
        for operand in (node.a, node.b):
            if isinstance(operand, Node):
                total += size[operand.index]
        if node.op != NEG and (uses[index] > 1 or total > INLINE_LIMIT or index in forced):
            named.append(node)
            total = 0
        size[index] = total
    return tuple(named)

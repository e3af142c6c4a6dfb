"""The prologue: `prepare` computes all that depends on parameters alone, for use by other functions.

Every function of `is_prepared` gets a twin that takes the constants c in place of the parameters p. Every
value of parameters alone that it uses is an entry of c, a parameter itself, too; `parameter_constants` brings
together what can be.

A function of parameters hands its work to its twin where that costs about the same, so that the arithmetic
is emitted once. Short ones stay whole, and so do those that could then fail where they do not now, as a
division by zero is an error in some languages. Where a check of some function stands before such a division
it is none: `prepare` goes on, and the check tells.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

from linegraph.ir.dag import DIV, NEG, SYMBOL, Dag, Node, Operand
from linegraph.ir.parameter_constants import Restructured, ends, is_constant, remade, rewritten
from linegraph.ir.program import PREPARED_SUFFIX, Argument, Call, Program, Result, Routine, assemble
from linegraph.ir.sums import collected, with_sums_collected

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

PREPARE = "prepare"
COUNT = "NK"
"""The name of the number of constants."""

PREPARED = (
    "loop_equations",
    "algebraic_loop",
    "mass_matrix",
    "bias",
    "equations",
    "inverse_dynamics",
    "constraints",
    "constraint_jacobian",
    "constraint_rates",
    "constraint_bias",
    "constrained_equations",
    "constraint_sizes",
    "forward_dynamics",
    "coordinate_rates",
    "rhs",
    "project",
    "complete",
    "reduction",
    "reduced_equations",
    "center_of_mass",
    "center_of_mass_velocity",
    "center_of_mass_jacobian",
    "momentum",
    "centroidal_momentum_matrix",
    "centroidal_momentum_bias",
    "kinematics",
    "constrained_slopes",
    "linearize",
    "inverse_dynamics_derivatives",
    "forward_dynamics_derivatives",
    "regressor",
)
"""The functions of simulation and control; the others read what few parameters they need themselves."""

PREPARED_PREFIX = "frame_"
"""The prefix of functions of frames, all of which are prepared, too."""

SHORT = 100
"""Functions with fewer operations are emitted in full, which is easier to read."""

MOST_MORE = 1 / 8
"""A function called alone may take this share more than it would without `prepare`."""

T = TypeVar("T", bound=Program | Routine)


def is_prepared(function: str) -> bool:
    """Whether a function gets a twin that takes the constants.

    Example:
        >>> is_prepared("equations"), is_prepared("frame_hand_pose"), is_prepared("energy")
        (True, True, False)
    """
    return function in PREPARED or function.startswith(PREPARED_PREFIX)


def with_prologue(
    programs: Sequence[Program | Routine],
) -> tuple[tuple[Program | Routine, ...], int]:
    """Add `prepare` and the functions that read its constants.

    Returns:
        All functions, and how many constants there are: none where no function depends on parameters.
    """
    given = [p for p in programs if isinstance(p, Program) and is_prepared(p.name)]
    twins = Restructured().programs(given)
    constants = _Constants(twins)
    if not constants.entries:
        return with_sums_collected(programs), 0
    met = _Met(constants.entries)
    reading = [met.read_by(collected(constants.read_by(twin))) for twin in twins]
    entries = tuple(met.entries)
    about = (
        "Prologue: all that depends on parameters alone. Call it once, and again whenever p changes; the "
        f"functions whose names end in {PREPARED_SUFFIX} take its constants c in place of p."
    )
    parameters = next(a for a in given[0].arguments if a.name == "p")
    result = Result("c", (len(entries),), entries, "constants")
    prologue = assemble(PREPARE, about, (parameters,), (result,))
    judged = _judged(twins)
    guarded = (n.index for n in prologue.live if n.op == DIV and n.b.index in judged)
    prologue = collected(replace(prologue, guarded=frozenset(guarded)))
    found: dict[str, Program | Routine] = {
        own.name: replace(x, arguments=_sized(x.arguments, len(entries)))
        for own, x in zip(given, reading, strict=True)
    }
    found |= {
        p.name: _twin(p, len(entries))
        for p in programs
        if isinstance(p, Routine) and is_prepared(p.name)
    }
    handing = _Handing(programs, prologue)
    whole: list[Program | Routine] = [prologue]
    for program in with_sums_collected(programs):
        if program.name not in found:
            whole.append(program)
            continue
        whole += [handing.of(program), found[program.name]]
    return tuple(whole), len(entries)


class _Constants:
    """The largest values of parameters alone that programs use, and the programs that read them from c.

    Attributes:
        entries: these values, in the order in which they were derived.
    """

    def __init__(self, programs: Sequence[Program]) -> None:
        # of its own, too, so that what reads constants keeps its place among the rest
        self._dag = dag = Dag()
        self._known: dict[int, Operand] = {}
        constant: dict[int, bool] = {}
        nodes = {node.index: node for program in programs for node in program.live}
        used: dict[int, Node] = {}
        varying = [node for _, node in sorted(nodes.items()) if not is_constant(node, constant)]
        operands = [x for node in varying if node.op != SYMBOL for x in (node.a, node.b)]
        for x in (*operands, *(x for program in programs for x in ends(program))):
            if isinstance(x, Node) and is_constant(x, constant):
                value = x.a if x.op == NEG else x
                used[value.index] = value
        self.entries = [used[index] for index in sorted(used)]
        for place, value in enumerate(self.entries):
            self._known[value.index] = dag.symbol("c", place)
        for node in varying:
            dag.label = node.label
            self._known[node.index] = remade(dag, node, self._of)
        dag.release()

    def read_by(self, program: Program) -> Program:
        """The twin of a program."""
        return rewritten(_twin(program, len(self.entries)), self._of)

    def _of(self, x: Operand) -> Operand:
        if not isinstance(x, Node):
            return x
        known = self._known.get(x.index)
        return self._dag.negate(self._known[x.a.index]) if known is None else known


class _Met:
    """Constants that met in collected sums: what an operation makes of constants alone is one more of them.

    Attributes:
        entries: all constants, as values of the parameters.
    """

    def __init__(self, entries: Sequence[Node]) -> None:
        self.entries = list(entries)
        self._dag = entries[0].dag
        self._places = {node.index: place for place, node in enumerate(entries)}

    def read_by(self, program: Program) -> Program:
        """A program that reads constants, without operations on constants alone."""
        values: dict[int, Operand] = {}
        known: dict[int, Operand] = {}
        dag = Dag()

        def value(x: Operand) -> Operand:
            return values[x.index] if isinstance(x, Node) else x

        def of(x: Operand) -> Operand:
            if not isinstance(x, Node):
                return x
            if x.index not in known:
                known[x.index] = self._constant(dag, values[x.index])
            return known[x.index]

        for node in program.live:
            operands = [x for x in (node.a, node.b) if isinstance(x, Node)]
            if node.op == SYMBOL and node.a == "c":
                values[node.index] = self.entries[node.b]
            elif operands and all(x.index in values for x in operands):
                values[node.index] = remade(self._dag, node, value)
        if all(node.op in (SYMBOL, NEG) for node in program.live if node.index in values):
            return program
        for node in program.live:
            dag.label = node.label
            if node.index not in values:
                known[node.index] = remade(dag, node, of)
        return rewritten(program, of)

    def _constant(self, dag: Dag, value: Operand) -> Operand:
        """A constant by its value: a number, or where it stands in c."""
        if not isinstance(value, Node):
            return value
        if value.op == NEG:
            return dag.negate(self._constant(dag, value.a))
        place = self._places.setdefault(value.index, len(self.entries))
        if place == len(self.entries):
            self.entries.append(value)
        return dag.symbol("c", place)


@dataclass(frozen=True)
class _Cost:
    """The operations of a function, including those of the functions it calls.

    Attributes:
        total: its operations.
        constant: those that depend on parameters alone.
        divisors: what it divides by of these.
    """

    total: int
    constant: frozenset[int]
    divisors: frozenset[int]


class _Handing:
    """Decides which functions hand their work to their twins."""

    def __init__(self, programs: Sequence[Program | Routine], prologue: Program) -> None:
        self._programs = {program.name: program for program in programs}
        self._prologue = prologue
        self._constant: dict[int, bool] = {}
        self._costs: dict[str, _Cost] = {}
        costs = [self._cost(p.name) for p in programs if is_prepared(p.name)]
        every = frozenset[int]().union(*(cost.divisors for cost in costs))
        self._divisors = every - _judged(p for p in programs if isinstance(p, Program))

    def of(self, program: T) -> T:
        """The function, with its work delegated to its twin where that pays."""
        return (
            replace(program, handed=program.name + PREPARED_SUFFIX)
            if self._hands(program)
            else program
        )

    def _hands(self, program: Program | Routine) -> bool:
        cost = self._cost(program.name)
        if not self._divisors <= cost.divisors:
            return False
        if isinstance(program, Routine):
            # it may call functions many times: prepared once for all
            return any(self._hands(self._programs[name]) for name in program.uses)
        size = len(self._prologue.results[0].entries)
        more = self._prologue.operations + size / 2 - len(cost.constant)
        return cost.total >= SHORT and more <= MOST_MORE * cost.total

    def _cost(self, name: str) -> _Cost:
        if name not in self._costs:
            self._costs[name] = self._counted(self._programs[name])
        return self._costs[name]

    def _counted(self, program: Program | Routine) -> _Cost:
        if isinstance(program, Routine):
            inner = [self._cost(name) for name in program.uses]
            return _together(inner)
        inner = [self._cost(call.program) for call in program.calls]
        live = [node for node in program.live if node.op != SYMBOL]
        constant = [node for node in live if is_constant(node, self._constant)]
        divisors = [n.b for n in live if n.op == DIV and is_constant(n.b, self._constant)]
        own = _Cost(
            program.operations,
            frozenset(node.index for node in constant if node.op != NEG),
            frozenset(x.index for x in divisors if isinstance(x, Node)),
        )
        return _together([own, *inner])


def _judged(programs: Iterable[Program]) -> frozenset[int]:
    """The indices of the checked nodes, without changes of sign and absolute values."""

    def bare(node: Node) -> Node:
        return bare(node.a) if node.op in ("abs", NEG) else node

    return frozenset(bare(check.node).index for program in programs for check in program.checks)


def _twin(program: T, size: int) -> T:
    """A function that takes the constants for the parameters, as do those it calls."""
    constants = Argument("c", size, f"constants, what {PREPARE} makes of the parameters")
    about = f"{program.name} from the constants of {PREPARE}. {program.about}"
    given = tuple(constants if a.name == "p" else a for a in program.arguments)
    name = program.name + PREPARED_SUFFIX
    if isinstance(program, Routine):
        uses = tuple(called + PREPARED_SUFFIX for called in program.uses)
        return replace(program, name=name, about=about, arguments=given, uses=uses)
    calls = tuple(
        Call(
            call.program + PREPARED_SUFFIX,
            tuple("c" if a == "p" else a for a in call.arguments),
            call.results,
        )
        for call in program.calls
    )
    return replace(program, name=name, about=about, arguments=given, calls=calls)


def _sized(arguments: Iterable[Argument], size: int) -> tuple[Argument, ...]:
    """The arguments of a twin, with the number of constants filled in."""
    return tuple(replace(a, size=size) if a.name == "c" else a for a in arguments)


def _together(costs: Sequence[_Cost]) -> _Cost:
    none = frozenset[int]()
    return _Cost(
        sum(cost.total for cost in costs),
        none.union(*(cost.constant for cost in costs)),
        none.union(*(cost.divisors for cost in costs)),
    )

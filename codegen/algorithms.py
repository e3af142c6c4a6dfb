"""The algorithms of a module, bound to it, as all languages print them.

Procedures that call none of the module's functions are shared by all routines; the others belong to one
routine, whose arguments they pass on.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from codegen import failures
from linegraph.ir.binding import Surroundings, bound
from linegraph.ir.program import Routine, counts_of
from linegraph.ir.statement_walks import expressions, nested, operands
from linegraph.ir.statements import NamedNumber

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.ir.program import Module, Program
    from linegraph.ir.statements import Procedure

CONSTANTS = "c"
"""The argument that holds the constants of `prepare`; it may be infinite where a check detects that."""

BATCHED = ("after_dynamics", "rhs")
"""Algorithms that only call others, so that they take many states at once where those do."""


@dataclass(frozen=True)
class Algorithms:
    """The procedures of a module's algorithms, in the order in which they are printed.

    Attributes:
        shared: the procedures that routines share, each after those that it calls.
        own: for each routine by name those of its own, its body last.
    """

    shared: tuple[Procedure, ...]
    own: dict[str, tuple[Procedure, ...]]

    def all(self) -> Iterable[Procedure]:
        """Every procedure, the shared ones first."""
        yield from self.shared
        for procedures in self.own.values():
            yield from procedures

    def codes(self) -> list[NamedNumber]:
        """The numbers with names that are used, in order."""
        found = {
            x: None
            for procedure in self.all()
            for statement in nested(procedure.body)
            for whole in expressions(statement)
            for x in operands(whole)
            if isinstance(x, NamedNumber)
        }
        return sorted(found, key=lambda x: (x.value, x.name))


def of(module: Module) -> Algorithms:
    """All algorithms of a module.

    Raises:
        ValueError: two routines need different text of a procedure that they share.
    """
    fails = frozenset(name for name, found in failures.statuses(module).items() if found)
    programs = {program.name: program for program in module.programs}
    around = Surroundings(programs, counts_of(module), fails)
    shared: dict[str, Procedure] = {}
    own: dict[str, tuple[Procedure, ...]] = {}
    for program in module.programs:
        if not isinstance(program, Routine) or program.handed:
            continue
        *others, body = bound(program, around)
        for procedure in others:
            if procedure.uses:
                continue
            if shared.setdefault(procedure.name, procedure) != procedure:
                raise ValueError(f"{procedure.name} is not the same for all routines")
        own[program.name] = (*(x for x in others if x.uses), body)
    return Algorithms(tuple(shared.values()), own)


def is_single(program: Program | Routine) -> bool:
    """Whether a function decides by the numbers of one state, and so takes one state at a time."""
    if not isinstance(program, Routine) or program.handed:
        return False
    return program.algorithm not in BATCHED

"""Long equations in readable form: named intermediates, grouped by joint and body."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from linegraph.ir.dag import SYMBOL, Node
from linegraph.ir.program import Program
from linegraph.notation.tree import FUNCTION, ZERO, Math, Name
from linegraph.programs.register import module_of
from linegraph.programs.request import Request
from linegraph.report.document import EquationRow, Group, IntermediateList
from linegraph.report.nodes import Nodes

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.report.subject import Subject

CONSTRAINTS = ("constraints", "constraint_jacobian", "constraint_bias")

ONLY = {
    "equations": ("equations", ("equations",)),
    "constrained": ("constraints", ("equations", *CONSTRAINTS)),
    "constraints": ("constraints", CONSTRAINTS),
    "reactions": ("reactions", ("reactions_at",)),
}
"""For each listing the functions to derive, and those of them to show."""

ENTRIES = {"q": "q", "v": "v", "a": "v", "u": "u"}
"""Letters of vectors whose entries are numbered in the table of coordinates."""

LETTERS = {"gamma": "γ", "gam": "γ", "phi": "φ"}


def symbols_of(subject: Subject, *, entries: bool = False) -> Callable[[str, Any], Math]:
    """Return a function that typesets the symbols of programs.

    Args:
        subject: the derivation with its notation.
        entries: whether q, v, v̇ and u are written as numbered entries, for long listings.
    """
    arguments = {
        "q": subject.q_names,
        "v": subject.v_names,
        "a": subject.a_names,
        "u": subject.u_names,
        "lam": [quantity.name for quantity in subject.multipliers],
        "loop": subject.loop_names,
    }

    taken = {(name.letter, name.subs) for name in subject.look.names.values()}
    short = {
        argument
        for argument, letter in ENTRIES.items()
        if not any((letter, (str(k + 1),)) in taken for k in range(len(arguments[argument])))
    }

    def symbol(argument: str, place: Any) -> Math:
        if entries and argument in short:
            look = subject.look.name(arguments[argument][place])
            own = Name(ENTRIES[argument], (str(place + 1),), dots=int(argument == "a"))
            return replace(own, role=look.role, place=place)
        if argument in arguments:
            return subject.look.name(arguments[argument][place])
        return subject.look.name(argument if place is None else str(place))

    return symbol


def listed_program(subject: Subject, which: str) -> tuple[IntermediateList, list[EquationRow], int]:
    """List the steps of a program.

    Args:
        subject: the derivation with its notation.
        which: a key of `ONLY`.

    Returns:
        The intermediates, the results in terms of them, and the number of operations.
    """
    only, shown = ONLY[which]
    module = module_of(
        subject.derivation,
        "report",
        Request(
            folded=subject.folded,
            only=(only,) if which != "constrained" else ("constraints", "equations"),
            prologue=False,
        ),
    )
    programs = [p for p in module.programs if isinstance(p, Program) and p.name in shown]
    groups: list[Group] = []
    results: list[EquationRow] = []
    listing = _Steps(subject)
    for program in programs:
        groups += listing.groups(program)
        results += listing.results(program)
    return IntermediateList(tuple(groups)), results, sum(program.operations for program in programs)


class _Steps:
    """Names intermediates in order, continuing through several programs."""

    def __init__(self, subject: Subject) -> None:
        self._subject = subject
        self._symbol = symbols_of(subject, entries=True)
        self._count = 0
        taken = {(name.letter, name.subs) for name in subject.look.names.values()}
        size = range(1, len(subject.q_names) + 1)
        self._trig = {
            op: next(x for x in letters if not any((x, (str(k),)) in taken for k in size))
            for op, letters in (("sin", ("s", "S", "σ")), ("cos", ("c", "C", "κ")))
        }
        free = (x for x in ("z", "Z", "y", "ζ", "η") if not any(letter == x for letter, _ in taken))
        self._letter = next(free, "z'")
        self._known: dict[tuple[int, bool], Name] = {}

    def groups(self, program: Program) -> list[Group]:
        """The steps of a program by label, without those named before."""
        self._nodes = Nodes(self._symbol, program.turned)
        # Programs share nodes: a node that has a name keeps it.
        for (index, turned), name in self._known.items():
            if turned == (index in program.turned):
                self._nodes.known[index] = name
        found: list[tuple[str, list[EquationRow]]] = []
        for node in program.steps:
            if not found or found[-1][0] != node.label:
                found.append((node.label, []))
            if node.index in self._nodes.known:
                continue
            right = self._nodes.named(node)
            name = self._name(node)
            self._nodes.known[node.index] = name
            self._known[node.index, node.index in program.turned] = name
            found[-1][1].append(EquationRow(name, right))
        return [Group(label.replace("->", "→"), tuple(rows)) for label, rows in found if rows]

    def _name(self, node: Node) -> Name:
        a = node.a
        if node.op in self._trig and isinstance(a, Node) and a.op == SYMBOL and a.a == "q":
            return Name(self._trig[node.op], (str(a.b + 1),), role=FUNCTION, place=a.b)
        self._count += 1
        return Name(self._letter, (str(self._count),), place=self._count)

    def results(self, program: Program) -> list[EquationRow]:
        """Results of a program, without zeros and the lower half of symmetric matrices."""
        rows = []
        for result in program.results:
            columns = result.shape[1] if len(result.shape) > 1 else 0
            for k, entry in enumerate(result.entries):
                i, j = divmod(k, columns) if columns else (k, 0)
                if (
                    columns
                    and j < i
                    and columns == result.shape[0]
                    and _alike(result, i, j, columns)
                ):
                    continue
                tree = self._nodes(entry)
                if tree == ZERO:
                    continue
                rows.append(EquationRow(self._result(result.name, i, j, bool(columns)), tree))
        return rows

    def _result(self, name: str, i: int, j: int, square: bool) -> Name:
        if name == "R":
            return self._reaction(i)
        letter = LETTERS.get(name, name)
        return Name(letter, (str(i + 1), str(j + 1)) if square else (str(i + 1),))

    def _reaction(self, place: int) -> Name:
        """Symbol of a reaction: force and torque of each joint, then through variables of networks."""
        joints, network = list(self._subject.tree.ends), self._subject.network
        joint, component = divmod(place, 6)
        if joint < len(joints):
            letter = "f" if component < 3 else "τ"
            return Name(letter, (joints[joint], "xyz"[component % 3]))
        assert network is not None
        edges = [branch for branch in network.branches if not branch.port.spatial]
        edge = edges[place - 6 * len(joints)]
        return self._subject.through(edge.port.domain, edge.name)


def _alike(result: Any, i: int, j: int, columns: int) -> bool:
    return bool(result.entries[i * columns + j] is result.entries[j * columns + i])

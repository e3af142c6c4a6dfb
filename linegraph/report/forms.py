"""The equations of motion: in closed form if short, else with named intermediates."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.dynamics.regularity import cause
from linegraph.errors import ModelError
from linegraph.ir.program import Result, leaves, operations_of
from linegraph.notation.plain import Plain
from linegraph.notation.tree import (
    ONE,
    TRANSPOSED,
    ZERO,
    Grid,
    Math,
    Name,
    Power,
    Product,
    parts,
    product,
    total,
)
from linegraph.notation.writing import pieces
from linegraph.report.document import (
    Block,
    Code,
    EquationRow,
    Formulas,
    Inline,
    Section,
    said,
)
from linegraph.report.intermediates import listed_program
from linegraph.report.laws import vector
from linegraph.report.system import letter, listed, motion_equation

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from linegraph.report.subject import Subject

MOST_OPERATIONS = 250
"""Largest number of operations of quantities for which closed forms are tried."""

MOST_PRODUCTS = 3000
"""Largest number of products of two terms spent on one quantity's closed form."""

MOST_PRINTED = 3600
"""Largest number of readable characters: of M and h, of φ, J and γ, of all reactions."""

MOST_LEAVES, MOST_WRITTEN = 2000, 40000
"""Largest number of symbols and numbers of an effort, and of characters of all efforts."""

WIDEST_PIECE = 84
"""Largest number of characters of a readable closed form without a possible line break."""

WIDEST_GRID = 72
"""A wider matrix (characters) is written entry by entry."""


class Forms:
    """The equations of motion of a report, in the sections that follow the principle."""

    def __init__(self, subject: Subject, tell: Callable[[str], None]) -> None:
        """Count operations; closed forms are computed on demand.

        Args:
            subject: the derivation and its notation.
            tell: called with a short text at each stage.
        """
        self._subject, self._tell = subject, tell
        self._functions = subject.equations

    # -- how long they are

    @cached_property
    def short(self) -> bool:
        """Whether M and h are short enough for closed form."""
        f = self._functions
        entries = (*f.mass_result.entries, *f.bias_beside_mass.entries)
        return self._readable(entries, lambda: [self.closed.mass_matrix, self.closed.bias])

    @cached_property
    def short_constraints(self) -> bool:
        """Whether φ, J and γ are short enough for closed form."""
        f = self._functions
        entries = [*f.constraints, *(x for row in f.jacobian for x in row), *f.constraint_bias]
        form = self.closed
        return self._readable(
            entries, lambda: [form.constraints, form.constraint_jacobian, form.constraint_bias]
        )

    @cached_property
    def short_reactions(self) -> bool:
        """Whether reactions are short enough for closed form."""
        names = [joint.name for joint in self._subject.model.joints]
        scheme = self._functions.edges
        entries = [x for n in names for part in scheme.reaction(n) for x in part]
        return self._readable(entries, lambda: [x for n in names for x in self.closed.reaction(n)])

    def _readable(self, entries: Sequence[Any], closed: Callable[[], list[Any]]) -> bool:
        """Whether closed forms are readable; operations are counted first, which costs less."""
        result = Result("", (len(entries),), tuple(entries), "")
        if operations_of((result,)) > MOST_OPERATIONS:
            return False
        try:
            trees = [self.tree(x) for x in closed()]
        except ModelError:
            return False  # too many terms
        if sum(len(Plain()(tree)) for tree in trees) > MOST_PRINTED:
            return False
        cells = [x for t in trees for x in (parts(t) if isinstance(t, Grid) else (t,))]
        return all(len(p) <= WIDEST_PIECE for x in cells for _, p in pieces(Plain().marked(x)))

    @cached_property
    def _energies(self) -> tuple[Any, ...]:
        """Kinetic, potential and stored energy; empty if too long."""
        try:
            found = tuple(self.closed.energy)
        except ModelError:
            return ()
        size = sum(len(Plain()(self.tree(x))) for x in found)
        return found if size <= MOST_PRINTED else ()

    # -- closed forms

    @cached_property
    def closed(self) -> Any:
        """Closed forms of the derivation, simplified to the requested level."""
        return self._subject.derivation.closed_form(
            self._subject.level, budget=MOST_PRODUCTS, progress=self._tell
        )

    def tree(self, expression: Any) -> Math:
        """Convert a SymPy expression to a formula."""
        return self._subject.look.tree(self._subject.valued(expression))

    # -- sections

    def sections(self) -> list[Section]:
        """Sections on M, h and Q, constraints, scalar equations, energy and reactions."""
        found = [self._motion()]
        if self._subject.tree.closed:
            found.append(self._loops())
        if self.short:
            found.append(self._written_out())
        if self.short and self._energies:
            found.append(self._energy())
        if self._subject.model.joints:
            found.append(self._reactions())
        return found

    def _motion(self) -> Section:
        self._tell("equations of motion")
        subject = self._subject
        blocks: list[Block] = [
            said("In ", motion_equation(subject), " the mass matrix, the bias and the forces are")
        ]
        if self.short:
            blocks += self._matrix("M", self.closed.mass_matrix, symmetric=True)
            blocks += self._matrix("h", self.closed.bias)
            blocks += self._matrix("Q", self.closed.forces)
        else:
            blocks += self._listed("constrained" if self._whole else "equations")
            blocks += self._forces()
        if self._subject.tree.positions:
            blocks += self._rates()
        if idle := subject.derivation.idle:
            why = (
                f"The mass matrix is singular, since {cause(idle)}: it determines no accelerations."
            )
            blocks.append(said(why))
        return Section("Equations of motion", tuple(blocks))

    @property
    def _whole(self) -> bool:
        """Whether constraints are listed together with M and h."""
        return self._subject.tree.closed and not self.short_constraints

    def _forces(self) -> list[Block]:
        """Q of a long system: mostly one effort in each row."""
        efforts = self._functions.forces
        # Count first: expanded, a few hundred shared operations may become millions.
        entries = [self._nodes(x, entries=True) for x in efforts if leaves(x) <= MOST_LEAVES]
        if len(entries) < len(efforts) or len(str(entries)) > MOST_WRITTEN:
            return [said("Q is listed with the functions that `emit` writes.")]
        rows = [EquationRow(Name("Q", (str(k),)), x) for k, x in enumerate(entries, 1)]
        return [said("The forces are"), Formulas(tuple(rows))]

    def _nodes(self, x: Any, *, entries: bool = False) -> Math:
        from linegraph.report.intermediates import symbols_of
        from linegraph.report.nodes import Nodes

        return Nodes(symbols_of(self._subject, entries=entries))(x)

    def _listed(self, which: str) -> list[Block]:
        listing, results, operations = listed_program(self._subject, which)
        text = (
            f"They are too long to be read in one piece ({operations} operations), so parts that are used "
            "again have names z, and s and c are sines and cosines; coordinates, velocities and inputs go by "
            "their places in the table above. Group by group, in the order of the tree:"
        )
        return [said(text), listing, said("With these"), Formulas(tuple(results))]

    def _matrix(self, name: str, matrix: Any, *, symmetric: bool = False) -> list[Block]:
        """A matrix as a whole if it fits, else the entries that are not zero."""
        tree = self.tree(matrix)
        assert isinstance(tree, Grid)
        if not tree.rows:
            return []
        widths = [max(len(Plain()(row[j])) for row in tree.rows) for j in range(len(tree.rows[0]))]
        if sum(widths) + 2 * len(widths) <= WIDEST_GRID:
            return [Formulas((EquationRow(letter(name), tree),))]
        rows = []
        for i, row in enumerate(tree.rows):
            for j, entry in enumerate(row):
                if entry == ZERO or (symmetric and j < i and entry == tree.rows[j][i]):
                    continue
                subs = (str(i + 1), str(j + 1)) if len(row) > 1 else (str(i + 1),)
                left: Math = Name(name, subs)
                if symmetric and j > i and entry == tree.rows[j][i]:
                    rows.append(EquationRow(left, entry))
                    continue
                rows.append(EquationRow(left, entry))
        twin = " M is symmetric; entries below its diagonal are not repeated." * symmetric
        missing = (
            " Entries that are not shown are zero." if len(rows) < sum(map(len, tree.rows)) else ""
        )
        about = f"{twin}{missing}".strip()
        return [Formulas(tuple(rows)), *([said(about)] if about else [])]

    def _rates(self) -> list[Block]:
        """``q̇ = N v``, unless v are the rates of q."""
        subject = self._subject
        plain = [f"{q}_dot" for q in subject.q_names]
        if plain == subject.v_names[: len(plain)]:
            return [
                said(
                    "The velocities of mechanics are the rates of the coordinates: N is the identity."
                )
            ]
        rates = self._functions.coordinate_rates
        rows = [
            EquationRow(Name(n.letter, n.subs, n.dots + 1), self._nodes(x))
            for n, x in zip(subject.symbols(subject.q_names), rates, strict=True)
            if isinstance(n, Name) and f"{n}" and self._nodes(x) != n.rate()
        ]
        return [said("The coordinates change by"), Formulas(tuple(rows))]

    def _loops(self) -> Section:
        self._tell("constraints")
        subject = self._subject
        rows = [
            EquationRow(
                letter("λ"), Grid(tuple((subject.look.name(q.name),) for q in subject.multipliers))
            )
        ]
        text = (
            "The circuit equations of the chords, projected on the directions in which these react, are "
            "constraints; their multipliers are those reactions, which act on the head of the chord."
        )
        blocks: list[Block] = [said(text), Formulas(tuple(rows)), *self._counted()]
        if not self.short_constraints:
            if self.short:
                blocks += self._listed("constraints")
            else:
                blocks.append(said("φ, J and γ are listed with M and h above."))
            return Section("Constraints of the loops", tuple(blocks))
        form = self.closed
        blocks += self._matrix("φ", form.constraints)
        blocks += self._matrix("J", form.constraint_jacobian)
        blocks += self._matrix("γ", form.constraint_bias)
        return Section("Constraints of the loops", tuple(blocks))

    def _counted(self) -> list[Block]:
        from linegraph.programs.loop_remarks import freedoms_text

        derivation = self._subject.derivation
        if any(p.value is None for p in self._subject.model.parameters.values()):
            return []
        found = derivation.assembled
        text = (
            f"{found.rank} of {len(found.unique)} are independent: {freedoms_text(found.freedoms)}."
        )
        loose = [
            q.name
            for q, one in zip(self._subject.multipliers, found.unique, strict=True)
            if not one
        ]
        if loose:
            return [said(f"{text} Not unique are ", Code(", ".join(loose)), ".")]
        return [said(text)]

    def _written_out(self) -> Section:
        """The scalar equations, row by row."""
        subject, form = self._subject, self.closed
        M, h, Q = form.mass_matrix, form.bias, form.forces
        a = subject.symbols(subject.a_names)
        J: Any = None
        if subject.tree.closed and self.short_constraints:
            J = form.constraint_jacobian
        rows = []
        for i in range(M.shape[0]):
            left: list[tuple[bool, Math]] = []
            for j, acceleration in enumerate(a):
                entry = self.tree(M[i, j])
                if entry != ZERO:
                    left.append((False, _times(entry, acceleration)))
            left.append((False, self.tree(h[i])))
            right: list[tuple[bool, Math]] = [(False, self.tree(Q[i]))]
            for k, quantity in enumerate(subject.multipliers if J is not None else ()):
                entry = self.tree(J[k, i])
                if entry != ZERO:
                    right.append((False, _times(entry, subject.look.name(quantity.name))))
            if subject.tree.closed and J is None:
                row = Power(Name("J", bold=True), TRANSPOSED)
                right.append((False, Name("(Jᵀλ)", (str(i + 1),)) if row else ZERO))
            rows.append(EquationRow(total(left, ordered=False), total(right)))
        return Section("Written out", (Formulas(tuple(rows)),))

    def _energy(self) -> Section:
        self._tell("energy")
        names = ("T", "V", "W")
        rows = [
            EquationRow(Name(n), self.tree(x))
            for n, x in zip(names, self._energies, strict=False)
            if x != 0
        ]
        words = ["kinetic energy T", "the potential energy V", "what networks store, W"]
        shown = [w for w, x in zip(words, self._energies, strict=False) if x != 0]
        if not rows:
            return Section("Energy", (said("Nothing stores energy."),))
        return Section(
            "Energy", (said(f"The energy in the system: {listed(shown)}."), Formulas(tuple(rows)))
        )

    def _reactions(self) -> Section:
        self._tell("reactions")
        subject = self._subject
        axes = {"tail": "the tail", "ground": "ground"}
        where = axes.get(subject.model.choices.reactions, "the head")
        once: list[Inline] = ["Once ", letter("v", dots=1)]
        once += [" and ", letter("λ"), " are known"] if subject.tree.closed else [" is known"]
        blocks: list[Block] = [said(
            *once, ", every other variable follows from the circuit and the cutset equations. A joint ",
            "exerts a force ", Name("f", bold=True), " and a torque ", Name("τ", bold=True), " on its head, ",
            f"given here about the origin of the head, in the axes of {where}. The joint's effort is part ",
            "of them, elements in the joint are not; components that are not shown are zero.")]  # fmt: skip
        if self.short_reactions:
            for joint in subject.model.joints:
                force, torque = self.closed.reaction(joint.name)
                rows = (
                    EquationRow(vector("f", joint.name), self.tree(force)),
                    EquationRow(vector("τ", joint.name), self.tree(torque)),
                )
                blocks.append(Formulas(tuple(r for row in rows for r in _components(row))))
        else:
            listing, results, operations = listed_program(subject, "reactions")
            blocks += [
                said(f"They take {operations} operations, with named parts of their own:"),
                listing,
                said("With these"),
                Formulas(tuple(results)),
            ]
        return Section("Reactions", tuple(blocks))


def _components(row: EquationRow) -> list[EquationRow]:
    """A vector as a whole if it fits, else its components."""
    assert isinstance(row.right, Grid)
    assert isinstance(row.left, Name)
    if len(Plain()(row.right)) <= WIDEST_GRID:
        return [row]
    left = row.left
    return [
        EquationRow(Name(left.letter, (*left.subs, axis)), entry)
        for axis, (entry,) in zip("xyz", row.right.rows, strict=True)
        if entry != ZERO
    ]


def _times(entry: Math, by: Math) -> Math:
    """An entry of a matrix times a variable; factored forms are kept."""
    return by if entry == ONE else product([entry, by]) if not _sum(entry) else _signed(entry, by)


def _sum(entry: Math) -> bool:
    return bool(getattr(entry, "terms", ()))


def _signed(entry: Math, by: Math) -> Math:
    terms = entry.terms  # type: ignore[union-attr]
    if len(terms) == 1:
        return total([(True, product([terms[0][1], by]))])
    return Product((entry, by))


__all__ = ["Forms"]

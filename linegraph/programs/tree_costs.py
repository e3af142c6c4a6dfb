"""The trees that a model may be derived with, and their costs: `linegraph trees`.

Any joint of a loop may be cut. The candidates are the automatic tree, those that differ from it by the
cut of one loop, and absolute coordinates or absolute angles for all bodies.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.components.joints import Compound
from linegraph.errors import ModelError
from linegraph.ir.program import Program
from linegraph.model.choices import ABSOLUTE, ABSOLUTE_ANGLE
from linegraph.model.system import placed, variant
from linegraph.numeric.derived import Derived
from linegraph.pipeline import derived
from linegraph.programs.register import module_of
from linegraph.programs.request import Request

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from linegraph.model.builder import Model
    from linegraph.model.system import System

MOST = 24
"""Greatest number of candidates."""

MOST_NAMED = 5
"""If more chords are cut than this, only their number is printed."""


@dataclass(frozen=True)
class Candidate:
    """A tree and its cost.

    Attributes:
        choices: arguments of `Model.formulation` that choose it.
        cut: the joints and constraints that are chords.
        coordinates: the number of velocities.
        constraints: the number of constraints.
        operations: of all quantities that forward dynamics needs: M, h, J and γ, or M and h without
            loops.
        chosen: whether the model is derived with it.
    """

    choices: dict[str, Any]
    cut: tuple[str, ...]
    coordinates: int
    constraints: int
    operations: int
    chosen: bool

    @property
    def name(self) -> str:
        """The line of a model file that chooses it."""
        if "coordinates" in self.choices:
            return f'coordinates = "{self.choices["coordinates"]}"'
        branches = ", ".join(f'"{name}"' for name in self.choices["tree"])
        return f"tree = [{branches}]" if self.cut else "the only tree of joints"


class Trees(list[Candidate]):
    """Candidate trees, cheapest first; printed as a table."""

    def __str__(self) -> str:
        """A table: operations, velocities, constraints, chords, and the line that chooses the tree."""
        return _table(self)


def trees(model: Model | System, tell: Callable[[str], None] | None = None) -> Trees:
    """The sensible trees, cheapest first; among equals the model's own tree first, then as found.

    Args:
        model: a builder or a frozen system.
        tell: called with the progress, one line per tree.

    Raises:
        ModelError: the model cannot be derived, or none of the trees has equations of motion.
    """
    system = model.system()
    own = derived(system, Derived)
    found: dict[tuple[Any, ...], Candidate] = {}
    refused: ModelError | None = None
    for choices in _choices(system, own):
        if len(found) == MOST:
            break
        if tell is not None:
            tell(f"tree {len(found) + 1}")
        twin = variant(system, **choices)
        try:
            derivation = own if _same(own, choices) else derived(twin, Derived)
            tree = derivation.formulation
            key = (tree.joints, tree.absolute, tuple(tree.level))
            if key not in found:
                found[key] = _judged(derivation, choices, derivation is own)
        except ModelError as error:
            # e.g. a joint that cannot be cut, a tree that cannot be assembled, a law that needs a coordinate
            refused = refused or error
    if refused is not None and not found:
        raise placed(refused, system)
    cheapest = sorted(found.values(), key=lambda c: (c.operations, c.coordinates, not c.chosen))
    return Trees(cheapest)


def _same(own: Derived, choices: dict[str, Any]) -> bool:
    """Whether choices are those that the model is derived with."""
    if "coordinates" in choices or own.formulation.absolute or own.formulation.level:
        return False
    return set(choices["tree"]) == set(_moving(own))


def _choices(system: System, own: Derived) -> Iterator[dict[str, Any]]:
    """The automatic tree, its neighbours, and the trees of inertia edges."""
    base = own if not (own.formulation.absolute or own.formulation.level) else _joints_only(system)
    branches = _moving(base)
    yield {"tree": branches}
    compound = {joint.name for joint in system.joints if isinstance(joint, Compound)}
    for chord in base.formulation.chords:
        for other in base.circuit_of(chord)[:-1]:
            if other in branches and other not in compound:
                yield {"tree": tuple(chord if name == other else name for name in branches)}
    yield {"coordinates": ABSOLUTE_ANGLE}
    yield {"coordinates": ABSOLUTE}


def _joints_only(system: System) -> Derived:
    return derived(variant(system), Derived)


def _moving(derivation: Derived) -> tuple[str, ...]:
    """The joints that are branches, in declared order."""
    joints = derivation.system.joints
    return tuple(j.name for j in joints if j.name in derivation.formulation.joints)


def _judged(derivation: Derived, choices: dict[str, Any], chosen: bool) -> Candidate:
    """A candidate: a tree with its chords, its coordinates and the operations of its equations."""
    module = module_of(
        derivation,
        "counted",
        Request(
            only=("constraints", "equations") if derivation.structure.closed else ("equations",),
            prologue=False,
        ),
    )
    programs = {p.name: p for p in module.programs if isinstance(p, Program)}
    whole = programs.get("constrained_equations", programs["equations"])
    tree = derivation.structure
    held = (c.component.name for c in tree.closures if c.restrictions or c.drive)
    others = (c.name for c in derivation.system.constraints)
    cut = tuple(dict.fromkeys([*held, *others]))
    count = len(derivation.assembled.unique) if tree.closed else 0
    return Candidate(choices, cut, len(tree.velocities), count, whole.operations, chosen)


def _table(found: list[Candidate]) -> str:
    """The candidates as a table."""
    rows = [("operations", "velocities", "constraints", "cut", "")]
    for c in found:
        name = f"{c.name}{'   (this model)' * c.chosen}"
        cut = ", ".join(c.cut) if len(c.cut) <= MOST_NAMED else f"{len(c.cut)} joints"
        cut = cut or "-"
        rows.append((str(c.operations), str(c.coordinates), str(c.constraints), cut, name))
    widths = [max(len(row[k]) for row in rows) for k in range(4)]
    lines = []
    for row in rows:
        numbers = [cell.rjust(width) for cell, width in zip(row[:3], widths, strict=False)]
        lines.append("  ".join([*numbers, row[3].ljust(widths[3]), row[4]]).rstrip() + "\n")
    return "".join(lines)

"""The independent coordinates of a mechanism with loops: chosen by the user, or found by its assembly."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.errors import ModelError
from linegraph.kinematics.state_layout import has_plain_rates

if TYPE_CHECKING:
    from linegraph.numeric.assembly import Assembly
    from linegraph.programs.workspace import Workspace


def assembly(f: Workspace) -> Assembly:
    """The assembly of the model, found once for all functions."""
    return f.derivation.assembled


def independent(f: Workspace) -> list[tuple[int, int]]:
    """(position, velocity) of each independent coordinate, as chosen by the user or by the assembly.

    Raises:
        ModelError: a chosen one does not exist, or its rate is not its velocity.
    """
    wanted = f.tree.system.choices.independent
    pairs = _plain_pairs(f)
    if wanted is None:
        found = assembly(f).independent
        chosen = [(pairs[v], v) for v in found if v in pairs]
        return chosen if len(chosen) == assembly(f).freedoms else []
    names = {quantity.name: k for k, quantity in enumerate(f.tree.velocities)}
    for name in wanted:
        if name not in names or names[name] not in pairs:
            known = ", ".join(n for n, k in names.items() if k in pairs)
            problem = (
                f'independent: "{name}" is no coordinate of this tree with its rate as velocity; '
                f"known: {known}"
            )
            raise ModelError("formulation", problem)
    for name in wanted:
        if wanted.count(name) > 1:
            raise ModelError("formulation", f'independent: "{name}" is named twice')
    if len(wanted) != assembly(f).freedoms:
        problem = (
            f"independent: {len(wanted)} coordinates for {assembly(f).freedoms} degrees of freedom"
        )
        raise ModelError("formulation", problem)
    return [(pairs[names[name]], names[name]) for name in wanted]


def _plain_pairs(f: Workspace) -> dict[int, int]:
    """For each velocity that is the derivative of a coordinate, the place of that coordinate."""
    return {
        v.index: q.index
        for link in f.tree.links
        if has_plain_rates(link.joint)
        for q, v in zip(link.place.positions, link.velocities, strict=True)
        if q.ratio == 1 and q.offset == 0
    }

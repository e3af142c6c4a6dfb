"""Remarks in the head of an emitted file about constraints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.programs.independent import assembly

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.programs.workspace import Workspace


def remarks(f: Workspace, chosen: Sequence[str]) -> tuple[str, ...]:
    """Number, rank and redundancy of the constraints, as a remark in the head of a file.

    Args:
        f: the shared equations.
        chosen: keys of the functions that are made; not used.
    """
    if not f.tree.closed:
        return ()
    found = assembly(f)
    cut = ", ".join(dict.fromkeys(e.component for e in f.constraint_equations))
    text = (
        f"{len(f.constraint_equations)} constraints come from the chords of the tree ({cut}), "
        "M vdot + h = Q + J^T lam with J vdot = gam; "
        f"{found.rank} are independent: {freedoms_text(found.freedoms)}."
    )
    if f.tree.network is not None:
        text += " With networks beside them they are not reduced to independent coordinates."
    if found.redundant:
        names = [
            e.multiplier.name
            for e, one in zip(f.constraint_equations, found.unique, strict=True)
            if not one
        ]
        text += (
            f" {found.redundant} are redundant: the motion is the same without them, but these multipliers, "
            f"and the reactions that depend on them, are not unique: {', '.join(names)}."
        )
    return (text,)


def freedoms_text(count: int) -> str:
    """The number of degrees of freedom, in words."""
    return f"{count} degree{'' if count == 1 else 's'} of freedom"

"""Kinds of edges and their line styles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.body import GROUND
from linegraph.components.scalar.forces import NetworkForce
from linegraph.drawing.scene import BRANCH, GREY, Pen

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.graph.multigraph import Edge
    from linegraph.model.system import System

BRANCH_PEN, CHORD_PEN, OPEN_PEN = Pen(BRANCH, 3), Pen(GREY, 1.2), Pen(GREY, 1.2)

PLAIN, ELEMENT, LIMIT, PORT = "", "force element or load", "constraint", "port of a network"
DASHES: Mapping[str, tuple[float, ...]] = {
    PLAIN: (),
    ELEMENT: (6, 3),
    LIMIT: (10, 3, 2, 3),
    PORT: (2, 2.5),
}
"""Dashes of the lines of each kind of edge."""


def kinds_of(model: System) -> dict[str, str]:
    """Kind of each component of spatial mechanics that is no joint, by name."""
    kinds = {e.name: PORT if isinstance(e, NetworkForce) else ELEMENT for e in model.elements}
    return kinds | {limit.name: LIMIT for limit in model.constraints}


def is_arm(edge: Edge) -> bool:
    """Whether an edge is a rigid arm of a body or of ground."""
    return edge.name.startswith(f"{edge.component}/arm")


def is_inertia(edge: Edge) -> bool:
    """Whether an edge is the inertia edge of a body."""
    return edge.name == f"{edge.component}/inertia" and edge.tail == GROUND


def pen_of(kind: str, bold: bool) -> Pen:
    """The line style of an edge: branches bold, chords thin, dashes by kind.

    Args:
        kind: a key of `DASHES`.
        bold: whether the edge is a branch.
    """
    pen = BRANCH_PEN if bold else CHORD_PEN
    return Pen(pen.color, pen.width, DASHES[kind])

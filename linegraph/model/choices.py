"""What a user may choose of the formulation: the tree, the coordinates, and the axes of results."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from linegraph.components.validation import nearest
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Mapping

COORDINATES = ("joint", "absolute", "absolute-angle", "automatic")
JOINT, ABSOLUTE, ABSOLUTE_ANGLE, AUTOMATIC = COORDINATES
"""The edges whose across variables are a body's coordinates: its joint; its inertia edge; its joint for the
position and its inertia edge for the orientation; or this for bodies that turn in a plane, else its joint."""

HEAD, TAIL, GROUND_AXES = REACTION_AXES = ("head", "tail", "ground")
"""The axes in which joint reactions are resolved."""


@dataclass(frozen=True)
class Choices:
    """The user's choices; whatever is left open is chosen automatically.

    Attributes:
        tree: edges that must be branches: joints by name, inertia edges as ``body/inertia``.
        coordinates: for all bodies, one of `COORDINATES`.
        of_body: for single bodies, by name.
        independent: the coordinates that a closed mechanism is reduced to; None for an automatic choice.
        baumgarte: (alpha, beta) of ``φ̈ + 2 alpha φ̇ + beta² φ = 0`` (1/s) in forward dynamics; None for φ̈ =
            0.
        reactions: one of `REACTION_AXES`.
    """

    tree: tuple[str, ...] = ()
    coordinates: str = JOINT
    of_body: Mapping[str, str] = field(default_factory=dict)
    independent: tuple[str, ...] | None = None
    baumgarte: tuple[Any, Any] | None = None
    reactions: str = HEAD

    def kind(self, body: str) -> str:
        """The kind of coordinates of a body, one of `COORDINATES`."""
        return self.of_body.get(body, self.coordinates)


def chosen(choices: Choices, **changes: Any) -> Choices:
    """Choices with some of them changed.

    Args:
        choices: as they were.
        **changes: attributes of `Choices` with their new values.

    Raises:
        ModelError: there is no such kind of coordinates or of axes.
    """
    found = replace(choices, **changes)
    for kind in (found.coordinates, *found.of_body.values()):
        if kind not in COORDINATES:
            raise ModelError("formulation", f'coordinates "{kind}"; {nearest(kind, COORDINATES)}')
    if found.reactions not in REACTION_AXES:
        problem = f'reactions "{found.reactions}"; {nearest(found.reactions, REACTION_AXES)}'
        raise ModelError("formulation", problem)
    return found

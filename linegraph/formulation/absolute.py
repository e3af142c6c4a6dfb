"""Bodies measured from ground: the joints that inertia edges are, and what their coordinates are called."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.body import GROUND, MASS_CENTER
from linegraph.components.joints import Free, Spherical
from linegraph.model.name_register import declared, numbered

if TYPE_CHECKING:
    from linegraph.formulation.formulate import Formulation
    from linegraph.model.system import System


def floating(body: str, stem: str) -> Free:
    """The joint that a body's inertia edge is when it is a branch: all six freedoms against ground.

    `stem` is what its coordinates begin with.
    """
    return Free(stem, (GROUND, f"{body}.{MASS_CENTER}"))


def turning(joint: str, body: str, stem: str) -> Spherical:
    """The joint that an inertia edge is in rotation: the body's orientation against ground."""
    return Spherical(stem, (joint, body), effort=False)


def stems_of(model: System, formulation: Formulation) -> dict[str, str]:
    """What the coordinates of each body begin with: nothing that the model declares has such a name.

    The body's name, or that with ``_body`` after it where one of the coordinates would meet another name, as
    that of a free joint called like the body. None where no body is measured from ground.
    """
    if not formulation.absolute and not formulation.level:
        return {}
    taken = {claim.name for claim in declared(model)} | {joint.name for joint in model.joints}
    if formulation.network is not None:
        taken |= {state.quantity.name for state in formulation.network.states}
    found: dict[str, str] = {}
    for body in model.bodies:
        for stem in numbered(body, f"{body}_body"):
            joint = floating(body, stem)
            own = {stem, *(x.name for x in (*joint.positions(), *joint.velocities()))}
            if not own & taken:
                break
        taken |= own
        found[body] = stem
    return found

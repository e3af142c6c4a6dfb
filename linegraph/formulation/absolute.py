"""Bodies measured relative to ground: the joints that replace inertia edges, and their coordinates' names."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.components.body import GROUND, MASS_CENTER
from linegraph.components.joints import Free, Spherical
from linegraph.model.name_register import declared, numbered

if TYPE_CHECKING:
    from linegraph.formulation.formulate import Formulation
    from linegraph.model.system import System


def floating(body: str, stem: str) -> Free:
    """The free joint for a body's inertia edge that is a branch: six freedoms relative to ground.

    Args:
        body: name of the body; the joint's head is its mass centre.
        stem: the beginning of the names of its coordinates.
    """
    return Free(stem, (GROUND, f"{body}.{MASS_CENTER}"))


def turning(joint: str, body: str, stem: str) -> Spherical:
    """The spherical joint for an inertia edge that is a branch in rotation only: orientation from ground.

    Args:
        joint: the joint that is the branch in translation.
        body: the body beyond it.
        stem: the beginning of the names of its coordinates.
    """
    return Spherical(stem, (joint, body), effort=False)


def stems_of(model: System, formulation: Formulation) -> dict[str, str]:
    """For each body the beginning of its coordinates' names; empty if no body is measured relative to ground.

    It is the body's name, or the name with ``_body`` after it where a coordinate would have the name of
    something else in the model, such as a free joint called like the body.

    Args:
        model: the system, whose declared names are taken.
        formulation: its trees; names of network states are taken, too.
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

"""Builds linegraph models from the random trees that the independent oracle reads too."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph import Model
from linegraph.components.joints import JOINTS

if TYPE_CHECKING:
    import numpy as np
    from systems import random_trees as trees


def numbers(a: np.ndarray) -> tuple[float, ...]:
    return tuple(float(x) for x in a)


def rows(a: np.ndarray) -> tuple[tuple[float, ...], ...]:
    return tuple(numbers(row) for row in a)


def model_of(tree: trees.Tree, name: str = "random") -> Model:
    """The model a user would build for this tree."""
    model = Model(name, gravity=numbers(tree.gravity))
    handles = {"ground": model.ground}
    for body in tree.bodies:
        handles[body.name] = model.body(
            body.name,
            mass=float(body.mass),
            mass_center=numbers(body.mass_center),
            inertia=rows(body.inertia),
        )
    for joint in tree.joints:
        tail = handles[joint.tail].frame(
            f"{joint.name}.tail", at=numbers(joint.tail_at), rotation=rows(joint.tail_rotation)
        )
        head = handles[joint.head].frame(
            f"{joint.name}.head", at=numbers(joint.head_at), rotation=rows(joint.head_rotation)
        )
        kind = JOINTS[joint.kind]
        model.add_joint(kind(joint.name, (tail, head), axis=numbers(joint.axis)))
    for coupling in tree.couplings:
        model.couple(coupling.joint, coupling.master, float(coupling.ratio), float(coupling.offset))
    return model

"""Small trees of bodies said twice: as a model, and as products of poses in NumPy.

The poses know nothing of links, working frames or alignment: they multiply the frames as given.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from support.rigid_motion import TINY, axial, pose, turned, undone

import linegraph as lg
from linegraph.algebra.protocol import Floats
from linegraph.formulation.formulate import Formulation, formulate
from linegraph.kinematics.tree import kinematic_tree
from linegraph.model.terminal_graphs import system_graph

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from linegraph.kinematics.links import KinematicTree

Array = Any
Frame = tuple[tuple[float, float, float], tuple[float, float, float], float]
"""Place, axis and angle."""

HERE: Frame = ((0, 0, 0), (0, 0, 1), 0.0)
GRAVITY = (0.3, -0.2, -9.81)
SIZES = {"revolute": 1, "prismatic": 1, "cylindrical": 2, "universal": 2}


class Part(NamedTuple):
    """A body and the joint that brings it.

    Attributes:
        kind: of the joint, one of `SIZES`.
        axis: the joint's, in its frames; of a universal joint both.
        near, far: the joint's frames on the body before and on its own.
        forward: whether the joint's edge points away from ground.
        parent: the body before; -1 is ground.
        mass, center, inertia: the body's; the inertia is central, in its own axes.
    """

    kind: str
    axis: Any = (0, 0, 1)
    near: Frame = HERE
    far: Frame = HERE
    forward: bool = True
    parent: int = -1
    mass: float = 1.0
    center: tuple[float, float, float] = (0.1, -0.2, 0.3)
    inertia: tuple[float, float, float] = (0.02, 0.03, 0.04)


LIMB = (
    Part(
        "revolute", (1, 2, 2), ((0.1, 0.2, 0.3), (1, 0, 1), 0.4), ((0, 0.1, -0.2), (0, 1, 1), 1.0)
    ),
    Part("prismatic", (0, 3, 4), ((0.5, 0, -0.1), (1, 1, 0), -0.8), parent=0, mass=0.7),
    Part("universal", ((1, 0, 0), (0, 1, 1)), ((0, 0.3, 0), (0, 0, 1), 0.3), parent=1, mass=0.5),
    Part("cylindrical", (0, 0, 1), far=((0.2, 0, 0.1), (1, 0, 0), 0.5), forward=False, parent=1),
    Part(
        "revolute", (0, -1, 0), ((0.4, 0.1, 0), (0, 0, 1), 0.0), forward=False, parent=3, mass=1.5
    ),
)
"""Joints crossed along and against their edges, about and along oblique axes, and a fork."""

LIMB_STATE = (
    np.array([0.3, -0.2, 0.5, -0.4, 0.6, 0.15, -0.7]),
    np.array([0.8, -0.5, 0.3, 1.1, -0.9, 0.4, 0.6]),
)

PLANE = (
    Part("revolute", center=(0.15, 0, 0)),
    Part("revolute", near=((0.3, 0, 0), (0, 0, 1), 0.0), parent=0, center=(0.2, 0, 0), mass=0.8),
    Part("revolute", near=((0.4, 0, 0), (0, 0, 1), 0.0), parent=1, center=(0.1, 0, 0), mass=0.5),
)
"""Three hinges about z, links of 0.3 m and 0.4 m along x."""


def modelled(parts: Sequence[Part]) -> lg.Model:
    """The parts as a model: bodies b0, b1, ... and joints j0, j1, ..."""
    model = lg.Model("chain", gravity=GRAVITY)
    made: list[Any] = []
    for k, part in enumerate(parts):
        body = model.body(f"b{k}", mass=part.mass, mass_center=part.center, inertia=part.inertia)
        before = model.ground if part.parent < 0 else made[part.parent]
        ends = [
            on.frame(f"f{k}{side}", at=place, axis=axis, angle=angle)
            for side, on, (place, axis, angle) in (
                ("near", before, part.near),
                ("far", body, part.far),
            )
        ]
        about = {"axes": part.axis} if part.kind == "universal" else {"axis": part.axis}
        between = tuple(ends if part.forward else reversed(ends))
        getattr(model, part.kind)(f"j{k}", between=between, **about)
        made.append(body)
    return model


def poses(parts: Sequence[Part], q: Any) -> list[Array]:
    """Where every body is: the frames as given, multiplied."""
    found: list[Array] = []
    at = 0
    for part in parts:
        own = q[at : at + SIZES[part.kind]]
        at += SIZES[part.kind]
        motion = _motion(part, own) if part.forward else undone(_motion(part, own))
        before = np.eye(4) if part.parent < 0 else found[part.parent]
        found.append(before @ _framed(part.near) @ motion @ undone(_framed(part.far)))
    return found


def _framed(frame: Frame) -> Array:
    place, axis, angle = frame
    return pose(turned(axis, angle), place)


def _motion(part: Part, q: Any) -> Array:
    """The joint's head seen from its tail."""
    if part.kind == "universal":
        return pose(turned(part.axis[0], q[0]) @ turned(part.axis[1], q[1]))
    along = np.asarray(part.axis, float) / np.linalg.norm(part.axis)
    angle = q[0] if part.kind in ("revolute", "cylindrical") else 0.0
    shift = q[-1] if part.kind in ("prismatic", "cylindrical") else 0.0
    return pose(turned(along, angle), shift * along)


def jacobian(parts: Sequence[Part], q: Any, body: int, place: Any = (0, 0, 0)) -> Array:
    """Velocity of a body's point and its angular velocity, each by every coordinate (6 x n)."""
    point = np.array([*place, 1.0])
    columns = []
    for e in np.eye(len(q)):
        ahead = poses(parts, q + 1j * TINY * e)[body]
        turn = ahead[:3, :3].imag / TINY @ ahead[:3, :3].real.T
        columns.append([*((ahead @ point)[:3].imag / TINY), *axial(turn)])
    return np.array(columns).T


def mass_matrix(parts: Sequence[Part], q: Any) -> Array:
    """The sum over bodies of what their Jacobians make of mass and inertia."""
    size = len(q)
    found = np.zeros((size, size))
    at = poses(parts, q)
    for k, part in enumerate(parts):
        J, R = jacobian(parts, q, k, part.center), at[k][:3, :3]
        found += part.mass * J[:3].T @ J[:3]
        found += J[3:].T @ R @ np.diag(part.inertia) @ R.T @ J[3:]
    return found


def formulated(model: lg.Model) -> Formulation:
    """The trees of a model."""
    system = model.system()
    return formulate(system, system_graph(system))


def walked(
    model: lg.Model, parameters: Mapping[str, float] | None = None, **arguments: Any
) -> KinematicTree:
    """The links of a model over floats: at a time t, for inputs u."""
    system = model.system()
    trees = formulate(system, system_graph(system))
    return kinematic_tree(system, trees, Floats(**arguments), parameters or {})


def link_poses(tree: KinematicTree, bodies: Sequence[Array]) -> list[Array]:
    """Where the links' working frames are, from where the bodies b0, b1, ... are."""
    found: dict[int, Array] = {}
    for k, at in enumerate(bodies):
        link, own = tree.bodies[f"b{k}"]
        found[link] = at @ undone(pose(np.array(own.rotation, float), np.array(own.at, float)))
    return [found[i] for i in range(len(tree.links))]

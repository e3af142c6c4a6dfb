"""MuJoCo's stages of smooth dynamics, from C; `mujoco_calls.c` says which are timed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import numpy as np
from calls import Call, Layout, folder
from environment import mujoco_library
from pinocchio_peer import names

if TYPE_CHECKING:
    from pathlib import Path

    from calls import Array
    from robots import Robot

LEAST = 1e-9
TOLERANCE = 1e-6
"""MuJoCo takes only inertias that a body can have; those of some files it, or `LEAST`, changes a little."""


@dataclass(frozen=True)
class WorldLayout(Layout):
    """Of a floating base: quaternions start with the real part, velocities are in the axes of the world."""

    def arranged(self, function: str, q: Array, v: Array, w: Array) -> Array:
        """MuJoCo's input."""
        x = super().arranged(function, q, v, w)
        if not self.free:
            return x
        n = len(self.velocities)
        R = rotation(q[3:7])
        x[3:7] = q[[6, 3, 4, 5]]
        x[n + 1 : n + 4] = R @ v[:3]
        if function == "inverse_dynamics":
            x[2 * n + 1 : 2 * n + 4] = R @ (w[:3] + np.cross(v[3:6], v[:3]))
        return x

    def restored(self, function: str, y: Array, q: Array, v: Array) -> Array:
        """The output of linegraph; with T v the velocities of MuJoCo, M is TᵀMT and h is Tᵀ(h + M Ṫ v)."""
        y = super().restored(function, y, q, v)
        if not self.free:
            return y
        n = len(self.velocities)
        T = np.eye(n)
        T[:3, :3] = rotation(q[3:7])
        turning = np.zeros(n)
        turning[:3] = T[:3, :3] @ np.cross(v[3:6], v[:3])
        if function == "inverse_dynamics":
            return np.asarray(T.T @ y)
        if function == "forward_dynamics":
            return np.asarray(T.T @ (y - turning))
        M = y[:-n].reshape(n, n)
        return np.concatenate(((T.T @ M @ T).ravel(), T.T @ (y[-n:] + M @ turning)))


def rotation(quaternion: Array) -> Array:
    """The matrix of a unit quaternion (x, y, z, w)."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def calls(robot: Robot, joints: tuple[str, ...], function: str) -> list[Call]:
    """The stages that make up a function."""
    library = mujoco_library()
    options = f"{function} {robot.base} {_urdf(robot)}"
    theirs = [name for name in names(library, options) if name != "root"]
    layout = WorldLayout.of(joints, theirs, 6 if robot.floating else 0)
    call = Call("MuJoCo", function, library, mujoco_library, layout, options)
    call.tolerance = TOLERANCE
    return [call]


def _urdf(robot: Robot) -> Path:
    """The robot with its free joint, which MuJoCo has in the file."""
    root = ElementTree.parse(robot.urdf).getroot()
    if robot.floating:
        children = {joint.find("child").get("link") for joint in root.findall("joint")}
        base = next(
            link.get("name") for link in root.findall("link") if link.get("name") not in children
        )
        root.append(ElementTree.Element("link", name="the_world"))
        joint = ElementTree.SubElement(root, "joint", name="root", type="floating")
        ElementTree.SubElement(joint, "parent", link="the_world")
        ElementTree.SubElement(joint, "child", link=base)
    for inertia in root.iterfind("link/inertial/inertia"):
        if np.linalg.eigvalsh(_matrix(inertia)).min() < LEAST:
            for word in ("ixy", "ixz", "iyz"):
                inertia.set(word, "0")
            for word in ("ixx", "iyy", "izz"):
                inertia.set(word, repr(max(float(inertia.get(word)), LEAST)))
    settings = ElementTree.SubElement(root, "mujoco")
    ElementTree.SubElement(settings, "compiler", balanceinertia="true")
    path = folder("mujoco") / f"{robot.name}.urdf"
    path.write_text(ElementTree.tostring(root, encoding="unicode"))
    return path


def _matrix(inertia: ElementTree.Element) -> Array:
    words = (("ixx", "ixy", "ixz"), ("ixy", "iyy", "iyz"), ("ixz", "iyz", "izz"))
    return np.array([[float(inertia.get(word)) for word in row] for row in words])

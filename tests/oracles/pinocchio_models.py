"""Pinocchio's view of a URDF in linegraph's coordinates: the two read the same file independently.

Pinocchio's model is built without mimic joints, every joint independent. A `Bridge` then knows, from the
XML alone, the constant matrix G of ``v_pinocchio = G v`` and the matching positions, so that
``M = G^T M_pinocchio G`` and ``h = G^T h_pinocchio``.
"""

from __future__ import annotations

import importlib.util
import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree

from linegraph.derivation import derive

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from linegraph.model.builder import Model

    Array = NDArray[np.float64]

GRAVITY = np.array([0.0, 0.0, -9.81])


def robots_folder() -> Path | None:
    """Where the example-robot-data wheel keeps its robots; None where it is not installed."""
    found = importlib.util.find_spec("pinocchio")
    for folder in Path((found and found.origin) or "/").parents:
        robots = folder / "share" / "example-robot-data" / "robots"
        if robots.is_dir():
            return robots
    return None


def urdf_files() -> list[Path]:
    """All URDFs of the example-robot-data wheel; none where it is not installed."""
    robots = robots_folder()
    return sorted(robots.rglob("*.urdf")) if robots else []


def load(path: Path, *, floating: bool) -> Any:
    """Pinocchio's model of a URDF file."""
    return load_text(path.read_text(), floating=floating)


def load_text(text: str, *, floating: bool) -> Any:
    """Pinocchio's model of a URDF: fixed base, or a free flyer named ``root``."""
    import pinocchio

    if floating:
        return pinocchio.buildModelFromXML(text, pinocchio.JointModelFreeFlyer(), "root")
    return pinocchio.buildModelFromXML(text)


@dataclass(frozen=True)
class Follower:
    """``q = ratio q_master + offset``, as the file says."""

    master: str
    ratio: float
    offset: float


def followers(text: str) -> dict[str, Follower]:
    """The mimic joints of a URDF."""
    root = etree.fromstring(text.encode(), etree.XMLParser(recover=True))
    found = {}
    for joint in root.findall("joint"):
        mimic = joint.find("mimic")
        if mimic is not None:
            ratio, offset = float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0))
            found[joint.get("name")] = Follower(mimic.get("joint"), ratio, offset)
    return found


class Bridge:
    """Maps states from linegraph to Pinocchio, and results back.

    Args:
        model: linegraph's model of the file.
        pinocchio_model: Pinocchio's model of it, with the same base.
        mimics: the file's `followers`.
        held: joints that are locked in `model`, and where.
    """

    def __init__(
        self,
        model: Model,
        pinocchio_model: Any,
        mimics: Mapping[str, Follower],
        held: Mapping[str, float] | None = None,
    ) -> None:
        """Derive linegraph's equations and note the names of its coordinates."""
        self.pin = pinocchio_model
        self.data = pinocchio_model.createData()
        self.weightless = pinocchio_model.copy()
        self.weightless.gravity.setZero()
        self.mimics = mimics
        self.held = held or {}
        self.numeric = derive(model).numeric()
        self.q_names = [quantity.name for quantity in self.numeric.tree.positions]
        self.v_names = [quantity.name for quantity in self.numeric.tree.velocities]

    @property
    def nq(self) -> int:
        """Positions of linegraph's model."""
        return len(self.q_names)

    @property
    def nv(self) -> int:
        """Velocities of linegraph's model."""
        return len(self.v_names)

    def random_state(self, rng: np.random.Generator) -> tuple[Array, Array]:
        """Positions, quaternions normalised, and velocities (nq,), (nv,)."""
        q = rng.uniform(-2, 2, self.nq)
        for start, name in enumerate(self.q_names):
            if name.endswith("_qx") and self.q_names[start + 3 : start + 4] == [name[:-1] + "w"]:
                q[start : start + 4] /= np.linalg.norm(q[start : start + 4])
        return q, rng.uniform(-2, 2, self.nv)

    def positions(self, q: Sequence[float] | Array) -> Array:
        """Pinocchio's q."""
        value = dict(zip(self.q_names, q, strict=True))
        result = np.zeros(self.pin.nq)
        for name, joint in self._joints():
            result[joint.idx_q : joint.idx_q + joint.nq] = self._joint_positions(name, joint, value)
        return result

    def _joints(self) -> list[tuple[str, Any]]:
        return list(zip(self.pin.names, self.pin.joints, strict=True))[1:]

    def _joint_positions(self, name: str, joint: Any, value: Mapping[str, float]) -> list[float]:
        if joint.nv == 6:
            return [value[f"{name}_{c}"] for c in ("x", "y", "z", "qx", "qy", "qz", "qw")]
        if joint.nv == 3:
            angle = value[f"{name}_angle"]
            return [value[f"{name}_x"], value[f"{name}_y"], math.cos(angle), math.sin(angle)]
        angle = self._value(name, value)
        return [angle] if joint.nq == 1 else [math.cos(angle), math.sin(angle)]

    def _value(self, name: str, value: Mapping[str, float]) -> float:
        """The coordinate of a joint of one freedom; a fixed joint stands at 0."""
        if name in self.held:
            return self.held[name]
        if name in self.mimics:
            follower = self.mimics[name]
            return follower.ratio * self._value(follower.master, value) + follower.offset
        return value[name] if self.pin.existJointName(name) else 0.0

    @cached_property
    def G(self) -> Array:
        """``v_pinocchio = G v``."""
        column = {name: j for j, name in enumerate(self.v_names)}
        matrix = np.zeros((self.pin.nv, self.nv))
        for name, joint in self._joints():
            for k, (source, ratio) in enumerate(self._joint_velocities(name, joint)):
                if ratio != 0:
                    matrix[joint.idx_v + k, column[source]] = ratio
        return matrix

    def _joint_velocities(self, name: str, joint: Any) -> list[tuple[str, float]]:
        if joint.nv == 6:
            return [(f"{name}_{c}", 1.0) for c in ("vx", "vy", "vz", "wx", "wy", "wz")]
        if joint.nv == 3:
            return [(f"{name}_{c}", 1.0) for c in ("vx", "vy", "wz")]
        ratio = 1.0
        while name in self.mimics and name not in self.held:
            ratio *= self.mimics[name].ratio
            name = self.mimics[name].master
        moves = name not in self.held and self.pin.existJointName(name)
        return [(name, ratio if moves else 0.0)]

    def inverse_dynamics(self, q: Array, v: Array, a: Array) -> Array:
        """``M a + h`` by Pinocchio, on linegraph's coordinates."""
        import pinocchio

        G = self.G
        tau = pinocchio.rnea(self.pin, self.data, self.positions(q), G @ v, G @ a)
        return np.asarray(G.T @ tau)

    def bias(self, q: Array, v: Array) -> Array:
        """Bias h by Pinocchio, on linegraph's coordinates."""
        return self.inverse_dynamics(q, v, np.zeros(self.nv))

    def mass_matrix(self, q: Array) -> Array:
        """M by Pinocchio, on linegraph's coordinates.

        Its columns are forces of unit accelerations without gravity: Pinocchio's crba fills only a
        triangle, and is wrong for joints that are not numbered depth first.
        """
        import pinocchio

        G = self.G
        at, rest = self.positions(q), np.zeros(self.pin.nv)
        columns = [
            pinocchio.rnea(self.weightless, self.data, at, rest, G[:, j]) for j in range(self.nv)
        ]
        return np.asarray(G.T @ np.array(columns).T.reshape(self.pin.nv, self.nv))

    def kinetic_energy(self, q: Array, v: Array) -> float:
        """By Pinocchio."""
        import pinocchio

        at = self.positions(q)
        return float(pinocchio.computeKineticEnergy(self.pin, self.data, at, self.G @ v))

    def potential_energy(self, q: Array) -> float:
        """By Pinocchio; its zero is another than linegraph's."""
        import pinocchio

        return float(pinocchio.computePotentialEnergy(self.pin, self.data, self.positions(q)))


def bridge(path: Path, model: Model, *, floating: bool) -> Bridge:
    """The bridge for a file and linegraph's model of it."""
    text = path.read_text()
    return Bridge(model, load_text(text, floating=floating), followers(text))


def worst_difference(pair: Bridge, states: int, seed: int) -> tuple[float, float]:
    """The largest relative differences of M and h over random states.

    Each relative to its own largest entry.
    """
    rng = np.random.default_rng(seed)
    worst_M = worst_h = 0.0
    for _ in range(states):
        q, v = pair.random_state(rng)
        M, h = pair.mass_matrix(q), pair.bias(q, v)
        got_M = np.array(pair.numeric.mass_matrix(list(q))).reshape(pair.nv, pair.nv)
        got_h = np.array(pair.numeric.bias(list(q), list(v)))
        worst_M = max(worst_M, float(np.abs(got_M - M).max() / np.abs(M).max()))
        worst_h = max(worst_h, float(np.abs(got_h - h).max() / (np.abs(h).max() or 1.0)))
    return worst_M, worst_h

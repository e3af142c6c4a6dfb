"""Emitted kinematics of named frames, centre of mass and momentum against Pinocchio on real robots.

A few robots by default, with fixed and floating base; ``--all-robots`` takes twenty. Some frames are bodies,
some are links that are welded to others. Pinocchio reads the same file by itself; the classical acceleration
of a frame with v̇ = 0 is J̇ v, the rates of momentum are those of its algorithm for the centroidal map.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from agreement.test_kinematics import operational
from agreement.test_pinocchio import readable
from support.emitted import load

from codegen import naming
from linegraph import ModelError, derive
from linegraph.emission.emit import render
from linegraph.readers import urdf

pytest.importorskip("pinocchio")
import pinocchio
from oracles import pinocchio_models as peers

if TYPE_CHECKING:
    from pathlib import Path

    from linegraph import Model

STATES = 10
TOLERANCE = 1e-10  # relative to the largest expected entry; measured 6e-15
FEW = ("panda", "ur5_robot", "solo12", "double_pendulum_continuous")
MANY = 20
WHOLE = (
    "center_of_mass",
    "center_of_mass_velocity",
    "center_of_mass_jacobian",
    "momentum",
    "centroidal_momentum_matrix",
    "centroidal_momentum_bias",
)
WORLD = pinocchio.LOCAL_WORLD_ALIGNED


def twenty() -> list[Path]:
    """As many robots of the wheel, of different folders before others of the same."""
    files = peers.urdf_files()
    first: dict[str, Path] = {}
    for file in files:
        first.setdefault(file.parent.parent.name, file)
    rest = [file for file in files if file not in first.values()]
    return [*first.values(), *rest][:MANY]


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "file" not in metafunc.fixturenames:
        return
    files = [file for file in peers.urdf_files() if file.stem in FEW]
    if metafunc.config.getoption("--all-robots"):
        files = list(dict.fromkeys([*files, *twenty()]))
    names = [f"{file.parent.parent.name}-{file.stem}" for file in files]
    metafunc.parametrize("file", files, ids=names)
    metafunc.parametrize("base", ["fixed", "floating"])


def chosen(model: Model, pin: Any) -> list[str]:
    """Three frames: the last body, one in the middle, and one welded to another."""
    bodies = [name for name in model.bodies if pin.existBodyName(name)]
    welded = [
        name for name in bodies if re.search("tool|hand|foot|camera|imu|tip", name, re.IGNORECASE)
    ]
    return list(dict.fromkeys([bodies[-1], bodies[len(bodies) // 2], *welded[-1:]]))


class Peer:
    """What Pinocchio says at a state, in linegraph's coordinates."""

    def __init__(self, pair: peers.Bridge, q: np.ndarray, v: np.ndarray) -> None:
        """Note the state, and move all links there."""
        self.pin, self.data, self.G = pair.pin, pair.pin.createData(), pair.G
        self.q, self.v = pair.positions(q), pair.G @ v
        rest = np.zeros(self.pin.nv)
        pinocchio.forwardKinematics(self.pin, self.data, self.q, self.v, rest)
        pinocchio.updateFramePlacements(self.pin, self.data)

    def frame(self, name: str) -> dict[str, np.ndarray]:
        """Pose, velocity, Jacobian and its rate times v."""
        at = self.pin.getBodyId(name)
        pose = self.data.oMf[at]
        jacobian = pinocchio.computeFrameJacobian(self.pin, self.data, self.q, at, WORLD)
        velocity = pinocchio.getFrameVelocity(self.pin, self.data, at, WORLD)
        rate = pinocchio.getFrameClassicalAcceleration(self.pin, self.data, at, WORLD)
        return {
            "position": pose.translation,
            "rotation": pose.rotation,
            "velocity": velocity.vector,
            "jacobian": jacobian @ self.G,
            "jacobian_dot_v": rate.vector,
        }

    def whole(self) -> dict[str, np.ndarray]:
        """Centre of mass and momentum."""
        data = self.pin.createData()
        com = pinocchio.centerOfMass(self.pin, data, self.q, self.v).copy()
        velocity = data.vcom[0].copy()
        jacobian = pinocchio.jacobianCenterOfMass(self.pin, data, self.q) @ self.G
        pinocchio.dccrba(self.pin, data, self.q, self.v)
        return {
            "com": com,
            "com_velocity": velocity,
            "Jcom": jacobian,
            "hg": data.Ag @ self.v,
            "Ag": data.Ag @ self.G,
            "Agdot_v": data.dAg @ self.v,
        }


def relative(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.max(np.abs(found - expected)) / max(np.max(np.abs(expected)), 1e-3))


def test_agrees_with_pinocchio(
    file: Path, base: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model, held = readable(file, base, 0.0)
    text = file.read_text()
    pin = peers.load_text(text, floating=base == "floating")
    pair = peers.Bridge(model, pin, peers.followers(text), held)
    frames = chosen(model, pin)
    files = render(
        model,
        name="robot",
        folded=True,
        languages=["python"],
        only=["frames", "kinematics", *WHOLE],
        frames=frames,
    )
    module = load(files, "robot", tmp_path)
    rng = np.random.default_rng(1)
    worst: dict[str, float] = {}

    def note(what: str, found: Any, expected: np.ndarray) -> None:
        worst[what] = max(worst.get(what, 0.0), relative(np.asarray(found), expected))

    for _ in range(STATES):
        q, v = pair.random_state(rng)
        peer = Peer(pair, q, v)
        expected: list[np.ndarray] = []
        for frame in frames:
            truth = peer.frame(frame)
            name = f"frame_{naming.stem(frame)}"
            position, rotation = getattr(module, f"{name}_pose")(q)
            note("position", position, truth["position"])
            note("rotation", rotation, truth["rotation"])
            note("velocity", getattr(module, f"{name}_velocity")(q, v), truth["velocity"])
            note("jacobian", getattr(module, f"{name}_jacobian")(q), truth["jacobian"])
            found = getattr(module, f"{name}_jacobian_dot_v")(q, v)
            note("jacobian_dot_v", found, truth["jacobian_dot_v"])
            expected += truth.values()
        truth = peer.whole()
        note("com", module.center_of_mass(q), truth["com"])
        note("com_velocity", module.center_of_mass_velocity(q, v), truth["com_velocity"])
        note("Jcom", module.center_of_mass_jacobian(q), truth["Jcom"])
        note("hg", module.momentum(q, v), truth["hg"])
        note("Ag", module.centroidal_momentum_matrix(q), truth["Ag"])
        note("Agdot_v", module.centroidal_momentum_bias(q, v), truth["Agdot_v"])
        expected += truth.values()
        for found, there in zip(module.kinematics(q, v), expected, strict=True):
            note("kinematics", found, there)
    with capsys.disabled():
        row = "  ".join(f"{key} {value:.0e}" for key, value in worst.items())
        print(f"\n{file.stem:28s} {base:8s} nv {module.NV:3d}  {row}", end="")
    assert max(worst.values()) < TOLERANCE


ARMS = (("panda", "panda_hand", 6), ("ur5_robot", "tool0", 6), ("solo12", "FL_FOOT", 3))


@pytest.mark.parametrize(("stem", "frame", "rows"), ARMS)
def test_operational_space_agrees_with_pinocchio(
    stem: str, frame: str, rows: int, tmp_path: Path
) -> None:
    """At states well away from singular ones: both sides solve, with the condition of J M^-1 J^T."""
    (file,) = (file for file in peers.urdf_files() if file.stem == stem)
    model = urdf.read(file, snap=0.0)
    pair = peers.bridge(file, model, floating=False)
    function = {6: "operational_space", 3: "operational_position"}[rows]
    files = render(
        model, name="robot", folded=True, languages=["python"], only=[function], frames=[frame]
    )
    emitted = getattr(load(files, "robot", tmp_path), f"frame_{frame}_{function}")
    rng = np.random.default_rng(2)
    compared = 0
    for _ in range(40):
        q, v = pair.random_state(rng)
        truth = Peer(pair, q, v).frame(frame)
        J, rate = truth["jacobian"][:rows], truth["jacobian_dot_v"][:rows]
        expected, condition = operational(J, rate, pair.mass_matrix(q), pair.bias(q, v))
        if condition > 1e4:
            continue
        compared += 1
        for result, there in zip(emitted(q, v), expected, strict=True):
            assert relative(result, there) < TOLERANCE
    assert compared > 10


def test_a_derivation_is_asked_for_frames() -> None:
    derivation = derive(urdf.read("examples/panda/panda.urdf"))
    q = np.array([0.1, -0.3, 0.2, -2.0, 0.3, 2.0, 0.8, 0.02])
    hand = ("panda_hand",)
    position, rotation = derivation.function("frame_panda_hand_pose", frames=hand)(q)
    assert position.shape == (3,)
    assert np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-14)
    J = derivation.function("frame_panda_hand_jacobian", frames=hand)(q)
    Lambda, *_ = derivation.function("frame_panda_hand_operational_space", frames=hand)(q, 0 * q)
    M = derivation.function("mass_matrix")(q)
    assert np.allclose(Lambda @ J @ np.linalg.solve(M, J.T), np.eye(6), atol=1e-11)
    with pytest.raises(ModelError, match="is not there"):
        derivation.function("frame_panda_hand_pose")

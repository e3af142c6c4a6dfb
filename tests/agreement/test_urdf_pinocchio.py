"""What a URDF means, against Pinocchio: M and h of the derivation over floats, before anything is emitted."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.urdf_text import ZOO, axis, inertial, joint, link, mimic, origin, robot

from linegraph.derivation import derive
from linegraph.errors import LinegraphError
from linegraph.readers.urdf import parse, read

pytest.importorskip("pinocchio")
from oracles import pinocchio_models as peers

if TYPE_CHECKING:
    from pathlib import Path

    from linegraph.model.builder import Model

TOLERANCE = 1e-10
STATES = 10
# one each: mimics, fixed mimics, a link called ground, rotated inertials, a branching hand, prismatic joints
FEW = (
    "panda",
    "talos_reduced",
    "TwoDofs",
    "hyq_no_sensors",
    "allegro_left_hand",
    "tiago",
    "baxter",
    "romeo_small",
)

FIXED_MASTER = robot(
    *(link(name, inertial("1", rpy="0.1 0.2 0.3", tensor="0.1 0 0 0.1 0 0.05")) for name in "abcd"),
    joint("m", "a", "b", "fixed", origin("0.1 0 0", "0.3 0 0")),
    joint("f", "b", "c", "prismatic", origin("0 0.1 0", "0 0.3 0") + axis("1 1 0") + mimic("m", "2", "0.4")),
    joint("j", "c", "d", "revolute", origin("0 0.1 0.2") + axis("0 1 1")),
)  # fmt: skip
GROUND_LINK = robot(
    link("ground", inertial()),
    link("arm", inertial()),
    joint("j", "ground", "arm", "continuous", axis("1 -2 3")),
)  # fmt: skip
TEXTS = {"zoo": ZOO, "fixed_master": FIXED_MASTER, "ground": GROUND_LINK}


@pytest.mark.parametrize("floating", [False, True])
@pytest.mark.parametrize("symbolic", [False, True])
@pytest.mark.parametrize("name", TEXTS)
def test_small_robots(name: str, symbolic: bool, floating: bool) -> None:
    text = TEXTS[name]
    model = parse(text, "r.urdf", base="floating" if floating else "fixed", symbolic=symbolic)
    other = peers.load_text(text.decode(), floating=floating)
    pair = peers.Bridge(model, other, peers.followers(text.decode()))
    assert max(peers.worst_difference(pair, STATES, seed=1)) < TOLERANCE


def test_energy_and_inverse_dynamics() -> None:
    model = parse(ZOO, "r.urdf", base="floating")
    pair = peers.Bridge(
        model, peers.load_text(ZOO.decode(), floating=True), peers.followers(ZOO.decode())
    )
    rng = np.random.default_rng(2)
    offsets = []
    for _ in range(STATES):
        q, v = pair.random_state(rng)
        a = rng.normal(size=pair.nv)
        kinetic, potential = pair.numeric.energy(list(q), list(v))
        assert kinetic == pytest.approx(pair.kinetic_energy(q, v), rel=1e-11)
        offsets.append(potential - pair.potential_energy(q))
        found = pair.numeric.inverse_dynamics(list(q), list(v), list(a))
        expected = pair.inverse_dynamics(q, v, a)
        np.testing.assert_allclose(found, expected, rtol=0, atol=TOLERANCE * np.abs(expected).max())
    assert max(offsets) - min(offsets) < 1e-9


def robots() -> list[Path]:
    return [path for path in peers.urdf_files() if path.stem in FEW]


@pytest.mark.parametrize("floating", [False, True])
@pytest.mark.parametrize("path", robots(), ids=lambda path: path.stem)
def test_real_robots(path: Path, floating: bool) -> None:
    model = read(path, base="floating" if floating else "fixed")
    pair = peers.bridge(path, model, floating=floating)
    assert max(peers.worst_difference(pair, 3, seed=3)) < TOLERANCE


REFUSED = {
    "alex_psyonic_hands.urdf": ':1037: joint "Left_index_q2": <mimic> follows "index_q1"',
    "ur3.urdf": ":6: robot: has no links",
}


def problem(model: Model) -> str:
    """Why equations of motion do not exist, in a word."""
    try:
        derive(model)
    except LinegraphError as error:
        found = re.search("singular|no joint can move", str(error))
        return found.group() if found else str(error)
    return ""


@pytest.mark.parametrize("path", peers.urdf_files(), ids=lambda path: path.stem)
def test_every_robot_is_read_or_refused_for_a_known_reason(path: Path) -> None:
    if path.name in REFUSED:
        with pytest.raises(LinegraphError, match=REFUSED[path.name]):
            read(path)
        return
    for base in ("fixed", "floating"):
        model = read(path, base=base)
        assert problem(model) in ("", "singular", "no joint can move")

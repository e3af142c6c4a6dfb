"""A name means one thing in all coordinates: `coordinates` changes neither motion, forces nor outputs.

Each model of the examples and of the documentation is derived in its own coordinates and in others. A state
of the first is carried over by the motion of the bodies. Accelerations of all bodies, outputs and kinetic
energy have to be the same there. The accelerations come from M v̇ + h = Q + J^T λ, J v̇ = γ, solved densely.
"""

from __future__ import annotations

import re
from copy import deepcopy
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import linegraph as lg
from linegraph.dynamics.edge_variables import InverseScheme
from linegraph.dynamics.outputs import observed
from linegraph.numeric.between_trees import transfer
from linegraph.readers import modelfile

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph.derivation import Derivation

ROOT = Path(__file__).parents[2]
TIME = 0.3
TOLERANCE = 1e-8
OTHERS = ("absolute", "absolute-angle")
BIG = ("stewart", "andrews", "excavator", "bricard", "arm_with_drives")


def documents() -> Iterator[tuple[str, bytes]]:
    """Each model file of the examples and the documentation that stands by itself."""
    for path in sorted((ROOT / "examples").glob("*/*.toml")):
        yield path.relative_to(ROOT).as_posix(), path.read_bytes()
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))):
        blocks = re.findall(r"```toml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
        for k, block in enumerate(blocks):
            yield f"{page.name}#{k}", block.encode()


@cache
def readable() -> dict[str, lg.Model]:
    """Those that are whole models with bodies that move freely in some way."""
    found = {}
    for name, text in documents():
        try:
            model = modelfile.parse(text, "m.toml")
            lg.derive(model)
        except lg.LinegraphError:
            continue  # a fragment
        if model.bodies and all(p.value is not None for p in model.parameters.values()):
            found[name] = model
    return found


def solved(derivation: Derivation, q: Any, v: Any, u: Any) -> dict[str, Any]:
    """Accelerations of all bodies, outputs and kinetic energy at a state."""
    here = derivation.numeric(t=TIME, u=list(u)).at(q, v)
    parts = (here.forces, here.mass_matrix, here.bias, here.jacobian, here.constraint_bias)
    Q, M, h, J, gamma = (np.array(part, dtype=float) for part in parts)
    count, size = len(gamma), len(h)
    J = J.reshape(count, size)
    whole = np.block([[M, -J.T], [J, np.zeros((count, count))]])
    x = np.linalg.lstsq(whole, np.concatenate([Q - h, gamma]), rcond=1e-12)[0]
    a, lam = x[:size].tolist(), x[size:].tolist()
    scheme = InverseScheme(here.chords, a, lam)
    outputs, _ = observed(scheme)
    centers = {body: scheme.center(body) for body in derivation.system.bodies}
    return {
        **{body: np.array([*frame.pull, *frame.spin]) for body, frame in centers.items()},
        "outputs": np.array(outputs, dtype=float),
        "kinetic": np.array(here.energy[:1]),
    }


def state(derivation: Derivation, draw: np.random.Generator) -> tuple[list[float], list[float]]:
    """A state that satisfies the constraints: near the assembled one, velocities projected."""
    numeric = derivation.numeric(t=TIME)
    q = [x + draw.uniform(-0.2, 0.2) for x in derivation.assembled.q]
    numeric.tree.normalise(q)
    v = draw.uniform(-1, 1, len(numeric.tree.velocities))
    return q, v.tolist()


def compared(model: lg.Model, coordinates: str, seed: int = 0) -> float:
    """The worst difference of accelerations, outputs and kinetic energy, relative to their size."""
    draw = np.random.default_rng(seed)
    twin = deepcopy(model)
    twin.formulation(coordinates=coordinates, tree=(), independent=None)
    first, second = lg.derive(model), lg.derive(twin)
    q, v = state(first, draw)
    u = draw.uniform(-1, 1, len(first.structure.inputs)).tolist()
    from_, to = first.numeric(t=TIME, u=u), second.numeric(t=TIME, u=u)
    there = transfer(from_, q, v, to)
    mechanical = from_.tree.layout.mechanical
    there[1][to.tree.layout.mechanical :] = v[mechanical:]
    a, b = solved(first, q, v, u), solved(second, *there, u)
    size = 1 + max(float(np.abs(x).max(initial=0)) for x in a.values())
    return max(float(np.abs(a[key] - b[key]).max(initial=0)) for key in a) / size


ALLOWED = "no branch of the tree|put it in a joint that is a branch|moves no inertia|is not a finite number"
"""Why a model cannot have such coordinates, or not be compared at such a state: never moved otherwise."""


@pytest.mark.seeds(range(1), range(6))
@pytest.mark.parametrize("coordinates", OTHERS)
def test_coordinates_change_neither_motion_nor_outputs(coordinates: str, seed: int) -> None:
    refused = {}
    for name, model in readable().items():
        if not seed and any(big in name for big in BIG):
            continue  # a second or more each
        try:
            worst = compared(model, coordinates, seed)
        except lg.LinegraphError as error:
            refused[name] = str(error)
            continue
        assert worst < TOLERANCE, (name, worst)
    assert all(re.search(ALLOWED, reason) for reason in refused.values()), refused
    assert len(refused) <= 6
    assert len(readable()) > 30


SAME_NAME = """name = "m"
[gravity]
acceleration = [0, 0, 0]
[frame.f]
at = [1, 2, 3]
rpy = [0, 0, "pi/2"]
[body.a]
mass = 2
mass_center = [0.1, 0, 0]
inertia = [1, 1, 1]
[free.a]
between = ["ground.f", "a"]
effort = false
[load.l]
at = "a"
force = ["10*a_x + 3*der(a_y)", 0, 0]
[outputs]
x = "a_x"
fx = "acceleration(a.mass_center).x"
"""
DRUM = """name = "m"
[body.drum]
mass = 1
inertia = [1, 1, 1]
[revolute.drum]
between = ["ground", "drum"]
axis = [0, 0, 1]
[load.l]
at = "drum"
torque = [0, 0, "-der(drum)"]
[outputs]
w = "der(drum)"
"""


@pytest.mark.parametrize("text", [SAME_NAME, DRUM], ids=["free", "hinge"])
@pytest.mark.parametrize("coordinates", OTHERS)
def test_a_joint_called_like_its_body_keeps_its_coordinates(text: str, coordinates: str) -> None:
    model = modelfile.parse(text.encode(), "m.toml")
    for seed in range(5):
        assert compared(model, coordinates, seed) < 1e-12


def test_the_position_of_a_free_joint_is_that_of_its_origin_in_absolute_coordinates() -> None:
    """A pull of -10 b_x: with the origin at x = 0.7 and the mass centre at 1.0 it is -7 N and not -10 N."""
    text = SAME_NAME.replace('"10*a_x + 3*der(a_y)"', '"-10*a_x"').replace("ground.f", "ground")
    model = modelfile.parse(text.replace("[0.1, 0, 0]", "[0.3, 0, 0]").encode(), "m.toml")
    model.formulation(coordinates="absolute")
    d = lg.derive(model)
    assert [q.name for q in d.structure.positions][:3] == ["a_body_x", "a_body_y", "a_body_z"]
    q, v = [1.0, 0, 0, 0, 0, 0, 1.0], [0.0] * 6
    found = solved(d, q, v, [])
    assert found["outputs"] == pytest.approx([0.7, -7 / 2])
    (power,) = np.array(d.numeric().bias(q, v))[:1]
    assert power == pytest.approx(7.0)


@pytest.mark.parametrize("name", ["yard", "excavator_arm"])
@pytest.mark.parametrize("coordinates", OTHERS)
def test_models_with_joints_called_like_bodies_have_absolute_coordinates(
    name: str, coordinates: str
) -> None:
    """In the yard a relation names two joints, which stay branches therefore."""
    model = next(m for m in readable().values() if m.name == name)
    assert compared(model, coordinates, seed=1) < TOLERANCE


def test_a_motor_says_that_its_joint_has_to_be_a_branch() -> None:
    """The drum of the winch has a joint of its own name, with a motor in it."""
    model = next(m for m in readable().values() if m.name == "winch")
    assert compared(model, "absolute-angle", seed=1) < TOLERANCE
    with pytest.raises(lg.ModelError, match="put it in a joint that is a branch"):
        compared(model, "absolute")


LED = """name = "m"
[body.a]
mass = 1
[body.b]
mass = 1
[prismatic.x]
between = ["ground", "a"]
axis = [1, 0, 0]
effort = false
[prismatic.led]
between = ["ground", "b"]
axis = [0, 1, 0]
motion = "0.1*sin(t)"
[relation.r]
rate = "der(x) - RATE"
"""


@pytest.mark.parametrize(
    ("rate", "acceleration"),
    [
        ("der(led)", lambda t: -0.1 * np.sin(t)),
        ("led*der(led)", lambda t: 0.01 * np.cos(2 * t)),
        ("led + 0.3*t", lambda t: 0.1 * np.cos(t) + 0.3),
    ],
)
def test_a_relation_follows_a_prescribed_motion(rate: str, acceleration: Any) -> None:
    """X' = f(led, led', t): x'' is its whole derivative, that of the prescribed motion included."""
    law = LED.replace("RATE", f"({rate})" if "+" in rate else rate)
    d = lg.derive(modelfile.parse(law.encode(), "m.toml"))
    for t in (0.0, 0.4, 1.0):
        numeric = d.numeric(t=t)
        assert numeric.constraint_bias([0.2], [0.1]) == pytest.approx([acceleration(t)], abs=1e-14)


@pytest.mark.parametrize("sequence", ["xyz", "zxz", "yzx"])
def test_a_free_joint_with_angles_pushes_alike_as_a_chord(sequence: str) -> None:
    """Efforts along its position and its angles, and a law that names these."""
    model = lg.Model("m")
    model.ground.frame("f", at=(1, 0.5, 0), rpy=(0.3, -0.2, 0.4))
    body = model.body("b", mass=2, mass_center=(0.1, 0.2, 0.3), inertia=(0.3, 0.4, 0.5))
    model.free(
        "b", ("ground.f", body), angles=sequence, effort=True, start=(0, 0, 0, 0.4, 0.7, 0.2)
    )
    model.load("l", body, force=("3*b_x - der(b_angle2)", "b_angle1", 0))
    model.output("angle", "b_angle3 + 2*der(b_y)")
    for seed in range(3):
        assert compared(model, "absolute", seed) < 1e-11

"""Links that move no inertia: whatever does not divide by M is there, and what does is refused once.

Nearly all industrial arms are published so: their links have meshes and no masses.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import numpy as np
import pytest
from cli.test_cli import linegraph, refused
from oracles import pinocchio_models as peers
from support.emitted import load
from support.modelfile_text import LOOP
from support.urdf_text import axis, inertial, joint, link, origin, robot

from linegraph import LinegraphError, Model, ModelError, derive
from linegraph.emission.emit import module_for, render
from linegraph.programs.register import OF_FRAMES, PROGRAMS
from linegraph.readers import modelfile, urdf

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path
    from types import ModuleType

OFFSET = (0.1, 0.0, 0.2)
TILT = 0.3
TURNING = ("j1", "j2", "j3", "j4")
DIVIDE = {"forward_dynamics", "rhs", "reactions"}
"""What `emit` writes by default that divides by M, of an arm."""


def arm(*solid: int) -> bytes:
    """Four hinges about z, each frame shifted and tilted about x; the links given have mass and inertia."""
    lines = [link("base")]
    for k, name in enumerate(TURNING, 1):
        heavy = inertial(tensor="0.3 0 0 0.4 0 0.5") if k in solid else ""
        place = origin(" ".join(map(str, OFFSET)), f"{TILT} 0 0")
        lines += [
            link(f"l{k}", heavy),
            joint(name, f"l{k - 1}" if k > 1 else "base", f"l{k}", inner=place + axis("0 0 1")),
        ]
    return robot(*lines)


def pose(q: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """Where the last link of the arm stands, by multiplying rotations."""
    at, turn = np.zeros(3), np.eye(3)
    c, s = math.cos(TILT), math.sin(TILT)
    tilt = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    for angle in q:
        at = at + turn @ np.array(OFFSET)
        c, s = math.cos(angle), math.sin(angle)
        turn = turn @ tilt @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    return at, turn


def emitted(model: Model, folder: Path, **options: object) -> tuple[ModuleType, list[str]]:
    """The emitted Python, and what `emit` warns of."""
    told: list[str] = []
    files = render(model, name="m", languages=["python"], warn=told.append, **options)
    return load(files, "m", folder), told


def test_an_arm_of_empty_links_has_its_kinematics(tmp_path: Path) -> None:
    module, told = emitted(urdf.parse(arm(), "arm.urdf"), tmp_path, frames=["l4"])
    (warning,) = told
    assert all(name in warning for name in (*TURNING, *DIVIDE))
    assert not DIVIDE & {*dir(module)}
    q, v, a = [0.3, -0.4, 0.5, 0.6], [0.7, 0.1, -0.2, 0.4], [1.0, 2.0, 3.0, 4.0]
    at, turn = pose(q)
    position, rotation = module.frame_l4_pose(q)
    np.testing.assert_allclose(position, at, atol=1e-14)
    np.testing.assert_allclose(rotation, turn, atol=1e-14)
    assert not module.mass_matrix(q).any()
    assert not module.inverse_dynamics(q, v, a).any()
    assert module.coordinate_rates(q, v).tolist() == v


def test_a_wrist_of_empty_links_leaves_the_rest_as_if_it_were_locked(tmp_path: Path) -> None:
    """M, h and τ of the first two joints are those of the arm with the wrist locked; the others are zero."""
    whole, told = emitted(urdf.parse(arm(1, 2), "arm.urdf"), tmp_path / "whole")
    (warning,) = told
    assert '"j3"' in warning
    assert '"j4"' in warning
    assert '"j2"' not in warning
    short = urdf.parse(arm(1, 2), "arm.urdf")
    for name in ("j3", "j4"):
        short.lock(name)
    locked, quiet = emitted(short, tmp_path / "locked")
    assert not quiet
    assert {*dir(locked)} >= DIVIDE
    q, v, a = [0.3, -0.4, 0.5, 0.6], [0.7, 0.1, -0.2, 0.4], [1.0, 2.0, 3.0, 4.0]
    M = np.zeros((4, 4))
    M[:2, :2] = locked.mass_matrix(q[:2])
    np.testing.assert_allclose(whole.mass_matrix(q), M, atol=1e-15)
    tau = [*locked.inverse_dynamics(q[:2], v[:2], a[:2]), 0.0, 0.0]
    np.testing.assert_allclose(whole.inverse_dynamics(q, v, a), tau, atol=1e-14)


@pytest.mark.parametrize("function", sorted(PROGRAMS))
def test_every_function_is_written_or_refused_with_all_joints_named(function: str) -> None:
    """What is asked for by name and divides by M is refused once; all else is written."""
    model = urdf.parse(arm(1, 2), "arm.urdf", symbolic=True)
    frames = ["l4"] if function in (*OF_FRAMES, "kinematics") else []
    try:
        module = module_for(model, "m", only=[function], frames=frames)
    except ModelError as error:
        text = str(error)
        if "is none of this model" in text:
            return
        assert re.match(r'arm.urdf:\d+: joint "j3": moves no inertia of its own \(l3\)', text)
        assert f'and neither does "j4" (l4): the mass matrix is singular, and {function}' in text
        assert text.endswith("or lock or fix the joints (--lock j3 --lock j4)")
        dividing = ("forward", "linear", "rhs", "operational", "drives", "outputs", "power")
        assert function.startswith(dividing)
    else:
        assert module.programs
        names = {program.name for program in module.programs}
        assert not names & {"forward_dynamics", "rhs", "linearize", "reactions"}


def test_reactions_for_given_accelerations_need_no_inertia(tmp_path: Path) -> None:
    """`reactions` first solves for accelerations and is left out; `reactions_at` is given them."""
    module, told = emitted(urdf.parse(arm(1, 2), "arm.urdf"), tmp_path, only=["reactions"])
    (warning,) = told
    assert "reactions, which divides by it, is left out" in warning
    assert module.reactions_at([0.0] * 4, [0.0] * 4, [0.0] * 4).any()
    assert not hasattr(module, "reactions")
    assert "reactions is left out: the mass matrix is singular, as joints" in module.__doc__


def test_a_notebook_is_told_the_same() -> None:
    derivation = derive(urdf.parse(arm(1, 2), "arm.urdf"))
    asked: tuple[Callable[[], object], ...] = (
        lambda: derivation.function("forward_dynamics"),
        lambda: derivation.function("reactions"),
        lambda: derivation.symbolic.rates,
        derivation.linearise,
    )
    for ask in asked:
        with pytest.raises(ModelError, match=r'"j3": moves no inertia .* "j4" \(l4\)'):
            ask()
    assert derivation.mass_matrix[2:, :].is_zero_matrix


def test_library_users_are_warned_as_python_warns() -> None:
    with pytest.warns(UserWarning, match='"j3": moves no inertia of its own'):
        render(urdf.parse(arm(1, 2), "arm.urdf"), languages=["python"])


# ---- loops, networks, parameters


def test_a_linkage_without_masses_has_its_kinematics(tmp_path: Path) -> None:
    """The bars of a four-bar linkage in the ratio of their lengths, by its closure equations."""
    text = re.sub(r"(mass|inertia) = .*\n", "", LOOP)
    module, (warning,) = emitted(modelfile.parse(text.encode(), "m.toml"), tmp_path)
    for name in ("motor", "elbow", "swing", "forward_dynamics", "project"):
        assert name in warning
    assert "--lock" not in warning, "locking one of them is enough"
    derivation = derive(modelfile.parse(text.encode(), "m.toml"))
    q = derivation.assembled.q
    p = module.DEFAULT_PARAMETERS
    found, v = module.complete(p, q, [q[0]], [1.0])
    np.testing.assert_allclose(found, q, atol=1e-12)
    np.testing.assert_allclose(module.constraint_rates(p, q, v), 0, atol=1e-12)
    assert not module.reduced_equations(p, q, v)[0].any()


def test_a_motor_gives_an_empty_link_its_rotor_inertia(tmp_path: Path) -> None:
    """J n² = 2e-5 · 50² = 0.05 kg m²; the torque k n i = 0.04 · 50 · 0.2 N m turns it with 8 rad/s²."""
    text = """
[inputs]
u = {}
[body.arm]
[revolute.hinge]
between = ["ground", "arm"]
axis = [0, -1, 0]
effort = false
[voltage_source.supply]
between = ["plus", "ground"]
voltage = "u"
[dc_motor.motor]
between = ["plus", "ground"]
joint = "hinge"
constant = 0.04
resistance = 2.4
inductance = 1e-3
ratio = 50
"""
    whole = modelfile.parse(f"{text}inertia = 2e-5\n".encode(), "m.toml")
    module, told = emitted(whole, tmp_path)
    assert not told
    np.testing.assert_allclose(module.mass_matrix([0.1]), np.diag([0.05, 1e-3]), rtol=1e-15)
    rates = [8.0, (12 - 2.4 * 0.2 - 2 * 0.3) / 1e-3]
    np.testing.assert_allclose(
        module.forward_dynamics([0.1], [0.3, 0.2], [12.0]), rates, rtol=1e-14
    )
    bare, (warning,) = emitted(modelfile.parse(text.encode(), "m.toml"), tmp_path / "bare")
    assert 'joint "hinge": moves no inertia of its own (arm)' in warning
    assert bare.mass_matrix([0.1]).tolist() == [[0.0, 0.0], [0.0, 1e-3]]


def test_parameters_are_judged_at_their_own_values(tmp_path: Path) -> None:
    text = """
[parameters]
J = { value = 0.0, unit = "kg*m^2" }
[body.rotor]
inertia = { xx = 1.0, yy = 1.0, zz = "J" }
[body.empty]
[revolute.spin]
between = ["ground", "rotor"]
axis = [0, 0, 1]
[revolute.tip]
between = ["rotor", "empty"]
axis = [0, 0, 1]
"""
    module, (warning,) = emitted(modelfile.parse(text.encode(), "m.toml"), tmp_path)
    assert '"spin": moves no inertia of its own' in warning
    assert '"tip"' in warning
    changed = module.DEFAULT_PARAMETERS.replace(J=3.0)
    assert module.mass_matrix(changed, [0.1, 0.2]).tolist() == [[3.0, 0.0], [0.0, 0.0]]


def test_all_stores_of_no_capacitance_are_named() -> None:
    text = """
[parameters]
C = 0.0
[inputs]
u = {}
[voltage_source.supply]
between = ["plus", "ground"]
voltage = "u"
"""
    for name, start in (("c", "plus"), ("d", "c")):
        text += f'[resistor.r{name}]\nbetween = ["{start}", "{name}"]\nresistance = 2\n'
        text += f'[capacitor.{name}]\nbetween = ["{name}", "ground"]\ncapacitance = "C"\n'
    model = modelfile.parse(text.encode(), "m.toml")
    with pytest.raises(LinegraphError) as caught:
        render(model, only=["rhs"])
    assert 'capacitor "c": v_c (voltage across c) has no rate' in str(caught.value)
    assert 'neither has v_d (voltage across d) of capacitor "d"' in str(caught.value)
    assert render(model, only=["mass_matrix", "inverse_dynamics"])


def test_an_inertia_less_than_nothing_is_refused_at_once() -> None:
    model = Model("m")
    model.revolute("a", between=("ground", model.body("rotor", inertia=(1, 1, -0.5))))
    with pytest.raises(ModelError, match="not positive definite"):
        derive(model)


# ---- the command line


def test_every_command_takes_an_arm_of_empty_links(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_bytes(arm())
    for command in ("show", "graph", "derive", "parameters", "trees", "check"):
        done = linegraph(command, path)
        assert done.returncode == 0, done.stderr
        assert "Traceback" not in done.stderr
    assert "the mass matrix is singular: joints" in linegraph("show", path).stdout
    assert "mass matrix is singular, since joints" in " ".join(
        linegraph("derive", path).stdout.split()
    )
    assert "accelerations and powers: M is singular" in linegraph("check", path).stdout
    done = linegraph("emit", path, "--out", tmp_path / "b", "--tests")
    assert done.returncode == 0
    assert done.stderr.count("warning:") == 1
    assert re.search(r'warning: .*arm\.urdf:\d+: joint "j1": moves no inertia', done.stderr)
    assert (tmp_path / "b" / "r_test.c").exists()


def test_what_divides_by_m_is_refused_once(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_bytes(arm())
    out = tmp_path / "b"
    for option in ("--only", "--with"):
        done = linegraph("emit", path, "--out", out, option, "linearize")
        refused(done, "error:", *(f'"{name}"' for name in TURNING), "--lock j1 --lock j2")
        assert done.stderr.count("error:") == 1
        assert not out.exists()


def test_a_robot_with_empty_fingers_has_the_mass_matrix_of_pinocchio(tmp_path: Path) -> None:
    """A humanoid whose grippers turn nothing: M, h and τ of all 33 joints, which Pinocchio has, too."""
    files = [file for file in peers.urdf_files() if file.stem == "romeo_laas_small"]
    if not files:
        pytest.skip("the example-robot-data wheel is not installed")
    model, text = urdf.read(files[0], snap=0.0), files[0].read_text()
    assert {x.name for x in derive(model).idle} == {"l_gripper_joint", "r_gripper_joint"}
    module, (warning,) = emitted(model, tmp_path, folded=True)
    assert "l_gripper_joint" in warning
    assert "r_gripper_joint" in warning
    pair = peers.Bridge(model, peers.load_text(text, floating=False), peers.followers(text), {})
    rng = np.random.default_rng(0)
    for _ in range(5):
        q, v = pair.random_state(rng)
        a = rng.normal(size=module.NV)
        for found, expected in (
            (module.mass_matrix(q), pair.mass_matrix(q)),
            (module.bias(q, v), pair.bias(q, v)),
            (module.inverse_dynamics(q, v, a), pair.inverse_dynamics(q, v, a)),
        ):
            np.testing.assert_allclose(found, expected, atol=1e-11 * np.abs(expected).max())

"""What URDFs mean: bodies, joints, coordinates, parameters and warnings."""

from __future__ import annotations

import math
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.urdf_text import ZOO, axis, inertial, joint, link, mimic, origin, robot

from linegraph.derivation import derive
from linegraph.errors import SourceError
from linegraph.readers.urdf import parse, read
from linegraph.spatial.rotation import from_rpy

if TYPE_CHECKING:
    from pathlib import Path

    from linegraph.model.builder import Model

ARM = robot(
    link("base"),
    link("arm", inertial()),
    joint("hinge", "base", "arm", inner=origin("0 0 1") + axis("0 1 0")),
)


def coordinates(model: Model) -> tuple[list[str], list[str]]:
    tree = derive(model).numeric().tree
    return [q.name for q in tree.positions], [v.name for v in tree.velocities]


def state(model: Model, seed: int = 0) -> tuple[list[float], list[float]]:
    """A random state, quaternions at the end of a joint's positions normalised."""
    rng = np.random.default_rng(seed)
    q: list[float] = []
    for one in model.joints:
        if one.name in {coupling.joint for coupling in model.couplings}:
            continue
        part = rng.uniform(-1, 1, len(one.positions()))
        if len(part) == 7:
            part[3:] /= np.linalg.norm(part[3:])
        q += part.tolist()
    return q, rng.uniform(-1, 1, len(coordinates(model)[1])).tolist()


def equations(model: Model, q: list[float], v: list[float]) -> tuple[np.ndarray, np.ndarray]:
    numeric = derive(model).numeric()
    return np.array(numeric.mass_matrix(q)), np.array(numeric.bias(q, v))


def assert_same(model: Model, other: Model, tolerance: float = 1e-12) -> None:
    q, v = state(model)
    for a, b in zip(equations(model, q, v), equations(other, q, v), strict=True):
        np.testing.assert_allclose(a, b, rtol=0, atol=tolerance * np.abs(a).max())


def test_a_file_and_its_text_give_the_same(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_bytes(ARM)
    for model in (read(path), read(str(path)), parse(ARM, "arm.urdf")):
        assert model.name == "r"
        assert list(model.bodies) == ["base", "arm"]
        assert [j.name for j in model.joints if j.freedoms] == ["hinge"]
        assert model.gravity == (0, 0, -9.81)
        assert model.warnings == []


def test_the_inertial_frame_is_turned_into_link_axes() -> None:
    text = robot(link("base"), link("arm", inertial(rpy="0.3 -0.4 0.5", tensor="1 0.1 0.2 1.1 0.05 1.2")),
                 joint("hinge", "base", "arm"))  # fmt: skip
    body = parse(text, "r.urdf").bodies["arm"]
    R = np.array(from_rpy(0.3, -0.4, 0.5))
    written = np.array([[1, 0.1, 0.2], [0.1, 1.1, 0.05], [0.2, 0.05, 1.2]])
    np.testing.assert_allclose(body.inertia, (R @ written @ R.T)[np.triu_indices(3)], atol=1e-15)
    assert body.mass == 2.0
    assert body.center == (0.1, 0.2, 0.3)


def test_the_joint_frame_lies_on_the_parent_under_the_joints_name() -> None:
    model = parse(ARM, "r.urdf")
    hinge = next(j for j in model.joints if j.name == "hinge")
    assert hinge.between == ("base.hinge", "arm")
    assert model.bodies["base"].frames["hinge"].at == (0.0, 0.0, 1.0)
    assert hinge.axis == (0.0, 1.0, 0.0)


def test_a_pendulum_has_the_textbook_equations() -> None:
    text = robot(link("base"), link("bob", inertial("2", "0 0 -0.5", tensor="0 0 0 0 0 0")),
                 joint("hinge", "base", "bob", "continuous", axis("0 1 0")))  # fmt: skip
    numeric = derive(parse(text, "r.urdf")).numeric()
    assert numeric.mass_matrix([0.3])[0][0] == pytest.approx(2 * 0.25)
    assert numeric.bias([0.3], [1.0])[0] == pytest.approx(2 * 9.81 * 0.5 * math.sin(0.3))


def test_the_axis_is_x_by_default_and_scaled_to_one() -> None:
    text = robot(*(link(n, inertial()) for n in "abcd"), joint("j", "a", "b"),
                 joint("k", "b", "c", "prismatic", axis("0 -3 0")),
                 joint("l", "c", "d", "revolute", axis("1 2 2.0001")))  # fmt: skip
    model = parse(text, "r.urdf")
    axes = {j.name: j.axis for j in model.joints}
    assert axes["j"] == (1, 0, 0)
    assert axes["k"] == (0, -1, 0)
    assert math.hypot(*axes["l"]) == pytest.approx(1, abs=1e-15)
    assert model.warnings == [
        'r.urdf:7: joint "k": <axis> has length 3; it is scaled to 1',
        'r.urdf:8: joint "l": <axis> has length 3.00007; it is scaled to 1',
    ]


@pytest.mark.parametrize("xyz", ["6e-17 0 -1", "1e-200 0 -1", "0 1e-13 1.0000001", "0 0 1e-300"])
def test_dust_beside_a_coordinate_axis_is_swept(xyz: str) -> None:
    model = parse(
        robot(link("a"), link("b", inertial()), joint("j", "a", "b", inner=axis(xyz))), "r.urdf"
    )
    assert {abs(c) for c in model.joints[-1].axis} == {0.0, 1.0}
    derive(model)


def test_coordinates_come_depth_first_whatever_the_file_order() -> None:
    links = [link(name, inertial()) for name in ("d", "c", "b", "a", "root_link")]
    joints = [
        joint("rd", "root_link", "d"), joint("bc", "b", "c"), joint("ra", "root_link", "a"),
        joint("ab", "a", "b"),
    ]  # fmt: skip
    model = parse(robot(*joints, *links), "r.urdf")
    assert coordinates(model)[0] == ["rd", "ra", "ab", "bc"]
    assert list(model.bodies) == ["root_link", "d", "a", "b", "c"]


def test_the_zoo_has_its_coordinates() -> None:
    q, v = coordinates(parse(ZOO, "zoo.urdf"))
    flight = [f"flight_{c}" for c in ("x", "y", "z", "qx", "qy", "qz", "qw")]
    assert q == ["shoulder", "elbow", "slide", "table_x", "table_y", "table_angle", *flight]
    rates = [f"flight_{c}" for c in ("vx", "vy", "vz", "wx", "wy", "wz")]
    assert v == ["shoulder", "elbow", "slide", "table_vx", "table_vy", "table_wz", *rates]


def test_a_floating_base_comes_first() -> None:
    q, v = coordinates(parse(ZOO, "zoo.urdf", base="floating"))
    assert q[:8] == [*(f"root_{c}" for c in ("x", "y", "z", "qx", "qy", "qz", "qw")), "shoulder"]
    assert v[:7] == [*(f"root_{c}" for c in ("vx", "vy", "vz", "wx", "wy", "wz")), "shoulder"]


def test_another_base_is_a_mistake_of_the_caller() -> None:
    with pytest.raises(ValueError, match='"fixed" or "floating"'):
        parse(ARM, "r.urdf", base="flying")


def test_followers_have_no_coordinate_and_keep_their_ratio() -> None:
    model = parse(ZOO, "zoo.urdf")
    found = {c.joint: (c.master, c.ratio, c.offset) for c in model.couplings}
    assert found == {
        "finger_joint": ("elbow", -1.5, 0.25),
        "tip_joint": ("finger_joint", 0.5, -0.1),
    }


def test_a_follower_of_a_fixed_joint_stands_at_its_offset() -> None:
    def text(kind: str, followers: tuple[str, str]) -> bytes:
        return robot(
            *(link(n, inertial()) for n in "abcde"), joint("m", "a", "b", kind, axis("0 0 1")),
            joint("f", "b", "c", "revolute", axis("0 1 0") + followers[0]),
            joint("g", "c", "d", "prismatic", axis("0 1 0") + followers[1]),
            joint("free_one", "d", "e", "revolute", axis("0 1 0")),
        )  # fmt: skip

    model = parse(text("fixed", (mimic("m", "2", "0.4"), mimic("f", "3", "-1"))), "r.urdf")
    assert coordinates(model)[0] == ["free_one"]
    assert model.warnings == [
        'r.urdf:8: joint "f": <mimic> follows "m", which cannot move: welded at 0.4',
        'r.urdf:9: joint "g": <mimic> follows "f", which cannot move: welded at 0.2',
    ]
    by_hand = parse(text("fixed", ("", "")), "r.urdf")
    by_hand.lock("f", 0.4)
    by_hand.lock("g", 0.4 * 3 - 1)
    assert_same(model, by_hand)


def test_a_mimic_on_a_fixed_joint_is_ignored_with_a_warning() -> None:
    text = robot(*(link(n, inertial()) for n in "abc"), joint("j", "a", "b"),
                 joint("k", "b", "c", "fixed", mimic("j")))  # fmt: skip
    model = parse(text, "r.urdf")
    assert model.couplings == ()
    assert model.warnings == ['r.urdf:6: joint "k": <mimic> of a fixed joint is ignored']


def test_locking_a_master_locks_its_followers() -> None:
    model = parse(ZOO, "zoo.urdf")
    model.lock("elbow", 0.3)
    assert "elbow" not in coordinates(model)[0]
    assert model.couplings == ()


def test_welded_inertials_add_up() -> None:
    """Two links welded by a rotated frame are one body: compare with the moments added by hand."""
    tensors = np.diag([0.3, 0.4, 0.5]), np.diag([0.1, 0.2, 0.15])
    center, at, rpy = np.array([0.1, 0, 0.2]), np.array([0.5, -0.1, 0.2]), (0.3, 0.7, -0.4)
    text = robot(
        link("base"), link("arm", inertial("3", "0.1 0 0.2", tensor="0.3 0 0 0.4 0 0.5")),
        link("tool", inertial("1", "0.05 0.1 0", tensor="0.1 0 0 0.2 0 0.15")),
        joint("hinge", "base", "arm", "revolute", axis("0 1 0")),
        joint("bolt", "arm", "tool", "fixed", origin("0.5 -0.1 0.2", "0.3 0.7 -0.4")),
    )  # fmt: skip
    R = np.array(from_rpy(*rpy))
    tool = at + R @ np.array([0.05, 0.1, 0])
    about_y = sum(
        (T + m * (c @ c * np.eye(3) - np.outer(c, c)))[1, 1]
        for T, m, c in ((tensors[0], 3, center), (R @ tensors[1] @ R.T, 1, tool))
    )
    assert derive(parse(text, "r.urdf")).numeric().mass_matrix([0.7])[0][0] == pytest.approx(
        about_y
    )


def test_symbolic_numbers_keep_the_files_values() -> None:
    folded, symbolic = parse(ZOO, "zoo.urdf"), parse(ZOO, "zoo.urdf", symbolic=True)
    assert coordinates(folded) == coordinates(symbolic)
    assert_same(folded, symbolic)
    links = [body for body in folded.bodies if body != "world"]
    joints = [j.name for j in folded.joints if j.name != "ground/base"]
    assert len(symbolic.parameters) == 10 * len(links) + 3 * len(joints)


def test_symbolic_parameters_are_moments_about_the_links_origin() -> None:
    model = parse(ARM, "r.urdf", symbolic=True)
    values = {p.name: (p.value, p.unit) for p in model.parameters.values()}
    assert list(values) == [
        "m_arm", "mx_arm", "my_arm", "mz_arm",
        "Ixx_arm", "Ixy_arm", "Ixz_arm", "Iyy_arm", "Iyz_arm", "Izz_arm",
        "x_hinge", "y_hinge", "z_hinge",
    ]  # fmt: skip
    assert values["m_arm"] == (2.0, "kg")
    assert values["my_arm"] == (pytest.approx(0.4), "kg m")
    assert values["Ixx_arm"] == (pytest.approx(1 + 2 * (0.04 + 0.09)), "kg m^2")
    assert values["Ixy_arm"] == (pytest.approx(-2 * 0.02), "kg m^2")
    assert values["z_hinge"] == (1.0, "m")


def test_changing_a_symbolic_parameter_changes_the_equations() -> None:
    model = parse(ARM, "r.urdf", symbolic=True)
    numeric = derive(model).numeric({"Iyy_arm": 7.0})
    assert numeric.mass_matrix([0.0])[0][0] == pytest.approx(7.0)


def test_parameter_names_are_identifiers_and_unique() -> None:
    names = ["left arm", "left-arm", "left__arm", "手", "腕", "2nd", "x" * 300]
    links = [link("base"), *(link(name, inertial()) for name in names)]
    joints = [joint(f"j{i}", "base", name) for i, name in enumerate(names)]
    twins = [link("last", inertial()), joint("m_left_arm", "base", "last")]
    found = list(parse(robot(*links, *joints, *twins), "r.urdf", symbolic=True).parameters)
    masses = [name for name in found if name.startswith("m_")]
    assert masses == [
        "m_left_arm_2", "m_left_arm_3", "m_left_arm_4", "m_unnamed", "m_unnamed_2", "m_2nd",
        "m_" + 100 * "x", "m_last",
    ]  # fmt: skip
    assert all(name.isascii() and name.isidentifier() for name in found)


def test_snap_is_the_models() -> None:
    text = robot(
        link("a"), link("b", inertial()), joint("j", "a", "b", inner=origin(rpy="0 0 1.5708"))
    )
    fine = parse(text, "r.urdf").bodies["a"].frames["j"].rotation
    coarse = parse(text, "r.urdf", snap=1e-4).bodies["a"].frames["j"].rotation
    assert 0 < abs(fine[0][0]) < 1e-5
    assert coarse == ((0, -1, 0), (1, 0, 0), (0, 0, 1))


def test_links_without_inertial_or_mass_are_fine() -> None:
    text = robot(link("a"), link("b"), link("c", inertial("0", tensor="0 0 0 0 0 0")),
                 link("d", inertial("1", tensor="0 0 0 0 0 0")), joint("ab", "a", "b"),
                 joint("bc", "b", "c", "fixed"), joint("cd", "c", "d", "fixed"))  # fmt: skip
    model = parse(text, "r.urdf")
    assert model.warnings == []
    assert [body.mass for body in model.bodies.values()] == [0, 0, 0, 1]


WARNINGS = {
    "negative_moment": (
        link("a", inertial(tensor="1 0 0 1 0 -0.1")),
        'r.urdf:2: link "a": no body has this inertia: principal moments -0.1, 1, 1 kg m^2: '
        "none can be negative",
    ),
    "triangle": (
        link("a", inertial(tensor="1 0 0 1 0 2.1")),
        'r.urdf:2: link "a": no body has this inertia: principal moments 1, 1, 2.1 kg m^2: '
        "the largest exceeds the sum of the others",
    ),
    "products_too_large": (
        link("a", inertial(tensor="1 2 0 1 0 1")),
        'r.urdf:2: link "a": no body has this inertia: principal moments -1, 1, 3 kg m^2: '
        "none can be negative",
    ),
    "no_inertia": (
        link("a", '<inertial><mass value="1"/></inertial>'),
        'r.urdf:2: link "a": <inertial> has no <inertia>; the link is taken as a point mass',
    ),
    "misspelt_inertial": (
        link("a", "<inertal/>"),
        'r.urdf:2: link "a": <inertal> is not known and ignored; did you mean "inertial"?',
    ),
    "misspelt_link": (
        link("a") + "\n<lnik/>",
        'r.urdf:3: robot: <lnik> is not known and ignored; did you mean "link"?',
    ),
    "origin_beside_inertial": (
        link("a", "<origin/><origin/>"),
        'r.urdf:2: link "a": <origin> is not known and ignored',
    ),
    "misspelt_xyz": (
        link("a", '<inertial><origin xzy="0 0 0"/><mass value="0"/><inertia ixx="0" ixy="0" ixz="0" '
                  'iyy="0" iyz="0" izz="0"/></inertial>'),
        'r.urdf:2: link "a": <origin> attribute "xzy" is not known and ignored; did you mean "xyz"?',
    ),
    "misspelt_multiplier": (
        f'{link("a")}{link("b")}{link("c")}{joint("j", "a", "b")}\n'
        + joint("k", "b", "c", inner='<mimic joint="j" multiplyer="2"/>'),
        'r.urdf:3: joint "k": <mimic> attribute "multiplyer" is not known and ignored; '
        'did you mean "multiplier"?',
    ),
    "misspelt_origin_of_a_joint": (
        link("a") + link("b") + "\n" + joint("j", "a", "b", inner="<orgin/>"),
        'r.urdf:3: joint "j": <orgin> is not known and ignored; did you mean "origin"?',
    ),
    "dampers": (
        "\n".join([link("a") + link("b") + link("c"),
                   joint("j", "a", "b", inner='<dynamics damping="0" friction="0"/>'),
                   joint("k", "b", "c", inner='<dynamics friction="0.1"/>')]),
        'r.urdf:4: joint "k": damping and friction are ignored',
    ),
    "ground": (
        link("ground"),
        'r.urdf:2: link "ground": "ground" is the inertial frame; the link becomes the body "ground_link"',
    ),
    "rotor": (
        link("a") + "\n<transmission name='t'><joint name='j'/><actuator name='m'><mechanicalReduction>100"
        "</mechanicalReduction><motorInertia>2e-5</motorInertia></actuator></transmission>",
        'r.urdf:3: transmission "t": <mechanicalReduction> 100, <motorInertia> 2e-5: '
        "ignored, though this may affect the motion",
    ),
    "loop_of_a_tool": (
        link("a") + "\n<loop_joint name='l' type='continuous'/>",
        "r.urdf:3: robot: <loop_joint> is not known and ignored, though this may affect the motion",
    ),
    "constraint_with_a_prefix": (
        link("a") + "\n<d:ball_constraint xmlns:d='urn:d'><d:ball_constraint_body_A name='a'/>"
        "</d:ball_constraint>",
        "r.urdf:3: robot: <d:ball_constraint>: ignored, though this may affect the motion",
    ),
    "rotor_with_a_prefix": (
        link("a") + link("b") + "\n"
        + joint("j", "a", "b", inner="<d:rotor_inertia xmlns:d='urn:d' value='1'/>"),
        'r.urdf:3: joint "j": <d:rotor_inertia>: ignored, though this may affect the motion',
    ),
    "spring_in_gazebo": (
        link("a") + "\n<gazebo reference='j'><springStiffness>3</springStiffness><kp>1</kp></gazebo>",
        'r.urdf:3: gazebo "j": <springStiffness> 3: ignored, though this may affect the motion',
    ),
    "loop_in_gazebo": (
        link("a") + "\n<gazebo><joint name='l' type='revolute'><parent>a</parent></joint></gazebo>",
        "r.urdf:3: robot: <joint> in <gazebo>: ignored, though this may affect the motion",
    ),
    "weightless_in_gazebo": (
        link("a") + "\n<gazebo reference='a'><turnGravityOff>true</turnGravityOff></gazebo>",
        'r.urdf:3: gazebo "a": <turnGravityOff> true: ignored, though this may affect the motion',
    ),
    "prefixes": (
        link("a") + "<drake:x/>\n<foo:y/>",
        "r.urdf:2: XML: undeclared namespace prefixes (drake, foo); what has them is ignored",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", WARNINGS)
def test_warnings(case: str) -> None:
    text, expected = WARNINGS[case]
    assert parse(robot(text), "r.urdf").warnings == [expected]


@pytest.mark.parametrize(
    "tensor",
    [
        "0 0 0 0 0 0",
        "1 0 0 1 0 2",
        "1 0 0 1 0 2.0000001",
        "1e-30 0 0 1e-30 0 1e-30",
        "1 0.3 0 1 0 1",
    ],
)
def test_possible_inertias_cause_no_warning(tensor: str) -> None:
    assert parse(robot(link("a", inertial(tensor=tensor))), "r.urdf").warnings == []


def test_warnings_come_in_the_order_of_the_file() -> None:
    text = robot(joint("j", "a", "b", inner=axis("0 0 2")), link("a", "<inertal/>"), "<foo/>",
                 link("b", inertial(tensor="1 0 0 1 0 5")))  # fmt: skip
    lines = [int(warning.split(":")[1]) for warning in parse(text, "r.urdf").warnings]
    assert lines == [2, 3, 4, 5]


def test_well_known_extensions_are_passed_over_in_silence() -> None:
    text = robot(
        '<material name="red"/><gazebo><a><b/></a></gazebo><transmission/><ros2_control/><sensor/>',
        link("a", "<visual><origin xyz='bad'/></visual><collision/><!-- <inertal/> -->"),
        link("b"),
        joint("j", "a", "b", "fixed", "<safety_controller/><calibration/>"),
        '<d:x xmlns:d="urn:d" d:y="1"/>',
    )
    assert parse(text, "r.urdf").warnings == []


@pytest.mark.parametrize(
    "text",
    [
        "<transmission name='t'><actuator name='m'><mechanicalReduction>100</mechanicalReduction>"
        "<motorInertia>0.0</motorInertia></actuator></transmission>",
        "<transmission name='t'><joint name='j'><hardwareInterface>x</hardwareInterface></joint>"
        "</transmission>",
        "<gazebo reference='a'><mu1>0.2</mu1><turnGravityOff>false</turnGravityOff>"
        "<sensor><mass/></sensor></gazebo>",
        "<gazebo><plugin name='p'><leftJoint>j</leftJoint><joint>k</joint></plugin></gazebo>",
        "<ros2_control name='r' type='system'><joint name='j'><command_interface/></joint></ros2_control>",
        "<d:proximity_properties xmlns:d='urn:d'/>",
    ],
)
def test_what_does_not_affect_the_motion_is_passed_over_in_silence(text: str) -> None:
    model = parse(robot(link("a"), link("b"), joint("j", "a", "b"), text), "r.urdf")
    assert model.warnings == []


def test_equal_warnings_are_gathered() -> None:
    """Of a chain of twelve joints with damping and gains, and links that no body can be."""
    links = [link(f"l{k}", inertial(tensor=f"1 0 0 1 0 {3 + k}")) for k in range(13)]
    inner = '<dynamics damping="1"/><controller_gains kp="1"/>'
    joints = [joint(f"j{k}", f"l{k}", f"l{k + 1}", inner=inner) for k in range(12)]
    listed = '12 joints ("j0", "j1", "j2" and 9 more)'
    assert parse(robot(*links, *joints), "r.urdf").warnings == [
        'r.urdf:2: 13 links ("l0", "l1", "l2" and 10 more): no body has this inertia: '
        "a principal moment is negative or exceeds the sum of the others",
        f"r.urdf:15: {listed}: <controller_gains> is not known and ignored",
        f"r.urdf:15: {listed}: damping and friction are ignored",
    ]


def test_few_warnings_of_a_sort_keep_their_numbers() -> None:
    links = [link(name, inertial(tensor=f"1 0 0 1 0 {k}")) for k, name in enumerate("abc", 3)]
    found = parse(robot(*links, joint("j", "a", "b"), joint("k", "b", "c")), "r.urdf").warnings
    assert [re.findall(r"1, 1, (\d) kg", text) for text in found] == [["3"], ["4"], ["5"]]


def test_a_root_that_an_extension_carries_is_told_with_it() -> None:
    text = '<d:joint xmlns:d="urn:d" name="j" type="universal"/>'
    with pytest.raises(SourceError, match=r"2 roots; .* not read: <d:joint> \(line 4\)$"):
        parse(robot(link("a"), link("b"), text), "r.urdf")


RENAMED = {
    "time": (
        "t",
        'joint "t": "t" has a meaning of its own in expressions; it becomes the joint "t_joint"',
    ),
    "rate": (
        "j_dot",
        'joint "j_dot": its coordinate "j_dot" has the name of a rate of joint "j"; it becomes the joint '
        '"j_dot_joint"',
    ),
    "root": (
        "root_x",
        'joint "root_x": its coordinate "root_x" has the name of a coordinate of joint "root"; it becomes '
        'the joint "root_x_joint"',
    ),
}


@pytest.mark.parametrize("case", RENAMED)
def test_a_joint_whose_name_meets_another_gives_way(case: str) -> None:
    name, warning = RENAMED[case]
    text = robot(*(link(x, inertial()) for x in "abcd"), joint("j", "a", "b"), joint(name, "b", "c"),
                 joint("k", "c", "d", inner=mimic(name, "2")))  # fmt: skip
    model = parse(text, "r.urdf", base="floating")
    assert model.warnings == [f"r.urdf:7: {warning}"]
    assert coordinates(model)[0][-2:] == ["j", f"{name}_joint"]
    assert [(c.joint, c.master) for c in model.couplings] == [("k", f"{name}_joint")]
    derive(model)


def test_a_robot_without_name_takes_the_files() -> None:
    model = parse(b'<robot><link name="a"/></robot>', "folder/crane.urdf")
    assert model.name == "crane"
    assert model.warnings == ['folder/crane.urdf:1: robot: has no name; taken as "crane"']


def test_a_link_called_ground_gives_way() -> None:
    text = robot(
        link("ground"), link("ground_link", inertial()), joint("j", "ground", "ground_link")
    )
    model = parse(text, "r.urdf")
    assert list(model.bodies) == ["ground_link_", "ground_link"]
    derive(model)


@pytest.mark.parametrize(
    "name",
    [
        "a b",
        "a'b",
        "a&quot;b",
        "*/",
        "//",
        "{{x}}",
        "Ω",
        "а",
        "x" * 300,
        "-",
        "1",
        "int",
        "%s",
        "\\",
    ],
)
def test_odd_names_pass(name: str) -> None:
    text = robot(link(name), link(name + "2", inertial()), joint(name, name, name + "2"))
    model = parse(text, "r.urdf", symbolic=True)
    derive(model)
    assert len(model.joints) == 2


@pytest.mark.parametrize("weld", ["ground/base", "ground/base'"])
def test_the_weld_to_ground_gets_out_of_the_way(weld: str) -> None:
    text = robot(link("a"), link("b", inertial()), joint(weld, "a", "b"))
    assert coordinates(parse(text, "r.urdf"))[0] == [weld]


@pytest.mark.parametrize(
    "text",
    [
        b"\xef\xbb\xbf" + ARM,
        b'<?xml version="1.0" encoding="utf-8"?>\n<!-- a < b -->\n<?pi x?>\n' + ARM,
        b'<?xml version="1.0" encoding="ISO-8859-1"?>'
        + ARM.replace(b"arm", "arm\u00e9".encode("latin-1")),
        ARM.replace(b"\n", b"\r\n"),
        ARM.replace(
            b'<robot name="r">', b'<robot name="r" xmlns="http://www.ros.org" version="1.0">'
        ),
        ARM.replace(b'"0 1 0"', b'" 0\t+1.0E+00\n -.0 "'),
    ],
)
def test_harmless_variations(text: bytes) -> None:
    model = parse(text, "r.urdf")
    assert model.warnings == []
    assert_same(model, parse(ARM, "r.urdf"))


def test_lines_count_on_after_65535() -> None:
    text = robot("\n" * 70000 + link("a", "\n<inertal/>"))
    assert parse(text, "r.urdf").warnings[0].startswith("r.urdf:7000")


def test_a_long_chain_does_not_exhaust_the_stack() -> None:
    n = 3000
    links = [link(f"l{i}", inertial()) for i in range(n)]
    joints = [joint(f"j{i}", f"l{i}", f"l{i + 1}", "fixed") for i in range(n - 1)]
    assert len(parse(robot(*links, *joints), "r.urdf").bodies) == n


def test_importing_and_reading_loads_nothing_heavy(tmp_path: Path) -> None:
    path = tmp_path / "zoo.urdf"
    path.write_bytes(ZOO)
    script = (
        "import sys, linegraph; assert 'lxml' not in sys.modules\n"
        f"from linegraph.readers.urdf import read; read({str(path)!r}); read({str(path)!r}, symbolic=True)\n"
        "print([m for m in ('numpy', 'sympy', 'networkx', 'pydantic', 'jinja2') if m in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"

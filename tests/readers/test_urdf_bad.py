"""URDFs in error: each gets one message that names the file, the line, the thing and what is wrong."""

from __future__ import annotations

import os
import socket
from typing import TYPE_CHECKING, NamedTuple

import pytest
from support.urdf_text import axis, inertial, joint, link, mimic, origin, robot

from linegraph.errors import SourceError
from linegraph.readers.urdf import parse, read

if TYPE_CHECKING:
    from pathlib import Path


class Bad(NamedTuple):
    """A text, the line to blame and what the message must say."""

    text: bytes
    line: int | None
    says: tuple[str, ...]


A, B, C = link("a"), link("b"), link("c")
AB = link("a") + link("b", inertial()) + link("c", inertial())
"""Line 2 of most cases; their joint is line 3."""


def at_2(line_2: str, *says: str) -> Bad:
    return Bad(robot(line_2), 2, says)


def at_3(line_3: str, *says: str) -> Bad:
    return Bad(robot(AB, line_3, joint("last", "a", "c", "fixed")), 3, says)


def hinge(inner: str, *says: str, kind: str = "revolute") -> Bad:
    return at_3(joint("j", "a", "b", kind, inner), 'joint "j"', *says)


def number(text: str, *says: str) -> Bad:
    return at_2(
        link("a", f'<inertial><mass value="{text}"/></inertial>'), 'link "a"', "<mass> value", *says
    )


def xml(text: bytes | str, line: int | None, *says: str) -> Bad:
    return Bad(text if isinstance(text, bytes) else text.encode(), line, says)


XML = {
    "empty": xml("", None, "is empty"),
    "blank": xml(" \n\t\n", None, "is empty"),
    "only_a_byte_order_mark": xml(b"\xef\xbb\xbf", None, "is empty"),
    "truncated_in_a_tag": xml('<robot name="r">\n<link name="a', 2, "XML"),
    "truncated_after_a_tag": xml('<robot name="r">\n<link name="a"/>\n', 3, "Premature end"),
    "wrong_end": xml('<robot name="r">\n<link name="a">\n</robot>', 3, "mismatch", "link"),
    "two_roots_elements": xml('<robot name="r"/>\n<robot name="s"/>', 2, "Extra content"),
    "text_after": xml('<robot name="r"/>\nhello', 2, "Extra content"),
    "attribute_twice": xml('<robot name="r">\n<link name="a" name="b"/></robot>', 2, "redefined"),
    "unquoted": xml("<robot name=r/>", 1, "AttValue"),
    "less_than_in_a_name": xml('<robot name="r">\n<link name="a<b"/></robot>', 2, "'<'"),
    "ampersand": xml('<robot name="r">\n<link name="a&b"/></robot>', 2, "EntityRef"),
    "entity_of_nothing": xml('<robot name="r">\n<link name="&x;"/></robot>', 2, "'x' not defined"),
    "nul_reference": xml('<robot name="r">\n<link name="&#0;"/></robot>', 2, "xmlChar value 0"),
    "nul": xml(b'<robot name="r">\n<link name="a\x00"/></robot>', 2, "NUL", "UTF-8"),
    "control_character": xml(b'<robot name="r">\n<link name="a\x07"/></robot>', 2, "XML"),
    "image": xml(b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", 3, "NUL"),
    "gzip": xml(b"\x1f\x8b\x08\x08", 1, "0x8b is not UTF-8"),
    "latin_1_undeclared": xml(
        b'<robot name="r">\n<link name="\xe9"/></robot>', 2, "0xe9 is not UTF-8"
    ),
    "utf_16": xml('<robot name="r"/>'.encode("utf-16"), 1, "UTF-16", "save the file as UTF-8"),
    "utf_16_without_mark": xml('<robot name="r"/>'.encode("utf-16-le"), 1, "UTF-16"),
    "utf_32": xml('<robot name="r"/>'.encode("utf-32"), 1, "UTF-32"),
    "declares_utf_16": xml(
        '<?xml version="1.0" encoding="UTF-16"?><robot name="r"/>', 1, '"utf-16"'
    ),
    "declares_utf_7": xml("<?xml version='1.0' encoding = 'UTF-7'?><robot/>", 1, '"utf-7"'),
    "declares_nonsense": xml('<?xml version="1.0" encoding="no"?><robot/>', 1, '"no"'),
    "doctype": xml(
        '<?xml version="1.0"?>\n<!DOCTYPE robot>\n<robot name="r"/>', 2, "DOCTYPE", "delete it"
    ),
    "doctype_after_comments": xml("<!-- <a> -->\n<?p ?>\n<!DOCTYPE robot>\n<robot/>", 3, "DOCTYPE"),
    "doctype_inside": xml('<robot name="r">\n<!DOCTYPE robot></robot>', 2, "XML"),
    "html": xml("<!DOCTYPE html>\n<html><body></body></html>", 1, "HTML page"),
    "html_without_doctype": xml("\n<html><body><br></body></html>", 2, "HTML page"),
    "json": xml('{"name": "r"}', 1, "is not XML", '{"name"'),
    "toml": xml('name = "r"\n[body.a]\n', 1, "is not XML"),
    "undeclared_prefix_and_more": xml('<robot name="r">\n<d:a/>\n<link></robot>', 3, "mismatch"),
    "many_prefixes_and_truncated": xml(
        '<robot name="r">\n' + "<d:a/>" * 500 + "\n<link>", 3, "Premature"
    ),
    "too_many_prefixes": xml(
        '<robot name="r">\n' + "".join(f"<p{i}:a/>" for i in range(30)) + "</robot>", 2, "prefix p0"
    ),
    "foreign_prefix": xml('<robot name="r">\n<é:a/></robot>', 2, "prefix é"),
    "nested": xml(
        '<robot name="r">\n' + "<a>" * 70 + "</a>" * 70 + "</robot>", 2, "more than 64 deep"
    ),
    "attributes": xml(
        "<robot " + " ".join(f'a{i}=""' for i in range(101)) + "/>", 1, "more than 100 attributes"
    ),
    "markup": xml("<robot>" + "<a/>" * 200_000 + "</robot>", None, "more than 200000 tags"),
    "sdf": xml('<sdf version="1.6"><model name="r"/></sdf>', 1, "SDF", "<robot>"),
    "mjcf": xml("\n<mujoco/>", 2, "MJCF", "<robot>"),
    "collada": xml("<COLLADA/>", 1, "COLLADA"),
    "ros_launch": xml("<launch/>", 1, "launch file"),
    "something": xml("<machine/>", 1, "no URDF", "<machine>", "<robot>"),
    "prefixed_root": xml('<x:robot xmlns:x="urn:x" name="r"/>', 1, "<x:robot>"),
}

XACRO = {
    "include": xml(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n<xacro:include filename="b"/></robot>',
        2, "<xacro:include>", "run xacro first",
    ),
    "other_prefix": xml(
        '<robot name="r" xmlns:x="http://ros.org/wiki/xacro"><link name="a">\n<x:if/></link></robot>',
        2, "<xacro:if>", "run xacro first",
    ),
    "undeclared": xml('<robot name="r">\n<xacro:macro/></robot>', 2, "<xacro:macro>", "run xacro first"),
    "number": number("${m}", "${m}", "run xacro first"),
    "argument": at_2(link("$(arg p)a"), "$(arg p)a", "run xacro first"),
    "in_three_numbers": hinge(origin("0 ${h/2} 0"), "0 ${h/2} 0", "run xacro first"),
    "parent": at_3(joint("j", "${p}a", "b"), 'joint "j"', "${p}a", "run xacro first"),
}  # fmt: skip

NUMBERS = {
    "underscore": number("1_0", '"1_0" is not a finite decimal number'),
    "comma": number("1,5", '"1,5" is not'),
    "hex": number("0x10", '"0x10" is not'),
    "nan": number("nan", '"nan" is not'),
    "inf": number("-inf", '"-inf" is not'),
    "overflow": number("1e999", "beyond any quantity", "1e999"),
    "huge": number("1e51", "beyond any quantity"),
    "word": number("two", '"two" is not'),
    "unit": number("2kg", '"2kg" is not'),
    "two_dots": number("1.2.3", '"1.2.3" is not'),
    "other_digits": number("١", '"١" is not'),
    "full_width": number("１", "is not"),
    "no_break_space": number("1\u00a0", "is not"),
    "minus_sign": number("−1", '"−1" is not'),
    "float_suffix": number("1.0f", '"1.0f" is not'),
    "exponent_only": number("1e", '"1e" is not'),
    "two_for_one": number("1 2", "one number needed, got 2"),
    "none_for_one": number("", "one number needed, got 0"),
    "blank": number(" ", "one number needed, got 0"),
    "long": number("9" * 5000 + "x", '9999...": "9999'),
    "trailing_comma": hinge(origin(rpy="0 1.5707963, 0"), "<origin> rpy", '"1.5707963," is not'),
    "two_for_three": hinge(origin("1 2"), "<origin> xyz", '"1 2"', "3 numbers needed, got 2"),
    "four_for_three": hinge(axis("0 0 1 0"), "<axis> xyz", "3 numbers needed, got 4"),
    "damping": hinge('<dynamics damping="a"/>', "<dynamics> damping", '"a" is not'),
    "multiplier": at_3(
        joint("j", "a", "b", inner=mimic("last", "x")), "<mimic> multiplier", '"x" is not'
    ),
    "offset": at_3(
        joint("j", "a", "b", inner=mimic("last", "1", "1;")), "<mimic> offset", '"1;" is not'
    ),
}

LINKS = {
    "no_name": at_2("<link/>", "<link>", 'no attribute "name"'),
    "misspelt_name": at_2('<link nam="a"/>', 'no attribute "name", only "nam"'),
    "empty_name": at_2(link(""), 'link ""', "the name is blank"),
    "blank_name": at_2(link("  "), "the name is blank"),
    "line_break_in_a_name": at_2(link("a&#10;b"), r'link "a\x0ab"', "U+000A"),
    "escape_in_a_name": at_2(link("a&#x9b;b"), "U+009B", "cannot be printed"),
    "right_to_left_override": at_2(link("a&#x202e;b"), "U+202E", "cannot be printed"),
    "negative_mass": at_2(link("a", inertial("-1")), 'link "a"', "the mass is negative (-1)"),
    "no_mass": at_2(link("a", "<inertial/>"), 'link "a"', "<inertial> has no <mass>"),
    "misspelt_mass": at_2(
        link("a", '<inertial><mas value="1"/></inertial>'), "has no <mass>", 'did you mean "mas"?'
    ),
    "no_value": at_2(link("a", "<inertial><mass>2</mass></inertial>"), '<mass> has no attribute "value"'),
    "misspelt_value": at_2(link("a", '<inertial><mass vlaue="1"/></inertial>'), 'only "vlaue"'),
    "two_masses": at_2(
        link("a", '<inertial><mass value="1"/><mass value="1"/></inertial>'), "has two <mass>", "line 2"
    ),
    "two_inertias": at_2(
        link("a", '<inertial><mass value="1"/><inertia/><inertia/></inertial>'), "has two <inertia>"
    ),
    "two_origins": at_2(
        link("a", '<inertial><mass value="1"/><origin/><origin/></inertial>'), "has two <origin>"
    ),
    "missing_entry": at_2(
        link("a", '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'),
        '<inertia> has no attribute "ixy"',
    ),
    "quaternion": at_2(
        link("a", '<inertial><origin quat_xyzw="0 0 0 1"/><mass value="1"/></inertial>'),
        "quat_xyzw is not read", "rpy",
    ),
    "two_inertials": Bad(
        robot("<link name='a'>", inertial(), inertial(), "</link>"),
        4, ('link "a"', "two <inertial>", "line 3"),
    ),
    "same_name": Bad(robot(A, B, A), 4, ('link "a"', "taken by the link on line 2")),
    "none": Bad(robot("<joint_/>"), 1, ("robot: has no links",)),
    "unprintable_robot": Bad(b'<robot name="a&#9;b"><link name="a"/></robot>', 1, ("U+0009",)),
}  # fmt: skip

JOINTS = {
    "no_name": at_3('<joint type="fixed"/>', "<joint>", 'no attribute "name", only "type"'),
    "blank_name": at_3(joint(" ", "a", "b"), "the name is blank"),
    "no_type": at_3('<joint name="j"><parent link="a"/></joint>', 'joint "j"', 'no attribute "type"'),
    "unknown_type": hinge("", 'type="spherical"', "revolute, continuous, prismatic", kind="spherical"),
    "misspelt_type": hinge("", 'type="revolut"', 'did you mean "revolute"?', kind="revolut"),
    "capital_type": hinge("", 'type="Fixed"', 'did you mean "fixed"?', kind="Fixed"),
    "no_parent": at_3('<joint name="j" type="fixed"><child link="b"/></joint>', 'joint "j"', "no <parent>"),
    "no_child": at_3('<joint name="j" type="fixed"><parent link="a"/></joint>', 'joint "j"', "no <child>"),
    "misspelt_child": at_3(
        '<joint name="j" type="fixed"><parent link="a"/><chidl link="b"/></joint>',
        "no <child>", 'did you mean "chidl"?',
    ),
    "no_link": at_3(
        '<joint name="j" type="fixed"><parent lnk="a"/><child link="b"/></joint>',
        '<parent> has no attribute "link"',
    ),
    "two_parents": hinge('<parent link="c"/>', "has two <parent>", "line 3"),
    "two_axes": hinge(axis("0 0 1") * 2, "has two <axis>"),
    "two_origins": hinge(origin() * 2, "has two <origin>"),
    "two_mimics": hinge(mimic("last") * 2, "has two <mimic>"),
    "zero_axis": hinge(axis("0 0 0"), "has no direction"),
    "zero_axis_of_a_slider": hinge(axis("0 -0.0 0e9"), "has no direction", kind="prismatic"),
    "axis_without_xyz": hinge("<axis/>", '<axis> has no attribute "xyz"'),
    "unknown_parent": at_3(joint("j", "aa", "b"), 'joint "j"', 'no parent link "aa"', 'did you mean "a"?'),
    "unknown_child": at_3(joint("j", "a", "zebra"), 'joint "j"', 'no child link "zebra"'),
    "to_itself": at_3(joint("j", "b", "b"), 'joint "j"', 'connects link "b" to itself'),
    "same_name": Bad(
        robot(AB, joint("j", "a", "b"), joint("j", "a", "c")), 4, ('joint "j"', "the joint on line 3")
    ),
    "a_name_for_a_mass_centre": at_3(joint("mass_center", "a", "b"), 'joint "mass_center"', "also arises"),
    "a_name_of_an_inner_edge": at_3(joint("b/inertia", "a", "b"), 'joint "b/inertia"', "edge inside a link"),
    "a_name_of_an_arm": at_3(joint("a/arm.last", "a", "b"), 'joint "a/arm.last"', "edge inside a link"),
}  # fmt: skip

MIMICS = {
    "unknown": hinge(mimic("lst"), '<mimic> follows "lst"', "no such joint", 'did you mean "last"?'),
    "itself": hinge(mimic("j"), "<mimic> follows itself"),
    "no_master": hinge("<mimic/>", '<mimic> has no attribute "joint"'),
    "on_a_planar_joint": hinge(mimic("last"), "one freedom", "planar", kind="planar"),
    "on_a_floating_joint": hinge(mimic("last"), "one freedom", "free", kind="floating"),
    "circle": Bad(
        robot(AB, joint("j", "a", "b", inner=mimic("k")), joint("k", "b", "c", inner=mimic("j"))),
        3, ('joint "j"', "follows itself through a circle"),
    ),
    "several_freedoms": Bad(
        robot(AB, joint("j", "a", "b", "floating"), joint("k", "b", "c", inner=mimic("j"))),
        4, ('joint "k"', '"j", which is free', "several freedoms"),
    ),
}  # fmt: skip

TREES = {
    "two_roots": Bad(
        robot(A, B, C, joint("j", "a", "b")),
        4, ('link "c"', '"a" (line 2), "c" (line 4)', "2 roots", "one tree"),
    ),
    "many_roots": Bad(robot(*(link(f"l{i}") for i in range(20))), 3, ("20 roots", "and 12 more")),
    "two_parents": Bad(
        robot(A, B, C, joint("j", "a", "c"), joint("k", "b", "c")),
        6, ('joint "k"', 'link "c" is already the child of joint "j" (line 5)'),
    ),
    "circle_of_all": Bad(
        robot(A, B, joint("j", "a", "b"), joint("k", "b", "a")), 4, ('"k" (line 5)', '"j" (line 4)', "circle")
    ),
    "circle_beside_the_tree": Bad(
        robot(A, B, C, link("d"), joint("w", "c", "d"), joint("j", "b", "c"), joint("k", "c", "b")),
        7, ('joint "j"', "circle", '"k" (line 8)'),
    ),
    "dots": Bad(
        robot(A, link("a.j"), C, joint("j", "a", "a.j"), joint("k", "a", "c")),
        5, ('joint "j"', 'the name "a.j" also arises from link "a.j" on line 3', "rename one"),
    ),
    "dots_in_two_joints": Bad(
        robot(A, link("a.b"), C, link("d"), joint("b.j", "a", "c"), joint("j", "a.b", "d"),
              joint("k", "a", "a.b")),
        7, ('joint "j"', '"a.b.j" also arises from joint "b.j" on line 6'),
    ),
    "dots_and_mass_centre": Bad(
        robot(A, link("a.mass_center"), joint("k", "a", "a.mass_center")), 3, ("also arises", 'link "a"')
    ),
}  # fmt: skip

GROUPS = {
    "xml": XML,
    "xacro": XACRO,
    "numbers": NUMBERS,
    "links": LINKS,
    "joints": JOINTS,
    "mimics": MIMICS,
    "trees": TREES,
}
CASES = {f"{group}-{name}": bad for group, cases in GROUPS.items() for name, bad in cases.items()}


@pytest.mark.parametrize("case", CASES)
def test_refused_with_place_and_reason(case: str) -> None:
    bad = CASES[case]
    with pytest.raises(SourceError) as caught:
        parse(bad.text, "some/robot.urdf")
    message = str(caught.value)
    place = "some/robot.urdf: " if bad.line is None else f"some/robot.urdf:{bad.line}: "
    assert message.startswith(place)
    for part in bad.says:
        assert part in message
    assert message.isprintable()
    assert len(message) < 800
    assert caught.value.line == bad.line


def test_there_are_many_cases() -> None:
    assert len(CASES) >= 120


def test_a_joint_called_root_clashes_with_a_floating_base() -> None:
    text = robot(A, link("b", inertial()), joint("root", "a", "b"))
    assert [j.name for j in parse(text, "r.urdf").joints if j.freedoms] == ["root"]
    with pytest.raises(SourceError, match=r'^r.urdf:4: joint "root": .*floating.*rename'):
        parse(text, "r.urdf", base="floating")


def test_long_names_are_shortened_in_messages() -> None:
    with pytest.raises(SourceError) as caught:
        parse(robot(link("x" * 100_000), link("x" * 100_000)), "r.urdf")
    assert len(str(caught.value)) < 300


# ---------------------------------------------------------------- files


def refusal(path: str | os.PathLike[str]) -> str:
    with pytest.raises(SourceError) as caught:
        read(path)
    assert caught.value.line is None
    return str(caught.value)


def test_no_such_file(tmp_path: Path) -> None:
    assert "cannot be read: No such file" in refusal(tmp_path / "none.urdf")


def test_no_name_at_all() -> None:
    assert "cannot be read" in refusal("")


def test_a_directory(tmp_path: Path) -> None:
    assert "is a directory" in refusal(tmp_path)


def test_a_path_through_a_file(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert "cannot be read" in refusal(tmp_path / "file" / "r.urdf")


def test_a_nul_in_the_path() -> None:
    assert "cannot be read" in refusal("r\x00.urdf")


def test_a_link_to_itself(tmp_path: Path) -> None:
    (tmp_path / "r.urdf").symlink_to(tmp_path / "r.urdf")
    assert "cannot be read" in refusal(tmp_path / "r.urdf")


@pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read all files"
)
def test_an_unreadable_file(tmp_path: Path) -> None:
    path = tmp_path / "r.urdf"
    path.write_bytes(robot(A))
    path.chmod(0)
    assert "Permission denied" in refusal(path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no FIFOs here")
def test_a_fifo_is_refused_and_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "r.urdf")
    assert "is not a regular file" in refusal(tmp_path / "r.urdf")


@pytest.mark.skipif(not hasattr(socket, "AF_UNIX"), reason="no sockets in the file system here")
def test_a_socket_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # the path of a socket must be short
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind("s")
        assert "is not a regular file" in refusal("s")


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="no devices here")
@pytest.mark.parametrize("device", ["/dev/zero", "/dev/null"])
def test_a_device_is_refused(device: str) -> None:
    assert "is not a regular file" in refusal(device)


def test_a_file_of_20_megabytes_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "r.urdf"
    path.write_bytes(robot(A) + b" " * 20_000_000)
    assert "over 16 MiB" in refusal(path)


def test_a_xacro_file_is_refused_by_its_name(tmp_path: Path) -> None:
    path = tmp_path / "r.urdf.xacro"
    path.write_bytes(robot(A))
    assert "run xacro first" in refusal(path)


def test_an_odd_file_name_cannot_break_the_message(tmp_path: Path) -> None:
    path = tmp_path / "a\nb\x1b[31m.urdf"
    path.write_bytes(b"<robot>")
    with pytest.raises(SourceError) as caught:
        read(path)
    assert str(caught.value).isprintable()

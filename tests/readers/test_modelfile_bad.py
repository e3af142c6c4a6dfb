"""Broken model files: every error at once, each with its file, its line, the key and what is wrong."""

from __future__ import annotations

import os
import socket
from typing import TYPE_CHECKING, NamedTuple

import pytest
from support.modelfile_text import SMALL

from linegraph.errors import SourceError, SourceErrors
from linegraph.readers.modelfile import parse, read
from linegraph.readers.modelfile.kinds import LONGEST_LABEL

if TYPE_CHECKING:
    from pathlib import Path

TAIL = len(SMALL.splitlines()) + 1
"""The line of what `after` appends."""


class Bad(NamedTuple):
    """A text, the lines to blame, and what the messages must say."""

    text: bytes
    lines: tuple[int | None, ...]
    says: tuple[str, ...]


def whole(text: str | bytes, line: int | None, *says: str) -> Bad:
    return Bad(text if isinstance(text, bytes) else text.encode(), (line,), says)


def after(text: str, line: int | tuple[int, ...], *says: str) -> Bad:
    """A sound model and what is appended; lines are counted from 1 in the latter."""
    lines = line if isinstance(line, tuple) else (line,)
    return Bad((SMALL + text).encode(), tuple(TAIL - 1 + n for n in lines), says)


def instead(old: str, new: str, *says: str, line: int | None = None) -> Bad:
    """A sound model with one line another."""
    assert SMALL.count(old) == 1, old
    at = SMALL[: SMALL.index(old)].count("\n") + 1
    return Bad(SMALL.replace(old, new).encode(), (line or at,), says)


def mass(value: str, *says: str) -> Bad:
    return instead('mass = "m"', f"mass = {value}", "[body.arm] mass", *says)


def law(expression: str, *says: str) -> Bad:
    text = f'[law.push]\njoint = "hinge"\nforce = "{expression}"\n'
    return after(text, 3, "[law.push] force", *says)


def motion(value: str, *says: str) -> Bad:
    return after(f"motion = {value}\n", 1, "[revolute.hinge] motion", *says)


TEXT = {
    "empty": whole("", None, "is empty", "linegraph new"),
    "blank": whole(" \n\t\n", None, "is empty"),
    "only_a_byte_order_mark": whole(b"\xef\xbb\xbf", None, "is empty"),
    "utf_16": whole(SMALL.encode("utf-16"), 1, "UTF-16", "save the file as UTF-8"),
    "utf_16_without_mark": whole(SMALL.encode("utf-16-le"), 1, "NUL", "UTF-16"),
    "utf_32": whole(SMALL.encode("utf-32"), 1, "UTF-32"),
    "latin_1": whole(b'name = "a"\ndescription = "\xe9"\n', 2, "0xe9 is not UTF-8"),
    "nul": whole(b'name = "a"\n\nx = "\x00"\n', 3, "NUL"),
    "image": whole(b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR", 3, "NUL"),
    "gzip": whole(b"\x1f\x8b\x08\x08", 1, "0x8b is not UTF-8"),
    "control_character": whole('name = "a\x07"\n', 1, "TOML", "column 10"),
    "lone_return": whole('name = "a"\rmass = 1\n', 1, "TOML"),
    "prose": whole("Dear reader,\nhere is my crane.\n", 1, "TOML", "column"),
    "xml": whole('<?xml version="1.0"?>\n<robot/>', 1, "looks like XML", ".urdf"),
    "yaml": whole("body:\n  mass: 1\n", 1, "TOML"),
    "python": whole("import os\n", 1, "TOML"),
    "too_large": whole(b"#" * (8 * 2**20 + 1), None, "over 8 MiB"),
}

SYNTAX = {
    "unclosed_header": instead("[revolute.hinge]", "[revolute.hinge", "TOML"),
    "empty_header": instead("[revolute.hinge]", "[]", "TOML"),
    "unclosed_text": instead('mass = "m"', 'mass = "m', "TOML"),
    "unclosed_list": after("a = [1, 2\n", 1, "TOML", "Unclosed array"),
    "unclosed_table": instead('unit = "N" }', 'unit = "N"', "TOML"),
    "no_value": instead('mass = "m"', "mass =", "TOML"),
    "no_key": instead('mass = "m"', '= "m"', "TOML"),
    "no_equals_sign": instead('mass = "m"', 'mass "m"', "TOML"),
    "bare_expression": instead('mass = "m"', "mass = m*2", "TOML", "column 8", "stand in quotes"),
    "bare_expression_in_a_list": instead("axis = [0, 1, 0]", "axis = [a, 1, 0]", "in quotes"),
    "unit_beside_a_number": instead("m = 1.5", "m = 1.5 kg", "TOML", "units in quotes"),
    "decimal_comma": instead("m = 1.5", "m = 1,5", "TOML", "1.5"),
    "no_digit_before_the_point": instead("m = 1.5", "m = .5", "TOML"),
    "no_digit_after_the_point": instead("m = 1.5", "m = 1.", "TOML"),
    "leading_zero": instead("m = 1.5", "m = 01.5", "TOML"),
    "octal": instead("m = 1.5", "m = 017", "TOML"),
    "typographic_quotes": instead('mass = "m"', "mass = “m”", "TOML"),
    "two_pairs_in_a_line": instead("m = 1.5", "m = 1.5 n = 2", "TOML"),
    "table_over_several_lines": instead('{ unit = "N" }', '{\n unit = "N" }', "TOML"),
    "bad_escape": instead('mass = "m"', 'mass = "\\m"', "TOML"),
    "key_twice": instead(
        'mass = "m"',
        'mass = "m"\nmass = 2',
        "[body.arm] mass",
        "given twice, first in line 9",
        line=10,
    ),
    "key_twice_in_a_table": instead('unit = "N"', 'unit = "N", unit = "N"', "given twice"),
    "table_twice": after(
        "\n[body.arm]\nmass = 1\n", 2, "[body.arm]", "given twice, first in line 8"
    ),
    "parameter_twice": instead("m = 1.5", "m = 1.5\nm = 2", "[parameters] m", "twice", line=4),
    "key_and_table": instead("m = 1.5", "m = 1.5\nm.value = 2", "TOML", line=4),
    "nested": after("a = " + "[" * 30 + "]" * 30 + "\n", 1, "nested more than 16 deep"),
    "dotted": after("a" + ".b" * 30 + " = 1\n", 1, "nested more than 16 deep"),
    "long_text": mass('"' + "1+" * 15_000 + '1"', "more than 20000 characters")._replace(
        says=("more than 20000",)
    ),
    "long_number": mass("1" * 5000)._replace(says=("more than 400 characters",)),
}

JSON = {
    "not_json": whole('{"name": "a",\n "body": {,}}', 2, "JSON", "column 11"),
    "truncated": whole('{"name": "a",\n', 2, "JSON"),
    "single_quotes": whole("{'name': 'a'}", 1, "JSON", "double quotes"),
    "comment": whole('{"name": "a" // hello\n}', 1, "JSON"),
    "trailing_comma": whole('{"name": "a",\n}', 2, "JSON"),
    "more_after_it": whole('{"name": "a"}\n{}', 2, "JSON", "Extra data"),
    "nan": whole('{"body": {"a": {"mass": NaN}}}', None, "JSON", "NaN"),
    "key_twice": whole(
        '{"body": {"a": {"mass": 1,\n"mass": 2}}}',
        2,
        "[body.a] mass",
        "given twice, first in line 1",
    ),
    "escaped_key_twice": whole('{"name": "a",\n"\\u006eame": "b"}', 2, "name", "twice"),
    "nested": whole('{"a":' * 50 + "1" + "}" * 50, 1, "nested more than 16"),
    "misspelt": whole(
        '{"name": "a",\n"body": {\n"b": {\n"mas": 1}}}', 4, "[body.b] mas", 'mean "mass"'
    ),
    "null": whole('{"body": {"b": {\n"mass": null}}}', 2, "[body.b] mass", "not nothing"),
}

KEYS = {
    "top": whole("nam = 'a'\n", 1, '"nam" is not known', 'did you mean "name"'),
    "top_table": after("[bodies.b]\n", 1, "[bodies]", "not known", 'did you mean "body"'),
    "type": after('[revolut.b]\nbetween = ["ground", "arm"]\n', 1, "[revolut]", '"revolute"'),
    "joint_as_a_type": after("[joint.b]\n", 1, "[joint] is not known", "[revolute.NAME]"),
    "force_as_a_type": after("[force.b]\n", 1, "[force] is not known", "[load.NAME]"),
    "link_as_a_type": after("[link.b]\n", 1, "[link]", 'did you mean "body"'),
    "couple_as_a_type": after("[couple.b]\n", 1, "[couple]", "follows = {"),
    "type_of_element": after('[sprng.b]\njoint = "hinge"\n', 1, "[sprng]", '"spring"'),
    "in_a_body": instead('mass = "m"', 'mas = "m"', "[body.arm] mas", 'did you mean "mass"'),
    "in_a_joint": after('axes = "x"\n', 1, "[revolute.hinge] axes", 'did you mean "axis"'),
    "of_another_joint": after("lead = 0.1\n", 1, "[revolute.hinge] lead", "unknown key"),
    "in_an_element": after(
        '[spring.s]\njoint = "hinge"\nstiffnes = 1\nstiffness = 2\n', 3, '"stiffness"'
    ),
    "in_a_frame": instead(
        "{ at = ", "{ on = 1, at = ", "[body.arm] frame.tip.on", "known: at, rpy"
    ),
    "in_a_parameter": instead('unit = "m"', 'units = "m"', "[parameters] L.units", '"unit"'),
    "in_an_input": instead('unit = "N"', "value = 1", "[inputs] push.value", "unknown key"),
    "in_an_inertia": instead("[0.1, 0.1, 0.1]", "{ ixx = 1 }", "inertia.ixx", '"xx"'),
    "in_gravity": after(
        "[gravity]\naccel = [0, 0, -9.81]\nacceleration = [0, 0, 0]\n",
        2,
        "[gravity] accel",
        "known: acceleration",
    ),
    "in_a_load": after(
        '[load.l]\nat = "arm"\nforces = [0, 0, 1]\ntorque = [0, 0, 0]\n',
        3,
        "[load.l] forces",
        '"force"',
    ),
    "axis_of_a_ball": after(
        '[body.b]\n[spherical.s]\nbetween = ["arm", "b"]\naxis = [1, 0, 0]\n',
        4,
        "[spherical.s] axis",
    ),
    "empty_key": instead('mass = "m"', '"" = 1', "unknown name"),
    "units_of_its_own": after('[units]\nlength = "mm"\n', 1, "[units]", "not known"),
}

MISSING = {
    "between": instead(
        'between = ["ground", "arm"]\n', "", "[revolute.hinge]", "between is missing", line=12
    ),
    "axis": instead("axis = [0, 1, 0]\n", "", "[revolute.hinge]", "axis is missing", line=12),
    "value": instead("{ value = 0.2, ", "{ ", "[parameters] L", "value is missing"),
    "place_of_an_element": after(
        "[spring.s]\nstiffness = 1\n", 1, "[spring.s]", "between or joint is missing"
    ),
    "law_of_a_spring": after('[spring.s]\njoint = "hinge"\n', 1, "stiffness or force is missing"),
    "damping": after('[damper.s]\njoint = "hinge"\n', 1, "[damper.s]", "damping is missing"),
    "friction": after('[friction.s]\njoint = "hinge"\n', 1, "viscous or coulomb is missing"),
    "limits": after('[stop.s]\njoint = "hinge"\nstiffness = 1\n', 1, "lower or upper is missing"),
    "law": after('[law.s]\njoint = "hinge"\n', 1, "[law.s]", "force is missing"),
    "at": after("[load.l]\nforce = [1, 0, 0]\n", 1, "[load.l]", "at is missing"),
    "force": after('[load.l]\nat = "arm"\n', 1, "[load.l]", "force or torque is missing"),
    "lead": after(
        '[body.n]\n[helical.s]\nbetween = ["arm", "n"]\naxis = [0, 0, 1]\n',
        2,
        "[helical.s]",
        "lead",
    ),
    "rotor": after("[rotor.r]\nratio = 2\n", (1, 1), "joint is missing", "inertia is missing"),
    "acceleration": after("[gravity]\n", 1, "[gravity]", "acceleration is missing"),
    "leader": after("follows = { ratio = 2 }\n", 1, "follows", "joint is missing"),
}

TYPES = {
    "true": mass("true", "not true"),
    "list": mass("[1]", "not a list of 1"),
    "table": mass("{ value = 1 }", "not a table"),
    "date": mass("1979-05-27", "not a date"),
    "time": mass("07:32:00", "not a date or time"),
    "infinity": mass("inf", "not a finite number"),
    "nan": mass("nan", "not a finite number"),
    "overflow": mass("1e999", "not a finite number"),
    "large": mass("1e200", "too large"),
    "long_integer": mass("1" * 200, "too large"),
    "negative": mass("-1", "is negative (-1)"),
    "negative_expression": mass('"m - 2"', "is negative (m - 2 = -0.5)"),
    "name_is_a_number": whole("name = 3\n", 1, "name", "a name in quotes", "not 3"),
    "name_is_empty": whole('name = ""\n', 1, "name", "empty"),
    "name_with_a_line_end": whole('name = "a\\nb"\n', 1, "name", "do not print"),
    "description": whole("description = [1]\n", 1, "description", "a text in quotes"),
    "description_with_controls": whole('description = "a\\u0007"\n', 1, "control characters"),
    "unit": instead('unit = "m"', "unit = 1", "L.unit", "a text in quotes is wanted, not 1"),
    "long_unit": instead('unit = "m"', f'unit = "{"m" * 1000}"', f"at most {LONGEST_LABEL}"),
    "unit_with_a_line_end": instead('unit = "m"', 'unit = "a\\n#include"', "line ends"),
    "body_is_a_number": after("[body]\nb = 3\n", 2, "[body.b]", "a table with keys"),
    "bodies_are_a_list": after("[[load]]\nat = 'arm'\n", 1, "[load]", "a table [load.NAME]"),
    "body_is_a_list": whole("[[body.arm]]\nmass = 1\n", 1, "[body.arm]", "not a list of 1"),
    "parameters_are_a_number": whole("parameters = 3\n", 1, "[parameters]", "a table"),
    "gravity_is_a_list": whole("gravity = [0, 0, -9.81]\n", 1, "[gravity]", "a table [gravity]"),
    "gravity_has_two": after(
        "[gravity]\nacceleration = [0, -9.81]\n", 2, "three numbers", "a list of 2"
    ),
    "axis_is_a_word": instead("axis = [0, 1, 0]", 'axis = "y"', "axis", "three numbers", 'not "y"'),
    "axis_has_four": instead("axis = [0, 1, 0]", "axis = [0, 1, 0, 0]", "a list of 4"),
    "axis_is_zero": instead("axis = [0, 1, 0]", 'axis = [0, "1 - 1", 0]', "length zero"),
    "axis_has_a_word": instead(
        "axis = [0, 1, 0]", "axis = [0, true, 0]", "axis (item 2)", "not true"
    ),
    "axis_has_a_parameter": instead(
        "axis = [0, 1, 0]", 'axis = [0, "m", 0]', "only numbers may stand"
    ),
    "between_is_a_word": instead('["ground", "arm"]', '"ground, arm"', "[tail, head]"),
    "between_has_three": instead('["ground", "arm"]', '["ground", "arm", "arm"]', "a list of 3"),
    "between_has_a_number": instead(
        '["ground", "arm"]', '["ground", 1]', "between (item 2)", "not 1"
    ),
    "effort_is_a_word": after('effort = "no"\n', 1, "effort", 'true or false is wanted, not "no"'),
    "frames_are_a_list": instead("frame.tip = { at", "frame = [{ at", "TOML")._replace(
        text=SMALL.replace('frame.tip = { at = [0, 0, "L"] }', "frame = [1]").encode(),
        says=("[body.arm] frame", "a list of 1"),
    ),
    "input_is_a_unit": instead(
        'push = { unit = "N" }', 'push = "N"', "[inputs] push", 'such as { unit = "N" }'
    ),
    "axes_of_a_load": after(
        '[load.l]\nat = "arm"\nforce = [0, 0, 1]\naxes = "local"\n',
        4,
        '"world" or "body"',
        '"local"',
    ),
    "joint_is_a_list": after(
        '[spring.s]\njoint = ["hinge"]\nstiffness = 1\n', 2, "name of a joint"
    ),
    "parts_are_words": after(
        '[body.c]\n[compound.c]\nbetween = ["arm", "c"]\nparts = ["revolute"]\n',
        4,
        "parts (item 1)",
        "{ type, axis }",
    ),
    "part_is_a_ball": after(
        '[body.c]\n[compound.c]\nbetween = ["arm", "c"]\nparts = [\n{ type = "spherical" },\n]\n',
        5,
        "parts (item 1)",
        '"spherical"',
        "revolute, prismatic",
    ),
    "parts_are_none": after(
        '[body.c]\n[compound.c]\nbetween = ["arm", "c"]\nparts = []\n', 4, "one to six"
    ),
    "universal_axes_are_parallel": after(
        '[body.c]\n[universal.c]\nbetween = ["arm", "c"]\naxes = [[1, 0, 0], [2, 0, 0]]\n',
        2,
        "[universal.c]",
        "parallel",
    ),
    "angles_are_unknown": after(
        '[body.c]\n[spherical.c]\nbetween = ["arm", "c"]\nangles = "xyy"\n',
        2,
        "[spherical.c]",
        "'xyy'",
        "zxz",
    ),
}

BODIES = {
    "inertia_is_a_number": instead("[0.1, 0.1, 0.1]", "0.1", "[xx, yy, zz]", "not 0.1"),
    "inertia_has_two": instead("[0.1, 0.1, 0.1]", "[0.1, 0.1]", "a list of 2"),
    "inertia_row_is_short": instead(
        "[0.1, 0.1, 0.1]", "[[1, 0, 0], [0, 1], [0, 0, 1]]", "inertia (item 2)"
    ),
    "inertia_is_skew": instead(
        "[0.1, 0.1, 0.1]", "[[1, 2, 0], [0, 1, 0], [0, 0, 1]]", "not symmetric"
    ),
    "inertia_is_mixed": instead("[0.1, 0.1, 0.1]", "[1, [0, 1, 0], [0, 0, 1]]", "three numbers"),
    "inertia_is_negative": instead("[0.1, 0.1, 0.1]", "{ xx = -1 }", "inertia.xx", "negative"),
    "both_moments": instead(
        'mass = "m"',
        'mass = "m"\nmass_center = [0, 0, 1]\nfirst_moment = [0, 0, 1]',
        "mass_center or first_moment, not both",
        line=8,
    ),
    "both_turns": instead(
        'at = [0, 0, "L"]', "rpy = [0, 0, 1], axis = [0, 0, 1]", "rpy or axis, not both"
    ),
    "turn_without_axis": instead('at = [0, 0, "L"]', "angle = 0.7", "no axis to turn about"),
    "frame_called_mass_center": instead("frame.tip", "frame.mass_center", "name is taken"),
    "body_called_ground": after("[body.ground]\nmass = 1\n", 1, "[body.ground]", "taken"),
    "body_without_name": after('[body.""]\nmass = 1\n', 1, "a name is needed"),
    "body_with_a_dot": after('[body."a.b"]\nmass = 1\n', 1, '[body."a.b"]', "has a dot"),
    "body_with_blanks": after('[body." a"]\nmass = 1\n', 1, "blanks at its ends"),
    "body_with_a_line_end": after('[body."a\\nb"]\nmass = 1\n', 1, "do not print", "a\\x0ab"),
    "body_with_a_long_name": after(f"[body.{'a' * 101}]\nmass = 1\n", 1, "101 characters"),
    "body_with_a_slash": after('[body."a/b"]\nmass = 1\n', 1, "slash"),
    "frame_with_a_dot": instead("frame.tip", 'frame."t.p"', "has a dot"),
}

CONNECTIONS = {
    "body": instead(
        '["ground", "arm"]',
        '["ground", "amr"]',
        "between (item 2)",
        'no body or frame "amr"; did you mean "arm"?',
    ),
    "frame": instead('["ground", "arm"]', '["ground", "arm.tap"]', 'did you mean "arm.tip"'),
    "world": instead('["ground", "arm"]', '["world", "arm"]', 'did you mean "ground"?'),
    "frame_of_ground": instead(
        '["ground", "arm"]', '["ground.hook", "arm"]', 'no body or frame "ground.hook"'
    ),
    "both": instead('["ground", "arm"]', '["grund", "amr"]', '"ground"', '"arm"')._replace(
        lines=(13, 13)
    ),
    "itself": instead('["ground", "arm"]', '["arm.tip", "arm"]', 'connects body "arm" to itself'),
    "ground_to_ground": after(
        '[frame.a]\n[spring.s]\nbetween = ["ground", "ground.a"]\nstiffness = 1\n', 3, "to itself"
    ),
    "joint_of_an_element": after(
        '[spring.s]\njoint = "hing"\nstiffness = 1\n', 2, 'no joint "hing"; did you mean "hinge"?'
    ),
    "two_places": after(
        '[spring.s]\njoint = "hinge"\nbetween = ["ground", "arm.tip"]\nstiffness = 1\n',
        1,
        "between or joint, not both",
    ),
    "joint_of_many_freedoms": after(
        '[body.b]\n[free.f]\nbetween = ["ground", "b"]\n[spring.s]\njoint = "f"\nstiffness = 1\n',
        5,
        "6 degrees of freedom",
        "one",
    ),
    "leader": after('follows = { joint = "hnge" }\n', 1, "follows.joint", '"hinge"'),
    "leader_and_motion": after(
        'motion = "t"\nfollows = { joint = "hinge" }\n', (-2,), "motion or follows, not both"
    ),
    "load": after('[load.l]\nat = "arm.tap"\nforce = [0, 0, 1]\n', 2, "[load.l] at", '"arm.tip"'),
    "rotor": after(
        '[body.b]\n[prismatic.p]\nbetween = ["ground", "b"]\naxis = [1, 0, 0]\n'
        '[rotor.r]\njoint = "p"\ninertia = 1\n',
        5,
        "[rotor.r]",
        "not a revolute",
    ),
    "same_name_of_joints": after(
        '[body.b]\n[prismatic.hinge]\nbetween = ["arm", "b"]\naxis = [1, 0, 0]\n',
        2,
        "taken by [revolute.hinge] in line 12",
    ),
    "same_name_of_element": after(
        '[spring.hinge]\njoint = "hinge"\nstiffness = 1\n', 1, "taken by [revolute.hinge]"
    ),
}

PARAMETERS = {
    "unknown": mass('"mm"', 'there is no "mm"', 'did you mean "m"'),
    "unknown_in_a_list": instead('[0, 0, "L"]', '[0, 0, "LL"]', "frame.tip.at (item 3)", '"L"'),
    "forward": instead(
        'l = "L/2"', 'l = "K/2"\nK = 2', "[parameters] l", "K, which is declared later"
    ),
    "itself": instead('l = "L/2"', 'l = "l/2"', "[parameters] l", "depends on itself"),
    "circle": instead(
        'l = "L/2"',
        'l = "a"\na = "b"\nb = "l + a"',
        "[parameters] l",
        "depends on itself: l -> a -> b -> l",
        line=5,
    )._replace(lines=(5, 6)),
    "of_an_input": instead('l = "L/2"', 'l = "push"', 'there is no "push"'),
    "of_time": instead(
        'l = "L/2"', 'l = "t"', "t cannot stand here", "only numbers and parameters"
    ),
    "called_t": instead(
        "m = 1.5", "m = 1.5\nt = 2", "[parameters] t", "meaning of its own", line=4
    ),
    "called_pi": instead("m = 1.5", "m = 1.5\npi = 3", "meaning of its own", line=4),
    "called_sin": instead("m = 1.5", "m = 1.5\nsin = 3", "meaning of its own", line=4),
    "called_lambda": instead("m = 1.5", "m = 1.5\nlambda = 3", "word of Python", line=4),
    "with_a_blank": instead(
        "m = 1.5", 'm = 1.5\n"a b" = 3', "cannot stand in an expression", line=4
    ),
    "with_an_underscore": instead("m = 1.5", "m = 1.5\n_a = 3", "starts with a letter", line=4),
    "with_two_underscores": instead("m = 1.5", "m = 1.5\na__b = 3", "cannot be emitted", line=4),
    "with_letters_of_greek": instead(
        "m = 1.5", 'm = 1.5\n"α" = 3', "cannot stand in an expression", line=4
    ),
    "with_a_hyphen": instead(
        "m = 1.5", "m = 1.5\na-b = 3", "cannot stand in an expression", line=4
    ),
    "as_an_input": instead(
        'push = { unit = "N" }', 'm = { unit = "N" }', "[inputs] m", "a parameter has this name"
    ),
    "as_a_coordinate": instead(
        "m = 1.5", "m = 1.5\nhinge = 2", 'coordinate "hinge" has the name of a parameter', line=13
    ),
    "division_by_zero": instead(
        'l = "L/2"', 'l = "1/(L - L)"', "[parameters] l", "division by zero"
    ),
    "no_real_value": instead(
        'l = "L/2"', 'l = "sqrt(-L)"', "[parameters] l", "sqrt(-0.2)", "finite"
    ),
    "overflow": instead('l = "L/2"', 'l = "exp(1000)"', "[parameters] l", "finite"),
}

EXPRESSIONS = {
    "empty": mass('""', "is empty", "an expression"),
    "half": mass('"m*"', "cannot read 'm*'", "not an expression"),
    "two_words": mass('"m m"', "not an expression"),
    "unit": mass('"12 mm"', "not an expression"),
    "power": mass('"m^2"', "write powers as **"),
    "comma": mass('"1,5"', "column"),
    "unknown_function": mass('"sine(m)"', "sine(...) is not a function", "sin,"),
    "arguments": mass('"sin(m, m)"', "sin takes 1 argument"),
    "keyword": mass('"sin(x=m)"', "plain arguments"),
    "call_of_a_call": mass('"sin(1)(2)"', "column"),
    "attribute": mass('"m.real"', "only numbers, names"),
    "subscript": mass('"m[0]"', "only numbers, names"),
    "lambda": mass('"lambda: 1"', "only numbers, names"),
    "comprehension": mass('"[x for x in m]"', "only numbers, names"),
    "comparison": mass('"m < 1"', "only numbers, names"),
    "condition": mass('"1 if m else 2"', "only numbers, names"),
    "text": mass("\"'a'\"", "only numbers, names"),
    "complex": mass('"2j"', "only numbers"),
    "hexadecimal": mass('"0x10"', "decimals"),
    "underscores": mass('"1_000"', "decimals"),
    "floor_division": mass('"m//2"', "operators are + - * /"),
    "comment": mass('"m # kg"', "without #"),
    "line_end": mass('"m +\\n 1"', "one line"),
    "walrus": mass('"(a := 1)"', "only numbers, names"),
    "format": mass("\"f'{m}'\"", "only numbers, names"),
    "import": mass("\"__import__('os')\"", "is not a function"),
    "dunder": mass('"().__class__.__bases__"', "only numbers, names"),
    "eval": mass('"eval(m)"', "eval(...) is not a function"),
    "letters_of_greek": mass('"α*m"', "not ASCII"),
    "power_of_a_name": mass('"2**m"', "exponent must be"),
    "tower": mass('"9**9**9"', "exponent must be"),
    "huge_power": mass('"(((10**64)**64)**64)"', "too large"),
    "huge_literal": mass('"1e999999999"', "too large"),
    "nested": mass('"' + "(" * 300 + "1" + ")" * 300 + '"', "cannot read"),
    "signs": mass('"' + "-" * 5000 + '1"', "nested"),
    "parts": mass('"' + "m+" * 4900 + 'm"', "cannot read"),
    "division_by_zero": mass('"m/0"', "division by zero (column 1)"),
    "division_by_nothing": mass('"1/(m - m)"', "division by zero"),
    "time_in_a_mass": mass('"t"', "t cannot stand here: only numbers and parameters"),
    "input_in_a_mass": mass('"push"', "push cannot stand here"),
    "rate_in_a_mass": mass('"der(hinge)"', "der(hinge) cannot stand here"),
    "time_in_a_frame": instead(
        '[0, 0, "L"]', '[0, 0, "t"]', "frame.tip.at (item 3)", "t cannot stand"
    ),
    "input_in_a_motion": motion('"push"', "push cannot stand here", "the time t"),
    "coordinate_in_a_motion": motion('"sin(hing)"', 'no "hing"'),
    "motion_is_true": motion("true", "not true"),
    "motion_is_empty": motion("[]", "one expression of t for each"),
    "motion_of_an_unknown": motion('"Input"', 'there is no "Input"'),
    "unknown_in_a_law": law("5*hing", 'there is no "hing"; did you mean "hinge"?'),
    "rate_of_an_unknown": law("der(hing)", 'no coordinate "hing"', '"hinge"'),
    "rate_of_a_parameter": law("der(m)", "der(m): there is no coordinate"),
    "rate_of_an_expression": law("der(2*hinge)", "der takes one name"),
    "rate_of_a_rate": law("der(der(hinge))", "der takes one name"),
    "two_unknown": law("aaaa + bbbb", '"aaaa"', '"bbbb"')._replace(lines=(TAIL + 2, TAIL + 2)),
    "x_in_a_stiffness": after(
        '[spring.s]\njoint = "hinge"\nstiffness = "2*x"\n', 3, "x cannot stand here"
    ),
    "x_of_two_meanings": instead("m = 1.5", "m = 1.5\nx = 1", "element's own", line=16)._replace(
        text=(
            SMALL.replace("m = 1.5", "m = 1.5\nx = 1") + '[law.a]\njoint = "hinge"\nforce = "x"\n'
        ).encode(),
        lines=(18,),
    ),
    "x_in_a_load": after(
        '[load.l]\nat = "arm"\nforce = ["x", 0, 0]\n', 3, "force (item 1)", "x cannot stand"
    ),
    "joint_with_several": after(
        '[body.b]\n[free.f]\nbetween = ["ground", "b"]\n[load.l]\nat = "b"\nforce = ["f", 0, 0]\n',
        6,
        'joint "f" has the coordinates f_x',
    ),
}

ROD = '[rod.strut]\nbetween = ["ground", "arm.tip"]\nlength = 0.2\n'
DRIVER = '[driver.lead]\nbetween = ["ground", "arm.tip"]\n'
ROLLING = '[rolling.tyre]\nbetween = ["ground", "arm"]\nradius = 0.2\n'
BLADE = '[blade.skate]\nbetween = ["ground", "arm.tip"]\n'

CONSTRAINTS = {
    "rod_without_ends": after("[rod.r]\nlength = 1\n", 1, "[rod.r]", "between is missing"),
    "rod_without_length": after(ROD.replace("length = 0.2\n", ""), 1, "length is missing"),
    "rod_of_one_end": after(ROD.replace('"ground", ', ""), 2, "[rod.strut] between", "a list of 1"),
    "rod_to_nothing": after(ROD.replace("arm.tip", "arm.tap"), 2, 'did you mean "arm.tip"?'),
    "rod_to_itself": after(ROD.replace("ground", "arm"), 2, 'connects body "arm" to itself'),
    "rod_in_a_joint": after(ROD + 'joint = "hinge"\n', 4, 'unknown key "joint"', "length"),
    "rod_with_effort": after(ROD + "effort = false\n", 4, 'unknown key "effort"'),
    "rod_misspelt": after(ROD + "lenght = 1\n", 4, '"lenght"; did you mean "length"?'),
    "length_is_true": after(ROD.replace("0.2", "true"), 3, "not true"),
    "length_is_a_list": after(ROD.replace("0.2", "[1]"), 3, "not a list of 1"),
    "length_of_a_coordinate": after(
        ROD.replace("0.2", '"hinge"'), 3, "hinge cannot stand here", "the time t"
    ),
    "length_of_an_input": after(ROD.replace("0.2", '"push*2"'), 3, "push cannot stand here"),
    "length_of_a_place": after(
        ROD.replace("0.2", '"position(arm).x"'), 3, "position(arm) can stand in [outputs] only"
    ),
    "length_unknown": after(ROD.replace("0.2", '"LL"'), 3, 'no "LL"; did you mean "L"?'),
    "rods_of_one_name": after(ROD + ROD, 4, "[rod.strut]", "given twice, first in line"),
    "rod_called_like_a_joint": after(
        ROD.replace("strut", "hinge"), 1, "taken by [revolute.hinge] in line 12"
    ),
    "rod_called_like_a_spring": after(
        '[spring.strut]\njoint = "hinge"\nstiffness = 1\n' + ROD, 4, "taken by [spring.strut]"
    ),
    "driver_of_nothing": after(DRIVER, 1, "[driver.lead]", "x or y or z is missing"),
    "driver_by_a_coordinate": after(DRIVER + 'z = "hinge"\n', 3, "[driver.lead] z", "cannot stand"),
    "driver_along_an_axis": after(
        DRIVER + "axis = [0, 0, 1]\n", (1, 3), "x or y or z is missing", 'unknown key "axis"'
    ),
    "driver_by_a_list": after(DRIVER + "x = [1, 2, 3]\n", 3, "not a list of 3"),
    "wheel_without_radius": after(ROLLING.replace("radius = 0.2\n", ""), 1, "radius is missing"),
    "wheel_that_breathes": after(ROLLING.replace("0.2", '"t"'), 3, "t cannot stand here"),
    "wheel_without_direction": after(ROLLING + "axis = [0, 0, 0]\n", 4, "length zero"),
    "wheel_with_a_direction_of_parameters": after(
        ROLLING + 'axis = [0, "L", 0]\n', 4, "axis (item 2)", "only numbers may stand"
    ),
    "wheel_with_a_width": after(ROLLING + "width = 1\n", 4, "known: between, axis, radius, crown"),
    "blade_without_direction": after(BLADE + "axis = [0, 0]\n", 3, "[blade.skate] axis", "three"),
    "blade_with_a_radius": after(BLADE + "radius = 1\n", 3, 'unknown key "radius"'),
    "constraint_as_a_type": after("[constraint.c]\n", 1, "[constraint] is not known"),
    "rods": after("[rods.r]\n", 1, '[rods] is not known; did you mean "rod"?'),
    "rod_is_a_number": after("[rod]\nr = 1\n", 2, "[rod.r]", "a table with keys"),
}

RELATIONS = {
    "without_a_rate": after("[relation.gear]\n", 1, "[relation.gear]", "rate is missing"),
    "between_bodies": after(
        '[relation.gear]\nbetween = ["ground", "arm"]\nrate = "der(hinge)"\n', 2, "known: rate"
    ),
    "of_an_equation": after('[relation.gear]\nrate = "der(hinge) = 1"\n', 2, "cannot read"),
    "of_an_unknown": after('[relation.gear]\nrate = "der(hing)"\n', 2, '"hing"', '"hinge"'),
    "of_a_body": after('[relation.gear]\nrate = "der(arm)"\n', 2, 'no coordinate "arm"'),
    "of_x": after('[relation.gear]\nrate = "der(hinge) - x"\n', 2, "x cannot stand here"),
    "of_a_velocity": after(
        '[relation.gear]\nrate = "velocity(arm.tip).x"\n', 2, "can stand in [outputs] only"
    ),
    "of_two": after('[relation.gear]\nrate = ["der(hinge)", 0]\n', 2, "not a list of 2"),
    "called_like_a_joint": after('[relation.hinge]\nrate = "der(hinge)"\n', 1, "name is taken"),
}


def choice(text: str, *says: str) -> Bad:
    return after(f"[formulation]\n{text}\n", 2, "[formulation]", *says)


FORMULATION = {
    "unknown_key": choice("trees = []", 'unknown key "trees"; did you mean "tree"?'),
    "tree_is_a_word": choice('tree = "hinge"', "a list of joints", 'not "hinge"'),
    "tree_of_numbers": choice("tree = [1]", "a list of joints"),
    "coordinates_of_a_kind": choice('coordinates = "cartesian"', '"absolute-angle"', '"cartesian"'),
    "coordinates_are_true": choice("coordinates = true", "not true"),
    "coordinates_of_a_list": choice('coordinates = ["absolute"]', "not a list of 1"),
    "coordinates_of_no_body": choice(
        'coordinates = { amr = "absolute" }', 'no body "amr"; did you mean "arm"?'
    ),
    "coordinates_of_ground": choice('coordinates = { ground = "absolute" }', '"ground"'),
    "coordinates_of_a_frame": choice('coordinates = { "arm.tip" = "absolute" }', '"arm.tip"'),
    "coordinates_of_a_body_are_none": choice("coordinates = { arm = 1 }", "coordinates.arm", "1"),
    "independent_is_a_word": choice('independent = "hinge"', "a list of coordinates is wanted"),
    "independent_is_a_table": choice("independent = [{}]", "a list of coordinates is wanted"),
    "baumgarte_of_one": choice("baumgarte = 5", "a list [alpha, beta] is wanted, not 5"),
    "baumgarte_of_three": choice("baumgarte = [1, 2, 3]", "a list [alpha, beta]"),
    "baumgarte_of_time": choice('baumgarte = [1, "t"]', "baumgarte (item 2)", "t cannot stand"),
    "baumgarte_of_nothing": choice('baumgarte = [1, ""]', "baumgarte (item 2)", "is empty"),
    "reactions_in_the_world": choice('reactions = "world"', '"ground" is wanted, not "world"'),
    "reactions_of_a_list": choice('reactions = ["head"]', "not a list of 1"),
    "is_a_list": after("[[formulation]]\n", 1, "a table [formulation] is wanted"),
    "has_a_name": after("[formulation.mine]\n", 1, "[formulation] mine", "unknown key"),
}


def output(value: str, *says: str) -> Bad:
    return after(f"[outputs]\ny = {value}\n", 2, "[outputs] y", *says)


OUTPUTS = {
    "true": output("true", "not true"),
    "list": output("[1, 2]", "not a list of 2"),
    "empty": output('""', "is empty"),
    "without_a_value": output('{ unit = "m" }', "value is missing"),
    "unknown_key": output('{ value = 1, units = "m" }', 'did you mean "unit"?'),
    "unit_is_a_number": output("{ value = 1, unit = 1 }", "y.unit", "a text in quotes"),
    "place_of_nothing": output('"position(amr).x"', 'no body or frame "amr"', '"arm"'),
    "place_of_a_joint": output('"position(hinge).x"', 'no body or frame "hinge"'),
    "place_on_the_fourth_axis": output('"position(arm).w"', "components x, y and z, not w"),
    "place_as_a_whole": output('"position(arm)"', "is a vector: add .x, .y or .z"),
    "place_of_two": output('"position(arm, ground).x"', "takes one name"),
    "place_of_an_expression": output('"position(2*arm).x"', "takes one name"),
    "place_deep_inside": output('"position(arm.tip.toe).x"', "takes one name"),
    "speed": output('"speed(arm).x"', "only numbers, names"),
    "force_of_a_body": output('"force(arm).x"', 'no joint or constraint "arm"'),
    "force_of_a_misspelt_joint": output('"force(hnge).x"', 'did you mean "hinge"?'),
    "torque_without_a_component": output('"torque(hinge)"', "is a vector"),
    "across_a_joint": output('"across(hinge)"', 'no force element or component "hinge"'),
    "through_a_component": output('"through(hinge).x"', "only numbers, names"),
    "x": output('"x"', "x cannot stand here"),
    "unknown": output('"hing"', 'no "hing"; did you mean "hinge"?'),
    "rate_of_a_place": output('"der(position(arm).x)"', "der takes one name"),
    "name_with_a_blank": after(
        '[outputs]\n"a b" = 1\n', 2, '[outputs] "a b"', "cannot stand in an expression"
    ),
    "name_of_a_function": after("[outputs]\nsin = 1\n", 2, "meaning of its own"),
    "name_twice": after("[outputs]\ny = 1\ny = 2\n", 3, "[outputs] y", "given twice"),
    "is_a_number": after("[[outputs]]\ny = 1\n", 1, "a table [outputs] is wanted"),
}


def start(value: str, *says: str) -> Bad:
    return after(f"start = {value}\n", 1, "[revolute.hinge] start", *says)


START = {
    "true": start("true", "not true"),
    "table": start("{ value = 1 }", "not a table"),
    "empty": start("[]", "one number for each coordinate"),
    "of_eight": start("[1, 2, 3, 4, 5, 6, 7, 8]", "not a list of 8"),
    "of_words": start('["ground"]', 'no "ground"'),
    "input": start('"input"', 'no "input"'),
    "of_time": start('"t"', "t cannot stand here"),
    "of_a_coordinate": start('"hinge"', 'no "hinge"'),
    "infinite": start("inf", "not a finite number"),
    "of_a_weld": after(
        '[body.b]\n[fixed.w]\nbetween = ["arm", "b"]\nstart = 0\n', 4, 'unknown key "start"'
    ),
    "of_a_rod": after(ROD + "start = 0\n", 4, 'unknown key "start"'),
}

CASES = {
    f"{group}-{name}": bad
    for group, cases in {
        "text": TEXT,
        "syntax": SYNTAX,
        "json": JSON,
        "keys": KEYS,
        "missing": MISSING,
        "types": TYPES,
        "bodies": BODIES,
        "connections": CONNECTIONS,
        "parameters": PARAMETERS,
        "expressions": EXPRESSIONS,
        "constraints": CONSTRAINTS,
        "relations": RELATIONS,
        "formulation": FORMULATION,
        "outputs": OUTPUTS,
        "start": START,
    }.items()
    for name, bad in cases.items()
}


def errors_of(text: bytes) -> tuple[SourceError, ...]:
    with pytest.raises((SourceError, SourceErrors)) as caught:
        parse(text, "small.toml" if not text.startswith(b"{") else "small.json")
    error = caught.value
    return error.errors if isinstance(error, SourceErrors) else (error,)


@pytest.mark.parametrize("case", CASES)
def test_says_where_and_what(case: str) -> None:
    bad = CASES[case]
    errors = errors_of(bad.text)
    text = "\n".join(map(str, errors))
    assert tuple(error.line for error in errors) == bad.lines, text
    for part in bad.says:
        assert part in text, text
    for line in text.split("\n"):
        assert line.startswith("small.")
        assert line.isprintable()
        assert len(line) < 700


def test_the_cases_are_many() -> None:
    assert len(CASES) >= 300
    parse(SMALL.encode(), "small.toml")


def test_all_errors_are_reported_in_the_order_of_the_file() -> None:
    text = (
        'nam = "a"\n[parameters]\nm = "k"\n[body.b]\nmass = "m"\nmas = 2\n[revolute.h]\n'
        'between = ["ground", "c"]\naxis = [0, 0]\n[damper.d]\njoint = "h"\ndamping = "der(h)*"\n'
    )
    errors = errors_of(text.encode())
    assert [error.line for error in errors] == [1, 3, 6, 8, 9, 12]
    assert [error.thing for error in errors] == [
        "",
        "[parameters] m",
        "[body.b] mas",
        "[revolute.h] between (item 2)",
        "[revolute.h] axis",
        "[damper.d] damping",
    ]


def test_more_errors_than_a_screen_holds_are_counted() -> None:
    text = "".join(f'[body.b{i}]\nmass = "x"\n' for i in range(50))
    with pytest.raises(SourceErrors) as caught:
        parse(text.encode(), "many.toml")
    lines = str(caught.value).split("\n")
    assert len(lines) == 21
    assert lines[-1] == "and 30 more"
    assert len(caught.value.errors) == 50


def test_what_follows_from_an_error_is_not_reported() -> None:
    """A joint in error still has a name, a parameter in error too."""
    text = (
        'parameters.m = "oops"\nparameters.k = "2*m"\nbody.b.mass = "k"\n'
        '[revolute.h]\nbetween = ["ground", "b"]\naxis = [0]\n'
        '[law.l]\njoint = "h"\nforce = "m*der(h) + k"\n[rotor.r]\njoint = "h"\ninertia = 1\n'
    )
    assert [error.line for error in errors_of(text.encode())] == [1, 6]


def test_errors_of_the_derivation_have_a_line() -> None:
    """A loop is none of them, a loose body is."""
    from linegraph.derivation import derive

    text = (
        SMALL + '[revolute.second]\nbetween = ["ground", "arm"]\naxis = [0, 1, 0]\n[body.loose]\n'
    )
    with pytest.raises(SourceError, match=rf'small.toml:{TAIL + 3}: body "loose": nothing'):
        derive(parse(text.encode(), "small.toml"))


# ---------------------------------------------------------------- files


def test_a_missing_file(tmp_path: Path) -> None:
    with pytest.raises(SourceError, match=r"none\.toml: cannot be read: No such file"):
        read(tmp_path / "none.toml")


def test_a_folder(tmp_path: Path) -> None:
    with pytest.raises(SourceError, match="is a directory"):
        read(tmp_path)


def test_a_path_with_nul() -> None:
    with pytest.raises(SourceError, match="cannot be read"):
        read("a\x00b.toml")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no FIFOs here")
def test_a_fifo_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "f.toml")
    with pytest.raises(SourceError, match="not a regular file"):
        read(tmp_path / "f.toml")


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="no devices here")
def test_a_device_is_not_read() -> None:
    with pytest.raises(SourceError, match="not a regular file"):
        read("/dev/zero")


@pytest.mark.skipif(not hasattr(socket, "AF_UNIX"), reason="no sockets here")
def test_a_socket(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # a socket's path is short
    with socket.socket(socket.AF_UNIX) as server:
        server.bind("s.toml")
        with pytest.raises(SourceError, match="not a regular file"):
            read("s.toml")


def test_a_dangling_link(tmp_path: Path) -> None:
    (tmp_path / "l.toml").symlink_to(tmp_path / "none")
    with pytest.raises(SourceError, match="cannot be read"):
        read(tmp_path / "l.toml")

"""Names in a URDF may be any text: what is emitted works and moves alike, or is refused once and clearly.

The whole path: XML, the importer, the derivation, C under a strict compiler with trigraphs on, Python with
warnings as errors. Names that parsers, templates, comments and strings could trip over stand in all places.
"""

from __future__ import annotations

import random
import subprocess
import sys
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

import numpy as np
import pytest
from support import codegen_samples as samples
from support.emitted import load

from linegraph.emission.emit import render
from linegraph.errors import LinegraphError
from linegraph.readers.urdf import parse

if TYPE_CHECKING:
    from pathlib import Path

    from linegraph.model.builder import Model

INERTIAL = (
    '<inertial><origin xyz="0 0.1 -0.5"/><mass value="2"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
)
NAMES = (
    *samples.HOSTILE,
    *("*/ int evil; /*", "/* */ double t0[9]; //", "static const double t0 = 1;", "return 0; }"),
    *("{%- for x in y %}", "{#", "#}", "}}", "%(name)s", "%%", "\\N{x}", "\\u0041", "f'{1}'"),
    *("int", "class", "lambda", "NAN", "q", "p", "NQ", "R_NQ", "r_mass_matrix", "self", "np", "t0"),
    *("手", "Ω", "é", "e\u0301", "İ", "ſ", "a b", "a.b", "a_b", "a__b", "_", "__init__", "1", "-"),
    *("t", "pi", "sin", "input", "der", "ground", "root", "x_dot", "a_x", "u_x"),
)
CHECK = [
    "cc",
    "-std=c99",
    "-trigraphs",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-pedantic",
    "-Wno-trigraphs",
]


def robot(names: list[str]) -> bytes:
    """A chain of a hinge, a slide and a hinge; names of the robot, of three links and of three joints."""
    blanks = {"\n": "&#10;", "\r": "&#13;", "\t": "&#9;"}
    quoted = [quoteattr(name, blanks) for name in names]
    model, one, two, three, first, second, third = quoted
    rows = [
        (first, "revolute", '"stand"', one, "0 0 1"),
        (second, "prismatic", one, two, "1 0 0"),
        (third, "continuous", two, three, "0 1 0"),
    ]
    joints = "".join(
        f'<joint name={name} type="{kind}"><parent link={near}/><child link={far}/>'
        f'<origin xyz="0.3 0 0.1"/><axis xyz="{axis}"/></joint>\n'
        for name, kind, near, far, axis in rows
    )
    links = "".join(f"<link name={name}>{INERTIAL}</link>\n" for name in (one, two, three))
    text = f'<robot name={model}>\n<link name="stand"/>\n{links}{joints}</robot>'
    return text.encode("utf-8", "surrogatepass")


def checked(model: Model, folder: Path) -> None:
    """What is emitted is strict C99, C++ and Python, and says what the same robot of plain names does."""
    model.name = "r"
    files = render(model)
    for name, text in files.items():
        (folder / name).write_text(text, encoding="ascii")
    for compiler in (CHECK, ["c++", "-x", "c++", *CHECK[3:]]):
        command = [*compiler, "-fsyntax-only", str(folder / "r.c")]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    script = "import sys; sys.dont_write_bytecode = True; import r; print(len(r.Q_NAMES))"
    command = [sys.executable, "-W", "error", "-c", script]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.stdout.strip() == "3", done.stderr
    emitted = load(files, "r", folder)
    q, v = np.array([0.3, -0.2, 0.5]), np.array([0.1, 0.7, -0.4])
    np.testing.assert_allclose(emitted.bias(q, v), PLAIN[1], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(emitted.mass_matrix(q), PLAIN[0], rtol=1e-12, atol=1e-12)


def plain() -> tuple[np.ndarray, np.ndarray]:
    """M and h of the robot by the float reference."""
    from linegraph.derivation import derive

    names = ["r", "one", "two", "three", "first", "second", "third"]
    numeric = derive(parse(robot(names), "r.urdf")).numeric()
    q, v = [0.3, -0.2, 0.5], [0.1, 0.7, -0.4]
    return np.array(numeric.mass_matrix(q)), np.array(numeric.bias(q, v))


PLAIN = plain()


def passed(names: list[str], symbolic: bool, folder: Path) -> bool:
    """Whether names are accepted; if not, one line says why and where."""
    try:
        model = parse(robot(names), "r.urdf", symbolic=symbolic)
    except LinegraphError as error:
        message = str(error)
        assert message.startswith("r.urdf:")
        assert message.isprintable()
        assert len(message) < 600
        return False
    checked(model, folder)
    return True


@pytest.mark.parametrize(
    "name", ["*/ int evil; /*", '"""\\', "??/", "{{ 7 * 7 }}{% raw %}", "手", "t"]
)
def test_a_joint_and_its_link_may_be_called(name: str, tmp_path: Path) -> None:
    assert passed(["r", name, "two", "three", name, "second", "third"], False, tmp_path)


@pytest.mark.seeds(range(0, 6, 2), range(300))
def test_any_names_give_working_code_or_one_refusal(seed: int, tmp_path: Path) -> None:
    """Half of the names from the list, half put together from two of it; a file names nothing twice."""
    draw = random.Random(seed)
    names: list[str] = []
    while len(names) < 7:
        name = draw.choice(NAMES) + (draw.choice(NAMES) if draw.random() < 0.5 else "")
        if name not in names:
            names.append(name)
    passed(names, draw.random() < 0.5, tmp_path)


def test_most_names_pass(tmp_path: Path) -> None:
    """Refused are those that hold no character that prints, and what XML or xacro claim."""
    refused = []
    for name in dict.fromkeys(NAMES):
        try:
            parse(robot(["r", "one", "two", "three", name, "second", "third"]), "r.urdf")
        except LinegraphError:
            refused.append(name)
    assert all(not x.isprintable() or not x.strip() or "$(" in x for x in refused), refused

"""Model files: the whole language read, equal to the builder's words, in TOML and in JSON."""

from __future__ import annotations

import json
import random
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.modelfile_text import LOOP, SMALL, ZOO

import linegraph as lg
from linegraph.components.constraints import CONSTRAINTS
from linegraph.components.forces import ELEMENTS
from linegraph.components.joints import JOINTS
from linegraph.derivation import derive
from linegraph.emission.emit import render
from linegraph.errors import LinegraphError, SourceErrors
from linegraph.readers.modelfile import parse, read, schema, starter
from linegraph.readers.modelfile.document import parse_document
from linegraph.readers.modelfile.schema import PATH, text
from linegraph.readers.modelfile.starter import write
from linegraph.readers.modelfile.tables import TYPES, joint_table

DOCUMENTATION = Path(__file__).parents[2] / "docs" / "model_file.md"
EXAMPLES = re.findall(r"^```toml\n(.*?)^```", DOCUMENTATION.read_text("utf-8"), re.M | re.S)


def zoo() -> lg.Model:
    return parse(ZOO.encode(), "zoo.toml")


def built() -> lg.Model:
    """`ZOO` in the builder's words."""
    model = lg.Model("zoo")
    model.parameter("g", 9.81)
    model.parameter("L", 0.2, "m", "length")
    model.parameter("m", 0.5, "kg")
    model.parameter("l", "L/2")
    model.parameter("J", "m*l**2/3")
    model.parameter("w", 2.0)
    tilt = model.parameter("tilt", 0.3)
    model.input("push", "N", "a push")
    model.input("wind")
    model.gravity = (0, 0, "-g")
    cart = model.body("cart", mass="2*m", inertia={"xx": 0.1, "yy": "J", "zz": 0.1})
    arm = model.body(
        "arm", mass="m", mass_center=(0, 0, "-l"), inertia={"xx": "J", "yy": "J", "zz": 0}
    )
    hand = model.body(
        "hand",
        mass=0.1,
        first_moment=(0.01, 0, 0),
        inertia={"xx": 0.01, "yy": 0.01, "zz": "m*L**2/10"},
    )
    for name, mass, moment in (
        ("finger", 0.05, 1e-3),
        ("thumb", 0.05, 1e-3),
        ("ball", 1, 0.1),
        ("nut", 1, 0.1),
    ):
        model.body(name, mass=mass, inertia=(moment,) * 3)
    turret = model.body("turret")
    model.body("lift", mass=1)
    hook = model.ground.frame("hook", at=(0, 0, 1))
    ramp = model.ground.frame("ramp", axis=(0, 1, 0), angle=tilt * 1)
    eye = cart.frame("eye", at=("L", 0, 0), rpy=(0, 3.141592653589793 / 2, 0))
    other = cart.frame("other eye", at=(0, "-L", 0))
    tip = arm.frame("tip", at=(0, 0, "-L"))
    model.prismatic("slide", between=(ramp, cart), axis=(COS_30, 0.5, 0), effort=False)
    model.revolute("swing", between=(eye, arm), axis=(0, 1, 0))
    model.universal("wrist", between=(tip, hand), axes=((1, 0, 0), (0, 1, 0)), effort=False)
    model.revolute("knuckle", between=(hand, "finger"), axis=(0, 0, 1))
    model.revolute("knuckle2", between=(hand, "thumb"), axis=(0, 0, 1))
    model.couple("knuckle2", to="knuckle", ratio=-1, offset=0.1)
    model.spherical("socket", between=(cart, "ball"), angles="xyz")
    parts = (("revolute", (1, 0, 0)), ("helical", (0, 0, 1), {"lead": "L/10"}))
    model.compound("screw", between=(cart, "nut"), parts=parts)
    model.revolute("turn", between=("ground", turret), axis=(0, 0, 1), drive="0.1*sin(w*t)")
    model.prismatic("up", between=(turret, "lift"), axis=(0, 0, 1), drive="input")
    model.spring("strut", between=(hook, other), force="20*x + 3*x**3 + 0.1*v", length=0.4)
    model.spring("return", joint="slide", stiffness="g/L")
    model.damper("bearing", joint="swing", damping=1e-4)
    model.friction("rail", joint="slide", viscous=0.1, coulomb=0.2, width=1e-2)
    model.stop("end", joint="knuckle", lower=-1, upper="pi/2", stiffness=100.0)
    law = "push*sin(w*t)/(1 + x**2) + der(swing)"
    model.law("pull", between=("ball", "nut"), force=law)
    torque = (0, "0.1*sqrt(2 + der(slide)**2)", 0)
    model.load("gust", at=tip, force=("wind", 0, "-slide"), torque=torque, axes="body")
    model.rotor("motor", joint="swing", inertia=1e-5, ratio=50)
    return model


COS_30 = 0.8660254037844387


def test_the_file_says_what_the_builder_says() -> None:
    from_file, by_hand = zoo(), built()
    by_hand.about = from_file.about
    assert render(from_file) == render(by_hand)


def test_json_says_the_same() -> None:
    as_json = json.dumps(tomllib.loads(ZOO), indent=1)
    model, other = zoo(), parse(as_json.encode(), "zoo.json")
    # the types are grouped in a JSON made so: joints in another order are other coordinates
    assert [joint.name for joint in other.joints] != [joint.name for joint in model.joints]
    parts = {joint.name: joint for joint in model.joints}
    assert parts == {joint.name: joint for joint in other.joints}
    assert set(model.force_elements) == set(other.force_elements)
    assert model.bodies == other.bodies


def test_json_gives_the_same_bytes() -> None:
    model = parse(SMALL.encode(), "small.toml")
    for source in ("small.json", "small", "small.model"):
        other = parse(json.dumps(tomllib.loads(SMALL)).encode(), source)
        other.about = model.about
        assert render(model) == render(other)


def test_everything_in_the_file_is_carried() -> None:
    model = zoo()
    assert model.parameters["L"] == lg.Parameter("L", 0.2, "m", "length")
    assert [quantity.unit for quantity in model.inputs] == ["N", ""]
    assert model.about.startswith("Every kind of table, every kind of value. Derived from")
    header = render(model)["zoo.h"]
    for part in ("every kind of value", "SHA-256", "a push"):
        assert part in header
    assert re.search(r"L +0\.2 +m +length", header)
    assert model.source == "zoo.toml"
    assert model.places['joint "swing"'] == ZOO[: ZOO.index("[revolute.swing]")].count("\n") + 1


def test_coordinates_stand_in_the_order_of_the_file() -> None:
    text = (
        'revolute.c = { between = ["b", "d"], axis = [0, 0, 1] }\n'
        "[body.b]\nmass = 1\n[body.a]\nmass = 1\n[body.d]\nmass = 1\ninertia = [1, 1, 1]\n"
        '[prismatic.z]\nbetween = ["ground", "a"]\naxis = [1, 0, 0]\n'
        '[revolute.a]\nbetween = ["a", "b"]\naxis = [0, 0, 1]\n'
    )
    names = [joint.name for joint in parse(text.encode(), "m.toml").joints]
    assert names == ["c", "z", "a"]
    swapped = text.replace("[prismatic.z]", "[revolute.a2]").replace(
        "[revolute.a]", "[prismatic.b]"
    )
    assert [joint.name for joint in parse(swapped.encode(), "m.toml").joints] == ["c", "a2", "b"]


def test_a_symbolic_tilt_is_a_rotation() -> None:
    """On a ramp of angle tilt, gravity acts with its sine."""
    text = (
        "parameters.tilt = 0.3\n[frame.ramp]\nrpy = [0, 'tilt', 0]\n[body.b]\nmass = 2\n"
        '[prismatic.s]\nbetween = ["ground.ramp", "b"]\naxis = [1, 0, 0]\n'
    )
    derivation = derive(parse(text.encode(), "m.toml"))
    for tilt in (0.3, 0.7):
        (h,) = derivation.numeric({"tilt": tilt}).bias([0.0], [0.0])
        import math

        assert h == pytest.approx(-2 * 9.81 * math.sin(tilt))


def test_the_basement_moves() -> None:
    text = (
        "parameters.a = 0.1\nparameters.w = 3.0\n[basement]\n"
        'position = ["a*sin(w*t)", 0, "input"]\nrotation = { axis = [0, 0, 1], angle = "w*t" }\n'
        '[body.b]\nmass = 2\n[prismatic.s]\nbetween = ["basement", "b"]\naxis = [1, 0, 0]\n'
    )
    model = parse(text.encode(), "m.toml")
    by_hand = lg.Model("m", about=model.about)
    by_hand.parameter("a", 0.1)
    by_hand.parameter("w", 3.0)
    turn = {"axis": (0, 0, 1), "angle": "w*t"}
    base = by_hand.basement(position=("a*sin(w*t)", 0, "input"), rotation=turn)
    by_hand.body("b", mass=2)
    by_hand.prismatic("s", between=(base, "b"), axis=(1, 0, 0))
    assert render(model) == render(by_hand)
    for rotation in ('"input"', '{ rpy = [0, "t", "input"] }'):
        other = re.sub(r"rotation = .*", f"rotation = {rotation}", text)
        assert render(parse(other.encode(), "m.toml"))


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
def test_line_ends_and_byte_order_marks(end: str, mark: bytes) -> None:
    model = parse(mark + ZOO.replace("\n", end).encode(), "zoo.toml")
    assert model.places == zoo().places


def test_a_model_without_name_has_that_of_the_file(tmp_path: Path) -> None:
    path = tmp_path / "my crane.toml"
    path.write_text(SMALL.replace('name = "small"\n', ""))
    assert read(path).name == "my crane"


def test_unused_keys_of_joints_are_refused_by_type() -> None:
    assert "axis" in joint_table("revolute").fields
    assert "axis" not in joint_table("spherical").fields
    assert "axes" in joint_table("universal").fields
    assert "axis" not in joint_table("universal").fields
    assert "motion" not in joint_table("fixed").fields


def test_every_component_is_in_the_language() -> None:
    assert TYPES.keys() > {*JOINTS, *ELEMENTS, *CONSTRAINTS, "relation"}
    assert set(TYPES) <= set(schema()["properties"])


# ---------------------------------------------------------------- places


def _random_value(draw: random.Random, depth: int) -> str:
    kinds = [
        "1",
        "-1.5e3",
        '"text"',
        "'''a\n'' b'''",
        '"""x\n\\""" y"""',
        "true",
        "1979-05-27 07:32:00Z",
    ]
    if depth and draw.random() < 0.4:
        inner = [_random_value(draw, depth - 1) for _ in range(draw.randrange(4))]
        gap = draw.choice((", ", ",\n  # a comment, ]\n  "))
        return (
            "["
            + gap.join(inner)
            + draw.choice(("", ",")) * bool(inner)
            + draw.choice(("", "\n"))
            + "]"
        )
    if depth and draw.random() < 0.3:
        pairs = [
            f"{_random_key(draw, i)} = {_random_value(draw, 0)}" for i in range(draw.randrange(3))
        ]
        return "{" + ", ".join(pairs) + "}"
    return draw.choice(kinds)


def _random_key(draw: random.Random, i: int) -> str:
    return draw.choice(
        (f"k{i}", f'"k {i}"', f"'k#{i}'", f"k{i}.sub", f'k{i} . "s.u]b"', f'"\\u00e9{i}"')
    )


def _random_toml(draw: random.Random) -> str:
    lines = []
    for i in range(draw.randrange(1, 12)):
        kind = draw.random()
        if kind < 0.2:
            lines.append(f"  [ t{i} . {_random_key(draw, i)} ] # ]")
        elif kind < 0.35:
            lines.append(f"[[a{draw.randrange(2)}]]")
        elif kind < 0.45:
            lines.append(draw.choice(("", "# [comment]", "\t")))
        else:
            lines.append(f"{_random_key(draw, i)} = {_random_value(draw, 2)}")
    return "\n".join(lines)


def _paths(value: Any, path: tuple[str | int, ...] = ()) -> set[tuple[str | int, ...]]:
    found = {path} if path else set()
    items = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    for key, inner in items:
        found |= _paths(inner, (*path, key))
    return found


@pytest.mark.parametrize("seed", range(20))
def test_the_locator_finds_exactly_what_the_reader_reads(seed: int) -> None:
    draw = random.Random(seed)
    valid = 0
    while valid < 40:
        toml = _random_toml(draw)
        try:
            data = tomllib.loads(toml)
        except tomllib.TOMLDecodeError:
            continue
        valid += 1
        found = parse_document((toml or "#").encode() + b"\n#", "m.toml").lines
        assert set(found) == _paths(data), toml
        assert list(found.values()) == sorted(found.values()) or "[[" in toml or "t" in toml
        for path, line in found.items():
            if isinstance(path[-1], str) and path[-1].isascii():
                assert path[-1] in toml.split("\n")[line - 1], (path, line, toml)


@pytest.mark.parametrize("seed", range(5))
def test_the_json_locator_finds_exactly_what_the_reader_reads(seed: int) -> None:
    draw = random.Random(seed)

    def value(depth: int) -> Any:
        kind = draw.randrange(6 if depth else 4)
        if kind == 4:
            return [value(depth - 1) for _ in range(draw.randrange(4))]
        if kind == 5:
            return {f'k"{i}\n{{': value(depth - 1) for i in range(draw.randrange(4))}
        return draw.choice((1, -2.5e-3, True, None, 'a"\\', "]}\u00e9", ""))

    for _ in range(50):
        data = {"a": value(5), "b": value(3)}
        for indent in (None, 2):
            text = json.dumps(data, indent=indent, ensure_ascii=draw.random() < 0.5)
            assert set(parse_document(text.encode(), "m.json").lines) == _paths(data), text


# ---------------------------------------------------------------- schema, starter, documentation


def test_the_shipped_schema_is_current() -> None:
    assert PATH.read_text(encoding="utf-8") == text(), (
        "run: linegraph schema > linegraph/readers/modelfile/schema.json"
    )


def _valid(value: Any, wanted: dict[str, Any]) -> bool:
    """The few words of JSON Schema that ours uses."""
    if "anyOf" in wanted and not any(_valid(value, option) for option in wanted["anyOf"]):
        return False
    if "const" in wanted or "enum" in wanted:
        return value in wanted.get("enum", [wanted.get("const")])
    if any(not _valid(value, part) for part in wanted.get("allOf", ())):
        return False
    if not set(wanted.get("required", ())) <= set(value if isinstance(value, dict) else ()):
        return False
    match wanted.get("type"):
        case "object":
            properties = wanted.get("properties", {})
            others = wanted.get("additionalProperties", True)
            return isinstance(value, dict) and all(
                _valid(inner, properties[key])
                if key in properties
                else isinstance(others, dict) and _valid(inner, others)
                for key, inner in value.items()
            )
        case "array":
            return (
                isinstance(value, list)
                and wanted.get("minItems", 0) <= len(value) <= wanted.get("maxItems", len(value))
                and all(_valid(item, wanted["items"]) for item in value)
            )
        case "string":
            return isinstance(value, str)
        case "boolean":
            return isinstance(value, bool)
        case "number":
            number = isinstance(value, (int, float)) and not isinstance(value, bool)
            return number and value >= wanted.get("minimum", value)
    return True


@pytest.mark.parametrize("toml", [ZOO, SMALL, LOOP, starter("cart"), *EXAMPLES])
def test_the_schema_accepts_what_the_reader_accepts(toml: str) -> None:
    assert _valid(tomllib.loads(toml), schema())


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('mass = "m"', "mas = 1"),
        ('mass = "m"', "mass = -1"),
        ("axis = [0, 1, 0]", "axis = [0, 1]"),
        ("axis = [0, 1, 0]", ""),
        ("[revolute.hinge]", "[revolut.hinge]"),
        ('unit = "N"', "unit = 1"),
        ("[revolute.hinge]", "[rod.r]\nlength = 1\n[revolute.hinge]"),
        ("[revolute.hinge]", '[driver.d]\nbetween = ["ground", "arm"]\n[revolute.hinge]'),
        ("[revolute.hinge]", "[relation.r]\n[revolute.hinge]"),
        ("[revolute.hinge]", "[formulation]\nbaumgarte = [1]\n[revolute.hinge]"),
        ("[revolute.hinge]", '[formulation]\ncoordinates = "cartesian"\n[revolute.hinge]'),
        ("[revolute.hinge]", "[formulation]\ntree = [1]\n[revolute.hinge]"),
        ("[revolute.hinge]", "[outputs]\ny = {}\n[revolute.hinge]"),
        ("[revolute.hinge]", "[outputs]\ny = true\n[revolute.hinge]"),
    ],
)
def test_the_schema_refuses_what_the_reader_refuses(old: str, new: str) -> None:
    text = SMALL.replace(old, new)
    assert not _valid(tomllib.loads(text), schema())
    with pytest.raises(SourceErrors):
        parse(text.encode(), "m.toml")


@pytest.mark.parametrize("name", ["cart", "my crane", 'quo"ted', "\u00e9"])
def test_the_starter_can_be_emitted(name: str) -> None:
    model = parse(starter(name).encode(), "new.toml")
    assert model.name == name
    assert not model.warnings
    header = render(model, name="m", languages=["c"])["m.h"]
    assert "mass of the pendulum" in header


def test_the_starter_names_every_type() -> None:
    for kind in (*JOINTS, *ELEMENTS):
        assert kind in starter("a")


def test_the_starter_writes_over_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert write("crane") == Path("crane.toml")
    before = Path("crane.toml").read_text()
    with pytest.raises(LinegraphError, match="is there already"):
        write("crane")
    assert Path("crane.toml").read_text() == before
    with pytest.raises(LinegraphError, match="cannot be written: No such file"):
        write("crane", "none/crane.toml")
    for bad in ("", "a/b", "a\nb", ".."):
        with pytest.raises(LinegraphError, match="name"):
            write(bad)
    assert [path.name for path in tmp_path.iterdir()] == ["crane.toml"]


@pytest.mark.parametrize("number", range(len(EXAMPLES)))
def test_the_documentation_is_true(number: int) -> None:
    """Each example is a model, or a piece to be added to what the page says first."""
    example = EXAMPLES[number]
    model = parse(example.encode(), "example.toml")
    derive(model)
    assert render(model)


def test_the_documentation_has_every_type() -> None:
    page = DOCUMENTATION.read_text("utf-8")
    for kind in TYPES:
        assert f"[{kind}." in page or f"`{kind}`" in page, kind


# ---- inertias


def with_inertia(text: str) -> lg.Model:
    """A body on a hinge with the given lines."""
    joint = '[revolute.x]\nbetween = ["ground", "a"]\naxis = [0, 1, 0]\n'
    return parse(f"[parameters]\nJ = 5\n[body.a]\n{text}\n{joint}".encode(), "m.toml")


@pytest.mark.parametrize(
    ("text", "moments"),
    [
        ("mass = 1\ninertia = { xx = 1, yy = 1, zz = 5 }", "1, 1, 5"),
        ('mass = 1\ninertia = [1, 1, "J"]', "1, 1, 5"),
        ("mass = 1\ninertia = [[1, 2, 0], [2, 1, 0], [0, 0, 1]]", "-1, 1, 3"),
        # about the mass centre at x = 2: yy and zz less 4 m
        ("mass = 1\nfirst_moment = [2, 0, 0]\ninertia = [1, 5, 9]", "1, 1, 5"),
    ],
)
def test_an_inertia_that_no_body_has_is_told(text: str, moments: str) -> None:
    (warning,) = with_inertia(text).warnings
    start = 'm.toml:3: body "a": no body has this inertia: principal moments'
    assert warning.startswith(f"{start} {moments} kg m^2: ")


@pytest.mark.parametrize(
    "text",
    [
        "mass = 1\ninertia = [1, 1, 2]",
        "mass = 1\ninertia = { zz = 5 }",  # a model in a plane
        "inertia = [[1, 1, 0], [1, 1, 0], [0, 0, 0]]",  # a rotor about an oblique axis
        "mass = 2\nfirst_moment = [2, 0, 0]\ninertia = [1, 3, 3]",
        "mass = 1",
    ],
)
def test_other_inertias_cause_no_warning(text: str) -> None:
    assert with_inertia(text).warnings == []


def test_inertias_symmetric_within_rounding_are_made_symmetric() -> None:
    """R I R^T by numpy is symmetric but for an ulp; what is off by more is refused."""
    draw = np.random.default_rng(5)
    off = 0
    for _ in range(20):
        turn, _ = np.linalg.qr(draw.normal(size=(3, 3)))
        tensor = turn @ np.diag([0.3, 0.4, 0.5]) @ turn.T
        off += int((tensor != tensor.T).any())
        model = with_inertia(f"mass = 1\ninertia = {tensor.tolist()}")
        by_hand = lg.Model("m")
        by_hand.body("a", mass=1, inertia=tensor)
        xx, xy, xz, yy, yz, zz = model.bodies["a"].inertia
        found = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        np.testing.assert_allclose(found, (tensor + tensor.T) / 2, rtol=0, atol=1e-16)
        assert by_hand.bodies["a"].inertia == model.bodies["a"].inertia
    assert off > 5
    tensor[0, 1] += 1e-9
    with pytest.raises(LinegraphError, match=r"m\.toml:5: \[body\.a\] inertia: is not symmetric"):
        with_inertia(f"mass = 1\ninertia = {tensor.tolist()}")

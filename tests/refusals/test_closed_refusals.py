"""Closed mechanisms that cannot be: one message with file and line that names the edges.

Also the other side: what looks suspicious and can be.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest
from support.modelfile_text import LOOP

from linegraph import Model, ModelError, SourceError, derive
from linegraph.emission.emit import render
from linegraph.errors import LinegraphError
from linegraph.readers.modelfile import parse

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.derivation import Derivation

SLIDERS = """\
[body.cart]
mass = 2
[body.cab]
mass = 1
[prismatic.rail]
between = ["ground", "cart"]
axis = [1, 0, 0]
[prismatic.lift]
between = ["cart", "cab"]
axis = [0, 0, 1]
start = 1
"""
"""Two sliders on each other: cases drive them and tie them to ground."""

COMPOUND = """\
[body.cart]
mass = 2
inertia = [1, 1, 1]
frame.tip.at = [1, 0, 0]
[body.cab]
mass = 1
inertia = [1, 1, 1]
[compound.crab]
between = ["ground", "cart"]
parts = [{ type = "prismatic", axis = [1, 0, 0] }, { type = "revolute", axis = [0, 0, 1] }]
[prismatic.lift]
between = ["ground", "cab"]
axis = [0, 1, 0]
"""


class Bad(NamedTuple):
    """A file, the headers of tables one of which is to blame, and what the message must say."""

    text: str
    tables: tuple[str, ...]
    says: tuple[str, ...]


def bad(text: str, tables: str | tuple[str, ...], *says: str) -> Bad:
    return Bad(text, (tables,) if isinstance(tables, str) else tables, says)


def changed(text: str, *changes: tuple[str, str]) -> str:
    """A text with some lines otherwise; each must be there once."""
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def driven(text: str, joint: str, motion: str) -> str:
    """A model with a joint prescribed."""
    return changed(text, (f".{joint}]\n", f'.{joint}]\nmotion = "{motion}"\n'))


def following(text: str, joint: str, leader: str) -> str:
    return changed(text, (f".{joint}]\n", f'.{joint}]\nfollows = {{ joint = "{leader}" }}\n'))


def formulated(text: str, choice: str) -> str:
    return f"{text}[formulation]\n{choice}\n"


def related(rate: str, text: str = LOOP) -> str:
    return f'{text}[relation.gear]\nrate = "{rate}"\n'


def whole(text: str) -> Derivation:
    """All that a command does with a file, forward dynamics among it."""
    model = parse(text.encode(), "m.toml")
    derivation = derive(model)
    derivation.require_inverse("forward_dynamics")
    render(model)
    return derivation


SECOND_RAIL = '[prismatic.second]\nbetween = ["ground", "cart"]\naxis = [1, 0, 0]\n'
ROPE = '[rod.rope]\nbetween = ["ground", "cab"]\nlength = {}\n'
LEAD = '[driver.lead]\nbetween = ["ground", "{}"]\nx = "{}"\n'

OVER_DRIVEN = {
    "two_drives": bad(
        driven(driven(SLIDERS + SECOND_RAIL, "rail", "0.1*t"), "second", "0.2*t"),
        ("[prismatic.rail]", "[prismatic.second]"),
        *("rail", "second", "over-driven"),
    ),
    "two_drives_from_the_start": bad(
        driven(driven(SLIDERS + SECOND_RAIL, "rail", "t"), "second", "t + 0.5"),
        ("[prismatic.rail]", "[prismatic.second]"),
        *("rail", "second", "cannot be assembled", "0.5"),
    ),
    "two_drivers": bad(
        SLIDERS + LEAD.format("cart", "0.1*t") + LEAD.format("cab", "0.2*t").replace("lead", "tow"),
        ("[driver.lead]", "[driver.tow]"),
        *("lead", "tow", "over-driven"),
    ),
    "a_driver_and_a_drive": bad(
        driven(SLIDERS, "rail", "0.1*t") + LEAD.format("cab", "0.3*t"),
        ("[prismatic.rail]", "[driver.lead]"),
        *("rail", "lead", "over-driven"),
    ),
    "a_rod_and_a_drive": bad(
        driven(SLIDERS, "rail", "1 + 0.1*t") + ROPE.format('"1 + 0.2*t"').replace("cab", "cart"),
        ("[prismatic.rail]", "[rod.rope]"),
        *("rope", "rail", "over-driven"),
    ),
    "a_rod_and_a_drive_from_the_start": bad(
        driven(SLIDERS, "rail", "1 + 0.1*t") + ROPE.format(2).replace("cab", "cart"),
        "[rod.rope]",
        *("rail - rope", "cannot be assembled"),
    ),
    "a_crank_and_a_rocker": bad(
        driven(driven(LOOP, "motor", "0.8"), "swing", "2.5"),
        "[revolute.knee]",
        *("motor", "elbow", "swing", "knee", "cannot be assembled"),
    ),
}

UNASSEMBLABLE = {
    "bars_too_short": bad(
        changed(LOOP, ("[0.4, 0, 0]", "[0.04, 0, 0]"), ("[0.3, 0, 0]", "[0.1, 0, 0]")),
        "[revolute.knee]",
        *("motor - elbow - swing - knee", "start"),
    ),
    "rod_too_long": bad(
        LOOP + '[rod.strut]\nbetween = ["ground", "rocker.tip"]\nlength = 5\n',
        "[rod.strut]",
        *("swing - strut", "cannot be assembled"),
    ),
    "hinges_askew": bad(
        changed(LOOP, ("[0.35, 0, 0]", "[0.35, 0, 0.2]")), "[revolute.knee]", "gap", "knee"
    ),
    "wheel_that_does_not_reach_the_ground": bad(
        changed(SLIDERS, ("axis = [0, 0, 1]", "axis = [0, 1, 0]"))
        + '[rolling.tyre]\nbetween = ["ground", "cab"]\nradius = 0.3\n',
        "[rolling.tyre]",
        *("tyre", "cannot be assembled"),
    ),
}

FLOATING = {
    "alone": bad(LOOP + "[body.loose]\nmass = 1\n", "[body.loose]", "loose", "nothing connects it"),
    "on_a_rope": bad(
        LOOP + '[body.loose]\nmass = 1\n[rod.rope]\nbetween = ["ground", "loose"]\nlength = 1\n',
        "[body.loose]",
        *("loose", "a free one if it floats"),
    ),
    "rolling": bad(
        LOOP + '[body.ball]\nmass = 1\n[rolling.r]\nbetween = ["ground", "ball"]\nradius = 1\n',
        "[body.ball]",
        *("ball", "nothing connects it"),
    ),
    "a_loop_of_its_own": bad(
        LOOP
        + "[body.ring]\nmass = 1\n[body.link]\nmass = 1\n"
        + '[revolute.one]\nbetween = ["ring", "link"]\naxis = [0, 0, 1]\n'
        + '[revolute.two]\nbetween = ["ring", "link"]\naxis = [0, 0, 1]\n',
        "[body.ring]",
        *("ring", "nothing connects it"),
    ),
}

MASSLESS = {
    "loop": bad(
        re.sub(r"(mass|inertia) = .*\n", "", LOOP),
        ("[revolute.motor]", "[revolute.elbow]", "[revolute.swing]"),
        *("motor", "elbow", "no inertia"),
    ),
    "held_by_a_massless_hook": bad(
        SLIDERS
        + "[body.hook]\n"
        + '[spherical.eye]\nbetween = ["cab", "hook"]\nstart = [0, 0, 0, 1]\n'
        + '[rod.rope]\nbetween = ["ground", "cab"]\nlength = 1\n',
        "[spherical.eye]",
        *("eye", "no inertia"),
    ),
}

TREES = {
    "circuit": bad(
        formulated(LOOP, 'tree = ["motor", "elbow", "swing", "knee"]'),
        "[formulation]",
        *("knee", "closes a circuit"),
    ),
    "circuit_with_an_inertia_edge": bad(
        formulated(LOOP, 'tree = ["motor", "crank/inertia"]'),
        "[formulation]",
        *("crank/inertia", "closes a circuit"),
    ),
    "unknown": bad(
        formulated(LOOP, 'tree = ["moter"]'), "[formulation]", "moter", 'did you mean "motor"?'
    ),
    "unknown_body": bad(
        formulated(LOOP, 'tree = ["cronk/inertia"]'), "[formulation]", "cronk", "crank/inertia"
    ),
    "spring": bad(formulated(LOOP, 'tree = ["coil"]'), "[formulation]", "coil", "no joint"),
    "rod": bad(
        formulated(SLIDERS + ROPE.format(1), 'tree = ["rope"]'), "[formulation]", "rope", "no joint"
    ),
    "compound_as_chord": bad(
        formulated(
            COMPOUND + '[revolute.pin]\nbetween = ["cart", "cab"]\naxis = [0, 0, 1]\n',
            'tree = ["lift", "pin"]',
        ),
        "[compound.crab]",
        *("crab", "compound", "branch"),
    ),
    "two_compounds": bad(
        COMPOUND
        + '[compound.crab2]\nbetween = ["ground", "cart.tip"]\n'
        + 'parts = [{ type = "prismatic", axis = [1, 0, 0] }]\n',
        ("[compound.crab]", "[compound.crab2]"),
        *("crab", "compound"),
    ),
    "coupled_joint_cut": bad(
        formulated(following(LOOP, "swing", "elbow"), 'tree = ["motor", "knee"]'),
        ("[formulation]", "[revolute.swing]", "[revolute.elbow]"),
        "coupled",
    ),
    "loop_of_coupled_joints": bad(
        following(following(LOOP, "swing", "elbow"), "knee", "motor"),
        ("[revolute.knee]", "[revolute.motor]", "[revolute.swing]", "[revolute.elbow]"),
        "coupled",
    ),
}

INDEPENDENT = {
    "unknown": bad(
        formulated(LOOP, 'independent = ["moter"]'), "[formulation]", "moter", "motor, elbow"
    ),
    "chord": bad(formulated(LOOP, 'independent = ["knee"]'), "[formulation]", '"knee"'),
    "none": bad(formulated(LOOP, "independent = []"), "[formulation]", "0 coordinates for 1"),
    "too_many": bad(
        formulated(LOOP, 'independent = ["motor", "elbow"]'), "[formulation]", "2 coordinates for 1"
    ),
    "twice": bad(
        formulated(
            LOOP + '[body.cab]\nmass = 1\n[prismatic.lift]\nbetween = ["crank", "cab"]\n'
            "axis = [1, 0, 0]\n",
            'independent = ["motor", "motor"]',
        ),
        "[formulation]",
        *("motor", "twice"),
    ),
    "quaternion": bad(
        formulated(
            SLIDERS + "[body.ball]\nmass = 1\ninertia = [1, 1, 1]\n[spherical.eye]\n"
            'between = ["ground", "ball"]\n' + ROPE.format(1),
            'independent = ["eye_wx"]',
        ),
        "[formulation]",
        "eye_wx",
    ),
}

RELATIONS = {
    "input": bad(related("der(motor) - push"), "[relation.gear]", "gear", "the input push"),
    "chord": bad(related("der(motor) - der(knee)"), "[relation.gear]", "gear", "knee"),
    "product": bad(related("der(motor)*der(swing)"), "[relation.gear]", "gear", "linear"),
    "square": bad(related("der(motor)**2 - der(swing)"), "[relation.gear]", "gear", "linear"),
    "sine": bad(related("sin(der(motor)) - der(swing)"), "[relation.gear]", "gear", "linear"),
    "without_rates": bad(related("motor - 0.8"), "[relation.gear]", "gear", "der"),
    "nothing": bad(related("0"), "[relation.gear]", "gear", "der"),
    "not_smooth": bad(related("abs(motor)*der(motor)"), "[relation.gear]", "gear", "smooth"),
    "contradiction": bad(
        related("der(motor) - 1") + '[relation.belt]\nrate = "der(motor) - 2"\n',
        ("[relation.gear]", "[relation.belt]"),
        *("gear", "belt", "over-driven"),
    ),
}

STARTS = {
    "of_two": bad(changed(LOOP, ("start = 0.8", "start = [0.8, 1]")), "[revolute.motor]", "motor"),
    "half_a_place": bad(
        SLIDERS + "[body.ship]\nmass = 1\ninertia = [1, 1, 1]\n[free.floats]\n"
        'between = ["ground", "ship"]\nstart = [0, 0, 1]\n' + ROPE.format(1).replace("cab", "ship"),
        "[free.floats]",
        *("floats", "7"),
    ),
    "quaternion_of_no_length": bad(
        SLIDERS + "[body.ship]\nmass = 1\ninertia = [1, 1, 1]\n[free.floats]\n"
        'between = ["ground", "ship"]\nstart = [0, 0, 1, 0, 0, 0, 0]\n'
        + ROPE.format(1).replace("cab", "ship"),
        "[free.floats]",
        *("floats", "quaternion"),
    ),
}

MOTIONS = {
    "of_no_angle": bad(driven(LOOP, "motor", "atan2(0*t, 0)"), "[revolute.motor]", "motor"),
    "outside_the_domain": bad(
        LOOP + '[rod.strut]\nbetween = ["ground", "rocker.tip"]\nlength = "log(t)"\n',
        "[rod.strut]",
        *("strut", "log(0.0) is not a finite number"),
    ),
}

OUTPUTS = {
    "mass_centre_of_ground": bad(
        LOOP + '[outputs]\ny = "position(ground.mass_center).x"\n',
        "[outputs]",
        "ground.mass_center",
    ),
    "coordinate_without_a_formula": bad(
        SLIDERS
        + '[spherical.eye]\nbetween = ["ground", "cab"]\n[outputs]\ny = "eye_qx"\n'
        + formulated("", 'tree = ["rail", "lift"]'),
        "[outputs]",
        "eye_qx",
    ),
}

CASES = {
    f"{group}-{name}": case
    for group, cases in {
        "over_driven": OVER_DRIVEN,
        "unassemblable": UNASSEMBLABLE,
        "floating": FLOATING,
        "massless": MASSLESS,
        "trees": TREES,
        "independent": INDEPENDENT,
        "relations": RELATIONS,
        "starts": STARTS,
        "motions": MOTIONS,
        "outputs": OUTPUTS,
    }.items()
    for name, case in cases.items()
}


def lines_of(text: str, tables: tuple[str, ...]) -> set[int]:
    """The lines of some tables, their keys included."""
    found, inside = set(), False
    for number, line in enumerate(text.split("\n"), start=1):
        if line.startswith("["):
            inside = line in tables
        if inside:
            found.add(number)
    assert found, tables
    return found


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", CASES)
def test_says_where_and_what(name: str) -> None:
    case = CASES[name]
    with pytest.raises(LinegraphError) as caught:
        whole(case.text)
    message = str(caught.value)
    place = re.match(r"m\.toml:(\d+): (.*)", message)
    assert place, message
    assert message.isprintable(), message
    assert len(message) < 700
    assert int(place[1]) in lines_of(case.text, case.tables), message
    for part in case.says:
        assert part in place[2], message


def test_the_sound_models_are_sound() -> None:
    """What the cases change can be derived."""
    assert whole(LOOP).assembled.freedoms == 1
    assert not whole(SLIDERS).structure.closed
    assert not whole(COMPOUND).structure.closed


# ---- what no file says


@pytest.mark.parametrize(
    ("held", "says"),
    [
        ({"moter": 0.3}, ("moter", "motor, elbow, swing")),
        ({"knee": 0.3}, ('"knee"', "motor, elbow, swing")),
        ({"motor": 0.3, "swing": -2.0}, ("motor - elbow - swing - knee", '"motor", "swing" held')),
    ],
    ids=["unknown", "chord", "out_of_reach"],
)
def test_coordinates_are_held_where_they_can_be(
    held: dict[str, float], says: tuple[str, ...]
) -> None:
    derivation = whole(LOOP)
    with pytest.raises(ModelError) as caught:
        derivation.assembly(held)
    for part in says:
        assert part in str(caught.value)


@pytest.mark.parametrize(
    ("choose", "says"),
    [
        (lambda m: m.formulation(coordinates="cartesian"), ("cartesian", "absolute-angle")),
        (lambda m: m.formulation(of_body={"b": "absolut"}), ("absolut", 'did you mean "absolute"')),
        (lambda m: m.formulation(reactions="world"), ("world", "ground")),
        (lambda m: (m.formulation(of_body={"c": "absolute"}), derive(m)), ('body "c"', "no such")),
        (lambda m: (m.formulation(tree=("j",)), derive(m)), ('branch "j"', "hinge")),
    ],
    ids=["coordinates", "of_body", "reactions", "no_body", "no_branch"],
)
def test_the_builder_says_the_same(choose: Callable[[Model], Any], says: tuple[str, ...]) -> None:
    model = Model("m")
    body = model.body("b", mass=1, inertia=(1, 1, 1))
    model.revolute("hinge", between=("ground", body))
    with pytest.raises(ModelError) as caught:
        choose(model)
    assert not isinstance(caught.value, SourceError)
    for part in says:
        assert part in str(caught.value)


# ---- what can be


def test_two_drives_that_agree_are_fine() -> None:
    """The second one is redundant: the force is shared in a way that nothing decides."""
    text = driven(driven(SLIDERS + SECOND_RAIL, "rail", "0.1*t"), "second", "0.1*t")
    found = whole(text).assembled
    assert (found.freedoms, found.redundant) == (1, 6)
    assert not any(found.unique)


def test_a_rod_may_start_without_length() -> None:
    """Its direction is not known there: the search goes on from elsewhere."""
    text = changed(SLIDERS, ("start = 1\n", "")) + ROPE.format(2)
    found = whole(text).assembled
    assert found.freedoms == 1
    assert sum(x * x for x in found.q) == pytest.approx(4)


def test_the_length_of_a_rod_may_be_an_input() -> None:
    """There is a position for whatever length it has at the start."""
    found = whole(SLIDERS + ROPE.format('"input"')).assembled
    assert found.freedoms == 1


def test_directions_of_constraints_need_no_unit_length() -> None:
    wheel = '[rolling.tyre]\nbetween = ["ground.wall", "cab"]\nradius = 0.3\naxis = [0, {}, 0]\n'
    wall = "[frame.wall]\naxis = [0, 1, 0]\nangle = 0.3\n"
    blade = '[blade.skate]\nbetween = ["ground", "cart"]\naxis = [0, {}, 0]\n'
    for text in (SLIDERS + wall + wheel, SLIDERS + blade):
        one, two = (derive(parse(text.format(x).encode(), "m.toml")).numeric() for x in (1, 2))
        for q in ([0.1, 0.2], [-0.4, 1.0]):
            assert two.constraint_jacobian(q) == one.constraint_jacobian(q)
            assert two.constraints(q) == one.constraints(q)


def test_an_output_may_name_the_time() -> None:
    text = LOOP + '[outputs]\ny = "motor - t"\n'
    assert "double t," in render(parse(text.encode(), "m.toml"))["loop.h"]


def test_a_loop_may_have_massless_bodies() -> None:
    """One of its bodies moves wherever the others do."""
    text = changed(LOOP, ("mass = 0.2\ninertia = [1e-4, 1e-4, 1e-4]\n", ""))
    text = changed(text, ("mass = 0.6\ninertia = [5e-3, 5e-3, 5e-3]\n", ""))
    assert whole(text).assembled.freedoms == 1


def test_a_joint_of_a_loop_may_be_locked() -> None:
    model = parse(LOOP.encode(), "m.toml")
    model.lock("motor", 0.8)
    found = derive(model).assembled
    assert (found.freedoms, found.rank) == (0, 2)


@pytest.mark.parametrize("motion", ["0.8 + sqrt(t)", "0.8 + 1/t"])
def test_a_motion_may_begin_without_a_rate(motion: str) -> None:
    """At t = 0 it has no finite rate; the loop is judged a little later, as a tree is."""
    assert whole(driven(LOOP, "motor", motion)).assembled.freedoms == 0


def test_what_cannot_be_a_chord_is_spared_by_absolute_coordinates() -> None:
    """All bodies absolute, but for those at the head of a compound or a coupled joint."""
    compound = whole(formulated(COMPOUND, 'coordinates = "absolute"')).formulation
    assert "crab" in compound.joints
    coupled = whole(formulated(following(LOOP, "swing", "elbow"), 'coordinates = "absolute"'))
    assert {"swing", "elbow"} <= coupled.formulation.joints

"""The sketch of a mechanism: where things stand, what they are called, that names are clear."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest
from support.drawn import FILES, example, outside, overlaps

from linegraph import Model, ModelError, derive
from linegraph.drawing.mechanism import mechanism_scene, mechanism_svg
from linegraph.drawing.poses import poses
from linegraph.drawing.scene import Disc, flat
from linegraph.drawing.views import chosen_view

if TYPE_CHECKING:
    from linegraph.drawing.scene import Scene

WITH_BODIES = [
    name
    for name, path in FILES.items()
    if path.suffix == ".urdf" or "[body." in path.read_text(encoding="utf-8")
]


def disc_of(scene: Scene, kind: str, name: str) -> tuple[float, float]:
    """The first disc of a thing: a pin seen end-on, a mass centre."""
    for part in scene.parts():
        if (part.kind, part.name) == (kind, name):
            return next((i.x, i.y) for i in flat(part.items) if isinstance(i, Disc))
    raise AssertionError(name)


@pytest.mark.parametrize("name", WITH_BODIES)
def test_names_are_clear_and_everything_has_one(name: str) -> None:
    scene = mechanism_scene(example(name))
    assert overlaps(scene) == []
    assert outside(scene) == []
    model = example(name).system
    said = " ".join(part.name for part in scene.parts())
    things = [*model.bodies, *(j.name for j in model.joints), *(e.name for e in model.elements)]
    assert [thing for thing in things if thing not in said] == []
    signs = {part.name for part in scene.parts() if part.kind == "joint"}
    assert signs == {joint.name for joint in model.joints if joint.freedoms}


@pytest.mark.parametrize("name", ["double_pendulum", "four_bar", "stewart_platform", "furuta"])
def test_names_of_bodies_and_joints_are_seen(name: str) -> None:
    model = example(name).system
    texts = {text.text for text in mechanism_scene(example(name)).texts()}
    assert {*model.bodies, *(joint.name for joint in model.joints)} <= texts


def test_a_pendulum_stands_where_trigonometry_puts_it() -> None:
    l1, c2, a, b = 0.5, 0.2, 0.3, 0.8
    scene = mechanism_scene(example("double_pendulum"), [a, b])
    shoulder = disc_of(scene, "joint", "shoulder")
    elbow = disc_of(scene, "joint", "elbow")
    lower = disc_of(scene, "center", "lower.mass_center")
    # a turn about y takes what hangs to negative x; seen along y, x points right and z up
    scale = math.dist(shoulder, elbow) / l1
    wanted = (shoulder[0] - scale * l1 * math.sin(a), shoulder[1] + scale * l1 * math.cos(a))
    assert elbow == pytest.approx(wanted, abs=0.2)
    wanted = (elbow[0] - scale * c2 * math.sin(a + b), elbow[1] + scale * c2 * math.cos(a + b))
    assert lower == pytest.approx(wanted, abs=0.3)


def test_a_four_bar_closes_where_two_circles_meet() -> None:
    """The knee is one of the two points at distance b from the elbow and c from the pivot."""
    a, b, c, d, angle = 0.1, 0.4, 0.3, 0.35, 1.1
    scene = mechanism_scene(example("four_bar"), hold={"motor": angle})
    motor, swing = (disc_of(scene, "joint", name) for name in ("motor", "swing"))
    scale = math.dist(motor, swing) / d
    elbow, knee = (disc_of(scene, "joint", name) for name in ("elbow", "knee"))
    at = (motor[0] + scale * a * math.cos(angle), motor[1] - scale * a * math.sin(angle))
    assert elbow == pytest.approx(at, abs=0.2)
    assert math.dist(elbow, knee) == pytest.approx(b * scale, abs=0.3)
    assert math.dist(swing, knee) == pytest.approx(c * scale, abs=0.3)


def test_the_view_is_chosen() -> None:
    for name, right, up in (
        ("double_pendulum", (1, 0, 0), (0, 0, 1)),
        ("four_bar", (1, 0, 0), (0, 1, 0)),
        ("cart_pole", (1, 0, 0), (0, 0, 1)),
    ):
        view = chosen_view(poses(example(name)))
        assert view.planar
        assert view.right == pytest.approx(right)
        assert view.up == pytest.approx(up)
    for name in ("furuta", "panda", "stewart_platform"):
        view = chosen_view(poses(example(name)))
        assert not view.planar
        # from above, ground's z upright
        assert view.seen((0, 0, 1)) == pytest.approx((0, 0.9063), abs=1e-3)
        assert view.toward[2] > 0


def test_the_configuration_is_the_assembled_one() -> None:
    derivation = example("four_bar")
    assert mechanism_svg(derivation) == mechanism_svg(derivation, derivation.assembled.q)
    assert mechanism_svg(derivation) != mechanism_svg(
        derivation, derivation.placed_assembly({"motor": 2}).q
    )


def test_what_cannot_be_sketched_is_told() -> None:
    with pytest.raises(ModelError, match='model "cauer_filter": has no bodies'):
        mechanism_scene(example("cauer_filter"))
    with pytest.raises(ModelError, match="q: 2 coordinates are needed, got 1"):
        mechanism_scene(example("double_pendulum"), [0.1])
    model = Model("m")
    bob = model.body("bob", mass=1, mass_center=(0, 0, model.parameter("c")))
    model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
    with pytest.raises(ModelError, match='parameter "c": has no value; a sketch'):
        mechanism_scene(derive(model))


def test_every_kind_of_joint_has_a_sign() -> None:
    """Also where everything stands at one point, and nothing has a size."""
    from linegraph.components.joints import JOINTS

    model = Model("all", gravity=(0, 0, 0))
    before = model.ground
    for kind in JOINTS:
        body = model.body(f"b_{kind}", mass=1, inertia=(1, 1, 1))
        options = {
            "helical": {"lead": 0.1},
            "compound": {"parts": [("revolute", (1, 0, 0)), ("prismatic", (0, 1, 0))]},
        }.get(kind, {})
        getattr(model, kind)(f"j_{kind}", between=(before, body), **options)
        before = body
    scene = mechanism_scene(derive(model))
    assert overlaps(scene) == []
    assert outside(scene) == []
    signs = {part.name for part in scene.parts() if part.kind == "joint"}
    assert signs == {f"j_{kind}" for kind in JOINTS if kind != "fixed"}


def test_ties_of_every_kind() -> None:
    model = Model("ties")
    post = model.ground.frame("post", at=(1, 0, 0))
    plate = model.body("plate", mass=1, inertia=(1, 1, 1))
    corner = plate.frame("corner", at=(0.5, 0, -0.8))
    model.revolute("hinge", between=("ground", plate), axis=(0, 1, 0))

    model.spring("coil", between=(post, corner), stiffness=1, length=0.1)
    model.damper("pot", between=(post, corner), damping=1)
    model.load("wind", at=corner, force=(1, 0, 0))
    scene = mechanism_scene(derive(model))
    ties = {part.name for part in scene.parts() if part.kind == "tie"}
    assert ties == {"coil", "pot", "wind"}
    assert overlaps(scene) == []

"""Models that cannot be: one `ModelError` each, which names the thing and says what is wrong with it.

Also the other side: models that look suspicious and are fine.
"""

from __future__ import annotations

import math
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy
from systems import random_trees as trees

from linegraph import LinegraphError, Model, ModelError, Parameter, SourceError, derive
from linegraph.components.joints import Revolute
from linegraph.dynamics.regularity import is_solid
from linegraph.kinematics.links import Link
from linegraph.kinematics.state_layout import Place
from linegraph.spatial.inertia import Moments, second_moments
from linegraph.spatial.rotation import Rotation
from linegraph.spatial.vector import ZERO

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.model.builder import BodyHandle

NAN, INF = math.nan, math.inf
WRONG_NUMBERS = pytest.mark.parametrize("wrong", [NAN, INF, -INF], ids=str)


def solid(model: Model, name: str, **options: Any) -> BodyHandle:
    return model.body(name, **{"mass": 1.0, "inertia": (0.1, 0.2, 0.25), **options})


def chain(*names: str) -> Model:
    """Solid bodies one after the other on revolute joints j1, j2, ..."""
    model = Model("chain")
    before: Any = "ground"
    for k, name in enumerate(names, start=1):
        body = solid(model, name, mass_center=(0.3, 0.1, 0.2))
        model.revolute(f"j{k}", between=(before, body), axis=(0, 1, 0))
        before = body
    return model


def refusal(build: Callable[[], Any]) -> str:
    """The message of the one ModelError that building raises, checked to be complete."""
    with pytest.raises(ModelError) as caught:
        build()
    message = str(caught.value)
    assert message == f"{caught.value.thing}: {caught.value.problem}"
    assert "\n" not in message
    assert len(caught.value.problem) > 8
    return message


# ---- names


def twice(add: Callable[[Model], Any]) -> Model:
    model = chain("a", "b")
    add(model)
    add(model)
    return model


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (
            lambda: twice(lambda m: m.body("c")),
            'body "c": the name is taken; names of bodies are unique',
        ),
        (
            lambda: Model("m").body("ground"),
            'body "ground": the name is taken; names of bodies are unique',
        ),
        (
            lambda: twice(lambda m: m.ground.frame("f")),
            'frame "ground.f": the name is taken on this body',
        ),
        (
            lambda: Model("m").body("b").frame("mass_center"),
            'frame "b.mass_center": the name is taken on this body',
        ),
        (
            lambda: twice(lambda m: m.revolute("j", between=("a", "b"))),
            'joint "j": the name is taken; names of joints are unique',
        ),
        (
            lambda: twice(lambda m: m.parameter("p", 1.0)),
            'parameter "p": is declared twice',
        ),
    ],
)
def test_names_are_given_once(build: Callable[[], Any], message: str) -> None:
    assert refusal(build) == message


def test_a_frame_and_a_body_with_one_terminal_are_refused() -> None:
    model = Model("m")
    solid(model, "a").frame("b")
    solid(model, "a.b")
    message = 'terminal "a.b": two frames have this name; rename one'
    assert refusal(model.graph) == message


def test_a_body_named_like_a_mass_center_is_refused() -> None:
    """In the graph it would hang on the other body, connected to nothing and in no equation."""
    model = Model("m")
    model.prismatic("j", between=("ground", model.body("a", mass=1)))
    model.body("a.mass_center", mass=5)
    assert 'terminal "a.mass_center": ' in refusal(lambda: derive(model))


@pytest.mark.parametrize(
    ("kind", "other", "what"),
    [
        ("planar", "a_x", "a coordinate"),
        ("planar", "a_vy", "a velocity"),
        ("revolute", "a_dot", "a rate"),
    ],
)
def test_two_coordinates_of_one_name_are_refused(kind: str, other: str, what: str) -> None:
    """Planar joint a has the coordinate a_x; the rate of a revolute joint a is shown as a_dot."""
    model = Model("m")
    one, two = solid(model, "one"), solid(model, "two")
    getattr(model, kind)("a", between=("ground", one))
    model.revolute(other, between=(one, two))
    own = f'joint "{other}": its coordinate "{other}"'
    assert (
        refusal(lambda: derive(model)) == f'{own} has the name of {what} of joint "a"; rename one'
    )


def test_a_joint_with_the_name_of_another_edge_is_refused() -> None:
    model = Model("m")
    model.revolute("b/inertia", between=("ground", solid(model, "b")))
    message = 'edge "b/inertia": arises twice in translation; rename a component'
    assert refusal(model.graph) == message


# ---- numbers


@WRONG_NUMBERS
@pytest.mark.parametrize(
    ("thing", "build"),
    [
        ('body "b"', lambda x: Model("m").body("b", mass=x)),
        ('body "b"', lambda x: Model("m").body("b", mass_center=(0, x, 0))),
        ('body "b"', lambda x: Model("m").body("b", first_moment=(0, 0, x))),
        ('body "b"', lambda x: Model("m").body("b", inertia=(1, x, 1))),
        ('body "b"', lambda x: Model("m").body("b", inertia={"xz": x})),
        ('frame "ground.f"', lambda x: Model("m").ground.frame("f", at=(x, 0, 0))),
        ('frame "ground.f"', lambda x: Model("m").ground.frame("f", rpy=(0, 0, x))),
        ('frame "ground.f"', lambda x: Model("m").ground.frame("f", axis=(0, x, 0))),
        (
            'frame "ground.f"',
            lambda x: Model("m").ground.frame("f", axis=(0, 0, 1), angle=x),
        ),
        (
            'frame "ground.f"',
            lambda x: Model("m").ground.frame("f", rotation=((x, 0, 0), (0, 1, 0), (0, 0, 1))),
        ),
        ('joint "j"', lambda x: Model("m").revolute("j", between=("a", "b"), axis=(x, 0, 0))),
        ('parameter "p"', lambda x: Model("m").parameter("p", x)),
        ("gravity", lambda x: Model("m", gravity=(0, 0, x))),
        ("gravity", lambda x: setattr(Model("m"), "gravity", (x, 0, 0))),
        ('joint "j1"', lambda x: chain("a", "b").couple("j1", "j2", ratio=x)),
        ('joint "j1"', lambda x: chain("a", "b").couple("j1", "j2", offset=x)),
        ('joint "j1"', lambda x: chain("a").lock("j1", x)),
    ],
)
def test_numbers_must_be_finite(thing: str, build: Callable[[float], Any], wrong: float) -> None:
    assert refusal(lambda: build(wrong)) == f"{thing}: {wrong} is not a finite number"


@WRONG_NUMBERS
def test_an_inertia_matrix_must_be_finite(wrong: float) -> None:
    message = refusal(lambda: Model("m").body("b", inertia=((wrong, 0, 0), (0, 1, 0), (0, 0, 1))))
    assert message == f'body "b": {wrong} is not a finite number'


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (
            lambda: Model("m").body("b", mass=-0.5),
            'body "b": the mass is negative (-0.5); it must be 0 or more',
        ),
        (
            lambda: Model("m").body("b", mass_center=(0, 0, 0), first_moment=(0, 0, 0)),
            'body "b": give mass_center or first_moment, not both',
        ),
        (
            lambda: Model("m").body("b", mass_center=(0, 0)),
            'body "b": three components are needed, got 2',
        ),
        (
            lambda: Model("m").ground.frame("f", at=(0, 0, 0, 1)),
            'frame "ground.f": three components are needed, got 4',
        ),
        (
            lambda: Model("m").ground.frame("f", rpy=(1.57,)),
            'frame "ground.f": three components are needed, got 1',
        ),
        (
            lambda: Model("m", gravity=(9.81,)),
            "gravity: three components are needed, got 1",
        ),
        (
            lambda: Model("m").revolute("j", between=("ground", "b"), axis=(0, 0, 0)),
            'joint "j": the axis has length zero; give a direction such as (0, 0, 1)',
        ),
        (
            lambda: Model("m").ground.frame("f", axis=(0, 0, 0), angle=1.0),
            'frame "ground.f": the axis has length zero; give a direction such as (0, 0, 1)',
        ),
        (
            lambda: Model("m").ground.frame("f", angle=0.7),
            'frame "ground.f": has an angle but no axis to turn about; give both, or rpy',
        ),
        (
            lambda: Model("m").ground.frame("f", rpy=(0, 0, 0), angle=0.7),
            'frame "ground.f": has an angle but no axis to turn about; give both, or rpy',
        ),
        (
            lambda: Model("m").ground.frame("f", rpy=(0, 0, 1), axis=(0, 0, 1)),
            'frame "ground.f": give rpy or axis, not both',
        ),
        (
            lambda: Model("m").ground.frame("f", rpy=(0, 0, 1), rotation=np.eye(3)),
            'frame "ground.f": give rpy or rotation, not both',
        ),
    ],
)
def test_numbers_must_make_sense(build: Callable[[], Any], message: str) -> None:
    assert refusal(build) == message


@pytest.mark.parametrize(
    ("inertia", "problem"),
    [
        ((1, 2), "inertia must be (xx, yy, zz), a 3 x 3 matrix or named entries"),
        ((1, 2, 3, 4), "inertia must be (xx, yy, zz), a 3 x 3 matrix or named entries"),
        (((1, 0), (0, 1)), "inertia must be (xx, yy, zz), a 3 x 3 matrix or named entries"),
        (((1, 0, 0), (0, 1, 0)), "inertia must be (xx, yy, zz), a 3 x 3 matrix or named entries"),
        (
            ((1, 0), (0, 1), (0, 0)),
            "inertia must be (xx, yy, zz), a 3 x 3 matrix or named entries",
        ),
        ((1, (0, 1, 0), 1), "inertia must be (xx, yy, zz), a 3 x 3 matrix or named entries"),
        (((1, 0.5, 0), (0, 1, 0), (0, 0, 1)), "the inertia matrix is not symmetric"),
        (((1, 0, 0), (1e-11, 1, 0), (0, 0, 1)), "the inertia matrix is not symmetric"),
        (3, "inertia must be (xx, yy, zz), a 3 x 3 matrix or named entries"),
        ("abc", "inertia must be (xx, yy, zz), a 3 x 3 matrix or named entries"),
        (np.ones((3, 2)), "inertia must be (xx, yy, zz), a 3 x 3 matrix or named entries"),
        ({"xx": 1, "zy": 2}, "unknown inertia entry 'zy'; entries are xx, xy, xz, yy, yz, zz"),
    ],
    ids=str,
)
def test_inertia_of_another_shape_is_refused(inertia: Any, problem: str) -> None:
    assert refusal(lambda: Model("m").body("b", inertia=inertia)) == f'body "b": {problem}'


@pytest.mark.parametrize(
    "axis", [(1e-200, 0.0, -1.0), (1e-9, 0.0, -1.0), (1e-9, 0, -1), (1e200, 0, 0)], ids=str
)
def test_axes_of_extreme_numbers_are_directions(axis: tuple[float, float, float]) -> None:
    model = Model("m")
    body = model.body("b", mass=1, mass_center=(0, 0, 1), inertia=(0.1, 0.2, 0.25))
    model.revolute("j", between=("ground", body), axis=axis)
    ((inertia,),) = derive(model).numeric().mass_matrix([0.3])
    assert inertia == pytest.approx(1.1 if axis[2] == 0 else 0.25, rel=1e-14)


@pytest.mark.parametrize(
    "rotation",
    [
        ((2, 0, 0), (0, 2, 0), (0, 0, 2)),
        ((1, 0, 0), (0, 1, 0), (0, 0, -1)),
        ((1, 0.1, 0), (0, 1, 0), (0, 0, 1)),
        ((0, 0, 0), (0, 0, 0), (0, 0, 0)),
        ((1, 0), (0, 1)),
        ((1, 0, 0), (0, 1, 0)),
        1.0,
    ],
    ids=["twice as long", "mirrored", "sheared", "nothing", "two by two", "two rows", "number"],
)
def test_a_matrix_that_is_no_rotation_is_refused(rotation: Any) -> None:
    message = refusal(lambda: Model("m").ground.frame("f", rotation=rotation))
    assert message.startswith('frame "ground.f": ')


def test_three_by_three_matrices_of_other_libraries() -> None:
    """Arrays of NumPy's and matrices of sympy's mean what nested tuples mean."""
    rows = ((1, 4, 5), (4, 2, 6), (5, 6, 3))
    turn = ((0, -1, 0), (1, 0, 0), (0, 0, 1))
    found = []
    for kind in (tuple, np.array, sympy.Matrix):
        model = Model("m")
        body = model.body("b", mass=1.0, inertia=kind(rows))
        body.frame("f", rotation=kind(turn))
        found.append(model.bodies["b"])
    assert found[0] == found[1] == found[2]
    assert found[0].inertia == (1, 4, 5, 2, 6, 3)


@pytest.mark.parametrize(
    "kind",
    [
        list,
        np.array,
        sympy.Matrix,
    ],
)
def test_vectors_of_other_libraries(kind: Callable[[Any], Any]) -> None:
    model = Model("m", gravity=kind([0, 0, -9.81]))
    body = model.body("b", mass=1.0, mass_center=kind([0, 0, 1]))
    body.frame("f", at=kind([1, 2, 3]))
    model.revolute("j", between=("ground", body), axis=kind([0, 1, 0]))
    assert model.gravity == (0, 0, -9.81)
    assert model.bodies["b"].center == (0, 0, 1)
    assert model.bodies["b"].frames["f"].at == (1, 2, 3)
    assert model.joints[0].axis == (0, 1, 0)


@pytest.mark.parametrize(
    ("mass", "problem"),
    [
        (sympy.nan, "nan is not a finite number"),
        (sympy.oo, "inf is not a finite number"),
        (sympy.Integer(-2), "the mass is negative (-2); it must be 0 or more"),
    ],
    ids=str,
)
def test_numbers_of_sympys_are_checked_like_others(mass: Any, problem: str) -> None:
    assert refusal(lambda: Model("m").body("b", mass=mass)) == f'body "b": {problem}'


def test_an_inertia_matrix_of_symbols() -> None:
    model = Model("m")
    a, b = model.parameter("a", 1.0), model.parameter("b", 2.0)
    model.body("b", inertia=((1, a * b, 0), (b * a, 2, a), (0, a, 3)))
    assert model.bodies["b"].inertia == (1, a * b, 0, 2, a, 3)
    for wrong in (((1, a, 0), (b, 2, 0), (0, 0, 3)), ((1, a, 0), (1, 2, 0), (0, 0, 3))):
        message = refusal(lambda rows=wrong: model.body("c", inertia=rows))  # type: ignore[misc]
        assert message == 'body "c": the inertia matrix is not symmetric'


def test_three_ways_to_give_an_inertia() -> None:
    for given, expected in (
        ((1, 2, 3), (1, 0, 0, 2, 0, 3)),
        (((1, 4, 5), (4, 2, 6), (5, 6, 3)), (1, 4, 5, 2, 6, 3)),
        ([[1, 4, 5], [4, 2, 6], [5, 6, 3]], (1, 4, 5, 2, 6, 3)),
        ({"xx": 1, "yz": 6}, (1, 0, 0, 0, 6, 0)),
        # the rounding of a computed tensor is no asymmetry
        (((1, 0.1 + 0.2, 0), (0.3, 2, 0), (0, 0, 3)), (1, 0.1 + 0.2, 0, 2, 0, 3)),
    ):
        model = Model("m")
        model.body("b", inertia=given)
        assert model.bodies["b"].inertia == expected


# ---- connections


def joined(tail: str, head: str) -> Model:
    model = chain("upper_arm", "fore_arm")
    model.revolute("extra", between=(tail, head))
    return model


@pytest.mark.parametrize(
    ("tail", "head", "hint"),
    [
        ("uper_arm", "fore_arm", 'there is no body or frame "uper_arm"; did you mean "upper_arm"?'),
        ("ground", "forearm", 'there is no body or frame "forearm"; did you mean "fore_arm"?'),
        ("Ground", "fore_arm", 'there is no body or frame "Ground"; did you mean "ground"?'),
        (
            "zz",
            "ground",
            'there is no body or frame "zz"; known: ground, upper_arm, fore_arm',
        ),
    ],
)
def test_a_dangling_terminal_comes_with_a_hint(tail: str, head: str, hint: str) -> None:
    model = joined(tail, head)
    assert refusal(lambda: derive(model)) == f'joint "extra": {hint}'


def test_the_mass_center_is_no_terminal() -> None:
    model = joined("ground", "fore_arm.mass_center")
    assert refusal(lambda: derive(model)).startswith(
        'joint "extra": there is no body or frame "fore_arm.mass_center"; '
    )


@pytest.mark.parametrize(
    ("bodies", "listed"),
    [
        ("abcdefg", "ground, a, b, c, d, e, f, g"),
        ("abcdefgh", "ground, a, b, c, d, e, f, g, ..."),
        ("abcdefghij", "ground, a, b, c, d, e, f, g, ..."),
    ],
)
def test_of_many_names_a_few_are_listed(bodies: str, listed: str) -> None:
    model = chain(*bodies)
    model.revolute("extra", between=("ground", "qqq"))
    assert refusal(lambda: derive(model)).endswith(f"; known: {listed}")


def test_a_joint_must_connect_two_bodies() -> None:
    model = chain("a")
    model.revolute("extra", between=("a", "a"))
    assert refusal(lambda: derive(model)) == 'joint "extra": connects body "a" to itself'
    model = Model("m")
    body = solid(model, "b")
    model.fixed("extra", between=(body.frame("f"), body.frame("g")))
    assert refusal(lambda: derive(model)) == 'joint "extra": connects body "b" to itself'
    model = chain("a")
    model.fixed("extra", between=("ground", model.ground.frame("f")))
    assert refusal(lambda: derive(model)) == 'joint "extra": connects body "ground" to itself'


def test_a_loop_is_a_constraint() -> None:
    """Three hinges on one axis: the last one declared closes the loop and takes nothing away."""
    model = chain("a", "b")
    model.revolute("closing", between=("b", "ground"), axis=(0, 1, 0))
    derivation = derive(model)
    assert derivation.formulation.chords == ("closing",)
    assert [quantity.name for quantity in derivation.structure.positions] == ["j1", "j2"]
    found = derivation.assembled
    assert (len(found.unique), found.rank, found.freedoms) == (5, 0, 2)


def test_of_a_loop_the_joint_with_most_freedom_is_cut() -> None:
    model = Model("m")
    body = solid(model, "b")
    model.planar("plane", between=("ground", body))
    model.revolute("hinge", between=("ground", body))
    model.free("wall", between=("ground", body))
    formulation = derive(model).formulation
    assert formulation.joints == {"hinge"}
    assert formulation.chords == ("plane", "wall")


def test_two_welds_in_parallel_share_what_they_bear() -> None:
    """Statically overdetermined: the motion is as with one, the multipliers are not unique."""
    model = chain("a")
    shelf = solid(model, "shelf", mass_center=(0.1, 0.2, 0.3))
    model.fixed("weld", between=("a", shelf))
    expected = derive(model).numeric().mass_matrix([0.3])
    model.fixed("bolt", between=("a", shelf))
    derivation = derive(model)
    assert derivation.formulation.chords == ("bolt",)
    assert derivation.numeric().mass_matrix([0.3]) == expected
    found = derivation.assembled
    assert (found.rank, found.redundant, found.freedoms) == (0, 6, 1)
    assert not any(found.unique)


def test_a_body_on_two_hinges_of_one_axis_turns() -> None:
    model = chain("a", "b")
    model.fixed("bolt", between=("ground", "b"))
    derivation = derive(model)
    assert derivation.formulation.chords == ("j2",)
    found = derivation.assembled
    assert (found.freedoms, found.redundant) == (1, 5)


def test_unconnected_bodies_are_refused() -> None:
    problem = "nothing connects it to ground; add a joint, a free one if it floats"
    model = chain("a")
    solid(model, "stray")
    assert refusal(lambda: derive(model)) == f'body "stray": {problem}'
    solid(model, "other")
    model.revolute("island", between=("stray", "other"))
    assert refusal(lambda: derive(model)) == f'body "stray": {problem}'


def test_something_must_move() -> None:
    problem = "no joint can move: there is nothing to derive"
    assert refusal(lambda: derive(bolted())) == f'model "m": {problem}'
    locked = chain("a")
    locked.lock("j1", 0.4)
    assert refusal(lambda: derive(locked)) == f'model "chain": {problem}'


def test_an_empty_model_is_refused() -> None:
    assert refusal(lambda: derive(Model("m"))).startswith('model "m": ')


@pytest.mark.parametrize("value", [0.0, -1.0], ids=["of length zero", "minus z"])
def test_a_symbolic_axis_that_has_no_formula_is_refused(value: float) -> None:
    model = Model("m")
    axis = (model.parameter("ax", 0.0), 0, model.parameter("az", value))
    model.revolute("j", between=("ground", solid(model, "b")), axis=axis)
    assert refusal(lambda: derive(model)).startswith('joint "j": ')


def bolted() -> Model:
    model = Model("m")
    model.fixed("bolt", between=("ground", solid(model, "b")))
    return model


# ---- couplings and locks


def coupled(*pairs: tuple[str, str]) -> Model:
    model = chain("a", "b", "c")
    model.planar("table", between=("ground", solid(model, "puck")))
    for joint, master in pairs:
        model.couple(joint, master)
    return model


@pytest.mark.parametrize(
    ("pairs", "message"),
    [
        ([("j1", "j2"), ("j1", "j3")], 'joint "j1": is coupled twice'),
        ([("j1", "j1")], 'joint "j1": follows itself through a circle of couplings'),
        (
            [("j1", "j2"), ("j2", "j3"), ("j3", "j1")],
            'joint "j1": follows itself through a circle of couplings',
        ),
        (
            [("j2", "j3"), ("j3", "j2"), ("j1", "j2")],
            'joint "j2": follows itself through a circle of couplings',
        ),
        ([("j1", "j4")], 'joint "j1": cannot follow: "j4" is not a joint of one freedom'),
        ([("j4", "j1")], 'joint "j4": cannot follow: "j4" is not a joint of one freedom'),
        ([("j1", "table")], 'joint "j1": cannot follow: "table" is not a joint of one freedom'),
        ([("table", "j1")], 'joint "table": cannot follow: "table" is not a joint of one freedom'),
    ],
)
def test_impossible_couplings_are_refused(pairs: list[tuple[str, str]], message: str) -> None:
    assert refusal(lambda: derive(coupled(*pairs))) == message


def test_a_chain_of_couplings_is_composed() -> None:
    """q1 = 2 (3 q3 + 5) + 7: one coordinate, and rates of ratio 6."""
    model = chain("a", "b", "c")
    model.couple("j1", "j2", ratio=2, offset=7)
    model.couple("j2", "j3", ratio=3, offset=5)
    tree = derive(model).numeric().tree
    first = tree.links[0].place.positions[0]
    assert (first.index, first.ratio, first.offset) == (0, 6, 17)
    assert tree.links[0].velocities[0].ratio == 6
    assert [quantity.name for quantity in tree.positions] == ["j3"]
    assert tree.layout.efforts == [(0, 0)]


def test_only_joints_that_exist_can_be_locked() -> None:
    problem = 'there is no such joint to lock; did you mean "j2"?'
    assert refusal(lambda: chain("a", "b").lock("j22")) == f'joint "j22": {problem}'
    problem = "there is no such joint to lock; known: j1, j2"
    assert refusal(lambda: chain("a", "b").lock("elbow")) == f'joint "elbow": {problem}'
    problem = "is planar; only joints of one freedom can be locked"
    assert refusal(lambda: coupled().lock("table")) == f'joint "table": {problem}'


def test_what_follows_a_locked_joint_is_locked_with_it() -> None:
    """Locking the master at 0.3 is locking both, each at its own value."""
    model = chain("a", "b", "c")
    model.couple("j1", "j2", ratio=2, offset=7)
    model.couple("j2", "j3", ratio=3, offset=5)
    model.revolute("j4", between=("c", solid(model, "d", mass_center=(0.1, 0, 0))))
    moving = derive(model).numeric()
    model.lock("j3", 0.3)
    locked = derive(model).numeric()
    assert [quantity.name for quantity in locked.tree.positions] == ["j4"]
    assert model.couplings == ()
    expected = moving.mass_matrix([0.3, 0.8])[1][1]
    assert locked.mass_matrix([0.8])[0][0] == pytest.approx(expected, rel=1e-14)
    expected = moving.bias([0.3, 0.8], [0.0, 1.1])[1]
    assert locked.bias([0.8], [1.1])[0] == pytest.approx(expected, rel=1e-14)


def test_locking_a_joint_on_a_terminal_that_is_not_there() -> None:
    model = Model("m")
    model.revolute("j", between=("grund", solid(model, "b")))
    message = 'joint "j": there is no body or frame "grund"; did you mean "ground"?'
    assert refusal(lambda: model.lock("j")) == message


def test_what_follows_by_a_symbolic_ratio_is_locked_too() -> None:
    model = chain("a", "b", "c")
    model.couple("j2", "j1", ratio=model.parameter("r", 2.0), offset=0.3)
    moving = derive(model).numeric()
    model.lock("j1", 0.5)
    locked = derive(model).numeric()
    expected = moving.mass_matrix([0.5, 0.8])[1][1]
    assert locked.mass_matrix([0.8])[0][0] == pytest.approx(expected, rel=1e-14)
    expected = moving.bias([0.5, 0.8], [0.0, 1.1])[1]
    assert locked.bias([0.8], [1.1])[0] == pytest.approx(expected, rel=1e-14)


def test_a_locked_joint_cannot_lead() -> None:
    model = chain("a", "b")
    model.lock("j1")
    model.couple("j2", "j1")
    message = 'joint "j2": cannot follow: "j1" is not a joint of one freedom'
    assert refusal(lambda: derive(model)) == message


# ---- singular mass matrices


def singular(model: Model) -> str:
    """The name of the joint that is blamed for a singular mass matrix, by what divides by it alone."""
    derivation = derive(model)
    with pytest.raises(ModelError, match="moves no inertia of its own") as caught:
        derivation.require_inverse("forward_dynamics")
    problem = caught.value.problem
    assert "the mass matrix is singular, and forward_dynamics divides by it" in problem
    assert "Give the bodies it carries mass" in problem
    assert "or lock or fix the joint" in problem
    kind, name = caught.value.thing.split(" ")
    assert kind == "joint"
    return name.strip('"')


def test_a_massless_leaf() -> None:
    model = chain("a", "b")
    model.revolute("tip", between=("b", model.body("empty")), axis=(1, 0, 0))
    assert singular(model) == "tip"
    model.lock("tip")
    assert not derive(model).idle


def test_a_massless_leaf_before_others() -> None:
    """The joint is named wherever it stands in the order of coordinates."""
    model = Model("m")
    model.prismatic("tip", between=("ground", model.body("empty")))
    model.revolute("j", between=("ground", solid(model, "a")))
    assert singular(model) == "tip"


def test_a_massless_body_with_inertia_about_its_hinge_is_fine_and_about_another_axis_not() -> None:
    model = chain("a")
    wheel = model.body("wheel", inertia=(0, 0, 0.1))
    model.revolute("spin", between=("a", wheel), axis=(0, 0, 1))
    derive(model)
    model = chain("a")
    wheel = model.body("wheel", inertia=(0, 0, 0.1))
    model.revolute("spin", between=("a", wheel), axis=(1, 0, 0))
    assert singular(model) == "spin"
    model = chain("a")
    wheel = model.body("wheel", inertia=(0, 0, 0.1))
    model.prismatic("slide", between=("a", wheel), axis=(0, 0, 1))
    assert singular(model) == "slide"


def test_a_last_axis_through_a_point_mass() -> None:
    model = chain("a")
    bob = model.body("bob", mass=2.0, mass_center=(0, 0, 0.7))
    model.revolute("twist", between=("a", bob), axis=(0, 0, 1))
    assert singular(model) == "twist"
    model = chain("a")
    bob = model.body("bob", mass=2.0, mass_center=(0, 0, 0.7))
    model.revolute("swing", between=("a", bob), axis=(1, 0, 0))
    derive(model)


def test_an_axis_through_all_the_mass_beyond() -> None:
    """Not the leaf's joint, whose body moves, but the one before it, in a body with a point mass."""
    model = Model("m")
    post = model.body("post", mass=1.0, mass_center=(0, 0, 1))
    model.revolute("twist", between=("ground", post), axis=(0, 0, 1))
    bead = model.body("bead", mass=1.0)
    model.prismatic("slide", between=(post, bead), axis=(0, 0, 1))
    assert singular(model) == "twist"


@pytest.mark.parametrize("order", [("inner", "outer"), ("outer", "inner")], ids=" ".join)
def test_two_coaxial_joints_with_nothing_between(order: tuple[str, str]) -> None:
    """The inner joint is to blame, which carries the empty body, whatever the order of coordinates."""
    model = Model("m")
    empty, wheel = model.body("empty"), solid(model, "wheel")
    ends = {"inner": ("ground", empty), "outer": (empty, wheel)}
    for name in order:
        model.revolute(name, between=ends[name])
    assert singular(model) == "inner"


@pytest.mark.parametrize("seed", range(40))
def test_a_point_mass_on_an_axis_of_general_direction(seed: int) -> None:
    """M_kk is zero up to rounding, which must not pass for inertia; a little off the axis it is some."""
    for away, refused in ((0.0, True), (1e-4, False)):
        rng = np.random.default_rng(seed)
        model = Model("m", gravity=rng.normal(size=3))
        arm = solid(model, "arm", mass_center=(0.1, 0.2, 0.3))
        center, turn = rng.normal(size=3), trees.random_rotation(rng)
        bead = model.body("bead", mass=float(rng.uniform(0.01, 100)), mass_center=center)
        at = center - 0.7 * turn[:, 2] + away * turn[:, 0]
        tip = arm.frame("tip", at=rng.normal(size=3), rotation=trees.random_rotation(rng))
        model.revolute("turn", between=("ground", arm))
        model.revolute("twist", between=(tip, bead.frame("hub", at=at, rotation=turn)))
        if refused:
            assert singular(model) == "twist"
        else:
            derive(model)


def random_moments(rng: np.random.Generator, principal: list[float], mass: float) -> Link:
    """A link of this mass and these central moments, turned and shifted at random."""
    turn, center = trees.random_rotation(rng), rng.normal(size=3)
    inertia = turn @ np.diag(principal) @ turn.T
    about = inertia + mass * (center @ center * np.eye(3) - np.outer(center, center))
    upper = tuple(float(about[i, j]) for i in range(3) for j in range(i, 3))
    second = second_moments(upper)  # type: ignore[arg-type]
    moments = Moments(mass, tuple((mass * center).tolist()), second)  # type: ignore[arg-type]
    joint = Revolute("j", ("ground", "b"))
    return Link("b", -1, joint, True, Rotation(), ZERO, Place(), moments)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize(
    ("principal", "mass", "expected"),
    [
        ([0.1, 0.2, 0.25], 2.0, True),
        ([1e-3, 0.2, 0.2], 2.0, True),
        ([0.0, 0.2, 0.2], 2.0, False),
        ([0.0, 0.0, 0.0], 2.0, False),
        ([-0.1, 0.2, 0.2], 2.0, False),
        ([-0.1, -0.1, 0.2], 2.0, False),
        ([-0.1, -0.1, -0.1], 2.0, False),
        ([0.1, 0.2, 0.25], 0.0, False),
        ([0.1, 0.2, 0.25], -2.0, False),
    ],
    ids=str,
)
def test_a_body_is_solid_when_its_central_moments_are_positive(
    principal: list[float], mass: float, expected: bool, seed: int
) -> None:
    assert is_solid(random_moments(np.random.default_rng(seed), principal, mass)) == expected


@pytest.mark.parametrize(
    "inertia", [(-1, -1, -1), (0.1, 0.1, -0.1)], ids=["throughout", "about its axis"]
)
def test_what_is_negative_is_called_negative(inertia: tuple[float, ...]) -> None:
    model = chain("a")
    model.revolute("turn", between=("a", model.body("tip", inertia=inertia)), axis=(0, 0, 1))
    problem = (
        "moves a mass or inertia that is negative (tip): the mass matrix is not positive definite"
    )
    assert refusal(lambda: derive(model)) == f'joint "turn": {problem}'
    model = Model("m")
    mass = model.parameter("mass", -1)
    model.prismatic("slide", between=("ground", model.body("b", mass=mass)))
    assert refusal(lambda: derive(model)).startswith(
        'joint "slide": moves a mass or inertia that is n'
    )


def test_three_sliders_in_a_plane() -> None:
    model = Model("m")
    first, second = model.body("first"), model.body("second")
    model.prismatic("x", between=("ground", first), axis=(1, 0, 0))
    model.prismatic("y", between=(first, second), axis=(0, 1, 0))
    model.prismatic("slant", between=(second, solid(model, "load")), axis=(3, 4, 0))
    assert singular(model) in ("x", "y")


def test_crossed_massless_bodies_are_fine() -> None:
    """A cardan joint: the cross between two hinges weighs nothing."""
    model = Model("m")
    cross, load = model.body("cross"), solid(model, "load")
    model.revolute("one", between=("ground", cross), axis=(1, 0, 0))
    model.revolute("two", between=(cross, load), axis=(0, 1, 0))
    mass = np.array(derive(model).numeric().mass_matrix([0.3, 0.4]))
    assert np.linalg.eigvalsh(mass)[0] > 0.05


def test_a_position_that_is_singular_by_itself_is_no_reason() -> None:
    """A point mass on two massless links: M is singular where they stretch, and only there."""
    model = Model("m")
    arm = model.body("arm")
    bob = model.body("bob", mass=1.0, mass_center=(0, 0, -1))
    model.revolute("one", between=("ground", arm), axis=(0, 1, 0))
    model.revolute("two", between=(arm.frame("tip", at=(0, 0, -1)), bob), axis=(0, 1, 0))
    numeric = derive(model).numeric()
    assert abs(np.linalg.det(numeric.mass_matrix([0.2, 0.0]))) < 1e-15
    assert np.linalg.det(numeric.mass_matrix([0.2, 1.0])) > 0.5


def test_a_follower_moves_with_its_master() -> None:
    """A massless leaf whose joint follows another has no row of M of its own."""
    model = chain("a")
    model.revolute("tip", between=("a", model.body("empty")))
    model.couple("tip", "j1", ratio=-1)
    assert derive(model).numeric().mass_matrix([0.1])[0][0] > 0


def test_parameters_without_values_count_as_mass() -> None:
    model = Model("m")
    model.prismatic("j", between=("ground", model.body("b", mass=model.parameter("m"))))
    derive(model)
    empty = Model("m")
    bob = empty.body("b", mass=empty.parameter("m"), mass_center=(0, 0, empty.parameter("l")))
    empty.revolute("twist", between=("ground", bob), axis=(0, 0, 1))
    assert singular(empty) == "twist"


# ---- parameters


def test_a_parameter_of_no_model_is_refused() -> None:
    model = Model("m")
    model.prismatic("j", between=("ground", model.body("b", mass=Parameter("m", 2.0))))
    assert refusal(lambda: derive(model)) == 'parameter "m": does not belong to this model'


def test_a_parameter_without_a_value_is_named() -> None:
    for factor in (1, 2):
        model = Model("m")
        mass = model.parameter("m")
        body = model.body("b", mass=mass if factor == 1 else factor * mass)
        model.prismatic("j", between=("ground", body))
        derivation = derive(model)
        assert refusal(derivation.numeric) == 'parameter "m": has no value'
        assert derivation.numeric({"m": 3.0}).mass_matrix([0.0]) == [[3.0 * factor]]


def test_of_several_wrong_names_the_same_is_named_each_time() -> None:
    """No message depends on the order in which Python hashes text."""
    script = (
        "from linegraph import Model, ModelError, derive; m = Model('m');"
        "b = [m.body(n, mass=1, inertia=(1, 1, 1)) for n in 'abcd'];"
        "m.planar('a', between=('ground', b[0]));"
        "[m.revolute(n, between=(b[0], x)) for n, x in zip(('a_x', 'a_y', 'a_angle'), b[1:])]\n"
        "try: derive(m)\nexcept ModelError as e: print(e)"
    )
    root = Path(__file__).parents[2]
    found = {
        subprocess.run(
            [sys.executable, "-c", script],
            cwd=root,
            env={**os.environ, "PYTHONHASHSEED": str(seed)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in range(6)
    }
    own = 'joint "a_x": its coordinate "a_x"'
    assert found == {f'{own} has the name of a coordinate of joint "a"; rename one\n'}


@pytest.mark.parametrize(
    "build",
    [
        lambda m: m.revolute("j", between=("ground", m.body("b", mass=1)), axis=("print(1)", 0, 1)),
        lambda m: m.ground.frame("f", rpy=("print(1)", 0, 0)),
        lambda m: m.ground.frame("f", axis=(0, 0, 1), angle="print(1)"),
    ],
    ids=["axis", "rpy", "angle"],
)
def test_text_never_reaches_sympy(
    build: Callable[[Model], Any], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(ModelError, match="not text"):
        build(Model("m"))
    assert capsys.readouterr().out == ""


def test_the_numeric_reference_takes_all_inputs_or_none() -> None:
    model = Model("m")
    model.prismatic("j", between=("ground", model.body("b", mass=2)), effort=False)
    push = model.input("push", "N")
    model.load("load", at="b", force=(0, 0, push))
    derivation = derive(model)
    assert derivation.numeric().bias([0.0], [0.0]) == [2 * 9.81]
    assert derivation.numeric(u=[3.0]).bias([0.0], [0.0]) == [2 * 9.81]
    with pytest.raises(ModelError, match="u: 1 inputs are needed, got 2"):
        derivation.numeric(u=[1.0, 2.0])


# ---- the errors themselves


def test_errors_keep_their_parts() -> None:
    error = SourceError("arm.urdf", 12, 'joint "elbow"', "is wrong")
    assert isinstance(error, ModelError)
    assert isinstance(error, LinegraphError)
    assert str(error) == 'arm.urdf:12: joint "elbow": is wrong'
    assert (error.source, error.line, error.thing) == ("arm.urdf", 12, 'joint "elbow"')
    assert str(SourceError("arm.urdf", None, "", "is empty")) == "arm.urdf: is empty"
    assert str(ModelError("", "all of it is wrong")) == "all of it is wrong"

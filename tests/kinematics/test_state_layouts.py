"""Which coordinates and inputs a model has, in which order, and which joint reads which."""

from __future__ import annotations

import math

import pytest
from support.chains import PLANE, modelled, walked

import linegraph as lg
from linegraph.algebra.jets import Jet
from linegraph.components.joints import Cylindrical, Free, Planar, Revolute, Spherical, Universal
from linegraph.kinematics.state_layout import (
    Freedom,
    Place,
    coordinates,
    has_plain_rates,
    own_rates,
)

ENDS = ("a", "b")


def names(entries: object) -> list[str]:
    return [x.name for x in entries]  # type: ignore[attr-defined]


def mixed() -> lg.Model:
    """A float, a hinge, a slide without effort, a driven hinge and an input; not in the tree's order."""
    model = lg.Model("mixed")
    a, b, c, d = (model.body(x, mass=1.0, inertia=(1, 1, 1)) for x in "abcd")
    model.prismatic("slide", between=(b, c), effort=False)
    model.free("float", between=("ground", a))
    model.revolute("driven", between=(c, d), motion="input")
    model.revolute("hinge", between=(a, b))
    model.input("u", unit="N")
    return model


def test_coordinates_stand_in_declared_order_and_quaternions_have_one_more() -> None:
    tree = walked(mixed(), u=[0.0] * 5)
    assert names(tree.positions) == [
        *("slide", "float_x", "float_y", "float_z"),
        *("float_qx", "float_qy", "float_qz", "float_qw", "hinge"),
    ]
    assert len(tree.velocities) == 8
    assert tree.velocities[0].unit == "m/s"
    assert tree.layout.places["hinge"] == Place((Freedom(8),), (Freedom(7),))
    assert tree.layout.mechanical == 8


def test_inputs_are_efforts_then_named_ones_then_prescribed_motions() -> None:
    tree = walked(mixed(), u=[0.0, 10.0, 20.0, 30.0, 40.0])
    # the float has no efforts unless they are asked for, and the slide is told to have none
    assert names(tree.inputs) == ["hinge", "u", "driven", "driven_rate", "driven_acceleration"]
    assert [q.unit for q in tree.inputs] == ["N*m", "N", "rad", "rad/s", "rad/s^2"]
    assert tree.layout.efforts == [(7, 0)]
    (jet,) = tree.layout.places["driven"].drive
    assert (jet.x, jet.dx, jet.ddx) == (20.0, 30.0, 40.0)
    assert tree.layout.slopes == {2: 3}
    assert tree.layout.named_inputs == {"u": 10.0}


def test_a_motion_given_in_t_has_its_derivatives() -> None:
    model = modelled(PLANE[:1])
    model.body("door", mass=1.0, inertia=(1, 1, 1))
    model.revolute("driven", between=("b0", "door"), motion="0.3*sin(2*t) + t**2")
    tree = walked(model, t=0.7)
    (jet,) = tree.layout.drives["driven"]
    assert jet.x == pytest.approx(0.3 * math.sin(1.4) + 0.49, abs=1e-15)
    assert jet.dx == pytest.approx(0.6 * math.cos(1.4) + 1.4, abs=1e-15)
    assert jet.ddx == pytest.approx(-1.2 * math.sin(1.4) + 2.0, abs=1e-15)
    assert coordinates(tree.layout.places["driven"], (), ()) == ((jet.x,), (jet.dx,))


def test_chains_of_couplings_are_composed_to_the_joint_that_leads() -> None:
    model = modelled(PLANE)
    model.couple("j2", to="j1", ratio=-2.0, offset=0.5)
    model.couple("j1", to="j0", ratio=3.0, offset=0.25)
    tree = walked(model)
    assert names(tree.positions) == ["j0"]
    # q2 = -2 q1 + 0.5 = -2 (3 q0 + 0.25) + 0.5
    assert tree.layout.places["j2"] == Place((Freedom(0, -6.0, 0.0),), (Freedom(0, -6.0),))
    assert coordinates(tree.layout.places["j1"], (0.1,), (0.2,)) == (
        (pytest.approx(0.55),),
        (pytest.approx(0.6),),
    )
    assert names(tree.inputs) == ["j0"]


def test_a_follower_of_a_driven_joint_is_driven() -> None:
    model = modelled(PLANE[:2])
    model.body("door", mass=1.0, inertia=(1, 1, 1))
    model.revolute("driven", between=("b1", "door"), motion="t**2")
    model.couple("j1", to="driven", ratio=3.0, offset=1.0)
    tree = walked(model, t=2.0)
    (jet,) = tree.layout.places["j1"].drive
    assert (jet.x, jet.dx, jet.ddx) == (13.0, 12.0, 6.0)


def test_couplings_in_a_circle_are_refused() -> None:
    model = modelled(PLANE)
    model.couple("j2", to="j1")
    model.couple("j1", to="j2")
    with pytest.raises(lg.ModelError, match="follows itself through a circle"):
        walked(model)


def test_only_joints_of_one_freedom_can_be_coupled() -> None:
    model = modelled(PLANE)
    model.body("end", mass=1.0, inertia=(1, 1, 1))
    model.spherical("ball", between=("b2", "end"))
    model.couple("j2", to="ball")
    with pytest.raises(lg.ModelError, match='"ball" is not a joint of one freedom'):
        walked(model)


def test_as_many_motions_as_coordinates_are_wanted() -> None:
    model = modelled(PLANE)
    model.body("end", mass=1.0, inertia=(1, 1, 1))
    model.cylindrical("rod", between=("b2", "end"), motion=["t"])
    with pytest.raises(lg.ModelError, match="prescribes 1 motions for 2 coordinates"):
        walked(model, t=0.0)


def test_a_ball_cannot_be_driven_since_its_velocities_are_no_rates() -> None:
    model = modelled(PLANE)
    model.body("end", mass=1.0, inertia=(1, 1, 1))
    model.spherical("ball", between=("b2", "end"), motion="input")
    with pytest.raises(lg.ModelError, match="v is not the derivative of q"):
        walked(model, u=[0.0] * 20)


def test_a_motion_without_derivatives_at_a_time_is_refused_there() -> None:
    model = modelled(PLANE[:1])
    model.body("door", mass=1.0, inertia=(1, 1, 1))
    model.revolute("driven", between=("b0", "door"), motion="sqrt(t)")
    with pytest.raises(lg.ModelError, match="no finite value, rate and acceleration"):
        walked(model, t=0.0)
    tree = walked(model, t=4.0)
    (jet,) = tree.layout.drives["driven"]
    assert (jet.x, jet.dx, jet.ddx) == (2.0, 0.25, -1 / 32)


@pytest.mark.parametrize(
    ("joint", "plain"),
    [
        (Revolute("j", ENDS), True),
        (Cylindrical("j", ENDS), True),
        (Universal("j", ENDS), True),
        (Planar("j", ENDS), False),
        (Spherical("j", ENDS), False),
        (Free("j", ENDS), False),
    ],
)
def test_v_is_the_derivative_of_q_of_joints_whose_axes_are_not_carried_along(
    joint: Revolute, plain: bool
) -> None:
    assert has_plain_rates(joint) is plain


def test_an_angle_measured_from_ground_is_less_by_what_the_near_body_has_turned() -> None:
    model = modelled((PLANE[0], PLANE[1]._replace(axis=(0, 0, -1))))
    model.formulation(coordinates="absolute-angle")
    tree = walked(model)
    place = tree.layout.places["j1"]
    assert place.level
    assert not place.in_space
    assert "against ground" in tree.positions[1].about
    # about -z, body 1 has turned by q1 - q0: q1's own angle is its own plus that of the near body
    assert coordinates(place, (0.3, 0.5), (1.0, 4.0)) == ((0.8,), (5.0,))
    assert own_rates(place, (1.0, 4.0)) == (4.0,)
    assert tree.layout.efforts == []
    assert tree.layout.pushes == {"j0": 0, "j1": 1}


def test_a_body_on_its_inertia_edge_has_coordinates_of_its_own_name() -> None:
    model = modelled(PLANE[:1])
    model.formulation(coordinates="absolute")
    tree = walked(model)
    assert names(tree.positions)[:3] == ["b0_x", "b0_y", "b0_z"]
    assert tree.layout.stems == {"b0": "b0"}
    assert tree.layout.own("b0") == tree.layout.places["b0"]
    assert tree.layout.own("j0") is None
    assert tree.layout.pushes == {"j0": 0}


def test_what_drives_a_rod_is_its_length_and_its_rates() -> None:
    model = modelled(PLANE)
    model.rod("strut", between=("ground", "b2"), length="0.6 + 0.1*t")
    tree = walked(model, t=1.0)
    (jet,) = tree.layout.drives["strut"]
    assert isinstance(jet, Jet)
    assert (jet.x, jet.dx, jet.ddx) == (pytest.approx(0.7), 0.1, 0)

"""Variables of edges: beams and hinges by hand, each body's own balance, power."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from oracles import newton_euler as oracle
from support.chains import LIMB, LIMB_STATE, modelled, poses
from support.drawn_trees import KINDS, drawn
from support.inverse_schemes import scheme
from support.linkages import BASE, COUPLER, CRANK, ROCKER, closed, four_bar, gap
from support.near import near
from support.rigid_motion import TINY, moving

import linegraph as lg
from linegraph.dynamics.edge_quantities import powers

if TYPE_CHECKING:
    from linegraph.dynamics.edge_variables import InverseScheme

G = 9.81


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kinds", KINDS)
def test_joints_transmit_what_the_bodies_beyond_them_need(kinds: str, seed: int) -> None:
    here = drawn(seed, kinds)
    spec, q, v, a = here.spec, here.q, here.v, here.a
    found = scheme(here.model, q, v, a, u=[0] * spec.nv)
    expected = oracle.reactions(spec, q, v, a)
    motions = oracle.body_motions(spec, q, v)
    for joint in spec.joints:
        wrench = found.reaction(joint.name)
        size = 1e-13 * (1 + max(np.abs(x).max() for x in expected.values()))
        np.testing.assert_allclose(wrench, expected[joint.name], rtol=0, atol=10 * size)
        head = motions[joint.head].rotation @ joint.head_rotation
        seen = expected[joint.name] @ head.T
        np.testing.assert_allclose(found.joints[joint.name], seen, rtol=0, atol=10 * size)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kinds", KINDS)
def test_inertia_edges_take_what_joints_deliver(kinds: str, seed: int) -> None:
    """Through times across sums up to zero; joints deliver τ v, inertia edges take the rate of energy."""
    here = drawn(seed, kinds)
    spec, q, v, a = here.spec, here.q, here.v, here.a
    edges = scheme(here.model, q, v, a, u=[0] * spec.nv).edges()
    found, sums = powers(edges)
    size = 1 + max(map(abs, found.values()))
    assert max(map(abs, sums)) < 1e-13 * size
    delivered = oracle.inverse_dynamics(spec, q, v, a) @ v
    joints = sum(
        found[f"{joint.name}.{kind}"]
        for joint in spec.joints
        for kind in ("translation", "rotation", "lever")
    )
    assert joints == pytest.approx(delivered, abs=1e-13 * size)
    bodies = sum(
        found[f"{body.name}/inertia.{kind}"]
        for body in spec.bodies
        for kind in ("translation", "rotation")
    )
    assert bodies == pytest.approx(-delivered, abs=1e-13 * size)


def test_terminals_and_mass_centres_move_as_their_poses() -> None:
    q, v = LIMB_STATE
    model = modelled(LIMB)
    found = scheme(model, q, v, [0] * 7)
    for name, k, place in (("b4", 4, (0, 0, 0)), ("b3.mass_center", 3, LIMB[3].center)):
        here = moving(lambda t, k=k: poses(LIMB, q + t * v)[k])  # type: ignore[misc]
        frame = found.terminal(name)
        arm, w = here.rotation @ place, here.angular
        near(frame.rotation, here.rotation)
        near(frame.origin, here.place + arm)
        near(frame.linear, here.linear + np.cross(w, arm))
        near(frame.angular, w)
        pull = here.pull + np.cross(here.spin, arm) + np.cross(w, np.cross(w, arm))
        near(frame.pull, pull, 1e-9)
        near(frame.spin, here.spin, 1e-9)


def test_across_variables_are_head_less_tail() -> None:
    q, v = LIMB_STATE
    model = modelled(LIMB)
    eye = model.ground.frame("eye", at=(0.4, 0.6, -0.2))
    model.spring("coil", between=(eye, "b4"), stiffness=1.0)
    model.damper("brake", joint="j0", damping=1.0)
    model.load("push", at="b2", force=(1, 0, 0))
    found = scheme(model, q, v).across()
    bodies = [moving(lambda t, k=k: poses(LIMB, q + t * v)[k]) for k in range(5)]  # type: ignore[misc]
    near(found["coil"], [bodies[4].linear, bodies[4].angular])
    near(found["push"], [bodies[2].linear, bodies[2].angular])
    # j3 points to ground: its tail is a frame of b3, its head b1's origin
    tail = bodies[3].linear + np.cross(bodies[3].angular, bodies[3].rotation @ LIMB[3].far[0])
    near(found["j3"], [bodies[1].linear - tail, bodies[1].angular - bodies[3].angular])
    near(found["brake"], found["j0"])
    center = bodies[2].linear + np.cross(bodies[2].angular, bodies[2].rotation @ LIMB[2].center)
    near(found["b2/inertia"], [center, bodies[2].angular])
    rigid = "b4/arm"
    near(found[rigid][1], [0, 0, 0])
    arm = bodies[4].rotation @ LIMB[4].center
    near(found[rigid][0], -np.cross(bodies[4].angular, arm))


def beam() -> lg.Model:
    """A bar along x of 2 m on a hinge about z, with everything on it that may act."""
    model = lg.Model("beam", gravity=(0, -G, 0))
    bar = model.body("bar", mass=3.0, mass_center=(1.0, 0, 0), inertia=(0.1, 0.2, 0.25))
    tip = bar.frame("tip", at=(2.0, 0, 0))
    model.revolute("hinge", between=("ground", bar))
    model.spring("stay", between=(model.ground.frame("top", at=(2.0, 1.5, 0)), tip), stiffness=40.0)
    model.damper("brake", joint="hinge", damping=0.7)
    model.load("push", at=tip, force=(5.0, -2.0, 1.0), torque=(0.3, 0, 0))
    return model


def test_a_hinge_carries_what_springs_loads_and_weight_leave() -> None:
    """Turning at 1.2 rad/s: what the motion takes, less 60 N of the stay, the push and the weight."""
    w, spin = 1.2, -0.4
    found = scheme(beam(), [0.0], [w], [spin], u=[0.0])
    stay, push, weight = np.array([0, 60.0, 0]), np.array([5.0, -2, 1]), np.array([0, -3 * G, 0])
    needed = 3.0 * np.array([-(w**2) * 1.0, spin * 1.0, 0])
    force = needed - stay - push - weight
    near(found.joints["hinge"].force, force)
    moments = np.cross([2, 0, 0], stay + push) + np.cross([1, 0, 0], weight) + [0.3, 0, 0]
    torque = [0, 0, (0.25 + 3.0) * spin] - moments
    # the damper has an edge of its own: the hinge's torque leaves it out
    near(found.joints["hinge"].torque, torque + np.array([0, 0, 0.7 * w]))
    near(found.elements["brake"].through.torque, [0, 0, -0.7 * w])
    near(found.elements["stay"].through.force, stay)
    near(found.elements["push"].through.force, push)
    near(found.elements["push"].through.torque, [0.3, 0, 0])


def test_what_a_body_asks_for_is_an_edge_from_ground() -> None:
    w, spin = 1.2, -0.4
    edge = scheme(beam(), [0.0], [w], [spin]).inertia("bar")
    near(edge.through.force, [3.0 * w**2, -3.0 * (spin + G), 0])
    near(edge.through.torque, [0, 0, -0.25 * spin])
    near(edge.linear, [0, w, 0])
    near(edge.angular, [0, 0, w])


def test_a_body_with_a_first_moment_has_the_inertia_edge_of_its_centre() -> None:
    """Inertia about the origin, m (r.r 1 - r r^T) more than about the centre; the body spins freely."""
    mass, center = 1.3, np.array([0.2, -0.1, 0.4])
    central = np.array([[0.5, 0.02, -0.03], [0.02, 0.6, 0.01], [-0.03, 0.01, 0.7]])
    about = central + mass * (center @ center * np.eye(3) - np.outer(center, center))
    edges = []
    for given in (
        {"mass_center": tuple(center), "inertia": tuple(map(tuple, central))},
        {"first_moment": tuple(mass * center), "inertia": tuple(map(tuple, about))},
    ):
        model = lg.Model("two ways")
        body = model.body("body", mass=mass, **given)
        model.free("pose", between=("ground", body))
        q, v = [0, 0, 0, 0.1, 0.5, -0.5, 0.7], [0.3, 0.4, -0.2, 1.1, -0.7, 0.9]
        a = [0.2, 0.1, -0.3, 0.8, -1.2, 0.5]
        edges.append(scheme(model, q, v, a).inertia("body"))
    one, two = edges
    near(two.through, one.through)
    assert np.abs(one.through.torque).max() > 0.1


def test_an_edge_between_moving_points_has_a_lever_on_its_tail() -> None:
    """The torque on the tail of a force at the head, about the tail: what balances power in rotation."""
    q, v = LIMB_STATE
    model = modelled(LIMB)
    model.spring("coil", between=("b2", "b4"), stiffness=3.0, length=0.1)
    found = scheme(model, q, v, [0.1] * 7, u=[0] * 7)
    edge = found.elements["coil"]
    at = poses(LIMB, q)
    line = at[4][:3, 3] - at[2][:3, 3]
    pull = -3.0 * (np.linalg.norm(line) - 0.1) * line / np.linalg.norm(line)
    near(edge.through.force, pull)
    near(edge.through.torque, [0, 0, 0])
    near(edge.lever, [0, 0, 0])  # a central force has none
    joint = found.edges()["j2"]
    tail, head = (found.terminal(end) for end in ("b1.f2near", "b2.f2far"))
    offset = np.subtract(head.origin, tail.origin)
    near(joint.lever, -np.cross(offset, joint.through.force))
    near(joint.turning, tail.angular)
    _, sums = powers(found.edges())
    near(sums, [0, 0], 1e-12)


def test_the_tension_of_an_element_goes_with_its_length() -> None:
    model = beam()
    (stay,) = (e for e in model.system().elements if e.name == "stay")
    (brake,) = (e for e in model.system().elements if e.name == "brake")
    found = scheme(model, [0.3], [1.2])
    tip = 2 * np.array([math.cos(0.3), math.sin(0.3)])
    length = float(np.hypot(*(tip - [2.0, 1.5])))
    near(found.tension(stay), [length, 40.0 * length])  # type: ignore[arg-type]
    near(found.tension(brake), [0.3, 0.7 * 1.2])  # type: ignore[arg-type]


@pytest.mark.parametrize(("axes", "lean"), [("tail", 0.7), ("head", 1.1), ("ground", 0.0)])
def test_reactions_are_seen_in_the_chosen_axes(axes: str, lean: float) -> None:
    model = lg.Model("nail", gravity=(0, -G, 0))
    nail = model.ground.frame("nail", at=(0.1, 0.2, 0), axis=(0, 0, 1), angle=0.7)
    bob = model.body("bob", mass=2.0, mass_center=(0.5, 0, 0))
    model.revolute("hinge", between=(nail, bob))
    model.formulation(reactions=axes)
    force, torque = scheme(model, [0.4], [0.0], [0.0], u=[0.0]).reaction("hinge")
    weight = 2.0 * G
    near(force, [weight * math.sin(lean), weight * math.cos(lean), 0])
    near(torque, [0, 0, weight * 0.5 * math.cos(1.1)])


def test_a_prescribed_joint_tells_what_drives_it() -> None:
    """A cart that is led, with a swinging bar: F = (m1 + m2) x'' + d/dt (m2 c w cos)."""
    m1, m2, c = 2.0, 0.8, 0.6
    model = lg.Model("led", gravity=(0, -G, 0))
    cart = model.body("cart", mass=m1)
    bar = model.body("bar", mass=m2, mass_center=(0, -c, 0), inertia={"zz": 0.1})
    model.prismatic("rail", between=("ground", cart), axis=(1, 0, 0), motion="0.2*sin(3*t)")
    model.revolute("swing", between=(cart, bar))
    t, angle, w, spin = 0.4, 0.5, 1.7, -2.2
    found = scheme(model, [angle], [w], [spin], t=t, u=[0.0])
    pull = -1.8 * math.sin(3 * t)
    force = (m1 + m2) * pull + m2 * c * (spin * math.cos(angle) - w**2 * math.sin(angle))
    assert found.drives() == {"rail": pytest.approx(force, abs=1e-13)}
    assert scheme(beam(), [0.1], [0.0], [0.0], u=[0.0]).drives() == {}


# a loop: every pin of a four-bar linkage, from the motions of its bars


def bars(q: Any, v: Any, a: Any) -> Any:
    """Place, acceleration and angular acceleration of each bar's mass centre: x + i y."""
    turning = [(0,), (0, 1), (2,)]
    angles, rates, spins = ([sum(x[k] for k in on) for on in turning] for x in (q, v, a))
    arm = np.exp(1j * np.array(angles))
    bent = arm * (1j * np.array(spins) - np.array(rates) ** 2)
    half = np.array([CRANK, COUPLER, ROCKER]) / 2
    start = np.array([0, CRANK * arm[0], BASE])
    begun = np.array([0, CRANK * bent[0], 0])
    return start, start + half * arm, begun + half * bent, np.array(spins)


def pins(q: Any, v: Any, a: Any, efforts: Any) -> tuple[Any, float]:
    """Forces of the pins a, b and d on their bars and of c on the rocker: nine balances, and what is left."""
    start, at, pull, spins = bars(q, v, a)
    end = start[1] + COUPLER * np.exp(1j * (q[0] + q[1]))
    # (pin, its place, the bar it acts on, the bar it acts back on)
    acting = ((start[0], 0, None), (start[1], 1, 0), (start[2], 2, None), (end, 2, 1))
    rows, right = np.zeros((9, 8)), np.zeros(9)
    for k in range(3):
        needed = pull[k] + 1j * G
        right[3 * k : 3 * k + 3] = needed.real, needed.imag, 0.03 * spins[k]
    right[[2, 5, 8]] -= [efforts[0] - efforts[1], efforts[1] - efforts[3], efforts[2] + efforts[3]]
    for pin, (place, on, back) in enumerate(acting):
        for bar, sign in ((on, 1), (back, -1)):
            if bar is not None:
                arm = place - at[bar]
                rows[3 * bar : 3 * bar + 2, 2 * pin : 2 * pin + 2] += sign * np.eye(2)
                rows[3 * bar + 2, 2 * pin : 2 * pin + 2] += sign * np.array([-arm.imag, arm.real])
    found = np.linalg.lstsq(rows, right, rcond=None)[0]
    return found.reshape(4, 2), float(np.abs(rows @ found - right).max())


def moving_linkage(efforts: Any) -> tuple[InverseScheme, Any, Any]:
    """The linkage under torques in a, b, d and c, its pins by hand, and its state."""
    model = four_bar()
    q = closed(0.7)
    J = np.array([gap(q + 1j * TINY * e).imag / TINY for e in np.eye(3)]).T
    v = np.linalg.svd(J)[2][2] * 3.0
    numeric = lg.derive(model).numeric(u=[efforts[k] for k in (0, 1, 2, 3)])
    names = [x.name for x in numeric.tree.inputs]
    assert names == ["a", "b", "d", "c"]
    rows = np.array(numeric.constraint_jacobian(q))
    turn = np.array([-1, -1, 1]) * efforts[3]
    right = [
        *(np.array(efforts[:3]) + turn - numeric.bias(q, v)),
        *numeric.constraint_bias(q, v),
    ]
    M = np.array(numeric.mass_matrix(q))
    whole = np.block([[M, -rows.T], [rows, np.zeros((5, 5))]])
    found = np.linalg.lstsq(whole, right, rcond=None)[0]
    a, multipliers = found[:3], found[3:]
    forces, left = pins(q, v, a, efforts)
    assert left < 1e-12
    return scheme(model, q, v, a, multipliers.tolist(), u=efforts), forces, (q, v)


def test_all_pins_of_a_linkage_carry_what_its_bars_balance_with() -> None:
    efforts = [2.0, -0.5, 0.8, 0.3]
    found, forces, _ = moving_linkage(efforts)
    for name, force, effort in zip("abdc", forces, efforts, strict=True):
        near(found.joints[name].force, [*force, 0], 1e-12)
        assert found.joints[name].torque[2] == pytest.approx(effort, abs=1e-12)


def test_a_linkage_balances_the_power_of_its_edges() -> None:
    efforts = [2.0, -0.5, 0.8, 0.3]
    found, _, (_, v) = moving_linkage(efforts)
    edges = found.edges()
    each, sums = powers(edges)
    near(sums, [0, 0], 1e-12)
    turns = {"a": v[0], "b": v[1], "d": v[2], "c": v[2] - v[0] - v[1]}
    for (name, w), effort in zip(turns.items(), efforts, strict=True):
        assert each[f"{name}.rotation"] == pytest.approx(effort * w, abs=1e-12)
        assert each[f"{name}.translation"] == pytest.approx(0, abs=1e-12)


def test_elements_in_a_chord_have_their_own_edge() -> None:
    """A damper in c: the torque on c's head is the damper's, and the chord's own is its effort alone."""
    model = four_bar()
    model.damper("brake", joint="c", damping=0.4)
    q, v = closed(0.7), [0.9, -1.3, 0.6]
    found = scheme(model, q, v, [0, 0, 0], [0] * 5, u=[0, 0, 0, 1.1])
    rate = v[2] - v[0] - v[1]
    near(found.elements["brake"].through.torque, [0, 0, -0.4 * rate])
    near(found.joints["c"].torque, [0, 0, 1.1])
    near(found.joints["c"].force, [0, 0, 0])


def test_a_weld_that_closes_a_loop_holds_with_its_multipliers() -> None:
    """A bar on a hinge, welded at its tip: a torque of weight times arm, and the hinge carries the weight."""
    model = lg.Model("held", gravity=(0, -G, 0))
    bar = model.body("bar", mass=3.0, mass_center=(1.0, 0, 0))
    model.revolute("hinge", between=("ground", bar))
    ends = (model.ground.frame("wall", at=(2, 0, 0)), bar.frame("tip", at=(2, 0, 0)))
    model.fixed("weld", between=ends)
    model.formulation(tree=("hinge",))
    holding = 3.0 * G
    found = scheme(model, [0], [0], [0], [0, 0, 0, 0, 0, holding], u=[0])
    near(found.joints["weld"], [[0, 0, 0], [0, 0, holding]])
    near(found.joints["hinge"], [[0, 3.0 * G, 0], [0, 0, 0]])
    pushed = scheme(model, [0], [0], [0], [1, 2, 3, 4, 5, 6], u=[0])
    near(pushed.joints["weld"], [[1, 2, 3], [4, 5, 6]])


def test_rigid_arms_carry_what_their_terminals_exert() -> None:
    """From the mass centre to a terminal: the joint there, about the terminal, and turned round."""
    q, v = LIMB_STATE
    found = scheme(modelled(LIMB), q, v, [0.1] * 7, u=[0] * 7)
    edges = found.edges()
    # j1 slides from b0 to b1: its force is at the head and has a moment about the tail
    force, torque = (np.array(x) for x in found.joints["j1"])
    tail, head = (found.terminal(end) for end in ("b0.f1near", "b1.f1far"))
    about_tail = torque + np.cross(np.subtract(head.origin, tail.origin), force)
    near(edges["b1/arm.f1far"].through, [-force, -torque])
    near(edges["b0/arm.f1near"].through, [force, about_tail])


def test_without_networks_there_are_no_variables_of_them() -> None:
    found = scheme(beam(), [0.0], [0.0])
    assert (found.network(), found.gains(), found.variables()) == ({}, {}, {})

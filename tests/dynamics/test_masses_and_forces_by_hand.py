"""M, h and applied forces of a few links: textbook formulas, virtual work, sums over bodies."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from support.chains import (
    LIMB,
    LIMB_STATE,
    PLANE,
    Part,
    jacobian,
    link_poses,
    mass_matrix,
    modelled,
    poses,
    walked,
)
from support.rigid_motion import STEP, TINY, tensor

import linegraph as lg
from linegraph.components.forces.load import BODY, WORLD
from linegraph.dynamics import mass_matrix as masses
from linegraph.dynamics.applied_forces import Applied, applied, depends_on_inputs, efforts
from linegraph.dynamics.chords import Chords
from linegraph.dynamics.mass_matrix import composites, ground_is_cheaper, inertia_force
from linegraph.dynamics.orthogonality import energy, generalised_forces, inverse_dynamics
from linegraph.dynamics.regularity import (
    Idle,
    cause,
    is_solid,
    link_of,
    listed,
    massless,
    refusal,
    require_motion,
)
from linegraph.kinematics.tree_state import TreeState
from linegraph.spatial.placement import Placement
from linegraph.spatial.rotation import IDENTITY_MATRIX

G = 9.81
L1, C1, C2, M1, M2, J1, J2 = 0.5, 0.2, 0.3, 1.5, 0.8, 0.02, 0.01
EXACT = 4e-15


def double_pendulum() -> lg.Model:
    """Two bars that hang along -y and turn about z."""
    model = lg.Model("double", gravity=(0, -G, 0))
    upper = model.body("upper", mass=M1, mass_center=(0, -C1, 0), inertia={"zz": J1})
    lower = model.body("lower", mass=M2, mass_center=(0, -C2, 0), inertia={"zz": J2})
    model.revolute("q1", between=("ground", upper))
    model.revolute("q2", between=(upper.frame("end", at=(0, -L1, 0)), lower))
    return model


def at(model: lg.Model, q: Any, v: Any, **arguments: Any) -> TreeState:
    return TreeState(walked(model, **arguments), q, v)


def test_two_links_have_the_textbooks_mass_matrix_and_bias() -> None:
    (a, b), (da, db) = (0.7, -1.1), (1.3, 0.4)
    here = at(double_pendulum(), [a, b], [da, db])
    far = J2 + M2 * C2**2
    cross = M2 * L1 * C2
    M = [
        [J1 + M1 * C1**2 + M2 * L1**2 + far + 2 * cross * math.cos(b), far + cross * math.cos(b)],
        [far + cross * math.cos(b), far],
    ]
    np.testing.assert_allclose(masses.mass_matrix(here), M, atol=EXACT)
    pull = M2 * G * C2 * math.sin(a + b)
    h = [
        -cross * math.sin(b) * (2 * da * db + db**2) + (M1 * C1 + M2 * L1) * G * math.sin(a) + pull,
        cross * math.sin(b) * da**2 + pull,
    ]
    np.testing.assert_allclose(inverse_dynamics(here), h, atol=EXACT)
    speeding = [0.3, -2.0]
    expected = np.array(M) @ speeding + h
    np.testing.assert_allclose(inverse_dynamics(here, speeding), expected, atol=2 * EXACT)
    kinetic, potential = energy(here)
    assert kinetic == pytest.approx(np.array([da, db]) @ M @ [da, db] / 2)
    low = M1 * C1 * math.cos(a) + M2 * (L1 * math.cos(a) + C2 * math.cos(a + b))
    assert potential == pytest.approx(-G * low)


def test_the_mass_matrix_of_a_fork_is_the_sum_over_its_bodies() -> None:
    q, v = LIMB_STATE
    found = masses.mass_matrix(at(modelled(LIMB), q, v))
    np.testing.assert_allclose(found, mass_matrix(LIMB, q), atol=EXACT)


def test_composites_have_the_masses_of_all_bodies_beyond_a_joint() -> None:
    q, v = LIMB_STATE
    state = at(modelled(LIMB), q, v)
    bodies = poses(LIMB, q)
    beyond = {0: range(5), 1: (1, 2, 3, 4), 2: (2,), 3: (3, 4), 4: (4,)}
    for i, (found, own) in enumerate(
        zip(composites(state), link_poses(state.tree, bodies), strict=True)
    ):
        mass, first, inertia = 0.0, np.zeros(3), np.zeros((3, 3))
        for k in beyond[i]:
            seen = np.linalg.inv(own) @ bodies[k]
            c, R = (seen @ [*LIMB[k].center, 1])[:3], seen[:3, :3]
            mass += LIMB[k].mass
            first += LIMB[k].mass * c
            inertia += R @ np.diag(LIMB[k].inertia) @ R.T
            inertia += LIMB[k].mass * (c @ c * np.eye(3) - np.outer(c, c))
        assert found.mass == pytest.approx(mass)
        np.testing.assert_allclose(found.first, first, atol=EXACT)
        np.testing.assert_allclose(tensor(found.inertia), inertia, atol=2 * EXACT)
        force, torque = inertia_force(found, (0.3, -1, 2), (0.5, 0.1, -0.7))
        e, a = np.array([0.3, -1, 2]), np.array([0.5, 0.1, -0.7])
        np.testing.assert_allclose(force, mass * a + np.cross(e, first), atol=2 * EXACT)
        np.testing.assert_allclose(torque, inertia @ e + np.cross(first, a), atol=2 * EXACT)


def oblique(count: int) -> tuple[Part, ...]:
    axes = ((1, 2, 2), (0, 3, 4), (2, -1, 2))
    return tuple(
        Part("revolute", axes[k % 3], ((0.3, 0.1 * k, -0.2), (1, 0, 1), 0.5), parent=k - 1)
        for k in range(count)
    )


def test_long_chains_carry_columns_to_ground_and_short_ones_do_not() -> None:
    for count, ground in ((2, False), (12, True)):
        q = np.linspace(-1, 1, count)
        state = at(modelled(oblique(count)), q, 0 * q)
        assert ground_is_cheaper(state) is ground
        expected = mass_matrix(oblique(count), q)
        np.testing.assert_allclose(masses.mass_matrix(state), expected, atol=1e-14 * expected.max())


def test_coupled_hinges_meet_in_one_entry() -> None:
    model = double_pendulum()
    model.couple("q2", to="q1", ratio=-2.0)
    far, cross = J2 + M2 * C2**2, M2 * L1 * C2 * math.cos(-2 * 0.4)
    whole = J1 + M1 * C1**2 + M2 * L1**2 + far + 2 * cross
    # (1, -2) M (1, -2)^T
    expected = whole - 4 * (far + cross) + 4 * far
    found = masses.mass_matrix(at(model, [0.4], [0.0]))
    assert found == [[pytest.approx(expected, abs=EXACT)]]


# what acts


def acting(
    model: lg.Model, q: Any, v: Any, driven: bool = False, **arguments: Any
) -> tuple[TreeState, Applied]:
    state = at(model, q, v, **arguments)
    return state, applied(Chords(state), driven=driven)


EYE = (0.4, 0.6, -0.2)
POINT = (0.1, -0.3, 0.2)
K, REST = 120.0, 0.35


def sprung() -> lg.Model:
    model = modelled(LIMB)
    eye = model.ground.frame("eye", at=EYE)
    end = model.add_frame("b4", "hook", Placement(POINT, IDENTITY_MATRIX))
    model.spring("coil", between=(eye, end), stiffness=K, length=REST)
    return model


def stretch(q: Any) -> Any:
    line = (poses(LIMB, q)[4] @ [*POINT, 1])[:3] - np.array(EYE)
    return np.sqrt(line @ line)


def test_a_spring_between_two_points_works_against_its_stretch() -> None:
    q, v = LIMB_STATE
    state, found = acting(sprung(), q, v)
    tension = K * (stretch(q) - REST)
    slope = np.array([stretch(q + 1j * TINY * e).imag / TINY for e in np.eye(7)])
    np.testing.assert_allclose(generalised_forces(state, found), -tension * slope, atol=1e-12)
    assert found.potential == pytest.approx(K * (stretch(q) - REST) ** 2 / 2)
    assert found.efforts == [0] * 7
    # only the link at its far end feels it: the other end is ground
    assert [w != ((0, 0, 0), (0, 0, 0)) for w in found.wrenches] == [False] * 4 + [True]


def test_a_springs_wrench_is_its_pull_and_its_moment_about_the_links_origin() -> None:
    q, v = LIMB_STATE
    state, found = acting(sprung(), q, v)
    bodies = poses(LIMB, q)
    own = link_poses(state.tree, bodies)[4]
    end = (bodies[4] @ [*POINT, 1])[:3]
    line = np.array(EYE) - end
    pull = K * (np.linalg.norm(line) - REST) * line / np.linalg.norm(line)
    force, torque = found.wrenches[4]
    np.testing.assert_allclose(own[:3, :3] @ force, pull, atol=1e-13)
    np.testing.assert_allclose(own[:3, :3] @ torque, np.cross(end - own[:3, 3], pull), atol=1e-13)


def test_a_damper_in_a_hinge_acts_against_its_rate() -> None:
    model = modelled(PLANE)
    model.damper("brake", joint="j1", damping=0.7)
    model.spring("coil", joint="j2", stiffness=3.0, length=0.2)
    _, found = acting(model, [0.1, 0.2, 0.6], [1.0, -2.0, 0.5])
    assert found.efforts == [0, pytest.approx(1.4), pytest.approx(-3.0 * 0.4)]
    assert found.potential == pytest.approx(3.0 * 0.4**2 / 2)


def test_loads_push_in_the_axes_of_ground_or_of_their_body() -> None:
    q, v = LIMB_STATE
    for axes in (WORLD, BODY):
        model = modelled(LIMB)
        model.load("push", at="b3", force=(1, -2, 3), torque=(0.5, 0, -1), axes=axes)
        state, found = acting(model, q, v)
        turn = poses(LIMB, q)[3][:3, :3] if axes == BODY else np.eye(3)
        J = jacobian(LIMB, q, 3)
        expected = (turn @ [1, -2, 3]) @ J[:3] + (turn @ [0.5, 0, -1]) @ J[3:]
        np.testing.assert_allclose(generalised_forces(state, found), expected, atol=2e-14)


def test_what_names_an_input_is_driven_and_the_rest_is_bias() -> None:
    model = modelled(PLANE)
    model.input("u")
    model.load("push", at="b2", force=("2*u", 0, 0))
    model.spring("coil", joint="j0", stiffness=5.0)
    system = model.system()
    assert depends_on_inputs(system, ("2*u", 0)) is True
    assert depends_on_inputs(system, (3.0, "t")) is False
    u = [0.0, 0.0, 0.0, 1.5]
    _, resting = acting(model, [0.2, 0, 0], [0, 0, 0], u=u)
    _, driven = acting(model, [0.2, 0, 0], [0, 0, 0], driven=True, u=u)
    assert resting.efforts[0] == pytest.approx(-1.0)
    assert all(w == ((0, 0, 0), (0, 0, 0)) for w in resting.wrenches)
    assert driven.efforts == [0, 0, 0]
    force, _ = driven.wrenches[2]
    np.testing.assert_allclose(force, (3 * math.cos(0.2), -3 * math.sin(0.2), 0), atol=1e-15)


def test_efforts_stand_at_their_own_velocity_or_act_between_angles_from_ground() -> None:
    u = [2.0, 3.0, 5.0]
    for coordinates, expected in (("joint", u), ("absolute-angle", [2 - 3, 3 - 5, 5])):
        model = modelled(PLANE)
        model.formulation(coordinates=coordinates)
        chords = Chords(at(model, [0.1, 0.2, 0.3], [0, 0, 0], u=u))
        assert efforts(chords, [0, 0, 0]) == expected


def test_momentum_changes_as_h_says_of_the_power_of_gravity() -> None:
    """With v̇ = 0 the power of h is the rate of the energy: v·h = d/dt (T + V)."""
    q, v = LIMB_STATE

    def total(t: float) -> float:
        return sum(energy(at(modelled(LIMB), q + v * t, v)))

    h = inverse_dynamics(at(modelled(LIMB), q, v))
    change = (total(STEP) - total(-STEP)) / (2 * STEP)
    assert v @ h == pytest.approx(change, abs=1e-8)


# what moves no inertia


def idle(model: lg.Model) -> list[str]:
    tree = walked(model)
    return [x.name for x in massless(tree, lambda: [])]


def test_a_joint_that_moves_nothing_is_named_and_one_that_moves_something_beyond_is_not() -> None:
    assert idle(modelled(PLANE)) == []
    empty = {"mass": 0.0, "inertia": (0, 0, 0)}
    assert idle(modelled((*PLANE[:2], PLANE[2]._replace(**empty)))) == ["j2"]
    # with the first two empty the last one's mass is moved by all three hinges
    assert idle(modelled((PLANE[0]._replace(**empty), PLANE[1]._replace(**empty), PLANE[2]))) == []
    assert idle(modelled([part._replace(**empty) for part in PLANE])) == ["j0", "j1", "j2"]


def test_a_point_mass_on_the_axis_of_a_hinge_is_not_moved_by_it() -> None:
    point = {"inertia": (0, 0, 0), "center": (0, 0, 0.7)}
    assert idle(modelled((PLANE[0]._replace(**point),))) == ["j0"]
    # on oblique axes rounding leaves an inertia, which is none beside the mass and its distance
    for axis in ((1, 2, 3), (3, -1, 2), (1, 1, 1)):
        center = tuple(0.7 * x for x in axis)
        assert idle(modelled((PLANE[0]._replace(axis=axis, **point | {"center": center}),))) == [
            "j0"
        ]
    off = {"inertia": (0, 0, 0), "center": (1e-3, 0, 0.7)}
    assert idle(modelled((PLANE[0]._replace(**off),))) == []


def test_what_networks_add_may_be_the_inertia_that_is_missing() -> None:
    tree = walked(modelled((PLANE[0]._replace(mass=0.0, inertia=(0, 0, 0)),)))
    assert [x.name for x in massless(tree, lambda: [(0, 0, 0.1)])] == []
    assert [x.name for x in massless(tree, lambda: [(1, 1, 0.1)])] == ["j0"]


def test_a_negative_inertia_is_refused_with_its_joint() -> None:
    tree = walked(modelled((PLANE[0]._replace(mass=0.0, inertia=(0, 0, -1)),)))
    with pytest.raises(lg.ModelError, match="negative") as told:
        massless(tree, lambda: [])
    assert told.value.thing == 'joint "j0"'


def test_a_solid_link_has_inertia_in_every_direction() -> None:
    def solid(**changes: Any) -> bool:
        tree = walked(modelled((PLANE[0]._replace(**changes),)))
        return is_solid(tree.links[0])

    assert solid()
    assert not solid(mass=0.0)
    assert not solid(inertia=(0, 0.1, 0.1))  # a rod
    assert not solid(inertia=(0, 0.1, 0.1), center=(0, 5.0, 0))  # and one that a hinge swings
    assert not solid(inertia=(-0.1, 0.1, 0.1))
    assert solid(center=(100.0, 0, 0))  # central inertias count, not those about the joint


def test_refusals_name_all_joints_and_functions_once() -> None:
    two = [Idle("joint", "j1", "b1"), Idle("joint", "j2", "b2")]
    told = refusal(two, ["rhs", "forward_dynamics"])
    assert told.thing == 'joint "j1"'
    assert 'neither does "j2" (b2)' in told.problem
    assert "rhs and forward_dynamics divide by it" in told.problem
    assert "--lock j1 --lock j2" in told.problem
    assert "--lock" not in refusal(two, ["rhs"], closed=True).problem
    assert "rhs, which divides by it, is left out" in refusal(two, ["rhs"], asked=False).problem
    store = Idle("capacitor", "C", "u_C (voltage)")
    assert refusal([store], ["rhs"]).thing == 'capacitor "C"'
    assert cause([two[0], store]) == (
        'joint "j1" moves no inertia and nothing stores u_C (voltage) of capacitor "C"'
    )
    assert cause(two) == 'joints "j1" and "j2" move no inertia'
    assert [listed(x) for x in ("a", "ab", "abc")] == ["a", "a and b", "a, b and c"]


def test_a_model_in_which_nothing_moves_is_refused() -> None:
    model = lg.Model("wall")
    model.fixed("nail", between=("ground", model.body("brick", mass=1.0)))
    tree = walked(model)
    with pytest.raises(lg.ModelError, match="no joint can move"):
        require_motion(tree)


def test_a_sample_of_a_tree_has_the_parameters_own_values() -> None:
    model = lg.Model("bob")
    mass = model.parameter("m", 2.5)
    bob = model.body("bob", mass=mass, mass_center=(1, 0, 0))
    model.revolute("hinge", between=("ground", bob))
    tree = lg.derive(model).sample
    assert tree.links[0].moments.mass == 2.5
    assert link_of(tree, 0) is tree.links[0]

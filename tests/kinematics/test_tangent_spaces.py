"""Small changes of a state along its velocities, beside differentiated rotations."""

from __future__ import annotations

import numpy as np
from support.chains import PLANE, modelled, walked
from support.rigid_motion import TINY, axial, cross_matrix, of_quaternion

import linegraph as lg
from linegraph.kinematics.tangent_space import adjoint, chain, changes


def ball_after_slide() -> lg.Model:
    model = lg.Model("ball")
    a = model.body("a", mass=1.0, inertia=(1, 1, 1))
    b = model.body("b", mass=1.0, inertia=(1, 1, 1))
    model.prismatic("slide", between=("ground", a), axis=(1, 0, 0))
    model.spherical("ball", between=(a, b))
    return model


Q = np.array([0.3, 0.5, -0.5, 0.1, 0.7])


def test_a_change_of_a_quaternion_turns_the_body_about_its_own_axes() -> None:
    tree = walked(ball_after_slide())
    assert changes(tree) == [("d", 0), ("d", 1), ("d", 2), ("d", 3)]
    found = chain(tree, list(Q))
    assert found["q", 0] == {("d", 0): 1}
    for k in range(3):
        slope = np.array([found["q", i].get(("d", 1 + k), 0) for i in range(1, 5)])
        ahead = of_quaternion(Q[1:] + 1j * TINY * slope)
        # Q[1:] has length 1: R^T dR is the unit vector along axis k
        np.testing.assert_allclose(
            axial(ahead.real.T @ ahead.imag / TINY), np.eye(3)[k], atol=1e-15
        )


def test_changes_between_two_turning_bodies_follow_the_bracket_of_the_ball() -> None:
    """R exp[d] turns with w + dw exactly if d' = dw - w x d, to first order in d."""
    tree = walked(ball_after_slide())
    v = (0.9, 0.4, -1.1, 0.7)
    ad = np.array(adjoint(tree, v))
    w, d, dw = np.array(v[1:]), np.array([0.2, 0.5, -0.3]), np.array([-0.6, 0.1, 0.8])
    rate = dw - ad[1:, 1:] @ d
    # (R E)^T (R E)' = E^T [w] E + E^T E', with E = 1 + eps [d] and eps a complex step
    E = np.eye(3) + 1j * TINY * cross_matrix(d)
    turning = E.T @ cross_matrix(w) @ E + E.T @ (1j * TINY * cross_matrix(rate))
    np.testing.assert_allclose(axial(turning).imag / TINY, dw, atol=1e-15)
    assert not ad[0].any()
    assert not ad[:, 0].any()


def test_the_bracket_of_hinges_is_zero_and_followers_have_none() -> None:
    model = modelled(PLANE)
    model.couple("j2", to="j0", ratio=-2.0)
    tree = walked(model)
    assert adjoint(tree, (1.0, 2.0)) == [[0, 0], [0, 0]]
    assert chain(tree, [0.1, 0.2]) == {("q", 0): {("d", 0): 1}, ("q", 1): {("d", 1): 1}}

"""Derivatives from composites: a double pendulum by its formulas, random trees by differences."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from oracles import newton_euler as oracle
from support.chains import PLANE, Part, modelled, walked
from support.drawn_trees import Drawn, differences, drawn
from support.near import near
from support.rigid_motion import TINY

import linegraph as lg
from linegraph.dynamics.composite_derivatives import has_slopes, slopes
from linegraph.ir.dag import Dag
from linegraph.kinematics.tree_state import TreeState

G = 9.81
L1, C1, C2, M1, M2, J1, J2 = 0.5, 0.2, 0.3, 1.5, 0.8, 0.02, 0.01


def derivatives(model: lg.Model, q: Any, v: Any, a: Any) -> tuple[Any, Any, Any]:
    found = slopes(TreeState(walked(model), q, v), a)
    by_change, by_velocity, by_acceleration = (np.array(rows, float) for rows in found)
    return by_change, by_velocity, by_acceleration


def by_complex_steps(function: Any, at: Any) -> Any:
    at = np.asarray(at, float)
    return np.array([function(at + 1j * TINY * e).imag / TINY for e in np.eye(len(at))]).T


def pendulum() -> lg.Model:
    """Two bars that hang along -y and turn about z."""
    model = lg.Model("double", gravity=(0, -G, 0))
    upper = model.body("upper", mass=M1, mass_center=(0, -C1, 0), inertia={"zz": J1})
    lower = model.body("lower", mass=M2, mass_center=(0, -C2, 0), inertia={"zz": J2})
    model.revolute("q1", between=("ground", upper))
    model.revolute("q2", between=(upper.frame("end", at=(0, -L1, 0)), lower))
    return model


def torque(q: Any, v: Any, a: Any) -> Any:
    """The textbook's M a + h, for complex numbers too."""
    (q1, q2), (v1, v2), (a1, a2) = q, v, a
    far, cross = J2 + M2 * C2**2, M2 * L1 * C2
    near = J1 + M1 * C1**2 + M2 * L1**2
    inner, bend = far + cross * np.cos(q2), cross * np.sin(q2)
    pull = M2 * G * C2 * np.sin(q1 + q2)
    weight = (M1 * C1 + M2 * L1) * G * np.sin(q1) + pull
    first = (near + far + 2 * cross * np.cos(q2)) * a1 + inner * a2
    return np.array(
        [first - bend * (2 * v1 * v2 + v2**2) + weight, inner * a1 + far * a2 + bend * v1**2 + pull]
    )


def test_a_double_pendulum_has_the_derivatives_of_the_textbooks_torques() -> None:
    q, v, a = [0.7, -1.1], [1.3, 0.4], [0.3, -2.0]
    found = derivatives(pendulum(), q, v, a)
    for rows, expected in zip(
        found,
        (
            by_complex_steps(lambda x: torque(x, v, a), q),
            by_complex_steps(lambda x: torque(q, x, a), v),
            by_complex_steps(lambda x: torque(q, v, x), a),
        ),
        strict=True,
    ):
        near(rows, expected)


def test_a_coupled_pendulum_has_those_along_the_coupling() -> None:
    """With q = (1, -2) s the derivative by s is (1, -2) D (1, -2)^T, in each of the three."""
    model = pendulum()
    model.couple("q2", to="q1", ratio=-2.0)
    ratio = np.array([1.0, -2.0])
    found = derivatives(model, [0.7], [1.3], [0.4])
    whole = derivatives(pendulum(), 0.7 * ratio, 1.3 * ratio, 0.4 * ratio)
    for rows, all_rows in zip(found, whole, strict=True):
        near(rows, [[ratio @ all_rows @ ratio]])


def test_a_point_on_a_crane_moves_as_its_polar_coordinates_do() -> None:
    """Slewing about z, then luffing out along x: radial m (r'' - r w^2), moment m (r^2 w' + 2 r r' w)."""
    m, r, out, w = 2.5, 0.8, 0.3, 1.1
    point = {"mass": m, "center": (0, 0, 0), "inertia": (0, 0, 0)}
    empty = {"mass": 0.0, "inertia": (0, 0, 0)}
    parts = (Part("revolute", **empty), Part("prismatic", (1, 0, 0), parent=0, **point))  # type: ignore[arg-type]
    model = modelled(parts)
    model.gravity = (0, 0, -G)
    turn, slide = 0.4, -0.7
    by_change, by_velocity, mass = derivatives(model, [0.3, r], [w, out], [turn, slide])
    near(by_change, [[0, m * (2 * r * turn + 2 * out * w)], [0, -m * w**2]])
    near(by_velocity, [[2 * m * r * out, 2 * m * r * w], [-2 * m * r * w, 0]])
    near(mass, [[m * r**2, 0], [0, m]])


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kinds", ["revolute", "prismatic", "planar", "free", "any"])
def test_random_trees_have_the_derivatives_of_newton_and_euler(kinds: str, seed: int) -> None:
    """A change of a free joint is a shift and a turn along its head's axes."""
    here = steady(seed, kinds)
    spec, q, v, a = here.spec, here.q, here.v, here.a
    by_change, by_velocity, by_acceleration = slopes(here.over_floats(), a)
    expected = differences(here, lambda x: oracle.inverse_dynamics(spec, x, v, a))
    near(by_change, expected, 1e-10)
    units = np.eye(spec.nv)
    # h is quadratic in v, so a central difference of any step is its derivative
    columns = [(oracle.bias(spec, q, v + e) - oracle.bias(spec, q, v - e)) / 2 for e in units]
    near(by_velocity, np.array(columns).T)
    near(by_acceleration, oracle.mass_matrix(spec, q, v))


def steady(seed: int, kinds: str) -> Drawn:
    """A random tree whose joints keep their directions in far axes: free ones point away from ground."""
    while not over_nodes((here := drawn(seed, kinds)).model):
        seed += 100
    return here


def over_nodes(model: lg.Model) -> bool:
    dag = Dag()
    tree = walked(model)
    q = [dag.symbol("q", k) for k in range(len(tree.positions))]
    v = [dag.symbol("v", k) for k in range(len(tree.velocities))]
    return has_slopes(TreeState(replace(tree, algebra=dag), q, v))


@pytest.mark.parametrize(
    ("kind", "forward", "expected"),
    [
        ("revolute", True, True),
        ("revolute", False, True),
        ("prismatic", False, True),
        ("cylindrical", True, True),
        ("universal", True, False),  # its first axis turns as seen from its far side
    ],
)
def test_turns_and_shifts_that_stay_are_told_from_those_that_change(
    kind: str, forward: bool, expected: bool
) -> None:
    axis: Any = ((1, 0, 0), (0, 1, 0)) if kind == "universal" else (1, 2, 2)
    assert over_nodes(modelled((Part(kind, axis, forward=forward),))) is expected


def test_links_that_turn_against_ground_have_no_such_derivatives() -> None:
    model = modelled(PLANE)
    assert over_nodes(model)
    model.formulation(coordinates="absolute-angle")
    assert not over_nodes(model)

"""Conformance of every registered constraint: its rows agree with its equation of position.

A constraint that is added to `linegraph.components.constraints.CONSTRAINTS` is tested here without another
line, unless it needs options. Rates are complex steps along the motion of both ends.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from support.chains import Part, modelled, walked
from support.near import near
from support.rigid_motion import TINY, axial, cross_matrix, pose, turned

import linegraph as lg
from linegraph.components.constraints import (
    CONSTRAINTS,
    Constraint,
    Instant,
    Pose,
    Prescribed,
    ReactionRow,
)
from linegraph.dynamics.chords import Chords
from linegraph.ir.program import Quantity
from linegraph.kinematics.tree_state import TreeState

NEEDED: dict[str, dict[str, Any]] = {
    "rod": {"length": 0.6},
    "driver": {"y": 0.3},
    "rolling": {"radius": 0.4},
}
"""Options without which a type cannot be."""

VARIANTS: dict[str, tuple[str, dict[str, Any]]] = {
    **{kind: (kind, NEEDED.get(kind, {})) for kind in CONSTRAINTS},
    "rod with a stroke": ("rod", {"length": "0.6 + 0.1*sin(3*t)"}),
    "driver along all axes": ("driver", {"x": "t**2", "y": "0.3", "z": "cos(t)"}),
    "rim of a wheel": ("rolling", {"radius": 0.4, "axis": (0.6, 0, 0.8)}),
    "rounded rim": ("rolling", {"radius": 0.4, "crown": 0.1, "axis": (0, 1, 0)}),
    "oblique blade": ("blade", {"axis": (0.6, -0.8, 0)}),
}
"""Every registered type, some with further options."""

EVERY = pytest.mark.parametrize("name", VARIANTS)
SEEDS = pytest.mark.parametrize("seed", range(5))


def made(name: str) -> Constraint:
    kind, options = VARIANTS[name]
    return CONSTRAINTS[kind]("limit", ("ground.near", "body.far"), **options)


class Complex:
    """An algebra of complex numbers, as far as rows need one."""

    def sqrt(self, x: Any) -> Any:
        """The root with a real part of 0 or more."""
        return np.sqrt(x + 0j)


def instant(name: str, tail: Any, head: Any, drive: Any) -> Instant:
    """Both ends as poses of NumPy, and what is prescribed: value and rate, or None."""
    ends = [Pose(tuple(map(tuple, x[:3, :3])), tuple(x[:3, 3])) for x in (tail, head)]
    given = [None if x is None else Prescribed(*x) for x in drive]
    return Instant(Complex(), lambda x: x, *ends, given)  # type: ignore[arg-type]


def drawn(name: str, seed: int) -> tuple[Any, Any, Any, Any]:
    """Poses of both ends, their twists (angular, linear) and what is prescribed, at random."""
    rng = np.random.default_rng(seed)
    tail, head = (pose(turned(rng.normal(size=3), rng.normal()), rng.normal(size=3)) for _ in "th")
    twists = rng.normal(size=(2, 2, 3))
    drive = [None if x is None else rng.normal(size=2) for x, _ in made(name).prescribed()]
    return tail, head, twists, drive


def moved(at: Any, twist: Any, step: complex) -> Any:
    """A pose a small step along a twist: its imaginary part is the rate."""
    w, u = twist
    return pose(at[:3, :3] + step * cross_matrix(w) @ at[:3, :3], at[:3, 3] + step * u)


def rows(name: str, tail: Any, head: Any, drive: Any) -> tuple[ReactionRow, ...]:
    return made(name).rows(instant(name, tail, head, drive))


@pytest.mark.parametrize("kind", CONSTRAINTS)
def test_a_registered_constraint_is_what_its_base_class_promises(kind: str) -> None:
    make = CONSTRAINTS[kind]
    assert make.kind == kind
    assert issubclass(make, Constraint)
    assert make.__dataclass_params__.frozen  # type: ignore[attr-defined]
    own = {f.name for f in dataclasses.fields(make)} - {"name", "between"}
    assert set(make.timed) <= own
    assert {field for group in make.needs for field in group} <= own
    for group in make.needs:
        assert {*group} & NEEDED[kind].keys()
    model = lg.Model("built")
    model.free("pose", ("ground", model.body("body", mass=1.0)))
    getattr(model, kind)("limit", between=("ground", "body"), **NEEDED.get(kind, {}))
    (found,) = model.system().constraints
    assert type(found) is make
    assert found.ends == ("ground", "body")


@EVERY
def test_its_values_are_all_that_is_given(name: str) -> None:
    """Each value once, axes by component; a name and ends are none."""
    limit = made(name)
    given = VARIANTS[name][1].values()
    flat = [x for value in given for x in (value if isinstance(value, tuple) else (value,))]
    for value in flat:
        assert value in limit.values()
    assert not {"limit", limit.between} & {*limit.values()}
    assert not {*limit.between} & {*limit.values()}
    assert None not in limit.values()


@EVERY
def test_multipliers_have_names_of_their_own_and_positions_where_rows_have_them(name: str) -> None:
    limit = made(name)
    found = limit.equations()
    names = [quantity.name for quantity, _ in found]
    assert len({*names}) == len(names) > 0
    for quantity, _ in found:
        assert isinstance(quantity, Quantity)
        assert quantity.name.startswith("limit_")
        assert quantity.unit in ("N", "N*m")
        assert "limit" in quantity.about
    tail, head, _, drive = drawn(name, 0)
    made_rows = rows(name, tail, head, drive)
    assert [row.position is not None for row in made_rows] == [x for _, x in found]


@EVERY
def test_what_it_prescribes_is_a_value_of_its_fields_that_may_be_timed(name: str) -> None:
    limit = made(name)
    found = limit.prescribed()
    assert len(found) == len(limit.timed)
    for (value, quantity), field in zip(found, limit.timed, strict=True):
        assert value == getattr(limit, field)
        assert quantity.name.startswith("limit_")
        assert quantity.unit == "m"


@EVERY
@SEEDS
def test_the_rate_of_its_position_is_what_its_rows_say(name: str, seed: int) -> None:
    """With u, w the motion of the head seen from the tail, d/dt position = force . u + torque . w - rate."""
    tail, head, (of_tail, of_head), drive = drawn(name, seed)
    step = 1j * TINY
    ahead = [None if x is None else (x[0] + step * x[1], x[1]) for x in drive]
    later = rows(name, moved(tail, of_tail, step), moved(head, of_head, step), ahead)
    line = head[:3, 3] - tail[:3, 3]
    u = of_head[1] - of_tail[1] - np.cross(of_tail[0], line)
    w = of_head[0] - of_tail[0]
    holonomic = 0
    for row, next_row in zip(rows(name, tail, head, drive), later, strict=True):
        if row.position is None:
            continue
        holonomic += 1
        change = np.imag(next_row.position) / TINY
        said = np.real(np.dot(row.force, u) + np.dot(row.torque, w) - row.rate)
        near(change, said, 1e-13)
    assert holonomic == sum(x for _, x in made(name).equations())


@EVERY
@SEEDS
def test_its_rows_turn_with_both_ends(name: str, seed: int) -> None:
    """A constraint is between its ends: another view of both turns its forces and changes nothing else."""
    tail, head, _, drive = drawn(name, seed)
    rng = np.random.default_rng(100 + seed)
    view = pose(turned(rng.normal(size=3), rng.normal()), rng.normal(size=3))
    here, there = rows(name, tail, head, drive), rows(name, view @ tail, view @ head, drive)
    for row, seen in zip(here, there, strict=True):
        near(np.real(seen.force), view[:3, :3] @ np.real(row.force))
        near(np.real(seen.torque), view[:3, :3] @ np.real(row.torque))
        if row.position is not None:
            near(np.real(seen.position), np.real(row.position))
        near(np.real(seen.rate), np.real(row.rate))


@EVERY
@SEEDS
def test_its_rows_are_directions_of_length_one_that_are_not_one(name: str, seed: int) -> None:
    """Forces are unit vectors, so that multipliers are newtons, and no row is a combination of the others."""
    tail, head, _, drive = drawn(name, seed)
    found = rows(name, tail, head, drive)
    for row in found:
        assert np.linalg.norm(np.real(row.force)) == pytest.approx(1, abs=1e-14)
    wrenches = [[*np.real(row.force), *np.real(row.torque)] for row in found]
    assert np.linalg.matrix_rank(wrenches) == len(found)


# the rows of each type, compared with geometry


def held(name: str, seed: int) -> tuple[Any, Any, Any, list[Any], list[Any], list[Any]]:
    """Both ends, what is prescribed, and of every row its position, and what it makes of u and w."""
    tail, head, (of_tail, of_head), drive = drawn(name, seed)
    line = head[:3, 3] - tail[:3, 3]
    u = of_head[1] - of_tail[1] - np.cross(of_tail[0], line)
    w = of_head[0] - of_tail[0]
    found = rows(name, tail, head, drive)
    positions = [row.position for row in found]
    speeds = [np.real(np.dot(row.force, u) + np.dot(row.torque, w)) for row in found]
    return tail, head, drive, positions, speeds, [u, w]


@SEEDS
def test_a_rod_holds_the_distance(seed: int) -> None:
    tail, head, (length,), (position,), (speed,), (u, _) = held("rod", seed)
    line = head[:3, 3] - tail[:3, 3]
    near(np.real(position), np.linalg.norm(line) - length[0])
    near(speed, u @ line / np.linalg.norm(line))


@SEEDS
def test_a_driver_leads_along_the_tails_axes(seed: int) -> None:
    tail, head, drive, positions, speeds, (u, _) = held("driver along all axes", seed)
    line = tail[:3, :3].T @ (head[:3, 3] - tail[:3, 3])
    near(np.real(positions), line - [x for x, _ in drive])
    near(speeds, tail[:3, :3].T @ u)
    _, _, (_, given, _), positions, speeds, (u, _) = held("driver", seed)
    tail, head, *_ = drawn("driver", seed)
    near(np.real(positions), [tail[:3, 1] @ (head[:3, 3] - tail[:3, 3]) - given[0]])
    near(speeds, [tail[:3, 1] @ u])


@SEEDS
def test_a_blade_does_not_move_along_its_axis_in_the_heads_frame(seed: int) -> None:
    _, head, _, _, speeds, (u, _) = held("oblique blade", seed)
    near(speeds, [u @ head[:3, :3] @ [0.6, -0.8, 0]])


@pytest.mark.parametrize("name", ["rolling", "rim of a wheel", "rounded rim"])
@SEEDS
def test_a_wheel_touches_with_its_lowest_point_which_does_not_slip(name: str, seed: int) -> None:
    tail, head, _, positions, speeds, (u, w) = held(name, seed)
    options, normal = VARIANTS[name][1], tail[:3, 2]
    radius, crown, axis = (options.get(k) for k in ("radius", "crown", "axis"))
    if axis is None:
        lowest = -radius * normal
    else:
        first = np.cross(axis, (0.1, 0.2, 0.7))
        first /= np.linalg.norm(first)
        first, second = (head[:3, :3] @ x for x in (first, np.cross(axis, first)))
        angle = np.arctan2(normal @ second, normal @ first) + np.pi
        lowest = radius * (np.cos(angle) * first + np.sin(angle) * second)
        lowest = lowest - (crown or 0) * normal
    height = normal @ (head[:3, 3] - tail[:3, 3] + lowest)
    near(np.real(positions[0]), height)
    slip = u + np.cross(w, lowest)
    near(speeds[0], normal @ slip)
    if axis is None:
        near(speeds[1:], [tail[:3, 0] @ slip, tail[:3, 1] @ slip])
        return
    track = np.cross(head[:3, :3] @ axis, normal)
    track /= np.linalg.norm(track)
    near(speeds[1:], [track @ slip, np.cross(normal, track) @ slip])


# in a mechanism

ARM = (
    Part("revolute", (1, 2, 2), ((0.1, 0.2, 0.3), (1, 0, 1), 0.4)),
    Part("cylindrical", (0, 1, 1), ((0.5, 0, -0.1), (1, 1, 0), -0.8), parent=0),
    Part("revolute", (0, 0, 1), ((-0.6, 0.3, 0.2), (0, 1, 1), 0.7)),
    Part("revolute", (2, 1, 0), ((0.3, 0.4, 0), (0, 1, 0), 0.5), parent=2),
)
"""Two arms of two bodies each, q' = v."""

TIME = 0.37
STEP = 1e-3


def chords(name: str, q: Any, v: Any, t: float = TIME) -> Chords:
    """The constraint between the ends of both arms, at a state and a time."""
    kind, options = VARIANTS[name]
    model = modelled(ARM)
    getattr(model, kind)("limit", between=("b1", "b3"), **options)
    found = Chords(TreeState(walked(model, t=t), q, v))
    assert len(found.equations) == len(made(name).equations())
    return found


def difference(function: Any) -> Any:
    """The derivative at 0 by differences of fourth order."""
    weights = ((-2, 1), (-1, -8), (1, 8), (2, -1))
    return sum(w * np.array(function(k * STEP), float) for k, w in weights) / (12 * STEP)


@EVERY
@pytest.mark.parametrize("seed", range(2))
def test_j_is_the_derivative_of_its_position_and_gamma_of_its_rate(name: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    q, v = rng.uniform(-1, 1, size=(2, 5))
    here = chords(name, q, v)
    J = np.array(here.jacobian(), float)
    count = len(here.position())
    by_q = [difference(lambda s, e=e: chords(name, q + s * e, v).position()) for e in np.eye(5)]  # type: ignore[misc]
    near(J[:count], np.array(by_q).T.reshape(count, 5), 1e-10)
    # with v constant the rate J v - b of every row, of position or not, changes by -γ
    along = difference(lambda s: chords(name, q + s * v, v, TIME + s).position())
    near(here.rates()[:count], along, 1e-10)
    near(np.subtract(here.rates(), chords(name, q, 0 * v).rates()), J @ v)
    change = difference(lambda s: chords(name, q + s * v, v, TIME + s).rates())
    near(here.bias(), -change, 1e-9)


def test_a_pose_moves_along_its_twist() -> None:
    """Checks the steps used above: a turn about ground's axes through the pose's own origin."""
    at = pose(turned((1, 2, 3), 0.7), (1, 2, 3))
    w, u = np.array([0.3, -0.4, 0.5]), np.array([1.0, 0.0, -2.0])
    ahead = moved(at, (w, u), 1j * TINY)
    near(axial(ahead[:3, :3].imag / TINY @ at[:3, :3].T), w)
    near(ahead[:3, 3].imag / TINY, u)

"""Conformance of every registered joint type: what it says of its motion agrees with the motion itself.

Velocities are checked by the complex step: with q moved by i h q', h = 1e-30, the imaginary part of the
rotation and displacement over h is their derivative, exact to rounding. A joint that is added to
`linegraph.components.joints.JOINTS` is tested here without another line, unless it needs options.
"""

from __future__ import annotations

import cmath
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from numpy.typing import NDArray
from systems import random_trees as trees

from linegraph import Model, ModelError, derive
from linegraph.algebra.protocol import Floats
from linegraph.components.joints import JOINTS, Joint
from linegraph.dynamics.mass_matrix import mass_matrix
from linegraph.dynamics.orthogonality import inverse_dynamics
from linegraph.kinematics.tree_state import TreeState
from linegraph.spatial.motion import reverse

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from linegraph.kinematics.links import KinematicTree
    from linegraph.model.builder import BodyHandle
    from linegraph.spatial.motion import Motion

Array = NDArray[np.complex128]

STEP = 1e-30
EXACT = 1e-14  # measured 3.3e-15
NEEDED: dict[str, dict[str, Any]] = {
    "helical": {"lead": 0.7},
    "compound": {"parts": (("revolute", (0, 1, 0)), ("helical", (0.6, 0, 0.8), {"lead": -0.4}))},
}
"""Options without which a type cannot be."""

VARIANTS: dict[str, tuple[str, dict[str, Any]]] = {
    **{kind: (kind, NEEDED.get(kind, {})) for kind in JOINTS},
    "spherical by angles": ("spherical", {"angles": "zxz"}),
    "free by angles": ("free", {"angles": "xyz"}),
    "oblique universal": ("universal", {"axes": ((1, 2, -1), (0.5, 0, 1))}),
    "compound of many": (
        "compound",
        {"parts": (("prismatic", (1, 2, 3)), ("planar", (0, -1, 0)), ("revolute", (1, 0, 1)))},
    ),
}
"""Every registered type, some with further options."""

UNALIGNED = ("fixed", "free", "spherical")
KINDS = pytest.mark.parametrize("kind", VARIANTS)
SEEDS = pytest.mark.parametrize("seed", range(10))
WAYS = pytest.mark.parametrize("forward", [True, False], ids=["forward", "reversed"])


class ComplexNumbers:
    """The algebra of complex numbers."""

    sin = staticmethod(cmath.sin)
    cos = staticmethod(cmath.cos)
    sqrt = staticmethod(cmath.sqrt)

    def symbol(self, argument: str, place: int | str | None = None) -> complex:
        raise AssertionError(f"a joint asks for {argument}[{place}]")


ALGEBRA = ComplexNumbers()


def unit_axis(rng: np.random.Generator) -> tuple[float, float, float]:
    axis = rng.normal(size=3)
    x, y, z = (axis / np.linalg.norm(axis)).tolist()
    return (x, y, z)


def made(kind: str, axis: Sequence[float] = (0, 0, 1)) -> Joint:
    x, y, z = axis
    word, options = VARIANTS[kind]
    return JOINTS[word]("j", ("ground", "b"), axis=(x, y, z), **options)


FREEDOMS = {kind: made(kind).freedoms for kind in VARIANTS}


def state(joint: Joint, rng: np.random.Generator) -> tuple[NDArray[Any], NDArray[Any]]:
    """A state; the coordinates of a quaternion are those called q, and have length one."""
    quantities = joint.positions()
    q = rng.normal(size=len(quantities))
    turning = [k for k, quantity in enumerate(quantities) if quantity.unit == "1"]
    if turning:
        q[turning] /= np.linalg.norm(q[turning])
    return q, rng.normal(size=joint.freedoms)


def rates(joint: Joint, q: Any, v: Any) -> NDArray[Any]:
    found = joint.rates(ALGEBRA, tuple(q), tuple(v))
    return np.array(found, dtype=complex).reshape(len(q)).real


def vector(a: Any) -> Array:
    return np.array(a, dtype=complex)


def skew(w: Array) -> Array:
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


def combined(vectors: Sequence[Any], v: Any) -> Array:
    total = np.zeros(3, dtype=complex)
    for a, rate in zip(vectors, v, strict=True):
        total = total + rate * vector(a)
    return total


def near(found: Any, expected: Any, tolerance: float = EXACT) -> None:
    scale = 1 + float(np.abs(expected).max(initial=0))
    np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance * scale)


def check_derivatives(motion: Callable[[Any], Motion], q: Any, qdot: Any, v: Any) -> None:
    """Subspaces and biases of a motion against its derivatives along q'."""
    now, ahead = motion(q), motion(q + 1j * STEP * qdot)
    rotation = vector(now.rotation.matrix())
    turning = vector(ahead.rotation.matrix()).imag / STEP
    moving = vector(ahead.displacement).imag / STEP
    w, u = combined(now.angular, v), combined(now.linear, v)
    near(rotation @ rotation.T, np.eye(3))
    near(rotation.T @ turning, skew(w))
    near(rotation.T @ moving, u)
    near(vector(now.angular_bias), combined(ahead.angular, v).imag / STEP)
    near(vector(now.linear_bias), combined(ahead.linear, v).imag / STEP)


# ---- what a joint says of itself


def test_the_register_is_keyed_by_kind_and_the_builder_has_its_words() -> None:
    for kind, joint_type in JOINTS.items():
        assert joint_type.kind == kind
        model = Model("m")
        body = model.body("b")
        joint = getattr(model, kind)("j", between=("ground", body), **NEEDED.get(kind, {}))
        assert type(joint) is joint_type
        assert model.joints == (joint,)
        assert getattr(model, kind).__doc__


@KINDS
def test_lengths_names_and_units(kind: str) -> None:
    joint = made(kind)
    q, v = joint.positions(), joint.velocities()
    assert len(v) == joint.freedoms
    assert len(joint.rest()) == len(q) >= len(v)
    for quantities in (q, v):
        names = [quantity.name for quantity in quantities]
        assert len(names) == len(set(names))
        assert all(name == "j" or name.startswith("j_") for name in names)
        assert all(quantity.about for quantity in quantities)
    assert {quantity.unit for quantity in q} <= {"rad", "m", "1"}
    assert {quantity.unit for quantity in v} <= {"rad/s", "m/s"}
    if len(q) == len(v):
        assert [quantity.unit for quantity in v] == [f"{quantity.unit}/s" for quantity in q]
    if joint.freedoms == 1:
        assert [quantity.name for quantity in (*q, *v)] == ["j", "j"]


@KINDS
def test_at_rest_head_and_tail_coincide(kind: str) -> None:
    joint = made(kind)
    motion = joint.motion(Floats(), joint.rest(), (0.0,) * joint.freedoms)
    # oblique axes leave the rounding of constant rotations
    tolerance = 1e-15 if kind in ("oblique universal", "compound of many") else 0.0
    near(np.array(motion.rotation.matrix(), dtype=float), np.eye(3), tolerance)
    np.testing.assert_array_equal(np.array(motion.displacement, dtype=float), np.zeros(3))


@KINDS
@SEEDS
def test_lengths_of_a_motion(kind: str, seed: int) -> None:
    joint = made(kind)
    q, v = state(joint, np.random.default_rng(seed))
    motion = joint.motion(Floats(), tuple(q), tuple(v))
    assert len(motion.angular) == len(motion.linear) == joint.freedoms
    assert len(joint.rates(Floats(), tuple(q), tuple(v))) == len(q)
    for a in (*motion.angular, *motion.linear, motion.angular_bias, motion.linear_bias):
        assert len(a) == 3


@KINDS
@SEEDS
def test_no_velocity_is_idle(kind: str, seed: int) -> None:
    """The freedoms are independent: the subspace has full rank."""
    joint = made(kind)
    q, v = state(joint, np.random.default_rng(seed))
    motion = joint.motion(Floats(), tuple(q), tuple(v))
    columns = [(*s, *u) for s, u in zip(motion.angular, motion.linear, strict=True)]
    space = np.array(columns, dtype=float).reshape(-1, 6)
    assert np.linalg.matrix_rank(space) == joint.freedoms


# ---- what a joint says of its motion


@KINDS
@WAYS
@SEEDS
def test_subspaces_and_biases_are_derivatives_of_the_motion(
    kind: str, forward: bool, seed: int
) -> None:
    joint = made(kind)
    q, v = state(joint, np.random.default_rng(seed))

    def motion(coordinates: Any) -> Motion:
        along = joint.motion(ALGEBRA, tuple(coordinates), tuple(v))
        return along if forward else reverse(along)

    check_derivatives(motion, q, rates(joint, q, v), v)


@KINDS
@SEEDS
def test_reversing_gives_the_inverse_motion(kind: str, seed: int) -> None:
    joint = made(kind)
    q, v = state(joint, np.random.default_rng(seed))
    motion = joint.motion(ALGEBRA, tuple(q), tuple(v))
    back = reverse(motion)
    rotation = vector(motion.rotation.matrix())
    near(vector(back.rotation.matrix()), rotation.T)
    near(rotation @ vector(back.displacement) + vector(motion.displacement), np.zeros(3))
    again = reverse(back)
    near(vector(again.rotation.matrix()), rotation)
    near(vector(again.displacement), vector(motion.displacement))
    for ours, theirs in ((motion.angular, again.angular), (motion.linear, again.linear)):
        near(combined(theirs, v), combined(ours, v))


@KINDS
@SEEDS
def test_the_axis_is_the_z_of_the_aligned_frame(kind: str, seed: int) -> None:
    """Where the motion has an axis: along it, about it or normal to it, whatever its direction."""
    axis = unit_axis(np.random.default_rng(seed))
    joint = made(kind, axis)
    alignment = np.array(joint.alignment(), dtype=float)
    near(alignment @ alignment.T, np.eye(3))
    if joint.kind in UNALIGNED:
        np.testing.assert_array_equal(alignment, np.eye(3))
    elif joint.kind not in ("universal", "compound"):
        near(alignment[:, 2], np.array(axis))


def test_the_last_axis_of_rotation_is_the_z_of_several() -> None:
    """Universal and compound joints have axes of their own; coordinate axes are left as they are."""
    np.testing.assert_array_equal(np.array(made("universal").alignment()), np.eye(3))
    for kind, last in (
        ("oblique universal", (0.5, 0, 1)),
        ("compound", (0.6, 0, 0.8)),
        ("compound of many", (1, 0, 1)),
    ):
        expected = np.array(last) / np.linalg.norm(last)
        near(np.array(made(kind).alignment(), dtype=float)[:, 2], expected)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, -1), (0, -1, 0)])
def test_axes_in_the_users_frames(axis: tuple[int, int, int]) -> None:
    """A revolute joint turns about its axis, a prismatic one slides along it, a planar one across."""
    a = np.array(axis, dtype=float)
    for kind in ("revolute", "prismatic", "planar"):
        joint = made(kind, axis)
        out = np.array(joint.alignment(), dtype=float)
        q = (0.3,) if joint.freedoms == 1 else (0.3, 0.4, 0.5)
        motion = joint.motion(Floats(), q, (0.0,) * joint.freedoms)
        rotation = out @ np.array(motion.rotation.matrix(), dtype=float) @ out.T
        at = out @ np.array(motion.displacement, dtype=float)
        turn, slide = {
            "revolute": (0.3, np.zeros(3)),
            "prismatic": (0.0, 0.3 * a),
            "planar": (0.5, at),
        }[kind]
        cross = skew(vector(a)).real
        expected = np.eye(3) + np.sin(turn) * cross + (1 - np.cos(turn)) * cross @ cross
        near(rotation, expected)
        near(at, slide)
        if kind == "planar":
            assert at @ a == 0
            assert np.linalg.norm(at) == pytest.approx(0.5, abs=1e-15)


def test_known_motions() -> None:
    """Right-handed quarter turns, by hand."""
    quarter = np.pi / 2
    turned = made("revolute").motion(Floats(), (quarter,), (0.0,)).rotation.out((1, 0, 0))
    near(np.array(turned), np.array([0, 1, 0]))
    planar = made("planar")
    moved = planar.rates(Floats(), (0.0, 0.0, quarter), (2.0, 0.0, 3.0))
    near(np.array(moved), np.array([0, 2, 3]))
    free = made("free")
    half = np.sqrt(0.5)
    q = (1.0, 2.0, 3.0, 0.0, 0.0, half, half)
    near(np.array(free.motion(Floats(), q, (0.0,) * 6).rotation.out((1, 0, 0))), [0, 1, 0])
    moved = free.rates(Floats(), q, (1.0, 0.0, 0.0, 0.0, 0.0, 2.0))
    near(np.array(moved), np.array([0, 1, 0, 0, 0, half, -half]))


@SEEDS
def test_a_quaternion_keeps_its_length(seed: int) -> None:
    joint = made("free")
    q, v = state(joint, np.random.default_rng(seed))
    assert abs(q[3:] @ rates(joint, q, v)[3:]) < EXACT


# ---- a joint within a model


def random_inertia(rng: np.random.Generator) -> tuple[float, ...]:
    points = rng.normal(scale=0.4, size=(6, 3))
    return tuple((np.trace(points.T @ points) * np.eye(3) - points.T @ points).ravel().tolist())


def pair(kind: str, forward: bool, rng: np.random.Generator) -> Model:
    """A body that floats on a free joint and carries another on a joint of one kind."""
    model = Model("pair", gravity=tuple(rng.normal(size=3).tolist()))
    handles: list[BodyHandle] = []
    for name in ("near", "far"):
        i = random_inertia(rng)
        handles.append(
            model.body(
                name,
                mass=float(rng.uniform(0.5, 2)),
                mass_center=rng.normal(size=3).tolist(),
                inertia=(i[:3], i[3:6], i[6:]),
            )
        )
    ends = [
        handle.frame(
            "end",
            at=rng.normal(size=3).tolist(),
            rotation=tuple(tuple(row) for row in trees.random_rotation(rng).tolist()),
        )
        for handle in handles
    ]
    tail, head = ends if forward else ends[::-1]
    model.free("base", between=("ground", handles[0]))
    word, options = VARIANTS[kind]
    model.add_joint(JOINTS[word]("j", (tail, head), axis=unit_axis(rng), **options))
    return model


def pair_state(tree: KinematicTree, rng: np.random.Generator) -> tuple[list[float], list[float]]:
    q = []
    for link in tree.links:
        q += state(link.joint, rng)[0].tolist()
    return q, rng.normal(size=len(tree.velocities)).tolist()


@KINDS
@WAYS
@SEEDS
def test_regrouping_keeps_the_mass_matrix_and_the_bias(kind: str, forward: bool, seed: int) -> None:
    rng = np.random.default_rng(seed)
    tree = derive(pair(kind, forward, rng)).tree(Floats(), {})
    short = tree.regrouped()
    for _ in range(2):
        q, v = pair_state(tree, rng)
        whole, fewer = TreeState(tree, q, v), TreeState(short, q, v)
        m: NDArray[np.float64] = np.array(mass_matrix(whole))
        near(np.array(mass_matrix(fewer)), m)
        near(np.array(inverse_dynamics(fewer)), np.array(inverse_dynamics(whole)))


@KINDS
@SEEDS
def test_regrouping_loses_no_mass(kind: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    tree = derive(pair(kind, True, rng)).tree(Floats(), {})
    moments = tree.links[-1].moments
    kept, handed = made(kind).regroup(moments)
    assert kept.mass + handed.mass == moments.mass
    near(np.add(kept.first, handed.first), np.array(moments.first))


def test_regrouping_takes_what_it_promises_from_a_revolute_joint() -> None:
    """Khalil's minimal parameters: mass, first and second moment along z leave the link."""
    rng = np.random.default_rng(0)
    tree = derive(pair("revolute", True, rng)).tree(Floats(), {})
    kept = tree.regrouped().links[1].moments
    assert (kept.mass, kept.first[2], kept.second[5]) == (0, 0, 0)
    kept = derive(pair("prismatic", True, rng)).tree(Floats(), {}).regrouped().links[1].moments
    assert kept.second == (0, 0, 0, 0, 0, 0)


@KINDS
def test_effort_inputs_act_along_the_velocities(kind: str) -> None:
    rng = np.random.default_rng(1)
    model = pair(kind, True, rng)
    tree = derive(model).tree(Floats(), {})
    joint = made(kind)
    assert joint.effort == (joint.kind != "free")
    acting = joint.velocities() if joint.effort else ()
    assert [quantity.name for quantity in tree.inputs] == [quantity.name for quantity in acting]
    assert tree.layout.efforts == [(6 + k, k) for k in range(len(acting))]
    for quantity, velocity in zip(tree.inputs, acting, strict=True):
        assert quantity.unit == {"rad/s": "N*m", "m/s": "N"}[velocity.unit]


@pytest.mark.parametrize("kind", [kind for kind, count in FREEDOMS.items() if count])
def test_effort_can_be_given_and_taken(kind: str) -> None:
    word, options = VARIANTS[kind]
    for effort in (True, False):
        model = Model("m")
        body = model.body("b", mass=1, inertia=(1, 2, 3))
        joint = getattr(model, word)("j", between=("ground", body), effort=effort, **options)
        tree = derive(model).tree(Floats(), {})
        count = joint.freedoms if effort else 0
        assert len(tree.inputs) == count
        assert tree.layout.efforts == [(k, k) for k in range(count)]


@pytest.mark.parametrize("kind", [kind for kind, count in FREEDOMS.items() if count == 1])
@SEEDS
def test_a_locked_joint_is_the_joint_at_that_value(kind: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    forward = bool(seed % 2)
    model = pair(kind, forward, rng)
    q, v = pair_state(derive(model).tree(Floats(), {}), rng)
    moving = derive(model).numeric()
    model.lock("j", q[7])
    locked = derive(model).numeric()
    assert len(locked.tree.velocities) == 6
    near(np.array(locked.mass_matrix(q[:7])), np.array(moving.mass_matrix(q))[:6, :6])
    near(np.array(locked.bias(q[:7], v[:6])), np.array(moving.bias(q, [*v[:6], 0.0]))[:6])


@pytest.mark.parametrize("kind", [kind for kind, count in FREEDOMS.items() if count != 1])
def test_only_joints_of_one_freedom_can_be_locked(kind: str) -> None:
    model = Model("m")
    word, options = VARIANTS[kind]
    getattr(model, word)("j", between=("ground", model.body("b")), **options)
    with pytest.raises(ModelError, match=f'joint "j": is {word}; only joints of one freedom can'):
        model.lock("j")

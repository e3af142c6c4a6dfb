"""Joints of several freedoms: conformance, and equality with the same mechanism made of simple joints.

A joint of the family is taken apart into revolute, prismatic, planar or free joints with massless bodies
in between; the oracle's Newton-Euler equations of that mechanism must be its equations. Measured errors,
relative to 1 + the largest entry, are at most 3e-14.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from oracles import newton_euler as oracle
from support.compiled import Compiled
from support.emitted import load
from support.spec_models import model_of, numbers, rows
from systems import random_trees as trees

import linegraph as lg
from linegraph.algebra.protocol import Floats
from linegraph.components.joints import JOINTS, Compound, Helical, Spherical, Universal
from linegraph.components.joints.spherical import SEQUENCES
from linegraph.emission.emit import module_for, render
from linegraph.model.body_handle import BodyHandle
from linegraph.numeric.reference import Numeric
from linegraph.paper.joint_form import paper_matrices
from linegraph.spatial.inertia import Moments
from linegraph.spatial.rotation import Turn

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


TOLERANCE = 1e-12
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
AXES = dict(zip("xyz", (X, Y, Z), strict=True))
Parts = list[tuple[str, Any]]


@dataclass(frozen=True)
class Case:
    """A joint of the family and what it consists of.

    Attributes:
        word: the model's word for it.
        options: what is said besides name and terminals.
        parts: kind and axis of each simple joint, tail to head.
        leads: parts whose next one is a slide that follows them, and the lead of the two as a screw.
    """

    word: str
    options: dict[str, Any]
    parts: Parts
    leads: tuple[tuple[int, float], ...] = ()


def universal(rng: np.random.Generator, kind: str) -> Case:
    first, second = direction(rng), direction(rng)
    if kind == "normal":
        second = np.cross(first, second)
        second /= np.linalg.norm(second)
    if kind == "plane":
        first, second = np.array([0.6, 0.0, -0.8]), np.array([0.0, 0.0, 1.0])
    axes = (X, Y) if kind == "coordinate" else (numbers(first), numbers(second))
    return Case("universal", {"axes": axes}, [("revolute", axis) for axis in axes])


def cylindrical(rng: np.random.Generator) -> Case:
    axis = numbers(direction(rng))
    return Case("cylindrical", {"axis": axis}, [("revolute", axis), ("prismatic", axis)])


def helical(rng: np.random.Generator) -> Case:
    axis, lead = numbers(direction(rng)), float(rng.normal())
    parts: Parts = [("revolute", axis), ("prismatic", axis)]
    return Case("helical", {"axis": axis, "lead": lead}, parts, ((0, lead),))


def spherical(rng: np.random.Generator, angles: str) -> Case:
    return Case("spherical", {"angles": angles}, [("revolute", AXES[c]) for c in angles])


def free(rng: np.random.Generator, angles: str) -> Case:
    parts: Parts = [("prismatic", axis) for axis in (X, Y, Z)]
    return Case("free", {"angles": angles}, parts + [("revolute", AXES[c]) for c in angles])


def compound(rng: np.random.Generator, count: int) -> Case:
    """Any parts about any axes, a coordinate axis of either sign one time in two, but no idle ones."""
    while True:
        case = _compound(rng, count)
        if independent(case):
            return case


def independent(case: Case) -> bool:
    """Whether the parts' velocities are independent where all angles are 1."""
    if sum(3 if kind == "planar" else 1 for kind, _ in case.parts) - len(case.leads) > 6:
        return False
    joint = Compound("joint", ("a", "b"), **case.options)
    motion = joint.motion(Floats(), (1.0,) * joint.freedoms, (0.0,) * joint.freedoms)
    velocities = np.hstack([np.array(motion.angular), np.array(motion.linear)]).astype(float)
    return bool(np.linalg.svd(velocities, compute_uv=False)[-1] > 0.05)


def _compound(rng: np.random.Generator, count: int) -> Case:
    given: list[tuple[Any, ...]] = []
    parts: Parts = []
    leads = []
    for _ in range(count):
        kind = str(rng.choice(["revolute", "prismatic", "planar", "cylindrical", "helical"]))
        axis = numbers(direction(rng))
        if rng.random() < 0.5:
            axis = numbers(rng.choice([-1.0, 1.0]) * np.eye(3)[rng.integers(3)])
        given.append((kind, axis))
        if kind == "helical":
            lead = float(rng.normal())
            given[-1] += ({"lead": lead},)
            leads.append((len(parts), lead))
        twofold = kind in ("cylindrical", "helical")
        parts += [("revolute", axis), ("prismatic", axis)] if twofold else [(kind, axis)]
    return Case("compound", {"parts": tuple(given)}, parts, tuple(leads))


FAMILY: dict[str, Callable[[np.random.Generator], Case]] = {
    "cylindrical": cylindrical,
    "helical": helical,
    **{
        f"universal {kind}": partial(universal, kind=kind)
        for kind in ("coordinate", "normal", "plane", "oblique")
    },
    **{f"spherical {angles}": partial(spherical, angles=angles) for angles in SEQUENCES},
    **{f"free {angles}": partial(free, angles=angles) for angles in SEQUENCES},
    **{f"compound of {count}": partial(compound, count=count) for count in (1, 2, 3, 4)},
}


def direction(rng: np.random.Generator) -> np.ndarray:
    vector = rng.normal(size=3)
    return np.asarray(vector / np.linalg.norm(vector))


def error(found: Any, expected: Any) -> float:
    found, expected = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    return float(np.max(np.abs(found - expected)) / (1 + np.max(np.abs(expected))))


def skeleton(rng: np.random.Generator, seed: int) -> tuple[trees.Tree, trees.Joint]:
    """A random tree of solid bodies and the joint in it that the family replaces, in either direction."""
    kinds = ("revolute", "revolute", "prismatic", "planar")
    tree = trees.random_tree(rng, bodies=4, kinds=kinds, couplings=False, massless=False)
    joint = tree.joints[seed % 4]
    if seed % 8 >= 4:
        ends = {"tail": joint.head, "head": joint.tail}
        at = {"tail_at": joint.head_at, "head_at": joint.tail_at}
        turned = {"tail_rotation": joint.head_rotation, "head_rotation": joint.tail_rotation}
        joint = replace(joint, **ends, **at, **turned)
    others = tuple(other for other in tree.joints if other.name != joint.name)
    return replace(tree, joints=others), joint


def model_with(tree: trees.Tree, joint: trees.Joint, case: Case) -> lg.Model:
    """The tree with a joint of the family, declared last, between the frames of `joint`."""
    model = model_of(tree, "family")
    ends = [
        BodyHandle(model, body).frame(f"target.{end}", at=numbers(at), rotation=rows(rotation))
        for body, end, at, rotation in (
            (joint.tail, "tail", joint.tail_at, joint.tail_rotation),
            (joint.head, "head", joint.head_at, joint.head_rotation),
        )
    ]
    getattr(model, case.word)("target", between=tuple(ends), **case.options)
    return model


def taken_apart(tree: trees.Tree, joint: trees.Joint, case: Case) -> trees.Tree:
    """The same mechanism with a simple joint for each part and massless bodies in between."""
    count = len(case.parts)
    between = [f"between{k}" for k in range(1, count)]
    bodies = [trees.Body(name, 0.0, np.zeros(3), np.zeros((3, 3))) for name in between]
    stops = [joint.tail, *between, joint.head]
    here = (np.zeros(3), np.eye(3))
    joints = [
        trees.Joint(
            f"part{k}", kind, stops[k], stops[k + 1],
            *((joint.tail_at, joint.tail_rotation) if k == 0 else here),
            *((joint.head_at, joint.head_rotation) if k == count - 1 else here),
            np.array(axis, dtype=float),
        )
        for k, (kind, axis) in enumerate(case.parts)
    ]  # fmt: skip
    couplings = tuple(
        trees.Coupling(f"part{k + 1}", f"part{k}", lead / (2 * np.pi), 0.0)
        for k, lead in case.leads
    )
    return trees.Tree((*tree.bodies, *bodies), (*tree.joints, *joints), couplings, tree.gravity)


def numeric(model: lg.Model) -> Numeric:
    return lg.derive(model).numeric()


@pytest.mark.one_in(3)
@pytest.mark.seeds(range(0, 3, 2), range(8))
@pytest.mark.parametrize("name", FAMILY)
def test_equals_its_parts_with_massless_bodies(name: str, seed: int) -> None:
    """M, h, inverse dynamics, energy and rates, by the oracle and by simple joints; regrouped or not."""
    rng = np.random.default_rng([seed, list(FAMILY).index(name)])
    case = FAMILY[name](rng)
    tree, joint = skeleton(rng, seed)
    whole, parts = numeric(model_with(tree, joint, case)), taken_apart(tree, joint, case)
    simple = numeric(model_of(parts))
    regrouped = Numeric(whole.tree.regrouped())
    for _ in range(3):
        q, v = trees.random_state(rng, parts)
        a = rng.normal(size=parts.nv)
        mass, bias = oracle.mass_matrix(parts, q, v), oracle.bias(parts, q, v)
        for found in (whole, simple, regrouped):
            assert error(found.mass_matrix(q), mass) < TOLERANCE
            assert error(found.bias(q, v), bias) < TOLERANCE
            torque = oracle.inverse_dynamics(parts, q, v, a)
            assert error(found.inverse_dynamics(q, v, a), torque) < TOLERANCE
        kinetic, potential = whole.energy(q, v)
        assert error(kinetic, oracle.kinetic_energy(parts, q, v)) < TOLERANCE
        assert error(potential, oracle.potential_energy(parts, q)) < TOLERANCE
        paper = paper_matrices(whole.at(q, v).state)
        assert error(paper.A, mass) < 10 * TOLERANCE
        assert error(-np.array(paper.B), bias) < 10 * TOLERANCE


@pytest.mark.parametrize("seed", range(8))
def test_quaternion_is_a_free_joint_held_at_its_origin(seed: int) -> None:
    rng = np.random.default_rng(seed)
    tree, joint = skeleton(rng, seed)
    ball = numeric(model_with(tree, joint, Case("spherical", {}, [])))
    free = taken_apart(tree, joint, Case("free", {}, [("free", Z)]))
    place, speed = free.coordinate_slices["part0"], free.velocity_slices["part0"]
    turning = np.delete(np.arange(free.nv), np.arange(speed.start, speed.start + 3))
    regrouped = Numeric(ball.tree.regrouped())
    for _ in range(3):
        q, v = trees.random_state(rng, free)
        a = rng.normal(size=free.nv)
        q[place.start : place.start + 3] = 0
        for held in (v, a):
            held[speed.start : speed.start + 3] = 0
        own = np.delete(q, np.arange(place.start, place.start + 3))
        mass = oracle.mass_matrix(free, q, v)[np.ix_(turning, turning)]
        torque = oracle.inverse_dynamics(free, q, v, a)[turning]
        for found in (ball, regrouped):
            assert error(found.mass_matrix(own), mass) < TOLERANCE
            assert error(found.inverse_dynamics(own, v[turning], a[turning]), torque) < TOLERANCE
        energy = oracle.kinetic_energy(free, q, v), oracle.potential_energy(free, q)
        assert error(ball.energy(own, v[turning]), energy) < TOLERANCE


@pytest.mark.parametrize("angles", SEQUENCES)
@pytest.mark.parametrize("word", ["spherical", "free"])
def test_quaternion_and_angles_accelerate_alike(word: str, angles: str) -> None:
    """At the same state and under the same torque: ω̇ = S q̈ + bias."""
    rng = np.random.default_rng(SEQUENCES.index(angles))
    tree, joint = skeleton(rng, SEQUENCES.index(angles))
    first = numeric(model_with(tree, joint, Case(word, {"angles": angles}, [])))
    second = numeric(model_with(tree, joint, Case(word, {}, [])))
    joint_of_angles = JOINTS[word]("target", ("a", "b"), angles=angles)
    width, others = joint_of_angles.freedoms, len(first.tree.velocities) - joint_of_angles.freedoms
    q, v = rng.uniform(0.3, 1.2, size=others + width), rng.normal(size=others + width)
    motion = joint_of_angles.motion(Floats(), tuple(q[others:]), tuple(v[others:]))
    blocks = (motion.angular,) if word == "spherical" else (motion.linear, motion.angular)
    biases = (
        [motion.angular_bias] if word == "spherical" else [motion.linear_bias, motion.angular_bias]
    )
    jacobian = np.eye(others + width)
    jacobian[others:, others:] = np.vstack([np.array(block, dtype=float).T for block in blocks])
    remainder = np.concatenate([np.zeros(others), *biases])
    turn = np.array(motion.rotation.matrix(), dtype=float)
    same = np.concatenate([q[: others + width - 3], quaternion_of(turn)])
    torque = rng.normal(size=others + width)
    mass = np.array(first.mass_matrix(q))
    acceleration = np.linalg.solve(mass, jacobian.T @ torque - first.bias(q, v))
    mass = np.array(second.mass_matrix(same))
    expected = np.linalg.solve(mass, torque - second.bias(same, jacobian @ v))
    assert error(jacobian @ acceleration + remainder, expected) < 1e-11


def quaternion_of(r: np.ndarray) -> np.ndarray:
    """The unit quaternion x, y, z, w of a rotation matrix by less than half a turn."""
    w = np.sqrt(1 + np.trace(r)) / 2
    x, y, z = (r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1])
    return np.array([x / (4 * w), y / (4 * w), z / (4 * w), w])


class Complex:
    """The algebra in which derivatives are exact: f(x + i h) has h f'(x) as its imaginary part."""

    sin = staticmethod(cmath.sin)
    cos = staticmethod(cmath.cos)


STEP = 1e-60


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", [*FAMILY, "spherical", "free", "planar", "revolute", "prismatic"])
def test_motion_agrees_with_its_derivatives(name: str, seed: int) -> None:
    """Along q̇ = N v: R^T Ṙ = [w x], R^T ḋ = u, and ẇ and u̇ are the biases."""
    rng = np.random.default_rng([7, seed])
    case = FAMILY[name](rng) if name in FAMILY else Case(name, {}, [])
    joint = JOINTS[case.word]("target", ("a", "b"), **case.options)
    q, v = rng.normal(size=len(joint.positions())), rng.normal(size=joint.freedoms)
    if len(q) > len(v):
        q[-4:] /= np.linalg.norm(q[-4:])
    rates = np.array(joint.rates(Floats(), tuple(q), tuple(v)))
    moved = tuple(complex(x, STEP * rate) for x, rate in zip(q, rates, strict=True))
    algebra: Any = Complex()
    motion = joint.motion(algebra, moved, tuple(v))
    here = joint.motion(Floats(), tuple(q), tuple(v))
    turn = np.array(motion.rotation.matrix(), dtype=complex)
    assert error(turn.real, here.rotation.matrix()) < 1e-14
    assert error(turn.real.T @ turn.real, np.eye(3)) < 1e-14
    w, u = (np.array(columns, dtype=complex).T @ v for columns in (motion.angular, motion.linear))
    spin = turn.real.T @ turn.imag / STEP
    assert error(spin, oracle.skew(w.real)) < 1e-13
    shift = np.array(motion.displacement, dtype=complex).imag / STEP
    assert error(turn.real.T @ shift, u.real) < 1e-13
    assert error(w.imag / STEP, here.angular_bias) < 1e-13
    assert error(u.imag / STEP, here.linear_bias) < 1e-13


@pytest.mark.parametrize("name", [*FAMILY, "spherical", "free"])
def test_rest_is_where_the_frames_coincide(name: str) -> None:
    case = FAMILY[name](np.random.default_rng(0)) if name in FAMILY else Case(name, {}, [])
    joint = JOINTS[case.word]("target", ("a", "b"), **case.options)
    motion = joint.motion(Floats(), joint.rest(), (0.0,) * joint.freedoms)
    assert error(motion.rotation.matrix(), np.eye(3)) < 1e-14
    assert motion.displacement == (0, 0, 0)
    assert len({quantity.name for quantity in joint.positions()}) == len(joint.positions())
    assert len(joint.velocities()) == joint.freedoms


def test_what_is_handed_to_the_tail_body() -> None:
    """Nothing remains of what could be handed over; compound joints keep everything."""
    solid = Moments(3.0, (0.1, 0.2, 0.3), (1.0, 0.1, 0.2, 1.5, 0.3, 1.2))
    for word in ("spherical", "universal"):
        kept, handed = JOINTS[word]("joint", ("a", "b")).regroup(solid)
        assert (kept.mass, kept.first, kept.second) == (0, solid.first, solid.second)
        assert handed[:3] == (3.0, (0, 0, 0), (0, 0, 0, 0, 0, 0))
    for word in ("cylindrical", "helical", "planar"):
        options = {"lead": 0.1} if word == "helical" else {}
        kept, handed = JOINTS[word]("joint", ("a", "b"), **options).regroup(solid)
        assert (kept.mass, kept.first) == (solid.mass, solid.first)
        assert handed[:3] == (0, (0, 0, 0), (0, 0, 0, 0, 0, 1.2))
        assert kept.second == (*solid.second[:5], 0)
    gimbal = Compound("joint", ("a", "b"), parts=(("revolute", X), ("revolute", Y)))
    assert gimbal.regroup(solid)[0] == solid


def everything(name: str = "everything", lead: Any = 0.2, tilt: Any = 0.3) -> lg.Model:
    """A tree with every joint of the family, some with their head towards ground."""
    model = lg.Model(name)
    if name == "symbolic":
        lead, tilt = model.parameter("lead", lead), model.parameter("tilt", tilt)
    rng = np.random.default_rng(5)
    before: str | BodyHandle = "ground"
    joints: list[tuple[str, dict[str, Any]]] = [
        ("free", {"angles": "zyx"}),
        ("universal", {"axes": ((1, tilt, 0), (0, 1, tilt))}),
        ("helical", {"axis": (0, 1, 0), "lead": lead}),
        ("spherical", {"effort": False}),
        ("cylindrical", {"axis": (1, 2, 2)}),
        ("spherical", {"angles": "zxz"}),
        ("compound", {"parts": (("planar", Y), ("helical", (tilt, 0, 1), {"lead": lead}))}),
    ]
    for k, (word, options) in enumerate(joints):
        body = model.body(
            f"b{k}",
            mass=float(rng.uniform(1, 2)),
            mass_center=numbers(rng.normal(size=3)),
            inertia={"xx": 1.0, "xy": 0.1, "yy": 1.2, "yz": -0.2, "zz": 0.8},
        )
        frame = body.frame("in", at=numbers(rng.normal(size=3)), rpy=numbers(rng.normal(size=3)))
        ends = (frame, before) if k % 3 == 1 else (before, frame)
        getattr(model, word)(f"j{k}", between=ends, **options)
        before = body.frame("out", at=numbers(rng.normal(size=3)), axis=X, angle=0.4)
        if k == 2:
            before = "ground"
    return model


def state_of(model: lg.Model, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    q = np.concatenate(
        [
            x / np.linalg.norm(x) if len(x) > joint.freedoms else x
            for joint in model.joints
            for x in [rng.normal(size=len(joint.positions()))]
        ]
    )
    return q, rng.normal(size=sum(joint.freedoms for joint in model.joints))


def test_emitted_code_agrees_with_the_reference(tmp_path: Path) -> None:
    """Python and C, with numbers and with parameters for leads and axes."""
    model, rng = everything(), np.random.default_rng(0)
    reference = numeric(model)
    files = render(model)
    emitted, compiled = load(files, "everything", tmp_path), Compiled(files, "everything", tmp_path)
    symbolic = load(render(everything("symbolic"), languages=["python"]), "symbolic", tmp_path)
    p = symbolic.DEFAULT_PARAMETERS
    for _ in range(5):
        q, v = state_of(model, rng)
        n = len(v)
        expected = reference.mass_matrix(q), reference.bias(q, v)
        for mass, bias in (
            emitted.equations(q, v),
            symbolic.equations(p, q, v),
            compiled.call("equations", q, v, out=[(n, n), (n,)]),
        ):
            assert error(mass, expected[0]) < TOLERANCE
            assert error(bias, expected[1]) < TOLERANCE
        u = rng.normal(size=emitted.NU)
        efforts = np.zeros(n)
        efforts[[i for i in range(6, n) if not 9 <= i < 12]] = u
        acceleration = np.linalg.solve(expected[0], efforts - expected[1])
        assert error(emitted.forward_dynamics(q, v, u), acceleration) < 1e-10
        assert error(emitted.energy(q, v), reference.energy(q, v)) < TOLERANCE
        step = 1e-4
        ahead, behind = (emitted.energy(*advance(emitted, q, v, u, h)) for h in (step, -step))
        power = float(efforts @ v)
        assert abs(float(np.sum(ahead - behind)) / (2 * step) - power) < 1e-4 * (1 + abs(power))


def advance(
    emitted: Any, q: np.ndarray, v: np.ndarray, u: np.ndarray, time: float
) -> tuple[np.ndarray, np.ndarray]:
    """One step of the midpoint rule under inputs u."""
    middle = (
        q + time / 2 * emitted.coordinate_rates(q, v),
        v + time / 2 * emitted.forward_dynamics(q, v, u),
    )
    return (
        q + time * emitted.coordinate_rates(*middle),
        v + time * emitted.forward_dynamics(*middle, u),
    )


def test_closed_forms_of_a_universal_joint() -> None:
    """The symbolic equations are those of the reference."""
    model = lg.Model("cardan")
    inertia = {name: model.parameter(name, value) for name, value in (("xx", 1.0), ("zz", 3.0))}
    body = model.body("body", inertia={**inertia, "yy": 2.0})
    model.universal("cross", between=("ground", body))
    derivation = lg.derive(model)
    values = {"xx": 1.0, "zz": 3.0, "cross_angle1": 0.3, "cross_angle2": 0.4}
    values |= {"cross_angle1_dot": 0.5, "cross_angle2_dot": -0.6}
    found = np.array(derivation.symbolic.mass_matrix.subs(values), dtype=float)
    assert error(found, derivation.numeric().mass_matrix([0.3, 0.4])) < 1e-14
    found = np.array(derivation.symbolic.bias.subs(values), dtype=float).ravel()
    assert error(found, derivation.numeric().bias([0.3, 0.4], [0.5, -0.6])) < 1e-14


@pytest.mark.parametrize("symbolic", [False, True])
def test_a_locked_screw_stays_advanced(symbolic: bool) -> None:
    def build() -> lg.Model:
        model = lg.Model("screw")
        lead: Any = model.parameter("lead", 0.4) if symbolic else 0.4
        nut = model.body("nut", mass=2.0, mass_center=(0.1, 0.2, 0.3), inertia=(1, 1, 1))
        arm = model.body("arm", mass=1.0, mass_center=(0.2, 0.1, 0.3), inertia=(1, 2, 3))
        model.helical("screw", between=("ground", nut), axis=(1, 2, 2), lead=lead)
        model.revolute("hinge", between=(nut.frame("f", at=(0.3, 0, 0)), arm), axis=Y)
        return model

    locked = build()
    locked.lock("screw", 0.7)
    whole, part = numeric(build()), numeric(locked)
    assert error(part.mass_matrix([0.2]), whole.mass_matrix([0.7, 0.2])[1][1]) < 1e-14
    assert error(part.bias([0.2], [3.0]), whole.bias([0.7, 0.2], [0.0, 3.0])[1]) < 1e-14


def test_a_screw_may_follow_and_lead() -> None:
    """A nut driven through a gear: one coordinate for both."""
    model = lg.Model("drive")
    gear = model.body("gear", inertia=(1, 1, 2.0))
    nut = model.body("nut", mass=3.0, inertia=(1, 1, 0.5))
    model.revolute("gear", between=("ground", gear))
    model.helical("screw", between=("ground", nut), lead=0.1)
    model.couple("screw", to="gear", ratio=-4)
    expected = 2.0 + 16 * (0.5 + 3.0 * (0.1 / (2 * np.pi)) ** 2)
    assert error(numeric(model).mass_matrix([0.3]), [[expected]]) < 1e-15


def test_parallel_turns_of_a_compound_joint_are_one_turn() -> None:
    joint = Compound("arm", ("a", "b"), parts=(("revolute", Z), ("prismatic", X), ("revolute", Z)))
    motion = joint.motion(Floats(), (0.3, 2.0, 0.4), (0.0, 0.0, 0.0))
    (only,) = motion.rotation.factors
    assert isinstance(only, Turn)
    assert error((only.axis, only.cosine, only.sine), (2, np.cos(0.7), np.sin(0.7))) < 1e-15


def test_what_cannot_be_is_refused() -> None:
    ends = ("ground", "body")
    with pytest.raises(lg.ModelError, match=r"there are no angles 'xyy'; .* xyz, xzy, .* zyz"):
        Spherical("ball", ends, angles="xyy")
    with pytest.raises(lg.ModelError, match="there are no angles"):
        lg.Model("m").free("root", between=ends, angles="abc")
    with pytest.raises(lg.ModelError, match="parallel"):
        Universal("cross", ends, axes=((1, 2, 3), (-2, -4, -6)))
    with pytest.raises(lg.ModelError, match="two axes are needed, got 1"):
        Universal("cross", ends, axes=(X,))  # type: ignore[arg-type]
    with pytest.raises(lg.ModelError, match="length zero"):
        Universal("cross", ends, axes=(X, (0, 0, 0)))
    with pytest.raises(lg.ModelError, match="inf is not a finite number"):
        Helical("screw", ends, lead=float("inf"))
    with pytest.raises(lg.ModelError, match="has no lead"):
        lg.Model("m").helical("screw", between=ends)
    for parts, problem in (
        ((), "no parts"),
        ((("planar", X), ("planar", Y), ("revolute", Z)), "has 7 freedoms"),
        ((("spherical", X),), "a part cannot be 'spherical'; parts are revolute"),
        (("revolute",), "a part is .kind, axis. or"),
        ((("helical", X, 0.1),), "a part is .kind, axis. or"),
        ((("revolute", (0, 0)),), "three components are needed"),
        ((("revolute", (0, 0, float("nan"))),), "not a finite number"),
        ((("helical", X, {"pitch": 1}),), "part 1 has no option 'pitch'; known: lead"),
        ((("revolute", X), ("revolute", Y, {"effort": 0})), "part 2 has no option .*known: name"),
    ):
        with pytest.raises(lg.ModelError, match=problem):
            Compound("odd", ends, parts=parts)


def operations(word: str | None, frames: bool) -> int:
    """Of `equations` for three bodies, the middle one hinged to ground, with one or two joints between."""
    model = lg.Model("three")
    solid = {"mass": 2.0, "mass_center": (0.1, 0.2, 0.3)}
    inertia = {"xx": 1.1, "xy": 0.02, "xz": 0.03, "yy": 1.3, "yz": -0.05, "zz": 0.9}
    a, b, c = (model.body(name, **solid, inertia=inertia) for name in "abc")
    turned: dict[str, Any] = {"rpy": (0.3, 0.2, 0.1)} if frames else {}
    tail, head = (body.frame("joint", at=(0.3, 0.1, 0.2), **turned) for body in (a, b))
    model.revolute("base", between=("ground", a))
    if word is None:
        cross = model.body("cross")
        model.revolute("first", between=(tail, cross), axis=X)
        model.revolute("second", between=(cross, head), axis=Y)
    else:
        getattr(model, word)("joint", between=(tail, head))
    model.revolute("last", between=(b.frame("out", at=(0.2, 0.3, 0.4)), c), axis=Y)
    programs = module_for(model, "three").programs
    return next(program.operations for program in programs if program.name == "equations")


@pytest.mark.parametrize("frames", [False, True])
def test_a_universal_joint_costs_what_two_hinges_cost(frames: bool) -> None:
    """Measured: 395 and 387 with frames along the bodies' axes, 739 and 705 with turned ones."""
    assert operations("universal", frames) <= 1.06 * operations(None, frames)

"""Constraints of every kind against what mechanics says: the same joint as a branch, closed forms, books."""

from __future__ import annotations

import math
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.emitted import load

import linegraph as lg
from linegraph.components.joints import JOINTS
from linegraph.emission.emit import render
from linegraph.ir.statuses import SINGULAR_POSITION
from linegraph.numeric.between_trees import transfer

if TYPE_CHECKING:
    from collections.abc import Callable

TIME = 0.37
KINDS: dict[str, dict[str, Any]] = {
    "fixed": {},
    "revolute": {"axis": (0.6, 0, 0.8)},
    "prismatic": {"axis": (0, 1, 0)},
    "helical": {"axis": (0, 0.6, 0.8), "lead": 0.3},
    "cylindrical": {"axis": (1, 0, 0)},
    "universal": {"axes": ((1, 0.2, 0), (0.3, 0.5, 1))},
    "planar": {"axis": (0, 0, 1)},
    "spherical": {},
    "free": {},
}


def emitted(model: lg.Model, **options: Any) -> Any:
    """The emitted Python of a model."""
    with TemporaryDirectory() as folder:
        return load(render(model, languages=["python"], **options), model.name, Path(folder))


def pair(kind: str, **options: Any) -> lg.Model:
    """A body on a hinge, and another on a joint of some kind."""
    model = lg.Model("two")
    a = model.body("a", mass=2.0, mass_center=(0.1, 0.2, -0.1), inertia=(0.5, 0.6, 0.4))
    b = model.body("b", mass=1.0, mass_center=(-0.2, 0.1, 0.1), inertia=(0.3, 0.2, 0.4))
    a.frame("p", at=(0.3, -0.1, 0.2), rpy=(0.3, 0.4, 0.5))
    b.frame("p", at=(-0.3, 0.2, 0.1), rpy=(0.1, -0.4, 0.5))
    model.revolute("base", between=("ground", a), axis=(0, 1, 0))
    getattr(model, kind)("joint", between=("a.p", "b.p"), **options)
    return model


def worst_difference(model_at: Callable[[], lg.Model], seed: int, **other: Any) -> float:
    """Of reactions between the joint as a branch and as a chord."""
    rng = np.random.default_rng(seed)
    model, changed = model_at(), model_at()
    changed.formulation(**other)
    first, second = emitted(model), emitted(changed)
    head = [TIME] if model.depends_on_time else []
    base, derivation = lg.derive(model), lg.derive(changed)
    worst = 0.0
    for _ in range(4):
        u = rng.uniform(-2, 2, first.NU)
        numeric = base.numeric(t=TIME, u=u.tolist())
        q = rng.uniform(-1, 1, first.NQ).tolist()
        numeric.tree.normalise(q)
        if "joint_angle2" in first.Q_NAMES:
            # of the two sets of Euler angles of one orientation a chord measures that with this sign
            k = first.Q_NAMES.index("joint_angle2")
            q[k] = abs(q[k])
        v = rng.uniform(-1, 1, first.NV).tolist()
        there = transfer(numeric, q, v, derivation.numeric(t=TIME, u=u.tolist()))
        mine = first.reactions(*head, q, v, u)
        theirs = second.reactions(*head, *there, u)
        worst = max(worst, np.abs(mine - theirs).max() / (1 + np.abs(mine).max()))
    return float(worst)


def test_every_joint_type_is_tried_as_a_chord() -> None:
    """A compound joint is refused as a chord: its reaction directions change with q."""
    assert KINDS.keys() == JOINTS.keys() - {"compound"}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("coordinates", ["absolute", "absolute-angle"])
def test_a_chord_transmits_what_the_branch_does(kind: str, coordinates: str) -> None:
    """Efforts along it included: as a chord they are projected, as a branch they are coordinates' own."""
    at = lambda: pair(kind, **KINDS[kind])  # noqa: E731
    assert worst_difference(at, 1, coordinates=coordinates) < 1e-11


@pytest.mark.parametrize("sequence", ["xyz", "zxz", "yzx"])
def test_angles_of_a_ball_may_carry_efforts_as_a_chord(sequence: str) -> None:
    at = lambda: pair("spherical", angles=sequence)  # noqa: E731
    assert worst_difference(at, 2, coordinates="absolute") < 1e-10


@pytest.mark.parametrize("kind", ["revolute", "prismatic", "helical"])
def test_elements_act_in_chords(kind: str) -> None:
    """A spring, a damper and a law that names the chord's own coordinate and rate."""

    def at() -> lg.Model:
        model = pair(kind, **KINDS[kind])
        model.spring("spring", joint="joint", stiffness=7.0, length=0.2)
        model.damper("damper", joint="joint", damping=0.3)
        model.law("law", ("ground", "b.p"), force="3*joint + 2*der(joint) + 0.1*x")
        return model

    assert worst_difference(at, 3, coordinates="absolute") < 1e-10


@pytest.mark.parametrize(
    ("kind", "motion"),
    [
        ("revolute", "2.5*sin(2*t)"),
        ("prismatic", "0.3*t**2"),
        ("cylindrical", ["3.5*t", "sin(t)"]),
        ("universal", ["t", "0.4*t**2"]),
        ("helical", "9*t"),
    ],
)
def test_a_prescribed_chord_is_driven_like_the_branch(kind: str, motion: Any) -> None:
    """The driving force is part of the reaction; angles beyond half a turn are no matter."""
    at = lambda: pair(kind, motion=motion, **KINDS[kind])  # noqa: E731
    assert worst_difference(at, 4, coordinates="absolute") < 1e-10


def test_motion_from_inputs_drives_a_chord() -> None:
    at = lambda: pair("revolute", motion="input", **KINDS["revolute"])  # noqa: E731
    assert worst_difference(at, 5, coordinates="absolute") < 1e-10


def pendulum_on(rod: bool) -> lg.Model:
    """A load on a rigid rope from a trolley: a rod, or a massless body between two balls."""
    model = lg.Model("rope")
    trolley = model.body("trolley", mass=3.0)
    load = model.body("load", mass=2.0, inertia=(0.1, 0.2, 0.3))
    load.frame("eye", at=(0.1, 0, 0.2))
    model.prismatic("rail", between=("ground", trolley), axis=(1, 0, 0))
    model.free("pose", between=("ground", load), start=(0, 0, -2, 0, 0, 0, 1))
    if rod:
        model.rod("rope", between=(trolley, "load.eye"), length=1.8)
    else:
        rope = model.body("line")
        rope.frame("end", at=(0, 0, -1.8))
        model.universal("top", between=(trolley, rope), effort=False)
        model.spherical("bottom", between=("line.end", "load.eye"), effort=False)
        model.formulation(tree=("rail", "pose", "top"))
    return model


def test_a_rod_is_a_massless_body_between_joints() -> None:
    one, two = emitted(pendulum_on(True)), lg.derive(pendulum_on(False))
    other = emitted(two.system)
    rng = np.random.default_rng(6)
    q, v = one.project(lg.derive(pendulum_on(True)).assembled.q, rng.normal(size=one.NV))
    u = rng.normal(size=one.NU)
    a, _ = one.forward_dynamics(q, v, u)
    # the other model: rail and pose are common to both; its rope's angles follow
    names = list(other.Q_NAMES)
    guess = np.array(two.assembled.q)
    for k, name in enumerate(one.Q_NAMES):
        guess[names.index(name)] = q[k]
    held = {n: float(guess[names.index(n)]) for n in one.Q_NAMES}
    found = two.assembly(held, start=guess.tolist()).q
    J = other.constraint_jacobian(found)
    wanted = np.zeros((7, other.NV))
    for k, name in enumerate(one.V_NAMES):
        wanted[k, list(other.V_NAMES).index(name)] = 1.0
    w = np.linalg.lstsq(np.vstack([J, wanted]), np.concatenate([np.zeros(len(J)), v]), rcond=None)[
        0
    ]
    b, _ = other.forward_dynamics(found, w, u)
    for k, name in enumerate(one.V_NAMES):
        assert b[list(other.V_NAMES).index(name)] == pytest.approx(a[k], abs=1e-9)


def test_a_driver_lifts_with_what_newton_says() -> None:
    """F = m (g + z̈), and the rows are named by their axis."""
    model = lg.Model("lift", gravity=(0, 0, -9.81))
    mass = model.body("mass", mass=3.0, inertia=(1, 1, 1))
    model.free("pose", between=("ground", mass))
    model.driver("hook", between=("ground", mass), z="0.2*sin(3*t)")
    found = emitted(model)
    assert found.CONSTRAINT_NAMES == ("hook_fz",)
    q, v = found.project(TIME, [0, 0, 0, 0, 0, 0, 1], np.zeros(6))
    assert q[2] == pytest.approx(0.2 * math.sin(3 * TIME), abs=1e-14)
    assert v[2] == pytest.approx(0.6 * math.cos(3 * TIME), abs=1e-14)
    a, lam = found.forward_dynamics(TIME, q, v, [])
    acceleration = -1.8 * math.sin(3 * TIME)
    assert a[2] == pytest.approx(acceleration, abs=1e-13)
    assert lam[0] == pytest.approx(3.0 * (9.81 + acceleration), abs=1e-12)


def test_hybrid_dynamics_returns_the_driving_torque() -> None:
    """A prescribed joint in the tree: its reaction along the axis is what inverse dynamics asks for."""

    def arm(motion: Any) -> lg.Model:
        model = lg.Model("arm", gravity=(0, -9.81, 0))
        for k, near in enumerate(("ground", "b0.end")):
            body = model.body(f"b{k}", mass=1.5, mass_center=(0.2, 0, 0), inertia=(0.1, 0.1, 0.1))
            body.frame("end", at=(0.4, 0, 0))
            given = {"motion": motion} if motion and k == 0 else {}
            model.revolute(f"j{k}", between=(near, body), axis=(0, 0, 1), **given)
        return model

    driven, whole = emitted(arm("0.5*t**2")), emitted(arm(None))
    q, v, u = [0.3], [0.7], [1.1]
    a, reactions = driven.forward_dynamics(TIME, q, v, u), driven.reactions(TIME, q, v, u)
    drive = reactions[list(driven.REACTION_NAMES).index("j0_tz")]
    assert driven.DRIVE_NAMES == ("j0",)
    assert driven.drives(TIME, q, v, u) == pytest.approx([drive], abs=1e-13)
    state = ([0.5 * TIME**2, 0.3], [TIME, 0.7], [1.0, a[0]])
    tau = whole.inverse_dynamics(*state)
    assert drive == pytest.approx(tau[0], abs=1e-12)
    assert tau[1] == pytest.approx(u[0], abs=1e-12)


@pytest.mark.parametrize(
    ("kind", "motion"), [("cylindrical", ["3.5*t", "sin(t)"]), ("helical", "9*t")]
)
@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_driving_forces_do_the_power_that_is_missing(
    kind: str, motion: Any, coordinates: str
) -> None:
    """Rate of energy = efforts times rates + driving forces times prescribed rates, branch or chord."""
    model = pair(kind, motion=motion, **KINDS[kind])
    model.formulation(coordinates=coordinates)
    found = emitted(model, functions=("power",))
    rng = np.random.default_rng(11)
    base = lg.derive(model).numeric(t=TIME)
    q, v = np.array(lg.derive(model).assembled.q), rng.normal(size=found.NV)
    if getattr(found, "NC", 0):
        q, v = found.project(TIME, q, v)
    u = rng.normal(size=found.NU)
    a = found.forward_dynamics(TIME, q, v, u)
    a = a[0] if isinstance(a, tuple) else a
    h = 1e-4

    def at(s: float) -> float:
        rates = np.array(base.coordinate_rates(q.tolist(), (v + s * a / 2).tolist()))
        there = q + s * rates
        return float(np.sum(found.energy(TIME + s, there, v + s * a)))

    rate = (at(h) - at(-h)) / (2 * h)
    powers, sums = found.power(TIME, q, v, u)
    assert np.abs(sums).max() < 1e-11 * (1 + np.abs(powers).max())
    prescribed = {"cylindrical": [3.5, math.cos(TIME)], "helical": [9.0]}[kind]
    x = found.across(TIME, q, v)
    spin = x[list(found.ACROSS_NAMES).index("base_wy")]
    power = float(np.dot(found.drives(TIME, q, v, u), prescribed)) + u[0] * spin
    assert rate == pytest.approx(power, rel=2e-6, abs=1e-6)


def test_a_rod_of_variable_length_takes_it_from_inputs() -> None:
    """Length, rate and acceleration are inputs; the assembly does not wait for them."""
    model = lg.Model("winch", gravity=(0, 0, -9.81))
    bob = model.body("bob", mass=2.0)
    parts = (("prismatic", (1, 0, 0)), ("prismatic", (0, 0, 1)))
    model.compound("at", between=("ground", bob), parts=parts, effort=False, start=(0, -1))
    model.rod("rope", between=("ground", bob), length="input")
    found = emitted(model)
    assert found.U_NAMES == ("rope_length", "rope_length_rate", "rope_length_acceleration")
    u = [1.5, 0.2, 0.3]
    q, v = found.project([0.0, -1.2], [0.0, 0.0], u)
    assert q == pytest.approx([0, -1.5], abs=1e-13)
    assert v == pytest.approx([0, -0.2], abs=1e-13)
    a, lam = found.forward_dynamics(q, v, u)
    assert a == pytest.approx([0, -0.3], abs=1e-12)
    assert lam[0] == pytest.approx(-2.0 * (9.81 - 0.3), abs=1e-11)


def test_chaplygins_sleigh() -> None:
    """v̇ = c ω², ω̇ = -m c v ω / (I + m c²): Chaplygin 1911, c from the blade to the mass centre."""
    m, c, inertia = 2.0, 0.3, 0.5
    model = lg.Model("sleigh", gravity=(0, 0, 0))
    sled = model.body("sled", mass=m, mass_center=(c, 0, 0), inertia=(1, 1, inertia))
    model.planar("plane", between=("ground", sled), effort=False)
    model.blade("runner", between=("ground", sled), axis=(0, 1, 0))
    found = emitted(model)
    assert (found.NC, found.NP) == (1, 0)
    speed, spin = 1.3, 0.8
    q, v = found.project([0.1, 0.2, 0.6], [speed, 0.0, spin])
    assert v == pytest.approx([speed, 0.0, spin], abs=1e-14)
    a, lam = found.forward_dynamics(q, v, [])
    assert a[0] == pytest.approx(c * spin**2, abs=1e-13)
    assert a[2] == pytest.approx(-m * c * speed * spin / (inertia + m * c * c), abs=1e-13)
    force = m * inertia * speed * spin / (inertia + m * c * c)
    assert lam[0] == pytest.approx(force, abs=1e-12)


def test_a_ball_rolls_down_an_incline() -> None:
    """5/7 of g sin(slope), with the contact force of Newton's law."""
    slope, radius, m, g = 0.3, 0.2, 2.0, 9.81
    model = lg.Model("ball", gravity=(0, 0, -g))
    model.ground.frame("plane", axis=(0, 1, 0), angle=slope)
    ball = model.body("ball", mass=m, inertia=(0.4 * m * radius**2,) * 3)
    model.free("pose", between=("ground.plane", ball), start=(0, 0, radius, 0, 0, 0, 1))
    model.rolling("contact", between=("ground.plane", ball), radius=radius)
    found = emitted(model)
    assert (found.NC, found.NP) == (3, 1)
    q, v = found.project([0, 0, radius, 0, 0, 0, 1], np.zeros(6))
    a, lam = found.forward_dynamics(q, v, [])
    along = 5 / 7 * g * math.sin(slope)
    assert a[0] == pytest.approx(along, abs=1e-12)
    assert a[4] == pytest.approx(along / radius, abs=1e-11)
    assert lam[0] == pytest.approx(m * g * math.cos(slope), abs=1e-12)
    assert lam[1] == pytest.approx(-2 / 7 * m * g * math.sin(slope), abs=1e-12)


def test_a_torus_without_radius_is_a_ball() -> None:
    """The crown alone: the same accelerations as those of a ball of that size."""

    def rolling(**options: Any) -> Any:
        model = lg.Model("torus", gravity=(1.5, 0.5, -9.81))
        body = model.body("body", mass=2.0, inertia=(0.03, 0.04, 0.05))
        model.free("pose", between=("ground", body), start=(0, 0, 0.2, 0, 0, 0, 1))
        model.rolling("contact", between=("ground", body), **options)
        return emitted(model)

    ball, torus = rolling(radius=0.2), rolling(axis=(0, 1, 0), radius=0, crown=0.2)
    rng = np.random.default_rng(12)
    q, v = ball.project([0.1, 0.2, 0.2, *rng.normal(size=4)], rng.normal(size=6))
    assert torus.constraints(q) == pytest.approx([0.0], abs=1e-14)
    assert torus.constraint_rates(q, v) == pytest.approx(np.zeros(3), abs=1e-13)
    a, b = ball.forward_dynamics(q, v, []), torus.forward_dynamics(q, v, [])
    assert b[0] == pytest.approx(a[0], abs=1e-11)
    assert b[1][0] == pytest.approx(a[1][0], abs=1e-11)


def test_a_rounded_rim_touches_where_its_lowest_point_is() -> None:
    """d/dt of touching is the velocity there along the normal, for a rim and a crown of any tilt."""
    model = lg.Model("rim")
    body = model.body("body", mass=2.0, inertia=(0.03, 0.04, 0.05))
    model.free("pose", between=("ground", body), start=(0, 0, 0.3, 0, 0, 0, 1))
    model.rolling("contact", between=("ground", body), axis=(0, 1, 0), radius=0.3, crown=0.05)
    found, base = emitted(model), lg.derive(model).numeric()
    rng = np.random.default_rng(13)
    q = [0.0, 0.1, 0.3, *rng.normal(size=4)]
    base.tree.normalise(q)
    v = rng.normal(size=6)
    rates = np.array(base.coordinate_rates(q, v.tolist()))
    h = 1e-4

    def touching(s: float) -> float:
        there = (np.array(q) + s * rates).tolist()
        base.tree.normalise(there)
        return float(found.constraints(there)[0])

    change = (touching(-2 * h) - 8 * touching(-h) + 8 * touching(h) - touching(2 * h)) / (12 * h)
    assert change == pytest.approx(float((found.constraint_jacobian(q) @ v)[0]), abs=1e-9)


@pytest.mark.parametrize("kind", ["universal", "cylindrical", "planar"])
def test_laws_may_name_the_coordinates_of_chords(kind: str) -> None:
    """What is measured across a chord is what the branch has as its coordinates, and so are its rates."""

    def at() -> lg.Model:
        model = pair(kind, **KINDS[kind])
        names = [quantity.name for quantity in model.joints[1].positions()]
        law = " + ".join(f"{k + 1}*{name} + 0.3*der({name})" for k, name in enumerate(names))
        model.law("law", ("ground", "b.p"), force=law)
        return model

    assert worst_difference(at, 6, coordinates="absolute") < 1e-10


def test_multipliers_that_are_not_unique_have_least_norm() -> None:
    """Bricard's linkage: no part of λ along the null space of J^T, in C and in Python."""
    from support.closed_examples import system

    s = system("bricard")
    q, v = s.project(s.start + 0.05, np.full(s.py.NV, 0.3))
    null = np.linalg.svd(s.py.constraint_jacobian(q))[0][:, s.py.RANK :]
    assert null.shape == (5, 1)
    for lam in (s.accelerate(q, v, [])[1], s.py.forward_dynamics(q, v, [])[1]):
        assert np.abs(lam).max() > 1.0
        assert np.abs(null.T @ np.ravel(lam)).max() < 1e-10


def test_a_relation_is_a_gear() -> None:
    """``der(a) - 2 der(b)`` moves like a coupling by the ratio 2, with the same speeds."""

    def shafts(coupled: bool) -> lg.Model:
        model = lg.Model("shafts")
        for name in "ab":
            body = model.body(f"disc_{name}", mass=1, mass_center=(0.1, 0, 0), inertia=(1, 1, 0.7))
            model.revolute(name, between=("ground", body), axis=(0, 1, 0), effort=name == "b")
        if coupled:
            model.couple("a", "b", ratio=2)
        else:
            model.relation("gear", "der(a) - 2*der(b)")
        return model

    free, tied = emitted(shafts(False)), emitted(shafts(True))
    a, _ = free.forward_dynamics([0.6, 0.3], [0.8, 0.4], [1.5])
    b = tied.forward_dynamics([0.3], [0.4], [1.5])
    assert a == pytest.approx([2 * b[0], b[0]], abs=1e-12)


def test_a_relation_may_depend_on_place_and_time() -> None:
    """J v̇ = γ by differences along a motion that obeys ``y' = sin(x) x' + cos(2 t)``."""
    model = lg.Model("curve")
    point = model.body("point", mass=1)
    parts = tuple(
        ("prismatic", axis, {"name": n}) for n, axis in (("x", (1, 0, 0)), ("y", (0, 1, 0)))
    )
    model.compound("at", between=("ground", point), parts=parts)
    model.relation("curve", "der(at_y) - sin(at_x)*der(at_x) - cos(2*t)")
    found = emitted(model)
    q, v = found.project(TIME, [0.4, 0.1], [0.7, 0.0])
    a, _ = found.forward_dynamics(TIME, q, v, [0.3, 0.5])

    def slip(s: float) -> float:
        at = q + s * v + s * s * a / 2
        return float(found.constraint_rates(TIME + s, at, v + s * a)[0])

    h = 1e-3
    change = (slip(-2 * h) - 8 * slip(-h) + 8 * slip(h) - slip(2 * h)) / (12 * h)
    assert slip(0.0) == pytest.approx(0.0, abs=1e-14)
    assert change == pytest.approx(0.0, abs=1e-10)


def test_baumgarte_brings_errors_back() -> None:
    """With alpha = beta the error of position dies out like (1 + beta t) exp(-beta t)."""
    beta = 5.0
    model = lg.Model("drift", gravity=(0, 0, 0))
    body = model.body("body", mass=1, inertia=(1, 1, 1))
    model.free("pose", between=("ground", body))
    model.driver("hold", between=("ground", body), x=0)
    model.formulation(baumgarte=(beta, beta))
    found = emitted(model)
    a, _ = found.forward_dynamics([0.1, 0, 0, 0, 0, 0, 1], [0.2, 0, 0, 0, 0, 0], [])
    assert a[0] == pytest.approx(-2 * beta * 0.2 - beta**2 * 0.1, abs=1e-13)
    assert found.constraint_bias([0.1, 0, 0, 0, 0, 0, 1], np.zeros(6)) == pytest.approx(0.0)


def test_a_weld_too_many_changes_nothing_but_its_reactions() -> None:
    """Two welds in parallel: six redundant rows, each weld carries half by least norm of the multipliers."""

    def table(welds: int) -> lg.Model:
        model = lg.Model("welds")
        top = model.body("top", mass=4.0, inertia=(1, 1, 1))
        model.prismatic("lift", between=("ground", top), axis=(0, 0, 1))
        load = model.body("load", mass=2.0, mass_center=(0.3, 0, 0), inertia=(1, 1, 1))
        for k in range(welds):
            model.fixed(f"weld{k}", between=(top, load))
        return model

    assert lg.derive(table(2)).assembly().redundant == 6
    one, two = emitted(table(1)), emitted(table(2))
    a = one.forward_dynamics([0.1], [0.2], [30.0])
    b, _ = two.forward_dynamics([0.1], [0.2], [30.0])
    assert b == pytest.approx(a, abs=1e-14)
    names = list(two.REACTION_NAMES)
    whole = one.reactions([0.1], [0.2], [30.0])[list(one.REACTION_NAMES).index("weld0_fz")]
    parts = two.reactions([0.1], [0.2], [30.0])
    shared = parts[names.index("weld0_fz")] + parts[names.index("weld1_fz")]
    assert shared == pytest.approx(whole, abs=1e-12)


def test_a_singular_position_is_a_status() -> None:
    """Parallelograms laid flat may fold either way: a status in C, outputs untouched, an error in Python."""
    from support.closed_examples import system
    from support.compiled import Failed

    s = system("parallelograms")
    flat = np.array([-math.pi / 2] * 3 + [math.pi / 2] * 2)
    assert np.abs(s.call("constraints", flat, out=[(s.py.NP,)])).max() < 1e-15
    with pytest.raises(Failed) as caught:
        s.accelerate(flat, np.zeros(s.py.NV), [0.0])
    assert caught.value.status == SINGULAR_POSITION.number
    with pytest.raises(np.linalg.LinAlgError, match="the position is singular") as raised:
        s.py.forward_dynamics(flat, np.zeros(s.py.NV), [0.0])
    assert raised.value.status == SINGULAR_POSITION.number
    a, _ = s.accelerate(flat + 0.01 * np.array([1, 1, 1, -1, -1]), np.zeros(s.py.NV), [0.0])
    assert a[0] == pytest.approx(-3.5 / 3 * 9.81 * math.cos(0.01), rel=1e-9)


def test_what_is_not_a_number_is_a_status() -> None:
    from support.closed_examples import system
    from support.compiled import Failed

    s = system("bricard")
    nowhere = np.full(s.py.NQ, np.nan)
    for function, out in (
        ("forward_dynamics", [(s.py.NV,), (s.py.NC,)]),
        ("project", [(s.py.NQ,), (s.py.NV,)]),
    ):
        arguments = (nowhere, np.zeros(s.py.NV), *([[]] if function == "forward_dynamics" else []))
        with pytest.raises(Failed):
            s.call(function, *arguments, out=out)


def test_parameters_that_cannot_be_assembled_are_a_status() -> None:
    """A four-bar whose fixed pivots are too far apart, at run time."""
    from linegraph.readers import modelfile

    examples = Path(__file__).parents[2] / "examples"
    found = emitted(modelfile.read(examples / "four_bar" / "four_bar.toml"))
    far = found.DEFAULT_PARAMETERS.replace(d=3.5)
    with pytest.raises(np.linalg.LinAlgError, match="no position"):
        found.project(far, [0.8, 0.0, 1.2], np.zeros(3))
    with pytest.raises(np.linalg.LinAlgError):
        found.complete(far, [0.8, 0.0, 1.2], [0.8], [1.0])


def test_outputs_are_what_they_name() -> None:
    model = lg.Model("out", gravity=(0, 0, -9.81))
    bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
    bob.frame("tip", at=(0, 0, -1.0))
    model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
    model.spring("strut", between=("ground", "bob.tip"), stiffness=5.0, length=0.4)
    model.output("height", "position(bob.tip).z")
    model.output("speed", "velocity(bob.mass_center).x")
    model.output("pull", "through(strut) + 0*across(strut)", "N")
    model.output("load", "force(hinge).z", "N")
    model.output("bend", "acceleration(bob.tip).x")
    found = emitted(model)
    assert found.OUTPUT_NAMES == ("height", "speed", "pull", "load", "bend")
    q, v, u = [0.4], [0.9], [0.2]
    y = found.outputs(q, v, u)
    (a,) = found.forward_dynamics(q, v, u)
    assert y[0] == pytest.approx(-math.cos(0.4), abs=1e-14)
    assert y[1] == pytest.approx(-0.5 * math.cos(0.4) * 0.9, abs=1e-14)
    assert y[2] == pytest.approx(5.0 * (1.0 - 0.4), abs=1e-14)
    assert y[3] == pytest.approx(found.reactions(q, v, u)[2], abs=1e-13)
    assert y[4] == pytest.approx(-math.cos(0.4) * a + math.sin(0.4) * 0.81, abs=1e-13)


@pytest.mark.parametrize("axes", ["head", "tail", "ground"])
def test_reactions_are_resolved_as_the_user_says(axes: str) -> None:
    """A pendulum: what the hinge exerts on the bob is weight and centripetal force, in three frames."""
    model = lg.Model("axes", gravity=(0, 0, -9.81))
    model.ground.frame("nail", rpy=(0, 0.7, 0))
    bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
    model.revolute("hinge", between=("ground.nail", bob), axis=(0, 1, 0), effort=False)
    model.formulation(reactions=axes)
    found = emitted(model)
    tilt, spin = 0.4, 0.9
    (a,) = found.forward_dynamics([tilt - 0.7], [spin], [])
    x, z = -0.5 * math.sin(tilt), -0.5 * math.cos(tilt)
    pull = np.array([a * z - spin**2 * x, 0.0, -a * x - spin**2 * z])
    force = 2.0 * (pull + np.array([0, 0, 9.81]))
    angle = {"head": tilt, "tail": 0.7, "ground": 0.0}[axes]
    c, s = math.cos(angle), math.sin(angle)
    turned = [c * force[0] - s * force[2], 0.0, s * force[0] + c * force[2]]
    assert found.reactions([tilt - 0.7], [spin], [])[:3] == pytest.approx(turned, abs=1e-12)


def test_reactions_from_accelerations_are_those_from_inputs() -> None:
    model = pair("universal", **KINDS["universal"])
    found = emitted(model)
    rng = np.random.default_rng(9)
    q, v, u = rng.normal(size=found.NQ), rng.normal(size=found.NV), rng.normal(size=found.NU)
    a = found.forward_dynamics(q, v, u)
    assert found.reactions_at(q, v, a) == pytest.approx(found.reactions(q, v, u), abs=1e-14)


def test_symbolic_reactions_one_edge_at_a_time() -> None:
    """Sympy's expressions give the emitted numbers."""
    import sympy

    model = lg.Model("sym", gravity=(0, 0, "-g"))
    model.parameter("g", 9.81)
    model.parameter("m", 2.0)
    bob = model.body("bob", mass="m", mass_center=(0, 0, -0.5), inertia={"yy": 0.1})
    model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
    symbolic = lg.derive(model).symbolic
    force, torque = symbolic.reaction("hinge")
    values = {"g": 9.81, "m": 2.0, "hinge": 0.4, "hinge_dot": 0.9, "a_hinge": 0.3}
    numbers = [
        float(x.subs({sympy.Symbol(k): v for k, v in values.items()})) for x in (*force, *torque)
    ]
    found = emitted(model)
    there = found.reactions_at(found.DEFAULT_PARAMETERS, [0.4], [0.9], [0.3])
    assert there == pytest.approx(numbers, abs=1e-12)
    linear, angular = symbolic.across("hinge")
    assert list(linear) == [0, 0, 0]
    assert angular[1] == sympy.Symbol("hinge_dot")


def test_symbolic_constraints_of_a_four_bar() -> None:
    """φ, J and γ over sympy give the emitted numbers at a state."""
    import sympy

    from linegraph.readers import modelfile

    examples = Path(__file__).parents[2] / "examples"
    model = modelfile.read(examples / "four_bar" / "four_bar.toml")
    symbolic, found = lg.derive(model).symbolic, emitted(model)
    q, v = np.array([0.7, -0.2, 1.3]), np.array([0.5, -0.4, 0.3])
    names = dict(zip([*symbolic.q, *symbolic.v], [*q, *v], strict=True))
    names |= {sympy.Symbol(p.name): p.value for p in model.parameters.values() if not p.derived}
    p = found.DEFAULT_PARAMETERS
    for mine, theirs in (
        (symbolic.constraints, found.constraints(p, q)),
        (symbolic.constraint_jacobian, found.constraint_jacobian(p, q)),
        (symbolic.constraint_bias, found.constraint_bias(p, q, v)),
    ):
        numbers = [float(x.subs(names)) for x in mine]
        assert np.ravel(theirs) == pytest.approx(numbers, abs=1e-12)
    assert [str(x) for x in symbolic.multipliers] == list(found.CONSTRAINT_NAMES)


def test_parallelograms_pass_their_singular_position() -> None:
    """IFToMM benchmark A02, N = 2: 10 s by Runge and Kutta's method, projected after every step.

    All rods lie flat ten times. A step of which some stage is too near to that is taken with another size.
    Compared with the exact equation of its one angle, integrated in the same way, and with the published
    positions, which converge to it with the step.
    """
    from support.closed_examples import system
    from support.compiled import Failed

    s = system("parallelograms")
    q, v = s.call("complete", np.zeros(s.py.NQ), [0.0], [-1.0], out=[(s.py.NQ,), (s.py.NV,)])
    size, t, retaken = s.py.NQ, 0.0, 0
    one = np.array([0.0, 1.0])

    def slope(x: np.ndarray) -> np.ndarray:
        a, _ = s.accelerate(x[:size], x[size:], [0.0])
        return np.concatenate([x[size:], a])

    def exact(x: np.ndarray) -> np.ndarray:
        return np.array([x[1], 3.5 / 3 * 9.81 * math.sin(x[0])])

    def step(f: Callable[[np.ndarray], np.ndarray], x: np.ndarray, h: float) -> np.ndarray:
        k1 = f(x)
        k2 = f(x + h / 2 * k1)
        k3 = f(x + h / 2 * k2)
        return x + h / 6 * (k1 + 2 * k2 + 2 * k3 + f(x + h * k3))

    while t < 10:
        for share in (1, 1.5, 2, 3, 4, 6):
            h = min(share * 2e-3, 10 - t)
            try:
                x = step(slope, np.concatenate([q, v]), h)
                ahead = s.project(x[:size], x[size:])
                slope(np.concatenate(ahead))
            except Failed as failed:
                if failed.status != SINGULAR_POSITION.number:
                    raise
                retaken += 1
                continue
            break
        else:
            raise AssertionError(f"no step passes at {t} s")
        (q, v), t, one = ahead, t + h, step(exact, one, h)
    assert retaken > 0
    place = [-math.sin(q[0]), math.cos(q[0])]
    assert place == pytest.approx([math.sin(one[0]), math.cos(one[0])], abs=1e-7)
    assert place == pytest.approx([0.3284583, 0.9445185], abs=2e-6)

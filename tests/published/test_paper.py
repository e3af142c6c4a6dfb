"""The paper's matrices, in joint form and as printed, against the recursive route.

Random models with every kind of joint, some in prescribed motion, on a moving basement. Errors are relative
to 1 + the largest entry; over 1200 models the worst was 8e-15.
"""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy

import linegraph as lg
from linegraph.dynamics import orthogonality
from linegraph.dynamics.edge_variables import InverseScheme
from linegraph.errors import ModelError
from linegraph.paper.joint_form import paper_matrices
from linegraph.paper.star_form import equations, printed_matrices
from linegraph.paper.star_inverse import star_variables

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.numeric.reference import Numeric
    from linegraph.paper.star_tree import PrintedMatrices

TOLERANCE = 1e-12
TURNING = ("revolute", "universal", "spherical xyz", "spherical zxz")
PRINTED = (*TURNING, "prismatic")
ALL = (*PRINTED, "spherical", "cylindrical", "helical", "planar", "free", "free zyx", "compound")
TIME = 0.7
PATH = ("0.3*sin(2*t)", "0.5*t**2", "0.2*cos(t) - t")
RPY = ("0.4*sin(t)", "t - 0.2*t**2", "0.7*cos(3*t)")
SEEDS = pytest.mark.parametrize("seed", range(60))


def numbers(a: Any) -> tuple[float, ...]:
    return tuple(float(x) for x in a)


def error(found: Any, expected: Any) -> float:
    found, expected = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    assert found.shape == expected.shape
    return float(np.max(np.abs(found - expected)) / (1 + np.max(np.abs(expected))))


class Drawn:
    """A random model, each joint of which may be given another motion or none."""

    def __init__(self, rng: np.random.Generator, kinds: Sequence[str], **options: Any) -> None:
        """Draw the bodies one after the other, each with its joint."""
        self.rng = rng
        self.model = lg.Model("drawn", gravity=numbers(rng.normal(scale=5, size=3)))
        self.bodies: list[Any] = []
        self.single: list[str] = []
        basement = options.get("basement")
        root: Any = "ground" if basement is None else basement(self.model)
        for k in range(options.get("count", 6)):
            alone = options.get("alone", False) and k > 0
            chained = bool(self.bodies) and (alone or rng.random() < 0.8)
            parent = self.bodies[int(rng.integers(len(self.bodies)))] if chained else root
            first = options.get("first") if k == 0 else None
            self.add(k, parent, first or str(rng.choice(list(kinds))), options.get("drive", 0.0))
        if options.get("couplings", False) and len(self.single) > 1:
            self.model.couple(self.single[-1], self.single[0], -0.7, 0.2)

    def add(self, k: int, parent: Any, kind: str, drive: float) -> None:
        rng = self.rng
        points = rng.normal(scale=0.4, size=(6, 3))
        points -= points.mean(axis=0)
        moments = points.T @ points / 3
        body = self.model.body(
            f"b{k}",
            mass=float(rng.uniform(0.5, 3)),
            mass_center=numbers(rng.normal(scale=0.3, size=3)),
            inertia=[numbers(row) for row in np.trace(moments) * np.eye(3) - moments],
        )
        ends = [self.frame(parent, f"out{k}"), self.frame(body, "in")]
        if rng.random() < 0.3:
            ends.reverse()
        word, _, angles = kind.partition(" ")
        options: dict[str, Any] = {"angles": angles} if angles else {}
        if word in ("revolute", "prismatic", "helical", "cylindrical", "planar"):
            options["axis"] = numbers(rng.normal(size=3))
        if word in ("revolute", "prismatic", "helical"):
            driven = rng.random() < drive
            if driven:
                options["drive"] = "0.5*sin(3*t) + t"
            else:
                self.single.append(f"j{k}")
        if word == "helical":
            options["lead"] = 0.4
        if word == "universal":
            options["axes"] = (numbers(rng.normal(size=3)), numbers(rng.normal(size=3)))
        if word == "compound":
            turn, slide, screw = (numbers(rng.normal(size=3)) for _ in range(3))
            parts = [("revolute", turn), ("prismatic", slide), ("helical", screw, {"lead": 0.3})]
            options["parts"] = tuple(parts)
        getattr(self.model, word)(f"j{k}", between=tuple(ends), **options)
        self.bodies.append(body)

    def frame(self, body: Any, name: str) -> Any:
        handle = self.model.ground if body == "ground" else body
        at, rpy = numbers(self.rng.normal(size=3)), numbers(self.rng.normal(size=3))
        return handle.frame(name, at=at, rpy=rpy)


def moving(model: lg.Model) -> Any:
    """A basement in given motion."""
    return model.basement(PATH, {"rpy": RPY})


def turning(model: lg.Model) -> Any:
    """A basement that turns about an oblique axis."""
    return model.basement(rotation={"axis": (1, 2, -1), "angle": RPY[1]})


def free_to_move(model: lg.Model) -> Any:
    """The same as `moving`, but with coordinates of its own."""
    # without inertia its own rows would be singular; those of the others do not know it
    handle = model.body("basement", mass=1.0, inertia=(1, 1, 1))
    axes = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    parts = [("prismatic", axis) for axis in axes] + [("revolute", axis) for axis in axes[::-1]]
    model.compound("basement", between=("ground", handle), parts=tuple(parts), effort=False)
    return handle


BASEMENTS = (None, moving, turning)


def state(numeric: Numeric, rng: np.random.Generator) -> tuple[list[float], list[float]]:
    q = rng.normal(size=len(numeric.tree.positions))
    names = [quantity.name for quantity in numeric.tree.positions]
    for start, name in enumerate(names):
        if name.endswith("_qx"):
            q[start : start + 4] /= np.linalg.norm(q[start : start + 4])
    return q.tolist(), rng.normal(size=len(numeric.tree.velocities)).tolist()


def drawn(seed: int, kinds: Sequence[str], **options: Any) -> Numeric | None:
    """None where everything in the model happens to be prescribed."""
    model = Drawn(np.random.default_rng(seed), kinds, **options).model
    numeric = lg.derive(model).numeric(t=TIME)
    return numeric if numeric.tree.velocities else None


def against_the_recursive_route(numeric: Numeric, matrices: Any, q: Any, v: Any) -> float:
    return max(
        error(matrices.A, numeric.mass_matrix(q)),
        error([-b for b in matrices.B], numeric.bias(q, v)),
    )


# ---- joint form


def joint_form_error(seed: int) -> float:
    numeric = drawn(
        seed, ALL, basement=BASEMENTS[seed % 3], couplings=True, drive=0.3 * (seed % 2), count=7
    )
    if numeric is None:
        return 0.0
    q, v = state(numeric, np.random.default_rng([seed, 1]))
    paper = paper_matrices(numeric.at(q, v).state)
    return against_the_recursive_route(numeric, paper, q, v)


@SEEDS
def test_joint_form_is_the_recursive_route(seed: int) -> None:
    assert joint_form_error(seed) < TOLERANCE


@pytest.mark.parametrize("seed", range(20))
def test_prescribed_motion_is_free_motion_that_happens(seed: int) -> None:
    """The rows of the other joints, with the basement's accelerations given as if they were found."""
    options: dict[str, Any] = {"alone": True, "count": 4}
    given = drawn(seed, PRINTED, basement=moving, **options)
    found = drawn(seed, PRINTED, basement=free_to_move, **options)
    assert given is not None
    assert found is not None
    time = sympy.Symbol("t")
    motions = [sympy.sympify(x) for x in (*PATH, *RPY[::-1])]
    x, dx, ddx = (
        [float(f.diff(time, order).subs(time, TIME)) for f in motions] for order in range(3)
    )
    q, v = state(given, np.random.default_rng([seed, 1]))
    a = np.random.default_rng([seed, 2]).normal(size=len(v))
    expected = found.inverse_dynamics(x + q, dx + v, [*ddx, *a])[6:]
    here = given.at(q, v).state
    for matrices in (paper_matrices(here), printed_matrices(here)):
        torque = np.array(matrices.A, dtype=float) @ a - np.array(matrices.B, dtype=float)
        assert error(torque, expected) < TOLERANCE


def test_columns_of_prescribed_joints_are_empty() -> None:
    numeric = drawn(3, ("revolute",), basement=moving, count=4)
    assert numeric is not None
    q, v = state(numeric, np.random.default_rng(3))
    paper = paper_matrices(numeric.at(q, v).state)
    (basement,) = (i for i, link in enumerate(numeric.tree.links) if link.place.drive)
    assert all(row[basement] == (0, 0, 0) for row in (*paper.S, *paper.K))
    assert len(paper.S) == 4
    assert len(paper.H) == 5


def test_a_first_moment_without_mass_has_no_centre() -> None:
    model = lg.Model("odd")
    body = model.body("odd", first_moment=(1, 0, 0), inertia=(1, 1, 1))
    model.revolute("hinge", between=("ground", body))
    here = lg.derive(model).numeric().at([0.1], [0.2])
    with pytest.raises(ModelError, match="no mass"):
        paper_matrices(here.state)


# ---- as printed


def printed(
    seed: int, kinds: Sequence[str], **options: Any
) -> tuple[Numeric, list[float], list[float], PrintedMatrices]:
    numeric = drawn(seed, kinds, alone=True, **options)
    assert numeric is not None
    q, v = state(numeric, np.random.default_rng([seed, 1]))
    return numeric, q, v, printed_matrices(numeric.at(q, v).state)


def printed_error(seed: int, kinds: Sequence[str], **options: Any) -> float:
    options = {"basement": BASEMENTS[seed % 3], "count": 1 + seed % 7, **options}
    numeric, q, v, paper = printed(seed, kinds, **options)
    return against_the_recursive_route(numeric, paper, q, v)


@SEEDS
def test_printed_form_is_the_recursive_route(seed: int) -> None:
    """Revolute, cardan, spherical and prismatic joints."""
    assert printed_error(seed, PRINTED) < TOLERANCE


@SEEDS
def test_printed_form_with_every_kind_of_joint(seed: int) -> None:
    """Further than the paper goes; couplings and prescribed joints within the tree."""
    options = {"couplings": True, "drive": 0.3, "first": "universal"}
    assert printed_error(seed, ALL, **options) < TOLERANCE


@pytest.mark.parametrize("seed", range(15))
@pytest.mark.parametrize("first", ["prismatic", "cylindrical", "planar", "free", "compound"])
def test_a_translational_joint_on_the_basement(first: str, seed: int) -> None:
    """The paper leaves it out; its row of K stands on chord 1."""
    assert printed_error(seed, PRINTED, first=first, basement=moving) < TOLERANCE


def star_matrices(paper: PrintedMatrices) -> dict[str, np.ndarray]:
    names = [f.name for f in fields(paper) if f.name not in ("branches", "chords", "bodies")]
    return {name: np.array(getattr(paper, name), dtype=float) for name in names}


@pytest.mark.parametrize("seed", range(20))
def test_the_star_tree_is_the_joint_tree(seed: int) -> None:
    """H of the star tree, read at mass centres, is that of the joints; so is S H; and P H = 1."""
    numeric, q, v, paper = printed(seed, PRINTED, basement=BASEMENTS[seed % 3], count=1 + seed % 7)
    m = star_matrices(paper)
    size = len(paper.chords)
    assert len(paper.branches) == size == 2 * len(paper.bodies) - 1
    assert np.array_equal(m["P"] @ m["H"], np.eye(size))
    joints = paper_matrices(numeric.at(q, v).state)
    basement = [i for i, link in enumerate(numeric.tree.links) if link.place.drive]
    h = np.delete(np.delete(np.array(joints.H), basement, 0), basement, 1)
    outer, inner = range(0, size, 2), range(1, size, 2)
    assert np.array_equal(m["H"][np.ix_(outer, outer)], -h)
    assert np.array_equal(m["H"][np.ix_(inner, outer)], h[1:])
    s = np.delete(np.array(joints.S, dtype=float), basement, 1)
    turned = np.einsum("acx,cb->abx", m["S"], m["H"])[:, outer]
    assert error(turned, np.einsum("ajx,ji->aix", s, h)) < TOLERANCE


@pytest.mark.parametrize("seed", range(10))
def test_the_circuit_equations_give_the_absolute_motion(seed: int) -> None:
    """X_b^r = H^T (X_c^r - 1 X_1^r) are the angular velocities; X_c^t - 1 X_1 sums to the centres."""
    numeric, q, v, paper = printed(seed, PRINTED, basement=moving, count=6)
    m = star_matrices(paper)
    spin = m["X_r"].copy()
    spin[0] -= m["X_1_r"]
    absolute = m["H"].T @ spin
    # inner chords do not turn: B_j belongs to the body before it
    for j, chord in enumerate(paper.chords):
        tail = int(chord.split(" -> ")[0][2:]) - 1
        if j % 2:
            assert np.all(m["X_r"][j] == 0)
            assert error(absolute[j], absolute[2 * tail]) < TOLERANCE
    energy = sum(
        absolute[b] @ m["I"][b] @ absolute[b] / 2 for b in range(0, len(paper.branches), 2)
    )
    assert 0 < energy < numeric.energy(q, v)[0]


@pytest.mark.parametrize("seed", range(20))
def test_the_sign_of_p_star(seed: int) -> None:
    """P* is max(-P, 0). Rows of P zeroed with the sign kept leave A as it is, and make B wrong."""
    numeric, q, v, paper = printed(seed, TURNING, basement=BASEMENTS[seed % 3], count=5)
    kept = [
        row if "C_" in branch else [0] * len(row)
        for branch, row in zip(paper.branches, paper.P, strict=True)
    ]
    assert [[-x for x in row] for row in kept] == paper.P_star
    wrong = equations(replace(paper, P_star=kept))
    assert error(wrong.A, paper.A) == 0
    assert against_the_recursive_route(numeric, paper, q, v) < TOLERANCE
    assert error([-b for b in wrong.B], numeric.bias(q, v)) > 0.1


@pytest.mark.parametrize("seed", range(20))
def test_z1_as_printed_is_wrong(seed: int) -> None:
    """The print has -(H P* x diag X) H m H^T (H P* x diag X)^T V, that is H P* x diag X Z_2, once more."""
    numeric, q, v, paper = printed(seed, TURNING, basement=BASEMENTS[seed % 3], count=5)
    m = star_matrices(paper)
    h = m["H"]
    moment = h @ m["P_star"] @ np.cross(m["X"], m["Z_2"])
    right = -h @ np.einsum("bxy,by->bx", m["I"], h.T @ m["V"])
    assert error(m["Z_1"], right) < TOLERANCE
    misprinted = m["B"] + np.einsum("acx,cx->a", m["S"], moment - m["Z_1"])
    bias = np.array(numeric.bias(q, v))
    assert error(-m["B"], bias) < TOLERANCE
    assert error(-misprinted, bias) > 0.01


@pytest.mark.parametrize("basement", BASEMENTS)
def test_one_body_on_the_basement(basement: Any) -> None:
    model = lg.Model("two")
    base = model.ground if basement is None else basement(model)
    for k in range(2):
        body = model.body(f"b{k}", mass=1.0, inertia=(1, 1, 1))
        model.revolute(f"j{k}", between=(base, body))
    here = lg.derive(model).numeric(t=TIME).at([0.1, 0.2], [0.3, 0.4])
    with pytest.raises(ModelError, match="carries 2 bodies"):
        printed_matrices(here.state)


@pytest.mark.parametrize("seed", range(10))
def test_external_forces_and_joint_efforts(seed: int) -> None:
    """E Y_E and S Y_c^r + K Y_c^t: loads, and springs between bodies and in joints."""
    rng = np.random.default_rng(seed)
    made = Drawn(rng, PRINTED, alone=True, basement=moving, first="revolute", count=4)
    model = made.model
    model.load("push", made.bodies[-1], force=(1, -2, 3), torque=(0.3, 0.2, "0.5*t"))
    model.spring("rope", (made.bodies[0], made.bodies[-1]), stiffness=20.0, length=0.1)
    model.spring("coil", joint="j0", stiffness=7.0, length=0.2)
    numeric = lg.derive(model).numeric(t=TIME)
    q, v = state(numeric, rng)
    here = numeric.at(q, v)
    expected = orthogonality.inverse_dynamics(here.state, None, here.passive)
    paper = printed_matrices(here.state, here.passive)
    assert error([-b for b in paper.B], expected) < TOLERANCE
    assert error(expected, numeric.bias(q, v)) == 0
    alone = orthogonality.inverse_dynamics(here.state)
    assert error(expected, alone) > 1e-3


# ---- over sympy


def test_a_double_pendulum_over_sympy() -> None:
    """Both forms give the known equations of two point masses."""
    model = lg.Model("double", gravity=(0, 0, "-g"))
    m, length, _ = (model.parameter(name) for name in "mlg")
    at = (0, 0, -length)
    first = model.body("first", mass=m, mass_center=at)
    second = model.body("second", mass=m, mass_center=at)
    model.revolute("a", between=("ground", first), axis=(0, 1, 0))
    model.revolute("b", between=(first.frame("end", at=at), second), axis=(0, 1, 0))
    symbolic = lg.derive(model).symbolic
    names = "m l g a b a_dot b_dot"
    mass, r, g, a, b, da, db = sympy.symbols(names)
    star = symbolic.printed_matrices
    c, s, j = sympy.cos(b), sympy.sin(b), mass * r**2
    inertia = sympy.Matrix([[j * (3 + 2 * c), j * (1 + c)], [j * (1 + c), j]])
    low = -mass * g * r * sympy.sin(a + b)
    right = sympy.Matrix(
        [
            j * s * (2 * da * db + db**2) - 2 * mass * g * r * sympy.sin(a) + low,
            -j * s * da**2 + low,
        ]
    )
    for matrices in (symbolic.paper_matrices, star):
        assert (sympy.Matrix(matrices.A) - inertia).applyfunc(sympy.simplify).is_zero_matrix
        rest = (sympy.Matrix(matrices.B) - right).applyfunc(sympy.expand_trig)
        assert rest.applyfunc(sympy.simplify).is_zero_matrix


# ---- the inverse scheme


@pytest.mark.parametrize("seed", range(60))
def test_the_papers_inverse_scheme_is_the_recursive_one(seed: int) -> None:
    """Joint forces projected on the joints' axes are inverse dynamics; edge by edge they are `reactions`."""
    numeric, q, v, paper = printed(seed, PRINTED, basement=BASEMENTS[seed % 3], count=1 + seed % 6)
    a = np.random.default_rng([seed, 5]).normal(size=len(v)).tolist()
    found = star_variables(paper, a)
    projected = [
        sum(np.dot(s, y) for s, y in zip(row, found.Y_c_r, strict=True))
        + sum(np.dot(k, y) for k, y in zip(slide, found.Y_c_t, strict=True))
        for row, slide in zip(paper.S, paper.K, strict=True)
    ]
    assert error(projected, numeric.inverse_dynamics(q, v, a)) < TOLERANCE
    scheme = InverseScheme(numeric.chords(q, v), a)
    moving = [link for link in numeric.tree.links if not link.place.drive]
    forces = {link.name: scheme.joints[link.joint.name].force for link in moving}
    for k, body in enumerate(paper.bodies):
        # the outer chord runs from the mass centre to the joint: it pushes the body back
        force = -np.array(found.Y_c_t[2 * k], dtype=float)
        link = next(link for link in moving if link.name == body)
        expected = np.array(forces[body], dtype=float) * (1 if link.forward else -1)
        assert error(force, expected) < TOLERANCE

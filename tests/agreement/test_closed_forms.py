"""Closed forms against numbers: every level, every quantity, random systems.

What is derived over floats is the reference. Closed forms are evaluated with 40 digits, so that differences
are those of the reference and of floats in the model. Errors are relative to 1 + the largest entry.
"""

from __future__ import annotations

import os
import random
import subprocess
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy
from agreement.test_closed_loops import model_of as closed_model
from oracles.closed_systems import random_system as closed_system
from published.book_forms import books, double_pendulum, furuta, symbols
from support.form_measures import angles, matrix_values, operations, values, vanishes, whole_floats
from sympy.physics import mechanics
from systems import random_mixed, random_systems, readable_systems
from systems.random_mixed import model_of as mixed_model

import linegraph as lg
from linegraph.dynamics import orthogonality
from linegraph.dynamics.applied_forces import efforts
from linegraph.dynamics.chords import equations as chord_equations
from linegraph.dynamics.edge_variables import InverseScheme

if TYPE_CHECKING:
    from collections.abc import Callable

    from published.book_forms import Book

    from linegraph import Derivation
    from linegraph.numeric.reference import Numeric
    from linegraph.symbolic.closed_forms import ClosedForms

Array = Any
Expr = Any

EXACT = 1e-12
SOLVED = 1e-9  # accelerations: what the conditioning of M leaves
STEP = 1e-3
SLOPE = 1e-8  # differences of the fourth order
LEVELS = ("none", "fast", "full")
LARGE = (20, 32)
"""Free bodies that carry others: nobody reads their equations, which are not simplified here."""

EVERY = range(36)
SIMPLE = tuple(seed for seed in EVERY if seed not in LARGE)
WHOLE = tuple(seed for seed in (*range(24), 24, 25, 28, 33) if seed not in LARGE)
"""Readable systems that are simplified in full: of two bodies at most, and a few of three."""

ANYTHING = (*(0, 2, 6, 12, 13, 14, 18, 19, 20, 24, 26), *(30, 31, 32, 36, 37, 38, 42, 44, 48, 56))
"""Systems of everything with three bodies at most, without those that sympy takes long to write down."""

SIMPLIFIED, UNREADABLE = (6, 18, 24, 32, 36, 38, 42, 44), (0, 12, 30)
"""Of `ANYTHING` those that are simplified, and those of which it is said that nobody could read them."""

LOOPS = (0, 1, 3, 4, 8, 12, 30, 47, 50, 168)
WITH_REACTIONS = (0, 4, 8, 12, 50)

# Seeds that are tried when nobody asks for all forms, each of them within two seconds or the only one of its
# kind:
#   readable systems   every kind of joint alone (0 to 11); a second body behind hinge, slide, cylindrical,
#                      helical, planar and compound joints (12 to 21), those behind joints that turn about
#                      two or three axes take the longest and are left out; three hinges in a row (24), and
#                      a chain with a driven joint in it (25)
#   anything           springs, dampers, laws, stops, friction and loads; couplings (14, 19, 37, 38), a base
#                      in motion (19, 37); of joints prismatic (6, 44), helical and revolute (14), compound
#                      (19), free (30, 38), spherical (32, 44), universal (37), cylindrical (42)
#   simplified         prismatic (6), revolute (36), free (38), cylindrical (42) and spherical (44) joints,
#                      with couplings and all kinds of force elements
#   refused            one, 12
#   loops              of revolute, cylindrical and spherical joints (1), of universal and fixed ones (30,
#                      50), with a prismatic (47) and with a planar joint (168)
FEW = (*range(0, 12, 2), 12, 16, 19, 24)
FEW_OF_ANYTHING = (6, 19, 32, 38, 44)
FEW_SIMPLIFIED, FEW_UNREADABLE = (6, 36, 38, 42, 44), (12,)
FEW_LOOPS = (1, 47, 168)

EXAMPLES = Path(__file__).parents[2] / "examples"


def error(found: Any, expected: Any) -> float:
    found, expected = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    assert found.shape == expected.shape
    largest = np.max(np.abs(found - expected), initial=0.0)
    return float(largest / (1 + np.max(np.abs(expected), initial=0.0)))


# ---- the reference, and closed forms at the same state


@dataclass(frozen=True)
class State:
    """A derivation at a state: the reference, and all symbols with their numbers."""

    derivation: Derivation
    numeric: Numeric
    q: list[float]
    v: list[float]
    a: list[float]
    multipliers: list[float]

    @property
    def numbers(self) -> dict[Expr, float]:
        """What closed forms are evaluated with."""
        d = self.derivation
        given = {sympy.Symbol(name): float(x) for name, x in self.numeric.parameters.items()}
        given[sympy.Symbol("t")] = self.numeric.t
        rows = ((d.q, self.q), (d.v, self.v), (d.a, self.a), (d.u, self.inputs))
        for named, row in rows:
            given |= dict(zip(named, row, strict=True))
        if self.multipliers:
            given |= dict(zip(d.symbolic.multipliers, self.multipliers, strict=True))
        return given

    @property
    def inputs(self) -> list[float]:
        return list(self.numeric.algebra.arguments["u"])

    def form(self, expression: Expr) -> Array:
        """A closed form here, in its own shape; of a number alone a float."""
        if isinstance(expression, sympy.MatrixBase):
            return matrix_values(expression, self.numbers)
        return values([expression], self.numbers)[0]

    def forces(self) -> Array:
        """Q of the reference."""
        here = self.numeric.at(self.q, self.v)
        active = orthogonality.generalised_forces(here.state, here.active)
        return np.array(efforts(here.chords, active))

    def acceleration(self) -> Array:
        """v̇ of the reference, under the multipliers here."""
        M = np.array(self.numeric.mass_matrix(self.q, self.v))
        right = self.forces() - self.numeric.bias(self.q, self.v)
        if self.multipliers:
            J = np.array(self.numeric.constraint_jacobian(self.q))
            right = right + J.T @ self.multipliers
        return np.linalg.solve(M, right)

    def scheme(self) -> InverseScheme:
        """Every edge of the reference."""
        return InverseScheme(self.numeric.chords(self.q, self.v), self.a, self.multipliers)

    def rates(self, v: Any = None) -> Array:
        """N(q) v."""
        return np.array(self.numeric.coordinate_rates(self.q, self.v if v is None else v))

    def along(self) -> Array:
        """N(q), a column for each velocity."""
        unit = np.eye(len(self.v))
        return np.array([self.rates(list(row)) for row in unit]).T.reshape(len(self.q), -1)


def state_of(derivation: Derivation, seed: int, parameters: Any = None) -> State:
    """A random state."""
    draw, tree = random.Random(seed), derivation.structure
    t = draw.uniform(0.1, 1)
    q = [draw.uniform(-1, 1) for _ in tree.positions]
    v, a = ([draw.uniform(-1, 1) for _ in tree.velocities] for _ in range(2))
    u = [draw.uniform(-1, 1) for _ in tree.inputs]
    numeric = derivation.numeric(parameters, t=t, u=u)
    numeric.tree.normalise(q)
    count = len(chord_equations(numeric.tree))
    return State(derivation, numeric, q, v, a, [draw.uniform(-1, 1) for _ in range(count)])


def agree(derivation: Derivation, level: str, seed: int, *, reactions: bool = True) -> None:
    """Everything a level gives."""
    forms_agree(derivation, at_level(derivation, level), seed, reactions=reactions)


def forms_agree(derivation: Derivation, found: ClosedForms, seed: int, *, reactions: bool) -> None:
    """All that was asked for, at two states."""
    for k in range(2):
        state = state_of(derivation, 2 * seed + k)
        n, q, v = state.numeric, state.q, state.v
        assert error(state.form(found.mass_matrix), n.mass_matrix(q, v)) < EXACT
        assert error(state.form(found.bias)[:, 0], n.bias(q, v)) < EXACT
        assert error(state.form(found.forces)[:, 0], state.forces()) < EXACT
        assert error([state.form(e) for e in found.energy], n.energy(q, v)) < EXACT
        if n.tree.closed:
            assert error(state.form(found.constraints)[:, 0], n.constraints(q)) < EXACT
            assert error(state.form(found.constraint_jacobian), n.constraint_jacobian(q)) < EXACT
            assert error(state.form(found.constraint_bias)[:, 0], n.constraint_bias(q, v)) < EXACT
        if not reactions:
            continue
        scheme = state.scheme()
        for joint in (j.name for j in derivation.system.joints):
            wrench = [state.form(part)[:, 0] for part in found.reaction(joint)]
            assert error(wrench, [list(part) for part in scheme.reaction(joint)]) < EXACT, joint


@cache
def readable(seed: int, symbolic: bool, elements: bool = True, drives: bool = True) -> Derivation:
    """A readable system; one without drives is the same one if nothing of it is driven."""
    drawn = readable_systems.system(seed, symbolic=symbolic, elements=elements, drives=drives)
    if not drives and not drawn.driven:
        return readable(seed, symbolic, elements)
    return lg.derive(drawn.model)


@cache
def form(seed: int, level: str) -> ClosedForms:
    """What a readable system has at a level."""
    return at_level(readable(seed, turns(seed)), level)


def at_level(derivation: Derivation, level: str) -> ClosedForms:
    return derivation.symbolic if level == "full" else derivation.closed_form(level)


def turns(seed: int) -> bool:
    """Whether parameters are symbols: of each kind of joint now these, now those."""
    return bool((seed + seed // 12) % 2)


# ---- every level, every quantity


def readable_agrees(seed: int, level: str) -> None:
    derivation = readable(seed, turns(seed))
    forms_agree(derivation, form(seed, level), seed, reactions=seed % 3 == 0)


@pytest.mark.seeds(FEW, EVERY)
def test_derived_forms_are_the_numbers(seed: int) -> None:
    """Symbols and numbers take turns, and so do kinds of joints."""
    readable_agrees(seed, "none")


@pytest.mark.seeds(FEW, SIMPLE)
def test_fast_closed_forms_are_the_numbers(seed: int) -> None:
    readable_agrees(seed, "fast")


@pytest.mark.seeds(FEW, WHOLE)
def test_full_closed_forms_are_the_numbers(seed: int) -> None:
    readable_agrees(seed, "full")


@pytest.mark.seeds(FEW_OF_ANYTHING, ANYTHING)
def test_whatever_a_model_may_say_has_a_form(seed: int) -> None:
    """Systems of everything, oblique and all in numbers, not simplified."""
    agree(anything(seed), "none", seed, reactions=seed % 12 == 0)


@pytest.mark.seeds(FEW_SIMPLIFIED, SIMPLIFIED)
def test_whatever_a_model_may_say_is_simplified(seed: int) -> None:
    """The same, one body with all that acts on it."""
    agree(anything(seed), "fast", seed, reactions=False)


@pytest.mark.seeds(FEW_UNREADABLE, UNREADABLE)
def test_what_nobody_could_read_is_refused(seed: int) -> None:
    """Laws of forces whose polynomials swell: it is said, and what was derived is still to be had."""
    with pytest.raises(lg.ModelError, match=r"too many terms for a closed form.*level \"none\""):
        assert anything(seed).closed_form("fast").bias
    agree(anything(seed), "none", seed, reactions=False)


@cache
def anything(seed: int) -> Derivation:
    return lg.derive(random_systems.random_system(seed).model)


@pytest.mark.parametrize("level", ["none", "fast"])
@pytest.mark.parametrize("seed", range(0, 40, 5))
def test_closed_forms_of_networks_are_the_numbers(seed: int, level: str) -> None:
    derivation = lg.derive(mixed_model(random_mixed.random_system(seed)))
    network = derivation.formulation.network
    if network is not None and network.loop_names:
        pytest.skip("its algebraic loop has no closed form")
    agree(derivation, level, seed, reactions=False)


@pytest.mark.seeds(FEW_LOOPS, LOOPS)
def test_closed_forms_of_closed_loops_are_the_numbers(seed: int) -> None:
    derivation = lg.derive(closed_model(closed_system(seed), f"closed{seed}"))
    agree(derivation, "none", seed, reactions=seed in WITH_REACTIONS)


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("name", ["four_bar", "slider_crank"])
def test_closed_forms_of_linkages_are_the_numbers(name: str, level: str) -> None:
    agree(example(name), level, 1)


@cache
def example(name: str) -> Derivation:
    from linegraph.readers.modelfile import read

    return lg.derive(read(EXAMPLES / name / f"{name}.toml"))


@pytest.mark.seeds(FEW, WHOLE)
def test_fully_simplified_forms_are_no_longer(seed: int) -> None:
    forms = [form(seed, level) for level in LEVELS]
    for name in ("mass_matrix", "bias"):
        none, some, most = (operations(getattr(found, name)) for found in forms)
        assert most <= min(some, none), name


@pytest.mark.seeds(FEW, WHOLE)
def test_simplified_forms_have_no_whole_floats(seed: int) -> None:
    found = readable(seed, symbolic=False).symbolic
    for entry in (*found.mass_matrix, *found.bias, *found.energy):
        assert not whole_floats(entry), entry


def test_the_face_of_a_derivation_is_the_full_level() -> None:
    d = lg.derive(double_pendulum())
    full = d.closed_form("full")
    assert d.mass_matrix == full.mass_matrix == d.symbolic.mass_matrix
    assert d.bias == full.bias
    assert d.forces == full.forces
    assert (d.kinetic_energy, d.potential_energy) == tuple(full.energy)
    assert d.reaction("a") == full.reaction("a")


# ---- the Coriolis matrix

SPINNING = ("spherical", "free", "planar")


def mass_slopes(state: State) -> Array:
    """∂M/∂q, differentiated by sympy: one matrix for each position."""
    d = state.derivation
    M = d.mass_matrix
    return np.array([state.form(M.diff(x)) for x in d.q])


def quadratic(state: State) -> Array:
    """What of h is quadratic in v: the even part, less h at rest."""
    q, v = state.q, state.v
    back, rest = [-x for x in v], [0.0] * len(v)
    there, here, still = (np.array(state.numeric.bias(q, x)) for x in (back, v, rest))
    return (here + there) / 2 - still


@pytest.mark.seeds(FEW, WHOLE)
def test_the_coriolis_matrix_makes_the_quadratic_forces(seed: int) -> None:
    state = state_of(readable(seed, symbolic=turns(seed)), seed)
    C = state.form(state.derivation.coriolis_matrix)
    assert error(C @ state.v, quadratic(state)) < EXACT


@pytest.mark.seeds(FEW, WHOLE)
def test_the_rate_of_m_less_twice_c_is_skew(seed: int) -> None:
    """Along q̇ = N v, quasi-velocities too."""
    state = state_of(readable(seed, symbolic=turns(seed), drives=False), seed)
    rate = np.einsum("a,aij->ij", state.rates(), mass_slopes(state))
    S = rate - 2 * state.form(state.derivation.coriolis_matrix)
    assert error(S + S.T, np.zeros_like(S)) < EXACT * (1 + np.abs(S).max())


@pytest.mark.seeds(FEW, WHOLE)
def test_the_coriolis_matrix_is_that_of_christoffel_or_linear_in_quasi_velocities(
    seed: int,
) -> None:
    if readable_systems.KINDS[seed % 12] in SPINNING:
        is_linear(seed)
    else:
        is_christoffels(seed)


def is_christoffels(seed: int) -> None:
    """C_ij = 1/2 sum_k (∂_k M_ij + ∂_j M_ik - ∂_i M_jk) v_k."""
    state = state_of(readable(seed, symbolic=turns(seed), drives=False), seed)
    dM, v = mass_slopes(state), np.array(state.v)
    expected = np.einsum("kij,k->ij", dM, v)
    expected = expected + np.einsum("jik,k->ij", dM, v) - np.einsum("ijk,k->ij", dM, v)
    assert error(state.form(state.derivation.coriolis_matrix), expected / 2) < EXACT


def is_linear(seed: int) -> None:
    """C of twice the velocities is twice C, of none it is zero."""
    d = readable(seed, symbolic=True, drives=False)
    double = {v: 2 * v for v in d.v}
    state = state_of(d, seed)
    C = d.coriolis_matrix
    assert error(state.form(C.xreplace(double)), 2 * state.form(C)) < EXACT
    assert error(state.form(C.xreplace(dict.fromkeys(d.v, sympy.S.Zero))), np.zeros(C.shape)) == 0


def test_the_coriolis_matrix_of_a_free_body_is_known() -> None:
    """Of a body at its mass centre, in its own axes: C w = w x I w, m w x v."""
    model = lg.Model("free")
    m, A, B, D = (model.parameter(name) for name in ("m", "A", "B", "D"))
    body = model.body("body", mass=m, inertia=(A, B, D))
    model.free("f", between=("ground", body), effort=False)
    d = lg.derive(model)
    v, w = sympy.Matrix(d.v[:3]), sympy.Matrix(d.v[3:])
    inertia = sympy.diag(*symbols("A B D"))
    expected = [*(sympy.Symbol("m") * w.cross(v)), *w.cross(inertia * w)]
    x, y, z, last = d.q[3:]
    unit = {last: 1 - x**2 - y**2 - z**2}
    for one, other in zip(d.coriolis_matrix * d.v, expected, strict=True):
        assert vanishes(one - other, unit)


def test_the_coriolis_matrix_of_the_double_pendulum_is_the_textbooks() -> None:
    d = lg.derive(double_pendulum())
    da, db = d.v
    m2, l1, c2, b = symbols("m2 l1 c2 b")
    h = m2 * l1 * c2 * sympy.sin(b)
    expected = sympy.Matrix([[-h * db, -h * (da + db)], [h * da, 0]])
    for one, other in zip(d.coriolis_matrix, expected, strict=True):
        assert vanishes(one - other)
    assert operations(d.coriolis_matrix) <= 1.2 * operations(expected)


def test_the_coriolis_matrix_of_the_furuta_pendulum_is_the_textbooks() -> None:
    d = lg.derive(furuta())
    dth, dal = d.v
    m, l, L, J_a, J_t, al = symbols("m l L J_a J_t al")  # noqa: E741
    k = (J_t + m * l**2 - J_a) * sympy.sin(2 * al) / 2
    h = m * L * l * sympy.sin(al)
    expected = sympy.Matrix([[k * dal, k * dth - h * dal], [-k * dth, 0]])
    for one, other in zip(d.coriolis_matrix, expected, strict=True):
        assert vanishes(one - other)
    assert operations(d.coriolis_matrix) <= 1.2 * operations(expected)


# ---- gravity


@pytest.mark.seeds(FEW, WHOLE)
def test_gravity_is_the_slope_of_its_energy(seed: int) -> None:
    """Along N, of the weights alone: springs have a part of h of their own."""
    derivation = readable(seed, symbolic=turns(seed))
    bare = readable(seed, symbolic=turns(seed), elements=False)
    state, weights = state_of(derivation, seed), state_of(bare, seed)
    assert weights.q == state.q
    slopes = np.array([weights.form(bare.potential_energy.diff(x)) for x in bare.q])
    expected = weights.along().T @ slopes
    assert error(state.form(derivation.gravity)[:, 0], expected) < EXACT


@pytest.mark.seeds(FEW, WHOLE)
def test_bias_is_coriolis_and_gravity_where_nothing_else_acts(seed: int) -> None:
    d = readable(seed, symbolic=turns(seed), elements=False, drives=False)
    state = state_of(d, seed)
    found = state.form(d.coriolis_matrix) @ state.v + state.form(d.gravity)[:, 0]
    assert error(found, state.numeric.bias(state.q, state.v)) < EXACT


@pytest.mark.seeds(FEW, WHOLE)
def test_kinetic_energy_is_that_of_m(seed: int) -> None:
    d = readable(seed, symbolic=turns(seed), drives=False)
    state = state_of(d, seed)
    v = np.array(state.v)
    assert error(state.form(d.kinetic_energy), v @ state.form(d.mass_matrix) @ v / 2) < EXACT


# ---- the equations


@pytest.mark.seeds(FEW, WHOLE)
def test_equations_hold_where_the_reference_accelerates(seed: int) -> None:
    hold(readable(seed, symbolic=turns(seed)), seed)


@pytest.mark.parametrize("name", ["four_bar", "slider_crank", "cart_pole_motor"])
def test_equations_of_examples_hold_where_the_reference_accelerates(name: str) -> None:
    hold(example(name), 1)


def hold(derivation: Derivation, seed: int) -> None:
    """And nowhere else."""
    found = derivation.equations()
    assert all(isinstance(e, sympy.Equality) for e in found)
    state = state_of(derivation, seed)
    numbers = state.numbers | dict(zip(derivation.a, state.acceleration(), strict=True))
    size = len(derivation.v)
    for e in found[:size]:
        left, right = values([e.lhs, e.rhs], numbers)
        assert error([left], [right]) < SOLVED
    off = numbers | {x: numbers[x] + 1 for x in derivation.a}
    residues = [float(np.ptp(values([e.lhs, e.rhs], off))) for e in found[:size]]
    assert max(residues) > 1e-6
    # under any multipliers accelerations miss the constraints by what they miss them in the reference
    rest = [float(np.subtract(*values([e.lhs, e.rhs], numbers))) for e in found[size:]]
    n = state.numeric
    J = np.array(n.constraint_jacobian(state.q)).reshape(-1, size)
    missed = J @ state.acceleration() - n.constraint_bias(state.q, state.v)
    # rows that say 0 = 0 are no equations
    rows = zip(
        derivation.constraint_jacobian * derivation.a, derivation.constraint_bias, strict=True
    )
    said = [any(side != 0 for side in row) for row in rows]
    assert error(rest, missed[said]) < SOLVED
    assert not missed[np.logical_not(said)].any()


def test_equations_are_collected_in_accelerations() -> None:
    """Each acceleration stands once in an equation, with its entry of M."""
    d = lg.derive(double_pendulum())
    for i, equation in enumerate(d.equations()):
        whole = equation.lhs - equation.rhs
        for j, a in enumerate(d.a):
            assert equation.count(lambda e, a=a: e == a) == 1
            assert vanishes(whole.diff(a) - d.mass_matrix[i, j])


# ---- refused


@pytest.mark.parametrize("budget", [20, 40, 60])
def test_what_is_refused_changes_nothing_that_is_asked_later(budget: int) -> None:
    """The same form, or the same refusal, as where nothing was asked before."""
    names = ("mass_matrix", "bias", "coriolis_matrix", "gravity", "kinetic_energy")
    derivation = example("furuta")

    def asked(form: Any, name: str) -> Any:
        try:
            return getattr(form, name)
        except lg.ModelError as error:
            return str(error)

    alone = {name: asked(derivation.closed_form(budget=budget), name) for name in names}
    refused = [name for name in names if isinstance(alone[name], str)]
    assert 0 < len(refused) < len(names)
    for first in refused:
        form = derivation.closed_form(budget=budget)
        asked(form, first)
        generators, work = len(form.simplifier.ring.generators), form.simplifier.ring.work
        assert (generators, work) == (0, 0)
        for name in names:
            form = derivation.closed_form(budget=budget)
            asked(form, first)
            assert asked(form, name) == alone[name]


# ---- linearised


def flow(derivation: Derivation, parameters: Any = None) -> Callable[[Any, Any], Array]:
    """ẋ = f(x, u) of the reference."""

    def f(x: Any, u: Any) -> Array:
        numeric = derivation.numeric(parameters, t=0.0, u=[float(e) for e in u])
        n = len(numeric.tree.positions)
        q, v = [float(e) for e in x[:n]], [float(e) for e in x[n:]]
        at = State(derivation, numeric, q, v, v, [])
        return np.concatenate([at.rates(), at.acceleration()])

    return f


def jacobian(f: Callable[[Array], Array], x: Array) -> Array:
    """By differences of the fourth order."""
    columns = []
    for k in range(len(x)):
        e = np.eye(len(x))[k] * STEP
        columns.append((8 * (f(x + e) - f(x - e)) - (f(x + 2 * e) - f(x - 2 * e))) / (12 * STEP))
    return np.array(columns).T


LINEARISED = {
    "furuta": ({"hinge": 0}, {"hinge": sympy.pi}),
    "cart_pole_motor": ({"swing": 0}, {"swing": sympy.pi}),
    "cart_pole": ({"swing": 0, "slide": 0}, {"swing": sympy.pi, "slide": sympy.Rational(1, 4)}),
}


@pytest.mark.parametrize("up", [0, 1], ids=["hanging", "upright"])
@pytest.mark.parametrize("name", LINEARISED)
def test_linearised_equations_are_the_slopes_of_the_reference(name: str, up: int) -> None:
    derivation = example(name)
    at = LINEARISED[name][up]
    space = derivation.linearise(at=at)
    assert list(space.states) == [str(x) for x in (*derivation.q, *derivation.v)]
    assert list(space.inputs) == [str(x) for x in derivation.u]
    x = np.array([float(at.get(name, 0)) for name in space.states])
    u = np.zeros(len(space.inputs))
    f = flow(derivation)
    A, B, *_ = space.numeric()
    slopes = jacobian(lambda x: f(x, u), x)
    assert error(A, slopes) < SLOPE
    assert error(B, jacobian(lambda u: f(x, u), u)) < SLOPE
    assert (
        error(spectrum(A), spectrum(slopes)) < 1e-5
    )  # eigenvalues of defective zeros part by roots
    assert (max(np.linalg.eigvals(A).real) > 0.1) == bool(up)


def spectrum(A: Array) -> Array:
    """The coefficients of the characteristic polynomial over a scale: eigenvalues without an order."""
    scale = np.abs(np.linalg.eigvals(A)).max()
    return np.poly(A / scale)


def test_linearised_equations_keep_their_symbols() -> None:
    """The pendulum upright: g m l / (J_t + m l²) less what the arm carries."""
    d = lg.derive(furuta())
    A = d.linearise(at={"al": sympy.pi}).A
    g, m, l, L, J0, _, J_t = symbols("g m l L J0 J_a J_t")  # noqa: E741
    J_a = sympy.Symbol("J_a")
    arm, pole, between = J0 + m * L**2 + J_a, J_t + m * l**2, m * L * l
    expected = g * m * l * arm / (arm * pole - between**2)
    assert vanishes(A[3, 1] - expected)
    assert A[0, 2] == A[1, 3] == 1
    assert not A.atoms(sympy.Float)


def test_other_parameters_have_other_slopes() -> None:
    derivation = example("furuta")
    chosen = {"L": 0.31, "m": 0.2}
    A, _, *_ = derivation.linearise(at={"hinge": sympy.pi}).numeric(chosen)
    x = np.array([0, np.pi, 0, 0])
    expected = jacobian(lambda x: flow(derivation, chosen)(x, [0.0]), x)
    assert error(A, expected) < SLOPE


@pytest.mark.parametrize("at", [{"hinge": 0.3}, {"hinge": sympy.pi / 2}])
def test_off_equilibrium_nothing_is_linearised(at: Any) -> None:
    with pytest.raises(lg.ModelError, match="equilibrium"):
        example("furuta").linearise(at=at)


def test_an_unknown_coordinate_is_named() -> None:
    with pytest.raises(lg.ModelError, match="hing"):
        example("furuta").linearise(at={"hing": 0})


# ---- fast evaluation


def called(function: Any, state: State, parameters: Any = None, **others: Any) -> Any:
    """A function of `Derivation.function` with those arguments that it takes."""
    given = {"t": state.numeric.t, "u": state.inputs} | {k: getattr(state, k) for k in "qva"}
    given |= others
    return function(*(given[name] for name in function.arguments), parameters=parameters)


NEAREST = 1e-14


@pytest.mark.seeds(FEW, EVERY[::3])
def test_functions_are_the_reference(seed: int) -> None:
    d = readable(seed, symbolic=bool(seed // 3 % 2))
    state = state_of(d, seed)
    q, v = state.q, state.v
    assert error(called(d.function("mass_matrix"), state), state.numeric.mass_matrix(q)) < NEAREST
    assert error(called(d.function("bias"), state), state.numeric.bias(q, v)) < NEAREST
    energy = called(d.function("energy"), state)
    assert error(energy, state.numeric.energy(q, v)) < NEAREST


def test_functions_take_many_states_at_once() -> None:
    d = example("furuta")
    states = [state_of(d, seed) for seed in range(5)]
    q, v = (np.array([getattr(s, name) for s in states]) for name in "qv")
    M = called(d.function("mass_matrix"), states[0], q=q)
    h = called(d.function("bias"), states[0], q=q, v=v)
    assert M.shape == (5, 2, 2)
    assert h.shape == (5, 2)
    for k, state in enumerate(states):
        assert error(M[k], state.numeric.mass_matrix(state.q)) < NEAREST
        assert error(h[k], state.numeric.bias(state.q, state.v)) < NEAREST


def test_functions_take_parameters() -> None:
    d = example("furuta")
    chosen = {"L": 0.31, "m": 0.2}
    state = state_of(d, 3)
    M = called(d.function("mass_matrix"), state, parameters=chosen)
    expected = d.numeric(chosen).mass_matrix(state.q)
    assert error(M, expected) < NEAREST
    assert error(M, state.numeric.mass_matrix(state.q)) > 1e-4


def test_an_unknown_function_is_named() -> None:
    with pytest.raises(lg.LinegraphError, match="mass_matrices"):
        example("furuta").function("mass_matrices")


# ---- as sympy.physics.mechanics has it


def test_coordinates_become_functions_of_time() -> None:
    d = lg.derive(double_pendulum())
    a, b = mechanics.dynamicsymbols("a b")
    time = mechanics.dynamicsymbols._t
    moving = d.dynamic(d.bias + d.mass_matrix * d.a)
    known = {*symbols("g m1 m2 l1 c1 c2 I1 I2"), time}
    assert moving.free_symbols <= known
    assert mechanics.find_dynamicsymbols(moving) == {
        x.diff(time, k) for x in (a, b) for k in (0, 1, 2)
    }
    back = {a.diff(time, 2): d.a[0], b.diff(time, 2): d.a[1]}
    back |= {a.diff(time): d.v[0], b.diff(time): d.v[1]}
    back |= {a: d.q[0], b: d.q[1]}
    for old, new in back.items():
        moving = moving.subs(old, new)
    assert moving == d.bias + d.mass_matrix * d.a


def test_quasi_velocities_become_functions_by_their_own_names() -> None:
    model = lg.Model("free")
    body = model.body("body", mass=2, inertia=(1, 2, 3))
    model.spherical("o", between=("ground", body), effort=False)
    d = lg.derive(model)
    moving = d.dynamic(d.mass_matrix * d.a + d.bias)
    wx, wy, wz = mechanics.dynamicsymbols("o_wx o_wy o_wz")
    time = mechanics.dynamicsymbols._t
    expected = sympy.Matrix(
        [
            wx.diff(time) + wy * wz,
            2 * wy.diff(time) - 2 * wx * wz,
            3 * wz.diff(time) + wx * wy,
        ]
    )
    assert (moving - expected).applyfunc(sympy.expand).is_zero_matrix


def test_lagranges_method_of_sympy_takes_our_energies() -> None:
    """Its mass matrix and forcing, from T and U of the derivation, are those of the derivation."""
    d = lg.derive(double_pendulum())
    q = mechanics.dynamicsymbols("a b")
    method = mechanics.LagrangesMethod(d.dynamic(d.kinetic_energy - d.potential_energy), q)
    method.form_lagranges_equations()
    for one, other in zip(method.mass_matrix, d.dynamic(d.mass_matrix), strict=True):
        assert vanishes(plain(one - other, d))
    for one, other in zip(method.forcing, d.dynamic(d.forces - d.bias), strict=True):
        assert vanishes(plain(one - other, d))


def plain(expression: Expr, d: Derivation) -> Expr:
    """Functions of time as symbols again."""
    q = mechanics.dynamicsymbols("a b")
    time = mechanics.dynamicsymbols._t
    rates = {x.diff(time): v for x, v in zip(q, d.v, strict=True)}
    return expression.subs(rates).subs(dict(zip(q, d.q, strict=True)))


# ---- symbols and numbers alike


@pytest.mark.seeds(FEW, WHOLE)
def test_numbers_for_parameters_cost_nothing(seed: int) -> None:
    """A system said in numbers has forms as short, within a fifth, as the symbols' with numbers put in."""
    named, plain_numbers = readable(seed, symbolic=True), readable(seed, symbolic=False)
    point = {sympy.Symbol(p.name): sympy.Float(p.value) for p in named.system.parameters.values()}
    for name in ("mass_matrix", "bias", "gravity", "potential_energy"):
        by_symbols, by_numbers = getattr(named, name), getattr(plain_numbers, name)
        expected = by_symbols.subs(point)
        assert operations(by_numbers) <= 1.2 * operations(expected), name
        state = state_of(plain_numbers, seed)
        assert error(state.form(by_numbers), state.form(expected)) < EXACT, name


def test_numbers_keep_angles_together() -> None:
    """The double pendulum in numbers looks as it does in symbols."""
    model = lg.Model("numbers", gravity=(0, 0, -9.8))
    upper = model.body("b1", mass=0.37, mass_center=(0, 0, -1.21), inertia={"yy": 0.83})
    lower = model.body("b2", mass=0.59, mass_center=(0, 0, -1.73), inertia={"yy": 0.47})
    tip = upper.frame("tip", at=(0, 0, -1.09))
    model.revolute("a", between=("ground", upper), axis=(0, 1, 0), effort=False)
    model.revolute("b", between=(tip, lower), axis=(0, 1, 0), effort=False)
    d = lg.derive(model)
    a, b = d.q
    assert angles(d.mass_matrix) == {b}
    assert angles(d.gravity) == {a, a + b}
    book = next(book for book in books() if book.name == "double pendulum, relative angles")
    given = {
        "m1": 0.37, "c1": 1.21, "I1": 0.83, "m2": 0.59, "c2": 1.73, "I2": 0.47, "l1": 1.09, "g": 9.8,
    }  # fmt: skip
    point = {sympy.Symbol(name): sympy.Float(x) for name, x in given.items()}
    for ours, theirs in ((d.mass_matrix, book.M), (d.bias, book.h)):
        assert operations(ours) <= 1.2 * operations(theirs.subs(point))
    # numbers are those that were given, multiplied: no digits of rounding beside them
    assert all(len(str(x)) < 18 for x in d.mass_matrix.atoms(sympy.Float))


# ---- no form is wrong


SMALL = 3
"""Velocities of an example at most, that is written in closed form here."""

QUANTITIES = ("mass_matrix", "bias", "forces", "energy", "gravity", "coriolis_matrix")


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", sorted(path.stem for path in EXAMPLES.glob("*/*.toml")))
def test_no_form_of_an_example_is_rejected(name: str) -> None:
    """A form that differs from what was derived is not used; that one was made at all is a bug."""
    derivation = example(name)
    if len(derivation.structure.velocities) <= SMALL:
        none_is_rejected(derivation)


@pytest.mark.parametrize("book", books(), ids=lambda book: book.name)
def test_no_form_of_a_book_is_rejected(book: Book) -> None:
    none_is_rejected(lg.derive(book.model()))


def none_is_rejected(derivation: Derivation) -> None:
    for name in QUANTITIES:
        assert getattr(derivation.symbolic, name) is not None
        assert derivation.symbolic.simplifier.rejected == [], name


# ---- the same every time


def test_forms_do_not_depend_on_the_order_of_hashes(tmp_path: Path) -> None:
    script = tmp_path / "forms.py"
    script.write_text(
        "import sys\n"
        f"sys.path.insert(0, {str(Path(__file__).parents[1])!r})\n"
        "import sympy; from published import book_forms\n"
        "import linegraph as lg\n"
        "for make in (book_forms.double_pendulum, book_forms.furuta):\n"
        "    d = lg.derive(make()).symbolic\n"
        "    print(sympy.srepr(d.mass_matrix), d.bias, d.energy)\n"
    )
    found = {
        subprocess.run(
            [sys.executable, str(script)],
            env={**os.environ, "PYTHONHASHSEED": seed},
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        for seed in ("1", "2", "77")
    }
    assert len(found) == 1

"""The tree is a choice and never the physics: absolute coordinates and absolute angles on random trees.

Each system is derived three times. A state of one is carried over to the others by the motion of the bodies;
what every joint transmits, which depends on every acceleration, has to be the same, and so has the kinetic
energy.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.emitted import load
from support.spec_models import model_of
from systems import random_trees as trees

import linegraph as lg
from linegraph.emission.emit import render
from linegraph.model.choices import ABSOLUTE, ABSOLUTE_ANGLE
from linegraph.numeric.between_trees import transfer

if TYPE_CHECKING:
    from linegraph.derivation import Derivation

TOLERANCE = 1e-9


@cache
def tree(seed: int) -> Any:
    rng = np.random.default_rng(seed)
    return trees.random_tree(rng, bodies=2 + seed % 5, couplings=False, massless=False)


def derived(model: lg.Model, name: str) -> tuple[Any, Derivation]:
    """The emitted Python of a model, and its derivation."""
    model.name = name
    with TemporaryDirectory() as folder:
        return load(render(model, languages=["python"]), name, Path(folder)), lg.derive(model)


def solved(emitted: Any, q: Any, v: Any, u: Any) -> tuple[Any, Any]:
    """Reactions and kinetic energy; what is welded to ground has potential energy in some trees only."""
    return np.asarray(emitted.reactions(q, v, u)), np.asarray(emitted.energy(q, v))[:1]


def compare(model_at: Any, other: dict[str, Any], rng: np.random.Generator) -> float:
    """The worst relative difference of reactions and energy between two formulations."""
    first, base = derived(model_at(), "first")
    changed = model_at()
    changed.formulation(**other)
    second, derivation = derived(changed, "second")
    worst = 0.0
    for _ in range(3):
        q = rng.uniform(-1, 1, first.NQ)
        numeric = base.numeric()
        as_list = q.tolist()
        numeric.tree.normalise(as_list)
        v, u = rng.uniform(-1, 1, first.NV), rng.uniform(-2, 2, first.NU)
        there = transfer(numeric, as_list, v.tolist(), derivation.numeric())
        if getattr(second, "NC", 0):
            assert np.abs(second.constraints(there[0])).max() < 1e-12
            assert np.abs(second.constraint_rates(*there)).max() < 1e-12
        a, b = solved(first, as_list, v, u), solved(second, *there, u)
        for mine, theirs in zip(a, b, strict=True):
            worst = max(worst, np.abs(mine - theirs).max() / (1 + np.abs(mine).max()))
    return float(worst)


@pytest.mark.seeds(range(0, 24, 4), range(48))
@pytest.mark.parametrize("kind", [ABSOLUTE, ABSOLUTE_ANGLE])
def test_random_trees_move_alike_in_all_coordinates(seed: int, kind: str) -> None:
    rng = np.random.default_rng([seed, 7])
    worst = compare(lambda: model_of(tree(seed)), {"coordinates": kind}, rng)
    assert worst < TOLERANCE, worst


@pytest.mark.parametrize("seed", range(6))
def test_a_single_body_may_have_coordinates_of_its_own(seed: int) -> None:
    """Half of the bodies absolute, a quarter by absolute angles, the rest by joints."""
    rng = np.random.default_rng([seed, 8])
    names = list(model_of(tree(seed)).bodies)
    kinds = {
        name: (ABSOLUTE, "joint", ABSOLUTE, ABSOLUTE_ANGLE)[k % 4] for k, name in enumerate(names)
    }
    worst = compare(lambda: model_of(tree(seed)), {"of_body": kinds}, rng)
    assert worst < TOLERANCE, worst


def planar_chain(count: int, axis: tuple[float, float, float] = (0, 0, 1)) -> lg.Model:
    """Hinges about one direction, every second one pointing to ground or against the others."""
    model = lg.Model("chain", gravity=(0.3, -9.81, 0.2))
    near = "ground"
    for k in range(count):
        body = model.body(
            f"b{k}", mass=1 + k, mass_center=(0.2, 0.1 * k, 0), inertia=(0.1, 0.2, 0.25 + 0.1 * k)
        )
        body.frame("end", at=(0.5, 0, 0))
        ends = (near, body) if k % 2 == 0 else (body, near)
        sign = -1 if k % 3 == 1 else 1
        model.revolute(f"j{k}", between=ends, axis=tuple(sign * x for x in axis))
        near = f"b{k}.end"
    model.spring("torsion", joint="j1", stiffness=3.0)
    model.damper("bearing", joint=f"j{count - 1}", damping=0.4)
    return model


def test_planar_chains_have_one_absolute_angle_each() -> None:
    """Against joint coordinates, with elements in the joints and efforts along them."""
    rng = np.random.default_rng(3)
    assert compare(lambda: planar_chain(5), {"coordinates": ABSOLUTE_ANGLE}, rng) < 1e-12
    model = planar_chain(5)
    model.formulation(coordinates=ABSOLUTE_ANGLE)
    tree_of = lg.derive(model).structure
    assert len(tree_of.positions) == len(tree_of.velocities) == 5
    assert not tree_of.closed


def test_a_chain_about_any_direction_is_planar() -> None:
    axis = (0.6, 0.0, 0.8)
    rng = np.random.default_rng(4)
    assert compare(lambda: planar_chain(4, axis), {"coordinates": ABSOLUTE_ANGLE}, rng) < 1e-12


def test_absolute_angles_show_differences_only() -> None:
    """The mass matrix of a double pendulum has cos(t1 - t2) and nothing else."""
    import sympy

    model = lg.Model("pendulum", gravity=(0, "-g", 0))
    for name in ("g", "m1", "m2", "l1", "c1", "c2", "J1", "J2"):
        model.parameter(name, 1.0)
    first = model.body("first", mass="m1", mass_center=("c1", 0, 0), inertia={"zz": "J1"})
    first.frame("end", at=("l1", 0, 0))
    second = model.body("second", mass="m2", mass_center=("c2", 0, 0), inertia={"zz": "J2"})
    model.revolute("t1", between=("ground", first), axis=(0, 0, 1))
    model.revolute("t2", between=("first.end", second), axis=(0, 0, 1))
    model.formulation(coordinates=ABSOLUTE_ANGLE)
    found = lg.derive(model).symbolic
    l1, m1, m2, c1, c2, J1, J2 = sympy.symbols("l1 m1 m2 c1 c2 J1 J2")
    t1, t2 = sympy.symbols("t1 t2")
    coupling = m2 * l1 * c2 * sympy.cos(t1 - t2)
    book = sympy.Matrix([[J1 + m1 * c1**2 + m2 * l1**2, coupling], [coupling, J2 + m2 * c2**2]])
    assert sympy.simplify(found.mass_matrix - book) == sympy.zeros(2, 2)


def test_automatic_coordinates_take_absolute_angles_in_planes_only() -> None:
    model = planar_chain(3)
    tip = model.body("tip", mass=1, inertia=(1, 1, 1))
    model.revolute("wrist", between=("b2.end", tip), axis=(0, 1, 0))
    model.formulation(coordinates="automatic")
    derivation = lg.derive(model)
    assert set(derivation.formulation.level) == {"j0", "j1", "j2"}
    assert not derivation.structure.closed


def four_bar() -> lg.Model:
    from linegraph.readers import modelfile

    examples = Path(__file__).parents[2] / "examples"
    return modelfile.read(examples / "four_bar" / "four_bar.toml")


def test_the_candidates_are_listed_cheapest_first() -> None:
    from linegraph.programs.tree_costs import trees

    found = trees(four_bar())
    counts = [candidate.operations for candidate in found]
    assert counts == sorted(counts)
    assert sum(candidate.chosen for candidate in found) == 1
    assert {candidate.cut for candidate in found} >= {("knee",), ("elbow",), ("swing",), ("motor",)}
    absolute = next(c for c in found if c.choices.get("coordinates") == ABSOLUTE)
    assert (absolute.coordinates, absolute.constraints) == (18, 20)
    text = str(found)
    assert "(this model)" in text
    assert 'coordinates = "absolute-angle"' in text


def test_candidates_can_be_chosen_as_listed() -> None:
    """What the table says to write gives the numbers it lists."""
    from linegraph.programs.tree_costs import trees

    for candidate in trees(four_bar()):
        model = four_bar()
        model.formulation(**{"independent": None, **candidate.choices})
        structure = lg.derive(model).structure
        assert len(structure.velocities) == candidate.coordinates


def test_of_equal_joints_the_farthest_from_ground_is_cut() -> None:
    """A loop of six like hinges is cut in the middle: the tree is shallow."""
    model = lg.Model("ring")
    corners = [(1, 0), (0.5, 0.866), (-0.5, 0.866), (-1, 0), (-0.5, -0.866), (0.5, -0.866)]
    model.ground.frame("end", at=(*corners[-1], 0))
    model.ground.frame("start", at=(*corners[0], 0))
    near = "ground.start"
    for k in range(5):
        along = np.subtract(corners[k + 1], corners[k])
        body = model.body(f"b{k}", mass=1, inertia=(1, 1, 1))
        body.frame("end", at=(*along, 0))
        model.revolute(f"j{k}", between=(near, body), axis=(0, 0, 1))
        near = f"b{k}.end"
    model.revolute("j5", between=(near, "ground.end"), axis=(0, 0, 1))
    assert lg.derive(model).formulation.chords in (("j2",), ("j3",))


def test_of_a_loop_the_freest_joint_is_cut() -> None:
    model = lg.Model("loop")
    a, b = (model.body(name, mass=1, inertia=(1, 1, 1)) for name in "ab")
    model.revolute("hinge", between=("ground", a), axis=(0, 0, 1))
    model.spherical("ball", between=(a, b))
    model.universal("cross", between=(b, "ground"))
    assert lg.derive(model).formulation.chords == ("ball",)

"""Mechanisms with redundant joints move as they do without: random ones of all sizes, misaligned a little."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from oracles.closed_systems import direction
from support.compiled import Compiled
from support.emitted import load
from support.spec_models import numbers
from systems.redundant_mechanisms import Pair, random_pair

from linegraph import Model, derive
from linegraph.dynamics.chords import equations
from linegraph.emission.emit import render
from linegraph.errors import ModelError
from linegraph.readers import modelfile

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from linegraph.kinematics.links import KinematicTree

COUNT = 1000
FEW = range(0, COUNT, 74)
IN_C = range(0, COUNT, 296)
"""Those whose emitted C is compiled by default: every fourth of the few."""

STATES = 3
TOLERANCE = 1e-8  # measured 5e-13 over all 1000


def drawn(rng: np.random.Generator, size: float, units: Sequence[str]) -> Any:
    """A number of size 1 for each coordinate or velocity, times the size of the mechanism for lengths."""
    return np.array([rng.normal() * (size if unit.startswith("m") else 1.0) for unit in units])


def normalised(names: Sequence[str], q: Any) -> Any:
    """The same with unit quaternions."""
    for k, name in enumerate(names):
        if name.endswith("_qx"):
            q[k : k + 4] /= np.linalg.norm(q[k : k + 4])
    return q


def solver(model: Model, tree: KinematicTree, folder: Path, language: str) -> Any:
    """The emitted forward dynamics of a mechanism, as a function of q, v and u."""
    files = render(model, languages=[language], only=("forward_dynamics",))
    if language == "python":
        return load(files, model.name, folder).forward_dynamics
    compiled = Compiled(files, model.name, folder)
    out: list[tuple[int, ...]] = [(len(tree.velocities),)]
    out += [(len(equations(tree)),)] * tree.closed
    return lambda q, v, u: compiled.call("forward_dynamics", q, v, u, out=out)


class Asked:
    """Both mechanisms at the same states, in Python or in C."""

    def __init__(self, pair: Pair, folder: Path, language: str = "python") -> None:
        """Derive and emit both."""
        self.pair = pair
        self.trees = [derive(model).structure for model in (pair.whole, pair.plain)]
        self.solvers = [
            solver(model, tree, folder, language)
            for model, tree in zip((pair.whole, pair.plain), self.trees, strict=True)
        ]

    def state(self, seed: int) -> tuple[list[Any], list[Any], Any]:
        """Coordinates and velocities of both, and inputs."""
        size = self.pair.size
        rng = np.random.default_rng(seed)
        found: list[list[Any]] = [[], []]
        for what, of in ((0, "positions"), (1, "velocities")):
            known: dict[str, float] = {}
            angle = rng.uniform(0.7, 1.2)
            for tree in self.trees:
                quantities = getattr(tree, of)
                names = [quantity.name for quantity in quantities]
                x = drawn(rng, size, [quantity.unit for quantity in quantities])
                x = np.array([known.setdefault(n, y) for n, y in zip(names, x, strict=True)])
                if "foot0" in names:  # cranks that are parallel
                    x = np.array([angle if n.startswith("foot") else -angle for n in names])
                found[what].append(normalised(names, x) if what == 0 else x)
        units = [quantity.unit for quantity in self.trees[1].inputs]
        torque = 1e3 * size**5
        u = [rng.normal() * (torque if unit == "N*m" else torque / size) for unit in units]
        return found[0], found[1], np.array(u)

    def difference(self, seed: int) -> float:
        """The largest difference of accelerations, beside the largest of them."""
        q, v, u = self.state(seed)
        size = self.pair.size
        found = []
        for tree, solve, *state in zip(self.trees, self.solvers, q, v, strict=True):
            a = solve(*state, u)
            a = a[0] if isinstance(a, tuple) else a
            pairs = zip(tree.velocities, a, strict=True)
            found.append({x.name: y / (size if x.unit == "m/s" else 1) for x, y in pairs})
        whole, plain = found
        assert {*plain} <= {*whole}
        largest = max(map(abs, plain.values()))
        return float(max(abs(plain[name] - whole[name]) for name in plain) / largest)


@pytest.mark.seeds(FEW, range(COUNT))
def test_redundant_joints_change_nothing(seed: int, tmp_path: Path) -> None:
    """Freedoms, redundancy and accelerations are those of the mechanism without the redundant joints."""
    pair = random_pair(seed)
    assembled = derive(pair.whole).assembled
    assert (assembled.freedoms, assembled.redundant) == (pair.freedoms, pair.redundant)
    asked = Asked(pair, tmp_path)
    assert max(asked.difference(k) for k in range(STATES)) < TOLERANCE


@pytest.mark.seeds(IN_C, range(COUNT))
def test_redundant_joints_change_nothing_in_c(seed: int, tmp_path: Path) -> None:
    """The compiled C of both gives the same accelerations too."""
    asked = Asked(random_pair(seed), tmp_path, "c")
    assert max(asked.difference(k) for k in range(STATES)) < TOLERANCE


DOOR = """
name = "door"
[parameters]
a = 0.1
[frame.low]
at = [0.3, 0, 0]
[frame.high]
at = [0.3, 0, 1]
[body.door]
mass = 10
mass_center = [0.5, 0, 0.5]
inertia = [1, 2, 1]
frame.low = { at = ["3*a", 0, 0] }
frame.high = { at = [0.3, 0, 1] }
[revolute.low]
between = ["ground.low", "door.low"]
axis = [0, 0, 1]
[revolute.high]
between = ["ground.high", "door.high"]
axis = [0, 0, 1]
effort = false
"""
"""3 * 0.1 is not 0.3: all rows of J are rounding."""


def both(model: Model, folder: Path) -> tuple[Any, Compiled]:
    """What is emitted, in Python and in C."""
    files = render(model, only=("forward_dynamics", "reduction", "project"))
    module = load({k: x for k, x in files.items() if k.endswith(".py")}, model.name, folder)
    return module, Compiled(files, model.name, folder)


def test_a_door_on_two_hinges_turns(tmp_path: Path) -> None:
    """7 N m turn 1 + 10 * 0.2^2 = 1.4 kg m^2 by 5 rad/s^2; nothing but its angle is free, and that is."""
    model = modelfile.parse(DOOR.encode(), "door.toml")
    assembled = derive(model).assembled
    assert (assembled.freedoms, assembled.rank, assembled.redundant) == (1, 0, 5)
    assert not any(assembled.unique)
    module, compiled = both(model, tmp_path)
    p = module.DEFAULT_PARAMETERS
    for q, v in (([0.0], [0.0]), ([0.7], [3.0])):
        a, lam = module.forward_dynamics(p, q, v, [7.0])
        assert a == pytest.approx([5.0], rel=1e-14)
        assert np.abs(lam).max() < 1e-12
        in_c = compiled.call("forward_dynamics", None, q, v, [7.0], out=[(1,), (5,)])
        assert in_c[0] == pytest.approx([5.0], rel=1e-14)
        assert np.abs(in_c[1]).max() < 1e-12
        T, _ = module.reduction(p, q, v)
        assert np.array(T).ravel() == pytest.approx([1.0], rel=1e-14)


def test_doors_on_any_axis_turn() -> None:
    """100 doors on random axes, their hinges up to 1e-12 m off: one degree of freedom each."""
    rng = np.random.default_rng(0)
    for k in range(100):
        model = Model("door")
        door = model.body("door", mass=10, mass_center=(0.5, 0, 0.5), inertia=(1, 2, 1))
        axis, at = direction(rng), rng.normal(size=3)
        off = (0.0, 1e-16, 1e-14, 1e-12)[k % 4] * direction(rng)
        for name, place, apart in (("low", at, 0 * off), ("high", at + axis, off)):
            ends = (
                model.ground.frame(name, at=numbers(place)),
                door.frame(name, at=numbers(place + apart)),
            )
            model.revolute(name, between=ends, axis=numbers(axis), effort=name == "low")
        assembled = derive(model).assembled
        assert (assembled.freedoms, assembled.redundant) == (1, 5)


def leaning(kind: str, tilt: float, size: float) -> Model:
    """A door on two hinges, or a drawer on two slides: the second axis leans in both of its ends."""
    model = Model("leaning")
    body = model.body("leaf", mass=1, mass_center=(size / 2, 0, 0), inertia=(size**2,) * 3)
    join = model.revolute if kind == "hinge" else model.prismatic
    apart = (0, 0, size) if kind == "hinge" else (size, 0, 0)
    ends = (model.ground.frame("there", at=apart), body.frame("there", at=apart))
    join("first", between=("ground", body), axis=(0, 0, 1))
    join("second", between=ends, axis=(tilt, 0, 1), effort=False)
    return model


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("kind", ["hinge", "slide"])
@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_an_axis_that_leans_is_rounding_or_refused_or_holds(
    coordinates: str, kind: str, size: float
) -> None:
    """Closed where it stands, a gap as large as the lean opens on the way: up to 1e-9 it is none."""
    for tilt, freedoms in ((0.0, 1), (1e-12, 1), (1e-9, 1), (1e-8, None), (5e-8, None), (1e-6, 0)):
        model = leaning(kind, tilt, size)
        model.formulation(coordinates=coordinates)
        if freedoms is None:
            with pytest.raises(
                ModelError, match=r'joint "(first|second)": closes .* a gap of .* opens'
            ):
                derive(model)
        else:
            assert derive(model).assembled.freedoms == freedoms


def test_a_door_hung_on_a_turned_frame_turns(tmp_path: Path) -> None:
    """About the hinges' axis through points of the door, by Huygens and Steiner."""
    model = modelfile.parse(SLANTED.encode(), "door.toml")
    assert derive(model).assembled.freedoms == 1
    module, compiled = both(model, tmp_path)
    axis = np.array([0.6, 0.0, 0.8])
    arm = np.array([0.5, 0.0, 0.5]) - np.array([0.31, 0.17, 0.0])
    about = axis @ np.diag([1.0, 2.0, 1.0]) @ axis + 10 * np.sum(np.cross(axis, arm) ** 2)
    a, _ = module.forward_dynamics([0.4], [0.0], [7.0])
    still, _ = module.forward_dynamics([0.4], [0.0], [0.0])
    assert a - still == pytest.approx([7.0 / about], rel=1e-12)
    in_c = compiled.call("forward_dynamics", [0.4], [0.0], [7.0], out=[(1,), (5,)])[0]
    assert in_c == pytest.approx(a, rel=1e-12)


SLANTED = """
name = "door"
[frame.post]
at = [0.7, 0.2, 0.1]
rpy = [0.3, 0.2, 0.5]
[body.jamb]
frame.low = { at = [0.31, 0.17, 0] }
frame.high = { at = [0.85, 0.17, 0.72] }
[fixed.wall]
between = ["ground.post", "jamb"]
[body.door]
mass = 10
mass_center = [0.5, 0, 0.5]
inertia = [1, 2, 1]
frame.low = { at = [0.31, 0.17, 0] }
frame.high = { at = [0.85, 0.17, 0.72] }
[revolute.low]
between = ["jamb.low", "door.low"]
axis = [0.6, 0, 0.8]
[revolute.high]
between = ["jamb.high", "door.high"]
axis = [0.6, 0, 0.8]
effort = false
"""


def chain(lengths: Sequence[float], apart: float) -> Model:
    """Bars in a row between two hinges on ground."""
    model = Model("chain")
    end = "ground"
    for k, length in enumerate(lengths):
        bar = model.body(f"bar{k}", mass=1, inertia=(0, length**2, 0))
        model.revolute(f"j{k}", between=(end, bar), axis=(0, 1, 0))
        end = bar.frame("end", at=(length, 0, 0))
    far = model.ground.frame("far", at=(apart, 0, 0))
    model.revolute("last", between=(end, far), axis=(0, 1, 0))
    return model


@pytest.mark.parametrize("size", [1e-9, 1e-6, 1.0, 1e3, 1e6])
def test_what_cannot_be_assembled_says_the_distance(size: float) -> None:
    """Two bars of 1 m end 3 m at least from a hinge 5 m away."""
    with pytest.raises(ModelError, match=re.escape(f"a gap of {3 * size:.3g} m remains at least")):
        derive(chain([size, size], 5 * size))


@pytest.mark.parametrize("size", [1e-9, 1e-6, 1.0, 1e3, 1e6])
def test_four_bars_of_any_size_move_alike(size: float, tmp_path: Path) -> None:
    """Lengths, gravity and inertias scaled together: the angles' accelerations stay."""
    found = []
    for x in (size, 1.0):
        model = Model("chain", gravity=(0, 0, -9.81 * x))
        end = "ground"
        for k, length in enumerate((0.3 * x, 0.9 * x, 0.6 * x)):
            mass = 1e3 * x**3
            bar = model.body(
                f"bar{k}",
                mass=mass,
                mass_center=(length / 2, 0, 0),
                inertia=(0, mass * length**2 / 12, 0),
            )
            start = (0.8, -0.3, 1.4)[k]
            model.revolute(f"j{k}", between=(end, bar), axis=(0, -1, 0), start=start)
            end = bar.frame("end", at=(length, 0, 0))
        far = model.ground.frame("far", at=(0.8 * x, 0, 0))
        model.revolute("last", between=(end, far), axis=(0, -1, 0), effort=False)
        derivation = derive(model)
        assert (derivation.assembled.freedoms, derivation.assembled.redundant) == (1, 3)
        module = load(render(model, languages=["python"]), "chain", tmp_path / str(x))
        q, v = module.complete(derivation.assembled.q, derivation.assembled.q[:1], [2.0])
        a, _ = module.forward_dynamics(q, v, np.zeros(module.NU))
        found.append(np.array([q, a]))
    assert found[0] == pytest.approx(found[1], rel=1e-9, abs=1e-9)


def test_a_bar_of_100_nm_and_1_pg_is_a_pendulum(tmp_path: Path) -> None:
    """Inertias are judged by the model's own lengths: u / (Izz + m a^2)."""
    model = Model("nano")
    bar = model.body("bar", mass=1e-15, mass_center=(1e-7, 0, 0), inertia=(0, 1e-29, 1e-29))
    model.revolute("hinge", between=("ground", bar), axis=(0, 0, 1))
    module = load(render(model, languages=["python"]), "nano", tmp_path)
    a = module.forward_dynamics([0.3], [0.0], [1e-27])
    assert a == pytest.approx([1e-27 / 2e-29], rel=1e-12)


def test_a_mass_on_its_axis_up_to_rounding_has_no_inertia() -> None:
    """0.1 + 0.2 - 0.3 is no lever arm, beside arms of the model's own size."""
    model = Model("spinning")
    arm = model.body("arm", mass=1, mass_center=(0.5, 0, 0), inertia=(0.1, 0.1, 0.1))
    bead = model.body("bead", mass=1, mass_center=(0.1 + 0.2 - 0.3, 0, 0))
    model.revolute("hinge", between=("ground", arm), axis=(0, 0, 1))
    model.revolute("pivot", between=(arm.frame("end", at=(1, 0, 0)), bead), axis=(0, 0, 1))
    with pytest.raises(ModelError, match="moves no inertia of its own"):
        derive(model).require_inverse("forward_dynamics")

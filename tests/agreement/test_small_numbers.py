"""Where digits are lost or constants cancel: slender bodies, inertias that become zero, small differences."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
import sympy
from support.compiled import Compiled
from support.emitted import load

import linegraph as lg
from linegraph.emission.emit import render
from linegraph.ir.dag import Dag
from linegraph.spatial.inertia import second_moments
from linegraph.spatial.rotation import from_rpy, snapped

if TYPE_CHECKING:
    from pathlib import Path

Z = (0, 0, 1)


@pytest.mark.parametrize("small", [1e-3, 1e-6, 1e-9, 1e-10])
@pytest.mark.parametrize("large", [(1 / 12, 1 / 12), (50.0, 50.0), (49.7, 50.0)])
def test_a_slender_body_keeps_its_small_inertia(small: float, large: tuple[float, float]) -> None:
    """The moments are carried as ∫ r rᵀ dm, of which a rod's inertia about itself is a small sum."""
    for axis in range(3):
        inertia = [*large]
        inertia.insert(axis, small + abs(large[0] - large[1]))
        model = lg.Model("rod")
        body = model.body("rod", mass=1, inertia=tuple(inertia))
        direction = tuple(float(k == axis) for k in range(3))
        model.revolute("hinge", between=("ground", body), axis=direction)
        assert lg.derive(model).numeric().mass_matrix([0.3]) == [[inertia[axis]]]


def test_equal_symbols_leave_each_other_out() -> None:
    """Of (a + b) - b no digit of a small a would be left."""
    a, b = sympy.symbols("a b")
    dag = Dag()
    small, large = dag.symbol("p", "small"), dag.symbol("p", "large")
    assert second_moments((b, 0, 0, b, 0, a)) == (a / 2, 0, 0, a / 2, 0, b - a / 2)
    found = second_moments((large, 0, 0, small, 0, large))
    assert found[0] is found[5] is small / 2


def test_an_inertia_that_becomes_zero_is_reported(tmp_path: Path) -> None:
    """At run time, in both forms: no rounding of the other moments takes its place."""
    model = lg.Model("rod", gravity=(0, 0, 0))
    for name, value in {"Jx": 0.1, "Jy": 0.3, "Jz": 0.2}.items():
        model.parameter(name, value)
    body = model.body("b", mass=1, mass_center=(0, 0, 0.5), inertia=("Jx", "Jy", "Jz"))
    model.revolute("j", between=("ground", body), axis=Z)
    module = load(render(model, languages=["python"]), "rod", tmp_path)
    for x, y in np.random.default_rng(0).uniform(0.01, 2, (200, 2)):
        p = module.DEFAULT_PARAMETERS.replace(Jx=x, Jy=y, Jz=0.0)
        with pytest.raises(np.linalg.LinAlgError):
            module.forward_dynamics(p, [0.0], [0.0], [1.0])
        with pytest.raises(np.linalg.LinAlgError):
            module.forward_dynamics_prepared(module.prepare(p), [0.0], [0.0], [1.0])


def test_constants_do_not_meet_where_they_make_small_differences(tmp_path: Path) -> None:
    model = lg.Model("two", gravity=(0, 0, 0))
    model.parameter("p0", 1e5)
    bodies = [model.body(name, mass=1) for name in "ab"]
    model.prismatic("x", between=("ground", bodies[0]), axis=(1, 0, 0))
    model.prismatic("y", between=("ground", bodies[1]), axis=(1, 0, 0))
    model.load("pull", at=bodies[0], force=("(x - p0) + (y - p0)", 0, 0))
    numeric = lg.derive(model).numeric()
    module = load(render(model, languages=["python"]), "two", tmp_path)
    c = module.prepare(module.DEFAULT_PARAMETERS)
    for apart in np.random.default_rng(0).normal(size=(50, 2)):
        q = (1e5 + 1e-3 * apart).tolist()
        assert module.bias_prepared(c, q, [0.0, 0.0]).tolist() == numeric.bias(q, [0.0, 0.0])


def test_a_turn_that_is_nearly_a_quarter_stays_a_turn() -> None:
    """Its sine is near enough to 1 to be replaced, its cosine not to 0: then neither is."""
    for angle in (np.pi / 2 + 4e-6, 1.5708, 1e-7):
        m = from_rpy(angle, 0, 0)
        assert snapped(m, 1e-11) == m
    assert snapped(from_rpy(np.pi / 2 + 4e-12, 0, 0), 1e-11) == ((1, 0, 0), (0, 0, -1), (0, 1, 0))


def closed_with_input() -> lg.Model:
    """A linkage with a slider beside it whose motion comes from inputs."""
    model = lg.Model("drv")
    a = model.body("a", mass=1, mass_center=(0.1, 0, 0), inertia=(1, 1, 1))
    s = model.body("s", mass=1, inertia=(1, 1, 1))
    b = model.body("b", mass=1, mass_center=(0.1, 0, 0), inertia=(1, 1, 1))
    model.revolute("j0", between=("ground", a), axis=(0, 1, 0))
    model.prismatic("lift", between=(a, s), axis=(1, 0, 0), motion="input")
    model.revolute("j2", between=("ground", b), axis=(0, 1, 0))
    ends = (a.frame("e", at=(1, 0, 0)), b.frame("e", at=(1, 0, 0.5)))
    model.rod("rod", between=ends, length=0.4)
    return model


def test_routines_of_closed_models_take_the_inputs_that_move_masses(tmp_path: Path) -> None:
    files = render(closed_with_input())
    Compiled(files, "drv", tmp_path)
    module = load(files, "drv", tmp_path)
    u = np.array([0.1, 0.2, 0.3, 0.0, 0.0])[: module.NU]
    q, v = module.project(*(x for x in ([0.1, 0.1], [0.0, 0.0], u)))
    assert np.allclose(module.constraints(q), 0, atol=1e-12)
    assert np.all(np.isfinite(v))


@pytest.mark.parametrize("name", ["lanes", "all", "s_lanes"])
def test_names_like_those_of_helpers_leave_no_function_unused(name: str, tmp_path: Path) -> None:
    model = lg.Model(name)
    body = model.body("b", mass=1, mass_center=(0.1, 0, 0.2), inertia=(1, 1.2, 1.1))
    model.revolute("j", between=("ground", body), axis=Z)
    for k, options in enumerate(({"trig": "inline"}, {"batch": True})):
        Compiled(render(model, **options), name, tmp_path / str(k))  # type: ignore[arg-type]

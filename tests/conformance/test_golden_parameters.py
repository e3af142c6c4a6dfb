"""Golden vectors of identification: Y, pi and the rest of tau, by another route."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from conformance.test_golden import build, read, run
from support.emitted import load
from systems import random_systems

import linegraph as lg
from linegraph.emission.emit import render

if TYPE_CHECKING:
    from pathlib import Path

ASKED = ("regressor", "inertial_parameters")


def worn() -> lg.Model:
    """Links of several welded bodies, friction of many kinds, a joint that follows, a spring."""
    model = lg.Model("worn", gravity=(0.3, -0.2, -9.8))
    c = model.parameter("c", 0.7, "N*m*s")
    arm = model.body("arm", mass=2.0, mass_center=(0.1, 0.2, -0.5), inertia=(0.3, 0.2, 0.1))
    tool = model.body("tool", mass=0.5, mass_center=(0.05, 0, 0.1), inertia=(0.02, 0.03, 0.01))
    hand = model.body("hand", mass=0.7, mass_center=(0, 0.1, 0), inertia=(0.02, 0.02, 0.03))
    wheel = model.body("wheel", mass=0.3, inertia=(0.01, 0.02, 0.01))
    model.revolute("hinge", between=("ground", arm), axis=(0, 1, 0))
    model.fixed("flange", between=(arm.frame("end", (0, 0.3, -1), rpy=(0.3, -0.2, 0.9)), tool))
    model.prismatic("slide", between=(tool, hand), axis=(1, 0, 0))
    model.revolute("axle", between=(arm, wheel), axis=(0, 1, 0))
    model.couple("axle", to="hinge", ratio=3.0)
    model.damper("grease", joint="hinge", damping=c)
    model.damper("bearing", joint="axle", damping=0.2)
    model.friction("seal", joint="hinge", coulomb=1.1, viscous=0.3)
    model.friction("rail", joint="slide", coulomb=0.4, width=0.05)
    model.friction("brush", joint="axle", coulomb=0.6)
    model.spring("flexure", joint="slide", stiffness=5.0)
    return model


@pytest.mark.parametrize("folded", [True, False])
def test_what_identification_asks_for_holds(folded: bool, tmp_path: Path) -> None:
    """In Python at all states and at one, and in C; far below what is allowed."""
    files = render(worn(), name="worn", functions=ASKED, folded=folded, tests=True)
    load(files, "worn", tmp_path)
    check = load(files, "test_worn", tmp_path)
    assert set(ASKED) <= set(check.FUNCTIONS)
    assert np.abs(check.EXPECTED["rest_of_tau"][0]).max() > 1
    for function in ASKED:
        check.compare(function, slice(None))
        check.compare(function, 1)
    status, lines = run(build(files, "worn", tmp_path))
    assert status == 0, "\n".join(lines)
    assert max(float(line.split()[3]) for line in lines[:-1]) < 2e-12


@pytest.mark.parametrize("seed", range(4))
def test_random_systems_hold(seed: int, tmp_path: Path) -> None:
    """Closed and open, with elements of all kinds."""
    model = random_systems.random_system(seed).model
    files = render(model, name="drawn", functions=ASKED, languages=["python"], tests=True)
    load(files, "drawn", tmp_path)
    check = load(files, "test_drawn", tmp_path)
    for function in ASKED:
        check.compare(function, slice(None))


def test_every_corrupted_entry_is_seen(tmp_path: Path) -> None:
    """One entry after the other off by a ten-millionth of the largest of its result."""
    files = render(worn(), name="worn", functions=ASKED, languages=["python"], tests=True)
    load(files, "worn", tmp_path)
    check = load(files, "test_worn", tmp_path)
    seen = 0
    for function in ASKED:
        right = getattr(check.code, function)
        for k, key in enumerate(check.FUNCTIONS[function][2]):
            expected, scale = check.EXPECTED[key]
            for place in np.ndindex(scale.shape):
                wrong = off(right, k, place, 1e-7 * np.abs(expected).max())
                setattr(check.code, function, wrong)
                with pytest.raises(AssertionError):
                    check.compare(function, slice(None))
                seen += 1
        setattr(check.code, function, right)
        check.compare(function, slice(None))
    assert seen == 2 * 36 + 2 + 36


def off(function: Any, result: int, place: tuple[int, ...], by: float) -> Any:
    """The same function, but for one entry of one result."""

    def wrong(*given: Any) -> Any:
        found = function(*given)
        results = [np.array(x) for x in (found if isinstance(found, tuple) else (found,))]
        results[result][(..., *place)] += by
        return tuple(results) if isinstance(found, tuple) else results[0]

    return wrong


@pytest.mark.parametrize("name", ["cart_pole_motor", "arm_with_drives", "magnetic_levitation"])
def test_with_networks_rotors_are_parameters_of_joints(name: str, tmp_path: Path) -> None:
    """What motors add to joints is known from the energy of the networks, not from their mass matrix."""
    model = read(name)
    files = render(model, name=name, functions=ASKED, languages=["python"], tests=True)
    load(files, name, tmp_path)
    check = load(files, f"test_{name}", tmp_path)
    for function in ASKED:
        check.compare(function, slice(None))
    rotors = [k for k, x in enumerate(check.code.PI_NAMES) if x.endswith("armature")]
    values = check.EXPECTED["pi"][0][0]
    assert len(rotors) > 0
    assert any(values[k] > 0 for k in rotors) == any(
        getattr(component, "inertia", None) is not None for component in model.components
    )

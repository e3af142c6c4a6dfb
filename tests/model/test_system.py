"""The frozen system: what is said after a snapshot does not reach it."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, dataclass, field
from typing import Any

import numpy as np
import pytest
import sympy

import linegraph as lg
from linegraph.model.system import settled, variant


def pendulum() -> lg.Model:
    model = lg.Model("pendulum")
    bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
    model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
    return model


def test_a_system_says_what_the_model_said() -> None:
    model = pendulum()
    system = model.system()
    assert isinstance(system, lg.System)
    assert system.system() is system
    assert system.name == "pendulum"
    assert dict(system.bodies) == model.bodies
    assert system.joints == model.joints
    assert system.gravity == model.gravity


def test_what_is_added_later_does_not_reach_it() -> None:
    model = pendulum()
    system, derivation = model.system(), lg.derive(model)
    model.gravity = (0, 0, -1.62)
    model.body("other", mass=1.0)
    model.prismatic("slide", between=("bob", "other"))
    model.parameter("m", 3.0)
    model.input("push")
    model.formulation(coordinates="absolute")
    assert [*system.bodies] == ["bob"]
    assert [joint.name for joint in system.joints] == ["hinge"]
    assert not system.parameters
    assert not system.inputs
    assert system.choices.coordinates == "joint"
    # 2 kg * 9.81 m/s^2 * 0.5 m * sin(pi / 2)
    (h,) = derivation.numeric().bias([np.pi / 2], [0.0])
    assert h == pytest.approx(9.81, rel=1e-15)
    assert float(derivation.gravity[0].subs("hinge", sympy.pi / 2)) == pytest.approx(
        9.81, rel=1e-15
    )


def test_nothing_of_it_can_be_set() -> None:
    system: Any = pendulum().system()
    with pytest.raises(FrozenInstanceError):
        system.gravity = (0, 0, 0)
    with pytest.raises(TypeError):
        system.bodies["other"] = system.bodies["bob"]


def test_a_list_that_was_handed_over_may_be_changed_afterwards() -> None:
    matrix = [[2.0, 0.5], [0.5, 1.0]]
    model = lg.Model("coils")
    model.coupled_inductors("T", [("a", "ground"), ("b", "ground")], inductance=matrix)
    model.resistor("Ra", ("a", "ground"), resistance=1.0)
    model.resistor("Rb", ("b", "ground"), resistance=1.0)
    derivation = lg.derive(model)
    before = derivation.numeric().mass_matrix([0.0, 0.0])
    matrix[0][0] = 7.0
    assert lg.derive(model.system()).numeric().mass_matrix([0.0, 0.0]) is not None
    assert derivation.numeric().mass_matrix([0.0, 0.0]) == before


@dataclass(frozen=True)
class Thing:
    numbers: tuple[Any, ...]
    named: dict[str, Any] = field(default_factory=dict)
    rate: Any = None


def test_settled_copies_what_can_change_and_nothing_else() -> None:
    inner = [1, 2]
    given = Thing((inner, "x"), {"k": inner}, sympy.Symbol("c"))
    found = settled(given)
    inner.append(3)
    assert found.numbers == ([1, 2], "x")
    assert found.named == {"k": [1, 2]}
    assert found.rate is given.rate
    unchanging = Thing((1, ("a", 2.0)))
    assert settled(unchanging.numbers) is unchanging.numbers
    array = np.eye(2)
    assert settled(array) is not array


def test_a_variant_has_other_choices_alone() -> None:
    model = pendulum()
    model.formulation(reactions="ground")
    system = model.system()
    twin = variant(system, coordinates="absolute")
    assert twin.choices.coordinates == "absolute"
    assert twin.choices.reactions == "head"  # as by default
    assert twin.bodies is system.bodies
    assert system.choices.reactions == "ground"

"""Types that share one class: a law for several domains, as each domain's model files write it."""

from __future__ import annotations

import pickle
from copy import deepcopy
from dataclasses import FrozenInstanceError, fields, replace
from typing import Any

import pytest

from linegraph import Model
from linegraph.components.domains import DOMAINS, HYDRAULIC, ROTATION_1D, SPATIAL, THERMAL
from linegraph.components.scalar import COMPONENTS
from linegraph.components.scalar.couplings import Ratio
from linegraph.components.scalar.mechanical import Damper1D, Friction1D, Inertia1D
from linegraph.components.scalar.sources import AcrossSource, ThroughSource
from linegraph.components.scalar.stores import Spring1D
from linegraph.components.scalar.twins import Twins
from linegraph.components.transducers.interface import Interface
from linegraph.errors import ModelError

SHARED = {
    Inertia1D: {"mass", "inertia"},
    Spring1D: {"translational_spring", "rotational_spring"},
    Damper1D: {"translational_damper", "rotational_damper"},
    Friction1D: {"translational_friction", "rotational_friction"},
    Ratio: {"lever", "gear"},
    Interface: {"translational_interface", "rotational_interface"},
    AcrossSource: {
        *("voltage_source", "velocity_source", "angular_velocity_source"),
        *("pressure_source", "temperature_source", "mmf_source"),
    },
    ThroughSource: {
        *("current_source", "force_source", "torque_source"),
        *("flow_source", "heat_source", "flux_source"),
    },
}
KINDS = sorted(set().union(*SHARED.values()))


@pytest.mark.parametrize("one", SHARED, ids=lambda one: one.__name__)
def test_one_class_has_these_types_and_no_other(one: type) -> None:
    found = {word for word, kind in COMPONENTS.items() if issubclass(kind, one)}
    assert found == SHARED[one]
    assert all(vars(COMPONENTS[word]).get("laws") is None for word in found)


@pytest.mark.parametrize("one", [AcrossSource, ThroughSource])
def test_every_scalar_domain_has_both_sources(one: type) -> None:
    found = [getattr(COMPONENTS[word], "domain_name", None) for word in SHARED[one]]
    assert sorted(map(str, found)) == sorted(name for name in DOMAINS if name not in SPATIAL)


@pytest.mark.parametrize("word", COMPONENTS)
def test_types_are_found_where_they_say(word: str) -> None:
    """Copies in other processes look for them there."""
    kind = COMPONENTS[word]
    assert pickle.loads(pickle.dumps(kind)) is kind
    assert deepcopy(kind) is kind


@pytest.mark.parametrize("word", KINDS)
def test_each_type_tells_what_its_own_keys_mean(word: str) -> None:
    kind = COMPONENTS[word]
    text = str(kind.__doc__)
    own = {f.name for f in fields(kind)} - {"name", "between", "second", "joint", "points", "shaft"}
    assert all(f"    {key}: " in text for key in own)
    assert text.startswith(("A ", "An ", "Friction "))
    assert "``" in text.splitlines()[0]


def test_a_key_that_is_added_must_be_given() -> None:
    model = Model("m")
    with pytest.raises(ModelError, match=r'pressure_source "p": pressure is missing'):
        model.pressure_source("p", ("a", "ground"))


def test_a_type_of_another_domain_is_one_line() -> None:
    kind: Any = Twins(HYDRAULIC, __name__).of(
        Damper1D, "porous_plug", "A plug: ``Y = damping X``.", damping="m^3/s/Pa."
    )
    plug = kind("plug", ("a", "b"), damping=2.0)
    assert (kind.__name__, plug.kind, kind.required) == ("PorousPlug", "porous_plug", ("damping",))
    assert [port.domain for port in plug.ports()] == ["hydraulic"]
    assert "m^3/s/Pa" in kind.__doc__
    assert "N s/m" not in kind.__doc__
    assert replace(plug, damping=3.0).damping == 3.0
    assert plug == kind("plug", ("a", "b"), damping=2.0) != Damper1D("plug", ("a", "b"), 2.0)
    with pytest.raises(FrozenInstanceError):
        plug.damping = 1.0


def test_couplings_and_shafts_follow_their_domain() -> None:
    kind: Any = Twins(THERMAL, __name__).of(Ratio, "pump", "``X1 = ratio X2``.", ratio="1.")
    assert kind.domain_names == ("thermal", "thermal")
    assert kind.required == ("ratio",)
    turning: Any = Twins(ROTATION_1D, __name__).of(Interface, "clutch", "``X = w``.")
    assert turning.turns
    assert not COMPONENTS["translational_interface"].turns  # type: ignore[attr-defined]


def test_sources_name_their_variable_and_its_unit() -> None:
    flow: Any = COMPONENTS["flow_source"]
    assert flow.__doc__.startswith("A source: ``Y = flow``, through it from tail to head.")
    assert (
        "    flow: m^3/s: a number, an input, an expression of t or of any variable."
        in flow.__doc__
    )

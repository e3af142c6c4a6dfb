"""Conformance of every registered component: what is emitted of it obeys the law that its type promises.

A model is built around a component: each of its edges gets a store and a resistance, in parallel or in
series, and its edge in mechanics a shaft, a joint or two points. At random states the variables of its edges
and, by differences along the motion, their rates are put into formulas written apart. A component that is
added to `linegraph.components.scalar.COMPONENTS` is tested here once `PORTS` has its edges and
`CASES` its law.
"""

from __future__ import annotations

import inspect
import json
import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pytest
from support.emitted import load

from linegraph import Model, derive
from linegraph.components.scalar import COMPONENTS
from linegraph.emission.emit import render
from linegraph.errors import LinegraphError, ModelError, SourceErrors
from linegraph.readers.modelfile import parse
from linegraph.readers.modelfile.schema import schema

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from linegraph.derivation import Derivation

EXACT = 1e-11  # measured below 1e-12: rates are differences
SEEDS = range(3)
NAME = "c"
"""The component under test; all else has other names."""

Row = tuple[str, str, dict[str, Any]]
"""A component: its type, its name, its keys."""


class Seen:
    """The variables of one component at a state, and their rates.

    Attributes:
        keys: of the component, by name: ``seen["resistance"]``.
        X, Y: across and through variable of each edge.
        dX, dY: their rates.
        x: the displacement of its edge in mechanics.
        own: its own states by what their names begin with, and their rates.
        beside: outputs that the case asks for.
        sign: -1 where its edges are turned around.
    """

    def __init__(self, keys: Mapping[str, Any], sign: int) -> None:
        """Nothing is seen yet."""
        self.keys, self.sign = keys, sign
        self.X: list[float] = []
        self.Y: list[float] = []
        self.dX: list[float] = []
        self.dY: list[float] = []
        self.x = math.nan
        self.t = 0.0
        self.own: dict[str, tuple[float, float]] = {}
        self.beside: dict[str, float] = {}

    def __getitem__(self, key: str) -> Any:
        return self.keys[key]


class Case(NamedTuple):
    """What a type promises, for some keys.

    Attributes:
        keys: all that is given beside the places of its edges.
        law: what is zero.
        kept: of each edge what it keeps.
        stored: its energy; None where it has none, or no energy is meant.
        heat: the power it dissipates.
        optional: keys that may be left out.
        beside: further components that the case needs.
        asks: further outputs, by name.
    """

    keys: dict[str, Any]
    law: Callable[[Seen], list[float]]
    kept: tuple[str, ...] = ("",)
    stored: Callable[[Seen], float] | None = None
    heat: Callable[[Seen], float] | None = None
    optional: tuple[str, ...] = ()
    beside: tuple[Row, ...] = ()
    asks: tuple[tuple[str, str], ...] = ()


A, T = "across", "through"

# ---- the documented edges

ONE_PORTS = {
    "electrical": (
        *("resistor", "conductance", "capacitor", "inductor", "diode"),
        *("voltage_source", "current_source", "element", "store"),
    ),
    "translation_1d": (
        *("mass", "translational_spring", "translational_damper", "translational_friction"),
        *("force_source", "velocity_source"),
    ),
    "rotation_1d": (
        *("inertia", "rotational_spring", "rotational_damper", "rotational_friction"),
        *("torque_source", "angular_velocity_source"),
    ),
    "hydraulic": (
        *("tank", "accumulator", "inertance", "pipe", "orifice", "valve"),
        *("pressure_source", "flow_source"),
    ),
    "thermal": (
        *("heat_capacity", "conduction", "convection", "radiation", "losses"),
        *("temperature_source", "heat_source"),
    ),
    "magnetic": ("reluctance", "mmf_source", "flux_source"),
}
TWO_PORTS = {
    "transformer": ("electrical", "electrical"),
    "gyrator": ("electrical", "electrical"),
    "lever": ("translation_1d", "translation_1d"),
    "gear": ("rotation_1d", "rotation_1d"),
    "belt": ("rotation_1d", "rotation_1d"),
    "rack": ("rotation_1d", "translation_1d"),
    "screw": ("rotation_1d", "translation_1d"),
    "winding": ("electrical", "magnetic"),
}
TRANSDUCERS = {
    "dc_motor": ("electrical", "rotation_1d"),
    "moving_coil": ("electrical", "translation_1d"),
    "solenoid": ("electrical", "translation_1d"),
    "reluctance_machine": ("electrical", "rotation_1d"),
    "variable_capacitor": ("electrical", "translation_1d"),
    "piezo": ("electrical", "translation_1d"),
    "cylinder": ("hydraulic", "translation_1d"),
    "pump": ("hydraulic", "rotation_1d"),
    "hydraulic_motor": ("hydraulic", "rotation_1d"),
    "translational_interface": ("translation_1d", "translation_1d"),
    "rotational_interface": ("rotation_1d", "rotation_1d"),
}
SEVERAL = {
    "opamp": (("input", "electrical"), ("output", "electrical")),
    "coupled_inductors": (("winding1", "electrical"), ("winding2", "electrical")),
    "synchronous_machine": (
        *(("winding1", "electrical"), ("winding2", "electrical")),
        ("mechanical", "rotation_1d"),
    ),
}

PORTS: dict[str, tuple[tuple[str, str], ...]] = {
    **{kind: (("", domain),) for domain, kinds in ONE_PORTS.items() for kind in kinds},
    **{kind: (("first", a), ("second", b)) for kind, (a, b) in TWO_PORTS.items()},
    **{kind: ((a, a), ("mechanical", b)) for kind, (a, b) in TRANSDUCERS.items()},
    **SEVERAL,
}
"""Label and subspace of every edge of a type."""

SOURCES = {kind for kind in PORTS if kind.endswith("_source")} | {"opamp"}

# ---- laws, by hand


def by(letter: str, key: str) -> Callable[[Seen], list[float]]:
    """A source: one of its variables is what the key says at this time."""
    return lambda s: [getattr(s, letter)[0] - (0.3 + 0.5 * math.sin(2 * s.t))]


def source(letter: str, key: str) -> Case:
    return Case({key: "0.3 + 0.5*sin(2*t)"}, by(letter, key))


def dissipative(keys: dict[str, Any], law: Callable[[Seen], float], *optional: str) -> Case:
    """An element that gives Y of X and turns all into heat."""
    return Case(
        keys,
        lambda s: [s.Y[0] - law(s)],
        heat=lambda s: s.X[0] * law(s),
        optional=optional,
    )


def across_store(key: str, slope: Callable[[Seen], float], value: Any, *optional: str) -> Case:
    """``Y = slope dX``, with the energy of a constant slope."""
    keys = value if isinstance(value, dict) else {key: value}
    return Case(
        keys,
        lambda s: [s.Y[0] - slope(s) * s.dX[0]],
        (A,),
        lambda s: slope(s) * s.X[0] ** 2 / 2,
        optional=optional,
    )


def through_store(key: str, value: float) -> Case:
    return Case(
        {key: value},
        lambda s: [s.X[0] - s[key] * s.dY[0]],
        (T,),
        lambda s: s[key] * s.Y[0] ** 2 / 2,
    )


def curved(kept: str, key: str, name: str) -> Case:
    """A store with a charge of 0.7 k + 0.1 k^3, given as such or by its co-energy."""
    charge, coenergy = f"0.7*{name} + 0.1*{name}**3", f"0.35*{name}**2 + 0.025*{name}**4"

    def slope(k: float) -> float:
        return 0.7 + 0.3 * k**2

    def energy(k: float) -> float:
        return 0.35 * k**2 + 0.075 * k**4

    keys = {key: coenergy if key == "coenergy" else charge}
    if kept == A:
        return Case(
            keys,
            lambda s: [s.Y[0] - slope(s.X[0]) * s.dX[0]],
            (A,),
            lambda s: energy(s.X[0]),
        )
    return Case(keys, lambda s: [s.X[0] - slope(s.Y[0]) * s.dY[0]], (T,), lambda s: energy(s.Y[0]))


def spring(key: str) -> Case:
    """By its stiffness, or by a force or an energy of its displacement, which then is a state."""
    if key == "stiffness":
        return Case(
            {key: 1.7},
            lambda s: [s.dY[0] - 1.7 * s.X[0]],
            (T,),
            lambda s: s.Y[0] ** 2 / (2 * 1.7),
        )
    given = {"force": "3*x + 0.5*x**3", "energy": "1.5*x**2 + x**4/8"}[key]
    return Case(
        {key: given},
        lambda s: [s.Y[0] - 3 * s.own["x"][0] - 0.5 * s.own["x"][0] ** 3, s.own["x"][1] - s.X[0]],
        stored=lambda s: 1.5 * s.own["x"][0] ** 2 + s.own["x"][0] ** 4 / 8,
    )


def friction() -> Case:
    return dissipative(
        {"viscous": 0.3, "coulomb": 0.4, "width": 0.5},
        lambda s: 0.3 * s.X[0] + 0.4 * math.tanh(s.X[0] / 0.5),
        *("viscous", "coulomb", "width"),
    )


def transformer(
    ratio: Callable[[Seen], float], keys: dict[str, Any], *optional: str, turned: bool = False
) -> Case:
    """``X1 = n X2``, ``Y2 = -n Y1``; turned, of the second edge first."""
    a, b = (1, 0) if turned else (0, 1)
    return Case(
        keys,
        lambda s: [s.X[a] - ratio(s) * s.X[b], s.Y[b] + ratio(s) * s.Y[a]],
        ("", ""),
        lambda s: 0.0,
        optional=optional,
    )


def gyrator(key: str, keys: dict[str, Any], *optional: str) -> Case:
    return Case(
        keys,
        lambda s: [s.X[0] - s[key] * s.Y[1], s.X[1] + s[key] * s.Y[0]],
        ("", ""),
        lambda s: 0.0,
        optional=optional,
    )


def motor(**more: float) -> Case:
    keys = {"constant": 0.6, "resistance": 1.2, **more}
    n, b, L, J = (
        keys.get(key, rest)
        for key, rest in (("ratio", 1), ("damping", 0), ("inductance", 0), ("inertia", 0))
    )
    return Case(
        keys,
        lambda s: [
            s.X[0] - 1.2 * s.Y[0] - L * s.dY[0] - 0.6 * n * s.X[1],
            s.Y[1] + 0.6 * n * s.Y[0] - n**2 * (b * s.X[1] + J * s.dX[1]),
        ],
        (T if L else "", A if J else ""),
        lambda s: L * s.Y[0] ** 2 / 2 + J * (n * s.X[1]) ** 2 / 2,
        lambda s: 1.2 * s.Y[0] ** 2 + b * (n * s.X[1]) ** 2,
        ("inductance", "inertia", "damping", "ratio"),
    )


def coil(**more: float) -> Case:
    keys = {"constant": 0.7, **more}
    R, L = keys.get("resistance", 0), keys.get("inductance", 0)
    return Case(
        keys,
        lambda s: [
            s.X[0] - R * s.Y[0] - L * s.dY[0] - 0.7 * s.X[1],
            s.Y[1] + 0.7 * s.Y[0],
        ],
        (T if L else "", ""),
        lambda s: L * s.Y[0] ** 2 / 2,
        lambda s: R * s.Y[0] ** 2,
        ("resistance", "inductance"),
    )


TEXT, TURNING = "(0.5 + 0.3/(1 + x**2))", "(0.5 + 0.2*cos(2*x))"
VALUES: dict[str, tuple[Callable[[float], float], Callable[[float], float]]] = {
    TEXT: (lambda x: 0.5 + 0.3 / (1 + x**2), lambda x: -0.6 * x / (1 + x**2) ** 2),
    TURNING: (lambda x: 0.5 + 0.2 * math.cos(2 * x), lambda x: -0.4 * math.sin(2 * x)),
}
"""An inductance or capacitance by a displacement, and its slope."""


def magnet(key: str, of: str) -> Case:
    """A solenoid; by its co-energy it saturates."""
    L, slope = VALUES[of]
    given = {
        "inductance": of,
        "coenergy": f"{of}*i**2/2 + 0.02*i**4",
        "energy": f"psi**2/(2*{of})",
    }[key]
    b = 0.02 * (key == "coenergy")

    def law(s: Seen) -> list[float]:
        (v, w), (i, y) = s.X, s.Y
        if key == "energy":
            psi, rate = s.own["psi"]
            push = psi**2 * slope(s.x) / (2 * L(s.x) ** 2)
            return [i - psi / L(s.x), v - 0.4 * i - rate, y + push]
        rate = (L(s.x) + 12 * b * i**2) * s.dY[0] + slope(s.x) * i * w
        return [v - 0.4 * i - rate, y + slope(s.x) * i**2 / 2]

    return Case(
        {key: given, "resistance": 0.4},
        law,
        ("" if key == "energy" else T, ""),
        lambda s: L(s.x) * s.Y[0] ** 2 / 2 + 3 * b * s.Y[0] ** 4,
        lambda s: 0.4 * s.Y[0] ** 2,
        ("resistance",),
    )


def plates(key: str) -> Case:
    """A variable capacitor; by its co-energy it is not linear in v."""
    C, slope = VALUES[TEXT]
    given = {
        "capacitance": TEXT,
        "coenergy": f"{TEXT}*v**2/2 + 0.02*v**4",
        "energy": f"q**2/(2*{TEXT})",
    }[key]
    b = 0.02 * (key == "coenergy")

    def law(s: Seen) -> list[float]:
        (v, w), (i, y) = s.X, s.Y
        if key == "energy":
            q, rate = s.own["q"]
            return [v - q / C(s.x), i - rate, y + q**2 * slope(s.x) / (2 * C(s.x) ** 2)]
        rate = (C(s.x) + 12 * b * v**2) * s.dX[0] + slope(s.x) * v * w
        return [i - rate, y + slope(s.x) * v**2 / 2]

    return Case(
        {key: given},
        law,
        ("" if key == "energy" else A, ""),
        lambda s: C(s.x) * s.X[0] ** 2 / 2 + 3 * b * s.X[0] ** 4,
    )


def synchronous(s: Seen) -> list[float]:
    """A machine of two phases with saliency and magnets."""
    c, d = math.cos(2 * s.x), math.sin(2 * s.x)
    i, w = np.array(s.Y[:2]), s.X[2]
    L = np.array([[0.8 + 0.2 * c, 0.2 * d], [0.2 * d, 0.8 - 0.2 * c]])
    slope = 0.4 * np.array([[-d, c], [c, d]])
    turned = 0.3 * np.array([-math.sin(s.x), math.cos(s.x)])
    volts = 0.35 * i + L @ np.array(s.dY[:2]) + (slope @ i + turned) * w
    return [*(np.array(s.X[:2]) - volts), s.Y[2] + i @ slope @ i / 2 + i @ turned]


def synchronous_energy(s: Seen) -> float:
    c, d = math.cos(2 * s.x), math.sin(2 * s.x)
    a, b = s.Y[:2]
    return (0.8 + 0.2 * c) * a**2 / 2 + (0.8 - 0.2 * c) * b**2 / 2 + 0.2 * d * a * b


def coupled(s: Seen) -> list[float]:
    L = np.array(s["inductance"])
    return list(np.array(s.X) - L @ np.array(s.dY))


def pump() -> Case:
    return Case(
        {"displacement": 0.4, "leakage": 0.2},
        lambda s: [s.Y[0] - 0.4 * s.X[1] - 0.2 * s.X[0], s.Y[1] + 0.4 * s.X[0]],
        ("", ""),
        heat=lambda s: 0.2 * s.X[0] ** 2,
        optional=("leakage",),
    )


def interface() -> Case:
    return Case({}, lambda s: [s.X[0] - s.X[1], s.Y[1] + s.Y[0]], ("", ""), stored=lambda s: 0.0)


def element(law: str, current: Callable[[Seen], float], **more: Any) -> Case:
    return dissipative({"domain": "electrical", "law": law, **more}, current)


CASES: dict[str, tuple[str, Case]] = {}
"""Each by its name: the type, and what it promises."""


def case(kind: str, what: Case, variant: str = "") -> None:
    CASES[f"{kind} {variant}".rstrip()] = (kind, what)


case("resistor", dissipative({"resistance": 2.5}, lambda s: s.X[0] / 2.5))
case("conductance", dissipative({"conductance": 0.4}, lambda s: 0.4 * s.X[0]))
case("capacitor", across_store("capacitance", lambda s: 0.7, 0.7))
case("capacitor", curved(A, "charge", "x"), "by charge")
case("capacitor", curved(A, "coenergy", "x"), "by coenergy")
case("inductor", through_store("inductance", 0.8))
case("inductor", curved(T, "flux", "y"), "by flux")
case("inductor", curved(T, "coenergy", "y"), "by coenergy")
case(
    "coupled_inductors",
    Case(
        {"inductance": ((0.9, 0.3), (0.3, 0.6))},
        coupled,
        (T, T),
        lambda s: float(np.array(s.Y) @ np.array(s["inductance"]) @ np.array(s.Y)) / 2,
    ),
)
case(
    "diode",
    dissipative(
        {"saturation": 0.1, "voltage": 0.5},
        lambda s: 0.1 * (math.exp(s.X[0] / 0.5) - 1),
        *("saturation", "voltage"),
    ),
)
case("opamp", Case({}, lambda s: [s.X[0], s.Y[0]], ("", "")))
case("transformer", transformer(lambda s: 1.7, {"ratio": 1.7}))
case(
    "transformer",
    transformer(lambda s: 1.7, {"ratio": 1.7, "domains": ("rotation_1d", "hydraulic")}, "domains"),
    "of two domains",
)
case("gyrator", gyrator("ratio", {"ratio": 1.7}))
case(
    "gyrator",
    gyrator("ratio", {"ratio": -0.6, "domains": ("electrical", "translation_1d")}, "domains"),
    "of two domains",
)
case("voltage_source", source("X", "voltage"))
case("current_source", source("Y", "current"))

case("mass", across_store("mass", lambda s: 0.7, 0.7))
case("inertia", across_store("inertia", lambda s: 0.7, 0.7))
for turning in ("translational", "rotational"):
    case(f"{turning}_spring", spring("stiffness"))
    case(f"{turning}_spring", spring("force"), "by force")
    case(f"{turning}_spring", spring("energy"), "by energy")
    case(f"{turning}_damper", dissipative({"damping": 0.4}, lambda s: 0.4 * s.X[0]))
    case(f"{turning}_friction", friction())
case("lever", transformer(lambda s: -1.7, {"ratio": -1.7}))
case("gear", transformer(lambda s: -1.7, {"ratio": -1.7}))
case("belt", transformer(lambda s: 0.9 / 0.4, {"radius1": 0.4, "radius2": 0.9}))
case("rack", transformer(lambda s: 0.6, {"radius": 0.6}, turned=True))
case("screw", transformer(lambda s: 3.0 / (2 * math.pi), {"lead": 3.0}, turned=True))
case("force_source", source("Y", "force"))
case("velocity_source", source("X", "velocity"))
case("torque_source", source("Y", "torque"))
case("angular_velocity_source", source("X", "velocity"))

case(
    "tank",
    across_store(
        "",
        lambda s: 2.0 / (1.6 * 2.5),
        {"area": 2.0, "density": 1.6, "gravity": 2.5},
        *("density", "gravity"),
    ),
)
case("accumulator", across_store("capacity", lambda s: 0.7, 0.7))
case("accumulator", curved(A, "volume", "x"), "by volume")
case("accumulator", curved(A, "coenergy", "x"), "by coenergy")
case("inertance", through_store("inertance", 0.8))
case("pipe", dissipative({"resistance": 2.5}, lambda s: s.X[0] / 2.5))
case(
    "orifice",
    dissipative(
        {"coefficient": 0.8, "width": 0.6},
        lambda s: 0.8 * s.X[0] / (s.X[0] ** 2 + 0.36) ** 0.25,
        "width",
    ),
)
for opening, share in ((0.6, 0.6), ("0.2 + across(r0)", None), (-0.3, 0.0)):
    case(
        "valve",
        dissipative(
            {"coefficient": 0.8, "opening": opening, "width": 0.6},
            lambda s, share=share: (
                (max(0.2 + s.beside["over"], 0.0) if share is None else share)
                * (0.8 * s.X[0] / (s.X[0] ** 2 + 0.36) ** 0.25)
            ),
            *("opening", "width"),
        )._replace(asks=(("over", "across(r0)"),)),
        {0.6: "", -0.3: "shut"}.get(opening, "of a variable"),  # type: ignore[call-overload]
    )
case("pressure_source", source("X", "pressure"))
case("flow_source", source("Y", "flow"))

case("heat_capacity", across_store("capacity", lambda s: 0.7, 0.7))
case("conduction", Case({"conductance": 0.4}, lambda s: [s.Y[0] - 0.4 * s.X[0]]))
case(
    "convection",
    Case(
        {"coefficient": 0.5, "area": 0.8},
        lambda s: [s.Y[0] - 0.4 * s.X[0]],
        optional=("area",),
    ),
)
case(
    "radiation",
    Case(
        {"coefficient": 0.2},
        lambda s: [
            s.Y[0]
            - 0.2 * s.sign * ((s.sign * s.X[0] + s.beside["sky"]) ** 4 - s.beside["sky"] ** 4)
        ],
        beside=(
            (
                "store",
                "sky",
                {"between": ("sky", "ground"), "domain": "thermal", "constant": 1.3},
            ),
        ),
        asks=(("sky", "across(sky)"),),
    ),
)
case(
    "losses",
    Case(
        {"of": ("hot", "drag")},
        lambda s: [
            s.Y[0] - s.beside["volts"] ** 2 / 1.6 - 0.3 * s.beside["speed"] ** 2,
        ],
        beside=(
            ("resistor", "hot", {"between": ("h", "ground"), "resistance": 1.6}),
            ("capacitor", "C", {"between": ("h", "ground"), "capacitance": 1.2}),
            ("translational_damper", "drag", {"between": ("m", "ground"), "damping": 0.3}),
            ("mass", "M", {"between": ("m", "ground"), "mass": 1.2}),
        ),
        asks=(("volts", "across(hot)"), ("speed", "across(drag)")),
    ),
)
case("temperature_source", source("X", "temperature"))
case("heat_source", source("Y", "heat"))

case("reluctance", across_store("reluctance", lambda s: 1 / 1.4, 1.4))
case("reluctance", curved(A, "flux", "x"), "by flux")
case("reluctance", curved(A, "coenergy", "x"), "by coenergy")
case("winding", gyrator("turns", {"turns": 1.7}))
case("mmf_source", source("X", "mmf"))
case("flux_source", source("Y", "rate"))

case("element", element("y = 0.4*x + 0.1*x**3", lambda s: 0.4 * s.X[0] + 0.1 * s.X[0] ** 3))
case(
    "element",
    Case(
        {"domain": "hydraulic", "law": "x = 0.4*y + 0.1*y**3"},
        lambda s: [s.X[0] - 0.4 * s.Y[0] - 0.1 * s.Y[0] ** 3],
    ),
    "by x",
)
case(
    "element",
    Case(
        {"domain": "rotation_1d", "law": "x - y = 0.2*tanh(x + y)"},
        lambda s: [s.X[0] - s.Y[0] - 0.2 * math.tanh(s.X[0] + s.Y[0])],
    ),
    "implicit",
)
case(
    "element",
    Case(
        {"domain": "electrical", "law": "y = s + 0.2*x", "rate": "x - 0.3*s"},
        lambda s: [
            s.Y[0] - s.own["s"][0] - 0.2 * s.X[0],
            s.own["s"][1] - s.X[0] + 0.3 * s.own["s"][0],
        ],
        optional=("rate",),
    ),
    "with a state",
)
for domain in PORTS["store"][0][1], "thermal", "magnetic", "acoustic":
    keys = {"domain": domain, "constant": 0.7}
    case(
        "store",
        across_store("", lambda s: 0.7, keys, "domain"),
        f"of across in {domain}" * (domain != "electrical"),
    )
    if domain != "thermal":
        case(
            "store",
            Case(
                {**keys, "keeps": T},
                lambda s: [s.X[0] - 0.7 * s.dY[0]],
                (T,),
                lambda s: 0.7 * s.Y[0] ** 2 / 2,
                optional=("domain", "keeps"),
            ),
            f"of through in {domain}",
        )
case("store", curved(A, "charge", "k"), "by charge")
case("store", curved(A, "coenergy", "k"), "by coenergy")

case("dc_motor", motor())
case("dc_motor", motor(inductance=0.5), "with inductance")
case("dc_motor", motor(inertia=0.3, damping=0.2, ratio=1.5), "with inertia")
case("dc_motor", motor(inductance=0.5, inertia=0.3, damping=0.2, ratio=-1.5), "with all")
case("moving_coil", coil())
case("moving_coil", coil(resistance=0.9, inductance=0.5), "with all")
for key in ("inductance", "coenergy", "energy"):
    case("solenoid", magnet(key, TEXT), f"by {key}" * (key != "inductance"))
    case("reluctance_machine", magnet(key, TURNING), f"by {key}" * (key != "inductance"))
for key in ("capacitance", "coenergy", "energy"):
    case("variable_capacitor", plates(key), f"by {key}" * (key != "capacitance"))
case(
    "piezo",
    Case(
        {"stiffness": 2.0, "coupling": 0.5, "capacitance": 0.8},
        lambda s: [
            s.Y[0] - 0.8 * s.dX[0] - 0.5 * s.X[1],
            s.Y[1] + 0.5 * s.X[0] - 2.0 * s.x,
        ],
        (A, ""),
        lambda s: 0.8 * s.X[0] ** 2 / 2 + 2.0 * s.x**2 / 2,
    ),
)
case(
    "synchronous_machine",
    Case(
        {
            "inductance": (
                ("0.8 + 0.2*cos(2*x)", "0.2*sin(2*x)"),
                ("0.2*sin(2*x)", "0.8 - 0.2*cos(2*x)"),
            ),
            "flux": ("0.3*cos(x)", "0.3*sin(x)"),
            "resistance": 0.35,
        },
        synchronous,
        (T, T, ""),
        synchronous_energy,
        lambda s: 0.35 * (s.Y[0] ** 2 + s.Y[1] ** 2),
        ("flux", "resistance"),
    ),
)
case(
    "cylinder",
    Case(
        {"area": 0.4},
        lambda s: [s.Y[0] - 0.4 * s.X[1], s.Y[1] + 0.4 * s.X[0]],
        ("", ""),
        lambda s: 0.0,
    ),
)
case("pump", pump())
case("hydraulic_motor", pump())
case("translational_interface", interface())
case("rotational_interface", interface())

ODD = {
    name
    for name, (kind, _) in CASES.items()
    if kind not in (*SOURCES, "diode", "radiation", "losses", "synchronous_machine")
    and kind not in ("solenoid", "reluctance_machine", "variable_capacitor")
    and name != "valve of a variable"
} | {"opamp"}
"""Whose laws stay the same if all its variables change their sign."""

# ---- a model around a component

ACOUSTIC = {
    "across": {"name": "sound pressure", "unit": "Pa", "letter": "p"},
    "through": {"name": "volume velocity", "unit": "m^3/s", "letter": "U"},
}
SHAFT, JOINT, POINTS = "shaft", "joint", "points"
MASS, HEIGHT = 1.3, 0.8
"""Of the body on the joint, and how far beside its way the other point is."""


class Way(NamedTuple):
    """How a component is tested: what stands around its edges, their direction, its place in mechanics."""

    series: bool = True
    forward: bool = True
    place: str = SHAFT


class Whole(NamedTuple):
    """A model as the tables of a file, in their order."""

    rows: list[Row]
    mechanics: str
    outputs: dict[str, str]


def ports_of(name: str) -> list[tuple[str, str]]:
    """Label and subspace of every edge in a case."""
    kind, given = CASES[name]
    found = list(PORTS[kind])
    if "domains" in given.keys:
        return [(label, d) for (label, _), d in zip(found, given.keys["domains"], strict=True)]
    return [(label, given.keys.get("domain", domain)) for label, domain in found]


def edge_of(label: str) -> str:
    return f"{NAME}.{label}" if label else NAME


def whole(name: str, way: Way) -> Whole:
    """The model around a case."""
    kind, given = CASES[name]
    ports = ports_of(name)
    pairs = []
    for k, (label, _) in enumerate(ports):
        far = "sky" if kind == "radiation" else "ground"
        pair = (f"p{k}", far)
        turned = not way.forward and label != "mechanical"
        pairs.append(pair[::-1] if turned else pair)
    keys: dict[str, Any] = {}
    spatial = kind in (*TRANSDUCERS, "synchronous_machine") and way.place != SHAFT
    if kind in ("coupled_inductors", "synchronous_machine"):
        keys["windings"] = tuple(pairs[:2])
    else:
        keys["between"] = pairs[0]
    if kind in TWO_PORTS:
        keys["second"] = pairs[1]
    elif kind == "opamp":
        keys["output"] = pairs[1]
    elif ports[-1][0] == "mechanical":
        keys |= {
            SHAFT: {SHAFT: pairs[-1]},
            JOINT: {JOINT: "j"},
            POINTS: {POINTS: ("ground.pin", "cart")},
        }[way.place]
    rows: list[Row] = [(kind, NAME, {**keys, **given.keys}), *given.beside]
    if kind == "opamp":
        rows.append(("resistor", "back", {"between": ("p0", "p1"), "resistance": 1.9}))
    for k, (_, domain) in enumerate(ports[:-1] if spatial else ports):
        rows += around(k, domain, way.series or kind == "opamp")
    if not way.series:
        rows += around(9, "hydraulic", True)  # what is on a source is no state
        rows[-1][2]["between"] = ("s9", "ground")
    asked = dict(given.asks)
    if spatial:
        edge = edge_of(ports[-1][0])
        asked |= {"X": f"across({edge})", "Y": f"through({edge})"}
    turns = ports[-1][1] == "rotation_1d"
    return Whole(rows, MECHANICS[turns] if spatial else "", asked)


def around(k: int, domain: str, series: bool) -> list[Row]:
    """A store and a resistance at one edge."""
    to = f"s{k}" if series else f"p{k}"
    store = {"between": (to, "ground"), "domain": domain, "constant": 1.1 + 0.3 * k}
    ends = (to, f"p{k}") if series else (to, "ground")
    law = f"x = {0.6 + 0.2 * k}*y"
    return [
        ("store", f"e{k}", store),
        ("element", f"r{k}", {"between": ends, "domain": domain, "law": law}),
    ]


MECHANICS = {
    False: f"""\
[gravity]
acceleration = [0, 0, 0]
[frame.pin]
at = [0, {HEIGHT}, 0]
[body.cart]
mass = {MASS}
[prismatic.j]
between = ["ground", "cart"]
axis = [1, 0, 0]
effort = false
""",
    True: f"""\
[gravity]
acceleration = [0, 0, 0]
[body.cart]
mass = 1
inertia = [1, 1, {MASS}]
[revolute.j]
between = ["ground", "cart"]
axis = [0, 0, 1]
effort = false
""",
}


def text_of(given: Whole) -> str:
    """As a model file."""
    lines = ['name = "conformance"']
    if any("acoustic" in row[2].values() for row in given.rows):
        for key, value in ACOUSTIC.items():
            inner = ", ".join(f"{k} = {json.dumps(v)}" for k, v in value.items())
            lines += ["[domain.acoustic]"] * (key == A) + [f"{key} = {{ {inner} }}"]
    lines.append(given.mechanics)
    for kind, name, keys in given.rows:
        lines.append(f"[{kind}.{name}]")
        lines += [f"{key} = {json.dumps(value)}" for key, value in keys.items()]
    lines += ["[outputs]"] * bool(given.outputs)
    lines += [f'{name} = "{value}"' for name, value in given.outputs.items()]
    return "\n".join(lines) + "\n"


def model_of(given: Whole) -> Model:
    """By the builder."""
    model = Model("conformance")
    if any("acoustic" in row[2].values() for row in given.rows):
        model.domain("acoustic", **ACOUSTIC)
    if given.mechanics:
        model.gravity = (0, 0, 0)
        if "prismatic" in given.mechanics:
            model.ground.frame("pin", at=(0, HEIGHT, 0))
            cart = model.body("cart", mass=MASS)
            model.prismatic("j", between=("ground", cart), axis=(1, 0, 0), effort=False)
        else:
            cart = model.body("cart", mass=1, inertia=(1, 1, MASS))
            model.revolute("j", between=("ground", cart), axis=(0, 0, 1), effort=False)
    for kind, name, keys in given.rows:
        getattr(model, kind)(name, **keys)
    for name, value in given.outputs.items():
        model.output(name, value)
    return model


class System:
    """An emitted case, at random states."""

    def __init__(
        self, name: str, way: Way, folder: Any, given: Whole | None = None, folded: bool = False
    ) -> None:
        """Emit the case's own model, or another one around it."""
        self.name, self.way = name, way
        self.kind, self.case = CASES[name]
        self.labels = [label for label, _ in ports_of(name)]
        self.model = parse(text_of(given or whole(name, way)).encode(), "m.toml")
        files = render(self.model, languages=["python"], folded=folded)
        self.module = load(files, "conformance", folder)
        self.states = list(self.module.STATE_NAMES)

    @property
    def derivation(self) -> Derivation:
        return derive(self.model)

    def call(self, function: str, x: Any, t: float) -> Any:
        nq = self.module.NQ
        nu = np.zeros(self.module.NU)
        given = {"x": x, "q": x[:nq], "v": x[nq:], "u": nu, "t": t}
        emitted = getattr(self.module, function)
        return emitted(*(given[a] for a in inspect.signature(emitted).parameters))

    def outputs(self, x: Any, t: float) -> dict[str, float]:
        """What the case asks for, and X0, Y0, X1, ...: of edges in mechanics by outputs."""
        y: dict[str, float] = {}
        if hasattr(self.module, "outputs"):
            found = self.call("outputs", x, t).tolist()
            y = dict(zip(self.module.OUTPUT_NAMES, found, strict=True))
        across = dict(zip(self.module.ACROSS_NAMES, self.call("across", x, t), strict=True))
        through = dict(zip(self.module.REACTION_NAMES, self.call("reactions", x, t), strict=True))
        for k, label in enumerate(self.labels):
            spatial = self.way.place != SHAFT and label == "mechanical"
            edge = edge_of(label)
            y[f"X{k}"] = y["X"] if spatial else float(across[edge])
            y[f"Y{k}"] = y["Y"] if spatial else float(through[edge])
        return y

    def seen(self, x: Any, t: float, rated: bool = True) -> Seen:
        """The component's variables; rates by central differences of fourth order along the motion."""
        found = Seen(self.case.keys, 1 if self.way.forward else -1)
        y = self.outputs(x, t)
        n = range(len(self.labels))
        found.X, found.Y = [y[f"X{k}"] for k in n], [y[f"Y{k}"] for k in n]
        found.beside = y
        found.t = t
        found.x = self.displacement(x)
        if rated:
            rate = self.call("rhs", x, t)
            there = {h: self.outputs(x + h * STEP * rate, t + h * STEP) for h in (-2, -1, 1, 2)}
            found.dX = [difference({h: y[f"X{k}"] for h, y in there.items()}) for k in n]
            found.dY = [difference({h: y[f"Y{k}"] for h, y in there.items()}) for k in n]
            for place, state in enumerate(self.states):
                letter, _, owner = state.partition("_")
                if owner == NAME:
                    found.own[letter] = (float(x[place]), float(rate[place]))
        return found

    def displacement(self, x: Any) -> float:
        """Of the edge in mechanics."""
        if self.way.place == SHAFT or "j" not in self.states:
            name = f"x_{NAME}"
            return float(x[self.states.index(name)]) if name in self.states else math.nan
        j = float(x[self.states.index("j")])
        return math.hypot(j, HEIGHT) if self.way.place == POINTS else j

    def rate_of(self, stored: Callable[[Seen], float], x: Any, t: float) -> float:
        rate = self.call("rhs", x, t)
        return difference(
            {h: stored(self.owned(x + h * STEP * rate, t + h * STEP)) for h in (-2, -1, 1, 2)}
        )

    def owned(self, x: Any, t: float) -> Seen:
        """Without rates."""
        found = self.seen(x, t, rated=False)
        for place, state in enumerate(self.states):
            letter, _, owner = state.partition("_")
            if owner == NAME:
                found.own[letter] = (float(x[place]), math.nan)
        return found

    def drawn(self, seed: int) -> tuple[Any, float]:
        """A random state and time."""
        rng = np.random.default_rng(seed)
        return rng.uniform(-1, 1, len(self.states)), float(rng.uniform(0, 2))


STEP = 1e-3


def difference(there: Mapping[int, float]) -> float:
    return (8 * (there[1] - there[-1]) - (there[2] - there[-2])) / (12 * STEP)


@pytest.fixture(scope="module")
def find(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, Way], System]:
    """A case emitted, once."""
    found: dict[tuple[str, Way], System] = {}

    def system(name: str, way: Way) -> System:
        if (name, way) not in found:
            found[(name, way)] = System(name, way, tmp_path_factory.mktemp("case"))
        return found[(name, way)]

    return system


def ways_of(name: str) -> list[Way]:
    """Store and resistance in series and in parallel, both directions, each place in mechanics."""
    kind, _ = CASES[name]
    found = [Way(True, True), Way(False, False)]
    if PORTS[kind][-1][0] == "mechanical":
        found += [Way(True, False, JOINT), Way(False, True, JOINT)]
        if PORTS[kind][-1][1] == "translation_1d":
            found.append(Way(True, True, POINTS))
    return found


ALL = [(name, way) for name in CASES for way in ways_of(name)]
EVERY = pytest.mark.parametrize(
    ("name", "way"),
    ALL,
    ids=[
        f"{name}, {'series' if way.series else 'parallel'}, {'' if way.forward else 'turned, '}{way.place}"
        for name, way in ALL
    ],
)
NAMES = pytest.mark.parametrize("name", CASES)
KINDS = pytest.mark.parametrize("kind", COMPONENTS)

# ---- the tables


def test_the_tables_cover_the_register() -> None:
    assert set(PORTS) == set(COMPONENTS)
    assert {kind for kind, _ in CASES.values()} == set(COMPONENTS)
    assert set(CASES) >= set(COMPONENTS)
    assert {kind for kind, made in COMPONENTS.items() if made.source} == SOURCES


@KINDS
def test_types_are_what_they_are_called(kind: str) -> None:
    made = COMPONENTS[kind]
    assert made.kind == kind
    assert made.__doc__
    assert getattr(Model, kind).kind is made


# ---- what is emitted


@pytest.mark.one_in(3)
@EVERY
def test_obeys_its_law(name: str, way: Way, find: Callable[[str, Way], System]) -> None:
    """At its edges, by formulas written apart."""
    system = find(name, way)
    for seed in SEEDS:
        seen = system.seen(*system.drawn(seed))
        zero = system.case.law(seen)
        assert len(zero) >= len(seen.X)
        size = 1 + max(map(abs, (*seen.X, *seen.Y, *seen.dX, *seen.dY)))
        assert np.max(np.abs(zero)) <= EXACT * size


@pytest.mark.one_in(3)
@EVERY
def test_keeps_its_energy(name: str, way: Way, find: Callable[[str, Way], System]) -> None:
    """What it takes in it stores or turns into heat: by hand, and as the derivation says itself."""
    system = find(name, way)
    domains = {domain for _, domain in ports_of(name)}
    if system.kind in SOURCES or "thermal" in domains:
        return
    for seed in SEEDS:
        x, t = system.drawn(seed)
        seen = system.seen(x, t)
        taken = float(np.dot(seen.X, seen.Y))
        size = 1 + sum(abs(a * b) for a, b in zip(seen.X, seen.Y, strict=True))
        stored, heat = system.case.stored, system.case.heat
        if stored is not None or heat is not None:
            grown = 0.0 if stored is None else system.rate_of(stored, x, t)
            lost = 0.0 if heat is None else heat(seen)
            assert abs(grown + lost - taken) <= 10 * EXACT * size
        gains = gains_of(system, x, t)
        if NAME in gains:
            assert abs(gains[NAME]) <= EXACT * size
        else:
            assert name.endswith((" by charge", " by flux", " by volume", " by force", "a state"))


def gains_of(system: System, x: Any, t: float) -> dict[str, float]:
    """What each component stores and loses, less what it takes in, at the rates that are emitted."""
    nq = system.module.NQ
    numeric = system.derivation.numeric(t=t)
    a = system.call("forward_dynamics", x, t).tolist()
    at = numeric.exchange(x[:nq].tolist(), x[nq:].tolist())
    assert at is not None
    return {key: float(value) for key, value in replace(at, acceleration=a).gains().items()}


@EVERY
def test_what_its_edges_are_called(name: str, way: Way, find: Callable[[str, Way], System]) -> None:
    """The lists of variables have its edges, with the values that outputs have."""
    system = find(name, way)
    (component,) = (c for c in system.model.components if c.name == NAME)
    assert [port.label for port in component.ports()] == system.labels
    domains = [domain for _, domain in ports_of(name)]
    spatial = way.place != SHAFT
    found = [port.domain for port in component.ports()]
    assert found == ([*domains[:-1], ""] if spatial else domains)
    assert [port.spatial for port in component.ports()][-1] == spatial
    edges = [edge_of(label) for label in system.labels]
    listed = edges[:-1] if spatial else edges
    spread = [f"{edges[-1]}_{v}{c}" for v in "vw" for c in "xyz"] if spatial else []
    for names, expected in (
        (system.module.ACROSS_NAMES, [*spread, *listed]),
        (system.module.REACTION_NAMES, listed),
    ):
        assert [edge for edge in names if edge.partition(".")[0] == NAME] == expected


@KINDS
def test_every_edge_may_be_asked_for(
    kind: str, find: Callable[[str, Way], System], tmp_path: Any
) -> None:
    """Outputs, and values of other components, may name it; they agree with the lists."""
    system, given = find(kind, Way()), whole(kind, Way())
    for k, label in enumerate(system.labels):
        for letter, word in (("X", A), ("Y", T)):
            given.outputs[f"own_{letter}{k}"] = f"{word}({edge_of(label)})"
    heat = " + ".join(f"{word}({edge_of(label)})" for label in system.labels for word in (A, T))
    given.rows.append(("heat_capacity", "warm", {"between": ("warm", "ground"), "capacity": 2.0}))
    given.rows.append(("heat_source", "heater", {"between": ("ground", "warm"), "heat": heat}))
    other = System(kind, Way(), tmp_path, given)
    x, t = system.drawn(7)
    y, found = system.outputs(x, t), other.outputs(np.append(x, 3.0), t)
    total = 0.0
    for key in y:
        if key[0] in "XY":
            assert found[f"own_{key}"] == pytest.approx(y[key], rel=1e-12, abs=1e-12)
            total += y[key]
    rate = other.call("rhs", np.append(x, 3.0), t)
    assert rate[other.states.index("T_warm")] == pytest.approx(total / 2, rel=1e-12, abs=1e-12)


@NAMES
def test_keeps_what_it_says(name: str, find: Callable[[str, Way], System]) -> None:
    """With a resistance in series all that it keeps are states, called after it."""
    system = find(name, Way())
    (component,) = (c for c in system.model.components if c.name == NAME)
    kept = system.case.kept
    assert component.kept() == kept
    letters = {
        "electrical": ("v", "i"),
        "translation_1d": ("v", "F"),
        "rotation_1d": ("w", "tau"),
        "hydraulic": ("p", "Q"),
        "thermal": ("T", "H"),
        "magnetic": ("F", "dphi"),
        "acoustic": ("p", "U"),
    }
    several = system.kind in ("coupled_inductors", "synchronous_machine")
    expected = [
        letters[domain][what == T] + f"_{NAME}" + f"_{label}" * several
        for (label, domain), what in zip(ports_of(name), kept, strict=True)
        if what
    ]
    expected += [f"{own.label}_{NAME}" for own in component.states()]
    if component.displaced:
        expected.append(f"x_{NAME}")
    found = [s for s in system.states if s.partition("_")[2].partition("_")[0] == NAME]
    assert found == expected
    assert not system.derivation.formulation.network.dependent
    assert not system.derivation.formulation.network.rates


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", sorted(ODD))
@pytest.mark.parametrize("series", [True, False], ids=["series", "parallel"])
def test_turning_its_edges_turns_its_variables(
    name: str, series: bool, find: Callable[[str, Way], System], tmp_path: Any
) -> None:
    """... and nothing else."""
    system, turned = find(name, Way(series)), whole(name, Way(series, False))
    keys = turned.rows[0][2]
    if "shaft" in keys:
        keys["shaft"] = keys["shaft"][::-1]
    other = System(name, Way(series, False), tmp_path, turned)
    assert other.states == system.states
    own = [s.partition("_")[2].partition("_")[0] == NAME for s in system.states]
    signs = np.where(own, -1.0, 1.0)
    x, t = system.drawn(5)
    there = signs * x
    np.testing.assert_allclose(
        other.call("rhs", there, t), signs * system.call("rhs", x, t), rtol=1e-11, atol=1e-11
    )
    before, after = system.outputs(x, t), other.outputs(there, t)
    for key in before:
        if key[0] in "XY":
            assert after[key] == pytest.approx(-before[key], rel=1e-11, abs=1e-11)


MECHANICAL = [(name, way) for name, way in ALL if way.place != SHAFT]


@pytest.mark.parametrize(("name", "way"), MECHANICAL)
def test_pushes_what_it_drives(name: str, way: Way, find: Callable[[str, Way], System]) -> None:
    """The body on its joint accelerates by -Y, what the edge does not take in."""
    system = find(name, way)
    place = system.module.NQ + list(system.module.V_NAMES).index("j")
    for seed in SEEDS:
        x, t = system.drawn(seed)
        seen = system.seen(x, t, rated=False)
        j, w = float(x[0]), float(x[place])
        slope = j / math.hypot(j, HEIGHT) if way.place == POINTS else 1.0
        assert seen.X[-1] == pytest.approx(slope * w, abs=1e-13)
        force = MASS * float(system.call("rhs", x, t)[place])
        assert force == pytest.approx(-slope * seen.Y[-1], rel=1e-11, abs=1e-12)


# ---- the two doors


@pytest.mark.one_in(3)
@NAMES
def test_file_and_builder_say_the_same(name: str) -> None:
    for way in {*ways_of(name)} - {Way(False, False)}:
        given = whole(name, way)
        read, built = parse(text_of(given).encode(), "m.toml"), model_of(given)
        read.about = built.about = "the same"
        assert render(read) == render(built)


@NAMES
def test_every_number_may_be_an_expression(
    name: str, find: Callable[[str, Way], System], tmp_path: Any
) -> None:
    """... of parameters: with the values they had, everything stays as it was."""
    system = find(name, Way())
    given = whole(name, Way())
    kind, _, keys = given.rows[0]
    spelled = {key: expressed(value) for key, value in keys.items()}
    if spelled == keys:
        return
    given.rows[0] = (kind, NAME, spelled)
    given = given._replace(mechanics="[parameters]\nunity = 1.0\n")
    other = System(name, Way(), tmp_path, given, folded=True)
    x, t = system.drawn(4)
    np.testing.assert_allclose(
        other.call("rhs", x, t), system.call("rhs", x, t), rtol=1e-12, atol=1e-12
    )


def expressed(value: Any) -> Any:
    if isinstance(value, tuple):
        return tuple(expressed(x) for x in value)
    return f"{value!r}*unity" if isinstance(value, float) else value


@NAMES
def test_keys_are_in_the_schema(name: str) -> None:
    kind, given = CASES[name]
    (table,) = (schema()["properties"][kind]["additionalProperties"],)
    keys = whole(name, Way()).rows[0][2]
    assert table["additionalProperties"] is False
    assert set(keys) <= set(table["properties"])
    assert set(table.get("required", ())) <= set(keys)
    assert all(table["properties"][key].get("description") for key in given.keys)


@NAMES
def test_unknown_keys_are_refused(name: str) -> None:
    given = whole(name, Way())
    kind, _, keys = given.rows[0]
    given.rows[0] = (kind, NAME, {**keys, "nonsense": 1})
    refused(given, 'unknown key "nonsense"', "nonsense")
    with pytest.raises((ModelError, TypeError)):
        model_of(given)


@NAMES
def test_keys_may_be_left_out_or_must_be_given(name: str) -> None:
    """One error with the line of the table, or of the key that lacks its like."""
    kind, what = CASES[name]
    keys = whole(name, Way()).rows[0][2]
    for key in keys:
        given = whole(name, Way())
        given.rows[0] = (kind, NAME, {k: v for k, v in keys.items() if k != key})
        if key in what.optional:
            parse(text_of(given).encode(), "m.toml")
            model_of(given)
        else:
            refused(given, key, "")
            if (kind, key) != ("element", "domain"):  # the builder takes the electrical one
                with pytest.raises((ModelError, TypeError)):
                    derive(model_of(given))


def refused(given: Whole, says: str, key: str) -> None:
    """One of the errors has the line of the component's table, or of one of its keys."""
    text = text_of(given)
    line = text.split("\n").index(f"[{given.rows[0][0]}.{NAME}]") + 1
    if key:
        line += [*given.rows[0][2]].index(key) + 1
    with pytest.raises(SourceErrors) as caught:
        parse(text.encode(), "m.toml")
    matching = [e for e in caught.value.errors if e.line == line and says in str(e)]
    assert matching, str(caught.value)
    assert all(f"[{given.rows[0][0]}.{NAME}]" in str(e) for e in caught.value.errors)


@KINDS
def test_two_components_cannot_have_one_name(kind: str) -> None:
    given = whole(kind, Way())
    other = "mass" if kind == "pipe" else "pipe"
    text = text_of(given._replace(outputs={})) + f"[{other}.{NAME}]\nbetween = []\n"
    with pytest.raises(LinegraphError, match=rf"taken by \[{kind}\.{NAME}\] in line"):
        parse(text.encode(), "m.toml")
    model = model_of(given)
    _, _, keys = given.rows[0]
    with pytest.raises(ModelError, match="the name is taken"):
        getattr(model, kind)(NAME, **keys)

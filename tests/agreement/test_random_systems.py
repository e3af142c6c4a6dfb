"""Emitted code of random systems of everything against Newton and Euler: 500 systems x 20 states.

That angles and quaternions of one system accelerate alike is shown in `test_joint_family.py`.
"""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from oracles import newton_euler as oracle
from support.compiled import Compiled
from support.emitted import load
from systems import random_systems as systems

from linegraph.components.forces import ELEMENTS
from linegraph.components.joints import JOINTS
from linegraph.emission.emit import render

if TYPE_CHECKING:
    from pathlib import Path

    from systems.random_systems import State, System

SYSTEMS, STATES, BATCH = 500, 20, 20
EVERY = range(0, SYSTEMS, BATCH)
FEW = EVERY[:5:5]
"""Where batches begin: by default of those systems that are counted below to have every part often."""

EXACT = 1e-12  # relative to 1 + the largest expected entry; measured 1.3e-13
SOLVED = 1e-10  # forward dynamics at the same scale; measured 1.1e-11
SAME = 3e-14  # C and Python; measured 3e-15
SAME_SOLVED = 1e-12  # their forward dynamics; measured 3e-14
AUDIT = 1e-11  # of the sums of through times across, relative to the largest power
BALANCE = 5e-9  # of power, relative; measured 4e-10


def error(found: Any, expected: Any) -> float:
    found, expected = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    return float(np.max(np.abs(found - expected)) / (1 + np.max(np.abs(expected))))


def regular_states(rng: np.random.Generator, system: System, count: int) -> list[State]:
    """States at which M is safely regular: away from singular orientations of angles."""
    found: list[State] = []
    while len(found) < count:
        state = systems.draw_state(rng, system)
        if systems.regular(system, state):
            found.append(state)
    return found


def arguments(emitted: Any, system: System, states: list[State], tau: np.ndarray) -> dict[str, Any]:
    """Everything that emitted functions take, for many states."""
    count = len(system.effort_places)
    u = np.array([[state.u[name] for name in emitted.U_NAMES[count:]] for state in states])
    return {
        "p": getattr(emitted, "DEFAULT_PARAMETERS", None),
        "t": np.array([state.t for state in states]),
        "q": np.array([state.q for state in states]),
        "v": np.array([state.v for state in states]),
        "a": np.array([state.a for state in states]),
        "u": np.hstack([tau, u.reshape(len(states), -1)]),
    }


def call(emitted: Any, name: str, given: dict[str, Any]) -> Any:
    """A function with those arguments that it takes."""
    function = getattr(emitted, name)
    return function(*(given[key] for key in inspect.signature(function).parameters))


@pytest.mark.seeds(FEW, EVERY)
def test_emitted_python_agrees_with_newton_euler(seed: int, tmp_path: Path) -> None:
    for number in range(seed, seed + BATCH):
        system = systems.random_system(number)
        name = system.model.name
        files = render(system.model, languages=["python"], functions=("power",))
        emitted = load(files, name, tmp_path)
        rng = np.random.default_rng([number, 1])
        states = regular_states(rng, system, STATES)
        tau = rng.normal(size=(STATES, len(system.effort_places)))
        given = arguments(emitted, system, states, tau)
        assert list(emitted.Q_NAMES) == system.names
        assert set(emitted.U_NAMES[tau.shape[1] :]) == set(system.named_inputs)

        mass, bias = call(emitted, "equations", given)
        torque = call(emitted, "inverse_dynamics", given)
        acceleration = call(emitted, "forward_dynamics", given)
        energy = call(emitted, "energy", given)
        powers, sums = call(emitted, "power", given)
        assert np.abs(sums).max() <= AUDIT * (1 + np.abs(powers).max()), number
        mass = np.broadcast_to(mass, (STATES, *mass.shape[-2:]))
        assert np.array_equal(mass, np.swapaxes(mass, -1, -2))
        for k in range(0, STATES, 3):
            state = states[k]
            truth = systems.expected(system, state, tau[k])
            assert error(mass[k], truth.mass) < EXACT, number
            assert error(bias[k], truth.bias) < EXACT, number
            assert error(torque[k], truth.mass @ state.a + truth.bias) < EXACT, number
            solved = np.linalg.solve(truth.mass, truth.efforts - truth.bias)
            assert error(acceleration[k], solved) < SOLVED, number
            assert error(energy[k], (truth.kinetic, truth.potential)) < EXACT, number


def at(emitted: Any, system: System, state: State, tau: np.ndarray) -> dict[str, Any]:
    """The arguments of one state."""
    given = arguments(emitted, system, [state], tau[None])
    return {key: value if key == "p" else value[0] for key, value in given.items()}


@pytest.mark.seeds(range(7, 487, 128), range(7, 487, 32))
def test_emitted_c_agrees_with_emitted_python(seed: int, tmp_path: Path) -> None:
    """The same operations in the same order, but for functions of the two libraries."""
    system = systems.random_system(seed)
    name = system.model.name
    only = ("equations", "inverse_dynamics", "forward_dynamics", "energy", "coordinate_rates")
    files = render(system.model, only=only)
    emitted, compiled = load(files, name, tmp_path), Compiled(files, name, tmp_path)
    rng = np.random.default_rng([seed, 2])
    n = emitted.NV
    outputs: dict[str, list[tuple[int, ...]]] = {
        "equations": [(n, n), (n,)],
        "inverse_dynamics": [(n,)],
        "forward_dynamics": [(n,)],
        "energy": [(2,)],
        "coordinate_rates": [(emitted.NQ,)],
    }
    for state in regular_states(rng, system, 3):
        given = at(emitted, system, state, rng.normal(size=len(system.effort_places)))
        in_c = {**given, "p": None, "t": float(given["t"])}
        for function, out in outputs.items():
            names = inspect.signature(getattr(emitted, function)).parameters
            found = compiled.call(function, *(in_c[key] for key in names), out=out)
            expected = call(emitted, function, given)
            pairs = zip(found, expected, strict=True) if len(out) > 1 else ((found, expected),)
            for ours, theirs in pairs:
                limit = SAME_SOLVED if function == "forward_dynamics" else SAME
                assert error(ours, theirs) < limit


@pytest.mark.seeds(range(0, 80, 16), range(0, 80, 4))
def test_power_balance(seed: int, tmp_path: Path) -> None:
    """d(T + U)/dt = (tau + forces that no potential has) . v, by a fourth-order difference."""
    system = systems.random_system(seed)
    assert not system.drives
    name = system.model.name
    only = ("energy", "inverse_dynamics")
    emitted = load(render(system.model, languages=["python"], only=only), name, tmp_path)
    rng, step = np.random.default_rng([seed, 3]), 1e-3
    own_q, own_v = system.places()
    for state in regular_states(rng, system, 3):
        tau = np.zeros(len(system.effort_places))
        given = at(emitted, system, state, tau)
        q, v, a = state.whole
        a = a.copy()
        a[own_v] = state.a
        rate = 0.0
        for shift, weight in {-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}.items():
            there_q, there_v = oracle.advance(system.tree, q, v, a, shift * step)
            there = {**given, "q": there_q[own_q], "v": there_v[own_v]}
            rate += weight * float(np.sum(call(emitted, "energy", there))) / step
        truth = systems.expected(system, state, tau)
        lost = truth.passive - truth.conservative
        power = float((call(emitted, "inverse_dynamics", given) + lost) @ state.v)
        assert abs(rate - power) < BALANCE * (1 + abs(power)), seed


def test_every_kind_of_part_occurs_often() -> None:
    """A hundred systems: every joint, element, kind of drive and coupling is among them many times."""
    seen: dict[str, int] = {}
    for seed in range(100):
        system = systems.random_system(seed)
        parts = [joint.kind for joint in system.model.joints]
        parts += [element.kind for element in system.model.elements]
        parts += [
            f"drive by {'input' if d.text == 'input' else 'time'}" for d in system.drives.values()
        ]
        parts += ["coupling"] * len(system.model.couplings)
        parts += [
            name for name in ("rotor", "basement") if any(name in b for b in system.model.bodies)
        ]
        parts += ["quaternion" for _ in system.held]
        parts += ["between points" for e in system.model.elements if getattr(e, "between", None)]
        parts += ["in a joint" for e in system.model.elements if getattr(e, "joint", None)]
        parts += ["driven by inputs" for force in system.forces if force.driven]
        for part in parts:
            seen[part] = seen.get(part, 0) + 1
    expected = (*JOINTS, *ELEMENTS, "load", "coupling", "rotor", "basement", "quaternion")
    expected += ("drive by input", "drive by time", "between points", "in a joint")
    expected += ("driven by inputs",)
    rare = {part: seen.get(part, 0) for part in expected if seen.get(part, 0) < 10}
    assert rare == {}, "systems.random_systems draws these too rarely"

"""Derivatives of the dynamics against complex steps of the derivation over numbers.

The reference is no program: linegraph's derivation over complex lanes, one lane for each direction, solved by
numpy. So neither the DAG, nor the working frames, nor any rule of differentiation is shared.
"""

from __future__ import annotations

import inspect
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from agreement.test_random_mixed import case_of
from oracles.mixed_reference import Lane, Reference, lanes, rate
from support.compiled import Compiled
from support.emitted import load
from systems import random_systems

import linegraph as lg
from linegraph import ModelError, derive
from linegraph.algebra.differentiation import Replay
from linegraph.algebra.protocol import Floats
from linegraph.components.parameters import valued
from linegraph.emission.emit import render
from linegraph.kinematics.tree_state import TreeState
from linegraph.numeric.reference import Numeric
from linegraph.programs.register import PROGRAMS
from linegraph.programs.workspace import Workspace

if TYPE_CHECKING:
    from linegraph.derivation import Derivation

Array = Any

EXAMPLES = Path(__file__).parents[2] / "examples"
STEP = 1e-30
EXACT = 1e-12
"""Relative to 1 + the largest entry of the matrix; of accelerations times the condition of M, too."""


@dataclass(frozen=True)
class Point:
    """A model at one state."""

    derivation: Derivation
    t: float
    q: Array
    v: Array
    u: Array

    @cached_property
    def mechanical(self) -> int:
        return int(self.derivation.structure.layout.mechanical)

    @cached_property
    def loop(self) -> Array:
        """The unknowns of the algebraic loop."""
        network = self.derivation.formulation.network
        if not network or not network.loop:
            return np.zeros(0)
        numeric = self.derivation.numeric(None, self.t, list(self.u))
        exchange = numeric.exchange(list(self.q), list(self.v))
        assert exchange is not None
        return np.array(exchange.solved)

    @cached_property
    def still(self) -> Reference:
        return self.at(np.zeros((1, len(self.q) + len(self.v) + len(self.u))))

    def at(self, changes: Array) -> Reference:
        """One lane for each row of changes of q, v and u."""
        count, first = len(changes), len(self.q)
        second = first + len(self.v)
        found = Reference(
            self.derivation,
            np.full(count, self.t),
            self.q + changes[:, :first],
            self.v + changes[:, first:second],
            self.u + changes[:, second:],
            np.tile(self.loop, (count, 1)),
        )
        if not self.loop.size:
            return found
        exchange = found.here.networks
        assert exchange is not None
        network = exchange.network
        residual = found.stacked([exchange.still(r) for r in network.loop])
        slopes = found.stacked([[exchange.still(x) for x in row] for row in network.loop_jacobian])
        return replace(
            found, loop=found.loop - np.linalg.solve(slopes, residual[..., None])[..., 0]
        )

    @cached_property
    def columns(self) -> Array:
        """N(q), for changes of q that keep quaternions on their sphere."""
        units = np.eye(len(self.v))[: self.mechanical]
        q, numeric = self.still.here.q, self.still.numeric
        rows = [numeric.coordinate_rates(q, list(unit)) for unit in units]
        return np.array([self.still.stacked(row)[0] for row in rows]).reshape(-1, len(self.q)).T

    @cached_property
    def moved(self) -> Reference:
        """A small imaginary step along each change, each velocity, each input."""
        n, m, k = len(self.q), len(self.v), len(self.u)
        steps = np.zeros((self.mechanical + m + k, n + m + k))
        steps[: self.mechanical, :n] = self.columns.T
        steps[self.mechanical :, n:] = np.eye(m + k)
        return self.at(1j * STEP * steps)

    def parts(self, of: Array) -> tuple[Array, Array, Array]:
        """Derivatives by changes of q, by v and by u, of what was evaluated on `moved`."""
        found = (np.imag(of) / STEP).T
        first, second = self.mechanical, self.mechanical + len(self.v)
        return found[:, :first], found[:, first:second], found[:, second:]

    def call(self, name: str, *, folded: bool = True, **more: Any) -> list[Array]:
        """What the program gives: every result as an array."""
        (program,) = PROGRAMS[name](Workspace(self.derivation, folded))
        given = {"t": self.t, "q": self.q, "v": self.v, "u": self.u, "loop": self.loop, **more}

        def number(symbol: tuple[str, Any]) -> float:
            argument, place = symbol
            return float(given[argument] if place is None else given[argument][place])

        value = Replay(Floats(), number)
        for check in program.checks:
            assert value(check.node) > (check.fraction or 1) * value(check.bound)
        return [np.array(value.all(x.entries), float).reshape(x.shape) for x in program.results]


def error(found: Array, expected: Array) -> float:
    assert found.shape == expected.shape
    return float(
        np.max(np.abs(found - expected), initial=0) / (1 + np.max(np.abs(expected), initial=0))
    )


def conditioned(mass: Array) -> float:
    """The condition number of M, scaled to a unit diagonal."""
    size = 1 / np.sqrt(np.abs(np.diag(mass)))
    return float(np.linalg.cond(mass * np.outer(size, size)))


def compare(point: Point, rng: np.random.Generator) -> None:
    a = rng.normal(size=len(point.v))
    tau = point.moved.inverse(np.tile(a, (len(point.moved.t), 1)))
    by_q, by_v, _ = point.parts(tau)
    found = point.call("inverse_dynamics_derivatives", a=a)
    mass = np.real(point.still.mass[0])
    for ours, theirs in zip(found, (by_q, by_v, mass), strict=True):
        assert error(ours, theirs) <= EXACT
    limit = EXACT * conditioned(mass)
    by_q, by_v, by_u = point.parts(point.moved.acceleration)
    expected = (by_q, by_v, by_u) if len(point.u) else (by_q, by_v)
    for ours, theirs in zip(point.call("forward_dynamics_derivatives"), expected, strict=True):
        assert error(ours, theirs) <= limit
    A, *B = point.call("linearize")
    assert error(A, np.vstack((above(point), np.hstack((by_q, by_v))))) <= limit
    if B:
        zeros = np.zeros((point.mechanical, len(point.u)))
        assert error(B[0], np.vstack((zeros, by_u))) <= limit


def above(point: Point) -> Array:
    """How a small change goes on: N d' = d/dq(N v) [N d] + N dv - d/dq(N d) [N v]."""
    first, count = point.mechanical, len(point.v)
    units = np.eye(count)[:first]

    def slopes(rates: Array, along: Array) -> Array:
        """The derivative of N(q) `rates` along N(q) `along`."""
        shift = np.zeros((1, len(point.q) + count + len(point.u)), complex)
        shift[0, : len(point.q)] = 1j * STEP * (point.columns @ along[:first])
        moved = point.at(shift)
        found = TreeState(moved.tree, moved.here.q, lanes(rates[None, :])).coordinate_rates
        return rate(moved.stacked(found)[0])

    drift = [slopes(point.v, d) - slopes(d, point.v) for d in units]
    own = np.linalg.lstsq(point.columns, np.array(drift).reshape(first, -1).T, rcond=None)[0]
    return np.hstack((own, np.eye(first), np.zeros((first, count - first))))


def random_point(seed: int) -> tuple[Point, np.random.Generator]:
    system = random_systems.random_system(seed)
    rng = np.random.default_rng([seed, 5])
    while True:
        state = random_systems.draw_state(rng, system)
        if random_systems.regular(system, state):
            break
    derivation = derive(system.model)
    names = [quantity.name for quantity in derivation.structure.inputs]
    count = len(system.effort_places)
    u = np.array([*rng.normal(size=count), *(state.u[name] for name in names[count:])])
    return Point(derivation, state.t, state.q, state.v, u), rng


@pytest.mark.seeds(range(0, 120, 16), range(120))
def test_random_mechanical_systems(seed: int) -> None:
    compare(*random_point(seed))


@pytest.mark.seeds(range(0, 80, 8), range(80))
def test_random_systems_with_networks(seed: int) -> None:
    case = case_of(seed, 1)
    r = case.reference
    compare(Point(r.derivation, float(r.t[0]), r.q[0], r.v[0], r.u[0]), case.rng)


PARAMETRIC = (
    "furuta",
    "cart_pole_motor",
    "double_pendulum",
    "magnetic_levitation",
    "elastic_pendulum",
)


@pytest.mark.parametrize("name", PARAMETRIC)
def test_by_parameters(name: str) -> None:
    """Every parameter in its own lane takes a small imaginary step."""
    model = lg.read(EXAMPLES / name / f"{name}.toml")
    derivation = derive(model)
    tree = derivation.structure
    names = [p.name for p in model.parameters.values() if not p.derived]
    rng = np.random.default_rng(4)
    q = rng.uniform(0.2, 1.0, len(tree.positions))
    v, u = rng.normal(size=len(tree.velocities)), rng.normal(size=len(tree.inputs))
    point = Point(derivation, 0.3, q, v, u)
    moved = point.at(np.zeros((len(names), len(q) + len(v) + len(u)), complex))

    def value(p: Any) -> Any:
        found = np.full(len(names), complex(p.value))
        if p.name in names:
            found[names.index(p.name)] += 1j * STEP
        return Lane(found)

    algebra: Any = moved.algebra
    values = valued(model.parameters.values(), algebra, value)
    moved.__dict__["numeric"] = Numeric(derivation.tree(algebra, values), derivation)
    a = rng.normal(size=len(v))
    expected = np.imag(moved.inverse(np.tile(a, (len(names), 1)))).T / STEP
    parameters = {p.name: float(p.value) for p in model.parameters.values()}
    given = {"a": a, "p": parameters, "folded": False}
    (found,) = point.call("inverse_dynamics_parameter_derivatives", **given)
    assert error(found, expected) <= EXACT
    (found,) = point.call("forward_dynamics_parameter_derivatives", **given)
    mass = np.real(point.still.mass[0])
    assert error(found, np.imag(moved.acceleration).T / STEP) <= EXACT * conditioned(mass)


@pytest.mark.parametrize("name", ["furuta", "cart_pole_motor", "gyroscope", "ship_arm"])
def test_emitted(name: str, tmp_path: Path) -> None:
    """C and Python say the same, for one state and for many, and d.function asks for them."""
    model = lg.read(EXAMPLES / name / f"{name}.toml")
    wanted = ("linearize", "inverse_dynamics_derivatives", "forward_dynamics_derivatives")
    files = render(model, folded=True, only=wanted)
    emitted, compiled = load(files, model.name, tmp_path), Compiled(files, model.name, tmp_path)
    rng = np.random.default_rng(5)
    sizes = {"q": emitted.NQ, "v": emitted.NV, "u": emitted.NU, "a": emitted.NV}
    many = {key: rng.uniform(0.1, 0.9, (3, size)) for key, size in sizes.items()}
    many["t"] = np.full(3, 0.2)
    for function in wanted:
        python = getattr(emitted, function)
        keys = list(inspect.signature(python).parameters)
        found = python(*(many[key] for key in keys))
        given = [float(many[key][1]) if key == "t" else many[key][1] for key in keys]
        single = python(*given)
        shapes = [x.shape for x in single]
        for one, whole, in_c in zip(
            single, found, compiled.call(function, *given, out=shapes), strict=True
        ):
            assert error(np.broadcast_to(whole, (3, *one.shape))[1], one) <= 1e-15
            assert error(in_c, one) <= 1e-13
    assert emitted.NDX == emitted.NT + emitted.NV
    ask = derive(model).function("linearize")
    A, _ = ask(many["q"][1], many["v"][1], many["u"][1]) if name == "furuta" else (None, None)
    assert name != "furuta" or A.shape == (emitted.NDX, emitted.NDX)


def test_long_loops_are_refused() -> None:
    """Diodes between resistors behind a source: voltages that only Newton finds."""
    model = lg.Model("ladder")
    model.input("u", "V")
    model.voltage_source("s", ("n0", "ground"), voltage="u")
    for k in range(5):
        model.resistor(f"R{k}", (f"n{k}", f"n{k + 1}"), resistance=1.0)
        model.diode(f"D{k}", (f"n{k + 1}", "ground"), saturation=1e-3, voltage=0.5)
    model.resistor("last", ("n5", "n6"), resistance=1.0)
    model.capacitor("C", ("n6", "ground"), capacitance=1.0)
    with pytest.raises(ModelError, match=r"algebraic loop of \d unknowns; derivatives"):
        render(model, only=("linearize",))


def test_what_has_no_derivatives_is_refused() -> None:
    model = lg.read(EXAMPLES / "four_bar" / "four_bar.toml")
    with pytest.raises(ModelError, match=r"it has constraints.*linearize gives them"):
        render(model, only=("forward_dynamics_derivatives",))
    with pytest.raises(ModelError, match=r"take no parameters.*keep them symbolic"):
        render(model, folded=True, functions=("inverse_dynamics_parameter_derivatives",))

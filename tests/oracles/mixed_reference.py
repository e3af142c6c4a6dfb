"""The numeric reference for many states at once, and for complex steps: linegraph's derivation over lanes.

A `Lane` holds one scalar at many states. It calculates with numbers and with lanes, and leaves to others, as
to jets, what it does not know. Complex lanes give derivatives: a step of 1e-30 along the motion, after which
the imaginary part is the rate, exact to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from linegraph import Model, derive
from linegraph.components.parameters import valued
from linegraph.dynamics import orthogonality
from linegraph.dynamics.applied_forces import efforts
from linegraph.dynamics.edge_variables import InverseScheme
from linegraph.dynamics.equations import StateEquations
from linegraph.numeric.reference import Numeric

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.derivation import Derivation

Array = Any
STEP = 1e-30
NUMBERS = (int, float, complex, Fraction, np.number)


class Lane:
    """One scalar at many states."""

    __slots__ = ("x",)
    __array_ufunc__ = None

    def __init__(self, x: Array) -> None:
        """An array, real or complex."""
        self.x = x

    def __neg__(self) -> Lane:
        return Lane(-self.x)

    def __add__(self, other: Any) -> Any:
        y = plain(other)
        return NotImplemented if y is None else Lane(self.x + y)

    def __radd__(self, other: Any) -> Any:
        y = plain(other)
        return NotImplemented if y is None else Lane(y + self.x)

    def __sub__(self, other: Any) -> Any:
        y = plain(other)
        return NotImplemented if y is None else Lane(self.x - y)

    def __rsub__(self, other: Any) -> Any:
        y = plain(other)
        return NotImplemented if y is None else Lane(y - self.x)

    def __mul__(self, other: Any) -> Any:
        y = plain(other)
        return NotImplemented if y is None else Lane(self.x * y)

    def __rmul__(self, other: Any) -> Any:
        y = plain(other)
        return NotImplemented if y is None else Lane(y * self.x)

    def __truediv__(self, other: Any) -> Any:
        y = plain(other)
        return NotImplemented if y is None else Lane(self.x / y)

    def __rtruediv__(self, other: Any) -> Any:
        y = plain(other)
        return NotImplemented if y is None else Lane(y / self.x)


def plain(x: Any) -> Any:
    """What lanes calculate with; None of anything else."""
    if isinstance(x, Lane):
        return x.x
    if isinstance(x, Fraction):
        return float(x)
    return x if isinstance(x, NUMBERS) else None


def _side(x: Array) -> Array:
    return np.sign(np.real(x))


def _atan2(y: Array, x: Array) -> Array:
    """Of complex steps, too: the slope times the step."""
    angle = np.arctan2(np.real(y), np.real(x))
    if not (np.iscomplexobj(y) or np.iscomplexobj(x)):
        return angle
    across = np.real(x) * np.imag(y) - np.real(y) * np.imag(x)
    return angle + 1j * across / (np.real(x) ** 2 + np.real(y) ** 2)


FUNCTIONS: dict[str, Callable[..., Array]] = {
    **{name: getattr(np, name) for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp")},
    **{"log": np.log, "sqrt": np.sqrt, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan},
    "atan2": _atan2,
    "abs": lambda x: x * _side(x),
    "sign": _side,
    "min": lambda x, y: np.where(np.real(x) < np.real(y), x, y),
    "max": lambda x, y: np.where(np.real(x) > np.real(y), x, y),
}


class Lanes:
    """The algebra of lanes."""

    def __init__(self, **arguments: Any) -> None:
        """Keep what `symbol` looks up."""
        self.arguments = arguments

    def symbol(self, argument: str, place: int | str | None = None) -> Any:
        """The lane given for this place."""
        given = self.arguments[argument]
        return given if place is None else given[place]

    def sin(self, x: Any) -> Any:
        """Sine."""
        return self.function("sin", x)

    def cos(self, x: Any) -> Any:
        """Cosine."""
        return self.function("cos", x)

    def sqrt(self, x: Any) -> Any:
        """Square root."""
        return self.function("sqrt", x)

    def function(self, name: str, *x: Any) -> Any:
        """Any function of linegraph's."""
        return Lane(FUNCTIONS[name](*map(plain, x)))


def lanes(columns: Array) -> list[Lane]:
    """The columns of an array, states a row."""
    return [Lane(column) for column in np.moveaxis(columns, -1, 0)]


@dataclass
class Reference:
    """A model at many states.

    Attributes:
        derivation: the model, derived.
        t, q, v, u: states a row; u in the order of the model's inputs.
        loop: the unknowns of the algebraic loop there.
    """

    derivation: Derivation
    t: Array
    q: Array
    v: Array
    u: Array
    loop: Array

    @classmethod
    def at(cls, derivation: Derivation, t: Array, q: Array, v: Array, u: Array) -> Reference:
        """The algebraic loop solved state by state, in floats."""
        network = derivation.formulation.network
        count = len(network.loop) if network else 0
        loop = np.zeros((len(t), count))
        for k in range(len(t) if count else 0):
            exchange = derivation.numeric(None, t[k], list(u[k])).exchange(list(q[k]), list(v[k]))
            assert exchange is not None
            loop[k] = exchange.solved
        return cls(derivation, t, q, v, u, loop)

    @property
    def model(self) -> Model:
        return self.derivation.system

    @cached_property
    def algebra(self) -> Lanes:
        return Lanes(t=Lane(self.t), u=lanes(self.u), loop=lanes(self.loop))

    @cached_property
    def numeric(self) -> Numeric:
        """The derivation over lanes."""
        parameters = self.model.parameters.values()
        algebra: Any = self.algebra
        values = valued(parameters, algebra, lambda p: float(p.value))
        return Numeric(self.derivation.tree(algebra, values), self.derivation)

    @property
    def tree(self) -> Any:
        return self.numeric.tree

    @property
    def first(self) -> int:
        """How many velocities are mechanical."""
        return int(self.tree.layout.mechanical)

    @cached_property
    def here(self) -> StateEquations:
        """The equations at the states."""
        return StateEquations(self.tree, lanes(self.q), lanes(self.v))

    def stacked(self, rows: Any) -> Array:
        """Scalars as an array, states first."""
        if isinstance(rows, (list, tuple)):
            parts = [self.stacked(row) for row in rows]
            return np.stack(parts, axis=1) if parts else np.zeros((len(self.t), 0))
        x = plain(rows)
        return np.broadcast_to(np.asarray(x), (len(self.t),))

    @cached_property
    def mass(self) -> Array:
        return self.stacked(self.here.mass_matrix)

    @cached_property
    def bias(self) -> Array:
        return self.stacked(self.here.bias)

    @cached_property
    def forces(self) -> Array:
        active = orthogonality.generalised_forces(self.here.state, self.here.active)
        return self.stacked(efforts(self.here.chords, active))

    @cached_property
    def rates(self) -> Array:
        """q̇."""
        return self.stacked(self.here.coordinate_rates)

    @cached_property
    def solution(self) -> tuple[Array, Array]:
        """v̇ and λ."""
        right = self.forces - self.bias
        if not self.tree.closed:
            return np.linalg.solve(self.mass, right[..., None])[..., 0], np.zeros((len(self.t), 0))
        J = self.stacked(self.here.jacobian)
        below = self.stacked(self.here.constraint_bias)
        n, m = J.shape[2], J.shape[1]
        whole = np.zeros((len(self.t), n + m, n + m))
        whole[:, :n, :n] = self.mass
        whole[:, n:, :n] = J
        whole[:, :n, n:] = -np.swapaxes(J, 1, 2)
        given = np.concatenate((right, below), axis=1)
        found = np.linalg.solve(whole, given[..., None])[..., 0]
        return found[:, :n], found[:, n:]

    @property
    def acceleration(self) -> Array:
        return self.solution[0]

    def inverse(self, a: Array) -> Array:
        """What a motion takes."""
        return self.stacked(self.here.inverse_dynamics(lanes(a)))

    @cached_property
    def scheme(self) -> InverseScheme:
        a, multipliers = self.solution
        return InverseScheme(self.here.chords, lanes(a), lanes(multipliers))

    @cached_property
    def network(self) -> dict[str, tuple[Array, Array]]:
        """X and Y of every edge in a scalar subspace."""
        found = self.scheme.network()
        return {name: (self.stacked(x), self.stacked(y)) for name, (x, y) in found.items()}

    @cached_property
    def energy(self) -> Array:
        """Kinetic energy, potential energy, and what networks store; a column each."""
        kinetic, potential = orthogonality.energy(self.here.state)
        stored = self.here.networks.energy() if self.here.networks else 0
        return self.stacked([kinetic, potential + self.here.passive.potential, stored])

    def kept(self, keys: Sequence[tuple[str, str]]) -> Array:
        """Across and through variables that need no rates, and components' own states; a column each."""
        exchange = self.here.networks
        assert exchange is not None
        network = exchange.network
        found = []
        for kind, edge in keys:
            if (kind, edge) in network.places:
                found.append(self.here.v[self.first + network.places[(kind, edge)]])
            else:
                found.append(exchange.across(edge) if kind == "X" else exchange.through(edge))
        return self.stacked(found)

    @cached_property
    def moved(self) -> Reference:
        """The same, a small imaginary step along the motion ahead."""
        names = [quantity.name for quantity in self.tree.inputs]
        given = dict(zip(names, self.u.T, strict=True))
        ahead = {"": "_rate", "_rate": "_acceleration"}
        rates = np.zeros_like(self.u)
        for k, name in enumerate(names):
            stem = name.removesuffix("_rate")
            rates[:, k] = given.get(f"{stem}{ahead[name[len(stem) :]]}", 0.0)
        return Reference(
            self.derivation,
            self.t + 1j * STEP,
            self.q + 1j * STEP * self.rates,
            self.v + 1j * STEP * self.acceleration,
            self.u + 1j * STEP * rates,
            self.loop + 0j,
        )


def rate(of: Array) -> Array:
    """The derivative along the motion, of what was evaluated on `moved`."""
    return np.imag(of) / STEP


def reference_of(
    model: Model, t: Array, q: Mapping[str, Array], v: Mapping[str, Array], u: Mapping[str, Array]
) -> Reference:
    """A model at states given by name."""
    derivation = derive(model)
    tree = derivation.structure
    count = len(t)

    def columns(quantities: Any, given: Mapping[str, Array]) -> Array:
        found = [given[quantity.name] for quantity in quantities]
        return np.stack(found, axis=1) if found else np.zeros((count, 0))

    return Reference.at(
        derivation,
        t,
        columns(tree.positions, q),
        columns(tree.velocities, v),
        columns(tree.inputs, u),
    )

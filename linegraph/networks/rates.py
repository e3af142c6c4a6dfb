"""Total time derivatives of a network's scalars, by the chain rule."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.algebra.residues import CONSTANT, Residues
from linegraph.errors import ModelError
from linegraph.networks.network import RATE, SHAFT_RATE
from linegraph.networks.static import DUAL, LOOP

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from linegraph.algebra.differentiation import Calculus, Symbol
    from linegraph.algebra.scalar import Scalar
    from linegraph.networks.network import State


class Rates:
    """The chain rule over a network's symbols.

    Args:
        who: the thing that errors name.
        calculus: derivatives over the network's DAG.
        states: whose rates are symbols.
        dependent: the stores that depend on others, for messages.

    Attributes:
        replaced: states that constraints have fixed, with their values.
        known: rates that static laws give; they are written as such so that 𝓜 stays symmetric.
    """

    def __init__(
        self, who: str, calculus: Calculus, states: Sequence[State], dependent: Iterable[str]
    ) -> None:
        """Start without replaced states."""
        self.who = who
        self.places = {state.key: k for k, state in enumerate(states)}
        self.replaced: dict[Symbol, Scalar] = {}
        self.known: dict[Symbol, Scalar] = {}
        self._calculus, self._dag = calculus, calculus.dag
        self._dependent = tuple(dependent)
        self._residues = Residues()

    def of(self, x: Scalar) -> Scalar:
        """The total derivative of a scalar, linear in the rates of states and the accelerations of ports."""
        total: Scalar = 0
        for symbol, slope in self._calculus.gradient(x).items():
            if self._residues(slope):
                total = total + slope * self._of(symbol)
        return total

    def _of(self, symbol: Symbol) -> Scalar:
        kind, place = symbol
        if symbol in self.replaced:
            return self.of(self.replaced[symbol])
        if symbol in self.known:
            return self.known[symbol]
        if symbol in self.places:
            return self._dag.symbol(RATE, self.places[symbol])
        if kind == "t":
            return 1
        if kind in ("p", CONSTANT):
            return 0
        follows = {"x": "w", "w": SHAFT_RATE, "u": "du", "du": "ddu"}
        if kind in follows:
            return self._dag.symbol(follows[kind], place)
        if kind == "name" and not str(place).startswith(("der(", "taken(")):
            return self._dag.symbol("name", f"der({place})")
        raise self.too_deep(kind, place)

    def too_deep(self, kind: str, place: object) -> ModelError:
        """The error for a derivative that is not known.

        Args:
            kind: the argument of the symbol to be differentiated.
            place: its place.
        """
        names = ", ".join(self._dependent) or "some stores"
        what = {
            "ddu": f"the third derivative of input {place}",
            LOOP: "the derivative of an algebraic loop",
            DUAL: f"the derivative of what flows in {place}, which itself depends on rates",
        }.get(kind, f"the derivative of {place}")
        problem = (
            f"the stores {names} depend on others in a way that needs {what}; put a small resistance or "
            "store between them"
        )
        return ModelError(self.who, problem)

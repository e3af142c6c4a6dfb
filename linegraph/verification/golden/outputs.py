"""Outputs that the model defines by name: its own expressions of coordinates and variables of edges.

The size of an expression is the sum over its names of slope times size.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linegraph.algebra.formula import variable_of
from linegraph.algebra.jets import Jet, Jets, lifted
from linegraph.components.forces import Element
from linegraph.components.parameters import names_in, resolver
from linegraph.dynamics.law_names import scope
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from linegraph.verification.golden.edges import Edges
    from linegraph.verification.golden.walk import Valued

Sized = tuple[float, float]
"""A number and its size: the magnitude of the terms that it is the sum of."""

OF_POINTS = {
    "position": ("origin", ""),
    "velocity": ("linear", "of_linear"),
    "acceleration": ("pull", "of_pull"),
    "angular_velocity": ("angular", "of_angular"),
    "angular_acceleration": ("spin", "of_spin"),
}
"""For each variable of a point the attributes of `GroundPlace` with its value and its size."""


@dataclass(frozen=True)
class Outputs:
    """The outputs of a model at a state.

    Attributes:
        edges: variables of all edges there.
    """

    edges: Edges

    @property
    def values(self) -> Valued:
        """One number for each output, in declared order, with sizes.

        Raises:
            ModelError: an expression has no value at this state; names the output.
        """
        cuts = self.edges.cuts
        pairs = []
        for output in cuts.model.outputs:
            try:
                pairs.append(self._value(output.value))
            except ModelError as error:
                raise ModelError(f'output "{output.name}"', error.problem) from None
        values, sizes = (cuts.walk.np.array([x[k] for x in pairs], float) for k in (0, 1))
        return values, sizes

    def _value(self, given: Any) -> Sized:
        """Value and size of an expression."""
        np, algebra = self.edges.cuts.walk.np, self.edges.cuts.walk.numeric.algebra
        names = sorted(names_in(given))
        known = {name: self._known(name) for name in names}
        units = np.eye(len(names))
        values = {name: Jet(x, units[k], 0.0) for k, (name, (x, _)) in enumerate(known.items())}
        found = lifted(resolver(Jets(algebra), values)(given))
        sizes = np.array([max(abs(x), size) for x, size in known.values()])
        slopes = np.abs(np.broadcast_to(np.asarray(found.dx, float), len(names)))
        return float(found.x), abs(float(found.x)) + float(slopes @ sizes)

    def _known(self, name: str) -> Sized:
        """Value and size of a name in an expression."""
        variable = variable_of(name)
        if variable is not None:
            return self._variable(*variable)
        cuts = self.edges.cuts
        walk, numeric = cuts.walk, cuts.walk.numeric
        chords = numeric.chords(walk.q, walk.v)
        values = scope(chords.state, chords)
        if name not in values:
            inputs = [quantity.name for quantity in walk.tree.inputs]
            return float(numeric.algebra.arguments["u"][inputs.index(name)]), 0.0
        return float(values[name]), float(walk.np.abs(walk.v).sum()) * name.startswith("der(")

    def _variable(self, kind: str, thing: str, part: str) -> Sized:
        """Value and size of a variable of an edge or a point."""
        cuts = self.edges.cuts
        if kind in OF_POINTS:
            place, (what, size) = cuts.place(thing), OF_POINTS[kind]
            vector = getattr(place, what)
            length = getattr(place, size) if size else float(cuts.walk.np.abs(vector).sum())
            return float(vector["xyz".index(part)]), float(length)
        exchange = cuts.acting.exchange
        if kind in ("across", "through"):
            elements = {e.name: e for e in cuts.model.elements if isinstance(e, Element)}
            if exchange is not None and thing in exchange.network.variables:
                at = exchange.across(thing) if kind == "across" else exchange.through(thing)
                return float(at), float(exchange.size(thing, int(kind == "through")))
            return self._tension(elements[thing], kind)
        both, of_force, of_torque = self.edges.reaction(thing)
        half = both[:3] if kind == "force" else both[3:]
        return float(half["xyz".index(part)]), of_force if kind == "force" else of_torque

    def _tension(self, element: Element, kind: str) -> Sized:
        """Length or coordinate of a force element, or its through variable, with its size."""
        cuts, np = self.edges.cuts, self.edges.cuts.walk.np
        if element.between is None:
            x, y = cuts.acting.in_joint(element)
            return (float(x), 0.0) if kind == "across" else (float(y), 0.0)
        tail, head = (cuts.place(end).origin for end in element.between)
        length = float(np.linalg.norm(head - tail))
        if kind == "across":
            return length, float(np.linalg.norm(head) + np.linalg.norm(tail))
        pull = -cuts.elements[element.name].force
        return float(pull @ (head - tail)) / length, float(np.linalg.norm(pull))

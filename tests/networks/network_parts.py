"""Small networks taken apart: edges, graphs and laws of a few components."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph import Model
from linegraph.components.scalar.branches import edges_of, projections
from linegraph.networks.laws import laws_of
from linegraph.networks.selection import Selection, select
from linegraph.networks.static import Solver, Statics

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.components.scalar.base import Component
    from linegraph.components.scalar.branches import Branch
    from linegraph.graph.multigraph import Projection
    from linegraph.networks.law_records import Laws


class Parts(NamedTuple):
    """The edges, the graph of each subspace and the terminal equations."""

    branches: list[Branch]
    graphs: tuple[Projection, ...]
    laws: Laws

    def selection(self, *wanted: str) -> Selection:
        """The chosen states and trees."""
        return select(self.branches, self.graphs, self.laws, wanted)

    def statics(self, *wanted: str) -> Statics:
        """The solution of the static laws."""
        return Solver(self.branches, self.laws, self.selection(*wanted)).solve()


def system(
    *components: Component, parameters: Sequence[str] = (), inputs: Sequence[str] = ()
) -> Any:
    """A system of these components."""
    found = Model("small")
    for name in parameters:
        found.parameter(name, 1.0)
    for name in inputs:
        found.input(name)
    for component in components:
        found.add_component(component)
    return found


def parts(
    *components: Component, parameters: Sequence[str] = (), inputs: Sequence[str] = ()
) -> Parts:
    """A network of these components, taken apart."""
    branches = edges_of(components)
    graphs = projections(branches)
    made = system(*components, parameters=parameters, inputs=inputs)
    return Parts(branches, graphs, laws_of(made, branches, graphs))

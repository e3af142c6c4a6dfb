"""Snapshots of a builder as frozen systems."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.model.system import System, frozen, settled
from linegraph.model.terminal_graphs import system_graph, terminals_of

if TYPE_CHECKING:
    from linegraph.components.forces import Element, PointForce
    from linegraph.graph.multigraph import SystemGraph
    from linegraph.model.choices import Choices
    from linegraph.spatial.placement import Placement


class Snapshots:
    """A builder of which snapshots can be taken; its attributes are those of `System`."""

    name: str
    about: str
    snap: float
    gravity: Any
    bodies: Any
    ground_frames: Any
    joints: Any
    couplings: Any
    force_elements: Any
    constraints: Any
    relations: Any
    components: Any
    domains: Any
    parameters: Any
    inputs: Any
    outputs: Any
    choices: Choices
    bounds: Any
    warnings: list[str]
    source: str | None
    places: dict[str, int]

    def system(self) -> System:
        """A frozen system of all declared so far; later changes of the builder do not affect it."""
        return System(
            name=self.name,
            gravity=settled(self.gravity),
            about=self.about,
            snap=self.snap,
            bodies=frozen(self.bodies),
            ground_frames=frozen(self.ground_frames),
            joints=settled(self.joints),
            couplings=settled(self.couplings),
            force_elements=settled(self.force_elements),
            constraints=settled(self.constraints),
            relations=settled(self.relations),
            components=settled(self.components),
            domains=frozen(self.domains),
            parameters=frozen(self.parameters),
            inputs=settled(self.inputs),
            outputs=settled(tuple(self.outputs)),
            choices=settled(self.choices),
            bounds=settled(self.bounds),
            warnings=tuple(self.warnings),
            source=self.source,
            places=frozen(self.places),
        )

    @property
    def elements(self) -> tuple[Element | PointForce, ...]:
        """Force elements and loads, and the forces that edges of networks exert on the mechanics."""
        return self.system().elements

    @property
    def depends_on_time(self) -> bool:
        """Whether a prescribed motion or a law names the time t."""
        return self.system().depends_on_time

    def terminals(self) -> dict[str, tuple[str, Placement]]:
        """Every terminal to which a joint may be connected, with its body and its placement there."""
        return terminals_of(self.system())

    def graph(self) -> SystemGraph:
        """The system graph: the union of all terminal graphs.

        Raises:
            ModelError: a component names a terminal that does not exist, or connects a body to itself.
        """
        return system_graph(self.system())

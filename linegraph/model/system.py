"""The frozen system: what a builder held when the snapshot was taken."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, is_dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar

from linegraph.components.parameters import names_in
from linegraph.components.scalar.forces import forces_of
from linegraph.display import Displayed
from linegraph.errors import ModelError, SourceError
from linegraph.model.bounds import Bounds
from linegraph.model.choices import Choices
from linegraph.spatial.vector import ZERO, Vector

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.components.body import Body
    from linegraph.components.constraints import Constraint
    from linegraph.components.constraints.relation import Relation
    from linegraph.components.domains import Domain
    from linegraph.components.forces import Element, PointForce
    from linegraph.components.joints import Joint
    from linegraph.components.parameters import Input, Parameter
    from linegraph.components.scalar.base import Component
    from linegraph.model.coupling import Coupling
    from linegraph.model.outputs import Output
    from linegraph.spatial.placement import Placement

Value = TypeVar("Value")


def _nothing() -> Any:
    return field(default_factory=lambda: MappingProxyType({}))


@dataclass(frozen=True, repr=False)
class System(Displayed):
    """A system of components, connected at terminals: an immutable snapshot of a builder.

    Attributes:
        name: the prefix of everything emitted.
        gravity: acceleration of free fall in ground axes (m/s²).
        about: one paragraph for the head of emitted files.
        snap: rotation entries closer than this to 0, 1, -1, 1/2 or -1/2 become these exactly.
        bodies: the rigid bodies by name.
        ground_frames: named frames of ground.
        joints: in declared order, the order of coordinates.
        couplings: joints that follow others.
        force_elements: force elements and loads in declared order.
        constraints: constraints with edges in declared order.
        relations: constraints between velocities in declared order.
        components: the components of scalar networks in declared order.
        domains: power subspaces that the user declares, by name.
        parameters, inputs: named numbers, and inputs of laws.
        outputs: quantities that emitted code returns by name.
        choices: the user's choices of the formulation.
        bounds: intervals within which `check` and golden vectors evaluate the equations.
        warnings: messages of the reader.
        source: the file that the system was read from, if any.
        places: the lines of that file by the things that they declare.
    """

    name: str
    gravity: Vector = ZERO
    about: str = ""
    snap: float = 0.0
    bodies: Mapping[str, Body] = _nothing()
    ground_frames: Mapping[str, Placement] = _nothing()
    joints: tuple[Joint, ...] = ()
    couplings: tuple[Coupling, ...] = ()
    force_elements: tuple[Element | PointForce, ...] = ()
    constraints: tuple[Constraint, ...] = ()
    relations: tuple[Relation, ...] = ()
    components: tuple[Component, ...] = ()
    domains: Mapping[str, Domain] = _nothing()
    parameters: Mapping[str, Parameter] = _nothing()
    inputs: tuple[Input, ...] = ()
    outputs: tuple[Output, ...] = ()
    choices: Choices = field(default_factory=Choices)
    bounds: Bounds = field(default_factory=Bounds)
    warnings: tuple[str, ...] = ()
    source: str | None = None
    places: Mapping[str, int] = _nothing()

    def __repr__(self) -> str:
        """The name, with the numbers of bodies and joints."""
        return f"<System {self.name}: {len(self.bodies)} bodies, {len(self.joints)} joints>"

    def system(self) -> System:
        """The system itself, so that functions may take a builder or a system."""
        return self

    @property
    def elements(self) -> tuple[Element | PointForce, ...]:
        """Force elements and loads, and the forces that edges of networks exert on the mechanics."""
        return (*self.force_elements, *forces_of(self.components))

    @property
    def depends_on_time(self) -> bool:
        """Whether a prescribed motion or a law names the time t."""
        values = [value for joint in self.joints for value in joint.prescribed_values()]
        acting = (*self.force_elements, *self.constraints, *self.relations, *self.components)
        values += [output.value for output in self.outputs]
        values += [value for component in acting for value in component.values()]
        return any("t" in names_in(value) for value in values)


def variant(system: System, **choices: Any) -> System:
    """The same system with other choices of the formulation.

    Args:
        system: its own choices are dropped.
        **choices: attributes of `Choices`; those that are not given have their defaults.
    """
    return replace(system, choices=replace(Choices(), **choices))


def placed(error: ModelError, system: System) -> ModelError:
    """An error with its line in the file that the system was read from.

    Args:
        error: names the thing at fault.
        system: knows the lines of things; without a file the error is returned unchanged.
    """
    if system.source is None:
        return error
    return SourceError(system.source, system.places.get(error.thing), error.thing, error.problem)


def settled(value: Value) -> Value:
    """A value that shares nothing mutable with the caller's.

    Lists, dictionaries and arrays are copied, also within tuples and dataclasses; numbers, texts and SymPy
    expressions are immutable.
    """
    copied: Any = value
    if isinstance(value, (list, tuple)):
        copied = _sequence(value)
    elif isinstance(value, dict):
        copied = {key: settled(item) for key, item in value.items()}
    elif is_dataclass(value) and not isinstance(value, type):
        given: Any = value
        parts = {f.name: getattr(given, f.name) for f in fields(given) if f.init}
        changed = {k: new for k, x in parts.items() if (new := settled(x)) is not x}
        copied = replace(given, **changed) if changed else given
    elif hasattr(value, "__array__") and hasattr(value, "copy"):
        copied = value.copy()
    return copied  # type: ignore[no-any-return]


def _sequence(value: Any) -> Any:
    """A list as a copy, a tuple as it is if none of its items had to be copied."""
    items = [settled(item) for item in value]
    if isinstance(value, list):
        return items
    if all(new is old for new, old in zip(items, value, strict=True)):
        return value
    return type(value)(*items) if hasattr(value, "_fields") else tuple(items)


def frozen(mapping: Mapping[str, Value]) -> Mapping[str, Value]:
    """An immutable copy of a mapping."""
    return MappingProxyType({name: settled(value) for name, value in mapping.items()})

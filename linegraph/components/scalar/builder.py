"""What the builder does with components and domains, whatever their words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.components.domains import Domain, declared
from linegraph.components.validation import finite, require_new

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.components.scalar.base import Component


class Networks:
    """The networks of a model under construction.

    Attributes:
        domains: power subspaces of the model's own, by name.
    """

    _components: dict[str, Component]
    domains: dict[str, Domain]

    @property
    def _edges(self) -> Mapping[str, Any]:
        """By their names all things that have edges, but bodies."""
        raise NotImplementedError

    def domain(
        self, name: str, across: Mapping[str, str], through: Mapping[str, str], power: bool = True
    ) -> Domain:
        """Declare a power subspace; each variable is ``{"name": ..., "unit": ..., "letter": ...}``.

        Raises:
            ModelError: the name is taken, or the units do not make a power.
        """
        self.domains[name] = declared(name, across, through, power, self.domains)
        return self.domains[name]

    @property
    def components(self) -> tuple[Component, ...]:
        """The components of scalar networks in declared order."""
        return tuple(self._components.values())

    def add_component(self, component: Component) -> Component:
        """Add a component made elsewhere; ``model.resistor(...)`` and its siblings are friendlier.

        Raises:
            ModelError: the name is taken, or something is missing.
        """
        who = f'{component.kind} "{component.name}"'
        taken = "the name is taken; joints, elements and components share names"
        require_new(component.name, self._edges, who, taken)
        component.require_fields()
        finite(component.values(), who)
        return self._components.setdefault(component.name, component)

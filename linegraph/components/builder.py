"""What the builder does with components and domains, whatever their words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.checks import finite
from linegraph.domains import Domain, declared
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.components.base import Component


class Networks:
    """The networks of a model under construction.

    Attributes:
        domains: power subspaces of the model's own, by name.
    """

    _components: dict[str, Component]
    domains: dict[str, Domain]

    def _taken(self, name: str) -> bool:
        """Whether something that is no component has a name."""
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
        if component.name in self._components or self._taken(component.name):
            raise ModelError(who, "the name is taken; joints, elements and components share names")
        component.require_fields()
        finite(component.values(), who)
        return self._components.setdefault(component.name, component)

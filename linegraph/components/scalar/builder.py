"""The builder's part for components and domains, whatever their types."""

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
        """All things that have edges, but bodies, by their names."""
        raise NotImplementedError

    def domain(
        self, name: str, across: Mapping[str, str], through: Mapping[str, str], power: bool = True
    ) -> Domain:
        """Declare a power subspace; each variable is ``{"name": ..., "unit": ..., "letter": ...}``.

        Args:
            name: of the subspace, unlike all others.
            across: the variable measured between the ends of an edge.
            through: the variable that flows along an edge.
            power: whether their product is a power (W); their units must agree with that.

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

        Args:
            component: its name must be unlike those of joints, force elements and other components.

        Returns:
            The component.

        Raises:
            ModelError: the name is taken, something is missing, or a number is not finite.
        """
        who = f'{component.kind} "{component.name}"'
        taken = "the name is taken; joints, elements and components share names"
        require_new(component.name, self._edges, who, taken)
        component.require_fields()
        finite(component.values(), who)
        return self._components.setdefault(component.name, component)

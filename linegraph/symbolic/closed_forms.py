"""All closed forms of a derivation: its equations, and the linear systems that follow from them."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from linegraph.symbolic.equation_forms import EquationForms
from linegraph.symbolic.linear_systems import linearise, state_space_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from linegraph.symbolic.state_space import StateSpace


class ClosedForms(EquationForms):
    """The equations of a derivation as SymPy expressions, with their linearisations."""

    @cached_property
    def state_space(self) -> StateSpace:
        """A, B, C, D of a linear system, in letters.

        Raises:
            ModelError: the system is not linear.
        """
        return state_space_of(self)

    def linearise(self, at: Mapping[Any, Any] | None = None) -> StateSpace:
        """A, B, C, D for small deviations from a steady motion; see `Derivation.linearise`."""
        return linearise(self, at or {})

    linearize = linearise

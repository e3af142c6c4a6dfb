"""The inverse scheme of a model at a state, over floats."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from support.chains import walked

from linegraph.dynamics.chords import Chords
from linegraph.dynamics.edge_variables import InverseScheme
from linegraph.kinematics.tree_state import TreeState

if TYPE_CHECKING:
    from collections.abc import Sequence

    import linegraph as lg


def scheme(
    model: lg.Model,
    q: Any,
    v: Any,
    a: Any = None,
    multipliers: Sequence[float] = (),
    **arguments: Any,
) -> InverseScheme:
    """The scheme at a state; `arguments` are the time t and the inputs u."""
    state = TreeState(walked(model, **arguments), map(float, q), map(float, v))
    return InverseScheme(Chords(state), a, multipliers)

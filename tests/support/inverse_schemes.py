"""The inverse scheme of a model at a state, over floats."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.algebra.protocol import Floats
from linegraph.dynamics.chords import Chords, equations
from linegraph.dynamics.edge_variables import InverseScheme
from linegraph.formulation.formulate import formulate
from linegraph.kinematics.arms import arms
from linegraph.kinematics.formulated import Formulated
from linegraph.model.terminal_graphs import system_graph

if TYPE_CHECKING:
    from collections.abc import Sequence

    import linegraph as lg
    from linegraph.kinematics.links import KinematicTree
    from linegraph.model.system import System


class Scheme(NamedTuple):
    """The scheme, and what it was made of."""

    inverse: InverseScheme
    system: System
    tree: KinematicTree
    floats: Floats
    chords: Chords
    state: tuple[tuple[float, ...], tuple[float, ...]]


def scheme(
    model: lg.Model,
    q: Any,
    v: Any,
    a: Any = None,
    multipliers: Sequence[float] = (),
    **arguments: Any,
) -> Scheme:
    """The scheme at a state; `arguments` are the time t and the inputs u."""
    system = model.system()
    graph = system_graph(system)
    formulated = Formulated(system, graph, formulate(system, graph))
    floats = Floats(**arguments)
    tree = formulated.tree(floats, {})
    state = tuple(map(float, q)), tuple(map(float, v))
    crossed = arms(tree, floats, *state)
    chords = Chords(tree, floats, crossed, {})
    known = list(zip(equations(tree), multipliers, strict=True)) if len(multipliers) else []
    inverse = InverseScheme(
        formulated, tree, floats, {}, crossed, chords, state, None if a is None else tuple(a), known
    )
    return Scheme(inverse, system, tree, floats, chords, state)

"""From a system to equations: the pipeline, stage by stage.

    Model ──system()──→ System ──system_graph──→ SystemGraph ──formulate──→ Formulation
          ──kinematic_tree──→ KinematicTree ──orthogonality, chords──→ M, h, J, ... over any algebra
          ──programs──→ Module ──codegen.render──→ files

Each arrow is one pure function.
"""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, TypeVar

from linegraph.dynamics.law_names import require_linear
from linegraph.dynamics.potentials import require_energies
from linegraph.dynamics.regularity import require_motion
from linegraph.errors import ModelError
from linegraph.formulation.formulate import formulate
from linegraph.model.name_register import declared, require_distinct, require_own
from linegraph.model.system import placed
from linegraph.model.terminal_graphs import system_graph
from linegraph.numeric.derived import Derived

if TYPE_CHECKING:
    from linegraph.model.builder import Model
    from linegraph.model.system import System


Kind = TypeVar("Kind", bound=Derived)


def derived(model: Model | System, kind: type[Kind]) -> Kind:
    """Unite the terminal graphs, choose the trees, and check that equations of motion exist.

    Args:
        model: a builder, of which a snapshot is taken, or a system.
        kind: the type of the result: `Derived`, or the `Derivation` that users see.

    Raises:
        ModelError: the model cannot be derived; the message names the component.
    """
    system = model.system()
    try:
        graph = system_graph(system)
        owners = require_distinct(declared(system), system.places)
        require_own(system, owners, system.places)
        found = kind(system, graph, formulate(system, graph))
        require_motion(found.structure)
        _ = found.symbol_names
        if found.structure.closed and found.valued:
            _require_relations(found)
        _ = found.idle
        require_energies(system)
    except ModelError as error:
        raise placed(error, system) from None
    return found


def _require_relations(found: Derived) -> None:
    """Refuse relations that are not constraints of velocity."""
    if found.system.relations:
        numeric = found.numeric(t=found.system.bounds.sometime)
        require_linear(numeric.tree, random.Random(0))

"""linegraph: equations of motion from linear (terminal) graphs, derived symbolically, emitted as code.

Public names are imported when they are first used. The command line therefore starts quickly, and an
interrupt during imports ends it without a traceback.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from linegraph.version import __version__

if TYPE_CHECKING:
    from linegraph.components.parameters import Input, Parameter
    from linegraph.derivation import Derivation, derive
    from linegraph.drawing.scene import Scene
    from linegraph.emission.emit import emit
    from linegraph.errors import LinegraphError, ModelError, NameRefused, SourceError
    from linegraph.evaluation import Function
    from linegraph.identification.base_parameters import BaseParameters
    from linegraph.model.builder import Model
    from linegraph.model.system import System
    from linegraph.notation import init_printing
    from linegraph.numeric.assembly import Assembly
    from linegraph.programs.tree_costs import trees
    from linegraph.readers.read import read
    from linegraph.symbolic.closed_forms import ClosedForms
    from linegraph.symbolic.equation_list import Equations
    from linegraph.symbolic.simplify import simplify
    from linegraph.symbolic.state_space import StateSpace
    from linegraph.verification.checking.run import check

_MODULES = {
    "Assembly": "numeric.assembly",
    "BaseParameters": "identification.base_parameters",
    "ClosedForms": "symbolic.closed_forms",
    "Derivation": "derivation",
    "Equations": "symbolic.equation_list",
    "Function": "evaluation",
    "Input": "components.parameters",
    "LinegraphError": "errors",
    "Model": "model.builder",
    "ModelError": "errors",
    "NameRefused": "errors",
    "Parameter": "components.parameters",
    "Scene": "drawing.scene",
    "SourceError": "errors",
    "StateSpace": "symbolic.state_space",
    "System": "model.system",
    "check": "verification.checking.run",
    "derive": "derivation",
    "emit": "emission.emit",
    "init_printing": "notation",
    "read": "readers.read",
    "simplify": "symbolic.simplify",
    "trees": "programs.tree_costs",
}
"""Module of each public name."""


def __getattr__(name: str) -> Any:
    if name not in _MODULES:
        raise AttributeError(f"module 'linegraph' has no attribute '{name}'", name=name)
    value = getattr(import_module(f"linegraph.{_MODULES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*__all__, "__doc__", "__file__", "__name__", "__path__"])


__all__ = [
    "Assembly",
    "BaseParameters",
    "ClosedForms",
    "Derivation",
    "Equations",
    "Function",
    "Input",
    "LinegraphError",
    "Model",
    "ModelError",
    "NameRefused",
    "Parameter",
    "Scene",
    "SourceError",
    "StateSpace",
    "System",
    "__version__",
    "check",
    "derive",
    "emit",
    "init_printing",
    "read",
    "simplify",
    "trees",
]

"""linegraph: equations of motion from linear (terminal) graphs, derived symbolically, emitted as code.

What is exported here is imported when it is first used: the command line starts at once, and an interrupt
while it imports ends it without a traceback.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from linegraph.version import __version__

if TYPE_CHECKING:
    from linegraph.components.parameters import Parameter
    from linegraph.derivation import Derivation, derive
    from linegraph.emission.emit import emit
    from linegraph.errors import LinegraphError, ModelError, NameRefused, SourceError
    from linegraph.model.builder import Model
    from linegraph.notation import init_printing
    from linegraph.readers.read import read
    from linegraph.symbolic.simplify import simplify

_MODULES = {
    "Derivation": "derivation",
    "LinegraphError": "errors",
    "Model": "model.builder",
    "ModelError": "errors",
    "NameRefused": "errors",
    "Parameter": "components.parameters",
    "SourceError": "errors",
    "derive": "derivation",
    "emit": "emission.emit",
    "init_printing": "notation",
    "read": "readers.read",
    "simplify": "symbolic.simplify",
}
"""The module of each name that is exported."""


def __getattr__(name: str) -> Any:
    if name not in _MODULES:
        raise AttributeError(f"module 'linegraph' has no attribute '{name}'", name=name)
    value = getattr(import_module(f"linegraph.{_MODULES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*__all__, "__doc__", "__file__", "__name__", "__path__"])


__all__ = [
    "Derivation",
    "LinegraphError",
    "Model",
    "ModelError",
    "NameRefused",
    "Parameter",
    "SourceError",
    "__version__",
    "derive",
    "emit",
    "init_printing",
    "read",
    "simplify",
]

"""linegraph: equations of motion from linear (terminal) graphs, derived symbolically, emitted as code.

What is exported here is imported when it is first used: the command line starts at once, and an interrupt
while it imports ends it without a traceback.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from linegraph.version import __version__

if TYPE_CHECKING:
    from linegraph.derive import Derivation, derive
    from linegraph.emission import emit
    from linegraph.errors import LinegraphError, ModelError, NameRefused, SourceError
    from linegraph.model import Model
    from linegraph.notation import init_printing
    from linegraph.parameters import Parameter
    from linegraph.reading import read
    from linegraph.tidy import simplify

_MODULES = {
    "Derivation": "derive",
    "LinegraphError": "errors",
    "Model": "model",
    "ModelError": "errors",
    "NameRefused": "errors",
    "Parameter": "parameters",
    "SourceError": "errors",
    "derive": "derive",
    "emit": "emission",
    "init_printing": "notation",
    "read": "reading",
    "simplify": "tidy",
}
"""The module of each name that is exported."""


class _Package(ModuleType):
    """The package, whose attribute `derive` is the function, not the module that has the same name."""

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in _MODULES or not isinstance(value, ModuleType):
            super().__setattr__(name, value)

    def __getattr__(self, name: str) -> Any:
        if name in _MODULES:
            value = getattr(import_module(f"linegraph.{_MODULES[name]}"), name)
            setattr(self, name, value)
            return value
        if not name.startswith("_"):
            try:
                return import_module(f"linegraph.{name}")
            except ModuleNotFoundError as error:
                if error.name != f"linegraph.{name}":
                    raise
        raise AttributeError(f"module 'linegraph' has no attribute '{name}'", name=name, obj=self)

    def __dir__(self) -> list[str]:
        return sorted([*__all__, "__doc__", "__file__", "__name__", "__path__"])


sys.modules[__name__].__class__ = _Package

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

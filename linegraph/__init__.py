"""linegraph: equations of motion from linear (terminal) graphs, derived symbolically, emitted as code."""

from linegraph.derive import Derivation, derive
from linegraph.errors import LinegraphError, ModelError, NameRefused, SourceError
from linegraph.model import Model
from linegraph.parameters import Parameter

__version__ = "0.1.0"

__all__ = [
    "Derivation",
    "LinegraphError",
    "Model",
    "ModelError",
    "NameRefused",
    "Parameter",
    "SourceError",
    "derive",
]

"""linegraph: equations of motion from linear (terminal) graphs, derived symbolically, emitted as code."""

from linegraph.derive import Derivation, derive
from linegraph.emission import emit
from linegraph.errors import LinegraphError, ModelError, NameRefused, SourceError
from linegraph.model import Model
from linegraph.notation import init_printing
from linegraph.parameters import Parameter
from linegraph.reading import read
from linegraph.tidy import simplify
from linegraph.version import __version__

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

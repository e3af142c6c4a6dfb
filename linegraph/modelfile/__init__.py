"""Model files: a terminal graph written down in TOML or JSON becomes a `Model`."""

from linegraph.modelfile.importer import parse, read
from linegraph.modelfile.schema import schema
from linegraph.modelfile.starter import starter

__all__ = ["parse", "read", "schema", "starter"]

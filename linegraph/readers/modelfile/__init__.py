"""Model files: a terminal graph in TOML or JSON becomes a `Model`."""

from linegraph.readers.modelfile.importer import parse, read
from linegraph.readers.modelfile.schema import schema
from linegraph.readers.modelfile.starter import starter

__all__ = ["parse", "read", "schema", "starter"]

"""URDF robot descriptions as models.

    path ──document──→ Element ──links, joints──→ Link, Joint ──structure──→ Tree ──building──→ Model

Only `document` handles files and XML, only `structure` builds the tree, and only `building` uses `Model`.
All stages between are frozen data with line numbers.
"""

from linegraph.readers.urdf.importer import parse, read

__all__ = ["parse", "read"]

"""URDF robot descriptions as models.

    path ──document──→ Element ──links, joints──→ Link, Joint ──structure──→ Tree ──building──→ Model

`document` is the only part that touches files and XML; `structure` the only one that knows what a tree
is; `building` the only one that knows `Model`. Everything in between is frozen data with its line.
"""

from linegraph.readers.urdf.importer import parse, read

__all__ = ["parse", "read"]

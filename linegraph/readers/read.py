"""A model from a file, whatever its kind."""

from __future__ import annotations

import os

from linegraph.errors import LinegraphError
from linegraph.model.builder import SNAP, Model


def read(
    path: str | os.PathLike[str],
    *,
    base: str = "fixed",
    symbolic: bool = False,
    snap: float = SNAP,
) -> Model:
    """Read a model file (.toml or .json) or a URDF.

    Args:
        path: the file.
        base: of a URDF, whether its root is ``fixed`` or ``floating``.
        symbolic: of a URDF, whether masses, moments and offsets become parameters.
        snap: how close entries of rotations are to 0, 1/2 or 1 to be these.

    Raises:
        SourceError: something in the file is wrong; the message names the place.
        LinegraphError: the file cannot be read, or a model file is to float.
    """
    source = os.fspath(path)
    if is_urdf(source):
        from linegraph.readers import urdf

        return urdf.read(source, base=base, symbolic=symbolic, snap=snap)
    from linegraph.readers import modelfile

    if base == "floating":
        raise LinegraphError(
            "--base floating is for a URDF; in a model file connect the base to ground with a free "
            'joint: [free.root] between = ["ground", "BODY"]'
        )
    return modelfile.read(source, snap=snap)


def is_urdf(source: str) -> bool:
    """By the name; where that does not tell, by what the file begins with."""
    ending = source.lower().rpartition(".")[2]
    if ending in ("toml", "json"):
        return False
    if ending in ("urdf", "xml", "xacro"):
        return True
    from linegraph.readers.modelfile.document import read_bytes

    start = read_bytes(source)[:1000].removeprefix(b"\xef\xbb\xbf").lstrip()
    return start.startswith(b"<")

"""Reading a model from a file of any kind."""

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
        base: ``fixed`` or ``floating``: how the root of a URDF is connected to ground.
        symbolic: whether masses, moments and offsets of a URDF become parameters.
        snap: entries of rotation matrices this close to 0, 1 or 1/2 become these exactly.

    Returns:
        The model; warnings about the file are in its `warnings`.

    Raises:
        SourceError: the file is wrong; the message names the line.
        LinegraphError: the file cannot be read, or a floating base was requested for a model file.
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
    """Whether a file is a URDF: by its ending, else by its first character."""
    ending = source.lower().rpartition(".")[2]
    if ending in ("toml", "json"):
        return False
    if ending in ("urdf", "xml", "xacro"):
        return True
    from linegraph.readers.modelfile.document import read_bytes

    start = read_bytes(source)[:1000].removeprefix(b"\xef\xbb\xbf").lstrip()
    return start.startswith(b"<")

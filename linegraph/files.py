"""Writing a set of files so that either all of them appear or none."""

from __future__ import annotations

import contextlib
import errno
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from linegraph.errors import LinegraphError

if TYPE_CHECKING:
    from collections.abc import Mapping


STAGED = ".linegraph-"
"""How the names begin that files have before they have their own."""


def write_all(folder: str | os.PathLike[str], files: Mapping[str, str | bytes]) -> list[Path]:
    """Write files under their names, or paths below the folder, replacing what stood there.

    Texts are written in UTF-8 with LF line ends.

    Everything is first written beside its place under another name and moved there last, so that an
    interrupted run leaves no half file under a final name.

    Raises:
        LinegraphError: the folder cannot be made or written to.
    """
    target = Path(folder)
    staged: list[tuple[str, Path]] = []
    try:
        target.mkdir(parents=True, exist_ok=True)
        for name, content in files.items():
            staged.append((_stage(target, content), target / name))
        for _, final in staged:
            final.parent.mkdir(parents=True, exist_ok=True)
            if final.is_dir():
                raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(final))
        for temporary, final in staged:
            os.replace(temporary, final)
    except OSError as error:
        for temporary, _ in staged:
            with contextlib.suppress(OSError):
                os.unlink(temporary)
        reason = error.strerror or str(error)
        place = os.fspath(folder)
        if error.filename and not Path(error.filename).name.startswith(STAGED):
            place = str(error.filename)
        raise LinegraphError(f"cannot write to {place}: {reason}") from None
    return [final for _, final in staged]


def _stage(folder: Path, content: str | bytes) -> str:
    """Write to a new file in the folder, with the permissions of an ordinary one."""
    handle, temporary = tempfile.mkstemp(prefix=STAGED, dir=folder)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content.encode("utf-8") if isinstance(content, str) else content)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, 0o666 & ~mask)
    except OSError:
        os.unlink(temporary)
        raise
    return temporary

"""Writing files so that either all of them appear or none; and into what is no file.

A regular file is replaced whole: an interrupted run leaves the old one. A device, a pipe or a socket is
written into, never replaced.
"""

from __future__ import annotations

import contextlib
import errno
import os
import re
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from linegraph.errors import DeviceFailed, LinegraphError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


STAGED = ".linegraph-"
"""How the names begin that files have before they have their own."""

DESCRIPTOR = re.compile(r"/dev/(stdin|stdout|stderr)|(?:/dev/fd|/proc/self/fd)/(\d+)")
"""Names of what this process has open already."""

STANDARD = {"stdin": 0, "stdout": 1, "stderr": 2}

OF_DEVICES = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.ENXIO, errno.EPIPE)
"""Errors that the name is not to blame for: a full disk, a device that fails, a reader that left."""


def is_stream(path: str | os.PathLike[str]) -> bool:
    """Whether a path is a device, a pipe or the like: what is written goes into it and replaces nothing."""
    place = Path(path)
    if DESCRIPTOR.fullmatch(os.fspath(path)):
        return True
    try:
        return place.exists() and not (place.is_file() or place.is_dir())
    except OSError:
        return False


def write_file(path: str | os.PathLike[str], content: str | bytes) -> Path:
    """Write one file, whole or not at all; into what is no regular file, as it is.

    Raises:
        LinegraphError: it cannot be written; `DeviceFailed` if the name is not to blame.
    """
    target = Path(path)
    if is_stream(path):
        with _explained(target):
            _pour(os.fspath(path), _bytes(content))
        return target
    if target.is_dir() or not target.name:
        raise LinegraphError(f"cannot write to {path}: it is a folder")
    return write_all(target.parent, {target.name: content})[0]


def write_new(path: str | os.PathLike[str], content: str) -> None:
    """Write a file that must not be there yet; into what is no regular file, as it is.

    Raises:
        FileExistsError: it is there.
        OSError: it cannot be written; nothing is left of it.
    """
    if is_stream(path):
        _pour(os.fspath(path), _bytes(content))
        return
    with open(path, "xb") as file:
        try:
            file.write(_bytes(content))
            file.flush()
        except BaseException:
            os.unlink(path)
            raise


def write_all(folder: str | os.PathLike[str], files: Mapping[str, str | bytes]) -> list[Path]:
    """Write files under their names, or paths below the folder, replacing what stood there.

    Texts are written in UTF-8 with LF line ends.

    Everything is first written beside its place under another name and moved there last, so that an
    interrupted run leaves no half file under a final name. A link stays, and what it points to is replaced.

    Raises:
        LinegraphError: the folder cannot be made or written to; `DeviceFailed` if its name is not to blame.
    """
    target = Path(folder)
    staged: list[tuple[str, Path]] = []
    streams: list[tuple[Path, bytes]] = []
    with _explained(target):
        try:
            target.mkdir(parents=True, exist_ok=True)
            for name, content in files.items():
                final = target / name
                if is_stream(final):
                    streams.append((final, _bytes(content)))
                    continue
                staged.append((_stage(target, content), Path(os.path.realpath(final))))
            for _, final in staged:
                final.parent.mkdir(parents=True, exist_ok=True)
                if final.is_dir():
                    raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(final))
            for temporary, final in staged:
                os.replace(temporary, final)
            for final, stream in streams:
                _pour(str(final), stream)
        except BaseException:
            for temporary, _ in staged:
                with contextlib.suppress(OSError):
                    os.unlink(temporary)
            raise
    return [target / name for name in files]


@contextlib.contextmanager
def _explained(place: Path) -> Iterator[None]:
    """Turn an error of the system into one of ours."""
    try:
        yield
    except OSError as error:
        _refuse(error, place)


def _refuse(error: OSError, place: Path) -> NoReturn:
    named = error.filename and not Path(str(error.filename)).name.startswith(STAGED)
    where = str(error.filename) if named else str(place)
    reason = error.strerror or str(error)
    kind = DeviceFailed if error.errno in OF_DEVICES else LinegraphError
    raise kind(f"cannot write to {where}: {reason}") from None


def _bytes(content: str | bytes) -> bytes:
    return content.encode("utf-8") if isinstance(content, str) else content


def _pour(path: str, content: bytes) -> None:
    """Write into what is there; of what this process has open already, where it has got to."""
    found = DESCRIPTOR.fullmatch(path)
    if found:
        number = STANDARD[found[1]] if found[1] else int(found[2])
        handle = os.dup(number)
    else:
        handle = os.open(path, os.O_WRONLY)
    with os.fdopen(handle, "wb") as stream:
        stream.write(content)


def _stage(folder: Path, content: str | bytes) -> str:
    """Write to a new file in the folder, with the permissions of an ordinary one."""
    handle, temporary = tempfile.mkstemp(prefix=STAGED, dir=folder)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(_bytes(content))
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, 0o666 & ~mask)
    except BaseException:
        os.unlink(temporary)
        raise
    return temporary

"""Writing files: all of them or none, and into devices.

A regular file is replaced as a whole, so that an interrupted run leaves the old one. A device, a pipe or a
socket is written into and never replaced.
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
"""Prefix of the temporary names under which files are written first."""

DESCRIPTOR = re.compile(r"/dev/(stdin|stdout|stderr)|(?:/dev/fd|/proc/self/fd)/(\d+)")
"""Paths that denote file descriptors of this process."""

STANDARD = {"stdin": 0, "stdout": 1, "stderr": 2}

OF_DEVICES = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.ENXIO, errno.EPIPE)
"""Errors not caused by the path: a full disk, a failing device, a pipe whose reader has exited."""


def is_stream(path: str | os.PathLike[str]) -> bool:
    """Whether a path is a device, a pipe or the like, into which output is written without replacing it."""
    place = Path(path)
    if DESCRIPTOR.fullmatch(os.fspath(path)):
        return True
    try:
        return place.exists() and not (place.is_file() or place.is_dir())
    except OSError:
        return False


def write_file(path: str | os.PathLike[str], content: str | bytes) -> Path:
    """Write one file, as a whole or not at all; a device or pipe is written into.

    Args:
        path: the file; its folder is created if missing.
        content: text, written in UTF-8 with LF line ends, or bytes.

    Returns:
        The path.

    Raises:
        LinegraphError: it cannot be written; `DeviceFailed` if the path is not the cause.
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
    """Write a file that must not exist yet; a device or pipe is written into.

    Args:
        path: the file, in an existing folder.
        content: text, written in UTF-8 with LF line ends.

    Raises:
        FileExistsError: the file exists.
        OSError: it cannot be written; no part of it is left.
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
    """Write files by name, or by path relative to a folder, replacing existing ones.

    Everything is first written to temporary names in the folder and then moved, so that an interrupted run
    leaves no incomplete file under a final name. A symbolic link is kept and its target replaced.

    Args:
        folder: the folder, created if missing.
        files: contents by name: texts, written in UTF-8 with LF line ends, or bytes.

    Returns:
        The paths, in the order of `files`.

    Raises:
        LinegraphError: the folder cannot be created or written to; `DeviceFailed` if the path is not the
            cause.
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
            # All contents are complete; from here on files are only renamed.
            for temporary, final in staged:
                os.replace(temporary, final)
            # Devices last: what is written to them cannot be taken back.
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
    """Turn an `OSError` into a `LinegraphError`."""
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
    """Write into an existing device or pipe; for an open descriptor, continue at its position."""
    found = DESCRIPTOR.fullmatch(path)
    if found:
        number = STANDARD[found[1]] if found[1] else int(found[2])
        handle = os.dup(number)
    else:
        handle = os.open(path, os.O_WRONLY)
    with os.fdopen(handle, "wb") as stream:
        stream.write(content)


def _stage(folder: Path, content: str | bytes) -> str:
    """Write to a new temporary file in the folder, with the permissions of an ordinary file."""
    handle, temporary = tempfile.mkstemp(prefix=STAGED, dir=folder)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(_bytes(content))
        # mkstemp makes files private to the owner; the umask can be read only by setting it.
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, 0o666 & ~mask)
    except BaseException:
        os.unlink(temporary)
        raise
    return temporary

"""From bytes to plain data with line numbers: TOML or JSON, with limits against hostile files."""

from __future__ import annotations

import json
import os
import re
import stat
import tomllib
from typing import TYPE_CHECKING, Any, NamedTuple

from linegraph.errors import SourceError
from linegraph.readers.modelfile import json_lines, toml_lines
from linegraph.readers.modelfile.places import Limit, Lines
from linegraph.readers.modelfile.report import ModelReport, shown
from linegraph.readers.modelfile.tables import FLAT

if TYPE_CHECKING:
    from linegraph.readers.modelfile.report import Path

MOST_BYTES = 8 * 2**20

_UTF8 = "; save the file as UTF-8"
_AT = re.compile(r"\s*\(at (?:line (\d+), column (\d+)|end of document)\)$")


class ModelText(NamedTuple):
    """The content of a model file.

    Attributes:
        data: its tables.
        lines: the line of every key, in the order of the file.
    """

    data: dict[str, Any]
    lines: dict[Path, int]


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """Read a regular file, at most one byte more than the accepted size.

    Raises:
        SourceError: it is missing, unreadable or no regular file.
    """
    source = shown(os.fsdecode(path), 1000)
    try:
        _require_regular(os.stat(path), source)
        # Without O_NONBLOCK, opening a FIFO that has replaced the file since the check would block forever.
        flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
        with open(os.open(path, flags), "rb") as file:
            _require_regular(os.fstat(file.fileno()), source)
            return file.read(MOST_BYTES + 1)
    except OSError as error:
        raise SourceError(source, None, "", f"cannot be read: {error.strerror}") from None
    except ValueError as error:  # a NUL in the path
        raise SourceError(source, None, "", f"cannot be read: {error}") from None


def parse_document(data: bytes, source: str) -> ModelText:
    """Parse a TOML or JSON text into tables with line numbers.

    Args:
        data: the bytes of the file, in UTF-8.
        source: name of the file, for messages; its ending decides between JSON and TOML.

    Raises:
        SourceError: it is neither TOML nor JSON, not UTF-8, or larger than the limits.
    """
    source = shown(source, 1000)
    text = _decoded(data, source)
    as_json = source.lower().endswith(".json") or text.lstrip().startswith("{")
    try:
        # Scanned first: its limits protect the parser, which has none.
        places = (json_lines if as_json else toml_lines).locate(text)
    except Limit as limit:
        raise SourceError(source, limit.line, "", limit.problem) from None
    tables = (_json if as_json else _toml)(text, source, places)
    return ModelText(tables, places.lines)


def _require_regular(status: os.stat_result, source: str) -> None:
    if stat.S_ISDIR(status.st_mode):
        raise SourceError(source, None, "", "is a directory; a model file is needed")
    if not stat.S_ISREG(status.st_mode):
        raise SourceError(source, None, "", "is not a regular file")


def _decoded(data: bytes, source: str) -> str:
    """Decode the text: LF line ends, no byte order mark."""
    if len(data) > MOST_BYTES:
        problem = f"is over {MOST_BYTES // 2**20} MiB, more than is read"
        raise SourceError(source, None, "", problem)
    if data.startswith((b"\xff\xfe", b"\xfe\xff", b"\x00\x00\xfe\xff")):
        raise SourceError(source, 1, "", f"is UTF-16 or UTF-32{_UTF8}")
    data = data.removeprefix(b"\xef\xbb\xbf")
    if b"\x00" in data:
        line = data.count(b"\n", 0, data.index(b"\x00")) + 1
        raise SourceError(source, line, "", f"holds NUL bytes: it is UTF-16 or no text{_UTF8}")
    try:
        text = data.decode()
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        problem = f"byte 0x{data[error.start]:02x} is not UTF-8: another encoding, or no text"
        raise SourceError(source, line, "", problem + _UTF8) from None
    if not text.strip():
        raise SourceError(source, None, "", "is empty; `linegraph new` writes a file to start from")
    return text.replace("\r\n", "\n")


def _toml(text: str, source: str, places: Lines) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        found = _AT.search(str(error))
        line = int(found[1]) if found and found[1] else text.rstrip("\n").count("\n") + 1
        _refuse_twice(source, line, places)
        said = _AT.sub("", str(error))
        column = f" (column {found[2]})" if found and found[2] else ""
        problem = f"{shown(said, 200)}{column}{_advice(text, line, said)}"
        raise SourceError(source, line, "TOML", problem) from None
    except (ValueError, RecursionError) as error:
        raise SourceError(source, None, "TOML", shown(str(error), 200)) from None


def _refuse_twice(source: str, line: int, places: Lines) -> None:
    """Report the duplicate key, if that is where the reader stopped."""
    twice = places.twice
    if twice is not None and abs(twice.line - line) <= 1:
        thing = ModelReport(source, places.lines, FLAT).thing(twice.path)
        problem = f"is given twice, first in line {twice.first}; names are unique"
        raise SourceError(source, twice.line, thing, problem)


def _advice(text: str, line: int, said: str) -> str:
    """Guess a beginner's intention and return advice that ends the message."""
    there = text.split("\n")[line - 1].strip() if line <= text.count("\n") + 1 else ""
    _, sign, value = there.partition("=")
    if sign and re.match(r"\s*[\[(]?\s*[-+]?[A-Za-z_(.]", value) and "Invalid value" in said:
        return "; names and expressions stand in quotes"
    if sign and re.match(r"\s*[-+]?[\d.]", value):
        return "; write numbers as 1500, 1.5 or 1.5e3, and expressions and units in quotes"
    if there.startswith("<"):
        return "; this looks like XML: a URDF's name must end with .urdf or .xml"
    return ""


def _json(text: str, source: str, places: Lines) -> dict[str, Any]:
    try:
        data = json.loads(text, parse_constant=_refuse_constant)
    except json.JSONDecodeError as error:
        problem = f"{shown(error.msg, 200)} (column {error.colno})"
        raise SourceError(source, error.lineno, "JSON", problem) from None
    except (ValueError, RecursionError) as error:
        raise SourceError(source, None, "JSON", shown(str(error), 200)) from None
    if places.twice is not None:
        _refuse_twice(source, places.twice.line, places)
    if not isinstance(data, dict):
        raise SourceError(source, 1, "JSON", "a model is an object: {...}")
    return data


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is not a number of JSON")

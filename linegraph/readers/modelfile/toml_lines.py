"""Line numbers of every table, key and item of a TOML text.

The standard library's parser gives values without places; this scanner gives places without values. It
understands the structure of TOML completely: headers, arrays of tables, dotted and quoted keys, inline
tables, arrays and strings over several lines. It runs first, so that its limits protect the parser. Where
it meets text that is not TOML it stops, and the parser reports the error.
"""

from __future__ import annotations

import contextlib
import re
import tomllib
from typing import TYPE_CHECKING

from linegraph.readers.modelfile.places import Lines, NotUnderstood

if TYPE_CHECKING:
    from linegraph.readers.modelfile.report import Path

# Possessive quantifiers, so that matching takes linear time for hostile files as well.
_BLANK = re.compile(r"[ \t]*+")
_GAP = re.compile(r"(?:[ \t\n]++|#[^\n]*+)*+")
_LINE_END = re.compile(r"[ \t]*+(?:#[^\n]*+)?(?:\n|\Z)")
_KEY = re.compile(r"""[A-Za-z0-9_-]++|"(?:[^"\\\n]++|\\.)*+"|'[^'\n]*+'""")
_STRING = re.compile(
    r'''"""(?:[^"\\]++|\\.|"(?!""))*+""""{0,2}'''
    r"""|'''(?:[^']++|'(?!''))*+''''{0,2}"""
    r"""|"(?:[^"\\\n]++|\\.)*+"|'[^'\n]*+'""",
    re.DOTALL,
)
_SCALAR = re.compile(r"[^\s,\[\]{}#=\"'][^,\]}#\n]*+")


def locate(text: str) -> Lines:
    r"""Line numbers in a TOML text with LF line ends, as far as it is valid.

    Raises:
        Limit: it is larger or deeper than the limits.

    Example:
        >>> places = locate("[body.arm]\nmass = 1\n")
        >>> places.lines["body", "arm", "mass"]
        2
    """
    places = Lines(text)
    with contextlib.suppress(NotUnderstood):
        _Scanner(text, places).scan()
    return places


class _Scanner:
    """Scans the text once."""

    def __init__(self, text: str, places: Lines) -> None:
        self._text = text
        self._places = places
        self._at = 0
        self._tables: dict[Path, int] = {}

    def scan(self) -> None:
        """Scan the whole text."""
        table: Path = ()
        self._match(_GAP)
        while self._at < len(self._text):
            if self._text[self._at] == "[":
                table = self._header()
            else:
                self._pair(table)
            if not self._match(_LINE_END):
                raise NotUnderstood
            self._match(_GAP)

    def _match(self, pattern: re.Pattern[str]) -> str | None:
        """Match a pattern at the present position and move behind it."""
        found = pattern.match(self._text, self._at)
        if found is None:
            return None
        self._at = found.end()
        return found[0]

    def _expect(self, text: str) -> None:
        if not self._text.startswith(text, self._at):
            raise NotUnderstood
        self._at += len(text)

    def _header(self) -> Path:
        """Scan ``[table]`` or ``[[array of tables]]``."""
        start = self._at
        array = self._text.startswith("[[", start)
        self._expect("[[" if array else "[")
        keys = self._keys()
        self._expect("]]" if array else "]")
        path: Path = ()
        for i, key in enumerate(keys):
            path = (*path, key)
            last = i == len(keys) - 1
            if last and array:
                self._places.note(path, start, again=True)
                self._tables[path] = self._tables.get(path, 0) + 1
            if path in self._tables:
                path = (*path, self._tables[path] - 1)
            self._places.note(path, start, again=not last)
        return path

    def _keys(self) -> list[str]:
        """Scan a dotted key with the blanks around it."""
        keys = []
        while True:
            self._match(_BLANK)
            key = self._match(_KEY)
            if key is None:
                raise NotUnderstood
            keys.append(self._plain(key))
            self._places.require_depth(len(keys), self._at)
            self._match(_BLANK)
            if not self._text.startswith(".", self._at):
                return keys
            self._at += 1

    def _plain(self, key: str) -> str:
        """Return a key without its quotes."""
        if key[0] not in "\"'":
            return key
        self._places.string(len(key), self._at)
        try:
            return next(iter(tomllib.loads(f"{key} = 0")))
        except tomllib.TOMLDecodeError:
            raise NotUnderstood from None

    def _pair(self, table: Path) -> None:
        """Scan ``key = value``."""
        start = self._at
        keys = self._keys()
        self._expect("=")
        self._match(_BLANK)
        path = table
        for key in keys[:-1]:
            path = (*path, key)
            self._places.note(path, start, again=True)
        path = (*path, keys[-1])
        self._places.note(path, start)
        self._value(path)

    def _value(self, path: Path) -> None:
        self._places.require_depth(len(path), self._at)
        start = self._at
        first = self._text[start : start + 1]
        if first == "[":
            self._array(path)
        elif first == "{":
            self._inline(path)
        elif first in ("'", '"'):
            if (text := self._match(_STRING)) is None:
                raise NotUnderstood
            self._places.string(len(text), start)
        else:
            if (text := self._match(_SCALAR)) is None:
                raise NotUnderstood
            self._places.scalar(len(text.rstrip()), start)

    def _array(self, path: Path) -> None:
        self._expect("[")
        count = 0
        while True:
            self._match(_GAP)
            if self._text.startswith("]", self._at):
                break
            item = (*path, count)
            self._places.note(item, self._at)
            self._value(item)
            count += 1
            self._match(_GAP)
            if not self._text.startswith(",", self._at):
                break
            self._at += 1
        self._expect("]")

    def _inline(self, path: Path) -> None:
        self._expect("{")
        self._match(_BLANK)
        while not self._text.startswith("}", self._at):
            self._pair(path)
            self._match(_BLANK)
            if not self._text.startswith(",", self._at):
                break
            self._at += 1
            self._match(_BLANK)
        self._expect("}")

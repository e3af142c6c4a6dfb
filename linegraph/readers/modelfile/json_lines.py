"""Line numbers of every key and item of a JSON text.

Like `toml_lines` it runs before the parser, enforces limits, and stops at text it does not understand.
"""

from __future__ import annotations

import contextlib
import json
import re
from typing import TYPE_CHECKING

from linegraph.readers.modelfile.places import Lines, NotUnderstood

if TYPE_CHECKING:
    from linegraph.readers.modelfile.report import Path

# Possessive quantifiers, so that matching takes linear time for hostile files as well.
_GAP = re.compile(r"[ \t\r\n]*+")
_STRING = re.compile(r'"(?:[^"\\\n]++|\\.)*+"')
_SCALAR = re.compile(r"[A-Za-z0-9.+-]++")


def locate(text: str) -> Lines:
    """Line numbers in a JSON text, as far as it is valid.

    Raises:
        Limit: it is larger or deeper than the limits.
    """
    places = Lines(text)
    with contextlib.suppress(NotUnderstood):
        _JsonScanner(text, places).value(())
    return places


class _JsonScanner:
    """Scans the text once."""

    def __init__(self, text: str, places: Lines) -> None:
        self._text = text
        self._places = places
        self._at = 0

    def value(self, path: Path) -> None:
        """Scan a value with all values inside it."""
        self._places.require_depth(len(path), self._at)
        self._skip()
        first = self._text[self._at : self._at + 1]
        if first == "{":
            self._members(path, "}")
        elif first == "[":
            self._members(path, "]")
        elif first == '"':
            self._text_here()
        else:
            self._places.scalar(len(self._token(_SCALAR)), self._at)

    def _skip(self) -> None:
        found = _GAP.match(self._text, self._at)
        self._at = found.end() if found else self._at

    def _text_here(self) -> str:
        text = self._token(_STRING)
        self._places.string(len(text), self._at)
        return text

    def _token(self, pattern: re.Pattern[str]) -> str:
        found = pattern.match(self._text, self._at)
        if found is None:
            raise NotUnderstood
        self._at = found.end()
        return found[0]

    def _members(self, path: Path, end: str) -> None:
        """Scan the members between two brackets."""
        self._at += 1
        self._skip()
        count = 0
        while not self._text.startswith(end, self._at):
            start = self._at
            key: str | int = self._key() if end == "}" else count
            self._places.note((*path, key), start)
            self.value((*path, key))
            count += 1
            self._skip()
            if not self._text.startswith(",", self._at):
                break
            self._at += 1
            self._skip()
        if not self._text.startswith(end, self._at):
            raise NotUnderstood
        self._at += 1

    def _key(self) -> str:
        key = self._text_here()
        self._skip()
        if not self._text.startswith(":", self._at):
            raise NotUnderstood
        self._at += 1
        try:
            return str(json.loads(key))
        except ValueError:
            raise NotUnderstood from None

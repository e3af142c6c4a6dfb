"""How much stack the functions of an emitted C file take at most, read off the file's own text.

A function's frame has its variables, its arguments and what a call costs. Without optimisation a compiler
gives every variable a place of its own; with it, registers take most of them, so that the same sum is an
upper bound for both. To a frame comes the deepest of those it calls. Nothing calls itself.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

CALL = 32
"""Bytes of every call: the return address, the frame's, alignment."""

SPILLED = 160
"""Bytes of registers that a function saves, and of numbers it holds in between, at most."""

_WORD = 8
"""Bytes of a pointer, and of an argument."""

_BYTES = {"double": 8, "float": 4, "int": 4}

_REGISTER = 64
"""Bytes of the longest vector register."""

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_FUNCTION = re.compile(
    r"^[a-zA-Z][^\n;{}=]*?\b(\w+)\(([^;{}]*?)\)\n\{\n(.*?)^\}", re.DOTALL | re.MULTILINE
)
_VARIABLE = re.compile(
    r"(?<=[\s(])(?:const )?(double|float|int|\w+_(?:lanes|bits|some)) "
    r"(\*const )?(\w+)(?:\[([^\]]+)\])?(?= =|;)"
)
_WIDE = re.compile(r"_(?:lanes|bits|some)\b")
_STATIC = re.compile(r"\bstatic const [^;]*;")
_ENUM = re.compile(r"\benum \{([^}]*)\}")
_CALLED = re.compile(r"\b(\w+)\(")


def bounds(source: str, sizes: Mapping[str, int]) -> dict[str, int]:
    """Bytes of stack that each function takes at most, with all that it calls but <math.h>.

    `sizes` are the macros that arrays are declared with.
    """
    bodies = functions(_STATIC.sub("", _COMMENT.sub("", source)))
    found: dict[str, int] = {}

    def depth(name: str) -> int:
        if name not in found:
            head, body = bodies[name]
            called = [x for x in _CALLED.findall(body) if x in bodies]
            own = _frame(head, body, sizes)
            found[name] = -(-(own + max(map(depth, called), default=0)) // 8) * 8
        return found[name]

    return {name: depth(name) for name in bodies}


def functions(source: str) -> dict[str, tuple[str, str]]:
    """For each function that is defined: its parameters and the lines between its braces."""
    return {name: (head, body) for name, head, body in _FUNCTION.findall(source)}


def _frame(head: str, body: str, sizes: Mapping[str, int]) -> int:
    """Bytes of one function alone."""
    known = dict(sizes)
    known |= dict.fromkeys(re.findall(r"\w+_LANES\b", body), 8)
    for entries in _ENUM.findall(body):
        for entry in entries.split(","):
            name, value = entry.split("=")
            known[name.strip()] = _value(value, known)
    variables = 0
    for kind, pointer, _, size in _VARIABLE.findall(body):
        variables += (
            _WORD if pointer else _BYTES.get(kind, _REGISTER) * (_value(size, known) if size else 1)
        )
    arguments = _WORD * (head.count(",") + 1)
    if _WIDE.search(body):
        arguments += 4 * _REGISTER  # registers are kept in places of their alignment
    # a quarter more, since a compiler that makes one function of several may not use a place twice
    return CALL + arguments + variables * 5 // 4 + min(SPILLED, _WORD * body.count(";"))


def _value(text: str, known: Mapping[str, int]) -> int:
    """A sum of products of whole numbers and names, with brackets."""
    words = re.findall(r"\w+|[+*()]", text)
    place = 0

    def term() -> int:
        nonlocal place
        word = words[place]
        place += 1
        if word == "(":
            inner = total()
            place += 1
            return inner
        return int(word) if word.isdigit() else known[word]

    def product() -> int:
        nonlocal place
        value = term()
        while place < len(words) and words[place] == "*":
            place += 1
            value *= term()
        return value

    def total() -> int:
        nonlocal place
        value = product()
        while place < len(words) and words[place] == "+":
            place += 1
            value += product()
        return value

    return total()

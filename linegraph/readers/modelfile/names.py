"""Which names things in a model file may have."""

from __future__ import annotations

import keyword
import re

from linegraph.components.validation import RESERVED, reserved_problem
from linegraph.readers.modelfile.report import shown

LONGEST_NAME = 100

_SYMBOL = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def name_problem(name: str, *, dots: bool = False) -> str:
    """Why a body, frame, joint or element cannot have a name; empty if it can.

    Args:
        name: the name.
        dots: whether dots and slashes are allowed, which otherwise separate bodies from frames and edges.
    """
    if not name.strip():
        return "a name is needed; it is empty"
    if name != name.strip() or not name.isprintable():
        return f'the name "{shown(name)}" has blanks at its ends or characters that do not print'
    if len(name) > LONGEST_NAME:
        return f"a name of {len(name)} characters; at most {LONGEST_NAME} can be emitted"
    if not dots and "." in name:
        return f'the name "{shown(name)}" has a dot; dots separate a body from its frame'
    if not dots and "/" in name:
        return f'the name "{shown(name)}" has a slash; slashes separate a body from its edges'
    return ""


def symbol_problem(name: str) -> str:
    """Why a parameter or input cannot have a name; empty if it can."""
    if not _SYMBOL.fullmatch(name):
        problem = "a name starts with a letter and has letters, digits and _ only"
        return f'"{shown(name)}" cannot stand in an expression: {problem}'
    if "__" in name or len(name) > LONGEST_NAME:
        return f'"{shown(name)}" cannot be emitted: at most {LONGEST_NAME} characters, no "__"'
    if name in RESERVED:
        return reserved_problem(name)
    if keyword.iskeyword(name):
        return f'"{name}" is a word of Python, in which code is emitted; choose another name'
    return ""

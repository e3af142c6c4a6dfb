"""Displays in notebooks: types say that they are shown, a register says how.

A graph or a model knows nothing of pictures. It inherits `Displayed`; `notebook` enters the functions that
draw it, and is loaded when something is shown for the first time.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

MAKERS = "linegraph.notebook"
"""The module that enters what makes displays."""

_SVG: dict[type, Callable[[Any], str]] = {}
_HTML: dict[type, Callable[[Any], str]] = {}


class Displayed:
    """Something that notebooks show as a picture or as HTML, if the register has a function for its type."""

    def _repr_svg_(self) -> str | None:
        return _made(_SVG, self)

    def _repr_html_(self) -> str | None:
        return _made(_HTML, self)


def register(
    kind: type, *, svg: Callable[[Any], str] | None = None, html: Callable[[Any], str] | None = None
) -> None:
    """Enter the functions that show a type and all that inherits from it."""
    if svg is not None:
        _SVG[kind] = svg
    if html is not None:
        _HTML[kind] = html


def _made(makers: dict[type, Callable[[Any], str]], shown: object) -> str | None:
    import_module(MAKERS)
    for kind in type(shown).__mro__:
        if kind in makers:
            return makers[kind](shown)
    return None

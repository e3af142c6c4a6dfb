"""Displays in notebooks: a register of the functions that draw each type.

A graph or a model must not depend on drawing. It inherits `Displayed`; `notebook` registers the functions
that draw it, and is imported when an object is displayed for the first time.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

MAKERS = "linegraph.notebook"
"""The module that registers the functions."""

_SVG: dict[type, Callable[[Any], str]] = {}
_HTML: dict[type, Callable[[Any], str]] = {}


class Displayed:
    """An object that notebooks show as a picture or HTML if a function is registered for its type."""

    def _repr_svg_(self) -> str | None:
        return _made(_SVG, self)

    def _repr_html_(self) -> str | None:
        return _made(_HTML, self)


def register(
    kind: type, *, svg: Callable[[Any], str] | None = None, html: Callable[[Any], str] | None = None
) -> None:
    """Register the functions that display a type and its subclasses.

    Args:
        kind: the type.
        svg: returns the SVG text of an object.
        html: returns the HTML of an object.
    """
    if svg is not None:
        _SVG[kind] = svg
    if html is not None:
        _HTML[kind] = html


def _made(makers: dict[type, Callable[[Any], str]], shown: object) -> str | None:
    # Imported at the first display only, so that models and graphs do not load drawing.
    import_module(MAKERS)
    for kind in type(shown).__mro__:
        if kind in makers:
            return makers[kind](shown)
    return None

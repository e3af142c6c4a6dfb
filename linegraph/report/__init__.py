"""Texts about a model for readers: an overview, and the derivation step by step.

overview      `linegraph show` contents      the document of a derivation: system, graphs, laws, principle,
forms document      the parts of a document, independent of the format text, markdown, latex, html    its
writers
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from linegraph.errors import LinegraphError
from linegraph.files import is_stream, write_file
from linegraph.report.overview import assembled, show

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from linegraph.derivation import Derivation

FORMATS = {"text": ".txt", "markdown": ".md", "latex": ".tex", "html": ".html"}
"""Formats of reports with the endings of their files."""


def report(
    derivation: Derivation,
    format: str = "text",
    *,
    level: str = "full",
    folded: bool = False,
    progress: Callable[[str], None] | None = None,
) -> str:
    """Write a readable derivation of a model.

    Args:
        derivation: the derived model.
        format: one of `FORMATS`.
        level: how far closed forms are simplified: ``none``, ``fast`` or ``full``.
        folded: write the parameters' values in place of their names.
        progress: called with a short text before each stage.

    Returns:
        The text of the report.

    Raises:
        LinegraphError: there is no such format.

    Example:
        >>> from linegraph import Model, derive
        >>> model = Model("pendulum")
        >>> bob = model.body("bob", mass=model.parameter("m", 2.0, "kg"), mass_center=(0, 0, -0.5))
        >>> _ = model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
        >>> "0.25·m·q_hinge″ + 0.5·m·g" in report(derive(model)).replace("4.905", "0.5·m·g")
        True
    """
    if format not in FORMATS:
        raise LinegraphError(f'there is no format "{format}"; formats: {", ".join(FORMATS)}')
    from linegraph.report.contents import document

    tell = progress or (lambda text: None)
    found = document(derivation, level, folded, tell)
    tell(f"writing {format}")
    return str(import_module(f"linegraph.report.{format}").render(found))


def format_of(path: str) -> str:
    """The format of a file by its ending; text for a device or pipe without one.

    Raises:
        LinegraphError: the ending belongs to no format.
    """
    for name, ending in FORMATS.items():
        if path.lower().endswith(ending):
            return name
    if is_stream(path):
        return "text"
    endings = ", ".join(FORMATS.values())
    raise LinegraphError(f"the ending of {path} tells no format: use {endings}, or --format")


def save(path: str, text: str) -> Path:
    """Write a report to a file, completely or not at all.

    Args:
        path: the file.
        text: the report.

    Returns:
        The path of the file.

    Raises:
        LinegraphError: it cannot be written.
    """
    return write_file(path, text)


__all__ = ["FORMATS", "assembled", "format_of", "report", "save", "show"]

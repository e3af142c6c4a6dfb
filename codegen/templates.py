"""The one place that finds the templates and makes the Jinja environment."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import jinja2


def folder() -> Path:
    """The folder of all templates: within the installed package, else beside it in the sources."""
    package = Path(__file__).resolve().parent
    packaged = package / "templates"
    return packaged if packaged.is_dir() else package.parent / "templates"


def fill(template: str, **texts: object) -> str:
    """The text of a file, made from a template.

    Args:
        template: its path relative to `folder`.
        texts: the values of all variables of the template.
    """
    return _environment().get_template(template).render(texts)


@functools.cache
def _environment() -> jinja2.Environment:
    import jinja2  # here, since who only asks for the names of languages should not wait for it

    return jinja2.Environment(
        loader=jinja2.FileSystemLoader(folder()),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )

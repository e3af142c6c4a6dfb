"""Messages of the command line on standard error: warnings, errors and progress."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

from linegraph.errors import DeviceFailed, LinegraphError, SourceErrors
from linegraph.exits import IO_FAILED, WRONG

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


@contextmanager
def explained() -> Iterator[None]:
    """Turn an error of the user into one message and exit status 2, an error of a device into status 74."""
    try:
        yield
    except LinegraphError as error:
        messages = error.messages() if isinstance(error, SourceErrors) else [str(error)]
        for message in messages:
            click.echo(f"{click.style('error:', fg='red', bold=True)} {message}", err=True)
        sys.exit(IO_FAILED if isinstance(error, DeviceFailed) else WRONG)


def warn(text: str) -> None:
    """Print a warning on standard error."""
    click.echo(f"{click.style('warning:', fg='yellow', bold=True)} {text}", err=True)


@contextmanager
def progress() -> Iterator[Callable[[str], None]]:
    """Show the present stage on standard error if it is a terminal, and erase it at the end."""
    if not sys.stderr.isatty():
        yield lambda text: None
        return

    def tell(text: str) -> None:
        click.echo(f"\r\x1b[K{text} ...", nl=False, err=True)

    try:
        yield tell
    finally:
        click.echo("\r\x1b[K", nl=False, err=True)

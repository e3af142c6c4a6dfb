"""The command `linegraph`, and `python -m linegraph`: runs the command line and ends the process.

Everything else is imported inside `main`, so that an interrupt is handled at any time.
"""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import sys

from linegraph.exits import BROKEN, INTERRUPTED, IO_FAILED


def main() -> None:
    """Run the command line and end the process.

    If a reader exits, as ``head`` does, SIGPIPE ends the process as it does any other tool.
    """
    if hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    written = _opened()
    try:
        from linegraph.cli.main import run

        status = run()
        sys.stdout.flush()
        # A command that succeeded has printed its result, which is lost if standard output is closed.
        if not written and status == 0:
            raise OSError(errno.EBADF, "it is closed")
    except KeyboardInterrupt:
        status = INTERRUPTED
        _tell("interrupted")
    except OSError as error:
        status = IO_FAILED
        place = error.filename or "standard output"
        _tell(f"error: cannot write to {place}: {error.strerror or error}")
    except Exception:
        import traceback

        status = BROKEN
        _tell(
            f"{traceback.format_exc()}error: this is a fault of linegraph: please report the model"
        )
    _leave(status)


def _opened() -> bool:
    """Replace closed standard streams by the null device.

    Otherwise files opened later would get their descriptors, and prints would go into these files.

    Returns:
        Whether standard output is open.
    """
    written = getattr(sys, "stdout", None) is not None
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name, None) is None:
            stream = os.fdopen(os.open(os.devnull, os.O_RDWR), mode, encoding="utf-8")
            setattr(sys, name, stream)
    return written


def _tell(text: str) -> None:
    with contextlib.suppress(OSError):
        sys.stderr.write(f"{text}\n")
        sys.stderr.flush()


def _leave(status: int) -> None:
    """End the process; output that cannot be written is not tried again."""
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    sys.exit(status)


if __name__ == "__main__":
    main()

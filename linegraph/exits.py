"""Exit statuses of the command `linegraph`."""

CHECK_FAILED = 1
"""A check has failed: the equations of the model differ between independent routes."""

WRONG = 2
"""The model or the command line is wrong; nothing is written."""

BROKEN = 70
"""An internal error of the program: EX_SOFTWARE of <sysexits.h>."""

IO_FAILED = 74
"""Writing failed: a full disk, a device. EX_IOERR of <sysexits.h>."""

INTERRUPTED = 130
"""Interrupted, as shells count it: 128 + SIGINT."""

"""Exit statuses of the command `linegraph`."""

CHECK_FAILED = 1
"""A check has failed: the equations of the model are not what they should be."""

WRONG = 2
"""The model or the call is wrong; nothing is written."""

BROKEN = 70
"""An error of the program itself: EX_SOFTWARE of <sysexits.h>."""

IO_FAILED = 74
"""What is written to failed: a full disk, a device. EX_IOERR of <sysexits.h>."""

INTERRUPTED = 130
"""Interrupted, as shells count it: 128 + SIGINT."""

"""Emitted C, compiled and called from Python: what every test of emitted C stands on.

    arm = Compiled(codegen.render(module, "c"), "arm", tmp_path)
    M = arm.call("mass_matrix", [0.1, 0.2], out=[(2, 2)])
    M, h = arm.call("equations", q, v, out=[(2, 2), (2,)])

Each output lies between guards and is filled beforehand, so a call also shows that a function writes all of
its outputs and nothing else, and nothing at all when it fails.
"""

from __future__ import annotations

import ctypes
import re
import shutil
import subprocess
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

WARNINGS = (
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Wdouble-promotion",
    "-Wshadow",
    "-Werror",
)
COMPILERS = {
    "gcc": ("gcc", "-std=c99"),
    "clang": ("clang", "-std=c99"),
    "g++": ("g++", "-std=c++17", "-x", "c++"),
    "clang++": ("clang++", "-std=c++17", "-x", "c++"),
}
"""Ways to compile emitted C: as C99 and as C++."""

_UNTOUCHED = -1.2345678901234567e300
_GUARD = 8

Array = NDArray[np.float64]


def has_no_warnings(
    files: Mapping[str, str], name: str, folder: Path, compiler: str, flags: Sequence[str]
) -> None:
    """Compile emitted files for the sake of warnings alone.

    GCC finds some only as it optimizes, so that C is compiled; the other compilers need not go further than
    the syntax, where theirs are found.
    """
    if compiler == "gcc":
        Compiled(files, name, folder, compiler, flags)
        return
    folder.mkdir(parents=True, exist_ok=True)
    for file, text in files.items():
        (folder / file).write_text(text, encoding="ascii", newline="\n")
    command = [*COMPILERS[compiler], *WARNINGS, *flags, "-fsyntax-only", str(folder / f"{name}.c")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stderr[:4000]}"


def available(compiler: str) -> bool:
    """Whether the machine has this one of `COMPILERS`."""
    return shutil.which(COMPILERS[compiler][0]) is not None


class Failed(Exception):
    """A function has reported that it could not compute.

    Attributes:
        status: what it returned.
    """

    def __init__(self, function: str, status: int) -> None:
        """Keep the status."""
        super().__init__(f"{function} returned {status}")
        self.status = status


class Compiled:
    """A shared library made of emitted files.

    Args:
        files: file name -> text, as `codegen.render` gives them.
        name: the module's name, the prefix of its functions.
        folder: where files and library are written.
        compiler: one of `COMPILERS`.
        flags: further flags of the compiler; warnings are errors in any case.
    """

    def __init__(
        self,
        files: Mapping[str, str],
        name: str,
        folder: Path,
        compiler: str = "gcc",
        flags: Sequence[str] = ("-O1", "-ffp-contract=off"),
    ) -> None:
        """Write the files, compile and load them; the compiler's first complaint is an error."""
        folder.mkdir(parents=True, exist_ok=True)
        for file, text in files.items():
            (folder / file).write_text(text, encoding="ascii", newline="\n")
        library = folder / f"{name}.so"
        command = [*COMPILERS[compiler], *WARNINGS, *flags, "-fPIC", "-shared"]
        command += [str(folder / f"{name}.c"), "-x", "none", "-lm", "-o", str(library)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise AssertionError(f"{' '.join(command)}\n{done.stderr[:4000]}")
        self.name = name
        self.header = files[f"{name}.h"]
        self.library = ctypes.CDLL(str(library))

    def call(self, function: str, *inputs: Any, out: Sequence[tuple[int, ...]]) -> Any:
        """The outputs of a function, which have the shapes `out`: an array, or a tuple of several.

        Args:
            function: its name without the prefix.
            *inputs: arrays, the time as a float, parameters as an array of their values in order, or
                as None for the default ones.
            out: the shapes of the outputs.

        Raises:
            Failed: the function has returned a status other than 0.
        """
        emitted = self.library[f"{self.name}_{function}"]
        can_fail = (
            re.search(rf"^int {self.name}_{function}\(", self.header, re.MULTILINE) is not None
        )
        emitted.restype = ctypes.c_int if can_fail else None
        kept = [self._pass(value) for value in inputs]
        buffers = [np.full(int(np.prod(shape)) + 2 * _GUARD, _UNTOUCHED) for shape in out]
        status = emitted(*kept, *(_pointer(buffer[_GUARD:]) for buffer in buffers))
        self._inspect(function, buffers, bool(can_fail and status))
        if can_fail and status:
            raise Failed(function, status)
        arrays = tuple(x[_GUARD:-_GUARD].reshape(s) for x, s in zip(buffers, out, strict=True))
        return arrays[0] if len(arrays) == 1 else arrays

    def names(self, symbol: str, count: int) -> list[bytes | None]:
        """The names of the `count` quantities q, v or u."""
        return list((ctypes.c_char_p * count).in_dll(self.library, f"{self.name}_{symbol}_names"))

    def default_parameters(self, count: int) -> Array:
        """The values of the `count` parameters."""
        values = (ctypes.c_double * count).in_dll(self.library, f"{self.name}_default_parameters")
        return np.array(values)

    def _pass(self, value: ArrayLike | None) -> Any:
        if value is None:
            return ctypes.byref(
                ctypes.c_double.in_dll(self.library, f"{self.name}_default_parameters")
            )
        if isinstance(value, float):
            return ctypes.c_double(value)
        return _pointer(np.array(value, dtype=float))

    @staticmethod
    def _inspect(function: str, buffers: list[Array], failed: bool) -> None:
        for place, buffer in enumerate(buffers):
            guards = np.concatenate((buffer[:_GUARD], buffer[-_GUARD:]))
            assert (guards == _UNTOUCHED).all(), f"{function} writes outside of output {place}"
            inner = buffer[_GUARD:-_GUARD]
            if failed:
                assert (inner == _UNTOUCHED).all(), f"{function} failed but wrote output {place}"
            else:
                assert (inner != _UNTOUCHED).all(), f"{function} leaves parts of output {place}"


def _pointer(array: Array) -> Any:
    """A pointer that keeps its array alive."""
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))

"""From a model to files: derive, render in each language, write."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from linegraph.errors import ModelError
from linegraph.files import write_all
from linegraph.model.system import placed
from linegraph.numeric.derived import Derived
from linegraph.pipeline import derived
from linegraph.programs.frame_names import named_frames
from linegraph.programs.register import ON_REQUEST, PROGRAMS, module_of
from linegraph.version import __version__

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable, Sequence
    from pathlib import Path

    from linegraph.ir.golden_vectors import Vectors
    from linegraph.ir.program import Module
    from linegraph.kinematics.frame_trees import NamedFrame
    from linegraph.model.builder import Model
    from linegraph.model.system import System

CONVENTIONS = (
    "Angles are in radians. Quaternions are (x, y, z, w) and must have length 1. A free joint has "
    "q = (position in the parent frame, quaternion) and v = (linear velocity, angular velocity), both in "
    "the axes of the moving body; a spherical joint has a quaternion and the angular velocity in these "
    "axes; a planar joint has q = (x, y, angle) in the parent frame and v = (vx, vy, wz) in the axes of the "
    "moving body. All other v are derivatives of q. A joint's effort acts along the velocity of its name.",
)


def emit(
    model: Model | System,
    out: str | os.PathLike[str] = ".",
    *,
    name: str | None = None,
    languages: Iterable[str] | None = None,
    folded: bool = False,
    functions: Iterable[str] = (),
    only: Iterable[str] = (),
    frames: Iterable[str] = (),
    tests: bool = False,
    progress: Callable[[str], None] | None = None,
    warn: Callable[[str], None] | None = None,
    **options: Any,
) -> list[Path]:
    """Derive a model and write its functions as source files.

    Args:
        model: the builder or the system.
        out: the folder, created if missing.
        name: prefix of functions and files; default the model's name, turned into an identifier.
        languages: some of `codegen.LANGUAGES`; default all, or C alone with the option ``arduino``.
        folded: write the parameters' values into the code instead of keeping them symbolic.
        functions: further functions to write, of `programs.register.ON_REQUEST`.
        only: write only these of `programs.register.PROGRAMS` and the functions they call.
        frames: bodies, or frames of bodies as ``body.frame``, whose kinematics are to be written.
        tests: also write golden vectors: programs that compare the written functions with independent
            results.
        progress: called with a short text before each stage.
        warn: called with warnings about the files; default a Python warning.
        **options: options for C: ``trig`` ("libm" or "inline"), ``batch`` (functions of many states),
            ``real`` ("double" or "float"), ``prefix`` (of functions, types and macros), ``cmake``,
            ``arduino`` and ``report``; see `codegen.Options`.

    Returns:
        The paths of the files written. Nothing is written unless everything could be rendered.

    Raises:
        LinegraphError: the model cannot be derived, a name cannot be emitted, or a file cannot be written.

    Example:
        >>> import tempfile
        >>> from linegraph import Model
        >>> model = Model("pendulum")
        >>> bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
        >>> _ = model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
        >>> [path.name for path in emit(model, tempfile.mkdtemp(), languages=["c", "python"])]
        ['pendulum.h', 'pendulum.c', 'pendulum.py']
    """
    files = render(
        model,
        name=name,
        languages=languages,
        folded=folded,
        functions=functions,
        only=only,
        frames=frames,
        tests=tests,
        progress=progress,
        warn=warn,
        **options,
    )
    return write_all(out, files)


def render(
    model: Model | System,
    *,
    name: str | None = None,
    languages: Iterable[str] | None = None,
    folded: bool = False,
    functions: Iterable[str] = (),
    only: Iterable[str] = (),
    frames: Iterable[str] = (),
    tests: bool = False,
    progress: Callable[[str], None] | None = None,
    warn: Callable[[str], None] | None = None,
    **options: Any,
) -> dict[str, str]:
    """Render the files that `emit` writes.

    Args:
        model: the builder or the system.
        name: prefix of functions and files; default the model's name, turned into an identifier.
        languages: some of `codegen.LANGUAGES`; default all, or C alone with the option ``arduino``.
        folded: write the parameters' values into the code.
        functions: further functions to write.
        only: write only these functions and those they call.
        frames: bodies, or frames of bodies, whose kinematics are to be written.
        tests: also render golden vectors.
        progress: called with a short text before each stage.
        warn: called with warnings about the files; default a Python warning.
        **options: options for C, as for `emit`.

    Returns:
        The text of each file by name, or by path relative to the folder.

    Raises:
        LinegraphError: the model cannot be derived, or a name cannot be emitted.
    """
    import codegen

    tell = progress or (lambda text: None)
    choices = codegen.options_of(options)
    # An option that differs from its default must concern a language that is written, or it would be
    # ignored silently.
    asked = {name for name, x in options.items() if x != getattr(codegen.Options(), name)}
    heeding = [x for x in codegen.LANGUAGES if asked & codegen.known(x).options]
    default = heeding if choices.arduino else codegen.LANGUAGES
    chosen = list(dict.fromkeys(_several(languages or default)))
    frames, functions, only = _several(frames), _several(functions), _several(only)
    for language in chosen:
        if language not in codegen.LANGUAGES:
            known = ", ".join(codegen.LANGUAGES)
            raise ModelError(f'language "{language}"', f"is not known; known: {known}")
    if asked and not set(heeding) & set(chosen):
        whose, given = " or ".join(map(str.capitalize, heeding)), ", ".join(sorted(asked))
        problem = f"{whose} is not written: add it to the languages"
        raise ModelError(f"options of {whose} ({given})", problem)
    prefix = codegen.naming.identifier(model.name) if name is None else name
    tell("deriving")
    _require_known(functions, only)
    system = model.system()
    named = named_frames(system, frames)
    derivation = derived(system, Derived)
    module = _module(derivation, prefix, named, folded=folded, functions=functions, only=only)
    if module.omitted:
        (warn or _python_warning)(str(derivation.no_inverse(module.omitted, asked=False)))
    files: dict[str, str] = {}
    for language in chosen:
        tell(f"writing {language}")
        files |= codegen.render(module, language, choices)
    if tests:
        tell("computing golden vectors")
        found = _vectors(derivation, module, named)
        for language in chosen:
            checks = codegen.render_tests(module, found, language, choices)
            if not checks:
                tell(f"{language} has no golden vectors")
            files |= checks
    return files


def _python_warning(text: str) -> None:
    warnings.warn(text, stacklevel=4)


def _several(names: Iterable[str]) -> tuple[str, ...]:
    """Return names as a tuple; a single string is one name."""
    return (names,) if isinstance(names, str) else tuple(names)


def _vectors(derivation: Derived, module: Module, frames: Sequence[NamedFrame]) -> Vectors:
    """Golden vectors of a module, with errors placed in the model's file."""
    from linegraph.verification import golden

    try:
        return golden.vectors(derivation, module, frames=frames)
    except ModelError as error:
        raise placed(error, derivation.system) from None


def module_for(
    model: Model | System,
    name: str,
    *,
    folded: bool = False,
    functions: Iterable[str] = (),
    only: Iterable[str] = (),
    frames: Iterable[str] = (),
) -> Module:
    """The program of each function of a model, from which operations are counted.

    Args:
        model: the builder or the system.
        name: prefix of functions.
        folded: write the parameters' values into the programs instead of keeping them symbolic.
        functions: further functions, of `programs.register.ON_REQUEST`.
        only: only these of `programs.register.PROGRAMS` and the functions they call.
        frames: bodies, or frames of bodies as ``body.frame``, whose kinematics are included.

    Raises:
        ModelError: the model cannot be derived, or there is no such function or frame.

    Example:
        >>> from linegraph import Model
        >>> model = Model("pendulum")
        >>> bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
        >>> _ = model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
        >>> module_for(model, "m", only=("frames", "center_of_mass"), frames=("bob",)).programs[:2]
        (<program frame_bob_pose(q): 2 operations>, <program frame_bob_velocity(q, v): 0 operations>)
    """
    wanted, few = tuple(functions), tuple(only)
    _require_known(wanted, few)
    system = model.system()
    named = named_frames(system, frames)
    return _module(derived(system, Derived), name, named, folded=folded, functions=wanted, only=few)


def _require_known(wanted: Iterable[str], only: Iterable[str]) -> None:
    """Refuse names of functions that do not exist."""
    for known, chosen in ((ON_REQUEST, wanted), (tuple(PROGRAMS), only)):
        for function in chosen:
            if function not in known:
                raise ModelError(f'function "{function}"', f"is not one of {', '.join(known)}")


def _module(
    derivation: Derived,
    name: str,
    frames: Sequence[NamedFrame],
    *,
    folded: bool,
    functions: Sequence[str],
    only: Sequence[str],
) -> Module:
    """The programs of a derivation, with errors placed in the model's file."""
    system = derivation.system
    about = [f"Equations of motion of {system.name}, derived by linegraph {__version__}."]
    about += [text for text in (system.about,) if text]
    try:
        return module_of(
            derivation,
            name,
            folded=folded,
            about=[*about, *CONVENTIONS],
            wanted=functions,
            only=only,
            frames=frames,
        )
    except ModelError as error:
        raise placed(error, system) from None

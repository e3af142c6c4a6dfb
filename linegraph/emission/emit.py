"""From a model to files: derive, render in each language, write."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

import codegen
from linegraph.emission.choices import EmitChoices, chosen
from linegraph.errors import ModelError
from linegraph.files import write_all
from linegraph.model.system import placed
from linegraph.numeric.derived import Derived
from linegraph.pipeline import derived
from linegraph.programs.frame_names import named_frames
from linegraph.programs.register import ON_REQUEST, PROGRAMS, module_of
from linegraph.programs.request import Request
from linegraph.version import __version__

if TYPE_CHECKING:
    import os
    from collections.abc import Iterable, Sequence
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
    tests: bool = False,
    **choices: Unpack[EmitChoices],
) -> list[Path]:
    """Derive a model and write its functions as source files.

    Args:
        model: the builder or the system.
        out: the folder, created if missing.
        name: prefix of functions and files; default the model's name, turned into an identifier.
        languages: some of `codegen.LANGUAGES`; default all, or C alone with the option ``arduino``.
        tests: also write golden vectors: programs that compare the written functions with independent
            results.
        **choices: ``folded``, ``functions``, ``only``, ``frames``, ``progress``, ``warn``; for C ``trig``,
            ``batch``, ``real``, ``prefix``, ``cmake``, ``arduino``, ``report``. See `EmitChoices`.

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
    return write_all(out, render(model, name=name, languages=languages, tests=tests, **choices))


def render(
    model: Model | System,
    *,
    name: str | None = None,
    languages: Iterable[str] | None = None,
    tests: bool = False,
    **choices: Unpack[EmitChoices],
) -> dict[str, str]:
    """Render the files that `emit` writes.

    Args:
        model: the builder or the system.
        name: prefix of functions and files; default the model's name, turned into an identifier.
        languages: some of `codegen.LANGUAGES`; default all, or C alone with the option ``arduino``.
        tests: also render golden vectors.
        **choices: as for `emit`.

    Returns:
        The text of each file by name, or by path relative to the folder.

    Raises:
        LinegraphError: the model cannot be derived, or a name cannot be emitted.
    """
    of = chosen(choices)
    written = of.languages(languages)
    prefix = codegen.naming.identifier(model.name) if name is None else name
    of.progress("deriving")
    _require_known(of.functions, of.only)
    system = model.system()
    request = Request(of.folded, of.functions, of.only, named_frames(system, of.frames))
    derivation = derived(system, Derived)
    module = _module(derivation, prefix, request)
    if module.omitted:
        of.warn(str(derivation.no_inverse(module.omitted, asked=False)))
    files: dict[str, str] = {}
    for language in written:
        of.progress(f"writing {language}")
        files |= codegen.render(module, language, of.options)
    if tests:
        of.progress("computing golden vectors")
        found = _vectors(derivation, module, request.frames)
        for language in written:
            checks = codegen.render_tests(module, found, language, of.options)
            if not checks:
                of.progress(f"{language} has no golden vectors")
            files |= checks
    return files


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
    request = Request(folded, wanted, few, named_frames(system, frames))
    return _module(derived(system, Derived), name, request)


def _require_known(wanted: Iterable[str], only: Iterable[str]) -> None:
    """Refuse names of functions that do not exist."""
    for known, asked in ((ON_REQUEST, wanted), (tuple(PROGRAMS), only)):
        for function in asked:
            if function not in known:
                raise ModelError(f'function "{function}"', f"is not one of {', '.join(known)}")


def _module(derivation: Derived, name: str, request: Request) -> Module:
    """The programs of a derivation, with errors placed in the model's file."""
    system = derivation.system
    about = [f"Equations of motion of {system.name}, derived by linegraph {__version__}."]
    about += [text for text in (system.about,) if text]
    try:
        return module_of(derivation, name, request, [*about, *CONVENTIONS])
    except ModelError as error:
        raise placed(error, system) from None

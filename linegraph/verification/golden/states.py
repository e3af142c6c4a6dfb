"""Golden vectors: states of a model, and results of its emitted functions there by an independent route.

The route is Newton's and Euler's equations of every body (`bodies`), in floats, from derivatives of its
position. NumPy solves for accelerations. States are admissible: quaternions have length 1, loops are
closed, velocities obey the constraints, and every law is defined.
"""

from __future__ import annotations

import math
import random
from typing import TYPE_CHECKING, Any

from linegraph.errors import ModelError
from linegraph.ir.golden_vectors import CONSTANTS, RETURNED, Expected, Then, Values, Vectors
from linegraph.ir.program import PREPARED_SUFFIX, Routine
from linegraph.verification.golden.beside import beside
from linegraph.verification.golden.draws import DIGITS, Asked, Drawing, short
from linegraph.verification.golden.point import Kept, Point
from linegraph.verification.golden.references import references

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.ir.program import Module, Program
    from linegraph.kinematics.frame_trees import NamedFrame
    from linegraph.numeric.derived import Derived
    from linegraph.verification.golden.reference import Reference
    from linegraph.verification.golden.walk import Valued

UNTESTED = {
    "prepare": "the functions that take its constants are called by those that are compared",
    "algebraic_loop": "called by functions that are compared",
    "constraint_sizes": "called by functions that are compared",
    "loop_equations": "called by functions that are compared",
    "constrained_slopes": "called by functions that are compared",
}
"""Why a function is not compared itself; for all others the reason is `NO_ROUTE`."""

NO_ROUTE = "there is no independent route to what it returns"
EMPTY = "it returns nothing here"
HANDED = "called by the function of its name without the ending"


def vectors(
    derivation: Derived, module: Module, seed: int = 0, frames: Sequence[NamedFrame] = ()
) -> Vectors:
    """Golden vectors of all functions of a module for which there is an independent route.

    Args:
        derivation: the model.
        module: its functions as they are to be emitted.
        seed: seed of the random states.
        frames: frames whose kinematics are among the functions.

    Returns:
        States with arguments q (nq), v (n), u (nu), a (n) in SI units, and the results there, each entry
        with the scale that its error is to be judged on.

    Raises:
        ModelError: no function has an independent route, or no admissible state was found.

    Example:
        >>> from linegraph import Model, derive
        >>> from linegraph.programs.register import module_of
        >>> from linegraph.programs.request import Request
        >>> model = Model("pendulum")
        >>> bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
        >>> _ = model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
        >>> derivation = derive(model)
        >>> module = module_of(derivation, "pendulum", Request(folded=True, only=("mass_matrix",)))
        >>> vectors(derivation, module).values["M"].rows[0]
        (0.5,)
    """
    register = references(frames)
    if derivation.structure.closed:
        register = {label: beside(label, known) for label, known in register.items()}
    compared = _compared(register, module)
    if not compared:
        raise ModelError("tests", "nothing that is emitted is known by an independent route")
    details: dict[str, Any] = {}
    for p in module.programs:
        details |= dict(p.details) if isinstance(p, Routine) else {}
    kept = Kept(*(tuple(details.get(key, ())) for key in ("s_at", "w_at", "d_at")))
    asked = [_asked(program, reference) for _, program, reference in compared]
    drawing = Drawing(derivation, random.Random(seed), kept, asked, varied=bool(module.parameters))
    points = drawing.points()
    programs = {program.name: program for program in module.programs}
    written = _Written(points)
    expected = []
    for label, program, reference in compared:
        results = written.results(program, reference.results)
        given = written.given(program, reference.given)
        then = tuple(
            Then(
                after.function,
                written.given(programs[after.function], after.given),
                written.results(programs[after.function], after.results),
            )
            for after in reference.then
            if after.function in programs
        )
        expected.append(Expected(label, program.name, reference.route, given, results, then))
    names = tuple(x.name for x in module.parameters) if written.parametric else ()
    if names:
        values = {x.name: float(x.value or 0.0) for x in module.parameters}
        rows = [{**values, **point.p} for point in points]
        written.arguments["p"] = tuple(tuple(row[name] for name in names) for row in rows)
    untested = _untested({program.name for _, program, _ in compared}, module)
    return Vectors(len(points), written.arguments, written.values, tuple(expected), untested, names)


class _Written:
    """Arguments and results at some states, each computed once."""

    def __init__(self, points: Sequence[Point]) -> None:
        """Start without arguments and results."""
        self._points = points
        self.arguments: dict[str, tuple[tuple[float, ...], ...]] = {}
        self.values: dict[str, Values] = {}
        self.parametric = False

    def given(self, program: Program | Routine, keys: Mapping[str, str]) -> tuple[str, ...]:
        """Key of each argument of a function."""
        names = [argument.name for argument in program.arguments]
        self.parametric = self.parametric or bool({"p", CONSTANTS} & {*names})
        found = tuple(keys.get(name, name) for name in names if name != "p")
        for key in found:
            if not key.startswith(RETURNED) and key != CONSTANTS:
                self.arguments[key] = tuple(_argument(point, key) for point in self._points)
        return found

    def results(
        self, program: Program | Routine, made: Mapping[str, Callable[[Point], Valued]]
    ) -> tuple[str, ...]:
        """Key of each result of a function; empty where it is not compared."""
        for result in program.results:
            if result.name in made:
                source = made[result.name]
                self.values[_key(source)] = _values(self._points, source, result.shape)
        return tuple(_key(made[r.name]) if r.name in made else "" for r in program.results)


def _compared(
    register: Mapping[str, Reference], module: Module
) -> list[tuple[str, Program | Routine, Reference]]:
    """The comparisons: label, function and reference, in emitted order."""
    found = []
    handed = {program.handed for program in module.programs}
    for program in module.programs:
        # A function that takes the constants of prepare is either called by the one without or has its own
        # text.
        name = program.name.removesuffix(PREPARED_SUFFIX)
        twin = PREPARED_SUFFIX * (name != program.name)
        for label, reference in register.items():
            own = (reference.function or label) == name and _returns(program)
            whole = all(r.name in reference.results for r in program.results)
            if own and program.name not in handed and (whole or reference.then):
                found.append((label + twin, program, reference))
    return found


def _asked(program: Program | Routine, reference: Reference) -> Asked:
    """The results that must be defined at a state for this comparison."""
    made = {
        r.name: reference.results[r.name] for r in program.results if r.name in reference.results
    }
    for after in reference.then:
        made |= after.results
    return made


def _returns(program: Program | Routine) -> bool:
    """Whether there is anything to compare: q̇ of a model without coordinates is empty."""
    return any(0 not in result.shape for result in program.results)


def _untested(compared: set[str], module: Module) -> tuple[tuple[str, str], ...]:
    handed = {program.handed for program in module.programs}

    def why(program: Program | Routine) -> str:
        if program.name in handed:
            return HANDED
        own = program.name.removesuffix(PREPARED_SUFFIX)
        return UNTESTED.get(own, NO_ROUTE) if _returns(program) else EMPTY

    return tuple((p.name, why(p)) for p in module.programs if p.name not in compared)


def _key(made: Callable[[Point], Valued]) -> str:
    return made.__name__.lstrip("_")


def _argument(point: Point, key: str) -> tuple[float, ...]:
    if key == "t":
        return (point.t,)
    return tuple(getattr(point, key))


def _values(
    points: Sequence[Point],
    made: Callable[[Point], Valued],
    shape: tuple[int, ...],
) -> Values:
    """One result at all states, and for each entry the scale: its largest size over the states.

    At a loud state the scale is the size there, if that is larger.
    """
    np = points[0].walk.np
    found = [made(point) for point in points]
    sizes = [np.maximum(np.abs(value), size).reshape(-1) for value, size in found]
    calm = [size for point, size in zip(points, sizes, strict=True) if not point.loud]
    most = np.max(calm, axis=0) if sizes[0].size else np.zeros(0)
    rows, loud = [], []
    for point, (value, _), size in zip(points, found, sizes, strict=True):
        scale = _scale(np.maximum(most, size) if point.loud else most)
        rows.append(tuple(map(_digits, value.reshape(-1).tolist(), scale)))
        if point.loud:
            loud.append(scale)
    return Values(shape, tuple(rows), _scale(most), tuple(loud))


def _scale(sizes: Any) -> tuple[float, ...]:
    return tuple(short(float(x) or 1.0, 3) for x in sizes)


def _digits(x: float, scale: float) -> float:
    """Round a number to the digits that its scale has: further ones are rounding. Never -0.0."""
    lowest = DIGITS - 1 - math.floor(math.log10(scale))
    return round(x, lowest) + 0.0

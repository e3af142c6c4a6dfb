"""Expressions in a model file: parsed and their names checked at once, evaluated later."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Any

from linegraph.algebra.formula import parse, variable_of
from linegraph.algebra.protocol import Floats
from linegraph.errors import ModelError
from linegraph.model.name_register import OWN, own_problem

if TYPE_CHECKING:
    from linegraph.algebra.formula import Formula
    from linegraph.readers.modelfile.report import Spot

LARGEST = 1e150
"""Limit of numbers: the square of a larger one would overflow."""


class Scope(IntEnum):
    """The names that an expression may use; each scope includes those before it."""

    NUMBERS = 0
    PARAMETERS = 1
    TIME = 2
    STATE = 3
    OUTPUT = 4
    NETWORK = 5
    LAW = 6


ALLOWED = {
    Scope.NUMBERS: "only numbers may stand here",
    Scope.PARAMETERS: "only numbers and parameters may stand here",
    Scope.TIME: "only numbers, parameters and the time t may stand here",
    Scope.STATE: "numbers, parameters, t, inputs, coordinates and their rates der(...) may stand here",
    Scope.OUTPUT: "variables of edges, numbers, parameters, t, inputs, coordinates and their rates may "
    "stand here",
    Scope.NETWORK: "variables of edges, the component's own, numbers, parameters, t, inputs, coordinates "
    "and their rates may stand here",
    Scope.LAW: "x, v, numbers, parameters, t, inputs, coordinates and their rates may stand here",
}


@dataclass
class Names:
    """The names that a file declares, as far as it has been read.

    Attributes:
        parameters: values of parameters; None where a value could not be calculated.
        inputs: named inputs.
        coordinates: coordinates of the joints read so far.
        several: joints with several coordinates, and these coordinates.
        terminals: bodies and frames, each with its body.
        joints: all joints of the file with their numbers of freedoms; None while unknown.
        elements: force elements.
        constraints: constraints with edges.
        components: components of networks, with their types.
        domains: domains defined in the file.
        incomplete: True if a joint is wrong, so that not all coordinates are known.
        owners: for names that element laws use themselves, the other thing of that name with its line.
        shared: a name that means the same number in the present element and outside of it.
    """

    parameters: dict[str, float | None] = field(default_factory=dict)
    inputs: set[str] = field(default_factory=set)
    coordinates: set[str] = field(default_factory=set)
    several: dict[str, list[str]] = field(default_factory=dict)
    terminals: dict[str, str] = field(default_factory=dict)
    joints: dict[str, int | None] = field(default_factory=dict)
    elements: set[str] = field(default_factory=set)
    constraints: set[str] = field(default_factory=set)
    components: dict[str, str] = field(default_factory=dict)
    domains: set[str] = field(default_factory=set)
    incomplete: bool = False
    owners: dict[str, str] = field(default_factory=dict)
    shared: str = ""

    def known(self, scope: Scope) -> list[str]:
        """All names that may be used in a scope."""
        names: list[str] = list(self.parameters) if scope >= Scope.PARAMETERS else []
        if scope >= Scope.TIME:
            names.append("t")
        if scope >= Scope.STATE:
            names += [*self.inputs, *self.coordinates]
        if scope >= Scope.LAW:
            names += ["x", "v"]
        return list(dict.fromkeys(names))


def read_expression(
    text: str, scope: Scope, spot: Spot, names: Names, own: tuple[str, ...] = ()
) -> Formula | None:
    """Parse an expression and check its names.

    Args:
        text: the expression.
        scope: the names it may use.
        spot: its place in the file, where errors are noted.
        names: the names that the file declares.
        own: further names with a meaning here, such as those of the component.

    Returns:
        The parsed expression; None after errors were noted.
    """
    if not text.strip():
        spot.error("is empty; give a number or an expression")
        return None
    try:
        formula = parse(text)
    except ModelError as error:
        spot.error(error.problem)
        return None
    wrong = [
        _own_problem(name, names) if name in own else _problem(name, scope, spot, names)
        for name in dict.fromkeys(formula.names())
    ]
    problems = [problem for problem in wrong if problem]
    for problem in problems:
        spot.error(problem)
    return None if problems else formula


def _own_problem(name: str, names: Names) -> str:
    if not _declared(name, names) or name == names.shared:
        return ""
    owner = _owner(name, names)
    return f'"{name}" is of the component itself here, but {owner} has this name too; rename that'


def _problem(name: str, scope: Scope, spot: Spot, names: Names) -> str:
    """Why a name is not allowed in an expression; empty if it is."""
    variable = variable_of(name)
    if variable is not None:
        return _variable_problem(variable, scope, spot, names)
    inner = name[4:-1] if name.startswith("der(") else name
    rate = inner != name
    if rate and scope >= Scope.STATE:
        if inner in names.coordinates or names.incomplete:
            return ""
        several = _several(inner, names)
        hint = several or spot.report.hint(inner, sorted(names.coordinates))
        return f'{name}: there is no coordinate "{inner}"{hint}'
    if not rate and scope >= Scope.LAW and name in OWN and _declared(name, names):
        return "" if name == names.shared else own_problem(name, _owner(name, names))
    if not rate and name in names.known(scope):
        return ""
    if rate or name in ("t", "x", "v") or _declared(name, names):
        return f"{name} cannot stand here: {ALLOWED[scope]}"
    # The name may be a coordinate of a joint that is wrong itself; that joint's error is enough.
    if names.incomplete and scope >= Scope.STATE:
        return ""
    hint = (
        _several(name, names)
        or _rate_meant(name, scope, names)
        or spot.report.hint(name, names.known(scope))
    )
    return f'there is no "{name}"{hint}'


def _rate_meant(name: str, scope: Scope, names: Names) -> str:
    """Advice for a name that looks like the rate of a coordinate: ``x_dot``, ``dx``, ``xdot``."""
    for inner in (name.removesuffix("_dot"), name.removesuffix("dot"), name.removeprefix("d")):
        own = scope >= Scope.LAW and inner == "x"
        if inner != name and scope >= Scope.STATE and (own or inner in names.coordinates):
            ways = ["v for the element's own rate"] if scope >= Scope.LAW else []
            ways += [f"der({inner}) for the rate of {inner}"] if inner in names.coordinates else []
            return f"; write {' or '.join(ways)}"
    return ""


def _owner(name: str, names: Names) -> str:
    return names.owners.get(name, "something else")


def _variable_problem(
    variable: tuple[str, str, str], scope: Scope, spot: Spot, names: Names
) -> str:
    """Why a variable of an edge or point is not allowed in an expression; empty if it is."""
    kind, thing, _ = variable
    if scope >= Scope.STATE and kind in ("across", "through"):
        if thing.partition(".")[0] in names.components:
            return ""
        if scope == Scope.NETWORK:
            hint = spot.report.hint(thing, sorted(names.components))
            return f'{kind}: there is no component "{thing}"{hint}'
    if scope != Scope.OUTPUT:
        return f"{kind}({thing}) can stand in [outputs] only"
    if kind in ("across", "through"):
        known, what = {*names.elements, *names.components}, "force element or component"
    elif kind in ("force", "torque"):
        known, what = {*names.joints, *names.constraints}, "joint or constraint"
    else:
        bodies = {f"{body}.mass_center" for body in names.terminals.values()}
        known, what = {*names.terminals, *bodies}, "body or frame"
    if thing in known:
        return ""
    return f'{kind}: there is no {what} "{thing}"{spot.report.hint(thing, sorted(known))}'


def _several(name: str, names: Names) -> str:
    if name not in names.several:
        return ""
    return f'; joint "{name}" has the coordinates {", ".join(names.several[name])}'


def _declared(name: str, names: Names) -> bool:
    return name in names.parameters or name in names.inputs or name in names.coordinates


def value_of(formula: Formula, names: Names, spot: Spot) -> float | None:
    """Evaluate an expression for the file's own parameter values.

    An expression without a finite value is reported now, with its line, not when the model is derived.

    Args:
        formula: the expression.
        names: the names that the file declares, with values of parameters.
        spot: its place in the file, where errors are noted.

    Returns:
        The value; None if a parameter has none, or after an error was noted.
    """
    needed = set(formula.names())
    known = {name: names.parameters.get(name) for name in needed}
    if any(value is None for value in known.values()):
        return None
    try:
        value = float(formula.evaluate(Floats(), known))
    except ModelError as error:
        spot.error(error.problem)
        return None
    except (ArithmeticError, ValueError):
        value = math.inf
    except TypeError:  # the square root of a negative number, to a power
        value = math.nan
    if not math.isfinite(value):
        spot.error("has no finite value for the parameters' values")
        return None
    return value


def number_problem(value: Any) -> str:
    """Why a plain number cannot be used: not finite or too large; empty if it can."""
    if isinstance(value, float) and not math.isfinite(value):
        return f"{value} is not a finite number"
    if abs(value) > LARGEST:
        return f"the number is too large; at most {LARGEST:g} can be calculated with"
    return ""

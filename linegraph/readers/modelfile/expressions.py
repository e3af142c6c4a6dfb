"""Expressions in a file: parsed when read, their names looked up at once, evaluated later."""

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
"""Larger numbers overflow when squared."""


class Scope(IntEnum):
    """What an expression may name; each includes those before it."""

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
    """What a file declares, as far as it has been read.

    Attributes:
        parameters: their values; None where it could not be calculated.
        inputs: the named inputs.
        coordinates: of every joint read so far.
        several: joints with several coordinates, and these.
        terminals: bodies and frames, with the body each is of.
        joints: every joint of the file and how many freedoms it has; None while that is not known.
        elements: the force elements.
        constraints: the constraints with edges.
        components: the components of networks, by type.
        domains: the subspaces that the file adds.
        incomplete: a joint is wrong, so that not all coordinates are known.
        owners: what else may own a name that an element's law has for itself: what it is, and its line.
        shared: what of these is one and the same number in the element that is read now.
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
        """All that may be named in a scope."""
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
    """The expression, if it can stand here; None after its errors are noted.

    `own` are further names that mean something here.
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
    """Why a name cannot stand in an expression; empty if it can."""
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
    if names.incomplete and scope >= Scope.STATE:
        return ""
    hint = (
        _several(name, names)
        or _rate_meant(name, scope, names)
        or spot.report.hint(name, names.known(scope))
    )
    return f'there is no "{name}"{hint}'


def _rate_meant(name: str, scope: Scope, names: Names) -> str:
    """How to write what looks like the rate of a coordinate: ``x_dot``, ``dx``, ``xdot``."""
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
    """Why a variable of an edge or a point cannot stand in an expression."""
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
    """The value for the parameters' own values; None where it is unknown or was refused.

    An expression that cannot be calculated for the file's own numbers is a mistake: better said now.
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
    """Why a plain number cannot be used; empty if it can."""
    if isinstance(value, float) and not math.isfinite(value):
        return f"{value} is not a finite number"
    if abs(value) > LARGEST:
        return f"the number is too large; at most {LARGEST:g} can be calculated with"
    return ""

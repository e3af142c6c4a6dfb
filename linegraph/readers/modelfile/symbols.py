"""Parameters, inputs and outputs of a model file, and angles of frames that depend on parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.algebra.formula import parse
from linegraph.errors import MOST_PRINTED, ModelError
from linegraph.readers.modelfile.expressions import Names, value_of
from linegraph.readers.modelfile.kinds import WRONG, said
from linegraph.readers.modelfile.names import symbol_problem
from linegraph.readers.modelfile.tables import INPUT, OUTPUT, PARAMETER

if TYPE_CHECKING:
    from linegraph.model.builder import Model
    from linegraph.readers.modelfile.report import Spot


MOST_PARAMETERS = 5000
LONGEST_CIRCLE = 8
"""Largest number of names shown of a circular definition."""


def read_parameters(tables: Any, spot: Spot, names: Names, model: Model) -> None:
    """Declare the parameters; each may depend on those before it.

    Args:
        tables: the content of ``[parameters]``; ignored if it is no table, which is reported elsewhere.
        spot: the place of the table, where errors are noted.
        names: the names that the file declares; values are added.
        model: receives the parameters.
    """
    if not isinstance(tables, dict):
        return
    if len(tables) > MOST_PARAMETERS:
        spot.error(f"has more than {MOST_PARAMETERS} parameters")
        return
    wanted = {name: _used(_value(given)) for name, given in tables.items()}
    for name, given in tables.items():
        place = spot.at(name)
        problem = symbol_problem(name) or _order_problem(
            name, wanted, names, place.report.count < MOST_PRINTED
        )
        found: Any = WRONG
        if problem:
            place.error(problem)
        elif isinstance(given, dict):
            found = PARAMETER.read(given, place, names)
        else:
            value = PARAMETER.fields["value"].kind.read(given, place, names)
            found = WRONG if value is WRONG else {"value": value}
        names.parameters[name] = None
        # A parameter that depends on a wrong one is not wrong itself, and gets no error.
        if found is not WRONG and model.parameters.keys() >= set(wanted[name]):
            model.parameter(name, **found)
            names.parameters[name] = _number(found["value"], place, names)


def _value(given: Any) -> Any:
    return given.get("value") if isinstance(given, dict) else given


def _used(value: Any) -> list[str]:
    """Names in a value, if it is a valid expression."""
    try:
        return list(dict.fromkeys(parse(value).names())) if isinstance(value, str) else []
    except ModelError:
        return []


def _order_problem(name: str, wanted: dict[str, list[str]], names: Names, thorough: bool) -> str:
    """Why a parameter cannot be used before its declaration; empty if all come before."""
    later = [used for used in wanted[name] if used in wanted and used not in names.parameters]
    if not later:
        return ""
    circle = _circle(name, wanted) if thorough else []
    if len(circle) == 1:
        return "depends on itself"
    if circle:
        way = circle[:LONGEST_CIRCLE] + ["..."] * (len(circle) > LONGEST_CIRCLE)
        return f"depends on itself: {' -> '.join([*way, name])}"
    return f"depends on {later[0]}, which is declared later; move that up"


def _circle(name: str, wanted: dict[str, list[str]]) -> list[str]:
    """A chain of definitions from a parameter back to itself; empty if there is none."""
    before: dict[str, str] = {}
    ahead = [name]
    while ahead:
        here = ahead.pop()
        for used in wanted.get(here, ()):
            if used == name:
                way = [here]
                while way[-1] != name:
                    way.append(before[way[-1]])
                return way[::-1]
            if used not in before:
                before[used] = here
                ahead.append(used)
    return []


def _number(value: Any, spot: Spot, names: Names) -> float | None:
    """Value of a parameter for the file's own numbers; None after errors were noted."""
    if not isinstance(value, str):
        return float(value)
    return value_of(parse(value), names, spot)


def read_inputs(tables: Any, spot: Spot, names: Names, model: Model) -> None:
    """Declare the named inputs.

    Args:
        tables: the content of ``[inputs]``; ignored if it is no table, which is reported elsewhere.
        spot: the place of the table, where errors are noted.
        names: the names that the file declares; inputs are added.
        model: receives the inputs.
    """
    if not isinstance(tables, dict):
        return
    for name, given in tables.items():
        place = spot.at(name)
        problem = symbol_problem(name)
        if problem:
            place.error(problem)
        elif not isinstance(given, dict):
            place.error(f'a table is wanted, such as {{ unit = "N" }}, not {said(given)}')
        else:
            found = INPUT.read(given, place, names)
            if found is not WRONG:
                model.input(name, **found)
        names.inputs.add(name)


def read_outputs(tables: Any, spot: Spot, names: Names, model: Model) -> None:
    """Declare the outputs: expressions that emitted code returns by name.

    Args:
        tables: the content of ``[outputs]``; ignored if it is no table, which is reported elsewhere.
        spot: the place of the table, where errors are noted.
        names: the names that the file declares.
        model: receives the outputs.
    """
    if not isinstance(tables, dict):
        return
    for name, given in tables.items():
        place = spot.at(name)
        problem = symbol_problem(name)
        if problem:
            place.error(problem)
            continue
        table = given if isinstance(given, dict) else {"value": given}
        found = OUTPUT.read(table, place, names)
        if found is not WRONG:
            model.output(name, **found)


def rotation_value(value: Any) -> Any:
    """An angle or a tuple of angles for the builder.

    Expressions become SymPy expressions, because the rotation matrix needs their sines and cosines.
    """
    if isinstance(value, tuple):
        return tuple(rotation_value(x) for x in value)
    if not isinstance(value, str):
        return value
    import sympy

    from linegraph.algebra.sympy_scalars import Sympy

    formula = parse(value)
    return formula.evaluate(Sympy(), {name: sympy.Symbol(name) for name in formula.names()})

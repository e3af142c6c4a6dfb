"""Name the component whose law is undefined at every state tried, and advise how to bound the states."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph.algebra.formula import Formula, parse
from linegraph.components.parameters import names_in, resolver
from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph.numeric.derived import Derived
    from linegraph.numeric.reference import Numeric

BOUND = (
    "at all states that were tried; bound them where it is defined: [check] with inputs, coordinates, "
    "velocities or parameters = { NAME = [low, high] } or t = [low, high] in a model file, check_within(...) "
    "of a model in Python"
)


def undefined(derivation: Derived, error: ModelError, numeric: Numeric | None) -> ModelError:
    """Turn the error of a law that is defined at no state into one that names the component and the remedy.

    Args:
        derivation: the model.
        error: the error raised by the law; laws of networks raise it with an empty `thing`.
        numeric: the model at a state where the law was undefined, for its inputs, time and parameters; None
            where the model itself could not be evaluated.

    Returns:
        An error for the component, its message followed by `BOUND`.
    """
    thing, problem = error.thing, error.problem
    if not thing:
        thing, others = _owner(derivation, problem.partition("(")[0], numeric)
        problem += f" (it may also be of {', '.join(others)})" * bool(others)
    return ModelError(thing or f'model "{derivation.system.name}"', f"{problem}, {BOUND}")


def _owner(derivation: Derived, function: str, numeric: Numeric | None) -> tuple[str, list[str]]:
    """Find the component of a network whose law is undefined, and further candidates.

    Candidates are the components whose own expressions use the function that has no value. Of several,
    those remain whose expressions have no value for the given inputs, time and parameters.
    """
    candidates = [c for c in derivation.system.components if function in _used(c.values())]
    if len(candidates) > 1 and numeric is not None:
        certain = [c for c in candidates if _fails(numeric, c.values())]
        candidates = certain or candidates
    things = [f'{component.kind} "{component.name}"' for component in candidates]
    return (things[0], things[1:]) if things else ("", [])


def _fails(numeric: Numeric, values: tuple[Any, ...]) -> bool:
    """Whether any of some expressions has no value for the inputs, the time and the parameters."""
    known = {**numeric.parameters, **numeric.tree.layout.named_inputs, "t": numeric.t}
    for value in values:
        if names_in(value) <= known.keys():
            try:
                resolver(numeric.algebra, known)(value)
            except (ModelError, ArithmeticError):
                return True
    return False


def _used(values: tuple[Any, ...]) -> set[str]:
    """Names of the functions and operations in some expressions."""
    return {op for value in values for op in _operations(value)}


def _operations(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        value = parse(value)
    if isinstance(value, Formula):
        yield value.op
        for part in value.parts:
            if isinstance(part, Formula):
                yield from _operations(part)
    elif hasattr(value, "free_symbols"):
        yield from (str(f.func).lower() for f in value.atoms() | set(value.args))

"""Golden vectors: states of a model, and what its emitted functions must return there by another route.

The route is `bodywise`: Newton's and Euler's equations of every body, from derivatives of where it is, in
floats. What solves for accelerations is NumPy's. States obey what a state has to obey: quaternions have
length 1, loops are closed and velocities allowed, and every law is defined.
"""

from __future__ import annotations

import random
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from linegraph.assembly import consistent
from linegraph.errors import ModelError
from linegraph.golden.point import Kept, Point
from linegraph.golden.references import OF_BODIES, Reference, references
from linegraph.program import PREPARED_SUFFIX, Routine
from linegraph.vectors import Expected, Values, Vectors

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.derive import Derivation
    from linegraph.golden.walk import Valued
    from linegraph.program import Module, Program
    from linegraph.tips import NamedFrame

STATES = 10
"""How many states a model is asked at, that at rest included."""

TRIES = 40
"""How many states are drawn for one that is defined."""

DIGITS = 13
"""Digits of what is written: the tolerance is far above them, differences of machines are below."""

REACHES = (1.0, 0.3, 0.1, 0.03)
"""How far states of networks and inputs are from zero; the first that will do."""

EVEN = 300.0
"""What acts in a network may be this much larger at one state than at most."""

REGULAR = 1e4
"""Accelerations may be this much smaller than what they are made of; beyond, M is nearly singular."""

SOLVED = ("a", "A", "B", "da_dq", "da_dv", "da_du", "da_dp", "Lambda")
"""Results for which M is solved with."""

Asked = dict[str, "Callable[[Point], Valued]"]
"""The results of a function, and what gives them."""

UNTESTED = {
    "prepare": "the functions that take its constants are called by those that are compared",
    "algebraic_loop": "called by functions that are compared",
    "loop_equations": "called by functions that are compared",
    **dict.fromkeys(OF_BODIES, "what networks add to it is known by no independent route"),
    "constrained_slopes": "called by functions that are compared",
}
"""Why a function is not called by itself; of all others, that no independent route is known."""

NO_ROUTE = "there is no independent route to what it returns"
EMPTY = "it returns nothing here"
HANDED = "called by the function of its name without the ending"
TWIN = (
    "the function of its name without the ending, which is compared, from the constants of prepare"
)


def vectors(
    derivation: Derivation, module: Module, seed: int = 0, frames: Sequence[NamedFrame] = ()
) -> Vectors:
    """Golden vectors of all functions of a module that are known by another route.

    Args:
        derivation: the model.
        module: its functions as they are to be emitted.
        seed: of the random states.
        frames: whose kinematics are among the functions.

    Returns:
        States with arguments q (nq), v (nv), u (nu), a (nv) in SI units, and the results there.

    Raises:
        ModelError: none of the functions is known by another route, or no state is defined.

    Example:
        >>> from linegraph import Model, derive
        >>> from linegraph.programs import module_of
        >>> model = Model("pendulum")
        >>> bob = model.body("bob", mass=2.0, mass_center=(0, 0, -0.5))
        >>> _ = model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
        >>> derivation = derive(model)
        >>> module = module_of(derivation, "pendulum", folded=True, about=(), only=("mass_matrix",))
        >>> vectors(derivation, module).values["M"].rows[0]
        (0.5,)
    """
    register = references(frames, networks=derivation.formulation.network is not None)
    chosen = [p for p in module.programs if _known(register, p)]
    if not chosen:
        raise ModelError("tests", "nothing that is emitted is known by an independent route")
    draw = random.Random(seed)
    details: dict[str, Any] = {}
    for p in module.programs:
        details |= dict(p.details) if isinstance(p, Routine) else {}
    kept = Kept(*(tuple(details.get(key, ())) for key in ("s_at", "w_at", "d_at")))
    points = _points(derivation, draw, kept, [_asked(register, p) for p in chosen])
    expected, values = [], {}
    given: dict[str, tuple[tuple[float, ...], ...]] = {}
    for program in chosen:
        reference = register[program.name]
        names = [a.name for a in program.arguments if a.name != "p"]
        keys = [reference.given.get(name, name) for name in names]
        for key in keys:
            given[key] = tuple(_argument(point, key) for point in points)
        results = [(r.name, reference.results[r.name]) for r in program.results]
        for (_, made), result in zip(results, program.results, strict=True):
            values[_key(made)] = _values(points, made, result.shape)
        made_keys = tuple(_key(made) for _, made in results)
        expected.append(Expected(program.name, reference.route, tuple(keys), made_keys))
    return Vectors(len(points), given, values, tuple(expected), _untested(register, module))


def _known(register: Mapping[str, Reference], program: Program | Routine) -> bool:
    reference = register.get(program.name)
    if reference is None or any(r.name not in reference.results for r in program.results):
        return False
    return _returns(program)


def _asked(register: Mapping[str, Reference], program: Program | Routine) -> Asked:
    return {r.name: register[program.name].results[r.name] for r in program.results}


def _returns(program: Program | Routine) -> bool:
    """Whether there is anything to compare: q̇ of a model without coordinates is empty."""
    return any(0 not in result.shape for result in program.results)


def _untested(register: Mapping[str, Reference], module: Module) -> tuple[tuple[str, str], ...]:
    handed = {program.handed for program in module.programs}

    compared = {program.name for program in module.programs if _known(register, program)}

    def why(program: Program | Routine) -> str:
        if program.name in handed:
            return HANDED
        if program.name.removesuffix(PREPARED_SUFFIX) in compared:
            return TWIN
        return UNTESTED.get(program.name, NO_ROUTE) if _returns(program) else EMPTY

    return tuple((p.name, why(p)) for p in module.programs if not _known(register, p))


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
    """One result at all states, and for each entry the largest of what it is made of."""
    np = points[0].walk.np
    found = [made(point) for point in points]
    rows = tuple(tuple(_short(float(x)) for x in value.reshape(-1)) for value, _ in found)
    sizes = [np.maximum(np.abs(value), size).reshape(-1) for value, size in found]
    scale = np.max(sizes, axis=0) if sizes[0].size else np.zeros(0)
    return Values(shape, rows, tuple(_short(float(x) or 1.0, 3) for x in scale))


def _short(x: float, digits: int = DIGITS) -> float:
    return float(f"{x:.{digits}g}")


def _points(
    derivation: Derivation,
    draw: random.Random,
    kept: Kept,
    chosen: Sequence[Asked],
) -> list[Point]:
    """All states; those of networks so near zero that no exponential law dwarfs one state by another."""
    reaches = REACHES if derivation.formulation.network is not None else REACHES[:1]
    points: list[Point] = []
    for reach in reaches:
        try:
            found = [
                _point(derivation, draw, kept, chosen, reach, rest=k == 0) for k in range(STATES)
            ]
        except ModelError:
            if not points:
                raise
            break
        points = found
        if _even(points):
            break
    return points


def _even(points: Sequence[Point]) -> bool:
    """Whether what acts in networks is of the same size at all states, more or less."""
    np = points[0].walk.np
    first = points[0].walk.tree.layout.mechanical
    sizes = np.array([np.abs(point.bodies.bias[0][first:]) for point in points])
    return bool((sizes.max(axis=0) <= EVEN * np.median(sizes, axis=0)).all())


def _point(
    derivation: Derivation,
    draw: random.Random,
    kept: Kept,
    chosen: Sequence[Asked],
    reach: float,
    *,
    rest: bool,
) -> Point:
    """A state at which everything is defined, and nothing nearly singular."""
    first: ModelError | None = None
    for attempt in range(TRIES):
        # roots, logarithms and gaps want what is positive
        low = -1.0 if attempt % 2 == 0 else 0.2
        try:
            point = _drawn(derivation, draw, (low, reach), rest=rest and attempt < 2)
            point = replace(point, kept=kept)
            if _defined(point, chosen):
                return point
        except ModelError as error:
            first = first or error
        except (ArithmeticError, ValueError):
            continue
    if first is not None:
        raise first
    who = f'model "{derivation.model.name}"'
    raise ModelError(who, "no state was found at which all laws are defined and M is regular")


def _drawn(
    derivation: Derivation, draw: random.Random, within: tuple[float, float], *, rest: bool
) -> Point:
    """A state: at rest in mechanics, or a random one, on the constraints if there are any."""
    low, reach = within
    structure = derivation.structure
    first = structure.layout.mechanical

    def some(count: int, low: float = -1.0, reach: float = 1.0) -> list[float]:
        return [_short(reach * draw.uniform(low, 1.0)) for _ in range(count)]

    t = _short(draw.uniform(0.1, 1.0)) if derivation.model.depends_on_time else 0.0
    u = (
        [0.0] * len(structure.inputs)
        if rest and low < 0
        else some(len(structure.inputs), low, reach)
    )
    numeric = derivation.numeric(None, t, u)
    states = some(len(structure.velocities) - first, low, reach)
    v = [0.0] * first if rest else some(first)
    q = _at_rest(derivation) if rest else some(len(structure.positions), low)
    numeric.tree.normalise(q)
    if structure.closed:
        q, v = consistent(derivation, numeric, draw)
        if rest and not derivation.model.depends_on_time and not any(u):
            q, v = list(derivation.assembled.q), [0.0] * len(v)
        v, states = v[:first], v[first:] if not rest else states
    q, v = [_short(x, 15) for x in q], [_short(x, 15) for x in (*v, *states)]
    beside = [x + draw.uniform(-0.05, 0.05) for x in q]
    numeric.tree.normalise(beside)
    a, off = some(len(v)), some(len(v))
    return Point(derivation, t, u, q, v, a, [_short(x, 15) for x in beside], off)


def _at_rest(derivation: Derivation) -> list[float]:
    """Where the frames of all joints coincide."""
    q = [0.0] * len(derivation.structure.positions)
    for link in derivation.structure.links:
        places = link.place.positions
        for f, x in zip(places, link.joint.rest(), strict=False):
            q[f.index] = float(x)
    return q


def _defined(point: Point, chosen: Sequence[Asked]) -> bool:
    """Whether all is finite there, and accelerations are not what is left of far larger things."""
    np = point.walk.np
    for name, made in (pair for asked in chosen for pair in asked.items()):
        try:
            value, size = made(point)
            if not (np.isfinite(value).all() and np.isfinite(size).all()):
                return False
            if name in SOLVED and not _regular(np, *point.motion[0]):
                return False
            if name == "Lambda" and not _regular(np, value, size, least=0):
                return False
        except np.linalg.LinAlgError:
            return False
    return True


def _regular(np: Any, value: Any, size: Any, least: float = 1.0) -> bool:
    largest = least + np.abs(value).max(initial=0.0)
    return bool(size.max(initial=0.0) <= REGULAR * largest)

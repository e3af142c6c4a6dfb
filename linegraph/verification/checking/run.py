"""A check from the random states to the findings."""

from __future__ import annotations

import random
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from linegraph.dynamics.chords import equations
from linegraph.dynamics.regularity import cause
from linegraph.errors import ModelError
from linegraph.evaluation import loaded
from linegraph.model.system import placed
from linegraph.programs.register import module_of
from linegraph.verification.checking.balance import balances, unjudged_components
from linegraph.verification.checking.findings import (
    AUDIT,
    COMPONENTS,
    FLOATS,
    LOOPS,
    PAPER,
    POWER,
    PROGRAM,
    Comparison,
    Findings,
    Tally,
)
from linegraph.verification.checking.routes import _State
from linegraph.verification.golden.draws import SINGULAR, Asked, Drawing
from linegraph.verification.golden.point import Kept

if TYPE_CHECKING:
    from linegraph.evaluation import Function
    from linegraph.ir.program import Module
    from linegraph.numeric.derived import Derived
    from linegraph.verification.golden.point import Point

STATES = 12
"""Number of states of a check; at every second one parameters differ from the model's own values."""

NEARLY_SINGULAR = "at all states that were tried the mass matrix is nearly singular"


def check(derivation: Derived, seed: int = 0) -> Findings:
    """Compare the routes to the equations of motion at `STATES` random states.

    Args:
        derivation: the model.
        seed: seed of the random states.

    Returns:
        The comparisons, with differences relative to the terms of each number.

    Raises:
        ModelError: a law is defined at no state that was tried; names the law and its place in the file.
    """
    try:
        return _check(derivation, seed)
    except ModelError as error:
        raise placed(error, derivation.system) from None


def _check(derivation: Derived, seed: int) -> Findings:
    tree = derivation.structure
    # First, so that errors of structure are reported as such and not as laws that need bounds.
    module = module_of(derivation, "checked")
    points, moving = _points(derivation, seed)
    tally = Tally(_names(derivation))
    unjudged = _unjudged(derivation, moving=moving)
    driven = _driven(derivation)
    function = loaded(derivation, module, "forward_dynamics") if tree.closed and moving else None
    for place, point in enumerate(points):
        state = _State.at(point)
        tally.loud = place if point.loud else None
        _equations(tally, state, point, module)
        if not moving:
            continue
        _motion(tally, state, point, module, function)
        (a, _), (lam, _) = point.motion
        if not driven and tree.layout.mechanical:
            change, power, size = state.power_balance(a.tolist())
            tally.note(POWER, "rate of energy", change, power, size)
        sums = state.audit_sums(a.tolist(), lam.tolist())
        tally.note(AUDIT, "sums of through times across", sums, 0 * sums, point.edges.sums[1])
        for still in (point, replace(point, u=[0.0] * len(point.u)))[: 1 + bool(point.u)]:
            # Sources hide a store's own imbalance, so balances are checked without inputs, too.
            for name, (gain, size) in _balances(still).items():
                tally.note(COMPONENTS, f"power of {name}", gain, 0.0, size, alone=True)
    found = tally.comparisons()
    if tree.closed:
        found = (*found, _freedoms(derivation, points))
    return Findings(found, unjudged, len(points))


def _points(derivation: Derived, seed: int) -> tuple[list[Point], bool]:
    """States, and whether accelerations are known at them.

    Raises:
        ModelError: no admissible state was found; names the law that is undefined.
    """
    equations_: Asked = {"M": lambda p: p.bodies.mass_matrix, "h": lambda p: p.bodies.bias}
    solved: Asked = {"a": lambda p: p.motion[0]}
    # If M is nearly singular at all states, at least M and h can be compared.
    for moving in (False,) if derivation.idle else (True, False):
        asked = [equations_, solved] if moving else [equations_]
        drawing = Drawing(derivation, random.Random(seed), Kept(), asked)
        try:
            return drawing.points(STATES), moving
        except ModelError as error:
            if error.problem != SINGULAR or not moving:
                raise
    raise AssertionError


def _equations(tally: Tally, state: _State, point: Point, module: Module) -> None:
    """Compare M, h and τ of all routes with Newton's and Euler's equations."""
    (M, of_M), (h, of_h) = point.bodies.mass_matrix, point.bodies.bias
    routes: list[tuple[str, Any]] = [
        (PROGRAM, state.emitted(module)),
        (FLOATS, state.reference()),
    ]
    if not state.tree.levelled:
        routes.append((PAPER, state.printed()))
    for group, (other_M, other_h) in routes:
        tally.note(group, "M", other_M, M, of_M)
        tally.note(group, "h", other_h, h, of_h)
    (tau, of_tau) = point.inverse
    tally.note(PROGRAM, "M a + h", state.run(module, "inverse_dynamics")[0], tau, of_tau)


def _motion(
    tally: Tally, state: _State, point: Point, module: Module, function: Function | None
) -> None:
    """Compare emitted accelerations and multipliers, and the quantities they are solved from."""
    (a, of_a), (lam, of_lam) = point.motion
    if function is None:
        tally.note(PROGRAM, "accelerations", state.accelerations(module), a, of_a)
        return
    (J, of_J), (gam, of_gam) = point.closed.jacobian, point.closed.bias
    for group, (other_J, other_gam) in (
        (PROGRAM, [state.run(module, f"constraint_{x}")[0] for x in ("jacobian", "bias")]),
        (FLOATS, state.constraints()),
    ):
        tally.note(group, "J", other_J, J, of_J)
        tally.note(group, "gamma", other_gam, gam, of_gam)
    (M, of_M), (f, of_f) = point.bodies.mass_matrix, point.force
    stabilised, of_stabilised = point.stabilised
    parts = state.run(module, "constrained_equations")
    expected = ((M, of_M), (f, of_f), (J, of_J), (stabilised, of_stabilised))
    for what, found, (value, size) in zip(
        ("M", "Q - h", "J", "gamma"), parts, expected, strict=True
    ):
        tally.note(PROGRAM, f"{what} of the constrained equations", found, value, size)
    other_a, other_lam = state.constrained_motion(module, function)
    unique = [k for k, one in enumerate(point.derivation.assembled.unique) if one]
    tally.note(LOOPS, "accelerations", other_a, a, of_a)
    np = point.walk.np
    chosen = np.array(unique, int)
    tally.note(LOOPS, "multipliers", np.asarray(other_lam)[chosen], lam[chosen], of_lam[chosen])


def _balances(point: Point) -> dict[str, tuple[float, float]]:
    """Balances at a state; empty where laws are undefined without inputs."""
    try:
        return balances(point)
    except (ModelError, ArithmeticError):
        return {}


def _freedoms(derivation: Derived, points: list[Point]) -> Comparison:
    """Whether the assembly counts as many degrees of freedom as the rank of J leaves."""
    mechanical = derivation.structure.layout.mechanical
    expected = min(mechanical - point.rank for point in points)
    found = derivation.assembled.freedoms
    place = f"{found} by the assembly, {expected} by the places of the bodies"
    return Comparison(LOOPS, "number of freedoms", float(found != expected), place)


def _driven(derivation: Derived) -> bool:
    """Whether a prescribed motion does work."""
    layout = derivation.structure.layout
    return any(place.drive for place in layout.places.values()) or any(
        any(drives) for drives in layout.drives.values()
    )


def _unjudged(derivation: Derived, *, moving: bool) -> tuple[tuple[str, str], ...]:
    """Quantities that are not compared, each with the reason."""
    tree = derivation.structure
    found: list[tuple[str, str]] = []
    if tree.levelled:
        found.append(("paper's matrices", "they have no angles measured from ground"))
    if not moving:
        idle = derivation.idle
        why = f"M is singular, as {cause(idle)}" if idle else NEARLY_SINGULAR
        found.append(("accelerations and powers", why))
        return tuple(found)
    if tree.closed and not all(derivation.assembled.unique):
        names = [
            e.multiplier.name
            for e, one in zip(equations(tree), derivation.assembled.unique, strict=True)
            if not one
        ]
        found.append(("multipliers that are not unique", ", ".join(names)))
    if not tree.layout.mechanical:
        found.append(("power balance", "nothing moves"))
    elif _driven(derivation):
        found.append(("power balance", "prescribed motion does work"))
    found += [(f"power of {name}", why) for name, why in unjudged_components(derivation).items()]
    return tuple(found)


def _names(derivation: Derived) -> dict[str, list[str]]:
    """Names of the entries of each quantity."""
    tree = derivation.structure
    v = [quantity.name for quantity in tree.velocities]
    rows = [e.multiplier.name for e in equations(tree)]
    square, wide = ([f"{a}, {b}" for a in x for b in v] for x in (v, rows))
    unique = [
        name
        for name, one in zip(rows, derivation.assembled.unique if tree.closed else (), strict=False)
        if one
    ]
    ending = " of the constrained equations"
    return {
        "M": square,
        "h": v,
        "M a + h": v,
        "accelerations": v,
        "J": wide,
        "gamma": rows,
        "multipliers": unique,
        f"M{ending}": square,
        f"Q - h{ending}": v,
        f"J{ending}": wide,
        f"gamma{ending}": rows,
    }

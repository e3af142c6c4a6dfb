"""Newton's method for the algebraic loops of a network, in floats: the reference for emitted code.

A step is halved until the largest residual has fallen by enough. That suffices for most loops, but not where
a law is flat, as a saturation or a dead zone is, or has a kink that the step would have to cross. Then every
law of the loop gets a resistance in series and a conductance in parallel, which vanish level by level, each
level starting at the solution of the one before: a continuation method. Laws that rise become strictly
increasing and not too steep, so that each level has exactly one solution, which moves to that of the loop
itself.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.algebra.differentiation import Replay
from linegraph.algebra.protocol import Floats
from linegraph.errors import ModelError
from linegraph.networks.static import EASE, LOOP

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.algebra.differentiation import Symbol
    from linegraph.networks.network import Network

    Vector = list[float]
    Evaluate = Callable[[Vector, float, float], "_Point"]
    """The loop as a function of its unknowns and of the resistance and the conductance at its laws."""

MOST_STEPS = 200
MOST_HALVINGS = 40
DECREASE = 1e-4
"""The fraction of the decrease predicted by linearisation that a step must achieve."""

BEGINS = (0.0, 1.0, -1.0)
RESISTANCES = (1.0, 1e3, 1e-3)
"""Resistances (ohm, or the unit of the subspace) by which currents are compared with voltages."""

NEAR, NEARER = 0.01, 12
"""The start of the search with resistances; not zero, where roots are steep and powers flat. Where
exponentials overflow, a tenth of it is tried, up to so many times."""

LEVELS = 24
FIRST, RATIO = 0.5, 0.31622776601683794
"""The resistances of the first level, and the factor from each level to the next, 1/sqrt(10)."""

LEVEL_STEPS = 50
LEVEL_GAP = 1e-9
"""A level is solved when its residual has fallen to this fraction of its first value."""

MISSED, MOST_MISSED = 1e-3, 3
"""A level is missed if more than this fraction of its residual is left; so many in a row end the search."""

ROUNDING = 1e-13
"""A residual below this fraction of its terms is zero."""

PROBE_EASE, PROBE = 1e-8, 1e-6
"""The resistances that make a singular Jacobian regular, and the distance along its flattest direction at
which another solution is looked for."""


@dataclass(frozen=True)
class _Point:
    """The loop at given unknowns.

    Attributes:
        x: the unknowns.
        residual: of each law.
        jacobian: its derivatives with respect to the unknowns.
        sizes: of the terms of each residual.
    """

    x: Vector
    residual: Vector
    jacobian: list[Vector]
    sizes: Vector

    @property
    def gap(self) -> float:
        """The largest residual; infinite where one is not finite."""
        largest = max(map(abs, self.residual), default=0.0)
        return largest if all(map(math.isfinite, self.residual)) else math.inf

    @property
    def rounding(self) -> bool:
        """Whether all residuals are within the rounding of their terms."""
        pairs = zip(self.residual, self.sizes, strict=True)
        return all(abs(r) <= ROUNDING * size < math.inf for r, size in pairs)

    @property
    def solved(self) -> bool:
        """Whether the unknowns are a solution."""
        return self.gap == 0 or (self.rounding and self.gap < math.inf)

    @property
    def steep(self) -> bool:
        """Whether a slope is infinite, as that of a root at zero."""
        return not all(math.isfinite(x) for row in self.jacobian for x in row)

    def step(self, right: Vector) -> Vector | None:
        """The solution of ``jacobian step = right``; None if the Jacobian is singular."""
        import numpy as np

        try:
            found = np.linalg.solve(np.array(self.jacobian), np.array(right))
        except np.linalg.LinAlgError:
            return None
        return [float(x) for x in found] if np.all(np.isfinite(found)) else None


def solved(network: Network, known: Callable[[Symbol], float]) -> Vector:
    """Solve a network's algebraic loop for its unknowns.

    Args:
        network: with the loop.
        known: the value of every other symbol, given as (argument, place).

    Returns:
        One number for each of `network.loop_names`.

    Raises:
        ModelError: no solution was found, or it is not the only one.
    """
    evaluate = _evaluation(network, known)
    size = len(network.loop)
    for begin in BEGINS:
        found = _run(evaluate, [begin] * size, 0.0, 0.0)
        if found.solved:
            return _only(evaluate, found)
    for resistance in RESISTANCES:
        reached = _followed(evaluate, size, resistance)
        if reached is not None and reached.solved:
            return _only(evaluate, reached)
    raise ModelError("model", "the algebraic loop of its network has no solution here")


def _evaluation(network: Network, known: Callable[[Symbol], float]) -> Evaluate:
    """The loop as a function of its unknowns and of the resistance and the conductance at its laws."""
    size = len(network.loop)
    given = {symbol: known(symbol) for symbol in network.loop_needs}

    def known_of(symbol: Symbol) -> float:
        return given[symbol] if symbol in given else known(symbol)

    def evaluate(x: Vector, series: float, parallel: float) -> _Point:
        values = {(LOOP, k): value for k, value in enumerate(x)}
        values |= {(EASE, 0): series, (EASE, 1): parallel}
        replay = Replay(Floats(), lambda s: values[s] if s in values else known_of(s))
        try:
            residual = [float(replay(r)) for r in network.eased]
            slopes = [[float(replay(e)) for e in row] for row in network.eased_jacobian]
            sizes = [float(replay(e)) for e in network.loop_sizes]
        except (ModelError, ArithmeticError):
            return _Point(x, [math.inf] * size, [], [0.0] * size)
        return _Point(x, residual, slopes, sizes)

    return evaluate


def _run(evaluate: Evaluate, x: Vector, series: float, parallel: float) -> _Point:
    """Newton's method with halved steps, until it solves the loop or makes no more progress."""
    at = evaluate(x, series, parallel)
    eased = series > 0
    enough = LEVEL_GAP * at.gap if eased else 0.0
    for _ in range(LEVEL_STEPS if eased else MOST_STEPS):
        if not enough < at.gap < math.inf:
            break
        step = at.step([-r for r in at.residual])
        found = None if step is None else _nearer(evaluate, at, step, series, parallel)
        if found is None:
            break
        done = at.rounding and not eased and found.gap > at.gap / 2
        at = found
        # once all residuals are rounding, go on only while the largest is still halved
        if done:
            break
    return at


def _nearer(
    evaluate: Evaluate,
    at: _Point,
    step: Vector,
    series: float,
    parallel: float,
) -> _Point | None:
    """The end of a step, halved until the residual falls by enough; None if it never does."""
    length = 1.0
    for _ in range(MOST_HALVINGS):
        ahead = [a + length * b for a, b in zip(at.x, step, strict=True)]
        found = evaluate(ahead, series, parallel)
        # each row has a rounding level of its own: the largest residual need not fall when all reach theirs
        if series == 0 and found.solved and not at.solved:
            return found
        if not found.steep and found.gap <= (1 - DECREASE * length) * at.gap:
            return found
        length /= 2
    return None


def _followed(evaluate: Evaluate, size: int, resistance: float) -> _Point | None:
    """The solution reached as resistances at the laws vanish; None if levels in a row have no solution."""
    x = [NEAR * (1 + i / 8) for i in range(size)]
    ease = FIRST
    for _ in range(NEARER):
        if evaluate(x, ease * resistance, ease / resistance).gap < math.inf:
            break
        x = [value / 10 for value in x]
    missed = 0
    for _ in range(LEVELS):
        start = evaluate(x, ease * resistance, ease / resistance)
        found = _run(evaluate, x, ease * resistance, ease / resistance)
        missed = missed + 1 if found.gap > MISSED * start.gap else 0
        if missed == MOST_MISSED:
            return None
        x = found.x
        ease *= RATIO
    return _run(evaluate, x, 0.0, 0.0)


def _only(evaluate: Evaluate, found: _Point) -> Vector:
    """The solution, if there is no other one beside it.

    Where the Jacobian is singular, as at the zero of ``x abs(x)`` and within a dead zone, a next point in the
    direction in which the residual changes least tells a double root from a continuum of solutions.

    Raises:
        ModelError: there are others.
    """
    if found.steep or found.step(found.residual) is not None:
        return found.x
    eased = evaluate(found.x, PROBE_EASE, PROBE_EASE)
    flat = eased.step([size if size > 0 else 1.0 for size in found.sizes])
    if flat is not None:
        reach = max(abs(p) / (1 + abs(x)) for p, x in zip(flat, found.x, strict=True))
        for way in (PROBE, -PROBE):
            beside = [x + way * p / reach for x, p in zip(found.x, flat, strict=True)]
            if evaluate(beside, 0.0, 0.0).solved:
                break
        else:
            return found.x
    raise ModelError("model", "the algebraic loop of its network has several solutions here")

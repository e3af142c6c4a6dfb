"""Whether a mass matrix is regular: every velocity must move some inertia.

M, h, inverse dynamics, kinematics and pictures exist for every model; only functions that divide by M
need it to be regular. So nothing is refused until such a function is requested, and then all joints at
fault are named at once.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from typing import TYPE_CHECKING

from linegraph.dynamics.mass_matrix import composites, mass_matrix
from linegraph.errors import ModelError
from linegraph.kinematics.tree_state import TreeState

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from linegraph.kinematics.links import KinematicTree, Link
    from linegraph.model.system import System

    Entry = tuple[int, int, float]

SINGULAR = 1e-13
"""A pivot of M below this fraction of the terms it is the sum of is zero up to rounding."""

DUST = 1e-14
"""An arm below this fraction of the greatest length in a model is rounding."""


@dataclass(frozen=True)
class Idle:
    """A velocity that accelerates nothing, so that M is singular.

    Attributes:
        kind: of its component: ``joint``, ``capacitor``, ...
        name: of its component.
        moved: the link that the joint moves, or the quantity that the component should store.
    """

    kind: str
    name: str
    moved: str


def require_motion(tree: KinematicTree) -> None:
    """Refuse a model without states.

    Raises:
        ModelError: nothing moves, and nothing stores energy.
    """
    if not tree.velocities:
        raise ModelError(f'model "{tree.system.name}"', _nothing(tree.system))


def massless(tree: KinematicTree, added: Callable[[], Sequence[Entry]]) -> tuple[Idle, ...]:
    """The joints of an open tree that move no inertia of their own; with them locked, M is regular.

    If all bodies have mass and inertia in every direction, M is regular. Only otherwise is M factored,
    at two random states, so that no special position decides.

    Args:
        tree: the links in numbers.
        added: returns the entries that networks add to M, as (row, column, value); called only if
            bodies alone do not suffice.

    Raises:
        ModelError: a joint moves a negative mass or inertia.
    """
    if all(is_solid(link) for link in tree.links):
        return ()
    states = [_failing(tree, seed, ()) for seed in (1, 2)]
    if all(map(any, states)) and (more := added()):
        states = [_failing(tree, seed, more) for seed in (1, 2)]
    dust, negative = min(states, key=lambda failing: (len(failing[1]), len(failing[0])))
    if negative:
        raise _negative(link_of(tree, negative[0]))
    links = dict.fromkeys(link_of(tree, index).name for index in sorted(dust))
    by_name = {link.name: link for link in tree.links}
    return tuple(Idle("joint", by_name[name].joint.name, name) for name in links)


def refusal(
    idle: Sequence[Idle], functions: Sequence[str], *, closed: bool = False, asked: bool = True
) -> ModelError:
    """The error for functions that divide by a singular M: one message that names all joints at fault.

    Args:
        idle: the velocities that accelerate nothing; not empty.
        functions: those that divide by M.
        closed: whether there are loops, which restrict what may move.
        asked: whether the functions were requested by name, not just left out of a file.
    """
    first, kind = idle[0], idle[0].kind
    one = len(functions) == 1
    divide = f"divide{'s' * one} by it"
    if not asked:
        divide = f"which {divide}, {'is' if one else 'are'} left out"
    comma = "," * (not asked)
    singular = f"the mass matrix is singular, and {listed(functions)}{comma} {divide}"
    same = [x for x in idle if x.kind == kind] if kind == "joint" else idle
    others = same[1:]
    if kind != "joint":
        rest = [f'{x.moved} of {x.kind} "{x.name}"' for x in others]
        more = f", and neither {'has' if len(rest) == 1 else 'have'} {listed(rest)}" if rest else ""
        problem = (
            f"{first.moved} has no rate{more}: what stores it is zero for the parameters' values"
        )
        cure = "Leave the component out, or give it a value"
        return ModelError(f'{kind} "{first.name}"', f"{problem}, so {singular}. {cure}")
    own = "that the loops allow to move" if closed else "of its own"
    problem = f"moves no inertia {own} ({first.moved})"
    if others:
        rest = [f'"{x.name}" ({x.moved})' for x in others]
        problem += f", and neither do{'es' * (len(rest) == 1)} {listed(rest)}"
    cure = f"Give the bodies {'they carry' if others else 'it carries'} mass and inertia"
    if not closed:
        locks = " ".join(f"--lock {x.name}" for x in same)
        cure += f", or lock or fix the joint{'s' * bool(others)} ({locks})"
    return ModelError(f'joint "{first.name}"', f"{problem}: {singular}. {cure}")


def cause(idle: Sequence[Idle]) -> str:
    """The reason for a singular M, in one clause."""
    joints = [f'"{x.name}"' for x in idle if x.kind == "joint"]
    stores = [f'{x.moved} of {x.kind} "{x.name}"' for x in idle if x.kind != "joint"]
    one = len(joints) == 1
    parts = (
        [f"joint{'s' * (not one)} {listed(joints)} move{'s' * one} no inertia"] if joints else []
    )
    parts += [f"nothing stores {listed(stores)}"] if stores else []
    return " and ".join(parts)


def listed(names: Sequence[str]) -> str:
    """Names joined as in a sentence: "a, b and c"."""
    return ", ".join(names[:-1]) + " and " * (len(names) > 1) + names[-1]


def _nothing(system: System) -> str:
    """The message for a model without states."""
    if not system.components:
        return "no joint can move: there is nothing to derive"
    return "has no state: nothing in it moves or stores energy, so there is nothing to integrate"


def _negative(link: Link) -> ModelError:
    """The error for a link with a negative mass or inertia."""
    problem = f"moves a mass or inertia that is negative ({link.name})"
    return ModelError(
        f'joint "{link.joint.name}"', f"{problem}: the mass matrix is not positive definite"
    )


def is_solid(link: Link) -> bool:
    """Whether mass and central inertia are positive, with a margin, and the joint's freedoms independent.

    The leading minors of the central inertia must be positive (Sylvester's criterion).
    """
    m, (x, y, z), *_ = link.moments
    xx, xy, xz, yy, yz, zz = link.moments.inertia
    if m <= 0 or link.joint.singular:
        return False
    cx, cy, cz = x / m, y / m, z / m
    a = xx - m * (cy * cy + cz * cz)
    b = yy - m * (cx * cx + cz * cz)
    c = zz - m * (cx * cx + cy * cy)
    d, e, f = xy + m * cx * cy, xz + m * cx * cz, yz + m * cy * cz
    least = 1e-9 * max(xx, yy, zz)
    minor = a * b - d * d
    volume = c * minor - a * f * f - b * e * e + 2 * d * e * f
    return bool(a > least and minor > least * a and volume > least * minor)


def _failing(tree: KinematicTree, seed: int, added: Sequence[Entry]) -> tuple[list[int], list[int]]:
    """The velocities at which the factorisation of M from the leaves fails, at a random state."""
    draw = random.Random(seed)
    q = [draw.uniform(-1, 1) for _ in tree.positions]
    tree.normalise(q)
    state = TreeState(tree, q, [0.0] * len(tree.velocities))
    rows = [list(row) for row in mass_matrix(state)]
    scales = _scales(state)
    outward = tree.outward[: tree.layout.mechanical]
    for i, j, entry in added:
        if max(i, j) < tree.layout.mechanical:
            rows[i][j] += entry
            scales[i] += abs(entry) * (i == j)
    return _failing_pivots(rows, scales, outward)


def _scales(state: TreeState) -> list[float]:
    """The inertia of each velocity in the worst direction: the scale by which a pivot is judged zero.

    It is that of a turn about any axis through the joint, with all mass at its actual distance, plus
    that of a shift of all mass. Arms that are rounding relative to the model's lengths count as zero.
    """
    tree = state.tree
    scales = [0.0] * len(tree.velocities)
    arm = DUST * _reach(tree)
    for link, cross, moments in zip(tree.links, state.arms, composites(state), strict=True):
        xx, _, _, yy, _, zz = moments.inertia
        mass, first = abs(moments.mass), math.hypot(*moments.first)
        turning = abs(xx) + abs(yy) + abs(zz) + mass * arm * arm / SINGULAR
        for a, freedom in enumerate(link.velocities):
            w, u = math.hypot(*cross.motion.angular[a]), math.hypot(*cross.motion.linear[a])
            size = w * w * turning + 2 * w * u * first + u * u * mass
            scales[freedom.index] += freedom.ratio**2 * size
    return scales


def _reach(tree: KinematicTree) -> float:
    """The greatest length in a model (m): an arm between joints, or from a joint to a mass centre."""
    arms = [math.hypot(*link.at) for link in tree.links]
    masses = [link.moments for link in tree.links if link.moments.mass]
    arms += [math.hypot(*m.first) / abs(m.mass) for m in masses]
    return max(arms)


def _failing_pivots(
    m: list[list[float]], scales: list[float], outward: list[int]
) -> tuple[list[int], list[int]]:
    """Factor M = Lᵀ D L from the leaves: the pivots that are rounding, and the first negative one.

    As long as no pivot is negative, a zero pivot has a zero row beside it; it is left out, and the rest
    is factored as if its coordinate were locked.
    """
    m = [list(row) for row in m]
    dust: list[int] = []
    for place in reversed(range(len(outward))):
        k = outward[place]
        pivot = m[k][k]
        if pivot < -SINGULAR * scales[k]:
            return dust, [k]
        if not pivot > SINGULAR * scales[k]:
            dust.append(k)
            continue
        for i in outward[:place]:
            factor = m[k][i] / pivot
            for j in outward[:place]:
                m[i][j] -= factor * m[k][j]
    return dust, []


def link_of(tree: KinematicTree, index: int) -> Link:
    """The link that a velocity moves.

    Args:
        tree: the links.
        index: place of the velocity in v; one of mechanics.
    """
    for link in tree.links:
        if any(freedom.index == index for freedom in link.velocities):
            return link
    raise AssertionError("every velocity belongs to a joint")

"""Whether a mass matrix can be inverted: every coordinate must move some inertia."""

from __future__ import annotations

import math
import random
from typing import TYPE_CHECKING

from linegraph.algebra import Floats
from linegraph.errors import ModelError
from linegraph.mass_matrix import composites, mass_matrix
from linegraph.orthogonality import arms
from linegraph.parameters import sample_values
from linegraph.walk import kinematic_tree

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.formulation import Formulation
    from linegraph.joints import Moments
    from linegraph.kinematics import KinematicTree, Link
    from linegraph.model import Model
    from linegraph.orthogonality import Arm

SINGULAR = 1e-13
"""A pivot of M below this fraction of what it was made of is zero up to rounding."""

DUST = 1e-14
"""An arm of this fraction of the greatest length in a model is rounding."""


def require_regular(model: Model, formulation: Formulation) -> None:
    """Refuse a model one of whose coordinates moves no inertia.

    Bodies with mass and inertia in every direction make M regular by themselves; only where some body
    lacks them is M factored, at two random states, so that no special position decides.

    Raises:
        ModelError: names the joint.
    """
    tree = sample_tree(model, formulation)
    if not tree.velocities:
        raise ModelError(f'model "{model.name}"', _nothing(model))
    if tree.closed or all(is_solid(link) for link in tree.links):
        return  # with constraints, whether M is regular on the motions they allow is asked at assembly
    failures = [_first_dependent(tree, seed) for seed in (1, 2)]
    if all(failures):
        index, pivot = failures[-1] or (0, 0.0)
        raise _refusal(_link_of(tree, index), pivot)


def sample_tree(model: Model, formulation: Formulation) -> KinematicTree:
    """The links in numbers: the parameters' own values where they have some, any time, any inputs."""
    anywhere = Floats(t=0.37, u=_Anything())
    values = sample_values(model.parameters.values(), anywhere)
    return kinematic_tree(model, formulation, anywhere, values)


def _nothing(model: Model) -> str:
    """What to tell of a model without states."""
    if not model.components:
        return "no joint can move: there is nothing to derive"
    return "has no state: nothing in it moves or stores energy, so there is nothing to integrate"


def _refusal(link: Link, pivot: float) -> ModelError:
    """What to tell of a link that a coordinate moves without inertia, or with less than none."""
    who = f'joint "{link.joint.name}"'
    if pivot < 0:
        problem = f"moves a mass or inertia that is negative ({link.name})"
        return ModelError(who, f"{problem}: the mass matrix is not positive definite")
    problem = (
        f"moves no inertia of its own ({link.name}): the mass matrix is singular. Give the bodies it "
        "carries mass and inertia, or lock or fix the joint"
    )
    return ModelError(who, problem)


class _Anything:
    """Inputs at which regularity is judged: it does not depend on them, but motions may."""

    def __getitem__(self, place: int) -> float:
        return 0.1 + 0.07 * place


def is_solid(link: Link) -> bool:
    """Whether mass and central inertia are positive, with a margin, and the joint's freedoms independent."""
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


def _first_dependent(tree: KinematicTree, seed: int) -> tuple[int, float] | None:
    """The coordinate at which the factorisation of M from the leaves fails, and its pivot; or None."""
    draw = random.Random(seed)
    q = [draw.uniform(-1, 1) for _ in tree.positions]
    tree.normalise(q)
    crossed = arms(tree, Floats(), q, [0.0] * len(tree.velocities))
    rows = mass_matrix(tree, Floats(), crossed)
    outward = tree.outward[: tree.layout.mechanical]
    return _failing_pivot(
        rows, _scales(tree, crossed, composites(tree, Floats(), crossed)), outward
    )


def _scales(tree: KinematicTree, crossed: Sequence[Arm], carried: list[Moments]) -> list[float]:
    """What each coordinate's inertia would be in the worst direction: zero is judged beside it.

    A turn about any axis through the joint, with the mass as far from it as it is, and a shift of all mass.
    An arm that is rounding beside the model's own lengths is none.
    """
    scales = [0.0] * len(tree.velocities)
    arm = DUST * _reach(tree)
    for link, cross, moments in zip(tree.links, crossed, carried, strict=True):
        xx, _, _, yy, _, zz = moments.inertia
        mass, first = abs(moments.mass), math.hypot(*moments.first)
        turning = abs(xx) + abs(yy) + abs(zz) + mass * arm * arm / SINGULAR
        for a, freedom in enumerate(link.velocities):
            w, u = math.hypot(*cross.motion.angular[a]), math.hypot(*cross.motion.linear[a])
            size = w * w * turning + 2 * w * u * first + u * u * mass
            scales[freedom.index] += freedom.ratio**2 * size
    return scales


def _reach(tree: KinematicTree) -> float:
    """The greatest length in a model: an arm from joint to joint or to a mass centre."""
    arms = [math.hypot(*link.at) for link in tree.links]
    masses = [link.moments for link in tree.links if link.moments.mass]
    arms += [math.hypot(*m.first) / abs(m.mass) for m in masses]
    return max(arms)


def _failing_pivot(
    m: list[list[float]], scales: list[float], outward: list[int]
) -> tuple[int, float] | None:
    """M = L^T D L from the leaves to the root: the first pivot that is not positive, 0.0 for dust."""
    m = [list(row) for row in m]
    for place in reversed(range(len(outward))):
        k = outward[place]
        pivot = m[k][k]
        if not pivot > SINGULAR * scales[k]:
            return k, pivot if pivot < -SINGULAR * scales[k] else 0.0
        for i in outward[:place]:
            factor = m[k][i] / pivot
            for j in outward[:place]:
                m[i][j] -= factor * m[k][j]
    return None


def _link_of(tree: KinematicTree, index: int) -> Link:
    for link in tree.links:
        if any(freedom.index == index for freedom in link.velocities):
            return link
    raise AssertionError("every velocity belongs to a joint")

"""The base parameters of a derivation: exact relations, and those that only numbers show."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, Any

from linegraph.algebra.protocol import Floats
from linegraph.algebra.sampled import WEAK, Traced, given
from linegraph.errors import ModelError
from linegraph.identification.base_parameters import BaseParameters
from linegraph.identification.regressor import Station, by_motions
from linegraph.identification.relations import PREFERRED, Member, Twist, null_vectors, without
from linegraph.identification.standard_parameters import MOMENTS, Axis, axes, homes, quantities
from linegraph.kinematics.tree_state import TreeState
from linegraph.spatial.placement import Placement
from linegraph.spatial.vector import negate

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.kinematics.links import KinematicTree, Link
    from linegraph.numeric.derived import Derived
    from linegraph.numeric.reference import Numeric

Array = Any

SAMPLES = 3
"""Number of random values of the model's parameters at which the geometry is tested for constants."""

SPREAD, TRIES = 0.5, 60
"""Largest relative change of parameters in a sample, and how many samples are tried."""

DUST = 1e-14
"""Rounding of entries of rotation matrices, and of lengths (m)."""

SINGULAR = 1e-10
"""Singular values below this fraction of the largest are zero, for columns scaled to unit length."""

TIMES = 12
"""Number of times at which a prescribed motion is evaluated."""

CONSTANT = 1e-7
"""Largest difference between samples of a factor that is constant."""

ROUNDING = 1e-13
"""Largest difference of such a factor from an integer that it is taken for."""


def base_parameters(
    derivation: Derived, of_model: Callable[[Mapping[str, float]], Any]
) -> BaseParameters:
    """The base parameters of a model.

    Args:
        derivation: the model.
        of_model: computes its standard parameters pi, in SI units, for given values of parameters.

    Returns:
        Names, units, K and the indices of independent and dependent parameters.

    Raises:
        ModelError: nothing moves; or coupled or prescribed motions make a relation whose coefficients
            depend on parameters of the model.
    """
    model, tree = derivation.system, derivation.structure
    if not tree.links:
        raise ModelError(
            f'model "{model.name}"', "has no links that move: it has no base parameters"
        )
    named = quantities(tree)
    samples = _samples(derivation)
    seen = axes(tree)
    links = _members(tree, [numeric.tree for numeric in samples], seen)
    gravity = _vector(tree.gravity, [numeric.tree.gravity for numeric in samples])
    vectors = null_vectors(links, gravity)
    vectors = _completed(derivation, samples, seen, vectors)
    dependent = tuple(sorted(vectors))
    independent = tuple(k for k in range(len(named)) if k not in vectors)
    row = {place: n for n, place in enumerate(independent)}
    entries = {
        (row[place], column): -_node(x)
        for column, pivot in enumerate(dependent)
        for place, x in vectors[pivot].items()
        if place != pivot
    }
    return BaseParameters(
        model.name,
        tuple(quantity.name for quantity in named),
        tuple(quantity.unit for quantity in named),
        independent,
        dependent,
        tuple(pivot for pivot in dependent if len(vectors[pivot]) == 1),
        entries,
        derivation,
        of_model,
    )


def members_of(derivation: Derived, tree: KinematicTree, *, own_values: bool) -> list[Member]:
    """The links of a tree with the geometry that relations depend on.

    Args:
        derivation: the model.
        tree: its links over some DAG, where parameters are symbols or have the model's own values.
        own_values: whether they have the model's own values.

    Returns:
        One member for each link, parents first.
    """
    samples = [derivation.numeric()] if own_values else _samples(derivation)
    seen = axes(tree)
    return _members(tree, [numeric.tree for numeric in samples], seen)


def _node(x: Scalar) -> Scalar:
    return x.node if isinstance(x, Traced) else x


# ---- geometry with its values at samples


def _samples(derivation: Derived) -> list[Numeric]:
    """The model at random parameters near its own, ever nearer where it is not defined.

    Raises:
        ModelError: it is not defined at any of them.
    """
    # Fixed seed: which parameters are independent must not depend on chance.
    draw = random.Random(0)
    parameters = [p for p in derivation.system.parameters.values() if not p.derived]
    found: list[Numeric] = []
    wanted = SAMPLES if parameters else 1
    for attempt in range(TRIES):
        spread = SPREAD / (1 + attempt / 5)
        values = {
            p.name: (p.value or 1.0) * draw.uniform(1 - spread, 1 + spread) for p in parameters
        }
        try:
            found.append(_numeric(derivation, values, draw))
        except (ModelError, ArithmeticError):
            continue
        if len(found) == wanted:
            return found
    problem = "its geometry is not defined for parameters near their own values"
    raise ModelError(f'model "{derivation.system.name}"', problem)


def _numeric(derivation: Derived, values: dict[str, float], draw: random.Random) -> Numeric:
    u = [draw.uniform(-1, 1) for _ in derivation.structure.inputs]
    return derivation.numeric(values, draw.uniform(0.1, 0.9), u)


def _vector(node: Sequence[Any], values: Sequence[Sequence[Any]]) -> Any:
    return tuple(
        given(x, [float(v) for v in at], DUST) for x, *at in zip(node, *values, strict=True)
    )


def _placement(node: Placement, values: Sequence[Placement]) -> Placement:
    rows = tuple(
        _vector(row, [value.rotation[k] for value in values]) for k, row in enumerate(node.rotation)
    )
    return Placement(_vector(node.at, [value.at for value in values]), rows)


def _members(
    tree: KinematicTree, samples: Sequence[KinematicTree], seen: Sequence[Axis]
) -> list[Member]:
    """The links, with constants recognised by their values at the samples."""
    trees = (tree, *samples)
    poses = [[home.pose for home in homes(one)] for one in trees]
    armature = {axis.joint: 10 * len(tree.links) + 3 * n + 2 for n, axis in enumerate(seen)}
    found = []
    for i, (link, *others) in enumerate(zip(*(one.links for one in trees), strict=True)):
        near = _placement(_near(link), [_near(other) for other in others])
        home = _placement(poses[0][i], [at[i] for at in poses[1:]])
        ratio: Scalar = 1
        if len(link.velocities) == 1:
            ratios = [other.velocities[0].ratio for other in others]
            ratio = given(link.velocities[0].ratio, [float(x) for x in ratios], 0.0)
        indices = tuple(freedom.index for freedom in link.velocities)
        own = armature.get(link.joint.name) if len(indices) == 1 else None
        twists = _twists(link, others)
        found.append(Member(link.parent, near, twists, indices, ratio, home, own))
    return found


def _near(link: Link) -> Placement:
    return Placement(link.at, link.rotation.matrix())


def _twists(link: Link, others: Sequence[Link]) -> tuple[Twist, ...]:
    """Motions for unit velocities of a joint at rest, in its own axes.

    A joint of several freedoms is a sequence of turns and shifts about these.
    """
    motions = []
    for one in (link, *others):
        joint = one.joint
        motions.append(joint.motion(Floats(), joint.rest(), (0.0,) * joint.freedoms))
    node, *values = motions
    found = [
        Twist(
            _vector(node.angular[k], [value.angular[k] for value in values]),
            _vector(node.linear[k], [value.linear[k] for value in values]),
        )
        for k in range(link.joint.freedoms)
    ]
    if link.forward:
        return tuple(found)
    # Traversed from head to tail: motions are reversed, the last one first.
    return tuple(Twist(negate(w), negate(u)) for w, u in reversed(found))


# ---- numbers


def regressor_rows(
    numerics: Sequence[Numeric], seen: Sequence[Axis], states: int, draw: random.Random
) -> Array:
    """Y at random states, stacked.

    Columns of dry and viscous friction are zero here: no other column depends on them.

    Args:
        numerics: the model in numbers, at one time or several.
        seen: the joints that have parameters.
        states: number of states for each.
        draw: random number generator.

    Returns:
        (states times len(numerics) times n) x npi.
    """
    import numpy as np

    tree = numerics[0].tree
    n, count = len(tree.velocities), 10 * len(tree.links)
    rows = np.zeros((len(numerics), states, n, count + 3 * len(seen)))
    for numeric, found in zip(numerics, rows, strict=True):
        for Y in found:
            q = [draw.uniform(-1.5, 1.5) for _ in tree.positions]
            tree.normalise(q)
            v, a = ([draw.uniform(-2, 2) for _ in range(n)] for _ in range(2))
            _fill(Y, numeric, seen, (q, v, a))
    return rows.reshape(-1, rows.shape[-1])


def _fill(Y: Array, numeric: Numeric, seen: Sequence[Axis], state: tuple[list[float], ...]) -> None:
    """Write Y at a state q, v, v̇ into an n x npi array."""
    tree = numeric.tree
    q, v, a = state
    stations = [Station(i, home.pose) for i, home in enumerate(homes(tree))]
    count = 10 * len(tree.links)
    found = by_motions(TreeState(tree, q, v), stations, a)
    for i, columns in enumerate(found):
        for k, entries in columns.items():
            Y[k, 10 * i : 10 * i + 10] = entries
    for m, axis in enumerate(seen):
        for freedom in axis.row:
            Y[freedom.index, count + 3 * m + 2] = freedom.ratio * axis.rate(a)


def in_numbers(derivation: Derived, sample: Numeric, seed: int) -> list[Numeric]:
    """The model of a sample at several times and inputs if it has prescribed motions, else the sample alone.

    Args:
        derivation: the model.
        sample: the model at some values of its parameters.
        seed: seed of the times and inputs.
    """
    places = derivation.structure.layout.places.values()
    if not any(place.drive for place in places):
        return [sample]
    draw = random.Random(seed)
    values = {k: float(x) for k, x in sample.parameters.items()}
    return [_numeric(derivation, values, draw) for _ in range(TIMES)]


def _completed(
    derivation: Derived,
    samples: Sequence[Numeric],
    seen: Sequence[Axis],
    vectors: dict[int, dict[int, Scalar]],
) -> dict[int, dict[int, Scalar]]:
    """All relations: those given, and those of coupled joints and prescribed motions, found in numbers."""
    tree = derivation.structure
    driven = any(place.drive for place in tree.layout.places.values())
    if not (tree.coupled or driven):
        return vectors
    left = [k for k in _order(tree, seen) if k not in vectors]
    tables = [_table(derivation, seen, n, sample, left) for n, sample in enumerate(samples)]
    pivots = _pivots(tables[0])
    if not pivots:
        return vectors
    found = {}
    for pivot, coefficients in _solved(derivation, tables, pivots):
        found[left[pivot]] = {left[k]: x for k, x in coefficients.items()}
    return {place: without(vector, found) for place, vector in vectors.items()} | found


def _order(tree: KinematicTree, seen: Sequence[Axis]) -> list[int]:
    """Parameters of links and rotors in order of elimination.

    Rotors come first, then followers, then the other links, each in the order of `PREFERRED`.
    """
    count = 10 * len(tree.links)
    own = {axis.joint for axis in seen}
    followers = [i for i, link in enumerate(tree.links) if link.joint.name not in own]
    others = [i for i in range(len(tree.links)) if i not in followers]
    order = list(range(count + 2, count + 3 * len(seen), 3))
    for i in (*reversed(followers), *others):
        order += [10 * i + MOMENTS.index(part) for part in PREFERRED]
    return order


def _table(
    derivation: Derived, seen: Sequence[Axis], n: int, sample: Numeric, left: Sequence[int]
) -> Array:
    """Columns of Y at random states, more rows than columns."""
    numerics = in_numbers(derivation, sample, n)
    states = 3 * len(left) // len(sample.tree.velocities) + 8
    each = states // len(numerics) + 1
    return regressor_rows(numerics, seen, each, random.Random(n))[:, list(left)]


def _pivots(table: Array) -> list[int]:
    """Columns that depend on the others: as many as there are relations, the first possible ones."""
    import numpy as np

    scales = np.linalg.norm(table, axis=0)
    scales[scales == 0] = 1
    # Columns have different units; scaled to unit length, one threshold on singular values fits all.
    _, values, right = np.linalg.svd(table / scales, full_matrices=False)
    rows = right[values < SINGULAR * values[0]]
    pivots: list[int] = []
    # Pivots that are not weak come first, so that factors stay moderate; a second pass takes the others.
    for least in (WEAK, 0.0):
        for k in range(rows.shape[1]):
            if not len(rows) or k in pivots:
                continue
            sizes = np.abs(rows[:, k]) / np.abs(rows).max(axis=1)
            best = int(np.argmax(sizes))
            if sizes[best] > max(least, CONSTANT):
                rest = rows - np.outer(rows[:, k] / rows[best, k], rows[best])
                rows = np.delete(rest, best, axis=0)
                pivots.append(k)
    return sorted(pivots)


def _solved(
    derivation: Derived, tables: Sequence[Array], pivots: Sequence[int]
) -> list[tuple[int, dict[int, Scalar]]]:
    """The relation of each pivot, equal for all samples.

    Raises:
        ModelError: its coefficients depend on the model's parameters.
    """
    import numpy as np

    kept = [k for k in range(tables[0].shape[1]) if k not in pivots]
    solutions = []
    for table in tables:
        scales = np.linalg.norm(table, axis=0)
        scales[scales == 0] = 1
        whole = table / scales
        x = np.linalg.lstsq(whole[:, kept], whole[:, pivots], rcond=None)[0]
        solutions.append(x * scales[pivots] / scales[kept][:, None])
    spread = np.max(np.abs(np.array(solutions) - solutions[0]))
    if spread > CONSTANT * (1 + np.max(np.abs(solutions[0]))):
        problem = (
            "coupled or prescribed motions tie its parameters together by factors that depend on other "
            "parameters of the model; give numbers instead of these to get the factors in numbers"
        )
        raise ModelError(f'model "{derivation.system.name}"', problem)
    found = []
    for n, pivot in enumerate(pivots):
        vector: dict[int, Scalar] = {pivot: 1}
        for m, k in enumerate(kept):
            value = -float(solutions[0][m, n])
            x = given(value, [value] * len(tables), ROUNDING)
            if x != 0:
                vector[k] = x
        found.append((pivot, vector))
    return found

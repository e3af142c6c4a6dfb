"""Columns of the regressor that are linear combinations of others, computed as such where that is cheaper.

A change of a link's parameters that the parent can compensate at any motion (`relations`) makes one column
of the link a combination of other columns of the link and its parent. For a hinge on an axis through the
parent's origin this is one addition for a mass or first moment, in place of products of vectors.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from linegraph.algebra.sampled import Traced, size
from linegraph.identification.relations import handed
from linegraph.identification.search import members_of
from linegraph.identification.standard_parameters import MOMENTS
from linegraph.ir.dag import DIV, Node

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.identification.regressor import Columns
    from linegraph.kinematics.links import KinematicTree
    from linegraph.numeric.derived import Derived

LARGEST = 16
"""Largest factor of a combination: larger ones would lose digits."""

COSTS = (4, *[8] * 3, *[5] * 6)
"""Approximate operations for a coefficient of each moment computed directly."""


class TiedColumn(NamedTuple):
    """A column of a link as a linear combination of others.

    Attributes:
        link, moment: the column.
        parent: the link nearer to ground, which has some of the other columns.
        terms: link, moment and factor of each summand.
    """

    link: int
    moment: int
    parent: int
    terms: tuple[tuple[int, int, Scalar], ...]

    @property
    def cheap(self) -> bool:
        """Whether the combination costs no more operations than the column itself."""
        products = sum(factor not in (1, -1) for _, _, factor in self.terms)
        return products + len(self.terms) - 1 <= COSTS[self.moment]


def ties(derivation: Derived, tree: KinematicTree, *, folded: bool) -> list[TiedColumn]:
    """Columns that can be computed from others, inner links first.

    Args:
        derivation: the model.
        tree: its links, over the algebra of the factors.
        folded: whether parameters are numbers there.

    Returns:
        The columns of all links whose parent is a link; only factors up to `LARGEST` and without divisions.
    """
    found = []
    own = len(MOMENTS)
    members = members_of(derivation, tree, own_values=folded)
    for i, vectors in handed(members).items():
        for pivot, vector in vectors.items():
            terms = tuple(
                (*divmod(place, own), -(x.node if isinstance(x, Traced) else x))
                for place, x in vector.items()
                if place != pivot
            )
            plain = all(size(x) <= LARGEST for x in vector.values())
            links = pivot < own * len(members)
            if links and plain and not any(_divides(factor) for _, _, factor in terms):
                found.append(TiedColumn(i, pivot % own, members[i].parent, terms))
    return found


def _divides(factor: Scalar) -> bool:
    """Whether a factor divides by a parameter and so may be undefined."""
    pending, seen = [factor], set()
    while pending:
        node = pending.pop()
        if isinstance(node, Node) and node.index not in seen:
            seen.add(node.index)
            if node.op == DIV:
                return True
            pending += [node.a, node.b] if node.op != "symbol" else []
    return False


def tied(columns: Sequence[Columns], chosen: Sequence[TiedColumn]) -> list[Columns]:
    """Replace columns by linear combinations, for all velocities that also move the parent.

    Args:
        columns: for each link, the coefficients of its moments by velocity.
        chosen: the columns to replace.
    """
    found = [{k: list(entries) for k, entries in of_link.items()} for of_link in columns]
    for tie in chosen:
        for k, entries in found[tie.link].items():
            if k not in found[tie.parent]:
                continue
            total: Scalar = 0
            for link, moment, factor in tie.terms:
                total = total + factor * found[link][k][moment]
            entries[tie.moment] = total
    return found

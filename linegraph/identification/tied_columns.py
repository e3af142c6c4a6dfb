"""Columns of the regressor that are sums of others: computed as such where that is cheaper.

What a parent can carry as well as a link, whatever moves (`relations`), makes a column of the
link's a sum of others of its own and of its parent's. Of a hinge on an axis through the parent's origin that
is one addition for a mass or a first moment instead of a product of vectors.
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
"""Sums with larger factors would lose digits."""

COSTS = (4, *[8] * 3, *[5] * 6)
"""About what a coefficient of each moment costs by itself."""


class TiedColumn(NamedTuple):
    """A column of a link as a sum of others.

    Attributes:
        link, moment: which column; the parent has some of the others.
        terms: link, moment and factor of each.
    """

    link: int
    moment: int
    parent: int
    terms: tuple[tuple[int, int, Scalar], ...]

    @property
    def cheap(self) -> bool:
        """Whether the sum costs no more than the column by itself."""
        products = sum(factor not in (1, -1) for _, _, factor in self.terms)
        return products + len(self.terms) - 1 <= COSTS[self.moment]


def ties(derivation: Derived, tree: KinematicTree, *, folded: bool) -> list[TiedColumn]:
    """The ties of all links beyond another one, inner links first.

    Args:
        derivation: of what.
        tree: its links, over the algebra in which factors are wanted.
        folded: whether parameters are numbers there.
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
    """Whether a factor may have no value: where a parameter is divided by."""
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
    """Columns in which some are written as sums, along all velocities that the parent has, too."""
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

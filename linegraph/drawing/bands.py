"""Things in bands, one above the other: in which order they stand, and where.

Vertices and bodies stand in every second band; in between, and beside them, each edge has a lane of its own,
as wide as its label where it carries that. So nothing can overlap, and what is left to decide is the order,
for few crossings, and the places, for straight edges. All in integers: the same on every machine.
"""

from __future__ import annotations

from bisect import bisect_right, insort
from collections.abc import Hashable
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple, TypeVar

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

ORDERING_SWEEPS, PLACING_SWEEPS = 16, 200
Thing = TypeVar("Thing", bound=Hashable)

GAP = 8
FIRM = 4
"""From this weight on a link is worth being exactly straight."""

FINE = 16
"""Places are calculated in this fraction of a unit."""


class BandLink(NamedTuple):
    """What connects a port of a thing with one in the band above; `weight` is how straight it shall be."""

    low: int
    low_port: str
    high: int
    high_port: str
    weight: int


@dataclass
class Cell:
    """One thing in a band.

    Attributes:
        ports: where links end, from left to right.
        left, right: how far it reaches from its reference to either side.
        offsets: of the ports from the reference.
        x: of the reference, once placed.
    """

    band: int
    ports: list[str]
    left: int = 0
    right: int = 0
    offsets: dict[str, int] = field(default_factory=dict)
    x: int = 0


class Bands:
    """Cells in bands.

    Args:
        cells: what there is; in each band from left to right as it is to begin with.
        links: between neighbouring bands.
    """

    def __init__(self, cells: Sequence[Cell], links: Sequence[BandLink]) -> None:
        """Nothing is ordered yet."""
        self.apart: Mapping[tuple[int, int], int] = {}
        self.cells = cells
        self.rows: list[list[int]] = [
            [] for _ in range(1 + max((c.band for c in cells), default=0))
        ]
        for k, cell in enumerate(cells):
            self.rows[cell.band].append(k)
        self.above: list[list[BandLink]] = [[] for _ in cells]
        self.below: list[list[BandLink]] = [[] for _ in cells]
        for link in links:
            self.above[link.low].append(link)
            self.below[link.high].append(link)

    # ---- order

    def order(self) -> None:
        """Find an order with few crossings: by barycentres, up and down, the best one kept."""
        best = self._crossings()
        kept = self._state()
        for sweep in range(ORDERING_SWEEPS):
            if not best:
                break
            upward = sweep % 2 == 0
            rows = range(len(self.rows)) if upward else reversed(range(len(self.rows)))
            for row in rows:
                self._sort(row, upward)
            self._exchange()
            count = self._crossings()
            if count < best:
                best, kept = count, self._state()
        self._restore(kept)

    def _state(self) -> tuple[list[list[int]], list[list[str]]]:
        return [list(row) for row in self.rows], [list(cell.ports) for cell in self.cells]

    def _restore(self, state: tuple[list[list[int]], list[list[str]]]) -> None:
        self.rows = state[0]
        for cell, ports in zip(self.cells, state[1], strict=True):
            cell.ports = ports

    def _ranks(self, row: int) -> dict[tuple[int, str], int]:
        """The place of every port of a band, from the left."""
        if not 0 <= row < len(self.rows):
            return {}
        ports = ((k, port) for k in self.rows[row] for port in self.cells[k].ports)
        return {port: place for place, port in enumerate(ports)}

    def _ends(self, k: int, upward: bool) -> list[tuple[str, tuple[int, str]]]:
        """For each link to the band that is fixed: the own port and the far one."""
        if upward:
            return [(x.high_port, (x.low, x.low_port)) for x in self.below[k]]
        return [(x.low_port, (x.high, x.high_port)) for x in self.above[k]]

    def _sort(self, row: int, upward: bool) -> None:
        """Sort a band by the mean place of what its things are linked to, and so their ports."""
        ranks = self._ranks(row - 1 if upward else row + 1)
        means: dict[int, Fraction] = {}
        for k in self.rows[row]:
            ends = self._ends(k, upward)
            if not ends:
                continue
            means[k] = Fraction(sum(ranks[far] for _, far in ends), len(ends))
            own: dict[str, list[int]] = {}
            for port, far in ends:
                own.setdefault(port, []).append(ranks[far])
            averages = {port: Fraction(sum(x), len(x)) for port, x in own.items()}
            self.cells[k].ports = _resorted(self.cells[k].ports, averages)
        self.rows[row] = _resorted(self.rows[row], means)

    def _exchange(self) -> None:
        """Exchange neighbours as long as that removes crossings."""
        for row, cells in enumerate(self.rows):
            below, above = self._ranks(row - 1), self._ranks(row + 1)
            seen = {
                k: (
                    sorted(below[far] for _, far in self._ends(k, True)),
                    sorted(above[far] for _, far in self._ends(k, False)),
                )
                for k in cells
            }
            for place in range(len(cells) - 1):
                a, b = cells[place], cells[place + 1]
                now = sum(_inverted(x, y) for x, y in zip(seen[a], seen[b], strict=True))
                then = sum(_inverted(y, x) for x, y in zip(seen[a], seen[b], strict=True))
                if then < now:
                    cells[place], cells[place + 1] = b, a

    def _crossings(self) -> int:
        """How many pairs of links cross."""
        count = 0
        for row in range(len(self.rows) - 1):
            low, high = self._ranks(row), self._ranks(row + 1)
            pairs = sorted(
                (low[(x.low, x.low_port)], high[(x.high, x.high_port)])
                for k in self.rows[row]
                for x in self.above[k]
            )
            passed: list[int] = []
            for _, far in pairs:
                count += len(passed) - bisect_right(passed, far)
                insort(passed, far)
        return count

    # ---- places

    def place(self, apart: Mapping[tuple[int, int], int]) -> None:
        """Place everything: in this order, nothing too close, links as straight as they can be.

        Args:
            apart: how far the references of neighbours stand apart at least, if farther than for their size.
        """
        self.apart = apart
        for row in self.rows:
            x = 0
            for k, distance in zip(row, self._distances(row), strict=True):
                x += distance
                self.cells[k].x = x
        before: list[int] = []
        for sweep in range(PLACING_SWEEPS):
            upward = sweep % 2 == 0
            rows = self.rows if upward else self.rows[::-1]
            for row in rows:
                self._settle(row, sweep < 2, upward)
            if upward:
                now = [cell.x for cell in self.cells]
                if now == before:
                    break
                before = now
        for row in self.rows:
            self._straighten(row, upward=True)
        for row in self.rows[::-1]:
            self._straighten(row, upward=False)
        first = min((c.x - c.left * FINE for c in self.cells), default=0)
        for cell in self.cells:
            cell.x = (cell.x - first + FINE // 2) // FINE

    def _distances(self, row: list[int]) -> list[int]:
        """How far the reference of each thing of a band is at least from that of the one before."""
        found = [0] * min(1, len(row))
        for a, b in pairwise(row):
            near = self.cells[a].right + GAP + self.cells[b].left
            found.append(max(near, self.apart.get((a, b), 0)) * FINE)
        return found

    def _settle(self, row: list[int], one_sided: bool, upward: bool) -> None:
        """Bring a band as near as it can be to where its links want it (pool adjacent violators)."""
        blocks: list[list[int]] = []  # weight, weighted sum, how many
        shifts: list[int] = []
        shift = 0
        for k, distance in zip(row, self._distances(row), strict=True):
            shift += distance
            shifts.append(shift)
            weight, wish = self._wish(k, one_sided, upward)
            blocks.append([weight, wish - weight * shift, 1])
            while len(blocks) > 1 and _mean(blocks[-2]) >= _mean(blocks[-1]):
                last = blocks.pop()
                blocks[-1] = [a + b for a, b in zip(blocks[-1], last, strict=True)]
        at = 0
        for block in blocks:
            for _ in range(block[2]):
                self.cells[row[at]].x = _mean(block) + shifts[at]
                at += 1

    def _straighten(self, row: list[int], *, upward: bool) -> None:
        """Bring things exactly over (or under) what they are firmly linked to; what is not makes room."""
        for place, k in enumerate(row):
            links = [(x, x.low, x.low_port, x.high_port) for x in self.below[k] if upward]
            links += [(x, x.high, x.high_port, x.low_port) for x in self.above[k] if not upward]
            wishes = [
                (-x.weight, abs(wish - self.cells[k].x), wish)
                for x, far, far_port, port in links
                if x.weight >= FIRM
                for wish in (self._over(far, far_port, k, port),)
            ]
            for _, _, wish in sorted(wishes):
                if self._shift(row, place, wish):
                    break

    def _shift(self, row: list[int], place: int, wish: int) -> bool:
        """Move one thing, and loose ones out of its way; whether that could be done."""
        distances = self._distances(row)
        moved = {place: wish}
        for sense in (-1, 1):
            at = place
            while 0 <= at + sense < len(row):
                distance = distances[max(at, at + sense)]
                near = self.cells[row[at + sense]].x
                if sense * (near - moved[at]) >= distance:
                    break
                if self._firm(row[at + sense]):
                    return False
                moved[at + sense] = moved[at] + sense * distance
                at += sense
        for at, x in moved.items():
            self.cells[row[at]].x = x
        return True

    def _firm(self, k: int) -> bool:
        return any(x.weight >= FIRM for x in (*self.below[k], *self.above[k]))

    def _over(self, far: int, far_port: str, k: int, port: str) -> int:
        """Where a thing's link to a far port is straight."""
        ahead = self.cells[far].offsets.get(far_port, 0) - self.cells[k].offsets.get(port, 0)
        return self.cells[far].x + ahead * FINE

    def _wish(self, k: int, one_sided: bool, upward: bool) -> tuple[int, int]:
        """The weight of a thing's links, and the weighted sum of the places they want it at."""
        weight = wish = 0
        links = [
            (x, x.low, x.low_port, x.high_port) for x in self.below[k] if upward or not one_sided
        ]
        links += [
            (x, x.high, x.high_port, x.low_port)
            for x in self.above[k]
            if not (upward and one_sided)
        ]
        for x, far, far_port, port in links:
            weight += x.weight
            wish += x.weight * self._over(far, far_port, k, port)
        return (weight, wish) if weight else (1, self.cells[k].x)


def _mean(block: list[int]) -> int:
    return block[1] // block[0]


def _resorted(things: Sequence[Thing], by: dict[Thing, Fraction]) -> list[Thing]:
    """Those that have a value sorted by it among the places they take; the others stay."""
    order = iter(sorted((x for x in things if x in by), key=lambda x: by[x]))
    return [next(order) if x in by else x for x in things]


def _inverted(left: Iterable[int], right: Sequence[int]) -> int:
    """How many pairs stand the wrong way round."""
    return sum(1 for a in left for b in right if a > b)

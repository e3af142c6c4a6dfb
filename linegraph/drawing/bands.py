"""Layered layout: cells in bands, one above the other; their order in each band, and their positions.

Vertices and bodies occupy every second band. Between and beside them, each edge has a lane of its own, as
wide as its label where it carries one, so nothing can overlap. What remains is to choose the order, for few
crossings, by barycentres [Sugiyama et al. 1981], and the positions, for straight edges. All arithmetic is
exact, with integers and fractions, so that results are the same on every machine.
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
"""From this weight on, a link is made exactly straight if possible."""

FINE = 16
"""Number of steps per unit in which positions are calculated."""


class BandLink(NamedTuple):
    """A connection of a cell's port with a port in the band above.

    Attributes:
        low, low_port: the cell in the lower band and its port.
        high, high_port: the cell in the upper band and its port.
        weight: importance of drawing it straight.
    """

    low: int
    low_port: str
    high: int
    high_port: str
    weight: int


@dataclass
class Cell:
    """A vertex, body or lane in a band.

    Attributes:
        band: index of the band, from below.
        ports: names of the points where links end, from left to right.
        left, right: extent to both sides of the reference point.
        offsets: positions of the ports relative to the reference point.
        x: position of the reference point, once placed.
    """

    band: int
    ports: list[str]
    left: int = 0
    right: int = 0
    offsets: dict[str, int] = field(default_factory=dict)
    x: int = 0


class Bands:
    """Cells in bands, to be ordered and placed.

    Args:
        cells: all cells, in each band in the initial order from left to right.
        links: connections between neighbouring bands.
    """

    def __init__(self, cells: Sequence[Cell], links: Sequence[BandLink]) -> None:
        """Sort cells and links by band, in the given order."""
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
        """Find an order with few crossings and keep the best one met.

        Bands are sorted by barycentres in sweeps up and down, with exchanges of neighbours in between.
        """
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
        """Rank of every port of a band, from the left."""
        if not 0 <= row < len(self.rows):
            return {}
        ports = ((k, port) for k in self.rows[row] for port in self.cells[k].ports)
        return {port: place for place, port in enumerate(ports)}

    def _ends(self, k: int, upward: bool) -> list[tuple[str, tuple[int, str]]]:
        """Links of a cell to the band that is fixed: own port and far port."""
        if upward:
            return [(x.high_port, (x.low, x.low_port)) for x in self.below[k]]
        return [(x.low_port, (x.high, x.high_port)) for x in self.above[k]]

    def _sort(self, row: int, upward: bool) -> None:
        """Sort the cells of a band, and their ports, by the mean rank of the ports they are linked to."""
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
        """Exchange neighbours where that removes crossings."""
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
        """Number of pairs of links that cross."""
        count = 0
        for row in range(len(self.rows) - 1):
            low, high = self._ranks(row), self._ranks(row + 1)
            pairs = sorted(
                (low[(x.low, x.low_port)], high[(x.high, x.high_port)])
                for k in self.rows[row]
                for x in self.above[k]
            )
            # Links cross if their upper ends are in the opposite order of their lower ends: count
            # inversions.
            passed: list[int] = []
            for _, far in pairs:
                count += len(passed) - bisect_right(passed, far)
                insort(passed, far)
        return count

    # ---- places

    def place(self, apart: Mapping[tuple[int, int], int]) -> None:
        """Choose positions in the present order, with links as straight as possible.

        Args:
            apart: least distance between the reference points of two neighbours, if larger than from their
                sizes.
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
                # In the first sweeps one side has no useful positions yet and is ignored.
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
        """Least distance of each cell's reference point from that of the cell before."""
        found = [0] * min(1, len(row))
        for a, b in pairwise(row):
            near = self.cells[a].right + GAP + self.cells[b].left
            found.append(max(near, self.apart.get((a, b), 0)) * FINE)
        return found

    def _settle(self, row: list[int], one_sided: bool, upward: bool) -> None:
        """Place a band as close as possible to the positions its links require.

        This is a weighted least-squares problem with order constraints, solved by pooling adjacent
        violators.
        """
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
        """Place cells exactly above (or below) those they are firmly linked to; others make room."""
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
        """Move a cell and the loose ones in its way; return whether that was possible."""
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
        """Position of a cell for which its link to a far port is straight."""
        ahead = self.cells[far].offsets.get(far_port, 0) - self.cells[k].offsets.get(port, 0)
        return self.cells[far].x + ahead * FINE

    def _wish(self, k: int, one_sided: bool, upward: bool) -> tuple[int, int]:
        """Total weight of a cell's links, and the weighted sum of the positions they require."""
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
    """Sort those that have a value among the places they occupy; the others stay."""
    order = iter(sorted((x for x in things if x in by), key=lambda x: by[x]))
    return [next(order) if x in by else x for x in things]


def _inverted(left: Iterable[int], right: Sequence[int]) -> int:
    """Number of pairs in the wrong order."""
    return sum(1 for a in left for b in right if a > b)

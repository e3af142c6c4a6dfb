"""Constraints hidden in the equations of a network, which fix states: index reduction until 𝓜 is regular.

Whether 𝓜 is singular is decided by exact rank. A structural test [Pantelides 1988] looks at which entries are
zero only, and misses rows that depend on each other by their values.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from linegraph.algebra.differentiation import substitution
from linegraph.algebra.residues import Residues, Span, rank
from linegraph.errors import ModelError
from linegraph.networks.elimination import LinearRow, eliminate
from linegraph.networks.network import RATE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from linegraph.algebra.differentiation import Calculus, Replay
    from linegraph.algebra.scalar import Scalar
    from linegraph.networks.network import State
    from linegraph.networks.rates import Rates


class Reduction:
    """Rows ``𝓜 ż = f`` of which some may be dependent.

    Args:
        rates: total derivatives; the states that are fixed are entered there.
        calculus: derivatives over the network's DAG.
        states: all states.
        owners: for each row the state of its store, or None.
    """

    def __init__(
        self,
        rates: Rates,
        calculus: Calculus,
        states: Sequence[State],
        owners: Sequence[int | None],
    ) -> None:
        """Start with no state fixed."""
        self._owners = list(owners)
        self._rates, self._states = rates, states
        self._calculus, self._dag = calculus, calculus.dag
        self._residues = Residues()

    def reduce(self, rows: list[Scalar], variables: dict[str, tuple[Scalar, Scalar]]) -> set[int]:
        """Solve the null combinations of 𝓜 for states and differentiate them, until 𝓜 is regular.

        Args:
            rows: expressions linear in the rates that are zero; replaced by independent ones.
            variables: (X, Y) by edge; the fixed states in them are replaced.

        Returns:
            The indices of the fixed states.

        Raises:
            ModelError: a combination fixes no state.
        """
        gone: set[int] = set()
        while True:
            found = self._null(rows, gone)
            if found is None:
                self._ordered(rows, gone)
                return gone
            rest = found
            place, value = self._fixed(rest, gone)
            key = self._states[place].key
            gone.add(place)
            self._rates.replaced[key] = value
            rate = self._rates.of(value)
            replace = substitution(self._dag, {key: value, (RATE, place): rate})
            kept = replace.all(rows)
            rows[:] = self._independent(kept, gone)
            for name, (x, y) in variables.items():
                variables[name] = (replace(x), replace(y))

    def _rate_row(self, row: Scalar, gone: set[int]) -> LinearRow:
        gradient = self._calculus.gradient(row)
        entries = {s: slope for s, slope in gradient.items() if s[0] == RATE and s[1] not in gone}
        rest = substitution(self._dag, dict.fromkeys(entries, 0))(row)
        return LinearRow(entries, rest)

    def _null(self, rows: Sequence[Scalar], gone: set[int]) -> Scalar | None:
        """The expression that a null combination of 𝓜 makes zero; None if 𝓜 is regular."""
        if self._rank(rows, gone) == len(rows):
            return None
        found = eliminate([self._rate_row(r, gone) for r in rows], self._dag, self._residues)
        return found.left[0]

    def _rank(self, rows: Sequence[Scalar], gone: set[int]) -> int:
        return rank(
            [
                {s: self._residues(e) for s, e in self._rate_row(row, gone).entries.items()}
                for row in rows
            ]
        )

    def _independent(self, rows: Sequence[Scalar], gone: set[int]) -> list[Scalar]:
        """The rows without the one that follows from the others and the fixed states."""
        span, kept, dropped = Span(), [], False
        owners, self._owners = self._owners, []
        for k, row in enumerate(rows):
            entries = self._rate_row(row, gone).entries
            made = span.add({s: self._residues(e) for s, e in entries.items()}, k)
            if made is None or dropped:
                kept.append(row)
                self._owners.append(owners[k])
            else:
                dropped = True
        if not dropped:
            self._owners.pop()
        return kept if dropped else kept[:-1]

    def _fixed(self, rest: Scalar, gone: set[int]) -> tuple[int, Scalar]:
        """The index of the state that a constraint fixes, and its value.

        It is the last state whose slope is not zero and contains no state.

        Raises:
            ModelError: the constraint fixes no state.
        """
        gradient = self._calculus.gradient(rest)
        for place in reversed(range(len(self._states))):
            key = self._states[place].key
            slope = gradient.get(key)
            if place in gone or slope is None or not self._residues(slope):
                continue
            if any(s in self._rates.places for s in self._calculus.support(slope)):
                continue
            value = substitution(self._dag, {key: 0})(rest)
            return place, -value / slope
        names = ", ".join(s.quantity.name for s in self._states)
        problem = (
            f"its states ({names}) are not determined: the laws contradict each other, or fix an input or "
            "the motion of a joint"
        )
        raise ModelError(self._rates.who, problem)

    @cached_property
    def later(self) -> Replay:
        """The replacement of fixed states by their values."""
        values = dict(self._rates.replaced)
        for _ in values:
            replace = substitution(self._dag, values)
            values = {key: replace(x) for key, x in values.items()}
        return substitution(self._dag, values)

    def _ordered(self, rows: list[Scalar], gone: set[int]) -> None:
        """Sort the rows so that each has the rate of its own state, and no diagonal entry of 𝓜 is zero."""
        columns = [k for k in range(len(self._states)) if k not in gone]
        entries = [{s[1] for s in self._calculus.support(row) if s[0] == RATE} for row in rows]
        matched: dict[int, int] = {}

        # a maximum matching of rows and columns, by augmenting paths
        def augment(row: int, seen: set[int]) -> bool:
            for column in sorted(entries[row]):
                if column in seen or column not in columns:
                    continue
                seen.add(column)
                if column not in matched or augment(matched[column], seen):
                    matched[column] = row
                    return True
            return False

        for row, owner in enumerate(self._owners):
            if owner in entries[row] and owner in columns and owner not in matched:
                matched[owner] = row
        for row in range(len(rows)):
            if row not in matched.values():
                augment(row, set())
        if len(matched) == len(rows):
            rows[:] = [rows[matched[column]] for column in columns]

"""What a check has found: comparisons, each on the scale of what it is made of, and what was not judged."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_LEAST = 1e-300
TOLERANCE = 2e-12
"""Worst difference that rounding explains, relative to the terms that a number is made of: seldom 1e-13."""

PROGRAM, FLOATS, PAPER, LOOPS = "emitted program", "derivation over floats", "paper", "loops"
POWER, AUDIT, COMPONENTS = "power", "audit", "components"
"""Groups of comparisons."""


@dataclass(frozen=True)
class Comparison:
    """One quantity by two routes, at all states.

    Attributes:
        group: which routes met.
        what: the quantity.
        worst: the worst difference, relative to the largest terms its entry is made of.
        place: the entry where it is worst.
    """

    group: str
    what: str
    worst: float
    place: str = ""

    @property
    def good(self) -> bool:
        """Whether rounding explains the difference."""
        return self.worst < TOLERANCE


@dataclass(frozen=True)
class Findings:
    """What a check has found.

    Attributes:
        comparisons: all that was compared.
        unjudged: what could not be, and why.
        states: at how many states.
    """

    comparisons: tuple[Comparison, ...]
    unjudged: tuple[tuple[str, str], ...] = ()
    states: int = 0

    @property
    def good(self) -> bool:
        """Whether all differences are rounding."""
        return all(comparison.good for comparison in self.comparisons)

    @property
    def bad(self) -> tuple[Comparison, ...]:
        """What differs by more than rounding."""
        return tuple(comparison for comparison in self.comparisons if not comparison.good)

    def worst(self, group: str) -> float | None:
        """The worst difference of a group; None where nothing of it was judged."""
        found = [c.worst for c in self.comparisons if c.group == group]
        return max(found, default=None)

    @property
    def program(self) -> float:
        """Of the emitted program from Newton and Euler."""
        return self.worst(PROGRAM) or 0.0

    @property
    def paper(self) -> float | None:
        """Of the paper's matrices from Newton and Euler."""
        return self.worst(PAPER)

    @property
    def power(self) -> float | None:
        """Of the power balance of mechanics."""
        return self.worst(POWER)

    @property
    def audit(self) -> float | None:
        """Of the sums of through times across."""
        return self.worst(AUDIT)


@dataclass
class Tally:
    """Differences gathered over states: what they are relative to is known only at the end.

    Attributes:
        names: what the entries of a quantity are called, by quantity.
        loud: the number of the loud state that is noted, if it is one: its scale is its own.
    """

    names: Mapping[str, Sequence[str]] = field(default_factory=dict)
    loud: int | None = None
    _errors: dict[tuple[str, str, int | None], Any] = field(default_factory=dict)
    _scales: dict[tuple[str, str, int | None], Any] = field(default_factory=dict)

    def note(
        self, group: str, what: str, found: Any, expected: Any, size: Any, *, alone: bool = False
    ) -> None:
        """A quantity at a state: by a route, as expected, and how large what it is made of is.

        With `alone` it is compared on the scale of this state, else on that of all states that are not loud.
        """
        import numpy as np

        found, expected = (np.asarray(x, float).reshape(-1) for x in (found, expected))
        scale = np.maximum(np.abs(expected), np.abs(np.asarray(size, float)).reshape(-1))
        error = np.abs(found - expected) if len(found) == len(expected) else np.full(1, np.inf)
        # what is no number is as wrong as can be
        error = np.where(np.isfinite(error), error, np.inf)
        if alone:
            error = np.where(error == 0, 0.0, error / np.where(scale > 0, scale, _LEAST))
            scale = np.ones(len(error))
        key = (group, what, self.loud)
        if key in self._errors and len(self._errors[key]) == len(error):
            error = np.maximum(error, self._errors[key])
            scale = np.maximum(scale, self._scales[key])
        self._errors[key], self._scales[key] = error, scale

    def comparisons(self) -> tuple[Comparison, ...]:
        """All quantities, in the order in which they were met."""
        import numpy as np

        found: dict[tuple[str, str], Comparison] = {}
        for key, errors in self._errors.items():
            group, what, _ = key
            scales, calm = self._scales[key], self._scales.get((group, what, None))
            if calm is not None and len(calm) == len(scales):
                scales = np.maximum(scales, calm)
            one = self._comparison(group, what, errors, scales)
            known = found.setdefault((group, what), one)
            if one.worst > known.worst:
                found[group, what] = one
        return tuple(found.values())

    def _comparison(self, group: str, what: str, errors: Any, scales: Any) -> Comparison:
        """One quantity at all states that have one scale."""
        import numpy as np

        if len(scales) != len(errors):
            return Comparison(group, what, float("inf"))
        # what is made of nothing is zero
        ratios = np.where(errors == 0, 0.0, errors / np.where(scales > 0, scales, _LEAST))
        worst = float(ratios.max(initial=0.0))
        place = int(ratios.argmax()) if len(ratios) else 0
        names = self.names.get(what, ())
        return Comparison(group, what, worst, names[place] if place < len(names) else "")

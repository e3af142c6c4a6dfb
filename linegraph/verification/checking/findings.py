"""Results of a check: comparisons on the scale of their terms, and quantities that were not judged."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_LEAST = 1e-300
TOLERANCE = 2e-12
"""Largest difference, relative to the terms of a number, that rounding explains; it seldom exceeds 1e-13."""

PROGRAM, FLOATS, PAPER, LOOPS = "emitted program", "derivation over floats", "paper", "loops"
POWER, AUDIT, COMPONENTS = "power", "audit", "components"
"""Groups of comparisons."""


@dataclass(frozen=True)
class Comparison:
    """One quantity computed by two routes, over all states.

    Attributes:
        group: the two routes.
        what: the quantity.
        worst: the worst difference, relative to the largest size of its entry.
        place: name of the entry where it is worst.
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
    """The result of a check.

    Attributes:
        comparisons: all comparisons.
        unjudged: quantities that could not be compared, each with the reason.
        states: the number of states.
    """

    comparisons: tuple[Comparison, ...]
    unjudged: tuple[tuple[str, str], ...] = ()
    states: int = 0

    @property
    def good(self) -> bool:
        """Whether rounding explains all differences."""
        return all(comparison.good for comparison in self.comparisons)

    @property
    def bad(self) -> tuple[Comparison, ...]:
        """Comparisons with differences that rounding does not explain."""
        return tuple(comparison for comparison in self.comparisons if not comparison.good)

    def worst(self, group: str) -> float | None:
        """The worst difference of a group; None where nothing in it was compared."""
        found = [c.worst for c in self.comparisons if c.group == group]
        return max(found, default=None)

    @property
    def program(self) -> float:
        """Worst difference of the emitted program from Newton and Euler."""
        return self.worst(PROGRAM) or 0.0

    @property
    def paper(self) -> float | None:
        """Worst difference of the paper's matrices from Newton and Euler; None if not compared."""
        return self.worst(PAPER)

    @property
    def power(self) -> float | None:
        """Worst relative imbalance of power in mechanics; None if not compared."""
        return self.worst(POWER)

    @property
    def audit(self) -> float | None:
        """Worst relative sum of through times across; None if not compared."""
        return self.worst(AUDIT)


@dataclass
class Tally:
    """Differences collected over states; their scales are known only after the last one.

    Attributes:
        names: names of the entries of each quantity.
        loud: index of the present state if it is loud and so has its own scale, else None.
    """

    names: Mapping[str, Sequence[str]] = field(default_factory=dict)
    loud: int | None = None
    _errors: dict[tuple[str, str, int | None], Any] = field(default_factory=dict)
    _scales: dict[tuple[str, str, int | None], Any] = field(default_factory=dict)

    def note(
        self, group: str, what: str, found: Any, expected: Any, size: Any, *, alone: bool = False
    ) -> None:
        """Record one quantity at one state.

        Args:
            group: the two routes.
            what: the quantity.
            found: values by the route under test; any shape, flattened.
            expected: values by the independent route, as many.
            size: sizes of the expected values.
            alone: compare on this state's scale; otherwise on the largest scale of all states that are not
                loud.
        """
        import numpy as np

        found, expected = (np.asarray(x, float).reshape(-1) for x in (found, expected))
        scale = np.maximum(np.abs(expected), np.abs(np.asarray(size, float)).reshape(-1))
        error = np.abs(found - expected) if len(found) == len(expected) else np.full(1, np.inf)
        # NaN and infinities count as infinite errors.
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
        """All comparisons in the order first recorded; the worst of calm and loud states counts."""
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
        """One quantity over all states that share a scale."""
        import numpy as np

        if len(scales) != len(errors):
            return Comparison(group, what, float("inf"))
        # An entry without terms must be exactly zero.
        ratios = np.where(errors == 0, 0.0, errors / np.where(scales > 0, scales, _LEAST))
        worst = float(ratios.max(initial=0.0))
        place = int(ratios.argmax()) if len(ratios) else 0
        names = self.names.get(what, ())
        return Comparison(group, what, worst, names[place] if place < len(names) else "")

"""Text of a check's result."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.verification.checking.findings import AUDIT, FLOATS, LOOPS, PAPER, POWER, PROGRAM
from linegraph.verification.checking.findings import COMPONENTS as NETWORKS

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.numeric.derived import Derived
    from linegraph.verification.checking.findings import Comparison, Findings

HEADINGS = {
    PROGRAM: "emitted program and Newton-Euler",
    FLOATS: "derivation over floats and Newton-Euler",
    PAPER: "paper's matrices and Newton-Euler",
    LOOPS: "loops: freedoms, emitted motion",
    POWER: "power balance",
    AUDIT: "audit: sum of through times across",
    NETWORKS: "power of each component of networks",
}
_WIDTH = 41


def counted(count: int, what: str, several: str = "") -> str:
    """Count with its noun: "1 input", "2 inputs".

    Args:
        count: the number.
        what: the noun in the singular.
        several: its plural; by default with -s.
    """
    return f"{count} {what if count == 1 else several or what + 's'}"


def report(derivation: Derived, findings: Findings, heading: Callable[[str], str] = str) -> str:
    """Write the result of a check as text.

    Args:
        derivation: the model.
        findings: the result of `check`.
        heading: how to mark a heading, such as bold; by default unchanged.

    Returns:
        The model's size, coordinates, worst differences and verdict, ending in a newline.
    """
    tree = derivation.structure
    lines = [heading(f"model {derivation.system.name}")]
    freedoms = derivation.assembled.freedoms if tree.closed else tree.layout.mechanical
    states = len(tree.velocities) - tree.layout.mechanical
    counts = [counted(freedoms, "degree of freedom", "degrees of freedom")]
    counts += [counted(states, "state of networks", "states of networks")] * bool(states)
    lines.append(f"  {', '.join([*counts, counted(len(tree.inputs), 'input')])}")
    listed = (("q", tree.positions), ("v", tree.velocities), ("u", tree.inputs))
    for symbol, quantities in listed:
        lines += [f"  {symbol}[{i}]  {x.name}  {x.unit}" for i, x in enumerate(quantities)]
    where = f"at {counted(findings.states, 'random state')}"
    lines.append(heading(f"{where}, worst differences relative to the terms compared"))
    for group, title in HEADINGS.items():
        worst = findings.worst(group)
        if worst is not None:
            what = dict.fromkeys(c.what for c in findings.comparisons if c.group == group)
            few = group in (PROGRAM, FLOATS, PAPER, LOOPS)
            parts = f"  {', '.join(what)}" if few else ""
            lines.append(f"  {title:<{_WIDTH}} {worst:.1e}{parts}")
    if findings.unjudged:
        lines.append(heading("not judged"))
        lines += [f"  {what}: {why}" for what, why in findings.unjudged]
    if findings.bad:
        lines.append(heading("differences that rounding does not explain"))
        lines += [f"  {_said(comparison)}" for comparison in findings.bad]
    lines.append("good" if findings.good else "NOT GOOD: please report this model")
    return "\n".join(lines) + "\n"


def _said(comparison: Comparison) -> str:
    place = f" [{comparison.place}]" * bool(comparison.place)
    return f"{comparison.what}{place}: {comparison.worst:.1e} ({HEADINGS[comparison.group]})"

"""The report of a derivation: its sections, in the order of the derivation."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from linegraph.notation.tree import rounded
from linegraph.report.choice import chosen_tree
from linegraph.report.document import Document, formulas
from linegraph.report.forms import Forms
from linegraph.report.graphs import system_graph, terminal_graphs, topological
from linegraph.report.laws import terminal_equations
from linegraph.report.principle import connecting, orthogonality
from linegraph.report.subject import Subject
from linegraph.report.system import conventions, described

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.derivation import Derivation


SOURCE = re.compile(r"Derived from [^.]*\b[0-9a-f]{64}\.?")


def document(
    derivation: Derivation,
    level: str = "full",
    folded: bool = False,
    progress: Callable[[str], None] | None = None,
) -> Document:
    """Compose the report of a derivation.

    Args:
        derivation: the derived model.
        level: how far closed forms are simplified: ``none``, ``fast`` or ``full``.
        folded: whether to write parameters' values in place of their names.
        progress: called with a short text before each stage.
    """
    subject = Subject(derivation, level, folded)
    tell = progress or (lambda text: None)
    tell("graphs")
    sections = [
        described(subject),
        terminal_graphs(subject),
        system_graph(subject),
        chosen_tree(subject),
        topological(subject),
        terminal_equations(subject),
        connecting(subject),
        orthogonality(subject),
        *Forms(subject, tell).sections(),
    ]
    title = f"Equations of motion of {derivation.system.name}"
    first = conventions(subject, any(map(rounded, formulas(tuple(sections)))))
    about, source = _told(derivation.system.about)
    return Document(title, about, (first, *sections), source)


def _told(about: str) -> tuple[str, str]:
    """Split a model's description from the note about its source file, which goes to the end."""
    found = SOURCE.search(about)
    if found is None:
        return about, ""
    return (about[: found.start()] + about[found.end() :]).strip(), found[0].strip()

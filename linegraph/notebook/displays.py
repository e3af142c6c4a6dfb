"""How a derivation and a model look in a notebook: short, and where to look next."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from linegraph.drawing.pictures import graph_svg
from linegraph.errors import LinegraphError
from linegraph.notation import Notation

if TYPE_CHECKING:
    from linegraph.model.builder import Model
    from linegraph.pipeline import Derivation

SMALL = 4
"""A derivation with more velocities does not show its equations unasked."""


def of_derivation(derivation: Derivation) -> str:
    """Its size, its equations of motion if it is small, and the graph with the chosen tree."""
    tree = derivation.structure
    sizes = (
        f"{len(tree.positions)} coordinates q, {len(tree.velocities)} velocities v, "
        f"{len(tree.inputs)} inputs u"
    )
    head = f"<p><b>{escape(derivation.model.name)}</b>: {sizes}</p>"
    return head + _equations(derivation) + graph_svg(derivation)


def _equations(derivation: Derivation) -> str:
    if len(derivation.structure.velocities) > SMALL:
        return "<p>Ask for <code>mass_matrix</code>, <code>bias</code>, <code>function(...)</code>.</p>"
    try:
        found = derivation.equations()
    except LinegraphError as error:
        return f"<p>{escape(str(error))}</p>"
    look = Notation(derivation)
    return "".join(f"<p>{look.mathml(equation)}</p>" for equation in found)


def of_model(model: Model) -> str:
    """Its bodies and joints, elements and components."""
    rows = [("body", name, "") for name in model.bodies]
    rows += [(joint.kind, joint.name, " → ".join(joint.between)) for joint in model.joints]
    others = (*model.elements, *model.constraints, *model.components)
    rows += [(part.kind, part.name, "") for part in others]
    cells = [[f"<td>{escape(str(cell))}</td>" for cell in row] for row in rows]
    lines = "".join(f"<tr>{''.join(row)}</tr>" for row in cells)
    return f"<p><b>{escape(model.name)}</b> {escape(model.about)}</p><table>{lines}</table>"

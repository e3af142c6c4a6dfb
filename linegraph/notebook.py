"""Displays of notebooks: pictures of graphs, short overviews of models and derivations."""

from __future__ import annotations

from html import escape

from linegraph.derivation import Derivation
from linegraph.display import register
from linegraph.drawing.pictures import graph_svg, projection_svg, system_svg, topology_svg
from linegraph.drawing.scene import Scene
from linegraph.drawing.svg import svg_text
from linegraph.errors import LinegraphError
from linegraph.graph.forest import Topology
from linegraph.graph.multigraph import Projection, SystemGraph
from linegraph.model.builder import Model
from linegraph.model.system import System
from linegraph.notation.notation import Notation

SMALL = 4
"""Largest number of velocities for which a derivation displays its equations."""


def _of_derivation(derivation: Derivation) -> str:
    """HTML of a derivation: its size, its equations if it is small, and the graph with the chosen tree."""
    tree = derivation.structure
    sizes = (
        f"{len(tree.positions)} coordinates q, {len(tree.velocities)} velocities v, "
        f"{len(tree.inputs)} inputs u"
    )
    head = f"<p><b>{escape(derivation.system.name)}</b>: {sizes}</p>"
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


def _of_model(model: Model | System) -> str:
    """HTML of a model: bodies, joints, elements, constraints and components."""
    model = model.system()
    rows = [("body", name, "") for name in model.bodies]
    rows += [(joint.kind, joint.name, " → ".join(joint.between)) for joint in model.joints]
    others = (*model.elements, *model.constraints, *model.components)
    rows += [(part.kind, part.name, "") for part in others]
    cells = [[f"<td>{escape(str(cell))}</td>" for cell in row] for row in rows]
    lines = "".join(f"<tr>{''.join(row)}</tr>" for row in cells)
    return f"<p><b>{escape(model.name)}</b> {escape(model.about)}</p><table>{lines}</table>"


register(Projection, svg=projection_svg)
register(SystemGraph, svg=lambda graph: system_svg(graph.projections))
register(Topology, svg=topology_svg)
register(Scene, svg=svg_text)
register(Model, html=_of_model)
register(System, html=_of_model)
register(Derivation, html=_of_derivation)

"""Named outputs: expressions of edge variables, coordinates, inputs and parameters.

position(arm.tip).x   velocity(...)   acceleration(...)   angular_velocity(...)   in ground axes
force(elbow).z        torque(elbow).x                     of joints and constraints, as in `reactions`
across(strut)         through(strut)                      of force elements: x and the tension
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linegraph.algebra.formula import variable_of
from linegraph.components.forces import Element
from linegraph.components.parameters import names_in, resolver
from linegraph.components.validation import nearest
from linegraph.dynamics.law_names import scope
from linegraph.errors import ModelError
from linegraph.model.terminal_graphs import terminals_of

if TYPE_CHECKING:
    from linegraph.algebra.scalar import Scalar
    from linegraph.dynamics.edge_variables import InverseScheme
    from linegraph.model.system import System

OF_POINTS = {
    "position": "origin",
    "velocity": "linear",
    "acceleration": "pull",
    "angular_velocity": "angular",
    "angular_acceleration": "spin",
}
DYNAMIC = ("acceleration", "angular_acceleration", "force", "torque")
"""Variables that are known only after forward dynamics."""


def observed(scheme: InverseScheme) -> tuple[list[Scalar], bool]:
    """The scalars of all outputs, and whether one of them depends on accelerations.

    Raises:
        ModelError: an output names something that does not exist.
    """
    state = scheme.chords.state
    model, algebra = state.tree.system, state.algebra
    values = scope(state, scheme.chords)
    # efforts share their names with velocities: in outputs such a name means the coordinate or velocity
    own = {x.name for j in model.joints for x in (*j.positions(), *j.velocities())}
    prescribing = {q.name: k for k, q in enumerate(state.tree.inputs) if q.name not in own}
    dynamic = False
    found = []
    for output in model.outputs:
        try:
            for name in names_in(output.value):
                variable = variable_of(name)
                if variable is not None:
                    dynamic = dynamic or variable[0] in DYNAMIC
                    values[name] = _edge_variable(model, scheme, *variable)
            for name in sorted(names_in(output.value) & prescribing.keys()):
                values.setdefault(name, algebra.symbol("u", prescribing[name]))
            found.append(resolver(algebra, values)(output.value))
        except ModelError as error:
            raise ModelError(f'output "{output.name}"', error.problem) from None
    return found, dynamic


def _edge_variable(
    system: System, scheme: InverseScheme, kind: str, thing: str, part: str
) -> Scalar:
    """One variable of an edge or a point."""
    if kind in OF_POINTS:
        known = [*terminals_of(system), *(f"{body}.mass_center" for body in system.bodies)]
        if thing not in known:
            raise ModelError(
                "", f"{kind}({thing}): there is no such terminal; {nearest(thing, known)}"
            )
        return getattr(scheme.terminal(thing), OF_POINTS[kind])["xyz".index(part)]
    if f"{kind}({thing})" in scheme.variables():
        return scheme.variables()[f"{kind}({thing})"]
    if kind in ("across", "through"):
        elements = {e.name: e for e in system.elements if isinstance(e, Element)}
        known_edges = [*elements, *scheme.network()]
        if thing not in elements:
            raise ModelError(
                "",
                f"{kind}({thing}): there is no such element; {nearest(thing, known_edges)}",
            )
        x, y = scheme.tension(elements[thing])
        return x if kind == "across" else y
    if thing not in scheme.joints:
        problem = f"{kind}({thing}): there is no such joint or constraint; {nearest(thing, scheme.joints)}"
        raise ModelError("", problem)
    return getattr(scheme.reaction(thing), kind)["xyz".index(part)]

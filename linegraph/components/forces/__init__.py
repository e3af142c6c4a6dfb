"""The register of force elements: one file each; `model.builder.Model` has a method for each."""

from linegraph.components.forces.base import Element
from linegraph.components.forces.damper import Damper
from linegraph.components.forces.drag import Drag
from linegraph.components.forces.friction import Friction
from linegraph.components.forces.law import Law
from linegraph.components.forces.load import Load
from linegraph.components.forces.point_force import PointForce
from linegraph.components.forces.spring import Spring
from linegraph.components.forces.stop import Stop

ELEMENTS: dict[str, type[Element]] = {
    kind.kind: kind for kind in (Spring, Damper, Friction, Stop, Law)
}

POINT_FORCES: dict[str, type[PointForce]] = {kind.kind: kind for kind in (Load, Drag)}
"""What acts on a body at a terminal, from ground."""

__all__ = [
    "ELEMENTS",
    "POINT_FORCES",
    "Damper",
    "Drag",
    "Element",
    "Friction",
    "Law",
    "Load",
    "PointForce",
    "Spring",
    "Stop",
]

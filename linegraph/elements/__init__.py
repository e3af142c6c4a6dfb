"""The register of force elements: one file each, one line here, one line in `model.Model`."""

from linegraph.elements.base import Element
from linegraph.elements.damper import Damper
from linegraph.elements.friction import Friction
from linegraph.elements.law import Law
from linegraph.elements.load import Load
from linegraph.elements.spring import Spring
from linegraph.elements.stop import Stop

ELEMENTS: dict[str, type[Element]] = {
    kind.kind: kind for kind in (Spring, Damper, Friction, Stop, Law)
}

__all__ = ["ELEMENTS", "Damper", "Element", "Friction", "Law", "Load", "Spring", "Stop"]

"""The register of constraints: one file each, one line here, one line in `model.Model`."""

from linegraph.constraints.base import Constraint, Instant, Pose, Prescribed, Row, aligned
from linegraph.constraints.blade import Blade
from linegraph.constraints.driver import Driver
from linegraph.constraints.rod import Rod
from linegraph.constraints.rolling import Rolling

CONSTRAINTS: dict[str, type[Constraint]] = {
    kind.kind: kind for kind in (Rod, Driver, Rolling, Blade)
}

__all__ = [
    "CONSTRAINTS",
    "Blade",
    "Constraint",
    "Driver",
    "Instant",
    "Pose",
    "Prescribed",
    "Rod",
    "Rolling",
    "Row",
    "aligned",
]

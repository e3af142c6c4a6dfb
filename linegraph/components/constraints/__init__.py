"""The register of constraints: one file each; `model.builder.Model` has a method for each."""

from linegraph.components.constraints.base import (
    Constraint,
    Instant,
    Pose,
    Prescribed,
    ReactionRow,
    aligned,
)
from linegraph.components.constraints.blade import Blade
from linegraph.components.constraints.driver import Driver
from linegraph.components.constraints.rod import Rod
from linegraph.components.constraints.rolling import Rolling

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
    "ReactionRow",
    "Rod",
    "Rolling",
    "aligned",
]

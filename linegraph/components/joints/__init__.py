"""The register of joint types: one file each; `model.builder.Model` has a method for each."""

from linegraph.components.joints.base import Joint
from linegraph.components.joints.compound import Compound
from linegraph.components.joints.cylindrical import Cylindrical
from linegraph.components.joints.fixed import Fixed
from linegraph.components.joints.free import Free
from linegraph.components.joints.helical import Helical
from linegraph.components.joints.planar import Planar
from linegraph.components.joints.prismatic import Prismatic
from linegraph.components.joints.revolute import Revolute
from linegraph.components.joints.spherical import Spherical
from linegraph.components.joints.universal import Universal

JOINTS: dict[str, type[Joint]] = {
    kind.kind: kind
    for kind in (
        Fixed,
        Revolute,
        Prismatic,
        Helical,
        Cylindrical,
        Universal,
        Planar,
        Spherical,
        Free,
        Compound,
    )
}

__all__ = [
    "JOINTS",
    "Compound",
    "Cylindrical",
    "Fixed",
    "Free",
    "Helical",
    "Joint",
    "Planar",
    "Prismatic",
    "Revolute",
    "Spherical",
    "Universal",
]

"""The register of joint types: one file each, one line here, one line in `model.Model`."""

from linegraph.joints.base import Joint, Moments, Motion
from linegraph.joints.compound import Compound
from linegraph.joints.cylindrical import Cylindrical
from linegraph.joints.fixed import Fixed
from linegraph.joints.free import Free
from linegraph.joints.helical import Helical
from linegraph.joints.planar import Planar
from linegraph.joints.prismatic import Prismatic
from linegraph.joints.revolute import Revolute
from linegraph.joints.spherical import Spherical
from linegraph.joints.universal import Universal

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
    "Moments",
    "Motion",
    "Planar",
    "Prismatic",
    "Revolute",
    "Spherical",
    "Universal",
]

"""The register of joint types: one file each, one line here, one line in `model.Model`."""

from linegraph.joints.base import Joint, Moments, Motion
from linegraph.joints.fixed import Fixed
from linegraph.joints.free import Free
from linegraph.joints.planar import Planar
from linegraph.joints.prismatic import Prismatic
from linegraph.joints.revolute import Revolute

JOINTS: dict[str, type[Joint]] = {
    kind.kind: kind for kind in (Fixed, Revolute, Prismatic, Planar, Free)
}

__all__ = [
    "JOINTS",
    "Fixed",
    "Free",
    "Joint",
    "Moments",
    "Motion",
    "Planar",
    "Prismatic",
    "Revolute",
]

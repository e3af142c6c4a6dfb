"""What is compared: real robots, chains in space and in the plane, each as one URDF that all peers read.

The robots are those of the example-robot-data wheel, reduced to what equations of motion are made of:
nothing to see or to hit, locked joints fixed, no damping and no mimicking fingers. So nobody spends time
on reading meshes, and nobody leaves out a joint that another one keeps.
"""

from __future__ import annotations

import importlib.util
import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from generation import chain, planar_chain

ROBOTS = {
    # robot: file, base, locked joints
    "ur5": ("ur_description/urdf/ur5_robot.urdf", "fixed", ()),
    "panda": (
        "panda_description/urdf/panda.urdf",
        "fixed",
        ("panda_finger_joint1", "panda_finger_joint2"),
    ),
    "solo12": ("solo_description/robots/solo12.urdf", "floating", ()),
    "anymal": ("anymal_b_simple_description/robots/anymal.urdf", "floating", ()),
    "talos": ("talos_data/robots/talos_reduced.urdf", "floating", ()),
}
CHAINS = ("chain5", "chain10", "chain20", "chain40", "planar5", "planar20")
KNOWN = re.compile(r"(chain|planar)(\d+)")
NOT_DYNAMICS = ("visual", "collision", "gazebo", "transmission", "material", "sensor")


@dataclass(frozen=True)
class Robot:
    """One system.

    Attributes:
        name: what tables call it; an identifier.
        urdf: the file.
        floating: whether its root link is free.
    """

    name: str
    urdf: Path
    floating: bool

    @property
    def base(self) -> str:
        """The word for it."""
        return "floating" if self.floating else "fixed"


def robot(name: str, folder: Path) -> Robot:
    """A system by its name: one of `ROBOTS`, or `chainN`, `planarN`."""
    folder.mkdir(parents=True, exist_ok=True)
    if found := KNOWN.fullmatch(name):
        maker = chain if found[1] == "chain" else planar_chain
        return Robot(name, maker(int(found[2]), folder), floating=False)
    if name not in ROBOTS:
        raise SystemExit(f"no robot {name!r}; known: {', '.join(ROBOTS)}, chainN, planarN")
    file, base, locks = ROBOTS[name]
    path = folder / f"{name}.urdf"
    path.write_text(_reduced(_robots_folder() / file, locks))
    return Robot(name, path, floating=base == "floating")


def _robots_folder() -> Path:
    found = importlib.util.find_spec("cmeel")
    for folder in Path((found and found.origin) or "/").parents:
        robots = folder / "cmeel.prefix" / "share" / "example-robot-data" / "robots"
        if robots.is_dir():
            return robots
    raise SystemExit("the example-robot-data wheel is not installed")


def _reduced(path: Path, locks: tuple[str, ...]) -> str:
    root = ElementTree.parse(path).getroot()
    for parent in (root, *root.findall("link")):
        for word in NOT_DYNAMICS:
            for element in parent.findall(word):
                parent.remove(element)
    for joint in root.findall("joint"):
        if joint.get("name") in locks:
            joint.set("type", "fixed")
        for word in ("mimic", "dynamics", "safety_controller", "calibration"):
            for element in joint.findall(word):
                joint.remove(element)
    return ElementTree.tostring(root, encoding="unicode")

"""URDF texts for tests, one element a line so that line numbers are easy to see."""

from __future__ import annotations


def robot(*lines: str) -> bytes:
    """A robot; the first of `lines` is line 2."""
    return "\n".join(['<robot name="r">', *lines, "</robot>"]).encode()


def link(name: str, inner: str = "") -> str:
    """A link on one line."""
    return f'<link name="{name}">{inner}</link>' if inner else f'<link name="{name}"/>'


def inertial(
    mass: str = "2", xyz: str = "0.1 0.2 0.3", rpy: str = "0 0 0", tensor: str = "1 0 0 1 0 1"
) -> str:
    """An inertial; `tensor` is xx xy xz yy yz zz."""
    entries = zip(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), tensor.split(), strict=True)
    inertia = " ".join(f'{entry}="{value}"' for entry, value in entries)
    return (
        f'<inertial><origin xyz="{xyz}" rpy="{rpy}"/><mass value="{mass}"/>'
        f"<inertia {inertia}/></inertial>"
    )


def joint(name: str, parent: str, child: str, kind: str = "revolute", inner: str = "") -> str:
    """A joint on one line; limits are there for readers that want them."""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{inner}'
        f'<limit effort="1" velocity="1" lower="-1" upper="1"/></joint>'
    )


def axis(xyz: str) -> str:
    """An axis."""
    return f'<axis xyz="{xyz}"/>'


def origin(xyz: str = "0 0 0", rpy: str = "0 0 0") -> str:
    """An origin."""
    return f'<origin xyz="{xyz}" rpy="{rpy}"/>'


def mimic(master: str, multiplier: str = "1", offset: str = "0") -> str:
    """A mimic."""
    return f'<mimic joint="{master}" multiplier="{multiplier}" offset="{offset}"/>'


ZOO = robot(
    link("world"),
    link("base", inertial("5", "0.05 -0.02 0.1", "0.3 -0.2 0.5", "0.5 0.02 -0.03 0.6 0.01 0.4")),
    joint("weld", "world", "base", "fixed", origin("0.1 0.2 0.3", "0.4 0.5 -0.6")),
    link("upper", inertial("2", "0 0.1 0.2", "1.2 0.1 -0.7", "0.1 0.01 0.02 0.12 -0.01 0.08")),
    joint(
        "shoulder", "base", "upper", "continuous",
        origin("0 0 0.4", "0 1.5707963267948966 0") + axis("0 0 1"),
    ),
    link("lower", inertial("1.5", "0.03 0.1 0.2", "0 0 0", "0.1 0.01 0.02 0.12 -0.01 0.08")),
    joint("elbow", "upper", "lower", "revolute", origin("0.3 0 0", "0.1 -0.2 0.3") + axis("1 2 -2")),
    link("slider", inertial("0.7", "0.01 0.02 0.03", "0.5 0.6 0.7", "0.01 0 0 0.012 0 0.008")),
    joint("slide", "lower", "slider", "prismatic", origin("0.1 0.2 0.1", "0 0 1") + axis("0 -1 0")),
    link("box", inertial("0.3", "0.2 0.1 0", "0.1 0.1 0.1", "0.01 0.001 0 0.012 0 0.008")),
    joint("stuck", "slider", "box", "fixed", origin("0.1 0.1 0.1", "1 1 1")),
    link("finger", inertial("0.4", "0.02 0.01 0.1", "0.1 0.2 0.3", "0.01 0 0 0.01 0 0.005")),
    joint(
        "finger_joint", "lower", "finger", "revolute",
        origin("0 0.1 0", "0 -1.5707963267948966 0") + axis("0 1 0") + mimic("elbow", "-1.5", "0.25"),
    ),
    link("tip", inertial("0.2", "0.02 0.03 0.1", "0.1 0.2 0.3", "0.01 0 0 0.01 0 0.005")),
    joint(
        "tip_joint", "finger", "tip", "continuous",
        origin("0 0 0.1") + mimic("finger_joint", "0.5", "-0.1"),
    ),
    link("puck", inertial("0.9", "0.1 0.05 0.02", "0.3 0.2 0.1", "0.02 0.001 0 0.03 0 0.025")),
    joint("table", "base", "puck", "planar", origin("0.5 0 0", "0.2 0.1 0") + axis("0 0 1")),
    link("drone", inertial("0.6", "0.01 0.02 0.03", "0.3 0.2 0.1", "0.02 0.001 0 0.03 0 0.025")),
    joint("flight", "base", "drone", "floating", origin("0 0.5 0", "0.2 0.1 0.4")),
)  # fmt: skip
"""Every type of joint, followers of followers, welds and rotated inertial frames, depth first."""

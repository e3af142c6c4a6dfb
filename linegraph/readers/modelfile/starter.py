"""A model file to start from: complete, commented, ready to emit."""

from __future__ import annotations

import json
from pathlib import Path

from linegraph.errors import DeviceFailed, LinegraphError
from linegraph.files import OF_DEVICES, write_new
from linegraph.readers.modelfile.names import name_problem
from linegraph.readers.modelfile.report import shown

_TEXT = """\
# A terminal graph: components, and how they are connected.
#
#   linegraph show {file}               what it is made of, and how its equations arise
#   linegraph emit {file} --out build   M(q) v' + h(q, v) = Q(u) as C and Python
#   linegraph schema --help                 completion and checks while you type
#
# One rule: a table is [type.name], and between = [tail, head] is its oriented edge. A terminal is
# "body" or "body.frame"; "ground" is there from the start. SI units and radians throughout; any number
# may be an expression in quotes: + - * / ** ( ), sin, cos, sqrt, ..., pi.

name = {name}
description = "A pendulum on a cart, pushed by a motor and held by a spring."

[parameters] # each stays a symbol in the emitted code; expressions may use earlier ones
g = {{ value = 9.81, unit = "m/s^2", about = "acceleration of gravity" }}
m = {{ value = 0.2, unit = "kg", about = "mass of the pendulum" }}
l = {{ value = 0.3, unit = "m", about = "hinge to mass centre" }}
J = "m*l**2/3" # follows from the others: no symbol of its own

[inputs] # known at run time; joints bring an input each, named as their velocity
push = {{ unit = "N", about = "force of the motor on the cart" }}

[gravity]
acceleration = [0, 0, "-g"]

[body.cart]
mass = 0.6
frame.hinge = {{ at = [0, 0, 0.05] }} # a named frame: at, and rpy or axis and angle

[body.pendulum]
mass = "m"
mass_center = [0, 0, "-l"] # in the body's own frame
inertia = {{ xx = "J", yy = "J", zz = 0 }} # about the mass centre; xy, xz, yz are 0 if left out

# Joints. Their order is the order of the coordinates q and v.
# Types: {joints}.

[prismatic.slide]
between = ["ground", "cart"]
axis = [1, 0, 0]
effort = false # no input of its own: it is pushed by the load below

[revolute.swing]
between = ["cart.hinge", "pendulum"]
axis = [0, -1, 0]
effort = false

# Elements, along the line between two points or along the coordinate of a joint.
# Types: {elements}.

[spring.return]
joint = "slide"
stiffness = 5.0
length = 0.0

[friction.rail]
joint = "slide"
viscous = 0.1
coulomb = 0.05

[damper.bearing]
joint = "swing"
damping = 1e-4

# Forces and torques on bodies: expressions of t, inputs, coordinates and their rates, as in der(slide).

[load.motor]
at = "cart"
force = ["push", 0, 0]
"""


def starter(name: str) -> str:
    """Text of a commented model file, ready to emit.

    Args:
        name: the model's name.

    Example:
        >>> from linegraph.readers.modelfile import parse
        >>> [joint.name for joint in parse(starter("cart").encode(), "cart.toml").joints]
        ['slide', 'swing']
    """
    from linegraph.components.forces import ELEMENTS
    from linegraph.components.joints import JOINTS

    return _TEXT.format(
        name=json.dumps(name, ensure_ascii=False),
        file=f"{name}.toml",
        joints=", ".join(JOINTS),
        elements=", ".join(ELEMENTS),
    )


def write(name: str, out: str | None = None) -> Path:
    """Write a starter file without overwriting an existing one.

    Args:
        name: the model's name.
        out: the file; default ``NAME.toml``.

    Returns:
        The path of the file.

    Raises:
        LinegraphError: the name cannot be used, or the file already exists or cannot be written.
    """
    problem = name_problem(name)
    if problem:
        raise LinegraphError(f'model "{shown(name)}": {problem}')
    path = Path(out or f"{name}.toml")
    text = starter(name)
    try:
        write_new(path, text)
    except FileExistsError:
        raise LinegraphError(f"{path}: is there already; choose another name or --out") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        kind = DeviceFailed if getattr(error, "errno", None) in OF_DEVICES else LinegraphError
        raise kind(f"{shown(str(path), 1000)}: cannot be written: {reason}") from None
    return path

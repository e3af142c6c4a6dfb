"""Systems in letters that are linearised: rows of masses, pendulums, pendulums on carts, a parallelogram."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linegraph import Model

if TYPE_CHECKING:
    from collections.abc import Callable


def row(n: int) -> Model:
    """Masses on springs, joints one after the other."""
    model = Model("row")
    for i in range(1, n + 1):
        near = f"b{i - 1}" if i > 1 else "ground"
        body = model.body(f"b{i}", mass=model.parameter(f"m{i}", 1.0 + 0.1 * i))
        model.parameter(f"k{i}", 2.0 - 0.1 * i)
        model.prismatic(f"x{i}", (near, body), (1, 0, 0))
        model.spring(f"s{i}", joint=f"x{i}", stiffness=f"k{i}")
    return model


def pendulum(n: int, *, cart: bool = False, bodies: bool = False) -> Model:
    """Links in a plane, each a point at its end, or with a mass centre and an inertia of its own."""
    model = Model("pendulum")
    model.gravity = (0, 0, -1 * model.parameter("g", 9.81))
    near: Any = "ground"
    if cart:
        near = model.body("cart", mass=model.parameter("m0", 1.5))
        model.prismatic("x", ("ground", near), (1, 0, 0))
    for i in range(1, n + 1):
        length = model.parameter(f"l{i}", 0.5 + 0.1 * i)
        more: Any = {}
        reach: Any = length
        if bodies:
            reach = model.parameter(f"c{i}", 0.3)
            more = {"inertia": {"yy": model.parameter(f"J{i}", 0.1)}}
        mass = model.parameter(f"m{i}", 1.0 + 0.1 * i)
        body = model.body(f"b{i}", mass=mass, mass_center=(0, 0, -1 * reach), **more)
        model.revolute(f"t{i}", (near, body), (0, 1, 0))
        near = body.frame("end", at=(0, 0, -1 * length))
    return model


SYSTEMS: dict[str, Callable[[int], Model]] = {
    "row": row,
    "pendulum": pendulum,
    "pendulum on a cart": lambda n: pendulum(n, cart=True),
    "pendulum of bodies": lambda n: pendulum(n, bodies=True),
}


def parallelogram() -> Model:
    """Two rods hang side by side and carry a coupler; the loop closes while they hang."""
    model = Model("parallelogram")
    m, length, M = (model.parameter(n, x) for n, x in (("m", 0.7), ("L", 0.4), ("M", 1.3)))
    d = model.parameter("d", 0.25)
    model.gravity = (0, 0, -1 * model.parameter("g", 9.81))
    ends = {}
    for name, x in (("left", 0), ("right", d)):
        rod = model.body(
            f"{name}_rod",
            mass=m,
            mass_center=(0, 0, -1 * length / 2),
            inertia={"yy": m * length**2 / 12},
        )
        place = model.ground.frame(f"{name}_pivot", at=(x, 0, 0))
        model.revolute(name, (place, rod), (0, 1, 0), effort=name == "left")
        ends[name] = rod.frame("end", at=(0, 0, -1 * length))
    coupler = model.body("coupler", mass=M, mass_center=(d / 2, 0, 0), inertia={"yy": 0.01})
    model.revolute("near", (ends["left"], coupler), (0, 1, 0), effort=False)
    far = coupler.frame("far", at=(d, 0, 0))
    model.revolute("closing", (ends["right"], far), (0, 1, 0), effort=False)
    return model

"""A cart that carries a pole; the force on the cart is the only input."""

from __future__ import annotations

import sys

import linegraph as lg


def cart_pole() -> lg.Model:
    """A cart sliding along x and a pole swinging about y, angle 0 hanging down."""
    model = lg.Model("cart_pole", about="A pole on a sliding cart; the angle is 0 when it hangs.")
    cart_mass = model.parameter("m_cart", 0.6, "kg", "mass of the cart")
    mass = model.parameter("m_pole", 0.2, "kg", "mass of the pole")
    length = model.parameter("l", 0.3, "m", "hinge to mass centre of the pole")
    inertia = model.parameter("J_pole", 0.006, "kg*m^2", "central inertia of the pole about y")

    cart = model.body("cart", mass=cart_mass)
    pole = model.body("pole", mass=mass, mass_center=(0, 0, -length), inertia={"yy": inertia})
    model.prismatic("slide", between=("ground", cart), axis=(1, 0, 0))
    model.revolute("hinge", between=(cart, pole), axis=(0, -1, 0), effort=False)
    return model


if __name__ == "__main__":
    system = cart_pole()
    equations = lg.derive(system).symbolic
    print("M =", equations.mass_matrix)
    print("h =", equations.bias)
    for path in lg.emit(system, sys.argv[1] if len(sys.argv) > 1 else "build/cart_pole"):
        print(path)

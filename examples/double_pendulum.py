"""A double pendulum with every parameter a symbol: built in code, read as sympy, emitted as C and Python."""

from __future__ import annotations

import sys

import linegraph as lg


def double_pendulum() -> lg.Model:
    """Two rods swinging about y, each with its mass centre on its axis."""
    model = lg.Model("double_pendulum", about="Two rods in the vertical plane, hinged end to end.")
    model.gravity = (0, 0, -model.parameter("g", 9.81, "m/s^2", "acceleration of gravity"))
    m1 = model.parameter("m1", 1.0, "kg", "mass of the upper rod")
    m2 = model.parameter("m2", 0.8, "kg", "mass of the lower rod")
    l1 = model.parameter("l1", 0.5, "m", "length of the upper rod")
    c1 = model.parameter("c1", 0.25, "m", "hinge to mass centre, upper rod")
    c2 = model.parameter("c2", 0.2, "m", "hinge to mass centre, lower rod")
    i1 = model.parameter("I1", 0.021, "kg*m^2", "central inertia of the upper rod about y")
    i2 = model.parameter("I2", 0.011, "kg*m^2", "central inertia of the lower rod about y")

    upper = model.body("upper", mass=m1, mass_center=(0, 0, -c1), inertia={"yy": i1})
    lower = model.body("lower", mass=m2, mass_center=(0, 0, -c2), inertia={"yy": i2})
    model.revolute("shoulder", between=("ground", upper), axis=(0, 1, 0))
    model.revolute("elbow", between=(upper.frame("tip", at=(0, 0, -l1)), lower), axis=(0, 1, 0))
    return model


if __name__ == "__main__":
    system = double_pendulum()
    equations = lg.derive(system).symbolic
    print("M =", equations.mass_matrix)
    print("h =", equations.bias)
    for path in lg.emit(system, sys.argv[1] if len(sys.argv) > 1 else "build/double_pendulum"):
        print(path)

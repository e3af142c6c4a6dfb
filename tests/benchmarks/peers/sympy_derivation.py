"""A planar chain by SymPy's own mechanics: Kane's or Lagrange's method, then cse, then C.

    python sympy_derivation.py kane 3 FILE.c

Derived with symbols for lengths, masses and moments, which become the numbers of `planar_chain` before
common subexpressions are sought. Prints JSON: CPU seconds without importing SymPy, and operations.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import sympy
from sympy.physics import mechanics
from sympy.printing.c import C99CodePrinter

NUMBERS = {"l": 0.5, "c": 0.25, "m": 1.0, "J": 0.02, "g": 9.81}
TEXT = """#include <math.h>

void call(void *self, const double *x, double *y)
{{
    (void)self;
{lines}
}}
"""
POWERS = {"Pow": [(lambda base, power: power == 2, lambda base, power: f"({base})*({base})")]}


class Chain:
    """n links whose axes are parallel, in a vertical plane: bodies, points and coordinates.

    Args:
        n: how many.
        speeds: whether velocities are symbols of their own, as Kane's method has them.
    """

    def __init__(self, n: int, *, speeds: bool) -> None:
        """Walk from the ground to the tip."""
        self.q = mechanics.dynamicsymbols(f"q:{n}")
        rates = mechanics.dynamicsymbols(f"q:{n}", 1)
        self.v = mechanics.dynamicsymbols(f"v:{n}") if speeds else rates
        self.kinematic = [v - rate for v, rate in zip(self.v, rates, strict=True)] if speeds else []
        self.numbers = {sympy.Symbol(name): number for name, number in NUMBERS.items()}
        self.ground = mechanics.ReferenceFrame("N")
        self.g = sympy.Symbol("g")
        self.bodies = []
        self.links(sympy.symbols("l c m J"))

    def links(self, symbols: tuple[sympy.Symbol, ...]) -> None:
        """Add the bodies."""
        length, center, mass, moment = symbols
        frame, point, spin = self.ground, mechanics.Point("O"), sympy.S.Zero
        point.set_vel(self.ground, 0)
        for k, (q, v) in enumerate(zip(self.q, self.v, strict=True)):
            spin += v
            new = frame.orientnew(f"A{k}", "Axis", [q, self.ground.y])
            new.set_ang_vel(self.ground, spin * self.ground.y)
            middle = point.locatenew(f"C{k}", center * new.x)
            middle.v2pt_theory(point, self.ground, new)
            tip = point.locatenew(f"P{k}", length * new.x)
            tip.v2pt_theory(point, self.ground, new)
            inertia = (mechanics.inertia(new, 0, moment, 0), middle)
            body = mechanics.RigidBody(f"B{k}", middle, new, mass, inertia)
            body.potential_energy = (
                mass * self.g * middle.pos_from(self._origin(point, k)).dot(self.ground.z)
            )
            self.bodies.append(body)
            frame, point = new, tip

    def _origin(self, point: mechanics.Point, k: int) -> mechanics.Point:
        if k == 0:
            self.origin = point
        return self.origin


def kane(n: int) -> tuple[Chain, sympy.Matrix, sympy.Matrix]:
    """M and h by Kane's method."""
    chain = Chain(n, speeds=True)
    method = mechanics.KanesMethod(chain.ground, chain.q, chain.v, chain.kinematic)
    loads = [(body.masscenter, -body.mass * chain.g * chain.ground.z) for body in chain.bodies]
    method.kanes_equations(chain.bodies, loads)
    return chain, method.mass_matrix, -method.forcing


def lagrange(n: int) -> tuple[Chain, sympy.Matrix, sympy.Matrix]:
    """M and h by Lagrange's equations of the second kind."""
    chain = Chain(n, speeds=False)
    energies = mechanics.Lagrangian(chain.ground, *chain.bodies)
    method = mechanics.LagrangesMethod(energies, chain.q)
    method.form_lagranges_equations()
    return chain, method.mass_matrix, -method.forcing


def written(chain: Chain, M: sympy.Matrix, h: sympy.Matrix) -> tuple[str, int]:
    """The C text, and how many operations it has."""
    n = len(chain.q)
    x = [sympy.Symbol(f"x[{k}]") for k in range(2 * n)]
    order = [*zip(chain.v, x[n:], strict=True), *zip(chain.q, x[:n], strict=True)]
    results = [entry.subs(order).subs(chain.numbers) for entry in [*M, *h]]
    parts, results = sympy.cse(results)
    printer = C99CodePrinter({"user_functions": POWERS})
    lines = [f"    const double {name} = {printer.doprint(part)};" for name, part in parts]
    lines += [f"    y[{k}] = {printer.doprint(result)};" for k, result in enumerate(results)]
    counted = sympy.count_ops([*(part for _, part in parts), *results], visual=True)
    operations = counted.subs({"NEG": 0}).subs(dict.fromkeys(counted.free_symbols, 1))
    return TEXT.format(lines="\n".join(lines)), int(operations)


def main() -> None:
    """Derive, write, tell."""
    method, n, path = sys.argv[1:]
    start = time.process_time()
    text, operations = written(*{"kane": kane, "lagrange": lagrange}[method](int(n)))
    Path(path).write_text(text)
    print(json.dumps({"seconds": time.process_time() - start, "operations": operations}))


if __name__ == "__main__":
    main()

"""Closed forms: how long they take on one core and how long they are, beside sympy's own.

    python tests/benchmarks/closed_forms.py
    python tests/benchmarks/closed_forms.py --sympy-seconds 120 --only "double pendulum"

Each line is one process with one thread, after all imports: CPU seconds of `derive` and of M and h simplified
in full, and operations (`sympy.count_ops`) of both, counted as in
`tests/support/form_measures.py`. sympy's line is
`KanesMethod` over the same bodies and `trigsimp` of every entry of its mass matrix and forcing; what is not
ready in time has no figures.

Arms are three links with every parameter a symbol: mass, mass centre and six inertias of each body, three
offsets of each joint.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import time
from pathlib import Path
from typing import Any

sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parents[2])]

import sympy  # noqa: E402
from published.book_forms import double_pendulum, furuta  # noqa: E402
from support.form_measures import operations  # noqa: E402
from sympy.physics import mechanics  # noqa: E402

import linegraph as lg  # noqa: E402


def arm(axes: str) -> lg.Model:
    """Three hinges one after the other."""
    model = lg.Model(f"arm_{axes}")
    model.gravity = (0, 0, -1 * model.parameter("g"))
    near: Any = model.ground
    for k, axis in enumerate(axes, 1):

        def named(letter: str, endings: Any, k: int = k) -> tuple[Any, ...]:
            return tuple(model.parameter(f"{letter}{k}{end}") for end in endings)

        xx, yy, zz, xy, xz, yz = named("I", ("xx", "yy", "zz", "xy", "xz", "yz"))
        body = model.body(
            f"b{k}",
            mass=model.parameter(f"m{k}"),
            mass_center=named("c", "xyz"),
            inertia={"xx": xx, "yy": yy, "zz": zz, "xy": xy, "xz": xz, "yz": yz},
        )
        place = near.frame("out", at=named("l", "xyz"))
        direction = tuple(int(axis == c) for c in "xyz")
        model.revolute(f"q{k}", between=(place, body), axis=direction, effort=False)
        near = body
    return model


SYSTEMS: dict[str, Any] = {
    "double pendulum": double_pendulum,
    "double pendulum, absolute": lambda: double_pendulum("absolute-angle"),
    "Furuta pendulum": furuta,
    "arm z, y, y": lambda: arm("zyy"),
    "arm x, y, z": lambda: arm("xyz"),
}


def ours(name: str, level: str) -> tuple[float, int, int]:
    """Seconds, and operations of M and of h."""
    model = SYSTEMS[name]()
    start = time.process_time()
    form = lg.derive(model).closed_form(level)
    M, h = form.mass_matrix, form.bias
    return time.process_time() - start, operations(M), operations(h)


def theirs(name: str, _: str) -> tuple[float, int, int]:
    """The same by Kane and `trigsimp`."""
    build = {"double pendulum": _pendulum, "Furuta pendulum": _furuta}
    start = time.process_time()
    kane = build[name]() if name in build else _arm(name.replace("arm ", "").replace(", ", ""))
    M, h = (e.applyfunc(sympy.trigsimp) for e in (kane.mass_matrix, -kane.forcing))
    return time.process_time() - start, operations(M), operations(h)


# ---- the same bodies for sympy


class Chain:
    """Bodies on hinges one after the other, as sympy.physics.mechanics takes them."""

    def __init__(self) -> None:
        """Ground alone."""
        self.ground = self.frame = mechanics.ReferenceFrame("N")
        self.origin = mechanics.Point("O")
        self.origin.set_vel(self.ground, 0)
        self.q: list[Any] = []
        self.u: list[Any] = []
        self.bodies: list[Any] = []

    def link(self, offset: Any, axis: str, mass: Any, centre: Any, inertia: Any) -> None:
        """One more body: offset from the hinge before it, then the rest in its own axes."""
        k = len(self.q) + 1
        q, u = mechanics.dynamicsymbols(f"q{k} u{k}")
        frame, before = mechanics.ReferenceFrame(f"B{k}"), self.frame
        direction = getattr(before, axis)
        frame.orient_axis(before, direction, q)
        frame.set_ang_vel(before, u * direction)
        place = self.origin.locatenew(f"P{k}", self._vector(offset, before))
        place.v2pt_theory(self.origin, self.ground, before)
        at = place.locatenew(f"C{k}", self._vector(centre, frame))
        at.v2pt_theory(place, self.ground, frame)
        tensor = mechanics.inertia(frame, *inertia)
        self.bodies.append(mechanics.RigidBody(f"b{k}", at, frame, mass, (tensor, at)))
        self.q.append(q)
        self.u.append(u)
        self.frame, self.origin = frame, place

    @staticmethod
    def _vector(entries: Any, frame: Any) -> Any:
        x, y, z = entries
        return x * frame.x + y * frame.y + z * frame.z

    def kane(self) -> Any:
        """The equations."""
        rates = [u - q.diff() for q, u in zip(self.q, self.u, strict=True)]
        g = sympy.Symbol("g")
        loads = [(b.masscenter, -b.mass * g * self.ground.z) for b in self.bodies if b.mass != 0]
        method = mechanics.KanesMethod(self.ground, q_ind=self.q, u_ind=self.u, kd_eqs=rates)
        method.kanes_equations(self.bodies, loads)
        return method


def _pendulum() -> Any:
    m1, m2, l1, c1, c2, I1, I2 = sympy.symbols("m1 m2 l1 c1 c2 I1 I2")
    chain = Chain()
    chain.link((0, 0, 0), "y", m1, (0, 0, -c1), (0, I1, 0))
    chain.link((0, 0, -l1), "y", m2, (0, 0, -c2), (0, I2, 0))
    return chain.kane()


def _furuta() -> Any:
    m, l, L, J0, J_a, J_t = sympy.symbols("m l L J0 J_a J_t")  # noqa: E741
    chain = Chain()
    chain.link((0, 0, 0), "z", sympy.S.Zero, (0, 0, 0), (0, 0, J0))
    chain.link((L, 0, 0), "x", m, (0, 0, -l), (J_t, J_t, J_a))
    return chain.kane()


def _arm(axes: str) -> Any:
    chain = Chain()
    for k, axis in enumerate(axes, 1):
        offset, centre = (sympy.symbols(f"{c}{k}x {c}{k}y {c}{k}z") for c in "lc")
        xx, yy, zz, xy, yz, xz = sympy.symbols(
            " ".join(f"I{k}{e}" for e in ("xx", "yy", "zz", "xy", "yz", "xz"))
        )
        chain.link(offset, axis, sympy.Symbol(f"m{k}"), centre, (xx, yy, zz, xy, yz, xz))
    return chain.kane()


# ---- the table


def measured(job: Any, name: str, level: str, limit: float) -> str:
    """A line's figures, from a process of its own."""
    context = multiprocessing.get_context("spawn")
    with context.Pool(1) as pool:
        waiting = pool.apply_async(job, (name, level))
        try:
            seconds, M, h = waiting.get(limit)
        except multiprocessing.TimeoutError:
            pool.terminate()
            return f"{f'> {limit:.0f}':>9} {'':>9} {'':>9}"
    return f"{seconds:9.2f} {M:9d} {h:9d}"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=[*SYSTEMS], help="one system alone")
    parser.add_argument("--levels", default="full", help="of linegraph, e.g. none,fast,full")
    parser.add_argument("--seconds", type=float, default=300, help="how long to wait for ours")
    parser.add_argument("--sympy-seconds", type=float, default=60, help="and for sympy; 0 for not")
    given = parser.parse_args()
    print(f"{'system':28} {'by':18} {'CPU s':>9} {'ops of M':>9} {'ops of h':>9}")
    for name in [given.only] if given.only else SYSTEMS:
        for level in given.levels.split(","):
            figures = measured(ours, name, level, given.seconds)
            print(f"{name:28} {f'linegraph {level}':18} {figures}", flush=True)
        if given.sympy_seconds and "absolute" not in name:
            figures = measured(theirs, name, "", given.sympy_seconds)
            print(f"{'':28} {'Kane, trigsimp':18} {figures}", flush=True)


if __name__ == "__main__":
    main()

"""The potential energy of force elements: which part of a law has one, and its formula.

Only the tension at rest with inputs at zero, ``f(x, 0)``, can have a potential; parts that vanish with
rates and inputs take or give power and store none. If f(x, 0) depends on x and parameters alone, its
antiderivative is the energy. If no rule of integration applies, or other coordinates occur, the energy
is unknown unless the user gives it; then its derivative with respect to x is compared with f(x, 0).
"""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, Any

from linegraph.algebra.antiderivative import antiderivative
from linegraph.algebra.differentiation import Calculus, Replay, substitution
from linegraph.algebra.formula import Formula
from linegraph.algebra.protocol import Floats
from linegraph.algebra.residues import Residues
from linegraph.components.forces import Element, Law, Spring
from linegraph.components.parameters import names_in, resolver
from linegraph.errors import ModelError
from linegraph.ir.dag import Dag

if TYPE_CHECKING:
    from linegraph.algebra.protocol import Algebra
    from linegraph.algebra.scalar import Scalar
    from linegraph.components.forces import PointForce
    from linegraph.components.forces.base import Resolve
    from linegraph.model.system import System

X, RATE, NAME = "x", "v", "name"
SAMPLES = 8
CLOSE = 1e-9


class _Unknown(Exception):
    """The energy is unknown; the message gives the reason."""


def stored(
    system: System, element: Element, algebra: Algebra, x: Scalar, resolve: Resolve
) -> Scalar:
    """The potential energy of an element at x (J); 0 if it is unknown.

    Args:
        system: declares inputs and coordinates.
        element: a force element.
        algebra: where to calculate.
        x: its length or coordinate (m or rad).
        resolve: from model values to scalars.
    """
    given = element.energy if isinstance(element, (Law, Spring)) else None
    stretch = x - resolve(element.length) if isinstance(element, Spring) else x
    if given is not None:
        return resolve(given, x=stretch)
    try:
        found = _potential(system, element)
    except _Unknown:
        return 0
    if found is None:
        return element.potential(algebra, x, resolve)

    def symbol(key: tuple[str, Any]) -> Scalar:
        return stretch if key[0] == X else resolve(Formula("name", (key[1],)))

    return Replay(algebra, symbol)(found)


def holds(system: System, element: Element | PointForce) -> bool:
    """Whether an element driven by inputs has a potential energy: part of its law is independent of them.

    Args:
        system: declares inputs and coordinates.
        element: a force element or load.
    """
    if not isinstance(element, (Law, Spring)):
        return False
    if element.energy is not None:
        return True
    try:
        return _potential(system, element) not in (None, 0)
    except _Unknown:
        return False


def unknown(system: System) -> dict[str, str]:
    """The force elements whose potential energy is unknown, each with the reason."""
    found = {}
    for element in system.force_elements:
        if getattr(element, "energy", None) is not None:
            continue
        try:
            _potential(system, element)
        except _Unknown as reason:
            found[f"{element.kind} {element.name}"] = str(reason)
    return found


def require_energies(system: System) -> None:
    """Refuse an `energy` whose derivative with respect to x is not the force at rest.

    Raises:
        ModelError: names the element.
    """
    for element in system.force_elements:
        given = element.energy if isinstance(element, (Law, Spring)) else None
        if given is None:
            continue
        who = f'{element.kind} "{element.name}"'
        trace = _Trace(system)
        try:
            energy = trace.value(given)
            force = trace.value(_law(element))
            if isinstance(element, Spring) and element.force is None:
                force = force * trace.x
            rest = trace.at_rest(force)
        except _Unknown as error:
            raise ModelError(who, f"energy: {error}") from None
        except ModelError as error:
            raise ModelError(who, f"energy: {error.problem}") from None
        inputs = sorted(names_in(given) & {q.name for q in system.inputs})
        if inputs or any(s[0] == RATE for s in trace.calculus.support(energy)):
            what = inputs[0] if inputs else "v"
            raise ModelError(
                who, f"energy: names {what}; what is stored depends on positions alone"
            )
        if not trace.equal(trace.calculus.derivative(energy, (X, None)), rest):
            problem = (
                "energy: its derivative with respect to x is not the force at v = 0 with inputs at zero; "
                "correct one of them, or leave energy out"
            )
            raise ModelError(who, problem)


def _law(element: Element | PointForce) -> Any:
    """The expression of an element's tension; for a linear spring its stiffness."""
    force = getattr(element, "force", None)
    return element.stiffness if force is None and isinstance(element, Spring) else force


def _potential(system: System, element: Element | PointForce) -> Scalar | None:
    """The energy over the DAG of a trace; None if the element's class has its own formula.

    Raises:
        _Unknown: gives the reason.
    """
    if isinstance(element, Spring):
        _require_own(system, element.length, "length")
        if element.force is None:
            _require_own(system, element.stiffness, "stiffness")
            return None
    elif not isinstance(element, Law):
        for value in element.values():
            if element.kind == "stop":
                _require_own(system, value, "a value")
        return None
    trace = _Trace(system)
    try:
        force = trace.at_rest(trace.value(_law(element)))
    except ModelError as error:
        raise _Unknown(error.problem) from None
    others = trace.others(force)
    if others:
        raise _Unknown(f"its force depends on {others[0]} too")
    found = antiderivative(trace.calculus, trace.without_time(force), (X, None))
    if found is None:
        raise _Unknown("no rule integrates its force")
    return found


def _require_own(system: System, value: Any, what: str) -> None:
    """Refuse a spring whose values depend on other quantities: it has no energy as a function of x."""
    trace = _Trace(system)
    for name in sorted(names_in(value)):
        if name in trace.inputs or name in trace.positions or "(" in name:
            raise _Unknown(f"its {what} depends on {name}")


class _Trace:
    """Expressions of one element over a DAG of their own, with symbols x, v and names."""

    def __init__(self, system: System) -> None:
        self.dag = Dag()
        self.calculus = Calculus(self.dag)
        self.x = self.dag.symbol(X)
        self.inputs = {quantity.name for quantity in system.inputs}
        self.positions = {q.name for joint in system.joints for q in joint.positions()}
        self._residues = Residues()

    def value(self, given: Any) -> Scalar:
        """The node of an expression in x, v and names."""
        known = {name: self.dag.symbol(NAME, name) for name in names_in(given)}
        values = {**known, "x": self.x, "v": self.dag.symbol(RATE)}
        return resolver(self.dag, values)(given)

    def at_rest(self, f: Scalar) -> Scalar:
        """A tension with rates, inputs and variables of networks set to zero.

        Raises:
            _Unknown: it is not finite there.
        """
        moving = [s for s in self.calculus.support(f) if s[0] == RATE or self._moves(s[1])]
        try:
            return substitution(self.dag, dict.fromkeys(moving, 0))(f)
        except (ArithmeticError, ModelError):
            raise _Unknown("its force is not finite at rest") from None

    def _moves(self, name: str | None) -> bool:
        return name is not None and (name in self.inputs or "(" in name)

    def others(self, f: Scalar) -> list[str]:
        """The coordinates of other joints that a tension depends on."""
        slopes = self.calculus.gradient(f)
        return sorted(
            name
            for (kind, name), slope in slopes.items()
            if kind == NAME and name in self.positions and self._residues(slope)
        )

    def without_time(self, f: Scalar) -> Scalar:
        """A tension less its part that depends on time alone.

        Raises:
            _Unknown: its slope with respect to x depends on time.
        """
        time = (NAME, "t")
        if time not in self.calculus.support(f):
            return f
        try:
            still = substitution(self.dag, {time: 0})(f)
        except (ArithmeticError, ModelError):
            raise _Unknown("its force is not finite at t = 0") from None
        if self._residues(self.calculus.derivative(f - still, (X, None))):
            raise _Unknown("the time changes its stiffness")
        return still

    def equal(self, a: Scalar, b: Scalar) -> bool:
        """Whether two scalars are the same function.

        Args:
            a: a node of the trace.
            b: another one; they are compared exactly, then at random points where both are finite.
        """
        if not self._residues(a - b):
            return True
        draw = random.Random(0)
        symbols = sorted(self.calculus.support(a) | self.calculus.support(b), key=repr)
        compared = 0
        for k in range(2 * SAMPLES):
            least = -2.0 if k % 2 else 0.2
            at = {s: draw.uniform(least if s[0] == X else 0.5, 2.0) for s in symbols}
            replay = Replay(Floats(), at.__getitem__)
            try:
                first, second = float(replay(a)), float(replay(b))
            except (ArithmeticError, ModelError):
                continue
            compared += 1
            if not abs(first - second) <= CLOSE * (1 + abs(first) + abs(second)):
                return False
        return compared > 0

"""Linear systems, symbolically and as other tools have them.

ẋ = A x + B u + E u̇        y = C x + D u + F u̇
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy
from sympy.polys.matrices import DomainMatrix

from linegraph.errors import ModelError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

Expr = Any


@dataclass(frozen=True, repr=False)
class StateSpace:
    """A linear time-invariant system.

    Attributes:
        states, inputs, outputs: names, in the order of rows and columns.
        A, B, C, D: sympy matrices.
        E, F: of the inputs' derivatives; zero unless stores are tied to sources.
        defaults: the parameters' own values.

    Example:
        >>> from linegraph import Model, derive
        >>> model = Model("low_pass")
        >>> R, C, _ = model.parameter("R", 1e3), model.parameter("C", 1e-6), model.input("u", "V")
        >>> _ = model.voltage_source("s", ("a", "ground"), voltage="u")
        >>> _ = model.resistor("R1", ("a", "b"), resistance="R")
        >>> _ = model.capacitor("C1", ("b", "ground"), capacitance="C")
        >>> space = derive(model).symbolic.state_space
        >>> space.A, space.B, space.transfer_function()[0]
        (Matrix([[-1/(C*R)]]), Matrix([[1/(C*R)]]), 1/(C*R*s + 1))
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    A: Expr
    B: Expr
    C: Expr
    D: Expr
    E: Expr
    F: Expr
    defaults: Mapping[str, float]

    def __repr__(self) -> str:
        """Its names."""
        names = (", ".join(part) for part in (self.states, self.inputs, self.outputs))
        return "<linear system: states {}; inputs {}; outputs {}>".format(*names)

    def _repr_latex_(self) -> str:
        from linegraph.notation import Notation

        look = Notation()
        rates = f"{look.latex(self.A)} x + {look.latex(self.B)} u"
        if any(entry != 0 for entry in self.E):
            rates += rf" + {look.latex(self.E)} \dot u"
        names = ", ".join(look.latex(sympy.Symbol(name)) for name in self.states)
        return rf"$\displaystyle \dot x = {rates}, \quad x = ({names})$"

    @property
    def shifted(self) -> StateSpace:
        """The same with states ``x - E u``, in which no derivative of an input is needed but by outputs."""
        zero = sympy.zeros(*self.E.shape)
        B = (self.A * self.E + self.B).applyfunc(sympy.simplify)
        D = (self.C * self.E + self.D).applyfunc(sympy.simplify)
        return StateSpace(
            self.states,
            self.inputs,
            self.outputs,
            self.A,
            B,
            self.C,
            D,
            zero,
            self.F,
            self.defaults,
        )

    def transfer_function(self, s: Expr = None) -> Expr:
        """H(s), outputs x inputs: rational functions of s (default the symbol ``s``)."""
        s = sympy.Symbol("s") if s is None else s
        matrices = (
            s * sympy.eye(len(self.states)) - self.A,
            self.B + s * self.E,
            self.C,
            self.D + s * self.F,
        )
        # over the field of rational functions, in which every step is cancelled
        parts = [DomainMatrix.from_Matrix(sympy.nsimplify(m, rational=True)) for m in matrices]
        inner, right, C, D = (part.to_field() for part in DomainMatrix.unify(*parts))
        return (C * inner.lu_solve(right) + D).to_Matrix().applyfunc(sympy.factor)

    def numeric(self, parameters: Mapping[str, float] | None = None) -> tuple[Any, Any, Any, Any]:
        """A, B, C, D as arrays, shifted where need be; parameters in place of the model's own.

        Raises:
            ModelError: an output has a derivative of an input, or a parameter has no value.
        """
        import numpy

        space = self.shifted
        if any(entry != 0 for entry in space.F):
            raise ModelError(
                "state space", "an output has a derivative of an input: it is not proper"
            )
        values = {**self.defaults, **(parameters or {})}
        matrices = []
        for matrix in (space.A, space.B, space.C, space.D):
            found = matrix.subs({sympy.Symbol(name): x for name, x in values.items()})
            missing = sorted(symbol.name for symbol in found.free_symbols)
            if missing:
                raise ModelError("state space", f"no value is known of {', '.join(missing)}")
            matrices.append(numpy.array(found.tolist(), dtype=float).reshape(matrix.shape))
        return matrices[0], matrices[1], matrices[2], matrices[3]

    def to_scipy(self, parameters: Mapping[str, float] | None = None) -> Any:
        """A ``scipy.signal.StateSpace``."""
        from scipy.signal import StateSpace as Found

        return Found(*self.numeric(parameters))

    def to_control(self, parameters: Mapping[str, float] | None = None) -> Any:
        """A ``control.StateSpace`` with its names."""
        import control

        return control.ss(
            *self.numeric(parameters),
            states=list(self.states),
            inputs=list(self.inputs),
            outputs=list(self.outputs),
        )


def state_space(
    states: Sequence[Expr],
    rates: Sequence[Expr],
    inputs: Sequence[Expr],
    slopes: Mapping[Expr, Expr],
    outputs: Mapping[str, Expr],
    defaults: Mapping[str, float],
) -> StateSpace:
    """Read the matrices off expressions.

    Args:
        states: symbols.
        rates: their derivatives.
        inputs: symbols, without derivatives of other inputs.
        slopes: the symbol of the derivative of each input that has one.
        outputs: expressions by name.
        defaults: the parameters' own values.

    Raises:
        ModelError: something is not linear, depends on the time or has a constant part.
    """
    steep = [slopes.get(u, sympy.Dummy()) for u in inputs]
    variables = [*states, *inputs, *steep]
    named = {str(x): rate for x, rate in zip(states, rates, strict=True)}
    parts = []
    for rows in (named, outputs):
        matrix = sympy.zeros(len(rows), len(variables))
        for i, (name, expression) in enumerate(rows.items()):
            _read(matrix, i, name, expression, variables)
        parts.append(matrix)
    n, m = len(states), len(inputs)
    columns = (slice(0, n), slice(n, n + m), slice(n + m, n + 2 * m))
    A, B, E = (parts[0][:, c] for c in columns)
    C, D, F = (parts[1][:, c] for c in columns)
    names = (tuple(map(str, states)), tuple(map(str, inputs)), tuple(outputs))
    return StateSpace(*names, A, B, C, D, E, F, defaults)


def linearised(
    equations: tuple[Sequence[Expr], Expr, Expr],
    states: tuple[Sequence[Expr], Sequence[Expr]],
    at: Mapping[Expr, Expr],
    inputs: Sequence[Expr],
    slopes: Mapping[Expr, Expr],
    outputs: Mapping[str, Expr],
    defaults: Mapping[str, float],
) -> StateSpace:
    """The matrices for small deviations from a point where nothing accelerates.

    Args:
        equations: q̇, M and Q - h, with ``M v̇ = Q - h``.
        states: the symbols q and v.
        at: the value of every state and input.
        inputs: symbols, without derivatives of other inputs.
        slopes: the symbol of the derivative of each input that has one.
        outputs: expressions by name.
        defaults: the parameters' own values.

    Raises:
        ModelError: v̇ is not zero there, or the time stands in the equations.
    """
    rates, mass, right = equations
    q, v = states
    point = {symbol: sympy.sympify(value, strict=True) for symbol, value in at.items()}
    if sympy.Symbol("t") in (mass.free_symbols | right.free_symbols) - set(point):
        raise ModelError(
            "linearise", "the equations depend on the time: no point is an equilibrium"
        )
    for name, residual in zip(v, right.subs(point), strict=True):
        if not _vanishes(residual):
            problem = (
                f"{name} does not stay as it is there: Q - h = {sympy.simplify(residual)}. Give the values "
                "of an equilibrium, those of inputs too"
            )
            raise ModelError("linearise", problem)
    known = [*q, *v, *inputs, *slopes.values()]

    def small(expressions: Sequence[Expr]) -> Expr:
        column = sympy.Matrix(list(expressions))
        return (column.jacobian(sympy.Matrix(known)).subs(point) * sympy.Matrix(known)).expand()

    accelerations = mass.subs(point).LUsolve(small(right))
    moved = {name: small([y])[0] for name, y in outputs.items()}
    changes = [*small(rates), *accelerations]
    return state_space([*q, *v], changes, inputs, slopes, moved, defaults)


def _vanishes(residual: Expr) -> bool:
    """Whether an expression is zero, floats as far as they are exact."""
    found = sympy.simplify(residual)
    if found == 0:
        return True
    terms = sympy.Add.make_args(residual)
    size = sum(abs(term) for term in terms)
    return bool(found.is_number and size.is_number and abs(found) <= 1e-12 * size)


def _read(matrix: Expr, i: int, name: str, expression: Expr, variables: Sequence[Expr]) -> None:
    """One row: the slopes along all variables."""
    whole = sympy.sympify(expression, strict=True)
    rest = whole
    for j, variable in enumerate(variables):
        slope = sympy.simplify(sympy.diff(whole, variable))
        if slope.free_symbols & set(variables):
            raise ModelError(f'"{name}"', f"is not linear in {variable}: there is no state space")
        matrix[i, j] = slope
        rest = rest.subs(variable, 0)
    rest = sympy.simplify(rest)
    if rest != 0:
        problem = (
            f"has a part ({rest}) that is neither of states nor of inputs; make its source an input"
        )
        raise ModelError(f'"{name}"', problem)

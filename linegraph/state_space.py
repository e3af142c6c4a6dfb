"""Linear systems, symbolically and as other tools have them.

ẋ = A x + B u + E u̇        y = C x + D u + F u̇
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy
from sympy.polys.matrices import DomainMatrix

from linegraph.errors import ModelError
from linegraph.simplification.plain import quotient

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
        B = (self.A * self.E + self.B).applyfunc(quotient)
        D = (self.C * self.E + self.D).applyfunc(quotient)
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
        return (C * inner.lu_solve(right) + D).to_Matrix().applyfunc(quotient)

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

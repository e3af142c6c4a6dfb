"""The base parameters of a model: the combinations of its standard parameters that motion can identify.

Inverse dynamics is ``tau = Y pi`` (`regressor`, `standard_parameters`), but some columns of Y are zero and
some are linear combinations of others. With the independent parameters pi_b and the others pi_d,

    beta = pi_b + K pi_d        Y pi = Y_b beta

K depends on the geometry alone [Gautier and Khalil 1990]. It is exact: `relations` finds it with symbols
for what is symbolic in the model. Relations that exist only because motions are coupled or prescribed are
found numerically, as in [Gautier 1991].
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any

from linegraph.algebra.differentiation import Replay
from linegraph.algebra.protocol import Floats
from linegraph.components.parameters import is_number, valued
from linegraph.components.validation import nearest
from linegraph.errors import ModelError
from linegraph.identification.standard_parameters import JOINT_PARTS
from linegraph.ir.dag import Node

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from linegraph.algebra.scalar import Scalar
    from linegraph.numeric.derived import Derived

Expr = Any
Array = Any


@dataclass(frozen=True, eq=False, repr=False)
class BaseParameters:
    """The base parameters beta of a model, each a linear combination of its standard parameters pi.

    ``beta = pi[independent] + K pi[dependent]``, and ``Y pi = Y[:, independent] beta`` for the regressor Y.
    Parameters of the model in K are assumed generic: special values may reduce the number of base
    parameters further.

    Attributes:
        model: the model's name.
        names: the standard parameters, in the order of pi.
        units: their units.
        independent: indices in pi of the parameters that stay, one for each base parameter.
        dependent: indices of the parameters that are absorbed by others.
        without_effect: indices of the parameters that no motion shows; also in `dependent`.
        entries: K by row and column, zeros left out: numbers, or nodes of parameters of the model.
        derivation: the derivation they belong to.
        of_model: computes pi from the model's own numbers, for given values of its parameters.

    Example:
        >>> from linegraph import Model, derive
        >>> model = Model("arm", gravity=(0, -9.81, 0))
        >>> l = model.parameter("l", 0.5)
        >>> upper = model.body("upper", mass=1.0)
        >>> lower = model.body("lower", mass=1.0, mass_center=(0.3, 0, 0))
        >>> _ = model.revolute("q1", ("ground", upper))
        >>> _ = model.revolute("q2", (upper.frame("tip", (l, 0, 0)), lower))
        >>> base = derive(model).base_parameters()
        >>> [str(x) for x in base.expressions[:3]]
        ['l*lower.m + upper.mx', 'upper.my', 'l**2*lower.m + q1.armature + upper.Izz']
        >>> base.values().round(3).tolist()[:3]
        [0.5, 0.0, 0.25]
    """

    model: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    independent: tuple[int, ...]
    dependent: tuple[int, ...]
    without_effect: tuple[int, ...]
    entries: Mapping[tuple[int, int], Scalar]
    derivation: Derived
    of_model: Callable[[Mapping[str, float]], Array]

    @property
    def count(self) -> int:
        """The number of base parameters."""
        return len(self.independent)

    @cached_property
    def K(self) -> Expr:
        """K as a SymPy matrix, base parameters x dependent ones."""
        import sympy

        found = sympy.zeros(len(self.independent), len(self.dependent))
        for (i, j), x in self.entries.items():
            found[i, j] = _written(x)
        return found

    @cached_property
    def expressions(self) -> tuple[Expr, ...]:
        """Each base parameter as a SymPy expression in symbols named as pi and the model's parameters."""
        import sympy

        symbols = [sympy.Symbol(name) for name in self.names]
        rows: list[list[Expr]] = [[symbols[place]] for place in self.independent]
        for (i, j), x in self.entries.items():
            rows[i].append(_written(x) * symbols[self.dependent[j]])
        return tuple(sympy.Add(*row) for row in rows)

    def relation(self, parameters: Mapping[str, float] | None = None) -> Array:
        """K as a NumPy array, base parameters x dependent ones.

        Args:
            parameters: values in place of the model's own.

        Raises:
            ModelError: a parameter has no value, or the model has no parameter of that name.
        """
        import numpy as np

        found = np.zeros((len(self.independent), len(self.dependent)))
        values = self._values(parameters or {})
        replay = Replay(Floats(), lambda symbol: values[symbol[1]])
        for place, x in self.entries.items():
            found[place] = float(replay(x))
        return found

    def matrix(self, parameters: Mapping[str, float] | None = None) -> Array:
        """B of ``beta = B pi`` as a NumPy array, base parameters x standard ones.

        Args:
            parameters: values in place of the model's own.

        Raises:
            ModelError: a parameter has no value, or the model has no parameter of that name.
        """
        import numpy as np

        found = np.zeros((len(self.independent), len(self.names)))
        found[:, list(self.dependent)] = self.relation(parameters)
        found[range(self.count), list(self.independent)] = 1.0
        return found

    def values(self, parameters: Mapping[str, float] | None = None) -> Array:
        """Values of beta, from the masses, inertias and friction of the model, in SI units.

        Args:
            parameters: values in place of the model's own.

        Raises:
            ModelError: a parameter has no value, or the model has no parameter of that name.
        """
        return self.matrix(parameters) @ self.standard(parameters)

    def standard(self, parameters: Mapping[str, float] | None = None) -> Array:
        """Values of the standard parameters pi, from the model's own numbers, in SI units.

        Args:
            parameters: values in place of the model's own.
        """
        return self.of_model(parameters or {})

    def _values(self, given: Mapping[str, float]) -> dict[str, float]:
        declared = self.derivation.system.parameters
        for name in given:
            if name not in declared:
                raise ModelError(f'parameter "{name}"', f"is not there; {nearest(name, declared)}")
            if not is_number(given[name]):
                raise ModelError(f'parameter "{name}"', f"is a number, not {given[name]!r}")

        def value(p: Any) -> float:
            x = given.get(p.name, p.value)
            if x is None:
                raise ModelError(f'parameter "{p.name}"', "has no value")
            return float(x)

        return {k: float(x) for k, x in valued(declared.values(), Floats(), value).items()}

    # -- looks

    def __repr__(self) -> str:
        """Return the numbers of base and standard parameters."""
        return f"<{self.count} base parameters of {self.model}, of {len(self.names)} standard ones>"

    def __str__(self) -> str:
        """Return a table of the base parameters with their sums, then those that are sums of nothing else."""
        lines = [
            f"{self.count} base parameters of {self.model}, of {len(self.names)} standard parameters"
        ]
        rows = self._rows()
        width = max((len(name) for name, _, _ in rows), default=0)
        lines += [f"  {name.ljust(width)}  {unit.ljust(6)}  {text}" for name, unit, text in rows]
        lines += [f"{title}: {', '.join(names)}" for title, names in self._others() if names]
        return "\n".join(lines) + "\n"

    def _repr_html_(self) -> str:
        """Return the same table as HTML, for notebooks."""
        head = "<tr><th>base parameter</th><th>unit</th><th>sum</th></tr>"
        cells = (
            "".join(f"<td style='text-align:left'>{escape(cell)}</td>" for cell in row)
            for row in self._rows()
        )
        rows = "".join(f"<tr>{row}</tr>" for row in cells)
        others = "".join(
            f"<p>{title}: {escape(', '.join(names))}</p>"
            for title, names in self._others()
            if names
        )
        return f"<p>{escape(repr(self)[1:-1])}</p><table>{head}{rows}</table>{others}"

    def _rows(self) -> list[tuple[str, str, str]]:
        """Name, unit and sum of each base parameter; those of joints that are no sums are left out."""
        sums: list[dict[str, list[str]]] = [{} for _ in self.independent]
        for (i, j), x in sorted(self.entries.items(), key=lambda item: item[0]):
            sums[i].setdefault(_text(x), []).append(self.names[self.dependent[j]])
        found = []
        for place, terms in zip(self.independent, sums, strict=True):
            name = self.names[place]
            if terms or not self._alone(place):
                text = " ".join([name, *(_term(factor, names) for factor, names in terms.items())])
                found.append((name, self.units[place], text))
        return found

    def _alone(self, place: int) -> bool:
        """Whether a parameter belongs to a joint."""
        return self.names[place].rpartition(".")[2] in JOINT_PARTS

    def _others(self) -> list[tuple[str, list[str]]]:
        """Parameters listed below the table: those of joints that are no sums, and those without effect."""
        summed = {self.independent[i] for i, _ in self.entries}
        alone = [self.names[k] for k in self.independent if self._alone(k) and k not in summed]
        gone = [self.names[k] for k in self.without_effect]
        return [("by themselves", alone), ("without effect", gone)]


def _written(x: Scalar) -> Expr:
    """An entry of K as a SymPy expression in closed form."""
    import sympy

    from linegraph.algebra.sympy_scalars import to_sympy
    from linegraph.symbolic.simplification.plain import quotient, simplify

    if not isinstance(x, Node):
        return sympy.sympify(x, strict=True)
    found = to_sympy(x, lambda symbol: sympy.Symbol(str(symbol[1])))
    plain = simplify(found)
    return quotient(plain) if sympy.fraction(sympy.together(plain))[1].free_symbols else plain


def _text(x: Scalar) -> str:
    """An entry of K as text."""
    if not isinstance(x, Node):
        return f"{float(x):.10g}"
    return str(_written(x)).replace("**", "^")


def _term(factor: str, names: Sequence[str]) -> str:
    """A summand with its sign: a factor and the parameters that it multiplies."""
    if factor in ("1", "-1"):
        return " ".join(f"{'-' if factor == '-1' else '+'} {name}" for name in names)
    whole = names[0] if len(names) == 1 else f"({' + '.join(names)})"
    if " " in factor:
        return f"+ ({factor})*{whole}"
    sign, bare = ("-", factor[1:]) if factor.startswith("-") else ("+", factor)
    return f"{sign} {bare}*{whole}"

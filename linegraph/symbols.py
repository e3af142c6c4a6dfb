"""sympy, the face: closed forms for people, and user expressions coming in."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias

import sympy

from linegraph import orthogonality
from linegraph.checks import nearest
from linegraph.closure import Chords, equations
from linegraph.errors import ModelError
from linegraph.expression import Dag, Node
from linegraph.functions import ARITY
from linegraph.inverse_scheme import InverseScheme
from linegraph.loads import Applied, applied
from linegraph.mass_matrix import mass_matrix
from linegraph.paper import PaperMatrices, paper_matrices
from linegraph.paper_print import PrintedMatrices, printed_matrices
from linegraph.parameters import valued
from linegraph.scope import relations

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from linegraph.algebra import Algebra
    from linegraph.derive import Derivation
    from linegraph.kinematics import KinematicTree
    from linegraph.vector import Scalar

Expr: TypeAlias = Any
"""A sympy expression; sympy carries no types."""

RENAMED = {"abs": "Abs", "min": "Min", "max": "Max"}
"""Functions that sympy calls otherwise."""


class Sympy:
    """The algebra of sympy expressions: every argument's entry is a symbol of its own name.

    Args:
        names: for each argument, the symbols' names in order.
    """

    def __init__(self, names: Mapping[str, Iterable[str]] | None = None) -> None:
        """Keep the names that symbols are shown with."""
        self._names = {argument: list(given) for argument, given in (names or {}).items()}

    def symbol(self, argument: str, place: int | str | None = None) -> Expr:
        """The symbol of this entry."""
        if place is None or isinstance(place, str):
            return sympy.Symbol(place or argument)
        return sympy.Symbol(self._names[argument][place])

    sin = staticmethod(sympy.sin)
    cos = staticmethod(sympy.cos)
    sqrt = staticmethod(sympy.sqrt)

    def function(self, name: str, *x: Expr) -> Expr:
        """Any function of `functions.ARITY`."""
        return getattr(sympy, RENAMED.get(name, name))(*x)


class Symbolic:
    """A derivation's equations as sympy objects.

    Coordinates are written as the joints' names; velocities as ``name_dot``, or by their own names
    (``root_wx``) where v is not the derivative of q.

    Attributes:
        q, v: column matrices of symbols.
    """

    def __init__(self, derivation: Derivation) -> None:
        """Derive over sympy; nothing is simplified until asked for."""
        self._derivation = derivation
        self._model = derivation.model
        positions, rates, inputs = _names(derivation.structure, derivation.model.parameters)
        self.algebra = Sympy({"q": positions, "v": rates, "u": inputs})
        declared = derivation.model.parameters.values()
        self._parameters = valued(declared, self.algebra, lambda p: sympy.Symbol(p.name))
        self.tree: KinematicTree = derivation.tree(self.algebra, self._parameters)
        self.q = sympy.Matrix([sympy.Symbol(name) for name in positions])
        self.v = sympy.Matrix([sympy.Symbol(name) for name in rates])

    @cached_property
    def _arms(self) -> list[orthogonality.Arm]:
        return orthogonality.arms(self.tree, self.algebra, list(self.q), list(self.v))

    @cached_property
    def mass_matrix(self) -> Expr:
        """M(q) as a sympy Matrix, simplified entry by entry."""
        rows = mass_matrix(self.tree, self.algebra, self._arms)
        return sympy.Matrix(rows).applyfunc(simplified)

    @cached_property
    def bias(self) -> Expr:
        """h(q, v) as a sympy column Matrix, simplified entry by entry."""
        rows = orthogonality.inverse_dynamics(
            self.tree, self.algebra, self._arms, applied=self._applied
        )
        return sympy.Matrix(rows).applyfunc(simplified)

    @cached_property
    def constraints(self) -> Expr:
        """φ(q) as a column Matrix: zero where all loops are closed."""
        return sympy.Matrix(self._chords.position()).applyfunc(simplified)

    @cached_property
    def constraint_jacobian(self) -> Expr:
        """J(q), constraints x velocities; the multipliers' names are in `multipliers`."""
        rows = self._chords.jacobian()
        return sympy.Matrix(len(rows), len(self.v), [x for row in rows for x in row]).applyfunc(
            simplified
        )

    @cached_property
    def constraint_bias(self) -> Expr:
        """γ of J v̇ = γ as a column Matrix."""
        return sympy.Matrix(self._chords.bias()).applyfunc(simplified)

    @property
    def multipliers(self) -> Expr:
        """λ as a column Matrix of symbols: the through variables of the chords."""
        return sympy.Matrix([sympy.Symbol(e.multiplier.name) for e in equations(self.tree)])

    def reaction(self, joint: str) -> tuple[Expr, Expr]:
        """Force and torque that a joint exerts on its head, one edge alone, v̇ as symbols ``a_name``.

        Resolved as `Choices.reactions` says, about the head's origin; with loops λ are `multipliers`.

        Raises:
            ModelError: there is no such joint or constraint.
        """
        if joint not in self.tree.ends:
            raise ModelError(f'joint "{joint}"', f"is not there; {nearest(joint, self.tree.ends)}")
        wrench = self._scheme.reaction(joint)
        force, torque = (sympy.Matrix(part).applyfunc(simplified) for part in wrench)
        return force, torque

    def across(self, edge: str) -> tuple[Expr, Expr]:
        """Velocity and angular velocity across an edge, in ground axes.

        Raises:
            ModelError: there is no such edge.
        """
        found = self._scheme.across()
        if edge not in found:
            raise ModelError(f'edge "{edge}"', f"is not there; {nearest(edge, found)}")
        linear, angular = (sympy.Matrix(part).applyfunc(simplified) for part in found[edge])
        return linear, angular

    @cached_property
    def a(self) -> Expr:
        """v̇ as a column Matrix of symbols."""
        return sympy.Matrix([sympy.Symbol(f"a_{q.name}") for q in self.tree.velocities])

    @cached_property
    def _chords(self) -> Chords:
        state = (tuple(self.q), tuple(self.v))
        rates = orthogonality.coordinate_rates(self.tree, self.algebra, *state)
        found = relations(self._model, self.tree, self.algebra, self._parameters, state, rates)
        return Chords(self.tree, self.algebra, self._arms, self._parameters, found)

    @cached_property
    def _scheme(self) -> InverseScheme:
        multipliers = zip(equations(self.tree), self.multipliers, strict=True)
        return InverseScheme(
            self._derivation,
            self.tree,
            self.algebra,
            self._parameters,
            self._arms,
            self._chords,
            (tuple(self.q), tuple(self.v)),
            tuple(self.a),
            list(multipliers),
        )

    @cached_property
    def paper_matrices(self) -> PaperMatrices:
        """P, H, C, S, K and the literal (13)-(15) of the paper, over sympy and not simplified."""
        return paper_matrices(self.tree, self.algebra, list(self.q), list(self.v))

    @cached_property
    def energy(self) -> tuple[Expr, Expr]:
        """Kinetic and potential energy, that of springs included."""
        kinetic, potential = orthogonality.energy(self.tree, self.algebra, self._arms)
        return simplified(kinetic), simplified(potential + self._applied.potential)

    @cached_property
    def printed_matrices(self) -> PrintedMatrices:
        """All matrices of the paper in its own form of 2n - 1 chords, over sympy and not simplified."""
        return printed_matrices(self.tree, self.algebra, list(self.q), list(self.v))

    @cached_property
    def _applied(self) -> Applied:
        """Elements and loads that no input drives."""
        state = (tuple(self.q), tuple(self.v))
        return applied(
            self._model, self.tree, self.algebra, self._parameters, self._arms, *state, driven=False
        )


def _names(
    tree: KinematicTree, parameters: Mapping[str, Any]
) -> tuple[list[str], list[str], list[str]]:
    """What positions, velocities and inputs are called; no two alike.

    Raises:
        ModelError: a name stands for two things.
    """
    positions = [quantity.name for quantity in tree.positions]
    rates = [quantity.name for quantity in tree.velocities]
    rates = [f"{name}_dot" if name in positions else name for name in rates]
    inputs = [
        f"u_{quantity.name}" if quantity.name in (*positions, *rates) else quantity.name
        for quantity in tree.inputs
    ]
    for name in parameters:
        if name in positions or name in rates:
            raise ModelError(f'parameter "{name}"', "has the name of a coordinate; rename one")
    for name in rates:
        if name in positions:
            problem = "is the name of a coordinate and of a rate; rename a joint"
            raise ModelError(f'coordinate "{name}"', problem)
    return positions, rates, inputs


def simplified(expression: Expr) -> Expr:
    """Products multiplied out, sin^2 + cos^2 merged, common factors collected."""
    whole = _whole(sympy.sympify(expression, strict=True))
    return _whole(sympy.factor_terms(sympy.trigsimp(sympy.expand(whole))))


def _whole(expression: Expr) -> Expr:
    """Floats with integer values as integers: 2.0 x is 2 x to a reader."""
    return expression.replace(
        lambda e: e.is_Float and float(e).is_integer(), lambda e: sympy.Integer(int(e))
    )


def evaluate(expression: Expr, algebra: Algebra, parameters: Mapping[str, Scalar]) -> Scalar:
    """Walk a sympy expression of parameters into another algebra.

    Raises:
        ModelError: a symbol is no parameter, or an operation has no counterpart in emitted code.

    Example:
        >>> from linegraph.algebra import Floats
        >>> m, l = sympy.symbols("m l")
        >>> evaluate(m * l**2 / 3, Floats(), {"m": 6.0, "l": 0.5})
        0.5
    """

    def walk(e: Expr) -> Scalar:
        if e.is_Symbol:
            if e.name not in parameters:
                problem = "is used but not declared; declare it with model.parameter(...)"
                raise ModelError(f'parameter "{e.name}"', problem)
            return parameters[e.name]
        if e.is_Number or e.is_NumberSymbol:
            return number(e)
        return _apply(e, [walk(part) for part in e.args], algebra)

    return walk(sympy.sympify(expression, strict=True))


def number(e: Expr) -> Scalar:
    """A sympy number as an int where exact, else as a float."""
    return int(e) if e.is_Integer else float(e)


def _apply(e: Expr, parts: list[Scalar], algebra: Algebra) -> Scalar:
    """One operation of sympy's over another algebra."""
    if e.is_Add:
        return _fold(lambda a, b: a + b, parts)
    if e.is_Mul:
        return _fold(lambda a, b: a * b, parts)
    if e.is_Pow:
        return power(parts[0], e.exp, algebra)
    name = _OURS.get(e.func.__name__, e.func.__name__)
    if name in ("min", "max"):
        return _fold(lambda a, b: algebra.function(name, a, b), parts)
    if ARITY.get(name) == len(parts):
        return algebra.function(name, *parts)
    raise ModelError("", f"{name}(...) in {e} has no counterpart in emitted code")


_OURS = {theirs: ours for ours, theirs in RENAMED.items()}


def power(base: Scalar, exponent: Expr, algebra: Algebra) -> Scalar:
    """Integer and half-integer powers by products, roots and one division.

    Raises:
        ModelError: any other exponent.
    """
    twice = 2 * (sympy.Rational(float(exponent)) if exponent.is_Float else exponent)
    if not twice.is_Integer or abs(twice) > 128:
        raise ModelError("", f"the power {exponent} has no counterpart in emitted code")
    whole, half = divmod(abs(int(twice)), 2)
    result: Scalar = algebra.sqrt(base) if half else 1
    for _ in range(whole):
        result = result * base
    if not exponent.is_negative:
        return result
    if isinstance(result, (int, float)) and result == 0:
        raise ModelError("", "a division by zero at the parameters' values")
    return 1 / result


def to_sympy(node: Scalar, dag: Dag, names: Mapping[str, Iterable[str]]) -> Expr:
    """A DAG node as a sympy expression, intermediates substituted."""
    algebra = Sympy(names)
    known: dict[int, Expr] = {}
    pending = [node]
    while pending:
        top = pending[-1]
        if not isinstance(top, Node) or top.index in known:
            pending.pop()
            continue
        waiting = [x for x in (top.a, top.b) if isinstance(x, Node) and x.index not in known]
        if waiting and top.op != "symbol":
            pending += waiting
            continue
        known[top.index] = _shown(top, known, algebra)
        pending.pop()
    return known[node.index] if isinstance(node, Node) else sympy.sympify(node, strict=True)


def _shown(node: Node, known: Mapping[int, Expr], algebra: Sympy) -> Expr:
    def operand(x: Any) -> Expr:
        return known[x.index] if isinstance(x, Node) else sympy.sympify(x, strict=True)

    if node.op == "symbol":
        return algebra.symbol(node.a, node.b)
    actions: dict[str, Callable[..., Expr]] = {
        "neg": lambda a: -a,
        "add": lambda a, b: a + b,
        "sub": lambda a, b: a - b,
        "mul": lambda a, b: a * b,
        "div": lambda a, b: a / b,
    }
    operands = [operand(x) for x in (node.a, node.b) if x is not None]
    if node.op in actions:
        return actions[node.op](*operands)
    return algebra.function(node.op, *operands)


def _fold(action: Callable[[Scalar, Scalar], Scalar], parts: list[Scalar]) -> Scalar:
    result = parts[0]
    for part in parts[1:]:
        result = action(result, part)
    return result

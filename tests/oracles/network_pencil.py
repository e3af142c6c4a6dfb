"""An oracle of linear scalar networks that knows no tree: the sparse tableau, in exact arithmetic.

A network is a plain list of parts. Each port is an edge from a tail to a head, with an across
variable X = potential(tail) - potential(head) and a through variable Y that flows through the part
from tail to head. The unknowns w are X and Y of every port. A part says

==============  ==========================================  =======================================
kind            laws                                        value
==============  ==========================================  =======================================
resistor        X = value Y                                 resistance
conductance     Y = value X                                 conductance
capacitor       Y = value X'                                capacitance
inductor        X = value Y'                                inductance
voltage_source  X = u[value]                                index of an input
current_source  Y = u[value]                                index of an input
vcvs            X = value X(of)                             gain; `of` names the controlling part
vccs            Y = value X(of)                             gain
ccvs            X = value Y(of)                             gain
cccs            Y = value Y(of)                             gain
transformer     X1 = value X2, Y1 = -Y2 / value             ratio; `second` is the edge of port 2
gyrator         X1 = value Y2, X2 = -value Y1               ratio; `second` is the edge of port 2
opamp           X1 = 0, Y1 = 0, nothing about port 2        none; `second` is the edge of the output
==============  ==========================================  =======================================

Beside these laws stand KCL at the vertices and KVL, which is X = potential(tail) - potential(head)
with the potentials eliminated. Together that is E w' = A w + B u, square, and everything is asked
of this pencil. A float stands for the decimal it is printed as, so all numbers are rational:

- `order` takes determinants of s E - A modulo a prime, at more values of s than its degree can be;
- `characteristic` interpolates the same polynomial over the rationals, of the d x d pencil that is
  left when the d stores' laws are written in d free variables, and `poles` are its roots;
- `reduce` differentiates what is not a differential equation until w' is known (the shuffle
  algorithm), and rewrites x' with all the constraints met on the way. Only its results are rounded.

An equation is a dict of integers: the coefficients of variables' derivatives, whose sum is zero.
"""

from __future__ import annotations

import itertools
import math
from collections import defaultdict
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import mpmath
import numpy as np
import sympy
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence

Array = NDArray[np.float64]

PRIME = 2**61 - 1
STORES = {"capacitor": "X", "inductor": "Y"}
"""The kinds that store, and the variable each keeps."""


class Singular(Exception):
    """det(s E - A) is zero for every s: the network has no solution, or many."""


class NotStates(Exception):
    """The variables given are no basis of the states."""


@dataclass(frozen=True)
class Part:
    """A component of a network: see the table above."""

    kind: str
    name: str
    tail: str
    head: str
    value: float | Fraction | None = None
    second: tuple[str, str] | None = None
    of: str | None = None


class Variable(NamedTuple):
    """X or Y of a port, u of an input or p of a vertex; port 2 of a part is called NAME.second."""

    owner: str
    letter: str


class Jet(NamedTuple):
    """A derivative of a variable."""

    variable: Variable
    times: int


Equation = dict[Jet, int]


@dataclass(frozen=True)
class Reduced:
    """x' = A x + B[0] u + B[1] u' + ..., and w = C x + D[0] u + D[1] u' + ...

    What is exactly zero is 0.0. B and D have three entries at least, and more if there are higher
    derivatives of the inputs.
    """

    A: Array
    B: tuple[Array, ...]
    C: Array
    D: tuple[Array, ...]
    variables: tuple[Variable, ...]
    """The rows of C and D."""

    @property
    def B0(self) -> Array:
        return self.B[0]

    @property
    def B1(self) -> Array:
        return self.B[1]

    @property
    def B2(self) -> Array:
        return self.B[2]


def order(netlist: Sequence[Part]) -> int:
    """The degree of det(s E - A).

    Raises:
        Singular: it is zero for every s.
    """
    equations = _tableau(tuple(netlist))
    column = {variable: i for i, variable in enumerate(variables(netlist))}
    bound = sum(map(_moves, equations))
    values = []
    for s in range(1, bound + 2):
        rows = []
        for equation in equations:
            row: dict[int, int] = defaultdict(int)
            for (variable, times), a in equation.items():
                if variable in column:
                    row[column[variable]] += a * s**times
            rows.append({j: a % PRIME for j, a in row.items() if a % PRIME})
        values.append(_determinant_modulo(rows))
    degree = -1
    for k in range(bound + 1):  # values[0] is now the k-th forward difference
        if values[0]:
            degree = k
        values = [(b - a) % PRIME for a, b in itertools.pairwise(values)]
    if degree < 0:
        raise Singular
    return degree


def characteristic(netlist: Sequence[Part]) -> list[Fraction]:
    """The coefficients of det(s E - A), made monic, from that of s^0 upwards.

    Raises:
        Singular: it is zero for every s.
    """
    equations = _tableau(tuple(netlist))
    wanted = variables(netlist)
    equations = [_whole({j: a for j, a in x.items() if j.variable in wanted}) for x in equations]
    static, rest = _solved(
        [x for x in equations if not _moves(x)], {Jet(variable, 0) for variable in wanted}
    )
    if rest:
        raise Singular
    substitutes = static | {
        Jet(variable, 1): _differentiated(x) for (variable, _), x in static.items()
    }
    free = [variable for variable in wanted if Jet(variable, 0) not in static]
    laws = [_substituted(x, substitutes) for x in equations if _moves(x)]
    points = range(-(len(laws) // 2), len(laws) // 2 + 2)
    determinants = [
        _determinant([[x.get(Jet(z, 0), 0) + s * x.get(Jet(z, 1), 0) for z in free] for x in laws])
        for s in points
    ]
    coefficients = _interpolated(points, determinants)
    while coefficients and not coefficients[-1]:
        coefficients.pop()
    if not coefficients:
        raise Singular
    return [x / coefficients[-1] for x in coefficients]


def poles(netlist: Sequence[Part]) -> NDArray[np.complex128]:
    """The finite eigenvalues, by real part and then by imaginary part; repeated ones are equal.

    Raises:
        Singular: every number is one.
    """
    coefficients = characteristic(netlist)[::-1]
    polynomial = sympy.Poly([sympy.Rational(str(x)) for x in coefficients], sympy.Symbol("s"))
    roots: list[complex] = []
    for factor, times in polynomial.sqf_list()[1]:  # one without repeated roots per multiplicity
        with mpmath.workdps(40):
            exact = [mpmath.mpf(int(x.p)) / int(x.q) for x in factor.all_coeffs()]
            found = mpmath.polyroots(exact, maxsteps=1000, extraprec=40 + 20 * len(exact))
        roots += times * [complex(x) for x in found]
    return np.array(sorted(roots, key=lambda x: (x.real, x.imag)), dtype=complex)


def basis(netlist: Sequence[Part]) -> list[tuple[str, str]]:
    """The first stores, in the order of the netlist, whose variables are a basis of the states.

    Raises:
        Singular: the network has none.
    """
    constraints, _ = _shuffled(tuple(netlist))
    stores = [Variable(x.name, STORES[x.kind]) for x in netlist if x.kind in STORES]
    others = {Jet(x, 0) for x in variables(netlist) if x not in stores}
    _, rest = _solved(constraints, others)
    dependent = set()
    for variable in reversed(stores):
        solved, rest = _solved(rest, {Jet(variable, 0)})
        if solved:
            dependent.add(variable)
    return [(x.owner, x.letter) for x in stores if x not in dependent]


def reduce(netlist: Sequence[Part], states: Sequence[tuple[str, str]]) -> Reduced:
    """The state equations of a network, and all its variables, for states (part name, "X" or "Y").

    Raises:
        Singular: the network has no state equations.
        NotStates: these variables are no basis of the states.
    """
    forms = reduced_exactly(netlist, states)
    x = [Variable(*state) for state in states]
    w = variables(netlist)
    times = max((jet.times for form in forms.values() for jet in form), default=0)
    count = inputs(netlist)

    def matrix(rows: list[Jet], columns: list[Jet]) -> Array:
        entries = [[float(forms[i].get(j, 0)) for j in columns] for i in rows]
        return np.array(entries, dtype=float).reshape(len(rows), len(columns))

    rates, values = [Jet(i, 1) for i in x], [Jet(i, 0) for i in w]
    u = [[Jet(_input(i), k) for i in range(count)] for k in range(max(times, 2) + 1)]
    return Reduced(
        A=matrix(rates, [Jet(i, 0) for i in x]),
        B=tuple(matrix(rates, columns) for columns in u),
        C=matrix(values, [Jet(i, 0) for i in x]),
        D=tuple(matrix(values, columns) for columns in u),
        variables=tuple(w),
    )


def reduced_exactly(
    netlist: Sequence[Part], states: Sequence[tuple[str, str]]
) -> dict[Jet, dict[Jet, Fraction]]:
    """As `reduce`, but each of x' and w as its coefficients of x, u, u', ...

    Raises:
        Singular: the network has no state equations.
        NotStates: these variables are no basis of the states.
    """
    constraints, rates = _shuffled(tuple(netlist))
    w = variables(netlist)
    x = [Variable(*state) for state in states]
    if len(x) != len(w) - len(constraints) or len(set(x)) != len(x) or not set(x) <= set(w):
        raise NotStates
    dependent = {Jet(i, 0) for i in w if i not in x}
    static, rest = _solved(constraints, dependent)
    if rest:
        raise NotStates
    solved = static | {Jet(i, 1): _substituted(rates[Jet(i, 1)], static) for i in x}
    return {Jet(i, 0): {Jet(i, 0): Fraction(1)} for i in x} | {
        jet: {i: Fraction(-a, equation[jet]) for i, a in equation.items() if i != jet}
        for jet, equation in solved.items()
    }


def variables(netlist: Sequence[Part]) -> list[Variable]:
    """The unknowns w: X and Y of every port."""
    return [Variable(name, letter) for name, *_ in _ports(netlist) for letter in "XY"]


def inputs(netlist: Sequence[Part]) -> int:
    """The number of inputs."""
    sources = [x.value for x in netlist if x.kind in ("voltage_source", "current_source")]
    return 1 + max((int(x) for x in sources if x is not None), default=-1)


def _input(index: int) -> Variable:
    return Variable(str(index), "u")


def _ports(netlist: Iterable[Part]) -> list[tuple[str, str, str]]:
    result = []
    for part in netlist:
        result.append((part.name, part.tail, part.head))
        if part.second is not None:
            result.append((f"{part.name}.second", *part.second))
    return result


@lru_cache(maxsize=32)
def _tableau(netlist: tuple[Part, ...]) -> list[Equation]:
    """E w' = A w + B u: KVL, KCL, and the laws."""
    across, through = [], defaultdict(list)
    for name, tail, head in _ports(netlist):
        p, q = Jet(Variable(tail, "p"), 0), Jet(Variable(head, "p"), 0)
        X, Y = Jet(Variable(name, "X"), 0), Jet(Variable(name, "Y"), 0)
        across.append(_sum((X, 1), (p, -1), (q, 1)))
        through[p].append((Y, 1))
        through[q].append((Y, -1))
    _, kvl = _solved(across, set(through))
    flows = {Jet(variable, 0) for variable in variables(netlist) if variable.letter == "Y"}
    kcl, _ = _solved([_sum(*terms) for terms in through.values()], flows)
    equations = [*kvl, *kcl.values(), *(law for part in netlist for law in _laws(part))]
    if len(equations) != len(variables(netlist)):
        raise ValueError("a name is used twice")
    return equations


def _laws(part: Part) -> list[Equation]:
    X, Y = Jet(Variable(part.name, "X"), 0), Jet(Variable(part.name, "Y"), 0)
    second = f"{part.name}.second"
    X2, Y2 = Jet(Variable(second, "X"), 0), Jet(Variable(second, "Y"), 0)
    of = part.of or ""
    X0, Y0 = Jet(Variable(of, "X"), 0), Jet(Variable(of, "Y"), 0)
    if part.kind == "opamp":
        return [{X: 1}, {Y: 1}]
    if part.kind == "voltage_source":
        return [{X: 1, Jet(_input(int(part.value or 0)), 0): -1}]
    if part.kind == "current_source":
        return [{Y: 1, Jet(_input(int(part.value or 0)), 0): -1}]
    a = Fraction(str(part.value))
    match part.kind:
        case "resistor":
            return [_sum((X, 1), (Y, -a))]
        case "conductance":
            return [_sum((Y, 1), (X, -a))]
        case "capacitor":
            return [_sum((Y, 1), (X._replace(times=1), -a))]
        case "inductor":
            return [_sum((X, 1), (Y._replace(times=1), -a))]
        case "vcvs":
            return [_sum((X, 1), (X0, -a))]
        case "vccs":
            return [_sum((Y, 1), (X0, -a))]
        case "ccvs":
            return [_sum((X, 1), (Y0, -a))]
        case "cccs":
            return [_sum((Y, 1), (Y0, -a))]
        case "transformer":
            return [_sum((X, 1), (X2, -a)), _sum((Y, a), (Y2, 1))]
        case "gyrator":
            return [_sum((X, 1), (Y2, -a)), _sum((X2, 1), (Y, a))]
    raise ValueError(part.kind)


@lru_cache(maxsize=32)
def _shuffled(netlist: tuple[Part, ...]) -> tuple[list[Equation], dict[Jet, Equation]]:
    """All constraints among w, u and derivatives of u, and w' in terms of them.

    Each equation differentiated raises the degree of det(s E - A) by one, which is the number of
    equations once E is regular. So there are as many constraints as that number exceeds the order.
    """
    equations = _tableau(netlist)
    w = variables(netlist)
    rates, values = {Jet(i, 1) for i in w}, {Jet(i, 0) for i in w}
    constraints: list[Equation] = []
    while True:
        moving, still = _solved(equations, rates)
        if not still:
            return constraints, moving
        static, rest = _solved(still, values)
        constraints += static.values()
        if rest or len(constraints) > len(w):
            raise Singular
        equations = [*moving.values(), *map(_differentiated, static.values())]


def _moves(equation: Equation) -> bool:
    return any(jet.times for jet in equation)


def _differentiated(equation: Equation) -> Equation:
    return {Jet(variable, times + 1): a for (variable, times), a in equation.items()}


def _sum(*terms: tuple[Jet, int | Fraction]) -> Equation:
    result: dict[Jet, Fraction] = defaultdict(Fraction)
    for jet, a in terms:
        result[jet] += a
    scale = math.lcm(*(a.denominator for a in result.values()))
    return _whole({jet: int(a * scale) for jet, a in result.items()})


def _whole(equation: Mapping[Jet, int]) -> Equation:
    """Without what is zero, and divided by what all coefficients have in common."""
    common = math.gcd(*equation.values()) or 1
    return {jet: a // common for jet, a in equation.items() if a}


def _without(equation: Equation, jet: Jet, pivot: Equation) -> Equation:
    """A combination of two equations in which a variable does not occur."""
    a, b = equation[jet], pivot[jet]
    common = math.gcd(a, b)
    a, b = a // common, b // common
    result = {i: b * x for i, x in equation.items()}
    for i, x in pivot.items():
        result[i] = result.get(i, 0) - a * x
    return _whole(result)


def _substituted(equation: Equation, solved: Mapping[Jet, Equation]) -> Equation:
    """An equation without what `_solved` has solved for."""
    for jet in [jet for jet in equation if jet in solved]:
        equation = _without(equation, jet, solved[jet])
    return equation


def _solved(
    equations: Iterable[Equation], wanted: Collection[Jet]
) -> tuple[dict[Jet, Equation], list[Equation]]:
    """Equations solved for as many of the wanted as possible (Gauss-Jordan), and those without any.

    No solved equation has what another is solved for. What says 0 = 0 is among the rest.
    """
    rows = dict(enumerate(equations))
    where: dict[Jet, set[int]] = defaultdict(set)
    for i, row in rows.items():
        for jet in row:
            where[jet].add(i)
    solved: dict[Jet, Equation] = {}
    owner: dict[Jet, int] = {}
    todo = dict.fromkeys(rows)
    rest = []
    while todo:
        i = min(todo, key=lambda i: len(rows[i]))
        del todo[i]
        candidates = [jet for jet in rows[i] if jet in wanted]
        if not candidates:
            rest.append(rows[i])
            for jet in rows[i]:
                where[jet].discard(i)
            continue
        jet = min(candidates, key=lambda jet: (len(where[jet]), jet))
        for j in where[jet] - {i}:
            before, after = rows[j], _without(rows[j], jet, rows[i])
            for k in before.keys() - after.keys():
                if k != jet:
                    where[k].discard(j)
            for k in after.keys() - before.keys():
                where[k].add(j)
            rows[j] = after
        where[jet] = {i}
        owner[jet] = i
    solved = {jet: rows[i] for jet, i in owner.items()}
    return solved, rest


def _determinant_modulo(rows: list[dict[int, int]]) -> int:
    """The determinant of a square matrix of sparse rows, modulo the prime."""
    result = 1
    left = dict(enumerate(rows))
    chosen: list[int] = []
    columns: list[int] = []
    while left:
        i = min(left, key=lambda i: len(left[i]))
        pivot = left.pop(i)
        if not pivot:
            return 0
        having = {j: [k for k, row in left.items() if j in row] for j in pivot}
        j = min(pivot, key=lambda j: len(having[j]))
        chosen.append(i)
        columns.append(j)
        result = result * pivot[j] % PRIME
        inverse = pow(pivot[j], -1, PRIME)
        for k in having[j]:
            row = left[k]
            factor = row[j] * inverse % PRIME
            for m, a in pivot.items():
                b = (row.get(m, 0) - factor * a) % PRIME
                if b:
                    row[m] = b
                else:
                    row.pop(m, None)
    return result * _sign(chosen) * _sign(columns) % PRIME


def _sign(permutation: Sequence[int]) -> int:
    result, seen = 1, set()
    for start in permutation:
        i = start
        while i not in seen:
            seen.add(i)
            i = permutation[i]
            if i != start:
                result = -result
    return result


def _determinant(matrix: list[list[int]]) -> int:
    """The determinant of a square matrix of integers (Bareiss)."""
    n, sign, previous = len(matrix), 1, 1
    for k in range(n - 1):
        row = next((i for i in range(k, n) if matrix[i][k]), None)
        if row is None:
            return 0
        if row != k:
            matrix[k], matrix[row] = matrix[row], matrix[k]
            sign = -sign
        pivot, top = matrix[k][k], matrix[k]
        for i in range(k + 1, n):
            a, line = matrix[i][k], matrix[i]
            for j in range(k + 1, n):
                line[j] = (line[j] * pivot - a * top[j]) // previous
        previous = pivot
    return sign * matrix[-1][-1] if n else 1


def _interpolated(points: Sequence[int], values: Sequence[int]) -> list[Fraction]:
    """The coefficients, from the lowest, of the polynomial that has these values (Newton)."""
    differences = [Fraction(x) for x in values]
    n = len(points)
    for k in range(1, n):
        for i in range(n - 1, k - 1, -1):
            differences[i] = (differences[i] - differences[i - 1]) / (points[i] - points[i - k])
    zero = Fraction(0)
    result = [zero]
    for i in range(n - 1, -1, -1):
        result = [
            up - points[i] * a for up, a in zip([zero, *result], [*result, zero], strict=True)
        ]
        result[0] += differences[i]
    return result

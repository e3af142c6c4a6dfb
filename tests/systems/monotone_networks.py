"""Seeded random networks of monotone laws whose one solution is known, because it was chosen first.

Potentials are drawn, then elements between them: what flows in each follows from its law, and a current
source at every vertex takes up what is left. Every element is monotone, so that all solutions together are a
convex set; where the equations are regular at the chosen one, there is no other [Minty 1960].

A stage is an amplifier with limits and negative feedback. With its output v and its input e, the potential of
a vertex of its own, ``v = clip(-gain e)`` and ``e = share v + rest``: one solution, because the left side of
``e - share clip(-gain e) = rest`` rises with e.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from random import Random
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from linegraph import Model

if TYPE_CHECKING:
    from collections.abc import Callable

GROUND = "ground"
REGULAR = 1e-7
"""The least singular value of the equations in the network's own units, relative to the largest."""


class Curve(NamedTuple):
    """A rising function: its text in the argument ``{}``, and its value."""

    text: str
    value: Callable[[float], float]


def saturation(r: Random, width: float, height: float) -> Curve:
    g, shift = height / width * r.choice((1, 10, 1000)), r.choice((0.0, width * r.uniform(-1, 1)))
    low, high = -height * r.choice((1, 0.3)), height
    return Curve(
        f"min({high!r}, max({low!r}, {g!r}*({{}} - ({shift!r}))))",
        lambda x: min(high, max(low, g * (x - shift))),
    )


def smooth_saturation(r: Random, width: float, height: float) -> Curve:
    w = width * r.choice((1, 0.1, 0.01))
    return Curve(f"{height!r}*tanh({{}}/{w!r})", lambda x: height * math.tanh(x / w))


def round_saturation(r: Random, width: float, height: float) -> Curve:
    return Curve(f"{height!r}*atan({{}}/{width!r})", lambda x: height * math.atan(x / width))


def dead_zone(r: Random, width: float, height: float) -> Curve:
    g, low, high = height / width, -width * r.uniform(0, 1), width * r.uniform(0, 1)
    return Curve(
        f"{g!r}*(max(0, {{0}} - {high!r}) + min(0, {{0}} - ({low!r})))",
        lambda x: g * (max(0, x - high) + min(0, x - low)),
    )


def saturation_of_sizes(r: Random, width: float, height: float) -> Curve:
    g = height / width
    return Curve(
        f"{g / 2!r}*(abs({{0}} + {width!r}) - abs({{0}} - {width!r}))",
        lambda x: g / 2 * (abs(x + width) - abs(x - width)),
    )


def rectifier(r: Random, width: float, height: float) -> Curve:
    g, knee, leak = height / width, width * r.uniform(-0.5, 0.5), r.choice((0, 1e-6, 1e-3))
    return Curve(
        f"{g!r}*(max(0, {{0}} - ({knee!r})) + {leak!r}*{{0}})",
        lambda x: g * (max(0, x - knee) + leak * x),
    )


def exponential(r: Random, width: float, height: float) -> Curve:
    saturation, voltage = height * 10 ** r.uniform(-14, -3), width / r.uniform(3, 30)
    return Curve(
        f"{saturation!r}*(exp({{}}/{voltage!r}) - 1)",
        lambda x: saturation * math.expm1(x / voltage) if x / voltage < 100 else math.inf,
    )


def cube(r: Random, width: float, height: float) -> Curve:
    g = height / width**3
    return Curve(f"{g!r}*({{}})**3", lambda x: g * x**3)


def square(r: Random, width: float, height: float) -> Curve:
    g = height / width**2
    return Curve(f"{g!r}*({{0}})*abs({{0}})", lambda x: g * x * abs(x))


def root(r: Random, width: float, height: float) -> Curve:
    g = height / math.sqrt(width)
    return Curve(
        f"{g!r}*sign({{0}})*sqrt(abs({{0}}))", lambda x: g * math.copysign(math.sqrt(abs(x)), x)
    )


CURVES = (
    saturation,
    smooth_saturation,
    round_saturation,
    dead_zone,
    saturation_of_sizes,
    rectifier,
    exponential,
    cube,
    square,
    root,
)


@dataclass
class Edge:
    """An edge of the network, with what is known at the solution.

    Attributes:
        x, y: across and through variable.
        dx, dy: the slopes of its law ``dx x + dy y = ...``.
        add: adds it to a model.
    """

    name: str
    ends: tuple[str, str]
    x: float
    y: float
    dx: float
    dy: float
    add: Callable[[Model], None]


@dataclass
class Drawn:
    """A network, its state and inputs, and its solution."""

    edges: list[Edge] = field(default_factory=list)
    state: dict[str, float] = field(default_factory=dict)
    inputs: list[float] = field(default_factory=list)

    def model(self) -> Model:
        """In the builder's words, with every variable an output."""
        model = Model("monotone")
        for k in range(len(self.inputs)):
            model.input(f"u{k}")
        for edge in self.edges:
            edge.add(model)
        for edge in self.edges:
            model.output(f"x_{edge.name}", f"across({edge.name})")
            model.output(f"y_{edge.name}", f"through({edge.name})")
        return model

    def expected(self) -> list[float]:
        """The outputs at the solution."""
        return [value for edge in self.edges for value in (edge.x, edge.y)]


class _Drawing:
    def __init__(self, seed: int) -> None:
        self.r = Random(seed)
        self.potential = {GROUND: 0.0}
        self.surplus: dict[str, float] = {}
        self.drawn = Drawn()
        self.volts = 10 ** self.r.uniform(-0.5, 1.5)
        self.amperes = 10 ** self.r.uniform(-3, 1)

    def name(self, letter: str) -> str:
        return f"{letter}{len(self.drawn.edges)}"

    def vertex(self, potential: float | None = None) -> str:
        name = f"n{len(self.potential)}"
        self.potential[name] = (
            self.r.uniform(-1, 1) * self.volts if potential is None else potential
        )
        return name

    def x(self, ends: tuple[str, str]) -> float:
        return self.potential[ends[0]] - self.potential[ends[1]]

    def edge(
        self,
        letter: str,
        ends: tuple[str, str],
        y: float,
        slopes: tuple[float, float],
        add: Callable[[Model, str], None],
    ) -> None:
        name = self.name(letter)
        self.drawn.edges.append(Edge(name, ends, self.x(ends), y, *slopes, lambda m: add(m, name)))

    def source(self, value: float) -> str:
        """An expression of this value: a number, an input, or kinks of an input."""
        r, kind = self.r, self.r.random()
        if kind < 0.4:
            return repr(value)
        place, given = len(self.drawn.inputs), r.uniform(-2, 2)
        u, size = f"u{place}", abs(value) + 1e-3 * self.volts
        self.drawn.inputs.append(given)
        if kind < 0.6:
            self.drawn.inputs[-1] = value
            return u
        curve, number = r.choice(
            (
                (f"abs({u})", abs(given)),
                (f"max({u}, 0.3)", max(given, 0.3)),
                (f"min(1, max(-1, {u}))", min(1, max(-1, given))),
                (f"max(0, {u} - 1) + min(0, {u} + 1)", max(0, given - 1) + min(0, given + 1)),
            )
        )
        return f"{size!r}*({curve}) + ({value - size * number!r})"

    def rising(self, ends: tuple[str, str]) -> None:
        """An element whose through variable rises with its across variable."""
        r = self.r
        x = self.x(ends)
        for _ in range(20):
            width = self.volts * 10 ** r.uniform(-1, 0.5)
            made = r.choice(CURVES)(r, width, self.amperes * 10 ** r.uniform(-1, 1))
            y = made.value(x)
            if abs(y) <= 100 * self.amperes:
                break
        else:
            return
        law = "y = " + made.text.format("x")
        self.edge(
            "N",
            ends,
            y,
            (_slope(made, x), -1.0),
            lambda m, name: m.element(name, ends, "electrical", law=law),
        )

    def series(self, near: str, far: str) -> None:
        """An element whose across variable rises with its through variable, behind it another."""
        r = self.r
        y = r.uniform(-1, 1) * self.amperes
        for _ in range(20):
            height = self.volts * 10 ** r.uniform(-1, 0.3)
            made = r.choice(CURVES)(r, self.amperes * 10 ** r.uniform(-1, 0.5), height)
            x = made.value(y)
            if abs(x) <= 20 * self.volts:
                break
        else:
            return
        middle = self.vertex(self.potential[near] - x)
        ends = (near, middle)
        law = "x = " + made.text.format("y")
        self.edge(
            "Y",
            ends,
            y,
            (-1.0, _slope(made, y)),
            lambda m, name: m.element(name, ends, "electrical", law=law),
        )
        self.any((middle, far))

    def resistor(self, ends: tuple[str, str]) -> None:
        value = self.volts / self.amperes * 10 ** self.r.uniform(-1.5, 1.5)
        self.edge(
            "R",
            ends,
            self.x(ends) / value,
            (1.0, -value),
            lambda m, name: m.resistor(name, ends, resistance=value),
        )

    def voltage(self, ends: tuple[str, str]) -> None:
        text = self.source(self.x(ends))
        self.edge(
            "V",
            ends,
            self.r.uniform(-1, 1) * self.amperes,
            (1.0, 0.0),
            lambda m, name: m.voltage_source(name, ends, voltage=text),
        )

    def capacitor(self, ends: tuple[str, str]) -> None:
        name = self.name("C")
        self.drawn.state[f"v_{name}"] = self.x(ends)
        self.edge(
            "C",
            ends,
            self.r.uniform(-1, 1) * self.amperes,
            (1.0, 0.0),
            lambda m, name: m.capacitor(name, ends, capacitance=1e-3),
        )

    def inductor(self, ends: tuple[str, str]) -> None:
        name, y = self.name("L"), self.r.uniform(-1, 1) * self.amperes
        self.drawn.state[f"i_{name}"] = y
        self.edge("L", ends, y, (0.0, 1.0), lambda m, name: m.inductor(name, ends, inductance=1e-3))

    def diode(self, ends: tuple[str, str]) -> None:
        saturation, voltage = 10 ** self.r.uniform(-14, -6), self.r.choice((0.02585, 0.05))
        x = self.x(ends) / voltage
        if x > 60 or saturation * math.exp(x) > 100 * self.amperes:
            return
        grown = math.exp(x)
        self.edge(
            "D",
            ends,
            saturation * (grown - 1),
            (saturation * grown / voltage, -1.0),
            lambda m, name: m.diode(name, ends, saturation=saturation, voltage=voltage),
        )

    def stage(self, near: str) -> None:
        """An amplifier: its input between two resistors, its output limited."""
        r = self.r
        gain, limit = 10 ** r.uniform(1, 5), self.volts * 10 ** r.uniform(-0.3, 0.5)
        out = r.uniform(-1, 1) * limit if r.random() < 0.5 else limit * r.choice((-1, 1))
        e = -out / gain
        if abs(out) == limit:
            e *= 1 + 10 ** r.uniform(-2, 3)
        inside, output = self.vertex(e), self.vertex(out)
        self.resistor((near, inside))
        self.resistor((output, inside))
        sense = self.name("S")
        self.edge(
            "S",
            (inside, GROUND),
            0.0,
            (0.0, 1.0),
            lambda m, name: m.conductance(name, (inside, GROUND), conductance=0),
        )
        law = f"min({limit!r}, max({-limit!r}, {-gain!r}*across({sense})))"
        self.edge(
            "A",
            (output, GROUND),
            r.uniform(-1, 1) * self.amperes,
            (1.0, 0.0),
            lambda m, name: m.voltage_source(name, (output, GROUND), voltage=law),
        )
        self.any((output, near))

    def any(self, ends: tuple[str, str]) -> None:
        if ends[0] == ends[1]:
            return
        kind = self.r.choices(
            (self.rising, self.resistor, self.diode, self.voltage, self.capacitor, self.inductor),
            (50, 20, 15, 4, 4, 4),
        )[0]
        kind(ends)

    def balanced(self) -> Drawn:
        """Sources that take up what is left at every vertex."""
        left = dict.fromkeys(self.potential, 0.0)
        for edge in self.drawn.edges:
            left[edge.ends[0]] += edge.y
            left[edge.ends[1]] -= edge.y
        for vertex, flow in left.items():
            if vertex == GROUND:
                continue
            text, ends = self.source(-flow), (vertex, GROUND)
            self.edge(
                "J",
                ends,
                -flow,
                (0.0, 1.0),
                lambda m, name, ends=ends, text=text: m.current_source(name, ends, current=text),
            )
        return self.drawn


def _slope(curve: Curve, x: float) -> float:
    """The slope of a curve, at its kinks that of one side."""
    h = 1e-7 * (abs(x) + 1e-3)
    return (curve.value(x + h) - curve.value(x - h)) / (2 * h)


def _regular(drawn: Drawn, volts: float, amperes: float) -> bool:
    """Whether the equations have full rank at the solution: potentials and flows are the unknowns."""
    vertices = sorted({end for edge in drawn.edges for end in edge.ends} - {GROUND})
    n, m = len(vertices), len(drawn.edges)
    place = {vertex: k for k, vertex in enumerate(vertices)}
    A = np.zeros((n + m, n + m))
    for k, edge in enumerate(drawn.edges):
        across, through = edge.dx * volts, edge.dy * amperes
        size = max(abs(across), abs(through))
        for end, sign in zip(edge.ends, (1, -1), strict=True):
            if end != GROUND:
                A[place[end], n + k] += sign
                A[n + k, place[end]] += sign * across / size
        A[n + k, n + k] += through / size
    sizes = np.linalg.svd(A, compute_uv=False)
    return bool(sizes[-1] > REGULAR * sizes[0])


def draw(seed: int) -> Drawn:
    """A network by its number."""
    for attempt in range(1000):
        drawing = _Drawing(1000 * seed + attempt)
        r = drawing.r
        vertices = [GROUND]
        for _ in range(r.randint(1, 6)):
            new = drawing.vertex()
            drawing.any((new, r.choice(vertices)))
            vertices.append(new)
        for _ in range(r.randint(1, 6)):
            near, far = r.choice(vertices), r.choice(vertices)
            if r.random() < 0.3:
                drawing.series(near, far)
            else:
                drawing.any((near, far))
        if r.random() < 0.2:
            drawing.stage(r.choice(vertices))
        drawn = drawing.balanced()
        if all(math.isfinite(v) for v in drawn.expected()) and _regular(
            drawn, drawing.volts, drawing.amperes
        ):
            return drawn
    raise AssertionError("nothing regular was drawn")

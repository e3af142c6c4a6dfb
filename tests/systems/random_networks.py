"""Seeded random linear networks, as netlists for the oracle in `network_pencil`.

A network starts with a source and grows by pieces, each attached to vertices that exist, so it is
connected to ground and no vertex is a dead end. Whatever fixes a voltage (a voltage source, a
controlled one, port 2 of a transformer, the output of an op-amp) gets a vertex of its own: that is
why most of what is drawn has one solution. A few networks get a loop of voltage sources or a
cutset of current sources that leaves them without one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from random import Random

from oracles.network_pencil import Part

GROUND = "ground"
SMALLEST, LARGEST = 3, 40
"""The number of edges: a part with two ports has two."""

LETTERS = {
    "resistor": "R",
    "conductance": "S",
    "capacitor": "C",
    "inductor": "L",
    "voltage_source": "V",
    "current_source": "I",
    "vcvs": "E",
    "vccs": "G",
    "ccvs": "H",
    "cccs": "F",
    "transformer": "T",
    "gyrator": "N",
    "opamp": "U",
}
"""What the names of parts start with."""

SIMPLE = {"resistor": 30, "conductance": 12, "capacitor": 30, "inductor": 28}
"""Kinds with one port, and how often each is drawn."""

PIECES = {
    "bridge": (1, 24),
    "pair": (2, 28),
    "controlled_current": (1, 8),
    "controlled_voltage": (2, 8),
    "transformer": (3, 8),
    "gyrator": (3, 8),
    "follower": (3, 4),
    "inverter": (4, 4),
    "amplifier": (4, 4),
    "capacitor_loop": (3, 3),
    "inductor_cutset": (3, 3),
}
"""Edges of each piece at most, and how often it is drawn where it fits."""

FORCED = 0.3
"""How often a loop of capacitors is forced, and a cutset of inductors."""

ILL_POSED = 0.02


def draw(seed: int) -> list[Part]:
    """A network of 3 to 40 edges with inputs u[0] to u[2] at most."""
    random = Random(seed)
    edges = random.randint(SMALLEST, LARGEST)
    loop, cutset, spoilt = (random.random() < x for x in (FORCED, FORCED, ILL_POSED))
    pieces = loop * ["capacitor_loop"] + cutset * ["inductor_cutset"]
    edges = max(edges, 3 + 3 * len(pieces))
    sources = min(random.randint(1, 3), edges // 4 + 1)
    pieces += (sources - 1) * ["source"] + spoilt * ["contradiction"]
    random.shuffle(pieces)
    edges = max(edges, 2 + sum(_size(x) for x in pieces))
    network = _Network(random, spare=3 - sources)
    network.source()
    while network.edges < edges:
        room = edges - network.edges - sum(_size(x) for x in pieces)
        fitting = [x for x, (size, _) in PIECES.items() if size <= room]
        if pieces and (not fitting or random.random() < 0.25):
            piece = pieces.pop()
        else:
            piece = random.choices(fitting, [PIECES[x][1] for x in fitting])[0]
        getattr(network, piece)()
    random.shuffle(network.parts)
    return network.parts


def _size(piece: str) -> int:
    return PIECES[piece][0] if piece in PIECES else 2


@dataclass
class _Network:
    """A network that grows."""

    random: Random
    parts: list[Part] = field(default_factory=list)
    vertices: list[str] = field(default_factory=lambda: [GROUND])
    inputs: int = 0
    spare: int = 0
    """How many inputs there may be beside those of `source`."""

    @property
    def edges(self) -> int:
        return sum(1 if part.second is None else 2 for part in self.parts)

    def source(self) -> None:
        """An independent source with a load."""
        if self.random.random() < 0.6:
            (tail,) = self.some(1)
            new = self.new()
            self.add("voltage_source", new, tail, self.inputs)
            self.load(new)
        elif len(self.vertices) == 1:
            new = self.new()
            self.add("current_source", GROUND, new, self.inputs)
            self.load(new)
        else:
            tail, head = self.some(2)
            self.add("current_source", tail, head, self.inputs)
        self.inputs += 1

    def bridge(self) -> None:
        self.simple(*self.some(2))

    def pair(self) -> None:
        tail, head = self.some(2)
        new = self.new()
        self.simple(tail, new)
        self.simple(new, head)

    def controlled_current(self) -> None:
        kind = self.random.choice(("vccs", "cccs"))
        tail, head = self.some(2)
        self.add(kind, tail, head, self.gain(), of=self.control())

    def controlled_voltage(self) -> None:
        kind, of = self.random.choice(("vcvs", "ccvs")), self.control()
        (tail,) = self.some(1)
        new = self.new()
        self.add(kind, new, tail, self.gain(), of=of)
        self.load(new)

    def transformer(self) -> None:
        self.coupled("transformer")

    def gyrator(self) -> None:
        self.coupled("gyrator")

    def coupled(self, kind: str) -> None:
        tail, head = self.some(2)
        (far,) = self.some(1)
        new = self.new()
        second = (new, far) if self.random.random() < 0.5 else (far, new)
        self.add(kind, tail, head, self.gain(), second=second)
        self.load(new)

    def follower(self) -> None:
        (plus,) = self.some(1)
        out = self.new()
        self.add("opamp", plus, out, second=(out, GROUND))
        self.load(out)

    def inverter(self) -> None:
        """An op-amp that inverts, integrates or, more seldom, differentiates."""
        (plus,) = self.some(1) if self.random.random() < 0.2 else (GROUND,)
        start = self.other(plus)
        minus, out = self.new(), self.new()
        kinds = self.random.choices(
            (("resistor", "resistor"), ("resistor", "capacitor"), ("capacitor", "resistor")),
            (4, 5, 1),
        )[0]
        self.simple(start, minus, kinds[0])
        self.simple(minus, out, kinds[1])
        self.add("opamp", plus, minus, second=(out, GROUND))

    def amplifier(self) -> None:
        """An op-amp that does not invert."""
        plus, foot = self.some(2)
        minus, out = self.new(), self.new()
        self.simple(foot, minus, "resistor")
        self.simple(minus, out, self.random.choice(("resistor", "resistor", "capacitor")))
        self.add("opamp", plus, minus, second=(out, GROUND))

    def capacitor_loop(self) -> None:
        """Up to three capacitors that close a loop, perhaps one with a voltage source."""
        kinds = ("capacitor", "voltage_source", "vcvs", "ccvs")
        over = [part for part in self.parts if part.kind in kinds]
        tail, head = self.some(2)
        if over and self.random.random() < 0.5:
            part = self.random.choice(over)
            tail, head = part.tail, part.head
        else:
            self.simple(tail, head, "capacitor")
        if self.random.random() < 0.5:
            self.simple(tail, head, "capacitor")
        else:
            new = self.new()
            self.simple(tail, new, "capacitor")
            self.simple(new, head, "capacitor")

    def inductor_cutset(self) -> None:
        """A vertex with inductors only, or with a current source beside them."""
        ends = self.some(self.random.choice((2, 3)) if len(self.vertices) > 2 else 2)
        control = self.control()
        new = self.new()
        for end in ends:
            self.simple(new, end, "inductor")
        if len(ends) == 2 and self.random.random() < 0.5:
            (end,) = self.some(1, but=new)
            if self.spare and self.random.random() < 0.5:
                self.add("current_source", end, new, self.inputs)
                self.inputs += 1
                self.spare -= 1
            else:
                kind = self.random.choice(("vccs", "cccs"))
                self.add(kind, end, new, self.gain(), of=control)

    def contradiction(self) -> None:
        """A loop of voltage sources, or a cutset of current sources."""
        if self.random.random() < 0.5:
            (tail,) = self.some(1)
            new = self.new()
            self.add("voltage_source", new, tail, 0)
            self.add("voltage_source", new, tail, 0)
        else:
            tail, head = self.some(2)
            new = self.new()
            self.add("current_source", tail, new, 0)
            self.add("current_source", new, head, 0)

    def some(self, count: int, but: str | None = None) -> list[str]:
        """Distinct vertices, among which ground is more likely."""
        left = [vertex for vertex in self.vertices if vertex != but]
        result = []
        for _ in range(count):
            if GROUND in left and self.random.random() < 0.25:
                result.append(GROUND)
            else:
                result.append(self.random.choice(left))
            left.remove(result[-1])
        self.random.shuffle(result)
        return result

    def other(self, vertex: str) -> str:
        return self.some(1, but=vertex)[0]

    def new(self) -> str:
        self.vertices.append(f"n{len(self.vertices)}")
        return self.vertices[-1]

    def control(self) -> str:
        """A part whose port is not dead."""
        return self.random.choice([x for x in self.parts if x.kind != "opamp"]).name

    def load(self, vertex: str) -> None:
        """A part from a vertex to another, more often one that does not store."""
        kinds = ("resistor", "conductance") if self.random.random() < 0.6 else tuple(SIMPLE)
        self.simple(vertex, self.other(vertex), self.random.choice(kinds))

    def simple(self, tail: str, head: str, kind: str | None = None) -> None:
        if kind is None:
            kind = self.random.choices(list(SIMPLE), list(SIMPLE.values()))[0]
        if self.random.random() < 0.5:
            tail, head = head, tail
        self.add(kind, tail, head, self.value())

    def add(
        self,
        kind: str,
        tail: str,
        head: str,
        value: float | None = None,
        *,
        second: tuple[str, str] | None = None,
        of: str | None = None,
    ) -> None:
        number = 1 + sum(part.kind == kind for part in self.parts)
        name = f"{LETTERS[kind]}{number}"
        self.parts.append(Part(kind, name, tail, head, value, second, of))

    def value(self) -> float:
        return round(math.exp(self.random.uniform(math.log(0.2), math.log(5.0))), 3)

    def gain(self) -> float:
        return self.value() * (-1 if self.random.random() < 0.3 else 1)

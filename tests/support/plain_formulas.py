"""Formulas in plain text, read back and computed: what is printed is what holds."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

TOKEN = re.compile(
    r"\s*(?:(?P<number>\d+(?:\.\d+)?)|(?P<power>[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)|(?P<sign>[+−·/(),;\[\]^√])|"
    r"(?P<name>[^\s+−·/(),;\[\]^√⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+))"
)
DIGITS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
FUNCTIONS: dict[str, Callable[..., float]] = {
    **{
        name: getattr(math, name)
        for name in ("sin", "cos", "tan", "exp", "tanh", "atan2", "asin", "acos")
    },
    "abs": abs,
    "ln": math.log,
    "max": max,
    "min": min,
    "sign": lambda x: (x > 0) - (x < 0),
}


@dataclass
class Reader:
    """Reads one formula, left to right."""

    values: Mapping[str, float]

    def __call__(self, text: str) -> float:
        self.tokens = [(str(m.lastgroup), m[m.lastgroup or 0]) for m in TOKEN.finditer(text)]
        assert "".join(t for _, t in self.tokens) == text.replace(" ", ""), text
        self.place = 0
        found = self.total()
        assert self.place == len(self.tokens), (text, self.tokens[self.place :])
        return found

    def peek(self) -> str:
        return self.tokens[self.place][1] if self.place < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        token = self.peek()
        assert not wanted or token == wanted, (token, wanted)
        self.place += 1
        return token

    def total(self) -> float:
        sign = -1.0 if self.peek() == "−" else 1.0
        if sign < 0:
            self.take()
        found = sign * self.product()
        while self.peek() in ("+", "−"):
            sign = 1.0 if self.take() == "+" else -1.0
            found += sign * self.product()
        return found

    def product(self) -> float:
        found = self.power()
        while self.peek() in ("·", "/"):
            found = found * self.power() if self.take() == "·" else found / self.power()
        return found

    def power(self) -> float:
        found = self.atom()
        if self.place < len(self.tokens) and self.tokens[self.place][0] == "power":
            found = found ** int(self.take().translate(DIGITS))
        elif self.peek() == "^":
            self.take()
            found = found ** self.bracket()[0]
        return found

    def bracket(self) -> list[float]:
        self.take("(")
        found = [self.total()]
        while self.peek() == ",":
            self.take()
            found.append(self.total())
        self.take(")")
        return found

    def atom(self) -> float:
        kind, token = self.tokens[self.place]
        if token == "(":
            return self.bracket()[0]
        self.take()
        if token == "√":
            return math.sqrt(self.bracket()[0])
        if kind == "number":
            return float(token)
        assert kind == "name", token
        raised = self.place < len(self.tokens) and self.tokens[self.place][0] == "power"
        if raised and self.place + 1 < len(self.tokens) and self.tokens[self.place + 1][1] == "(":
            power = int(self.take().translate(DIGITS))
            return FUNCTIONS[token](*self.bracket()) ** power
        if token in FUNCTIONS and self.peek() == "(":
            return FUNCTIONS[token](*self.bracket())
        return self.values[token]


def entries(text: str) -> list[list[str]]:
    """The entries of a matrix or of a column in plain text."""
    inner = text[1:-1]
    if text[0] == "[":
        return [_split(row) for row in _split(inner, ";")]
    return [[entry] for entry in _split(inner)]


def _split(text: str, sign: str = ",") -> list[str]:
    found, depth, start = [], 0, 0
    for k, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        if letter == sign and not depth:
            found.append(text[start:k].strip())
            start = k + 1
    return [*found, text[start:].strip()]

"""Random scalar networks against a descriptor pencil reduced in exact arithmetic, written apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from oracles import network_pencil
from support.network_models import linear
from systems.random_networks import draw

from linegraph import Model, ModelError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from oracles.network_pencil import Part

SEEDS = 1000
CHUNK = 50

CONTROLLED = {"vcvs": "voltage", "ccvs": "voltage", "vccs": "current", "cccs": "current"}
LETTER = {"v": "across", "c": "through"}


def model_of(parts: Sequence[Part]) -> Model:
    """A netlist in the builder's words."""
    model = Model("random")
    for k in range(network_pencil.inputs(parts)):
        model.input(f"u{k}")
    ports = {part.name: part for part in parts}
    for part in parts:
        ends = (part.tail, part.head)
        if part.kind in ("voltage_source", "current_source"):
            word = part.kind.removesuffix("_source")
            getattr(model, part.kind)(part.name, ends, **{word: f"u{part.value}"})
        elif part.kind in CONTROLLED:
            field = CONTROLLED[part.kind]
            of = str(part.of)
            two = ports[of].kind in ("transformer", "gyrator")
            edge = (
                f"{of}.{'first' if two else 'output' if ports[of].kind == 'opamp' else ''}".rstrip(
                    "."
                )
            )
            law = f"({part.value!r})*{LETTER[part.kind[0]]}({edge})"
            getattr(model, f"{field}_source")(part.name, ends, **{field: law})
        elif part.kind in ("transformer", "gyrator"):
            getattr(model, part.kind)(part.name, ends, second=part.second, ratio=part.value)
        elif part.kind == "opamp":
            model.opamp(part.name, ends, output=part.second)
        else:
            field = {"resistor": "resistance", "capacitor": "capacitance", "inductor": "inductance"}
            getattr(model, part.kind)(
                part.name, ends, **{field.get(part.kind, part.kind): part.value}
            )
    return model


@pytest.mark.seeds(range(0, SEEDS, 6 * CHUNK), range(0, SEEDS, CHUNK))
def test_states_and_matrices_are_those_of_the_pencil(seed: int) -> None:
    for number in range(seed, seed + CHUNK):
        parts = draw(number)
        try:
            order = network_pencil.order(parts)
        except network_pencil.Singular:
            with pytest.raises(ModelError):
                linear(model_of(parts))
            continue
        states, A, B = linear(model_of(parts))
        assert len(states) == order, number
        expected = network_pencil.reduce(parts, [(edge, kind) for kind, edge in states])
        scale = 1 + np.max(np.abs(expected.A), initial=0.0)
        assert np.max(np.abs(A - expected.A), initial=0.0) <= 1e-9 * scale, number
        for k, wanted in enumerate((expected.B0, expected.B1, expected.B2)):
            scale = 1 + np.max(np.abs(wanted), initial=0.0)
            assert np.max(np.abs(B[k] - wanted), initial=0.0) <= 1e-9 * scale, (number, k)

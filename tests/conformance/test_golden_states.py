"""Where golden vectors ask: what a state hides that is legal, locked or loud is seen at others."""

from __future__ import annotations

import random
import re
from typing import TYPE_CHECKING

import numpy as np
import pytest
from conformance.test_golden import build, found, read, run

import linegraph as lg
from linegraph.emission.emit import module_for, render
from linegraph.readers import modelfile
from linegraph.verification import golden
from linegraph.verification.golden.draws import Drawing
from linegraph.verification.golden.point import Kept

if TYPE_CHECKING:
    from pathlib import Path


def drawing(model: lg.Model) -> Drawing:
    return Drawing(
        lg.derive(model), random.Random(0), Kept(), [{"M": lambda p: p.bodies.mass_matrix}]
    )


def test_bodies_are_asked_beside_the_constraints() -> None:
    """Two cranks of a parallelogram stand alike on its constraints, and not where M is asked."""
    vectors = found("parallelograms")
    given = {x.function: x.given for x in vectors.expected}
    assert given["mass_matrix"] == ("q_off",)
    assert given["constraint_jacobian"] == ("q",)
    legal, beside = (np.array(vectors.given[key]) for key in ("q", "q_off"))
    alike = [
        (i, j)
        for i in range(legal.shape[1])
        for j in range(i)
        if np.abs(np.sin(legal[:, i] - legal[:, j])).max() < 1e-12
    ]
    assert alike
    assert all(np.abs(np.sin(beside[:, i] - beside[:, j])).min() > 1e-9 for i, j in alike)


def test_masses_vary_though_constraints_are_redundant() -> None:
    """Lengths that must fit keep their values; masses and lengths that need not are others."""
    some = drawing(read("four_bar"))
    assert some.derivation.assembled.redundant == 3
    assert some._fixed == frozenset()
    cranks = drawing(read("parallelograms"))
    assert cranks.derivation.assembled.redundant > 0
    values = {name for point in cranks.points() for name in point.p}
    assert values


ZERO = """
[parameters]
m = { value = 2, unit = "kg" }
x = { value = 0, unit = "m" }
l = { value = 0.5, unit = "m" }
[body.bob]
mass = "m"
mass_center = ["x", 0, "-l"]
[revolute.hinge]
between = ["ground", "bob"]
axis = [0, 1, 0]
"""


def test_parameters_that_are_zero_vary() -> None:
    """Else no wrong factor of theirs would be seen: little beside others of their unit."""
    model = modelfile.parse(ZERO.encode(), "m.toml")
    values = [point.p.get("x", 0.0) for point in drawing(model).points()]
    assert {0.04 <= x <= 0.0625 for x in values if x} == {True}
    assert sum(x != 0 for x in values) == 5


def test_locked_velocities_are_zero() -> None:
    """What rounding leaves of them would be its own scale."""
    for point in drawing(read("bricard")).points():
        v = np.abs(point.v)
        assert not ((v > 0) & (v < 1e-13 * v.max())).any()


def test_exponential_laws_hide_nothing() -> None:
    """Diodes at two volts of a source carry 1e11 A; beside that no capacitor's milliamperes are seen."""
    model = read("ring_modulator")
    vectors = golden.vectors(lg.derive(model), module_for(model, "m", only=("bias",)))
    # two volts of ten kilohertz have a phase of 1e5 at most, and rounding of that is what is left
    assert max(vectors.values["h"].scale) < 1e5
    assert min(vectors.values["h"].scale) > 1e-3


@pytest.mark.parametrize("sign", ["-", "+"])
def test_a_current_beside_diodes_is_seen(sign: str, tmp_path: Path) -> None:
    """The sign of a capacitor's current beside two diodes."""
    files = render(read("ring_modulator"), name="m", only=("bias",), tests=True, languages=["c"])
    files["m.c"], count = re.subn(r"(h\[6\] = .*)- v\[5\]", rf"\1{sign} v[5]", files["m.c"])
    assert count == 2  # from parameters, and from the constants of prepare
    status, _ = run(build(files, "m", tmp_path))
    assert status == (sign == "+")


def test_kinetic_energy_is_judged_by_its_own_parts() -> None:
    """Not by what springs and weights hold beside it."""
    vectors = found("condenser_microphone")
    kinetic, *others = vectors.values["E"].scale
    assert kinetic == pytest.approx(max(row[0] for row in vectors.values["E"].rows), rel=1e-2)
    assert kinetic < 1e-3 * max(others)

"""Derivatives where a law has a kink or an infinite slope: the limit from one side where that is finite."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.compiled import Compiled, Failed
from support.emitted import load

from linegraph.algebra.formula import parse
from linegraph.algebra.jets import Jet, Jets
from linegraph.algebra.protocol import Floats
from linegraph.emission.emit import render
from linegraph.ir.statuses import NOT_FINITE
from linegraph.readers import modelfile

if TYPE_CHECKING:
    from pathlib import Path

    import linegraph as lg

FINITE = {
    "x**1.5": (0.0,),
    "-2*max(-x, 0)**1.5": (0.0,),
    "max(x, 0)**1.5": (0.0,),
    "x*sqrt(x)": (0.0,),
    "3*x*sqrt(2*x)": (0.0,),
    "-x*sqrt(-5*x)": (0.0,),
    "(x/3)**1.5": (0.0,),
    "x/7*sqrt(x)": (0.0,),
    "abs(x)**1.5": (0.0,),
    "x**2.5": (0.0,),
    "(x**2)**1.5": (0.0,),
    "sqrt(x)**3": (0.0,),
    "x**1.5*cos(x) + x": (1.0,),
    "x*abs(x)": (0.0,),
    "sqrt(max(x - 1, 0))": (0.0,),
    "sqrt(max(-1 - x, 0)) + x": (1.0,),
    "asin(min(x + 2, 1))": (0.0,),
    "acos(max(x - 2, -1))": (0.0,),
    "abs(x)": (1.0, -1.0),
    "sqrt(x**2)": (1.0, -1.0),
    "sqrt(x**4)": (0.0,),
    "max(x, 0)": (1.0, 0.0),
    "max(0, x)": (1.0, 0.0),
    "min(x, 0)": (1.0, 0.0),
    "min(0, x)": (1.0, 0.0),
    "max(2*x, 3*x)": (2.0, 3.0),
    "min(2*x, 3*x)": (2.0, 3.0),
    "sign(x)": (0.0,),
    "atan2(x, 1)": (1.0,),
}
"""The force against x as a function of x, and the limits of its derivative from both sides of 0."""

INFINITE = ("sqrt(x)", "asin(x + 1)", "acos(x - 1)", "sqrt(max(x, 0))", "atan2(x, 2*x)")
"""What has no finite derivative at 0, or none at all."""


def rail(name: str, forces: list[str], folder: Path) -> lg.Model:
    """Bodies of 1 kg on rails of their own, each with a force as a function of its place."""
    text = f'name = "{name}"\n'
    for k, force in enumerate(forces):
        own = re.sub(r"\bx\b", f"x{k}", force)
        text += f'[body.b{k}]\nmass = 1\n[prismatic.x{k}]\nbetween = ["ground", "b{k}"]\n'
        text += f'axis = [1, 0, 0]\neffort = false\n[law.l{k}]\njoint = "x{k}"\nforce = "{own}"\n'
    folder.mkdir(exist_ok=True)
    file = folder / f"{name}.toml"
    file.write_text(text, encoding="ascii")
    return modelfile.read(file)


def both(name: str, forces: list[str], folder: Path) -> tuple[Compiled, Any]:
    files = render(rail(name, forces, folder), functions=["linearize"])
    return Compiled(files, name, folder), load(files, name, folder)


def test_the_limit_from_one_side_where_it_is_finite(tmp_path: Path) -> None:
    count = len(FINITE)
    library, python = both("kinks", list(FINITE), tmp_path)
    rest = np.zeros(count)
    found = python.linearize(rest, rest, [])
    in_c = library.call("linearize", rest, rest, [], out=[(2 * count, 2 * count)])
    for A in (found, in_c):
        for k, (force, limits) in enumerate(FINITE.items()):
            assert any(abs(A[count + k, k] + limit) < 1e-14 for limit in limits), force


@pytest.mark.parametrize("force", INFINITE)
def test_what_has_no_finite_derivative_is_a_status(force: str, tmp_path: Path) -> None:
    library, python = both("steep", [force], tmp_path)
    with pytest.raises(python.StatusError) as raised:
        python.linearize([0.0], [0.0], [])
    with pytest.raises(Failed) as failed:
        library.call("linearize", [0.0], [0.0], [], out=[(2, 2)])
    assert raised.value.status == failed.value.status == NOT_FINITE.number


@pytest.mark.parametrize("force", FINITE)
def test_beside_the_kink_it_is_the_central_difference(force: str, tmp_path: Path) -> None:
    model = rail("beside", [force], tmp_path)
    python = load(render(model, functions=["linearize"], languages=["python"]), "beside", tmp_path)
    for x in (-0.3, 0.3):
        step = 1e-6
        try:
            above, below = (python.forward_dynamics([x + h], [0.0], [])[0] for h in (step, -step))
        except python.StatusError:
            continue
        A = python.linearize([x], [0.0], [])
        assert A[1, 0] == pytest.approx((above - below) / (2 * step), abs=1e-7)


def test_powers_of_time_prescribe_motions_from_rest() -> None:
    found = parse("t**2.5").evaluate(Jets(Floats(t=0.0)), {"t": Jet(0.0, 1, 0)})
    assert (found.x, found.dx, found.ddx) == (0.0, 0.0, 0.0)
    later = parse("t**2.5").evaluate(Jets(Floats(t=4.0)), {"t": Jet(4.0, 1, 0)})
    assert (later.x, later.dx, later.ddx) == pytest.approx((32.0, 20.0, 3.75 * math.sqrt(4.0)))

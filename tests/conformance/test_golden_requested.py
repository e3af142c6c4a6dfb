"""Golden vectors of functions on request: derivatives, frames, the whole, operational space."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from conformance.test_golden import build, close, corrupted, emitted, read, run
from support.compiled import WARNINGS
from support.emitted import load

import linegraph as lg
from linegraph.algebra.jets import derivatives
from linegraph.algebra.protocol import Floats
from linegraph.emission.emit import render
from linegraph.errors import ModelError
from linegraph.ir.functions import ARITY
from linegraph.programs.kinematics import WHOLE
from linegraph.verification.golden.references import REFERENCES
from linegraph.verification.golden.steps import STEP, Complexes

if TYPE_CHECKING:
    from pathlib import Path

DERIVATIVES = ("linearize", "inverse_dynamics_derivatives", "forward_dynamics_derivatives")
OF_PARAMETERS = ("regressor", "inertial_parameters")
BY_PARAMETERS = tuple(f"{x}_dynamics_parameter_derivatives" for x in ("inverse", "forward"))
REQUESTED: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "furuta": (("power", *DERIVATIVES, *BY_PARAMETERS, *OF_PARAMETERS, *WHOLE), ("pendulum",)),
    "panda": ((*DERIVATIVES, "momentum", "operational_space"), ("panda_hand", "panda_link4")),
    "satellite": ((*DERIVATIVES, *WHOLE, "operational_space"), ("arm.tip", "hub.mass_center")),
    "slider_crank": (("linearize", *WHOLE), ("rod",)),
    "ring_modulator": (DERIVATIVES, ()),
}
"""Functions on request, and frames: symbols, numbers, a floating base, a loop, a network with a loop."""


def satellite() -> lg.Model:
    """A free body with an arm in a ball joint, and a spring."""
    model = lg.Model("satellite", gravity=(0, 0, -0.2))
    k = model.parameter("k", 3.0, "N*m/rad")
    hub = model.body(
        "hub",
        mass=4.0,
        mass_center=(0.1, 0, 0.05),
        inertia=((0.5, 0.02, 0), (0.02, 0.6, 0.01), (0, 0.01, 0.7)),
    )
    arm = model.body("arm", mass=1.5, mass_center=(0, 0, 0.4), inertia=(0.2, 0.2, 0.05))
    arm.frame("tip", at=(0, 0.1, 0.8))
    model.free("root", between=("ground", hub))
    model.spherical("shoulder", between=(hub, arm))
    wheel = model.body("wheel", mass=0.5, inertia=(0.01, 0.02, 0.01))
    model.revolute("axle", between=(hub, wheel), axis=(0, 1, 0))
    model.spring("flexure", joint="axle", stiffness=k)
    return model


@cache
def requested(name: str) -> dict[str, str]:
    """The files of a model of `REQUESTED`."""
    functions, frames = REQUESTED[name]
    folded = name == "panda"
    model = satellite() if name == "satellite" else read(name)
    return render(model, name=name, functions=functions, frames=frames, folded=folded, tests=True)


# ---- what is emitted holds


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", REQUESTED)
def test_what_is_requested_holds(name: str, tmp_path: Path) -> None:
    """Derivatives, frames, the whole: in Python at all states and at one, in C beside all others."""
    files = requested(name)
    load(files, name, tmp_path)
    check = load(files, f"test_{name}", tmp_path)
    functions, frames = REQUESTED[name]
    assert set(functions) - {"operational_space"} <= set(check.FUNCTIONS)
    assert sum(function.endswith("_jacobian_dot_v") for function in check.FUNCTIONS) == len(frames)
    assert ("kinematics" in check.FUNCTIONS) == bool(frames)
    for function in check.FUNCTIONS:
        check.compare(function, slice(None))
        check.compare(function, 1)
    status, lines = run(build(files, name, tmp_path, *WARNINGS))
    assert status == 0, "\n".join(lines)
    assert [line.split()[0] for line in lines[:-1]] == list(check.FUNCTIONS)
    assert max(float(line.split()[3]) for line in lines[:-1]) < 2e-12


# ---- what is corrupted does not


@pytest.mark.parametrize("name", ["furuta", "slider_crank"])
def test_corrupted_c_fails(name: str, tmp_path: Path) -> None:
    """One sign in what linearises, of a tree and of a mechanism with a loop."""
    files = dict(requested(name))
    function = "constrained_slopes" if name == "slider_crank" else "linearize"
    old = r"(= \S+ \* \S+) \+"
    for place in (f"{name}_{function}", f"{name}_{function}_prepared"):
        if re.search(rf"^(void|int) {place}\(", files[f"{name}.c"], re.M):
            break
    files[f"{name}.c"] = corrupted(files[f"{name}.c"], place, old, r"\1 -")
    status, lines = run(build(files, name, tmp_path))
    assert status == 1
    verdicts = {line.split()[0]: line.split()[-1] for line in lines[:-1]}
    assert verdicts.pop("linearize") == "FAIL"
    assert set(verdicts.values()) == {"ok"}


@pytest.mark.one_in(2)
@pytest.mark.parametrize(
    ("name", "function"),
    [
        ("furuta", "linearize"),
        ("slider_crank", "constrained_slopes"),
        ("satellite", "centroidal_momentum_bias"),
    ],
)
def test_corrupted_python_fails(name: str, function: str, tmp_path: Path) -> None:
    """Every sum with a wrong sign is seen, but for those that make no difference.

    On the constraints much has no effect on how a mechanism linearises: what turns with a closed loop.
    """
    files = dict(requested(name))
    lines = files[f"{name}.py"].split("\n")
    # what is called: the function's own lines, or those of its twin that takes constants
    twin = f"_{function}_prepared"
    called = twin if f"return {twin}(_prepare(" in files[f"{name}.py"] else f"_{function}"
    heads = (f"def {called}_core(", f"def {called}(")
    start = next(k for head in heads for k, x in enumerate(lines) if x.startswith(head))
    stop = next(k for k in range(start + 1, len(lines)) if lines[k].startswith("def "))
    sums = [k for k in range(start, stop) if re.match(r"    t\d+ = .* [-+] ", lines[k])]
    sums = sums[:: 1 + len(sums) // 50]
    asked = "linearize" if function == "constrained_slopes" else function
    load(files, name, tmp_path)
    right = results(load(files, f"test_{name}", tmp_path), asked)
    wrong = 0
    for k in sums:
        flipped = re.sub(r" ([-+]) ", lambda x: " - " if x[1] == "+" else " + ", lines[k], count=1)
        files[f"{name}.py"] = "\n".join([*lines[:k], flipped, *lines[k + 1 :]])
        load(files, name, tmp_path / str(k))
        check = load(files, f"test_{name}", tmp_path / str(k))
        try:
            differs = not all(map(np.allclose, results(check, asked), right))
        except np.linalg.LinAlgError:
            differs = True
        if differs:
            wrong += 1
            with pytest.raises((AssertionError, np.linalg.LinAlgError)):
                check.compare(asked, slice(None))
    assert wrong > 20


def results(check: Any, function: str) -> tuple[Any, ...]:
    """What a function returns at all states."""
    name, arguments, *_ = check.FUNCTIONS[function]
    return check.call(name, arguments, slice(None), {})  # type: ignore[no-any-return]


# ---- what they are made of


@pytest.mark.parametrize("function", ARITY)
def test_complex_steps(function: str) -> None:
    """The imaginary part is the derivative by each argument; at a kink it is that of the side."""
    own = {
        "abs": lambda x: (np.sign(x),),
        "sign": lambda _: (0.0,),
        "min": lambda a, b: (float(a < b), float(b < a)),
        "max": lambda a, b: (float(a > b), float(b > a)),
        "atan2": lambda y, x: (x / (x * x + y * y), -y / (x * x + y * y)),
    }
    for x in ((0.3, 0.7), (0.7, 0.3), (-0.4, 0.2), (0.2, -0.9)):
        at = x[: ARITY[function]]
        if at[0] < 0 and function in ("log", "sqrt"):
            with pytest.raises(ModelError, match="not a finite number"):
                Complexes().function(function, complex(at[0], STEP))
            continue
        y = Floats().function(function, *at)
        slopes = own.get(function, lambda x, y=y: (derivatives(function, Floats(), x, y) or [])[:1])
        for k, slope in enumerate(slopes(*at)):
            z = [complex(a, STEP * (i == k)) for i, a in enumerate(at)]
            found = Complexes().function(function, *z)
            assert close([found.real, found.imag / STEP], [y, slope])


def test_every_line_of_the_register_is_used() -> None:
    plain = ("rolling_disc", "car_axis", "four_bar")
    texts = [emitted(name)[f"test_{name}.py"] for name in plain]
    texts += [requested(name)[f"test_{name}.py"] for name in ("furuta", "slider_crank")]
    for function in REFERENCES:
        assert any(f'\n    "{function}": (' in text for text in texts), function

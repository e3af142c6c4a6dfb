"""Emitted C and Python against Pinocchio on real robots, fixed and floating: 50 states each.

A few robots by default; ``--all-robots`` takes every URDF of the example-robot-data wheel and prints a
table. A robot with a joint that moves no inertia is refused by linegraph; that joint is then locked on
both sides, so that the rest of the robot is compared.

Everything is compared as the file says it, that is with ``--snap 0``; M, h and inverse dynamics also as
emitted by default, where the dust of decimal angles is removed. An acceleration can be no more exact than
the mass matrix is well conditioned: two solvers that err in the last place differ by its condition number
times the rounding unit, and some robots have a condition number of 1e10.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.compiled import Compiled
from support.emitted import load

from linegraph import ModelError, derive
from linegraph.emission.emit import render
from linegraph.model.builder import SNAP
from linegraph.readers import urdf

pytest.importorskip("pinocchio")
from oracles import pinocchio_models as peers

if TYPE_CHECKING:
    from pathlib import Path

    from linegraph import Model

STATES = 50
TOLERANCE = 1e-10  # relative to the largest expected entry
FEW = (
    "double_pendulum_continuous",
    "panda",
    "ur5_robot",
    "solo12",
    "anymal-kinova",
    "simple_humanoid",
    "talos_reduced",
)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    files = peers.urdf_files()
    if not metafunc.config.getoption("--all-robots"):
        files = [file for file in files if file.stem in FEW]
    names = [f"{file.parent.parent.name}-{file.stem}" for file in files]
    metafunc.parametrize("file", files, ids=names)
    metafunc.parametrize("base", ["fixed", "floating"])


def readable(file: Path, base: str, snap: float) -> tuple[Model, dict[str, float]]:
    """The model, with the joints locked that move no inertia."""
    try:
        model = urdf.read(file, base=base, snap=snap)
        held = dict.fromkeys((x.name for x in derive(model).idle), 0.0)
        for name in held:
            model.lock(name)
        derive(model).require_inverse("forward_dynamics")
    except ModelError as error:
        pytest.skip(f"refused: {error}")
    return model, held


def relative(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.max(np.abs(found - expected)) / (np.max(np.abs(expected)) or 1.0))


@pytest.mark.one_in(4)
def test_agrees_with_pinocchio(
    file: Path, base: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model, held = readable(file, base, 0.0)
    text = file.read_text()
    pair = peers.Bridge(
        model, peers.load_text(text, floating=base == "floating"), peers.followers(text), held
    )
    files = render(model, name="robot", folded=True)
    snapped = render(
        readable(file, base, SNAP)[0], name="snapped", folded=True, languages=["python"]
    )
    compiled = Compiled(files, "robot", tmp_path, flags=("-O0",))
    module, dusted = load(files, "robot", tmp_path), load(snapped, "snapped", tmp_path)
    n = module.NV
    assert list(module.Q_NAMES) == pair.q_names
    rng = np.random.default_rng(0)
    worst: dict[str, float] = {}
    condition = 0.0

    def note(what: str, found: np.ndarray, expected: np.ndarray) -> None:
        worst[what] = max(worst.get(what, 0.0), relative(found, expected))

    for _ in range(STATES):
        q, v = pair.random_state(rng)
        a, u = rng.normal(size=n), rng.normal(size=module.NU)
        tau = np.zeros(n)
        tau[[module.V_NAMES.index(name) for name in module.U_NAMES]] = u
        M, h, inverse = pair.mass_matrix(q), pair.bias(q, v), pair.inverse_dynamics(q, v, a)
        forward = np.linalg.solve(M, tau - h)
        condition = max(condition, float(np.linalg.cond(M)))
        found_M, found_h = compiled.call("equations", q, v, out=[(n, n), (n,)])
        note("M", found_M, M)
        note("h", found_h, h)
        note("inverse", compiled.call("inverse_dynamics", q, v, a, out=[(n,)]), inverse)
        note("forward", compiled.call("forward_dynamics", q, v, u, out=[(n,)]), forward)
        note("forward", module.forward_dynamics(q, v, u), forward)
        for emitted, kind in ((module, ""), (dusted, "snapped ")):
            found_M, found_h = emitted.equations(q, v)
            note(f"{kind}M", found_M, M)
            note(f"{kind}h", found_h, h)
            note(f"{kind}inverse", emitted.inverse_dynamics(q, v, a), inverse)
    with capsys.disabled():
        row = "  ".join(f"{key} {value:.0e}" for key, value in worst.items())
        locked = f"  locked {len(held)}" if held else ""
        print(f"\n{file.stem:28s} {base:8s} nv {n:3d}  {row}  cond {condition:.0e}{locked}", end="")
    limit = max(TOLERANCE, 10 * np.finfo(float).eps * condition)
    assert worst.pop("forward") < limit
    assert max(worst.values()) < TOLERANCE

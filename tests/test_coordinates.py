"""A name means one thing in all coordinates: `coordinates` changes neither motion, forces nor outputs.

Each model of the examples and of the documentation is derived in its own coordinates and in others. A state
of the first is carried over by the motion of the bodies. Accelerations of all bodies, outputs and kinetic
energy have to be the same there. The accelerations come from M v̇ + h = Q + J^T λ, J v̇ = γ, solved densely.
"""

from __future__ import annotations

import re
from copy import deepcopy
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import linegraph as lg
from linegraph import modelfile, orthogonality
from linegraph.closure import equations
from linegraph.inverse_scheme import InverseScheme
from linegraph.loads import efforts
from linegraph.observation import observed
from linegraph.transfer import transfer

if TYPE_CHECKING:
    from collections.abc import Iterator

    from linegraph.derive import Derivation

ROOT = Path(__file__).parent.parent
TIME = 0.3
TOLERANCE = 1e-8
OTHERS = ("absolute", "absolute-angle")


def documents() -> Iterator[tuple[str, bytes]]:
    """Each model file of the examples and the documentation that stands by itself."""
    for path in sorted((ROOT / "examples").glob("*/*.toml")):
        yield path.relative_to(ROOT).as_posix(), path.read_bytes()
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))):
        blocks = re.findall(r"```toml\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
        for k, block in enumerate(blocks):
            yield f"{page.name}#{k}", block.encode()


@cache
def readable() -> dict[str, lg.Model]:
    """Those that are whole models with bodies that move freely in some way."""
    found = {}
    for name, text in documents():
        try:
            model = modelfile.parse(text, "m.toml")
            lg.derive(model)
        except lg.LinegraphError:
            continue  # a fragment
        if model.bodies and all(p.value is not None for p in model.parameters.values()):
            found[name] = model
    return found


def solved(derivation: Derivation, q: Any, v: Any, u: Any) -> dict[str, Any]:
    """Accelerations of all bodies, outputs and kinetic energy at a state."""
    numeric = derivation.numeric(t=TIME, u=list(u))
    tree, algebra, parameters = numeric.tree, numeric.algebra, numeric.parameters
    arms = orthogonality.arms(tree, algebra, q, v)
    chords = numeric.chords(q, v)
    active = orthogonality.generalised_forces(
        tree, algebra, arms, numeric.applied(q, v, driven=True)
    )
    Q = np.array(efforts(tree, algebra, chords, active), dtype=float)
    M = np.array(numeric.united_mass_matrix(q, v), dtype=float)
    h = np.array(numeric.bias(q, v), dtype=float)
    count, size = len(equations(tree)), len(tree.velocities)
    J = np.array(chords.jacobian(), dtype=float).reshape(count, size)
    gamma = np.array(chords.bias(), dtype=float)
    whole = np.block([[M, -J.T], [J, np.zeros((count, count))]])
    x = np.linalg.lstsq(whole, np.concatenate([Q - h, gamma]), rcond=1e-12)[0]
    a, lam = x[:size].tolist(), x[size:].tolist()
    pairs = list(zip(equations(tree), lam, strict=True))
    scheme = InverseScheme(
        derivation, tree, algebra, parameters, arms, chords, (tuple(q), tuple(v)), a, pairs
    )
    outputs, _ = observed(
        derivation.model, tree, algebra, parameters, chords, (tuple(q), tuple(v)), scheme
    )
    centers = {body: scheme.center(body) for body in derivation.model.bodies}
    return {
        **{body: np.array([*frame.pull, *frame.spin]) for body, frame in centers.items()},
        "outputs": np.array(outputs, dtype=float),
        "kinetic": np.array(numeric.energy(q, v)[:1]),
    }


def state(derivation: Derivation, draw: np.random.Generator) -> tuple[list[float], list[float]]:
    """A state that satisfies the constraints: near the assembled one, velocities projected."""
    numeric = derivation.numeric(t=TIME)
    q = [x + draw.uniform(-0.2, 0.2) for x in derivation.assembled.q]
    numeric.tree.normalise(q)
    v = draw.uniform(-1, 1, len(numeric.tree.velocities))
    return q, v.tolist()


def compared(model: lg.Model, coordinates: str, seed: int = 0) -> float:
    """The worst difference of accelerations, outputs and kinetic energy, relative to their size."""
    draw = np.random.default_rng(seed)
    twin = deepcopy(model)
    twin.formulation(coordinates=coordinates, tree=(), independent=None)
    first, second = lg.derive(model), lg.derive(twin)
    q, v = state(first, draw)
    u = draw.uniform(-1, 1, len(first.structure.inputs)).tolist()
    from_, to = first.numeric(t=TIME, u=u), second.numeric(t=TIME, u=u)
    there = transfer(from_, q, v, to)
    mechanical = from_.tree.layout.mechanical
    there[1][to.tree.layout.mechanical :] = v[mechanical:]
    a, b = solved(first, q, v, u), solved(second, *there, u)
    size = 1 + max(float(np.abs(x).max(initial=0)) for x in a.values())
    return max(float(np.abs(a[key] - b[key]).max(initial=0)) for key in a) / size

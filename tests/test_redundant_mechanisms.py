"""Mechanisms with redundant joints move as they do without: random ones of all sizes, misaligned a little."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from emitted import load
from redundant_mechanisms import Pair, random_pair

from linegraph import derive
from linegraph.emission import render

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

COUNT = 1000
FEW = range(0, COUNT, 37)
IN_C = range(0, COUNT, 250)
STATES = 3
TOLERANCE = 1e-8  # measured 2e-10


def of_names(names: Sequence[str], rng: np.random.Generator, size: float, units: Sequence[str]) -> Any:
    """A number of size 1 for each coordinate or velocity, lengths in the mechanism's own; cranks are parallel."""
    angle = rng.uniform(0.7, 1.2)
    found = []
    for name, unit in zip(names, units, strict=True):
        x = rng.normal() * (size if unit.startswith("m") else 1.0)
        x = {"foot": angle, "hand": -angle}.get(name[:4], x)
        found.append(x)
    return np.array(found)


def normalised(names: Sequence[str], q: Any) -> Any:
    """The same with unit quaternions."""
    for k, name in enumerate(names):
        if name.endswith("_qx"):
            q[k : k + 4] /= np.linalg.norm(q[k : k + 4])
    return q


class Asked:
    """Both mechanisms in Python, at the same states."""

    def __init__(self, pair: Pair, folder: Path) -> None:
        self.pair = pair
        self.trees = [derive(model).structure for model in (pair.whole, pair.plain)]
        self.modules = [
            load(
                render(model, languages=["python"], only=("forward_dynamics",)),
                model.name,
                folder,
            )
            for model in (pair.whole, pair.plain)
        ]

    def state(self, seed: int) -> tuple[list[Any], list[Any], Any]:
        """Coordinates and velocities of both, and inputs."""
        size = self.pair.size
        rng = np.random.default_rng(seed)
        found: list[list[Any]] = [[], []]
        for what, of in ((0, "positions"), (1, "velocities")):
            known: dict[str, float] = {}
            for tree in self.trees:
                quantities = getattr(tree, of)
                names = [quantity.name for quantity in quantities]
                x = of_names(names, rng, size, [quantity.unit for quantity in quantities])
                x = np.array([known.setdefault(n, y) for n, y in zip(names, x, strict=True)])
                alike = known.get("foot0")
                if alike is not None:
                    x = np.array([alike if n.startswith("foot") else -alike for n in names])
                found[what].append(normalised(names, x) if what == 0 else x)
        units = [quantity.unit for quantity in self.trees[1].inputs]
        torque = 1e3 * size**5
        u = [rng.normal() * (torque if unit == "N*m" else torque / size) for unit in units]
        return found[0], found[1], np.array(u)

    def difference(self, seed: int) -> float:
        """The largest difference of accelerations, beside the largest of them."""
        q, v, u = self.state(seed)
        size = self.pair.size
        found = []
        for tree, module, *state in zip(self.trees, self.modules, q, v, strict=True):
            a = module.forward_dynamics(*state, u)
            a = a[0] if isinstance(a, tuple) else a
            pairs = zip(tree.velocities, a, strict=True)
            found.append({x.name: y / (size if x.unit == "m/s" else 1) for x, y in pairs})
        whole, plain = found
        assert {*plain} <= {*whole}
        largest = max(map(abs, plain.values()))
        return float(max(abs(plain[name] - whole[name]) for name in plain) / largest)


@pytest.mark.seeds(FEW, range(COUNT))
def test_redundant_joints_change_nothing(seed: int, tmp_path: Path) -> None:
    """Freedoms, redundancy and accelerations are those of the mechanism without the redundant joints."""
    pair = random_pair(seed)
    assembled = derive(pair.whole).assembled
    assert (assembled.freedoms, assembled.redundant) == (pair.freedoms, pair.redundant)
    asked = Asked(pair, tmp_path)
    assert max(asked.difference(k) for k in range(STATES)) < TOLERANCE

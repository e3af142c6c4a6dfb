"""Every number of a model may be a symbol: with default values the same equations follow as from numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from oracles import newton_euler as oracle
from support.compiled import Compiled
from support.emitted import load
from support.spec_models import model_of, numbers, rows
from systems import random_trees as trees

import linegraph as lg
from linegraph.components.joints import JOINTS
from linegraph.emission.emit import render

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path


def symbolic_model_of(tree: trees.Tree) -> lg.Model:
    """A tree with every mass, moment, offset, axis, ratio and gravity a parameter of its own."""
    model = lg.Model("symbolic")
    count = 0

    def symbol(value: float) -> lg.Parameter:
        nonlocal count
        count += 1
        return model.parameter(f"p{count}", float(value))

    def symbols(values: Iterable[float]) -> tuple[Any, ...]:
        return tuple(symbol(value) for value in values)

    model.gravity = symbols(tree.gravity)
    handles = {"ground": model.ground}
    for body in tree.bodies:
        xx, xy, xz, yy, yz, zz = (float(body.inertia[i, j]) for i in range(3) for j in range(i, 3))
        entries = dict(
            zip(("xx", "xy", "xz", "yy", "yz", "zz"), (xx, xy, xz, yy, yz, zz), strict=True)
        )
        handles[body.name] = model.body(
            body.name,
            mass=symbol(body.mass),
            mass_center=symbols(body.mass_center),
            inertia={key: symbol(value) for key, value in entries.items()},
        )
    for joint in tree.joints:
        ends = [
            handles[body].frame(f"{joint.name}.{end}", at=symbols(at), rotation=rows(rotation))
            for body, end, at, rotation in (
                (joint.tail, "tail", joint.tail_at, joint.tail_rotation),
                (joint.head, "head", joint.head_at, joint.head_rotation),
            )
        ]
        # a planar joint's directions, too, follow its axis; a turn by pi about x has no formula there
        plain = joint.axis[2] < -0.999
        axis = numbers(joint.axis) if plain else symbols(joint.axis)
        model.add_joint(JOINTS[joint.kind](joint.name, (ends[0], ends[1]), axis=axis))
    for coupling in tree.couplings:
        model.couple(
            coupling.joint, coupling.master, symbol(coupling.ratio), symbol(coupling.offset)
        )
    return model


@pytest.mark.parametrize("seed", range(6))
def test_symbols_give_what_numbers_give(seed: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(seed)
    tree = trees.random_tree(rng, bodies=1 + seed % 4)
    files = render(symbolic_model_of(tree))
    module = load(files, "symbolic", tmp_path)
    compiled = Compiled(files, "symbolic", tmp_path, flags=("-O0",))
    folded = load(render(model_of(tree), name="plain", languages=["python"]), "plain", tmp_path)
    p = module.DEFAULT_PARAMETERS
    n = tree.nv
    for _ in range(5):
        q, v = trees.random_state(rng, tree)
        mass, bias = module.equations(p, q, v)
        expected = oracle.mass_matrix(tree, q, v)
        assert np.max(np.abs(mass - expected)) < 1e-12 * np.max(np.abs(expected))
        expected = oracle.bias(tree, q, v)
        assert np.max(np.abs(bias - expected)) < 1e-12 * (1 + np.max(np.abs(expected)))
        u = rng.normal(size=module.NU)
        np.testing.assert_allclose(
            module.forward_dynamics(p, q, v, u),
            folded.forward_dynamics(q, v, u),
            rtol=1e-9,
            atol=1e-9,
        )
        np.testing.assert_allclose(
            module.energy(p, q, v), folded.energy(q, v), rtol=1e-9, atol=1e-9
        )
        c_mass, c_bias = compiled.call("equations", None, q, v, out=[(n, n), (n,)])
        np.testing.assert_allclose(c_mass, mass, rtol=1e-12, atol=1e-13)
        np.testing.assert_allclose(c_bias, bias, rtol=1e-12, atol=1e-12)


def test_changed_parameters_change_the_equations(tmp_path: Path) -> None:
    model = lg.Model("pendulum")
    mass, length = model.parameter("m", 2.0), model.parameter("l", 0.5)
    bob = model.body("bob", mass=mass, mass_center=(0, 0, -length))
    model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
    module = load(render(model, languages=["python"]), "pendulum", tmp_path)
    p = module.DEFAULT_PARAMETERS.replace(m=[1.0, 3.0], l=2.0)
    np.testing.assert_allclose(module.mass_matrix(p, [0.1])[:, 0, 0], [4.0, 12.0])


def test_symbolic_angles_turn_frames(tmp_path: Path) -> None:
    def build(name: str, roll: Any, turn: Any) -> lg.Model:
        model = lg.Model(name)
        if name == "symbolic":
            roll, turn = model.parameter("roll", roll), model.parameter("turn", turn)
        body = model.body("body", mass=1.5, mass_center=(0.1, 0.2, 0.3), inertia=(0.1, 0.2, 0.25))
        first = model.ground.frame("first", rpy=(roll, 0.2, -0.3))
        second = body.frame("second", at=(0, 0, 0.4), axis=(1, 2, 2), angle=turn)
        model.revolute("hinge", between=(first, second), axis=(0, 1, 0))
        return model

    symbolic = load(
        render(build("symbolic", 0.7, -1.1), languages=["python"]), "symbolic", tmp_path
    )
    plain = load(render(build("plain", 0.7, -1.1), languages=["python"]), "plain", tmp_path)
    found = symbolic.equations(symbolic.DEFAULT_PARAMETERS, [0.4], [2.0])
    for one, other in zip(found, plain.equations([0.4], [2.0]), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-13)


def test_a_parameter_without_a_value_cannot_be_emitted() -> None:
    model = lg.Model("pendulum")
    bob = model.body("bob", mass=model.parameter("m"), mass_center=(0, 0, -1))
    model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
    with pytest.raises(lg.ModelError, match='parameter "m": has no value'):
        render(model)


def test_an_undeclared_symbol_is_named() -> None:
    import sympy

    model = lg.Model("pendulum")
    bob = model.body("bob", mass=sympy.Symbol("m"), mass_center=(0, 0, -1))
    model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
    with pytest.raises(lg.ModelError, match='parameter "m": is used but not declared'):
        render(model)


def test_a_robot_with_massless_links_has_finite_reactions(tmp_path: Path) -> None:
    """A link without mass has its mass centre at its origin, also while its mass is a symbol."""
    path = "examples/panda/panda.urdf"
    found = []
    for name, folded in (("lettered", False), ("numbered", True)):
        only = ("across", "reactions")
        files = render(lg.read(path, symbolic=not folded), name=name, folded=folded, only=only)
        found.append(load(files, name, tmp_path))
    lettered, numbered = found
    rng = np.random.default_rng(2)
    q, v, u = rng.normal(size=8), rng.normal(size=8), rng.normal(size=8)
    p = lettered.DEFAULT_PARAMETERS
    assert np.allclose(lettered.across(p, q, v), numbered.across(q, v), rtol=0, atol=1e-13)
    assert np.allclose(
        lettered.reactions(p, q, v, u), numbered.reactions(q, v, u), rtol=0, atol=1e-11
    )

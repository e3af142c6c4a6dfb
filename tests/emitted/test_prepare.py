"""`prepare` and what reads its constants: the same numbers as from parameters, and nothing left to hoist."""

from __future__ import annotations

import contextlib
import inspect
import re
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from agreement.test_symbolic_parameters import symbolic_model_of
from conformance.test_joints import VARIANTS
from oracles import newton_euler as oracle
from support.compiled import Compiled, Failed
from support.emitted import load
from systems import random_trees as trees

import linegraph as lg
from linegraph.components.joints import JOINTS
from linegraph.emission.emit import module_for, render
from linegraph.ir.dag import SYMBOL, Node
from linegraph.ir.program import Program
from linegraph.ir.prologue import PREPARED, SHORT
from linegraph.readers import modelfile, urdf

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linegraph.ir.program import Module

EXAMPLES = Path(__file__).parents[2] / "examples"
EXACT = 1e-12  # relative to 1 + the largest expected entry; measured 8e-15
SOLVED = 1e-10  # what a system of equations is solved for
STATES = 4
INERTIA = ("xx", "xy", "xz", "yy", "yz", "zz")


def error(found: Any, expected: Any) -> float:
    found, expected = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    most = np.max(np.abs(expected), initial=0.0)
    return float(np.max(np.abs(found - expected), initial=0.0) / (1 + most))


class Symbols:
    """Parameters of a model, one for every number."""

    def __init__(self, model: lg.Model) -> None:
        """None yet."""
        self.model = model

    def one(self, value: float) -> lg.Parameter:
        return self.model.parameter(f"p{len(self.model.parameters)}", float(value))

    def all(self, values: Iterable[float]) -> tuple[Any, ...]:
        return tuple(self.one(value) for value in values)


def branched(kind: str, rng: np.random.Generator) -> lg.Model:
    """Two joints of a kind among hinges, in either direction, and all numbers but axes symbols."""
    model = lg.Model("branched")
    symbols = Symbols(model)
    model.gravity = symbols.all(rng.normal(size=3) * 5)
    word, options = VARIANTS[kind]
    bodies = [model.ground]
    kinds = ("revolute", word, word, "prismatic")
    for i, joint in enumerate(kinds):
        inertia = dict(zip(("xx", "yy", "zz"), rng.uniform(0.3, 0.5, size=3), strict=True))
        inertia |= dict(zip(("xy", "xz", "yz"), rng.normal(size=3) * 0.05, strict=True))
        body = model.body(
            f"b{i}",
            mass=symbols.one(rng.uniform(0.5, 2)),
            mass_center=symbols.all(rng.normal(size=3) * 0.3),
            inertia={key: symbols.one(value) for key, value in inertia.items()},
        )
        tail, head = (
            owner.frame(
                f"{joint}{i}_{end}",
                at=symbols.all(rng.normal(size=3) * 0.4),
                rpy=symbols.all(rng.normal(size=3)),
            )
            for owner, end in ((bodies[max(i - 1, 0)], "tail"), (body, "head"))
        )
        axis = rng.normal(size=3)
        x, y, z = (axis / np.linalg.norm(axis)).tolist()
        given = options if joint == word and 0 < i < 3 else {}
        ends = (tail, head) if i % 2 else (head, tail)
        model.add_joint(JOINTS[joint](f"j{i}", ends, axis=(x, y, z), **given))
        bodies.append(body)
    return model


def changed(model: lg.Model, rng: np.random.Generator) -> dict[str, float]:
    """Other values of all parameters that have none of their own."""
    return {
        p.name: float(p.value) * rng.uniform(0.9, 1.1)
        for p in model.parameters.values()
        if not p.derived
    }


@pytest.mark.one_in(4)
@pytest.mark.parametrize("kind", VARIANTS)
def test_prepared_functions_give_what_the_reference_gives(kind: str, tmp_path: Path) -> None:
    """Every joint type, C and Python, before and after parameters change; moments are not regrouped there."""
    rng = np.random.default_rng(len(kind))
    model = branched(kind, rng)
    files = render(model)
    module = load(files, "branched", tmp_path)
    compiled = Compiled(files, "branched", tmp_path, flags=("-O0",))
    derivation = lg.derive(model)
    n = module.NV
    for _ in range(STATES):
        values = changed(model, rng)
        p = module.DEFAULT_PARAMETERS.replace(**values)
        c = module.prepare(p)
        in_c = compiled.call("prepare", list(values.values()), out=[(module.NK,)])
        assert error(in_c, c) < EXACT
        numeric = derivation.numeric(values)
        q = rng.uniform(-1, 1, size=module.NQ).tolist()
        numeric.tree.normalise(q)
        v, a, u = rng.normal(size=n), rng.normal(size=n), rng.normal(size=module.NU)
        mass, bias = np.array(numeric.mass_matrix(q)), np.array(numeric.bias(q, v.tolist()))
        torque = numeric.inverse_dynamics(q, v.tolist(), a.tolist())
        for found in (
            module.equations(p, q, v),
            module.equations_prepared(c, q, v),
            compiled.call("equations_prepared", in_c, q, v, out=[(n, n), (n,)]),
            (module.mass_matrix_prepared(c, q), module.bias_prepared(c, q, v)),
        ):
            assert error(found[0], mass) < EXACT
            assert error(found[1], bias) < EXACT
        assert error(module.inverse_dynamics(p, q, v, a), torque) < EXACT
        assert error(module.inverse_dynamics_prepared(c, q, v, a), torque) < EXACT
        scale = np.abs(np.linalg.inv(mass)).max() * (1 + np.abs(mass).max())
        if n == module.NU and scale < 1e4:
            solved = np.linalg.solve(mass, u - bias)
            found = module.forward_dynamics_prepared(c, q, v, u)
            assert error(found, solved) < SOLVED
            assert error(module.forward_dynamics(p, q, v, u), solved) < SOLVED
            found = compiled.call("forward_dynamics_prepared", in_c, q, v, u, out=[(n,)])
            assert error(found, solved) < SOLVED


@pytest.mark.seeds(range(0, 20, 6), range(20))
def test_random_trees(seed: int, tmp_path: Path) -> None:
    """Massless bodies and couplings, too, against Newton and Euler."""
    rng = np.random.default_rng([seed, 5])
    tree = trees.random_tree(rng, bodies=1 + seed % 7)
    module = load(
        render(symbolic_model_of(tree), languages=["python"]), "symbolic", tmp_path / str(seed)
    )
    c = module.prepare(module.DEFAULT_PARAMETERS)
    for _ in range(STATES):
        q, v = trees.random_state(rng, tree)
        mass, bias = oracle.mass_matrix(tree, q, v), oracle.bias(tree, q, v)
        found = module.equations_prepared(c, q, v)
        assert error(found[0], mass) < EXACT
        assert error(found[1], bias) < EXACT
        u = rng.normal(size=module.NU)
        solved = module.forward_dynamics_prepared(c, q, v, u)
        assert error(solved, module.forward_dynamics(module.DEFAULT_PARAMETERS, q, v, u)) < 1e-8


SYSTEMS = (
    "andrews_squeezer",
    "arm_with_drives",
    "bicycle",
    "cart_pole_motor",
    "excavator_arm",
    "four_bar",
    "ring_modulator",
    "rolling_disc",
    "ship_arm",
    "stewart_platform",
    "synchronous_machine",
)


def given_to(module: Any, model: lg.Model, rng: np.random.Generator) -> dict[str, Any]:
    """Arguments at a consistent position, as far as there are constraints."""
    derivation = lg.derive(model)
    if derivation.structure.closed:
        q = list(derivation.assembled.q)
    else:
        q = rng.uniform(0.2, 0.9, size=module.NQ).tolist()
        derivation.numeric().tree.normalise(q)
    sizes = {"v": module.NV, "a": module.NV, "u": module.NU, "lam": getattr(module, "NC", 0)}
    drawn = {name: 0.1 * rng.normal(size=size) for name, size in sizes.items()}
    free = getattr(module, "NI", 0)
    names = [quantity.name for quantity in derivation.structure.positions]
    s = [q[names.index(name)] for name in getattr(module, "INDEPENDENT_NAMES", ())]
    return {
        **drawn,
        "t": 0.3,
        "q": np.array(q),
        "x": np.concatenate([q, drawn["v"]]),
        "s": np.array(s),
        "w": 0.1 * rng.normal(size=free),
    }


def requested(model: lg.Model) -> list[str]:
    """Functions on request that read constants, as far as the model has them."""
    found = []
    for function in ("linearize", "inverse_dynamics_derivatives", "regressor"):
        with contextlib.suppress(lg.ModelError):
            module_for(model, "asked", only=(function,))
            found.append(function)
    return found


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name", SYSTEMS)
def test_every_prepared_function_is_its_contract_s_equal(name: str, tmp_path: Path) -> None:
    model = modelfile.read(EXAMPLES / name / f"{name}.toml")
    files = render(model, functions=requested(model))
    module = load(files, name, tmp_path)
    compiled = Compiled(files, name, tmp_path, flags=("-O0",))
    rng = np.random.default_rng(len(name))
    given = given_to(module, model, rng)
    given["lam"] = rng.normal(size=getattr(module, "NC", 0))
    values = module.DEFAULT_PARAMETERS._values()
    if not lg.derive(model).structure.closed:
        values = {key: x * rng.uniform(0.95, 1.05) for key, x in values.items()}
    p = module.DEFAULT_PARAMETERS.replace(**values)
    given |= {"p": p, "c": module.prepare(p)}
    in_c = {**given, "p": list(values.values())}
    twins = [x for x in vars(module) if x.endswith("_prepared") and not x.startswith("_")]
    assert len(twins) >= 7
    for twin in twins:
        function = getattr(module, twin.removesuffix("_prepared"))
        arguments = list(inspect.signature(function).parameters)
        if "loop" in arguments:
            continue
        assert list(inspect.signature(getattr(module, twin)).parameters) == [
            "c" if x == "p" else x for x in arguments
        ]
        expected = function(*(given[x] for x in arguments))
        found = getattr(module, twin)(*(given["c" if x == "p" else x] for x in arguments))
        several = isinstance(expected, tuple)
        shapes = [x.shape for x in expected] if several else [expected.shape]
        call = compiled.call(twin, *(in_c["c" if x == "p" else x] for x in arguments), out=shapes)
        for one, c_one, other in zip(
            *((x if several else (x,)) for x in (found, call, expected)), strict=True
        ):
            assert error(one, other) < 1e-9, twin
            assert error(c_one, other) < 1e-9, twin


def pendulum() -> lg.Model:
    model = lg.Model("pendulum")
    mass, length = model.parameter("m", 2.0), model.parameter("l", 0.5)
    bob = model.body("bob", mass=mass, mass_center=(0, 0, -length), inertia={"yy": "m*l**2/12"})
    model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
    return model


def test_arrays_of_parameters_broadcast(tmp_path: Path) -> None:
    module = load(render(pendulum(), languages=["python"]), "pendulum", tmp_path)
    masses, q = np.array([[1.0], [3.0]]), np.linspace(0, 1, 5)[:, None]
    p = module.DEFAULT_PARAMETERS.replace(m=masses, l=2.0)
    c = module.prepare(p)
    assert c.shape == (2, 1, module.NK)
    found = module.equations_prepared(c, q, q)
    for one, other in zip(found, module.equations(p, q, q), strict=True):
        assert one.shape[:2] == (2, 5)
        np.testing.assert_allclose(one, other, rtol=1e-14)
    with pytest.raises(ValueError, match="c must have shape"):
        module.equations_prepared(np.zeros(module.NK + 1), q, q)


def constant_operations(module: Module) -> dict[str, list[Node]]:
    """Operations in prepared functions on nothing but constants and numbers."""
    found = {}
    for program in module.programs:
        if not isinstance(program, Program) or not program.name.endswith("_prepared"):
            continue
        live = program.live
        assert not any(node.op == SYMBOL and node.a == "p" for node in live)
        found[program.name] = [
            node
            for node in live
            if node.op not in (SYMBOL, "neg")
            and all(
                not isinstance(x, Node) or (x.op == SYMBOL and x.a == "c") for x in (node.a, node.b)
            )
        ]
    return found


@pytest.mark.parametrize("name", sorted(path.stem for path in EXAMPLES.glob("*/*.toml")))
def test_nothing_is_left_to_hoist(name: str) -> None:
    """No operation on constants alone, no division by one; and every constant is read."""
    module = module_for(modelfile.read(EXAMPLES / name / f"{name}.toml"), name)
    left = constant_operations(module)
    assert bool(left) == bool(module.parameters)
    assert not any(left.values()), left
    programs = [p for p in module.programs if isinstance(p, Program) and p.name in left]
    live = {node for program in programs for node in program.live}
    read = {node.b for node in live if node.op == SYMBOL and node.a == "c"}
    assert read == set(range(dict(module.counts)["NK"])) if left else not read
    divisors = [node.b for node in live if node.op == "div"]
    assert not any(x.op == SYMBOL and x.a == "c" for x in divisors)


def chain(links: int) -> lg.Model:
    """A chain in space of symbols alone: masses, mass centres, inertias, offsets, gravity."""
    model = lg.Model("chain")
    symbols = Symbols(model)
    rng = np.random.default_rng(8)
    model.gravity = (0, 0, symbols.one(-9.81))
    before = model.ground
    for i in range(links):
        tip = before.frame(f"tip{i}", at=symbols.all(rng.uniform(0.1, 0.5, size=3)))
        before = model.body(
            f"b{i}",
            mass=symbols.one(1),
            mass_center=symbols.all(rng.uniform(0.1, 0.3, size=3)),
            inertia={k: symbols.one(0.1 if k[0] == k[1] else 0.01) for k in INERTIA},
        )
        axis = ((0, 0, 1), (0, 1, 0), (1, 0, 0))[i % 3]
        model.revolute(f"j{i}", between=(tip, before), axis=axis)
    return model


def test_articulated_inertias_of_regrouped_symbols(tmp_path: Path) -> None:
    """Moments of a link that has handed its mass inward, in a chain too long to factor M."""
    links = 24
    model = chain(links)
    programs = {p.name: p for p in module_for(model, "chain").programs}
    assert not programs["forward_dynamics_prepared"].calls
    module = load(render(model, languages=["python"]), "chain", tmp_path)
    rng = np.random.default_rng(links)
    for _ in range(STATES):
        values = changed(model, rng)
        c = module.prepare(module.DEFAULT_PARAMETERS.replace(**values))
        numeric = lg.derive(model).numeric(values)
        q, v, u = rng.normal(size=(3, links))
        mass, bias = np.array(numeric.mass_matrix(q.tolist())), numeric.bias(q.tolist(), v.tolist())
        found = module.forward_dynamics_prepared(c, q, v, u)
        assert error(mass @ found + bias, u) < SOLVED
        assert error(found, np.linalg.solve(mass, u - bias)) < SOLVED


MOST = {"prepare": 391, "equations_prepared": 1254, "inverse_dynamics_prepared": 792}
MOST |= {"mass_matrix_prepared": 610, "bias_prepared": 752, "equations": 1615}
"""Of 8 links, when last measured; without `prepare` equations took 1976."""


def test_operations_of_a_chain_of_symbols() -> None:
    module = module_for(chain(8), "chain")
    counted = {p.name: p.operations for p in module.programs if isinstance(p, Program)}
    assert {name: counted[name] for name in MOST if counted[name] > MOST[name]} == {}


EXAMPLES_MOST = {
    # equations without prepare, when it came in: 44, 57, 142, 943, 407
    "double_pendulum": 24,
    "furuta": 23,
    "andrews_squeezer": 74,
    "stewart_platform": 767,
    "ship_arm": 251,
}


@pytest.mark.parametrize("name", EXAMPLES_MOST)
def test_operations_of_examples(name: str) -> None:
    module = module_for(modelfile.read(EXAMPLES / name / f"{name}.toml"), name)
    counted = {p.name: p.operations for p in module.programs if isinstance(p, Program)}
    assert counted["equations_prepared"] <= EXAMPLES_MOST[name]


def test_long_functions_are_emitted_once() -> None:
    """What is long and takes about as much with all constants calls its twin, the rest is whole."""
    module = module_for(chain(8), "chain")
    handed = {p.name for p in module.programs if p.handed}
    assert {"mass_matrix", "bias", "equations", "inverse_dynamics", "rhs"} <= handed
    assert "energy" not in handed
    text = render(chain(8), languages=["c"])["chain.c"]
    assert (
        "{\n    double c[CHAIN_NK];\n    chain_prepare(p, c);\n"
        "    chain_equations_prepared(c, q, v, M, h);\n}\n"
    ) in text
    assert "    return chain_forward_dynamics_prepared(c, q, v, u, a);\n" in text
    short = {p.name: p for p in module_for(pendulum(), "pendulum").programs}
    assert not any(p.handed for p in short.values())
    assert all(p.operations < SHORT for p in short.values() if isinstance(p, Program))


def test_without_parameters_nothing_is_prepared() -> None:
    folded = render(pendulum(), folded=True)
    robot = render(urdf.read(EXAMPLES / "panda" / "panda.urdf"), name="panda")
    assert not any("prepare" in text or "NK" in text for text in (folded | robot).values())


def test_parameters_without_influence_need_no_constants() -> None:
    model = lg.Model("idle")
    model.parameter("unused", 1.0)
    model.prismatic("slide", between=("ground", model.body("b", mass=1)))
    assert "prepare" not in render(model)["idle.h"]


def test_every_function_worth_it_is_emitted() -> None:
    module = module_for(modelfile.read(EXAMPLES / "four_bar" / "four_bar.toml"), "four_bar")
    names = {p.name for p in module.programs}
    assert {name for name in names if f"{name}_prepared" in names} == names & set(PREPARED)


def test_the_example_of_the_page_runs(tmp_path: Path) -> None:
    page = (EXAMPLES.parent / "docs" / "model_file.md").read_text("utf-8")
    model = re.search(r"^```toml\n(.*?)^```", page, re.M | re.S)
    program = re.search(r"^```c\n(.*?)^```", page, re.M | re.S)
    assert model is not None
    assert program is not None
    files = render(modelfile.parse(model[1].encode(), "furuta.toml"), languages=["c"])
    for name, text in (files | {"main.c": program[1]}).items():
        (tmp_path / name).write_text(text, "utf-8")
    command = ["gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", "main.c", "furuta.c", "-lm"]
    subprocess.run(command, cwd=tmp_path, check=True)
    assert subprocess.run([tmp_path / "a.out"], check=False).returncode == 0


DIVIDER = b"""
name = "divider"
[parameters]
R = 100.0
C = 1e-6
[inputs]
u = { unit = "V" }
[voltage_source.source]
between = ["a", "ground"]
voltage = "u"
[resistor.first]
between = ["a", "b"]
resistance = "R"
[capacitor.store]
between = ["b", "ground"]
capacitance = "C"
"""


def test_what_cannot_be_divided_by_stays_a_status(tmp_path: Path) -> None:
    """As without `prepare`: a check comes before the division, and others do not fail of it."""
    files = render(modelfile.parse(DIVIDER, "divider.toml"))
    module = load(files, "divider", tmp_path)
    compiled = Compiled(files, "divider", tmp_path)
    short = module.DEFAULT_PARAMETERS.replace(R=0.0)
    with pytest.raises(np.linalg.LinAlgError, match="static laws"):
        module.forward_dynamics(short, [], [1.0], [2.0])
    assert module.mass_matrix(short, []).shape == (1, 1)
    with pytest.raises(np.linalg.LinAlgError, match="static laws"):
        module.forward_dynamics_prepared(module.prepare(short), [], [1.0], [2.0])
    several = module.DEFAULT_PARAMETERS.replace(R=[0.0, 50.0])
    assert module.prepare(several).shape == (2, module.NK)
    c = compiled.call("prepare", [0.0, 1e-6], out=[(module.NK,)])
    with pytest.raises(Failed) as failed:
        compiled.call("forward_dynamics_prepared", c, [], [1.0], [2.0], out=[(1,)])
    assert failed.value.status == 901
    c = module.prepare(module.DEFAULT_PARAMETERS)
    found = module.forward_dynamics_prepared(c, [], [1.0], [2.0])
    np.testing.assert_allclose(found, 1e4, rtol=1e-12)


def test_a_division_by_zero_fails_where_it_is_needed(tmp_path: Path) -> None:
    model = chain(5)
    width = model.parameter("width", 0.2)
    model.spring("spring", joint="j0", stiffness=f"3 / {width.name}")
    module = load(render(model, languages=["python"]), "chain", tmp_path)
    p, q = module.DEFAULT_PARAMETERS.replace(width=0.0), np.linspace(0.1, 0.5, 5)
    for run in (lambda: module.prepare(p), lambda: module.equations(p, q, q)):
        with pytest.raises(ZeroDivisionError):
            run()
    assert np.all(np.isfinite(module.mass_matrix(p, q)))
    programs = {program.name: program for program in module_for(model, "chain").programs}
    assert programs["equations"].handed
    assert not programs["mass_matrix"].handed


def test_functions_of_parameters_are_constants(tmp_path: Path) -> None:
    """Roots, sines, quotients and derived parameters: no function but of coordinates is left."""
    model = lg.Model("formulas")
    model.parameter("k", 30.0)
    model.parameter("w", 2.0)
    tilt = model.parameter("tilt", 0.3)
    derived = model.parameter("f", "sqrt(k / w) + max(k, w) * exp(-w)")
    body = model.body("b", mass="w / (1 + k)", mass_center=(0, 0, "cos(tilt)"))
    place = model.ground.frame("place", rpy=(tilt, 0, 0))
    model.revolute("hinge", between=(place, body), axis=(0, 1, 0))
    model.spring("spring", joint="hinge", stiffness=derived)
    model.law("law", joint="hinge", force="-k * x**3 / w - sin(tilt) * v / f")
    module = module_for(model, "formulas")
    prepared = [p for p in module.programs if p.name.endswith("_prepared")]
    live = [n for p in prepared if isinstance(p, Program) for n in p.live]
    assert {n.op for n in live} <= {SYMBOL, "neg", "add", "sub", "mul", "div", "sin", "cos"}
    assert all(n.a.a == "q" for n in live if n.op in ("sin", "cos"))
    loaded = load(render(model, languages=["python"]), "formulas", tmp_path)
    p = loaded.DEFAULT_PARAMETERS.replace(k=20.0, tilt=-0.4)
    expected = lg.derive(model).numeric({"k": 20.0, "tilt": -0.4})
    found = loaded.equations_prepared(loaded.prepare(p), [0.2], [0.7])
    assert error(found[0], expected.mass_matrix([0.2])) < EXACT
    assert error(found[1], expected.bias([0.2], [0.7])) < EXACT


def test_a_singular_mass_matrix_of_symbols_is_a_status(tmp_path: Path) -> None:
    """Regrouped sums leave dust where a symbolic inertia is zero; it is judged beside what it is made of."""
    model = lg.Model("gimbal")
    inner = model.body("inner")
    length = model.parameter("l", 0.7)
    rod = model.body("rod", mass=model.parameter("m", 1.3), mass_center=(0, 0, length))
    model.revolute("azimuth", between=("ground", inner), axis=(0, 0, 1))
    model.revolute("tilt", between=(inner, rod), axis=(1, 0, 0))
    module = load(render(model, languages=["python"]), "gimbal", tmp_path)
    p = module.DEFAULT_PARAMETERS
    for run, given in (
        (module.forward_dynamics, p),
        (module.forward_dynamics_prepared, module.prepare(p)),
    ):
        with pytest.raises(np.linalg.LinAlgError, match="singular at azimuth"):
            run(given, [0.3, 0.0], [0.0, 0.0], [1.0, 0.0])
        assert np.all(np.isfinite(run(given, [0.3, 0.4], [0.0, 0.0], [1.0, 0.0])))

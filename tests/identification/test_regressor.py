"""The regressor: tau = Y pi + rest to rounding for whatever can be modelled, and Y by Pinocchio."""

from __future__ import annotations

import ctypes
import inspect
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy
from click.testing import CliRunner
from support.compiled import Compiled
from support.emitted import load
from systems import random_mixed as mixed
from systems import random_systems as systems

from linegraph import Model, ModelError, derive
from linegraph.cli.main import main
from linegraph.emission.emit import module_for, render
from linegraph.identification.regressor import Columns, Station, by_motions, by_wrenches
from linegraph.identification.standard_parameters import MOMENTS, homes
from linegraph.identification.tied_columns import tied, ties
from linegraph.model.system import variant
from linegraph.programs.workspace import Workspace
from linegraph.readers import modelfile, urdf

if TYPE_CHECKING:
    from pathlib import Path

EXACT = 1e-12  # relative to the largest torque; measured 4e-15 at most
ONLY = ("inverse_dynamics", "regressor", "inertial_parameters", "coordinate_rates")
FOUR_BAR = "examples/four_bar/four_bar.toml"
FEW = ("panda", "ur5_robot", "solo12", "anymal-kinova", "simple_humanoid")

Array = Any


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "file" in metafunc.fixturenames:
        peers = pytest.importorskip("oracles.pinocchio_models")
        files = peers.urdf_files()
        if not metafunc.config.getoption("--all-robots"):
            files = [file for file in files if file.stem in FEW]
        names = [f"{file.parent.parent.name}-{file.stem}" for file in files]
        metafunc.parametrize("file", files, ids=names)
        metafunc.parametrize("base", ["fixed", "floating"])


class Emitted:
    """A model's functions at random states."""

    def __init__(self, model: Model, folder: Path, *, folded: bool = False) -> None:
        """Emit and load."""
        files = render(model, name="m", languages=["python"], only=ONLY, folded=folded)
        self.module = load(files, "m", folder)
        self.quaternions = derive(model).structure.quaternions

    def call(self, name: str, given: dict[str, Any]) -> Any:
        function = getattr(self.module, name)
        return function(*(given[x] for x in inspect.signature(function).parameters))

    def states(self, count: int, seed: int = 0) -> dict[str, Any]:
        rng, m = np.random.default_rng(seed), self.module
        q = rng.uniform(-1.5, 1.5, (count, m.NQ))
        for places in self.quaternions:
            q[:, places] /= np.linalg.norm(q[:, places], axis=1, keepdims=True)
        v, a = rng.uniform(0.3, 1.2, (2, count, m.NV)) * rng.choice([-1, 1], (2, count, m.NV))
        u, t = rng.normal(size=(count, m.NU)), rng.uniform(0, 1, count)
        p = getattr(m, "DEFAULT_PARAMETERS", None)
        return {"p": p, "t": t, "q": q, "v": v, "a": a, "u": u}

    def defect(self, count: int = 10) -> float:
        """Of tau = Y pi + rest, relative to the largest of all terms."""
        given = self.states(count)
        tau, found = self.call("inverse_dynamics", given), self.call("regressor", given)
        Y, rest = found if isinstance(found, tuple) else (found, np.zeros_like(tau))
        pi = self.call("inertial_parameters", given)
        assert Y.shape[-2:] == (self.module.NV, self.module.NPI)
        assert pi.shape == (self.module.NPI,) == (len(self.module.PI_NAMES),)
        size = (np.abs(Y) @ np.abs(pi) + np.abs(rest)).max(-1) + 1e-300
        return float((np.abs(Y @ pi + rest - tau).max(-1) / size).max())


@pytest.mark.parametrize("seed", [0, 1, 2, 3, 5, 8, 13, 21, 34, 55])
def test_random_systems(seed: int, tmp_path: Path) -> None:
    """All joints, couplings, rotors, basements, prescribed motions, elements and loads."""
    assert Emitted(systems.random_system(seed).model, tmp_path).defect() < EXACT


@pytest.mark.parametrize("seed", [1, 4, 7, 11])
def test_random_systems_with_networks(seed: int, tmp_path: Path) -> None:
    assert Emitted(mixed.model_of(mixed.random_system(seed)), tmp_path).defect() < EXACT


@pytest.mark.parametrize("coordinates", ["joint", "absolute-angle", "absolute"])
def test_closed_loops_along_the_velocities_of_their_tree(coordinates: str, tmp_path: Path) -> None:
    model = variant(modelfile.read(FOUR_BAR).system(), coordinates=coordinates)
    assert Emitted(model, tmp_path).defect() < EXACT


@pytest.mark.parametrize("name", ["slider_crank", "rolling_disc", "bicycle"])
def test_examples_with_constraints(name: str, tmp_path: Path) -> None:
    assert Emitted(modelfile.read(f"examples/{name}/{name}.toml"), tmp_path).defect() < EXACT


def test_rotors_and_gears_of_motors_are_armatures(tmp_path: Path) -> None:
    model = modelfile.read("examples/arm_with_drives/arm_with_drives.toml")
    emitted = Emitted(model, tmp_path)
    assert emitted.defect() < EXACT
    m = emitted.module
    pi = dict(zip(m.PI_NAMES, m.inertial_parameters(m.DEFAULT_PARAMETERS), strict=True))
    values = {name: p.value for name, p in model.parameters.items()}
    waist = next(joint.name for joint in model.joints)
    assert pi[f"{waist}.armature"] == pytest.approx(values["n1"] ** 2 * values["J1"], rel=1e-14)
    given = emitted.states(3)
    Y, rest = emitted.call("regressor", given)
    currents = [k for k, name in enumerate(m.V_NAMES) if name not in m.Q_NAMES]
    assert currents
    assert not Y[:, currents].any()
    assert rest[:, currents].any(axis=-1).all()


def bent_arm() -> Model:
    """Two links with all parameters, friction of each kind, and a spring."""
    model = Model("bent")
    l1, d, c = model.parameter("l1", 0.4), model.parameter("d", 0.2), model.parameter("c", 0.3)
    upper = model.body(
        "upper",
        mass=2.0,
        mass_center=(0.1, 0.02, 0.2),
        inertia=((0.1, 0.01, 0.02), (0.01, 0.2, 0), (0.02, 0, 0.3)),
    )
    tool = model.body("tool", mass=0.5, mass_center=(0, 0.1, 0))
    lower = model.body("lower", mass=1.0, mass_center=(0.1, 0, 0.2), inertia=(0.1, 0.2, 0.3))
    model.revolute("shoulder", ("ground", upper), axis=(0, 0, 1))
    model.revolute("elbow", (upper.frame("end", (l1, 0, 0.1)), lower), axis=(0.6, 0, 0.8))
    model.fixed("grip", (lower.frame("hand", (0, 0, 0.3), rpy=(0.3, 0.2, 0.1)), tool))
    model.damper("d1", joint="shoulder", damping=d)
    model.friction("f1", joint="elbow", viscous=d, coulomb=c, width=0.05)
    return model


def test_friction_has_columns_and_springs_are_the_rest(tmp_path: Path) -> None:
    model = bent_arm()
    first = Emitted(model, tmp_path)
    assert first.defect() < EXACT
    given = first.states(4)
    Y = first.call("regressor", given)
    assert not isinstance(Y, tuple)
    names = list(first.module.PI_NAMES)
    assert names[:10] == [f"upper.{part}" for part in MOMENTS]
    assert "tool.m" not in names
    pi = dict(zip(names, first.call("inertial_parameters", given), strict=True))
    assert pi["shoulder.damping"] == pi["elbow.damping"] == 0.2
    assert pi["shoulder.friction"] == 0
    assert pi["elbow.friction"] == 0.3
    assert pi["lower.m"] == 1.5
    v, a = given["v"], given["a"]
    wanted = np.stack([v[:, 1], np.tanh(v[:, 1] / 0.05), a[:, 1]], -1)
    place = names.index("elbow.damping")
    assert np.abs(Y[:, 1, place : place + 3] - wanted).max() < 1e-15
    assert not Y[:, 0, place : place + 3].any()
    model.spring("s", joint="elbow", stiffness=3.0)
    second = Emitted(model, tmp_path)
    given["p"] = second.module.DEFAULT_PARAMETERS
    assert second.defect() < EXACT
    _, rest = second.call("regressor", given)
    assert np.abs(rest - 3 * np.stack([0 * v[:, 1], given["q"][:, 1]], -1)).max() < 1e-14


def test_friction_where_angles_are_measured_from_ground(tmp_path: Path) -> None:
    """A joint's rate is then the difference of two velocities."""
    model = Model("plane", gravity=(0, -9.81, 0))
    one, two = (model.body(name, mass=1.0, mass_center=(0.1, 0, 0)) for name in ("one", "two"))
    model.revolute("a", ("ground", one))
    model.revolute("b", (one.frame("tip", (0.3, 0, 0)), two))
    model.friction("f", joint="b", viscous=0.4, coulomb=0.5, width=2.0)
    emitted = Emitted(variant(model.system(), coordinates="absolute-angle"), tmp_path)
    assert emitted.defect() < EXACT
    given = emitted.states(3)
    Y, v = emitted.call("regressor", given), given["v"]
    assert not isinstance(Y, tuple)
    place = list(emitted.module.PI_NAMES).index("b.damping")
    rate = v[:, 1] - v[:, 0]
    assert np.abs(Y[:, :, place] - np.stack([-rate, rate], -1)).max() < 1e-15
    assert np.abs(Y[:, 1, place + 1] - np.tanh(rate / 2)).max() < 1e-15


def test_parameters_of_a_following_joint_are_those_of_the_other(tmp_path: Path) -> None:
    model = Model("pair")
    one, two = (model.body(name, mass=1.0, mass_center=(0.1, 0, 0)) for name in ("one", "two"))
    model.revolute("a", ("ground", one), axis=(0, 1, 0))
    model.revolute("b", (one.frame("tip", (0.3, 0, 0)), two), axis=(0, 1, 0))
    model.couple("b", "a", ratio=-2.0)
    model.damper("d", joint="b", damping=0.5)
    model.friction("f", joint="b", coulomb=0.5)
    emitted = Emitted(model, tmp_path)
    assert emitted.defect() < EXACT
    given = emitted.states(2)
    names = list(emitted.module.PI_NAMES)
    assert names[20:] == ["a.damping", "a.friction", "a.armature"]
    assert emitted.call("inertial_parameters", given)[20] == 2.0
    # at another rate dry friction rises otherwise: it is no parameter
    _, rest = emitted.call("regressor", given)
    assert np.abs(rest - 0.5 * -2 * np.tanh(-2 * given["v"] / 1e-3)).max() < 1e-14


def test_emitted_c_agrees(tmp_path: Path) -> None:
    """With symbolic parameters, without, and with the parameters' values alone."""
    for folded in (False, True):
        files = render(bent_arm(), name="bent", only=ONLY, folded=folded)
        folder = tmp_path / str(folded)
        compiled, module = Compiled(files, "bent", folder), load(files, "bent", folder)
        assert "#define BENT_NPI 26" in files["bent.h"]
        assert compiled.names("pi", 26) == [name.encode() for name in module.PI_NAMES]
        given = Emitted(bent_arm(), tmp_path).states(1)
        head_c, head = ([], []) if folded else ([None], [module.DEFAULT_PARAMETERS])
        state = [given[x][0] for x in ("q", "v", "a")]
        Y = compiled.call("regressor", *head_c, *state, out=[(2, 26)])
        assert np.abs(Y - module.regressor(*head, *state)).max() < 1e-15
        pi = compiled.call("inertial_parameters", *head_c, out=[(26,)])
        assert (pi == module.inertial_parameters(*head)).all()


def test_files_are_the_same_without_the_request() -> None:
    files = render(bent_arm(), name="bent")
    assert not any("regressor" in text or "NPI" in text for text in files.values())


def test_a_model_without_links_is_refused(tmp_path: Path) -> None:
    circuit = "examples/cauer_filter/cauer_filter.toml"
    for option in ("--with", "--only"):
        call = ["emit", circuit, "--out", str(tmp_path), option, "regressor"]
        done = CliRunner().invoke(main, call)
        assert done.exit_code == 2
        assert 'function "regressor"' in done.output
    assert not list(tmp_path.iterdir())
    with pytest.raises(ModelError, match="inertial_parameters"):
        module_for(modelfile.read(circuit), "m", only=["inertial_parameters"])


# ---- Pinocchio


@pytest.mark.one_in(2)
def test_agrees_with_pinocchio(file: Path, base: str, tmp_path: Path) -> None:
    import pinocchio
    from agreement.test_pinocchio import readable
    from oracles import pinocchio_models as peers

    model, held = readable(file, base, 0.0)
    text = file.read_text()
    there = peers.load_text(text, floating=base == "floating")
    pair = peers.Bridge(model, there, peers.followers(text), held)
    emitted = Emitted(model, tmp_path, folded=True)
    assert emitted.defect(3) < EXACT
    rng = np.random.default_rng(0)
    links = derive(model).structure.links
    blocks = [there.getJointId(link.joint.name) - 1 for link in links]
    if held:
        pytest.skip("what is locked is other links there")
    pi = emitted.module.inertial_parameters()[: 10 * len(links)].reshape(-1, 10)
    wanted = np.array([there.inertias[block + 1].toDynamicParameters() for block in blocks])
    assert np.abs(pi - wanted).max() < EXACT * np.abs(wanted).max()
    for _ in range(3):
        q, v = pair.random_state(rng)
        a = rng.normal(size=pair.nv)
        given = (there, pair.data, pair.positions(q), pair.G @ v, pair.G @ a)
        expected = pair.G.T @ pinocchio.computeJointTorqueRegressor(*given)
        columns = [10 * block + k for block in blocks for k in range(10)]
        found = emitted.module.regressor(q, v, a)[:, : 10 * len(links)]
        assert np.abs(found - expected[:, columns]).max() < EXACT * np.abs(expected).max()


# ---- cost


def columns_of(model: Model) -> dict[str, list[Columns]]:
    """Both routes in the frames of the walk, over floats at a random state."""
    numeric = derive(model).numeric()
    tree = numeric.tree
    draw = np.random.default_rng(0)
    q, v, a = (draw.normal(size=len(x)) for x in (tree.positions, tree.velocities, tree.velocities))
    q = list(q)
    tree.normalise(q)
    state = numeric.at(q, v).state
    stations = [Station(i, home.pose) for i, home in enumerate(homes(tree))]
    return {r.__name__: r(state, stations, list(a)) for r in (by_motions, by_wrenches)}


def test_both_routes_agree() -> None:
    for model in (panda(), urdf.read(robot("simple_humanoid"), base="floating"), bent_arm()):
        one, other = columns_of(model).values()
        for columns, expected in zip(one, other, strict=True):
            assert columns.keys() == expected.keys()
            size = max(np.abs(entries).max() for entries in expected.values())
            for k, entries in columns.items():
                assert np.abs(np.subtract(entries, expected[k])).max() < EXACT * size


@pytest.mark.parametrize(
    ("name", "base", "most"),
    [("panda", "fixed", 1974), ("ur5_robot", "fixed", 759), ("solo12", "floating", 2655)],
)
def test_operations_do_not_grow(name: str, base: str, most: int) -> None:
    model = urdf.read(robot(name), base=base)
    (program,) = module_for(model, "m", folded=True, only=["regressor"]).programs
    assert program.operations <= most


def test_columns_that_are_sums_of_others_are_the_same() -> None:
    """Also with symbols for offsets; where a parameter is divided by, columns stay as they are."""
    for model in (panda(), bent_arm(), urdf.read(robot("ur5_robot"), symbolic=True)):
        derivation = derive(model)
        numeric = derivation.numeric()
        every = ties(derivation, numeric.tree, folded=True)
        assert len(every) >= 3 * (len(numeric.tree.links) - 1)
        assert any(tie.cheap for tie in every) == (model.name != "bent")
        columns = columns_of(model)["by_motions"]
        for one, expected in zip(tied(columns, every), columns, strict=True):
            size = max(np.abs(entries).max() for entries in expected.values())
            for k, entries in expected.items():
                assert np.abs(np.subtract(one[k], entries)).max() < EXACT * size
    slanted = Model("slanted")
    slanted.parameter("alpha", 0.3)
    near: Any = slanted.ground
    direction = (0, sympy.sin(sympy.Symbol("alpha")), sympy.cos(sympy.Symbol("alpha")))
    for k in range(2):
        body = slanted.body(f"b{k}", mass=1.0, mass_center=(0.1, 0.1, 0), inertia=(0.1, 0.1, 0.1))
        slanted.revolute(f"q{k}", (near.frame(f"f{k}", (0.2, 0, 0)), body), axis=direction)
        near = body
    f = Workspace(derive(slanted), folded=False)
    found = ties(f.derivation, f.tree, folded=False)
    assert {tie.moment for tie in found} == {0}


def robot(name: str) -> Path:
    peers = pytest.importorskip("oracles.pinocchio_models")
    (file,) = (file for file in peers.urdf_files() if file.stem == name)
    return file


def panda() -> Model:
    return urdf.read(robot("panda"))


def test_many_states_at_once_in_c(tmp_path: Path) -> None:
    model, n = bent_arm(), 37
    files = render(model, name="bent", folded=True, only=["regressor"], batch=True)
    compiled = Compiled(files, "bent", tmp_path)
    given = Emitted(model, tmp_path / "python", folded=True).states(n)
    state = [np.ascontiguousarray(given[x]) for x in ("q", "v", "a")]
    found = np.full((n, 2, 26), np.nan)
    pointers = [x.ctypes.data_as(ctypes.c_void_p) for x in (*state, found)]
    compiled.library["bent_regressor_batch"](ctypes.c_int(n), *pointers)
    for k in range(n):
        one = compiled.call("regressor", *(x[k] for x in state), out=[(2, 26)])
        assert np.abs(found[k] - one).max() < 1e-14

"""Functions of kinematics as a user meets them: C and Python, names, what is written, costs, refusals."""

from __future__ import annotations

import inspect
import re
import runpy
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from support.compiled import Compiled, Failed
from support.emitted import load
from systems import readable_systems

from linegraph import Model, ModelError, NameRefused, derive
from linegraph.cli.main import main
from linegraph.cli.options import FURTHER as REQUESTS
from linegraph.emission.emit import emit, module_for, render
from linegraph.ir.program import Program
from linegraph.programs.kinematics import WHOLE
from linegraph.programs.register import ON_REQUEST
from linegraph.readers import modelfile, urdf

PANDA = Path("examples/panda/panda.urdf")
STEWART = Path("examples/stewart_platform/stewart_platform.toml")
LOOP = Path("examples/four_bar/four_bar.toml")
EVERYTHING = (*WHOLE, "operational_space", "operational_position")
SAME = 3e-14
"""C and Python do the same operations in the same order."""


def wrist(**options: Any) -> Model:
    """Six hinges, the last three of which meet, and a tool with a tip of its own."""
    model = Model("wrist")
    before = model.ground
    for k, axis in enumerate(("z", "y", "y", "x", "y", "x")):
        ends = (before.frame(f"out{k}", at=(0.3 * (k in (2, 3)), 0.0, 0.1 * (k < 4))), f"link{k}")
        before = model.body(
            f"link{k}", mass=1.0 + k, mass_center=(0.1, 0.02, 0.0), inertia=(0.02, 0.03, 0.04)
        )
        direction = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}[axis]
        model.revolute(f"joint{k}", between=ends, axis=direction, **options)
    before.frame("tip", at=(0.2, 0.0, 0.05), rpy=(0.1, 0.7, 0.3))
    return model


def run(*arguments: Any) -> Any:
    return CliRunner().invoke(main, [str(a) for a in arguments])


def operations(model: Model, **options: Any) -> dict[str, int]:
    programs = module_for(model, "counted", folded=True, **options).programs
    return {x.name: x.operations for x in programs if isinstance(x, Program)}


# ---- what is written


def test_the_command_line_knows_what_is_on_request() -> None:
    assert set(REQUESTS) | {"frames"} == set(ON_REQUEST)
    text = run("emit", "--help").output
    assert [name for name in REQUESTS if not re.search(rf"\b{name}\b", text)] == []


def test_a_frame_has_four_functions_and_they_come_together(tmp_path: Path) -> None:
    done = run("emit", PANDA, "--out", tmp_path, "--frame", "panda_hand", "--lang", "python")
    assert done.exit_code == 0, done.output
    plain = run("emit", PANDA, "--out", tmp_path / "plain", "--lang", "python")
    assert plain.exit_code == 0
    names = [
        set(re.findall(r"^def ([a-z]\w*)", path.read_text(), re.MULTILINE))
        for path in (tmp_path / "panda.py", tmp_path / "plain" / "panda.py")
    ]
    hand = {f"frame_panda_hand_{x}" for x in ("pose", "velocity", "jacobian", "jacobian_dot_v")}
    assert names[0] - names[1] == hand | {"kinematics"}
    assert names[1] <= names[0]


def test_one_function_of_the_whole_comes_alone_and_two_come_together() -> None:
    one = operations(wrist(), only=(), functions=("momentum",))
    assert "momentum" in one
    assert "kinematics" not in one
    two = operations(wrist(), functions=("momentum", "center_of_mass"))
    assert set(two) - set(one) == {"center_of_mass", "kinematics"}


def test_results_of_all_at_once_have_the_names_of_their_frames() -> None:
    module = module_for(wrist(), "m", frames=("link5.tip", "link2"), functions=("center_of_mass",))
    together = next(x for x in module.programs if x.name == "kinematics")
    parts = ("position", "rotation", "velocity", "jacobian", "jacobian_dot_v")
    names = [f"{frame}_{part}" for frame in ("link5_tip", "link2") for part in parts]
    assert [result.name for result in together.results] == [*names, "com"]
    assert [argument.name for argument in together.arguments] == ["q", "v"]
    still = module_for(wrist(), "m", functions=("center_of_mass", "center_of_mass_jacobian"))
    together = next(x for x in still.programs if x.name == "kinematics")
    assert [argument.name for argument in together.arguments] == ["q"]


def test_only_what_is_asked_for_of_frames() -> None:
    alone = operations(wrist(), only=("kinematics",), frames=("link5",))
    assert set(alone) == {"kinematics"}
    alone = operations(wrist(), only=("operational_position",), frames=("link5",))
    assert set(alone) == {"equations", "frame_link5_operational_position"}


def test_same_input_same_bytes() -> None:
    texts = [render(wrist(), frames=("link5.tip",), functions=EVERYTHING) for _ in range(2)]
    assert texts[0] == texts[1]


# ---- C


def arguments(module: Any, name: str, given: dict[str, Any]) -> list[Any]:
    return [given[key] for key in inspect.signature(getattr(module, name)).parameters]


def agree(files: dict[str, str], frame: str, tmp_path: Path, rng: np.random.Generator) -> None:
    """Every function of kinematics in C and in Python."""
    module, compiled = load(files, "both", tmp_path), Compiled(files, "both", tmp_path)
    q = rng.uniform(-1, 1, module.NQ)
    p = getattr(module, "DEFAULT_PARAMETERS", None)
    given = {"q": q, "v": rng.normal(size=module.NV), "t": 0.3, "p": p}
    given |= {"u": rng.normal(size=module.NU)}
    given |= {"c": module.prepare(p)} if hasattr(module, "prepare") else {}
    pattern = rf"(frame_{frame}_\w+|center_of\w*|momentum\w*|centroidal\w*|kinematics\w*)"
    names = [name for name in vars(module) if re.fullmatch(pattern, name)]
    assert len(names) >= 11
    for name in names:
        taken = arguments(module, name, given)
        expected = getattr(module, name)(*taken)
        expected = expected if isinstance(expected, tuple) else (expected,)
        taken = [None if x is p else x for x in taken] if p is not None else taken
        found = compiled.call(name, *taken, out=[x.shape for x in expected])
        found = found if isinstance(found, tuple) else (found,)
        limit = SAME if "operational" not in name else 1e-9
        for x, y in zip(found, expected, strict=True):
            assert np.max(np.abs(x - y)) <= limit * (1 + np.max(np.abs(y))), name


def test_c_agrees_with_python(tmp_path: Path) -> None:
    files = render(wrist(), name="both", frames=("link5.tip",), functions=EVERYTHING)
    agree(files, "link5_tip", tmp_path, np.random.default_rng(3))


def test_c_agrees_with_python_with_loops(tmp_path: Path) -> None:
    model = modelfile.read(STEWART)
    files = render(model, name="both", frames=("platform",), only=("operational_space",))
    module = load(files, "both", tmp_path)
    compiled = Compiled(files, "both", tmp_path, flags=("-O0",))
    q, v = np.array(derive(model).assembled.q), np.linspace(-1, 1, module.NV)
    name, n = "frame_platform_operational_space", module.NV
    expected = getattr(module, name)(module.DEFAULT_PARAMETERS, q, v)
    found = compiled.call(name, None, q, v, out=[(6, 6), (6,), (n, 6)])
    for x, y in zip(found, expected, strict=True):
        assert np.max(np.abs(x - y)) < 1e-10 * (1 + np.max(np.abs(y)))


@pytest.mark.parametrize("seed", [0, 2, 7, 17, 25])
def test_symbolic_parameters_and_their_constants(seed: int, tmp_path: Path) -> None:
    """C and Python, functions and their prepared twins; and the same as with numbers in the code."""
    last = f"b{len(readable_systems.system(seed, symbolic=True).bodies) - 1}"
    options: dict[str, Any] = {"frames": [last], "functions": WHOLE}
    drawn = readable_systems.system(seed, symbolic=True).model
    files = render(drawn, name="both", **options)
    agree(files, last, tmp_path, np.random.default_rng(seed))
    module = load(files, "both", tmp_path)
    numbers = readable_systems.system(seed, symbolic=False).model
    folded = load(render(numbers, name="folded", **options), "folded", tmp_path)
    rng = np.random.default_rng(seed)
    given = {
        "p": module.DEFAULT_PARAMETERS,
        "c": module.prepare(module.DEFAULT_PARAMETERS),
        "t": 0.7,
        "q": rng.uniform(-1, 1, module.NQ),
        "v": rng.normal(size=module.NV),
        "u": rng.normal(size=module.NU),
    }
    expected = folded.kinematics(*arguments(folded, "kinematics", given))
    for name in ("kinematics", "kinematics_prepared"):
        found = getattr(module, name)(*arguments(module, name, given))
        for x, y in zip(found, expected, strict=True):
            assert np.max(np.abs(x - y)) <= 1e-13 * (1 + np.max(np.abs(y)))


def test_many_states_at_once(tmp_path: Path) -> None:
    files = render(
        wrist(), name="m", languages=["python"], frames=("link5.tip",), functions=EVERYTHING
    )
    module = load(files, "m", tmp_path)
    rng = np.random.default_rng(0)
    q, v = rng.uniform(-1, 1, (5, 6)), rng.normal(size=(5, 6))
    found = module.frame_link5_tip_operational_space(q, v)
    assert [x.shape for x in found] == [(5, 6, 6), (5, 6), (5, 6, 6)]
    for k in range(5):
        for x, y in zip(found, module.frame_link5_tip_operational_space(q[k], v[k]), strict=True):
            np.testing.assert_allclose(x[k], y, rtol=1e-9, atol=1e-11)


def test_what_is_welded_to_ground_is_a_frame_too(tmp_path: Path) -> None:
    model = urdf.read(PANDA)
    files = render(model, name="m", frames=("panda_link0",))
    compiled, module = Compiled(files, "m", tmp_path), load(files, "m", tmp_path)
    position, rotation = compiled.call("frame_panda_link0_pose", np.ones(8), out=[(3,), (3, 3)])
    assert not position.any()
    assert np.array_equal(rotation, np.eye(3))
    assert not compiled.call("frame_panda_link0_jacobian", np.ones(8), out=[(6, 8)]).any()
    assert not module.frame_panda_link0_jacobian_dot_v(np.ones(8), np.ones(8)).any()


# ---- singular positions


def test_a_singular_position_is_reported(tmp_path: Path) -> None:
    """With the wrist stretched its first axis and its last are one: a status, results untouched."""
    files = render(wrist(), name="both", frames=("link5",), functions=("operational_space",))
    module, compiled = load(files, "both", tmp_path), Compiled(files, "both", tmp_path)
    q, v, out = np.array([0.1, 0.4, -0.9, 0.3, 0.0, 0.2]), np.ones(6), [(6, 6), (6,), (6, 6)]
    with pytest.raises(np.linalg.LinAlgError, match='frame "link5" cannot move'):
        module.frame_link5_operational_space(q, v)
    with pytest.raises(Failed) as failed:
        compiled.call("frame_link5_operational_space", q, v, out=out)
    assert failed.value.status > module.NV
    q[4] = 0.8
    compiled.call("frame_link5_operational_space", q, v, out=out)


# ---- costs


def test_all_at_once_costs_less_than_one_after_the_other() -> None:
    for model, frames in ((wrist(), ("link5.tip",)), (wrist(), ("link5.tip", "link3"))):
        counts = operations(model, frames=frames, functions=WHOLE)
        parts = [n for name, n in counts.items() if name.startswith("frame_") or name in WHOLE]
        assert len(parts) == 4 * len(frames) + len(WHOLE)
        assert counts["kinematics"] < 0.6 * sum(parts)


MOST = {
    "frame_panda_hand_pose": 139,
    "frame_panda_hand_velocity": 154,
    "frame_panda_hand_jacobian": 167,
    "frame_panda_hand_jacobian_dot_v": 247,
    "center_of_mass": 78,
    "center_of_mass_velocity": 210,
    "center_of_mass_jacobian": 214,
    "momentum": 510,
    "centroidal_momentum_matrix": 647,
    "centroidal_momentum_bias": 742,
    "kinematics": 1742,
    "frame_panda_hand_operational_space": 2298,
    "frame_panda_hand_operational_position": 1088,
}
MOST_OF_HAND = 408
"""When last measured: they may go down, never up."""


def test_costs_of_an_arm() -> None:
    counts = operations(urdf.read(PANDA), frames=("panda_hand",), functions=EVERYTHING)
    assert {name: n for name, n in MOST.items() if counts[name] > n} == {}
    hand = operations(urdf.read(PANDA), frames=("panda_hand",))
    assert hand["kinematics"] <= MOST_OF_HAND


def test_extents_are_called_by_what_they_count() -> None:
    """Also where a model has six constraints, so that 6 might be read as their number."""
    model = modelfile.read(LOOP)
    name = next(iter(model.bodies))
    header = render(model, name="m", languages=["c"], frames=(name,), functions=WHOLE)["m.h"]
    for text in ("J[M_RESTRICT 6 * M_NV]", "Jcom[M_RESTRICT 3 * M_NV]", "Ag[M_RESTRICT 6 * M_NV]"):
        assert text in header
    assert "J (6 x NV, row-major)" in header


# ---- what the documentation says


DOCUMENT = Path("docs/kinematics.md").read_text(encoding="utf-8")


def test_functions_and_results_are_those_of_the_documentation() -> None:
    """Every function, its arguments and its results, in the tables."""
    module = module_for(wrist(), "m", frames=("link5.tip",), functions=EVERYTHING)
    programs = {x.name: x for x in module.programs}
    rows = re.findall(r"^\| `(\w+)` \| `([\w, ]+)` \| (.*) \|$", DOCUMENT, re.MULTILINE)
    assert len(rows) == 12
    for name, taken, results in rows:
        program = programs[name.replace("NAME", "link5_tip")]
        assert ", ".join(argument.name for argument in program.arguments) == taken
        named = re.findall(r"`(\w+)`", results)
        if named:
            assert [result.name for result in program.results] == named


def block(language: str) -> str:
    return str(re.findall(rf"^```{language}\n(.*?)^```", DOCUMENT, re.MULTILINE | re.DOTALL)[0])


def test_what_the_documentation_shows_runs(tmp_path: Path, monkeypatch: Any) -> None:
    files = render(urdf.read(PANDA), name="panda", frames=("panda_hand",))
    load(files, "panda", tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    given = {"q": np.full(8, 0.3), "v": np.ones(8), "wanted": np.zeros(6)}
    (tmp_path / "shown.py").write_text(block("python"))
    found = runpy.run_path(str(tmp_path / "shown.py"), given)
    assert found["a"].shape == (8,)
    shown = "\n".join(('#include "panda.h"', "int main(void) {", block("c"), "return 0; }"))
    (tmp_path / "main.c").write_text(
        shown.replace("{\ndouble", "{ const double q[8] = {0};\ndouble")
    )
    command = ["gcc", "-std=c99", "-Werror", "-c", "main.c", "-o", "main.o"]
    subprocess.run(command, cwd=tmp_path, check=True)


# ---- refusals


@pytest.mark.parametrize(
    ("options", "parts"),
    [
        (("--frame", "panda_hnd"), ('frame "panda_hnd"', 'did you mean "panda_hand"?')),
        (("--frame", ""), ('frame ""', "known:")),
        (("--frame", "ground"), ('frame "ground"', "no body")),
        (("--frame", "a\nb{{7*7}}"), ("is no body and no frame of one",)),
        (("--with", "operational_space"), ('function "operational_space"', "--frame")),
        (("--only", "frames"), ('function "frames"', "--frame")),
        (("--only", "bias", "--frame", "panda_hand"), ('frame "panda_hand"', "nothing of it is")),
        (("--with", "momenta"), ("momenta",)),
    ],
)
def test_a_wrong_call_is_refused(
    options: tuple[str, ...], parts: tuple[str, ...], tmp_path: Path
) -> None:
    done = run("emit", PANDA, "--out", tmp_path, *options)
    assert done.exit_code == 2
    assert all(part in done.output for part in parts), done.output
    assert "Traceback" not in done.output
    assert not list(tmp_path.iterdir())


def test_frames_that_would_have_one_name_are_refused(tmp_path: Path) -> None:
    model = Model("m")
    first = model.body("a", mass=1.0)
    first.frame("b-c")
    first.frame("b_c")
    model.prismatic("slide", between=("ground", first))
    with pytest.raises(NameRefused, match=r"frame .a\.b-c. and frame .a\.b_c.: both become a_b_c"):
        emit(model, tmp_path, frames=("a.b-c", "a.b_c"))
    assert not list(tmp_path.iterdir())
    same = module_for(model, "m", frames=("a.b-c", "a.b-c"))
    assert sum(x.name == "frame_a_b_c_pose" for x in same.programs) == 1


def test_what_moves_without_mass_has_no_centre_of_mass() -> None:
    model = Model("bell")
    model.revolute("hinge", between=("ground", model.body("bell", inertia=(1, 1, 1))))
    for function in WHOLE:
        with pytest.raises(ModelError, match='model "bell": all that moves has no mass together'):
            module_for(model, "m", functions=(function,))
    assert operations(model, frames=("bell",))["frame_bell_jacobian"] == 0


def test_a_frame_that_cannot_move_everywhere_has_no_inertia_there() -> None:
    model = Model("arm")
    upper = model.body("upper", mass=1.0, inertia=(1, 1, 1))
    lower = model.body("lower", mass=1.0, inertia=(1, 1, 1))
    model.revolute("shoulder", between=("ground", upper))
    model.revolute("elbow", between=(upper.frame("end", at=(1, 0, 0)), lower))
    lower.frame("tip", at=(1, 0, 0))
    for function, way in (
        ("operational_space", "operational_position may do"),
        ("operational_position", ""),
    ):
        with pytest.raises(ModelError, match="cannot move along z by itself at any position") as e:
            module_for(model, "m", frames=("lower.tip",), functions=(function,))
        assert way in str(e.value)


def test_frames_that_cannot_are_left_out_and_named(tmp_path: Path) -> None:
    """Of a hand and of the link before the elbow: six rows of the first alone, three of both."""
    given = {"frames": ("panda_link4", "panda_hand"), "functions": ("operational_space",)}
    files = render(urdf.read(PANDA), name="m", **given)
    names = re.findall(r"^def frame_(\w+)_operational_space", files["m.py"], re.MULTILINE)
    assert names == ["panda_hand"]
    for text in files["m.h"], files["m.py"]:
        assert 'no operational_space of the frame "panda_link4": it cannot move' in text


def test_a_mechanism_that_moves_too_little_is_refused() -> None:
    model = modelfile.read(LOOP)
    name = next(iter(model.bodies))
    assert "kinematics" in operations(model, frames=(name,))
    with pytest.raises(ModelError, match="leave 1 independent velocity, fewer than the 3 rows"):
        module_for(model, "m", frames=(name,), functions=("operational_position",))


# ---- names from files


def test_any_name_is_a_frame(tmp_path: Path) -> None:
    """Names that end comments and strings, or are words of the languages."""
    hostile = '*/"""{{7*7}}\\'
    model = Model("m")
    before, names = model.ground, (hostile, "class", "2nd", "platform", "x" * 300)
    for k, name in enumerate(names):
        body = model.body(name, mass=1.0, inertia=(1, 1, 1))
        model.revolute(f"j{k}", between=(before, body), axis=(k % 2, 0, 1 - k % 2))
        before = body
    files = render(model, name="m", frames=names)
    Compiled(files, "m", tmp_path)
    module = load(files, "m", tmp_path)
    for stem in ("x_7_7", "class", "x_2nd", "platform", "x" * 80):
        assert getattr(module, f"frame_{stem}_pose")(np.zeros(5))[0].shape == (3,)


def test_a_frame_called_as_results_of_the_whole_is_refused_by_name() -> None:
    model = wrist()
    model.body("com")
    model.fixed("weld", between=("link5.tip", "com"))
    wanted = ("center_of_mass", "center_of_mass_velocity")
    with pytest.raises(ModelError, match=r'frame "com": its com_velocity .* one name'):
        render(model, frames=("com",), functions=wanted)
    assert render(model, frames=("com",), only=("frames", *wanted))

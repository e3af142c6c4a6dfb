"""What docs/networks.md says is true: models derive, programs run, messages are the real ones."""

from __future__ import annotations

import inspect
import math
import re
import subprocess
import sys
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from scipy.linalg import expm
from support.emitted import load

from linegraph.components.domains import DOMAINS, SPATIAL, UNITS
from linegraph.components.scalar import COMPONENTS
from linegraph.components.scalar.base import PLACES, Transducer
from linegraph.derivation import derive
from linegraph.emission.emit import emit, render
from linegraph.errors import LinegraphError
from linegraph.readers import modelfile
from linegraph.report import show
from linegraph.verification import checking

if TYPE_CHECKING:
    import linegraph as lg
    from linegraph.derivation import Derivation

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "networks.md").read_text("utf-8")
README = (ROOT / "README.md").read_text("utf-8")


def blocks(language: str, text: str = PAGE) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.M | re.S)


def name_of(model: str) -> str:
    (found,) = re.findall(r'^name = "(\w+)"$', model, re.M)
    return str(found)


MODELS = {name_of(text): text for text in blocks("toml")}
"""The models of the page by their names: every block is one."""


def read(name: str) -> lg.Model:
    return modelfile.parse(MODELS[name].encode(), f"{name}.toml")


def run(program: str, folder: Path) -> str:
    path = folder / "example.py"
    path.write_text(program)
    done = subprocess.run(
        [sys.executable, str(path)],
        cwd=folder,
        env={"PYTHONPATH": str(ROOT), "PATH": "/usr/bin"},
        check=True,
        capture_output=True,
        text=True,
    )
    return done.stdout


def commands(script: str, folder: Path) -> str:
    """What the commands of a block print, one after the other."""
    printed = ""
    for line in script.splitlines():
        command = re.sub(r"^(\.venv/bin/)?linegraph", f"{sys.executable} -m linegraph", line)
        environment = {"PYTHONPATH": str(ROOT), "PATH": "/usr/bin"}
        done = subprocess.run(
            command.split(),
            cwd=folder,
            env=environment,
            check=True,
            capture_output=True,
            text=True,
        )
        assert not done.stderr
        printed += done.stdout
    return printed


# ---- models, commands and programs


@pytest.mark.parametrize("name", MODELS)
def test_models_derive_and_are_good(name: str, tmp_path: Path) -> None:
    model = read(name)
    assert not model.warnings
    assert checking.check(derive(model)).good
    emit(model, tmp_path, functions=["power"])
    command = ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-c", f"{name}.c", "-o", "out.o"]
    subprocess.run(command, cwd=tmp_path, check=True)


def test_what_show_and_the_commands_print(tmp_path: Path) -> None:
    (tmp_path / "rlc.toml").write_text(MODELS["rlc"])
    printed = commands(blocks("console")[0], tmp_path)
    assert "good" in printed
    assert {path.name for path in (tmp_path / "build").iterdir()} == {"rlc.h", "rlc.c", "rlc.py"}
    shown = show(derive(read("rlc")))
    assert printed.startswith(shown)
    assert blocks("text")[0] in shown


def test_remarks(tmp_path: Path) -> None:
    remarks = [text for text in blocks("text") if text.startswith("remarks")]
    assert len(remarks) == 2
    for name, text in zip(("divider", "clipper"), remarks, strict=True):
        derivation = derive(read(name))
        assert text in show(derivation)
        header = " ".join(render(read(name))[f"{name}.h"].replace("\n *", "").split())
        for line in text.splitlines()[1:]:
            assert line.strip()[1:] in header


def rlc(R: float) -> np.ndarray:
    """Current and voltage of the circuit 0.1 ms after 5 V are applied, by the matrix exponential."""
    L, C, u, t = 1e-3, 1e-6, 5.0, 1e-4
    A = np.array([[-R / L, -1 / L], [1 / C, 0]])
    steady = np.array([0, u])
    return np.asarray(steady - expm(A * t) @ steady)


def test_the_program_in_c(tmp_path: Path) -> None:
    emit(read("rlc"), tmp_path, languages=["c"])
    (program,) = blocks("c")
    assert len(program.splitlines()) <= 22
    (tmp_path / "main.c").write_text(program)
    strict = ["-std=c99", "-pedantic", "-O1", "-Wall", "-Wextra", "-Werror"]
    command = ["cc", *strict, "main.c", "rlc.c", "-lm", "-o", "main"]
    subprocess.run(command, cwd=tmp_path, check=True)
    done = subprocess.run([tmp_path / "main"], check=True, capture_output=True, text=True)
    assert done.stdout == blocks("text")[1]
    found = [float(line.split()[1]) for line in done.stdout.splitlines()]
    assert found == pytest.approx(rlc(10.0), abs=2e-5)  # the midpoint rule's error


def test_the_program_in_python(tmp_path: Path) -> None:
    emit(read("rlc"), tmp_path / "build", languages=["python"])
    printed = run(blocks("python")[0], tmp_path)
    i, v, energy = (float(line.split()[1]) for line in printed.splitlines())
    assert (i, v) == pytest.approx(rlc(20.0), abs=6e-6)
    assert energy == pytest.approx(1e-3 * i**2 / 2 + 1e-6 * v**2 / 2, rel=1e-3)


def test_the_state_space(tmp_path: Path) -> None:
    program = blocks("python")[1]
    assert run(program, tmp_path) == blocks("text")[-1]
    names: dict[str, Any] = {}
    exec(program.partition("symbolic = ")[0], names)
    control = pytest.importorskip("control")
    found = derive(names["model"]).state_space.to_control()
    assert isinstance(found, control.StateSpace)
    assert found.state_labels == ["v_C1"]


# ---- the tables


def rows(heading: str) -> list[list[str]]:
    """The cells of a table whose head begins with a word."""
    (table,) = re.findall(rf"^\| {heading} \|.*\n\|[ -|]*\n((?:\|.*\n)+)", PAGE, re.M)
    return [[cell.strip() for cell in row.strip("|").split(" | ")] for row in table.splitlines()]


def words(cell: str) -> list[str]:
    """What stands between backquotes."""
    return re.findall(r"`([^`]*)`", cell)


def test_domains() -> None:
    found = {words(name)[0]: cells for name, *cells in rows("domain")}
    for domain in DOMAINS.values():
        if domain.name in SPATIAL:
            continue
        variables = (domain.across, domain.through)
        expected = [f"{x.name} ({x.symbol})" for x in variables]
        expected.append(", ".join(f"`{x.letter}_`" for x in variables))
        assert found.pop(domain.name) == expected
    assert not found


HEADS = [*(name for name in DOMAINS if name not in SPATIAL), "any domain"]


@pytest.mark.parametrize("head", HEADS)
def test_components_stand_in_the_table_of_their_domain(head: str) -> None:
    kinds = {
        name: kind
        for name, kind in COMPONENTS.items()
        if not issubclass(kind, Transducer) and name != "synchronous_machine"
        if domain_of(kind) == head
    }
    found = {words(first)[0]: keys for first, keys, _ in rows(head)}
    assert found.keys() == kinds.keys()
    for name, kind in kinds.items():
        own = {f.name for f in fields(kind)} - {"name", "between"}
        assert own <= set(words(found[name])), name


def domain_of(kind: Any) -> str:
    if kind.kind in ("element", "store"):
        return "any domain"
    if kind.kind in ("coupled_inductors", "opamp", "transformer", "gyrator"):
        return "electrical"
    names = getattr(kind, "domain_names", None)
    if names is None:
        return str(kind.domain_name)
    return str(names["magnetic" in names])


def test_transducers() -> None:
    kinds = {name: kind for name, kind in COMPONENTS.items() if "joint" in {*dir(kind)}}
    found = {words(row[0])[0]: row[1:] for row in rows("type")}
    assert found.keys() == kinds.keys()
    keys: list[str] = []
    for name, (turns, given, *_) in found.items():
        keys = keys if given == "the same" else words(given)
        kind: Any = kinds[name]
        own = {f.name for f in fields(kind)} - set(PLACES)
        assert own <= set(keys), name
        if name != "synchronous_machine":
            assert turns == ("yes" if kind.turns else "no")


def test_what_components_call_their_own_variables() -> None:
    table = {word: about for names, about in rows("name") for word in words(names)}
    used = {name for kind in COMPONENTS.values() for key in kind.own.values() for name in key}
    assert used <= table.keys()


def test_functions() -> None:
    """Every emitted function of networks is in the table, and no other."""
    stated = {word.partition("(")[0] for name, _ in rows("function") for word in words(name)}
    found: set[str] = set()
    for name in ("winch", "clipper"):
        source = render(read(name), languages=["python"], functions=["power"])[f"{name}.py"]
        found |= set(re.findall(r"^def ([a-z]\w*)\(", source, re.M))
    twins = {name for name in found if name.endswith("_prepared")}
    assert {name.removesuffix("_prepared") for name in twins} <= found
    assert found - twins == stated


DEFAULTS = {"density": 1000, "gravity": 9.81, "saturation": 1e-14, "voltage": 0.02585}
DEFAULTS |= {"viscous": 0, "coulomb": 0, "leakage": 0, "opening": 1, "resistance": 0, "area": 1}


def test_what_may_be_left_out() -> None:
    """The paragraph has all defaults, and they are those."""
    (paragraph,) = re.findall(r"^What may be left out: (.*?)\n\n", PAGE, re.M | re.S)
    stated = {*words(paragraph), "area"}
    for name, kind in COMPONENTS.items():
        for f in fields(kind):
            if f.name in PLACES or f.name in kind.required or f.default is None:
                continue
            if not isinstance(f.default, (int, float)):
                continue
            assert f.name in stated, (name, f.name)
            if f.name == "width":
                assert f.default == (1e-3 if "friction" in name else 1)
            elif f.name == "ratio":
                assert (name, f.default) == ("dc_motor", 1)
            else:
                assert f.default == DEFAULTS[f.name]


def test_units_of_own_domains() -> None:
    (sentence,) = re.findall(r"units are products of\s+(.*?), and the\s+product", PAGE, re.S)
    assert set(re.split(r"[,\s]+(?:and\s+)?", sentence)) == UNITS.keys()


def test_names_of_edges() -> None:
    (sentence,) = re.findall(r"^The edges of a component.*\n.*$", PAGE, re.M)
    shown = {word.partition(".")[2] for word in words(sentence)}
    pair = (("a", "ground"), ("b", "ground"))
    given = {"inductance": ((1.0, 0.0), (0.0, 1.0)), "windings": pair, "between": pair[0]}
    given |= {"second": pair[1], "output": pair[1], "joint": "hinge"}
    labels = set()
    for kind in COMPONENTS.values():
        taken = {f.name: given[f.name] for f in fields(kind) if f.name in given}
        if kind.kind not in ("coupled_inductors", "synchronous_machine"):
            taken.pop("inductance", None)
        labels |= {port.label for port in kind("c", **taken).ports()}
    assert shown == labels - {"", "rotation_1d"}


# ---- what the text says


def module(name: str, folder: Path) -> Any:
    return load(render(read(name), functions=["power"], languages=["python"]), name, folder)


def test_matrices_of_the_circuit() -> None:
    symbolic = derive(read("rlc")).symbolic
    assert str(symbolic.mass_matrix) == "Matrix([[L, 0], [0, C]])"
    assert str(symbolic.bias) == "Matrix([[R*i_L1 + v_C1], [-i_L1]])"
    assert str(symbolic.forces) == "Matrix([[u], [0]])"


def test_states_of_the_models() -> None:
    def names(name: str) -> tuple[list[str], list[str]]:
        tree = derive(read(name)).structure
        return [q.name for q in tree.velocities], [q.name for q in tree.inputs]

    assert names("divider") == (["v_C2"], ["u", "u_rate"])
    assert names("bass_box")[0] == ["p_air", "U_port"]
    assert names("winch")[0] == ["drum", "i_motor", "T_copper"]


def test_the_winch(tmp_path: Path) -> None:
    """By hand: the rotor's inertia at the joint, heat, energy, and what its reaction leaves out."""
    emitted = module("winch", tmp_path)
    assert emitted.STATE_NAMES == ("drum", "drum_dot", "i_motor", "T_copper")
    w, i, T, u, air = 2.0, 1.5, 300.0, 12.0, 293.0
    given = (emitted.DEFAULT_PARAMETERS, [0.3], [w, i, T])
    R = 0.4 * (1 + 0.0039 * (T - 293))
    turning, current, warming = emitted.forward_dynamics(*given, [u, air])
    inertia = 0.05 + 30**2 * 2e-4
    assert turning == pytest.approx((30 * 0.05 * i - 0.2 * w) / inertia)
    assert current == pytest.approx((u - R * i - 30 * 0.05 * w) / 1e-3)
    lost = R * i**2 + 0.2 * w**2
    cooled = (1 + 0.02 * w) * (T - air)
    assert warming == pytest.approx((lost - cooled) / 60)
    torque = 30 * 0.05 * i - 30**2 * 2e-4 * turning
    assert emitted.outputs(*given, [u, air]) == pytest.approx([torque, lost])
    stored = 30**2 * 2e-4 * w**2 / 2 + 1e-3 * i**2 / 2
    assert emitted.energy(*given) == pytest.approx([0.05 * w**2 / 2, 0, stored])
    delivered, sums = emitted.power(*given, [u, air])
    assert dict(zip(emitted.POWER_NAMES, delivered, strict=True))["supply"] == pytest.approx(u * i)
    assert "copper" not in emitted.POWER_NAMES
    assert sums == pytest.approx([0, 0, 0], abs=1e-9)
    reactions = dict(zip(emitted.REACTION_NAMES, emitted.reactions(*given, [u, air]), strict=True))
    assert reactions["drum_ty"] == pytest.approx(0, abs=1e-12)
    assert reactions["motor.electrical"] == i
    assert emitted.ACROSS_NAMES[-6:] == emitted.REACTION_NAMES[-6:]


def test_one_magnet_in_three_ways(tmp_path: Path) -> None:
    line = next(line for line in PAGE.splitlines() if line.startswith("    inductance = "))
    ways = re.split(r" {4,}", line.strip())
    L0, d, x, w, i, u = 0.3, 0.01, 0.004, 0.2, 1.7, 9.0
    inductance = L0 / (1 + x / d)
    rates = []
    for k, way in enumerate(ways):
        text = magnet(way)
        model = modelfile.parse(text.encode(), "magnet.toml")
        emitted = load(render(model, languages=["python"]), "magnet", tmp_path)
        z = i if k < 2 else inductance * i
        rates.append(emitted.rhs([x, w, z], [u]))
        assert emitted.STATE_NAMES[-1] == ("i_m" if k < 2 else "psi_m")
    # by hand
    slope = -L0 / d / (1 + x / d) ** 2
    force = slope * i**2 / 2
    linkage = u - 2.0 * i
    expected = [w, force / 0.1, (linkage - slope * w * i) / inductance]
    assert rates[0] == pytest.approx(expected)
    assert rates[1] == pytest.approx(expected)
    assert rates[2] == pytest.approx([w, force / 0.1, linkage])


def magnet(way: str) -> str:
    return f"""
    name = "magnet"
    [parameters]
    L0 = "0.3"
    d = "0.01"
    [inputs]
    u = {{}}
    [gravity]
    acceleration = [0, 0, 0]
    [body.ball]
    mass = 0.1
    [prismatic.gap]
    between = ["ground", "ball"]
    axis = [1, 0, 0]
    effort = false
    [voltage_source.s]
    between = ["a", "ground"]
    voltage = "u"
    [solenoid.m]
    between = ["a", "ground"]
    joint = "gap"
    resistance = 2
    {way}
    """


SOURCE = """
[inputs]
u = {}
[voltage_source.s]
between = ["a", "ground"]
voltage = "u"
"""
CAPACITORS = """
[inputs]
u = {}
[current_source.s]
between = ["ground", "a"]
current = "u"
[capacitor.C1]
between = ["a", "ground"]
capacitance = 1
[capacitor.C2]
between = ["a", "ground"]
capacitance = 2
"""
LOADED = """
[resistor.R]
between = ["a", "b"]
resistance = 1
[capacitor.C]
between = ["b", "ground"]
capacitance = 1
"""
HINGE = """
[body.arm]
mass = 1
inertia = [1, 1, 1]
[revolute.hinge]
between = ["ground", "arm"]
axis = [0, 0, 1]
[body.hand]
mass = 1
inertia = [1, 1, 1]
[revolute.wrist]
between = ["arm", "hand"]
axis = [0, 0, 1]
"""
MOTOR = """
[dc_motor.drive]
between = ["a", "ground"]
joint = "hinge"
constant = 1
resistance = 1
"""
TWO_INTERFACES = """
[rotational_interface.I]
between = ["x", "ground"]
joint = "hinge"
[rotational_interface.J]
between = ["y", "ground"]
joint = "wrist"
"""


def derived(text: str) -> Derivation:
    return derive(modelfile.parse(text.encode(), "model.toml"))


def states(text: str) -> list[str]:
    found = derived(text)
    assert checking.check(found).good
    return [quantity.name for quantity in found.structure.velocities]


def test_stores_that_depend_on_each_other() -> None:
    """The first is the state, rather one with an end on ground, but for a wish; their constants add."""
    assert states(CAPACITORS) == ["v_C1"]
    assert derived(CAPACITORS).numeric().mass_matrix([]) == [[3]]
    assert states(CAPACITORS + '[formulation]\ntree = ["C2"]') == ["v_C2"]
    assert states(MODELS["divider"]) == ["v_C2"]
    series = SOURCE + "".join(
        f'[inductor.L{k}]\nbetween = ["{a}", "{b}"]\ninductance = {k}\n'
        for k, a, b in ((1, "a", "b"), (2, "b", "c"), (3, "c", "ground"))
    )
    assert states(series) == ["i_L3"]
    assert derived(series).numeric().mass_matrix([]) == [[6]]


def test_the_mass_matrix_of_a_store_that_is_not_linear_takes_v(tmp_path: Path) -> None:
    text = 'name = "curved"\n' + CAPACITORS.replace("capacitance = 1", 'coenergy = "x**4"')
    files = render(modelfile.parse(text.encode(), "model.toml"), languages=["python"])
    emitted = load(files, "curved", tmp_path)
    assert emitted.mass_matrix([], [3.0]).tolist() == [[12 * 3.0**2 + 2]]


def test_a_wish_for_an_edge_of_several() -> None:
    text = SOURCE.replace('"a"', '"in"') + HINGE + MOTOR + "inductance = 1\n"
    text += '[inductor.choke]\nbetween = ["in", "a"]\ninductance = 1\n'
    assert states(text)[-1] == "i_drive"
    assert states(text + '[formulation]\ntree = ["choke"]')[-1] == "i_choke"
    assert states(text + '[formulation]\ntree = ["drive.electrical"]')[-1] == "i_drive"


def test_shafts_of_transducers_keep_their_displacement_where_it_is_used() -> None:
    text = SOURCE + '[mass.m]\nbetween = ["x", "ground"]\nmass = 1\n'
    coil = 'between = ["a", "ground"]\nshaft = ["x", "ground"]\n'
    assert states(text + f"[moving_coil.c]\n{coil}constant = 1\nresistance = 1") == ["v_m"]
    assert states(text + f'[solenoid.c]\n{coil}inductance = "1 + x**2"') == ["v_m", "i_c", "x_c"]
    spring = '[translational_spring.k]\nbetween = ["x", "ground"]\n'
    assert states(text + spring + "stiffness = 2") == ["v_m", "F_k"]
    assert states(text + spring + 'force = "x**3"') == ["v_m", "x_k"]


def test_the_sign_of_a_source_and_of_a_push() -> None:
    text = 'name = "signs"\n[inputs]\nu = {}\n[force_source.f]\nbetween = ["ground", "cart"]\n'
    text += 'force = "u"\n[mass.m]\nbetween = ["cart", "ground"]\nmass = 2\n'
    text += '[translational_spring.k]\nbetween = ["cart", "ground"]\nstiffness = 3\n'
    numeric = derived(text).symbolic
    assert str(numeric.rates) == "Matrix([[-F_k/2 + u/2], [3*v_m]])"


def test_switches_and_controlled_sources() -> None:
    switch = '[conductance.S]\nbetween = ["a", "b"]\nconductance = "10*s"\n'
    text = SOURCE.replace("u = {}", "u = {}\ns = {}") + switch
    text += '[capacitor.C]\nbetween = ["b", "ground"]\ncapacitance = 2\n'
    assert str(derived(text).symbolic.rates) == "Matrix([[5*s*(u - v_C)]])"
    text = SOURCE + LOADED.replace('"a", "b"', '"c", "b"')
    text += '[resistor.R1]\nbetween = ["a", "ground"]\nresistance = 1\n'
    text += '[voltage_source.amp]\nbetween = ["c", "ground"]\nvoltage = "-50*across(R1)"'
    assert str(derived(text).symbolic.rates) == "Matrix([[-50*u - v_C]])"


def test_forces_and_loads_may_name_networks() -> None:
    text = SOURCE + LOADED + HINGE
    text += '[law.push]\njoint = "hinge"\nforce = "x*across(C) + through(R)"\n'
    text += '[load.twist]\nat = "hand"\ntorque = [0, 0, "across(C)"]\n'
    assert states(text) == ["hinge", "wrist", "v_C"]


def test_an_input_in_the_loop_is_in_h(tmp_path: Path) -> None:
    emitted = module("clipper", tmp_path)
    assert list(inspect.signature(emitted.bias).parameters) == ["q", "v", "u"]
    v, u = 0.2, 3.0
    (bias,) = emitted.bias([], [v], [u])
    (rate,) = emitted.forward_dynamics([], [v], [u])
    assert bias == pytest.approx(-1e-6 * rate)
    (drop,) = emitted.algebraic_loop([], [v], [u])
    assert (u - v - drop) / 1e3 == pytest.approx(1e-14 * math.expm1(drop / 0.02585))
    assert rate == pytest.approx((u - v - drop) / 1e3 / 1e-6)


UNSOLVABLE = SOURCE + (
    '[element.E]\ndomain = "electrical"\nbetween = ["a", "b"]\nlaw = "x = 1 + y**2"\n'
    '[resistor.R]\nbetween = ["b", "c"]\nresistance = 1\n'
    '[capacitor.C]\nbetween = ["c", "ground"]\ncapacitance = 1\n'
)
DIVIDED = (
    "[parameters]\nR = 1.0\n"
    + SOURCE
    + LOADED.replace("= 1\n[cap", '= "R"\n[cap')
    + '[resistor.R2]\nbetween = ["b", "ground"]\nresistance = "R"\n'
)


@pytest.mark.parametrize(
    ("text", "status", "message"),
    [
        (UNSOLVABLE, 900, "the algebraic loop of the network has no solution"),
        (DIVIDED, 901, "the static laws of the network are singular here"),
    ],
)
def test_statuses(text: str, status: int, message: str, tmp_path: Path) -> None:
    assert re.search(rf"tatus (is )?{status}\b|status is {status}\b", PAGE)
    files = render(modelfile.parse(text.encode(), "model.toml"))
    assert f"({status}): {message}" in re.sub(r"\s+\*?\s*", " ", files["model.h"])
    emitted = load(files, "model", tmp_path)
    p = [emitted.DEFAULT_PARAMETERS.replace(R=0.0)] if status == 901 else []
    with pytest.raises(np.linalg.LinAlgError, match=message):
        emitted.forward_dynamics(*p, [], [0.0], [-1.0])


# ---- messages


OPAMP = SOURCE + LOADED + '[opamp.A]\nbetween = ["b", "ground"]\noutput = ["out", "ground"]\n'
AGAINST = SOURCE + LOADED.replace("capacitor.C", "resistor.C").replace("capacitance", "resistance")
COPIED = SOURCE + (
    '[diode.D]\nbetween = ["b", "ground"]\n[resistor.R]\nbetween = ["a", "b"]\nresistance = 1\n'
    '[voltage_source.copy]\nbetween = ["c", "ground"]\nvoltage = "across(D)"\n'
    '[capacitor.C]\nbetween = ["c", "ground"]\ncapacitance = 1\n'
)
HELD = SOURCE + (
    '[resistor.R]\nbetween = ["a", "b"]\nresistance = 1\n'
    '[capacitor.C1]\nbetween = ["b", "ground"]\ncapacitance = 1\n'
    '[opamp.A]\nbetween = ["b", "ground"]\noutput = ["c", "ground"]\n'
    '[resistor.R2]\nbetween = ["c", "ground"]\nresistance = 1\n'
    '[capacitor.C2]\nbetween = ["c", "ground"]\ncapacitance = 1\n'
)
FOUR_BAR = (ROOT / "examples" / "four_bar" / "four_bar.toml").read_text("utf-8")
AT_THE_KNEE = FOUR_BAR + SOURCE.replace("[inputs]\nu = {}\n", "").replace('"u"', "12")
AT_THE_KNEE += MOTOR.replace("hinge", "knee") + "inertia = 1e-4\n"
DOMAIN = """
[domain.acoustic]
across = { name = "sound pressure", unit = "Pa", letter = "p" }
through = { name = "mass flow", unit = "kg/s", letter = "m" }
"""

REFUSED = {
    "no ground": SOURCE.replace("ground", "gnd") + LOADED.replace("ground", "gnd"),
    "loop": SOURCE + '[voltage_source.s2]\nbetween = ["a", "ground"]\nvoltage = 1\n' + LOADED,
    "joints tied": HINGE
    + TWO_INTERFACES
    + '[gear.G]\nbetween = ["x", "ground"]\nsecond = ["y", "ground"]\nratio = 3\n',
    "cutset": SOURCE + LOADED + '[current_source.i]\nbetween = ["ground", "x"]\ncurrent = 1\n',
    "repeated": AGAINST + '[opamp.A]\nbetween = ["b", "ground"]\noutput = ["out", "ground"]\n',
    "open op-amp": OPAMP,
    "store on a joint": HINGE
    + SOURCE
    + '[capacitor.C]\nbetween = ["a", "ground"]\ncapacitance = "2 + hinge"\n',
    "store on an edge": SOURCE
    + LOADED
    + '[capacitor.C2]\nbetween = ["b", "ground"]\ncapacitance = "2 + across(R)**2"\n',
    "third derivative": SOURCE
    + '[capacitor.C]\nbetween = ["a", "ground"]\ncapacitance = 1\n'
    + '[current_source.i]\nbetween = ["ground", "b"]\ncurrent = "through(C)"\n'
    + '[inductor.L]\nbetween = ["b", "ground"]\ninductance = 1\n'
    + '[voltage_source.s2]\nbetween = ["c", "ground"]\nvoltage = "across(L)"\n'
    + '[capacitor.C2]\nbetween = ["c", "ground"]\ncapacitance = 1\n'
    + LOADED.replace("R]", "R9]").replace("C]", "C9]").replace('"b"', '"d"'),
    "of a loop": COPIED + LOADED.replace("R]", "R9]").replace("C]", "C9]").replace('"b"', '"d"'),
    "of a rate": HINGE
    + '[voltage_source.s]\nbetween = ["a", "ground"]\nvoltage = "der(hinge)"\n'
    + '[capacitor.C]\nbetween = ["a", "ground"]\ncapacitance = 1\n',
    "held": HELD,
    "named rate": HINGE
    + CAPACITORS
    + '[load.twist]\nat = "hand"\ntorque = [0, 0, "through(C2)"]\n',
    "chord": AT_THE_KNEE,
    "static": SOURCE + '[resistor.R]\nbetween = ["a", "ground"]\nresistance = 1\n',
    "no value": "[parameters]\nC = 0.0\n"
    + SOURCE
    + LOADED.replace("nce = 1\n[c", "nce = 2\n[c").replace("capacitance = 1", 'capacitance = "C"'),
    "massless": '[body.arm]\n[revolute.hinge]\nbetween = ["ground", "arm"]\naxis = [0, 0, 1]\n'
    + SOURCE
    + MOTOR,
    "which edge": HINGE + MOTOR + SOURCE.replace('"u"', '"across(drive)"'),
    "two descriptions": LOADED + 'coenergy = "x**2"\n',
    "no place": MOTOR.replace('joint = "hinge"\n', ""),
    "no equation": '[element.E]\ndomain = "electrical"\nbetween = ["a", "ground"]\nlaw = "x + y"\n',
    "taken": "[parameters]\nx = 1\n"
    + LOADED.replace("nce = 1\n[", "nce = 2\n[").replace("capacitance = 1", 'charge = "x**3"'),
    "no power": DOMAIN,
}
"""Models that are refused."""

WITHOUT_STATE_SPACE = {
    "curved": CAPACITORS + '[diode.D]\nbetween = ["a", "ground"]\n',
    "constant": SOURCE.replace('"u"', "5") + LOADED,
    "improper": MODELS["divider"] + '[outputs]\ni = "through(source)"\n',
}
"""Models of which `state_space` or `to_scipy` says why there is none."""


def message_of(text: str) -> str:
    """What refuses a model, or warns that functions of it are left out."""
    warned: list[str] = []
    try:
        render(modelfile.parse(text.encode(), "model.toml"), warn=warned.append)
    except LinegraphError as error:
        return str(error)
    (warning,) = warned
    return warning


@pytest.fixture(scope="module")
def messages() -> dict[str, str]:
    """What is really said, by case."""
    found = {case: message_of(text) for case, text in REFUSED.items()}
    for case, text in WITHOUT_STATE_SPACE.items():
        symbolic = derived(text).symbolic
        with pytest.raises(LinegraphError) as error:
            symbolic.state_space.to_scipy()
        found[case] = str(error.value)
    loose = SOURCE + LOADED + '[resistor.R2]\nbetween = ["b", "c"]\nresistance = 1\n'
    (found["loose"],) = modelfile.parse(loose.encode(), "model.toml").warnings
    return found


MESSAGES = [words(first)[0] for first, _ in rows("message")]


@pytest.mark.parametrize("quoted", MESSAGES)
def test_messages_are_the_real_ones(quoted: str, messages: dict[str, str]) -> None:
    pattern = ".+".join(map(re.escape, quoted.split("...")))
    assert any(re.search(pattern, message) for message in messages.values())


def test_every_case_is_on_the_page(messages: dict[str, str]) -> None:
    patterns = [".+".join(map(re.escape, quoted.split("..."))) for quoted in MESSAGES]
    for case, message in messages.items():
        assert any(re.search(pattern, message) for pattern in patterns), (case, message)
        assert message.startswith(("model.toml", '"', "state space")), message


# ---- what is not possible


def test_energies_of_charges_and_forces_are_integrated(tmp_path: Path) -> None:
    text = 'name = "known"\n[capacitor.C]\nbetween = ["a", "ground"]\ncharge = "x + x**3"\n'
    text += '[inductor.L]\nbetween = ["a", "ground"]\nflux = "y + y**3"\n'
    text += '[mass.m]\nbetween = ["x", "ground"]\nmass = 2\n'
    text += '[translational_spring.k]\nbetween = ["x", "ground"]\nforce = "x**3"\n'
    assert states(text) == ["v_C", "i_L", "v_m", "x_k"]
    files = render(modelfile.parse(text.encode(), "model.toml"), languages=["python"])
    assert "Not known" not in files["known.py"]
    energy = load(files, "known", tmp_path).energy([], [1.0, 2.0, 3.0, 4.0])
    # x²/2 + 3x⁴/4 of x = 1 and of 2, 9 of the mass, 4⁴/4 of the spring
    assert energy.tolist() == [0, 0, 1.25 + 14 + 9 + 64]


def test_energies_that_are_not_known(tmp_path: Path) -> None:
    text = 'name = "unknown"\n[capacitor.C]\nbetween = ["a", "ground"]\ncharge = "x*exp(x)"\n'
    text += '[mass.m]\nbetween = ["x", "ground"]\nmass = 2\n'
    text += '[element.E]\ndomain = "translation_1d"\nbetween = ["x", "ground"]\n'
    text += (
        'law = "y = s"\nrate = "x - s"\n[resistor.R]\nbetween = ["a", "ground"]\nresistance = 1\n'
    )
    assert states(text) == ["v_C", "v_m", "s_E"]
    files = render(modelfile.parse(text.encode(), "model.toml"))
    for name in ("unknown.py", "unknown.h"):
        said = " ".join(files[name].replace("*", " ").split())
        assert "Not known, and left out: the energy of capacitor C; element E." in said
    energy = load(files, "unknown", tmp_path).energy([], [1.0, 3.0, 5.0])
    assert energy.tolist() == [0, 0, 9]


def test_joints_tied_by_a_spring() -> None:
    spring = '[rotational_spring.k]\nbetween = ["x", "y"]\nstiffness = 3\n'
    assert states(HINGE + TWO_INTERFACES + spring) == ["hinge", "wrist", "tau_k"]


def test_motors_of_closed_mechanisms() -> None:
    """At a chord without rotor, at a branch with one; independent coordinates are not offered."""
    assert derived(AT_THE_KNEE.replace("inertia = 1e-4\n", ""))
    left = AT_THE_KNEE.replace("[formulation]", '[formulation]\ntree = ["knee"]')
    files = render(modelfile.parse(left.encode(), "model.toml"), languages=["python"])
    found = set(re.findall(r"^def ([a-z]\w*)\(", files["four_bar.py"], re.M))
    assert found >= {"forward_dynamics", "project", "rhs"}
    assert not found & {"complete", "reduction", "reduced_equations"}


def test_relations_name_no_networks() -> None:
    text = HINGE + SOURCE + LOADED + '[relation.r]\nrate = "der(hinge) - across(C)"\n'
    assert "across(C) is not known here" in message_of(text)


# ---- the README


def test_the_readme_links_here_and_its_model_runs(tmp_path: Path) -> None:
    assert "(docs/networks.md)" in README
    (text,) = blocks("toml", README)
    (script,) = blocks("shell", README)
    name = name_of(text)
    (tmp_path / f"{name}.toml").write_text(text)
    printed = commands(script, tmp_path)
    assert "good" in printed
    assert (tmp_path / "build" / f"{name}.c").exists()
    for kind in COMPONENTS:
        assert f"`{kind}`" in PAGE

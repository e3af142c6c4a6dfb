"""Networks made to harm: payloads as names and expressions, bombs, and good files with pieces exchanged."""

from __future__ import annotations

import ast
import json
import random
import re
import subprocess
import sys
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from readers.test_modelfile_hostile import PAYLOADS
from support.compiled import Compiled
from support.emitted import load

from linegraph import derive
from linegraph.components.scalar import COMPONENTS
from linegraph.emission.emit import render
from linegraph.errors import LinegraphError
from linegraph.readers.modelfile import parse

if TYPE_CHECKING:
    from collections.abc import Callable

EXAMPLES = Path(__file__).parents[2] / "examples"

# ---- names

NAMED = """\
name = "m"

[domain.{domain}]
across = {{ name = {variable}, unit = "Pa", letter = {letter} }}
through = {{ name = {variable}, unit = "m^3/s", letter = "U" }}

[capacitor.{component}]
between = [{vertex}, "ground"]
capacitance = 2.0
[resistor.load]
between = [{vertex}, "ground"]
resistance = 3.0
[store.box]
between = [{vertex}, "ground"]
domain = {domain}
constant = 0.5
[element.hole]
between = [{vertex}, "ground"]
domain = {domain}
law = "y = x/4"
[transformer.ratio]
between = [{vertex}, "ground"]
second = [{vertex}, "ground"]
domains = ["electrical", {domain}]
ratio = 1.5
[losses.heat]
between = ["ground", {vertex}]
of = ["load", {component}]
[heat_capacity.block]
between = [{vertex}, "ground"]
capacity = 1.0
"""
HARMLESS = {"domain": "d", "variable": "n", "letter": "p", "component": "C1", "vertex": "a"}
"""Every name that a network has."""

HOSTILE = [
    *PAYLOADS,
    'a"; system("touch canary"); "',
    "a\\",
    "a\\\\",
    "\\x41\\u0041",
    "*/ int x; /*",
    "??/",
    "??' '??",
    '"""',
    "'''",
    '""" + open("canary", "w") + """',
    "{{ 7*7 }}",
    "{%- raw -%}",
    "%s%n%d",
    "a\nb",
    "a\x00b",
    "a\x1b[31m",
    "\u202eabc",
    "手",
    "Ω·ẋ²",
    "é\u0301",
    "\U0001f600",
    "x" * 100,
    "x" * 101,
    "手" * 100,
    " ",
    "a ",
    "",
    ".",
    "a.b",
    "a/b",
    "0",
    "__class__",
    "class",
    "ground",
    "t",
    "x",
    "der(x)",
    "across(C1)",
    "C1",
]


def quoted(text: str) -> str:
    """As TOML writes it, in its own key or value."""
    return json.dumps(text).replace("\x7f", "\\u007f")


def named(**names: str) -> str:
    return NAMED.format(**{key: quoted(value) for key, value in (HARMLESS | names).items()})


def bare(files: dict[str, str]) -> list[str]:
    """What the emitted files do: comments left out and texts emptied."""
    found = []
    for end in "hc":
        text = re.sub(r'/\*.*?\*/|"(?:[^"\\\n]|\\.)*"', kept, files[f"m.{end}"], flags=re.DOTALL)
        found.append(re.sub(r"[ \t]+\n", "\n", text))
    tree = ast.parse(files["m.py"])
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            node.value = ""
    return [*found, ast.dump(tree)]


def kept(match: re.Match[str]) -> str:
    return '""' if match[0][0] == '"' else ""


def emitted(text: str) -> dict[str, str] | LinegraphError:
    """The files, or why there are none."""
    try:
        return render(parse(text.encode("utf-8", "surrogatepass"), "m.toml"))
    except LinegraphError as error:
        return error


@pytest.fixture(scope="module")
def harmless() -> list[str]:
    found = emitted(named())
    assert isinstance(found, dict)
    return bare(found)


def require_placed(error: LinegraphError) -> None:
    for line in str(error).split("\n"):
        assert re.match(r"m\.toml(:\d+)?: |and \d+ more$", line), line
        assert line.isprintable()
    assert len(str(error)) < 20_000


@pytest.mark.one_in(3)
@pytest.mark.parametrize(
    ("name", "place"),
    [
        (name, place)
        for name in HOSTILE
        for place in HARMLESS
        if name not in PAYLOADS or place in ("component", "letter")
    ],
)
def test_names_stay_names(name: str, place: str, harmless: list[str]) -> None:
    """Refused with a place, or in comments and texts alone."""
    found = emitted(named(**{place: name}))
    if isinstance(found, LinegraphError):
        require_placed(found)
        return
    assert all(text.isascii() for text in found.values())
    assert not [line for text in found.values() for line in text.split("\n") if len(line) > 1500]
    if name not in HARMLESS.values() and name != "ground":
        assert bare(found) == harmless


@pytest.fixture(scope="module")
def living() -> list[str]:
    """Names that components may have."""
    found = []
    for name in HOSTILE:
        try:
            parse(named(component=name).encode(), "m.toml")
        except LinegraphError:
            continue
        found.append(name)
    return found


def test_some_names_live(living: list[str]) -> None:
    assert len(living) > 10
    assert any(not name.isascii() for name in living)
    assert any('"' in name for name in living)
    assert any("\\" in name for name in living)


def test_names_arrive_as_they_are(living: list[str], tmp_path: Path) -> None:
    """What the compiled C and the imported Python call the states is what the file said."""
    text = 'name = "m"\n'
    for k, name in enumerate(living):
        text += f"[capacitor.{quoted(name)}]\n" if name != "load" else "[capacitor.other]\n"
        text += f'between = [{quoted(name)}, "ground"]\ncapacitance = 2.0\n'
        text += f'[resistor."R {k}"]\nbetween = [{quoted(name)}, "ground"]\nresistance = 3.0\n'
    text = text.replace('between = ["ground", "ground"]', 'between = ["g", "ground"]')
    files = emitted(text)
    assert isinstance(files, dict), files
    wanted = [f"v_{'other' if name == 'load' else name}" for name in living]
    module = load(files, "m", tmp_path)
    assert list(module.V_NAMES) == wanted
    compiled = Compiled(files, "m", tmp_path)
    assert [x.decode() for x in compiled.names("v", len(wanted)) if x is not None] == wanted
    assert {path.name for path in tmp_path.iterdir()} <= {
        "m.h",
        "m.c",
        "m.py",
        "m.so",
        "__pycache__",
    }


# ---- expressions and all other fields

HINGE = """\
[body.arm]
mass = 1
inertia = [1, 1, 1]
[revolute.hinge]
between = ["ground", "arm"]
axis = [0, 1, 0]
"""
BASE = f"""\
{HINGE}
[resistor.R1]
between = ["a", "ground"]
resistance = 2.0
[capacitor.C1]
between = ["a", "ground"]
capacitance = 3.0
[rotational_damper.drag]
between = ["s", "ground"]
damping = 1.0
"""
PAIR = '["a", "ground"]'
FIELDS = {
    "resistance": f"[resistor.it]\nbetween = {PAIR}\nresistance = @\n",
    "charge": f"[capacitor.it]\nbetween = {PAIR}\ncharge = @\n",
    "coenergy": f"[inductor.it]\nbetween = {PAIR}\ncoenergy = @\n",
    "voltage": '[voltage_source.it]\nbetween = ["b", "a"]\nvoltage = @\n',
    "law": f'[element.it]\nbetween = {PAIR}\ndomain = "electrical"\nlaw = @\n',
    "rate": f'[element.it]\nbetween = {PAIR}\ndomain = "electrical"\nlaw = "y = s"\nrate = @\n',
    "domain": f'[element.it]\nbetween = {PAIR}\ndomain = @\nlaw = "y = x"\n',
    "ratio": f'[transformer.it]\nbetween = {PAIR}\nsecond = ["b", "ground"]\nratio = @\n',
    "domains": f'[gyrator.it]\nbetween = {PAIR}\nsecond = ["b", "ground"]\nratio = 1\ndomains = @\n',
    "keeps": f"[store.it]\nbetween = {PAIR}\nconstant = 1\nkeeps = @\n",
    "windings": "[coupled_inductors.it]\nwindings = @\ninductance = [[1, 0], [0, 1]]\n",
    "inductance": f"[coupled_inductors.it]\nwindings = [{PAIR}, {PAIR}]\ninductance = @\n",
    "entry": f"[coupled_inductors.it]\nwindings = [{PAIR}, {PAIR}]\ninductance = [[@, 0], [0, @]]\n",
    "flux": f"[synchronous_machine.it]\nwindings = [{PAIR}]\ninductance = [[1]]\nflux = [@]\njoint = "
    '"hinge"\n',
    "constant": f'[dc_motor.it]\nbetween = {PAIR}\nshaft = ["s", "ground"]\nresistance = 1\nconstant = @\n',
    "joint": f"[dc_motor.it]\nbetween = {PAIR}\njoint = @\nresistance = 1\nconstant = 1\n",
    "shaft": f"[dc_motor.it]\nbetween = {PAIR}\nshaft = @\nresistance = 1\nconstant = 1\n",
    "points": f"[moving_coil.it]\nbetween = {PAIR}\npoints = @\nconstant = 1\n",
    "energy": f'[solenoid.it]\nbetween = {PAIR}\nshaft = ["s", "ground"]\nenergy = @\n',
    "of": '[losses.it]\nbetween = ["w", "ground"]\nof = @\n',
    "names": '[losses.it]\nbetween = ["w", "ground"]\nof = [@]\n',
    "between": "[resistor.it]\nbetween = @\nresistance = 1\n",
    "unit": '[domain.it]\nacross = { name = "p", unit = @, letter = "p" }\n'
    'through = { name = "q", unit = "m^3/s", letter = "q" }\n',
    "letter": '[domain.it]\nacross = @\nthrough = { name = "q", unit = "m^3/s", letter = "q" }\n',
}
"""One table each; what is hostile stands for @."""

CODE = PAYLOADS[:22]


@pytest.mark.parametrize("field", FIELDS)
@pytest.mark.parametrize("payload", CODE)
def test_nothing_is_executed(payload: str, field: str) -> None:
    """No field of a component takes code: each refuses it where it stands."""
    text = f"{BASE}{FIELDS[field].replace('@', quoted(payload))}"
    (line,) = {k for k, row in enumerate(text.split("\n"), 1) if quoted(payload) in row}
    found = emitted(text)
    assert isinstance(found, LinegraphError)
    require_placed(found)
    lines = {int(x) for x in re.findall(r"^m\.toml:(\d+):", str(found), re.MULTILINE)}
    first = text[: text.rindex("\n[")].count("\n") + 2
    assert lines & {line, first}, found


REACHING = [
    "across(C1).__class__",
    "across(__import__('os'))",
    "across('C1')",
    "across(C1, R1)",
    "across(C1)(1)",
    "across[C1]",
    "across(C1.__dict__)",
    "through(R1).real",
    "through(*C1)",
    "across(x=C1)",
    "across(across(C1))",
    "der(across(C1))",
    "lambda: across(C1)",
    "across(C1) if 1 else 2",
    "across(C1) or 2",
    "(y := across(C1))",
    "[across(C1)]",
    "across(C1) @ 2",
    "f'{across(C1)}'",
    "across",
    "through",
    "potential(a)",
    "value(1)",
    "states",
    "X[0]",
    "dag.symbol(1)",
]
"""What would reach into things if it were ever run."""


@pytest.mark.parametrize("field", ["resistance", "charge", "voltage", "rate", "entry", "energy"])
@pytest.mark.parametrize("payload", REACHING)
def test_nothing_can_be_reached(payload: str, field: str) -> None:
    found = emitted(f"{BASE}{FIELDS[field].replace('@', quoted(payload))}")
    assert isinstance(found, LinegraphError)
    require_placed(found)


WRONG = [
    "1",
    "-1.5",
    "true",
    "[]",
    "{}",
    "[[]]",
    "[1, 2]",
    '["a"]',
    "1979-05-27",
    '""',
    '"a"',
    "[[[1]]]",
]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("kind", COMPONENTS)
def test_values_of_any_type_are_refused_or_taken(kind: str) -> None:
    """Every key of every type, with values of all types: a model, or an error with a line."""
    for field in fields(COMPONENTS[kind]):
        for value in WRONG:
            if field.name == "name":
                continue
            text = f"{BASE}[{kind}.it]\n{field.name} = {value}\n"
            if field.name != "between":
                text += f"between = {PAIR}\n"
            found = emitted(text)
            if isinstance(found, LinegraphError):
                require_placed(found)


WATCHED = """
import json, sys
from linegraph.emission.emit import render
from linegraph.errors import LinegraphError
from linegraph.readers.modelfile import parse

texts = json.load(sys.stdin)

def tried(text):
    try:
        render(parse(text.encode(), "m.toml"))
    except LinegraphError as error:
        str(error)

tried(texts[0])
tried("[resistr]")
watching = True

def hook(event, arguments):
    if watching and event.split(".")[0] in ("open", "socket", "subprocess", "os", "exec", "import", "shutil"):
        print(event, arguments)

sys.addaudithook(hook)
for text in texts:
    tried(text)
watching = False
"""


def test_nothing_is_opened_run_or_imported(living: list[str], tmp_path: Path) -> None:
    """From the text to the emitted files nothing but calculation happens, whatever stands there."""
    texts = [named()]
    texts += [
        f"{BASE}{FIELDS[field].replace('@', quoted(p))}" for field in FIELDS for p in CODE[:8]
    ]
    texts += [named(**{place: p}) for place in HARMLESS for p in CODE]
    texts += [named(component=name) for name in living]
    done = subprocess.run(
        [sys.executable, "-c", WATCHED],
        input=json.dumps(texts),
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        cwd=tmp_path,
        env={"PYTHONPATH": str(EXAMPLES.parent), "PATH": ""},
    )
    assert done.returncode == 0, done.stderr[-2000:]
    assert done.stdout == ""
    assert not list(tmp_path.iterdir())


# ---- bombs

SECONDS = 20  # of CPU, on any machine: what unfolds or searches takes minutes
MEBIBYTES = 1024

LIMITED = f"""
import resource, sys, time
resource.setrlimit(resource.RLIMIT_AS, ({MEBIBYTES} << 20, {MEBIBYTES} << 20))
from pathlib import Path
from linegraph.emission.emit import render
from linegraph.errors import LinegraphError
from linegraph.readers.modelfile import parse
text = Path(sys.argv[1]).read_bytes()
start = time.process_time()
try:
    render(parse(text, "m.toml"))
    print("derived")
except LinegraphError as error:
    print(error)
assert time.process_time() - start < {SECONDS}, time.process_time() - start
"""


def resistor(name: str, tail: str, head: str, value: float | str = 2) -> str:
    return f'[resistor.{name}]\nbetween = ["{tail}", "{head}"]\nresistance = {json.dumps(value)}\n'


def law(text: str) -> str:
    return f'{BASE}[element.it]\nbetween = {PAIR}\ndomain = "electrical"\nlaw = "y = {text}"\n'


def doubled(depth: int) -> str:
    return "x" if depth == 0 else f"({doubled(depth - 1)}*sin({doubled(depth - 1)}))"


def matrix(size: int, entry: Callable[[int, int], str]) -> str:
    rows = (", ".join(entry(min(i, j), max(i, j)) for j in range(size)) for i in range(size))
    return f"inductance = [{', '.join(f'[{row}]' for row in rows)}]\n"


def coils(size: int) -> str:
    pairs = ", ".join(f'["w{k}", "ground"]' for k in range(size))
    return f"windings = [{pairs}]\n"


DRAW = random.Random(0)
REPEATED = ", ".join(['"R1"'] * 20_000)
BOMBS: dict[str, tuple[Callable[[], str], str]] = {
    "windings": (lambda: f"[coupled_inductors.K]\n{coils(20_000)}", "more than 50000"),
    "fewer_windings": (lambda: f"[coupled_inductors.K]\n{coils(10_000)}", "a list of windings"),
    "matrix": (
        lambda: f"[coupled_inductors.K]\n{coils(2)}{matrix(200, lambda i, j: '1')}",
        "a matrix",
    ),
    "matrix_of_expressions": (
        lambda: (
            f'{BASE}[synchronous_machine.S]\nshaft = ["s", "ground"]\n{coils(40)}'
            + matrix(40, lambda i, j: f'"cos({i}*x + {j})"')
        ),
        "",
    ),
    "factors": (lambda: law("*".join(["x"] * 4_900)), "cannot read"),
    "fewer_factors": (lambda: law("*".join(["x"] * 90)), "derived"),
    "functions": (lambda: law("exp(" * 95 + "x" + ")" * 95), ""),
    "doubled": (lambda: law(doubled(9)), "derived"),
    "powers": (lambda: law("((((1.1**64)**64)**64)**64)*x"), "too large"),
    "power_of_x": (lambda: law("(((x**64)**64)**64)**64"), ""),
    "heats": (
        lambda: f'{BASE}[losses.h]\nbetween = ["w", "ground"]\nof = [{REPEATED}]\n',
        "a list of names",
    ),
    "empty_tables": (lambda: "".join(f"[resistor.r{i}]\n" for i in range(24_000)), "is missing"),
    "domains": (
        lambda: "".join(
            f'[domain.d{i}]\nacross = {{ name = "p", unit = "Pa", letter = "p" }}\n'
            'through = { name = "q", unit = "m^3/s", letter = "q" }\n'
            for i in range(5_000)
        ),
        "nothing to derive",
    ),
    "units": (
        lambda: (
            f'{BASE}[domain.d]\nacross = {{ name = "p", unit = "{"m*" * 190}m", letter = "p" }}\n'
            f'through = {{ name = "q", unit = "m^{"9" * 300}", letter = "q" }}\n'
        ),
        "power",
    ),
    "hints": (
        lambda: (
            BASE
            + "".join(
                resistor(f"r{i}", "a", f"n{i}", f"across({'ab' * 40}{i})") for i in range(4_000)
            )
        ),
        "no component",
    ),
    "many_sources": (
        lambda: (
            BASE
            + "".join(
                f'[voltage_source.v{i}]\nbetween = ["a", "ground"]\nvoltage = 1\n'
                for i in range(1_500)
            )
        ),
        "closes a loop",
    ),
    "chain_of_sources": (
        lambda: (
            BASE
            + "".join(
                f'[voltage_source.v{i}]\nbetween = ["n{i}", "ground"]\n'
                f'voltage = "across(v{(i + 1) % 200})*across(v{(i + 2) % 200})"\n'
                for i in range(200)
            )
        ),
        "",
    ),
    "squares_of_squares": (
        lambda: (
            BASE
            + "".join(
                f'[voltage_source.v{i}]\nbetween = ["n{i}", "ground"]\n'
                f'voltage = "across(v{i - 1})**2"\n' + resistor(f"q{i}", f"n{i}", "ground")
                for i in range(50)
            ).replace("v-1", "R1")
        ),
        "derived",
    ),
    "resistors_in_parallel": (
        lambda: BASE + "".join(resistor(f"r{i}", "a", "ground", DRAW.random()) for i in range(400)),
        "derived",
    ),
    "resistors_in_series": (
        lambda: (
            BASE
            + "".join(
                resistor(f"r{i}", f"n{i}", f"n{i + 1}" if i < 399 else "a", DRAW.random())
                for i in range(400)
            ).replace('"n0"', '"ground"')
        ),
        "derived",
    ),
    "loose_ends": (
        lambda: BASE + "".join(resistor(f"r{i}", "a", f"n{i}") for i in range(500)),
        "derived",
    ),
    "derivatives": (
        lambda: (
            BASE
            + "[inputs]\nu = {}\n"
            + '[voltage_source.v]\nbetween = ["n0", "ground"]\nvoltage = "u"\n'
            + "".join(
                f'[capacitor.c{i}]\nbetween = ["n{i}", "m{i}"]\ncapacitance = 1\n'
                f'[opamp.o{i}]\nbetween = ["ground", "m{i}"]\noutput = ["n{i + 1}", "ground"]\n'
                + resistor(f"q{i}", f"m{i}", f"n{i + 1}")
                for i in range(40)
            )
        ),
        "derivative of input u",
    ),
    "losses_of_losses": (
        lambda: (
            BASE
            + '[heat_capacity.w]\nbetween = ["w", "ground"]\ncapacity = 1\n'
            + "".join(
                f'[losses.h{i}]\nbetween = ["ground", "w"]\nof = ["R1"]\n' for i in range(300)
            )
        ),
        "derived",
    ),
}


@pytest.mark.one_in(3)
@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are Linux's")
@pytest.mark.parametrize("bomb", BOMBS)
def test_bombs_are_soon_over(bomb: str, tmp_path: Path) -> None:
    """Refused or derived, in two seconds and little memory."""
    make, says = BOMBS[bomb]
    path = tmp_path / "m.toml"
    path.write_text(make())
    done = subprocess.run(
        [sys.executable, "-c", LIMITED, str(path)],
        capture_output=True,
        text=True,
        timeout=30,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    assert says in done.stdout
    assert len(done.stdout) < 20_000


# ---- mutations

MUTATED = ("rlc_ladder", "motor_warming_up", "cart_pole_motor")
SOME = 100
TOKENS = re.compile(r'"[^"\n]*"|[\w.+-]+|\s+|.', re.DOTALL)
ODD = [
    *('""', '"0"', '"-1"', "0", "-1", "1e-300", "1e300", "nan", "1e400", "true", "[]", "{}"),
    *('"ground"', '["a", "b"]', '[["a", "ground"]]', '"t"', '"x"', '"y"', '"u"', '"u*u"', '"1/u"'),
    *('"across(R1)"', '"through(R1)"', '"across(C1)**2"', '"1/0"', '"sqrt(-1)"', '"log(t)"'),
    *('"y = x"', '"x = y"', '"y = 1"', '"x**3"', '"electrical"', '"rotation_1d"', '"der(slide)"'),
    *('"exp(across(C1))"', '"1/across(C1)"', '"through(motor.electrical)"', '"across(motor)"'),
]


def blocks(lines: list[str]) -> list[tuple[int, int]]:
    """Where the tables are."""
    heads = [k for k, line in enumerate(lines) if line.startswith("[")]
    return list(zip(heads, [*heads[1:], len(lines)], strict=True))


def table_mutated(lines: list[str], draw: random.Random) -> list[str]:
    """A table or a line left out, repeated under another name, or of another type."""
    tables = blocks(lines)
    first, last = draw.choice(tables)
    match draw.randrange(4):
        case 0:
            del lines[first:last]
        case 1:
            del lines[draw.randrange(len(lines))]
        case 2:
            again = lines[first:last]
            again[0] = re.sub(r"\.(\w+)\]", rf".\1_{draw.randrange(99)}]", again[0])
            lines[last:last] = again
        case 3:
            kind = re.match(r"\[(\w+)\.", lines[draw.choice(tables)[0]])
            if kind:
                lines[first] = re.sub(r"\[\w+\.", f"[{kind[1]}.", lines[first])
    return lines


def value_mutated(lines: list[str], draw: random.Random) -> list[str]:
    """A value or name that is another one's, or changed places with it, or is odd."""
    tokens = TOKENS.findall("\n".join(lines))
    places = [i for i, token in enumerate(tokens) if re.match(r'"|[-\d]', token)]
    i, j = draw.choice(places), draw.choice(places)
    match draw.randrange(3):
        case 0:
            tokens[i] = draw.choice(ODD)
        case 1:
            tokens[i], tokens[j] = tokens[j], tokens[i]
        case 2:
            tokens[i] = tokens[j]
    return "".join(tokens).split("\n")


def mutated(text: str, draw: random.Random) -> str:
    lines = text.split("\n")
    for _ in range(draw.randint(1, 3)):
        change = table_mutated if draw.random() < 0.45 and blocks(lines) else value_mutated
        lines = change(lines, draw)
    return "\n".join(lines)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("example", MUTATED)
@pytest.mark.parametrize("start", range(0, SOME, 25))
def test_mutations_are_derived_or_refused(example: str, start: int) -> None:
    """A model with all its code, or an error in a printable line that has a place in the file."""
    text = (EXAMPLES / example / f"{example}.toml").read_text(encoding="utf-8")
    for seed in range(start, start + 25):
        changed = mutated(text, random.Random(seed))
        try:
            model = parse(changed.encode(), "m.toml")
            derive(model)
            render(model)
        except LinegraphError as error:
            require_placed(error)
        except Exception as error:
            raise AssertionError(f"{type(error).__name__}: {error}\n\n{changed}") from error

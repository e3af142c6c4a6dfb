"""Model files made to harm: bombs, payloads, and a good file with tokens deleted, swapped, repeated."""

from __future__ import annotations

import ast
import random
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from support.modelfile_text import SMALL, ZOO

from linegraph.emission.emit import render
from linegraph.errors import LinegraphError
from linegraph.model.builder import Model
from linegraph.readers.modelfile import parse

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

SECONDS = 20  # of CPU, on any machine: what unfolds or searches takes minutes
MEBIBYTES = 512

LIMITED = f"""
import resource, sys, time
resource.setrlimit(resource.RLIMIT_AS, ({MEBIBYTES} << 20, {MEBIBYTES} << 20))
from linegraph.errors import LinegraphError
from linegraph.readers.modelfile import read
start = time.process_time()
try:
    read(sys.argv[1])
except LinegraphError as error:
    print(error)
assert time.process_time() - start < {SECONDS}, time.process_time() - start
"""

WATCHED = """
import sys
import difflib, tomllib
from linegraph.errors import LinegraphError
from linegraph.readers.modelfile import read

def hook(event, arguments):
    watched = event.split(".")[0] in ("open", "socket", "subprocess", "os", "exec", "import", "urllib")
    if watched and not isinstance(arguments[0], int):  # a number stands for a file already open
        print(event, arguments[0])

sys.addaudithook(hook)
try:
    read(sys.argv[1])
except LinegraphError as error:
    print("refused:", error)
"""


def run(script: str, path: Path) -> str:
    command = [sys.executable, "-c", script, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout


MEGA = 2**20
BOMBS: dict[str, tuple[Callable[[], str], str]] = {
    "lists": (lambda: "a = " + "[" * MEGA, "nested more than 16"),
    "tables": (lambda: "a = " + "{a=" * MEGA, "nested more than 16"),
    "dotted": (lambda: "a" + ".a" * MEGA + " = 1", "nested more than 16"),
    "header": (lambda: "[a" + ".a" * MEGA + "]", "nested more than 16"),
    "headers": (lambda: "".join(f"[a.b.c{i}]\n" for i in range(400_000)), "more than"),
    "keys": (lambda: "".join(f"a{i}=1\n" for i in range(600_000)), "more than"),
    "quoted_keys": (lambda: "".join(f'"a{i}"=1\n' for i in range(40_000)), "not known"),
    "arrays_of_tables": (lambda: "[[a]]\n" * 150_000, "more than 50000"),
    "items": (lambda: "a = [" + "1," * 3_000_000 + "]", "more than 50000"),
    "inline": (
        lambda: "a = {" + ",".join(f"a{i}=1" for i in range(500_000)) + "}",
        "more than 50000",
    ),
    "lines": (lambda: "\n" * 8_000_000 + "a", "more than 200000 lines"),
    "comments": (lambda: "#\n" * 4_000_000, "more than 200000 lines"),
    "one_comment": (lambda: "#" + "x" * 8_000_000 + "\na = 1", "not known"),
    "one_text": (lambda: 'a = "' + "x" * 8_000_000 + '"', "more than 20000 characters"),
    "escapes": (lambda: 'a = "' + "\\n" * 4_000_000 + '"', "more than 20000 characters"),
    "texts": (
        lambda: "".join(f'a{i} = "{"x" * 19_000}"\n' for i in range(430)),
        "more than 500000",
    ),
    "literal_text": (lambda: "a = '''" + "'x" * 4_000_000 + "'''", "more than 20000 characters"),
    "open_text": (lambda: 'a = """' + '""x' * 2_500_000, "TOML"),
    "long_key": (lambda: "a" * 8_000_000 + " = 1", "not known"),
    "long_number": (lambda: "a = " + "1" * 8_000_000, "more than 400 characters"),
    "long_float": (lambda: "a = 1." + "1" * 8_000_000, "more than 400 characters"),
    "blanks": (lambda: "a" + " " * 8_000_000 + "= 1", "not known"),
    "terms": (lambda: SMALL.replace('"m"', '"' + "m+" * 4_900 + 'm"'), "cannot read"),
    "many_terms": (
        lambda: "[parameters]\n" + "".join(f'a{i} = "{"(1)+" * 90}1"\n' for i in range(1_500)),
        "more than 500000 characters",
    ),
    "doubling": (
        lambda: (
            "[parameters]\na0 = 2\n"
            + "".join(f'a{i} = "a{i - 1}*a{i - 1}"\n' for i in range(1, 5000))
        ),
        "finite",
    ),
    "chain": (
        lambda: (
            "[parameters]\na0 = 2\n" + "".join(f'a{i} = "a{i - 1}"\n' for i in range(1, 40_000))
        ),
        "more than 5000",
    ),
    "shorter_chain": (
        lambda: "[parameters]\na0 = 2\n" + "".join(f'a{i} = "a{i - 1}"\n' for i in range(1, 5_000)),
        "",
    ),
    "circle": (
        lambda: "[parameters]\n" + "".join(f'a{i} = "a{(i + 1) % 5_000}"\n' for i in range(5_000)),
        "depends on itself: a0 ->",
    ),
    "bodies": (lambda: "".join(f"[body.b{i}]\n" for i in range(24_000)), ""),
    "frames": (lambda: "[body.b]\n" + "".join(f"frame.f{i} = {{}}\n" for i in range(24_000)), ""),
    "frames_of_ground": (lambda: "".join(f"[frame.f{i}]\n" for i in range(24_000)), ""),
    "hints": (
        lambda: "".join(f"[body.{'ab' * 30}{i}]\nma{'s' * 70} = 1\n" for i in range(15_000)),
        "unknown key",
    ),
    "unknown_bodies": (
        lambda: "".join(
            f'[body.{"ab" * 30}{i}]\n[revolute.j{i}]\nbetween = ["{"ba" * 30}", "b"]\naxis=[0,0,1]\n'
            for i in range(4_000)
        ),
        "no body or frame",
    ),
    "couplings": (
        lambda: "".join(
            f'[body.b{i}]\n[revolute.j{i}]\nbetween = ["ground", "b{i}"]\naxis=[0,0,1]\n'
            f'follows = {{ joint = "j{i + 1}" }}\n'
            for i in range(3_000)
        ),
        "no joint",
    ),
    "rotors": (
        lambda: SMALL + "".join(f'[rotor.r{i}]\njoint="hinge"\ninertia=1\n' for i in range(3_000)),
        "",
    ),
    "json_lists": (lambda: '{"a":' + "[" * MEGA, "nested more than 16"),
    "json_keys": (
        lambda: "{" + ",".join(f'"a{i}":1' for i in range(600_000)) + "}",
        "more than 50000",
    ),
    "json_text": (lambda: '{"a": "' + "x" * 8_000_000 + '"}', "more than 20000"),
    "json_number": (lambda: '{"a": ' + "1" * 8_000_000 + "}", "more than 400"),
    "json_open_texts": (lambda: '{"' * 4_000_000, "JSON"),
}


@pytest.mark.one_in(4)
@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are Linux's")
@pytest.mark.parametrize("bomb", BOMBS)
def test_bombs_are_refused_soon_and_in_little_memory(bomb: str, tmp_path: Path) -> None:
    make, says = BOMBS[bomb]
    path = tmp_path / ("m.json" if bomb.startswith("json") else "m.toml")
    path.write_text(make())
    message = run(LIMITED, path)
    assert says in message
    assert len(message) < 20_000


# ---------------------------------------------------------------- payloads

PAYLOADS = [
    "__import__('os').system('touch canary')",
    "().__class__.__bases__[0].__subclasses__()",
    "exec('import os')",
    "open('canary', 'w')",
    "print.__self__.open('canary', 'w')",
    "(lambda: open('canary', 'w'))()",
    "[open('canary', 'w') for _ in (1,)]",
    'f\'{open("canary", "w")}\'',
    "'{0.__class__}'.format(m)",
    "m.__reduce__()",
    "Symbol('m')",
    "Lambda(m, m)",
    "S(m)",
    "{{ m }}",
    "{% import os %}",
    '*/ system("touch canary"); /*',
    "m\nimport os",
    "m; import os",
    "$(touch canary)",
    "`touch canary`",
    "%n%n%n",
    "!!python/object/apply:os.system ['touch canary']",
]


@pytest.mark.parametrize("place", ["expression", "unit", "name", "key", "description"])
@pytest.mark.parametrize("payload", PAYLOADS)
def test_nothing_is_executed(payload: str, place: str, tmp_path: Path) -> None:
    quoted = '"' + payload.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
    text = {
        "expression": SMALL.replace('mass = "m"', f"mass = {quoted}"),
        "unit": SMALL.replace('"N"', quoted),
        "name": SMALL.replace('"small"', quoted),
        "key": SMALL + f"[body.{quoted}]\n",
        "description": f"description = {quoted}\n{SMALL}",
    }[place]
    try:
        found: Model | LinegraphError = parse(text.encode(), "m.toml")
    except LinegraphError as error:
        found = error
    if isinstance(found, Model):
        assert place != "expression"
    else:
        assert str(found).startswith("m.toml:")


ASKED = [
    "position(__import__('os')).x",
    "position(arm.__class__).x",
    "position(arm).__class__",
    "position(arm).x.__class__",
    "force(__builtins__).x",
    "across(open('canary', 'w'))",
    "through(hinge.__globals__)",
    "der(__class__)",
    "velocity(arm.tip).x if open('canary', 'w') else 0",
    "position(arm.mass_center.real).x",
]
"""What would reach into things if it were ever run."""


def code_of(line: str) -> list[str]:
    """What is emitted for a model with this output, comments and docstrings left out."""
    files = render(parse(f"{SMALL}[outputs]\n{line}\n".encode(), "m.toml"))
    text = [re.sub(r"/\*.*?\*/", "", files[f"small.{end}"], flags=re.DOTALL) for end in "hc"]
    return [*text, ast.dump(ast.Module(ast.parse(files["small.py"]).body[1:], []))]


@pytest.mark.one_in(3)
@pytest.mark.parametrize("place", ["value", "table", "unit", "about", "name"])
@pytest.mark.parametrize("payload", [*PAYLOADS, *ASKED])
def test_nothing_is_executed_that_outputs_ask_for(payload: str, place: str) -> None:
    """As an expression or a name it is refused; as a text it stays in comments."""
    quoted = '"' + payload.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
    line = {
        "value": f"y = {quoted}",
        "table": f"y = {{ value = {quoted} }}",
        "unit": f"y = {{ value = 1, unit = {quoted} }}",
        "about": f"y = {{ value = 1, about = {quoted} }}",
        "name": f"{quoted} = 1",
    }[place]
    try:
        found: list[str] | LinegraphError = code_of(line)
    except LinegraphError as error:
        found = error
    if isinstance(found, LinegraphError):
        assert re.match(r"m\.toml:\d+: \[outputs\] ", str(found))
    else:
        assert place in ("unit", "about")
        assert found == code_of("y = 1")


@pytest.mark.parametrize("payload", PAYLOADS[:8])
def test_nothing_but_the_file_is_opened(payload: str, tmp_path: Path) -> None:
    quoted = '"' + payload.replace("\\", "\\\\").replace('"', '\\"') + '"'
    path = tmp_path / "m.toml"
    path.write_text(SMALL.replace('mass = "m"', f"mass = {quoted}"))
    *events, refusal = run(WATCHED, path).splitlines()
    assert [event for event in events if not event.startswith("import ")] == [f"open {path}"]
    assert refusal.startswith("refused:")
    assert list(tmp_path.iterdir()) == [path]


# ---------------------------------------------------------------- mutations

TOKENS = re.compile(r'"[^"\n]*"|[\w.+-]+|\s+|.', re.DOTALL)
NASTY = [
    '""', '"0"', '"-1"', "nan", "1e400", "[]", "{}", "[0, 0, 0]", '"a"', '"swing"', '"ground"', "true", "-1",
    '"t"', '"x"', '"der(slide)"', '"1/0"', "1979-05-27", "[", "]", "{", "}", "=", ",", "\n", "#", "'''",
    '"""', "[body.cart]", "[revolute.a]", "follows", "motion", '"input"', '"mass_center"', "\ufeff", "手",
    "\x00", '"sin(swing)"', '"m**-0.5"', '"log(m - m)"', "\\", '"atan2(0, 0)"', "1_000", "0x10", "inf",
]  # fmt: skip


def mutated(text: str, draw: random.Random) -> str:
    tokens = TOKENS.findall(text)
    for _ in range(draw.randint(1, 3)):
        i, j = draw.randrange(len(tokens)), draw.randrange(len(tokens))
        match draw.randrange(5):
            case 0:
                del tokens[i : i + draw.choice((1, 1, 1, 5, 30))]
            case 1:
                tokens[i], tokens[j] = tokens[j], tokens[i]
            case 2:
                tokens.insert(i, tokens[i])
            case 3:
                tokens[i] = draw.choice(NASTY)
            case 4:
                tokens[i:i] = tokens[j : j + draw.choice((1, 5, 40))]
        tokens = tokens or [" "]
    return "".join(tokens)


def values_mutated(text: str, draw: random.Random) -> str:
    """Only what stands in quotes or is a number: most of these stay TOML."""
    tokens = TOKENS.findall(text)
    places = [i for i, token in enumerate(tokens) if re.match(r'"|[-\d]', token)]
    for _ in range(draw.randint(1, 4)):
        i, j = draw.choice(places), draw.choice(places)
        other = draw.choice([token for token in NASTY if token[0] in '"-1[t{n'])
        tokens[i] = draw.choice((tokens[j], other))
    return "".join(tokens)


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("mutate", [mutated, values_mutated])
def test_mutations_give_a_model_or_an_error_with_a_place(
    mutate: Callable[[str, random.Random], str], seed: int
) -> None:
    draw = random.Random(seed)
    for _ in range(25):
        text = mutate(ZOO, draw).encode("utf-8", "surrogatepass")
        try:
            found: Model | LinegraphError = parse(text, "m.toml")
        except LinegraphError as error:
            found = error
        if isinstance(found, LinegraphError):
            for line in str(found).split("\n"):
                assert re.match(r"m\.toml(:\d+)?: |and \d+ more", line), text.decode()

"""Files made to harm: bombs, reads of other files, and good files with tokens deleted, swapped, repeated."""

from __future__ import annotations

import random
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from support.urdf_text import ZOO, inertial, joint, link, mimic, robot

from linegraph.derivation import derive
from linegraph.errors import LinegraphError
from linegraph.model.builder import Model
from linegraph.readers.urdf import parse

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

SECONDS = 20  # of CPU, on any machine: what unfolds or searches takes minutes
MEBIBYTES = 512

LIMITED = f"""
import resource, sys, time
resource.setrlimit(resource.RLIMIT_AS, ({MEBIBYTES} << 20, {MEBIBYTES} << 20))
from linegraph.errors import SourceError
from linegraph.readers.urdf import read
start = time.process_time()
try:
    read(sys.argv[1])
except SourceError as error:
    print(error)
assert time.process_time() - start < {SECONDS}, time.process_time() - start
"""

WATCHED = """
import sys
import difflib, lxml.etree
from linegraph.errors import SourceError
from linegraph.readers.urdf import read

def hook(event, arguments):
    watched = event.split(".")[0] in ("open", "socket", "subprocess", "os", "exec", "compile", "urllib")
    if watched and not isinstance(arguments[0], int):  # a number stands for a file already open
        print(event, *arguments)

sys.addaudithook(hook)
try:
    read(sys.argv[1])
except SourceError as error:
    print("refused:", error)
"""


def run(script: str, path: Path) -> str:
    command = [sys.executable, "-c", script, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def _laughs() -> bytes:
    entities = ["<!ENTITY a0 'ha'>"]
    entities += [f"<!ENTITY a{i} '{f'&a{i - 1};' * 10}'>" for i in range(1, 12)]
    return f"<!DOCTYPE robot [{''.join(entities)}]>\n<robot name='r'><link name='&a11;'/></robot>".encode()


def _quadratic() -> bytes:
    uses = "&a;" * 100_000
    return f"<!DOCTYPE robot [<!ENTITY a '{'x' * 100_000}'>]>\n<robot name='{uses}'/>".encode()


BOMBS: dict[str, tuple[Callable[[], bytes], str]] = {
    "billion_laughs": (_laughs, "DOCTYPE"),
    "quadratic_blow_up": (_quadratic, "DOCTYPE"),
    "external_entity": (
        lambda: b'<!DOCTYPE robot [<!ENTITY a SYSTEM "file:///etc/passwd">]>\n<robot name="&a;"/>',
        "DOCTYPE",
    ),
    "external_dtd": (
        lambda: b'<!DOCTYPE robot SYSTEM "http://192.0.2.1/r.dtd">\n<robot name="r"/>',
        "DOCTYPE",
    ),
    "parameter_entity": (
        lambda: (
            b'<!DOCTYPE robot [<!ENTITY % a SYSTEM "file:///dev/zero"> %a;]>\n<robot name="r"/>'
        ),
        "DOCTYPE",
    ),
    "doctype_far_down": (
        lambda: b"<!--" + b"x" * 9_000_000 + b"-->\n<!DOCTYPE robot>\n<robot/>",
        "DOCTYPE",
    ),
    "nesting": (lambda: robot("<a>" * 50_000 + "</a>" * 50_000), "depth"),
    "nested_links": (lambda: robot("<link name='a'>" * 50_000), "depth"),
    "twenty_megabytes": (lambda: robot(link("a")) + b" " * 20_000_000, "16 MiB"),
    "elements": (lambda: robot("<a/>" * 4_000_000), "200000"),
    "attributes": (
        lambda: b"<robot " + b" ".join(b'a%d=""' % i for i in range(190_000)) + b"/>",
        "100 attributes",
    ),
    "long_name": (lambda: robot(link("x" * 15_000_000)), "XML"),
    "long_text": (lambda: robot(link("a") + "x" * 15_000_000), "XML"),
    "long_number": (lambda: robot(link("a", inertial("1" * 9_000_000 + "x"))), "not a finite"),
    "many_numbers": (lambda: robot(link("a", inertial("1 " * 2_000_000))), "got 2000000"),
    "comments": (lambda: b"<!---->" * 190_000, "XML"),
    "open_comments": (lambda: b"<!--" * 190_000, "XML"),
    "instructions": (lambda: b"<?a?>" * 190_000 + b"<robot/>", "no links"),
    "same_links": (lambda: robot(link("a") * 90_000), "taken by"),
    "roots": (lambda: robot(*(link(f"l{i}") for i in range(90_000))), "90000 roots"),
    "prefixes": (lambda: robot("".join(f"<p{i}:a/>" for i in range(90_000))), "prefix"),
    "circle": (
        lambda: robot(
            *(link(f"l{i}") for i in range(10_000)),
            *(joint(f"j{i}", f"l{i}", f"l{(i + 1) % 10_000}", "fixed") for i in range(10_000)),
        ),
        "circle",
    ),
    "mimics": (
        lambda: robot(
            *(link(f"l{i}") for i in range(8_000)),
            *(joint(f"j{i}", f"l{i}", f"l{i + 1}", inner=mimic(f"j{i + 1}")) for i in range(7_998)),
            joint("j7998", "l7998", "l7999", inner=mimic("j0")),
        ),
        "circle",
    ),
    "hints": (
        lambda: robot(
            *(link("ab" * 30 + str(i)) for i in range(20_000)),
            *(joint(f"j{i}", "ba" * 30, "ba" * 30) for i in range(10)),
        ),
        "no parent link",
    ),
}


@pytest.mark.one_in(4)
@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are Linux's")
@pytest.mark.parametrize("bomb", BOMBS)
def test_bombs_are_refused_soon_and_in_little_memory(bomb: str, tmp_path: Path) -> None:
    make, says = BOMBS[bomb]
    path = tmp_path / "r.urdf"
    path.write_bytes(make())
    message = run(LIMITED, path)
    assert says in message
    assert len(message) < 1200


def test_nothing_but_the_file_is_opened(tmp_path: Path) -> None:
    (tmp_path / "secret.txt").write_text("canary")
    (tmp_path / "mesh.stl").write_text("canary")
    visual = '<visual><geometry><mesh filename="package://../secret.txt"/></geometry></visual>'
    include = (
        '<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="secret.txt" parse="text"/>'
    )
    style = '<?xml-stylesheet href="secret.txt"?><?include secret.txt?>'
    path = tmp_path / "r.urdf"
    path.write_bytes(robot(link("a", visual) + include + style))
    events = [line.split() for line in run(WATCHED, path).splitlines()]
    assert [(event[0], event[1]) for event in events] == [("open", str(path))]


@pytest.mark.parametrize("system", ["secret.txt", "file:///dev/stdin", "http://127.0.0.1:9/"])
def test_entities_open_nothing(tmp_path: Path, system: str) -> None:
    (tmp_path / "secret.txt").write_text("canary")
    path = tmp_path / "r.urdf"
    path.write_text(
        f'<!DOCTYPE r [<!ENTITY a SYSTEM "{system}">]><robot name="r"><link name="&a;"/></robot>'
    )
    *events, refusal = run(WATCHED, path).splitlines()
    assert [event.split()[:2] for event in events] == [["open", str(path)]]
    assert refusal.startswith("refused:")
    assert "canary" not in refusal


# ---------------------------------------------------------------- mutations

TOKENS = re.compile(r'"[^"]*"|[\w.:+-]+|\s+|.', re.DOTALL)
NASTY = [
    '""', '"0"', '"-1"', '"nan"', '"1e400"', '"0 0 0"', '"1 2 3"', '"a"', '"base"', '"elbow"', '"fixed"',
    '"planar"', '"mass_center"', '"ground"', '"root"', "<", ">", "/>", "<!--", "<![CDATA[", "&amp;", "&x;",
    "=", "<mimic", "<a:b/>", "<link/>", "\ufeff", "手", "\x00",
    '"1e-320"', '"1e49 -1e49 1e49"', "]]>", "<?x ?>",
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


def quotes_mutated(text: str, draw: random.Random) -> str:
    """Only what stands in quotes: most of these stay XML."""
    tokens = TOKENS.findall(text)
    places = [i for i, token in enumerate(tokens) if token.startswith('"')]
    for _ in range(draw.randint(1, 3)):
        i, j = draw.choice(places), draw.choice(places)
        other = draw.choice([token for token in NASTY if token.startswith('"')])
        tokens[i] = draw.choice((tokens[j], other))
    return "".join(tokens)


@pytest.mark.parametrize("seed", range(25))
@pytest.mark.parametrize("mutate", [mutated, quotes_mutated])
def test_mutations_give_a_model_or_an_error_with_a_place(
    mutate: Callable[[str, random.Random], str], seed: int
) -> None:
    draw = random.Random(seed)
    for _ in range(20):
        text = mutate(ZOO.decode(), draw).encode("utf-8", "surrogatepass")
        base, symbolic = draw.choice(("fixed", "floating")), draw.random() < 0.2
        try:
            found: Model | LinegraphError = parse(text, "r.urdf", base=base, symbolic=symbolic)
        except LinegraphError as error:
            found = error
        if isinstance(found, Model):
            assert problem(found) in ("", "singular", "not positive definite", "no joint can move")
        else:
            assert re.match(r"r\.urdf(:\d+)?: ", str(found))
            assert str(found).isprintable()


def problem(model: Model) -> str:
    """Why equations of motion do not exist, in a word."""
    try:
        derive(model)
    except LinegraphError as error:
        found = re.search("singular|not positive definite|no joint can move", str(error))
        return found.group() if found else str(error)
    return ""


def test_some_mutations_pass_and_some_do_not() -> None:
    """The mutations above are neither all harmless nor all fatal."""
    draw = random.Random(1)
    outcomes = []
    for _ in range(100):
        try:
            parse(quotes_mutated(ZOO.decode(), draw).encode(), "r.urdf")
            outcomes.append(True)
        except LinegraphError:
            outcomes.append(False)
    assert 5 < sum(outcomes) < 95

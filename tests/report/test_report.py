"""Reports: what stands in them holds, and every format carries it whole and escaped."""

from __future__ import annotations

import os
import random
import re
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from click.testing import CliRunner
from lxml import etree
from support import targets
from support.plain_formulas import Reader, entries

import linegraph as lg
from linegraph.cli.main import main
from linegraph.errors import LinegraphError
from linegraph.ir.dag import Dag
from linegraph.ir.program import leaves
from linegraph.notation.plain import Plain
from linegraph.notation.tree import Grid, Name, Sum
from linegraph.readers import modelfile, urdf
from linegraph.report import FORMATS, format_of, html, latex, markdown, report, text
from linegraph.report.contents import document
from linegraph.report.document import (
    Document,
    EquationRow,
    Formulas,
    IntermediateList,
    Matrix,
    Section,
    formulas,
)
from linegraph.report.graphs import MOST_WRITTEN
from linegraph.report.intermediates import ENTRIES, symbols_of
from linegraph.report.subject import Subject

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "examples"
TOML = sorted(path.stem for path in FOLDER.glob("*/*.toml"))
NAMES = [*TOML, "panda"]
WRITERS = {"text": text, "markdown": markdown, "latex": latex, "html": html}
LEVEL = "fast"


@cache
def derivation(name: str) -> lg.Derivation:
    folder = FOLDER / name
    if name == "panda":
        return lg.derive(urdf.read(str(folder / "panda.urdf")))
    return lg.derive(modelfile.read(str(folder / f"{name}.toml")))


@cache
def reported(name: str) -> Document:
    return document(derivation(name), LEVEL)


@cache
def written(name: str, format: str) -> str:
    return str(WRITERS[format].render(reported(name)))


def blocks(parts: Any) -> Iterator[Any]:
    for block in parts:
        yield block
        if isinstance(block, Section):
            yield from blocks(block.blocks)


# ---- all examples in all formats, each of them once


LOOPS = ("four_bar", "slider_crank", "andrews_squeezer", "stewart_platform", "bicycle")
WITH_REACTIONS = ("cart_pole", "furuta", "heavy_top", "panda")
COMPILED = ("four_bar", "panda")


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", NAMES)
def test_the_report_of(name: str, tmp_path: Path) -> None:
    """One test for each example: its document is made once, in whatever process."""
    every_example_has_a_report(name)
    html_is_whole_and_alone(name)
    latex_is_ascii_and_balanced(name)
    plain_lines_fit(name)
    printed_cutsets_and_circuits_are_those_of_the_topology(name)
    printed_mass_matrix_and_bias_are_those_of_the_derivation(name)
    if name in LOOPS:
        printed_constraints_are_those_of_the_derivation(name)
    if name in WITH_REACTIONS:
        printed_reactions_are_those_of_the_derivation(name)
    if name in COMPILED:
        compiled(written(name, "latex"), tmp_path)
    assert len(written(name, "html").encode()) < 2_000_000


def every_example_has_a_report(name: str) -> None:
    titles = [section.title for section in reported(name).sections]
    assert titles[:9] == [
        "Conventions",
        "The system",
        "Terminal graphs of the components",
        "The system graph",
        "The chosen tree",
        "Cutset and circuit equations",
        "Terminal equations",
        "Connecting equations",
        "The principle of orthogonality",
    ]
    assert titles[9] == "Equations of motion"
    for format in FORMATS:
        assert len(written(name, format)) > 5000


ARITY = {"msub": 2, "msup": 2, "mfrac": 2, "mover": 2, "munder": 2}


def html_is_whole_and_alone(name: str) -> None:
    page = written(name, "html")
    tree = etree.fromstring(page.encode())
    tags = [str(e.tag).rpartition("}")[2] for e in tree.iter() if isinstance(e.tag, str)]
    assert "script" not in tags
    assert tags.count("math") > 20
    for e in tree.iter():
        tag = str(e.tag).rpartition("}")[2]
        if tag in ARITY:
            assert len(e) == ARITY[tag], etree.tostring(e)
        for key, value in e.attrib.items():
            assert key.rpartition("}")[2] not in ("src", "onload", "onclick")
            if key.rpartition("}")[2] == "href":
                assert value.startswith("#")
    addresses = set(re.findall(r"https?://[^\"' <]+", page))
    assert addresses <= {"http://www.w3.org/1999/xhtml", "http://www.w3.org/2000/svg"}
    assert "@import" not in page
    assert not re.findall(r"url\((?!#)", page)
    targets = {e.attrib["id"] for e in tree.iter() if "id" in e.attrib}
    links = {e.attrib["href"][1:] for e in tree.iter() if "href" in e.attrib}
    assert links <= targets


def latex_is_ascii_and_balanced(name: str) -> None:
    source = written(name, "latex")
    assert source.isascii()
    bare = re.sub(r"\\[{}]", "", source)
    assert bare.count("{") == bare.count("}")
    assert len(re.findall(r"\\begin\{", source)) == len(re.findall(r"\\end\{", source))


def compiled(source: str, folder: Path) -> None:
    (folder / "report.tex").write_text(source, encoding="utf-8")
    if shutil.which("pdflatex") is None:
        return
    command = [
        "pdflatex",
        "-interaction=nonstopmode",
        "-halt-on-error",
        "-no-shell-escape",
        "report.tex",
    ]
    done = subprocess.run(command, cwd=folder, capture_output=True, check=False)
    assert done.returncode == 0, done.stdout.decode(errors="replace")[-3000:]
    assert (folder / "report.pdf").stat().st_size > 10000


def plain_lines_fit(name: str) -> None:
    rows = [line for line in written(name, "text").splitlines() if line.startswith("    ")]
    assert sum(len(line) > 130 for line in rows) <= len(rows) // 10


# ---- what is printed holds


def values_of(
    d: lg.Derivation, q: list[float], v: list[float], more: dict[str, float]
) -> dict[str, float]:
    """The value of every symbol by its plain text."""
    subject = Subject(d)
    found = dict(zip(subject.q_names, q, strict=True)) | dict(zip(subject.v_names, v, strict=True))
    found |= more
    numeric = d.numeric()
    found |= {name: float(x) for name, x in numeric.parameters.items()}
    shown = {Plain()(subject.look.name(name)): x for name, x in found.items()} | {"t": 0.0}
    # long listings go by places
    for argument, letter in ENTRIES.items():
        look = symbols_of(subject, entries=True)
        for k, name in enumerate(subject_names(subject, argument)):
            if name in found and letter:
                shown.setdefault(Plain()(look(argument, k)), found[name])
    return shown


def subject_names(subject: Subject, argument: str) -> list[str]:
    return list(getattr(subject, f"{argument}_names"))


def state_of(d: lg.Derivation, seed: int = 1) -> tuple[list[float], list[float]]:
    draw = random.Random(seed)
    q = [draw.uniform(0.2, 0.9) for _ in d.structure.positions]
    d.structure.normalise(q)
    return q, [draw.uniform(-1, 1) for _ in d.structure.velocities]


def equations_in(section: Section) -> dict[str, Any]:
    """Every equation of a section by the plain text of its left side; matrices entry by entry."""
    found: dict[str, str] = {}
    for block in blocks(section.blocks):
        rows: tuple[EquationRow, ...] = block.rows if isinstance(block, Formulas) else ()
        for row in rows:
            left, right = Plain()(row.left), Plain()(row.right)
            if not isinstance(row.right, Grid):
                found[left] = right
                continue
            for i, line in enumerate(entries(right), 1):
                for j, entry in enumerate(line, 1):
                    name = Name(left, (str(i), str(j)) if len(line) > 1 else (str(i),))
                    found[Plain()(name)] = entry
    return found


def walked(section: Section, values: dict[str, float]) -> dict[str, float]:
    """The named intermediates of a section, computed in the order in which they are listed."""
    known = dict(values)
    for block in blocks(section.blocks):
        for group in block.groups if isinstance(block, IntermediateList) else ():
            for row in group.rows:
                name = Plain()(row.left)
                assert name not in values
                known[name] = Reader(known)(Plain()(row.right))
    return known


@pytest.mark.parametrize(
    "name", ["double_pendulum", "furuta", "four_bar", "cart_pole_motor", "crane", "heavy_top"]
)
def test_printed_motion_of_mass_centres_is_that_of_the_derivation(name: str) -> None:
    d = derivation(name)
    q, v = state_of(d)
    values = values_of(d, q, v, {})
    printed = equations_in(section_of(name, "Connecting equations"))
    scheme = scheme_of(d, q, v, [0.0] * len(v))
    seen = 0
    for body in d.system.bodies:
        frame = scheme.center(body)
        for start, part in (
            (f"r_{body}.mass_center", frame.origin),
            (f"v_{body}/inertia", frame.linear),
        ):
            whole = printed.get(start)
            if whole not in (None, "0"):
                shown = dict(zip("xyz", (e for (e,) in entries(whole)), strict=True))
            else:
                shown = {
                    axis: printed[key] for axis in "xyz" if (key := f"{start}_{axis}") in printed
                }
            if not shown and whole is None:
                continue  # too long
            seen += 1
            for axis, x in zip("xyz", part, strict=True):
                assert abs(Reader(values)(shown.get(axis, "0")) - float(x)) < 1e-12
    assert seen >= (1 if name == "heavy_top" else 2)


def section_of(name: str, title: str) -> Section:
    return next(s for s in reported(name).sections if s.title == title)


CLOSE = 2e-5
"""Numbers are printed with six digits."""


def compare(expected: list[float], prefix: str, known: Any, reader: Reader, scale: float) -> None:
    for k, x in enumerate(expected, 1):
        printed = known.get(Plain()(Name(prefix, (str(k),))))
        value = 0.0 if printed is None else reader(printed)
        assert abs(value - x) <= CLOSE * scale, (prefix, k, printed)


def printed_mass_matrix_and_bias_are_those_of_the_derivation(name: str) -> None:
    d = derivation(name)
    network = d.formulation.network
    if network is not None and network.loop:
        return  # its algebraic loop has no values here
    q, v = state_of(d)
    given = [0.0] * len(d.structure.inputs)
    more = dict.fromkeys(Subject(d).u_names, 0.0)
    numeric = d.numeric(u=given)
    values = values_of(d, q, v, more)
    section = section_of(name, "Equations of motion")
    known = walked(section, values)
    reader = Reader(known)
    printed = equations_in(section)
    M, h = numeric.mass_matrix(q, v), numeric.bias(q, v)
    size = max(1e-9, *(abs(x) for row in M for x in row))
    for i, row in enumerate(M):
        for j, x in enumerate(row):
            entry = printed.get(Plain()(Name("M", (str(i + 1), str(j + 1)))))
            if entry is None and len(M) == 1:
                entry = printed.get("M₁")
            if entry is None:
                entry = printed.get(Plain()(Name("M", (str(j + 1), str(i + 1)))))
            value = 0.0 if entry is None else reader(entry)
            assert abs(value - x) <= CLOSE * size, (i, j, entry)
    compare(h, "h", printed, reader, max(1.0, *(abs(x) for x in h)))


def printed_constraints_are_those_of_the_derivation(name: str) -> None:
    d = derivation(name)
    q, v = state_of(d)
    numeric = d.numeric()
    found: dict[str, str] = {}
    known = values_of(d, q, v, dict.fromkeys(Subject(d).u_names, 0.0))
    readers: dict[str, Reader] = {}
    for title in ("Equations of motion", "Constraints of the loops"):
        section = section_of(name, title)
        known = walked(section, known)
        # each section has intermediates of its own
        stated = equations_in(section)
        readers |= dict.fromkeys(stated, Reader(dict(known)))
        found |= stated

    def reader(entry: str) -> float:
        return next(readers[key] for key, text in found.items() if text == entry)(entry)

    J = numeric.constraint_jacobian(q)
    for i, row in enumerate(J):
        for j, x in enumerate(row):
            entry = found.get(Plain()(Name("J", (str(i + 1), str(j + 1)))))
            assert abs((0.0 if entry is None else reader(entry)) - x) <= CLOSE * 10, (i, j, entry)
    gamma = numeric.constraint_bias(q, v)
    compare(gamma, "γ", found, reader, max(1.0, *(abs(x) for x in gamma)))


def printed_reactions_are_those_of_the_derivation(name: str) -> None:
    d = derivation(name)
    q, v = state_of(d)
    draw = random.Random(3)
    a = [draw.uniform(-1, 1) for _ in v]
    subject = Subject(d)
    more = dict(zip(subject.a_names, a, strict=True)) | dict.fromkeys(subject.u_names, 0.0)
    section = section_of(name, "Reactions")
    values = values_of(d, q, v, more)
    reader = Reader(walked(section, values))
    printed = equations_in(section)
    scheme = scheme_of(d, q, v, a)
    for joint in d.system.joints:
        wrench = scheme.reaction(joint.name)
        for letter, part in (("f", wrench.force), ("τ", wrench.torque)):
            size = max(1.0, *(abs(float(x)) for x in part))
            for k, (axis, x) in enumerate(zip("xyz", part, strict=True), 1):
                entry = printed.get(f"{letter}_{joint.name}_{axis}")
                if entry is None:
                    entry = printed.get(f"{letter}_{joint.name}{'₁₂₃'[k - 1]}")
                if entry is None:
                    entry = printed.get(Plain()(Name(f"{letter}_{joint.name}", (str(k),))))
                value = 0.0 if entry is None else reader(entry)
                assert abs(value - float(x)) <= 10 * CLOSE * size, (joint.name, letter, axis, entry)


def scheme_of(d: lg.Derivation, q: list[float], v: list[float], a: list[float]) -> Any:
    from linegraph.dynamics.edge_variables import InverseScheme

    return InverseScheme(d.numeric().chords(q, v), a)


# ---- topological equations


def printed_cutsets_and_circuits_are_those_of_the_topology(name: str) -> None:
    d = derivation(name)
    section = section_of(name, "Cutset and circuit equations")
    topologies = []
    if d.system.bodies:
        topologies += [d.formulation.translation, d.formulation.rotation]
    if d.formulation.network is not None:
        topologies += list(d.formulation.network.topologies)
    inner = [b for b in section.blocks if isinstance(b, Section)]
    assert len(inner) == len(topologies)
    for part, topology in zip(inner, topologies, strict=True):
        printed = [b for b in part.blocks if isinstance(b, Formulas)]
        matrices = [m for m in (topology.cutset, topology.circuit) if m.rows]
        shown = [b for b in part.blocks if isinstance(b, Matrix)]
        if not printed:
            continue  # a large rotation refers to translation
        if len(topology.projection.edges) > MOST_WRITTEN and matrices:
            # the matrix, and one equation of each kind read off it
            assert [b.matrix for b in shown] == [topology.cutset]
            assert [len(b.rows) for b in printed] == [1, 1]
            rows = [(printed[0].rows[0], topology.cutset), (printed[1].rows[0], topology.circuit)]
            for row, matrix in rows:
                signs = [
                    -1 if n else 1 for n, _ in getattr(row.left, "terms", ((False, row.left),))
                ]
                assert signs in [[1, *(own[j] for j in sorted(own))] for own in matrix.entries]
            continue
        assert [len(b.rows) for b in printed] == [len(m.rows) for m in matrices]
        for block, matrix in zip(printed, matrices, strict=True):
            for row, own in zip(block.rows, matrix.entries, strict=True):
                terms = row.left.terms if isinstance(row.left, Sum) else ((False, row.left),)
                signs = [-1 if negative else 1 for negative, _ in terms]
                assert signs == [1, *(own[j] for j in sorted(own))]


def test_torques_about_ground_satisfy_the_printed_cutsets() -> None:
    """T = τ + r × f of each edge, summed over every vertex, is zero."""
    d = derivation("furuta")
    q, v = state_of(d)
    scheme = scheme_of(d, q, v, [0.7, -0.4])
    found = scheme.edges()
    projection = d.formulation.rotation.projection
    sums = {vertex: [0.0] * 6 for vertex in projection.vertices}
    for edge in projection.edges:
        through = found[edge.name].through
        head = scheme.terminal(edge.head).origin
        x, y, z = (float(c) for c in head)
        fx, fy, fz = (float(c) for c in through.force)
        moment = (y * fz - z * fy, z * fx - x * fz, x * fy - y * fx)
        total = [
            *(float(c) for c in through.force),
            *(float(t) + m for t, m in zip(through.torque, moment, strict=True)),
        ]
        for k, value in enumerate(total):
            sums[edge.tail][k] += value
            sums[edge.head][k] -= value
    assert max(abs(x) for row in sums.values() for x in row) < 1e-12


def test_what_a_model_was_made_from_stands_at_the_end() -> None:
    for name in ("panda", "furuta"):
        for format in FORMATS:
            text = written(name, format).replace("\\allowbreak{}", "").replace("\n", " ")
            place = text.index("Derived from a ")
            assert place > len(text) - 250
    assert reported("furuta").about.startswith("Furuta pendulum")


# ---- the same bytes


SCRIPT = """
import sys
from linegraph import derive
from linegraph.readers import modelfile
from linegraph.report import report
for path in sys.argv[1:]:
    d = derive(modelfile.read(path))
    for format in ("text", "markdown", "latex", "html"):
        sys.stdout.buffer.write(report(d, format, level="fast").encode())
"""


def test_reports_do_not_depend_on_hash_order() -> None:
    """Another process, with another seed, against this one."""
    names = ("furuta", "cart_pole_motor")
    environment = {**os.environ, "PYTHONHASHSEED": "1", "PYTHONPATH": str(ROOT)}
    paths = [str(FOLDER / name / f"{name}.toml") for name in names]
    command = [sys.executable, "-c", SCRIPT, *paths]
    done = subprocess.run(command, capture_output=True, check=True, env=environment)
    here = "".join(written(name, format) for name in names for format in FORMATS)
    assert done.stdout.decode() == here


# ---- hostile models

HOSTILE = (
    "<script>alert(1)</script>",
    r"\input{/etc/passwd}",
    "a$b%c_d^e&f#g~h{i}",
    "`x`|y| **z** [k](http://a.b)",
    "]]>--><!-- \u202eright\u202c",
    "umläut 半",
)


@pytest.mark.parametrize("name", [*HOSTILE, " ".join(HOSTILE)])
def test_no_text_of_a_model_is_markup(name: str, tmp_path: Path) -> None:
    model = lg.Model(name, about=f"{name} {name}\nsecond line") if takes_about() else lg.Model(name)
    model.parameter("m", 1.0, name, name)
    body = model.body(f"body {name}", mass="m", mass_center=(0, 0, 1))
    tip = body.frame(f"tip {name}", at=(0, 0, 2))
    model.revolute(f"joint {name}", between=("ground", body), axis=(0, 1, 0))
    model.damper(f"damper {name}", joint=f"joint {name}", damping=0.1)
    other = model.body("other", mass=2.0, mass_center=(0, 0, 1))
    model.prismatic("slide", between=(tip, other), axis=(1, 0, 0))
    model.resistor(f"r {name}", (f"v {name}", "ground"), resistance=1.0)
    model.capacitor(f"c {name}", (f"v {name}", "ground"), capacitance=1.0)
    d = lg.derive(model)
    pages = {format: report(d, format, level="fast") for format in FORMATS}
    page = pages["html"]
    tree = etree.fromstring(page.encode())
    assert "<script" not in page
    assert not [e for e in tree.iter() if str(e.tag).endswith("script")]
    for format in ("html", "latex", "text", "markdown"):
        assert "\u202e" not in pages[format]
    for line in pages["latex"].splitlines():
        assert r"\input" not in line or line.startswith(r"\usepackage")
    # what stands between backticks is shown as it is
    outside = re.sub(r"```text.*?```|(`+).+?\1", "", pages["markdown"], flags=re.S)
    assert "<script" not in outside
    fences = [line for line in pages["markdown"].splitlines() if line.startswith("```")]
    assert fences[::2] == [f for f in fences[::2] if f in ("```mermaid", "```text")]
    assert set(fences[1::2]) == {"```"}
    columns = [
        line.replace(r"\|", "") for line in pages["markdown"].splitlines() if line.startswith("| ")
    ]
    assert all(line.endswith(" |") for line in columns)
    if name not in HOSTILE:  # all of them together
        compiled(pages["latex"], tmp_path)


def takes_about() -> bool:
    import inspect

    return "about" in inspect.signature(lg.Model.__init__).parameters


# ---- the command


@pytest.mark.parametrize("format", FORMATS)
def test_the_command_writes_files(format: str, tmp_path: Path) -> None:
    target = tmp_path / f"pole{FORMATS[format]}"
    source = str(FOLDER / "cart_pole" / "cart_pole.toml")
    done = CliRunner().invoke(main, ["derive", source, "--output", str(target)])
    assert done.exit_code == 0, done.output
    assert done.output.strip() == str(target)
    printed = CliRunner().invoke(main, ["derive", source, "--format", format])
    assert printed.stdout == target.read_text(encoding="utf-8")


def test_the_command_says_what_is_wrong(tmp_path: Path) -> None:
    source = str(FOLDER / "cart_pole" / "cart_pole.toml")
    for output, words in (
        (str(tmp_path / "a.pdf"), "tells no format"),
        (str(tmp_path), "is a directory"),
        ("/proc/none/a.html", "cannot write"),
    ):
        done = CliRunner().invoke(main, ["derive", source, "--output", output])
        assert done.exit_code == 2
        assert words in done.output
        assert "Traceback" not in done.output
    folder = tmp_path / "dir.html"
    folder.mkdir()
    done = CliRunner().invoke(main, ["derive", source, "--output", str(folder)])
    assert done.exit_code == 2
    assert "is a directory" in done.output
    assert list(tmp_path.iterdir()) == [folder]


def test_folded_parameters_are_numbers() -> None:
    d = derivation("cart_pole")
    shown = report(d, "text", folded=True)
    start = shown.index("\nEquations of motion\n")
    assert "m_pole" not in shown[start : shown.index("Reactions", start)]


def test_formats_are_known() -> None:
    assert [format_of(f"a.B{ending}") for ending in FORMATS.values()] == list(FORMATS)
    with pytest.raises(LinegraphError, match="no format"):
        report(derivation("cart_pole"), "word")


def test_every_formula_of_a_report_is_written_alike() -> None:
    """No formula is lost on the way: each is found again in plain text."""
    page = re.sub(r"\s+", "", written("furuta", "text"))
    for tree in formulas(reported("furuta").sections):
        assert re.sub(r"\s+", "", Plain()(tree)) in page


def test_forces_that_share_parts_are_not_written_out() -> None:
    """Spread out, an effort of a few hundred operations has a million letters: it is counted first."""
    model = targets.everything()["loop5"]()
    model.formulation(independent=None, coordinates="absolute-angle")
    page = report(lg.derive(model), "text", level="none")
    assert "Q is listed with the functions" in " ".join(page.split())


def test_leaves_are_those_of_the_tree() -> None:
    """Doubled fifty times, two letters are 2^51; nothing is written to count them."""
    dag = Dag()
    x = dag.symbol("q", 0) + dag.symbol("q", 1)
    for _ in range(50):
        x = dag.multiply(x, x)
    assert leaves(x) == 2**51
    assert leaves(2 * dag.symbol("t")) == 2
    assert leaves(dag.symbol("t")) == leaves(3.5) == 1

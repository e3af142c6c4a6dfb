"""A language is named in one place: its package, its templates and one line make it one of all languages."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import codegen
import linegraph as lg

ROOT = Path(__file__).parents[2]

TOY = '''"""A toy: what each function takes and gives, one line each."""

from codegen import layout, templates
from codegen.algorithms import of
from codegen.language import Language


def render(module, options):
    functions = [
        (p.name, [a.name for a in p.arguments], [r.name for r in p.results]) for p in module.programs
    ]
    text = templates.fill("toy/module.toy.jinja", name=module.name, functions=functions)
    return {f"{module.name}.toy": text}


LANGUAGE = Language(render)
'''
TEMPLATE = """module {{ name }}
{% for function, given, found in functions %}
{{ function }}: {{ given | join(" ") }} -> {{ found | join(" ") }}
{% endfor %}
"""
MODEL = """name = "slide"
[body.box]
mass = 2
[prismatic.x]
between = ["ground", "box"]
axis = [1, 0, 0]
"""


@pytest.fixture(scope="module")
def toy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The code with one more language, made as CONTRIBUTING says."""
    folder = tmp_path_factory.mktemp("toy")
    for part in ("codegen", "templates"):
        shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "codegen" / "toy").mkdir()
    (folder / "codegen" / "toy" / "__init__.py").write_text(TOY)
    (folder / "templates" / "toy").mkdir()
    (folder / "templates" / "toy" / "module.toy.jinja").write_text(TEMPLATE)
    register = folder / "codegen" / "__init__.py"
    lines = register.read_text().splitlines(keepends=True)
    place = next(k for k, line in enumerate(lines) if line.startswith("_REGISTER")) + 1
    lines.insert(place, '    "toy": "codegen.toy",\n')
    register.write_text("".join(lines))
    (folder / "slide.toml").write_text(MODEL)
    return folder


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "linegraph", *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": f"{folder}{os.pathsep}{ROOT}"},
        capture_output=True,
        text=True,
        check=False,
    )


def test_one_line_makes_it_a_choice_of_the_command_line(toy: Path) -> None:
    done = run(toy, "emit", "slide.toml", "--out", "one", "--lang", "toy")
    assert done.returncode == 0, done.stderr
    assert [x.name for x in (toy / "one").iterdir()] == ["slide.toy"]
    assert "\nforward_dynamics: q v u -> a\n" in (toy / "one" / "slide.toy").read_text()
    refused = run(toy, "emit", "slide.toml", "--out", "two", "--lang", "cobol")
    assert refused.returncode == 2
    assert "'toy'" in refused.stderr


def test_it_is_written_with_all_others_and_without_golden_vectors(toy: Path) -> None:
    done = run(toy, "emit", "slide.toml", "--out", "all", "--tests")
    assert done.returncode == 0, done.stderr
    found = {x.name for x in (toy / "all").iterdir()}
    assert found == {
        *("slide.toy", "slide.h", "slide.c", "slide.py"),
        *("slide_test.c", "test_slide.py"),
    }


def test_options_of_c_are_not_its_own(toy: Path) -> None:
    done = run(toy, "emit", "slide.toml", "--out", "no", "--lang", "toy", "--batch")
    assert done.returncode == 2
    assert "options of C (batch): C is not written: add it to the languages" in done.stderr
    done = run(toy, "emit", "slide.toml", "--out", "library", "--arduino")
    assert done.returncode == 0, done.stderr
    assert not list((toy / "library").rglob("*.toy"))


def test_a_language_without_golden_vectors_says_so(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    known = {language: codegen._REGISTER[language] for language in ("c", "python")}
    text = codegen.Language(lambda module, options: {f"{module.name}.txt": "text\n"})
    made = {**known, "text": text}
    monkeypatch.setattr(codegen, "_REGISTER", made)
    monkeypatch.setattr(codegen, "LANGUAGES", tuple(made))
    model = lg.Model("p")
    model.prismatic("x", between=("ground", model.body("b", mass=1.0)), axis=(1, 0, 0))
    told: list[str] = []
    files = lg.emit(model, tmp_path, tests=True, progress=told.append)
    assert {file.name for file in files} == {"p.h", "p.c", "p.py", "p.txt", "p_test.c", "test_p.py"}
    assert "text has no golden vectors" in told

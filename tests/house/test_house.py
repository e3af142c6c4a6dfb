"""The code base: packages in order, sizes, forbidden calls, documentation, public names, costs of imports.

Each test lists all offenders at once. A new package, or a new module of the root, gets a line in
`rooms.ROOMS`.
"""

from __future__ import annotations

import ast
import doctest
import importlib
import io
import re
import subprocess
import sys
import tokenize
import types
from typing import TYPE_CHECKING

import pytest
from house import picture, rooms
from house.rooms import ROOT, all_imports, files, parsed, room

import linegraph

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

MOST_CODE_LINES = 60
MOST_FILE_LINES = 400
MOST_ROOT_MODULES = 14
MOST_PARAMETERS = 6

CODEGEN_SEES = {"codegen", "ir", "errors", "tolerance"}
CLOSED_FORMS = (
    "symbolic",
    "notation.printing",
    "algebra.sympy_scalars",
    "evaluation",
)
"""What is about sympy."""
HEAVY = {"sympy", "networkx", "numpy", "jinja2", "lxml", "matplotlib"}
ONLY_THERE = {
    "click": {"linegraph.cli.main", "linegraph.cli.options", "linegraph.cli.output"},
    "jinja2": {"codegen.templates"},
    "lxml": {"linegraph.readers.urdf.document"},
    "matplotlib": {"linegraph.drawing.png"},
    "codegen": {
        "linegraph.cli.options",
        "linegraph.emission.choices",
        "linegraph.emission.emit",
        "linegraph.evaluation",
        "linegraph.programs.frame_names",
    },
}
PRINTING = ("linegraph.cli.main", "linegraph.cli.output", "linegraph.__main__")
FORBIDDEN = {"eval", "exec", "compile", "__import__", "parse_expr", "lambdify", "popen"}
FORBIDDEN_MODULES = {"pickle", "marshal", "shelve", "subprocess", "ctypes", "code"}


# ---- packages


def test_every_package_has_its_place() -> None:
    assert len(rooms.ROOMS) == len(set(rooms.ROOMS))
    assert {room(name) for name in files()} - {"linegraph"} == set(rooms.ROOMS)


def test_imports_point_down() -> None:
    """All imports: those for types and those inside functions, too."""
    assert [f"{x.source} -> {x.target}" for x in rooms.upward()] == []


def test_no_file_imports_itself_in_the_end() -> None:
    assert rooms.circles() == []


def test_the_search_for_arrows_and_circles_finds_them(monkeypatch: pytest.MonkeyPatch) -> None:
    up = rooms.Import("linegraph.graph.forest", "linegraph.drawing.pictures", True, True)
    more = (*all_imports(), up)
    monkeypatch.setattr(rooms, "all_imports", lambda: more)
    assert rooms.upward() == [up]
    (circle,) = rooms.circles()
    assert {up.source, up.target} <= set(circle)


def test_the_root_is_small() -> None:
    assert rooms.counts()["modules in the root"] <= MOST_ROOT_MODULES


def test_no_two_modules_of_a_package_have_the_name_of_another_package() -> None:
    """A folder and a module of one name would hide each other."""
    folders = {n for n, path in files().items() if path.name == "__init__.py"}
    assert not folders & {n for n, path in files().items() if path.name != "__init__.py"}


def test_no_two_classes_have_one_name() -> None:
    places: dict[str, list[str]] = {}
    for module, path in files().items():
        for node in ast.walk(parsed(path)):
            if isinstance(node, ast.ClassDef):
                places.setdefault(node.name, []).append(module)
    assert {name: found for name, found in places.items() if len(found) > 1} == {}


def test_graphs_know_no_physics() -> None:
    seen = {room(x.target) for x in rooms.ours() if room(x.source) == "graph"}
    assert seen == {"graph", "errors", "display"}


def test_codegen_sees_programs_only() -> None:
    assert {room(x.target) for x in rooms.ours() if room(x.source) == "codegen"} <= CODEGEN_SEES


def test_joint_types_know_the_base_and_what_they_are_made_of() -> None:
    joints = "linegraph.components.joints"
    common = {f"{joints}.base", f"{joints}.composition", f"{joints}.look"}
    made_of = {
        f"{joints}.free": {f"{joints}.prismatic", f"{joints}.spherical"},
        f"{joints}.composition": {f"{joints}.revolute"},
    }
    folder = {name for name in files() if name.startswith(f"{joints}.")}
    for found in all_imports():
        if found.source in folder - {f"{joints}.compound"} and found.target in folder:
            assert found.target in common | made_of.get(found.source, set()), found


@pytest.mark.parametrize("package", ONLY_THERE)
def test_libraries_stay_where_they_are_wrapped(package: str) -> None:
    users = {
        found.source
        for found in all_imports()
        if found.target.split(".")[0] == package and not found.source.startswith(package)
    }
    assert users <= ONLY_THERE[package]


def test_heavy_libraries_are_imported_where_they_are_used() -> None:
    """At the top of a file only where the whole file is about them."""
    early = {
        (found.source, found.target.split(".")[0])
        for found in all_imports()
        if found.target.split(".")[0] in HEAVY and not found.lazy and not found.typing
    }
    about = tuple(f"linegraph.{name}" for name in CLOSED_FORMS)
    assert {x for x in early if not (x[1] == "sympy" and x[0].startswith(about))} <= {
        ("codegen.templates", "jinja2"),
        ("linegraph.readers.urdf.document", "lxml"),
    }


# ---- sizes


def functions(path: Path) -> Iterator[ast.FunctionDef]:
    for node in ast.walk(parsed(path)):
        if isinstance(node, ast.FunctionDef):
            yield node


def code_lines(path: Path) -> set[int]:
    """Lines that hold code: no blanks, no comments."""
    skip = {
        tokenize.COMMENT,
        tokenize.NL,
        tokenize.NEWLINE,
        tokenize.INDENT,
        tokenize.DEDENT,
        tokenize.ENDMARKER,
    }
    lines: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(path.read_text(encoding="utf-8")).readline):
        if token.type not in skip:
            lines.update(range(token.start[0], token.end[0] + 1))
    return lines


def size(function: ast.FunctionDef, lines: set[int]) -> int:
    """Code lines of a function, its docstring not counted."""
    own = set(range(function.lineno, int(function.end_lineno or 0) + 1)) & lines
    first = function.body[0]
    if ast.get_docstring(function) is not None:
        own -= set(range(first.lineno, int(first.end_lineno or 0) + 1))
    return len(own)


def test_functions_are_short() -> None:
    long = {}
    for name, path in files().items():
        lines = code_lines(path)
        for function in functions(path):
            if (count := size(function, lines)) > MOST_CODE_LINES:
                long[f"{name}.{function.name}"] = count
    assert long == {}


def parameters(function: ast.FunctionDef) -> int:
    """How many parameters a function has, `self` left out."""
    given = function.args
    every = [
        *given.posonlyargs,
        *given.args,
        *given.kwonlyargs,
        *filter(None, [given.vararg, given.kwarg]),
    ]
    return len([x for x in every if x.arg not in ("self", "cls")])


def test_functions_take_few_parameters() -> None:
    many = {
        f"{name}.{function.name}"
        for name, path in files().items()
        for function in functions(path)
        if parameters(function) > MOST_PARAMETERS
        and not of_click(function)
        # arrays are passed one by one there, since not all languages have records of them
        and not name.startswith("linegraph.ir.algorithms.")
    }
    assert many == set()


def of_click(function: ast.FunctionDef) -> bool:
    """Whether a function is a command: its parameters are the options of that."""
    return any("command" in ast.unparse(d) for d in function.decorator_list)


def test_files_are_short() -> None:
    counts = {
        name: len(path.read_text(encoding="utf-8").splitlines()) for name, path in files().items()
    }
    long = {name: n for name, n in counts.items() if n > MOST_FILE_LINES}
    assert long == {}


RULED = '''def f(x):
    """One.

    Two.
    """
    # three

    y = (
        x
    )
    return y
'''


def test_the_ruler_measures(tmp_path: Path) -> None:
    path = tmp_path / "ruled.py"
    path.write_text(RULED, encoding="utf-8")
    (function,) = functions(path)
    assert code_lines(path) == {1, 2, 3, 4, 5, 8, 9, 10, 11}
    assert size(function, code_lines(path)) == 5


# ---- calls


def called(call: ast.Call) -> str:
    function = call.func
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ""


def calls() -> Iterator[tuple[str, ast.Call]]:
    for name, path in files().items():
        for node in ast.walk(parsed(path)):
            if isinstance(node, ast.Call):
                yield f"{name}:{node.lineno}", node


def of_re(call: ast.Call) -> bool:
    """``re.compile`` compiles no code."""
    function = call.func
    return isinstance(function, ast.Attribute) and ast.unparse(function.value) == "re"


def of_os(call: ast.Call) -> bool:
    """``os.system``; `Model.system` is something else."""
    return ast.unparse(call.func) == "os.system"


def test_nothing_runs_text() -> None:
    found = [
        place
        for place, call in calls()
        if (called(call) in FORBIDDEN and not of_re(call))
        or any(word.arg == "shell" for word in call.keywords)
    ]
    assert found == []
    modules = {found.target.split(".")[0] for found in all_imports()}
    assert modules & FORBIDDEN_MODULES == set()


def test_sympify_takes_no_text() -> None:
    """`sympify` evaluates strings unless it is strict."""
    sympified = [(place, call) for place, call in calls() if called(call) in ("sympify", "S")]
    lax = [
        place
        for place, call in sympified
        if not any(word.arg == "strict" for word in call.keywords)
    ]
    assert sympified
    assert lax == []


def test_only_the_command_line_prints() -> None:
    found = [
        place
        for place, call in calls()
        if called(call) in ("print", "echo", "secho") and place.split(":")[0] not in PRINTING
    ]
    streams = [
        f"{name}:{node.lineno}"
        for name, path in files().items()
        for node in ast.walk(parsed(path))
        if isinstance(node, ast.Attribute)
        and node.attr in ("stdout", "stderr")
        and name not in PRINTING
    ]
    assert found + streams == []


def test_the_search_for_calls_finds_them() -> None:
    tree = ast.parse(
        "import os\nos.system('x')\nre.compile('x')\nfoo(shell=True)\nprint(eval('1'))"
    )
    found = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    assert {called(call) for call in found} == {"system", "compile", "foo", "print", "eval"}
    assert [called(call) for call in found if of_re(call)] == ["compile"]
    assert [called(call) for call in found if of_os(call)] == ["system"]


# ---- documentation


def undocumented(node: ast.AST, prefix: str) -> Iterator[str]:
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, ast.ClassDef | ast.FunctionDef) or child.name.startswith("_"):
            continue
        setter = any(ast.unparse(d).endswith(".setter") for d in child.decorator_list)
        if ast.get_docstring(child) is None and not setter:
            yield f"{prefix}.{child.name}"
        if isinstance(child, ast.ClassDef):
            yield from undocumented(child, f"{prefix}.{child.name}")


def test_all_that_is_public_has_a_docstring() -> None:
    missing = [name for name, path in files().items() if ast.get_docstring(parsed(path)) is None]
    for name, path in files().items():
        missing += undocumented(parsed(path), name)
    assert missing == []


def test_the_search_for_docstrings_finds_them() -> None:
    tree = ast.parse(
        "def f(): pass\nclass A:\n    'doc'\n    def g(self): pass\n    def _h(self): pass\n"
    )
    assert list(undocumented(tree, "m")) == ["m.f", "m.A.g"]


@pytest.mark.parametrize("module", [name for name in files() if not name.endswith("__main__")])
def test_examples_in_docstrings_hold(module: str) -> None:
    tests = doctest.DocTestFinder(exclude_empty=True).find(importlib.import_module(module))
    report = io.StringIO()
    runner = doctest.DocTestRunner(optionflags=doctest.FAIL_FAST)
    for test in tests:
        runner.run(test, out=report.write)
    assert runner.failures == 0, report.getvalue()


def test_enough_examples_are_found() -> None:
    finder = doctest.DocTestFinder(exclude_empty=True)
    examples = [
        example
        for name in files()
        if not name.endswith("__main__")
        for test in finder.find(importlib.import_module(name))
        for example in test.examples
    ]
    assert len(examples) > 30


# ---- the public face


def test_the_public_names_are_those_listed() -> None:
    assert linegraph.__all__ == sorted(linegraph.__all__)
    public = {name for name in dir(linegraph) if not name.startswith("_")}
    assert public | {"__version__"} == set(linegraph.__all__)
    assert all(not isinstance(getattr(linegraph, n), types.ModuleType) for n in linegraph.__all__)


def test_a_name_that_is_not_public_is_an_error() -> None:
    assert "has no attribute 'bogus'" in fresh(
        "import linegraph as lg\ntry: lg.bogus\nexcept AttributeError as e: print(e)"
    )


def test_nothing_is_imported_before_the_command_line_is_guarded() -> None:
    """What `python -m linegraph` loads of this project before its `main` runs."""
    script = (
        "import linegraph.__main__, sys; print(sorted(m for m in sys.modules if 'linegraph' in m))"
    )
    found = fresh(script)
    own = ["linegraph", "linegraph.__main__", "linegraph.exits", "linegraph.version"]
    assert found.strip() == str(own)


def fresh(script: str) -> str:
    """What a fresh interpreter prints."""
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


LOADED = f"; import sys; print([m for m in {sorted(HEAVY)} if m in sys.modules])"


def test_importing_linegraph_loads_nothing_heavy() -> None:
    assert fresh("import linegraph" + LOADED).strip() == "[]"


def test_asking_for_help_loads_nothing_heavy() -> None:
    script = "from linegraph.cli.main import main; main(['--help'], standalone_mode=False)"
    assert fresh(script + LOADED).strip().endswith("[]")
    script = "from linegraph.cli.main import main; main(['emit', '--help'], standalone_mode=False)"
    assert fresh(script + LOADED).strip().endswith("[]")


def test_deriving_from_python_loads_nothing_heavy() -> None:
    script = (
        "from linegraph import Model, derive; m = Model('m'); b = m.body('b', mass=1);"
        "m.prismatic('j', between=('ground', b)); derive(m).numeric().mass_matrix([0.1])"
    )
    assert fresh(script + LOADED).strip() == "[]"


def test_emitting_loads_templates_only() -> None:
    script = (
        "from linegraph import Model; from linegraph.emission.emit import render; m = Model('m');"
        "m.prismatic('j', between=('ground', m.body('b', mass=1))); render(m)"
    )
    assert fresh(script + LOADED).strip() == "['jinja2']"


# ---- the guide for contributors


def walks() -> Iterator[tuple[str, str]]:
    """File and name of each step of the walks through the code."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    part = text.split("## Three walks")[1].split("## Adding things")[0]
    yield from re.findall(r"^\| `([\w/.]+)` \| (?:`(\w+)`)? ?\|", part, re.MULTILINE)


def test_the_walks_lead_somewhere() -> None:
    assert len(list(walks())) > 25
    for file, name in walks():
        text = (ROOT / file).read_text(encoding="utf-8")
        assert re.search(rf"^(?:def|class) {name}\b", text, re.MULTILINE) or not name, (file, name)


def test_the_guide_names_every_package() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    folders = {room(name) for name, path in files().items() if path.name == "__init__.py"}
    assert [name for name in sorted(folders - {"linegraph"}) if f"`{name}`" not in text] == []


def test_the_picture_is_that_of_the_imports() -> None:
    """Else run ``python tests/house/picture.py``."""
    assert picture.FILE.read_text(encoding="utf-8") == picture.svg_text(picture.scene())


def test_documents_name_files_that_exist() -> None:
    documents = [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("examples/**/*.md")]
    named = [
        (document.name, name)
        for document in documents
        for name in re.findall(
            r"`((?:linegraph|codegen|tests|templates|docs|examples)/[\w/.]+\.\w+)`",
            document.read_text(encoding="utf-8"),
        )
        if "NAME" not in name
    ]
    assert len(named) > 50
    assert [(document, name) for document, name in named if not (ROOT / name).exists()] == []


PUBLIC_PACKAGES = {"linegraph", "linegraph.drawing"}


def test_documents_and_examples_use_public_names_alone() -> None:
    places = [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")]
    places += [x for x in ROOT.glob("examples/**/*") if x.suffix in (".md", ".py", ".ipynb")]
    found = [
        (place.name, module, [name.strip() for name in names.split(",")])
        for place in places
        for module, names in re.findall(
            r"\bfrom (linegraph[\w.]*) import ([\w, ]+)", place.read_text(encoding="utf-8")
        )
    ]
    assert len(found) >= 4
    assert [x for x in found if x[1] not in PUBLIC_PACKAGES] == []
    used = {(module, name) for _, module, names in found for name in names}
    used |= {
        ("linegraph", name)
        for place in places
        for name in re.findall(r"\blg\.([A-Za-z_]+)", place.read_text(encoding="utf-8"))
    }
    assert len(used) > 10
    for module, name in sorted(used):
        assert name in importlib.import_module(module).__all__, name

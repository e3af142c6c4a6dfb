"""The house: layers, sizes, forbidden calls, documentation, the public face, and what imports cost.

Each test lists all offenders at once. A new module must be given its layer below.
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
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import pytest

import linegraph

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parent.parent
PACKAGES = ("linegraph", "codegen")

MOST_CODE_LINES = 60
MOST_FILE_LINES = 400
OVERSIZE: dict[str, str] = {}
"""Files and functions that are bigger, each with its reason."""

LAYERS: tuple[tuple[str, ...], ...] = (
    (
        "errors",
        "exits",
        "version",
        "vector",
        "vectors",
        "coupling",
        "outputs",
        "notation",
        "tolerance",
    ),
    ("domains", "files", "functions", "graph", "pivoting"),
    ("powers",),
    ("algebra", "expression", "formula", "jets"),
    ("roots",),
    ("differentiation", "residues", "traced"),
    ("antiderivative", "coriolis", "sympy_walk"),
    ("simplification",),
    ("letters", "tidy"),
    ("state_space",),
    ("parameters", "program", "rotation", "topology"),
    ("checks", "constants", "elements", "statuses"),
    ("body", "bounds", "choices", "sums"),
    ("components",),
    ("constraints", "joints", "network"),
    ("register", "terminals", "words"),
    ("assemblies",),
    ("model",),
    ("exchange", "planarity"),
    ("absolute", "formulation"),
    ("layout",),
    ("kinematics",),
    ("expansion", "factorization", "spins", "walk"),
    ("orthogonality", "working_frames"),
    ("articulated", "frames", "mass_matrix", "standard_parameters", "tangent", "tips"),
    ("composite_bias", "composite_slopes", "regressor", "rows", "twists"),
    ("closure", "momenta"),
    ("lengths", "potentials", "scope", "transfer"),
    ("loads", "search"),
    ("edges", "paper", "regularity", "united"),
    ("inverse_scheme", "paper_print", "assembly"),
    ("observation", "paper_inverse"),
    ("equation_list", "symbol_names"),
    ("small_motions",),
    ("at_state",),
    ("linear",),
    ("symbols",),
    ("base_parameters", "dynamic", "numeric", "parameter_relations"),
    ("parameter_search",),
    ("face", "tied_columns"),
    ("derive",),
    ("drawing", "network_programs"),
    ("closed_programs", "edge_programs", "interpretation", "modelfile", "urdf"),
    ("closed_remarks", "prologue", "reading", "shared"),
    ("kinematic_programs", "loop_slopes", "pivots"),
    ("operational_programs", "slopes"),
    ("closed_derivatives", "division", "parameter_programs"),
    ("derivative_programs",),
    ("programs",),
    ("codegen", "golden", "trees"),
    ("named_frames",),
    ("appearance", "evaluation"),
    ("checking", "cli_options", "cli_output", "emission", "report"),
    ("cli",),
    ("__main__",),
)
"""From the ground up; a package counts as one. Modules of one layer do not import each other."""

UPWARD = {
    # locking a joint moves a frame by the joint's motion
    ("assemblies", "kinematics"),
    # what one asks a derivation, the emitted code answers
    ("face", "evaluation"),
    # ... and a picture, how it stands
    ("face", "drawing"),
}
"""Imports upwards, inside functions. The list is to shrink.

What shows a stage stands above it: methods that notebooks call, `_repr_svg_` and the like, may import it."""

SHOWING = re.compile(r"_repr_[a-z]+_")

NO_PHYSICS = {"graph": {"errors"}, "topology": {"errors", "graph"}}
CODEGEN_SEES = {
    f"linegraph.{name}"
    for name in ("errors", "expression", "functions", "program", "statuses", "tolerance", "vectors")
}
CLOSED_FORMS = (
    "at_state",
    "dynamic",
    "equation_list",
    "evaluation",
    "letters",
    "linear",
    "notation.printing",
    "simplification",
    "simplification.exact",
    "simplification.factoring",
    "simplification.plain",
    "simplification.quotients",
    "simplification.spaces",
    "state_space",
    "symbols",
    "sympy_walk",
)
"""What is about sympy."""
HEAVY = {"sympy", "networkx", "numpy", "jinja2", "lxml", "matplotlib"}
ONLY_THERE = {
    "click": {"linegraph.cli", "linegraph.cli_options", "linegraph.cli_output"},
    "jinja2": {"codegen.templates"},
    "lxml": {"linegraph.urdf.document"},
    "matplotlib": {"linegraph.drawing.png"},
    "codegen": {
        "linegraph.emission",
        "linegraph.evaluation",
        "linegraph.named_frames",
        "linegraph.cli_options",
    },
}
PRINTING = ("linegraph.cli", "linegraph.cli_output", "linegraph.__main__")
FORBIDDEN = {"eval", "exec", "compile", "__import__", "parse_expr", "lambdify", "system", "popen"}
FORBIDDEN_MODULES = {"pickle", "marshal", "shelve", "subprocess", "ctypes", "code"}


class Import(NamedTuple):
    """Module `source` imports module `target`.

    `lazy` inside a function, `typing` for types only, `shows` inside a method that a notebook calls.
    """

    source: str
    target: str
    lazy: bool
    typing: bool
    shows: bool


@cache
def files() -> dict[str, Path]:
    """Every module's file by its dotted name."""
    found = {}
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            parts = path.relative_to(ROOT).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@cache
def parsed(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def imports(name: str, path: Path) -> Iterator[Import]:
    """All imports of a module, those in functions and under TYPE_CHECKING too."""

    def walk(node: ast.AST, lazy: bool, typing: bool, shows: bool) -> Iterator[Import]:
        if isinstance(node, ast.Import):
            yield from (Import(name, alias.name, lazy, typing, shows) for alias in node.names)
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{name}: a relative import"
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                target = whole if whole in files() else str(node.module)
                yield Import(name, target, lazy, typing, shows)
        lazy = lazy or isinstance(node, ast.FunctionDef)
        shows = shows or (isinstance(node, ast.FunctionDef) and bool(SHOWING.fullmatch(node.name)))
        typing = typing or (isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING")
        for child in ast.iter_child_nodes(node):
            yield from walk(child, lazy, typing, shows)

    yield from walk(parsed(path), False, False, False)


@cache
def all_imports() -> list[Import]:
    return [found for name, path in files().items() for found in imports(name, path)]


def unit(module: str) -> str:
    """The part of the house that a module is: ``linegraph.joints.free`` is joints."""
    first, *rest = module.split(".")
    return first if first == "codegen" or not rest else rest[0]


def inside() -> list[Import]:
    """Imports between parts of the house that happen at run time."""
    return [
        found
        for found in all_imports()
        if found.target.split(".")[0] in PACKAGES
        and not found.typing
        and found.source != "linegraph"
        and unit(found.source) != unit(found.target)
    ]


# ---- layers


def test_every_module_has_a_layer() -> None:
    listed = [name for layer in LAYERS for name in layer]
    assert len(listed) == len(set(listed))
    assert {unit(name) for name in files()} - {"linegraph"} == set(listed)


def test_imports_point_down() -> None:
    level = {name: k for k, layer in enumerate(LAYERS) for name in layer}
    upward = {
        (unit(found.source), unit(found.target))
        for found in inside()
        if level.get(unit(found.target), -1) >= level[unit(found.source)] and not found.shows
    }
    assert upward == UPWARD


def test_imports_upward_wait_for_their_function() -> None:
    assert all(
        found.lazy for found in inside() if (unit(found.source), unit(found.target)) in UPWARD
    )


@pytest.mark.parametrize("module", NO_PHYSICS)
def test_graphs_know_no_physics(module: str) -> None:
    seen = {
        found.target
        for found in all_imports()
        if found.source == f"linegraph.{module}" and not found.shows
    }
    ours = {unit(target) for target in seen if target.startswith("linegraph")}
    assert ours <= NO_PHYSICS[module]


def test_codegen_sees_programs_only() -> None:
    seen = {
        found.target
        for found in all_imports()
        if found.source.startswith("codegen") and found.target.startswith("linegraph")
    }
    assert seen <= CODEGEN_SEES


def test_joint_types_know_the_base_and_what_they_are_made_of() -> None:
    common = {"linegraph.joints.base", "linegraph.joints.composition"}
    made_of = {
        "linegraph.joints.free": {"linegraph.joints.prismatic", "linegraph.joints.spherical"},
        "linegraph.joints.composition": {"linegraph.joints.revolute"},
    }
    folder = {name for name in files() if name.startswith("linegraph.joints.")}
    for found in all_imports():
        if found.source in folder - {"linegraph.joints.compound"} and found.target in folder:
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
    assert early <= {
        *((f"linegraph.{name}", "sympy") for name in CLOSED_FORMS),
        ("codegen.templates", "jinja2"),
        ("linegraph.urdf.document", "lxml"),
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
    assert {k: n for k, n in long.items() if k not in OVERSIZE} == {}


def test_files_are_short() -> None:
    counts = {
        name: len(path.read_text(encoding="utf-8").splitlines()) for name, path in files().items()
    }
    long = {name: n for name, n in counts.items() if n > MOST_FILE_LINES}
    assert {name: n for name, n in long.items() if name not in OVERSIZE} == {}


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


def test_a_module_never_takes_the_place_of_the_function_of_its_name() -> None:
    """Whatever is imported first: loading `linegraph.derive` binds the module to that name."""
    whole = "; assert isinstance(linegraph.derive, types.FunctionType), linegraph.derive"
    for first in (
        "import linegraph",
        "import linegraph.derive",
        "from linegraph.derive import placed",
    ):
        assert fresh(f"import types; {first}; import linegraph{whole}; print('ok')") == "ok\n"
    assert fresh("import linegraph as lg; print(lg.modelfile.parse.__name__)") == "parse\n"
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
    script = "from linegraph.cli import main; main(['--help'], standalone_mode=False)"
    assert fresh(script + LOADED).strip().endswith("[]")
    script = "from linegraph.cli import main; main(['emit', '--help'], standalone_mode=False)"
    assert fresh(script + LOADED).strip().endswith("[]")


def test_deriving_from_python_loads_nothing_heavy() -> None:
    script = (
        "from linegraph import Model, derive; m = Model('m'); b = m.body('b', mass=1);"
        "m.prismatic('j', between=('ground', b)); derive(m).numeric().mass_matrix([0.1])"
    )
    assert fresh(script + LOADED).strip() == "[]"


def test_emitting_loads_templates_only() -> None:
    script = (
        "from linegraph import Model; from linegraph.emission import render; m = Model('m');"
        "m.prismatic('j', between=('ground', m.body('b', mass=1))); render(m)"
    )
    assert fresh(script + LOADED).strip() == "['jinja2']"

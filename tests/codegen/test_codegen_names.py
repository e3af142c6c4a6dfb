"""Names: what is refused and why, and identifiers made from any text; texts made plain."""

from __future__ import annotations

import keyword
import shutil
import subprocess
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from support import codegen_samples as samples
from support.codegen_samples import with_parameters
from support.compiled import Compiled

import codegen
from codegen import naming, prose, reserved
from linegraph.errors import LinegraphError, NameRefused
from linegraph.ir.dag import Dag
from linegraph.ir.program import Argument, Quantity, Result, assemble

if TYPE_CHECKING:
    from pathlib import Path


REFUSED = [
    *("int", "double", "restrict", "_Bool", "inline", "bool", "nullptr", "typeof"),
    *("class", "template", "new", "this", "and", "xor", "constexpr", "co_await", "export"),
    *("lambda", "None", "def", "yield", "async", "global", "pass", "is", "True"),
    *("_X", "_x", "__x", "x__y", "__init__", "_"),
    *("NAN", "INFINITY", "HUGE_VAL", "M_PI", "M_SQRT1_2", "isnan", "signbit", "FP_ZERO", "NULL"),
    *("linux", "unix", "i386", "math_errhandling", "DOMAIN", "OVERFLOW", "FP_FAST_FMA"),
    *("", " ", "a b", "1a", "a-b", "a.b", "a\n", "a\x00", "a;", "a*/", "a\\", "ä", "раss", "ª"),
    *("𝐪", "a\u200b", "²", "x" * 129, "x" * 100_000, "a=1", "a)", "self", "replace"),
    *("PLAIN_NQ", "PLAIN_NV", "PLAIN_NU", "PLAIN_H"),
    *(text for text in samples.HOSTILE if text != "noqa"),
]


@pytest.mark.parametrize("name", REFUSED, ids=range(len(REFUSED)))
def test_such_parameters_are_refused(name: str) -> None:
    for language in codegen.LANGUAGES:
        with pytest.raises(NameRefused, match=r"parameter .* cannot be used") as refusal:
            codegen.render(with_parameters(name), language)
        message = str(refusal.value)
        assert message.isascii()
        assert message.isprintable()
        assert len(message) < 600


@pytest.mark.parametrize(
    "name",
    ["int", "class", "_x", "a__b", "a_", "", "a b", "x" * 200, "numpy", "math", "stdio", "é"],
)
def test_such_models_are_refused(name: str) -> None:
    with pytest.raises(NameRefused, match=r"model .* cannot be used in emitted code: .* would do"):
        codegen.render(replace(samples.constant(), name=name), "c")


@pytest.mark.parametrize(
    "name", ["y0", "j1", "gamma", "I", "l", "m_1", "lambda_", "Mass2", "x" * 128]
)
def test_such_parameters_are_accepted(name: str, tmp_path: Path) -> None:
    Compiled(codegen.render(with_parameters(name), "c"), "plain", tmp_path)


def test_twice_the_same_name_is_refused() -> None:
    with pytest.raises(NameRefused, match=r"parameter 'm' .* it is there twice"):
        codegen.render(with_parameters("m", "M", "m"), "c")
    module = samples.constant()
    twice = replace(module, programs=(*module.programs, module.programs[0]))
    with pytest.raises(NameRefused, match=r"function 'mass_matrix' .* it is there twice"):
        codegen.render(twice, "c")


@pytest.mark.parametrize(
    "name", ["sin", "y0", "t0", "NQ", "parameters", "status", "int", "Parameters"]
)
def test_functions_arguments_and_results_keep_off_what_the_files_use(name: str) -> None:
    dag = Dag()
    q = Argument("q", 1, "")
    made = assemble("f", "", (q,), (Result("y", (1,), (dag.symbol("q", 0),), ""),))
    for wrong in (
        replace(made, name=name),
        replace(made, arguments=(q, Argument(name, 1, ""))),
        replace(made, results=(replace(made.results[0], name=name),)),
    ):
        with pytest.raises(NameRefused):
            codegen.render(samples.single(wrong, size=1), "python")
    same = replace(made, results=(replace(made.results[0], name="q"),))
    with pytest.raises(NameRefused, match="it is there twice"):
        codegen.render(samples.single(same, size=1), "python")


def test_coordinates_may_have_any_name_but_not_any_length() -> None:
    long = (Quantity("x" * 1001, "", ""),) * 2
    with pytest.raises(NameRefused, match="it has 1001 characters, more than 1000"):
        codegen.render(replace(samples.constant(), positions=long), "c")


def test_no_macro_of_any_compiler_is_accepted() -> None:
    macros: set[str] = set()
    for command in (
        ["gcc", "-std=gnu99"],
        ["gcc", "-std=gnu2x", "-D_GNU_SOURCE"],
        ["g++", "-x", "c++"],
        ["clang", "-std=gnu99", "-D_GNU_SOURCE"],
    ):
        if shutil.which(command[0]) is None:
            continue
        done = subprocess.run(
            [*command, "-dM", "-E", "-include", "math.h", "-"],
            input="",
            capture_output=True,
            text=True,
            check=True,
        )
        macros |= {line.split()[1].split("(")[0] for line in done.stdout.splitlines()}
    assert len(macros) > 300
    for name in macros:
        with pytest.raises(NameRefused):
            naming.validate(with_parameters(name))


def test_all_keywords_of_this_python_are_known() -> None:
    assert set(keyword.kwlist) <= reserved.KEYWORDS


TEXTS = [
    *samples.HOSTILE,
    *REFUSED,
    *reserved.KEYWORDS,
    *reserved.FILES,
    *reserved.MACROS,
    *("a_", "_a", "a__b", "7", "7dof", "int_", "FP_X", "M_PI", "WX", "lambda_", "é", "x" * 500),
]


def test_identifiers_can_always_be_emitted() -> None:
    for text in TEXTS:
        name = naming.identifier(text)
        assert naming.identifier(name) == name
        naming.validate(replace(with_parameters(name), name="other"))
        naming.validate(replace(samples.constant(), name=name))


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("panda_arm", "panda_arm"),
        ("iiwa14", "iiwa14"),
        ("R2D2", "R2D2"),
        ("my robot (v2.1)", "my_robot_v2_1"),
        ("2-link", "x_2_link"),
        ("class", "x_class"),
        ("lambda_", "x_lambda"),
        ("numpy", "x_numpy"),
        ("", "x"),
        ("—", "x"),
        ("__init__", "init"),
    ],
)
def test_identifiers_stay_close_to_the_text(text: str, name: str) -> None:
    assert naming.identifier(text) == name


def test_identifiers_of_many_texts_tell_collisions() -> None:
    assert naming.identifiers(["a b", "c"], "joint") == ("a_b", "c")
    with pytest.raises(NameRefused, match=r"joint 'a b' and joint 'a\.b': both become a_b"):
        naming.identifiers(["a b", "c", "a.b"], "joint")


def test_refusals_are_errors_of_the_user() -> None:
    assert issubclass(NameRefused, LinegraphError)


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        ("M v̇ + h = Q", "M vdot + h = Q"),
        ("q̈, ẋ, ż", "qddot, xdot, zdot"),
        ("kg m² · 90° ± 1 µm", "kg m^2 * 90deg +- 1 um"),
        ("für Żółw", "fur Zo<U+0142>w"),
        ("a\n  b\tc\u2028d", "a b c<U+2028>d"),
        ("\x00\x1b", "<U+0000><U+001B>"),
        ("\u202eevil", "<U+202E>evil"),
    ],
)
def test_texts_become_plain(text: str, plain: str) -> None:
    assert prose.plain(text) == plain


@pytest.mark.parametrize("text", samples.HOSTILE)
def test_plain_texts_are_one_printable_line(text: str) -> None:
    plain = prose.plain(text)
    assert plain.isascii()
    assert plain.isprintable()
    assert prose.plain(plain) == plain
    assert all(len(line) <= prose.WIDTH for line in prose.paragraph(text))


def test_tables_keep_columns_and_wrap_long_texts() -> None:
    quantities = (
        Quantity("a", "rad", "short", 1.5),
        Quantity("longer", "m", "a long text " * 12, 10),
        Quantity("n" * 40, "", ""),
    )
    lines = prose.table(quantities)
    assert lines[0] == f"  0  {'a':24}  1.5   rad  short"
    assert lines[1].startswith(f"  1  {'longer':24}  10.0  m    a long text")
    assert lines[-1].strip() == f"2  {'n' * 40}"
    assert all(len(line) <= prose.WIDTH for line in lines)
    assert prose.table(()) == []

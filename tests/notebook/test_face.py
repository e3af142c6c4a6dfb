"""What a notebook sees: reprs, pictures, equations line by line, functions, files of every kind."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
import sympy
from sympy import cos, sin

import linegraph as lg
from linegraph.emission.emit import module_for
from linegraph.symbolic.simplification.plain import quotient

EXAMPLES = Path(__file__).parents[2] / "examples"


@cache
def furuta() -> lg.Derivation:
    return lg.derive(lg.read(EXAMPLES / "furuta" / "furuta.toml"))


@cache
def four_bar() -> lg.Derivation:
    return lg.derive(lg.read(EXAMPLES / "four_bar" / "four_bar.toml"))


def shown() -> list[Any]:
    d = furuta()
    module = module_for(d.system, "furuta")
    stages = [
        d.system,
        d.graph,
        d.graph["translation"],
        d.topology,
        d.topology.cutset,
        d,
        d.symbolic,
    ]
    return [*stages, d.linearise(), module, module.programs[0], d.function("bias"), d.sketch()]


@pytest.mark.parametrize("thing", shown(), ids=lambda thing: type(thing).__name__)
def test_reprs_are_short_and_name_what_they_are_of(thing: Any) -> None:
    text = repr(thing)
    assert len(text) < 400
    assert "\n" not in text
    assert " object at 0x" not in text


@pytest.mark.parametrize("thing", shown(), ids=lambda thing: type(thing).__name__)
def test_what_a_notebook_shows_is_well_formed(thing: Any) -> None:
    for form in ("_repr_svg_", "_repr_html_"):
        if hasattr(thing, form):
            ElementTree.fromstring(f"<div>{getattr(thing, form)()}</div>")
    if hasattr(thing, "_repr_latex_"):
        assert thing._repr_latex_().startswith("$")


def test_every_stage_can_be_looked_at() -> None:
    d = furuta()
    for stage in (d.graph, d.graph["rotation"], d.topology, d.sketch()):
        assert "<svg" in stage._repr_svg_()
    for stage in (d.system, d, d.topology.circuit):
        assert stage._repr_html_()
    assert r"\dot x" in d.linearise()._repr_latex_()
    assert d.equations()._repr_latex_().count("&=") == 2


def test_hostile_names_are_escaped() -> None:
    model = lg.Model("<script>alert(1)</script>")
    body = model.body("<b>", mass=1)
    model.prismatic("x", between=("ground", body), axis=(1, 0, 0))
    for thing in (model, lg.derive(model), lg.derive(model).topology.cutset):
        text = thing._repr_html_()
        assert "<script" not in text
        assert "<b>:" not in text
        ElementTree.fromstring(f"<div>{text}</div>")


def test_a_large_derivation_shows_no_equations_unasked() -> None:
    d = lg.derive(lg.read(EXAMPLES / "panda" / "panda.urdf"))
    assert "<math" not in d._repr_html_()
    assert "symbolic" not in vars(d)


def test_equations_are_the_matrices_row_by_row() -> None:
    d = furuta()
    for k, equation in enumerate(d.equations()):
        assert equation.lhs == (d.mass_matrix * d.a + d.bias)[k]
        assert equation.rhs == d.forces[k]


def test_equations_of_a_loop_have_multipliers_and_no_empty_rows() -> None:
    d = four_bar()
    found = d.equations()
    assert all((e.lhs, e.rhs) != (0, 0) for e in found)
    assert len(found) > len(d.v)
    assert set(d.multipliers) & set().union(*(e.rhs.free_symbols for e in found))


def test_parameters_by_name() -> None:
    p = furuta().p
    assert sympy.Symbol("L") * p.m == p.L * sympy.Symbol("m")


def test_a_file_is_read_whatever_its_kind(tmp_path: Path) -> None:
    assert lg.read(EXAMPLES / "panda" / "panda.urdf").name == "panda"
    plain = tmp_path / "robot"
    plain.write_bytes((EXAMPLES / "panda" / "panda.urdf").read_bytes())
    assert lg.read(plain).name == "panda"
    with pytest.raises(lg.LinegraphError, match="floating is for a URDF"):
        lg.read(EXAMPLES / "furuta" / "furuta.toml", base="floating")


def test_functions_take_one_state_many_and_parameters() -> None:
    d = furuta()
    q, v = np.array([[0.1, 0.2], [0.3, -0.4], [1, 2]]), np.array([[1.0, 2], [3, 4], [0, 1]])
    column, entry = d.function(d.bias), d.function(d.bias[0])
    whole = d.function("bias")(q, v)
    assert column(q, v).shape == (3, 2)
    assert entry(q, v).shape == (3,)
    np.testing.assert_allclose(column(q, v), whole, rtol=1e-14)
    np.testing.assert_allclose(entry(q, v), whole[:, 0], rtol=1e-14)
    np.testing.assert_allclose(column(q[0], v[0]), whole[0], rtol=1e-14)
    heavier = d.numeric({"m": 2.0}).bias(list(q[0]), list(v[0]))
    np.testing.assert_allclose(column(q[0], v[0], parameters={"m": 2.0}), heavier, rtol=1e-13)


@pytest.mark.parametrize(
    ("what", "message"),
    [("biass", 'did you mean "bias"'), (sympy.Symbol("foo") + 1, "foo")],
    ids=str,
)
def test_functions_that_are_not_there(what: Any, message: str) -> None:
    with pytest.raises(lg.ModelError, match=message):
        furuta().function(what)


def test_functions_say_what_they_take() -> None:
    with pytest.raises(lg.ModelError, match="takes q, v; got 1"):
        furuta().function("bias")([0, 0])
    with pytest.raises(lg.ModelError, match='"mm"'):
        furuta().function("bias")([0, 0], [0, 0], parameters={"mm": 1})


def test_a_level_that_is_not_there() -> None:
    with pytest.raises(lg.ModelError, match="none, fast, full"):
        furuta().closed_form("best")


def test_progress_is_told_with_a_bar() -> None:
    said: list[str] = []
    _ = furuta().closed_form(progress=said.append).mass_matrix
    assert said[0] == "simplifying mass matrix [....................] 0/4"
    assert said[-1].endswith("3/4")


def test_too_many_terms_are_refused_with_advice() -> None:
    with pytest.raises(lg.ModelError, match="too many terms for a closed form; ask for its func"):
        _ = furuta().closed_form(budget=10).bias


def test_any_expression_is_simplified() -> None:
    a, b, w = sympy.symbols("a b a_dot")
    assert lg.simplify(sin(a) * cos(b) + cos(a) * sin(b)) == sin(a + b)
    both = lg.simplify(sympy.Matrix([[w * cos(a) ** 2 + w * sin(a) ** 2, b]]), rates=[w])
    assert both == sympy.Matrix([[w, b]])
    assert lg.simplify(sympy.pi * sympy.Function("f")(a)) == sympy.pi * sympy.Function("f")(a)


def test_quotients_have_no_common_factors() -> None:
    m, l, g = sympy.symbols("m l g")  # noqa: E741
    found = quotient((-g * m * l + 0.5 * m) / (-m * l - m * g))
    assert sympy.simplify(found - (g * l - 0.5) / (l + g)) == 0
    assert m not in found.free_symbols
    assert quotient(sympy.Integer(3)) == 3

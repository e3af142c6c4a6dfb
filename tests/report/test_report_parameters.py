"""Parameters as numbers in reports: a name is a symbol, whatever it means elsewhere."""

from __future__ import annotations

from pathlib import Path

import pytest
import sympy

import linegraph as lg
from linegraph.readers.modelfile import parse
from linegraph.report import FORMATS, report

EXAMPLES = Path(__file__).parents[2] / "examples"
MODEL = """
name = "named"
[parameters]
E = { value = 3.0 }
S = { value = 2.0 }
m = { value = "2*E" }
[body.b]
mass = "m*S"
[prismatic.x]
between = ["ground", "b"]
axis = [1, 0, 0]
"""


def test_names_that_sympy_knows_are_parameters_all_the_same() -> None:
    derivation = lg.derive(parse(MODEL.encode(), "m.toml"))
    text = report(derivation, "text", folded=True)
    assert "M = (12)" in text
    assert "12\u00b7x\u2033" in text
    assert "M = (2\u00b7E\u00b7S)" in report(derivation, "text")


def test_dynamic_takes_no_text() -> None:
    derivation = lg.derive(parse(MODEL.encode(), "m.toml"))
    with pytest.raises(sympy.SympifyError):
        derivation.dynamic(["1+1"])


@pytest.mark.parametrize("name", ["magnetic_levitation", "moving_support_pendulum"])
def test_sympy_parses_no_text_of_a_file(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its parser runs what it reads; formulas of files go through our own."""

    def refuse(text: str, *_: object, **__: object) -> None:
        raise AssertionError(f"parsed by sympy: {text!r}")

    monkeypatch.setattr("sympy.parsing.sympy_parser.parse_expr", refuse)
    for model in (lg.read(EXAMPLES / name / f"{name}.toml"), parse(MODEL.encode(), "m.toml")):
        derivation = lg.derive(model)
        for folded in (False, True):
            for kind in FORMATS if model.source is None else ("html",):
                assert report(derivation, kind, folded=folded)
        assert derivation._repr_html_()
        assert derivation.equations()
        assert derivation.function("bias")
        assert derivation.function(derivation.mass_matrix)

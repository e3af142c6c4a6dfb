"""Parameters as numbers in reports: a name is a symbol, whatever it means elsewhere."""

from __future__ import annotations

import linegraph as lg
from linegraph.modelfile import parse
from linegraph.report import report

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
    import pytest
    import sympy

    derivation = lg.derive(parse(MODEL.encode(), "m.toml"))
    with pytest.raises(sympy.SympifyError):
        derivation.dynamic(["1+1"])

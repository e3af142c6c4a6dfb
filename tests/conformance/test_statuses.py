"""Statuses: what a function reports, under one name and number in C and Python, having written nothing."""

from __future__ import annotations

import re
import subprocess
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.compiled import Compiled, Failed
from support.emitted import load

from linegraph.emission.emit import render
from linegraph.ir.statuses import COMMON, NOT_FINITE, NOT_FINITE_INPUT, counted, singular_at
from linegraph.readers import modelfile, urdf

if TYPE_CHECKING:
    from collections.abc import Mapping

EXAMPLES = Path(__file__).parents[2] / "examples"
FOUR_BAR = EXAMPLES / "four_bar" / "four_bar.toml"


@cache
def four_bar() -> Mapping[str, str]:
    return render(modelfile.read(FOUR_BAR))


def both(files: Mapping[str, str], name: str, folder: Path) -> tuple[Compiled, Any]:
    return Compiled(files, name, folder), load(files, name, folder)


def test_what_is_not_a_number_is_never_ok_on_a_four_bar(tmp_path: Path) -> None:
    """`project` of a NaN, `complete` at a NaN rate, `forward_dynamics` under a NaN input."""
    library, python = both(four_bar(), "four_bar", tmp_path)
    nan, q, v = np.nan, [0.8, -0.2, 1.4], [0.0, 0.0, 0.0]
    for function, arguments, out in (
        ("project", ([nan, -0.2, 1.4], v), [(3,), (3,)]),
        ("complete", (q, [0.8], [nan]), [(3,), (3,)]),
        ("forward_dynamics", (q, v, [nan]), [(3,), (5,)]),
    ):
        with pytest.raises(Failed) as failed:
            library.call(function, None, *arguments, out=out)
        with pytest.raises(python.StatusError) as raised:
            getattr(python, function)(python.DEFAULT_PARAMETERS, *arguments)
        assert failed.value.status == raised.value.status == NOT_FINITE_INPUT.number
        assert raised.value.name == "NOT_FINITE_INPUT"


def test_parameters_are_arguments_too(tmp_path: Path) -> None:
    """A parameter that is not finite is an argument that is not, whether or not constants are prepared."""
    library, python = both(four_bar(), "four_bar", tmp_path)
    q, v, u = [0.8, -0.2, 1.4], [0.0, 0.0, 0.0], [0.0]
    names = [name for name in python.Parameters.__slots__ if not name.startswith("_")]
    values = library.default_parameters(len(names))
    for place, name in enumerate(names):
        changed = values.copy()
        changed[place] = np.inf
        with pytest.raises(Failed) as failed:
            library.call("forward_dynamics", changed, q, v, u, out=[(3,), (5,)])
        with pytest.raises(python.StatusError) as raised:
            python.forward_dynamics(python.Parameters(**{name: np.inf}), q, v, u)
        assert failed.value.status == raised.value.status == NOT_FINITE_INPUT.number


def test_rhs_writes_nothing_before_it_succeeds(tmp_path: Path) -> None:
    """Of a Panda: coordinate rates are known when forward dynamics fails, and are not written."""
    model = urdf.read(EXAMPLES / "panda" / "panda.urdf")
    files = render(model, name="panda", only=["rhs"], languages=["c"])
    library = Compiled(files, "panda", tmp_path)
    x = np.arange(16.0)
    x[1:6] = np.nan
    with pytest.raises(Failed, match="902"):  # which looks at the output, too
        library.call("rhs", x, np.zeros(8), out=[(16,)])


def law(force: str, folder: Path) -> tuple[Compiled, Any]:
    text = f"""
name = "pushed"
[body.b]
mass = 1
[prismatic.rail]
between = ["ground", "b"]
axis = [1, 0, 0]
effort = false
[law.l]
joint = "rail"
force = "{force}"
"""
    file = folder / "pushed.toml"
    file.write_text(text, encoding="ascii")
    return both(render(modelfile.read(file)), "pushed", folder)


@pytest.mark.parametrize(
    "force",
    [
        "max(sqrt(x), 0)",
        "max(0, sqrt(x))",
        "min(sqrt(x), 5)",
        "sign(sqrt(x))",
        "exp(-1000*x)",
        "1/(x + 1)",
        "log(x)",
    ],
)
def test_no_function_hides_what_is_not_a_number(force: str, tmp_path: Path) -> None:
    """At x = -1 none of these is a finite number."""
    library, python = law(force, tmp_path)
    with pytest.raises(Failed) as failed:
        library.call("forward_dynamics", [-1.0], [0.0], [], out=[(1,)])
    with pytest.raises(python.StatusError) as raised:
        python.forward_dynamics([-1.0], [0.0], [])
    assert failed.value.status == raised.value.status == NOT_FINITE.number
    assert np.isfinite(python.forward_dynamics([1.0], [0.0], [])).all()


def test_a_division_by_zero_that_does_not_matter_is_none_in_both_languages(tmp_path: Path) -> None:
    """atan(1/x) has a limit at 0, which C finds, as numbers divided by zero are infinite."""
    library, python = law("atan(1/x)", tmp_path)
    in_c = library.call("forward_dynamics", [0.0], [0.0], [], out=[(1,)])
    assert in_c == python.forward_dynamics([0.0], [0.0], []) == pytest.approx(-np.pi / 2)


def test_one_bad_state_of_many_raises(tmp_path: Path) -> None:
    python = load(four_bar(), "four_bar", tmp_path)
    p = python.DEFAULT_PARAMETERS
    q, v = python.complete(p, [0.8, 0.0, 1.2], [[0.8], [0.9]], [[1.0], [1.0]])
    assert python.forward_dynamics(p, q, v, [0.0])[0].shape == (2, 3)
    q[1, 2] = np.nan
    with pytest.raises(python.StatusError, match="infinite or not a number"):
        python.forward_dynamics(p, q, v, [0.0])


def test_floats_are_looked_at_too(tmp_path: Path) -> None:
    files = dict(render(modelfile.read(FOUR_BAR), languages=["c"], real="float"))
    files["main.c"] = """
#include <math.h>
#include "four_bar.h"
int main(void)
{
    const four_bar_parameters *const p = &four_bar_default_parameters;
    const float q[3] = {0.8F, -0.2F, 1.4F}, bad[3] = {0.8F, NAN, 1.4F};
    const float v[3] = {0.0F}, large[3] = {1e30F}, u[1] = {0.0F};
    float a[3], lam[5], q_on[3], v_on[3];
    int wrong = four_bar_project(p, bad, v, q_on, v_on) != FOUR_BAR_NOT_FINITE_INPUT;
    wrong += four_bar_project(p, q, v, q_on, v_on) != FOUR_BAR_OK;
    wrong += four_bar_forward_dynamics(p, q_on, large, u, a, lam) != FOUR_BAR_NOT_FINITE;
    return wrong;
}
"""
    for file, text in files.items():
        (tmp_path / file).write_text(text, encoding="ascii")
    command = ["gcc", "-std=c99", "-O1", "main.c", "four_bar.c", "-lm", "-o", "main"]
    subprocess.run(command, cwd=tmp_path, check=True)
    assert subprocess.run([str(tmp_path / "main")], check=False).returncode == 0


def test_a_complex_step_keeps_its_imaginary_part(tmp_path: Path) -> None:
    """Derivatives of bias and forward dynamics beside those that are emitted, and central differences."""
    model = urdf.read(EXAMPLES / "panda" / "panda.urdf")
    wanted = ["bias", "forward_dynamics", "forward_dynamics_derivatives"]
    python = load(render(model, name="panda", only=wanted, languages=["python"]), "panda", tmp_path)
    q, v, u = np.linspace(-0.5, 0.5, 8), np.linspace(0.3, -0.2, 8), np.full(8, 0.1)
    exact = python.forward_dynamics_derivatives(q, v, u)[0]
    h = 1e-30
    for k in range(8):
        beside = q + 1j * h * np.eye(8)[k]
        slope = python.forward_dynamics(beside, v, u).imag / h
        np.testing.assert_allclose(slope, exact[:, k], rtol=1e-11, atol=1e-11)
        step = 1e-6 * np.eye(8)[k]
        central = (python.bias(q + step, v) - python.bias(q - step, v)) / 2e-6
        np.testing.assert_allclose(python.bias(beside, v).imag / h, central, atol=1e-7)
    many = python.bias(q + 1j * h * np.eye(8), v)
    assert many.shape == (8, 8)
    assert many.dtype == complex


def test_complex_numbers_are_refused_where_parts_would_be_lost(tmp_path: Path) -> None:
    python = load(four_bar(), "four_bar", tmp_path)
    p = python.DEFAULT_PARAMETERS
    q = np.array([0.8 + 1e-30j, -0.2, 1.4])
    assert python.mass_matrix(p, q).dtype == complex
    with pytest.raises(TypeError, match="q is complex"):
        python.forward_dynamics(p, q, np.zeros(3), [0.0])
    with pytest.raises(TypeError, match="are real numbers"):
        p.replace(m1=1j) if hasattr(p, "m1") else python._number(1j)
    (tmp_path / "law").mkdir()
    _, bent = law("abs(x)", tmp_path / "law")
    with pytest.raises(TypeError, match="q is complex"):
        bent.bias([1e-30j], [0.0])


def test_single_precision_is_computed_in_doubles(tmp_path: Path) -> None:
    python = load(four_bar(), "four_bar", tmp_path)
    q = np.array([0.8, -0.2, 1.4], np.float32)
    found = python.mass_matrix(python.DEFAULT_PARAMETERS, q)
    assert found.dtype == float
    assert (found == python.mass_matrix(python.DEFAULT_PARAMETERS, q.astype(float))).all()


def test_the_page_lists_all_statuses_that_modules_have_in_common() -> None:
    page = (EXAMPLES.parent / "docs" / "embedding.md").read_text("utf-8")
    rows = re.findall(r"^\| (9\d\d) \| `(\w+)` \|", page, re.MULTILINE)
    assert [(int(number), name) for number, name in rows] == [(x.number, x.name) for x in COMMON]


def test_numbers_of_velocities_pass_over_those_of_all_modules() -> None:
    assert singular_at(0, "hinge")[::2] == (1, "SINGULAR_AT_hinge")
    assert [counted(k) for k in (897, 898, 899, 900)] == [898, 899, 1000, 1001]

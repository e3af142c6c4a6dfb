"""Emitted Python: shapes, errors, parameters, documentation, hostile texts."""

from __future__ import annotations

import ast
import copy
import inspect
import pickle
import subprocess
import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support import codegen_samples as samples
from support.emitted import load

import codegen
from codegen.python import module as python
from linegraph.ir.program import Quantity

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def arm(tmp_path: Path) -> Any:
    return load(codegen.render(samples.arm(), "python"), "arm", tmp_path)


@pytest.fixture
def plain(tmp_path: Path) -> Any:
    return load(codegen.render(samples.constant(), "python"), "plain", tmp_path)


def test_contents(arm: Any, plain: Any) -> None:
    assert (arm.NQ, arm.NV, arm.NU) == (2, 2, 2)
    assert arm.Q_NAMES == arm.V_NAMES == arm.U_NAMES == ("joint_0", "joint_1")
    assert plain.U_NAMES == ()
    assert not hasattr(plain, "Parameters")
    assert str(inspect.signature(arm.forward_dynamics)) == "(p, t, q, v, u)"
    assert "q: positions, shape (..., NQ)" in arm.mass_matrix.__doc__
    assert "M: the mass matrix, shape (..., NV, NV)" in arm.mass_matrix.__doc__
    assert "StatusError: 1: the mass matrix is singular;" in arm.forward_dynamics.__doc__
    assert "A double pendulum." in arm.__doc__


def test_only_numpy_is_imported() -> None:
    tree = ast.parse(codegen.render(samples.arm(), "python")["arm.py"])
    imports = [x for x in ast.walk(tree) if isinstance(x, ast.Import | ast.ImportFrom)]
    assert [ast.unparse(x) for x in imports] == ["import numpy as np"]


@pytest.mark.parametrize(
    ("q", "v", "t"),
    [
        ((), (), ()),
        ((5,), (), ()),
        ((), (5,), ()),
        ((5,), (5,), ()),
        ((3, 1), (5,), ()),
        ((3, 1), (1, 5), (3, 5)),
        ((), (), (4,)),
        ((0,), (), ()),
        ((1,), (), ()),
        ((2, 3), (), ()),
        ((2, 3), (4, 1, 1), ()),
    ],
)
def test_leading_axes_broadcast(arm: Any, q: Any, v: Any, t: Any) -> None:
    rng = np.random.default_rng(0)
    states = [rng.uniform(0.1, 1.0, (*lead, 2)) for lead in (q, v, v)]
    times = rng.uniform(0.1, 1.0, t)
    lead = np.broadcast_shapes(q, v, t)
    p = arm.DEFAULT_PARAMETERS
    M, h = arm.equations(p, times, *states[:2])
    a = arm.forward_dynamics(p, times, *states)
    E = arm.energy(p, *states[:2])
    assert M.shape == (*lead, 2, 2)
    assert h.shape == a.shape == (*lead, 2)
    assert E.shape == (*np.broadcast_shapes(q, v), 2)
    assert {x.dtype for x in (M, h, a, E)} == {np.dtype(float)}
    q_all, v_all, u_all = (np.broadcast_to(x, (*lead, 2)) for x in states)
    t_all = np.broadcast_to(times, lead)
    for place in np.ndindex(lead):
        state = (p, t_all[place], q_all[place], v_all[place])
        one = arm.equations(*state)
        np.testing.assert_allclose(M[place], one[0], rtol=1e-15)
        np.testing.assert_allclose(h[place], one[1], rtol=1e-14)
        np.testing.assert_allclose(a[place], arm.forward_dynamics(*state, u_all[place]), rtol=1e-13)


def test_constant_results_have_the_leading_shape(plain: Any) -> None:
    M, h = plain.equations(np.zeros((4, 3, 2)), [0.0, 0.0])
    assert M.shape == (4, 3, 2, 2)
    assert (M == [[2, 0], [0, 1 / 3]]).all()
    assert (h == 0).all()
    assert plain.driven(np.zeros((3, 2)), []).shape == (3, 2, 2)
    assert plain.driven(np.zeros(2), np.zeros((3, 0))).shape == (3, 2, 2)
    M[0, 0, 0, 0] = 5.0
    assert (plain.mass_matrix([0, 0]) == [[2, 0], [0, 1 / 3]]).all()


def test_lists_integers_and_single_precision_are_welcome(plain: Any) -> None:
    expected = plain.equations([1.0, 2.0], [0.0, 0.0])[1]
    for q in ([1, 2], (1, 2), np.array([1, 2], dtype=np.float32), np.array([1, 2])):
        assert (plain.equations(q, [0, 0])[1] == expected).all()


@pytest.mark.parametrize("q", [1.0, [1.0], [1.0, 2.0, 3.0], [[1.0], [2.0]], []])
def test_wrong_last_axis_names_the_argument(plain: Any, q: Any) -> None:
    with pytest.raises(ValueError, match=r"q must have shape \(\.\.\., 2\), not \("):
        plain.mass_matrix(q)
    with pytest.raises(ValueError, match=r"v must have shape \(\.\.\., 2\)"):
        plain.equations([0.0, 0.0], q)


def test_shapes_that_do_not_broadcast_are_refused(plain: Any) -> None:
    with pytest.raises(ValueError, match="broadcast"):
        plain.equations(np.zeros((3, 2)), np.zeros((4, 2)))


def test_inputs_are_left_alone(arm: Any) -> None:
    q = np.linspace(0, 1, 6).reshape(3, 2)
    before = q.copy()
    arm.mass_matrix(arm.DEFAULT_PARAMETERS, q)
    assert (q == before).all()


def test_failing_checks_raise(arm: Any) -> None:
    state = ([0.3, -1.2], [0.8, 0.5], [1.0, -2.0])
    for bad, name in (
        (arm.Parameters(m=0.0, I=0.0), "STATUS_1"),
        (arm.Parameters(m=-50.0), "STATUS_1"),
        (arm.Parameters(m=np.nan), "NOT_FINITE_INPUT"),
        (arm.Parameters(m=[1.0, 2.0, -50.0]), "STATUS_1"),
    ):
        with pytest.raises(np.linalg.LinAlgError) as caught:
            arm.forward_dynamics(bad, 0.0, *state)
        assert (caught.value.name, caught.value.status) == (name, arm.STATUSES[name][0])
        assert str(caught.value) == arm.STATUSES[name][1]
        again = pickle.loads(pickle.dumps(caught.value))
        assert (again.name, again.status, str(again)) == (name, *arm.STATUSES[name])


def test_parameters_are_a_frozen_record(arm: Any) -> None:
    p = arm.Parameters(m=2)
    assert (p.m, p.I) == (2.0, 0.1)
    assert repr(p) == "Parameters(m=2.0, I=0.1)"
    assert repr(p.replace(I=3)) == "Parameters(m=2.0, I=3.0)"
    assert repr(arm.DEFAULT_PARAMETERS) == "Parameters(m=1.5, I=0.1)"
    with pytest.raises(AttributeError, match=r"m cannot be set; replace\(m=\.\.\.\)"):
        p.m = 3.0
    with pytest.raises(AttributeError, match="cannot be deleted"):
        del p.m
    with pytest.raises(AttributeError):
        p.other = 1.0
    with pytest.raises(TypeError, match="unexpected keyword argument"):
        p.replace(other=1.0)
    for copied in (copy.copy(p), copy.deepcopy(p), pickle.loads(pickle.dumps(p))):
        assert repr(copied) == repr(p)
    with pytest.raises(TypeError, match="p must be Parameters, not list"):
        arm.mass_matrix([1.0, 2.0], [0.0, 0.0])


def test_parameters_broadcast_and_are_copied(arm: Any) -> None:
    masses = np.array([1.0, 2.0, 3.0])
    p = arm.Parameters(m=masses)
    expected = arm.mass_matrix(p, [0.1, 0.2])
    masses[:] = 7.0
    assert expected.shape == (3, 2, 2)
    assert (arm.mass_matrix(p, [0.1, 0.2]) == expected).all()
    for i, mass in enumerate((1.0, 2.0, 3.0)):
        one = arm.mass_matrix(arm.Parameters(m=mass), [0.1, 0.2])
        np.testing.assert_allclose(expected[i], one, rtol=1e-15)
    assert arm.mass_matrix(arm.Parameters(m=masses[:, None]), np.zeros((5, 2))).shape == (
        3,
        5,
        2,
        2,
    )
    with pytest.raises(ValueError, match="read-only"):
        p.m[0] = 1.0
    with pytest.raises(ValueError, match="broadcast"):
        arm.Parameters(m=[1.0, 2.0], I=[1.0, 2.0, 3.0])


def test_any_accepted_name_works_as_a_parameter(tmp_path: Path) -> None:
    words = (
        "q v u a t M object name value values np type float2 leads t0 parameters y0 gamma lambda_ I"
    )
    listed = tuple(Quantity(word, "", "", float(i)) for i, word in enumerate(words.split()))
    module = replace(samples.constant(), parameters=listed)
    emitted = load(codegen.render(module, "python"), "plain", tmp_path)
    assert [getattr(emitted.DEFAULT_PARAMETERS, x.name) for x in listed] == [
        x.value for x in listed
    ]


def test_single_states_are_computed_in_floats(arm: Any) -> None:
    seen = []
    sine = arm._sin

    def watched(x: Any) -> Any:
        seen.append(type(x))
        return sine(x)

    arm._sin = watched
    arm.equations(arm.DEFAULT_PARAMETERS, 0.0, [0.1, 0.2], [0.3, 0.4])
    assert set(seen) == {float}
    assert type(sine(1.0)) is float


def test_runs_with_warnings_as_errors(tmp_path: Path) -> None:
    for file, text in codegen.render(samples.hostile('\\d \\N \'" """'), "python").items():
        (tmp_path / file).write_text(text, encoding="ascii")
    script = "import arm; print(arm.mass_matrix(arm.DEFAULT_PARAMETERS, [1.0]))"
    command = [sys.executable, "-W", "error", "-c", script]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)


class Blank(ast.NodeTransformer):
    """Replaces every string by the same one."""

    def visit_Constant(self, node: ast.Constant) -> ast.Constant:
        return ast.Constant("") if isinstance(node.value, str) else node


def shape(text: str) -> str:
    return ast.dump(Blank().visit(ast.parse(text, type_comments=True)))


@pytest.mark.parametrize("text", samples.HOSTILE, ids=range(len(samples.HOSTILE)))
def test_hostile_text_never_becomes_code(text: str, tmp_path: Path) -> None:
    benign = codegen.render(samples.hostile("text"), "python")["arm.py"]
    files = codegen.render(samples.hostile(text), "python")
    assert files["arm.py"].isascii()
    assert files["arm.py"].replace("\n", "").isprintable()
    assert shape(files["arm.py"]) == shape(benign)
    emitted = load(files, "arm", tmp_path)
    assert emitted.Q_NAMES == emitted.V_NAMES == emitted.U_NAMES == (text,)
    assert emitted.mass_matrix(emitted.DEFAULT_PARAMETERS, [1.0]).shape == (1, 1)


@pytest.mark.parametrize("text", [*samples.HOSTILE, "plain", "it's", 'say "x"', "both ' and \""])
def test_literals_are_exact(text: str) -> None:
    literal = python.literal(text)
    assert ast.literal_eval(literal) == text
    assert literal.isascii()
    assert literal.isprintable()


def test_literals_prefer_double_quotes() -> None:
    assert python.literal("plain") == '"plain"'
    assert python.literal("it's") == '"it\'s"'
    assert python.literal('say "x"') == "'say \"x\"'"

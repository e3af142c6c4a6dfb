"""How formulas look: names, order, numbers, brackets, in LaTeX, MathML and plain text."""

from __future__ import annotations

import math
import random

import pytest
import sympy
from lxml import etree
from support.plain_formulas import Reader

import linegraph as lg
from linegraph.notation.expressions import number
from linegraph.notation.latex import Latex, escaped
from linegraph.notation.mathml import MathMl
from linegraph.notation.names import shaped
from linegraph.notation.notation import Notation
from linegraph.notation.plain import Plain
from linegraph.notation.tree import Numeral, Sum
from linegraph.notation.writing import pieces, visible

g, l, m, J_axial, theta, theta_dot, hinge, hinge_dot = sympy.symbols(  # noqa: E741
    "g l m J_axial theta theta_dot hinge hinge_dot"
)
LOOK = Notation()


def pendulum() -> lg.Derivation:
    model = lg.Model("pendulum")
    m1, c1 = model.parameter("m1", 2.0, "kg"), model.parameter("c1", 0.5, "m")
    gravity = model.parameter("g", 9.81, "m/s^2")
    model.gravity = (0, 0, -gravity)
    root = model.body("base", mass=m1, inertia=(1, 2, 3))
    model.free("root", between=("ground", root))
    bob = model.body("bob", mass=m1, mass_center=(0, 0, -c1))
    model.revolute("theta", between=(root, bob), axis=(0, 1, 0))
    return lg.derive(model)


def test_names() -> None:
    look = Notation(pendulum())
    names = (
        "m1",
        "theta",
        "theta_dot",
        "a_theta",
        "root_wx",
        "root_x",
        "a_root_wx",
        "u_theta",
        "root_qw",
    )
    assert [Plain()(look.name(x)) for x in names] == [
        *("m₁", "θ", "θ′", "θ″", "ω_root_x", "x_root", "ω_root_x′", "u_θ", "q_root_w"),
    ]
    assert [Latex()(look.name(x)) for x in names] == [
        "m_{1}",
        r"\theta",
        r"\dot{\theta}",
        r"\ddot{\theta}",
        r"\omega_{\mathrm{root},x}",
        r"x_{\mathrm{root}}",
        r"\dot{\omega}_{\mathrm{root},x}",
        r"u_{\theta}",
        r"q_{\mathrm{root},w}",
    ]


def chain() -> lg.Derivation:
    """A loop with joints named after axes, letters, numbered letters and in long words."""
    model = lg.Model("chain")
    near = model.ground
    joints = [("prismatic", "x"), ("revolute", "theta1"), ("revolute", "arm"), ("revolute", "panda_joint1"),
              ("cylindrical", "delta"), ("spherical", "psi")]  # fmt: skip
    for kind, name in joints:
        body = model.body(f"b_{name}", mass=1.0, inertia=(1, 1, 1))
        options = {} if kind == "spherical" else {"axis": (0, 0, 1)}
        getattr(model, kind)(name, between=(near, body), **options)
        near = body
    model.fixed("delta2", between=(near, "ground"))
    return lg.derive(model)


@pytest.mark.parametrize(
    ("name", "plain", "latex", "mathml"),
    [
        ("x", "x", "x", "<mi>x</mi>"),
        ("a_x", "x″", r"\ddot{x}", '<mover accent="true"><mi>x</mi><mo>¨</mo></mover>'),
        ("u_x", "u_x", "u_{x}", "<msub><mi>u</mi><mi>x</mi></msub>"),
        ("theta1_dot", "θ₁′", r"\dot{\theta}_{1}", '<msub><mover accent="true"><mi>θ</mi><mo>˙</mo>'
         "</mover><mn>1</mn></msub>"),
        ("u_theta1", "u_θ₁", r"u_{\theta_{1}}",
         "<msub><mi>u</mi><msub><mi>θ</mi><mn>1</mn></msub></msub>"),
        ("arm_dot", "arm′", r"\dot{\mathit{arm}}",
         '<mover accent="true"><mi class="w">arm</mi><mo>˙</mo></mover>'),
        ("panda_joint1", "q_panda_joint1", r"q_{\text{panda\_joint1}}",
         "<msub><mi>q</mi><mi>panda_joint1</mi></msub>"),
        ("a_panda_joint1", "q_panda_joint1″", r"\ddot{q}_{\text{panda\_joint1}}",
         '<msub><mover accent="true"><mi>q</mi><mo>¨</mo></mover><mi>panda_joint1</mi></msub>'),
        ("delta_angle", "φ_δ", r"\phi_{\delta}", "<msub><mi>φ</mi><mi>δ</mi></msub>"),
        ("u_delta_angle", "u_δ_angle", r"u_{\delta,\mathrm{angle}}",
         "<msub><mi>u</mi><mrow><mi>δ</mi><mo>,</mo><mi>angle</mi></mrow></msub>"),
        ("u_psi_wx", "u_ψ_wx", r"u_{\psi,\mathrm{wx}}",
         "<msub><mi>u</mi><mrow><mi>ψ</mi><mo>,</mo><mi>wx</mi></mrow></msub>"),
        ("psi_f1", "λ_ψ_f₁", r"\lambda_{\psi,f_{1}}",
         "<msub><mi>λ</mi><mrow><mi>ψ</mi><mo>,</mo><msub><mi>f</mi><mn>1</mn></msub></mrow></msub>"),
    ],
)  # fmt: skip
def test_names_in_all_writers(name: str, plain: str, latex: str, mathml: str) -> None:
    look = CHAIN.name(name)
    assert (Plain()(look), Latex()(look), MathMl()(look)) == (plain, latex, mathml)


def test_no_two_names_look_alike() -> None:
    for writer in (Plain(), Latex(), MathMl()):
        looks = [writer(name) for name in CHAIN.names.values()]
        assert len(looks) == len({*looks})
    # names chosen so that rules meet: each pair would print as one
    model = lg.Model("alike")
    for name in (
        "q_shoulder",
        "theta",
        "u_shoulder",
        "m1",
        "m_1",
        "k_theta1",
        "k_θ₁",
        "é1x",
        "e1x",
    ):
        model.parameter(name, 1.0)
    body = model.body("b", mass=1.0, inertia=(1, 1, 1))
    model.revolute("shoulder", between=("ground", body), axis=(0, 0, 1))
    names = Notation(lg.derive(model)).names
    for writer in (Plain(), Latex(), MathMl()):
        looks = [writer(name).replace("textit", "mathit") for name in names.values()]
        assert len(looks) == len({*looks})


CHAIN = Notation(chain())


def test_an_acceleration_is_one_only_where_there_is_a_coordinate() -> None:
    assert LOOK.text(sympy.Symbol("a_theta")) == "a_θ"
    assert Notation(pendulum()).text(sympy.Symbol("a_theta")) == "θ″"


def test_words_are_one_name() -> None:
    assert LOOK.latex(hinge_dot) == r"\dot{\mathit{hinge}}"
    assert LOOK.latex(J_axial) == r"J_{\mathrm{axial}}"
    assert '<mi class="w">hinge</mi>' in LOOK.mathml(hinge)


def test_names_that_look_alike_stay_apart() -> None:
    model = lg.Model("alike")
    for name in ("m1", "m_1"):
        model.parameter(name, 1.0, "kg")
    body = model.body("b", mass="m1 + m_1")
    model.prismatic("x", between=("ground", body))
    look = Notation(lg.derive(model))
    shown = {Plain()(look.name(name)) for name in ("m1", "m_1")}
    assert shown == {"m1", "m_1"}


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        (g * m * l * sympy.sin(theta), "m·g·l·sin(θ)"),
        (sympy.sin(theta) ** 2 * m, "m·sin²(θ)"),
        (theta_dot**2 * m * l * sympy.sin(theta), "m·l·sin(θ)·θ′²"),
        (J_axial + m * l**2, "J_axial + m·l²"),
        (-m * g + l, "l − m·g"),
        (-m * g - l, "−l − m·g"),
        (m * l**2 / 2, "(1/2)·m·l²"),
        (m / (l * g), "m/(g·l)"),
        (sympy.sqrt(l**2 + 1), "√(l² + 1)"),
        (m * (l + g) * sympy.cos(theta + hinge), "m·(l + g)·cos(θ + hinge)"),
        (sympy.Rational(-2, 3) * m, "−(2/3)·m"),
        (2.50 * m, "2.5·m"),
        (sympy.Float("1.23456789e-7") * m, "1.23457·10⁻⁷·m"),
        (sympy.Eq(m * l, g), "m·l = g"),
        (sympy.Abs(l) + 1, "abs(l) + 1"),
    ],
)
def test_order_and_brackets(expression: sympy.Expr, text: str) -> None:
    assert LOOK.text(expression).replace("g + l", "l + g") == text


def test_a_function_before_another_factor_has_brackets() -> None:
    assert LOOK.latex(sympy.sin(hinge) * hinge_dot).startswith(r"\sin(\mathit{hinge})")
    assert LOOK.latex(sympy.sin(theta) * sympy.cos(theta)) == r"\sin \theta\,\cos \theta"


def test_factored_forms_are_kept() -> None:
    kept = m * (l + 2 * (g + theta))
    assert LOOK.text(kept).count("(") == 1 or "2·" in LOOK.text(kept)
    assert LOOK.text(m * (l + g) * (l - g)) in ("m·(l + g)·(l − g)", "m·(g + l)·(l − g)")


def test_numbers() -> None:
    assert number(1 / 3) == Numeral("0.333333", True)
    assert number(0.25) == Numeral("0.25")
    assert number(-2) == Sum(((True, Numeral("2")),))
    assert Plain()(number(3e-5)) == "3·10⁻⁵"
    assert Latex()(number(1e12)) == "10^{12}"
    assert Latex()(number(2.5e-8)) == r"2.5 \cdot 10^{-8}"


def test_functions_of_time_get_dots() -> None:
    t = sympy.Symbol("t")
    angle = sympy.Function("theta")(t)
    assert LOOK.latex(sympy.Derivative(angle, t, 2) + angle) == r"\ddot{\theta} + \theta"


HOSTILE = (
    "<script>alert(1)</script>",
    r"\input{/etc/passwd}",
    "a$b%c_d^e&f#g~h{i}",
    "`x`|y|",
    "line\nbreak\r\ttab",
    "umläut ñ 半 \u202eright\u202c \u0000\u0001\u0007",
    "]]>--><!--",
    "$$x$$",
)


@pytest.mark.parametrize("text", HOSTILE)
def test_no_text_gets_out(text: str) -> None:
    symbol = sympy.Symbol(text)
    latex = LOOK.latex(symbol + symbol**2)
    assert "\n" not in latex
    commands = {"textless", "textgreater", "textbackslash", "textit", "textasciitilde", "textbar",
                "textasciicircum", "textasciigrave", "textquotesingle", "textquotedbl", "ensuremath",
                "cdot", "_", "%", "$", "&", "#", "{", "}", "text"}  # fmt: skip
    import re

    assert set(re.findall(r"\\([a-z]+|.)", latex)) <= commands
    assert latex.isascii()
    tree = etree.fromstring(LOOK.mathml(symbol + symbol**2))
    assert {e.tag for e in tree.iter()} <= {
        "math",
        "mi",
        "mo",
        "mn",
        "msup",
        "msub",
        "mrow",
        "mspace",
    }
    assert all(c.isprintable() for c in LOOK.text(symbol))


def test_escaping_leaves_nothing_active() -> None:
    assert escaped("%$&#_{}") == r"\%\$\&\#\_\{\}"
    assert visible("a\u202eb\nc") == "a<U+202E>b c"
    assert shaped("a b").letter == "a b"


def random_expression(draw: random.Random, depth: int) -> sympy.Expr:
    if depth == 0:
        return draw.choice(
            [g, l, m, theta, theta_dot, hinge, J_axial, sympy.Integer(draw.randint(1, 9))]
        )
    parts = [random_expression(draw, depth - 1) for _ in range(draw.randint(2, 3))]
    kind = draw.randrange(6)
    if kind < 2:
        return sympy.Add(*(draw.choice([1, -1]) * x for x in parts))
    if kind < 4:
        return sympy.Mul(*parts)
    if kind == 4:
        return draw.choice([sympy.sin, sympy.cos])(parts[0]) ** draw.randint(1, 3)
    return parts[0] / (parts[1] ** 2 + 3)


@pytest.mark.parametrize("seed", range(60))
def test_text_means_what_it_was_written_for(seed: int) -> None:
    draw = random.Random(seed)
    expression = random_expression(draw, 3)
    names = {s: draw.uniform(0.5, 1.5) for s in (g, l, m, theta, theta_dot, hinge, J_axial)}
    values = {LOOK.text(s): x for s, x in names.items()}
    expected = complex(expression.subs(names).evalf()).real
    assert math.isclose(Reader(values)(LOOK.text(expression)), expected, rel_tol=1e-9, abs_tol=1e-9)


@pytest.mark.parametrize("seed", range(20))
def test_all_writers_break_at_the_same_places(seed: int) -> None:
    tree = LOOK.tree(random_expression(random.Random(seed), 3))
    depths = [[d for d, _ in pieces(w.marked(tree))] for w in (Plain(), Latex(), MathMl())]
    assert depths[0] == depths[1] == depths[2]
    for _, piece in pieces(MathMl().marked(tree)):
        etree.fromstring(f"<math>{piece}</math>")


def test_notebooks_get_this_notation() -> None:
    from linegraph.notation.printing import FacePrinter

    printer = FacePrinter(LOOK)
    assert printer.doprint(m * hinge_dot) == r"m\,\dot{\mathit{hinge}}"
    assert printer.doprint(sympy.Matrix([[m, 0]])) == r"\begin{bmatrix} m & 0 \end{bmatrix}"
    integral = printer.doprint(sympy.Integral(m * hinge_dot, l))
    assert r"\int" in integral
    assert r"\dot{\mathit{hinge}}" in integral
    assert lg.init_printing.__module__ == "linegraph.notation"

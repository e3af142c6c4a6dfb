"""`linegraph graph` as a user meets it: files whole or not at all, one message for what is wrong."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner
from lxml import etree

from linegraph.cli.main import main

ROOT = Path(__file__).parents[2]
FOUR_BAR = str(ROOT / "examples" / "four_bar" / "four_bar.toml")
MOTOR = str(ROOT / "examples" / "cart_pole_motor" / "cart_pole_motor.toml")
FILTER = str(ROOT / "examples" / "cauer_filter" / "cauer_filter.toml")


def run(*arguments: str) -> tuple[int, str, str]:
    done = CliRunner().invoke(main, ["graph", *arguments])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    return done.exit_code, done.stdout, done.stderr


@pytest.mark.parametrize("ending", ["svg", "png", "dot", "SVG"])
def test_a_file_for_each_ending(ending: str, tmp_path: Path) -> None:
    if ending == "png":
        pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    path = tmp_path / f"out.{ending}"
    code, out, _ = run(FOUR_BAR, "-o", str(path))
    assert (code, out) == (0, f"{path}\n")
    start = {"svg": b"<svg ", "png": b"\x89PNG", "dot": b"digraph"}[ending.lower()]
    assert path.read_bytes().startswith(start)
    assert [*tmp_path.iterdir()] == [path]


def test_without_a_file_svg_goes_to_standard_output() -> None:
    code, out, err = run(FOUR_BAR)
    assert (code, err) == (0, "")
    assert etree.fromstring(out.encode()).get("role") == "img"


def test_graph_sketch_or_both() -> None:
    texts = {}
    for what in ("graph", "sketch", "both"):
        code, out, _ = run(FOUR_BAR, "--what", what)
        assert code == 0
        texts[what] = {node.text for node in etree.fromstring(out.encode()).iter("{*}text")}
    assert "mechanism" in texts["sketch"] & texts["both"] - texts["graph"]
    assert "translation and rotation" in texts["graph"] & texts["both"] - texts["sketch"]
    assert run(FOUR_BAR)[1] == run(FOUR_BAR, "--what", "graph")[1]


def test_subspaces() -> None:
    _, out, _ = run(MOTOR, "--subspace", "electrical", "--subspace", "translation")
    texts = {node.text for node in etree.fromstring(out.encode()).iter("{*}text")}
    assert {"electrical", "translation"} <= texts
    assert "rotation_1d" not in texts


def test_the_position_can_be_set() -> None:
    assert (
        run(FOUR_BAR, "--what", "sketch")[1]
        != run(FOUR_BAR, "--what", "sketch", "--set", "motor=2")[1]
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((FOUR_BAR, "-o", "OUT/x.pdf"), "the name must end in .svg, .png or .dot"),
        ((FOUR_BAR, "-o", "OUT/x"), "the name must end in .svg, .png or .dot"),
        ((FOUR_BAR, "-o", "OUT/.svg"), "the name must end in .svg, .png or .dot"),
        ((FILTER, "-o", "OUT/x.svg", "--what", "sketch"), "has no bodies"),
        ((FILTER, "-o", "OUT/x.svg", "--subspace", "nowhere"), 'subspace "nowhere": is not in'),
        ((FOUR_BAR, "-o", "OUT/x.svg", "--set", "motor=1"), "--what sketch or --what both"),
        ((FOUR_BAR, "-o", "OUT/x.dot", "--what", "both"), "holds the graph alone"),
        ((FOUR_BAR, "--what", "sketch", "--subspace", "rotation"), "--subspace is of the graph"),
        ((FOUR_BAR, "-o", "OUT/x.svg", "--what", "both", "--set", "q9=1"), 'coordinate "q9"'),
        ((FOUR_BAR, "-o", "OUT/x.svg", "--what", "both", "--set", "q9"), "is not a number"),
        (("nothing.toml", "-o", "OUT/x.svg"), "nothing.toml"),
    ],
)
def test_what_is_wrong_is_told_and_nothing_written(
    arguments: tuple[str, ...], message: str, tmp_path: Path
) -> None:
    code, out, err = run(*(a.replace("OUT", str(tmp_path)) for a in arguments))
    assert (code, out) == (2, "")
    assert message in err
    assert err.count("rror:") == 1
    assert [*tmp_path.iterdir()] == []


def test_a_place_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    code, out, err = run(FOUR_BAR, "-o", str(tmp_path / "file" / "x.svg"))
    assert (code, out) == (2, "")
    assert err.startswith("error: cannot write to ")


def test_a_file_there_is_replaced_whole(tmp_path: Path) -> None:
    path = tmp_path / "x.svg"
    path.write_text("old", encoding="utf-8")
    assert run(FOUR_BAR, "-o", str(path))[0] == 0
    assert path.read_text(encoding="utf-8") == run(FOUR_BAR)[1]


def test_png_without_matplotlib_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "matplotlib", None)
    code, out, err = run(FOUR_BAR, "-o", str(tmp_path / "x.png"))
    assert (code, out) == (2, "")
    assert 'pip install "linegraph-dynamics[plot]"' in err
    assert [*tmp_path.iterdir()] == []


def test_a_model_with_an_odd_name(tmp_path: Path) -> None:
    path = tmp_path / "a & b <c>.toml"
    shutil.copy(FOUR_BAR, path)
    code, out, _ = run(str(path))
    assert code == 0
    etree.fromstring(out.encode())

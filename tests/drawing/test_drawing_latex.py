"""Scenes in LaTeX: text is escaped, lines are operators of PDF, and it compiles."""

from __future__ import annotations

import re
import shutil
import subprocess
from typing import TYPE_CHECKING

import pytest
from support.drawn import example, picture

from linegraph.drawing.latex import PREAMBLE, decimal
from linegraph.drawing.latex import picture as written
from linegraph.drawing.mechanism import mechanism_scene
from linegraph.drawing.scene import Pen, Region, Scene, Stroke, Text, flat, line

if TYPE_CHECKING:
    from pathlib import Path

HOSTILE = (r"\input{/etc/passwd}", "%$&#_{}~^", "}}\\end{picture}", "Größe_θ_名前\u202e")
OPERATORS = re.compile(r"(?:(?:-?[\d.]+|\[[\d. ]*\]) )*(?:[mlcwdjfnBSh]|re|rg|RG|cm)(?: |$)")


def shapes(latex: str) -> list[str]:
    """What is handed to PDF."""
    return [line for line in latex.splitlines() if re.match(r"[-\d]", line)]


def test_every_item_is_written() -> None:
    scene = picture("four_bar")
    latex = written(scene, 400, 400)
    items = list(flat(scene.items))
    assert latex.count(r"\makebox") == sum(isinstance(item, Text) for item in items)
    assert len(shapes(latex)) == sum(not isinstance(item, Text) for item in items)
    for shape in shapes(latex):
        assert OPERATORS.sub("", shape) == ""


def test_lines_stand_where_the_scene_has_them() -> None:
    pen = Pen("#ff8000", 2, (3, 1))
    scene = Scene(100, 50, "", "", (line((10, 20), (30, 40), pen=pen),))
    latex = written(scene, 1000, 1000, 1)
    assert shapes(latex) == ["1 0.502 0 RG 2 w [3 1] 0 d 10 20 m 30 40 l S"]
    # y down, points of PDF for those of TeX
    assert (
        rf"\put(0,50){{\drawn{{1 j {decimal(72 / 72.27)} 0 0 {decimal(-72 / 72.27)} 0 0 cm" in latex
    )
    curve = Stroke((0, 0), (((1, 2), (3, 4), (5, 6)),), closed=True, fill="#000000")
    box = Region(0, 0, 8, 4, 2, Pen("#000000", 1))
    latex = written(Scene(9, 9, "", "", (curve, box)), 9, 9)
    assert shapes(latex)[0] == "0 0 0 rg 0 0 m 1 2 3 4 5 6 c h f"
    assert shapes(latex)[1].count(" c") == 4


def test_a_picture_fits_its_place() -> None:
    scene = picture("panda")
    for width, height in ((300, 3000), (3000, 300)):
        (unit,) = re.findall(r"unitlength\}\{([\d.]+)pt", written(scene, width, height))
        assert scene.width * float(unit) <= width + 1
        assert scene.height * float(unit) <= height + 1


@pytest.mark.parametrize("engine", ["pdflatex", "lualatex", "latex"])
def test_it_compiles_whatever_it_says(engine: str, tmp_path: Path) -> None:
    if shutil.which(engine) is None:
        pytest.skip(f"there is no {engine}")
    texts = tuple(Text(5, 12 * k, text, bold=k == 1) for k, text in enumerate(HOSTILE, 1))
    scenes = [Scene(200, 60, "", "", texts), mechanism_scene(example("furuta"))]
    source = "\n".join([
        r"\documentclass{article}\usepackage[T1]{fontenc}\usepackage{amsmath}\usepackage{color}",
        r"\usepackage{textcomp,lmodern}",
        PREAMBLE,
        r"\begin{document}",
        *(written(scene, 300, 300) for scene in scenes),
        r"\end{document}",
    ])  # fmt: skip
    assert r"\input" not in source
    (tmp_path / "a.tex").write_text(source, encoding="utf-8")
    command = [engine, "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "a.tex"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, check=False)
    assert done.returncode == 0, done.stdout.decode(errors="replace")[-2000:]

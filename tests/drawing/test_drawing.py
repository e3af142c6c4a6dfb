"""Pictures of the graph: nothing overlaps, all is named, branches are bold, the same bytes each time."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from lxml import etree
from support.drawn import FILES, covered, crossed, digests, example, outside, overlaps, picture

from linegraph import Model, ModelError, derive
from linegraph.drawing.dot import dot_text
from linegraph.drawing.letters import clean, width
from linegraph.drawing.looks import BRANCH_PEN, is_arm
from linegraph.drawing.pictures import (
    chosen_panels,
    graph_scene,
    graph_svg,
    projection_svg,
    system_svg,
    topologies,
    topology_svg,
    whole_scene,
)
from linegraph.drawing.png import png_bytes
from linegraph.drawing.scene import Stroke, Text, flat
from linegraph.drawing.svg import svg_text
from linegraph.graph.forest import choose_forest
from linegraph.graph.multigraph import Edge, unite

ROOT = Path(__file__).parents[2]
SVG = "{http://www.w3.org/2000/svg}"
HOSTILE = (
    "<script>alert(1)</script>",
    "a\"b'c",
    "&amp; & ]]>",
    "line\nbreak\ttab",
    "\\N\\G{|}$x_1$",
)
OTHERS = ("Größe_θ_名前", "x" * 300, "\u202eright\u0000\ud800", "0", "ground/arm")


def hostile() -> Model:
    """A chain of bodies with names that no file would let pass."""
    model = Model('the "<worst>" & name\n')
    before = model.ground
    for k, name in enumerate((*HOSTILE, *OTHERS)):
        body = model.body(name, mass=1, mass_center=(0, 0, -0.5), inertia=(1, 1, 1))
        model.revolute(f"{name}|{k}", between=(before, body), axis=(0, 1, 0))
        before = body.frame(f"tip {name}", at=(0, 0, -1))
    return model


@pytest.mark.parametrize("name", FILES)
def test_the_graph_of(name: str) -> None:
    """One test for each example: it is derived and drawn once, in whatever process."""
    labels_are_clear(name)
    no_edge_runs_through_a_label(name)
    every_name_is_there(name)
    branches_are_bold(name)
    svg_is_well_formed_and_alone(name)


# ---- nothing overlaps


def labels_are_clear(name: str) -> None:
    scene = picture(name)
    assert overlaps(scene) == []
    assert outside(scene) == []
    assert covered(scene) == []


def no_edge_runs_through_a_label(name: str) -> None:
    assert crossed(picture(name)) == set()


@pytest.mark.parametrize("name", ["four_bar", "panda", "cart_pole_motor", "ring_modulator"])
def test_graphs_without_a_tree_are_clear_too(name: str) -> None:
    text = system_svg(example(name).graph.projections)
    drawn = etree.fromstring(text.encode())
    assert not drawn.findall(f".//{SVG}g[@class='lg-branch']")
    names = {
        edge.name for projection in example(name).graph.projections for edge in projection.edges
    }
    assert names <= {
        group.findtext(f"{SVG}title").split(" (")[0] for group in drawn.iter(f"{SVG}g")
    }


def test_hostile_names_are_clear() -> None:
    scene = whole_scene(derive(hostile()))
    assert overlaps(scene) == []
    assert outside(scene) == []


@pytest.mark.parametrize("coordinates", ["absolute", "absolute-angle"])
def test_other_trees_are_clear(coordinates: str) -> None:
    from linegraph.model.system import variant

    scene = graph_scene(derive(variant(example("double_pendulum").system, coordinates=coordinates)))
    assert overlaps(scene) == []
    assert crossed(scene) == set()


# ---- everything is there


def every_name_is_there(name: str) -> None:
    derivation = example(name)
    parts = {(part.kind, part.name) for part in picture(name).parts()}
    named = {name for _, name in parts}
    for topology in topologies(derivation):
        assert {edge.name for edge in topology.projection.edges} <= named
        assert {*topology.projection.vertices} <= {n for kind, n in parts if kind == "vertex"}
    assert {*derivation.system.bodies} <= {n for kind, n in parts if kind == "body"}


def branches_are_bold(name: str) -> None:
    """Those of the topology and no others; rigid arms are drawn discreetly."""
    derivation = example(name)
    panels = chosen_panels(derivation)
    for names, topology in panels:
        scene = picture(name) if len(panels) == 1 else graph_scene(derivation, names)
        bold = {
            part.name
            for part in scene.parts()
            for item in part.items
            if isinstance(item, Stroke) and item.pen and item.pen.width == BRANCH_PEN.width
            if part.kind != "legend"
        }
        assert bold == {edge.name for edge in topology.branches if not is_arm(edge)}
        thin = {part.name for part in scene.parts() if part.kind == "chord"}
        assert thin == {edge.name for edge in topology.chords}


def test_arrows_point_from_tail_to_head() -> None:
    """A vertical lane's head: its tip is nearer to the edge's head than its back."""
    graph = unite(
        [[Edge("up", "up", "e", "ground", "a"), Edge("down", "down", "e", "b", "ground")]]
    )
    topology = choose_forest(graph["e"])
    drawn = etree.fromstring(topology_svg(topology).encode())
    for group in drawn.findall(f".//{SVG}g[@class='lg-branch']"):
        head = group.findall(f"{SVG}path")[1].get("d")
        ys = [float(y) for y in re.findall(r",(-?[\d.]+)", head)]
        rises = ys[0] < ys[1]
        assert rises == (group.findtext(f"{SVG}title").startswith("up"))


def test_one_panel_where_translation_and_rotation_are_alike() -> None:
    titles = [t.text for t in graph_scene(example("double_pendulum")).texts()]
    assert "translation and rotation" in titles
    titles = [t.text for t in graph_scene(example("andrews_squeezer")).texts()]
    assert {"translation", "rotation"} <= {*titles}
    titles = [t.text for t in graph_scene(example("double_pendulum"), "rotation").texts()]
    assert "rotation" in titles
    assert "translation and rotation" not in titles


def test_subspaces_can_be_chosen() -> None:
    derivation = example("cart_pole_motor")
    scene = graph_scene(derivation, ["electrical", "rotation_1d"])
    names = {part.name for part in scene.parts()}
    assert {"supply", "pinion.first"} <= names
    assert "swing" not in names
    with pytest.raises(ModelError, match='subspace "electric": is not in this model'):
        graph_scene(derivation, "electric")


def test_a_remark_where_there_is_no_sketch() -> None:
    model = Model("m")
    bob = model.body("bob", mass=model.parameter("m"), mass_center=(0, 0, -1))
    model.revolute("hinge", between=("ground", bob), axis=(0, 1, 0))
    texts = [text.text for text in whole_scene(derive(model)).texts()]
    assert 'no sketch: parameter "m" has no value; a sketch of the mechanism needs one' in texts
    assert "mechanism" not in texts


# ---- files


def svg_is_well_formed_and_alone(name: str) -> None:
    text = svg_text(picture(name))
    drawn = etree.fromstring(text.encode())
    assert drawn.tag == f"{SVG}svg"
    assert drawn.get("role") == "img"
    assert [drawn[0].tag, drawn[1].tag] == [f"{SVG}title", f"{SVG}desc"]
    assert not drawn.xpath("//@id")
    assert {etree.QName(node).localname for node in drawn.iter()} <= {
        "svg", "title", "desc", "rect", "g", "path", "circle", "text"
    }  # fmt: skip
    assert "href" not in text
    assert "url(" not in text
    assert drawn.find(f"{SVG}rect").get("fill") == "#ffffff"


def test_hostile_names_are_text_in_svg() -> None:
    model = hostile()
    text = svg_text(whole_scene(derive(model)))
    drawn = etree.fromstring(text.encode("utf-8"))
    titles = {group.findtext(f"{SVG}title").split(" (")[0] for group in drawn.iter(f"{SVG}g")}
    assert {clean(name) for name in model.bodies} <= titles
    assert not drawn.findall(".//script")
    assert "<script" not in text


def test_long_and_foreign_names_keep_their_box() -> None:
    """Of letters whose width is not known the picture says how wide they are to be."""
    drawn = etree.fromstring(graph_svg(derive(hostile())).encode())
    texts = [node for node in drawn.iter(f"{SVG}text") if "θ" in (node.text or "")]
    assert texts
    assert all(node.get("textLength") for node in texts)
    assert width("名前", 10) > width("ab", 10)


def plain(dot: str) -> str:
    program = shutil.which("dot")
    if program is None:
        pytest.skip("Graphviz is not installed")
    done = subprocess.run(
        [program, "-Tplain"], input=dot, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "syntax" not in done.stderr
    return done.stdout


def test_dot_has_quoted_every_name() -> None:
    text = dot_text(derive(hostile()))
    rest = re.sub(r'"(?:[^"\\]|\\.)*"', "", text)
    assert not re.search(r'["<>&\\]', rest.replace("->", ""))


@pytest.mark.parametrize("name", ["four_bar", "cart_pole_motor", "panda"])
def test_dot_is_understood(name: str) -> None:
    derivation = example(name)
    lines = plain(dot_text(derivation)).splitlines()
    topology = derivation.topology
    assert sum(line.startswith("node 0:") or line.startswith('node "0:') for line in lines) == len(
        topology.projection.vertices
    )
    edges = sum(len(t.projection.edges) for t in topologies(derivation)) - len(
        topology.projection.edges
    )
    assert sum(line.startswith("edge ") for line in lines) == edges


def test_dot_understands_hostile_names() -> None:
    assert plain(dot_text(derive(hostile()))).count("\nnode ") == 3 * len((*HOSTILE, *OTHERS)) + 1


@pytest.mark.parametrize("name", ["double_pendulum", "cauer_filter"])
def test_png(name: str) -> None:
    pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    scene = graph_scene(example(name))
    data = png_bytes(scene)
    assert data.startswith(b"\x89PNG")
    size = (int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big"))
    assert size == (2 * scene.width, 2 * scene.height)
    assert data == png_bytes(scene)
    assert b"tEXt" not in data
    assert b"tIME" not in data


def test_hostile_names_and_large_pictures_in_png() -> None:
    pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    assert png_bytes(whole_scene(derive(hostile()))).startswith(b"\x89PNG")


# ---- the same bytes

SAME = "from support.drawn import digests; print(digests())"


def test_bytes_do_not_depend_on_the_process() -> None:
    """Another process, with another seed, against this one."""
    path = os.pathsep.join([str(ROOT / "tests"), str(ROOT)])
    environment = {**os.environ, "PYTHONHASHSEED": "1", "PYTHONPATH": path}
    command = [sys.executable, "-c", SAME]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == digests()


@pytest.mark.parametrize("name", ["four_bar", "anymal", "excavator_arm"])
def test_bytes_are_the_same_again(name: str) -> None:
    again = derive(example(name).system)
    assert svg_text(whole_scene(example(name))) == svg_text(whole_scene(again))


def test_numbers_are_short() -> None:
    text = svg_text(whole_scene(example("stewart_platform")))
    assert not re.search(r"\d\.\d\d", text)


# ---- notebooks


def test_stages_show_themselves() -> None:
    derivation = example("four_bar")
    for stage in (derivation.graph, derivation.graph["rotation"], derivation.topology):
        assert etree.fromstring(stage._repr_svg_().encode()).tag == f"{SVG}svg"
    assert projection_svg(derivation.graph["rotation"]) == derivation.graph["rotation"]._repr_svg_()
    whole = [t for t in example("cart_pole_motor").graph._repr_svg_().splitlines() if "<text" in t]
    assert any("electrical" in line for line in whole)


def test_graphs_without_ground() -> None:
    ring = [
        Edge(n, n, "e", a, b) for n, a, b in (("x", "1", "2"), ("y", "2", "3"), ("z", "3", "1"))
    ]
    drawn = etree.fromstring(unite([ring])._repr_svg_().encode())
    titles = {group.findtext(f"{SVG}title").split(" (")[0] for group in drawn.iter(f"{SVG}g")}
    assert {"x", "y", "z", "1", "2", "3"} <= titles
    assert "ground" not in titles


def test_loops_and_many_parallel_edges() -> None:
    many = [Edge(f"e{k}", f"e{k}", "e", *(("a", "b") if k % 2 else ("b", "a"))) for k in range(9)]
    own = [Edge("self", "self", "e", "a", "a"), Edge("g", "g", "e", "ground", "ground")]
    base = [Edge(f"to{v}", f"to{v}", "e", v, "ground") for v in "ab"]
    graph = unite([many + own + base])
    drawn = etree.fromstring(topology_svg(choose_forest(graph["e"], roots=["ground"])).encode())
    titles = {group.findtext(f"{SVG}title").split(" (")[0] for group in drawn.iter(f"{SVG}g")}
    assert {edge.name for edge in graph["e"].edges} <= titles
    places = [(n.get("x"), n.get("y")) for n in drawn.iter(f"{SVG}text")]
    assert len(places) == len({*places})


def test_every_item_lies_on_the_canvas() -> None:
    scene = whole_scene(example("arm_with_drives"))
    for item in flat(scene.items):
        if isinstance(item, Stroke):
            points = [item.start, *(p for step in item.steps for p in step)]
            assert all(0 <= x <= scene.width and 0 <= y <= scene.height for x, y in points)
        elif isinstance(item, Text):
            assert 0 <= item.x <= scene.width

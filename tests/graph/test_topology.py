"""Topology on random multigraphs: exact identities, and networkx as the independent oracle.

The graphs have parallel edges, self loops, vertices without edges and several parts. Everything is
integer arithmetic: no tolerance anywhere.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import networkx as nx
import numpy as np
import pytest
import sympy
from support.spec_models import model_of
from systems import random_trees as trees

from linegraph import derive
from linegraph.algebra.protocol import Floats
from linegraph.errors import ModelError
from linegraph.graph.forest import Topology, choose_forest
from linegraph.graph.multigraph import Edge, Projection
from linegraph.kinematics.tree_state import TreeState
from linegraph.paper.joint_form import paper_matrices

if TYPE_CHECKING:
    from collections.abc import Callable

    from linegraph.graph.multigraph import IntegerMatrix
    from linegraph.kinematics.links import KinematicTree

SEEDS = range(40)
SMALL = range(12)


def random_projection(rng: np.random.Generator, vertices: int = 10, edges: int = 22) -> Projection:
    names = tuple(f"v{i}" for i in range(int(rng.integers(1, vertices + 1))))
    ends = rng.integers(0, len(names), size=(int(rng.integers(0, edges + 1)), 2))
    return Projection(
        "d",
        names,
        tuple(Edge(f"e{k}", f"c{k}", "d", names[i], names[j]) for k, (i, j) in enumerate(ends)),
    )


def random_weights(rng: np.random.Generator, projection: Projection) -> dict[str, float]:
    """Few different weights, so that ties are common; some edges have none."""
    return {e.name: float(rng.integers(1, 5)) for e in projection.edges if rng.random() < 0.8}


def draw(seed: int, **sizes: int) -> tuple[Projection, dict[str, float], Topology]:
    rng = np.random.default_rng(seed)
    projection = random_projection(rng, **sizes)
    weights = random_weights(rng, projection)
    return projection, weights, choose_forest(projection, weights)


def names(edges: tuple[Edge, ...]) -> list[str]:
    return [edge.name for edge in edges]


def in_edge_order(projection: Projection, own: tuple[Edge, ...], rest: IntegerMatrix) -> Any:
    """[U A] or [B U] as numpy, with the columns in the order of the projection's edges."""
    whole = np.zeros((len(own), len(projection.edges)), dtype=int)
    column = {edge.name: j for j, edge in enumerate(projection.edges)}
    dense = rest.to_numpy()
    for i, edge in enumerate(own):
        whole[i, column[edge.name]] = 1
    for j, name in enumerate(rest.columns):
        whole[:, column[name]] += dense[:, j]
    return whole


def undirected(vertices: tuple[str, ...], edges: tuple[Edge, ...]) -> Any:
    graph = nx.MultiGraph()
    graph.add_nodes_from(vertices)
    for edge in edges:
        graph.add_edge(edge.tail, edge.head, key=edge.name)
    return graph


def forest_of(topology: Topology) -> Any:
    return undirected(topology.projection.vertices, topology.branches)


def expected_cutset(topology: Topology) -> list[list[int]]:
    """A by the definition: cut the branch, look which chords join the two sides, and which way."""
    rows = []
    for branch in topology.branches:
        forest = forest_of(topology)
        forest.remove_edge(branch.tail, branch.head, key=branch.name)
        heads = nx.node_connected_component(forest, branch.head)
        rows.append([(c.head in heads) - (c.tail in heads) for c in topology.chords])
    return rows


def expected_circuit(topology: Topology) -> list[list[int]]:
    """B by the definition: from the chord's head back to its tail along the forest."""
    forest = forest_of(topology)
    column = {edge.name: j for j, edge in enumerate(topology.branches)}
    direction = {edge.name: edge for edge in topology.branches}
    rows = []
    for chord in topology.chords:
        row = [0] * len(column)
        path = nx.shortest_path(forest, chord.head, chord.tail)
        for near, far in nx.utils.pairwise(path):
            (name,) = forest[near][far]
            row[column[name]] += 1 if direction[name].tail == near else -1
        rows.append(row)
    return rows


def test_the_graphs_drawn_reach_every_feature() -> None:
    drawn = [draw(seed)[0] for seed in SEEDS]
    ends = [[frozenset((e.tail, e.head)) for e in projection.edges] for projection in drawn]
    assert any(len(pairs) > len(set(pairs)) for pairs in ends), "parallel edges"
    assert any(len(pair) == 1 for pairs in ends for pair in pairs), "self loops"
    assert any(set(p.vertices) - frozenset().union(*e) for p, e in zip(drawn, ends, strict=True))
    assert any(len(draw(seed)[2].roots) > 2 and draw(seed)[2].branches for seed in SEEDS)


@pytest.mark.parametrize("seed", SEEDS)
def test_counts(seed: int) -> None:
    projection, _, topology = draw(seed)
    v, e = len(projection.vertices), len(projection.edges)
    n = nx.number_connected_components(undirected(projection.vertices, projection.edges))
    assert len(topology.roots) == n
    assert len(topology.branches) == v - n
    assert len(topology.chords) == e - v + n
    assert sorted(names(topology.branches + topology.chords)) == sorted(names(projection.edges))


@pytest.mark.parametrize("seed", SEEDS)
def test_matrices_are_those_of_their_definitions(seed: int) -> None:
    _, _, topology = draw(seed)
    assert topology.cutset.to_numpy().tolist() == expected_cutset(topology)
    assert topology.circuit.to_numpy().tolist() == expected_circuit(topology)
    assert topology.cutset.rows == topology.circuit.columns == tuple(names(topology.branches))
    assert topology.cutset.columns == topology.circuit.rows == tuple(names(topology.chords))


@pytest.mark.parametrize("seed", SEEDS)
def test_exact_orthogonality(seed: int) -> None:
    projection, _, topology = draw(seed)
    assert np.array_equal(topology.circuit.to_numpy(), -topology.cutset.to_numpy().T)
    cutsets = in_edge_order(projection, topology.branches, topology.cutset)
    circuits = in_edge_order(projection, topology.chords, topology.circuit)
    assert not (cutsets @ circuits.T).any()
    assert not (projection.incidence.to_numpy() @ circuits.T).any()


@pytest.mark.parametrize("seed", SEEDS)
def test_entries_and_minors_are_unimodular(seed: int) -> None:
    _, _, topology = draw(seed)
    a = topology.cutset.to_numpy()
    assert set(a.flat) <= {-1, 0, 1}
    rng = np.random.default_rng(seed)
    for _ in range(4):
        size = int(rng.integers(0, min(4, *a.shape) + 1))
        rows = rng.choice(a.shape[0], size, replace=False)
        columns = rng.choice(a.shape[1], size, replace=False)
        assert sympy.Matrix(a[np.ix_(rows, columns)].tolist()).det() in (-1, 0, 1)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_forest_has_the_least_weight(seed: int) -> None:
    projection, weights, topology = draw(seed)
    graph = undirected(projection.vertices, projection.edges)
    for edge in projection.edges:
        graph.edges[edge.tail, edge.head, edge.name]["weight"] = weights.get(edge.name, 0.0)
    least = nx.minimum_spanning_tree(graph).size(weight="weight")
    assert sum(weights.get(edge.name, 0.0) for edge in topology.branches) == least
    assert nx.is_forest(nx.Graph(forest_of(topology)))


@pytest.mark.parametrize("seed", SEEDS)
def test_ties_go_to_the_edge_declared_first(seed: int) -> None:
    """Of a circuit its chord is the heaviest edge and, of equals, the last declared."""
    projection, weights, topology = draw(seed)
    rank = {e.name: (weights.get(e.name, 0.0), k) for k, e in enumerate(projection.edges)}
    for chord, row in zip(topology.chords, topology.circuit.entries, strict=True):
        assert all(rank[topology.branches[j].name] < rank[chord.name] for j in row)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_walk_goes_from_the_roots_outward(seed: int) -> None:
    projection, _, topology = draw(seed)
    seen = set(topology.roots)
    for step in topology.walk:
        assert step.near in seen
        assert step.far not in seen
        ends = (step.near, step.far) if step.forward else (step.far, step.near)
        assert (step.edge.tail, step.edge.head) == ends
        seen.add(step.far)
    assert seen == set(projection.vertices)
    assert sorted(step.edge.name for step in topology.walk) == sorted(names(topology.branches))


def test_roots_are_honoured_where_their_part_has_one() -> None:
    chain = [("a", "b"), ("b", "c"), ("x", "y")]
    edges = tuple(Edge(t + h, t + h, "d", t, h) for t, h in chain)
    projection = Projection("d", ("a", "b", "c", "x", "y"), edges)
    assert choose_forest(projection).roots == ("a", "x")
    assert set(choose_forest(projection, roots=["c", "nowhere"]).roots) == {"c", "x"}
    one_each = choose_forest(projection, roots=["c", "b"])
    assert len(one_each.roots) == 2
    assert one_each.roots[0] == "c"


def random_forest(rng: np.random.Generator, projection: Projection) -> list[str]:
    """The edges of a spanning forest that pays no heed to weights, in random order."""
    graph = undirected(projection.vertices, projection.edges)
    for _, _, data in graph.edges(data=True):
        data["weight"] = rng.random()
    chosen = [key for *_, key in nx.minimum_spanning_tree(graph).edges(keys=True)]
    return [str(name) for name in rng.permutation(chosen)]


@pytest.mark.parametrize("seed", SEEDS)
def test_wanted_branches_are_honoured(seed: int) -> None:
    rng = np.random.default_rng(seed)
    projection = random_projection(rng)
    weights = random_weights(rng, projection)
    wanted = random_forest(rng, projection)
    assert set(names(choose_forest(projection, weights, branches=wanted).branches)) == set(wanted)
    half = wanted[::2]
    assert set(half) <= set(names(choose_forest(projection, weights, branches=half).branches))


@pytest.mark.parametrize("seed", SEEDS)
def test_wanted_branches_that_close_a_circuit_are_refused(seed: int) -> None:
    rng = np.random.default_rng(seed)
    projection = random_projection(rng)
    wanted = random_forest(rng, projection)
    spare = [edge for edge in projection.edges if edge.name not in wanted]
    for edge in spare[:2]:
        with pytest.raises(ModelError, match=r'branch "e\d+": the wanted tree closes a circuit'):
            choose_forest(projection, branches=[*wanted, edge.name])


def test_the_branch_that_closes_the_circuit_is_named() -> None:
    edges = tuple(Edge(name, name, "d", "a", "b") for name in ("first", "second"))
    projection = Projection("d", ("a", "b"), edges)
    with pytest.raises(ModelError, match='branch "second": the wanted tree closes a circuit here'):
        choose_forest(projection, branches=["first", "second"])
    with pytest.raises(ModelError, match='branch "third": there is no edge of that name'):
        choose_forest(projection, branches=["third"])


@pytest.mark.parametrize("seed", SEEDS)
def test_reversing_an_edge_turns_the_sign_of_its_own_row_or_column(seed: int) -> None:
    projection, weights, topology = draw(seed)
    for k, edge in enumerate(projection.edges):
        turned = edge._replace(tail=edge.head, head=edge.tail)
        edges = (*projection.edges[:k], turned, *projection.edges[k + 1 :])
        other = choose_forest(replace(projection, edges=edges), weights)
        assert names(other.branches) == names(topology.branches)
        expected = topology.cutset.to_numpy()
        if edge in topology.branches:
            expected[names(topology.branches).index(edge.name)] *= -1
        else:
            expected[:, names(topology.chords).index(edge.name)] *= -1
        assert np.array_equal(other.cutset.to_numpy(), expected)


@pytest.mark.parametrize("seed", SMALL)
def test_rank_of_incidence(seed: int) -> None:
    projection, _, topology = draw(seed, vertices=8, edges=14)
    rank = projection.incidence.to_sympy().rank()
    assert rank == len(projection.vertices) - len(topology.roots)


@pytest.mark.parametrize("seed", SMALL)
def test_cutset_equations_and_vertex_equations_imply_each_other(seed: int) -> None:
    """Equal row spaces, by the reduced row echelon form over the rationals."""
    projection, _, topology = draw(seed, vertices=7, edges=12)

    def basis(matrix: Any) -> Any:
        reduced, pivots = sympy.Matrix(matrix).rref()
        return reduced[: len(pivots), :]

    cutsets = in_edge_order(projection, topology.branches, topology.cutset)
    if cutsets.size:
        assert basis(cutsets) == basis(projection.incidence.to_numpy())
    else:
        assert not projection.incidence.to_numpy().any()


def bridge() -> Topology:
    """A square with a diagonal: every branch lies in some circuit."""
    pairs = [("a", "b"), ("b", "c"), ("c", "d"), ("d", "a"), ("a", "c")]
    edges = tuple(Edge(t + h, t + h, "d", t, h) for t, h in pairs)
    return choose_forest(Projection("d", ("a", "b", "c", "d"), edges))


def against(topology: Topology) -> Topology:
    first, *rest = topology.walk
    return replace(topology, walk=(first._replace(forward=not first.forward), *rest))


def turned_step(topology: Topology) -> Topology:
    *rest, last = topology.walk
    return replace(topology, walk=(*rest, last._replace(near=last.far, far=last.near)))


def other_edge(topology: Topology) -> Topology:
    first, *rest, last = topology.walk
    walk = (first._replace(edge=last.edge), *rest, last._replace(edge=first.edge))
    return replace(topology, walk=walk)


def shuffled(topology: Topology) -> Topology:
    return replace(topology, walk=topology.walk[::-1])


def one_part_more(topology: Topology) -> Topology:
    return replace(topology, roots=(*topology.roots, "c"))


def chord_as_branch(topology: Topology) -> Topology:
    (*chords, last), branches = topology.chords, topology.branches
    return replace(topology, chords=tuple(chords), branches=(*branches, last))


def forgotten_chord(topology: Topology) -> Topology:
    return replace(topology, chords=topology.chords[1:])


@pytest.mark.parametrize(
    "tamper",
    [against, turned_step, other_edge, shuffled, one_part_more, chord_as_branch, forgotten_chord],
)
def test_a_wrong_topology_cannot_be_built(tamper: Callable[[Topology], Topology]) -> None:
    with pytest.raises(AssertionError, match=r"branches must number|B = -A\^T|orthogonal"):
        tamper(bridge())


@pytest.mark.parametrize("seed", SEEDS)
def test_turning_one_step_of_a_random_walk_is_noticed(seed: int) -> None:
    _, _, topology = draw(seed)
    in_circuit = {j for row in topology.circuit.entries for j in row}
    for k, step in enumerate(topology.walk):
        if topology.branches.index(step.edge) not in in_circuit:
            continue  # a bridge has no column to be wrong in
        wrong = step._replace(forward=not step.forward)
        walk = (*topology.walk[:k], wrong, *topology.walk[k + 1 :])
        with pytest.raises(AssertionError, match="orthogonal"):
            replace(topology, walk=walk)


@pytest.mark.parametrize("seed", range(20))
def test_the_papers_H_is_the_cutset_matrix_of_joints_and_inertia_edges(seed: int) -> None:
    """Row by row up to the joint's orientation; a link's bodies share a column."""
    rng = np.random.default_rng(seed)
    spec = trees.random_tree(rng, bodies=1 + seed % 8)
    derivation = derive(model_of(spec))
    q, v = trees.random_state(rng, spec)
    tree: KinematicTree = derivation.tree(Floats(), {})
    h = paper_matrices(TreeState(tree, q.tolist(), v.tolist())).H
    cutset = derivation.topology.cutset
    for i, link in enumerate(tree.links):
        row = cutset.rows.index(link.joint.name)
        sign = 1 if link.forward else -1
        for j, other in enumerate(tree.links):
            for body in other.name.split(", "):
                column = cutset.columns.index(f"{body}/inertia")
                assert cutset[row, column] == sign * h[i][j], (link.joint.name, body)

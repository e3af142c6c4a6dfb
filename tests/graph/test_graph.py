"""The system graph: union of terminal graphs, projections, incidence, and matrices of integers."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING

import numpy as np
import pytest
import sympy

from linegraph.errors import ModelError
from linegraph.graph.multigraph import Edge, IntegerMatrix, Projection, unite

if TYPE_CHECKING:
    from linegraph.graph.multigraph import SystemGraph


def edge(name: str, tail: str, head: str, domain: str = "electrical") -> Edge:
    return Edge(name, name, domain, tail, head)


def circuit() -> SystemGraph:
    """Two lamps in parallel on a cell, a part of its own, and a shaft in another domain."""
    return unite(
        [
            [edge("cell", "0", "a")],
            [edge("left", "a", "0"), edge("shaft", "0", "s", "rotation")],
            [edge("right", "a", "0")],
            [edge("apart", "x", "y")],
        ]
    )


def random_matrix(draw: random.Random, rows: int, columns: int) -> IntegerMatrix:
    entries = tuple(
        {j: draw.choice([-3, -1, 1, 2]) for j in range(columns) if draw.random() < 0.4}
        for _ in range(rows)
    )
    return IntegerMatrix(
        tuple(f"r{i}" for i in range(rows)), tuple(f"c{j}" for j in range(columns)), entries
    )


def dense(matrix: IntegerMatrix) -> list[list[int]]:
    rows, columns = matrix.shape
    return [[matrix[i, j] for j in range(columns)] for i in range(rows)]


def test_union_merges_terminals_of_one_name_within_each_domain() -> None:
    graph = circuit()
    assert graph.domains == ("electrical", "rotation")
    assert graph["electrical"].vertices == ("0", "a", "x", "y")
    assert [e.name for e in graph["electrical"].edges] == ["cell", "left", "right", "apart"]
    assert graph["rotation"].vertices == ("0", "s")
    assert [e.name for e in graph["rotation"].edges] == ["shaft"]


def test_an_unknown_domain_is_not_a_projection() -> None:
    with pytest.raises(KeyError, match="hydraulic"):
        circuit()["hydraulic"]


def test_incidence_is_plus_one_where_an_edge_leaves() -> None:
    incidence = unite([[edge("e", "from", "to")]])["electrical"].incidence
    assert (incidence.rows, incidence.columns) == (("from", "to"), ("e",))
    assert dense(incidence) == [[1], [-1]]


def test_incidence_of_parallel_edges_and_of_several_parts() -> None:
    assert dense(circuit()["electrical"].incidence) == [
        [1, -1, -1, 0],
        [-1, 1, 1, 0],
        [0, 0, 0, 1],
        [0, 0, 0, -1],
    ]


def test_a_self_loop_leaves_and_enters_its_vertex() -> None:
    incidence = unite([[edge("loop", "a", "a"), edge("e", "a", "b")]])["electrical"].incidence
    assert dense(incidence) == [[0, 1], [0, -1]]


def test_a_name_may_return_in_another_domain_only() -> None:
    both = unite([[edge("arm", "0", "a"), edge("arm", "0", "a", "rotation")]])
    assert both.domains == ("electrical", "rotation")
    with pytest.raises(ModelError, match=r'edge "arm": arises twice in electrical; rename a com'):
        unite([[edge("arm", "0", "a")], [edge("arm", "a", "b")]])


def test_the_union_is_frozen_and_repeats_itself() -> None:
    assert circuit() == circuit()
    assert circuit().projections[0].incidence.entries == circuit()["electrical"].incidence.entries


def test_nothing_united_is_empty() -> None:
    assert unite([]).projections == ()


@pytest.mark.parametrize("seed", range(20))
def test_matrix_algebra_is_numpys(seed: int) -> None:
    draw = random.Random(seed)
    m, n, p = (draw.randint(0, 6) for _ in range(3))
    left, right = random_matrix(draw, m, n), random_matrix(draw, n, p)
    a = np.array(dense(left), dtype=int).reshape(m, n)
    b = np.array(dense(right), dtype=int).reshape(n, p)

    product = left @ right
    assert (product.rows, product.columns) == (left.rows, right.columns)
    assert np.array_equal(product.to_numpy(), a @ b)
    assert all(value for row in product.entries for value in row.values())
    assert np.array_equal(left.transposed.to_numpy(), a.T)
    assert (left.transposed.rows, left.transposed.columns) == (left.columns, left.rows)
    assert np.array_equal((-left).to_numpy(), -a)
    assert [list(row) for row in left] == a.tolist()
    assert left.to_numpy().dtype == np.dtype(int)
    assert left.shape == left.to_numpy().shape == (m, n)


@pytest.mark.parametrize("seed", range(5))
def test_to_sympy_is_the_same_matrix(seed: int) -> None:
    draw = random.Random(seed)
    matrix = random_matrix(draw, draw.randint(1, 5), draw.randint(1, 5))
    assert matrix.to_sympy() == sympy.Matrix(dense(matrix))
    assert all(entry.is_Integer for entry in matrix.to_sympy())


def test_to_sympy_keeps_the_shape_of_an_empty_matrix() -> None:
    assert IntegerMatrix((), ("a", "b"), ()).to_sympy().shape == (0, 2)


def test_a_matrix_prints_as_a_table_with_names() -> None:
    matrix = IntegerMatrix(("a", "long"), ("x", "other"), ({0: 1}, {0: -1, 1: 12}))
    assert str(matrix) == "       x  other\na     +1      .\nlong  -1    +12"


def test_the_table_of_a_matrix_without_columns_names_its_rows() -> None:
    assert str(IntegerMatrix(("a", "bc"), (), ({}, {}))) == "\na\nbc"


def test_to_networkx_keeps_names_orientation_and_parallel_edges() -> None:
    graph = circuit()["electrical"].to_networkx()
    assert graph.is_directed()
    assert graph.is_multigraph()
    assert graph.graph == {"domain": "electrical"}
    assert list(graph.nodes) == ["0", "a", "x", "y"]
    assert sorted(graph.edges(keys=True)) == [
        ("0", "a", "cell"),
        ("a", "0", "left"),
        ("a", "0", "right"),
        ("x", "y", "apart"),
    ]
    assert graph.edges["a", "0", "left"] == {"component": "left"}


def test_to_networkx_keeps_a_vertex_without_edges() -> None:
    assert list(Projection("d", ("alone",), ()).to_networkx().nodes) == ["alone"]

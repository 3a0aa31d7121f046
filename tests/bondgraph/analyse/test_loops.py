"""Loops by name with their gain, against hand calculations; refusals with the expression that vanishes."""

import itertools

import networkx as nx
import pytest
import sympy as sp

import bondgraph as bg


def _graph(nodes: list[bg.nodes.elements.Node], *paths: str) -> "nx.DiGraph[str]":
    """A graph of these nodes; each path ``a b c`` is a chain of bonds."""
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from(nodes)
    for path in paths:
        names = path.split()
        graph.add_edges_from(itertools.pairwise(names))
    return graph


def test_a_ladder_of_three_resistances_is_one_loop() -> None:
    nodes = [
        bg.Se("u", "U"),
        bg.One("w"),
        bg.R("a", "a"),
        bg.Zero("n"),
        bg.R("b", "b"),
        bg.R("c", "c"),
    ]
    (loop,) = bg.loops(_graph(nodes, "u w a", "w n b", "n c"))
    a, b, c = sp.symbols("a b c")
    parallel = b * c / (b + c)
    # U - a i = u_n and i = u_n / parallel: going round once, i comes back as -parallel/a or its inverse.
    assert loop.kind == "resistances"
    assert set(loop.nodes) == {"a", "b", "c"}
    assert loop.gain is not None
    closed = {sp.cancel(-a / parallel), sp.cancel(-parallel / a)}
    assert sp.cancel(loop.gain) in closed


def test_a_ring_of_transformers_has_the_product_of_their_ratios() -> None:
    nodes = [
        bg.One("p"), bg.One("q"), bg.TF("one", "n"), bg.TF("two", "k"), bg.I("m", "m"), bg.Se("F", "F"),
    ]  # fmt: skip
    flows, efforts = bg.loops(_graph(nodes, "p one q two p", "p m", "F q"))
    n, k = sp.symbols("n k")
    # Going round once a flow comes back n k times as large, an effort too or the other way round.
    for loop in (flows, efforts):
        assert loop.kind == "bonds"
        assert set(loop.nodes) == {"p", "q", "one", "two"}
        assert loop.gain in {n * k, 1 / (n * k)}


def test_a_dependent_inertia_behind_a_gear() -> None:
    nodes = [bg.One("a"), bg.I("J_1", "J_1"), bg.TF("gear", "n"), bg.One("b"), bg.I("J_2", "J_2")]
    (loop,) = bg.loops(_graph(nodes, "a J_1", "a gear b J_2"))
    J_1, J_2, n = sp.symbols("J_1 J_2 n")
    assert (loop.kind, loop.nodes) == ("storages", ("J_1", "J_2"))
    # J_1 w' = -n J_2 (n w)': the torque comes back as -n**2 J_2 / J_1.
    assert loop.gain is not None
    assert sp.cancel(loop.gain + n**2 * J_2 / J_1) == 0


def test_a_capacitor_across_a_source() -> None:
    nodes = [bg.Se("u", "U"), bg.TF("t", "n"), bg.Zero("p"), bg.C("C", "C"), bg.R("r", "r")]
    (loop,) = bg.loops(_graph(nodes, "u t p C", "p r"))
    C, n = sp.symbols("C n")
    assert (loop.kind, loop.nodes) == ("source", ("u", "C"))
    # The capacitor's voltage is U/n, the source sees C/n (U/n)'.
    assert loop.gain is not None
    assert sp.cancel(loop.gain - C / n**2) == 0


def test_a_tree_has_no_loops() -> None:
    nodes = [bg.Se("u", "U"), bg.One("w"), bg.R("a", "a"), bg.I("L", "L"), bg.C("C", "C")]
    assert bg.loops(_graph(nodes, "u w a", "w L", "w C")) == ()


SINGULAR = [
    (
        [bg.One("p"), bg.One("q"), bg.TF("one", "n"), bg.TF("two", "1/n"), bg.I("m", "m"), bg.R("r", "r")],
        ["p one q two p", "p m", "q r"],
        bg.AlgebraicLoopError,
        "m_one*m_two - 1 vanishes with m_one = n, m_two = 1/n",
    ),
    (
        [bg.Zero("n"), bg.C("a", "C"), bg.C("b", "-C"), bg.R("r", "r")],
        ["n a", "n b", "n r"],
        bg.SingularStorageError,
        "C_a + C_b vanishes with C_a = C, C_b = -C",
    ),
    (
        [bg.One("x"), bg.I("J_1", "n**2*J"), bg.TF("gear", "n"), bg.One("y"), bg.I("J_2", "-J")],
        ["x J_1", "x gear y J_2"],
        bg.SingularStorageError,
        "I_J_1 + I_J_2*n**2 vanishes with I_J_1 = J*n**2, I_J_2 = -J",
    ),
    (
        [bg.Zero("n"), bg.C("c", "C"), bg.One("s"), bg.R("a", "r"), bg.R("b", "-r")],
        ["n c", "n s a", "s b"],
        bg.AlgebraicLoopError,
        "R_a + R_b vanishes with R_a = r, R_b = -r",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("nodes", "paths", "error", "text"), SINGULAR)
def test_a_refusal_shows_what_vanishes(
    nodes: list[bg.nodes.elements.Node],
    paths: list[str],
    error: type[bg.BondGraphError],
    text: str,
) -> None:
    with pytest.raises(error) as found:
        bg.derive(_graph(nodes, *paths))
    assert text in str(found.value)


def test_a_ring_without_ratios_is_singular_with_any() -> None:
    nodes = [bg.One("p"), bg.One("q"), bg.One("s"), bg.I("m", "m"), bg.R("r", "r"), bg.Se("F", "F")]
    with pytest.raises(bg.AlgebraicLoopError, match="so it is with any ratios"):
        bg.derive(_graph(nodes, "p q s p", "p m", "q r", "F s"))


def test_a_loop_too_large_to_be_read_has_no_gain() -> None:
    nodes = [bg.Se("u", "U"), bg.One("w_0")]
    paths = ["u w_0"]
    for k in range(8):
        nodes += [
            bg.R(f"a_{k}", 1),
            bg.Zero(f"n_{k}"),
            bg.R(f"b_{k}", 2),
            bg.One(f"w_{k + 1}"),
        ]
        paths += [f"w_{k} a_{k}", f"w_{k} n_{k} b_{k}", f"n_{k} w_{k + 1}"]
    nodes += [bg.R("end", 1)]
    paths += ["w_8 end"]
    (loop,) = bg.loops(_graph(nodes, *paths))
    assert loop.kind == "resistances"
    assert loop.gain is None
    assert len(loop.nodes) == 17

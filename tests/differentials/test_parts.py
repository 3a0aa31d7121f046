import pytest
import sympy as sp

import bondgraph as bg
from differentials.parts import assemble, bevel, clutch, engine, gear, halfshaft, inertia, shaft


def test_a_gear_multiplies_inertia_by_the_square_of_its_ratio() -> None:
    graph = assemble(
        shaft("fast"),
        shaft("slow"),
        engine("engine", "tau", at="fast"),
        inertia("J", "J", at="fast", priority=-1),
        gear("gear", "n", driving="fast", driven="slow"),
        inertia("L", "L", at="slow", speed="omega"),
    )
    found = bg.derive(graph)
    n, J, L = sp.symbols("n J L")
    assert sp.expand(found.A[0, 0] - (L + n**2 * J)) == 0
    assert found.B[0, 0] == n


def test_a_clutch_brakes_the_slip_between_its_shafts() -> None:
    graph = assemble(
        shaft("a"),
        shaft("b"),
        inertia("J_a", "J_a", at="a", speed="w_a"),
        inertia("J_b", "J_b", at="b", speed="w_b"),
        clutch("clutch", "tau", "slip", driving="a", driven="b"),
    )
    found = bg.derive(graph)
    assert found.F.tolist() == [[1, -1]]
    assert found.B.tolist() == [[-1], [1]]


def test_a_bevel_gear_halves_the_sum_of_its_speeds() -> None:
    graph = assemble(
        shaft("case", "w_c"),
        shaft("l"),
        shaft("r"),
        engine("engine", "tau", at="case"),
        bevel("bevel", "case", "l", "r"),
        inertia("J_l", "J_l", at="l"),
        inertia("J_r", "J_r", at="r"),
    )
    found = bg.derive(graph, outputs=["case"])
    assert found.F.tolist() == [[sp.Rational(1, 2)] * 2]
    assert found.B.tolist() == [[sp.Rational(1, 2)]] * 2


def test_a_halfshaft_twists_between_its_ends() -> None:
    graph = assemble(
        shaft("in"),
        shaft("out"),
        inertia("J_1", "J_1", at="in", speed="w"),
        halfshaft(1, "in", "out", "k", "b"),
        inertia("J_2", "J_2", at="out", speed="w_t"),
    )
    found = bg.derive(graph, outputs=["halfshaft_1"])
    b = sp.Symbol("b")
    assert [str(s) for s in (*found.states, *found.outputs)] == ["w", "tau_k1", "w_t", "tau_hs1"]
    assert found.F.tolist() == [[b, 1, -b]]


def test_parts_that_disagree_are_refused() -> None:
    with pytest.raises(bg.StructureError, match="two parts declare node 'J'"):
        assemble(shaft("a"), inertia("J", "J", at="a"), inertia("J", "J_2", at="a"))
    with pytest.raises(bg.StructureError, match="two parts declare the bond 'a' -> 'J'"):
        assemble(shaft("a"), inertia("J", "J", at="a"), inertia("J", "J", at="a"))

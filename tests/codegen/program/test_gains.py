"""Loops of laws with a gain of 1 determine nothing and are refused by name, on every way out."""

from collections.abc import Callable

import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Family, simulator, to_c, to_python


def _mass() -> bg.StateEquations:
    nodes = [
        bg.Se("F", "F"),
        bg.One("j"),
        bg.I("m", "m", flow="v"),
        bg.C("k", "1/k", effort="F_k"),
        bg.R("b", "b"),
    ]
    return bg.derive(bond_graph(nodes, "F>j>m j>k j>b"))


NUMBERS = {"m": 2, "k": 800, "b": 4}
WAYS: dict[str, Callable[[dict], object]] = {
    "numpy": lambda laws: simulator(_mass(), NUMBERS, laws),
    "c": lambda laws: simulator(_mass(), NUMBERS, laws, "c"),
    "family": lambda laws: Family(_mass(), NUMBERS, laws).simulator(),
    "to_c": lambda laws: to_c(_mass(), NUMBERS, laws),
    "to_python": lambda laws: to_python(_mass(), NUMBERS, laws),
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("law", ["F", "F + v", "F + 1", "(2*F + F*v)/(2 + v)"])
def test_a_law_of_itself_is_refused_by_name(law: str, way: str) -> None:
    with pytest.raises(
        bg.AlgebraicLoopError, match=r"laws at 'F' give F from F alone .* gain of 1"
    ):
        WAYS[way]({"F": law})


def test_laws_that_only_say_each_other_are_refused() -> None:
    nodes = [
        bg.One("n"),
        bg.I("m", 2, flow="v"),
        bg.R("a", law="e_b + v"),
        bg.R("b", law="e_a - v"),
    ]
    equations = bg.derive(bond_graph(nodes, "n>m n>a n>b"))
    with pytest.raises(bg.AlgebraicLoopError, match="laws at 'a', 'b' give e_a, e_b from e_a, e_b"):
        simulator(equations, {})


def _through_a_resistance(law: str) -> bg.StateEquations:
    """``e = V - R f`` around the port, whose law gives f."""
    nodes = [bg.Se("s", "V"), bg.One("n"), bg.R("r", "R"), bg.R("port", law=law, gives="flow")]
    return bg.derive(bond_graph(nodes, "s>n>r n>port"), outputs=["port"])


def test_a_loop_by_way_of_a_resistance_is_refused_where_its_gain_is_1() -> None:
    """``f = (V_0 - e) g`` with ``e = V - R f`` is ``f (1 - R g) = (V_0 - V) g``."""
    with pytest.raises(bg.AlgebraicLoopError, match="the laws at 'port' give f_port"):
        simulator(_through_a_resistance("(V_0 - e_port)/R"), {"R": 2, "V_0": 1})
    equations = _through_a_resistance("(V_0 - e_port)*g")
    with pytest.raises(bg.AlgebraicLoopError, match="at these parameters the laws at 'port'"):
        simulator(equations, {"R": 2, "V_0": 1, "g": 0.5})
    for g in (0.25, 3.0):
        result = simulator(equations, {"R": 2, "V_0": 1, "g": g}).run([0, 1], inputs={"V": 5.0})
        assert result["f_port"] == pytest.approx([-4 * g / (1 - 2 * g)] * 2, rel=1e-9)


def test_a_parameter_still_holds_an_open_input() -> None:
    result = simulator(_mass(), {**NUMBERS, "F": 3.0}).run([0.0, 0.1])
    assert result["F"] == pytest.approx([3.0, 3.0])

"""Tables of a program: each once, by name, and no two of one name."""

import networkx as nx
import pytest

import bondgraph as bg
from codegen import simulator
from codegen.program.lower import lower

drag = bg.LookupTable("drag", [0, 1, 3], [0, 2, 3])
other = bg.LookupTable("drag", [0, 1], [0, 1])
level = bg.LookupTable("level", [0, 1], [2, 1])


def _equations(law: object) -> bg.StateEquations:
    graph = nx.DiGraph()
    graph.add_nodes_from([
        bg.Se("push", drag("t") + drag("t/2")), bg.One("n"), bg.I("m", drag(2), flow="v"), bg.R("r", law=law),
        bg.R("f", law=bg.DryFriction(level("v"), level("slip/2"))),
    ])  # fmt: skip
    graph.add_edges_from([("push", "n"), ("n", "m"), ("n", "r"), ("n", "f")])
    return bg.derive(graph)


@pytest.mark.parametrize("timed", [False, True])
def test_each_table_is_there_once(timed: bool) -> None:
    assert lower(_equations(drag("v")), timed=timed).tables == (drag, level)


def test_two_tables_of_one_name_are_refused() -> None:
    equations = _equations(other("v"))
    with pytest.raises(
        bg.TableError, match="laws and values: there are two tables 'drag'; rename one"
    ):
        lower(equations)
    with pytest.raises(bg.TableError, match="two tables 'drag'"):
        simulator(_equations(drag("v")), {}, {"r": other("v")})

"""Tables that come with a graph: every value and law may call them, and parts share them."""

import networkx as nx
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg

drag = bg.LookupTable("drag", [0, 1, 3], [0, 2, 3])
ratio = bg.LookupTable("ratio", [0, 1], [1, 2], outside="hold")
phi, v = sp.symbols("phi v")


def _graph(*tables: object, law: object = "b*drag(v)") -> nx.DiGraph:
    nodes = [bg.Se("push", "drag(t)"), bg.One("n"), bg.I("m", "m", flow="v"), bg.R("b", law=law)]
    graph = bond_graph(nodes, "push>n>m n>b")
    graph.graph["tables"] = list(tables)
    return graph


def test_values_and_laws_call_the_tables_of_their_graph() -> None:
    equations = bg.derive(_graph(drag))
    t, b = sp.symbols("t b")
    assert equations.laws["b"].expression == b * drag(v)
    assert equations.laws["push"].expression == drag(t)
    assert equations.tables == (drag,)
    assert _graph(drag).nodes["b"]["law"] == "b*drag(v)"


def test_without_its_table_a_call_is_refused() -> None:
    with pytest.raises(bg.ExpressionError, match="'drag' is not a function"):
        bg.derive(_graph(ratio))


def test_every_attribute_that_reads_names_may_call() -> None:
    graph = nx.DiGraph(tables=[drag, ratio])
    graph.add_nodes_from([
        bg.One("n"), bg.I("m", "drag(2)", flow="v"), bg.TF("g", "ratio(k)"), bg.Zero("z"),
        bg.C("c", energy="drag(q_c)*q_c"), bg.Sw("key", on="drag(e_c) - 1"),
        bg.R("field", [["drag(1)", 0], [0, "ratio(k)"]], ports=["a", "b"]), bg.One("far"),
    ])  # fmt: skip
    graph.add_edges_from(
        [("n", "m"), ("n", "g"), ("g", "z"), ("z", "c"), ("z", "key"), ("far", "key_")][:5]
    )
    graph.remove_node("far")
    graph.add_edge("n", "field", port="a")
    graph.add_node("other", kind="One")
    graph.add_edge("other", "field", port="b")
    graph.add_nodes_from([bg.Se("e", "ratio(2*u)")])
    graph.add_edge("e", "other")
    checked = bg.validate(graph)
    told = {name: checked.nodes[name]["element"] for name in checked}
    assert told["m"].value == drag(2)
    assert told["g"].value == ratio("k")
    assert told["c"].law.expression == sp.diff(drag("q_c") * sp.Symbol("q_c"), "q_c")
    assert told["key"].switch.on == drag("e_c") - 1
    assert dict(told["field.b"].row)["field.b"] == ratio("k")
    assert told["e"].law.expression == ratio("2*u")


def test_laws_that_are_put_later_call_them_as_well() -> None:
    equations = bg.derive(_graph(drag, law="b*v"))
    there = bg.linearize(equations, {"v": 2, "t": 2}, laws={"b": "drag(v)"})
    assert there.J[0, 0] == -sp.diff(drag(v), v).subs(v, 2)


def test_equations_may_be_given_tables_for_such_laws() -> None:
    equations = bg.derive(_graph(drag, law="b*v"))
    with pytest.raises(bg.ExpressionError, match=r"'ratio' is not a function.*given as tables"):
        bg.linearize(equations, {"v": 2, "t": 2}, laws={"b": "ratio(v/9)"})
    more = equations.with_tables([ratio, drag])
    assert bg.linearize(more, {"v": 2, "t": 2}, laws={"b": "ratio(v/9)"}).J[0, 0] == -sp.Rational(
        1, 9
    ) * sp.diff(ratio(v), v).subs(v, sp.Rational(2, 9))
    assert equations.tables == (drag,)
    with pytest.raises(bg.TableError, match="two tables 'drag'"):
        equations.with_tables([bg.LookupTable("drag", [0, 1], [0, 1])])


def test_friction_is_told_the_tables_of_its_texts() -> None:
    stribeck = bg.LookupTable("stribeck", [0, 1], [2, 1])
    friction = bg.DryFriction("N*drag(x)", "stribeck(slip)", tables=[drag, stribeck])
    assert friction.level == sp.Symbol("N") * drag("x")
    assert friction.breakaway == stribeck(0)
    with pytest.raises(bg.ExpressionError, match=r"is below the curve at standstill"):
        bg.DryFriction(1, "stribeck(slip)", 1, tables=[stribeck])
    with pytest.raises(bg.ExpressionError, match="would drive the slip"):
        bg.DryFriction(1, bg.LookupTable("down", [0, 1], [-2, 1])("slip"))
    with pytest.raises(bg.ExpressionError, match="'stribeck' is not a function"):
        bg.DryFriction(1, "stribeck(slip)")


@pytest.mark.parametrize(
    ("given", "says"),
    [("drag", "must be a list of LookupTable"), ({"drag": drag}, "must be a list of LookupTable"),
     ([drag, "ratio"], "is no LookupTable"),
     ([drag, bg.LookupTable("drag", [0, 1], [0, 1])], "two tables 'drag'")],
)  # fmt: skip
def test_what_is_no_list_of_tables_is_refused(given: object, says: str) -> None:
    graph = _graph()
    graph.graph["tables"] = given
    with pytest.raises(bg.TableError, match=says):
        bg.validate(graph)


def test_one_table_needs_no_list() -> None:
    graph = _graph()
    graph.graph["tables"] = drag
    assert bg.derive(graph).tables == (drag,)


def test_parts_share_their_tables() -> None:
    part = _graph(drag)
    left, right = bg.prefixed(part, "left_"), bg.prefixed(part, "right_", parameters=True)
    between = bond_graph(
        [("left_n", {}), ("right_n", {}), bg.Zero("z"), bg.R("r", 1)], "left_n>z>right_n z>r"
    )
    whole = bg.assemble(left, right, between)
    assert whole.graph["tables"] == [drag]
    equations = bg.derive(whole)
    assert equations.laws["left_b"].expression == sp.Symbol("b") * drag("left_v")
    assert equations.laws["right_b"].expression == sp.Symbol("right_b") * drag("right_v")


def test_parts_with_two_tables_of_one_name_are_refused() -> None:
    other = bg.prefixed(_graph(bg.LookupTable("drag", [0, 1], [0, 1])), "other_")
    with pytest.raises(bg.TableError, match="two tables 'drag'"):
        bg.assemble(_graph(drag), other)


def test_a_ratio_by_a_table_is_known_not_to_vanish() -> None:
    """A dependent mass behind it is no reason to refuse: between its points a line has no other values."""
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J", "J", flow="w"), bg.Df("angle", integrate="phi"),
             bg.TF("g", "ratio(phi)"), bg.One("b"), bg.I("m", "m", priority=-1)]  # fmt: skip
    graph = bond_graph(nodes, "T>a>J a>angle a>g>b>m")
    graph.graph["tables"] = [ratio]
    J, m = sp.symbols("J m")
    assert bg.derive(graph).A[0, 0].equals(J + m * ratio(phi) ** 2) is not False

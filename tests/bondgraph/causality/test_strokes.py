"""Strokes that spread, contradict, and are taken back."""

from references.alsd import alsd_graph
from references.build import Graph, bond_graph

import bondgraph as bg
from bondgraph.causality.record import Contradiction, Reason
from bondgraph.causality.strokes import StrokeSearch


def _strokes(graph: Graph) -> StrokeSearch:
    return StrokeSearch(bg.validate(graph))


def _set(strokes: StrokeSearch, name: str, gives: str) -> Contradiction | None:
    node = strokes.names.index(name)
    return strokes.assign(
        strokes.at[node][0], strokes.end_for(node, gives), Reason(node, "chooses")
    )


def _ends(strokes: StrokeSearch) -> dict[str, str | None]:
    return {
        f"{strokes.names[tail]}>{strokes.names[head]}": None if end is None else strokes.names[end]
        for (tail, head), end in zip(strokes.bonds, strokes.end, strict=True)
    }


def test_one_stroke_forces_others() -> None:
    nodes = [
        bg.Se("s", "u"),
        bg.TF("t", 2),
        bg.Zero("z"),
        bg.C("c", 1),
        bg.GY("g", 1),
        bg.I("m", 1),
    ]
    strokes = _strokes(bond_graph(nodes, "s>t>z>c z>g>m"))
    assert _set(strokes, "s", "effort") is None
    assert _ends(strokes) == {"s>t": "t", "t>z": "z", "z>c": "c", "z>g": "g", "g>m": "g"}


def test_contradiction_names_the_node_whose_rule_breaks() -> None:
    nodes = [bg.Zero("z"), bg.C("a", 1), bg.C("b", 1), bg.C("c", 1)]
    strokes = _strokes(bond_graph(nodes, "z>a z>b z>c"))
    assert _set(strokes, "a", "flow") is None
    assert _set(strokes, "b", "flow") is None
    assert set(_ends(strokes).values()) == {"a", "b", "z"}
    conflict = _set(strokes, "c", "flow")
    assert conflict is not None
    assert strokes.names[conflict.node] == "c"


def test_undone_trial_leaves_no_trace() -> None:
    strokes = _strokes(alsd_graph())
    assert _set(strokes, "engine", "effort") is None
    before, length = _ends(strokes), len(strokes.trail)
    assert _set(strokes, "I_w1", "flow") is None
    assert _set(strokes, "I_w2", "flow") is None
    assert _ends(strokes) != before
    strokes.undo(length)
    assert _ends(strokes) == before
    assert _set(strokes, "I_i", "flow") is None
    assert _set(strokes, "I_w2", "flow") is None
    assert strokes.gives(strokes.names.index("I_w1")) == "effort"

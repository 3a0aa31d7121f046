"""`validate`: what is not a bond graph is refused, with the node's or bond's name."""

import networkx as nx
import pytest
import sympy as sp
from references.alsd import alsd_graph
from references.build import Graph, bond_graph

import bondgraph as bg


def _mass(*nodes: tuple, bonds: str = "", **replace: dict[str, object]) -> Graph:
    """A force on a mass; more nodes and bonds; ``j``, ``m``, ``s``: attributes put in place."""
    graph = bond_graph([bg.Se("s", "u"), bg.One("j"), bg.I("m", "m"), *nodes], f"s>j>m {bonds}")
    for name, attributes in replace.items():
        graph.nodes[name].clear()
        graph.nodes[name].update(attributes)
    return graph


def _with_edge(graph: Graph, tail: object, head: object, **attributes: object) -> Graph:
    graph.add_edge(tail, head, **attributes)
    return graph


POSITIVE = sp.Symbol("m", positive=True)

BAD = {
    "no graph": (None, "networkx.DiGraph.*not a NoneType"),
    "undirected": (nx.Graph(alsd_graph()), "networkx.DiGraph.*not a Graph"),
    "multigraph": (nx.MultiDiGraph(alsd_graph()), "networkx.DiGraph.*not a MultiDiGraph"),
    "empty": (nx.DiGraph(), "no nodes"),
    "self-loop": (_with_edge(_mass(), "j", "j"), "'j' is bonded to itself"),
    "both ways": (_with_edge(_mass(), "m", "j"), "'j' and 'm' are bonded both ways"),
    "bond attribute": (_with_edge(_mass(), "j", "m", weight=1), "'j' -> 'm'.*'weight'"),
    "undeclared node": (_with_edge(_mass(), "j", "ghost"), "'ghost' has no kind"),
    "no kind": (_mass(m={"value": "m"}), "'m' has no kind"),
    "unknown kind": (_mass(m={"kind": "Inertia", "value": "m"}), "'m'.*unknown kind 'Inertia'"),
    "kind in lower case": (_mass(j={"kind": "one"}), "'j'.*unknown kind 'one'"),
    "kind of another type": (_mass(j={"kind": []}), r"'j'.*unknown kind \[\]"),
    "typo in a key": (_mass(m={"kind": "I", "valeu": "m"}), "'m'.*unknown attribute 'valeu'"),
    "key of another kind": (_mass(j={"kind": "One", "effort": "e"}), "'j'.*attribute 'effort'"),
    "value on a junction": (_mass(j={"kind": "One", "value": 1}), "'j'.*attribute 'value'"),
    "law on a source": (_mass(s={"kind": "Se", "value": "u", "law": "1"}), "'s'.*'law'"),
    "missing value": (_mass(m={"kind": "I"}), "'m' has no value"),
    "source without value": (_mass(s={"kind": "Se"}), "'s' has no value"),
    "transformer without value": (
        bond_graph([bg.Se("s", "u"), ("g", {"kind": "TF"}), bg.I("m", "m")], "s>g>m"),
        "'g' has no value",
    ),
    "value and law": (_mass(m={"kind": "I", "value": "m", "law": "p_m"}), "'m' has both"),
    "storage of zero": (_mass(m={"kind": "I", "value": 0}), "'m': its value is zero"),
    "storage of hidden zero": (_mass(m={"kind": "I", "value": "a - a"}), "'m': its value is zero"),
    "storage of zero by identity": (
        _mass(m={"kind": "I", "value": "(a + b)**2 - a**2 - 2*a*b - b**2"}),
        "'m': its value is zero",
    ),
    "modulus of zero": (
        bond_graph([bg.Se("s", "u"), bg.TF("g", 0.0), bg.I("m", "m")], "s>g>m"),
        "'g': its value is zero",
    ),
    "gyrator of zero": (
        bond_graph([bg.Se("s", "u"), bg.GY("g", "0"), bg.I("m", "m")], "s>g>m"),
        "'g': its value is zero",
    ),
    "value named as its flow": (
        _mass(m={"kind": "I", "value": "w", "flow": "w"}),
        "'m': its value is w, the name of its own variable",
    ),
    "value not a number": (_mass(m={"kind": "I", "value": float("nan")}), "'m': nan"),
    "value of another type": (_mass(m={"kind": "I", "value": [1]}), r"'m': \[1\]"),
    "value that calls": (_mass(m={"kind": "I", "value": "open('f')"}), "'m': 'open'"),
    "bond missing": (_mass(bg.I("n", "n")), "I 'n' has 0 bonds; it needs exactly one"),
    "junction alone": (_mass(bg.One("k")), "junction 'k' has no bonds"),
    "two bonds at a source": (_mass(bg.Zero("z"), bonds="s>z"), "Se 's' has 2 bonds.*one"),
    "two bonds at a storage": (_mass(bg.Zero("z"), bonds="m>z"), "I 'm' has 2 bonds.*junction"),
    "one bond at a transformer": (_mass(bg.TF("g", 2), bonds="j>g"), "TF 'g' has 1 .* in and 0 out"),
    "two bonds into a gyrator": (
        _mass(bg.GY("g", 2), bg.C("c", 1), bonds="j>g c>g"), "GY 'g' has 2 .* in and 0 out",
    ),
    "name that cannot be a symbol": (
        _with_edge(_mass(bg.R("brake 1")), "j", "brake 1"),
        "'brake 1'.*cannot be a symbol.*rename",
    ),
    "name of another type": (nx.relabel_nodes(_mass(), {"m": (1, 2)}), r"\(1, 2\).*a text or an int"),
    "name that is a truth value": (nx.relabel_nodes(_mass(), {"m": True}), "True.*a text or an int"),
    "flow that cannot be a symbol": (
        _mass(m={"kind": "I", "value": "m", "flow": "2w"}), "'m', flow: '2w' cannot be a symbol",
    ),
    "flow that is a keyword": (
        _mass(m={"kind": "I", "value": "m", "flow": "lambda"}), "'m', flow: 'lambda' cannot",
    ),
    "flow of another type": (_mass(m={"kind": "I", "value": "m", "flow": 5}), "'m', flow: 5 cannot"),
    "name of the time": (_mass(m={"kind": "I", "value": "m", "flow": "t"}), "'m': 't' is the time"),
    "priority": (_mass(m={"kind": "I", "value": "m", "priority": "high"}), "'m', priority: 'high'"),
    "priority not a number": (
        _mass(m={"kind": "I", "value": "m", "priority": float("nan")}), "'m', priority: nan",
    ),
    "gives": (_mass(bg.R("p", gives="torque"), bonds="j>p"), "'p': gives is 'torque'"),
    "gives of a resistance": (
        _mass(bg.R("p", "r", gives="flow"), bonds="j>p"), "'p': gives is for open ports",
    ),
    "unit": (_mass(m={"kind": "I", "value": "m", "unit": 1}), "'m': unit 1"),
    "a curve that falls where friction gives its flow": (
        _mass(bg.R("p", law=bg.DryFriction("mu", "1 + exp(-slip)"), gives="flow"), bonds="j>p"),
        "'p', law: dry friction that gives a flow .* has one level.*needs an inertia between",
    ),
    "a breakaway where friction gives its flow": (
        _mass(bg.R("p", law=bg.DryFriction("mu", 1, "3/2"), gives="flow"), bonds="j>p"),
        "'p', law: dry friction that gives a flow .* has one level",
    ),
    "friction on a storage": (_mass(m={"kind": "I", "law": bg.DryFriction("mu")}), "'m', law.*p_m"),
    "law of another type": (_mass(bg.R("p", law=[1]), bonds="j>p"), r"'p', law: \[1\]"),
    "assumptions": (
        _mass(bg.R("p", "m"), bonds="j>p", m={"kind": "I", "value": POSITIVE}),
        "'p': the symbol m is used elsewhere with different assumptions",
    ),
    "assumptions in a law": (
        _mass(bg.R("p", law=POSITIVE * sp.Symbol("f_p")), bonds="j>p"),
        "'p': the symbol m is used elsewhere with different assumptions",
    ),
    "assumptions of an input": (
        _mass(s={"kind": "Se", "value": sp.Symbol("u", real=True)}), "'s': the input u",
    ),
    "parts": (
        nx.union(_mass(), _mass(s={"kind": "Se", "value": "w"}), rename=("a_", "b_")),
        "'a_s'.*'b_s' share neither a bond nor a signal",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_graph_is_refused(name: str) -> None:
    graph, message = BAD[name]
    with pytest.raises(bg.StructureError, match=message):
        bg.validate(graph)
    with pytest.raises(bg.StructureError, match=message):
        bg.derive(graph)

"""Resistances with several ports, each with a law: what makes heat, what turns three phases into one."""

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Step, simulator

LAWS = {"rod": "d*f_b_rod", "heat": "-d*f_b_rod**2/e_b_heat"}


def _damper(**more: object) -> nx.DiGraph:
    told = {"ports": ["rod", "heat"], "law": LAWS, "gives": {"heat": "flow"}, **more}
    nodes = [bg.One("rod"), bg.I("m", "m", flow="v"), bg.R("b", **told), bg.Zero("warm"),
             bg.C("body", law="T_0*exp(q_body/c)", effort="T")]  # fmt: skip
    graph = bond_graph(nodes, "rod>m warm>body")
    graph.add_edge("rod", "b", port="rod")
    graph.add_edge("warm", "b", port="heat")
    return graph


def test_what_a_damper_takes_warms_a_body_through_its_own_port() -> None:
    """First law: ``m v^2/2 + c T`` stays; second: entropy only grows."""
    run = simulator(bg.derive(_damper()), {"m": 2, "d": 3, "T_0": 300, "c": 5}).run(
        np.linspace(0, 2, 41), {"v": 10}
    )
    assert run["v"] == pytest.approx(10 * np.exp(-1.5 * run.time), rel=1e-8)
    assert run["v"] ** 2 + 5 * run["T"] == pytest.approx(np.full(41, 1600.0), rel=1e-10)
    assert (np.diff(run["q_body"]) > 0).all()
    assert abs(run.audit().residual) < 1e-9 * run.audit().turned_over


def test_three_phases_in_mixed_causality_feed_one_rail() -> None:
    """A bridge by its averages: two ports give efforts, one a flow; its power balances at every instant.

    With e_a = d_a U, e_b = d_b U and f_dc = d_a i_a + d_b i_b it passes on all that it takes.
    """
    laws = {"a": "d_a*e_x_dc", "b": "d_b*e_x_dc", "dc": "-(d_a*f_x_a + d_b*f_x_b)"}
    nodes = [bg.Se("u", "u"), bg.One("a"), bg.I("L_a", "L", flow="i_a"), bg.One("b"), bg.R("load", "r"),
             bg.I("L_b", "L", flow="i_b"), bg.Zero("dc"), bg.C("rail", "C", effort="U"),
             bg.R("x", ports=["a", "b", "dc"], law=laws, gives={"dc": "flow"})]  # fmt: skip
    graph = bond_graph(nodes, "u>a>L_a b>L_b b>load dc>rail")
    for port in ("a", "b", "dc"):
        graph.add_edge(port, "x", port=port)
    numbers = {"L": 0.1, "r": 2.0, "C": 0.5, "d_a": 0.6, "d_b": -0.4}
    run = simulator(bg.derive(graph), numbers).run(
        np.linspace(0, 1, 21), inputs={"u": Step(0.1, 5)}
    )
    total = run.power("x.a") + run.power("x.b") + run.power("x.dc")
    assert np.abs(total).max() < 1e-12 * np.abs(run.power("x.a")).max()
    assert run["U"][-1] > 0.1


def test_files_and_parts_keep_the_laws_of_ports() -> None:
    declared = _damper(law={**LAWS, "rod": bg.DryFriction("N")})
    equations = bg.derive(declared)
    for again in (bg.from_json(bg.to_json(declared)), bg.from_graphml(bg.to_graphml(declared))):
        assert bg.derive(again).laws == equations.laws
    part = bg.prefixed(_damper(), "left_", parameters=["d"])
    told = {port: str(law) for port, law in part.nodes["left_b"]["law"].items()}
    assert told == {
        "rod": "f_left_b_rod*left_d", "heat": "-f_left_b_rod**2*left_d/e_left_b_heat",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"law": {"rod": "f_b_rod"}}, "no law at port 'heat'; each port needs one"),
        (
            {"law": {**LAWS, "haet": 1}},
            r"law: there is no port 'haet' \(did you mean 'heat'\?\); there are",
        ),
        ({"gives": {"hot": "flow"}}, "gives: there is no port 'hot'"),
        ({"gives": "flow"}, "with ports, gives maps ports to effort or flow, not 'flow'"),
        ({"gives": {"heat": "heat"}}, "gives is 'heat'; it must be 'effort' or 'flow'"),
        ({"value": [[1, 0], [0, 1]]}, "it has both a law and a value; give one of them"),
        ({"law": {**LAWS, "rod": "d*"}}, "node 'b.rod', law: .* is not an expression"),
    ],
)
def test_what_is_no_law_of_ports_is_refused(more: dict[str, object], message: str) -> None:
    with pytest.raises(bg.BondGraphError, match=message):
        bg.derive(_damper(**more))

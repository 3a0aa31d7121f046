"""The active limited slip differential: its bond graph written by hand, and Appendix B typed in.

Deur, Hancock, Assadian, "Modeling of Active Differential Dynamics", IMECE2008-69248, Fig. 7a.
"""

from __future__ import annotations

import networkx as nx
import sympy as sp

import bondgraph as bg

from .build import bond_graph

BONDS = (
    "engine>input>final_drive>case>halves>sum input>I_i sum>left sum>right left>I_w1 right>I_w2 "
    "case>slip>clutch slip>right left>tire_1 right>tire_2"
)


def alsd_graph() -> nx.DiGraph:
    """Fig. 7a: the passive differential, and the clutch between the case and the right output."""
    nodes = [
        bg.Se("engine", "tau_e"),
        bg.One("input"),
        bg.I("I_i", "I_i", priority=-1),
        bg.TF("final_drive", "1/i"),
        bg.One("case"),
        bg.TF("halves", 2),
        bg.Zero("sum"),
        bg.One("left"),
        bg.One("right"),
        bg.I("I_w1", "I_w1", flow="omega_1"),
        bg.I("I_w2", "I_w2", flow="omega_2"),
        bg.Zero("slip"),
        bg.R("clutch", effort="tau_f", flow="omega_f"),
        bg.R("tire_1", effort="tau_t1", flow="omega_t1"),
        bg.R("tire_2", effort="tau_t2", flow="omega_t2"),
    ]
    return bond_graph(nodes, BONDS)


def plain_graph() -> nx.DiGraph:
    """The same declared with networkx alone."""
    graph: nx.DiGraph = nx.DiGraph()
    graph.add_node("engine", kind="Se", value="tau_e")
    graph.add_node("input", kind="One")
    graph.add_node("I_i", kind="I", value="I_i", priority=-1)
    graph.add_node("final_drive", kind="TF", value="1/i")
    graph.add_node("case", kind="One")
    graph.add_node("halves", kind="TF", value=2)
    graph.add_node("sum", kind="Zero")
    graph.add_node("left", kind="One")
    graph.add_node("right", kind="One")
    graph.add_node("I_w1", kind="I", value="I_w1", flow="omega_1")
    graph.add_node("I_w2", kind="I", value="I_w2", flow="omega_2")
    graph.add_node("slip", kind="Zero")
    graph.add_node("clutch", kind="R", effort="tau_f", flow="omega_f")
    graph.add_node("tire_1", kind="R", effort="tau_t1", flow="omega_t1")
    graph.add_node("tire_2", kind="R", effort="tau_t2", flow="omega_t2")
    for path in BONDS.split():
        nx.add_path(graph, path.split(">"))
    return graph


STATES = sp.symbols("omega_1 omega_2")
INPUTS = sp.symbols("tau_e tau_f tau_t1 tau_t2")
OUTPUTS = sp.symbols("omega_f,")

_i, _I_i, _I_w1, _I_w2 = sp.symbols("i I_i I_w1 I_w2")
_a = _i**2 * _I_i / 4
_half = sp.Rational(1, 2)

#: Appendix B, first model; I_i and I_w1, I_w2 stand for the lumped I_i*, I_w1*, I_w2*.
A = sp.Matrix([[_I_w1 + _a, _a], [_a, _I_w2 + _a]])
B = sp.Matrix([[_i / 2, -_half, -1, 0], [_i / 2, _half, 0, -1]])
F = sp.Matrix([[_half, -_half]])

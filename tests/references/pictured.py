"""Graphs whose pictures have signals: modulated elements, parts without bonds between, fields, chains."""

import random
from collections.abc import Callable
from types import MappingProxyType
from typing import Any

import networkx as nx

import bondgraph as bg
from references.random_graphs import random_graph


def made(nodes: list[Any], bonds: list[Any]) -> Any:
    """A graph of these nodes and bonds."""
    graph: Any = nx.DiGraph()
    graph.add_nodes_from(nodes)
    graph.add_edges_from(bonds)
    return graph


def prey_and_predators() -> Any:
    """Two populations (Lotka, Volterra) that no bond joins: what is eaten reads both."""
    return made(
        [bg.Zero("x"), bg.C("X", 1, effort="x"), bg.Sf("eaten", "beta*x*y"),
         bg.Zero("y"), bg.C("Y", 1, effort="y"), bg.Sf("growth", "delta*x*y")],
        [("x", "X"), ("x", "eaten"), ("growth", "y"), ("y", "Y")],
    )  # fmt: skip


def pendulum() -> Any:
    """A weight on a rod: transformers that its angle modulates (Karnopp, Margolis, Rosenberg)."""
    return made(
        [bg.One("turn"), bg.I("J", "J", flow="omega"), bg.Df("angle", integrate="theta"),
         bg.TF("x", "l*cos(theta)"), bg.TF("y", "l*sin(theta)"), bg.One("vx"), bg.One("vy"),
         bg.R("drag", "b"), bg.Se("weight", "-m*g"), bg.I("m_y", "m", priority=-1)],
        [("turn", "J"), ("turn", "angle"), ("turn", "x"), ("turn", "y"), ("x", "vx"), ("vx", "drag"),
         ("y", "vy"), ("weight", "vy"), ("vy", "m_y")],
    )  # fmt: skip


def excited_motor() -> Any:
    """A motor whose field current, in a part of its own, is its gyrator's modulus."""
    return made(
        [bg.Se("u", "U"), bg.One("arm"), bg.R("Ra", "R_a"), bg.I("La", "L_a"),
         bg.GY("machine", "K*i_f"), bg.One("shaft"), bg.I("J", "J"), bg.R("b", "b*(1 + t)"),
         bg.Se("uf", "U_f"), bg.One("coil", flow="i_f"), bg.R("Rf", "R_f"), bg.I("Lf", "L_f")],
        [("u", "arm"), ("arm", "Ra"), ("arm", "La"), ("arm", "machine"), ("machine", "shaft"),
         ("shaft", "J"), ("shaft", "b"), ("uf", "coil"), ("coil", "Rf"), ("coil", "Lf")],
    )  # fmt: skip


def servo() -> Any:
    """A four way valve whose spool is a part of its own, a cylinder, and the way back of its place."""
    edges = {"PA": "+", "PB": "-", "AT": "-", "BT": "+"}
    valves = [
        bg.R(f"valve_{at}", law=f"k*(x_0 {sign} x)*sign(e_valve_{at})*sqrt(abs(e_valve_{at}))", gives="flow")
        for at, sign in edges.items()
    ]  # fmt: skip
    return made(
        [bg.Se("supply", "p_s"), bg.Zero("P"), *map(bg.One, edges), *valves, bg.Zero("A"), bg.Zero("B"),
         bg.C("chamber_A", "V/beta"), bg.C("chamber_B", "V/beta"), bg.Zero("T"), bg.Se("tank", "p_t"),
         bg.TF("area_A", "S"), bg.TF("area_B", "1/S"), bg.One("piston"), bg.I("mass", "m", flow="v"),
         bg.R("friction", "b"), bg.Se("load", "F_L"), bg.Df("position", integrate="y"),
         bg.Se("drive", "k_p*(r - y)"), bg.One("spool"), bg.I("m_s", "m_s"), bg.R("b_s", "b_s"),
         bg.C("spring", "1/k_s"), bg.Df("spool_place", integrate="x")],
        [("supply", "P"), ("P", "PA"), ("P", "PB"), *((at, f"valve_{at}") for at in edges), ("PA", "A"),
         ("PB", "B"), ("A", "AT"), ("B", "BT"), ("AT", "T"), ("BT", "T"), ("T", "tank"),
         ("A", "chamber_A"), ("B", "chamber_B"), ("A", "area_A"), ("area_A", "piston"),
         ("piston", "area_B"), ("area_B", "B"), ("piston", "mass"), ("piston", "friction"),
         ("load", "piston"), ("piston", "position"), ("drive", "spool"), ("spool", "m_s"),
         ("spool", "b_s"), ("spool", "spring"), ("spool", "spool_place")],
    )  # fmt: skip


def amplifier() -> Any:
    """An inverting amplifier: its source reads what a detector tells of its input."""
    return made(
        [bg.Se("in", "u"), bg.One("i_1"), bg.R("R_1", "R_1"), bg.Zero("minus"), bg.De("diff", effort="v_m"),
         bg.C("C_i", "C_i"), bg.One("i_2"), bg.R("R_2", "R_2"), bg.Zero("out"), bg.C("load", "C_l"),
         bg.One("i_o"), bg.R("R_o", "R_o"), bg.Se("amp", "-A*v_m")],
        [("in", "i_1"), ("i_1", "R_1"), ("i_1", "minus"), ("minus", "diff"), ("minus", "C_i"),
         ("minus", "i_2"), ("i_2", "R_2"), ("i_2", "out"), ("out", "load"), ("amp", "i_o"),
         ("i_o", "R_o"), ("i_o", "out")],
    )  # fmt: skip


def coupled_coils() -> Any:
    """Two circuits that a field of inertias joins."""
    return made(
        [bg.Se("u_1", "u_1"), bg.Se("u_2", "u_2"), bg.One("a"), bg.One("b"), bg.R("R_a", "R_a"),
         bg.R("R_b", "R_b"),
         bg.I("coils", [["L_1", "M"], ["M", "L_2"]], ports=["primary", "secondary"])],
        [("u_1", "a"), ("u_2", "b"), ("a", "R_a"), ("b", "R_b"), ("a", "coils", {"port": "primary"}),
         ("b", "coils", {"port": "secondary"})],
    )  # fmt: skip


def reaction() -> Any:
    """A + B to C, the rate of a resistance of two ports (Oster, Perelson, Katchalsky)."""
    rate = "kappa*(exp(e_re_forward/RT) - exp(-e_re_reverse/RT))"
    return made(
        [*(bg.Zero(s) for s in "ABC"), *(bg.C(f"c_{s}", law=f"RT*log(K_{s}*q_c_{s})") for s in "ABC"),
         bg.One("left"), bg.One("right"),
         bg.R("re", ports=["forward", "reverse"], law={"forward": rate, "reverse": rate},
              gives={"forward": "flow", "reverse": "flow"})],
        [*((s, f"c_{s}") for s in "ABC"), ("A", "left"), ("B", "left"), ("right", "C"),
         ("left", "re", {"port": "forward"}), ("right", "re", {"port": "reverse"})],
    )  # fmt: skip


def relay() -> Any:
    """A switch that a far voltage opens, a diode, a sensor."""
    return made(
        [bg.Se("battery", "E"), bg.One("wire"), bg.Sw("key", on="gate - v_c"), bg.R("r", "R"),
         bg.Zero("node"), bg.C("cap", "C", effort="v_c"), bg.One("free"), bg.Diode("d"),
         bg.I("L", "L", flow="i_L"), bg.Df("sensor")],
        [("battery", "wire"), ("wire", "key"), ("wire", "r"), ("wire", "node"), ("node", "cap"),
         ("node", "free"), ("free", "d"), ("free", "L"), ("free", "sensor")],
    )  # fmt: skip


def masses(count: int = 10) -> Any:
    """Masses joined by springs; a brake on the first reads the last, and so does what drives it."""
    nodes: list[Any] = [bg.Se("drive", "k*(r - s)"), bg.R("brake", law="b*f_brake*abs(w)"),
                        bg.Df("odometer", integrate="s")]  # fmt: skip
    bonds: list[Any] = [("drive", "v_1"), ("v_1", "brake"), (f"v_{count}", "odometer")]
    for at in range(1, count + 1):
        named = {"flow": "w"} if at == count else {}
        nodes += [bg.One(f"v_{at}"), bg.I(f"m_{at}", f"m_{at}", **named)]
        bonds += [(f"v_{at}", f"m_{at}")]
        if at < count:
            nodes += [bg.Zero(f"f_{at}"), bg.C(f"k_{at}", f"1/k_{at}")]
            bonds += [(f"v_{at}", f"f_{at}"), (f"f_{at}", f"k_{at}"), (f"f_{at}", f"v_{at + 1}")]
    return made(nodes, bonds)


def crowded() -> Any:
    """A junction with bonds all round it whose flow two elements read."""
    return made(
        [bg.Se("s", "u"), bg.One("j", flow="w"), bg.R("r", "b"), bg.I("i", "J"), bg.C("c", "C"),
         bg.Zero("z", effort="p"), bg.R("q", "Q*(1 + w**2)"), bg.Sw("k", on="p - w"), bg.R("n", "N")],
        [("s", "j"), ("j", "r"), ("j", "i"), ("j", "c"), ("j", "z"), ("z", "q"), ("j", "k"), ("z", "n")],
    )  # fmt: skip


def ring_of_pools(count: int = 6) -> Any:
    """Pools that no bonds join, each made by what its neighbour and one across have."""
    nodes: list[Any] = []
    bonds: list[Any] = []
    for at in range(count):
        near, far = (at + count - 1) % count, (at + count // 2) % count
        nodes += [bg.Sf(f"make{at}", f"k*c_{near} - d*c_{at}*c_{far}"), bg.Zero(f"pool{at}"),
                  bg.C(f"C{at}", f"V_{at}", effort=f"c_{at}")]  # fmt: skip
        bonds += [(f"make{at}", f"pool{at}"), (f"pool{at}", f"C{at}")]
    return made(nodes, bonds)


PICTURED: "MappingProxyType[str, Callable[[], Any]]" = MappingProxyType({
    make.__name__: make
    for make in (prey_and_predators, pendulum, excited_motor, servo, amplifier, coupled_coils, reaction,
                 relay, masses, crowded, ring_of_pools)
})  # fmt: skip
"""By their names."""


def modulated(seed: int) -> Any:
    """A random graph some of whose values read flows of its inertias, wherever these are."""
    dice = random.Random(seed)
    graph = random_graph(dice, 6 + seed % 20, mesh=0.6 if seed % 2 else 0.0)
    flows = []
    for name, told in graph.nodes(data=True):
        if told["kind"] == "I" and told.get("value") is not None and not told.get("ports"):
            told.setdefault("flow", f"w_{name}")
            flows.append(told["flow"])
    for _, told in graph.nodes(data=True):
        valued = told.get("value") is not None and not told.get("ports")
        if flows and valued and told["kind"] in ("TF", "GY", "R") and dice.random() < 0.4:
            told["value"] = f"({told['value']})*(1 + {dice.choice(flows)}**2)"
    return graph

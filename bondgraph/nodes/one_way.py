"""Constructors of switches that let flow or effort through one way only: diode, check valve, freewheel."""

from collections.abc import Hashable

from bondgraph.nodes.elements import Node, Sw


def Diode(name: Hashable, effort: object = None, flow: object = None) -> Node:
    """An ideal diode, a `Sw`: flow passes it in its bond's direction without effort, none against it.

    On, its flow is not negative and its effort zero; off, its effort is not positive and its flow zero.
    ``effort`` and ``flow`` name its variables, else ``e_<name>`` and ``f_<name>``.

    Raises nothing: `validate` looks at nodes.

    >>> Diode("d")
    ('d', {'kind': 'Sw', 'on': 'e_d', 'off': '-f_d'})
    """
    own_effort, own_flow = _own(name, effort, flow)
    return Sw(name, on=own_effort, off=f"-{own_flow}", effort=effort, flow=flow)


def CheckValve(name: Hashable, effort: object = None, flow: object = None) -> Node:
    """An ideal check valve, which is a `Diode`: open in its bond's direction, shut against it.

    Raises nothing: `validate` looks at nodes.

    >>> CheckValve("v", flow="Q") == Diode("v", flow="Q")
    True
    """
    return Diode(name, effort, flow)


def Freewheel(name: Hashable, effort: object = None, flow: object = None) -> Node:
    """An ideal freewheel (overrunning clutch), a `Sw`: it holds in its bond's direction, free against it.

    Raises nothing: `validate` looks at nodes.

    Off, it is locked: its flow is zero and its effort not negative. On, it runs free: its effort is zero
    and its flow not positive. Between two shafts it lets the first drive the second, not be driven by it:

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([
    ...     bg.One("hub"), bg.I("J_1", "J_1", flow="w_1"), bg.Zero("between"), Freewheel("fw"),
    ...     bg.One("wheel"), bg.I("J_2", "J_2", flow="w_2")])
    >>> nx.add_path(g, ["hub", "between", "wheel"])
    >>> g.add_edges_from([("hub", "J_1"), ("between", "fw"), ("wheel", "J_2")])
    >>> bg.derive(g, outputs=["fw"]).F  # w_1 - w_2, never positive
    Matrix([[1, -1]])
    """
    own_effort, own_flow = _own(name, effort, flow)
    return Sw(name, on=f"-{own_effort}", off=own_flow, effort=effort, flow=flow)


def _own(name: Hashable, effort: object, flow: object) -> tuple[object, object]:
    """What the switch's effort and flow are called."""
    return f"e_{name}" if effort is None else effort, f"f_{name}" if flow is None else flow

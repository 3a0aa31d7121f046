"""Switches and controlled junctions: which there are, and a graph without them for each of its modes."""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import replace
from typing import Any

import networkx as nx
import sympy as sp

from bondgraph.declare.validate import validate, with_elements
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Element, Switch
from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.laws import ExpressionLaw


def switches(graph: Any) -> tuple[Switch, ...]:
    """When each switch and each controlled junction of a graph changes over, in declaration order.

    Those by which state machines take transitions are none of these.

    Raises what `validate` raises.

    >>> import networkx as nx
    >>> from bondgraph.nodes.elements import One, Se, Sw
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([Se("battery", "E"), One("wire"), Sw("key", on="gate")])
    >>> nx.add_path(g, ["battery", "wire", "key"])
    >>> [(switch.name, switch.on, switch.off) for switch in switches(g)]
    [('key', gate, -gate)]
    """
    found = (element.switch for element in _elements(validate(graph)) if element.switch)
    return tuple(one for one in found if one.transition is None)


def in_mode(graph: Any, on: Iterable[Hashable] = ()) -> "nx.DiGraph[Hashable]":
    """The graph in one mode: the switches and controlled junctions in ``on`` are on, the others off.

    A switch that is on gives zero effort, one that is off zero flow; so each mode has a causality and
    equations of its own, with fewer states where a switch binds some. The names of efforts and flows are
    the same in all modes. The equations that hold for all modes are those of the graph as it stands.

    Raises `StructureError` for a name that is neither a switch nor a controlled junction.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("battery", "E"), bg.One("wire"), bg.Sw("key", on="gate"), bg.C("cap", "C")])
    >>> g.add_edges_from([("battery", "wire"), ("wire", "key"), ("wire", "cap")])
    >>> open_circuit, charging = bg.derive(bg.in_mode(g)), bg.derive(bg.in_mode(g, on=["key"]))
    >>> open_circuit.states, charging.states, [str(port.given) for port in open_circuit.ports]
    ((e_cap,), (), ['E', 'f_key'])
    """
    checked = validate(graph)
    chosen = checked_modes([switch.name for switch in switches(checked)], on)
    settled = {
        element.name: _settled(element, element.switch, element.switch.name in chosen)
        for element in _elements(checked)
        if element.switch is not None and element.switch.transition is None
    }
    return with_elements(checked, settled)


def checked_modes(known: Sequence[Hashable], on: Any) -> frozenset[Hashable]:
    """The switches that are told to be on; `StructureError` for others than the ``known``."""
    if isinstance(on, str) or not isinstance(on, Iterable):
        raise StructureError(f"on must be a list of switches, not {on!r}")
    chosen = list(on)
    for name in chosen:
        if name not in known:
            listed = ", ".join(map(repr, known)) or "none"
            raise StructureError(f"{name!r} is no switch of this graph; there are {listed}")
    return frozenset(chosen)


def _elements(graph: "nx.DiGraph[Hashable]") -> list[Element]:
    return [graph.nodes[name]["element"] for name in graph]


def _settled(element: Element, switch: Switch, on: bool) -> Element:
    """What is left of a switch in one mode: a port that gives zero."""
    other = "flow" if switch.gives == "effort" else "effort"
    gives = switch.gives if on else other
    return replace(
        element, kind=Kind.R, gives=gives, law=ExpressionLaw(sp.Integer(0)), switch=None
    )  # fmt: skip

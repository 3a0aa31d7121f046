"""Parts of drivelines as small bond graphs that share terminals: 1-junctions called by their shafts.

A part is a graph that mentions its terminals by name only; `assemble` puts parts together, in order.
The order of the parts is the order of states and inputs.
"""

from collections.abc import Hashable
from typing import TypeAlias

import networkx as nx

import bondgraph as bg
from bondgraph.elements import Node

Part: TypeAlias = "nx.DiGraph[Hashable]"
"""A bond graph whose terminals may still lack their attributes."""


def assemble(*parts: Part) -> Part:
    """One graph of all parts. Terminals of one name are one shaft.

    Raises `StructureError` if two parts declare one node differently, or one bond twice.
    """
    whole: nx.DiGraph[Hashable] = nx.DiGraph()
    for part in parts:
        for name, attributes in part.nodes(data=True):
            known = whole.nodes[name] if name in whole else {}
            if attributes and known and dict(known) != dict(attributes):
                raise bg.StructureError(
                    f"two parts declare node {name!r}: {known} and {attributes}"
                )
            whole.add_node(name, **attributes)
        for bond in part.edges:
            if whole.has_edge(*bond) or whole.has_edge(*reversed(bond)):
                raise bg.StructureError(f"two parts declare the bond {bond[0]!r} -> {bond[1]!r}")
            whole.add_edge(*bond)
    return whole


def shaft(name: str, speed: str | None = None) -> Part:
    """A rigid shaft: one speed, torques that sum to zero. ``speed`` names it, else ``f_<name>``."""
    return _part([bg.One(name, flow=speed)])


def engine(name: str, torque: str, at: str) -> Part:
    """A torque source driving a shaft; a bare name is an input [N m]."""
    return _part([bg.Se(name, torque)], (name, at))


def inertia(name: str, value: str, at: str, speed: str | None = None, priority: float = 0) -> Part:
    """A moment of inertia [kg m^2] on a shaft; with a lower ``priority`` it is the dependent one."""
    return _part([bg.I(name, value, flow=speed, priority=priority)], (at, name))


def gear(name: str, ratio: str, driving: str, driven: str) -> Part:
    """A gear of ratio ``w_driving / w_driven``: a transformer of modulus 1/ratio."""
    return _part([bg.TF(name, f"1/({ratio})")], (driving, name), (name, driven))


def bevel(name: str, case: str, left: str, right: str) -> Part:
    """A bevel differential: ``w_case = (w_left + w_right)/2``, equal torques (Fig. 1)."""
    halves, torque = f"{name}_halves", f"{name}_torque"
    return _part(
        [bg.TF(halves, 2), bg.Zero(torque)],
        (case, halves), (halves, torque), (torque, left), (torque, right),
    )  # fmt: skip


def clutch(name: str, torque: str, slip: str, driving: str, driven: str) -> Part:
    """A friction clutch as an open port: slip ``w_driving - w_driven``, its torque brakes that slip."""
    between = f"{name}_slip"
    return _part(
        [bg.Zero(between), bg.R(name, effort=torque, flow=slip)],
        (driving, between), (between, name), (between, driven),
    )  # fmt: skip


def halfshaft(number: int, inner: str, outer: str, k: str, b: str) -> Part:
    """A spring k [N m/rad] and a damper b [N m s/rad] in parallel between two shafts, eq. (16).

    The spring's torque ``tau_k<number>`` is the state, ``tau_hs<number>`` the whole.
    """
    torque, twist = f"halfshaft_{number}", f"twist_{number}"
    spring, damper = f"spring_{number}", f"damper_{number}"
    return _part(
        [
            bg.Zero(torque, effort=f"tau_hs{number}"),
            bg.One(twist),
            bg.C(spring, f"1/({k})", effort=f"tau_k{number}"),
            bg.R(damper, b),
        ],
        (inner, torque), (torque, outer), (torque, twist), (twist, spring), (twist, damper),
    )  # fmt: skip


def tire(number: int, at: str) -> Part:
    """The road's torque on a wheel as an open port ``tau_t<number>`` at speed ``omega_t<number>``."""
    name = f"tire_{number}"
    return _part([bg.R(name, effort=f"tau_t{number}", flow=f"omega_t{number}")], (at, name))


def _part(nodes: list[Node], *bonds: tuple[str, str]) -> Part:
    part: nx.DiGraph[Hashable] = nx.DiGraph()
    part.add_nodes_from(nodes)
    part.add_edges_from(bonds)
    return part

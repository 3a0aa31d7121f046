"""Parts of drivelines as small bond graphs that share terminals: 1-junctions called by their shafts.

A part is a graph that mentions its terminals by name only; `assemble` puts parts together, in order.
The order of the parts is the order of states and inputs.
"""

from collections.abc import Hashable

import networkx as nx

import bondgraph as bg
from bondgraph.declare.composition import assemble as assemble
from bondgraph.declare.renaming import Part as Part
from bondgraph.nodes.elements import Node
from differentials.laws import backlash


def shaft(name: str, speed: str | None = None) -> Part:
    """A rigid shaft: one speed, torques that sum to zero. ``speed`` names it, else ``f_<name>``."""
    return part([bg.One(name, flow=speed)])


def engine(name: str, torque: str, at: str) -> Part:
    """A torque source driving a shaft; a bare name is an input [N m]."""
    return part([bg.Se(name, torque)], (name, at))


def inertia(name: str, value: str, at: str, speed: str | None = None, priority: float = 0) -> Part:
    """A moment of inertia [kg m^2] on a shaft; with a lower ``priority`` it is the dependent one."""
    return part([bg.I(name, value, flow=speed, priority=priority)], (at, name))


def gear(name: str, ratio: str, driving: str, driven: str) -> Part:
    """A gear of ratio ``w_driving / w_driven``: a transformer of modulus 1/ratio."""
    return part([bg.TF(name, f"1/({ratio})")], (driving, name), (name, driven))


def bevel(name: str, case: str, left: str, right: str) -> Part:
    """A bevel differential: ``w_case = (w_left + w_right)/2``, equal torques (Fig. 1)."""
    halves, torque = f"{name}_halves", f"{name}_torque"
    return part(
        [bg.TF(halves, 2), bg.Zero(torque)],
        (case, halves), (halves, torque), (torque, left), (torque, right),
    )  # fmt: skip


def planetary(name: str, ratio: str, sun: str, ring: str, carrier: str) -> Part:
    """A planetary gear: ``(1 + h) w_carrier = h w_ring + w_sun``, h = teeth of ring over sun (Fig. 7d).

    Torque on the ring is h times that on the sun, the carrier gives both out.
    """
    node, up, down = f"{name}_torque", f"{name}_ring", f"{name}_carrier"
    return part(
        [bg.TF(up, ratio), bg.Zero(node), bg.TF(down, f"1/(1 + ({ratio}))")],
        (ring, up), (up, node), (sun, node), (node, down), (down, carrier),
    )  # fmt: skip


def double_planetary(name: str, ratio: str, driving: str, driven: str, carrier: str) -> Part:
    """Two suns coupled by planets of two steps: ``h w_driving = w_driven + (h - 1) w_carrier`` (Fig. 7c).

    With its carrier held the driven sun turns h times as fast as the driving one.
    """
    node, up, down = f"{name}_torque", f"{name}_driving", f"{name}_carrier"
    return part(
        [bg.TF(up, ratio), bg.Zero(node), bg.TF(down, f"1/(({ratio}) - 1)")],
        (driving, up), (up, node), (node, driven), (node, down), (down, carrier),
    )  # fmt: skip


def clutch(
    name: str, torque: str, slip: str, driving: str, driven: str, speedup: str | None = None
) -> Part:
    """A friction clutch as an open port: slip ``w_driving - w_driven``, its torque brakes that slip.

    With ``speedup`` h a gear lies before it, and the slip is ``h w_driving - w_driven`` (Fig. 7b).
    """
    between, faster = f"{name}_slip", f"{name}_gear"
    nodes = [bg.Zero(between), bg.R(name, effort=torque, flow=slip)]
    away = [(between, name), (between, driven)]
    if speedup is None:
        return part(nodes, (driving, between), *away)
    return part(
        [bg.TF(faster, speedup), *nodes], (driving, faster), (faster, between), *away
    )  # fmt: skip


def brake(name: str, torque: str, slip: str, at: str) -> Part:
    """A friction brake between a shaft and the housing as an open port; its slip is the shaft's speed."""
    return part([bg.R(name, effort=torque, flow=slip)], (at, name))


def compliant_shaft(
    name: str, driving: str, driven: str, k: str, b: str | None = None, gap: str | None = None,
    torque: str | None = None, spring_torque: str | None = None,
) -> Part:  # fmt: skip
    """A spring k [N m/rad] and, parallel to it, a damper b [N m s/rad] between two shafts.

    ``spring_torque`` names the state, ``torque`` the whole. With a ``gap`` [rad] the shaft carries no
    torque in a zone of that width (Fig. 5) and its twist ``q_<name>_spring`` is the state; its damper
    then acts outside the zone alone, and never pulls the faces together.
    """
    twist, spring, damper = (f"{name}_{part}" for part in ("twist", "spring", "damper"))
    ends = [bg.Zero(name, effort=torque)], (driving, name), (name, driven)
    if gap is not None:
        twisted = bg.C(spring, law=backlash(f"q_{spring}", f"f_{spring}", k, b, gap), effort=torque)
        return part([*ends[0], twisted], *ends[1:], (name, spring))
    elastic = bg.C(spring, f"1/({k})", effort=spring_torque)
    if b is None:
        return part([*ends[0], elastic], *ends[1:], (name, spring))
    return part(
        [*ends[0], bg.One(twist), elastic, bg.R(damper, b)],
        *ends[1:], (name, twist), (twist, spring), (twist, damper),
    )  # fmt: skip


def halfshaft(
    number: int, inner: str, outer: str, k: str, b: str | None = None, gap: str | None = None
) -> Part:
    """A `compliant_shaft` to a wheel, eq. (16): spring torque ``tau_k<number>``, ``tau_hs<number>`` whole."""
    return compliant_shaft(
        f"halfshaft_{number}", inner, outer, k, b, gap, f"tau_hs{number}", f"tau_k{number}"
    )


def tire(number: int, at: str) -> Part:
    """The road's torque on a wheel as an open port ``tau_t<number>`` at speed ``omega_t<number>``.

    Its node is ``tire_<number>``: a law for it, of that speed, goes under this name.
    """
    name = f"tire_{number}"
    return part([bg.R(name, effort=f"tau_t{number}", flow=f"omega_t{number}")], (at, name))


def wheel(number: int, at: str, value: str, speed: str | None = None) -> Part:
    """A wheel's inertia ``I_w<number>`` of that value and its `tire`, on a shaft.

    ``speed`` names its state, else ``f_I_w<number>``.
    """
    return assemble(inertia(f"I_w{number}", value, at=at, speed=speed), tire(number, at=at))


def part(nodes: list[Node], *bonds: tuple[str, str]) -> Part:
    """Nodes and bonds as a part; a node that a bond names and the list does not is a terminal.

    Raises nothing.

    >>> import bondgraph as bg
    >>> list(part([bg.R("brake", "b")], ("shaft", "brake")))
    ['brake', 'shaft']
    """
    found: nx.DiGraph[Hashable] = nx.DiGraph()
    found.add_nodes_from(nodes)
    found.add_edges_from(bonds)
    return found

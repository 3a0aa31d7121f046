"""Stops: `Stop` as a user writes it, and the elements that it is made of."""

from collections.abc import Hashable, Mapping
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import symbol
from bondgraph.algebra.expressions import expression
from bondgraph.errors import StructureError
from bondgraph.nodes.attributes import variable
from bondgraph.nodes.elements import Element, Node, Switch, stated
from bondgraph.nodes.kinds import BOUNDS, POSITION, Kind
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.nodes.resets import resets_of


def Stop(
    name: Hashable, low: object = 0, high: object = None, restitution: object = 0,
    start: object = None, stiffness: object = None, damping: object = None, flow: object = None,
    reset: object = None,
) -> Node:  # fmt: skip
    """A stop at a 1-junction: its displacement ``q_<name>``, the integral of its flow, stays within bounds.

    Power counts into it. Rigid, it lets ``q_<name>`` neither fall below ``low`` nor rise above ``high`` (no
    such bound if None): what moves on is stopped by an impulse and thrown back with ``restitution`` times its
    speed, a number from 0 to 1; what holds it there are ``e_<name>_low`` and ``e_<name>_high``. With
    ``stiffness``, and ``damping`` if any, it yields: beyond a bound it pushes back with the effort
    ``stiffness * depth + damping * flow``, as long as that does not pull. ``start``: the displacement with
    which runs begin, 0 unless told; values may hold parameters. ``reset``: of a rigid one states by name and
    what each becomes at each of its impacts, ``{"n": "n + 1"}``: expressions have the values just after it.

    Raises nothing: `validate` looks at nodes.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("weight", "-g*m"), bg.One("ball"), bg.I("m", "m", flow="v"), Stop("floor")])
    >>> g.add_edges_from([("weight", "ball"), ("ball", "m"), ("ball", "floor")])
    >>> floor = bg.derive(g).switches[0]
    >>> floor.name, floor.guard, floor.gap
    ('floor', 'stop', q_floor)
    """
    given = {
        "low": low, "high": high, "restitution": restitution, "start": start,
        "stiffness": stiffness, "damping": damping, "flow": flow, "reset": reset,
    }  # fmt: skip
    if restitution == 0:
        del given["restitution"]
    return stated(name, Kind.STOP, given)


def stop_elements(name: Hashable, attributes: Mapping[str, Any]) -> list[Element]:
    """A 1-junction, what integrates its flow, and at each bound a switch, or one law where it yields."""
    where = f"node {name!r}"
    bounds = {
        key: expression(attributes[key], f"{where}, {key}")
        for key in BOUNDS
        if attributes.get(key) is not None
    }
    if not bounds:
        raise StructureError(
            f"{where}: a stop without a bound stops nothing; give low, high or both"
        )
    check_order(bounds, where)
    flow = variable(attributes, "flow", name)
    place = symbol(f"q_{name}", where)
    junction = Element(name, Kind.ONE, None, None, flow, whole=name)
    position = Element(
        f"{name}.{POSITION}", Kind.DF, None, *_own(name, POSITION), gives="effort", integral=place,
        start=_optional(attributes, "start", where), whole=name,
    )  # fmt: skip
    made = _springs if attributes.get("stiffness") is not None else rigid
    return [junction, position, *made(name, attributes, bounds, place)]


def rigid(
    name: Hashable, attributes: Mapping[str, Any], bounds: Mapping[str, sp.Expr], place: sp.Symbol
) -> list[Element]:
    """At each bound a switch that holds as long as its effort pushes, and lets go what has left.

    A stop of one bound calls it by its own name, unless that is the place's.
    """
    where = f"node {name!r}"
    if attributes.get("damping") is not None:
        raise StructureError(
            f"{where}: damping belongs to a stop with a stiffness; a rigid one has restitution"
        )
    bounce = _optional(attributes, "restitution", where) or sp.Integer(0)
    if bounce.is_number and not 0 <= bounce <= 1:
        raise StructureError(f"{where}: restitution {bounce} is not between 0 and 1")
    resets = resets_of(attributes.get("reset"), where, ("hit",))
    found = []
    for key, bound in bounds.items():
        effort, flow = _own(name, key)
        way = BOUNDS[key]
        own = name if len(bounds) == 1 and name != place.name else f"{name}.{key}"
        switch = Switch(
            own, way * effort, way * (bound - place), "effort", restitution=bounce, stops=True,
            resets=resets,
        )  # fmt: skip
        found.append(
            Element(f"{name}.{key}", Kind.SW, None, effort, flow, switch=switch, whole=name)
        )
    return found


def _springs(
    name: Hashable, attributes: Mapping[str, Any], bounds: Mapping[str, sp.Expr], place: sp.Symbol
) -> list[Element]:
    """At each bound a spring and a damper that do not pull."""
    where = f"node {name!r}"
    if attributes.get("restitution") is not None:
        raise StructureError(f"{where}: a stop has a restitution or a stiffness, not both")
    if attributes.get("reset") is not None:
        raise StructureError(f"{where}: a stop that yields has no impacts at which to reset states")
    stiffness = expression(attributes["stiffness"], f"{where}, stiffness")
    damping = _optional(attributes, "damping", where) or sp.Integer(0)
    found = []
    for key, bound in bounds.items():
        effort, flow = _own(name, key)
        way = BOUNDS[key]
        depth = way * (bound - place)
        push = sp.Max(0, stiffness * depth - way * damping * flow)
        law = ExpressionLaw(-way * sp.Piecewise((push, depth > 0), (0, True)))
        found.append(
            Element(
                f"{name}.{key}", Kind.R, None, effort, flow, law=law, gives="effort", whole=name
            )
        )
    return found


def _own(name: Hashable, part: str) -> tuple[sp.Symbol, sp.Symbol]:
    """Effort and flow of one part."""
    effort, flow = (symbol(f"{letter}_{name}_{part}", f"node {name!r}") for letter in "ef")
    return effort, flow


def _optional(attributes: Mapping[str, Any], key: str, where: str) -> sp.Expr | None:
    given = attributes.get(key)
    return None if given is None else expression(given, f"{where}, {key}")


def check_order(bounds: Mapping[str, sp.Expr], where: str) -> None:
    """Refuse numbers that leave no room between them."""
    if len(bounds) == 2:
        room = bounds["high"] - bounds["low"]
        if room.is_number and room <= 0:
            raise StructureError(f"{where}: low {bounds['low']} is not below high {bounds['high']}")

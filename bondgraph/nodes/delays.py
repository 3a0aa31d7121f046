"""Delays: `Delay` as a user writes it, and the elements that it is made of."""

from collections.abc import Hashable, Mapping
from typing import Any

from bondgraph.algebra.atoms import symbol
from bondgraph.algebra.expressions import TIME, expression
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Element, Node
from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.lagging import Lagging
from bondgraph.nodes.signals import own_name


def Delay(name: Hashable, value: object, time: object, start: object = 0, **more: object) -> Node:
    """A signal of this name: an expression as it was ``time`` [s] ago; ``start`` until a run has gone so far.

    Jumps and corners travel on: each is a breakpoint so much later. Nothing rational stands in for it, so it
    has no transfer function of finite order, and `linearize` refuses it. Runs, sweeps, steppers and exports
    remember as much of the past as it needs; at rest, for `trim`, it gives what it reads.

    Raises nothing: `validate` looks at nodes.

    >>> import bondgraph as bg
    >>> net = bg.graph([bg.Se("motor", "1*late"), bg.One("shaft"), bg.I("J", "J", flow="omega"),
    ...                 Delay("late", "K*(ref - omega)", time="T_d")], "motor > shaft > J")
    >>> bg.derive(net).delays[0]
    Lagging(given=late, value=K*(-omega + ref), time=T_d, start=0)
    """
    told = {"value": value, "time": time, **({} if start == 0 else {"start": start}), **more}
    return name, {"kind": str(Kind.DELAY), **told}


def delay_elements(name: Hashable, attributes: Mapping[str, Any]) -> list[Element]:
    """A source that is left open, and a detector that takes nothing from it."""
    where = f"node {name!r}"
    for key in ("value", "time"):
        if attributes.get(key) is None:
            raise StructureError(f"{where} has no {key}; give an expression")
    value, time, start = (
        expression(attributes.get(key, 0), f"{where}, {key}") for key in ("value", "time", "start")
    )
    for key, told in (("time", time), ("start", start)):
        if TIME in told.free_symbols:
            raise StructureError(f"{where}: its {key} reads the time; give numbers and parameters")
    if time.is_number and not time > 0:
        raise StructureError(f"{where}: its time is {time}; what is not late is a Function")
    given, flow = own_name(name, where), symbol(f"f_{name}", where)
    late = Lagging(given, value, time, start)
    return [
        Element(name, Kind.SE, None, given, flow, gives="effort", whole=name, late=late),
        Element(f"{name}.end", Kind.DE, None, given, flow, gives="flow", whole=name),
    ]

"""Signals as nodes: `Function` and `State` as a user writes them, and the elements that they are made of.

A signal is a port without power. A function is a source whose effort has the function's name, at a detector
that takes no flow; a state is what such a detector integrates. So each goes wherever sources, laws and
detectors go, and no later stage knows of it.
"""

from collections.abc import Hashable, Mapping
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import symbol
from bondgraph.algebra.expressions import expression
from bondgraph.errors import StructureError
from bondgraph.nodes.attributes import start_of, unit_of
from bondgraph.nodes.elements import Element, Node, stated
from bondgraph.nodes.kinds import BOUNDS, POSITION, Kind
from bondgraph.nodes.laws import ExpressionLaw, law
from bondgraph.nodes.stops import check_order, rigid


def Function(name: Hashable, value: object, **more: object) -> Node:
    """A signal of this name: an expression of signals, inputs, parameters and the time.

    It has no bonds and takes no power; whatever reads a name may read it, and it may read any. Where
    functions determine one another, or by way of the graph themselves, they are solved together. ``ports=``:
    names in the expression that stand for what wires bring, as arguments do, ``ports=["plus", "minus"]``.

    Raises nothing: `validate` looks at nodes.

    >>> import bondgraph as bg
    >>> motor = bg.graph([bg.Se("motor", "1*tau"), bg.One("shaft"), bg.I("J", "J", flow="omega"),
    ...                   bg.Function("tau", "K*(ref - omega)")], "motor > shaft > J")
    >>> print(bg.explicit(bg.derive(motor)))
    omega' = K*(-omega + ref)/J
    """
    return stated(name, Kind.FUNCTION, {"value": value, **more})


def State(
    name: Hashable, rate: object, start: object = None, low: object = None, high: object = None,
    **more: object,
) -> Node:  # fmt: skip
    """A state of this name whose rate is an expression; ``start``: where it begins, 0 unless told.

    With ``low``, ``high`` or both it does not leave these bounds: at one it stays for as long as its rate
    would lead beyond, and leaves as soon as the rate turns, so that an integrator does not wind up.

    Raises nothing: `validate` looks at nodes.

    >>> import bondgraph as bg
    >>> lag = bg.graph([bg.State("x", "(u - x)/T"), bg.Function("u", "sin(t)")])
    >>> print(bg.explicit(bg.derive(lag)))
    x' = (-x + sin(t))/T
    """
    told = {"rate": rate, "start": start, "low": low, "high": high, **more}
    return stated(name, Kind.STATE, told)


def function_elements(name: Hashable, attributes: Mapping[str, Any]) -> list[Element]:
    """The source that gives the signal, and a detector that takes nothing from it."""
    where = f"node {name!r}"
    if attributes.get("value") is None:
        raise StructureError(f"{where} has no value; give an expression")
    effort = own_name(name, where)
    told = law(attributes["value"], where)
    if not isinstance(told, ExpressionLaw):
        raise StructureError(f"{where}: its value is an expression, not {told!r}")
    if effort in told.free_symbols:
        raise StructureError(
            f"{where}: its value reads {effort} itself; a State has a memory, or give what it reads "
            "another name"
        )
    return _pair(name, effort, told, unit_of(attributes, where))


def state_elements(name: Hashable, attributes: Mapping[str, Any]) -> list[Element]:
    """What gives the rate, and what integrates it; with bounds a stop between them."""
    where = f"node {name!r}"
    if attributes.get("rate") is None:
        raise StructureError(f"{where} has no rate; give an expression")
    place, unit = own_name(name, where), unit_of(attributes, where)
    rate = ExpressionLaw(expression(attributes["rate"], f"{where}, rate"))
    start = start_of(attributes, where)
    demand = symbol(f"rate_{name}", where)
    own = symbol(f"e_{name}", where)
    bounds = {
        key: expression(attributes[key], f"{where}, {key}")
        for key in BOUNDS
        if attributes.get(key) is not None
    }
    if not bounds:
        return _pair(name, own, rate, unit, demand, place, start)
    check_order(bounds, where)
    _check_start(start, bounds, where)
    flow = symbol(f"f_{name}", where)
    junction = Element(name, Kind.ONE, None, None, flow, whole=name)
    source = Element(
        f"{name}.rate", Kind.SE, None, demand, flow, law=rate, gives="effort", whole=name, unit=unit
    )
    follows = Element(f"{name}.free", Kind.R, sp.Integer(1), own, flow, whole=name)
    reads = Element(
        f"{name}.{POSITION}", Kind.DF, None, symbol(f"e_{name}_{POSITION}", where), flow,
        gives="effort", integral=place, start=start, whole=name,
    )  # fmt: skip
    return [junction, source, follows, reads, *rigid(name, {}, bounds, place)]


def _check_start(start: sp.Expr | None, bounds: Mapping[str, sp.Expr], where: str) -> None:
    """Refuse a number to start from that is beyond a bound that is a number."""
    for key, bound in bounds.items():
        beyond = None if start is None else BOUNDS[key] * (bound - start)
        if beyond is not None and beyond.is_number and beyond > 0:
            raise StructureError(f"{where}: start {start} is beyond its bound, {key} {bound}")


def _pair(
    name: Hashable, effort: sp.Symbol, told: ExpressionLaw, unit: str | None,
    read: sp.Symbol | None = None, integral: sp.Symbol | None = None, start: sp.Expr | None = None,
) -> list[Element]:  # fmt: skip
    """A source and the detector that it ends at; ``read``: the effort as that reads it."""
    flow = symbol(f"f_{name}", f"node {name!r}")
    return [
        Element(
            name, Kind.SE, None, effort, flow, law=told, gives="effort", unit=unit, whole=name
        ),
        Element(
            f"{name}.end", Kind.DE, None, read or effort, flow, gives="flow", integral=integral,
            start=start, whole=name,
        ),
    ]  # fmt: skip


def own_name(name: Hashable, where: str) -> sp.Symbol:
    """The signal that a node of this name is."""
    if not isinstance(name, str):
        raise StructureError(
            f"{where}: a signal's node has the signal's name, a text, not {name!r}"
        )
    return symbol(name, where)


def source_of(name: Hashable, part: str, kind: Kind, given: sp.Expr) -> Element:
    """A part of a node of several that gives an expression."""
    return Element(
        f"{name}.{part}", kind, None, *variables_of(name, part), law=ExpressionLaw(given),
        gives=kind.gives, whole=name,
    )  # fmt: skip


def variables_of(name: Hashable, part: str) -> tuple[sp.Symbol, sp.Symbol]:
    """Effort and flow of such a part."""
    effort, flow = (symbol(f"{letter}_{name}_{part}", f"node {name!r}") for letter in "ef")
    return effort, flow

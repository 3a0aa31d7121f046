"""Nonlinear storages that are held to something: they count by their laws' inverses, with a slope in A."""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType

import sympy as sp

from bondgraph.nodes.elements import Element, Switch
from bondgraph.nodes.inverting import with_inverse
from bondgraph.nodes.laws import DryFriction, ExpressionLaw
from bondgraph.reduce.motion import replaced
from bondgraph.reduce.structure import JunctionStructure, Port


def by_inverses(structure: JunctionStructure) -> JunctionStructure:
    """The structure whose nonlinear states that are held to something are what their laws give.

    Of ``e = law(q)`` the state is e, with ``q = inverse(e)`` and ``inverse'(e) e' = f``: a dependent storage
    that it drives moves with e', and friction that holds it binds e, which a law of q would not
    tell. Laws without an inverse stay, and are refused where that is needed.
    """
    ports, rows = structure.ports, structure.rows
    return with_inverses(
        structure, {at for d, port in enumerate(ports) if _holds(port) for at in rows[d]}
    )


def with_inverses(structure: JunctionStructure, held: Iterable[int]) -> JunctionStructure:
    """The structure whose nonlinear states among these ports are what their laws give."""
    made = by_inverse(structure, held)
    if not made:
        return structure
    new = tuple(replace(p, element=made.get(p.element.name, p.element)) for p in structure.ports)
    elements = MappingProxyType({**structure.elements, **made})
    return replace(structure, ports=new, elements=elements)


def by_inverse(structure: JunctionStructure, held: Iterable[int]) -> dict[Hashable, Element]:
    """The nonlinear storages among these ports, as elements whose states are what their laws give."""
    made: dict[Hashable, Element] = {}
    for at in sorted(held):
        port = structure.ports[at]
        if port.integral and not port.element.by_inverse:
            turned = with_inverse(port.element)
            if turned is not None:
                made[turned.name] = replace(turned, by_inverse=True)
    return made


def _holds(port: Port) -> bool:
    """Whether what a port receives is bound at times: by a dependent storage or friction."""
    dependent = port.element.kind.stores and not port.integral and port.element.gives is None
    return dependent or isinstance(port.element.law, DryFriction)


def with_states_told(structure: JunctionStructure) -> JunctionStructure:
    """The structure in which what reads such a state reads ``q = inverse(e)``, or ``p = inverse(f)``.

    So a value, a law or a switch may read a displacement or a momentum whatever causality its storage has.
    """
    told = {
        state: port.element.inverse
        for port in structure.ports
        if (state := _untold(port)) is not None and port.element.inverse is not None
    }
    if not told:
        return structure
    values = replaced(structure, told)
    ports = tuple(replace(port, element=_reading(port.element, told)) for port in values.ports)
    elements = {name: _reading(one, told) for name, one in structure.elements.items()}
    elements |= {port.element.name: port.element for port in ports}
    return replace(values, ports=ports, elements=MappingProxyType(elements))


def _untold(port: Port) -> sp.Symbol | None:
    """The state of a law that the port keeps by its inverse; None where it is a state, or there is none."""
    law = port.element.law
    if not isinstance(law, ExpressionLaw) or not port.element.kind.stores:
        return None
    return law.state if port.own_state is None else None


def _reading(element: Element, told: Mapping[sp.Symbol, sp.Expr]) -> Element:
    """The element with that put into its law and its switch; its own law's state stays."""
    law, switch = element.law, element.switch
    if isinstance(law, ExpressionLaw):
        others = {state: value for state, value in told.items() if state != law.state}
        law = ExpressionLaw(law.expression.xreplace(others), law.state)
    elif isinstance(law, DryFriction):
        parts = (part.xreplace(told) for part in (law.level, law.curve, law.breakaway))
        law = DryFriction(*parts)
    return replace(element, law=law, switch=None if switch is None else _switch(switch, told))


def _switch(switch: Switch, told: Mapping[sp.Symbol, sp.Expr]) -> Switch:
    resets = tuple(replace(one, value=one.value.xreplace(told)) for one in switch.resets)
    on, off = switch.on.xreplace(told), switch.off.xreplace(told)
    bounce = switch.restitution.xreplace(told)
    reads = None if switch.reads is None else switch.reads.xreplace(told)
    return replace(switch, on=on, off=off, restitution=bounce, resets=resets, reads=reads)

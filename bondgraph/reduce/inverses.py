"""Nonlinear storages that are held to something: they count by their laws' inverses, with a slope in A."""

from collections.abc import Hashable, Iterable
from dataclasses import replace
from types import MappingProxyType

from bondgraph.declare.elements import Element
from bondgraph.declare.inverting import with_inverse
from bondgraph.declare.laws import DryFriction
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

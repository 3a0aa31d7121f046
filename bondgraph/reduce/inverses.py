"""Nonlinear storages that drive dependent ones: they count by their laws' inverses, with a slope in A."""

from dataclasses import replace
from types import MappingProxyType

from bondgraph.declare.inverting import with_inverse
from bondgraph.reduce.structure import JunctionStructure


def by_inverses(structure: JunctionStructure) -> JunctionStructure:
    """The structure whose nonlinear states that drive dependent storages are what their laws give.

    Of ``e = law(q)`` the state is e, with ``q = inverse(e)`` and ``inverse'(e) e' = f``: what it drives
    moves with e', which a law of q would not tell. Laws without an inverse stay, and are refused there.
    """
    ports, rows = structure.ports, structure.rows
    driving = {
        at
        for d, port in enumerate(ports)
        if port.element.kind.stores and not port.integral and port.element.gives is None
        for at in rows[d]
    }
    made = {}
    for at in sorted(driving):
        turned = with_inverse(ports[at].element) if ports[at].integral else None
        if turned is not None:
            made[turned.name] = replace(turned, by_inverse=True)
    if not made:
        return structure
    new = tuple(replace(p, element=made.get(p.element.name, p.element)) for p in ports)
    elements = MappingProxyType({**structure.elements, **made})
    return replace(structure, ports=new, elements=elements)

"""Where the names come from that a run has to be given: whose they are, or which law or value reads them."""

from collections.abc import Hashable, Iterator, Mapping, Set

import sympy as sp

from bondgraph.analyse.closures import merged_laws
from bondgraph.equations import StateEquations
from bondgraph.errors import nearest
from bondgraph.nodes.laws import ExpressionLaw, Law
from bondgraph.reduce.structure import Port

MOST = 2
"""So many places are named."""


def whence(
    name: str, equations: StateEquations, laws: Mapping[Hashable, object],
    parameters: Mapping[str, object],
) -> str:  # fmt: skip
    """What a message says after a name that has no number: the one that was meant, and who reads it.

    ``laws``: over ports, as of a simulator; ``parameters``: what has a number. Only a name that the graph
    does not declare may be another one misspelt: a signal's, or that of a number which nothing reads.

    >>> import bondgraph as bg
    >>> nodes = [bg.Se("push", "F"), bg.One("cart"), bg.I("m", "m", flow="v"), bg.R("air", law="c*w**2")]
    >>> g = bg.graph(nodes, "push > cart > m", "cart > air")
    >>> whence("w", bg.derive(g), {}, {}), whence("F", bg.derive(g), {}, {})
    (" (in the law of 'air', which receives f_air)", " (of Se 'push')")
    """
    closed = merged_laws(equations, laws)
    owners = [port for port in equations.ports if port.given.name == name]
    if owners:
        element = owners[0].element
        return f" (of {element.kind} {element.name!r})"
    read = _read(equations, closed)
    moving = (*equations.signals, *equations.further_states)
    known = {*map(str, moving), *(one for one in parameters if one not in read)}
    meant = nearest(name, sorted(known)).removeprefix(" (").removesuffix(")")
    places = list(_places(name, equations, closed))
    more = ["..."] if len(places) > MOST else []
    told = "; ".join([one for one in (meant, *places[:MOST], *more) if one])
    return f" ({told})" if told else ""


def _read(equations: StateEquations, laws: Mapping[Hashable, Law]) -> set[str]:
    names = {*equations.parameters}.union(*(one.free_symbols for one in laws.values()))
    return {one.name for one in names}


def _places(name: str, equations: StateEquations, laws: Mapping[Hashable, Law]) -> Iterator[str]:
    """Every law and value that reads it; of a law also what it would have at hand."""
    ports = {port.element.name: port for port in equations.ports}
    known = {*equations.signals, *equations.further_states}
    for node, law in laws.items():
        if name in {one.name for one in law.free_symbols}:
            yield f"in the law of {node!r}{_at_hand(law, ports.get(node), known)}"
    for node, element in equations.elements.items():
        values = [element.value, *(entry for _, entry in element.row)]
        if any(name in {one.name for one in v.free_symbols} for v in values if v is not None):
            yield f"in the value of {node!r}"


def _at_hand(law: Law, port: Port | None, known: Set[sp.Symbol]) -> str:
    """What a law could read that reads no signal at all."""
    if port is None or not isinstance(law, ExpressionLaw) or law.expression.free_symbols & known:
        return ""
    if law.state is not None:
        return f", which is over {law.state}"
    return f", which receives {port.received}" if port.element.kind.resists else ""

"""The whole equations as text: the matrices, what stands beside them, and everything put in."""

from collections.abc import Iterator, Sequence

import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.nodes.laws import DryFriction
from bondgraph.show.display import (
    MOST_SIGNS,
    WIDTH,
    counted,
    equations_text,
    listed,
    written,
)
from bondgraph.show.lines import words, wrapped
from bondgraph.show.powers import without_functions, without_idle
from bondgraph.show.putting_in import closed
from bondgraph.show.signal_nodes import given_inside
from bondgraph.show.statements import Statement, Statements, statements
from bondgraph.show.ways import going, lagging, rubbing, switching, working

PUT_IN = "with laws and sources put in"

TOO_LONG = "put into one another, laws and sources are too long to be read here"


def whole_text(model: StateEquations) -> str:
    """Never empty where there is a state, an output, a law or a switch.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.One("j"), bg.I("m", "m", flow="v"), bg.C("k", law="k*q_k**3")])
    >>> g.add_edges_from([("j", "m"), ("j", "k")])
    >>> print(whole_text(bg.derive(g)))
    [ m ] [v'] = [ -1 ] [e_k]
    <BLANKLINE>
    where
      e_k = k*q_k^3
      q_k' = v
    <BLANKLINE>
    with laws and sources put in
      m*v' = -k*q_k^3
      q_k' = v
    """
    model = without_functions(model)
    found = statements(model)
    parts = (
        equations_text(without_idle(model)),
        *map("\n".join, (_beside(model, found), _put_in(model, found))),
    )
    return "\n\n".join(part for part in parts if part)


def ways(model: StateEquations) -> list[str]:
    """A sentence for each dry friction and each switch, both of its ways; and for each controller."""
    told = given_inside(model)
    frictions = [
        rubbing(port, law)
        for port in model.ports
        if isinstance(law := model.laws.get(port.element.name), DryFriction)
        and port.given not in told
    ]
    machines = [going(one, model.switches) for one in model.machines]
    plain = [one for one in model.plain_switches if one.port.given not in told]
    switches = [*map(switching, plain), *machines]
    return [*frictions, *switches, *map(working, model.tasks), *map(lagging, model.delays)]


def together(loop: Sequence[sp.Symbol]) -> str:
    """What is told of names that determine one another.

    >>> together(sp.symbols("e f"))
    'e and f follow from one another: they are solved together'
    """
    *first, last = map(str, loop)
    if not first:
        return f"{last} follows from itself: it is solved for"
    return f"{', '.join(first)} and {last} follow from one another: they are solved together"


def put_in(model: StateEquations, found: Statements) -> tuple[Statement, ...]:
    """Every state's and output's equation with laws and sources put in; none where that changes none."""
    if not found.given:
        return ()
    turning = tuple(one for one in found.given if one.ruled is not None)
    rows, bare = closed(model, found), closed(model, Statements(turning, found.rates, ()))
    changed = tuple(one for one in rows if one not in turning)
    return () if rows == bare else changed


def _beside(model: StateEquations, found: Statements) -> Iterator[str]:
    lines = [line for one in (*found.given, *found.rates) for line in _lines(one)]
    sentences = [*map(together, found.loops), *ways(model)]
    for text in sentences:
        first, *rest = words(text)
        lines += wrapped([f"  {first}", *rest], WIDTH, "    ")
    if lines and (model.states or model.outputs):
        yield "where"
    if sum(map(len, lines)) <= MOST_SIGNS:
        yield from lines
        return
    for what, names in (
        ("law or signal", [one.left for one in found.given]),
        ("further state", [one.left for one in found.rates]),
    ):
        yield f"  {counted(len(names), what, f'{what}s')}: {listed(names)}"
    yield f"  {counted(len(sentences), 'switch or friction', 'switches and frictions')}"


def _put_in(model: StateEquations, found: Statements) -> Iterator[str]:
    lines = [line for one in put_in(model, found) for line in _lines(one, whole=False)]
    if sum(map(len, lines)) > MOST_SIGNS:
        yield TOO_LONG
    elif lines:
        yield PUT_IN
        yield from lines


def _lines(one: Statement, whole: bool = True) -> list[str]:
    if one.ruled is not None:
        first, *rest = words(f"{one.left} = {one.ruled.text(whole)}")
        return wrapped([f"  {first}", *rest], WIDTH, "    ")
    return [f"  {line}" for line in written(one.left_terms, one.right)]

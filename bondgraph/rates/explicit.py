"""`explicit`: every state's rate as one expression, laws put in; in co-energy or energy states."""

from collections.abc import Iterable, Iterator, Mapping
from itertools import count
from typing import Any

import sympy as sp

from bondgraph.algebra.functions import without_logarithms
from bondgraph.algebra.tidy import tidy
from bondgraph.analyse.input_rates import rate_symbol
from bondgraph.analyse.turned import turned
from bondgraph.derive import check_derived
from bondgraph.equations import StateEquations
from bondgraph.rates.energy import in_energy_states
from bondgraph.rates.record import ExplicitRates
from bondgraph.rates.signals import Signals
from bondgraph.show.ruled import Ruled
from bondgraph.show.signal_nodes import signal_nodes
from bondgraph.solving.loops import closed
from bondgraph.solving.steps import size, told

MOST_TIDIED = 40
"""A shorter form of a rate is looked for where it has no more operands."""


def explicit(
    equations: StateEquations, laws: Mapping[Any, object] | None = None, energy: bool = False
) -> ExplicitRates:
    """``x' = f(x, u, t)``: each state, those of laws and detectors included, to its rate.

    ``laws``: as for a simulator. Ports with dry friction and switches stay inputs, by what they give,
    relays by their names; of nodes of signals `ExplicitRates.ruled` has both ways. The rate of an input u
    is the symbol ``d_u``. ``energy``: in momenta ``p_<node>`` and displacements
    ``q_<node>`` instead of the flows and efforts of linear storages, whose values must then be constant.

    Laws that determine one another at once and are linear are solved. Of others the equations that are
    left stand in `ExplicitRates.implicit`, by the names of what the laws give, and rates hold these names.
    Where rates would be long, parts of them have names in `ExplicitRates.where`.

    Raises `AlgebraicLoopError` where laws determine one another and leave no solution, or many.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("force", "F"), bg.One("j"), bg.I("m", "m", flow="v"),
    ...                   bg.C("k", law="k*q_k**3")])
    >>> g.add_edges_from([("force", "j"), ("j", "m"), ("j", "k")])
    >>> print(explicit(bg.derive(g)))
    v' = (F - k*q_k**3)/m
    q_k' = v
    """
    check_derived(equations)
    signals = Signals(turned(equations, laws), laws)
    solution = closed(signals.told, signals.owners)
    parts, rates = solution.told, signals.rates
    results: dict[sp.Symbol, sp.Expr] = dict(rates)
    if energy:
        results, put_in = in_energy_states(signals.equations, rates)
        parts = {name: expr.xreplace(put_in) for name, expr in parts.items()}
    ruled = {n: one for n, one in _ruled(signals) if n in results or n == one.left}
    inner = [expr for one in ruled.values() for expr in one.expressions]
    whole = told([*results.values(), *solution.implicit.values(), *inner], parts)
    names = _names(whole.parts, {name: rate_symbol(s) for s, name in rates.items()}, whole.results)
    found = [_tidy(result.xreplace(names)) for result in whole.results]
    implicit = dict(zip(solution.implicit, found[len(results) :], strict=False))
    put = iter(found[len(results) + len(implicit) :])
    ways = {name: one.put(lambda _: next(put)) for name, one in ruled.items()}
    where = {names.get(name, name): _tidy(e.xreplace(names)) for name, e in whole.parts.items()}
    return ExplicitRates(dict(zip(results, found, strict=False)), implicit, where, ways)


def _ruled(signals: Signals) -> Iterator[tuple[sp.Symbol, Ruled]]:
    """What nodes of signals with several ways come to, by their states, relays by their own names."""
    for node in signal_nodes(signals.equations):
        if node.ruled is not None:
            yield node.state or node.ruled.left, node.ruled


def _tidy(expr: sp.Expr) -> sp.Expr:
    """What is not long by itself in its shortest form; the rest is over few denominators already."""
    expr = without_logarithms(expr)
    return tidy(expr) if size(expr, {}) <= MOST_TIDIED else expr


def _names(
    parts: Iterable[sp.Symbol], rates: Mapping[sp.Symbol, sp.Symbol], used: Iterable[sp.Expr]
) -> dict[sp.Symbol, sp.Symbol]:
    """What parts without a name of their own are called: ``d_<state>`` a rate, ``s_1`` and so on others."""
    parts = list(parts)
    taken = {name.name for expr in (*used, *parts) for name in expr.free_symbols}
    free = (name for at in count(1) if (name := f"s_{at}") not in taken)
    found: dict[sp.Symbol, sp.Symbol] = {}
    for part in parts:
        if isinstance(part, sp.Dummy):
            own = rates.get(part)
            found[part] = own if own and own.name not in taken else sp.Symbol(next(free))
    return found

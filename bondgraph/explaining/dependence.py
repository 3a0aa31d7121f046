"""Dependent storages: what rules them, differentiated, and put into the balances of the states."""

from collections.abc import Iterable, Iterator, Mapping

import sympy as sp

from bondgraph.explaining.elimination import reading_terms, row_terms
from bondgraph.explaining.momenta import Momenta
from bondgraph.explaining.records import Equation, Step, equation
from bondgraph.reduce.record import Reading
from bondgraph.reduce.sorting import Reduction
from bondgraph.reduce.storages import stored_rate
from bondgraph.show.sums import Term, rate, total


def dependent_step(reduction: Reduction, held: Momenta) -> Step:
    """Each dependent storage's constraint, its rate, and what it gives; and the rates of other momenta."""
    lines = [*_rates_of_values(reduction)]
    for port in reduction.dependent:
        lines += (
            _moving(reduction, held, port)
            if port in held.symbols
            else _fixed(reduction, held, port)
        )
    for port in reduction.states:
        if port in reduction.energies:
            one = reduction.structure.ports[port]
            terms = reading_terms(reduction, reduction.columns[port])
            lines.append(equation(one.given, terms, node=one.element.name))
        elif port in held.symbols:
            one = reduction.structure.ports[port]
            terms = reading_terms(reduction, stored_rate(reduction, port))
            lines.append(equation(rate(held.symbols[port]), terms, node=one.element.name))
    title = "Differentiated: what dependent storages give"
    if not reduction.dependent:
        title = "Differentiated: what storages hold"
    return Step("dependent", title, (), tuple(lines))


def _fixed(reduction: Reduction, held: Momenta, port: int) -> Iterator[Equation]:
    """A constant times a fixed sum of states and inputs: the sum's rate, times the constant."""
    one = reduction.structure.ports[port]
    ((value, variable),) = held.stored[port]
    ruled = reduction.reading(reduction.structure.rows[port])
    differentiated = Reading({}, {}, ruled.F, ruled.D)
    name = one.element.name
    yield equation(variable, reading_terms(reduction, ruled), node=name)
    yield equation(rate(variable), reading_terms(reduction, differentiated), node=name)
    given = reading_terms(reduction, reduction.columns[port])
    yield equation(one.given, [(value, rate(variable))], given, node=name)


def _moving(reduction: Reduction, held: Momenta, port: int) -> Iterator[Equation]:
    """A momentum over states and inputs, and its rate by the rules of products and chains."""
    structure, one, symbol = (
        reduction.structure,
        reduction.structure.ports[port],
        held.symbols[port],
    )
    used = total(held.stored[port]).free_symbols
    ruled = {
        structure.ports[d].received: reading_terms(reduction, reduction.reading(structure.rows[d]))
        for d in reduction.dependent
        if structure.ports[d].received in used
    }
    yield equation(
        symbol, held.stored[port], _put_in(held.stored[port], ruled), node=one.element.name
    )
    given = reading_terms(reduction, reduction.columns[port])
    yield equation(one.given, rate(symbol), given, node=one.element.name)


def _put_in(stored: Iterable[Term], ruled: Mapping[sp.Symbol, list[Term]]) -> list[Term]:
    terms: list[Term] = []
    for value, variable in stored:
        if variable in ruled:
            terms += [(value * factor, signal) for factor, signal in ruled[variable]]
        else:
            put = {name: total(tuple(sums)) for name, sums in ruled.items()}
            terms.append((value, variable.xreplace(put)))
    return terms


def _rates_of_values(reduction: Reduction) -> Iterator[Equation]:
    """The rates of laws' and detectors' states that values move with."""
    if reduction.motion is None:
        return
    for name, reading in reduction.motion.rates.items():
        if name not in reduction.names and name not in reduction.inputs:
            yield equation(rate(name), reading_terms(reduction, reading))


def balances_step(
    reduction: Reduction, held: Momenta, shown: Iterable[tuple[sp.Symbol, Mapping[int, sp.Expr]]]
) -> Step:
    """Each state's storage law with everything put in, and the outputs."""
    lines: list[Equation] = []
    for port in reduction.states:
        one, row = reduction.structure.ports[port], reduction.driving(port)
        if port in held.symbols:
            stored = reading_terms(reduction, stored_rate(reduction, port))
        else:
            ((value, variable),) = held.stored[port]
            stored = [(value, rate(variable))]
        put = reading_terms(reduction, reduction.reading(row))
        # A momentum of several storages changes by what the rest gives, not by what one of them receives.
        received = [one.received] if row == reduction.structure.rows[port] else []
        lines.append(
            equation(stored, *received, row_terms(reduction, row), put, node=one.element.name)
        )
    for symbol, row in shown:
        seen, put = row_terms(reduction, row), reading_terms(reduction, reduction.reading(row))
        if total(tuple(seen)) != total(tuple(put)):
            lines.append(equation(symbol, seen, put))
    return Step("balances", "Put into the storages' laws and the outputs", (), tuple(lines))

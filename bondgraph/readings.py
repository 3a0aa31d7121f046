"""Checks on derived signals: equal names mean equal quantities, and no law has to be differentiated."""

from collections.abc import Hashable, Mapping, Sequence

import sympy as sp

from bondgraph.errors import DependentSourceError, StructureError
from bondgraph.exact import Row
from bondgraph.junction import Port
from bondgraph.laws import DryFriction, Law
from bondgraph.reduction import Reading
from bondgraph.residues import is_zero


def check_readings(
    states: Sequence[sp.Symbol],
    inputs: Sequence[sp.Symbol],
    readings: Sequence[tuple[sp.Symbol, Reading]],
) -> None:
    """Refuse one name for two quantities: a state, an input or a reading that differs from a reading."""
    one = sp.Integer(1)
    known = {state: Reading({at: one}, {}, {}, {}) for at, state in enumerate(states)}
    if len(known) < len(states):
        twice = next(state for state in states if list(states).count(state) > 1)
        raise StructureError(f"two storages have a state {twice}; give each a name of its own")
    for at, name in enumerate(inputs):
        if name in known:
            raise StructureError(f"{name} names both a state and an input; rename one of them")
        known[name] = Reading({}, {at: one}, {}, {})
    for name, reading in readings:
        other = known.setdefault(name, reading)
        if not _equal(other, reading):
            raise StructureError(
                f"two different quantities are called {name}; names may be equal only where the "
                "quantities are, so rename one"
            )


def _equal(one: Reading, other: Reading) -> bool:
    if one is other:
        return True
    pairs = ((one.F, other.F), (one.D, other.D), (one.H, other.H), (one.K, other.K))
    return all(
        is_zero(a.get(column, sp.Integer(0)) - b.get(column, sp.Integer(0)))
        for a, b in pairs
        for column in a.keys() | b.keys()
    )


def check_laws(
    laws: Mapping[Hashable, Law],
    states: Sequence[sp.Symbol],
    ports: Sequence[Port],
    E: Sequence[Row],
    readings: Mapping[sp.Symbol, Reading],
) -> None:
    """Refuse a law whose slope in time would be needed: a port that drives a dependent storage.

    A law of time, parameters and inputs alone may drive one: it is a known source.
    """
    inputs = list(dict.fromkeys(port.given for port in ports))
    signals = {*states, *readings, *(port.given for port in ports if port.element.name in laws)}
    for port in ports:
        law = laws.get(port.element.name)
        if law is None or not depends_on_signals(law, signals):
            continue
        column = inputs.index(port.given)
        reading = readings[port.received]
        if reading.H or reading.K or any(column in row for row in E):
            other = "flow" if port.gives == "effort" else "effort"
            raise DependentSourceError(
                f"the law at {port.element.name!r} drives a dependent storage, so its slope in time "
                f"would be needed; let it give its {other} (gives={other!r}), or put a storage that "
                "can be independent beside it"
            )


def depends_on_signals(law: Law, signals: set[sp.Symbol]) -> bool:
    """Whether a law reads anything that the system itself rules."""
    if isinstance(law, DryFriction) or law.state is not None:
        return True
    return bool(law.free_symbols & signals)

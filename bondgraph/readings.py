"""What laws may close: no port whose effort or flow would have to be differentiated in time."""

from collections.abc import Hashable, Mapping, Sequence

import sympy as sp

from bondgraph.elements import STORAGES
from bondgraph.errors import DependentSourceError
from bondgraph.exact import Row
from bondgraph.junction import Port
from bondgraph.laws import DryFriction, Law
from bondgraph.modulation import Reading


def check_laws(
    laws: Mapping[Hashable, Law],
    known: set[sp.Symbol],
    ports: Sequence[Port],
    E: Sequence[Row],
    readings: Mapping[sp.Symbol, Reading],
) -> None:
    """Refuse a law whose slope in time would be needed: a port that drives a dependent storage.

    A law of time, parameters and inputs alone may drive one: it is a known source. ``known``: every
    signal of the graph, open inputs included.
    """
    inputs = list(dict.fromkeys(port.given for port in ports))
    signals = known - {port.given for port in ports if port.element.name not in laws}
    for port in ports:
        law = laws.get(port.element.name)
        if law is None or not depends_on_signals(law, signals):
            continue
        column = inputs.index(port.given)
        reading = readings[port.received]
        if reading.H or reading.K or any(column in row for row in E):
            other = "flow" if port.gives == "effort" else "effort"
            way = f"let it give its {other} (gives={other!r})"
            if port.element.kind in STORAGES:
                way = "put a resistance between"
            raise DependentSourceError(
                f"the law at {port.element.name!r} drives a dependent storage, so its slope in time "
                f"would be needed; {way}, or put a storage that can be independent beside it"
            )


def depends_on_signals(law: Law, signals: set[sp.Symbol]) -> bool:
    """Whether a law reads anything that the system itself rules."""
    if isinstance(law, DryFriction) or law.state is not None:
        return True
    return bool(law.free_symbols & signals)

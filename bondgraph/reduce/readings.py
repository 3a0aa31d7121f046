"""What laws may close: no port whose effort would have to be differentiated, or is read by itself."""

from collections.abc import Collection, Hashable, Mapping, Sequence
from dataclasses import replace

import sympy as sp

from bondgraph.algebra.exact import FixedRow
from bondgraph.errors import DependentSourceError, StructureError
from bondgraph.nodes.elements import OTHER
from bondgraph.nodes.inverting import why_unturned
from bondgraph.nodes.laws import DryFriction, Law, check_slider
from bondgraph.reduce.record import Reading
from bondgraph.reduce.structure import Port, PortRow


def check_laws(
    laws: Mapping[Hashable, Law],
    known: Mapping[sp.Symbol, PortRow],
    ports: Sequence[Port],
    E: Sequence[FixedRow],
    readings: Mapping[sp.Symbol, Reading],
    states: Collection[sp.Symbol],
) -> None:
    """Refuse dry friction that reads its own effort, and a law whose slope in time would be needed.

    The slope is needed where a port drives a dependent storage.

    A law of time, parameters and inputs alone may drive one: it is a known source. ``known``: every
    signal of the graph, open inputs included, as a row over what ports give. ``states``: those that laws
    own and detectors make, which are none of these rows and move as well.
    """
    inputs = list(dict.fromkeys(port.given for port in ports))
    outside = {port.given for port in ports if port.element.name not in laws}
    signals = {*known, *states} - outside
    for port in ports:
        law = laws.get(port.element.name)
        if law is None or not depends_on_signals(law, signals):
            continue
        _check_friction(law, port, known)
        _check_own(law, port, signals)
        column = inputs.index(port.given)
        reading = readings[port.received]
        if reading.H or reading.K or any(column in row for row in E):
            other = OTHER[port.gives]
            way = f"let it give its {other} (gives={other!r}), by a law of its {port.gives}"
            if port.element.kind.supplies:
                way = "let it read the time, parameters and inputs alone"
            if port.element.kind.stores:
                way = "give the inverse of its law, put a resistance between"
            raise DependentSourceError(
                f"the law at {port.element.name!r} drives a dependent storage, so its slope in time "
                f"would be needed; {way}, or put a storage that can be independent beside it"
                f"{why_unturned(replace(port.element, law=law))}"
            )


def _check_own(law: Law, port: Port, signals: Collection[sp.Symbol]) -> None:
    """Refuse a resistance whose law reads what it gives itself and nothing else that moves."""
    if port.element.kind.resists and {*law.free_symbols} & {*signals} == {port.given}:
        raise StructureError(
            f"law at {port.element.name!r}: it gives its {port.gives} {port.given} and reads nothing else; "
            f"a law of the {port.gives} gives the {OTHER[port.gives]} (gives={OTHER[port.gives]!r}), "
            f"one that gives the {port.gives} reads {port.received}"
        )


def _check_friction(law: Law, port: Port, known: Mapping[sp.Symbol, PortRow]) -> None:
    """Refuse friction whose level, curve or breakaway is told by the effort that it gives itself."""
    if not isinstance(law, DryFriction):
        return
    if port.gives == "flow":
        check_slider(law, f"law at {port.element.name!r}")
    parts = (("level", law.level), ("curve", law.curve), ("breakaway", law.breakaway))
    for what, part in parts:
        for name in sorted(part.free_symbols, key=str):
            # A signal of one term, at the place of the effort, is the effort under another name.
            if name == port.given or (name in known and {*known[name]} == {*known[port.given]}):
                raise StructureError(
                    f"law at {port.element.name!r}: the {what} of dry friction uses {name}, the {port.gives} "
                    f"that this port gives itself; give the {port.gives} another name "
                    f"({port.gives}=...), or what the {what} uses"
                )


def depends_on_signals(law: Law, signals: set[sp.Symbol]) -> bool:
    """Whether a law reads anything that the system itself rules."""
    if isinstance(law, DryFriction) or law.state is not None:
        return True
    return bool(law.free_symbols & signals)

"""Which ports switch, and what changes each over: recognised exactly."""

from collections.abc import Mapping, Sequence

import sympy as sp

from bondgraph.algebra.exact import FixedRow
from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.residues import is_zero
from bondgraph.errors import DependentSourceError
from bondgraph.nodes.elements import OTHER, Switch
from bondgraph.reduce.motion import slope_of
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.sorting import Reduction
from bondgraph.reduce.structure import Port, PortRow
from bondgraph.reduce.switch_port import Guard, SwitchPort


def switch_ports(
    reduction: Reduction, signals: Mapping[sp.Symbol, PortRow]
) -> tuple[SwitchPort, ...]:
    """The ports that switch, in declaration order.

    ``signals``: every named signal of the graph as a row over its ports.
    """
    structure = reduction.structure
    ports = [structure.ports[at] for at in reduction.imposed]
    outside = {p.given for p in ports if p.element.kind.supplies and p.element.law is None}
    inside = {*signals, *structure.states_of_laws} - outside
    found = []
    for port in ports:
        switch = port.element.switch
        if switch is None:
            continue
        side = _side(switch, port, reduction, signals)
        stop = None if side else _stop(switch, port, reduction, signals)
        if stop is not None:
            found.append(stop)
            continue
        guard: Guard = "one-sided" if side else "general"
        if not (switch.on.free_symbols | switch.off.free_symbols) & inside:
            guard = "commanded"
        found.append(SwitchPort(switch, port, guard, side))
    return tuple(found)


def _side(
    switch: Switch, port: Port, reduction: Reduction, signals: Mapping[sp.Symbol, PortRow]
) -> int:
    """1 or -1 as the two conditions are told by the port's own variables; 0 if they are not."""
    element = port.element
    # Off, the switch is free in what it gives while it is on; on, it is free in the other.
    on = _sign(switch.on, element.variable(switch.gives), reduction, signals)
    off = _sign(switch.off, element.variable(OTHER[switch.gives]), reduction, signals)
    if on == 0 or off != -on:
        return 0
    return on if port.gives == switch.gives else -on


def _stop(
    switch: Switch, port: Port, reduction: Reduction, signals: Mapping[sp.Symbol, PortRow]
) -> SwitchPort | None:
    """The switch as a stop, if it is one: with a gap that its own flow opens or closes."""
    element, moving = port.element, _moving(reduction, signals)
    way = _sign(switch.on, element.effort, reduction, signals) if switch.gives == "effort" else 0
    own = switch.off.free_symbols & moving
    if way == 0 or len(own) != 1 or element.flow is None:
        return None
    (place,) = own
    integrated = [p for p in reduction.structure.ports if p.element.integral == place]
    if not integrated:
        return None
    ratio = _ratio(
        reduction.reading(signals[integrated[0].received]), reduction.reading(signals[element.flow])
    )
    slope = -slope_of(switch.off, place)
    if ratio not in (1, -1) or slope.free_symbols & moving:
        return None
    opens = slope * ratio
    if int(bool(opens.is_positive)) - int(bool(opens.is_negative)) != way:
        return None
    gap = sp.expand(-switch.off / (slope * way * ratio))
    side = way if port.gives == "effort" else -way
    return SwitchPort(switch, port, "stop", side, gap, place, way * int(ratio))


def _moving(reduction: Reduction, signals: Mapping[sp.Symbol, PortRow]) -> set[sp.Symbol]:
    """Everything but parameters."""
    return {*signals, *reduction.structure.states_of_laws, *reduction.inputs, TIME}


def _sign(
    condition: sp.Expr, own: sp.Symbol | None, reduction: Reduction,
    signals: Mapping[sp.Symbol, PortRow],
) -> int:  # fmt: skip
    """The sign of c in ``condition = c * own``, whatever names it is written in; 0 if there is none.

    Parameters in c count as far as their assumptions tell its sign.
    """
    total, left = ReadingSum(), condition
    for name in sorted(condition.free_symbols & signals.keys(), key=str):
        factor = slope_of(condition, name)
        if factor.free_symbols & signals.keys():
            return 0
        total.add(reduction.reading(signals[name]), factor)
        left -= factor * name
    if own is None or not is_zero(left):
        return 0
    ratio = _ratio(total.whole(), reduction.reading(signals[own]))
    return 0 if ratio is None else int(bool(ratio.is_positive)) - int(bool(ratio.is_negative))


def _ratio(one: Reading, other: Reading) -> sp.Expr | None:
    """c with ``one = c * other``, None if there is none."""
    pairs = [
        (a.get(j, sp.Integer(0)), b.get(j, sp.Integer(0)))
        for a, b in zip(one.parts, other.parts, strict=True)
        for j in a.keys() | b.keys()
    ]
    ratios = [sp.cancel(a / b) for a, b in pairs if not is_zero(b)]
    if not ratios or any(not is_zero(a - ratios[0] * b) for a, b in pairs):
        return None
    return ratios[0]


def check_switches(
    switches: Sequence[SwitchPort], inputs: Sequence[sp.Symbol], E: Sequence[FixedRow],
    readings: Mapping[sp.Symbol, Reading],
) -> None:  # fmt: skip
    """Refuse a switch that drives a dependent storage: its rate would be needed where it is held."""
    driven = {j for row in (*E, *(reading.K for reading in readings.values())) for j in row}
    for one in switches:
        received = readings[one.port.received]
        if received.H or received.K or inputs.index(one.port.given) in driven:
            raise DependentSourceError(
                f"the switch {one.name!r} drives a dependent storage, though a switch takes its causality "
                "after the storages; please report this graph"
            )

"""`SwitchPort`: a port that a switch holds or lets go, which of its ways is which, what changes it over."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import sympy as sp

from bondgraph.algebra.exact import FixedRow
from bondgraph.algebra.residues import is_zero
from bondgraph.declare.elements import OTHER, Switch
from bondgraph.errors import DependentSourceError
from bondgraph.reduce.motion import slope_of
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.sorting import Reduction
from bondgraph.reduce.structure import Port, PortRow

Guard = Literal["one-sided", "commanded", "general"]
"""What changes a switch over: its own two sides, a signal from outside, or any expression."""


@dataclass(frozen=True)
class SwitchPort:
    """A port that is let go, when it gives zero, or held, when it gives what keeps at zero what it receives.

    ``guard``: "one-sided" if ``on`` is a positive multiple of the port's own effort and ``off`` of its own
    flow reversed, or both with the other sign (a flow and an effort for a controlled 0-junction);
    "commanded" if both hold time, parameters and open sources' inputs alone; else "general".

    ``side``, of a one-sided port 1 or -1, else 0: let go, it receives ``side * received >= 0``; held, it
    gives ``side * given <= 0``.
    """

    switch: Switch
    port: Port
    guard: Guard
    side: int = 0

    @property
    def name(self) -> Hashable:
        """The node: the Sw, or the controlled junction."""
        return self.switch.name

    @property
    def on(self) -> sp.Expr:
        """Off, it turns on as this rises above zero."""
        return self.switch.on

    @property
    def off(self) -> sp.Expr:
        """On, it turns off as this rises above zero."""
        return self.switch.off

    @property
    def gives(self) -> str:
        """What it gives in all of its modes, "effort" or "flow"."""
        return self.port.gives

    @property
    def held(self) -> Literal["on", "off"]:
        """The way in which it is held: "off" if it gives, in all modes, what it gives as zero while on."""
        return "off" if self.port.gives == self.switch.gives else "on"


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

"""Nodes of signals in state equations: what each comes to, instead of the elements that it is made of."""

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass

import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.nodes.elements import Element
from bondgraph.nodes.kinds import BOUNDS, Kind
from bondgraph.nodes.laws import DryFriction, ExpressionLaw
from bondgraph.show.following import Following
from bondgraph.show.ruled import Bounded, Ruled, Turning


@dataclass(frozen=True)
class SignalNode:
    """One node, of a state or of several ways; not of functions, which are what their source gives.

    ``rate``: of a state without bounds its rate; ``ruled``: what another comes to; ``given``: the variables
    that its parts give, which need no equation; ``stated``: what of them is told by its name.
    """

    name: Hashable
    given: frozenset[sp.Symbol]
    state: sp.Symbol | None = None
    rate: sp.Expr | None = None
    ruled: Ruled | None = None
    stated: sp.Symbol | None = None


def signal_nodes(model: StateEquations) -> tuple[SignalNode, ...]:
    """States, relays and limited rates, in declaration order; none of what was settled in one mode.

    >>> import bondgraph as bg
    >>> (node,) = signal_nodes(bg.derive(bg.graph([bg.State("z", "u", low=0)])))
    >>> node.name, node.stated, node.ruled.text(whole=False)
    ('z', rate_z, 'rate_z within 0 <= z')
    """
    return tuple(_nodes(model))


def given_inside(model: StateEquations) -> frozenset[sp.Symbol]:
    """What parts of these nodes give: told with the node, and by no law, switch or friction of its own."""
    return frozenset().union(*(node.given for node in signal_nodes(model)))


def signal_states(model: StateEquations) -> tuple[sp.Symbol, ...]:
    """The states of all nodes of signals, those that controllers keep too, in declaration order."""
    found = []
    for one in model.elements.values():
        state = one.flow if one.kind.stores else one.integral
        if one.of_signals and state is not None:
            found.append(state)
    return tuple(found)


def _nodes(model: StateEquations) -> Iterator[SignalNode]:
    parts: dict[Hashable, list[Element]] = {}
    for one in model.elements.values():
        if one.of_signals:
            parts.setdefault(one.whole, []).append(one)
    for name, own in parts.items():
        by_part = {str(one.name).removeprefix(f"{name}."): one for one in own}
        by_part[""] = own[0]
        told = _TOLD.get(own[0].declared or Kind.FUNCTION)
        given = frozenset(
            port.given for port in model.ports if port.element.name in {one.name for one in own}
        )
        if told is not None and (found := told(name, by_part, given)) is not None:
            yield found


def _state(
    name: Hashable, parts: Mapping[str, Element], given: frozenset[sp.Symbol]
) -> SignalNode | None:
    state = next(one.integral for one in parts.values() if one.integral is not None)
    if "end" in parts:
        return SignalNode(name, given, state, rate=_expression(parts[""]))
    bounds: dict[str, sp.Expr | None] = dict.fromkeys(BOUNDS)
    for key, way in BOUNDS.items():
        if key in parts:
            if (switch := parts[key].switch) is None:
                return None
            bounds[key] = state + way * switch.off
    demand = parts["rate"].effort
    return SignalNode(name, given, state, ruled=Bounded(state, demand, **bounds), stated=demand)


def _turning(
    name: Hashable, parts: Mapping[str, Element], given: frozenset[sp.Symbol]
) -> SignalNode | None:
    switch, own = parts["switch"].switch, parts[""].effort
    if switch is None or switch.reads is None or own is None:
        return None
    off, on = _expression(parts["off"]), _expression(parts["on"])
    read = switch.reads
    ruled = Turning(own, read, read + switch.off, read - switch.on, off, on)
    return SignalNode(name, given, ruled=ruled)


def _following(
    name: Hashable, parts: Mapping[str, Element], given: frozenset[sp.Symbol]
) -> SignalNode | None:
    clutch, state = parts["clutch"].law, parts["mass"].flow
    if not isinstance(clutch, DryFriction) or state is None:
        return None
    drift = _expression(parts["drift"]) if "drift" in parts else sp.Integer(0)
    ruled = Following(
        state, _expression(parts["input"]), clutch.level + drift, clutch.level - drift
    )
    return SignalNode(name, given, state, ruled=ruled)


_TOLD = {Kind.STATE: _state, Kind.HYSTERESIS: _turning, Kind.RATE_LIMITER: _following}


def _expression(element: Element) -> sp.Expr:
    assert isinstance(element.law, ExpressionLaw)
    return element.law.expression

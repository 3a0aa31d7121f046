"""What is written beside elements: values, conditions of switches, bounds of stops, where they are short."""

from collections.abc import Sequence

import sympy as sp

from bondgraph.drawing.rich import MOST, Rich, Run, formula, joined, length, named
from bondgraph.nodes.elements import OTHER, Element, Switch
from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.laws import DryFriction, ExpressionLaw
from bondgraph.nodes.tasks import Transition

IN_BLOCK = 36
"""Letters of a line in a block, which are small, at most."""


def bounds(ports: Sequence[Element]) -> Rich:
    """What a rigid stop keeps its displacement within, if that is short; nothing of one that yields."""
    place = next(port.integral for port in ports if port.integral is not None)
    low: Rich = ()
    high: Rich = ()
    for port in ports:
        if port.switch is None:
            continue
        if sp.diff(port.switch.off, place) < 0:
            low = (*formula(place + port.switch.off), Run(" ≤ "))
        else:
            high = (Run(" ≤ "), *formula(place - port.switch.off))
    bounded: Rich = (*low, *formula(place), *high)
    switches = [port.switch for port in ports if port.switch is not None]
    text = (*bounded, *_resets(switches[0])) if switches else bounded
    for one in (text, bounded):
        if (low or high) and length(one) <= MOST:
            return joined([*one])
    return ()


def does(ports: Sequence[Element]) -> tuple[Rich, ...]:
    """What a node of signals does, by lines that are short: a value, an integral and its bounds, instants."""
    told = [port.law.expression for port in ports if isinstance(port.law, ExpressionLaw)]
    lines: list[Rich] = []
    if (task := ports[0].task) is not None:
        lines.append((Run(task.instants),))
    elif (late := ports[0].late) is not None:
        lines += [formula(late.value), joined([*formula(late.time), Run(" s ago")])]
    elif ports[0].machine is not None:
        taken = [port.switch.transition for port in ports if port.switch is not None]
        lines += [_taken(one) for one in taken if one is not None]
    elif (switch := ports[-1].switch) is not None and switch.reads is not None:
        lines += _turning(switch, switch.reads, *told)
    elif isinstance(clutch := ports[-1].law, DryFriction):
        lines += _following(ports, clutch)
    elif ports[0].declared is Kind.STATE:
        begin, end = ("∫ (", ")") if told[0].is_Add else ("∫ ", "")
        lines += [joined([Run(begin), *formula(told[0]), Run(end)]), bounds(ports)]
    elif ports[0].declared is Kind.HYSTERESIS:
        lines += [_conditions(port.switch) for port in ports if port.switch is not None]
    elif ports[0].declared is Kind.RATE_LIMITER:
        dragged = [port.law for port in ports if port.kind is Kind.SF]
        lines += [formula(law.expression) for law in dragged if isinstance(law, ExpressionLaw)]
    else:
        lines.append(formula(told[0]))
    return tuple(line for line in lines if line and length(line) <= IN_BLOCK)


def _turning(switch: Switch, read: sp.Expr, off: sp.Expr, on: sp.Expr) -> list[Rich]:
    """Both values of a hysteresis, each with the threshold beyond which it is that."""
    return [
        (*formula(value), Run(" once "), *formula(read), Run(sign), *formula(bound))
        for value, sign, bound in (
            (on, " > ", read - switch.on), (off, " < ", read + switch.off),
        )
    ]  # fmt: skip


def _following(ports: Sequence[Element], clutch: DryFriction) -> list[Rich]:
    """What a limited rate follows, and between which rates."""
    laws = {port.kind: port.law for port in ports if isinstance(port.law, ExpressionLaw)}
    drift = laws[Kind.SE].expression if Kind.SE in laws else sp.Integer(0)
    rise, fall = clutch.level + drift, clutch.level - drift
    rate = (*named(ports[0].whole), Run("'"))
    led = (
        (Run("|"), *rate, Run("| ≤ "), *formula(rise)) if rise == fall
        else (*formula(-fall), Run(" ≤ "), *rate, Run(" ≤ "), *formula(rise))
    )  # fmt: skip
    return [formula(laws[Kind.SF].expression), led]


def _taken(one: Transition) -> Rich:
    """A transition and its guard, as a line; what is too long for that without it."""
    line = joined([Run(f"{one.words}: "), *formula(one.guard), Run(" > 0")])
    return line if length(line) <= IN_BLOCK else (Run(one.words),)


def switched(element: Element) -> str:
    """On or off: what in_mode leaves of a switch is a port that gives zero of one of the two."""
    if element.kind.resists and element.law == ExpressionLaw(sp.Integer(0)):
        return "on" if element.gives == "effort" else "off"
    return ""


def value_text(element: Element) -> Rich | None:
    """What the element is by its value, by its law or by how it switches, if that is short."""
    if element.switch is not None:
        one_way = _one_way(element)
        text = (*one_way, *_resets(element.switch)) if one_way else _conditions(element.switch)
        return joined([*text]) if length(text) <= MOST else None
    given = element.value
    if given is None and element.kind.supplies and element.owner is None:
        law = element.law
        given = law.expression if isinstance(law, ExpressionLaw) else element.given
    if given is None or element.owner is not None:
        return None
    text = formula(given)
    return text if length(text) <= MOST else None


def _one_way(element: Element) -> Rich:
    """What a switch lets through, where its own two variables change it over, as a diode's; else nothing."""
    switch = element.switch
    own = None if switch is None else element.variable(switch.gives)
    other = None if switch is None else element.variable(OTHER[switch.gives])
    if switch is None or own is None or other is None:
        return ()
    on, off = switch.on / own, switch.off / other
    if on.is_positive and off.is_negative:
        return (*named(other), Run(" ≥ 0"))
    if on.is_negative and off.is_positive:
        return (*named(other), Run(" ≤ 0"))
    return ()


def _conditions(switch: Switch) -> Rich:
    """What turns a switch on, and what turns it off where that is more than the opposite."""
    text: Rich = (*formula(switch.on), Run(" > 0"))
    if switch.off != -switch.on:
        text = (*text, Run(", off "), *formula(switch.off), Run(" > 0"))
    return (*text, *_resets(switch))


def _resets(switch: Switch) -> Rich:
    """What a switch sets states to."""
    parts: Rich = ()
    for one in switch.resets:
        parts = (*parts, Run("; "), *formula(one.state), Run(" := "), *formula(one.value))
    return parts

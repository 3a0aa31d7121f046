"""What has two ways, in words: switches and stops, on and off; dry friction, sticking and slipping."""

from collections.abc import Sequence

import sympy as sp

from bondgraph.nodes.lagging import Lagging
from bondgraph.nodes.laws import SLIP, DryFriction
from bondgraph.nodes.tasks import Machine, Reset, Task
from bondgraph.reduce.structure import Port
from bondgraph.reduce.switch_port import SwitchPort
from bondgraph.show.plain import plain
from bondgraph.show.sums import signed_terms


def rubbing(port: Port, law: DryFriction) -> str:
    """What dry friction does, by what it gives."""
    curve = law.curve.xreplace({SLIP: sp.Symbol(f"|{port.received}|")})
    text, level = f"{port.element.name}: dry friction; ", plain(law.level * curve)
    if port.gives == "flow":
        return (
            f"{text}{port.given} = 0 while {port.received} stays within {level} either way; slipping it "
            f"keeps {port.received} there"
        )
    at_rest = plain(law.level * law.breakaway)
    return (
        f"{text}{port.given} = sign({port.received})*{level} slipping; sticking, {port.received} = 0 by "
        f"what {port.given} that takes, while |{port.given}| <= {at_rest}"
    )


def switching(one: SwitchPort) -> str:
    """Both ways of a switch: what it gives, what it keeps at zero, and what changes it over."""
    given, received = one.port.given, one.port.received
    free = f"it gives {given} = 0"
    holds = f"it keeps {received} = 0 by what {given} that takes"
    on, off = (holds, free) if one.held == "on" else (free, holds)
    what = "an ideal switch" if one.gap is None else "a stop"
    text = (
        f"{one.name}: {what}; on, {on}, and turns off as {_passes(one.off)} zero; "
        f"off, {off}, and turns on as {_passes(one.on)} zero"
    )
    text += "".join(map(_reset, one.switch.resets))
    if not one.side:
        return text
    least, most = ("negative", "positive") if one.side > 0 else ("positive", "negative")
    if one.gap is not None:
        return f"{text}; {_bound(one)}"
    return f"{text}; so {received} is never {least} and {given} never {most}"


def lagging(one: Lagging) -> str:
    """What a delay gives."""
    return (
        f"{one.given}: {plain(one.value)} as it was {plain(one.time)} s ago; {plain(one.start)} before a run "
        "has gone so far"
    )


def going(machine: Machine, switches: Sequence[SwitchPort]) -> str:
    """A state machine: its modes by their numbers, and its transitions, by which switches they are taken."""
    modes = ", ".join(f"{mode} = {at}" for at, mode in enumerate(machine.modes))
    text = f"{machine.name}: a state machine, {modes}; begins in {machine.start}"
    for one in switches:
        taken = one.switch.transition
        if taken is None or taken.machine != machine:
            continue
        text += f"; {taken.words} as {_passes(taken.guard)} zero"
        sets = [each for each in one.switch.resets if each.state != machine.number]
        told = " and ".join(f"{each.state} becomes {plain(each.value)}" for each in sets)
        text += f", and {told}" if told else ""
    return text


def working(task: Task) -> str:
    """What a sampled controller sets, and when."""
    if task.step is not None:
        reads = ", ".join(map(str, task.reads)) or "nothing"
        sets = " and ".join(map(str, task.states))
        return f"{task.name}: {task.instants} a Python function sets {sets}; it reads {reads}"
    sets = " and ".join(f"{one.state} becomes {plain(one.value)}" for one in task.resets)
    return f"{task.name}: {task.instants} {sets}, by what there was before; between, these stay"


def positive(condition: sp.Expr) -> tuple[bool, sp.Expr]:
    """Whether a condition that has to rise above zero is told by what has to fall below it, and by what.

    >>> f, g = sp.symbols("f g")
    >>> positive(-f), positive(f), positive(g - f)
    ((True, f), (False, f), (False, -f + g))
    """
    (sign, size), *more = signed_terms(condition) or ((sp.Integer(1), condition),)
    return (True, size) if not more and sign < 0 else (False, condition)


def _passes(condition: sp.Expr) -> str:
    falls, told = positive(condition)
    return f"{plain(told)} {'falls below' if falls else 'rises above'}"


def _reset(one: Reset) -> str:
    """What a state becomes."""
    when = "at each impact" if one.event == "hit" else f"as it turns {one.event}"
    return f"; {when} {one.state} becomes {plain(one.value)}"


def _bound(one: SwitchPort) -> str:
    """What a stop sees to."""
    pushes = one.side if one.gives == "effort" else -one.side
    never = "positive" if pushes > 0 else "negative"
    text = f"so {plain(one.gap)} is never negative and {one.port.element.effort} never {never}"
    bounce = one.switch.restitution
    if not bounce:
        return text
    return f"{text}, and what meets it is thrown back with {plain(bounce)} times its speed"

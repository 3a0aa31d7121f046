"""What has two ways as LaTeX: what holds in each of them, and until when."""

from collections.abc import Iterator, Sequence

import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.nodes.laws import SLIP, DryFriction
from bondgraph.nodes.tasks import Machine, Task
from bondgraph.reduce.structure import Port
from bondgraph.reduce.switch_port import SwitchPort
from bondgraph.show.signal_nodes import given_inside
from bondgraph.show.sums import typeset
from bondgraph.show.ways import positive


def ways_latex(model: StateEquations) -> Iterator[str]:
    """A formula for each dry friction and each switch, and for all that controllers set."""
    told = given_inside(model)
    for port in model.ports:
        law = model.laws.get(port.element.name)
        if isinstance(law, DryFriction) and port.given not in told:
            yield _cases(_friction(port, law))
    for machine in model.machines:
        yield from _machine(machine, model.switches)
    for one in model.plain_switches:
        if one.port.given in told:
            continue
        yield _cases(_switch(one))
        for reset in one.switch.resets:
            when = "at each impact" if reset.event == "hit" else f"as it turns {reset.event}"
            yield rf"{typeset(reset.state)} := {typeset(reset.value)} \quad \text{{{when}}}"
    if rows := [row for task in model.tasks for row in _set(task)]:
        body = " \\\\\n".join(rows)
        yield rf"\begin{{aligned}} {body} \end{{aligned}}"


def _set(task: Task) -> Iterator[str]:
    """What a controller sets, below one another; its instants at the first."""
    when = rf" && \text{{{task.instants}, by what there was before}}"
    if task.step is not None:
        names = ", ".join(map(typeset, task.states))
        yield rf"{names} &:= \text{{by a Python function}}{when}"
        return
    for reset in task.resets:
        yield f"{typeset(reset.state)} &:= {typeset(reset.value)}{when}"
        when = ""


def _machine(machine: Machine, switches: Sequence[SwitchPort]) -> Iterator[str]:
    """The numbers of its modes, and each transition with its guard and what it sets."""
    modes = ", ".join(rf"{at}\ (\text{{{escaped(one)}}})" for at, one in enumerate(machine.modes))
    yield rf"{typeset(machine.number)} \in \{{ {modes} \}}"
    for one in switches:
        taken = one.switch.transition
        if taken is None or taken.machine != machine:
            continue
        ends = r" \to ".join(rf"\text{{{escaped(mode)}}}" for mode in (taken.source, taken.target))
        sets = (each for each in one.switch.resets if each.state != machine.number)
        told = "".join(rf",\ {typeset(each.state)} := {typeset(each.value)}" for each in sets)
        yield rf"{ends} \quad \text{{as }} {_passed(taken.guard)}{told}"


def escaped(mode: str) -> str:
    r"""A mode's name as text.

    >>> print(escaped("limp_home"))
    limp\_home
    """
    return mode.replace("_", r"\_")


def _cases(rows: Iterator[tuple[str, str]]) -> str:
    body = r" \\ ".join(f"{left} & {when}" for left, when in rows)
    return rf"\begin{{cases}} {body} \end{{cases}}"


def _friction(port: Port, law: DryFriction) -> Iterator[tuple[str, str]]:
    given, received = typeset(port.given), typeset(port.received)
    if port.gives == "flow":
        level = typeset(law.level * law.curve)
        yield f"{given} = 0", rf"\text{{sticking, while }} |{received}| \leq {level}"
        sign = rf"\operatorname{{sign}}\left({given}\right)"
        yield f"{received} = {sign} {level}", r"\text{slipping}"
        return
    curve = law.curve.xreplace({SLIP: sp.Abs(port.received)})
    level, at_rest = typeset(law.level * curve), typeset(law.level * law.breakaway)
    yield f"{received} = 0", rf"\text{{sticking, while }} |{given}| \leq {at_rest}"
    sign = rf"\operatorname{{sign}}\left({received}\right)"
    yield f"{given} = {sign} {level}", r"\text{slipping}"


def _switch(one: SwitchPort) -> Iterator[tuple[str, str]]:
    given, received = f"{typeset(one.port.given)} = 0", f"{typeset(one.port.received)} = 0"
    on, off = (received, given) if one.held == "on" else (given, received)
    yield on, rf"\text{{on, until }} {_passed(one.off)}"
    yield off, rf"\text{{off, until }} {_passed(one.on)}"


def _passed(condition: sp.Expr) -> str:
    falls, told = positive(condition)
    return f"{typeset(told)} {'<' if falls else '>'} 0"

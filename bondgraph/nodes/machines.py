"""State machines: `StateMachine` as a user writes it, and the elements that it is made of."""

from collections.abc import Hashable, Iterable, Mapping
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import symbol
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Element, Node, Switch, stated
from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.nodes.parts import LAST, NUMBER, ending
from bondgraph.nodes.tasks import Machine, Reset, Transition
from bondgraph.nodes.transitions import check_mode, check_set, modes_of, starts_of, transitions_of


def StateMachine(
    name: Hashable, modes: Iterable[str], transitions: Mapping[str, object],
    start: str | None = None, states: Mapping[str, object] | None = None, **more: object,
) -> Node:  # fmt: skip
    """A machine that is in one of its ``modes`` at any time, and goes from one to another at once.

    ``transitions``: by the modes, ``"idle > launch"``, the guard, an expression of any signals, or a pair of
    guard and action. A transition is taken as its guard rises above zero while the machine is in its mode,
    or if the guard is above zero where that is entered, or a run begins in it; of several the first, as they
    are written. The action maps states to what each becomes, told by what stood before: those in ``states``,
    which keep what they are in between and map to where they begin, or any of the graph. What ticks at the
    same instant comes after all transitions, and may lead to others.

    The signal ``<name>`` is the number of the mode, 0, 1, ... in order, and a state, so that ``initial`` may
    have another than ``start``, the first unless told. For each mode the signal ``<name>_<mode>`` is 1 in
    it and 0 otherwise. A transition from a mode to itself is taken each time its guard rises above zero.

    Raises nothing: `validate` looks at nodes.

    >>> import bondgraph as bg, codegen
    >>> tank = bg.graph(
    ...     [bg.Sf("pump", "Q*valve_fill"), bg.Zero("node"), bg.C("tank", "A", effort="h"), bg.R("leak", "R"),
    ...      bg.StateMachine("valve", ["fill", "rest"], states={"fills": 1}, transitions={
    ...          "fill > rest": "h - 2", "rest > fill": ("1 - h", {"fills": "fills + 1"})})],
    ...     "pump > node > tank", "node > leak")
    >>> run = codegen.simulator(bg.derive(tank), {"Q": 5, "A": 1, "R": 1}).run([0, 1, 2])
    >>> [(event.port, event.kind) for event in run.events], run["valve"].tolist()
    ([('valve', 'fill > rest'), ('valve', 'rest > fill'), ('valve', 'fill > rest')], [0.0, 1.0, 1.0])
    """
    pairs = transitions.items() if isinstance(transitions, Mapping) else ()
    acting = {key: told for key, told in pairs if isinstance(told, list | tuple) and len(told) == 2}
    guards = {key: acting[key][0] if key in acting else told for key, told in pairs}
    given = {
        "modes": modes, "transitions": guards or transitions, "initially": start, "states": states,
        "reset": {key: told[1] for key, told in acting.items()} or None, **more,
    }  # fmt: skip
    return stated(name, Kind.MACHINE, given)


def machine_elements(name: Hashable, attributes: Mapping[str, Any]) -> list[Element]:
    """What keeps the mode and the states, a source for the signal of each mode, a switch for each transition.

    A switch has a port of its own that carries nothing; its condition is the guard, in the mode alone.
    """
    where = f"node {name!r}"
    if not isinstance(name, str):
        raise StructureError(
            f"{where}: a machine's node has the name of the signal that is its mode, a text, not {name!r}"
        )
    number = symbol(name, where)
    modes = modes_of(attributes.get("modes"), name, where)
    first = attributes.get("initially", modes[0])
    check_mode(first, modes, f"{where}, start")
    machine = Machine(name, number, modes, str(first))
    starts = starts_of(attributes.get("states"), where)
    found = transitions_of(attributes, machine, where)
    check_set(starts, found, number, where)
    effort, flow = (symbol(f"{letter}_{name}", where) for letter in "ef")
    made = [
        Element(name, Kind.ZERO, None, effort, None, whole=name, machine=machine),
        # No flow passes it, so that its effort, the rate of all that is kept, is zero.
        Element(f"{name}.still", Kind.R, sp.Integer(1), effort, flow, whole=name),
        _kept(name, NUMBER, number, sp.Integer(modes.index(str(first)))),
    ]
    made += [_kept(name, one.name, one, value) for one, value in starts.items()]
    for mode in modes:
        made += _shown(machine, mode)
    for transition, resets in found:
        made += _taken(transition, resets)
    return made


def _kept(name: str, part: str, state: sp.Symbol, start: sp.Expr) -> Element:
    """A detector that integrates zero."""
    effort, flow = (symbol(f"{letter}_{name}_{part}", f"node {name!r}") for letter in "ef")
    return Element(
        f"{name}.{part}", Kind.DE, None, effort, flow, gives="flow", integral=state, start=start,
        whole=name,
    )  # fmt: skip


def _shown(machine: Machine, mode: str) -> list[Element]:
    """The signal that is 1 in a mode: a source, and the detector that it ends at."""
    name, where = str(machine.name), f"node {machine.name!r}"
    effort, flow = symbol(f"{name}_{mode}", where), symbol(f"f_{name}_is_{mode}", where)
    told = ExpressionLaw(machine.chosen(mode, sp.Integer(1), sp.Integer(0)))
    own = f"{name}_{mode}"
    return [
        Element(own, Kind.SE, None, effort, flow, law=told, gives="effort", whole=name, at=own),
        Element(f"{own}.end", Kind.DE, None, effort, flow, gives="flow", whole=name, at=own),
    ]


def _taken(transition: Transition, resets: tuple[Reset, ...]) -> list[Element]:
    """The switch that a transition turns on, and off again where that has led away; what it ends at."""
    machine = transition.machine
    name, where = str(machine.name), f"node {machine.name!r}"
    ends = f"{name}_{ending(transition.words)}"
    effort, flow, *beyond = (
        symbol(f"{letter}_{ends}{last}", where) for last in ("", LAST) for letter in "ef"
    )
    own, one = f"{name}.{transition.words}", sp.Integer(1)
    on = machine.chosen(transition.source, transition.guard, -one)
    off = machine.chosen(transition.source, -transition.guard, one)
    target = sp.Integer(machine.modes.index(transition.target))
    if transition.source != transition.target:
        resets = (Reset(machine.number, target, "on"), *resets)
    switch = Switch(own, on, off, "effort", resets=resets, transition=transition)
    return [
        Element(own, Kind.SW, None, effort, flow, switch=switch, whole=name, at=own),
        Element(f"{own}.end", Kind.R, one, beyond[0], beyond[1], whole=name, at=own),
    ]

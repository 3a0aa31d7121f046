"""Commands that turn a switch on above zero and off below, as functions of the time and of signals."""

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.equations import StateEquations
from bondgraph.reduce.switch_port import SwitchPort
from codegen.numbers.arrays import Array
from codegen.numbers.lambdified import lambdified


@dataclass(frozen=True)
class Command:
    """The command of a switch, and its value from the time [s] and signals by their names, for numpy.

    ``timed``: whether it holds the time itself.
    """

    name: Hashable
    on: sp.Expr
    off: sp.Expr
    signals: tuple[str, ...]
    value: Callable[..., Any]
    timed: bool = False

    def at(self, times: Array, *signals: Array) -> Array:
        """Its values at many times, from those of its signals there."""
        return np.broadcast_to(np.asarray(self.value(times, *signals), dtype=float), times.shape)


def commands(equations: StateEquations, parameters: Mapping[str, Any]) -> tuple[Command, ...]:
    """Of each switch that goes by one command alone, at these parameters."""
    numbers = {sp.Symbol(name): value for name, value in parameters.items()}
    found = []
    for one in equations.plain_switches:
        if one.guard != "commanded" or one.off != -one.on:
            continue
        names = sorted(one.on.free_symbols - {TIME, *numbers}, key=str)
        value = lambdified([TIME, *names], one.on.subs(numbers))
        timed = TIME in one.on.free_symbols
        found.append(Command(one.name, one.on, one.off, tuple(n.name for n in names), value, timed))
    return tuple(found)


def conditions_told(one: SwitchPort) -> str:
    """When a switch changes over, for people; nothing of one that its own port changes over."""
    if one.side:
        return ""
    return f"turns on as {one.on} rises above zero, off as {one.off} does; zero changes nothing"

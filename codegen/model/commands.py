"""Commands that turn a switch on above zero and off below, as functions of the time and of signals."""

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.equations import StateEquations


@dataclass(frozen=True)
class Command:
    """The command of a switch, and its value from the time [s] and signals by their names, for numpy."""

    name: Hashable
    on: sp.Expr
    off: sp.Expr
    signals: tuple[str, ...]
    value: Callable[..., Any]


def commands(equations: StateEquations, parameters: Mapping[str, Any]) -> tuple[Command, ...]:
    """Of each switch that goes by one command alone, at these parameters."""
    numbers = {sp.Symbol(name): value for name, value in parameters.items()}
    found = []
    for one in equations.switches:
        if one.guard != "commanded" or one.off != -one.on:
            continue
        names = sorted(one.on.free_symbols - {TIME, *numbers}, key=str)
        value = sp.lambdify([TIME, *names], one.on.subs(numbers), "numpy")
        found.append(Command(one.name, one.on, one.off, tuple(n.name for n in names), value))
    return tuple(found)

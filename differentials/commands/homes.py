"""Where commands live, and what a list of them says; each is imported when it is asked for."""

from collections.abc import Iterator, Mapping, MutableMapping
from importlib import import_module
from types import MappingProxyType
from typing import NamedTuple

import click


class Home(NamedTuple):
    """A command: its module among the commands, its function there, and what it does in short."""

    module: str
    function: str
    short: str


COMMANDS: Mapping[str, Home] = MappingProxyType(
    {
        "list": Home("listing", "list_all", "The differentials and scenarios there are."),
        "show": Home("reading", "show", "Equations, causality, parameters, modes."),
        "draw": Home("graphs", "draw", "The bond graph, in the terminal or as a picture."),
        "check": Home(
            "checking", "check", "What is to be asked about a graph: doubts, hints, strokes."
        ),
        "derive": Home("reading", "derive", "The state equations: text, LaTeX or JSON."),
        "explain": Home("reading", "explain", "How the equations come about, step by step."),
        "modes": Home("linearising", "modes", "Frequencies, damping, poles and mode shapes."),
        "linear": Home("linearising", "linear", "The matrices for small deviations, in numbers."),
        "simulate": Home(
            "running", "simulate", "Run it: events, every signal as a table, a picture."
        ),
        "sweep": Home("sweeping", "sweep", "Run it over a grid of numbers; a table of measures."),
        "export": Home("exporting", "export", "Write it as Python, C or an FMU."),
        "convert": Home("graphs", "convert", "Write the graph as JSON or GraphML, to be changed."),
        "figures": Home("tours", "draw_figures", "The paper's Figs. 11 to 14."),
        "demo": Home("tours", "demo", "A tour: equations, causality, modes, two simulations."),
    }
)
"""By name, from the first look to the last use."""


class Homes(MutableMapping[str, click.Command]):
    """The commands by name, each found at its home."""

    def __init__(self) -> None:
        self._found: dict[str, click.Command] = {}

    def __getitem__(self, name: str) -> click.Command:
        if name not in self._found:
            home = COMMANDS[name]
            module = import_module(f"differentials.commands.{home.module}")
            self._found[name] = getattr(module, home.function)
        return self._found[name]

    def __setitem__(self, name: str, command: click.Command) -> None:
        self._found[name] = command

    def __delitem__(self, name: str) -> None:
        del self._found[name]

    def __iter__(self) -> Iterator[str]:
        return iter(COMMANDS)

    def __len__(self) -> int:
        return len(COMMANDS)

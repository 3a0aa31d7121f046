"""Grids and measures of a sweep as they are typed."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import click
import numpy as np

import bondgraph as bg
import codegen
from differentials.commands.names import Assigned, check_names
from differentials.commands.options import Command
from differentials.commands.subject import nodes_called

FORM = "NAME=FROM:TO:COUNT"


def grid(text: str) -> list[float]:
    """Numbers of one name: ``from:to:count`` evenly, ``from:to:count:log`` in equal ratios, or a list.

    >>> grid("0:1:3"), grid("1:100:3:log"), grid("1,2.5")
    ([0.0, 0.5, 1.0], [1.0, 10.0, 100.0], [1.0, 2.5])
    """
    if ":" not in text:
        return [float(part) for part in text.split(",")]
    begin, end, count, *scale = text.split(":")
    if scale not in ([], ["log"]) or int(count) < 1:
        raise ValueError(text)
    first, last = float(begin), float(end)
    if scale and not first * last > 0:
        raise bg.SignalError("equal ratios need two numbers of one sign, neither of them 0")
    space = np.geomspace if scale else np.linspace
    return [float(value) for value in space(first, last, int(count))]


GRID = Assigned(FORM, "k=4300:17200:5", grid)

SIGNALS: Mapping[str, tuple[Callable[[str], Any], str]] = MappingProxyType(
    {
        "peak": (codegen.peak, "The largest magnitude of a signal."),
        "largest": (codegen.largest, "The largest value of a signal."),
        "smallest": (codegen.smallest, "The smallest value of a signal."),
        "final": (codegen.final, "A signal's last value."),
        "integral": (codegen.integral, "A signal integrated over the run."),
    }
)
"""Measures of a signal."""

EVENTS: Mapping[str, tuple[Callable[[Any, str], Any], str]] = MappingProxyType(
    {
        "first": (codegen.first_event, "The time of the first event, such as clutch:stick."),
        "count": (codegen.event_count, "How many events of a kind, such as clutch:slip."),
    }
)
"""Measures of a port's events."""

RUBBING, SWITCHING = ("stick", "slip", "cross"), ("on", "off")
STOPPING = ("hit", "touch", "apart")
"""Events of friction, of switches, and of stops."""


def measure_options(command: Command) -> Command:
    """An option for every measure."""
    for name, (_, text) in reversed([*EVENTS.items()]):
        command = click.option(f"--{name}", multiple=True, metavar="PORT:EVENT",
                               help=f"{text} May be repeated.")(command)  # fmt: skip
    for name, (_, text) in reversed([*SIGNALS.items()]):
        command = click.option(f"--{name}", multiple=True, metavar="SIGNAL",
                               help=f"{text} May be repeated.")(command)  # fmt: skip
    return command


def measures(
    given: Mapping[str, Iterable[str]], signals: Iterable[str], ports: Mapping[Any, Sequence[str]]
) -> dict[str, Any]:
    """Column to measure, such as ``peak_tau_k1`` and ``first_clutch_stick``.

    ``ports``: node to the kinds of event that it has.

    Raises `BondGraphError` for signals, ports and kinds of event that there are not, and for no measure.
    """
    known = list(signals)
    found: dict[str, Any] = {}
    for name, (make, _) in SIGNALS.items():
        check_names(given[name], known, "signal")
        found |= {f"{name}_{one}": make(one) for one in given[name]}
    for name, (count, _) in EVENTS.items():
        for text in given[name]:
            port, _, kind = text.rpartition(":")
            (node,) = nodes_called([port or kind], ports, "friction port or switch")
            check_names([kind], ports[node], "kind of event")
            found[f"{name}_{port}_{kind}"] = count(node, kind)
    if not found:
        raise bg.SignalError(
            "a sweep keeps what is measured: add --peak SIGNAL, --final SIGNAL or --first PORT:EVENT"
        )
    return found

"""Hysteresis: `Hysteresis` as a user writes it, and the elements that it is made of."""

from collections.abc import Hashable, Mapping
from typing import Any

import sympy as sp

from bondgraph.algebra.expressions import expression
from bondgraph.errors import StructureError
from bondgraph.nodes.attributes import unit_of
from bondgraph.nodes.elements import Element, Node, Switch, stated
from bondgraph.nodes.kinds import Kind
from bondgraph.nodes.signals import own_name, source_of, variables_of
from bondgraph.nodes.stops import check_order

KEY = "switch"
"""The part that is a switch; events and modes name it ``<name>.switch``."""


def Hysteresis(
    name: Hashable, input: object, low: object, high: object, off: object = 0, on: object = 1,
    **more: object,
) -> Node:  # fmt: skip
    """A signal of two values: ``on`` once its input is above ``high``, ``off`` once that is below ``low``.

    Between the two it stays what it is; a run begins off, or on where the input is above ``high`` or
    ``initially_on=["<name>.switch"]`` tells so. Both instants are located. ``off`` and ``on`` are numbers,
    parameters or signals; a thermostat that heats while it is cold has ``off=1, on=0``.

    Raises nothing: `validate` looks at nodes.

    >>> import bondgraph as bg, codegen
    >>> room = bg.graph([bg.Sf("heater", "P*heat"), bg.Zero("air"), bg.C("air_heat", "C", effort="T"),
    ...                  bg.R("wall", "R"), Hysteresis("heat", "T", low=19, high=21, off=1, on=0)],
    ...                 "heater > air > air_heat, air > wall")
    >>> ready = codegen.simulator(bg.derive(room), {"P": 3000, "C": 1e5, "R": 0.01})
    >>> run = ready.run([0, 400, 550, 700], initial={"T": 15})
    >>> run["T"].round(2).tolist(), run["heat"].tolist()
    ([15.0, 19.95, 20.19, 19.94], [1.0, 1.0, 0.0, 1.0])
    """
    told = {"value": input, "low": low, "high": high, **more, "off": off, "on": on}
    return stated(name, Kind.HYSTERESIS, told)


def hysteresis_elements(name: Hashable, attributes: Mapping[str, Any]) -> list[Element]:
    """A junction whose effort is the signal: ``off`` by its load, ``on`` by a source behind a switch."""
    where = f"node {name!r}"
    for key, word in (("value", "input"), ("low", "lower bound low"), ("high", "upper bound high")):
        if attributes.get(key) is None:
            raise StructureError(f"{where} has no {word}; give a number, a name or an expression")
    told = {
        key: expression(attributes.get(key, default), f"{where}, {key}")
        for key, default in {"value": 0, "low": 0, "high": 0, "off": 0, "on": 1}.items()
    }
    check_order({key: told[key] for key in ("low", "high")}, where)
    own, read = own_name(name, where), told["value"]
    if own in read.free_symbols:
        raise StructureError(
            f"{where}: its input reads {own} itself, which jumps as it turns; let it read a state between"
        )
    switch = Switch(f"{name}.{KEY}", read - told["high"], told["low"] - read, "effort", reads=read)
    effort, flow = variables_of(name, KEY)
    return [
        Element(name, Kind.ZERO, None, own, None, whole=name, unit=unit_of(attributes, where)),
        Element(f"{name}.load", Kind.R, sp.Integer(1), *variables_of(name, "load"), whole=name),
        source_of(name, "off", Kind.SF, told["off"]),
        Element(
            f"{name}.branch", Kind.ONE, None, None, variables_of(name, "branch")[1], whole=name
        ),
        source_of(name, "on", Kind.SE, told["on"]),
        Element(f"{name}.{KEY}", Kind.SW, None, effort, flow, switch=switch, whole=name),
    ]

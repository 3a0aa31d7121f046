"""Blocks without a memory: each is a `Function` of its input."""

from collections.abc import Hashable
from typing import Any

from bondgraph.algebra.lookup_table import LookupTable
from bondgraph.blocks.told import known, parted, told
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Node
from bondgraph.nodes.signals import Function


def Gain(name: Hashable, input: object, gain: object) -> Node:
    """A signal ``gain`` times as large as its input.

    Raises `StructureError`, naming the node, for what is no number, text or expression.

    >>> import bondgraph as bg
    >>> bg.Gain("u", "ref - omega", "K")
    ('u', {'kind': 'Function', 'value': 'K*(ref - omega)'})
    """
    return Function(name, told(f"node {name!r}", "{gain}*{input}", gain=gain, input=input))


def Sum(name: Hashable, *inputs: object) -> Node:
    """The sum of its inputs; one with a minus before it is taken away.

    Raises `StructureError`, naming the node, where there are no inputs, and for one that is no number, text
    or expression.

    >>> import bondgraph as bg
    >>> bg.Sum("e", "ref", "-omega")[1]["value"]
    'ref - omega'
    """
    where = f"node {name!r}"
    if not inputs:
        raise StructureError(
            f"{where} has no inputs; name what is summed, Sum({name!r}, 'a', '-b')"
        )
    text, parts = "", {}
    for at, one in enumerate(inputs):
        sign, parts[f"s{at}"] = parted(one)
        text += (f" {sign or '+'} " if text else sign) + f"{{s{at}}}"
    return Function(name, told(where, text, **parts))


def Limiter(name: Hashable, input: object, low: object = None, high: object = None) -> Node:
    """Its input as long as that is within bounds, and the bound beyond; None bounds nothing.

    Bounds are numbers, parameters or signals; runs locate the instants at which it comes to one.

    Raises `StructureError`, naming the node, without a bound, and for numbers that leave no room between.

    >>> import bondgraph as bg
    >>> bg.Limiter("tau", "K*(ref - omega)", -2, "most")[1]["value"]
    'min(most, max((-2), (K*(ref - omega))))'
    """
    return Function(name, limited(f"node {name!r}", input, low, high))


def DeadZone(name: Hashable, input: object, low: object, high: object) -> Node:
    """Zero while its input is between two bounds, and beyond them what goes beyond.

    Raises `StructureError`, naming the node, for numbers that leave no room between, and for what is no
    number, text or expression.

    >>> import bondgraph as bg
    >>> bg.DeadZone("play", "phi", -0.1, 0.1)[1]["value"]
    'max(0, phi - 0.1) + min(0, phi - (-0.1))'
    """
    where = f"node {name!r}"
    check_room(where, low, high)
    text = "max(0, {input} - {high}) + min(0, {input} - {low})"
    return Function(name, told(where, text, input=input, low=low, high=high))


def LookUp(name: Hashable, input: object, table: LookupTable) -> Node:
    """What a table has at its input, or at a list of two inputs; the graph need not be given the table.

    Raises `StructureError`, naming the node, for what is no table; `TableError` where the table takes
    another number of inputs.

    >>> import bondgraph as bg
    >>> most = bg.LookupTable("most", [0, 100, 200], [10, 30, 20])
    >>> bg.LookUp("limit", "omega", most)
    ('limit', {'kind': 'Function', 'value': most(omega)})
    """
    if not isinstance(table, LookupTable):
        raise StructureError(f"node {name!r}: {table!r} is no table; give a LookupTable")
    return Function(name, table(*input) if isinstance(input, list | tuple) else table(input))


def limited(where: str, input: Any, low: Any, high: Any) -> Any:
    """The value of a limiter."""
    check_room(where, low, high)
    if low is None and high is None:
        raise StructureError(f"{where}: a limiter without a bound limits nothing; give low or high")
    if low is None:
        return told(where, "min({high}, {input})", high=high, input=input)
    if high is None:
        return told(where, "max({low}, {input})", low=low, input=input)
    return told(where, "min({high}, max({low}, {input}))", high=high, low=low, input=input)


def check_room(where: str, low: Any, high: Any) -> None:
    """Refuse two numbers that leave no room between them."""
    a, b = known(low, where), known(high, where)
    if a is not None and b is not None and a >= b:
        raise StructureError(f"{where}: low {a} is not below high {b}")

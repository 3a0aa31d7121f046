"""Names in values that are inputs: the opening of a valve, a mass that is filled."""

from collections.abc import Iterable
from dataclasses import replace

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.declare.names import named_by
from bondgraph.errors import StructureError, nearest
from bondgraph.reduce.structure import JunctionStructure


def opened(structure: JunctionStructure, inputs: Iterable[str]) -> JunctionStructure:
    """The structure whose values read these names as inputs.

    Raises `StructureError` for a name that no value reads, and for one that means something else.
    """
    if isinstance(inputs, str) or not isinstance(inputs, Iterable):
        raise StructureError(f"inputs must be a list of names, not {inputs!r}")
    names = tuple(dict.fromkeys(map(str, inputs)))
    if not names:
        return structure
    read = {name.name: name for name in _read(structure)}
    signals = {name.name for one in structure.elements.values() for name in named_by(one)}
    for name in names:
        if name in signals or name == TIME.name:
            what = "the time" if name == TIME.name else "a signal of the graph"
            raise StructureError(f"{name} can be no input of values: it is {what}")
        if name not in read:
            raise StructureError(f"no value reads an input {name}{nearest(name, sorted(read))}")
    return replace(structure, opened=tuple(read[name] for name in names))


def _read(structure: JunctionStructure) -> set[sp.Symbol]:
    """The names that values of storages, resistances and two-ports read."""
    used: set[sp.Symbol] = set()
    for element in structure.elements.values():
        if element.value is not None and not element.kind.supplies:
            used |= element.value.free_symbols
        used |= set().union(*(entry.free_symbols for _, entry in element.row))
    return used

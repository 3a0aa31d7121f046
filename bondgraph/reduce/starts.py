"""Declared starts: of states alone, by numbers and parameters."""

from bondgraph.errors import StructureError
from bondgraph.reduce.sorting import Reduction


def check_starts(reduction: Reduction) -> None:
    """Refuse the start of what is no state, and one that reads a signal."""
    structure = reduction.structure
    signals = {*reduction.names, *reduction.inputs, *structure.states_of_laws}
    signals |= {name for port in structure.ports for name in (port.given, port.received)}
    for at, port in enumerate(structure.ports):
        element = port.element
        if element.start is None:
            continue
        if at in reduction.dependent:
            raise StructureError(
                f"node {element.name!r} has a start, but is dependent: others rule its {port.received}; "
                "give these a start, or it a higher priority"
            )
        if read := sorted(element.start.free_symbols & signals, key=str):
            raise StructureError(
                f"node {element.name!r}: its start reads {read[0]}, a signal; it holds numbers and parameters"
            )

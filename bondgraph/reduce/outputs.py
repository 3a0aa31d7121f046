"""Named signals: what each node's variables are over the ports, and which of them are shown."""

from collections.abc import Hashable, Iterable

import sympy as sp

from bondgraph.algebra.exact import fixed
from bondgraph.algebra.residues import is_zero
from bondgraph.errors import StructureError
from bondgraph.nodes.elements import Element
from bondgraph.reduce.record import Reading
from bondgraph.reduce.sorting import Reduction
from bondgraph.reduce.structure import JunctionStructure, PortRow


def named_signals(reduction: Reduction) -> dict[sp.Symbol, PortRow]:
    """Every named effort and flow: of one-ports both, of junctions the common one.

    Raises `StructureError` where one name stands for two different quantities.
    """
    structure = reduction.structure
    found: dict[sp.Symbol, PortRow] = {}
    for at, port in enumerate(structure.ports):
        _add(reduction, found, port.given, fixed({at: sp.Integer(1)}))
        _add(reduction, found, port.received, structure.rows[at])
    for name, row in structure.common.items():
        symbol = _common(structure, name)
        if symbol is not None:
            _add(reduction, found, symbol, row)
    return found


def shown_signals(
    structure: JunctionStructure, outputs: Iterable[Hashable] | None
) -> list[tuple[sp.Symbol, PortRow]]:
    """The signal each output node shows: what a one-port receives, what a junction has in common.

    Of a function it is the function. Unless told, those of open ports, functions and hystereses.
    """
    if outputs is None:
        outputs = [
            port.element.name
            for port in structure.ports
            if _is_open(port.element) or port.element.is_function
        ]
        outputs += [one for one in structure.common if structure.elements[one].is_effort_told]
    if isinstance(outputs, str) or not isinstance(outputs, Iterable):
        raise StructureError(f"outputs must be a list of nodes, not {outputs!r}")
    numbers = {port.element.name: at for at, port in enumerate(structure.ports)}
    result: list[tuple[sp.Symbol, PortRow]] = []
    for name in outputs:
        if not isinstance(name, Hashable) or name not in structure.elements:
            raise StructureError(f"output {name!r} is not a node of the graph")
        if name in numbers:
            at, port = numbers[name], structure.ports[numbers[name]]
            shown = (port.received, structure.rows[at])
            if port.element.is_function:
                shown = (port.given, fixed({at: sp.Integer(1)}))
            result.append(shown)
        else:
            result.append((_named_common(structure, name), structure.common[name]))
    return result


def _is_open(element: Element) -> bool:
    return element.kind.resists and element.gives is not None and element.law is None


def _named_common(structure: JunctionStructure, name: Hashable) -> sp.Symbol:
    if name not in structure.common:
        raise StructureError(
            f"output {name!r} is a {structure.elements[name].kind}, which has two efforts and two "
            "flows; name a junction or a one-port beside it"
        )
    symbol = _common(structure, name)
    if symbol is None:
        raise StructureError(
            f"output {name!r}: the junction's name makes no symbol; name its variable with "
            "effort=... or flow=..."
        )
    return symbol


def _common(structure: JunctionStructure, name: Hashable) -> sp.Symbol | None:
    element = structure.elements[name]
    return element.common


def _add(
    reduction: Reduction, found: dict[sp.Symbol, PortRow], symbol: sp.Symbol, row: PortRow
) -> None:
    """Enter a signal; the same name again must be the same quantity."""
    known = found.setdefault(symbol, row)
    if known is row or known == row:
        return
    if not _equal(reduction.reading(known), reduction.reading(row)):
        raise StructureError(
            f"two different quantities are called {symbol}; names may be equal only where the "
            f"quantities are, so rename one; a source that repeats it has the value '1*{symbol}'"
        )


def _equal(one: Reading, other: Reading) -> bool:
    pairs = ((one.F, other.F), (one.D, other.D), (one.H, other.H), (one.K, other.K))
    return all(
        is_zero(a.get(column, sp.Integer(0)) - b.get(column, sp.Integer(0)))
        for a, b in pairs
        for column in a.keys() | b.keys()
    )

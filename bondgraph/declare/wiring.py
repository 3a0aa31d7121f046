"""What each wire into a node brings: a signal that it reads by name, or one that a port of it stands for."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from bondgraph.algebra.atoms import symbol
from bondgraph.declare.carried import Carried, carried
from bondgraph.declare.quantities import kept_names, name_text
from bondgraph.declare.renaming import names_read_at
from bondgraph.errors import StructureError, nearest
from bondgraph.nodes.attributes import kind_of
from bondgraph.nodes.elements import Bond
from bondgraph.nodes.fields import port_names
from bondgraph.nodes.kinds import SIGNALS, Kind

FED = frozenset({Kind.SE, Kind.SF, Kind.TF, Kind.GY})
"""The kinds whose value may come by a wire."""

VALUE = "value"
"""What stands for the port of one of these."""

_NO_SIGNAL = "{!r} has no signal of its own; wire a detector or a junction beside it"

KEYS = frozenset({"port", "tail_port", "head_port", "signal"})
"""The attributes of a wire."""


@dataclass(frozen=True)
class Wire:
    """What ``reader`` reads of ``source``, both as declared: the ``names`` of the signals.

    ``port``: the one of the reader that it stands for, if it does.
    """

    source: Hashable
    reader: Hashable
    names: tuple[str, ...] = ()
    port: str | None = None

    def __str__(self) -> str:
        return f"wire {self.source!r} > {self.reader!r}"


def has_ports(attributes: Mapping[str, Any]) -> bool:
    """Whether a node of signals has names that stand for what wires bring."""
    return str(attributes.get("kind")) in SIGNALS and attributes.get("ports") is not None


def ports_of(graph: Any, name: Hashable) -> tuple[str, ...]:
    """The names that stand for what wires bring to a node."""
    attributes = graph.nodes[name]
    if not has_ports(attributes):
        waits = str(attributes.get("kind")) in FED and attributes.get(VALUE) is None
        return (VALUE,) if waits else ()
    found = port_names(attributes["ports"], f"node {name!r}")
    kept = [one for one in kept_names(attributes) if one in found]
    if kept or "t" in found:
        raise StructureError(
            f"node {name!r}: the port {(*kept, 't')[0]} has the name of "
            f"{'what it keeps' if kept else 'the time'}; rename it"
        )
    return found


def wires_into(graph: Any, bonds: Any, reader: Hashable, edges: Iterable[Bond]) -> list[Wire]:
    """The wires that lead to a node, each with what it brings, and the port that it stands for."""
    ports, read = ports_of(graph, reader), names_read_at(reader, graph.nodes[reader])
    wires: list[Wire] = []
    left: list[tuple[int, Carried]] = []
    for tail, _ in edges:
        wire, told = Wire(tail, reader), graph.edges[tail, reader]
        _check_edge(wire, told)
        out, port = _ends(graph, wire, told)
        can = _chosen(carried(bonds, tail, out), told.get("signal"), wire)
        names = tuple(name for name in can.names if name in read)
        if port is not None:
            wire = replace(wire, names=(_one(can, wire),), port=port)
        elif names:
            wire = replace(wire, names=names)
        else:
            left.append((len(wires), can))
        wires.append(wire)
    free = [port for port in ports if port not in {wire.port for wire in wires}]
    if left and (len(free) != 1 or len(left) != 1):
        at, can = left[-1]
        raise _refusal(wires[at], can, bonds, ports, free, read)
    for at, can in left:
        wires[at] = replace(wires[at], names=(_one(can, wires[at]),), port=free[0])
    return wires


def _check_edge(wire: Wire, told: Mapping[str, Any]) -> None:
    if wire.source == wire.reader:
        raise StructureError(f"node {wire.source!r} is wired to itself; remove that edge")
    unknown = sorted(map(str, told.keys() - KEYS))
    if unknown:
        raise StructureError(
            f"{wire}: unknown attribute {unknown[0]!r}; a wire may carry signal, the name of what it brings, "
            "and port, that of the port that it stands for"
        )


def _ends(graph: Any, wire: Wire, told: Mapping[str, Any]) -> tuple[str | None, str | None]:
    """The ports that an edge names, of the field at its tail and of the reader."""
    known = {end: _named_ports(graph, end) for end in (wire.reader, wire.source)}
    given = {wire.source: told.get("tail_port"), wire.reader: told.get("head_port")}
    if (port := name_text(told.get("port"))) is not None:
        end = next((end for end in known if port in known[end] and given[end] is None), None)
        given[wire.reader if end is None else end] = port
    for end, port in given.items():
        if port is not None and name_text(port) not in known[end]:
            listed = ", ".join(known[end])
            raise StructureError(
                f"{wire}: {end!r} has no port {port!r}{nearest(str(port), known[end])}; "
                + (f"there are {listed}" if listed else "leave it out")
            )
    if given[wire.source] is not None and str(graph.nodes[wire.source].get("kind")) in SIGNALS:
        raise StructureError(
            f"{wire}: the port {given[wire.source]} of {wire.source!r} is what it reads; a wire from it "
            "brings what it is or gives"
        )
    return name_text(given[wire.source]), name_text(given[wire.reader])


def _named_ports(graph: Any, name: Hashable) -> tuple[str, ...]:
    """The ports that an edge may name at a node, of a field, too."""
    ports = graph.nodes[name].get("ports")
    return () if ports is None else port_names(ports, f"node {name!r}")


def _chosen(can: Carried, signal: object, wire: Wire) -> Carried:
    """What a wire may bring, where the edge names it that alone."""
    if signal is None:
        return can
    name = str(name_text(getattr(signal, "name", signal)))
    if name not in can.names:
        raise StructureError(
            f"{wire}: {wire.source!r} has no signal {name!r}{nearest(name, can.names)}; there are "
            f"{', '.join(can.names) or 'none'}"
        )
    return Carried((name,), name)


def _one(can: Carried, wire: Wire) -> str:
    """The signal that fills a port."""
    if can.own is not None:
        return str(symbol(can.own, str(wire)))
    if not can.names:
        raise StructureError(f"{wire}: {_NO_SIGNAL.format(wire.source)}")
    raise StructureError(
        f"{wire}: {wire.source!r} has several signals, {', '.join(can.names)}; name one, "
        f"signal={can.names[0]!r} on the edge"
    )


def _refusal(
    wire: Wire, can: Carried, bonds: Any, ports: Sequence[str], free: Sequence[str], read: set[str]
) -> StructureError:
    """Why a wire that names no port brings nothing that its reader reads."""
    kind = kind_of(bonds.nodes[wire.reader], f"node {wire.reader!r}")
    if len(free) > 1:
        return StructureError(
            f"{wire}: {kind} {wire.reader!r} has the ports {', '.join(free)}; name one on the edge, "
            f"port={free[0]!r}, or in the path, '... > {wire.reader}.{free[0]}'"
        )
    if not can.names:
        return StructureError(f"{wire}: {_NO_SIGNAL.format(wire.source)}")
    what = can.own or f"any of {', '.join(can.names)}"
    if free and ports != (VALUE,):
        return StructureError(
            f"{wire}: {kind} {wire.reader!r} has one port, {free[0]}, and several wires; let a Function put "
            "their signals together, or give it a port for each"
        )
    if ports:
        return StructureError(
            f"{wire}: {kind} {wire.reader!r} does not read {what}, and another wire stands for "
            f"{'its value' if ports == (VALUE,) else 'all its ports'}; write the signal by this name, or let "
            "a Function put signals together"
        )
    if kind.joins and not read:
        return StructureError(
            f"{wire}: {kind.word} {wire.reader!r} reads nothing; a signal acts on bonds by way of a source, "
            "a modulated transformer or gyrator, or a condition"
        )
    told = ", ".join(sorted(read)) or "nothing"
    way_out = "Write the signal where it is meant, by this name, or remove the wire"
    if {*carried(bonds, wire.reader).names} & {
        *names_read_at(wire.source, bonds.nodes[wire.source])
    }:
        turned = f"{wire.reader!r} > {wire.source!r}"
        way_out = f"{wire.source!r} reads what it gives: turn the wire round, {turned}"
    return StructureError(
        f"{wire}: {kind} {wire.reader!r} does not read {what}; it reads {told}. {way_out}"
    )

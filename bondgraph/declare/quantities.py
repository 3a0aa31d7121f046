"""What a node of a declared graph names: its efforts, flows, states, and itself where it is a signal."""

from collections.abc import Hashable, Iterator, Mapping
from typing import Any

from bondgraph.algebra.atoms import normal
from bondgraph.errors import StructureError
from bondgraph.nodes.attributes import bare_name
from bondgraph.nodes.kinds import BOUNDS, POSITION, Kind
from bondgraph.nodes.parts import LAST, NUMBER, ending


def quantities(
    name: Hashable, attributes: Mapping[str, Any]
) -> Iterator[tuple[str, str, str | None]]:
    """What a node names: what the default name begins and ends with, and the name given or None."""
    if not attributes:
        yield from (("e_", "", None), ("f_", "", None))
        return
    kind = _kind(name, attributes)
    if kind.signals:
        yield from _of_signals(kind, attributes)
        return
    ports = attributes.get("ports")
    for key in ("effort", "flow"):
        if kind.two_port or ((kind.joins or kind is Kind.STOP) and key not in kind.nature.keys):
            continue
        given = attributes.get(key)
        if kind.supplies and key not in kind.nature.keys:
            given = _bare(name, attributes.get("value"))
        if ports is None:
            yield f"{key[0]}_", "", name_text(given)
        for port in ports or ():
            yield f"{key[0]}_", f"_{port}", name_text((given or {}).get(port))
    yield from _further(kind, attributes)


def _further(kind: Kind, attributes: Mapping[str, Any]) -> Iterator[tuple[str, str, str | None]]:
    """The same beside effort and flow: states of laws, integrals, the ports of controlled junctions."""
    ports = attributes.get("ports")
    if kind.stores and any(attributes.get(key) is not None for key in ("law", "energy")):
        for ending in ("",) if ports is None else (f"_{port}" for port in ports):
            yield f"{kind.letter}_", ending, None
    if kind.joins and (attributes.keys() & {"on", "off", "reset"}):
        yield from (("e_", "_switch", None), ("f_", "_switch", None))
    if kind is Kind.STOP:
        yield "q_", "", None
        for part in _stop_parts(attributes):
            yield from (("e_", f"_{part}", None), ("f_", f"_{part}", None))
    if attributes.get("integrate") is not None:
        yield "", "", name_text(attributes["integrate"])


def _stop_parts(attributes: Mapping[str, Any]) -> tuple[str, ...]:
    """The names of a stop's parts beside its junction."""
    return (POSITION, *(key for key in BOUNDS if attributes.get(key) is not None))


def _of_signals(kind: Kind, attributes: Mapping[str, Any]) -> Iterator[tuple[str, str, str | None]]:
    """A function or a state by its own name, a controller by what it keeps and gives; then their parts.

    A state machine by its own name, by those of its modes and by what it keeps.
    """
    kept = list(kept_names(attributes)) if kind in (Kind.CONTROLLER, Kind.MACHINE) else []
    yield from (("", "", one) for one in kept)
    if kind is not Kind.CONTROLLER:
        yield "", "", None
    if kind is not Kind.FUNCTION:
        yield "e_", "", None
    yield "f_", "", None
    parts = [*kept, *PARTS.get(kind, ())]
    if kind is Kind.STATE:
        yield "rate_", "", None
        bounds = [key for key in BOUNDS if attributes.get(key) is not None]
        parts += [POSITION, *bounds] if bounds else []
    if kind is Kind.MACHINE:
        for mode in listed(attributes.get("modes")):
            yield from (("", f"_{mode}", None), ("f_", f"_is_{mode}", None))
        ends = map(ending, listed(attributes.get("transitions")))
        parts += [NUMBER, *(f"{end}{last}" for end in ends for last in ("", LAST))]
    for part in parts:
        yield from (("e_", f"_{part}", None), ("f_", f"_{part}", None))


PARTS: Mapping[Kind, tuple[str, ...]] = {
    Kind.HYSTERESIS: ("load", "off", "branch", "on", "switch"),
    Kind.RATE_LIMITER: ("mass", "drift", "slip", "input", "clutch"),
}
"""The parts of nodes that are the same whatever their attributes."""


def listed(given: Any) -> list[str]:
    """The names in a list or a mapping, if it is one."""
    return (
        [str(name_text(one)) for one in given] if isinstance(given, Mapping | list | tuple) else []
    )


def kept_names(attributes: Mapping[str, Any]) -> Iterator[str]:
    """What a controller keeps: its states, then what it gives, each once."""
    named = [attributes.get(key) for key in ("states", "outputs")]
    lists = [told for told in named if isinstance(told, Mapping | list | tuple)]
    yield from dict.fromkeys(str(name_text(one)) for told in lists for one in told)


def _kind(name: Hashable, attributes: Mapping[str, Any]) -> Kind:
    try:
        return Kind(str(attributes.get("kind")))
    except ValueError:
        raise StructureError(
            f"node {name!r}: kind {attributes.get('kind')!r}; there are {', '.join(Kind)}. A part is "
            "the graph as declared, and its terminals have no attributes at all or a kind"
        ) from None


def _bare(name: Hashable, value: object) -> str | None:
    """The input that a source's value names, if it is one name; there is none where a wire feeds it."""
    if value is None:
        return None
    found = bare_name(value, f"node {name!r}")
    return None if found is None else found.name


def name_text(name: Any) -> str | None:
    """A name as it is compared."""
    return None if name is None else str(normal(str(name)))

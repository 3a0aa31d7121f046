"""GraphML is looked through before anything is built of it."""

from collections.abc import Iterable
from xml.parsers import expat

from bondgraph.errors import FileFormatError

_NAMESPACE = "http://graphml.graphdrawing.org/xmlns "
_SCHEMA = "http://www.w3.org/2001/XMLSchema-instance schemaLocation"
_TAGS: dict[str, tuple[str | None, frozenset[str]]] = {
    "graphml": (None, frozenset({_SCHEMA})),
    "key": ("graphml", frozenset({"id", "for", "attr.name", "attr.type"})),
    "graph": ("graphml", frozenset({"edgedefault"})),
    "node": ("graph", frozenset({"id"})),
    "edge": ("graph", frozenset({"source", "target"})),
    "data": ("graph node edge", frozenset({"key"})),
}
"""The elements a file may have: in what they stand, and their XML attributes."""


def check_xml(text: str) -> None:
    """Refuse all GraphML but the plain kind: one directed graph, texts as attributes, nothing twice.

    Raises `FileFormatError`; for document types and entities before anything is expanded.

    >>> check_xml("<!DOCTYPE bomb><graphml/>")
    Traceback (most recent call last):
    bondgraph.errors.FileFormatError: a document type or entity is not allowed; remove the <!DOCTYPE ...>
    """
    _Checker().check(text)


class _Checker:
    """One pass over the XML that builds nothing and stops at the first thing that does not belong."""

    def __init__(self) -> None:
        self._open: list[str] = []
        self._seen: set[tuple[str, ...]] = set()
        self._ends: list[str] = []
        self._at = 0

    def check(self, text: str) -> None:
        parser = expat.ParserCreate("utf-8", " ")
        parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = self._refuse_types
        parser.StartElementHandler = self._start
        parser.EndElementHandler = lambda _: self._open.pop()
        try:
            parser.Parse(text.encode("utf-8"), True)
        except (expat.ExpatError, UnicodeEncodeError) as error:
            raise FileFormatError(f"not XML: {error}") from None
        if ("graph",) not in self._seen:
            raise FileFormatError("no GraphML of a bond graph: there is no graph in it")
        for end in self._ends:
            if ("node", end) not in self._seen:
                raise FileFormatError(f"a bond ends at {end!r}, but there is no such node")

    def _refuse_types(self, *_: object) -> None:
        raise FileFormatError("a document type or entity is not allowed; remove the <!DOCTYPE ...>")

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        tag = tag.removeprefix(_NAMESPACE)
        inside = self._open[-1] if self._open else None
        place, allowed = _TAGS.get(tag, ("", frozenset()))
        if tag not in _TAGS or (inside != place and inside not in (place or "").split()):
            raise FileFormatError(
                f"XML element {tag[:60]!r} in {inside!r} has no place in a bond graph"
            )
        if set(attributes) - allowed or (allowed - set(attributes) - {_SCHEMA}):
            raise FileFormatError(
                f"XML element {tag!r}: it must have exactly {', '.join(sorted(allowed)) or 'nothing'}"
            )
        self._open.append(tag)
        self._at += tag != "data"
        self._check_once(tag, attributes)

    def _check_once(self, tag: str, attributes: dict[str, str]) -> None:
        """Refuse what comes twice, and what is not directed or no text."""
        if attributes.get("edgedefault", "directed") != "directed":
            raise FileFormatError("the graph must be directed; an edge is a bond with a direction")
        if attributes.get("attr.type", "string") != "string":
            raise FileFormatError(f"key {attributes['attr.name']!r}: attributes are of type string")
        for mark in self._marks(tag, attributes):
            if mark in self._seen:
                raise FileFormatError(f"{' '.join(mark[:2])!r} is there twice; keep one")
            self._seen.add(mark)

    def _marks(self, tag: str, attributes: dict[str, str]) -> Iterable[tuple[str, ...]]:
        """What tells this XML element from others."""
        if tag == "edge":
            ends = attributes["source"], attributes["target"]
            self._ends.extend(ends)
            return [("edge", *ends)]
        if tag == "data":
            return [("data", attributes["key"], str(self._at))]
        if tag == "key":
            return [("key", attributes["id"]), ("key", attributes["for"], attributes["attr.name"])]
        return [(tag, attributes["id"])] if tag == "node" else [(tag,)]

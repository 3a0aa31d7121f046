"""Bond graphs as GraphML: what other graph programs read. All attributes are texts."""

import io
import re
from collections.abc import Hashable, Iterable
from typing import Any

import networkx as nx

from bondgraph.declare.tables import TABLES
from bondgraph.errors import FileFormatError
from bondgraph.files.declarations import Declaration, declaration
from bondgraph.files.nodelink import line, parsed
from bondgraph.files.restored import check_type, restored
from bondgraph.files.safexml import check_xml
from bondgraph.nodes.kinds import NAMED
from bondgraph.tables.record import Sampled

_INTEGER = re.compile(r"-?[0-9]{1,500}")
_NO_XML = re.compile("[^\t\n\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML cannot hold, and the carriage return, which it turns into another."""

_NESTED = frozenset(
    {"value", "law", "ports", "effort", "flow", "gives", "reset", "start", "reads", "modes"}
    | {*NAMED}
)


def to_graphml(graph: Any) -> str:
    """The graph as GraphML text, which `from_graphml` reads as a graph of the same equations.

    A node's id is its name; a name that is an integer stands beside it as ``integer``. What has
    parts, dry friction or a matrix, is a JSON text.

    Raises what `to_json` raises, and `FileFormatError` for characters that XML cannot hold.

    >>> import bondgraph as bg
    >>> graph = nx.DiGraph()
    >>> graph.add_nodes_from([bg.Se("s", "u"), bg.R("r", 2.5)])
    >>> graph.add_edge("s", "r")
    >>> from_graphml(to_graphml(graph)).nodes["r"]
    {'kind': 'R', 'value': '2.5'}
    """
    told = declaration(graph)
    ids: dict[Hashable, str] = {name: name for name, _ in told.nodes if isinstance(name, str)}
    taken = set(ids.values())
    result: nx.DiGraph[str] = nx.DiGraph(format="bondgraph", version="1")
    if told.name is not None:
        result.graph["name"] = _xml(told.name, "the graph's name")
    if told.tables:
        result.graph[TABLES] = line(told.tables)
    for name, attributes in told.nodes:
        texts = _texts(attributes, f"node {name!r}")
        if not isinstance(name, str):
            ids[name] = texts["integer"] = format(name, "d")
            while ids[name] in taken:
                ids[name] += "#"
            taken.add(ids[name])
        result.add_node(ids[name], **texts)
        _xml(ids[name], f"node {name!r}", empty=True)
    for tail, head, more in told.bonds:
        texts = _texts(more, f"bond {tail!r} -> {head!r}")
        result.add_edge(ids[tail], ids[head], **texts)
    buffer = io.BytesIO()
    nx.write_graphml_xml(result, buffer)
    return buffer.getvalue().decode("utf-8").rstrip("\n") + "\n"


def _texts(attributes: dict[str, Any], where: str) -> dict[str, str]:
    """The attributes as texts; lists and objects as the text that JSON has for them."""
    texts = {}
    for key, value in attributes.items():
        nested = line(value) if isinstance(value, list | dict) else value
        text = nested if isinstance(nested, str) else _number_text(nested)
        texts[key] = _xml(text, f"{where}, {key}")
    return texts


def _number_text(value: float) -> str:
    return format(value, "d") if isinstance(value, int) else float.__repr__(value)


def _xml(text: str, where: str, empty: bool = False) -> str:
    found = _NO_XML.search(text)
    if found:
        raise FileFormatError(
            f"{where}: GraphML cannot hold the character {found[0]!r}; write JSON"
        )
    if not text and not empty:
        raise FileFormatError(
            f"{where}: GraphML cannot hold an empty text; leave it out, or write JSON"
        )
    return text


def from_graphml(text: str, tables: Iterable[Sampled] = ()) -> "nx.DiGraph[Hashable]":
    """The graph that a GraphML text of `to_graphml` holds, validated.

    ``tables``: `LookupTable` objects that its values and laws may call, beside its own.

    Document types and entities are refused before anything is expanded; so is every element and
    attribute that a bond graph has no use for.

    Raises `FileFormatError` for text that is not such GraphML, and what `validate` raises.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph([("u", "loop"), ("loop", "L")])
    >>> g.add_nodes_from([bg.Se("u", "u"), bg.One("loop"), bg.I("L", "L")])
    >>> sorted(from_graphml(to_graphml(g)).edges)
    [('loop', 'L'), ('u', 'loop')]
    """
    check_xml(text)
    try:
        raw = nx.parse_graphml(text)
    except (nx.NetworkXError, SyntaxError, LookupError, TypeError, ValueError) as error:
        raise FileFormatError(f"not GraphML of a bond graph: {error}") from None
    header = {key: raw.graph[key] for key in raw.graph if not key.endswith("_default")}
    if header.pop("format", None) != "bondgraph" or header.pop("version", None) != "1":
        raise FileFormatError(
            "no GraphML of a bond graph: the graph needs format 'bondgraph' and version '1'"
        )
    name, own = header.pop("name", None), parsed(header.pop(TABLES, "[]"))
    check_type(own, (list,), "the graph's tables")
    if header:
        raise FileFormatError(f"graph attribute {min(header)!r} is unknown; remove it")
    names = {id_: _name(id_, texts) for id_, texts in raw.nodes(data=True)}
    nodes = [(names[id_], _attributes(id_, texts)) for id_, texts in raw.nodes(data=True)]
    bonds = [
        (names[tail], names[head], _attributes(tail, texts))
        for tail, head, texts in raw.edges(data=True)
    ]
    return restored(Declaration(name, tuple(nodes), tuple(bonds), tuple(own)), tables)


def _name(id_: str, texts: dict[str, str]) -> Hashable:
    if "integer" not in texts:
        return id_
    if not _INTEGER.fullmatch(texts["integer"]):
        raise FileFormatError(f"node {id_!r}: {texts['integer'][:60]!r} is not an integer")
    return int(texts["integer"])


def _attributes(id_: str, texts: dict[str, str]) -> dict[str, Any]:
    result: dict[str, Any] = {key: text for key, text in texts.items() if key != "integer"}
    for key, text in result.items():
        if key in _NESTED and text.startswith(("[", "{")):
            result[key] = parsed(text)
    if "priority" in result:
        text = result["priority"]
        try:
            result["priority"] = int(text) if _INTEGER.fullmatch(text) else float(text)
        except ValueError:
            raise FileFormatError(f"node {id_!r}: priority {text[:60]!r} is not a number") from None
    return result

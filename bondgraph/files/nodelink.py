"""Bond graphs as JSON in networkx's node-link layout."""

import json
import math
from collections.abc import Hashable, Iterable
from typing import Any

import networkx as nx

from bondgraph.algebra.atoms import MAX_DIGITS
from bondgraph.declare.tables import TABLES
from bondgraph.errors import FileFormatError
from bondgraph.files.declarations import Declaration, declaration
from bondgraph.files.restored import check_type, restored
from bondgraph.tables.record import Sampled

VERSION = 1
MAX_PARTS = 500_000
"""Lists and objects in one text; no graph that fits into a file has as many, and each takes memory."""

_LAYOUT = {"directed": True, "multigraph": False}
_TYPES = {"nodes": (list,), "edges": (list,), "graph": (dict,)}


def to_json(graph: Any) -> str:
    """The graph as JSON text, which `from_json` reads as a graph of the same equations.

    The layout is networkx's node-link with ``format`` and ``version`` before it. Nodes and bonds keep
    their order; texts, integers and floats stay as they were given, other values become text. The
    same graph gives the same text.

    Raises what `validate` raises, and `FileFormatError`, naming the node, for what text cannot say:
    symbols with assumptions.

    >>> import bondgraph as bg
    >>> graph = nx.DiGraph()
    >>> graph.add_nodes_from([bg.Se("s", "u"), bg.R("r", 2.5)])
    >>> graph.add_edge("s", "r")
    >>> print(to_json(graph), end="")
    {
     "format": "bondgraph",
     "version": 1,
     "directed": true,
     "multigraph": false,
     "graph": {},
     "nodes": [
      {"id": "s", "kind": "Se", "value": "u"},
      {"id": "r", "kind": "R", "value": 2.5}
     ],
     "edges": [
      {"source": "s", "target": "r"}
     ]
    }
    """
    told = declaration(graph)
    head: dict[str, Any] = {
        "format": "bondgraph",
        "version": VERSION,
        **_LAYOUT,
        "graph": {} if told.name is None else {"name": told.name},
    }
    if told.tables:
        head["graph"] |= {TABLES: told.tables}
    nodes = [line({"id": name, **attributes}) for name, attributes in told.nodes]
    bonds = [line({"source": tail, "target": to, **more}) for tail, to, more in told.bonds]
    entries = [f"{line(key)}: {line(value)}" for key, value in head.items()]
    for key, lines in (("nodes", nodes), ("edges", bonds)):
        entries.append(
            f"{line(key)}: [\n  " + ",\n  ".join(lines) + "\n ]" if lines else f'"{key}": []'
        )
    return "{\n " + ",\n ".join(entries) + "\n}\n"


def line(value: object) -> str:
    """A value as JSON on one line."""
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def from_json(text: str, tables: Iterable[Sampled] = ()) -> "nx.DiGraph[Hashable]":
    """The graph that a JSON text of `to_json` holds, validated.

    ``tables``: `LookupTable` objects that its values and laws may call, beside its own.

    Raises `FileFormatError` for text that is not such JSON - another version, unknown or repeated keys,
    wrong types, NaN, nodes or bonds that come twice - and what `validate` raises.

    >>> from_json('{"format": "bondgraph", "version": 2}')
    Traceback (most recent call last):
    bondgraph.errors.FileFormatError: version 2 is unknown; this toolkit reads version 1
    """
    data = parsed(text)
    check_type(data, (dict,), "a bond graph in JSON")
    if data.get("format") != "bondgraph" or "version" not in data:
        raise FileFormatError('not a bond graph: "format" must be "bondgraph", with a "version"')
    if type(data["version"]) is not int or data["version"] != VERSION:
        raise FileFormatError(
            f"version {str(data['version'])[:60]} is unknown; this toolkit reads version {VERSION}"
        )
    _check_keys(data, {"format", "version", "nodes", "edges"}, {*_LAYOUT, "graph"}, "the file")
    for key, types in _TYPES.items():
        check_type(data.get(key, {}), types, key)
    for key, value in _LAYOUT.items():
        if data.get(key, value) is not value:
            raise FileFormatError(f"{key} must be {json.dumps(value)}; an edge is one bond")
    about = data.get("graph", {})
    _check_keys(about, set(), {"name", TABLES}, "graph")
    if "name" in about:
        check_type(about["name"], (str,), "the graph's name")
    own = about.get(TABLES, [])
    check_type(own, (list,), "the graph's tables")
    nodes, bonds = [], []
    for index, node in enumerate(data["nodes"]):
        check_type(node, (dict,), f"nodes[{index}]")
        _check_keys(node, {"id"}, set(node), f"nodes[{index}]")
        nodes.append((node.pop("id"), node))
    for index, edge in enumerate(data["edges"]):
        check_type(edge, (dict,), f"edges[{index}]")
        _check_keys(edge, {"source", "target"}, set(edge), f"edges[{index}]")
        bonds.append((edge.pop("source"), edge.pop("target"), edge))
    told = Declaration(about.get("name"), tuple(nodes), tuple(bonds), tuple(own))
    return restored(told, tables)


def parsed(text: str) -> Any:
    """What a JSON text holds; `FileFormatError` for NaN, repeated keys and numbers without end."""
    if text.count("[") + text.count("{") > MAX_PARTS:
        raise FileFormatError(f"more than {MAX_PARTS} lists and objects, or nested too deeply")
    try:
        return json.loads(
            text,
            object_pairs_hook=_object,
            parse_constant=lambda name: _number(name, float),
            parse_float=lambda digits: _number(digits, float),
            parse_int=lambda digits: _number(digits, int),
        )
    except json.JSONDecodeError as error:
        raise FileFormatError(f"not JSON: {error}") from None
    except RecursionError:
        raise FileFormatError("not a bond graph: the JSON is nested too deeply") from None


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    result: dict[str, Any] = {}
    for key, value in pairs:
        if key in result:
            raise FileFormatError(f"the key {key[:60]!r} is there twice in one object; keep one")
        result[key] = value
    return result


def _number(digits: str, kind: type[int] | type[float]) -> float:
    if len(digits) > 2 * MAX_DIGITS:
        raise FileFormatError(f"a number of {len(digits)} digits; at most {MAX_DIGITS} are allowed")
    value = kind(digits)
    if isinstance(value, float) and not math.isfinite(value):
        raise FileFormatError(f"{digits} is not a finite number")
    return value


def _check_keys(data: dict[str, Any], needed: set[str], more: set[str], where: str) -> None:
    missing, unknown = sorted(needed - set(data)), sorted(set(data) - needed - more)
    if missing:
        raise FileFormatError(f"{where}: the key {missing[0]!r} is missing")
    if unknown:
        raise FileFormatError(f"{where}: the key {unknown[0][:60]!r} is unknown; remove it")

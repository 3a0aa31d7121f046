"""Files that nobody wrote in good faith end in an error, soon."""

import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from references.build import bond_graph

import bondgraph as bg

GRAPH = bond_graph([bg.Se("s", "u"), bg.R("r", "r", unit="N")], "s>r")
HEAD = '"format": "bondgraph", "version": 1'
XML = bg.to_graphml(GRAPH)


@pytest.fixture(autouse=True)
def _soon() -> Iterator[None]:
    start = time.process_time()
    yield
    assert time.process_time() - start < 2


def _data() -> dict[str, Any]:
    return json.loads(bg.to_json(GRAPH))


def test_the_graph_itself_is_accepted() -> None:
    assert list(bg.from_json(json.dumps(_data()))) == list(bg.from_graphml(XML)) == ["s", "r"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not JSON"), ("hello", "not JSON"), ("[1]", "must be of type dict"),
        ("1", "must be of type dict"),
        ("{}", 'must be "bondgraph"'), ("[" * 10**5, "nested too deeply"),
        ("[" + "[]," * 3_300_000 + "[]]", "more than 500000 lists and objects"),
        ('{"format": "other", "version": 1}', 'must be "bondgraph"'),
        ('{"format": "bondgraph"}', 'with a "version"'), ("[" * 10**6, "nested too deeply"),
        ('{"a":' * 10**5, "nested too deeply"), ('{"format": NaN}', "NaN is not a finite number"),
        ('{"format": -Infinity}', "-Infinity is not"), ('{"format": 1e999}', "1e999 is not a finite"),
        ('{"format": ' + "9" * 10**6 + "}", "a number of 1000000 digits"),
        ('{"format": 0.' + "9" * 10**6 + "}", "a number of 1000002 digits"),
        ('{"format": 1, "format": 2}', "the key 'format' is there twice"),
        ("{" + HEAD + "}", "the key 'edges' is missing"),
        ("{" + HEAD + ', "edges": [], "nodes": []}', "no nodes"),
        ("{" + HEAD + ', "edges": [], "nodes": {}}', "nodes: a dict must be of type list"),
        ("{" + HEAD + ', "edges": [], "nodes": [1]}', r"nodes\[0\]: 1 must be of type dict"),
        ("{" + HEAD + ', "edges": [], "nodes": [{}]}', r"nodes\[0\]: the key 'id' is missing"),
    ],
)  # fmt: skip
def test_what_is_no_graph_is_refused(text: str, message: str) -> None:
    with pytest.raises(bg.BondGraphError, match=message):
        bg.from_json(text)


@pytest.mark.parametrize("version", [0, 2, 1.0, True, "1", None, [1]])
def test_other_versions_are_refused(version: object) -> None:
    with pytest.raises(bg.FileFormatError, match="is unknown; this toolkit reads version 1"):
        bg.from_json(json.dumps({**_data(), "version": version}))


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"author": "me"}, "the key 'author' is unknown"), ({"directed": False}, "directed must be true"),
        ({"directed": 1}, "directed must be true"), ({"multigraph": True}, "multigraph must be false"),
        ({"graph": []}, "graph: a list must"), ({"graph": {"x": 1}}, "graph: the key 'x' is unknown"),
        ({"graph": {"name": 1}}, "the graph's name: 1 must"),
        ({"edges": [{"source": "s"}]}, "the key 'target' is missing"),
        ({"edges": [{"source": "s", "target": "r", "weight": "1"}]}, "unknown attribute 'weight'"),
        ({"edges": [{"source": "s", "target": "r", "port": 1}]}, "bond 's' -> 'r', port: 1 must be"),
        ({"edges": [{"source": "s", "target": "q"}]}, "bond 's' -> 'q': there is no node 'q'"),
        ({"edges": [{"source": "s", "target": ["r"]}]}, "the end of a bond: a list must be"),
        ({"edges": [{"source": "s", "target": "r"}] * 2}, "bond 's' -> 'r' is there twice"),
        ({"edges": []}, "Se 's' has 0 bonds"),
    ],
)  # fmt: skip
def test_other_graphs_are_refused(more: dict[str, Any], message: str) -> None:
    with pytest.raises(bg.BondGraphError, match=message):
        bg.from_json(json.dumps({**_data(), **more}))


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"id": "s"}, "node 's' is there twice"), ({"id": True}, "the id of a node: True must"),
        ({"id": 1.5}, "the id of a node: 1.5 must"), ({"id": None}, "the id of a node: a NoneType must"),
        ({"id": "\ud800"}, "half a character"), ({"kind": "X"}, "node 'r': unknown kind 'X'"),
        ({"kind": ["R"]}, "node 'r', kind: a list must be"), ({"value": None}, "value: a NoneType must"),
        ({"value": True}, "value: True must"), ({"value": 0}, "its value is zero"),
        ({"value": {"a": 1}}, "value: a dict must"), ({"value": [["a"]]}, "node 'r'"),
        ({"value": [[["a"]]]}, "value: a list must"), ({"value": "__import__('os')"}, "node 'r'"),
        ({"value": "9" * 10**6}, "node 'r': text of 1000000 characters"), ({"value": "9**9**9"}, "node 'r'"),
        ({"value": "(" * 3000}, "node 'r': parentheses nested"), ({"value": "1e999"}, "not a finite"),
        ({"color": "red"}, "node 'r': unknown attribute 'color'"), ({"element": "x"}, "unknown attribute"),
        ({"unit": 1}, "node 'r', unit: 1 must"), ({"effort": "a.b"}, "cannot be a symbol"),
        ({"effort": {"a": 1}}, "node 'r', effort: 1 must"), ({"ports": [1]}, "node 'r', ports: 1 must"),
        ({"priority": 1}, "unknown attribute 'priority'"), ({"law": "x"}, "both a value and a law"),
        ({"law": {}}, "node 'r', law: a law of parts has"), ({"law": {"level": []}}, "law, level: a list"),
        ({"law": {"level": "open('f')"}}, "node 'r', law: .*'open' is not a function"),
        ({"law": {"level": 1, "breakaway": 0.5}}, "node 'r', law: dry friction: breakaway"),
        ({"law": {"level": 1, "self": 1}}, "a law of parts has level"),
        ({"law": {"expression": "x", "state": "1"}}, "node 'r', law: '1' cannot be a symbol"),
    ],
)  # fmt: skip
def test_other_nodes_are_refused(more: dict[str, Any], message: str) -> None:
    data = _data()
    data["nodes"][1].update(more)
    with pytest.raises(bg.BondGraphError, match=message):
        bg.from_json(json.dumps(data))


LAUGHS = (
    '<?xml version="1.0"?><!DOCTYPE lolz [<!ENTITY a "' + "lol" * 100 + '">'
    + "".join(f'<!ENTITY {b} "{f"&{a};" * 50}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True))
    + "]><graphml><graph edgedefault='directed'><node id='&i;'/></graph></graphml>"
)  # fmt: skip
NODE = '<node id="r">'
LAW = XML.replace('attr.name="unit"', 'attr.name="law"')


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (LAUGHS, "a document type or entity is not allowed"),
        ('<!DOCTYPE x SYSTEM "file:///etc/passwd"><graphml/>', "a document type"),
        ("<a>" * 10**6, "XML element 'a' in None has no place"), ("", "not XML"), ("hello", "not XML"),
        ("<graphml/>", "there is no graph"), ("<graphml>" * 10**5, "has no place"),
        (XML.replace(">bondgraph<", ">other<"), "needs format 'bondgraph'"),
        (XML.replace('"d1">1<', '"d1">2<'), "version '1'"), (XML[:-30], "not XML"),
        (XML.replace('"directed"', '"undirected"'), "must be directed"),
        (XML.replace('"string"', '"int"'), "attributes are of type string"),
        (XML.replace(NODE, '<node id="s">'), "'node s' is there twice"),
        (XML.replace('target="r"', 'target="q"'), "a bond ends at 'q', but there is no such node"),
        (XML.replace("</graph>", '</graph><graph edgedefault="directed"/>'), "'graph' is there twice"),
        (XML.replace("<edge", '<edge source="s" target="r"/><edge'), "'edge s' is there twice"),
        (XML.replace(NODE, NODE + '<data key="zz">1</data>'), "not GraphML of a bond graph"),
        (XML.replace(NODE, NODE + '<data key="d2">R</data>'), "'data d2' is there twice"),
        (XML.replace(NODE, NODE + "<port/>"), "XML element 'port' in 'node' has no place"),
        (XML.replace(NODE, '<node id="r" color="red">'), "it must have exactly id"),
        (XML.replace(NODE, "<node>"), "it must have exactly id"),
        (XML.replace('attr.name="unit"', 'attr.name="integer"'), "'N' is not an integer"),
        (XML.replace('attr.name="unit"', 'attr.name="priority"'), "priority 'N' is not a number"),
        (XML.replace('attr.name="unit"', 'attr.name="color"'), "unknown attribute 'color'"),
        (LAW.replace(">N<", ">{<"), "not JSON"),
        (LAW.replace(">N<", ">" + "[" * 10**6 + "<"), "nested"),
        (XML.replace(">r<", ">__import__('os')<"), "node 'r': '__import__' is not a function"),
        (XML.replace(">r<", ">" + "9" * 10**6 + "<"), "node 'r': text of 1000000 characters"),
    ],
)  # fmt: skip
def test_other_xml_is_refused(text: str, message: str) -> None:
    with pytest.raises(bg.BondGraphError, match=message):
        bg.from_graphml(text)


@pytest.mark.parametrize("read", [bg.read_json, bg.read_graphml])
def test_files_are_bounded_and_utf_8_and_named(tmp_path: Path, read: Any) -> None:
    path = tmp_path / "graph"
    path.write_bytes(b" " * 10_000_001)
    with pytest.raises(bg.FileFormatError, match=r"graph: more than 10000000 bytes"):
        read(path)
    with pytest.raises(bg.FileFormatError, match=r"/dev/zero: more than"):
        read("/dev/zero")
    for encoding in ("utf-16", "latin-1"):
        path.write_text("<!DOCTYPE ü>", encoding=encoding)
        with pytest.raises(bg.FileFormatError, match=r"graph: not UTF-8"):
            read(path)
    with pytest.raises(FileNotFoundError):
        read(tmp_path / "none")


def test_a_byte_order_mark_is_no_harm_and_refusals_keep_their_kind(tmp_path: Path) -> None:
    path = tmp_path / "graph"
    path.write_text(bg.to_json(GRAPH), encoding="utf-8-sig")
    assert list(bg.read_json(path)) == ["s", "r"]
    path.write_text(bg.to_json(GRAPH).replace('"value": "r"', '"value": "f(x)"'), encoding="utf-8")
    with pytest.raises(bg.ExpressionError, match="graph: node 'r': 'f' is not a function"):
        bg.read_json(path)

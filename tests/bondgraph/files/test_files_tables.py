"""Files keep the tables of a graph, those of expressions too, and read what they are given beside them."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import networkx as nx
import pytest
from references.build import bond_graph

import bondgraph as bg

drag = bg.LookupTable("drag", [0, 0.1, 3], [0, 1 / 3, 3], method="pchip", outside="refuse")
torque = bg.LookupTable("torque", [0, 1, 2], [0, 1], [[0, 3], [0, 2], [0, 0]])

BOTH = [(bg.to_json, bg.from_json), (bg.to_graphml, bg.from_graphml)]
Write, Read = Callable[[Any], str], Callable[..., nx.DiGraph]


def _graph(law: object = "drag(v)") -> nx.DiGraph:
    friction = bg.DryFriction(torque("v", 1), "1")
    nodes = [bg.Se("push", "2*torque(v, u)"), bg.One("n"), bg.I("m", "m", flow="v"), bg.R("b", law=law),
             bg.R("f", law=friction)]  # fmt: skip
    graph = bond_graph(nodes, "push>n>m n>b n>f")
    graph.graph.update(name="engine", tables=[drag, torque])
    return graph


@pytest.mark.parametrize(("write", "read"), BOTH)
def test_tables_are_read_as_they_were_written(write: Write, read: Read) -> None:
    text = write(_graph())
    back = read(text)
    assert back.graph["tables"] == [drag, torque]
    assert write(back) == text
    assert bg.derive(back).laws == bg.derive(_graph()).laws


@pytest.mark.parametrize(("write", "read"), BOTH)
def test_tables_of_expressions_are_written_too(write: Write, read: Read) -> None:
    graph = _graph(drag("v"))
    graph.graph["tables"] = [torque]
    back = read(write(graph))
    assert {table.name for table in back.graph["tables"]} == {"drag", "torque"}
    assert bg.derive(back).laws == bg.derive(graph).laws


@pytest.mark.parametrize(("write", "read"), BOTH)
def test_a_file_may_call_tables_that_it_is_given(write: Write, read: Read) -> None:
    graph = _graph()
    graph.nodes["f"]["law"] = "0"
    text = write(graph)
    without = {
        bg.to_json: lambda: json.dumps({**json.loads(text), "graph": {}}),
        bg.to_graphml: lambda: _without_tables(text),
    }[write]()
    with pytest.raises(bg.ExpressionError, match=r"'(drag|torque)' is not a function"):
        read(without)
    assert bg.derive(read(without, [drag, torque])).laws == bg.derive(graph).laws
    with pytest.raises(bg.TableError, match="two tables 'drag'"):
        read(text, [bg.LookupTable("drag", [0, 1], [0, 1])])


def _without_tables(text: str) -> str:
    lines = [
        line for line in text.splitlines() if '"method"' not in line and "&quot;method" not in line
    ]
    assert len(lines) < len(text.splitlines())
    return "\n".join(lines)


def test_files_on_disk_take_tables(tmp_path: Path) -> None:
    graph = _graph()
    bg.write_json(graph, tmp_path / "g.json")
    bg.write_graphml(graph, tmp_path / "g.graphml")
    for found in (
        bg.read_json(tmp_path / "g.json", [drag]),
        bg.read_graphml(tmp_path / "g.graphml"),
    ):
        assert found.graph["tables"] == [drag, torque]


def test_two_tables_of_one_name_are_not_written() -> None:
    graph = _graph(bg.LookupTable("drag", [0, 1], [0, 1])("v"))
    with pytest.raises(bg.TableError, match="two tables 'drag'"):
        bg.to_json(graph)


def test_a_slope_of_a_table_has_no_text() -> None:
    graph = _graph(drag("v").diff("v"))
    with pytest.raises(
        bg.FileFormatError, match=r"(cannot be written as text|is not an expression)"
    ):
        bg.to_json(graph)


GOOD = {"name": "drag", "x": [0, 1], "z": [0, 1], "method": "linear", "outside": "hold"}


@pytest.mark.parametrize(
    ("table", "says"),
    [
        (3, r"tables\[0\]: a table must be an object"),
        ({"name": "drag"}, r"tables\[0\]: 'x' is missing"),
        (GOOD | {"w": 1}, "'w' is unknown"),
        (GOOD | {"method": 1}, "method: '1' must be a text"),
        (GOOD | {"x": "01"}, "x: '01' must be a list"),
        (GOOD | {"x": [0, "1"]}, "x, row 2: '1' is not a number"),
        (GOOD | {"x": [1, 0]}, "x must increase, but row 2"),
        (GOOD | {"z": [0]}, r"z has 1 row\(s\)"),
        (GOOD | {"y": [0, 1]}, "row 1 of z must be a list"),
        (GOOD | {"method": "cubic"}, "method='cubic'"),
        (GOOD | {"name": "sin"}, "expressions' own"),
    ],
)
def test_malformed_tables_are_refused(table: Any, says: str) -> None:
    data = {**json.loads(bg.to_json(_graph())), "graph": {"tables": [table]}}
    with pytest.raises((bg.FileFormatError, bg.TableError), match=says):
        bg.from_json(json.dumps(data))


def test_no_number_is_refused_as_json() -> None:
    text = bg.to_json(_graph()).replace("3.0]", "NaN]", 1)
    with pytest.raises(bg.FileFormatError, match="NaN is not a finite number"):
        bg.from_json(text)

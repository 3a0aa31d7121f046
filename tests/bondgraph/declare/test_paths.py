"""A graph from paths is the graph that networkx makes; what is no path is refused by name."""

import networkx as nx
import pytest
from references.random_graphs import chain

import bondgraph as bg

NODES = [bg.Se("push", "F"), bg.One("j"), bg.I("m", "m"), bg.R("drag", "b")]


def _by_hand() -> "nx.DiGraph[str]":
    made: nx.DiGraph[str] = nx.DiGraph()
    made.add_nodes_from(NODES)
    made.add_edges_from([("push", "j"), ("j", "m"), ("j", "drag")])
    return made


@pytest.mark.parametrize(
    "paths",
    [
        ("push > j > m", "j > drag"),
        ("push>j>m,j>drag",),
        (["push", "j", "m"], ("j", "drag")),
        (" push >\n j > m ,\n j > drag ",),
    ],
)
def test_paths_in_any_form_are_the_edges_of_networkx(paths: tuple[object, ...]) -> None:
    made, want = bg.graph(NODES, *paths), _by_hand()
    assert list(made.nodes(data=True)) == list(want.nodes(data=True))
    assert list(made.edges(data=True)) == list(want.edges(data=True))
    assert bg.to_json(made) == bg.to_json(want)


def test_no_module_has_the_name() -> None:
    assert callable(bg.graph)
    with pytest.raises(ImportError, match=r"bondgraph\.graph"):
        __import__("bondgraph.graph")


def test_names_with_spaces_numbers_and_signs() -> None:
    nodes = [bg.One("left wheel"), bg.One(3), bg.One("a-b"), bg.One("c, > d")]
    made = bg.graph(nodes, "left wheel > 3 > a-b", ["a-b", "c, > d"], (3, "c, > d"))
    assert list(made.edges) == [
        ("left wheel", 3), (3, "a-b"), (3, "c, > d"), ("a-b", "c, > d"),
    ]  # fmt: skip


def test_a_text_is_the_node_of_that_text_before_a_number() -> None:
    assert list(bg.graph([bg.One("3"), bg.One(3), bg.One("a")], "3 > a").edges) == [("3", "a")]


def test_the_nodes_may_be_a_mapping_and_terminals_bare_names() -> None:
    part = bg.graph({"rail": {}, "j": {"kind": "1"}}, "rail > j")
    assert dict(part.nodes["rail"]) == {}
    same = bg.graph(["rail", bg.One("j")], "rail > j")
    assert list(same.edges) == list(part.edges)


def test_ports_of_fields_are_named_behind_a_dot() -> None:
    field = bg.I("M", [["a", "c"], ["c", "b"]], ports=["x", "y"])
    made = bg.graph([bg.Se("F", "F"), bg.Se("G", "G"), field], "F > M.x", "G > M.y")
    assert dict(made.edges) == {("F", "M"): {"port": "x"}, ("G", "M"): {"port": "y"}}
    assert bg.derive(made).A.shape == (2, 2)
    two = bg.graph([field, bg.C("K", [["a", "c"], ["c", "b"]], ports=["u", "v"])], "M.x > K.u")
    assert dict(two.edges["M", "K"]) == {"tail_port": "x", "head_port": "u"}


def test_tables_are_those_of_the_graph() -> None:
    table = bg.LookupTable("drag", [0, 1], [0, 2])
    made = bg.graph(
        [bg.One("j"), bg.I("m", 1), bg.R("r", law="drag(f_r)")], "j > m, j > r", tables=[table]
    )
    assert made.graph == {"tables": [table]}
    with pytest.raises(bg.TableError, match="LookupTable"):
        bg.graph([], tables=["drag"])


WRONG: dict[str, tuple[tuple[object, ...], str]] = {
    "an unknown name": (("push > jj > m",), r"path 'push > jj > m'.*no node 'jj'.*there are push, j"),
    "a near name": (("puhs > j",), r"path 'puhs > j'.*no node 'puhs' \(did you mean 'push'\?\)"),
    "an unknown node": ((["push", 7],), r"path \['push', 7\].*no node 7.*there are push, j, m, drag"),
    "no hashable": ((["push", []],), r"no node \[\]"),
    "a truth": ((["push", True],), "no node True"),
    "nothing": (("",), "path '' has no bond; write at least two nodes"),
    "one node": (("push",), "path 'push' has no bond"),
    "an empty list": (([],), r"path \[\] has no bond"),
    "a comma at the end": (("push > j,",), "path '' has no bond"),
    "two signs": (("push > > j",), "path 'push > > j'.*without a node before or behind"),
    "a sign at the end": (("push > j >",), "without a node before or behind"),
    "an arrow": (("push -> j",), "path 'push -> j': '->' is no arrow here.*'a > b'"),
    "a double arrow": (("push => j",), "'=>' is no arrow"),
    "the other way": (("j < push",), "'<' is no arrow here"),
    "a half arrow": (("push ⇀ j",), "'⇀' is no arrow"),
    "dashes": (("push -- j > m",), "'--' is no arrow"),
    "twice": (("push > j", "push > j"), "path 'push > j': the bond 'push' > 'j' is there already"),
    "both ways": (("push > j", "j > push"), "path 'j > push': the bond 'push' > 'j' is there already"),
    "to itself": (("j > j",), "path 'j > j': node 'j' is bonded to itself"),
    "no path": ((5,), "5 is no path; write 'a > b > c'"),
    "no port": (("push > m.x",), r"no node 'm\.x'"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_what_is_no_path_is_refused(case: str) -> None:
    paths, message = WRONG[case]
    with pytest.raises(bg.StructureError, match=message):
        bg.graph(NODES, *paths)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("nodes", "message"),
    [
        ("push", "the nodes are a list"), (5, "the nodes are a list"), ([bg.Se], "is no node"),
        ([("j", "One")], "is no node"), ([bg.One("j"), bg.I("j", 1)], "two nodes are called 'j'"),
        ([True], "a node's name must be a text"),
        ([(("a",), {"kind": "One"})], "a node's name must be a text"),
    ],
)  # fmt: skip
def test_what_are_no_nodes_is_refused(nodes: object, message: str) -> None:
    with pytest.raises(bg.StructureError, match=message):
        bg.graph(nodes)  # type: ignore[arg-type]


def test_digits_are_junctions_on_every_way_in() -> None:
    """In attributes, parts, JSON and GraphML; files have the names they had."""
    digits = bg.graph(
        [bg.Sf("s", "v"), ("z", {"kind": "0"}), ("j", {"kind": "1"}), bg.I("m", "m"), bg.C("c", "c")],
        "s > z > c, z > j > m",
    )  # fmt: skip
    names = bg.graph(
        [bg.Sf("s", "v"), bg.Zero("z"), bg.One("j"), bg.I("m", "m"), bg.C("c", "c")],
        "s > z > c, z > j > m",
    )
    assert bg.derive(digits) == bg.derive(names)
    assert bg.to_json(digits) == bg.to_json(names)
    assert bg.to_graphml(digits) == bg.to_graphml(names)
    for text, read in ((bg.to_json(names), bg.from_json), (bg.to_graphml(names), bg.from_graphml)):
        told = text.replace("Zero", "0").replace("One", "1")
        assert told != text
        assert bg.derive(read(told)) == bg.derive(names)
    assert bg.to_json(bg.prefixed(digits, "a_")) == bg.to_json(bg.prefixed(names, "a_"))
    pair = [bg.graph([bg.One("hub")]), bg.graph([("hub", {"kind": "1"})])]
    assert list(bg.assemble(*pair)) == ["hub"]


@pytest.mark.parametrize("kind", [0, 1, "2", "01", ""])
def test_nothing_else_is_a_junction(kind: object) -> None:
    with pytest.raises(bg.StructureError, match=r"unknown kind.*0 and 1 for Zero and One"):
        bg.validate(bg.graph([("j", {"kind": kind})]))


def test_a_graph_is_drawn_or_says_why_not() -> None:
    made = bg.graph(NODES, "push > j > m, j > drag")
    assert made._repr_svg_() == bg.drawing(made).svg()
    assert str(made) == bg.drawing(made).text()
    assert repr(made) == "<BondGraph: 4 nodes, 3 bonds>"
    made.add_node("x", kind="Inertia")
    assert made._repr_svg_() is None
    text = str(made)
    assert text.startswith("Se push\nOne j\n")
    assert "j > drag\nNot drawn: node 'x': unknown kind 'Inertia'" in text


def test_of_a_large_graph_the_sizes_are_told() -> None:
    large = bg.assemble(chain(200))
    assert large._repr_svg_() is None  # type: ignore[attr-defined]
    assert str(large) == repr(large)


def test_what_makes_graphs_makes_those_that_are_drawn() -> None:
    made = bg.graph(NODES, "push > j > m, j > drag")
    for one in (
        made.copy(),
        bg.assemble(made),
        bg.prefixed(made, "a_"),
        bg.from_json(bg.to_json(made)),
    ):
        assert isinstance(one, bg.BondGraph)


def test_a_list_of_bonds_in_one_path_is_refused() -> None:
    with pytest.raises(bg.StructureError, match=r"list of paths; give them one by one"):
        bg.graph([bg.Se("F", "F"), bg.One("o"), bg.I("m", "m")], [("F", "o"), ("o", "m")])

"""What is written reads back as a graph of the same equations, or is refused by name."""

import itertools
import json
import os
import random
import stat
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from pathlib import Path

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from references.cases import CASES
from references.random_graphs import random_graph
from soak.families import seeds

import bondgraph as bg
import differentials

ROOT = Path(bg.__file__).parents[1]
FORMS = {
    "json": (bg.to_json, bg.from_json, bg.write_json, bg.read_json),
    "graphml": (bg.to_graphml, bg.from_graphml, bg.write_graphml, bg.read_graphml),
}
x, y, a = sp.symbols("x y a")


@pytest.fixture(params=FORMS)
def form(request: pytest.FixtureRequest) -> tuple[Callable, ...]:
    return FORMS[request.param]


def _told(graph: nx.DiGraph) -> list:
    """All that later stages see of a graph, in the order in which they see it."""
    checked = bg.validate(graph)
    nodes = [(type(name), name, checked.nodes[name]["element"]) for name in checked]
    return [nodes, list(checked.edges(data=True)), [list(checked.pred[name]) for name in checked]]


@cache
def _differential(name: str, halfshafts: bool, lumped: bool) -> tuple[nx.DiGraph, list | None]:
    """A graph and its equations, for both forms."""
    graph = differentials.graph(name, halfshafts, lumped)
    return graph, _equations(graph) if lumped else None


@cache
def _textbook(name: str) -> tuple[nx.DiGraph, list]:
    graph = bond_graph(CASES[name].nodes, CASES[name].bonds)
    return graph, _equations(graph)


def _equations(graph: nx.DiGraph) -> list:
    try:
        found = bg.derive(graph)
    except bg.BondGraphError as error:
        return [type(error), str(error)]
    vectors = [found.states, found.inputs, found.outputs, dict(found.laws), dict(found.integrals)]
    return vectors + [found.A, found.J, found.B, found.E, found.F, found.D, found.G]


def _round(
    graph: nx.DiGraph,
    form: tuple[Callable, ...],
    derive: bool = True,
    known: list | None = None,
) -> nx.DiGraph:
    """``known``: the graph's equations."""
    to_text, from_text, *_ = form
    text = to_text(graph)
    back = from_text(text)
    assert _told(back) == _told(graph)
    assert list(back.edges(data=True)) == list(graph.edges(data=True))
    assert to_text(back) == text
    assert text.endswith("\n")
    assert not text.endswith("\n\n")
    if derive:
        assert _equations(back) == (known or _equations(graph))
    return back


def _resisted(value: object, **more: object) -> nx.DiGraph:
    return bond_graph([bg.Se("s", "u"), bg.R("r", value, **more)], "s>r")


VARIANTS = [
    (name, bool(halfshafts), bool(lumped))
    for name, halfshafts, lumped in itertools.product(differentials.catalog, (0, 1), (0, 1))
    if differentials.catalog[name].full or not halfshafts
]


@pytest.mark.parametrize(("name", "halfshafts", "lumped"), VARIANTS)
def test_differentials_come_back(name: str, halfshafts: bool, lumped: bool, form: tuple) -> None:
    graph, known = _differential(name, halfshafts, lumped)
    _round(graph, form, derive=lumped, known=known)


PLAY = [name for name, row in differentials.catalog.items() if row.play]


@pytest.mark.parametrize("name", PLAY)
def test_backlash_comes_back(name: str, form: tuple) -> None:
    full = differentials.catalog[name].play == "full"
    _round(differentials.graph(name, halfshafts=full, backlash=True), form)


@pytest.mark.parametrize(
    "value",
    [
        sp.Piecewise((x, y > 0), (0, True)),
        sp.Piecewise(
            (x, (y > 0) & (y <= x)), (sp.pi * y, ~sp.Eq(x, 2) | (x > 3 * y)), (sp.E, True)
        ),
        sp.Piecewise((x, (y > 0) & ((x < 1) | (x > 2) & (y < 5))), (-1, True)) ** 2,
    ],
)
def test_what_piecewise_resistances_say_comes_back(value: object, form: tuple) -> None:
    _round(_resisted(value), form)


@pytest.mark.parametrize("name", CASES)
def test_textbook_graphs_come_back(name: str, form: tuple) -> None:
    graph, known = _textbook(name)
    _round(graph, form, known=known)


@pytest.mark.parametrize("seed", seeds("files"))
def test_random_graphs_come_back(seed: int, form: tuple) -> None:
    graph = random_graph(random.Random(seed), 3 + seed, mesh=0.4, symbols=seed % 2 == 0)
    _round(graph, form, derive=seed < 12)


def test_numbered_nodes_differ_from_texts(form: tuple) -> None:
    graph: nx.DiGraph = nx.DiGraph(name="both")
    graph.add_nodes_from(
        [(1, {"kind": "One"}), bg.Se("1", "u"), bg.Zero(""), bg.One("1#"), bg.TF(-7, 2)]
    )
    graph.add_nodes_from(
        [bg.I(10**30, 3), bg.R("ä b&<>\"'\t\n ", 4, effort="τ", flow="ω_1", unit="N·m/°")]
    )
    graph.add_edges_from(
        [("1", 1), (1, ""), ("", "1#"), ("1#", 10**30), ("", -7), (-7, "ä b&<>\"'\t\n ")]
    )
    assert _round(graph, form).graph["name"] == "both"


def test_detectors_modulation_and_priorities_come_back(form: tuple) -> None:
    nodes = [bg.Se("drive", "tau"), bg.One("rot"), bg.I("J", "J", flow="omega", priority=Fraction(1, 3)),
             bg.Df("angle", integrate="theta", flow=sp.Symbol("w"), unit="rad"),
             bg.TF("crank", "r*cos(theta)"),
             bg.Zero("z", effort="p"), bg.De("gauge", effort="p"), bg.One("slider"),
             bg.I("m", "m", priority=-1.5), bg.Se("wind", "a*sin(2*t)"), bg.Sf("belt", 2.5)]  # fmt: skip
    bonds = "drive>rot>J rot>angle rot>crank>z>slider>m z>gauge wind>slider belt>z"
    _round(bond_graph(nodes, bonds), form)


@pytest.mark.parametrize(
    "value",
    [
        2, 2.5, 0.1, 1e-7, 1e22, 0.1604, Fraction(-3, 7), np.float32(0.1), np.int64(3), np.float64(0.3),
        sp.Rational(22, 7), sp.Float(0.1), sp.sqrt(2), sp.pi, 2 * sp.pi * x, sp.E * x, sp.exp(x / y),
        x ** sp.Rational(-2, 3), -x / (y - 1), (x + y) ** 2 / 3, sp.Max(x, 0) + sp.Min(y, -x, a),
        sp.atan2(x, y), abs(x) * sp.sign(y), 1 / sp.sqrt(x**2 + 1), 2 ** x, -(x**-y), sp.log(x) * sp.tanh(y),
        "h1/(h1 - 1)", " 1/( i )", "ℏ + ﬁ",
    ],
)  # fmt: skip
def test_values_are_the_same_expressions(value: object, form: tuple) -> None:
    back = _round(_resisted(value), form, derive=False)
    if isinstance(value, str):
        assert back.nodes["r"]["value"] == value


@pytest.mark.parametrize(
    "law",
    [
        "c*f_r*abs(f_r)", 3, sp.tanh(sp.Symbol("f_r") / 2) + sp.pi, bg.DryFriction("tau_h"),
        bg.DryFriction("a*tau_h", "1 + 0.2*exp(-slip/0.1)"), bg.DryFriction(10, "1 + slip/9", "k + 1"),
        bg.ExpressionLaw(x**2), bg.ExpressionLaw(x**2 + sp.Symbol("z"), sp.Symbol("z")),
    ],
)  # fmt: skip
def test_laws_come_back(law: object, form: tuple) -> None:
    _round(_resisted(None, law=law), form)
    stored = bond_graph([bg.Se("s", "u"), bg.C("c", law="k*q_c**3")], "s>c")
    stored.nodes["c"]["law"] = bg.validate(stored).nodes["c"]["element"].law
    assert _round(stored, form, derive=False).nodes["c"]["law"] == "k*q_c**3"


def test_fields_come_back(form: tuple) -> None:
    nodes = [bg.Se("u", "u"), bg.One("a"), bg.One("b"), bg.R("r", "r"),
             bg.I("coils", sp.Matrix([["L1", "M"], ["M", 2]]), ports=("one", "two"),
                  flow={"two": "i_2", "one": "i_1"})]  # fmt: skip
    graph = bond_graph(nodes, "u>a>coils b>r b>coils")
    graph.edges["a", "coils"]["port"] = "one"
    graph.edges["b", "coils"]["head_port"] = "two"
    _round(graph, form)
    del graph.nodes["coils"]["value"]
    graph.nodes["coils"]["energy"] = "p_coils_one**2/L1 + p_coils_one*p_coils_two/M"
    _round(graph, form)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (sp.Symbol("k", positive=True), "node 'r', value: the symbol k has assumptions"),
        (sp.Dummy("d") + 1, "node 'r', value: the symbol d has assumptions"),
        (sp.EulerGamma, "node 'r', value: 'EulerGamma' would be read as EulerGamma, which is not"),
        (sp.Mul(2, sp.Add(x, y, evaluate=False), evaluate=False), "node 'r', value: .* would be read as"),
        (sp.Add(*sp.symbols("long_name_:500")), "node 'r', value: text of 7887 characters"),
    ],
)  # fmt: skip
def test_what_text_cannot_say_is_refused(value: object, message: str, form: tuple) -> None:
    with pytest.raises(bg.FileFormatError, match=message):
        form[0](_resisted(value))


def test_graph_attributes_and_checked_copies_are_refused(form: tuple) -> None:
    graph = _resisted("r")
    with pytest.raises(bg.FileFormatError, match="the checked copy"):
        form[0](bg.validate(graph))
    graph.graph["author"] = "me"
    with pytest.raises(bg.FileFormatError, match="graph attribute 'author'"):
        form[0](graph)


@pytest.mark.parametrize("text", ["\x00", "\r", "\x1b", "\ufffe"])
def test_characters_that_xml_cannot_hold_are_refused(text: str) -> None:
    graph = _resisted("r", unit=text)
    assert _round(graph, FORMS["json"]).nodes["r"]["unit"] == text
    with pytest.raises(
        bg.FileFormatError, match="node 'r', unit: GraphML cannot hold the character"
    ):
        bg.to_graphml(graph)


def test_names_that_xml_cannot_hold_are_refused() -> None:
    graph = nx.relabel_nodes(_resisted("r", effort="e", flow="f"), {"r": "r\x00"})
    assert list(_round(graph, FORMS["json"])) == ["s", "r\x00"]
    with pytest.raises(
        bg.FileFormatError, match=r"node 'r.x00': GraphML cannot hold the character"
    ):
        bg.to_graphml(graph)


def test_half_characters_and_empty_texts_are_refused(form: tuple) -> None:
    with pytest.raises(bg.FileFormatError, match="node 'r', unit: half a character"):
        form[0](_resisted("r", unit="\ud800"))
    with pytest.raises(
        bg.FileFormatError, match="node 'r', unit: GraphML cannot hold an empty text"
    ):
        bg.to_graphml(_resisted("r", unit=""))


def test_networkx_reads_the_layout() -> None:
    graph = differentials.graph("alsd")
    data = json.loads(bg.to_json(graph))
    other = nx.node_link_graph(data, edges="edges")
    assert list(other.nodes(data=True)) == list(graph.nodes(data=True))
    assert list(other.edges) == list(graph.edges)


def test_the_order_in_which_attributes_were_given_means_nothing(form: tuple) -> None:
    graph = differentials.graph("stationary_tvd", halfshafts=True)
    other = nx.DiGraph()
    for name, attributes in graph.nodes(data=True):
        other.add_node(name, unit=None, **dict(reversed(attributes.items())))
        if attributes["kind"] in ("Zero", "One"):
            del other.nodes[name]["unit"]
    other.add_edges_from(graph.edges)
    assert form[0](other) == form[0](graph)


def test_files_hold_the_text(tmp_path: Path, form: tuple) -> None:
    to_text, _, write, read = form
    graph = _resisted("r", effort="τ")
    write(graph, tmp_path / "ü.file")
    assert (tmp_path / "ü.file").read_bytes().decode("utf-8") == to_text(graph)
    assert _told(read(str(tmp_path / "ü.file"))) == _told(graph)
    assert [path.name for path in tmp_path.iterdir()] == ["ü.file"]


@pytest.mark.parametrize("failing", ["replace", "fsync"])
def test_a_failing_write_leaves_what_was_there(
    tmp_path: Path, form: tuple, failing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A full disk shows when the file is flushed; a lost right when it is moved."""
    write, path = form[2], tmp_path / "graph"
    path.write_text("old", encoding="utf-8")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, failing, fail)
        with pytest.raises(OSError, match="No space left"):
            write(_resisted("r"), path)
    with pytest.raises(bg.StructureError, match="no nodes"):
        write(nx.DiGraph(), path)
    with pytest.raises(bg.FileFormatError, match="assumptions"):
        write(_resisted(sp.Symbol("k", real=True)), path)
    assert path.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_rights_and_links_stay(tmp_path: Path, form: tuple) -> None:
    write, path, link = form[2], tmp_path / "graph", tmp_path / "link"
    path.touch(mode=0o640)
    path.chmod(0o640)
    link.symlink_to(path)
    write(_resisted("r"), link)
    assert link.is_symlink()
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    assert path.stat().st_size > 100

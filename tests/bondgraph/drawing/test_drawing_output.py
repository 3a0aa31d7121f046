"""What drawings are written as: SVG, PNG, PDF, text; what is drawn of graphs without a causality."""

import sys
from importlib import util
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import networkx as nx
import pytest

import bondgraph as bg
import differentials
from bondgraph.drawing.metrics import ADVANCES, FAMILY
from bondgraph.nodes.elements import Node

ROOT = Path(bg.__file__).parents[1]
SVG = "{http://www.w3.org/2000/svg}"


def graph(nodes: list[Any], bonds: list[Any]) -> Any:
    made: Any = nx.DiGraph()
    made.add_nodes_from(nodes)
    made.add_edges_from(bonds)
    return made


def oscillator(name: str = "loop") -> Any:
    """A force on a mass, a spring and a damper."""
    return graph(
        [bg.Se("force", "F"), bg.One(name), bg.I("mass", "m", flow="v"), bg.C("spring", "1/k"),
         bg.R("damper", "b")],
        [("force", name), (name, "mass"), (name, "spring"), (name, "damper")],
    )  # fmt: skip


def texts(drawing: bg.Drawing) -> list[str]:
    """The texts of an SVG as a reader sees them."""
    root = ElementTree.fromstring(drawing.svg())
    return ["".join(text.itertext()) for text in root.iter(f"{SVG}text")]


def test_svg_says_what_it_shows() -> None:
    drawing = bg.drawing(differentials.graph("alsd"), title="ALSD & more")
    root = ElementTree.fromstring(drawing.svg())
    assert root.findtext(f"{SVG}title") == "ALSD & more"
    assert "15 bonds" in str(root.findtext(f"{SVG}desc"))
    assert "derivative causality: I_i" in str(root.findtext(f"{SVG}desc"))
    assert {"Se: τe", "TF: 1/i", "R: clutch", "Iw1 :I", "I: Iw2"} <= set(texts(drawing))


def test_svg_needs_nothing_outside_itself() -> None:
    text = bg.drawing(differentials.graph("alsd")).svg()
    assert text.count("http") == 1  # the name space
    for word in ("href", "url(", "<script", "<style", "@import"):
        assert word not in text


def test_names_are_escaped() -> None:
    name = "<b>&\"'\n]]>"
    drawing = bg.drawing(oscillator(name))
    assert "<b>&\"'�]]>" in texts(drawing)
    assert "\n".join(drawing.text().splitlines()) == drawing.text()


def test_notebooks_show_causal_graphs() -> None:
    causal = bg.assign_causality(oscillator())
    drawing = bg.drawing(causal)
    assert causal._repr_svg_() == drawing._repr_svg_() == drawing.svg()
    assert drawing.svg() == bg.drawing(oscillator()).svg()


@pytest.mark.parametrize(("suffix", "start"), [(".png", b"\x89PNG"), (".pdf", b"%PDF-")])
def test_saved_pictures(tmp_path: Path, suffix: str, start: bytes) -> None:
    pytest.importorskip("matplotlib")
    drawing = bg.drawing(differentials.graph("passive"))
    for name in "ab":
        drawing.save(tmp_path / f"{name}{suffix}")
    first, second = ((tmp_path / f"{name}{suffix}").read_bytes() for name in "ab")
    assert first.startswith(start)
    assert first == second


def test_saved_svg_is_the_text(tmp_path: Path) -> None:
    drawing = bg.drawing(oscillator())
    drawing.save(tmp_path / "graph.svg")
    assert (tmp_path / "graph.svg").read_bytes() == drawing.svg().encode()


def test_other_suffixes_are_refused(tmp_path: Path) -> None:
    with pytest.raises(bg.StructureError, match=r"\.svg, \.png or \.pdf, not '\.gif'"):
        bg.drawing(oscillator()).save(tmp_path / "graph.gif")
    assert list(tmp_path.iterdir()) == []


def test_png_needs_the_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(bg.MissingExtraError, match=r"bondgraph-toolkit\[pictures\]"):
        bg.drawing(oscillator()).save(tmp_path / "graph.png")
    bg.drawing(oscillator()).save(tmp_path / "graph.svg")


def test_text_is_aligned_with_strokes_at_the_right_end() -> None:
    assert bg.drawing(oscillator(), powers=True).text().splitlines() == [
        "Se: F    ──⇀|  1 loop  F         f_force",
        "1 loop  |──⇀   C: 1/k  e_spring  f_spring",
        "1 loop   ──⇀|  I: m    e_mass    v",
        "1 loop  |──⇀   R: b    e_damper  f_damper",
    ]


def test_values_or_names() -> None:
    assert "I: m" in bg.drawing(oscillator()).text()
    assert "I: mass" in bg.drawing(oscillator(), values=False).text()


def test_switches_are_drawn_with_strokes_and_what_turns_them_on() -> None:
    made = graph(
        [bg.Se("battery", "E"), bg.One("wire"), bg.Sw("key", on="gate"), bg.C("cap", "C")],
        [("battery", "wire"), ("wire", "key"), ("wire", "cap")],
    )
    assert bg.drawing(made).text().splitlines() == [
        "Se: E    ──⇀|  1 wire",
        "1 wire  |──⇀   C: C",
        "1 wire   ──⇀|  Sw: gate > 0",
    ]
    assert "Sw: key" in texts(bg.drawing(made, values=False))
    on, off = (bg.drawing(bg.in_mode(made, on=mode)) for mode in (["key"], []))
    assert "Sw: key (on)" in texts(on)
    assert "Sw: key (off)" in texts(off)
    assert all(bond.stroke for drawing in (on, off) for bond in drawing.scene.bonds)
    assert [node.name for node in on.scene.nodes if node.frame] == ["cap"]
    assert [node.name for node in off.scene.nodes if node.frame] == []


@pytest.mark.parametrize(
    ("switch", "shown"),
    [
        (bg.Diode("d"), "f_d ≥ 0"),
        (bg.CheckValve("d", effort="dp", flow="Q"), "Q ≥ 0"),
        (bg.Freewheel("d"), "f_d ≤ 0"),
        (bg.Sw("d", on="-3*e_d", off="f_d/2"), "f_d ≤ 0"),
        (bg.Sw("d", on="e_d", off="f_d"), "e_d > 0, off f_d > 0"),
        (bg.Sw("d", on="e_d - 1", off="-f_d"), "e_d − 1 > 0, off −f_d > 0"),
        (bg.Sw("d", on="3*e_d - 100", off="7 - f_d"), "d"),
        (bg.Sw("d", on="u - 2", off="1 - u"), "u − 2 > 0, off 1 − u > 0"),
        (bg.Sw("d", on="t - 2"), "t − 2 > 0"),
    ],
)
def test_each_kind_of_switch_is_drawn_as_what_it_is(switch: Node, shown: str) -> None:
    made = graph(
        [bg.Se("battery", "u"), bg.One("wire"), switch, bg.R("load", "R")],
        [("battery", "wire"), ("wire", "d"), ("wire", "load")],
    )
    assert f"Sw: {shown}" in bg.drawing(made).text().splitlines()[1]


def test_long_conditions_are_left_to_the_name() -> None:
    made = graph(
        [bg.Se("s", "E"), bg.One("loop", on="i_measured - i_highest - sin(w*t)"), bg.R("r", "R"),
         bg.Sw("k", on="sin(100*pi*t) - depth*cos(carrier*t)")],
        [("s", "loop"), ("loop", "r"), ("loop", "k")],
    )  # fmt: skip
    listed = bg.drawing(made).text()
    assert "Sw: k\n" in listed
    assert "Sw: loop_switch\n" in listed


def test_refused_causality_is_told_under_the_picture() -> None:
    made = graph(
        [bg.Se("one", "u"), bg.Zero("node"), bg.Se("two", "w")], [("one", "node"), ("two", "node")]
    )
    with pytest.raises(bg.CausalityError) as refusal:
        bg.assign_causality(made)
    drawing = bg.drawing(made)
    assert all(bond.stroke is None for bond in drawing.scene.bonds)
    shown = " ".join(texts(drawing))
    assert shown.endswith(" ".join(f"No causal strokes: {refusal.value}".split()))


def test_what_is_no_bond_graph_is_refused() -> None:
    with pytest.raises(bg.StructureError, match="exactly one"):
        bg.drawing(graph([bg.I("alone", "m")], []))


def test_fields_are_one_node() -> None:
    made = graph(
        [bg.Se("force", "F"), bg.One("tip"), bg.One("middle"), bg.R("b", "b"),
         bg.C("beam", [["c11", "c12"], ["c12", "c22"]], ports=["tip", "middle"])],
        [("force", "tip"), ("tip", "beam", {"port": "tip"}), ("middle", "beam", {"port": "middle"}),
         ("middle", "b")],
    )  # fmt: skip
    causal = bg.assign_causality(made)
    drawing = bg.drawing(causal)
    assert texts(drawing).count("C: beam") == 1
    at_beam = [bond for bond in drawing.scene.bonds if "beam" in (bond.tail, bond.head)]
    assert {bond.ends: bond.receiver for bond in at_beam} == {
        ends: causal.strokes[ends] for ends in [("tip", "beam"), ("middle", "beam")]
    }


def test_detectors_and_gyrators() -> None:
    made = graph(
        [bg.Se("u", "U"), bg.One("coil"), bg.I("L", "L"), bg.GY("motor", "k_m"), bg.One("shaft"),
         bg.I("J", "J"), bg.Df("angle", integrate="theta"), bg.De("torque"), bg.Zero("node"), bg.R("b", "b")],
        [("u", "coil"), ("coil", "L"), ("coil", "motor"), ("motor", "shaft"), ("shaft", "J"),
         ("shaft", "angle"), ("shaft", "node"), ("node", "torque"), ("node", "b")],
    )  # fmt: skip
    assert {"GY: km", "Df: angle", "De: torque"} <= {
        text.replace("angle :Df", "Df: angle").replace("torque :De", "De: torque")
        for text in texts(bg.drawing(made))
    }


def test_widths_are_those_of_the_font() -> None:
    """The table against the font's own file, in thousandths of the size."""
    font_manager = pytest.importorskip("matplotlib.font_manager")
    ft2font = pytest.importorskip("matplotlib.ft2font")
    font = ft2font.FT2Font(font_manager.findfont(FAMILY))
    for letter, advance in ADVANCES.items():
        glyph = font.load_char(ord(letter), flags=ft2font.LoadFlags.NO_SCALE)
        assert round(glyph.horiAdvance * 1000 / font.units_per_EM) == advance, letter


@pytest.mark.parametrize("file", ["alsd.svg", "fig2a.svg", "pendulum.svg", "speed_loop.svg"])
def test_pictures_of_the_documentation_are_up_to_date(file: str) -> None:
    """If this fails as it should, write them with ``python docs/draw.py``."""
    spec = util.spec_from_file_location("draw", ROOT / "docs" / "draw.py")
    assert spec is not None
    assert spec.loader is not None
    module = util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert (ROOT / "docs" / "pictures" / file).read_text(encoding="utf-8") == module.picture(file)

"""Signals in pictures: what reads what, and where lines run; chains that lie, names and numbers."""

from functools import cache
from importlib import import_module
from itertools import pairwise

import pytest
from references.drawn import arrow, boxes, in_the_way, touching
from references.pictured import PICTURED, made, masses, modulated, prey_and_predators

import bondgraph as bg
from bondgraph.drawing.compose import Layout
from bondgraph.drawing.rich import plain
from bondgraph.layout.boxes import Box
from bondgraph.layout.routes import Wanted, routes
from bondgraph.layout.stubs import Surroundings

WRITTEN = {"plain": {}, "full": {"powers": True, "names": True, "numbers": True}}
LAYOUTS: tuple[Layout, ...] = ("horizontal", "vertical")


@cache
def drawn(name: str, layout: Layout | None = None, written: str = "plain") -> bg.Drawing:
    """One of the graphs, drawn once for all that is asked of it."""
    return bg.drawing(PICTURED[name](), layout=layout, **WRITTEN[written])


def told(drawing: bg.Drawing) -> dict[tuple[object, object], str]:
    """What reads what of which other, by names."""
    items = drawing.subject.items
    return {
        (items[one.source].name, items[one.reader].name): plain(one.names)
        for one in drawing.subject.signals
    }


def symbols(drawing: bg.Drawing) -> dict[object, str]:
    return {item.name: item.symbol for item in drawing.subject.items}


@pytest.mark.parametrize("written", WRITTEN)
@pytest.mark.parametrize("layout", [None, *LAYOUTS])
@pytest.mark.parametrize("name", PICTURED)
def test_nothing_touches(name: str, layout: Layout | None, written: str) -> None:
    drawing = drawn(name, layout, written)
    assert touching(drawing.scene) == []
    assert in_the_way(drawing.scene) == []
    shown = {(one.source, one.reader) for one in drawing.scene.signals}
    assert shown == set(told(drawing))


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("seed", range(14))
def test_nothing_touches_in_random_graphs(seed: int, layout: Layout) -> None:
    drawing = bg.drawing(modulated(seed), layout=layout)
    assert touching(drawing.scene) == []
    assert in_the_way(drawing.scene) == []
    assert len(drawing.scene.signals) == len(drawing.subject.signals)


def test_faults_of_lines_are_seen() -> None:
    """The judge of the tests above sees a signal that is led over a stroke, and one on a bond."""
    scene = drawn("pendulum").scene
    assert in_the_way(scene) == []
    signal = scene.signals[0]
    for at, bond in enumerate(scene.bonds):
        assert bond.stroke is not None
        (x0, y0), (x1, y1) = bond.stroke
        middle = ((x0 + x1) / 2, (y0 + y1) / 2)
        aside = (y1 - y0, x0 - x1)
        path = ((middle[0] - aside[0], middle[1] - aside[1]),
                (middle[0] + aside[0] + 0.1, middle[1] + aside[1] + 0.1))  # fmt: skip
        wrong = type(signal)(signal.source, signal.reader, path, (path[1], path[1]))
        assert in_the_way(type(scene)(**{**vars(scene), "signals": (wrong,)})), at


@pytest.mark.parametrize("name", PICTURED)
def test_signals_run_from_what_has_them_to_what_reads_them(name: str) -> None:
    """Level and upright pieces; the arrow at the reader; a branch begins on a line of its source."""
    scene = drawn(name).scene
    box = {node.name: node.box for node in scene.nodes}
    for signal in scene.signals:
        for (x0, y0), (x1, y1) in pairwise(signal.path):
            assert (abs(x0 - x1) < 1e-6) != (abs(y0 - y1) < 1e-6)
        assert near(box[signal.reader], signal.path[-1])
        assert all(near(box[signal.reader].grown(7), end) for _, end in arrow(signal))
        if not signal.branch:
            assert near(box[signal.source], signal.path[0])
            continue
        stems = [one for one in scene.signals if one.source == signal.source and one is not signal]
        assert any(on(signal.path[0], a, b) for one in stems for a, b in pairwise(one.path))


def near(box: Box, point: tuple[float, float]) -> bool:
    wide = box.grown(3.1)
    return wide.left <= point[0] <= wide.right and wide.top <= point[1] <= wide.bottom


def on(point: tuple[float, float], first: tuple[float, float], last: tuple[float, float]) -> bool:
    wide = Box(*map(min, first, last), *map(max, first, last)).grown(0.02)
    return wide.left <= point[0] <= wide.right and wide.top <= point[1] <= wide.bottom


def test_parts_that_signals_alone_join_are_drawn_with_them() -> None:
    drawing = bg.drawing(prey_and_predators())
    assert told(drawing) == {
        ("X", "eaten"): "x", ("Y", "eaten"): "y", ("X", "growth"): "x", ("Y", "growth"): "y"
    }  # fmt: skip
    assert symbols(drawing)["eaten"] == symbols(drawing)["growth"] == "MSf"
    assert drawing.text().splitlines()[-1].split() == ["C:", "1", "┄┄→", "MSf:", "δ·x·y", "y"]
    assert "growth reads x of X" in drawing.scene.description
    assert drawing.svg().count('stroke-width="0.7"') == 8  # a line and an arrow each


def test_what_signals_and_the_time_modulate() -> None:
    pendulum, motor = drawn("pendulum"), drawn("excited_motor")
    assert told(pendulum) == {("angle", "x"): "θ", ("angle", "y"): "θ"}
    assert symbols(pendulum)["x"] == symbols(pendulum)["y"] == "MTF"
    assert symbols(pendulum)["weight"] == "Se"
    assert told(motor) == {("coil", "machine"): "i_f"}
    assert symbols(motor)["machine"] == "MGY"
    assert symbols(motor)["b"] == "MR"  # the time
    assert symbols(motor)["Ra"] == "R"


def test_what_is_at_its_own_bond_is_no_signal() -> None:
    """Air drag by the speed of its own junction, named at the mass; a source of the same is modulated."""
    graph = made(
        [
            bg.One("body"),
            bg.I("m", "m", flow="v"),
            bg.R("air", law="c*v*abs(v)"),
            bg.Se("wind", "-b*v"),
        ],
        [("body", "m"), ("body", "air"), ("wind", "body")],
    )
    drawing = bg.drawing(graph)
    assert told(drawing) == {("m", "wind"): "v"}
    assert symbols(drawing)["air"] == "R"
    assert symbols(drawing)["wind"] == "MSe"


def test_signals_can_be_left_out() -> None:
    drawing = bg.drawing(prey_and_predators(), signals=False)
    assert drawing.scene.signals == ()
    assert "┄" not in drawing.text()
    assert symbols(drawing)["growth"] == "MSf"


def test_a_signal_that_finds_no_way_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    arrows = import_module("bondgraph.drawing.arrows")
    monkeypatch.setattr(arrows, "routes", lambda wanted, _: [None] * len(wanted))
    notes = " ".join(text for text, _ in boxes(bg.drawing(prey_and_predators()).scene))
    assert "Signals without a line: eaten reads x of X; eaten reads y of Y" in notes


def test_bonds_to_detectors_have_full_arrows_and_strokes() -> None:
    for name in ("pendulum", "amplifier", "servo", "relay"):
        scene = drawn(name).scene
        kinds = {item.name: item.kind for item in drawn(name).subject.items}
        for bond in scene.bonds:
            detects = kinds[bond.tail].detects or kinds[bond.head].detects
            assert (bond.other is not None) == detects
            assert bond.stroke is not None
    assert "──→" in drawn("relay").text()


def test_ports_of_fields_are_named_at_the_field() -> None:
    for layout in LAYOUTS:
        scene = drawn("coupled_coils", layout).scene
        coils = next(node.box for node in scene.nodes if node.name == "coils")
        ports = {bond.tail: bond.labels for bond in scene.bonds if bond.head == "coils"}
        texts = {
            tail: ["".join(run.text for run in one.rich) for one in own]
            for tail, own in ports.items()
        }
        assert texts == {"a": ["primary"], "b": ["secondary"]}
        others = [node.box for node in scene.nodes if node.name in ("a", "b")]
        for (label,) in ports.values():
            assert apart(label.box, coils) < min(apart(label.box, other) for other in others)
    assert "I: coils [primary]" in drawn("coupled_coils").text()


def apart(one: Box, two: Box) -> float:
    across = max(one.left - two.right, two.left - one.right, 0.0)
    return across + max(one.top - two.bottom, two.top - one.bottom, 0.0)


def test_chains_lie_and_can_be_made_to_stand() -> None:
    lying, standing = bg.drawing(masses()).scene, bg.drawing(masses(), layout="vertical").scene
    assert lying.width > 5 * lying.height
    assert standing.height > 3 * standing.width
    x = {node.name: node.labels[0].box.left for node in lying.nodes}
    row = [f"{kind}_{at}" for at in range(1, 10) for kind in "vf"]
    assert sorted(row, key=x.__getitem__) == row
    short = bg.drawing(masses(1)).scene
    assert short.height > 0
    with pytest.raises(
        bg.StructureError, match="layout is 'horizontal', 'vertical' or None, not 'round'"
    ):
        bg.drawing(masses(), layout="round")  # type: ignore[arg-type]


def test_bonds_are_numbered_as_they_are_listed() -> None:
    drawing = bg.drawing(masses(3), numbers=True)
    for at, bond in enumerate(drawing.scene.bonds, 1):
        assert str(at) in ["".join(run.text for run in one.rich) for one in bond.labels]
    bonds = [line for line in drawing.text().splitlines() if "┄" not in line]
    assert sorted(int(line.split()[0]) for line in bonds) == list(range(1, len(bonds) + 1))


def test_names_stand_beside_values() -> None:
    texts = [text for text, _ in boxes(bg.drawing(masses(3), names=True).scene)]
    assert "odometer" not in texts  # it has no value, so its name is written already
    assert {"C: 1/k1", "k1", "MSe: k·(r − s)", "drive"} <= set(texts)
    assert "k1" not in [text for text, _ in boxes(bg.drawing(masses(3)).scene)]


@pytest.mark.parametrize("name", PICTURED)
def test_the_same_graph_is_the_same_bytes(name: str) -> None:
    assert bg.drawing(PICTURED[name]()).svg() == drawn(name).svg()


def test_a_pair_of_nodes_and_long_names_are_drawn() -> None:
    long = "a_name_that_is_longer_than_all_the_others_are"
    for layout in LAYOUTS:
        drawing = bg.drawing(
            made([bg.Se(long, "F"), bg.I("m", "m")], [(long, "m")]), values=False, layout=layout
        )
        assert touching(drawing.scene) == []
        assert len(drawing.scene.bonds) == 1


def test_lines_find_their_way_round_walls() -> None:
    """Round a wall between two rectangles: the least length by hand, and none where it is walled in."""
    one, two, wall = Box(0, 0, 20, 20), Box(200, 0, 220, 20), Box(100, -50, 120, 40)
    near = Surroundings([one, two, wall], [], [])
    (route,) = routes([Wanted((one,), (two,), "a")], near)
    assert route is not None
    assert route.path[0][1] >= 20  # below, where the wall is shorter
    assert all(not wall.grown(5.9).crossed(a, b) for a, b in pairwise(route.path))
    closed = [
        Box(-60, -60, 80, -20),
        Box(-60, 40, 80, 80),
        Box(-60, -60, -20, 80),
        Box(40, -60, 80, 80),
    ]
    assert routes([Wanted((one,), (two,), "a")], Surroundings([one, two, *closed], [], [])) == [
        None
    ]

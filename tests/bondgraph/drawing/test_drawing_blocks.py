"""Nodes of signals in pictures: blocks, and arrows from what they read to what reads them."""

import random
from functools import cache
from itertools import combinations
from typing import Any

import pytest
from references.drawn import in_the_way, touching

import bondgraph as bg
from bondgraph.drawing.compose import Layout
from bondgraph.drawing.rich import plain
from bondgraph.drawing.shapes import NodeShape

LAYOUTS: tuple[Layout | None, ...] = (None, "horizontal", "vertical")


def _motor(*nodes: Any) -> list[Any]:
    return [
        bg.Se("motor"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b"), bg.Df("tacho"), *nodes
    ]  # fmt: skip


BONDS = "motor > shaft > J, shaft > b, shaft > tacho"


def pi_loop() -> Any:
    return bg.graph(
        _motor(
            bg.Function("error", "ref - y", ports=["y"]), bg.State("z", "K_i*e", ports=["e"]),
            bg.Function("tau", "K*e + z", ports=["e"]),
        ),
        BONDS, "tacho > error > tau > motor, error > z > tau",
    )  # fmt: skip


def limited() -> Any:
    nodes = _motor(
        bg.State("z", "K_i*(ref - omega) - 1", low=0, high="z_max"),
        bg.Function("tau", "z - d*omega"),
    )
    return bg.graph(nodes, BONDS, "tacho > z > tau > motor, J > tau")


def two_controllers() -> Any:
    """A slow one tells a fast one; a ratio, a brake and a load read signals, too."""
    nodes = [
        bg.Sf("supply", "w_in"), bg.TF("cvt"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b"),
        bg.Se("brake"), bg.One("wheel"), bg.I("J_2", "J_2", flow="omega_2"), bg.R("slip", "d"), bg.Zero("n"),
        bg.R("r", "r*load"), bg.Function("load", "1 + sin(t)"), bg.Function("filter", "goal - x"),
        bg.State("x", "filter/T"),
        bg.Controller("fast", every=0.01, states={"z": 0}, update={"z": "z + omega - x"},
                      gives={"ratio": "z", "tau_b": "2*z"}),
        bg.Controller("slow", every="1/10", offset="1/25", gives={"goal": "omega_2/4"}),
    ]  # fmt: skip
    return bg.graph(
        nodes, "supply > cvt > shaft > J, shaft > b, brake > shaft, shaft > n > wheel > J_2, n > slip",
        "wheel > r", "fast.ratio > cvt, fast.tau_b > brake, load > r, J > fast, x > fast",
        "J_2 > slow > filter > x > filter",
    )  # fmt: skip


def blocks_alone() -> Any:
    return bg.graph(
        [bg.State("x", "v"), bg.State("v", "-k*x"), bg.Function("E", "v**2/2 + k*x**2/2")]
    )


GRAPHS = {make.__name__: make for make in (pi_loop, limited, two_controllers, blocks_alone)}


@cache
def drawn(name: str, layout: Layout | None = None, powers: bool = False) -> bg.Drawing:
    return bg.drawing(GRAPHS[name](), layout=layout, powers=powers)


def told(drawing: bg.Drawing) -> dict[tuple[object, object], str]:
    """What reads what of which other, by names."""
    items = drawing.subject.items
    return {
        (items[one.source].name, items[one.reader].name): plain(one.names)
        for one in drawing.subject.signals
    }


def shapes(drawing: bg.Drawing) -> dict[object, NodeShape]:
    return {node.name: node for node in drawing.scene.nodes}


def inside(drawing: bg.Drawing, name: str) -> list[str]:
    """What stands in a block."""
    return [plain(label.rich) for label in shapes(drawing)[name].labels]


@pytest.mark.parametrize("powers", [False, True])
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("name", GRAPHS)
def test_nothing_touches_and_every_signal_has_its_line(
    name: str, layout: Layout | None, powers: bool
) -> None:
    drawing = drawn(name, layout, powers)
    assert touching(drawing.scene) == []
    assert in_the_way(drawing.scene) == []
    assert {(one.source, one.reader) for one in drawing.scene.signals} == set(told(drawing))
    for one, two in combinations(drawing.scene.blocks, 2):
        assert not one.overlaps(two)


@pytest.mark.parametrize("seed", range(8))
def test_nothing_touches_in_random_diagrams(seed: int) -> None:
    """Functions and states that read each other and a motor, half of them by wires."""
    dice = random.Random(seed)
    names = [f"s_{at}" for at in range(3 + seed)]
    nodes, wires = [], []
    for name in names:
        read = dice.sample([one for one in names if one != name], 2)
        text = f"-{name} + {read[0]}/2 - {read[1]}/3 + omega/5"
        nodes.append(bg.State(name, text) if dice.random() < 0.6 else bg.State(name, text, low=-1))
        wires += [f"{one} > {name}" for one in read if dice.random() < 0.5]
    nodes.append(bg.Function("tau", f"ref - {names[0]}"))
    drawing = bg.drawing(bg.graph(_motor(*nodes), BONDS, ", ".join([*wires, "tau > motor"])))
    assert touching(drawing.scene) == []
    assert in_the_way(drawing.scene) == []
    assert len(drawing.scene.signals) == len(drawing.subject.signals)


def test_wires_and_names_are_one_arrow_each() -> None:
    assert told(drawn("pi_loop")) == {
        ("tacho", "error"): "ω", ("error", "z"): "error", ("error", "tau"): "error",
        ("z", "tau"): "z", ("tau", "motor"): "τ",
    }  # fmt: skip
    assert told(drawn("two_controllers"))["fast", "brake"] == "τ_b"


def test_a_wire_tells_whose_a_signal_is() -> None:
    """By name omega is the detector's; a wire from the inertia says that it is read there."""
    nodes = _motor(bg.Function("f", "2*omega"), bg.State("q", "-f"))
    by_name = bg.graph(nodes, "motor > shaft > J, shaft > b, shaft > tacho", "q > motor")
    by_name.nodes["tacho"]["flow"] = "omega"
    by_wire = by_name.copy()
    by_wire.add_edge("J", "f")
    assert ("tacho", "f") in told(bg.drawing(by_name))
    found = told(bg.drawing(by_wire))
    assert ("tacho", "f") not in found
    assert found["J", "f"] == "ω"


def test_blocks_say_what_they_do() -> None:
    assert inside(drawn("pi_loop"), "tau") == ["τ", "K·error + z"]
    assert inside(drawn("pi_loop"), "z") == ["z", "∫ Kᵢ·error"]
    assert inside(drawn("limited"), "z") == ["z", "∫ (Kᵢ·(ref − ω) − 1)", "0 ≤ z ≤ z_max"]
    assert inside(drawn("two_controllers"), "slow") == ["slow", "every 1/10 s from 1/25 s on"]
    names = bg.drawing(GRAPHS["limited"](), values=False)
    assert inside(names, "z") == ["z"]
    long = bg.graph([bg.State("x", "+".join(f"sin({at}*x)" for at in range(1, 9)))])
    assert inside(bg.drawing(long), "x") == ["x"]


def test_blocks_are_framed_and_hold_their_text() -> None:
    drawing = drawn("limited")
    assert [node.name for node in drawing.scene.nodes if node.block] == ["z", "tau"]
    assert len(drawing.scene.frames) == 0
    for node in drawing.scene.nodes:
        for label in node.labels if node.block else ():
            assert node.frame is not None
            assert node.frame.left < label.box.left
            assert label.box.right < node.frame.right
            assert node.frame.top < label.box.top
            assert label.box.bottom < node.frame.bottom
    assert drawing.svg().count("<rect x=") == 2


@pytest.mark.parametrize("layout", LAYOUTS)
def test_blocks_follow_the_signals_and_the_last_is_level_with_what_reads_it(
    layout: Layout | None,
) -> None:
    node = shapes(drawn("pi_loop", layout))
    places = [node[name].box.left for name in ("error", "z", "tau", "motor")]
    assert places == sorted(places)
    middles = [(node[name].box.top + node[name].box.bottom) / 2 for name in ("tau", "motor")]
    assert abs(middles[0] - middles[1]) <= 1
    (last,) = (one for one in drawn("pi_loop", layout).scene.signals if one.reader == "motor")
    assert len(last.path) == 2


def test_blocks_are_listed_with_what_they_do() -> None:
    assert str(pi_loop()).splitlines() == [
        "MSe: τ            ──⇀|  1 shaft",
        "1 shaft          |──→   Df: tacho",
        "1 shaft           ──⇀|  I: J",
        "1 shaft          |──⇀   R: b",
        "Function: τ       ┄┄→   MSe: τ           τ",
        "Df: tacho         ┄┄→   Function: error  ω",
        "Function: error   ┄┄→   State: z         error",
        "Function: error   ┄┄→   Function: τ      error",
        "State: z          ┄┄→   Function: τ      z",
        "Function: error    =    ref − ω",
        "State: z           =    ∫ Kᵢ·error",
        "Function: τ        =    K·error + z",
    ]
    assert (
        str(limited()).splitlines()[-2] == "State: z       =    ∫ (Kᵢ·(ref − ω) − 1), 0 ≤ z ≤ z_max"
    )


def test_strokes_of_bonds_are_as_without_signals() -> None:
    """The motor gives its effort, the inertia the flow; signals change none of it."""
    strokes = {bond.ends: bond.receiver for bond in drawn("pi_loop").scene.bonds}
    assert strokes == {
        ("motor", "shaft"): "shaft", ("shaft", "J"): "J", ("shaft", "b"): "shaft",
        ("shaft", "tacho"): "shaft",
    }  # fmt: skip


def test_pictures_of_blocks_are_saved(tmp_path: Any) -> None:
    for suffix, start in ((".png", b"\x89PNG"), (".pdf", b"%PDF")):
        path = tmp_path / f"loop{suffix}"
        drawn("limited").save(path)
        assert path.read_bytes().startswith(start)


def test_the_picture_in_words_counts_blocks() -> None:
    words = drawn("pi_loop").scene.description
    kinds = "1 1, 1 Df, 2 Function, 1 I, 1 MSe, 1 R, 1 State"
    assert words.startswith(f"A bond graph of 8 nodes ({kinds}) and 4 bonds.")
    assert "error reads ω of tacho" in words

"""Pictures of bond graphs by their geometry: nothing touches, strokes lie where effort is received."""

import math
import random
from functools import cache
from importlib import util
from pathlib import Path
from typing import Any

import pytest
from references.drawn import boxes, lines, touching
from references.random_graphs import random_graph
from soak.families import seeds

import bondgraph as bg
import differentials
from bondgraph.drawing.shapes import Scene
from bondgraph.layout.boxes import Box, Point

EXAMPLES = Path(__file__).parents[3] / "examples"

DIFFERENTIALS = sorted(
    path.stem for path in EXAMPLES.glob("*.py") if "differentials.parts" in path.read_text("utf-8")
)
"""Those that are put together from parts."""

CATALOG = [
    (name, full) for name, row in differentials.catalog.items() for full in {False, row.full}
]


@cache
def drawn(name: str, full: bool = False, powers: bool = False) -> Scene:
    """A differential's picture, made once for all that is asked of it."""
    return bg.drawing(differentials.graph(name, full), powers=powers).scene


def example(name: str) -> Any:
    """The graph that an example builds."""
    spec = util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.graph()


def check_strokes(causal: bg.CausalGraph, scene: Scene) -> None:
    """Every bond has one stroke, across its end at the node that receives the effort."""
    box = {node.name: node.box for node in scene.nodes}
    assert {bond.ends for bond in scene.bonds} == set(causal.strokes)
    for bond in scene.bonds:
        receiver = causal.strokes[bond.ends]
        (other,) = {bond.tail, bond.head} - {receiver}
        assert bond.stroke is not None
        (x1, y1), (x2, y2) = bond.stroke
        middle = ((x1 + x2) / 2, (y1 + y2) / 2)
        end = bond.path[0] if receiver == bond.tail else bond.path[-1]
        inner = bond.path[1] if receiver == bond.tail else bond.path[-2]
        assert math.dist(middle, end) < 1e-9
        assert distance(middle, box[receiver]) < distance(middle, box[other])
        along = (inner[0] - end[0], inner[1] - end[1])
        across = (x2 - x1, y2 - y1)
        assert abs(along[0] * across[0] + along[1] * across[1]) < 1e-6 * math.hypot(*along)


def distance(point: Point, box: Box) -> float:
    """From a point to a rectangle."""
    across = max(box.left - point[0], 0.0, point[0] - box.right)
    return math.hypot(across, max(box.top - point[1], 0.0, point[1] - box.bottom))


@pytest.mark.parametrize("powers", [False, True])
@pytest.mark.parametrize(("name", "full"), CATALOG)
def test_nothing_touches_in_the_catalog(name: str, full: bool, powers: bool) -> None:
    assert touching(drawn(name, full, powers)) == []


@pytest.mark.parametrize("powers", [False, True])
@pytest.mark.parametrize("name", DIFFERENTIALS)
def test_nothing_touches_in_the_examples(name: str, powers: bool) -> None:
    assert touching(bg.drawing(example(name), powers=powers).scene) == []


@pytest.mark.parametrize(("name", "full"), CATALOG)
def test_strokes_of_the_catalog(name: str, full: bool) -> None:
    check_strokes(bg.assign_causality(differentials.graph(name, full)), drawn(name, full))


@pytest.mark.slow
def test_strokes_of_random_graphs() -> None:
    count = 0
    drawn_of = seeds("drawings")
    for seed in drawn_of:
        graph = random_graph(random.Random(seed), 4 + seed % 24)
        try:
            causal = bg.assign_causality(graph)
        except bg.BondGraphError:
            continue
        check_strokes(causal, bg.drawing(causal).scene)
        count += 1
    assert count >= 0.55 * len(drawn_of)


def test_barbs_are_on_the_side_of_the_flow() -> None:
    """Below flat bonds, right of steep ones, at the end that power flows to."""
    scene = drawn("four_wheel_drive_tvd")
    for bond in scene.bonds:
        (x0, y0), (x1, y1) = bond.path[-2:]
        off = (bond.barb[0] - x1, bond.barb[1] - y1)
        cross = (x1 - x0) * off[1] - (y1 - y0) * off[0]
        left_to_right = x1 > x0 if abs(x1 - x0) >= abs(y1 - y0) else y1 < y0
        assert (cross > 0) == left_to_right, bond.ends
        assert math.dist(bond.barb, (x0, y0)) < math.dist((x0, y0), (x1, y1))


@pytest.mark.parametrize(
    ("name", "full"), [("passive", False), ("passive", True), ("stationary_tvd", False),
                       ("stationary_tvd", True), ("passive_halfshafts", False)],
)  # fmt: skip
def test_mirror_images(name: str, full: bool) -> None:
    """Left and right are images of each other in the line through the case; inputs are on top."""
    scene = drawn(name, full)
    box = {str(node.name): node.labels[0].box for node in scene.nodes}
    middle = (box["case"].left + box["case"].right) / 2
    assert (box["input"].left + box["input"].right) / 2 == pytest.approx(middle)
    pairs = [("left", "right"), ("tire_1", "tire_2"), ("I_w1", "I_w2")]
    if full:
        pairs += [("wheel_1", "wheel_2"), ("halfshaft_1_spring", "halfshaft_2_spring")]
    if name == "stationary_tvd":
        pairs += [("clutch_1", "clutch_2"), ("carrier_1", "carrier_2")]
    for left, right in pairs:
        assert box[left].top == pytest.approx(box[right].top)
        assert middle - box[left].left == pytest.approx(box[right].right - middle), (left, right)
        assert box[left].right < middle
    wheels = ("wheel_1", "wheel_2") if "wheel_1" in box else ("left", "right")
    assert box["I_w1"].right < box[wheels[0]].left  # inertias outside
    assert box["I_w2"].left > box[wheels[1]].right
    assert box["engine"].top == min(one.top for one in box.values())
    assert box["tire_1"].top == max(one.top for one in box.values()) or name == "stationary_tvd"


def test_pictures_are_inside_their_frame() -> None:
    scene = drawn("superposition_tvd", True, True)
    whole = Box(0, 0, scene.width, scene.height)
    points = [point for _, *line in lines(scene) for point in line]
    for _, box in boxes(scene):
        points += [(box.left, box.top), (box.right, box.bottom)]
    assert all(distance(point, whole) == 0 for point in points)

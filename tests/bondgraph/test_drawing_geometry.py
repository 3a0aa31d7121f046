"""Pictures of bond graphs by their geometry: nothing touches, strokes lie where effort is received."""

import math
import random
import sys
from collections.abc import Callable, Iterator
from importlib import util
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest
from references.random_graphs import random_graph

import bondgraph as bg
import differentials
from bondgraph.drawing.shapes import Box, Point, Scene

EXAMPLES = Path(__file__).parents[2] / "examples"

CATALOG = [
    (name, full) for name, row in differentials.catalog.items() for full in {False, row.full}
]


def boxes(scene: Scene) -> list[tuple[str, Box]]:
    """Every label of a picture: what it says and what it fills."""
    labels = [label for node in scene.nodes for label in node.labels]
    labels += [label for bond in scene.bonds for label in bond.labels] + list(scene.notes)
    return [("".join(run.text for run in label.rich), label.box) for label in labels]


def lines(scene: Scene) -> Iterator[tuple[Any, Point, Point]]:
    """Every straight line of every bond."""
    for bond in scene.bonds:
        for first, last in zip(bond.path, bond.path[1:], strict=False):
            yield bond.ends, first, last
        yield bond.ends, bond.path[-1], bond.barb
        if bond.stroke:
            yield bond.ends, *bond.stroke


def touching(scene: Scene) -> list[tuple[object, object]]:
    """Labels that overlap, lines through labels, lines through frames, frames on others' labels."""
    texts = boxes(scene)
    found: list[tuple[object, object]] = [
        (one, two) for (one, a), (two, b) in combinations(texts, 2) if a.overlaps(b)
    ]
    for ends, first, last in lines(scene):
        found += [(ends, text) for text, box in texts if box.crossed(first, last)]
    for node in scene.nodes:
        if node.frame is not None:
            own = {label.box for label in node.labels}
            found += [
                (node.name, text)
                for text, box in texts
                if box not in own and box.overlaps(node.frame)
            ]
            found += [(node.name, e) for e, a, b in lines(scene) if node.frame.crossed(a, b)]
    return found


def example(name: str) -> Any:
    """The graph that an example builds."""
    spec = util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.graph()


def check_strokes(causal: bg.CausalGraph) -> None:
    """Every bond has one stroke, across its end at the node that receives the effort."""
    scene = bg.drawing(causal).scene
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
    assert touching(bg.drawing(differentials.graph(name, full), powers=powers).scene) == []


@pytest.mark.parametrize("powers", [False, True])
@pytest.mark.parametrize("name", sorted(path.stem for path in EXAMPLES.glob("*.py")))
def test_nothing_touches_in_the_examples(name: str, powers: bool) -> None:
    assert touching(bg.drawing(example(name), powers=powers).scene) == []


@pytest.mark.parametrize(("name", "full"), CATALOG)
def test_strokes_of_the_catalog(name: str, full: bool) -> None:
    check_strokes(bg.assign_causality(differentials.graph(name, full)))


def test_strokes_of_random_graphs() -> None:
    drawn = 0
    for seed in range(130):
        graph = random_graph(random.Random(seed), 4 + seed % 24)
        try:
            causal = bg.assign_causality(graph)
        except bg.BondGraphError:
            continue
        check_strokes(causal)
        drawn += 1
    assert drawn >= 100

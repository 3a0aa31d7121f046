"""What equations state when they are shown, put beside what the simulator computes: both sides are equal.

Of random graphs with laws, moving values and tables, and of every ready one: every statement beside the
matrices, every row of the matrices, and every equation with laws and sources put in; and nothing in them is
left unexplained. Guides, notebooks and textbook cases have the same by `rig/walked.py`.
"""

import random
from collections.abc import Callable
from functools import partial
from importlib import import_module
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from oracles.routes.delayed import DELAYED
from oracles.routes.kinds import KINDS
from oracles.stated import instant, misfits, misfits_somewhere
from references.build import bond_graph
from references.cases import CASES
from references.nonlinear.drawn import drawn
from references.pictured import PICTURED
from soak.families import seeds

import bondgraph as bg
import differentials

ROOT = Path(__file__).parents[2]
VARIANTS = ("halfshafts", "lumped", "backlash")


def _paper(name: str, *asked: bool) -> Any:
    """A differential's graph with what is asked of `VARIANTS`."""
    return differentials.graph(name, **dict(zip(VARIANTS, asked, strict=True)))


def _example(path: Path) -> Any:
    if path.suffix == ".json":
        return bg.read_json(path)
    return import_module(f"examples.{path.stem}").graph()


def _variants() -> dict[str, Callable[[], Any]]:
    """The paper's differentials with everything that each can have."""
    found = {}
    for name, asked in product(differentials.catalog, product((False, True), repeat=len(VARIANTS))):
        try:
            _paper(name, *asked)
        except bg.StructureError:
            continue
        chosen = [word for word, one in zip(VARIANTS, asked, strict=True) if one]
        found["-".join([name, *chosen])] = partial(_paper, name, *asked)
    return found


def _is_graph(path: Path) -> bool:
    """Whether an example is a graph, or has one."""
    return path.suffix == ".json" or (
        path.suffix == ".py" and "def graph(" in path.read_text("utf-8")
    )


EXAMPLES = [path for path in sorted((ROOT / "examples").iterdir()) if _is_graph(path)]

GRAPHS: dict[str, Callable[[], Any]] = {
    **_variants(),
    **{path.name: partial(_example, path) for path in EXAMPLES},
    **{name: partial(bond_graph, one.nodes, one.bonds) for name, one in CASES.items()},
    **PICTURED,
}  # fmt: skip
"""By their names: differentials, examples, printed cases, drawings."""


def test_all_that_is_ready_is_walked() -> None:
    kept = {path.name for path in EXAMPLES}
    assert len(kept) >= 5
    assert {*GRAPHS} > kept | {*CASES} | {*PICTURED}
    assert {name.partition("-")[0] for name in GRAPHS} > {*differentials.catalog}
    assert len(GRAPHS) > len(kept) + len(CASES) + len(PICTURED) + 2 * len(differentials.catalog)


@pytest.mark.parametrize("name", GRAPHS)
def test_what_is_stated_of_a_ready_graph_is_what_the_simulator_computes(name: str) -> None:
    assert misfits_somewhere(bg.derive(GRAPHS[name]())) == []


INSTANTANEOUS = [name for name, make in KINDS.items() if make not in DELAYED]
"""What a delay gives has no instant of its own."""


@pytest.mark.parametrize("name", INSTANTANEOUS)
def test_what_is_stated_of_every_kind_of_ports_is_what_the_simulator_computes(name: str) -> None:
    assert misfits_somewhere(KINDS[name]().equations) == []


@pytest.mark.parametrize("seed", seeds("whole-equations"))
def test_what_is_stated_is_what_the_simulator_computes(seed: int) -> None:
    rng = random.Random(f"whole {seed}")
    made = drawn(rng, rng.randint(4, 12))
    try:
        equations = bg.derive(made.graph, outputs=[], inputs=made.inputs)
        at = instant(equations, rng, made.parameters)
    except bg.BondGraphError:
        return
    assert misfits(equations, at) == []

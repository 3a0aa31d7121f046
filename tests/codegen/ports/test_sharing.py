"""Redundant ports share a load fairly: also those that are not the worst, and alike in every backend."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest
import scipy.optimize
from oracles.c_model import Pair
from oracles.exported import instant, loaded
from references.build import bond_graph

import bondgraph as bg
from codegen import simulator, to_python
from codegen.standalone.sharing import fair_share


def _in_turn(efforts: np.ndarray, share: np.ndarray, caps: np.ndarray) -> np.ndarray:
    """By linear programs: the least largest fraction; what must carry it does; then the rest."""
    free, count = share.shape
    known: dict[int, float] = {}
    while len(known) < count:
        open_ = [i for i in range(count) if i not in known]
        rows = [np.append(s * share[:, i], -caps[i]) for i in open_ for s in (1, -1)]
        right = [-s * efforts[i] for i in open_ for s in (1, -1)]
        fixed = [np.append(share[:, i], 0.0) for i in known]
        system = {
            "A_eq": np.array(fixed) if fixed else None,
            "b_eq": [known[i] - efforts[i] for i in known] if fixed else None,
        }
        every = [(None, None)] * free + [(0, None)]
        best = scipy.optimize.linprog(np.eye(free + 1)[-1], rows, right, bounds=every, **system)
        top = best.x[-1] * (1 + 1e-9) + 1e-9
        within = every[:-1] + [(0, top)]
        for i in open_:
            ends = [
                s * efforts[i] + scipy.optimize.linprog(
                    np.append(s * share[:, i], 0.0), rows, right, bounds=within, **system
                ).fun
                for s in (1, -1)
            ]  # fmt: skip
            if -ends[1] - ends[0] < 1e-6:
                known[i] = (ends[0] - ends[1]) / 2
    return np.array([known[i] for i in range(count)])


@pytest.mark.parametrize("seed", range(12))
def test_shares_are_those_of_linear_programs_in_turn(seed: int) -> None:
    """Also where directions leave a port alone, or fall into pairs that do not touch."""
    rng = np.random.default_rng(seed)
    free, count = 1 + seed % 3, 5
    share = rng.normal(size=(free, count)) * (rng.uniform(size=(free, count)) < 0.7)
    share[np.arange(free), np.arange(free)] = 1.0
    efforts, caps = rng.normal(size=count) * 10, rng.uniform(0.5, 20, count)
    assert fair_share(efforts, share, caps) == pytest.approx(
        _in_turn(efforts, share, caps), abs=1e-5
    )


def test_pairs_that_do_not_touch_share_each_by_itself() -> None:
    share = np.array([[1.0, -1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, -1.0, 0.0]])
    caps = np.array([1.0, 3.0, 2.0, 2.0, 1.0])
    found = fair_share(np.array([8.0, 0.0, 0.0, 1.0, 9.0]), share, caps)
    assert found == pytest.approx([2.0, 6.0, 0.5, 0.5, 9.0], abs=1e-14)


def _shaft(gears: str = "") -> bg.StateEquations:
    """Brakes on a shaft, the last ones behind gears, and one on another shaft beyond a spring."""
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.Zero("k"),
             bg.C("s", "c", effort="f"), bg.One("far"), bg.I("l", "l", flow="w"),
             bg.R("b_far", law=bg.DryFriction("L_far", 1, 1.1)),
             *(bg.R(f"b{i}", law=bg.DryFriction(f"L_{i}", 1, 1.2)) for i in range(3 + len(gears))),
             *(bg.TF(f"g{i}", ratio) for i, ratio in enumerate(gears))]  # fmt: skip
    bonds = "push>n>m n>k>s k>far>l far>b_far n>b0 n>b1 n>b2 "
    bonds += " ".join(f"n>g{i} g{i}>b{3 + i}" for i in range(len(gears)))
    return bg.derive(bond_graph(nodes, bonds))


SHAFTS = {"brakes": "", "geared": "r", "twice geared": "rq"}
RATIOS = {"r": 2.5, "q": -0.4}


def _values(gears: str) -> dict[str, float]:
    levels = {f"L_{i}": 1.0 + 0.7 * i for i in range(3 + len(gears))}
    ratios = {one: RATIOS[one] for one in gears}
    return {"m": 2.0, "l": 0.7, "c": 0.1, "L_far": 0.8} | levels | ratios


def _loads(caps: np.ndarray, gains: np.ndarray) -> list[float]:
    """Pushes well below what the brakes can hold, just below it and just above it."""
    most = float(np.abs(gains) @ caps)
    return [0.3 * most, -0.7 * most, most * (1 - 1e-9), -most * (1 - 1e-9), most * (1 + 1e-9)]


@pytest.mark.parametrize("name", SHAFTS)
def test_python_shares_as_the_simulator_does(name: str) -> None:
    equations, gears = _shaft(SHAFTS[name]), SHAFTS[name]
    values = _values(SHAFTS[name])
    ready, exported = simulator(equations, values), loaded(to_python(equations, values)).Model()
    caps = np.array([1.2 * values[f"L_{i}"] for i in range(3 + len(gears))])
    gains = np.array([1.0, 1.0, 1.0, *(RATIOS[one] for one in gears)])
    sticking = []
    for load, far in product(_loads(caps, gains), (0.0, 0.5, -5.0)):
        x = np.array([far if one == "f" else 0.0 for one in ready.states])
        _, signals, mode = instant(ready, 0.0, x, np.array([load + far]), np.zeros(1))
        now = exported.instant(0.0, x, [load + far], None, None)
        sticking.append(mode)
        found = exported.outputs(0.0, x, [load + far])
        size = max(map(abs, signals.values()))
        assert found == pytest.approx(signals, rel=0, abs=1e-12 * size)
        assert now.rate == pytest.approx(ready.rhs(0.0, x, [load + far]), abs=1e-12 * size)
    assert {mode.count(0) for mode in sticking} >= {len(caps) + 1, len(caps)}


@pytest.mark.parametrize("name", SHAFTS)
def test_c_shares_as_the_simulator_does(name: str, tmp_path: Path) -> None:
    equations, rng = _shaft(SHAFTS[name]), np.random.default_rng(4)
    values = _values(SHAFTS[name])
    pair = Pair(tmp_path, equations, values)
    for _ in range(20):
        x, w = rng.normal(size=len(pair.program.states)), rng.normal(size=1) * 10
        mode = tuple(int(one) for one in rng.choice([0, 0, 0, 1], len(pair.program.friction)))
        now = pair.closed.evaluate(0.0, x, w, np.zeros(1), mode)
        status, parts = pair.c.evaluate(0.0, x, w, [0.0], mode)
        assert status == 0, pair.c.message(status)
        assert parts[2] == pytest.approx(now.u, rel=0, abs=1e-12 * np.abs(now.u).max())

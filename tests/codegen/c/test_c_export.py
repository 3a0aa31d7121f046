"""Exported C agrees with the simulator's model at every instant, in every mode, at any parameters."""

from collections.abc import Iterator
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import Pair
from oracles.exported import Case, catalog_cases, small_cases

import bondgraph as bg
from differentials import magic_formula_tire, stribeck_clutch
from differentials.model import model

RELATIVE = 1e-12
LOOPS = 1e-8
"""Laws that have to be solved for are solved to this fraction by either side."""


def _nonlinear() -> Iterator[tuple[str, Case]]:
    tires = {f"tire_{j}": magic_formula_tire(j) for j in (1, 2)}
    for name in ("alsd", "stationary_tvd"):
        levels = model(name).differential.clutches
        rubbing = {node: stribeck_clutch(levels[node], "ratio", 0.1) for node in levels}
        full = model(name, {**tires, **rubbing})
        values = {symbol: one.value for symbol, one in full.parameters.items()}
        values |= dict.fromkeys(full.starts, 80.0) | {"D_t": 4000.0, "C_t": 1.6, "E_t": 0.5}
        values["ratio"] = 1.4
        yield f"{name}-nonlinear", (full.equations, values, dict(full.laws))


CASES = dict([*catalog_cases(), *small_cases(), *_nonlinear()])


def _point(pair: Pair, rng: np.random.Generator):
    """A random instant: states about 80 where speeds are, inputs and levels not negative."""
    count = len(pair.program.external)
    s = rng.uniform(-1, 1, pair.closed.size) * rng.choice([0.5, 80.0])
    return rng.uniform(0.1, 3), s, rng.uniform(0.1, 2, count), rng.uniform(-1, 1, count)


def _magnitudes(pair: Pair, now) -> list[np.ndarray]:
    """What the terms of each part add up to: rounding is relative to it."""
    a = now.numbers
    x, u, du = np.abs(now.x), np.abs(now.u), np.abs(now.du)
    y = np.abs(a.F) @ x + np.abs(a.D) @ u + np.abs(a.G) @ du
    rate = np.abs(a.P) @ x + np.abs(a.Q) @ u + np.abs(a.R) @ du
    rows = [x, np.abs(now.z), u, du, y, [*rate, *np.abs(now.rate[len(x) :])], np.abs(now.caps)]
    # Holding efforts add up whatever pushes.
    pushed = max(np.abs(a.R @ now.u).max(initial=0), 1e-3)
    return [np.max(row, initial=0.0) + (pushed if at == 0 else 1e-3) for at, row in enumerate(rows)]


def _compare(pair: Pair, rng: np.random.Generator) -> int:
    """All modes at one random instant; how many could be evaluated."""
    t, s, w, dw = _point(pair, rng)
    solved = pair.program.joint or any(group.loop for group in pair.program.groups)
    done = 0
    for mode in product((-1, 0, 1), repeat=len(pair.program.friction)):
        status, parts = pair.c.evaluate(t, s, w, dw, mode)
        try:
            with np.errstate(all="ignore"):
                now = pair.closed.evaluate(t, s, w, dw, mode)
        except bg.SimulationError:
            assert status != 0, (mode, parts)
            continue
        expected = [now.x, now.z, now.u, now.du, now.y, now.rate, now.caps]
        if not all(np.isfinite(part).all() for part in expected):
            assert status != 0
            continue
        assert status == 0, f"{mode}: {pair.c.message(status)}"
        tolerance = LOOPS if solved else RELATIVE
        for got, part, size in zip(parts, expected, _magnitudes(pair, now), strict=False):
            assert got == pytest.approx(part, rel=0, abs=tolerance * size), mode
        names = list(pair.program.readings)
        rows = [names.index(name) for name in pair.program.outputs]
        assert parts[-1] == pytest.approx(parts[4][rows], rel=0, abs=0)
        done += 1
    return done


@pytest.mark.parametrize("name", CASES)
def test_evaluation_agrees_at_random_instants_modes_and_parameters(
    name: str, tmp_path: Path
) -> None:
    equations, values, laws = CASES[name]
    pair = Pair(tmp_path, equations, values, laws)
    rng = np.random.default_rng(7)
    done = sum(_compare(pair, rng) for _ in range(4))
    for _ in range(3):
        pair.at({key: float(value) * rng.uniform(0.7, 1.4) for key, value in values.items()})
        done += _compare(pair, rng)
    assert done

"""Stops in fixed steps of exported C: what each step leaves."""

from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import Pair
from oracles.stops import ball, dropped, struck

import bondgraph as bg

G = 9.81


def _stepped(pair: Pair, h: float, count: int, s: list[float]) -> tuple[np.ndarray, list[int]]:
    """The vector after each step, and whether the stop is let go in it; no input."""
    rows, modes = [np.array(s)], []
    for k in range(count):
        status, after = pair.c.step(k * h, h, rows[-1], np.zeros((3, len(pair.program.external))))
        assert status == 0, pair.c.message(status)
        rows.append(after)
        modes.append(pair.c.mode()[0])
    return np.array(rows), modes


def _ball(folder: Path, restitution: float) -> Pair:
    return Pair(folder, dropped(restitution).equations, {"m": 2.0, "g": G, "e": restitution})


def test_no_step_goes_through_a_stop(tmp_path: Path) -> None:
    """What a step cannot foresee is its own acceleration's: g h^2 / 2."""
    h = 0.01
    rows, _ = _stepped(_ball(tmp_path, 0.8), h, 600, [0.0, 1.0])
    v, q = rows.T
    assert q.min() >= -G * h**2 / 2 * (1 + 1e-9)
    energy = v**2 / 2 + G * q
    assert (np.diff(energy) <= 1e-9).all()


def test_what_has_bounced_rests_and_does_not_chatter(tmp_path: Path) -> None:
    rows, modes = _stepped(_ball(tmp_path, 0.5), 0.001, 3000, [0.0, 1.0])
    last = max(k for k, mode in enumerate(modes) if mode)
    assert last * 0.001 == pytest.approx(np.sqrt(2 / G) * 3, abs=0.01)
    assert not any(modes[last + 1 :])
    assert not rows[last + 2 :].any()


def test_energy_is_kept_by_what_is_elastic(tmp_path: Path) -> None:
    v, q = _stepped(_ball(tmp_path, 1.0), 0.003, 2000, [0.0, 1.0])[0].T
    assert v**2 / 2 + G * q == pytest.approx(G, rel=1e-9)


def test_what_is_pulled_leaves_in_that_step(tmp_path: Path) -> None:
    """At rest on a stop, with its weight reversed."""
    pair = _ball(tmp_path, 0.0)
    _, modes = _stepped(pair, 0.01, 5, [0.0, 0.0])
    assert modes == [0] * 5
    pair.at({"m": 2.0, "g": -G, "e": 0.0})
    rows, modes = _stepped(pair, 0.01, 5, [0.0, 0.0])
    assert modes == [1] * 5
    assert rows[-1] == pytest.approx([G * 0.05, G * 0.05**2 / 2])


def test_a_bound_at_a_height(tmp_path: Path) -> None:
    equations = bg.derive(ball("e", low="h"))
    pair = Pair(tmp_path, equations, {"m": 2.0, "g": G, "e": 0.0, "h": 0.3})
    rows, modes = _stepped(pair, 0.01, 100, [0.0, 0.5])
    assert rows[-1].tolist() == [0.0, 0.3]
    assert modes[-1] == 0


def test_a_row_of_balls_passes_on_in_one_step(tmp_path: Path) -> None:
    case = struck(4, 1)
    pair = Pair(tmp_path, case.equations, case.numbers)
    names = [str(name) for name in (*pair.program.states, *pair.program.law_states)]
    rows, _ = _stepped(pair, 0.01, 100, [case.initial[name] for name in names])
    speeds = [names.index(f"v{i}") for i in range(4)]
    assert {tuple(row) for row in rows[:, speeds].tolist()} == {(1, 0, 0, 0), (0, 0, 0, 1)}

"""Fixed steps of exported C and of exported Python are the same steps, to rounding."""

from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import Pair
from oracles.exported import catalog_cases, loaded, small_cases

from codegen.python.export import to_python

CASES = dict([*catalog_cases(), *small_cases()])
CHOSEN = (
    "alsd", "stationary_tvd", "superposition_tvd-rigid", "oscillator", "belt", "stacked", "clutches",
    "slip_damper", "constrained", "clutches_with_loss", "heater", "braked_crank",
    "divider V", "lever", "duffing", "mixed",
)  # fmt: skip
STEP, BAND, COUNT = 2e-3, 1e-3, 100


def _inputs(t: float, names: tuple[str, ...]) -> list[float]:
    """Levels of clutches above zero, anything else to and fro."""
    levels = [name.startswith("tau_h") for name in names]
    return [
        2 + np.sin(9 * t + k) if level else -7 * np.cos(9 * t + k) for k, level in enumerate(levels)
    ]


@pytest.mark.parametrize("name", CHOSEN)
def test_steps_agree(name: str, tmp_path: Path) -> None:
    equations, values, laws = CASES[name]
    pair = Pair(tmp_path, equations, values, laws)
    module = loaded(to_python(equations, values, laws))
    program, python = pair.program, module.Model()
    names = tuple(name.name for name in program.external)
    start = np.random.default_rng(5).uniform(-1, 1, len(program.states) + len(program.law_states))
    start[: len(start) // 2] = 0.3
    signals = [lambda t, k=k: _inputs(t, names)[k] for k in range(len(names))]
    given = module.sampled(signals, 0.0, STEP)
    s = module.vector(python.form, 0.0, start, *given[0])
    mine = pair.c.vector(0.0, start, _inputs(0.0, names))
    pair.c.band(BAND)
    mode = None
    for k in range(COUNT):
        t = k * STEP
        given = module.sampled(signals, t, STEP)
        mode, s = python.settled(module.Point(t, s, *given[0]), mode, BAND, STEP)
        mode, s = python.advance(t, STEP, s, given, mode)
        status, mine = pair.c.step(t, STEP, mine, [w for w, _ in given])
        assert status == 0, pair.c.message(status)
        assert pair.c.mode() == tuple(mode), t
        assert mine[: len(s)] == pytest.approx(s, rel=1e-8, abs=1e-8 * (1 + np.abs(s).max())), t

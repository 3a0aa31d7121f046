"""Impulses that slopes do not tell are refused; a resistance in the way, or linear storages, are not."""

import numpy as np
import pytest
from references.build import bond_graph
from scipy.integrate import solve_ivp

import bondgraph as bg
from codegen import simulator

SHARED = [bg.Zero("n"), bg.C("a", law="sinh(q_a)", effort="e_a"), bg.C("b", law="2*sinh(q_b)"), bg.One("j"),
          bg.Sw("s", on="t - 1", off="-1"), bg.Zero("m"), bg.C("c", "1/2", effort="e_c")]  # fmt: skip
BONDS = "n>a n>b n>j j>s j>m m>c"


def test_a_switch_that_shorts_what_is_turned_round_is_refused_by_name() -> None:
    """Shared out by their slopes before, what they hold would not be kept, by a tenth."""
    with pytest.raises(bg.StructureError, match="switch 's' would give an impulse to e_a, e_c"):
        bg.derive(bond_graph(SHARED, BONDS))


def test_behind_a_resistance_it_is_a_matter_of_time() -> None:
    equations = bg.derive(bond_graph([*SHARED, bg.R("r", "r")], f"{BONDS} j>r"))
    run = simulator(equations, {"r": 0.5}).run(np.linspace(0, 3, 7), {"e_a": 5.0})

    def rate(t: float, e: np.ndarray) -> list[float]:
        i = (e[0] - e[1]) / 0.5
        return [-i / (1 / np.hypot(1, e[0]) + 0.5 / np.hypot(1, e[0] / 2)), i / 0.5]

    right = solve_ivp(rate, (1, 3), [5.0, 0.0], "DOP853", run.time[2:], rtol=1e-11, atol=1e-12).y
    assert run["e_a"][2:] == pytest.approx(right[0], rel=1e-8)
    assert run["e_c"][2:] == pytest.approx(right[1], abs=1e-8)

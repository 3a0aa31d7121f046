"""The model that the tour begins with, against the same equations written by hand."""

import doctest
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

pytest.importorskip("matplotlib")

TOUR = Path(__file__).parents[2] / "docs" / "tour.md"
KT, MW, MB, K, K3, C, G = 2e5, 40, 300, 15e3, 5e5, 800, 9.81


def _shown() -> dict[str, Any]:
    """What the first program of the tour makes, by name."""
    names: dict[str, Any] = {}
    text = TOUR.read_text(encoding="utf-8").partition("savefig")[0]
    with redirect_stdout(StringIO()):
        for example in doctest.DocTestParser().get_examples(text):
            exec(compile(example.source, "tour.md", "exec"), names)
    return names


def _rates(_: float, x: np.ndarray, road: float) -> list[float]:
    tyre, wheel, body, stroke = x
    closing = wheel - body
    strut = K * stroke + K3 * stroke**3 + C * closing * abs(closing)
    return [KT * (road - wheel), (tyre - strut) / MW - G, strut / MB - G, closing]


def test_the_quarter_car_of_the_tour_moves_as_its_equations_by_hand() -> None:
    names = _shown()
    run = names["drive"]
    sag = brentq(lambda q: K * q + K3 * q**3 - MB * G, 0, 1)
    x, at = np.array([(MW + MB) * G, 0, 0, sag]), 0.0
    assert run["q_spring"][0] == pytest.approx(sag, rel=1e-9)
    for until, road in ((0.5, 0.0), (0.55, 2.0), (3.0, 0.0)):
        x = solve_ivp(_rates, (at, until), x, args=(road,), rtol=1e-10, atol=1e-10).y[:, -1]
        at = until
    assert [run[name][-1] for name in names["model"].states] == pytest.approx(x, rel=1e-5, abs=1e-6)
    assert len(names["picture"].axes) == 3

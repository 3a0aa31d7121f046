"""The slip controller of a guide: its rest, its poles and its margins, against matrices written by hand."""

import doctest
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

control = pytest.importorskip("control")
pytest.importorskip("matplotlib")

GUIDE = Path(__file__).parents[2] / "docs" / "your-own-differential.md"
PERIOD, LAG, K, K_I = 0.01, 0.04, 40, 100
#: The ice gives 50 of the 200 N m of a side, so that half of the clutch's torque is the other 150.
REST, SLIP = 300, 2


def _shown() -> dict[str, Any]:
    """What the section makes, by name, before it writes a unit."""
    text = GUIDE.read_text(encoding="utf-8")
    text = text[text.index("## A slip controller") :].partition("**Take it along.**")[0]
    names: dict[str, Any] = {}
    with redirect_stdout(StringIO()):
        for example in doctest.DocTestParser().get_examples(text):
            exec(compile(example.source, GUIDE.name, "exec"), names)
    return names


def _plant() -> tuple[np.ndarray, np.ndarray]:
    """Wheels and lag over a period: states then what is asked, held; and the row of the slip."""
    right = 0.5 * np.arctanh((200 + REST / 2) / 600)
    slopes = [
        grip / 0.5 / np.cosh(w / 0.5) ** 2 for grip, w in ((50, right + 2 * SLIP), (600, right))
    ]
    shared = 0.1 * 4**2 / 4
    inertia = [[shared + 1, shared], [shared, shared + 1]]
    rates = np.zeros((4, 4))
    rates[:2, :2] = np.linalg.solve(inertia, -np.diag(slopes))
    rates[:2, 2] = np.linalg.solve(inertia, [-0.5, 0.5])
    rates[2, 2:] = -1 / LAG, 1 / LAG
    return np.asarray(expm(rates * PERIOD))[:3], np.array([0.5, -0.5, 0])


def test_the_slip_controller_of_the_guide_is_as_its_matrices_by_hand() -> None:
    names, (moved, slip) = _shown(), _plant()
    assert names["point"]["level"] == pytest.approx(REST, rel=1e-6)
    assert names["point"]["slip"] == pytest.approx(SLIP, rel=1e-9)
    P, Q = moved[:, :3], moved[:, 3]
    closed = np.zeros((4, 4))
    closed[:3, :3], closed[:3, 3] = P + np.outer(Q, K * slip), Q
    closed[3] = [*(PERIOD * K_I * slip), 1]
    poles = np.sort_complex([*np.linalg.eigvals(closed), 0])
    assert np.sort_complex(names["closed"].poles()) == pytest.approx(poles, abs=1e-6)
    hertz = names["hertz"]
    there = np.exp(2j * np.pi * hertz * PERIOD)
    plant = np.array([slip @ np.linalg.solve(z * np.eye(3) - P, Q) for z in there])
    loop = -plant * (K + PERIOD * K_I / (there - 1))
    gain, phase, *_ = control.margin(control.frd(loop, 2 * np.pi * hertz))
    assert (names["gain"], names["phase"]) == pytest.approx((gain, phase), rel=1e-3)


def test_the_slip_stays_where_it_is_allowed_and_the_torque_never_pulls() -> None:
    names = _shown()
    assert names["run"]["slip"][-1] == pytest.approx(SLIP, abs=1e-2)
    assert names["run"]["level"].min() >= 0

"""Bode plots, pole maps and mode shapes, against textbook oscillators."""

import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from oracles.slides import oscillator, two_masses

import bondgraph as bg
from bondgraph.analyse.state_space import StateSpace
from codegen import bode, mode_shapes, pole_map

pytest.importorskip("matplotlib")


def _curves(axis: Any) -> list[Any]:
    return [line for line in axis.lines if line.get_gid() is None]


def test_a_bode_plot_is_that_of_the_textbook() -> None:
    """v / P = s / (2 s^2 + 0.4 s + 8)."""
    hertz = np.array([0.01, 0.1, 1 / np.pi, 1.0, 30.0])
    upper, lower = bode(oscillator(), "P", "v", frequencies=hertz).axes
    s = 2j * np.pi * hertz
    expected = s / (2 * s**2 + 0.4 * s + 8)
    (gain,), (phase,) = _curves(upper), _curves(lower)
    assert gain.get_xdata() == pytest.approx(hertz)
    assert gain.get_ydata() == pytest.approx(20 * np.log10(abs(expected)))
    assert phase.get_ydata() == pytest.approx(np.degrees(np.angle(expected)))
    assert upper.get_ylabel() == "Magnitude [dB]"
    assert lower.get_ylabel() == "Phase [°]"
    assert lower.get_xlabel() == "Frequency [Hz]"
    assert upper.get_xscale() == lower.get_xscale() == "log"


def test_it_shows_every_output_and_marks_the_oscillation() -> None:
    figure = bode(oscillator(), "P", title="Driven")
    upper, _ = figure.axes
    assert [text.get_text() for text in upper.get_legend().get_texts()] == ["$v$", "$F$"]
    assert figure.get_suptitle() == "Driven"
    own = np.sqrt(4 - 0.1**2) / (2 * np.pi)
    (mark,) = (line for line in upper.lines if line.get_gid() == "oscillation")
    assert mark.get_xdata()[0] == pytest.approx(own)
    assert [text.get_text() for text in upper.texts] == [f"{own:.4g} Hz"]


@pytest.mark.parametrize("damping", [4e-2, 4e-5])
def test_sharp_resonances_are_not_missed(damping: float) -> None:
    """At 2 rad/s the force meets nothing but the damper: v / P = 1 / damping."""
    (gain, _) = _curves(bode(oscillator(damping), "P").axes[0])
    assert max(gain.get_ydata()) == pytest.approx(-20 * np.log10(damping), abs=0.3)


def test_the_phase_is_continuous() -> None:
    """A chain of two oscillators falls from 0 to -360 degrees: output 3 times integrated, and once more."""
    one = oscillator()
    P = np.block([[one.P, np.zeros((2, 2))], [one.Q @ one.F[1:], one.P]])
    Q = np.vstack([one.Q, np.zeros((2, 1))])
    F = np.hstack([np.zeros((1, 2)), one.F[1:]])
    two = StateSpace(
        tuple("abcd"), ("P",), ("y",), P, Q, 0 * Q, F, np.zeros((1, 1)), np.zeros((1, 1))
    )
    (phase,) = _curves(bode(two, "P").axes[1])
    assert abs(np.diff(phase.get_ydata())).max() < 90
    assert phase.get_ydata()[[0, -1]] == pytest.approx([0, -360], abs=3)


def test_what_cancels_is_no_response() -> None:
    one = oscillator()
    twin = replace(
        one, states=("a", "b", "c", "d"), outputs=("y", "z"),
        P=np.kron(np.eye(2), one.P), Q=np.vstack([one.Q, one.Q * (1 + 1e-16)]), R=np.zeros((4, 1)),
        F=np.array([[0.3, 0.1, -0.3, -0.1], [1, 0, 0, 0]]), D=np.zeros((2, 1)), G=np.zeros((2, 1)),
    )  # fmt: skip
    upper, lower = bode(twin, "P").axes
    assert [t.get_text() for t in upper.get_legend().get_texts()] == ["$y$ (no response)", "$z$"]
    for axis in (upper, lower):
        nothing, something = _curves(axis)
        assert np.isnan(nothing.get_ydata()).all()
        assert np.isfinite(something.get_ydata()).all()


def test_what_has_no_bode_plot_is_refused() -> None:
    with pytest.raises(bg.SignalError, match="'x' is not an input; there are P"):
        bode(oscillator(), "x")
    with pytest.raises(bg.SignalError, match="'x' is not an output; there are v, F"):
        bode(oscillator(), "P", "v", "x")
    for wrong in ([0.0, 1.0], [-1.0], [np.nan], [], [[1.0]]):
        with pytest.raises(bg.SignalError, match="frequencies must be positive numbers"):
            bode(oscillator(), "P", frequencies=wrong)


def test_poles_lie_where_the_textbook_has_them() -> None:
    figure = pole_map(oscillator())
    (axis,) = figure.axes
    (crosses,) = (line for line in axis.lines if line.get_marker() == "x")
    found = sorted(zip(crosses.get_xdata(), crosses.get_ydata(), strict=True))
    own = np.sqrt(4 - 0.1**2)
    assert found == [pytest.approx((-0.1, -own)), pytest.approx((-0.1, own))]
    (named,) = (text.get_text() for text in axis.texts if text.get_gid() == "mode")
    assert named == f"{own / 2 / np.pi:.4g} Hz, ζ = 0.05"
    assert axis.get_xlabel() == "Real part [1/s]"
    assert axis.get_legend() is None


def test_poles_that_do_not_decay_are_told_from_those_that_do() -> None:
    one = oscillator()
    other = replace(one, P=-one.P)
    (axis,) = pole_map(other).axes
    assert [line for line in axis.lines if line.get_marker() == "x"] == []
    (rings,) = (line for line in axis.lines if line.get_marker() == "o")
    assert rings.get_xdata() == pytest.approx([0.1, 0.1])
    both = replace(one, states=tuple("abcd"), P=np.kron(np.diag([1, -1]), one.P))
    (axis,) = pole_map(both).axes
    assert len(axis.get_legend().get_texts()) == 2


def test_rounding_is_not_shown() -> None:
    """Undamped: poles at 0, 2 and 2 sqrt(3) times i, none of which decays, whatever rounding makes of it."""
    model = two_masses()
    (axis,) = pole_map(model).axes
    assert [line.get_marker() for line in axis.lines if line.get_linestyle() == "None"] == ["o"]
    first, second, third = sorted(axis.get_title() for axis in mode_shapes(model).axes)
    assert first == "0 1/s"
    assert second.endswith("damping ratio 0")
    assert third.endswith("damping ratio 0")


def test_rays_have_their_damping_ratio() -> None:
    (axis,) = pole_map(oscillator(1.6)).axes
    rays = [line for line in axis.lines if line.get_gid() == "ray"]
    ratios = set()
    for ray in rays:
        (x, y) = ray.get_xdata()[1], ray.get_ydata()[1]
        ratios.add(round(-x / np.hypot(x, y), 9))
    assert ratios == {0.1, 0.2, 0.4, 0.7}


def test_shapes_are_together_and_against_each_other() -> None:
    """Equal masses between walls: 2 rad/s in phase, 2 sqrt(3) in opposite phase; springs a quarter ahead."""
    model = two_masses()
    figure = mode_shapes(model)
    titles = [axis.get_title() for axis in figure.axes]
    for expected in (2 / (2 * np.pi), 2 * np.sqrt(3) / (2 * np.pi)):
        assert sum(title.startswith(f"{expected:.4g} Hz") for title in titles) == 1, titles
    for axis in figure.axes:
        names = [label.get_text() for label in axis.get_xticklabels()]
        assert names[:2] == ["$v_{1}$", "$v_{2}$"]
        (arrows,) = axis.collections
        ahead = dict(zip(arrows.XY[:, 0].round(), arrows.U + 1j * arrows.V, strict=True))
        same = {f"{2 / (2 * np.pi):.4g}": 1, f"{2 * np.sqrt(3) / (2 * np.pi):.4g}": -1}
        sign = next((same[k] for k in same if axis.get_title().startswith(k)), None)
        if sign is not None:
            assert ahead[1] / ahead[0] == pytest.approx(sign)
            # F_1' = k v_1: the spring's force is a quarter period behind the speed.
            assert ahead[2] / ahead[0] == pytest.approx(-1j)


def test_bars_are_participations() -> None:
    model = two_masses()
    modes = model.modes()
    for axis, mode in zip(mode_shapes(model).axes, modes, strict=True):
        heights = [bar.get_height() for bar in axis.patches]
        assert heights == pytest.approx(list(mode.participation.values()))


def test_chosen_modes_alone_are_drawn() -> None:
    model = two_masses()
    chosen = [model.mode({"v_1": 1, "v_2": -1})]
    (axis,) = mode_shapes(model, chosen, title="Against").axes
    assert axis.get_title().startswith(f"{2 * np.sqrt(3) / (2 * np.pi):.4g} Hz")
    with pytest.raises(bg.SignalError, match="no modes to draw"):
        mode_shapes(model, [])


def test_of_many_modes_and_states_the_first_and_the_largest_are_drawn() -> None:
    rates = -np.arange(1.0, 21.0)
    names = tuple(f"x_{k}" for k in range(20))
    empty = np.zeros((20, 0))
    many = StateSpace(
        names, (), (), np.diag(rates), empty, empty, empty.T, np.zeros((0, 0)), np.zeros((0, 0))
    )
    figure = mode_shapes(many)
    assert figure.get_suptitle() == "Modes, the first 12 of 20"
    assert [axis.get_title() for axis in figure.axes] == [f"-{k} 1/s" for k in range(1, 13)]
    assert [t.get_text() for t in figure.axes[0].get_xticklabels()] == [f"$x_{{{k}}}$" if k < 10 else
            rf"$x_{{\mathrm{{{k}}}}}$" for k in range(12)]  # fmt: skip


def test_without_matplotlib_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    for draw in (lambda m: bode(m, "P"), pole_map, mode_shapes):
        with pytest.raises(bg.MissingExtraError, match=r"bondgraph-toolkit\[pictures\]"):
            draw(oscillator())

"""What is drawn of runs: data, labels, marks."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from oracles.slides import slide, swing
from references.build import bond_graph

import bondgraph as bg
from codegen import Event, Result, panels, switched_simulator
from codegen.pictures.flags import ROWS, rows
from codegen.pictures.labels import common, measured, pretty
from codegen.pictures.marks import APART, MOST, stuck_spans
from codegen.pictures.style import COLOURS, curve

matplotlib_figure = pytest.importorskip("matplotlib.figure")


def _curves(axis: Any) -> list[Any]:
    return [line for line in axis.lines if line.get_gid() is None]


def _marks(axis: Any) -> list[float]:
    return [line.get_xdata()[0] for line in axis.lines if line.get_gid() == "event"]


def _eventful(count: int) -> Result:
    run = slide(samples=401)
    events = tuple(Event(4 * k / count, "rub", "cross") for k in range(count))
    return replace(run, events=events)


def test_a_plot_has_the_signals_over_time_with_names_and_units() -> None:
    run = slide()
    figure = run.plot("v", "F_r", title="Slide", units={"F_r": "N"})
    assert isinstance(figure, matplotlib_figure.Figure)
    (axis,) = figure.axes
    for line, name in zip(_curves(axis), ("v", "F_r"), strict=True):
        assert (line.get_xdata() == run.time).all()
        assert (line.get_ydata() == run[name]).all()
    assert [t.get_text() for t in axis.get_legend().get_texts()] == ["$v$ [m/s]", "$F_{r}$ [N]"]
    assert axis.get_ylabel() == "$v$, $F_{r}$"
    assert axis.get_xlabel().startswith("Time [s]")
    assert figure.get_suptitle() == "Slide"


def test_one_signal_has_its_name_and_unit_at_the_axis_and_no_legend() -> None:
    (axis,) = slide().plot("v").axes
    assert axis.get_ylabel() == "$v$ [m/s]"
    assert axis.get_legend() is None


def test_without_names_the_states_are_drawn() -> None:
    run = slide()
    (line,) = _curves(run.plot().axes[0])
    assert (line.get_ydata() == run["v"]).all()


def test_signals_that_no_column_has_are_drawn() -> None:
    run = slide()
    assert "e_m" not in list(run)
    (line,) = _curves(run.plot("e_m").axes[0])
    assert line.get_ydata()[5] == pytest.approx(-3.0)


def test_events_have_a_hairline_and_a_flag_and_sticking_is_shaded() -> None:
    figure = slide().plot("v")
    (axis,) = figure.axes
    assert _marks(axis) == pytest.approx([2.0])
    assert [text.get_text() for text in axis.texts] == ["rub: stick"]
    assert axis.texts[0].xy[0] == pytest.approx(2.0)
    (patch,) = axis.patches
    assert (patch.get_x(), patch.get_x() + patch.get_width()) == pytest.approx((2.0, 4.0))
    assert "grey: sticking" in axis.get_xlabel()


def test_of_many_events_those_that_stand_apart_are_marked_and_counted() -> None:
    few = _eventful(MOST).plot("v").axes[0]
    assert len(_marks(few)) == MOST
    assert "events marked" not in few.get_xlabel()
    many = _eventful(1000).plot("v").axes[0]
    marked = _marks(many)
    assert np.diff(marked).min() >= 4 * APART * (1 - 1e-9)
    assert 0.8 / APART < len(marked) <= 1 / APART + 1
    assert f"({len(marked)} of 1000 events marked)" in many.get_xlabel()


def test_events_outside_the_samples_are_not_marked() -> None:
    run = replace(slide(), events=(Event(-1.0, "rub", "cross"), Event(5.0, "rub", "cross")))
    assert _marks(run.plot("v").axes[0]) == []


def test_an_axis_of_ones_own_is_drawn_into() -> None:
    figure = matplotlib_figure.Figure()
    left, right = figure.subplots(1, 2)
    assert slide().plot("v", ax=right, title="here") is figure
    assert right.get_title() == "here"
    assert len(_curves(right)) == 1
    assert not left.lines


def test_panels_share_the_time_and_every_mark() -> None:
    run = slide()
    upper, lower = panels(run, ["v", ["F_r", "w"]], labels=[None, "Rub"], title="Both").axes
    assert upper.get_shared_x_axes().joined(upper, lower)
    assert (upper.get_ylabel(), lower.get_ylabel()) == ("$v$ [m/s]", "Rub")
    assert [t.get_text() for t in lower.get_legend().get_texts()] == ["$F_{r}$", "$w$"]
    assert _marks(upper) == _marks(lower) == pytest.approx([2.0])
    assert [len(axis.texts) for axis in (upper, lower)] == [1, 0]
    assert lower.get_xlabel().startswith("Time [s]")
    assert upper.get_xlabel() == ""


def test_a_list_among_the_names_of_a_plot_makes_panels() -> None:
    run = slide()
    upper, lower = run.plot(["v", "w"], "F_r", title="Both").axes
    assert [len(_curves(axis)) for axis in (upper, lower)] == [2, 1]
    assert (_curves(upper)[1].get_ydata() == run["w"]).all()
    assert (_curves(lower)[0].get_ydata() == run["F_r"]).all()
    assert len(run.plot(["v", "w"]).axes) == 1
    with pytest.raises(bg.SignalError, match="2 panels do not go into one axis"):
        run.plot(["v"], ["w"], ax=upper)
    with pytest.raises(bg.SignalError, match="at least one signal"):
        run.plot([])


def test_panels_without_groups_are_one_for_each_state() -> None:
    run = slide()
    assert [axis.get_ylabel() for axis in panels(run).axes] == ["$v$ [m/s]"]


def test_what_cannot_be_drawn_is_refused() -> None:
    run = slide()
    with pytest.raises(bg.SignalError, match=r"no signal 'x'; there are v"):
        run.plot("v", "x")
    with pytest.raises(bg.SignalError, match="no signal 'x'"):
        panels(run, ["v", ["x"]])
    with pytest.raises(bg.SignalError, match="list of signals or of lists of signals, not 'v'"):
        panels(run, "v")
    with pytest.raises(bg.SignalError, match="1 labels for 2 panels"):
        panels(run, ["v", "w"], labels=["one"])
    with pytest.raises(bg.SignalError, match="at least one signal"):
        panels(run, ["v", []])


def test_a_picture_is_the_same_bytes_every_time(tmp_path: Path) -> None:
    for name in ("one.png", "other.png"):
        slide().plot("v").savefig(tmp_path / name)
    one, other = ((tmp_path / name).read_bytes() for name in ("one.png", "other.png"))
    assert one == other


def test_nothing_is_left_in_matplotlibs_global_state() -> None:
    script = (
        "import sys; from oracles.slides import slide; slide().plot('v')\n"
        "sys.exit('matplotlib.pyplot' in sys.modules)"
    )
    search = {"PYTHONPATH": ":".join((".", "tests", "tests/codegen"))}
    root = Path(__file__).parents[3]
    done = subprocess.run([sys.executable, "-c", script], cwd=root, env=search, check=False)
    assert done.returncode == 0


def test_matplotlib_is_not_imported_with_the_packages() -> None:
    script = "import sys, codegen, differentials; sys.exit('matplotlib' in sys.modules)"
    root = Path(__file__).parents[3]
    done = subprocess.run([sys.executable, "-c", script], cwd=root, env={}, check=False)
    assert done.returncode == 0


def test_without_matplotlib_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    run = slide()
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(bg.MissingExtraError, match=r"bondgraph-toolkit\[pictures\]"):
        run.plot("v")


def test_sticking_lasts_from_event_to_event_of_a_port() -> None:
    events = (Event(0.01, "a", "stick"), Event(0.015, "b", "stick"), Event(0.02, "a", "slip"),
              Event(0.03, "b", "cross"))  # fmt: skip
    assert stuck_spans(events, 0.05) == [(0.01, 0.02), (0.015, 0.03)]
    assert stuck_spans(events[:1], 0.05) == [(0.01, 0.05)]


def test_flags_are_over_no_other_and_no_pole_runs_through_a_text() -> None:
    random = np.random.default_rng(5)
    starts = np.sort(random.uniform(0, 400, 60))
    stops = starts + random.uniform(20, 60, 60)
    spans = list(zip(starts.tolist(), stops.tolist(), strict=True))
    placed = [(span, row) for span, row in zip(spans, rows(spans), strict=True) if row is not None]
    assert len(placed) > ROWS
    for at, ((start, stop), row) in enumerate(placed):
        for (other, _), above in placed[at + 1 :]:
            if start <= other < stop:
                assert above < row, "a later flag's pole crosses this text, or the texts overlap"


def test_curves_differ_in_colour_and_also_in_line() -> None:
    looks = [(curve(k)["color"], str(curve(k)["linestyle"])) for k in range(42)]
    assert len(set(looks)) == 42
    for first in range(len(COLOURS) - 1):
        assert looks[first][1] != looks[first + 1][1]


def _linear(channel: int) -> float:
    part = channel / 255
    return part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4


def _seen(colour: str, matrix: np.ndarray) -> np.ndarray:
    rgb = np.array([_linear(int(colour[at : at + 2], 16)) for at in (1, 3, 5)])
    return np.clip(matrix @ rgb, 0, 1) ** (1 / 2.2)


#: Full dichromacy over linear RGB: Machado, Oliveira, Fernandes (2009), severity 1.0.
EYES = {
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
                   [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
                     [-0.011820, 0.042940, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602],
                   [0.004733, 0.691367, 0.303900]],
}  # fmt: skip


@pytest.mark.parametrize("eyes", EYES)
def test_the_first_colours_differ_for_colour_blind_eyes(eyes: str) -> None:
    seen = [_seen(colour, np.array(EYES[eyes])) for colour in COLOURS[:4]]
    for at, one in enumerate(seen):
        for other in seen[at + 1 :]:
            assert np.linalg.norm(one - other) > 0.1


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("omega_1", r"$\omega_{1}$"),
        ("tau_hs1", r"$\tau_{\mathrm{hs1}}$"),
        ("x2", "$x_{2}$"),
        ("I_w_left", r"$I_{w,\mathrm{left}}$"),
        ("speed", r"$\mathrm{speed}$"),
        ("ω_1", "ω_1"),
        ("a$b", r"a\$b"),
        ("_x", "_x"),
    ],
)
def test_names_are_greek_where_they_are_called_so(name: str, shown: str) -> None:
    assert pretty(name) == shown
    assert measured(name, "m") == shown + " [m]"


def test_every_greek_name_can_be_drawn() -> None:
    from matplotlib.mathtext import MathTextParser

    from codegen.pictures.labels import GREEK

    for name in sorted(GREEK):
        MathTextParser("path").parse(pretty(name))


def test_an_axis_tells_the_unit_that_all_signals_have() -> None:
    assert common(["a", "b"], ["m", "m"]) == "$a$, $b$ [m]"
    assert common(["a", "b"], ["m", "s"]) == "$a$, $b$"
    assert common("abcd", ["m"] * 4) == "[m]"
    assert common("abcd", ["m", "s", "", ""]) == ""


def test_units_are_those_that_elements_tell() -> None:
    assert dict(slide().units) == {"v": "m/s"}
    assert dict(swing().units) == {"P": "N"}


def test_switchings_are_marked_and_their_units_kept() -> None:
    graph = bond_graph(
        [bg.One("first"), bg.I("m_1", 1, flow="v_1", unit="m/s"), bg.Zero("gap"),
         bg.Sw("slack", on="1 - t"), bg.One("second"), bg.I("m_2", 3, flow="v_2")],
        "first>m_1 first>gap>slack gap>second>m_2",
    )  # fmt: skip
    run = switched_simulator(graph, {}).run(np.linspace(0, 2, 21), initial={"v_1": 4.0})
    (axis,) = run.plot("v_1").axes
    assert axis.get_ylabel() == "$v_{1}$ [m/s]"
    assert [text.get_text() for text in axis.texts] == ["slack: off"]
    assert _marks(axis) == pytest.approx([1.0])
    assert not axis.patches

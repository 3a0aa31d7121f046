"""Runs over one another, and how far they differ."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.slides import slide, swing

import bondgraph as bg
from codegen import Event, compare


def test_the_largest_difference_is_where_textbooks_have_it() -> None:
    """Speeds 3 - 1.5 t and 3 - 2 t, down to 0: furthest apart when the second stops, at 1.5 s."""
    found = compare({"dry": slide(), "drier": slide(4.0)}, ["v"])
    (difference,) = found.differences
    assert (difference.signal, difference.run) == ("v", "drier")
    assert difference.largest == pytest.approx(0.75)
    assert difference.time == pytest.approx(1.5)
    assert difference.relative == pytest.approx(0.25)


def test_events_are_shifted_by_what_the_friction_does() -> None:
    (shift,) = compare({"dry": slide(), "drier": slide(4.0)}).shifts
    assert (shift.port, shift.kind, shift.run) == ("rub", "stick", "drier")
    assert shift.first == pytest.approx(2.0)
    assert shift.shift == pytest.approx(-0.5)


def test_events_of_one_run_alone_have_no_shift() -> None:
    run = slide()
    other = replace(
        run, events=(Event(0.5, "rub", "slip"), *run.events, Event(3.0, "rub", "stick"))
    )
    shifts = compare([run, other]).shifts
    assert [(s.kind, s.first, s.other, s.shift) for s in shifts] == [
        ("slip", None, 0.5, None),
        ("stick", run.events[0].time, run.events[0].time, 0.0),
        ("stick", None, 3.0, None),
    ]
    assert [s.other for s in compare([other, run]).shifts] == [None, run.events[0].time, None]


def test_other_samples_are_compared_along_straight_lines() -> None:
    """The speed is straight but for the corner at 2 s, where both have a sample."""
    assert compare([slide(), slide(samples=81)]).differences[0].largest < 1e-9
    found = compare([slide(samples=81), slide()]).differences[0]
    assert found.largest < 1e-9
    late = slide()
    short = replace(late, time=late.time[:11], columns={"v": 2 * late["v"][:11]})
    assert compare([late, short], ["v"]).differences[0].largest == pytest.approx(3.0)


def test_nothing_over_no_range_is_nothing_and_something_infinite() -> None:
    run = slide()
    flat = replace(run, columns={**run.columns, "v": np.ones(41)})
    assert compare([flat, flat], ["v"]).differences[0].relative == 0
    assert compare([flat, run], ["v"]).differences[0].relative == float("inf")


def test_the_text_is_a_table_of_differences_and_of_events() -> None:
    lines = str(compare({"dry": slide(), "drier": slide(4.0)}, ["v"])).splitlines()
    assert lines[0].split() == ["against", "dry", "largest", "of", "range", "at"]
    assert lines[1].split() == ["v,", "drier", "0.75", "0.25", "1.5", "s"]
    assert lines[3].split() == ["events", "dry", "other", "later", "by"]
    assert lines[4].split() == ["rub:", "stick,", "drier", "2", "s", "1.5", "s", "-0.5", "s"]
    assert len(lines) == 5


def test_what_cannot_be_compared_is_refused() -> None:
    run = slide()
    with pytest.raises(bg.SignalError, match="1 runs; comparing needs two"):
        compare([run])
    with pytest.raises(bg.SignalError, match="no signal 'x'; there are v"):
        compare([run, run], ["x"])
    with pytest.raises(bg.SignalError, match="no signal 'P'"):
        compare([swing(), run], ["P"])
    with pytest.raises(bg.SignalError, match="must be a list of signals, not 'v'"):
        compare([run, run], "v")
    with pytest.raises(bg.SignalError, match="'2' has no time in common"):
        compare([run, replace(run, time=run.time + 10)])


def test_the_picture_has_a_panel_for_each_signal_and_a_curve_for_each_run() -> None:
    pytest.importorskip("matplotlib")
    runs = {"dry": slide(), "$$": slide(4.0)}
    upper, lower = compare(runs, ["v", "F_r"]).plot("Friction").axes
    assert upper.get_ylabel() == "$v$ [m/s]"
    assert lower.get_ylabel() == "$F_{r}$"
    curves = [line for line in upper.lines if line.get_gid() is None]
    for line, run in zip(curves, runs.values(), strict=True):
        assert (line.get_ydata() == run["v"]).all()
    assert [text.get_text() for text in upper.get_legend().get_texts()] == ["dry", r"\$\$"]
    marks = [line for line in lower.lines if line.get_gid() == "event"]
    assert sorted(line.get_xdata()[0] for line in marks) == pytest.approx([1.5, 2.0])
    owners = {round(line.get_xdata()[0], 3): line.get_color() for line in marks}
    assert owners == {2.0: curves[0].get_color(), 1.5: curves[1].get_color()}

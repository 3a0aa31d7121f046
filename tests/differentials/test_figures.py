"""The figures' panels and what is drawn in them."""

from pathlib import Path
from typing import Any

import pytest
from oracles.exported import model_of

import bondgraph as bg
import differentials
from codegen import Result
from differentials.figures import Figure, draw, figures, panels

#: Panels of Figs. 11, 13 and 14 as printed, top to bottom, by what they show.
PRINTED = {
    "fig11": [
        {"tau_h", "tau_e"}, {"tau_f"}, {"tau_hs1", "tau_hs2"}, {"omega_1", "omega_2", "omega_c"},
        {"omega_f"}, {"omega_t1", "omega_t2"},
    ],
    "fig13": [
        {"tau_h1", "tau_h2", "tau_e"}, {"tau_f1", "tau_f2"}, {"tau_hs1", "tau_hs2"},
        {"omega_1", "omega_2", "omega_c"}, {"omega_f1", "omega_f2"}, {"omega_t1", "omega_t2"},
    ],
    "fig14": [
        {"tau_h1", "tau_h2", "tau_e"}, {"tau_f1", "tau_f2"}, {f"tau_hs{j}" for j in range(1, 5)},
        {*(f"omega_{j}" for j in range(1, 5)), "omega_c"}, {"omega_f1", "omega_f2"},
        {f"omega_t{j}" for j in range(1, 5)},
    ],
}  # fmt: skip


@pytest.mark.parametrize("name", PRINTED)
def test_panels_are_the_papers(name: str) -> None:
    shown = [{curve.signal for curve in panel.curves} for panel in figures[name].panels]
    assert shown == PRINTED[name]


def test_fig12_has_four_stiffnesses_at_each_of_two_speeds() -> None:
    figure = figures["fig12"]
    assert len(figure.runs) == 8
    for panel, speed in zip(figure.panels, (20, 80), strict=True):
        runs = [figure.runs[curve.run][1] for curve in panel.curves]
        assert runs == [f"fig12_{speed}_{k}" for k in ("0.5", "1", "2", "5")]
        assert all((c.signal, c.minus) == ("tau_hs1", "tau_hs2") for c in panel.curves)


@pytest.mark.parametrize("name", differentials.catalog)
def test_every_differential_has_all_that_its_panels_show(name: str) -> None:
    chosen = differentials.catalog[name]
    full = model_of(name)
    known = {str(symbol) for symbol in full.equations.signals} | set(chosen.clutches.values())
    shown = {curve.signal for panel in panels(chosen) for curve in panel.curves}
    assert shown <= known


def _short() -> tuple[Figure, Result]:
    case = differentials.Scenario(80.0, -2.0, 350.0, (1000.0,), 0.01, 0.02, 0.05)
    return figures["fig11"], differentials.simulate("alsd", case)


def test_a_picture_is_the_same_bytes_every_time(tmp_path: Path) -> None:
    figure, result = _short()
    for name in ("one.png", "other.png"):
        draw(figure, (result,), tmp_path / name)
    one, other = ((tmp_path / name).read_bytes() for name in ("one.png", "other.png"))
    assert one == other
    assert one[:8] == b"\x89PNG\r\n\x1a\n"


def test_what_is_drawn_is_the_run_with_its_lock_marked(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    figure, result = _short()
    drawn: list[Any] = []
    monkeypatch.setattr(
        "matplotlib.figure.Figure.savefig", lambda self, *_, **__: drawn.append(self)
    )
    draw(figure, (result,), tmp_path / "nowhere.png")
    (picture,) = drawn
    for axis, panel in zip(picture.axes, figure.panels, strict=True):
        assert axis.get_ylabel() == panel.label
        lines = [line for line in axis.lines if line.get_gid() is None]
        for line, curve in zip(lines, panel.curves, strict=True):
            assert (line.get_ydata() == result[curve.signal]).all()
        assert len({(line.get_color(), line.get_linestyle()) for line in lines}) == len(lines)
        marks = [line.get_xdata()[0] for line in axis.lines if line.get_gid() == "event"]
        assert marks == [event.time for event in result.events]
    assert picture.get_suptitle() == "Response of the ALSD"


def test_without_matplotlib_the_extra_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    figure, result = _short()
    monkeypatch.setitem(__import__("sys").modules, "matplotlib.figure", None)
    with pytest.raises(bg.MissingExtraError, match=r"bondgraph-toolkit\[pictures\]"):
        draw(figure, (result,), tmp_path / "x.png")

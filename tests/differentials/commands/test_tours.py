"""The demo and the paper's figures."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result

import differentials
from differentials.commands import tours

Call = Callable[..., Result]


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures are empty files: `test_figures_draws_all_of_them` draws each."""
    monkeypatch.setattr(tours, "draw", lambda figure, results, path: Path(path).touch())


@pytest.mark.usefixtures("undrawn")
def test_the_demo_prints_what_it_found_and_writes_what_it_says(call: Call, tmp_path: Path) -> None:
    done = call("demo", "--out", str(tmp_path / "made here"))
    assert (done.exit_code, done.stderr) == (0, "")
    for part in (
        "dependent (derivative causality):   I_i",
        "[omega_1']",
        "[omega_f] = [ 1/2  -1/2 ]",
    ):
        assert part in done.stdout
    assert "t = 0.501222 s   clutch sticks" in done.stdout
    assert "t = 0.568431 s   clutch slips again" in done.stdout
    assert all(name in done.stdout for name in differentials.catalog)
    written = [
        Path(line.split(":  ")[-1].strip())
        for line in done.stdout.splitlines()
        if str(tmp_path) in line
    ]
    assert len(written) == 4
    assert all(path.exists() for path in written)
    data = np.genfromtxt(written[0], delimiter=",", names=True)
    assert len(data) == 1001
    assert abs(data["omega_f"][510:560]).max() < 1e-9


TABLES = {
    "fig11": {"fig11"},
    "fig12": {f"fig12_{speed}_{k}" for speed in (20, 80) for k in ("0.5", "1", "2", "5")},
    **{name: {name} for name in ("fig13", "fig13_superposition", "fig14")},
}


def test_figures_draws_all_of_them(call: Call, tmp_path: Path) -> None:
    assert call("figures", "--out", "out").exit_code == 0
    assert {path.name for path in (tmp_path / "out").iterdir()} == _files(*TABLES)
    for picture in (tmp_path / "out").glob("*.png"):
        assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


@pytest.mark.usefixtures("undrawn")
def test_figures_draws_those_asked_for(call: Call, tmp_path: Path) -> None:
    assert call("figures", "fig13", "fig12", "--out", "figs").exit_code == 0
    assert {path.name for path in (tmp_path / "figs").iterdir()} == _files("fig13", "fig12")
    assert call("figures", "fig11").exit_code == 0
    assert {path.name for path in (tmp_path / "out").iterdir()} == _files("fig11")


def _files(*names: str) -> set[str]:
    tables = {f"{table}.csv" for name in names for table in TABLES[name]}
    return tables | {f"{name}.png" for name in names}

"""The command line as a newcomer meets it."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import differentials
from differentials.__main__ import main


def command(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "differentials", *arguments],
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_demo_prints_what_it_found_and_writes_what_it_says(tmp_path: Path) -> None:
    done = command("demo", "--out", str(tmp_path / "made here"))
    assert (done.returncode, done.stderr) == (0, "")
    for part in ("dependent (derivative causality):   I_i", "A = ", "B = ", "F = [1/2  -1/2]"):
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


def test_list_names_every_differential_and_scenario(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list"]) == 0
    text = capsys.readouterr().out
    for name in (*differentials.catalog, *differentials.scenarios):
        assert name in text
    assert re.search(r"four_wheel_drive_tvd +4 or 12 +2 +fig14", text)


@pytest.mark.parametrize("name", differentials.catalog)
def test_show_gives_equations_causality_parameters_and_modes(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["show", name]) == 0
    text = capsys.readouterr().out
    states = differentials.equations(name).states
    assert f"x = [{', '.join(map(str, states))}]" in text
    assert differentials.catalog[name].title in text
    for part in ("A = ", "B = ", "dependent (derivative causality)", "kg m^2", "pole [1/s]"):
        assert part in text


def test_show_of_variants(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["show", "alsd", "--halfshafts", "--unlumped"]) == 0
    text = capsys.readouterr().out
    assert "tau_k1" in text
    assert "I_i, I_c" in text
    assert main(["show", "superposition_tvd"]) == 0
    assert "omega_f1 = 0 at" in (text := capsys.readouterr().out)
    assert "= 1.2857" in text


def test_simulate_writes_a_table_and_a_picture(tmp_path: Path) -> None:
    arguments = ["simulate", "alsd", "--scenario", "fig12_80_5", "--set", "k=4300", "--set", "b=2"]
    assert main([*arguments, "--out", str(tmp_path)]) == 0
    table, picture = (tmp_path / f"alsd_fig12_80_5.{end}" for end in ("csv", "png"))
    assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    data = np.genfromtxt(table, delimiter=",", names=True)
    expected = differentials.simulate("alsd", "fig12_80_5", {"k": 4300.0, "b": 2.0})
    assert data["tau_hs1"] == pytest.approx(expected["tau_hs1"], rel=1e-12)
    assert data["t"][-1] == 0.5


def test_simulate_takes_the_differentials_own_scenario(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["simulate", "passive_halfshafts", "--out", str(tmp_path)]) == 0
    assert "passive_halfshafts, engine_step" in capsys.readouterr().out
    assert (tmp_path / "passive_halfshafts_engine_step.csv").exists()


def test_figures_draws_those_asked_for(tmp_path: Path) -> None:
    assert main(["figures", "fig13", "fig12", "--out", str(tmp_path)]) == 0
    names = {path.name for path in tmp_path.iterdir()}
    tables = {f"fig12_{speed}_{k}.csv" for speed in (20, 80) for k in ("0.5", "1", "2", "5")}
    assert names == {"fig12.png", "fig13.png", "fig13.csv", *tables}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["show", "alds"], "no differential is called 'alds'; there is passive"),
        (["show", "passive_input_shaft", "--halfshafts"], "no model with halfshafts"),
        (["simulate", "alsd", "--scenario", "fig99"], "no scenario is called 'fig99'"),
        (["simulate", "alsd", "--scenario", "fig13"], "1 clutch(es); the scenario gives 2"),
        (["simulate", "alsd", "--set", "kk=1"], "no parameter 'kk'; there are I_1"),
        (["simulate", "alsd", "--set", "k=0"], "1/k"),
        (["simulate", "alsd", "--set", "k=nan"], "k"),
        (["simulate", "passive_halfshafts", "--backlash"], "no shaft that could have backlash"),
        (["figures", "fig10"], "no figure is called 'fig10'; there is fig11"),
    ],
)
def test_what_cannot_be_done_is_one_clear_line(
    arguments: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = [] if arguments[0] == "show" else ["--out", str(tmp_path)]
    assert main([*arguments, *out]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"python -m differentials {arguments[0]}: ")
    assert message in error
    assert len(error.splitlines()) == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "the following arguments are required: COMMAND"),
        (["dance"], "invalid choice: 'dance'"),
        (["simulate"], "the following arguments are required: NAME"),
        (["simulate", "alsd", "--set", "k"], "'k' is not NAME=NUMBER, as in k=4300"),
        (["simulate", "alsd", "--set", "k=stiff"], "'k=stiff' is not NAME=NUMBER"),
        (["list", "--loud"], "unrecognized arguments: --loud"),
    ],
)
def test_what_is_not_understood_is_one_clear_line(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as left:
        main(arguments)
    assert left.value.code == 2
    error = capsys.readouterr().err
    assert message in error
    assert "--help" in error
    assert len(error.splitlines()) == 1


def test_a_folder_that_cannot_be_made_is_one_clear_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    done = command("figures", "fig13", "--out", str(tmp_path / "file" / "deeper"))
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1


def test_help_tells_a_newcomer_what_to_type() -> None:
    text = command("--help").stdout
    for part in ("list", "show", "simulate", "figures", "demo", "examples:", "--set k=4300"):
        assert part in text
    assert "NAME=NUMBER" in command("simulate", "--help").stdout
    assert "fig13_superposition" in command("figures", "--help").stdout


def test_without_matplotlib_the_table_is_written_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    assert main(["simulate", "passive", "--out", str(tmp_path)]) == 0
    assert "bondgraph-toolkit[pictures]" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["passive_engine_step.csv"]

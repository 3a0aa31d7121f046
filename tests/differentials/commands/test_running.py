"""Runs of catalog and file: their events, tables and pictures."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import Result
from references.build import bond_graph

import bondgraph as bg
import differentials

Call = Callable[..., Result]

Data = Callable[..., Any]
OSCILLATOR = (
    "simulate",
    "examples/oscillator.json",
    "--set",
    "m=2",
    "--set",
    "k=800",
    "--set",
    "b=0",
)


def table(path: Path) -> Any:
    return np.genfromtxt(path, delimiter=",", names=True)


def test_simulate_writes_a_table_and_a_picture(call: Call, tmp_path: Path) -> None:
    arguments = ["simulate", "alsd", "--scenario", "fig12_80_5", "--set", "k=4300", "--set", "b=2"]
    assert call(*arguments, "--out", "made here").exit_code == 0
    written, picture = (tmp_path / "made here" / f"alsd_fig12_80_5.{end}" for end in ("csv", "png"))
    assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    data = table(written)
    expected = differentials.simulate("alsd", "fig12_80_5", {"k": 4300.0, "b": 2.0})
    assert data["tau_hs1"] == pytest.approx(expected["tau_hs1"], rel=1e-12)
    assert data["t"][-1] == 0.5


def test_the_differentials_own_scenario_is_taken(call: Call, tmp_path: Path) -> None:
    done = call("simulate", "passive_halfshafts", "-o", "run.csv")
    assert "passive_halfshafts, engine_step" in done.stdout
    assert done.stdout.endswith("run.csv\n")
    assert {path.name for path in tmp_path.iterdir()} == {"examples", "run.csv"}


def test_the_events_of_fig_11(data: Data, call: Call) -> None:
    """Locks at 0.50122 s, slips again at 0.56843 s."""
    found = data("simulate", "alsd", "--scenario", "fig11", "-o", "alsd.csv")
    assert [(e["port"], e["kind"]) for e in found["events"]] == [
        ("clutch", "stick"),
        ("clutch", "slip"),
    ]
    assert [e["time"] for e in found["events"]] == pytest.approx([0.50122, 0.56843], abs=5e-6)
    assert found["files"] == ["alsd.csv"]
    assert found["samples"] == 1001
    assert "t = 0.501222 s   clutch sticks" in call("simulate", "alsd", "-o", "alsd.csv").stdout


def test_inputs_starts_and_times_change_a_scenario(data: Data) -> None:
    """Without clutch and engine torque a car in steady motion goes on as it is."""
    found = data(
        "simulate", "alsd", "--input", "tau_e=0", "--input", "tau_h=0", "--initial", "omega_2=80",
        "--initial", "omega_t2=80", "--set", "omega_t2_0=80", "--until", "0.2", "--sample", "0.1",
        "-o", "run.csv",
    )  # fmt: skip
    assert (found["until"], found["samples"]) == (0.2, 3)
    assert found["final"]["omega_t1"] == pytest.approx(80, abs=1e-9)
    assert found["final"]["tau_hs1"] == pytest.approx(0, abs=1e-6)


def test_a_file_runs_as_the_textbook_says(call: Call, tmp_path: Path) -> None:
    """A step of force F on a mass m on a spring k: the spring's force is F (1 - cos w t)."""
    done = call(
        *OSCILLATOR,
        "--input",
        "F=step(0.1, 10)",
        "--until",
        "1",
        "--sample",
        "0.01",
        "-o",
        "run.csv",
    )
    assert done.exit_code == 0, done.output
    data = table(tmp_path / "run.csv")
    assert len(data) == 101
    after = np.maximum(data["t"] - 0.1, 0)
    assert data["F_k"] == pytest.approx(10 * (1 - np.cos(20 * after)), abs=1e-6)


def test_laws_close_ports_of_files(data: Data) -> None:
    """A force -m g holds the mass at the end of a slow ramp: the spring then carries m g."""
    found = data(
        "simulate", "examples/oscillator.json", "--set", "m=2", "--set", "k=800", "--set", "b=400",
        "--law", "force=-9.81*m", "--until", "30", "-o", "run.csv",
    )  # fmt: skip
    assert found["final"]["F_k"] == pytest.approx(-9.81 * 2, rel=1e-6)


def test_friction_over_a_port_on_a_spring_makes_the_spring_a_state(data: Data) -> None:
    """Stretched at 1 m/s from 1 N: it slips at 2 N after 0.1 m."""
    nodes = [
        bg.Sf("speed", "v"),
        bg.Zero("z"),
        bg.C("k", "1/k", effort="F"),
        bg.R("slider", flow="s"),
    ]
    bg.write_json(bond_graph(nodes, "speed>z>k z>slider"), "jenkins.json")
    found = data("simulate", "jenkins.json", "--set", "k=10", "--law", "slider=friction(2)", "--input",
                 "v=1", "--initial", "F=1", "--until", "1", "-o", "run.csv")  # fmt: skip
    assert (found["final"]["F"], found["final"]["s"]) == pytest.approx((2.0, 1.0), abs=1e-9)
    assert [round(event["time"], 9) for event in found["events"]] == [0.1]


def test_a_file_begins_where_it_rests(call: Call, data: Data) -> None:
    """A weight of 8 on a spring of 800: 0.01 below, where no step of the input disturbs it."""
    found = data(*OSCILLATOR, "--equilibrium", "--input", "F=8")
    assert found["final"]["v"] == pytest.approx(0, abs=1e-9)
    assert found["final"]["F_k"] == pytest.approx(8, abs=1e-9)
    refused = call(*OSCILLATOR, "--equilibrium", "--initial", "v=1", "--input", "F=8")
    assert refused.exit_code != 0
    assert "leave --initial out" in refused.output


def test_a_file_is_drawn_too(call: Call, tmp_path: Path) -> None:
    assert call(*OSCILLATOR, "--initial", "v=1", "--input", "F=0").exit_code == 0
    assert (tmp_path / "out" / "oscillator_run.png").read_bytes().startswith(b"\x89PNG")
    assert len(table(tmp_path / "out" / "oscillator_run.csv")) == 1001


def test_switches_run_from_mode_to_mode(data: Data) -> None:
    """The diode conducts until the load takes less than the capacitor gives back, then blocks."""
    found = data(
        "simulate", "examples/rectifier.json", "--set", "R_s=1", "--set", "C=1e-3", "--set", "R_l=100",
        "--input", "u=sine(10, 50)", "--until", "0.03", "--sample", "1e-4", "-o", "run.csv",
    )  # fmt: skip
    assert [e["kind"] for e in found["events"]] == ["off", "on", "off"]
    assert 0.005 < found["events"][0]["time"] < 0.01
    assert 0.02 < found["events"][1]["time"] < 0.025


def test_netcdf_is_written(call: Call, tmp_path: Path) -> None:
    assert call("simulate", "passive", "-o", "run.nc").exit_code == 0
    assert (tmp_path / "run.nc").stat().st_size > 0


def test_without_matplotlib_the_table_is_written_all_the_same(
    call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    done = call("simulate", "passive")
    assert done.exit_code == 0
    assert "bondgraph-toolkit[pictures]" in done.stderr
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["passive_engine_step.csv"]


def test_a_streamed_run_has_the_bytes_of_one_that_is_written(call: Call, tmp_path: Path) -> None:
    run = ["simulate", "alsd", "--sample", "1e-4"]
    assert call(*run, "-o", "run.csv").exit_code == 0
    done = call(*run, "-o", "made/streamed.csv", "--stream")
    assert done.exit_code == 0
    assert (tmp_path / "made" / "streamed.csv").read_bytes() == (tmp_path / "run.csv").read_bytes()
    assert "10001 samples, 2 events" in done.stdout
    events = (tmp_path / "made" / "streamed.events.csv").read_text().splitlines()
    assert [line.split(",")[1:3] for line in events[1:]] == [
        ["clutch", "stick"],
        ["clutch", "slip"],
    ]


def test_a_streamed_run_as_data(data: Data, tmp_path: Path) -> None:
    found = data("simulate", "alsd", "-o", "run.csv", "--stream", "--signal", "tau_f")
    assert (found["samples"], found["events"]) == (1001, 2)
    assert found["files"] == ["run.csv", "run.events.csv"]
    assert (tmp_path / "run.csv").read_text().startswith("t,tau_f\n")
    assert "omega_1" in found["final"]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--signal", "tau_f"], "--signal goes with --stream"),
        (["--stream"], r"--stream needs -o FILE, which ends in .csv or .parquet"),
        (["--stream", "-o", "run.mat"], "--stream needs -o FILE"),
        (["--stream", "-o", "run.csv", "--signal", "tau_g"], "did you mean 'tau_"),
    ],
)
def test_what_does_not_stream_is_refused(
    arguments: list[str], told: str, call: Call, tmp_path: Path
) -> None:
    done = call("simulate", "alsd", *arguments)
    assert done.exit_code == 2
    assert told in done.stderr
    assert [one.name for one in tmp_path.iterdir()] == ["examples"]


def test_a_streamed_run_that_ends_halfway_tells_what_is_left(call: Call, tmp_path: Path) -> None:
    level = ["--law", "clutch=friction(tau_h*(1-2*t))", "--sample", "5e-5"]
    done = call("simulate", "alsd", *level, "-o", "run.csv", "--stream")
    assert done.exit_code == 2
    assert "what was written before that is in" in done.stderr
    assert "run.partial.csv" in done.stderr
    assert not (tmp_path / "run.csv").exists()
    rows = table(tmp_path / "run.partial.csv")
    assert len(rows) >= 4096
    assert rows["t"][-1] < 0.5

"""Units of somebody else, written by hand in C, against the closed form of what they do."""

import gc
import math
import tempfile
from pathlib import Path

import fmpy
import fmpy.validation
import numpy as np
import pytest
from oracles.lag_units import KIND, VARIABLE, lag_unit

import bondgraph as bg
import codegen
from bondgraph.errors import SignalError, UnitError

VERSIONS = pytest.mark.parametrize("version", ["2.0", "3.0"])

A, B = {"T": 0.2, "k": 1.5}, {"T": 0.5, "k": 2.0}


@pytest.fixture(autouse=True)
def _room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Whatever is unpacked is gone again, and no library of it is still loaded."""
    room = tmp_path / "room"
    room.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(room))
    yield room
    assert list(room.iterdir()) == []
    assert str(room) not in Path("/proc/self/maps").read_text()


def _lag(u: list[float], h: float, about: dict[str, float]) -> list[float]:
    """y under inputs that are held."""
    found = [0.0]
    for value in u[:-1]:
        gain = 1 - math.exp(-h / about["T"])
        found.append(found[-1] + (about["k"] * value - found[-1]) * gain)
    return found


def _chain(path: Path, **more: object) -> codegen.CoSimulation:
    return codegen.cosimulate(
        {"first": path, "second": str(path)}, {"first.y": "second.u"}, end=2, every=0.1,
        inputs={"first.u": codegen.Sine(1, 1)}, initial={"first": A, "second": B}, **more,
    )  # fmt: skip


@VERSIONS
def test_a_chain_of_two_units_is_what_it_is_by_hand(version: str, tmp_path: Path) -> None:
    run = _chain(lag_unit(tmp_path / "unit", version))
    u = [math.sin(2 * math.pi * k / 10) for k in range(21)]
    first = _lag(u, 0.1, A)
    assert np.abs(run["first.u"] - u).max() < 1e-12
    assert np.abs(run["first.y"] - first).max() < 1e-12
    assert np.abs(run["second.y"] - _lag(first, 0.1, B)).max() < 1e-12
    assert run["second.u"].tolist() == run["first.y"].tolist()
    assert run["first.steps"].tolist() == list(range(21))
    assert run["second.high"].tolist() == (run["second.y"] > 0.5).astype(float).tolist()
    assert "first.label" not in run.columns
    assert run.units == {"first.u": "N", "first.y": "m/s", "second.u": "N", "second.y": "m/s"}


@VERSIONS
def test_in_turn_the_second_has_what_the_first_has_come_to(version: str, tmp_path: Path) -> None:
    run = _chain(lag_unit(tmp_path / "unit", version), order=["first", "second"])
    first = _lag([math.sin(2 * math.pi * k / 10) for k in range(21)], 0.1, A)
    assert np.abs(run["second.y"] - _lag([*first[1:], 0.0], 0.1, B)).max() < 1e-12


@VERSIONS
def test_a_unit_beside_a_model(version: str, tmp_path: Path) -> None:
    """A mass that a lagging engine pulls and air slows: two recursions by hand."""
    graph = bg.graph(
        [bg.Se("pull", "F"), bg.One("cart"), bg.I("m", 2, flow="v"), bg.R("air", "c")],
        "pull > cart > m, cart > air",
    )
    cart = codegen.simulator(bg.derive(graph), {"c": 0.5})
    run = codegen.cosimulate(
        {"engine": lag_unit(tmp_path / "unit", version), "cart": cart},
        {"engine.y": ["cart.F"], "cart.v": ["engine.u"]},
        end="3/2", every=0.05, initial={"engine": {"T": 0.2, "k": -3.0}, "cart": {"v": 4.0}},
    )  # fmt: skip
    y, v = [0.0], [4.0]
    for _ in range(30):
        force, speed = y[-1], v[-1]
        y.append(force + (-3.0 * speed - force) * (1 - math.exp(-0.05 / 0.2)))
        v.append(force / 0.5 + (speed - force / 0.5) * math.exp(-0.5 * 0.05 / 2))
    assert np.abs(run["cart.v"] - v).max() < 1e-9
    assert np.abs(run["engine.y"] - y).max() < 1e-9
    assert run["cart.f_pull"].tolist() == run["cart.v"].tolist()


def test_a_unit_of_fmi_2_follows_lines_where_it_says_so(tmp_path: Path) -> None:
    """A ramp through a clock-like unit: after the first interval the line is the ramp itself."""
    kind = KIND.format(more=f'{VARIABLE} canInterpolateInputs="true"')
    path = lag_unit(tmp_path / "unit", "2.0", kind)
    ramp = bg.graph([bg.State("r", 3.0)])
    run = codegen.cosimulate(
        {"lag": path, "ramp": codegen.simulator(bg.derive(ramp), {})}, {"ramp.r": "lag.u"},
        end=1, every=0.1, linear=["lag.u"], initial={"lag": A},
    )  # fmt: skip
    y = [0.0, 0.0]
    for k in range(1, 10):
        u, a = 0.3 * k, math.exp(-0.1 / 0.2)
        lead = 1.5 * (u - 3.0 * 0.2)
        y.append(lead + 1.5 * 0.3 + (y[-1] - lead) * a)
    assert np.abs(run["lag.y"] - y).max() < 1e-9
    plain = lag_unit(tmp_path / "plain", "2.0")
    with pytest.raises(SignalError, match="the unit holds its inputs"):
        codegen.cosimulate(
            {"lag": plain, "ramp": codegen.simulator(bg.derive(ramp), {})},
            {"ramp.r": "lag.u"}, end=1, every=0.1, linear=["lag.u"],
        )  # fmt: skip


@VERSIONS
def test_an_error_of_a_unit_shows_its_log(version: str, tmp_path: Path) -> None:
    path = lag_unit(tmp_path / "unit", version)
    late = codegen.Step(0.5, 2000.0)
    with pytest.raises(
        UnitError, match=r"'bad': fmi.DoStep returned 'error'; its log: u = 2000 is out of"
    ):
        codegen.cosimulate(
            {"good": path, "bad": path}, {}, end=1, every=0.1, inputs={"bad.u": late}
        )


@VERSIONS
def test_fmpy_takes_the_units_too_and_hears_their_log_afterwards(
    version: str,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What listened here is gone, and what fmpy listens by is as it was."""
    path = lag_unit(tmp_path / "unit", version)
    test_an_error_of_a_unit_shows_its_log(version, tmp_path)
    gc.collect()
    assert fmpy.validation.validate_fmu(str(path)) == []
    # After an error fmpy leaves behind what it unpacked.
    theirs = tmp_path / "theirs"
    theirs.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(theirs))
    with pytest.raises(fmpy.fmi1.FMICallException):
        fmpy.simulate_fmu(str(path), start_values={"u": 4000.0})
    assert "u = 4000 is out of range" in capfd.readouterr().out


def test_a_unit_that_ends_the_run(tmp_path: Path) -> None:
    path = lag_unit(tmp_path / "unit", "3.0")
    with pytest.raises(UnitError, match="it ends the run"):
        codegen.cosimulate({"unit": path}, {}, end=1, every=0.1, inputs={"unit.u": 999})


@VERSIONS
def test_steps_that_a_unit_does_not_take(version: str, tmp_path: Path) -> None:
    path = lag_unit(tmp_path / "unit", version, discards=True)
    assert len(codegen.cosimulate({"unit": path}, {}, end=1, every=0.1).time) == 11
    with pytest.raises(UnitError, match="does not take this communication step"):
        codegen.cosimulate({"unit": path}, {}, end=1, every=0.2)


def test_an_interval_is_a_whole_number_of_fixed_steps(tmp_path: Path) -> None:
    path = lag_unit(tmp_path / "unit", "3.0", KIND.format(more='fixedInternalStepSize="0.1"'))
    assert len(codegen.cosimulate({"unit": path}, {}, end=0.6, every=0.3).time) == 3
    with pytest.raises(UnitError, match=r"steps of 1/10 s.*take every=0\.3"):
        codegen.cosimulate({"unit": path}, {}, end=1, every=0.25)


@VERSIONS
def test_types_of_variables(version: str, tmp_path: Path) -> None:
    path = lag_unit(tmp_path / "unit", version)
    run = codegen.cosimulate({"unit": path}, {}, 0.1, 0.1, initial={"unit": {"steps": 4}})
    assert run["unit.steps"].tolist() == [4.0, 5.0]
    for value, match in ((0.5, "whole numbers"), (math.nan, "finite number"), ("a", "finite")):
        with pytest.raises(SignalError, match=match):
            codegen.cosimulate({"unit": path}, {}, 0.1, 0.1, initial={"unit": {"steps": value}})
    with pytest.raises(SignalError, match="a truth value"):
        codegen.cosimulate({"unit": path}, {}, 0.1, 0.1, initial={"unit": {"high": 2}})
    with pytest.raises(SignalError, match=r"no variable 'stepps'.*did you mean 'steps'"):
        codegen.cosimulate({"unit": path}, {}, 0.1, 0.1, initial={"unit": {"stepps": 1}})


@VERSIONS
def test_what_passes_through_a_unit_is_late_but_for_the_start(version: str, tmp_path: Path) -> None:
    """y = 2 u + 1: at the start by the u that is there, later by that of the step before."""
    gain = bg.derive(bg.graph([bg.Function("y", "2*u + 1")]))
    path = codegen.write_fmu(tmp_path / "gain.fmu", gain, {}, version=version)
    clock = codegen.simulator(bg.derive(bg.graph([bg.State("s", 1.0, start=3)])), {})
    run = codegen.cosimulate({"gain": path, "clock": clock}, {"clock.s": "gain.u"}, 1, 0.25)
    assert run["gain.u"].round(9).tolist() == [3.0, 3.25, 3.5, 3.75, 4.0]
    echo = codegen.simulator(bg.derive(bg.graph([bg.Function("x", "v + 0*t")])), {})
    parts = {"gain": path, "clock": clock, "echo": echo}
    run = codegen.cosimulate(parts, {"clock.s": "gain.u", "gain.y": "echo.v"}, 1, 0.25)
    assert run["gain.y"].round(9).tolist() == [7.0, 7.0, 7.5, 8.0, 8.5]
    assert run["echo.x"].tolist() == run["gain.y"].tolist()


@VERSIONS
def test_a_loop_through_a_unit_at_the_start_is_refused(version: str, tmp_path: Path) -> None:
    gain = bg.derive(bg.graph([bg.Function("y", "u/2 + 1")]))
    path = codegen.write_fmu(tmp_path / "gain.fmu", gain, {}, version=version)
    echo = codegen.simulator(bg.derive(bg.graph([bg.Function("x", "v + 1")])), {})
    with pytest.raises(
        bg.SimulationError, match=r"t = 0\.0 s the signals between .* do not settle"
    ):
        codegen.cosimulate({"a": path, "b": echo}, {"a.y": "b.v", "b.x": "a.u"}, 1, 0.25)


def test_units_that_cannot_take_part(tmp_path: Path) -> None:
    exchange = lag_unit(tmp_path / "a", "2.0", '<ModelExchange modelIdentifier="lag"/>')
    elsewhere = lag_unit(tmp_path / "b", "3.0", platform="riscv-templeos")
    broken = tmp_path / "broken.fmu"
    broken.write_bytes(exchange.read_bytes()[:-30])
    for path, match in (
        (exchange, "is not for co-simulation"),
        (elsewhere, "no library for this platform.*it has riscv-templeos"),
        (broken, "no archive"),
        (tmp_path / "nowhere.fmu", "no such file"),
    ):
        with pytest.raises(UnitError, match=match):
            codegen.cosimulate({"unit": path}, {}, end=1, every=0.1)


def test_a_unit_that_a_process_may_have_once(tmp_path: Path) -> None:
    kind = KIND.format(more=f'{VARIABLE} canBeInstantiatedOnlyOncePerProcess="true"')
    path = lag_unit(tmp_path / "unit", "2.0", kind)
    assert len(codegen.cosimulate({"a": path}, {}, end=1, every=0.5).time) == 3
    with pytest.raises(UnitError, match=r"'a' and 'b'.*once in a process"):
        codegen.cosimulate({"a": path, "b": path}, {}, end=1, every=0.5)


def test_without_fmpy(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(__import__("sys").modules, "fmpy", None)
    with pytest.raises(bg.MissingExtraError, match=r"bondgraph-toolkit\[fmu\]"):
        codegen.cosimulate({"unit": tmp_path / "some.fmu"}, {}, end=1, every=0.1)


@VERSIONS
def test_connections_that_a_unit_has_not(version: str, tmp_path: Path) -> None:
    path = lag_unit(tmp_path / "unit", version)
    parts = {"a": path, "b": path}
    for wires, match in (
        ({"a.k": "b.u"}, "is a parameter"),
        ({"a.u": "b.u"}, "is an input"),
        ({"a.step": "b.u"}, "'a' has no output of one number 'step'.*did you mean 'steps'"),
        ({"a.y": "b.y"}, "'b' has no input 'y'"),
        ({"a.y": "b.k"}, "'b' has no input 'k'"),
    ):
        with pytest.raises(SignalError, match=match):
            codegen.cosimulate(parts, wires, end=1, every=0.1)
    run = codegen.cosimulate(parts, {}, end=1, every=0.5)
    with pytest.raises(SignalError, match="'a' is a unit"):
        run.of("a")

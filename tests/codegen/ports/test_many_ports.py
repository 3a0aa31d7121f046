"""Many ports that are held or let go: no table of sets or modes limits them, on any route."""

import subprocess
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from oracles.c_model import closer, compiled, written
from oracles.exported import loaded
from oracles.many import Many, bridge, chain, gearbox, stack

import bondgraph as bg
from codegen import (
    Family,
    Result,
    Simulator,
    Swept,
    event_count,
    samples,
    simulator,
    to_c,
    to_python,
    write_fmu,
)
from codegen.batch.exact import ExactLoop
from codegen.engine.places import FEWEST, Places
from codegen.engine.sizes import Engine
from codegen.standalone.ranks import SlipRows, held_set
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import batch_of

Made = tuple[Many, bg.StateEquations]


@cache
def made(kind: Callable[..., Many], *size: int) -> Made:
    """A case and its equations, derived once for all tests."""
    case = kind(*size)
    return case, bg.derive(case.graph)


@cache
def ready(backend: str, kind: Callable[..., Many], *size: int) -> Simulator:
    return simulator(made(kind, *size)[1], {}, backend=backend)


@cache
def run(method: str, backend: str, kind: Callable[..., Many], *size: int) -> Result:
    """A run, in C without a word that numpy has done it."""
    case = made(kind, *size)[0]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return ready(backend, kind, *size).run(case.times, {}, case.inputs, method, 1e-10, 1e-11)


def _agree(case: Many, found: Result, expected: Result, tolerance: float) -> None:
    assert [(e.port, e.kind) for e in found.events] == [(e.port, e.kind) for e in expected.events]
    for name in case.shown:
        range_ = np.ptp(expected[name]) + 1e-9
        assert np.abs(found[name] - expected[name]).max() <= tolerance * range_, name


def test_a_chain_of_forty_blocks_steps_exactly_in_c_as_in_numpy() -> None:
    case, _ = made(chain, 40)
    expected = run("auto", "numpy", chain, 40)
    assert len(expected.events) > 40
    _agree(case, run("auto", "c", chain, 40), expected, 1e-9)


def test_modes_that_find_no_room_are_worked_out_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A chain of a hundred blocks has more than half a gigabyte of modes; here is room for sixteen."""
    (case, equations), places = made(chain, 12), []

    def few(self: Places, engine: Engine, record: object) -> None:
        start(self, engine, record, FEWEST * engine.ffi.sizeof("ex_mode"))
        places.append(self)

    expected = run("auto", "c", chain, 12)
    start = Places.__init__
    monkeypatch.setattr(Places, "__init__", few)
    cramped = simulator(equations, {}, backend="c")
    for _ in range(2):
        found = cramped.run(case.times, {}, case.inputs, "exact")
        assert found.backend == "c"
        assert found.events == expected.events
        for name in case.shown:
            assert np.array_equal(found[name], expected[name])
            assert np.array_equal(found[f"f_b{name[1:]}"], expected[f"f_b{name[1:]}"])
    (few_places,) = places
    assert few_places.kept <= few_places.most == FEWEST < len(few_places.known)


@pytest.mark.parametrize("kind", [(bridge, 12), (gearbox,)], ids=["24 diodes", "12 clutches"])
def test_a_bridge_and_a_gearbox_are_located_in_c_as_in_numpy(kind: tuple) -> None:
    """Ports that share a load make modes that are not affine: events are located then."""
    case, _ = made(*kind)
    expected = run("auto", "numpy", *kind)
    assert len(expected.events) > 60
    _agree(case, run("auto", "c", *kind), expected, 1e-8)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_implicit_steps_of_a_gearbox_leave_rest_as_explicit_ones(backend: str) -> None:
    """Where it breaks loose its slips rise from zero as t^2: none of them dips to zero.

    In two seconds ports do so at eight instants, of ten in four.
    """
    case, _ = made(gearbox)
    times = case.times[case.times <= 2]
    found, expected = (
        ready(which, gearbox).run(times, {}, case.inputs, method)
        for which, method in ((backend, "Radau"), ("c", "DOP853"))
    )
    assert found.backend == backend
    assert {event.kind for event in found.events} == {"slip", "stick", "cross"}
    _agree(case, found, expected, 1e-8)


def test_blocks_that_all_touch_are_pivoted_the_same_way_in_c() -> None:
    """Twelve ports in one block, more than are enumerated."""
    case, _ = made(stack, 12)
    expected = run("auto", "numpy", stack, 12)
    assert len({event.port for event in expected.events}) == 12
    _agree(case, run("auto", "c", stack, 12), expected, 1e-9)


def test_currents_and_voltages_of_a_bridge_are_those_of_diodes() -> None:
    """Each diode either carries or blocks, and at every node currents add up to zero."""
    found = run("auto", "c", bridge, 12)
    upper, lower = ([f"{side}{k}" for k in range(12)] for side in "ul")
    for name in (*upper, *lower):
        current, voltage = found[f"f_{name}"], found[f"e_{name}"]
        assert current.min() >= -1e-9
        assert voltage.max() <= 1e-9
        assert np.abs(current * voltage).max() <= 1e-9
    for side in (upper, lower):
        assert sum(found[f"f_{name}"] for name in side) == pytest.approx(found["i"], abs=1e-9)
    assert found["i"].max() > 8
    # Of what a coil carries a resistance of 50 to the star's middle takes its part, as its node is driven.
    for k in range(12):
        into = found[f"i{k}"] - found[f"f_u{k}"] + found[f"f_l{k}"]
        assert np.abs(into).max() < 10.0 / 50 + 1e-9


def test_a_sweep_of_a_chain_is_run_in_c() -> None:
    case, equations = made(chain, 12)
    family = Family(equations, {}, backend="c")
    measures = {"w0": samples("w0"), "slips": event_count("b3", "slip")}
    inputs = {"P": Swept("size", case.inputs["P"])}
    loop = batch_of(Job(family, ("size",), case.times, measures, None, inputs))
    assert loop is not None
    assert isinstance(loop.loop, ExactLoop)
    (speeds, counts), left = loop([[0.9], [1.0]])
    assert left == []
    expected = run("auto", "numpy", chain, 12)
    assert np.abs(speeds[1] - expected["w0"]).max() <= 1e-9 * np.ptp(expected["w0"])
    assert counts[1] == sum(e.port == "b3" and e.kind == "slip" for e in expected.events)


def test_runs_that_exact_steps_cannot_do_are_located_in_the_same_sweep() -> None:
    case, equations = made(gearbox)
    family = Family(equations, {}, backend="c")
    inputs = {**case.inputs, "T": Swept("size", case.inputs["T"])}
    job = Job(family, ("size",), case.times, {"w": samples("w_a")}, None, inputs)
    loop = batch_of(job)
    assert loop is not None
    (speeds,), left = loop([[1.0]])
    assert left == []
    expected = run("auto", "numpy", gearbox)
    assert np.abs(speeds[0] - expected["w_a"]).max() <= 1e-8 * np.ptp(expected["w_a"])


def test_exports_of_a_gearbox_step_alike_and_locate_its_events(tmp_path: Path) -> None:
    """Python and C in the same fixed steps; C as the simulator where events are located."""
    (case, equations), expected = made(gearbox), run("auto", "numpy", gearbox)
    step, end = 5e-3, 1.5
    times = np.arange(0, end + step / 2, 10 * step)
    module = loaded(to_python(equations, {}, inputs=case.inputs))
    stepped = module.simulate(times, {}, dict(case.inputs), step=step)
    sources = written(tmp_path, to_c(equations, {}, main=True, inputs=case.inputs))
    program = str(compiled(tmp_path, sources, "-O0"))
    fixed = _columns([program, repr(end), repr(step)])
    located = _columns([program, "4", "0.05", "located"])
    for name in case.shown:
        size = np.ptp(stepped[name])
        at_times = np.interp(times, fixed["t"], fixed[name])
        assert np.abs(at_times - stepped[name]).max() <= 1e-9 * size, name
        error = np.interp(case.times, located["t"], located[name]) - expected[name]
        assert np.abs(error).max() <= 1e-8 * np.ptp(expected[name]), name


def test_forty_ports_go_into_exported_c_and_a_unit(tmp_path: Path) -> None:
    """Both locate the chain's events as the simulator does."""
    (case, equations), expected = made(chain, 40), run("auto", "numpy", chain, 40)
    files = closer(to_c(equations, {}, main=True, inputs=case.inputs))
    sources = written(tmp_path, files)
    located = _columns([str(compiled(tmp_path, sources, "-O0")), "3", "0.05", "located"])
    unit = write_fmu(tmp_path / "chain.fmu", equations, {}, version="3.0", inputs=case.inputs)
    stepped = simulate_fmu(
        str(unit),
        fmi_type="CoSimulation",
        stop_time=3.0,
        output=list(case.shown),
        output_interval=0.05,
    )
    # The unit keeps to the tolerances that it was written with.
    for found, bound in ((located, 1e-8), (stepped, 1e-7)):
        for name in case.shown:
            off = np.abs(found[name] - expected[name]).max()
            assert off <= bound * (np.ptp(expected[name]) + 1e-9), name


def _columns(command: list[str]) -> dict[str, np.ndarray]:
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    head, *lines = done.stdout.splitlines()
    values = np.array([[float(one) for one in line.split(",")] for line in lines])
    return dict(zip(head.split(","), values.T, strict=True))


def test_ranks_are_those_of_the_numbers() -> None:
    """Rows of small integers; singular values tell their ranks as well."""
    rng = np.random.default_rng(7)
    for _ in range(30):
        ports, states, inputs = 6, 4, 9
        F = rng.integers(-1, 2, (ports, states)) * rng.integers(0, 2, (ports, 1))
        D = np.zeros((ports, inputs), dtype=int)
        D[:, :ports] = np.diag(rng.integers(0, 2, ports))
        D[:, ports:] = rng.integers(-1, 2, (ports, inputs - ports))
        F[-1], D[-1] = F[0] + F[1], D[0] + D[1]
        prime = 2**61 - 1
        rows = [
            [{j: int(v) % prime for j, v in enumerate(row) if v} for row in matrix]
            for matrix in (F, D)
        ]
        held = held_set(SlipRows(rows[0], rows[1], range(ports), [()] * ports, prime), range(ports))
        square = D[:, :ports]
        assert len(held.direct) == np.linalg.matrix_rank(square)
        both = np.linalg.matrix_rank(np.hstack([square, F]))
        whole = np.linalg.matrix_rank(np.hstack([square, F, D]))
        assert len(held.direct) + len(held.kept) == both
        assert held.ruled == (whole > both)


def test_the_longest_stable_step_of_many_ports_is_of_those_that_bind_most() -> None:
    """A chain is fastest with all blocks let go, near ``w**2 = 4 k/m``: holding slows it."""
    text = to_c(bg.derive(chain(9).graph), {}, main=True)["config.h"]
    told = float(text.split("#define BG_LONGEST_STEP ")[1].split()[0])
    masses, stiffness = 1 + 0.01 * np.arange(9), 50.0
    springs = np.diff(np.eye(9), axis=0)
    rates = np.linalg.eigvalsh(stiffness * springs.T @ springs / np.sqrt(np.outer(masses, masses)))
    assert told == pytest.approx(2 * np.sqrt(2) / np.sqrt(rates.max()), rel=1e-5)

"""Steps for real time: their order, rest, and what they cost, on three models; and when they tell."""

import ctypes
import re
import warnings
from collections.abc import Callable
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import compiled, written
from oracles.exported import loaded
from oracles.realtime import (
    Exported,
    RealTime,
    alsd,
    conducting_bridge,
    gearbox,
    operations,
    six_pulse,
    slipping_gearbox,
)
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, to_c, to_python
from codegen.engine.status import Status
from codegen.fixed.boxes import Boxed

CASES = {"alsd": alsd, "gearbox": gearbox, "six-pulse": six_pulse}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Exported]:
    """A model as C, compiled once for all tests."""

    @cache
    def compiled_model(name: str, integrator: str = "rk4") -> Exported:
        return Exported(CASES[name](), tmp_path_factory.mktemp("step"), integrator)

    return compiled_model


@pytest.fixture(params=CASES)
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def exported(name: str, made: Callable[..., Exported]) -> Exported:
    return made(name)


STEPS = {"alsd": (1e-3, 1e-4), "gearbox": (2e-3, 1e-4), "six-pulse": (5e-4, 1e-4)}
"""Long and short steps [s]; the bridge's fastest rate is 2,500/s, so that 2 ms is beyond stability."""


def test_across_changes_errors_fall_with_the_step_at_least(name: str, exported: Exported) -> None:
    """Largest difference at any sample of any state from the run with located events, over its range."""
    long, short = STEPS[name]
    rough, fine = exported.error(long), exported.error(short)
    assert np.log(rough / fine) / np.log(long / short) > 1.0
    assert fine < 2e-3


SMOOTH = {"alsd": alsd, "gearbox": slipping_gearbox, "six-pulse": conducting_bridge}


@pytest.mark.parametrize("integrator", ["rk4", "rosenbrock"])
@pytest.mark.parametrize("name", SMOOTH)
def test_where_nothing_changes_steps_are_of_order_four(
    name: str, integrator: str, tmp_path: Path
) -> None:
    """By three halvings (Richardson), at the end of a stretch without events."""
    case = SMOOTH[name]()
    model = Exported(case, tmp_path, integrator)
    h = {"alsd": 5e-4, "gearbox": 4e-3, "six-pulse": 5e-4}[name]
    h *= 6 if (name, integrator) == ("six-pulse", "rosenbrock") else 1
    ends = []
    for parts in (1, 2, 4):
        found = model.march(h / parts, case.smooth - (0.1 if name == "alsd" else 0.0))
        assert found.taken == len(found.costs)
        assert len(np.unique(found.modes, axis=0)) == 1
        ends.append(found.rows[-1])
    first, second = (np.abs(a - b).max() for a, b in pairwise(ends))
    assert 3.5 < np.log2(first / second) < 5.0


def test_all_steps_of_a_model_cost_the_same_within_a_factor_of_three(exported: Exported) -> None:
    """In basic blocks run through, the first step included, through all that happens in the run."""
    for h in (5e-4, 1e-4):
        found = exported.march(h, exported.case.end)
        assert found.taken == len(found.costs)
        assert len(np.unique(found.modes, axis=0)) > 1
        assert found.costs.max() < 3 * found.costs.min()


RESTS = {
    "alsd": ({"tau_h": 3000.0}, "tau_e", 5.0),
    "gearbox": ({f"N_{one}": 300.0 for one in ("K1", "K2", "G1", "G2", "G3", "G4", "GR")}, "T", 20.0),
    "six-pulse": ({}, "U0", 0.0),
}  # fmt: skip
"""What holds: inputs, and one that swings by so much."""

COUNT = 20_000


@pytest.mark.parametrize("name", ["gearbox", "six-pulse"])
def test_at_rest_nothing_chatters_or_creeps(name: str, made: Callable[..., Exported]) -> None:
    """All clutches locked, the engine pushes to and fro; a bridge without voltage."""
    w, swings, by = RESTS[name]
    changes, far, _ = made(name).rest(1e-3, COUNT, w, swings, by)
    assert (changes, far) == (0, pytest.approx(0.0, abs=1e-12))


@pytest.mark.parametrize("h", [1e-4, 2e-3])
def test_a_locked_differential_stays_locked(h: float, made: Callable[..., Exported]) -> None:
    """Whose wheels go on together, while its shafts wind up and down: it sticks at once, for good."""
    w, swings, by = RESTS["alsd"]
    changes, _, last = made("alsd").rest(h, COUNT, w, swings, by)
    assert changes == 0
    assert last["omega_1"] == pytest.approx(last["omega_2"], rel=1e-14)


def _block(level: object = "N") -> bg.StateEquations:
    """A mass that a force pushes, on the ground."""
    nodes = [
        bg.Se("P", "F"),
        bg.One("v"),
        bg.I("m", 2.0, flow="w"),
        bg.R("ground", law=bg.DryFriction(level)),
    ]
    return bg.derive(bond_graph(nodes, "P>v>m v>ground"))


def test_a_stuck_block_stands_still_over_a_million_steps(tmp_path: Path) -> None:
    """It comes to rest from 1 m/s first."""
    w = {"F": Constant(0.0), "N": Constant(10.0)}
    model = Exported(RealTime(_block(), {}, None, {"w": 0.01}, w, 1.0, 0.0), tmp_path)
    changes, far, _ = model.rest(1e-3, 1_000_000, {"N": 10.0}, "F", 9.9)
    assert changes == 1
    assert far == pytest.approx(0.01, abs=0.005)


def test_a_block_stops_where_friction_stops_it_and_not_a_step_later(tmp_path: Path) -> None:
    """From v_0 at the deceleration N/m; in the step that takes more than that away it is at zero."""
    w = {"F": Constant(0.0), "N": Constant(10.0)}
    model = Exported(RealTime(_block(), {}, None, {"w": 0.0123}, w, 1.0, 0.0), tmp_path)
    found = model.march(1e-3, 0.01)
    assert found.rows[:3, 0] == pytest.approx([0.0073, 0.0023, 0.0], abs=1e-14)
    assert found.modes[:, 0].tolist() == [1, 1, *[0] * 8]


@pytest.mark.parametrize("name", ["alsd", "six-pulse"])
@pytest.mark.parametrize("integrator", ["rk4", "rosenbrock"])
def test_config_tells_what_a_step_takes(name: str, integrator: str, tmp_path: Path) -> None:
    """Against numbers that count what is done with them: no more than told, and most of it."""
    case = CASES[name]()
    text = case.export(integrator)["config.h"]
    usual = int(re.search(r"BG_STEP_OPERATIONS (\d+)", text)[1])
    most = int(re.search(r"BG_STEP_MOST_OPERATIONS (\d+)", text)[1])
    told = operations(case, tmp_path, integrator)
    assert not told[:, 0].any()
    counts = told[:, 1:].sum(axis=1)
    assert counts[0] < most
    assert 0.7 * usual < counts[-1] < usual
    products = int(re.search(r"no port changes, \d+ evaluations: (\d+) multiplications", text)[1])
    assert 0.6 * products < told[-1, 1] < products


def test_an_implicit_step_tells_of_an_error_beyond_one_percent_and_is_taken(tmp_path: Path) -> None:
    """A swing of 2,000 rad/s: of it 4 ms leave nothing, 0.1 ms are fine."""
    nodes = [bg.One("v"), bg.I("m", 1.0, flow="w"), bg.C("c", 0.25e-6, effort="F")]
    equations = bg.derive(bond_graph(nodes, "v>m v>c"))
    case = RealTime(equations, {}, None, {"w": 1.0}, {}, 0.0, 0.0)
    model = Exported(case, tmp_path, "rosenbrock")
    for h, status in ((1e-4, Status.OK), (4e-3, Status.INACCURATE)):
        found = model.march(h, 5 * h)
        assert found.taken == 5
        assert found.told[0] == status, model.message(int(found.told[0]))
        assert np.isfinite(found.rows).all()
    assert "beyond 1 % of a state's range" in model.message(Status.INACCURATE)
    module = loaded(to_python(equations, {}, integrator="rosenbrock"))
    with pytest.warns(UserWarning, match="at t = 0 the error of a step of 0.004 s is beyond 1 %"):
        module.simulate([0.0, 0.004], {"w": 1.0}, {}, step=4e-3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = module.simulate([0.0, 0.01], {"w": 1.0}, {}, step=1e-4)
    assert run["w"][-1] == pytest.approx(np.cos(20.0), abs=1e-4)


@pytest.mark.parametrize("name", ["alsd", "six-pulse"])
def test_exported_python_takes_the_same_implicit_steps(
    name: str, made: Callable[..., Exported]
) -> None:
    case = CASES[name]()
    model = made(name, "rosenbrock")
    text = to_python(case.equations, case.numbers, case.laws, integrator="rosenbrock")
    end = 0.56 if name == "alsd" else 0.16
    found = model.march(1e-3, end)
    times = np.linspace(0, end, round(end / 0.02) + 1)
    signals = {name: (lambda t, one=one: float(one(t))) for name, one in case.inputs.items()}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = loaded(text).simulate(times, case.initial, signals, step=1e-3)
    assert found.taken == len(found.costs)
    for at, name in enumerate(model.states):
        mine, largest = found.rows[19::20, at], np.abs(run[name]).max()
        assert mine == pytest.approx(run[name][1:], rel=0, abs=1e-7 * largest), name


def test_an_integrator_that_is_none_is_refused() -> None:
    for export in (to_c, to_python):
        with pytest.raises(
            bg.ParameterError, match=r"no integrator 'euler' of fixed steps; there are 'rk4'"
        ):
            export(_block(), {}, integrator="euler")


HARNESS = """
#include <string.h>
#include "model_internal.h"
int harness_box(int ports, const double *yields, double *rows, int *way)
{
    static bg_boxed box;
    static double system[BG_PORTS * BG_PORTS];
    memset(&box, 0, sizeof box);
    for (int i = 0; i < ports; i++) {
        box.way[i] = way[i];
        box.least[i] = rows[i];
        box.most[i] = rows[ports + i];
        box.given[i] = rows[2 * ports + i];
        box.slip[i] = rows[3 * ports + i];
        box.slips[i] = BG_HUGE;
    }
    const int status = bg_box_solve(ports, &box, yields, system);
    for (int i = 0; i < ports; i++) {
        rows[i] = box.given[i];
        rows[ports + i] = box.slip[i];
        way[i] = box.way[i];
    }
    return status;
}
"""


@pytest.fixture(scope="module")
def solve(tmp_path_factory: pytest.TempPathFactory):
    """The problem of a step in C: ways, what ports give, slips, status; the same in Python agrees."""
    folder = tmp_path_factory.mktemp("box")
    files = gearbox().export()
    (folder / "box.c").write_text(HARNESS)
    sources = [*written(folder, files), str(folder / "box.c")]
    library = ctypes.CDLL(str(compiled(folder, sources, "-O0", "-shared", "-fPIC", to="box.so")))

    def solved(yields: np.ndarray, slip: np.ndarray, least: np.ndarray, most: np.ndarray):
        ports, zeros = len(slip), np.zeros(len(slip))
        box = Boxed(np.zeros(ports, int), least, most, zeros, zeros, zeros, slip, zeros)
        found = box.solve(yields)
        rows = np.concatenate([least, most, zeros, slip])
        way = np.zeros(ports, np.intc)
        status = library.harness_box(
            ports, np.ascontiguousarray(yields).ctypes.data_as(ctypes.c_void_p),
            rows.ctypes.data_as(ctypes.c_void_p), way.ctypes.data_as(ctypes.c_void_p),
        )  # fmt: skip
        given, slips = rows[:ports], rows[ports : 2 * ports]
        assert found == (status == 0)
        assert way.tolist() == box.way.tolist()
        assert given == pytest.approx(box.given, rel=1e-9, abs=1e-12)
        assert slips == pytest.approx(box.slip, rel=1e-9, abs=1e-12)
        return way, given, slips, status

    return solved


@pytest.mark.parametrize("seed", range(40))
def test_what_ports_give_solves_the_complementarity_problem(solve, seed: int) -> None:
    """Of passive ports, whatever their matrix: y = slip - V u, u within bounds, y zero or on its side."""
    draw = np.random.default_rng(seed)
    ports = int(draw.integers(1, 8))
    root, skew = draw.normal(size=(2, ports, ports))
    yields = root @ root.T + 0.1 * np.eye(ports) + (skew - skew.T)
    slip, most = 5 * draw.normal(size=ports), draw.uniform(0.1, 2.0, ports)
    way, given, y, status = solve(yields, slip, -most, most)
    assert status == 0
    assert slip - yields @ given == pytest.approx(y, abs=1e-9)
    assert (np.abs(given) <= most + 1e-9).all()
    assert (np.abs(y[way == 0]) < 1e-9).all()
    assert (y * way >= -1e-7).all()
    assert given[way != 0] == pytest.approx((way * most)[way != 0])


def test_a_problem_without_a_solution_ends_and_tells(solve) -> None:
    """Two ports that each push the other: in no way do both rest, or both slip. Its bound is in config.h."""
    yields = np.array([[1e-3, 4.0], [-4.0, 1e-3]]) @ np.diag([1.0, -1.0])
    *_, status = solve(yields, np.array([1.0, 1.0]), np.array([-0.1, 0.0]), np.array([0.0, 0.1]))
    _, given, y, told = solve(
        np.array([[-1.0, 0.5], [0.5, -1.0]]), np.array([0.3, -0.2]), -np.ones(2), np.ones(2)
    )
    assert told in (Status.OK, Status.PIVOTS)
    assert np.isfinite([*given, *y]).all()
    assert status in (Status.OK, Status.PIVOTS)

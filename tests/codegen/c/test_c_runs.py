"""Exported C in use: affine maps, rates, steps in bounded time, instances side by side."""

import ctypes
import subprocess
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import CModel, Pair, compiled, written
from references.build import bond_graph

import bondgraph as bg
import differentials
from codegen import Step, simulator, to_c
from differentials.model import model


def _alsd() -> tuple[bg.StateEquations, dict[str, float], dict]:
    full = model("alsd")
    values = {symbol: one.value for symbol, one in full.parameters.items()}
    return full.equations, values | {"omega_t1_0": 80.0, "omega_t2_0": 82.0}, full.laws


@pytest.fixture(scope="module")
def alsd(tmp_path_factory: pytest.TempPathFactory) -> Pair:
    return Pair(tmp_path_factory.mktemp("alsd"), *_alsd())


@pytest.mark.parametrize("name", ["alsd", "stationary_tvd", "four_wheel_drive_tvd"])
def test_affine_maps_agree(name: str, tmp_path: Path) -> None:
    full = model(name)
    values = {symbol: one.value for symbol, one in full.parameters.items()}
    pair = Pair(tmp_path, full.equations, values | dict.fromkeys(full.starts, 80.0), full.laws)
    for mode in product((-1, 0, 1), repeat=len(pair.program.friction)):
        expected = pair.closed.affine_map(mode, len(pair.program.external))
        status, matrix = pair.c.affine_map(mode)
        assert status == 0
        size = np.abs(expected.matrix).max(axis=1, keepdims=True)
        assert (np.abs(matrix - expected.matrix) <= 1e-12 * size + 1e-9).all()


def test_straight_rates_are_those_of_an_evaluation(alsd: Pair) -> None:
    rng = np.random.default_rng(3)
    for sign in (1, -1):
        s, w = rng.uniform(-80, 80, 6), rng.uniform(0, 900, 2)
        _, parts = alsd.c.evaluate(0.0, s, w, [0, 0], (sign,))
        assert alsd.c.rhs(0.0, s, w, [sign]) == pytest.approx(parts[5], rel=1e-12)


def test_rates_that_need_a_loop_take_the_way_of_an_evaluation(tmp_path: Path) -> None:
    nodes = [
        bg.One("n"),
        bg.I("m", 2, flow="v"),
        bg.R("a", law="v - e_b/2"),
        bg.R("b", law="tanh(e_a)"),
    ]
    pair = Pair(tmp_path, bg.derive(bond_graph(nodes, "n>m n>a n>b")), {})
    assert pair.c.rhs(0.0, [0.7], [], []) == pytest.approx(
        pair.closed.evaluate(0.0, np.array([0.7]), np.zeros(0), np.zeros(0), ()).rate, rel=1e-9
    )


def _lagged(t: float) -> list[float]:
    """The torques of Fig. 11: steps at 0.1 s and 0.5 s through lags of 40 ms."""
    return [
        level * -np.expm1(-(t - start) / 0.04) if t > start else 0.0
        for level, start in ((350.0, 0.1), (1000.0, 0.5))
    ]


def _fixed_steps(pair: Pair, h: float) -> np.ndarray:
    """omega_1 .. at every 10 ms of Fig. 11 by fixed steps."""
    pair.at(_alsd()[1])
    s, rows = np.array([80.0, 82.0, 0.0, 0.0, 80.0, 82.0]), []
    steps = round(0.01 / h)
    for k in range(100 * steps):
        if k % steps == 0:
            rows.append(s)
        w = [_lagged((k + part) * h) for part in (0, 0.5, 1)]
        status, s = pair.c.step(k * h, h, s, w)
        assert status == 0
    return np.array(rows)


def test_fixed_steps_of_figure_11_converge(alsd: Pair) -> None:
    run = differentials.simulate("alsd", "fig11")
    expected = np.column_stack([run[name] for name in run.states])[:1000:10]
    errors = []
    for h in (2e-4, 1e-4, 5e-5):
        found = _fixed_steps(alsd, h)
        scale = np.abs(expected).max(axis=0)
        errors.append(float((np.abs(found - expected) / scale).max()))
    assert errors[2] < errors[1] / 3 < errors[0] / 9
    assert errors[2] < 2e-5


def test_a_clutch_that_locks_has_no_slip_and_holds_within_its_breakaway(alsd: Pair) -> None:
    alsd.at(_alsd()[1])
    s = np.array([80.0, 82.0, 0.0, 0.0, 80.0, 82.0])
    status, s = alsd.c.step(0.0, 1e-6, s, [[50.0, 5000.0]] * 3)
    assert status == 0
    modes = [alsd.c.mode()]
    for k in range(2000):
        status, s = alsd.c.step(k * 1e-4, 1e-4, s, [[50.0, 5000.0]] * 3)
        assert status == 0
        modes.append(alsd.c.mode())
    assert modes[0] == (-1,)
    assert modes[-1] == (0,)
    assert abs(s[0] - s[1]) < 1e-9


def test_instances_do_not_disturb_each_other(alsd: Pair) -> None:
    values = _alsd()[1]
    w, start = [[100.0, 500.0]] * 3, np.array([80.0, 82.0, 0.0, 0.0, 80.0, 82.0])

    def alone(inertia: float) -> np.ndarray:
        one, s = CModel(alsd.library, alsd.program, values | {"I_i": inertia}), start
        for k in range(300):
            _, s = one.step(k * 1e-4, 1e-4, s, w)
        return s

    expected = [alone(inertia) for inertia in (0.1, 0.2, 0.4)]
    many = [CModel(alsd.library, alsd.program, values | {"I_i": one}) for one in (0.1, 0.2, 0.4)]
    states = [start] * 3
    for k in range(300):
        states = [one.step(k * 1e-4, 1e-4, s, w)[1] for one, s in zip(many, states, strict=True)]
    assert np.array_equal(states, expected)


def test_the_main_program_runs_alone_clean_under_sanitizers(tmp_path: Path) -> None:
    equations, values, laws = _alsd()
    sources = written(tmp_path, to_c(equations, values, laws, name="alsd", main=True))
    program = compiled(
        tmp_path, sources, "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover",
        "--param=asan-instrumentation-with-call-threshold=0",
    )  # fmt: skip
    starts = ["omega_1=80", "omega_2=82", "omega_t1=80", "omega_t2=82", "tau_e=50", "tau_h=900"]
    done = subprocess.run(
        [program, "0.05", "1e-4", *starts], capture_output=True, text=True, check=True
    )
    head, *rows = done.stdout.splitlines()
    assert head.split(",")[:7] == ["t", *(name.name for name in (*equations.states,))]
    table = np.array([row.split(",") for row in rows], dtype=float)
    ready = simulator(equations, values, laws)
    run = ready.run(
        table[:, 0], dict(zip(ready.states, [80, 82, 0, 0, 80, 82], strict=True)),
        {"tau_e": 50.0, "tau_h": Step(-1.0, 900.0)},
    )  # fmt: skip
    for at, name in enumerate(head.split(",")[1:], 1):
        scale = np.abs(run[name]).max() + 1e-9
        assert np.abs(table[:, at] - run[name]).max() < 1e-2 * scale, name
    for wrong in (["0.05"], ["0.05", "1e-4", "nobody=1"], ["1", "1e-4", "I_1=nan"]):
        assert subprocess.run([program, *wrong], capture_output=True, check=False).returncode == 1


def test_no_object_of_an_export_calls_the_allocator(tmp_path: Path) -> None:
    sources = written(tmp_path, to_c(*_alsd()))
    (tmp_path / "all.c").write_text("".join(f'#include "{source}"\n' for source in sources))
    subprocess.run(
        ["gcc", "-std=c99", "-fno-pic", "-fno-pie", "-c", "all.c"], cwd=tmp_path, check=True
    )
    listed = subprocess.run(
        ["nm", "--undefined-only", "all.o"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    wanted = {line.split()[-1] for line in listed.stdout.splitlines() if " U " in line}
    assert not {name for name in wanted if not name.startswith("bg_")} - {
        "memcmp", "memcpy", "memmove", "memset", "sqrt", "fmin", "fmax", "fabs", "copysign", "nextafter",
        "ldexp", "exp", "floor",
        "log", "pow", "sin", "cos", "__stack_chk_fail", "_GLOBAL_OFFSET_TABLE_",
    }  # fmt: skip
    data = subprocess.run(["nm", "all.o"], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert not [
        line
        for line in data.stdout.splitlines()
        if line.split()[1:2] in (["D"], ["B"], ["d"], ["b"])
    ]


def test_struct_size_is_known_to_callers(alsd: Pair) -> None:
    assert alsd.library.bg_model_size() == ctypes.sizeof(alsd.c.instance)

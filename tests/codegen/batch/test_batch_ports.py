"""The loop over runs on models with several friction ports."""

import numpy as np
import pytest
from oracles.c_model import WARNED
from oracles.models import belt, stacked_blocks
from oracles.sweeping import spring_mass

import bondgraph as bg
from codegen import (
    Constant,
    Family,
    Lag,
    Ramp,
    Sine,
    Step,
    event_count,
    final,
    first_event,
    integral,
    peak,
    samples,
)  # fmt: skip
from codegen.batch.engine import batch_engine
from codegen.c.export import to_c
from codegen.engine.sized import sizes
from codegen.record.result import Result
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import batch_of
from differentials.scenarios import prepared


def _agree(
    family: Family, rows: dict[str, list[float]], times, measures, initial=None, inputs=None
) -> int:
    """The loop and single runs of the C engine give the same; how many events there are."""
    names, table = tuple(rows), np.column_stack([*rows.values()])
    loop = batch_of(Job(family, names, np.asarray(times), measures, initial, inputs))
    assert loop is not None
    columns, left = loop(table)
    assert left == []
    seen = 0
    for at, row in enumerate(table.tolist()):
        run: Result = family.simulator(**dict(zip(names, row, strict=True))).run(
            times, initial, inputs
        )
        seen += len(run.events)
        for (name, measure), column in zip(measures.items(), columns, strict=True):
            expected = np.asarray(measure(run))
            if measure.function.__name__ == "_first_event":
                assert column[at] == pytest.approx(expected, abs=1e-12, nan_ok=True), name
                continue
            signal = measure.arguments[0]
            span = 1.0 if signal not in run.columns else max(np.ptp(run[signal]), 1e-3)
            span *= max(1.0, times[-1] - times[0])
            assert np.abs(column[at] - expected).max() <= 1e-9 * span, (name, row)
    return seen


@pytest.mark.parametrize(
    ("name", "scenario"),
    [("stationary_tvd", "fig13"), ("superposition_tvd", "fig13_superposition")],
)
def test_torque_vectoring_with_two_clutches(name: str, scenario: str) -> None:
    case = prepared(name, scenario)
    family = Family(case.equations, case.parameters, case.laws, "c")
    ports = [port.name for port in family.program.friction]
    assert len(ports) == 2
    swept = next(p for p in family.parameters if p.startswith("I_"))
    base = float(family.parameters[swept])
    signals = [*family.states, *(r.name for r in family.program.readings)][:6]
    measures = {f"samples of {s}": samples(s) for s in signals}
    measures |= {
        f"{kind} of {p}": first_event(p, kind) for p in ports for kind in ("stick", "slip")
    }
    measures |= {f"count of {p}": event_count(p, "slip") for p in ports}
    rows = {swept: [base, 0.8 * base, 1.3 * base]}
    _agree(family, rows, np.linspace(0.0, 1.0, 801), measures, case.initial, case.inputs)


STACKED = {"m_1": 2.0, "m_2": 1.0, "L_1": 3.0, "L_2": 1.0}
PUSHES = {
    "P_1": Sine(6.0, 0.7) + Step(3.0, -4.0) + Lag(Step(6.0, 5.0), 0.3),
    "P_2": Sine(2.5, 1.1, offset=0.3) + Step(5.0, -1.0),
}


def _stacked() -> Family:
    laws = {"ground": bg.DryFriction("L_1", 1, 1.2), "contact": bg.DryFriction("L_2", 1, 1.5)}
    return Family(bg.derive(stacked_blocks()), STACKED, laws, "c")


@pytest.mark.parametrize("count", [961, 31])
def test_blocks_on_top_of_each_other(count: int) -> None:
    """Also with samples so far apart that each is many steps."""
    family = _stacked()
    measures = {f"{state} {m.__name__}": m(state) for state in family.states
                for m in (samples, peak, final, integral)}  # fmt: skip
    measures |= {f"{port} {kind}": first_event(port, kind)
                 for port in ("ground", "contact") for kind in ("stick", "slip", "cross")}  # fmt: skip
    measures |= {f"count at {port}": event_count(port, "stick") for port in ("ground", "contact")}
    rows = {"L_1": [3.0, 2.2, 4.0], "m_2": [1.0, 1.7, 0.6]}
    assert _agree(family, rows, np.linspace(0.0, 9.0, count), measures, None, PUSHES) > 20


def test_times_at_any_distance() -> None:
    """Steps of power series between most samples, leaps over the regular ones."""
    times = np.concatenate([np.linspace(0.0, 1.0, 11) ** 2, np.linspace(1.1, 3.0, 200), [3.5, 4.0]])
    family = Family(
        bg.derive(belt(bg.C("spring", "1/k", effort="F"))), {"m": 1.0, "k": 40.0, "F_c": 2.0},
        None, "c",
    )  # fmt: skip
    inputs = {
        "V_b": Lag(Step(0.2, 1.5), 0.05) + Sine(0.4, 1.7, offset=0.3) + Ramp(0.9, -2.0, end=1.8)
    }
    measures = {"v": samples("v"), "F": integral("F"), "belt": samples("V_b")}
    rows = {"k": [40.0, 55.0], "F_c": [2.0, 1.5]}
    assert _agree(family, rows, times, measures, {"v": 0.2}, inputs) > 5


def test_runs_whose_parameters_do_not_change() -> None:
    """What is bound for one run serves the next."""
    times, measures = np.linspace(0.0, 4.0, 201), {"v": samples("v_1"), "w": final("v_2")}
    family = _stacked()
    # As many slots of generators as those of the blocks above have: the same library.
    inputs = {
        "P_1": Lag(Step(0.0, 4.0), 0.1) + Sine(1.0, 0.5),
        "P_2": Constant(0.2) + Sine(0.1, 0.7),
    }
    loop = batch_of(Job(family, ("v_1",), times, measures, {"v_2": 0.5}, inputs))
    assert loop is not None
    (found, _), left = loop([(v,) for v in (-1.0, 2.0, 2.0, 0.0)])
    assert left == []
    for row, v in zip(found, (-1.0, 2.0, 2.0, 0.0), strict=True):
        expected = family.simulator().run(times, {"v_1": v, "v_2": 0.5}, inputs)["v_1"]
        assert np.abs(row - expected).max() <= 1e-9


def test_the_loop_compiles_without_warnings(monkeypatch: pytest.MonkeyPatch) -> None:
    for family, optimised in ((_stacked(), "-O3"), (spring_mass(), "-O1")):
        monkeypatch.setenv("CFLAGS", optimised)
        model = to_c(family.equations, family.parameters, family.laws)
        wanted = sizes(family.simulator().closed, 2)
        batch_engine(model, wanted, WARNED)

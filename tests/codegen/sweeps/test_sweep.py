"""`sweep` in one process: every run's numbers, what fails, and what cannot be swept."""

import gc
import math
import sys
import tracemalloc

import numpy as np
import pytest
import sympy as sp
from oracles.sweeping import LOCKING, MEASURES, TIMES, Plain, answer, locking, spring_mass, twice

import bondgraph as bg
import codegen
from codegen import Samples, Sweep, Table, sweep
from codegen.record.measures import Measure

HERE = {"workers": 0, "progress": False}


def _swept(parameters: object, measures: object = MEASURES, **more: object) -> Sweep:
    return sweep(
        spring_mass(), parameters, TIMES, measures, **{"inputs": {"P": 0.0}, **HERE, **more}
    )


def test_every_run_is_the_closed_form_answer() -> None:
    axes = {"k": [2.0, 8.0, 18.0], "v": [1.0, -2.0], "P": [0.0, 3.0], "m": [2.0, 0.5]}
    measures = {"speed": codegen.final("v"), "force": codegen.final("F")}
    found = _swept(axes, measures, inputs=None)
    m, k, v, P = (found[name] for name in "mkvP")
    speed, force = answer(m, k, v, P, TIMES[-1])
    assert found["speed"] == pytest.approx(speed, rel=1e-9, abs=1e-9)
    assert found["force"] == pytest.approx(force, rel=1e-9, abs=1e-9)
    assert set(zip(m, k, v, P, strict=True)).__len__() == len(found) == 24


def test_runs_are_those_of_single_simulators() -> None:
    rows = Table(c=[400.0, 750.0, 900.0], omega_2=[81.0, 82.0, 90.0])
    given = {**LOCKING, "initial": {"omega_1": 80.0}}
    found = sweep(locking(), rows, **given, **HERE)
    for at in range(3):
        result = locking().simulator(c=rows.row(at)[0]).run(
            LOCKING["time"], {"omega_1": 80.0, "omega_2": rows.row(at)[1]}, LOCKING["inputs"]
        )  # fmt: skip
        for name, measure in LOCKING["measures"].items():
            assert found[name][at] == measure(result)


def test_inputs_and_initial_values_may_follow_the_runs_numbers() -> None:
    given = {
        **LOCKING,
        "initial": lambda values: {"omega_1": values["w_0"], "omega_2": values["w_0"] + 2},
        "inputs": lambda values: {
            "tau_e": 0.0, "tau_h": codegen.Lag(codegen.Step(0.0, values["demand"]), 0.04)
        },
    }  # fmt: skip
    found = sweep(locking(), {"demand": [500.0, 2000.0], "w_0": [60.0, 80.0]}, **given, **HERE)
    assert not found.failed
    assert found["stick"][0] > found["stick"][2] > 0
    assert found["stick"][0] == pytest.approx(found["stick"][1])


def test_sets_that_fail_are_told_and_the_others_go_on() -> None:
    found = _swept({"m": [1.0, 0.0, 2.0, np.nan]}, {"end": codegen.final("v")})
    assert [failure.run for failure in found.failed] == [1, 3]
    assert found.failed[0].values == {"m": 0.0}
    assert "zero or infinite at m = 0" in found.failed[0].message
    assert "not a finite number" in found.failed[1].message
    assert np.isnan(found["end"]).tolist() == [False, True, False, True]
    assert found.complete


def test_measures_that_fail_are_told_by_name_and_run() -> None:
    found = _swept({"v": [2.0]}, {"odd": lambda result: "text"})
    assert "measure 'odd': ValueError" in found.failed[0].message
    found = _swept({"v": [2.0]}, {"odd": lambda result: np.complex128(1 + 5j)})
    assert "measure 'odd': TypeError" in found.failed[0].message
    found = _swept({"v": [1.0]}, {"odd": lambda result: codegen.peak("nothing")(result)})
    assert "measure 'odd': no signal 'nothing'; there are v, F" in found.failed[0].message


@pytest.mark.parametrize(
    ("measure", "says"),
    [
        (codegen.peak("forc"), "no signal 'forc'"),
        (codegen.integral("V"), "no signal 'V'"),
        (codegen.samples("f_sprin"), "no signal 'f_sprin' \\(did you mean 'f_spring'\\?\\)"),
        (codegen.first_event("sprin", "stick"), "no node 'sprin' \\(did you mean 'spring'\\?\\)"),
        (codegen.event_count("clutch", "slip"), "no node 'clutch'; there are"),
        (codegen.work("sprin"), "no node 'sprin'"),
    ],
)
def test_measures_of_what_the_model_does_not_have_are_refused_first(
    measure: Measure, says: str
) -> None:
    with pytest.raises(bg.SignalError, match=f"measure 'odd': {says}"):
        _swept({"v": [1.0]}, {"odd": measure})
    result = spring_mass().simulator().run([0.0, 1.0], {}, {"P": 0.0})
    with pytest.raises((bg.SignalError, bg.StructureError), match=says.split(" ")[2].strip("'")):
        measure(result)


def test_kinds_of_events_that_there_are_not_are_refused() -> None:
    for asked in (codegen.first_event, codegen.event_count):
        with pytest.raises(bg.SignalError, match="no event is a 'stik'"):
            asked("clutch", "stik")


@pytest.mark.parametrize("on", ["P", 3, ["gap"]])
def test_switches_that_there_are_not_are_refused_first(on: object) -> None:
    with pytest.raises(bg.StructureError, match=r"on must be a list of switches|is no switch"):
        _swept({"v": [1.0]}, {"end": codegen.final("v")}, initially_on=on)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: codegen.Grid(a=[]), "a has no values"),
        (lambda: Table(a=[], b=[]), "a has no values"),
        (lambda: codegen.Grid("ab"), "a grid's axes must map names"),
        (lambda: codegen.Grid({"a": [1.0]}, a=[2.0]), "a comes twice"),
        (lambda: codegen.Grid({sp.Symbol("a"): [1.0], "a": [2.0]}), "a comes twice"),
        (lambda: Table(7), "a table's rows must be one or more mappings"),
        (lambda: Samples(3, 1, a=3), "samples of a need two limits or a function, not 3"),
        (lambda: Samples(3, 1, a=None), "samples of a need two limits"),
        (lambda: Samples(3, 1, a=(1.0, math.inf)), "samples of a need two limits"),
        (lambda: Samples(3, 1, a=(2.0, 1.0)), "samples of a: the lower limit comes first"),
        (lambda: Samples(0, 1, a=(1.0, 2.0)), "runs must be a whole number from 1 on, not 0"),
        (lambda: Samples(2.5, 1, a=(1.0, 2.0)), "runs must be a whole number"),
        (lambda: Samples(3, "x", a=(1.0, 2.0)), "seed must be a whole number from 0 on, not 'x'"),
        (lambda: Samples(3, -1, a=(1.0, 2.0)), "seed must be a whole number"),
    ],
)
def test_what_is_no_design_is_refused_when_it_is_made(make, message: str) -> None:
    with pytest.raises(bg.SignalError, match=message):
        make()


@pytest.mark.parametrize("chunk", [1, 2, 7])
def test_measures_keep_the_shape_of_the_first_run(chunk: int) -> None:
    def ragged(result: codegen.Result) -> np.ndarray:
        return np.full(int(result["v"][0]), 7.0)

    found = _swept({"v": [3.0, 2.0, 3.0, 2.0, 2.0]}, {"n": ragged}, chunk=chunk)
    assert found["n"].shape == (5, 3)
    assert [failure.run for failure in found.failed] == [1, 3, 4]
    assert "((2,),), in the first run ((3,),)" in found.failed[0].message


def test_a_grid_becomes_a_data_set_with_an_axis_for_each_name() -> None:
    measures = {"end": codegen.final("F"), "course": codegen.samples("v"), "pair": _pair}
    found = _swept({"k": [2.0, 8.0, 18.0], "v": [1.0, -2.0]}, measures)
    data = found.to_xarray()
    assert data["end"].dims == ("k", "v")
    assert data["course"].dims == ("k", "v", "time")
    assert data["pair"].dims == ("k", "v", "pair_0")
    one = data.sel(k=8.0, v=-2.0)
    assert float(one["end"]) == found["end"][3]
    assert (one["course"].values == found["course"][3]).all()
    assert float(one["course"].sel(time=0.0)) == -2.0


def _pair(result: codegen.Result) -> list[float]:
    return [float(result["v"][0]), float(result["v"][-1])]


def test_a_table_becomes_a_data_set_along_its_runs() -> None:
    found = _swept(Samples(4, seed=5, k=(1.0, 9.0)), {"end": codegen.final("F")})
    data = found.to_xarray()
    assert data["end"].dims == data["k"].dims == ("run",)
    assert (data["k"].values == found["k"]).all()


def test_missing_extras_are_named(monkeypatch) -> None:
    for name in ("xarray", "tqdm", "distributed"):
        monkeypatch.setitem(sys.modules, name, None)
    found = _swept({"k": [2.0]}, progress=True)
    assert found.table()["force"] == pytest.approx(0.0)
    with pytest.raises(bg.MissingExtraError, match=r"pip install bondgraph-toolkit\[sweep\]"):
        found.to_xarray()
    with pytest.raises(bg.MissingExtraError, match=r"pip install bondgraph-toolkit\[cluster\]"):
        _swept({"k": [2.0]}, client=object())


def test_a_bar_tells_the_progress(capfd) -> None:
    _swept({"k": [2.0, 3.0]}, progress=True)
    assert "2/2" in capfd.readouterr().err
    _swept({"k": [2.0, 3.0]})
    assert not capfd.readouterr().err


def test_memory_grows_with_the_measures_only() -> None:
    def most(runs: int) -> int:
        values = Table(a=np.arange(runs, dtype=float))
        gc.collect()
        tracemalloc.start()
        found = sweep(Plain(), values, TIMES, {"twice": twice}, chunk=100, **HERE)
        used = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert (found["twice"] == 2 * values.column("a")).all()
        return used

    most(10)
    few, many = most(1000), most(11000)
    # A float for the measure, an index of what is to do, a mark that it is done.
    assert (many - few) / 10000 < 3 * 8


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_an_input_whose_size_is_swept_is_the_signal_times_the_number(backend: str) -> None:
    plain = spring_mass()
    family = codegen.Family(plain.equations, plain.parameters, plain.laws, backend)
    push = codegen.Ramp(0.1, 2.0) + codegen.Sine(0.5, 1.0)
    grid, measures = {"m": [1.0, 3.0], "size": [-2.0, 0.5]}, {"end": codegen.final("v")}
    found = sweep(family, grid, TIMES, measures, None, {"P": codegen.Swept("size", push)}, **HERE)
    for m, size, end in zip(found["m"], found["size"], found["end"], strict=True):
        alone = codegen.Ramp(0.1, 2.0 * size) + codegen.Sine(0.5 * size, 1.0)
        run = plain.simulator(m=m).run(TIMES, None, {"P": alone})
        assert end == pytest.approx(run["v"][-1], rel=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"parameters": {"c": [1]}}, "'c' is no parameter, state or input; there are m, k, v, F, p_m"),
        ({"parameters": {"k": []}}, "k has no values"),
        ({"parameters": {"k": ["a"]}}, "the values of k must be numbers"),
        ({"parameters": {"k": np.array([1 + 5j])}}, "the values of k must be numbers: these are complex128"),
        ({"parameters": {"k": [1.0, np.complex128(1)]}}, "the values of k must be numbers"),
        ({"parameters": {"k": ["1", "2"]}}, "the values of k must be numbers"),
        ({"parameters": {"k": 1.0}}, r"the values of k must be a list, not of shape \(\)"),
        ({"parameters": 5}, "parameters must be a Grid"),
        ({"measures": codegen.peak("v")}, "measures must map names to functions"),
        ({"parameters": {"p_n": [1.0]}}, "'p_n' is no parameter, .* .did you mean 'p_m'"),
        ({"parameters": {"p_n": [1.0]}, "initial": {"p_m": 1.0}}, "'p_n' is no parameter"),
        ({"initial": {"p_m": 1.0, "w": 2.0}}, "'w' is not a state"),
        ({"parameters": {"p_m": [1.0]}, "initial": {"p_m": 1.0}}, "'p_m' is swept, too"),
        ({"parameters": [{"k": 1}, {"m": 1}]}, r"row 1 has the names \['m'\]"),
        ({"parameters": {"P": [1.0]}}, "inputs: 'P' is swept, too"),
        ({"initial": {"x": 1.0}}, "'x' is not a state"),
        ({"inputs": {}}, "missing input"),
        ({"inputs": {"P": codegen.Swept("size")}}, "input 'P': 'size' is not swept; swept are k"),
        ({"inputs": [1]}, r"inputs must map names to values, not be \[1\]"),
        ({"inputs": 5}, "inputs must map names to values, not be 5"),
        ({"initial": 5}, "initial must map names to values, not be 5"),
        ({"inputs": codegen.Step(0, 1)}, "inputs must map names to values, not be Step"),
        ({"inputs": codegen.Swept("k")}, "inputs must map names to values, not be Swept"),
        ({"parameters": {"P": [1.0]}, "inputs": {sp.Symbol("P"): 0.0}}, "inputs: P is swept, too"),
        ({"inputs": {"P": "x"}}, "neither a signal nor a number"),
        ({"time": [0.0]}, "two or more points"),
        ({"method": "Euler"}, "unknown method 'Euler'"),
        ({"measures": {}}, "name at least one"),
        ({"measures": {"end": "v"}}, "measure 'end': 'v' is not a function"),
        ({"measures": {"k": _pair}}, "'k' is swept, so no measure"),
        ({"measures": {"run": _pair}}, "'run' names an axis"),
        ({"workers": -1}, "workers must be 0 or more"),
        ({"workers": 1.5}, "workers must be a whole number"),
        ({"chunk": 0}, "chunk must be 1 or more"),
        ({"workers": 1, "measures": {"end": lambda r: 0.0}}, "cannot be sent to other processes"),
        ({"model": spring_mass().equations}, "such as codegen.Family"),
    ],
)  # fmt: skip
def test_what_no_run_can_use_is_refused_before_the_first(change, message: str) -> None:
    given = {"model": spring_mass(), "parameters": {"k": [1.0, 2.0]}, "time": TIMES,
             "measures": {"end": codegen.final("v")}, "inputs": {"P": 0.0}, **HERE}  # fmt: skip
    with pytest.raises(bg.SignalError, match=message):
        sweep(**{**given, **change})


def test_samples_and_tables_are_refused_with_the_reason() -> None:
    with pytest.raises(bg.SignalError, match=r"one length, not {'a': 1, 'b': 2}"):
        Table(a=[1], b=[1, 2])
    with pytest.raises(bg.SignalError, match="rows or columns, not both"):
        Table([{"a": 1}], b=[1])
    with pytest.raises(bg.SignalError, match="two limits or a function"):
        Samples(3, seed=1, a=(1.0,))  # type: ignore[arg-type]


def test_samples_lie_within_their_limits_and_do_not_depend_on_each_other() -> None:
    one, more = Samples(50, seed=3, a=(2.0, 3.0)), Samples(500, seed=3, b=(0.0, 1.0), a=(2.0, 3.0))
    assert ((more.column("a") >= 2) & (more.column("a") < 3)).all()
    assert (one.column("a") == more.column("a")[:50]).all()
    assert (Samples(50, seed=4, a=(2.0, 3.0)).column("a") != one.column("a")).all()
    assert abs(np.corrcoef(more.column("a"), more.column("b"))[0, 1]) < 0.2


def test_a_function_of_a_runs_numbers_may_size_inputs() -> None:
    measures = {"end": codegen.final("v")}
    grid, found = {"size": [1.0, 2.0]}, []
    for inputs in ({"P": codegen.Swept("size")}, lambda values: {"P": codegen.Swept("size")}):
        found.append(sweep(spring_mass(), grid, TIMES, measures, None, inputs, **HERE)["end"])
    assert found[0].tolist() == found[1].tolist()
    wrong = sweep(spring_mass(), grid, TIMES, measures, None,
                  lambda values: {"P": codegen.Swept("sise")}, **HERE)  # fmt: skip
    messages = {failure.message for failure in wrong.failed}
    assert messages == {"'sise' is not swept; swept are size"}


def test_a_size_has_its_name_as_swept_names_have() -> None:
    """The micro sign and the Greek letter are one name."""
    grid, push = {"\u03bc": [1.0, 2.0]}, codegen.Swept("\u00b5")
    found = sweep(spring_mass(), grid, TIMES, MEASURES, None, {"P": push}, **HERE)
    assert not found.failed

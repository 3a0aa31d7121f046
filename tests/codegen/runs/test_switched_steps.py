"""Fixed steps of models with switches: the same in exported Python and C, and right in the limit."""

import re
import subprocess
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from oracles.c_model import Pair, compiled, written
from oracles.exported import loaded
from oracles.switched_steps import Switched, switched_steps
from references.build import bond_graph

import bondgraph as bg
from codegen import Sine, simulator, to_c, to_python

CASES = dict(switched_steps())
BAND = 1e-6


@dataclass(frozen=True)
class Exported:
    """A case as C and as Python."""

    case: Switched
    equations: bg.StateEquations
    pair: Pair
    module: ModuleType

    def signals(self):
        return [self.case.inputs[name.name] for name in self.pair.program.external]

    def start(self) -> np.ndarray:
        program = self.pair.program
        names = [name.name for name in (*program.states, *program.law_states)]
        return np.array([self.case.initial.get(name, 0.0) for name in names])

    def march(self, parts: int):
        """Modes at all steps of C, and samples at every so many."""
        pair, count, h = self.pair.at(self.case.numbers), self.case.count, self.case.step / parts
        times = 0.5 * h * np.arange(2 * (count * parts + 1) + 1)
        w = np.column_stack([[signal(t) for t in times] for signal in self.signals()])
        pair.c.band(BAND)
        s = pair.c.vector(0.0, self.start(), w[0])
        return pair.c.march(h, count * parts, parts, s, w)


@pytest.fixture(scope="module", params=CASES)
def exported(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Exported:
    case = CASES[str(request.param)]
    equations = bg.derive(case.graph)
    pair = Pair(tmp_path_factory.mktemp("switched"), equations, case.numbers, on=case.on)
    return Exported(case, equations, pair, loaded(to_python(equations, case.numbers)))


def test_c_and_python_take_the_same_steps(exported: Exported) -> None:
    case, module, h = exported.case, exported.module, exported.case.step
    c, python, signals = exported.pair.at(case.numbers).c, module.Model(), exported.signals()
    given = module.sampled(signals, 0.0, h)
    s = module.vector(python.form, 0.0, exported.start(), *given[0])
    mine = c.vector(0.0, exported.start(), given[0][0])
    if case.on:
        s = python.begin(module.Point(0.0, s, *given[0]), case.on, case.initial)
    c.band(BAND)
    mode, modes = None, set()
    for k in range(case.count):
        given = module.sampled(signals, k * h, h)
        mode, s = python.settled(module.Point(k * h, s, *given[0]), mode, BAND, h)
        mode, s = python.advance(k * h, h, s, given, mode)
        status, mine = c.step(k * h, h, mine, [w for w, _ in given])
        assert status == 0, c.message(status)
        assert c.mode() == tuple(mode), k * h
        assert mine[: len(s)] == pytest.approx(s, rel=1e-12, abs=1e-12 * (1 + np.abs(s).max()))
        modes.add(tuple(mode))
    assert len(modes) > 1


def test_steps_converge_to_located_events(exported: Exported) -> None:
    case = exported.case
    ready = simulator(exported.equations, case.numbers)
    times = np.arange(case.count + 1) * case.step
    expected = ready.run(times, case.initial, case.inputs, initially_on=case.on)
    assert len(expected.events) > 1
    errors = []
    for parts in (1, 16):
        modes, found = exported.march(parts)
        errors.append(max(
            # Where a state jumps, a sample between the two instants of an event is of either side.
            np.sort(np.abs(found[name] - expected[name]))[:-4].max() / np.ptp(expected[name])
            for name in ready.states
        ))  # fmt: skip
    assert errors[1] < case.near
    assert errors[1] < errors[0] / 4
    for at, port in enumerate(exported.pair.program.friction):
        if port.switch is not None:
            on = [port.switch.word(sign) == "on" for sign in modes[::16, at].tolist()]
            assert (on == expected[str(port.name)]).mean() > 0.98


@pytest.fixture(scope="module")
def dog() -> ModuleType:
    return loaded(to_python(bg.derive(CASES["dog"].graph), CASES["dog"].numbers))


def test_a_dog_hands_momentum_over_and_loses_none(dog: ModuleType) -> None:
    """J_1 w_1 + J_2 w_2 grows by the torque alone; in, both turn as one."""
    case, times = CASES["dog"], np.linspace(0, 0.5, 101)
    run = dog.simulate(times, case.initial, {"tau": 1.3}, step=2.5e-3)
    momentum = 2.0 * run["w_1"] + 0.7 * run["w_2"]
    assert momentum == pytest.approx(2.0 * 5 - 0.7 * 3 + 1.3 * times, rel=1e-13)
    held = run["dog"] == 0
    assert 30 < held.sum() < 40
    assert run["w_1"][held] == pytest.approx(momentum[held] / 2.7, rel=1e-13)
    assert run["w_2"][held] == pytest.approx(run["w_1"][held], rel=1e-13)
    after = times > 0.32
    assert np.ptp(run["w_2"][after]) < 1e-12
    assert np.diff(run["w_1"][after]) == pytest.approx(1.3 / 2.0 * 5e-3, rel=1e-9)


def test_a_coil_without_a_way_for_its_current_loses_it() -> None:
    """Open, there is none; with a diode it decays with L/R. Columns tell what is on."""
    times = np.linspace(0, 0.06, 61)
    for name in ("coil", "coil with diode"):
        case = CASES[name]
        module = loaded(to_python(bg.derive(case.graph), case.numbers))
        run = module.simulate(times, case.initial, dict(case.inputs), step=2e-4, initially_on=["k"])
        assert (("k", "d") if "diode" in name else ("k",)) == module.SWITCHES
        assert run["k"] == pytest.approx((times < 0.0313).astype(float))
        opened = times > 0.032
        if "diode" in name:
            assert run["d"] == pytest.approx((times > 0.0313).astype(float))
            assert run["i"][opened] == pytest.approx(
                run["i"][opened][0] * np.exp(-(times[opened] - times[opened][0]) / 0.02), rel=1e-6
            )
        else:
            assert abs(run["i"][opened]).max() < 1e-12


def _joined() -> bg.StateEquations:
    """Two masses that a dog joins by the word of an input."""
    nodes = [bg.Se("T", "tau"), bg.One("a"), bg.I("J_1", "J_1", flow="w_1"), bg.Zero("gap"),
             bg.Sw("slack", on="g - 0.5"), bg.One("b"), bg.I("J_2", "J_2", flow="w_2")]  # fmt: skip
    graph = bond_graph(nodes, "T>a>J_1 a>gap>b>J_2 gap>slack")
    return bg.derive(graph)


def test_a_start_is_completed_by_what_is_on(tmp_path: Path) -> None:
    """In Python, in C by steps and by located events; what is told stays, as in the simulator."""
    equations, numbers = _joined(), {"J_1": 2.0, "J_2": 0.7}
    given = {"tau": 0.0, "g": 0.0}
    module = loaded(to_python(equations, numbers))
    with pytest.warns(UserWarning, match=r"follow what switches hold: w_2 = 5"):
        run = module.simulate([0.0, 0.1], {"w_1": 5.0}, given, step=1e-3)
    assert run["w_2"] == pytest.approx([5.0, 5.0], rel=1e-13)
    # Not on, it joins what it finds.
    start = {"w_1": 5.0, "w_2": 0.0}
    run = module.simulate([0.0, 0.1], start, given, step=1e-3, initially_on=["slack"])
    assert run["w_1"] == pytest.approx(10.0 / 2.7, rel=1e-13)
    with pytest.raises(ValueError, match=r"no switch is called 'cog'; there is slack"):
        module.simulate([0.0, 0.1], {}, given, initially_on=["cog"])
    more = {"main": True, "initial": {"w_1": 5.0}, "inputs": {"g": 0.0}}
    program = compiled(tmp_path, written(tmp_path, to_c(equations, numbers, **more)))
    for words in ([], ["located"]):
        rows = _rows(program, *words)
        assert rows[:, 1:3] == pytest.approx(5.0, rel=1e-13), words
        named = _rows(program, *words, "w_2=0.0")
        assert named[:, 1:3] == pytest.approx(10.0 / 2.7, rel=1e-13), words
    with pytest.raises(
        bg.StructureError, match="'cog' is no switch of this graph; there are 'slack'"
    ):
        to_c(equations, numbers, initially_on=["cog"])


@pytest.mark.parametrize("words", [(), ("located",)])
def test_the_main_program_tells_of_a_start_that_was_completed(
    words: tuple[str, ...], tmp_path: Path
) -> None:
    """Once, on the error stream, and not of one whose states are named."""
    more = {"main": True, "initial": {"w_1": 5.0}, "inputs": {"g": 0.0}}
    files = to_c(_joined(), {"J_1": 2.0, "J_2": 0.7}, **more)
    program = compiled(tmp_path, written(tmp_path, files))
    told = []
    for named in ((), ("w_2=5",), ("w_2=0",)):
        line = [str(program), "0.1", "0.05", *words, *named]
        told.append(subprocess.run(line, capture_output=True, text=True, check=True).stderr)
    assert (
        told[0].splitlines()[0] == "states that were not named follow what switches hold: w_2 = 5"
    )
    assert [text.count("follow") for text in told] == [1, 0, 0]


@pytest.mark.parametrize("on", [(), ("relay",)])
def test_between_two_thresholds_a_relay_stays_as_it_was_at_first(
    on: tuple[str, ...], tmp_path: Path
) -> None:
    """From 27, where neither 25 nor 30 is passed: to 12/1.1 with the fan on, to 120 with it off."""
    equations, numbers = bg.derive(CASES["relay"].graph), CASES["relay"].numbers
    rest, rate = (12 / 1.1, 1.1 / 2) if on else (120.0, 0.1 / 2)
    times = np.linspace(0.0, 0.2, 5)
    expected = rest + (27.0 - rest) * np.exp(-rate * times)
    module = loaded(to_python(equations, numbers))
    run = module.simulate(times, {"theta": 27.0}, {"P": 12.0}, step=1e-3, initially_on=on)
    assert run["theta"] == pytest.approx(expected, rel=1e-12)
    assert run["relay"] == pytest.approx(len(on))
    more = {"main": True, "initial": {"theta": 27.0}, "inputs": {"P": 12.0}, "initially_on": on}
    program = compiled(tmp_path, written(tmp_path, to_c(equations, numbers, **more)))
    for how in ("located", "step=1e-3"):
        rows = _rows(program, how, end="0.2")
        assert rows[:, 1] == pytest.approx(expected, rel=1e-9), how
        assert rows[:, -1] == pytest.approx(len(on)), how


def _rows(program: Path, *words: str, end: str = "0.1") -> np.ndarray:
    done = subprocess.run(
        [program, end, "0.05", *words], capture_output=True, text=True, check=True
    )
    return np.array([list(map(float, row.split(","))) for row in done.stdout.splitlines()[1:]])


def test_the_main_program_tells_what_turns_on_and_off(tmp_path: Path) -> None:
    case = CASES["rectifier"]
    more = {"main": True, "initial": case.initial, "inputs": dict(case.inputs)}
    files = to_c(bg.derive(case.graph), case.numbers, **more)
    program = compiled(tmp_path, written(tmp_path, files))
    done = subprocess.run(
        [program, "0.04", "0.001", "located"], capture_output=True, text=True, check=True
    )
    told = re.findall(r"^(\S+),d,(\w+),0$", done.stderr, re.MULTILINE)
    assert [kind for _, kind in told] == ["on", "off", "on", "off"]
    ready = simulator(bg.derive(case.graph), case.numbers)
    events = ready.run([0.0, 0.04], case.initial, {"u": Sine(10, 50)}).events
    assert [float(t) for t, _ in told] == pytest.approx([event.time for event in events], abs=1e-9)


def test_the_longest_stable_step_is_of_every_mode() -> None:
    """Held, the switch leaves a rate of 1/(R_2 C) alone; let go, R_1 is beside: 1/(R C)."""
    nodes = [bg.Se("s", "E"), bg.One("w"), bg.Sw("k", on="g - 0.5"), bg.R("R_1", "R_1"), bg.Zero("n"),
             bg.C("c", "C", effort="v"), bg.R("R_2", "R_2")]  # fmt: skip
    graph = bond_graph(nodes, "s>w>k w>R_1 w>n n>c n>R_2")
    text = to_python(bg.derive(graph), {"R_1": 0.5, "R_2": 2.0, "C": 1e-3})
    module = loaded(text)
    assert pytest.approx(2.785293563405282 / (2500.0), rel=1e-5) == module.LONGEST_STEP
    given = {"E": 1.0, "g": lambda t: float(t > 0.02)}
    with pytest.raises(
        module.UnstableStep, match=r"at t = 0\.02\d* a step of 0\.00149\d* s is beyond"
    ):
        module.simulate([0.0, 0.1], {}, given, step=1.5e-3)
    module.simulate([0.0, 0.02], {}, given, step=1.5e-3)


def test_where_no_mode_is_consistent_the_switches_are_named(tmp_path: Path) -> None:
    """A relay without hysteresis that its own effect turns back; a step that fails changes nothing."""
    nodes = [bg.Se("E", "U"), bg.One("w"), bg.Sw("k", on="1 - 2*e_R"), bg.R("R", 2, effort="e_R"),
             bg.I("L", 1, flow="i")]  # fmt: skip
    graph = bond_graph(nodes, "E>w>k w>R w>L")
    equations = bg.derive(graph)
    module = loaded(to_python(equations, {}))
    with pytest.raises(module.EvaluationError, match=r"at t = 0 no mode of k is consistent"):
        module.simulate([0.0, 0.1], {"i": 1.0}, {"U": 1.0})
    pair = Pair(tmp_path, equations, {})
    status, s = pair.c.step(0.0, 1e-3, [1.0], [[1.0]] * 3)
    assert "is consistent" in pair.c.message(status)
    assert s == pytest.approx([1.0])
    assert pair.c.mode() == (0,)


def test_the_exported_program_prints_whether_switches_are_on(tmp_path: Path) -> None:
    """Behind states and outputs 1 and 0, in either way of running; friction has no such column."""
    case = CASES["coil with diode"]
    given = {"initial": case.initial, "inputs": case.inputs, "initially_on": case.on}
    files = to_c(bg.derive(case.graph), case.numbers, name="coil", main=True, **given)
    program = compiled(tmp_path, written(tmp_path, files))
    for how in ("located", "step=1e-4"):
        told = subprocess.run(
            [program, "0.06", "1e-3", how], capture_output=True, text=True, check=True
        )
        head, *rows = told.stdout.splitlines()
        columns = dict(
            zip(head.split(","), np.array([r.split(",") for r in rows], float).T, strict=True)
        )
        assert [*columns][-2:] == ["k", "d"]
        assert columns["k"] == pytest.approx((columns["t"] < 0.0313).astype(float))
        assert columns["d"] == pytest.approx((columns["t"] > 0.0313).astype(float))
    files = to_c(bg.derive(CASES["freewheel"].graph), CASES["freewheel"].numbers, main=True)
    (tmp_path / "other").mkdir()
    program = compiled(tmp_path / "other", written(tmp_path / "other", files))
    told = subprocess.run([program, "0.01", "0.01"], capture_output=True, text=True, check=True)
    assert told.stdout.splitlines()[0] == "t,w_1,w_2,fw"

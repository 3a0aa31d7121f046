"""Fixed steps below and beyond the stability of their method, in exported C and Python and in units."""

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import Pair, compiled, written
from oracles.called import Unit
from oracles.exported import loaded
from oracles.stiff import STIFF, Stiff, amplification, first_unstable
from references.build import bond_graph

import bondgraph as bg
from codegen import to_c, to_python
from codegen.modes.stability import stable_step

COUNT = 600
"""So many steps until all is at rest that comes to rest."""

PROMPT = 4
"""In so many steps what is beyond the limit from the start is told."""

BELOW, BEYOND = (0.5, 0.9), (1.1, 2.0)


@pytest.fixture(scope="module", params=STIFF)
def stiff(request: pytest.FixtureRequest) -> Stiff:
    return STIFF[str(request.param)]()


@pytest.fixture(scope="module")
def pair(stiff: Stiff, tmp_path_factory: pytest.TempPathFactory) -> Pair:
    case = stiff.case
    return Pair(tmp_path_factory.mktemp("stiff"), case.equations, case.parameters, case.laws)


def _close(stiff: Stiff, found: dict[str, float], h: float, count: int) -> None:
    expected = stiff.expected(h, count)
    largest = max(map(abs, expected.values()))
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=0, abs=stiff.near * largest), name


def _in_c(stiff: Stiff, pair: Pair, h: float, count: int):
    """Status, steps taken and states by name."""
    pair.at(stiff.case.parameters)
    names = [name.name for name in pair.program.states]
    w = [stiff.case.inputs[name.name] for name in pair.program.external]
    s = pair.c.vector(0.0, [stiff.case.initial.get(name, 0.0) for name in names], w)
    for k in range(count):
        status, s = pair.c.step(k * h, h, s, [w] * 3)
        if status:
            return status, k, dict(zip(names, s, strict=True))
    return 0, count, dict(zip(names, s, strict=True))


@pytest.mark.parametrize("part", BELOW)
def test_c_steps_below_the_limit_and_is_right(stiff: Stiff, pair: Pair, part: float) -> None:
    h = part * stiff.longest
    status, _, found = _in_c(stiff, pair, h, COUNT)
    assert status == 0, pair.c.message(status)
    _close(stiff, found, h, COUNT)


@pytest.mark.parametrize("part", BEYOND)
def test_c_tells_a_step_beyond_the_limit_before_numbers_explode(
    stiff: Stiff, pair: Pair, part: float
) -> None:
    status, taken, found = _in_c(stiff, pair, part * stiff.longest, COUNT)
    assert "beyond the stability" in pair.c.message(status)
    assert taken <= PROMPT
    assert pair.c.longest() == pytest.approx(stiff.longest, rel=0.02)
    assert max(map(abs, found.values())) < 100


def test_a_shorter_step_goes_on_from_where_one_was_refused(stiff: Stiff, pair: Pair) -> None:
    _in_c(stiff, pair, 2 * stiff.longest, COUNT)
    names = [name.name for name in pair.program.states]
    w = [stiff.case.inputs[name.name] for name in pair.program.external]
    s = np.array([stiff.case.initial.get(name, 0.0) for name in names])
    h = 0.9 * stiff.longest
    for k in range(COUNT):
        status, s = pair.c.step(k * h, h, s, [w] * 3)
        assert status == 0, pair.c.message(status)
    _close(stiff, dict(zip(names, s, strict=True)), h, COUNT)


@pytest.fixture(scope="module")
def module(stiff: Stiff):
    case = stiff.case
    text = to_python(
        case.equations, case.parameters, case.laws, initial=case.initial, inputs=case.inputs
    )
    return loaded(text)


@pytest.mark.parametrize("part", BELOW)
def test_python_steps_below_the_limit_and_is_right(stiff: Stiff, module, part: float) -> None:
    h = part * stiff.longest
    run = module.simulate([0.0, COUNT * h], stiff.case.initial, stiff.case.inputs, step=h)
    _close(stiff, {name: run[name][-1] for name in module.STATES}, h, COUNT)


@pytest.mark.parametrize("part", BEYOND)
def test_python_names_time_step_and_the_longest_that_is_stable(
    stiff: Stiff, module, part: float
) -> None:
    h = part * stiff.longest
    with pytest.raises(
        module.UnstableStep, match=f"at t = .* a step of {h:g} s is beyond"
    ) as found:
        module.simulate([0.0, 200 * h], stiff.case.initial, stiff.case.inputs, step=h)
    assert isinstance(found.value, ArithmeticError)
    at, longest = re.search(r"t = (\S+) .* step is (\S+) s", str(found.value)).groups()
    assert float(at) <= PROMPT * h
    assert float(longest) == pytest.approx(stiff.longest, rel=0.02)


def test_the_longest_step_at_the_start_stands_in_what_is_exported(stiff: Stiff, module) -> None:
    case = stiff.case
    given = {"initial": case.initial, "inputs": case.inputs}
    text = to_c(case.equations, case.parameters, case.laws, **given)["config.h"]
    told = float(re.search(r"BG_LONGEST_STEP (\S+)", text)[1])
    assert told == pytest.approx(stiff.longest, rel=1e-5)
    assert told == module.LONGEST_STEP
    assert 0 < module.STEP <= min(1e-4, told / 2)


UNITS = (("wheel", "2.0"), ("wheel", "3.0"), ("chain", "3.0"), ("clutch", "2.0"))


@pytest.mark.usefixtures("compiled_quickly")
@pytest.mark.parametrize(("name", "version"), UNITS)
def test_units_step_below_the_limit_and_refuse_beyond_it(
    name: str, version: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    stiff = STIFF[name]()
    unit = Unit(stiff.case, version, tmp_path, inputs=stiff.case.inputs)
    usual = unit.description.defaultExperiment.stepSize
    assert float(usual) <= stiff.longest / 2
    for part in BELOW:
        h = part * stiff.longest
        made = unit.started("CoSimulation", fixed_internal_step=h)
        made.doStep(currentCommunicationPoint=0.0, communicationStepSize=COUNT * h)
        states = [symbol.name for symbol in stiff.case.equations.states]
        found = dict(zip(states, unit.get(made, *states), strict=True))
        _close(stiff, found, h, COUNT)
        unit.free(made)
    for part in BEYOND:
        h = part * stiff.longest
        made = unit.started("CoSimulation", fixed_internal_step=h)
        capsys.readouterr()
        with pytest.raises(Exception, match=r"(?i)dostep"):
            made.doStep(currentCommunicationPoint=0.0, communicationStepSize=COUNT * h)
        told = re.search(r"at t = (\S+) an internal step of (\S+) s is beyond.* one is (\S+) s",
                         capsys.readouterr().out)  # fmt: skip
        assert float(told[1]) <= PROMPT * h
        assert float(told[2]) == pytest.approx(h, rel=1e-5)
        assert float(told[3]) == pytest.approx(stiff.longest, rel=0.02)
        unit.free(made)


def test_in_each_mode_its_own_limit(tmp_path: Path) -> None:
    """Locked, both inertias are on the shaft: steps are stable that a slipping clutch forbids.

    Longer ones are not: those are refused locked, too.
    """
    stiff = STIFF["clutch"]()
    case = stiff.case
    locked = np.array([[-6.0 / 0.45, -1.0 / 0.45], [2000.0, 0.0]])
    h = 0.9 * first_unstable(locked)
    assert h > 1.1 * stiff.longest
    pair = Pair(tmp_path, case.equations, case.parameters, case.laws)
    s = np.zeros(3)
    for k in range(400):
        status, s = pair.c.step(k * h, h, s, [[20.0]] * 3)
        assert status == 0, pair.c.message(status)
    assert pair.c.mode() == (0,)
    status, _ = pair.c.step(400 * h, 1.1 * first_unstable(locked), s, [[20.0]] * 3)
    assert "beyond the stability" in pair.c.message(status)
    assert pair.c.mode() == (0,)
    for k in range(400, 405):
        status, s = pair.c.step(k * h, h, s, [[200.0]] * 3)
        if status:
            break
    assert "beyond the stability" in pair.c.message(status)


@pytest.mark.parametrize("h", [0.0, -1e-3, float("nan"), float("inf")])
def test_a_step_is_a_positive_number(pair: Pair, module, stiff: Stiff, h: float) -> None:
    status, _, _ = _in_c(stiff, pair, h, 1)
    assert "positive finite number" in pair.c.message(status)
    with pytest.raises(ValueError, match="a step must be a positive finite number"):
        module.simulate([0.0, 1.0], stiff.case.initial, stiff.case.inputs, step=h)
    model = module.Model()
    w = [stiff.case.inputs[name] for name in model.names.external]
    at = np.array(w), np.zeros(len(w))
    s = np.array([stiff.case.initial.get(name, 0.0) for name in module.STATES])
    mode = model.decided(module.Point(0.0, s, *at), None, 1e-6)
    with pytest.raises(ValueError, match="a step must be a positive finite number"):
        model.step(0.0, h, s, [at] * 3, mode)


def test_the_check_can_be_left_out_when_compiling(tmp_path: Path) -> None:
    """Then a step beyond the limit is taken, and what it gives is no number in the end."""
    case = STIFF["chain"]().case
    files = to_c(case.equations, case.parameters, main=True, inputs={"F": 7.0})
    program = compiled(tmp_path, written(tmp_path, files), "-DBG_CHECK_STEP=0")
    h = 1.1 * STIFF["chain"]().longest
    done = subprocess.run(
        [program, repr(40 * h), repr(h)], capture_output=True, text=True, check=True
    )
    assert abs(float(done.stdout.splitlines()[-1].split(",")[1])) > 1e6
    checked = compiled(tmp_path, written(tmp_path, files), to="checked")
    done = subprocess.run(
        [checked, repr(40 * h), repr(h)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert re.search(
        r"step=\S+; the longest stable one is \S+\n.*beyond the stability", done.stderr
    )


def test_the_longest_step_of_a_rate_is_on_the_boundary_of_stability() -> None:
    assert stable_step(-4.0) == pytest.approx(2.785293563405282 / 4, rel=1e-12)
    assert stable_step(-4j) == pytest.approx(np.sqrt(8) / 4, rel=1e-12)
    for angle in np.linspace(np.pi / 2 + 0.01, np.pi, 50):
        rate = 7 * np.exp(1j * angle)
        assert abs(amplification(stable_step(rate) * rate)) == pytest.approx(1, abs=1e-9)


@pytest.mark.parametrize(
    "law", ["sign(v)*sqrt(Abs(v))", "3*sign(v)", "Max(v, 0)", "20*Max(v - 1e-3, 0)"]
)
def test_what_jumps_is_no_fast_rate(law: str, tmp_path: Path) -> None:
    """Infinite slopes and kinks that no step could be short enough for are stepped over, from rest, too."""
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.R("r", law=law)]
    pair = Pair(tmp_path, bg.derive(bond_graph(nodes, "push>n>m n>r")), {"m": 1.0})
    for force in (0.0, 1.0):
        pair.at({"m": 1.0})
        s = np.zeros(1)
        for k in range(300):
            status, s = pair.c.step(k * 1e-2, 1e-2, s, [[force]] * 3)
            assert status == 0, pair.c.message(status)
        assert abs(s[0]) <= 3.1

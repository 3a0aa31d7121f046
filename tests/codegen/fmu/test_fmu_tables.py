"""Tables of units: their values are parameters, between which is what scipy's interpolators have."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from fmpy import validation
from oracles.called import Unit
from oracles.tuned import END, LEAVES, NUMBERS, PUSH, START, VALUES, dragged, mapped, speed
from oracles.units import Case
from references.build import bond_graph
from references.interpolated import METHODS, interpolated, off, random_table

import bondgraph as bg
import codegen
from codegen.tuning import TUNING

VERSIONS = ["2.0", "3.0"]
KINDS = ["CoSimulation", "ModelExchange"]
Array = np.ndarray

pytestmark = pytest.mark.usefixtures("compiled_quickly")


def _unit(equations: bg.StateEquations, version: str, folder: Path, **more: object) -> Unit:
    case = Case(equations, NUMBERS if more else {}, None, {}, {}, END)
    return Unit(case, version, folder, **more)


def _put(unit: Unit, made, name: str, values: Array) -> None:
    """The values of a table, at once or one by one."""
    if unit.version == "3.0":
        made.setFloat64([unit.at[name]], np.ravel(values).tolist())
    else:
        places = np.ndindex(np.shape(values))
        names = [f"{name}[{','.join(str(at + 1) for at in place)}]" for place in places]
        made.setReal([unit.at[one] for one in names], np.ravel(values).tolist())


def _got(unit: Unit, made, name: str, values: Array) -> list[float]:
    if unit.version == "3.0":
        return list(made.getFloat64([unit.at[name]], np.size(values)))
    places = np.ndindex(np.shape(values))
    names = [f"{name}[{','.join(str(at + 1) for at in place)}]" for place in places]
    return list(made.getReal([unit.at[one] for one in names]))


def _walked(unit: Unit, made, begin: float, end: float, count: int = 10) -> Array:
    """Speeds at the ends of communication steps."""
    times, found = np.linspace(begin, end, count + 1), []
    for t, later in pairwise(times):
        made.doStep(currentCommunicationPoint=t, communicationStepSize=later - t)
        found.append(unit.get(made, "v")[0])
    return np.array(found)


@pytest.fixture(scope="module", params=VERSIONS)
def pushed(request: pytest.FixtureRequest, tmp_path_factory, compiled_quickly: None) -> Unit:
    folder = tmp_path_factory.mktemp("pushed")
    return _unit(dragged(), request.param, folder, initial=START, inputs={})


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("method", METHODS)
def test_between_values_that_are_set_is_what_scipy_has(
    method: str, version: str, tmp_path: Path
) -> None:
    """They are got as they were set; so are axes, which FMI 2.0 has no arrays for."""
    _, (*axes, z) = random_table(method, "hold")
    path = codegen.write_fmu(tmp_path / "map.fmu", mapped(method, *axes), {}, version=version)
    assert validation.validate_fmu(str(path)) == []
    unit = _unit(mapped(method, *axes), version, tmp_path)
    made, rng = unit.started("ModelExchange"), np.random.default_rng(6)
    made.enterEventMode()
    _put(unit, made, "map", z)
    assert _got(unit, made, "map", z) == z.ravel().tolist()
    if version == "3.0":
        for letter, axis in zip("xy", axes, strict=False):
            assert list(made.getFloat64([unit.at[f"map.{letter}"]], len(axis))) == axis.tolist()
    made.enterContinuousTimeMode()
    places = [rng.uniform(axis[0] - 1, axis[-1] + 1, 100) for axis in axes]
    beside = places[-1] if len(places) == 2 else np.zeros(100)
    found = []
    for v, u in zip(places[0], beside, strict=True):
        unit.put(made, u=u)
        made.setContinuousStates((np.ctypeslib.ctypes.c_double * 1)(v), 1)
        found.append(unit.get(made, "der(v)")[0] - u)
    right = interpolated(method, "hold", [*axes, z], places, (0,) * len(axes))
    assert off(np.array(found), right) < 1e-12
    unit.free(made)


def test_corners_that_values_make_are_located(pushed: Unit) -> None:
    """The table is flat where the unit is written."""
    made = pushed.started("CoSimulation", **PUSH)
    assert _walked(pushed, made, 0.0, END)[-1] == pytest.approx(4 * END - 1, abs=1e-9)
    pushed.free(made)
    made = pushed.started("CoSimulation", **PUSH)
    _put(pushed, made, "drag", np.array(VALUES))
    times = np.linspace(0, END, 11)[1:]
    assert _walked(pushed, made, 0.0, END) == pytest.approx(speed(times), abs=1e-9)
    pushed.free(made)


def test_values_may_be_tuned_between_steps(pushed: Unit) -> None:
    """From rest at 1/4 on as under the other table."""
    made = pushed.started("CoSimulation", **PUSH)
    assert _walked(pushed, made, 0.0, 0.25)[-1] == pytest.approx(0.0, abs=1e-12)
    _put(pushed, made, "drag", np.array(VALUES))
    times = np.linspace(0.25, 1.25, 11)[1:]
    right = -PUSH["P"] * np.expm1(-(times - 0.25))
    assert _walked(pushed, made, 0.25, 1.25) == pytest.approx(right, abs=1e-9)
    pushed.free(made)


def test_values_are_saved_and_an_instances_own(pushed: Unit) -> None:
    save, load, pack, unpack = (
        ("getFMUstate", "setFMUstate", "serializeFMUstate", "deSerializeFMUstate")
        if pushed.version == "2.0"
        else ("getFMUState", "setFMUState", "serializeFMUState", "deserializeFMUState")
    )
    made, other = (pushed.started("CoSimulation", **PUSH) for _ in range(2))
    _put(pushed, made, "drag", np.array(VALUES))
    first = _walked(pushed, made, 0.0, 1.0)
    state = getattr(made, save)()
    later = _walked(pushed, made, 1.0, 2.0)
    assert _walked(pushed, other, 0.0, 1.0)[-1] == pytest.approx(3.0, abs=1e-9)
    _put(pushed, made, "drag", np.zeros(4))
    assert not np.allclose(_walked(pushed, made, 2.0, 2.4), later[:10])
    getattr(made, load)(state)
    assert np.array_equal(_walked(pushed, made, 1.0, 2.0), later)
    getattr(other, load)(getattr(other, unpack)(getattr(made, pack)(state)))
    assert _got(pushed, other, "drag", np.zeros(4)) == list(VALUES)
    assert np.array_equal(_walked(pushed, other, 1.0, 2.0), later)
    assert first[-1] == pytest.approx(speed(1.0), abs=1e-9)
    made.reset()
    assert _got(pushed, made, "drag", np.zeros(4)) == [0.0] * 4
    made.freeInstance()
    pushed.free(other)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_what_is_no_number_is_refused_by_name(
    bad: float, pushed: Unit, capfd: pytest.CaptureFixture[str]
) -> None:
    made = pushed.started("CoSimulation", **PUSH)
    with pytest.raises(Exception, match=r"(?i)set(Real|Float64)"):
        _put(pushed, made, "drag", np.array([1.0, 2.0, bad, 3.0]))
    assert f"table drag, row 3: {bad:g} is not finite" in capfd.readouterr().out
    assert np.isfinite(_got(pushed, made, "drag", np.zeros(4))).all()
    pushed.free(made)


def test_an_array_is_given_whole(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    unit = _unit(dragged(), "3.0", tmp_path, initial=START, inputs={})
    made = unit.started("CoSimulation")
    for count in (3, 5):
        with pytest.raises(Exception, match="Float64"):
            made.setFloat64([unit.at["drag"]], [1.0] * count)
        assert "as many values as the variables have" in capfd.readouterr().out
    with pytest.raises(Exception, match="Float64"):
        made.setFloat64([unit.at["drag.x"]], [1.0] * 4)
    assert "the axes of a table cannot be set" in capfd.readouterr().out
    made.setFloat64([unit.at["P"], unit.at["drag"], unit.at["m"]], [4.0, *VALUES, 1.0])
    assert made.getFloat64([unit.at["m"], unit.at["drag"], unit.at["P"]], 6) == [1.0, *VALUES, 4.0]
    unit.free(made)


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("step", [0.0, 1e-3])
def test_a_table_that_is_left_is_named(
    step: float, version: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    unit = _unit(dragged("refuse"), version, tmp_path, initial=START, inputs={})
    made = unit.started("CoSimulation", fixed_internal_step=step, **PUSH)
    _put(unit, made, "drag", np.array(VALUES))
    with pytest.raises(Exception, match="DoStep"):
        _walked(unit, made, 0.0, END)
    told = capfd.readouterr().out
    assert "w leaves table 'drag', which is from -2 to 3 and refuses what is outside" in told
    at = float(told.partition("at t = ")[2].split()[0])
    assert at == pytest.approx(LEAVES, abs=2e-3)
    made.freeInstance()


@pytest.mark.parametrize("version", VERSIONS)
def test_so_it_is_in_model_exchange(
    version: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    unit = _unit(dragged("refuse", VALUES), version, tmp_path, initial=START, inputs={})
    made = unit.started("ModelExchange", **PUSH)
    made.setTime(0.5)
    made.setContinuousStates((np.ctypeslib.ctypes.c_double * 1)(3.25), 1)
    with pytest.raises(Exception, match=r"Get(Real|Float64)"):
        unit.get(made, "der(v)")
    says = "at t = 0.5 w leaves table 'drag', which is from -2 to 3 and refuses what is outside"
    assert says in capfd.readouterr().out
    made.freeInstance()


def test_there_are_no_slopes_by_values(pushed: Unit, capfd: pytest.CaptureFixture[str]) -> None:
    made = pushed.started("CoSimulation", **PUSH)
    name = "drag" if pushed.version == "3.0" else "drag[1]"
    with pytest.raises(Exception, match="DirectionalDerivative"):
        pushed.slopes(made, ["der(v)"], [name], [1.0])
    assert "no derivatives by the values of tables" in capfd.readouterr().out
    pushed.free(made)


def test_of_many_values_fmi_2_lists_none(tmp_path: Path) -> None:
    """A unit for which there is no array has no name for each of thousands."""
    axis = np.arange(TUNING.most_scalars + 1.0)
    names = {}
    for version in VERSIONS:
        unit = _unit(mapped("linear", axis), version, tmp_path)
        names[version] = {name for name in unit.at if name.startswith("map")}
    assert names == {"2.0": set(), "3.0": {"map", "map.x"}}


@pytest.mark.parametrize("version", VERSIONS)
def test_a_law_that_never_gives_this_is_named(
    version: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """A mass of the speed ``exp(p) - 1`` is driven to -2."""
    nodes = [bg.Se("T", "T"), bg.One("n"), bg.I("J", 1),
             bg.I("m", law="exp(p_m) - 1", flow="w", priority=-1)]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "T>n>J n>m"))
    unit = Unit(Case(equations, {}, None, {}, {}, END), version, tmp_path)
    made = unit.started("ModelExchange", T=-1.0)
    made.setTime(0.5)
    made.setContinuousStates((np.ctypeslib.ctypes.c_double * 1)(-2.0), 1)
    with pytest.raises(Exception, match=r"Get(Real|Float64)"):
        unit.get(made, "der(w)")
    says = "at t = 0.5 w + 1 leaves what is above 0: the law of 'm' gives it in no state"
    assert says in capfd.readouterr().out
    made.freeInstance()

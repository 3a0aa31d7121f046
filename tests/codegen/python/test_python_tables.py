"""Tables of exported Python: other values in them, and what is told where one is left."""

import re

import numpy as np
import pytest
from oracles.exported import loaded
from oracles.tuned import END, LEAVES, NUMBERS, PUSH, START, VALUES, dragged, mapped, speed
from references.interpolated import METHODS, interpolated, off, random_table

import codegen

TIMES = np.linspace(0, END, 51)


@pytest.mark.parametrize("integrator", ["rk4", "rosenbrock"])
def test_a_run_takes_other_values(integrator: str) -> None:
    module = loaded(codegen.to_python(dragged(), NUMBERS, integrator=integrator))
    given = {"initial": START, "inputs": PUSH, "step": 1e-2}
    run = module.simulate(TIMES, tables={"drag": VALUES}, **given)
    assert run["v"] == pytest.approx(speed(TIMES), abs=1e-4)
    assert module.simulate(TIMES, **given)["v"] == pytest.approx(4 * TIMES - 1, abs=1e-9)


@pytest.mark.parametrize("method", METHODS)
def test_between_them_is_what_scipy_has(method: str) -> None:
    _, parts = random_table(method, "hold")
    module = loaded(codegen.to_python(mapped(method, *parts[:-1]), {}))
    model, rng = module.Model(tables={"map": parts[-1]}), np.random.default_rng(5)
    places = [rng.uniform(axis[0] - 1, axis[-1] + 1, 200) for axis in parts[:-1]]
    beside = places[-1] if len(places) == 2 else np.zeros(200)
    found = [model.rhs(0.0, [v], [u])[0] - u for v, u in zip(places[0], beside, strict=True)]
    right = interpolated(method, "hold", parts, places, (0,) * len(places))
    assert off(np.array(found), right) < 1e-12


@pytest.mark.parametrize("integrator", ["rk4", "rosenbrock"])
def test_a_table_that_is_left_is_named(integrator: str) -> None:
    text = codegen.to_python(dragged("refuse", VALUES), NUMBERS, integrator=integrator)
    says = (
        r"at t = (\S+) w leaves table 'drag', which is from -2.0 to 3.0 and refuses what is outside"
    )
    with pytest.raises(ArithmeticError, match=says) as failure:
        loaded(text).simulate(TIMES, START, PUSH, step=1e-2)
    told = re.match(says, str(failure.value))
    assert told is not None
    assert float(told[1]) == pytest.approx(LEAVES, abs=2e-2)


@pytest.mark.parametrize(
    ("tables", "says"),
    [
        ({"drag": [1, 2, 3]}, r"table 'drag' has \(4,\) values, not \(3,\)"),
        ({"drag": [1, 2, np.inf, 3]}, r"table 'drag': the value at \(3,\), from 1, is not finite"),
        ({"lift": [1]}, r"no table is called 'lift'; there is drag"),
    ],
)
def test_wrong_values_are_refused_by_name(tables: dict[str, list[float]], says: str) -> None:
    module = loaded(codegen.to_python(dragged(), NUMBERS))
    with pytest.raises(ValueError, match=says):
        module.Model(tables=tables)

"""Linear models with rates and spans over twelve decades, against exponentials in 60 digits and more."""

from collections.abc import Callable
from time import perf_counter

import numpy as np
import pytest
from references.stiff_linear import Linear, random_linear
from soak.families import seeds

import bondgraph as bg
from codegen import simulator

BACKENDS = ("numpy", "c")
SAMPLES = 101
LOOKED_AT = (1, 10, 100)


def _errors(model: Linear, found: "dict[str, np.ndarray]", times: np.ndarray) -> float:
    """The largest error of a state, over what is allowed: its range times 1e-9, or the phase that is lost;
    and units in the last place of what hardly changes."""
    right = np.array([list(model.start.values()), *(model.at(float(times[k])) for k in LOOKED_AT)])
    allowed = max(1e-9, 1e-15 * model.turning * model.span) * np.ptp(right, axis=0)
    allowed += 16 * np.spacing(np.abs(right).max(axis=0))
    got = np.array([found[name][list(LOOKED_AT)] for name in model.states]).T
    return float((np.abs(got - right[1:]) / np.maximum(allowed, 1e-300)).max())


@pytest.mark.parametrize("seed", seeds("stiff-linear"))
def test_states_are_the_exponential(
    seed: int, record_property: Callable[[str, object], None]
) -> None:
    model = random_linear(seed)
    equations = bg.derive(model.graph)
    times = np.linspace(0.0, model.span, SAMPLES)
    for backend in BACKENDS:
        ready = simulator(equations, model.parameters, backend=backend)
        began = perf_counter()
        run = ready.run(times, model.start, {"F": model.signal}, method="exact")
        record_property(f"{backend}_seconds", perf_counter() - began)
        worst = _errors(model, {name: run[name] for name in model.states}, times)
        record_property(f"{backend}_error", worst)
        assert run.backend == backend
        assert worst <= 1, f"{model.family}, {backend}: {worst:.3g} times what is allowed"

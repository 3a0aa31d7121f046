"""A sweep tells once of switches that stay on while their commands rest at zero."""

import re
import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Family, Sine, Step, Swept, final, peak, sweep
from codegen.batch.asked import Asked
from codegen.batch.batch import batch
from codegen.runs.track import Settings

T = np.linspace(0.0, 2.0, 5)
BACKENDS = ["numpy", "c"]
MEASURES = {"v": final("v"), "most": peak("v")}


def _switched(on: str) -> bg.StateEquations:
    """A capacitor of 1 that a switch joins to a source of 1, each by a resistance of 1."""
    nodes = [bg.Se("u", 1), bg.One("l"), bg.R("R", "r"), bg.Sw("s", on=on), bg.Zero("n"),
             bg.C("C", 1, effort="v"), bg.R("Rl", 1)]  # fmt: skip
    return bg.derive(bond_graph(nodes, "u>l l>R l>s l>n n>C n>Rl"))


def _warned(*given: Any, **more: Any) -> list[warnings.WarningMessage]:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        sweep(*given, progress=False, workers=0, **more)
    return told


def _stops(size: float) -> Any:
    """1 until t = 1, then 1 - size."""
    return Constant(1.0) + size * Step(1.0, -1.0)


@pytest.mark.parametrize("backend", BACKENDS)
def test_it_is_told_once_with_the_first_run_and_how_many(backend: str) -> None:
    """A gate of 1 falls by the size: to -1 it turns off, to 0 it stays; the resistance changes nothing."""
    family = Family(_switched("gate"), {"r": 1}, backend=backend)
    inputs = {"gate": Swept("size", Step(1.0, 1.0))}
    grid = {"r": [1.0, 2.0], "size": [0.0, 1.0, -1.0]}
    # On at first: until t = 1 the gate rests at zero in every run.
    [one] = _warned(family, grid, T, MEASURES, inputs=inputs, initially_on=["s"])
    assert one.filename == __file__
    assert "in 6 of 6 runs switch 's' stays on while its command gate rests at zero" in str(
        one.message
    )
    assert "first in run 0 from t = 0 on" in str(one.message)
    assert not _warned(family, grid, T, MEASURES, inputs=inputs)
    # A gate of 1, whose level a swept input has: 0 in the second and the last of four runs.
    rows = [{"gate": g, "r": r} for g, r in ((1.0, 1.0), (0.0, 1.0), (-1.0, 2.0), (0.0, 2.0))]
    [one] = _warned(family, rows, T, MEASURES, initially_on=["s"])
    assert "in 2 of 4 runs switch 's'" in str(one.message)
    assert "first in run 1 from t = 0 on" in str(one.message)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize(
    ("inputs", "where"),
    [
        (lambda values: {"gate": _stops(values["size"])}, "in 1 of 3 runs .* first in run 1 from t = 1 on"),
        (lambda values: {"gate": Step(values["size"], -1.0, 1.0)}, None),
        (lambda values: 1 / 0, None),
    ],
    ids=["rests in one", "turns off", "has no inputs"],
)  # fmt: skip
def test_inputs_by_a_function_are_looked_at_run_by_run(
    backend: str, inputs: Callable[[Mapping[str, float]], Any], where: str | None
) -> None:
    """What a function gives in a run is what is looked at."""
    family = Family(_switched("gate"), {"r": 1}, backend=backend)
    told = _warned(family, {"size": [0.5, 1.0, 2.0]}, T, MEASURES, inputs=inputs)
    if where is None:
        assert not told
    else:
        [one] = told
        assert re.search(where, str(one.message))
        assert one.filename == __file__


def test_a_threshold_that_is_swept_counts() -> None:
    """A gate of 0 and 1 against a level of 0, 1/2 and 1: at 0 it rests on after it falls."""
    family = Family(_switched("gate - level"), {"r": 1, "level": 0.5})
    gate = {"gate": Step(1.0, 0.0, 1.0)}
    [one] = _warned(family, {"level": [0.5, 0.0]}, T, MEASURES, inputs=gate)
    assert "in 1 of 2 runs" in str(one.message)
    assert "first in run 1 from t = 1 on" in str(one.message)
    assert not _warned(family, {"r": [1.0, 2.0]}, T, MEASURES, inputs=gate)


def test_a_pulse_between_samples_is_seen() -> None:
    """On for a hundredth between two samples, and 0 afterwards."""
    family = Family(_switched("gate"), {"r": 1})
    gate = {"gate": Step(0.6, 1.0) + Step(0.61, -1.0)}
    [one] = _warned(family, {"r": [1.0]}, T, MEASURES, inputs=gate)
    assert "first in run 0 from t = 0.61 on" in str(one.message)


def test_a_command_that_only_passes_zero_is_none() -> None:
    family = Family(_switched("gate"), {"r": 1})
    assert not _warned(family, {"r": [1.0]}, T, MEASURES, inputs={"gate": Sine(1.0, 0.5)})


def test_the_loop_in_c_does_these_runs() -> None:
    """So what is told is told of them, too."""
    family = Family(_switched("gate"), {"r": 1}, backend="c")
    inputs = {"gate": Constant(1.0)}
    assert batch(Asked(family, ("r",), T, MEASURES, None, inputs, Settings(), ())) is not None

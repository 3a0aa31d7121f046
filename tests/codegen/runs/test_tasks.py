"""A motor under a sampled PI in numpy, in C and in sweeps, against segments put together by hand."""

import numpy as np
import pytest
from oracles.ticked import END, INSTANTS, NUMBERS, REF, case, check, counter, segments

import codegen

TIMES = {"between instants": np.linspace(0, END, 36), "on each": np.linspace(0, END, 121)}


@pytest.mark.parametrize("times", TIMES.values(), ids=TIMES)
@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize(("method", "within"), [("auto", 1e-12), ("DOP853", 1e-7)])
def test_a_loop_is_what_its_segments_are(
    backend: str, method: str, within: float, times: np.ndarray
) -> None:
    loop = case()
    ready = codegen.simulator(loop.equations, loop.parameters, backend=backend)
    check(ready.run(times, {}, {"ref": REF}, method), times, within)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_sweeps_run_as_one_does(backend: str) -> None:
    """As many as would go side by side if nothing ticked."""
    loop, times = case(), TIMES["between instants"]
    family = codegen.Family(loop.equations, loop.parameters, backend=backend)
    found = codegen.sweep(
        family, codegen.Table(L=[NUMBERS["L"]] * 12), times,
        {"omega": codegen.samples("omega"), "stamp": codegen.samples("stamp")},
        {}, {"ref": REF}, workers=0, progress=False,
    )  # fmt: skip
    assert not found.failed
    right = segments(times)
    assert np.abs(found["omega"] - right["omega"]).max() < 1e-8 * np.ptp(right["omega"])
    assert (found["stamp"] == right["stamp"]).all()


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_starts_and_ends_are_instants(backend: str) -> None:
    made = counter()
    ready = codegen.simulator(made.equations, made.parameters, backend=backend)
    run = ready.run([0.1, 0.25, 0.3], {"v": 3.0}, {"P": 0.0})
    assert run["n"].tolist() == [1, 2, 3]
    assert run["stamp"].tolist() == [0.1, 0.2, 0.3]


def test_the_instants_are_those_of_a_division() -> None:
    """The segments are of these; they are not sums of a period."""
    assert INSTANTS[:4] == (0.01, 0.04, 0.07, 0.1)
    assert len({*INSTANTS} & {*np.cumsum([0.01, *[0.03] * 39])}) < 40

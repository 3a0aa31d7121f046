"""Laws that read what friction and switches give, and that act on neither: every way of running tells them.

A mass with dry friction, pulled by 3/2 at a speed of -1: v' is 5/2 up to v = 0 at 2/5 s, then 1/2, and the
friction is -1, then 1. A state whose rate is a line of it goes down at -1, then up at 3.
"""

import numpy as np
import pytest

import bondgraph as bg
import codegen

TIMES = np.linspace(0.0, 3.0, 31)


def _equations() -> bg.StateEquations:
    nodes = [
        bg.Se("pull", "F"), bg.One("n"), bg.I("m", 1, flow="v"),
        bg.R("rub", law=bg.DryFriction("mu"), effort="e"), bg.State("W", "2*e + 1"),
    ]  # fmt: skip
    return bg.derive(bg.graph(nodes, "pull > n > m, n > rub"))


def _known(t: np.ndarray, mu: float = 1.0) -> np.ndarray:
    leaves = 1 / (1.5 + mu)
    return np.where(t < leaves, (1 - 2 * mu) * t, (1 + 2 * mu) * t - 4 * mu * leaves)


@pytest.mark.parametrize(
    ("backend", "method"),
    [("numpy", "exact"), ("numpy", "DOP853"), ("c", "exact"), ("c", "DOP853")],
)
def test_a_state_whose_rate_reads_friction(backend: str, method: str) -> None:
    ready = codegen.simulator(_equations(), {"mu": 1.0}, backend=backend)
    run = ready.run(TIMES, {"v": -1.0}, {"F": 1.5}, method)
    assert np.abs(run["W"] - _known(TIMES)).max() < 1e-8
    assert [event.kind for event in run.events] == ["cross"]


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_it_is_swept(backend: str) -> None:
    family = codegen.Family(_equations(), {"mu": 1.0}, backend=backend)
    levels = np.linspace(0.2, 1.2, 12)
    found = codegen.sweep(
        family, codegen.Table(mu=levels), TIMES, {"W": codegen.samples("W")}, {"v": -1.0}, {"F": 1.5},
        workers=0, progress=False,
    )  # fmt: skip
    for row, mu in zip(found["W"], levels, strict=True):
        assert np.abs(row - _known(TIMES, mu)).max() < 1e-8


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_what_holds_is_read_as_well(backend: str) -> None:
    """At rest the friction is the pull, 2 t, up to its level; the state has the integral of that."""
    ready = codegen.simulator(_equations(), {"mu": 1.0}, backend=backend)
    run = ready.run(TIMES, inputs={"F": codegen.Ramp(0.0, 2.0)}, method="exact")
    read = np.where(TIMES < 0.5, TIMES**2, TIMES - 0.25)
    assert np.abs(run["W"] - 2 * read - TIMES).max() < 1e-8
    assert [event.kind for event in run.events] == ["slip"]


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_source_behind_a_switch_is_read(backend: str) -> None:
    """A switch turns on at 1 s and puts 2 across a resistance of 4; a state has the current's integral."""
    nodes = [
        bg.Se("battery", "E"), bg.One("wire"), bg.R("r", 4, flow="i"), bg.Sw("key", on="t - 1"),
        bg.State("charge", "3*i"),
    ]  # fmt: skip
    equations = bg.derive(bg.graph(nodes, "battery > wire > r, wire > key"))
    run = codegen.simulator(equations, {}, backend=backend).run(TIMES, inputs={"E": 2.0})
    assert np.abs(run["charge"] - 1.5 * np.maximum(TIMES - 1, 0)).max() < 1e-8

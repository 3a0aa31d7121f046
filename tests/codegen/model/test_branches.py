"""Starts beyond a pole of a law: where the law is turned round on another branch, every route refuses."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from references.build import bond_graph
from scipy.optimize import brentq

import bondgraph as bg
import codegen

NUMBERS = {"k": 1.0, "c_b": 1.0}
TIMES = np.linspace(0.0, 0.5, 6)


def _two(law: str, start: object) -> bg.StateEquations:
    """Two springs on one node: its state is what both give."""
    nodes = [bg.Sf("pump", "Q"), bg.Zero("n"), bg.C("a", law=law, effort="u", start=start),
             bg.C("b", "c_b")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "pump>n>a n>b"))


def _run(equations: bg.StateEquations) -> codegen.Result:
    made = codegen.simulator(equations, NUMBERS, backend="numpy")
    return made.run(TIMES, inputs={"Q": 1.0})


ROUTES: dict[str, Callable[[bg.StateEquations, Path], object]] = {
    "run": lambda equations, _: _run(equations),
    "to_python": lambda equations, _: codegen.to_python(equations, NUMBERS),
    "to_c": lambda equations, _: codegen.to_c(equations, NUMBERS),
    "fmu": lambda equations, path: codegen.write_fmu(path / "a.fmu", equations, NUMBERS),
}


@pytest.mark.parametrize("law", ["k*tan(q_a)", "k*q_a + tan(q_a)"])
@pytest.mark.parametrize("route", ROUTES)
def test_a_start_beyond_the_pole_is_refused_by_name(route: str, law: str, tmp_path: Path) -> None:
    with pytest.raises(bg.ParameterError, match=r"C 'a': it starts at 2, .* along the branch"):
        ROUTES[route](_two(law, 2), tmp_path)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_runs_of_a_sweep_that_start_there_are_refused(backend: str) -> None:
    family = codegen.Family(_two("k*tan(q_a)", "2*k"), NUMBERS | {"k": 0.5}, backend=backend)
    found = codegen.sweep(
        family, codegen.Table(k=[0.5, 1.0]), TIMES, {"end": codegen.final("u")}, inputs={"Q": 1.0},
        workers=0, progress=False,
    )  # fmt: skip
    assert np.isfinite(found["end"][0])
    (failure,) = found.failed
    assert "'a': it starts at 2" in failure.message


@pytest.mark.parametrize(
    ("law", "start", "by_hand"),
    [
        ("k*tan(q_a)", 1.0, np.tan),
        ("1/(k - q_a)", 2.0, lambda q: 1 / (1 - q)),
        ("tanh(k*q_a)", 5.0, np.tanh),
        ("k*q_a + Max(q_a - 1, 0)", 3.0, lambda q: q + max(q - 1, 0)),
    ],
)
def test_a_start_on_the_branch_runs_as_it_is_by_hand(
    law: str, start: float, by_hand: Callable
) -> None:
    """Of one hyperbola both branches are: what is charged in all, q + u, goes on with the time."""
    run = _run(_two(law, start))
    far = {"k*tan(q_a)": 1.57}.get(law, start + 1)
    whole = start + by_hand(start) + TIMES
    states = [
        brentq(lambda q, w=w: q + by_hand(q) - w, start, far, xtol=1e-14) if w > whole[0] else start
        for w in whole
    ]
    assert run["u"] == pytest.approx([by_hand(q) for q in states], abs=1e-8)

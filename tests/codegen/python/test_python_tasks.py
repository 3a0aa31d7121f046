"""Sampled tasks in exported Python: at exact instants, once each, after events there."""

import numpy as np
import pytest
from oracles.exported import loaded
from oracles.ticked import END, INSTANTS, case, check
from references.build import bond_graph

import bondgraph as bg
import codegen

GRIDS = {
    "between instants": np.linspace(0, END, 36),
    "on each of them": np.linspace(0, END, 121),
    "on each, a rounding off": np.cumsum([0.0, *[0.01] * 120]),
    "twice the same": np.sort([*np.linspace(0, END, 25), *INSTANTS, *INSTANTS]),
}


def _module(**more):
    loop = case()
    return loaded(codegen.to_python(loop.equations, loop.parameters, loop.laws, **more))


@pytest.mark.parametrize("times", GRIDS.values(), ids=GRIDS)
def test_a_loop_is_what_its_segments_are(times: np.ndarray) -> None:
    # The step of the source would be late by part of a fixed step.
    early = times[times <= 0.33]
    run = _module().simulate(early, {}, {"ref": 2.0}, step=2e-4)
    check(run, early)


def test_coarse_steps_keep_the_instants() -> None:
    times = np.linspace(0, 0.33, 4)
    run = _module().simulate(times, {}, {"ref": 2.0}, step=0.02)
    assert run["stamp"].tolist() == [0.0, 0.1, 0.22, 0.31]
    check(run, times, within=1e-2)


def test_implicit_steps_do_the_same() -> None:
    times = np.linspace(0, 0.33, 12)
    run = _module(integrator="rosenbrock").simulate(times, {}, {"ref": 2.0}, step=2e-4)
    check(run, times)


def _stamped(*nodes: bg.nodes.elements.Node, bonds: str = "push>n>m", **task: object):
    """A mass, and a controller that keeps what it sees of it and when."""
    every = [
        bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), *nodes,
        bg.Controller("watch", gives={"stamp": "t + 1", "seen": "v"}, **task),
    ]  # fmt: skip
    equations = bg.derive(bond_graph(every, bonds))
    return loaded(codegen.to_python(equations, {"m": 2.0}))


def test_a_start_and_an_end_are_instants() -> None:
    run = _stamped(every="1/10").simulate([0.1, 0.2], {"v": 3.0}, {"P": 0.0}, step=1.0)
    assert run["stamp"].tolist() == [1.1, 1.2]
    assert run["seen"].tolist() == [3.0, 3.0]
    late = _stamped(every="1/10", offset="1/20").simulate([0.1, 0.2], {}, {"P": 0.0}, step=1.0)
    assert late["stamp"].tolist() == [0.0, 0.1 + 0.05 + 1]


def test_a_task_sees_what_an_impact_at_its_instant_leaves() -> None:
    """A mass at -2 m/s is 0.5 m off its bound: it meets it at 0.25 s, and is thrown back at half."""
    stop = bg.Stop("wall", low=0, restitution="1/2")
    module = _stamped(stop, bonds="push>n>m n>wall", every="1/4", offset="1/4")
    run = module.simulate(
        np.linspace(0, 0.5, 3), {"v": -2.0, "q_wall": 0.5}, {"P": 0.0}, step=1 / 64
    )
    assert run["seen"].tolist() == pytest.approx([0.0, 1.0, 1.0])

"""Dry friction that gives a flow: directly on a spring, side by side, two in series; on every route."""

import pickle
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType

import networkx as nx
import numpy as np
import pytest
from oracles.c_model import Pair
from oracles.called import Unit
from oracles.exported import loaded
from oracles.switched_units import SwitchedCase
from references.build import bond_graph

import bondgraph as bg
from codegen import (
    Constant,
    Family,
    Ramp,
    Signal,
    Sine,
    Step,
    event_count,
    final,
    simulator,
    sweep,
    to_c,
    to_python,
    trim,
    write_fmu,
)
from codegen.exports import target
from codegen.numbers.arrays import Array
from codegen.targets import Export

T = np.linspace(0.0, 2.0, 81)
SWAY = 0.7 * np.sin(np.pi * T)
"""What is imposed: a sway [m], by its speed."""

SPEED = Sine(0.7 * np.pi, 0.5, np.pi / 2)
ENGINES = [(backend, method) for backend in ("numpy", "c") for method in ("exact", "DOP853")]


def iwan(sliders: Sequence[str], level: str | None = "N_{}") -> "nx.DiGraph[str]":
    """Springs, each directly on a slider, side by side under an imposed speed; without a level open ports."""
    graph = bond_graph([bg.Sf("speed", "v"), bg.One("j")], "speed>j")
    for one in sliders:
        law = None if level is None else bg.DryFriction(level.format(one))
        graph.add_nodes_from([
            bg.Zero(f"z_{one}"), bg.C(f"k_{one}", f"1/k_{one}", effort=f"F_k_{one}"),
            bg.R(one, effort=f"F_{one}", flow=f"s_{one}", law=law),
        ])  # fmt: skip
        graph.add_edges_from([("j", f"z_{one}"), (f"z_{one}", f"k_{one}"), (f"z_{one}", one)])
    return graph


def play(sway: Array, stiffness: float, level: float) -> Array:
    """The force of a spring on a slider: how far it lags behind, kept within its level.

    Exact where the samples have all turning points (the operator of play has no other memory).
    """
    force, found, last = 0.0, [], sway[0]
    for x in sway:
        force = float(np.clip(force + stiffness * (x - last), -level, level))
        last = x
        found.append(force)
    return np.array(found)


JENKINS = bg.derive(iwan(["a"]))
NUMBERS = {"k_a": 10.0, "N_a": 2.0}
LATER = bg.derive(iwan(["a"], None))
"""The same with an open port, over which its law is put later."""

BARE = bg.derive(iwan(["a"], None), outputs=[])

FRICTION = {"a": bg.DryFriction("N_a")}
RIGHT = play(SWAY, 10.0, 2.0)
LAG = np.arcsin(0.3 / 0.7) / np.pi
EVENTS = [(np.arcsin(0.2 / 0.7) / np.pi, "slip"), (0.5, "stick"), (1 - LAG, "slip"),
          (1.5, "stick"), (2 - LAG, "slip")]  # fmt: skip
"""It first slips where the sway is 0.2, then 0.4 after each turn."""

EARLY = int(np.searchsorted(T, 1.0)) + 1
"""So many samples have its first slip, its first turn and its slip back."""


def test_it_takes_the_causality_that_the_spring_leaves() -> None:
    assert list(map(str, JENKINS.states)) == ["F_k_a"]
    assert list(map(str, JENKINS.inputs)) == ["v", "s_a"]
    assert not any(JENKINS.E)
    assert not any(JENKINS.G)


@pytest.mark.parametrize(("backend", "method"), ENGINES)
def test_a_slider_on_a_spring_is_the_operator_of_play(backend: str, method: str) -> None:
    ready = simulator(JENKINS, NUMBERS, backend=backend)
    run = ready.run(T, {}, {"v": SPEED}, method, 1e-11, 1e-13)
    assert run.backend == backend
    assert run["F_a"] == pytest.approx(RIGHT, abs=1e-9)
    assert [(event.port, event.kind) for event in run.events] == [("a", kind) for _, kind in EVENTS]
    assert [event.time for event in run.events] == pytest.approx([t for t, _ in EVENTS], abs=1e-9)
    moving = np.where(np.abs(RIGHT) == 2.0, 0.7 * np.pi * np.cos(np.pi * T), 0.0)
    away = np.min(np.abs(T[:, None] - np.array([t for t, _ in EVENTS])), axis=1) > 1e-6
    assert run["s_a"][away] == pytest.approx(moving[away], abs=1e-9)
    assert set(run) == {"F_k_a", "v", "e_speed", "F_a", "s_a"}
    audit = run.audit()
    assert abs(audit.residual) < 1e-9 * audit.turned_over
    # It slips by 0.5, 1 and 0.3 m.
    assert audit.lost["a"] == pytest.approx(2.0 * 1.8, rel=1e-9)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_sliders_side_by_side_are_sums_of_plays(backend: str) -> None:
    """Iwan's model: three springs and levels, each by itself."""
    numbers = {"k_a": 10.0, "N_a": 2.0, "k_b": 4.0, "N_b": 1.8, "k_c": 7.0, "N_c": 0.0}
    run = simulator(bg.derive(iwan("abc")), numbers, backend=backend).run(T, {}, {"v": SPEED})
    total = sum(play(SWAY, numbers[f"k_{one}"], numbers[f"N_{one}"]) for one in "abc")
    assert run["e_speed"] == pytest.approx(total, abs=1e-9)


def _series(**more: object) -> bg.StateEquations:
    """A mass on two sliders in series."""
    nodes = [bg.Se("F", "F"), bg.One("m"), bg.I("M", 1, flow="v"), bg.Zero("z"),
             bg.R("a", effort="F_a", flow="s_a", law=bg.DryFriction("A")),
             bg.R("b", effort="F_b", flow="s_b", law=bg.DryFriction("B"), **more)]  # fmt: skip
    return bg.derive(bond_graph(nodes, "F>m>M m>z>a z>b"))


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize(("weak", "strong"), [("a", "b"), ("b", "a")])
def test_of_two_in_series_the_weaker_slips(backend: str, weak: str, strong: str) -> None:
    """v' = 3 - 1 = 2 until 1 s, then -3 - 1 until it turns at 1.5 s, and -3 + 1 back."""
    numbers = {"A": 1.0, "B": 2.5} if weak == "a" else {"A": 2.5, "B": 1.0}
    push = Step(1.0, -3.0, 3.0)
    run = simulator(_series(), numbers, backend=backend).run(T, {}, {"F": push})
    speed = np.where(T < 1, 2 * T, np.where(T < 1.5, 2 - 4 * (T - 1), -2 * (T - 1.5)))
    assert run["v"] == pytest.approx(speed, abs=1e-9)
    assert run[f"s_{weak}"] == pytest.approx(speed, abs=1e-9)
    assert run[f"s_{strong}"] == pytest.approx(0 * T, abs=1e-12)
    assert [(e.port, e.kind) for e in run.events] == [(weak, "cross")]


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("of", ["a step", "a ramp"])
def test_a_level_that_changes_is_followed_at_once(backend: str, of: str) -> None:
    """Stretched at 1 m/s; the level falls: the spring snaps to it by a step, and creeps by a ramp."""
    level: Signal = Step(0.55, 1.0, 3.0) if of == "a step" else Ramp(0.5, -2.0, 3.0, end=1.5)
    run = simulator(JENKINS, {"k_a": 10.0}, backend=backend).run(T, {}, {"v": 1.0, "N_a": level})
    assert run["F_a"] == pytest.approx(np.minimum(10 * T, [level(t) for t in T]), abs=1e-9)
    audit = run.audit()
    assert abs(audit.residual) < 1e-9 * audit.turned_over


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_level_by_another_spring(backend: str) -> None:
    """A spring that is pressed at 0.25 m/s rules it: N = 0.4 * 8 * t/4 = 0.8 t."""
    graph = iwan(["a"], "mu*F_n")
    graph.add_nodes_from([bg.Sf("press", "w"), bg.C("n", "1/8", effort="F_n")])
    graph.add_edge("press", "n")
    ready = simulator(bg.derive(graph), {"k_a": 10.0, "mu": 0.4}, backend=backend)
    run = ready.run(T, {}, {"v": 1.0, "w": 0.25})
    assert run["F_a"] == pytest.approx(0.8 * T, abs=1e-9)
    assert run["s_a"][1:] == pytest.approx(1 - 0.08 + 0 * T[1:], abs=1e-9)
    with pytest.raises(
        bg.SimulationError, match=r"the friction at 'a' has .* must not be negative"
    ):
        ready.run(T, {}, {"v": 1.0, "w": -0.25})


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_sweeps_tell_of_sliders_what_runs_do(backend: str) -> None:
    family = Family(JENKINS, NUMBERS, backend=backend)
    measures = {
        "F": final("F_a"), "slips": event_count("a", "slip"), "sticks": event_count("a", "stick")
    }  # fmt: skip
    levels = {"N_a": [2.0, 5.0, 20.0]}
    sent = pickle.loads(pickle.dumps(family))
    done = sweep(sent, levels, T, measures, inputs={"v": SPEED}, workers=0)
    expected = [play(SWAY, 10.0, level)[-1] for level in (2.0, 5.0, 20.0)]
    assert done["F"] == pytest.approx(expected, abs=1e-9)
    assert done["slips"].tolist() == [3.0, 2.0, 0.0]
    assert done["sticks"].tolist() == [2.0, 2.0, 0.0]


@pytest.fixture(scope="module")
def module() -> ModuleType:
    return loaded(to_python(JENKINS, NUMBERS))


def test_fixed_steps_of_python(module: ModuleType) -> None:
    """Until it slips for the second time, backwards."""
    run = module.simulate(T[:EARLY], {}, {"v": SPEED}, step=5e-4)
    assert run["F_k_a"] == pytest.approx(RIGHT[:EARLY], abs=2e-2)
    assert {2.0, -2.0} <= {*RIGHT[:EARLY]}
    assert not module.SWITCHES
    assert set(run) == {"t", "F_k_a", "v", "s_a"}
    with pytest.raises(ValueError, match="no switch is called 'a'"):
        module.simulate(T, {}, {"v": SPEED}, initially_on=["a"])


def test_fixed_steps_of_c(tmp_path: Path) -> None:
    pair, h = Pair(tmp_path, JENKINS, NUMBERS).at(NUMBERS), 5e-4
    s, found = pair.c.vector(0.0, np.zeros(1), [SPEED(0.0)]), [0.0]
    for k in range(4000):
        status, s = pair.c.step(k * h, h, s, [[SPEED(k * h + part)] for part in (0, h / 2, h)])
        assert status == 0, pair.c.message(status)
        found += [s[0]] if k % 50 == 49 else []
    assert found == pytest.approx(RIGHT, abs=2e-2)


@pytest.mark.parametrize("version", ["2.0", "3.0"])
@pytest.mark.usefixtures("compiled_quickly")
def test_units(version: str, tmp_path: Path) -> None:
    """Driven forwards and back by an importer; the mode is 1, 0 or -1, as of other friction."""
    case = SwitchedCase(JENKINS, NUMBERS, None, {}, {"v": 1.0}, 2.0)
    unit = Unit(case, version, tmp_path, inputs={"v": 1.0})
    assert {"F_a", "s_a", "mode(a)"} <= set(unit.at)
    assert not [name for name in unit.at if "forwards" in name or "backwards" in name]
    made, get = unit.started("CoSimulation"), "getInteger" if version == "2.0" else "getInt32"
    t, told = 0.0, []
    for speed, h in ((1.0, 0.1), (1.0, 0.5), (-1.0, 0.3), (-1.0, 0.5)):
        unit.put(made, v=speed)
        made.doStep(currentCommunicationPoint=t, communicationStepSize=h)
        t += h
        told.append((*unit.get(made, "F_a"), *getattr(made, get)([unit.at["mode(a)"]])))
    assert [mode for _, mode in told] == [0, 1, 0, -1]
    assert [force for force, _ in told] == pytest.approx([1.0, 2.0, -1.0, -2.0], abs=1e-9)
    unit.free(made)


def test_a_linear_model_in_either_mode() -> None:
    stuck = bg.linearize(JENKINS, mode={"a": "stick"}, outputs=["e_speed"])
    slips = bg.linearize(JENKINS, mode={"a": "slip"}, outputs=["e_speed", "s_a"])
    assert [str(name) for name in stuck.states] == ["F_k_a"]
    assert not slips.states
    assert slips.D.tolist() == [[0], [1]]
    # What changes with the level: its own effort, to the side to which it slips.
    graph = iwan(["a"])
    model = bg.linearize(bg.derive(graph), at={"s_a": -1}, inputs=["N_a"], outputs=["e_speed"])
    assert model.D.tolist()[0][list(map(str, model.inputs)).index("N_a")] == -1


@pytest.mark.parametrize(("backend", "method"), ENGINES)
def test_friction_put_later_over_a_port_on_a_spring(backend: str, method: str) -> None:
    """As it is declared, it gives its effort and rules the spring; with friction the spring is a state."""
    assert (LATER.states, list(map(str, LATER.inputs))) == ((), ["v", "F_a"])
    ready = simulator(LATER, NUMBERS, FRICTION, backend)
    assert (ready.states, ready.inputs, ready.outputs) == (("F_k_a",), ("v",), ("s_a",))
    run = ready.run(T, {}, {"v": SPEED}, method, 1e-11, 1e-13)
    assert run.backend == backend
    assert run["F_a"] == pytest.approx(RIGHT, abs=1e-9)
    assert [(event.port, event.kind) for event in run.events] == [("a", kind) for _, kind in EVENTS]
    assert set(run) == {"F_k_a", "v", "e_speed", "F_a", "s_a"}
    assert run.audit().lost["a"] == pytest.approx(2.0 * 1.8, rel=1e-9)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_friction_put_later_in_series(backend: str) -> None:
    """Of two in series on a spring the weaker slips: the force is that of it alone, the other stays."""
    nodes = [bg.Sf("speed", "v"), bg.Zero("z"), bg.C("K", "1/10", effort="F"),
             bg.R("a", effort="F_a", flow="s_a"),
             bg.R("b", effort="F_b", flow="s_b", gives="flow")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "speed>z>K z>a z>b"))
    laws = {"F_a": bg.DryFriction("A"), "b": bg.DryFriction("B")}
    for numbers, weak, strong in (
        ({"A": 3.0, "B": 2.0}, "b", "a"),
        ({"A": 2.0, "B": 3.0}, "a", "b"),
    ):
        run = simulator(equations, numbers, laws, backend).run(T, {}, {"v": SPEED})
        assert run["F"] == pytest.approx(RIGHT, abs=1e-9)
        assert run[f"s_{strong}"] == pytest.approx(0 * T, abs=1e-12)
        assert {event.port for event in run.events} == {weak}


def test_friction_put_later_goes_every_way(tmp_path: Path) -> None:
    """Sweeps, exports, linear models, steady states, explicit rates: those of the graph with its law."""
    measures = {"F": final("F_a")}
    family, levels = Family(LATER, NUMBERS, FRICTION), {"N_a": [2.0, 5.0]}
    sent = pickle.loads(pickle.dumps(family))
    done = sweep(sent, levels, T, measures, inputs={"v": SPEED}, workers=0)
    assert done["F"] == pytest.approx(
        [play(SWAY, 10.0, level)[-1] for level in (2.0, 5.0)], abs=1e-9
    )
    assert to_python(BARE, NUMBERS, FRICTION) == to_python(JENKINS, NUMBERS)
    assert to_c(BARE, NUMBERS, FRICTION, main=True) == to_c(JENKINS, NUMBERS, main=True)
    shown = ["e_speed", "s_a"]
    for mode in ("stick", "slip"):
        late = bg.linearize(LATER, laws=FRICTION, mode={"a": mode}, outputs=shown)
        assert late == bg.linearize(JENKINS, mode={"a": mode}, outputs=shown)
    assert bg.explicit(LATER, FRICTION) == bg.explicit(JENKINS)
    assert trim(simulator(LATER, NUMBERS, FRICTION), {"v": 0.0})["F_k_a"] == pytest.approx(0.0)
    late = loaded(to_python(LATER, NUMBERS, FRICTION))
    run = late.simulate(T[:EARLY], {}, {"v": SPEED}, step=5e-4)
    assert run["F_k_a"] == pytest.approx(RIGHT[:EARLY], abs=2e-2)
    assert set(run) == {"t", "F_k_a", "v", "s_a"}
    export = Export("late", LATER, NUMBERS, FRICTION, {}, {"v": SPEED}, T)
    files = target("python").write(export, tmp_path)
    assert [file.name for file in files] == ["late.py", "run_late.py"]


@pytest.mark.parametrize("version", ["2.0", "3.0"])
@pytest.mark.usefixtures("compiled_quickly")
def test_units_with_friction_put_later(version: str, tmp_path: Path) -> None:
    """The same bytes as with the law declared."""
    first, second = (
        write_fmu(tmp_path / "one.fmu", one, NUMBERS, law, version).read_bytes()
        for one, law in ((BARE, FRICTION), (JENKINS, None))
    )
    assert first == second
    # With its slip as an output, which the port gives now.
    unit = Unit(
        SwitchedCase(LATER, NUMBERS, FRICTION, {}, {"v": 1.0}, 2.0),
        version,
        tmp_path,
        inputs={"v": 1.0},
    )
    made = unit.started("CoSimulation")
    made.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.5)
    assert unit.get(made, "F_a", "F_k_a", "s_a") == pytest.approx([2.0, 2.0, 1.0], abs=1e-9)
    unit.free(made)


def test_a_steady_state() -> None:
    """A mass on a slider on a spring holds what its level holds."""
    nodes = [bg.Se("F", "F"), bg.One("m"), bg.I("M", 1, flow="v"), bg.Zero("z"), bg.C("K", "1/9", effort="f"),
             bg.R("a", effort="F_a", flow="s", law=bg.DryFriction(2))]  # fmt: skip
    ready = simulator(bg.derive(bond_graph(nodes, "F>m>M m>z>K z>a")), {})
    point = trim(ready, {"F": 1.5})
    assert point["F_a"] == pytest.approx(1.5)
    assert set(point) == {"v", "f", "F", "f_F", "F_a", "s"}
    with pytest.raises(bg.SimulationError, match="'a' would not stick"):
        trim(ready, {"F": 2.5})


@pytest.mark.parametrize(("backend", "method"), ENGINES)
@pytest.mark.parametrize("way", [1, -1])
def test_a_travel_is_the_impulse_of_its_event(way: int, backend: str, method: str) -> None:
    """A level falls by a step to 2 below 200/pi sin(0.02 pi): the spring of 100 gives way at once."""
    ready = simulator(
        bg.derive(iwan("a")), {"k_a": 100.0}, {"a": bg.DryFriction("N")}, backend=backend
    )
    speed, level = Sine(2.0 * way, 0.5, np.pi / 2), Constant(5.0) + Step(0.02, -3.0)
    result = ready.run(np.linspace(0.0, 0.1, 11), {}, {"v": speed, "N": level}, method)
    (event,) = [one for one in result.events if one.impulse]
    travel = (200 / np.pi * np.sin(0.02 * np.pi) - 2) / 100
    assert (event.port, event.kind) == ("a", "slip")
    assert (event.time, abs(event.impulse)) == pytest.approx((0.02, travel), abs=1e-9)

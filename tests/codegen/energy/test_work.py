"""Work, integrals and power balances against closed forms, however few the samples."""

from math import cos, exp, pi, sin

import numpy as np
import pytest
from oracles.audited import CLOSED, open_part
from oracles.models import block, pulled_block
from references.build import bond_graph

import bondgraph as bg
import codegen
from codegen import Ramp, Result, Sine, Step, simulator, switched_simulator

METHODS = ("auto", "DOP853", "Radau")


def _sliding(samples: list[float], method: str) -> Result:
    """A mass of 2 at 5 m/s on a damper: all of its 25 J are lost."""
    graph = bond_graph(
        [bg.One("m"), bg.I("M", 2, flow="v"), bg.R("b", 40, effort="F_b")], "m>M m>b"
    )
    return simulator(bg.derive(graph), {}).run(samples, {"v": 5.0}, method=method)


@pytest.mark.usefixtures("closely")
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("samples", [[0, 0.6], [0, 0.001, 0.6], [0.006 * k for k in range(101)]])
def test_a_damper_takes_what_the_mass_had(samples: list[float], method: str) -> None:
    """In the end a part of 4e-11 of it is left."""
    result = _sliding(samples, method)
    times = np.array(samples)
    lost = 25 * (1 - np.exp(-40 * times))
    assert result.work("b") == pytest.approx(lost, rel=2e-9, abs=1e-9)
    assert result.work("M") == pytest.approx(-lost, rel=2e-9, abs=1e-9)
    assert result.integral("v") == pytest.approx((1 - np.exp(-20 * times)) / 4, rel=1e-9)
    audit = result.audit()
    assert (audit.took["M"], audit.lost["b"]) == pytest.approx((-25, 25), rel=2e-9)
    assert audit.conserving == ("m",)
    assert open_part(result) < CLOSED


def test_a_capacitor_charged_through_a_resistance_takes_half() -> None:
    nodes = [bg.Se("battery", 12), bg.One("wire"), bg.R("r", 100), bg.C("c", 1e-3)]
    result = simulator(bg.derive(bond_graph(nodes, "battery>wire>r wire>c")), {}).run([0, 4])
    supplied = 1e-3 * 144 * (1 - exp(-40))
    audit = result.audit()
    assert audit.gave == pytest.approx({"battery": supplied})
    assert audit.took == pytest.approx({"c": supplied / 2})
    assert audit.lost == pytest.approx({"r": supplied / 2})
    assert result.integral("f_c")[-1] == pytest.approx(12e-3, rel=1e-12)


@pytest.mark.parametrize("method", ["auto", "Radau"])
def test_a_stiff_part_does_not_hide_the_slow_one(method: str) -> None:
    """Two capacitors on a battery of 2 V, with time constants of 1e-9 s and 10 s, in one interval of 5 s."""
    nodes = [bg.Se("battery", 2), bg.Zero("bus"), bg.One("a"), bg.C("fast", 1e-9, effort="u"),
             bg.R("r", 1), bg.One("b"), bg.C("slow", 1, effort="v"), bg.R("s", 10)]  # fmt: skip
    graph = bond_graph(nodes, "battery>bus>a>fast a>r bus>b>slow b>s")
    result = simulator(bg.derive(graph), {}).run([0, 5], {"u": 3.0}, method=method)
    assert result.work("s")[-1] == pytest.approx(2 * (1 - exp(-1)), rel=1e-9)
    assert result.work("r")[-1] == pytest.approx(5e-10, rel=1e-7)


@pytest.mark.parametrize("method", METHODS)
def test_a_clutch_loses_what_it_slips(method: str) -> None:
    """A mass of 2 at 6 m/s under friction of 4: it slides 9 m in 3 s, then it sticks under a push of 1."""
    result = simulator(bg.derive(block()), {"m": 2.0, "F_c": 4.0}).run(
        [0, 10], {"v": 6.0}, {"P": Step(5.0, 1.0)}, method=method
    )
    assert [event.kind for event in result.events] == ["stick"]
    assert result.work("ground") == pytest.approx([0, 36], abs=1e-8)
    assert result.integral("f")[-1] == pytest.approx(12 + 5, abs=1e-8)
    assert result.audit().took["m"] == pytest.approx(-36, abs=1e-8)


def test_a_spring_pulled_until_it_slips() -> None:
    """A block sticks until k V t is F_c; what the motor gave is F_c^2/2k, none of it lost before."""
    result = simulator(bg.derive(pulled_block()), {"m": 1.0, "k": 50.0, "F_c": 10.0}).run(
        [0, 0.2], {}, {"V": 1.0}
    )
    assert result.work("motor")[-1] == pytest.approx(1.0, rel=1e-12)
    assert result.audit().took["k"] == pytest.approx(1.0, rel=1e-12)
    assert result.work("ground")[-1] == pytest.approx(0.0, abs=1e-12)


def test_a_source_that_steps_into_an_inertia_gives_it_its_energy() -> None:
    """w steps from 0 to 4: 2 w^2/2 = 16 at once, and 0.5 s of 3 w^2 = 48 into the damper by 1 s."""
    nodes = [bg.Sf("drive", "w"), bg.One("shaft"), bg.I("J", 2), bg.R("b", 3), bg.C("k", 0.5)]
    graph = bond_graph(nodes, "drive>shaft>J shaft>b shaft>k")
    result = simulator(bg.derive(graph, []), {}).run([0, 0.5, 1], {}, {"w": Step(0.5, 4.0)})
    assert result.work("J") == pytest.approx([0, 16, 16], rel=1e-12)
    assert result.work("b") == pytest.approx([0, 0, 24], rel=1e-12)
    assert result.work("drive") == pytest.approx([0, 16, 44], rel=1e-12)
    assert open_part(result) < CLOSED


def test_a_source_that_steps_to_and_fro_gives_a_coupled_inertia_nothing() -> None:
    """A difference of speeds that a source rules: both inertias jump, and jump back."""
    nodes = [bg.Sf("drive", "w"), bg.Zero("between"), bg.One("a"), bg.One("b"), bg.I("A", 2, flow="v"),
             bg.I("B", 3, priority=-1)]  # fmt: skip
    graph = bond_graph(nodes, "a>between>b drive>between a>A b>B")
    result = simulator(bg.derive(graph, []), {}).run(
        [0, 1.5, 3], {"v": 1.0}, {"w": Step(1.0, 5.0) + Step(2.0, -5.0)}
    )
    # p = 2 v_a + 3 v_b stays: 5 v_a + 3 * 5 = 5, so v_a = -2 and v_b = 3.
    assert result["v"] == pytest.approx([1, -2, 1])
    assert result.work("A") == pytest.approx([0, 3, 0], abs=1e-12)
    assert result.work("B") == pytest.approx([0, 12, 0], abs=1e-12)
    assert result.work("drive") == pytest.approx([0, 15, 0], abs=1e-12)


def test_an_inelastic_impact_takes_the_energy_of_the_lost_velocities() -> None:
    """1 at 4 m/s catches 3 at rest: 8 J before, 2 J after."""
    nodes = [bg.One("first"), bg.I("m_1", 1, flow="v_1"), bg.Zero("gap"), bg.Sw("slack", on="1 - t"),
             bg.One("second"), bg.I("m_2", 3, flow="v_2")]  # fmt: skip
    graph = bond_graph(nodes, "first>m_1 first>gap>slack gap>second>m_2")
    result = switched_simulator(graph, {}).run([0.0, 2.0], initial={"v_1": 4.0})
    audit = result.audit()
    assert audit.impacts == pytest.approx(6)
    assert audit.took == pytest.approx({"m_1": -7.5, "m_2": 1.5})
    assert abs(audit.residual) < 1e-12
    assert result.work("m_1") == pytest.approx([0, -7.5])
    assert result.integral("v_2") == pytest.approx([0, 1])


def test_a_drive_that_catches_an_inertia_loses_as_much_as_it_gives() -> None:
    """A wheel of 2 at rest is joined to a drive at 3 rad/s: it takes 9, the drive gives 18."""
    nodes = [bg.Sf("drive", "w"), bg.Zero("gap"), bg.Sw("slack", on="1 - t"), bg.One("wheel"),
             bg.I("J", 2, flow="v")]  # fmt: skip
    graph = bond_graph(nodes, "drive>gap>slack gap>wheel>J")
    audit = switched_simulator(graph, {}).run([0.0, 2.0], inputs={"w": 3.0}).audit()
    assert audit.gave == pytest.approx({"drive": 18})
    assert audit.took == pytest.approx({"J": 9})
    assert audit.impacts == pytest.approx(9)
    assert abs(audit.residual) < 1e-12


def test_a_value_that_moves_gives_what_its_storage_gains() -> None:
    """A coil of L(t) = 2 + sin t that carries 3 A takes (L i)^2' i = L' i^2, half of it from its motion."""
    nodes = [bg.Sf("current", 3), bg.One("loop"), bg.I("coil", "2 + sin(t)", flow="i")]
    graph = bond_graph([*nodes, bg.C("c", 1, effort="u")], "current>loop>coil loop>c")
    result = simulator(bg.derive(graph, []), {}).run([0, 1.0], {"u": 1.0})
    assert result.work("coil")[-1] == pytest.approx(9 * sin(1.0), rel=1e-9)
    audit = result.audit()
    assert audit.gave["current"] == pytest.approx(9 * sin(1.0) + 7.5, rel=1e-9)
    assert audit.took["coil"] == pytest.approx(9 * sin(1.0), rel=1e-9)
    assert result.energy("coil")[-1] - result.energy("coil")[0] == pytest.approx(4.5 * sin(1.0))
    assert open_part(result) < CLOSED


@pytest.mark.usefixtures("closely")
def test_a_pendulum_turned_by_its_own_angle_closes() -> None:
    """A mass on a crank: its inertia 3 + 2 cos(theta) is a function of a state."""
    nodes = [bg.Se("torque", "T"), bg.One("shaft"), bg.I("J", "3 + 2*cos(theta)", flow="w"),
             bg.Df("angle", integrate="theta"), bg.R("b", "0.2")]  # fmt: skip
    graph = bond_graph(nodes, "torque>shaft>J shaft>angle shaft>b")
    result = simulator(bg.derive(graph, []), {}).run([0, 4], {"w": 2.0}, {"T": Sine(1.0, 0.3)})
    assert result["theta"][-1] > 2 * pi
    gained = result.audit().took["J"]
    assert gained == pytest.approx(result.work("J")[-1], rel=1e-8)
    assert open_part(result) < CLOSED


WITH_PLAY = "k*(max(q_s - 0.05, 0) + min(q_s + 0.05, 0))"


def _on_a_spring(law: str) -> codegen.Simulator:
    """A mass of 2, pushed, on a spring with that law and a damper by the square of the speed."""
    nodes = [bg.Se("push", "P"), bg.One("m"), bg.I("M", 2, flow="v"), bg.C("s", law=law, effort="F"),
             bg.R("b", law="0.3*v*abs(v)")]  # fmt: skip
    return simulator(bg.derive(bond_graph(nodes, "push>m>M m>s m>b"), []), {"k": 8.0})


@pytest.mark.parametrize("law", ["k*q_s + 5*q_s**3", WITH_PLAY, "k*q_s + v"])
def test_nonlinear_springs_close_by_their_energy_or_their_power(law: str) -> None:
    ready = _on_a_spring(law)
    result = ready.run([0, 2, 4], {"v": 1.0}, {"P": Sine(3.0, 0.7)})
    assert open_part(result) < CLOSED
    assert result.audit().took["s"] == pytest.approx(result.work("s")[-1], rel=1e-6, abs=1e-8)


def test_the_balance_closes_over_corners_wherever_steps_meet_them() -> None:
    """Steps for whose error a corner lay just right left up to 8e-9 open, one run in three over 1e-9."""
    ready = _on_a_spring(WITH_PLAY)
    for start in 1 + 1e-4 * np.arange(4):
        result = ready.run([0, 2, 4], {"v": start}, {"P": Sine(3.0, 0.7)})
        assert open_part(result) < CLOSED, start


def test_fields_are_one_node_of_the_balance() -> None:
    nodes = [bg.Se("push", "P"), bg.One("a"), bg.One("b"), bg.I("pair", [[2, 1], [1, 3]], ports=["x", "y"]),
             bg.R("r", 4), bg.R("s", 1)]  # fmt: skip
    graph = bond_graph(nodes, "push>a>r b>s")
    graph.add_edge("a", "pair", port="x")
    graph.add_edge("b", "pair", port="y")
    result = simulator(bg.derive(graph, []), {}).run([0, 3], {}, {"P": Ramp(0.5, 2.0)})
    audit = result.audit()
    listed = [*audit.gave, *audit.took, *audit.lost, *audit.conserving]
    assert sorted(map(str, listed)) == sorted(map(str, graph))
    assert audit.took["pair"] == pytest.approx(result.work("pair")[-1], rel=1e-12)
    parts = result.work("pair.x") + result.work("pair.y")
    assert parts == pytest.approx(result.work("pair"), rel=1e-12)
    assert open_part(result) < CLOSED


def test_an_oscillation_is_integrated_over_whole_periods() -> None:
    """cos(w t) and its square over 5 periods and a quarter, told at the two ends alone."""
    nodes = [bg.One("m"), bg.I("M", 1, flow="v"), bg.C("k", 1, effort="F")]
    result = simulator(bg.derive(bond_graph(nodes, "m>M m>k")), {}).run([0, 10.5 * pi], {"v": 1.0})
    assert result.integral("v")[-1] == pytest.approx(sin(10.5 * pi), rel=1e-12)
    assert result.work("k")[-1] == pytest.approx((1 - cos(21 * pi)) / 4, rel=1e-12)


def test_what_there_is_not_is_refused() -> None:
    result = _sliding([0, 1], "auto")
    for node in ("m", "none"):
        with pytest.raises(bg.StructureError, match=f"'{node}' is not a one-port of the graph"):
            result.work(node)
    with pytest.raises(bg.SignalError, match=r"no signal 'w'; there are F_b, .*v"):
        result.integral("w")


def test_a_balance_is_told_as_a_table() -> None:
    text = str(_sliding([0, 5], "auto").audit())
    assert [line.split() for line in text.splitlines()[1:5]] == [
        ["M", "took", "-25"], ["took", "in", "all", "-25"], ["b", "lost", "25"], ["lost", "in", "all", "25"],
    ]  # fmt: skip
    assert "conserve power: m" in text


def test_measures_of_a_run_are_its_works() -> None:
    result = _sliding([0, 5], "auto")
    assert codegen.work("b")(result) == result.work("b")[-1]

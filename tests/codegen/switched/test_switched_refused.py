"""What switched simulators refuse, and values that switches set to zero."""

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Step, switched_simulator


def _coil(key: str = "key", on: str = "1 - t") -> "nx.DiGraph[str]":
    nodes = [bg.Se("E", "U"), bg.One("w"), bg.Sw(key, on=on), bg.R("R", 2), bg.I("L", 1, flow="i")]
    return bond_graph(nodes, f"E>w w>{key} w>R w>L")


@pytest.mark.parametrize("name", ["i", "U", "e_L", "f_R"])
def test_a_switch_called_like_a_signal_is_refused(name: str) -> None:
    with pytest.raises(bg.StructureError, match=f"switch '{name}' is called like a signal"):
        switched_simulator(_coil(name), {})


def test_exact_steps_are_those_of_integration() -> None:
    """A coil that charges through 2 for a second, and is cut off."""
    times = np.linspace(0, 2, 9)
    for method in ("exact", "Radau"):
        result = switched_simulator(_coil(), {}).run(times, inputs={"U": 1.0}, method=method)
        assert [(event.time, event.kind) for event in result.events] == [(1.0, "off")]
        charged = np.where(times < 1, (1 - np.exp(-2 * times)) / 2, 0.0)
        assert result["i"] == pytest.approx(charged, abs=1e-8)


def test_exact_steps_are_refused_where_a_condition_is_not_affine() -> None:
    with pytest.raises(bg.SimulationError, match="a condition of a switch is not affine for exact"):
        switched_simulator(_coil(on="1 - i**2"), {}).run([0, 2], inputs={"U": 1.0}, method="exact")


@pytest.mark.parametrize("on", ["sqrt(t - 1) - 0.5", "log(t - 1) + 5"])
def test_a_condition_without_a_value_is_refused(on: str) -> None:
    with pytest.raises(
        bg.SimulationError, match=r"at t = 0\.5 the known source .* has no finite real value"
    ):
        switched_simulator(_coil(on=on), {}).run([0.0, 2.0], inputs={"U": 1.0})


def test_a_graph_without_switches_is_refused() -> None:
    graph = bond_graph([bg.Se("E", "U"), bg.One("w"), bg.I("L", 1)], "E>w w>L")
    with pytest.raises(bg.StructureError, match="no switches"):
        switched_simulator(graph, {})


def test_a_value_may_use_a_flow_that_an_open_diode_keeps_at_zero() -> None:
    """A coil, a capacitor and a resistance 0.1 + i^2 behind a diode, against tight integration."""
    nodes = [
        bg.Se("E", "u"), bg.One("w"), bg.Sw("d", on="e_d", off="-f_d"), bg.I("L", 1, flow="i"),
        bg.C("c", 1, effort="v"), bg.R("r", "0.1 + i**2"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "E>w w>d w>L w>c w>r")
    run = switched_simulator(graph, {}).run(np.linspace(0, 8, 9), inputs={"u": Step(0.0, 1.0)})
    from scipy.integrate import solve_ivp

    def rate(t: float, s: list[float]) -> list[float]:
        i, v = s
        return [1 - v - (0.1 + i * i) * i, i]

    def stop(t: float, s: list[float]) -> float:
        return s[0] if t > 0.1 else 1.0

    stop.terminal = True  # type: ignore[attr-defined]
    found = solve_ivp(rate, (0, 8), [0.0, 0.0], events=stop, rtol=1e-11, atol=1e-12)
    assert [event.kind for event in run.events] == ["off"]
    assert run.events[0].time == pytest.approx(found.t_events[0][0], abs=1e-6)
    assert run["v"][-1] == pytest.approx(found.y[1][-1], abs=1e-7)
    assert run["i"][-1] == 0.0

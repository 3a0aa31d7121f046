"""Two masses and a spring with a damper between them, as two models, against the whole in closed form."""

import numpy as np
import pytest
from scipy.linalg import expm

import bondgraph as bg
import codegen
from bondgraph.errors import SignalError

M1, M2, K, D = 2.0, 1.0, 50.0, 3.0
END = 1.0


def _cart(backend: str = "numpy") -> codegen.Simulator:
    graph = bg.graph(
        [bg.One("cart"), bg.I("m_1", M1, flow="v_1"), bg.Se("load", "F")], "cart > m_1, cart > load"
    )
    return codegen.simulator(bg.derive(graph), {}, backend=backend)


def _wagon(damping: float, backend: str = "numpy") -> codegen.Simulator:
    nodes = [
        bg.Sf("contact", "v"), bg.Zero("gap"), bg.One("link"), bg.C("spring", 1 / K, effort="f"),
        bg.R("damper", "d"), bg.One("wagon"), bg.I("m_2", M2, flow="v_2"),
    ]  # fmt: skip
    path = "contact > gap > wagon > m_2, gap > link > spring, link > damper"
    equations = bg.derive(bg.graph(nodes, path), outputs=["contact"])
    return codegen.simulator(equations, {"d": damping}, backend=backend)


def _coupled(
    every: str, damping: float = D, backend: str = "numpy", **more: object
) -> codegen.CoSimulation:
    parts = {"a": _cart(backend), "b": _wagon(damping, backend)}
    wires = {"a.v_1": "b.v", "b.e_contact": "a.F"}
    initial = {"a": {"v_1": 1.0}}
    return codegen.cosimulate(parts, wires, END, every, initial=initial, **more)


def _exact(times: np.ndarray, damping: float = D) -> np.ndarray:
    """v_1, v_2 and the spring's force by hand: M1 v_1' = -e, M2 v_2' = e, f' = K (v_1 - v_2)."""
    force = np.array([damping, -damping, 1.0])
    rates = np.array([-force / M1, force / M2, [K, -K, 0.0]])
    return np.array([expm(rates * t) @ [1.0, 0.0, 0.0] for t in times])


def _errors(**more: object) -> list[float]:
    found = []
    for every in ("1/50", "1/100", "1/200", "1/400"):
        run = _coupled(every, **more)
        wanted = _exact(run.time)
        found.append(max(
            float(np.abs(run[name] - wanted[:, at]).max())
            for at, name in enumerate(("a.v_1", "b.v_2"))
        ))  # fmt: skip
    return found


def _order(errors: list[float]) -> float:
    return float(np.polyfit(np.arange(len(errors)), -np.log2(errors), 1)[0])


@pytest.mark.parametrize("order", [None, ["a", "b"], ["b", "a"]])
def test_held_inputs_converge_with_the_first_power_of_the_interval(order: list[str] | None) -> None:
    errors = _errors(order=order)
    assert 0.9 < _order(errors) < 1.1
    assert errors[-1] < 0.01


def test_inputs_along_lines_converge_with_the_second_power() -> None:
    assert 1.8 < _order(_errors(linear=["a.F", "b.v"])) < 2.3


def test_numpy_and_c_agree() -> None:
    ours, theirs = _coupled("1/100"), _coupled("1/100", backend="c")
    assert theirs.of("a").backend == "c"
    for name in ours:
        assert np.abs(ours[name] - theirs[name]).max() < 1e-11 * max(np.ptp(ours[name]), 1.0)


def test_what_the_coupling_creates_is_what_the_energy_grows_by() -> None:
    """Without a damper nothing is lost: all that the three storages gain was made between them."""
    run = _coupled("1/100", damping=0.0)
    held = (M1 * run["a.v_1"] ** 2 + M2 * run["b.v_2"] ** 2 + run["b.f"] ** 2 / K) / 2
    made = run.created("b.v", "a.F")
    assert held[-1] - held[0] > 1e-2
    assert np.abs(made - (held - held[0])).max() < 1e-9
    finer = _coupled("1/200", damping=0.0).created("b.v", "a.F")
    assert 1.8 < made[-1] / finer[-1] < 2.4


def test_a_model_of_the_coupling_is_a_result_that_balances() -> None:
    run = _coupled("1/100")
    part = run.of("b")
    assert sorted(part.states) == ["f", "v_2"]
    assert abs(part.audit().residual) < 1e-9
    effort, flow = part.bond("link", "damper")
    assert np.abs(effort - D * flow).max() < 1e-12
    assert np.abs(flow - (run["b.v"] - run["b.v_2"])).max() < 1e-12


def test_along_lines_a_model_balances_as_well() -> None:
    assert abs(_coupled("1/100", linear=["a.F"]).of("a").audit().residual) < 1e-9


def test_energy_is_told_of_power_connections_alone() -> None:
    run = _coupled("1/10")
    with pytest.raises(SignalError, match=r"'a\.v' is no connected input"):
        run.created("a.v", "b.v")
    with pytest.raises(SignalError, match="a power connection has two inputs"):
        run.created("a.F", "a.F")

"""Nodes of signals in explanations: told as functions, states and controllers, not as their parts."""

from typing import Any

import sympy as sp

import bondgraph as bg


def _told(*nodes: Any, value: object = "1*tau") -> bg.Explanation:
    motor = [bg.Se("motor", value), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b")]
    return bg.explain(bg.graph([*motor, *nodes], "motor > shaft > J, shaft > b"))


def _step(told: bg.Explanation, topic: str) -> Any:
    return next(step for step in told.steps if step.topic == topic)


def test_functions_and_states_are_told_by_their_names() -> None:
    told = _told(bg.Function("tau", "K*(ref - omega) + z"), bg.State("z", "K_i*(ref - omega)"))
    z, e_z, omega, ref, K, K_i = sp.symbols("z e_z omega ref K K_i")
    lines = {str(one.left): one.right for one in _step(told, "signals").equations}
    assert sp.expand(lines["tau"] - K * (ref - omega) - z) == 0
    assert sp.expand(lines["e_z"] - K_i * (ref - omega)) == 0
    assert lines["z'"] == e_z
    assert [one.node for one in _step(told, "signals").equations] == ["tau", "z", "z"]
    assert str(told).startswith(
        "From a bond graph of 4 nodes and 3 bonds with 2 nodes of signals to A x'"
    )


def test_what_signals_are_made_of_is_not_told() -> None:
    told = _told(
        bg.Function("tau", "u - z"), bg.State("z", "omega - 1", low=0),
        bg.Controller("c", every="1/10", gives={"u": "-omega"}),
    )  # fmt: skip
    parts = {"tau.end", "z.free", "z.low", "z.position", "c.still", "c.u"}
    for step in told.steps:
        assert not parts & {one.node for one in step.equations}, step.topic
    assert len([line for line in _step(told, "causality").sentences if ".end" in line]) == 0
    assert [line.split(" (")[0] for line in _step(told, "causality").sentences] == [
        "motor",
        "J",
        "shaft",
    ]
    assert not any("z.low" in line for line in _step(told, "laws").sentences)


def test_instants_of_controllers_and_bounds_of_states_are_told() -> None:
    told = _told(
        bg.State("z", "omega - 1", low=0, high="top"),
        bg.Controller("c", every="1/10", offset="1/20", states={"n": 0}, update={"n": "n + 1"},
                      gives={"tau": "z - n"}),
    )  # fmt: skip
    controller, low, high = _step(told, "signals").sentences
    assert controller.startswith(
        "c: every 1/10 s from 1/20 s on n becomes n + 1 and tau becomes z - n"
    )
    assert low.endswith("so z is never negative and e_z_low never positive")
    assert "so top - z is never negative" in high


def test_equations_are_as_of_the_graph_without_functions() -> None:
    """The rates with everything put in: J omega' = -K omega - b omega."""
    told = _told(bg.Function("tau", "-K*omega"))
    J, K, b, omega = sp.symbols("J K b omega")
    last = told.steps[-1].equations[0]
    assert sp.expand(last.right + (K + b) * omega) == 0
    assert last.left.coeff(J).free_symbols == {sp.Symbol("omega'")}

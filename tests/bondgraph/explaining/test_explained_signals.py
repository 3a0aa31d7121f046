"""Nodes of signals in explanations: told as functions, states and controllers, not as their parts."""

import re
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
    z, omega, ref, K, K_i = sp.symbols("z omega ref K K_i")
    lines = {str(one.left): one.right for one in _step(told, "signals").equations}
    assert sp.expand(lines["tau"] - K * (ref - omega) - z) == 0
    assert sp.expand(lines["z'"] - K_i * (ref - omega)) == 0
    assert [one.node for one in _step(told, "signals").equations] == ["tau", "z"]
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
    state, controller = _step(told, "signals").sentences
    assert controller.startswith(
        "c: every 1/10 s from 1/20 s on n becomes n + 1 and tau becomes z - n"
    )
    assert state == "z' = rate_z within 0 <= z <= top: at a bound z' = 0 while rate_z leads beyond"


def test_equations_are_as_of_the_graph_without_functions() -> None:
    """The rates with everything put in: J omega' = -K omega - b omega."""
    told = _told(bg.Function("tau", "-K*omega"))
    J, K, b, omega = sp.symbols("J K b omega")
    last = told.steps[-1].equations[0]
    assert sp.expand(last.right + (K + b) * omega) == 0
    assert last.left.coeff(J).free_symbols == {sp.Symbol("omega'")}


def test_what_blocks_are_made_of_is_told_nowhere() -> None:
    """A motor behind all kinds of nodes that have several ways: the steps are those of the motor alone."""
    told = _told(
        bg.Hysteresis("relay", "omega", 1, 2), bg.RateLimiter("r", "ref", 2, falling=1),
        bg.State("z", "ref - omega", low=0), bg.Function("tau", "K*r - relay - z"),
    )  # fmt: skip
    text, latex = str(told), told.latex()
    inner = re.compile(r"(?<![a-z])[ef]_\{?(z|relay|r[_,])|z\.low|relay\.|r\.[a-z]")
    assert inner.search(text) is None, text
    assert inner.search(latex) is None, latex
    head = ["1 state: omega", "2 states of signals: r, z", "1 input: e_motor"]
    assert [line.strip() for line in text.splitlines()[1:4]] == head
    numbers = [one.number for step in told.steps for one in (*step.equations, *step.formulas)]
    assert numbers == [*range(1, len(numbers) + 1)]
    assert _step(told, "inertia").formulas[0].left.matrix.shape == (1, 1)
    signals = _step(told, "signals")
    assert [str(one.left) for one in signals.equations] == ["rate_z", "tau"]
    assert signals.sentences == (
        "relay = 1 once omega > 2, 0 once omega < 1",
        "r' = 2 while ref > r, -1 while ref < r; r = ref while -1 <= ref' <= 2",
        "z' = rate_z within 0 <= z: at the bound z' = 0 while rate_z leads beyond",
    )

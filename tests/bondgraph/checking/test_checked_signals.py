"""Doubts about graphs with nodes of signals: of the bond graph alone, none of what the nodes are made of."""

from typing import Any

import pytest

import bondgraph as bg


def _motor(*nodes: Any) -> bg.BondGraph:
    motor = [bg.Se("motor", "1*tau"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b")]
    return bg.graph([*motor, *nodes], "motor > shaft > J, shaft > b")


SOUND = {
    "integrator": [bg.Function("tau", "z"), bg.State("z", "K*(ref - omega)", low=-1, high="top")],
    "relay": [bg.Function("tau", "T*relay"), bg.Hysteresis("relay", "omega - ref", "low", "high")],
    "limiter": [bg.Function("tau", "K*(r - omega)"), bg.RateLimiter("r", "ref", "up", falling="down")],
    "pid": bg.PID("tau", "ref - omega", "kp", "ki", "kd", tau_d="T", low=-1, high=1),
    "lead": bg.TransferFunction("tau", "ref - omega", ["T", 1], ["T_2", 1]),
    "cascade": [bg.Controller("fast", every=0.01, gives={"tau": "K*(goal - omega)"}),
                bg.Controller("slow", every=0.1, states={"n": 0}, update={"n": "n + ref - omega"},
                              gives={"goal": "n"})],
    "unread": [bg.Function("tau", "1*ref"), bg.Function("power", "tau*omega"),
               bg.Hysteresis("fast", "omega", 1, 2), bg.RateLimiter("slow", "omega", 1)],
}  # fmt: skip


@pytest.mark.parametrize("name", SOUND)
@pytest.mark.parametrize("derivative", [False, True])
def test_nothing_is_to_be_asked_of_sound_graphs(name: str, derivative: bool) -> None:
    assert str(bg.check(_motor(*SOUND[name]), derivative=derivative)) == "nothing found"


@pytest.mark.parametrize("name", SOUND)
def test_doubts_are_those_of_the_graph_without_signals(name: str) -> None:
    """A junction that only hands on, told once and by its own name."""
    nodes = [bg.Se("motor", "1*tau"), bg.One("shaft"), bg.I("J", "J", flow="omega"), *SOUND[name]]
    (found,) = str(bg.check(bg.graph(nodes, "motor > shaft > J"))).splitlines()
    assert found.startswith("hint (pass-through): 1-junction 'shaft' has two bonds")


def test_open_strokes_are_those_of_bonds() -> None:
    found = str(bg.check(_motor(*SOUND["relay"]), strokes={("motor", "shaft"): "shaft"}))
    assert "without a stroke: 'shaft' -> 'J', 'shaft' -> 'b';" in found
    assert "relay" not in found

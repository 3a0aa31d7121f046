"""Causal paths by way of functions and states: loops of controllers by hand, and Mason's rule on them."""

from typing import Any

import pytest
import sympy as sp

import bondgraph as bg

s, J, b, K, K_i, T = sp.symbols("s J b K K_i T")


def _motor(*nodes: Any, paths: str = "") -> Any:
    motor = [bg.Se("motor"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b")]
    bonds = "motor > shaft > J, shaft > b, load > shaft"
    return bg.graph([*motor, bg.Se("load", "M"), *nodes], bonds, *([paths] if paths else []))


def _same(one: sp.Expr, other: sp.Expr) -> bool:
    return sp.cancel(one - other) == 0


def test_a_speed_loop_is_a_loop() -> None:
    """From the load: 1/(J s + b + K + K_i/s), a loop by each way of the controller."""
    graph = _motor(
        bg.Function("e", "ref - omega"), bg.State("z", "K_i*e"), bg.Function("tau", "K*e + z"),
        paths="J > e > tau > motor, e > z > tau",
    )  # fmt: skip
    found = bg.causal_paths(graph, "load", "J")
    gains = {loop.nodes: loop.gain for loop in found.loops}
    assert gains == {
        ("J", "shaft", "b", "shaft", "J"): -b / (J * s),
        ("J", "e", "tau", "motor", "shaft", "J"): -K / (J * s),
        ("J", "e", "z", "tau", "motor", "shaft", "J"): -K_i / (J * s**2),
    }
    assert _same(found.determinant, 1 + (b + K) / (J * s) + K_i / (J * s**2))
    speed = bg.causal_paths(graph, "load", "shaft").transfer
    assert _same(speed, s / (J * s**2 + (b + K) * s + K_i))


def test_a_lag_has_a_loop_of_its_own() -> None:
    """z' = (omega - z)/T: from the load to z 1/((J s + b)(T s + 1))."""
    graph = _motor(bg.State("z", "(omega - z)/T"), bg.Function("tau", "2*t"), paths="tau > motor")
    found = bg.causal_paths(graph, "load", "z")
    assert _same(found.transfer, 1 / ((J * s + b) * (T * s + 1)))
    assert [loop.gain for loop in found.loops if set(loop.nodes) == {"z"}] == [-1 / (T * s)]


def test_a_path_ends_at_a_function_and_begins_at_one() -> None:
    graph = _motor(bg.Function("tau", "-K*omega"), paths="J > tau > motor")
    assert _same(bg.causal_paths(graph, "load", "tau").transfer, -K / (J * s + b + K))
    assert _same(bg.causal_paths(graph, "tau", "shaft").transfer, 1 / (J * s + b + K))


def test_known_sources_that_read_signals_need_no_function() -> None:
    graph = bg.graph(
        [
            bg.Se("motor", "-K*omega"),
            bg.One("shaft"),
            bg.I("J", "J", flow="omega"),
            bg.Se("load", "M"),
        ],
        "motor > shaft > J, load > shaft",
    )
    assert _same(bg.causal_paths(graph, "load", "shaft").transfer, 1 / (J * s + K))


@pytest.mark.parametrize(
    ("node", "message"),
    [
        (bg.Function("tau", "omega**2"), "Function 'tau' reads omega by a factor that moves"),
        (bg.Function("tau", "t*omega"), "Function 'tau' reads omega by a factor that moves"),
        (bg.State("tau", "omega", low=0), "State 'tau' is not linear"),
        (bg.Controller("c", every=1, gives={"tau": "omega"}), "Controller 'c' works at instants"),
    ],
)
def test_signals_without_a_constant_gain_are_refused_by_name(node: Any, message: str) -> None:
    graph = _motor(node)
    graph.nodes["motor"]["value"] = "1*tau"
    with pytest.raises(bg.StructureError, match=message):
        bg.causal_paths(graph, "load", "J")

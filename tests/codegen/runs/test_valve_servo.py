"""A hydraulic servo in its limit cycle: by default settings as scipy's methods at tight tolerances."""

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph
from scipy.integrate import solve_ivp

import bondgraph as bg
from codegen import Signal, Sine, simulator

NUMBERS = {
    "P_s": 100.0,
    "K": 2.0,
    "A": 1.0,
    "c": 2e-3,
    "m": 1.0,
    "b": 0.5,
    "gain": 20.0,
    "lag": 0.02,
}
"""Pressures in bar, lengths in cm: any units that fit one another."""

LASTS = {"numpy": 0.1, "c": 0.5}
"""How long a run is followed [s]; its swings grow to their full size within the first half second."""


def _servo() -> nx.DiGraph:
    """A four-way valve between supply, tank and two chambers, a cylinder, a mass on a spring, feedback.

    The valve's spool ``s`` follows ``gain*(want - x)`` with a lag: one first-order element of its own.
    """
    orifice = "K*Max({way}s, 0)*sign({e})*sqrt(abs({e}))"
    nodes = [bg.Se("supply", "P_s"), bg.Zero("high"), bg.Zero("a"), bg.Zero("b_side"), bg.Se("tank", 0),
             bg.Zero("low"), bg.C("c_a", "c", effort="p_a"), bg.C("c_b", "c", effort="p_b"),
             bg.TF("piston_a", "1/A"), bg.TF("piston_b", "1/A"), bg.One("rod", flow="v"),
             bg.I("m", "m", flow="v_m"),
             bg.R("b", "b"), bg.Df("place", integrate="x"), bg.R("leak", "1000"), bg.One("leaking"),
             bg.Se("command", "gain*(want - x)"), bg.One("coil"), bg.R("coil_r", 1),
             bg.C("spool", "lag", effort="s")]  # fmt: skip
    bonds = "supply>high tank>low a>c_a b_side>c_b a>piston_a>rod rod>piston_b>b_side rod>m rod>b rod>place"
    bonds += " a>leaking>b_side leaking>leak command>coil>coil_r coil>spool"
    ways = ["sa high a", "bt b_side low", "at a low -", "sb high b_side -"]
    for name, begin, end, *sign in (way.split() for way in ways):
        way = "".join(sign)
        nodes += [
            bg.One(f"w_{name}"),
            bg.R(name, law=orifice.format(way=way, e=f"e_{name}"), gives="flow"),
        ]
        bonds += f" {begin}>w_{name}>{end} w_{name}>{name}"
    return bond_graph(nodes, bonds)


def _rates(t: float, y: np.ndarray, want: Signal) -> list[float]:
    """By hand: p_a, p_b, v, s, x."""
    p_a, p_b, v, s, x = y
    n = NUMBERS

    def flow(opening: float, drop: float) -> float:
        return n["K"] * max(opening, 0.0) * np.sign(drop) * np.sqrt(abs(drop))

    q_a = flow(s, n["P_s"] - p_a) - flow(-s, p_a)
    q_b = flow(-s, n["P_s"] - p_b) - flow(s, p_b)
    leak = (p_a - p_b) / 1000
    return [
        (q_a - n["A"] * v - leak) / n["c"], (q_b + n["A"] * v + leak) / n["c"],
        (n["A"] * (p_a - p_b) - n["b"] * v) / n["m"], (n["gain"] * (want(t) - x) - s) / n["lag"], v,
    ]  # fmt: skip


def _by_hand(method: str, times: np.ndarray) -> np.ndarray:
    run = solve_ivp(_rates, (0, times[-1]), [50.0, 50.0, 0.0, 0.2, 0.0], method, times,
                    args=(Sine(0.1, 0.5),), rtol=1e-9, atol=1e-9)  # fmt: skip
    return np.asarray(run.y)


def test_both_of_scipys_methods_agree() -> None:
    times = np.linspace(0, 0.1, 11)
    first, second = _by_hand("DOP853", times), _by_hand("Radau", times)
    assert np.abs(first - second).max() < 1e-6 * np.abs(first).max()


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_a_servo_in_its_limit_cycle_is_that_by_hand(backend: str) -> None:
    ready = simulator(bg.derive(_servo()), NUMBERS, backend=backend)
    begin = {"p_a": 50.0, "p_b": 50.0, "s": 0.2}
    times = np.linspace(0, LASTS[backend], 21)
    run = ready.run(times, begin, {"want": Sine(0.1, 0.5)})
    assert run.backend == backend
    right = _by_hand("DOP853", times)
    # Both chambers reach supply and tank, and the swings are larger than what is asked for.
    assert backend == "numpy" or (np.ptp(right[4]) > 0.5 and np.ptp(right[0]) > 100)
    for name, values in zip(("p_a", "p_b", "v_m", "s", "x"), right, strict=True):
        assert np.abs(run[name] - values).max() < 1e-6 * np.ptp(values), name

"""Switches of every guard and in either causality, each with a run that is known by hand."""

from collections.abc import Mapping
from itertools import pairwise

import numpy as np
from references.build import bond_graph
from scipy.optimize import brentq

import bondgraph as bg
from oracles.routes.kind import Array, Kind, relaxed, stepwise

GATE = "step(0.3, 1, 0) + step(0.7, -1, 0)"
"""1 from 0.3 to 0.7 s, else 0."""


def diode() -> Kind:
    """A half wave through R and L: the current of the sine switched on, until it is gone."""
    R, L, w, u = 2.0, 0.05, 100 * np.pi, 10.0
    z, phase, tau = np.hypot(R, w * L), np.arctan2(w * L, R), L / R

    def current(t: Array) -> Array:
        return u / z * (np.sin(w * t - phase) + np.sin(phase) * np.exp(-t / tau))

    out = brentq(current, 0.01, 0.0199)
    nodes = [
        bg.Se("src", "u"),
        bg.One("n"),
        bg.R("r", "R"),
        bg.I("l", "L", flow="i"),
        bg.Diode("d"),
    ]
    return Kind(
        "diode", bond_graph(nodes, "src>n>r n>l n>d"), {"R": R, "L": L}, {"u": "sine(10, 50)"},
        lambda t, run: {"i": np.where(t < out, current(t), 0)}, 0.0199, at=0.005, mode={"d": "on"},
        rest={"inputs": {"u": -1.0}},
    )  # fmt: skip


def clamp() -> Kind:
    """A constant current into C beside a diode onto E: v = I t/C, and no more than E."""
    nodes = [bg.Sf("src", "I"), bg.Zero("n"), bg.C("c", "C", effort="v"), bg.One("to"), bg.Diode("d"),
             bg.Se("E", "E")]  # fmt: skip
    graph = bond_graph(nodes, "src>n>c n>to>d E>to")
    return Kind(
        "diode across a capacitor", graph, {"C": 0.1}, {"I": "1", "E": "-4"},
        lambda t, run: {"v": np.minimum(t / 0.1, 4)}, 0.99, at=0.2, mode={"d": "off"},
        rest={"inputs": {"I": 1.0, "E": -4.0}},
    )  # fmt: skip


def bridge() -> Kind:
    """Four diodes hand |u| to a load of R and L."""
    R, L, w, u = 2.0, 0.02, 100 * np.pi, 10.0
    nodes = [bg.Se("src", "u"), bg.One("s"), bg.Zero("p"), bg.Zero("q"), bg.One("load"), bg.R("R", "R"),
             bg.I("L", "L", flow="i"), bg.Zero("top")]  # fmt: skip
    graph = bond_graph(nodes, "src>s p>s s>q top>load load>R load>L")
    # The node that the load's current returns to is the reference and has no junction.
    for name, way in {"d1": "q>{}>top", "d2": "p>{}>top", "d3": "{}>q", "d4": "{}>p"}.items():
        path = way.format(f"leg_{name}").split(">")
        graph.add_nodes_from([bg.One(f"leg_{name}"), bg.Diode(name)])
        graph.add_edges_from([*pairwise(path), (f"leg_{name}", name)])

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        z, phase, tau, half = np.hypot(R, w * L), np.arctan2(w * L, R), L / R, np.pi / w
        parts, i = [], 0.0
        for k in range(3):

            def wave(s: Array, i: float = i) -> Array:
                return u / z * (
                    np.sin(w * s - phase) + np.sin(phase) * np.exp(-s / tau)
                ) + i * np.exp(-s / tau)

            parts.append((k * half, wave))
            i = float(wave(np.array(half)))
        return {"i": stepwise(t, *parts)}

    return Kind(
        "bridge of four diodes", graph, {"R": R, "L": L}, {"u": "sine(10, 50)"}, known, 0.0299,
        at=0.004, mode={"d1": "on", "d2": "off", "d3": "off", "d4": "on"}, rest={"inputs": {"u": 5.0}},
    )  # fmt: skip


def check_valve() -> Kind:
    """A tank at h_0 behind a valve and a pipe, under a rising pressure: the lag of a ramp from p = h_0 on."""
    nodes = [
        bg.Se("pump", "p"),
        bg.One("n"),
        bg.CheckValve("valve"),
        bg.R("pipe", "R"),
        bg.C("tank", "C", effort="h"),
    ]
    h0, a, tau = 2.0, 6.0, 0.25
    opens = h0 / a

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {
            "h": stepwise(t, (0, lambda s: h0 + 0 * s),
                          (opens, lambda s: h0 + a * s - a * tau * (1 - np.exp(-s / tau))))}  # fmt: skip

    return Kind(
        "check valve", bond_graph(nodes, "pump>n>valve n>pipe n>tank"), {"R": 0.5, "C": 0.5},
        {"p": f"ramp(0, {a})"}, known, 1.0, {"h": h0}, at=0.1, mode={"valve": "off"},
        rest={"inputs": {"p": 1.0}, "initial": {"h": 2.0}},
    )  # fmt: skip


def _shafts(*more: tuple, bonds: str):
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J_1", "J_1", flow="w_1"), bg.Zero("gap"),
             bg.One("b"), bg.I("J_2", "J_2", flow="w_2"), *more]  # fmt: skip
    return bond_graph(nodes, f"T>a>J_1 a>gap>b>J_2 {bonds}")


def freewheel() -> Kind:
    """w_1 = T t/J_1 meets w_2 = 3 and takes it along."""
    T, J1, J2, w0 = 6.0, 1.0, 2.0, 3.0
    t0 = w0 * J1 / T

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {
            "w_1": stepwise(t, (0, lambda s: T / J1 * s), (t0, lambda s: w0 + T / (J1 + J2) * s)),
            "w_2": stepwise(t, (0, lambda s: w0 + 0 * s), (t0, lambda s: w0 + T / (J1 + J2) * s)),
        }

    return Kind(
        "freewheel", _shafts(bg.Freewheel("fw"), bonds="gap>fw"), {"J_1": J1, "J_2": J2}, {"T": f"{T}"},
        known, 0.99, {"w_1": 0.0, "w_2": w0}, on=("fw",), at=0.2, mode={"fw": "on"},
        rest={"inputs": {"T": 0.0}},
    )  # fmt: skip


def freewheel_and_brake() -> Kind:
    """The same, braked: w_2 falls at N/J_2 until it is met, then both rise at (T - N)/(J_1 + J_2)."""
    T, J1, J2, w0, n = 6.0, 1.0, 2.0, 3.0, 1.5
    t0 = w0 / (T / J1 + n / J2)
    meets = T / J1 * t0

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {
            "w_1": stepwise(
                t, (0, lambda s: T / J1 * s), (t0, lambda s: meets + (T - n) / (J1 + J2) * s)
            ),
            "w_2": stepwise(
                t, (0, lambda s: w0 - n / J2 * s), (t0, lambda s: meets + (T - n) / (J1 + J2) * s)
            ),
        }

    brake = bg.R("brake", law=bg.DryFriction("N"))
    return Kind(
        "freewheel beside friction", _shafts(bg.Freewheel("fw"), brake, bonds="gap>fw b>brake"),
        {"J_1": J1, "J_2": J2, "N": n}, {"T": f"{T}"}, known, 0.99, {"w_1": 0.0, "w_2": w0}, on=("fw",),
        at=0.8, mode={"fw": "off", "brake": "slip"}, rest={"inputs": {"T": 1.0}},
    )  # fmt: skip


def key_in_series() -> Kind:
    """A key before a choke: what flows when it opens is gone at once."""
    nodes = [
        bg.Se("E", "E"),
        bg.One("n"),
        bg.R("R", "R"),
        bg.I("L", "L", flow="i"),
        bg.Sw("key", on="0.5 - gate"),
    ]

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {
            "i": stepwise(t, (0, lambda s: 5 * (1 - np.exp(-s / 0.2))), (0.3, lambda s: 0 * s),
                          (0.7, lambda s: 5 * (1 - np.exp(-s / 0.2))))}  # fmt: skip

    return Kind(
        "ideal switch, commanded, in series with an inductor", bond_graph(nodes, "E>n>R n>L n>key"),
        {"R": 2.0, "L": 0.4}, {"E": "10", "gate": GATE}, known, 0.99, on=("key",), at=0.5,
        mode={"key": "off"}, rest={"inputs": {"E": 10.0, "gate": 0.0}},
    )  # fmt: skip


def key_across() -> Kind:
    """A key across a capacitor: it discharges at once, and is charged again."""
    nodes = [
        bg.Se("E", "E"),
        bg.One("n"),
        bg.R("R", "R"),
        bg.Zero("z"),
        bg.C("C", "C", effort="v"),
        bg.Sw("key", on="gate - 0.5"),
    ]

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {
            "v": stepwise(t, (0, lambda s: 10 * (1 - np.exp(-s / 0.2))), (0.3, lambda s: 0 * s),
                          (0.7, lambda s: 10 * (1 - np.exp(-s / 0.2))))}  # fmt: skip

    return Kind(
        "ideal switch, commanded, across a capacitor", bond_graph(nodes, "E>n>R n>z>C z>key"),
        {"R": 2.0, "C": 0.1}, {"E": "10", "gate": GATE}, known, 0.99, at=0.5, mode={"key": "on"},
        rest={"inputs": {"E": 10.0, "gate": 0.0}},
    )  # fmt: skip


def _joined(*dogs: tuple, bonds: str, name: str, end_of_join: float, **inputs: str) -> Kind:
    """Two shafts that are one from 0.3 s on: momentum stays; T turns the first, or both."""
    T, J1, J2 = 4.0, 1.0, 3.0
    before, other = 2.0 + T * 0.3 / J1, -1.0
    meets = (J1 * before + J2 * other) / (J1 + J2)
    apart = meets + T / (J1 + J2) * (end_of_join - 0.3)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {
            "w_1": stepwise(t, (0, lambda s: 2 + T / J1 * s), (0.3, lambda s: meets + T / (J1 + J2) * s),
                            (end_of_join, lambda s: apart + T / J1 * s)),
            "w_2": stepwise(t, (0, lambda s: other + 0 * s), (0.3, lambda s: meets + T / (J1 + J2) * s),
                            (end_of_join, lambda s: apart + 0 * s)),
        }  # fmt: skip

    names = [dog[0] for dog in dogs if dog[1]["kind"] == "Sw"]
    mode = dict.fromkeys(names, "off") | ({"late": "on"} if "late" in names else {})
    return Kind(
        name, _shafts(*dogs, bonds=bonds), {"J_1": J1, "J_2": J2}, {"T": f"{T}", **inputs}, known, 0.99,
        {"w_1": 2.0, "w_2": other}, on=tuple(names), at=0.4, mode=mode,
        rest={"inputs": {"T": 0.0} | dict.fromkeys(inputs, 1.0)},
    )  # fmt: skip


def dog() -> Kind:
    return _joined(
        bg.Sw("dog", on="0.5 - gate"), bonds="gap>dog", name="dog, commanded by an input",
        end_of_join=0.7, gate=GATE,
    )  # fmt: skip


def two_dogs() -> Kind:
    """One holds from 0.3 to 0.6 s, the other from 0.5 to 0.7 s."""
    return _joined(
        bg.Sw("soon", on="0.5 - one"), bg.Sw("late", on="0.5 - two"), bg.One("slip"),
        bonds="gap>slip slip>soon slip>late",
        name="two dogs on one slip", end_of_join=0.7, one="step(0.3, 1, 0) + step(0.6, -1, 0)",
        two="step(0.5, 1, 0) + step(0.7, -1, 0)",
    )  # fmt: skip


def controlled_one() -> Kind:
    """A valve that is a 1-junction: open from 0.3 to 0.7 s it fills a tank."""
    nodes = [
        bg.Se("pump", "p"),
        bg.One("valve", on="gate - 0.5"),
        bg.R("pipe", "R"),
        bg.C("tank", "C", effort="h"),
    ]

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"h": relaxed(np.clip(t, 0.3, 0.7), 1.0, 0.25, [(0.3, 5.0)])}

    return Kind(
        "controlled 1-junction", bond_graph(nodes, "pump>valve>pipe valve>tank"), {"R": 0.5, "C": 0.5},
        {"p": "5", "gate": GATE}, known, 0.99, {"h": 1.0}, at=0.5, mode={"valve": "on"},
        rest={"inputs": {"p": 5.0, "gate": 1.0}},
    )  # fmt: skip


def controlled_zero() -> Kind:
    """A 0-junction between a source behind R and a choke: off, it is a short."""
    nodes = [bg.Se("E", "E"), bg.One("in"), bg.R("R", "R"), bg.Zero("z", on="gate - 0.5"), bg.One("out"),
             bg.I("L", "L", flow="i"), bg.R("S", "S")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:

        def short(s: Array, i: float = 1.0) -> Array:
            return i * np.exp(-s * 3 / 0.6)

        i = float(short(0.3))

        def driven(s: Array) -> Array:
            return 2 + (i - 2) * np.exp(-s * 5 / 0.6)

        out = float(driven(0.4))
        return {"i": stepwise(t, (0, short), (0.3, driven), (0.7, lambda s: short(s, out)))}

    return Kind(
        "controlled 0-junction", bond_graph(nodes, "E>in>R in>z>out>L out>S"), {"R": 2.0, "S": 3.0, "L": 0.6},
        {"E": "10", "gate": GATE}, known, 0.99, {"i": 1.0}, at=0.5, mode={"z": "on"},
        rest={"inputs": {"E": 10.0, "gate": 1.0}},
    )  # fmt: skip


def pwm() -> Kind:
    """Closed while sin(31 t + 0.3) > 0: a lag that goes on for as long as it was closed."""
    w, a, tau = 31.0, 0.3, 0.2

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        turns, rest = np.divmod(w * t + a, 2 * np.pi)
        closed = (turns * np.pi + np.minimum(rest, np.pi) - a) / w
        return {"v": 10 * (1 - np.exp(-closed / tau))}

    nodes = [bg.Se("E", "E"), bg.One("n"), bg.R("R", "R"), bg.C("C", "C", effort="v"),
             bg.Sw("key", on="sin(31*t + 0.3)")]  # fmt: skip
    return Kind(
        "PWM by time alone", bond_graph(nodes, "E>n>R n>C n>key"), {"R": 2.0, "C": 0.1}, {"E": "10"}, known,
        0.99, at=0.05, mode={"key": "on"}, rest={"inputs": {"E": 10.0}},
    )  # fmt: skip


def buck() -> Kind:
    """A choke between E and 0 by a key and a diode: its current never dies."""
    E, R, L = 12.0, 2.0, 0.5
    nodes = [bg.Se("src", "E"), bg.One("s"), bg.Sw("q", on="cos(31*t)"), bg.Zero("n"),
             bg.Freewheel("d"), bg.One("l"), bg.I("L", "L", flow="i"), bg.R("R", "R")]  # fmt: skip
    half = np.pi / 31
    edges = [(0.0, E / R), *(((k + 0.5) * half, 0.0 if k % 2 == 0 else E / R) for k in range(12))]

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"i": relaxed(t, 3.0, L / R, edges)}

    return Kind(
        "commanded switch beside a diode (buck)", bond_graph(nodes, "src>s>q s>n n>d n>l>L l>R"),
        {"R": R, "L": L}, {"E": f"{E}"}, known, 0.99, {"i": 3.0}, on=("q",), at=0.02,
        mode={"q": "on", "d": "off"}, rest={"inputs": {"E": E}},
    )  # fmt: skip


def latch() -> Kind:
    """A fan that cools from 30 degrees on until 25 are reached: each way a lag, crossed again and again."""
    P, C, R, fan = 12.0, 2.0, 10.0, 1.0
    nodes = [bg.Sf("power", "P"), bg.Zero("n"), bg.Sw("relay", on="theta - 30", off="25 - theta"),
             bg.One("pass"), bg.R("fan", "R_f"), bg.C("room", "C", effort="theta"),
             bg.R("wall", "R")]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        parts, begin, theta = [], 0.0, 27.0
        heating, cooling = (P * R, R * C), (P / (1 / R + 1 / fan), C / (1 / R + 1 / fan))
        for k in range(12):
            (to, tau), goal = (heating, 30.0) if k % 2 == 0 else (cooling, 25.0)
            parts.append(
                (begin, lambda s, v=theta, to=to, tau=tau: to + (v - to) * np.exp(-s / tau))
            )
            begin += tau * np.log((theta - to) / (goal - to))
            theta = goal
        return {"theta": stepwise(t, *parts)}

    return Kind(
        "latch (a general condition)",
        bond_graph(nodes, "power>n n>room n>wall n>pass pass>fan pass>relay"),
        {"C": C, "R": R, "R_f": fan}, {"P": f"{P}"}, known, 3.97, {"theta": 27.0}, at=0.3,
        mode={"relay": "off"}, rest={"inputs": {"P": 1.0}, "initial": {"theta": 9.0}},
    )  # fmt: skip


SWITCHES = (
    diode, clamp, bridge, check_valve, freewheel, freewheel_and_brake, key_in_series, key_across, dog,
    two_dogs, controlled_one, controlled_zero, pwm, buck, latch,
)  # fmt: skip

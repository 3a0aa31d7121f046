"""Dry friction in its forms, each with a run that is known by hand."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from references.build import bond_graph
from scipy.special import ellipk

import bondgraph as bg
from oracles.routes.kind import Array, Kind, stepwise

F, V0, A = 4.0, 0.5, 6.0
STOPS, GOES = (F - np.sqrt(F**2 - 2 * V0 * A)) / A, F / A
RAMP = {"P": f"ramp(0, {A})"}


def _braked(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
    """v' = -F + A t from v_0 on until it is gone; from F/A on again."""
    v = stepwise(t, (0, lambda s: V0 - F * s + A * s**2 / 2), (STOPS, lambda s: 0 * s),
                 (GOES, lambda s: A * s**2 / 2))  # fmt: skip
    return {"v": v}


def _block(law: bg.DryFriction, *more: tuple, bonds: str = ""):
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"),
             bg.R("rub", effort="f", flow="slip_v", law=law), *more]  # fmt: skip
    return bond_graph(nodes, f"push>n>m n>rub {bonds}")


def coulomb() -> Kind:
    return Kind(
        "dry friction", _block(bg.DryFriction("N")), {"m": 1.0, "N": F}, RAMP, _braked, 1.0, {"v": V0},
        at=0.4, mode={"rub": "stick"}, rest={"inputs": {"P": 2.0}},
    )  # fmt: skip


def level_of_input() -> Kind:
    """v' = -N(t) = -3 t: at rest after sqrt(2 v_0/3)."""

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": np.maximum(1.0 - 1.5 * t**2, 0) * (t < (1 / 1.5) ** 0.5)}

    return Kind(
        "its level an input", _block(bg.DryFriction("N")), {"m": 1.0}, {"P": "0", "N": "ramp(0, 3)"},
        known, 1.0, {"v": 1.0}, at=0.4, mode={"rub": "slip"}, rest={"inputs": {"P": 1.0, "N": 2.0}},
    )  # fmt: skip


def breakaway() -> Kind:
    """Level 4, breakaway 6: it goes at 6 = 9 t, with v' = 9 t - 4."""
    t0 = 6 / 9

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": stepwise(t, (t0, lambda s: 2 * s + 4.5 * s**2))}

    return Kind(
        "breakaway above its level", _block(bg.DryFriction("N", breakaway=1.5)), {"m": 1.0, "N": 4.0},
        {"P": "ramp(0, 9)"}, known, 1.0, at=0.4, mode={"rub": "stick"}, rest={"inputs": {"P": 5.0}},
    )  # fmt: skip


def stribeck() -> Kind:
    """m v' = a - b exp(-v/w) has v = w log((b + (a - b) exp(a t/(m w)))/a)."""
    a, b, w = 6.0 - 4.0, 1.2, 0.1

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": w * np.log((b + (a - b) * np.exp(a * t / w)) / a)}

    law = bg.DryFriction("N", curve="1 + 0.3*exp(-slip/0.1)")
    return Kind(
        "a Stribeck curve", _block(law), {"m": 1.0, "N": 4.0}, {"P": "6"}, known, 1.0,
        at=0.1, mode={"rub": "slip"}, rest={"inputs": {"P": 5.0}},
    )  # fmt: skip


def asymmetric() -> Kind:
    """(1 + v/4) N whichever way it slips: v' = P + N + N v/4 until it turns, v' = P - N - N v/4 then."""
    n, p, v0 = 2.0, 5.0, -1.4
    up, down = 4 * (p + n) / n, 4 * (p - n) / n
    turns = np.log(up / (up + v0)) * 4 / n

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {
            "v": stepwise(t, (0, lambda s: -up + (v0 + up) * np.exp(n / 4 * s)),
                          (turns, lambda s: down * (1 - np.exp(-n / 4 * s))))}  # fmt: skip

    return Kind(
        "another level each way", _block(bg.DryFriction("N", curve="1 + slip_v/4")),
        {"m": 1.0, "N": n}, {"P": f"{p}"}, known, 1.0, {"v": v0}, at=0.6, mode={"rub": "slip"},
        rest={"inputs": {"P": 1.0}},
    )  # fmt: skip


_STORE = (bg.Zero("z"), bg.C("store", "C", effort="s"), bg.R("leak", "R"))


def level_of_state() -> Kind:
    """A level mu s, s = s_0 exp(-t/T): it goes at T log(mu s_0/P)."""
    mu, s0, tau, p = 0.5, 8.0, 0.5, 2.0
    goes = tau * np.log(mu * s0 / p)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {
            "s": s0 * np.exp(-t / tau),
            "v": stepwise(t, (goes, lambda s: p * s - p * tau * (1 - np.exp(-s / tau)))),
        }

    return Kind(
        "its level a state", _block(bg.DryFriction("mu*abs(s)"), *_STORE, bonds="z>store z>leak"),
        {"m": 1.0, "mu": mu, "C": 0.25, "R": 2.0}, {"P": f"{p}"}, known, 1.0, {"s": s0},
        at=0.6, mode={"rub": "slip"}, rest={"inputs": {"P": 0.0}},
    )  # fmt: skip


def curve_of_state() -> Kind:
    """A curve 1 + s: v' = P - N - N s_0 exp(-t/T)."""
    n, s0, tau, p = 2.0, 1.0, 0.5, 6.0

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {
            "v": (p - n) * t - n * s0 * tau * (1 - np.exp(-t / tau)),
        }

    return Kind(
        "its curve of a state", _block(bg.DryFriction("N", curve="1 + s"), *_STORE, bonds="z>store z>leak"),
        {"m": 1.0, "N": n, "C": 0.25, "R": 2.0}, {"P": f"{p}"}, known, 1.0, {"s": s0},
        at=0.6, mode={"rub": "slip"}, rest={"inputs": {"P": 1.0}},
    )  # fmt: skip


def ruled_by_load() -> Kind:
    """A level mu times the pull that the friction leaves: m v' = P/(1 + mu) - b v."""
    nodes = [bg.Se("push", "P"), bg.One("a"), bg.R("rub", law=bg.DryFriction("mu*abs(pull)")),
             bg.Zero("rope", effort="pull"), bg.One("n"), bg.I("m", "m", flow="v"),
             bg.R("b", "b")]  # fmt: skip
    mu, b, p = 0.6, 2.0, 5.0

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"v": p / (1 + mu) / b * (1 - np.exp(-b * t))}

    return Kind(
        "its level the load that it leaves", bond_graph(nodes, "push>a>rub a>rope>n>m n>b"),
        {"m": 1.0, "mu": mu, "b": b}, {"P": f"{p}"}, known, 1.0, at=0.6, mode={"rub": "slip"},
        rest={"inputs": {"P": p}, "initial": {"v": 1.0}},
    )  # fmt: skip


def bollard() -> Kind:
    """A rope round a bollard holds a load W until it is pulled e^(mu phi) times as hard, then lifts it.

    At rest the level goes by the load, and what it holds is the pull less the load; as the rope slips
    m v' = P e^-(mu phi) - W - b v, with P - P_0 = A t.
    """
    nodes = [bg.Se("hand", "P"), bg.Se("before", "P_0"), bg.One("a"), bg.Zero("rope", effort="pull"),
             bg.R("post", law=bg.DryFriction("(exp(mu*phi) - 1)*abs(pull)")), bg.One("n"),
             bg.I("m", "m", flow="v"), bg.R("b", "b"), bg.Se("weight", "G")]  # fmt: skip
    mu, phi, w, b, first, rise = 0.3, 2.0, 1.0, 2.0, 1.5, 2.0
    times = np.exp(mu * phi)
    slips = (w * times - first) / rise

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        s = np.maximum(t - slips, 0)
        v = rise / times * (s / b - (1 - np.exp(-b * s)) / b**2)
        return {"v": v}

    return Kind(
        "a rope round a bollard",
        bond_graph(nodes, "hand>a before>a a>post a>rope>n>m n>b weight>n"),
        {"m": 1.0, "mu": mu, "phi": phi, "b": b, "P_0": first, "G": -w}, {"P": f"ramp(0, {rise})"},
        known, 1.0, at=0.6, mode={"post": "slip"}, rest={"inputs": {"P": 0.1}},
    )  # fmt: skip


def on_a_spring() -> Kind:
    """An imposed speed, 1 then -1, over a spring k and a slider N in series: the force stays within N."""
    return _jenkins(
        "directly on a spring", [bg.R("rub", law=bg.DryFriction("N"))], "z>rub", {"N": 2.0}
    )


def put_later() -> Kind:
    """The same, the port open where the graph is derived, and closed by dry friction after it."""
    closed = _jenkins("put later on a spring", [bg.R("rub")], "z>rub", {"N": 2.0})
    return replace(closed, later={"rub": "friction(N)"})


def in_series() -> Kind:
    """The same with a second slider beside it, of a greater level: it never slips."""
    rubs = [
        bg.R("rub", law=bg.DryFriction("N")),
        bg.R("firm", flow="creep", law=bg.DryFriction("M")),
    ]
    return _jenkins("two in series on a spring", rubs, "z>rub z>firm", {"N": 2.0, "M": 3.0})


def _jenkins(name: str, rubs: list, bonds: str, numbers: dict[str, float]) -> Kind:
    k, n = 10.0, 2.0
    nodes = [bg.Sf("drive", "w"), bg.Zero("z", effort="force"), bg.C("k", "1/k", effort="s"), *rubs]

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {"s": np.where(t < 0.5, np.minimum(k * t, n), np.maximum(n - k * (t - 0.5), -n))}

    mode = {rub[0]: "stick" for rub in rubs} | {"rub": "slip"}
    return Kind(
        name, bond_graph(nodes, f"drive>z>k {bonds}"), {"k": k, **numbers}, {"w": "step(0.5, -1, 1)"},
        known, 0.99, at=0.35, mode=mode, rest={"inputs": {"w": 0.0}},
    )  # fmt: skip


def together() -> Kind:
    """Two on one slip: at rest they share the load, which nothing else tells apart."""
    graph = _block(bg.DryFriction("N"), bg.R("two", law=bg.DryFriction("M")), bonds="n>two")
    return Kind(
        "two on one slip", graph, {"m": 1.0, "N": 3.0, "M": 1.0}, RAMP, _braked, 1.0, {"v": V0},
        at=0.1, mode={"rub": "slip", "two": "slip"}, rest={"inputs": {"P": 2.0}},
    )  # fmt: skip


def chain() -> Kind:
    """Seven blocks alike, springs between them, each pushed: no spring is ever loaded."""
    nodes, bonds = [], []
    for i in range(7):
        nodes += [bg.Se(f"push{i}", "P"), bg.One(f"n{i}"), bg.I(f"m{i}", "m", flow=f"v{i}"),
                  bg.R(f"rub{i}", law=bg.DryFriction("N"))]  # fmt: skip
        bonds += [f"push{i}>n{i}>m{i} n{i}>rub{i}"]
    for i in range(6):
        nodes += [bg.Zero(f"z{i}"), bg.C(f"k{i}", "1/k", effort=f"s{i}")]
        bonds += [f"n{i}>z{i}>n{i + 1} z{i}>k{i}"]

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        return {f"v{i}": _braked(t, run)["v"] for i in range(7)}

    return Kind(
        "seven in a chain", bond_graph(nodes, " ".join(bonds)), {"m": 1.0, "N": F, "k": 50.0}, RAMP,
        known, 1.0, {f"v{i}": V0 for i in range(7)}, at=0.1,
        mode={f"rub{i}": "slip" for i in range(7)}, rest={"inputs": {"P": 2.0}},
    )  # fmt: skip


def behind_moving_ratio() -> Kind:
    """A crank that a slider brakes: J w^2/2 + N r (1 - cos theta) stays, until it rests.

    That is at 60 degrees, after K(1/4).
    """
    nodes = [bg.Se("drive", "P"), bg.One("shaft"), bg.I("J", "J", flow="w"),
             bg.Df("angle", integrate="theta"), bg.TF("yoke", "r*sin(theta)"), bg.One("slider"),
             bg.R("rub", law=bg.DryFriction("N"))]  # fmt: skip

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        theta = run["theta"]
        rests = t > ellipk(0.25)
        left = np.sqrt(np.maximum(2 * np.cos(theta) - 1, 0))
        return {"w": np.where(rests, 0, left), "theta": np.where(rests, np.pi / 3, theta)}

    return Kind(
        "behind a moving ratio", bond_graph(nodes, "drive>shaft>J shaft>angle shaft>yoke>slider>rub"),
        {"J": 1.0, "r": 0.5, "N": 2.0}, {"P": "0"}, known, 2.5, {"w": 1.0, "theta": 0.0},
        at=0.5, mode={"rub": "slip"}, rest={"inputs": {"P": 0.2}, "initial": {"theta": 1.0}},
    )  # fmt: skip


def warmed() -> Kind:
    """A brake that warms up by what it takes, and cools: theta' = (N (u - slow t) - h theta)/c, to rest."""
    u, slow, stops = 3.0, 2.0, 1.5
    k, a, b = 4.0 / 2.0, 5.0 * u / 2.0, 5.0 * slow / 2.0
    nodes = [bg.Se("drive", "M"), bg.One("n"), bg.I("m", 1.0, flow="w"),
             bg.R("brake", effort="tau", flow="s", law=bg.DryFriction("N")),
             bg.Se("heat", "tau*s - h*theta"), bg.One("warm"),
             bg.I("body", "c", flow="theta")]  # fmt: skip

    def warm(s: Array) -> Array:
        return (a + b / k) / k * -np.expm1(-k * s) - b / k * s

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        last = float(warm(np.array(stops)))
        return {
            "w": np.maximum(u - slow * t, 0),
            "theta": stepwise(t, (0.0, warm), (stops, lambda s: last * np.exp(-k * s))),
        }

    return Kind(
        "warmed by what it takes, by a law that only reads that",
        bond_graph(nodes, "drive>n>m n>brake heat>warm>body"), {"h": 4.0, "c": 2.0},
        {"M": "3", "N": "5"}, known, 3.0, {"w": u}, at=1.0, mode={"brake": "slip"},
        rest={"inputs": {"M": 3.0, "N": 5.0}},
    )  # fmt: skip


def followed() -> Kind:
    """A signal that repeats what a brake gives, and a state of it, which is how far it has slowed."""
    N, u, stops = 2.0, 1.5, 0.75

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        w = np.maximum(u - N * t, 0.0)
        return {"w": w, "lost": 3 * (u - w)}

    nodes = [bg.One("n"), bg.I("m", "m", flow="w"),
             bg.R("brake", effort="tau", flow="s", law=bg.DryFriction("N")),
             bg.State("lost", "copied"), bg.Function("copied", "gain*tau")]  # fmt: skip
    return Kind(
        "read by a law that acts on nothing that slips", bond_graph(nodes, "n>m n>brake"),
        {"m": 1.0, "gain": 3.0}, {"N": f"{N}"}, known, 1.5, {"w": u}, at=stops / 2, mode={"brake": "slip"},
        rest={"inputs": {"N": N}},
    )  # fmt: skip


FRICTION = (
    coulomb, level_of_input, breakaway, stribeck, asymmetric, level_of_state, curve_of_state,
    ruled_by_load, bollard, on_a_spring, put_later, in_series, together, chain, behind_moving_ratio, warmed,
    followed,
)  # fmt: skip

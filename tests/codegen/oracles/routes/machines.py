"""State machines, each with a run that is known by hand."""

from collections.abc import Mapping

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from oracles.routes.kind import Array, Kind, stepwise


def _shaft(torque: str, *nodes: bg.nodes.elements.Node) -> "bg.BondGraph":
    """J w' = torque - b w."""
    return bond_graph(
        [bg.Se("drive", torque), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b"), *nodes],
        "drive>shaft>J shaft>b",
    )  # fmt: skip


def selector() -> Kind:
    """A gear that goes up at a speed of 2 and down at one of 1: w' = 2 F - w in low, F - w in high."""
    F, cut = 1.5, 1.7
    up = np.log(3.0)
    at_cut = F + (2 - F) * np.exp(up - cut)
    down = cut + np.log(at_cut)

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        w = stepwise(
            t, (0.0, lambda s: 3 * (1 - np.exp(-s))), (up, lambda s: F + (2 - F) * np.exp(-s)),
            (cut, lambda s: at_cut * np.exp(-s)), (down, lambda s: np.exp(-s)),
        )  # fmt: skip
        gear = stepwise(
            t, (0.0, lambda s: 0 * s), (up, lambda s: 1 + 0 * s), (down, lambda s: 0 * s)
        )
        return {"omega": w, "gear": gear}

    gear = bg.StateMachine(
        "gear", ["low", "high"], {"low > high": "omega - up", "high > low": "down - omega"}
    )
    return Kind(
        "state machine with hysteresis", _shaft("F*(2*gear_low + gear_high)", gear),
        {"J": 1.0, "b": 1.0, "up": 2.0, "down": 1.0}, {"F": f"step({cut}, 0, {F})"}, known, 2.5, at=1.4,
        mode={"gear": "high"}, rest={"inputs": {"F": F}, "initial": {"gear": 1.0, "omega": F}},
    )  # fmt: skip


def launch() -> Kind:
    """It launches as a throttle comes to 1/10, with twice the torque until the speed is 1, then in gear 1."""
    begin = 0.2
    # At first w' = s + 1/5, s after the begin; then half as much times the gear that it comes to.
    s1 = -0.2 + np.sqrt(0.04 + 2.0)
    gear = 0.75

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        w = stepwise(
            t, (0.0, lambda s: 0 * s), (begin, lambda s: s**2 / 2 + s / 5),
            (begin + s1, lambda s: 1 + gear * (s**2 / 4 + (s1 / 2 + 0.1) * s)),
        )  # fmt: skip
        mode = stepwise(
            t,
            (0.0, lambda s: 0 * s),
            (begin, lambda s: 1 + 0 * s),
            (begin + s1, lambda s: 2 + 0 * s),
        )
        return {"omega": w, "box": mode, "gear": np.where(mode == 2, gear, 0.0)}

    box = bg.StateMachine(
        "box", ["idle", "launch", "drive"], start="idle", states={"gear": "none"},
        transitions={
            "idle > launch": "throttle - 1/10",
            "launch > drive": ("omega - 1", {"gear": "gear + 3/4*omega"}),
            "drive > idle": "-throttle",
        },
    )  # fmt: skip
    graph = bond_graph(
        [bg.Se("drive", "1*force"), bg.One("shaft"), bg.I("J", "J", flow="omega"),
         bg.Function("force", "throttle*(2*box_launch + gear)"), box], "drive>shaft>J",
    )  # fmt: skip
    return Kind(
        "state machine with an action", graph, {"J": 1.0, "none": 0.0}, {"throttle": "ramp(0, 0.5)"},
        known, 1.9, at=0.7, mode={"box": "launch"}, rest={"inputs": {"throttle": 0.0}},
    )  # fmt: skip


def begun() -> Kind:
    """A guard above zero as the run begins, another that follows at once; then one by time."""

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        level = stepwise(t, (0.0, lambda s: 2 + 3 * s), (0.5, lambda s: 3.5 - s))
        after = t >= 0.5
        return {"x": level, "m": np.where(after, 3.0, 2.0), "n": np.where(after, 111.0, 11.0)}

    machine = bg.StateMachine(
        "m", ["off", "warm", "run", "down"], states={"n": 0},
        transitions={
            "off > warm": ("x - 1/2", {"n": "n + 1", "x": "x + 1"}),
            "off > down": "x - 1/2",
            "warm > run": ("1 - off", {"n": "n + 10"}),
            "run > down": ("t - 1/2", {"n": "n + 100"}),
        },
    )  # fmt: skip
    graph = bond_graph([bg.State("x", "rate*m_run - m_down", start=1), machine], "")
    return Kind("state machine that begins by transitions", graph, {"rate": 3.0, "off": 0.0}, {}, known, 1.0,
                at=0.7, mode={"m": "down"}, rest={"initial": {"x": 0.2}})  # fmt: skip


def chained() -> Kind:
    """x' = 1 up to 1; then, at one instant, through three modes, in the last of which x' = -1; and again."""

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        x = stepwise(
            t,
            (0.0, lambda s: s),
            (1.0, lambda s: 2 - s),
            (3.0, lambda s: s),
            (4.0, lambda s: 2 - s),
        )
        away = ((t >= 1) & (t < 3)) | (t >= 4)
        return {
            "x": x,
            "n": stepwise(
                t,
                (0.0, lambda s: 0 * s),
                (1.0, lambda s: 21 + 0 * s),
                (3.0, lambda s: 22 + 0 * s),
                (4.0, lambda s: 65 + 0 * s),
            ),
            "p": np.where(away, 3.0, 0.0),
        }

    machine = bg.StateMachine(
        "p", ["up", "b", "c", "down"], states={"n": 0},
        transitions={
            "up > b": ("x - one", {"n": "n + 1", "x": "2*x"}),
            "up > c": ("2*x - 2*one", {"n": "-1"}),
            "b > c": ("x - 3/2", {"n": "2*n + 1"}),
            "c > down": ("x - 1/2", {"n": "n + 3*5 + 3"}),
            "down > up": ("-x", {"n": "n + 1"}),
        },
    )  # fmt: skip
    graph = bond_graph([bg.State("x", "p_up - p_down"), machine], "")
    return Kind("state machine that goes on at once", graph, {"one": 1.0}, {}, known, 4.5, at=0.5,
                mode={"p": "up"}, rest={"initial": {"x": 0.5, "p": 1.0}})  # fmt: skip


def ticked() -> Kind:
    """A controller's instants alone tell what it reads, and a transition to itself counts how often."""
    T = 0.25

    def known(t: Array, run: Mapping[str, Array]) -> dict[str, Array]:
        # x' = 1 up to the first instant above 0.8, then -1 to the first below 0.1, and so on.
        turns = [1.0, 2.0, 3.0]
        x = stepwise(
            t,
            (0.0, lambda s: s),
            (1.0, lambda s: 1 - s),
            (2.0, lambda s: s),
            (3.0, lambda s: 1 - s),
        )
        mode = sum((-1) ** k * (t >= turn - 1e-12) for k, turn in enumerate(turns))
        counted = sum((t >= turn + 0.5 - 1e-12) * 1.0 for turn in (0.0, 1.0, 2.0))
        return {"x": x, "way": mode * 1.0, "passed": counted}

    nodes = [
        bg.State("x", "drive*(way_up - way_down)"), bg.Controller("sensor", every=T, gives={"seen": "x"}),
        bg.StateMachine(
            "way", ["up", "down"], {"up > down": "seen - most", "down > up": "least - seen"}
        ),
        bg.StateMachine(
            "counter", ["on"], states={"passed": 0},
            transitions={"on > on": ("(x - 1/2)*(way_up - way_down)", {"passed": "passed + 1"})},
        ),
    ]  # fmt: skip
    return Kind("state machine that reads a controller", bond_graph(nodes, ""), {"most": 0.8, "least": 0.1},
                {"drive": "1"}, known, 3.2, at=0.7, mode={"way": "up", "counter": "on"},
                rest={"inputs": {"drive": 0.0}, "initial": {"x": 0.3}})  # fmt: skip


MACHINES = (selector, launch, begun, chained, ticked)

"""Stretches and choices of mode that recur, which the exact engine in C knows from before: they are made
again only where nothing else can have happened. The judge has one current in closed form."""

import shutil
from typing import Any, NamedTuple

import numpy as np
import pytest
import scipy.optimize
from numpy.typing import NDArray
from references.build import bond_graph

import bondgraph as bg
from codegen import Result, Simulator, Sine, Step, simulator

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")

E, A, L, R = 10.0, 6.0, 2e-3, 1.0
SLOW, FAST, BIAS = 200 * np.pi, 4000 * np.pi, 0.8
"""Of the load's source and of the switch [rad/s]; the switch is on while sin(FAST t) is above -BIAS."""

END = 0.03
VOLTAGES = {"on": E, "low": 0.0, "high": 2 * E}
"""What the load has where the switch is on or a diode; else its current is zero."""


class Judged(NamedTuple):
    """What happens, by port and kind, and the current at samples."""

    events: list[tuple[float, str, str]]
    current: NDArray[np.float64]


def _after(t: float, i: float, voltage: float, at: Any) -> Any:
    """The current at some times, which is i at t: L i' + R i = voltage - E - A sin(SLOW t)."""
    size = R**2 + (SLOW * L) ** 2

    def forced(t: Any) -> Any:
        turned = R * np.sin(SLOW * t) - SLOW * L * np.cos(SLOW * t)
        return (voltage - E) / R - A / size * turned

    return forced(at) + (i - forced(t)) * np.exp(-R / L * (at - t))


def _switchings() -> list[tuple[float, bool]]:
    """When the switch changes over, and whether it is on then."""
    down = (np.pi + np.arcsin(BIAS)) / FAST
    up = (2 * np.pi - np.arcsin(BIAS)) / FAST
    periods = range(int(END * FAST / (2 * np.pi)) + 1)
    found = [
        (k * 2 * np.pi / FAST + at, on) for k in periods for at, on in ((down, False), (up, True))
    ]
    return [(t, on) for t, on in found if t < END]


def _judged(times: NDArray[np.float64]) -> Judged:
    """A leg whose current goes on through a diode as its switch opens: down if positive, else up."""
    t, i, mode = 0.0, 0.0, "on"
    events: list[tuple[float, str, str]] = []
    current = np.zeros(len(times))

    def go(stop: float) -> None:
        nonlocal t, i
        inside = (times >= t) & (times < stop)
        if mode != "none":
            current[inside] = _after(t, i, VOLTAGES[mode], times[inside])
            i = float(_after(t, i, VOLTAGES[mode], stop))
        t = stop

    for until, on in [*_switchings(), (END + 1e-12, True)]:
        sign = {"low": 1.0, "high": -1.0}.get(mode, 0.0)
        # The current of a diode falls all the way.
        if sign and sign * _after(t, i, VOLTAGES[mode], until) < 0:
            begin = t, i, VOLTAGES[mode]
            go(
                float(
                    scipy.optimize.brentq(lambda at, x=begin: _after(*x, at), t, until, xtol=1e-17)
                )
            )
            events.append((t, mode, "off"))
            i, mode = 0.0, "none"
        go(until)
        if until < END and on:
            events.append((t, "q", "on"))
            events += [(t, mode, "off")] if mode != "none" else []
            mode = "on"
        elif until < END:
            mode = "low" if i > 0 else "high"
            events += [(t, "q", "off"), (t, mode, "on")]
    return Judged(events, current)


NODES = [
    bg.Se("mid", "E"), bg.One("s"), bg.Sw("q", on="sin(w*t) + 0.8"), bg.Zero("n"),
    bg.Sw("low", on="-e_low", off="f_low"), bg.One("top"), bg.Se("rail", "2*E"), bg.Diode("high"),
    bg.One("load"), bg.I("L", "L", flow="i"), bg.R("R", "R"), bg.Se("back", "e"),
]  # fmt: skip
LEG = bg.derive(bond_graph(NODES, "mid>s>q s>n>low n>top>rail top>high n>load>L load>R load>back"))


def _ready() -> Simulator:
    return simulator(LEG, {"E": E, "L": L, "R": R, "w": FAST}, backend="c")


def _run(ready: Simulator, times: NDArray[np.float64]) -> Result:
    """By the exact engine, and no other in its place."""
    done = ready.run(times, inputs={"e": Sine(A, SLOW / (2 * np.pi), offset=E)}, method="exact")
    assert done.backend == "c"
    return done


def _times(kind: str) -> NDArray[np.float64]:
    random = np.random.default_rng(7)
    few = {
        "at switchings": [0.0, *(t for t, _ in _switchings()), END],
        "one": [0.0, END],
        "ragged": [0.0, *np.sort(random.uniform(0, END, 700)), END],
    }
    return np.array(few[kind]) if kind in few else np.linspace(0.0, END, int(kind))


@pytest.mark.parametrize("kind", ["one", "at switchings", "ragged", "61", "3001"])
def test_what_recurs_is_as_a_judge_finds(kind: str) -> None:
    """The current ends in some periods and not in others, and goes on down or up: the same switching of the
    same mode has three outcomes; stretches of one length end in two ways."""
    times = _times(kind)
    expected, found = _judged(times), _run(_ready(), times)
    told = [(event.port, event.kind) for event in found.events]
    by_judge = [event[1:] for event in expected.events]
    assert {("low", "on"), ("high", "on"), ("low", "off"), ("high", "off")} <= set(by_judge)
    assert len(by_judge) > 150
    assert told == by_judge
    at = np.array([event.time for event in found.events])
    assert at == pytest.approx([event[0] for event in expected.events], abs=1e-13)
    assert found["i"] == pytest.approx(
        expected.current, abs=1e-9 * np.ptp(expected.current) + 1e-12
    )


def test_a_run_does_not_depend_on_the_one_before() -> None:
    times = _times("61")
    ready = _ready()
    one, two = (_run(ready, times) for _ in range(2))
    assert one["i"].tolist() == two["i"].tolist()
    assert [event.time for event in one.events] == [event.time for event in two.events]


DIPS = [
    bg.Se("src", "u"), bg.Zero("z"), bg.One("s"), bg.Sw("q", on="sin(w*t)"), bg.R("r2", 1),
    bg.One("l"), bg.I("L", "L", flow="i"), bg.Zero("o"), bg.C("c", "C", effort="v"),
    bg.One("k"), bg.Diode("d"), bg.R("r", 1), bg.Se("bias", "B"),
]  # fmt: skip
RINGING = bg.derive(bond_graph(DIPS, "src>z z>s s>q s>r2 z>l l>L l>o o>c o>k k>d k>r k>bias"))


def test_what_the_state_does_within_a_stretch_is_seen() -> None:
    """A resonance grows by one period in each half period of a switch: v = A/2 (sin x - x cos x), where x is
    2 w t. At its ends v is lowest, within them a diode conducts as soon as v comes to B."""
    w, bias = 100 * np.pi, 33.0
    L, C = 1e-2, 1 / (1e-2 * (2 * w) ** 2)
    ready = simulator(RINGING, {"w": w, "L": L, "C": C, "B": bias}, backend="c")
    end = 14.5 * np.pi / w
    done = ready.run([0.0, end], inputs={"u": Sine(1, 2 * w / (2 * np.pi))}, method="exact")
    assert done.backend == "c"

    def over(t: float) -> float:
        x = 2 * w * t
        return float((np.sin(x) - x * np.cos(x)) / 2 - bias)

    grid = np.linspace(0, end, 4001)
    above = next(k for k in range(len(grid)) if over(grid[k]) > 0)
    first = scipy.optimize.brentq(over, grid[above - 1], grid[above], xtol=1e-16)
    told = [event for event in done.events if event.time <= first * (1 + 1e-9)]
    halves = int(first * w / np.pi)
    assert halves > 8
    assert [(event.port, event.kind) for event in told] == [
        *[("q", "off" if k % 2 else "on") for k in range(1, halves + 1)], ("d", "on"),
    ]  # fmt: skip
    assert [event.time for event in told] == pytest.approx(
        [*(np.arange(1, halves + 1) * np.pi / w), first], abs=1e-11
    )


STEPS = [
    *(bg.Se(f"s{k}", f"e{k}") for k in (1, 2, 3, 5)), bg.One("w"), bg.Sw("q", on="sin(w*t) + 2 + a"),
    bg.Zero("n"), bg.Sw("d", on="-e_d", off="f_d"), bg.One("l"), bg.I("L", 1, flow="i"), bg.R("R", 1),
]  # fmt: skip
STEPPED = bg.derive(bond_graph(STEPS, "s1>w s2>w s3>w s5>w w>q w>n n>d n>l l>L l>R"))


def test_what_inputs_do_from_a_step_on_is_seen() -> None:
    """Five stretches of a period, each to a step of a source: from the step of a on, after four, the same
    sine crosses its level at 7/12 and 11/12 of each period."""
    period = 0.25
    ready = simulator(STEPPED, {"w": 2 * np.pi / period}, backend="c")
    inputs = {f"e{k}": Step(k * period, 1.0, 1.0 if k == 1 else 0.5) for k in (1, 2, 3, 5)}
    inputs["a"] = Step(4 * period, -1.5)
    done = ready.run([0.0, 6 * period], inputs=inputs, method="exact")
    assert done.backend == "c"
    expected = [
        ((k + part / 12) * period, port, kind)
        for k in (4, 5)
        for part, first in ((7, "off"), (11, "on"))
        for port, kind in (("q", first), ("d", "on" if first == "off" else "off"))
    ]
    assert [(event.port, event.kind) for event in done.events] == [one[1:] for one in expected]
    assert [event.time for event in done.events] == pytest.approx(
        [one[0] for one in expected], abs=1e-13
    )

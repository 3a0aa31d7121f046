"""Resets of states at events: closed forms, instants in several parts, and what is refused."""

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Step, simulator

ROUTES = [("numpy", "auto"), ("numpy", "DOP853"), ("c", "auto"), ("c", "DOP853")]


def _beside(*switches: tuple[str, dict[str, object]]) -> nx.DiGraph:
    """A capacitor behind a current, a count where it is asked for, and switches that carry no power."""
    nodes = [bg.Sf("source", "I"), bg.Zero("n"), bg.C("c", "C", effort="v"), *switches]
    bonds = ["source>n>c"]
    if "count" in str(switches):
        nodes += [bg.Sf("none", "0*C"), bg.One("still"), bg.Df("counter", integrate="count")]
        bonds.append("none>still>counter")
    for name, _ in switches:
        nodes += [bg.One(f"{name}_pivot"), bg.R(f"{name}_rest", 1)]
        bonds.append(f"{name}_pivot>{name}_rest {name}_pivot>{name}")
    return bond_graph(nodes, " ".join(bonds))


def _told(result) -> list[tuple[float, str, str]]:
    return [(round(e.time, 9), str(e.port), e.kind) for e in result.events]


@pytest.mark.parametrize(("backend", "method"), ROUTES)
def test_a_neuron_fires_with_its_period(backend: str, method: str) -> None:
    """C v' = I - v/R from v_0 to the threshold: R C log((I R - v_0)/(I R - 1)) apart, each time less
    C (1 - v_0^2)/2."""
    nodes = [bg.Sf("source", "I"), bg.Zero("n"), bg.C("m", "C", effort="v"), bg.R("leak", "R"),
             bg.One("pivot"), bg.R("rest", 1), bg.Sw("spike", "v - 1", reset={"v": "v_0"})]  # fmt: skip
    graph = bond_graph(nodes, "source>n>m n>leak pivot>rest pivot>spike")
    C, R, v_0, current = 0.5, 2.0, -0.3, 0.8
    made = simulator(bg.derive(graph), {"C": C, "R": R, "v_0": v_0}, backend=backend)
    run = made.run(np.linspace(0, 10, 21), inputs={"I": current}, method=method)
    final = current * R
    period = R * C * np.log((final - v_0) / (final - 1))
    times = R * C * np.log(final / (final - 1)) + period * np.arange(100)
    times = times[times < 10]
    assert run.backend == backend
    for kind in ("on", "off"):
        found = [e.time for e in run.events if e.kind == kind]
        assert found == pytest.approx(times.tolist(), abs=1e-10 if method == "auto" else 2e-9)
    audit = run.audit()
    assert audit.resets == pytest.approx(len(times) * C * (1 - v_0**2) / 2, abs=1e-9)
    assert audit.impacts == 0
    assert abs(audit.residual) < 1e-8 * audit.turned_over
    assert "resets took" in str(audit)


@pytest.mark.parametrize(("backend", "method"), ROUTES)
def test_a_ball_by_reset_moves_as_one_on_a_stop(backend: str, method: str) -> None:
    """v := -e v as its height falls below 0, from 5 m at 10 m/s^2: at 1, 1 + 2 e, .. s."""
    m, e = 2.0, 0.8
    start, times = {"h": 5.0}, np.linspace(0.0, 7.0, 30)
    by_hand = [bg.Se("w", "-10*m"), bg.One("n"), bg.I("m", "m", flow="v"), bg.Df("d", integrate="h"),
               bg.One("pivot"), bg.R("rest", 1), bg.Sw("floor", "-h", reset={"v": "-e*v"})]  # fmt: skip
    graph = bond_graph(by_hand, "w>n>m n>d pivot>rest pivot>floor")
    run = simulator(bg.derive(graph), {"m": m, "e": e}, backend=backend).run(
        times, start, method=method
    )
    stopped = bond_graph([*by_hand[:3], bg.Stop("floor", restitution="e")], "w>n>m n>floor")
    right = simulator(bg.derive(stopped), {"m": m, "e": e}).run(times, {"q_floor": 5.0})
    falls = 1 + 2 * np.concatenate([[0.0], np.cumsum(e ** np.arange(1, 9))])
    on = [one.time for one in run.events if one.kind == "on"]
    near = 1e-10 if method == "auto" else 1e-9
    assert on == pytest.approx(falls[falls < 7].tolist(), abs=near)
    assert run["h"] == pytest.approx(right["q_floor"], abs=10 * near)
    assert run["v"] == pytest.approx(right["v"], abs=100 * near)
    assert run.audit().resets == pytest.approx(right.audit().impacts, rel=1e-8)
    assert abs(run.audit().residual) < 1e-8 * run.audit().turned_over


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_one_reset_sets_off_another_and_each_has_its_event(backend: str) -> None:
    """Full at 1 and counted; the third count, at the same instant, drains it and begins anew."""
    graph = _beside(
        bg.Sw("full", "v - 1", reset={"v": "1/4", "count": "count + 1"}),
        bg.Sw("third", "count - 5/2", reset={"on": {"v": "0", "count": "0"}, "off": {"v": "v + 1/8"}}),
    )  # fmt: skip
    run = simulator(bg.derive(graph), {"C": 2.0}, backend=backend).run(
        np.linspace(0, 6, 13), inputs={"I": 1.0}
    )
    at = [2.0, 3.5, 5.0]
    known = [(t, "full", kind) for t in at for kind in ("on", "off")]
    assert _told(run) == [
        *known[:5],
        (5.0, "full", "off"),
        (5.0, "third", "on"),
        (5.0, "third", "off"),
    ]
    rise = np.array([0, 0.25, 0.5, 0.75, 0.25, 0.5, 0.75, 0.25, 0.5, 0.75, 0.125, 0.375, 0.625])
    assert run["v"] == pytest.approx(rise, abs=1e-12)
    assert run["count"].tolist() == [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 0, 0, 0]


@pytest.mark.parametrize(("backend", "method"), ROUTES)
def test_a_timer_and_an_input_reset_and_a_start_does_not(backend: str, method: str) -> None:
    """At 1/2 s by the time, at 3/4 s by a gate; what is on as a run begins has turned on before."""
    graph = _beside(
        bg.Sw("timer", "t - 1/2", reset={"v": "v/2"}), bg.Sw("gate", "g - 1/2", reset={"v": "-v"}),
        bg.Sw("before", "1 + I", reset={"v": "100*C"}),
    )  # fmt: skip
    given = {"I": 1.0, "g": Constant(0.0) + Step(0.75, 1.0)}
    run = simulator(bg.derive(graph), {"C": 1.0}, backend=backend).run(
        [0, 0.25, 0.5, 0.7, 0.75, 1.0], {"v": 1.0}, given, method
    )
    assert run["v"] == pytest.approx([1, 1.25, 0.75, 0.95, -1.0, -0.75], abs=1e-10)
    assert _told(run) == [(0.5, "timer", "on"), (0.75, "gate", "on")]


@pytest.mark.parametrize(("backend", "method"), ROUTES)
def test_a_state_beside_a_driven_dependent_storage_is_what_it_is_reset_to(
    backend: str, method: str
) -> None:
    """w_s = (1 + h) w_c - h w of a sun that follows a ring forced at w = 2 + t: only w_c is reset."""
    nodes = [bg.Sf("ring", "w"), bg.TF("h", "-h"), bg.One("carrier"), bg.I("I_c", "I_c", flow="w_c"),
             bg.TF("k", "1 + h"), bg.Zero("mesh"), bg.I("I_s", "I_s", flow="w_s", priority=-1),
             bg.One("pivot"), bg.R("rest", 1), bg.Sw("at", "t - 1", reset={"w_c": "3 + w_c/10 + w_s/10"}),
             bg.One("r"), bg.One("s")]  # fmt: skip
    graph = bond_graph(nodes, "ring>r>h>mesh carrier>I_c carrier>k>mesh>s>I_s pivot>rest pivot>at")
    I_c, I_s, h = 2.0, 0.5, 3.0
    made = simulator(bg.derive(graph), {"I_c": I_c, "I_s": I_s, "h": h}, backend=backend)
    assert made.states == ("w_c",)
    signal = Constant(2.0) + Step(0.4, 0.5)
    run = made.run([0, 1.0, 2.0], {"w_c": 1.0}, {"w": signal}, method)
    # Nothing drives it but the step of w, of which it gets this part.
    part = h * (1 + h) * I_s / (I_c + (1 + h) ** 2 * I_s)
    before = 1.0 + part * 0.5
    after = 3 + before / 10 + ((1 + h) * before - h * 2.5) / 10
    assert run["w_c"] == pytest.approx([1.0, after, after], abs=1e-9)


def _key_across(reset: object) -> nx.DiGraph:
    nodes = [bg.Sf("source", "I"), bg.Zero("n"), bg.C("c", "C", effort="v")]
    nodes += [bg.Sw("key", "t - 1", reset=reset)]
    return bond_graph(nodes, "source>n>c n>key")


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("method", ["auto", "DOP853"])
@pytest.mark.parametrize(
    ("graph", "says"),
    [
        (_beside(bg.Sw("a", "v - 1", reset={"on": {"v": "0"}, "off": {"v": "2"}})),
         "resets at .* set off one another without end"),
        (_beside(bg.Sw("a", "v - 1", reset={"v": "0"}), bg.Sw("b", "v - 1", reset={"v": "1/2"})),
         "'a' and 'b' reset v to 0 and 0.5 at once"),
        (_key_across({"v": "1"}), "the reset of v contradicts what 'key' holds"),
        (_beside(bg.Sw("a", "v - 1", reset={"v": "log(-v)"})), "what 'a' resets v to has no finite value"),
    ],
    ids=["endless", "twice", "held", "infinite"],
)  # fmt: skip
def test_what_is_refused(graph: nx.DiGraph, says: str, backend: str, method: str) -> None:
    made = simulator(bg.derive(graph), {"C": 1.0}, backend=backend)
    with pytest.raises(bg.SimulationError, match=says):
        made.run([0, 2], inputs={"I": 1.0}, method=method)


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_what_agrees_is_set_once_and_what_holds_may_be_reset_to_what_it_holds(backend: str) -> None:
    graph = _beside(
        bg.Sw("a", "v - 1", reset={"v": "1/2"}), bg.Sw("b", "v - 1", reset={"v": "v/2"})
    )
    run = simulator(bg.derive(graph), {"C": 1.0}, backend=backend).run([0, 1.25], inputs={"I": 1.0})
    assert run["v"][-1] == pytest.approx(0.75, abs=1e-12)
    held = simulator(bg.derive(_key_across({"v": "0*v"})), {"C": 1.0}, backend=backend)
    assert held.run([0, 2], inputs={"I": 1.0})["v"].tolist() == [0, 0]


@pytest.mark.parametrize(("backend", "method"), ROUTES)
def test_a_stop_counts_what_is_thrown_back_and_what_stays(backend: str, method: str) -> None:
    """Thrown at 1 m/s from one wall to another 1 m off, e = 1/2: hits at 1, 3, 7 .. s."""
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.Sf("none", "0*L"), bg.One("still"),
             bg.Df("counter", integrate="count"),
             bg.Stop("walls", low=0, high="L", restitution="e",
                     reset={"count": "count + abs(v)"})]  # fmt: skip
    graph = bond_graph(nodes, "n>m n>walls none>still>counter")
    for e, counts in ((0.5, [0, 0.5, 0.5, 0.75, 0.75]), (0.0, [0, 0, 0, 0, 0])):
        made = simulator(bg.derive(graph), {"L": 1.0, "e": e}, backend=backend)
        run = made.run([0, 1.5, 2.5, 3.5, 6.5], {"v": 1.0}, method=method)
        assert run["count"] == pytest.approx(counts, abs=1e-9)

"""Switched circuits and drives against closed forms and integrations phase by phase."""

import networkx as nx
import numpy as np
import pytest
from oracles.energy import misfit
from oracles.phases import Array, Phase, follow
from references.build import bond_graph
from scipy.linalg import expm

import bondgraph as bg
from bondgraph.declare.renaming import Part
from codegen import Constant, Result, Signal, Sine, Step, switched_simulator


def _gate(edges: Array) -> Signal:
    """1 at first, changing at each of the edges."""
    total: Signal = Constant(1.0)
    for k, at in enumerate(edges.tolist()):
        total = total + Step(at, 1.0 if k % 2 else -1.0)
    return total


def _kinds(result: Result, port: str) -> list[str]:
    return [event.kind for event in result.events if event.port == port]


DIODE = {"on": "e_d", "off": "-f_d"}


def _rectifier() -> Part:
    """A source, a diode and R_1 in series, onto C beside R."""
    nodes = [bg.Se("src", "u"), bg.One("loop"), bg.Sw("d", **DIODE), bg.R("R_1", "R_1"), bg.Zero("out"),
             bg.C("c", "C", effort="v"), bg.R("load", "R")]  # fmt: skip
    return bond_graph(nodes, "src>loop>d loop>R_1 loop>out out>c out>load")


RECTIFIER = {"R_1": 1.0, "C": 1e-3, "R": 100.0}


def test_half_wave_rectifier() -> None:
    w, times = 100 * np.pi, np.linspace(0, 0.1, 101)
    # x = v, u, u'/w
    phases: dict[str, Phase] = {
        "off": ([[-10, 0, 0], [0, 0, w], [0, -w, 0]], [([1, -1, 0], "on")]),
        "on": ([[-1010, 1000, 0], [0, 0, w], [0, -w, 0]], [([-1, 1, 0], "off")]),
    }
    expected, began = follow(phases, "off", np.array([2.0, 0.0, 10.0]), times, {})
    run = switched_simulator(_rectifier(), RECTIFIER)
    result = run.run(times, {"v": 2.0}, {"u": Sine(10, 50)})
    assert [event.kind for event in result.events] == [name for _, name in began]
    assert [e.time for e in result.events] == pytest.approx([t for t, _ in began], abs=1e-10)
    assert result["v"] == pytest.approx(expected[:, 0], abs=1e-8)
    assert result["e_d"].max() < 1e-9
    assert result["f_d"].min() > -1e-9
    conducting = result["u"] - result["v"] > 1e-9
    assert result["d"] == pytest.approx(conducting.astype(float))


def test_power_of_the_rectifier_is_balanced_and_the_diode_takes_none() -> None:
    simulator = switched_simulator(_rectifier(), RECTIFIER)

    def run(times: Array) -> Result:
        return simulator.run(times, {"v": 2.0}, {"u": Sine(10, 50)})

    def supplied(r: Result) -> Array:
        return r.power("src") - r.power("R_1") - r.power("load")

    assert misfit(run, [0.0, 0.02, 0.04], lambda r: r.energy("c"), supplied) < 1e-8
    result = run(np.linspace(0, 0.04, 2001))
    assert np.abs(result.power("d")).max() < 1e-9
    effort, flow = result.bond("out", "load")
    assert effort == pytest.approx(result["v"])
    assert flow == pytest.approx(result["v"] / 100)
    assert result.work("load")[-1] == pytest.approx(
        np.trapezoid(result["v"] ** 2 / 100, result.time)
    )


def _buck() -> Part:
    nodes = [bg.Se("src", "E"), bg.One("s"), bg.Sw("q", on="g - 0.5"), bg.Zero("n"),
             bg.Sw("d", on="-e_d", off="f_d"), bg.One("l"), bg.I("L", "L", flow="i"), bg.Zero("o"),
             bg.C("c", "C", effort="v"), bg.R("r", "R")]  # fmt: skip
    return bond_graph(nodes, "src>s>q s>n>d n>l>L l>o o>c o>r")


def _boost() -> Part:
    nodes = [bg.Se("src", "E"), bg.One("l"), bg.I("L", "L", flow="i"), bg.Zero("n"),
             bg.Sw("q", on="g - 0.5"), bg.One("w"), bg.Sw("d", **DIODE), bg.Zero("o"),
             bg.C("c", "C", effort="v"), bg.R("r", "R")]  # fmt: skip
    return bond_graph(nodes, "src>l>L l>n>q n>w>d w>o o>c o>r")


@pytest.mark.parametrize("kind", ["buck", "boost"])
@pytest.mark.parametrize("R", [5.0, 400.0])
def test_converters_with_steady_and_interrupted_current(kind: str, R: float) -> None:
    """x = i, v, 1: transistor on, diode on, neither."""
    E, L, C, T = 24.0, 1e-3, 1e-4, 1e-4
    buck = kind == "buck"
    rest = [1 / C, -1 / (R * C), 0.0]
    drive, free = (
        ([0, -1 / L, E / L], [0, -1 / L, 0]) if buck else ([0, 0, E / L], [0, -1 / L, E / L])
    )
    idle = [0, -1 / (R * C), 0.0]
    zero = [0.0, 0.0, 0.0]
    phases: dict[str, Phase] = {
        "on": ([drive, rest if buck else idle, zero], []),
        "free": ([free, rest, zero], [([1, 0, 0], "idle")]),
        "idle": ([zero, idle, zero], []),
    }
    edges = np.arange(1, 60) * T / 2
    change = {"on": "free"}, {"free": "on", "idle": "on"}
    forced = {at: change[k % 2] for k, at in enumerate(edges.tolist())}
    # Never on a breakpoint.
    times = (np.arange(100) + 0.37) * 3e-5
    start = np.array([2.1 if buck and R < 100 else 0.0, 12.0 if buck else 30.0, 1.0])
    first: Array = expm(np.array(phases["on"][0]) * times[0]).astype(float) @ start
    expected, began = follow(phases, "on", first, times, forced)
    run = switched_simulator(_buck() if buck else _boost(), {"L": L, "C": C, "R": R})
    result = run.run(
        times, {"i": first[0], "v": first[1]}, {"E": E, "g": _gate(edges)}, initially_on=["q"]
    )
    assert ("idle" in {name for _, name in began}) == (R > 100)
    assert result["i"] == pytest.approx(expected[:, 0], abs=1e-8)
    assert result["v"] == pytest.approx(expected[:, 1], abs=1e-8)
    off = [event.time for event in result.events if (event.port, event.kind) == ("d", "off")]
    dies = [t for t, name in began if name == "idle"]
    assert [t for t in off if min(abs(edges - t)) > 1e-9] == pytest.approx(dies, abs=1e-12)


@pytest.mark.parametrize(
    ("C_1", "C_2", "u_1", "u_2"), [(2.0, 3.0, 5.0, -1.0), (1e-6, 4e-6, 0.0, 100.0)]
)
def test_paralleled_capacitors_share_their_charge(
    C_1: float, C_2: float, u_1: float, u_2: float
) -> None:
    nodes = [bg.Zero("a"), bg.C("c1", C_1, effort="u_1"), bg.One("w"), bg.Sw("k", on="t - 1"),
             bg.Zero("b"), bg.C("c2", C_2, effort="u_2")]  # fmt: skip
    graph = bond_graph(nodes, "a>c1 a>w>k w>b>c2")
    result = switched_simulator(graph, {}).run(np.linspace(0, 2, 9), {"u_1": u_1, "u_2": u_2})
    together = (C_1 * u_1 + C_2 * u_2) / (C_1 + C_2)
    assert result["u_1"] == pytest.approx(np.where(result.time < 1, u_1, together), rel=1e-12)
    assert result["u_2"] == pytest.approx(np.where(result.time < 1, u_2, together), rel=1e-12)
    energy = result.energy("c1") + result.energy("c2")
    lost = C_1 * C_2 / (C_1 + C_2) * (u_1 - u_2) ** 2 / 2
    assert energy[0] - energy[-1] == pytest.approx(lost, rel=1e-12)
    assert result["k"].tolist() == [0.0] * 4 + [1.0] * 5
    ((time, port, kind, _),) = result.events
    assert (port, kind) == ("k", "on")
    assert time == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("ratio", [1, 2, -3])
def test_a_dog_clutch_behind_a_gear_shares_angular_momentum(ratio: int) -> None:
    """The impulse at the dog is P = (w_1/ratio - w_2) / (1/(J_1 ratio^2) + 1/J_2)."""
    nodes = [bg.One("a"), bg.I("J_1", "J_1", flow="w_1"), bg.TF("gear", _modulus(ratio)), bg.Zero("z"),
             bg.Sw("dog", on="1 - t"), bg.One("b"), bg.I("J_2", "J_2", flow="w_2")]  # fmt: skip
    graph = bond_graph(nodes, "a>J_1 a>gear>z>dog z>b>J_2")
    J_1, J_2, w_1, w_2, i = 0.7, 2.0, 40.0, -3.0, float(ratio)
    run = switched_simulator(graph, {"J_1": J_1, "J_2": J_2})
    result = run.run([0.0, 0.5, 2.0], {"w_1": w_1, "w_2": w_2})
    slip = w_1 / i - w_2
    P = slip / (1 / (J_1 * i**2) + 1 / J_2)
    assert result["w_1"] == pytest.approx([w_1, w_1, w_1 - P / i / J_1], rel=1e-12)
    assert result["w_2"] == pytest.approx([w_2, w_2, w_2 + P / J_2], rel=1e-12)
    energy = result.energy("J_1") + result.energy("J_2")
    assert energy[0] - energy[-1] == pytest.approx(P * slip / 2, rel=1e-12)


def _modulus(ratio: int) -> str:
    return f"1/({ratio})"


def test_a_capacitor_follows_the_source_onto_which_it_is_switched() -> None:
    """Its charge jumps, then its current is C u'."""
    nodes = [bg.Se("s", "E"), bg.One("w"), bg.Sw("k", on="g"), bg.C("c", "C", effort="u")]
    run = switched_simulator(bond_graph(nodes, "s>w>k w>c"), {"C": 2.0})
    result = run.run(
        np.linspace(0, 2, 9), {"u": 0.5}, {"E": Sine(3, 0.25), "g": Step(1.0, 1.0, -1.0)}
    )
    angle = np.pi / 2 * result.time
    assert result["u"] == pytest.approx(np.where(result.time < 1, 0.5, 3 * np.sin(angle)), abs=1e-9)
    current = 2.0 * 3 * np.pi / 2 * np.cos(angle)
    assert result["f_s"] == pytest.approx(np.where(result.time < 1, 0.0, current), abs=1e-9)
    assert result.power("s") == pytest.approx(result["E"] * result["f_s"], abs=1e-9)


@pytest.mark.parametrize("diode", [False, True])
def test_a_contactor_interrupts_a_coil_unless_a_diode_keeps_its_current(diode: bool) -> None:
    """The coil's impulse closes the diode, at the instant at which the contactor opens."""
    nodes = [bg.Se("s", "E"), bg.One("w"), bg.Sw("k", on="1 - t"), bg.Zero("n"), bg.One("c"),
             bg.I("L", "L", flow="i"), bg.R("R", "R")]  # fmt: skip
    graph = bond_graph(nodes, "s>w>k w>n>c c>L c>R")
    if diode:
        graph.add_nodes_from([bg.Sw("d", on="-e_d", off="f_d")])
        nx.add_path(graph, ["n", "d"])
    run = switched_simulator(graph, {"L": 2.0, "R": 1.0})
    result = run.run(np.linspace(0, 2, 21), inputs={"E": 3.0})
    t = result.time
    kept = 3 * (1 - np.exp(-0.5)) * np.exp(-(t - 1) / 2) if diode else np.zeros_like(t)
    assert result["i"] == pytest.approx(np.where(t < 1, 3 * (1 - np.exp(-t / 2)), kept), abs=1e-9)
    assert result["e_k"] == pytest.approx(np.where(t < 1, 0.0, 3.0), abs=1e-9)
    ports = [("k", "off"), ("d", "on")] if diode else [("k", "off")]
    assert [(event.port, event.kind) for event in result.events] == ports
    assert [event.time for event in result.events] == pytest.approx([1.0] * len(ports), abs=1e-12)


def _heated(on: str, off: str | None = None) -> Part:
    """A source through R and a switch heats C, which leaks through l."""
    nodes = [bg.Se("s", "E"), bg.One("w"), bg.Sw("k", on=on, off=off), bg.R("R", 1),
             bg.C("c", 1, effort="T"), bg.Zero("z"), bg.R("l", 3)]  # fmt: skip
    return bond_graph(nodes, "s>w>k w>R w>z>c z>l")


def test_a_thermostat_has_the_period_of_its_hysteresis() -> None:
    """Heating to E 3/4 with time constant 3/4, cooling to 0 with 3."""
    run = switched_simulator(_heated("lo - T", "T - hi"), {"lo": 1.0, "hi": 1.2})
    result = run.run(np.linspace(0, 8, 81), inputs={"E": 4.0})
    heats, cools = 0.75 * np.log(2.0 / 1.8), 3 * np.log(1.2)
    first = 0.75 * np.log(3.0 / 1.8)
    period = heats + cools
    off = [event.time for event in result.events if event.kind == "off"]
    on = [event.time for event in result.events if event.kind == "on"]
    assert len(off) >= 10
    assert off == pytest.approx(first + period * np.arange(len(off)), abs=1e-9)
    assert on == pytest.approx(first + cools + period * np.arange(len(on)), abs=1e-9)


def test_controlled_junctions_cut_loops_and_ground_nodes() -> None:
    T = np.linspace(0, 3, 31)
    loop = [bg.Se("s", 3), bg.One("w", on="1 - t"), bg.R("R", 1), bg.C("c", 1, effort="u")]
    result = switched_simulator(bond_graph(loop, "s>w>R w>c"), {}).run(T)
    assert result["u"] == pytest.approx(3 * (1 - np.exp(-np.minimum(T, 1))), abs=1e-9)
    assert result["f_w"][10:] == pytest.approx(np.zeros(21), abs=1e-12)
    node = [
        bg.Sf("s", 3),
        bg.Zero("w", on="(t - 1)*(t - 2)"),
        bg.R("R", 1),
        bg.C("c", 1, effort="u"),
    ]
    result = switched_simulator(bond_graph(node, "s>w>R w>c"), {}).run(T)
    since = np.where(T < 1, T, np.where(T < 2, 0, T - 2))
    assert result["u"] == pytest.approx(3 * (1 - np.exp(-since)), abs=1e-9)
    assert _kinds(result, "w") == ["off", "on"]


@pytest.mark.parametrize("smoothed", [False, True])
def test_a_bridge_gives_the_magnitude_of_its_source(smoothed: bool) -> None:
    """Modes that short the source, or leave coils of nothing undetermined, have no equations."""
    legs = {"d1": "a>ap>d1 ap>p", "d2": "b>bp>d2 bp>p", "d3": "na>a na>d3", "d4": "nb>b nb>d4"}
    ones = [bg.One(name) for name in ("s", "ap", "bp", "na", "nb")]
    nodes = [bg.Se("src", "u"), *ones, bg.Zero("a"), bg.Zero("b"), bg.Zero("p"), bg.R("load", 100)]
    nodes += [bg.Sw(d, on=f"e_{d}", off=f"-f_{d}") for d in legs]
    bonds = "src>s b>s s>a p>load " + " ".join(legs.values())
    if smoothed:
        nodes += [bg.R("R_s", 1), bg.C("c", 1e-3, effort="v")]
        bonds += " s>R_s p>c"
    times = np.linspace(0, 0.04, 82)[1:]
    w = 100 * np.pi
    wave = Sine(10, 50, phase=0.1)
    result = switched_simulator(bond_graph(nodes, bonds), {}).run(times, inputs={"u": wave})
    if not smoothed:
        assert result["e_p"] == pytest.approx(np.abs(result["u"]), abs=1e-6)
        return
    up, down = [[0, 0, w], [0, -w, 0]], [-10.0, 0.0, 0.0]
    phases: dict[str, Phase] = {
        "off": ([down, *up], [([1, -1, 0], "forth"), ([1, 1, 0], "back")]),
        "forth": ([[-1010, 1000, 0], *up], [([-1, 1, 0], "off")]),
        "back": ([[-1010, -1000, 0], *up], [([-1, -1, 0], "off")]),
    }
    angle = w * times[0] + 0.1
    start = np.array([0.0, 10 * np.sin(angle), 10 * np.cos(angle)])
    expected, _ = follow(phases, "forth", start, times, {})
    assert result["v"] == pytest.approx(expected[:, 0], abs=1e-7)


def test_friction_and_a_clutch_in_one_graph() -> None:
    """A sliding block picks up another; together they slow down less and stick."""
    nodes = [bg.One("a"), bg.I("m_1", 1, flow="v_1"), bg.R("ground", law=bg.DryFriction(2)), bg.Zero("z"),
             bg.Sw("slack", on="1 - t"), bg.One("b"), bg.I("m_2", 3, flow="v_2")]  # fmt: skip
    graph = bond_graph(nodes, "a>m_1 a>ground a>z>slack z>b>m_2")
    result = switched_simulator(graph, {}).run(np.linspace(0, 6, 25), {"v_1": 8.0})
    t = result.time
    v = np.where(t < 1, 8 - 2 * t, np.maximum(1.5 - 0.5 * (t - 1), 0.0))
    assert result["v_1"] == pytest.approx(v, abs=1e-9)
    assert result["v_2"] == pytest.approx(np.where(t < 1, 0.0, v), abs=1e-9)
    assert [(e.port, e.kind) for e in result.events] == [("slack", "off"), ("ground", "stick")]
    assert [e.time for e in result.events] == pytest.approx([1.0, 4.0], abs=1e-9)


def test_two_gates_that_change_at_one_instant() -> None:
    """A capacitor is switched from one ideal source to another; both at once would be a conflict."""
    nodes = [bg.Zero("n"), bg.One("r"), bg.R("R", 1), bg.C("c", 1, effort="u")]
    bonds = "n>r r>R r>c"
    for k in (1, 2):
        nodes += [bg.Se(f"s{k}", f"E_{k}"), bg.One(f"w{k}"), bg.Sw(f"k{k}", on=f"g_{k} - 0.5")]
        bonds += f" s{k}>w{k} w{k}>k{k} w{k}>n"
    inputs = {"E_1": 2.0, "E_2": -5.0, "g_1": Step(1.0, 0.0, 1.0), "g_2": Step(1.0, 1.0)}
    run = switched_simulator(bond_graph(nodes, bonds), {})
    result = run.run(np.linspace(0, 3, 13), inputs=inputs, initially_on=["k1"])
    assert [event.time for event in result.events] == pytest.approx([1.0, 1.0])
    assert {(e.port, e.kind) for e in result.events} == {("k1", "off"), ("k2", "on")}
    t, u_1 = result.time, 2 * (1 - np.exp(-1))
    late = -5 + (u_1 + 5) * np.exp(1 - t)
    assert result["u"] == pytest.approx(np.where(t < 1, 2 * (1 - np.exp(-t)), late), abs=1e-9)


def test_a_crank_that_latches_onto_a_slider_at_an_angle() -> None:
    """J w + r s m v is kept, s = sin(angle); afterwards the energy of crank and slider is."""
    nodes = [bg.One("shaft"), bg.I("J", 2, flow="w"), bg.Df("angle", integrate="theta"),
             bg.TF("yoke", "r*sin(theta)"), bg.Zero("gap"), bg.Sw("slack", on="theta_0 - theta"),
             bg.One("slider"), bg.I("m", 3, flow="v")]  # fmt: skip
    graph = bond_graph(nodes, "shaft>J shaft>angle shaft>yoke>gap>slack gap>slider>m")
    r, at, w, v = 0.5, 0.8, 1.6, -0.4
    run = switched_simulator(graph, {"r": r, "theta_0": at})
    result = run.run(np.linspace(0, 1, 20), {"w": w, "v": v})
    assert [event.time for event in result.events] == pytest.approx([at / w], abs=1e-9)
    s = r * np.sin(at)
    latched = (2 * w + 3 * s * v) / (2 + 3 * s**2)
    energy = (2 + 3 * s**2) * latched**2
    later = result.time > at / w
    arm = r * np.sin(result["theta"][later])
    assert result["w"][later] == pytest.approx(np.sqrt(energy / (2 + 3 * arm**2)), abs=1e-8)
    assert result["v"][later] == pytest.approx(arm * result["w"][later], abs=1e-8)
    assert result["w"][~later] == pytest.approx(np.full((~later).sum(), w), abs=1e-9)


def test_no_consistent_mode_is_refused_by_name() -> None:
    nodes = [bg.Se("s_1", 3), bg.One("w"), bg.Sw("k", on=1), bg.Se("s_2", 1)]
    run = switched_simulator(bond_graph(nodes, "s_1>w>k s_2>w"), {})
    with pytest.raises(
        bg.SimulationError,
        match=r"at t = 0 no mode of the switches.*what 'k' receives, which only sources rule.*'k' would",
    ):
        run.run([0.0, 1.0])


def test_a_switch_that_wants_both_is_refused() -> None:
    run = switched_simulator(_heated("E", "E"), {})
    with pytest.raises(
        bg.SimulationError, match=r"at t = 0 no mode.*'k' would change over at once"
    ):
        run.run([0.0, 1.0], inputs={"E": 3.0})


@pytest.mark.most(30)
def test_endless_switching_ends_with_an_error() -> None:
    """Without hysteresis the temperature slides along the threshold: on, off, on, off."""
    run = switched_simulator(_heated("1 - T"), {})
    with pytest.raises(bg.SimulationError, match="needs a hysteresis"):
        run.run([0.0, 2.0], inputs={"E": 3.0})


@pytest.mark.parametrize(
    ("w_2", "level", "times", "kinds"),
    [
        # Joined at 1 s with opposite momenta: both stand, and the brake sticks at once.
        (-5.0, 1.0, [1.0, 1.0], ["on", "stick"]),
        # (4 - 1)/2 = 1.5 rad/s, the other way round than before; it stops after 3 s.
        (-2.0, 1.0, [1.0, 1.0, 4.0], ["on", "cross", "stick"]),
        # (4 + 1)/2 = 2.5 rad/s the same way: nothing changes at the brake but when it sticks.
        (2.0, 1.0, [1.0, 6.0], ["on", "stick"]),
        # It stood until it is torn away with 2 rad/s.
        (0.0, 4.0, [1.0, 1.0, 2.0], ["on", "slip", "stick"]),
    ],
    ids=["sticks", "turns", "goes on", "is torn away"],
)
def test_what_friction_does_as_a_switch_changes_over(w_2, level, times, kinds) -> None:
    """A dog joins two inertias of 1, one at 4 rad/s, the other with a brake, at 1 s."""
    nodes = [bg.One("a"), bg.I("J1", 1, flow="w1"), bg.One("b"), bg.I("J2", 1, flow="w2"), bg.Zero("z"),
             bg.R("br", law=bg.DryFriction(level)), bg.Sw("dog", on="1 - t", off="t - 1")]  # fmt: skip
    graph = bond_graph(nodes, "a>J1 b>J2 b>br a>z z>dog z>b")
    samples = np.array([0.0, 0.5, 1.0, 3.0, 7.0])
    run = switched_simulator(graph, {}).run(samples, {"w1": 4.0, "w2": w_2}, initially_on=["dog"])
    kinds = ["off" if kind == "on" else kind for kind in kinds]
    assert [(event.port, event.kind) for event in run.events] == [
        ("dog" if kind == "off" else "br", kind) for kind in kinds
    ]
    assert [event.time for event in run.events] == pytest.approx(times, abs=1e-9)
    # Every sample once; at the switching it shows the instant after.
    before = np.sign(w_2) * np.maximum(abs(w_2) - level * samples, 0.0)
    joined = (4.0 + np.sign(w_2) * max(abs(w_2) - level, 0.0)) / 2
    after = np.maximum(joined - level / 2 * (samples - 1), 0.0)
    assert run["w2"] == pytest.approx(np.where(samples < 1, before, after), abs=1e-9)

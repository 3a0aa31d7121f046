"""Every effort, flow, power and energy of a run, whether recorded or not."""

import random

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from references.random_graphs import random_graph

import bondgraph as bg
from codegen import Ramp, Result, Sine, simulator


def _oscillator(samples: int = 41, **spring: object) -> Result:
    nodes = [bg.Se("push", "P"), bg.One("j"), bg.I("m", "m", flow="v"), bg.R("b", "b"),
             bg.C("k", effort="F", **spring), bg.TF("lever", "n"), bg.One("far"),
             bg.I("small", "M", priority=-1)]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>j>m j>b j>k j>lever>far>small"), outputs=[])
    numbers = {"m": 2.0, "b": 0.3, "k": 8.0, "n": 3.0, "M": 0.1}
    times = np.linspace(0, 1, samples)
    return simulator(equations, numbers).run(times, {"v": 1.0}, {"P": Sine(4.0, 1.3)})


@pytest.fixture(scope="module")
def run() -> Result:
    return _oscillator(value="1/k")


def test_named_signals_that_no_column_has(run: Result) -> None:
    assert "f_small" not in list(run)
    assert run["f_small"] == pytest.approx(3 * run["v"])
    with pytest.raises(KeyError, match=r"no signal 'w'; there are v, F, P.*f_small"):
        run["w"]


def test_bonds_carry_what_their_ends_say(run: Result) -> None:
    effort, flow = run.bond("j", "lever")
    below, fast = run.bond("lever", "far")
    assert fast == pytest.approx(3 * flow)
    assert effort == pytest.approx(3 * below)
    assert flow == pytest.approx(run["v"])
    with pytest.raises(bg.StructureError, match="no bond 'm' -> 'j'"):
        run.bond("m", "j")


def test_a_dependent_storage_takes_the_effort_of_its_acceleration(run: Result) -> None:
    """(m + n^2 M) v' = P - b v - F, and the lever carries n^2 M v'."""
    total = 2.0 + 9 * 0.1
    rate = (run["P"] - 0.3 * run["v"] - run["F"]) / total
    assert run.bond("j", "lever")[0] == pytest.approx(0.9 * rate)


def test_power_supplied_is_absorbed_at_every_sample(run: Result) -> None:
    absorbed = sum(run.power(node) for node in ("m", "b", "k", "small"))
    assert run.power("push") == pytest.approx(absorbed, abs=1e-12)
    assert (run.power("b") >= 0).all()


def test_energies_are_those_of_textbooks(run: Result) -> None:
    assert run.energy("m") == pytest.approx(run["v"] ** 2)
    assert run.energy("k") == pytest.approx(run["F"] ** 2 / 16)
    assert run.energy("small") == pytest.approx(0.05 * (3 * run["v"]) ** 2)


@pytest.mark.parametrize("samples", [2, 41])
def test_work_adds_up_to_the_energies_however_few_the_samples(samples: int) -> None:
    run = _oscillator(samples, value="1/k")
    stored = sum(run.energy(node) for node in ("m", "k", "small"))
    left = run.work("push") - run.work("b") - (stored - stored[0])
    assert abs(left).max() < 1e-12
    for node in ("m", "k", "small"):
        assert run.work(node) == pytest.approx(run.energy(node) - run.energy(node)[0], abs=1e-12)


def test_a_law_stores_its_integral() -> None:
    run = _oscillator(law="k*q_k + 5*q_k**3")
    q = run["q_k"]
    assert run.energy("k") == pytest.approx(4 * q**2 + 1.25 * q**4)
    gap = _oscillator(law="k*(max(q_k - 0.05, 0) + min(q_k + 0.05, 0))")
    over = np.maximum(abs(gap["q_k"]) - 0.05, 0)
    assert abs(over).max() > 0.1
    assert gap.energy("k") == pytest.approx(4 * over**2, abs=1e-12)


def test_a_law_of_other_signals_has_no_energy_of_its_own() -> None:
    with pytest.raises(bg.SignalError, match="'k': its law reads other signals"):
        _oscillator(law="k*q_k + v").energy("k")


@pytest.mark.parametrize(
    ("node", "what"), [("j", "one-port"), ("lever", "one-port"), ("none", "one-port")]
)
def test_only_one_ports_have_a_power(run: Result, node: str, what: str) -> None:
    with pytest.raises(bg.StructureError, match=what):
        run.power(node)


@pytest.mark.parametrize("node", ["b", "push", "j", "none"])
def test_only_storages_have_an_energy(run: Result, node: str) -> None:
    with pytest.raises(bg.StructureError, match="not an I or a C"):
        run.energy(node)


def _derived(seed: int) -> bg.StateEquations | None:
    try:
        found = bg.derive(random_graph(random.Random(seed), 9, mesh=0.3), outputs=[])
    except bg.BondGraphError:
        return None
    return found if found.states and found.inputs else None


@pytest.mark.parametrize("seed", range(12))
def test_power_balances_in_random_graphs_at_every_bond_and_port(seed: int) -> None:
    """Sources supply what the rest absorbs; a bond between junctions has one power, seen from all sides."""
    equations = next(filter(None, map(_derived, range(100 * seed, 100 * seed + 99))))
    rng = np.random.default_rng(seed)
    numbers = {name.name: float(rng.uniform(0.5, 2)) for name in equations.parameters}
    ready = simulator(equations, numbers)
    inputs = {name: Ramp(0.0, float(rng.normal())) for name in ready.inputs}
    run = ready.run(np.linspace(0, 0.2, 5), dict.fromkeys(ready.states, 0.3), inputs)
    supplied, absorbed, size = np.zeros(5), np.zeros(5), 1e-6
    for node, element in equations.elements.items():
        if element.one_port:
            into = supplied if element.kind.supplies else absorbed
            into += run.power(node)
            size += abs(run.power(node)).max()
    assert abs(supplied - absorbed).max() < 1e-9 * size


def _measured_coils() -> bg.StateEquations:
    """A primary coil with a resistance; the voltage of the open secondary is read, and levered."""
    nodes = [bg.Se("u", "u"), bg.One("primary"), bg.R("R", "R"), bg.One("secondary"), bg.TF("lever", "n"),
             bg.I("coils", [["L1", "M"], ["M", "L2"]], ports=["p", "s"]), bg.One("end"),
             bg.De("probe", effort="e_probe")]  # fmt: skip
    graph = bond_graph(nodes, "u>primary>R secondary>lever>end>probe")
    graph.add_edge("primary", "coils", port="p")
    graph.add_edge("secondary", "coils", port="s")
    return bg.derive(graph)


def test_parameters_of_what_can_only_be_read_are_named() -> None:
    """``e_s = -M i'``, ``i' = (u - R i)/L1``: with R = L1 = u = 1 the rate is ``exp(-t)``; M and the lever
    are in no matrix."""
    equations = _measured_coils()
    assert equations.parameters == sp.symbols("L1 M R n")
    numbers = {"L1": 1.0, "M": 0.5, "R": 1.0, "n": 4.0}
    result = simulator(equations, numbers).run([0.0, 1.0], inputs={"u": 1.0})
    assert result["e_probe"] == pytest.approx(-0.5 * np.exp([0.0, -1.0]) / 4, abs=1e-10)
    for missing in ("M", "n"):
        fewer = {name: value for name, value in numbers.items() if name != missing}
        with pytest.raises(bg.ParameterError, match=rf"missing parameter\(s\) {missing}; give"):
            simulator(equations, fewer)


def test_an_energy_that_needs_more_says_so() -> None:
    """Nothing flows in the secondary: L2 rules nothing but the sum that its field's energy is."""
    numbers = {"L1": 1.0, "M": 0.5, "R": 1.0, "n": 4.0}
    result = simulator(_measured_coils(), numbers).run([0.0, 1.0], inputs={"u": 1.0})
    with pytest.raises(
        bg.ParameterError, match="energy of 'coils' needs a number for L2 in parameters"
    ):
        result.energy("coils")
    result = simulator(_measured_coils(), {**numbers, "L2": 3.0}).run([0.0, 1.0], inputs={"u": 1.0})
    current = 1 - np.exp(-1.0)
    assert result.energy("coils")[1] == pytest.approx(0.5 * current**2, abs=1e-10)

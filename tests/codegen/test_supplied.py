"""Names in values without a number: inputs beside parameters, else forgotten ones."""

from itertools import pairwise

import networkx as nx
import numpy as np
import pytest
import scipy
from references.build import bond_graph

import bondgraph as bg
import codegen


def _valve(value: str) -> nx.DiGraph:
    nodes = [bg.Se("force", "F"), bg.One("mass"), bg.I("m", "m", flow="v"), bg.R("b", value)]
    return bond_graph(nodes, "force>mass>m mass>b")


@pytest.mark.usefixtures("closely")
def test_a_name_beside_a_parameter_is_an_input() -> None:
    """A drag that doubles at 20 s: 3 (1 - exp(-t/2)), then on to 1.5."""
    simulator = codegen.simulator(bg.derive(_valve("b*(1 + opening)")), {"m": 2, "b": 1})
    times = np.linspace(0, 40, 401)
    run = simulator.run(times, inputs={"F": 3, "opening": codegen.Step(20, 1)})
    met = -3 * np.expm1(-10.0)
    right = np.where(times < 20, -3 * np.expm1(-times / 2), 1.5 + (met - 1.5) * np.exp(20 - times))
    assert np.abs(run["v"] - right).max() < 1e-8
    assert simulator.inputs == ("F", "opening")


@pytest.mark.parametrize(
    ("value", "given", "message"),
    [
        ("b", {}, r"b; give each a number in parameters, or derive with inputs=\['b'\]"),
        ("2/b", {}, r"missing parameter\(s\) b; give"),
        ("b*(1 + openin)", {"b": 1, "opening": 2}, r"openin \(did you mean 'opening'\?\)"),
        ("b*(1 + opening)", {}, r"missing parameter\(s\) b, opening; give"),
    ],
)  # fmt: skip
def test_what_was_forgotten_is_refused(value: str, given: dict[str, float], message: str) -> None:
    with pytest.raises(bg.ParameterError, match=message):
        codegen.simulator(bg.derive(_valve(value)), {"m": 2, **given})


def test_a_lone_name_is_an_input_where_that_is_said() -> None:
    equations = bg.derive(_valve("b"), inputs=["b"])
    assert codegen.simulator(equations, {"m": 2}).inputs == ("F", "b")


def test_an_input_that_nothing_gives_is_named() -> None:
    simulator = codegen.simulator(bg.derive(_valve("b*(1 + opening)")), {"m": 2, "b": 1})
    with pytest.raises(bg.SignalError, match="opening"):
        simulator.run([0, 1], inputs={"F": 3})


def test_a_ratio_that_steps_before_a_mass_is_refused() -> None:
    """The mass behind it would have to be met at once, by an impulse that no law tells."""
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J", "J", flow="w"), bg.TF("gear", "n*(1 + shift)"),
             bg.One("out"), bg.I("m", "m", priority=-1)]  # fmt: skip
    graph = bond_graph(nodes, "T>a>J a>gear>out>m")
    simulator = codegen.simulator(bg.derive(graph), {"J": 1, "n": 2, "m": 3})
    with pytest.raises(
        bg.SimulationError, match=r"input 'shift' steps at t = 0\.5, where a dependent"
    ):
        simulator.run([0, 1], inputs={"T": 1, "shift": codegen.Step(0.5, 1)})


def test_a_ratio_that_steps_before_a_resistance_counts_at_once() -> None:
    nodes = [bg.Se("T", "T"), bg.One("a"), bg.I("J", "J", flow="w"), bg.TF("gear", "n*(1 + shift)"),
             bg.One("out"), bg.R("b", "b")]  # fmt: skip
    graph = bond_graph(nodes, "T>a>J a>gear>out>b")
    simulator = codegen.simulator(bg.derive(graph), {"J": 1, "n": 1, "b": 1})
    run = simulator.run([0, 0.5, 1], {"w": 1}, {"T": 0, "shift": codegen.Step(0.5, 1)})
    assert run["w"] == pytest.approx(np.exp([0, -0.5, -2.5]), rel=1e-8)


def _chain(load: codegen.Signal, backend: str) -> codegen.Result:
    """Two filled carts, one with a filled flywheel behind a rack, on springs of filled stiffness."""
    nodes = [bg.Se("push", "F"), bg.One("a"), bg.I("m_1", "m*(1 + load)", flow="v_1", priority=1),
             bg.Zero("z"), bg.C("spring", "1/(k*(1 + load))"), bg.R("damper", "b/(1 + load)"), bg.One("d"),
             bg.One("c"), bg.I("m_2", "m", flow="v_2", priority=1), bg.TF("rack", "r"), bg.One("wheel"),
             bg.I("J", "J*(2 + load)")]  # fmt: skip
    graph = bond_graph(nodes, "push>a>m_1 a>z>c>m_2 z>d>spring d>damper c>rack>wheel>J")
    numbers = {"m": 2.0, "k": 30.0, "b": 1.5, "r": 3.0, "J": 0.4}
    simulator = codegen.simulator(bg.derive(graph), numbers, backend=backend)
    return simulator.run(np.linspace(0, 3, 61), {"p_m_1": 1.0}, {"F": 2.0, "load": load})


def _by_hand(load: codegen.Signal, edges: list[float]) -> np.ndarray:
    """Momenta and the spring's displacement, piece by piece."""

    def rates(t: float, s: np.ndarray) -> list[float]:
        more = 1 + load(t)
        v_1, v_2 = s[0] / (2 * more), s[1] / (2 + 9 * 0.4 * (1 + more))
        force = 30 * more * s[2] + 1.5 / more * (v_1 - v_2)
        return [2 - force, force, v_1 - v_2]

    times, s = np.linspace(0, 3, 61), np.array([1.0, 0.0, 0.0])
    found = np.zeros((3, 61))
    for begin, end in pairwise(edges):
        # A step counts from its instant on; just before the next one it does not yet.
        last = np.nextafter(end, begin)
        run = scipy.integrate.solve_ivp(
            lambda t, s, last=last: rates(min(t, last), s), (begin, end), s, "DOP853",
            dense_output=True, rtol=1e-11, atol=1e-13,
        )  # fmt: skip
        inside = (times >= begin) & (times <= end)
        found[:, inside], s = run.sol(times[inside]), run.y[:, -1]
    return found


@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_filled_storages_are_those_by_hand(backend: str) -> None:
    """Over steps and ramps of what fills them: what they hold goes on, what they give steps."""
    for load, edges in (
        (codegen.Step(0.731, 1.0), [0.0, 0.731, 3.0]),
        (codegen.Ramp(0.5, 2.0), [0.0, 0.5, 3.0]),
        (codegen.Square(0.7, 0.0, 1.5), [0.0, *(np.arange(1, 5) / 1.4), 3.0]),
    ):
        run, right = _chain(load, backend), _by_hand(load, edges)
        for name, values in zip(("p_m_1", "p_m_2", "q_spring"), right, strict=True):
            assert np.abs(run[name] - values).max() < 1e-7 * np.ptp(values), name


@pytest.mark.parametrize("load", [codegen.Step(0.5, 1), codegen.Ramp(0.2, 1.0)])
def test_what_fills_a_mass_takes_part_in_the_balance(load: codegen.Signal) -> None:
    """What took it, beside what it holds, is the work of its force: ``int v p' dt``."""
    nodes = [
        bg.Se("push", "P"),
        bg.One("cart"),
        bg.I("m", "m*(1 + load)", flow="v"),
        bg.R("b", "b"),
    ]
    simulator = codegen.simulator(
        bg.derive(bond_graph(nodes, "push>cart>m cart>b")), {"m": 1, "b": 2}
    )
    run = simulator.run(np.linspace(0, 1, 101), inputs={"P": 6, "load": load})
    audit = run.audit()
    assert abs(audit.residual) < 1e-8 * audit.turned_over
    assert audit.took["m"] == pytest.approx(run.work("m")[-1], rel=1e-8)
    assert run.energy("m")[-1] < 0.8 * audit.took["m"]

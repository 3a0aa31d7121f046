"""Exported Python: it stands alone, says what the simulator says, and runs in fixed steps."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from oracles.exported import catalog_cases, constrained, instant, lever, loaded, small_cases
from oracles.models import clutches
from references.build import bond_graph

import bondgraph as bg
import differentials
from codegen import Ramp, Sine, Step, simulator, to_python
from differentials.model import model
from differentials.scenarios import named

CASES = {**dict(catalog_cases()), **dict(small_cases())}

ALONE = """
import sys


class Block:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in ("sympy", "scipy", "networkx", "bondgraph", "codegen"):
            raise ImportError(name)


sys.meta_path.insert(0, Block())
scope = {}
exec(compile(open(sys.argv[1], encoding="utf-8").read(), sys.argv[1], "exec"), scope)
run = scope["simulate"]([0.0, 0.01, 0.02], {"omega_1": 80.0}, {"tau_e": 100.0, "tau_h": lambda t: t})
print(sorted(run), run["omega_1"].tolist()[-1] > 0)
print(sorted(name for name in sys.modules if name.partition(".")[0] in ("sympy", "scipy", "bondgraph")))
"""


def _alsd() -> str:
    return to_python(*CASES["alsd"], name="alsd")


def _python(*arguments: str, **environment: str) -> str:
    found = subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, check=False,
        env={**os.environ, **environment},
    )  # fmt: skip
    assert found.returncode == 0, found.stderr
    return found.stdout


def test_it_needs_numpy_only(tmp_path: Path) -> None:
    file = tmp_path / "alsd.py"
    file.write_text(_alsd(), encoding="utf-8")
    shown, imported = _python("-I", "-c", ALONE, str(file)).splitlines()
    assert "'omega_1'" in shown
    assert shown.endswith("True")
    assert imported == "[]"


@pytest.mark.parametrize("name", CASES)
def test_rates_and_outputs_are_the_simulators(name: str) -> None:
    equations, numbers, laws = CASES[name]
    ready = simulator(equations, numbers, laws)
    module = loaded(to_python(equations, numbers, laws))
    assert (
        ready.states, ready.inputs, ready.outputs,
    ) == (module.STATES, module.INPUTS, module.OUTPUTS)  # fmt: skip
    exported, rng = module.Model(), np.random.default_rng(3)
    for turn in range(12):
        x = rng.uniform(-2, 2, len(ready.states)) * (turn % 4 > 0)
        u, du = rng.uniform(0.1, 2, (2, len(ready.inputs)))
        du, t = du * (turn % 2), rng.uniform()
        rate, signals, _ = instant(ready, t, x, u, du)
        now = exported.instant(t, x, u, du, None)
        terms = np.abs(now.numbers.P) @ np.abs(now.x) + np.abs(now.numbers.Q) @ np.abs(now.u) + 1e-3
        terms += np.abs(now.numbers.R) @ np.abs(now.du)
        size = np.append(terms, np.full(len(x) - len(now.x), 1 + np.abs(now.y).max(initial=0)))
        assert (np.abs(exported.rhs(t, x, u, du) - rate) <= 1e-12 * size).all()
        if not du.any():
            assert (np.abs(exported.rhs(t, x, u) - ready.rhs(t, x, u)) <= 1e-12 * size).all()
        largest = 1e-3 + max(map(abs, signals.values()))
        assert exported.outputs(t, x, u, du) == pytest.approx(signals, rel=0, abs=1e-12 * largest)


FIGURES = {
    "fig11": ("alsd", 1.2e-3, (450, 701)),
    "fig13": ("stationary_tvd", 1e-6, (0, 601)),
    "fig14": ("four_wheel_drive_tvd", 6e-3, (450, 701)),
}
"""The differential, the error that is left, and the samples [ms]: about all that sticks and slips."""


def _figure(name: str):
    """The module of a figure, its run by the simulator, and where and how the module begins."""
    (differential, _, (first, _)), case = FIGURES[name], named(name)
    full, reference = model(differential), differentials.simulate(differential, name)
    closed = reference.observer.model
    numbers = {symbol: float(value) for symbol, value in closed.parameters.items()}
    module = loaded(to_python(full.equations, numbers, full.laws, differential))
    start = {state: float(reference[state][first]) for state in reference.states}
    inputs = {key: _lagged(case, key, full) for key in reference.inputs}
    return module, reference, start, inputs


def _lagged(case, key: str, full):
    demands = dict(zip(full.differential.clutches.values(), case.clutch_torques, strict=True))
    at, demand = (
        (case.engine_step, case.engine_torque) if key == "tau_e"
        else (case.clutch_step, demands[key])
    )  # fmt: skip
    return lambda t: demand * (1 - np.exp(-max(t - at, 0.0) / case.lag))


@pytest.mark.parametrize("name", FIGURES)
def test_fixed_steps_converge_to_located_events(name: str) -> None:
    """At least of first order, from a step to its half; of fourth where nothing sticks."""
    module, reference, start, inputs = _figure(name)
    part, errors = slice(*FIGURES[name][2], 5), []
    for step in (1e-3, 5e-4):
        run = module.simulate(reference.time[part], start, inputs, step=step)
        errors.append(max(
            np.abs(run[state] - reference[state][part]).max() / np.abs(reference[state]).max()
            for state in module.STATES
        ))  # fmt: skip
    assert errors[1] < FIGURES[name][1]
    order = np.log2(errors[0] / errors[1])
    assert order > (3.5 if name == "fig13" else 1.0)


def test_a_dependent_storage_follows_its_source() -> None:
    """E u' beside friction: the integrated vector jumps with a step, and holds against a slope."""
    numbers, times = {"m_1": 1.0, "m_2": 3.0, "L": 6.0}, np.linspace(0, 2, 81)
    module, ready = loaded(to_python(lever(), numbers)), simulator(lever(), numbers)
    for drive, step, near in (
        (Step(0.5, 1.2) + Step(1.5, -0.4), 2e-3, 4e-3), (Ramp(0.5, 1.9), 5e-3, 1e-12),
        (Ramp(0.5, 2.1), 5e-3, 1e-12),
    ):  # fmt: skip
        expected = ready.run(times, inputs={"V": drive})
        run = module.simulate(times, {}, {"V": drive}, step=step)
        assert run["v_1"] == pytest.approx(expected["v_1"], abs=near)


def test_redundant_ports_share_by_what_each_holds_and_let_go_together() -> None:
    numbers = {"I_1": 0.5, "I_2": 0.25, "L_0": 10.0, "L_1": 25.0}
    graph = clutches(bg.DryFriction("L_0"), bg.DryFriction("L_1"))
    both = bg.derive(graph, outputs=["c0"])
    run = loaded(to_python(both, numbers)).simulate(
        np.linspace(0, 2, 41), {}, {"T_1": lambda t: 20 * t, "T_2": lambda t: -20 * t}, step=5e-3
    )
    held = run["t"] < 1.74
    assert run["f_0"][held] == pytest.approx(20 * run["t"][held] * 10 / 35, abs=1e-9)
    assert run["slip"][held] == pytest.approx(0, abs=1e-12)
    assert run["slip"][-1] == pytest.approx(10 * 0.25**2 * 6, rel=5e-4)


def test_brakes_in_different_gears_hold_whatever_they_can_hold_together() -> None:
    """Each carries the same fraction of its level: they let go at P = L_1 + r L_2 = 5."""
    numbers, times = {"m": 2.0, "L_1": 3.0, "L_2": 1.0, "r": 2.0}, np.linspace(0, 2, 41)
    module = loaded(to_python(constrained(), numbers))
    run = module.simulate(times, {}, {"P": lambda t: 4 * t}, step=5e-3)
    assert run["v"] == pytest.approx(np.maximum(times - 1.25, 0) ** 2, abs=5e-5)
    held = times < 1.24
    assert run["f_1"][held] == pytest.approx(3 / 5 * 4 * times[held], abs=1e-9)
    assert run["f_2"][held] == pytest.approx(1 / 5 * 4 * times[held], abs=1e-9)


WORDS = (
    "match case c0 c1 np τ tau double Model simulate now parameters matrix values math l I O float "
    "x u X U give Hold self print"
)


def test_names_may_be_any(tmp_path: Path) -> None:
    """Keywords are no symbols; everything else may collide with what the text uses itself."""
    words = WORDS.split()
    law = sum(sp.Symbol(word) * sp.Symbol("m1") ** (at % 3) for at, word in enumerate(words))
    law += sp.sin(sp.Symbol("np") * sp.Symbol("case")) * law
    nodes = [
        bg.One("n"), bg.I("m", "J", flow="m1"), bg.R("values", law=law), bg.Se("with", "await_"),
        bg.R('odd "name"\n', law=bg.DryFriction("match_0*case + exp_in**2"), effort="def_", flow="if_"),
        bg.C("λ", "1/np", effort="t_"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "n>m n>values n>λ with>n")
    graph.add_edge("n", 'odd "name"\n')
    numbers = {word: 0.1 + at / 7 for at, word in enumerate([*words, "J", "match_0"])}
    equations = bg.derive(graph)
    text = to_python(equations, numbers, name='"a" \\ """')
    module, ready = loaded(text), simulator(equations, numbers)
    assert (ready.states, ready.inputs) == (module.STATES, module.INPUTS)
    found = module.Model().rhs(0.2, [0.3, 0.4], [1.2, 0.5])
    assert found == pytest.approx(ready.rhs(0.2, [0.3, 0.4], [1.2, 0.5]), rel=1e-12)
    _check(text, tmp_path)


def _check(text: str, folder: Path) -> None:
    file = folder / "text.py"
    file.write_text(text, encoding="utf-8")
    options = ("--isolated", "--select", "E,F", "--line-length", "100", str(file))
    _python("-m", "ruff", "check", *options)


@pytest.mark.parametrize("name", ["alsd", "stationary_tvd", "diode", "mixed", "clutches_with_loss", "crank",
                                  "braked_crank", "duffing", "divider 3*V + 4*t"])  # fmt: skip
def test_text_has_no_lint(name: str, tmp_path: Path) -> None:
    _check(to_python(*CASES[name], name=name), tmp_path)


def test_text_is_formatted(tmp_path: Path) -> None:
    file = tmp_path / "alsd.py"
    file.write_text(_alsd(), encoding="utf-8")
    _python("-m", "ruff", "format", "--isolated", "--line-length", "100", "--check", str(file))


def test_the_text_of_the_alsd(update_golden: bool) -> None:
    file, text = Path(__file__).parents[1] / "golden" / "alsd.py.txt", _alsd()
    if update_golden:
        file.parent.mkdir(exist_ok=True)
        file.write_text(text, encoding="utf-8")
    assert file.read_text(encoding="utf-8") == text


def test_other_numbers_at_run_time_and_what_is_refused() -> None:
    equations, numbers, laws = CASES["oscillator"]
    module = loaded(to_python(equations, numbers, laws))
    ready = simulator(equations, numbers | {"k": 7.0}, laws)
    assert module.Model({"k": 7.0}).rhs(0, [0.2, 0.3]) == pytest.approx(ready.rhs(0, [0.2, 0.3]))
    with pytest.raises(ValueError, match="no parameter is called 'K'"):
        module.Model({"K": 7.0})
    with pytest.raises(ValueError, match="no state is called"):
        module.simulate([0, 1], {"w": 1.0}, {})
    for wrong in (1j, np.complex128(1 + 5j), "7", np.nan, np.inf):
        with pytest.raises(ValueError, match="parameter k must be a finite real number, not"):
            module.Model({"k": wrong})
        with pytest.raises(ValueError, match=r"state \w+ must be a finite real number, not"):
            module.simulate([0, 1], {module.STATES[0]: wrong}, {})
    with pytest.raises(bg.ParameterError, match="missing parameter"):
        to_python(equations, {"k": 1.0, "F_c": 1.0})


GEARS = {3.0: [0.0, 0.0], 2.0: [0.04, 0.08]}
"""With unequal gears two clutches hold both shafts; with equal ones, 5 v' = 0.2 and w' = 2 v'."""


@pytest.mark.parametrize(("written", "other"), [(3.0, 2.0), (2.0, 3.0)])
def test_numbers_at_which_other_ports_are_redundant_are_refused_by_name(
    written: float, other: float
) -> None:
    nodes = [bg.Se("push", "P"), bg.One("n1"), bg.One("n2"), bg.I("m1", "m", flow="v"),
             bg.I("m2", "m", flow="w"), bg.Zero("a"), bg.Zero("b"), bg.TF("ga", "r_1"), bg.TF("gb", "r_2"),
             bg.R("left", law=bg.DryFriction("L")), bg.R("right", law=bg.DryFriction("L"))]  # fmt: skip
    graph = bond_graph(nodes, "push>n1>m1 n2>m2 n1>a>left a>ga>n2 n1>b>right b>gb>n2")
    numbers = {"m": 1.0, "L": 1.0, "r_1": 2.0, "r_2": written}
    module = loaded(to_python(bg.derive(graph), numbers))
    assert module.STATES == ("v", "w")
    assert module.Model().rhs(0.0, [0, 0], [0.2]) == pytest.approx(GEARS[written], abs=1e-14)
    refused = pytest.raises(ArithmeticError, match="other ports of 'left', 'right' are redundant")
    with refused:
        module.Model({"r_2": other}).rhs(0.0, [0, 0], [0.2])
    slightly = module.Model({"L": 1.5}).rhs(0.0, [0, 0], [0.2], mode=[0, 0])
    assert slightly == pytest.approx(GEARS[written], abs=1e-14)


def test_a_slope_that_holding_would_need_is_told_by_the_module_as_by_the_simulator() -> None:
    """The clutch holds only where v' = w', and w is found by a search."""
    nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.Zero("z"),
             bg.R("law", law="(sin(v) - w**3)/2", gives="flow", flow="w"),
             bg.R("rub", law=bg.DryFriction("L"))]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>n>m n>z z>law z>rub"))
    numbers, told = {"m": 1.0, "L": 1.0}, "holding 'rub' would need the slope in time of w"
    with pytest.raises(bg.SimulationError, match=told):
        simulator(equations, numbers).run([0, 0.1], {}, {"P": 0.5})
    with pytest.raises(ArithmeticError, match=told):
        loaded(to_python(equations, numbers)).simulate([0, 0.1], {}, {"P": 0.5})


def test_a_law_of_the_speed_brakes_as_it_should() -> None:
    nodes = [bg.One("n"), bg.I("m", 1, flow="v"), bg.R("r", law="tanh(v)")]
    module = loaded(to_python(bg.derive(bond_graph(nodes, "n>m n>r")), {}))
    run = module.simulate([0, 1.0], {"v": 1.0}, {}, step=1e-3)
    assert np.sinh(run["v"][-1]) == pytest.approx(np.sinh(1) * np.exp(-1), rel=1e-9)


def test_an_input_may_be_given_as_a_signal() -> None:
    equations, numbers, laws = CASES["duffing"]
    times, drive = np.linspace(0, 1, 11), Sine(2.0, 0.7)
    run = loaded(to_python(equations, numbers, laws)).simulate(times, {}, {"P": drive}, step=1e-3)
    expected = simulator(equations, numbers, laws).run(times, {}, {"P": drive})
    assert run["v"] == pytest.approx(expected["v"], abs=1e-9)

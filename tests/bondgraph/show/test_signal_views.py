"""Nodes of signals in equations that are shown: what they come to, in both ways, not what they are made of.

Values by hand: what a state within bounds, a relay and a limited rate are at instants whose numbers are told.
"""

import json
import re
from typing import Any

import numpy as np
import pytest
import sympy as sp
from click.testing import CliRunner
from oracles.ruled import allowed, ruled_misfit
from oracles.stated import Instant, misfits
from references.latex_checks import check_latex

import bondgraph as bg
from bondgraph.show.latex_matrices import matrices_latex
from bondgraph.show.powers import powers
from bondgraph.show.statements import Statement, statements
from codegen import Constant, Ramp, simulator
from differentials.commands.app import app

INNER = re.compile(r"(?<![a-z])[ef]_\{?(z|relay|r[_,]|pi)|z\.(low|high)|relay\.|r\.[a-z]")
"""Variables and names of parts, in text and in LaTeX."""


def _motor(*nodes: Any) -> bg.BondGraph:
    motor = [bg.Se("motor", "1*tau"), bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b")]
    return bg.graph([*motor, *nodes], "motor > shaft > J, shaft > b")


LIMITED = _motor(
    bg.Function("tau", "K*(ref - omega) + z"),
    bg.State("z", "K_i*(ref - omega)", low=-1, high="top"),
)
RELAY = _motor(bg.Function("tau", "T*relay"), bg.Hysteresis("relay", "omega", 1, 2, off=1, on=0))
LIMITER = _motor(bg.Function("tau", "K*(r - omega)"), bg.RateLimiter("r", "step", "rate"))
SAMPLED = _motor(
    bg.Controller("pi", every="1/50", states={"z": 0}, update={"z": "z + ref - omega"},
                  gives={"tau": "K*(ref - omega) + z"}),
)  # fmt: skip


def _beside(graph: bg.BondGraph) -> list[str]:
    lines = str(bg.derive(graph)).splitlines()
    return [line.strip() for line in lines[lines.index("where") + 1 :] if line]


def test_a_state_within_bounds_reads_as_one_equation() -> None:
    assert _beside(LIMITED) == [
        "tau = K*(ref - omega) + z",
        "e_motor = tau",
        "rate_z = K_i*(ref - omega)",
        "z' = rate_z within -1 <= z <= top: at a bound z' = 0 while rate_z leads beyond",
        "with laws and sources put in",
        "J*omega' = K*(ref - omega) + z - b*omega",
        "z' = K_i*(ref - omega) within -1 <= z <= top",
    ]


def test_a_relay_reads_as_its_two_values() -> None:
    assert _beside(RELAY) == [
        "relay = 0 once omega > 2, 1 once omega < 1",
        "tau = T*relay",
        "e_motor = tau",
        "with laws and sources put in",
        "J*omega' = T*relay - b*omega",
    ]


def test_a_limited_rate_reads_as_it_goes_and_follows() -> None:
    ruled = "r' = rate while step > r, -rate while step < r; r = step while |step'| <= rate"
    assert ruled in _beside(LIMITER)
    told = bg.derive(
        _motor(bg.Function("tau", "r"), bg.RateLimiter("r", "2*ref - 1", 2, falling=1))
    )
    assert (
        "r' = 2 while 2*ref - 1 > r, -1 while 2*ref - 1 < r; r = 2*ref - 1 while -1 <= (2*ref - 1)' <= 2"
    ) in " ".join(str(told).split())


def test_what_controllers_hold_has_no_rate_of_its_own() -> None:
    lines = _beside(SAMPLED)
    assert lines[:1] == ["e_motor = tau"]
    assert lines[1].startswith("pi: every 1/50 s z becomes ref + z - omega and tau becomes ")
    assert not any("tau'" in line or "z'" in line for line in lines)


@pytest.mark.parametrize("graph", [LIMITED, RELAY, LIMITER, SAMPLED])
def test_no_view_names_what_nodes_are_made_of(graph: bg.BondGraph) -> None:
    equations = bg.derive(graph)
    texts = [str(equations), str(bg.explain(graph)), str(bg.explicit(equations))]
    typeset = [bg.latex(equations), bg.latex(bg.explicit(equations)), bg.explain(graph).latex()]
    for text in (*texts, *typeset):
        assert INNER.search(text) is None, text
    assert "J" in matrices_latex(powers(equations))
    check_latex(equations._repr_latex_(), tabs=3)


@pytest.mark.parametrize("graph", [LIMITED, RELAY, LIMITER])
def test_the_matrices_are_those_of_the_motor(graph: bg.BondGraph) -> None:
    shown = powers(bg.derive(graph))
    J, b = sp.symbols("J b")
    assert [str(name) for name in (*shown.states, *shown.inputs, *shown.outputs)] == [
        "omega",
        "e_motor",
    ]
    assert (shown.A[0], shown.J[0], shown.B[0]) == (J, -b, 1)


def _ruled(graph: bg.BondGraph) -> Statement:
    found = statements(bg.derive(graph))
    return next(one for one in (*found.given, *found.rates) if one.ruled is not None)


def _values(graph: bg.BondGraph, **numbers: float) -> list[float]:
    told = {name.replace("_dot", "'"): value for name, value in numbers.items()}
    return allowed(
        _ruled(graph), lambda e: float(e.subs({sp.Symbol(n): v for n, v in told.items()})), 1e-9
    )


def test_both_ways_of_each_bound_are_stated() -> None:
    """z within -1 and 2: it rests at a bound that its rate leads beyond, and leaves it as that turns."""
    at = {"top": 2.0}
    assert _values(LIMITED, z=0.5, rate_z=3, **at) == [3]
    assert set(_values(LIMITED, z=2, rate_z=3, **at)) == {0}
    assert set(_values(LIMITED, z=2, rate_z=-3, **at)) == {-3}
    assert set(_values(LIMITED, z=-1, rate_z=-3, **at)) == {0}
    assert set(_values(LIMITED, z=-1, rate_z=3, **at)) == {3}


def test_a_relay_is_what_its_thresholds_leave() -> None:
    assert _values(RELAY, omega=2.5) == [0]
    assert _values(RELAY, omega=0.5) == [1]
    assert sorted(_values(RELAY, omega=1.5)) == [0, 1]


def test_a_limited_rate_is_one_of_three() -> None:
    assert _values(LIMITER, step=3, r=1, rate=2, step_dot=9) == [2]
    assert _values(LIMITER, step=0, r=1, rate=2, step_dot=9) == [-2]
    assert _values(LIMITER, step=1, r=1, rate=2, step_dot=-0.5) == [-0.5]
    assert _values(LIMITER, step=1, r=1, rate=2, step_dot=-5) == [-2]


def _at(
    graph: bg.BondGraph, time: float, numbers: dict, signals: dict, initial: dict | None = None
) -> Instant:
    """A run's instant: five samples from there on, inputs' slopes told."""
    ready = simulator(bg.derive(graph), numbers)
    run = ready.run([0.0, *(time + 1e-3 * np.arange(5))], initial or {}, signals)
    told = {"t": time, **numbers, **{f"{name}'": 0.0 for name in numbers}}
    for name, signal in signals.items():
        told |= {name: signal(time), f"{name}'": signal.piece(time).derivative(time)}
    return Instant(run, told, 1e-6)


MOTOR = {"J": 1.0, "b": 0.5}
CASES = [
    (LIMITED, 2.0, {**MOTOR, "K": 0.1, "K_i": 1.0, "top": 0.5}, {"ref": Constant(5.0)}, {}, {"z": 0.5}),
    (LIMITED, 3.0, {**MOTOR, "K": 0.1, "K_i": 1.0, "top": 0.5}, {"ref": Constant(-5.0)}, {}, {"z": -1.0}),
    (LIMITED, 0.05, {**MOTOR, "K": 0.1, "K_i": 1.0, "top": 0.5}, {"ref": Constant(2.0)}, {}, {}),
    (RELAY, 0.2, {**MOTOR, "T": 3.0}, {}, {"omega": 2.5}, {"relay": 0.0}),
    (RELAY, 0.2, {**MOTOR, "T": 3.0}, {}, {"omega": 0.5}, {"relay": 1.0}),
    (LIMITER, 1.0, {**MOTOR, "K": 1.0, "rate": 2.0}, {"step": Constant(5.0)}, {}, {"r": 2.0}),
    (LIMITER, 1.0, {**MOTOR, "K": 1.0, "rate": 2.0}, {"step": Constant(-5.0)}, {}, {"r": -2.0}),
    (LIMITER, 1.0, {**MOTOR, "K": 1.0, "rate": 2.0}, {"step": Ramp(0.0, 1.5)}, {}, {"r": 1.5}),
    (SAMPLED, 0.105, {**MOTOR, "K": 1.0}, {"ref": Constant(1.0)}, {}, {}),
]  # fmt: skip
"""Graph, time [s], numbers, inputs, start, and what of the run is so by hand."""


@pytest.mark.parametrize("case", CASES)
def test_in_each_way_what_is_stated_is_what_the_simulator_computes(case: Any) -> None:
    graph, time, numbers, signals, initial, known = case
    at = _at(graph, time, numbers, signals, initial)
    for name, value in known.items():
        assert at.run[name][1] == pytest.approx(value, abs=1e-9)
    assert misfits(bg.derive(graph), at) == []


def test_what_is_none_of_its_ways_is_seen() -> None:
    one = _ruled(LIMITED)
    numbers = {"z": 2.0, "rate_z": 3.0, "top": 2.0, "z'": 3.0}

    def number(expr: sp.Expr) -> float:
        return float(expr.subs({sp.Symbol(name): value for name, value in numbers.items()}))

    assert "is not of" in ruled_misfit(one, number, 1e-6)
    numbers["z'"] = 0.0
    assert ruled_misfit(one, number, 1e-6) == ""


def test_names_of_several_letters_stand_upright_in_latex() -> None:
    text = bg.latex(bg.derive(LIMITED))
    assert r"\mathrm{rate}_{z} &= K_{i} \left(\mathrm{ref} - \omega\right)" in text
    assert r"\begin{cases} \mathrm{rate}_{z} & \text{within } -1 \leq z \leq \mathrm{top}" in text


def test_what_controllers_set_stands_below_one_another() -> None:
    text = bg.latex(bg.derive(SAMPLED))
    assert text.count("&:=") == 2
    assert text.count(r"\text{every 1/50 s, by what there was before}") == 1


def test_the_command_line_tells_the_same(tmp_path: Any) -> None:
    path = tmp_path / "limited.json"
    bg.write_json(LIMITED, path)
    found = CliRunner().invoke(app, ["derive", str(path)])
    assert found.exit_code == 0, found.output
    assert "z' = K_i*(ref - omega) within -1 <= z <= top" in found.output
    assert "f_z" not in found.output
    data = json.loads(CliRunner().invoke(app, ["derive", str(path), "--json"]).output)
    told = json.dumps(data)
    assert "rate_z within -1 <= z <= top: at a bound z' = 0 while rate_z leads beyond" in told


def test_what_a_run_of_a_file_needs_names_what_signals_read(tmp_path: Any) -> None:
    path = tmp_path / "relay.json"
    bg.write_json(RELAY, path)
    found = CliRunner().invoke(app, ["show", str(path)])
    assert found.exit_code == 0, found.output
    lines = [
        line.split(":", 1) for line in found.output.splitlines() if "--" in line and ":" in line
    ]
    told = {what.split(" (")[0]: names.strip() for what, names in lines}
    assert told["numbers"] == "J, b"
    assert told["numbers or signals"] == "T"
    assert "switch" not in found.output


def test_json_has_the_matrices_that_are_printed(tmp_path: Any) -> None:
    path = tmp_path / "limiter.json"
    bg.write_json(LIMITER, path)
    data = json.loads(CliRunner().invoke(app, ["derive", str(path), "--json"]).output)
    assert (data["states"], data["inputs"]) == (["omega"], ["e_motor"])
    assert (data["A"], data["J"], data["B"]) == ([["J"]], [["-b"]], [["1"]])
    assert data["rates"]["r'"].startswith("rate while step > r")

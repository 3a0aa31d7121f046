"""What there is and what follows from it, as text and as data."""

import re
from collections.abc import Callable
from typing import Any

import pytest
import sympy as sp
from click.testing import Result

import bondgraph as bg
import differentials

Call = Callable[..., Result]

Data = Callable[..., Any]


def test_list_names_every_differential_and_scenario(call: Call) -> None:
    text = call("list").stdout
    for name in (*differentials.catalog, *differentials.scenarios):
        assert name in text
    assert re.search(r"four_wheel_drive_tvd +4 or 12 +2 +fig14", text)


def test_list_as_data_has_the_papers_orders(data: Data) -> None:
    found = data("list")
    orders = {row["name"]: (row["states"], row["full_states"]) for row in found["differentials"]}
    assert orders["alsd"] == (2, 6)
    assert orders["four_wheel_drive_tvd"] == (4, 12)
    assert orders["passive_input_clutch"] == (3, None)
    cases = {row["name"]: row for row in found["scenarios"]}
    assert (cases["fig11"]["engine_torque"], cases["fig11"]["clutch_torques"]) == (350.0, [1000.0])


@pytest.mark.parametrize("name", differentials.catalog)
def test_show_gives_equations_causality_parameters_and_modes(name: str, call: Call) -> None:
    done = call("show", name)
    assert done.exit_code == 0
    equations = differentials.equations(name)
    assert str(equations) in done.stdout
    assert all(f"{state}'" in done.stdout for state in equations.states)
    assert differentials.catalog[name].title in done.stdout
    for part in ("dependent (derivative causality)", "kg m^2", "pole [1/s]"):
        assert part in done.stdout


def test_show_of_variants(call: Call) -> None:
    text = call("show", "alsd", "--halfshafts", "--unlumped").stdout
    assert "tau_k1" in text
    assert "I_i, I_c" in text
    text = call("show", "superposition_tvd").stdout
    assert "omega_f1 = 0 at" in text
    assert "= 1.2857" in text


def test_show_as_data(data: Data) -> None:
    found = data("show", "alsd")
    assert found["causality"]["derivative"] == ["I_i"]
    assert found["causality"]["why"]["I_i"]
    assert found["parameters"]["k"]["value"] == 8600.0
    assert found["parameters"]["k"]["unit"] == "N m/rad"
    assert {"tail": "engine", "head": "input", "effort_to": "input"} in found["causality"][
        "strokes"
    ]


def test_show_of_a_file_says_what_a_run_needs(call: Call) -> None:
    text = call("show", "examples/oscillator.json").stdout
    assert "a mass on a spring and a damper, and a force" in text
    assert re.search(r"--set NAME=NUMBER\): +b, k, m\n", text)
    assert "F from force" in text


def test_modes_of_switches_have_equations_of_their_own(data: Data, call: Call) -> None:
    file = "examples/rectifier.json"
    conducting, blocking = data("derive", file, "--on", "d"), data("derive", file, "--off", "d")
    assert sp.sympify(conducting["J"][0][0]) == sp.sympify("-1/R_l - 1/R_s")
    assert sp.sympify(blocking["J"][0][0]) == sp.sympify("-1/R_l")
    assert "switches that are on: d (of d)" in call("show", file, "--on", "d").stdout
    assert "switches that are on: none (of d)" in call("derive", file, "--off", "d").stdout


def test_a_graph_with_switches_is_shown_as_it_stands(data: Data, call: Call) -> None:
    """C v' = (u - e_d - v)/R_s - v/R_l, whatever e_d the diode takes."""
    file = "examples/rectifier.json"
    whole = data("derive", file)
    assert (whole["states"], whole["inputs"]) == (["v"], ["u", "e_d"])
    assert sp.sympify(whole["B"][0][1]) == sp.sympify("-1/R_s")
    text = call("show", file).stdout
    assert "switches, each let go or held: d (held while off, one-sided)\n" in text
    assert re.search(r"\(--input, --law\): +u from mains\n", text)
    assert "an ideal switch; on, it gives e_d = 0" in " ".join(call("explain", file).stdout.split())
    assert "Sw: f_d ≥ 0\n" in call("draw", file).stdout
    assert "|" in next(line for line in call("draw", file).stdout.splitlines() if "Sw" in line)


def test_derive_gives_the_papers_matrices(data: Data) -> None:
    """IMECE2008-69248, Appendix B, ALSD: the input inertia in A, the slip in F."""
    found = data("derive", "alsd")
    assert found["states"] == ["omega_1", "omega_2"]
    assert found["inputs"] == ["tau_e", "tau_f", "tau_t1", "tau_t2"]
    own, other = "I_w1 + I_i*i**2/4", "I_i*i**2/4"
    expected = [[own, other], [other, own.replace("I_w1", "I_w2")]]
    assert sp.Matrix(sp.sympify(found["A"])) == sp.Matrix(sp.sympify(expected))
    assert found["F"] == [["1/2", "-1/2"]]


def test_derive_of_a_file_shows_what_is_asked_for(data: Data) -> None:
    """A mass on a spring: m v' = F - b v - F_k, F_k'/k = v; the spring's flow is v."""
    found = data("derive", "examples/oscillator.json", "--output", "spring")
    assert found["states"] == ["v", "F_k"]
    assert found["A"] == [["m", "0"], ["0", "1/k"]]
    assert found["J"] == [["-b", "-1"], ["1", "0"]]
    assert found["B"] == [["1"], ["0"]]
    assert found["F"] == [["1", "0"]]


def test_derive_as_text_and_as_latex(call: Call) -> None:
    equations = differentials.equations("alsd")
    assert call("derive", "alsd").stdout == f"{equations}\n"
    assert call("derive", "alsd", "--latex").stdout == f"{bg.latex(equations)}\n"


def test_explain_as_text_and_as_latex(call: Call) -> None:
    done = call("explain", "passive", "--halfshafts")
    assert done.exit_code == 0
    assert "I_i" in done.stdout
    assert "\\" not in done.stdout
    assert "\\" in call("explain", "passive", "--latex").stdout
    assert "spring" in call("explain", "examples/oscillator.json").stdout

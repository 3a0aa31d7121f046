"""The models that other tools are measured with: their exact solutions and their texts."""

import re

import numpy as np
import pytest
from references.fig11 import TAU_H, Parameters, System

from benchmarks.tools import chains, drivelines, ladders

UNIFORM = chains.Chain((2.0,) * 6, (1e-3,) * 5, (0.0,) * 6)


def test_a_uniform_free_chain_has_the_frequencies_of_theory():
    # A row of n equal masses between equal springs, both ends free: 2 sqrt(k/m) sin(j pi/(2 n)).
    A, _ = chains.matrices(UNIFORM)
    found = np.sort(np.linalg.eigvals(A).imag)[5:]
    expected = 2 * np.sqrt(1e3 / 2.0) * np.sin(np.arange(6) * np.pi / 12)
    assert np.allclose(found, expected, atol=1e-9)


def test_the_momentum_of_a_chain_is_what_drives_it_less_what_dampers_take():
    one = chains.chain(5)
    speeds = chains.speeds(one)
    step = chains.END / (chains.SAMPLES - 1)
    resisted = speeds @ np.array(one.dampers)
    taken = step * (resisted.sum() - (resisted[0] + resisted[-1]) / 2)
    assert speeds[-1] @ np.array(one.inertias) == pytest.approx(
        one.torque * chains.END - taken, rel=1e-5
    )


def test_the_text_of_a_chain_has_its_numbers_and_joins_everything():
    one = chains.chain(4)
    text = chains.text(one)
    for part, name, expected in (
        ("Inertia", "m", one.inertias), ("Damper", "b", one.dampers), ("Spring", "c", one.compliances)
    ):  # fmt: skip
        told = re.findall(rf"  {part} \w+\({name} = ([^)]*)\);", text)
        assert tuple(map(float, told)) == expected
    ends = re.findall(r"connect\((\S+), (\S+)\);", text)
    joined = {end for pair in ends for end in pair}
    assert {"drive.a", *(f"m_{k}.a" for k in range(4)), *(f"b_{k}.a" for k in range(4))} <= joined
    assert {f"c_{k}.{side}" for k in (1, 2, 3) for side in "ab"} <= joined
    # A tree: one joint less than there are ends, counting each place where several meet once.
    assert len(ends) == 1 + 4 + 2 * 3


def test_a_chain_is_read_back_from_what_tools_are_told():
    one = chains.chain(3)
    assert chains.read(chains.spec(one)) == one
    two = ladders.Ladder(sections=3, R=2.0)
    assert ladders.read(ladders.spec(two)) == two


def test_a_ladder_without_resistance_swings_as_a_coil_and_a_capacitor_do():
    one = ladders.Ladder(sections=1, R=0.0, load=1e15, V=3.0)
    times = np.linspace(0, 2e-3, 50)
    expected = 3.0 * (1 - np.cos(times / np.sqrt(one.L * one.C)))
    assert np.allclose(ladders.voltages(one, times)[:, 0], expected, atol=1e-9)


def test_a_ladder_comes_to_what_its_resistances_divide():
    one = ladders.Ladder(sections=4, R=5.0, load=30.0, V=10.0)
    A, b = ladders.matrices(one)
    resting = np.linalg.solve(A, -b)
    assert resting[:4] == pytest.approx([0.2] * 4)
    assert resting[4:] == pytest.approx([9.0, 8.0, 7.0, 6.0])


def test_the_netlist_and_the_text_of_a_ladder_have_the_same_parts():
    one = ladders.Ladder(sections=3)
    deck = ladders.netlist(one).splitlines()
    assert [line for line in deck if line[0] in "RLC"] == [
        "R1 n0 a1 1.0", "L1 a1 n1 0.001 IC=0", "C1 n1 0 1e-06 IC=0",
        "R2 n1 a2 1.0", "L2 a2 n2 0.001 IC=0", "C2 n2 0 1e-06 IC=0",
        "R3 n2 a3 1.0", "L3 a3 n3 0.001 IC=0", "C3 n3 0 1e-06 IC=0", "RL n3 0 50.0",
    ]  # fmt: skip
    text = ladders.text(one)
    assert [len(re.findall(rf"  {part} {letter}_\d", text)) for part, letter in
            (("Resistor", "R"), ("Inductor", "L"), ("Capacitor", "C"))] == [3, 3, 3]  # fmt: skip


def test_the_open_differential_is_fig_11_without_torque_on_its_clutch():
    expected = np.delete(np.delete(System(Parameters()).matrix(1, True, False), TAU_H, 0), TAU_H, 1)
    p = drivelines.NUMBERS
    assert np.allclose(drivelines.open_matrix(p["k"], p["I_w"]), expected, rtol=1e-12, atol=0)


def test_tires_that_saturate_far_away_are_linear(monkeypatch):
    monkeypatch.setitem(drivelines.NUMBERS, "limit", 1e9)
    linear, saturated = (
        drivelines.end_torque(9000.0, 0.7),
        drivelines.end_torque_saturated(9000.0, 0.7),
    )
    assert saturated == pytest.approx(linear, rel=1e-9)


def test_derivatives_are_those_of_differences():
    k, I_w = drivelines.NUMBERS["k"], drivelines.NUMBERS["I_w"]
    torque, part = drivelines.end_torque, 1e-4
    by_k = (torque(k * (1 + part), I_w) - torque(k * (1 - part), I_w)) / (2 * part * k)
    by_I = (torque(k, I_w * (1 + part)) - torque(k, I_w * (1 - part))) / (2 * part * I_w)
    assert drivelines.gradient() == pytest.approx((by_k, by_I), rel=1e-5)


def test_pairs_of_a_sweep_differ_and_lie_around_the_numbers():
    pairs = drivelines.pairs(40)
    assert len({tuple(pair) for pair in pairs.tolist()}) == 40
    assert pairs.min(axis=0) == pytest.approx([4300.0, 0.6])
    assert pairs[:, 0].max() == pytest.approx(12900.0)


@pytest.mark.parametrize(
    ("dialect", "there", "not_there"),
    [
        (drivelines.Dialect(True), ("discrete Integer mode", "pre(mode) == 0 and"), ("tanh",)),
        (drivelines.Dialect(True, True), ("discrete Real mode", "elsewhen up > 0"), ("tanh", " and hold")),
        (drivelines.Dialect(False), ("tanh((w_1 - w_2)/2/0.01)",), ("when", "pre(", "mode(")),
    ],
)  # fmt: skip
def test_a_clutch_is_told_as_a_tool_takes_it(dialect, there, not_there):
    text = drivelines.clutch_text(dialect)
    assert all(words in text for words in there)
    assert not any(words in text for words in not_there)


@pytest.mark.parametrize("text", [
    chains.text(chains.chain(3)), ladders.text(ladders.Ladder()), drivelines.open_text(False),
    *(drivelines.clutch_text(drivelines.Dialect(*how)) for how in ((True,), (True, True), (False,))),
])  # fmt: skip
def test_texts_close_what_they_open_and_have_an_equation_for_each_unknown(text):
    assert re.findall(r"^(?:model|connector) (\w+)$", text, re.M) == re.findall(
        r"^end (\w+);$", text, re.M
    )
    assert text.count("(") == text.count(")")
    last = text[text.rindex("\nmodel ") if "\nmodel " in text else 0 :]
    declared, equations = last.split("\nequation\n")
    unknown = len(re.findall(r"^  (?:discrete )?(?:Real|Integer) ", declared, re.M))
    if "connect(" not in text:
        outside = re.sub(r"  when .*?  end when;\n", "", equations, flags=re.S)
        assert outside.count(" = ") + ("when " in equations) == unknown

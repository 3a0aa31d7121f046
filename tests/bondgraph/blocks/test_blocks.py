"""Blocks as nodes: what they are made of, in symbols, and what is refused by name."""

from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp

import bondgraph as bg
import codegen
from bondgraph.nodes.elements import Node

s, a, b, c, k = sp.symbols("s a b c k")


def _transfer(nodes: list[Node], name: str = "y") -> sp.Expr:
    equations = bg.derive(bg.graph([nodes]), outputs=[name])
    (found,) = bg.linearize(equations, inputs=["u"]).transfer_function(s)
    return found


@pytest.mark.parametrize(
    ("num", "den", "wanted"),
    [
        (["k"], ["a", 1], k / (a * s + 1)),
        ("k", [1, 0, "b"], k / (s**2 + b)),
        ([1, "k", 2], ["a", "b", "c"], (s**2 + k * s + 2) / (a * s**2 + b * s + c)),
        ([0, 0.5, "k - 1"], [2, "-b", 4, 1], (s / 2 + k - 1) / (2 * s**3 - b * s**2 + 4 * s + 1)),
        ([a + b, c], [k**2, 3], ((a + b) * s + c) / (k**2 * s + 3)),
        (np.array([1.0, 0.25]), np.array([1, 2, 3]), (s + sp.Rational(1, 4)) / (s**2 + 2 * s + 3)),
        (["a"], ["b"], a / b),
    ],
)
def test_a_transfer_function_has_its_coefficients_as_symbols(
    num: object, den: object, wanted: sp.Expr
) -> None:
    found = _transfer(bg.TransferFunction("y", "u", num, den))
    assert sp.cancel(found - wanted) == 0


def test_a_state_space_is_c_over_s_less_a() -> None:
    A, B = sp.Matrix([[0, 1], [-k, -b]]), sp.Matrix([0, a])
    C, D = sp.Matrix([[1, c]]), sp.Matrix([[sp.Rational(1, 2)]])
    found = _transfer(bg.StateSpace("y", "u", A, B, C, D.tolist()))
    wanted = (C * (s * sp.eye(2) - A).inv() * B + D)[0]
    assert sp.cancel(found - wanted) == 0


def test_a_pid_is_its_three_terms() -> None:
    kp, ki, kd, tau = sp.symbols("kp ki kd tau_d")
    found = _transfer(bg.PID("y", "u - 0", "kp", "ki", kd, "tau_d"))
    assert sp.cancel(found - (kp + ki / s + kd * s / (tau * s + 1))) == 0
    assert len(bg.PID("y", "u", 2, kd=0.0)) == 1


def test_a_list_among_the_nodes_is_nodes_as_well() -> None:
    """Those of a block, however deep, are as good as one by one."""
    nodes = [bg.Gain("e", "u", 2), *bg.TransferFunction("y", "e", [1], [1, 1])]
    one, other = bg.graph(nodes), bg.graph([nodes[0], [[nodes[1]], nodes[2]]])
    assert list(one.nodes(data=True)) == list(other.nodes(data=True))
    with pytest.raises(bg.StructureError, match="two nodes are called 'e'"):
        bg.graph([nodes, [nodes[0]]])


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: bg.TransferFunction("G", "u", [1, 0, 0], [1, 1]), "'G': its num has degree 2, its den 1"),
        (lambda: bg.TransferFunction("G", "u", [1], [0, 0]), "'G': its den is zero"),
        (lambda: bg.TransferFunction("G", "u", [[1]], [1, 1]), "'G', num has rows"),
        (lambda: bg.TransferFunction("G", "u", [1], [None, 1]), "'G', den: its coefficient is None"),
        (lambda: bg.StateSpace("S", "u", [[0, 1]], [[1]], [[1]]), "'S': A has 1 rows of .2.; it must be"),
        (lambda: bg.StateSpace("S", "u", [[0]], [[1, 2]], [[1]]), "'S': B has .* it must be 1 by 1"),
        (lambda: bg.StateSpace("S", "u", [0, 1], [[1]], [[1]]), "'S': A is .*give a list of rows"),
        (lambda: bg.StateSpace("S", "u", 0, 1, 1, start=[1, 2]), "'S': start has 2 values for 1 states"),
        (lambda: bg.PID("c", "e", 1, kd=2), "'c': a rate that is not filtered is improper; give tau_d"),
        (lambda: bg.PID("c", "e", 1, kd=2, tau_d=0), "'c': tau_d is 0; a time constant is above zero"),
        (lambda: bg.PID("c", "e", 1, 1, tau_t=1), "'c': tau_t leads the integral back from a bound"),
        (lambda: bg.PID("c", "e", 1, 1, low=1, high="1/2"), "'c': low 1 is not below high 1/2"),
        (lambda: bg.Limiter("l", "e"), "'l': a limiter without a bound"),
        (lambda: bg.DeadZone("d", "e", 1, 1), "'d': low 1 is not below high 1"),
        (lambda: bg.Sum("e"), "'e' has no inputs"),
        (lambda: bg.Gain("g", None, 2), "'g': its input is None"),
        (lambda: bg.Gain("g", "e", True), "'g': its gain is True"),
        (lambda: bg.LookUp("t", "e", [1, 2]), "'t': .* is no table"),
    ],
)  # fmt: skip
def test_what_has_no_meaning_is_refused_by_name(make: Callable[[], object], says: str) -> None:
    with pytest.raises(bg.StructureError, match=f"node {says}"):
        make()


@pytest.mark.parametrize(
    ("node", "says"),
    [
        (bg.Hysteresis("h", "x", 1, 1), "low 1 is not below high 1"),
        (bg.Hysteresis("h", None, 1, 2), "has no input"),
        (bg.Hysteresis("h", "x - h", 1, 2), "its input reads h itself"),
        (bg.RateLimiter("h", "x", None), "has no rate"),
        (bg.RateLimiter("h", "x", 1, falling=-2), "the rate -2 is negative; give its magnitude"),
        (bg.RateLimiter("h", "x - h", 1), "its input reads h itself"),
    ],
)
def test_memories_without_a_meaning_are_refused_by_name(node: Node, says: str) -> None:
    with pytest.raises(bg.StructureError, match=f"node 'h'.*{says}"):
        bg.derive(bg.graph([node, bg.State("x", "-x")]))


@pytest.mark.parametrize(
    ("start", "on", "values"),
    [(0.5, [], [0, 0]), (0.5, ["h.switch"], [1, 1]), (2.5, [], [1, 1]), (-1.0, ["h.switch"], [0, 0])],
)  # fmt: skip
def test_a_hysteresis_begins_as_its_input_or_the_run_says(
    start: float, on: list[str], values: list[float]
) -> None:
    equations = bg.derive(bg.graph([bg.Hysteresis("h", "x", 0, 2), bg.State("x", "0*t")]))
    run = codegen.simulator(equations, {}).run([0, 1], {"x": start}, initially_on=on)
    assert run["h"].tolist() == values


def test_a_rate_limiter_of_what_jumps_as_a_switch_turns_says_what_it_lacks() -> None:
    nodes = [bg.Hysteresis("h", "x", 0, 2), bg.State("x", "1 + 0*t"), bg.RateLimiter("y", "h", 4)]
    ready = codegen.simulator(bg.derive(bg.graph(nodes)), {})
    with pytest.raises(
        bg.SimulationError, match=r"holding 'y.clutch' would need the slope in time"
    ):
        ready.run([0, 1])


@pytest.mark.parametrize(
    ("input", "start", "first"),
    [("cos(t)", None, 1), ("cos(t)", 0.25, 0.25), ("k*cos(t)", None, 0), ("k*cos(t)", "k", 2)],
)
def test_a_rate_limiter_begins_where_it_is_told(input: str, start: object, first: float) -> None:
    equations = bg.derive(bg.graph([bg.RateLimiter("y", input, 0.5, start=start)]))
    parameters = {"k": 2} if "k" in input else {}
    assert codegen.simulator(equations, parameters).run([0, 1])["y"][0] == first

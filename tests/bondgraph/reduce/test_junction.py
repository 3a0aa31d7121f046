"""`junction_structure`: power-conserving by construction, loops solved exactly."""

import random
from fractions import Fraction

import pytest
import sympy as sp
from references.alsd import alsd_graph
from references.brute_force import regular
from references.build import Graph, bond_graph, turned
from references.matrices import differences, rationals
from references.random_graphs import random_graph

import bondgraph as bg


def _structure(graph: Graph) -> bg.JunctionStructure:
    return bg.junction_structure(bg.assign_causality(graph))


def _into_ports(structure: bg.JunctionStructure) -> sp.Matrix:
    """S with power counted into every port: row i times +1 or -1."""
    return sp.diag(*(port.inward for port in structure.ports)) * sp.Matrix(structure.S)


def _assert_skew(graph: Graph) -> None:
    power = _into_ports(_structure(graph))
    assert differences(power, -power.T) == {}


def test_differential_conserves_power() -> None:
    _assert_skew(alsd_graph())


def test_motor_with_a_gear_conserves_power() -> None:
    nodes = [
        bg.Se("U", "U"), bg.One("a"), bg.I("L", "L"), bg.GY("motor", "K"), bg.One("b"),
        bg.TF("gear", "n"), bg.GY("pump", "D"), bg.Zero("z"), bg.C("c", "c"), bg.Sf("leak", "q"),
        bg.R("valve"),
    ]  # fmt: skip
    _assert_skew(bond_graph(nodes, "a>U a>L a>motor>b>gear>z>c b>pump>valve z>leak"))


@pytest.mark.parametrize("seed", range(80))
def test_random_structure_conserves_power(seed: int) -> None:
    rng = random.Random(seed)
    graph = random_graph(rng, rng.randint(4, 25), mesh=0.4)
    if not regular(graph):
        return
    structure = _structure(graph)
    names = {str(symbol) for symbol in structure.S.free_symbols}
    power = rationals(_into_ports(structure), {n: Fraction(rng.randint(1, 50), 7) for n in names})
    assert power == -power.T


def test_moduli_are_read_as_the_convention_has_them() -> None:
    """TF ``e_in = m e_out, f_out = m f_in``; GY ``e_in = r f_out, e_out = r f_in``."""
    m, r = sp.symbols("m r")
    lever = _structure(bond_graph([bg.Sf("s", "v"), bg.TF("g", "m"), bg.C("c", "c")], "s>g>c"))
    assert [port.gives for port in lever.ports] == ["flow", "effort"]
    assert differences(lever.S, [[0, m], [m, 0]]) == {}
    motor = _structure(bond_graph([bg.Sf("s", "v"), bg.GY("g", "r"), bg.I("l", "l")], "s>g>l"))
    assert [port.gives for port in motor.ports] == ["flow", "flow"]
    assert differences(motor.S, [[0, r], [r, 0]]) == {}


def test_ports_are_in_declaration_order_with_what_they_give() -> None:
    ports = _structure(alsd_graph()).ports
    names = ["engine", "I_i", "I_w1", "I_w2", "clutch", "tire_1", "tire_2"]
    assert [port.element.name for port in ports] == names
    gives = ["effort", "effort", "flow", "flow", "effort", "effort", "effort"]
    assert [port.gives for port in ports] == gives
    assert [port.inward for port in ports] == [-1, 1, 1, 1, 1, 1, 1]
    assert [str(port.given) for port in ports[:3]] == ["tau_e", "e_I_i", "omega_1"]
    assert [str(port.received) for port in ports[:3]] == ["f_engine", "f_I_i", "e_I_w1"]


def test_source_drawn_as_a_head_receives_power() -> None:
    graph = turned(alsd_graph(), {("engine", "input"), ("left", "I_w1")})
    ports = _structure(graph).ports
    assert [port.inward for port in ports] == [1, 1, 1, 1, 1, 1, 1]
    _assert_skew(graph)


def test_junctions_know_their_common_variable() -> None:
    """The case turns at the mean of the wheels; at the clutch the effort is the clutch's own."""
    structure = _structure(alsd_graph())
    half = sp.Rational(1, 2)
    assert dict(structure.common["case"]) == {2: half, 3: half}
    assert dict(structure.common["left"]) == {2: 1}
    assert dict(structure.common["slip"]) == {4: 1}
    assert set(structure.common) == {"input", "case", "sum", "left", "right", "slip"}


def test_loop_is_solved_exactly() -> None:
    """Two transformers in a ring: e_z = m e_1 and e_2 = n e_z, with e_1 - e_2 = e_p at j.

    So e_z = m e_p/(1 - m n).
    """
    m, n = sp.symbols("m n")
    nodes = [
        bg.Sf("s", "u"), bg.Zero("z"), bg.TF("g", "m"), bg.One("j"), bg.TF("h", "n"),
        bg.R("p"), bg.I("i", "i", priority=-1),
    ]  # fmt: skip
    graph = bond_graph(nodes, "s>z>g>j>h>z j>p z>i")
    assert regular(graph)
    _assert_skew(graph)
    structure = _structure(graph)
    names = [port.element.name for port in structure.ports]
    entry = structure.S[names.index("s"), names.index("p")]
    assert sp.cancel(entry - m / (1 - m * n)) == 0


def test_result_depends_on_the_moduli_only() -> None:
    symbols = _structure(alsd_graph()).S.free_symbols
    assert symbols == {sp.Symbol("i")}

"""Steady states and rates at an instant, with switches as states and inputs tell them."""

import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import simulator, trim

RECTIFIER = simulator(
    bg.derive(
        bond_graph(
            [bg.Se("src", "u"), bg.One("loop"), bg.Diode("d"), bg.R("R_1", 1), bg.Zero("out"),
             bg.C("c", "1/1000", effort="v"), bg.R("load", 99)],
            "src>loop>d loop>R_1 loop>out out>c out>load",
        )
    ),
    {},
)  # fmt: skip


@pytest.mark.parametrize(("u", "v", "e_d"), [(10.0, 9.9, 0.0), (-10.0, 0.0, -10.0)])
def test_a_rectifier_rests_conducting_or_not(u: float, v: float, e_d: float) -> None:
    point = trim(RECTIFIER, {"u": u})
    assert point["v"] == pytest.approx(v, abs=1e-9)
    assert point["e_d"] == pytest.approx(e_d, abs=1e-9)
    assert RECTIFIER.rhs(0.0, [point["v"]], [u]) == pytest.approx([0.0], abs=1e-6)


def test_a_mode_in_which_nothing_rests_is_refused_by_name() -> None:
    with pytest.raises(bg.SimulationError, match=r"no steady state.*; 'd' would not stay off$"):
        trim(RECTIFIER, {"u": 10.0}, mode={"d": "off"})
    with pytest.raises(bg.SimulationError, match=r"no steady state.*; 'd' would not stay on$"):
        trim(RECTIFIER, {"u": -10.0}, mode={"d": "on"})


@pytest.mark.parametrize(("u", "v"), [(10.0, 9.0), (0.0, 5.0), (-10.0, 0.0)])
def test_the_rate_of_a_rectifier_is_that_of_its_diode(u: float, v: float) -> None:
    current = max(u - v, 0.0) / 1.0
    assert RECTIFIER.rhs(0.0, [v], [u]) == pytest.approx([1000 * (current - v / 99)])


DRIVE = [bg.Se("e", "T"), bg.One("a"), bg.I("m_1", 1, flow="v_1"), bg.R("d_1", 2), bg.Zero("gap"),
         bg.Sw("dog", on="gate"), bg.One("b"), bg.I("m_2", 3, flow="v_2"), bg.R("d_2", 6)]  # fmt: skip
DOG = bg.derive(bond_graph(DRIVE, "e>a a>m_1 a>d_1 a>gap>dog gap>b>m_2 b>d_2"))


@pytest.mark.parametrize(
    ("gate", "mode", "speeds"),
    [
        (-1.0, None, (2.0, 2.0)),
        (1.0, None, (8.0, 0.0)),
        (0.0, None, (2.0, 2.0)),
        (0.0, {"dog": "on"}, (8.0, 0.0)),
        (0.0, {"dog": "off"}, (2.0, 2.0)),
    ],
)
def test_a_dog_joins_as_its_input_says(gate, mode, speeds) -> None:
    """Apart each turns by its own damper; joined T/(2 + 6). A gate of zero leaves it as it is told."""
    ready = simulator(DOG, {})
    point = trim(ready, {"T": 16.0, "gate": gate}, mode=mode)
    assert [point[v] for v in ("v_1", "v_2")] == pytest.approx(speeds, abs=1e-9)
    told = mode or {"dog": "on" if gate > 0 else "off"}
    poles = bg.linearize(DOG, at=point, mode=told).numeric({}).poles()
    assert sorted(poles.real) == pytest.approx([-2.0] if told["dog"] == "off" else [-2.0, -2.0])


def test_a_dog_that_its_input_opens_does_not_stay_off() -> None:
    with pytest.raises(bg.SimulationError, match="'dog' would not stay off"):
        trim(simulator(DOG, {}), {"T": 16.0, "gate": 1.0}, mode={"dog": "off"})


def test_the_rates_of_a_dog_are_those_of_its_mode() -> None:
    """Joined (16 - 2 v - 6 v)/4; at speeds that differ the impact comes first, at (v_1 + 3 v_2)/4."""
    ready = simulator(DOG, {})
    assert ready.rhs(0.0, [1.0, 1.0], [16.0, -1.0]) == pytest.approx([2.0, 2.0])
    assert ready.rhs(0.0, [3.0, 1.0], [16.0, 1.0]) == pytest.approx([10.0, -2.0])
    assert ready.rhs(0.0, [3.0, 1.0], [16.0, -1.0]) == pytest.approx([1.0, 1.0])
    assert ready.rhs(0.0, [3.0, 1.0], [16.0, 0.0], ["dog"]) == pytest.approx([10.0, -2.0])
    assert ready.rhs(0.0, [3.0, 1.0], [16.0, 0.0]) == pytest.approx([1.0, 1.0])
    with pytest.raises(
        bg.StructureError, match="'cat' is no switch of this graph; there are 'dog'"
    ):
        ready.rhs(0.0, [3.0, 1.0], [16.0, 0.0], ["cat"])


def test_switches_and_friction_rest_together() -> None:
    """A freewheel drives a block that a brake of 2 holds up to T = 2; beyond, its damper carries the rest."""
    nodes = [bg.Se("e", "T"), bg.One("a"), bg.I("m_1", 1, flow="v_1"), bg.R("d_1", 1), bg.Zero("gap"),
             bg.Freewheel("free"), bg.One("b"), bg.I("m_2", 3, flow="v_2"), bg.R("d_2", 4),
             bg.R("rub", effort="tau", flow="w", law=bg.DryFriction(2))]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "e>a a>m_1 a>d_1 a>gap>free gap>b>m_2 b>d_2 b>rub"))
    ready = simulator(equations, {})
    held = trim(ready, {"T": 1.0})
    assert [held["v_1"], held["v_2"]] == pytest.approx([0.0, 0.0], abs=1e-9)
    moves = trim(ready, {"T": 12.0}, {"v_1": 1.0, "v_2": 1.0})
    assert [moves["v_1"], moves["v_2"]] == pytest.approx([2.0, 2.0])
    overrun = trim(ready, {"T": -12.0}, mode={"rub": "stick"})
    assert [overrun["v_1"], overrun["v_2"]] == pytest.approx([-12.0, 0.0], abs=1e-9)
    with pytest.raises(bg.SimulationError, match="'rub' would not stick"):
        trim(ready, {"T": 12.0}, mode={"rub": "stick"})


def test_a_point_may_tell_the_level_of_a_port_that_sticks() -> None:
    nodes = [bg.Se("e", "T"), bg.One("a"), bg.I("m", 1, flow="v"), bg.R("d", 2), bg.C("k", 1, effort="F"),
             bg.R("rub", effort="tau", flow="w", law=bg.DryFriction("level"))]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "e>a a>m a>d a>k a>rub"))
    point = trim(simulator(equations, {}), {"T": 1.0, "level": 5.0}, mode={"rub": "stick"})
    model = bg.linearize(equations, at=point, mode={"rub": "stick"}).numeric({})
    assert model.poles() == pytest.approx([0.0])


def test_a_bridge_rests_either_way_round() -> None:
    legs = {"d1": "a>ap>d1 ap>p", "d2": "b>bp>d2 bp>p", "d3": "na>a na>d3", "d4": "nb>b nb>d4"}
    nodes = [bg.Se("src", "u"), *(bg.One(n) for n in ("s", "ap", "bp", "na", "nb")), bg.Zero("a"),
             bg.Zero("b"), bg.Zero("p"), bg.R("load", 99), bg.R("R_s", 1), bg.C("c", 1, effort="v"),
             *(bg.Diode(d) for d in legs)]  # fmt: skip
    bonds = "src>s b>s s>a p>load s>R_s p>c " + " ".join(legs.values())
    ready = simulator(bg.derive(bond_graph(nodes, bonds)), {})
    for u in (20.0, -20.0):
        assert trim(ready, {"u": u})["v"] == pytest.approx(19.8)


@pytest.mark.parametrize(
    ("mode", "message"),
    [
        ({"dog": "stick"}, "'dog' can be 'on' or 'off', not 'stick'"),
        ({"cat": "on"}, "'cat' is no switch and has no dry friction; there are 'dog'"),
        ("dog", "mode must map nodes to"),
    ],
)
def test_modes_that_there_are_not_are_refused(mode, message: str) -> None:
    with pytest.raises(bg.StructureError, match=message):
        trim(simulator(DOG, {}), {"T": 16.0, "gate": 1.0}, mode=mode)

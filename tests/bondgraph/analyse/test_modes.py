"""`linearize(mode=...)`: switches held and let go, against hand-derived models and modes derived alone."""

import itertools
import random
import re
from typing import Any

import pytest
import sympy as sp
from references.build import bond_graph
from references.matrices import differences
from references.random_switches import random_switched
from references.switched_modes import determinant, of_the_mode, solved
from soak.families import seeds

import bondgraph as bg

C, L, R, R_s, I_1, I_2, b, s = sp.symbols("C L R R_s I_1 I_2 b s")
REFUSALS = (bg.CausalityError, bg.AlgebraicLoopError, bg.SingularStorageError)


def _rectifier() -> bg.StateEquations:
    """A source, a coil and a diode before a capacitor with a load."""
    nodes = [bg.Se("mains", "u"), bg.One("loop"), bg.Diode("d"), bg.I("coil", "L", flow="i"),
             bg.Zero("out"), bg.C("cap", "C", effort="v"), bg.R("load", "R")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "mains>loop>d loop>coil loop>out>cap out>load"))


def _shafts(*more: str) -> bg.StateEquations:
    """T_1 on I_1, T_2 on I_2, a dog between them and a brake on the second, with more open ports."""
    nodes = [bg.Se("e", "T_1"), bg.One("one"), bg.I("i_1", "I_1", flow="w_1"), bg.Zero("z"),
             bg.Sw("dog", on="1 - lever"), bg.One("two"), bg.I("i_2", "I_2", flow="w_2"),
             bg.Se("l", "T_2"), bg.R("brake", law=bg.DryFriction("cap", "1 + b*slip")),
             *map(bg.R, more)]  # fmt: skip
    bonds = " ".join(f"one>{name}" for name in more)
    return bg.derive(bond_graph(nodes, f"e>one>i_1 one>z>dog z>two>i_2 l>two two>brake {bonds}"))


def test_a_diode_on_and_off() -> None:
    """On, L i' = u - v; off, i = 0 and e_d = u - v: an open circuit beside a capacitor with its load."""
    on = bg.linearize(_rectifier(), mode={"d": "on"}, outputs=["v", "e_d", "f_d"])
    assert (on.states, on.inputs) == (sp.symbols("i v"), sp.symbols("u,"))
    assert differences(on.J, [[0, -1], [1, -1 / R]]) == {}
    through = 1 / (s * L + R / (1 + s * R * C))
    assert (
        differences(on.transfer_function(), [[R / (1 + s * R * C) * through], [0], [through]]) == {}
    )
    off = bg.linearize(_rectifier(), mode={"d": "off"}, outputs=["v", "e_d", "f_d"])
    assert (off.states, off.inputs) == (sp.symbols("v,"), sp.symbols("u,"))
    assert (differences(off.A, [[C]]), differences(off.J, [[-1 / R]])) == ({}, {})
    assert differences(off.F, [[1], [-1], [0]]) == {}
    assert differences(off.D, [[0], [1], [0]]) == {}


def test_a_dog_and_a_brake_in_each_of_their_modes() -> None:
    """The dog is out while on; it holds w_1 = w_2 while off; the brake holds w_2 or rubs with b cap."""
    equations, outputs = _shafts(), ["w_1", "w_2", "e_dog", "e_brake"]

    def answers(dog: str, brake: str, **at: object) -> sp.Matrix:
        model = bg.linearize(equations, at, mode={"dog": dog, "brake": brake}, outputs=outputs)
        return model.transfer_function()

    rub = b * sp.Symbol("cap")
    one, two = 1 / (s * I_1), 1 / (s * I_2 + rub)
    free = [[one, 0], [0, two], [0, 0], [0, rub * two]]
    assert differences(answers("on", "slip", w_2=3), free) == {}
    assert differences(answers("on", "slip", w_2=-3), free) == {}
    both = 1 / (s * (I_1 + I_2) + rub)
    carried = [(s * I_2 + rub) * both, -s * I_1 * both]
    assert differences(
        answers("off", "slip", w_2=3), [[both, both], [both, both], carried, [rub * both] * 2]
    ) == {}  # fmt: skip
    assert differences(answers("on", "stick"), [[one, 0], [0, 0], [0, 0], [0, 1]]) == {}
    assert differences(answers("off", "stick"), [[0, 0], [0, 0], [1, 0], [1, 1]]) == {}


def test_stuck_and_stick_are_one() -> None:
    told = bg.linearize(_shafts(), mode={"dog": "off", "brake": "stick"})
    assert told == bg.linearize(_shafts(), stuck=["brake"], mode={"dog": "off"})
    assert told == bg.linearize(_shafts(), stuck=["brake"], mode={"dog": "off", "brake": "stick"})


def test_a_switch_across_a_capacitor_is_held_while_it_is_on() -> None:
    """In flow form: off it takes nothing, R C v' = u - v; on it keeps v = 0 and takes u/R."""
    nodes = [bg.Se("src", "u"), bg.One("w"), bg.R("r", "R"), bg.Zero("z"), bg.C("c", "C", effort="v"),
             bg.Sw("short", on="gate")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "src>w>r w>z>c z>short"))
    assert (equations.switches[0].gives, equations.switches[0].held) == ("flow", "on")
    off = bg.linearize(equations, mode={"short": "off"}, outputs=["v", "f_short"])
    assert differences(off.transfer_function(), [[1 / (1 + s * R * C)], [0]]) == {}
    on = bg.linearize(equations, mode={"short": "on"}, outputs=["v", "f_short"])
    assert on.states == ()
    assert differences(on.D, [[0], [1 / R]]) == {}


def test_a_controlled_junction_is_told_by_its_own_name() -> None:
    nodes = [
        bg.Se("bat", "E"),
        bg.One("loop", on="gate"),
        bg.R("R", "R"),
        bg.C("c", "C", effort="v"),
    ]
    equations = bg.derive(bond_graph(nodes, "bat>loop>R loop>c"))
    on = bg.linearize(equations, mode={"loop": "on"}, outputs=["v"])
    assert differences(on.transfer_function(), [[1 / (1 + s * R * C)]]) == {}
    off = bg.linearize(equations, mode={"loop": "off"}, outputs=["v", "e_loop_switch"])
    assert differences(off.J, [[0]]) == {}
    assert differences(off.F, [[1], [-1]]) == {}


def test_a_switch_against_an_imposed_flow_shows_its_rate() -> None:
    """An open dog against a driven shaft: v = w, and it carries I_1 w' + b w."""
    nodes = [bg.Sf("shaft", "w"), bg.Zero("z"), bg.Sw("dog", on="lever"), bg.One("k"),
             bg.I("i", "I_1", flow="v"), bg.R("r", "b")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "shaft>z>dog z>k>i k>r"))
    model = bg.linearize(equations, mode={"dog": "off"}, outputs=["v", "e_dog"])
    assert (differences(model.D, [[1], [b]]), differences(model.G, [[0], [I_1]])) == ({}, {})


def test_what_holds_a_switch_beside_a_driven_capacitor_shows_the_sources_rate() -> None:
    """u = v_1 + v_2 with v_1 shorted: the short takes C_2 u', open it leaves (C_1 + C_2) v_1' = C_2 u'."""
    nodes = [bg.Se("s", "u"), bg.One("loop"), bg.Zero("n"), bg.C("c_1", "C_1", effort="v_1"),
             bg.Sw("short", on="gate"), bg.C("c_2", "C_2", priority=-1)]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "s>loop>n>c_1 n>short loop>c_2"))
    C_1, C_2 = sp.symbols("C_1 C_2")
    shorted = bg.linearize(equations, mode={"short": "on"}, outputs=["f_short", "e_c_2"])
    assert (differences(shorted.D, [[0], [1]]), differences(shorted.G, [[C_2], [0]])) == ({}, {})
    opened = bg.linearize(equations, mode={"short": "off"}, outputs=["v_1", "f_short"])
    assert differences(opened.transfer_function(), [[C_2 / (C_1 + C_2)], [0]]) == {}


def test_what_a_law_reads_of_a_held_switch_is_known() -> None:
    """A resistance told by the switch's own flow, which is zero while it is open, and by nothing else."""
    nodes = [
        bg.Se("src", "u"),
        bg.One("loop"),
        bg.Sw("k", on="gate"),
        bg.I("L", "L", flow="i"),
        bg.One("own"),
        bg.Se("other", "E"),
        bg.I("m", "C", flow="v"),
        bg.R("r", law="R*v*(1 + f_k)"),
    ]
    equations = bg.derive(bond_graph(nodes, "src>loop>k loop>L other>own>m own>r"))  # fmt: skip
    model = bg.linearize(equations, {"v": 2}, mode={"k": "off"}, outputs=["v"])
    assert differences(model.transfer_function(), [[0, 1 / (s * C + R)]]) == {}
    with pytest.raises(bg.SignalError, match="f_k is 3, but its law gives 0"):
        bg.linearize(equations, {"v": 2, "f_k": 3}, mode={"k": "off"})


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({}, "tell whether 'dog' is on or off, such as mode={'dog': 'off'}"),
        ({"mode": {"brake": "stick"}}, "tell whether 'dog' is on or off"),
        ({"mode": ["dog"]}, "mode must map nodes to 'on', 'off', 'stick' or 'slip', not be ['dog']"),
        ({"mode": {"dog": "stick"}}, "'dog' can be 'on' or 'off', not 'stick'"),
        ({"mode": {"dog": True}}, "'dog' can be 'on' or 'off', not True"),
        ({"mode": {"dog": "on", "brake": "on"}}, "'brake' can be 'stick' or 'slip', not 'on'"),
        ({"mode": {"dgo": "on"}}, "'dgo' is no switch and no port that could stick; there are the "
                                  "switches 'dog' and the ports 'brake', 'open'"),
        ({"mode": {"dog": "on", "i_1": "slip"}}, "'i_1' is no switch and no port that could stick"),
        ({"mode": {"dog": "on", "open": "slip"}}, "'open' has no dry friction that could slip"),
        ({"mode": {"dog": "on", "brake": "slip"}, "stuck": ["brake"]}, "leave one of them out"),
        ({"stuck": ["dog"]}, "'dog' is a switch: tell whether it is on or off in mode"),
        ({"mode": {"dog": "on"}, "laws": {"dog": "3"}}, "law at 'dog': a switch is told by its on and off"),
        ({"mode": {"dog": "on"}, "laws": {"e_dog": "3"}}, "law at 'dog': a switch is told"),
    ],
)  # fmt: skip
def test_wrong_modes_are_refused(more: dict[str, Any], message: str) -> None:
    with pytest.raises(bg.StructureError, match=re.escape(message)):
        bg.linearize(_shafts("open"), **more)


def test_all_switches_left_out_are_named() -> None:
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.Diode("a"), bg.Diode("b"), bg.I("L", 1)]
    equations = bg.derive(bond_graph(nodes, "s>j>a j>b j>L"))
    with pytest.raises(bg.StructureError, match="tell whether 'a', 'b' are on or off"):
        bg.linearize(equations)
    with pytest.raises(bg.SignalError, match="e_a can't be an input"):
        bg.linearize(equations, inputs=["e_a"], mode={"a": "on", "b": "on"})


def test_two_switches_that_hold_one_current_share_what_holds_it() -> None:
    """What each of them takes is not told by the graph; what both take together is, u."""
    nodes = [bg.Se("s", "u"), bg.One("j", flow="i"), bg.Diode("a"), bg.Diode("b"), bg.I("L", "L")]
    equations = bg.derive(bond_graph(nodes, "s>j>a j>b j>L"))
    both = {"a": "off", "b": "off"}
    model = bg.linearize(equations, mode=both, outputs=["i"])
    assert (model.states, model.D) == ((), sp.Matrix([[0]]))
    with pytest.raises(
        bg.SignalError, match="shows what one of 'a', 'b' gives, which hold together"
    ):
        bg.linearize(equations, mode=both, outputs=["e_a"])
    one = bg.linearize(equations, mode={"a": "off", "b": "on"}, outputs=["e_a"])
    assert differences(one.D, [[1]]) == {}


def test_what_holds_a_switch_is_told_by_holding_efforts() -> None:
    """e_d = u - v while i = 0, from L i' = u - e_d - v."""
    held = bg.holding_efforts(_rectifier(), ["d"])
    assert dict(held) == {sp.Symbol("e_d"): sp.Symbol("u") - sp.Symbol("v")}


@pytest.mark.parametrize("seed", seeds("linear-modes"))
def test_a_linear_model_in_a_mode_is_that_of_the_mode_alone(seed: int) -> None:
    graph, rng = random_switched(seed), random.Random(seed)
    try:
        whole = bg.derive(graph)
    except REFUSALS:
        return
    names = [one.name for one in whole.switches]
    zero = {name for one in whole.switches for name in (one.port.given, one.port.received)}
    for on in itertools.product([True, False], repeat=len(names)):
        mode = dict(zip(names, on, strict=True))
        try:
            own = bg.derive(bg.in_mode(graph, [name for name in names if mode[name]]))
        except REFUSALS:
            continue
        s = sp.Rational(rng.randint(1, 40), 7)
        if determinant(s * own.A - own.J) == 0:
            continue
        words = {name: "on" if value else "off" for name, value in mode.items()}
        shown = sorted(map(str, whole.signals.keys() - set(whole.inputs)))
        model = bg.linearize(whole, mode=words, outputs=shown)
        x = solved(s * sp.Matrix(model.A) - model.J, sp.Matrix(model.B) + s * model.E)
        found = model.F * x + model.D + s * model.G
        expected = of_the_mode(own, s, zero)
        assert set(model.inputs) == set(whole.inputs) - zero
        for i, name in enumerate(model.outputs):
            assert dict(zip(model.inputs, found[i, :], strict=True)) == expected[name], (
                words,
                name,
            )


def _bounded() -> bg.StateEquations:
    """``T x' = r - x`` between bounds; at one x stays, so that it has no slope."""
    return bg.derive(
        bg.graph([bg.State("x", "(r - x)/T", low="lowest", high=5), bg.Function("y", "x")])
    )


def test_a_point_off_the_bounds_of_a_state_tells_that_it_is_free() -> None:
    """At x = 3 between 1 and 5 the pole is -1/T; a bound of which nothing is known has to be told."""
    at = {"x": 3, "lowest": 1}
    free = bg.linearize(_bounded(), at, inputs=["r"], outputs=["y"])
    assert [sp.simplify(pole) for pole in free.numeric({"T": 2}).poles()] == [-0.5]
    told = bg.linearize(_bounded(), {"x": 3}, inputs=["r"], mode={"x.low": "apart"})
    assert told.numeric({"T": 2}).poles() == [-0.5]
    with pytest.raises(bg.StructureError, match=r"'x.low' is apart \(on\) or touching \(off\)"):
        bg.linearize(_bounded(), {"x": 3}, inputs=["r"])


@pytest.mark.parametrize(("place", "name"), [(1, "x.low"), (5, "x.high")])
def test_at_a_bound_the_mode_is_told_and_off_it_not_against_the_point(
    place: int, name: str
) -> None:
    at = {"x": place, "lowest": 1}
    with pytest.raises(bg.StructureError, match=f"{name}' is apart"):
        bg.linearize(_bounded(), at, inputs=["r"])
    assert bg.linearize(_bounded(), at, inputs=["r"], mode={name: "touch"}).numeric({}).poles() == [
        0
    ]
    with pytest.raises(bg.StructureError, match=f"'{name}' touches its bound"):
        bg.linearize(_bounded(), at | {"x": 3}, inputs=["r"], mode={name: "off"})

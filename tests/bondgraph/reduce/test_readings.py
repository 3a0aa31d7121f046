"""Equal names mean equal quantities; no law has to be differentiated."""

import pytest
import sympy as sp
from references.build import Graph, bond_graph
from references.matrices import differences

import bondgraph as bg


def _two_masses(**names: str) -> Graph:
    """Mass m at junction j and mass n at junction k, a damper b between them at z."""
    nodes = [
        bg.Se("s", "u"), bg.One("j", flow=names.get("j")), bg.I("m", "m", flow="v"), bg.Zero("z"),
        bg.R("b", "b", flow=names.get("b")), bg.One("k", flow=names.get("k")),
        bg.I("n", "n", flow=names.get("n", "w")),
    ]  # fmt: skip
    return bond_graph(nodes, "s>j>m j>z>b z>k>n")


def test_equal_names_of_equal_quantities_are_accepted() -> None:
    equations = bg.derive(_two_masses(j="v", k="w"), outputs=["j", "k"])
    assert equations.outputs == equations.states == sp.symbols("v w")
    assert differences(equations.F, [[1, 0], [0, 1]]) == {}


def test_equal_names_of_equal_dependent_quantities_are_accepted() -> None:
    """Two masses on one shaft: one is dependent, and their speeds are one."""
    nodes = [bg.Se("s", "u"), bg.One("j"), bg.I("m", "m", flow="v"), bg.I("n", "n", flow="v")]
    equations = bg.derive(bond_graph(nodes, "s>j j>m j>n"), outputs=["n"])
    assert equations.states == equations.outputs == sp.symbols("v,")


@pytest.mark.parametrize("names", [{"j": "w"}, {"k": "v"}, {"j": "u"}])
def test_equal_names_of_different_shown_quantities_are_refused(names: dict[str, str]) -> None:
    (output, name), = names.items()  # fmt: skip
    with pytest.raises(bg.StructureError, match=f"different quantities are called {name}"):
        bg.derive(_two_masses(**names), outputs=[output])


@pytest.mark.parametrize("names", [{"j": "w"}, {"b": "v"}, {"k": "v"}])
def test_equal_names_of_different_quantities_are_refused_without_being_shown(
    names: dict[str, str],
) -> None:
    with pytest.raises(bg.StructureError, match="different quantities"):
        bg.derive(_two_masses(**names))


def test_two_states_of_one_name_are_refused() -> None:
    with pytest.raises(bg.StructureError, match="two different quantities are called v"):
        bg.derive(_two_masses(n="v"))


def test_state_with_the_name_of_an_input_is_refused() -> None:
    nodes = [bg.Se("s", "v"), bg.One("j"), bg.I("m", "m", flow="v")]
    with pytest.raises(bg.StructureError, match="two different quantities are called v"):
        bg.derive(bond_graph(nodes, "s>j>m"))


def test_two_ports_that_receive_one_name_must_receive_one_quantity() -> None:
    nodes = [bg.One("j"), bg.I("m", "m"), bg.R("p", flow="y"), bg.R("q", flow="y")]
    assert bg.derive(bond_graph(nodes, "j>m j>p j>q")).outputs == sp.symbols("y y")
    nodes = [bg.TF("g", "n"), *nodes]
    with pytest.raises(bg.StructureError, match="different quantities are called y"):
        bg.derive(bond_graph(nodes, "j>m j>p j>g>q"))


def _clutch_on_a_spring(law: object, gives: str = "effort") -> Graph:
    """A port between a driven shaft and a spring without an inertia between."""
    nodes = [bg.Zero("z"), bg.C("k", "1/k"), bg.R("p", law=law, gives=gives), bg.Sf("w", "w")]
    return bond_graph(nodes, "w>z>k z>p")


@pytest.mark.parametrize("law", ["c*f_p - f_p**3", "c*f_p**2"])
def test_law_that_drives_a_dependent_storage_is_refused(law: object) -> None:
    with pytest.raises(bg.DependentSourceError, match=r"law at 'p'.*gives='flow'"):
        bg.derive(_clutch_on_a_spring(law))


def test_dry_friction_gives_its_flow_there_and_has_no_curve_then() -> None:
    equations = bg.derive(_clutch_on_a_spring(bg.DryFriction("mu")))
    assert equations.states == sp.symbols("e_k,")
    assert set(equations.inputs) == set(sp.symbols("w f_p"))
    with pytest.raises(bg.StructureError, match=r"law at 'p': .* needs an inertia between"):
        bg.derive(_clutch_on_a_spring(bg.DryFriction("mu", "1 + exp(-slip)")))


@pytest.mark.parametrize(
    ("law", "gives", "flow"),
    [("e_p/c", "flow", "e_p/c"), ("c*f_p", "effort", "e_p/c"), ("c*w*f_p", "effort", "e_p/(c*w)")],
)
def test_law_that_gives_the_flow_instead_is_accepted(law: str, gives: str, flow: str) -> None:
    """By itself, or turned round."""
    equations = bg.derive(_clutch_on_a_spring(law, gives))
    assert equations.states == sp.symbols("e_k,")
    assert equations.laws["p"].expression == sp.sympify(flow)
    assert differences(equations.B, [[-1, 1]]) == {}


def test_known_source_may_drive_a_dependent_storage() -> None:
    equations = bg.derive(_clutch_on_a_spring("a*sin(t)"), outputs=["p"])
    assert differences(equations.G, [[-1 / sp.Symbol("k"), 0]]) == {}


def _law_over_a_spring(law: str) -> Graph:
    """The law's port imposes the effort of a spring, which is dependent, and drives a mass."""
    nodes = [
        bg.Sf("s", "u"), bg.Zero("z"), bg.C("k", "1/k"), bg.R("p", law=law),
        bg.One("j", flow="v_j"), bg.I("m", "m", flow="v"), bg.R("d", "d", flow="v_d"),
    ]  # fmt: skip
    return bond_graph(nodes, "s>z z>k p>z z>j j>m j>d")


@pytest.mark.parametrize("name", ["v", "v_j", "v_d"])
def test_law_of_any_signal_of_the_graph_that_drives_a_dependent_storage_is_refused(
    name: str,
) -> None:
    """State, junction and damper have one speed under three names."""
    with pytest.raises(bg.DependentSourceError, match="law at 'p'"):
        bg.derive(_law_over_a_spring(f"c*{name}"))


@pytest.mark.parametrize("name", ["v_j", "v_d"])
def test_any_signal_of_the_graph_can_be_made_a_reading(name: str) -> None:
    """So that a law may read it: junction and damper have the speed of the mass."""
    nodes = [
        bg.Se("s", "u"), bg.One("j", flow="v_j"), bg.I("m", "m", flow="v"),
        bg.R("d", "d", flow="v_d"), bg.R("p", law=f"c*{name}**2"),
    ]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "s>j j>m j>d j>p"))
    symbol = sp.Symbol(name)
    assert symbol not in equations.readings
    reading = equations.with_readings([symbol]).readings[symbol]
    assert (dict(reading.F), dict(reading.D), dict(reading.H)) == ({0: 1}, {}, {})
    assert equations.with_readings([sp.Symbol("unknown")]) == equations


def _followed() -> Graph:
    """A capacitor behind a resistor, and its voltage again before another two (an ideal follower)."""
    nodes = [bg.Se("V", "u"), bg.One("a"), bg.R("R1", 2), bg.C("C1", 0.5, effort="v1"),
             bg.Se("op", "1*v1"), bg.One("b"), bg.R("R2", 3), bg.C("C2", "1/5", effort="v2")]  # fmt: skip
    return bond_graph(nodes, "V>a>R1 a>C1 op>b>R2 b>C2")


def test_a_source_may_repeat_a_signal() -> None:
    s = sp.Symbol("s")
    for graph in (_followed(), bg.from_json(bg.to_json(_followed()))):
        model = bg.linearize(bg.derive(graph), outputs=["v2"])
        assert sp.simplify(model.transfer_function()[0] - 1 / ((s + 1) * (3 * s / 5 + 1))) == 0
    parts = bg.derive(bg.prefixed(_followed(), "x"))
    assert parts.laws["xop"].free_symbols == {sp.Symbol("xv1")}
    with pytest.raises(bg.StructureError, match=r"a source that repeats it has the value '1\*v'"):
        bg.derive(bond_graph([bg.Se("s", "v"), bg.One("j"), bg.I("m", "m", flow="v")], "s>j>m"))

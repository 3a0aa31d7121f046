"""What stands where at an instant, by hand."""

from references.build import bond_graph

import bondgraph as bg
from codegen import lower
from codegen.program.layout import NAMES, RECORDED, places, recorded, widths


def test_the_parts_of_an_instant_by_hand() -> None:
    """A mass on a nonlinear spring with a brake and a push: one state, one of a law, four inputs."""
    nodes = [
        bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.R("brake", flow="slip"),
        bg.C("spring", effort="F", law="k*q_spring**3"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "push>n>m n>brake n>spring")
    program = lower(bg.derive(graph), {"brake": bg.DryFriction("L")}, ["m", "k"])
    assert [name.name for name in (*program.states, *program.law_states)] == ["v", "q_spring"]
    assert [name.name for name in program.inputs] == ["P", "e_brake", "F"]
    assert [name.name for name in program.external] == ["P", "L"]
    readings = len(program.readings)
    assert widths(program) == (1, 1, 3, 3, readings, 2, 1, 2)
    assert recorded(program) == (1, 1, 3, 3, readings, 2, 2)
    assert [NAMES[part] for part in RECORDED] == ["x", "z", "u", "du", "y", "rate", "external"]
    found = places(program)
    assert {name: found[name] for name in ("v", "q_spring", "P", "e_brake", "F", "L")} == {
        "v": 0, "q_spring": 1, "P": 2, "e_brake": 3, "F": 4, "L": -2,
    }  # fmt: skip
    assert found["slip"] == 8 + [name.name for name in program.readings].index("slip")


def test_a_model_without_states_has_one_rate() -> None:
    """For integrators, which need something."""
    graph = bond_graph([bg.Se("push", "P"), bg.R("air", "b")], "push>air")
    program = lower(bg.derive(graph, outputs=["air"]), {}, ["b"])
    assert widths(program)[5] == 1
    assert widths(program)[:2] == (0, 0)

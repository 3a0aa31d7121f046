"""State machines as they are declared: what is refused, named, printed, renamed and doubted."""

import re
from typing import Any

import pytest

import bondgraph as bg


def _graph(**told: Any) -> bg.BondGraph:
    given: dict[str, Any] = {
        "modes": ["a", "b"], "transitions": {"a > b": "x - 1", "b > a": "1/2 - x"}, **told
    }  # fmt: skip
    return bg.graph([bg.State("x", "m_a - m_b"), bg.StateMachine("m", **given)])


@pytest.mark.parametrize(
    ("told", "message"),
    [
        ({"modes": "ab"}, "modes is 'ab'; give a list of names"),
        ({"modes": []}, "has no modes"),
        ({"modes": ["a", "b", "a"]}, "the mode 'a' is there twice"),
        ({"modes": ["a", "b c"]}, "'b c' cannot be a mode"),
        ({"start": "c"}, "start: there is no mode 'c'; there are a, b"),
        ({"transitions": {}}, "transitions is {}; it must map"),
        ({"transitions": None}, "transitions is None; it must map"),
        ({"transitions": {"a": "x"}}, "'a' is no transition; name the mode that it leaves"),
        ({"transitions": {"a > b > a": "x"}}, "'a > b > a' is no transition"),
        ({"transitions": {"a > lunch": "x"}}, "there is no mode 'lunch'"),
        ({"transitions": {"a > a": "x"}}, "'a > a' stays in its mode and sets nothing"),
        ({"transitions": {"a > b": "x", "a>b": "x"}}, "'a > b' is there twice"),
        ({"transitions": {"a > b": ("x", {"m": 1})}}, "sets m, the mode"),
        ({"transitions": {"a > b": ("x", {"y": 1})}}, "reset of y, which is no state"),
        ({"transitions": {"a > b": ("x", 1)}}, "reset is 1; it must map names of states"),
        ({"transitions": {"a > b": ("x", {}, 1)}}, "it must be a guard, or a guard and what"),
        ({"reset": {"b > b": {"x": 1}}}, "reset has 'b > b', which is no transition"),
        ({"states": {"n": 0}}, "the state n is never set"),
        ({"states": {"m": 0}}, "m is its mode"),
        ({"states": {"n": "t"}}, "the start of n reads the time"),
        ({"states": [1]}, "states must map names to where they begin"),
    ],
)
def test_what_is_no_machine_is_refused(told: dict[str, Any], message: str) -> None:
    with pytest.raises(bg.BondGraphError, match=re.escape(message)):
        bg.derive(_graph(**told))


def test_a_machine_has_the_name_of_its_mode() -> None:
    with pytest.raises(bg.StructureError, match="has the name of the signal that is its mode"):
        bg.validate(
            bg.graph([bg.StateMachine(3, ["a"], {"a > a": ("t", {"n": 1})}, states={"n": 0})])
        )


def test_a_mode_s_signal_is_nobody_else_s() -> None:
    graph = _graph()
    graph.add_nodes_from([bg.Function("m_a", "x")])
    with pytest.raises(bg.StructureError, match="two nodes are called 'm_a'"):
        bg.derive(graph)


def test_it_begins_where_it_is_told() -> None:
    starts = bg.derive(_graph(start="b")).starts
    assert {str(name): value for name, value in starts.items()} == {"m": 1}


def test_its_modes_and_ways_are_printed_without_what_it_is_made_of() -> None:
    graph = _graph(
        states={"n": 0}, transitions={"a > b": ("x - 1", {"n": "n + 1"}), "b > a": "1/2 - x"}
    )
    text = " ".join(str(bg.derive(graph)).split())
    assert (
        "m: a state machine, a = 0, b = 1; begins in a; a > b as x - 1 rises above zero, and n becomes "
        "n + 1; b > a as 1/2 - x rises above zero"
    ) in text
    assert "e_m_a_b" not in text
    assert "ideal switch" not in text
    assert r"\text{a} \to \text{b} \quad \text{as } x - 1 > 0,\ n := n + 1" in bg.latex(
        bg.derive(graph)
    )
    assert "m: a state machine" in str(bg.explain(graph))


def test_it_is_no_switch_for_those_who_ask_for_switches() -> None:
    graph = _graph()
    assert bg.switches(graph) == ()
    assert bg.derive(bg.in_mode(graph)).machines == bg.derive(graph).machines
    with pytest.raises(bg.StructureError, match="is no switch of this graph"):
        bg.in_mode(graph, on=["m.a > b"])


def test_a_part_is_copied_with_its_machine() -> None:
    part = _graph(
        states={"n": 0}, transitions={"a > b": ("x - k", {"n": "n + 1"}), "b > a": "1/2 - x"}
    )
    both = bg.assemble(
        bg.prefixed(part, "left_"),
        bg.prefixed(part, "right_"),
        bg.graph([bg.Function("y", "left_n*right_m_b")]),
    )
    equations = bg.derive(both)
    assert [str(name) for name in equations.further_states] == [
        "left_x", "left_m", "left_n", "right_x", "right_m", "right_n"
    ]  # fmt: skip
    machine = both.nodes["right_m"]
    assert machine["reset"] == {"a > b": {"right_n": bg.expression("right_n + 1", "")}}
    assert machine["transitions"]["a > b"] == bg.expression("right_x - k", "")


def test_a_mode_that_nothing_leads_to_is_doubted() -> None:
    (found,) = bg.check(_graph(modes=["a", "b", "lost"]))
    assert (found.rule, found.node) == ("mode", "m")
    assert "no transition leads from 'a' to the mode 'lost'" in found.text
    assert len(bg.check(_graph())) == 0

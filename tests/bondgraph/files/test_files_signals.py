"""Functions, states and sampled controllers in files: what is read has the same equations and instants."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest
import sympy as sp
from oracles.routes.kinds import SIGNALS

import bondgraph as bg

FORMS = {
    "json": (bg.to_json, bg.from_json),
    "graphml": (bg.to_graphml, bg.from_graphml),
}
Form = tuple[Callable[[Any], str], Callable[[str], Any]]


@pytest.fixture(params=FORMS)
def form(request: pytest.FixtureRequest) -> Form:
    return FORMS[request.param]


@pytest.mark.parametrize("name", [make.__name__ for make in SIGNALS])
def test_signals_come_back_byte_for_byte(name: str, form: Form) -> None:
    to_text, from_text = form
    graph = {make.__name__: make for make in SIGNALS}[name]().graph
    text = to_text(graph)
    back = from_text(text)
    assert to_text(back) == text
    one, other = bg.derive(back), bg.derive(graph)
    for what in (
        "A",
        "J",
        "B",
        "E",
        "states",
        "further_states",
        "inputs",
        "laws",
        "starts",
        "tasks",
    ):
        assert getattr(one, what) == getattr(other, what), what


@pytest.mark.parametrize(
    ("every", "offset", "instant"),
    [
        (1, 0, (1, 0, 1)),
        ("1/10", "1/25", (5, 2, 50)),
        (0.05, 0.02, (5, 2, 100)),
        (Fraction(1, 3), Fraction(1, 9), (3, 1, 9)),
        (sp.Rational(1, 7), 0, (1, 0, 7)),
    ],
)
def test_instants_are_the_same_whatever_a_period_was_told_as(
    every: object, offset: object, instant: tuple[int, int, int], form: Form
) -> None:
    to_text, from_text = form
    x = sp.Symbol("x")
    graph = bg.graph(
        [
            bg.Controller(
                "c", every=every, offset=offset, reads=[x], gives={sp.Symbol("u"): x + 1}
            ),
            bg.Function("x", "2*t"),
        ]
    )
    back = from_text(to_text(graph))
    assert to_text(back) == to_text(graph)
    (task,) = bg.derive(back).tasks
    assert (task.every, task.offset, task.unit) == instant
    assert task.resets[0].value == x + 1


def test_the_order_of_states_and_of_what_is_given_comes_back(form: Form) -> None:
    to_text, from_text = form
    graph = bg.graph(
        [
            bg.Controller(
                "c", every=1, states={"z": 2, "a": "a_0"}, update={"a": "a + z", "z": "z/2"},
                gives={"v": "a", "b": "z"},
            )
        ]
    )  # fmt: skip
    back = from_text(to_text(graph))
    found = bg.derive(back)
    assert [str(one) for one in found.further_states] == ["z", "a", "v", "b"]
    assert [str(one) for one in found.tasks[0].states] == ["z", "a", "v", "b"]
    assert back.nodes["c"]["states"] == {"z": 2, "a": "a_0"}


def test_texts_of_signals_call_tables(form: Form) -> None:
    to_text, from_text = form
    table = bg.LookupTable("map", [0, 1], [2, 4])
    graph = bg.graph(
        [
            bg.Controller(
                "c", every=1, states={"z": "map(1)"}, update={"z": "map(x)"}, gives={"u": "map(z)"}
            ),
            bg.Function("x", "map(s)"), bg.State("s", "map(u)", high="map(0) + 6"),
        ],
        tables=[table],
    )  # fmt: skip
    back = from_text(to_text(graph))
    assert to_text(back) == to_text(graph)
    assert bg.derive(back).tasks == bg.derive(graph).tasks
    call = bg.derive(graph).tasks[0].resets[0].value
    assert float(call.subs("x", 0.25)) == 2.5


@pytest.mark.parametrize(
    ("attributes", "message"),
    [
        ('"every": [1]', "node 'c', every: a list must be of type str, int, float"),
        ('"every": 1, "outputs": ["u"]', "node 'c', outputs: a list must be of type dict"),
        ('"every": 1, "outputs": {"u": ["x"]}', "outputs of u: a list must be of type str, int, float"),
        ('"every": 1, "states": {"z": null}', "states of z: a NoneType must be of type str"),
        ('"every": 1, "reads": "x"', "node 'c', reads: 'x' must be of type list"),
        ('"every": 1, "reads": [1]', "node 'c', reads: 1 must be of type str"),
        ('"every": "soon", "outputs": {"u": 1}', "every: soon is not a number of seconds"),
    ],
)  # fmt: skip
def test_other_attributes_are_refused(attributes: str, message: str) -> None:
    text = bg.to_json(bg.graph([bg.Controller("c", every=1, gives={"u": 1})]))
    own = '"every": 1, "outputs": {"u": 1}'
    assert own in text
    with pytest.raises(bg.BondGraphError) as caught:
        bg.from_json(text.replace(own, attributes))
    assert message in str(caught.value)


def test_what_text_cannot_say_is_refused() -> None:
    x = sp.Symbol("x", positive=True)
    graph = bg.graph([bg.Controller("c", every=1, gives={"u": x})])
    with pytest.raises(bg.FileFormatError, match="outputs of u: the symbol x has assumptions"):
        bg.to_json(graph)

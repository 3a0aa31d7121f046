"""The table of kinds against the field's own definitions."""

import inspect

import pytest

import bondgraph as bg
from bondgraph.nodes import (
    controllers,
    delays,
    elements,
    hysteresis,
    machines,
    rate_limiter,
    signals,
    stops,
)
from bondgraph.nodes.kinds import Kind

ROLES = {
    "supplies": "Se Sf", "stores": "I C", "resists": "R", "two_port": "TF GY", "gyrates": "GY",
    "joins": "Zero One", "detects": "De Df", "switches": "Stop Sw",
    "signals": "Function State Controller Hysteresis RateLimiter Delay StateMachine",
    "one_port": "Se Sf I C R De Df Stop Sw", "absorbs": "I C R De Df Stop Sw",
}  # fmt: skip

GIVES = {"Se": "effort", "Sf": "flow", "I": "flow", "C": "effort", "De": "flow", "Df": "effort"}
"""A source its own variable, a storage the one that its state tells, a detector none of what it reads."""


@pytest.mark.parametrize("role", ROLES)
def test_each_kind_is_what_the_field_calls_it(role: str) -> None:
    assert [kind for kind in Kind if getattr(kind, role)] == [
        kind for kind in Kind if kind in ROLES[role].split()
    ]


def test_each_kind_gives_what_it_can() -> None:
    assert {str(kind): kind.gives for kind in Kind if kind.gives} == GIVES
    assert {str(kind): kind.common for kind in Kind if kind.common} == {
        "Zero": "effort",
        "One": "flow",
    }
    assert {str(kind): kind.letter for kind in Kind if kind.letter} == {"I": "p", "C": "q"}


def test_each_kind_has_a_name_for_people() -> None:
    assert {str(kind): kind.symbol for kind in Kind if kind.symbol != kind} == {
        "Zero": "0",
        "One": "1",
    }
    assert {str(kind): kind.word for kind in Kind if kind.word != kind} == {
        "Zero": "0-junction", "One": "1-junction",
    }  # fmt: skip


def test_no_two_one_ports_have_one_place_beside_their_junction() -> None:
    places = [kind.nature.place for kind in Kind if kind.one_port]
    assert sorted(places) == list(range(len(places)))


HOMES = {
    "Stop": stops, "Function": signals, "State": signals, "Controller": controllers,
    "Hysteresis": hysteresis, "RateLimiter": rate_limiter, "Delay": delays, "StateMachine": machines,
}  # fmt: skip
"""Where constructors are that are not with the elements."""

CALLED = {"m": "value", "r": "value", "start": "initially", "input": "value", "gives": "outputs"}
"""Attributes by names that constructors have for them; a controller gives what an attribute lists."""


@pytest.mark.parametrize("kind", list(Kind))
def test_each_kind_has_a_constructor_of_its_own_attributes(kind: Kind) -> None:
    """What it takes by name is what a node of the kind may carry; its value may have another name."""
    make = getattr(HOMES.get(str(kind), elements), str(kind))
    assert make is getattr(bg, str(kind))
    taken = set(inspect.signature(make).parameters) - {"name", "more"}
    own = {name if name in kind.nature.keys else CALLED[name] for name in taken}
    assert own <= kind.nature.keys


def test_a_kind_is_made_by_a_row_of_the_table_alone() -> None:
    with pytest.raises(ValueError, match="'Memristor' is not a valid Kind"):
        Kind("Memristor")
    assert Kind("I") is Kind.I
    assert Kind.I == "I"

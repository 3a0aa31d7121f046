"""A run as a short text."""

from dataclasses import replace

import numpy as np
from oracles.slides import slide, swing

from codegen import Event


def test_it_says_where_states_begin_and_end_and_what_happened() -> None:
    run = slide()
    lines = str(run).splitlines()
    assert lines[0] == "41 samples from 0 to 4 s, 1 event"
    assert lines[1].split() == ["first", "last", "least", "most"]
    assert lines[2].split() == ["v", "[m/s]", "3", "0", "0", "3"]
    assert lines[3:] == ["  2 s  rub: stick"]
    assert run.summary() == str(run)


def test_columns_are_aligned_to_the_right() -> None:
    run = slide()
    wide = replace(run, columns={**run.columns, "v": np.linspace(-1.5, 1234.5, 41)})
    heads, numbers = str(wide).splitlines()[1:3]
    for head, number in (("first", "-1.5"), ("last", "1234.5"), ("most", "1234.5")):
        assert numbers[: heads.index(head) + len(head)].endswith(number), head


def test_of_much_only_the_beginning_is_shown() -> None:
    run = swing()
    events = tuple(Event(0.01 * k, "p", "cross") for k in range(25))
    names = tuple(f"x_{k}" for k in range(23))
    many = replace(run, events=events, states=names, columns=dict.fromkeys(names, run.time))
    lines = str(many).splitlines()
    assert lines[0].endswith("25 events")
    assert "  and 3 more states" in lines
    assert lines[-1] == "  and 5 more events"
    assert len(lines) == 1 + 1 + 20 + 1 + 20 + 1

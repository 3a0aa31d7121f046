"""What structure says an input rules at once, against what changes when it is given another value."""

import warnings

import pytest
from oracles.routes.kind import Kind
from oracles.routes.kinds import KINDS

import bondgraph as bg
from codegen import simulator
from codegen.cosimulation.feeds import Feeds

WITH_INPUTS = [make for make in KINDS.values() if make().inputs]


@pytest.mark.parametrize("make", WITH_INPUTS, ids=lambda make: make.__name__)
def test_nothing_else_changes_at_once(make: object) -> None:
    kind: Kind = make()
    ready = simulator(kind.equations, kind.numbers, kind.laws)
    feeds = Feeds(ready.closed, ready.closed.equations.tasks)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        one = ready.stepper(kind.initial, kind.signals, initially_on=kind.on)
    one.advance(0.4 * kind.end)
    kept, before = one.state, dict(one.signals)
    for name in ready.inputs:
        try:
            now = one.give(**{name: before[name] * 1.001 + 1e-3})
        except bg.BondGraphError as refused:
            if "impulse" in str(refused):
                continue
            raise
        if not one.events[len(kept.events) :]:
            changed = {key for key in before if abs(now[key] - before[key]) > 1e-9 * abs(now[key])}
            beyond = {key for key in changed if name not in feeds.of(key)}
            assert beyond == set()
        one.restore(kept)


def test_some_signals_are_told_by_no_input() -> None:
    """The look itself: where everything fed everything it would prove nothing."""
    found = 0
    for make in WITH_INPUTS:
        kind = make()
        ready = simulator(kind.equations, kind.numbers, kind.laws)
        feeds = Feeds(ready.closed, ())
        found += any(not feeds.of(name) for name in ready.states)
    assert found > len(WITH_INPUTS) / 2

"""Records of modes in which the same ports stick: copies but for what friction's way of slipping moves."""

import numpy as np
import pytest
from oracles.many import chain
from oracles.models import block

import bondgraph as bg
from codegen import Simulator, simulator
from codegen.engine.filling import ALL, Filling
from codegen.engine.modes import Tables
from codegen.model.snapshot import Mode

FIELDS = ("shot", "left", "take_away", "mix", "ruling", "stay", "jump", "shock", "weight")


def _tables(ready: Simulator) -> Tables:
    assert ready.engine is not None
    start, signals = np.zeros(len(ready.states)), ready.sources(0.0, 1.0)
    return ready.engine.prepare(np.array([0.0, 1.0]), start, signals).tables


def _record(tables: Tables, mode: Mode) -> dict[str, np.ndarray]:
    tables.supply(mode)
    made = tables.places.record_of(mode)
    numbers = {
        name: np.frombuffer(tables.engine.ffi.buffer(getattr(made, name))).copy() for name in FIELDS
    }
    return {**numbers, "counts": np.array([made.held, made.ruled, made.fastest, made.supported])}


def _chain() -> Simulator:
    return simulator(bg.derive(chain(6).graph), {}, backend="c")


def test_a_record_from_kin_has_the_digits_of_one_worked_out_by_itself(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    whole = []
    shot = Filling.shot

    def counted(self: Filling, made: object, affine: object, columns: object = ALL) -> None:
        whole.append(columns is ALL)
        shot(self, made, affine, columns)

    one, other = (1, 0, 1, -1, 0, 1), (-1, 0, 1, 1, 0, -1)
    expected = _record(_tables(_chain()), other)
    tables = _tables(_chain())
    before = _record(tables, one)
    monkeypatch.setattr(Filling, "shot", counted)
    found = _record(tables, other)
    assert whole == [False]
    assert any((before[name] != found[name]).any() for name in found)
    for name, numbers in expected.items():
        assert np.array_equal(found[name], numbers), name


@pytest.mark.parametrize("level", ["1 + v/9", "2 + P/9"])
def test_levels_that_states_rule_are_worked_out_each_by_itself(level: str) -> None:
    """Such a level moves the rates of states with the way of slipping; one of an input does not."""
    graph = bg.derive(block(bg.DryFriction(level)))
    ready = simulator(graph, {"m": 1.0}, backend="c")
    expected = {mode: _record(_tables(ready), mode) for mode in ((1,), (-1,))}
    tables = _tables(ready)
    for mode, record in expected.items():
        found = _record(tables, mode)
        for name, numbers in record.items():
            assert np.array_equal(found[name], numbers), (name, mode)
    assert ("P" in level) == bool(tables._kin.are_alike)

"""What the C engine is told of modes: their rates where a run asks for them, of those that have any."""

import numpy as np
import pytest
from oracles.models import block

import bondgraph as bg
from bondgraph.errors import SimulationError
from codegen import simulator
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel


def test_rates_are_told_of_modes_that_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    """A mode in which nothing can hold has none, and is no reason to end the run that asks."""
    ready = simulator(bg.derive(block()), {"m": 1.0}, backend="c")
    whole = ClosedModel.affine_map

    def refused(self: ClosedModel, mode: Mode, inputs: int) -> object:
        if mode == (0,):
            raise SimulationError("nothing holds")
        return whole(self, mode, inputs)

    monkeypatch.setattr(ClosedModel, "affine_map", refused)
    assert ready.engine is not None
    signals = ready.sources(0.0, 1.0)
    tables = ready.engine.prepare(np.array([0.0, 1.0]), np.zeros(1), signals).tables
    tables.supply((1,))
    tables.supply((0,))
    assert [made.rates for _, made in tables.places.made()] == [-1, 0]
    tables.sharpen()
    slips, none = (made for _, made in tables.places.made())
    assert (slips.rates, none.rates, none.none) == (1, 0, 1)

"""Friction modes on trial: a mode in which the laws have no solution is none, and another is looked at."""

from collections.abc import Iterator, Sequence
from itertools import product

from bondgraph.errors import SimulationError
from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.ports.friction import SlopeNeededError


def evaluated(
    model: ClosedModel,
    t: float,
    s: Array,
    pieces: Sequence[Piece],
    mode: Mode,
    slipping: bool = True,
) -> tuple[Mode, Snapshot]:
    """The model with friction slipping as in ``mode``, ports that stick forwards; if need be, otherwise.

    ``slipping``: unless it is set, the mode itself comes first.
    A level that grows with what the port gives (a self-locking gear) may have no solution one way.
    Raises the `SimulationError` of the first try if no mode can be evaluated.
    """
    refused: SimulationError | None = None
    for tried in _tries(mode) if slipping else (mode, *_tries(mode)):
        try:
            return tried, model.at(t, s, pieces, tried)
        except SlopeNeededError:
            raise
        except SimulationError as error:
            refused = refused or error
    raise refused or SimulationError("there is no mode")


def _tries(mode: Mode) -> Iterator[Mode]:
    """Slipping as the mode says, backwards where it is silent, the mode, any way of slipping, all stuck."""
    yield tuple(sign or 1 for sign in mode)
    yield tuple(sign or -1 for sign in mode)
    yield mode
    yield from product((1, -1), repeat=len(mode))
    yield (0,) * len(mode)

"""Friction modes on trial: a mode in which the laws have no solution is none, and another is looked at."""

from collections.abc import Sequence
from itertools import chain

from bondgraph.errors import SimulationError
from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.ports.refusals import SlopeNeededError
from codegen.standalone.friction import ways


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
    for tried in ways(mode) if slipping else chain((mode,), ways(mode)):
        try:
            return tried, model.at(t, s, pieces, tried)
        except SlopeNeededError:
            raise
        except SimulationError as error:
            refused = refused or error
    raise refused or SimulationError("there is no mode")

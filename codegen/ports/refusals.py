"""What a model in numbers raises, as the toolkit's own errors."""

from collections.abc import Iterator
from contextlib import contextmanager

from bondgraph.errors import SimulationError
from codegen.standalone.arrays import EvaluationError, HoldError


class SlopeNeededError(SimulationError):
    """Ports could hold, but what holds them needs the slope in time of what a law gives."""


@contextmanager
def refusals() -> Iterator[None]:
    """Inside, what has no values is a `SimulationError`."""
    try:
        yield
    except HoldError as error:
        raise SlopeNeededError(str(error)) from None
    except EvaluationError as error:
        raise SimulationError(str(error)) from None

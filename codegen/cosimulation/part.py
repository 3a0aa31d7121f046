"""What takes part in a co-simulation: something with inputs and signals that goes from instant to instant."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import NamedTuple, Protocol

from bondgraph.errors import BondGraphError
from codegen.numbers.arrays import Array
from codegen.runs.track import Event


class Given(NamedTuple):
    """An input from an instant on: its value there, and its slope [1/s]."""

    value: float
    slope: float = 0.0


class Part(Protocol):
    """A participant. ``name``: in connections; ``inputs``: what it is given; ``time``: where it is [s]."""

    name: str
    inputs: tuple[str, ...]
    time: float

    def fed(self, signal: str, first: bool) -> frozenset[str]:
        """The inputs that a signal depends on at once; ``first``: at the first instant."""

    def certain(self, first: bool) -> bool:
        """Whether `fed` is told by structure, and is no more than what may be."""

    def begin(self, time: float) -> None:
        """Be at the first instant [s]; inputs are as they start."""

    def give(self, given: Mapping[str, Given]) -> bool:
        """Take these inputs from the present instant on; whether any is another than before."""

    def ready(self) -> None:
        """The first instant is over: inputs there are as they stay."""

    def read(self, signal: str) -> float:
        """A signal at the present instant."""

    def keep(self) -> None:
        """Record the present instant."""

    def advance(self, stop: float) -> None:
        """Go on to another instant [s]."""

    @property
    def columns(self) -> Mapping[str, Array]:
        """What was recorded, by signal."""

    @property
    def units(self) -> Mapping[str, str]:
        """Units of those signals of which they are known."""

    @property
    def events(self) -> tuple[Event, ...]:
        """What happened, in order."""


@contextmanager
def named(part: str) -> Iterator[None]:
    """Errors of a participant tell whose they are."""
    try:
        yield
    except BondGraphError as error:
        told = f"participant {part!r}"
        if str(error).startswith(told):
            raise
        raise type(error)(f"{told}: {error}") from error

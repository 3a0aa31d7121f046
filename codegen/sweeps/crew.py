"""`Crew`: what does the chunks of a sweep, wherever it does them."""

from typing import NamedTuple, Protocol

from codegen.sweeps.chunks import Chunk, Outcome


class Lost(NamedTuple):
    """No outcome: the process ended. ``blamed``: while it did these runs."""

    blamed: bool


class Crew(Protocol):
    """Does chunks; several at a time."""

    #: Whether processes are shared, so that a run's process may have ended by another run.
    shared: bool

    def slots(self) -> int:
        """How many chunks may be under way."""

    def start(self, chunk: Chunk) -> None:
        """Begin a chunk."""

    def finished(self) -> list[tuple[Chunk, Outcome | Lost]]:
        """Chunks that are through; waits for one."""

    def close(self, now: bool) -> None:
        """Let the processes end; ``now``: with whatever is under way."""

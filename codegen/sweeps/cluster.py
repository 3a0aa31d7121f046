"""Who does the runs of a sweep: the workers of a dask cluster."""

import uuid
from contextlib import suppress
from typing import Any

from bondgraph.errors import MissingExtraError, SignalError, SimulationError
from codegen.packing import packed
from codegen.sweeps.chunks import Chunk, Outcome
from codegen.sweeps.crew import Lost
from codegen.sweeps.measuring import measured_remotely

RETRIES = 3
"""How often a task is sent again that got lost between the machines."""


class Cluster:
    """Does chunks as tasks of a `distributed.Client`.

    A task whose worker dies is given to another by the scheduler; one that it gives up on is `Lost`.

    Raises `MissingExtraError` without distributed.
    """

    shared = True

    def __init__(self, job: bytes, client: Any) -> None:
        try:
            import distributed
        except ImportError:
            raise MissingExtraError(
                "clusters need distributed; install the optional extra: "
                "pip install bondgraph-toolkit[cluster]"
            ) from None
        if not isinstance(client, distributed.Client) or client.asynchronous:
            raise SignalError(
                f"client must be a distributed.Client that is not asynchronous, not {client!r}"
            )
        self._distributed = distributed
        self._client, self._job = client, job
        self._under_way: dict[Any, tuple[Chunk, int]] = {}

    def slots(self) -> int:
        """Two for each thread of the cluster as it is now, so that none waits for work."""
        return max(2 * int(sum(self._client.nthreads().values())), 1)

    def start(self, chunk: Chunk) -> None:
        """Send a chunk."""
        self._send(chunk, RETRIES)

    def _send(self, chunk: Chunk, retries: int) -> None:
        future = self._client.submit(
            measured_remotely,
            self._job,
            packed(chunk),
            key=f"sweep-{chunk.indices[0]}-{uuid.uuid4().hex}",
            pure=False,
        )
        self._under_way[future] = (chunk, retries)

    def finished(self) -> list[tuple[Chunk, Outcome | Lost]]:
        """Chunks that are through; waits for one."""
        # A future that got lost is done, too.
        with suppress(self._distributed.CancelledError):
            self._distributed.wait(list(self._under_way), return_when="FIRST_COMPLETED")
        found: list[tuple[Chunk, Outcome | Lost]] = []
        for future in [future for future in self._under_way if future.done()]:
            chunk, retries = self._under_way.pop(future)
            outcome = self._outcome(future)
            if outcome is not None:
                found.append((chunk, outcome))
            elif retries:
                self._send(chunk, retries - 1)
            else:
                raise SimulationError(
                    f"the cluster lost the runs {chunk.indices[0]} to {chunk.indices[-1]} again and again"
                )
        return found

    def _outcome(self, future: Any) -> Outcome | Lost | None:
        """What a future gave; None if it got lost."""
        try:
            return Outcome(*future.result())
        except self._distributed.scheduler.KilledWorker:
            return Lost(blamed=True)
        except (self._distributed.CancelledError, OSError):
            return None

    def close(self, now: bool) -> None:
        """Take back what is under way."""
        self._client.cancel(list(self._under_way))
        self._under_way.clear()

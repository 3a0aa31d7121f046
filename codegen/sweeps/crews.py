"""Who does the runs of a sweep: this process, threads of it, or processes beside it."""

import multiprocessing
import os
import pickle
import signal
from collections.abc import Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager

from bondgraph.errors import SimulationError
from codegen.sweeps.chunks import Chunk, Outcome
from codegen.sweeps.crew import Lost
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import measured

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""What tells linear algebra how many threads to use."""

STARTS = 3
"""How many processes in a row may fail to start."""


class Here:
    """Does the runs in this process."""

    shared = False

    def __init__(self, job: Job) -> None:
        self._job = job
        self._begun: list[Chunk] = []

    def slots(self) -> int:
        """One."""
        return 1

    def start(self, chunk: Chunk) -> None:
        """Take note of a chunk."""
        self._begun.append(chunk)

    def finished(self) -> list[tuple[Chunk, Outcome | Lost]]:
        """Do what was begun."""
        begun, self._begun = self._begun, []
        return [(chunk, measured(self._job, chunk)) for chunk in begun]

    def close(self, now: bool) -> None:
        """Nothing to end."""


class Threads:
    """Threads of this process, for runs that a loop in C does."""

    shared = False

    def __init__(self, job: Job, workers: int) -> None:
        self._job, self._workers = job, workers
        self._executor = ThreadPoolExecutor(workers)
        self._begun: dict[Future[Outcome], Chunk] = {}

    def slots(self) -> int:
        """One for each thread."""
        return self._workers

    def start(self, chunk: Chunk) -> None:
        """Give a chunk to a thread."""
        self._begun[self._executor.submit(measured, self._job, chunk)] = chunk

    def finished(self) -> list[tuple[Chunk, Outcome | Lost]]:
        """Chunks that are through; waits for one."""
        through = wait(self._begun, return_when=FIRST_COMPLETED).done
        return [(self._begun.pop(future), future.result()) for future in through]

    def close(self, now: bool) -> None:
        """Let the threads end."""
        self._executor.shutdown(wait=True, cancel_futures=now)


class Processes:
    """Processes of which each does one chunk at a time, so that it is known which chunk ended one."""

    shared = False

    def __init__(self, job: bytes, workers: int) -> None:
        self._lanes = [_Lane(job) for _ in range(workers)]
        self._proven = False
        self._failed_starts = 0

    def slots(self) -> int:
        """One for each process."""
        return len(self._lanes)

    def start(self, chunk: Chunk) -> None:
        """Give a chunk to a process that has none."""
        next(lane for lane in self._lanes if lane.chunk is None).start(chunk)

    def finished(self) -> list[tuple[Chunk, Outcome | Lost]]:
        """Chunks that are through; waits for one."""
        busy = [(lane, lane.future) for lane in self._lanes if lane.future is not None]
        through = wait([future for _, future in busy], return_when=FIRST_COMPLETED).done
        return [self._taken(lane, future) for lane, future in busy if future in through]

    def _taken(self, lane: "_Lane", future: Future[Outcome]) -> tuple[Chunk, Outcome | Lost]:
        chunk = lane.chunk
        assert chunk is not None
        lane.chunk = lane.future = None
        try:
            outcome: Outcome | Lost = future.result()
        except BrokenExecutor:
            outcome = Lost(blamed=lane.started)
            self._check_start(lane)
            lane.end(now=True)
        else:
            self._proven, self._failed_starts = True, 0
        return chunk, outcome

    def _check_start(self, lane: "_Lane") -> None:
        """Refuse to go on where processes do not even start."""
        self._proven = self._proven or lane.started
        self._failed_starts = 0 if lane.started else self._failed_starts + 1
        if not self._proven or self._failed_starts >= STARTS:
            raise SimulationError(
                "the processes of the sweep do not start; what they print tells why. A script that is "
                "run needs the line if __name__ == '__main__': above what it does, and measures must "
                "stand in a module that can be imported; or let workers=0 do the runs in this process"
            )

    def close(self, now: bool) -> None:
        """Let the processes end."""
        for lane in self._lanes:
            lane.end(now)


class _Lane:
    """A process, and the chunk it does."""

    def __init__(self, job: bytes) -> None:
        self._job = job
        self.chunk: Chunk | None = None
        self.future: Future[Outcome] | None = None
        self.open()

    def open(self) -> None:
        """Start a process."""
        before = multiprocessing.active_children()
        context = multiprocessing.get_context("spawn")
        self._executor = ProcessPoolExecutor(1, context, _prepare, (self._job,))
        with _one_thread():
            self._ready = self._executor.submit(os.getpid)
        self._ended = False
        self._processes = [p for p in multiprocessing.active_children() if p not in before]

    @property
    def started(self) -> bool:
        """Whether the process came as far as taking work."""
        return self._ready.done() and self._ready.exception() is None

    def start(self, chunk: Chunk) -> None:
        """Begin a chunk, in another process if this one has ended."""
        self.chunk = chunk
        if self._ended:
            self.open()
        try:
            self.future = self._executor.submit(_measured_here, chunk)
        except BrokenExecutor:
            self.end(now=True)
            self.open()
            self.future = self._executor.submit(_measured_here, chunk)

    def end(self, now: bool) -> None:
        """End the process."""
        self._ended = True
        if now:
            for process in self._processes:
                process.terminate()
        self._executor.shutdown(wait=True, cancel_futures=True)


@contextmanager
def _one_thread() -> Iterator[None]:
    """Processes started inside use one thread each for linear algebra."""
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


_jobs: list[Job] = []
"""In a process of `Processes`: its job."""


def _prepare(job: bytes) -> None:
    # Who interrupts the sweep interrupts the process that collects, which ends this one.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _jobs.append(pickle.loads(job))


def _measured_here(chunk: Chunk) -> Outcome:
    return measured(_jobs[0], chunk)

"""`sweep`: many runs of one model over its parameters, initial values and sizes of its inputs."""

import os
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from os import PathLike
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bondgraph.errors import SignalError
from codegen.batch.asked import Given
from codegen.called.function import followed
from codegen.engine.fallback import tell_all
from codegen.record.measures import Measure
from codegen.record.result import Result
from codegen.runs.arguments import checked_times
from codegen.runs.completion import tell_all_completed
from codegen.sweeps.checks import check, checked_measures, checked_switches
from codegen.sweeps.chunks import Outcome
from codegen.sweeps.cluster import Cluster
from codegen.sweeps.crew import Crew
from codegen.sweeps.crews import Here, Processes, Threads
from codegen.sweeps.design import Table, design
from codegen.sweeps.drive import BESIDE, QUICK, STEADY, Pace, Rhythm, Work, drive
from codegen.sweeps.held import by_states_of
from codegen.sweeps.job import Job, Model
from codegen.sweeps.measuring import abreast_of, batch_of, sent
from codegen.sweeps.resting import tell_all_resting
from codegen.sweeps.result import Collected, Sweep, SweepInterrupted
from codegen.sweeps.store import Store
from codegen.tuning import TUNING


def sweep(
    model: Model,
    parameters: Table | Mapping[str, ArrayLike] | Sequence[Mapping[str, float]],
    time: ArrayLike,
    measures: Mapping[str, Callable[[Result], Any]],
    initial: Given = None,
    inputs: Given = None,
    *,
    method: str = "auto",
    rtol: float = TUNING.rtol,
    atol: float = TUNING.atol,
    workers: int | None = None,
    client: Any = None,
    store: str | PathLike[str] | None = None,
    progress: bool = True,
    chunk: int | None = None,
    initially_on: Iterable[Hashable] = (),
    events: bool = True,
) -> Sweep:
    """Run a model once for each set of numbers and keep the measures of each run.

    ``model``: a `Family`. ``parameters``: a `Grid` (or a mapping of names to numbers), a `Table` (or a list
    of rows) or `Samples`. A name is a parameter, a state (its value at the start), what a storage holds at
    the start (``p_m``, ``q_C``), an input (held constant) or the size of an input, which is given as
    `Swept`. ``measures``: name to a function of the `Result` that gives a number or an array. ``time``,
    ``initial``, ``inputs``, ``method``, ``rtol``, ``atol``, ``initially_on``: as of `Simulator.run`;
    ``initial`` and ``inputs`` may be functions of a run's numbers by name, which then may have names of
    their own.

    ``workers``: processes to run in, by default one for each core; 0: in this process. A family with
    backend "c" and ready measures (all of this package) is run by threads instead, many runs in
    one call of C, where none of the model's outputs shows the rate of an input. That is fastest without
    functions of a run's numbers, which Python calls run by run. In numpy the runs of an affine model whose
    only switching is friction are done side by side, from so many on that it pays, with what single runs
    give but for rounding; a run of which anything is doubtful is done by itself, and so are runs with
    functions of their numbers for ``initial`` or ``inputs``.
    What is sent to processes must be picklable, and a script needs the line
    ``if __name__ == "__main__":``. ``client``: a `distributed.Client` to run on instead. ``chunk``: how
    many runs are done together, by default what takes some seconds, in C one at most. None of these
    changes a number.

    Events of a run are gone with it. They are kept for `first_event` and `event_count`, in C up to a fixed
    number, and for functions of your own, where a run's memory grows with its switchings: ``events=False``
    keeps none for these, as `Simulator.run` does.

    ``store``: a folder to keep finished runs in; the same call continues there. ``progress``: a bar, where
    tqdm is installed.

    Runs that backend "c" cannot do are done by numpy; one `BackendWarning` tells how many, and why. Starts
    that were completed by what switches hold are in ``completed``; one `ModelWarning` tells of them. One for
    each switch tells in how many runs it stays on while its command rests at zero, and of the first.

    A run that is refused, or whose process ends, is told in ``failed``; the others go on. Interrupted, it
    raises `SweepInterrupted`, a `KeyboardInterrupt` whose ``sweep`` has what is done.

    Raises `SignalError`, and `StructureError` for switches that there are not, for arguments that no run can
    use, `StoreError` for the folder of another sweep.

    >>> import bondgraph as bg, networkx as nx
    >>> from codegen import Family, final, peak
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.One("mass"), bg.I("m", "m", flow="v"), bg.C("spring", "1/k", effort="F")])
    >>> g.add_edges_from([("mass", "m"), ("mass", "spring")])
    >>> family = Family(bg.derive(g), {"m": 1, "k": 1})
    >>> found = sweep(family, {"k": [1, 4, 9], "v": [1, 2]}, np.linspace(0, 6.4, 641),
    ...               {"force": peak("F"), "end": final("v")}, workers=0, progress=False)
    >>> found["force"].round(3)
    array([1., 2., 2., 4., 3., 6.])
    >>> found.table()["k"]
    array([1., 1., 4., 4., 9., 9.])
    """
    runs = design(parameters)
    settings = MappingProxyType({"method": method, "rtol": rtol, "atol": atol})
    asked = MappingProxyType(checked_measures(measures))
    on = checked_switches(model, initially_on)
    times = checked_times(time)
    # Once for all runs and processes, which need not have the functions.
    in_numpy = getattr(model, "backend", "numpy") == "numpy"
    told = followed(inputs, times) if in_numpy else inputs
    given = by_states_of(model, initial, runs.names), told, settings, on, events, len(runs)
    job = Job(model, runs.names, times, asked, *given)
    check(job, initial)
    _check_count(workers, "workers", 0)
    _check_count(chunk, "chunk", 1)
    collected = Collected(len(runs), tuple(measures))
    kept = None
    if store is not None:
        about = {**job.about(initial), "parameters": runs.fingerprint(), "runs": len(runs)}
        kept = Store(store, about)
    for outcome in () if kept is None else kept.finished():
        collected.add(outcome)
    over_time = frozenset(n for n, m in measures.items() if isinstance(m, Measure) and m.over_time)
    todo = np.flatnonzero(~collected.done)
    try:
        with _bar(progress, len(runs), len(runs) - len(todo)) as advance:

            def keep(outcome: Outcome) -> None:
                new = collected.add(outcome)
                if kept is not None and new:
                    kept.keep(outcome)
                advance(new)

            if len(todo):
                work = Work(runs, todo, Pace(chunk, _rhythm(job, client)))
                _run(_crew(job, client, workers, len(todo)), work, keep)
    except KeyboardInterrupt:
        raise SweepInterrupted(collected.sweep(runs, job.time, over_time)) from None
    tell_all(collected.fallen, len(runs))
    found = collected.sweep(runs, job.time, over_time)
    tell_all_completed(found.completed, len(runs))
    tell_all_resting(job, runs)
    return found


def _rhythm(job: Job, client: Any) -> Rhythm:
    """How chunks grow: by what does their runs."""
    if batch_of(job) is not None:
        return STEADY if client is not None else QUICK
    return STEADY if abreast_of(job) is None else BESIDE


def _run(crew: Crew, work: Work, keep: Callable[[Outcome], None]) -> None:
    finished = False
    try:
        drive(crew, work, keep)
        finished = True
    finally:
        crew.close(now=not finished)


def _crew(job: Job, client: Any, workers: int | None, runs: int) -> Crew:
    if client is not None:
        return Cluster(sent(job), client)
    if workers is None:
        known = hasattr(os, "sched_getaffinity")
        workers = len(os.sched_getaffinity(0)) if known else os.cpu_count() or 1
    if workers == 0:
        return Here(job)
    if batch_of(job) is not None:
        return Threads(job, min(workers, runs))
    return Processes(sent(job), min(workers, runs))


@contextmanager
def _bar(wanted: bool, runs: int, done: int) -> Iterator[Callable[[int], object]]:
    """What tells how many runs are through: a bar, or nothing."""
    try:
        from tqdm import tqdm
    except ImportError:
        wanted = False
    if not wanted:
        yield lambda new: None
        return
    with tqdm(total=runs, initial=done, unit="run") as bar:
        yield bar.update


def _check_count(count: object, what: str, least: int) -> None:
    if count is not None and (isinstance(count, bool) or not isinstance(count, int)):
        raise SignalError(f"{what} must be a whole number, not {count!r}")
    if count is not None and count < least:
        raise SignalError(f"{what} must be {least} or more, not {count}")

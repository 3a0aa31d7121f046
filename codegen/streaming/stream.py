"""A run of a model, streamed to a file of its samples and one of its events."""

from collections.abc import Callable, Iterable
from contextlib import ExitStack
from os import PathLike
from pathlib import Path
from types import MappingProxyType

from bondgraph.errors import SignalError, nearest
from bondgraph.writing import growing, telling
from codegen.modes.closed import ClosedModel
from codegen.program.units import told_units
from codegen.record.columns import known_names, table_names
from codegen.record.tables import free
from codegen.streaming.files import checked_ending, events_into, numbers_into
from codegen.streaming.streamed import Streamed
from codegen.streaming.writing import Writing
from codegen.taking.asked import Request
from codegen.taking.blocks import Sink

Run = Callable[[Sink], str]
"""Runs into a sink; what ran it."""


def events_beside(path: str | PathLike[str]) -> Path:
    """Where the events of a run go whose samples go to ``path``.

    >>> events_beside("out/run.csv").as_posix()
    'out/run.events.csv'
    """
    target = Path(path)
    return target.with_name(f"{target.stem}.events{target.suffix}")


def wanted_signals(model: ClosedModel, signals: Iterable[str] | None) -> tuple[str, ...]:
    """The signals that are to be written, each once; `SignalError` for one that there is not."""
    if signals is None:
        return table_names(model.program)
    if isinstance(signals, str):
        raise SignalError(f"signals must be a list of names, not {signals!r}")
    known, names = known_names(model.program), tuple(dict.fromkeys(signals))
    for name in names:
        if name not in known:
            raise SignalError(
                f"no signal {name!r}{nearest(str(name), known)}; there are {', '.join(known)}"
            )
    return names


def streamed(
    model: ClosedModel, asked: Request, path: Path, names: tuple[str, ...], run: Run
) -> tuple[Streamed, Writing]:
    """Run into the files; what is left of the run, and what wrote it.

    Each file takes its place when both are whole. Raises `WriteError` where a file cannot be written.
    """
    ending, beside = checked_ending(path), events_beside(path)
    t, units = free("t", dict.fromkeys(names)), told_units(model.equations)
    with ExitStack() as files:
        numbers = numbers_into(
            files.enter_context(growing(path)), ending, [t, *names], {**units, t: "s"}
        )
        events = None
        if asked.events:
            events = events_into(files.enter_context(growing(beside)), ending)
        writing = Writing(model, asked.times, names, numbers, events)
        try:
            backend = run(writing)
        except BaseException as error:
            _leave(writing, error)
            raise
        writing.end()
    if not asked.events:
        with telling(beside):
            beside.unlink(missing_ok=True)
    told = {name: unit for name, unit in units.items() if name in writing.final}
    found = Streamed(
        path, beside if asked.events else None, writing.samples, writing.events, names,
        MappingProxyType(dict(writing.final)), MappingProxyType(told), backend, asked.begun.completed,
    )  # fmt: skip
    return found, writing


def _leave(writing: Writing, error: BaseException) -> None:
    """Let what was written before an error be read; what fails then is told beside that."""
    try:
        writing.end()
    except (OSError, ValueError) as other:
        error.add_note(f"the last of it could not be written: {other}")

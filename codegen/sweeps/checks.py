"""What no run of a sweep could use, refused before the first."""

from collections.abc import Callable, Hashable, Iterable, Mapping
from typing import Any

from bondgraph.algebra.atoms import normal
from bondgraph.declare.switching import checked_modes
from bondgraph.errors import SignalError, nearest
from codegen.batch.asked import Given
from codegen.family import Family
from codegen.inputs.signal import Signal
from codegen.inputs.swept import Swept, settled
from codegen.program.records import Program
from codegen.record.columns import known_names
from codegen.record.measures import EVENTFUL, OF_NODES, READY, Measure, check_event, check_node
from codegen.runs.arguments import named_numbers, settings_of, signals_for
from codegen.sweeps.held import starts_of
from codegen.sweeps.job import Job, Model

RESERVED = ("run", "time")
"""Names of axes."""


def checked_switches(model: Model, on: Iterable[Hashable]) -> tuple[Hashable, ...]:
    """The switches that are on at first; `StructureError` for what is no list of the model's."""
    listed = isinstance(on, Iterable) and not isinstance(on, str)
    chosen = tuple(on) if listed else ()
    known = [p.name for p in model.program.switches] if isinstance(model, Family) else chosen
    checked_modes(known, chosen if listed else on)
    return chosen


def checked_measures(measures: Mapping[str, Callable[..., Any]]) -> dict[str, Callable[..., Any]]:
    """The measures by name; `SignalError` for what is no mapping."""
    if not isinstance(measures, Mapping):
        raise SignalError(f"measures must map names to functions of a run, not be {measures!r}")
    return dict(measures)


def check(job: Job, initial: Given) -> None:
    """Refuse what no run could use, before the first; ``initial``: as it was given.

    Raises `SignalError`.
    """
    model = job.model
    if not all(hasattr(model, name) for name in ("simulator", "parameters", "states", "inputs")):
        raise SignalError(
            f"a sweep needs a model whose numbers are free, such as codegen.Family, not {model!r}"
        )
    _check_measures(job)
    free = callable(initial) or callable(job.inputs)
    starts = starts_of(model)
    known = (*model.parameters, *starts, *model.inputs, *_sizes(job))
    for name in job.names:
        if name not in known and not free:
            raise SignalError(
                f"{name!r} is no parameter, state or input{nearest(name, known)}; there are "
                f"{', '.join(known)}"
            )
    for given, what in ((initial, "initial"), (job.inputs, "inputs")):
        if isinstance(given, Signal) or not (callable(given) or isinstance(given, Mapping | None)):
            raise SignalError(f"{what} must map names to values, not be {given!r}")
        twice = [] if callable(given) else [n for n in given or {} if str(normal(n)) in job.names]
        if twice:
            raise SignalError(f"{what}: {twice[0]!r} is swept, too; leave it out here")
    if not callable(initial):
        named_numbers({} if initial is None else initial, starts)
    if not callable(job.inputs):
        swept = {name: 0.0 for name in job.names if name in model.inputs}
        given = settled(job.inputs or {}, dict.fromkeys(_sizes(job), 0.0))
        signals_for({**given, **swept}, model.inputs)
    settings_of(**job.settings)


def _sizes(job: Job) -> list[str]:
    """The swept numbers that are sizes of inputs; refuses those that are not swept."""
    if not isinstance(job.inputs, Mapping):
        return []
    for name, given in job.inputs.items():
        if isinstance(given, Swept) and given.name not in job.names:
            raise SignalError(
                f"input {name!r}: {given.name!r} is not swept; swept are {', '.join(job.names)}"
            )
    return [given.name for given in job.inputs.values() if isinstance(given, Swept)]


def _check_measures(job: Job) -> None:
    if not job.measures:
        raise SignalError("measures: name at least one function of a run")
    for name, measure in job.measures.items():
        if not callable(measure):
            raise SignalError(f"measure {name!r}: {measure!r} is not a function of a run")
        if isinstance(measure, Measure) and isinstance(job.model, Family):
            _check_names(name, measure, job.model.program)
    if not job.events and job.asking:
        raise SignalError(f"measure {job.asking[0]!r} asks for events; leave events=False out")
    for name in RESERVED:
        if name in job.names or name in job.measures:
            raise SignalError(f"{name!r} names an axis; call the column something else")
    for name in job.names:
        if name in job.measures:
            raise SignalError(f"{name!r} is swept, so no measure can have that name")


def _check_names(name: str, measure: Measure, program: Program) -> None:
    """Refuse a ready measure of a signal or a node that the model does not have."""
    if measure.function not in READY or not measure.arguments:
        return
    asked, known = measure.arguments[0], known_names(program)
    try:
        if READY[measure.function] in OF_NODES:
            check_node(asked, (*program.nodes, *_fields(program)))
            if measure.function in EVENTFUL:
                check_event(asked, measure.arguments[1], program.transitions)
        elif asked not in known:
            raise SignalError(
                f"no signal {asked!r}{nearest(str(asked), known)}; there are {', '.join(known)}"
            )
    except SignalError as error:
        raise SignalError(f"measure {name!r}: {error}") from None


def _fields(program: Program) -> list[Hashable]:
    """The nodes of several ports, which are asked for as wholes."""
    owners = (one.owner for one in program.equations.elements.values())
    return list(dict.fromkeys(owner for owner in owners if owner is not None))

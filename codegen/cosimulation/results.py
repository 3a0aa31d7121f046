"""What a model went through as the record of a run: its inputs are what they were held at."""

from codegen.cosimulation.held import signal_of
from codegen.cosimulation.model import ModelPart
from codegen.inputs.signals import as_signal
from codegen.model.sources import source_signals
from codegen.numbers.arrays import Array, read_only
from codegen.record.beyond import refuse_all_beyond
from codegen.record.columns import listed_columns
from codegen.record.replay import Run
from codegen.record.result import Result
from codegen.runs.completion import started


def result_of(part: ModelPart, times: Array) -> Result:
    """The record of a model over the communication points."""
    ready, stepper = part.simulator, part.stepper
    model, origin = ready.closed, stepper.origin
    signals = [
        signal_of(times, part.held[name]) if name in part.held else as_signal(part.open[name], name)
        for name in ready.inputs
    ]
    begin, end = float(times[0]), float(times[-1])
    every = [*signals, *source_signals(model.program, model.parameters, begin, end)]
    _, begun = started(model, begin, dict(origin.start.told), every, origin.start.on)
    columns, observer = origin.plan.columns(part.rows)
    run = Run(
        ready.laws, model.parameters, times, read_only(begun.s), tuple(signals), part.settings,
        begun.mode,
    )  # fmt: skip
    shown, inner = listed_columns(columns, model.program)
    found = Result(
        times,
        ready.states,
        ready.inputs,
        ready.outputs,
        part.events,
        shown,
        observer,
        ready.ledger(run),
        part.units,
        stepper.backend,
        begun.completed,
        inner,
    )
    refuse_all_beyond(model, found)
    return found

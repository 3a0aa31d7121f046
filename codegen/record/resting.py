"""A run's commands that came to rest at zero while their switches were on."""

import warnings

from bondgraph.errors import ModelWarning
from codegen.model.resting import first_rest
from codegen.modes.closed import ClosedModel
from codegen.record.result import Result


def tell_resting(model: ClosedModel, done: Result) -> None:
    """Warn whoever called what calls this of switches that are on at two samples with a command of zero."""
    for one in model.commands:
        values = one.at(done.time, *(done[name] for name in one.signals))
        rest = first_rest(one, done[str(one.name)], values, done.time)
        if rest is not None:
            warnings.warn(str(rest), ModelWarning, stacklevel=3)

"""A run's commands that came to rest at zero while their switches were on."""

import warnings
from collections.abc import Iterable

import numpy as np

from bondgraph.errors import ModelWarning
from codegen.model.outside import outside
from codegen.model.resting import Rest, first_rest
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.record.beyond import Sampled


class Resting:
    """What is found of that in a run that is seen in parts, one after the other."""

    def __init__(self, model: ClosedModel) -> None:
        self._model = model
        self._latest: dict[int, tuple[Array, ...]] = {}
        self._found: dict[int, Rest] = {}

    def see(self, part: Sampled) -> None:
        """Look at the next samples."""
        for at, one in enumerate(self._model.commands):
            values = one.at(part.time, *(part[name] for name in one.signals))
            # Two samples one after the other tell, so the latest of the part before is of this one, too.
            rows = part[str(one.name)], np.asarray(values) + 0 * part.time, part.time
            before = self._latest.get(at)
            whole = rows if before is None else tuple(map(np.append, before, rows))
            rest = first_rest(one, *whole)
            if rest is not None:
                self._found.setdefault(at, rest)
            self._latest[at] = tuple(row[-1:] for row in whole)

    @property
    def rests(self) -> Iterable[Rest]:
        """The first of each command that there was."""
        return [self._found[at] for at in sorted(self._found)]


def tell_resting(model: ClosedModel, done: Sampled) -> None:
    """Warn, at the user's line, of switches that are on at two samples with a command of zero."""
    found = Resting(model)
    found.see(done)
    tell_rests(found)


def tell_rests(found: Resting) -> None:
    """The same of a run that was seen in parts."""
    for rest in found.rests:
        warnings.warn(str(rest), ModelWarning, stacklevel=outside())

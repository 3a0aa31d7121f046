"""What a sweep does for every run, as one object that can be sent to other processes."""

import hashlib
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Protocol

import numpy as np

from bondgraph.errors import BondGraphError
from codegen.batch.asked import Given
from codegen.inputs.swept import settled
from codegen.numbers.arrays import Array
from codegen.record.measures import EVENTFUL, READY, Measure
from codegen.record.result import Result
from codegen.runs.track import CORNER
from codegen.simulator import Simulator
from codegen.tuning import TUNING


class Runner(Protocol):
    """A model with all its numbers, such as `codegen.Simulator`."""

    def run(
        self,
        time: Array,
        initial: Mapping[str, float] | None = None,
        inputs: Mapping[str, object] | None = None,
        method: str = "auto",
        rtol: float = TUNING.rtol,
        atol: float = TUNING.atol,
    ) -> Result:
        """The record of a run."""


class Model(Protocol):
    """What a sweep can run: `codegen.Family`, or anything alike that can be pickled."""

    @property
    def parameters(self) -> Mapping[str, object]:
        """Default numbers by name."""

    @property
    def states(self) -> tuple[str, ...]:
        """What a run's initial values may name."""

    @property
    def inputs(self) -> tuple[str, ...]:
        """What a run must be given."""

    def simulator(self, /, **changes: object) -> Runner:
        """The model with other numbers for some parameters."""

    def fingerprint(self) -> str:
        """A text that is another for another model."""


@dataclass(frozen=True, eq=False)
class Job:
    """A model and all that its runs share; ``names`` are what each run has numbers for.

    ``events``: whether functions that are no ready measures find what happened in a run. ``runs``: how many
    there are in all.
    """

    model: Model
    names: tuple[str, ...]
    time: Array
    measures: Mapping[str, Callable[[Result], Any]]
    initial: Given = None
    inputs: Given = None
    settings: Mapping[str, Any] = field(default_factory=dict)
    initially_on: tuple[Hashable, ...] = ()
    events: bool = True
    runs: int = 0

    def run(
        self, row: Sequence[float], fallen: list[str] | None = None,
        completed: dict[str, float] | None = None,
    ) -> tuple[Array, ...] | str:  # fmt: skip
        """The measures of one run, or why there are none.

        In ``fallen`` why numpy did it for C, in ``completed`` the states that followed switches at the start.
        """
        values = dict(zip(self.names, row, strict=True))
        try:
            result = self._result(values, [] if fallen is None else fallen)
        except BondGraphError as error:
            return str(error)
        except Exception as error:  # noqa: BLE001 - one run of many: told with its numbers
            return f"{type(error).__name__}: {error}"
        if completed is not None:
            completed |= getattr(result, "completed", {})
        return self.measured(result)

    def measured(self, result: Result) -> tuple[Array, ...] | str:
        """The measures of the record of a run, or why there are none."""
        found = []
        for name, measure in self.measures.items():
            try:
                found.append(_measured(measure(result)))
            except BondGraphError as error:
                return f"measure {name!r}: {error}"
            except Exception as error:  # noqa: BLE001 - the caller's code
                return f"measure {name!r}: {type(error).__name__}: {error}"
        return tuple(found)

    def record(self, row: Sequence[float]) -> Result:
        """The record of one run; raises what refuses it."""
        return self._result(dict(zip(self.names, row, strict=True)), [])

    def _result(self, values: Mapping[str, float], fallen: list[str]) -> Result:
        model = self.model
        changes = {name: v for name, v in values.items() if name in model.parameters}
        initial, inputs = _given(self.initial, values), settled(_given(self.inputs, values), values)
        initial |= {name: v for name, v in values.items() if name in model.states}
        inputs |= {name: v for name, v in values.items() if name in model.inputs}
        runner = model.simulator(**changes)
        if not isinstance(runner, Simulator):
            return runner.run(self.time, initial, inputs, **self._settings)
        # Times differ from run to run; the reason is what is counted.
        return runner.run_telling(
            lambda stopped: fallen.append(stopped.reason),
            self.time, initial, inputs, events=self.eventful, corners=self._cornered,
            **self._settings,
        )  # fmt: skip

    @property
    def eventful(self) -> bool:
        """Whether a measure may ask for events."""
        ready = (isinstance(m, Measure) and m.function in READY for m in self.measures.values())
        return (self.events and not all(ready)) or bool(self.asking)

    @property
    def _cornered(self) -> bool:
        """Whether a ready measure asks for corners of laws."""
        asking = [self.measures[name] for name in self.asking]
        return any(CORNER in one.arguments for one in asking if isinstance(one, Measure))

    @property
    def asking(self) -> list[str]:
        """The ready measures that events are kept for."""
        every = self.measures.items()
        return [name for name, m in every if getattr(m, "function", None) in EVENTFUL]

    @property
    def _settings(self) -> dict[str, Any]:
        """The settings, with the switches that are on at first where any is."""
        on = {"initially_on": self.initially_on} if self.initially_on else {}
        return {**self.settings, **on}

    def about(self, initial: Given) -> dict[str, object]:
        """What identifies the job, part by part: everything that the results depend on but the rows.

        ``initial``: as it was given, with what storages hold by that name.
        """
        return {
            "model": self.model.fingerprint(),
            "time": hashlib.sha256(self.time.tobytes()).hexdigest(),
            "initial": _described(initial),
            "inputs": _described(self.inputs),
            "settings": {name: _described(value) for name, value in self.settings.items()},
            "names": list(self.names),
            **({"initially_on": list(map(repr, self.initially_on))} if self.initially_on else {}),
            **({} if self.events else {"events": False}),
            "measures": [[name, _described(measure)] for name, measure in self.measures.items()],
        }


def _measured(value: Any) -> Array:
    """What a measure gives as floats, truth values as 0 and 1; `TypeError` for what is complex."""
    if np.iscomplexobj(value):
        raise TypeError(f"{value!r} is complex")
    return np.array(value, dtype=float)


def _given(given: Given, values: Mapping[str, float]) -> dict[str, Any]:
    found = given(values) if callable(given) else given
    return dict(found or {})


def _described(value: object) -> str:
    """Text that stands for an argument in every process.

    Functions are told by their names, objects without a text of their own by their classes.
    """
    if isinstance(value, Mapping):
        return repr(sorted((str(name), _described(part)) for name, part in value.items()))
    if isinstance(value, np.ndarray):
        return f"{value.dtype}{value.shape} {hashlib.sha256(value.tobytes()).hexdigest()}"
    if isinstance(value, list | tuple):
        return f"({', '.join(map(_described, value))})"
    if isinstance(value, partial):
        parts = (value.func, *value.args, value.keywords)
        return f"partial({', '.join(map(_described, parts))})"
    named: Any = value if hasattr(value, "__qualname__") else type(value)
    plain: Any = object
    if named is value or named.__repr__ is plain.__repr__:
        return f"{getattr(named, '__module__', '')}.{named.__qualname__}"
    return repr(value)

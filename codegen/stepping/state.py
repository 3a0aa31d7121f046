"""Where a stepper is, as a record that can be kept, pickled and gone back to."""

from collections.abc import Hashable
from dataclasses import dataclass, field
from typing import NamedTuple

from codegen.inputs.signal import Signal
from codegen.model.kept import Paused
from codegen.runs.track import Event


class Start(NamedTuple):
    """How a run was told to begin: states by name, and the switches that are on before."""

    told: tuple[tuple[str, float], ...]
    on: frozenset[Hashable]


@dataclass(frozen=True)
class StepperState:
    """All that what a stepper does next rests on, as numbers that do not change; it can be pickled.

    It is of one model, whatever runs it: what numpy left, C goes on with. ``time`` [s]; ``inputs``: the
    signals that hold; the rest is for `Stepper.restore`.

    >>> import pickle
    >>> import bondgraph as bg
    >>> from codegen import simulator
    >>> mass = bg.graph([bg.Se("force", "F"), bg.One("mass"), bg.I("m", "m", flow="v")],
    ...                 "force > mass > m")
    >>> stepper = simulator(bg.derive(mass), {"m": 2}).stepper(inputs={"F": 4})
    >>> before = pickle.loads(pickle.dumps(stepper.state))
    >>> stepper.advance(0.5)["v"], before.time
    (1.0, 0.0)
    >>> stepper.restore(before)
    >>> stepper.time, stepper.signals["v"]
    (0.0, 0.0)
    """

    time: float
    inputs: tuple[Signal, ...] = field(repr=False)
    #: What is left of the time by rounding [s].
    late: float = field(repr=False)
    #: Names of states, inputs and ports, which tell a model from others.
    names: tuple[tuple[Hashable, ...], ...] = field(repr=False)
    #: How it began, before the first advance; else nothing.
    start: Start | None = field(repr=False)
    paused: Paused = field(repr=False)
    #: What the latest advance told of.
    events: tuple[Event, ...] = field(repr=False)

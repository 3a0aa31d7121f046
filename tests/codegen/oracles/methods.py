"""Every way in which the toolkit runs a model, with one shape of record, so that runs can be compared.

A way that locates events is a function from a `Made` to an `Outcome`; one with fixed steps takes the steps
per sample, too. A further way needs one such function and its line in `LOCATED` or `STEPPED`.
"""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np

import codegen
from codegen.runs.arguments import signals_for
from codegen.runs.track import Event
from differentials.figures import figures
from differentials.prepared import SAMPLE
from differentials.scenarios import Scenario, prepared, scenarios
from differentials.topologies import catalog
from oracles.c_model import Pair
from oracles.exported import loaded
from oracles.units import Case, sampled, simulated

OWN: Mapping[str, str] = {name: one.scenario for name, one in catalog.items()}
"""Each differential's own scenario."""

EVERY = tuple(
    dict.fromkeys([*OWN.items(), *(run for figure in figures.values() for run in figure.runs)])
)
"""Every differential in its own scenario, and every run that a figure of the paper shows."""

SOON = {"engine_step": 0.02, "clutch_step": 0.1, "duration": 0.2}
"""Steps one soon after the other, and the end soon after: where a clutch sticks and slips in the scenario
itself, it does so here, on the four-wheel drive more often."""

TIGHT = 1e-13
"""CVODE's relative tolerance: of a speed's magnitude, which is up to 1e5 times as large as its range."""


@dataclass(frozen=True)
class Outcome:
    """Signals at every sample, and the changes of mode of each friction port in their order."""

    columns: Mapping[str, np.ndarray]
    events: tuple[Event, ...]


@dataclass(frozen=True)
class Made:
    """A differential in a scenario, and what is made of it in a folder, each when first asked for.

    ``pairs``: compiled C by differential, which scenarios share. ``brief``: what `SOON` says of the scenario.
    """

    name: str
    scenario: str
    folder: Path
    pairs: dict[str, Pair] = field(default_factory=dict, compare=False)
    brief: bool = False

    @cached_property
    def case(self) -> Case:
        ready = prepared(self.name, self._shown)
        arguments = (ready.equations, ready.parameters, ready.laws, ready.initial, ready.inputs)
        return Case(*arguments, float(ready.times[-1]))

    @property
    def _shown(self) -> Scenario:
        whole = scenarios[self.scenario]
        return replace(whole, **SOON) if self.brief else whole

    @property
    def samples(self) -> int:
        return round(self.case.end / SAMPLE) + 1

    @cached_property
    def exact(self) -> codegen.Result:
        return self.case.run(self.samples, "exact")

    @property
    def ports(self) -> tuple[Hashable, ...]:
        return tuple(port.name for port in self.exact.observer.model.program.friction)

    def pair(self) -> Pair:
        if self.name not in self.pairs:
            case = self.case
            self.pairs[self.name] = Pair(
                self.folder / self.name, case.equations, case.parameters, case.laws, "-O0"
            )
        return self.pairs[self.name].at(self.case.parameters)

    def unit(self, version: str) -> Path:
        path = self.folder / version / f"{self.name}_{self.scenario}.fmu"
        return path if path.exists() else self.case.written(path, version)


def _kept(result: codegen.Result) -> Outcome:
    return Outcome(result.columns, result.events)


def _in_backend(made: Made, method: str) -> Outcome:
    """Generated C and nothing else."""
    case = made.case
    ready = codegen.simulator(case.equations, case.parameters, case.laws, "c")
    found = ready.run(made.exact.time, case.initial, case.inputs, method)
    assert found.backend == "c"
    return _kept(found)


def _exchanged(made: Made, version: str) -> Outcome:
    return _by_fmpy(made, version, "ModelExchange", made.samples, tolerance=TIGHT)


def _cosimulated(made: Made, per_sample: int, version: str) -> Outcome:
    rows = (made.samples - 1) * per_sample + 1
    start = {"fixed_internal_step": SAMPLE / per_sample}
    return _by_fmpy(made, version, "CoSimulation", rows, start_values=start)


def _by_fmpy(made: Made, version: str, kind: str, rows: int, **more) -> Outcome:
    output = [*made.exact, *(f"mode({port})" for port in made.ports)]
    found = simulated(made.unit(version), kind, made.case, output, rows, **more)
    modes = np.array([found[f"mode({port})"] for port in made.ports]).T
    columns = sampled(found, made.case, made.samples)
    return Outcome(columns, changes(found["time"], modes, made.ports))


def _in_python(made: Made, per_sample: int) -> Outcome:
    """`simulate` of the exported module; the modes are those that its own steps settle on."""
    case, seen = made.case, []
    module = loaded(codegen.to_python(case.equations, case.parameters, case.laws))
    settled = module.Model.settled

    def noted(model, at, *rest):
        found = settled(model, at, *rest)
        seen.append((at.t, found[0]))
        return found

    module.Model.settled = noted
    times = np.linspace(0.0, case.end, made.samples)
    step = SAMPLE / per_sample
    columns = module.simulate(times, case.initial, case.inputs, step=step)
    modes = np.reshape([mode for _, mode in seen], (len(seen), len(made.ports)))
    return Outcome(columns, changes([t for t, _ in seen], modes, made.ports))


def _in_c(made: Made, per_sample: int) -> Outcome:
    case, pair, h = made.case, made.pair(), SAMPLE / per_sample
    count = (made.samples - 1) * per_sample
    names = [name.name for name in pair.program.external]
    signals = signals_for(case.inputs, names)
    w = np.array([[signal(k * h / 2) for signal in signals] for k in range(2 * count + 3)])
    start = [case.initial.get(name, 0.0) for name in made.exact.states]
    modes, columns = pair.c.march(h, count, per_sample, pair.c.vector(0.0, start, w[0]), w)
    return Outcome(columns, changes(np.arange(count + 1) * h, modes, made.ports))


def changes(
    times: Sequence[float], modes: np.ndarray, ports: Sequence[Hashable]
) -> tuple[Event, ...]:
    """Where the modes, rows over time, differ from the row before."""
    found = []
    for at, port in enumerate(ports):
        for k in np.flatnonzero(np.diff(modes[:, at])):
            before, after = modes[k : k + 2, at]
            kind = "stick" if after == 0 else "slip" if before == 0 else "cross"
            found.append(Event(float(times[k + 1]), port, kind))
    return tuple(sorted(found, key=lambda event: event.time))


LOCATED: Mapping[str, Callable[[Made], Outcome]] = {
    "numpy exact": lambda made: _kept(made.exact),
    "C backend": lambda made: _in_backend(made, "exact"),
    "C, events located": lambda made: _in_backend(made, "DOP853"),
    "numpy DOP853": lambda made: _kept(made.case.run(made.samples, "DOP853")),
    "FMI 2.0 exchange": lambda made: _exchanged(made, "2.0"),
    "FMI 3.0 exchange": lambda made: _exchanged(made, "3.0"),
}
"""Ways to run that locate events; the first is what others are compared with."""

STEPPED: Mapping[str, Callable[[Made, int], Outcome]] = {
    "exported C": _in_c,
    "exported Python": _in_python,
    "FMI 2.0 co-simulation": lambda made, per_sample: _cosimulated(made, per_sample, "2.0"),
    "FMI 3.0 co-simulation": lambda made, per_sample: _cosimulated(made, per_sample, "3.0"),
}
"""Ways to run with fixed steps, so many for each sample; the first is what others are compared with."""

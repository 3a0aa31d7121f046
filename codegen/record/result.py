"""`Result`: the record of a run, and every effort, flow, power and energy in it."""

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Protocol

from bondgraph.errors import SignalError
from codegen.energy.audit import Audit
from codegen.numbers.arrays import Array
from codegen.pictures.labels import common, measured, pretty
from codegen.pictures.marks import Marks, stuck_spans
from codegen.pictures.stacked import Line, Panel, along, fill, stacked
from codegen.record.summary import summary
from codegen.record.tables import dataset
from codegen.record.timed import Timed
from codegen.record.views import run_html
from codegen.record.working import Accountant, Named, Watcher
from codegen.runs.track import Event


def _no_units() -> Mapping[str, str]:
    return MappingProxyType({})


def _no_columns() -> Mapping[str, Array]:
    return MappingProxyType({})


def _nothing() -> Mapping[str, float]:
    return MappingProxyType({})


@dataclass(frozen=True)
class Result(Timed):
    """The record of a run: ``result["omega_1"]`` is any named signal of the graph over ``result.time``.

    ``events``: what happened at friction ports and switches, in order. At a step or an event a sample
    shows the instant just after. ``columns``: the signals that a table of the run holds: states, inputs,
    outputs and what laws read; they and ``time`` are read-only arrays. ``inner``: those of the parts that
    functions, states and controllers are made of, which no table holds and ``result[...]`` gives.
    ``units``: of those signals of which elements tell it. ``backend``: what ran it; what the C of a
    simulator cannot go on with is run by "numpy" from the start. ``completed``: the states that were not
    named and followed what switches held at first.
    """

    time: Array = field(repr=False)
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    events: tuple[Event, ...]
    columns: Mapping[str, Array] = field(repr=False)
    observer: Watcher = field(repr=False, compare=False)
    ledger: Accountant = field(repr=False, compare=False)
    units: Mapping[str, str] = field(repr=False, default_factory=_no_units)
    backend: str = "numpy"
    completed: Mapping[str, float] = field(repr=False, default_factory=_nothing)
    inner: Mapping[str, Array] = field(repr=False, compare=False, default_factory=_no_columns)

    def __getitem__(self, name: str) -> Array:
        """The values of one signal; `KeyError` naming what there is."""
        if name in self.columns:
            return self.columns[name]
        if name in self.inner:
            return self.inner[name]
        return self.observer.signal(name)

    def __iter__(self) -> Iterator[str]:
        """The names of the columns."""
        return iter(self.columns)

    def bond(self, tail: Hashable, head: Hashable) -> tuple[Array, Array]:
        """Effort and flow of a bond, as declared; see `StateEquations.bond`."""
        return self.observer.bond(tail, head)

    def power(self, node: Hashable) -> Array:
        """Power that an I, C or R absorbs, or that a source supplies."""
        return self.observer.power(node)

    def energy(self, node: Hashable) -> Array:
        """Energy stored in an I or C, 0 where its state is 0."""
        return self.observer.energy(node)

    def work(self, node: Hashable) -> Array:
        """Energy that an I, C or R has absorbed, or a source has supplied, up to each sample.

        Integrated with the run, however few the samples: when first asked for, the same run is done again
        for that. Impulses are in it.
        """
        return self.ledger.work(node)

    def integral(self, name: str) -> Array:
        """A signal, or what a linear storage holds, integrated up to each sample, as `work` is.

        Raises `SignalError` for one that there is not.
        """
        return self.ledger.integral(name)

    def audit(self) -> Audit:
        """What sources gave, storages took, resistances and laws lost, and jumps took; see `Audit`.

        It closes to the run's tolerance, and to 1e-9 of the energy turned over at the default one.
        """
        return self.ledger.audit()

    def to_xarray(self) -> Any:
        """An `xarray.Dataset` of every column over "time" [s], with units and roles as attributes.

        Events are the coordinates ``event_time``, ``event_port`` and ``event_kind`` along "event". Where
        a signal has such a name, an underscore is appended. Raises `MissingExtraError` without xarray.
        """
        roles = (("output", self.outputs), ("input", self.inputs), ("state", self.states))
        attributes: dict[str, dict[str, str]] = {name: {} for name in self.columns}
        for role, names in roles:
            for name in names:
                attributes.setdefault(name, {})["role"] = role
        for name, unit in self.units.items():
            attributes.setdefault(name, {})["units"] = unit
        return dataset(self.time, self.columns, attributes, self.events)

    def summary(self) -> str:
        """Samples, where states begin, end and turn, and events, as a short text."""
        states = {name: self.columns[name] for name in self.states}
        return summary(self.time, states, self.units, self.events)

    def __str__(self) -> str:
        return self.summary()

    def _repr_html_(self) -> str:
        states = {name: self.columns[name] for name in self.states}
        return run_html(
            self.time, states, tuple(self.columns), self.units, self.events, self.backend
        )

    def __dir__(self) -> list[str]:
        """What users ask; what works it out is left out."""
        return [name for name in super().__dir__() if name not in ("observer", "ledger")]

    def _ipython_key_completions_(self) -> list[str]:
        return list(dict.fromkeys([*self.columns, *self.observer.names()]))

    def plot(
        self, *names: str | Sequence[str], title: str | None = None, ax: Any = None,
        units: Mapping[str, str] | None = None,
    ) -> Any:  # fmt: skip
        """A `matplotlib.figure.Figure` of signals, the states if none are named, with events marked.

        Names share one panel; with a list among them each name or list has its own, as of `panels`.
        ``ax``: an axis to draw into. ``units``: of signals of which elements tell none.

        Raises `SignalError` for unknown names, `MissingExtraError` without matplotlib.
        """
        groups, marks = grouped(names, self.states), marks_of(self)
        shown = [panel_of(self, group, units=units) for group in groups]
        if ax is None:
            return stacked(shown, marks, title or "", *([3.0] if len(shown) == 1 else []))
        if len(shown) > 1:
            raise SignalError(
                f"{len(shown)} panels do not go into one axis; leave out ax, or the lists"
            )
        fill(ax, shown[0])
        height = along([ax], shown, marks)
        if title:
            ax.set_title(title, pad=6 + height)
        return ax.figure


class Shown(Protocol):
    """What has signals over the time, and events: a run, or several side by side."""

    @property
    def time(self) -> Array:
        """Of the samples [s]."""

    @property
    def units(self) -> Mapping[str, str]:
        """Of signals of which they are known."""

    @property
    def events(self) -> tuple[Event, ...]:
        """What happened."""

    def __getitem__(self, name: str) -> Array:
        """A signal; `KeyError` for one that there is not."""


def values_of(result: Named, name: str) -> Array:
    """A signal of a run; `SignalError` naming what there is."""
    try:
        return result[name]
    except KeyError as error:
        raise SignalError(error.args[0]) from None


def grouped(names: Sequence[str | Sequence[str]], states: Sequence[str]) -> list[list[str]]:
    """The signals of each panel: of one where there are names alone."""
    lists = [[one] if isinstance(one, str) else list(one) for one in names]
    if all(isinstance(one, str) for one in names):
        return [[name for one in lists for name in one] or [*states]]
    return lists


def panel_of(
    result: Shown, names: Sequence[str], label: str | None = None,
    units: Mapping[str, str] | None = None,
) -> Panel:  # fmt: skip
    """Signals of a run as a panel, labelled with their names and units."""
    if not names:
        raise SignalError("a panel needs at least one signal")
    told = {**result.units, **({} if units is None else units)}
    shared = len({told.get(name, "") for name in names}) == 1
    lines = tuple(
        Line(
            result.time,
            values_of(result, name),
            pretty(name) if shared else measured(name, told.get(name, "")),
        )
        for name in names
    )
    own = common(names, [told.get(name, "") for name in names]) if label is None else label
    return Panel(own, lines)


def marks_of(result: Shown) -> Marks:
    """A run's events and the spans in which its ports stick."""
    return Marks(result.events, tuple(stuck_spans(result.events, float(result.time[-1]))))

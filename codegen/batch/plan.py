"""What the loop over runs keeps of each: ready measures as numbers that C understands."""

from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from codegen.energy.accounts import Account, Product
from codegen.numbers.arrays import Array
from codegen.program.layout import places
from codegen.program.records import Program
from codegen.record.measures import READY, Measure
from codegen.runs.track import CORNER, KINDS

WHATS = (
    "peak", "largest", "smallest", "start", "final", "samples", "total", "first_event", "event_count",
)  # fmt: skip
"""In the order of ``batch_measure.h``."""

SAMPLES, EVENTS = WHATS.index("samples"), WHATS.index("first_event")

Numbers = Mapping[str, Array]
"""The parameters of each run, by name."""

Column = Callable[[Array, Numbers], Array]
"""A measure of each run, from the rows of results and the runs' numbers."""


class Entry(NamedTuple):
    """A measure as ``batch_measure`` of C: -1 where it has no signal, port or kind.

    ``signal``: of a total its product. ``at``: its first place in a run's row of results.
    """

    what: int
    signal: int
    port: int
    kind: int
    at: int


@dataclass(frozen=True)
class Plan:
    """What to keep of each run. ``rows``: places of the signals that are followed.

    ``factors``: places of those that ``products`` are made of, two each, -1 for none. ``samples``: how
    many instants there are. ``width``: how many numbers a run gives. ``columns``: the measures one by
    one.
    """

    entries: tuple[Entry, ...]
    rows: tuple[int, ...]
    factors: tuple[int, ...]
    products: tuple[tuple[int, int], ...]
    samples: int
    width: int
    columns: tuple[Column, ...]
    #: The mode before a run, and for each state whether it is given.
    first: tuple[int, ...] = ()
    named: tuple[int, ...] = ()

    @property
    def eventful(self) -> bool:
        """Whether a measure asks for events."""
        return any(entry.what >= EVENTS for entry in self.entries)

    @property
    def cornered(self) -> bool:
        """Whether one asks for corners of laws."""
        return any(entry.kind == KINDS.index(CORNER) for entry in self.entries)

    def told(self, found: Array, numbers: Numbers) -> tuple[Array, ...]:
        """The measures, from a row of results for each run."""
        return tuple(column(found, numbers) for column in self.columns)


class Gathering:
    """A plan in the making; what is asked for twice is kept once."""

    def __init__(self, program: Program, samples: int) -> None:
        self._places, self._samples, self._width = places(program), samples, 0
        self._places_of_events, self._ports = program.happening, len(program.friction)
        self._taken = program.taken
        self._entries: dict[tuple[int, int, int, int], Entry] = {}
        self._rows: dict[int, int] = {}
        self._factors: dict[int, int] = {}
        self._products: dict[tuple[int, int], int] = {}

    @property
    def samples(self) -> int:
        """How many instants there are."""
        return self._samples

    def knows(self, name: str) -> bool:
        """Whether a signal is one of the program's."""
        return name in self._places

    def signal(self, what: str, name: str) -> int:
        """The place of what is kept of a signal in a run's row of results."""
        row = self._rows.setdefault(self._places[name], len(self._rows))
        return self._kept(WHATS.index(what), row, -1, -1)

    def event(self, what: str, node: Hashable, event: str) -> list[int]:
        """The places of what is kept of events, one for each of the node's ports."""
        taken = [at for at, words in self._taken.items() if words == event]
        if taken := [at for at in taken if self._places_of_events[at] == node]:
            return [self._kept(WHATS.index(what), -1, taken[0], KINDS.index("on"))]
        places = enumerate(self._places_of_events)
        ports = [
            at for at, name in places if name == node and (at >= self._ports) == (event == CORNER)
        ] or [-1]
        kind = KINDS.index(event) if event in KINDS else -1
        return [self._kept(WHATS.index(what), -1, port, kind) for port in ports]

    def account(self, account: Account) -> Callable[[Array], Array]:
        """What an account came to, from the rows of results."""
        at = [self._product(product) for product in account]
        shares = np.array([product.share for product in account])
        return lambda found: np.asarray(found[:, at] @ shares, dtype=float)

    def plan(self, columns: Iterable[Column]) -> Plan:
        """All that was asked for."""
        return Plan(
            tuple(self._entries.values()), tuple(self._rows), tuple(self._factors),
            tuple(self._products), self._samples, self._width, tuple(columns),
        )  # fmt: skip

    def _product(self, product: Product) -> int:
        one = self._factor(product.one)
        two = (one, self._factor(product.other) if product.other else -1)
        place = self._products.setdefault(two, len(self._products))
        return self._kept(WHATS.index("total"), place, -1, -1)

    def _factor(self, name: str) -> int:
        return self._factors.setdefault(self._places[name], len(self._factors))

    def _kept(self, what: int, signal: int, port: int, kind: int) -> int:
        key = (what, signal, port, kind)
        if key not in self._entries:
            self._entries[key] = Entry(*key, self._width)
            self._width += self._samples if what == SAMPLES else 1
        return self._entries[key].at


def plain(measure: Measure, gathered: Gathering) -> Column | None:
    """A measure of samples or events as the loop gets it; None for a signal that it does not know."""
    name = READY[measure.function]
    what = WHATS.index(name)
    if what >= EVENTS:
        places = gathered.event(name, *measure.arguments)
        whole = np.fmin if what == EVENTS else np.add
        return lambda found, numbers: whole.reduce(found[:, places], axis=1)
    if gathered.knows(measure.arguments[0]):
        at = gathered.signal(name, measure.arguments[0])
    else:
        return None
    if what == SAMPLES:
        return lambda found, numbers: found[:, at : at + gathered.samples]
    return lambda found, numbers: found[:, at]

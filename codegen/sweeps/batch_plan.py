"""What the loop over runs keeps of each: ready measures as numbers that C understands."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

from codegen.arrays import Array
from codegen.engine.runs import KINDS
from codegen.model.places import places
from codegen.program import Program
from codegen.sweeps.measures import READY, Measure

WHATS = (
    "peak", "largest", "smallest", "final", "integral", "samples", "first_event", "event_count",
)  # fmt: skip
"""In the order of ``batch_measure.h``."""

SAMPLES, EVENTS = WHATS.index("samples"), WHATS.index("first_event")


class Entry(NamedTuple):
    """A measure as ``batch_measure`` of C: -1 where it has no signal, port or kind.

    ``at``: its first place in a run's row of results.
    """

    what: int
    signal: int
    port: int
    kind: int
    at: int


@dataclass(frozen=True)
class Plan:
    """What to keep of each run. ``rows``: places of the signals that are followed.

    ``samples``: how many instants there are. ``width``: how many numbers a run gives.
    """

    entries: tuple[Entry, ...]
    rows: tuple[int, ...]
    samples: int
    width: int

    def columns(self, found: Array) -> tuple[Array, ...]:
        """The measures one by one, from a row of results for each run."""
        return tuple(
            found[:, one.at : one.at + self.samples] if one.what == SAMPLES else found[:, one.at]
            for one in self.entries
        )


def plan(measures: Iterable[object], program: Program, samples: int) -> Plan | None:
    """How the loop gets these measures; None where one is none that it can do."""
    known, rows = places(program), list[int]()
    entries, at = list[Entry](), 0
    for measure in measures:
        if not isinstance(measure, Measure) or measure.function not in READY:
            return None
        what = WHATS.index(READY[measure.function])
        if what >= EVENTS:
            entries.append(_of_events(what, measure, program, at))
        elif measure.arguments[0] in known:
            row = known[measure.arguments[0]]
            if row not in rows:
                rows.append(row)
            entries.append(Entry(what, rows.index(row), -1, -1, at))
        else:
            return None
        at += samples if what == SAMPLES else 1
    return Plan(tuple(entries), tuple(rows), samples, at)


def _of_events(what: int, measure: Measure, program: Program, at: int) -> Entry:
    node, event = measure.arguments
    ports = [port.name for port in program.friction]
    port = ports.index(node) if node in ports else -1
    kind = KINDS.index(event) if event in KINDS else -1
    return Entry(what, -1, port, kind, at)

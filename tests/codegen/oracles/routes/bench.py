"""`Bench`: what the routes of one kind share, made once; how a run is compared with the known one."""

import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import networkx as nx
import numpy as np

import bondgraph as bg
import codegen
from oracles.c_model import compiled, written
from oracles.routes.kind import Array, Kind
from oracles.units import Case

EXACT, LOCATED, UNIT = 1e-7, 1e-6, 1e-5
"""How far a run may be off its known values, of their range: by exact steps, located events, an importer."""

FEW, MANY = 2_500, 20_000
"""Fixed steps of a run in Python and in C."""

CLOSE, WIDER = 1e-4, 1e-3
"""How near to an instant its neighbours are, of the length of a run: for slopes, for their differences."""


def stepped(count: int) -> float:
    """How far so many fixed steps may be off: each of a few events is late by up to a step.

    The latch is slowest to forget: five of them, at four ranges in the length of its run.
    """
    return 60 / count


@dataclass(frozen=True)
class Bench:
    """A kind and a folder for what is made of it."""

    kind: Kind
    folder: Path

    @cached_property
    def ready(self) -> codegen.Simulator:
        return codegen.simulator(self.kind.equations, self.kind.numbers, self.kind.laws)

    def ran(self, times: Array) -> codegen.Result:
        """By numpy."""
        kind = self.kind
        return self.ready.run(times, kind.initial, kind.signals, initially_on=kind.on)

    @cached_property
    def run(self) -> codegen.Result:
        """What the other routes find states and switches of."""
        return self.ran(self.kind.times())

    @cached_property
    def about(self) -> codegen.Result:
        """The run at its start, and about its instant: wider twice, close, at it, close, wider twice."""
        end = self.kind.end
        near = np.array([-2 * WIDER, -WIDER, -CLOSE, 0, CLOSE, WIDER, 2 * WIDER])
        return self.ran(np.array([0.0, *(self.kind.at + near * end)]))

    @cached_property
    def compiled(self) -> codegen.Simulator:
        return codegen.simulator(self.kind.equations, self.kind.numbers, self.kind.laws, "c")

    @property
    def given(self) -> dict[str, object]:
        """What exports take of a run."""
        kind = self.kind
        return {"initial": kind.initial, "inputs": kind.signals, "initially_on": kind.on}

    @cached_property
    def program(self) -> Path:
        """The exported C with its main program, as a user compiles it."""
        kind = self.kind
        files = codegen.to_c(
            kind.equations, kind.numbers, kind.laws, "kind", main=True, **self.given
        )
        return compiled(self.folder, written(self.folder, files), "-O0")

    def printed(self, *how: str) -> Mapping[str, Array]:
        """The table that the exported program prints, at the samples of the kind."""
        sample = f"{self.kind.end / 50!r}"
        told = subprocess.run(
            [self.program, f"{self.kind.end!r}", sample, *how], capture_output=True, text=True,
            check=False,
        )  # fmt: skip
        assert told.returncode == 0, told.stderr
        head, *rows = told.stdout.splitlines()
        table = np.array([row.split(",") for row in rows], dtype=float)
        return dict(zip(head.split(","), table.T, strict=True))

    def unit(self, version: str) -> tuple[Path, Case]:
        """A unit, and the case that it is made of."""
        kind = self.kind
        case = Case(kind.equations, kind.numbers, kind.laws, kind.initial, kind.signals, kind.end)
        path = self.folder / f"unit{version[0]}.fmu"
        if not path.exists():
            case.written(path, version, initially_on=kind.on)
        return path, case

    @property
    def file(self) -> Path:
        """The graph as JSON."""
        path = self.folder / "kind.json"
        bg.write_json(self.kind.graph, path)
        return path

    def check(self, found: Mapping[str, Array], within: float, aside: float = 0.0) -> None:
        """States as they are known by hand, switches as numpy has them.

        ``aside``: how near events [s] a sample may be of either side of them.
        """
        times = self.kind.times()
        # At the start switches may wait for their conditions to rise.
        near = (times == 0) & (aside > 0)
        for event in self.run.events:
            near |= np.abs(times - event.time) <= aside
        for name, right in self.kind.known(times, found).items():
            size = max(np.ptp(right), 1e-3 * np.abs(right).max())
            off = np.abs(found[name] - right)[~near].max() / size
            assert off <= within, f"{name} is off by {off:.1e} of its range"
        for name in self.kind.switches:
            assert (found[name] == self.run[name])[~near].all(), f"switch {name}"


def same(graph: nx.DiGraph, other: bg.StateEquations) -> None:
    """A graph has those equations, laws and switches, to the last sign."""
    one = bg.derive(graph, inputs=[name.name for name in other.reduction.structure.opened])
    for name in ("A", "J", "B", "E", "F", "D", "G", "states", "inputs", "outputs", "laws"):
        assert getattr(one, name) == getattr(other, name), name
    assert one.tasks == other.tasks
    told = [
        [(s.name, s.on, s.off, s.guard, s.side, s.switch.resets) for s in e.switches]
        for e in (one, other)
    ]
    assert told[0] == told[1]

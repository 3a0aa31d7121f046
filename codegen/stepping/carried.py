"""Where runs in C have paused, from their numbers and back to them: the same record for each backend."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codegen.model.kept import Kept, KeptPeaks, Paused
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.tuning import TUNING

HEAD = 8
"""Numbers of a loop before those of its latest events: see ``bg_carry_kept``."""


@dataclass(frozen=True)
class Carried:
    """The order of an engine's numbers: of a loop, s, peaks of states and inputs, magnitudes reached.

    ``size``: of s; ``states``, ``inputs``: of the peaks; ``reached``: for each magnitude its place in s.
    """

    model: ClosedModel
    size: int
    states: int
    inputs: int
    reached: tuple[int, ...]
    #: So many magnitudes there is room for, at the least.
    least: int = 1

    @property
    def ports(self) -> int:
        """So many ports there is room for."""
        return max(len(self.model.program.friction), 1)

    @property
    def cuts(self) -> list[int]:
        """Where the parts of one record begin, and where it ends."""
        p = self.ports
        widths = [HEAD, TUNING.stalled, *[p] * 6, 2 * p]
        widths += [self.size, self.states, self.inputs, max(len(self.reached), self.least)]
        return [int(cut) for cut in np.cumsum(widths)]

    def told(self, numbers: Array) -> Paused:
        """The record of a paused run."""
        arrived, present = np.split(numbers, 2)
        return Paused(self._kept(arrived), self._kept(present))

    def numbers(self, paused: Paused) -> Array:
        """The numbers of a record."""
        return np.concatenate([self._written(one) for one in paused])

    def _kept(self, numbers: Array) -> Kept:
        parts = [part.tolist() for part in np.split(numbers, self.cuts[:-1])]
        head, rounds, mode, touched, lingers, leapt, last, unseen, speeds, s, x, u, far = parts
        t, began, done, time, begun, decided, after, full = head
        program, count = self.model.program, len(self.model.program.friction)
        both = (*x[: len(program.states)], *u[: len(program.inputs)])
        largest = np.abs(s)
        largest[: len(program.states)] = np.maximum(
            largest[: len(program.states)], x[: len(program.states)]
        )
        for place, size in zip(self.reached, far, strict=False):
            if place >= 0:
                largest[place] = max(largest[place], size)
        first = int(after)
        return Kept(
            t,
            began,
            done,
            tuple(s),
            tuple(int(sign) for sign in mode[:count]),
            frozenset(i for i in range(count) if touched[i]),
            bool(begun),
            bool(decided),
            tuple(largest.tolist()),
            KeptPeaks(
                both,
                len(program.states),
                time,
                frozenset(i for i in range(count) if lingers[i]),
                tuple((i, leapt[i]) for i in range(count) if leapt[i]),
            ),
            tuple(
                (i, last[i], int(unseen[i]), speeds[2 * i], speeds[2 * i + 1])
                for i in range(count)
                if math.isfinite(last[i])
            ),
            tuple(rounds[first:] + rounds[:first] if full else rounds[:first]),
        )

    def _written(self, kept: Kept) -> Array:
        p, program, peaks = self.ports, self.model.program, kept.peaks
        rounds = list(kept.rounds[-TUNING.stalled :])
        full = len(rounds) == TUNING.stalled
        head = [kept.t, kept.began, kept.done, peaks.time, kept.begun, kept.decided]
        head += [len(rounds) % TUNING.stalled, full]
        ports = np.zeros((6, p))
        last, speeds = np.full(p, -np.inf), np.full((p, 2), np.inf)
        ports[0, :] = 1.0
        ports[0, : len(kept.mode)] = kept.mode
        ports[1, list(kept.touched)] = 1.0
        ports[2, list(peaks.lingering)] = 1.0
        for i, leapt in peaks.leapt:
            ports[3, i] = leapt
        for i, when, unseen, before, latest in kept.crossings:
            last[i], ports[5, i], speeds[i] = when, unseen, (before, latest)
        ports[4] = last
        both = np.array(peaks.both)
        x, u = np.zeros(self.states), np.zeros(self.inputs)
        x[: peaks.states], u[: len(program.inputs)] = both[: peaks.states], both[peaks.states :]
        far = np.zeros(max(len(self.reached), self.least))
        for at, place in enumerate(self.reached):
            far[at] = kept.largest[place] if place >= 0 else 0.0
        return np.concatenate(
            [head, _filled(rounds), ports.ravel(), speeds.ravel(), kept.s, x, u, far]
        )


def _filled(rounds: Sequence[float]) -> Array:
    found = np.zeros(TUNING.stalled)
    found[: len(rounds)] = rounds
    return found

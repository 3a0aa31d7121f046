"""What of a run of bodies with stops is not as the judge finds it, or does not keep momentum and energy."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np
from references.stops.impact import JammedError
from references.stops.line import Line, Wave
from references.stops.motion import Course, Machine

from codegen import Result
from oracles.stopped import elements, run

NEAR, LEAST = 1e-4, 1e-3
"""Seconds about an event in which samples may show either side; of the largest, impulses compared."""


def sure(line: Line, times: np.ndarray, course: Course, rng: np.random.Generator) -> int:
    """Up to which sample the motion is that of neighbours within 1e-10: no tie, no chaos.

    Two on either side: where one grazes a stop, the other passes it by.
    """
    found = np.array(course.states)
    size, upto = 1 + np.abs(found).max(), len(times)
    if course.ties:
        upto = int(np.searchsorted(times, course.ties[0]))
    seed = int(rng.integers(2**32))
    for way in (1e-10, -1e-10):
        nudged = _nudged(line, np.random.default_rng(seed), way)
        neighbour = Course()
        # Where rounding alone decides, the judge may find no stops of a neighbour that hold.
        with suppress(JammedError):
            Machine(nudged).run(times[:upto], neighbour)
        other = np.array(neighbour.states)
        upto = len(other)
        far = np.abs(other - found[:upto]).max(axis=1) > 3e-9 * size
        apart = np.flatnonzero(far & clear(line, times[:upto], course))
        upto = min(upto, *apart.tolist(), len(times))
    return upto


def _nudged(line: Line, rng: np.random.Generator, part: float) -> Line:
    def near(value: float) -> float:
        return value * (1 + part * float(rng.uniform(-1, 1)))

    def waving(one: Wave) -> Wave:
        # What swings by itself comes back to where it was let go, whatever it weighs.
        if one.amplitude:
            return replace(one, constant=near(one.constant), amplitude=near(one.amplitude))
        omega, phase = rng.uniform(1, 5), rng.uniform(0, 6)
        return Wave(near(one.constant), part * (1 + abs(one.constant)), float(omega), float(phase))

    forces = tuple(map(waving, line.forces or [Wave()] * len(line.masses)))
    return replace(
        line, masses=tuple(map(near, line.masses)), speeds=tuple(map(near, line.speeds)),
        forces=forces,
    )  # fmt: skip


def clear(line: Line, times: np.ndarray, course: Course) -> np.ndarray:
    """Samples away from events, and not among bounces so small that they may have ended."""
    found = np.ones(len(times), dtype=bool)
    events = course.events
    if not events:
        return found
    largest = max(one[3] for one in events)
    bouncing = {stop.name for stop in line.stops if stop.bounce > 0}
    for k, (t, name, _, impulse) in enumerate(events):
        found &= np.abs(times - t) > NEAR
        later = next((one[0] for one in events[k + 1 :] if one[1] == name), t)
        if name in bouncing and impulse < LEAST * largest:
            found &= (times < t) | (times > later)
    return found


def complaints(
    line: Line, times: np.ndarray, result: Result, course: Course, upto: int
) -> list[str]:
    """What in a run is not as the judge finds it: speeds, deflections, impulses, energy."""
    found, n = np.array(course.states), len(line.masses)
    good = clear(line, times, course)
    good[upto:] = False
    size = 1 + np.abs(found).max()
    wrong = []
    for i in range(n):
        far = np.abs(result[f"v{i}"] - found[:, n + i])[good].max(initial=0.0)
        if far > 1e-8 * size:
            wrong.append(f"v{i}: off by {far:.3g}")
    for name, (one, *_) in elements(line).items():
        a, b = one.place
        if a < n and (b is None or b < n):
            q = found[:, a] - (0.0 if b is None else found[:, b])
            far = np.abs(result[f"q_{name}"] - q)[:upto].max(initial=0.0)
            if far > 1e-8 * size:
                wrong.append(f"q_{name}: off by {far:.3g}")
    audit = result.audit()
    if abs(audit.residual) > 1e-9 * audit.turned_over + 1e-16:
        wrong.append(f"audit: {audit.residual:.3g} of {audit.turned_over:.3g} open")
    if audit.impacts < -1e-12 * audit.turned_over:
        wrong.append(f"impacts gave {-audit.impacts:.3g}")
    end = times[upto - 1] - NEAR if upto else -1.0
    return wrong + _unlike_events(result, course, end)


def _unlike_events(result: Result, course: Course, end: float) -> list[str]:
    """Impulses of one that the other has not."""
    told = [(e.time, str(e.port), abs(e.impulse)) for e in result.events]
    right = [(t, name, impulse) for t, name, _, impulse in course.events]
    largest = max((one[2] for one in right if one[0] <= end), default=0.0)
    wrong = []
    for here, there, whose in ((told, right, "no"), (right, told, "missing")):
        left = list(there)
        for one in here:
            if one[0] > end or one[2] <= LEAST * largest:
                continue
            same = [
                k for k, (t, name, impulse) in enumerate(left)
                if name == one[1] and abs(t - one[0]) < 1e-6
                and abs(impulse - one[2]) < 1e-6 * largest
            ]  # fmt: skip
            if same:
                del left[same[0]]
            else:
                wrong.append(f"{whose} impulse of {one[1]} at {one[0]:.9g}: {one[2]:.6g}")
    return wrong


def unbalanced(line: Line, times: np.ndarray, result: Result, backend: str = "numpy") -> list[str]:
    """Instants at which bodies gain other momentum than the events' impulses, at most twenty.

    Of another run, whose samples lie a moment before and after; events are told by that run, too.
    """
    moment = 1e-8
    instants = np.unique([e.time for e in result.events])
    inside = instants[(instants > times[0] + moment) & (instants < times[-1] - moment)]
    alone = inside[np.diff(inside, append=np.inf) > 4 * moment]
    alone = alone[np.diff(alone, prepend=-np.inf) > 4 * moment][:: len(alone) // 20 + 1]
    if not len(alone):
        return []
    around = np.sort([*(alone - moment), *(alone + moment)])
    seen = run(line, [times[0], *around, times[-1]], backend)
    wrong, places = [], {stop.name: stop.place for stop in line.stops}
    for k, t in enumerate(alone):
        gained = np.zeros(len(line.masses) + len(line.driven))
        for event in seen.events:
            if abs(event.time - t) < moment:
                a, b = places[str(event.port)]
                gained[a] -= event.impulse
                if b is not None:
                    gained[b] += event.impulse
        for i, mass in enumerate(line.masses):
            before, after = seen[f"v{i}"][2 * k + 1 : 2 * k + 3]
            off = mass * (after - before) - gained[i]
            # Forces give some, too.
            if abs(off) > 1e-5 * (1 + np.abs(gained).max()):
                wrong.append(f"momentum of body {i} at {t:.9g}: {off:.3g} of {gained[i]:.6g}")
    return wrong

"""Random bodies with up to six stops go every route as the judge finds, or as far as fixed steps can tell."""

import subprocess
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import compiled, written
from oracles.exported import loaded
from oracles.stopped import elements, graph, initial, inputs
from oracles.stopped_judged import clear, sure
from oracles.stopped_random import random_line
from oracles.units import Case, sampled, simulated
from references.stops.impact import JammedError
from references.stops.line import Line
from references.stops.motion import Course, Machine
from soak.families import seeds

import bondgraph as bg
import codegen

pytestmark = pytest.mark.usefixtures("compiled_quickly")

END, SAMPLES, STEPS = 4.0, 41, 20_000
TIMES = np.linspace(0.0, END, SAMPLES)

SLACK = 40
"""Speeds, of the largest, per second that a step is late."""

TIGHT, BY_IMPORTER = 1e-7, 1e-4
"""How far located runs may be off, of the largest: by themselves, and where an importer locates to some
1e-6; motions that are compared enlarge an error thirty times, at the most."""

COARSER = 8
"""Python takes steps so many times as long."""

EARLY = 3
"""Fixed steps, late by up to one at each event, are compared up to so many of them."""


def _off(
    line: Line, course: Course, run: Mapping[str, np.ndarray], upto: int, aside: float = 0.0
) -> float:
    """How far speeds and displacements are off the judge's at most, of the largest.

    ``aside`` [s]: as near as that to an event a sample may be of either side of it.
    """
    found, n = np.array(course.states), len(line.masses)
    good = clear(line, TIMES, course)
    good[upto:] = False
    for t, *_ in course.events:
        good &= np.abs(TIMES - t) >= aside
    off = [np.abs(run[f"v{i}"] - found[:, n + i])[good].max(initial=0.0) for i in range(n)]
    for name, (one, *_) in elements(line).items():
        a, b = one.place
        if a < n and (b is None or b < n):
            q = found[:, a] - (0.0 if b is None else found[:, b])
            off.append(np.abs(run[f"q_{name}"] - q)[good].max(initial=0.0))
    return float(max(off) / (1 + np.abs(found).max()))


def _gaps(line: Line, run: Mapping[str, np.ndarray]) -> float:
    """The least gap at any sample."""
    gaps = [
        one.way * (run[f"q_{name}"] - one.at).min()
        if one.way > 0 else (one.at - run[f"q_{name}"]).min()
        for name, bounds in elements(line).items() for one in bounds
    ]  # fmt: skip
    return float(min(gaps))


def _printed(program: Path, *how: str) -> Mapping[str, np.ndarray]:
    """The table that the exported program prints."""
    words = [program, f"{END!r}", f"{END / (SAMPLES - 1)!r}", *how]
    told = subprocess.run(words, capture_output=True, text=True, check=True)
    head, *rows = told.stdout.splitlines()
    return dict(zip(head.split(","), np.array([r.split(",") for r in rows], float).T, strict=True))


@pytest.mark.parametrize("seed", seeds("stops-everywhere"))
def test_random_stops_everywhere(seed: int, tmp_path: Path) -> None:
    line = random_line(np.random.default_rng(seed))
    try:
        course = Machine(line).run(TIMES)
        upto = sure(line, TIMES, course, np.random.default_rng([seed, 1]))
    except JammedError:
        pytest.skip("a source presses what does not yield: no route goes that way")
    made, start, given = graph(line), initial(line), inputs(line)
    made.nodes["m0"]["value"], numbers = "mass", {"mass": line.masses[0]}
    equations = bg.derive(made)
    early = [t for t, *_ in course.events][EARLY:]
    soon = min(upto, int(np.searchsorted(TIMES, early[0])) if early else SAMPLES)
    late = SLACK * END / STEPS

    files = codegen.to_c(equations, numbers, None, "kind", main=True, initial=start, inputs=given)
    program = compiled(tmp_path, written(tmp_path, files), "-O0")
    assert _off(line, course, _printed(program, "located"), upto) < TIGHT
    module = loaded(codegen.to_python(equations, numbers, None, "kind"))
    waves = {name: one if callable(one) else float(one) for name, one in given.items()}
    stepped = {
        "C": _printed(program, f"step={END / STEPS!r}"),
        "Python": module.simulate(TIMES, start, waves, step=COARSER * END / STEPS),
    }
    for name, run in stepped.items():
        coarse = 1 if name == "C" else COARSER
        aside = (EARLY + 1) * coarse * END / STEPS
        assert _off(line, course, run, soon, aside) < coarse * late, name
        assert _gaps(line, run) > -1e-9, name

    measures = {name: codegen.samples(name) for name in start}
    swept = codegen.sweep(
        codegen.Family(equations, numbers, backend="c"), {"mass": [line.masses[0]]}, TIMES, measures,
        start, given, workers=0, progress=False,
    )  # fmt: skip
    assert not swept.failed
    assert _off(line, course, {name: swept[name][0] for name in start}, upto) < TIGHT

    case, names, version = (
        Case(equations, numbers, None, start, given, END),
        [*start],
        "23"[seed % 2],
    )
    path = case.written(tmp_path / "unit.fmu", f"{version}.0")
    for kind, near in (("CoSimulation", TIGHT), ("ModelExchange", BY_IMPORTER)):
        found = sampled(simulated(path, kind, case, names, SAMPLES), case, SAMPLES)
        assert _off(line, course, found, upto) < near, kind

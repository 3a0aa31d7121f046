"""Runs of a model by every engine in C, each of which must be C's own and like numpy's."""

from collections.abc import Iterator

import numpy as np

import codegen
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import batch_of
from oracles.units import Case

METHODS = ("auto", "DOP853", "Radau")


def times_of(case: Case) -> list[np.ndarray]:
    """Two samples, and a few that are not evenly apart."""
    return [np.array([0.0, case.end]), case.end * np.array([0.0, 0.3, 0.35, 0.8, 1.0])]


def check_runs(case: Case) -> None:
    """Runs by every method over every axis of time are C's, and like numpy's."""
    fast, slow = (
        codegen.simulator(case.equations, case.parameters, case.laws, backend=backend)
        for backend in ("c", "numpy")
    )
    for times in times_of(case):
        expected = slow.run(times, case.initial, case.inputs)
        for method in METHODS:
            found = fast.run(times, case.initial, case.inputs, method)
            assert found.backend == "c", method
            told = [[(e.port, e.kind) for e in one.events] for one in (found, expected)]
            assert told[0] == told[1], method
            for name in expected:
                size = max(1.0, float(np.abs(expected[name]).max()))
                assert np.abs(found[name] - expected[name]).max() <= 1e-6 * size, (method, name)


def check_sweeps(case: Case) -> int:
    """Sweeps by the loops in C are like single runs; how many loops there are for the model."""
    return sum(1 for job in _jobs(case) if _looped(job))


def _jobs(case: Case) -> Iterator[Job]:
    family = codegen.Family(case.equations, case.parameters, case.laws, "c")
    names = [*family.parameters, *family.states]
    measures = {f"end {name}": codegen.final(name) for name in family.states}
    for times in times_of(case) if names and measures else ():
        for method in METHODS:
            settings = {"method": method}
            yield Job(family, (names[0],), times, measures, case.initial, case.inputs, settings)


def _looped(job: Job) -> bool:
    loop = batch_of(job)
    if loop is None:
        return False
    value = float(str(job.model.parameters.get(job.names[0], 0.25)))
    rows = [(value,), (1.5 * value,)]
    columns, left = loop(rows)
    assert list(left) == []
    for at, row in enumerate(rows):
        for column, one in zip(columns, job.run(row), strict=True):
            assert abs(column[at] - float(one)) <= 1e-6 * max(1.0, abs(float(one)))
    return True

"""Sweeps on a cluster whose workers die."""

from collections.abc import Iterator

import dask
import distributed
import numpy as np
import pytest
from oracles.sweeping import MEASURES, TIMES, Killer, Logged, spring_mass

import bondgraph as bg
import codegen
from codegen import Sweep, sweep
from codegen.sweeps.drive import ENDED

SPEEDS = np.arange(1.0, 31.0)


@pytest.fixture(scope="module")
def client() -> Iterator[distributed.Client]:
    # A task is given up with its first worker, so that what follows is seen soon.
    settings = {"distributed.scheduler.allowed-failures": 0}
    with (
        dask.config.set(settings),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def _swept(measures: object, **more: object) -> Sweep:
    given = {"inputs": {"P": 0.0}, "progress": False, **more}
    return sweep(spring_mass(), {"v": SPEEDS}, TIMES, measures, **given)


def test_a_cluster_gives_the_same_numbers(client) -> None:
    there, here = _swept(MEASURES, client=client), _swept(MEASURES, workers=0)
    assert there.complete
    for name in MEASURES:
        assert (there[name] == here[name]).all()


def test_a_worker_that_is_killed_loses_nothing_and_nothing_counts_twice(client, tmp_path) -> None:
    measures = {"F": Killer(17.0, tmp_path), "log": Logged(tmp_path)}
    found = _swept(measures, client=client, chunk=3, store=tmp_path / "store")
    assert (tmp_path / "killed").exists()
    assert found.complete
    assert not found.failed
    assert (found["F"] == _swept({"F": codegen.final("F")}, workers=0)["F"]).all()
    assert Logged(tmp_path).runs() >= 30
    again = _swept(measures, workers=0, store=tmp_path / "store")
    assert (again["F"] == found["F"]).all()


def test_a_run_that_kills_its_worker_fails_alone(client) -> None:
    found = _swept({"F": Killer(at=3.0)}, client=client, chunk=5)
    assert [(failure.run, failure.message) for failure in found.failed] == [(2, ENDED)]
    assert np.isnan(found["F"]).tolist() == [v == 3.0 for v in SPEEDS]


def test_what_is_no_client_is_refused() -> None:
    with pytest.raises(bg.SignalError, match=r"client must be a distributed\.Client"):
        _swept(MEASURES, client="tcp://here")

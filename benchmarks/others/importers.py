"""Units with switches in co-simulation under two importers: FMPy, and FMI Library by libcosimpy."""

import importlib.util
from pathlib import Path

import numpy as np
from fmpy import simulate_fmu
from oracles.switched_units import SwitchedCase

STEPS = 100


def missing() -> str:
    """Why there is no second importer; nothing if there is."""
    found = importlib.util.find_spec("libcosimpy")
    return "" if found else "FMI Library is not installed (libcosimpy of the Python package index)"


def by_library(path: Path, case: SwitchedCase, names: list[str]) -> np.ndarray:
    """Variables at the communication points after the first, by FMI Library."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    # In nanoseconds.
    run = CosimExecution.from_step_size(round(case.end / STEPS * 1e9))
    at = run.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name="unit"))
    observer = CosimObserver.create_last_value()
    run.add_observer(observer)
    known = {one.name.decode(): one for one in run.slave_variables(at)}
    references = [known[name].reference for name in names]
    rows = []
    for _ in range(STEPS):
        run.step()
        rows.append(observer.last_real_values(at, references))
    return np.array(rows)


def by_fmpy(path: Path, case: SwitchedCase, names: list[str]) -> np.ndarray:
    """The same by FMPy, at FMI Library's tolerance: none is told."""
    found = simulate_fmu(
        str(path), fmi_type="CoSimulation", stop_time=case.end, step_size=case.end / STEPS,
        output_interval=case.end / STEPS, output=names, set_stop_time=False,
    )  # fmt: skip
    return np.array([list(row)[1:] for row in found[1 : STEPS + 1]])

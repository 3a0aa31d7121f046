"""Differentials in their scenarios as Python, C and functional mock-up units."""

from collections.abc import Mapping
from pathlib import Path

import bondgraph as bg
import codegen
from differentials.scenarios import Prepared, Scenario, named, prepared

TARGETS = ("python", "c", "fmu2", "fmu3")


def export(
    name: str,
    target: str,
    scenario: str | Scenario,
    parameters: Mapping[str, float] | None,
    out: Path,
) -> list[Path]:
    """Write a differential's full model, as it is in a scenario, into a folder; the files written.

    ``target``: "python", a module and a script that runs the scenario with it; "c", a folder of C99 whose
    parameters and main program are the scenario's; "fmu2" or "fmu3", a unit with its inputs inside.

    Raises `BondGraphError` for names and numbers that don't fit, and for what the target needs.
    """
    if target not in TARGETS:
        raise bg.SignalError(f"unknown target {target!r}; there are {', '.join(TARGETS)}")
    ready = prepared(name, scenario, parameters)
    arguments = (ready.equations, ready.parameters, ready.laws)
    out.mkdir(parents=True, exist_ok=True)
    if target.startswith("fmu"):
        path = out / f"{name}.fmu"
        codegen.write_fmu(
            path, *arguments, version=f"{target[-1]}.0", initial=ready.initial, inputs=ready.inputs,
            name=name,
        )  # fmt: skip
        return [path]
    if target == "c":
        texts = codegen.to_c(
            *arguments, name=name, main=True, initial=ready.initial, inputs=ready.inputs
        )
        return [_written(out / name / file, text) for file, text in texts.items()]
    script = _script(name, ready, named(scenario))
    module = codegen.to_python(*arguments, name)
    return [_written(out / f"{name}.py", module), _written(out / f"run_{name}.py", script)]


def _written(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8", newline="\n")
    return path


def _script(name: str, ready: Prepared, case: Scenario) -> str:
    """A script that runs the module through the scenario."""
    starts = dict(zip(ready.inputs, [case.engine_step, *[case.clutch_step] * 9], strict=False))
    demands = dict(zip(ready.inputs, [case.engine_torque, *case.clutch_torques], strict=True))
    inputs = "".join(
        f'    "{one}": lagged({starts[one]!r}, {float(demands[one])!r}),\n' for one in ready.inputs
    )
    initial = "".join(f'    "{one}": {float(v)!r},\n' for one, v in ready.initial.items())
    return f'''"""Runs {name} through its scenario and writes every signal as comma-separated columns."""

import math

import numpy as np

from {name} import simulate


def lagged(time, demand, lag={float(case.lag)!r}):
    """A step of a demand at a time [s], through a first-order lag."""
    return lambda t: 0.0 if t < time else demand * (1.0 - math.exp(-(t - time) / lag))


inputs = {{
{inputs}}}
initial = {{
{initial}}}
times = np.linspace(0.0, {float(case.duration)!r}, {len(ready.times)})
result = simulate(times, initial, inputs, step=1e-4)
table = np.column_stack([times, *result.values()])
header = ",".join(["t", *result])
np.savetxt("{name}.csv", table, delimiter=",", header=header, comments="")
print("wrote {name}.csv")
'''

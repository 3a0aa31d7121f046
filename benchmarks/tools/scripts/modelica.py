"""The package `modelica`: a Modelica toolchain in Python, on scipy's integrators."""

from typing import Any

import numpy as np
from modelica.lang import parse
from modelica.sim import build, causalize, flatten, sensitivity, simulate, vector


def derived(name: str) -> Any:
    """What makes ordered equations of a model of this name and code of them."""

    def prepare(spec: dict[str, Any], text: str = "modelica") -> Any:
        system = causalize(flatten([parse(spec[text])], name))
        return system, build(system), spec

    return prepare


def run(ready: Any, method: str = "DOP853", tolerance: float = 1e-9, **options: Any) -> Any:
    """A run with the samples among its times."""
    _, kernel, spec = ready
    given = {"tolerance": tolerance, "absolute": 1e-9, "method": method, **options}
    return simulate(kernel, stop=spec["end"], points=spec["samples"], **given)


def at_samples(spec: dict[str, Any], found: Any, names: list[str]) -> list[list[float]]:
    """Columns at the samples, which are among the times; after an event where it is at one."""
    time = np.array(found.time)
    grid = np.linspace(0.0, spec["end"], spec["samples"])
    rows = np.searchsorted(time, grid + 1e-12 * spec["end"]) - 1
    return np.column_stack([np.array(found[name])[rows] for name in names]).tolist()


def chain_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Eigenvalues of its rates, which are linear, and speeds."""
    kernel = ready[1]
    p, y, w = kernel.start(0.0)
    size = len(y)

    def rates(state: Any) -> Any:
        return np.array(kernel.rhs(0.0, state, p, w, np.empty(size)))

    at_zero = rates(np.zeros(size))
    A = np.column_stack([rates(row) - at_zero for row in np.eye(size)])
    values = np.linalg.eigvals(A)
    names = [f"m_{k}.w" for k in range(len(spec["inertias"]))]
    return {
        "eigenvalues": [[v.real, v.imag] for v in values.tolist()],
        "values": at_samples(spec, found, names),
    }


def ladder_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Times and voltages."""
    names = [f"C_{k}.v" for k in range(1, spec["sections"] + 1)]
    times = np.linspace(0.0, spec["end"], spec["samples"])
    return {"times": times.tolist(), "values": at_samples(spec, found, names)}


def prepare_clutch(spec: dict[str, Any]) -> Any:
    """The clutch with conditions of one comparison each."""
    return derived("Driveline")({**spec, "end": 1.0}, "by_relations")


def clutch_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """What it says of events that changed the mode; speeds at the samples."""
    kinds = {"back < -1e-9": "stick", "up > 0": "slip", "down > 0": "slip"}
    events = [
        [event.time, kind] for event in found.events for cause, kind in kinds.items()
        if event.cause == f"when {cause}"
    ]  # fmt: skip
    return {"events": events, "values": at_samples({**spec, "end": 1.0}, found, ["w_1", "w_2"])}


def sweep(ready: Any) -> Any:
    """One run after the other with a vector of parameters each; two samples."""
    system, kernel, spec = ready
    few = (system, kernel, {**spec, "samples": 2})
    values = []
    for k, inertia in spec["pairs"]:
        changed = vector(system, {"k": k, "I_w": inertia})
        values.append(float(run(few, parameters=changed)["k_1"][-1]))
    return values


def sweep_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """The torques."""
    return {"values": found}


def prepare_gradient(spec: dict[str, Any]) -> Any:
    """A model with its derivatives with respect to both parameters."""
    system = causalize(flatten([parse(spec["modelica"])], "Driveline"))
    return build(system, sensitivity=("k", "I_w")), spec


def run_gradient(ready: Any) -> Any:
    """Derivatives integrated beside the states."""
    kernel, spec = ready
    given = {"tolerance": 1e-9, "absolute": 1e-9, "method": "DOP853"}
    return sensitivity(kernel, ("k", "I_w"), stop=spec["end"], **given)


def gradient_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """The value and its derivatives at the end."""
    value = found.values[found.states.index("k_1"), -1]
    return {
        "value": float(value), "gradient": [float(found["k_1", name][-1]) for name in ("k", "I_w")],
    }  # fmt: skip


ROWS = {
    "chain": (derived("Chain"), run, chain_told),
    "ladder": (derived("Ladder"), run, ladder_told),
    "clutch": (prepare_clutch, run, clutch_told),
    "sweep": (derived("Driveline"), sweep, sweep_told),
    "gradient": (prepare_gradient, run_gradient, gradient_told),
}
CANNOT: dict[str, str] = {}

"""Rumoca: Modelica, compiled in Rust."""

from typing import Any

import numpy as np
import rumoca

TIGHT = {"rtol": 1e-9, "atol": 1e-9}


def compiled(name: str) -> Any:
    """What compiles a model of this name and keeps what is asked of it."""

    def prepare(spec: dict[str, Any], text: str = "modelica") -> Any:
        return rumoca.Session().loads(spec[text], model=name), spec

    return prepare


def run(ready: Any, solver: str = "rk-like", **options: Any) -> Any:
    """A run at evenly spaced samples."""
    model, spec = ready
    config = rumoca.SimConfig(solver=solver, **TIGHT)
    step = spec["end"] / (spec["samples"] - 1)
    return model.simulate(t=(0.0, spec["end"]), dt=step, config=config, **options)


def chain_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Speeds. It gives no rates of states, to CasADi or JAX, where a model has other unknowns beside them."""
    columns = [found[f"m_{k}.w"] for k in range(len(spec["inertias"]))]
    return {"values": np.column_stack(columns).tolist()}


def ladder_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Times and voltages."""
    columns = [found[f"C_{k}.v"] for k in range(1, spec["sections"] + 1)]
    return {"times": list(map(float, found.time)), "values": np.column_stack(columns).tolist()}


def prepare_clutch(spec: dict[str, Any]) -> Any:
    """The clutch with a mode that is a whole number."""
    return compiled("Driveline")({**spec, "end": 1.0}, "by_mode")


def run_clutch(ready: Any) -> Any:
    """By its explicit solver, which is the faster and the more exact of its two here."""
    return run(ready, "rk-like")


def clutch_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Where the mode changes, both ends of which are among the times; speeds at the samples."""
    time, mode = np.array(found.time), np.round(np.array(found["mode"]))
    at = np.nonzero(np.diff(mode))[0]
    kinds = [["stick" if mode[k + 1] == 0 else "slip" if mode[k] == 0 else "cross"] for k in at]
    events = [[float(time[k + 1]), *kind] for k, kind in zip(at, kinds, strict=True)]
    grid = np.linspace(0.0, 1.0, spec["samples"])
    nearest = np.clip(np.searchsorted(time, grid - 1e-12), 0, len(time) - 1)
    values = np.column_stack([found["w_1"], found["w_2"]])[nearest]
    return {"events": events, "values": values.tolist()}


def sweep(ready: Any) -> Any:
    """One run after the other, each told its parameters; two samples."""
    model, spec = ready
    few = (model, {**spec, "samples": 2})
    values = []
    for k, inertia in spec["pairs"]:
        found = run(few, "rk-like", params={"k": k, "I_w": inertia})
        values.append(float(found["k_1"][-1]))
    return values


def sweep_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """The torques."""
    return {"values": found}


ROWS = {
    "chain": (compiled("Chain"), run, chain_told),
    "ladder": (compiled("Ladder"), run, ladder_told),
    "clutch": (prepare_clutch, run_clutch, clutch_told),
    "sweep": (compiled("Driveline"), sweep, sweep_told),
}
CANNOT = {"gradient": "gradients of expressions at one instant only, none of a run's result"}

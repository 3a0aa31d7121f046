"""Diffrax on JAX: an integrator of rates that are written by hand, for sweeps and gradients.

The clutch is a loop by hand over solutions that end in an event each.
"""

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import diffrax
import jax
import jax.numpy as jnp
import numpy as np
import optimistix
from tools import chains, ladders
from tools.jax_rates import START, clutched, hold, opened

jax.config.update("jax_enable_x64", True)

CONTROL = {"rtol": 1e-9, "atol": 1e-9}
MOST = 100_000
"""Steps of a run."""


def end_torque(spec: dict[str, Any]) -> Any:
    """The first halfshaft's torque at the end, as a function of stiffness and wheel inertia."""

    def rates(t: Any, y: Any, pair: Any) -> Any:
        return opened({**spec["numbers"], "k": pair[0], "I_w": pair[1]}, y, spec["linear"])

    def result(pair: Any) -> Any:
        found = diffrax.diffeqsolve(
            diffrax.ODETerm(rates), diffrax.Tsit5(), 0.0, spec["end"], 1e-4, jnp.array(START), args=pair,
            stepsize_controller=diffrax.PIDController(**CONTROL), max_steps=4096,
        )  # fmt: skip
        return found.ys[-1, 2]

    return result


def prepare_sweep(spec: dict[str, Any]) -> Any:
    """Traced; compiled at the first run."""
    return jax.jit(jax.vmap(end_torque(spec))), jnp.array(spec["pairs"])


def sweep(ready: Any) -> Any:
    """All runs side by side."""
    return np.asarray(ready[0](ready[1]).block_until_ready())


def sweep_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """The torques."""
    return {"values": found.tolist()}


def prepare_gradient(spec: dict[str, Any]) -> Any:
    """The result with its gradient by reverse mode."""
    numbers = spec["numbers"]
    return jax.jit(jax.value_and_grad(end_torque(spec))), jnp.array([numbers["k"], numbers["I_w"]])


def run_gradient(ready: Any) -> Any:
    """Value and gradient."""
    value, slopes = ready[0](ready[1])
    return float(value), np.asarray(slopes).tolist()


def gradient_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """The value and its derivatives."""
    return {"by_hand": True, "value": found[0], "gradient": found[1]}


def linear_run(A: Any, b: Any, times: Any) -> Any:
    """``x' = A x + b`` from nothing, at the samples."""
    left, right = jnp.array(A), jnp.array(b)

    @jax.jit
    def go() -> Any:
        return diffrax.diffeqsolve(
            diffrax.ODETerm(lambda t, y, _: left @ y + right), diffrax.Dopri8(), 0.0, times[-1], None,
            jnp.zeros(len(b)), stepsize_controller=diffrax.PIDController(**CONTROL),
            saveat=diffrax.SaveAt(ts=jnp.array(times)), max_steps=MOST,
        ).ys  # fmt: skip

    return go


def prepare_chain(spec: dict[str, Any]) -> Any:
    """Its matrices are given."""
    A, b = chains.matrices(chains.read(spec))
    times = np.linspace(0.0, spec["end"], spec["samples"])
    return linear_run(A, b, times), times, slice(0, len(spec["inertias"]))


def prepare_ladder(spec: dict[str, Any]) -> Any:
    """Its matrices are given."""
    A, b = ladders.matrices(ladders.read(spec))
    times = np.linspace(0.0, spec["end"], spec["samples"])
    return linear_run(A, b, times), times, slice(spec["sections"], 2 * spec["sections"])


def run_linear(ready: Any) -> Any:
    """All states at the samples."""
    return np.asarray(ready[0]().block_until_ready())


def linear_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Times and the columns that are compared."""
    values = found[:, ready[2]].tolist()
    return {"by_hand": True, "times": ready[1].tolist(), "values": values}


def clutch_parts(spec: dict[str, Any]) -> Any:
    """A compiled solution for each mode: on from a time and a state to an event or an end."""
    p = spec["numbers"]

    def rates(mode: int) -> Any:
        def of(t: Any, y: Any, demand: Any) -> Any:
            friction = hold(p, y) if mode == 0 else mode * y[7]
            return clutched(p, y, friction, demand[0], demand[1])

        return of

    def guard(mode: int) -> Any:
        if mode == 0:
            return lambda t, y, args, **_: y[7] - jnp.abs(hold(p, y))
        return lambda t, y, args, **_: mode * (y[0] - y[1]) / 2

    def go_on(mode: int) -> Any:
        finder = optimistix.Newton(1e-12, 1e-12)

        @jax.jit
        def go(begin: Any, end: Any, y: Any, demand: Any, times: Any) -> Any:
            return diffrax.diffeqsolve(
                diffrax.ODETerm(rates(mode)), diffrax.Dopri8(), begin, end, 1e-5, y, args=demand,
                stepsize_controller=diffrax.PIDController(rtol=1e-10, atol=1e-10), max_steps=MOST,
                saveat=diffrax.SaveAt(
                    subs=[diffrax.SubSaveAt(t1=True), diffrax.SubSaveAt(ts=times)]
                ),
                event=diffrax.Event(guard(mode), finder, direction=False),
            )  # fmt: skip

        return go

    return {mode: go_on(mode) for mode in (-1, 0, 1)}, jax.jit(lambda y: hold(p, y)), spec


def run_clutch(ready: Any) -> Any:
    """The loop by hand: from demand to demand and event to event."""
    modes, held, spec = ready
    p, grid = spec["numbers"], np.linspace(0.0, 1.0, spec["samples"])
    y, mode, now, events = jnp.array([*START, 0.0]), -1, 0.0, []
    rows = np.empty((spec["samples"], 8))
    for end in (spec["step_e"], spec["step_h"], 1.0):
        demand = jnp.array(
            [p["torque_e"] * (now >= spec["step_e"]), p["torque_h"] * (now >= spec["step_h"])]
        )
        while now < end:
            at = np.clip(grid, now, end)
            found = modes[mode](now, end, y, demand, jnp.array(at))
            y, last = found.ys[0][0], float(found.ts[0][0])
            inside = (grid >= now) & (grid <= last)
            rows[inside] = np.asarray(found.ys[1])[inside]
            if last < end:
                before, mode = mode, _next(mode, float(held(y)), float(y[7]))
                events.append([last, "stick" if mode == 0 else "slip" if before == 0 else "cross"])
            now = last
    return rows, events


def _next(mode: int, hold: float, pressure: float) -> int:
    if mode == 0:
        return 1 if hold > 0 else -1
    return 0 if abs(hold) <= pressure else -mode


def clutch_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Events and speeds."""
    return {"by_hand": True, "events": found[1], "values": found[0][:, :2].tolist()}


ROWS = {
    "chain": (prepare_chain, run_linear, linear_told),
    "ladder": (prepare_ladder, run_linear, linear_told),
    "clutch": (clutch_parts, run_clutch, clutch_told),
    "sweep": (prepare_sweep, sweep, sweep_told),
    "gradient": (prepare_gradient, run_gradient, gradient_told),
}
CANNOT: dict[str, str] = {}

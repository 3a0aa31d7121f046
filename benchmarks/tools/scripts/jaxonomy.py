"""Jaxonomy: acausal parts that it compiles, and a block with modes where parts do not reach; on JAX."""

import logging
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import jax
import jax.numpy as jnp
import jaxonomy as jx
import numpy as np
import scipy.linalg
from jaxonomy.acausal import AcausalCompiler, AcausalDiagram, EqnEnv, electrical, rotational
from tools.jax_blocks import Clutched, Open

jax.config.update("jax_enable_x64", True)
logging.disable(logging.CRITICAL)

TIGHT = {"rtol": 1e-9, "atol": 1e-9}


def options(spec: dict[str, Any], **more: Any) -> Any:
    """Steps that end at every sample and are all kept."""
    count = spec["samples"]
    step = spec["end"] / (count - 1)
    return jx.SimulatorOptions(
        **TIGHT,
        max_major_step_length=step,
        max_major_steps=4 * count,
        buffer_length=40 * count,
        **more,
    )


def prepare_chain(spec: dict[str, Any]) -> Any:
    """Its rotational parts, compiled; sensors at the first and the last inertia."""
    env, net = EqnEnv(), AcausalDiagram()
    fixed = {"initial_velocity_fixed": True, "initial_angle_fixed": True}
    inertias = [
        rotational.Inertia(env, name=f"m{k}", I=m, **fixed) for k, m in enumerate(spec["inertias"])
    ]
    ground = rotational.FixedAngle(env, name="ground")
    drive = rotational.TorqueSource(env, name="drive", tau=spec["torque"], enable_flange_b=False)
    net.connect(drive, "flange_a", inertias[0], "flange")
    for k, d in enumerate(spec["dampers"]):
        damper = rotational.Damper(env, name=f"b{k}", D=d)
        net.connect(damper, "flange_a", inertias[k], "flange")
        net.connect(damper, "flange_b", ground, "flange")
    for k, c in enumerate(spec["compliances"], 1):
        spring = rotational.Spring(env, name=f"c{k}", K=1 / c)
        net.connect(spring, "flange_a", inertias[k - 1], "flange")
        net.connect(spring, "flange_b", inertias[k], "flange")
    sensors = []
    for k in (0, len(inertias) - 1):
        sensors.append(rotational.MotionSensor(env, name=f"s{k}", enable_flange_b=False))
        net.connect(sensors[-1], "flange_a", inertias[k], "flange")
    return compiled(env, net), spec


def compiled(env: Any, net: Any) -> Any:
    """The system and its context."""
    system = AcausalCompiler(env, net)()
    return system, system.create_context()


def run(ready: Any) -> Any:
    """A run with all outputs."""
    (system, context), spec = ready
    ports = {str(k): port for k, port in enumerate(system.output_ports)}
    span = (0.0, spec["end"])
    return jx.simulate(system, context, span, options=options(spec), recorded_signals=ports)


def at_samples(spec: dict[str, Any], found: Any) -> Any:
    """The rows that are at the samples, and the times that they are at."""
    time = np.asarray(found.time)
    grid = np.linspace(0.0, spec["end"], spec["samples"])
    rows = np.searchsorted(time, grid + 1e-9 * spec["end"]) - 1
    return rows, time[rows]


def eigenvalues(system: Any, context: Any) -> list[list[float]]:
    """Finite ones of the pencil of its mass matrix and its Jacobian."""

    def rates(x: Any) -> Any:
        return system.eval_time_derivatives(context.with_continuous_state(x))

    x = context.continuous_state
    J = np.asarray(jax.jacfwd(rates)(x))
    values = scipy.linalg.eigvals(J, np.diag(np.asarray(system._cs_mass_matrix)))
    return [[v.real, v.imag] for v in values.tolist() if np.isfinite(v) and abs(v) < 1e12]


def chain_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Eigenvalues, and the first and last speed."""
    rows, times = at_samples(spec, found)
    values = np.column_stack([np.asarray(found.outputs[k]) for k in ("0", "1")])[rows]
    return {
        "eigenvalues": eigenvalues(*ready[0]), "columns": [0, len(spec["inertias"]) - 1],
        "times": times.tolist(), "values": values.tolist(),
    }  # fmt: skip


def prepare_ladder(spec: dict[str, Any]) -> Any:
    """Its electrical parts, compiled; a sensor at the last capacitor."""
    env, net = EqnEnv(), AcausalDiagram()
    ground = electrical.Ground(env, name="ground")
    source = electrical.VoltageSource(env, name="source", v=spec["V"])
    net.connect(source, "n", ground, "p")
    before = (source, "p")
    for k in range(1, spec["sections"] + 1):
        R = electrical.Resistor(env, name=f"R{k}", R=spec["R"])
        L = electrical.Inductor(env, name=f"L{k}", L=spec["L"], initial_current_fixed=True)
        C = electrical.Capacitor(env, name=f"C{k}", C=spec["C"], initial_voltage_fixed=True)
        net.connect(*before, R, "p")
        net.connect(R, "n", L, "p")
        net.connect(L, "n", C, "p")
        net.connect(C, "n", ground, "p")
        before = (C, "p")
    load = electrical.Resistor(env, name="load", R=spec["load"])
    sensor = electrical.VoltageSensor(env, name="sensor")
    for part in (load, sensor):
        net.connect(*before, part, "p")
        net.connect(part, "n", ground, "p")
    return compiled(env, net), spec


def ladder_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Times and the last voltage."""
    rows, times = at_samples(spec, found)
    values = np.asarray(found.outputs["0"])[rows].reshape(-1, 1)
    return {"times": times.tolist(), "values": values.tolist(), "columns": [spec["sections"] - 1]}


def prepare_clutch(spec: dict[str, Any]) -> Any:
    """The block; compiled at the first run."""
    system = Clutched(spec)
    return (system, system.create_context()), {**spec, "end": 1.0}


def clutch_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """Where the mode changes, and speeds."""
    time, mode = np.asarray(found.time), np.asarray(found.outputs["1"])
    events = [
        [float(time[k + 1]), "stick" if mode[k + 1] == 1 else "slip"]
        for k in np.nonzero(np.diff(mode))[0]
    ]
    # After an event it steps on from there, no longer to the samples.
    rows, times = at_samples(ready[1], found)
    kept = np.nonzero(np.abs(times - np.linspace(0.0, 1.0, spec["samples"])) < 1e-12)[0]
    values = np.asarray(found.outputs["0"])[rows[kept], :2]
    return {"by_hand": True, "events": events, "rows": kept.tolist(), "values": values.tolist()}


def prepare_sweep(spec: dict[str, Any]) -> Any:
    """A diagram of the block alone."""
    builder = jx.DiagramBuilder()
    block = builder.add(Open(spec))
    return builder.build(), block, spec


def sweep(ready: Any) -> Any:
    """All runs side by side."""
    diagram, block, spec = ready
    pairs = jnp.array(spec["pairs"])
    found = jx.simulate_batch(
        diagram, (0.0, spec["end"]), {"driveline.k": pairs[:, 0], "driveline.I_w": pairs[:, 1]},
        options=jx.SimulatorOptions(**TIGHT, max_major_steps=10, buffer_length=2000),
        recorded_signals={"x": block.output_ports[0]}, use_vmap=True,
    )  # fmt: skip
    return np.asarray(found.outputs["x"])[:, -1, 2]


def sweep_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """The torques."""
    return {"values": found.tolist()}


def prepare_gradient(spec: dict[str, Any]) -> Any:
    """The result as a function of both parameters, with its gradient by its adjoint."""
    system = Open(spec)
    context = system.create_context()
    given = jx.SimulatorOptions(**TIGHT, enable_autodiff=True, max_major_steps=10)

    def result(pair: Any) -> Any:
        at = context.with_parameters({"k": pair[0], "I_w": pair[1]})
        found = jx.simulate(system, at, (0.0, spec["end"]), options=given)
        return found.context.continuous_state[2]

    numbers = spec["numbers"]
    return jax.jit(jax.value_and_grad(result)), jnp.array([numbers["k"], numbers["I_w"]])


def run_gradient(ready: Any) -> Any:
    """Value and gradient."""
    value, slopes = ready[0](ready[1])
    return float(value), np.asarray(slopes).tolist()


def gradient_told(spec: dict[str, Any], ready: Any, found: Any) -> dict[str, Any]:
    """The value and its derivatives."""
    return {"by_hand": True, "value": found[0], "gradient": found[1]}


ROWS = {
    "chain": (prepare_chain, run, chain_told),
    "ladder": (prepare_ladder, run, ladder_told),
    "clutch": (prepare_clutch, run, clutch_told),
    "sweep": (prepare_sweep, sweep, sweep_told),
    "gradient": (prepare_gradient, run_gradient, gradient_told),
}
CANNOT: dict[str, str] = {}
